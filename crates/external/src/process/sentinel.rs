//! Whether a model still answers as it did: the nominal point, evaluated again.

use super::protocol::Line;
use sensitol::assembly::NonRepeatable;

/// In place of a row: the point is the nominal one, evaluated again.
pub(super) const SENTINEL: usize = usize::MAX;
/// Windows of points after which a child is checked, and points at the least.
const WINDOWS: usize = 16;
const POINTS: usize = 50;
/// Answers agree when they differ by no more than this part of what the model has been seen to vary by,
const NOISE: f64 = 1e-7;
/// and this part of themselves.
const ROUNDING: f64 = 1e-12;

/// The reference answers of the nominal point, and how far answers vary.
#[derive(Debug, Default)]
pub(super) struct Reference {
    nominal: Option<Vec<Option<f64>>>,
    range: Vec<[f64; 2]>,
}

/// Points that a child may answer before it is checked.
pub(super) fn interval(window: usize) -> usize {
    (WINDOWS * window).max(POINTS)
}

/// The values of an answer, None where it has none.
pub(super) fn values(line: &Line, outputs: usize) -> Vec<Option<f64>> {
    match (&line.y, &line.error) {
        (Some(values), None) => values.clone(),
        _ => vec![None; outputs],
    }
}

/// Whether two answers are the same, for an output that varies by `spread` and repeats within `noise`.
pub(super) fn agree(a: Option<f64>, b: Option<f64>, spread: f64, noise: f64) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= noise.max(NOISE * spread + ROUNDING * a.abs()),
        (None, None) => true,
        _ => false,
    }
}

/// A change of an answer by more than this part of what the model varies by is another solution, and no noise.
pub(super) const FLIP: f64 = 1e-3;

/// Whether one of these differences is more than noise.
pub(super) fn is_flip(doubts: &[NonRepeatable]) -> bool {
    let far = |doubt: &NonRepeatable| match (doubt.expected, doubt.found) {
        (Some(a), Some(b)) => (a - b).abs() > FLIP * doubt.spread,
        _ => true,
    };
    doubts.iter().any(far)
}

impl Reference {
    /// How far an output has been seen to vary.
    pub(super) fn spread(&self, output: usize) -> f64 {
        self.range.get(output).map_or(0.0, |range| (range[1] - range[0]).max(0.0))
    }

    /// Sets the values that later answers to the nominal point are compared with.
    pub(super) fn trust(&mut self, nominal: &[Option<f64>]) {
        self.nominal = Some(nominal.to_vec());
    }

    /// Learns from an answer how far the model varies.
    pub(super) fn learn(&mut self, values: &[Option<f64>]) {
        self.range.resize(values.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        for (range, value) in self.range.iter_mut().zip(values) {
            if let Some(value) = value {
                *range = [range[0].min(*value), range[1].max(*value)];
            }
        }
    }

    /// The first answer to the nominal point is what later ones are held against: whether this one is like it.
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
