//! Quantiles: the limit beyond which a tail has a given probability, by its logarithm.

use super::{LawFigure, LawTail, SurfaceLaw};

/// Steps at most: a dozen when all is well.
const STEPS: usize = 200;
/// Part of sigma within which two limits are one.
const SAME: f64 = 1e-14;

/// The limit at which a tail of the law has the probability `p`, above 0 and at most one half.
pub(super) fn quantile(law: &SurfaceLaw, tail: LawTail, p: f64) -> LawFigure {
    let (mean, sigma) = (law.mean(), law.sigma());
    let sign = tail.sign();
    // Outward from the mean; positive while the tail is too heavy.
    let gap = |u: f64| {
        let value = law.tail(mean + sign * u, tail).value;
        libm::log(value.max(1e-305) / p)
    };
    let [least, most] = law.range();
    let end = if tail == LawTail::Upper { most - mean } else { mean - least };
    let other = if tail == LawTail::Upper { mean - least } else { most - mean };
    let (mut low, mut at_low) = (0.0, gap(0.0));
    let mut width = sigma;
    while at_low < 0.0 && -low < other {
        low = (low - width).max(-other);
        at_low = gap(low);
        width *= 1.5;
    }
    let (mut high, mut at_high, mut width) = (low, at_low, sigma);
    while at_high > 0.0 && high < end {
        (low, at_low) = (high, at_high);
        high = (high + width).min(end);
        at_high = if high >= end { f64::NEG_INFINITY } else { gap(high) };
        width *= 1.5;
    }
    let scale = SAME * (sigma + mean.abs());
    let (mut halve, mut best) = (false, f64::NAN);
    for _ in 0..STEPS {
        if high - low <= scale {
            break;
        }
        // Regula falsi with the weights of Anderson and Björck, and a halving where it does not close in.
        let secant = low + (high - low) * at_low / (at_low - at_high);
        let u = if halve || !(secant > low && secant < high) { 0.5 * (low + high) } else { secant };
        let before = high - low;
        let at = gap(u);
        let moved = (u - best).abs();
        best = u;
        if at > 0.0 {
            at_high *= weight(at, at_low);
            (low, at_low) = (u, at);
        } else {
            at_low *= weight(at, at_high);
            (high, at_high) = (u, at);
        }
        if at == 0.0 || moved <= scale {
            break;
        }
        halve = high - low > 0.5 * before && !halve;
    }
    // Where the bounds were one from the start there was no step.
    let best = if best.is_nan() { 0.5 * (low + high) } else { best };
    let y = mean + sign * best;
    let (off, density) = (law.tail(y, tail).error, law.density(y).value);
    let error = if density > 0.0 { off / density } else { f64::INFINITY };
    LawFigure::new(y, error.max(scale))
}

fn weight(now: f64, before: f64) -> f64 {
    let weight = 1.0 - now / before;
    if weight > 0.0 { weight } else { 0.5 }
}
