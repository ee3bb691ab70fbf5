//! The report of an allocation for people.

use super::CharacteristicReport;
use super::allocation::{AllocatedReport, AllocationReport, AttainableReport, KeptReport, PriceReport};
use super::head;
use super::number::{UNKNOWN, beside, plain, share, significant};
use super::page::{Grid, Page, Style, clean, short};
use super::requirement::loud;

/// An allocation as text: what it came to, tolerances, requirements, characteristics, and what to paste into the study.
pub fn allocation_text(report: &AllocationReport, style: Style) -> String {
    let mut page = Page::new(style);
    if let Some(title) = &report.head.title {
        page.line(&clean(title));
    }
    heading(&mut page, report);
    if let Some(attainable) = &report.attainable {
        unattainable(&mut page, attainable);
    }
    if !report.tolerances.is_empty() && report.cost_after.is_some() {
        page.line("");
        tolerances(&mut page, report);
    }
    if !report.recentred.is_empty() {
        page.line("");
        recentred(&mut page, report);
    }
    if !report.requirements.is_empty() {
        page.line("");
        requirements(&mut page, report);
    }
    page.line("");
    characteristics(&mut page, report);
    loosest(&mut page, report);
    joint(&mut page, report);
    confirmation(&mut page, report);
    if !report.front.is_empty() {
        page.line("");
        front(&mut page, report);
    }
    if let Some(table) = &report.dimensions_table {
        page.line("");
        page.line("[dimensions]");
        table.lines().for_each(|line| page.verbatim(line));
    }
    page.finish()
}

/// A smaller residual is rounding.
const LEAST: f64 = 1e-12;
/// Digits of a cost.
const COST: usize = 5;

fn money(cost: Option<f64>) -> String {
    cost.map_or(UNKNOWN.to_owned(), |cost| significant(cost, COST))
}

fn heading(page: &mut Page, report: &AllocationReport) {
    let spent = format!(
        "{} evaluations in {} rounds{}{}",
        report.run.evaluations,
        report.rounds,
        head::beside(&report.run),
        if report.confirmed && report.cost_after.is_some() { ", confirmed by the model" } else { "" }
    );
    let cost = match (report.cost_before, report.cost_after) {
        (before, Some(after)) => {
            let saved = before.map_or(String::new(), |before| {
                let part = 100.0 * (1.0 - after / before);
                format!(
                    " instead of {}, {} % {}",
                    significant(before, COST),
                    significant(part.abs(), 3),
                    if part < 0.0 { "more" } else { "less" }
                )
            });
            format!("cost {}{saved}", significant(after, COST))
        }
        (Some(before), None) => format!("cost {} before", significant(before, COST)),
        (None, None) => "nominal values moved".to_owned(),
    };
    page.line(&format!("{}: {cost}", report.status));
    page.line(&spent);
    let proof = &report.proof;
    if let Some(gap) = proof.gap {
        let basis = if proof.bound_is_exact == Some(true) { "" } else { ", as far as a sample of choices tells" };
        let text = match gap <= 1e-9 {
            true => format!("no choice of processes costs less{basis} ({} nodes)", proof.nodes),
            false => format!(
                "no choice of processes costs less than {}{basis}: a gap of {} % ({} nodes)",
                money(proof.bound),
                significant(100.0 * gap, 2),
                proof.nodes
            ),
        };
        page.line(&text);
    }
    if let Some(residual) = proof.kkt_residual {
        let closed = if proof.closed_form { ", Lagrange's solution in closed form" } else { "" };
        // The next power of ten, and no more than doubles tell.
        let within = 10f64.powi(residual.max(LEAST).log10().ceil() as i32);
        page.line(&format!("conditions of Karush, Kuhn and Tucker kept within {within:.0e}{closed}"));
    }
}

fn unattainable(page: &mut Page, one: &AttainableReport) {
    let name = short(&one.characteristic);
    let required = required(one.requirement, one.required);
    let best = one.best.map_or("unknown".to_owned(), |best| measure(one.requirement, best));
    page.line(&format!("`{name}` cannot keep {required}: the best that there is is {best}"));
    if one.together {
        page.line("it could by itself: together with the other requirements it cannot");
    }
    if !one.because.is_empty() {
        let names: Vec<String> = one.because.iter().take(5).map(|name| format!("`{}`", short(name))).collect();
        let more = if one.because.len() > 5 { ", ..." } else { "" };
        page.line(&format!("dimensions without a cost break it by themselves: {}{more}", names.join(", ")));
    }
}

fn required(requirement: &str, required: f64) -> String {
    match requirement {
        "yield" => format!("a yield of {}", share(1.0 - required)),
        "cpk" => format!("a Cpk of {}", plain(required)),
        "sigma" => format!("a sigma of {}", plain(required)),
        "rss" => "its limits by rss".to_owned(),
        _ => "its limits in the worst case".to_owned(),
    }
}

/// What there is, in the requirement's own measure.
fn measure(requirement: &str, value: f64) -> String {
    match requirement {
        "yield" => share(1.0 - value),
        "cpk" => format!("{value:.4}"),
        "sigma" => significant(value, 6),
        _ => format!("{} % of the room", significant(100.0 * value, 5)),
    }
}

fn tolerances(page: &mut Page, report: &AllocationReport) {
    let shares = report.characteristics.len() == 1;
    let header = ["", "before", "after", "", "cost", "after", if shares { "share %" } else { "most %" }, "after", ""];
    let mut table = Grid::new(header, "<>><>>>><");
    for one in &report.tolerances {
        let most = |of: &dyn Fn(&super::allocation::ContributionReport) -> Option<f64>| {
            let share = one.contributions.iter().filter_map(of).reduce(f64::max);
            share.map_or(UNKNOWN.to_owned(), |share| format!("{:.1}", 100.0 * share))
        };
        table.row([
            short(&one.dimension),
            band(one.before, one.deviations.before),
            band(one.after, one.deviations.after),
            one.unit.as_deref().map(clean).unwrap_or_default(),
            money(one.cost_before),
            money(one.cost_after),
            most(&|one| one.before),
            most(&|one| one.after),
            remark(one),
        ]);
    }
    page.print(&table);
}

fn band(half: f64, deviations: Option<[f64; 2]>) -> String {
    match deviations {
        Some([lower, upper]) if (lower + upper).abs() > 1e-9 * half => {
            format!("{} / {}", signed(lower), signed(upper))
        }
        _ => format!("± {}", significant(half, 4)),
    }
}

fn signed(value: f64) -> String {
    let text = significant(value, 4);
    if value >= 0.0 { format!("+{text}") } else { text }
}

fn remark(one: &AllocatedReport) -> String {
    let process = one.process.as_deref().map(clean);
    let bound = one.at_bound.map(|bound| format!("at its {bound}"));
    process.into_iter().chain(bound).collect::<Vec<_>>().join(", ")
}

fn recentred(page: &mut Page, report: &AllocationReport) {
    let mut table = Grid::new(["nominal", "before", "after", ""], "<>><");
    for one in &report.recentred {
        let moved = (one.after - one.before).abs();
        table.row([
            short(&one.dimension),
            plain(one.before),
            beside(one.after, moved),
            one.unit.as_deref().map(clean).unwrap_or_default(),
        ]);
    }
    page.print(&table);
}

fn requirements(page: &mut Page, report: &AllocationReport) {
    let mut table = Grid::new(["required", "", "before", "after", ""], "<<>><");
    for one in &report.requirements {
        let of = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| measure(one.requirement, value));
        table.row([short(&one.characteristic), wanted(one), of(one.before), of(one.after), verdict(one)]);
    }
    page.print(&table);
    for price in &report.shadow_prices {
        prices(page, report, price);
    }
}

fn wanted(one: &KeptReport) -> String {
    match one.requirement {
        "yield" => format!("yield {}", share(1.0 - one.required)),
        "cpk" => format!("Cpk {}", plain(one.required)),
        "sigma" => format!("sigma {}", plain(one.required)),
        other => other.to_owned(),
    }
}

fn verdict(one: &KeptReport) -> String {
    let before = loud(one.verdict_before);
    // Where nothing was found there is only what was.
    match one.verdict {
        Some(verdict) => format!("{}, {before} before", loud(verdict)),
        None => format!("{before} before"),
    }
}

/// What it saves when a limit gives way by a step that people can picture.
fn prices(page: &mut Page, report: &AllocationReport, price: &PriceReport) {
    let one = report.characteristics.iter().find(|one| one.name == price.characteristic);
    let unit = one.and_then(|one| one.unit.as_deref());
    let sigma = one.and_then(|one| one.after.as_ref().or(Some(&one.before))).and_then(|after| after.sigma);
    let step = match unit {
        Some("mm") => 0.001,
        _ => 10f64.powf(sigma.filter(|sigma| *sigma > 0.0).map_or(0.0, f64::log10).floor() - 1.0),
    };
    let by = format!("{}{}", plain(step), unit.map(|unit| format!(" {}", clean(unit))).unwrap_or_default());
    let part = |what: &str, price: Option<f64>| {
        price.map(|price| format!("{what} by {by} saves {}", significant(price * step, 3)))
    };
    let two = one.is_some_and(|one| one.before.lower.is_some() && one.before.upper.is_some());
    let all: Vec<String> = [
        part("both limits wider", price.both.filter(|_| two)),
        part("the lower limit lower", price.lower),
        part("the upper limit higher", price.upper),
        part("a larger sigma", price.sigma),
    ]
    .into_iter()
    .flatten()
    .collect();
    if !all.is_empty() {
        page.line(&format!("  {}: {}", short(&price.characteristic), all.join(", ")));
    }
}

fn characteristics(page: &mut Page, report: &AllocationReport) {
    let mut table = Grid::new(["", "", "mean", "sigma", "Cpk", "yield"], "<<>>>>");
    for one in &report.characteristics {
        let unit = one.unit.as_deref().map(|unit| format!(" [{}]", clean(unit))).unwrap_or_default();
        let mut row = |name: String, when: &str, of: &CharacteristicReport| {
            let sigma = of.sigma.unwrap_or(0.0);
            table.row([
                name,
                when.to_owned(),
                of.mean.map_or(UNKNOWN.to_owned(), |mean| beside(mean, sigma)),
                of.sigma.map_or(UNKNOWN.to_owned(), |sigma| beside(sigma, sigma)),
                of.cpk.map_or(String::new(), |cpk| format!("{cpk:.3}")),
                rejected(of),
            ]);
        };
        row(format!("{}{unit}", short(&one.name)), "before", &one.before);
        if let Some(after) = &one.after {
            row(String::new(), "after", after);
        }
    }
    page.print(&table);
}

fn rejected(of: &CharacteristicReport) -> String {
    match (of.ppm_below, of.ppm_above) {
        (None, None) => String::new(),
        (below, above) => share(1e-6 * (below.unwrap_or(0.0) + above.unwrap_or(0.0))),
    }
}

fn loosest(page: &mut Page, report: &AllocationReport) {
    if report.requirements.is_empty() {
        return;
    }
    let of = |factor: Option<f64>| factor.map_or("no one factor".to_owned(), |factor| format!("{factor:.4}"));
    let after = match report.loosest_scaling.after {
        None => String::new(),
        after => format!(", after by {}", of(after)),
    };
    page.line(&format!(
        "all tolerances together may be multiplied, before by {}{after}, until a requirement is just kept",
        of(report.loosest_scaling.before)
    ));
}

fn joint(page: &mut Page, report: &AllocationReport) {
    let of = |joint: &Option<super::allocation::JointReport>| {
        joint.as_ref().map(|joint| {
            let error =
                joint.standard_error.map_or(String::new(), |error| format!(" ± {}", significant(100.0 * error, 2)));
            format!("{:.4}{error} %", 100.0 * joint.yield_)
        })
    };
    let (before, after) = (of(&report.joint_yield.before), of(&report.joint_yield.after));
    if let Some(text) = match (before, after) {
        (Some(before), Some(after)) => Some(format!("{before} before, {after} after")),
        (before, after) => before.or(after),
    } {
        page.line(&format!("all limits at once are kept by {text} (sampled from the surrogates, standard error)"));
    }
}

fn confirmation(page: &mut Page, report: &AllocationReport) {
    let Some(confirmation) = &report.confirmation else { return };
    for one in &confirmation.characteristics {
        let Some((value, [low, high])) = one.yield_.zip(one.standard_error.yield_) else { continue };
        page.line(&format!(
            "{}: {} of {} points of the model keep the limits, 95 % interval {} .. {}",
            short(&one.name),
            share(1.0 - value),
            confirmation.samples,
            share(1.0 - low),
            share(1.0 - high)
        ));
    }
}

fn front(page: &mut Page, report: &AllocationReport) {
    let mut table = Grid::new(["required", "cost", ""], "<><");
    for point in &report.front {
        let Some(first) = point.required.first() else { continue };
        let wanted = match first.requirement {
            "yield" => share(1.0 - first.required),
            _ => format!("Cpk {}", significant(first.required, 4)),
        };
        let remark = if point.cost.is_none() { "cannot be kept" } else { "" };
        table.row([wanted, money(point.cost), remark.to_owned()]);
    }
    page.print(&table);
}
