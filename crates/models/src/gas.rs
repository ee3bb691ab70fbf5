//! Gas pressure in a cylinder over the crank angle. Neither engine paper gives numbers for it.
//!
//! The trace is our own. Compression and expansion follow powers of the volume, joined by a Wiebe function (Wiebe 1970, exponent 2, factor
//! 5 in the burnt fraction, 55 degrees long). Blow-down to the pressure of the exhaust and suction complete it:
//!
//! ```text
//! v = 1 + (10.5 - 1)/2 (R + 1 - cos th - sqrt(R^2 - sin^2 th))                      volume by the least one, R = rod/crank
//! p = (1 - B) 1e5 (10.5/v)^1.32 + B p3 v^-1.28,  B = 1 - exp(-5 u^3),  u = max(0, (th - ths)/55)     -180 .. 180
//! p = 1.05e5 + (p3 10.5^-1.28 - 1.05e5) exp(-(th - 180)/20)                          180 .. 360
//! p = 1e5                                                                           -360 .. -180
//! ```
//!
//! with th in degrees from the top dead centre of the firing stroke, pressures in Pa.

use super::jet::Real;
use sensitol_numeric::elementary::{Cos, Elementary, Exp, Ln, Sin};

/// Pressure around the engine, Pa.
pub(super) const ATMOSPHERE: f64 = 1.01325e5;
/// Pressure at the end of suction, Pa.
pub(super) const SUCTION: f64 = 1e5;
/// Pressure at the end of the exhaust, Pa.
const EXHAUST: f64 = 1.05e5;
/// Compression ratio: largest volume by least volume.
const COMPRESSION: f64 = 10.5;
/// Exponents of the volume for compression and expansion.
const POWERS: [f64; 2] = [1.32, 1.28];
/// Duration of the combustion, degrees.
const BURNING: f64 = 55.0;
/// Crank angle in which the pressure falls by e during blow-down, degrees.
const BLOW_DOWN: f64 = 20.0;

/// Pressure at an angle from -360 to 360 degrees, Pa.
pub(super) fn pressure(degrees: f64, p3: f64, start: f64, rod_by_crank: f64) -> f64 {
    if degrees < -180.0 {
        return SUCTION;
    }
    if degrees > 180.0 {
        let [own, by_p3] = exhaust(degrees);
        return own + by_p3 * p3;
    }
    let theta = degrees * std::f64::consts::PI / 180.0;
    working(strokes(Sin::of(theta), Cos::of(theta), rod_by_crank), Exp::of(unburnt_log(degrees, start)), p3)
}

/// Pressure by the volume: of the unburnt charge in Pa, and of the burnt charge as a factor of p3.
#[inline]
pub(super) fn strokes<T: Real>(sin: T, cos: T, rod_by_crank: f64) -> [T; 2] {
    let root = (-(sin * sin) + rod_by_crank * rod_by_crank).sqrt();
    let volume = (-cos - root + (rod_by_crank + 1.0)) * (0.5 * (COMPRESSION - 1.0)) + 1.0;
    let log = volume.ln();
    let [compression, expansion] = POWERS;
    [(log * -compression + compression * Ln::of(COMPRESSION)).exp() * SUCTION, (log * -expansion).exp()]
}

/// Logarithm of the unburnt fraction; 0 before the ignition at `start`, degrees.
#[inline(always)]
pub(super) fn unburnt_log<T: Real>(degrees: T, start: f64) -> T {
    let u = (degrees + -start) * (1.0 / BURNING);
    // The function is three times differentiable at the start, since the product with 0 also has derivatives of 0.
    if u.value() > 0.0 { u * u * u * -5.0 } else { u * 0.0 }
}

/// Pressure between -180 and 180 degrees, Pa.
#[inline]
pub(super) fn working<T: Real>([fresh, burnt]: [T; 2], unburnt: T, p3: f64) -> T {
    unburnt * fresh + (-unburnt + 1.0) * burnt * p3
}

/// Pressure between 180 and 360 degrees, Pa.
#[inline]
pub(super) fn blow_down<T: Real>(degrees: T, p3: f64) -> T {
    let left = ((degrees + -180.0) * (-1.0 / BLOW_DOWN)).exp();
    left * (p3 * Exp::of(-POWERS[1] * Ln::of(COMPRESSION)) - EXHAUST) + EXHAUST
}

/// Pressure between 180 and 360 degrees as a linear function of p3: constant in Pa, and factor of p3.
pub(super) fn exhaust(degrees: f64) -> [f64; 2] {
    let left = Exp::of(-(degrees - 180.0) / BLOW_DOWN);
    [EXHAUST * (1.0 - left), left * Exp::of(-POWERS[1] * Ln::of(COMPRESSION))]
}
