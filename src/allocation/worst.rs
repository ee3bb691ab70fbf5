//! The worst case of a surface that is not linear, as a function of the tolerances.
//!
//! ```text
//! W(T) = max over the box of (q(u) - nominal)        q: the second-order surface at the station, u_j in [m_j - h_j T_j, m_j + h_j T_j]
//! dW/d ln T_j = dq/du_j (u_j - m_j)                   at the place of the maximum, where that is an end of the band; 0 within it
//! ```
//!
//! The place is that of the descents with which a search of the extremes begins; the slope is that of the envelope theorem. At the
//! station itself the true worst case is known where interval arithmetic encloses the formula: `W` is multiplied by what the true one is
//! of it there, so that a search that comes to rest keeps the true one. Where the two differ and the model is cheap, `W` is that of the
//! formula itself at [its corners](super::corners). Source of the correction: N. M. Alexandrov, R. M. Lewis,
//! Optimization and Engineering 2 (2001).

use super::corners::Corners;
use crate::extremes::{Model, Region};
use sensitol_numeric::surrogate::Surrogate;

/// A true worst case farther off than by this factor is not a correction but another function: the difference is added.
const NEAR: f64 = 2.0;

/// A factor, and what is added.
pub(super) type WorstCaseCorrection = (f64, f64);

/// Nothing is corrected.
pub(super) const NO_CORRECTION: WorstCaseCorrection = (1.0, 0.0);

/// The factor and the addition that make a reach that was found the true one.
pub(super) fn correction(found: f64, truth: f64) -> WorstCaseCorrection {
    let factor = truth / found;
    let near = found > 0.0 && (1.0 / NEAR..=NEAR).contains(&factor);
    if near { (factor, 0.0) } else { (1.0, truth - found) }
}

/// Whether a correction is more than what the bounds of a true worst case leave open.
pub(super) fn is_off(&(factor, more): &WorstCaseCorrection) -> bool {
    (factor - 1.0).abs() > SURE || more != 0.0
}

/// The worst case of one characteristic about a station.
pub(super) struct WorstCase {
    /// The surface in sigmas, and the same upside down: each is least where the characteristic reaches farthest below and above.
    sides: [Model; 2],
    /// The middle of every band and its half, in sigmas from the mean, and by how many halves the middle moves where they grow.
    bands: Vec<[f64; 3]>,
    /// Indices of the dimensions of these bands.
    varying: Vec<usize>,
    /// The surface at the means less the nominal value.
    rise: f64,
    /// The corrections from the surface's reach below and above to the true one: a factor, and what is added.
    corrections: [WorstCaseCorrection; 2],
    /// The true worst case below and above the nominal value at the station.
    reached: Option<[f64; 2]>,
    /// The formula itself, where the surface is not it.
    corners: Option<Corners>,
}

/// A correction by less than this part is what the bounds of the true worst case leave open.
const SURE: f64 = 1e-9;

impl WorstCase {
    /// Of a surface with the bands of its dimensions, where the true worst case reaches so far below and above the nominal value; None where a
    /// part is unknown.
    pub(super) fn of(
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

    /// Corrects what is found at the station to the true worst case there.
    fn correct(&mut self) {
        let Some(reached) = self.reached else { return };
        self.corrections = [NO_CORRECTION; 2];
        let ones = vec![1.0; self.varying.iter().max().map_or(0, |&last| last + 1)];
        let of = |above: bool| correction(self.reach(&ones, above).0, reached[usize::from(above)]);
        self.corrections = [of(false), of(true)];
    }

    /// Whether the true worst case is known, and the surface is off.
    pub(super) fn is_off(&self) -> bool {
        self.reached.is_some() && self.corrections.iter().any(is_off)
    }

    /// The places of the surface's extremes below and above, by coordinates of the bands in `[-1, 1]`.
    pub(super) fn places(&self) -> [Vec<f64>; 2] {
        let end = |sign: f64| self.bands.iter().map(|[middle, half, _]| middle + sign * half).collect();
        let region = Region { lower: end(-1.0), upper: end(1.0) };
        let place = |side: &Model| {
            let at = side.least_in(&region).into_iter().zip(&self.bands);
            at.map(|(u, [middle, half, _])| ((u - middle) / half).clamp(-1.0, 1.0)).collect()
        };
        self.sides.each_ref().map(place)
    }

    /// Follows the formula itself from here.
    pub(super) fn follow(&mut self, corners: Corners) {
        self.corners = Some(corners);
        self.correct();
    }

    /// How far it reaches beyond the nominal value, above or below, at these factors of all tolerances; and how that grows with the
    /// logarithm of every one, as `(dimension, slope)`.
    pub(super) fn reach(&self, factors: &[f64], above: bool) -> (f64, Vec<(usize, f64)>) {
        self.reach_moved(factors, &vec![0.0; factors.len()], above)
    }

    /// The same with all nominal values moved by `shifts` sigmas, beyond the nominal value as it was.
    pub(super) fn reach_moved(&self, factors: &[f64], shifts: &[f64], above: bool) -> (f64, Vec<(usize, f64)>) {
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
            // An end of the band moves by what it has of the half width; the one that is held has nothing.
            let way = at[j] - (middle + shifts[self.varying[j]] - lean * half);
            if held { -factor * side.slope(&at, j) * way } else { 0.0 }
        };
        let slopes = (0..at.len()).map(|j| (self.varying[j], slope(j))).collect();
        (factor * (sign * self.rise - side.rise(&at)) + more, slopes)
    }
}
