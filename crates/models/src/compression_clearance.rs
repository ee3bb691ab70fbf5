//! Model `compression-clearance`: gap between piston and cylinder head of a diesel engine, a one-dimensional chain.

use super::{Block, Model, ModelInput, ModelOutput};
use sensitol::assembly::Responses;

/// Gap at the top dead centre, with gravity closing every clearance:
///
/// ```text
/// clearance = A + B + C - D - H - L + (E - F)/2 + (G - F)/2 + (J - K)/2 - P/2
/// ```
pub static COMPRESSION_CLEARANCE: Model = Model {
    name: "compression-clearance",
    title: "compression clearance of a diesel engine, a chain of twelve parts",
    source: "Liu, Xu and Xu, Intern. Combust. Engine & Powerplant 39(2), 2022, Table 1; its nominal values are masked: ours are chosen for its clearance, 0.8411 mm",
    inputs: &[
        ModelInput { name: "A", unit: "mm", nominal: 334.5661, about: "deck height" },
        ModelInput { name: "B", unit: "mm", nominal: 40.03, about: "liner shoulder to the row of bearings" },
        ModelInput { name: "C", unit: "mm", nominal: 1.2, about: "thickness of the gasket" },
        ModelInput { name: "D", unit: "mm", nominal: 65.0, about: "compression height of the piston" },
        ModelInput { name: "E", unit: "mm", nominal: 36.01, about: "diameter of the piston's bore for the pin" },
        ModelInput { name: "F", unit: "mm", nominal: 36.0, about: "diameter of the pin" },
        ModelInput { name: "G", unit: "mm", nominal: 36.03, about: "bore of the small end" },
        ModelInput { name: "H", unit: "mm", nominal: 210.0, about: "distance of the eyes" },
        ModelInput { name: "J", unit: "mm", nominal: 70.05, about: "bore of the big end" },
        ModelInput { name: "K", unit: "mm", nominal: 70.0, about: "diameter of the crank pin" },
        ModelInput { name: "L", unit: "mm", nominal: 60.0, about: "crank radius" },
        ModelInput { name: "P", unit: "mm", nominal: 80.0, about: "diameter of the main journal" },
    ],
    outputs: &[ModelOutput {
        name: "clearance",
        unit: "mm",
        about: "compression clearance",
        depends_on: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11],
    }],
    evaluate,
    bounds: &[],
};

/// Coefficients of the inputs.
const COEFFICIENTS: [f64; 12] = [1.0, 1.0, 1.0, -1.0, 0.5, -1.0, 0.5, -1.0, 0.5, -0.5, -1.0, -0.5];

fn evaluate(block: &Block<'_>, out: &mut Responses) {
    let Some(column) = block.column(0) else { return };
    let mut sums = vec![0.0; block.rows()];
    for (input, coefficient) in COEFFICIENTS.into_iter().enumerate() {
        for (sum, value) in sums.iter_mut().zip(block.input(input)) {
            *sum += coefficient * value;
        }
    }
    out.set_rows(0, column, &sums);
}
