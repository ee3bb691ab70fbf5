//! Principal axes of the inputs of a model. If two inputs are nearly proportional, the corners of a surface over them lie far from all
//! parts.
//!
//! Inputs `z` with means `m` and standard deviations `s` have the correlation `R = V D V'`. The coordinates `w = V' S^-1 (z - m)` are
//! uncorrelated. A surface over them takes the same number of points, or fewer: directions without variance are omitted.

use std::sync::Arc;

use faer::{Mat, Side};

use crate::assembly::{
    AssemblyFunction, EvaluationError, Input, ModelInfo, Points, Request, Responses, Run, Signature,
};
use sensitol_numeric::sampling::{Joint, Summary};

/// Correlation above which the corners of a pair lie far from all parts.
const ALIKE: f64 = 0.95;
/// An input whose sigma is below this part of its mean does not vary.
pub(super) const STILL: f64 = 1e-12;
/// An eigenvalue of a correlation matrix of `m` inputs below `m` times this is a rounding of 0.
pub(super) const ZERO: f64 = 1e-12;

/// Directions in which inputs vary together.
pub(super) struct Axes {
    centre: Vec<f64>,
    /// Matrix from `w` to `z - centre`, one row for each input.
    outward: Mat<f64>,
    /// Matrix from `z - centre` to `w`, one row for each direction.
    inward: Mat<f64>,
}

impl Axes {
    /// Returns the axes of inputs at these points, about `centre`. Returns None if no two inputs are nearly proportional.
    pub(super) fn of(sent: &Points, centre: &[f64]) -> Option<Self> {
        let m = sent.dimensions();
        let sigma: Vec<f64> = (0..m).map(|j| Summary::of(sent.column(j)).sigma()).collect();
        let moving: Vec<usize> = (0..m).filter(|&j| sigma[j] > STILL * centre[j].abs() && sigma[j] > 0.0).collect();
        let correlation = Mat::from_fn(moving.len(), moving.len(), |j, k| {
            if j == k { 1.0 } else { together(sent.column(moving[j]), sent.column(moving[k])) }
        });
        let alike = |j: usize| (j + 1..moving.len()).any(|k| correlation[(j, k)].abs() > ALIKE);
        if !(0..moving.len()).any(alike) {
            return None;
        }
        let eigen = correlation.self_adjoint_eigen(Side::Lower).ok()?;
        let (values, vectors) = (eigen.S(), eigen.U());
        let mut order: Vec<usize> = (0..moving.len()).filter(|&k| values[k] > ZERO * moving.len() as f64).collect();
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]).then(a.cmp(&b)));
        let place = |input: usize| moving.iter().position(|&of| of == input);
        // An input that does not vary has no component in any direction.
        let entry = |input: usize, direction: usize| place(input).map_or(0.0, |j| vectors[(j, order[direction])]);
        Some(Self {
            centre: centre.to_vec(),
            outward: Mat::from_fn(m, order.len(), |input, k| sigma[input] * entry(input, k)),
            inward: Mat::from_fn(
                order.len(),
                m,
                |k, input| {
                    if sigma[input] > 0.0 { entry(input, k) / sigma[input] } else { 0.0 }
                },
            ),
        })
    }

    pub(super) fn directions(&self) -> usize {
        self.outward.ncols()
    }

    /// Converts inputs to coordinates along the axes.
    pub(super) fn inward(&self, sent: &Points) -> Points {
        let rows: Vec<Vec<f64>> = (0..sent.rows())
            .map(|row| {
                let z = sent.row(row);
                let along = |k: usize| (0..z.len()).map(|j| self.inward[(k, j)] * (z[j] - self.centre[j])).sum();
                (0..self.directions()).map(along).collect()
            })
            .collect();
        Points::from_rows(&rows)
    }

    /// Converts coordinates along the axes to inputs.
    fn outward(&self, points: &Points) -> Points {
        let rows: Vec<Vec<f64>> = (0..points.rows())
            .map(|row| {
                let w = points.row(row);
                let of = |j: usize| (0..w.len()).fold(self.centre[j], |sum, k| sum + self.outward[(j, k)] * w[k]);
                (0..self.centre.len()).map(of).collect()
            })
            .collect();
        Points::from_rows(&rows)
    }
}

/// Returns the correlation of two columns.
fn together(a: &[f64], b: &[f64]) -> f64 {
    let rows: Vec<[f64; 2]> = a.iter().zip(b).map(|(a, b)| [*a, *b]).collect();
    let joint = Joint::of(&rows);
    let [[aa, ab], [_, bb]] = *joint.products();
    ab / (aa.sqrt() * bb.sqrt())
}

/// Model as a function of the principal axes of its inputs.
pub(super) struct Turned {
    model: Arc<dyn AssemblyFunction>,
    pub(super) axes: Arc<Axes>,
    signature: Signature,
}

impl Turned {
    /// Wraps the model as a function of the axes, which get these names.
    pub(super) fn new(model: Arc<dyn AssemblyFunction>, axes: Arc<Axes>, names: &[String]) -> Self {
        let inputs = names.iter().map(|name| Input { name: name.clone(), unit: None }).collect();
        // Every axis moves every input.
        let mut outputs = model.signature().outputs.clone();
        outputs.iter_mut().for_each(|output| output.depends_on = None);
        let signature = Signature { inputs, outputs, ..model.signature().clone() };
        Self { model, axes, signature }
    }
}

impl AssemblyFunction for Turned {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        self.model.prepare(outputs)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.model.evaluate(&Request::values(&self.axes.outward(request.points), request.outputs), run, out);
        for row in 0..out.rows() {
            for output in 0..out.outputs() {
                let Some(gradient) = out.gradient(row, output).map(<[f64]>::to_vec) else { continue };
                let along =
                    |k: usize| gradient.iter().enumerate().map(|(j, slope)| slope * self.axes.outward[(j, k)]).sum();
                out.set_gradient(row, output, (0..self.axes.directions()).map(along).collect());
            }
        }
    }

    fn sent(&self, points: &Points) -> Option<(Vec<Input>, Points)> {
        Some((self.model.signature().inputs.clone(), self.axes.outward(points)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two inputs that vary alike, one fixed input and one independent input are recovered from their axes.
    #[test]
    fn axes_lead_there_and_back() {
        let z = |i: usize| {
            let [a, b, c] = [7, 11, 13].map(|period| (i % period) as f64 - (period / 2) as f64);
            vec![10.0 + a, 20.0 + 3.0 * a + 0.01 * b, 5.0, -1.0 + c]
        };
        let sent = Points::from_rows(&(0..1001).map(z).collect::<Vec<_>>());
        let axes = Axes::of(&sent, &[10.0, 20.0, 5.0, -1.0]).unwrap();
        assert_eq!(axes.directions(), 3);
        let back = axes.outward(&axes.inward(&sent));
        for j in 0..4 {
            // The eigenvectors are orthogonal up to rounding, and nothing is divided by an eigenvalue, so that the smallest direction is as
            // accurate.
            sent.column(j).iter().zip(back.column(j)).for_each(|(a, b)| assert!((a - b).abs() < 1e-12, "{a} {b}"));
        }
        let alone = Points::from_rows(&(0..1001).map(|i| vec![z(i)[0], z(i)[3]]).collect::<Vec<_>>());
        assert!(Axes::of(&alone, &[10.0, -1.0]).is_none());
    }
}
