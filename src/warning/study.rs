//! Warnings about the study itself.

use crate::warning::text::{Text, likewise, names, say};
use crate::warning::{Advice, NameKind};
use sensitol_numeric::names::shortened_to;

/// Greatest number of characters of a formula in a warning.
const PART: usize = 40;

pub(super) fn unused_dimension(dimensions: &[String]) -> Text {
    let (which, they, part) = match dimensions {
        [_] => ("dimension".to_owned(), "It takes", "costs"),
        many => (format!("{} dimensions:", many.len()), "They take", "cost"),
    };
    say(format!(
        "No analysed characteristic depends on {which} {}. {they} no part in the result and {part} no evaluation.",
        names(dimensions)
    ))
    .advise(Advice::CheckNames)
}

pub(super) fn nominal_outside_limits(dimensions: &[String]) -> Text {
    let (of, their) = match dimensions {
        [_] => ("nominal value of", "its own limits"),
        _ => ("nominal values of", "their own limits"),
    };
    say(format!(
        "The {of} {} outside {their}. The limits count; the nominal values only say where the drawing begins.",
        match dimensions {
            [_] => format!("{} lies", names(dimensions)),
            many => format!("{} dimensions lie ({})", many.len(), names(dimensions)),
        }
    ))
    .advise(Advice::CheckLimits)
}

pub(super) fn mean_outside_limits(characteristics: &[String]) -> Text {
    say(format!(
        "The nominal value and the mean of {} lie outside the limits. More than half of the assemblies are likely to be rejected. A \
         sign in the formula or the limits may be reversed.",
        names(characteristics)
    ))
    .advise(Advice::CheckLimits)
}

pub(super) fn dominant_dimension(characteristic: &str, dimension: &str, share: &f64, factor: &f64) -> Text {
    say(format!(
        "`{dimension}` has {:.1} % of the variance of `{characteristic}`. Its tolerance is {factor:.0} times the widest other one in the same \
         unit. A decimal point or a unit may be wrong.",
        100.0 * share
    ))
    .advise(Advice::CheckLimits)
}

pub(super) fn unit_mismatch(
    formula: &str,
    column: &usize,
    part: &str,
    what: &str,
    instead: &str,
    others: &[String],
) -> Text {
    let part = shortened_to(part, PART);
    say(format!(
        "The units of {formula} do not go together. Column {column}, `{part}`, is {what}. The numbers are used as they are. To correct it, {instead}.{}",
        likewise(others)
    ))
    .advise(Advice::CheckUnits)
}

pub(super) fn unknown_unit(units: &[String]) -> Text {
    let (which, they) = match units {
        [_] => ("unit", "It is a label that goes"),
        _ => ("units", "They are labels that go"),
    };
    say(format!("Nothing is known of the {which} {}. {they} with every other unit.", names(units)))
        .advise(Advice::CheckUnits)
}

pub(super) fn periodic_input(dimensions: &[String]) -> Text {
    let vary = if dimensions.len() == 1 { "varies" } else { "vary" };
    say(format!(
        "{} {vary} evenly over a full turn inside a sine or cosine. Derivatives at one angle do not know the other angles: sigma and contributions are wrong.",
        names(dimensions)
    ))
    .advise(Advice::WriteDirectionAsRim)
    .advise(Advice::Sample { points: None })
}

pub(super) fn interference(element: &str, share: &Option<f64>) -> Text {
    let pairs = match share {
        Some(share) if *share < 1e-4 => "Less than 0.01 % of the pairs do not go together".to_owned(),
        Some(share) => format!("{:.2} % of the pairs do not go together", 100.0 * share),
        None => "Some pairs may not go together".to_owned(),
    };
    say(format!("{pairs}: the bands of `{element}` let the pin be larger than its hole. Its clearance is 0 there, which is a kink of the formula."))
        .advise(Advice::CheckLimits)
}

pub(super) fn unused_name(kind: &NameKind, unused: &[String]) -> Text {
    let message = format!("No characteristic uses the {} {}.", kind.noun(unused.len()), names(unused));
    say(message).advise(Advice::CheckNames)
}

pub(super) fn near_singular(unknown: &str, condition: &f64) -> Text {
    say(format!(
        "The nominal position is nearly singular: the closure conditions hardly determine `{unknown}` (condition number {condition:.1e}). \
         Small deviations move it far, and some assemblies may not close."
    ))
    .advise(Advice::CheckPosition)
    .advise(Advice::Sample { points: None })
}
