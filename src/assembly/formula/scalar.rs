//! Programs on any type of value: numbers, jets, intervals.

use crate::assembly::formula::functions::{Binary, Unary, select};
use crate::assembly::formula::program::{Branch, Operand, Program, Step};

/// Value that a program can run on instead of columns of numbers.
pub(crate) trait Scalar: Clone {
    /// Returns a constant.
    fn constant(value: f64) -> Self;

    /// Applies a function of one argument.
    fn unary(function: Unary, a: &Self) -> Self;

    /// Applies a function of two arguments.
    fn binary(function: Binary, a: &Self, b: &Self) -> Self;

    /// Returns the product of a value with itself. Some types use that both factors are equal.
    fn square(a: &Self) -> Self {
        Self::binary(Binary::Multiply, a, a)
    }

    /// Returns the meaning of this value as the condition of an `if`.
    fn verdict(&self) -> Verdict;

    /// Returns the value of an `if` whose condition is open, from both branches.
    fn join(condition: &Self, then: Self, otherwise: Self) -> Self;
}

/// Outcome of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// The condition is not 0: only the first branch is run.
    Holds,
    /// The condition is 0: only the second branch is run.
    Fails,
    /// The condition has no value, so that the `if` has none.
    Undefined,
    /// The condition is not decided: both branches are run and [joined](Scalar::join).
    Open,
}

impl Scalar for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn unary(function: Unary, &a: &Self) -> Self {
        function.apply(a)
    }

    fn binary(function: Binary, &a: &Self, &b: &Self) -> Self {
        function.apply(a, b)
    }

    fn verdict(&self) -> Verdict {
        match *self {
            condition if condition.is_nan() => Verdict::Undefined,
            0.0 => Verdict::Fails,
            _ => Verdict::Holds,
        }
    }

    fn join(&condition: &Self, then: Self, otherwise: Self) -> Self {
        select(condition, then, otherwise)
    }
}

impl Program {
    /// Runs the program once on the values that `variable` returns, and returns every result in order.
    ///
    /// `registers` keeps memory from one run to the next.
    pub(super) fn evaluate<S: Scalar>(&self, variable: &impl Fn(usize) -> S, registers: &mut Vec<S>) -> Vec<S> {
        registers.resize(self.registers, S::constant(f64::NAN));
        let mut run = Evaluation { variable, registers };
        run.steps(&self.steps);
        self.results.iter().map(|&result| run.value(result)).collect()
    }
}

struct Evaluation<'r, S, V> {
    variable: &'r V,
    registers: &'r mut [S],
}

impl<S: Scalar, V: Fn(usize) -> S> Evaluation<'_, S, V> {
    fn value(&self, operand: Operand) -> S {
        match operand {
            Operand::Constant(value) => S::constant(value),
            Operand::Variable(index) => (self.variable)(index),
            Operand::Register(register) => self.registers[register].clone(),
        }
    }

    fn steps(&mut self, steps: &[Step]) {
        for step in steps {
            match step {
                Step::Unary { function, a, to } => self.registers[*to] = S::unary(*function, &self.value(*a)),
                Step::Binary { function: Binary::Multiply, a, b, to } if a == b => {
                    self.registers[*to] = S::square(&self.value(*a));
                }
                Step::Binary { function, a, b, to } => {
                    self.registers[*to] = S::binary(*function, &self.value(*a), &self.value(*b));
                }
                Step::If { condition, then, otherwise, to } => {
                    let condition = self.value(*condition);
                    self.registers[*to] = match condition.verdict() {
                        Verdict::Holds => self.branch(then),
                        Verdict::Fails => self.branch(otherwise),
                        Verdict::Undefined => S::constant(f64::NAN),
                        Verdict::Open => {
                            let then = self.branch(then);
                            S::join(&condition, then, self.branch(otherwise))
                        }
                    };
                }
            }
        }
    }

    fn branch(&mut self, branch: &Branch) -> S {
        self.steps(&branch.steps);
        self.value(branch.result)
    }
}
