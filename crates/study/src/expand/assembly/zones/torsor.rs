//! Deviation of a feature within its zones: the displacement and rotation of its frame, as terms of dimensions.
//!
//! | feature | zone | dimensions |
//! |---|---|---|
//! | axis with a length | place | a circle at either end |
//! | axis | place | a circle at the middle |
//! | plane with a size | place | an offset and two tilts that share the zone |
//! | plane | place | an offset |
//! | axis, plane | orientation | one or two tilts |
//! | point | place | three coordinates in a ball, or two across a datum axis |

use super::datums::Tilts;
use super::deviation::Torsor;
use super::entry::{FeatureExtent, ZoneEntry, ZoneKind, ZonedFeature};
use super::frame::ConstantFrame;
use super::lines::{Band, Extent, LineUnit, Lines, Owner, at, key, number, text};
use crate::error::{Fault, StudyFault};
use crate::expand::{Tree, Value, quoted};
use crate::faults::zone_fault::ZoneFault;
use crate::tree::Key;
use sensitol_spatial::FeatureKind;

/// Facts from the datums of a feature about its deviation.
pub(super) struct DatumFacts<'a> {
    /// Tilts that the datums bound.
    pub(super) tilts: Tilts,
    /// Name and frame of the first datum that is an axis.
    pub(super) axis: Option<(&'a str, ConstantFrame)>,
    /// Key and name of the diameter that gives a bonus, by the joints in which the feature is a hole or a pin.
    pub(super) material: Option<(&'static str, String)>,
}

/// LawWords of the law of a zone, for comments.
struct LawWords<'a> {
    zone: &'a ZoneEntry<'a>,
    text: String,
}

fn words<'a>(zone: &'a ZoneEntry<'a>, uniform: &str, normal: &str) -> LawWords<'a> {
    LawWords { zone, text: format!("{}: {}", zone.key, if zone.uniform { uniform } else { normal }) }
}

/// Deviation of a feature within its zones, with the lines that it needs.
pub(super) fn torsor(feature: &ZonedFeature<'_>, facts: &DatumFacts<'_>, lines: &mut Lines) -> Result<Torsor, Fault> {
    let place = feature.zone(&[ZoneKind::Location, ZoneKind::Eccentricity]);
    let orientation = feature.zone(&[ZoneKind::Orientation]);
    if let (Some(place), Some(orientation)) = (place, orientation)
        && let (Some(wide), Some(tight)) = (place.width.number(), orientation.width.number())
        && tight > wide
        && place.table.is_none_or(|table| table.get("at").is_none())
    {
        let (orientation_key, location) = (orientation.key, place.key);
        let found = ZoneFault::NoRefinement { orientation: orientation_key, tight, location, wide };
        return Err(at(&feature.owner, orientation.key, &orientation.span, found.into()));
    }
    check_modifier(feature, place)?;
    match feature.kind {
        FeatureKind::Axis => axis(feature, facts, [place, orientation], lines),
        FeatureKind::Plane => match place {
            Some(place) if place.kind == ZoneKind::Eccentricity => face_runout(feature, facts, place, lines),
            _ => plane(feature, facts, [place, orientation], lines),
        },
        FeatureKind::Point => point(feature, facts, place, lines),
        FeatureKind::Frame => {
            let Some(zone) = place else { return Ok(Torsor::default()) };
            let owner =
                noted(feature, words(zone, "evenly across the slot", "3 sigma = half the zone across the slot"));
            let name = format!("{}.at", feature.full());
            let half = lines.scaled(&zone.width, 0.5);
            let band = lines.band(&owner, &name, &half, LineUnit::Length, &zone.spread);
            Ok(Torsor { shift: [None, Some(band.text), None], tilt: Default::default() })
        }
    }
}

fn noted(feature: &ZonedFeature<'_>, words: LawWords<'_>) -> Owner {
    let zone = Some(words.zone.label(&feature.full()));
    Owner { note: words.text, zone, ..feature.owner.clone() }
}

/// Checks that a bonus belongs to a feature with a size.
fn check_modifier(feature: &ZonedFeature<'_>, place: Option<&ZoneEntry<'_>>) -> Result<(), Fault> {
    let Some((zone, table)) = place.and_then(|zone| Some((zone, zone.table?))) else { return Ok(()) };
    let stray = |keys: &[&'static str]| keys.iter().find_map(|&key| Some((key, table.get(key)?)));
    let refused = |key: &'static str, tree: &Tree, to: &str, instead: &'static str| {
        let found = StudyFault::DoesNotApply { key, to: to.to_owned(), instead };
        Err(at(&feature.owner, &format!("{}.{key}", zone.key), &tree.span, found))
    };
    match feature.kind {
        FeatureKind::Plane => match stray(&["at", "hole", "pin", "most"]) {
            Some((key, tree)) => {
                refused(key, tree, "a plane", "a plane has no size that gives a bonus: write it at the hole or pin")
            }
            None => Ok(()),
        },
        FeatureKind::Axis => match stray(&["outward"]) {
            Some((key, tree)) => refused(key, tree, "an axis", "it belongs to the profile of a plane"),
            None => Ok(()),
        },
        FeatureKind::Point | FeatureKind::Frame => match stray(&["at", "hole", "pin", "most", "outward"]) {
            Some((key, tree)) => refused(key, tree, "this feature", "leave it out"),
            None => Ok(()),
        },
    }
}

/// Extent that a zone needs.
fn missing_extent(feature: &ZonedFeature<'_>, zone: &ZoneEntry<'_>, instead: &str) -> Fault {
    let missing = StudyFault::MissingKey { key: "length".into(), instead: instead.to_owned() };
    at(&feature.owner, zone.key, &zone.span, missing)
}

/// Checks that an angular zone is not wider than its extent.
fn below(feature: &ZonedFeature<'_>, zone: &ZoneEntry<'_>, across: &Extent) -> Result<(), Fault> {
    match (zone.width.number(), across.number()) {
        (Some(zone_width), Some(length)) if zone_width > length => {
            let found = StudyFault::LengthBelowZone { length, zone: zone_width };
            Err(at(&feature.owner, zone.key, &zone.span, found))
        }
        _ => Ok(()),
    }
}

/// Deviation of an axis.
fn axis(
    feature: &ZonedFeature<'_>,
    facts: &DatumFacts<'_>,
    [place, orientation]: [Option<&ZoneEntry<'_>>; 2],
    lines: &mut Lines,
) -> Result<Torsor, Fault> {
    let length = match &feature.extent {
        FeatureExtent::Length(length) => Some(length),
        _ => None,
    };
    let mut found = Torsor::default();
    if let Some(zone) = orientation {
        let Some(length) = length else {
            let instead = "write the length over which the zone holds, such as length = 40";
            return Err(missing_extent(feature, zone, instead));
        };
        found.tilt = axis_tilt(feature, facts.tilts, zone, length, lines)?;
    }
    let Some(zone) = place else { return Ok(found) };
    let (name, half) = (feature.full(), lines.scaled(&zone.width, 0.5));
    match (orientation, length) {
        // The tilt has a zone of its own: the middle takes what it leaves.
        (Some(_), Some(length)) if zone.uniform && bonus(zone).is_none() => {
            let note = words(zone, "the middle evenly in what the tilt leaves", "");
            let owner = noted(feature, note);
            let parts: Vec<String> = found.tilt.iter().flatten().cloned().collect();
            let tilt = match &parts[..] {
                [x, y] => format!("hypot({x}, {y})"),
                _ => format!("abs({})", parts.join(" + ")),
            };
            let used = format!("{}/2*{tilt}", lines.length(length));
            let both = lines.circle_left(&owner, &format!("{name}.at"), (&half, &used), &zone.spread);
            found.shift = across(both);
        }
        (None, Some(length)) => {
            below(feature, zone, length)?;
            let note = words(zone, "both ends evenly in the zone", "3 sigma = half the zone in x and y of both ends");
            let owner = noted(feature, note);
            let [from, to] = [".end1", ".end2"];
            let first = in_circle(feature, facts, zone, &owner, &format!("{name}{from}"), &found, lines)?;
            let second = in_circle(feature, facts, zone, &owner, &format!("{name}{to}"), &found, lines)?;
            let [[x1, y1], [x2, y2]] = [first, second];
            let length = lines.length(length);
            found.shift = [Some(format!("({x1} + {x2})/2")), Some(format!("({y1} + {y2})/2")), None];
            found.tilt = [Some(format!("({y1} - {y2})/{length}")), Some(format!("({x2} - {x1})/{length}")), None];
        }
        (_, _) => {
            let note = words(zone, "the middle evenly in the zone", "3 sigma = half the zone in x and y of the middle");
            let owner = noted(feature, note);
            found.shift = across(in_circle(feature, facts, zone, &owner, &format!("{name}.at"), &found, lines)?);
        }
    }
    Ok(found)
}

fn across([x, y]: [String; 2]) -> [Option<String>; 3] {
    [Some(x), Some(y), None]
}

/// Modifier of a zone that is not RFS.
fn bonus<'t>(zone: &ZoneEntry<'t>) -> Option<&'t Tree> {
    let modifier = zone.table?.get("at")?;
    (!matches!(&modifier.value, Value::Text(text) if text == "RFS")).then_some(modifier)
}

/// A point of an axis in its circle, which a bonus widens.
fn in_circle(
    feature: &ZonedFeature<'_>,
    facts: &DatumFacts<'_>,
    zone: &ZoneEntry<'_>,
    owner: &Owner,
    name: &str,
    found: &Torsor,
    lines: &mut Lines,
) -> Result<[String; 2], Fault> {
    let half = lines.scaled(&zone.width, 0.5);
    let Some(modifier) = bonus(zone) else {
        return Ok(lines.circle(owner, name, &half, LineUnit::Length, &zone.spread));
    };
    let table = zone.table.unwrap_or(modifier);
    let Extent::Number(width) = zone.width else {
        let instead = "write the zone as a number beside `at`".to_owned();
        let missing = StudyFault::MissingKey { key: "zone".into(), instead };
        return Err(at(&feature.owner, zone.key, &zone.span, missing));
    };
    let mut frame = vec![(key(owner, "zone"), number(owner, width)), (key(owner, "at"), modifier.clone())];
    if lines.width(owner).is_some() {
        let name = owner.zone.as_ref().map_or_else(String::new, |zone| zone.name.clone());
        frame.push((key(owner, "width"), text(owner, name)));
    }
    let given = ["hole", "pin"].into_iter().find_map(|kind| Some((kind, table.get(kind)?.clone())));
    match (given, &facts.material) {
        (Some((kind, tree)), _) => frame.push((key(owner, kind), tree)),
        (None, Some((kind, diameter))) => frame.push((key(owner, kind), text(owner, diameter.clone()))),
        (None, None) => {
            let instead = "write the dimension whose size gives the bonus: hole = \"D\" or pin = \"D\"".to_owned();
            let missing = StudyFault::MissingKey { key: "hole".into(), instead };
            return Err(at(&feature.owner, zone.key, &modifier.span, missing));
        }
    }
    frame.extend(table.get("most").map(|most| (key(owner, "most"), most.clone())));
    // A tilt with a zone of its own makes the mating envelope smaller.
    if let (FeatureExtent::Length(length), [Some(x), Some(y), _]) = (&feature.extent, &found.tilt) {
        let form = format!("{}*hypot({x}, {y})", lines.length(length));
        frame.push((key(owner, "form"), text(owner, form)));
    }
    let keys = vec![
        ("nominal", lines.list(owner, vec![number(owner, 0.0), number(owner, 0.0)])),
        ("position", Tree { span: zone.span.clone(), value: Value::Table(frame) }),
    ];
    lines.dimension(owner, name.to_owned(), LineUnit::Length, keys, &zone.spread);
    Ok(["_x", "_y"].map(|axis| quoted(&format!("{name}{axis}"))))
}

/// Tilts of an axis within an orientation zone.
fn axis_tilt(
    feature: &ZonedFeature<'_>,
    tilts: Tilts,
    zone: &ZoneEntry<'_>,
    length: &Extent,
    lines: &mut Lines,
) -> Result<[Option<String>; 3], Fault> {
    below(feature, zone, length)?;
    let name = format!("{}.tilt", feature.full());
    let reach = lines.angle(&zone.width, length, 1.0);
    Ok(match tilts {
        Tilts::Both => {
            let owner = noted(
                feature,
                words(zone, "evenly in a circle of tilts", "3 sigma = the zone over the length in x and y"),
            );
            across(lines.circle(&owner, &name, &reach, LineUnit::Angle, &zone.spread))
        }
        Tilts::About(about) => {
            let owner = noted(
                feature,
                words(zone, "evenly about one direction", "3 sigma = the zone over the length, about one direction"),
            );
            let band = lines.band(&owner, &name, &reach, LineUnit::Angle, &zone.spread);
            along(about, &band)
        }
    })
}

/// A tilt about a direction across the normal or axis.
fn along(about: [f64; 2], band: &Band) -> [Option<String>; 3] {
    let part = |factor: f64| match factor {
        _ if factor.abs() < 1e-12 => None,
        _ if factor == 1.0 => Some(band.text.clone()),
        _ => Some(format!("({factor:?})*{}", band.text)),
    };
    [part(about[0]), part(about[1]), None]
}

/// Factor of a normal tilt that shares a zone with another one: the corner keeps three sigma within the zone of tilts.
pub(super) const SHARED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Deviation of a plane: an offset along its normal, and tilts.
fn plane(
    feature: &ZonedFeature<'_>,
    facts: &DatumFacts<'_>,
    [place, orientation]: [Option<&ZoneEntry<'_>>; 2],
    lines: &mut Lines,
) -> Result<Torsor, Fault> {
    let mut found = Torsor::default();
    if let Some(zone) = orientation {
        found.tilt = plane_tilt(feature, facts.tilts, zone, lines)?;
    }
    let Some(zone) = place else { return Ok(found) };
    let name = format!("{}.at", feature.full());
    let half = lines.scaled(&zone.width, 0.5);
    if orientation.is_some() && zone.uniform {
        let owner = noted(feature, words(zone, "evenly in what the tilt leaves", ""));
        let used = used_by_tilt(feature, &found, lines);
        let offset = lines.band_left(&owner, &name, (&half, &used), &zone.spread);
        found.shift = [None, None, Some(offset)];
        return Ok(found);
    }
    let law = match &feature.extent {
        _ if orientation.is_some() => "",
        FeatureExtent::Unknown => "",
        FeatureExtent::Length(_) => "diamond",
        FeatureExtent::Rectangle(_) => "octahedron",
        FeatureExtent::Round(_) => "bicone",
    };
    let shared = zone.uniform && !law.is_empty() && zone.width != Extent::Number(0.0);
    let note = match law {
        "" => words(zone, "evenly in the zone", "3 sigma = half the zone at the middle"),
        _ => words(
            zone,
            "offset and tilt evenly in the zone",
            "3 sigma = half the zone at the middle, tilts over sqrt 2",
        ),
    };
    let owner = noted(feature, note);
    // Members of a block have the law of the block.
    let spread = if shared { &[][..] } else { &zone.spread[..] };
    let outward = zone.table.and_then(|table| table.get("outward"));
    let offset = match outward {
        None => lines.band(&owner, &name, &half, LineUnit::Length, spread),
        Some(tree) => lines.offset_band(&owner, &name, unequal(feature, zone, tree)?, spread),
    };
    found.shift = [None, None, Some(offset.text.clone())];
    if law.is_empty() {
        return Ok(found);
    }
    let (bands, terms) = face_tilts(feature, facts.tilts, zone, (&owner, spread), lines)?;
    found.tilt = terms;
    if shared {
        let members: Vec<&Band> = std::iter::once(&offset).chain(&bands).collect();
        lines.block(&owner, &members, law);
    }
    Ok(found)
}

/// Tilts of a face that share the zone of its place: their dimensions, and the terms of the rotation.
fn face_tilts(
    feature: &ZonedFeature<'_>,
    tilts: Tilts,
    zone: &ZoneEntry<'_>,
    (owner, spread): (&Owner, &[(Key, Tree)]),
    lines: &mut Lines,
) -> Result<(Vec<Band>, [Option<String>; 3]), Fault> {
    let by = if zone.uniform { 1.0 } else { SHARED };
    let tilt_name = |axis: &str| format!("{}.tilt{axis}", feature.full());
    let tilt = |name: String, across: &Extent, by: f64, lines: &mut Lines| -> Result<Band, Fault> {
        below(feature, zone, across)?;
        let reach = lines.angle(&zone.width, across, by);
        Ok(lines.band(owner, &name, &reach, LineUnit::Angle, spread))
    };
    Ok(match &feature.extent {
        FeatureExtent::Length(length) => {
            let band = tilt(tilt_name(""), length, by, lines)?;
            let about = if let Tilts::About(about) = tilts { about } else { [1.0, 0.0] };
            (vec![band.clone()], along(about, &band))
        }
        FeatureExtent::Rectangle([along_x, along_y]) => {
            let bands = [tilt(tilt_name("_x"), along_y, by, lines)?, tilt(tilt_name("_y"), along_x, by, lines)?];
            let terms = across(bands.each_ref().map(|band| band.text.clone()));
            (bands.to_vec(), terms)
        }
        FeatureExtent::Round(diameter) => {
            let bands = [tilt(tilt_name("_x"), diameter, by, lines)?, tilt(tilt_name("_y"), diameter, by, lines)?];
            let terms = across(bands.each_ref().map(|band| band.text.clone()));
            (bands.to_vec(), terms)
        }
        FeatureExtent::Unknown => (Vec::new(), Default::default()),
    })
}

/// Band of a profile of which a part lies out of the material.
fn unequal(feature: &ZonedFeature<'_>, zone: &ZoneEntry<'_>, tree: &Tree) -> Result<[f64; 2], Fault> {
    let place = format!("{}.outward", zone.key);
    let range = "within the zone, a number: its part outside of the material, from 0 to the whole";
    match (super::frame::number(tree), zone.width.number()) {
        (Some(outward), Some(width)) if (0.0..=width).contains(&outward) => Ok([outward - width, outward]),
        (value, _) => {
            let value = value.unwrap_or(f64::NAN);
            Err(at(&feature.owner, &place, &tree.span, StudyFault::OutOfRange { value, range }))
        }
    }
}

/// Length of the zone that the tilt of a face uses, as a formula.
fn used_by_tilt(feature: &ZonedFeature<'_>, found: &Torsor, lines: &Lines) -> String {
    let tilt = |index: usize| found.tilt[index].clone().unwrap_or_else(|| "0".into());
    match &feature.extent {
        FeatureExtent::Rectangle([x, y]) => {
            let (x, y) = (lines.length(x), lines.length(y));
            format!("(abs({})*{y} + abs({})*{x})/2", tilt(0), tilt(1))
        }
        FeatureExtent::Round(diameter) => {
            format!("{}/2*hypot({}, {})", lines.length(diameter), tilt(0), tilt(1))
        }
        FeatureExtent::Length(length) => format!("{}/2*hypot({}, {})", lines.length(length), tilt(0), tilt(1)),
        FeatureExtent::Unknown => "0".into(),
    }
}

/// Tilts of a plane within an orientation zone.
fn plane_tilt(
    feature: &ZonedFeature<'_>,
    tilts: Tilts,
    zone: &ZoneEntry<'_>,
    lines: &mut Lines,
) -> Result<[Option<String>; 3], Fault> {
    let name = format!("{}.tilt", feature.full());
    let single = |about: [f64; 2], across: &Extent, lines: &mut Lines| {
        below(feature, zone, across)?;
        let owner = noted(
            feature,
            words(zone, "evenly about one direction", "3 sigma = the zone over the extent, about one direction"),
        );
        let reach = lines.angle(&zone.width, across, 1.0);
        Ok(along(about, &lines.band(&owner, &name, &reach, LineUnit::Angle, &zone.spread)))
    };
    match (&feature.extent, tilts) {
        (FeatureExtent::Unknown, _) => {
            let instead = "write the extent over which the zone holds, such as length = 40 or size = [60, 40]";
            Err(missing_extent(feature, zone, instead))
        }
        (FeatureExtent::Length(length), Tilts::Both) => single([1.0, 0.0], length, lines),
        (FeatureExtent::Length(length) | FeatureExtent::Round(length), Tilts::About(about)) => {
            single(about, length, lines)
        }
        (FeatureExtent::Rectangle([x, y]), Tilts::About(about)) => {
            let [by_x, by_y] = about.map(f64::abs);
            let across = match (x, y) {
                (Extent::Number(x), Extent::Number(y)) => Extent::Number(by_x * y + by_y * x),
                _ if by_y < 1e-12 => y.clone(),
                _ if by_x < 1e-12 => x.clone(),
                _ => Extent::Formula(format!("({by_x:?}*{} + {by_y:?}*{})", lines.length(y), lines.length(x))),
            };
            single(about, &across, lines)
        }
        (FeatureExtent::Round(diameter), Tilts::Both) => {
            below(feature, zone, diameter)?;
            let owner = noted(
                feature,
                words(zone, "evenly in a circle of tilts", "3 sigma = the zone over the diameter in x and y"),
            );
            let reach = lines.angle(&zone.width, diameter, 1.0);
            Ok(across(lines.circle(&owner, &name, &reach, LineUnit::Angle, &zone.spread)))
        }
        (FeatureExtent::Rectangle([x, y]), Tilts::Both) => {
            let note = words(zone, "both tilts evenly in the zone", "3 sigma = the zone over the extent and sqrt 2");
            let owner = noted(feature, note);
            let (by, spread) = if zone.uniform { (1.0, &[][..]) } else { (SHARED, &zone.spread[..]) };
            let mut bands = Vec::new();
            for (axis, extent) in [("_x", y), ("_y", x)] {
                below(feature, zone, extent)?;
                let reach = lines.angle(&zone.width, extent, by);
                bands.push(lines.band(&owner, &format!("{name}{axis}"), &reach, LineUnit::Angle, spread));
            }
            if zone.uniform && zone.width != Extent::Number(0.0) {
                lines.block(&owner, &[&bands[0], &bands[1]], "diamond");
            }
            Ok([Some(bands[0].text.clone()), Some(bands[1].text.clone()), None])
        }
    }
}

/// Tilt of a face within a runout about a datum axis.
fn face_runout(
    feature: &ZonedFeature<'_>,
    facts: &DatumFacts<'_>,
    zone: &ZoneEntry<'_>,
    lines: &mut Lines,
) -> Result<Torsor, Fault> {
    needed_axis(feature, facts, zone)?;
    let FeatureExtent::Round(diameter) = &feature.extent else {
        let instead = "the runout of a face tilts it: write its diameter".to_owned();
        let missing = StudyFault::MissingKey { key: "diameter".into(), instead };
        return Err(at(&feature.owner, zone.key, &zone.span, missing));
    };
    below(feature, zone, diameter)?;
    let owner =
        noted(feature, words(zone, "evenly in a circle of tilts", "3 sigma = the zone over the diameter in x and y"));
    let reach = lines.angle(&zone.width, diameter, 1.0);
    let name = format!("{}.tilt", feature.full());
    let tilt = across(lines.circle(&owner, &name, &reach, LineUnit::Angle, &zone.spread));
    Ok(Torsor { shift: Default::default(), tilt })
}

/// Datum axis of a zone about an axis.
fn needed_axis<'a>(
    feature: &ZonedFeature<'_>,
    facts: &DatumFacts<'a>,
    zone: &ZoneEntry<'_>,
) -> Result<(&'a str, ConstantFrame), Fault> {
    facts.axis.ok_or_else(|| {
        let found = ZoneFault::AxisMissing { zone: zone.key, kind: feature.kind.name() };
        at(&feature.owner, zone.key, &zone.span, found.into())
    })
}

/// Deviation of a point: within a ball, or within a circle about a datum axis.
fn point(
    feature: &ZonedFeature<'_>,
    facts: &DatumFacts<'_>,
    place: Option<&ZoneEntry<'_>>,
    lines: &mut Lines,
) -> Result<Torsor, Fault> {
    let Some(zone) = place else { return Ok(Torsor::default()) };
    let name = format!("{}.at", feature.full());
    let half = lines.scaled(&zone.width, 0.5);
    if zone.kind == ZoneKind::Eccentricity {
        let (_, frame) = needed_axis(feature, facts, zone)?;
        let owner = noted(
            feature,
            words(
                zone,
                "evenly in the circle across the axis",
                "3 sigma = half the zone in two directions across the axis",
            ),
        );
        let both = lines.circle(&owner, &name, &half, LineUnit::Length, &zone.spread);
        let term = |i: usize| {
            let parts: Vec<String> = (both.iter().zip(&frame.axes[..2]))
                .filter(|(_, axis)| axis[i].abs() > 1e-12)
                .map(|(text, axis)| if axis[i] == 1.0 { text.clone() } else { format!("({:?})*{text}", axis[i]) })
                .collect();
            (!parts.is_empty()).then(|| parts.join(" + "))
        };
        return Ok(Torsor { shift: [term(0), term(1), term(2)], tilt: Default::default() });
    }
    let owner = noted(feature, words(zone, "evenly in a ball", "3 sigma = half the zone in x, y and z"));
    let spread = if zone.uniform { &[][..] } else { &zone.spread[..] };
    let bands =
        ["_x", "_y", "_z"].map(|axis| lines.band(&owner, &format!("{name}{axis}"), &half, LineUnit::Length, spread));
    if zone.uniform && zone.width != Extent::Number(0.0) {
        lines.block(&owner, &[&bands[0], &bands[1], &bands[2]], "ball");
    }
    Ok(Torsor { shift: bands.map(|band| Some(band.text)), tilt: Default::default() })
}
