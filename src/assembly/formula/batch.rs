//! A program on columns.

use super::functions::{Binary, Unary, select};
use super::program::{Branch, Operand, Program, Step};
use crate::elementary::{self, Elementary, Work, on_this_processor};

/// Rows that go through the program together: few enough that all registers stay in the nearest cache.
pub(super) const LANES: usize = 256;

/// Runs a program on blocks of at most [`LANES`] rows.
pub(super) struct Machine<'a> {
    program: &'a Program,
    registers: Vec<Vec<f64>>,
}

/// One operand's values: a column, or the same number everywhere.
#[derive(Clone, Copy)]
enum Values<'a> {
    Same(f64),
    Each(&'a [f64]),
}

impl<'a> Machine<'a> {
    pub(super) fn new(program: &'a Program) -> Self {
        Self { program, registers: vec![vec![0.0; LANES]; program.registers] }
    }

    /// Evaluates `rows` rows, whose variables are the slices that `variable` returns, and hands out every result.
    pub(super) fn run<'v>(
        &mut self,
        rows: usize,
        variable: &impl Fn(usize) -> &'v [f64],
        mut result: impl FnMut(usize, &[f64]),
    ) {
        assert!(rows <= LANES, "a block of at most {LANES} rows");
        self.steps(&self.program.steps, rows, variable);
        for (index, &operand) in self.program.results.iter().enumerate() {
            match self.values(operand, rows, variable) {
                Values::Same(value) => result(index, &[value; LANES][..rows]),
                Values::Each(values) => result(index, values),
            }
        }
    }

    fn values<'s, 'v: 's>(
        &'s self,
        operand: Operand,
        rows: usize,
        variable: &impl Fn(usize) -> &'v [f64],
    ) -> Values<'s> {
        match operand {
            Operand::Constant(value) => Values::Same(value),
            Operand::Variable(index) => Values::Each(&variable(index)[..rows]),
            Operand::Register(register) => Values::Each(&self.registers[register][..rows]),
        }
    }

    fn steps<'v>(&mut self, steps: &'a [Step], rows: usize, variable: &impl Fn(usize) -> &'v [f64]) {
        for step in steps {
            match step {
                Step::Unary { function, a, to } => self.write_register(*to, |machine, out| {
                    unary(*function, machine.values(*a, rows, variable), &mut out[..rows]);
                }),
                Step::Binary { function, a, b, to } => self.write_register(*to, |machine, out| {
                    let (a, b) = (machine.values(*a, rows, variable), machine.values(*b, rows, variable));
                    binary(*function, a, b, &mut out[..rows]);
                }),
                Step::If { condition, then, otherwise, to } => {
                    self.branch(*condition, then, otherwise, *to, rows, variable);
                }
            }
        }
    }

    /// A branch that no row takes is not computed.
    fn branch<'v>(
        &mut self,
        condition: Operand,
        then: &'a Branch,
        otherwise: &'a Branch,
        to: usize,
        rows: usize,
        variable: &impl Fn(usize) -> &'v [f64],
    ) {
        let (mut any, mut all) = (false, true);
        match self.values(condition, rows, variable) {
            Values::Same(value) => (any, all) = (value != 0.0, value != 0.0),
            Values::Each(values) => values.iter().for_each(|&value| {
                any |= value != 0.0;
                all &= value != 0.0;
            }),
        }
        if any {
            self.steps(&then.steps, rows, variable);
        }
        if !all {
            self.steps(&otherwise.steps, rows, variable);
        }
        self.write_register(to, |machine, out| {
            let condition = machine.values(condition, rows, variable);
            let branch = |taken: bool, branch: &Branch| {
                if taken { machine.values(branch.result, rows, variable) } else { Values::Same(f64::NAN) }
            };
            let (then, otherwise) = (branch(any, then), branch(!all, otherwise));
            for (row, out) in out[..rows].iter_mut().enumerate() {
                *out = select(condition.at(row), then.at(row), otherwise.at(row));
            }
        });
    }

    /// Takes a register out while the others are read: no operation writes to one of its own operands.
    fn write_register(&mut self, to: usize, operation: impl FnOnce(&Self, &mut [f64])) {
        let mut out = std::mem::take(&mut self.registers[to]);
        operation(self, &mut out);
        self.registers[to] = out;
    }
}

impl Values<'_> {
    fn at(&self, row: usize) -> f64 {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values[row],
        }
    }
}

/// A loop per function, so that the compiler sees each one alone.
fn unary(function: Unary, a: Values<'_>, out: &mut [f64]) {
    macro_rules! each {
        ($($name:ident),*; $($block:ident),*) => {
            match function {
                $(Unary::$name => map(a, out, |x| Unary::$name.apply(x)),)*
                $(Unary::$block => block::<elementary::$block>(a, out),)*
            }
        };
    }
    each!(
        Negate, Abs, Sqrt, Log10, Asin, Atan, Sinh, Cosh, Tanh, Floor, Ceil, Sign;
        Exp, Ln, Sin, Cos, Tan, Acos
    );
}

fn block<E: Elementary>(a: Values<'_>, out: &mut [f64]) {
    match a {
        Values::Same(x) => out.fill(E::of(x)),
        Values::Each(a) => E::map(a, out),
    }
}

fn map(a: Values<'_>, out: &mut [f64], function: impl Fn(f64) -> f64) {
    match a {
        Values::Same(x) => out.fill(function(x)),
        Values::Each(a) => out.iter_mut().zip(a).for_each(|(out, &x)| *out = function(x)),
    }
}

fn binary(function: Binary, a: Values<'_>, b: Values<'_>, out: &mut [f64]) {
    macro_rules! each {
        ($($name:ident),*) => {
            match function {
                $(Binary::$name => on_this_processor(Zip { a, b, out, function: |x, y| Binary::$name.apply(x, y) }),)*
            }
        };
    }
    each!(
        Add,
        Subtract,
        Multiply,
        Divide,
        Power,
        Less,
        LessEqual,
        Greater,
        GreaterEqual,
        Equal,
        NotEqual,
        Min,
        Max,
        Atan2,
        Hypot
    );
}

struct Zip<'a, F> {
    a: Values<'a>,
    b: Values<'a>,
    out: &'a mut [f64],
    function: F,
}

impl<F: Fn(f64, f64) -> f64> Work for Zip<'_, F> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { a, b, out, function } = self;
        match (a, b) {
            (Values::Each(a), Values::Each(b)) => {
                out.iter_mut().zip(a).zip(b).for_each(|((out, &x), &y)| *out = function(x, y));
            }
            (Values::Each(a), Values::Same(y)) => out.iter_mut().zip(a).for_each(|(out, &x)| *out = function(x, y)),
            (Values::Same(x), Values::Each(b)) => out.iter_mut().zip(b).for_each(|(out, &y)| *out = function(x, y)),
            (Values::Same(x), Values::Same(y)) => out.fill(function(x, y)),
        }
    }
}
