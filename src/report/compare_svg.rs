//! The trade of speed for accuracy as a chart: evaluations against error, both on logarithmic scales.

use std::fmt::Write;

use super::compare::{CompareReport, ComparedReport};
use super::svg::{ACCENT, HEIGHT, MARGIN, WIDTH, across, axes, charts, escaped, mark, up};

/// One chart below the other, one for every characteristic. Open circles are methods whose error the reference does not
/// resolve; the dashed line is what it resolves; the line joins the methods that no other beats.
pub fn compare_svg(report: &CompareReport) -> String {
    charts("Evaluations against error", &report.characteristics, |one| one.name.clone(), chart)
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
    (x.from..=x.to).for_each(|decade| across(svg, x.at(10f64.powi(decade)), &power(decade)));
    (y.from..=y.to).for_each(|decade| up(svg, y.at(10f64.powi(decade)), &power(decade)));
    axes(svg, "evaluations", "error of mean and sigma, in sigmas");
    if floor > 0.0 {
        mark(svg, y.at(floor), "reference resolves");
    }
    let front: Vec<String> = (shown.iter().filter(|point| point.4))
        .map(|point| format!("{:.1} {:.1}", x.at(point.1), y.at(point.2)))
        .collect();
    if front.len() > 1 {
        let _ = writeln!(svg, "<path d=\"M{}\" fill=\"none\" stroke=\"{ACCENT}\"/>", front.join("L"));
    }
    for (method, evaluations, error, resolved, pareto) in shown {
        let (at, height) = (x.at(evaluations), y.at(error));
        let colour = if pareto { ACCENT } else { "#666" };
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
