//! Remedies for the faults of a study: actions to take, and texts to write instead.

use crate::entries::vocabulary::{ADJUSTMENTS, CORRELATIONS, SOLIDS};
use crate::error::StudyFault;
use crate::typing_habits::{TypingHabit, percent};
use sensitol::allocation::CostError;
use sensitol::assembly::implicit::ConditionsError;
use sensitol::warning::Advice;
use sensitol_numeric::characteristic::LimitsError;
use sensitol_numeric::dimension::DimensionFault;
use sensitol_numeric::distribution::DistributionError;
use sensitol_numeric::inspection::InspectionError;
use sensitol_numeric::requirement::RequirementError;

/// Keys of other programs, with the advice and the key that it needs.
const KEYS: [(&[&str], &str, &str); 7] = [
    (
        &["lsl", "min", "minimum", "lower_limit", "lower_bound", "low", "utg", "usg"],
        "lower",
        "the lower limit is `lower`",
    ),
    (
        &["usl", "max", "maximum", "upper_limit", "upper_bound", "high", "otg", "osg"],
        "upper",
        "the upper limit is `upper`",
    ),
    (&["lsl", "usl", "min", "max", "lower", "upper"], "limits", "write limits = [lower, upper]"),
    (&["tol", "plus_minus", "plusminus", "half_band", "toleranz"], "tolerance", "the half band is `tolerance`"),
    (&["std", "sd", "stddev", "std_dev", "standard_deviation"], "sigma", "the standard deviation is `sigma`"),
    (&["dist", "law"], "distribution", "the kind of distribution is `distribution`"),
    (&["value", "nom", "mean", "nennmass"], "nominal", "the value on the drawing is `nominal`"),
];
/// Names of distributions in other programs, by the name of the kind here.
const DISTRIBUTIONS: [(&[&str], &str); 4] = [
    (&["gauss", "gaussian", "norm", "normalverteilung"], "normal"),
    (&["rectangular", "rect", "flat", "gleichverteilung"], "uniform"),
    (&["triangle", "simpson"], "triangular"),
    (&["log-normal", "lognorm"], "lognormal"),
];

/// Advice on a key of another program. Returns None if none of the valid keys is likely.
fn key_of(key: &str, valid: &[String]) -> Option<&'static str> {
    let key = key.to_lowercase();
    let fits = |(keys, known, _): &&(&[&str], &str, &str)| {
        keys.contains(&key.as_str()) && valid.iter().any(|valid| valid == known)
    };
    KEYS.iter().find(fits).map(|(_, _, advice)| *advice)
}

/// Kind of distribution that another program names so.
fn distribution_of(found: &str) -> Option<&'static str> {
    let found = found.to_lowercase();
    DISTRIBUTIONS.iter().find(|(names, _)| names.contains(&found.as_str())).map(|(_, kind)| *kind)
}

impl StudyFault {
    /// Actions to take, besides changing the text of the study.
    pub fn advice(&self) -> Vec<Advice> {
        if let Self::Method(error) = self { error.advice() } else { Vec::new() }
    }

    /// Text to write instead. Returns None if no general advice exists.
    pub(crate) fn help(&self) -> Option<String> {
        // No fault has help in more than one of these.
        self.text_help()
            .or_else(|| self.dimension_help())
            .or_else(|| self.joint_help())
            .or_else(|| self.requirement_help())
            .or_else(|| self.formula_help())
    }

    /// The help on files, keys and names.
    fn text_help(&self) -> Option<String> {
        let meant = |name: &String| format!("did you mean `{name}`?");
        let one_of = |known: &[String]| format!("it is one of {}", known.join(", "));
        match self {
            Self::IsFolder { within: Some(study) } => Some(format!("did you mean {study}?")),
            Self::UnknownFormat { beside: Some(study), .. } => Some(format!("did you mean {study}?")),
            Self::WrongType { expected, .. } if expected == CORRELATIONS => {
                Some("write three lines for each pair:\n[[correlation]]\nbetween = [\"a\", \"b\"]\nvalue = 0.9".into())
            }
            Self::WrongType { expected, .. } if expected == ADJUSTMENTS => {
                Some("write a table for each:\n[[adjust]]\ndimension = \"shim\"\nvalues = [0.9, 1.0, 1.1]\nto = \"gap\"\ntarget = 0.1".into())
            }
            Self::Syntax { slip, .. } => slip.as_ref().map(ToString::to_string),
            Self::WrongType { expected, found } => TypingHabit::of_value(expected, found).map(|slip| slip.to_string()),
            Self::IsFolder { within: None } => Some("name the study file in it".into()),
            Self::UnknownFormat { table: true, .. } => {
                Some("a table becomes a study by `sensitol import`, and `sensitol analyze` reads it as it is".into())
            }
            Self::UnknownKey { key, valid, .. } if key_of(key, valid).is_some() => {
                key_of(key, valid).map(str::to_owned)
            }
            Self::UnknownWord { what: "distribution", found, .. } if distribution_of(found).is_some() => {
                distribution_of(found).map(|kind| format!("write \"{kind}\""))
            }
            Self::UnknownKey { nearest: Some(name), .. } | Self::UnknownWord { nearest: Some(name), .. } => {
                Some(meant(name))
            }
            Self::UnknownKey { valid, .. } if valid.is_empty() => None,
            Self::UnknownKey { valid, .. } => Some(format!("keys are {}", valid.join(", "))),
            Self::UnknownWord { known, .. } if known.is_empty() => None,
            Self::UnknownWord { known, .. } => Some(one_of(known)),
            Self::UnknownInput { nearest, known, .. } => {
                let nearest = nearest.as_ref().map(|name| format!("did you mean `{name}`? ")).unwrap_or_default();
                Some(format!("{nearest}its inputs are {}", known.join(", ")))
            }
            Self::MissingKey { instead, .. } => Some(instead.clone()),
            Self::DoesNotApply { instead, .. } => Some((*instead).to_owned()),
            Self::Data(fault) => fault.problem.help(),
            Self::ProcessFile { fault, .. } => fault.help(),
            Self::GroupName { name, .. } => {
                Some(format!("write sum({name}): the sum of its parts, not their number times one"))
            }
            Self::ReservedName { .. } => Some("choose another name".into()),
            Self::UnknownConfigured { nearest: Some(name), .. } => Some(format!("nearest: `{name}`")),
            Self::UnknownConfigured { known, .. } => Some(one_of(known)),
            Self::ConfiguredLimits { .. } => Some("write tolerance or fit in place of limits".into()),
            Self::ReservedConfiguration => Some("choose another name".into()),
            Self::NameTaken { .. } => Some("one of the two needs another name".into()),
            Self::Nothing { what: "dimension" } => {
                Some("write one a line below [dimensions], such as `a = { nominal = 10.0, tolerance = 0.3 }`".into())
            }
            Self::Nothing { .. } => Some(
                "write one a line below [characteristics], such as `gap = { formula = \"a - b\", lower = 0.1 }`".into(),
            ),
            _ => None,
        }
    }

    /// The help on values and tolerances of dimensions.
    fn dimension_help(&self) -> Option<String> {
        match self {
            Self::NotFinite { .. } => Some("write a finite number, or leave out a limit that does not exist".into()),
            Self::Swapped { lower, upper } if lower > upper => Some(format!("write [{upper}, {lower}]")),
            Self::Swapped { .. } => Some("a value that does not vary needs no tolerance".into()),
            Self::Dimension(DimensionFault::NegativeTolerance { value }) => {
                Some(format!("write {} for a band on both sides, [{value}, 0] for one below", -value))
            }
            Self::Dimension(DimensionFault::Unresolvable { .. }) => {
                Some("measure from a nearer datum, or leave the tolerance out".into())
            }
            Self::Fit(error) => error.help(),
            Self::Dimension(DimensionFault::Distribution(
                DistributionError::InfiniteMoment { .. } | DistributionError::Pearson(_),
            )) => Some("leave model out: the values themselves have all moments".into()),
            Self::SameAsItself { .. } => Some("name another dimension, or write a model or processes".into()),
            Self::SameAsChain { end, .. } => {
                Some(format!("write same_as = \"{end}\" where that has a cost, or give one of them a cost"))
            }
            Self::FromCircle { .. } => Some("measure one of them from a datum: leave out its `from`".into()),
            Self::NoMaterial { .. } => Some("write its tolerance, limits or fit".into()),
            Self::NothingFloats { .. } => Some("swap them, or write the clearance yourself: max(0, hole - pin)".into()),
            Self::LengthBelowZone { .. } => Some("write the length over which the zone holds, in its unit".into()),
            Self::FastenerPair { key, .. } => {
                let names = if key == "holes" { "[\"d1\", \"d2\"]" } else { "[\"hole_place\", \"thread\"]" };
                Some(format!("write {key} = {names}"))
            }
            _ => None,
        }
    }

    /// The help on dimensions that vary together.
    fn joint_help(&self) -> Option<String> {
        match self {
            Self::CorrelationOfRows { .. } => Some("leave it out, or write joint = false at one of the two".into()),
            Self::CorrelationInZone { .. } => Some("leave it out, or leave [[joint]] out".into()),
            Self::JointCount { law: Some(law), .. } if SOLIDS.contains(&law.as_str()) => {
                Some("write of = [\"x\", \"y\", \"z\"]".into())
            }
            Self::JointCount { .. } => Some("write of = [\"x\", \"y\"]".into()),
            Self::JointTwice { .. } => Some("a dimension is of one block".into()),
            Self::JointFile { .. } => Some(
                "leave `measured` of the dimension out, or give it a number of the part: match = \"serial\"".into(),
            ),
            Self::JointBand { .. } => Some("write its tolerance".into()),
            Self::JointDistribution { .. } => Some("leave it out".into()),
            Self::CorrelationBesideRows { inside, .. } => {
                Some(format!("leave the pair out, or write joint = false at `{inside}`"))
            }
            _ => None,
        }
    }

    /// The help on limits, requirements and costs.
    fn requirement_help(&self) -> Option<String> {
        match self {
            Self::Limits(LimitsError::ImpossibleYield { value }) if *value > 1.0 && *value <= 100.0 => {
                Some(format!("write {} for {value} %", percent(*value)))
            }
            Self::Limits(LimitsError::Swapped { .. }) | Self::Cost(CostError::Swapped { .. }) => {
                Some("exchange them".into())
            }
            Self::Cost(CostError::NoProcess) => {
                Some("write some, such as { name = \"grind\", tolerance = 0.002, cost = 19.4 }".into())
            }
            Self::Cost(CostError::Rising { .. }) => {
                Some("leave out the dearer process that holds less, or correct its cost".into())
            }
            Self::Inspection(InspectionError::NoLimits) | Self::Requirement(RequirementError::NoLimits { .. }) => {
                Some("write lower, upper or both".into())
            }
            Self::Requirement(RequirementError::ImpossibleYield { value }) if *value >= 1.0 => {
                Some("only a worst case promises that: require = \"worst-case\"".into())
            }
            _ => None,
        }
    }

    /// The help on formulas, conditions and units.
    fn formula_help(&self) -> Option<String> {
        match self {
            Self::Spatial(error) => Some(error.help()),
            Self::Zone(found) => Some(found.help()),
            Self::Compensator(found) => Some(found.help()),
            Self::Conditions(ConditionsError::Unbalanced { .. }) => Some(
                "as many equations as unknowns are needed; a loop counts for two, one along x and one along y".into(),
            ),
            Self::Conditions(ConditionsError::EmptyLoop { .. }) => Some(
                "write its vectors, such as [ { length = \"a\", angle = 0 }, { length = \"b\", angle = \"phi\" } ]"
                    .into(),
            ),
            Self::Conditions(ConditionsError::Undetermined { .. }) => {
                Some("use it in an equation or a loop, or write it as a constant".into())
            }
            Self::Formula(fault) => fault.help(),
            Self::Units { remedy, .. } => Some(remedy.clone()),
            Self::DimensionAndFormula { .. } => Some("leave one out".into()),
            Self::DrivenByOutput { .. } => Some("use dimensions, constants and other formulas".into()),
            Self::IdleFormula { .. } => Some("name it in [model] inputs, or leave it out".into()),
            _ => None,
        }
    }
}
