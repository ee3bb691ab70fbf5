//! Faults of compensators, extremes over motions and conditions.

/// An adjusted dimension, an extreme over a motion or a condition that is not usable.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompensatorFault {
    /// A stock without values.
    #[error("the stock of `{dimension}` is empty")]
    EmptyStock {
        /// The adjusted dimension.
        dimension: String,
    },
    /// A value that is in stock twice.
    #[error("the value {value} is in stock twice")]
    RepeatedValue {
        /// The value.
        value: f64,
    },
    /// A stock of too many values.
    #[error("the step {step} makes a stock of {count:.0} values, and {most} is the most")]
    TooManyValues {
        /// The step.
        step: f64,
        /// Number of values.
        count: f64,
        /// Greatest number of values.
        most: usize,
    },
    /// A list of too many values.
    #[error("the stock of `{dimension}` has {count} values, and {most} is the most")]
    LongStock {
        /// The adjusted dimension.
        dimension: String,
        /// Number of values.
        count: usize,
        /// Greatest number of values.
        most: usize,
    },
    /// A dimension that is adjusted twice.
    #[error("`{dimension}` is adjusted by another [[adjust]] already")]
    AdjustedTwice {
        /// The dimension.
        dimension: String,
    },
    /// A target beyond the limits of its characteristic.
    #[error("the target {target} lies outside the limits of `{characteristic}`")]
    TargetOutside {
        /// The target.
        target: f64,
        /// The characteristic.
        characteristic: String,
    },
    /// A dimension that the characteristic does not depend on.
    #[error("`{characteristic}` does not depend on `{dimension}`")]
    NoEffect {
        /// The dimension.
        dimension: String,
        /// The characteristic.
        characteristic: String,
    },
    /// A form of the response of a formula, which follows from the formula.
    #[error("`{characteristic}` is a formula, whose response is known")]
    ResponseOfFormula {
        /// The characteristic.
        characteristic: String,
    },
    /// A motion along a dimension that varies or is adjusted.
    #[error("`{dimension}` {why}, and a motion needs a dimension of its own")]
    MotionVaries {
        /// The dimension.
        dimension: String,
        /// Reason, as the middle of the sentence.
        why: &'static str,
    },
    /// A motion that ends where it begins, or before.
    #[error("the motion goes from {lower} to {upper}")]
    EmptyMotion {
        /// First value.
        lower: f64,
        /// Last value.
        upper: f64,
    },
    /// An extreme of an extreme.
    #[error("`{characteristic}` is an extreme over a motion itself")]
    ExtremeOfExtreme {
        /// The characteristic.
        characteristic: String,
    },
    /// A unit of an extreme other than that of its characteristic.
    #[error("the unit of the extreme is that of `{characteristic}`, {unit}")]
    ExtremeUnit {
        /// The characteristic.
        characteristic: String,
        /// Unit of the characteristic; a word if it has none.
        unit: String,
    },
    /// A condition on the characteristic itself.
    #[error("`{characteristic}` is given itself")]
    GivenItself {
        /// The characteristic.
        characteristic: String,
    },
    /// Conditions in a circle.
    #[error("{} are given each other", circle(names))]
    GivenCircle {
        /// The characteristics, each of which is given the next. The last one is given the first.
        names: Vec<String>,
    },
    /// A condition without limits.
    #[error("`{characteristic}` has no limits: {role}")]
    NoLimits {
        /// The characteristic.
        characteristic: String,
        /// Use of the limits.
        role: &'static str,
    },
    /// Answers to points that were evaluated elsewhere, where the points are not known beforehand.
    #[error("points evaluated elsewhere cannot answer a study with [[adjust]], `minimum` or `maximum`")]
    EvaluatedElsewhere,
}

impl CompensatorFault {
    /// Text to write instead.
    pub(crate) fn help(&self) -> String {
        match self {
            Self::EmptyStock { .. } => "write values = [0.9, 1.0, 1.1], or step = 0.1 and range = [0.5, 1.5]".into(),
            Self::RepeatedValue { .. } => "leave one of the two out".into(),
            Self::TooManyValues { .. } => "write a coarser step or a narrower range".into(),
            Self::LongStock { .. } => "leave values out".into(),
            Self::AdjustedTwice { .. } => "join their values, or adjust another dimension".into(),
            Self::TargetOutside { .. } => "write a target between the limits".into(),
            Self::NoEffect { .. } => "name a dimension that its formula uses".into(),
            Self::ResponseOfFormula { .. } => "leave `response` out: it is for programs".into(),
            Self::MotionVaries { .. } => "add a dimension without tolerance for the motion to the formula".into(),
            Self::EmptyMotion { .. } => "write the lesser value as `from` and the greater one as `to`".into(),
            Self::ExtremeOfExtreme { .. } => "name the characteristic with the formula".into(),
            Self::ExtremeUnit { .. } => "leave `unit` out".into(),
            Self::GivenItself { .. } => "name another characteristic".into(),
            Self::GivenCircle { .. } => "leave `given` of one of them out".into(),
            Self::NoLimits { .. } => "write lower, upper or both".into(),
            Self::EvaluatedElsewhere => "let sensitol run the program: the points follow from its answers".into(),
        }
    }
}

/// Names of a circle in words: two of them, or the path of more.
fn circle(names: &[String]) -> String {
    match names {
        [first, second] => format!("`{first}` and `{second}`"),
        _ => {
            let path: Vec<String> = names.iter().chain(names.first()).map(|name| format!("`{name}`")).collect();
            path.join(" -> ")
        }
    }
}
