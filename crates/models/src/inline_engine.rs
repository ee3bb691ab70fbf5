//! Model `inline-engine-balance`: unbalanced forces and moments of an inline engine of any layout.

use std::f64::consts::PI;

use super::{Block, Model, ModelInput, ModelOutput};
use sensitol::assembly::{EvaluationError, Responses};
use sensitol_numeric::elementary::{Cos, Elementary, Work, on_this_processor};

/// Indices of the inputs, in the order of `INLINE_ENGINE.inputs`.
mod input {
    pub const MP: usize = 0;
    pub const MR: usize = 1;
    pub(crate) const OMEGA: usize = 2;
    pub const R: usize = 3;
    pub const L: usize = 4;
    pub(crate) const HP: usize = 5;
    pub(crate) const HC: usize = 6;
    pub const T: usize = 7;
    pub(crate) const CYLINDERS: usize = 8;
    pub(crate) const PHI: usize = 9;
    pub const Z: usize = 21;
}

/// Greatest number of cylinders.
const MOST: usize = 12;

/// Generalises `engine-balance` to n cylinders, each with its crank angle and its place along the shaft:
///
/// ```text
/// mr = MP + MR hc/(hc + hp)
/// F1 = mr R omega^2 sum_n cos(t + phi_n),  F2 = mr R omega^2 (R/L) sum_n cos 2(t + phi_n),  F = F1 + F2
/// M1, M2 and M likewise, each share by z_n
/// ```
///
/// The nominal layout is that of `engine-balance`. Cylinders beyond n take no part.
pub static INLINE_ENGINE: Model = Model {
    name: "inline-engine-balance",
    title: "unbalanced forces and moments of an inline engine of up to twelve cylinders",
    source: "Sirousi and Ghasabzadeh Saryazdi, Tabriz J. Mech. Eng. 55(1), 2025, eqs 7-8, for n cylinders at places of their own",
    inputs: &[
        ModelInput { name: "MP", unit: "kg", nominal: 0.427, about: "mass of the piston group" },
        ModelInput { name: "MR", unit: "kg", nominal: 0.597, about: "mass of the connecting rod" },
        ModelInput { name: "omega", unit: "rad/s", nominal: 628.3185, about: "speed of the crankshaft" },
        ModelInput { name: "R", unit: "m", nominal: 0.0425, about: "crank radius" },
        ModelInput { name: "L", unit: "m", nominal: 0.1345, about: "length of the connecting rod" },
        ModelInput { name: "hp", unit: "m", nominal: 0.0973, about: "centre of mass of the rod to the piston pin" },
        ModelInput { name: "hc", unit: "m", nominal: 0.0372, about: "centre of mass of the rod to the crank pin" },
        ModelInput { name: "t", unit: "rad", nominal: 0.0, about: "crank angle" },
        ModelInput { name: "n", unit: "-", nominal: 4.0, about: "number of cylinders, 1 to 12: a constant" },
        ModelInput { name: "phi1", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 1 on the shaft" },
        ModelInput { name: "phi2", unit: "rad", nominal: PI, about: "crank angle of cylinder 2 on the shaft" },
        ModelInput { name: "phi3", unit: "rad", nominal: 3.0 * PI, about: "crank angle of cylinder 3 on the shaft" },
        ModelInput { name: "phi4", unit: "rad", nominal: 2.0 * PI, about: "crank angle of cylinder 4 on the shaft" },
        ModelInput { name: "phi5", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 5 on the shaft" },
        ModelInput { name: "phi6", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 6 on the shaft" },
        ModelInput { name: "phi7", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 7 on the shaft" },
        ModelInput { name: "phi8", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 8 on the shaft" },
        ModelInput { name: "phi9", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 9 on the shaft" },
        ModelInput { name: "phi10", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 10 on the shaft" },
        ModelInput { name: "phi11", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 11 on the shaft" },
        ModelInput { name: "phi12", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 12 on the shaft" },
        ModelInput { name: "z1", unit: "m", nominal: 0.00, about: "place of cylinder 1 along the shaft" },
        ModelInput { name: "z2", unit: "m", nominal: 0.05, about: "place of cylinder 2 along the shaft" },
        ModelInput { name: "z3", unit: "m", nominal: 0.10, about: "place of cylinder 3 along the shaft" },
        ModelInput { name: "z4", unit: "m", nominal: 0.15, about: "place of cylinder 4 along the shaft" },
        ModelInput { name: "z5", unit: "m", nominal: 0.20, about: "place of cylinder 5 along the shaft" },
        ModelInput { name: "z6", unit: "m", nominal: 0.25, about: "place of cylinder 6 along the shaft" },
        ModelInput { name: "z7", unit: "m", nominal: 0.30, about: "place of cylinder 7 along the shaft" },
        ModelInput { name: "z8", unit: "m", nominal: 0.35, about: "place of cylinder 8 along the shaft" },
        ModelInput { name: "z9", unit: "m", nominal: 0.40, about: "place of cylinder 9 along the shaft" },
        ModelInput { name: "z10", unit: "m", nominal: 0.45, about: "place of cylinder 10 along the shaft" },
        ModelInput { name: "z11", unit: "m", nominal: 0.50, about: "place of cylinder 11 along the shaft" },
        ModelInput { name: "z12", unit: "m", nominal: 0.55, about: "place of cylinder 12 along the shaft" },
    ],
    outputs: &[
        ModelOutput { name: "F", unit: "N", about: "unbalanced force", depends_on: FORCE },
        ModelOutput {
            name: "M",
            unit: "N.m",
            about: "unbalanced moment about the origin of the places",
            depends_on: MOMENT,
        },
        ModelOutput { name: "F1", unit: "N", about: "part of F at the engine's speed", depends_on: FORCE },
        ModelOutput { name: "F2", unit: "N", about: "part of F at twice that", depends_on: FORCE },
        ModelOutput { name: "M1", unit: "N.m", about: "part of M at the engine's speed", depends_on: MOMENT },
        ModelOutput { name: "M2", unit: "N.m", about: "part of M at twice that", depends_on: MOMENT },
    ],
    evaluate,
    bounds: &[],
};

const FORCE: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20];
const MOMENT: &[usize] = &[
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30,
    31, 32,
];

/// Number of rows in a pass, so that their sums stay in the nearest cache.
const LANES: usize = 256;

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    let columns: [Option<usize>; 6] = std::array::from_fn(|output| block.column(output));
    // Force and moment, each of first and second order.
    let mut sums = [[0.0; LANES]; 4];
    for first in (0..block.rows()).step_by(LANES) {
        let rows = first..(first + LANES).min(block.rows());
        let count = rows.len();
        on_this_processor(Balance { block, rows: rows.clone(), sums: &mut sums });
        let total = |a: usize, b: usize| {
            let mut total = sums[a];
            total.iter_mut().zip(&sums[b]).for_each(|(total, other)| *total += other);
            total
        };
        for (output, column) in columns.into_iter().enumerate() {
            let Some(column) = column else { continue };
            match output {
                0 => out.set_rows(first, column, &total(0, 1)[..count]),
                1 => out.set_rows(first, column, &total(2, 3)[..count]),
                _ => out.set_rows(first, column, &sums[output - 2][..count]),
            }
            for (row, &n) in rows.clone().zip(&block.input(input::CYLINDERS)[rows.clone()]) {
                if !((1.0..=MOST as f64).contains(&n) && n.fract() == 0.0) {
                    let message =
                        format!("the number of cylinders n is {n}, and must be a whole number from 1 to {MOST}");
                    out.fail(row, column, EvaluationError::Refused { message });
                }
            }
        }
    }
}

struct Balance<'a> {
    block: &'a Block<'a>,
    rows: std::ops::Range<usize>,
    sums: &'a mut [[f64; LANES]; 4],
}

impl Work for Balance<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { block, rows, sums } = self;
        let count = rows.len();
        let x = |input: usize| &block.input(input)[rows.clone()];
        let (t, cylinders) = (x(input::T), x(input::CYLINDERS));
        let (mut angles, mut shares) = ([0.0; LANES], [0.0; LANES]);
        let (angles, shares) = (&mut angles[..count], &mut shares[..count]);
        sums.iter_mut().for_each(|sum| sum.fill(0.0));
        let [force1, force2, moment1, moment2] = sums;
        for cylinder in 0..MOST {
            let (phi, z) = (x(input::PHI + cylinder), x(input::Z + cylinder));
            if cylinders.iter().all(|&n| n <= cylinder as f64) {
                break;
            }
            for row in 0..count {
                angles[row] = t[row] + phi[row];
            }
            Cos::map_inline(angles, shares);
            for row in 0..count {
                let runs = if cylinders[row] > cylinder as f64 { 1.0 } else { 0.0 };
                let (first, second) = (runs * shares[row], runs * (2.0 * shares[row] * shares[row] - 1.0));
                force1[row] += first;
                force2[row] += second;
                moment1[row] += z[row] * first;
                moment2[row] += z[row] * second;
            }
        }
        let [mp, mr, omega, r] = [input::MP, input::MR, input::OMEGA, input::R].map(x);
        let [l, hp, hc] = [input::L, input::HP, input::HC].map(x);
        for row in 0..count {
            let reciprocating = mp[row] + mr[row] * hc[row] / (hc[row] + hp[row]);
            let scale = reciprocating * r[row] * omega[row] * omega[row];
            let second = scale * r[row] / l[row];
            force1[row] *= scale;
            moment1[row] *= scale;
            force2[row] *= second;
            moment2[row] *= second;
        }
    }
}
