//! `engine-balance`: unbalanced force and moment of an inline four-cylinder engine.

use std::f64::consts::PI;

use super::{Block, Model, ModelInput, ModelOutput};
use crate::assembly::Responses;

/// The inputs' places, in the order of `ENGINE_BALANCE.inputs`.
mod input {
    pub const MP: usize = 0;
    pub const MR: usize = 1;
    pub const OMEGA: usize = 2;
    pub const A: usize = 3;
    pub const R: usize = 4;
    pub const L: usize = 5;
    pub const HP: usize = 6;
    pub const HC: usize = 7;
    pub const T: usize = 8;
    pub const PHI: [usize; 4] = [9, 10, 11, 12];
}

/// Sum of the cylinders' inertia forces along the cylinder axes, and their moment about the first cylinder:
///
/// ```text
/// mr = MP + MR hc/(hc + hp)                                    reciprocating mass
/// K(w) = mr R omega^2 [ cos t S1c - sin t S1s + (R/L)(cos 2t S2c - sin 2t S2s) ]
/// S1c = sum_n w_n cos phi_n,  S1s likewise,  S2c = sum_n w_n cos 2 phi_n,  S2s likewise
/// F = K(1),  M = K((n-1) a)
/// ```
pub static ENGINE_BALANCE: Model = Model {
    name: "engine-balance",
    title: "unbalanced force and moment of an inline four-cylinder engine",
    source: "Sirousi and Ghasabzadeh Saryazdi, Tabriz J. Mech. Eng. 55(1), 2025, eqs 7-8 and Table 3",
    inputs: &[
        ModelInput { name: "MP", unit: "kg", nominal: 0.427, about: "mass of the piston group" },
        ModelInput { name: "MR", unit: "kg", nominal: 0.597, about: "mass of the connecting rod" },
        ModelInput { name: "omega", unit: "rad/s", nominal: 628.3185, about: "speed of the crankshaft" },
        ModelInput { name: "a", unit: "m", nominal: 0.050, about: "distance between cylinders" },
        ModelInput { name: "R", unit: "m", nominal: 0.0425, about: "crank radius" },
        ModelInput { name: "L", unit: "m", nominal: 0.1345, about: "length of the connecting rod" },
        ModelInput { name: "hp", unit: "m", nominal: 0.0973, about: "centre of mass of the rod to the piston pin" },
        ModelInput { name: "hc", unit: "m", nominal: 0.0372, about: "centre of mass of the rod to the crank pin" },
        ModelInput { name: "t", unit: "rad", nominal: 0.0, about: "crank angle" },
        ModelInput { name: "phi1", unit: "rad", nominal: 0.0, about: "crank angle of cylinder 1 on the shaft" },
        ModelInput { name: "phi2", unit: "rad", nominal: PI, about: "crank angle of cylinder 2 on the shaft" },
        ModelInput { name: "phi3", unit: "rad", nominal: 3.0 * PI, about: "crank angle of cylinder 3 on the shaft" },
        ModelInput { name: "phi4", unit: "rad", nominal: 2.0 * PI, about: "crank angle of cylinder 4 on the shaft" },
    ],
    outputs: &[
        ModelOutput {
            name: "F",
            unit: "N",
            about: "unbalanced force",
            depends_on: &[0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12],
        },
        ModelOutput {
            name: "M",
            unit: "N.m",
            about: "unbalanced moment about the first cylinder",
            depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12],
        },
    ],
    evaluate,
};

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    let column = |index| block.input(index);
    let (mp, mr, omega, a) = (column(input::MP), column(input::MR), column(input::OMEGA), column(input::A));
    let (r, l, hp, hc, t) =
        (column(input::R), column(input::L), column(input::HP), column(input::HC), column(input::T));
    let phi = input::PHI.map(column);
    let (force, moment) = (block.column(0), block.column(1));
    for row in 0..block.rows() {
        let reciprocating = mp[row] + mr[row] * hc[row] / (hc[row] + hp[row]);
        let scale = reciprocating * r[row] * omega[row] * omega[row];
        let ratio = r[row] / l[row];
        // cos t cos phi - sin t sin phi = cos(t + phi): each cylinder's share, first and second order.
        let share = |n: usize| {
            let angle = t[row] + phi[n][row];
            angle.cos() + ratio * (2.0 * angle).cos()
        };
        let shares = [0, 1, 2, 3].map(share);
        if let Some(column) = force {
            out.set(row, column, scale * shares.iter().sum::<f64>());
        }
        if let Some(column) = moment {
            let levers = shares[1] + 2.0 * shares[2] + 3.0 * shares[3];
            out.set(row, column, scale * a[row] * levers);
        }
    }
}
