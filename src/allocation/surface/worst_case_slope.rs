//! Reach of a worst case: by its slopes, or by the corners of the bands if slopes do not determine it.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::surface::band::Reach;
use crate::allocation::surface::corners::{Band, Corners, Places};
use crate::allocation::surface::response::Responses;
use crate::problem::Problem;

impl Responses {
    /// Uses the formula itself for worst cases that the surface misses. The search begins at the `known` places of
    /// earlier linearization points, and adds to them. `asked` counts the values of the formula.
    pub(in crate::allocation) fn follow_corners(
        &mut self,
        problem: &Problem,
        known: &mut BTreeMap<usize, [Places; 2]>,
        asked: &Arc<AtomicU64>,
    ) {
        let band = |d: usize| {
            let Reach { middle, half, lean } = self.reach[d];
            Band { dimension: d, middle, half, lean, sigma: self.dimensions[d].sigma() }
        };
        let bands: Vec<Band> = self.varying.iter().map(|&d| band(d)).collect();
        for (c, of) in self.of.iter_mut().enumerate() {
            let Some((worst, nominal)) = of.worst.as_mut().filter(|worst| worst.is_off()).zip(of.nominal) else {
                continue;
            };
            let places = known.remove(&c).unwrap_or_default();
            if let Some(corners) = Corners::of(problem, c, nominal, bands.clone(), worst.places(), places, asked) {
                known.insert(c, corners.places());
                worst.follow(corners);
            }
        }
    }

    /// Nominal value, and the reach of the worst case beyond it, above or below, with nominals moved by `shifts`, in
    /// sigmas.
    pub(in crate::allocation) fn worst_reach(
        &self,
        characteristic: usize,
        factors: &[f64],
        shifts: &[f64],
        above: bool,
    ) -> Option<(f64, f64)> {
        let of = &self.of[characteristic];
        let nominal = of.nominal?;
        if let Some(worst) = &of.worst {
            return Some((nominal, worst.reach_moved(factors, shifts, above).0));
        }
        let all = self.every_dimension();
        let (constant, coefficients) = self.worst_case(characteristic, &all, above)?;
        let wide = |(group, coefficient): (&Priced, &f64)| {
            let d = group.members[0];
            coefficient * factors[d] * self.dimensions[d].half_band()
        };
        let reach = constant + all.iter().zip(&coefficients).map(wide).sum::<f64>();
        let moved = |(d, slope): (usize, &f64)| slope * shifts[d] * self.dimensions[d].sigma();
        Some((nominal + of.slopes.as_ref()?.iter().enumerate().map(moved).sum::<f64>(), reach))
    }
}
