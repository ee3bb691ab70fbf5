//! Tails of an exact distribution in a table. If the rest of a surface is sampled, they replace the distribution function along a
//! direction.

use crate::law::LawTail;
use crate::law::inversion::complex::Complex;
use crate::law::inversion::tail_inversion::Inversion;
use crate::law::surface::Surface;
use crate::law::tail_derivative::exact_derivatives;

/// Entries for each sigma.
const PER_SIGMA: f64 = 24.0;
/// Tail probability below which the table ends.
const LEAST: f64 = 1e-40;
/// Greatest number of entries on either side of the mean.
const MOST: usize = 1200;

/// Relative error of cubics where a density is smooth.
const SMOOTH: f64 = 1e-7;

/// Largest relative error of a table that replaces a direction.
const COARSE: f64 = 1e-4;

/// True if the transform has vanished at waves as short as a few entries of a table.
fn is_smooth(law: &Inversion) -> bool {
    /// Frequencies that are tested, times sigma: 2.5 to 4 entries for each wave.
    const WAVES: [f64; 4] = [36.0, 44.0, 52.0, 60.0];
    /// Tilt for a limit near the middle, times sigma.
    const TILT: f64 = 1.2;
    let (transform, sigma) = (&law.transform, law.sigma());
    let [low, high] = transform.domain;
    [-TILT / sigma, TILT / sigma].iter().all(|&tilt| {
        let theta = tilt.clamp(0.5 * low, 0.5 * high);
        let logs = transform.logs(theta);
        WAVES.iter().all(|wave| {
            let mut ratio = [Complex::ONE];
            transform.ratios(theta, &logs, wave / sigma, 1.0 / sigma, &mut ratio) == 1 && ratio[0].abs() < COARSE
        })
    })
}

/// Logarithms of both tails and their slopes, at equal distances.
#[derive(Debug)]
pub(super) struct Table {
    from: f64,
    step: f64,
    /// Logarithm of the lower tail and its slope. `upper` holds those of the upper tail.
    lower: Vec<[f64; 2]>,
    upper: Vec<[f64; 2]>,
    density: Vec<f64>,
    /// Largest relative difference of a tail to the distribution itself between entries, and at least [`SMOOTH`].
    pub(super) error: f64,
}

impl Table {
    /// Table of a distribution. Returns None if it has steps or corners, which no cubic interpolates.
    pub(super) fn of(law: &Inversion, range: [f64; 2]) -> Option<Self> {
        if !is_smooth(law) {
            return None;
        }
        let (mean, step) = (law.mean(), law.sigma() / PER_SIGMA);
        let reach = |tail: LawTail, end: f64| {
            let beyond = |place: usize| {
                let y = mean + tail.sign() * step * place as f64;
                tail.sign() * (y - end) >= 0.0 || law.tail(y, tail).value < LEAST
            };
            // Bisect for the last entry, because the tail falls monotonically.
            let (mut low, mut high) = (0, MOST);
            while high - low > 1 {
                let middle = (low + high) / 2;
                if beyond(middle) { high = middle } else { low = middle }
            }
            low
        };
        let (left, right) = (reach(LawTail::Lower, range[0]), reach(LawTail::Upper, range[1]));
        let from = mean - step * left as f64;
        let (mut lower, mut upper, mut density) = (Vec::new(), Vec::new(), Vec::new());
        for place in 0..=left + right {
            let y = from + step * place as f64;
            let at = law.density(y).value;
            for (tail, into) in [(LawTail::Lower, &mut lower), (LawTail::Upper, &mut upper)] {
                let value = law.tail(y, tail).value.max(1e-300);
                into.push([libm::log(value), -tail.sign() * at / value]);
            }
            density.push(at);
        }
        let mut table = Self { from, step, lower, upper, density, error: SMOOTH };
        table.error = table.error.max(table.difference(law));
        (table.error <= COARSE).then_some(table)
    }

    /// Largest relative difference of the smaller tail to the distribution itself, halfway between entries.
    fn difference(&self, law: &Inversion) -> f64 {
        /// Tail probability below which entries are not compared, because the distribution itself loses digits there.
        const TRACE: f64 = 1e-12;
        let last = self.lower.len() - 1;
        let mut most = 0.0f64;
        for place in 0..last {
            let y = self.from + self.step * (place as f64 + 0.5);
            let tail = if y < law.mean() { LawTail::Lower } else { LawTail::Upper };
            let own = law.tail(y, tail);
            let off = ((self.tail(y, tail) - own.value).abs() + own.error) / own.value;
            if own.value > TRACE || off.is_nan() {
                most = most.max(if off.is_nan() { f64::INFINITY } else { off });
            }
            if most > COARSE {
                break;
            }
        }
        most
    }

    /// Probability beyond a limit, by Hermite's cubic of the logarithm: 1e-8 relative where the density is smooth.
    pub(super) fn tail(&self, y: f64, tail: LawTail) -> f64 {
        let values = if tail == LawTail::Lower { &self.lower } else { &self.upper };
        let last = values.len() - 1;
        let place = (y - self.from) / self.step;
        if place <= 0.0 || place >= last as f64 {
            let outside = (place <= 0.0) == (tail == LawTail::Lower);
            // Beyond the table the tail is extrapolated as an exponential function.
            let [log, slope] = if place <= 0.0 { values[0] } else { values[last] };
            let off = if place <= 0.0 { y - self.from } else { y - self.from - self.step * last as f64 };
            return if outside { libm::exp(log + slope * off) } else { 1.0 };
        }
        let at = place as usize;
        let t = place - at as f64;
        let ([a, da], [b, db]) = (values[at], values[(at + 1).min(last)]);
        libm::exp(hermite(t, a, da * self.step, b, db * self.step)).min(1.0)
    }

    /// Density at `y`, by Hermite's cubic between entries with slopes from central differences; 0 beyond the table.
    pub(super) fn density(&self, y: f64) -> f64 {
        let place = (y - self.from) / self.step;
        let last = self.density.len() - 1;
        if place <= 0.0 || place >= last as f64 {
            return 0.0;
        }
        let at = place as usize;
        let t = place - at as f64;
        let d = |at: usize| self.density[at.min(last)];
        let slope = |at: usize| 0.5 * (d(at + 1) - d(at.saturating_sub(1)));
        hermite(t, d(at), slope(at), d(at + 1), slope(at + 1)).max(0.0)
    }
}

/// Derivatives of a tail by the tolerances of the inputs of an exact distribution.
#[derive(Debug)]
pub(super) struct Slopes {
    from: f64,
    step: f64,
    /// Derivatives at every entry, one for each input of the surface.
    values: Vec<Vec<f64>>,
}

impl Table {
    /// Derivatives of a tail at every fourth entry of the table.
    pub(super) fn slopes(&self, law: &Inversion, surface: &Surface, tail: LawTail) -> Slopes {
        /// Places per slope: slopes change more slowly than the tail.
        const EVERY: usize = 4;
        let step = self.step * EVERY as f64;
        let places = self.lower.len().div_ceil(EVERY);
        let at = |place: usize| {
            let found = exact_derivatives(law, surface, self.from + step * place as f64, tail);
            found.into_iter().map(|figure| figure.value).collect()
        };
        Slopes { from: self.from, step, values: (0..=places).map(at).collect() }
    }
}

impl Slopes {
    /// Derivative at a limit, by a cubic through four entries; 0 beyond the table.
    pub(super) fn at(&self, input: usize, y: f64) -> f64 {
        let place = (y - self.from) / self.step;
        if place < 0.0 || place >= (self.values.len() - 1) as f64 {
            return 0.0;
        }
        let at = place as usize;
        let d = |at: usize| self.values[at.min(self.values.len() - 1)][input];
        let slope = |at: usize| 0.5 * (d(at + 1) - d(at.saturating_sub(1)));
        hermite(place - at as f64, d(at), slope(at), d(at + 1), slope(at + 1))
    }
}

fn hermite(t: f64, a: f64, da: f64, b: f64, db: f64) -> f64 {
    let s = 1.0 - t;
    a * s * s * (1.0 + 2.0 * t) + b * t * t * (3.0 - 2.0 * t) + t * s * (da * s - db * t)
}
