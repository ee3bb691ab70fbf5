//! All mixed derivatives of a formula at once, by one pass for each variable instead of one for each pair.

use std::collections::BTreeSet;

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::graph::{GraphNode, NodeId};
use crate::assembly::formula::jet::Jet;
use crate::assembly::formula::scalar::{Scalar, Verdict};
use crate::assembly::formula::set::FormulaSet;
use sensitol_numeric::parallel::prelude::*;

/// Number of variables whose passes run together.
const LANES: usize = 8;

/// Number of variables whose second derivatives share one buffer of moves.
const TOGETHER: usize = 64;

/// Operation that depends on a variable, with its derivatives by its operands.
struct Local {
    /// Places of the operands among the operations. With one operand, both places are the same.
    of: [usize; 2],
    first: [f64; 2],
    /// Second derivatives: by the first operand, mixed, by the second operand.
    second: [f64; 3],
}

/// Operations of some formulas at one point, in the order of computation.
pub(crate) struct Tape {
    /// Operations that depend on a variable; None for the variable itself.
    operations: Vec<Option<Local>>,
    /// Variables with their places.
    variables: Vec<(usize, usize)>,
    /// Places of the formulas; None for a formula that cannot change with a variable.
    results: Vec<Option<usize>>,
    /// Number of variables, with those that no formula uses.
    count: usize,
}

/// Value of a node, with its place on the tape.
#[derive(Clone, Copy)]
struct NodeJet {
    jet: Jet,
    /// Place on the tape; None if the value cannot change with a variable.
    place: Option<usize>,
}

impl FormulaSet {
    /// Returns the mixed derivatives of a formula by these pairs of variables at a point, which has a value for every variable.
    ///
    /// A forward pass along one variable and a backward pass from the result give the derivatives of a slope by all variables (Griewank and
    /// Walther 2008, section 5.4). Returns None if the formula has a kink, a jump or the edge of a domain at this very point, or a number
    /// that is not finite. [`jets`](Self::jets) then show which derivatives exist.
    ///
    /// Cost: `n` variables of a formula of `m` operations take about `12 n m` products, for any number of pairs.
    pub(crate) fn mixed(&self, formula: usize, at: &[f64], pairs: &[(usize, usize)]) -> Option<Vec<f64>> {
        let tape = self.tape(&[formula], at)?;
        let adjoints = tape.adjoints(&[1.0])?;
        let mut places = vec![None; at.len()];
        tape.variables.iter().for_each(|&(variable, place)| places[variable] = Some(place));
        let mut of_first = vec![Vec::new(); at.len()];
        for (index, &(first, _)) in pairs.iter().enumerate() {
            if places[first].is_some() {
                of_first[first].push(index as u32);
            }
        }
        let along: Vec<usize> = (0..at.len()).filter(|&variable| !of_first[variable].is_empty()).collect();
        let passes: Vec<Vec<f64>> = (along.par_chunks(LANES))
            .map(|along| {
                let mut moves = vec![[0.0; LANES]; tape.operations.len()];
                let of_along = along.iter().filter_map(|&variable| places[variable]);
                of_along.enumerate().for_each(|(lane, place)| moves[place][lane] = 1.0);
                let changes = tape.changes(moves, &adjoints);
                let change =
                    |index: u32, lane: usize| places[pairs[index as usize].1].map(|place| changes[place][lane]);
                let of_lane = |(lane, &first): (usize, &usize)| {
                    let of_pair = |&index: &u32| change(index, lane).unwrap_or(0.0);
                    of_first[first].iter().map(of_pair).collect::<Vec<f64>>()
                };
                along.iter().enumerate().flat_map(of_lane).collect()
            })
            .collect();
        let mut mixed = vec![0.0; pairs.len()];
        let indices = along.iter().flat_map(|&first| &of_first[first]);
        indices.zip(passes.into_iter().flatten()).for_each(|(&index, value)| mixed[index as usize] = value);
        mixed.iter().all(|value| value.is_finite()).then_some(mixed)
    }

    /// Returns the first and the second derivative of a formula by each of these variables at a point, which has a value for every variable.
    ///
    /// One backward pass gives the first derivatives. A second derivative is the sum, over the operations that curve, of the derivative by the
    /// operation times its second derivative along the moves of its operands (Griewank and Walther 2008, section 5.4, with the terms of
    /// linear operations left out). Returns None as [`mixed`](Self::mixed) does.
    ///
    /// Cost: one pass over the formula, and for each variable the operations between it and the last one that curves.
    pub(crate) fn pure(&self, formula: usize, at: &[f64], variables: &[usize]) -> Option<Vec<[f64; 2]>> {
        let tape = self.tape(&[formula], at)?;
        let adjoints = tape.adjoints(&[1.0])?;
        let curved = CurvedPaths::of(&tape);
        let mut places = vec![None; at.len()];
        tape.variables.iter().for_each(|&(variable, place)| places[variable] = Some(place));
        let of_variables = |variables: &[usize]| -> Vec<[f64; 2]> {
            let mut moves = vec![0.0; tape.operations.len()];
            let derivatives = variables.iter().map(|&variable| match places[variable] {
                Some(place) => [adjoints[place], curved.second(&tape, &adjoints, place, &mut moves)],
                None => [0.0; 2],
            });
            derivatives.collect()
        };
        let found: Vec<[f64; 2]> = variables.par_chunks(TOGETHER).flat_map_iter(of_variables).collect();
        found.iter().flatten().all(|value| value.is_finite()).then_some(found)
    }

    /// Returns the operations of some formulas at a point, with their derivatives. Returns None if a formula has a kink, a jump or the edge
    /// of a domain at this very point, or a number that is not finite.
    pub(crate) fn tape(&self, formulas: &[usize], at: &[f64]) -> Option<Tape> {
        let roots: Vec<NodeId> = formulas.iter().map(|&formula| self.roots[formula]).collect();
        Tape::of(self, &roots, at)
    }
}

impl Tape {
    fn of(set: &FormulaSet, roots: &[NodeId], at: &[f64]) -> Option<Self> {
        let nodes = set.graph.nodes();
        let needed = set.graph.needed(roots.iter().copied());
        let mut known = vec![NodeJet { jet: Jet::constant(f64::NAN), place: None }; nodes.len()];
        let (operations, variables, results) = (Vec::new(), Vec::new(), Vec::new());
        let mut tape = Self { operations, variables, results, count: at.len() };
        // Values come first, because they decide which branches count.
        let mut values = vec![f64::NAN; nodes.len()];
        for (id, node) in nodes.iter().enumerate().filter(|(id, _)| needed[*id]) {
            let value = |id: NodeId| values[id as usize];
            values[id] = match *node {
                GraphNode::Constant(bits) => f64::from_bits(bits),
                GraphNode::Variable(index) => at[index],
                GraphNode::Unary(function, a) => function.apply(value(a)),
                GraphNode::Binary(function, a, b) => function.apply(value(a), value(b)),
                GraphNode::If(condition, then, otherwise) => match value(condition) {
                    condition if condition.is_nan() => f64::NAN,
                    0.0 => value(otherwise),
                    _ => value(then),
                },
            };
        }
        let counts = taken(nodes, roots, &values);
        for (id, node) in nodes.iter().enumerate().filter(|(id, _)| counts[*id]) {
            let of = |id: NodeId| known[id as usize];
            let next = tape.operations.len();
            let (jet, operation) = match *node {
                GraphNode::Constant(bits) => (Jet::constant(f64::from_bits(bits)), None),
                GraphNode::Variable(index) => {
                    tape.variables.push((index, next));
                    (Jet::variable(at[index], [1.0; 2]), Some(None))
                }
                GraphNode::Unary(function, a) => unary(function, of(a))?,
                GraphNode::Binary(function, a, b) => binary(function, of(a), of(b))?,
                GraphNode::If(condition, then, otherwise) => {
                    let taken = match of(condition).jet.verdict() {
                        Verdict::Holds => of(then),
                        Verdict::Fails => of(otherwise),
                        Verdict::Undefined | Verdict::Open => return None,
                    };
                    // The taken branch replaces the `if`.
                    known[id] = taken;
                    continue;
                }
            };
            if !jet.value().is_finite() {
                return None;
            }
            let place = operation.is_some().then_some(next);
            tape.operations.extend(operation);
            known[id] = NodeJet { jet, place };
        }
        tape.variables.sort_unstable();
        tape.results = roots.iter().map(|&root| known[root as usize].place).collect();
        Some(tape)
    }

    /// Returns the derivative of the weighted sum of the formulas by every operation. Returns None if one is not finite.
    fn adjoints(&self, weights: &[f64]) -> Option<Vec<f64>> {
        let mut adjoints = vec![0.0; self.operations.len()];
        for (place, weight) in self.results.iter().zip(weights) {
            place.iter().for_each(|&place| adjoints[place] += weight);
        }
        for place in (0..self.operations.len()).rev() {
            if let Some(local) = &self.operations[place] {
                let adjoint = adjoints[place];
                for (operand, slope) in local.of.into_iter().zip(local.first) {
                    adjoints[operand] += adjoint * slope;
                }
            }
        }
        adjoints.iter().all(|adjoint| adjoint.is_finite()).then_some(adjoints)
    }

    /// Returns the derivatives of the weighted sum of the formulas by every variable. Returns None if one is not finite.
    pub(crate) fn gradient(&self, weights: &[f64]) -> Option<Vec<f64>> {
        let adjoints = self.adjoints(weights)?;
        let mut gradient = vec![0.0; self.count];
        self.variables.iter().for_each(|&(variable, place)| gradient[variable] = adjoints[place]);
        Some(gradient)
    }

    /// Returns the change of the gradient of the weighted sum along every direction: the product of its Hessian with the direction. Returns
    /// None if a number is not finite.
    ///
    /// Cost: a formula of `m` operations takes about `12 m` products for each direction.
    pub(crate) fn curvatures(&self, weights: &[f64], along: &[&[f64]]) -> Option<Vec<Vec<f64>>> {
        let adjoints = self.adjoints(weights)?;
        let of_lanes = |along: &[&[f64]]| -> Vec<Vec<f64>> {
            let mut moves = vec![[0.0; LANES]; self.operations.len()];
            for &(variable, place) in &self.variables {
                along.iter().enumerate().for_each(|(lane, direction)| moves[place][lane] = direction[variable]);
            }
            let changes = self.changes(moves, &adjoints);
            let mut curvatures = vec![vec![0.0; self.count]; along.len()];
            for &(variable, place) in &self.variables {
                curvatures.iter_mut().enumerate().for_each(|(lane, of)| of[variable] = changes[place][lane]);
            }
            curvatures
        };
        let found: Vec<Vec<f64>> = along.par_chunks(LANES).flat_map_iter(of_lanes).collect();
        found.iter().flatten().all(|value| value.is_finite()).then_some(found)
    }

    /// Returns the change of the derivative by every operation. `moves` holds the moves of the variables along the directions of the lanes.
    fn changes(&self, mut moves: Vec<[f64; LANES]>, adjoints: &[f64]) -> Vec<[f64; LANES]> {
        for (place, local) in self.operations.iter().enumerate() {
            if let Some(Local { of: [a, b], first, .. }) = local {
                let (a, b) = (moves[*a], moves[*b]);
                moves[place] = std::array::from_fn(|lane| first[0] * a[lane] + first[1] * b[lane]);
            }
        }
        // Backward pass: the adjoints change by the changes of all later operations, and by the second derivatives.
        let mut changes = vec![[0.0; LANES]; self.operations.len()];
        for (place, local) in self.operations.iter().enumerate().rev() {
            if let Some(Local { of: [a, b], first, second: [aa, ab, bb] }) = local {
                let (own, adjoint) = (changes[place], adjoints[place]);
                let [aa, ab, bb] = [adjoint * aa, adjoint * ab, adjoint * bb];
                let (of_a, of_b) = (moves[*a], moves[*b]);
                for lane in 0..LANES {
                    changes[*a][lane] += first[0] * own[lane] + aa * of_a[lane] + ab * of_b[lane];
                    changes[*b][lane] += first[1] * own[lane] + ab * of_a[lane] + bb * of_b[lane];
                }
            }
        }
        changes
    }
}

/// Users of every operation from which an operation that curves can be reached.
struct CurvedPaths {
    /// Operations that use each operation, and that curve or are used by one that does.
    users: Vec<Vec<usize>>,
}

impl CurvedPaths {
    fn of(tape: &Tape) -> Self {
        let mut users: Vec<Vec<usize>> = vec![Vec::new(); tape.operations.len()];
        for (place, local) in tape.operations.iter().enumerate().rev() {
            let Some(Local { of: [a, b], second, .. }) = local else { continue };
            // OK because the users of an operation come after it: its own list is complete here.
            if *second != [0.0; 3] || !users[place].is_empty() {
                users[*a].push(place);
                if a != b {
                    users[*b].push(place);
                }
            }
        }
        Self { users }
    }

    /// Returns the second derivative by the variable at this place. `moves` is 0 everywhere, before and after.
    fn second(&self, tape: &Tape, adjoints: &[f64], variable: usize, moves: &mut [f64]) -> f64 {
        // Operations in their order, each once, since all that it uses has moved by then.
        let mut pending: BTreeSet<usize> = self.users[variable].iter().copied().collect();
        let (mut second, mut moved) = (0.0, vec![variable]);
        moves[variable] = 1.0;
        while let Some(place) = pending.pop_first() {
            let Some(Local { of: [a, b], first, second: [aa, ab, bb] }) = &tape.operations[place] else { continue };
            let (of_a, of_b) = (moves[*a], moves[*b]);
            second += adjoints[place] * (aa * of_a * of_a + 2.0 * ab * of_a * of_b + bb * of_b * of_b);
            moves[place] = first[0] * of_a + first[1] * of_b;
            moved.push(place);
            pending.extend(&self.users[place]);
        }
        moved.into_iter().for_each(|place| moves[place] = 0.0);
        second
    }
}

/// Returns a flag for each node on which the results depend at this point: the condition and one branch of an `if`.
fn taken(nodes: &[GraphNode], roots: &[NodeId], values: &[f64]) -> Vec<bool> {
    let mut taken = vec![false; nodes.len()];
    roots.iter().for_each(|&root| taken[root as usize] = true);
    for id in (0..nodes.len()).rev() {
        if !taken[id] {
            continue;
        }
        match nodes[id] {
            GraphNode::If(condition, then, otherwise) => {
                let branch = if values[condition as usize] == 0.0 { otherwise } else { then };
                [condition, branch].into_iter().for_each(|operand| taken[operand as usize] = true);
            }
            node => node.operands().for_each(|operand| taken[operand as usize] = true),
        }
    }
    taken
}

/// Result of an operation, with its derivatives if it depends on a variable.
type Operation = (Jet, Option<Option<Local>>);

/// Evaluates a function of one operand. Returns None if a derivative does not exist.
fn unary(function: Unary, a: NodeJet) -> Option<Operation> {
    let value = a.jet.value();
    let Some(place) = a.place else { return Some((Jet::constant(function.apply(value)), None)) };
    let jet = Jet::unary(function, &Jet::known(value, [1.0; 2], 0.0));
    if !jet.moves() {
        return Some((jet, None));
    }
    let local = Local { of: [place; 2], first: [jet.first(0)?, 0.0], second: [jet.second()?, 0.0, 0.0] };
    Some((jet, Some(Some(local))))
}

fn binary(function: Binary, a: NodeJet, b: NodeJet) -> Option<Operation> {
    let of = |first: [f64; 2], second: [f64; 2]| {
        let operand = |of: NodeJet, first: [f64; 2]| match of.place {
            Some(_) => Jet::known(of.jet.value(), first, 0.0),
            None => Jet::constant(of.jet.value()),
        };
        Jet::binary(function, &operand(a, first), &operand(b, second))
    };
    let both = of([1.0, 0.0], [0.0, 1.0]);
    if !both.moves() {
        return Some((both, None));
    }
    let (first, cross) = ([both.first(0)?, both.first(1)?], both.second()?);
    let [aa, bb] = [of([1.0; 2], [0.0; 2]).second()?, of([0.0; 2], [1.0; 2]).second()?];
    let place = a.place.or(b.place)?;
    let local = Local {
        of: [a.place.unwrap_or(place), b.place.unwrap_or(place)],
        first: [a.place.map_or(0.0, |_| first[0]), b.place.map_or(0.0, |_| first[1])],
        second: [aa, cross, bb],
    };
    Some((both, Some(Some(local))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::formula::{Formula, Meaning};

    fn set(text: &str, names: &[&str]) -> FormulaSet {
        let formula = Formula::parse(text).expect("a formula");
        let meanings: Vec<(&str, Meaning)> =
            names.iter().enumerate().map(|(index, name)| (*name, Meaning::Variable(index))).collect();
        FormulaSet::new(vec![("result".to_owned(), formula)], meanings).expect("known names")
    }

    /// Derivatives by hand: those of `x y^2 z^3` at (2, 3, 5) by xy, xz, yz and twice by y are 2 y z^3 = 750, 3 y^2 z^2 = 675, 6 x y z^2 =
    /// 900 and 2 x z^3 = 500.
    #[test]
    fn products_by_hand() {
        let set = set("x*y^2*z^3", &["x", "y", "z"]);
        let found = set.mixed(0, &[2.0, 3.0, 5.0], &[(0, 1), (0, 2), (1, 2), (1, 1)]);
        assert_eq!(found, Some(vec![750.0, 675.0, 900.0, 500.0]));
    }

    /// Compares with jets, which apply the chain rule in another way. The formulas cover every function, a branch, a tie that does not
    /// count, and an absent variable. Differences are roundings of a few dozen operations.
    #[test]
    fn all_functions_agree_with_jets() {
        let names = ["a", "b", "c", "d", "e"];
        let formulas = [
            "sqrt(a*b)*exp(c/4) + ln(a + b*c) - log10(d)*sin(a*d)",
            "cos(a - b)*tan(c/5) + asin(a/9)*acos(b/9) + atan(c*d)",
            "sinh(a/3)*cosh(b/3) + tanh(c*d/9) + hypot(a*b, c - d) + atan2(a*c, b)",
            "if(a < b, a^b*c, d^3) + max(a*d, b) + min(c, a^2*b) + abs(a - c*d)",
            "(a*b)^-2.5/(c + d^4) + -c/a + a^(b/2) + floor(a)*b*c + sign(d)*a*b",
            "if(a*0 + 3, b*c, sqrt(0 - a)) + d*a",
        ];
        let at = [1.3, 2.1, 0.7, 1.9, 5.0];
        let pairs: Vec<(usize, usize)> = (0..5).flat_map(|j| (0..5).map(move |k| (j, k))).collect();
        for text in formulas {
            let set = set(text, &names);
            let found = set.mixed(0, &at, &pairs).expect(text);
            for (&(j, k), found) in pairs.iter().zip(found) {
                let along = |d: usize| [j, k].map(|direction| f64::from(u8::from(d == direction)));
                let jet = set.jets(&[0], |d| Jet::variable(at[d], along(d)))[0].second().expect(text);
                assert!((found - jet).abs() <= 1e-13 * (1.0 + jet.abs()), "{text} by {j}, {k}: {found} for {jet}");
            }
            let pure = set.pure(0, &at, &[4, 0, 1, 2, 3]).expect(text);
            for (&d, [first, second]) in [4, 0, 1, 2, 3].iter().zip(pure) {
                let jet = set.jets(&[0], |index| Jet::variable(at[index], [f64::from(u8::from(index == d)); 2]))[0];
                let (of_jet, curvature) = (jet.first(0).expect(text), jet.second().expect(text));
                assert!((first - of_jet).abs() <= 1e-13 * (1.0 + of_jet.abs()), "{text} by {d}: {first} for {of_jet}");
                assert!((second - curvature).abs() <= 1e-13 * (1.0 + curvature.abs()), "{text} by {d}: {second}");
            }
        }
    }

    /// If a derivative may not exist, the result is None, and jets decide.
    #[test]
    fn kinks_and_edges_say_nothing() {
        for text in ["abs(x) + y", "min(x, y)", "sqrt(x)*y", "if(x, 1, y)", "floor(x)*y", "x/0", "if(x < y, x, y*x)"] {
            assert_eq!(set(text, &["x", "y"]).mixed(0, &[0.0, 0.0], &[(0, 1)]), None, "{text}");
            assert_eq!(set(text, &["x", "y"]).pure(0, &[0.0, 0.0], &[0, 1]), None, "{text}");
        }
        // A constant has no kink, and a branch that is not taken does not count.
        let names = ["x", "y"];
        assert_eq!(set("abs(0) + x*y", &names).mixed(0, &[0.0, 0.0], &[(0, 1)]), Some(vec![1.0]));
        assert_eq!(set("if(x < 1, x*y, sqrt(x - 1))", &names).mixed(0, &[0.0, 2.0], &[(0, 1)]), Some(vec![1.0]));
    }
}
