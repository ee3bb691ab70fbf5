//! Reads the measures of characteristics: distances, coordinates, angles, gaps and profiles.

use super::values::{Measures, Values};
use super::{feature, unknown_key};
use crate::error::{Fault, StudyFault, fault};
use crate::expand::{Tree, Value, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;
use sensitol_spatial::{Assembly, FrameAxis, Measure, MeasureKind};

/// Keys of measures.
pub(super) const KEYS: [&str; 6] = ["of", "from", "along", "angle", "gap", "profile"];

/// A characteristic with a measure.
pub(super) struct MeasureEntry<'t> {
    pub(super) key: &'t Key,
    tree: &'t Tree,
}

/// Characteristics with keys of measures.
pub(super) fn entries(study: &Tree) -> Vec<MeasureEntry<'_>> {
    let all = study.get("characteristics").map_or(&[][..], Tree::entries);
    let measures = |tree: &Tree| KEYS.iter().any(|key| tree.get(key).is_some());
    all.iter().filter(|(_, tree)| measures(tree)).map(|(key, tree)| MeasureEntry { key, tree }).collect()
}

/// True if a characteristic is an angle.
pub(super) fn is_angle(tree: &Tree) -> bool {
    tree.get("angle").is_some()
}

/// Unit of a characteristic, empty if it has none.
pub(super) fn unit(tree: &Tree) -> &str {
    match tree.get("unit").map(|unit| &unit.value) {
        Some(Value::Text(unit)) => unit,
        _ => "",
    }
}

/// Reads a measure.
pub(super) fn measure(
    entry: &MeasureEntry<'_>,
    assembly: &Assembly,
    values: &mut Values<'_>,
) -> Result<Measure, Fault> {
    let MeasureEntry { key, tree } = entry;
    let path = format!("characteristics.{}", key.name);
    let at = |name: &str| format!("{path}.{name}");
    if tree.get("formula").is_some() {
        let (b, why) = (
            KEYS.into_iter().find(|key| tree.get(key).is_some()).unwrap_or("of"),
            "are two ways to give a value: keep one".to_owned(),
        );
        return Err(fault(key.span.clone(), path, StudyFault::Conflict { a: "formula", b, why }));
    }
    let pair = |name: &'static str| -> Result<_, Fault> {
        let Some(Tree { value: Value::Array(items), .. }) = tree.get(name) else {
            return Err(wrong_type(tree.get(name).unwrap_or(tree), at(name), "a list of two features"));
        };
        match &items[..] {
            [a, b] => Ok([feature(a, &at(name), assembly)?, feature(b, &at(name), assembly)?]),
            _ => Err(wrong_type(tree.get(name).unwrap_or(tree), at(name), "a list of two features")),
        }
    };
    let given: Vec<&'static str> =
        ["of", "angle", "gap", "profile"].into_iter().filter(|key| tree.get(key).is_some()).collect();
    let (kind, between) = match given[..] {
        ["angle"] => (MeasureKind::Angle, pair("angle")?),
        ["gap"] => (MeasureKind::Gap, pair("gap")?),
        ["of"] => {
            let of = feature(tree.get("of").unwrap_or(tree), &at("of"), assembly)?;
            let from = needed(key, tree, &path)?;
            let from = feature(from, &at("from"), assembly)?;
            (distance(tree, &at("along"))?, [of, from])
        }
        ["profile"] => {
            let profile = tree.get("profile").unwrap_or(tree);
            if !matches!(profile.value, Value::Table(_)) {
                let expected = "a table such as { of = \"cover.face\", at = [[0, 0], [50, 0]] }";
                return Err(wrong_type(profile, at("profile"), expected));
            }
            unknown_key(profile, &at("profile"), &["of", "at"])?;
            let of = feature(profile.get("of").unwrap_or(profile), &at("profile.of"), assembly)?;
            let from = feature(needed(key, tree, &path)?, &at("from"), assembly)?;
            let expected = "a list of places such as [[0, 0], [50, 0]]";
            let Some(Tree { value: Value::Array(items), .. }) = profile.get("at") else {
                return Err(wrong_type(profile.get("at").unwrap_or(profile), at("profile.at"), expected));
            };
            let mut points = Vec::new();
            for item in items {
                points.push(values.list(item, &at("profile.at"), Measures::Length)?);
            }
            if points.is_empty() {
                return Err(wrong_type(profile.get("at").unwrap_or(profile), at("profile.at"), expected));
            }
            (MeasureKind::Profile(points), [of, from])
        }
        [a, b, ..] => {
            let why = "are two measures: write a characteristic for each".to_owned();
            return Err(fault(key.span.clone(), path, StudyFault::Conflict { a, b, why }));
        }
        [] | [_] => {
            let instead = "name the measured feature: of = \"part.feature\"".to_owned();
            return Err(fault(key.span.clone(), path, StudyFault::MissingKey { key: "of".into(), instead }));
        }
    };
    if let Some((stray, _)) = tree.entries().iter().find(|(key, _)| {
        (key.name == "along" && given != ["of"]) || (key.name == "from" && given != ["of"] && given != ["profile"])
    }) {
        let (key, to) = (if stray.name == "along" { "along" } else { "from" }, format!("`{}`", given[0]));
        let instead = "it belongs to a distance with `of`";
        return Err(fault(stray.span.clone(), at(key), StudyFault::DoesNotApply { key, to, instead }));
    }
    Ok(Measure { name: key.name.clone(), kind, between })
}

fn needed<'t>(key: &Key, tree: &'t Tree, path: &str) -> Result<&'t Tree, Fault> {
    let instead = "name the feature from which it is measured: from = \"part.feature\"".to_owned();
    let missing = StudyFault::MissingKey { key: "from".into(), instead };
    tree.get("from").ok_or_else(|| fault(key.span.clone(), path.to_owned(), missing))
}

/// Distance, or the coordinate that `along` names.
fn distance(tree: &Tree, key: &str) -> Result<MeasureKind, Fault> {
    let Some(along) = tree.get("along") else { return Ok(MeasureKind::Distance) };
    let known = ["x", "y", "z"];
    match &along.value {
        Value::Text(text) => match text.as_str() {
            "x" => Ok(MeasureKind::Along(FrameAxis::X)),
            "y" => Ok(MeasureKind::Along(FrameAxis::Y)),
            "z" => Ok(MeasureKind::Along(FrameAxis::Z)),
            _ => {
                let (nearest, known) = (nearest(text, known).map(str::to_owned), known.map(str::to_owned).to_vec());
                let unknown = StudyFault::UnknownWord { what: "coordinate", found: text.clone(), nearest, known };
                Err(fault(along.span.clone(), key.to_owned(), unknown))
            }
        },
        _ => Err(wrong_type(along, key.to_owned(), "\"x\", \"y\" or \"z\"")),
    }
}
