//! The front of cost against what is required, as a chart.

use std::fmt::Write;

use super::allocation::AllocationReport;
use super::number::significant;
use super::svg::{ACCENT, HEIGHT, MARGIN, WIDTH, across, axes, headline, opened, up};

/// What is required across, by the sigmas that reject as many on both sides together, or the Cpk; cost upwards. The open circle is what the
/// tolerances before keep and cost.
pub fn allocation_svg(report: &AllocationReport) -> String {
    let points: Vec<(f64, f64, String)> = (report.front.iter())
        .filter_map(|point| {
            let wanted = point.required.first()?;
            let (place, label) = scale(wanted.requirement, wanted.required);
            Some((place, point.cost?, label))
        })
        .collect();
    let [left, right, above, below] = MARGIN;
    let mut svg = opened("Cost against what is required", HEIGHT);
    let now = present(report);
    let [least, most] = range(points.iter().map(|point| point.0).chain(now.as_ref().map(|now| now.0)));
    let [cheapest, dearest] = range(points.iter().map(|point| point.1).chain(now.as_ref().map(|now| now.1)));
    let x = |value: f64| left + (value - least) / (most - least) * (WIDTH - left - right);
    let y = |value: f64| HEIGHT - below - (value - cheapest) / (dearest - cheapest) * (HEIGHT - above - below);
    let first = report.front.first().and_then(|point| point.required.first());
    headline(&mut svg, report.head.title.as_deref().unwrap_or("Cost against what is required"));
    for part in 0..=4 {
        let value = cheapest + (dearest - cheapest) * f64::from(part) / 4.0;
        up(&mut svg, y(value), &significant(value, 4));
    }
    // Every label would stand in the next one's way.
    let every = points.len().div_ceil(6).max(1);
    points.iter().step_by(every).for_each(|(place, _, label)| across(&mut svg, x(*place), label));
    axes(&mut svg, &format!("{} required", first.map_or("yield", |wanted| wanted.requirement)), "cost");
    let line: Vec<String> = points.iter().map(|point| format!("{:.1} {:.1}", x(point.0), y(point.1))).collect();
    if line.len() > 1 {
        let _ = writeln!(svg, "<path d=\"M{}\" fill=\"none\" stroke=\"{ACCENT}\"/>", line.join("L"));
    }
    for (place, cost, label) in &points {
        let _ = writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"4\" fill=\"{ACCENT}\"><title>{label}: {}</title></circle>",
            x(*place),
            y(*cost),
            significant(*cost, 6)
        );
    }
    if let Some((place, cost)) = now {
        let (at, height) = (x(place), y(cost));
        let _ = writeln!(svg, "<circle cx=\"{at:.1}\" cy=\"{height:.1}\" r=\"4\" fill=\"#fff\" stroke=\"#666\"/>");
        let _ = writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"#666\">before</text>", at + 7.0, height - 5.0);
    }
    svg + "</svg>\n"
}

/// Where a requirement lies, and its label.
fn scale(requirement: &str, required: f64) -> (f64, String) {
    match requirement {
        "yield" => {
            let rejected = (1.0 - required).max(f64::MIN_POSITIVE);
            (-rejected.log10(), format!("{} %", super::number::share(rejected).trim_end_matches(" %")))
        }
        _ => (required, significant(required, 3)),
    }
}

/// What the tolerances before gave, for what they cost.
fn present(report: &AllocationReport) -> Option<(f64, f64)> {
    let first = report.front.first()?.required.first()?;
    let one = report.requirements.iter().find(|one| one.characteristic == first.characteristic)?;
    let (had, cost) = (one.before?, report.cost_before?);
    (had < 1.0 - 1e-12 || first.requirement != "yield").then(|| (scale(first.requirement, had).0, cost))
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    values.filter(|value| value.is_finite()).for_each(|value| (low, high) = (low.min(value), high.max(value)));
    match (low.is_finite(), high > low) {
        (true, true) => [low - 0.05 * (high - low), high + 0.05 * (high - low)],
        (true, false) => [low - 1.0, low + 1.0],
        _ => [0.0, 1.0],
    }
}
