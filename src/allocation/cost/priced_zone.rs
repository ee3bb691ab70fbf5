//! Zone of a feature as one tolerance: its dimensions have half bands in proportion to it.

use std::ops::Range;

use crate::allocation::cost::cost_curve::{Curve, Priced};

/// Zone of a feature whose half width is a tolerance with a cost, or several zones of one width.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PricedZone {
    /// Zones of the group.
    pub parts: Vec<ZonePart>,
    /// Half band of every member per unit of the half width.
    pub shares: Vec<f64>,
    /// Dimensions without a tolerance that are proportional to the half width, with their factors. They are the widths
    /// in formulas, such as that of a zone with a bonus.
    pub widths: Vec<(usize, f64)>,
    /// Name of the zone that this one refines. Its tolerance is never below that of this one.
    pub within: Option<String>,
}

/// One zone of a group, or one dimension beside zones.
#[derive(Debug, Clone, PartialEq)]
pub struct ZonePart {
    /// Name in the study, such as `housing.bore.position`.
    pub name: String,
    /// Unit of the width.
    pub unit: Option<String>,
    /// Places of its dimensions among the members of the group.
    pub members: Range<usize>,
    /// Number of parts and their cost, if it is not that of the group.
    pub cost: Option<(f64, Curve)>,
}

/// Group that holds a dimension, with the share of the dimension in its tolerance.
pub(in crate::allocation) fn holder(priced: &[Priced], dimension: usize) -> Option<(usize, f64)> {
    let of = |(g, group): (usize, &Priced)| {
        let place = group.members.iter().position(|&d| d == dimension)?;
        Some((g, group.share(place)))
    };
    priced.iter().enumerate().find_map(of)
}
