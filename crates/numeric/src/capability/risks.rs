//! Risks of an inspection with a gauge that has an error: bad parts that it accepts, good parts that it rejects.
//!
//! The true value `x` has the distribution function `F`. The error of the gauge is `e = s t`, `t` standard normal. A part is accepted if `L
//! + g <= x + e <= U - g`:
//!
//! ```text
//! bad below and accepted    int_{g/s}^inf   phi(t) [F(min(L, U - g - s t)) - F(L + g - s t)] dt
//! good, rejected below      int_{-inf}^{g/s} phi(t) [F(min(U, L + g - s t)) - F(L)] dt
//! ```
//!
//! The upper side is the mirror image, computed with the upper tail of the distribution, so that small shares keep their digits. Only `F`
//! is used, so that any distribution will do, also that of measured values. Source: Deaver (1995), NCSLI RP-19; by integrals over the part
//! in place of the error.

use crate::characteristic::{KeptLimits, SpecLimits};
use crate::distribution::standard_normal;
use crate::pearson::LEGENDRE;

/// Greatest error of the gauge in its sigmas. Larger ones are neglected: 1e-19 of all.
const REACH: f64 = 9.0;
/// Greatest number of halvings of an interval. A step function needs them all and keeps an error.
const HALVINGS: u32 = 9;
/// Absolute error accepted for the integral over an interval, as a share of all parts.
const ABSOLUTE: f64 = 1e-13;
/// Relative error accepted for the integral over an interval.
const RELATIVE: f64 = 1e-10;
/// Greatest number of steps of the search for a guard.
const STEPS: usize = 60;
/// Greatest guard, as a part of half the width between two limits. More leaves next to no interval of acceptance.
const ROOM: f64 = 0.99;
/// Relative accuracy of a guard.
const CLOSE: f64 = 1e-9;

/// Shares of a distribution strictly below and strictly above a value.
pub struct Tails<'t> {
    /// Share strictly below a value.
    pub below: &'t dyn Fn(f64) -> f64,
    /// Share strictly above a value.
    pub above: &'t dyn Fn(f64) -> f64,
}

/// Risks of an inspection, as shares of all parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Risks {
    /// Share of parts that are bad and accepted: the consumer's risk.
    pub false_accept: f64,
    /// Share of parts that are good and rejected: the producer's risk.
    pub false_reject: f64,
    /// Error of the integration, valid for either share.
    pub error: f64,
}

impl Risks {
    /// Risks with a gauge of this sigma and the limits tightened by `guard`.
    pub fn of(tails: &Tails<'_>, limits: SpecLimits, gauge: f64, guard: f64) -> Self {
        let sides = sides(tails, limits, gauge, guard);
        let [[a, b], [c, d]] = sides.map(|side| [side.false_accept(), side.false_reject()]);
        Self { false_accept: a.0 + c.0, false_reject: b.0 + d.0, error: a.1 + b.1 + c.1 + d.1 }
    }
}

/// Least guard with which at most `rate` of all parts are bad and accepted. Returns None if no guard reaches that.
pub fn guard_for(tails: &Tails<'_>, limits: SpecLimits, gauge: f64, rate: f64) -> Option<f64> {
    let accepted =
        |guard: f64| sides(tails, limits, gauge, guard).iter().map(|side| side.false_accept().0).sum::<f64>();
    guard_reaching(&accepted, limits, gauge, rate)
}

/// Least guard for any function `accepted` that falls with the guard: the share of bad parts that are accepted.
pub fn guard_reaching(accepted: &dyn Fn(f64) -> f64, limits: SpecLimits, gauge: f64, rate: f64) -> Option<f64> {
    if accepted(0.0) <= rate {
        return Some(0.0);
    }
    // Nine sigmas of the gauge inside a limit no bad part is accepted.
    let widest = limits.lower().zip(limits.upper()).map(|(lower, upper)| 0.5 * (upper - lower));
    let (mut low, mut high) = (0.0, widest.map_or(REACH * gauge, |half| (ROOM * half).min(REACH * gauge)));
    if accepted(high) > rate {
        return None;
    }
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        match accepted(middle) > rate {
            true => low = middle,
            false => high = middle,
        }
        if high - low <= CLOSE * high {
            break;
        }
    }
    Some(high)
}

/// Probability that a part with this true value is accepted.
pub fn acceptance(x: f64, limits: KeptLimits, gauge: f64, guard: f64) -> f64 {
    let accepted = limits.tightened(guard);
    if gauge == 0.0 {
        return f64::from(u8::from(accepted.contains(x)));
    }
    let [low, high] = accepted.ends().map(|end| standard_normal::cdf((end - x) / gauge));
    (high - low).max(0.0)
}

/// One side of the limits: the lower one, or the upper one as the lower one of the mirrored axis.
struct Side<'t> {
    /// Share strictly beyond a value of the mirrored axis.
    tail: &'t dyn Fn(f64) -> f64,
    sign: f64,
    limit: Option<f64>,
    /// Other limit, infinite if there is none.
    far: f64,
    gauge: f64,
    guard: f64,
}

fn sides<'t>(tails: &Tails<'t>, limits: SpecLimits, gauge: f64, guard: f64) -> [Side<'t>; 2] {
    let (lower, upper) = (limits.lower(), limits.upper());
    let minus = |limit: Option<f64>| limit.map(|limit| -limit);
    let side = |tail, sign, limit, far: Option<f64>| Side {
        tail,
        sign,
        limit,
        far: far.unwrap_or(f64::INFINITY),
        gauge,
        guard,
    };
    [side(tails.below, 1.0, lower, upper), side(tails.above, -1.0, minus(upper), minus(lower))]
}

impl Side<'_> {
    fn beyond(&self, x: f64) -> f64 {
        (self.tail)(self.sign * x)
    }

    /// Share that is beyond the limit and accepted, and the error of the integration.
    fn false_accept(&self) -> (f64, f64) {
        let Some(limit) = self.limit.filter(|_| self.gauge > 0.0) else { return (0.0, 0.0) };
        let from = self.guard / self.gauge;
        // Beyond `turn` the far limit, too, decides which of these parts are accepted.
        let turn = (self.far - self.guard - limit) / self.gauge;
        let share = |t: f64| {
            let nearest = limit.min(self.far - self.guard - self.gauge * t);
            self.beyond(nearest) - self.beyond(limit + self.guard - self.gauge * t)
        };
        integral(&share, [from, from.max(0.0) + REACH], turn)
    }

    /// Share that is within the limits and measured beyond the tightened limit, and the error of the integration.
    fn false_reject(&self) -> (f64, f64) {
        let Some(limit) = self.limit else { return (0.0, 0.0) };
        let own = self.beyond(limit);
        if self.gauge == 0.0 {
            // Without an error of the gauge, exactly the share between the limit and its guard.
            return ((self.beyond(self.far.min(limit + self.guard)) - own).max(0.0), 0.0);
        }
        let turn = (limit + self.guard - self.far) / self.gauge;
        let share = |t: f64| self.beyond(self.far.min(limit + self.guard - self.gauge * t)) - own;
        integral(&share, [-REACH, (self.guard / self.gauge).min(REACH)], turn)
    }
}

/// Integral of a share times the standard normal density, with a bend at `turn`: value and error.
fn integral(share: &dyn Fn(f64) -> f64, [from, to]: [f64; 2], turn: f64) -> (f64, f64) {
    let f = |t: f64| share(t) * standard_normal::density(t);
    let inside = from < turn && turn < to;
    let pieces = if inside { vec![[from, turn], [turn, to]] } else { vec![[from, to]] };
    let mut sum = (0.0, 0.0);
    for [from, to] in pieces {
        let (value, error) = halved(&f, [from, to], legendre(&f, [from, to]), HALVINGS);
        sum = (sum.0 + value, sum.1 + error);
    }
    sum
}

/// Integral over an interval by its halves, halved further while they differ from the whole. `left` is the number of halvings left.
fn halved(f: &dyn Fn(f64) -> f64, [from, to]: [f64; 2], whole: f64, left: u32) -> (f64, f64) {
    let middle = 0.5 * (from + to);
    let halves = [[from, middle], [middle, to]];
    let parts = halves.map(|half| legendre(f, half));
    let (value, error) = (parts[0] + parts[1], (parts[0] + parts[1] - whole).abs());
    if left == 0 || error <= ABSOLUTE.max(RELATIVE * value.abs()) {
        return (value, error);
    }
    let [a, b] = [0, 1].map(|half| halved(f, halves[half], parts[half], left - 1));
    (a.0 + b.0, a.1 + b.1)
}

fn legendre(f: &dyn Fn(f64) -> f64, [from, to]: [f64; 2]) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    half * LEGENDRE.iter().map(|(x, weight)| weight * (f(middle - half * x) + f(middle + half * x))).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pearson::Pearson;

    /// Uniform part on 0 to 1 with a limit at 1/2: E[e+] = s/sqrt(2 pi) on either side, as long as no error reaches beyond the part.
    #[test]
    fn a_uniform_part_at_one_limit_has_a_closed_form() {
        let (below, above) = (|x: f64| x.clamp(0.0, 1.0), |x: f64| (1.0 - x).clamp(0.0, 1.0));
        let tails = Tails { below: &below, above: &above };
        let limits = SpecLimits::new(Some(0.5), None).unwrap();
        let truth = 0.01 / (2.0 * std::f64::consts::PI).sqrt();
        let found = Risks::of(&tails, limits, 0.01, 0.0);
        // Neglected errors beyond nine sigmas: 1e-19.
        assert!((found.false_accept - truth).abs() < 1e-13 && (found.false_reject - truth).abs() < 1e-13, "{found:?}");
        // A gauge without error accepts no bad part, and rejects the share within the guard.
        let exact = Risks::of(&tails, limits, 0.0, 0.1);
        assert!(exact.false_accept == 0.0 && (exact.false_reject - 0.1).abs() < 1e-15, "{exact:?}");
    }

    #[test]
    fn a_guard_reaches_the_rate_that_is_asked_for() {
        let law = Pearson::normal(0.0, 4.0).unwrap();
        let (below, above) = (|x: f64| law.cdf(x), |x: f64| law.sf(x));
        let tails = Tails { below: &below, above: &above };
        let limits = SpecLimits::new(Some(-8.0), Some(8.0)).unwrap();
        let guard = guard_for(&tails, limits, 1.0, 0.001).unwrap();
        let found = Risks::of(&tails, limits, 1.0, guard);
        // The guard has a relative accuracy of 1e-9.
        assert!((found.false_accept - 0.001).abs() < 1e-10, "{found:?} {guard}");
        assert_eq!(guard_for(&tails, limits, 1.0, 0.01), Some(0.0));
        let narrow = SpecLimits::new(Some(-0.001), Some(0.001)).unwrap();
        assert_eq!(guard_for(&tails, narrow, 1.0, 1e-12), None);
    }
}
