//! Reads the zones of a feature: which they are, how wide, over which extent, and from which datums.

use std::ops::Range;

use super::frame::{ConstantFrame, number};
use super::lines::{Extent, Owner, ZoneLabel};
use crate::error::{Fault, StudyFault, fault};
use crate::expand::assembly::unknown_key;
use crate::expand::{Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol::assembly::formula::{Formula, is_plain};
use sensitol_numeric::names::nearest;
use sensitol_spatial::FeatureKind;

/// Kind of a zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ZoneKind {
    /// Place of a feature: position, or profile of a plane.
    Location,
    /// Place of an axis about a datum axis.
    Eccentricity,
    Orientation,
    /// Form, which moves no frame.
    Form,
}

use FeatureKind::{Axis, Frame, Plane, Point};

/// Zones: the key, its kind, the features that it fits, and the text to write for others.
pub(super) const ZONES: [(&str, ZoneKind, &[FeatureKind], &str); 13] = [
    ("position", ZoneKind::Location, &[Plane, Axis, Point, Frame], ""),
    ("profile", ZoneKind::Location, &[Plane], "a profile is of a plane: write position"),
    ("coaxiality", ZoneKind::Eccentricity, &[Axis, Point], "it is of an axis or a point: write position or profile"),
    ("concentricity", ZoneKind::Eccentricity, &[Axis, Point], "it is of an axis or a point: write position or profile"),
    ("runout", ZoneKind::Eccentricity, &[Axis, Point, Plane], "it is of an axis, a point or a plane: write position"),
    (
        "total_runout",
        ZoneKind::Eccentricity,
        &[Axis, Point, Plane],
        "it is of an axis, a point or a plane: write position",
    ),
    ("perpendicularity", ZoneKind::Orientation, &[Plane, Axis], "it is of a plane or an axis: write position"),
    ("parallelism", ZoneKind::Orientation, &[Plane, Axis], "it is of a plane or an axis: write position"),
    ("angularity", ZoneKind::Orientation, &[Plane, Axis], "it is of a plane or an axis: write position"),
    ("flatness", ZoneKind::Form, &[Plane], "it is of a plane: write roundness, straightness or cylindricity"),
    ("straightness", ZoneKind::Form, &[Plane, Axis], "it is of a plane or an axis"),
    ("roundness", ZoneKind::Form, &[Axis, Point], "it is of a round surface: write flatness"),
    ("cylindricity", ZoneKind::Form, &[Axis], "it is of an axis: write flatness or roundness"),
];
/// Further keys of features with zones.
pub(super) const MORE: [&str; 4] = ["datums", "length", "size", "distribution"];
/// Kinds of features by the keys of their places and directions.
const KINDS: [(&str, &str, FeatureKind); 4] =
    [("plane", "normal", Plane), ("axis", "along", Axis), ("point", "", Point), ("frame", "z", Frame)];
/// Laws of a zone. The first is the default.
const LAWS: [&str; 2] = ["normal", "uniform"];

/// A zone as written.
#[derive(Debug, Clone)]
pub(super) struct ZoneEntry<'t> {
    pub(super) key: &'static str,
    pub(super) kind: ZoneKind,
    pub(super) span: Range<usize>,
    pub(super) width: Extent,
    /// True if all places in the zone have the same probability.
    pub(super) uniform: bool,
    /// Keys of the spread of its dimensions: `distribution`, `sigmas`, `cp`.
    pub(super) spread: Vec<(Key, Tree)>,
    /// Table of the zone; None for a number or name.
    pub(super) table: Option<&'t Tree>,
}

impl ZoneEntry<'_> {
    /// Label of the zone for the lines of a feature or pattern with this full name.
    pub(super) fn label(&self, of: &str) -> ZoneLabel {
        ZoneLabel { name: format!("{of}.{}", self.key), half: self.width.number().map(|width| 0.5 * width) }
    }
}

/// Extent of a feature, over which its zones hold.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum FeatureExtent {
    Unknown,
    Length(Extent),
    /// Components along x and y of the feature.
    Rectangle([Extent; 2]),
    /// Diameter of a round face.
    Round(Extent),
}

/// A feature with its zones.
pub(super) struct ZonedFeature<'t> {
    pub(super) part: &'t str,
    pub(super) name: &'t str,
    pub(super) kind: FeatureKind,
    pub(super) tree: &'t Tree,
    pub(super) owner: Owner,
    pub(super) zones: Vec<ZoneEntry<'t>>,
    pub(super) datums: Vec<&'t str>,
    pub(super) datum_span: Range<usize>,
    /// Datums of the orientation with their place; None if they are those of the feature.
    pub(super) orientation_datums: Option<(Vec<&'t str>, Range<usize>)>,
    /// Names of the two features of a common datum; None for a feature of the study.
    pub(super) common: Option<[&'t str; 2]>,
    pub(super) extent: FeatureExtent,
    /// Constant directions; None if one varies.
    pub(super) frame: Option<ConstantFrame>,
}

impl ZonedFeature<'_> {
    /// Full name, such as `housing.bore`.
    pub(super) fn full(&self) -> String {
        format!("{}.{}", self.part, self.name)
    }

    /// Zone of one of these kinds.
    pub(super) fn zone(&self, kinds: &[ZoneKind]) -> Option<&ZoneEntry<'_>> {
        self.zones.iter().find(|zone| kinds.contains(&zone.kind))
    }
}

/// Reads the features of a part that have a kind. Others are reported where they are read.
pub(super) fn features<'t>(study: &Tree, part: &'t Key, tree: &'t Tree) -> Vec<Result<ZonedFeature<'t>, Fault>> {
    let plain = |name: &str| !name.contains('.') && !name.contains('`');
    let kind = |tree: &Tree| KINDS.iter().find(|(key, ..)| tree.get(key).is_some()).copied();
    (tree.entries().iter())
        .filter(|(key, _)| plain(&part.name) && plain(&key.name) && key.name != "patterns")
        .filter_map(|(key, tree)| Some((key, tree, kind(tree)?)))
        .map(|(key, tree, (_, direction, kind))| feature(study, part, key, tree, (direction, kind)))
        .collect()
}

fn feature<'t>(
    study: &Tree,
    part: &'t Key,
    key: &'t Key,
    tree: &'t Tree,
    (direction, kind): (&str, FeatureKind),
) -> Result<ZonedFeature<'t>, Fault> {
    let path = format!("parts.{}.{}", part.name, key.name);
    let owner = Owner { key: path.clone(), span: key.span.clone(), note: String::new(), zone: None };
    let even = law(tree.get("distribution"), &format!("{path}.distribution"))?;
    let mut zones: Vec<ZoneEntry<'t>> = Vec::new();
    for (name, zone_kind, fits, instead) in ZONES {
        let Some((found, given)) = tree.entries().iter().find(|(key, _)| key.name == name) else { continue };
        if !fits.contains(&kind) {
            let to = format!("a {}", kind.name()).replace("a axis", "an axis");
            let does_not_apply = StudyFault::DoesNotApply { key: name, to, instead };
            return Err(fault(found.span.clone(), format!("{path}.{name}"), does_not_apply));
        }
        let zone = zone(study, (name, zone_kind), found, given, &format!("{path}.{name}"), even)?;
        let place = |kind: ZoneKind| matches!(kind, ZoneKind::Location | ZoneKind::Eccentricity);
        let twin = |other: &&ZoneEntry<'_>| other.kind == zone_kind || (place(other.kind) && place(zone_kind));
        if let Some(other) = zones.iter().find(twin) {
            let why = "are two zones of one thing: keep the one that the part is made by".to_owned();
            let conflict = StudyFault::Conflict { a: other.key, b: name, why };
            return Err(fault(found.span.clone(), format!("{path}.{name}"), conflict));
        }
        zones.push(zone);
    }
    let orientation = zones.iter().find(|zone| zone.kind == ZoneKind::Orientation);
    let orientation_datums = match orientation.and_then(|zone| Some((zone.key, zone.table?))) {
        Some((key, table)) if table.get("datums").is_some() => Some(datums(table, &format!("{path}.{key}"))?),
        _ => None,
    };
    let (datums, datum_span) = datums(tree, &path)?;
    Ok(ZonedFeature {
        part: &part.name,
        name: &key.name,
        kind,
        tree,
        owner,
        zones,
        datums,
        datum_span,
        orientation_datums,
        common: None,
        extent: extent(study, tree, kind, &path)?,
        frame: ConstantFrame::of(tree, direction),
    })
}

/// True if a law is `uniform`.
fn law(given: Option<&Tree>, path: &str) -> Result<bool, Fault> {
    match given.map(|tree| (&tree.value, tree)) {
        None => Ok(false),
        Some((Value::Text(text), _)) if LAWS.contains(&text.as_str()) => Ok(text == "uniform"),
        Some((Value::Text(text), tree)) => {
            let (found, nearest) = (text.clone(), nearest(text, LAWS).map(str::to_owned));
            let unknown = StudyFault::UnknownWord {
                what: "law of a zone",
                found,
                nearest,
                known: LAWS.map(str::to_owned).to_vec(),
            };
            Err(fault(tree.span.clone(), path.to_owned(), unknown))
        }
        Some((_, tree)) => Err(wrong_type(tree, path.to_owned(), "\"normal\" or \"uniform\"")),
    }
}

/// Reads a zone.
pub(super) fn zone<'t>(
    study: &Tree,
    (name, kind): (&'static str, ZoneKind),
    key: &Key,
    given: &'t Tree,
    path: &str,
    even: bool,
) -> Result<ZoneEntry<'t>, Fault> {
    let at = |name: &str| Key { span: given.span.clone(), name: name.to_owned() };
    let (table, width_tree, uniform) = match &given.value {
        Value::Table(_) => {
            let own: &[&str] = match kind {
                ZoneKind::Location => &["hole", "pin", "at", "most", "outward"],
                ZoneKind::Form => &["side"],
                ZoneKind::Orientation => &["datums"],
                ZoneKind::Eccentricity => &[],
            };
            let valid: Vec<&str> =
                ["zone", "distribution", "sigmas", "cp"].into_iter().chain(own.iter().copied()).collect();
            unknown_key(given, path, &valid)?;
            let Some(width) = given.get("zone") else {
                let instead = "write the number in the feature control frame, such as zone = 0.1".to_owned();
                let missing = StudyFault::MissingKey { key: "zone".into(), instead };
                return Err(fault(given.span.clone(), path.to_owned(), missing));
            };
            let own = given.get("distribution");
            let uniform = if own.is_some() { law(own, &format!("{path}.distribution"))? } else { even };
            (Some(given), width, uniform)
        }
        _ => (None, given, even),
    };
    let width = extent_of(study, width_tree, path, "0 or above")?;
    let mut spread: Vec<(Key, Tree)> = Vec::new();
    if uniform {
        let law = Tree { span: given.span.clone(), value: Value::Text("uniform".into()) };
        spread.push((at("distribution"), law));
    }
    for name in ["sigmas", "cp"] {
        let Some(own) = table.and_then(|table| table.get(name)) else { continue };
        if uniform {
            let key = if name == "cp" { "cp" } else { "sigmas" };
            let does_not_apply = StudyFault::DoesNotApply {
                key,
                to: "a uniform law".into(),
                instead: "leave it out, or write distribution = \"normal\"",
            };
            return Err(fault(own.span.clone(), format!("{path}.{name}"), does_not_apply));
        }
        spread.push((at(name), own.clone()));
    }
    Ok(ZoneEntry { key: name, kind, span: key.span.clone(), width, uniform, spread, table })
}

/// Reads a width, length or diameter: a number, a name, or a formula.
pub(super) fn extent_of(study: &Tree, tree: &Tree, path: &str, range: &'static str) -> Result<Extent, Fault> {
    if let Some(value) = number(tree) {
        let allowed = if range == "above 0" { value > 0.0 } else { value >= 0.0 };
        return match allowed && value.is_finite() {
            true => Ok(Extent::Number(value)),
            false => Err(fault(tree.span.clone(), path.to_owned(), StudyFault::OutOfRange { value, range })),
        };
    }
    let Value::Text(text) = &tree.value else {
        return Err(wrong_type(tree, path.to_owned(), "a number, the name of a dimension, or a formula in quotes"));
    };
    let sections = ["dimensions", "constants", "formulas"];
    let known = || sections.iter().flat_map(|section| study.get(section).map_or(&[][..], Tree::entries));
    if known().any(|(key, _)| key.name == *text) {
        return Ok(Extent::Formula(quoted(text)));
    }
    if is_plain(text) {
        let known: Vec<String> = known().map(|(key, _)| key.name.clone()).collect();
        let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
        let unknown = StudyFault::UnknownWord { what: "dimension or formula", found: text.clone(), nearest, known };
        return Err(fault(tree.span.clone(), path.to_owned(), unknown));
    }
    match Formula::parse(text) {
        Ok(_) => Ok(Extent::Formula(format!("({text})"))),
        Err(error) => Err(fault(tree.span.clone(), path.to_owned(), StudyFault::Formula(error.fault))),
    }
}

/// Names of the datums, with their place.
fn datums<'t>(tree: &'t Tree, path: &str) -> Result<(Vec<&'t str>, Range<usize>), Fault> {
    match tree.get("datums") {
        None => Ok((Vec::new(), 0..0)),
        Some(Tree { value: Value::Text(text), span }) if !text.trim().is_empty() => {
            Ok((text.split_whitespace().collect(), span.clone()))
        }
        Some(other) => {
            let expected = "the names of features of this part, in their order, such as \"A B C\"";
            Err(wrong_type(other, format!("{path}.datums"), expected))
        }
    }
}

/// Extent of a feature: `size` or `diameter` of a plane, `length` of a plane or an axis.
fn extent(study: &Tree, tree: &Tree, kind: FeatureKind, path: &str) -> Result<FeatureExtent, Fault> {
    let given: Vec<&'static str> = (["size", "length", "diameter"].into_iter())
        .filter(|key| tree.get(key).is_some() && (*key != "diameter" || kind == Plane))
        .collect();
    let fits: &[&str] = match kind {
        Plane => &["size", "length", "diameter"],
        Axis => &["length"],
        Point | Frame => &[],
    };
    if let Some(&key) = given.iter().find(|key| !fits.contains(key)) {
        let to = format!("a {}", kind.name()).replace("a axis", "an axis");
        let instead = if kind == Axis { "write the length of the axis" } else { "leave it out" };
        let place = tree.get(key).map_or(0..0, |tree| tree.span.clone());
        return Err(fault(place, format!("{path}.{key}"), StudyFault::DoesNotApply { key, to, instead }));
    }
    let (key, value) = match given[..] {
        [] => return Ok(FeatureExtent::Unknown),
        [key] => (key, tree.get(key).unwrap_or(tree)),
        [a, b, ..] => {
            let why = "are two extents of one face: keep one".to_owned();
            let place = tree.get(b).map_or(0..0, |tree| tree.span.clone());
            return Err(fault(place, format!("{path}.{b}"), StudyFault::Conflict { a, b, why }));
        }
    };
    let path = format!("{path}.{key}");
    match key {
        "size" => match &value.value {
            Value::Array(items) if items.len() == 2 => Ok(FeatureExtent::Rectangle([
                extent_of(study, &items[0], &path, "above 0")?,
                extent_of(study, &items[1], &path, "above 0")?,
            ])),
            _ => Err(wrong_type(value, path, "the extents along x and y of the face, such as [60, 40]")),
        },
        "length" => Ok(FeatureExtent::Length(extent_of(study, value, &path, "above 0")?)),
        _ => Ok(FeatureExtent::Round(extent_of(study, value, &path, "above 0")?)),
    }
}
