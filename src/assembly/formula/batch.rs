//! Programs on columns of numbers.

use crate::assembly::formula::functions::{Binary, Unary, for_each_binary, select};
use crate::assembly::formula::program::{Branch, Operand, Program, Step};
use sensitol_numeric::elementary::{self, Elementary, Work, on_this_processor};

/// Number of rows that pass through the program together, so few that all registers stay in the nearest cache.
pub(super) const LANES: usize = 256;

/// Evaluator of a program on blocks of at most [`LANES`] rows.
///
/// A value that is equal in all rows of a block is computed once: at the points of a difference plan most variables are at their means.
pub(super) struct Machine<'a> {
    program: &'a Program,
    registers: Vec<Vec<f64>>,
    /// Value of every register that is equal in all rows of this block; None if it varies.
    same: Vec<Option<f64>>,
    /// Value of every variable that is equal in all rows, up to the last variable that the program uses.
    variables: Vec<Option<f64>>,
}

/// Values of one operand: a column, or one number for all rows.
#[derive(Clone, Copy)]
enum Values<'a> {
    Same(f64),
    Each(&'a [f64]),
}

impl<'a> Machine<'a> {
    pub(super) fn new(program: &'a Program) -> Self {
        let variables = program.variables.last().map_or(0, |last| last + 1);
        Self {
            program,
            registers: vec![vec![0.0; LANES]; program.registers],
            same: vec![None; program.registers],
            variables: vec![None; variables],
        }
    }

    /// Evaluates `rows` rows, whose variables are the slices that `variable` returns, and passes every column of results to `result`.
    pub(super) fn run<'v>(
        &mut self,
        rows: usize,
        variable: &impl Fn(usize) -> &'v [f64],
        mut result: impl FnMut(usize, &[f64]),
    ) {
        assert!(rows <= LANES, "a block of at most {LANES} rows");
        for &index in &self.program.variables {
            self.variables[index] = the_same(&variable(index)[..rows]);
        }
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
            Operand::Variable(index) => match self.variables[index] {
                Some(value) => Values::Same(value),
                None => Values::Each(&variable(index)[..rows]),
            },
            Operand::Register(register) => match self.same[register] {
                Some(value) => Values::Same(value),
                None => Values::Each(&self.registers[register][..rows]),
            },
        }
    }

    fn steps<'v>(&mut self, steps: &'a [Step], rows: usize, variable: &impl Fn(usize) -> &'v [f64]) {
        for step in steps {
            match step {
                Step::Unary { function, a, to } => self.write_register(*to, |machine, out| {
                    unary(*function, machine.values(*a, rows, variable), &mut out[..rows])
                }),
                Step::Binary { function, a, b, to } => self.write_register(*to, |machine, out| {
                    let (a, b) = (machine.values(*a, rows, variable), machine.values(*b, rows, variable));
                    binary(*function, a, b, &mut out[..rows])
                }),
                Step::If { condition, then, otherwise, to } => {
                    self.branch(*condition, then, otherwise, *to, rows, variable);
                }
            }
        }
    }

    /// Evaluates an `if`. A branch that no row takes is not computed.
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
            if let (Values::Same(condition), Values::Same(then), Values::Same(otherwise)) = (condition, then, otherwise)
            {
                return Some(select(condition, then, otherwise));
            }
            for (row, out) in out[..rows].iter_mut().enumerate() {
                *out = select(condition.at(row), then.at(row), otherwise.at(row));
            }
            None
        });
    }

    /// Writes a register while the others are read. No operation writes to one of its own operands. If the result is equal in all rows, the
    /// operation returns it and writes nothing.
    fn write_register(&mut self, to: usize, operation: impl FnOnce(&Self, &mut [f64]) -> Option<f64>) {
        let mut out = std::mem::take(&mut self.registers[to]);
        self.same[to] = operation(self, &mut out);
        self.registers[to] = out;
    }
}

/// Returns the number that all of these values are, to the bit. Returns None if they differ.
fn the_same(values: &[f64]) -> Option<f64> {
    let (first, last) = (values.first()?, values.last()?);
    // In most columns that vary, the ends differ already.
    let ends = first.to_bits() == last.to_bits();
    (ends && on_this_processor(AllLike { values, bits: first.to_bits() })).then_some(*first)
}

struct AllLike<'a> {
    values: &'a [f64],
    bits: u64,
}

impl Work for AllLike<'_> {
    type Output = bool;

    #[inline(always)]
    fn work(self) -> bool {
        self.values.iter().fold(0, |differing, value| differing | (value.to_bits() ^ self.bits)) == 0
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

/// Applies a function, with a separate loop for each one, so that the compiler can optimise it. A result that is equal in all rows is
/// returned instead.
fn unary(function: Unary, a: Values<'_>, out: &mut [f64]) -> Option<f64> {
    let a = match a {
        Values::Same(x) => return Some(function.apply(x)),
        Values::Each(a) => a,
    };
    macro_rules! each {
        ($($name:ident),*; $($block:ident),*) => {
            match function {
                $(Unary::$name => out.iter_mut().zip(a).for_each(|(out, &x)| *out = Unary::$name.apply(x)),)*
                $(Unary::$block => elementary::$block::map(a, out),)*
            }
        };
    }
    each!(
        Negate, Abs, Sqrt, Log10, Asin, Atan, Sinh, Cosh, Tanh, Floor, Ceil, Sign;
        Exp, Ln, Sin, Cos, Tan, Acos
    );
    None
}

/// Applies a function of two operands like `unary`.
fn binary(function: Binary, a: Values<'_>, b: Values<'_>, out: &mut [f64]) -> Option<f64> {
    if let (Values::Same(x), Values::Same(y)) = (a, b) {
        return Some(function.apply(x, y));
    }
    for_each_binary!(function, FUNCTION => on_this_processor(Zip { a, b, out, function: |x, y| FUNCTION.apply(x, y) }));
    None
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

#[cfg(test)]
mod tests {
    use crate::assembly::formula::{Formula, FormulaSet, Meaning};

    /// Values do not depend on the block: blocks in which some variables are constant give the same bits as single rows.
    #[test]
    fn what_is_the_same_in_a_block_is_what_it_is_row_by_row() {
        const ROWS: usize = 600;
        let formulas = [
            "sqrt(a*b)*exp(c/4) + ln(a + b*c) - log10(d)*sin(a*d)",
            "cos(a - b)*tan(c/5) + asin(a/9)*acos(b/9) + atan(c*d)",
            "sinh(a/3)*cosh(b/3) + tanh(c*d/9) + hypot(a*b, c - d) + atan2(a*c, b)",
            "if(a < b, a^b*c, d^3) + max(a*d, b) + min(c, a^2*b) + abs(a - c*d)",
            "if(b > 2, a, if(c > 0, d, a/0)) + floor(a) + ceil(b) + sign(c - d)",
            "b^2 - b",
        ];
        let names = ["a", "b", "c", "d"];
        // One variable varies everywhere, one never, one in the second block only, one in a single row.
        let column = |of: fn(usize) -> f64| (0..ROWS).map(of).collect::<Vec<f64>>();
        let columns = [
            column(|row| 1.0 + 0.001 * row as f64),
            column(|_| 2.1),
            column(|row| if (256..512).contains(&row) { 0.3 + 0.002 * row as f64 } else { 0.7 }),
            column(|row| if row == 40 { 1.4 } else { 1.9 }),
        ];
        for text in formulas {
            let meanings = names.iter().enumerate().map(|(index, name)| (*name, Meaning::Variable(index)));
            let formula = vec![("y".to_owned(), Formula::parse(text).expect(text))];
            let set = FormulaSet::new(formula, meanings).expect(text);
            let mut together = vec![f64::NAN; ROWS];
            set.evaluate(&[0], ROWS, |index| &columns[index], |_, row, value| together[row] = value);
            for row in 0..ROWS {
                let mut alone = f64::NAN;
                set.evaluate(&[0], 1, |index| &columns[index][row..=row], |_, _, value| alone = value);
                assert_eq!(alone.to_bits(), together[row].to_bits(), "{text} in row {row}");
            }
        }
    }
}
