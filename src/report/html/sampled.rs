//! The page of a simulation.

use serde::Serialize;

use super::super::number::{UNKNOWN, plain, share, significant};
use super::super::{SimulatedReport, SimulationReport};
use super::analysis::{Verdict, limits};
use super::chart::{Bins, Spread};
use super::warned::Warned;
use super::{fact, provenance, render};
use crate::capability::Law;
use crate::moments::Moments;
use crate::pearson::Pearson;

#[derive(Serialize)]
struct Simulated<'r> {
    verdicts: Vec<Verdict<'r>>,
    characteristics: Vec<One<'r>>,
}

#[derive(Serialize)]
struct One<'r> {
    verdict: Verdict<'r>,
    interval: Option<String>,
    failed: Option<String>,
    estimates: Vec<[String; 3]>,
    limits: Vec<[String; 2]>,
    spread: Option<Spread>,
    words: String,
    control: Option<String>,
    warnings: Vec<Warned<'r>>,
}

/// A simulation as one page of HTML: every estimate with its standard error, the histogram with the error of every bar.
pub fn simulate_html(report: &SimulationReport) -> String {
    let simulated = Simulated {
        verdicts: report.characteristics.iter().map(verdict).collect(),
        characteristics: report.characteristics.iter().map(|one| characteristic(report, one)).collect(),
    };
    let mut facts = vec![
        fact("method", format!("{}, {} points", report.method, report.sampler)),
        fact("points", report.samples.to_string()),
        fact("evaluations", format!("{}, {} of them failed", report.run.evaluations, report.run.failed)),
    ];
    facts.extend(report.surrogate_evaluations.map(|count| fact("evaluations of the surrogate", count.to_string())));
    if let Some(reached) = report.reached {
        facts.push(fact("wanted standard errors", if reached { "reached" } else { "not reached" }));
    }
    facts.extend(provenance(&report.head, &report.run));
    let warnings = report.warnings.iter().filter(|warning| warning.characteristic.is_none()).collect();
    render("simulation.html", &report.head, facts, warnings, None, simulated)
}

/// As many digits as the standard error leaves: two of its own.
fn digits(value: Option<f64>, error: Option<f64>) -> String {
    match (value, error) {
        (None, _) => UNKNOWN.to_owned(),
        (Some(value), Some(error)) if error > 0.0 && error.is_finite() => {
            let decimals = (1.0 - error.log10().floor()).clamp(0.0, 15.0) as usize;
            format!("{value:.decimals$}")
        }
        (Some(value), _) => significant(value, 6),
    }
}

fn uncertain(error: Option<f64>) -> String {
    error.map_or(UNKNOWN.to_owned(), |error| significant(error, 2))
}

fn verdict(one: &SimulatedReport) -> Verdict<'_> {
    let errors = &one.standard_error;
    Verdict {
        name: &one.name,
        unit: one.unit.as_deref().unwrap_or_default(),
        mean: digits(one.mean, errors.mean),
        reach: digits(one.sigma.map(|sigma| 3.0 * sigma), errors.sigma.map(|error| 3.0 * error)),
        limits: limits(one.lower, one.upper),
        yield_: one.yield_.map(|yield_| share(1.0 - yield_)).unwrap_or_default(),
        cpk: one.cpk.map(|cpk| format!("{cpk:.3}")).unwrap_or_default(),
        target: one.target_yield.map(|target| share(1.0 - target)).unwrap_or_default(),
        met: one.verdict.map_or("none", crate::verdict::Verdict::name),
    }
}

/// The law of the sample's own moments.
fn fitted(one: &SimulatedReport) -> Option<Pearson> {
    let moments = Moments::new(one.mean?, one.sigma?, one.skewness?, one.kurtosis? - 3.0);
    match Law::fit(&moments).ok()? {
        Law::Pearson(law) => Some(*law),
        Law::Point { .. } => None,
    }
}

fn characteristic<'r>(report: &'r SimulationReport, one: &'r SimulatedReport) -> One<'r> {
    let errors = &one.standard_error;
    let row = |name: &str, value, error| [name.to_owned(), digits(value, error), uncertain(error)];
    let mut estimates = vec![
        row("mean", one.mean, errors.mean),
        row("sigma", one.sigma, errors.sigma),
        row("skewness", one.skewness, errors.skewness),
        row("kurtosis", one.kurtosis, errors.kurtosis),
    ];
    let quantiles = one.distribution.quantiles.0.iter().zip(&errors.quantiles.0);
    estimates.extend(quantiles.map(|((p, value), (_, error))| row(&format!("quantile {p}"), *value, *error)));
    let ppm = |value: Option<f64>| value.map(|value| format!("{} ppm", significant(value, 4)));
    let index = |value: Option<f64>| value.map(|value| format!("{value:.3}"));
    let rows = [
        ("below the lower limit", ppm(one.ppm_below)),
        ("above the upper limit", ppm(one.ppm_above)),
        ("Cp", index(one.cp)),
        ("Cpk", index(one.cpk)),
        ("least value seen", one.range.map(|[least, _]| plain(least))),
        ("greatest value seen", one.range.map(|[_, greatest]| plain(greatest))),
    ];
    let places: Vec<_> = one.mean.map(|mean| (mean, "mean", "mean")).into_iter().collect();
    let bins = one.histogram.as_ref().map(|of| Bins { edges: &of.edges, counts: &of.counts });
    // Four moments of a few points are no law.
    let law = bins.filter(|bins| bins.counts.len() > 1).and_then(|_| fitted(one));
    One {
        verdict: verdict(one),
        interval: errors.yield_.map(|[low, high]| format!("{} to {}", share(1.0 - low), share(1.0 - high))),
        failed: (one.failed > 0).then(|| match one.yield_bounds {
            Some([low, high]) => format!(
                "{} points have no value: the yield is {} if all of these are rejected, {} if none is",
                one.failed,
                share(1.0 - low),
                share(1.0 - high)
            ),
            None => format!("{} points have no value", one.failed),
        }),
        estimates,
        limits: rows.into_iter().filter_map(|(name, text)| Some([name.to_owned(), text?])).collect(),
        spread: Spread::of(law.as_ref(), bins, [one.lower, one.upper], &places),
        words: match &law {
            Some(law) => format!(
                "The sample; each bar with one standard error. The line: the Pearson law of its four moments ({}).", law.kind().name()),
            None => "The sample; each bar with one standard error.".to_owned(),
        },
        control: one.control.as_ref().map(|control| {
            let times = |value: Option<f64>| value.map_or("an unknown factor".to_owned(), |value| significant(value, 3));
            format!(
                "the surrogate of {} ({} evaluations) as control variate: the standard error of the mean shrank by {}, that of \
                 sigma by {}",
                control.method,
                control.evaluations,
                times(control.reduction.mean),
                times(control.reduction.sigma)
            )
        }),
        warnings: Warned::about(&report.warnings, &one.name),
    }
}
