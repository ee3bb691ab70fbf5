//! A program on whatever can be computed with: numbers, jets, intervals.

use super::functions::{Binary, Unary, select};
use super::program::{Branch, Operand, Program, Step};

/// A value that a program can be run on in place of columns of numbers.
pub(crate) trait Scalar: Clone {
    /// A number that never changes.
    fn constant(value: f64) -> Self;

    /// A function of one argument.
    fn unary(function: Unary, a: &Self) -> Self;

    /// A function of two arguments.
    fn binary(function: Binary, a: &Self, b: &Self) -> Self;

    /// The product of a value with itself, where it matters that both factors are the same.
    fn square(a: &Self) -> Self {
        Self::binary(Binary::Multiply, a, a)
    }

    /// The meaning of this value as the condition of an `if`.
    fn verdict(&self) -> Verdict;

    /// The value of an `if` whose condition is open, from both its branches.
    fn join(condition: &Self, then: Self, otherwise: Self) -> Self;
}

/// The outcome of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It is not 0: the first branch alone is run.
    Holds,
    /// It is 0: the second branch alone is run.
    Fails,
    /// It has no value, and so neither has the `if`.
    Undefined,
    /// It cannot be told: both branches are run and [joined](Scalar::join).
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
    /// Runs the program once, on what `variable` returns, and returns every result in order.
    ///
    /// `registers` is room that one run leaves to the next.
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
