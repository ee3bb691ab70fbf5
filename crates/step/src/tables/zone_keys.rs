//! Keys of tolerances, and which of them the reader of studies takes.

use super::text::number;
use crate::semantic::{GeometricTolerance, MaterialCondition, ToleranceKind, ZoneShape};

/// Keys of features that the reader of studies takes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ReaderKeys {
    /// Frames and diameters. Tolerances and extents are comments.
    #[default]
    Frames,
    /// Tolerances and extents too.
    Zones,
}

impl ReaderKeys {
    /// True if the reader takes the key.
    pub(super) fn takes(self, key: &str) -> bool {
        match self {
            Self::Zones => true,
            // NOTE: this is the only place that decides about keys of tolerances and extents.
            Self::Frames => ["plane", "normal", "axis", "along", "point", "diameter", "frame", "x", "z"].contains(&key),
        }
    }
}

/// A pair of key and text of a value.
pub(super) type KeyText = (&'static str, String);

/// Keys of a kind of tolerance. Returns None if a study has none.
fn key(kind: ToleranceKind) -> Option<&'static str> {
    Some(match kind {
        ToleranceKind::Flatness => "flatness",
        ToleranceKind::SurfaceProfile => "profile",
        ToleranceKind::Angularity => "angularity",
        ToleranceKind::Perpendicularity => "perpendicularity",
        ToleranceKind::Parallelism => "parallelism",
        ToleranceKind::Position => "position",
        ToleranceKind::Concentricity | ToleranceKind::Coaxiality => "coaxiality",
        ToleranceKind::CircularRunout | ToleranceKind::TotalRunout => "runout",
        ToleranceKind::Straightness
        | ToleranceKind::Roundness
        | ToleranceKind::Cylindricity
        | ToleranceKind::LineProfile
        | ToleranceKind::Symmetry
        | ToleranceKind::Other => return None,
    })
}

/// Tolerances that a feature has as keys: all of one datum frame and one material condition.
#[derive(Debug, Clone, Default)]
pub(super) struct FeatureZones {
    pub(super) values: Vec<KeyText>,
    datums: Option<String>,
    condition: Option<MaterialCondition>,
    framed: bool,
    /// Numbers of the entities.
    pub(super) entities: Vec<u64>,
}

impl FeatureZones {
    /// Adds a tolerance. `datums` are the features of its datums, `value` is in the unit of the study.
    ///
    /// # Errors
    /// Returns why the feature cannot have it as a key.
    pub(super) fn add(
        &mut self,
        tolerance: &GeometricTolerance,
        value: f64,
        datums: Option<String>,
        is_axis: bool,
    ) -> Result<(), String> {
        let Some(key) = key(tolerance.kind) else {
            return Err(format!("a study has no key for {}", tolerance.kind.label()));
        };
        if let ZoneShape::Other(name) = &tolerance.zone {
            return Err(format!("a zone `{name}`"));
        }
        if is_axis && key == "position" && tolerance.zone == ZoneShape::Width {
            return Err("a zone between two planes".to_owned());
        }
        if let Some((kind, _)) = tolerance.extra.first() {
            return Err(format!("with {}", kind.to_ascii_lowercase().replace('_', " ")));
        }
        if self.values.iter().any(|(other, _)| *other == key) {
            return Err(format!("the feature has another {key}"));
        }
        // A form has no datums, and joins every frame.
        if tolerance.has_datums || key != "flatness" {
            if self.framed && (self.datums != datums || self.condition != tolerance.condition) {
                return Err("another datum frame than the other tolerances of the feature".to_owned());
            }
            self.framed = true;
            self.datums = datums;
            self.condition = tolerance.condition;
        }
        self.values.push((key, number(value)));
        self.entities.push(tolerance.entity);
        Ok(())
    }

    /// Keys with their values, datums and condition last.
    pub(super) fn keys(&self) -> Vec<KeyText> {
        let mut found = self.values.clone();
        if let Some(datums) = &self.datums {
            found.push(("datums", format!("\"{datums}\"")));
        }
        match self.condition {
            Some(MaterialCondition::Maximum) => found.push(("at", "\"MMC\"".to_owned())),
            Some(MaterialCondition::Least) => found.push(("at", "\"LMC\"".to_owned())),
            None => {}
        }
        found
    }
}
