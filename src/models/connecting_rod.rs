//! `connecting-rod`: forces, crank torque, section, buckling and mass of a connecting rod.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::gas;
use super::jet::{Jet, Peak, Real, climb};
use super::{Block, Model, ModelInput, ModelOutput};
use crate::assembly::{EvaluationError, Responses};
use crate::elementary::{Cos, Elementary, Exp, Sin, Work, on_this_processor};

/// The inputs' places, in the order of `CONNECTING_ROD.inputs`.
mod input {
    pub const R: usize = 0;
    pub const L: usize = 1;
    pub const MC: usize = 2;
    pub const M_ROD: usize = 3;
    pub const M_P: usize = 4;
    pub const I_G: usize = 5;
    pub const D: usize = 6;
    pub const P3: usize = 7;
    pub const THS: usize = 8;
    pub const T: usize = 9;
    pub const K1: usize = 10;
    pub const K2: usize = 11;
    pub const H: usize = 12;
    pub const RHO: usize = 13;
    pub const E: usize = 14;
    pub const S_Y: usize = 15;
    pub const M_S: usize = 16;
    pub const I_S: usize = 17;
    pub const I_B: usize = 18;
    pub const R_IS: usize = 19;
    pub const T_S: usize = 20;
    pub const R_IB: usize = 21;
    pub const T_B: usize = 22;
    pub const MC_F: usize = 23;
    pub const MC_T: usize = 24;
    pub const THETA: usize = 25;
    pub const SPEED: usize = 26;
}
const INPUTS: usize = 27;

/// A connecting rod as three lumped masses: forces at its ends over the crank angle, their largest values, the height of the
/// section that carries them, buckling, and the mass of the shank.
///
/// With th from the firing top dead centre, s = r sin th/L, sin a = s, cos a = -sqrt(1 - s^2) and w the speed:
///
/// ```text
/// a'  = r w cos th/(L cos a),  a'' = (L a'^2 sin a - r w^2 sin th)/(L cos a)
/// x'' = -r w^2 cos th + L a'' sin a + L a'^2 cos a
/// Agx = -MC (a'^2 cos a + a'' sin a) + x'',  Agy = -MC a'^2 sin a + MC a'' cos a
/// Fx  = -(p - patm) pi D^2/4 - Mp x''
/// Fe  = [ -Ig a'' - m Agx (L - MC) sin a + m Agy (L - MC) cos a + Fx L sin a ]/(L cos a)
/// Faxial = -Fe sin a - Fx cos a (tension +),  Fnormal = Fe cos a - Fx sin a
/// T_Crank = -Fe (r cos th - L cos a) + m Agy (r cos th - (L - MC) cos a) - m Agx MC sin a + Ig a''
/// Ig' = Ig (MC'^3 + (L - MC')^3)/(MC^3 + (L - MC)^3)                                    where the mass centre moves
/// A = (2 k1 + k2 k3) t^2,  Izz = t^4 [k1/6 + k2 k3^3/12 + k1 (k3 + 1)^2/2],  Iyy = t^4 [2 k1^3 + k3 k2^3]/12,  H = (k3 + 2) t
/// ```
///
/// `H_req_3000` is the least height whose stress at the root of the shank is S_y/5 at every angle:
/// |Fa|/A + |M| (k3 + 2) t/(2 Izz), with the shank cut off the eyes. Euler's safety is pi^2 E Izz/(L^2 F_comp) in the plane of
/// motion and 4 pi^2 E Iyy/(L^2 F_comp) across it. [`gas`] has the pressure.
///
/// Maxima are over -60 to 180 degrees with gas, over 0 to 180 of the rod alone, found to rounding: smooth in the inputs as long as
/// one lobe is the largest. `Fn_opt` is the larger of two lobes that are nearly alike, and has a kink where they are.
pub static CONNECTING_ROD: Model = Model {
    name: "connecting-rod",
    title: "forces, crank torque, section height, buckling and mass of a connecting rod",
    source: "Shojaefard, Saeidi Googarchin and Hossein Oghli, lumped-mass method, eqs 1-34; gas trace ours, tolerances assumed",
    inputs: &[
        ModelInput { name: "r", unit: "mm", nominal: 41.0, about: "crank radius" },
        ModelInput { name: "L", unit: "mm", nominal: 133.6, about: "distance of the eyes" },
        ModelInput { name: "MC", unit: "mm", nominal: 105.0, about: "centre of mass from the small end" },
        ModelInput { name: "M_rod", unit: "g", nominal: 529.0, about: "mass of the rod" },
        ModelInput { name: "M_p", unit: "g", nominal: 410.0, about: "mass of the piston group" },
        ModelInput {
            name: "I_g",
            unit: "kg.mm^2",
            nominal: 1340.0,
            about: "inertia of the rod about its centre of mass",
        },
        ModelInput { name: "D", unit: "mm", nominal: 78.5, about: "bore" },
        ModelInput { name: "p3", unit: "bar", nominal: 95.5, about: "pressure after combustion at the least volume" },
        ModelInput { name: "ths", unit: "deg", nominal: -15.0, about: "crank angle of ignition" },
        ModelInput { name: "t", unit: "mm", nominal: 3.0, about: "thickness of the flanges" },
        ModelInput { name: "k1", unit: "-", nominal: 4.0, about: "width of the flanges by t" },
        ModelInput { name: "k2", unit: "-", nominal: 1.1, about: "thickness of the web by t" },
        ModelInput { name: "H", unit: "mm", nominal: 32.0, about: "height of the section" },
        ModelInput { name: "rho", unit: "kg/m^3", nominal: 7800.0, about: "density" },
        ModelInput { name: "E", unit: "GPa", nominal: 207.0, about: "modulus of elasticity" },
        ModelInput { name: "S_y", unit: "MPa", nominal: 700.0, about: "yield strength" },
        ModelInput { name: "M_s", unit: "g", nominal: 45.0, about: "mass of the small end" },
        ModelInput { name: "I_s", unit: "kg.mm^2", nominal: 15.022, about: "inertia of the small end" },
        ModelInput { name: "I_b", unit: "kg.mm^2", nominal: 376.55, about: "inertia of the big end" },
        ModelInput { name: "r_is", unit: "mm", nominal: 9.73, about: "inner radius of the small end" },
        ModelInput { name: "t_s", unit: "mm", nominal: 5.56, about: "wall of the small end" },
        ModelInput { name: "r_ib", unit: "mm", nominal: 22.83, about: "inner radius of the big end" },
        ModelInput { name: "t_b", unit: "mm", nominal: 7.6, about: "wall of the big end" },
        ModelInput {
            name: "mc_F",
            unit: "mm",
            nominal: 108.0,
            about: "centre of mass of Fn_opt; MC - 105 mm is added",
        },
        ModelInput {
            name: "mc_T",
            unit: "mm",
            nominal: 119.7,
            about: "centre of mass of T_opt_tied; MC - 105 mm is added",
        },
        ModelInput {
            name: "theta",
            unit: "deg",
            nominal: 20.0,
            about: "crank angle, -360 to 360, for F_axial, F_normal, T_crank",
        },
        ModelInput { name: "speed", unit: "rpm", nominal: 3000.0, about: "speed for F_axial, F_normal, T_crank" },
    ],
    outputs: &[
        ModelOutput {
            name: "F_tens_6000",
            unit: "N",
            about: "pull of the piston at the gas exchange dead centre, 6000 rpm",
            depends_on: &[0, 1, 4, 6],
        },
        ModelOutput {
            name: "F_comp_3000",
            unit: "N",
            about: "largest compression, 3000 rpm",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        },
        ModelOutput {
            name: "T_peak_3000",
            unit: "N.m",
            about: "largest crank torque, 3000 rpm",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        },
        ModelOutput {
            name: "Fn_rod_3000",
            unit: "N",
            about: "largest normal force of the rod alone, 3000 rpm",
            depends_on: &[0, 1, 2, 3, 5],
        },
        ModelOutput {
            name: "T_rod_3000",
            unit: "N.m",
            about: "largest crank torque of the rod alone, 3000 rpm",
            depends_on: &[0, 1, 2, 3, 5],
        },
        ModelOutput {
            name: "H_req_3000",
            unit: "mm",
            about: "least height of the section, 3000 rpm",
            depends_on: &[0, 1, 4, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 18, 19, 20, 21, 22],
        },
        ModelOutput {
            name: "H_margin",
            unit: "mm",
            about: "height above that",
            depends_on: &[0, 1, 4, 6, 7, 8, 9, 10, 11, 12, 13, 15, 16, 17, 18, 19, 20, 21, 22],
        },
        ModelOutput {
            name: "n_zz",
            unit: "-",
            about: "safety against buckling in the plane of motion",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14],
        },
        ModelOutput {
            name: "n_yy",
            unit: "-",
            about: "safety against buckling across it",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14],
        },
        ModelOutput {
            name: "m_shank",
            unit: "g",
            about: "mass of the shank",
            depends_on: &[1, 9, 10, 11, 12, 13, 19, 20, 21, 22],
        },
        ModelOutput {
            name: "T_opt_tied",
            unit: "N.m",
            about: "largest braking torque of the rod alone, mass centre at mc_T",
            depends_on: &[0, 1, 2, 3, 5, 24],
        },
        ModelOutput {
            name: "Fn_opt",
            unit: "N",
            about: "largest normal force of the rod alone in either direction, mass centre at mc_F: a kink",
            depends_on: &[0, 1, 2, 3, 5, 23],
        },
        ModelOutput {
            name: "Fn_opt_lobeA",
            unit: "N",
            about: "the one of its lobes near 37 degrees",
            depends_on: &[0, 1, 2, 3, 5, 23],
        },
        ModelOutput {
            name: "Fn_opt_lobeB",
            unit: "N",
            about: "the one near 118 degrees",
            depends_on: &[0, 1, 2, 3, 5, 23],
        },
        ModelOutput {
            name: "theta_F_comp",
            unit: "deg",
            about: "crank angle of the largest compression",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        },
        ModelOutput {
            name: "theta_H_req",
            unit: "deg",
            about: "crank angle at which H_req_3000 is required",
            depends_on: &[0, 1, 4, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 18, 19, 20, 21, 22],
        },
        ModelOutput {
            name: "F_axial",
            unit: "N",
            about: "axial force at theta, tension positive",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 25, 26],
        },
        ModelOutput {
            name: "F_normal",
            unit: "N",
            about: "normal force at theta",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 25, 26],
        },
        ModelOutput {
            name: "T_crank",
            unit: "N.m",
            about: "torque that the rod exerts on the crank at theta",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 25, 26],
        },
    ],
    evaluate,
};

/// The outputs' places.
mod output {
    pub const F_TENS: usize = 0;
    pub const F_COMP: usize = 1;
    pub const T_PEAK: usize = 2;
    pub const FN_ROD: usize = 3;
    pub const T_ROD: usize = 4;
    pub const H_REQ: usize = 5;
    pub const H_MARGIN: usize = 6;
    pub const N_ZZ: usize = 7;
    pub const N_YY: usize = 8;
    pub const M_SHANK: usize = 9;
    pub const T_OPT: usize = 10;
    pub const FN_OPT: usize = 11;
    pub const FN_OPT_A: usize = 12;
    pub const FN_OPT_B: usize = 13;
    pub const THETA_F: usize = 14;
    pub const THETA_H: usize = 15;
    pub const AT_THETA: [usize; 3] = [16, 17, 18];
}

/// The rod by the crank of the gas trace, which tolerances do not change.
const ROD_BY_CRANK: f64 = 133.6 / 41.0;
/// The mass centre, and the distance of the eyes, that the optima are told from: m.
const REFERENCE: [f64; 2] = [0.105, 0.1336];
/// Safety against yield.
const SAFETY: f64 = 5.0;
const DEGREE: f64 = PI / 180.0;
/// Degrees between the angles at which a maximum is first looked for: a fifth of the narrowest lobe at most.
const STEP: f64 = 5.0;
/// Rows whose inputs and maxima stay in the nearest cache.
const LANES: usize = 128;

fn circular(rpm: f64) -> f64 {
    rpm * PI / 30.0
}

/// The inputs of some rows in SI units, a column each.
struct Rows {
    x: [[f64; LANES]; INPUTS],
    count: usize,
}

/// What the inputs' units are in SI; degrees and rpm stay.
const SI: [f64; INPUTS] = {
    let mut si = [1e-3; INPUTS];
    si[input::I_G] = 1e-6;
    si[input::I_S] = 1e-6;
    si[input::I_B] = 1e-6;
    si[input::P3] = 1e5;
    si[input::THS] = 1.0;
    si[input::K1] = 1.0;
    si[input::K2] = 1.0;
    si[input::RHO] = 1.0;
    si[input::E] = 1e9;
    si[input::S_Y] = 1e6;
    si[input::THETA] = 1.0;
    si[input::SPEED] = 1.0;
    si
};

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    let asked: Vec<(usize, usize)> =
        (0..CONNECTING_ROD.outputs.len()).filter_map(|output| Some((output, block.column(output)?))).collect();
    let mut needed: Vec<usize> =
        asked.iter().flat_map(|&(output, _)| CONNECTING_ROD.outputs[output].depends_on).copied().collect();
    needed.sort_unstable();
    needed.dedup();
    let mut rows = Rows { x: [[0.0; LANES]; INPUTS], count: 0 };
    for first in (0..block.rows()).step_by(LANES) {
        rows.count = LANES.min(block.rows() - first);
        for &at in &needed {
            let given = &block.input(at)[first..first + rows.count];
            rows.x[at].iter_mut().zip(given).for_each(|(x, given)| *x = given * SI[at]);
        }
        answer(&rows, first, &asked, out);
    }
}

fn answer(rows: &Rows, first: usize, asked: &[(usize, usize)], out: &mut Responses) {
    let is_asked = |any: &[usize]| asked.iter().any(|(output, _)| any.contains(output));
    let count = rows.count;
    let none = || [Peak { at: f64::NAN, value: f64::NAN }; LANES];
    let found = |wanted: bool, search: &dyn Fn() -> [Peak; LANES]| if wanted { search() } else { none() };
    let fired = circular(3000.0);
    let with_gas = |effect| move || maxima(&Loaded { rows, w: fired, effect }, rows, &GAS_ANGLES, true);
    let compression =
        found(is_asked(&[output::F_COMP, output::THETA_F, output::N_ZZ, output::N_YY]), &with_gas(Effect::Compression));
    let torque = found(is_asked(&[output::T_PEAK]), &with_gas(Effect::Torque));
    let alone = |centre, effect| move || maxima(&Alone { rows, w: fired, centre, effect }, rows, &ROD_ANGLES, false);
    let normal = found(is_asked(&[output::FN_ROD]), &alone(Centre::Given, Effect::Normal));
    let braking = found(is_asked(&[output::T_ROD]), &alone(Centre::Given, Effect::Braking));
    let tied = found(is_asked(&[output::T_OPT]), &alone(Centre::Tied, Effect::Torque));
    let lobe_a = found(is_asked(&[output::FN_OPT, output::FN_OPT_A]), &alone(Centre::Optimum, Effect::Normal));
    let lobe_b = found(is_asked(&[output::FN_OPT, output::FN_OPT_B]), &alone(Centre::Optimum, Effect::AgainstNormal));
    let height = found(is_asked(&[output::H_REQ, output::H_MARGIN, output::THETA_H]), &|| heights(rows, fired));

    for &(output, column) in asked {
        let mut values = [f64::NAN; LANES];
        for (row, value) in values[..count].iter_mut().enumerate() {
            let x = |at: usize| rows.x[at][row];
            *value = match output {
                output::F_TENS => {
                    let (w, area) = (circular(6000.0), 0.25 * PI * x(input::D) * x(input::D));
                    x(input::M_P) * w * w * x(input::R) * (1.0 + x(input::R) / x(input::L))
                        + (gas::ATMOSPHERE - gas::SUCTION) * area
                }
                output::F_COMP => compression[row].value,
                output::T_PEAK => torque[row].value,
                output::FN_ROD => normal[row].value,
                output::T_ROD => braking[row].value,
                output::H_REQ => 1e3 * height[row].value,
                output::H_MARGIN => 1e3 * (x(input::H) - height[row].value),
                output::N_ZZ | output::N_YY => {
                    let (section, l) = (Section::of(rows, row), x(input::L));
                    let web = section.web(x(input::H));
                    let inertia = if output == output::N_ZZ { section.across(web) } else { 4.0 * section.along(web) };
                    PI * PI * x(input::E) * inertia / (l * l * compression[row].value)
                }
                output::M_SHANK => {
                    let section = Section::of(rows, row);
                    1e3 * x(input::RHO) * section.area(section.web(x(input::H))) * shank(rows, row)
                }
                output::T_OPT => tied[row].value,
                output::FN_OPT => lobe_a[row].value.max(lobe_b[row].value),
                output::FN_OPT_A => lobe_a[row].value,
                output::FN_OPT_B => lobe_b[row].value,
                output::THETA_F => compression[row].at / DEGREE,
                output::THETA_H => height[row].at / DEGREE,
                _ => {
                    let effects = [Effect::Compression, Effect::Normal, Effect::Torque];
                    let signs = [-1.0, 1.0, 1.0];
                    let which = output - output::AT_THETA[0];
                    let (degrees, w) = (x(input::THETA), circular(x(input::SPEED)));
                    if (-360.0..=360.0).contains(&degrees) {
                        let pressure = pressure(degrees, x(input::P3), x(input::THS));
                        let angle = Angle::of(degrees * DEGREE, pressure);
                        signs[which] * Loaded { rows, w, effect: effects[which] }.at(row, &angle)
                    } else {
                        out.fail(first + row, column, EvaluationError::Refused { message: BEYOND.into() });
                        continue;
                    }
                }
            };
        }
        for (row, &value) in values[..count].iter().enumerate() {
            let refused = matches!(output, output::H_REQ | output::H_MARGIN | output::THETA_H) && value.is_nan();
            if refused {
                out.fail(first + row, column, EvaluationError::Refused { message: NO_HEIGHT.into() });
            } else if out.error(first + row, column).is_none() {
                out.set(first + row, column, value);
            }
        }
    }
}

const BEYOND: &str = "the crank angle theta lies beyond -360 .. 360 degrees";
const NO_HEIGHT: &str = "no height of the section brings the stress to a fifth of the yield strength";

/// The pressure at any angle, Pa.
fn pressure(degrees: f64, p3: f64, start: f64) -> f64 {
    if degrees < -180.0 {
        return gas::SUCTION;
    }
    if degrees > 180.0 {
        let [own, by_p3] = gas::exhaust(degrees);
        return own + by_p3 * p3;
    }
    let theta = degrees * DEGREE;
    let strokes = gas::strokes(Sin::of(theta), Cos::of(theta), ROD_BY_CRANK);
    gas::working(strokes, Exp::of(gas::unburnt_log(degrees, start)), p3)
}

/// A crank angle with the gas pressure there.
struct Angle<T> {
    sin: T,
    cos: T,
    pressure: T,
}

impl Angle<f64> {
    fn of(theta: f64, pressure: f64) -> Self {
        Self { sin: Sin::of(theta), cos: Cos::of(theta), pressure }
    }
}

impl Angle<Jet> {
    /// With derivatives by the angle; of the pressure too where gas matters.
    fn around(theta: f64, gas: Option<(f64, f64)>) -> Self {
        let (s, c) = (Sin::of(theta), Cos::of(theta));
        let (sin, cos) = (Jet([s, c, -s]), Jet([c, -s, -c]));
        let pressure = gas.map_or(Jet([0.0; 3]), |(p3, start)| {
            let unburnt = gas::unburnt_log(Jet([theta / DEGREE, 1.0 / DEGREE, 0.0]), start).exp();
            gas::working(gas::strokes(sin, cos, ROD_BY_CRANK), unburnt, p3)
        });
        Self { sin, cos, pressure }
    }
}

/// How the rod moves.
struct Motion<T> {
    sin_a: T,
    cos_a: T,
    /// Square of the rate of the rod's angle, and its acceleration.
    rate: T,
    turn: T,
    /// Acceleration of the piston.
    piston: T,
}

impl<T: Real> Motion<T> {
    #[inline(always)]
    fn of(angle: &Angle<T>, r: f64, l: f64, w: f64) -> Self {
        let sin_a = angle.sin * (r / l);
        let cos_a = -(-(sin_a * sin_a) + 1.0).sqrt();
        let below = cos_a * l;
        let rate = angle.cos * (r * w) / below;
        let rate = rate * rate;
        let turn = (rate * sin_a * l + angle.sin * (-r * w * w)) / below;
        let piston = angle.cos * (-r * w * w) + (turn * sin_a + rate * cos_a) * l;
        Self { sin_a, cos_a, rate, turn, piston }
    }

    /// Acceleration at a distance from the small end, along the cylinder and across it.
    #[inline(always)]
    fn acceleration(&self, at: f64) -> [T; 2] {
        let along = self.piston + (self.rate * self.cos_a + self.turn * self.sin_a) * -at;
        [along, (self.turn * self.cos_a + -(self.rate * self.sin_a)) * at]
    }

    /// The force across the cylinder at the small end, of a body of this mass, centre and inertia, and a force along it.
    #[inline(always)]
    fn side_force(&self, [mass, centre, inertia]: [f64; 3], [ax, ay]: [T; 2], along: T, l: f64) -> T {
        let rest = (ay * self.cos_a - ax * self.sin_a) * (mass * (l - centre));
        (self.turn * -inertia + rest + along * self.sin_a * l) / (self.cos_a * l)
    }
}

/// What is made as large as it gets.
#[derive(Clone, Copy, PartialEq)]
enum Effect {
    Compression,
    Normal,
    AgainstNormal,
    /// That the rod exerts on the crank.
    Torque,
    Braking,
}

/// One effect on a rod with mass, centre of mass and inertia, with a force along the cylinder at its small end.
#[inline(always)]
fn effect<T: Real>(
    effect: Effect,
    angle: &Angle<T>,
    motion: &Motion<T>,
    body: [f64; 3],
    along: T,
    [r, l]: [f64; 2],
) -> T {
    let [mass, centre, inertia] = body;
    let [ax, ay] = motion.acceleration(centre);
    let side = motion.side_force(body, [ax, ay], along, l);
    let (sin_a, cos_a) = (motion.sin_a, motion.cos_a);
    match effect {
        Effect::Compression => side * sin_a + along * cos_a,
        Effect::Normal => side * cos_a - along * sin_a,
        Effect::AgainstNormal => along * sin_a - side * cos_a,
        Effect::Torque | Effect::Braking => {
            let pin = angle.cos * r;
            let external = -(side * (pin - cos_a * l)) + ay * (pin - cos_a * (l - centre)) * mass
                - ax * sin_a * (mass * centre)
                + motion.turn * inertia;
            if effect == Effect::Torque { -external } else { external }
        }
    }
}

/// Something that has a value at every crank angle in every row.
trait Curve {
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T;
}

/// Gas, piston and rod.
struct Loaded<'r> {
    rows: &'r Rows,
    w: f64,
    effect: Effect,
}

impl Curve for Loaded<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        let x = |at: usize| self.rows.x[at][row];
        let motion = Motion::of(angle, x(input::R), x(input::L), self.w);
        let along = gas_force(angle, x(input::D)) + motion.piston * -x(input::M_P);
        let body = [x(input::M_ROD), x(input::MC), x(input::I_G)];
        effect(self.effect, angle, &motion, body, along, [x(input::R), x(input::L)])
    }
}

#[inline(always)]
fn gas_force<T: Real>(angle: &Angle<T>, bore: f64) -> T {
    (angle.pressure + -gas::ATMOSPHERE) * (-0.25 * PI * bore * bore)
}

/// Where the mass centre of the rod is.
#[derive(Clone, Copy)]
enum Centre {
    Given,
    /// At mc_F, the inertia as for the nominal distance of the eyes.
    Optimum,
    /// At mc_T, the inertia as for the mass centre and the distance of the eyes that there are.
    Tied,
}

/// The rod without piston and gas.
struct Alone<'r> {
    rows: &'r Rows,
    w: f64,
    centre: Centre,
    effect: Effect,
}

impl Curve for Alone<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        let x = |at: usize| self.rows.x[at][row];
        let (l, [reference, eyes]) = (x(input::L), REFERENCE);
        let moved = |to: usize| x(to) + (x(input::MC) - reference);
        let cubes = |centre: f64, l: f64| centre * centre * centre + (l - centre) * (l - centre) * (l - centre);
        let (centre, factor) = match self.centre {
            Centre::Given => (x(input::MC), 1.0),
            Centre::Optimum => (moved(input::MC_F), cubes(x(input::MC_F), eyes) / cubes(reference, eyes)),
            Centre::Tied => (moved(input::MC_T), cubes(moved(input::MC_T), l) / cubes(reference, l)),
        };
        let motion = Motion::of(angle, x(input::R), l, self.w);
        let body = [x(input::M_ROD), centre, factor * x(input::I_G)];
        effect(self.effect, angle, &motion, body, angle.sin * 0.0, [x(input::R), l])
    }
}

/// The stress at the root of the shank, for a web of this height.
struct Root<'r> {
    rows: &'r Rows,
    w: f64,
    webs: [f64; LANES],
}

impl Root<'_> {
    /// Axial force and bending moment there.
    #[inline(always)]
    fn load<T: Real>(&self, row: usize, angle: &Angle<T>) -> [T; 2] {
        let x = |at: usize| self.rows.x[at][row];
        let (l, root, length) = (x(input::L), x(input::R_IS) + x(input::T_S), shank(self.rows, row));
        let section = Section::of(self.rows, row);
        let mass = x(input::RHO) * section.area(self.webs[row]) * length;
        let centre = root + 0.5 * length;
        let inertia = mass * length * length / 12.0 + x(input::I_S) + x(input::I_B);
        let motion = Motion::of(angle, x(input::R), l, self.w);
        let along = gas_force(angle, x(input::D)) + motion.piston * -(x(input::M_P) + x(input::M_S));
        let side = motion.side_force([mass, centre, inertia], motion.acceleration(centre), along, l);
        let axial = -(along * motion.cos_a) - side * motion.sin_a;
        let normal = along * motion.sin_a - side * motion.cos_a;
        [axial, normal * -root + motion.turn * x(input::I_S)]
    }
}

impl Curve for Root<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        let (section, web) = (Section::of(self.rows, row), self.webs[row]);
        let [axial, moment] = self.load(row, angle);
        axial.abs() * (1.0 / section.area(web)) + moment.abs() * section.bending(web)
    }
}

/// An I section: thickness and proportions; `k3`, the height of the web by the thickness, is asked for.
struct Section {
    t: f64,
    k1: f64,
    k2: f64,
}

impl Section {
    #[inline(always)]
    fn of(rows: &Rows, row: usize) -> Self {
        Self { t: rows.x[input::T][row], k1: rows.x[input::K1][row], k2: rows.x[input::K2][row] }
    }

    #[inline(always)]
    fn web(&self, height: f64) -> f64 {
        height / self.t - 2.0
    }

    #[inline(always)]
    fn area(&self, k3: f64) -> f64 {
        (2.0 * self.k1 + self.k2 * k3) * self.t * self.t
    }

    /// Izz.
    #[inline(always)]
    fn across(&self, k3: f64) -> f64 {
        let (square, k1) = (self.t * self.t, self.k1);
        square * square * (k1 / 6.0 + self.k2 * k3 * k3 * k3 / 12.0 + 0.5 * k1 * (k3 + 1.0) * (k3 + 1.0))
    }

    /// Iyy.
    #[inline(always)]
    fn along(&self, k3: f64) -> f64 {
        let (square, k1, k2) = (self.t * self.t, self.k1, self.k2);
        square * square * (2.0 * k1 * k1 * k1 + k3 * k2 * k2 * k2) / 12.0
    }

    /// Stress of a bending moment of 1.
    #[inline(always)]
    fn bending(&self, k3: f64) -> f64 {
        0.5 * (k3 + 2.0) * self.t / self.across(k3)
    }
}

/// Length of the shank.
#[inline(always)]
fn shank(rows: &Rows, row: usize) -> f64 {
    let x = |at: usize| rows.x[at][row];
    x(input::L) - x(input::R_IS) - x(input::T_S) - x(input::T_B) - x(input::R_IB)
}

/// Angles at which a search begins, with what the volume makes of the pressure there.
struct Grid {
    degrees: Vec<f64>,
    strokes: Vec<[f64; 2]>,
    turns: Vec<[f64; 2]>,
    ends: [f64; 2],
}

impl Grid {
    fn over(from: f64, to: f64) -> Self {
        let steps = ((to - from) / STEP).round() as usize;
        let degrees: Vec<f64> = (0..=steps).map(|step| from + STEP * step as f64).collect();
        let turns: Vec<[f64; 2]> =
            degrees.iter().map(|at| at * DEGREE).map(|theta| [Sin::of(theta), Cos::of(theta)]).collect();
        let strokes = turns.iter().map(|&[sin, cos]| gas::strokes(sin, cos, ROD_BY_CRANK)).collect();
        Self { degrees, strokes, turns, ends: [from * DEGREE, to * DEGREE] }
    }
}

static GAS_ANGLES: LazyLock<Grid> = LazyLock::new(|| Grid::over(-60.0, 180.0));
static ROD_ANGLES: LazyLock<Grid> = LazyLock::new(|| Grid::over(0.0, 180.0));

/// The largest value over the grid in every row, and the angle's place.
struct Scan<'a, C> {
    curve: &'a C,
    rows: &'a Rows,
    grid: &'a Grid,
    gas: bool,
}

impl<C: Curve> Work for Scan<'_, C> {
    type Output = [f64; LANES];

    #[inline(always)]
    fn work(self) -> [f64; LANES] {
        let Self { curve, rows, grid, gas } = self;
        let count = rows.count;
        let (mut best, mut place) = ([f64::NEG_INFINITY; LANES], [0.0; LANES]);
        let (mut exponents, mut unburnt) = ([0.0; LANES], [1.0; LANES]);
        for (index, (&degrees, (&strokes, &[sin, cos]))) in
            grid.degrees.iter().zip(grid.strokes.iter().zip(&grid.turns)).enumerate()
        {
            if gas {
                for (exponent, start) in exponents[..count].iter_mut().zip(&rows.x[input::THS]) {
                    *exponent = gas::unburnt_log(degrees, *start);
                }
                Exp::map_inline(&exponents[..count], &mut unburnt[..count]);
            }
            for row in 0..count {
                let pressure = if gas { gas::working(strokes, unburnt[row], rows.x[input::P3][row]) } else { 0.0 };
                let value = curve.at(row, &Angle { sin, cos, pressure });
                let better = value > best[row];
                best[row] = if better { value } else { best[row] };
                place[row] = if better { index as f64 } else { place[row] };
            }
        }
        place
    }
}

/// The largest value of a curve in every row, and where.
fn maxima<C: Curve>(curve: &C, rows: &Rows, grid: &Grid, gas: bool) -> [Peak; LANES] {
    let places = on_this_processor(Scan { curve, rows, grid, gas });
    let mut peaks = [Peak { at: f64::NAN, value: f64::NAN }; LANES];
    for (row, peak) in peaks[..rows.count].iter_mut().enumerate() {
        *peak = refined(curve, rows, grid, gas, row, grid.degrees[places[row] as usize] * DEGREE);
    }
    peaks
}

/// The maximum near a place of the grid.
fn refined<C: Curve>(curve: &C, rows: &Rows, grid: &Grid, gas: bool, row: usize, from: f64) -> Peak {
    let load = gas.then(|| (rows.x[input::P3][row], rows.x[input::THS][row]));
    let ends = [(from - STEP * DEGREE).max(grid.ends[0]), (from + STEP * DEGREE).min(grid.ends[1])];
    climb(|theta| curve.at(row, &Angle::<Jet>::around(theta, load)), from, ends)
}

/// Heights that Newton's method asks for at most.
const MOST_HEIGHTS: usize = 60;
/// The height of the web by the thickness that the first pass over the grid begins with: the design's.
const FIRST_WEB: f64 = 8.0;
/// Passes over the grid: each but the first sees whether the lobe has stayed the largest.
const PASSES: usize = 6;

/// The least height of the section in every row, and the angle that requires it: the largest stress over the angle is what is
/// allowed.
fn heights(rows: &Rows, w: f64) -> [Peak; LANES] {
    let grid: &Grid = &GAS_ANGLES;
    let mut root = Root { rows, w, webs: [1.0; LANES] };
    let mut found = [Peak { at: f64::NAN, value: f64::NAN }; LANES];
    let mut open: [bool; LANES] = std::array::from_fn(|row| row < rows.count);
    for row in 0..rows.count {
        root.webs[row] = FIRST_WEB;
    }
    for _ in 0..PASSES {
        if !open.contains(&true) {
            break;
        }
        let places = on_this_processor(Scan { curve: &root, rows, grid, gas: true });
        for row in (0..rows.count).filter(|&row| open[row]).collect::<Vec<_>>() {
            let from = grid.degrees[places[row] as usize] * DEGREE;
            if (from - found[row].at).abs() <= STEP * DEGREE {
                open[row] = false;
                continue;
            }
            match required(&mut root, grid, row, from) {
                Some(at) => {
                    let (t, k3) = (rows.x[input::T][row], root.webs[row]);
                    found[row] = Peak { at, value: (k3 + 2.0) * t };
                }
                None => {
                    found[row] = Peak { at: f64::NAN, value: f64::NAN };
                    (open[row], root.webs[row]) = (false, 1.0);
                }
            }
        }
    }
    found
}

/// Brings the largest stress of a lobe to what is allowed by the height of the web, and tells the angle.
fn required(root: &mut Root<'_>, grid: &Grid, row: usize, mut from: f64) -> Option<f64> {
    let rows = root.rows;
    let allowed = rows.x[input::S_Y][row] / SAFETY;
    for _ in 0..MOST_HEIGHTS {
        let k3 = root.webs[row];
        let peak = refined(root, rows, grid, true, row, from);
        from = peak.at;
        // The stress by the web's height at that angle: the angle's own change does not matter at a maximum.
        let h = 1e-6 * k3;
        let pressure = pressure(peak.at / DEGREE, rows.x[input::P3][row], rows.x[input::THS][row]);
        let angle = Angle::of(peak.at, pressure);
        let mut stress = |web: f64| {
            root.webs[row] = web;
            root.at(row, &angle)
        };
        let slope = (stress(k3 + h) - stress(k3 - h)) / (2.0 * h);
        let step = (peak.value - allowed) / slope;
        // Never to nothing at once: the stress grows without bound there.
        let next = if step < 0.9 * k3 { k3 - step } else { 0.1 * k3 };
        root.webs[row] = next;
        if !(next > 1e-3 && next < 1e6) {
            return None;
        }
        // The next step would be the square of this one.
        if step.abs() <= 1e-8 * next {
            return Some(from);
        }
    }
    None
}
