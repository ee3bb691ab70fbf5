//! Model `dual-mass-flywheel`: torsional vibration behind a dual-mass and behind a single-mass flywheel.

use std::f64::consts::PI;
use std::ops::{Add, Mul};
use std::sync::LazyLock;

use super::gas;
use super::jet::{Jet, climb};
use super::{Block, Model, ModelInput, ModelOutput};
use sensitol::assembly::{EvaluationError, Responses};
use sensitol_numeric::elementary::{Cos, Elementary, Exp, Sin};

/// Models the torsional vibration of a three-cylinder four-stroke engine with a dual-mass flywheel, or with a single-mass one and a clutch
/// damper:
///
/// ```text
/// D(W)  = (J1 + J2)(k + i c W) - J1 J2 W^2
/// H2(W) = (k + i c W)/(i W D),  H1(W) = (k - J2 W^2 + i c W)/(i W D)      speed of either mass per torque on the first
/// order 1.5: W = 1.5 n pi/30,  speed T0 |H|,  acceleration T0 W |H2|
/// n_crit = (30/pi)/1.5 sqrt(k (1/J1 + 1/J2))
/// T_g = sum_k (pi D^2 r/4)(p(th_k) - patm)(sin th_k + (r/l)/2 sin 2 th_k),  th_k = th + (k-1) 4 pi/3
/// T_i = -(9/4)(r/l)(m_p + m_A) r^2 w^2 sin 3 th
/// dW_at(th) = sum_m Re c_m H(1.5 m w) exp(1.5 i m th),  m = 1 .. 8,  c_m those of T_g + T_i;  dW_half half its range over th
/// ```
///
/// The single-mass flywheel is the same with `J_f`, `J_c`, `k_c` and `c_c`. The gas trace is our own, since the paper shows a picture only.
/// It belongs to r/l = 45/143 and does not change with tolerances of r and l.
pub static DUAL_MASS_FLYWHEEL: Model = Model {
    name: "dual-mass-flywheel",
    title: "torsional vibration of a three-cylinder engine with a dual-mass or single-mass flywheel",
    source: "Maghsoudi Gharehbolagh et al., J. Engine Research 70, 2023; gas trace ours, tolerances assumed",
    inputs: &[
        ModelInput { name: "J1", unit: "kg.m^2", nominal: 0.29, about: "inertia of the first mass" },
        ModelInput { name: "J2", unit: "kg.m^2", nominal: 0.04, about: "inertia of the second mass" },
        ModelInput { name: "k", unit: "N.m/rad", nominal: 327.844, about: "stiffness between them" },
        ModelInput { name: "c", unit: "N.m.s/rad", nominal: 1.5, about: "damping between them" },
        ModelInput { name: "J_f", unit: "kg.m^2", nominal: 0.33, about: "single mass: inertia of the flywheel" },
        ModelInput { name: "J_c", unit: "kg.m^2", nominal: 0.019, about: "single mass: inertia of the clutch" },
        ModelInput { name: "k_c", unit: "N.m/rad", nominal: 2000.0, about: "single mass: stiffness of the clutch" },
        ModelInput { name: "c_c", unit: "N.m.s/rad", nominal: 2.0, about: "single mass: damping of the clutch" },
        ModelInput { name: "T0", unit: "N.m", nominal: 420.0, about: "amplitude of the torque of order 1.5" },
        ModelInput { name: "r", unit: "m", nominal: 0.045, about: "crank radius" },
        ModelInput { name: "l", unit: "m", nominal: 0.143, about: "length of the connecting rod" },
        ModelInput { name: "D", unit: "m", nominal: 0.075, about: "bore" },
        ModelInput { name: "m_p", unit: "kg", nominal: 0.276, about: "mass of the piston" },
        ModelInput { name: "m_A", unit: "kg", nominal: 0.119, about: "mass of the rod at the piston pin" },
        ModelInput {
            name: "p3",
            unit: "Pa",
            nominal: 7_886_200.0,
            about: "pressure after combustion at the least volume",
        },
        ModelInput {
            name: "n",
            unit: "rpm",
            nominal: 1500.0,
            about: "speed of the engine, for the outputs without one in their name",
        },
        ModelInput {
            name: "theta",
            unit: "deg",
            nominal: 0.0,
            about: "crank angle from the firing dead centre of cylinder 1, for pressure to dWc_at",
        },
    ],
    outputs: &[
        ModelOutput {
            name: "n_crit_DMF",
            unit: "rpm",
            about: "critical speed, dual mass, undamped",
            depends_on: &[0, 1, 2],
        },
        ModelOutput {
            name: "n_crit_SMF",
            unit: "rpm",
            about: "critical speed, single mass, undamped",
            depends_on: &[4, 5, 6],
        },
        ModelOutput {
            name: "dW2_1000",
            unit: "rad/s",
            about: "amplitude of speed behind the dual mass at 1000 rpm, order 1.5",
            depends_on: &[0, 1, 2, 3, 8],
        },
        ModelOutput { name: "dW1_1000", unit: "rad/s", about: "the same before it", depends_on: &[0, 1, 2, 3, 8] },
        ModelOutput {
            name: "A_DMF_1500",
            unit: "rad/s^2",
            about: "amplitude of acceleration, dual mass, 1500 rpm",
            depends_on: &[0, 1, 2, 3, 8],
        },
        ModelOutput {
            name: "A_SMF_1500",
            unit: "rad/s^2",
            about: "amplitude of acceleration, single mass, 1500 rpm",
            depends_on: &[4, 5, 6, 7, 8],
        },
        ModelOutput {
            name: "A_ratio_1500",
            unit: "-",
            about: "the former by the latter",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7],
        },
        ModelOutput {
            name: "n_cross",
            unit: "rpm",
            about: "speed above which the dual mass is better",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7],
        },
        ModelOutput {
            name: "A_peak_DMF",
            unit: "rad/s^2",
            about: "largest acceleration over the speed, dual mass",
            depends_on: &[0, 1, 2, 3, 8],
        },
        ModelOutput {
            name: "dW2_1000_multi",
            unit: "rad/s",
            about: "half the range of speed behind the dual mass at 1000 rpm, eight orders",
            depends_on: &[0, 1, 2, 3, 9, 10, 11, 12, 13, 14],
        },
        ModelOutput {
            name: "A_DMF",
            unit: "rad/s^2",
            about: "amplitude of acceleration, dual mass, at n",
            depends_on: &[0, 1, 2, 3, 8, 15],
        },
        ModelOutput {
            name: "A_SMF",
            unit: "rad/s^2",
            about: "amplitude of acceleration, single mass, at n",
            depends_on: &[4, 5, 6, 7, 8, 15],
        },
        ModelOutput { name: "pressure", unit: "Pa", about: "pressure in cylinder 1 at theta", depends_on: &[14, 16] },
        ModelOutput {
            name: "T_gas",
            unit: "N.m",
            about: "torque of the gas in three cylinders at theta",
            depends_on: &[9, 10, 11, 14, 16],
        },
        ModelOutput {
            name: "T_inertia",
            unit: "N.m",
            about: "torque of their inertia at theta",
            depends_on: &[9, 10, 12, 13, 15, 16],
        },
        ModelOutput {
            name: "T_engine",
            unit: "N.m",
            about: "sum of both",
            depends_on: &[9, 10, 11, 12, 13, 14, 15, 16],
        },
        ModelOutput { name: "time", unit: "s", about: "time from theta = 0 at the speed n", depends_on: &[15, 16] },
        ModelOutput {
            name: "dW1_at",
            unit: "rad/s",
            about: "speed before the dual mass less its mean, at theta, eight orders",
            depends_on: &[0, 1, 2, 3, 9, 10, 11, 12, 13, 14, 15, 16],
        },
        ModelOutput {
            name: "dW2_at",
            unit: "rad/s",
            about: "the same behind it",
            depends_on: &[0, 1, 2, 3, 9, 10, 11, 12, 13, 14, 15, 16],
        },
        ModelOutput {
            name: "dWf_at",
            unit: "rad/s",
            about: "single mass: the same of the flywheel",
            depends_on: &[4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16],
        },
        ModelOutput {
            name: "dWc_at",
            unit: "rad/s",
            about: "single mass: the same behind the clutch's damper",
            depends_on: &[4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16],
        },
        ModelOutput {
            name: "dW1_half",
            unit: "rad/s",
            about: "half the range of dW1_at over theta",
            depends_on: &[0, 1, 2, 3, 9, 10, 11, 12, 13, 14, 15],
        },
        ModelOutput {
            name: "dW2_half",
            unit: "rad/s",
            about: "half the range of dW2_at",
            depends_on: &[0, 1, 2, 3, 9, 10, 11, 12, 13, 14, 15],
        },
        ModelOutput {
            name: "dWf_half",
            unit: "rad/s",
            about: "half the range of dWf_at",
            depends_on: &[4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15],
        },
        ModelOutput {
            name: "dWc_half",
            unit: "rad/s",
            about: "half the range of dWc_at",
            depends_on: &[4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15],
        },
        ModelOutput {
            name: "dWf_1000",
            unit: "rad/s",
            about: "amplitude of speed of the single-mass flywheel at 1000 rpm, order 1.5",
            depends_on: &[4, 5, 6, 7, 8],
        },
        ModelOutput {
            name: "dWc_1000",
            unit: "rad/s",
            about: "the same behind the clutch's damper",
            depends_on: &[4, 5, 6, 7, 8],
        },
    ],
    evaluate,
    bounds: &[],
};

/// Number of inputs.
const INPUTS: usize = 17;
/// Order of the crankshaft of the first vibration of three cylinders.
const ORDER: f64 = 1.5;
/// Number of orders in `dW2_1000_multi`.
const HARMONICS: usize = 8;
/// Number of points at which the search for its extremes begins: twelve for every period of the highest order.
const PLACES: usize = 96;

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    for (output, model) in DUAL_MASS_FLYWHEEL.outputs.iter().enumerate() {
        let Some(column) = block.column(output) else { continue };
        // Only the columns that the output depends on are read.
        let mut x = [0.0; INPUTS];
        let columns: Vec<(usize, &[f64])> = model.depends_on.iter().map(|&at| (at, block.input(at))).collect();
        for row in 0..block.rows() {
            columns.iter().for_each(|&(at, values)| x[at] = values[row]);
            match value(output, &x) {
                Some(value) => out.set(row, column, value),
                None => out.fail(row, column, EvaluationError::Refused { message: NO_CROSSING.into() }),
            }
        }
    }
}

const NO_CROSSING: &str = "the accelerations behind the two flywheels do not cross between their critical speeds";

/// One output at one point. Returns None if the output is a crossing that does not exist.
fn value(output: usize, x: &[f64; INPUTS]) -> Option<f64> {
    let (dual, single) = (|| Shaft::new(x[0], x[1], x[2], x[3]), || Shaft::new(x[4], x[5], x[6], x[7]));
    let crank = Crank { r: x[9], l: x[10], bore: x[11], mass: x[12] + x[13], p3: x[14] };
    let acceleration = |shaft: Shaft, n: f64| x[8] * circular(n) * shaft.second(circular(n));
    Some(match output {
        0 => dual().critical(),
        1 => single().critical(),
        2 => x[8] * dual().second(circular(1000.0)),
        3 => x[8] * dual().first(circular(1000.0)),
        4 => acceleration(dual(), 1500.0),
        5 => acceleration(single(), 1500.0),
        6 => dual().second(circular(1500.0)) / single().second(circular(1500.0)),
        7 => return crossing(&dual(), &single()),
        8 => x[8] * dual().largest_acceleration(),
        9 => half_range(&crank.speeds(&dual(), Mass::Last, 1000.0)),
        10 => acceleration(dual(), x[15]),
        11 => acceleration(single(), x[15]),
        12 => gas::pressure(wrapped(x[16]), x[14], IGNITION, ROD_BY_CRANK),
        13 => crank.gas(x[16]),
        14 => crank.inertia(x[16], x[15]),
        15 => crank.gas(x[16]) + crank.inertia(x[16], x[15]),
        16 => x[16] / (6.0 * x[15]),
        17 => wave(&crank.speeds(&dual(), Mass::First, x[15]), ORDER * x[16] * PI / 180.0).0[0],
        18 => wave(&crank.speeds(&dual(), Mass::Last, x[15]), ORDER * x[16] * PI / 180.0).0[0],
        19 => wave(&crank.speeds(&single(), Mass::First, x[15]), ORDER * x[16] * PI / 180.0).0[0],
        20 => wave(&crank.speeds(&single(), Mass::Last, x[15]), ORDER * x[16] * PI / 180.0).0[0],
        21 => half_range(&crank.speeds(&dual(), Mass::First, x[15])),
        22 => half_range(&crank.speeds(&dual(), Mass::Last, x[15])),
        23 => half_range(&crank.speeds(&single(), Mass::First, x[15])),
        24 => half_range(&crank.speeds(&single(), Mass::Last, x[15])),
        25 => x[8] * single().first(circular(1000.0)),
        _ => x[8] * single().second(circular(1000.0)),
    })
}

/// Circular frequency of order 1.5 at a speed in rpm.
fn circular(n: f64) -> f64 {
    ORDER * n * PI / 30.0
}

/// Absolute value of a complex number. The squares of all numbers here are finite, and the square root gives the same bits on every
/// machine.
fn size(re: f64, im: f64) -> f64 {
    (re * re + im * im).sqrt()
}

/// Two masses with a spring and a damper between them.
struct Shaft {
    stiffness: f64,
    damping: f64,
    /// Sum of the masses' inertias.
    sum: f64,
    /// Product of the masses' inertias.
    product: f64,
    /// Inertia of the second mass.
    last: f64,
}

impl Shaft {
    fn new(first: f64, last: f64, stiffness: f64, damping: f64) -> Self {
        Self { stiffness, damping, sum: first + last, product: first * last, last }
    }

    fn critical(&self) -> f64 {
        30.0 / PI / ORDER * (self.stiffness * self.sum / self.product).sqrt()
    }

    /// Coefficients of |D|^2 as a polynomial in the square of the frequency, constant first.
    fn denominator(&self) -> [f64; 3] {
        let [spring, damper] = [self.sum * self.stiffness, self.sum * self.damping];
        [spring * spring, damper * damper - 2.0 * spring * self.product, self.product * self.product]
    }

    fn size_of_denominator(&self, w: f64) -> f64 {
        size(self.sum * self.stiffness - self.product * w * w, self.sum * self.damping * w)
    }

    /// Absolute value |H2|.
    fn second(&self, w: f64) -> f64 {
        size(self.stiffness, self.damping * w) / (w * self.size_of_denominator(w))
    }

    /// Absolute value |H1|.
    fn first(&self, w: f64) -> f64 {
        size(self.stiffness - self.last * w * w, self.damping * w) / (w * self.size_of_denominator(w))
    }

    /// Largest W |H2|. The derivative of its square by W^2 is 0 there, a quadratic equation.
    fn largest_acceleration(&self) -> f64 {
        let [d, b, a] = self.denominator();
        let [k, c] = [self.stiffness * self.stiffness, self.damping * self.damping];
        let rest = c * d - b * k;
        // The larger root, in the form that admits a damping of 0.
        let square = rest / (a * k + (a * a * k * k + a * c * rest).sqrt());
        ((k + c * square) / (d + square * (b + square * a))).sqrt()
    }
}

/// Speed between the critical speeds at which both flywheels give the same acceleration. Returns None if there is none.
fn crossing(dual: &Shaft, single: &Shaft) -> Option<f64> {
    // Equal |H2|^2, multiplied by both denominators, gives a cubic in W^2.
    let side = |of: &Shaft, other: &Shaft| {
        let ([k, c], d) = ([of.stiffness * of.stiffness, of.damping * of.damping], other.denominator());
        [k * d[0], k * d[1] + c * d[0], k * d[2] + c * d[1], c * d[2]]
    };
    let (one, other) = (side(dual, single), side(single, dual));
    let cubic: [f64; 4] = std::array::from_fn(|power| one[power] - other[power]);
    let at = |x: f64| cubic.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient);
    let slope = |x: f64| cubic[1] + x * (2.0 * cubic[2] + x * 3.0 * cubic[3]);
    let [mut low, mut high] = [dual, single].map(|shaft| shaft.stiffness * shaft.sum / shaft.product);
    if !(low < high && at(low) > 0.0 && at(high) < 0.0) {
        return None;
    }
    // Newton's method from the middle of the critical speeds. A step that leaves the bracket is replaced by halving.
    let mut x = 0.25 * (low.sqrt() + high.sqrt()).powi(2);
    for _ in 0..128 {
        if at(x) > 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - at(x) / slope(x);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let done = (next - x).abs() <= 4.0 * f64::EPSILON * x;
        x = next;
        if done {
            break;
        }
    }
    Some(x.sqrt() * 30.0 / PI / ORDER)
}

/// One crank of three.
struct Crank {
    r: f64,
    l: f64,
    bore: f64,
    /// Reciprocating mass.
    mass: f64,
    p3: f64,
}

/// Either end of a shaft.
#[derive(Clone, Copy)]
enum Mass {
    First,
    Last,
}

/// Angle of the cycle, wrapped to -360 .. 360 degrees.
fn wrapped(degrees: f64) -> f64 {
    (degrees + 360.0).rem_euclid(720.0) - 360.0
}

impl Crank {
    /// Torque of the gas in three cylinders.
    fn gas(&self, degrees: f64) -> f64 {
        let (area, ratio) = (0.25 * PI * self.bore * self.bore * self.r, self.r / self.l);
        let cylinder = |behind: f64| {
            let at = wrapped(degrees + behind);
            let (theta, pressure) = (at * PI / 180.0, gas::pressure(at, self.p3, IGNITION, ROD_BY_CRANK));
            (pressure - gas::ATMOSPHERE) * (Sin::of(theta) + 0.5 * ratio * Sin::of(2.0 * theta))
        };
        area * [0.0, 240.0, 480.0].map(cylinder).iter().sum::<f64>()
    }

    /// Torque of the inertia of three cylinders: only order 3 remains in their sum.
    fn inertia(&self, degrees: f64, n: f64) -> f64 {
        let (w, theta) = (n * PI / 30.0, wrapped(degrees) * PI / 180.0);
        -2.25 * self.r / self.l * self.mass * self.r * self.r * w * w * Sin::of(3.0 * theta)
    }

    /// Fourier coefficients of the speed at either end of a shaft.
    fn speeds(&self, shaft: &Shaft, mass: Mass, n: f64) -> [Complex; HARMONICS] {
        let w = n * PI / 30.0;
        let (area, ratio) = (0.25 * PI * self.bore * self.bore * self.r, self.r / self.l);
        std::array::from_fn(|harmonic| {
            let order = harmonic + 1;
            let [fresh, burnt, fresh_twice, burnt_twice] = TORQUES[harmonic];
            let single = fresh + burnt * self.p3;
            let twice = fresh_twice + burnt_twice * self.p3;
            let mut torque = (single + twice * (0.5 * ratio)) * area;
            if order == 2 {
                torque.im += 2.25 * ratio * self.mass * self.r * self.r * w * w;
            }
            // H2 = (k + icW)/(iWD), with its denominator D. H1 has k - J2 W^2 in place of k.
            let frequency = ORDER * order as f64 * w;
            let spring = Complex { re: shaft.stiffness, im: shaft.damping * frequency };
            let denominator = spring * shaft.sum + Complex { re: -shaft.product * frequency * frequency, im: 0.0 };
            let passes = match mass {
                Mass::First => Complex { re: spring.re - shaft.last * frequency * frequency, im: spring.im },
                Mass::Last => spring,
            };
            torque * passes * (Complex { re: 0.0, im: frequency } * denominator).inverse()
        })
    }
}

/// Sum of all orders, with derivatives, at `x`, which is 1.5 times the crank angle.
fn wave(speeds: &[Complex; HARMONICS], x: f64) -> Jet {
    let turn = Complex { re: Cos::of(x), im: Sin::of(x) };
    let (mut power, mut jet) = (turn, [0.0; 3]);
    for (harmonic, speed) in speeds.iter().enumerate() {
        let (term, m) = (*speed * power, (harmonic + 1) as f64);
        jet[0] += term.re;
        jet[1] -= m * term.im;
        jet[2] -= m * m * term.re;
        power = power * turn;
    }
    Jet(jet)
}

/// Half the range of the sum of all orders over the crank angle.
fn half_range(speeds: &[Complex; HARMONICS]) -> f64 {
    let place = 2.0 * PI / PLACES as f64;
    let mut values = [0.0; PLACES];
    for (value, turns) in values.iter_mut().zip(TURNS.iter()) {
        *value = speeds.iter().zip(turns).map(|(speed, turn)| speed.re * turn.re - speed.im * turn.im).sum();
    }
    let extreme = |sign: f64| {
        let best = (0..PLACES).max_by(|&a, &b| (sign * values[a]).total_cmp(&(sign * values[b]))).unwrap_or(0);
        let at = best as f64 * place;
        climb(|x| Jet(wave(speeds, x).0.map(|part| sign * part)), at, [at - place, at + place]).value
    };
    0.5 * (extreme(1.0) + extreme(-1.0))
}

#[derive(Debug, Clone, Copy)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn inverse(self) -> Self {
        let square = self.re * self.re + self.im * self.im;
        Self { re: self.re / square, im: -self.im / square }
    }
}

impl Add for Complex {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Mul for Complex {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl Mul<f64> for Complex {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { re: factor * self.re, im: factor * self.im }
    }
}

/// Values of `exp(i m x)` at the points of the search, for every order.
static TURNS: LazyLock<Vec<[Complex; HARMONICS]>> = LazyLock::new(|| {
    let turn = |place: usize, order: usize| {
        let x = 2.0 * PI * (place * order % PLACES) as f64 / PLACES as f64;
        Complex { re: Cos::of(x), im: Sin::of(x) }
    };
    (0..PLACES).map(|place| std::array::from_fn(|harmonic| turn(place, harmonic + 1))).collect()
});

/// Crank angle of ignition, degrees.
const IGNITION: f64 = -15.0;
/// Ratio of rod to crank in the gas trace.
const ROD_BY_CRANK: f64 = 143.0 / 45.0;

/// Fourier coefficients of three cylinders' pressure times sin th, and times sin 2 th. Each has a constant and a factor of p3.
///
/// The trace is smooth between -360, -180, the ignition at -15, 180 and 360 degrees. In between, Gauss's rule on parts of at most 15
/// degrees has an error of 1e-15.
static TORQUES: LazyLock<[[Complex; 4]; HARMONICS]> = LazyLock::new(|| {
    const PARTS: [(f64, f64, usize); 4] =
        [(-360.0, -180.0, 12), (-180.0, IGNITION, 11), (IGNITION, 180.0, 13), (180.0, 360.0, 12)];
    let mut sums = [[Complex { re: 0.0, im: 0.0 }; 4]; HARMONICS];
    for (from, to, parts) in PARTS {
        let half = 0.5 * (to - from) / parts as f64;
        for part in 0..parts {
            let middle = from + half * (2 * part + 1) as f64;
            for (node, weight) in NODES.iter().flat_map(|&(node, weight)| [(-node, weight), (node, weight)]) {
                let degrees = middle + half * node;
                let theta = degrees * PI / 180.0;
                let (sin, cos) = (Sin::of(theta), Cos::of(theta));
                let [fresh, burnt] = match degrees {
                    ..-180.0 => [gas::SUCTION, 0.0],
                    180.0.. => gas::exhaust(degrees),
                    _ => {
                        let unburnt = Exp::of(gas::unburnt_log(degrees, IGNITION));
                        let [fresh, burnt] = gas::strokes(sin, cos, ROD_BY_CRANK);
                        [unburnt * fresh, (1.0 - unburnt) * burnt]
                    }
                };
                let pressures = [fresh - gas::ATMOSPHERE, burnt];
                // Factor for three cylinders, and 2/(4 pi) of the integral over two turns.
                let share = 3.0 * weight * half * PI / 180.0 / (2.0 * PI);
                for (harmonic, sums) in sums.iter_mut().enumerate() {
                    let angle = ORDER * (harmonic + 1) as f64 * theta;
                    let turn = Complex { re: share * Cos::of(angle), im: -share * Sin::of(angle) };
                    for (index, arm) in [sin, 2.0 * sin * cos].into_iter().enumerate() {
                        for (of, pressure) in pressures.into_iter().enumerate() {
                            sums[2 * index + of] = sums[2 * index + of] + turn * (arm * pressure);
                        }
                    }
                }
            }
        }
    }
    sums
});

/// Nodes and weights of the Gauss-Legendre rule of ten points, the positive half.
const NODES: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];
