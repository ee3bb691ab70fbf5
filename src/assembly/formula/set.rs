//! Named formulas that use each other, variables and constants.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use super::batch::{LANES, Machine};
use super::cancel::cancelled;
use super::error::{FailureReason, FormulaError, FormulaFailure, FormulaFault};
use super::functions::{Binary, select};
use super::graph::{Graph, NodeId};
use super::interval::Interval;
use super::jet::Jet;
use super::margins::Margins;
use super::parser::{Formula, Node};
use super::program::Program;
use super::scalar::Scalar;
use super::slopes::Sloped;
use crate::assembly::Bounds;
use sensitol_numeric::names::nearest;

/// The meaning of a name that is not a formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meaning {
    /// The column of this index.
    Variable(usize),
    /// A number.
    Constant(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reference {
    Outside(Meaning),
    Formula(usize),
}

/// Formulas in any order, resolved against each other.
///
/// Only what the asked formulas need is computed, common parts once. Cost: a formula of `n` operations takes about
/// `n` passes over blocks of 256 rows.
///
/// ```
/// use sensitol::assembly::formula::Formula;
/// use sensitol::assembly::formula::set::{FormulaSet, Meaning};
/// let formulas = vec![
///     ("gap".to_owned(), Formula::parse("height - 2*play")?),
///     ("height".to_owned(), Formula::parse("a^2")?),
/// ];
/// let names = [("a", Meaning::Variable(0)), ("play", Meaning::Constant(0.5))];
/// let set = FormulaSet::new(formulas, names).map_err(|(_, error)| error)?;
/// let mut gaps = [0.0; 2];
/// set.evaluate(&[0], 2, |_variable| &[3.0, 4.0], |_formula, row, gap| gaps[row] = gap);
/// assert_eq!(gaps, [8.0, 15.0]);
/// assert_eq!(set.variables(0), [0]);
/// # Ok::<(), sensitol::assembly::formula::FormulaError>(())
/// ```
#[derive(Debug)]
pub struct FormulaSet {
    pub(super) formulas: Vec<Entry>,
    /// Formulas before those that use them.
    pub(super) order: Vec<usize>,
    pub(super) graph: Graph,
    pub(super) roots: Vec<NodeId>,
    /// The variables of every formula, once they were asked for.
    variables: Vec<OnceLock<Vec<usize>>>,
    /// For every formula the node of the graph that each of its own nodes became.
    pub(super) places: Vec<Vec<NodeId>>,
    /// Where some formulas change their form, kept for the same reason as the program.
    pub(super) margins: Mutex<Option<(Vec<usize>, Arc<Margins>)>>,
    /// The last program, since the same outputs are asked again and again.
    program: Mutex<Option<(Vec<usize>, Arc<Program>)>>,
    /// The last program of bounds, whose sums are without what cancels.
    bounding: Mutex<Option<(usize, Arc<Program>)>>,
}

/// Formulas that are run on one point at a time.
#[derive(Debug, Clone)]
pub struct Routine(Arc<Program>);

impl Routine {
    /// Every formula on what `variable` returns; `room` is what one run leaves to the next.
    pub(crate) fn run<S: Scalar>(&self, variable: &impl Fn(usize) -> S, room: &mut Vec<S>) -> Vec<S> {
        self.0.evaluate(variable, room)
    }
}

#[derive(Debug)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) formula: Formula,
    /// The meanings of the names among the formula's nodes.
    pub(super) references: HashMap<usize, Reference>,
}

impl FormulaSet {
    /// Resolves every name.
    ///
    /// # Errors
    /// The index of the formula at fault, with an undefined name or a cycle.
    pub fn new<'n>(
        formulas: Vec<(String, Formula)>,
        meanings: impl IntoIterator<Item = (&'n str, Meaning)>,
    ) -> Result<Self, (usize, FormulaError)> {
        let named = formulas.len();
        Self::with_unnamed(formulas, named, meanings)
    }

    /// The same, but that only the first `named` formulas can be used by the others: the rest bear a name for errors.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(crate) fn with_unnamed<'n>(
        formulas: Vec<(String, Formula)>,
        named: usize,
        meanings: impl IntoIterator<Item = (&'n str, Meaning)>,
    ) -> Result<Self, (usize, FormulaError)> {
        let mut known: HashMap<String, Reference> =
            meanings.into_iter().map(|(name, meaning)| (name.to_owned(), Reference::Outside(meaning))).collect();
        for (index, (name, _)) in formulas[..named].iter().enumerate() {
            known.insert(name.clone(), Reference::Formula(index));
        }
        let mut entries = Vec::with_capacity(formulas.len());
        for (index, (name, formula)) in formulas.into_iter().enumerate() {
            let references = resolve(&formula, &known).map_err(|error| (index, error))?;
            entries.push(Entry { name, formula, references });
        }
        let order = order(&entries)?;
        let mut graph = Graph::default();
        let mut roots = vec![0; entries.len()];
        let mut places = vec![Vec::new(); entries.len()];
        for &index in &order {
            places[index] = entries[index].add_to(&mut graph, &roots);
            roots[index] = *places[index].last().expect("a formula is never empty");
        }
        let (margins, program, bounding) = (Mutex::new(None), Mutex::new(None), Mutex::new(None));
        let variables = vec![OnceLock::new(); roots.len()];
        Ok(Self { formulas: entries, order, graph, roots, variables, places, margins, program, bounding })
    }

    /// Number of formulas.
    pub fn len(&self) -> usize {
        self.formulas.len()
    }

    /// Numbers, names, functions and operators of all formulas together.
    pub(crate) fn parts(&self) -> usize {
        self.formulas.iter().map(|entry| entry.formula.nodes.len()).sum()
    }

    /// Whether there are no formulas.
    pub fn is_empty(&self) -> bool {
        self.formulas.is_empty()
    }

    /// The variables that a formula can depend on, through other formulas too, ascending.
    pub fn variables(&self, formula: usize) -> &[usize] {
        self.variables[formula].get_or_init(|| self.graph.variables(self.roots[formula]))
    }

    /// The formulas that these formulas use, themselves included, as a flag per formula.
    pub fn used(&self, by: impl IntoIterator<Item = usize>) -> Vec<bool> {
        let mut used = vec![false; self.len()];
        for formula in by {
            used[formula] = true;
        }
        for &index in self.order.iter().rev() {
            if used[index] {
                self.formulas[index].uses().for_each(|formula| used[formula] = true);
            }
        }
        used
    }

    /// Evaluates some formulas on `rows` rows; `variable` gives a variable's column, `result` gets the position in
    /// `formulas`, the row and the value, which is NaN or infinite where there is none.
    pub fn evaluate<'v>(
        &self,
        formulas: &[usize],
        rows: usize,
        variable: impl Fn(usize) -> &'v [f64],
        mut result: impl FnMut(usize, usize, f64),
    ) {
        self.evaluate_blocks(formulas, rows, variable, |formula, first, values| {
            values.iter().enumerate().for_each(|(lane, &value)| result(formula, first + lane, value));
        });
    }

    /// The same, handing out the values of some rows together, from a first row on.
    pub(crate) fn evaluate_blocks<'v>(
        &self,
        formulas: &[usize],
        rows: usize,
        variable: impl Fn(usize) -> &'v [f64],
        mut result: impl FnMut(usize, usize, &[f64]),
    ) {
        let program = self.program(formulas);
        let mut machine = Machine::new(&program);
        for first in (0..rows).step_by(LANES) {
            let lanes = LANES.min(rows - first);
            machine.run(lanes, &|index| &variable(index)[first..], |formula, values| {
                result(formula, first, values);
            });
        }
    }

    /// Some formulas at one point, with exact derivatives; `variable` gives a variable's value and how it moves.
    ///
    /// Cost: about what ten evaluations take.
    pub fn jets(&self, formulas: &[usize], variable: impl Fn(usize) -> Jet) -> Vec<Jet> {
        self.evaluate_scalar(formulas, variable)
    }

    /// Encloses a formula over a box, an interval for every variable, in interval arithmetic. Terms that a sum adds and subtracts again are
    /// left out.
    ///
    /// Cost: about as many operations on intervals as the formula has, times one more than there are variables that vary.
    ///
    /// ```
    /// use sensitol::assembly::formula::Formula;
    /// use sensitol::assembly::formula::set::{FormulaSet, Meaning};
    /// let formulas = vec![("y".to_owned(), Formula::parse("a^2 - b")?)];
    /// let names = [("a", Meaning::Variable(0)), ("b", Meaning::Variable(1))];
    /// let set = FormulaSet::new(formulas, names).map_err(|(_, error)| error)?;
    /// let bounds = set.bounds(0, &[[-1.0, 2.0], [3.0, 4.0]]);
    /// assert_eq!((bounds.value.lower(), bounds.value.upper()), (-4.0, 1.0));
    /// assert_eq!((bounds.slopes[0].lower(), bounds.slopes[0].upper()), (-2.0, 4.0));
    /// # Ok::<(), sensitol::assembly::formula::FormulaError>(())
    /// ```
    pub fn bounds(&self, formula: usize, region: &[[f64; 2]]) -> Bounds {
        let moving: Vec<usize> = (0..region.len()).filter(|&d| region[d][0] < region[d][1]).collect();
        let place: HashMap<usize, usize> = moving.iter().enumerate().map(|(index, &d)| (d, index)).collect();
        let variable = |d: usize| {
            let value = Interval::between(region[d][0], region[d][1]);
            place.get(&d).map_or(Sloped::still(value), |&index| Sloped::variable(value, index, moving.len()))
        };
        let Sloped { value, slopes: of_moving } =
            self.bounding(formula).evaluate(&variable, &mut Vec::new()).swap_remove(0);
        let mut slopes = vec![Interval::between(0.0, 0.0); region.len()];
        moving.iter().zip(of_moving).for_each(|(&d, slope)| slopes[d] = slope);
        Bounds { value, slopes }
    }

    /// Some formulas at one point, on any kind of value.
    pub(crate) fn evaluate_scalar<S: Scalar>(&self, formulas: &[usize], variable: impl Fn(usize) -> S) -> Vec<S> {
        self.program(formulas).evaluate(&variable, &mut Vec::new())
    }

    /// Some formulas made ready to be run again and again, by any number of threads.
    pub(crate) fn routine(&self, formulas: &[usize]) -> Routine {
        let roots: Vec<NodeId> = formulas.iter().map(|&formula| self.roots[formula]).collect();
        Routine(Arc::new(Program::of(&self.graph, &roots)))
    }

    fn program(&self, formulas: &[usize]) -> Arc<Program> {
        let mut last = self.program.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some((of, program)) = &*last
            && of == formulas
        {
            return Arc::clone(program);
        }
        let roots: Vec<NodeId> = formulas.iter().map(|&formula| self.roots[formula]).collect();
        let program = Arc::new(Program::of(&self.graph, &roots));
        *last = Some((formulas.to_vec(), Arc::clone(&program)));
        program
    }

    /// The program of one formula for bounds.
    fn bounding(&self, formula: usize) -> Arc<Program> {
        let mut last = self.bounding.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some((of, program)) = &*last
            && *of == formula
        {
            return Arc::clone(program);
        }
        let root = self.roots[formula];
        let program = match cancelled(&self.graph, root) {
            Some((graph, root)) => Program::of(&graph, &[root]),
            None => Program::of(&self.graph, &[root]),
        };
        let program = Arc::new(program);
        *last = Some((formula, Arc::clone(&program)));
        program
    }

    /// Why a formula has no finite value at one point: the first part of it, or of a formula that it uses there, that
    /// made the value what it is. None when it has a value.
    pub fn explain(&self, formula: usize, variable: impl Fn(usize) -> f64) -> Option<FormulaFailure> {
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); self.len()];
        for &index in &self.order {
            values[index] = self.formulas[index].values(&values, &variable);
        }
        // An infinity on the way to a NaN may be harmless (1/(1/0) is 0): a NaN is traced to where it arose.
        let fault = match *values[formula].last()? {
            value if value.is_finite() => return None,
            value if value.is_nan() => f64::is_nan,
            _ => f64::is_infinite,
        };
        let mut live = vec![false; self.len()];
        live[formula] = true;
        let mut failure = None;
        for &index in self.order.iter().rev() {
            if !live[index] {
                continue;
            }
            let entry = &self.formulas[index];
            let taken = entry.taken(&values[index]);
            for (&node, reference) in &entry.references {
                if let (true, Reference::Formula(used)) = (taken[node], reference) {
                    live[*used] = true;
                }
            }
            // Later in this loop is earlier in the order: the deepest cause wins.
            failure = entry.failure(&values[index], &taken, fault).or(failure);
        }
        failure
    }
}

fn resolve(formula: &Formula, known: &HashMap<String, Reference>) -> Result<HashMap<usize, Reference>, FormulaError> {
    let mut references = HashMap::new();
    for (index, (node, span)) in formula.nodes.iter().enumerate() {
        if let Node::Name(name) = node {
            let Some(&reference) = known.get(name) else {
                let mut names: Vec<&str> = known.keys().map(String::as_str).collect();
                names.sort_unstable();
                let nearest = nearest(name, names).map(str::to_owned);
                let fault = FormulaFault::UndefinedName { name: name.clone(), nearest };
                return Err(FormulaError { span: span.clone(), fault });
            };
            references.insert(index, reference);
        }
    }
    Ok(references)
}

/// Formulas before those that use them, or the cycle that makes it impossible.
fn order(entries: &[Entry]) -> Result<Vec<usize>, (usize, FormulaError)> {
    let uses: Vec<Vec<usize>> = entries.iter().map(|entry| entry.uses().collect()).collect();
    let mut missing: Vec<usize> = uses.iter().map(Vec::len).collect();
    let mut users = vec![Vec::new(); entries.len()];
    for (index, used) in uses.iter().enumerate() {
        for &used in used {
            users[used].push(index);
        }
    }
    let mut order: Vec<usize> = (0..entries.len()).filter(|&index| missing[index] == 0).collect();
    let mut next = 0;
    while next < order.len() {
        for &user in &users[order[next]] {
            missing[user] -= 1;
            if missing[user] == 0 {
                order.push(user);
            }
        }
        next += 1;
    }
    if order.len() == entries.len() {
        return Ok(order);
    }
    // Every formula left uses another one left: following such uses must come round.
    let start = (0..entries.len()).find(|&index| missing[index] > 0).expect("some formula is left");
    let mut path = vec![start];
    loop {
        let last = *path.last().expect("never empty");
        let next = *uses[last].iter().find(|&&used| missing[used] > 0).expect("it waits for another one");
        if let Some(first) = path.iter().position(|&index| index == next) {
            path.drain(..first);
            break;
        }
        path.push(next);
    }
    let (at, after) = (path[0], *path.get(1).unwrap_or(&path[0]));
    let node = (entries[at].references.iter())
        .filter(|(_, reference)| **reference == Reference::Formula(after))
        .map(|(&node, _)| node)
        .min()
        .expect("the cycle passes through this name");
    let path = path.iter().map(|&index| entries[index].name.clone()).collect();
    Err((at, FormulaError { span: entries[at].formula.nodes[node].1.clone(), fault: FormulaFault::Cycle { path } }))
}

impl Entry {
    /// The formulas that this one names, each once, ascending.
    fn uses(&self) -> impl Iterator<Item = usize> {
        let mut uses: Vec<usize> = (self.references.values())
            .filter_map(|reference| match reference {
                Reference::Formula(index) => Some(*index),
                Reference::Outside(_) => None,
            })
            .collect();
        uses.sort_unstable();
        uses.dedup();
        uses.into_iter()
    }

    /// The node of the graph for each of its own.
    fn add_to(&self, graph: &mut Graph, roots: &[NodeId]) -> Vec<NodeId> {
        let mut ids: Vec<NodeId> = Vec::with_capacity(self.formula.nodes.len());
        for (index, (node, _)) in self.formula.nodes.iter().enumerate() {
            let id = match *node {
                Node::Number(value) => graph.constant(value),
                Node::Name(_) => match self.references[&index] {
                    Reference::Outside(Meaning::Variable(variable)) => graph.variable(variable),
                    Reference::Outside(Meaning::Constant(value)) => graph.constant(value),
                    Reference::Formula(formula) => roots[formula],
                },
                Node::Unary(function, a) => graph.unary(function, ids[a]),
                Node::Binary(function, a, b) => graph.binary(function, ids[a], ids[b]),
                Node::If(condition, then, otherwise) => graph.branch(ids[condition], ids[then], ids[otherwise]),
            };
            ids.push(id);
        }
        ids
    }

    /// The value of every node at one point, branches not taken included.
    fn values(&self, formulas: &[Vec<f64>], variable: &impl Fn(usize) -> f64) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.formula.nodes.len());
        for (index, (node, _)) in self.formula.nodes.iter().enumerate() {
            values.push(match *node {
                Node::Number(value) => value,
                Node::Name(_) => match self.references[&index] {
                    Reference::Outside(Meaning::Variable(index)) => variable(index),
                    Reference::Outside(Meaning::Constant(value)) => value,
                    Reference::Formula(formula) => *formulas[formula].last().expect("formulas come in order"),
                },
                Node::Unary(function, a) => function.apply(values[a]),
                Node::Binary(function, a, b) => function.apply(values[a], values[b]),
                Node::If(condition, then, otherwise) => select(values[condition], values[then], values[otherwise]),
            });
        }
        values
    }

    /// Which nodes have a part in the result at a point where the nodes have these values.
    fn taken(&self, values: &[f64]) -> Vec<bool> {
        let mut taken = vec![false; values.len()];
        *taken.last_mut().expect("a formula is never empty") = true;
        for (index, (node, _)) in self.formula.nodes.iter().enumerate().rev() {
            if !taken[index] {
                continue;
            }
            match *node {
                Node::Number(_) | Node::Name(_) => {}
                Node::Unary(_, a) => taken[a] = true,
                Node::Binary(_, a, b) => (taken[a], taken[b]) = (true, true),
                Node::If(condition, then, otherwise) => {
                    taken[condition] = true;
                    match values[condition] {
                        condition if condition.is_nan() => {}
                        0.0 => taken[otherwise] = true,
                        _ => taken[then] = true,
                    }
                }
            }
        }
        taken
    }

    /// The first node with a part in the result that `fault` finds at fault while none of its operands is.
    fn failure(&self, values: &[f64], taken: &[bool], fault: fn(f64) -> bool) -> Option<FormulaFailure> {
        let sound = |operand: usize| !fault(values[operand]);
        let (span, reason) = self.formula.nodes.iter().enumerate().find_map(|(index, (node, span))| {
            if !taken[index] || !fault(values[index]) {
                return None;
            }
            let not_finite = FailureReason::NotFinite { value: values[index] };
            let reason = match *node {
                Node::Name(_) if matches!(self.references[&index], Reference::Formula(_)) => return None,
                Node::Number(_) | Node::Name(_) => not_finite,
                Node::Unary(function, a) if sound(a) => match function.domain() {
                    Some(rule) if values[a].is_finite() => FailureReason::Domain { argument: values[a], rule },
                    _ => not_finite,
                },
                Node::Binary(function, a, b) if sound(a) && sound(b) => match (function, values[a], values[b]) {
                    (Binary::Divide, _, 0.0) => FailureReason::DivisionByZero,
                    (Binary::Power, base, exponent) => FailureReason::Power { base, exponent },
                    _ => not_finite,
                },
                _ => return None,
            };
            Some((span.clone(), reason))
        })?;
        Some(FormulaFailure { name: self.name.clone(), text: self.formula.text.clone(), span, reason })
    }
}
