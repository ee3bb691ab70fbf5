//! Symbolic first derivatives: operations of the graph that compute the slope of other operations.

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::graph::{Graph, GraphNode, NodeId};

impl Graph {
    /// Adds the derivatives of `roots` by a variable. Returns None for one that is 0 everywhere.
    ///
    /// A derivative is NaN at a kink: at 0 of `abs`, at equal operands of `min` and `max`, and at the limit of an `if`. Functions in
    /// steps (`floor`, `sign`, comparisons) have the derivative 0, at their jumps as well.
    pub(super) fn slopes(&mut self, roots: &[NodeId], variable: usize) -> Vec<Option<NodeId>> {
        let needed = self.needed(roots.iter().copied());
        let mut slopes: Vec<Option<NodeId>> = vec![None; needed.len()];
        let mut moves = vec![false; needed.len()];
        for id in (0..needed.len()).filter(|&id| needed[id]) {
            let node = self.nodes()[id];
            moves[id] = node == GraphNode::Variable(variable) || node.operands().any(|operand| moves[operand as usize]);
            if !moves[id] {
                continue;
            }
            let slope = |operand: NodeId| slopes[operand as usize];
            slopes[id] = match node {
                GraphNode::Constant(_) => None,
                GraphNode::Variable(_) => Some(self.constant(1.0)),
                GraphNode::Unary(function, a) => {
                    slope(a).and_then(|slope| self.unary_slope(function, a, id as NodeId, slope))
                }
                GraphNode::Binary(function, a, b) => {
                    self.binary_slope(function, [a, b], [slope(a), slope(b)], id as NodeId)
                }
                GraphNode::If(condition, then, otherwise) => {
                    let (slopes, turns) = ([slope(then), slope(otherwise)], slope(condition).is_some());
                    self.branch_slope((condition, turns), slopes, &moves)
                }
            };
        }
        roots.iter().map(|&root| slopes[root as usize]).collect()
    }

    /// Adds the slope of `y`, a function of `a`.
    fn unary_slope(&mut self, function: Unary, a: NodeId, y: NodeId, slope: NodeId) -> Option<NodeId> {
        let one = self.constant(1.0);
        let square = |graph: &mut Self, x| graph.binary(Binary::Multiply, x, x);
        let rate = match function {
            Unary::Negate => return Some(self.unary(Unary::Negate, slope)),
            // 0/0 at the kink.
            Unary::Abs => self.binary(Binary::Divide, a, y),
            Unary::Sqrt => {
                let half = self.constant(0.5);
                self.binary(Binary::Divide, half, y)
            }
            Unary::Exp => y,
            Unary::Ln => return Some(self.binary(Binary::Divide, slope, a)),
            Unary::Log10 => {
                let scale = self.constant(std::f64::consts::LOG10_E);
                self.binary(Binary::Divide, scale, a)
            }
            Unary::Sin => self.unary(Unary::Cos, a),
            Unary::Cos => {
                let sine = self.unary(Unary::Sin, a);
                self.unary(Unary::Negate, sine)
            }
            Unary::Tan => {
                let square = square(self, y);
                self.binary(Binary::Add, one, square)
            }
            Unary::Asin | Unary::Acos => {
                let [below, above] = [Binary::Subtract, Binary::Add].map(|sign| self.binary(sign, one, a));
                let product = self.binary(Binary::Multiply, below, above);
                let root = self.unary(Unary::Sqrt, product);
                let sign = self.constant(if function == Unary::Asin { 1.0 } else { -1.0 });
                self.binary(Binary::Divide, sign, root)
            }
            Unary::Atan => {
                let square = square(self, a);
                let sum = self.binary(Binary::Add, one, square);
                return Some(self.binary(Binary::Divide, slope, sum));
            }
            Unary::Sinh => self.unary(Unary::Cosh, a),
            Unary::Cosh => self.unary(Unary::Sinh, a),
            Unary::Tanh => {
                let square = square(self, y);
                self.binary(Binary::Subtract, one, square)
            }
            Unary::Floor | Unary::Ceil | Unary::Sign => return None,
        };
        self.product(Some(rate), Some(slope))
    }

    /// Adds the slope of `y`, a function of `a` and `b`.
    fn binary_slope(
        &mut self,
        function: Binary,
        [a, b]: [NodeId; 2],
        [of_a, of_b]: [Option<NodeId>; 2],
        y: NodeId,
    ) -> Option<NodeId> {
        match function {
            Binary::Add => self.sum(of_a, of_b),
            Binary::Subtract => self.difference(of_a, of_b),
            Binary::Multiply => {
                let (first, second) = (self.product(of_a, Some(b)), self.product(Some(a), of_b));
                self.sum(first, second)
            }
            // The slope follows from y b = a.
            Binary::Divide => {
                let part = self.product(Some(y), of_b);
                let change = self.difference(of_a, part)?;
                Some(self.binary(Binary::Divide, change, b))
            }
            Binary::Power => self.power_slope([a, b], [of_a, of_b], y),
            Binary::Hypot => {
                let (first, second) = (self.product(Some(a), of_a), self.product(Some(b), of_b));
                let sum = self.sum(first, second)?;
                Some(self.binary(Binary::Divide, sum, y))
            }
            Binary::Atan2 => {
                let (first, second) = (self.product(Some(b), of_a), self.product(Some(a), of_b));
                let across = self.difference(first, second)?;
                let [of_a, of_b] = [a, b].map(|side| self.binary(Binary::Multiply, side, side));
                let square = self.binary(Binary::Add, of_a, of_b);
                Some(self.binary(Binary::Divide, across, square))
            }
            Binary::Min => self.lesser_slope([a, b], [of_a, of_b]),
            Binary::Max => self.lesser_slope([b, a], [of_a, of_b]),
            Binary::Less
            | Binary::LessEqual
            | Binary::Greater
            | Binary::GreaterEqual
            | Binary::Equal
            | Binary::NotEqual => None,
        }
    }

    /// Adds the slope of `y = a^b`.
    fn power_slope(&mut self, [a, b]: [NodeId; 2], [of_a, of_b]: [Option<NodeId>; 2], y: NodeId) -> Option<NodeId> {
        let one = self.constant(1.0);
        if of_b.is_none() {
            if self.constant_value(b) == Some(0.0) {
                return None;
            }
            let less = self.binary(Binary::Subtract, b, one);
            let power = self.binary(Binary::Power, a, less);
            let rate = self.product(Some(b), Some(power));
            return self.product(rate, of_a);
        }
        let logarithm = self.unary(Unary::Ln, a);
        let by_exponent = self.product(of_b, Some(logarithm));
        let relative = of_a.map(|of_a| self.binary(Binary::Divide, of_a, a));
        let by_base = self.product(Some(b), relative);
        let sum = self.sum(by_exponent, by_base);
        self.product(Some(y), sum)
    }

    /// Adds an `if` that is the first slope where `a` is less than `b`, the second one where it is greater, and NaN where both are equal.
    fn lesser_slope(&mut self, [a, b]: [NodeId; 2], slopes: [Option<NodeId>; 2]) -> Option<NodeId> {
        slopes.iter().any(Option::is_some).then(|| {
            let [of_a, of_b] = slopes.map(|slope| slope.unwrap_or_else(|| self.constant(0.0)));
            let tie = self.constant(f64::NAN);
            let greater = self.binary(Binary::Greater, a, b);
            let rest = self.branch(greater, of_b, tie);
            let less = self.binary(Binary::Less, a, b);
            self.branch(less, of_a, rest)
        })
    }

    /// Adds the slope of an `if`, which is NaN where its condition changes: at equal operands of a comparison, or at 0 if it has a slope.
    fn branch_slope(
        &mut self,
        (condition, turns): (NodeId, bool),
        branches: [Option<NodeId>; 2],
        moves: &[bool],
    ) -> Option<NodeId> {
        branches.iter().any(Option::is_some).then(|| {
            let [then, otherwise] = branches.map(|slope| slope.unwrap_or_else(|| self.constant(0.0)));
            let mut slope = self.branch(condition, then, otherwise);
            let needed = self.needed([condition]);
            let zero = self.constant(0.0);
            let compared = |id: usize| match self.nodes()[id] {
                GraphNode::Binary(function, a, b) if function.compares() => Some([a, b]),
                _ => None,
            };
            let deciding = (0..moves.len()).filter(|&id| needed[id] && moves[id]);
            let limits: Vec<[NodeId; 2]> =
                deciding.filter_map(compared).chain(turns.then_some([condition, zero])).collect();
            let tie = self.constant(f64::NAN);
            for [a, b] in limits {
                let equal = self.binary(Binary::Equal, a, b);
                slope = self.branch(equal, tie, slope);
            }
            slope
        })
    }

    fn product(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        let (a, b) = (a?, b?);
        match (self.constant_value(a), self.constant_value(b)) {
            (Some(0.0), _) | (_, Some(0.0)) => None,
            (Some(1.0), _) => Some(b),
            (_, Some(1.0)) => Some(a),
            (Some(-1.0), _) => Some(self.unary(Unary::Negate, b)),
            (_, Some(-1.0)) => Some(self.unary(Unary::Negate, a)),
            _ => Some(self.binary(Binary::Multiply, a, b)),
        }
    }

    fn sum(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.binary(Binary::Add, a, b)),
            (a, b) => a.or(b),
        }
    }

    fn difference(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.binary(Binary::Subtract, a, b)),
            (None, Some(b)) => Some(self.unary(Unary::Negate, b)),
            (a, None) => a,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::assembly::formula::jet::Jet;
    use crate::assembly::formula::program::Program;
    use crate::assembly::formula::{Formula, FormulaSet, Meaning};

    const NAMES: [&str; 3] = ["a", "b", "c"];

    fn set(text: &str) -> FormulaSet {
        let meanings = NAMES.iter().enumerate().map(|(index, name)| (*name, Meaning::Variable(index)));
        FormulaSet::new(vec![("y".to_owned(), Formula::parse(text).expect(text))], meanings).expect(text)
    }

    /// Returns the derivative of a formula by a variable at a point.
    fn slope(set: &FormulaSet, variable: usize, at: [f64; 3]) -> f64 {
        let mut graph = set.graph.clone();
        let Some(slope) = graph.slopes(&set.roots, variable)[0] else { return 0.0 };
        Program::of(&graph, &[slope]).evaluate(&|index: usize| at[index], &mut Vec::new())[0]
    }

    fn jet(set: &FormulaSet, variable: usize, at: [f64; 3]) -> Option<f64> {
        let along = |index: usize| [f64::from(u8::from(index == variable)), 0.0];
        set.jets(&[0], |index| Jet::variable(at[index], along(index)))[0].first(0)
    }

    #[test]
    fn symbolic_derivatives_are_those_of_jets() {
        let formulas = [
            "-a + 3*b - c/2 + 1",
            "sqrt(a*b)*exp(c/4) + ln(a + b*c) - log10(b)*sin(a*c)",
            "cos(a - b)*tan(c/5) + asin(a/9)*acos(b/9) + atan(b*c)",
            "sinh(a/3)*cosh(b/3) + tanh(c*a/9) + hypot(a*b, c - a) + atan2(a*c, b - 3)",
            "a^2 + b^3 + c^4 + a^-1 + b^0.5 + c^2.5 + a^b + 2^c + (a + b)^(c - 1) + 1^a + a^0",
            "if(a < b, a^b*c, c^3) + max(a*c, b) + min(c, a^2*b, 4) + abs(a - c*b)",
            "if(b > 2, a, if(c > 0, b, a*c)) + floor(a) + ceil(b) + sign(c - b)*a",
            "if(a - 0.3, b*c, a) + if((a < b)*(b < c), a, b)*(a >= 1) + (1/a)/(b/c) - 0*a",
        ];
        for text in formulas {
            let set = set(text);
            for step in 0..20 {
                let at = [0.37, 0.83, 0.59].map(|rate: f64| 0.4 + (rate * f64::from(step + 1)).fract() * 2.9);
                for (variable, name) in NAMES.iter().enumerate() {
                    let (symbolic, exact) = (slope(&set, variable, at), jet(&set, variable, at).expect(text));
                    let close = (symbolic - exact).abs() <= 1e-13 * exact.abs().max(1.0);
                    assert!(close, "{text} by {name}: {symbolic}, {exact} at {at:?}");
                }
            }
        }
    }

    #[test]
    fn a_kink_has_no_derivative() {
        let at = [1.0, 1.0, 0.0];
        for text in ["abs(c)", "min(a, b)", "max(a, 1)", "if(a < b, a, 2*a)", "if(c, a + c, b)", "if((a <= 1)*b, a, b)"]
        {
            let set = set(text);
            let variable = usize::from(text.contains("abs") || text.contains("(c,")) * 2;
            assert!(slope(&set, variable, at).is_nan(), "{text}");
        }
        // Neither a kink of another variable counts, nor a jump.
        assert_eq!(slope(&set("abs(c) + 2*a"), 0, at), 2.0);
        assert_eq!(slope(&set("floor(a) + if(c > 0, 3, 4)"), 0, at), 0.0);
        assert_eq!(slope(&set("if(b > 1, a, 2*a)"), 0, at), 2.0);
    }
}
