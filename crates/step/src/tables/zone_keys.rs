//! Keys of tolerances, and which of them the reader of studies takes.

use super::cluster::{FeatureShape, SAME_DIRECTION};
use super::text::number;
use crate::semantic::{GeometricTolerance, MaterialCondition, ToleranceKind, ZoneShape, cross, dot};

/// Keys of features that the reader of studies takes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ReaderKeys {
    /// Frames and diameters. Tolerances and extents are comments.
    Frames,
    /// Tolerances and extents too.
    #[default]
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

/// Group of tolerances, of which a feature has at most one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ZoneGroup {
    /// Place: position, profile, and places about a datum axis.
    Place,
    /// Direction.
    Orientation,
    /// Form, which needs no datum.
    Form,
}

/// Key of a kind of tolerance, and its group. Returns None if a study has none.
fn key(kind: ToleranceKind) -> Option<(&'static str, ZoneGroup)> {
    use ZoneGroup::{Form, Orientation, Place};
    Some(match kind {
        ToleranceKind::Position => ("position", Place),
        ToleranceKind::SurfaceProfile => ("profile", Place),
        ToleranceKind::Coaxiality => ("coaxiality", Place),
        ToleranceKind::Concentricity => ("concentricity", Place),
        ToleranceKind::CircularRunout => ("runout", Place),
        ToleranceKind::TotalRunout => ("total_runout", Place),
        ToleranceKind::Angularity => ("angularity", Orientation),
        ToleranceKind::Perpendicularity => ("perpendicularity", Orientation),
        ToleranceKind::Parallelism => ("parallelism", Orientation),
        ToleranceKind::Flatness => ("flatness", Form),
        ToleranceKind::Straightness => ("straightness", Form),
        ToleranceKind::Roundness => ("roundness", Form),
        ToleranceKind::Cylindricity => ("cylindricity", Form),
        ToleranceKind::LineProfile | ToleranceKind::Symmetry | ToleranceKind::Other => return None,
    })
}

/// Rank of a tolerance among those of a feature: places before the directions that refine them. Kinds without a key are first.
pub(super) fn rank(tolerance: &GeometricTolerance) -> Option<ZoneGroup> {
    let (_, group) = key(tolerance.kind)?;
    Some(if tolerance.upper.is_some() { group.max(ZoneGroup::Orientation) } else { group })
}

/// Key and group of a tolerance of a feature. The lower segment of a composite frame bounds the direction of a feature, or its form if it
/// names no datum. `datum` is the shape of the first datum.
///
/// # Errors
/// Returns why a study has no key.
fn key_of(
    tolerance: &GeometricTolerance,
    shape: &FeatureShape,
    datum: Option<&FeatureShape>,
) -> Result<(&'static str, ZoneGroup), String> {
    let Some((own, group)) = key(tolerance.kind) else {
        return Err(format!("a study has no key for {}", tolerance.kind.label()));
    };
    if !fits(own, shape) {
        return Err(format!("a study has no {} of {}", tolerance.kind.label(), words(shape)));
    }
    if tolerance.upper.is_none() || group != ZoneGroup::Place {
        return Ok((own, group));
    }
    if tolerance.condition.is_some() {
        return Err("a direction at a material condition".to_owned());
    }
    match (own, datum) {
        ("profile", None) => Ok(("flatness", ZoneGroup::Form)),
        ("profile" | "position", Some(datum)) => match orientation(shape, datum) {
            Some(key) => Ok((key, ZoneGroup::Orientation)),
            None => Err("a point has no direction".to_owned()),
        },
        _ => Err("the places of features to each other".to_owned()),
    }
}

/// Key of the orientation of a feature to a datum. Returns None if one of them is a point.
fn orientation(shape: &FeatureShape, datum: &FeatureShape) -> Option<&'static str> {
    let direction = |shape: &FeatureShape| match shape {
        FeatureShape::Plane { normal, .. } => Some((*normal, true)),
        FeatureShape::Axis { along, .. } => Some((*along, false)),
        FeatureShape::Point { .. } => None,
    };
    let ((own, is_plane), (other, is_plane_too)) = (direction(shape)?, direction(datum)?);
    let (along, turned) = (dot(own, other), cross(own, other));
    // The normal of a plane stands across the plane.
    let (parallel, perpendicular) = match is_plane == is_plane_too {
        true => ("parallelism", "perpendicularity"),
        false => ("perpendicularity", "parallelism"),
    };
    Some(match (dot(turned, turned).sqrt() < SAME_DIRECTION, along.abs() < SAME_DIRECTION) {
        (true, _) => parallel,
        (_, true) => perpendicular,
        _ => "angularity",
    })
}

/// True if a shape can have a key.
fn fits(key: &str, shape: &FeatureShape) -> bool {
    match shape {
        FeatureShape::Plane { .. } => !matches!(key, "coaxiality" | "concentricity" | "roundness" | "cylindricity"),
        FeatureShape::Axis { .. } => !matches!(key, "profile" | "flatness"),
        FeatureShape::Point { .. } => {
            matches!(key, "position" | "coaxiality" | "concentricity" | "runout" | "total_runout" | "roundness")
        }
    }
}

/// Words for a shape.
fn words(shape: &FeatureShape) -> &'static str {
    match shape {
        FeatureShape::Plane { .. } => "a plane",
        FeatureShape::Axis { .. } => "an axis",
        FeatureShape::Point { .. } => "a point",
    }
}

/// Datums of a tolerance that its feature can have.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct DatumNames {
    /// Indices of the features.
    pub(super) features: Vec<usize>,
    /// Names, in their order.
    pub(super) text: String,
    /// True if one of them is an axis.
    pub(super) has_axis: bool,
}

/// A tolerance as a key.
#[derive(Debug, Clone)]
struct ZoneKey {
    key: &'static str,
    group: ZoneGroup,
    value: f64,
    /// Key and name of the size that gives a bonus.
    bonus: Option<(MaterialCondition, &'static str, String)>,
    /// Datums of an orientation that are not those of the feature.
    datums: Option<DatumNames>,
}

/// Tolerances that a feature has as keys: at most one of each group, and all of one datum frame.
#[derive(Debug, Clone, Default)]
pub(super) struct FeatureZones {
    zones: Vec<ZoneKey>,
    datums: Option<DatumNames>,
    /// Numbers of the entities.
    pub(super) entities: Vec<u64>,
}

impl FeatureZones {
    /// Features from which this one is measured.
    pub(super) fn datum_features(&self) -> impl Iterator<Item = usize> {
        let own = self.zones.iter().filter_map(|zone| zone.datums.as_ref());
        own.chain(&self.datums).flat_map(|datums| datums.features.iter().copied())
    }

    /// Adds a tolerance. `value` and the shape of the feature are in the unit of the study, and the second shape is that of the first datum. `size` is the key and the name of the dimension of the diameter.
    ///
    /// # Errors
    /// Returns why the feature cannot have it as a key.
    pub(super) fn add(
        &mut self,
        tolerance: &GeometricTolerance,
        value: f64,
        datums: Option<DatumNames>,
        (shape, datum): (&FeatureShape, Option<&FeatureShape>),
        size: Option<(&'static str, String)>,
    ) -> Result<(), String> {
        let (key, group) = key_of(tolerance, shape, datum)?;
        // The runout of a face tilts it by its diameter, which the extents of a face do not tell.
        if matches!(key, "runout" | "total_runout") && matches!(shape, FeatureShape::Plane { .. }) {
            return Err("the runout of a face needs its diameter".to_owned());
        }
        if let ZoneShape::Other(name) = &tolerance.zone {
            return Err(format!("a zone `{}`", super::text::comment(name)));
        }
        let is_axis = matches!(shape, FeatureShape::Axis { .. });
        let is_round = !matches!(key, "runout" | "total_runout" | "concentricity") && group != ZoneGroup::Form;
        if is_axis && is_round && tolerance.zone == ZoneShape::Width {
            return Err("a zone between two planes".to_owned());
        }
        if let Some((kind, _)) = tolerance.extra.first() {
            return Err(format!("with {}", kind.to_ascii_lowercase().replace('_', " ")));
        }
        if let Some(other) = self.zones.iter().find(|other| other.group == group) {
            return Err(match other.key == key {
                true => format!("the feature has another {key}"),
                false => format!("the feature has {} already", other.key),
            });
        }
        let bonus = match (tolerance.condition, size) {
            (None, _) => None,
            (Some(condition), Some((size_key, size))) if is_axis && key == "position" => {
                Some((condition, size_key, size))
            }
            (Some(_), _) => return Err("at a material condition without a size that varies".to_owned()),
        };
        self.check_extent(group, value, shape)?;
        self.check_datums(key, group, datums.as_ref(), shape)?;
        // A form has no datums, and joins every frame. An orientation that refines a place may have datums of its own.
        let own = match group {
            ZoneGroup::Form => None,
            ZoneGroup::Orientation if self.is_placed() => datums.filter(|datums| self.datums.as_ref() != Some(datums)),
            ZoneGroup::Orientation | ZoneGroup::Place => {
                self.datums = datums;
                None
            }
        };
        self.zones.push(ZoneKey { key, group, value, bonus, datums: own });
        self.entities.push(tolerance.entity);
        Ok(())
    }

    fn is_placed(&self) -> bool {
        self.zones.iter().any(|zone| zone.group == ZoneGroup::Place)
    }

    /// Checks that a zone is not wider than its feature, and that a direction refines a place.
    fn check_extent(&self, group: ZoneGroup, value: f64, shape: &FeatureShape) -> Result<(), String> {
        let extent = match shape {
            FeatureShape::Plane { size, .. } => size.map(|[a, b]| a.min(b)),
            FeatureShape::Axis { length, .. } => *length,
            FeatureShape::Point { .. } => return Ok(()),
        };
        let extent = extent.filter(|extent| *extent > 0.0);
        match (group, extent) {
            (ZoneGroup::Orientation, None) => return Err("the feature has no extent".to_owned()),
            (ZoneGroup::Orientation | ZoneGroup::Place, Some(extent)) if value > extent => {
                return Err("the zone is wider than the feature".to_owned());
            }
            _ => {}
        }
        let place = self.zones.iter().find(|zone| zone.group == ZoneGroup::Place && zone.bonus.is_none());
        match (group, place) {
            (ZoneGroup::Orientation, Some(place)) if value >= place.value => {
                Err(format!("{} {} bounds it already", place.key, number(place.value)))
            }
            _ => Ok(()),
        }
    }

    /// Checks that all tolerances have one datum frame, and that a place about an axis has one.
    fn check_datums(
        &self,
        key: &str,
        group: ZoneGroup,
        datums: Option<&DatumNames>,
        shape: &FeatureShape,
    ) -> Result<(), String> {
        if group == ZoneGroup::Form {
            return Ok(());
        }
        let is_framed = self.zones.iter().any(|zone| zone.group != ZoneGroup::Form);
        let has_own = group == ZoneGroup::Orientation && datums.is_some() && self.is_placed();
        if is_framed && !has_own && self.datums.as_ref() != datums {
            return Err("another datum frame than the other tolerances of the feature".to_owned());
        }
        let about_axis = matches!(key, "coaxiality" | "concentricity" | "runout" | "total_runout");
        let needs_axis = datums.is_some() || !matches!(shape, FeatureShape::Axis { .. });
        if about_axis && needs_axis && !datums.is_some_and(|datums| datums.has_axis) {
            return Err("its datums have no axis".to_owned());
        }
        Ok(())
    }

    /// Keys with their values, datums last.
    pub(super) fn keys(&self) -> Vec<KeyText> {
        let text = |zone: &ZoneKey| match &zone.bonus {
            None => match &zone.datums {
                None => number(zone.value),
                Some(datums) => format!("{{ zone = {}, datums = \"{}\" }}", number(zone.value), datums.text),
            },
            Some((condition, key, size)) => {
                let at = match condition {
                    MaterialCondition::Maximum => "MMC",
                    MaterialCondition::Least => "LMC",
                };
                format!("{{ zone = {}, at = \"{at}\", {key} = \"{size}\" }}", number(zone.value))
            }
        };
        let mut found: Vec<KeyText> = self.zones.iter().map(|zone| (zone.key, text(zone))).collect();
        found.extend(self.datums.iter().map(|datums| ("datums", format!("\"{}\"", datums.text))));
        found
    }
}
