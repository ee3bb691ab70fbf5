//! Expectations of a function of one input by Gauss panels that are halved where two rules differ.

use super::input::{GAUSS, Input};

/// Part of the whole by which two rules on a panel may differ: all digits,
pub(super) const EXACT: f64 = 1e-15;
/// or as many as a quantile takes.
pub(super) const NEARLY: f64 = 1e-10;
/// Panels at most.
const MOST: usize = 6000;
/// Halvings of a panel at most: a kink is then known to the last digit.
const DEEPEST: usize = 52;

/// An expectation and what its panels leave uncertain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Expectation {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// `E f(z)` of a function that is smooth between these places and a few others.
pub(super) fn expectation(input: &Input, splits: &[f64], tolerance: f64, f: impl Fn(f64) -> f64) -> Expectation {
    let rule = |from: f64, to: f64, factor: f64| -> f64 {
        let width = to - from;
        let at = |x: f64| {
            let z = from + width * x;
            let density = input.density(z);
            // A place next to an end may be rounded onto it, where a broken power is infinite.
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
        // A narrow spike that the first rule has missed makes the whole larger.
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
