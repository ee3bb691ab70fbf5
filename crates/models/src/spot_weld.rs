//! Model `spot-weld`: gap and two flushes between the electrodes of a spot-welding gun, a chain in three dimensions.

use super::{Block, Model, ModelInput, ModelOutput};
use sensitol::assembly::Responses;
use sensitol_numeric::elementary::{Cos, Elementary, Sin, Work, on_this_processor};

/// Models two arms that turn about pivots on one frame. Each holds an electrode at a right angle to its end. With x forward, y sideways and
/// z up, and Rx, Ry, Rz the rotations about them, the tip of an electrode is at
///
/// ```text
/// tip = p + Rz(yaw) Rx(tilt) Ry(close) [ (rear, 0, 0) + Rz(skew) Ry(bend) (front, 0, -+tip) ]
/// gap = z_u - z_l,  flush1 = x_u - x_l,  flush2 = y_u - y_l
/// ```
///
/// with the upper electrode pointing down and the lower one up.
pub static SPOT_WELD: Model = Model {
    name: "spot-weld",
    title: "gap and flushes between the electrodes of a spot-welding gun",
    source: "after Sadikhani and Hashemian, Modares Mech. Eng. 18, 2018, which gives no dimensions; geometry ours",
    inputs: &[
        ModelInput { name: "px_u", unit: "mm", nominal: 0.0, about: "pivot of the upper arm, forward" },
        ModelInput { name: "py_u", unit: "mm", nominal: 0.0, about: "the same, sideways" },
        ModelInput { name: "pz_u", unit: "mm", nominal: 15.0, about: "the same, up" },
        ModelInput {
            name: "tilt_u",
            unit: "deg",
            nominal: 0.0,
            about: "tilt of the upper pivot's axis about the forward direction",
        },
        ModelInput { name: "yaw_u", unit: "deg", nominal: 0.0, about: "turn of it about the vertical" },
        ModelInput {
            name: "close_u",
            unit: "deg",
            nominal: -30.0,
            about: "angle of the upper arm about its pivot, up negative",
        },
        ModelInput { name: "rear_u", unit: "mm", nominal: 120.0, about: "length of the upper arm to its bend" },
        ModelInput { name: "bend_u", unit: "deg", nominal: 30.0, about: "bend in the plane of the gun, up negative" },
        ModelInput { name: "skew_u", unit: "deg", nominal: 0.0, about: "bend out of it" },
        ModelInput { name: "front_u", unit: "mm", nominal: 150.0, about: "length of the upper arm beyond its bend" },
        ModelInput { name: "tip_u", unit: "mm", nominal: 70.0, about: "length of the upper electrode" },
        ModelInput { name: "px_l", unit: "mm", nominal: 0.0, about: "pivot of the lower arm, forward" },
        ModelInput { name: "py_l", unit: "mm", nominal: 0.0, about: "the same, sideways" },
        ModelInput { name: "pz_l", unit: "mm", nominal: -15.0, about: "the same, up" },
        ModelInput {
            name: "tilt_l",
            unit: "deg",
            nominal: 0.0,
            about: "tilt of the lower pivot's axis about the forward direction",
        },
        ModelInput { name: "yaw_l", unit: "deg", nominal: 0.0, about: "turn of it about the vertical" },
        ModelInput {
            name: "close_l",
            unit: "deg",
            nominal: 30.0,
            about: "angle of the lower arm about its pivot, up negative",
        },
        ModelInput { name: "rear_l", unit: "mm", nominal: 120.0, about: "length of the lower arm to its bend" },
        ModelInput { name: "bend_l", unit: "deg", nominal: -30.0, about: "bend in the plane of the gun, up negative" },
        ModelInput { name: "skew_l", unit: "deg", nominal: 0.0, about: "bend out of it" },
        ModelInput { name: "front_l", unit: "mm", nominal: 150.0, about: "length of the lower arm beyond its bend" },
        ModelInput { name: "tip_l", unit: "mm", nominal: 70.0, about: "length of the lower electrode" },
    ],
    outputs: &[
        ModelOutput { name: "gap", unit: "mm", about: "between the tips, up", depends_on: GAP },
        ModelOutput { name: "flush1", unit: "mm", about: "the same, forward", depends_on: FLUSH1 },
        ModelOutput { name: "flush2", unit: "mm", about: "the same, sideways", depends_on: FLUSH2 },
    ],
    evaluate,
    bounds: &[],
};

/// Number of inputs of one arm.
const ARM: usize = 11;
/// Inputs of the gap. A shift of a pivot moves the tip along its own axis only. The yaw comes last and does not change the height.
const GAP: &[usize] = &[2, 3, 5, 6, 7, 8, 9, 10, 13, 14, 16, 17, 18, 19, 20, 21];
/// Inputs of the flush along x.
const FLUSH1: &[usize] = &[0, 3, 4, 5, 6, 7, 8, 9, 10, 11, 14, 15, 16, 17, 18, 19, 20, 21];
/// Inputs of the flush along y.
const FLUSH2: &[usize] = &[1, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 15, 16, 17, 18, 19, 20, 21];

/// Number of rows in a pass, so that their angles stay in the nearest cache.
const LANES: usize = 128;

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    // Up, forward, sideways: the order of the outputs.
    let columns = [block.column(0), block.column(1), block.column(2)];
    let mut differences = [[0.0; LANES]; 3];
    for first in (0..block.rows()).step_by(LANES) {
        let rows = first..(first + LANES).min(block.rows());
        let count = rows.len();
        differences.iter_mut().for_each(|of| of[..count].fill(0.0));
        for (arm, sign) in [1.0, -1.0].into_iter().enumerate() {
            let inputs = std::array::from_fn(|input| &block.input(arm * ARM + input)[rows.clone()]);
            on_this_processor(Tip { inputs, sign, differences: &mut differences });
        }
        for (column, values) in columns.iter().zip(&differences) {
            if let Some(column) = *column {
                out.set_rows(first, column, &values[..count]);
            }
        }
    }
}

/// Adds the place of one tip to the differences, with the sign + for the upper arm and - for the lower one.
struct Tip<'a> {
    inputs: [&'a [f64]; ARM],
    sign: f64,
    differences: &'a mut [[f64; LANES]; 3],
}

/// Sine and cosine of an angle in degrees, in every row.
struct Turn {
    sin: [f64; LANES],
    cos: [f64; LANES],
}

impl Turn {
    #[inline(always)]
    fn of(degrees: &[f64]) -> Self {
        let (mut angles, mut turn) = ([0.0; LANES], Self { sin: [0.0; LANES], cos: [1.0; LANES] });
        let count = degrees.len();
        for (angle, degrees) in angles.iter_mut().zip(degrees) {
            *angle = degrees.to_radians();
        }
        Sin::map_inline(&angles[..count], &mut turn.sin[..count]);
        Cos::map_inline(&angles[..count], &mut turn.cos[..count]);
        turn
    }
}

impl Work for Tip<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { inputs: [px, py, pz, tilt, yaw, close, rear, bend, skew, front, tip], sign, differences } = self;
        // One by one, since the closure of an array's `map` would be compiled separately, for the least processor.
        let (tilt, yaw, close) = (Turn::of(tilt), Turn::of(yaw), Turn::of(close));
        let (bend, skew) = (Turn::of(bend), Turn::of(skew));
        let [gap, forward, sideways] = differences;
        for row in 0..px.len() {
            // The electrode hangs from the upper arm and stands on the lower one.
            let hang = -sign * tip[row];
            let ahead = front[row] * bend.cos[row] + hang * bend.sin[row];
            let up = hang * bend.cos[row] - front[row] * bend.sin[row];
            let y = ahead * skew.sin[row];
            let x = rear[row] + ahead * skew.cos[row];
            let (x, z) = (x * close.cos[row] + up * close.sin[row], up * close.cos[row] - x * close.sin[row]);
            let (y, z) = (y * tilt.cos[row] - z * tilt.sin[row], y * tilt.sin[row] + z * tilt.cos[row]);
            let (x, y) = (x * yaw.cos[row] - y * yaw.sin[row], x * yaw.sin[row] + y * yaw.cos[row]);
            gap[row] += sign * (pz[row] + z);
            forward[row] += sign * (px[row] + x);
            sideways[row] += sign * (py[row] + y);
        }
    }
}
