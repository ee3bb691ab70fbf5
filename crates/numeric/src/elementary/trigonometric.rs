//! Trigonometric functions `sin`, `cos` and `tan`.

use std::f64::consts::FRAC_2_PI;

use crate::elementary::{Elementary, choose};

/// `pi/2` in two parts of 33 bits and the rest. A whole number below `2^20` times a part of 33 bits is exact.
const PARTS: [f64; 3] = [
    f64::from_bits(0x3ff9_21fb_5440_0000),
    f64::from_bits(0x3dd0_b461_1a60_0000),
    f64::from_bits(0x3ba3_198a_2e03_7073),
];
/// Greatest argument of the fast path: up to here arguments hold fewer than `2^20` quarter turns.
const FARTHEST: f64 = 1.6e6;
/// Least distance from a multiple of pi/2 for the fast path. Closer, the parts have too few digits: the remainder is exact to `2^-99` only.
const NEAREST: f64 = 1.0 / (1u64 << 30) as f64;
/// Rounds to a whole number: added and subtracted again, it leaves the nearest one. In between, that number stands in the last bits of the
/// sum.
const ROUNDING: f64 = 6_755_399_441_055_744.0;

/// Sine `sin(x)`, x in radians.
pub struct Sin;

/// Cosine `cos(x)`, x in radians.
pub struct Cos;

/// Tangent `tan(x)`, x in radians.
pub struct Tan;

/// Angle minus the nearest multiple of `pi/2`.
struct Reduced {
    /// Bits of the multiple, of which the last two count.
    quarters: u64,
    rest: f64,
    /// Rounding error of `rest`.
    tail: f64,
    /// True if the reduction is not accurate enough.
    apart: bool,
}

#[inline(always)]
fn reduced(x: f64) -> Reduced {
    let rounding = x * FRAC_2_PI + ROUNDING;
    let n = rounding - ROUNDING;
    let first = x - n * PARTS[0];
    let part = n * PARTS[1];
    let second = first - part;
    // The rounding error of the second difference, corrected by the third part. It needs no comparison, since the first difference is a
    // multiple of the last digit of the part (Boldo, Graillat and Muller 2017).
    let less = n * PARTS[2] - ((first - second) - part);
    let rest = second - less;
    let tail = (second - rest) - less;
    let near = (rest.abs() < NEAREST) & (n != 0.0);
    Reduced { quarters: rounding.to_bits(), rest, tail, apart: (x.abs() > FARTHEST) | x.is_nan() | near }
}

const S: [f64; 6] = [
    -0.166_666_666_666_666_32,
    0.008_333_333_333_322_49,
    -0.000_198_412_698_298_579_5,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const C: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_411,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sine between `-pi/4` and `pi/4`, with `tail` the rounding error of `x`.
#[inline(always)]
fn sine(x: f64, tail: f64) -> f64 {
    let z = x * x;
    let v = z * x;
    let p = S[1] + z * (S[2] + z * (S[3] + z * (S[4] + z * S[5])));
    x - ((z * (0.5 * tail - v * p) - tail) - v * S[0])
}

/// Cosine between `-pi/4` and `pi/4`, with `tail` the rounding error of `x`.
#[inline(always)]
fn cosine(x: f64, tail: f64) -> f64 {
    let z = x * x;
    let p = z * (C[0] + z * (C[1] + z * C[2])) + z * z * (z * z) * (C[3] + z * (C[4] + z * C[5]));
    let half = 0.5 * z;
    let w = 1.0 - half;
    w + (((1.0 - w) - half) + (z * p - x * tail))
}

/// Sine of an angle after this many further quarter turns.
#[inline(always)]
fn sine_after(angle: &Reduced, quarters: u64) -> f64 {
    let (s, c) = (sine(angle.rest, angle.tail), cosine(angle.rest, angle.tail));
    let quarters = angle.quarters.wrapping_add(quarters);
    let odd = 0u64.wrapping_sub(quarters & 1);
    turned(choose(odd, c, s), quarters)
}

/// Value after this many quarter turns, of which every second one changes the sign.
#[inline(always)]
fn turned(value: f64, quarters: u64) -> f64 {
    f64::from_bits(value.to_bits() ^ (quarters & 2) << 62)
}

/// Numbers whose quarter turns are inspected together.
const LOOK: usize = 64;

/// Maps numbers to their sines after `more` further quarter turns. Inputs vary little, so mostly all angles of a chunk need the same one of
/// the two polynomials.
#[inline(always)]
fn map_sines<E: Elementary>(x: &[f64], out: &mut [f64], more: u64) {
    let (looks, x_rest) = x.as_chunks::<LOOK>();
    let (outs, out_rest) = out.as_chunks_mut::<LOOK>();
    let (mut tails, mut quarters) = ([0.0; LOOK], [0; LOOK]);
    let mut apart = false;
    for (x, out) in looks.iter().zip(outs) {
        let (mut any, mut all) = (0, u64::MAX);
        for lane in 0..LOOK {
            let angle = reduced(x[lane]);
            (out[lane], tails[lane], quarters[lane]) = (angle.rest, angle.tail, angle.quarters.wrapping_add(more));
            any |= quarters[lane];
            all &= quarters[lane];
            apart |= angle.apart;
        }
        if any & 1 == 0 {
            for lane in 0..LOOK {
                out[lane] = turned(sine(out[lane], tails[lane]), quarters[lane]);
            }
        } else if all & 1 == 1 {
            for lane in 0..LOOK {
                out[lane] = turned(cosine(out[lane], tails[lane]), quarters[lane]);
            }
        } else {
            for lane in 0..LOOK {
                let angle = Reduced { quarters: quarters[lane], rest: out[lane], tail: tails[lane], apart: false };
                out[lane] = sine_after(&angle, 0);
            }
        }
    }
    for (out, &x) in out_rest.iter_mut().zip(x_rest) {
        let (value, other) = E::lane(x);
        *out = value;
        apart |= other;
    }
    if apart {
        E::map_apart(x, out);
    }
}

impl Elementary for Sin {
    #[inline(always)]
    fn lane(x: f64) -> (f64, bool) {
        let angle = reduced(x);
        (sine_after(&angle, 0), angle.apart)
    }

    fn apart(x: f64) -> f64 {
        libm::sin(x)
    }

    #[inline(always)]
    fn map_inline(x: &[f64], out: &mut [f64]) {
        map_sines::<Self>(x, out, 0);
    }
}

impl Elementary for Cos {
    #[inline(always)]
    fn lane(x: f64) -> (f64, bool) {
        let angle = reduced(x);
        (sine_after(&angle, 1), angle.apart)
    }

    fn apart(x: f64) -> f64 {
        libm::cos(x)
    }

    #[inline(always)]
    fn map_inline(x: &[f64], out: &mut [f64]) {
        map_sines::<Self>(x, out, 1);
    }
}

impl Elementary for Tan {
    #[inline(always)]
    fn lane(x: f64) -> (f64, bool) {
        let angle = reduced(x);
        let (s, c) = (sine(angle.rest, angle.tail), cosine(angle.rest, angle.tail));
        let odd = 0u64.wrapping_sub(angle.quarters & 1);
        let quotient = choose(odd, c, s) / choose(odd, s, c);
        (f64::from_bits(quotient.to_bits() ^ (odd & 1) << 63), angle.apart)
    }

    fn apart(x: f64) -> f64 {
        libm::tan(x)
    }
}
