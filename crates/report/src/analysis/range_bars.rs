//! Bars of a characteristic's ranges beside its limits, and the variance that its contributions leave out.

use crate::analysis::worst_case::KnownWorstCaseFigures;
use crate::analysis::worst_case::WorstCaseKind;
use crate::document::number::{NEWS, beside, outward, percent};
use crate::document::{Bar, Bars, Extent, Fill, Line, Tone};
use crate::figures::FittedFigures;
use crate::figures::{Figures, Named};
use sensitol::analysis::CharacteristicAnalysis;
use sensitol::extremes::Extremes;

/// Rounding tolerance at a limit, as a part of the extent of all intervals.
const ROUNDING: f64 = 1e-9;
/// Greatest distance of a drawn limit from the middle, in extents. A farther one would press everything else together.
const FAR: f64 = 2.0;
/// Name of the bar of bounds that interval arithmetic proves.
const BOUNDS: &str = "worst case, proven bounds";

/// Returns the part of the variance that the contributions leave out, in words. Returns None if it is negligible or unknown.
pub(crate) fn left_out(one: &CharacteristicAnalysis) -> Option<String> {
    let left_out = one.contributions.left_out_share.filter(|share| *share > 0.5 * NEWS)?;
    Some(format!("{} % is left out by all of these", percent(left_out)))
}

/// Returns the ranges below a density, with their ends as printed: mean \u{b1} 3 sigma, RSS, and the best known worst case.
pub(crate) fn ranges(one: &CharacteristicAnalysis) -> Vec<(String, [f64; 2], [String; 2])> {
    let around = |middle: Option<f64>, reach: Option<f64>| {
        let ends = [middle? - reach?, middle? + reach?];
        Some((ends, ends.map(|end| beside(end, one.scale()))))
    };
    let worst = one.known_worst_case();
    let name = match worst.as_ref().map(|worst| worst.kind) {
        Some(WorstCaseKind::Proven) => "worst case, proven",
        Some(WorstCaseKind::Found) => "worst case found",
        Some(WorstCaseKind::Linear) | None => "worst case, linear",
    };
    [
        ("mean \u{b1} 3\u{3c3}", around(one.mean(), one.sigma().map(|sigma| 3.0 * sigma))),
        ("RSS", around(one.linear.middle, one.linear.rss)),
        (name, worst.map(|worst| (worst.ends, worst.texts))),
    ]
    .into_iter()
    .filter_map(|(name, range)| {
        let (ends, texts) = range.filter(|(ends, _)| ends[0] < ends[1])?;
        Some((name.to_owned(), ends, texts))
    })
    .collect()
}

/// Builds bars of worst case, RSS and three sigma on one scale with the limits. Returns None if there is no extent.
pub(crate) fn spans(one: &CharacteristicAnalysis) -> Option<Bars> {
    let around = |middle: Option<f64>, reach: Option<f64>| Some([middle? - reach?, middle? + reach?]);
    let found = one.range.extremes.as_ref();
    let proven = if found.is_some_and(Extremes::proven) { "extremes, proven" } else { "extremes found" };
    // The study may set other inflation factors than Bender's 1.5.
    let bender = one
        .linear
        .rss
        .zip(one.linear.inflated_rss)
        .is_none_or(|(rss, inflated)| (inflated - 1.5 * rss).abs() <= 1e-9 * rss);
    let inflated = if bender { "RSS x 1.5 (Bender)" } else { "RSS x factors" };
    let intervals: Vec<(&str, [f64; 2])> = [
        ("worst case, linear", one.range.worst_case),
        (proven, found.map(|found| [found.least.value, found.greatest.value])),
        (BOUNDS, one.proof().map(|proof| proof.bounds)),
        ("RSS", around(one.linear.middle, one.linear.rss)),
        (inflated, around(one.linear.middle, one.linear.inflated_rss)),
        ("RSS with shifted means", around(one.linear.middle, one.linear.mean_shift_rss)),
        ("mean \u{b1} 3 sigma", around(one.mean(), one.sigma().map(|sigma| 3.0 * sigma))),
    ]
    .into_iter()
    .filter_map(|(name, interval)| Some((name, interval?)))
    .collect();
    let limits = Named::limits(one);
    let ends = intervals.iter().flat_map(|(_, interval)| *interval);
    let extent = ends.clone().fold(f64::NEG_INFINITY, f64::max) - ends.clone().fold(f64::INFINITY, f64::min);
    let middle = one.mean().or(one.linear.middle).unwrap_or(0.0);
    let near = limits.into_iter().flatten().filter(|limit| (limit - middle).abs() < FAR * extent);
    let scale = Extent::over(ends.chain(near), 0.04, 100.0)?;
    let (unit, slack) = (one.scale(), ROUNDING * extent);
    let limited = limits != [None, None];
    let row = |(name, [from, to]): (&str, [f64; 2])| {
        let kept = one.lower().is_none_or(|lower| from >= lower - slack)
            && one.upper().is_none_or(|upper| to <= upper + slack);
        let fill = if limited && !kept { Fill::Over } else { Fill::Span };
        let x = scale.at(from);
        let [low, high] = match name == BOUNDS {
            true => outward([from, to], unit, None),
            false => [from, to].map(|end| beside(end, unit)),
        };
        Bar {
            name: name.to_owned(),
            parts: vec![(fill, [x, (scale.at(to) - x).max(0.2)])],
            text: format!("{low} .. {high}"),
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
