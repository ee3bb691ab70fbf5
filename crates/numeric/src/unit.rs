//! Units of measurement: a factor to SI, seven exponents, a count of radians, and symbols.
//!
//! Syntax: `N.m/rad`, `kg.m^2`, `mm2`, `m/s²`, `1/K`, `W/m^2/K`. Products are written with `.`, `*`, `·` or a space, and `/` inverts the
//! one factor after it. Names come before prefixes: `min` is a minute, `in` an inch, `mil` a thousandth of one. The factors are exact by
//! definition (NIST SP 811, 2008, appendix B.8, and the international agreements named there).

use std::f64::consts::PI;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and candela.
pub(crate) type Dimension = [f64; 7];

/// Inch in metres, exact by definition.
const INCH: f64 = 0.0254;
/// Pound-force in newton: 0.45359237 kg times 9.80665 m/s².
const POUND_FORCE: f64 = 4.4482216152605;
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
    Symbol("thou", INCH / 1e3, LENGTH, 0.0, false),
    Symbol("mil", INCH / 1e3, LENGTH, 0.0, false),
    Symbol("uin", INCH * 1e-6, LENGTH, 0.0, false),
    Symbol("ft", 0.3048, LENGTH, 0.0, false),
    Symbol("micron", 1e-6, LENGTH, 0.0, false),
    Symbol("lb", 0.45359237, MASS, 0.0, false),
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

impl Unit {
    /// Unit of a plain number.
    pub fn one() -> Self {
        Self { scale: 1.0, dimension: NONE, radians: 0.0, point: false, symbols: Vec::new() }
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
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        if text.is_empty() {
            return Some(Self::one());
        }
        if let Some(unit) = Self::of_symbol(text) {
            return Some(unit);
        }
        let mut unit = Self::one();
        let (mut inverse, mut rest, mut wants) = (false, text, true);
        while !rest.is_empty() {
            let character = rest.chars().next()?;
            if ['.', '*', '\u{b7}', ' ', '/'].contains(&character) {
                // A second `/` before the next symbol is a typing error.
                if character == '/' && inverse && wants {
                    return None;
                }
                inverse |= character == '/';
                wants = true;
                rest = &rest[character.len_utf8()..];
                continue;
            }
            let end = rest.find(['.', '*', '\u{b7}', ' ', '/']).unwrap_or(rest.len());
            let factor = Self::of_factor(&rest[..end])?;
            unit = if inverse { unit.over(&factor) } else { unit.times(&factor) };
            (inverse, wants, rest) = (false, false, &rest[end..]);
        }
        (!wants && unit.scale.is_finite() && unit.scale > 0.0).then_some(unit)
    }

    /// Symbol with an exponent, such as `mm2`, `m^-1` or `s²`.
    fn of_factor(text: &str) -> Option<Self> {
        let text = text
            .replace('\u{b2}', "^2")
            .replace('\u{b3}', "^3")
            .replace("\u{207b}\u{b9}", "^-1")
            .replace('\u{2212}', "-");
        if text == "1" {
            return Some(Self::one());
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
        let unit = Self::of_symbol(symbol).filter(|unit| !unit.point)?;
        Some(unit.to_the(exponent))
    }

    fn of_symbol(name: &str) -> Option<Self> {
        if ["degC", "\u{b0}C"].contains(&name) {
            let symbols = vec![("degC".to_owned(), 1.0)];
            return Some(Self { dimension: TEMPERATURE, point: true, symbols, ..Self::one() });
        }
        let of = |Symbol(_, scale, dimension, radians, _): &Symbol, factor: f64| Self {
            scale: scale * factor,
            dimension: *dimension,
            radians: *radians,
            point: false,
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
        Self { point: false, symbols: vec![("K".to_owned(), 1.0)], ..self.clone() }
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
        ] {
            let [a, b] = [text, same].map(|text| Unit::parse(text).unwrap_or_else(|| panic!("{text}")));
            assert!(a.same_kind(&b), "{text}");
            assert!((a.scale / b.scale / factor - 1.0).abs() < 1e-14, "{text} {}", a.scale / b.scale);
        }
        for text in ["bar(g)", "furlong", "m//s", "kmin", "degC/m", "m/", "mmm", "degF"] {
            assert!(Unit::parse(text).is_none(), "{text}");
        }
        assert_eq!(Unit::parse("kN/mm^2").unwrap().to_string(), "kN/mm^2");
        assert_eq!(Unit::parse("1/K").unwrap().to_string(), "1/K");
    }
}
