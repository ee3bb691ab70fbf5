//! Expectations of a function of one input by Gauss panels, which are halved as long as two rules differ.

use crate::law::input::{GAUSS, Input};

/// Greatest difference of two rules on a panel, relative to the whole, for full accuracy.
pub(super) const EXACT: f64 = 1e-15;
/// Greatest difference of two rules on a panel, relative to the whole, for a quantile.
pub(super) const NEARLY: f64 = 1e-10;
/// Greatest number of panels.
const MOST: usize = 6000;
/// Greatest number of halvings of a panel: a kink is then located to the last digit.
const DEEPEST: usize = 52;

/// Expectation with the numerical error of its panels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Expectation {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// `E f(z)` of a function that is smooth except at the `splits` and a few other points.
pub(super) fn expectation(input: &Input, splits: &[f64], tolerance: f64, f: impl Fn(f64) -> f64) -> Expectation {
    let rule = |from: f64, to: f64, factor: f64| -> f64 {
        let width = to - from;
        let at = |x: f64| {
            let z = from + width * x;
            let density = input.density(z);
            // A node next to an end may be rounded onto it, where a broken power is infinite.
            if density > 0.0 && density.is_finite() { density * f(z) } else { 0.0 }
        };
        factor * width * GAUSS.iter().map(|(x, w)| w * at(*x)).sum::<f64>()
    };
    let mut splits = splits.to_vec();
    splits.sort_unstable_by(f64::total_cmp);
    let mut open = Vec::new();
    for ([from, to], factor) in input.panels() {
        let mut low = from;
        for high in splits.iter().copied().filter(|&z| z > from && z < to).chain([to]) {
            if high > low {
                open.push((low, high, factor, rule(low, high, factor), 0));
            }
            low = high;
        }
    }
    let atoms: f64 = input.atoms.iter().map(|&(z, p)| p * f(z)).sum();
    let mut total: f64 = atoms.abs() + open.iter().map(|panel| panel.3.abs()).sum::<f64>();
    let (mut value, mut error, mut taken) = (atoms, 0.0, 0);
    open.reverse();
    while let Some((from, to, factor, coarse, depth)) = open.pop() {
        let middle = 0.5 * (from + to);
        let (left, right) = (rule(from, middle, factor), rule(middle, to, factor));
        let off = (left + right - coarse).abs();
        // A narrow spike that the first rule missed makes the whole larger.
        total += left.abs() + right.abs() - coarse.abs();
        taken += 1;
        let fine = off <= tolerance * total || !(from < middle && middle < to);
        if fine || depth >= DEEPEST || taken >= MOST {
            value += left + right;
            error += off;
            continue;
        }
        open.push((middle, to, factor, right, depth + 1));
        open.push((from, middle, factor, left, depth + 1));
    }
    Expectation { value, error }
}
