//! Expands `[general]`: gives dimensions without a tolerance the general one of the drawing.
//!
//! # Source
//! ISO 2768-1:1989, table 1, for lengths. ISO 22081:2021 has no tables: values stand in the title block, here `length` and `angle`.

use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Expanded, Tree, Value, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::Unit;

/// Keys of a dimension that has no spread of its own.
const PLAIN: [&str; 17] = [
    "nominal",
    "unit",
    "from",
    "distribution",
    "sigmas",
    "cp",
    "cpk",
    "drift",
    "process",
    "rss_factor",
    "mean_shift",
    "description",
    "part",
    "drawing",
    "revision",
    "feature",
    "side",
];
/// Greatest size of each range, in millimetres.
const RANGES: [f64; 8] = [3.0, 6.0, 30.0, 120.0, 400.0, 1000.0, 2000.0, 4000.0];
/// Least size that the table covers, in millimetres.
const LEAST: f64 = 0.5;
/// Half tolerances of the classes in millimetres, by range; NaN where the standard has none.
const CLASSES: [(&str, [f64; 8]); 4] = [
    ("ISO 2768-f", [0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, f64::NAN]),
    ("ISO 2768-m", [0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0]),
    ("ISO 2768-c", [0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0]),
    ("ISO 2768-v", [f64::NAN, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0]),
];

/// General tolerance of lengths.
enum LengthTolerance {
    /// None is given.
    None,
    /// Half tolerances of a class, by size.
    Class(&'static str, [f64; 8]),
    /// Half tolerance of all sizes, in millimetres.
    Value(f64),
}

/// General tolerances of a study.
struct General {
    length: LengthTolerance,
    /// Half tolerance of angles, in degrees.
    angle: Option<f64>,
}

/// Gives every dimension that states neither a tolerance nor a spread the general tolerance of its quantity. Removes the section.
pub(super) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let Some(section) = expanded.tree.get("general").cloned() else { return Ok(()) };
    if let Some(sections) = expanded.tree.entries_mut() {
        sections.retain(|(key, _)| key.name != "general");
    }
    let general = read(&section)?;
    let mut faults = Faults::default();
    for (name, line) in expanded.tree.get_mut("dimensions").and_then(Tree::entries_mut).into_iter().flatten() {
        match tolerance(line, &general, &format!("dimensions.{}", name.name)) {
            Ok(None) => {}
            Ok(Some(value)) => {
                let value = Tree { span: section.span.clone(), value: Value::Number(value) };
                let key = Key { span: section.span.clone(), name: "tolerance".to_owned() };
                line.entries_mut().into_iter().for_each(|entries| entries.push((key.clone(), value.clone())));
            }
            Err(found) => faults.0.push(found),
        }
    }
    faults.none()
}

/// Dimensions without a tolerance to which ISO 2768-m would apply, with half the tolerance in their own unit. Returns an empty list if the
/// study has general tolerances.
pub(super) fn applicable(study: &Tree) -> Vec<(String, f64)> {
    if study.get("general").is_some() {
        return Vec::new();
    }
    let [_, (name, values), ..] = CLASSES;
    let general = General { length: LengthTolerance::Class(name, values), angle: None };
    let lines = study.get("dimensions").map_or(&[][..], Tree::entries);
    // A size outside of the table has no general tolerance.
    let half = |line: &Tree| tolerance(line, &general, "").ok().flatten();
    lines.iter().filter_map(|(key, line)| Some((key.name.clone(), half(line)?))).collect()
}

/// Reads the section.
fn read(section: &Tree) -> Result<General, Fault> {
    if !matches!(section.value, Value::Table(_)) {
        return Err(wrong_type(section, "general".into(), "a table such as { standard = \"ISO 2768-m\" }"));
    }
    let known = ["standard", "length", "angle"];
    if let Some((key, _)) = section.entries().iter().find(|(key, _)| !known.contains(&key.name.as_str())) {
        let nearest = nearest(&key.name, known).map(str::to_owned);
        let valid = known.map(str::to_owned).to_vec();
        let unknown = StudyFault::UnknownKey { key: key.name.clone(), nearest, valid };
        return Err(fault(key.span.clone(), format!("general.{}", key.name), unknown));
    }
    let positive = |name: &str, expected: &str| -> Result<Option<f64>, Fault> {
        let Some(given) = section.get(name) else { return Ok(None) };
        match given.value {
            Value::Number(value) if value.is_finite() && value > 0.0 => Ok(Some(value)),
            Value::Integer(value) if value > 0 => Ok(Some(value as f64)),
            _ => Err(wrong_type(given, format!("general.{name}"), expected)),
        }
    };
    let value = positive("length", "half the tolerance of all lengths in mm, above 0")?;
    let angle = positive("angle", "half the tolerance of all angles in degrees, above 0")?;
    let class = section.get("standard").map(class).transpose()?;
    let length = match (class, value) {
        (None, None) => LengthTolerance::None,
        (Some((name, values)), None) => LengthTolerance::Class(name, values),
        (None, Some(value)) => LengthTolerance::Value(value),
        (Some(_), Some(_)) => {
            let (a, b, why) = ("standard", "length", "are two tolerances of a length: keep one".to_owned());
            return Err(fault(section.span.clone(), "general", StudyFault::Conflict { a, b, why }));
        }
    };
    Ok(General { length, angle })
}

/// Class of a standard.
fn class(given: &Tree) -> Result<(&'static str, [f64; 8]), Fault> {
    let key = || "general.standard".to_owned();
    let Value::Text(text) = &given.value else {
        return Err(wrong_type(given, key(), "a class such as \"ISO 2768-m\""));
    };
    // Drawings also name the class of part 2, as in ISO 2768-mK, which is about form and position.
    let plain = text.trim().trim_end_matches(['H', 'K', 'L']);
    let found = CLASSES.iter().find(|(name, _)| name.eq_ignore_ascii_case(plain));
    found.copied().ok_or_else(|| {
        let names = CLASSES.map(|(name, _)| name);
        let (nearest, known) = (nearest(text, names).map(str::to_owned), names.map(str::to_owned).to_vec());
        let unknown = StudyFault::UnknownWord { what: "general tolerance", found: text.clone(), nearest, known };
        fault(given.span.clone(), key(), unknown)
    })
}

/// Half tolerance of a dimension in its own unit. Returns None for one with a spread of its own, and for one that is neither a length nor an angle.
fn tolerance(line: &Tree, general: &General, path: &str) -> Result<Option<f64>, Fault> {
    let Value::Table(entries) = &line.value else { return Ok(None) };
    if entries.iter().any(|(key, _)| !PLAIN.contains(&key.name.as_str())) {
        return Ok(None);
    }
    let (Some(nominal), Some(Tree { value: Value::Text(unit), .. })) = (line.get("nominal"), line.get("unit")) else {
        return Ok(None);
    };
    let (Some(unit), Some(degree), Some(millimetre)) = (Unit::parse(unit), Unit::parse("deg"), Unit::parse("mm"))
    else {
        return Ok(None);
    };
    let is_angle = unit.is_plain() && (unit == degree || Unit::parse("rad").is_some_and(|radian| unit == radian));
    if is_angle {
        return Ok(general.angle.map(|angle| angle * (degree.scale / unit.scale)));
    }
    if !unit.same_kind(&millimetre) {
        return Ok(None);
    }
    let size = match nominal.value {
        Value::Number(value) => value,
        Value::Integer(value) => value as f64,
        _ => return Ok(None),
    };
    let to_millimetres = unit.scale / millimetre.scale;
    let size = size.abs() * to_millimetres;
    let half = match &general.length {
        LengthTolerance::None => return Ok(None),
        LengthTolerance::Value(value) => *value,
        LengthTolerance::Class(name, values) => {
            let range = RANGES.iter().position(|&most| size <= most * (1.0 + 1e-12));
            let found = range.filter(|_| size >= LEAST).map(|range| values[range]).filter(|value| value.is_finite());
            found.ok_or_else(|| {
                let expected = format!("a size for which {name} has a tolerance, or a tolerance of its own,");
                wrong_type(nominal, format!("{path}.nominal"), &expected)
            })?
        }
    };
    Ok(Some(half / to_millimetres))
}
