//! Strata of the space of independent normal variables: half-spaces, and the slab between two of them.

use crate::estimate::normal_space::Columns;
use sensitol_numeric::distribution::standard_normal;

/// Greatest distance of a point in sigmas: 6e-16 of all assemblies are beyond.
pub(crate) const REACH: f64 = 8.0;

/// Points with `direction . z > from`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct HalfSpace {
    /// Normal vector of length 1.
    pub(crate) direction: Vec<f64>,
    pub(crate) from: f64,
}

impl HalfSpace {
    /// Moves points along the direction into the half-space, evenly up to [`REACH`], and returns their weights.
    ///
    /// With `t` along the direction, `t' = from + (REACH - from) Phi(t)` is uniform and has the weight `(REACH - from) density(t')`. Powers
    /// 3 and 4 of functions that grow along it depend on 3 to 6 sigma, where plain points are few.
    pub(crate) fn enter(&self, z: &mut Columns) -> Vec<f64> {
        let width = REACH - self.from;
        let along = along(z, &self.direction);
        let far: Vec<f64> = along.iter().map(|&t| self.from + width * standard_normal::cdf(t)).collect();
        shift(z, &self.direction, &along, &far);
        far.into_iter().map(|t| width * standard_normal::density(t)).collect()
    }

    /// Returns true for each point in the half-space.
    pub(crate) fn holds(&self, z: &Columns) -> Vec<bool> {
        along(z, &self.direction).into_iter().map(|t| t > self.from).collect()
    }
}

/// Returns true for each point that none of these half-spaces contains. A point counts in the first stratum that contains it.
pub(crate) fn outside_of<'s>(spaces: impl IntoIterator<Item = &'s HalfSpace>, z: &Columns) -> Vec<bool> {
    let mut outside = vec![true; z.first().map_or(0, Vec::len)];
    for space in spaces {
        outside.iter_mut().zip(space.holds(z)).for_each(|(outside, held)| *outside &= !held);
    }
    outside
}

/// Moves points along a direction between `-from` and `from`, by the normal distribution truncated there. Returns the weight of each.
pub(crate) fn between(z: &mut Columns, direction: &[f64], from: f64) -> f64 {
    let below = standard_normal::cdf(-from);
    let weight = 1.0 - 2.0 * below;
    let along = along(z, direction);
    let near: Vec<f64> =
        along.iter().map(|&t| standard_normal::quantile(below + standard_normal::cdf(t) * weight)).collect();
    shift(z, direction, &along, &near);
    weight
}

/// Coordinates of the points along a direction.
pub(crate) fn along(z: &Columns, direction: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; z.first().map_or(0, Vec::len)];
    for (column, &part) in z.iter().zip(direction).filter(|(_, part)| **part != 0.0) {
        sums.iter_mut().zip(column).for_each(|(sum, value)| *sum += part * value);
    }
    sums
}

fn shift(z: &mut Columns, direction: &[f64], from: &[f64], to: &[f64]) {
    for (column, &part) in z.iter_mut().zip(direction).filter(|(_, part)| **part != 0.0) {
        for ((value, from), to) in column.iter_mut().zip(from).zip(to) {
            *value += part * (to - from);
        }
    }
}

/// Scales a given vector to length 1. Returns the first axis if it has no length.
pub(crate) fn unit(mut vector: Vec<f64>) -> Vec<f64> {
    let length = length(&vector);
    if length > 0.0 && length.is_finite() {
        vector.iter_mut().for_each(|part| *part /= length);
    } else {
        vector.iter_mut().enumerate().for_each(|(j, part)| *part = f64::from(u8::from(j == 0)));
    }
    vector
}

pub(crate) fn length(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sensitol_numeric::sampling::Normals;

    /// Points of a stratum in one randomisation.
    const ROWS: usize = 256;
    /// Number of randomisations, whose scatter gives the error.
    const RANDOMISATIONS: usize = 16;

    /// Sums of all weights and of weight times the square along the direction, in one randomisation.
    fn total_and_square(seed: u64, direction: &[f64]) -> [f64; 2] {
        let normals = Normals::new(3, seed);
        let mut sums = [0.0; 2];
        let mut add = |weights: &[f64], at: &[f64]| {
            for (weight, t) in weights.iter().zip(at) {
                sums[0] += weight / ROWS as f64;
                sums[1] += weight * t * t / ROWS as f64;
            }
        };
        for (stream, sign) in [(1, 1.0), (2, -1.0)] {
            let tail = HalfSpace { direction: direction.iter().map(|part| sign * part).collect(), from: 2.5 };
            let mut z = normals.columns(stream, ROWS);
            let weights = tail.enter(&mut z);
            assert!(tail.holds(&z).into_iter().all(|inside| inside));
            add(&weights, &along(&z, direction));
        }
        let mut z = normals.columns(3, ROWS);
        let weight = between(&mut z, direction, 2.5);
        let inner = along(&z, direction);
        assert!(inner.iter().all(|t| t.abs() <= 2.5));
        add(&vec![weight; ROWS], &inner);
        sums
    }

    /// The two tails and the slab between them contain all probability, and the variance of a normal variable is 1.
    ///
    /// The estimates are unbiased, so that the mean of 16 randomisations lies within four of its standard errors: Student's distribution of
    /// 15 degrees of freedom leaves 0.0012 beyond.
    ///
    /// An upper bound of the standard error prevents noise from passing the test. A stratum of n plain points has a variance of at most
    /// `E[f^2]/n`. In a tail `t` is even over the width `h = 8 - 2.5` and `f = h phi(t) g(t)`, so that `E[f^2] = h int phi^2 g^2 dt <= h
    /// phi(2.5) int phi g^2 dt`, where `phi(2.5) = 0.01753`. For `g = 1` the integral is `P(t > 2.5) = 0.00621`; for `g = t^2` it is
    /// `E[t^4; t > 2.5] = (2.5^3 + 3 x 2.5) 0.01753 + 3 x 0.00621 = 0.424`. The weight of the slab has no error, and for the square its
    /// `E[f^2]` is at most `E[t^4] = 3`. Two tails and the slab add up to `2 x 5.5 x 0.01753 x 0.00621 = 0.0012` and `2 x 5.5 x 0.01753 x
    /// 0.424 + 3 = 3.082`. Scrambled points of a base-2 net have at most `2^(t + s - 1)` times the variance of plain ones (Pan and Owen
    /// 2021), with `t = 1` for three coordinates of Sobol' points: 8 times.
    #[test]
    fn the_strata_make_a_whole() {
        let direction = unit(vec![1.0, -2.0, 2.0]);
        let found: Vec<[f64; 2]> = (1..=RANDOMISATIONS as u64).map(|seed| total_and_square(seed, &direction)).collect();
        let n = RANDOMISATIONS as f64;
        for (figure, second_moment) in [(0, 0.0012), (1, 3.082)] {
            let mean = found.iter().map(|one| one[figure]).sum::<f64>() / n;
            let variance = found.iter().map(|one| (one[figure] - mean).powi(2)).sum::<f64>() / (n - 1.0);
            let error = (variance / n).sqrt();
            assert!((mean - 1.0).abs() <= 4.0 * error, "{figure}: {mean} with the standard error {error}");
            let bound = (8.0 * second_moment / ROWS as f64 / n).sqrt();
            assert!(error > 0.0 && error <= bound, "{figure}: {error} above {bound}");
        }
    }
}
