//! Named formulas that use each other, variables and constants.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use crate::assembly::Bounds;
use crate::assembly::formula::batch::{LANES, Machine};
use crate::assembly::formula::cancel::cancelled;
use crate::assembly::formula::error::{FailureReason, FormulaError, FormulaFailure, FormulaFault};
use crate::assembly::formula::functions::{Binary, select};
use crate::assembly::formula::graph::{Graph, NodeId};
use crate::assembly::formula::interval::Interval;
use crate::assembly::formula::jet::Jet;
use crate::assembly::formula::margins::Margins;
use crate::assembly::formula::parser::{Formula, Node};
use crate::assembly::formula::program::Program;
use crate::assembly::formula::scalar::Scalar;
use crate::assembly::formula::slopes::Sloped;
use sensitol_numeric::names::nearest;

/// Meaning of a name that is not a formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meaning {
    /// Variable: the column of this index.
    Variable(usize),
    /// Constant with this value.
    Constant(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reference {
    Outside(Meaning),
    Formula(usize),
}

/// Set of formulas in any order, resolved against each other.
///
/// Only the parts that the asked formulas need are computed, common parts once. Cost: a formula of `n` operations takes about `n` passes
/// over blocks of 256 rows.
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
    /// Order of evaluation: formulas before those that use them.
    pub(super) order: Vec<usize>,
    pub(super) graph: Graph,
    pub(super) roots: Vec<NodeId>,
    /// Variables of every formula, computed when they are first requested.
    variables: Vec<OnceLock<Vec<usize>>>,
    /// Node of the graph for each node of every formula.
    pub(super) places: Vec<Vec<NodeId>>,
    /// Switches of the formulas that were last requested, because the same ones are requested repeatedly.
    pub(super) margins: Mutex<Option<(Vec<usize>, Arc<Margins>)>>,
    /// Program of the outputs that were last requested, because the same ones are requested repeatedly.
    program: Mutex<Option<(Vec<usize>, Arc<Program>)>>,
    /// Last program of bounds. Terms that cancel are removed from its sums.
    bounding: Mutex<Option<(usize, Arc<Program>)>>,
}

/// Formulas that are run on one point at a time.
#[derive(Debug, Clone)]
pub struct Routine(Arc<Program>);

impl Routine {
    /// Evaluates every formula on the values that `variable` returns. `room` keeps memory from one run to the next.
    pub(crate) fn run<S: Scalar>(&self, variable: &impl Fn(usize) -> S, room: &mut Vec<S>) -> Vec<S> {
        self.0.evaluate(variable, room)
    }
}

#[derive(Debug)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) formula: Formula,
    /// Meanings of the names among the formula's nodes.
    pub(super) references: HashMap<usize, Reference>,
}

impl FormulaSet {
    /// Resolves every name.
    ///
    /// # Errors
    /// Fails with the index of the faulty formula, for an undefined name or a cycle.
    pub fn new<'n>(
        formulas: Vec<(String, Formula)>,
        meanings: impl IntoIterator<Item = (&'n str, Meaning)>,
    ) -> Result<Self, (usize, FormulaError)> {
        let named = formulas.len();
        Self::with_unnamed(formulas, named, meanings)
    }

    /// Resolves every name. Only the first `named` formulas can be used by the others; the names of the rest are for errors.
    ///
    /// # Errors
    /// Fails like [`new`](Self::new).
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

    /// Returns the number of formulas.
    pub fn len(&self) -> usize {
        self.formulas.len()
    }

    /// Returns the number of nodes of all formulas together: numbers, names, functions and operators.
    pub(crate) fn parts(&self) -> usize {
        self.formulas.iter().map(|entry| entry.formula.nodes.len()).sum()
    }

    /// True if there are no formulas.
    pub fn is_empty(&self) -> bool {
        self.formulas.is_empty()
    }

    /// Returns the variables that a formula can depend on, directly or through other formulas, ascending.
    pub fn variables(&self, formula: usize) -> &[usize] {
        self.variables[formula].get_or_init(|| self.graph.variables(self.roots[formula]))
    }

    /// Returns a flag for each formula that these formulas use, including themselves.
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

    /// Evaluates some formulas on `rows` rows. `variable` returns a variable's column. `result` receives the position in `formulas`, the
    /// row and the value, which is NaN or infinite if it does not exist.
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

    /// Evaluates some formulas like `evaluate`, but passes the values of several rows together. `result` receives the position, the first
    /// row and the values.
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

    /// Evaluates some formulas at one point, with exact derivatives. `variable` gives the value of a variable and its derivatives.
    ///
    /// Cost: about ten evaluations.
    pub fn jets(&self, formulas: &[usize], variable: impl Fn(usize) -> Jet) -> Vec<Jet> {
        self.evaluate_scalar(formulas, variable)
    }

    /// Returns bounds of a formula over a box, with an interval for every variable, by interval arithmetic. Terms that a sum adds and
    /// subtracts again are left out.
    ///
    /// Cost: about as many operations on intervals as the formula has, each times one more than the number of varying variables that its
    /// operands depend on.
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
        let variable = |d: usize| {
            let value = Interval::between(region[d][0], region[d][1]);
            if region[d][0] < region[d][1] { Sloped::variable(value, d) } else { Sloped::still(value) }
        };
        let Sloped { value, slopes: of_moving } =
            self.bounding(formula).evaluate(&variable, &mut Vec::new()).swap_remove(0);
        let mut slopes = vec![Interval::between(0.0, 0.0); region.len()];
        of_moving.into_iter().for_each(|(d, slope)| slopes[d] = slope);
        Bounds { value, slopes }
    }

    /// Evaluates some formulas at one point, on any type of value.
    pub(crate) fn evaluate_scalar<S: Scalar>(&self, formulas: &[usize], variable: impl Fn(usize) -> S) -> Vec<S> {
        self.program(formulas).evaluate(&variable, &mut Vec::new())
    }

    /// Prepares some formulas for repeated runs, by any number of threads.
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

    /// Returns the program of one formula for bounds.
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

    /// Returns both operands of the difference that a formula is, at one point. Returns None for other formulas.
    pub(crate) fn difference(&self, formula: usize, variable: impl Fn(usize) -> f64) -> Option<[f64; 2]> {
        let entry = &self.formulas[formula];
        let (Node::Binary(Binary::Subtract, a, b), _) = entry.formula.nodes.last()? else { return None };
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); self.len()];
        for &index in &self.order {
            values[index] = self.formulas[index].values(&values, &variable);
        }
        Some([values[formula][*a], values[formula][*b]])
    }

    /// Returns the reason why a formula has no finite value at one point, or None if it has one. The reason is the first part that causes
    /// the failure, in this formula or in one that it uses there.
    pub fn explain(&self, formula: usize, variable: impl Fn(usize) -> f64) -> Option<FormulaFailure> {
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); self.len()];
        for &index in &self.order {
            values[index] = self.formulas[index].values(&values, &variable);
        }
        // An infinity before a NaN may be harmless (1/(1/0) is 0), so that a NaN is traced to its own origin.
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
            // Later in this loop is earlier in the order, so that the deepest cause remains.
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

/// Returns the formulas in an order in which each comes before those that use it, or the cycle that makes this impossible.
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
    // Every remaining formula uses another remaining one, so that following these uses leads to a cycle.
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
    /// Returns the formulas that this one names, each once, ascending.
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

    /// Adds the formula to the graph. Returns the node of the graph for each node of the formula.
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

    /// Returns the value of every node at one point, including branches that are not taken.
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

    /// Returns a flag for each node that has a part in the result, given the values of all nodes.
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

    /// Returns the failure of the first node in the result that `fault` flags, while none of its operands is flagged.
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
