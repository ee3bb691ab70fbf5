//! Functions and operators of formulas, on numbers.

use sensitol_numeric::elementary::{self, Elementary};

/// Function or operator of one argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Unary {
    /// `-x`
    Negate,
    /// `abs(x)`
    Abs,
    /// `sqrt(x)`
    Sqrt,
    /// `exp(x)`
    Exp,
    /// `ln(x)`
    Ln,
    /// `log10(x)`
    Log10,
    /// `sin(x)`, x in radians
    Sin,
    /// `cos(x)`, x in radians
    Cos,
    /// `tan(x)`, x in radians
    Tan,
    /// `asin(x)`, in radians
    Asin,
    /// `acos(x)`, in radians
    Acos,
    /// `atan(x)`, in radians
    Atan,
    /// `sinh(x)`
    Sinh,
    /// `cosh(x)`
    Cosh,
    /// `tanh(x)`
    Tanh,
    /// `floor(x)`
    Floor,
    /// `ceil(x)`
    Ceil,
    /// `sign(x)`: -1, 0 or 1
    Sign,
}

/// Does the work once for every function of two arguments, which is the constant of the given name there. So the compiler can optimise
/// each one.
macro_rules! for_each_binary {
    ($function:expr, $name:ident => $work:expr) => {
        for_each_binary! {
            $function, $name => $work;
            Add, Subtract, Multiply, Divide, Power, Less, LessEqual, Greater, GreaterEqual, Equal, NotEqual, Min, Max, Atan2, Hypot
        }
    };
    ($function:expr, $name:ident => $work:expr; $($variant:ident),*) => {
        match $function {
            $(Binary::$variant => {
                const $name: Binary = Binary::$variant;
                $work
            })*
        }
    };
}
pub(super) use for_each_binary;

/// Function or operator of two arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Binary {
    /// `x + y`
    Add,
    /// `x - y`
    Subtract,
    /// `x * y`
    Multiply,
    /// `x / y`
    Divide,
    /// `x ^ y`
    Power,
    /// `x < y`: 1 or 0
    Less,
    /// `x <= y`: 1 or 0
    LessEqual,
    /// `x > y`: 1 or 0
    Greater,
    /// `x >= y`: 1 or 0
    GreaterEqual,
    /// `x == y`: 1 or 0
    Equal,
    /// `x != y`: 1 or 0
    NotEqual,
    /// `min(x, y, ...)`
    Min,
    /// `max(x, y, ...)`
    Max,
    /// `atan2(y, x)`, in radians
    Atan2,
    /// `hypot(x, y)`
    Hypot,
}

/// Function that a name in front of a parenthesis stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Callable {
    Unary(Unary),
    Binary(Binary),
    /// Function of two or more arguments, applied to two at a time.
    Fold(Binary),
    If,
}

impl Callable {
    const ALL: [(&'static str, Callable); 22] = [
        ("abs", Callable::Unary(Unary::Abs)),
        ("sqrt", Callable::Unary(Unary::Sqrt)),
        ("exp", Callable::Unary(Unary::Exp)),
        ("ln", Callable::Unary(Unary::Ln)),
        ("log10", Callable::Unary(Unary::Log10)),
        ("sin", Callable::Unary(Unary::Sin)),
        ("cos", Callable::Unary(Unary::Cos)),
        ("tan", Callable::Unary(Unary::Tan)),
        ("asin", Callable::Unary(Unary::Asin)),
        ("acos", Callable::Unary(Unary::Acos)),
        ("atan", Callable::Unary(Unary::Atan)),
        ("sinh", Callable::Unary(Unary::Sinh)),
        ("cosh", Callable::Unary(Unary::Cosh)),
        ("tanh", Callable::Unary(Unary::Tanh)),
        ("floor", Callable::Unary(Unary::Floor)),
        ("ceil", Callable::Unary(Unary::Ceil)),
        ("sign", Callable::Unary(Unary::Sign)),
        ("atan2", Callable::Binary(Binary::Atan2)),
        ("hypot", Callable::Binary(Binary::Hypot)),
        ("min", Callable::Fold(Binary::Min)),
        ("max", Callable::Fold(Binary::Max)),
        ("if", Callable::If),
    ];

    pub(super) fn of_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|&(_, callable)| callable)
    }

    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.iter().map(|&(name, _)| name)
    }

    /// Returns the fewest and the most arguments; None if there is no upper limit.
    pub(super) fn arity(self) -> (usize, Option<usize>) {
        match self {
            Self::Unary(_) => (1, Some(1)),
            Self::Binary(_) => (2, Some(2)),
            Self::Fold(_) => (2, None),
            Self::If => (3, Some(3)),
        }
    }
}

/// Named constants of formulas.
pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("deg", std::f64::consts::PI / 180.0)];

impl Unary {
    /// Applies the function to one number.
    #[inline]
    pub(crate) fn apply(self, x: f64) -> f64 {
        match self {
            Self::Negate => -x,
            Self::Abs => x.abs(),
            Self::Sqrt => x.sqrt(),
            Self::Exp => elementary::Exp::of(x),
            Self::Ln => elementary::Ln::of(x),
            Self::Log10 => libm::log10(x),
            Self::Sin => elementary::Sin::of(x),
            Self::Cos => elementary::Cos::of(x),
            Self::Tan => elementary::Tan::of(x),
            Self::Asin => libm::asin(x),
            Self::Acos => elementary::Acos::of(x),
            Self::Atan => libm::atan(x),
            Self::Sinh => libm::sinh(x),
            Self::Cosh => libm::cosh(x),
            Self::Tanh => libm::tanh(x),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
            Self::Sign if x == 0.0 => 0.0,
            Self::Sign => x.signum(),
        }
    }

    /// Returns the condition on the argument for a value to exist. Returns None for a function that has a value everywhere or fails by
    /// overflow only.
    pub(super) fn domain(self) -> Option<&'static str> {
        match self {
            Self::Asin | Self::Acos => Some("the argument must lie in -1 .. 1"),
            Self::Sqrt => Some("the argument must not be negative"),
            Self::Ln | Self::Log10 => Some("the argument must be above 0"),
            _ => None,
        }
    }
}

impl Binary {
    /// True for a comparison.
    pub(super) fn compares(self) -> bool {
        matches!(self, Self::Less | Self::LessEqual | Self::Greater | Self::GreaterEqual | Self::Equal | Self::NotEqual)
    }

    /// Applies the function to two numbers. An argument that is NaN always gives NaN. IEEE 754 drops it in some cases (`NaN ^ 0`,
    /// comparisons, `min`), and a domain error would then pass for a result.
    #[inline]
    pub(crate) fn apply(self, x: f64, y: f64) -> f64 {
        let truth = |is: bool| if x.is_nan() || y.is_nan() { f64::NAN } else { f64::from(u8::from(is)) };
        let guarded = |value: f64| if x.is_nan() || y.is_nan() { f64::NAN } else { value };
        match self {
            Self::Add => x + y,
            Self::Subtract => x - y,
            Self::Multiply => x * y,
            Self::Divide => x / y,
            Self::Power => guarded(libm::pow(x, y)),
            Self::Less => truth(x < y),
            Self::LessEqual => truth(x <= y),
            Self::Greater => truth(x > y),
            Self::GreaterEqual => truth(x >= y),
            Self::Equal => truth(x == y),
            Self::NotEqual => truth(x != y),
            Self::Min => guarded(x.min(y)),
            Self::Max => guarded(x.max(y)),
            Self::Atan2 => libm::atan2(x, y),
            Self::Hypot => guarded(libm::hypot(x, y)),
        }
    }
}

/// Evaluates `if(condition, x, y)` on numbers.
#[inline]
pub(super) fn select(condition: f64, x: f64, y: f64) -> f64 {
    if condition.is_nan() {
        f64::NAN
    } else if condition != 0.0 {
        x
    } else {
        y
    }
}
