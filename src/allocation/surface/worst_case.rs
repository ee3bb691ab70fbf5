//! Worst case of a surface that is not linear, as a function of the tolerances.
//!
//! ```text
//! W(T) = max over the box of (q(u) - nominal)        q: the second-order surface at the station, u_j in [m_j - h_j T_j, m_j + h_j T_j]
//! dW/d ln T_j = dq/du_j (u_j - m_j)                   at the place of the maximum, where that is an end of the band; 0 within it
//! ```
//!
//! The place is found by the descents that also begin a search of the extremes. The slope comes from the envelope
//! theorem. At the linearization point itself interval arithmetic may give the true worst case. `W` is then multiplied
//! by the ratio of the true one to it, so that a search ends at the true one. If the two differ and the model is cheap,
//! `W` is that of the formula itself at [its corners](crate::allocation::surface::corners). Source of the correction: N. M. Alexandrov, R.
//! M. Lewis, Optimization and Engineering 2 (2001).

use crate::allocation::surface::corners::Corners;
use crate::extremes::{Model, Region};
use sensitol_numeric::surrogate::Surrogate;

/// Greatest factor, either way, by which the true worst case is corrected. Beyond it the difference is added, because
/// it is a different function.
const NEAR: f64 = 2.0;

/// Correction by a factor and an addition.
pub(in crate::allocation) type WorstCaseCorrection = (f64, f64);

/// Correction without effect.
pub(in crate::allocation) const NO_CORRECTION: WorstCaseCorrection = (1.0, 0.0);

/// Correction of a reach that was found to the true one.
pub(in crate::allocation) fn correction(found: f64, truth: f64) -> WorstCaseCorrection {
    let factor = truth / found;
    let near = found > 0.0 && (1.0 / NEAR..=NEAR).contains(&factor);
    if near { (factor, 0.0) } else { (1.0, truth - found) }
}

/// True if a correction exceeds the uncertainty of the bounds of a true worst case.
pub(in crate::allocation) fn is_off(&(factor, more): &WorstCaseCorrection) -> bool {
    (factor - 1.0).abs() > SURE || more != 0.0
}

/// Worst case of one characteristic about a linearization point.
pub(in crate::allocation) struct WorstCase {
    /// Surface in sigmas, and its negative. Their least values are at the farthest reach below and above.
    sides: [Model; 2],
    /// Middle and half-width of every band, in sigmas from the mean, and the move of the middle per half-width that is
    /// added.
    bands: Vec<[f64; 3]>,
    /// Indices of the dimensions of these bands.
    varying: Vec<usize>,
    /// Value of the surface at the means, minus the nominal value.
    rise: f64,
    /// Corrections from the surface's reach below and above to the true one.
    corrections: [WorstCaseCorrection; 2],
    /// True reach below and above the nominal value at the linearization point, if it is known.
    reached: Option<[f64; 2]>,
    /// Formula itself, if the surface deviates from it.
    corners: Option<Corners>,
}

/// Greatest relative correction that the uncertainty of the true worst case explains.
const SURE: f64 = 1e-9;

impl WorstCase {
    /// Worst case of a surface with the bands of its dimensions, and the true reach below and above the nominal value.
    /// Returns None if a univariate part is unknown.
    pub(in crate::allocation) fn of(
        surrogate: &Surrogate,
        varying: &[usize],
        bands: Vec<[f64; 3]>,
        nominal: f64,
        reached: Option<[f64; 2]>,
    ) -> Option<Self> {
        let n = varying.len();
        let mut products = vec![Vec::new(); n];
        for (j, k, value) in surrogate.interactions.pairs() {
            products[j].push((k, value));
            products[k].push((j, value));
        }
        let parts = surrogate.parts.iter().map(|part| Some(part.as_ref()?.coefficients())).collect::<Option<_>>()?;
        let surface = Model { base: vec![0.0; n], scale: vec![1.0; n], parts, products };
        let sides = [surface.clone(), surface.negated()];
        let (varying, rise) = (varying.to_vec(), surrogate.centre - nominal);
        let mut worst = Self { sides, bands, varying, rise, corrections: [NO_CORRECTION; 2], reached, corners: None };
        worst.correct();
        Some(worst)
    }

    /// Corrects the reach at the linearization point to the true one.
    fn correct(&mut self) {
        let Some(reached) = self.reached else { return };
        self.corrections = [NO_CORRECTION; 2];
        let ones = vec![1.0; self.varying.iter().max().map_or(0, |&last| last + 1)];
        let of = |above: bool| correction(self.reach(&ones, above).0, reached[usize::from(above)]);
        self.corrections = [of(false), of(true)];
    }

    /// True if the true worst case is known, and that of the surface deviates from it.
    pub(in crate::allocation) fn is_off(&self) -> bool {
        self.reached.is_some() && self.corrections.iter().any(is_off)
    }

    /// Places of the surface's extremes below and above, by coordinates of the bands in `[-1, 1]`.
    pub(in crate::allocation) fn places(&self) -> [Vec<f64>; 2] {
        let end = |sign: f64| self.bands.iter().map(|[middle, half, _]| middle + sign * half).collect();
        let region = Region { lower: end(-1.0), upper: end(1.0) };
        let place = |side: &Model| {
            let at = side.least_in(&region).into_iter().zip(&self.bands);
            at.map(|(u, [middle, half, _])| ((u - middle) / half).clamp(-1.0, 1.0)).collect()
        };
        self.sides.each_ref().map(place)
    }

    /// Uses the formula itself from now on.
    pub(in crate::allocation) fn follow(&mut self, corners: Corners) {
        self.corners = Some(corners);
        self.correct();
    }

    /// Reach beyond the nominal value, above or below, at these factors of all tolerances. Also returns its derivatives
    /// by the logarithm of every tolerance, as `(dimension, slope)`.
    pub(in crate::allocation) fn reach(&self, factors: &[f64], above: bool) -> (f64, Vec<(usize, f64)>) {
        self.reach_moved(factors, &vec![0.0; factors.len()], above)
    }

    /// Reach beyond the original nominal value, with all nominal values moved by `shifts` sigmas.
    pub(in crate::allocation) fn reach_moved(
        &self,
        factors: &[f64],
        shifts: &[f64],
        above: bool,
    ) -> (f64, Vec<(usize, f64)>) {
        let (factor, more) = self.corrections[usize::from(above)];
        if let Some((reach, slopes)) = self.corners.as_ref().and_then(|of| of.reach(factors, shifts, above)) {
            return (factor * reach + more, slopes.into_iter().map(|(d, slope)| (d, factor * slope)).collect());
        }
        let (side, sign) = (&self.sides[usize::from(above)], if above { 1.0 } else { -1.0 });
        let end = |sign: f64| {
            let at = |(&[middle, half, lean], &d): (&[f64; 3], &usize)| {
                middle + shifts[d] + half * (sign * factors[d] + lean * (factors[d] - 1.0))
            };
            self.bands.iter().zip(&self.varying).map(at).collect()
        };
        let region = Region { lower: end(-1.0), upper: end(1.0) };
        let at = side.least_in(&region);
        let slope = |j: usize| {
            let held = at[j] == region.lower[j] || at[j] == region.upper[j];
            let [middle, half, lean] = self.bands[j];
            // An end of the band moves in proportion to its distance from the fixed point of the band. A held end does
            // not move.
            let way = at[j] - (middle + shifts[self.varying[j]] - lean * half);
            if held { -factor * side.slope(&at, j) * way } else { 0.0 }
        };
        let slopes = (0..at.len()).map(|j| (self.varying[j], slope(j))).collect();
        (factor * (sign * self.rise - side.rise(&at)) + more, slopes)
    }
}
