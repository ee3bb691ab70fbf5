//! Datums of a feature: which freedoms they fix, and deviations that a feature takes over from its datums.
//!
//! A plane fixes two tilts and the distance along its normal, an axis two tilts and two distances. Each datum fixes what those before it have
//! left free. A feature that is measured from a datum with a zone of its own moves with that datum, by the freedoms that the datum fixes.

use std::ops::Range;

use super::common;
use super::deviation::Torsor;
use super::entry::{ZoneKind, ZonedFeature};
use super::frame::{ConstantFrame, cross, dot, place, unit};
use super::lines::{Extent, Lines, at};
use crate::error::{Fault, StudyFault};
use crate::faults::zone_fault::ZoneFault;
use crate::scene::OpenZone;
use sensitol_numeric::names::nearest;
use sensitol_spatial::FeatureKind;

/// Part of a projection below which it counts as 0: roundings of directions.
const NOTHING: f64 = 1e-9;

/// Part of a direction that datums leave free above which it is open: a thousandth of a radian.
const LEFT: f64 = 1e-3;

/// Tilts of a feature that its datums bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Tilts {
    Both,
    /// The tilt about this direction across the normal or axis.
    About([f64; 2]),
}

/// Directions along which, or about which, datums fix a feature: orthonormal, at most three.
#[derive(Debug, Clone, Default)]
struct Span(Vec<[f64; 3]>);

impl Span {
    /// Part of a vector outside of the span.
    fn outside(&self, vector: [f64; 3]) -> [f64; 3] {
        self.0.iter().fold(vector, |left, own| {
            let along = dot(left, *own);
            [0, 1, 2].map(|i| left[i] - along * own[i])
        })
    }

    /// Adds a direction. Returns false if the span has it.
    fn add(&mut self, vector: [f64; 3]) -> bool {
        let left = self.outside(vector);
        match unit(left).filter(|_| dot(left, left) > NOTHING) {
            Some(new) => {
                self.0.push(new);
                true
            }
            None => false,
        }
    }
}

/// Freedoms that datums have fixed: rotations and displacements.
#[derive(Debug, Clone, Default)]
struct Fixed {
    rotations: Span,
    displacements: Span,
}

impl Fixed {
    /// Adds the freedoms that a datum fixes. Returns false if that is nothing.
    fn add(&mut self, kind: FeatureKind, frame: &ConstantFrame) -> bool {
        let [x, y, z] = frame.axes;
        // Points and further axes fix what is left of the rotations by their distance, which is not examined.
        let mut by_distance = false;
        let (rotations, displacements): (&[[f64; 3]], &[[f64; 3]]) = match kind {
            FeatureKind::Plane => (&[x, y], &[z]),
            FeatureKind::Axis => (&[x, y], &[x, y]),
            FeatureKind::Point => (&[], &[x, y, z]),
            FeatureKind::Frame => (&[x, y, z], &[x, y, z]),
        };
        if matches!(kind, FeatureKind::Point | FeatureKind::Axis)
            && self.rotations.0.len() < 3
            && !self.displacements.0.is_empty()
        {
            by_distance = true;
        }
        let added = rotations.iter().filter(|&&direction| self.rotations.add(direction)).count()
            + displacements.iter().filter(|&&direction| self.displacements.add(direction)).count();
        if by_distance && added == 0 {
            [x, y, z].into_iter().for_each(|direction| {
                self.rotations.add(direction);
            });
        }
        added > 0 || by_distance
    }
}

/// Names of datums with their place, and the key that they stand at.
pub(super) struct DatumList<'f> {
    pub(super) names: &'f [&'f str],
    pub(super) span: &'f Range<usize>,
    pub(super) key: String,
}

impl<'f> DatumList<'f> {
    /// Datums of a feature.
    pub(super) fn of(feature: &'f ZonedFeature<'_>) -> Self {
        Self { names: &feature.datums, span: &feature.datum_span, key: "datums".to_owned() }
    }

    /// Datums of the orientation of a feature. Returns None if it has none of its own.
    pub(super) fn of_orientation(feature: &'f ZonedFeature<'_>) -> Option<Self> {
        let (names, span) = feature.orientation_datums.as_ref()?;
        let zone = feature.zone(&[ZoneKind::Orientation])?;
        Some(Self { names, span, key: format!("{}.datums", zone.key) })
    }
}

/// Features of a part that a feature names as its datums.
pub(super) fn named<'f, 't>(
    feature: &ZonedFeature<'t>,
    datums: &DatumList<'_>,
    of_part: &[&'f ZonedFeature<'t>],
) -> Result<Vec<&'f ZonedFeature<'t>>, Fault> {
    let refused = |found: StudyFault| Err(at(&feature.owner, &datums.key, datums.span, found));
    let mut found = Vec::new();
    for name in datums.names {
        if *name == feature.name {
            return refused(ZoneFault::DatumOfItself { feature: feature.name.to_owned() }.into());
        }
        match of_part.iter().find(|other| other.name == *name) {
            Some(datum) => found.push(*datum),
            None => {
                let known: Vec<String> =
                    of_part.iter().map(|other| other.name.to_owned()).filter(|other| other != feature.name).collect();
                let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
                let what = "feature of this part";
                return refused(StudyFault::UnknownWord { what, found: (*name).to_owned(), nearest, known });
            }
        }
    }
    check(feature, datums, &found)?;
    Ok(found)
}

/// Checks that every datum fixes something.
fn check(feature: &ZonedFeature<'_>, names: &DatumList<'_>, datums: &[&ZonedFeature<'_>]) -> Result<(), Fault> {
    let mut fixed = Fixed::default();
    for (place, datum) in datums.iter().enumerate() {
        // A direction that varies is not examined.
        let Some(frame) = &datum.frame else { return Ok(()) };
        if !fixed.add(datum.kind, frame) {
            let before = datums[..place].iter().map(|datum| datum.name.to_owned()).collect();
            let found = ZoneFault::IdleDatum { datum: datum.name.to_owned(), before };
            return Err(at(&feature.owner, &names.key, names.span, found.into()));
        }
    }
    Ok(())
}

/// Zones of a feature whose datums leave a displacement or a tilt free that the zone bounds. Zones of form need no datums.
pub(super) fn open_zones(feature: &ZonedFeature<'_>, of_part: &[&ZonedFeature<'_>]) -> Vec<OpenZone> {
    let named_datums = named(feature, &DatumList::of(feature), of_part);
    let (Ok(datums), Some(own)) = (named_datums, &feature.frame) else { return Vec::new() };
    let mut fixed = Fixed::default();
    for datum in &datums {
        // A direction that varies is not examined.
        let Some(frame) = &datum.frame else { return Vec::new() };
        fixed.add(datum.kind, frame);
    }
    let [x, y, z] = own.axes;
    let bounded: &[[f64; 3]] = match feature.kind {
        FeatureKind::Axis => &[x, y],
        FeatureKind::Plane => &[z],
        FeatureKind::Point => &[x, y, z],
        FeatureKind::Frame => &[y],
    };
    let mut found = Vec::new();
    for zone in &feature.zones {
        let open: Vec<String> = match zone.kind {
            ZoneKind::Form => continue,
            ZoneKind::Orientation if feature.orientation_datums.is_some() => continue,
            _ if datums.is_empty() => vec!["all of it".to_owned()],
            ZoneKind::Location => (bounded.iter())
                .filter(|&&along| fixed.displacements.outside(along).iter().any(|part| part.abs() > LEFT))
                .map(|along| format!("its place along {}", direction_words(*along)))
                .collect(),
            ZoneKind::Orientation if fixed.rotations.0.is_empty() => vec!["its tilt".to_owned()],
            ZoneKind::Orientation | ZoneKind::Eccentricity => Vec::new(),
        };
        if !open.is_empty() {
            let datums = datums.iter().map(|datum| datum.name.to_owned()).collect();
            found.push(OpenZone { feature: feature.full(), zone: zone.key, datums, open });
        }
    }
    found
}

/// Direction in words: a letter, or its three parts.
fn direction_words(along: [f64; 3]) -> String {
    let letters = ["x", "y", "z"].into_iter().zip(along);
    let word =
        letters.clone().find(|(_, part)| (part.abs() - 1.0).abs() < NOTHING).map(|(letter, _)| letter.to_owned());
    word.unwrap_or_else(|| format!("[{:.3}, {:.3}, {:.3}]", along[0], along[1], along[2]))
}

/// Tilts that the datums bound. A rotation about the direction of a single datum changes nothing.
pub(super) fn tilts(feature: &ZonedFeature<'_>, datums: &[&ZonedFeature<'_>]) -> Tilts {
    let Some(own) = &feature.frame else { return Tilts::Both };
    let mut fixed = Fixed::default();
    for datum in datums {
        let Some(frame) = &datum.frame else { return Tilts::Both };
        fixed.add(datum.kind, frame);
    }
    let [first, second] = fixed.rotations.0[..] else { return Tilts::Both };
    let free = cross(first, second);
    let [x, y, z] = own.axes;
    match unit(cross(z, free)).filter(|about| dot(*about, *about) > 0.0 && off(z, free)) {
        Some(about) => {
            let [along_x, along_y] = [dot(about, x), dot(about, y)];
            // The sign has no meaning: the larger part is positive.
            let sign = if along_x.abs() >= along_y.abs() { along_x.signum() } else { along_y.signum() };
            Tilts::About(
                [sign * along_x, sign * along_y].map(|part| if part.abs() < NOTHING { 0.0 } else { rounded(part) }),
            )
        }
        None => Tilts::Both,
    }
}

/// True if two directions are not parallel.
fn off(a: [f64; 3], b: [f64; 3]) -> bool {
    let across = cross(a, b);
    dot(across, across) > NOTHING
}

/// A part of a direction without the rounding of 1.
fn rounded(part: f64) -> f64 {
    if (part.abs() - 1.0).abs() < NOTHING { part.signum() } else { part }
}

/// Sum of terms, each a factor and a text.
pub(super) type Terms = Vec<(f64, String)>;

/// Deviation in the frame of the part.
#[derive(Debug, Clone, Default)]
pub(super) struct PartTorsor {
    pub(super) shift: [Terms; 3],
    pub(super) tilt: [Terms; 3],
}

/// Indices of the datums of a feature, or of the two features of a common datum, and of those of its orientation if it has its own.
#[derive(Debug, Default)]
pub(super) struct DatumIndices {
    pub(super) own: Vec<usize>,
    pub(super) orientation: Option<Vec<usize>>,
}

/// Adds the deviations that features take over from their datums. Own deviations are in the order of the features.
///
/// A feature whose orientation has its own datums tilts with these, and its place moves with the others.
pub(super) fn carried(
    features: &[&ZonedFeature<'_>],
    datums: &[DatumIndices],
    own: Vec<Torsor>,
    lines: &Lines,
) -> Result<Vec<Torsor>, Fault> {
    let mut own = own;
    let mut done: Vec<bool> = vec![false; features.len()];
    let mut open: Vec<bool> = vec![false; features.len()];
    for feature in 0..features.len() {
        carry(feature, features, datums, &mut own, (&mut done, &mut open), lines)?;
    }
    Ok(own)
}

/// Adds the freedoms that one feature fixes, after its datums.
fn carry(
    feature: usize,
    features: &[&ZonedFeature<'_>],
    datums: &[DatumIndices],
    own: &mut [Torsor],
    (done, open): (&mut Vec<bool>, &mut Vec<bool>),
    lines: &Lines,
) -> Result<(), Fault> {
    if done[feature] {
        return Ok(());
    }
    open[feature] = true;
    let (of, named) = (features[feature], &datums[feature]);
    for &datum in named.own.iter().chain(named.orientation.iter().flatten()) {
        if open[datum] {
            let found = ZoneFault::DatumCycle { feature: of.name.to_owned(), datum: features[datum].name.to_owned() };
            return Err(at(&of.owner, "datums", &of.datum_span, found.into()));
        }
        carry(datum, features, datums, own, (done, open), lines)?;
    }
    if let (Some(_), [first, second]) = (of.common, &named.own[..]) {
        let [first, second] = [*first, *second];
        own[feature] = common::deviation([features[first], features[second]], [&own[first], &own[second]], lines);
        open[feature] = false;
        done[feature] = true;
        return Ok(());
    }
    let mut taken = taken_over(of, &named.own, features, own, lines)?;
    if let Some(orientation) = &named.orientation {
        taken.tilt = taken_over(of, orientation, features, own, lines)?.tilt;
    }
    if !(taken.shift.iter().chain(&taken.tilt).all(Vec::is_empty)) {
        let Some(frame) = of.frame.as_ref() else {
            let found = ZoneFault::VaryingDirection { feature: of.full() };
            return Err(at(&of.owner, "datums", &of.datum_span, found.into()));
        };
        add(&mut own[feature], &taken, frame, of.kind);
    }
    open[feature] = false;
    done[feature] = true;
    Ok(())
}

/// Deviation that a feature takes over from datums in their order.
fn taken_over(
    of: &ZonedFeature<'_>,
    datums: &[usize],
    features: &[&ZonedFeature<'_>],
    own: &[Torsor],
    lines: &Lines,
) -> Result<PartTorsor, Fault> {
    let mut fixed = Fixed::default();
    let mut taken = PartTorsor::default();
    for &datum in datums {
        let other = features[datum];
        if own[datum].is_zero() {
            other.frame.iter().for_each(|frame| {
                fixed.add(other.kind, frame);
            });
            continue;
        }
        let Some(frame) = other.frame.as_ref() else {
            let found = ZoneFault::VaryingDirection { feature: other.full() };
            return Err(at(&of.owner, "datums", &of.datum_span, found.into()));
        };
        let lever = lever(of, other, lines);
        take(&mut taken, &own[datum], frame, &fixed, &lever);
        fixed.add(other.kind, frame);
    }
    Ok(taken)
}

/// Coordinates of a feature from its datum, as texts; None for 0.
fn lever(of: &ZonedFeature<'_>, datum: &ZonedFeature<'_>, lines: &Lines) -> [Option<String>; 3] {
    let [a, b] = [of, datum].map(|feature| place(feature.tree));
    [0, 1, 2].map(|i| match (a[i].number(), b[i].number()) {
        (Some(a), Some(b)) if a == b => None,
        (Some(a), Some(b)) => Some(lines.length(&Extent::Number(a - b))),
        _ if a[i] == b[i] => None,
        _ => Some(format!("({} - {})", lines.length(&a[i]), lines.length(&b[i]))),
    })
}

/// Adds a datum's deviation by the freedoms that no datum before has fixed.
fn take(taken: &mut PartTorsor, own: &Torsor, frame: &ConstantFrame, fixed: &Fixed, lever: &[Option<String>; 3]) {
    for (axis, (shift, tilt)) in frame.axes.iter().zip(own.shift.iter().zip(&own.tilt)) {
        if let Some(text) = shift {
            push(&mut taken.shift, fixed.displacements.outside(*axis), &format!("({text})"));
        }
        let Some(text) = tilt else { continue };
        let about = fixed.rotations.outside(*axis);
        push(&mut taken.tilt, about, &format!("({text})"));
        // A rotation displaces the feature by its lever: the cross product, a coordinate of the lever at a time.
        for (i, arm) in lever.iter().enumerate() {
            let Some(arm) = arm else { continue };
            let along = [0, 1, 2].map(|k| f64::from(u8::from(k == i)));
            push(&mut taken.shift, cross(about, along), &format!("{arm}*({text})"));
        }
    }
}

/// Adds a term along a vector.
pub(super) fn push(terms: &mut [Terms; 3], along: [f64; 3], text: &str) {
    for (own, factor) in terms.iter_mut().zip(along) {
        if factor.abs() > NOTHING {
            own.push((rounded(factor), text.to_owned()));
        }
    }
}

/// Adds a deviation in the frame of the part to one in the frame of a feature.
pub(super) fn add(own: &mut Torsor, taken: &PartTorsor, frame: &ConstantFrame, kind: FeatureKind) {
    let text = |terms: &[Terms; 3], axis: [f64; 3]| -> Option<String> {
        let parts = terms.iter().zip(axis).flat_map(|(terms, along)| {
            terms
                .iter()
                .map(move |(factor, text)| (rounded(factor * along), text))
                .filter(|(factor, _)| factor.abs() > NOTHING)
        });
        let parts: Vec<String> = parts
            .map(|(factor, text)| if factor == 1.0 { text.clone() } else { format!("({factor:?})*{text}") })
            .collect();
        (!parts.is_empty()).then(|| parts.join(" + "))
    };
    let joined = |own: &mut Option<String>, more: Option<String>| {
        *own = match (own.take(), more) {
            (Some(own), Some(more)) => Some(format!("{own} + {more}")),
            (own, more) => own.or(more),
        };
    };
    for (axis, direction) in frame.axes.iter().enumerate() {
        joined(&mut own.shift[axis], text(&taken.shift, *direction));
        if kind != FeatureKind::Point {
            joined(&mut own.tilt[axis], text(&taken.tilt, *direction));
        }
    }
}
