//! Common datums: two features of a part as one datum, written as "A-B".
//!
//! Two axes on one line make the line through their middles. Two parallel planes make the plane through their middles, whose tilt about the
//! line of the middles is the mean of theirs. The frame is that of the first feature.
//!
//! # Source
//! ISO 5459:2011, 5.4: a common datum is established from two or more features at once.

use std::ops::Range;

use super::deviation::Torsor;
use super::entry::{FeatureExtent, ZonedFeature};
use super::frame::{dot, place};
use super::lines::{Extent, Lines, at};
use crate::error::{Fault, StudyFault};
use crate::faults::zone_fault::{CommonDatumFault, ZoneFault};
use sensitol_numeric::names::nearest;
use sensitol_spatial::FeatureKind;

/// Part of a direction or a distance below which it counts as 0: roundings of directions and places.
const NOTHING: f64 = 1e-9;

/// Common datums that the features of a part name, as features without zones. Their name is the word in the list of datums.
pub(super) fn common_datums<'t>(features: &[&ZonedFeature<'t>]) -> Result<Vec<ZonedFeature<'t>>, Fault> {
    let mut found: Vec<ZonedFeature<'t>> = Vec::new();
    for feature in features {
        let own = (&feature.datums, &feature.datum_span, "datums".to_owned());
        let of_orientation = feature.orientation_datums.as_ref().map(|(names, span)| {
            let zone = feature.zone(&[super::entry::ZoneKind::Orientation]);
            (names, span, zone.map_or_else(|| "datums".to_owned(), |zone| format!("{}.datums", zone.key)))
        });
        for (names, span, key) in [own].into_iter().chain(of_orientation) {
            for &word in names {
                let is_known = |name: &str| features.iter().any(|other| other.name == name);
                if is_known(word) || found.iter().any(|other| other.name == word) {
                    continue;
                }
                let Some(pair) = pair(word, features).map_err(|fault| at(&feature.owner, &key, span, fault))? else {
                    continue;
                };
                found.push(common_datum(word, pair, (feature, &key, span))?);
            }
        }
    }
    Ok(found)
}

/// The two features of a word with a hyphen. Returns None for a word without one, and for one whose parts are both unknown.
fn pair<'f, 't>(
    word: &'t str,
    features: &[&'f ZonedFeature<'t>],
) -> Result<Option<[&'f ZonedFeature<'t>; 2]>, StudyFault> {
    let named = |name: &str| features.iter().find(|feature| feature.name == name).copied();
    let splits = word.match_indices('-').map(|(at, _)| (&word[..at], &word[at + 1..]));
    let mut missing = None;
    for (first, second) in splits {
        match (named(first), named(second)) {
            (Some(a), Some(b)) => return Ok(Some([a, b])),
            (Some(_), None) if !second.is_empty() => missing = missing.or(Some(second)),
            (None, Some(_)) if !first.is_empty() => missing = missing.or(Some(first)),
            _ => {}
        }
    }
    let Some(missing) = missing else { return Ok(None) };
    let known: Vec<String> = features.iter().map(|feature| feature.name.to_owned()).collect();
    let nearest = nearest(missing, known.iter().map(String::as_str)).map(str::to_owned);
    Err(StudyFault::UnknownWord { what: "feature of this part", found: missing.to_owned(), nearest, known })
}

/// Common datum of two features that a feature names.
fn common_datum<'t>(
    word: &'t str,
    [a, b]: [&ZonedFeature<'t>; 2],
    (of, key, span): (&ZonedFeature<'t>, &str, &Range<usize>),
) -> Result<ZonedFeature<'t>, Fault> {
    let refused = |found: ZoneFault| Err(at(&of.owner, key, span, found.into()));
    let names = || [a.name.to_owned(), b.name.to_owned()];
    if a.name == of.name || b.name == of.name {
        return refused(ZoneFault::DatumOfItself { feature: of.name.to_owned() });
    }
    for one in [a, b] {
        if one.frame.is_none() {
            return refused(ZoneFault::VaryingDirection { feature: one.full() });
        }
    }
    match separation(a, b) {
        Ok(_) => {}
        Err(why) => return refused(ZoneFault::NoCommonDatum { names: names(), why }),
    }
    Ok(ZonedFeature {
        part: a.part,
        name: word,
        kind: a.kind,
        tree: a.tree,
        owner: a.owner.clone(),
        zones: Vec::new(),
        datums: Vec::new(),
        datum_span: span.clone(),
        orientation_datums: None,
        common: Some([a.name, b.name]),
        extent: FeatureExtent::Unknown,
        frame: a.frame,
    })
}

/// Distance of the middle of the second feature from that of the first.
enum Separation {
    /// Along the axis of the first feature: the difference of two coordinates.
    Along([Extent; 2]),
    /// Across the normal of the first feature: a direction in the frame of the feature, and a length.
    Across([f64; 2], f64),
}

/// Separation of two features that make a common datum.
fn separation(a: &ZonedFeature<'_>, b: &ZonedFeature<'_>) -> Result<Separation, CommonDatumFault> {
    let (Some(first), Some(second)) = (&a.frame, &b.frame) else { return Err(CommonDatumFault::Kinds) };
    let [x, y, z] = first.axes;
    if a.kind != b.kind || !matches!(a.kind, FeatureKind::Axis | FeatureKind::Plane) {
        return Err(CommonDatumFault::Kinds);
    }
    if (dot(z, second.axes[2]).abs() - 1.0).abs() > NOTHING {
        return Err(CommonDatumFault::Directions);
    }
    let [from, to] = [a, b].map(|feature| place(feature.tree));
    let offset: [Option<f64>; 3] = [0, 1, 2].map(|i| match (from[i].number(), to[i].number()) {
        (Some(from), Some(to)) => Some(to - from),
        _ if from[i] == to[i] => Some(0.0),
        _ => None,
    });
    // A coordinate that is a formula is taken along the direction of an axis of the part alone.
    let along_one = |i: usize| (z[i].abs() - 1.0).abs() < NOTHING;
    if (0..3).any(|i| offset[i].is_none() && !along_one(i)) {
        return Err(CommonDatumFault::Formula);
    }
    let numbers = offset.map(|part| part.unwrap_or(0.0));
    let across = [dot(numbers, x), dot(numbers, y)];
    let aside = libm::hypot(across[0], across[1]);
    let height = dot(numbers, z);
    if a.kind == FeatureKind::Plane {
        return match aside > NOTHING * (aside + height.abs()) {
            true => Ok(Separation::Across(across.map(|part| part / aside), aside)),
            false => Err(CommonDatumFault::Middles),
        };
    }
    if aside > NOTHING.sqrt() * height.abs() && offset.iter().all(Option::is_some) {
        return Err(CommonDatumFault::Line);
    }
    let [to, from] = match (0..3).find(|&i| offset[i].is_none()) {
        Some(i) if z[i] < 0.0 => [&from[i], &to[i]].map(Extent::clone),
        Some(i) => [&to[i], &from[i]].map(Extent::clone),
        None if height == 0.0 => return Err(CommonDatumFault::Middles),
        None => [height, 0.0].map(Extent::Number),
    };
    Ok(Separation::Along([to, from]))
}

/// Difference of two coordinates as a text with the unit of lengths.
fn difference([to, from]: &[Extent; 2], lines: &Lines) -> String {
    match (to.number(), from.number()) {
        (Some(to), Some(from)) => lines.length(&Extent::Number(to - from)),
        _ => format!("({} - {})", lines.length(to), lines.length(from)),
    }
}

/// Deviation of a common datum in the frame of its first feature, from those of its two features.
pub(super) fn deviation(features: [&ZonedFeature<'_>; 2], own: [&Torsor; 2], lines: &Lines) -> Torsor {
    let [a, b] = features;
    let (Ok(separation), Some(frame), Some(other)) = (separation(a, b), a.frame, b.frame) else {
        return Torsor::default();
    };
    if own[0].is_zero() && own[1].is_zero() {
        return Torsor::default();
    }
    let [x, y, z] = frame.axes;
    let shift = |axis: [f64; 3]| [along(&own[0].shift, &frame.axes, axis), along(&own[1].shift, &other.axes, axis)];
    let tilt = |axis: [f64; 3]| [along(&own[0].tilt, &frame.axes, axis), along(&own[1].tilt, &other.axes, axis)];
    match separation {
        // The rotation carries the first middle to the second: z x (shift of b - shift of a) / distance.
        Separation::Along(distance) => {
            let distance = difference(&distance, lines);
            let slope = |[a, b]: [Option<String>; 2], sign: f64| {
                sum(&[(sign, b), (-sign, a)]).map(|text| format!("({text})/{distance}"))
            };
            Torsor {
                shift: [sum(&[(1.0, shift(x)[0].clone())]), sum(&[(1.0, shift(y)[0].clone())]), None],
                tilt: [slope(shift(y), -1.0), slope(shift(x), 1.0), None],
            }
        }
        // About the line across the middles by their heights, about the line of the middles by the mean tilt.
        Separation::Across([ux, uy], distance) => {
            let length = lines.length(&Extent::Number(distance));
            let [low, high] = shift(z);
            let slope = sum(&[(1.0, high), (-1.0, low.clone())]).map(|text| format!("({text})/{length}"));
            let [[ax, bx], [ay, by]] = [tilt(x), tilt(y)];
            let mean = sum(&[(0.5 * ux, ax), (0.5 * ux, bx), (0.5 * uy, ay), (0.5 * uy, by)]);
            let mean = mean.map(|text| format!("({text})"));
            Torsor {
                shift: [None, None, low],
                tilt: [sum(&[(uy, slope.clone()), (ux, mean.clone())]), sum(&[(-ux, slope), (uy, mean)]), None],
            }
        }
    }
}

/// Part of a vector in a frame along a direction of length 1, as a text.
fn along(parts: &[Option<String>; 3], axes: &[[f64; 3]; 3], direction: [f64; 3]) -> Option<String> {
    let terms: Vec<(f64, Option<String>)> =
        parts.iter().zip(axes).map(|(text, axis)| (dot(*axis, direction), text.clone())).collect();
    sum(&terms)
}

/// Sum of texts with factors. Returns None if nothing is left.
fn sum(terms: &[(f64, Option<String>)]) -> Option<String> {
    let factor = |by: f64, text: &String| match by {
        _ if (by - 1.0).abs() < NOTHING => format!("({text})"),
        _ => format!("({by:?})*({text})"),
    };
    let texts: Vec<String> = (terms.iter())
        .filter(|(by, _)| by.abs() > NOTHING)
        .filter_map(|(by, text)| text.as_ref().map(|text| factor(*by, text)))
        .collect();
    (!texts.is_empty()).then(|| texts.join(" + "))
}
