//! Both tails and the density from the transform, by the trapezoidal rule along a contour.
//!
//! ```text
//! sf(y) = 1/pi int_0^inf Re[ exp(K(s) - s y)/s ] dt,  s = theta + i t, theta > 0;   cdf: theta < 0, sign changed
//! ```
//!
//! Each tail is summed directly, with a relative accuracy of its own (Rice 1980; Lugannani and Rice 1980; Abate and Whitt 1992; Trefethen
//! and Weideman 2014). For uniform inputs and atoms the transform decays too slowly to be summed to its end. A smooth window then ends the
//! sum. It changes the result only if the density has a corner within 110/T of the limit. T is doubled until two windows agree.

use std::cell::Cell;
use std::f64::consts::PI;
use std::sync::Arc;

use crate::distribution::standard_normal;
use crate::law::inversion::complex::Complex;
use crate::law::inversion::contour::{Contour, Side};
use crate::law::inversion::transform::Transform;
use crate::law::{LawFigure, LawTail};

/// Points of the first window.
const FIRST: usize = 64;
/// Points of the last window if panels or trees are summed.
const LAST: usize = 1 << 11;
/// Points of the last window for closed forms and atoms, which cost less for each point.
const LAST_CHEAP: usize = 1 << 14;
/// Points of the last window for perturbed forms, which take a few nodes for each point.
const LAST_PERTURBED: usize = 1 << 13;
/// Factor from the difference of windows to the error of a contour that ended early. Such windows may agree by chance.
const ENDED_EARLY: f64 = 40.0;
/// Smallest number of points of a contour from which a figure is computed.
const FEWEST: usize = 8;
/// Relative size of the remainder at which the sum ends.
const ENDED: f64 = 1e-14;
/// Relative difference at which two windows agree.
const AGREED: f64 = 1e-11;
/// Relative difference of two windows that suffices for a quantile, which moves by at most a third of it in sigmas.
const NEARLY: f64 = 1e-8;
/// Steepness of a window: at its ends it differs from 1 and 0 by 1e-13.
const STEEPNESS: f64 = 10.4;
/// Relative part of the sum that a window loses at its own ends.
const LEFT: f64 = 4e-13;
/// Stated relative error of the sums: rounding of the transform and the images in Poisson's formula.
const RELATIVE: f64 = 1e-12;
/// Distance from the mean, in sigmas, within which either tail has its own contour. Beyond it the larger tail is the complement.
const CENTRAL: f64 = 1.5;

/// Distribution of a sum of components with known transform.
#[derive(Debug)]
pub(in crate::law) struct Inversion {
    pub(in crate::law) transform: Transform,
    /// Centre of the surface, from which limits are counted.
    centre: f64,
    /// Values with a probability of their own, about the centre, ascending. Sums along a contour would halve those at the limit, so they
    /// are kept out of the sums.
    jumps: Vec<(f64, f64)>,
    sides: [Side; 2],
}

/// Quantity that is summed along a contour.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    LawTail(LawTail),
    Density,
}

impl Inversion {
    pub(in crate::law) fn new(transform: Transform, centre: f64) -> Self {
        let sides = [LawTail::Lower, LawTail::Upper].map(|tail| Side::new(tail, &transform));
        Self { transform, centre, jumps: Vec::new(), sides }
    }

    /// Adds these values, each with a probability of its own.
    pub(in crate::law) fn with_jumps(self, jumps: impl Iterator<Item = (f64, f64)>) -> Self {
        let jumps = jumps.map(|(y, weight)| (y - self.centre, weight)).collect();
        Self { jumps, ..self }
    }

    /// Probability of the separate values strictly beyond a limit that is counted from the centre.
    fn jumps_beyond(&self, y: f64, tail: LawTail) -> f64 {
        let beyond = |at: f64| tail.sign() * (at - y) > 0.0;
        self.jumps.iter().filter(|(at, _)| beyond(*at)).map(|(_, weight)| weight).sum()
    }

    pub(in crate::law) fn mean(&self) -> f64 {
        self.centre + self.transform.mean
    }

    pub(in crate::law) fn sigma(&self) -> f64 {
        self.transform.sigma
    }

    /// True if sums over nodes resolve the distribution at the mean, where both sides must also sum to 1, and farther out on both sides.
    pub(in crate::law) fn is_resolved(&self) -> bool {
        /// Greatest relative error of a tail. Beyond it points are as good.
        const RESOLVED: f64 = 1e-4;
        /// Tilts times sigma whose limits are tried. In a normal distribution these are the same numbers of sigmas from the mean.
        const TILTS: [f64; 2] = [1.5, 3.0];
        /// Fraction of the domain to which a tilt is limited.
        const INNER: f64 = 0.7;
        if self.transform.are_sums_closed() {
            return true;
        }
        let good = |figure: &LawFigure| figure.value.is_finite() && figure.error <= RESOLVED * figure.value;
        let sum = |y: f64, tail: LawTail| self.with_jumps_beyond(self.sum(y, tail, Quantity::LawTail(tail)), y, tail);
        let sides = [LawTail::Lower, LawTail::Upper];
        let halves = sides.map(|tail| sum(self.transform.mean, tail));
        let middle: f64 =
            self.jumps.iter().filter(|(at, _)| *at == self.transform.mean).map(|(_, weight)| weight).sum();
        let whole: f64 = halves.iter().map(|half| half.value).sum::<f64>() + middle;
        let [low, high] = self.transform.domain;
        let limit = |tail: LawTail, tilt: f64| {
            let theta = tail.sign() * tilt / self.sigma();
            self.transform.cumulants(theta.clamp(INNER * low, INNER * high))[1]
        };
        halves.iter().all(good)
            && (whole - 1.0).abs() <= RESOLVED
            && sides.iter().all(|&tail| TILTS.iter().all(|&tilt| good(&sum(limit(tail, tilt), tail))))
    }

    /// Mean about the centre under a tilt, or under the nearest tilt inside the domain.
    pub(in crate::law) fn tilted_mean(&self, theta: f64) -> f64 {
        let [low, high] = self.transform.domain;
        self.transform.cumulants(theta.clamp(0.9 * low, 0.9 * high))[1]
    }

    /// Probability beyond `y` on one side.
    pub(in crate::law) fn tail(&self, y: f64, tail: LawTail) -> LawFigure {
        let y = y - self.centre;
        if let Some(z) = self.normal(y) {
            let value = if tail == LawTail::Lower { standard_normal::cdf(z) } else { standard_normal::sf(z) };
            return LawFigure::new(value, 4.0 * f64::EPSILON * value * (1.0 + z * z));
        }
        let outward = tail.sign() * (y - self.transform.mean) / self.sigma();
        let own = if outward < -CENTRAL { tail.other() } else { tail };
        let found = self.with_jumps_beyond(self.sum(y, own, Quantity::LawTail(own)), y, own);
        if own == tail { found } else { found.complement() }
    }

    /// Adds the separate values beyond the limit to the tail of the part with a density.
    fn with_jumps_beyond(&self, smooth: LawFigure, y: f64, tail: LawTail) -> LawFigure {
        LawFigure::new((smooth.value + self.jumps_beyond(y, tail)).min(1.0), smooth.error)
    }

    /// Density per unit of `y`.
    pub(in crate::law) fn density(&self, y: f64) -> LawFigure {
        let y = y - self.centre;
        if let Some(z) = self.normal(y) {
            let value = standard_normal::density(z) / self.sigma();
            return LawFigure::new(value, 4.0 * f64::EPSILON * value * (1.0 + z * z));
        }
        let tail = if y < self.transform.mean { LawTail::Lower } else { LawTail::Upper };
        self.sum(y, tail, Quantity::Density)
    }

    /// Contour for several limits of one side: exact at the first of these limits and up to the second, which lies farther out. Returns
    /// None for a quadratic form, for which a contour for each limit costs little.
    pub(in crate::law) fn shared(&self, tail: LawTail, [y, farthest]: [f64; 2]) -> Option<Arc<Contour>> {
        let many = !self.transform.is_form();
        many.then(|| self.side(tail).contour_to(&self.transform, y - self.centre, farthest - self.centre))
    }

    /// A tail and the density along a contour that several limits share. `points` holds the points that the last limit took.
    pub(in crate::law) fn tail_and_density(
        &self,
        contour: &Contour,
        y: f64,
        tail: LawTail,
        points: &Cell<usize>,
    ) -> [LawFigure; 2] {
        let y = y - self.centre;
        let (value, window) = self.along(contour, y, Quantity::LawTail(tail), Extent::Nearly(points.get()));
        // Begin the next limit at the window before the last one, so that two windows are compared again.
        points.set(window.points / 2);
        let (density, _) = self.along(contour, y, Quantity::Density, Extent::Fixed(window));
        [self.with_jumps_beyond(value, y, tail), density]
    }

    /// True if the distribution is normal.
    pub(in crate::law) fn is_normal(&self) -> bool {
        self.transform.forms.is_normal() && self.transform.is_form()
    }

    /// Standardised limit. Returns None if the distribution is not normal.
    fn normal(&self, y: f64) -> Option<f64> {
        self.is_normal().then(|| (y - self.transform.mean) / self.sigma())
    }

    fn side(&self, tail: LawTail) -> &Side {
        &self.sides[usize::from(tail == LawTail::Upper)]
    }

    /// Quantity at a limit that is counted from the centre.
    fn sum(&self, y: f64, tail: LawTail, quantity: Quantity) -> LawFigure {
        let contour = self.side(tail).contour(&self.transform, y);
        self.along(&contour, y, quantity, Extent::From(FIRST)).0
    }

    /// Sum along a contour over the points that `extent` requests, and the window that was used.
    fn along(&self, contour: &Contour, y: f64, quantity: Quantity, extent: Extent) -> (LawFigure, Window) {
        let transform = &self.transform;
        let most = match (transform.is_cheap(), transform.is_perturbed()) {
            (true, _) => LAST_CHEAP,
            (false, true) => LAST_PERTURBED,
            (false, false) => LAST,
        };
        let (mut count, agreed, fixed) = match extent {
            Extent::From(points) => (points.max(FIRST), AGREED, None),
            Extent::Nearly(points) => (points.max(FIRST), NEARLY, None),
            Extent::Fixed(window) => (window.points, AGREED, Some(window)),
        };
        let mut previous = f64::NAN;
        let (sum, off, largest, window) = loop {
            let terms = self.terms(contour, y, quantity, count);
            if terms.len() < FEWEST {
                // Sums over nodes resolve next to nothing of the contour.
                return (LawFigure::new(f64::NAN, f64::INFINITY), Window { points: FIRST, smooth: true });
            }
            let ended = terms.len() < count;
            let largest = terms.iter().map(|term| term.abs()).fold(0.0, f64::max);
            let last = terms[terms.len() - terms.len() / 4..].iter().map(|term| term.abs()).fold(0.0, f64::max);
            let plain: f64 = terms.iter().map(|term| term.re).sum();
            let left = last * terms.len() as f64;
            let window = |smooth: bool| Window { points: terms.len(), smooth };
            if let Some(fixed) = fixed {
                let now = if fixed.smooth { windowed(&terms) } else { plain };
                break (now, if fixed.smooth { LEFT * now.abs() } else { left }, largest, fixed);
            }
            if left < ENDED * plain.abs() {
                break (plain, left, largest, window(false));
            }
            let now = windowed(&terms);
            // A contour that has ended is compared with shorter windows, because the same window again would agree.
            let off = if ended { shortened(&terms, now) } else { (now - previous).abs() };
            if off < agreed * now.abs() || count >= most || ended {
                let factor = if ended { ENDED_EARLY } else { 4.0 };
                let off = if off.is_nan() { now.abs() } else { factor * off + LEFT * now.abs() };
                break (now, off, largest, window(true));
            }
            (previous, count) = (now, 2 * count);
        };
        // Rounding error of the sum.
        let rounding = 1e-15 * (window.points as f64).sqrt() * largest;
        let level = libm::exp(contour.log - contour.theta * y) * contour.step / PI;
        let value = level * sum;
        let value = if quantity == Quantity::Density { value.max(0.0) } else { value.clamp(0.0, 1.0) };
        (LawFigure::new(value, level * (off + rounding) + RELATIVE * value), window)
    }

    /// Contour and window of a tail, and whether the tail is computed as the complement of the other one.
    pub(in crate::law) fn held(&self, y: f64, tail: LawTail) -> Line {
        let y = y - self.centre;
        let outward = tail.sign() * (y - self.transform.mean) / self.sigma();
        let own = if outward < -CENTRAL { tail.other() } else { tail };
        let contour = self.side(own).contour(&self.transform, y);
        let (_, window) = self.along(&contour, y, Quantity::LawTail(own), Extent::From(FIRST));
        Line {
            tail: own,
            complement: own != tail,
            theta: contour.theta,
            step: contour.step,
            bend: contour.bend,
            window,
        }
    }

    /// Tail of this distribution along the contour of another one. Returns None if the transform does not exist there.
    pub(in crate::law) fn tail_along(&self, y: f64, line: &Line) -> Option<LawFigure> {
        let [low, high] = self.transform.domain;
        if !(low < line.theta && line.theta < high) {
            return None;
        }
        let y = y - self.centre;
        let contour = Contour::fixed(&self.transform, line.theta, line.step, line.bend);
        let (found, _) = self.along(&contour, y, Quantity::LawTail(line.tail), Extent::Fixed(line.window));
        let found = self.with_jumps_beyond(found, y, line.tail);
        Some(if line.complement { found.complement() } else { found })
    }

    /// Derivatives of a tail by parameters. `changes` gives the derivatives of `K` by them at the points of the contour.
    pub(in crate::law) fn derivatives(
        &self,
        y: f64,
        tail: LawTail,
        changes: impl Fn(&Contour, usize) -> Vec<Vec<Complex>>,
    ) -> Vec<LawFigure> {
        let line = self.held(y, tail);
        let y = y - self.centre;
        let contour = self.side(line.tail).contour(&self.transform, y);
        // A derivative decays more slowly than the tail itself.
        let count = 2 * line.window.points;
        let terms = weighed(&contour, contour.integrand(&self.transform, y, count), Quantity::LawTail(line.tail));
        let sign = if line.complement { -1.0 } else { 1.0 };
        let level = sign * libm::exp(contour.log - contour.theta * y) * contour.step / PI;
        let of = |change: &Vec<Complex>| {
            let product = |count: usize| -> Vec<Complex> {
                terms.iter().zip(change).take(count).map(|(term, change)| *term * *change).collect()
            };
            let (whole, half) = (windowed(&product(count)), windowed(&product(count / 2)));
            LawFigure::new(level * whole, level.abs() * ((whole - half).abs() + 1e-11 * whole.abs()))
        };
        changes(&contour, terms.len()).iter().map(of).collect()
    }
}

impl Inversion {
    /// Terms of the sum at the first points, with the first one halved and without the separate values:
    ///
    /// ```text
    /// M(s) - sum_k p_k exp(s y_k)
    /// ```
    fn terms(&self, contour: &Contour, y: f64, quantity: Quantity, count: usize) -> Vec<Complex> {
        let mut terms = contour.integrand(&self.transform, y, count);
        for &(at, weight) in &self.jumps {
            let weight = weight * libm::exp(contour.theta * at - contour.log);
            for (index, term) in terms.iter_mut().enumerate() {
                *term = *term - Complex::cis(contour.step * index as f64 * (at - y)) * weight;
            }
        }
        weighed(contour, terms, quantity)
    }
}

/// Number of points of a sum.
#[derive(Debug, Clone, Copy)]
enum Extent {
    /// Smallest number of points; more are added until two windows agree.
    From(usize),
    /// Smallest number of points of a quantile; more are added until two windows agree well enough.
    Nearly(usize),
    /// Points and window of another sum.
    Fixed(Window),
}

/// Number of points of a sum, and whether a smooth window ends it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::law) struct Window {
    points: usize,
    smooth: bool,
}

/// Contour with the points on it that give a tail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::law) struct Line {
    tail: LawTail,
    complement: bool,
    theta: f64,
    step: f64,
    bend: f64,
    window: Window,
}

/// Turns values of the integrand into terms of the sum and halves the first one.
fn weighed(contour: &Contour, mut terms: Vec<Complex>, quantity: Quantity) -> Vec<Complex> {
    for (index, term) in terms.iter_mut().enumerate() {
        let s = contour.s(index);
        if let Quantity::LawTail(tail) = quantity {
            *term = *term / (s * tail.sign());
        }
        if contour.bend != 0.0 {
            // ds = (2 bend t + i) dt, and the factor i is taken out of the sum.
            *term *= Complex::new(1.0, -2.0 * contour.bend * s.im);
        }
    }
    if let Some(first) = terms.first_mut() {
        *first = *first * 0.5;
    }
    terms
}

/// Largest difference between shorter windows and the whole one.
fn shortened(terms: &[Complex], whole: f64) -> f64 {
    /// Lengths of the shorter windows, in eighths of the whole one.
    const EIGHTHS: [usize; 2] = [6, 7];
    let off = |eighths: usize| (windowed(&terms[..terms.len() * eighths / 8]) - whole).abs();
    EIGHTHS.iter().map(|&eighths| off(eighths)).fold(0.0, f64::max)
}

/// Sum of the real parts under a window that falls smoothly to 0 at the end.
fn windowed(terms: &[Complex]) -> f64 {
    let n = terms.len() as f64;
    let window = |index: usize| 0.5 * libm::erfc(STEEPNESS * (index as f64 / n - 0.5));
    terms.iter().enumerate().map(|(index, term)| term.re * window(index)).sum()
}
