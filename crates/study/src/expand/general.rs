//! Expands `[general]`: gives dimensions without a tolerance the general one of the drawing.
//!
//! # Source
//! ISO 2768-1:1989, table 1 for lengths, and table 3 for angles by the shorter leg. ISO 22081:2021 has no tables: values stand in the title block, here `length` and `angle`.

use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Expanded, Tree, Value, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::Unit;

/// Keys of a dimension that has no spread of its own.
const PLAIN: [&str; 18] = [
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
    LEG,
];
/// Key of the shorter leg of an angle.
const LEG: &str = "leg";
/// Greatest size of each range, in millimetres.
const RANGES: [f64; 8] = [3.0, 6.0, 30.0, 120.0, 400.0, 1000.0, 2000.0, 4000.0];
/// Least size that the table covers, in millimetres.
const LEAST: f64 = 0.5;
/// Relative excess of a size over the end of a range that is a rounding of a unit.
const ROUNDING: f64 = 1e-12;
/// Half tolerances of the classes in millimetres, by range; NaN where the standard has none.
const CLASSES: [(&str, [f64; 8]); 4] = [
    ("ISO 2768-f", [0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, f64::NAN]),
    ("ISO 2768-m", [0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0]),
    ("ISO 2768-c", [0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0]),
    ("ISO 2768-v", [f64::NAN, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0]),
];

/// Greatest length of the shorter leg in each range, in millimetres. The last range has no end.
const LEGS: [f64; 5] = [10.0, 50.0, 120.0, 400.0, f64::INFINITY];
/// Half tolerances of angles in minutes of arc, by range of the shorter leg, in the order of [`CLASSES`].
const ANGLES: [[f64; 5]; 4] = [
    [60.0, 30.0, 20.0, 10.0, 5.0],
    [60.0, 30.0, 20.0, 10.0, 5.0],
    [90.0, 60.0, 30.0, 15.0, 10.0],
    [180.0, 120.0, 60.0, 30.0, 20.0],
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
    angle: AngleTolerance,
}

/// General tolerance of angles.
enum AngleTolerance {
    /// None is given.
    None,
    /// Half tolerances of a class in minutes of arc, by the shorter leg.
    Class([f64; 5]),
    /// Half tolerance of all angles, in degrees.
    Value(f64),
}

/// Gives every dimension that states neither a tolerance nor a spread the general tolerance of its quantity. Removes the section.
///
/// Removes the legs of angles too, which nothing else needs.
pub(super) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let study = legs(expanded)?;
    let Some(section) = expanded.tree.get("general").cloned() else { return Ok(()) };
    if let Some(sections) = expanded.tree.entries_mut() {
        sections.retain(|(key, _)| key.name != "general");
    }
    let general = read(&section)?;
    let mut faults = Faults::default();
    for (name, line) in expanded.tree.get_mut("dimensions").and_then(Tree::entries_mut).into_iter().flatten() {
        let leg = study.iter().find(|(angle, _)| *angle == name.name).map(|(_, leg)| *leg);
        match tolerance(line, leg, &general, &format!("dimensions.{}", name.name)) {
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
    let ([_, (name, values), ..], [_, angles, ..]) = (CLASSES, ANGLES);
    let general = General { length: LengthTolerance::Class(name, values), angle: AngleTolerance::Class(angles) };
    let lines = study.get("dimensions").map_or(&[][..], Tree::entries);
    // A size outside of the table has no general tolerance, and a wrong leg is reported where the study is expanded.
    let half = |line: &Tree| {
        let leg = line.get(LEG).and_then(|given| leg(study, given, "").ok());
        tolerance(line, leg, &general, "").ok().flatten()
    };
    lines.iter().filter_map(|(key, line)| Some((key.name.clone(), half(line)?))).collect()
}

/// Takes the legs out of the dimensions. Returns them in millimetres, by the names of the angles.
fn legs(expanded: &mut Expanded) -> Result<Vec<(String, f64)>, Faults> {
    let lines = expanded.tree.get("dimensions").map_or(&[][..], Tree::entries);
    let (mut found, mut faults) = (Vec::new(), Faults::default());
    for (name, line) in lines {
        let Some((key, given)) = line.entries().iter().find(|(key, _)| key.name == LEG) else { continue };
        let path = format!("dimensions.{}.{LEG}", name.name);
        if !unit(line).is_some_and(|unit| is_angle(&unit)) {
            let to = "a dimension that is no angle".to_owned();
            let instead = "leave it out, or write the unit of the angle: unit = \"deg\"";
            let does_not_apply = StudyFault::DoesNotApply { key: LEG, to, instead };
            faults.0.push(fault(key.span.clone(), path, does_not_apply));
            continue;
        }
        found.extend(faults.take(leg(&expanded.tree, given, &path)).map(|leg| (name.name.clone(), leg)));
    }
    faults.none()?;
    if !found.is_empty() {
        for (_, line) in expanded.tree.get_mut("dimensions").and_then(Tree::entries_mut).into_iter().flatten() {
            line.entries_mut().into_iter().for_each(|keys| keys.retain(|(key, _)| key.name != LEG));
        }
    }
    Ok(found)
}

/// Length of the shorter leg of an angle in millimetres: a number in millimetres, or the nominal value of a dimension.
fn leg(study: &Tree, given: &Tree, path: &str) -> Result<f64, Fault> {
    let expected = "the shorter leg of the angle: a length in mm above 0, or the name of a dimension";
    if let Some(value) = number(given) {
        let is_length = value > 0.0 && value.is_finite();
        return if is_length { Ok(value) } else { Err(wrong_type(given, path.to_owned(), expected)) };
    }
    let Value::Text(text) = &given.value else { return Err(wrong_type(given, path.to_owned(), expected)) };
    let lines = study.get("dimensions").map_or(&[][..], Tree::entries);
    let Some((_, line)) = lines.iter().find(|(key, _)| key.name == *text) else {
        let known: Vec<String> = lines.iter().map(|(key, _)| key.name.clone()).collect();
        let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
        let unknown = StudyFault::UnknownWord { what: "dimension", found: text.clone(), nearest, known };
        return Err(fault(given.span.clone(), path.to_owned(), unknown));
    };
    let millimetre = Unit::parse("mm");
    let length = unit(line).zip(millimetre).filter(|(unit, millimetre)| unit.same_kind(millimetre));
    let nominal = line.get("nominal").and_then(number).filter(|value| *value != 0.0);
    match (length, nominal) {
        (Some((unit, millimetre)), Some(nominal)) => Ok(nominal.abs() * unit.scale / millimetre.scale),
        _ => Err(wrong_type(given, path.to_owned(), expected)),
    }
}

/// Number of a tree. Returns None for other values.
fn number(tree: &Tree) -> Option<f64> {
    match tree.value {
        Value::Number(value) => Some(value),
        Value::Integer(value) => Some(value as f64),
        _ => None,
    }
}

/// Unit of a line. Returns None if it has none that is known.
fn unit(line: &Tree) -> Option<Unit> {
    match line.get("unit") {
        Some(Tree { value: Value::Text(unit), .. }) => Unit::parse(unit),
        _ => None,
    }
}

/// True for degrees and radians.
fn is_angle(unit: &Unit) -> bool {
    unit.is_plain() && ["deg", "rad"].into_iter().any(|name| Unit::parse(name).is_some_and(|angle| *unit == angle))
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
    let angle = match (angle, class) {
        (Some(angle), _) => AngleTolerance::Value(angle),
        (None, Some((.., angles))) => AngleTolerance::Class(angles),
        (None, None) => AngleTolerance::None,
    };
    let length = match (class, value) {
        (None, None) => LengthTolerance::None,
        (Some((name, values, _)), None) => LengthTolerance::Class(name, values),
        (None, Some(value)) => LengthTolerance::Value(value),
        (Some(_), Some(_)) => {
            let (a, b, why) = ("standard", "length", "are two tolerances of a length: keep one".to_owned());
            return Err(fault(section.span.clone(), "general", StudyFault::Conflict { a, b, why }));
        }
    };
    Ok(General { length, angle })
}

/// Class of a standard: its name, and half tolerances of lengths and of angles.
fn class(given: &Tree) -> Result<(&'static str, [f64; 8], [f64; 5]), Fault> {
    let key = || "general.standard".to_owned();
    let Value::Text(text) = &given.value else {
        return Err(wrong_type(given, key(), "a class such as \"ISO 2768-m\""));
    };
    // Drawings also name the class of part 2, as in ISO 2768-mK, which is about form and position.
    let plain = text.trim().trim_end_matches(['H', 'K', 'L']);
    let found = CLASSES.into_iter().zip(ANGLES).find(|((name, _), _)| name.eq_ignore_ascii_case(plain));
    found.map(|((name, lengths), angles)| (name, lengths, angles)).ok_or_else(|| {
        let names = CLASSES.map(|(name, _)| name);
        let (nearest, known) = (nearest(text, names).map(str::to_owned), names.map(str::to_owned).to_vec());
        let unknown = StudyFault::UnknownWord { what: "general tolerance", found: text.clone(), nearest, known };
        fault(given.span.clone(), key(), unknown)
    })
}

/// Half tolerance of a dimension in its own unit. Returns None for one with a spread of its own, for an angle of a class without a leg, and for
/// one that is neither a length nor an angle. `leg` is in millimetres.
fn tolerance(line: &Tree, leg: Option<f64>, general: &General, path: &str) -> Result<Option<f64>, Fault> {
    let Value::Table(entries) = &line.value else { return Ok(None) };
    if entries.iter().any(|(key, _)| !PLAIN.contains(&key.name.as_str())) {
        return Ok(None);
    }
    let (Some(nominal), Some(unit)) = (line.get("nominal"), unit(line)) else { return Ok(None) };
    let (Some(degree), Some(millimetre)) = (Unit::parse("deg"), Unit::parse("mm")) else { return Ok(None) };
    if is_angle(&unit) {
        let degrees = match (&general.angle, leg) {
            (AngleTolerance::None, _) | (AngleTolerance::Class(_), None) => return Ok(None),
            (AngleTolerance::Value(value), _) => *value,
            (AngleTolerance::Class(values), Some(leg)) => {
                let range = LEGS.iter().position(|&most| leg <= most * (1.0 + ROUNDING));
                values[range.unwrap_or(LEGS.len() - 1)] / 60.0
            }
        };
        return Ok(Some(degrees * (degree.scale / unit.scale)));
    }
    if !unit.same_kind(&millimetre) {
        return Ok(None);
    }
    let Some(size) = number(nominal) else { return Ok(None) };
    let to_millimetres = unit.scale / millimetre.scale;
    let size = size.abs() * to_millimetres;
    let half = match &general.length {
        LengthTolerance::None => return Ok(None),
        LengthTolerance::Value(value) => *value,
        LengthTolerance::Class(name, values) => {
            let range = RANGES.iter().position(|&most| size <= most * (1.0 + ROUNDING));
            let found = range.filter(|_| size >= LEAST).map(|range| values[range]).filter(|value| value.is_finite());
            found.ok_or_else(|| {
                let expected = format!("a size for which {name} has a tolerance, or a tolerance of its own,");
                wrong_type(nominal, format!("{path}.nominal"), &expected)
            })?
        }
    };
    Ok(Some(half / to_millimetres))
}
