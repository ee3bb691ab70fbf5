//! Default costs if none are given: a tolerance that is harder to hold costs more.
//!
//! ```text
//! C_j = i_j/T_j           i_j: the tolerance unit of ISO 286-1 for the size, in the unit of the dimension
//! C_j = T_j0/T_j          where there is no size that has one: angles, forces, a nominal value of 0; T_j0: the half band as written
//! ```
//!
//! A third way fixes the proportions and leaves one factor. Either the grade is the same everywhere, `T_j = k i_j`
//! (constant precision: K. W. Chase, W. H. Greenwood, Manufacturing Review 1 (1988)), or the effect is, `|s_j| T_j =
//! k`.

use serde::Serialize;

use crate::allocation::cost::cost_curve::Curve;
use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::problem::Problem;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::fits::tolerance_unit;
use sensitol_numeric::unit::Unit;

/// Origin of the costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum CostBasis {
    /// Given costs.
    #[default]
    Given,
    /// Tolerance unit of the size, divided by the half band.
    ToleranceUnit,
    /// Tolerance unit divided by the half band, with the same grade everywhere.
    ConstantPrecision,
    /// Tolerance unit divided by the half band, with the same effect on the characteristic everywhere.
    EqualShares,
}

impl CostBasis {
    /// True if the proportions of the tolerances are fixed, so that only one factor is sought.
    pub(in crate::allocation) fn is_proportion(self) -> bool {
        matches!(self, Self::ConstantPrecision | Self::EqualShares)
    }
}

/// Greatest ratio of a tolerance without a cost to the present one, either way.
const RANGE: f64 = 10.0;

/// Tolerance unit of a dimension's size in its own unit. It is the present half band if the size has none.
pub(in crate::allocation) fn unit(dimension: &Dimension) -> f64 {
    let metre = Unit::parse("m");
    let length = match dimension.unit() {
        None => Some(1.0),
        Some(name) => Unit::parse(name)
            .filter(|unit| metre.as_ref().is_some_and(|metre| unit.same_kind(metre)))
            .map(|unit| 1e3 * unit.scale),
    };
    match length {
        Some(millimetres) if dimension.nominal() != 0.0 => {
            tolerance_unit(dimension.nominal() * millimetres) / millimetres
        }
        _ => dimension.half_band(),
    }
}

/// Relative costs of every dimension, every position and every zone, whose tolerance can change. Dimensions that are `held` get none.
///
/// A zone has the one cost `T_0/T` for all of its dimensions, since it is about 0 and has no size.
pub(in crate::allocation) fn relative(problem: &Problem, zones: &[Priced], held: &[usize]) -> Vec<Priced> {
    let dimensions = problem.dimensions();
    let mut groups: Vec<Priced> = Vec::new();
    for zone in zones {
        let present = zone.present(dimensions);
        let offer =
            Curve::reciprocal(0.0, present).and_then(|curve| Offer::between(curve, present / RANGE, present * RANGE));
        if let Ok(offer) = offer {
            groups.push(Priced { parts: 1.0, offers: vec![offer], rounded: None, ..zone.clone() });
        }
    }
    let of_zones = |d: usize| zones.iter().any(|zone| zone.members.contains(&d));
    for (d, dimension) in dimensions.iter().enumerate().filter(|&(d, _)| !held.contains(&d) && !of_zones(d)) {
        let free = dimension.sigma() > 0.0 && unscalable(dimension).is_none();
        if !free || dimension.half_band() <= 0.0 {
            continue;
        }
        let zone = dimension.zone();
        if let Some(known) =
            groups.iter_mut().find(|known| zone.is_some() && dimensions[known.members[0]].zone() == zone)
        {
            known.members.push(d);
            continue;
        }
        let present = dimension.half_band();
        let offer = Curve::reciprocal(0.0, unit(dimension))
            .and_then(|curve| Offer::between(curve, present / RANGE, present * RANGE));
        if let Ok(offer) = offer {
            groups.push(Priced { members: vec![d], parts: 1.0, offers: vec![offer], rounded: None, zone: None });
        }
    }
    groups
}

/// Reason why a dimension does not follow its tolerance. Returns None if it does.
pub(in crate::allocation) fn unscalable(dimension: &Dimension) -> Option<&'static str> {
    let law = dimension.distribution()?;
    if law.measured().is_some() {
        return Some("it is measured, and its parts are as they are");
    }
    match dimension.scaled(1.0) {
        Some(_) => None,
        None if law.probability().is_none() => Some("it is known by its moments only"),
        None => Some("its distribution does not follow a tolerance"),
    }
}
