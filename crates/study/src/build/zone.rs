//! Reads `[[joint]]`: dimensions that vary together as a whole, and zones with evenly spread points.

use crate::build::measured_rows::Block;
use crate::entries::correlation_entry::JointEntry;
use crate::entries::file::{DimensionEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::ZONES;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::correlation::{JointLaw, SolidShape, SolidZone};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;

/// Both exponents of the beta distribution of one coordinate, for points spread evenly over a disc.
pub(crate) const OF_DISC: f64 = 1.5;
/// Both exponents of the beta distribution of one coordinate, for points spread evenly over the rim of a disc.
pub(crate) const OF_RIM: f64 = 0.5;
/// Both exponents of the beta distribution of one coordinate, for points spread evenly over a ball.
pub(crate) const OF_BALL: f64 = 2.0;

/// Joint distribution of the zone with this name. Returns None if there is no such zone.
pub(crate) fn law(name: &str) -> Option<JointLaw> {
    let solid = |shape| JointLaw::Solid(SolidZone::new(shape));
    let solids = [SolidShape::Octahedron, SolidShape::Bicone, SolidShape::Ball].map(solid);
    let laws = [JointLaw::Disc, JointLaw::Rim, JointLaw::Diamond].into_iter().chain(solids);
    ZONES.iter().zip(laws).find(|(known, _)| **known == name).map(|(_, law)| law)
}

/// Blocks of the zones, in the order of the file, followed by the positions that are spread evenly over their zone.
pub(crate) fn zones(file: &StudyFile) -> Result<Vec<Block>, Fault> {
    let mut found: Vec<Block> = Vec::new();
    let mut taken: Vec<&str> = Vec::new();
    for (index, entry) in file.joint.0.iter().enumerate() {
        let key = format!("joint[{}]", index + 1);
        for name in entry.get_ref().of.get_ref() {
            if taken.contains(&name.get_ref().as_str()) {
                let twice = StudyFault::JointTwice { name: name.get_ref().clone() };
                return Err(fault(name.span(), format!("{key}.of"), twice));
            }
            taken.push(name.get_ref());
        }
        if let Some(law) = checked(file, entry, &key)? {
            let dimensions = entry.get_ref().of.get_ref().iter().map(|name| name.get_ref().clone()).collect();
            found.push(Block { dimensions, pairs: Vec::new(), law: Some(law) });
        }
    }
    let even = |(_, entry): &&(Spanned<String>, Spanned<DimensionEntry>)| {
        let entry = entry.get_ref();
        entry.position.as_ref().is_some_and(|zone| *zone.get_ref() > 0.0) && is_even(entry)
    };
    for (name, _) in file.dimensions.0.iter().filter(even) {
        let dimensions = ["x", "y"].map(|axis| format!("{}_{axis}", name.get_ref())).to_vec();
        found.push(Block { dimensions, pairs: Vec::new(), law: Some(JointLaw::Disc) });
    }
    Ok(found)
}

/// True if a position is spread evenly over its zone.
pub(crate) fn is_even(entry: &DimensionEntry) -> bool {
    entry.distribution.as_ref().is_some_and(|given| given.get_ref().kind == "uniform")
}

/// Joint distribution of an entry. Returns None if its dimensions are measured.
fn checked(file: &StudyFile, entry: &Spanned<JointEntry>, key: &str) -> Result<Option<JointLaw>, Fault> {
    let (span, entry) = (entry.span(), entry.get_ref());
    let of = entry.of.get_ref();
    let known: Vec<String> = file.dimensions.0.iter().map(|(name, _)| name.get_ref().clone()).collect();
    let line = |name: &Spanned<String>| {
        let line = file.dimensions.0.iter().find(|(known, _)| known.get_ref() == name.get_ref());
        line.map(|(_, line)| line.get_ref()).ok_or_else(|| {
            let nearest = nearest(name.get_ref(), known.iter().map(String::as_str)).map(str::to_owned);
            let (what, found, known) = ("dimension", name.get_ref().clone(), known.clone());
            fault(name.span(), format!("{key}.of"), StudyFault::UnknownWord { what, found, nearest, known })
        })
    };
    let lines = of.iter().map(|name| Ok((name, line(name)?))).collect::<Result<Vec<_>, Fault>>()?;
    let count = |law: Option<&str>| {
        let found = StudyFault::JointCount { law: law.map(str::to_owned), found: of.len() };
        fault(entry.of.span(), format!("{key}.of"), found)
    };
    match (&entry.measured, &entry.law) {
        (Some(_), Some(law)) => {
            let why = "are two ways to say how dimensions vary together: leave one out".to_owned();
            Err(fault(law.span(), format!("{key}.law"), StudyFault::Conflict { a: "measured", b: "law", why }))
        }
        (None, None) => {
            let instead = "write measured = \"lot.csv\", or law = \"disc\", \"rim\" or \"diamond\"".to_owned();
            Err(fault(span, key, StudyFault::MissingKey { key: "measured".into(), instead }))
        }
        (Some(measured), None) => {
            if of.len() < 2 {
                return Err(count(None));
            }
            // The expansion has copied the file to dimensions without one.
            let other = |line: &DimensionEntry| {
                line.measured.as_ref().is_none_or(|own| own.get_ref() != measured.get_ref() && line.serial.is_none())
            };
            match lines.iter().find(|(_, line)| other(line)) {
                None => Ok(None),
                Some((name, _)) => {
                    let found =
                        StudyFault::JointFile { name: name.get_ref().clone(), file: measured.get_ref().clone() };
                    Err(fault(name.span(), format!("{key}.of"), found))
                }
            }
        }
        (None, Some(word)) => {
            let Some(law) = law(word.get_ref()) else {
                let nearest = nearest(word.get_ref(), ZONES).map(str::to_owned);
                let (what, found) = ("law of a zone", word.get_ref().clone());
                let known = ZONES.map(str::to_owned).to_vec();
                let found = StudyFault::UnknownWord { what, found, nearest, known };
                return Err(fault(word.span(), format!("{key}.law"), found));
            };
            if of.len() != if matches!(law, JointLaw::Solid(_)) { 3 } else { 2 } {
                return Err(count(Some(word.get_ref())));
            }
            for (coordinate, (name, line)) in lines.into_iter().enumerate() {
                let at = |found| fault(name.span(), format!("{key}.of"), found);
                let (name, law_name) = (name.get_ref().clone(), word.get_ref().clone());
                if line.tolerance.is_none() && line.limits.is_none() && line.fit.is_none() {
                    return Err(at(StudyFault::JointBand { name, law: law_name }));
                }
                if line.measured.is_some() || line.moments.is_some() || !follows(line, &law, coordinate) {
                    return Err(at(StudyFault::JointDistribution { name, law: law_name }));
                }
            }
            Ok(Some(law))
        }
    }
}

/// True if a line has the distribution of a coordinate of the zone, which the expansion adds.
fn follows(line: &DimensionEntry, law: &JointLaw, coordinate: usize) -> bool {
    let Some(given) = &line.distribution else { return false };
    let given = given.get_ref();
    let is = |value: &Option<Spanned<f64>>, expected: f64| value.as_ref().is_some_and(|at| *at.get_ref() == expected);
    let beta = |exponent: f64| given.kind == "beta" && is(&given.alpha, exponent) && is(&given.beta, exponent);
    match law {
        JointLaw::Disc => beta(OF_DISC),
        JointLaw::Rim => beta(OF_RIM),
        JointLaw::Diamond => given.kind == "triangular" && given.mode.is_none(),
        JointLaw::Solid(solid) => match solid.shape() {
            SolidShape::Ball => beta(OF_BALL),
            SolidShape::Bicone if coordinate > 0 => given.kind == "bicone",
            SolidShape::Octahedron | SolidShape::Bicone => given.kind == "octahedron",
        },
        JointLaw::Rows(_) => false,
    }
}

/// Marks the dimensions of discs and rims as one zone, whose worst case has no point at the ends of both coordinates.
pub(crate) fn zoned(dimensions: Vec<Dimension>, blocks: &[Block]) -> Vec<Dimension> {
    let round = |block: &&Block| matches!(block.law, Some(JointLaw::Disc | JointLaw::Rim));
    let zone = |dimension: &Dimension| {
        let block = blocks.iter().filter(round).find(|of| of.dimensions.iter().any(|name| name == dimension.name()))?;
        (dimension.zone().is_none()).then(|| block.dimensions.join(", "))
    };
    let with = |dimension: Dimension| match zone(&dimension) {
        Some(zone) => dimension.within_zone(zone),
        None => dimension,
    };
    dimensions.into_iter().map(with).collect()
}
