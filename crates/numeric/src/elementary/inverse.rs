//! Arc cosine, `acos`.

use std::f64::consts::FRAC_PI_2;

use crate::elementary::{Elementary, choose, mask};

/// Difference between pi/2 and its double.
const LACKS: f64 = 6.123_233_995_736_766e-17;

/// Arc cosine `acos(x)`, in radians.
pub struct Acos;

const P: [f64; 6] = [
    0.166_666_666_666_666_66,
    -0.325_565_818_622_400_9,
    0.201_212_532_134_862_93,
    -0.040_055_534_500_679_41,
    0.000_791_534_994_289_814_5,
    3.479_331_075_960_212e-5,
];
const Q: [f64; 4] =
    [-2.403_394_911_734_414, 2.020_945_760_233_505_7, -0.688_283_971_605_453_3, 0.077_038_150_555_901_94];

impl Elementary for Acos {
    /// Arc cosine by the arc sine in the middle, and by that of half the angle towards the ends.
    #[inline(always)]
    fn lane(x: f64) -> (f64, bool) {
        let size = x.abs();
        let middle = mask(size < 0.5);
        let z = choose(middle, x * x, 0.5 * (1.0 - size));
        let p = z * (P[0] + z * (P[1] + z * (P[2] + z * (P[3] + z * (P[4] + z * P[5])))));
        let q = 1.0 + z * (Q[0] + z * (Q[1] + z * (Q[2] + z * Q[3])));
        let r = p / q;
        let inner = FRAC_PI_2 - (x - (LACKS - x * r));
        let s = z.sqrt();
        let left = 2.0 * (FRAC_PI_2 - (s + (r * s - LACKS)));
        // Split the root in two parts, since half the angle is little more than the root.
        let high = f64::from_bits(s.to_bits() & 0xffff_ffff_0000_0000);
        let low = (z - high * high) / (s + high);
        let right = 2.0 * (high + (r * s + low));
        let outer = choose(mask(x < 0.0), left, right);
        (choose(middle, inner, outer), (size >= 1.0) | x.is_nan())
    }

    fn apart(x: f64) -> f64 {
        libm::acos(x)
    }
}
