//! All distributions with independent formulas of their densities, and an integrator for them.

use std::f64::consts::PI;
use std::sync::Arc;

use sensitol_numeric::distribution::{
    Beta, CurvilinearTrapezoid, Distribution, Drifting, Exponential, ExtremeEnd, Gamma, Gumbel, Lognormal, Mixture,
    Normal, Part, Rayleigh, SolidAxis, SolidCoordinate, SplitNormal, Student, Tabulated, Trapezoidal, Triangular,
    TruncatedNormal, UShaped, Uniform, Weibull,
};

/// A distribution with its density.
pub struct Case {
    /// The distribution under test.
    pub distribution: Arc<dyn Distribution>,
    /// Density as a sum of pieces.
    pub pieces: Vec<Piece>,
}

/// An interval with a smooth density inside. The density may be singular at its ends. `density` takes the distances from both ends; the
/// second is infinite if the interval is.
pub struct Piece {
    /// Lower end.
    pub from: f64,
    /// Upper end; may be infinite.
    pub to: f64,
    density: Box<dyn Fn(f64, f64) -> f64>,
}

impl Piece {
    fn new(from: f64, to: f64, density: impl Fn(f64, f64) -> f64 + 'static) -> Self {
        Self { from, to, density: Box::new(density) }
    }

    /// Integral of `f(x)` times the density over the part of the piece in this interval. It uses the tanh-sinh rule, and towards infinity
    /// the exp-sinh rule (Takahasi and Mori 1974). Both damp the ends of the interval double exponentially.
    fn integral(&self, between: [f64; 2], f: &dyn Fn(f64) -> f64) -> f64 {
        let (from, to) = (self.from.max(between[0]), self.to.min(between[1]));
        if from >= to {
            return 0.0;
        }
        let step = 1.0 / 64.0;
        let value = |near: f64, far: f64, x: f64| {
            let density = (self.density)(near + (from - self.from), far + (self.to - to).max(0.0));
            // Terms such as 0 times infinity far out, or infinity at a singular end, vanish by the weight.
            if density == 0.0 || !density.is_finite() { 0.0 } else { f(x) * density }
        };
        let node = |i: i32| {
            let t = f64::from(i) * step;
            let s = 0.5 * PI * t.sinh();
            if to.is_finite() {
                // Fractions of the interval on either side, both with all their digits.
                let (left, right) = (1.0 / (1.0 + (-2.0 * s).exp()), 1.0 / (1.0 + (2.0 * s).exp()));
                let width = to - from;
                let slope = PI * t.cosh() * left * right * width;
                let x = if left < 0.5 { from + width * left } else { to - width * right };
                return if slope == 0.0 { 0.0 } else { slope * value(width * left, width * right, x) };
            }
            let distance = s.exp();
            let slope = 0.5 * PI * t.cosh() * distance;
            if slope.is_finite() && slope > 0.0 { slope * value(distance, f64::INFINITY, from + distance) } else { 0.0 }
        };
        step * (-400..=400).map(node).sum::<f64>()
    }
}

impl Case {
    fn new(distribution: impl Distribution + 'static, pieces: Vec<Piece>) -> Self {
        Self { distribution: Arc::new(distribution), pieces }
    }

    /// Integral of `f(x)` times the density over an interval.
    pub fn integral(&self, between: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
        self.pieces.iter().map(|piece| piece.integral(between, &f)).sum()
    }

    /// Expected value of `f(x)`.
    pub fn mean(&self, f: impl Fn(f64) -> f64) -> f64 {
        self.integral([f64::NEG_INFINITY, f64::INFINITY], f)
    }

    /// Density at `x`.
    pub fn density(&self, x: f64) -> f64 {
        let inside = |piece: &&Piece| x >= piece.from && x <= piece.to;
        self.pieces.iter().filter(inside).map(|piece| (piece.density)(x - piece.from, piece.to - x)).sum()
    }
}

fn gauss(z: f64) -> f64 {
    (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
}

/// Both halves of a normal density, out to 14 sigma.
fn normal_pieces(mean: f64, sigma: f64, weight: f64) -> Vec<Piece> {
    let far = 14.0 * sigma;
    vec![
        Piece::new(mean - far, mean, move |_, d| weight * gauss(d / sigma) / sigma),
        Piece::new(mean, mean + far, move |d, _| weight * gauss(d / sigma) / sigma),
    ]
}

fn normal() -> Case {
    Case::new(Normal::new(7.0, 0.2).unwrap(), normal_pieces(7.0, 0.2, 1.0))
}

fn uniform() -> Case {
    Case::new(Uniform::new(-1.0, 3.0).unwrap(), vec![Piece::new(-1.0, 3.0, |_, _| 0.25)])
}

fn triangular(mode: f64) -> Case {
    let up = move |d: f64, _: f64| 2.0 * d / (3.0 * (mode - 1.0));
    let down = move |_: f64, d: f64| 2.0 * d / (3.0 * (4.0 - mode));
    let pieces = [(mode > 1.0).then(|| Piece::new(1.0, mode, up)), (mode < 4.0).then(|| Piece::new(mode, 4.0, down))];
    Case::new(Triangular::new(1.0, mode, 4.0).unwrap(), pieces.into_iter().flatten().collect())
}

fn trapezoidal(top: f64) -> Case {
    let (h, ramp) = (1.0 / (1.0 + top), 1.0 - top);
    let pieces = vec![
        Piece::new(-1.0, -top, move |d, _| h * d / ramp),
        Piece::new(-top, top, move |_, _| h),
        Piece::new(top, 1.0, move |_, d| h * d / ramp),
    ];
    Case::new(Trapezoidal::new(-1.0, 1.0, top).unwrap(), pieces)
}

/// Normal parent with this mean and sigma, truncated to -1 .. 2. `mass` is its probability there, to the digits of mpmath.
fn truncated(mean: f64, sigma: f64, mass: f64) -> Case {
    let density = move |d: f64, _: f64| gauss((d - 1.0 - mean) / sigma) / (sigma * mass);
    Case::new(TruncatedNormal::new(-1.0, 2.0, mean, sigma).unwrap(), vec![Piece::new(-1.0, 2.0, density)])
}

fn beta(alpha: f64, beta: f64, function: f64) -> Case {
    let density =
        move |low: f64, high: f64| (0.5 * low).powf(alpha - 1.0) * (0.5 * high).powf(beta - 1.0) / (2.0 * function);
    Case::new(Beta::new(1.0, 3.0, alpha, beta).unwrap(), vec![Piece::new(1.0, 3.0, density)])
}

fn u_shaped() -> Case {
    // Distance d from the middle 1.5, whose half-width is 0.5.
    let pieces = vec![Piece::new(1.0, 1.5, |_, d| 12.0 * d * d), Piece::new(1.5, 2.0, |d, _| 12.0 * d * d)];
    Case::new(UShaped::new(1.0, 2.0).unwrap(), pieces)
}

/// Coordinate of an octahedron, by the area of its slices, which are squares.
fn octahedron() -> Case {
    let pieces = vec![Piece::new(1.0, 1.5, |d, _| 12.0 * d * d), Piece::new(1.5, 2.0, |_, d| 12.0 * d * d)];
    Case::new(SolidCoordinate::about(SolidAxis::Octahedron, 1.5, 0.5).unwrap(), pieces)
}

/// Coordinate across a double cone of volume 2 pi/3, by the area of its slices, which are bounded by hyperbolas.
fn bicone() -> Case {
    let density = |from_middle: f64, from_end: f64| {
        let half_chord = (from_end * (1.0 + from_middle)).sqrt();
        // Near the end the closed form loses digits; there it is the sum of its series.
        let area = match half_chord < 0.1 {
            true => (1..12).map(|k| 2.0 * half_chord.powi(2 * k + 1) / f64::from(4 * k * k - 1)).sum(),
            false => half_chord - from_middle * from_middle * (half_chord / from_middle).asinh(),
        };
        3.0 / PI * area
    };
    let pieces = vec![Piece::new(-1.0, 0.0, move |end, middle| density(middle, end)), Piece::new(0.0, 1.0, density)];
    Case::new(SolidCoordinate::about(SolidAxis::Bicone, 0.0, 1.0).unwrap(), pieces)
}

/// Curvilinear trapezoid between -1 and 1, by the density of GUM Supplement 1, 6.4.3.2.
fn curvilinear(d: f64) -> Case {
    let (end, flat) = (1.0 + d, 1.0 - d);
    // Function ln(end/t) of the distance from the end.
    let ramp = move |from_end: f64| -(-from_end / end).ln_1p() / (4.0 * d);
    let pieces = vec![
        Piece::new(-end, -flat, move |from_end, _| ramp(from_end)),
        Piece::new(-flat, flat, move |_, _| (end / flat).ln() / (4.0 * d)),
        Piece::new(flat, end, move |_, from_end| ramp(from_end)),
    ];
    Case::new(CurvilinearTrapezoid::new(-1.0, 1.0, d).unwrap(), pieces)
}

/// Student distribution with scale 1. It has 25 degrees of freedom, so that the moments for rules of nine nodes exist.
fn student() -> Case {
    // The constant is Gamma(13)/(Gamma(12.5) sqrt(25 pi)). The density beyond 1e4 does not even affect the twentieth moment.
    let density = |d: f64| 0.394_973_789_636_461_2 * (1.0 + d * d / 25.0).powf(-13.0);
    let pieces = vec![Piece::new(-1e4, 0.0, move |_, d| density(d)), Piece::new(0.0, 1e4, move |d, _| density(d))];
    Case::new(Student::with_scale(0.0, 1.0, 25.0).unwrap(), pieces)
}

/// Lots with sigma 0.2 and means within `drift` about 3. The density is a difference of two normal distribution functions.
pub fn drifting(drift: f64) -> Case {
    let below = |z: f64| 0.5 * libm::erfc(-z / 2f64.sqrt());
    let density = move |off: f64| {
        let [near, far] = [off - drift, off + drift].map(|off| below(-off / 0.2));
        (near - far) / (2.0 * drift)
    };
    let far = drift + 2.8;
    let pieces =
        vec![Piece::new(3.0 - far, 3.0, move |_, d| density(d)), Piece::new(3.0, 3.0 + far, move |d, _| density(d))];
    Case::new(Drifting::new(3.0, 0.2, drift).unwrap(), pieces)
}

fn exponential() -> Case {
    Case::new(Exponential::new(0.5, 2.0).unwrap(), vec![Piece::new(0.5, f64::INFINITY, |d, _| (-d / 1.5).exp() / 1.5)])
}

fn rayleigh() -> Case {
    let scale = 1.5 / (0.5 * PI).sqrt();
    let density = move |d: f64, _: f64| d / (scale * scale) * (-0.5 * (d / scale).powi(2)).exp();
    Case::new(Rayleigh::new(0.5, 2.0).unwrap(), vec![Piece::new(0.5, f64::INFINITY, density)])
}

/// Gamma distribution with scale 2, from 1 on. `function` is the gamma function of the shape.
fn gamma(shape: f64, function: f64) -> Case {
    let density = move |d: f64, _: f64| (0.5 * d).powf(shape - 1.0) * (-0.5 * d).exp() / (2.0 * function);
    let law = Gamma::new(1.0, 1.0 + 2.0 * shape, 2.0 * shape.sqrt()).unwrap();
    Case::new(law, vec![Piece::new(1.0, f64::INFINITY, density)])
}

fn lognormal(tau: f64) -> Case {
    let density = move |d: f64, _: f64| gauss(d.ln() / tau) / (tau * d);
    let mean = (0.5 * tau * tau).exp();
    let law = Lognormal::new(-1.0, mean - 1.0, mean * (tau * tau).exp_m1().sqrt()).unwrap();
    Case::new(law, vec![Piece::new(-1.0, f64::INFINITY, density)])
}

/// Weibull distribution with scale 1. `first` is `Gamma(1 + 1/shape)`, `second` is `Gamma(1 + 2/shape)`.
fn weibull(shape: f64, first: f64, second: f64) -> Case {
    let density = move |d: f64, _: f64| shape * d.powf(shape - 1.0) * (-d.powf(shape)).exp();
    let law = Weibull::new(0.0, first, (second - first * first).sqrt()).unwrap();
    Case::new(law, vec![Piece::new(0.0, f64::INFINITY, density)])
}

/// Gumbel distribution of largest or smallest values with mode 1 and scale 0.5. The tails beyond are below 1e-60.
fn gumbel(end: ExtremeEnd) -> Case {
    let density = |y: f64| (-y - (-y).exp()).exp() / 0.5;
    let sigma = 0.5 * PI / 6f64.sqrt();
    let mean = 0.5 * 0.577_215_664_901_532_9;
    match end {
        ExtremeEnd::Largest => {
            let pieces = vec![
                Piece::new(-2.0, 1.0, move |_, d| density(-d / 0.5)),
                Piece::new(1.0, f64::INFINITY, move |d, _| density(d / 0.5)),
            ];
            Case::new(Gumbel::new(end, 1.0 + mean, sigma).unwrap(), pieces)
        }
        ExtremeEnd::Smallest => {
            let pieces = vec![
                Piece::new(-79.0, 1.0, move |_, d| density(d / 0.5)),
                Piece::new(1.0, 4.0, move |d, _| density(-d / 0.5)),
            ];
            Case::new(Gumbel::new(end, 1.0 - mean, sigma).unwrap(), pieces)
        }
    }
}

/// Split normal distribution about 5: each half has its own sigma, and the densities meet at the mode.
fn split_normal(below: f64, above: f64) -> Case {
    let height = 2.0 / (below + above);
    let pieces = vec![
        Piece::new(5.0 - 14.0 * below, 5.0, move |_, d| height * gauss(d / below)),
        Piece::new(5.0, 5.0 + 14.0 * above, move |d, _| height * gauss(d / above)),
    ];
    Case::new(SplitNormal::new(5.0, below, above).unwrap(), pieces)
}

fn part(weight: f64, distribution: impl Distribution + 'static) -> Part {
    Part { name: "part".into(), weight, distribution: Arc::new(distribution) }
}

fn mixture() -> Case {
    let parts = vec![
        part(3.0, Normal::new(10.0, 0.1).unwrap()),
        part(1.0, Uniform::new(10.1, 10.5).unwrap()),
        part(1.0, Exponential::new(9.8, 9.9).unwrap()),
    ];
    let mut pieces = normal_pieces(10.0, 0.1, 0.6);
    pieces.push(Piece::new(10.1, 10.5, |_, _| 0.2 / 0.4));
    pieces.push(Piece::new(9.8, f64::INFINITY, |d, _| 0.2 * (-d / 0.1).exp() / 0.1));
    Case::new(Mixture::new(parts).unwrap(), pieces)
}

/// Mixture of two sources with a gap between them.
fn apart() -> Case {
    let parts = vec![part(0.5, Uniform::new(0.0, 1.0).unwrap()), part(0.5, Uniform::new(4.0, 5.0).unwrap())];
    let pieces = vec![Piece::new(0.0, 1.0, |_, _| 0.5), Piece::new(4.0, 5.0, |_, _| 0.5)];
    Case::new(Mixture::new(parts).unwrap(), pieces)
}

/// Table on a straight line over the scores from -5 to 5, which have this mass of a normal distribution.
fn straight_table(mass: f64) -> Case {
    let density = move |d: f64, _: f64| gauss(10.0 * d - 5.0) * 10.0 / mass;
    let table = Tabulated::new(&[-5.0, -1.0, 0.5, 5.0], &[7.0, 7.4, 7.55, 8.0]).unwrap();
    Case::new(table, vec![Piece::new(7.0, 8.0, density)])
}

/// Table with three points of the parabola 2 + z/2 + z^2/18, which ascends from -3 to 3. The cubics equal the parabola, and its root is the
/// score.
fn parabola_table(mass: f64) -> Case {
    let density = move |d: f64, _: f64| {
        let slope = (1.0 / 36.0 + 2.0 * d / 9.0).sqrt();
        gauss(9.0 * (slope - 0.5)) / (slope * mass)
    };
    let table = Tabulated::new(&[-3.0, 0.0, 3.0], &[1.0, 2.0, 4.0]).unwrap();
    Case::new(table, vec![Piece::new(1.0, 4.0, density)])
}

/// All distributions with their densities. The constants are from mpmath 1.3 with 30 digits.
pub fn cases() -> Vec<Case> {
    vec![
        normal(),
        uniform(),
        triangular(2.5),
        triangular(1.75),
        triangular(1.0),
        triangular(4.0),
        trapezoidal(0.25),
        trapezoidal(0.9),
        truncated(0.5, 0.5, 0.997_300_203_936_739_8),
        truncated(0.5, 10.0, 0.119_235_384_740_485_04),
        truncated(1.25, 0.75, 0.839_994_848_036_912_9),
        truncated(4.0, 0.5, 3.167_124_183_311_992e-5),
        beta(2.0, 5.0, 1.0 / 30.0),
        beta(0.5, 0.5, PI),
        beta(0.5, 3.0, 16.0 / 15.0),
        beta(7.0, 1.0, 1.0 / 7.0),
        exponential(),
        rayleigh(),
        gamma(0.5, PI.sqrt()),
        gamma(3.0, 2.0),
        gamma(20.0, 1.216_451_004_088_32e17),
        lognormal(0.1),
        lognormal(0.5),
        weibull(1.5, 0.902_745_292_950_933_6, 1.190_639_348_758_999),
        weibull(0.7, 1.265_823_506_057_283_3, 5.029_144_702_140_307),
        weibull(8.0, 0.941_742_699_849_701_5, 0.906_402_477_055_477),
        mixture(),
        apart(),
        u_shaped(),
        octahedron(),
        bicone(),
        curvilinear(0.125),
        curvilinear(0.75),
        student(),
        straight_table(0.999_999_426_696_856_2),
        parabola_table(0.997_300_203_936_739_8),
        gumbel(ExtremeEnd::Largest),
        gumbel(ExtremeEnd::Smallest),
        split_normal(0.1, 0.2),
        split_normal(1.0, 0.04),
    ]
}
