//! Formulas as text, with their values at the present poses.

use crate::number::Number;

/// A formula and its value. Constant parts are folded, so that a simple geometry gives a simple formula.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Expression {
    value: f64,
    form: Form,
}

#[derive(Debug, Clone, PartialEq)]
enum Form {
    Constant,
    /// Text, and how tightly its outermost operation binds.
    Text(String, Binding),
}

/// Binding strength of the outermost operation of a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Whole,
}

impl Expression {
    /// A formula of the study, with its value.
    pub(crate) fn formula(text: &str, value: f64) -> Self {
        let form = match text.parse::<f64>() {
            Ok(_) => Form::Constant,
            Err(_) => Form::Text(text.to_owned(), Binding::Sum),
        };
        Self { value, form }
    }

    /// A constant length with its unit.
    pub(crate) fn length(value: f64, unit: &str) -> Self {
        let text = format!("{}[{unit}]", number(value.abs()));
        let text = if value < 0.0 { format!("-{text}") } else { text };
        Self { value, form: Form::Text(text, Binding::Product) }
    }

    /// A name in backquotes, with its value.
    pub(crate) fn name(name: &str, value: f64) -> Self {
        Self { value, form: Form::Text(format!("`{name}`"), Binding::Whole) }
    }

    /// True if the formula is a number or a single name.
    pub(crate) fn is_short(&self) -> bool {
        match &self.form {
            Form::Constant => true,
            Form::Text(text, _) => {
                let name = text.strip_prefix('-').unwrap_or(text);
                let quoted = name.strip_prefix('`').and_then(|rest| rest.strip_suffix('`'));
                quoted
                    .unwrap_or(name)
                    .chars()
                    .all(|c| c.is_alphanumeric() || c == '_' || (quoted.is_some() && c == '.'))
            }
        }
    }

    /// True if the formula is a number.
    pub(crate) fn is_constant(&self) -> bool {
        self.form == Form::Constant
    }

    /// Text of the formula.
    pub(crate) fn text(&self) -> String {
        match &self.form {
            Form::Constant => number(self.value),
            Form::Text(text, _) => text.clone(),
        }
    }

    /// Text as an operand of an operation that binds this tightly.
    fn operand(&self, least: Binding) -> String {
        match &self.form {
            Form::Constant if self.value < 0.0 => format!("({})", number(self.value)),
            Form::Constant => number(self.value),
            Form::Text(text, binding) if *binding >= least => text.clone(),
            Form::Text(text, _) => format!("({text})"),
        }
    }

    /// Formula that has the value of `then` where `greater` is the greater number, and of `otherwise` elsewhere.
    pub(crate) fn choice([greater, than]: [&Self; 2], then: &Self, otherwise: &Self) -> Self {
        let value = if greater.value > than.value { then.value } else { otherwise.value };
        let text = format!("if({} > {}, {}, {})", greater.text(), than.text(), then.text(), otherwise.text());
        Self { value, form: Form::Text(text, Binding::Whole) }
    }

    fn is(&self, value: f64) -> bool {
        self.is_constant() && self.value == value
    }

    fn call(&self, function: &str, value: f64) -> Self {
        if self.is_constant() {
            return Self::constant(value);
        }
        Self { value, form: Form::Text(format!("{function}({})", self.text()), Binding::Whole) }
    }

    fn call_of_two(&self, other: &Self, function: &str, value: f64) -> Self {
        if self.is_constant() && other.is_constant() {
            return Self::constant(value);
        }
        Self { value, form: Form::Text(format!("{function}({}, {})", self.text(), other.text()), Binding::Whole) }
    }
}

/// Shortest text that is read as this number again.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

impl Number for Expression {
    fn constant(value: f64) -> Self {
        Self { value, form: Form::Constant }
    }

    fn value(&self) -> f64 {
        self.value
    }

    fn plus(&self, other: &Self) -> Self {
        let value = self.value + other.value;
        match () {
            () if self.is_constant() && other.is_constant() => Self::constant(value),
            () if self.is(0.0) => other.clone(),
            () if other.is(0.0) => self.clone(),
            () if other.is_constant() && other.value < 0.0 => self.minus(&Self::constant(-other.value)),
            () => {
                let text = match other.operand(Binding::Product) {
                    term if term.starts_with('-') => format!("{} - {}", self.operand(Binding::Sum), &term[1..]),
                    term => format!("{} + {term}", self.operand(Binding::Sum)),
                };
                Self { value, form: Form::Text(text, Binding::Sum) }
            }
        }
    }

    fn minus(&self, other: &Self) -> Self {
        let value = self.value - other.value;
        match () {
            () if self.is_constant() && other.is_constant() => Self::constant(value),
            () if self.is(0.0) => other.negative(),
            () if other.is(0.0) => self.clone(),
            () if other.is_constant() && other.value < 0.0 => self.plus(&Self::constant(-other.value)),
            () => {
                let text = match other.operand(Binding::Product) {
                    term if term.starts_with('-') => format!("{} + {}", self.operand(Binding::Sum), &term[1..]),
                    term => format!("{} - {term}", self.operand(Binding::Sum)),
                };
                Self { value, form: Form::Text(text, Binding::Sum) }
            }
        }
    }

    fn times(&self, other: &Self) -> Self {
        let value = self.value * other.value;
        match () {
            () if self.is_constant() && other.is_constant() => Self::constant(value),
            () if self.is(0.0) || other.is(0.0) => Self::constant(0.0),
            () if self.is(1.0) => other.clone(),
            () if other.is(1.0) => self.clone(),
            () if self.is(-1.0) => other.negative(),
            () if other.is(-1.0) => self.negative(),
            () => {
                let text = format!("{}*{}", self.operand(Binding::Product), other.operand(Binding::Product));
                Self { value, form: Form::Text(text, Binding::Product) }
            }
        }
    }

    fn over(&self, other: &Self) -> Self {
        let value = self.value / other.value;
        match () {
            () if self.is_constant() && other.is_constant() => Self::constant(value),
            () if self.is(0.0) => Self::constant(0.0),
            () if other.is(1.0) => self.clone(),
            () => {
                let text = format!("{}/{}", self.operand(Binding::Product), other.operand(Binding::Whole));
                Self { value, form: Form::Text(text, Binding::Product) }
            }
        }
    }

    fn negative(&self) -> Self {
        if self.is_constant() {
            return Self::constant(if self.value == 0.0 { 0.0 } else { -self.value });
        }
        let text = match self.operand(Binding::Product) {
            text if text.starts_with('-') => text[1..].to_owned(),
            text => format!("-{text}"),
        };
        Self { value: -self.value, form: Form::Text(text, Binding::Product) }
    }

    fn square_root(&self) -> Self {
        self.call("sqrt", self.value.sqrt())
    }

    fn sine(&self) -> Self {
        self.call("sin", libm::sin(self.value))
    }

    fn cosine(&self) -> Self {
        self.call("cos", libm::cos(self.value))
    }

    fn angle_over(&self, x: &Self) -> Self {
        self.call_of_two(x, "atan2", libm::atan2(self.value, x.value))
    }

    fn length_with(&self, other: &Self) -> Self {
        self.call_of_two(other, "hypot", libm::hypot(self.value, other.value))
    }

    fn absolute(&self) -> Self {
        self.call("abs", self.value.abs())
    }

    fn greater(&self, other: &Self) -> Self {
        self.call_of_two(other, "max", self.value.max(other.value))
    }
}
