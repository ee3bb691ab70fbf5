//! Standard tolerance grades in place of a free tolerance.

use crate::error::StudyFault;
use sensitol::allocation::{Curve, Offer};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::fits::grade_width;
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::Unit;

/// Names of the grades IT01 to IT18.
fn names() -> Vec<String> {
    ["01", "0"]
        .into_iter()
        .map(str::to_owned)
        .chain((1..=18).map(|grade: i32| grade.to_string()))
        .map(|grade| format!("IT{grade}"))
        .collect()
}

/// Offers of the grades from the first to the last, loosest first, within the given bounds. The half-width is half of a grade.
pub(crate) fn graded(
    curve: &Curve,
    ends: &[String; 2],
    [min, max]: [Option<f64>; 2],
    dimension: &Dimension,
) -> Result<Vec<Offer>, StudyFault> {
    let known = names();
    let place = |name: &String| {
        known.iter().position(|grade| grade == name).ok_or_else(|| {
            let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
            StudyFault::UnknownWord { what: "standard grade", found: name.clone(), nearest, known: known.clone() }
        })
    };
    let (first, last) = (place(&ends[0])?, place(&ends[1])?);
    if first > last {
        return Err(StudyFault::OutOfOrder { first: ends[0].clone(), last: ends[1].clone() });
    }
    let apart = |to: &str, instead| StudyFault::DoesNotApply { key: "grades", to: to.to_owned(), instead };
    if dimension.zone().is_some() {
        return Err(apart("a position", "a position has no size: write step or a free tolerance"));
    }
    let metre = Unit::parse("m");
    let millimetres = match dimension.unit() {
        None => Some(1.0),
        Some(name) => Unit::parse(name)
            .filter(|unit| metre.as_ref().is_some_and(|metre| unit.same_kind(metre)))
            .map(|unit| 1e3 * unit.scale),
    };
    let Some(millimetres) = millimetres else {
        return Err(apart("a dimension that is no length", "grades are of lengths: write step or a free tolerance"));
    };
    let mut offers = Vec::new();
    for grade in known[first..=last].iter().rev() {
        let half = 0.5 * grade_width(dimension.nominal().abs() * millimetres, &grade[2..])? / millimetres;
        let within =
            min.is_none_or(|min| half >= min * (1.0 - 1e-9)) && max.is_none_or(|max| half <= max * (1.0 + 1e-9));
        let known = curve.range().is_none_or(|[least, most]| (least..=most).contains(&half));
        if within && known {
            offers.push(Offer::between(Curve::fixed(curve.cost(half))?, half, half)?.named(grade));
        }
    }
    if offers.is_empty() {
        return Err(StudyFault::NoGrade { first: ends[0].clone(), last: ends[1].clone() });
    }
    Ok(offers)
}
