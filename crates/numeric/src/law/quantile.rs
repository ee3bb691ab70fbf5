//! Quantiles: the limit beyond which a tail has a given probability, by its logarithm.

use std::cell::Cell;
use std::sync::Arc;

use super::contour::Contour;
use super::exact::is_poor;
use super::inversion::Inversion;
use super::sampled::{Choice, Sampled};
use super::single::Single;
use super::{Kind, LawFigure, LawTail, SurfaceLaw};

/// Steps at most: a dozen when all is well.
const STEPS: usize = 200;
/// Part of sigma within which two limits are one.
const SAME: f64 = 1e-14;

/// The limit at which a tail of the law has the probability `p`, above 0 and at most one half.
pub(super) fn quantile(law: &SurfaceLaw, tail: LawTail, p: f64) -> LawFigure {
    let (mean, sigma) = (law.mean(), law.sigma());
    let sign = tail.sign();
    // Outward from the mean; positive while the tail is too heavy.
    let open = Cell::new(0.0);
    let gap = |u: f64| {
        let figure = law.tail(mean + sign * u, tail);
        // A small part of what the tail itself leaves open is not a difference. Next to nothing beside a large error is one.
        open.set(OPEN * figure.error / figure.value.max(p));
        libm::log(figure.value.max(1e-305) / p)
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
        if at.abs() <= open.get() || moved <= scale {
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

/// A quantile that is sought beside others: its tail, its probability, and where another law has it with its own density there.
#[derive(Debug, Clone, Copy)]
pub struct Sought {
    pub tail: LawTail,
    /// Above 0 and at most one half.
    pub p: f64,
    pub near: f64,
    pub density: f64,
}

/// A quantile that is sought beside others is found within this part of sigma,
const NEAR: f64 = 1e-7;
/// or this part of what a sample leaves open,
const OPEN: f64 = 0.02;
/// in so many steps, or by the search of [`quantile`]: a jump takes 30 halvings.
const MANY: usize = 80;
/// Of the way from the mean to the farthest quantile: the tilt of a limit there serves all of them. At three sigma it costs a digit.
const SHARED: f64 = 0.7;
/// Sigmas beyond the farthest place at which a shared contour is still right.
const MARGIN: f64 = 0.5;
/// Probabilities below this are sought with a tilt of their own where points are drawn: above it own points do as well.
const TILTED: f64 = 5e-3;

/// Several quantiles together: those of one tail share a contour, or points. None of them is looked for far from its place, so that a
/// quantile takes three or four values of the law.
pub(super) fn quantiles(law: &SurfaceLaw, sought: &[Sought]) -> Vec<LawFigure> {
    let sides = [LawTail::Lower, LawTail::Upper].map(|tail| Together::of(law, tail, sought));
    let one = |of: &Sought| near(law, &sides[usize::from(of.tail == LawTail::Upper)], of);
    sought.iter().map(one).collect()
}

/// Newton's method on the logarithm of a tail between bounds, which are halved where it does not close in.
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
        // The tail is too heavy: the quantile lies farther out.
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
        let close = (NEAR * sigma).max(if open.is_finite() { OPEN * open } else { 0.0 });
        // The slope of another law says nothing of how close a place is: next to a corner it may be infinite.
        let close_enough = step.abs() <= close && (measured.is_some() || here.abs() <= NEAR);
        if here == 0.0 || close_enough {
            return LawFigure::new((at + step).clamp(low, high), open + close);
        }
        if high - low <= close {
            return LawFigure::new(0.5 * (low + high), open.min(high - low) + close);
        }
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
        // Its search takes panels with all digits, hundreds of times.
        Together::Panels(_) => LawFigure::new(f64::NAN, f64::INFINITY),
        _ => law.quantile(tail, p),
    }
}

/// The common part of the quantiles of one tail.
enum Together<'l> {
    /// A contour, and how many points of it the last limit took.
    Line(&'l Inversion, Arc<Contour>, Cell<usize>),
    /// The points of a sample, and a contour of its control.
    Points(&'l Sampled, Option<(&'l Inversion, Arc<Contour>, Cell<usize>)>),
    /// Panels with fewer digits.
    Panels(&'l Single),
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

    /// The points with which a quantile is sought from here on.
    fn choice(&self, at: f64, tail: LawTail, p: f64) -> Choice {
        match self {
            Self::Points(sampled, _) => sampled.choice((p < TILTED).then_some(at), tail),
            _ => Choice::default(),
        }
    }

    /// A tail, and the slope of its logarithm where that comes with it.
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
