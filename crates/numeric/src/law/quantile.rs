//! Quantiles: the limit beyond which a tail has a given probability, found by the logarithm of the probability.

use std::cell::Cell;
use std::sync::Arc;

use crate::law::inversion::contour::Contour;
use crate::law::inversion::tail_inversion::Inversion;
use crate::law::inverted_law::is_poor;
use crate::law::sampled_law::{Choice, Sampled};
use crate::law::two_inputs::Single;
use crate::law::{Kind, LawFigure, LawTail, SurfaceLaw};

/// Greatest number of steps. A dozen is usual.
const STEPS: usize = 200;
/// Part of sigma within which two limits count as equal.
const SAME: f64 = 1e-14;

/// Limit at which a tail of the law has the probability `p`, above 0 and at most one half.
pub(super) fn quantile(law: &SurfaceLaw, tail: LawTail, p: f64) -> LawFigure {
    bracketed(law, tail, p, alone(law, tail, p))
}

/// Quantile whose error is confirmed by the tails on both sides of it. Values with probabilities of their own leave gaps, in which a search
/// may end beside the cluster that has the quantile. It is then bisected, since a tail falls outward everywhere.
fn bracketed(law: &SurfaceLaw, tail: LawTail, p: f64, found: LawFigure) -> LawFigure {
    if law.given.inputs.iter().all(|input| input.atoms.is_empty()) || !(found.value + found.error).is_finite() {
        return found;
    }
    let (sign, reach) = (tail.sign(), BRACKET * found.error);
    let [inward, outward] = [-reach, reach].map(|off| law.tail(found.value + sign * off, tail));
    if inward.value + inward.error >= p && outward.value - outward.error <= p {
        let flat = inward.value - inward.error <= p && outward.value + outward.error >= p;
        // On a gap every value has this tail: the error reaches to both of its ends.
        let width = if flat { extent(law, found.value, tail, p) } else { 0.0 };
        if width > WIDE * law.sigma() {
            return LawFigure::new(found.value, width);
        }
        let steep = (inward.value - outward.value).abs() * law.sigma() > STEEP * 2.0 * reach;
        let edge = if steep { EDGE * law.sigma() } else { 0.0 };
        return LawFigure::new(found.value, found.error.max(edge));
    }
    // The range may have no end, so that the bracket widens from the value that was found.
    let (mut heavy, mut light) = (found.value, found.value);
    let mut width = law.sigma();
    for _ in 0..STEPS {
        if law.tail(heavy, tail).value > p && law.tail(light, tail).value <= p {
            break;
        }
        (heavy, light) = (found.value - sign * width, found.value + sign * width);
        width *= 2.0;
    }
    let scale = SAME * (law.sigma() + law.mean().abs());
    for _ in 0..STEPS {
        let middle = 0.5 * (heavy + light);
        if (light - heavy).abs() <= scale || middle == heavy || middle == light {
            break;
        }
        *(if law.tail(middle, tail).value > p { &mut heavy } else { &mut light }) = middle;
    }
    let y = 0.5 * (heavy + light);
    LawFigure::new(y, extent(law, y, tail, p).max(EDGE * law.sigma()).max(scale))
}

/// Search of one quantile by its own tails.
fn alone(law: &SurfaceLaw, tail: LawTail, p: f64) -> LawFigure {
    let (mean, sigma) = (law.mean(), law.sigma());
    let sign = tail.sign();
    // Logarithm of the tail over `p` at a distance outward from the mean. It is positive while the tail is too heavy.
    let open = Cell::new(0.0);
    let gap = |u: f64| {
        let figure = law.tail(mean + sign * u, tail);
        // A gap below a small part of the tail's own error counts as none. Dividing by at least p keeps a tiny tail with a large error
        // searched.
        open.set(OPEN * figure.error / figure.value.max(p));
        libm::log(figure.value.max(1e-305) / p)
    };
    let [least, most] = law.range();
    let end = if tail == LawTail::Upper { most - mean } else { mean - least };
    let other = if tail == LawTail::Upper { mean - least } else { most - mean };
    // Bracket the quantile: inward until the tail is too heavy, then outward until it is too light.
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
        // Regula falsi with the weights of Anderson and Björck. Bisect if the interval does not shrink.
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
        if at.abs() <= open.get() || moved <= scale {
            break;
        }
        halve = high - low > 0.5 * before && !halve;
    }
    // If the bounds were equal from the start, there was no step.
    let best = if best.is_nan() { 0.5 * (low + high) } else { best };
    let y = mean + sign * best;
    let (off, density) = (law.tail(y, tail).error, law.density(y).value);
    let error = if density > 0.0 { off / density } else { f64::INFINITY };
    let error = if error <= COARSE * sigma { error } else { error.min(extent(law, y, tail, p)) };
    LawFigure::new(y, error.max(scale))
}

/// Distance from `y` within which the tail may have the probability `p`, up to [`FACTOR`]. It replaces the error over the density where the
/// density is no scale of the distance, as in a gap between two clusters of values.
fn extent(law: &SurfaceLaw, y: f64, tail: LawTail, p: f64) -> f64 {
    let [least, most] = law.range();
    let side = |sign: f64, end: f64| {
        let (mut distance, end) = (NEAR * law.sigma(), end.min(FARTHEST * law.sigma()));
        while distance < end {
            let figure = law.tail(y + sign * distance, tail);
            if (figure.value - p).abs() > figure.error {
                break;
            }
            distance *= FACTOR;
        }
        distance.min(end)
    };
    side(-1.0, y - least).max(side(1.0, most - y))
}

fn weight(now: f64, before: f64) -> f64 {
    let weight = 1.0 - now / before;
    if weight > 0.0 { weight } else { 0.5 }
}

/// Quantile that is computed together with others: its tail and probability, and a starting value from another distribution.
#[derive(Debug, Clone, Copy)]
pub struct Sought {
    /// Tail whose probability is given.
    pub tail: LawTail,
    /// Probability of the tail, above 0 and at most one half.
    pub p: f64,
    /// Starting value: this quantile of another distribution.
    pub near: f64,
    /// Density of that other distribution at the starting value.
    pub density: f64,
}

/// Error, in parts of sigma, within which a quantile beside others is found.
const NEAR: f64 = 1e-7;
/// Error, in parts of the sampling error, within which a quantile is found.
const OPEN: f64 = 0.02;
/// Logarithm of a tail over `p` up to which a small step ends a search.
const APART: f64 = 0.05;
/// Error, in sigmas, above which the error of a probability over the density is no error of a quantile.
const COARSE: f64 = 0.1;
/// Errors of a quantile within which its probability lies, by the tails there.
const BRACKET: f64 = 3.0;
/// Density per sigma above which a quantile lies in a cluster whose edges the transform does not resolve. Smooth laws stay below 10.
const STEEP: f64 = 100.0;
/// Resolution of the edge of a cluster, in sigmas: the transform was 4e-5 off at clusters of 1e-5 sigma.
const EDGE: f64 = 4e-5;
/// Width of a flat tail, in sigmas, above which it is a gap. [`extent`] begins at a hundredth of it.
const WIDE: f64 = 1e-5;
/// Greatest distance of [`extent`], in sigmas: farther out no quantile of interest lies.
const FARTHEST: f64 = 1e3;
/// Factor between two distances at which [`extent`] computes the tail.
const FACTOR: f64 = 4.0;
/// Greatest number of steps before the search of [`quantile`] takes over. A jump takes 30 halvings.
const MANY: usize = 80;
/// Fraction of the way from the mean to the farthest quantile at which the shared tilt is chosen. It serves all quantiles and costs a digit
/// at three sigma.
const SHARED: f64 = 0.7;
/// Distance beyond the farthest quantile, in sigmas, up to which a shared contour is still exact.
const MARGIN: f64 = 0.5;
/// Probability below which a sampled quantile takes a tilt of its own. Above it untilted points are as good.
const TILTED: f64 = 5e-3;

/// Several quantiles together. Those of one tail share a contour or points. Each search begins near its result, so that a quantile takes
/// three or four values of the law.
pub(super) fn quantiles(law: &SurfaceLaw, sought: &[Sought]) -> Vec<LawFigure> {
    let sides = [LawTail::Lower, LawTail::Upper].map(|tail| Together::of(law, tail, sought));
    let one = |of: &Sought| {
        let found = near(law, &sides[usize::from(of.tail == LawTail::Upper)], of);
        bracketed(law, of.tail, of.p, found)
    };
    sought.iter().map(one).collect()
}

/// Newton's method on the logarithm of a tail between bounds, which are halved if it does not converge.
fn near(law: &SurfaceLaw, side: &Together<'_>, sought: &Sought) -> LawFigure {
    let Sought { tail, p, near, density } = *sought;
    let (sign, sigma) = (tail.sign(), law.sigma());
    if matches!(side, Together::Nothing) && (law.step || !(near.is_finite() && density > 0.0)) {
        return law.quantile(tail, p);
    }
    let [mut low, mut high] = law.range();
    let inner = |y: f64, low: f64, high: f64| y > low && y < high;
    let mut at = if inner(near, low, high) { near } else { law.mean };
    let mut slope = if density > 0.0 { -sign * density / p } else { -sign / sigma };
    let choice = side.choice(at, tail, p);
    let (mut last, mut steps, mut widen): (Option<(f64, f64)>, _, _) = (None, [f64::INFINITY; 2], 0.5 * sigma);
    let mut open = f64::INFINITY;
    for _ in 0..MANY {
        let (value, own_slope) = side.at(law, at, tail, &choice);
        if !value.value.is_finite() {
            break;
        }
        let here = libm::log(value.value / p);
        // If the tail is too heavy, the quantile lies farther out.
        let outward = (here > 0.0) == (tail == LawTail::Upper);
        if outward {
            low = at
        } else {
            high = at
        }
        let own = own_slope.filter(|own| own * sign < 0.0 && own.is_finite());
        let secant = last.map(|(before, there)| (here - there) / (at - before)).filter(|secant| secant * sign < 0.0);
        let measured = own.or(secant);
        slope = measured.unwrap_or(slope);
        let step = -here / slope;
        let known = (value.error / value.value.max(p) / slope).abs();
        open = if known.is_finite() { known } else { open };
        // In a gap the density is 0, and the error over it exceeds every bracket.
        let close = (NEAR * sigma).max(if open <= COARSE * sigma { OPEN * open } else { 0.0 });
        // The density of another distribution is no evidence of convergence: next to a corner it may be infinite.
        // Beside a cluster of values a contour may have a density where there is none, and a step that ends there.
        let close_enough = step.abs() <= close && here.abs() <= if measured.is_some() { APART } else { NEAR };
        if here == 0.0 || close_enough {
            let y = (at + step).clamp(low, high);
            let known = if open <= COARSE * sigma { open } else { open.min(extent(law, y, tail, p)) };
            return LawFigure::new(y, known + close);
        }
        if high - low <= close {
            return LawFigure::new(0.5 * (low + high), open.min(high - low) + close);
        }
        // Take the Newton step if steps shrink and it stays inside, halve a finite bracket otherwise, or widen an open one.
        last = here.is_finite().then_some((at, here)).or(last);
        let closing = step.abs() <= 0.5 * steps[0] && inner(at + step, low, high);
        steps = [steps[1], step.abs()];
        at = match (closing, low.is_finite() && high.is_finite()) {
            (true, _) if step.abs() <= 2.0 * sigma => at + step,
            (_, true) => 0.5 * (low + high),
            _ => {
                widen *= 2.0;
                if outward { at + widen } else { at - widen }
            }
        };
    }
    match side {
        // The search by `quantile` would take panels at full accuracy, hundreds of times.
        Together::Panels(_) => LawFigure::new(f64::NAN, f64::INFINITY),
        _ => law.quantile(tail, p),
    }
}

/// Shared state of the quantiles of one tail.
enum Together<'l> {
    /// Contour, and the number of its points that the last limit took.
    Line(&'l Inversion, Arc<Contour>, Cell<usize>),
    /// Points of a sample, and a contour of its control variate.
    Points(&'l Sampled, Option<(&'l Inversion, Arc<Contour>, Cell<usize>)>),
    /// Panels at reduced accuracy.
    Panels(&'l Single),
    /// No shared state: every quantile is searched by itself.
    Nothing,
}

impl<'l> Together<'l> {
    fn of(law: &'l SurfaceLaw, tail: LawTail, sought: &[Sought]) -> Self {
        let outward = |of: &Sought| tail.sign() * (of.near - law.mean);
        let own = sought.iter().filter(|of| of.tail == tail && of.near.is_finite());
        let Some(most) = own.map(outward).reduce(f64::max) else { return Self::Nothing };
        let places = [SHARED * most, most + MARGIN * law.sigma()].map(|by| law.mean + tail.sign() * by);
        let line = |inversion: &'l Inversion| Some((inversion, inversion.shared(tail, places)?, Cell::new(0)));
        match &law.kind {
            Kind::Exact(exact) => match line(&exact.inversion) {
                Some((inversion, contour, points)) => Self::Line(inversion, contour, points),
                None => Self::Nothing,
            },
            Kind::Sampled(sampled) => Self::Points(sampled, sampled.control().and_then(line)),
            Kind::Single(single) => Self::Panels(single),
            Kind::Point(_) | Kind::Steps(_) => Self::Nothing,
        }
    }

    /// Points and estimate for the search of one quantile.
    fn choice(&self, at: f64, tail: LawTail, p: f64) -> Choice {
        match self {
            Self::Points(sampled, _) => sampled.choice((p < TILTED).then_some(at), tail),
            _ => Choice::default(),
        }
    }

    /// Tail at `y`, and the slope of its logarithm if the density comes with it.
    fn at(&self, law: &SurfaceLaw, y: f64, tail: LawTail, choice: &Choice) -> (LawFigure, Option<f64>) {
        match self {
            Self::Line(inversion, contour, points) => {
                let [value, density] = inversion.tail_and_density(contour, y, tail, points);
                match is_poor(value) {
                    true => (law.tail(y, tail), None),
                    false => (value, Some(-tail.sign() * density.value / value.value)),
                }
            }
            Self::Points(sampled, line) => {
                let exact = || match line {
                    Some((control, contour, points)) => Some(control.tail_and_density(contour, y, tail, points)[0]),
                    None => Some(sampled.control()?.tail(y, tail)),
                };
                (sampled.tail_by(y, tail, choice, exact), None)
            }
            Self::Panels(single) => (single.tail_nearly(y, tail), None),
            Self::Nothing => (law.tail(y, tail), None),
        }
    }
}
