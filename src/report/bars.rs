//! The bars of a characteristic: contributions to the variance, and intervals beside the limits.

use super::figures::{Figures, Named};
use crate::analysis::{CharacteristicAnalysis, Sensitivity};
use crate::document::number::{NEWS, beside, percent};
use crate::document::{Bar, Bars, Extent, Fill, Line, Tone};
use crate::extremes::Extremes;

/// Bars of a Pareto diagram.
const BARS: usize = 24;
/// A part of the extent of all intervals that rounding may make.
const ROUNDING: f64 = 1e-9;
/// A limit farther off than this many extents would press everything together.
const FAR: f64 = 2.0;

/// The strongest contributions to the variance, and what is left in words.
pub(super) fn pareto(one: &CharacteristicAnalysis) -> (Bars, Option<String>) {
    type Share = (String, [f64; 3]);
    if one.is_of_model() {
        return (pareto_of_model(one), None);
    }
    let own = one
        .sensitivities
        .iter()
        .filter_map(|row| Some((row.dimension.clone(), [row.linear_share?, row.curvature_share.unwrap_or(0.0), 0.0])));
    let joint = one.interactions.iter().filter_map(|pair| {
        Some((format!("{} \u{d7} {}", pair.dimensions[0], pair.dimensions[1]), [0.0, 0.0, pair.share?]))
    });
    let size = |share: &Share| share.1.iter().sum::<f64>();
    let mut all: Vec<Share> = own.chain(joint).filter(|share| size(share).abs() > 0.5 * NEWS).collect();
    all.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let rest = all.split_off(all.len().min(BARS));
    let more = format!("{} more have {} % together", rest.len(), percent(rest.iter().map(size).sum()));
    let left_out = one.left_out_share.filter(|share| *share > 0.5 * NEWS);
    let left_out = left_out.map(|share| format!("{} % is left out by all of these", percent(share)));
    let words: Vec<String> = (!rest.is_empty()).then_some(more).into_iter().chain(left_out).collect();
    // Bars are as long as the longest is wide; a negative share, of correlated dimensions, has none.
    let longest = all.first().map_or(1.0, size).max(f64::MIN_POSITIVE);
    let length = |share: f64| (1e4 * (share / longest).max(0.0)).round() / 1e2;
    let mut sum = 0.0;
    let mut row = |share: &Share| {
        let [linear, curvature, interaction] = share.1.map(length);
        sum += size(share);
        Bar {
            name: share.0.clone(),
            parts: vec![
                (Fill::Linear, [0.0, linear]),
                (Fill::Curvature, [linear, curvature]),
                (Fill::Interaction, [0.0, interaction]),
            ],
            text: format!("{} %", percent(size(share))),
            remark: Line::from(format!("{} %", percent(sum))),
        }
    };
    let bars = Bars {
        caption: format!("Contributions to the variance of {}, strongest first", one.name()),
        rows: all.iter().map(&mut row).collect(),
        marks: Vec::new(),
        legend: vec![(Fill::Linear, "linear"), (Fill::Curvature, "curvature"), (Fill::Interaction, "interaction")],
    };
    (bars, (!words.is_empty()).then(|| words.join("; ")))
}

/// The same of the model: by itself, and with interactions.
fn pareto_of_model(one: &CharacteristicAnalysis) -> Bars {
    let share = |row: &Sensitivity| {
        let first = row.first_order?.value;
        Some((row.dimension.clone(), [first, row.total.map_or(first, |total| total.value.max(first))]))
    };
    let mut all: Vec<(String, [f64; 2])> =
        one.sensitivities.iter().filter_map(share).filter(|(_, [_, total])| *total > 0.5 * NEWS).collect();
    all.sort_by(|a, b| b.1[1].total_cmp(&a.1[1]));
    all.truncate(BARS);
    let longest = all.first().map_or(1.0, |(_, [_, total])| *total).max(f64::MIN_POSITIVE);
    let length = |share: f64| (1e4 * (share / longest).max(0.0)).round() / 1e2;
    let row = |(name, [first, total]): (String, [f64; 2])| Bar {
        name,
        parts: vec![
            (Fill::Linear, [0.0, length(first)]),
            (Fill::Interaction, [length(first), length(total - first.max(0.0))]),
        ],
        text: format!("{} to {} %", percent(first), percent(total)),
        remark: Line::default(),
    };
    Bars {
        caption: format!("Contributions to the variance of {} by the model, strongest first", one.name()),
        rows: all.into_iter().map(row).collect(),
        marks: Vec::new(),
        legend: vec![(Fill::Linear, "by itself"), (Fill::Interaction, "with others")],
    }
}

/// The ranges below a density: mean \u{b1} 3 sigma, RSS, and the worst case as well as it is known.
pub(super) fn ranges(one: &CharacteristicAnalysis) -> Vec<(String, [f64; 2])> {
    let around = |middle: Option<f64>, reach: Option<f64>| Some([middle? - reach?, middle? + reach?]);
    let worst = worst_case(one).map_or(("worst case", None), |(name, ends)| (name, Some(ends)));
    [
        ("mean \u{b1} 3\u{3c3}", around(one.mean(), one.sigma().map(|sigma| 3.0 * sigma))),
        ("RSS", around(one.middle, one.rss)),
        worst,
    ]
    .into_iter()
    .filter_map(|(name, ends)| Some((name.to_owned(), ends.filter(|ends| ends[0] < ends[1])?)))
    .collect()
}

/// The worst case as well as it is known, and how it is known: proven, found by a search, or linear.
pub(super) fn worst_case(one: &CharacteristicAnalysis) -> Option<(&'static str, [f64; 2])> {
    let searched = one.extremes.as_ref().map(|found| [found.least.value, found.greatest.value]);
    match (searched, one.proof().filter(|proof| proof.proven)) {
        (Some(ends), Some(_)) => Some(("worst case, proven", ends)),
        (None, Some(proof)) => Some(("worst case, proven", proof.bounds)),
        (Some(ends), None) => Some(("worst case found", ends)),
        (None, None) => Some(("worst case, linear", one.worst_case?)),
    }
}

/// Worst case, RSS and three sigma on one scale with the limits; None where there is no extent.
pub(super) fn spans(one: &CharacteristicAnalysis) -> Option<Bars> {
    let around = |middle: Option<f64>, reach: Option<f64>| Some([middle? - reach?, middle? + reach?]);
    let found = one.extremes.as_ref();
    let proven = if found.is_some_and(Extremes::proven) { "extremes, proven" } else { "extremes found" };
    // Unless the study says otherwise.
    let bender = one.rss.zip(one.inflated_rss).is_none_or(|(rss, inflated)| (inflated - 1.5 * rss).abs() <= 1e-9 * rss);
    let inflated = if bender { "RSS x 1.5 (Bender)" } else { "RSS x factors" };
    let intervals: Vec<(&str, [f64; 2])> = [
        ("worst case, linear", one.worst_case),
        (proven, found.map(|found| [found.least.value, found.greatest.value])),
        ("worst case, proven bounds", one.proof().map(|proof| proof.bounds)),
        ("RSS", around(one.middle, one.rss)),
        (inflated, around(one.middle, one.inflated_rss)),
        ("RSS with shifted means", around(one.middle, one.mean_shift_rss)),
        ("mean \u{b1} 3 sigma", around(one.mean(), one.sigma().map(|sigma| 3.0 * sigma))),
    ]
    .into_iter()
    .filter_map(|(name, interval)| Some((name, interval?)))
    .collect();
    let limits = Named::limits(one);
    let ends = intervals.iter().flat_map(|(_, interval)| *interval);
    let extent = ends.clone().fold(f64::NEG_INFINITY, f64::max) - ends.clone().fold(f64::INFINITY, f64::min);
    let middle = one.mean().or(one.middle).unwrap_or(0.0);
    let near = limits.into_iter().flatten().filter(|limit| (limit - middle).abs() < FAR * extent);
    let scale = Extent::over(ends.chain(near), 0.04, 100.0)?;
    let (unit, slack) = (one.scale(), ROUNDING * extent);
    let limited = limits != [None, None];
    let row = |(name, [from, to]): (&str, [f64; 2])| {
        let kept = one.lower().is_none_or(|lower| from >= lower - slack)
            && one.upper().is_none_or(|upper| to <= upper + slack);
        let fill = if limited && !kept { Fill::Over } else { Fill::Span };
        let x = scale.at(from);
        Bar {
            name: name.to_owned(),
            parts: vec![(fill, [x, (scale.at(to) - x).max(0.2)])],
            text: format!("{} .. {}", beside(from, unit), beside(to, unit)),
            remark: match (limited, kept) {
                (false, _) => Line::default(),
                (true, true) => Line::toned("within", Tone::Good),
                (true, false) => Line::toned("exceeds", Tone::Bad),
            },
        }
    };
    let inside = |x: &f64| *x >= scale.from && *x <= scale.to;
    Some(Bars {
        caption: format!("Intervals of {} on one scale, with the limits as lines", one.name()),
        rows: intervals.into_iter().map(row).collect(),
        marks: limits.into_iter().flatten().filter(inside).map(|limit| scale.at(limit)).collect(),
        legend: Vec::new(),
    })
}
