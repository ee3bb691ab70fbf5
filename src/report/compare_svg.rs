//! The trade of speed for accuracy as a chart: evaluations against error, both on logarithmic scales.

use std::fmt::Write;

use super::compare::{CompareReport, ComparedReport};
use super::labels::{Label, placed};
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
    let points: Vec<([f64; 2], &str)> = shown.iter().map(|point| ([x.at(point.1), y.at(point.2)], point.0)).collect();
    let colour = |point: usize| if shown[point].4 { ACCENT } else { "#666" };
    let labels = placed(&points, [left, WIDTH - 5.0, above - 12.0, HEIGHT - below]);
    for Label { x, y, of, point, .. } in labels.iter().filter(|label| label.far) {
        // To the middle of the line, where the text begins or ends.
        let ([from, top], to) = (of, y - 4.0);
        let colour = colour(*point);
        let _ =
            writeln!(svg, "<path d=\"M{from:.1} {top:.1}L{x:.1} {to:.1}\" stroke=\"{colour}\" stroke-width=\"0.5\"/>");
    }
    for (i, ([at, height], _)) in points.iter().enumerate() {
        let (colour, fill) = (colour(i), if shown[i].3 { colour(i) } else { "#fff" });
        let _ =
            writeln!(svg, "<circle cx=\"{at:.1}\" cy=\"{height:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{colour}\"/>");
    }
    for label in labels {
        let (colour, anchor) = (colour(label.point), if label.ends { " text-anchor=\"end\"" } else { "" });
        let (x, y, text) = (label.x, label.y, escaped(&label.text));
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{colour}\"{anchor}>{text}</text>");
    }
}

/// A power of ten with its exponent raised; 1 to 1000 in full.
fn power(decade: i32) -> String {
    match decade {
        0..=3 => 10u32.pow(decade as u32).to_string(),
        _ => format!("10<tspan baseline-shift=\"super\" font-size=\"9\">{decade}</tspan>"),
    }
}
