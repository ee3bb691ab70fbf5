//! Faults of zones and floats of an assembly in space.

use std::fmt;

/// A zone or a float of an assembly in space that is not usable.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ZoneFault {
    /// A feature that is its own datum.
    #[error("`{feature}` is its own datum")]
    DatumOfItself {
        /// The feature.
        feature: String,
    },
    /// Features that are measured from each other.
    #[error("`{feature}` and `{datum}` are measured from each other")]
    DatumCycle {
        /// The feature.
        feature: String,
        /// Datum of the feature, whose zone is measured from the feature.
        datum: String,
    },
    /// A datum that takes no freedom.
    #[error("datum `{datum}` fixes nothing that {} not fixed", before.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and ") + if before.len() == 1 { " has" } else { " have" })]
    IdleDatum {
        /// The datum.
        datum: String,
        /// Datums before it.
        before: Vec<String>,
    },
    /// Two features that make no common datum.
    #[error("`{}` and `{}` make no common datum: {why}", names[0], names[1])]
    NoCommonDatum {
        /// The two features.
        names: [String; 2],
        /// Reason.
        why: CommonDatumFault,
    },
    /// A datum of the wrong kind.
    #[error("`{zone}` is measured from an axis, and datum `{datum}` is a {kind}")]
    NoAxis {
        /// Key of the zone.
        zone: &'static str,
        /// The datum.
        datum: String,
        /// Kind of the datum, in words.
        kind: &'static str,
    },
    /// A zone that needs an axis as datum and has none.
    #[error("`{zone}` of a {kind} is measured from an axis, and it names no datum")]
    AxisMissing {
        /// Key of the zone.
        zone: &'static str,
        /// Kind of the feature, in words.
        kind: &'static str,
    },
    /// A direction that is a formula, where a lever arm needs a fixed one.
    #[error("`{feature}` has a direction that varies, and zones are carried from a datum by fixed directions")]
    VaryingDirection {
        /// The feature.
        feature: String,
    },
    /// An orientation zone that is as wide as the zone of the place.
    #[error("`{orientation}` {tight} refines nothing: `{location}` {wide} bounds the tilt already")]
    NoRefinement {
        /// Key of the orientation zone.
        orientation: &'static str,
        /// Width of the orientation zone.
        tight: f64,
        /// Key of the zone of the place.
        location: &'static str,
        /// Width of the zone of the place.
        wide: f64,
    },
    /// A cost of a feature that has no zone.
    #[error("`{feature}` has a cost and no zone")]
    CostWithoutZone {
        /// The feature.
        feature: String,
    },
    /// A cost of a feature with several zones.
    #[error("`{feature}` has a cost and several zones: {}", quoted(zones))]
    CostOfSeveral {
        /// The feature.
        feature: String,
        /// Keys of the zones.
        zones: Vec<&'static str>,
    },
    /// A cost of a zone that the feature does not have.
    #[error("`{feature}` has no `{zone}`, and its cost has")]
    CostOfMissing {
        /// The feature.
        feature: String,
        /// Key of the zone.
        zone: String,
        /// Keys of the zones that there are.
        zones: Vec<&'static str>,
    },
    /// A zone with two lines of costs.
    #[error("`{zone}` has two costs, and `{other}` is the first")]
    TwoCosts {
        /// The zone.
        zone: String,
        /// Line of the first cost.
        other: String,
    },
    /// A cost of a zone that moves nothing.
    #[error("`{zone}` has a cost and moves nothing")]
    CostOfIdle {
        /// The zone.
        zone: String,
    },
    /// A cost of a zone whose width is a formula.
    #[error("`{zone}` has a cost, and its width is a formula")]
    CostOfFormula {
        /// The zone.
        zone: String,
    },
    /// A cost of a zone whose dimensions do not follow its width by numbers alone.
    #[error("`{zone}` has a cost, and a length or a place that its width is divided by is a formula")]
    CostOfFormulaArm {
        /// The zone.
        zone: String,
    },
    /// A cost of a zone of width 0.
    #[error("`{zone}` has a cost and the width 0")]
    CostOfNothing {
        /// The zone.
        zone: String,
    },
    /// A datum target beyond the extents of its face.
    #[error("target {target} of `{face}` lies at [{}, {}], outside of its size [{}, {}]", at[0], at[1], size[0], size[1])]
    TargetOutside {
        /// Number of the target, from 1.
        target: usize,
        /// Full name of the face.
        face: String,
        /// Place of the target from the middle of the face, along x and y.
        at: [f64; 2],
        /// Extents of the face along x and y.
        size: [f64; 2],
    },
    /// A cost of a zone that is not about the nominal place.
    #[error("`{zone}` has a cost, and its places are not about the nominal one")]
    CostOfUneven {
        /// The zone.
        zone: String,
    },
    /// Bounds of a cost with which an orientation could be wider than the location that it refines.
    #[error("{choice} lets {}", beyond(*is_inner, (inner, outer), *bound))]
    CostBeyondRefinement {
        /// Choice of the cost that breaks the refinement.
        choice: RefinedChoice,
        /// True if the orientation has the cost, false if the location has it.
        is_inner: bool,
        /// Key of the orientation.
        inner: &'static str,
        /// Key of the location.
        outer: &'static str,
        /// Half of the zone without a cost.
        bound: f64,
    },
}

/// Reason why two features make no common datum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CommonDatumFault {
    /// Features of other kinds than two axes or two planes.
    #[error("they are not two axes or two planes")]
    Kinds,
    /// Directions that differ.
    #[error("their directions are not parallel")]
    Directions,
    /// Axes beside each other.
    #[error("their axes are not one line")]
    Line,
    /// Middles at one place, or over each other.
    #[error("their middles are not apart")]
    Middles,
    /// Places that are formulas across the direction.
    #[error("their places across their direction are different formulas")]
    Formula,
}

/// Part of a cost that allows a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub enum RefinedChoice {
    /// Bound of the tolerance.
    Bound {
        /// Key of the bound.
        key: &'static str,
        /// Bound as written.
        given: f64,
    },
    /// Table without a point that keeps the refinement.
    Table {
        /// Half width of the point nearest to the other zone.
        near: f64,
    },
    /// Process of a list.
    Process {
        /// Name of the process.
        name: String,
        /// Half width as written.
        given: f64,
    },
}

impl fmt::Display for RefinedChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bound { key, given } => write!(f, "{key} = {given}"),
            Self::Table { near } => write!(f, "every point of the table, the nearest at {near},"),
            Self::Process { name, given } => write!(f, "the process `{name}` of {given}"),
        }
    }
}

/// Excess of an orientation over its location, in words.
fn beyond(is_inner: bool, (inner, outer): (&str, &str), bound: f64) -> String {
    match is_inner {
        true => format!("`{inner}` exceed `{outer}` (half width {bound})"),
        false => format!("`{inner}` (half width {bound}) exceed `{outer}`"),
    }
}

/// Names in backquotes.
fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

impl ZoneFault {
    /// Text to write instead.
    pub(crate) fn help(&self) -> String {
        match self {
            Self::DatumOfItself { .. } => "name other features of the part in datums, or leave datums out".into(),
            Self::DatumCycle { .. } => "measure one of them from a third feature, or leave its datums out".into(),
            Self::IdleDatum { .. } => "leave it out, or name a feature in another direction".into(),
            Self::NoCommonDatum { names: [a, b], .. } => format!("write them as two datums: \"{a} {b}\""),
            Self::NoAxis { .. } => "name an axis first, such as datums = \"journal\"".into(),
            Self::AxisMissing { .. } => "name the axis of the part: datums = \"journal\"".into(),
            Self::VaryingDirection { .. } => "write its directions as words or numbers".into(),
            Self::NoRefinement { .. } => "leave it out, or write a tighter zone".into(),
            Self::TargetOutside { size: [x, y], .. } => {
                format!(
                    "places start at the middle of the face: write x within ±{} and y within ±{}",
                    0.5 * x.abs(),
                    0.5 * y.abs()
                )
            }
            Self::CostWithoutZone { feature } => {
                format!("give `{feature}` a zone such as position = 0.1, or the cost to a dimension")
            }
            Self::CostOfSeveral { feature, zones } => format!("name one of them: \"{feature}.{}\"", zones[0]),
            Self::CostOfMissing { feature, zones, .. } => match zones[..] {
                [] => format!("give `{feature}` the zone, or leave the cost out"),
                _ => format!("it has {}: write \"{feature}.{}\"", quoted(zones), zones[0]),
            },
            Self::TwoCosts { .. } => "keep one of them".into(),
            Self::CostOfIdle { .. } => "leave the cost out, or name a joint that touches the feature".into(),
            Self::CostOfFormula { .. } => "give the cost to the dimension, or write the width as a number".into(),
            Self::CostOfFormulaArm { .. } => {
                "write the length of the feature, or the places of the pattern across its axes, as numbers".into()
            }
            Self::CostOfNothing { .. } => "write the present width, from which to start".into(),
            Self::CostOfUneven { .. } => "leave the cost out, or write an even zone without `outward` or `side`".into(),
            Self::CostBeyondRefinement { choice, is_inner, bound, .. } => match choice {
                RefinedChoice::Bound { key, .. } => {
                    format!("write {key} = {bound}, or give the other zone a cost too")
                }
                RefinedChoice::Table { .. } => {
                    let side = if *is_inner { "at most" } else { "at least" };
                    format!("write a point of {side} {bound}, or give the other zone a cost too")
                }
                RefinedChoice::Process { .. } => "leave it out, or give the other zone a cost too".into(),
            },
        }
    }
}
