//! Transform of one input by itself: `M(s) = E exp(s g(z))` by Gauss panels that resolve its phase.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::elementary::{Elementary, Exp, Work, on_this_processor};
use crate::law::input::Input;
use crate::law::inversion::complex::Complex;
use crate::law::polynomial::{Quartic, derivative, roots, value};

/// Negative logarithm of the least weight under a tilt, relative to the largest. Nodes with less weight are left out.
pub(in crate::law) const LEAST: f64 = 46.0;
/// Points of a contour that are computed together, by a rotation from one to the next.
pub(in crate::law) const BLOCK: usize = 64;

/// Input that has no products with others.
#[derive(Debug)]
pub(in crate::law) struct Single {
    /// Index of the input in the surface.
    pub(in crate::law) input: usize,
    law: Arc<Input>,
    part: Quartic,
    /// Sum of the changes of the part over the support, by which tables grow.
    swing: f64,
    /// Tables by the binary logarithm of the largest `|s|` that they resolve. The second key is the tilt that a table was made for, or 0 if
    /// it serves all tilts.
    tables: Mutex<BTreeMap<(i32, u64), Arc<Table>>>,
}

/// Values of the part at nodes, and the logarithms of their weights.
#[derive(Debug)]
pub(in crate::law) struct Table {
    pub(in crate::law) z: Vec<f64>,
    pub(in crate::law) values: Vec<f64>,
    pub(in crate::law) logs: Vec<f64>,
}

/// Level of the tables that resolve `|s|` up to `top`: its binary logarithm, rounded up.
pub(in crate::law) fn level(top: f64) -> i32 {
    libm::ceil(libm::log2(top.max(1e-300))) as i32
}

impl Table {
    pub(in crate::law) fn of(law: &Input, part: &Quartic, level: i32, near: f64, within: [f64; 2]) -> Self {
        let nodes = law.nodes_within(part, libm::exp2(f64::from(level)), near, within);
        let values = nodes.z.iter().map(|&z| value(part, z)).collect();
        let logs = nodes.weight.iter().map(|&weight| libm::log(weight)).collect();
        Self { z: nodes.z, values, logs }
    }
}

/// Nodes with noticeable weight under a tilt: values of the part, and weights relative to the largest.
#[derive(Debug, Default)]
pub(in crate::law) struct Tilted {
    pub(in crate::law) z: Vec<f64>,
    pub(in crate::law) values: Vec<f64>,
    pub(in crate::law) weights: Vec<f64>,
    /// Logarithm of the divisor of the weights.
    pub(in crate::law) log: f64,
}

impl Single {
    pub(in crate::law) fn new(input: usize, law: Arc<Input>, part: Quartic) -> Self {
        let extremes = roots(&derivative(&part), law.ends);
        let places = extremes.as_slice().iter().copied().chain([law.ends[1]]);
        let (swing, _) = places
            .map(|z| value(&part, z))
            .fold((0.0, value(&part, law.ends[0])), |(sum, before), at| (sum + f64::abs(at - before), at));
        Self { input, law, part, swing, tables: Mutex::default() }
    }

    /// True if one table of the whole support serves all tilts of a level.
    fn is_shared(&self, level: i32) -> bool {
        /// Largest phase over the support, in radians, of a table that all tilts share: about a thousand nodes. Beyond it a table of the
        /// interval with weight, which has one or two hundred, costs less although it serves one tilt only.
        const LARGEST: f64 = 576.0;
        /// Sum of the changes from which on tables are shared at any level, because levels end.
        const ENDLESS: f64 = 1e100;
        let phase = self.swing * libm::exp2(f64::from(level));
        phase <= LARGEST || self.swing.is_nan() || self.swing > ENDLESS
    }

    fn table(&self, level: i32) -> Arc<Table> {
        self.table_for(level, 0, || [f64::NEG_INFINITY, f64::INFINITY])
    }

    fn table_for(&self, level: i32, key: u64, within: impl FnOnce() -> [f64; 2]) -> Arc<Table> {
        let mut tables = self.tables.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(table) = tables.get(&(level, key)) {
            return Arc::clone(table);
        }
        let table = Arc::new(Table::of(&self.law, &self.part, level, 0.0, within()));
        tables.insert((level, key), Arc::clone(&table));
        table
    }

    /// Nodes that resolve `top` and have weight under a tilt. If a table of the whole support is large, or if `top` is far beyond the tilt,
    /// only the interval with weight is resolved. A large tilt has made that interval small.
    fn table_at(&self, theta: f64, top: f64) -> Arc<Table> {
        /// Levels beyond that of the tilt from which on the interval is found first.
        const BEYOND: i32 = 2;
        /// Levels from a table to the one that locates its weight: neighbouring nodes of that one differ by at most 4 in the exponent.
        const COARSER: i32 = 2;
        let (own, wanted) = (level(theta.abs()), level(top));
        let beyond = wanted > own + BEYOND;
        if !beyond && self.is_shared(wanted) {
            return self.table(wanted);
        }
        let coarser = if beyond { own } else { wanted - COARSER };
        let coarse = match self.is_shared(coarser) {
            true => self.table(coarser),
            false => self.table_at(theta, libm::exp2(f64::from(coarser))),
        };
        self.table_for(wanted, theta.to_bits(), || {
            let exponent = |at: usize| theta * coarse.values[at] + coarse.logs[at];
            let most = (0..coarse.z.len()).map(exponent).fold(f64::NEG_INFINITY, f64::max);
            let live = |at: &usize| exponent(*at) > most - LEAST;
            let first = (0..coarse.z.len()).find(live).unwrap_or(0);
            let last = (0..coarse.z.len()).rev().find(live).unwrap_or(0);
            // Extend to the next nodes on either side, which have no noticeable weight.
            let low = if first > 0 { coarse.z[first - 1] } else { f64::NEG_INFINITY };
            let high = coarse.z.get(last + 1).copied().unwrap_or(f64::INFINITY);
            [low, high]
        })
    }

    /// True if the input consists of atoms.
    pub(in crate::law) fn is_discrete(&self) -> bool {
        self.law.is_discrete()
    }

    /// Mean and variance of the part.
    pub(in crate::law) fn moments(&self) -> [f64; 2] {
        let nodes = self.law.nodes(&self.part, 0.0, 0.0);
        let values: Vec<f64> = nodes.z.iter().map(|&z| value(&self.part, z)).collect();
        let over = |f: &dyn Fn(f64) -> f64| values.iter().zip(&nodes.weight).map(|(&g, w)| w * f(g)).sum::<f64>();
        let mean = over(&|g| g) / over(&|_| 1.0);
        [mean, over(&|g| (g - mean) * (g - mean))]
    }

    pub(in crate::law) fn tilted(&self, theta: f64, top: f64) -> Tilted {
        let table = self.table_at(theta, top);
        let exponents: Vec<f64> = table.values.iter().zip(&table.logs).map(|(g, log)| theta * g + log).collect();
        let log = exponents.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut tilted = Tilted { log, ..Tilted::default() };
        for (place, exponent) in exponents.iter().enumerate() {
            if *exponent > log - LEAST {
                tilted.z.push(table.z[place]);
                tilted.values.push(table.values[place]);
                tilted.weights.push(Exp::of(exponent - log));
            }
        }
        tilted
    }

    /// `[K, K', K'']` at a real `theta`.
    pub(in crate::law) fn cumulants(&self, theta: f64) -> [f64; 3] {
        let tilted = self.tilted(theta, theta.abs());
        let mass: f64 = tilted.weights.iter().sum();
        let both = || tilted.values.iter().zip(&tilted.weights);
        let mean = both().map(|(g, w)| w * g).sum::<f64>() / mass;
        let variance = both().map(|(g, w)| w * (g - mean) * (g - mean)).sum::<f64>() / mass;
        [tilted.log + libm::log(mass), mean, variance]
    }

    /// Multiplies `M(s)/M(theta)` into the points of a block: `s = theta + i t`, `t = from, from + step, ...`.
    pub(in crate::law) fn multiply(&self, theta: f64, log_at_theta: f64, from: f64, step: f64, out: &mut [Complex]) {
        let top = libm::hypot(theta, from + step * out.len() as f64);
        let tilted = self.tilted(theta, top);
        let scale = Exp::of(tilted.log - log_at_theta);
        let start = |(g, w): (&f64, &f64)| Complex::cis(from * g) * (w * scale);
        let now: Vec<Complex> = tilted.values.iter().zip(&tilted.weights).map(start).collect();
        let turn: Vec<Complex> = tilted.values.iter().map(|g| Complex::cis(step * g)).collect();
        on_this_processor(Rotate::new(now, &turn, out));
    }

    /// True if an unbounded input has negligible weight under a tilt at the ends where it is cut.
    pub(in crate::law) fn bears(&self, theta: f64, at_mean: f64) -> bool {
        if self.law.support.iter().all(|end| end.is_finite()) {
            return true;
        }
        let table = self.table(level(at_mean));
        let exponents = || {
            let both = table.values.iter().zip(&table.logs);
            table.z.iter().zip(both).map(|(&z, (g, log))| (z, theta * g + log))
        };
        own_ends_weigh_nothing(&self.law, exponents)
    }
}

/// True if an unbounded input has negligible weight at the ends where it is cut. `exponents` gives values and logarithms of weights.
pub(in crate::law) fn own_ends_weigh_nothing<I: Iterator<Item = (f64, f64)>>(
    law: &Input,
    exponents: impl Fn() -> I,
) -> bool {
    /// Negative logarithm of the greatest relative weight of a cut end.
    const NOTHING: f64 = 32.0;
    let open = [0, 1].map(|end| law.support[end].is_infinite());
    if !open.contains(&true) || law.is_discrete() {
        return true;
    }
    let most = exponents().map(|(_, e)| e).fold(f64::NEG_INFINITY, f64::max);
    let [low, high] = law.ends;
    let edge = 0.02 * (high - low);
    let cut = |e: f64| e <= most - NOTHING;
    exponents().all(|(z, e)| (!(open[0] && z < low + edge) || cut(e)) && (!(open[1] && z > high - edge) || cut(e)))
}

/// Sums of complex numbers, each of which rotates by its own angle from one sum to the next.
struct Rotate<'a> {
    re: Vec<f64>,
    im: Vec<f64>,
    turn_re: Vec<f64>,
    turn_im: Vec<f64>,
    out: &'a mut [Complex],
}

/// Numbers summed side by side, whose sums are added in a fixed order.
const LANES: usize = 8;

impl<'a> Rotate<'a> {
    fn new(now: Vec<Complex>, turn: &[Complex], out: &'a mut [Complex]) -> Self {
        // Zeros fill the last lanes.
        let length = now.len().next_multiple_of(LANES);
        let padded = |values: &mut dyn Iterator<Item = f64>| {
            let mut values: Vec<f64> = values.collect();
            values.resize(length, 0.0);
            values
        };
        Self {
            re: padded(&mut now.iter().map(|v| v.re)),
            im: padded(&mut now.iter().map(|v| v.im)),
            turn_re: padded(&mut turn.iter().map(|v| v.re)),
            turn_im: padded(&mut turn.iter().map(|v| v.im)),
            out,
        }
    }
}

impl Work for Rotate<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { mut re, mut im, turn_re, turn_im, out } = self;
        for out in out {
            let (mut sum_re, mut sum_im) = ([0.0; LANES], [0.0; LANES]);
            let now = re.chunks_exact_mut(LANES).zip(im.chunks_exact_mut(LANES));
            let turn = turn_re.chunks_exact(LANES).zip(turn_im.chunks_exact(LANES));
            for ((re, im), (turn_re, turn_im)) in now.zip(turn) {
                for lane in 0..LANES {
                    let (a, b) = (re[lane], im[lane]);
                    sum_re[lane] += a;
                    sum_im[lane] += b;
                    re[lane] = a * turn_re[lane] - b * turn_im[lane];
                    im[lane] = a * turn_im[lane] + b * turn_re[lane];
                }
            }
            *out *= Complex::new(sum_re.iter().sum(), sum_im.iter().sum());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::{Distribution, Uniform};

    /// A uniform input has `M(s) = sinh(a)/a` with `a = s sqrt 3`, for large real parts too. Exponents of size `a` are rounded to some units
    /// in the last place of `a`, and the 16 nodes of a rule keep 1e-13.
    #[test]
    fn large_tilts_are_resolved_where_they_have_weight() {
        let law: Arc<dyn Distribution> = Arc::new(Uniform::new(-1.0, 1.0).unwrap());
        let single = Single::new(0, Arc::new(Input::of(&law).unwrap()), [0.0, 1.0, 0.0, 0.0, 0.0]);
        for theta in [1.0, 100.0, 1e3, 5e4, -2e3] {
            let (a, sign) = (f64::abs(theta) * 3f64.sqrt(), f64::signum(theta));
            let small = libm::exp(-2.0 * a);
            let coth = (1.0 + small) / (1.0 - small);
            let near = 1e-13 + 4.0 * f64::EPSILON * a;
            let [k, k1, _] = single.cumulants(theta);
            assert!((k - (a + libm::log1p(-small) - libm::log(2.0 * a))).abs() < near, "{theta}: {k}");
            assert!((k1 - sign * 3f64.sqrt() * (coth - 1.0 / a)).abs() < 1e-13, "{theta}: {k1}");
            let mut ratios = [Complex::ONE; 8];
            let step = 0.3 * theta.abs();
            single.multiply(theta, k, 0.0, step, &mut ratios);
            for (i, ratio) in ratios.iter().enumerate() {
                let y = sign * step * i as f64 * 3f64.sqrt();
                let exact = Complex::new(libm::cos(y), coth * libm::sin(y)) * a / Complex::new(a, y);
                assert!((*ratio - exact).abs() < near, "{theta} {i}: {ratio:?} {exact:?}");
            }
            assert!(single.tilted(theta, theta.abs()).z.len() < 1200, "{theta}");
        }
    }
}
