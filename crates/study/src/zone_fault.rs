//! Faults of zones and floats of an assembly in space.

/// A zone or a float of an assembly in space that says nothing usable.
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
}

impl ZoneFault {
    /// Text to write instead.
    pub(crate) fn help(&self) -> String {
        match self {
            Self::DatumOfItself { .. } => "name other features of the part in datums, or leave datums out".into(),
            Self::DatumCycle { .. } => "measure one of them from a third feature, or leave its datums out".into(),
            Self::IdleDatum { .. } => "leave it out, or name a feature in another direction".into(),
            Self::NoAxis { .. } => "name an axis first, such as datums = \"journal\"".into(),
            Self::AxisMissing { .. } => "name the axis of the part: datums = \"journal\"".into(),
            Self::VaryingDirection { .. } => "write its directions as words or numbers".into(),
            Self::NoRefinement { .. } => "leave it out, or write a tighter zone".into(),
        }
    }
}
