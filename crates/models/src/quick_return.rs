//! Model `quick-return`: stroke and time ratio of a crank-shaper mechanism.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Block, Model, ModelInput, ModelOutput};
use sensitol::assembly::Responses;
use sensitol_numeric::elementary::{Acos, Elementary, Work, on_this_processor};

/// A crank turns a slotted lever, whose end moves a ram by a link:
///
/// ```text
/// delta = atan2(e, d),  gamma = asin((r + s/2)/hypot(d, e))            the lever swings delta - gamma .. delta + gamma
/// x(b) = q sin b + sqrt(c^2 - (H - q cos b)^2)                         the ram
/// stroke = x(delta + gamma) - x(delta - gamma)
/// ratio  = (pi + 2 gamma)/(pi - 2 gamma)                               time of the working stroke by that of the return
/// ```
pub static QUICK_RETURN: Model = Model {
    name: "quick-return",
    title: "stroke and time ratio of a crank-shaper mechanism",
    source: "after Sadikhani and Hashemian, Modares Mech. Eng. 18, 2018, Fig. 10; geometry and tolerances ours, its dimensions are in a picture only",
    inputs: &[
        ModelInput { name: "r", unit: "mm", nominal: 56.6, about: "crank radius" },
        ModelInput { name: "d", unit: "mm", nominal: 140.0, about: "height of the crank above the lever's pivot" },
        ModelInput { name: "e", unit: "mm", nominal: 8.0, about: "offset of the crank from the lever's pivot" },
        ModelInput { name: "q", unit: "mm", nominal: 220.0, about: "length of the lever" },
        ModelInput { name: "c", unit: "mm", nominal: 180.0, about: "length of the link" },
        ModelInput { name: "H", unit: "mm", nominal: 235.0, about: "height of the ram above the lever's pivot" },
        ModelInput { name: "s", unit: "mm", nominal: 0.05, about: "clearance of the sliding block in the slot" },
    ],
    outputs: &[
        ModelOutput { name: "stroke", unit: "mm", about: "stroke of the ram", depends_on: &[0, 1, 2, 3, 4, 5, 6] },
        ModelOutput { name: "ratio", unit: "-", about: "time ratio", depends_on: &[0, 1, 2, 6] },
    ],
    evaluate,
    bounds: &[],
};

/// Number of rows in a pass, so that their sums stay in the nearest cache.
const LANES: usize = 256;

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    let (stroke, ratio) = (block.column(0), block.column(1));
    let mut values = [0.0; LANES];
    for first in (0..block.rows()).step_by(LANES) {
        let rows = first..(first + LANES).min(block.rows());
        let inputs = std::array::from_fn(|input| &block.input(input)[rows.clone()]);
        let values = &mut values[..rows.len()];
        if let Some(column) = stroke {
            on_this_processor(Stroke { inputs, strokes: &mut *values });
            out.set_rows(first, column, values);
        }
        if let Some(column) = ratio {
            on_this_processor(Ratio { inputs, ratios: &mut *values });
            out.set_rows(first, column, values);
        }
    }
}

struct Stroke<'a> {
    inputs: [&'a [f64]; 7],
    strokes: &'a mut [f64],
}

impl Work for Stroke<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let rows = self.strokes.len();
        let [r, d, e, q, c, height, s] = self.inputs.map(|input| &input[..rows]);
        for (row, stroke) in self.strokes.iter_mut().enumerate() {
            // Sine and cosine of delta and gamma are ratios of lengths, so no angle is computed.
            let reach = r[row] + 0.5 * s[row];
            let square = d[row] * d[row] + e[row] * e[row];
            let rest = (square - reach * reach).sqrt();
            let arm = [d[row], e[row], q[row], c[row], height[row]];
            *stroke = ram(arm, reach, [rest, square]) - ram(arm, -reach, [rest, square]);
        }
    }
}

/// Place of the ram at one end of its stroke. `reach` is negative at the other end.
#[inline(always)]
fn ram([d, e, q, c, height]: [f64; 5], reach: f64, [rest, square]: [f64; 2]) -> f64 {
    let sin = (e * rest + d * reach) / square;
    let cos = (d * rest - e * reach) / square;
    let rise = height - q * cos;
    q * sin + (c * c - rise * rise).sqrt()
}

struct Ratio<'a> {
    inputs: [&'a [f64]; 7],
    ratios: &'a mut [f64],
}

impl Work for Ratio<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let rows = self.ratios.len();
        let [r, d, e, _, _, _, s] = self.inputs.map(|input| &input[..rows]);
        let mut sines = [0.0; LANES];
        let sines = &mut sines[..rows];
        for (row, sine) in sines.iter_mut().enumerate() {
            *sine = (r[row] + 0.5 * s[row]) / (d[row] * d[row] + e[row] * e[row]).sqrt();
        }
        Acos::map_inline(sines, self.ratios);
        for ratio in self.ratios.iter_mut() {
            let gamma = FRAC_PI_2 - *ratio;
            *ratio = (PI + 2.0 * gamma) / (PI - 2.0 * gamma);
        }
    }
}
