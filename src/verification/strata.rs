//! Strata of the space of independent normal variables: half-spaces, and the slab between two of them.

use super::space::Columns;
use crate::distribution::standard_normal;

/// Where the world ends, in sigmas: beyond lie 6e-16 of all assemblies.
pub(super) const REACH: f64 = 8.0;

/// The points with `direction . z > from`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HalfSpace {
    /// Of length 1.
    pub(super) direction: Vec<f64>,
    pub(super) from: f64,
}

impl HalfSpace {
    /// Moves points along the direction into the half-space, evenly as far as [`REACH`], and returns their weights.
    ///
    /// With `t` along the direction, `t' = from + (REACH - from) Phi(t)` is uniform and has the weight
    /// `(REACH - from) density(t')`: powers 3 and 4 of what grows along it live at 3 to 6 sigma, where plain points are few.
    pub(super) fn enter(&self, z: &mut Columns) -> Vec<f64> {
        let width = REACH - self.from;
        let along = along(z, &self.direction);
        let far: Vec<f64> = along.iter().map(|&t| self.from + width * standard_normal::cdf(t)).collect();
        shift(z, &self.direction, &along, &far);
        far.into_iter().map(|t| width * standard_normal::density(t)).collect()
    }

    /// Whether each point lies in it.
    pub(super) fn holds(&self, z: &Columns) -> Vec<bool> {
        along(z, &self.direction).into_iter().map(|t| t > self.from).collect()
    }
}

/// Moves points along a direction between `-from` and `from`, by the normal law cut there; returns the weight of each.
pub(super) fn between(z: &mut Columns, direction: &[f64], from: f64) -> f64 {
    let below = standard_normal::cdf(-from);
    let weight = 1.0 - 2.0 * below;
    let along = along(z, direction);
    let near: Vec<f64> =
        along.iter().map(|&t| standard_normal::quantile(below + standard_normal::cdf(t) * weight)).collect();
    shift(z, direction, &along, &near);
    weight
}

/// How far every point lies along a direction.
pub(super) fn along(z: &Columns, direction: &[f64]) -> Vec<f64> {
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

/// Of length 1; the first axis for what has no length.
pub(super) fn unit(mut vector: Vec<f64>) -> Vec<f64> {
    let length = length(&vector);
    if length > 0.0 && length.is_finite() {
        vector.iter_mut().for_each(|part| *part /= length);
    } else {
        vector.iter_mut().enumerate().for_each(|(j, part)| *part = f64::from(u8::from(j == 0)));
    }
    vector
}

pub(super) fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Normals;

    /// The two tails and the slab between them hold all probability, and the variance of a normal variable is 1.
    #[test]
    fn the_strata_make_a_whole() {
        let (normals, direction, rows) = (Normals::new(3, 5), unit(vec![1.0, -2.0, 2.0]), 4096);
        let (mut total, mut square) = (0.0, 0.0);
        for (stream, sign) in [(1, 1.0), (2, -1.0)] {
            let tail = HalfSpace { direction: direction.iter().map(|part| sign * part).collect(), from: 2.5 };
            let mut z = normals.columns(stream, rows);
            let weights = tail.enter(&mut z);
            assert!(tail.holds(&z).into_iter().all(|inside| inside));
            for (weight, t) in weights.iter().zip(along(&z, &direction)) {
                total += weight / rows as f64;
                square += weight * t * t / rows as f64;
            }
        }
        let mut z = normals.columns(3, rows);
        let weight = between(&mut z, &direction, 2.5);
        let inner = along(&z, &direction);
        assert!(inner.iter().all(|t| t.abs() <= 2.5));
        total += weight;
        square += weight * inner.iter().map(|t| t * t).sum::<f64>() / rows as f64;
        // Quasi-random points of 4096 in three dimensions are off by about 1/4096 of a smooth function's spread, which is below 1.
        assert!((total - 1.0).abs() < 1.0 / 4096.0, "{total}");
        // A square grows without bound: a quarter of the standard error of as many plain points, sqrt(2/4096).
        assert!((square - 1.0).abs() < 0.25 * (2.0 / 4096f64).sqrt(), "{square}");
    }
}
