//! Quadratic forms of normal inputs with added third and fourth powers, as in angles about a stationary point.
//!
//! The surface is expanded anew about the saddle point `x*` of a tilt `theta`, which is exact for quartics. The inputs are `z = L x` with
//! independent normal `x`, and `eta` are the axes of the curvature at the saddle point. `gamma` and `beta` are the position and the slopes
//! along these axes:
//!
//! ```text
//! x*   = argmax theta y(L x) - |x|^2/2
//! K(s) = s y* - |x*|^2/2 + sum_i (s beta_i - gamma_i)^2/(2 q_i) - 1/2 log q_i + log E exp(s sum_j c3 v_j^3 + c4 v_j^4),   q_i = 1 - 2 a_i s
//! ```
//!
//! The `v_j` of the inputs with higher powers are normal under the complex tilt. The contour of integration turns with `s`, so the
//! integrand does not oscillate. Their expectation is a product of Gauss-Hermite rules, refined until two of them agree. If none agree, the
//! contour ends. Source of the expansion: O. E. Barndorff-Nielsen and D. R. Cox, Asymptotic Techniques for Use in Statistics (1989), 6.2;
//! of the turned rules: D. Huybrechs and S. Vandewalle, SIAM Journal on Numerical Analysis 44 (2006).

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use crate::distribution::{Normal, Rule};
use crate::law::inversion::complex::Complex;
use crate::law::inversion::quadratic_form::{factor, form};
use crate::law::polynomial::{Quartic, derivative, value};
use crate::law::surface::Surface;

/// Greatest number of inputs with higher powers: the nodes of a product rule grow as a power with this exponent.
const MOST_BENT: usize = 4;
/// Greatest number of inputs of a block, because every tilt takes eigenvalues.
const MOST_MEMBERS: usize = 48;
/// Greatest number of nodes of a product rule: a contour of a hundred points takes some hundredths of a second.
const MOST_NODES: usize = 4096;
/// Numbers of nodes along one input, each up to half as many again as the last.
const NODES: [usize; 12] = [4, 6, 8, 10, 13, 16, 20, 24, 30, 36, 44, 54];
/// Difference at which two rules agree, relative to the transform on the real axis.
const AGREED: f64 = 3e-14;
/// Points of a contour between two tests of the rules. A transform varies little between neighbours.
const TESTED: usize = 8;
/// Least value of a factor `1 - 2 a theta`. Below it the domain of the transform has ended.
const LEAST_FACTOR: f64 = 1e-3;
/// Greatest exponent of the higher powers at the complex mean for which the nodes are shifted to that mean. A larger one grows along the
/// contour.
const SHIFTED: f64 = 1.0;

static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    let normal = Normal::new(0.0, 1.0).expect("a standard normal distribution");
    NODES.iter().map(|&nodes| Rule::of(&normal, nodes)).collect()
});

/// Block of normal inputs, a few of which have higher powers.
#[derive(Debug)]
pub(in crate::law) struct PerturbedForm {
    /// Indices of the inputs in the surface.
    pub(in crate::law) members: Vec<usize>,
    parts: Vec<Quartic>,
    /// Curvatures, with half the products beside them.
    form: Mat<f64>,
    /// `L` of the correlation; None if the members are uncorrelated.
    factor: Option<Mat<f64>>,
    /// Members with higher powers, by their index in the block.
    bent: Vec<usize>,
    expansions: Mutex<BTreeMap<u64, Option<Arc<Expansion>>>>,
}

/// Block expanded about the saddle point of a tilt.
#[derive(Debug)]
struct Expansion {
    /// Value of the surface at the saddle point.
    at: f64,
    /// Half the squared distance of the saddle point, `|x*|^2/2`.
    distance: f64,
    /// `a_i`, `beta_i` and `gamma_i` of every axis.
    axes: Vec<[f64; 3]>,
    /// Components of every bent input along the axes.
    components: Vec<Vec<f64>>,
    /// Third and fourth coefficient of every bent input.
    powers: Vec<[f64; 2]>,
    /// `K(theta)`.
    log: f64,
    /// Index of the rule that resolves the real axis.
    level: usize,
}

/// Bent inputs under a complex tilt: means, a lower triangular factor of their covariance, and the part in closed form.
struct ComplexTilt {
    s: Complex,
    means: [Complex; MOST_BENT],
    factor: [[Complex; MOST_BENT]; MOST_BENT],
    /// Slopes of the exponent along the rules if the nodes are centred on 0 instead of the means.
    slopes: Option<[Complex; MOST_BENT]>,
    /// `K(s)` without the expectation.
    closed: Complex,
}

impl PerturbedForm {
    /// Block of these members. Returns None if an input is not normal, or if too many have higher powers.
    pub(in crate::law) fn of(surface: &Surface, members: &[usize]) -> Option<Self> {
        let parts: Vec<Quartic> = members.iter().map(|&j| surface.parts[j]).collect();
        let bent: Vec<usize> = (0..parts.len()).filter(|&a| parts[a][3] != 0.0 || parts[a][4] != 0.0).collect();
        let normal = members.iter().all(|&j| surface.inputs[j].is_normal());
        if !normal || members.len() > MOST_MEMBERS || !(1..=MOST_BENT).contains(&bent.len()) {
            return None;
        }
        let (form, factor) = (form(surface, members), factor(surface, members)?);
        Some(Self { members: members.to_vec(), parts, form, factor, bent, expansions: Mutex::default() })
    }

    /// Mean and variance, by Hermite polynomials: `E He_n(z_j) He_n(z_k) = n! rho^n`.
    pub(in crate::law) fn moments(&self) -> [f64; 2] {
        let m = self.members.len();
        let correlation = match &self.factor {
            Some(factor) => factor * factor.transpose(),
            None => Mat::identity(m, m),
        };
        // z^3 = He3 + 3 He1, z^4 = He4 + 6 He2 + 3.
        let mut second = self.form.clone();
        self.parts.iter().enumerate().for_each(|(a, part)| second[(a, a)] += 6.0 * part[4]);
        let first: Vec<f64> = self.parts.iter().map(|part| part[1] + 3.0 * part[3]).collect();
        let both = &second * &correlation;
        // E z_j z_k F_jk is the trace of F R; He2 takes 1 off its diagonal, and c2 + 3 c4 is the mean of a part.
        let mut mean: f64 = (0..m).map(|a| both[(a, a)]).sum();
        mean -= self.parts.iter().map(|part| 3.0 * part[4]).sum::<f64>();
        let mut variance = 0.0;
        for a in 0..m {
            for b in 0..m {
                let rho = correlation[(a, b)];
                variance += first[a] * first[b] * rho + 2.0 * both[(a, b)] * both[(b, a)];
                variance += 6.0 * self.parts[a][3] * self.parts[b][3] * rho.powi(3);
                variance += 24.0 * self.parts[a][4] * self.parts[b][4] * rho.powi(4);
            }
        }
        [mean, variance]
    }

    /// Curvatures and slopes along the axes about the means.
    pub(in crate::law) fn parabolas(&self) -> Vec<[f64; 2]> {
        self.expansion(0.0).map_or(Vec::new(), |about| about.axes.iter().map(|&[a, slope, _]| [a, slope]).collect())
    }

    /// True if the expansion about this tilt exists, which requires that the powers beside the form are small.
    pub(in crate::law) fn bears(&self, theta: f64) -> bool {
        self.expansion(theta).is_some()
    }

    /// `K` at a real tilt. Returns NaN if it does not exist.
    pub(in crate::law) fn log(&self, theta: f64) -> f64 {
        self.expansion(theta).map_or(f64::NAN, |about| about.log)
    }

    fn expansion(&self, theta: f64) -> Option<Arc<Expansion>> {
        let mut known = self.expansions.lock().unwrap_or_else(PoisonError::into_inner);
        known.entry(theta.to_bits()).or_insert_with(|| self.expanded(theta).map(Arc::new)).clone()
    }

    /// Expands the block about the saddle point of a tilt.
    fn expanded(&self, theta: f64) -> Option<Expansion> {
        let x = self.saddle(theta)?;
        let z = self.mixed(&x);
        let m = z.len();
        let eigen = self.curvature(&z).self_adjoint_eigen(Side::Lower).ok()?;
        let slopes = self.slopes(&z);
        let along = |i: usize, of: &[f64]| (0..m).map(|a| eigen.U()[(a, i)] * of[a]).sum::<f64>();
        let axes: Vec<[f64; 3]> = (0..m).map(|i| [eigen.S()[i], along(i, &slopes), along(i, &x)]).collect();
        if axes.iter().any(|&[a, ..]| 1.0 - 2.0 * a * theta < LEAST_FACTOR) {
            return None;
        }
        let row = |a: usize, i: usize| match &self.factor {
            Some(factor) => (0..m).map(|b| factor[(a, b)] * eigen.U()[(b, i)]).sum(),
            None => eigen.U()[(a, i)],
        };
        let components = self.bent.iter().map(|&a| (0..m).map(|i| row(a, i)).collect()).collect();
        let shifted = |&a: &usize| [self.parts[a][3] + 4.0 * self.parts[a][4] * z[a], self.parts[a][4]];
        let powers = self.bent.iter().map(shifted).collect();
        let distance = 0.5 * x.iter().map(|x| x * x).sum::<f64>();
        let mut about = Expansion { at: self.value(&z), distance, axes, components, powers, log: 0.0, level: 0 };
        let tilt = about.tilt(Complex::from(theta));
        let (level, expectation) = about.resolved(&tilt, 0, 1.0)?;
        about.level = level;
        about.log = tilt.closed.re + libm::log(expectation.re);
        (about.log.is_finite() && expectation.re > 0.0).then_some(about)
    }

    /// Maximum of `theta y - |x|^2/2`, followed from the origin by Newton's method while the tilt grows in steps.
    fn saddle(&self, theta: f64) -> Option<Vec<f64>> {
        /// Steps of the tilt from 0 to `theta`.
        const TILTS: usize = 8;
        /// Greatest number of Newton steps for each tilt.
        const STEPS: usize = 12;
        /// Tolerance of the Newton step, relative to the larger of the length of `x` and one sigma.
        const NEAR: f64 = 1e-13;
        let m = self.members.len();
        let mut x = vec![0.0; m];
        for part in 1..=TILTS {
            let theta = theta * part as f64 / TILTS as f64;
            let mut moved = f64::INFINITY;
            for _ in 0..STEPS {
                let z = self.mixed(&x);
                let (slopes, curvature) = (self.slopes(&z), self.curvature(&z));
                let gap = Mat::from_fn(m, 1, |a, _| theta * slopes[a] - x[a]);
                let bowl = Mat::from_fn(m, m, |a, b| f64::from(u8::from(a == b)) - 2.0 * theta * curvature[(a, b)]);
                // No Cholesky factor: there is no maximum any more and the domain has ended.
                let step = bowl.llt(Side::Lower).ok()?.solve(&gap);
                x.iter_mut().enumerate().for_each(|(a, x)| *x += step[(a, 0)]);
                moved = (0..m).map(|a| step[(a, 0)].abs()).fold(0.0, f64::max);
                let length = x.iter().fold(1.0f64, |length, x| length.max(x.abs()));
                if moved <= NEAR * length {
                    break;
                }
            }
            // Accept a last step that is only the rounding of the slopes.
            if moved.is_nan() || moved > 1e3 * NEAR * x.iter().fold(1.0f64, |length, x| length.max(x.abs())) {
                return None;
            }
        }
        Some(x)
    }

    /// Correlated normal inputs `L x`.
    fn mixed(&self, x: &[f64]) -> Vec<f64> {
        match &self.factor {
            Some(factor) => (0..x.len()).map(|a| x.iter().enumerate().map(|(b, x)| factor[(a, b)] * x).sum()).collect(),
            None => x.to_vec(),
        }
    }

    /// Surface about its centre.
    fn value(&self, z: &[f64]) -> f64 {
        let m = z.len();
        let products = (0..m).flat_map(|a| (0..a).map(move |b| (a, b)));
        let own: f64 = self.parts.iter().zip(z).map(|(part, &z)| value(part, z) - part[0]).sum();
        own + products.map(|(a, b)| 2.0 * self.form[(a, b)] * z[a] * z[b]).sum::<f64>()
    }

    /// Slopes of the surface by `x`.
    fn slopes(&self, z: &[f64]) -> Vec<f64> {
        let m = z.len();
        let beside = |a: usize| (0..m).filter(|&b| b != a).map(|b| 2.0 * self.form[(a, b)] * z[b]).sum::<f64>();
        let by_z: Vec<f64> = (0..m).map(|a| value(&derivative(&self.parts[a]), z[a]) + beside(a)).collect();
        match &self.factor {
            Some(factor) => (0..m).map(|b| (0..m).map(|a| factor[(a, b)] * by_z[a]).sum()).collect(),
            None => by_z,
        }
    }

    /// Half the second derivatives of the surface by `x`.
    fn curvature(&self, z: &[f64]) -> Mat<f64> {
        let mut form = self.form.clone();
        for &a in &self.bent {
            form[(a, a)] += 3.0 * z[a] * (self.parts[a][3] + 2.0 * self.parts[a][4] * z[a]);
        }
        match &self.factor {
            Some(factor) => factor.transpose() * &form * factor,
            None => form,
        }
    }

    /// Multiplies `M(s)/M(theta)` into the points of a block and returns the number of resolved points, counted from the first.
    pub(in crate::law) fn multiply(&self, theta: f64, points: &[Complex], out: &mut [Complex]) -> usize {
        let logs = self.logs(theta, points);
        logs.iter().zip(out).for_each(|(log, out)| *out *= log.exp());
        logs.len()
    }

    /// `K(s) - K(theta)` at the points that are resolved, counted from the first.
    pub(in crate::law) fn logs(&self, theta: f64, points: &[Complex]) -> Vec<Complex> {
        let Some(about) = self.expansion(theta) else { return Vec::new() };
        let mut logs = Vec::with_capacity(points.len());
        let mut level = about.level;
        for points in points.chunks(TESTED) {
            // The last point of each group has the largest phase.
            let last = about.tilt(points[points.len() - 1]);
            let scale = libm::exp(last.closed.re - about.log);
            match about.resolved(&last, level, scale) {
                Some((found, _)) => level = found,
                None => break,
            }
            logs.extend(points.iter().map(|&s| {
                let tilt = about.tilt(s);
                tilt.closed - Complex::from(about.log) + about.expectation(&tilt, level).ln()
            }));
        }
        logs
    }
}

impl Expansion {
    /// Bent inputs under a tilt.
    fn tilt(&self, s: Complex) -> ComplexTilt {
        let k = self.powers.len();
        let mut closed = s * self.at - Complex::from(self.distance);
        let [mut means, mut slopes] = [[Complex::ZERO; MOST_BENT]; 2];
        let mut covariance = [[Complex::ZERO; MOST_BENT]; MOST_BENT];
        for (i, &[a, slope, place]) in self.axes.iter().enumerate() {
            let q = Complex::ONE - s * (2.0 * a);
            let (inverse, gap) = (Complex::ONE / q, s * slope - Complex::from(place));
            let mean = gap * inverse;
            closed += gap * mean * 0.5 - q.ln() * 0.5;
            for j in 0..k {
                let own = self.components[j][i];
                means[j] += mean * own;
                (0..=j).for_each(|l| covariance[j][l] += inverse * (own * self.components[l][i]));
            }
        }
        let factor = complex_factor(covariance, k);
        let grown = (0..k).map(|j| self.power(s, j, means[j])).fold(Complex::ZERO, |sum, more| sum + more);
        // Far out along the complex means the higher powers may grow. The nodes then stay about the saddle point, and slopes in the
        // exponent account for the means.
        let stays = grown.abs() > SHIFTED && (0..k).all(|j| factor[j][j] != Complex::ZERO);
        if stays {
            for j in 0..k {
                let known = (0..j).fold(Complex::ZERO, |sum, l| sum + factor[j][l] * slopes[l]);
                slopes[j] = (means[j] - known) / factor[j][j];
                closed += slopes[j] * slopes[j] * -0.5;
            }
            means = [Complex::ZERO; MOST_BENT];
        }
        ComplexTilt { s, means, factor, slopes: stays.then_some(slopes), closed }
    }

    /// Exponent of the higher powers of a bent input.
    fn power(&self, s: Complex, j: usize, v: Complex) -> Complex {
        let [third, fourth] = self.powers[j];
        s * (v * v * v) * (v * fourth + Complex::from(third))
    }

    /// First rule from `from` on that agrees with the next one, and the expectation by that next one. Returns None if no two rules agree.
    fn resolved(&self, tilt: &ComplexTilt, from: usize, scale: f64) -> Option<(usize, Complex)> {
        let k = self.powers.len() as u32;
        let mut before = self.expectation(tilt, from);
        for level in from..NODES.len() - 1 {
            if NODES[level + 1].pow(k) > MOST_NODES {
                return None;
            }
            let next = self.expectation(tilt, level + 1);
            if scale * (next - before).abs() <= AGREED {
                return Some((level, next));
            }
            before = next;
        }
        None
    }

    /// Expectation of the higher powers by a product of rules.
    fn expectation(&self, tilt: &ComplexTilt, level: usize) -> Complex {
        self.nested(tilt, &RULES[level], 0, tilt.means)
    }

    /// Sum over the rule of input `j` and the rules of all inputs after it.
    fn nested(&self, tilt: &ComplexTilt, rule: &Rule, j: usize, means: [Complex; MOST_BENT]) -> Complex {
        let last = j + 1 == self.powers.len();
        let mut sum = Complex::ZERO;
        for (&w, &weight) in rule.nodes.iter().zip(&rule.weights) {
            let mut exponent = self.power(tilt.s, j, means[j] + tilt.factor[j][j] * w);
            if let Some(slopes) = &tilt.slopes {
                exponent += slopes[j] * w;
            }
            let own = exponent.exp() * weight;
            if last {
                sum += own;
                continue;
            }
            let mut means = means;
            (j + 1..self.powers.len()).for_each(|l| means[l] += tilt.factor[l][j] * w);
            sum += own * self.nested(tilt, rule, j + 1, means);
        }
        sum
    }
}

/// Lower triangular factor of a complex symmetric matrix, `C = F F'` without conjugation. A vanishing pivot gives a column of zeros.
fn complex_factor(covariance: [[Complex; MOST_BENT]; MOST_BENT], k: usize) -> [[Complex; MOST_BENT]; MOST_BENT] {
    /// Relative part of a variance below which a pivot is rounding.
    const NONE: f64 = 1e-13;
    let mut factor = [[Complex::ZERO; MOST_BENT]; MOST_BENT];
    for j in 0..k {
        let own = (0..j).fold(covariance[j][j], |rest, l| rest - factor[j][l] * factor[j][l]);
        if own.abs() <= NONE * covariance[j][j].abs() {
            continue;
        }
        // Either root will do, because the rules are symmetric.
        factor[j][j] = (own.ln() * 0.5).exp();
        for i in j + 1..k {
            let rest = (0..j).fold(covariance[i][j], |rest, l| rest - factor[i][l] * factor[j][l]);
            factor[i][j] = rest / factor[j][j];
        }
    }
    factor
}
