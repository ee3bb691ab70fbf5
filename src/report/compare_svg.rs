//! The trade of speed for accuracy as a chart: evaluations against error, both on logarithmic scales.

use std::fmt::Write;

use super::compare::{CompareReport, ComparedReport};
use super::svg::{escaped, opened};

const WIDTH: f64 = 720.0;
/// Height of one characteristic's chart.
const HEIGHT: f64 = 420.0;
/// Left, right, above, below.
const MARGIN: [f64; 4] = [80.0, 150.0, 48.0, 56.0];

/// One chart below the other, one for every characteristic. Open circles are methods whose error the reference does not
/// resolve; the dashed line is what it resolves; the line joins the methods that no other beats.
pub fn compare_svg(report: &CompareReport) -> String {
    let height = HEIGHT * report.characteristics.len() as f64;
    let mut svg = opened("Evaluations against error", WIDTH, height);
    for (index, one) in report.characteristics.iter().enumerate() {
        let _ = writeln!(svg, "<g transform=\"translate(0 {})\">", HEIGHT * index as f64);
        chart(&mut svg, one);
        svg += "</g>\n";
    }
    svg + "</svg>\n"
}

/// A logarithmic scale over whole decades.
struct Decades {
    from: i32,
    to: i32,
    pixels: [f64; 2],
}

impl Decades {
    fn over(values: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        let logs: Vec<f64> = values.filter(|value| *value > 0.0 && value.is_finite()).map(f64::log10).collect();
        let least = logs.iter().copied().fold(f64::INFINITY, f64::min);
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (from, to) = if logs.is_empty() { (0, 1) } else { (least.floor() as i32, most.ceil() as i32) };
        Self { from, to: to.max(from + 1), pixels }
    }

    fn at(&self, value: f64) -> f64 {
        let share = (value.log10() - f64::from(self.from)) / f64::from(self.to - self.from);
        self.pixels[0] + share * (self.pixels[1] - self.pixels[0])
    }
}

fn chart(svg: &mut String, one: &ComparedReport) {
    let [left, right, above, below] = MARGIN;
    let floor = one.methods.first().map_or(0.0, |method| method.error_vs_reference.floor);
    let shown: Vec<(&str, f64, f64, bool, bool)> = (one.methods.iter())
        .filter_map(|method| {
            let off = &method.error_vs_reference;
            let error = off.overall?.max(floor);
            (error > 0.0 && method.evaluations > 0).then_some((
                method.method.as_str(),
                method.evaluations as f64,
                error,
                off.resolved,
                method.pareto,
            ))
        })
        .collect();
    let x = Decades::over(shown.iter().map(|point| point.1), [left, WIDTH - right]);
    let y = Decades::over(shown.iter().map(|point| point.2).chain([floor]), [HEIGHT - below, above]);
    let name = escaped(&one.name);
    let _ = writeln!(svg, "<text x=\"{left}\" y=\"24\" font-size=\"15\" font-weight=\"bold\">{name}</text>");
    for decade in x.from..=x.to {
        let at = x.at(10f64.powi(decade));
        let _ = writeln!(svg, "<path d=\"M{at:.1} {above}V{}\" stroke=\"#ddd\"/>", HEIGHT - below);
        let _ = writeln!(
            svg,
            "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            HEIGHT - below + 18.0,
            power(decade)
        );
    }
    for decade in y.from..=y.to {
        let at = y.at(10f64.powi(decade));
        let _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{}\" stroke=\"#ddd\"/>", WIDTH - right);
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            left - 8.0,
            at + 4.0,
            power(decade)
        );
    }
    let middle = 0.5 * (left + WIDTH - right);
    let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">evaluations</text>", HEIGHT - 12.0);
    let centre = 0.5 * (above + HEIGHT - below);
    let _ = writeln!(
        svg,
        "<text x=\"18\" y=\"{centre}\" text-anchor=\"middle\" transform=\"rotate(-90 18 {centre})\">error of mean and sigma, in sigmas</text>"
    );
    if floor > 0.0 {
        let at = y.at(floor);
        let _ =
            writeln!(svg, "<path d=\"M{left} {at:.1}H{}\" stroke=\"#888\" stroke-dasharray=\"4 4\"/>", WIDTH - right);
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" fill=\"#555\">reference resolves</text>",
            WIDTH - right + 6.0,
            at + 4.0
        );
    }
    let front: Vec<String> = (shown.iter().filter(|point| point.4))
        .map(|point| format!("{:.1} {:.1}", x.at(point.1), y.at(point.2)))
        .collect();
    if front.len() > 1 {
        let _ = writeln!(svg, "<path d=\"M{}\" fill=\"none\" stroke=\"#1f6feb\"/>", front.join("L"));
    }
    for (method, evaluations, error, resolved, pareto) in shown {
        let (at, height) = (x.at(evaluations), y.at(error));
        let colour = if pareto { "#1f6feb" } else { "#666" };
        let fill = if resolved { colour } else { "#fff" };
        let _ =
            writeln!(svg, "<circle cx=\"{at:.1}\" cy=\"{height:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{colour}\"/>");
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\">{}</text>",
            at + 7.0,
            height - 5.0,
            escaped(method)
        );
    }
}

/// A power of ten with its exponent raised; 1 to 1000 in full.
fn power(decade: i32) -> String {
    match decade {
        0..=3 => 10u32.pow(decade as u32).to_string(),
        _ => format!("10<tspan baseline-shift=\"super\" font-size=\"9\">{decade}</tspan>"),
    }
}
