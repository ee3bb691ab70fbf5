//! Results of a simulation for one characteristic.

use serde::{Serialize, Serializer};

use crate::assembly::EvaluationError;
use crate::estimate::ConditionalYield;
use crate::extremes::keeps_by_proof;
use crate::method::Method;
use crate::problem::Problem;
#[cfg(feature = "schema")]
use crate::simulation::conclusion::SimulatedConclusion;
use crate::simulation::control_variate::Twin;
use crate::simulation::count::{Count, Replicate};
use crate::simulation::indices::SampledFactor;
use crate::simulation::inspection::inspected;
use crate::simulation::rare_switch_side::RareSwitchSides;
use crate::simulation::replicate_error::of_replicates;
use crate::simulation::replicate_moments::{moments, pooled, quantile};
use crate::simulation::surface_difference::{
    Controlled, Difference, Shares, carried, largest, moments as controlled, shares,
};
use crate::warning::Warning;
use sensitol_numeric::capability::{self, InspectionRisks, TAIL};
use sensitol_numeric::characteristic::KeptLimits;
use sensitol_numeric::characteristic::{Characteristic, SpecLimits};
#[cfg(feature = "schema")]
use sensitol_numeric::json_form::Concluded;
use sensitol_numeric::json_form::{RejectIntervals, through};
use sensitol_numeric::json_form::{millionths, text};
use sensitol_numeric::power::rescale;
use sensitol_numeric::requirement::{Requirement, RequirementFigures};
use sensitol_numeric::sampling::{Estimate, FEWEST, Summary, of_moments, wilson};
use sensitol_numeric::sampling::{LargestShare, SamplingInterval, clopper_pearson, one_error, settled};
use sensitol_numeric::verdict::{self, Judged, JudgedFigure, Verdict, Verdicts};

/// Estimates for one characteristic, each with its standard error. Unknown values are None.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct SimulatedCharacteristic {
    /// Characteristic, with its limits.
    #[serde(flatten)]
    #[cfg_attr(feature = "schema", schemars(with = "Concluded<Characteristic, SimulatedConclusion>"))]
    pub characteristic: Characteristic,
    /// Number of points with a value.
    pub samples: u64,
    /// Number of points without a value.
    pub failed: u64,
    /// Error of the first point without a value.
    #[serde(serialize_with = "text")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    pub error: Option<EvaluationError>,
    /// Mean value.
    #[serde(serialize_with = "value")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    pub mean: Option<Estimate>,
    /// Standard deviation.
    #[serde(serialize_with = "value")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    pub sigma: Option<Estimate>,
    /// Third standardised moment. None if nothing varies.
    #[serde(serialize_with = "value")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    pub skewness: Option<Estimate>,
    /// Fourth standardised moment, 3 for a normal distribution. None if nothing varies.
    #[serde(serialize_with = "value")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    pub kurtosis: Option<Estimate>,
    /// Quantiles at the [`PROBABILITIES`](sensitol_numeric::capability::PROBABILITIES). None if fewer than one value beyond is expected.
    /// There is no standard error with fewer than five.
    #[serde(skip)]
    pub quantiles: [Option<Estimate>; 7],
    /// Share of assemblies within the limits. None if there are no limits.
    #[serde(rename = "yield", serialize_with = "share")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    pub yield_: Option<YieldEstimate>,
    /// Share below the lower limit.
    #[serde(rename = "ppm_below", serialize_with = "millionths")]
    #[cfg_attr(feature = "schema", schemars(description = "Assemblies below the lower limit, per million."))]
    pub below: Option<f64>,
    /// Share above the upper limit.
    #[serde(rename = "ppm_above", serialize_with = "millionths")]
    #[cfg_attr(feature = "schema", schemars(description = "Assemblies above the upper limit, per million."))]
    pub above: Option<f64>,
    /// 95 % intervals of the shares below and above the limits, each from its own count. 0 to 0 if a proof excludes a side, None if that
    /// limit does not exist or no point has a value.
    #[serde(flatten, serialize_with = "through::<RejectIntervals, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "RejectIntervals"))]
    pub reject_intervals: [Option<[f64; 2]>; 2],
    /// Width of the limits divided by six sigma. None unless there are two limits, and if nothing varies.
    pub cp: Option<f64>,
    /// Distance of the nearer limit from the mean, divided by three sigma.
    pub cpk: Option<f64>,
    /// True if the sample was stopped before all its points were drawn. There is no verdict then.
    pub unfinished: bool,
    /// Least and greatest value of the sample.
    pub range: Option<[f64; 2]>,
    /// Histogram of the sample, with some tens of intervals.
    pub histogram: Option<Histogram>,
    /// Effect of the surrogate as control variate. None if none was requested, or it does not vary.
    pub control: Option<SurrogateControl>,
    /// Sobol' indices of every input. None if none were requested, or the sample does not determine them.
    #[serde(rename = "sobol")]
    pub indices: Option<Vec<SampledFactor>>,
    /// Yield of the assemblies that keep the limits of the characteristic that this one is given. None if it is given none, or no point
    /// keeps them.
    #[serde(rename = "conditional_yield")]
    pub conditional: Option<ConditionalYield>,
    /// Risks of the inspection, among the points of the sample. None if there is no gauge.
    pub inspection: Option<InspectionRisks>,
    /// Uncertainty of the results because measured dimensions are known by samples. None if there are no measured dimensions.
    #[serde(rename = "sampling_interval")]
    pub sampling: Option<SamplingInterval>,
    /// Moments without standard errors because they have not settled. They are reported as a warning.
    #[serde(skip)]
    pub unsettled: Option<Unsettled>,
}

/// Effect of a surrogate as control variate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SurrogateControl {
    /// Method of the surrogate.
    pub method: Method,
    /// Evaluations of the surrogate, for all characteristics together.
    pub evaluations: usize,
    /// Reduction of standard errors.
    pub reduction: Reduction,
    /// Number of points that carry mean, sigma, skewness and kurtosis.
    #[serde(skip)]
    pub(crate) carried: [f64; 4],
}

/// Ratios of the standard errors without and with the surrogate. None if unknown, and if the denominator is 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Reduction {
    /// Ratio for the mean.
    pub mean: Option<f64>,
    /// Ratio for sigma.
    pub sigma: Option<f64>,
}

/// Moments of a sample without standard errors, because a few points decide them, or assemblies that the sample does not contain.
#[derive(Debug, Clone, PartialEq)]
pub struct Unsettled {
    /// Names of the moments, the lowest first.
    figures: Vec<&'static str>,
    /// Share of the largest points in the sum of the first moment.
    share: LargestShare,
    /// Switch beyond which the assemblies are that the sample does not contain.
    switch: Option<String>,
}

/// Estimate of the share of assemblies that keep the limits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct YieldEstimate {
    /// Share among the points that have a value.
    pub value: f64,
    /// 95 % interval of the share, by the number of points only.
    pub interval: [f64; 2],
    /// Share if every point without a value is rejected, and if none is.
    pub bounds: [f64; 2],
}

/// Serializes an estimate without its standard error, which is written elsewhere.
fn value<S: Serializer>(estimate: &Option<Estimate>, serializer: S) -> Result<S::Ok, S::Error> {
    estimate.map(|estimate| estimate.value).serialize(serializer)
}

/// Serializes a yield without its interval, which is written elsewhere.
fn share<S: Serializer>(estimate: &Option<YieldEstimate>, serializer: S) -> Result<S::Ok, S::Error> {
    estimate.map(|estimate| estimate.value).serialize(serializer)
}

rescale!(SimulatedCharacteristic { mean, sigma, quantiles, range, histogram, inspection, sampling } without {
    characteristic, samples, failed, error, skewness, kurtosis, yield_, below, above, reject_intervals, cp, cpk, unfinished, control, indices,
    unsettled, conditional,
});
rescale!(Histogram { edges } without { counts });

/// Counts of values in intervals.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Histogram {
    /// Ends of the intervals, ascending: one more than there are intervals.
    pub edges: Vec<f64>,
    /// Number of values in each interval.
    pub counts: Vec<u64>,
}

const QUANTILES: [f64; 7] = [TAIL, 0.01, 0.05, 0.5, 0.95, 0.99, 1.0 - TAIL];

/// Rejects for each replicate, on average, from which on the scatter of the replicates gives the interval of the yield.
pub(super) const REJECTED: u64 = 5;
/// Largest value whose powers are safe: the eighth power of a larger one is close to the largest double, 1.8e308. The standard error of a
/// kurtosis needs it.
const LARGEST: f64 = 1e38;
/// Intervals of the histogram between the outer quantiles.
pub(crate) const BINS: usize = 40;
/// Factor on the standard error of the better of two estimates, because the same points decided the choice. Errors of 16 replicates are
/// uncertain by `1/sqrt(30)`, a fifth. The smaller of two such errors is too small by 0.56 of that if both are alike: a tenth.
pub(crate) const CHOICE: f64 = 1.1;

/// Returns None if the value is not finite, and the value without its error if the error is not finite.
fn finite(estimate: Option<Estimate>) -> Option<Estimate> {
    let Estimate { value, standard_error } = estimate.filter(|estimate| estimate.value.is_finite())?;
    Some(Estimate { value, standard_error: standard_error.filter(|error| error.is_finite()) })
}

impl SimulatedCharacteristic {
    pub(super) fn of((characteristic, kept): (&Characteristic, KeptLimits), evidence: &Evidence<'_>) -> Self {
        let count = evidence.count;
        let all = &evidence.all;
        let fine = pooled(&count.replicates);
        let known = all.count();
        let plain = evidence.plain();
        let [mean, sigma, skewness, kurtosis] = evidence.moments().map(finite);
        let shares = evidence.shares();
        // Shares with a surrogate take precedence over plain counts.
        let share = |side: usize| {
            if let Some(shares) = &shares {
                return Some(shares.outside[side]);
            }
            let outside: u64 = count.replicates.iter().map(|replicate| replicate.outside[side]).sum();
            (known > 0).then(|| outside as f64 / known as f64)
        };
        let limits = characteristic.limits();
        let quantiles = fine
            .as_ref()
            .map_or([None; 7], |fine| QUANTILES.map(|p| quantile(p, fine, all.range(), &count.replicates)));
        let range = (known > 0).then(|| all.range());
        // Ends of the histogram: the outer quantiles, or the range of a small sample.
        let outer = |index: usize, end: usize| {
            quantiles[index].map(|quantile| quantile.value).or(range.map(|range: [f64; 2]| range[end]))
        };
        let (low, high) = (outer(0, 0), outer(6, 1));
        let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
        let spread = value(sigma).filter(|&sigma| sigma > 0.0);
        let width = limits.lower().zip(limits.upper()).map(|(lower, upper)| upper - lower);
        let inspection = inspected(characteristic, kept, count, fine.as_ref());
        Self {
            cp: width.zip(spread).map(|(width, sigma)| width / (6.0 * sigma)),
            cpk: value(mean).zip(spread).and_then(|(mean, sigma)| capability::cpk(mean, sigma, limits)),
            unfinished: false,
            characteristic: characteristic.clone(),
            samples: known,
            failed: count.failed,
            error: count.error.clone(),
            mean,
            sigma,
            skewness,
            kurtosis,
            yield_: evidence.yield_of(limits),
            below: limits.lower().and_then(|_| share(0)),
            above: limits.upper().and_then(|_| share(1)),
            reject_intervals: [
                limits.lower().and_then(|_| evidence.interval_of(0)),
                limits.upper().and_then(|_| evidence.interval_of(1)),
            ],
            histogram: range.zip(fine).zip(low.zip(high)).map(|((range, fine), (low, high))| {
                let (edges, counts) = fine.histogram(range, [low, high], BINS);
                Histogram { edges, counts }
            }),
            range,
            quantiles,
            control: evidence.beside.as_ref().map(|(twin, differences)| SurrogateControl {
                method: twin.method,
                evaluations: twin.evaluations,
                reduction: Reduction { mean: reduction(plain[0], mean), sigma: reduction(plain[1], sigma) },
                carried: fewer(carried(differences)),
            }),
            indices: None,
            inspection,
            conditional: None,
            sampling: None,
            unsettled: evidence.unsettled(),
        }
    }

    /// Adds the uncertainty of measured samples, for all rejects and for each side.
    pub(super) fn with_sampling(self, sampling: SamplingInterval) -> Self {
        let sides = [self.below, self.above];
        let reject_intervals = verdict::sides_with_samples(sides, self.reject_intervals, sampling.rejected);
        Self { sampling: Some(sampling), reject_intervals, ..self }
    }
}

/// Figures of a sample. It gives no RSS and no worst case.
impl RequirementFigures for SimulatedCharacteristic {
    type Figure = JudgedFigure;

    /// Yield with its interval, in which points without a value may all be rejects. Of a characteristic with a condition it is the yield of
    /// the assemblies that count.
    fn yield_(&self) -> JudgedFigure {
        if self.characteristic.given().is_some() {
            let known = self.conditional.as_ref();
            return JudgedFigure { value: known.map(|of| of.value), interval: known.and_then(|of| of.interval) };
        }
        let interval = self.yield_.zip(self.yield_interval());
        let interval = interval.map(|(share, [low, high])| [low.min(share.bounds[0]), high]);
        JudgedFigure { value: self.yield_.map(|share| share.value), interval }
    }

    /// Cpk with two standard errors of mean and sigma, and the uncertainty of measured samples.
    fn cpk(&self) -> JudgedFigure {
        let Some((mean, sigma)) = self.mean.zip(self.sigma.filter(|sigma| sigma.value > 0.0)) else {
            return JudgedFigure { value: self.cpk, interval: None };
        };
        let [mean, sigma] = [mean, sigma].map(|of| (of.value, of.standard_error));
        JudgedFigure::cpk(self.cpk, mean, sigma, self.characteristic.limits(), self.sampling.as_ref())
    }

    /// Sigma with two standard errors, and the uncertainty of measured samples.
    fn sigma(&self) -> JudgedFigure {
        let measured = self.sampling.as_ref();
        self.sigma.map(|of| JudgedFigure::sigma(of.value, of.standard_error, measured)).unwrap_or_default()
    }
}

impl SimulatedCharacteristic {
    /// Adds a proof by interval arithmetic that a side without points has no rejects, if there is one.
    pub(super) fn with_proof(mut self, problem: &Problem, c: usize) -> Self {
        let open = [self.below == Some(0.0), self.above == Some(0.0)];
        let proven = keeps_by_proof(problem, c, open);
        for (interval, proven) in self.reject_intervals.iter_mut().zip(proven) {
            *interval = if proven { Some([0.0; 2]) } else { *interval };
        }
        self
    }

    /// Judges a requirement, which need not be the characteristic's own.
    pub(crate) fn judge(&self, requirement: Requirement) -> Judged {
        Judged::by(requirement, self).unless(self.unfinished)
    }

    /// 95 % interval of the yield: that of the points, with the uncertainty of measured samples. Returns None if there are no limits, or no
    /// point has a value.
    pub fn yield_interval(&self) -> Option<[f64; 2]> {
        let YieldEstimate { value, interval, .. } = self.yield_?;
        let rejected = self.sampling.as_ref().and_then(|of| of.rejected);
        let measured = rejected.map(|[low, high]| [1.0 - high, 1.0 - low]);
        Some(measured.map_or(interval, |measured| verdict::share(verdict::joined(value, interval, measured))))
    }

    /// Errors of mean and sigma that determine the number of printed digits: standard errors, with the uncertainty of measured samples.
    pub fn errors(&self) -> [Option<f64>; 2] {
        let error = |estimate: Option<Estimate>, of: fn(&SamplingInterval) -> Option<[f64; 2]>| {
            let Estimate { value, standard_error } = estimate?;
            let measured = self.sampling.as_ref().and_then(of).map(|interval| one_error(value, interval));
            Some(libm::hypot(standard_error?, measured.unwrap_or(0.0)))
        };
        [error(self.mean, |of| of.mean), error(self.sigma, |of| of.sigma)]
    }

    /// One error of the yield: half of the distance to the farther end of its interval.
    pub fn yield_error(&self) -> Option<f64> {
        Some(one_error(self.yield_?.value, self.yield_interval()?))
    }

    /// Judges a requirement by three errors on either side.
    pub(crate) fn judge_widely(&self, requirement: Requirement) -> Judged {
        self.judge(requirement).widely()
    }

    /// Yield if every point without a value is rejected, and if none is. Returns None if every point has a value.
    pub fn yield_bounds(&self) -> Option<[f64; 2]> {
        self.yield_.filter(|_| self.failed > 0).map(|share| share.bounds)
    }

    /// Verdicts on the characteristic.
    pub(super) fn verdicts(&self) -> Verdicts {
        Verdicts::by(&self.characteristic, |requirement| self.judge(requirement))
    }

    /// Verdicts on all requirements of the characteristic, its target yield included.
    pub fn requirements(&self) -> Vec<Judged> {
        self.verdicts().requirements
    }

    /// Verdict on the target yield. Returns None if there is no target.
    pub fn verdict(&self) -> Option<Verdict> {
        self.verdicts().verdict
    }

    /// Warning of values whose powers overflow a double.
    pub(super) fn overflow(&self) -> Option<Warning> {
        let [least, greatest] = self.range?;
        let characteristic = self.characteristic.name().to_owned();
        let value = least.abs().max(greatest.abs());
        (value > LARGEST).then_some(Warning::Overflow { characteristic, value, limit: LARGEST })
    }

    /// Warning of moments that have not settled.
    pub(super) fn unsettled(&self) -> Option<Warning> {
        let Unsettled { figures, share, switch } = self.unsettled.clone()?;
        Some(Warning::UnsettledMoments {
            characteristic: self.characteristic.name().to_owned(),
            figures,
            points: self.samples,
            largest: share.largest,
            ten_largest: share.watched,
            switch,
        })
    }

    /// Warning of points without a value, if there are any.
    pub(crate) fn failures(&self) -> Option<Warning> {
        Some(Warning::FailedSamples {
            characteristic: self.characteristic.name().to_owned(),
            failed: self.failed,
            samples: self.samples + self.failed,
            error: self.error.as_ref()?.to_string(),
        })
    }
}

/// All counts together, with the surrogate as control variate.
pub(super) struct Evidence<'a> {
    count: &'a Count,
    all: Summary,
    beside: Option<(&'a Twin, Vec<&'a Difference>)>,
    answered: u64,
    watched: Option<Watched<'a>>,
}

/// Shares of the largest points in the sums that give the errors of the moments, and the effect of seldom sides on these sums.
struct Watched<'a> {
    plain: [Watch; 4],
    /// Sums of the differences to a surrogate.
    controlled: [Watch; 4],
    seldom: Option<&'a RareSwitchSides>,
}

/// Reliability of one sum.
#[derive(Clone, Copy, Default)]
struct Watch {
    share: LargestShare,
    /// True if a seldom side adds more to the sum than all points do.
    lacks_a_side: bool,
    /// Standard error by the seldom sides in a sample of the same number of random points, no matter whether it contains any.
    of_sides: f64,
}

impl Watch {
    /// Sets the standard error that the sum supports.
    fn settled(self, estimate: Estimate) -> Estimate {
        let estimate = settled(estimate, self.share);
        let known = estimate.standard_error.filter(|_| !self.lacks_a_side);
        Estimate { standard_error: known.map(|error| libm::hypot(error, self.of_sides)), ..estimate }
    }

    /// Raises the standard error towards that of independent points as far as a few points decide the sum.
    fn raised(self, estimate: Estimate, independent: Option<f64>) -> Estimate {
        let least = self.share.independence() * independent.unwrap_or(0.0);
        Estimate { standard_error: estimate.standard_error.map(|error| error.max(least)), ..estimate }
    }
}

impl<'a> Evidence<'a> {
    pub(super) fn of(count: &'a Count, twin: Option<&'a Twin>, answered: u64) -> Self {
        let all = count.summary();
        let differences = || count.replicates.iter().map(|one| &one.difference).collect();
        let beside = twin.filter(|_| all.count() > 0).map(|twin| (twin, differences()));
        Self { count, all, beside, answered, watched: None }
    }

    /// Removes standard errors that depend on a few points, or on assemblies beyond switches that are seldom met.
    pub(super) fn watched(mut self, seldom: Option<&'a RareSwitchSides>) -> Self {
        let (mean, sigma) = (self.all.mean(), self.all.moment(2).sqrt());
        let powers = seldom.filter(|_| sigma > 0.0).map_or([0.0; 4], |seldom| seldom.powers(mean, sigma));
        let standardised = self.all.standardised();
        let shares = self.count.largest().shares(&self.all);
        // The mean has the unit of the values, and the relative error of sigma is half of that of its square.
        let of_sides = |power: f64, i: usize, sigma: f64| {
            [sigma, 0.5 * sigma, 1.0, 1.0][i] * (power / self.all.count().max(1) as f64).sqrt()
        };
        let plain = std::array::from_fn(|i| Watch {
            of_sides: of_sides(powers[i], i, sigma),
            share: shares[i],
            lacks_a_side: standardised.is_some_and(|moments| powers[i] > moments[2 * i + 2]),
        });
        let controlled = self.beside.as_ref().map_or([Watch::default(); 4], |(twin, differences)| {
            let squares = seldom.map_or([0.0; 4], |seldom| seldom.differences(twin));
            let largest = largest(differences);
            std::array::from_fn(|i| Watch {
                of_sides: of_sides(squares[i], i, twin.moments.sigma),
                share: largest[i].0,
                lacks_a_side: squares[i] > largest[i].1,
            })
        });
        self.watched = Some(Watched { plain, controlled, seldom });
        self
    }

    pub(super) fn moments(&self) -> [Option<Estimate>; 4] {
        let plain = self.plain();
        let Some((twin, differences)) = &self.beside else { return plain };
        let (random, controlled) = (of_moments(&self.all), controlled(differences, twin));
        let watched = self.watched.as_ref().map_or([Watch::default(); 4], |watched| watched.controlled);
        std::array::from_fn(|i| {
            let controlled = controlled[i].map(|Controlled { estimate, random, unfitted }| {
                let known = |estimate: Estimate| watched[i].settled(watched[i].raised(estimate, unfitted));
                let random = known(Estimate { standard_error: random, ..estimate }).standard_error;
                Controlled { estimate: known(estimate), random, unfitted }
            });
            better(controlled, plain[i], self.settled(random)[i])
        })
    }

    /// Moments of the sample without the surrogate.
    fn plain(&self) -> [Option<Estimate>; 4] {
        let (random, estimates) = (of_moments(&self.all), moments(&self.all, &self.count.replicates));
        let Some(Watched { plain, .. }) = &self.watched else { return estimates };
        let independent = |i: usize| random[i].and_then(|of| of.standard_error);
        self.settled(std::array::from_fn(|i| estimates[i].map(|estimate| plain[i].raised(estimate, independent(i)))))
    }

    /// Sets the standard errors that the sums of the sample support.
    fn settled(&self, estimates: [Option<Estimate>; 4]) -> [Option<Estimate>; 4] {
        let Some(Watched { plain, .. }) = &self.watched else { return estimates };
        std::array::from_fn(|i| estimates[i].map(|estimate| plain[i].settled(estimate)))
    }

    /// Moments without a standard error because they have not settled.
    fn unsettled(&self) -> Option<Unsettled> {
        let watched = self.watched.as_ref().filter(|_| self.all.count() >= FEWEST)?;
        let found = self.moments();
        let lacking = |i: usize| {
            let plain = watched.plain[i];
            (plain.lacks_a_side || plain.share.widening().is_none())
                && found[i].is_some_and(|of| of.value.is_finite() && of.standard_error.is_none())
        };
        let open: Vec<usize> = (0..4).filter(|&i| lacking(i)).collect();
        let &first = open.first()?;
        let plain = watched.plain[first];
        Some(Unsettled {
            figures: open.iter().map(|&i| ["mean", "sigma", "skewness", "kurtosis"][i]).collect(),
            share: plain.share,
            switch: watched.seldom.filter(|_| plain.lacks_a_side).and_then(RareSwitchSides::rarest),
        })
    }

    /// Shares outside the limits, if there are a surrogate and limits.
    fn shares(&self) -> Option<Shares> {
        let (twin, differences) = self.beside.as_ref()?;
        shares(differences, twin.outside.as_ref()?, REJECTED * differences.len() as u64)
    }

    /// Interval of the share below (0) or above (1) the limits, from its own count. Returns None if no value is known.
    fn interval_of(&self, side: usize) -> Option<[f64; 2]> {
        let (known, replicates) = (self.all.count(), &self.count.replicates);
        if let Some(shares) = self.shares() {
            return Some(shares.intervals[side]);
        }
        let outside: u64 = replicates.iter().map(|replicate| replicate.outside[side]).sum();
        let value = outside as f64 / known as f64;
        let few = outside.min(known - outside) < REJECTED * replicates.len() as u64;
        let scatter = of_replicates(replicates.iter().map(|replicate| {
            let n = replicate.summary.count();
            (n > 0).then(|| replicate.outside[side] as f64 / n as f64)
        }));
        match scatter {
            _ if known == 0 => None,
            Some(error) if !few && error > 0.0 => {
                Some([(value - 2.0 * error).max(0.0), (value + 2.0 * error).min(1.0)])
            }
            _ => Some(clopper_pearson(outside as f64, known as f64)),
        }
    }

    /// Share of assemblies within the limits. Returns None if there are no limits, or no value is known.
    pub(super) fn yield_of(&self, limits: SpecLimits) -> Option<YieldEstimate> {
        let (known, answered, replicates) = (self.all.count(), self.answered, &self.count.replicates);
        if !limits.exist() || known == 0 {
            return None;
        }
        if let Some(Shares { outside, interval, .. }) = self.shares() {
            let value = (1.0 - outside[0] - outside[1]).max(0.0);
            let within = value * known as f64;
            let bounds = [within, within + (answered - known) as f64].map(|most| most / answered as f64);
            return Some(YieldEstimate { value, interval, bounds });
        }
        let rejected = |replicate: &Replicate| replicate.outside.iter().sum::<u64>();
        let outside: u64 = replicates.iter().map(rejected).sum();
        let within = known - outside;
        let value = within as f64 / known as f64;
        let few = outside.min(within) < REJECTED * replicates.len() as u64;
        let interval = match of_replicates(replicates.iter().map(|replicate| {
            let n = replicate.summary.count();
            (n > 0).then(|| 1.0 - rejected(replicate) as f64 / n as f64)
        })) {
            Some(error) if !few && error > 0.0 => [(value - 2.0 * error).max(0.0), (value + 2.0 * error).min(1.0)],
            _ => wilson(within as f64, known as f64),
        };
        let bounds = [within, within + (answered - known)].map(|most| most as f64 / answered as f64);
        Some(YieldEstimate { value, interval, bounds })
    }
}

/// Chooses the controlled estimate, or the plain one if it is better. A tenth is added to the standard error for the choice.
///
/// The criterion is the scatter of all points as if they were random. Standard errors of 16 replicates are uncertain by a fifth: the
/// smaller of two would be too small. An estimate with an unknown error is worse than any other.
fn better(controlled: Option<Controlled>, plain: Option<Estimate>, random: Option<Estimate>) -> Option<Estimate> {
    let Some(Controlled { estimate, random: own, .. }) = controlled else { return plain };
    // If powers of the values overflow, only the controlled figure remains, because it is in units of its own sigma.
    let known = plain.filter(|of| of.value.is_finite() && of.standard_error.is_some());
    let without =
        random.filter(|of| of.value.is_finite()).and_then(|of| of.standard_error).filter(|error| error.is_finite());
    let Some(own) = own else { return known.or(Some(estimate)) };
    let best = if without.is_some_and(|without| without < own) { plain? } else { estimate };
    Some(Estimate { standard_error: best.standard_error.map(|error| CHOICE * error), ..best })
}

/// Number of points that carry each moment: the smaller one of the sums with and without the surrogate.
fn fewer([plain, controlled]: [[f64; 4]; 2]) -> [f64; 4] {
    std::array::from_fn(|moment| plain[moment].min(controlled[moment]))
}

/// Ratio of the standard errors without and with the surrogate.
fn reduction(plain: Option<Estimate>, controlled: Option<Estimate>) -> Option<f64> {
    let error = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.standard_error);
    let times = error(plain)? / error(controlled).filter(|&error| error > 0.0)?;
    times.is_finite().then_some(times)
}
