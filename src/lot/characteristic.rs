//! Characteristics by the assumed parts, by the measured parts, and as measured.

use serde::Serialize;

use crate::analysis::{Analysis, CharacteristicAnalysis};
use crate::lot::error::sample;
use crate::lot::{CorrelationInLot, DimensionInLot, LotError, LotTable};
use crate::problem::Problem;
use sensitol_numeric::lot::{
    LotFigure, LotSample, LotTest, MeasuredPair, MeasuredPart, PredictedVariance, compare_means, compare_spreads,
    predicted_yield_interval,
};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::sampling::clopper_pearson;

/// A characteristic as predicted twice and as measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CharacteristicInLot {
    /// Name of the characteristic.
    pub name: String,
    /// Unit of the characteristic.
    pub unit: Option<String>,
    /// Lower and upper limit.
    pub limits: [Option<f64>; 2],
    /// Prediction of the study; null if the model has no result.
    pub assumed: Option<PredictedFigures>,
    /// Prediction with the measured parts; null if there are none.
    pub by_parts: Option<PredictedFigures>,
    /// Measured assemblies; null if there are none.
    pub assemblies: Option<MeasuredAssemblies>,
    /// Tests of mean and sigma of the assemblies against the study.
    pub against_assumed: Option<[LotTest; 2]>,
    /// Tests of mean and sigma of the assemblies against the measured parts; null if no measured part is in the characteristic.
    pub against_parts: Option<[LotTest; 2]>,
    /// Difference of the two predictions by measured dimensions, largest first.
    pub differences: Vec<DifferenceShare>,
    /// Difference of the means that no dimension explains alone.
    pub mean_remainder: Option<f64>,
    /// Difference of the variances that no dimension explains alone.
    pub variance_remainder: Option<f64>,
    /// True for mean and sigma each if the measured parts alone show, at 5 %, that the prediction of the study is wrong.
    #[serde(skip)]
    pub parts_differ: [bool; 2],
    /// Judgement.
    pub verdict: LotVerdict,
}

/// Mean, sigma and yield of a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PredictedFigures {
    /// Mean; its interval is that of the number of measured parts, or null if nothing measured is in it.
    pub mean: f64,
    /// 95 % interval of the mean.
    pub mean_interval: Option<[f64; 2]>,
    /// Standard deviation.
    pub sigma: f64,
    /// Third standardised moment.
    pub skewness: Option<f64>,
    /// Fourth standardised moment.
    pub kurtosis: Option<f64>,
    /// Yield; null without a limit.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// 95 % interval of the yield by the number of measured parts.
    pub yield_interval: Option<[f64; 2]>,
}

/// Measured assemblies.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeasuredAssemblies {
    /// Number of assemblies.
    pub count: usize,
    /// Mean.
    pub mean: LotFigure,
    /// Standard deviation.
    pub sigma: LotFigure,
    /// Share within the limits with its interval by Clopper and Pearson; null without a limit.
    pub within: Option<LotFigure>,
    /// Measured values.
    #[serde(skip)]
    pub values: Vec<f64>,
}

/// Part of one dimension in the difference of two predictions.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DifferenceShare {
    /// The dimension.
    pub dimension: String,
    /// Change of the mean by it; null if its slope is unknown.
    pub mean: Option<f64>,
    /// Change of the variance by it; null if its share is unknown.
    pub variance: Option<f64>,
}

/// Judgement of a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LotVerdict {
    /// No assemblies were measured: the parts alone predict.
    NotMeasured,
    /// The assemblies agree with the study.
    AsAssumed,
    /// The assemblies differ from the study as the measured parts predict.
    ByParts {
        /// Dimension with the largest part in the difference.
        dimension: Option<String>,
    },
    /// The assemblies differ from the study. The measured parts are too few for a decision: they agree with both.
    TooFewParts {
        /// True for the mean.
        mean: bool,
        /// True for the sigma.
        sigma: bool,
    },
    /// The assemblies differ from the prediction of their parts: the model is wrong, or a dimension is missing.
    Unexplained {
        /// True if the mean differs.
        mean: bool,
        /// True if the sigma differs.
        sigma: bool,
    },
}

impl CharacteristicInLot {
    /// Sets the verdict at this level of the family.
    pub(super) fn judge(&mut self, level: f64) {
        let refuted = |tests: [LotTest; 2]| tests.map(|test| test.refutes(level));
        self.verdict = match (self.against_assumed.map(refuted), self.against_parts.map(refuted)) {
            (None, _) => LotVerdict::NotMeasured,
            (_, Some([mean, sigma])) if mean || sigma => LotVerdict::Unexplained { mean, sigma },
            (Some([false, false]), _) => LotVerdict::AsAssumed,
            // Parts that agree with the study as well as with the assemblies explain nothing.
            (Some([mean, sigma]), Some(_)) if mean && !self.parts_differ[0] || sigma && !self.parts_differ[1] => {
                LotVerdict::TooFewParts { mean: mean && !self.parts_differ[0], sigma: sigma && !self.parts_differ[1] }
            }
            (Some(_), Some(_)) => {
                LotVerdict::ByParts { dimension: self.differences.first().map(|one| one.dimension.clone()) }
            }
            (Some([mean, sigma]), None) => LotVerdict::Unexplained { mean, sigma },
        };
    }
}

/// Compares every characteristic.
pub(super) fn compared(
    tables: &[LotTable],
    [assumed, by_parts]: [&Analysis; 2],
    measured: &MeasuredLot<'_>,
) -> Result<Vec<CharacteristicInLot>, LotError> {
    let pairs = assumed.characteristics.iter().zip(&by_parts.characteristics);
    pairs.map(|(assumed, by_parts)| one(tables, [assumed, by_parts], measured)).collect()
}

/// Measured dimensions with their correlations, and the problem with them.
pub(super) struct MeasuredLot<'l> {
    /// Problem with the measured parts.
    pub(super) problem: &'l Problem,
    /// Measured dimensions.
    pub(super) dimensions: &'l [DimensionInLot],
    /// All pairs of the measured dimensions.
    pub(super) correlations: &'l [CorrelationInLot],
    /// Family-wise level.
    pub(super) level: f64,
}

fn one(
    tables: &[LotTable],
    [assumed, by_parts]: [&CharacteristicAnalysis; 2],
    lot: &MeasuredLot<'_>,
) -> Result<CharacteristicInLot, LotError> {
    let characteristic = &assumed.characteristic;
    let name = characteristic.name().to_owned();
    let limits = [characteristic.limits().lower(), characteristic.limits().upper()];
    let variance = variance(lot.problem, by_parts, lot.dimensions, lot.correlations, lot.level);
    let known = PredictedVariance::known(assumed.moments.map_or(f64::NAN, |of| of.variance()));
    let columns = tables.iter().flat_map(|table| table.columns.iter().map(move |column| (table, column)));
    let measured =
        columns.filter(|(_, column)| column.name == name).map(|(table, column)| sample(table, column)).next();
    let measured = measured.transpose()?;
    let tests = |moments: Option<Moments>, variance: &PredictedVariance| {
        let (measured, moments) = (measured.as_ref()?, moments?);
        let spreads = compare_spreads(measured, variance, excess(Some(moments)));
        Some([compare_means(measured, moments.mean(), variance), spreads])
    };
    // Without a measured part the second prediction is the first one, whose tests would be counted twice.
    let has_parts = !lot.dimensions.is_empty();
    let against_assumed = tests(assumed.moments, &known);
    let against_parts = if has_parts && (variance.of_mean() > 0.0 || by_parts.moments != assumed.moments) {
        tests(by_parts.moments, &variance)
    } else {
        None
    };
    let differences = differences([assumed, by_parts], lot.dimensions);
    let left = |total: Option<f64>, part: fn(&DifferenceShare) -> Option<f64>| {
        Some(total.filter(|_| has_parts)? - differences.iter().map(part).sum::<Option<f64>>()?)
    };
    let change = |of: fn(&Moments) -> f64| Some(of(by_parts.moments.as_ref()?) - of(assumed.moments.as_ref()?));
    let parts_differ = match (by_parts.moments, assumed.moments) {
        // The uncertainty of the parts is unknown without sensitivities: their prediction is taken as it is.
        (Some(_), Some(_)) if variance.of_mean() == 0.0 => [true; 2],
        (Some(parts), Some(assumed)) => variance.changes(parts.mean(), assumed.mean(), assumed.variance()),
        _ => [false; 2],
    };
    Ok(CharacteristicInLot {
        parts_differ,
        unit: characteristic.unit().map(str::to_owned),
        limits,
        assumed: PredictedFigures::of(assumed, None),
        by_parts: PredictedFigures::of(by_parts, Some(&variance)).filter(|_| has_parts),
        assemblies: measured.map(|column| MeasuredAssemblies::of(&column, limits, excess(by_parts.moments))),
        against_assumed,
        against_parts,
        mean_remainder: left(change(Moments::mean), |one| one.mean),
        variance_remainder: left(change(Moments::variance), |one| one.variance),
        differences,
        verdict: LotVerdict::NotMeasured,
        name,
    })
}

/// Predicted excess kurtosis; 0 as of a normal characteristic if it is unknown.
fn excess(moments: Option<Moments>) -> f64 {
    moments.and_then(|of| of.kurtosis()).map_or(0.0, |kurtosis| kurtosis - 3.0)
}

/// Variance of the prediction by the parts, with the uncertainty of the numbers of measured parts. `problem` is that of the measured parts.
fn variance(
    problem: &Problem,
    analysis: &CharacteristicAnalysis,
    dimensions: &[DimensionInLot],
    correlations: &[CorrelationInLot],
    level: f64,
) -> PredictedVariance {
    let Some(total) = analysis.moments.map(|of| of.variance()) else { return PredictedVariance::known(f64::NAN) };
    let correlation = |a: usize, b: usize| problem.correlation().map_or(0.0, |of| of.of(a, b));
    let in_block = |place: usize| problem.correlation().is_some_and(|of| of.block_of(place).is_some());
    let (mut parts, mut places): (Vec<MeasuredPart>, Vec<usize>) = (Vec::new(), Vec::new());
    for one in dimensions {
        let place = problem.dimensions().iter().position(|of| of.name() == one.name);
        let Some(place) = place.filter(|place| !in_block(*place)) else { continue };
        let Some(of) = analysis.sensitivities.get(place) else { continue };
        let law = problem.dimensions()[place].distribution();
        let excess = law.map_or(0.0, |law| law.standard_moments().kurtosis() - 3.0);
        let joined = (0..problem.dimensions().len()).any(|other| other != place && correlation(place, other) != 0.0);
        // The share of a correlated dimension has that of its partners in it, and may be negative.
        let effect = match (joined, of.linear_share, of.first) {
            (false, Some(share), first) => Some((share.max(0.0) * total).sqrt().copysign(first.unwrap_or(1.0))),
            (_, _, first) => first.map(|first| first * one.sigma.value),
        };
        let Some(effect) = effect else { continue };
        let curvature = of.curvature_share.unwrap_or(0.0).max(0.0) * total;
        parts.push(MeasuredPart { effect, curvature, count: one.parts, excess });
        places.push(place);
    }
    let mut pairs: Vec<MeasuredPair> = Vec::new();
    for (a, first) in places.iter().enumerate() {
        for (b, second) in places.iter().enumerate().skip(a + 1) {
            let value = correlation(*first, *second);
            let names = [first, second].map(|place| problem.dimensions()[*place].name());
            let found = correlations.iter().find(|of| of.between.iter().all(|name| names.contains(&name.as_str())));
            if value != 0.0 {
                let estimated = found.is_some_and(|found| found.test.refutes(level));
                let rows = found.map_or(0, |found| found.rows);
                pairs.push(MeasuredPair { parts: [a, b], correlation: value, estimated, rows });
            }
        }
    }
    PredictedVariance::of(total, &parts, &pairs)
}

/// Share of the variance that a dimension explains alone.
fn explained(analysis: &CharacteristicAnalysis, place: usize) -> Option<f64> {
    let of = analysis.sensitivities.get(place)?;
    Some(of.linear_share? + of.curvature_share.unwrap_or(0.0))
}

fn differences(
    [assumed, by_parts]: [&CharacteristicAnalysis; 2],
    dimensions: &[DimensionInLot],
) -> Vec<DifferenceShare> {
    let variance = |of: &CharacteristicAnalysis| of.moments.map(|moments| moments.variance());
    let part = |one: &DimensionInLot| {
        let place = assumed.sensitivities.iter().position(|of| of.dimension == one.name)?;
        let slope = |of: &CharacteristicAnalysis| of.sensitivities.get(place)?.first;
        let own = |of: &CharacteristicAnalysis| Some(explained(of, place)? * variance(of)?);
        let by = one.mean.value - one.assumed_mean;
        let mean = slope(assumed).zip(slope(by_parts)).map(|(a, b)| 0.5 * (a + b) * by);
        let variance = own(assumed).zip(own(by_parts)).map(|(a, b)| b - a);
        Some(DifferenceShare { dimension: one.name.clone(), mean, variance })
    };
    let mut found: Vec<DifferenceShare> = dimensions.iter().filter_map(part).collect();
    let spread = variance(assumed).unwrap_or(1.0);
    // A change of the mean counts by its square, which is its part in the mean squared distance from the assumed mean.
    let size = |one: &DifferenceShare| (one.mean.unwrap_or(0.0).powi(2) + one.variance.unwrap_or(0.0).abs()) / spread;
    found.sort_by(|a, b| size(b).total_cmp(&size(a)));
    found
}

impl PredictedFigures {
    fn of(analysis: &CharacteristicAnalysis, variance: Option<&PredictedVariance>) -> Option<Self> {
        let moments = analysis.moments?;
        let capability = analysis.distribution.capability;
        let rejects = capability.map_or([None; 2], |of| [of.below, of.above]);
        let yield_interval = match variance {
            Some(variance) if variance.of_mean() > 0.0 => predicted_yield_interval(rejects, variance),
            _ => analysis.yield_interval(),
        };
        Some(Self {
            mean: moments.mean(),
            mean_interval: variance
                .filter(|variance| variance.of_mean() > 0.0)
                .map(|variance| variance.mean_interval(moments.mean())),
            sigma: moments.sigma(),
            skewness: moments.skewness(),
            kurtosis: moments.kurtosis(),
            yield_: capability.and_then(|of| of.yield_()),
            yield_interval,
        })
    }
}

impl MeasuredAssemblies {
    fn of(column: &LotSample, [lower, upper]: [Option<f64>; 2], excess: f64) -> Self {
        let count = column.count();
        let kept =
            |value: &&f64| lower.is_none_or(|lower| **value >= lower) && upper.is_none_or(|upper| **value <= upper);
        let inside = column.values().iter().filter(kept).count();
        let within = (lower.is_some() || upper.is_some()).then(|| LotFigure {
            value: inside as f64 / count as f64,
            interval: clopper_pearson(inside as f64, count as f64),
        });
        Self {
            count,
            mean: column.mean_figure(),
            sigma: column.sigma_figure(excess),
            within,
            values: column.values().to_vec(),
        }
    }
}
