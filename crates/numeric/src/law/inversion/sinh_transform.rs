//! Inputs whose transform is a product of factors `sinh(a s)/(a s)`: uniform, symmetric triangular and symmetric trapezoidal. Their part of
//! the surface is straight. They are sums of one or two uniform variables of half-widths `a`.

use crate::law::input::Input;
use crate::law::inversion::complex::Complex;
use crate::law::polynomial::Quartic;

/// Half-widths of all uniform variables of a surface.
#[derive(Debug, Clone, Default)]
pub(in crate::law) struct SinhTransform {
    halves: Vec<f64>,
    pub(in crate::law) inputs: Vec<Hat>,
}

/// One input as a sum of uniform variables.
#[derive(Debug, Clone)]
pub(in crate::law) struct Hat {
    /// Index of the input in the surface.
    pub(in crate::law) input: usize,
    /// Half-widths in sigmas of the input, times its slope.
    pub(in crate::law) halves: Vec<f64>,
}

/// Argument below which the quotient is summed as a series, to full accuracy.
const SMALL: f64 = 0.5;

impl Hat {
    /// Uniform variables of an input. Returns None if the part is curved or the distribution is of another family.
    pub(in crate::law) fn of(input: usize, law: &Input, part: &Quartic) -> Option<Self> {
        if part[2..].iter().any(|&c| c != 0.0) {
            return None;
        }
        let slope = part[1];
        let halves = law.uniform_halves()?.into_iter().map(|half| (half * slope).abs()).collect();
        Some(Self { input, halves })
    }
}

impl SinhTransform {
    pub(in crate::law) fn push(&mut self, hat: Hat) {
        self.halves.extend_from_slice(&hat.halves);
        self.inputs.push(hat);
    }

    pub(in crate::law) fn is_empty(&self) -> bool {
        self.halves.is_empty()
    }

    pub(in crate::law) fn variance(&self) -> f64 {
        self.halves.iter().map(|a| a * a / 3.0).sum()
    }

    /// `[K, K', K'']` at a real `s`.
    pub(in crate::law) fn cumulants(&self, s: f64) -> [f64; 3] {
        self.halves.iter().fold([0.0; 3], |[k, k1, k2], &a| {
            let x = a * s;
            let (log, first, second) = match x.abs() < SMALL {
                true => {
                    let square = x * x;
                    // Derivatives of log(sinh x/x): x/3 - x^3/45 + 2 x^5/945 - x^7/4725 + 2 x^9/93555 - ...
                    let log = libm::log1p(quotient_less_one(square));
                    let first = x * series(square, &FIRST);
                    let second = series(square, &SECOND);
                    (log, first, second)
                }
                false => {
                    let size = x.abs();
                    let small = libm::exp(-2.0 * size);
                    let log = size + libm::log1p(-small) - libm::log(2.0 * size);
                    let coth = (1.0 + small) / (1.0 - small);
                    let sinh_square = (1.0 - small) * (1.0 - small) / (4.0 * small);
                    let first = (coth - 1.0 / size).copysign(x);
                    let second = 1.0 / (size * size) - if small > 0.0 { 1.0 / sinh_square } else { 0.0 };
                    (log, first, second)
                }
            };
            [k + log, k1 + a * first, k2 + a * a * second]
        })
    }

    /// `M(s)/M(theta)` at `s = theta + i t`.
    pub(in crate::law) fn ratio(&self, theta: f64, t: f64) -> Complex {
        self.halves.iter().fold(Complex::ONE, |product, &a| product * ratio(a * theta.abs(), a * t.copysign(t * theta)))
    }
}

fn series(square: f64, coefficients: &[f64]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * square + c)
}

/// Coefficients of the derivative of `log(sinh x/x)` by `x`, from Bernoulli numbers: `2^(2n) B_2n/(2n)!`.
const FIRST: [f64; 9] = [
    1.0 / 3.0,
    -1.0 / 45.0,
    2.0 / 945.0,
    -1.0 / 4725.0,
    2.0 / 93555.0,
    -1382.0 / 638_512_875.0,
    4.0 / 18_243_225.0,
    -3617.0 / 162_820_783_125.0,
    87_734.0 / 38_979_295_480_125.0,
];
/// Coefficients of the second derivative of `log(sinh x/x)` by `x`: each is that of `FIRST` times its power `2n + 1`.
const SECOND: [f64; 9] = {
    let mut second = FIRST;
    let mut n = 0;
    while n < 9 {
        second[n] *= (2 * n + 1) as f64;
        n += 1;
    }
    second
};

/// `sinh x/x - 1` as a series in `square = x^2`.
fn quotient_less_one(square: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 0.0);
    for n in 1..10 {
        term *= square / ((2 * n) * (2 * n + 1)) as f64;
        sum += term;
    }
    sum
}

/// `sinh(x + i y)/(x + i y)` divided by `sinh(x)/x`, for an `x` that is not negative.
fn ratio(x: f64, y: f64) -> Complex {
    if x.abs().max(y.abs()) < SMALL {
        let square = Complex::new(x, y) * Complex::new(x, y);
        let (mut term, mut sum) = (Complex::ONE, Complex::ONE);
        for n in 1..10 {
            term = term * square * (1.0 / ((2 * n) * (2 * n + 1)) as f64);
            sum += term;
        }
        return sum * (1.0 / (1.0 + quotient_less_one(x * x)));
    }
    let turn = Complex::cis(y);
    // sinh(x + iy) = sinh x cos y + i cosh x sin y, divided by exp(x)/2 against overflow.
    let small = libm::exp(-2.0 * x);
    let (sinh, cosh) =
        (if x < SMALL { 2.0 * x * (1.0 + quotient_less_one(x * x)) * libm::exp(-x) } else { 1.0 - small }, 1.0 + small);
    let over = if x == 0.0 { 2.0 } else { sinh / x };
    Complex::new(sinh * turn.re, cosh * turn.im) / (Complex::new(x, y) * over)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Series and closed form meet at their boundary. Each is right to some units in the last place.
    #[test]
    fn the_series_meets_the_closed_form() {
        for x in [0.0, 1e-9, 0.2, 0.499] {
            for y in [1e-9, 0.3, 0.4999] {
                let by_series = ratio(x, y);
                let s = Complex::new(x, y);
                let sinh = (s.exp() - (-s).exp()) * 0.5;
                let real = if x < 1e-5 { 1.0 } else { libm::sinh(x) / x };
                let closed = sinh / (s * real);
                assert!((by_series - closed).abs() < 1e-15 / libm::hypot(x, y), "{x} {y}");
            }
            let (inside, outside) = (ratio(x, 0.5 - 1e-12), ratio(x, 0.5 + 1e-12));
            assert!((inside - outside).abs() < 1e-12, "{x}: {inside:?} {outside:?}");
        }
        let hats = SinhTransform { halves: vec![1.0], inputs: Vec::new() };
        let (below, above) = (hats.cumulants(0.5 - 1e-13), hats.cumulants(0.5 + 1e-13));
        // The derivatives by s are below 1, and the two arguments are 2e-13 apart.
        below.iter().zip(above).for_each(|(below, above)| assert!((below - above).abs() < 2e-13, "{below} {above}"));
    }
}
