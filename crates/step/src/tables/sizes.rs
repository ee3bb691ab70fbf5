//! Lines of `[dimensions]`.

use super::text::number;
use super::{TableRequest, UniqueNames};
use crate::semantic::{DimensionKind, DimensionLimits, StepDimension, StepMeasure, StepUnit};

/// Unit of the study.
#[derive(Debug, Clone, Copy)]
pub(super) struct StudyUnit<'u> {
    pub(super) name: &'u str,
    pub(super) metres: f64,
}

impl StudyUnit<'_> {
    /// Value in the unit of the study, or in degrees.
    pub(super) fn value(&self, measure: &StepMeasure) -> f64 {
        match measure.unit {
            StepUnit::Length(scale) => measure.value * (scale / self.metres),
            StepUnit::Angle(scale) => measure.value * scale.to_degrees(),
            StepUnit::Other => measure.value,
        }
    }

    fn name(&self, measure: &StepMeasure) -> &str {
        match measure.unit {
            StepUnit::Angle(_) => "deg",
            _ => self.name,
        }
    }
}

/// Pairs that state the tolerance of a dimension. Returns an error with the reason for a comment.
fn limits(
    dimension: &StepDimension,
    nominal: f64,
    unit: StudyUnit<'_>,
    request: &TableRequest,
) -> Result<Option<String>, String> {
    let band = |low: f64, high: f64| {
        let [low, high] = [low.min(high), low.max(high)];
        match (low + high).abs() < 1e-9 {
            true => format!("tolerance = {}", number(high)),
            false => format!("tolerance = [{}, {}]", number(low), number(high)),
        }
    };
    match &dimension.limits {
        DimensionLimits::Deviations([low, high]) => {
            let [low, high] = [unit.value(low), unit.value(high)];
            if low == high {
                return Err("its deviations are equal".to_owned());
            }
            Ok(Some(band(low, high)))
        }
        DimensionLimits::Values([low, high]) => {
            let [low, high] = [unit.value(low), unit.value(high)];
            if low == high {
                return Err("its limits are equal".to_owned());
            }
            Ok(Some(band(low - nominal, high - nominal)))
        }
        DimensionLimits::Fit(class) => {
            let millimetres = nominal * unit.metres * 1e3;
            let is_plain = class.chars().all(|c| c.is_ascii_alphanumeric());
            match is_plain && request.fit_is_known.is_none_or(|is_known| is_known(millimetres, class)) {
                true => Ok(Some(format!("fit = \"{class}\""))),
                false => Err(format!("tolerance class `{}` is not in the tables", super::text::comment(class))),
            }
        }
        DimensionLimits::Exact => Err("theoretically exact".to_owned()),
        DimensionLimits::Reference => Err("for reference".to_owned()),
        DimensionLimits::Maximum(_) => Err("a greatest value alone".to_owned()),
        DimensionLimits::Minimum(_) => Err("a least value alone".to_owned()),
        DimensionLimits::None => Ok(None),
    }
}

/// Last part of the name of a dimension.
pub(super) fn suffix(kind: DimensionKind) -> &'static str {
    match kind {
        DimensionKind::Diameter => "diameter",
        DimensionKind::Radius => "radius",
        DimensionKind::Angle => "angle",
        DimensionKind::Length => "length",
    }
}

/// Line of a dimension, and its name unless it is a comment.
pub(super) fn line(
    dimension: &StepDimension,
    wanted: &str,
    unit: StudyUnit<'_>,
    request: &TableRequest,
    names: &mut UniqueNames,
) -> (String, Option<String>) {
    let id = dimension.entity;
    let Some(value) = &dimension.value else {
        return (format!("# {wanted}: no value in the file (#{id})"), None);
    };
    let nominal = unit.value(value);
    let of = unit.name(value);
    match limits(dimension, nominal, unit, request) {
        Ok(limits) => {
            let name = names.take(wanted);
            let note = if limits.is_none() { ", no tolerance in the file" } else { "" };
            let limits = limits.map(|text| format!(", {text}")).unwrap_or_default();
            let line = format!("{name} = {{ nominal = {}{limits}, unit = \"{of}\" }}  # #{id}{note}", number(nominal));
            (line, Some(name))
        }
        Err(reason) => (format!("# {wanted} = {} {of}: {reason} (#{id})", number(nominal)), None),
    }
}
