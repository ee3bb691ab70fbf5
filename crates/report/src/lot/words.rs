//! Sentences about a lot: departures of a dimension, verdict of a characteristic.

use crate::document::number::{index, percent, significant};
use sensitol::lot::{
    CharacteristicInLot, CorrelationInLot, DifferenceShare, DimensionInLot, GroupKind, LotComparison, LotVerdict,
};
use sensitol_numeric::lot::{Departure, LotFigure};

/// Formats a figure with its interval.
pub(super) fn figure(of: &LotFigure, digits: usize) -> String {
    let [low, high] = of.interval.map(|end| significant(end, digits));
    format!("{} ({low} .. {high})", significant(of.value, digits))
}

/// Formats a value with decimals that suit a sigma.
pub(super) fn placed(value: f64, sigma: f64) -> String {
    crate::document::number::beside(value, sigma)
}

/// Departures of a dimension from its assumption, each as a phrase.
pub(super) fn departures(one: &DimensionInLot, level: f64) -> Vec<String> {
    let mut phrases = Vec::new();
    if one.mean_test.refutes(level) {
        let by = one.mean.value - one.assumed_mean;
        let direction = if by > 0.0 { "above" } else { "below" };
        let sigmas = index(by.abs() / one.assumed_sigma);
        phrases.push(format!("mean {} {direction} the assumed one, {sigmas} sigma", significant(by.abs(), 3)));
    }
    if one.sigma_test.refutes(level) {
        phrases.push(format!("sigma {} times the assumed one", significant(one.sigma.value / one.assumed_sigma, 3)));
    }
    if let (Some(trend), Some(test)) = (one.trend, one.trend_test)
        && test.refutes(level)
    {
        phrases.push(format!("trend of {} over the lot", significant(trend.value, 3)));
    }
    for of in one.groups.iter().filter(|of| of.test.refutes(level)) {
        let what = match of.kind {
            GroupKind::Lot => "lots",
            GroupKind::Machine => "machines",
            GroupKind::Operator => "operators",
        };
        let part = of.between.value.powi(2) / (of.between.value.powi(2) + of.within.value.powi(2));
        phrases.push(format!("{what} differ, {} % of the variance between `{}`", percent(part), of.column));
    }
    if one.shape_test.is_some_and(|test| test.refutes(level)) {
        phrases.push(shape(one));
    }
    phrases
}

/// Measured correlation beside the assumed one.
pub(super) fn correlation(pair: &CorrelationInLot) -> String {
    let [a, b] = &pair.between;
    // Near 1 the distance from 1 is what counts.
    let [low, high] = pair.value.interval;
    let [value, low, high] = [pair.value.value, low, high].map(|value| format!("{value:.4}"));
    format!("correlation of {a} and {b}: {value} ({low} .. {high}), assumed {}", significant(pair.assumed, 2))
}

fn shape(one: &DimensionInLot) -> String {
    let short = |value: f64| placed(value, one.sigma.value);
    let of = one.assumed_distribution;
    match &one.departure {
        Some(Departure::Mixture { means, share }) => {
            let [a, b] = means.map(short);
            let parts = [1.0 - share, *share].map(percent);
            format!("not {of}: like two groups about {a} ({} %) and {b} ({} %)", parts[0], parts[1])
        }
        Some(Departure::Truncation { ends }) => {
            let ends = match ends {
                [Some(low), Some(high)] => format!("below {} and above {}", short(*low), short(*high)),
                [Some(low), None] => format!("below {}", short(*low)),
                [None, Some(high)] => format!("above {}", short(*high)),
                [None, None] => "beyond its ends".to_owned(),
            };
            format!("not {of}: like parts sorted out {ends}")
        }
        Some(Departure::Outliers { values }) => {
            let listed: Vec<String> = values.iter().take(3).map(|value| short(*value)).collect();
            let more = if values.len() > 3 { format!(" and {} more", values.len() - 3) } else { String::new() };
            format!("not {of}: outliers {}{more}", listed.join(", "))
        }
        Some(Departure::Skewness { skewness }) => format!("not {of}: skewness {}", index(*skewness)),
        Some(Departure::Kurtosis { kurtosis }) => format!("not {of}: kurtosis {}", index(*kurtosis)),
        None => format!("not {of}"),
    }
}

/// Verdict of a characteristic in one sentence.
pub(super) fn verdict(one: &CharacteristicInLot, found: &LotComparison) -> String {
    match &one.verdict {
        LotVerdict::NotMeasured => format!("no assemblies were measured: {}", parts_alone(one, found)),
        LotVerdict::AsAssumed if one.against_parts.is_none() => "the assemblies agree with the study".to_owned(),
        LotVerdict::AsAssumed => "the assemblies agree with the study and with their parts".to_owned(),
        LotVerdict::ByParts { dimension: Some(dimension) } => {
            format!("the assemblies differ from the study as their parts do: most by `{dimension}`")
        }
        LotVerdict::ByParts { dimension: None } => "the assemblies differ from the study as their parts do".to_owned(),
        LotVerdict::TooFewParts { mean, sigma } => format!(
            "the assemblies differ from the study in {}: the measured parts are too few to tell whether they explain it",
            figures(*mean, *sigma)
        ),
        LotVerdict::Unexplained { mean, sigma } if one.against_parts.is_none() => format!(
            "the assemblies differ from the study in {}, and no part of it was measured",
            figures(*mean, *sigma)
        ),
        LotVerdict::Unexplained { mean, sigma } => format!(
            "no measured dimension explains the {} of the assemblies: the model is wrong, or a dimension is missing",
            figures(*mean, *sigma)
        ),
    }
}

/// Judgement of the parts without assemblies, by the tests that the departures below it name.
fn parts_alone(one: &CharacteristicInLot, found: &LotComparison) -> String {
    let level = found.family_wise_level;
    let refuted = |name: &str| found.dimensions.iter().any(|of| of.name == name && of.departs(level));
    let acts =
        |share: &&DifferenceShare| share.mean.is_none_or(|by| by != 0.0) || share.variance.is_none_or(|by| by != 0.0);
    let first = one.differences.iter().filter(acts).find(|share| refuted(&share.dimension));
    let correlated = found.correlations.iter().any(|pair| pair.departs(level));
    match (first, changes(one)) {
        (Some(first), true) => format!("the parts change the prediction, most by `{}`", first.dimension),
        (Some(_), false) => "parts depart from the study, and hardly change the prediction".to_owned(),
        (None, true) if correlated => "the correlation of the parts changes the prediction".to_owned(),
        (None, _) if correlated => "the correlation of the parts departs from the study".to_owned(),
        (None, _) => "no measured part of it departs from the study".to_owned(),
    }
}

fn figures(mean: bool, sigma: bool) -> &'static str {
    match (mean, sigma) {
        (true, true) => "mean and sigma",
        (true, false) => "mean",
        _ => "sigma",
    }
}

/// True if the two predictions differ by a tenth of a sigma or more.
fn changes(one: &CharacteristicInLot) -> bool {
    /// Change of mean or sigma, in assumed sigmas, that is worth a sentence.
    const SEEN: f64 = 0.1;
    let (Some(assumed), Some(parts)) = (&one.assumed, &one.by_parts) else { return false };
    let off = (parts.mean - assumed.mean).abs().max((parts.sigma - assumed.sigma).abs());
    off >= SEEN * assumed.sigma
}
