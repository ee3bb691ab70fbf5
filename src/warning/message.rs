//! Warnings in words: cause, consequence, what to try.

use super::{Change, Ended, Figure, Loss, Warning};

impl Warning {
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
            Self::HeavyPoint { characteristic, limit, part } => format!(
                "`{characteristic}` beyond {limit}: one point bears {:.0} % of the probability, so that the surrogate does not \
                 know where rejects are, and there may be more than the interval says; more --samples, or a method that knows \
                 more (--method full)",
                100.0 * part
            ),
            Self::NothingBeyond { characteristic, limit, points, most } => format!(
                "`{characteristic}` beyond {limit}: not one of {points} points lies there, neither where the surrogate has the \
                 limit nor elsewhere; all that is known without the surrogate is a probability below {most:.1e}"
            ),
            Self::PlainSampling { characteristic, limit, plain, evaluations } => format!(
                "`{characteristic}` beyond {limit}: {plain:.0} points of a plain sample would have told as much as these \
                 {evaluations}; leave out --rare"
            ),
            Self::LostMoments { characteristic, because } => format!(
                "mean, sigma and all that follows from them are unknown of `{characteristic}`: {because}; a derivative \
                 method goes around lost points, --method second-order with the fewest"
            ),
            Self::ShallowRules { characteristic, share } => format!(
                "curvature adds {:.1} % of the variance of `{characteristic}`, and rules of three nodes do not integrate its third \
                 and fourth powers: do not trust skewness, kurtosis and yield; --method dimension-reduction or \
                 bivariate-dimension-reduction has five nodes",
                100.0 * share
            ),
            Self::PoorFit { characteristic, residual } => format!(
                "the fitted surface misses the values of `{characteristic}` by {:.1} % of sigma (residual standard error): it is \
                 no quadratic; --method six-n follows more bends, bivariate-dimension-reduction all of two dimensions",
                100.0 * residual
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
                    Loss::NotEvaluated { derivatives } => format!(
                        "the run was stopped before {derivatives} derivatives of `{characteristic}` were evaluated: its results \
                         leave them out, and no verdict follows; give it more time"
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
            Self::NoSamplingInterval { dimension, correlated: true } => format!(
                "`{dimension}` is known by a sample, and what its size leaves uncertain is not computed where dimensions are \
                 correlated; leave [[correlation]] out to see it"
            ),
            Self::NoSamplingInterval { dimension, correlated: false } => format!(
                "`{dimension}` is known by a sample, and what its size leaves uncertain is not computed by methods without a \
                 surrogate; --method six-n shows it"
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
            Self::Kink { characteristic, dimension, slopes: [left, right], between } => format!(
                "`{characteristic}` bends along `{dimension}` {}, from a slope of {left:.3} to {right:.3} sigma a sigma: no polynomial \
                 follows a kink, and moments of one are wrong; use sensitol simulate, or give each branch a characteristic of \
                 its own",
                places(*between)
            ),
            Self::Discontinuity { characteristic, dimension, by, between } => format!(
                "`{characteristic}` jumps along `{dimension}` {} by {by:.2} sigma: derivatives mean nothing there; check whether the \
                 model changes its configuration, and use sensitol simulate",
                places(*between)
            ),
            Self::HigherOrder { characteristic, dimension, coefficients: [third, fourth], held } => format!(
                "`{characteristic}` is more than a parabola along `{dimension}`: {third:+.2e} u^3 {fourth:+.2e} u^4 sigma; {}",
                match held {
                    true => "the moments have that part, and what comes beyond is in the error estimate",
                    false => "this method leaves it out: use --method six-n or auto",
                }
            ),
            Self::Scatter { characteristic, scatter, drowned } => format!(
                "answers of `{characteristic}` next to the means scatter by {scatter:.1e} of its sigma{}: no accuracy beyond that \
                 can be had; solve the model more tightly",
                match drowned {
                    0 => String::new(),
                    1 => ", as much as its curvature along one dimension".to_owned(),
                    many => format!(", as much as its curvature along {many} dimensions"),
                }
            ),
            Self::DomainEdgeWithin { characteristic, failed, points } => format!(
                "`{characteristic}` has no value at {failed} of {points} points of the distribution, though it has one wherever \
                 differences were taken: that part of the assemblies is in no moment and no yield; sensitol simulate counts them"
            ),
            Self::InteractionsLeftOut { characteristic, share } => format!(
                "{:.2} % of the variance of `{characteristic}` is none of what was examined, by comparison with the model: it is \
                 in sigma, and not in skewness and kurtosis; allow more evaluations, or use --method full",
                100.0 * share
            ),
            Self::UntrustedSurrogate { characteristic, share, sampled } => format!(
                "the surface through the evaluated points leaves {:.1} % of the variance of `{characteristic}` unexplained; {}",
                100.0 * share,
                match sampled {
                    Some(points) => format!(
                        "its moments come from {points} points of the model, with the surface as control variate, and carry their \
                         standard errors"
                    ),
                    None =>
                        "its moments are a guess: allow a sample with --budget, or use sensitol simulate".to_owned(),
                }
            ),
            Self::UnderResolved { characteristic, figure, error, wanted, budget } => {
                let name = figure.name();
                let shown = |value: f64| match figure {
                    Figure::Sigma => format!("{:.2} %", 100.0 * value),
                    Figure::Yield => format!("{:.2e} %", 100.0 * value),
                    Figure::Skewness | Figure::Kurtosis => format!("{value:.2e}"),
                };
                let known = match error {
                    Some(error) => format!("is known to {} by the estimate", shown(*error)),
                    None => "is not known to any figure".to_owned(),
                };
                format!(
                    "{name} of `{characteristic}` {known}, and {} was wanted; {}",
                    shown(*wanted),
                    match budget {
                        true => "the budget ended before: allow more evaluations",
                        false =>
                            "no further derivative would help: allow a sample with --budget, or use sensitol \
                         simulate",
                    }
                )
            }
            Self::TailsMissed { characteristic, law, surface, points } => format!(
                "the Pearson law with the four moments of `{characteristic}` rejects {:.0} ppm, and the surface that has these \
                 moments {:.0} ppm at {points} points: its tails are of another kind, and the yield is off by that; use \
                 sensitol simulate, or --rare with it",
                1e6 * law,
                1e6 * surface
            ),
            Self::Switch { characteristic, switch, change, probability } => format!(
                "`{characteristic}` {} at {switch}, with {} of the assemblies beyond; {}",
                match change {
                    Change::Kink => "bends",
                    Change::Jump => "jumps",
                    Change::Edge => "has no value beyond a limit",
                    Change::Pole => "grows without bound",
                },
                part(*probability),
                match change {
                    Change::Kink | Change::Jump =>
                        "no polynomial follows that: use the figures of the verification, or sensitol simulate",
                    Change::Edge => "every figure is of the assemblies that have a value",
                    Change::Pole =>
                        "it has no moments, and those printed are of the assemblies within eight sigma: choose another \
                         characteristic, or a distribution that ends before",
                }
            ),
            Self::UnverifiedSurface { characteristic, share, sampled } => format!(
                "the surface through the evaluated points leaves {} of the variance of `{characteristic}` unexplained, by {}; {}",
                share.map_or("an unknown part".to_owned(), |share| format!("{:.1} %", 100.0 * share)),
                match sampled {
                    Some(points) => format!("{points} points of the model"),
                    None => "the check points".to_owned(),
                },
                match sampled {
                    Some(_) => "use the figures of the verification, or --method auto, which takes them",
                    None => "its figures are a guess: use --method auto, or sensitol simulate",
                }
            ),
            Self::FigureOff { characteristic, figure, value, model, error } => {
                let [value, model, error] = [(value, 5), (model, 5), (error, 2)].map(|(of, digits)| significant(*of, digits));
                format!(
                    "{figure} of `{characteristic}` is {value} by the method, and {model} by the model itself, with an error of \
                     {error}; use --method auto, which takes that of the model"
                )
            }
            Self::SeveralModes { characteristic, coefficient } => format!(
                "skewness and kurtosis of `{characteristic}` are those of a distribution with two peaks ((skewness^2 + 1)/kurtosis = \
                 {coefficient:.2}): the Pearson law has one or a trough; look at the histogram of sensitol simulate"
            ),
        }
    }
}

fn lie(count: usize) -> &'static str {
    if count == 1 { "lies" } else { "lie" }
}

/// Values with their lines, and whether there are more of them.
fn values_and_lines(first: &[(f64, u64)], count: usize) -> String {
    let named: Vec<String> = first.iter().map(|(value, line)| format!("{value} (line {line})")).collect();
    format!("{}{}", named.join(", "), if count > first.len() { ", ..." } else { "" })
}

/// A share as percent, or as parts per million where it is small.
fn part(share: f64) -> String {
    if share < 1e-3 {
        format!("{} ppm", significant(1e6 * share, 2))
    } else {
        format!("{} %", significant(100.0 * share, 2))
    }
}

/// So many digits that count.
fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    match digits - 1 - exponent {
        places @ 0..=9 => format!("{value:.*}", places as usize),
        places if places < 0 && exponent < 9 => format!("{value:.0}"),
        _ => format!("{value:.*e}", (digits - 1) as usize),
    }
}

fn places([from, to]: [f64; 2]) -> String {
    format!("between {from:+.2} and {to:+.2} sigma")
}
