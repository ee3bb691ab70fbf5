//! Switches of formulas, where they change their form, and their degree as polynomials.
//!
//! Every switch has a margin, a function of the variables that changes its sign where the formula changes its form:
//!
//! | node | margin | kind |
//! |---|---|---|
//! | `abs(x)`, `min(a, b)`, `max(a, b)` | `x`; `a - b` | kink |
//! | `a < b` and the like | `a - b` | branch |
//! | `floor(x)`, `ceil(x)`; `sign(x)`; `atan2(y, x)` | `sin(pi x)`; `x`; `y` where `x < 0` | jump |
//! | `sqrt(x)`, `ln(x)`, `log10(x)`, `x^0.7`; `asin(x)`, `acos(x)` | `x`; `1 - abs(x)` | edge |
//! | `a/b`, `x^-2`; `tan(x)` | `b`, `x`; `cos(x)` | pole |
//!
//! A product as divisor has a margin for each factor, so that the pole of `1/x^2` is found. Margins are formulas themselves and run on the
//! same machine. Inside the branch of an `if` that is not taken a margin is NaN. An equality has no margin: two varying values are equal
//! with probability 0.

use std::sync::{Arc, PoisonError};

use crate::assembly::formula::batch::{LANES, Machine};
use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::graph::{Graph, GraphNode, NodeId};
use crate::assembly::formula::margins::Margins;
use crate::assembly::formula::program::{Program, guards};
use crate::assembly::formula::set::FormulaSet;
use crate::assembly::{Switch, SwitchKind};

impl FormulaSet {
    /// Returns the switches of some formulas and of the formulas that they use, each once.
    ///
    /// ```
    /// use sensitol::assembly::SwitchKind;
    /// use sensitol::assembly::formula::Formula;
    /// use sensitol::assembly::formula::set::{FormulaSet, Meaning};
    /// let formulas = vec![("y".to_owned(), Formula::parse("a + max(b, 3)/a")?)];
    /// let set = FormulaSet::new(formulas, [("a", Meaning::Variable(0)), ("b", Meaning::Variable(1))]).unwrap();
    /// let found: Vec<_> = set.switches(&[0]).into_iter().map(|switch| (switch.kind, switch.text)).collect();
    /// assert_eq!(found, [(SwitchKind::Kink, "max(b, 3)".into()), (SwitchKind::Pole, "max(b, 3)/a".into())]);
    /// # Ok::<(), sensitol::assembly::formula::FormulaError>(())
    /// ```
    pub fn switches(&self, formulas: &[usize]) -> Vec<Switch> {
        self.prepared(formulas).switches.clone()
    }

    /// Returns the margin of every switch of [`switches`](Self::switches) at `rows` rows, NaN if the switch has no part in the value.
    ///
    /// Shapes: a column of `rows` values for every switch. Cost: about one evaluation of the formulas.
    pub fn margins<'v>(&self, formulas: &[usize], rows: usize, variable: impl Fn(usize) -> &'v [f64]) -> Vec<Vec<f64>> {
        let margins = self.prepared(formulas);
        let mut columns = vec![Vec::with_capacity(rows); margins.switches.len()];
        let mut machine = Machine::new(&margins.program);
        for first in (0..rows).step_by(LANES) {
            let lanes = LANES.min(rows - first);
            machine.run(lanes, &|index| &variable(index)[first..], |switch, values| {
                columns[switch].extend_from_slice(values);
            });
        }
        columns
    }

    /// Returns the degree of a formula as a polynomial in its variables, whose degrees `variable` gives. Returns None if it is not a
    /// polynomial.
    ///
    /// Constants and other formulas are included. Cost: one pass over the operations.
    ///
    /// ```
    /// use sensitol::assembly::formula::Formula;
    /// use sensitol::assembly::formula::set::{FormulaSet, Meaning};
    /// let formula = |text: &str| Formula::parse(text).map(|formula| (text.to_owned(), formula));
    /// let formulas = vec![formula("a*b/4 + (a - 1)^2")?, formula("a/b")?];
    /// let set = FormulaSet::new(formulas, [("a", Meaning::Variable(0)), ("b", Meaning::Variable(1))]).unwrap();
    /// assert_eq!([0, 1].map(|formula| set.degree(formula, |_| Some(1))), [Some(2), None]);
    /// // `b` does not vary.
    /// assert_eq!(set.degree(1, |variable| Some(u32::from(variable == 0))), Some(1));
    /// # Ok::<(), sensitol::assembly::formula::FormulaError>(())
    /// ```
    pub fn degree(&self, formula: usize, variable: impl Fn(usize) -> Option<u32>) -> Option<u32> {
        let root = self.roots[formula];
        let mut degrees: Vec<Option<u32>> = Vec::with_capacity(root as usize + 1);
        for (id, &node) in self.graph.nodes()[..=root as usize].iter().enumerate() {
            let of = |operand: NodeId| degrees[operand as usize];
            let still = |operands: &[NodeId]| operands.iter().all(|&operand| of(operand) == Some(0)).then_some(0);
            debug_assert_eq!(id, degrees.len());
            let degree = match node {
                GraphNode::Constant(_) => Some(0),
                GraphNode::Variable(index) => variable(index),
                GraphNode::Unary(Unary::Negate, a) => of(a),
                GraphNode::Unary(_, a) => still(&[a]),
                GraphNode::Binary(Binary::Add | Binary::Subtract, a, b) => of(a).zip(of(b)).map(|(a, b)| a.max(b)),
                GraphNode::Binary(Binary::Multiply, a, b) => of(a).zip(of(b)).and_then(|(a, b)| a.checked_add(b)),
                GraphNode::Binary(Binary::Divide, a, b) => of(a).filter(|_| of(b) == Some(0)),
                GraphNode::Binary(Binary::Power, a, b) => {
                    let whole = self.graph.constant_value(b).filter(|b| (0.0..1e6).contains(b) && b.fract() == 0.0);
                    still(&[a, b]).or_else(|| of(a)?.checked_mul(whole? as u32))
                }
                GraphNode::Binary(_, a, b) => still(&[a, b]),
                GraphNode::If(condition, a, b) => {
                    of(a).zip(of(b)).filter(|_| of(condition) == Some(0)).map(|(a, b)| a.max(b))
                }
            };
            degrees.push(degree);
        }
        degrees[root as usize]
    }

    fn prepared(&self, formulas: &[usize]) -> Arc<Margins> {
        let mut last = self.margins.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, margins)) = &*last
            && of == formulas
        {
            return Arc::clone(margins);
        }
        let margins = Arc::new(self.prepare(formulas));
        *last = Some((formulas.to_vec(), Arc::clone(&margins)));
        margins
    }

    fn prepare(&self, formulas: &[usize]) -> Margins {
        let roots: Vec<NodeId> = formulas.iter().map(|&formula| self.roots[formula]).collect();
        let mut graph = self.graph.clone();
        let mut switches: Vec<(NodeId, SwitchKind, NodeId)> = Vec::new();
        for (id, conditions) in guards(&self.graph, &roots).into_iter().enumerate() {
            let Some(conditions) = conditions else { continue };
            for (kind, margin) in margins_of(&mut graph, self.graph.nodes()[id]) {
                if graph.constant_value(margin).is_some() {
                    continue;
                }
                let nothing = graph.constant(f64::NAN);
                let guarded = conditions.iter().fold(margin, |margin, &(condition, holds)| match holds {
                    true => graph.branch(condition, margin, nothing),
                    false => graph.branch(condition, nothing, margin),
                });
                switches.push((id as NodeId, kind, guarded));
            }
        }
        let margins: Vec<NodeId> = switches.iter().map(|&(_, _, margin)| margin).collect();
        Margins {
            program: Program::of(&graph, &margins),
            switches: switches.iter().map(|&(id, kind, _)| self.described(id, kind)).collect(),
        }
    }

    /// Returns the switch of a node, with the text of its first occurrence.
    fn described(&self, id: NodeId, kind: SwitchKind) -> Switch {
        let place = self.order.iter().find_map(|&entry| {
            let node = self.places[entry].iter().position(|&place| place == id)?;
            Some((entry, self.formulas[entry].formula.nodes[node].1.clone()))
        });
        match place {
            Some((entry, span)) => {
                let formula = &self.formulas[entry];
                let text = formula.formula.text().get(span.clone()).unwrap_or_default().trim().to_owned();
                Switch { kind, text, formula: Some(formula.name.clone()), span }
            }
            None => Switch { kind, text: String::new(), formula: None, span: 0..0 },
        }
    }
}

/// Returns the kinds and margins of the switches of one node.
fn margins_of(graph: &mut Graph, node: GraphNode) -> Vec<(SwitchKind, NodeId)> {
    match node {
        GraphNode::Unary(function, x) => {
            let (kind, margin) = match function {
                Unary::Abs => (SwitchKind::Kink, x),
                Unary::Sign => (SwitchKind::Jump, x),
                Unary::Floor | Unary::Ceil => {
                    let pi = graph.constant(std::f64::consts::PI);
                    let turns = graph.binary(Binary::Multiply, pi, x);
                    (SwitchKind::Jump, graph.unary(Unary::Sin, turns))
                }
                Unary::Tan => (SwitchKind::Pole, graph.unary(Unary::Cos, x)),
                Unary::Sqrt | Unary::Ln | Unary::Log10 => (SwitchKind::Edge, x),
                Unary::Asin | Unary::Acos => {
                    let (one, size) = (graph.constant(1.0), graph.unary(Unary::Abs, x));
                    (SwitchKind::Edge, graph.binary(Binary::Subtract, one, size))
                }
                _ => return Vec::new(),
            };
            vec![(kind, margin)]
        }
        GraphNode::Binary(function, a, b) => match function {
            Binary::Min | Binary::Max => vec![(SwitchKind::Kink, graph.binary(Binary::Subtract, a, b))],
            Binary::Less | Binary::LessEqual | Binary::Greater | Binary::GreaterEqual => {
                vec![(SwitchKind::Branch, graph.binary(Binary::Subtract, a, b))]
            }
            Binary::Atan2 => {
                let (zero, nothing) = (graph.constant(0.0), graph.constant(f64::NAN));
                let behind = graph.binary(Binary::Less, b, zero);
                vec![(SwitchKind::Jump, graph.branch(behind, a, nothing))]
            }
            Binary::Divide => {
                let factors = factors(graph, b);
                factors.into_iter().map(|factor| (SwitchKind::Pole, factor)).collect()
            }
            Binary::Power => match graph.constant_value(b) {
                Some(exponent) if exponent.fract() != 0.0 => vec![(SwitchKind::Edge, a)],
                Some(exponent) if exponent >= 0.0 => Vec::new(),
                Some(_) => factors(graph, a).into_iter().map(|factor| (SwitchKind::Pole, factor)).collect(),
                None => vec![(SwitchKind::Edge, a)],
            },
            _ => Vec::new(),
        },
        GraphNode::If(..) | GraphNode::Constant(_) | GraphNode::Variable(_) => Vec::new(),
    }
}

/// Returns the varying factors of a product, each once. Their signs determine the sign of the product.
fn factors(graph: &Graph, of: NodeId) -> Vec<NodeId> {
    let (mut open, mut found) = (vec![of], Vec::new());
    while let Some(id) = open.pop() {
        match graph.nodes()[id as usize] {
            GraphNode::Binary(Binary::Multiply, a, b) => open.extend([b, a]),
            // A quotient is 0 where its dividend is.
            GraphNode::Binary(Binary::Divide, a, _) => open.push(a),
            GraphNode::Binary(Binary::Power, a, b) if graph.constant_value(b).is_some_and(|b| b > 0.0) => open.push(a),
            GraphNode::Unary(Unary::Negate | Unary::Abs | Unary::Sqrt, a) => open.push(a),
            GraphNode::Constant(_) => {}
            _ if found.contains(&id) => {}
            _ => found.push(id),
        }
    }
    found
}
