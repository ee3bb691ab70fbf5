//! Unknowns at many points: side by side if that succeeds, else one by one by the safeguarded search.

use crate::assembly::formula::FormulaSet;
use crate::assembly::implicit::anchor::Anchor;
use crate::assembly::implicit::assembler::Assembler;
use crate::assembly::implicit::batch::{BatchSolver, Workspace};
use crate::assembly::implicit::error::AssemblyFailure;

/// Number of points that are solved side by side.
const WIDE: usize = 64;
/// Number of points side by side at the end, where few are left.
const NARROW: usize = 8;

/// Solved unknowns in a block of points.
pub(in crate::assembly) struct RowSolution {
    /// Column of every unknown, NaN where it was not found.
    pub(in crate::assembly) columns: Vec<Vec<f64>>,
    /// Failure of every row without a solution.
    pub(in crate::assembly) errors: Vec<Option<Box<AssemblyFailure>>>,
}

/// Points to solve: rows whose variables are all known.
struct Rows<'r, V> {
    solver: (&'r Assembler, &'r FormulaSet),
    anchor: &'r Anchor,
    /// Number of variables that are not unknowns.
    given: usize,
    variable: V,
}

impl RowSolution {
    /// Solves the conditions at every row whose variables are all known. A row has the same result, to the bit, in any block.
    pub(in crate::assembly) fn of(
        solver: (&Assembler, &FormulaSet),
        anchor: &Anchor,
        rows: usize,
        given: usize,
        variable: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let (assembler, set) = solver;
        let mut found = Self { columns: vec![vec![f64::NAN; rows]; assembler.len()], errors: vec![None; rows] };
        let uses = assembler.uses();
        let known = |&row: &usize| uses.iter().all(|&index| !variable(index, row).is_nan());
        let moves = |row: usize| uses.iter().any(|&index| variable(index, row) != anchor.given[index]);
        // Rows at the nominal dimensions have the nominal state.
        let mut open = Vec::with_capacity(rows);
        for row in (0..rows).filter(known) {
            if moves(row) {
                open.push(row);
            } else {
                found.set(row, &anchor.u);
            }
        }
        let rows = Rows { solver, anchor, given, variable };
        let Some(batch) = assembler.batch(set, anchor) else {
            open.into_iter().for_each(|row| rows.solve_alone(row, &mut found));
            return found;
        };
        // As many points as are side by side, and the rest in smaller groups if that is less work.
        let full = open.len() / WIDE * WIDE;
        let few = (open.len() - full) <= WIDE / 2;
        let (wide, narrow) = open.split_at(if few { full } else { open.len() });
        if !wide.is_empty() {
            rows.solve_together::<WIDE>(batch, wide, &mut found);
        }
        if !narrow.is_empty() {
            rows.solve_together::<NARROW>(batch, narrow, &mut found);
        }
        found
    }

    fn set(&mut self, row: usize, u: &[f64]) {
        self.columns.iter_mut().zip(u).for_each(|(column, &u)| column[row] = u);
    }
}

impl<V: Fn(usize, usize) -> f64> Rows<'_, V> {
    /// Solves rows in groups of `W`.
    fn solve_together<const W: usize>(&self, batch: &BatchSolver, rows: &[usize], found: &mut RowSolution) {
        let mut workspace: Workspace<W> = batch.workspace();
        let mut u = vec![f64::NAN; self.anchor.u.len()];
        for group in rows.chunks(W) {
            for lane in 0..W {
                // Places without a row take the nominal state.
                match group.get(lane) {
                    Some(&row) => batch.load(&mut workspace, lane, |index, _| (self.variable)(index, row)),
                    None => batch.load(&mut workspace, lane, |_, nominal| nominal),
                }
            }
            batch.solve(&self.solver.0.system, self.anchor, &mut workspace);
            for (lane, &row) in group.iter().enumerate() {
                if batch.solution(&workspace, lane, &mut u) {
                    found.set(row, &u);
                } else {
                    self.solve_alone(row, found);
                }
            }
        }
    }

    /// Solves one row by the safeguarded search.
    fn solve_alone(&self, row: usize, found: &mut RowSolution) {
        let (assembler, set) = self.solver;
        let mut values = vec![f64::NAN; self.given];
        assembler.uses().iter().for_each(|&index| values[index] = (self.variable)(index, row));
        match assembler.solve_safeguarded(set, self.anchor, &values) {
            Ok(u) => found.set(row, &u),
            Err(failure) => found.errors[row] = Some(Box::new(failure)),
        }
    }
}

impl Assembler {
    /// Returns the unknowns at one point. They have the same bits as in any block of points.
    pub(in crate::assembly) fn solve(
        &self,
        set: &FormulaSet,
        anchor: &Anchor,
        given: &[f64],
    ) -> Result<Vec<f64>, AssemblyFailure> {
        let mut found = RowSolution::of((self, set), anchor, 1, given.len(), |index, _| given[index]);
        match found.errors.swap_remove(0) {
            Some(failure) => Err(*failure),
            None => Ok(found.columns.iter().map(|column| column[0]).collect()),
        }
    }
}
