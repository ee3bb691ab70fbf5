//! Gaussian elimination of many small matrices with the same structure, side by side.
//!
//! Pivots are chosen once, at the nominal state. Entries that are 0 in every matrix are left out.

use crate::assembly::formula::stages::Column;
use sensitol_numeric::elementary::{Work, on_this_processor};

/// Smallest pivot as a part of the largest entry in its column. Smaller pivots are passed over even if they save operations.
const THRESHOLD: f64 = 0.1;
/// Smallest pivot as a part of the same pivot at the nominal state. Beyond, the nominal choice of pivots does not fit the point.
const LEAST_PIVOT: f64 = 1e-4;

/// Plan of the elimination of matrices with a common structure.
#[derive(Debug)]
pub(super) struct Elimination {
    pivots: Vec<Pivot>,
    /// Number of entries of the matrix that may differ from 0. They are the first factors, in their order.
    entries: usize,
    /// Number of factors, including those that are 0 before the elimination.
    pub(super) factors: usize,
    /// Product of the signs of the nominal pivots.
    pub(super) sign: f64,
}

/// Step of the elimination.
#[derive(Debug)]
struct Pivot {
    row: usize,
    column: usize,
    /// Place of the pivot among the factors.
    place: usize,
    /// Size of the pivot at the nominal state.
    nominal: f64,
    /// Rows from which this one is subtracted.
    below: Vec<Below>,
    /// Places of the entries right of the pivot, with the rows of the pivots in their columns.
    right: Vec<(usize, usize)>,
}

#[derive(Debug)]
struct Below {
    row: usize,
    place: usize,
    /// Places of an entry that changes and of the entry in the pivot's row.
    changes: Vec<(usize, usize)>,
}

impl Elimination {
    /// Plans the elimination of an `n` by `n` matrix. `entries` are the row, the column, the nominal value, and the value in scales, which
    /// is used for the choice of pivots. Returns None if the nominal matrix is singular.
    pub(super) fn new(n: usize, entries: &[(usize, usize, f64, f64)]) -> Option<Self> {
        let mut places = vec![vec![None; n]; n];
        let (mut values, mut scaled) = (vec![vec![0.0; n]; n], vec![vec![0.0; n]; n]);
        for (place, &(row, column, value, in_scales)) in entries.iter().enumerate() {
            places[row][column] = Some(place);
            (values[row][column], scaled[row][column]) = (value, in_scales);
        }
        let mut factors = entries.len();
        let (mut rows, mut columns): (Vec<usize>, Vec<usize>) = ((0..n).collect(), (0..n).collect());
        let mut pivots = Vec::with_capacity(n);
        while !rows.is_empty() {
            let (row, column) = cheapest(&rows, &columns, &places, &scaled)?;
            rows.retain(|&other| other != row);
            columns.retain(|&other| other != column);
            let right: Vec<(usize, usize)> =
                columns.iter().filter_map(|&column| Some((places[row][column]?, column))).collect();
            let mut below = Vec::new();
            for &lower in &rows {
                let Some(place) = places[lower][column] else { continue };
                // An entry that was 0 so far becomes a factor.
                let changes = right.iter().map(|&(upper, column)| {
                    let changed = *places[lower][column].get_or_insert_with(|| {
                        factors += 1;
                        factors - 1
                    });
                    (changed, upper)
                });
                below.push(Below { row: lower, place, changes: changes.collect() });
                for matrix in [&mut values, &mut scaled] {
                    let factor = matrix[lower][column] / matrix[row][column];
                    columns.iter().for_each(|&column| matrix[lower][column] -= factor * matrix[row][column]);
                }
            }
            let place = places[row][column].expect("a pivot is an entry");
            pivots.push(Pivot { row, column, place, nominal: values[row][column], below, right });
        }
        let mut row_of = vec![0; n];
        pivots.iter().for_each(|pivot: &Pivot| row_of[pivot.column] = pivot.row);
        let to_rows = |(place, column): &mut (usize, usize)| (*place, *column) = (*place, row_of[*column]);
        pivots.iter_mut().for_each(|pivot| pivot.right.iter_mut().for_each(to_rows));
        let sign = pivots.iter().map(|pivot| pivot.nominal.signum()).product();
        Some(Self { pivots, entries: entries.len(), factors, sign })
    }

    /// Factorises matrices whose entries are the first factors. `signs` receives the product of the signs of the pivots, NaN if a pivot
    /// is too small.
    pub(super) fn factorise<const W: usize>(
        &self,
        factors: &mut [Column<W>],
        spare: &mut Column<W>,
        signs: &mut [f64; W],
    ) {
        on_this_processor(Factorise { plan: self, factors, spare, signs });
    }

    /// Raises `changes` to the greatest factor by which a pivot differs from the same one at the nominal state.
    pub(super) fn measure_changes<const W: usize>(&self, factors: &[Column<W>], changes: &mut [f64; W]) {
        for pivot in &self.pivots {
            // The inverse stands in the place of the pivot.
            for (change, inverse) in changes.iter_mut().zip(&*factors[pivot.place]) {
                let ratio = (inverse * pivot.nominal).abs();
                *change = change.max(ratio).max(1.0 / ratio);
            }
        }
    }

    /// Solves the equations with these right sides, one for each row. The solution replaces them, with every unknown in the row of its
    /// pivot.
    pub(super) fn solve<const W: usize>(&self, factors: &[Column<W>], right: &mut [Column<W>], spare: &mut Column<W>) {
        on_this_processor(Substitute { plan: self, factors, right, spare });
    }

    /// Returns the rows of the pivots, each with its column.
    pub(super) fn unknowns(&self) -> impl Iterator<Item = (usize, usize)> {
        self.pivots.iter().map(|pivot| (pivot.row, pivot.column))
    }
}

/// Returns the pivot that causes the fewest operations (Markowitz 1957) among those that are large enough.
fn cheapest(
    rows: &[usize],
    columns: &[usize],
    places: &[Vec<Option<usize>>],
    scaled: &[Vec<f64>],
) -> Option<(usize, usize)> {
    let mut best: Option<(usize, f64, usize, usize)> = None;
    let in_row: Vec<usize> =
        rows.iter().map(|&row| columns.iter().filter(|&&column| places[row][column].is_some()).count()).collect();
    for &column in columns {
        let in_column = rows.iter().filter(|&&row| places[row][column].is_some()).count();
        let largest = rows.iter().map(|&row| scaled[row][column].abs()).fold(0.0, f64::max);
        for (&row, &in_row) in rows.iter().zip(&in_row) {
            let size = scaled[row][column].abs();
            if places[row][column].is_none() || size == 0.0 || size.is_nan() || size < THRESHOLD * largest {
                continue;
            }
            let cost = (in_row - 1) * (in_column - 1);
            let better = best.is_none_or(|(least, largest, ..)| cost < least || cost == least && size > largest);
            if better {
                best = Some((cost, size, row, column));
            }
        }
    }
    best.map(|(_, _, row, column)| (row, column))
}

struct Factorise<'a, const W: usize> {
    plan: &'a Elimination,
    factors: &'a mut [Column<W>],
    spare: &'a mut Column<W>,
    signs: &'a mut [f64; W],
}

impl<const W: usize> Work for Factorise<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { plan, factors, spare, signs } = self;
        signs.fill(1.0);
        factors[plan.entries..].iter_mut().for_each(|factor| factor.fill(0.0));
        for pivot in &plan.pivots {
            let least = LEAST_PIVOT * pivot.nominal.abs();
            // The inverse takes the place of the pivot.
            for (value, sign) in factors[pivot.place].iter_mut().zip(signs.iter_mut()) {
                *sign *= if value.abs() >= least { value.signum() } else { f64::NAN };
                *value = 1.0 / *value;
            }
            for below in &pivot.below {
                std::mem::swap(spare, &mut factors[below.place]);
                spare.iter_mut().zip(&*factors[pivot.place]).for_each(|(value, &inverse)| *value *= inverse);
                std::mem::swap(spare, &mut factors[below.place]);
                for &(changed, upper) in &below.changes {
                    std::mem::swap(spare, &mut factors[changed]);
                    subtract(spare, &factors[below.place], &factors[upper]);
                    std::mem::swap(spare, &mut factors[changed]);
                }
            }
        }
    }
}

struct Substitute<'a, const W: usize> {
    plan: &'a Elimination,
    factors: &'a [Column<W>],
    right: &'a mut [Column<W>],
    spare: &'a mut Column<W>,
}

impl<const W: usize> Work for Substitute<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { plan, factors, right, spare } = self;
        for pivot in &plan.pivots {
            std::mem::swap(spare, &mut right[pivot.row]);
            pivot.below.iter().for_each(|below| subtract(&mut right[below.row], &factors[below.place], spare));
            std::mem::swap(spare, &mut right[pivot.row]);
        }
        for pivot in plan.pivots.iter().rev() {
            std::mem::swap(spare, &mut right[pivot.row]);
            pivot.right.iter().for_each(|&(place, row)| subtract(spare, &factors[place], &right[row]));
            spare.iter_mut().zip(&*factors[pivot.place]).for_each(|(value, &inverse)| *value *= inverse);
            std::mem::swap(spare, &mut right[pivot.row]);
        }
    }
}

/// Subtracts a product from every number of a column.
#[inline(always)]
fn subtract<const W: usize>(from: &mut [f64; W], a: &[f64; W], b: &[f64; W]) {
    from.iter_mut().zip(a).zip(b).for_each(|((from, &a), &b)| *from -= a * b);
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::Elimination;
    use crate::assembly::formula::stages::Column;

    const LANES: usize = 8;

    /// Returns the determinant by expansion along the first row.
    fn determinant(matrix: &[Vec<f64>]) -> f64 {
        let minor = |column: usize| -> Vec<Vec<f64>> {
            let without = |row: &Vec<f64>| {
                row.iter().enumerate().filter(|(index, _)| *index != column).map(|(_, value)| *value).collect()
            };
            matrix[1..].iter().map(without).collect()
        };
        let term = |(column, value): (usize, &f64)| {
            let sign = if column % 2 == 0 { 1.0 } else { -1.0 };
            if *value == 0.0 { 0.0 } else { sign * value * determinant(&minor(column)) }
        };
        matrix.first().map_or(1.0, |row| row.iter().enumerate().map(term).sum())
    }

    /// Solutions of random sparse matrices fulfil the equations, and the signs change with the determinant.
    #[test]
    fn matrices_of_a_structure_are_solved_together() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
        let mut solved = 0;
        for round in 0..300 {
            let n = 1 + round % 6;
            let full: Vec<Vec<bool>> = (0..n).map(|_| (0..n).map(|_| random.random_bool(0.6)).collect()).collect();
            let places: Vec<(usize, usize)> =
                (0..n * n).map(|at| (at / n, at % n)).filter(|&(row, column)| full[row][column]).collect();
            // One matrix for each lane, of which the first is the nominal one.
            let first: Vec<f64> = places.iter().map(|_| random.random_range(-2.0..2.0)).collect();
            let near = |value: f64, random: &mut Xoshiro256PlusPlus| value + random.random_range(-0.3..0.3);
            let mut columns: Vec<Column<LANES>> = first
                .iter()
                .map(|&value| {
                    Box::new(std::array::from_fn(|lane| if lane == 0 { value } else { near(value, &mut random) }))
                })
                .collect();
            let matrix = |lane: usize| {
                let mut matrix = vec![vec![0.0; n]; n];
                places.iter().zip(&columns).for_each(|(&(row, column), all)| matrix[row][column] = all[lane]);
                matrix
            };
            let matrices: Vec<Vec<Vec<f64>>> = (0..LANES).map(matrix).collect();
            let nominal = determinant(&matrices[0]);
            let entries: Vec<(usize, usize, f64, f64)> =
                places.iter().zip(&first).map(|(&(row, column), &value)| (row, column, value, value)).collect();
            let Some(plan) = Elimination::new(n, &entries) else {
                assert!(nominal.abs() < 1e-12, "{matrices:?}");
                continue;
            };
            let mut right: Vec<Column<LANES>> =
                (0..n).map(|_| Box::new(std::array::from_fn(|_| random.random_range(-1.0..1.0)))).collect();
            let asked = right.clone();
            let (mut spare, mut signs): (Column<LANES>, _) = (Box::new([0.0; LANES]), [0.0; LANES]);
            columns.resize(plan.factors, Box::new([f64::NAN; LANES]));
            plan.factorise(&mut columns, &mut spare, &mut signs);
            plan.solve(&columns, &mut right, &mut spare);
            for (lane, matrix) in matrices.iter().enumerate() {
                let change = determinant(matrix) / nominal;
                if signs[lane].is_nan() || change.abs() < 1e-2 {
                    continue;
                }
                solved += 1;
                assert_eq!(signs[lane] * plan.sign, change.signum(), "{matrix:?}");
                let mut solution = vec![0.0; n];
                plan.unknowns().for_each(|(row, column)| solution[column] = right[row][lane]);
                let size = solution.iter().fold(1.0f64, |size, t| size.max(t.abs()));
                for (row, coefficients) in matrix.iter().enumerate() {
                    let value: f64 = coefficients.iter().zip(&solution).map(|(a, t)| a * t).sum();
                    assert!((value - asked[row][lane]).abs() < 1e-9 * size, "{matrix:?}");
                }
            }
        }
        assert!(solved > 1000, "{solved}");
    }

    /// A pivot that is nearly 0 has no sign.
    #[test]
    fn a_small_pivot_is_refused() {
        let plan = Elimination::new(1, &[(0, 0, -2.0, -2.0)]).unwrap();
        let (mut spare, mut signs): (Column<3>, _) = (Box::new([0.0; 3]), [0.0; 3]);
        plan.factorise(&mut [Box::new([-1.0, 1.0, 1e-5])], &mut spare, &mut signs);
        assert_eq!(signs[..2], [-1.0, 1.0]);
        assert!(signs[2].is_nan() && plan.sign == -1.0);
        assert!(Elimination::new(1, &[(0, 0, 0.0, 0.0)]).is_none());
    }
}
