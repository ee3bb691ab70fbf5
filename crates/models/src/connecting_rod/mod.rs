//! Model `connecting-rod`: forces, crank torque, section, buckling and mass of a connecting rod.

mod answers;
mod mechanics;
mod search;
mod section;

use std::f64::consts::PI;

use super::{Block, Model, ModelInput, ModelOutput, Validity};
use answers::answer;
use sensitol::assembly::Responses;

/// Indices of the inputs, in the order of `CONNECTING_ROD.inputs`.
mod input {
    pub const R: usize = 0;
    pub const L: usize = 1;
    pub const MC: usize = 2;
    pub(crate) const M_ROD: usize = 3;
    pub(crate) const M_P: usize = 4;
    pub(crate) const I_G: usize = 5;
    pub const D: usize = 6;
    pub(crate) const P3: usize = 7;
    pub(crate) const THS: usize = 8;
    pub const T: usize = 9;
    pub(crate) const K1: usize = 10;
    pub(crate) const K2: usize = 11;
    pub const H: usize = 12;
    pub(crate) const RHO: usize = 13;
    pub const E: usize = 14;
    pub(crate) const S_Y: usize = 15;
    pub(crate) const M_S: usize = 16;
    pub(crate) const I_S: usize = 17;
    pub(crate) const I_B: usize = 18;
    pub(crate) const R_IS: usize = 19;
    pub(crate) const T_S: usize = 20;
    pub(crate) const R_IB: usize = 21;
    pub(crate) const T_B: usize = 22;
    pub(crate) const MC_F: usize = 23;
    pub(crate) const MC_T: usize = 24;
    pub(crate) const THETA: usize = 25;
    pub(crate) const SPEED: usize = 26;
    pub(crate) const CUT: usize = 27;
}
/// Number of inputs.
const INPUTS: usize = 28;

/// Models a connecting rod as three lumped masses. Outputs are the forces at its ends over the crank angle with their largest values, the
/// height of the section that carries them, buckling, and the mass of the shank.
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
/// `H_req_3000` is the least height whose stress at the root of the shank is S_y/5 at every angle: |Fa|/A + |M| (k3 + 2) t/(2 Izz), with
/// the shank cut off the eyes. `H_req` is the same at the speed and the section of the inputs. The search ends at k3 = -2, where H = 0. For
/// k3 < 0 the flanges overlap, and the formulas count the overlap twice: a height below 2 t is a number without a section. H_margin is
/// therefore taken against the larger of H_req_3000 and 2 t.
///
/// Euler's safety is pi^2 E Izz/(L^2 F_comp) in the plane of motion and 4 pi^2 E Iyy/(L^2 F_comp) across it. `H_buckling_zz` and
/// `H_buckling_yy` are the heights with a safety of 5 under the largest compression of the big end. The pressure is that of [`gas`].
///
/// Maxima of outputs at 3000 rpm are over -60 to 180 degrees with gas, and over 0 to 180 of the rod alone. Those at the input `speed` are
/// over both turns. They are found to rounding, and are smooth in the inputs as long as one lobe is the largest. `Fn_opt` is the larger of
/// two nearly equal lobes, and has a kink at their equality.
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
            about: "centre of mass of Fn_opt and Fa_opt; MC - 105 mm is added",
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
        ModelInput {
            name: "speed",
            unit: "rpm",
            nominal: 3000.0,
            about: "speed for the outputs without one in their name",
        },
        ModelInput {
            name: "cut",
            unit: "-",
            nominal: 0.0,
            about: "section of H_req and H_theta: 0 at the root of the shank, 1 at the big end",
        },
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
            about: "height above that, or above 2 t",
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
            about: "normal force at theta, to which piston and gas add nothing",
            depends_on: &[0, 1, 2, 3, 5, 25, 26],
        },
        ModelOutput {
            name: "T_crank",
            unit: "N.m",
            about: "torque that the rod exerts on the crank at theta",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 25, 26],
        },
        ModelOutput {
            name: "H_req",
            unit: "mm",
            about: "least height of the section at this speed; below 2 t flanges overlap",
            depends_on: &[0, 1, 4, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 18, 19, 20, 21, 22, 26, 27],
        },
        ModelOutput {
            name: "theta_H",
            unit: "deg",
            about: "crank angle at which H_req is required",
            depends_on: &[0, 1, 4, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 18, 19, 20, 21, 22, 26, 27],
        },
        ModelOutput {
            name: "m_shank_req",
            unit: "g",
            about: "mass of the shank of height H_req",
            depends_on: &[0, 1, 4, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 18, 19, 20, 21, 22, 26, 27],
        },
        ModelOutput {
            name: "H_theta",
            unit: "mm",
            about: "least height of the section at theta",
            depends_on: &[0, 1, 4, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 18, 19, 20, 21, 22, 25, 26, 27],
        },
        ModelOutput {
            name: "H_buckling_zz",
            unit: "mm",
            about: "height with a safety of 5 against buckling in the plane of motion",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 14, 26],
        },
        ModelOutput {
            name: "H_buckling_yy",
            unit: "mm",
            about: "the same across it; below 0 the flanges alone are safe",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 14, 26],
        },
        ModelOutput {
            name: "F_axial_big",
            unit: "N",
            about: "axial force of the big end at theta, tension positive",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 25, 26],
        },
        ModelOutput {
            name: "theta_big_tension",
            unit: "deg",
            about: "crank angle after the gas exchange dead centre at which the big end's tension ends",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 26],
        },
        ModelOutput {
            name: "F_comp",
            unit: "N",
            about: "largest compression at this speed",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 26],
        },
        ModelOutput {
            name: "theta_F",
            unit: "deg",
            about: "crank angle of F_comp",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 26],
        },
        ModelOutput {
            name: "F_tens",
            unit: "N",
            about: "pull of the piston at the gas exchange dead centre",
            depends_on: &[0, 1, 4, 6, 26],
        },
        ModelOutput {
            name: "F_comp_big",
            unit: "N",
            about: "largest compression of the big end",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 26],
        },
        ModelOutput {
            name: "F_tens_big",
            unit: "N",
            about: "tension of the big end at the gas exchange dead centre",
            depends_on: &[0, 1, 2, 3, 4, 6, 26],
        },
        ModelOutput {
            name: "F_comp_inertia",
            unit: "N",
            about: "largest compression without gas",
            depends_on: &[0, 1, 2, 3, 4, 5, 26],
        },
        ModelOutput {
            name: "F_comp_rod",
            unit: "N",
            about: "largest compression of the rod alone",
            depends_on: &[0, 1, 2, 3, 5, 26],
        },
        ModelOutput {
            name: "Fa_opt",
            unit: "N",
            about: "largest axial force of the rod alone in either direction, 3000 rpm, mass centre at mc_F: a kink",
            depends_on: &[0, 1, 2, 3, 5, 23],
        },
    ],
    evaluate,
    bounds: &[
        Validity { output: output::H_REQ_3000, beyond: overlaps, reason: OVERLAP },
        Validity { output: output::H_REQ, beyond: overlaps, reason: OVERLAP },
        Validity { output: output::H_THETA, beyond: overlaps, reason: OVERLAP },
    ],
};

const OVERLAP: &str =
    "a height below 2 t, where the flanges of the I section overlap and the formulas count the overlap twice";

/// True if a required height is less than that of both flanges. A height of 0 needs no section.
fn overlaps(block: &Block<'_>, row: usize, height: f64) -> bool {
    height > 0.0 && height < 2.0 * block.input(input::T)[row]
}

/// Indices of the outputs.
mod output {
    pub(crate) const F_TENS_6000: usize = 0;
    pub(crate) const F_COMP_3000: usize = 1;
    pub(crate) const T_PEAK: usize = 2;
    pub(crate) const FN_ROD: usize = 3;
    pub(crate) const T_ROD: usize = 4;
    pub(crate) const H_REQ_3000: usize = 5;
    pub(crate) const H_MARGIN: usize = 6;
    pub(crate) const N_ZZ: usize = 7;
    pub(crate) const N_YY: usize = 8;
    pub(crate) const M_SHANK: usize = 9;
    pub(crate) const T_OPT: usize = 10;
    pub(crate) const FN_OPT: usize = 11;
    pub(crate) const FN_OPT_A: usize = 12;
    pub(crate) const FN_OPT_B: usize = 13;
    pub(crate) const THETA_F_COMP: usize = 14;
    pub(crate) const THETA_H_REQ: usize = 15;
    pub(crate) const F_AXIAL: usize = 16;
    pub(crate) const F_NORMAL: usize = 17;
    pub(crate) const T_CRANK: usize = 18;
    pub(crate) const H_REQ: usize = 19;
    pub(crate) const THETA_H: usize = 20;
    pub(crate) const M_SHANK_REQ: usize = 21;
    pub(crate) const H_THETA: usize = 22;
    pub(crate) const H_BUCKLING_ZZ: usize = 23;
    pub(crate) const H_BUCKLING_YY: usize = 24;
    pub(crate) const THETA_BIG_TENSION: usize = 26;
    pub(crate) const F_COMP: usize = 27;
    pub(crate) const THETA_F: usize = 28;
    pub(crate) const F_TENS: usize = 29;
    pub(crate) const F_COMP_BIG: usize = 30;
    pub(crate) const F_TENS_BIG: usize = 31;
    pub(crate) const F_COMP_INERTIA: usize = 32;
    pub(crate) const F_COMP_ROD: usize = 33;
    pub(crate) const FA_OPT: usize = 34;
}

/// One degree in radians.
const DEGREE: f64 = PI / 180.0;
/// Number of rows in a pass, so that their inputs and maxima stay in the nearest cache.
const LANES: usize = 128;

/// The inputs of some rows in SI units, a column each.
struct Rows {
    x: [[f64; LANES]; INPUTS],
    count: usize,
}

impl Rows {
    #[inline(always)]
    fn row(&self, row: usize) -> Row<'_> {
        Row { rows: self, row }
    }
}

/// Inputs of one row.
#[derive(Clone, Copy)]
struct Row<'r> {
    rows: &'r Rows,
    row: usize,
}

impl Row<'_> {
    /// A method, since closures are not inlined where code is optimised for size: every angle takes some twenty inputs.
    #[inline(always)]
    fn of(self, input: usize) -> f64 {
        self.rows.x[input][self.row]
    }
}

/// Factors of the inputs' units to SI. Degrees and rpm stay.
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
    si[input::CUT] = 1.0;
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
