//! Newton's method at many points side by side, block after block of the block-triangular order.
//!
//! Every point starts from its linear prediction. It takes full steps, each at most half as long as the one before, until rounding stops
//! it. A point for which that fails is left to the safeguarded search. The arithmetic of a point does not depend on its neighbours.

use crate::assembly::formula::stages::{Column, Expression, Expressions, Lanes, Part, StageExpressions, Stages};
use crate::assembly::formula::{Binary, FormulaSet, Unary};
use crate::assembly::implicit::anchor::{Anchor, OFF, SLACK, STEPS};
use crate::assembly::implicit::elimination::Elimination;
use crate::assembly::implicit::newton::{FOUND, NEAR, REACH, ROUNDING};
use crate::assembly::implicit::order::Structure;
use crate::assembly::implicit::system::{Kind, System};
use sensitol_numeric::elementary::{Work, on_this_processor};

/// Largest number of unknowns in a block. The factors of larger ones leave the cache.
const LARGEST: usize = 100;
/// Greatest part of a step that is still an error after a further step with the same derivatives. It allows for curvature that is four
/// times as large as two steps show.
const CURVED: f64 = 4.0;
/// Longest step, as a part of the one before, that counts as convergence. The safeguarded search has the same limit.
const SHORTER: f64 = 0.5;

/// Greatest distance of a root from its prediction, in scales, at which it is accepted although no slope predicts it. It is a tenth of a
/// scale: floats and tolerances move assemblies by some hundredths, and other branches lie about a scale away.
const NEIGHBOURHOOD: f64 = 0.1;
/// Greatest contraction of the steps to such a root. Two roots at the distance d let a step that begins at the distance e from one of them
/// leave e/d of the error, so that another root is at least ten times as far from the prediction as the one that is found.
const CONTRACTING: f64 = 0.1;
/// Greatest factor between a pivot at such a root and at the nominal state. A root of another branch near by has pivots that are smaller or of
/// another sign, since the determinant is 0 where branches meet.
const ALIKE: f64 = 2.0;

/// State of a point that is left to the safeguarded search. States are numbers, so that they stand in columns.
const FAILED: f64 = -1.0;
/// State of a point whose unknowns of this block are found.
const SOLVED: f64 = 0.0;
/// State of a point that takes further steps.
const OPEN: f64 = 1.0;

/// Solver of a system at many points.
#[derive(Debug)]
pub(super) struct BatchSolver {
    stages: Stages,
    blocks: Vec<BlockSolver>,
    /// Column, index among the variables, and nominal value of every given variable.
    given: Vec<(usize, usize, f64)>,
    /// Columns of the unknowns.
    unknowns: Vec<usize>,
    /// Product of the signs of all pivots at the nominal state.
    sign: f64,
}

/// Solver of one block.
#[derive(Debug)]
struct BlockSolver {
    equations: Vec<usize>,
    /// Unknown of every row of the solution.
    unknowns: Vec<usize>,
    elimination: Elimination,
    /// True if no derivative depends on the unknowns of the block.
    linear: bool,
}

/// Memory for `W` points.
pub(super) struct Workspace<const W: usize> {
    lanes: Lanes<W>,
    /// Entries of the Jacobian of a block, of the last pass whose derivatives were used.
    entries: Vec<Column<W>>,
    factors: Vec<Column<W>>,
    right: Vec<Column<W>>,
    spare: Column<W>,
    predicted: Vec<Column<W>>,
    progress: Progress<W>,
    signs: [f64; W],
    pivots: [f64; W],
}

/// Progress of the search at every point.
#[derive(Debug)]
struct Progress<const W: usize> {
    state: [f64; W],
    /// Length of the last step.
    last: [f64; W],
    /// Length of the next step, in scales.
    length: [f64; W],
    /// Largest residual, in scales.
    residual: [f64; W],
    /// 1 where the next pass needs derivatives.
    fresh: [f64; W],
    /// 1 where the step is taken.
    taken: [f64; W],
    /// Greatest length of a step as a part of the step before, over all steps of all blocks that are longer than `NEAR`.
    contraction: [f64; W],
    /// Greatest factor by which a pivot differs from that of the nominal state.
    change: [f64; W],
}

impl BatchSolver {
    /// Creates the solver. Returns None if the equations have no block-triangular order, or if a block is too large.
    pub(super) fn new(system: &System, set: &FormulaSet, anchor: &Anchor) -> Option<Self> {
        let (mut expressions, values) = Expressions::new(set, &system.formulas);
        let residuals = residuals(&mut expressions, &values, &system.conditions);
        let first = system.given;
        // The structure: unknowns in the values of the equations, and in their derivatives.
        let uses: Vec<Vec<usize>> = (residuals.iter())
            .map(|&residual| expressions.variables(residual).iter().filter_map(|at| at.checked_sub(first)).collect())
            .collect();
        let mut users = vec![Vec::new(); system.len()];
        uses.iter().enumerate().for_each(|(row, uses)| uses.iter().for_each(|&unknown| users[unknown].push(row)));
        let mut entries = vec![Vec::new(); system.len()];
        for (unknown, users) in users.iter().enumerate() {
            let of: Vec<Expression> = users.iter().map(|&row| residuals[row]).collect();
            for (&row, slope) in users.iter().zip(expressions.slopes(&of, first + unknown)) {
                entries[row].extend(slope.map(|slope| (unknown, slope)));
            }
        }
        let slopes = entries.iter().map(|row| row.iter().map(|(unknown, _)| *unknown).collect()).collect();
        let order = Structure { slopes, uses }.blocks()?;
        if order.iter().any(|block| block.unknowns.len() > LARGEST) {
            return None;
        }
        // Each block is a stage.
        let jacobian = system.jacobian(&anchor.given, &anchor.u, &anchor.scales);
        let (mut blocks, mut asked, mut stage_of) = (Vec::new(), Vec::new(), vec![0; system.len()]);
        for (stage, block) in order.into_iter().enumerate() {
            block.unknowns.iter().for_each(|&unknown| stage_of[unknown] = stage + 1);
            let mut of_block = StageExpressions::default();
            let mut matrix = Vec::new();
            for (row, &equation) in block.equations.iter().enumerate() {
                of_block.values.push(residuals[equation]);
                for &(unknown, slope) in &entries[equation] {
                    let Ok(column) = block.unknowns.binary_search(&unknown) else { continue };
                    let scale = anchor.scales.unknowns[unknown] / anchor.scales.equations[equation];
                    let nominal = jacobian[(equation, unknown)];
                    matrix.push((row, column, nominal, nominal * scale));
                    of_block.slopes.push(slope);
                }
            }
            let own = |variable: usize| variable.checked_sub(first).is_some_and(|at| block.unknowns.contains(&at));
            let linear = !of_block.slopes.iter().any(|&slope| expressions.variables(slope).into_iter().any(own));
            let elimination = Elimination::new(block.unknowns.len(), &matrix)?;
            let mut unknowns = vec![0; block.unknowns.len()];
            elimination.unknowns().for_each(|(row, column)| unknowns[row] = block.unknowns[column]);
            blocks.push(BlockSolver { equations: block.equations, unknowns, elimination, linear });
            asked.push(of_block);
        }
        let stage_of = |variable: usize| variable.checked_sub(first).map_or(0, |unknown| stage_of[unknown]);
        let stages = Stages::new(&expressions, &asked, stage_of);
        let given = system.uses.iter().map(|&index| Some((stages.variable(index)?, index, anchor.given[index])));
        let unknowns = (first..first + system.len()).map(|index| stages.variable(index));
        Some(Self {
            given: given.collect::<Option<_>>()?,
            unknowns: unknowns.collect::<Option<_>>()?,
            sign: blocks.iter().map(|block| block.elimination.sign).product(),
            stages,
            blocks,
        })
    }

    /// Returns memory for `W` points.
    pub(super) fn workspace<const W: usize>(&self) -> Workspace<W> {
        let columns = |count: usize| -> Vec<Column<W>> { vec![Box::new([0.0; W]); count] };
        let most = |of: fn(&BlockSolver) -> usize| self.blocks.iter().map(of).max().unwrap_or(0);
        let entries = (self.stages.stages().iter()).map(|stage| stage.slope_columns.len()).max().unwrap_or(0);
        Workspace {
            lanes: self.stages.lanes(),
            entries: columns(entries),
            factors: columns(most(|block| block.elimination.factors)),
            right: columns(most(|block| block.equations.len())),
            spare: Box::new([0.0; W]),
            predicted: columns(self.unknowns.len()),
            progress: Progress {
                state: [OPEN; W],
                last: [0.0; W],
                length: [0.0; W],
                residual: [0.0; W],
                fresh: [0.0; W],
                taken: [0.0; W],
                contraction: [0.0; W],
                change: [1.0; W],
            },
            signs: [0.0; W],
            pivots: [0.0; W],
        }
    }

    /// Sets the variables of one point. `value` returns a variable, from its index and its nominal value.
    pub(super) fn load<const W: usize>(
        &self,
        workspace: &mut Workspace<W>,
        lane: usize,
        value: impl Fn(usize, f64) -> f64,
    ) {
        for &(column, index, nominal) in &self.given {
            workspace.lanes.column_mut(column)[lane] = value(index, nominal);
        }
    }

    /// Solves the equations at all loaded points.
    pub(super) fn solve<const W: usize>(&self, system: &System, anchor: &Anchor, workspace: &mut Workspace<W>) {
        on_this_processor(Predict { solver: self, system, anchor, workspace });
        workspace.progress.state = [OPEN; W];
        (workspace.progress.contraction, workspace.progress.change) = ([0.0; W], [1.0; W]);
        workspace.signs = [1.0; W];
        self.stages.run_first(&mut workspace.lanes);
        for stage in 0..self.blocks.len() {
            self.solve_block(stage, system, anchor, workspace);
        }
        on_this_processor(Accept { solver: self, anchor, workspace });
    }

    /// Solves one block, once the blocks before it are solved.
    fn solve_block<const W: usize>(
        &self,
        stage: usize,
        system: &System,
        anchor: &Anchor,
        workspace: &mut Workspace<W>,
    ) {
        let block = &self.blocks[stage];
        let columns = &self.stages.stages()[stage];
        let progress = &mut workspace.progress;
        (progress.last, progress.fresh) = ([f64::INFINITY; W], [1.0; W]);
        // A point that failed in an earlier block stays failed. The others begin anew.
        progress.state.iter_mut().for_each(|state| *state = if *state == FAILED { FAILED } else { OPEN });
        for pass in 0..STEPS {
            self.stages.run(stage, Part::Values, &mut workspace.lanes);
            if pass == 0 || workspace.progress.fresh.contains(&1.0) {
                self.stages.run(stage, Part::Slopes, &mut workspace.lanes);
                on_this_processor(Refresh { columns: &columns.slope_columns, workspace });
                let factors = &mut workspace.factors[..block.elimination.factors];
                factors
                    .iter_mut()
                    .zip(&workspace.entries)
                    .for_each(|(factor, entry)| factor.copy_from_slice(&entry[..]));
                block.elimination.factorise(factors, &mut workspace.spare, &mut workspace.pivots);
            }
            for (right, &column) in workspace.right.iter_mut().zip(&columns.value_columns) {
                right.copy_from_slice(workspace.lanes.column(column));
            }
            on_this_processor(Measure {
                scales: &anchor.scales.equations,
                of: &block.equations,
                workspace,
                residual: true,
            });
            block.elimination.solve(&workspace.factors, &mut workspace.right, &mut workspace.spare);
            on_this_processor(Measure {
                scales: &anchor.scales.unknowns,
                of: &block.unknowns,
                workspace,
                residual: false,
            });
            on_this_processor(Judge { progress: &mut workspace.progress, linear: block.linear });
            on_this_processor(Move { block, columns: &self.unknowns, system, workspace });
            if pass == 0 && anchor.bends {
                for &unknown in &block.unknowns {
                    let found = workspace.lanes.column(self.unknowns[unknown]);
                    workspace.predicted[unknown].copy_from_slice(found);
                }
            }
            if !workspace.progress.state.contains(&OPEN) {
                break;
            }
        }
        // A point that is still open takes too many steps.
        for lane in 0..W {
            let progress = &mut workspace.progress;
            progress.state[lane] = if progress.state[lane] == SOLVED { SOLVED } else { FAILED };
            workspace.signs[lane] *= workspace.pivots[lane];
        }
        block.elimination.measure_changes(&workspace.factors, &mut workspace.progress.change);
        self.stages.run(stage, Part::Last, &mut workspace.lanes);
    }

    /// Writes the unknowns of one point into `u`. Returns false if they were not found.
    pub(super) fn solution<const W: usize>(&self, workspace: &Workspace<W>, lane: usize, u: &mut [f64]) -> bool {
        let columns = u.iter_mut().zip(&self.unknowns);
        columns.for_each(|(u, &column)| *u = workspace.lanes.column(column)[lane]);
        workspace.progress.state[lane] == SOLVED
    }
}

/// Returns the value of every equation.
fn residuals(expressions: &mut Expressions, values: &[Expression], conditions: &[Kind]) -> Vec<Expression> {
    let (mut residuals, mut next) = (Vec::new(), 0);
    for kind in conditions {
        match *kind {
            Kind::Equation => {
                residuals.push(values[next]);
                next += 1;
            }
            Kind::Loop { links } => {
                for function in [Unary::Cos, Unary::Sin] {
                    let parts = values[next..next + 2 * links].chunks_exact(2).map(|link| {
                        let direction = expressions.unary(function, link[1]);
                        expressions.binary(Binary::Multiply, link[0], direction)
                    });
                    let parts: Vec<Expression> = parts.collect();
                    let sum = parts.into_iter().reduce(|sum, part| expressions.binary(Binary::Add, sum, part));
                    residuals.push(sum.expect("a loop has a link"));
                }
                next += 2 * links;
            }
        }
    }
    residuals
}

/// Start of the search: the nominal solution and its linear change, within the bounds of the unknowns.
struct Predict<'a, const W: usize> {
    solver: &'a BatchSolver,
    system: &'a System,
    anchor: &'a Anchor,
    workspace: &'a mut Workspace<W>,
}

impl<const W: usize> Work for Predict<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { solver, system, anchor, workspace } = self;
        for (unknown, start) in workspace.predicted.iter_mut().enumerate() {
            start.fill(anchor.u[unknown]);
            for (k, &(column, _, nominal)) in solver.given.iter().enumerate() {
                let slope = anchor.slopes[(unknown, k)];
                if slope != 0.0 {
                    let given = workspace.lanes.column(column);
                    start.iter_mut().zip(given).for_each(|(start, given)| *start += slope * (given - nominal));
                }
            }
            let [lower, upper] = system.unknowns[unknown].bounds();
            start.iter_mut().for_each(|start| *start = start.max(lower).min(upper));
            workspace.lanes.column_mut(solver.unknowns[unknown]).copy_from_slice(&start[..]);
        }
    }
}

/// Update of the Jacobian where the next step needs it.
struct Refresh<'a, const W: usize> {
    columns: &'a [usize],
    workspace: &'a mut Workspace<W>,
}

impl<const W: usize> Work for Refresh<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Workspace { entries, lanes, progress, .. } = self.workspace;
        for (entry, &column) in entries.iter_mut().zip(self.columns) {
            for ((entry, &new), &fresh) in entry.iter_mut().zip(lanes.column(column)).zip(&progress.fresh) {
                *entry = if fresh == 1.0 { new } else { *entry };
            }
        }
    }
}

/// Measurement of the residuals or of the steps: the largest one in scales, NaN if one has no value.
struct Measure<'a, const W: usize> {
    scales: &'a [f64],
    /// Equation or unknown of every row.
    of: &'a [usize],
    workspace: &'a mut Workspace<W>,
    residual: bool,
}

impl<const W: usize> Work for Measure<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Progress { residual, length, .. } = &mut self.workspace.progress;
        let largest = if self.residual { residual } else { length };
        largest.fill(0.0);
        for (row, &index) in self.of.iter().enumerate() {
            let inverse = 1.0 / self.scales[index];
            for (largest, &value) in largest.iter_mut().zip(&*self.workspace.right[row]) {
                let size = (value * inverse).abs();
                // A comparison with NaN fails, so that NaN stays.
                *largest = if size <= *largest { *largest } else { size };
            }
        }
    }
}

/// Decision on every step.
struct Judge<'a, const W: usize> {
    progress: &'a mut Progress<W>,
    linear: bool,
}

impl<const W: usize> Work for Judge<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Progress { state, last, length, residual, fresh, taken, contraction, .. } = self.progress;
        for lane in 0..W {
            let (step, before) = (length[lane], last[lane]);
            let open = state[lane] == OPEN;
            // The error after this step is at most a few squares of it by the step before, or all of it is rounding.
            let settled = (step <= ROUNDING) | (CURVED * step * step <= ROUNDING * before) | (step > SHORTER * before);
            let settled = settled & (step <= FOUND) & (residual[lane] < NEAR);
            let shorter = (step <= SHORTER * before) & (step <= REACH);
            let go_on = if shorter { OPEN } else { FAILED };
            let next = if settled { SOLVED } else { go_on };
            state[lane] = if open { next } else { state[lane] };
            taken[lane] = if open & (next >= SOLVED) { 1.0 } else { 0.0 };
            // Derivatives that are as near as this serve all further steps.
            fresh[lane] = if open & (next == OPEN) & (step >= NEAR) & !self.linear { 1.0 } else { 0.0 };
            // Between shorter steps rounding decides. Before the first one stands infinity, which makes the ratio 0.
            let ratio = if before >= NEAR { step / before } else { 0.0 };
            contraction[lane] = if open & (ratio > contraction[lane]) { ratio } else { contraction[lane] };
            last[lane] = step;
        }
    }
}

/// Step of the unknowns of a block. A point that leaves the bounds fails.
struct Move<'a, const W: usize> {
    block: &'a BlockSolver,
    columns: &'a [usize],
    system: &'a System,
    workspace: &'a mut Workspace<W>,
}

impl<const W: usize> Work for Move<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Workspace { lanes, right, progress, .. } = self.workspace;
        for (row, &unknown) in self.block.unknowns.iter().enumerate() {
            let [lower, upper] = self.system.unknowns[unknown].bounds();
            let values = lanes.column_mut(self.columns[unknown]);
            for (lane, (value, &step)) in values.iter_mut().zip(&*right[row]).enumerate() {
                let moved = if progress.taken[lane] == 1.0 { *value - step } else { *value };
                let within = (lower <= moved) & (moved <= upper);
                progress.state[lane] = if within { progress.state[lane] } else { FAILED };
                *value = if within { moved } else { *value };
            }
        }
    }
}

/// Acceptance of the roots that are near their predictions, on the branch of the nominal state.
///
/// A clearance that is 0 at the nominal sizes has no slope, so that a float moves the assembly without a prediction. The root then counts as
/// near if its steps and pivots show that no other one is close.
struct Accept<'a, const W: usize> {
    solver: &'a BatchSolver,
    anchor: &'a Anchor,
    workspace: &'a mut Workspace<W>,
}

impl<const W: usize> Work for Accept<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { solver, anchor, workspace } = self;
        let (mut way, mut off) = ([0.0f64; W], [0.0f64; W]);
        for (unknown, &column) in solver.unknowns.iter().enumerate() {
            let (nominal, inverse) = (anchor.u[unknown], 1.0 / anchor.scales.unknowns[unknown]);
            let (predicted, found) = (&workspace.predicted[unknown], workspace.lanes.column(column));
            for lane in 0..W {
                way[lane] = way[lane].max(((predicted[lane] - nominal) * inverse).abs());
                off[lane] = off[lane].max(((found[lane] - predicted[lane]) * inverse).abs());
            }
        }
        for lane in 0..W {
            let Progress { state, contraction, change, .. } = &mut workspace.progress;
            let near = off[lane] <= OFF * way[lane] + SLACK;
            let alone = (off[lane] <= NEIGHBOURHOOD) & (contraction[lane] <= CONTRACTING) & (change[lane] <= ALIKE);
            let state = &mut state[lane];
            *state = if (near | alone) & (workspace.signs[lane] == solver.sign) { *state } else { FAILED };
        }
    }
}
