//! Linear program with many columns and at most four rows: the revised simplex method with a dense basis.
//!
//! The rows are the whole mass, the mean from below and from above, and the second moment about the middle of the range of the mean. A
//! distribution at one point within that range keeps all of them and is the first basis.

use crate::distribution_bounds::DistributionPromise;

/// Reduced cost below which a column enters the basis. Values of columns are shares.
const ENTERS: f64 = 1e-12;
/// Greatest number of steps. Some tens are usual.
const STEPS: usize = 20_000;
/// Least pivot, relative to the rows, which are scaled to the size 1.
const PIVOT: f64 = 1e-11;

/// Number of rows.
const ROWS: usize = 4;

/// A point with its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column {
    pub(super) x: f64,
    pub(super) value: f64,
}

/// Rows of the program in a scaled variable.
pub(super) struct Programme {
    /// Origin and scale of the variable.
    origin: f64,
    scale: f64,
    /// Greatest mean, and greatest of minus the mean, from the origin.
    mean: [f64; 2],
    /// Greatest second moment about the origin. None if it is not bounded.
    second: Option<f64>,
    /// Component of the mixture: a point, a pair, or a uniform distribution, by its moments.
    form: MixtureForm,
}

/// Distributions that are mixed.
#[derive(Clone, Copy, PartialEq)]
enum MixtureForm {
    Points,
    Pairs,
    Uniform,
}

/// Optimum of the program.
pub(super) struct Solution {
    pub(super) value: f64,
    /// Columns with their weights.
    pub(super) weights: Vec<(usize, f64)>,
    dual: [f64; ROWS],
    rows: RowsOf,
    scale: f64,
}

/// Rows of a column.
#[derive(Clone, Copy)]
struct RowsOf {
    origin: f64,
    scale: f64,
    form: MixtureForm,
}

impl RowsOf {
    fn at(&self, x: f64) -> [f64; ROWS] {
        let u = (x - self.origin) / self.scale;
        match self.form {
            MixtureForm::Points => [1.0, u, -u, u * u],
            MixtureForm::Pairs => [1.0, 0.0, 0.0, (x / self.scale).powi(2)],
            MixtureForm::Uniform => [1.0, 0.0, 0.0, (x / self.scale).powi(2) / 3.0],
        }
    }
}

impl Solution {
    /// Value of a column less that of the dual function.
    pub(super) fn reduced_cost(&self, column: &Column) -> f64 {
        let rows = self.rows.at(column.x);
        column.value - self.dual.iter().zip(rows).map(|(dual, row)| dual * row).sum::<f64>()
    }

    /// Curvature of the dual function downwards: minus its quadratic coefficient, in the unit of the variable.
    pub(super) fn curvature(&self) -> f64 {
        let form = if self.rows.form == MixtureForm::Uniform { 1.0 / 3.0 } else { 1.0 };
        -self.dual[3] * form / (self.scale * self.scale)
    }
}

/// Member of a basis.
#[derive(Clone, Copy, PartialEq)]
enum Member {
    Column(usize),
    Slack(usize),
}

impl Programme {
    /// Program of a promise with the mean in a range.
    pub(super) fn of(promise: &DistributionPromise, [low, high]: [f64; 2]) -> Self {
        let [from, to] = promise.range();
        let scale = to - from;
        let origin = f64::midpoint(low, high);
        let form = match (promise.is_symmetric(), promise.is_unimodal()) {
            (false, _) => MixtureForm::Points,
            (true, false) => MixtureForm::Pairs,
            (true, true) => MixtureForm::Uniform,
        };
        let half = if promise.is_symmetric() { 0.0 } else { 0.5 * (high - low) / scale };
        // The second moment about the origin is the variance and the squared distance of the mean, which is at most half the range.
        let second = promise.sigma().map(|sigma| (sigma / scale).powi(2) + half * half);
        Self { origin, scale, mean: [half; 2], second, form }
    }

    /// Least value of the program.
    pub(super) fn solve(&self, columns: &[Column]) -> Solution {
        let rows = RowsOf { origin: self.origin, scale: self.scale, form: self.form };
        let bounds = [1.0, self.mean[0], self.mean[1], self.second.unwrap_or(f64::MAX)];
        // A second moment without a bound gets a row that is never tight.
        let bounds = bounds.map(|bound| bound.min(4.0));
        let central = |column: &Column| {
            let [_, up, _, second] = rows.at(column.x);
            up.abs() + if self.form == MixtureForm::Points { 0.0 } else { second }
        };
        let first = (0..columns.len()).min_by(|a, b| central(&columns[*a]).total_cmp(&central(&columns[*b])));
        let first = first.expect("a program has columns");
        let mut basis = [Member::Column(first), Member::Slack(1), Member::Slack(2), Member::Slack(3)];
        let column_of = |member: Member| match member {
            Member::Column(place) => rows.at(columns[place].x),
            Member::Slack(row) => std::array::from_fn(|at| f64::from(u8::from(at == row))),
        };
        let value_of = |member: Member| if let Member::Column(place) = member { columns[place].value } else { 0.0 };
        let (mut weights, mut dual) = ([0.0; ROWS], [0.0; ROWS]);
        for step in 0..STEPS {
            let matrix = basis.map(column_of);
            weights = solved(&transposed(&matrix), bounds).unwrap_or(weights);
            dual = solved(&matrix, basis.map(value_of)).unwrap_or(dual);
            let product = |rows: [f64; ROWS]| dual.iter().zip(rows).map(|(dual, row)| dual * row).sum::<f64>();
            let reduced = |member: Member| value_of(member) - product(column_of(member));
            let all = (0..columns.len()).map(Member::Column).chain((1..ROWS).map(Member::Slack));
            let all = all.map(|member| (reduced(member), member)).filter(|(cost, _)| *cost < -ENTERS);
            // Late steps take the first column, which cannot repeat a basis for ever (Bland 1977).
            let entering = match step < STEPS / 2 {
                true => all.min_by(|a, b| a.0.total_cmp(&b.0)),
                false => all.into_iter().next(),
            };
            let Some((_, entering)) = entering else { break };
            let Some(along) = solved(&transposed(&matrix), column_of(entering)) else { break };
            let ratio = |place: usize| (along[place] > PIVOT).then(|| weights[place].max(0.0) / along[place]);
            let leaving = (0..ROWS).filter_map(|place| Some((ratio(place)?, place)));
            let Some((_, leaving)) = leaving.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
            basis[leaving] = entering;
        }
        let kept = basis.iter().zip(weights).filter_map(|(member, weight)| match member {
            Member::Column(place) if weight > 0.0 => Some((*place, weight)),
            _ => None,
        });
        let product = |dual: &[f64; ROWS]| dual.iter().zip(bounds).map(|(dual, bound)| dual * bound).sum::<f64>();
        // Duals of rows `<=` are at most 0. What remains above 0 by rounding, and what columns fall below the dual function, is taken off.
        let mut solution = Solution { value: 0.0, weights: kept.collect(), dual, rows, scale: self.scale };
        for row in 1..ROWS {
            solution.dual[row] = solution.dual[row].min(0.0);
        }
        let short = columns.iter().map(|column| solution.reduced_cost(column)).fold(0.0, f64::min);
        solution.dual[0] += short;
        solution.value = product(&solution.dual);
        solution
    }
}

fn transposed(matrix: &[[f64; ROWS]; ROWS]) -> [[f64; ROWS]; ROWS] {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]))
}

/// Solution of a small system by elimination with pivots. Returns None if it is singular.
fn solved(matrix: &[[f64; ROWS]; ROWS], right: [f64; ROWS]) -> Option<[f64; ROWS]> {
    let (mut rows, mut right) = (*matrix, right);
    for column in 0..ROWS {
        let pivot = (column..ROWS).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()))?;
        if rows[pivot][column].abs() < 1e-300 {
            return None;
        }
        rows.swap(column, pivot);
        right.swap(column, pivot);
        for row in 0..ROWS {
            if row != column {
                let factor = rows[row][column] / rows[column][column];
                let pivot_row = rows[column];
                rows[row].iter_mut().zip(pivot_row).for_each(|(cell, of)| *cell -= factor * of);
                right[row] -= factor * right[column];
            }
        }
    }
    Some(std::array::from_fn(|row| right[row] / rows[row][row]))
}
