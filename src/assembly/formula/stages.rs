//! Programs in stages for equations that are solved block by block, at many points side by side.
//!
//! A stage holds the operations that depend on the variables of its own block and of earlier blocks only. Values of earlier stages are
//! computed once for each point. Every operation takes whole columns, one number for each point, so that the arithmetic of a point does
//! not depend on its neighbours.

use crate::assembly::formula::functions::{Binary, Unary, for_each_binary, select};
use crate::assembly::formula::graph::{Graph, GraphNode, NodeId};
use crate::assembly::formula::set::FormulaSet;
use sensitol_numeric::elementary::{self, Elementary, Work, on_this_processor};

/// Column of one number for each of `W` points.
pub(crate) type Column<const W: usize> = Box<[f64; W]>;

/// Value in a graph of expressions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Expression(NodeId);

/// Graph of the expressions that some formulas need, to which sums and derivatives can be added.
#[derive(Debug, Default)]
pub(crate) struct Expressions {
    graph: Graph,
}

impl Expressions {
    /// Copies some formulas of a set. Returns the graph and the value of each formula.
    pub(crate) fn new(set: &FormulaSet, formulas: &[usize]) -> (Self, Vec<Expression>) {
        let roots: Vec<NodeId> = formulas.iter().map(|&formula| set.roots[formula]).collect();
        let needed = set.graph.needed(roots.iter().copied());
        let (mut graph, mut places) = (Graph::default(), vec![0; needed.len()]);
        for (id, &node) in set.graph.nodes().iter().enumerate().filter(|(id, _)| needed[*id]) {
            let at = |operand: NodeId| places[operand as usize];
            places[id] = match node {
                GraphNode::Constant(bits) => graph.constant(f64::from_bits(bits)),
                GraphNode::Variable(index) => graph.variable(index),
                GraphNode::Unary(function, a) => graph.unary(function, at(a)),
                GraphNode::Binary(function, a, b) => graph.binary(function, at(a), at(b)),
                GraphNode::If(condition, then, otherwise) => graph.branch(at(condition), at(then), at(otherwise)),
            };
        }
        let values = roots.into_iter().map(|root| Expression(places[root as usize])).collect();
        (Self { graph }, values)
    }

    pub(crate) fn unary(&mut self, function: Unary, a: Expression) -> Expression {
        Expression(self.graph.unary(function, a.0))
    }

    pub(crate) fn binary(&mut self, function: Binary, a: Expression, b: Expression) -> Expression {
        Expression(self.graph.binary(function, a.0, b.0))
    }

    /// Returns the variables that an expression can depend on, ascending.
    pub(crate) fn variables(&self, expression: Expression) -> Vec<usize> {
        self.graph.variables(expression.0)
    }

    /// Returns the derivatives of expressions by a variable, None for one that is 0 everywhere. At a kink a derivative is NaN.
    pub(crate) fn slopes(&mut self, of: &[Expression], variable: usize) -> Vec<Option<Expression>> {
        let roots: Vec<NodeId> = of.iter().map(|expression| expression.0).collect();
        self.graph.slopes(&roots, variable).into_iter().map(|slope| slope.map(Expression)).collect()
    }
}

/// Expressions of one stage that its block requests.
#[derive(Debug, Default)]
pub(crate) struct StageExpressions {
    /// Values, which every pass computes.
    pub(crate) values: Vec<Expression>,
    /// Derivatives, which only some passes compute.
    pub(crate) slopes: Vec<Expression>,
}

/// Operation on columns.
#[derive(Debug, Clone, Copy)]
struct Step {
    operation: Operation,
    /// Columns of the operands. Unused ones repeat the first one.
    from: [u32; 3],
    to: u32,
}

#[derive(Debug, Clone, Copy)]
enum Operation {
    Unary(Unary),
    Binary(Binary),
    If,
}

/// Operations of one stage.
#[derive(Debug, Default)]
pub(crate) struct Stage {
    values: Vec<Step>,
    slopes: Vec<Step>,
    /// Operations that later stages need, to be run once at the solution of the block.
    last: Vec<Step>,
    /// Columns of the values and of the derivatives.
    pub(crate) value_columns: Vec<usize>,
    pub(crate) slope_columns: Vec<usize>,
}

/// Part of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// Values of the block.
    Values,
    /// Derivatives of the block. The values must have been computed at the same state.
    Slopes,
    /// Values for later stages.
    Last,
}

/// Programs of all stages on a common set of columns.
#[derive(Debug)]
pub(crate) struct Stages {
    columns: usize,
    constants: Vec<(usize, f64)>,
    /// Columns of the variables.
    variables: Vec<(usize, usize)>,
    /// Operations that depend on no block.
    first: Vec<Step>,
    stages: Vec<Stage>,
}

/// Columns of `W` points, on which the programs run.
#[derive(Debug)]
pub(crate) struct Lanes<const W: usize> {
    columns: Vec<Column<W>>,
    spare: Column<W>,
}

impl Stages {
    /// Compiles the programs of some stages. `stage_of` returns the stage of a variable, counted from 1; 0 is a variable that is known.
    pub(crate) fn new(
        expressions: &Expressions,
        asked: &[StageExpressions],
        stage_of: impl Fn(usize) -> usize,
    ) -> Self {
        let graph = &expressions.graph;
        let count = graph.nodes().len();
        let ids = |all: &[Expression]| all.iter().map(|expression| expression.0).collect::<Vec<NodeId>>();
        let of_stage: Vec<[Vec<bool>; 2]> =
            (asked.iter()).map(|asked| [&asked.values, &asked.slopes].map(|all| graph.needed(ids(all)))).collect();
        let mut stages = vec![0; count];
        for id in 0..count {
            stages[id] = match graph.nodes()[id] {
                GraphNode::Variable(index) => stage_of(index),
                node => node.operands().map(|operand| stages[operand as usize]).max().unwrap_or(0),
            };
        }
        let needed_by = |block: usize, id: usize| of_stage[block].iter().any(|needed| needed[id]);
        // A column outlives its stage if another stage uses it.
        let mut shared = vec![false; count];
        for id in (0..count).filter(|&id| (0..asked.len()).any(|block| needed_by(block, id))) {
            for operand in graph.nodes()[id].operands() {
                shared[operand as usize] |= stages[operand as usize] != stages[id];
            }
        }
        for (block, asked) in asked.iter().enumerate() {
            for id in ids(&asked.values).into_iter().chain(ids(&asked.slopes)) {
                shared[id as usize] |= stages[id as usize] != block + 1;
            }
        }
        let mut emitter = Emitter::new(graph, &shared, (0..count).map(|id| (0..asked.len()).any(|b| needed_by(b, id))));
        let operations = |keep: &dyn Fn(usize) -> bool| -> Vec<NodeId> {
            let computed = |&id: &usize| graph.nodes()[id].operands().next().is_some() && keep(id);
            (0..count).filter(computed).map(|id| id as NodeId).collect()
        };
        let later = |stage: usize, id: usize| stages[id] == stage && (stage..asked.len()).any(|b| needed_by(b, id));
        let [first] = emitter.group([&operations(&|id| later(0, id))], &[]).0;
        let mut programs = Vec::with_capacity(asked.len());
        for (block, asked) in asked.iter().enumerate() {
            let [of_values, of_slopes] = &of_stage[block];
            let own = |id: usize| stages[id] == block + 1;
            let values = operations(&|id| own(id) && of_values[id]);
            let slopes = operations(&|id| own(id) && of_slopes[id] && !of_values[id]);
            let kept = [ids(&asked.values), ids(&asked.slopes)];
            let ([values, slopes], columns) = emitter.group([&values, &slopes], &kept);
            let [last] = emitter.group([&operations(&|id| later(block + 1, id))], &[]).0;
            let [value_columns, slope_columns] = <[Vec<usize>; 2]>::try_from(columns).expect("two lists are kept");
            programs.push(Stage { values, slopes, last, value_columns, slope_columns });
        }
        emitter.finish(first, programs)
    }

    /// Returns the stages, of which block 0 has the first one.
    pub(crate) fn stages(&self) -> &[Stage] {
        &self.stages
    }

    /// Returns the column of a variable, or None if no stage uses it.
    pub(crate) fn variable(&self, index: usize) -> Option<usize> {
        self.variables.iter().find(|(variable, _)| *variable == index).map(|&(_, column)| column)
    }

    /// Returns columns whose constants are set.
    pub(crate) fn lanes<const W: usize>(&self) -> Lanes<W> {
        let mut lanes = Lanes { columns: vec![Box::new([f64::NAN; W]); self.columns], spare: Box::new([0.0; W]) };
        self.constants.iter().for_each(|&(column, value)| lanes.columns[column].fill(value));
        lanes
    }

    /// Runs the operations that depend on no block.
    pub(crate) fn run_first<const W: usize>(&self, lanes: &mut Lanes<W>) {
        lanes.run(&self.first);
    }

    /// Runs a part of a stage.
    pub(crate) fn run<const W: usize>(&self, stage: usize, part: Part, lanes: &mut Lanes<W>) {
        let stage = &self.stages[stage];
        lanes.run(match part {
            Part::Values => &stage.values,
            Part::Slopes => &stage.slopes,
            Part::Last => &stage.last,
        });
    }
}

/// Assignment of columns to operations.
struct Emitter<'g> {
    graph: &'g Graph,
    /// Columns of constants, variables and shared operations.
    fixed: Vec<Option<usize>>,
    /// Number of these columns.
    permanent: usize,
    columns: usize,
}

impl<'g> Emitter<'g> {
    fn new(graph: &'g Graph, shared: &[bool], needed: impl Iterator<Item = bool>) -> Self {
        let mut next = 0;
        let mut fixed = vec![None; shared.len()];
        for (id, needed) in needed.enumerate() {
            if needed && (shared[id] || graph.nodes()[id].operands().next().is_none()) {
                fixed[id] = Some(next);
                next += 1;
            }
        }
        Self { graph, fixed, permanent: next, columns: next }
    }

    /// Emits lists of operations that run one after the other. Columns are used again after their last use, except those of `kept` nodes,
    /// whose columns are returned.
    fn group<const N: usize>(
        &mut self,
        lists: [&[NodeId]; N],
        kept: &[Vec<NodeId>],
    ) -> ([Vec<Step>; N], Vec<Vec<usize>>) {
        let mut last_use = vec![0; self.fixed.len()];
        for (clock, &id) in lists.iter().copied().flatten().enumerate() {
            self.graph.nodes()[id as usize].operands().for_each(|operand| last_use[operand as usize] = clock);
        }
        kept.iter().flatten().for_each(|&id| last_use[id as usize] = usize::MAX);
        let (mut place, mut free, mut clock) = (self.fixed.clone(), Vec::new(), 0);
        let mut next = self.permanent;
        let steps = lists.map(|list| {
            list.iter()
                .map(|&id| {
                    let node = self.graph.nodes()[id as usize];
                    let to = *place[id as usize].get_or_insert_with(|| {
                        free.pop().unwrap_or_else(|| {
                            next += 1;
                            next - 1
                        })
                    });
                    let of = |operand: NodeId| place[operand as usize].expect("operands come first");
                    // A free column is handed out once, even if an operation has it twice.
                    let mut freed: Vec<usize> = (node.operands())
                        .filter(|&operand| {
                            last_use[operand as usize] == clock && self.fixed[operand as usize].is_none()
                        })
                        .map(of)
                        .collect();
                    freed.sort_unstable();
                    freed.dedup();
                    free.extend(freed);
                    clock += 1;
                    let step = |operation, from: [NodeId; 3]| Step {
                        operation,
                        from: from.map(|operand| of(operand) as u32),
                        to: to as u32,
                    };
                    match node {
                        GraphNode::Unary(function, a) => step(Operation::Unary(function), [a; 3]),
                        GraphNode::Binary(function, a, b) => step(Operation::Binary(function), [a, b, a]),
                        GraphNode::If(condition, then, otherwise) => step(Operation::If, [condition, then, otherwise]),
                        GraphNode::Constant(_) | GraphNode::Variable(_) => unreachable!("no operation"),
                    }
                })
                .collect()
        });
        self.columns = self.columns.max(next);
        let columns = |ids: &Vec<NodeId>| {
            ids.iter().map(|&id| place[id as usize].expect("a kept node is computed")).collect::<Vec<usize>>()
        };
        (steps, kept.iter().map(columns).collect())
    }

    fn finish(self, first: Vec<Step>, stages: Vec<Stage>) -> Stages {
        let (mut constants, mut variables) = (Vec::new(), Vec::new());
        for (node, column) in self.graph.nodes().iter().zip(&self.fixed) {
            match (node, column) {
                (GraphNode::Constant(bits), &Some(column)) => constants.push((column, f64::from_bits(*bits))),
                (GraphNode::Variable(index), &Some(column)) => variables.push((*index, column)),
                _ => {}
            }
        }
        Stages { columns: self.columns, constants, variables, first, stages }
    }
}

impl<const W: usize> Lanes<W> {
    pub(crate) fn column(&self, column: usize) -> &[f64; W] {
        &self.columns[column]
    }

    pub(crate) fn column_mut(&mut self, column: usize) -> &mut [f64; W] {
        &mut self.columns[column]
    }

    fn run(&mut self, steps: &[Step]) {
        if !steps.is_empty() {
            on_this_processor(RunSteps { steps, lanes: self });
        }
    }
}

struct RunSteps<'a, const W: usize> {
    steps: &'a [Step],
    lanes: &'a mut Lanes<W>,
}

impl<const W: usize> Work for RunSteps<'_, W> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Lanes { columns, spare } = self.lanes;
        for step in self.steps {
            // No operation writes to one of its own operands, so that the result can stand outside the columns meanwhile.
            std::mem::swap(spare, &mut columns[step.to as usize]);
            let [a, b, c] = step.from.map(|column| &*columns[column as usize]);
            match step.operation {
                Operation::Unary(function) => unary(function, a, spare),
                Operation::Binary(function) => binary(function, a, b, spare),
                Operation::If => {
                    for lane in 0..W {
                        spare[lane] = select(a[lane], b[lane], c[lane]);
                    }
                }
            }
            std::mem::swap(spare, &mut columns[step.to as usize]);
        }
    }
}

/// Applies a function, with a separate loop for each one, so that the compiler can optimise it.
#[inline(always)]
fn unary<const W: usize>(function: Unary, a: &[f64; W], out: &mut [f64; W]) {
    macro_rules! each {
        ($($name:ident),*; $($block:ident),*) => {
            match function {
                $(Unary::$name => out.iter_mut().zip(a).for_each(|(out, &x)| *out = Unary::$name.apply(x)),)*
                $(Unary::$block => elementary::$block::map_inline(a, out),)*
            }
        };
    }
    each!(
        Negate, Abs, Sqrt, Log10, Asin, Atan, Sinh, Cosh, Tanh, Floor, Ceil, Sign;
        Exp, Ln, Sin, Cos, Tan, Acos
    );
}

/// Applies a function of two operands like `unary`.
#[inline(always)]
fn binary<const W: usize>(function: Binary, a: &[f64; W], b: &[f64; W], out: &mut [f64; W]) {
    for_each_binary!(function, FUNCTION => {
        out.iter_mut().zip(a).zip(b).for_each(|((out, &x), &y)| *out = FUNCTION.apply(x, y))
    });
}
