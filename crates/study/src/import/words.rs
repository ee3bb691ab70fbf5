//! Words in the cells of stack-up tables, in English and German.

use crate::import::columns::plain;

/// Words for distributions in tables, by the name of the kind in a study.
const DISTRIBUTIONS: [(&str, &[&str]); 8] = [
    ("normal", &["normal", "gauss", "gaussian", "normalverteilung", "n", "normal 3s"]),
    ("uniform", &["uniform", "rectangular", "gleich", "gleichverteilung", "rechteck", "r"]),
    ("triangular", &["triangular", "triangle", "dreieck", "dreieckverteilung"]),
    ("beta", &["beta"]),
    ("trapezoidal", &["trapezoidal", "trapez", "trapezoid"]),
    ("lognormal", &["lognormal", "log-normal", "log normal"]),
    ("exponential", &["exponential", "exponentialverteilung"]),
    ("rayleigh", &["rayleigh", "betragsverteilung"]),
];
/// Distributions that a fault names.
pub(super) const KNOWN_DISTRIBUTIONS: &str = "normal, uniform, triangular, beta or trapezoidal";
/// Words for the direction of a dimension that is added.
const PLUS: [&str; 14] = [
    "+", "+1", "1", "right", "rechts", "up", "plus", "add", "positive", "positiv", "pos", "\u{2192}", "\u{2191}",
    "+1.0",
];
/// Words for the direction of a dimension that is subtracted.
const MINUS: [&str; 13] = [
    "-", "-1", "left", "links", "down", "minus", "subtract", "negative", "negativ", "neg", "\u{2190}", "\u{2193}",
    "-1.0",
];
/// Directions that a fault names.
pub(super) const KNOWN_DIRECTIONS: &str = "+, -, 1, -1, right or left";
/// Names of rows that hold a result of the table, not a dimension.
const TOTALS: [&str; 18] = [
    "total",
    "sum",
    "summe",
    "gesamt",
    "gesamtsumme",
    "result",
    "ergebnis",
    "gap",
    "spalt",
    "spiel",
    "schliessmass",
    "closing dimension",
    "stack",
    "stack up",
    "worst case",
    "rss",
    "clearance",
    "gap target",
];
/// Names of rows that hold the sum of the rows above them, or of those since the last such row.
const SUBTOTALS: [&str; 6] = ["subtotal", "sub total", "sub-total", "zwischensumme", "teilsumme", "partial sum"];
/// Words before the lower limit of the characteristic.
const LOWER_LIMIT: [&str; 13] = [
    "lower limit",
    "lower",
    "lsl",
    "min",
    "minimum",
    "minimum gap",
    "min gap",
    "untere grenze",
    "unteres grenzmass",
    "utg",
    "usg",
    "mindestspiel",
    "mindestmass",
];
/// Words before the upper limit of the characteristic.
const UPPER_LIMIT: [&str; 14] = [
    "upper limit",
    "upper",
    "usl",
    "max",
    "maximum",
    "maximum gap",
    "max gap",
    "obere grenze",
    "oberes grenzmass",
    "otg",
    "osg",
    "hochstspiel",
    "grosstspiel",
    "hochstmass",
];
/// Words before both limits of the characteristic.
const LIMITS: [&str; 13] = [
    "limits",
    "limit",
    "grenzen",
    "grenzwerte",
    "grenzmasse",
    "requirement",
    "requirements",
    "anforderung",
    "forderung",
    "sollbereich",
    "target",
    "specification",
    "spezifikation",
];
/// Words that stand before limits only, so that a row with one of them as its name is not a dimension.
const NO_DIMENSION: [&str; 6] = ["limits", "limit", "grenzen", "grenzwerte", "grenzmasse", "sollbereich"];

/// Sign of a direction in a cell. Returns None for another word.
pub(super) fn direction(word: &str) -> Option<f64> {
    let word = crate::table::clean(word).to_lowercase();
    match (PLUS.contains(&word.as_str()), MINUS.contains(&word.as_str())) {
        (true, _) => Some(1.0),
        (_, true) => Some(-1.0),
        _ => None,
    }
}

/// Kind of distribution in a study for the word of a cell. Returns None for another word.
pub(super) fn distribution(word: &str) -> Option<&'static str> {
    let word = plain(word);
    DISTRIBUTIONS.iter().find(|(_, words)| words.contains(&word.as_str())).map(|(kind, _)| *kind)
}

/// True for the name of a row with a result of the table.
pub(super) fn is_total(name: &str) -> bool {
    let name = plain(name);
    TOTALS.contains(&name.trim_end_matches([' ', '=']))
}

/// True for the name of a row with the sum of some rows above.
pub(super) fn is_subtotal(name: &str) -> bool {
    SUBTOTALS.contains(&plain(name).trim_end_matches([' ', '=']))
}

/// True for a name that is never one of a dimension: its row holds both limits of the characteristic.
pub(super) fn names_both_limits(name: &str) -> bool {
    NO_DIMENSION.contains(&plain(name.trim_end_matches(['=', ' '])).as_str())
}

/// Limits that a word stands before: lower, upper or both. Returns None for another word.
pub(super) fn limit(word: &str) -> Option<[bool; 2]> {
    let word = plain(word.trim_end_matches(['=', ' ']));
    let word = word.as_str();
    match (LOWER_LIMIT.contains(&word), UPPER_LIMIT.contains(&word), LIMITS.contains(&word)) {
        (true, ..) => Some([true, false]),
        (_, true, _) => Some([false, true]),
        (.., true) => Some([true, true]),
        _ => None,
    }
}
