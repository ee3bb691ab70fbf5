//! Model `engine-balance`: unbalanced force and moment of an inline four-cylinder engine.

use std::f64::consts::PI;

use super::{Block, Model, ModelInput, ModelOutput};
use sensitol::assembly::Responses;
use sensitol_numeric::elementary::{Cos, Elementary, Work, on_this_processor};

/// Indices of the inputs, in the order of `ENGINE_BALANCE.inputs`.
mod input {
    pub const MP: usize = 0;
    pub const MR: usize = 1;
    pub(crate) const OMEGA: usize = 2;
    pub const A: usize = 3;
    pub const R: usize = 4;
    pub const L: usize = 5;
    pub(crate) const HP: usize = 6;
    pub(crate) const HC: usize = 7;
    pub const T: usize = 8;
    pub(crate) const PHI: [usize; 4] = [9, 10, 11, 12];
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
    bounds: &[],
};

/// Number of rows in a pass, so that their angles and sums stay in the nearest cache.
const LANES: usize = 256;

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    let (force, moment) = (block.column(0), block.column(1));
    let (mut sums, mut room) = ([[0.0; LANES]; 2], [[0.0; LANES]; 3]);
    for first in (0..block.rows()).step_by(LANES) {
        let rows = first..(first + LANES).min(block.rows());
        let inputs = std::array::from_fn(|input| &block.input(input)[rows.clone()]);
        let [forces, moments] = &mut sums;
        let (forces, moments) = (&mut forces[..rows.len()], &mut moments[..rows.len()]);
        on_this_processor(Balance { inputs, forces: &mut *forces, moments: &mut *moments, room: &mut room });
        for (column, values) in [(force, forces), (moment, moments)] {
            if let Some(column) = column {
                out.set_rows(first, column, values);
            }
        }
    }
}

struct Balance<'a> {
    inputs: [&'a [f64]; 13],
    forces: &'a mut [f64],
    moments: &'a mut [f64],
    /// Scratch space for an angle, its cosine, and the ratio of crank to rod.
    room: &'a mut [[f64; LANES]; 3],
}

impl Work for Balance<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { inputs, forces, moments, room: [angles, shares, ratios] } = self;
        let rows = forces.len();
        let (angles, shares, ratios) = (&mut angles[..rows], &mut shares[..rows], &mut ratios[..rows]);
        let (r, l) = (&inputs[input::R][..rows], &inputs[input::L][..rows]);
        for row in 0..rows {
            ratios[row] = r[row] / l[row];
        }
        forces.fill(0.0);
        moments.fill(0.0);
        for (phi, lever) in input::PHI.into_iter().zip([0.0, 1.0, 2.0, 3.0]) {
            let (t, phi) = (&inputs[input::T][..rows], &inputs[phi][..rows]);
            for row in 0..rows {
                angles[row] = t[row] + phi[row];
            }
            Cos::map_inline(angles, shares);
            for row in 0..rows {
                // Each cylinder adds its first and second order. The sum cos t cos phi - sin t sin phi is cos(t + phi). The second order
                // uses cos 2x = 2 cos^2 x - 1, whose absolute error is like that of cos x.
                let c = shares[row];
                let share = c + ratios[row] * (2.0 * c * c - 1.0);
                forces[row] += share;
                moments[row] += lever * share;
            }
        }
        let [mp, mr, omega, a] = [input::MP, input::MR, input::OMEGA, input::A].map(|input| &inputs[input][..rows]);
        let (hp, hc) = (&inputs[input::HP][..rows], &inputs[input::HC][..rows]);
        for row in 0..rows {
            let reciprocating = mp[row] + mr[row] * hc[row] / (hc[row] + hp[row]);
            let scale = reciprocating * r[row] * omega[row] * omega[row];
            forces[row] *= scale;
            moments[row] *= scale * a[row];
        }
    }
}
