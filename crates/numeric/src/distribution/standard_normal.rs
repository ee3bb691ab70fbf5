//! Standard normal distribution function and its inverse, to the last digits in both tails.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use crate::elementary::{Elementary, Ln, Work, on_this_processor};

/// Density at `z`.
pub fn density(z: f64) -> f64 {
    libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt()
}

/// Probability below `z`, to a few ulp down to the smallest doubles.
pub fn cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

/// Probability above `z`.
pub fn sf(z: f64) -> f64 {
    cdf(-z)
}

/// Value below which the probability is `p`: algorithm AS 241, PPND16 (Wichura 1988), about 1e-16 relative.
pub fn quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= CENTRAL {
        return central(q);
    }
    if p < 0.5 { lower_tail(p) } else { -lower_tail(1.0 - p) }
}

/// Replaces probabilities by quantiles, as [`Probability::quantiles`](crate::distribution::Probability::quantiles).
pub(crate) fn quantiles(tails: &mut [f64]) {
    quantiles_about((0.0, 1.0), tails);
}

/// Replaces probabilities by quantiles of the normal distribution with this mean and sigma.
pub(super) fn quantiles_about(place: (f64, f64), tails: &mut [f64]) {
    for tails in tails.chunks_mut(LANES) {
        on_this_processor(Quantiles { place, values: tails });
    }
}

/// Greatest distance of a probability from one half for which the central approximation is used.
const CENTRAL: f64 = 0.425;

#[inline(always)]
fn central(q: f64) -> f64 {
    let r = 0.180_625 - q * q;
    q * polynomial(&CENTRE[0], r) / polynomial(&CENTRE[1], r)
}

/// Probabilities that are computed together.
const LANES: usize = 256;
/// Probabilities that are tested for tails at once, one bit each.
const LOOK: usize = 64;

struct Quantiles<'a> {
    place: (f64, f64),
    values: &'a mut [f64],
}

impl Work for Quantiles<'_> {
    type Output = ();

    /// Quantiles with the same bits as one by one: the tails are collected and computed side by side, the centre is computed for all.
    #[inline(always)]
    fn work(self) {
        let Self { place: (mean, sigma), values } = self;
        let (mut places, mut outer) = ([0; LANES], [0.0; LANES]);
        let mut count = 0;
        let (looks, rest) = values.as_chunks::<LOOK>();
        for (look, values) in looks.iter().enumerate() {
            // One bit for each value in a tail, so that only those few are visited.
            let mut left = (0..LOOK).fold(0, |all, lane| all | u64::from(is_in_tail(values[lane])) << lane);
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                (places[count], outer[count]) = ((LOOK * look + lane) as u8, values[lane]);
                count += 1;
                left &= left - 1;
            }
        }
        for (place, &value) in (values.len() - rest.len()..).zip(rest).filter(|(_, value)| is_in_tail(**value)) {
            (places[count], outer[count]) = (place as u8, value);
            count += 1;
        }
        let (places, outer) = (&places[..count], &mut outer[..count]);
        let mut far = false;
        for tail in outer.iter_mut() {
            let (value, beyond) = near_tail(tail.abs());
            far |= beyond | (tail.abs() > 0.5);
            *tail = mean + sigma * from_end(*tail, value);
        }
        if far {
            for (&place, out) in places.iter().zip(outer.iter_mut()) {
                let tail = values[usize::from(place)];
                *out = mean + sigma * from_end(tail, quantile(tail.abs()));
            }
        }
        for value in values.iter_mut() {
            *value = mean + sigma * from_end(*value, central(value.abs() - 0.5));
        }
        for (&place, z) in places.iter().zip(outer.iter()) {
            values[usize::from(place)] = *z;
        }
    }
}

#[inline(always)]
fn is_in_tail(value: f64) -> bool {
    (value.abs() - 0.5).abs() > CENTRAL
}

/// Sign for the end that the probability was counted from: `quantile` itself from below, its negative from above.
#[inline(always)]
fn from_end(tail: f64, quantile: f64) -> f64 {
    if tail < 0.0 { -quantile } else { quantile }
}

/// Value above which the probability is `p`.
pub fn upper_quantile(p: f64) -> f64 {
    -quantile(p)
}

/// Mills' ratio for a `z` that is not negative: the probability above `z` over the density there. Nothing underflows.
pub(crate) fn mills(z: f64) -> f64 {
    if z < 4.0 {
        return (0.5 * PI).sqrt() * libm::erfc(z * FRAC_1_SQRT_2) * libm::exp(0.5 * z * z);
    }
    // Laplace's continued fraction z + 1/(z + 2/(z + ...)), with enough terms to converge.
    let terms = (60.0 + 800.0 / (z * z)) as u32;
    let fraction = (1..=terms).rev().fold(z, |below, n| z + f64::from(n) / below);
    1.0 / fraction
}

fn lower_tail(p: f64) -> f64 {
    if !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    if p == 0.0 {
        return f64::NEG_INFINITY;
    }
    let (value, far) = near_tail(p);
    if !far {
        return value;
    }
    let r = (-Ln::of(p)).sqrt() - 5.0;
    -polynomial(&FAR[0], r) / polynomial(&FAR[1], r)
}

/// Quantile of a probability in the tail, and true if the probability is too far out or too small for this approximation.
#[inline(always)]
fn near_tail(p: f64) -> (f64, bool) {
    let (logarithm, apart) = Ln::lane(p);
    let root = (-logarithm).sqrt();
    let r = root - 1.6;
    (-polynomial(&TAIL[0], r) / polynomial(&TAIL[1], r), apart | (root > 5.0))
}

#[inline(always)]
fn polynomial(coefficients: &[f64; 8], r: f64) -> f64 {
    let [a, b, c, d, e, f, g, h] = coefficients;
    ((((((h * r + g) * r + f) * r + e) * r + d) * r + c) * r + b) * r + a
}

/// Coefficients of numerator and denominator for `|p - 1/2| <= 0.425`.
const CENTRE: [[f64; 8]; 2] = [
    [
        3.387_132_872_796_366_5,
        133.141_667_891_784_38,
        1_971.590_950_306_551_3,
        13_731.693_765_509_46,
        45_921.953_931_549_87,
        67_265.770_927_008_7,
        33_430.575_583_588_13,
        2_509.080_928_730_122_7,
    ],
    [
        1.0,
        42.313_330_701_600_91,
        687.187_007_492_057_9,
        5_394.196_021_424_751,
        21_213.794_301_586_597,
        39_307.895_800_092_71,
        28_729.085_735_721_943,
        5_226.495_278_852_854,
    ],
];
/// Coefficients of numerator and denominator for probabilities down to `exp(-25)`.
const TAIL: [[f64; 8]; 2] = [
    [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        0.241_780_725_177_450_6,
        0.022_723_844_989_269_184,
        7.745_450_142_783_414e-4,
    ],
    [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        0.689_767_334_985_1,
        0.148_103_976_427_480_08,
        0.015_198_666_563_616_457,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ],
];
/// Coefficients of numerator and denominator for probabilities below `exp(-25)`.
const FAR: [[f64; 8]; 2] = [
    [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        0.296_560_571_828_504_87,
        0.026_532_189_526_576_124,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ],
    [
        1.0,
        0.599_832_206_555_888,
        0.136_929_880_922_735_8,
        0.014_875_361_290_850_615,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_8e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ],
];
