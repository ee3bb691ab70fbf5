//! Sentinels: the nominal point is evaluated again, to check that a model still gives the same answer.

use super::protocol::Line;
use sensitol::assembly::NonRepeatable;

/// Row of a sentinel, in place of the row of a point.
pub(super) const SENTINEL: usize = usize::MAX;
/// Windows of points after which a child is checked.
const WINDOWS: usize = 16;
/// Smallest number of points after which a child is checked.
const POINTS: usize = 50;
/// Greatest difference of two answers that agree, as a fraction of the range that the model has shown.
const NOISE: f64 = 1e-7;
/// Greatest difference of two answers that agree, as a fraction of the answer itself. Both limits are added.
const ROUNDING: f64 = 1e-12;

/// Values of one point; None for outputs without one.
pub(super) type Values = Vec<Option<f64>>;

/// Reference answer of the nominal point, and the range of all answers.
#[derive(Debug, Default)]
pub(super) struct Reference {
    nominal: Option<Vec<Option<f64>>>,
    range: Vec<[f64; 2]>,
}

/// Number of points that a child may answer before it is checked.
pub(super) fn interval(window: usize) -> usize {
    (WINDOWS * window).max(POINTS)
}

/// Values of an answer; None for outputs without one.
pub(super) fn values(line: &Line, outputs: usize) -> Vec<Option<f64>> {
    match (&line.y, &line.error) {
        (Some(values), None) => values.clone(),
        _ => vec![None; outputs],
    }
}

/// True if two answers agree, for an output with the range `spread` and the noise `noise`.
pub(super) fn agree(a: Option<f64>, b: Option<f64>, spread: f64, noise: f64) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= noise.max(NOISE * spread + ROUNDING * a.abs()),
        (None, None) => true,
        _ => false,
    }
}

/// Change of an answer, as a fraction of the range, above which it is another solution and not noise.
pub(super) const FLIP: f64 = 1e-3;

/// True if one of these differences is more than noise.
pub(super) fn is_flip(doubts: &[NonRepeatable]) -> bool {
    let far = |doubt: &NonRepeatable| match (doubt.expected, doubt.found) {
        (Some(a), Some(b)) => (a - b).abs() > FLIP * doubt.spread,
        _ => true,
    };
    doubts.iter().any(far)
}

impl Reference {
    /// Range of an output over all answers so far.
    pub(super) fn spread(&self, output: usize) -> f64 {
        self.range.get(output).map_or(0.0, |range| (range[1] - range[0]).max(0.0))
    }

    /// Sets the answer with which later ones to the nominal point are compared.
    pub(super) fn trust(&mut self, nominal: &[Option<f64>]) {
        self.nominal = Some(nominal.to_vec());
    }

    /// Extends the ranges by an answer.
    pub(super) fn learn(&mut self, values: &[Option<f64>]) {
        self.range.resize(values.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        for (range, value) in self.range.iter_mut().zip(values) {
            if let Some(value) = value {
                *range = [range[0].min(*value), range[1].max(*value)];
            }
        }
    }

    /// Compares an answer to the nominal point with the reference. The first answer becomes the reference. Returns the outputs that differ.
    pub(super) fn check(
        &mut self,
        found: Vec<Option<f64>>,
        names: &[String],
        suspects: &[Vec<f64>],
    ) -> Vec<NonRepeatable> {
        let Some(nominal) = &self.nominal else {
            self.nominal = Some(found);
            return Vec::new();
        };
        let doubt = |(output, (&expected, found)): (usize, (&Option<f64>, Option<f64>))| {
            let spread = self.spread(output);
            (!agree(expected, found, spread, 0.0)).then(|| NonRepeatable {
                output: names[output].clone(),
                expected,
                found,
                spread,
                suspects: suspects.to_vec(),
            })
        };
        nominal.iter().zip(found).enumerate().filter_map(doubt).collect()
    }
}
