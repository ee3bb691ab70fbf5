//! Text of a study from the dimensions of a table.

use std::fmt::Write;

use crate::import::spread::Spread;
use crate::write::{inline, name as key, number, quoted};
use sensitol::assembly::formula::is_plain;
use sensitol_numeric::labels::LABELS;

/// A dimension of a table in numbers.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) name: String,
    pub(super) nominal: f64,
    pub(super) spread: Spread,
    /// Factor of the dimension in the sum.
    pub(super) factor: f64,
    pub(super) unit: Option<String>,
    pub(super) distribution: Option<&'static str>,
    /// Keys with numbers: sigma, sigmas, cp, cpk, shift.
    pub(super) numbers: Vec<(&'static str, f64)>,
    /// Texts for description, part, drawing, revision and feature, in this order.
    pub(super) labels: [Option<String>; 5],
}

/// The characteristic of a table.
#[derive(Debug, Clone, Default)]
pub(super) struct Target {
    pub(super) name: String,
    pub(super) lower: Option<f64>,
    pub(super) upper: Option<f64>,
    pub(super) target_yield: Option<f64>,
}

/// Section `[dimensions]`.
pub(super) fn dimensions(parts: &[Part]) -> String {
    let mut text = "[dimensions]\n".to_owned();
    let wide = parts.iter().map(|part| key(&part.name).chars().count()).max().unwrap_or(0);
    for part in parts {
        let mut pairs = vec![format!("nominal = {}", number(part.nominal))];
        pairs.extend(match &part.spread {
            Spread::None => None,
            Spread::Deviations([low, high]) if *low == -high => Some(format!("tolerance = {}", number(high.abs()))),
            Spread::Deviations([low, high]) => Some(format!("tolerance = [{}, {}]", number(*low), number(*high))),
            Spread::Limits([low, high]) => Some(format!("limits = [{}, {}]", number(*low), number(*high))),
            Spread::Percent(part) => Some(format!("tolerance = {}", quoted(&format!("{part}%")))),
            Spread::Class(class) => Some(format!("fit = {}", quoted(class))),
        });
        pairs.extend(part.unit.as_ref().map(|unit| format!("unit = {}", quoted(unit))));
        let kind = part.distribution.filter(|kind| *kind != "normal");
        pairs.extend(kind.map(|kind| format!("distribution = {}", quoted(kind))));
        pairs.extend(part.numbers.iter().map(|(key, value)| format!("{key} = {}", number(*value))));
        let labels = LABELS.into_iter().zip(&part.labels);
        pairs.extend(labels.filter_map(|(key, text)| Some(format!("{key} = {}", quoted(text.as_ref()?)))));
        let pad = wide - key(&part.name).chars().count();
        let _ = writeln!(text, "{}{:pad$} = {}", key(&part.name), "", inline(pairs));
    }
    text
}

/// Sum of the dimensions with their factors. Returns an empty text if every factor is 0.
pub(super) fn sum(parts: &[Part]) -> String {
    let mut formula = String::new();
    for part in parts.iter().filter(|part| part.factor != 0.0) {
        let name = if is_plain(&part.name) { part.name.clone() } else { format!("`{}`", part.name) };
        let sign = match (formula.is_empty(), part.factor < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let by = if part.factor.abs() == 1.0 { String::new() } else { format!("{}*", part.factor.abs()) };
        let _ = write!(formula, "{sign}{by}{name}");
    }
    formula
}

/// Section `[characteristics]`.
pub(super) fn characteristics(target: &Target, formula: &str, unit: Option<&str>) -> String {
    let mut pairs = vec![format!("formula = {}", quoted(formula))];
    pairs.extend(unit.map(|unit| format!("unit = {}", quoted(unit))));
    let values = [("lower", target.lower), ("upper", target.upper), ("target_yield", target.target_yield)];
    pairs.extend(values.iter().filter_map(|(key, value)| Some(format!("{key} = {}", number((*value)?)))));
    format!("\n[characteristics]\n{} = {}\n", key(&target.name), inline(pairs))
}

/// Title and section `[about]`.
pub(super) fn head(title: Option<&str>, about: &[(&'static str, String)]) -> String {
    let mut text = title.map(|title| format!("title = {}\n", quoted(title))).unwrap_or_default();
    if !about.is_empty() {
        text += "\n[about]\n";
        about.iter().for_each(|(key, value)| text += &format!("{key} = {}\n", quoted(value)));
    }
    if text.is_empty() { text } else { text + "\n" }
}
