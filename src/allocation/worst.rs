//! The worst case of a surface that is not linear, as a function of the tolerances.
//!
//! ```text
//! W(T) = max over the box of (q(u) - nominal)        q: the second-order surface at the station, u_j in [m_j - h_j T_j, m_j + h_j T_j]
//! dW/d ln T_j = dq/du_j (u_j - m_j)                   at the place of the maximum, where that is an end of the band; 0 within it
//! ```
//!
//! The slope is that of the envelope theorem. At the station itself the true worst case is known where interval arithmetic encloses the
//! formula: `W` is multiplied by what the true one is of it there, so that a search that comes to rest keeps the true one. Source of the
//! correction: N. M. Alexandrov, R. M. Lewis, Optimization and Engineering 2 (2001).

use crate::surrogate::{Surrogate, Univariate};

/// Sweeps over all coordinates: each raises the value, and a surface of second order takes a few.
const SWEEPS: usize = 40;
/// Places within a band at which a slope may change its sign, and halvings that find where.
const PLACES: usize = 16;
const HALVINGS: usize = 50;
/// A true worst case farther off than by this factor is no correction but another function: the difference is added.
const NEAR: f64 = 2.0;

/// The worst case of one characteristic about a station.
pub(super) struct WorstCase {
    parts: Vec<Univariate>,
    products: Vec<Vec<(usize, f64)>>,
    /// The middle of every band and its half, in sigmas from the mean.
    bands: Vec<[f64; 2]>,
    /// Indices of the dimensions of these parts.
    varying: Vec<usize>,
    /// The surface at the means less the nominal value.
    rise: f64,
    /// What the true reach below and above is made of the surface's: a factor, and what is added.
    corrections: [(f64, f64); 2],
}

impl WorstCase {
    /// Of a surface with the bands of its dimensions, where the true worst case reaches so far below and above the nominal value; None where a
    /// part is unknown.
    pub(super) fn of(
        surrogate: &Surrogate,
        varying: &[usize],
        bands: Vec<[f64; 2]>,
        nominal: f64,
        reached: Option<[f64; 2]>,
    ) -> Option<Self> {
        let mut products = vec![Vec::new(); varying.len()];
        for (j, k, value) in surrogate.interactions.pairs() {
            products[j].push((k, value));
            products[k].push((j, value));
        }
        let parts = surrogate.parts.iter().copied().collect::<Option<Vec<Univariate>>>()?;
        let (varying, rise) = (varying.to_vec(), surrogate.centre - nominal);
        let mut worst = Self { parts, products, bands, varying, rise, corrections: [(1.0, 0.0); 2] };
        if let Some(reached) = reached {
            let ones = vec![1.0; worst.varying.iter().max().map_or(0, |&last| last + 1)];
            let of = |above: bool| {
                let (found, truth) = (worst.reach(&ones, above).0, reached[usize::from(above)]);
                let factor = truth / found;
                let near = found > 0.0 && (1.0 / NEAR..=NEAR).contains(&factor);
                if near { (factor, 0.0) } else { (1.0, truth - found) }
            };
            worst.corrections = [of(false), of(true)];
        }
        Some(worst)
    }

    /// How far it reaches beyond the nominal value, above or below, at these factors of all tolerances; and how that grows with the
    /// logarithm of every one, as `(dimension, slope)`.
    pub(super) fn reach(&self, factors: &[f64], above: bool) -> (f64, Vec<(usize, f64)>) {
        let sign = if above { 1.0 } else { -1.0 };
        let ends: Vec<[f64; 2]> = (self.bands.iter().zip(&self.varying))
            .map(|(&[middle, half], &d)| [middle - half * factors[d], middle + half * factors[d]])
            .collect();
        let middles: Vec<f64> = self.bands.iter().map(|band| band[0]).collect();
        let corner = |end: &dyn Fn(usize) -> usize| ends.iter().enumerate().map(|(j, ends)| ends[end(j)]).collect();
        let uphill = |j: usize| usize::from(sign * self.slope(j, &middles) > 0.0);
        let starts: [Vec<f64>; 5] =
            [corner(&uphill), corner(&|j| 1 - uphill(j)), corner(&|_| 0), corner(&|_| 1), middles.clone()];
        let best = starts.into_iter().map(|start| self.climbed(start, &ends, sign)).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((at, value)) = best else { return (f64::NAN, Vec::new()) };
        let (factor, more) = self.corrections[usize::from(above)];
        let slope = |j: usize| {
            let held = at[j] == ends[j][0] || at[j] == ends[j][1];
            if held { factor * sign * self.slope(j, &at) * (at[j] - self.bands[j][0]) } else { 0.0 }
        };
        let slopes = (0..at.len()).map(|j| (self.varying[j], slope(j))).collect();
        (factor * (value + sign * self.rise) + more, slopes)
    }

    /// From a place, coordinate by coordinate, up to where no one of them leads on: the place, and how far that is above the means.
    fn climbed(&self, mut at: Vec<f64>, ends: &[[f64; 2]], sign: f64) -> (Vec<f64>, f64) {
        for _ in 0..SWEEPS {
            let mut moved = false;
            for j in 0..at.len() {
                let better = self.best_along(j, &at, ends[j], sign);
                moved |= better != at[j];
                at[j] = better;
            }
            if !moved {
                break;
            }
        }
        let value = sign * self.value(&at);
        (at, value)
    }

    /// The place within a band at which the surface is greatest, all else held; where it is until another is better by more than rounding.
    fn best_along(&self, j: usize, at: &[f64], [low, high]: [f64; 2], sign: f64) -> f64 {
        let joint: f64 = self.products[j].iter().map(|&(k, value)| value * at[k]).sum();
        let value = |u: f64| sign * (self.parts[j].value(u) + joint * u);
        let slope = |u: f64| sign * (derivative(&self.parts[j], u) + joint);
        let place = |i: usize| low + (high - low) * i as f64 / PLACES as f64;
        let tops = (0..PLACES).map(|i| (place(i), place(i + 1))).filter(|&(a, b)| slope(a) > 0.0 && slope(b) < 0.0);
        let tops = tops.map(|(mut a, mut b)| {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                if slope(middle) > 0.0 { a = middle } else { b = middle }
            }
            0.5 * (a + b)
        });
        let best = tops.chain([low, high]).max_by(|&a, &b| value(a).total_cmp(&value(b))).unwrap_or(at[j]);
        let own = value(at[j].clamp(low, high));
        if value(best) > own + 1e-14 * own.abs() { best } else { at[j].clamp(low, high) }
    }

    fn value(&self, at: &[f64]) -> f64 {
        let own: f64 = self.parts.iter().zip(at).map(|(part, &u)| part.value(u)).sum();
        let both =
            self.products.iter().enumerate().flat_map(|(j, row)| row.iter().map(move |&(k, value)| (j, k, value)));
        own + 0.5 * both.map(|(j, k, value)| value * at[j] * at[k]).sum::<f64>()
    }

    fn slope(&self, j: usize, at: &[f64]) -> f64 {
        derivative(&self.parts[j], at[j]) + self.products[j].iter().map(|&(k, value)| value * at[k]).sum::<f64>()
    }
}

fn derivative(part: &Univariate, u: f64) -> f64 {
    let [a, b, c, d] = part.coefficients();
    a + u * (2.0 * b + u * (3.0 * c + u * 4.0 * d))
}
