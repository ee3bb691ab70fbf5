//! Units of measurement: a factor to SI, seven exponents, a count of radians, and symbols.
//!
//! Syntax: `N.m/rad`, `kg.m^2`, `mm2`, `m/s²`, `1/K`, `W/m^2/K`, `um/(m*K)`, `10^-6/K`. Products are written with `.`, `*`, `·`, a space or a hyphen
//! between letters, and `/` inverts the one factor or bracket after it. Names come before prefixes: `min` is a minute, `in` an inch, `mil` a
//! thousandth of one. A temperature scale is a point where it stands alone (`degC`), and a difference in a product (`ppm/degC`). The
//! factors are exact by definition (NIST SP 811, 2008, appendix B.8, and the international agreements named there).

use std::f64::consts::PI;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and candela.
pub(crate) type Dimension = [f64; 7];

/// Inch in metres, exact by definition.
const INCH: f64 = 0.0254;
/// Pound-force in newton: 0.45359237 kg times 9.80665 m/s².
const POUND_FORCE: f64 = 4.4482216152605;
/// Zero of the Celsius scale in kelvin, exact by definition.
const CELSIUS_ZERO: f64 = 273.15;
/// Degree Fahrenheit in kelvin, exact by definition.
const FAHRENHEIT: f64 = 5.0 / 9.0;
/// Zero of the Fahrenheit scale in kelvin: 459.67 degrees above absolute zero.
const FAHRENHEIT_ZERO: f64 = 459.67 * 5.0 / 9.0;
/// Tolerance between two equal scales or exponents. A factor has rounding errors only.
pub const SAME: f64 = 1e-9;

/// Unit of measurement, also of a part of a formula.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Factor to SI: a value times this is the value in SI.
    pub scale: f64,
    pub(crate) dimension: Dimension,
    /// Exponent of the radian. Radians may be dropped, never added.
    pub radians: f64,
    /// True for a temperature on a scale with another zero: a point, not a difference.
    pub point: bool,
    /// Zero of the scale of a point in SI: 273.15 for degC; 0 of other units.
    pub zero: f64,
    /// Symbols with their exponents, in the order of writing.
    symbols: Vec<(String, f64)>,
}

/// Symbol of a unit, its factor to SI, its exponents, its radians, and true if it takes prefixes.
struct Symbol(&'static str, f64, Dimension, f64, bool);

const NONE: Dimension = [0.0; 7];
const LENGTH: Dimension = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
const MASS: Dimension = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
const TIME: Dimension = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
const CURRENT: Dimension = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
const TEMPERATURE: Dimension = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
const VOLUME: Dimension = [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
const RATE: Dimension = [0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0];
const FORCE: Dimension = [1.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0];
const PRESSURE: Dimension = [-1.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0];
const ENERGY: Dimension = [2.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0];
const POWER: Dimension = [2.0, 1.0, -3.0, 0.0, 0.0, 0.0, 0.0];

#[rustfmt::skip]
const SYMBOLS: &[Symbol] = &[
    Symbol("m", 1.0, LENGTH, 0.0, true),
    Symbol("g", 1e-3, MASS, 0.0, true),
    Symbol("s", 1.0, TIME, 0.0, true),
    Symbol("A", 1.0, CURRENT, 0.0, true),
    Symbol("K", 1.0, TEMPERATURE, 0.0, true),
    Symbol("mol", 1.0, [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0], 0.0, true),
    Symbol("cd", 1.0, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 0.0, true),
    Symbol("rad", 1.0, NONE, 1.0, true),
    Symbol("deg", PI / 180.0, NONE, 1.0, false),
    Symbol("degree", PI / 180.0, NONE, 1.0, false),
    Symbol("degrees", PI / 180.0, NONE, 1.0, false),
    Symbol("\u{b0}", PI / 180.0, NONE, 1.0, false),
    Symbol("gon", PI / 200.0, NONE, 1.0, false),
    Symbol("arcmin", PI / 10800.0, NONE, 1.0, false),
    Symbol("arcsec", PI / 648_000.0, NONE, 1.0, false),
    Symbol("rev", 2.0 * PI, NONE, 1.0, false),
    Symbol("rpm", PI / 30.0, RATE, 1.0, false),
    Symbol("Hz", 1.0, RATE, 0.0, true),
    Symbol("N", 1.0, FORCE, 0.0, true),
    Symbol("Nm", 1.0, ENERGY, 0.0, false),
    Symbol("Pa", 1.0, PRESSURE, 0.0, true),
    Symbol("bar", 1e5, PRESSURE, 0.0, true),
    Symbol("J", 1.0, ENERGY, 0.0, true),
    Symbol("W", 1.0, POWER, 0.0, true),
    Symbol("V", 1.0, [2.0, 1.0, -3.0, -1.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("ohm", 1.0, [2.0, 1.0, -3.0, -2.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("Ohm", 1.0, [2.0, 1.0, -3.0, -2.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("\u{2126}", 1.0, [2.0, 1.0, -3.0, -2.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("\u{3a9}", 1.0, [2.0, 1.0, -3.0, -2.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("C", 1.0, [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("F", 1.0, [-2.0, -1.0, 4.0, 2.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("H", 1.0, [2.0, 1.0, -2.0, -2.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("T", 1.0, [0.0, 1.0, -2.0, -1.0, 0.0, 0.0, 0.0], 0.0, true),
    Symbol("L", 1e-3, VOLUME, 0.0, true),
    Symbol("l", 1e-3, VOLUME, 0.0, true),
    Symbol("t", 1e3, MASS, 0.0, false),
    Symbol("min", 60.0, TIME, 0.0, false),
    Symbol("h", 3600.0, TIME, 0.0, false),
    Symbol("d", 86400.0, TIME, 0.0, false),
    Symbol("in", INCH, LENGTH, 0.0, false),
    Symbol("\"", INCH, LENGTH, 0.0, false),
    Symbol("inch", INCH, LENGTH, 0.0, false),
    Symbol("inches", INCH, LENGTH, 0.0, false),
    Symbol("thou", INCH / 1e3, LENGTH, 0.0, false),
    Symbol("mil", INCH / 1e3, LENGTH, 0.0, false),
    Symbol("mils", INCH / 1e3, LENGTH, 0.0, false),
    Symbol("uin", INCH * 1e-6, LENGTH, 0.0, false),
    Symbol("\u{b5}in", INCH * 1e-6, LENGTH, 0.0, false),
    Symbol("\u{3bc}in", INCH * 1e-6, LENGTH, 0.0, false),
    Symbol("ft", 0.3048, LENGTH, 0.0, false),
    Symbol("micron", 1e-6, LENGTH, 0.0, false),
    Symbol("microns", 1e-6, LENGTH, 0.0, false),
    Symbol("lb", 0.45359237, MASS, 0.0, false),
    Symbol("lbm", 0.45359237, MASS, 0.0, false),
    Symbol("oz", 0.45359237 / 16.0, MASS, 0.0, false),
    Symbol("lbf", POUND_FORCE, FORCE, 0.0, false),
    Symbol("kgf", 9.80665, FORCE, 0.0, false),
    Symbol("psi", POUND_FORCE / (INCH * INCH), PRESSURE, 0.0, false),
    Symbol("ksi", 1e3 * POUND_FORCE / (INCH * INCH), PRESSURE, 0.0, false),
    Symbol("atm", 101_325.0, PRESSURE, 0.0, false),
    Symbol("%", 1e-2, NONE, 0.0, false),
    Symbol("\u{2030}", 1e-3, NONE, 0.0, false),
    Symbol("ppm", 1e-6, NONE, 0.0, false),
    Symbol("1", 1.0, NONE, 0.0, false),
    Symbol("-", 1.0, NONE, 0.0, false),
];

const PREFIXES: [(&str, f64); 14] = [
    ("da", 1e1),
    ("T", 1e12),
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("h", 1e2),
    ("d", 1e-1),
    ("c", 1e-2),
    ("m", 1e-3),
    ("u", 1e-6),
    ("\u{b5}", 1e-6),
    ("\u{3bc}", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
];

/// Characters between the factors of a product.
const SEPARATORS: [char; 8] = ['.', '*', '\u{b7}', '\u{22c5}', '\u{2219}', '\u{d7}', ' ', '/'];
/// Deepest nesting of brackets.
const DEEPEST: usize = 8;
/// Spellings of units, each with the one that is read.
const SPELLINGS: [(&str, &str); 22] = [
    ("\u{b0} C", "degC"),
    ("\u{b0}C", "degC"),
    ("\u{ba}C", "degC"),
    ("\u{2103}", "degC"),
    ("deg C", "degC"),
    ("deg. C", "degC"),
    ("\u{b0} F", "degF"),
    ("\u{b0}F", "degF"),
    ("\u{ba}F", "degF"),
    ("\u{2109}", "degF"),
    ("deg F", "degF"),
    ("deg. F", "degF"),
    (" per ", "/"),
    (" / ", "/"),
    ("\u{2215}", "/"),
    ("\u{2044}", "/"),
    ("\u{2212}", "-"),
    ("\u{207b}", "^-"),
    ("\u{b2}", "^2"),
    ("\u{b3}", "^3"),
    ("^(-", "^-("),
    ("^^", "^"),
];
/// Superscript digits but 2 and 3, in the order of their values.
const SUPERSCRIPTS: [(char, char); 8] = [
    ('\u{2070}', '0'),
    ('\u{b9}', '1'),
    ('\u{2074}', '4'),
    ('\u{2075}', '5'),
    ('\u{2076}', '6'),
    ('\u{2077}', '7'),
    ('\u{2078}', '8'),
    ('\u{2079}', '9'),
];

/// Text of a unit in the spelling that is read: powers as `^-2`, temperature scales as `degC` and `degF`.
fn spelling(text: &str) -> String {
    let mut text = text.trim().to_owned();
    for (from, to) in SPELLINGS {
        text = text.replace(from, to);
    }
    let superscript = |c: char| SUPERSCRIPTS.iter().find(|(known, _)| *known == c).map(|(_, digit)| *digit);
    let mut read = String::new();
    let all: Vec<char> = text.chars().collect();
    for (place, c) in all.iter().enumerate() {
        let before = place.checked_sub(1).map(|place| all[place]);
        match superscript(*c) {
            Some(digit) => {
                // The first of several superscripts begins an exponent.
                if before.is_none_or(|before| superscript(before).is_none() && before != '-') {
                    read.push('^');
                }
                read.push(digit);
            }
            None if *c == '-'
                && before.is_some_and(char::is_alphabetic)
                && all.get(place + 1).is_some_and(|c| c.is_alphabetic()) =>
            {
                read.push('*');
            }
            None => read.push(*c),
        }
    }
    // An exponent in brackets: K^(2), K^-(1).
    while let Some(open) = ["^(", "^-("].iter().find_map(|mark| read.find(mark).map(|at| at + mark.len() - 1)) {
        let Some(close) = read[open..].find(')').map(|at| open + at) else { break };
        if !read[open + 1..close].bytes().all(|byte| byte.is_ascii_digit()) {
            break;
        }
        read.remove(close);
        read.remove(open);
    }
    read
}

/// Exponent of a power of ten: -6 of `10^-6`, `10-6`, `1e-6` and `e-6`. Returns None for another text.
fn power_of_ten(text: &str) -> Option<i32> {
    let digits = ["10^", "1e", "1E", "e", "E"].iter().find_map(|mark| text.strip_prefix(mark));
    let digits = digits.or_else(|| text.strip_prefix("10").filter(|rest| rest.starts_with('-')))?;
    digits.parse().ok().filter(|power: &i32| power.abs() <= 30)
}

impl Unit {
    /// Unit of a plain number.
    pub fn one() -> Self {
        Self { scale: 1.0, dimension: NONE, radians: 0.0, point: false, zero: 0.0, symbols: Vec::new() }
    }

    /// Unit of an angle in radians.
    pub fn radian() -> Self {
        Self { radians: 1.0, symbols: vec![("rad".to_owned(), 1.0)], ..Self::one() }
    }

    /// Unit of the factor that turns degrees into radians.
    pub fn radians_of_a_degree() -> Self {
        let degree = Self { scale: PI / 180.0, symbols: vec![("deg".to_owned(), 1.0)], ..Self::radian() };
        Self::radian().over(&degree)
    }

    /// Unit of the same kind in SI, with the symbols of this one.
    pub fn in_si(self) -> Self {
        Self { scale: 1.0, ..self }
    }

    /// Reads a unit. Returns None if it is unknown.
    ///
    /// ```
    /// use sensitol_numeric::unit::Unit;
    /// let expansion = Unit::parse("um/(m*K)").ok_or("unknown")?;
    /// let same = Unit::parse("ppm/degC").ok_or("unknown")?;
    /// assert!(expansion.same_kind(&same) && (expansion.scale / same.scale - 1.0).abs() < 1e-15);
    /// assert!(Unit::parse("furlong").is_none());
    /// # Ok::<(), &str>(())
    /// ```
    pub fn parse(text: &str) -> Option<Self> {
        let text = spelling(text);
        if text.is_empty() {
            return Some(Self::one());
        }
        let unit = Self::of_symbol(&text).or_else(|| Self::product(&text, 0))?;
        (unit.scale.is_finite() && unit.scale > 0.0).then_some(unit)
    }

    /// Product of factors and brackets.
    fn product(text: &str, depth: usize) -> Option<Self> {
        let mut unit = Self::one();
        let (mut inverse, mut rest, mut wants) = (false, text, true);
        while !rest.is_empty() {
            let character = rest.chars().next()?;
            if SEPARATORS.contains(&character) {
                // A second `/` before the next symbol is a typing error.
                if character == '/' && inverse && wants {
                    return None;
                }
                inverse |= character == '/';
                wants = true;
                rest = &rest[character.len_utf8()..];
                continue;
            }
            if !wants {
                return None;
            }
            let (factor, end) = if ['(', '['].contains(&character) {
                Self::bracket(rest, depth)?
            } else {
                let end = rest.find(|c| SEPARATORS.contains(&c)).unwrap_or(rest.len());
                (Self::of_factor(&rest[..end])?, end)
            };
            unit = if inverse { unit.over(&factor) } else { unit.times(&factor) };
            (inverse, wants, rest) = (false, false, &rest[end..]);
        }
        (!wants).then_some(unit)
    }

    /// Bracket at the beginning of a text with its exponent, and the place behind it.
    fn bracket(text: &str, depth: usize) -> Option<(Self, usize)> {
        let mut open = 0;
        let close = text.char_indices().find_map(|(at, c)| {
            open += i32::from(['(', '['].contains(&c)) - i32::from([')', ']'].contains(&c));
            (open == 0).then_some(at)
        })?;
        let inner = text[1..close].trim();
        if depth == DEEPEST || inner.is_empty() {
            return None;
        }
        let unit = Self::of_factor(inner).or_else(|| Self::product(inner, depth + 1))?;
        let behind = &text[close + 1..];
        let end = behind.find(|c| SEPARATORS.contains(&c)).unwrap_or(behind.len());
        let exponent = match behind[..end].trim_start_matches('^') {
            "" => 1.0,
            exponent => f64::from(exponent.parse::<i32>().ok()?),
        };
        Some((unit.to_the(exponent), close + 1 + end))
    }

    /// Symbol with an exponent, such as `mm2` or `m^-1`, or a power of ten.
    fn of_factor(text: &str) -> Option<Self> {
        if text == "1" {
            return Some(Self::one());
        }
        if let Some(power) = power_of_ten(text) {
            let symbols = vec![(format!("1e{power}"), 1.0)];
            return Some(Self { scale: format!("1e{power}").parse().ok()?, symbols, ..Self::one() });
        }
        let digits = text.len() - text.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let (mut symbol, exponent) = text.split_at(text.len() - digits);
        let mut exponent: f64 = if digits == 0 { 1.0 } else { exponent.parse().ok()? };
        if digits > 0
            && let Some(negative) = symbol.strip_suffix('-')
        {
            (symbol, exponent) = (negative, -exponent);
        }
        let symbol = if digits > 0 { symbol.strip_suffix('^').unwrap_or(symbol) } else { symbol };
        // A temperature in a product is a difference.
        Some(Self::of_symbol(symbol)?.difference().to_the(exponent))
    }

    fn of_symbol(name: &str) -> Option<Self> {
        let scale = |symbol: &str, scale: f64, zero: f64| {
            let symbols = vec![(symbol.to_owned(), 1.0)];
            Some(Self { dimension: TEMPERATURE, scale, zero, point: true, symbols, ..Self::one() })
        };
        match name {
            "degC" => return scale("degC", 1.0, CELSIUS_ZERO),
            "degF" => return scale("degF", FAHRENHEIT, FAHRENHEIT_ZERO),
            _ => {}
        }
        let of = |Symbol(_, scale, dimension, radians, _): &Symbol, factor: f64| Self {
            scale: scale * factor,
            dimension: *dimension,
            radians: *radians,
            point: false,
            zero: 0.0,
            symbols: if ["1", "-"].contains(&name) { Vec::new() } else { vec![(name.to_owned(), 1.0)] },
        };
        if let Some(symbol) = SYMBOLS.iter().find(|symbol| symbol.0 == name) {
            return Some(of(symbol, 1.0));
        }
        PREFIXES.iter().find_map(|(prefix, factor)| {
            let rest = name.strip_prefix(prefix)?;
            SYMBOLS.iter().find(|symbol| symbol.0 == rest && symbol.4).map(|symbol| of(symbol, *factor))
        })
    }

    /// Product of two units.
    pub fn times(&self, other: &Self) -> Self {
        self.with(other, 1.0)
    }

    /// Quotient of two units.
    pub fn over(&self, other: &Self) -> Self {
        self.with(other, -1.0)
    }

    fn with(&self, other: &Self, sign: f64) -> Self {
        let mut symbols = self.symbols.clone();
        for (name, exponent) in &other.symbols {
            match symbols.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += sign * exponent,
                None => symbols.push((name.clone(), sign * exponent)),
            }
        }
        symbols.retain(|(_, exponent)| *exponent != 0.0);
        Self {
            scale: if sign > 0.0 { self.scale * other.scale } else { self.scale / other.scale },
            dimension: std::array::from_fn(|base| self.dimension[base] + sign * other.dimension[base]),
            radians: self.radians + sign * other.radians,
            point: false,
            zero: 0.0,
            symbols,
        }
    }

    /// Unit raised to a power.
    pub fn to_the(&self, exponent: f64) -> Self {
        // Compute whole powers as products, so that mm² is 1e-6 as nearly as a double allows.
        let scale =
            if exponent.fract() == 0.0 { self.scale.powi(exponent as i32) } else { libm::pow(self.scale, exponent) };
        Self {
            scale,
            dimension: self.dimension.map(|own| own * exponent),
            radians: self.radians * exponent,
            point: self.point && exponent == 1.0,
            zero: if exponent == 1.0 { self.zero } else { 0.0 },
            symbols: self.symbols.iter().map(|(name, own)| (name.clone(), own * exponent)).collect(),
        }
    }

    /// True if both units measure the same kind of quantity.
    pub fn same_kind(&self, other: &Self) -> bool {
        self.dimension.iter().zip(&other.dimension).all(|(a, b)| (a - b).abs() < SAME)
    }

    /// True if the unit has no kind: a plain number, an angle, a percentage.
    pub fn is_plain(&self) -> bool {
        self.dimension.iter().all(|exponent| exponent.abs() < SAME)
    }

    /// Unit of the difference of two such values: K for a temperature in degC.
    pub fn difference(&self) -> Self {
        if !self.point {
            return self.clone();
        }
        let symbol = if self.zero == FAHRENHEIT_ZERO { "degF" } else { "K" };
        Self { point: false, zero: 0.0, symbols: vec![(symbol.to_owned(), 1.0)], ..self.clone() }
    }
}

impl std::fmt::Display for Unit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let factor = |name: &str, exponent: f64| match exponent {
            1.0 => name.to_owned(),
            exponent => format!("{name}^{exponent}"),
        };
        let above = self.symbols.iter().filter(|(_, exponent)| *exponent > 0.0);
        let below = self.symbols.iter().filter(|(_, exponent)| *exponent < 0.0);
        let above: Vec<String> = above.map(|(name, exponent)| factor(name, *exponent)).collect();
        f.write_str(if above.is_empty() { "1" } else { "" })?;
        f.write_str(&above.join("."))?;
        below.into_iter().try_for_each(|(name, exponent)| write!(f, "/{}", factor(name, -exponent)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spellings of an expansion coefficient. A degree Fahrenheit is 5/9 K, so that 1/degF is 9/5 1/K.
    #[test]
    fn expansion_coefficients_are_read_as_people_write_them() {
        let per_kelvin = [
            "ppm/degC",
            "ppm/K",
            "ppm/\u{b0}C",
            "ppm/deg C",
            "um/m/degC",
            "um/(m*K)",
            "\u{b5}m/(m\u{b7}K)",
            "\u{3bc}m/(m K)",
            "\u{b5}m/m/\u{b0}C",
            "um/(m.degC)",
            "10^-6/K",
            "10\u{207b}\u{2076}/K",
            "1e-6/K",
            "10-6/K",
            "1e-6 1/degC",
            "ppm K^-1",
            "ppm per K",
            "ppm\u{b7}K\u{207b}\u{b9}",
            "um/m K^(-1)",
            "10^-6 mm/mm/degC",
            "(um/m)/K",
            "uin/in/K",
            "ppm/\u{2103}",
        ];
        for text in per_kelvin {
            let unit = Unit::parse(text).unwrap_or_else(|| panic!("{text}"));
            assert!(unit.same_kind(&Unit::parse("1/K").unwrap()) && !unit.point, "{text}");
            assert!((unit.scale / 1e-6 - 1.0).abs() < 1e-14, "{text} {}", unit.scale);
        }
        for text in ["1/K", "/K", "1/degC", "1/\u{b0}C", "mm/mm/degC", "m/(m*K)", "K^-1", "K\u{207b}\u{b9}"] {
            let unit = Unit::parse(text).unwrap_or_else(|| panic!("{text}"));
            assert!(unit.same_kind(&Unit::parse("1/K").unwrap()) && (unit.scale - 1.0).abs() < 1e-14, "{text}");
        }
        for (text, factor) in [("1/degF", 1.8), ("uin/in/degF", 1.8e-6), ("ppm/\u{b0}F", 1.8e-6), ("in/(in*degF)", 1.8)]
        {
            let unit = Unit::parse(text).unwrap_or_else(|| panic!("{text}"));
            assert!((unit.scale / factor - 1.0).abs() < 1e-14, "{text} {}", unit.scale);
        }
    }

    /// Reference: twelve factors of NIST SP 811, appendix B.8, in `tests/data/elements.json`. Exact factors are compared to rounding.
    #[test]
    fn factors_are_those_of_sp_811() {
        let text =
            std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/elements.json")).unwrap();
        let cases: serde_json::Value = serde_json::from_str(&text).unwrap();
        let case = cases["cases"].as_array().unwrap().iter().find(|case| case["name"] == "units-sp811").unwrap();
        assert_eq!(case["printed"].as_object().unwrap().len(), 12);
        for (name, printed) in case["printed"].as_object().unwrap() {
            let (from, to) = name.split_once(' ').unwrap();
            let (from, to) = (Unit::parse(from).unwrap(), Unit::parse(to).unwrap());
            assert!(from.same_kind(&to), "{name}");
            let found = from.scale / to.scale;
            assert!(
                (found - printed["value"].as_f64().unwrap()).abs() <= printed["tolerance"].as_f64().unwrap(),
                "{name}"
            );
            let exact = case["exact"][name].as_f64().unwrap();
            assert!((found - exact).abs() <= 4.0 * f64::EPSILON * exact, "{name}: {found} {exact}");
        }
    }

    #[test]
    fn units_are_read_as_they_are_written() {
        for (text, same, factor) in [
            ("N.m/rad", "kg m²/s²", 1.0),
            ("kg.m^2", "g.mm2", 1e9),
            ("m/s²", "mm/s/s", 1e3),
            ("1/K", "K^-1", 1.0),
            ("W/m^2/K", "W/m^2.1/K", 1.0),
            ("mm/min", "um/s", 1000.0 / 60.0),
            ("GPa", "N/mm^2", 1e3),
            ("\u{b5}m", "mm", 1e-3),
            ("%", "1", 1e-2),
            ("", "-", 1.0),
            ("min", "s", 60.0),
            ("mil", "in", 1e-3),
            ("dam", "m", 10.0),
            ("N-m", "N.m", 1.0),
            ("W/(m^2 K)", "W/m^2/K", 1.0),
            ("1/(s)^2", "s^-2", 1.0),
            ("degC/m", "K/m", 1.0),
            ("kOhm", "\u{2126}", 1e3),
            ("lbm", "kg", 0.45359237),
            ("\u{b5}in", "in", 1e-6),
        ] {
            let [a, b] = [text, same].map(|text| Unit::parse(text).unwrap_or_else(|| panic!("{text}")));
            assert!(a.same_kind(&b), "{text}");
            assert!((a.scale / b.scale / factor - 1.0).abs() < 1e-14, "{text} {}", a.scale / b.scale);
        }
        for text in
            ["bar(g)", "furlong", "m//s", "kmin", "m/", "mmm", "(m", "m)", "()", "m/(s", "K**-1", "degX", "10^-400/K"]
        {
            assert!(Unit::parse(text).is_none(), "{text}");
        }
        let [celsius, fahrenheit] = ["degC", "\u{b0}F"].map(|text| Unit::parse(text).unwrap());
        assert!(celsius.point && fahrenheit.point && celsius.zero != fahrenheit.zero);
        assert_eq!(Unit::parse("kN/mm^2").unwrap().to_string(), "kN/mm^2");
        assert_eq!(Unit::parse("1/K").unwrap().to_string(), "1/K");
    }
}
