//! Contours through the saddle point, and the values of the transform on them, which many limits share.
//!
//! Tilts stand on a fixed ladder, so the contour of a limit depends on the limit alone and not on earlier calls. Results therefore do not
//! depend on order or threads. Limits are counted from the centre of the surface. A contour keeps the transform at its points. Each further
//! limit costs one sum.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::law::LawTail;
use crate::law::inversion::complex::Complex;
use crate::law::inversion::single_input::BLOCK;
use crate::law::inversion::transform::Transform;

/// Ratio of neighbouring tilts on the ladder, `2^(1/4)`. Using the nearest one costs half a digit at 40 sigma and nothing closer in.
const STEP: f64 = 1.189_207_115_002_721;
/// Least tilt, times sigma.
const LEAST: f64 = 1.2;
/// Greatest tilt, times sigma, where the domain of the transform has no end: for closed forms, for panels, for trees.
const MOST: [f64; 3] = [1e9, 3000.0, 300.0];
/// Negative logarithm of the greatest relative error that a neighbouring image may add to a tail in Poisson's formula.
const NEIGHBOUR: f64 = 32.0;
/// Negative logarithm of the factor by which the image on the side of the domain's end has decayed.
const ROOM: f64 = 80.0;

/// Tilts of one side of the law, and the contours computed for them.
#[derive(Debug)]
pub(in crate::law) struct Side {
    tail: LawTail,
    least: f64,
    most: f64,
    rungs: Mutex<Vec<Rung>>,
    contours: Mutex<BTreeMap<Key, Arc<Contour>>>,
}

/// Tilt with its cumulants and the range of limits that use it.
#[derive(Debug, Clone, Copy)]
struct Rung {
    theta: f64,
    cumulants: [f64; 3],
    /// Farthest limit that uses this tilt.
    until: f64,
}

/// Rung index, doublings of the spacing, and the direction in which the contour is bent.
type Key = (usize, u32, i8);

/// Contour `s = theta + bend t^2 + i t`, in equal steps of `t`.
#[derive(Debug)]
pub(in crate::law) struct Contour {
    pub(in crate::law) theta: f64,
    pub(in crate::law) step: f64,
    pub(in crate::law) bend: f64,
    /// `K(theta)`.
    pub(in crate::law) log: f64,
    /// Contribution of every single input to `K(theta)`.
    logs: Vec<f64>,
    values: Mutex<Values>,
}

#[derive(Debug, Default)]
struct Values {
    /// `M(s)/M(theta)`, or its logarithm if the contour is bent.
    at: Vec<Complex>,
    /// True if sums over nodes resolve no point farther out.
    ended: bool,
}

impl Side {
    pub(in crate::law) fn new(tail: LawTail, transform: &Transform) -> Self {
        let end = match tail {
            LawTail::Upper => transform.domain[1],
            LawTail::Lower => -transform.domain[0],
        };
        let kind = match (transform.is_closed(), transform.are_sums_closed()) {
            (true, _) => 0,
            (_, true) => 1,
            _ => 2,
        };
        let least = (LEAST / transform.sigma).min(0.5 * end);
        let most = (0.75 * end).min(MOST[kind] / transform.sigma);
        Self { tail, least, most, rungs: Mutex::default(), contours: Mutex::default() }
    }

    fn sign(&self) -> f64 {
        self.tail.sign()
    }

    /// Rung whose saddle point is nearest to a limit.
    fn rung(&self, transform: &Transform, y: f64) -> (usize, Rung) {
        let mut rungs = self.rungs.lock().unwrap_or_else(PoisonError::into_inner);
        for place in 0.. {
            if place == rungs.len() {
                let size = (self.least * STEP.powi(place as i32)).min(self.most);
                let between = (size * STEP.sqrt()).min(self.most);
                let cumulants = transform.cumulants(self.sign() * size);
                let until = match size >= self.most {
                    true => self.sign() * f64::INFINITY,
                    false => transform.cumulants(self.sign() * between)[1],
                };
                rungs.push(Rung { theta: self.sign() * size, cumulants, until });
            }
            let rung = rungs[place];
            if self.sign() * (rung.until - y) >= 0.0 {
                return (place, rung);
            }
        }
        unreachable!("the last rung is used up to infinity")
    }

    pub(in crate::law) fn contour(&self, transform: &Transform, y: f64) -> Arc<Contour> {
        self.contour_to(transform, y, y)
    }

    /// Contour for one limit, with points so dense that it also serves every limit of this side up to `farthest`.
    pub(in crate::law) fn contour_to(&self, transform: &Transform, y: f64, farthest: f64) -> Arc<Contour> {
        let (place, rung) = self.rung(transform, y);
        let (theta, [log, _, spread]) = (rung.theta, rung.cumulants);
        let end = match self.tail {
            LawTail::Upper => transform.domain[1],
            LawTail::Lower => -transform.domain[0],
        };
        let room = end - theta.abs();
        // By Poisson's formula the sum is sum_m exp(theta m D) sf(y + m D). The spacing D keeps both neighbours m = -1 and m = 1
        // negligible.
        let below = |y: f64| (NEIGHBOUR + (theta * y - log).max(0.0)) / theta.abs();
        let least = below(if rung.until.is_finite() { rung.until } else { transform.mean })
            .max(if room.is_finite() { ROOM / room } else { 0.0 })
            .max(10.0 * spread.max(0.0).sqrt());
        let doublings = libm::ceil(2.0 * libm::log2(below(farthest) / least)).max(0.0);
        let spacing = least * libm::exp2(0.5 * doublings);
        let bend = match transform.vertex {
            // A parabola can be bent by this part of the distance without leaving the domain.
            Some(vertex) => {
                let size = if room.is_finite() { theta.abs().max(room) } else { theta.abs() };
                (0.12 / size).copysign(y - vertex)
            }
            None => 0.0,
        };
        let key = (place, doublings as u32, if bend == 0.0 { 0 } else { bend.signum() as i8 });
        let mut contours = self.contours.lock().unwrap_or_else(PoisonError::into_inner);
        let made = contours.entry(key).or_insert_with(|| {
            let step = 2.0 * std::f64::consts::PI / spacing;
            Arc::new(Contour { theta, step, bend, log, logs: transform.logs(theta), values: Mutex::default() })
        });
        Arc::clone(made)
    }
}

impl Contour {
    /// Contour with this tilt and these steps for any law.
    pub(in crate::law) fn fixed(transform: &Transform, theta: f64, step: f64, bend: f64) -> Self {
        let [log, ..] = transform.cumulants(theta);
        Self { theta, step, bend, log, logs: transform.logs(theta), values: Mutex::default() }
    }

    pub(in crate::law) fn s(&self, index: usize) -> Complex {
        let t = self.step * index as f64;
        Complex::new(self.theta + self.bend * t * t, t)
    }

    /// `exp(K(s) - K(theta) - (s - theta) y)` at the first `count` points. The result is shorter if sums over nodes ended the contour.
    pub(in crate::law) fn integrand(&self, transform: &Transform, y: f64, count: usize) -> Vec<Complex> {
        let mut values = self.values.lock().unwrap_or_else(PoisonError::into_inner);
        while values.at.len() < count && !values.ended {
            self.extend(transform, &mut values);
        }
        let known = values.at.iter().take(count).enumerate();
        match self.bend == 0.0 {
            true => known.map(|(i, value)| *value * Complex::cis(-self.step * i as f64 * y)).collect(),
            false => known.map(|(i, log)| (*log - (self.s(i) - Complex::from(self.theta)) * y).exp()).collect(),
        }
    }

    /// Computes one more block of points.
    fn extend(&self, transform: &Transform, values: &mut Values) {
        let first = values.at.len();
        let mut block = vec![Complex::ONE; BLOCK];
        match self.bend == 0.0 {
            true => {
                let from = self.step * first as f64;
                let resolved = transform.ratios(self.theta, &self.logs, from, self.step, &mut block);
                block.truncate(resolved);
            }
            false => {
                let points: Vec<Complex> = (0..BLOCK).map(|i| self.s(first + i)).collect();
                block = transform.bent_logs(self.theta, &points);
            }
        }
        values.ended = block.len() < BLOCK;
        values.at.extend(block);
    }
}
