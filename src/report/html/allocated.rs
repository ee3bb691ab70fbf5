//! The page of an allocation.

use serde::Serialize;

use super::super::number::{UNKNOWN, plain, plural, share, significant};
use super::super::{AllocatedReport, AllocationReport, KeptReport, allocation_svg};
use super::{fact, inline, provenance, render};

#[derive(Serialize)]
struct AllocatedPage {
    status: &'static str,
    /// Whether the tolerances found keep everything.
    good: bool,
    costs: Option<[String; 3]>,
    requirements: Vec<[String; 6]>,
    tolerances: Vec<Tolerance>,
    recentred: Vec<[String; 3]>,
    prices: Vec<[String; 5]>,
    attainable: Option<String>,
    table: Option<String>,
    chart: Option<String>,
    joint: Option<[String; 2]>,
}

/// A tolerance and its cost before and after, with bars on common scales.
#[derive(Serialize)]
struct Tolerance {
    name: String,
    unit: String,
    before: String,
    after: String,
    cost_before: String,
    cost_after: String,
    process: String,
    bars: [f64; 2],
}

/// An allocation as one page of HTML: what it saves first, then requirements, tolerances and costs before and after.
pub fn allocate_html(report: &AllocationReport) -> String {
    let dearest = (report.tolerances.iter().flat_map(|one| [one.cost_before, one.cost_after]).flatten())
        .fold(f64::MIN_POSITIVE, f64::max);
    let allocated = AllocatedPage {
        status: report.status,
        good: matches!(report.status, "optimal" | "almost-optimal"),
        costs: costs(report),
        requirements: report.requirements.iter().map(requirement).collect(),
        tolerances: report.tolerances.iter().map(|one| tolerance(one, dearest)).collect(),
        recentred: (report.recentred.iter())
            .map(|one| [one.dimension.clone(), plain(one.before), plain(one.after)])
            .collect(),
        prices: (report.shadow_prices.iter())
            .map(|one| {
                let [both, lower, upper, sigma] = [one.both, one.lower, one.upper, one.sigma].map(number);
                [one.characteristic.clone(), both, lower, upper, sigma]
            })
            .collect(),
        attainable: report.attainable.as_ref().map(|one| {
            let best = number(one.best);
            let because = match one.because.is_empty() {
                true => String::new(),
                false => format!(" Dimensions without cost that break it by themselves: {}.", one.because.join(", ")),
            };
            format!(
                "{} cannot keep {} {}: the best that there is, is {best}.{because}",
                one.characteristic,
                one.requirement,
                plain(one.required)
            )
        }),
        table: report.dimensions_table.clone(),
        chart: (!report.front.is_empty()).then(|| inline(&allocation_svg(report))),
        joint: report.joint_yield.before.as_ref().map(|before| {
            let text = |yield_: f64| share(1.0 - yield_);
            let after = report.joint_yield.after.as_ref().map_or(UNKNOWN.to_owned(), |after| text(after.yield_));
            [text(before.yield_), after]
        }),
    };
    let confirmed =
        if report.confirmed { "the model was evaluated at the tolerances found" } else { "not by the model" };
    let mut facts = vec![
        fact("derivatives by", report.method),
        fact("confirmed", confirmed),
        fact("evaluations", format!("{} in {}", report.run.evaluations, plural(report.rounds, "round", "rounds"))),
    ];
    if let Some(residual) = report.proof.kkt_residual {
        facts.push(fact("Karush-Kuhn-Tucker residual", significant(residual, 2)));
    }
    if let Some(gap) = report.proof.gap {
        facts.push(fact("at most above the least cost", format!("{} of it", significant(gap, 2))));
    }
    if let Some(confirmation) = &report.confirmation {
        facts.push(fact("Monte Carlo at the tolerances found", format!("{} points", confirmation.samples)));
    }
    facts.extend(provenance(&report.head, &report.run));
    render("allocation.html", &report.head, facts, report.warnings.iter().collect(), None, allocated)
}

fn number(value: Option<f64>) -> String {
    value.map_or(UNKNOWN.to_owned(), |value| significant(value, 5))
}

/// Before, after, and what that saves in percent.
fn costs(report: &AllocationReport) -> Option<[String; 3]> {
    let after = report.cost_after?;
    let saved = report.cost_before.filter(|&before| before > 0.0).map(|before| 100.0 * (1.0 - after / before));
    Some([
        number(report.cost_before),
        number(Some(after)),
        match saved {
            Some(saved) if saved >= 0.0 => format!("{saved:.1} % less"),
            Some(more) => format!("{:.1} % more", -more),
            None => String::new(),
        },
    ])
}

fn requirement(one: &KeptReport) -> [String; 6] {
    let value = |value: f64| if one.requirement == "yield" { share(1.0 - value) } else { significant(value, 5) };
    let text = |of: Option<f64>| of.map_or(UNKNOWN.to_owned(), value);
    [
        one.characteristic.clone(),
        one.requirement.to_owned(),
        value(one.required),
        text(one.before),
        text(one.after),
        // Where nothing was found there is only what was.
        one.verdict
            .map_or_else(|| format!("{} before", one.verdict_before.name()), |verdict| verdict.name().to_owned()),
    ]
}

fn tolerance(one: &AllocatedReport, dearest: f64) -> Tolerance {
    let bar = |cost: Option<f64>| (1e4 * cost.unwrap_or(0.0).max(0.0) / dearest).round() / 1e2;
    Tolerance {
        name: one.dimension.clone(),
        unit: one.unit.clone().unwrap_or_default(),
        before: significant(one.before, 5),
        after: significant(one.after, 5),
        cost_before: number(one.cost_before),
        cost_after: number(one.cost_after),
        process: [one.process.as_deref(), one.at_bound].into_iter().flatten().collect::<Vec<_>>().join(", at its "),
        bars: [bar(one.cost_before), bar(one.cost_after)],
    }
}
