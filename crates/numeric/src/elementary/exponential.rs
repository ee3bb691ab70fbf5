//! Exponential function `exp` and natural logarithm `ln`.

use crate::elementary::Elementary;

/// First 32 bits of `ln 2`, and the rest.
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];

/// Exponential function `exp(x)`.
pub struct Exp;

/// Natural logarithm `ln(x)`.
pub struct Ln;

const P: [f64; 5] = [
    0.166_666_666_666_666_02,
    -0.002_777_777_777_701_559_3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];

impl Elementary for Exp {
    #[inline(always)]
    fn lane(x: f64) -> (f64, bool) {
        /// Rounds to a whole number, as in the reduction of angles.
        const ROUNDING: f64 = 6_755_399_441_055_744.0;
        let rounding = x * std::f64::consts::LOG2_E + ROUNDING;
        let n = rounding - ROUNDING;
        let (high, low) = (x - n * LN_2[0], n * LN_2[1]);
        let r = high - low;
        let z = r * r;
        let c = r - z * (P[0] + z * (P[1] + z * (P[2] + z * (P[3] + z * P[4]))));
        let value = 1.0 + (r * c / (2.0 - c) - low + high);
        // Move the whole number into the exponent by a shift of its last bits, which are in two's complement.
        let power = rounding.to_bits().wrapping_add(1023) << 52;
        (value * f64::from_bits(power), (x.abs() > 708.0) | x.is_nan())
    }

    fn apart(x: f64) -> f64 {
        libm::exp(x)
    }
}

const L: [f64; 7] = [
    0.666_666_666_666_673_5,
    0.399_999_999_994_094_2,
    0.285_714_287_436_623_9,
    0.222_221_984_321_497_84,
    0.181_835_721_616_180_5,
    0.153_138_376_992_093_73,
    0.147_981_986_051_165_86,
];

/// Natural logarithm of a normal number above 0.
#[inline(always)]
fn logarithm(x: f64) -> f64 {
    /// Bits of sqrt(1/2), the least mantissa. The greatest one is twice that.
    const LEAST: u64 = 0x3fe6_a09e_0000_0000;
    let bits = x.to_bits().wrapping_add(0x3ff0_0000_0000_0000 - LEAST);
    // Read the exponent as a number: it stands in the last bits of 2^52.
    let n = f64::from_bits(0x4330_0000_0000_0000 | bits >> 52) - (4_503_599_627_370_496.0 + 1023.0);
    let f = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) + LEAST) - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (L[1] + w * (L[3] + w * L[5]));
    let odd = z * (L[0] + w * (L[2] + w * (L[4] + w * L[6])));
    let half = 0.5 * f * f;
    s * (half + (odd + even)) + n * LN_2[1] - half + f + n * LN_2[0]
}

impl Elementary for Ln {
    #[inline(always)]
    fn lane(x: f64) -> (f64, bool) {
        (logarithm(x), !(f64::MIN_POSITIVE..=f64::MAX).contains(&x))
    }

    fn apart(x: f64) -> f64 {
        libm::log(x)
    }
}
