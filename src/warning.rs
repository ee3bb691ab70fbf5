//! Warnings: where an assumption of the method fails, what that means, and what to try.

/// Something that a reader of the results must know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// No asked characteristic can depend on a dimension.
    UnusedDimension {
        /// The dimension.
        dimension: String,
    },
    /// No characteristic of the study uses a constant or formula.
    UnusedName {
        /// `constant` or `formula`.
        what: &'static str,
        /// Its name.
        name: String,
    },
    /// A tolerance that was found is no fit of ISO 286 any more.
    FitReplaced {
        /// The dimension.
        dimension: String,
    },
    /// The model was not asked at the tolerances that were found.
    NotConfirmed,
    /// Monte Carlo at the tolerances that were found says that a required yield is missed.
    ConfirmationMisses {
        /// The characteristic.
        characteristic: String,
        /// What is required.
        required: f64,
        /// 95 % interval of what there is.
        interval: [f64; 2],
    },
    /// The model failed at some points.
    FailedPoints {
        /// The characteristic that has no value there.
        characteristic: String,
        /// At how many points.
        failed: usize,
        /// Of how many.
        points: usize,
        /// The first such point, in words.
        point: String,
        /// Why it has no value there.
        error: String,
    },
    /// The model failed at some points of a sample.
    FailedSamples {
        /// The characteristic that has no value there.
        characteristic: String,
        /// At how many points.
        failed: u64,
        /// Of how many.
        samples: u64,
        /// Why, of the first.
        error: String,
    },
    /// A derivative could not be had.
    LostDerivative {
        /// The characteristic.
        characteristic: String,
        /// The dimension, or the two of a mixed derivative.
        dimensions: Vec<String>,
        /// What is lost.
        loss: Loss,
    },
    /// The model fails within reach of the tolerances: differences were taken over a shorter step.
    DomainEdge {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which it fails.
        dimension: String,
        /// The node that failed, in sigmas off the mean.
        failed: f64,
        /// The node in its place.
        used: f64,
    },
    /// A node that the moments want lies outside a distribution's support.
    SupportEdge {
        /// The dimension.
        dimension: String,
        /// Where the moments want it, in sigmas off the mean.
        from: f64,
        /// Where it is.
        to: f64,
    },
    /// A characteristic is curved along a dimension whose distribution reaches far beyond the nodes.
    LongTail {
        /// The characteristic.
        characteristic: String,
        /// The dimension.
        dimension: String,
        /// The farthest node, in sigmas off the mean.
        farthest: f64,
        /// How far values count in the fourth moment, in sigmas.
        reach: f64,
        /// The share of the variance that the curvature makes.
        share: f64,
    },
    /// The characteristic is the same at every point.
    NoReaction {
        /// The characteristic.
        characteristic: String,
    },
    /// The characteristic is exactly 0 at several points, though not at the means.
    Atom {
        /// The characteristic.
        characteristic: String,
        /// At how many points.
        points: usize,
    },
    /// Rounding in the model is not small beside the differences.
    Noise {
        /// The characteristic.
        characteristic: String,
        /// The rounding error of one value, relative to sigma.
        rounding: f64,
    },
    /// Interactions were left unexamined.
    PairsNotExamined {
        /// How many were examined.
        examined: usize,
        /// Of how many.
        possible: usize,
    },
    /// A first-order method on a characteristic that is visibly curved.
    RssInvalid {
        /// The characteristic.
        characteristic: String,
        /// How far curvature moves the mean, in sigmas.
        mean_shift: f64,
        /// What curvature adds to the variance, relative to what the slopes make of it.
        variance: f64,
    },
    /// An external model answered the nominal point otherwise than before.
    History {
        /// What of the model: a characteristic, or something that formulas use.
        output: String,
        /// What it was at first; None where it had no value.
        expected: Option<f64>,
        /// What it was then.
        found: Option<f64>,
        /// Whether the difference is of the size of what the output varies by: another solution, not a drift.
        flip: bool,
        /// How often.
        times: usize,
        /// Points that were evaluated again for it.
        points: usize,
        /// The first few of them, in words.
        suspects: Vec<String>,
    },
    /// Near the nominal dimensions the assembly can move or jam.
    NearSingular {
        /// The unknown that is held least.
        unknown: String,
        /// The condition number of the scaled closure conditions.
        condition: f64,
    },
    /// No distribution has the moments.
    InfeasibleMoments {
        /// The characteristic.
        characteristic: String,
        /// Why not, with the law at the bound.
        reason: String,
    },
    /// Hardly any distribution has the moments.
    NearInfeasibleMoments {
        /// The characteristic.
        characteristic: String,
        /// Third standardised moment.
        skewness: f64,
        /// Fourth standardised moment.
        kurtosis: f64,
    },
    /// Cells of a measured column have no value.
    MissingValues {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// How many have none.
        missing: usize,
        /// Of how many.
        rows: usize,
        /// The first lines without one.
        lines: Vec<u64>,
    },
    /// Measured values that lie too far from the others.
    Outliers {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// How many do.
        count: usize,
        /// Of how many.
        values: usize,
        /// The farthest of them with their lines.
        first: Vec<(f64, u64)>,
    },
    /// A sample that says little of the higher moments.
    SmallSample {
        /// The dimension.
        dimension: String,
        /// How many values it has.
        values: usize,
        /// How many it should have.
        enough: usize,
    },
    /// What the size of a sample leaves uncertain is not computed where dimensions are correlated.
    NoSamplingInterval {
        /// The dimension.
        dimension: String,
    },
    /// Measured values that are rounded too coarsely.
    CoarseResolution {
        /// The dimension.
        dimension: String,
        /// The least difference of two values.
        resolution: f64,
        /// Their sigma.
        sigma: f64,
        /// How many different values there are.
        distinct: usize,
    },
    /// Measured values outside the tolerance band.
    OutsideBand {
        /// The dimension.
        dimension: String,
        /// How many.
        count: usize,
        /// Of how many.
        values: usize,
        /// The first of them with their lines.
        first: Vec<(f64, u64)>,
        /// Whether their mean lies outside too.
        mean_too: bool,
    },
    /// The extremes of a characteristic are those that a search found, and no proof.
    NotProven {
        /// The characteristic.
        characteristic: String,
        /// Evaluations of the search.
        evaluations: usize,
        /// How it ended.
        ended: Ended,
        /// Points in the box at which the characteristic has no value.
        failed: usize,
        /// Why it has none at the first of them.
        failure: Option<String>,
        /// An interval that no assembly leaves, and the boxes of interval arithmetic that it took; for formulas.
        bounds: Option<([f64; 2], usize)>,
    },
    /// `auto` was asked for.
    AutoIsSecondOrder,
}

fn lie(count: usize) -> &'static str {
    if count == 1 { "lies" } else { "lie" }
}

/// Values with their lines, and whether there are more of them.
fn values_and_lines(first: &[(f64, u64)], count: usize) -> String {
    let named: Vec<String> = first.iter().map(|(value, line)| format!("{value} (line {line})")).collect();
    format!("{}{}", named.join(", "), if count > first.len() { ", ..." } else { "" })
}

/// How a search for extremes ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// No move along a coordinate improves either extreme.
    Converged,
    /// The budget was spent.
    Budget,
    /// The run was stopped.
    Stopped,
}

/// What of a derivative is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loss {
    /// Every derivative: there is no value at the means, from which differences are taken.
    Centre,
    /// Slope and curvature: without them the characteristic has no moments.
    Slope,
    /// The curvature; the slope is one-sided.
    Curvature,
    /// The mixed derivative.
    Mixed,
    /// One side of the mixed derivative.
    OneSidedMixed,
}

impl Warning {
    /// The code that reports use.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnusedDimension { .. } => "unused-dimension",
            Self::UnusedName { .. } => "unused-name",
            Self::FailedPoints { .. } | Self::FailedSamples { .. } => "failed-points",
            Self::LostDerivative { .. } => "lost-derivative",
            Self::DomainEdge { .. } => "domain-edge",
            Self::SupportEdge { .. } => "support-edge",
            Self::LongTail { .. } => "long-tail",
            Self::NoReaction { .. } => "no-reaction",
            Self::Atom { .. } => "atom",
            Self::Noise { .. } => "noise",
            Self::PairsNotExamined { .. } => "pairs-not-examined",
            Self::RssInvalid { .. } => "rss-invalid",
            Self::History { flip: true, .. } => "branch-flip",
            Self::History { flip: false, .. } => "history",
            Self::NearSingular { .. } => "near-singular",
            Self::InfeasibleMoments { .. } => "infeasible-moments",
            Self::NearInfeasibleMoments { .. } => "near-infeasible-moments",
            Self::MissingValues { .. } => "missing-values",
            Self::Outliers { .. } => "outliers",
            Self::SmallSample { .. } => "small-sample",
            Self::NoSamplingInterval { .. } => "no-sampling-interval",
            Self::CoarseResolution { .. } => "coarse-resolution",
            Self::OutsideBand { .. } => "outside-band",
            Self::NotProven { .. } => "not-proven",
            Self::FitReplaced { .. } => "fit-replaced",
            Self::NotConfirmed => "not-confirmed",
            Self::ConfirmationMisses { .. } => "confirmation-misses",
            Self::AutoIsSecondOrder => "auto-is-second-order",
        }
    }

    /// The characteristic that it concerns, where it concerns one.
    pub fn characteristic(&self) -> Option<&str> {
        match self {
            Self::FailedPoints { characteristic, .. }
            | Self::FailedSamples { characteristic, .. }
            | Self::LostDerivative { characteristic, .. }
            | Self::DomainEdge { characteristic, .. }
            | Self::LongTail { characteristic, .. }
            | Self::NoReaction { characteristic }
            | Self::Atom { characteristic, .. }
            | Self::Noise { characteristic, .. }
            | Self::History { output: characteristic, .. }
            | Self::InfeasibleMoments { characteristic, .. }
            | Self::NearInfeasibleMoments { characteristic, .. }
            | Self::NotProven { characteristic, .. }
            | Self::ConfirmationMisses { characteristic, .. }
            | Self::RssInvalid { characteristic, .. } => Some(characteristic),
            _ => None,
        }
    }

    /// The dimension that it concerns, where it concerns one.
    pub fn dimension(&self) -> Option<&str> {
        match self {
            Self::UnusedDimension { dimension }
            | Self::DomainEdge { dimension, .. }
            | Self::LongTail { dimension, .. }
            | Self::MissingValues { dimension, .. }
            | Self::Outliers { dimension, .. }
            | Self::SmallSample { dimension, .. }
            | Self::NoSamplingInterval { dimension }
            | Self::CoarseResolution { dimension, .. }
            | Self::OutsideBand { dimension, .. }
            | Self::FitReplaced { dimension }
            | Self::SupportEdge { dimension, .. } => Some(dimension),
            Self::LostDerivative { dimensions, .. } => dimensions.first().map(String::as_str),
            _ => None,
        }
    }

    /// Cause, consequence, and what to try.
    pub fn message(&self) -> String {
        match self {
            Self::UnusedDimension { dimension } => {
                format!("no asked characteristic depends on dimension `{dimension}`: it has no part in the result")
            }
            Self::UnusedName { what, name } => format!("no characteristic uses the {what} `{name}`"),
            Self::FailedPoints { characteristic, failed, points, point, error } => {
                format!("`{characteristic}` has no value at {failed} of {points} points; first at {point}: {error}")
            }
            Self::FailedSamples { characteristic, failed, samples, error } => format!(
                "`{characteristic}` has no value at {failed} of {samples} points, and everything said of it is about the \
                 others; the first: {error}"
            ),
            Self::LostDerivative { characteristic, dimensions, loss } => {
                let to = dimensions.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and ");
                match loss {
                    Loss::Centre => format!(
                        "`{characteristic}` has no value at the means, from which every difference is taken: it has no \
                         derivatives and no moments; check the nominal dimensions"
                    ),
                    Loss::Slope => format!(
                        "`{characteristic}` could not be differentiated by {to}: it has no moments; \
                         keep the model defined around the mean, or give the dimension a smaller step"
                    ),
                    Loss::Curvature => format!(
                        "`{characteristic}` could be differentiated by {to} on one side only: its curvature there is \
                         unknown and left out of the moments; a smaller --step may help"
                    ),
                    Loss::Mixed => format!(
                        "the interaction of {to} in `{characteristic}` could not be evaluated and is left out of the \
                         moments; a smaller --step may help"
                    ),
                    Loss::OneSidedMixed => format!(
                        "the interaction of {to} in `{characteristic}` could be evaluated at some of its corners only: \
                         it is less exact"
                    ),
                }
            }
            Self::DomainEdge { characteristic, dimension, failed, used } => format!(
                "`{characteristic}` has no value with `{dimension}` at {failed:+.3} sigma: {used:+.3} sigma was used, and \
                 part of the assemblies may have no value at all"
            ),
            Self::SupportEdge { dimension, from, to } => format!(
                "the node of `{dimension}` at {from:+.3} sigma lies outside its distribution and was moved to \
                 {to:+.3}, its partner with it: its fourth moment is matched less exactly"
            ),
            Self::LongTail { characteristic, dimension, farthest, reach, share } => format!(
                "`{characteristic}` is curved along `{dimension}` ({:.1} % of its variance), whose tail counts up to \
                 {reach:.0} sigma, while the model was evaluated up to {farthest:.1}: skewness, kurtosis and yield rest on what \
                 it does beyond; compare --method second-order with six-n",
                100.0 * share
            ),
            Self::NoReaction { characteristic } => format!(
                "`{characteristic}` is the same at every point that was evaluated: check that the model uses the dimensions, and examine interactions \
                 (--method full)"
            ),
            Self::Atom { characteristic, points } => format!(
                "`{characteristic}` is exactly 0 at {points} points: a distance that ends at contact hides interference; \
                 let the model offer a signed measure"
            ),
            Self::Noise { characteristic, rounding } => format!(
                "one rounding error of `{characteristic}` is {rounding:.1e} of its sigma: differences lose that much; \
                 measure it from a nearer datum"
            ),
            Self::PairsNotExamined { examined, possible } => format!(
                "{examined} of {possible} interactions were examined: what the others add to sigma is unknown; \
                 --method full examines all"
            ),
            Self::RssInvalid { characteristic, mean_shift, variance } => format!(
                "`{characteristic}` is curved: second order moves its mean by {mean_shift:+.2} sigma and adds {:.1} % to \
                 its variance; use --method second-order",
                100.0 * variance
            ),
            Self::History { output, expected, found, flip, times, points, suspects } => {
                let value = |value: &Option<f64>| value.map_or("no value".to_owned(), |value| value.to_string());
                let cause = match flip {
                    true => "the model seems to have settled in another solution: reset it before every point",
                    false => "its answers depend on what it was asked before: reset it before every point",
                };
                let times = if *times == 1 { "once".to_owned() } else { format!("{times} times") };
                format!(
                    "`{output}` at the nominal dimensions was {} at first and {} later ({times}): {cause}; {points} points were \
                     evaluated again by a fresh process{}",
                    value(expected),
                    value(found),
                    if suspects.is_empty() { String::new() } else { format!(", among them {}", suspects.join("; ")) }
                )
            }
            Self::NearSingular { unknown, condition } => format!(
                "the nominal position is nearly singular: the conditions hardly hold `{unknown}` (condition number \
                 {condition:.1e}); small deviations move it far, and some assemblies may not close at all"
            ),
            Self::InfeasibleMoments { characteristic, reason } => format!(
                "`{characteristic}` has no yield: {reason}. Either it has two values indeed, or a strong interaction was \
                 not examined (try --method full), or the `moments` of a dimension are rounded"
            ),
            Self::NearInfeasibleMoments { characteristic, skewness, kurtosis } => format!(
                "the kurtosis {kurtosis:.4} of `{characteristic}` is hardly above 1 + skewness^2 = {:.4}, the least that there \
                 is: it has nearly two values only, and its yield hangs on every digit of that",
                1.0 + skewness * skewness
            ),
            Self::MissingValues { dimension, file, missing, rows, lines } => {
                let named = lines.iter().map(u64::to_string).collect::<Vec<_>>().join(", ");
                let more = if missing > &lines.len() { ", ..." } else { "" };
                format!(
                    "{missing} of {rows} values of `{dimension}` {} missing in {file} (lines {named}{more}): the others \
                     stand for all",
                    if *missing == 1 { "is" } else { "are" }
                )
            }
            Self::Outliers { dimension, file, count, values, first } => format!(
                "{count} of {values} values of `{dimension}` in {file} {} farther out than a normal sample of this size \
                 reaches: {}; kept all the same, as a skewed law may have such values: take out what was measured wrongly",
                lie(*count),
                values_and_lines(first, *count)
            ),
            Self::SmallSample { dimension, values, enough } => format!(
                "`{dimension}` is known by {values} values: its skewness and everything beyond are guesses below {enough}; \
                 mind the sampling interval"
            ),
            Self::NoSamplingInterval { dimension } => format!(
                "`{dimension}` is known by a sample, and what its size leaves uncertain is not computed where dimensions are \
                 correlated; leave [[correlation]] out to see it"
            ),
            Self::CoarseResolution { dimension, resolution, sigma, distinct } => format!(
                "the {distinct} different values of `{dimension}` lie {:.2} sigma apart or more: rounding has a part in sigma; \
                 measure with a finer resolution",
                resolution / sigma
            ),
            Self::OutsideBand { dimension, count, values, first, mean_too } => format!(
                "{count} of {values} measured values of `{dimension}` {} outside its tolerance: {}{}",
                lie(*count),
                values_and_lines(first, *count),
                if *mean_too { "; so does their mean: check column and unit" } else { "" }
            ),
            Self::NotProven { characteristic, evaluations, ended, failed, failure, bounds } => {
                let doubt = match bounds {
                    Some(([lower, upper], boxes)) => format!(
                        "interval arithmetic on {boxes} boxes shows only that no assembly lies outside {lower} .. {upper}"
                    ),
                    None => "an assembly beyond them cannot be ruled out, as it can for formulas".to_owned(),
                };
                let cut = match ended {
                    Ended::Converged => "",
                    Ended::Budget => "; the budget ended the search: allow more evaluations with --budget",
                    Ended::Stopped => "; the search was stopped before its end",
                };
                let lost = match failure {
                    Some(reason) => format!("; {failed} of its points have no value and were left out: {reason}"),
                    None => String::new(),
                };
                format!(
                    "the extremes of `{characteristic}` are the best of {evaluations} evaluations and not proven: {doubt}\
                     {cut}{lost}"
                )
            }
            Self::FitReplaced { dimension } => format!(
                "`{dimension}` was a fit of ISO 286 and is a plain tolerance now: choose the class that is nearest, and require it \
                 as a process, if it has to be one"
            ),
            Self::ConfirmationMisses { characteristic, required, interval: [low, high] } => format!(
                "`{characteristic}` keeps its limits in {:.4} .. {:.4} % of the model's own sample, and {:.4} % are required: four moments \
                 do not say enough of its tails; require more, or a Cpk",
                100.0 * low,
                100.0 * high,
                100.0 * required
            ),
            Self::NotConfirmed => {
                "the tolerances rest on derivatives at others: the budget or the time did not allow to ask the model there; \
                 allow more, or analyze the study that --write writes"
                    .into()
            }
            Self::AutoIsSecondOrder => {
                "method auto is not built yet and stands for second-order; --method full adds every interaction".into()
            }
        }
    }
}
