//! The report for a terminal: the verdict first, then a table per characteristic; at most 100 columns.

use super::extremes::extremes;
use super::head;
use super::limits::{distribution, verdict};
use super::number::{UNKNOWN, beside, percent, plain, plural, share, significant, unsigned_zero};
use super::page::{Detail, Grid, Page, Style, clean, short};
use super::sampling::sampling;
use super::verification::verification;
use super::{CharacteristicReport, DimensionReport, Report, SensitivityReport};
use crate::method::Basis;

/// Contributions and interactions that are shown unless all are asked for.
const CONTRIBUTIONS: usize = 30;
const INTERACTIONS: usize = 5;
/// Interactions below this share of the variance are no news.
const NEWS: f64 = 1e-4;

/// The report as text, without its warnings.
pub fn text(report: &Report, style: Style) -> String {
    let mut page = Page::new(style);
    if let Some(title) = &report.head.title {
        page.line(&clean(title));
    }
    page.line(&summary(report));
    if let Some(account) = &report.account {
        page.wrapped(&account.to_string());
    }
    page.line("");
    verdicts(&mut page, report);
    for characteristic in &report.characteristics {
        page.line("");
        one(&mut page, report, characteristic);
    }
    page.finish()
}

/// What was done for it, in one line.
fn summary(report: &Report) -> String {
    let evaluations = plural(report.run.evaluations as usize, "evaluation", "evaluations");
    let varying = plural(report.varying, "varying dimension", "varying dimensions");
    format!("{}: {evaluations}, {varying}{}", report.method, head::beside(&report.run))
}

/// A line per characteristic: where it lies, and its limits.
fn verdicts(page: &mut Page, report: &Report) {
    let mut table = Grid::new(["", "mean", "± 3 sigma", "", "limits", ""], "<>><<<");
    for one in &report.characteristics {
        let limit = |limit: Option<f64>| limit.map_or(String::new(), plain);
        let limits = match (one.lower, one.upper) {
            (None, None) => String::new(),
            (Some(lower), None) => format!("above {}", plain(lower)),
            (None, Some(upper)) => format!("below {}", plain(upper)),
            (lower, upper) => format!("{} .. {}", limit(lower), limit(upper)),
        };
        let (mean, reach) = match (one.mean, one.sigma) {
            (Some(mean), Some(sigma)) => (beside(mean, sigma), beside(3.0 * sigma, sigma)),
            _ => ("unknown".to_owned(), UNKNOWN.to_owned()),
        };
        let unit = one.unit.as_deref().map(clean).unwrap_or_default();
        table.row([short(&one.name), mean, reach, unit, limits, verdict(one)]);
    }
    page.print(&table);
    if let Some(joint) = &report.joint_yield {
        let error = significant(100.0 * joint.error, 2);
        page.line(&format!("  all limits at once: yield {}, ± {error} %", share(1.0 - joint.value)));
    }
}

fn one(page: &mut Page, report: &Report, one: &CharacteristicReport) {
    let unit = one.unit.as_deref().map(|unit| format!(" [{}]", clean(unit))).unwrap_or_default();
    page.line(&format!("{}{unit}", clean(&one.name)));
    figures(page, one);
    extremes(page, one);
    distribution(page, one);
    sampling(page, one);
    page.line("");
    contributions(page, report, one);
    correlation(page, report, one);
    interactions(page, one);
}

fn figures(page: &mut Page, one: &CharacteristicReport) {
    let scale = one.sigma.filter(|&sigma| sigma > 0.0).or(one.rss).unwrap_or(0.0);
    let number = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| beside(value, scale));
    let shape = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| unsigned_zero(format!("{value:.4}")));
    let interval = |interval: Option<[f64; 2]>| match interval {
        Some([low, high]) => format!("{} .. {}", beside(low, scale), beside(high, scale)),
        None => UNKNOWN.to_owned(),
    };
    let around = |middle: Option<f64>, reach: Option<f64>| Some([middle? - reach?, middle? + reach?]);
    let shift = one.mean.and_then(|mean| Some(mean - one.nominal?));
    let mut table = Grid::new(["", "", "", ""], "<><<");
    for [name, value, other, text] in [
        ["nominal", &number(one.nominal), "mean shift", &number(shift)],
        ["mean", &number(one.mean), "3 sigma", &interval(around(one.mean, one.sigma.map(|sigma| 3.0 * sigma)))],
        ["sigma", &number(one.sigma), "rss", &interval(around(one.middle, one.rss))],
        ["skewness", &shape(one.skewness), "inflated rss", &interval(around(one.middle, one.inflated_rss))],
        ["kurtosis", &shape(one.kurtosis), "mean-shift rss", &interval(around(one.middle, one.mean_shift_rss))],
        ["", "", "worst case", &interval(one.worst_case.linear)],
    ] {
        table.row([name, value, other, text].map(str::to_owned));
    }
    page.print(&table);
    if let Some(fit) = &one.least_squares {
        let error = |error: Option<f64>| error.map_or(UNKNOWN.to_owned(), |error| significant(error, 2));
        page.line(&format!(
            "  {} coefficients fitted to {} points: residual standard error {}, of the mean {}, of sigma {}",
            fit.coefficients,
            fit.points,
            error(fit.residual_standard_error),
            error(fit.mean_standard_error),
            error(fit.sigma_standard_error)
        ));
    }
    estimate(page, one);
    verification(page, one);
    if let Some(sampled) = &one.surrogate_sampling {
        page.line(&format!(
            "  sampled from the surrogate, {} points: standard error of sigma {}, skewness {}, kurtosis {}",
            sampled.samples,
            significant(sampled.sigma, 2),
            significant(sampled.skewness, 2),
            significant(sampled.kurtosis, 2)
        ));
    }
}

/// How far all that may be off.
fn estimate(page: &mut Page, one: &CharacteristicReport) {
    let Some(estimate) = &one.error_estimate else { return };
    let part = |name: &str, value: Option<f64>| match value {
        Some(value) => format!("{name} {}", significant(value, 2)),
        None => format!("{name} {UNKNOWN}"),
    };
    let sigma = match (estimate.sigma, one.sigma) {
        (Some(error), Some(sigma)) if sigma > 0.0 => {
            format!("sigma {} ({} %)", significant(error, 2), percent(error / sigma))
        }
        (error, _) => part("sigma", error),
    };
    let mut parts = vec![part("mean", estimate.mean), sigma];
    parts.extend([part("skewness", estimate.skewness), part("kurtosis", estimate.kurtosis)]);
    if one.yield_.is_some() {
        parts.push(match estimate.yield_ {
            Some(error) => format!("yield {} %", significant(100.0 * error, 2)),
            None => part("yield", None),
        });
    }
    page.wrapped(&format!("  estimated errors: {}", parts.join(", ")));
    page.wrapped(&format!("  they rest on: {}", estimate.basis()));
    if let Some(sampled) = &one.model_sampling {
        page.wrapped(&format!(
            "  the surrogate was not trusted: mean to kurtosis from {} points of the model, with it as control variate",
            sampled.samples
        ));
    }
}

fn contributions(page: &mut Page, report: &Report, one: &CharacteristicReport) {
    let share = |row: &SensitivityReport| Some(row.linear_share? + row.curvature_share.unwrap_or(0.0));
    let mut rows: Vec<(&SensitivityReport, &DimensionReport)> = (one.sensitivities.iter().zip(&report.dimensions))
        .filter(|(row, dimension)| dimension.sigma > 0.0 || row.first.is_some_and(|first| first != 0.0))
        .collect();
    rows.sort_by(|(a, _), (b, _)| share(b).unwrap_or(-1.0).total_cmp(&share(a).unwrap_or(-1.0)));
    let shown = if page.style().detail == Detail::Full { rows.len() } else { rows.len().min(CONTRIBUTIONS) };
    let header = ["", "nominal", "tolerance", "", "slope", "curvature", "linear %", "curved %", "mean shift"];
    let mut table = Grid::new(header, "<><<>>>>>");
    for (row, dimension) in &rows[..shown] {
        let number = |value, order: usize| derivative(value, row.rounding.map(|rounding| rounding[order]));
        let shift = match (row.mean_shift, one.sigma) {
            (Some(shift), Some(sigma)) => rounded(shift, sigma),
            _ => UNKNOWN.to_owned(),
        };
        let cells = [
            short(&row.dimension),
            plain(dimension.nominal),
            tolerance(dimension),
            dimension.unit.as_deref().map(clean).unwrap_or_default(),
            number(row.first, 0),
            number(row.second, 1),
            row.linear_share.map_or(UNKNOWN.to_owned(), percent),
            row.curvature_share.map_or(UNKNOWN.to_owned(), percent),
            shift,
        ];
        table.row(cells);
    }
    page.print(&table);
    if let Some(source) = source(report, &rows) {
        page.line(&format!("  {source}"));
    }
    let rest = &rows[shown..];
    if !rest.is_empty() {
        let together: f64 = rest.iter().filter_map(|(row, _)| share(row)).sum();
        page.line(&format!("  and {} more with {} % together; -v shows all", rest.len(), percent(together)));
    }
}

/// The pairs that vary together, of dimensions that matter here.
fn correlation(page: &mut Page, report: &Report, one: &CharacteristicReport) {
    let matters = |name: &String| one.sensitivities.iter().any(|row| row.dimension == *name && row.first != Some(0.0));
    let pairs: Vec<String> = (report.correlation.iter())
        .filter(|pair| pair.between.iter().all(matters))
        .map(|pair| format!("{} × {} {}", short(&pair.between[0]), short(&pair.between[1]), plain(pair.value)))
        .collect();
    if pairs.is_empty() {
        return;
    }
    let most = if page.style().detail == Detail::Full { pairs.len() } else { INTERACTIONS };
    let more = if pairs.len() > most { format!(" and {} more", pairs.len() - most) } else { String::new() };
    let shown = pairs[..pairs.len().min(most)].join(", ");
    page.line(&format!(
        "  correlated: {shown}{more}; shares are covariances with the whole, the worst case ignores it"
    ));
}

/// What slopes and curvatures are, unless they are differences as everything else.
fn source(report: &Report, rows: &[(&SensitivityReport, &DimensionReport)]) -> Option<String> {
    let differences: Vec<String> =
        rows.iter().filter(|(row, _)| !row.exact).map(|(row, _)| short(&row.dimension)).collect();
    if differences.len() == rows.len() {
        return None;
    }
    let but = match differences.len() {
        0 => String::new(),
        1..=8 => format!(", but by differences for {}", differences.join(", ")),
        many => format!(", but by differences for {many} dimensions"),
    };
    let rest = match report.basis {
        Basis::Exact => "everything rests on them",
        Basis::Differences => "the rest comes from differences",
        Basis::LeastSquares => "the rest comes from the fitted surface",
        Basis::Quadrature => "the moments come from quadrature",
    };
    Some(format!("slopes and curvatures are exact{but}; {rest}"))
}

/// A derivative to six digits; what rounding alone can make is 0 as far as anybody knows.
pub(super) fn derivative(value: Option<f64>, rounding: Option<f64>) -> String {
    match (value, rounding) {
        (None, _) => UNKNOWN.to_owned(),
        (Some(value), Some(rounding)) if value.abs() <= 2.0 * rounding => "0".to_owned(),
        (Some(value), _) => significant(value, 6),
    }
}

/// Beside sigma, where nothing but zeros is 0.
pub(super) fn rounded(shift: f64, sigma: f64) -> String {
    let text = beside(shift, sigma);
    if text.parse() == Ok(0.0) { "0".to_owned() } else { text }
}

/// The ends of a tolerance band as drawings have them.
pub(super) fn band([lower, upper]: [f64; 2]) -> String {
    if lower == -upper {
        return format!("± {}", plain(upper));
    }
    let signed = |value: f64| if value >= 0.0 { format!("+{}", plain(value)) } else { plain(value) };
    format!("{} / {}", signed(lower), signed(upper))
}

pub(super) fn tolerance(dimension: &DimensionReport) -> String {
    match dimension.tolerance {
        Some(ends) => band(ends),
        None if dimension.sigma > 0.0 => format!("sigma {}", significant(dimension.sigma, 4)),
        None => UNKNOWN.to_owned(),
    }
}

fn interactions(page: &mut Page, one: &CharacteristicReport) {
    let detail = page.style().detail;
    let possible = one.possible_interactions;
    if possible == 0 {
        return;
    }
    let examined = one.interactions.len();
    if examined == 0 {
        return page.line(&format!("  interactions: none of {possible} examined"));
    }
    let known: Option<Vec<f64>> = one.interactions.iter().map(|interaction| interaction.share).collect();
    let together = known.map_or("an unknown part".to_owned(), |shares| format!("{} %", percent(shares.iter().sum())));
    page.line(&format!("  interactions: {examined} of {possible} examined, {together} of the variance together"));
    let shown = one
        .interactions
        .iter()
        .filter(|interaction| detail == Detail::Full || interaction.share.is_none_or(|share| share >= NEWS));
    let most = if detail == Detail::Full { examined } else { INTERACTIONS };
    for interaction in shown.take(most) {
        let [a, b] = &interaction.dimensions;
        let mixed = derivative(interaction.mixed, interaction.rounding);
        let share = interaction.share.map_or(UNKNOWN.to_owned(), percent);
        page.line(&format!("    {} × {}  {share} %  mixed derivative {mixed}", short(a), short(b)));
    }
}
