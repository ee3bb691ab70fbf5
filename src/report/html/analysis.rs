//! The page of an analysis.

use serde::Serialize;

use super::super::number::{UNKNOWN, beside, percent, plain, plural, share, significant, unsigned_zero};
use super::super::text::{band, derivative, rounded};
use super::super::{CharacteristicReport, Report, Stack, StackNote, WarningReport};
use super::chart::{Bins, Scale, Span, Spread, quantiles};
use super::warned::Warned;
use super::what_if::WhatIf;
use super::{Fact, fact, json, provenance, render};
use crate::capability::Law;
use crate::method::ALL;
use crate::summary::RunSummary;

/// Bars of a Pareto diagram, and interactions in a table.
const BARS: usize = 24;
const INTERACTIONS: usize = 24;
/// A share below this is no news.
const NEWS: f64 = 5e-5;

#[derive(Serialize)]
struct Analysed<'r> {
    verdicts: Vec<Verdict<'r>>,
    characteristics: Vec<One<'r>>,
    what_if: Option<Tries<'r>>,
    /// Why there is nothing to try.
    no_what_if: Option<String>,
}

/// A characteristic in one line.
#[derive(Serialize)]
pub(super) struct Verdict<'r> {
    pub(super) name: &'r str,
    pub(super) unit: &'r str,
    pub(super) mean: String,
    pub(super) reach: String,
    pub(super) limits: String,
    pub(super) yield_: String,
    pub(super) cpk: String,
    pub(super) target: String,
    pub(super) met: &'static str,
}

#[derive(Serialize)]
struct One<'r> {
    verdict: Verdict<'r>,
    figures: Vec<[String; 2]>,
    limits: Vec<[String; 2]>,
    spread: Option<Spread>,
    quantiles: Vec<[String; 2]>,
    family: String,
    spans: Vec<Span>,
    span_limits: Vec<f64>,
    pareto: Vec<Share>,
    rest: Option<String>,
    sensitivities: Vec<[String; 10]>,
    interactions: Vec<[String; 4]>,
    more_interactions: Option<String>,
    notes: Vec<String>,
    stack: Option<Stacked>,
    error: Vec<[String; 2]>,
    basis: Option<String>,
    warnings: Vec<Warned<'r>>,
}

/// A contribution.
#[derive(Serialize)]
struct Share {
    name: String,
    linear: f64,
    curvature: f64,
    interaction: f64,
    percent: String,
}

/// The stack-up table of a linear characteristic.
#[derive(Serialize)]
struct Stacked {
    rows: Vec<[String; 6]>,
    totals: Vec<[String; 6]>,
    notes: Vec<String>,
}

/// What can be changed.
#[derive(Serialize)]
struct Tries<'r> {
    dimensions: Vec<Try<'r>>,
    characteristics: Vec<(&'r str, &'r str, Option<&'r str>)>,
    written: bool,
    cost: Option<String>,
}

#[derive(Serialize)]
struct Try<'r> {
    name: &'r str,
    unit: &'r str,
    nominal: String,
    half: f64,
    band: bool,
    fixed: Option<&'static str>,
}

/// An analysis as one page of HTML. With a [`WhatIf`] the page computes the results of other tolerances and means by itself, as
/// [`Surface::at`](crate::analysis::Surface::at) does.
///
/// The page needs no network and loads nothing. No evaluation.
pub fn analyze_html(report: &Report, what_if: Option<&WhatIf>) -> String {
    let stacks = report.stacks();
    let characteristics: Vec<One<'_>> =
        report.characteristics.iter().zip(&stacks).map(|(one, stack)| characteristic(report, one, stack)).collect();
    let possible = what_if.filter(|what_if| what_if.possible());
    let analysed = Analysed {
        verdicts: report.characteristics.iter().map(verdict).collect(),
        characteristics,
        what_if: possible.map(tries),
        no_what_if: what_if.and_then(WhatIf::impossible),
    };
    let named = |warning: &&WarningReport| match &warning.characteristic {
        Some(name) => !report.characteristics.iter().any(|one| one.name == *name),
        None => true,
    };
    let warnings = report.warnings.iter().filter(named).collect();
    render("analysis.html", &report.head, facts(report), warnings, possible.map(json), analysed)
}

/// How many there were, and how often the next ones waited for the last.
fn evaluations(run: &RunSummary) -> String {
    let rounds = plural(run.stages as usize, "round", "rounds");
    format!("{} in {rounds}, {} of them failed", run.evaluations, run.failed)
}

fn facts(report: &Report) -> Vec<Fact> {
    let procedure = ALL.iter().find(|procedure| procedure.name() == report.method);
    let method = match procedure {
        Some(procedure) => format!("{}: {}; evaluations: {}", report.method, procedure.about(), procedure.count()),
        None => report.method.to_owned(),
    };
    let mut facts = vec![fact("method", method)];
    facts.extend(report.account.as_ref().map(|account| fact("what its points went to", account.to_string())));
    facts.push(fact("varying dimensions", report.varying.to_string()));
    facts.push(fact("evaluations", evaluations(&report.run)));
    let derivatives = match report.derivatives {
        Some("exact") => "exact",
        Some(_) => "differences",
        None => "none: the moments rest on values or on a fitted surface",
    };
    facts.push(fact("derivatives", derivatives));
    let pairs = report.correlation.iter();
    let pairs: Vec<String> =
        pairs.map(|pair| format!("{} and {}: {}", pair.between[0], pair.between[1], plain(pair.value))).collect();
    if !pairs.is_empty() {
        facts.push(fact("correlations", pairs.join("; ")));
    }
    facts.extend(provenance(&report.head, &report.run));
    facts
}

/// Limits in words.
pub(super) fn limits(lower: Option<f64>, upper: Option<f64>) -> String {
    match (lower, upper) {
        (None, None) => String::new(),
        (Some(lower), None) => format!("above {}", plain(lower)),
        (None, Some(upper)) => format!("below {}", plain(upper)),
        (Some(lower), Some(upper)) => format!("{} .. {}", plain(lower), plain(upper)),
    }
}

/// A yield by what is rejected on the two sides.
fn yielded(one: &CharacteristicReport) -> String {
    match (one.ppm_below, one.ppm_above) {
        (None, None) => String::new(),
        (below, above) => share(1e-6 * (below.unwrap_or(0.0) + above.unwrap_or(0.0))),
    }
}

fn verdict(one: &CharacteristicReport) -> Verdict<'_> {
    let limited = one.lower.is_some() || one.upper.is_some();
    let (mean, reach) = match (one.mean, one.sigma) {
        (Some(mean), Some(sigma)) => (beside(mean, sigma), beside(3.0 * sigma, sigma)),
        _ => ("unknown".to_owned(), UNKNOWN.to_owned()),
    };
    Verdict {
        name: &one.name,
        unit: one.unit.as_deref().unwrap_or_default(),
        mean,
        reach,
        limits: limits(one.lower, one.upper),
        yield_: if limited && one.yield_.is_none() { "unknown".to_owned() } else { yielded(one) },
        cpk: one.cpk.map(|cpk| format!("{cpk:.3}")).unwrap_or_default(),
        target: one.target_yield.map(|target| share(1.0 - target)).unwrap_or_default(),
        met: one.verdict.map_or("none", crate::verdict::Verdict::name),
    }
}

fn characteristic<'r>(report: &'r Report, one: &'r CharacteristicReport, stack: &Stack) -> One<'r> {
    let law = match &one.law {
        Some(Law::Pearson(law)) => Some(&**law),
        _ => None,
    };
    let mut places = law.map_or(Vec::new(), quantiles);
    places.extend(one.mean.map(|mean| (mean, "mean", "mean")));
    let histogram = one.model_sampling.as_ref().and_then(|sampling| sampling.histogram.as_ref());
    let bins = histogram.map(|of| Bins { edges: &of.edges, counts: &of.counts });
    let (pareto, rest) = pareto(one);
    let seen = |one: &&super::super::InteractionReport| one.share.is_none_or(|share| share > NEWS);
    let interactions: Vec<_> = one.interactions.iter().filter(seen).collect();
    let more = one.interactions.len() - interactions.len().min(INTERACTIONS);
    let (spans, span_limits) = spans(one);
    One {
        verdict: verdict(one),
        figures: figures(one),
        limits: kept(one),
        spread: Spread::of(law, bins, [one.lower, one.upper], &places),
        quantiles: one.quantiles().map_or(Vec::new(), |quantiles| {
            let sigma = one.sigma.unwrap_or(0.0);
            quantiles.0.iter().map(|&(p, value)| [p.to_owned(), beside(value, sigma)]).collect()
        }),
        family: match (&one.distribution, one.sigma) {
            (Some(super::super::DistributionReport::Pearson { kind: "normal", .. }), _) => "normal".to_owned(),
            (Some(super::super::DistributionReport::Pearson { kind, .. }), _) => {
                let bars = if bins.is_some() { " over the sample of the model; each bar with one standard error" } else { "" };
                format!("Pearson type {kind}{bars}")
            }
            (Some(super::super::DistributionReport::Point { at }), _) => {
                format!("every assembly has the same value: {}", plain(*at))
            }
            (None, Some(_)) => "no distribution has this skewness and kurtosis: the yield is unknown".to_owned(),
            (None, None) => String::new(),
        },
        spans,
        span_limits,
        pareto,
        rest,
        sensitivities: sensitivities(report, one),
        interactions: interactions.iter().take(INTERACTIONS).map(|pair| interaction(pair)).collect(),
        more_interactions: (more > 0).then(|| {
            let (examined, possible) = (one.interactions.len(), one.possible_interactions);
            format!("Interactions examined: {examined} of {possible}; those that are not shown are weaker, and in the JSON report")
        }),
        notes: notes(one),
        stack: stacked(stack),
        error: errors(one),
        basis: one.error_estimate.as_ref().map(|estimate| estimate.basis()),
        warnings: Warned::about(&report.warnings, &one.name),
    }
}

fn shape(value: Option<f64>) -> String {
    value.map_or(UNKNOWN.to_owned(), |value| unsigned_zero(format!("{value:.4}")))
}

fn row(name: &str, text: String) -> [String; 2] {
    [name.to_owned(), text]
}

fn figures(one: &CharacteristicReport) -> Vec<[String; 2]> {
    let scale = one.sigma.filter(|&sigma| sigma > 0.0).or(one.rss).unwrap_or(0.0);
    let number = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| beside(value, scale));
    let mut figures = vec![
        row("nominal", number(one.nominal)),
        row("mean", number(one.mean)),
        row("sigma", number(one.sigma)),
        row("skewness", shape(one.skewness)),
        row("kurtosis", shape(one.kurtosis)),
    ];
    if let Some(shift) = one.mean.zip(one.nominal).map(|(mean, nominal)| mean - nominal) {
        figures.push(row("mean off the nominal", beside(shift, scale)));
    }
    figures
}

fn kept(one: &CharacteristicReport) -> Vec<[String; 2]> {
    let ppm = |value: f64| format!("{} ppm", significant(value, 4));
    let index = |value: f64| format!("{value:.3}");
    let rows = [
        ("below the lower limit", one.ppm_below.map(ppm)),
        ("above the upper limit", one.ppm_above.map(ppm)),
        ("Cp", one.cp.map(index)),
        ("Cpk", one.cpk.map(index)),
        ("Cp by percentiles", one.cp_percentile.map(index)),
        ("Cpk by percentiles", one.cpk_percentile.map(index)),
        ("sigma level", one.sigma_level.map(index)),
        ("yield if it were normal", one.normal_fit.as_ref().and_then(|normal| normal.yield_).map(|y| share(1.0 - y))),
    ];
    rows.into_iter().filter_map(|(name, text)| Some(row(name, text?))).collect()
}

/// What else is known of how far the results may be off, where they come from samples or a fit.
fn notes(one: &CharacteristicReport) -> Vec<String> {
    let error = |error: Option<f64>| error.map_or(UNKNOWN.to_owned(), |error| significant(error, 2));
    let scale = one.sigma.unwrap_or(0.0);
    let mut notes = Vec::new();
    if let Some(of) = &one.surrogate_sampling {
        let [sigma, skewness, kurtosis] = [of.sigma, of.skewness, of.kurtosis].map(|of| error(Some(of)));
        notes.push(format!(
            "Sampled from the surrogate at {} points; standard errors: sigma {sigma}, skewness {skewness}, kurtosis {kurtosis}",
            of.samples
        ));
    }
    if let Some(of) = &one.model_sampling {
        let [mean, sigma, skewness, kurtosis] = [of.mean, of.sigma, of.skewness, of.kurtosis].map(error);
        notes.push(format!(
            "From {} points of the model, as the surrogate was not trusted; standard errors: mean {mean}, sigma {sigma}, \
             skewness {skewness}, kurtosis {kurtosis}",
            of.samples
        ));
        if let Some([low, high]) = of.yield_interval {
            notes.push(format!("95 % interval of the sample's yield: {} to {}", share(1.0 - low), share(1.0 - high)));
        }
    }
    if let Some(of) = &one.least_squares {
        notes.push(format!(
            "A surface of {} coefficients fitted to {} points; residual standard error {}",
            of.coefficients,
            of.points,
            error(of.residual_standard_error)
        ));
    }
    if let Some(of) = &one.sampling_interval {
        let between = |name: &str, interval: Option<[f64; 2]>| {
            interval.map(|[low, high]| format!("{name} {} to {}", beside(low, scale), beside(high, scale)))
        };
        let yields = of.rejected.map(|[low, high]| format!("yield {} to {}", share(high), share(low)));
        let cpk = of.cpk.map(|[low, high]| format!("Cpk {low:.3} to {high:.3}"));
        let all: Vec<String> =
            [between("mean", of.mean), between("sigma", of.sigma), yields, cpk].into_iter().flatten().collect();
        let level = plain(100.0 * of.level);
        notes.push(format!("{level} % intervals by the size of measured samples: {}; {}", all.join(", "), of.basis));
    }
    notes
}

/// How far the results may be off.
fn errors(one: &CharacteristicReport) -> Vec<[String; 2]> {
    let Some(estimate) = &one.error_estimate else { return Vec::new() };
    let rows = [
        ("mean", estimate.mean),
        ("sigma", estimate.sigma),
        ("skewness", estimate.skewness),
        ("kurtosis", estimate.kurtosis),
        ("yield", estimate.yield_),
    ];
    let text = |error: Option<f64>| error.map_or("unknown".to_owned(), |error| significant(error, 2));
    rows.into_iter().map(|(name, error)| row(name, text(error))).collect()
}

/// The strongest contributions, and what is left.
fn pareto(one: &CharacteristicReport) -> (Vec<Share>, Option<String>) {
    let own = one.sensitivities.iter().filter_map(|row| {
        let (linear, curvature) = (row.linear_share?, row.curvature_share.unwrap_or(0.0));
        Some(Share {
            name: row.dimension.clone(),
            linear,
            curvature,
            interaction: 0.0,
            percent: percent(linear + curvature),
        })
    });
    let joint = one.interactions.iter().filter_map(|pair| {
        let share = pair.share?;
        let name = format!("{} \u{d7} {}", pair.dimensions[0], pair.dimensions[1]);
        Some(Share { name, linear: 0.0, curvature: 0.0, interaction: share, percent: percent(share) })
    });
    let size = |share: &Share| share.linear + share.curvature + share.interaction;
    let mut all: Vec<Share> = own.chain(joint).filter(|share| size(share).abs() > NEWS).collect();
    all.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let rest = all.split_off(all.len().min(BARS));
    let sum: f64 = rest.iter().map(size).sum();
    let mut left = match rest.len() {
        0 => None,
        count => Some(format!("{count} more have {} % together", percent(sum))),
    };
    if let Some(share) = one.left_out_share.filter(|share| *share > NEWS) {
        let words = format!("{} % is left out by all of these", percent(share));
        left = Some(left.map_or(words.clone(), |left| format!("{left}; {words}")));
    }
    // Bars are as long as the longest is wide; a negative share, of correlated dimensions, has none.
    let longest = all.first().map_or(1.0, size).max(f64::MIN_POSITIVE);
    let length = |share: f64| (1e4 * (share / longest).max(0.0)).round() / 1e2;
    for share in &mut all {
        (share.linear, share.curvature, share.interaction) =
            (length(share.linear), length(share.curvature), length(share.interaction));
    }
    (all, left)
}

/// Worst case, RSS and three sigma on one scale with the limits.
fn spans(one: &CharacteristicReport) -> (Vec<Span>, Vec<f64>) {
    let around = |middle: Option<f64>, reach: Option<f64>| Some([middle? - reach?, middle? + reach?]);
    let proven = if one.worst_case.proven == Some(true) { "extremes, proven" } else { "extremes found" };
    let intervals: Vec<(&str, [f64; 2])> = [
        ("worst case, linear", one.worst_case.linear),
        (proven, one.worst_case.extremes),
        ("no assembly lies beyond", one.worst_case.bounds),
        ("RSS", around(one.middle, one.rss)),
        ("RSS x 1.5 (Bender)", around(one.middle, one.inflated_rss)),
        ("RSS with shifted means", around(one.middle, one.mean_shift_rss)),
        ("mean \u{b1} 3 sigma", around(one.mean, one.sigma.map(|sigma| 3.0 * sigma))),
    ]
    .into_iter()
    .filter_map(|(name, interval)| Some((name, interval?)))
    .collect();
    let limits = [one.lower, one.upper];
    let ends = intervals.iter().flat_map(|(_, interval)| *interval);
    let extent = ends.clone().fold(f64::NEG_INFINITY, f64::max) - ends.clone().fold(f64::INFINITY, f64::min);
    let middle = one.mean.or(one.middle).unwrap_or(0.0);
    // A limit far away would press everything together.
    let near = limits.into_iter().flatten().filter(|limit| (limit - middle).abs() < 2.0 * extent);
    let Some(scale) = Scale::over(ends.chain(near), 0.04, 100.0) else { return (Vec::new(), Vec::new()) };
    let unit = one.sigma.filter(|&sigma| sigma > 0.0).or(one.rss).unwrap_or(0.0);
    let slack = 1e-9 * extent;
    let spans = intervals.into_iter().map(|(name, [from, to])| Span {
        name: name.to_owned(),
        x: scale.at(from),
        width: (scale.at(to) - scale.at(from)).max(0.2),
        from: beside(from, unit),
        to: beside(to, unit),
        kept: (one.lower.is_some() || one.upper.is_some()).then(|| {
            one.lower.is_none_or(|lower| from >= lower - slack) && one.upper.is_none_or(|upper| to <= upper + slack)
        }),
    });
    let inside = |x: &f64| *x >= scale.from && *x <= scale.to;
    (spans.collect(), limits.into_iter().flatten().filter(inside).map(|limit| scale.at(limit)).collect())
}

fn sensitivities(report: &Report, one: &CharacteristicReport) -> Vec<[String; 10]> {
    let part = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), percent);
    let pairs = one.sensitivities.iter().zip(&report.dimensions);
    pairs
        .filter(|(row, dimension)| dimension.sigma > 0.0 || row.first.is_some_and(|first| first != 0.0))
        .map(|(row, dimension)| {
            let number = |value, order: usize| derivative(value, row.rounding.map(|rounding| rounding[order]));
            [
                row.dimension.clone(),
                dimension.unit.clone().unwrap_or_default(),
                plain(dimension.nominal),
                dimension.tolerance.map_or(String::new(), band),
                significant(dimension.sigma, 5),
                format!("{}{}", number(row.first, 0), if row.exact { "" } else { " \u{2248}" }),
                number(row.second, 1),
                part(row.linear_share),
                part(row.curvature_share),
                match (row.mean_shift, one.sigma) {
                    (Some(shift), Some(sigma)) => rounded(shift, sigma),
                    _ => UNKNOWN.to_owned(),
                },
            ]
        })
        .collect()
}

fn interaction(pair: &super::super::InteractionReport) -> [String; 4] {
    let number = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| significant(value, 5));
    [
        format!("{} \u{d7} {}", pair.dimensions[0], pair.dimensions[1]),
        number(pair.mixed),
        pair.share.map_or(UNKNOWN.to_owned(), percent),
        number(pair.mean_shift),
    ]
}

/// Only where nothing says that the characteristic is not linear.
fn stacked(stack: &Stack) -> Option<Stacked> {
    let bent = |note: &StackNote| {
        matches!(note, StackNote::Curved { .. } | StackNote::NotExamined | StackNote::InteractionsNotExamined { .. })
    };
    if stack.notes.iter().any(bent) || stack.rows.is_empty() {
        return None;
    }
    let scale = stack.totals.iter().filter_map(|total| total.half_width).fold(0.0, f64::max);
    let scaled = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| beside(value, scale));
    let rows = stack.rows.iter().map(|row| {
        [
            row.dimension.name.clone(),
            row.direction.clone(),
            plain(row.dimension.nominal),
            band(row.deviations),
            scaled(row.contribution),
            row.share.map_or(UNKNOWN.to_owned(), percent),
        ]
    });
    let totals = stack.totals.iter().map(|total| {
        let interval = total.interval();
        [
            total.kind.name().to_owned(),
            scaled(total.middle),
            scaled(total.half_width),
            scaled(interval.map(|[from, _]| from)),
            scaled(interval.map(|[_, to]| to)),
            match stack.keeps(total) {
                None => String::new(),
                Some(true) => "within the limits".to_owned(),
                Some(false) => "exceeds the limits".to_owned(),
            },
        ]
    });
    let notes = stack.notes.iter().map(ToString::to_string).collect();
    Some(Stacked { rows: rows.collect(), totals: totals.collect(), notes })
}

fn tries(what_if: &WhatIf) -> Tries<'_> {
    let dimensions = what_if.dimensions().iter().map(|one| Try {
        name: &one.name,
        unit: one.unit.as_deref().unwrap_or_default(),
        nominal: plain(one.nominal),
        half: one.half,
        band: one.band.is_some(),
        fixed: one.fixed,
    });
    let characteristics = what_if.characteristics().iter();
    Tries {
        dimensions: dimensions.collect(),
        characteristics: characteristics
            .map(|one| (one.name.as_str(), one.unit.as_deref().unwrap_or_default(), one.why.as_deref()))
            .collect(),
        written: what_if.written(),
        cost: what_if
            .paid()
            .map(|paid| paid.map_or("no process holds these tolerances".to_owned(), |paid| significant(paid, 6))),
    }
}
