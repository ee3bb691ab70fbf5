//! A sweep as a chart: mean, median and the band of all but 0.27 %, over the parameter.

use std::fmt::Write;

use super::number::plain;
use super::svg::{ACCENT, HEIGHT, MARGIN, WIDTH, across, axes, charts, mark, up};
use super::sweep::{SweepReport, SweptPointReport, SweptReport};

/// One chart below the other, one for every characteristic. The band is open where a value has no result.
pub fn sweep_svg(report: &SweepReport) -> String {
    let parameter = with_unit(&report.parameter.name, report.parameter.unit.as_deref());
    charts(
        "Mean and quantile band",
        &report.characteristics,
        |one| one.name.clone(),
        |svg, one| {
            chart(svg, one, &parameter);
        },
    )
}

fn with_unit(name: &str, unit: Option<&str>) -> String {
    unit.map_or(name.to_owned(), |unit| format!("{name} [{unit}]"))
}

/// A linear scale.
struct Linear {
    from: f64,
    to: f64,
    pixels: [f64; 2],
}

impl Linear {
    fn over(values: impl Iterator<Item = f64>, margin: f64, pixels: [f64; 2]) -> Self {
        let [from, to] = values
            .filter(|value| value.is_finite())
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
        let (from, to) = if from <= to { (from, to) } else { (0.0, 1.0) };
        // What does not vary stands in the middle.
        let room = if from < to { margin * (to - from) } else { 0.5 * from.abs().max(1.0) };
        Self { from: from - room, to: to + room, pixels }
    }

    fn at(&self, value: f64) -> f64 {
        self.pixels[0] + (value - self.from) / (self.to - self.from) * (self.pixels[1] - self.pixels[0])
    }

    /// Round numbers within, five to ten of them.
    fn ticks(&self) -> Vec<f64> {
        let rough = (self.to - self.from) / 5.0;
        let power = 10f64.powf(rough.log10().floor());
        let step = [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|step| *step <= rough).unwrap_or(power);
        let (first, last) = ((self.from / step).ceil() as i64, (self.to / step).floor() as i64);
        // A product is rounder than a sum of steps.
        let rounded = |tick: i64| format!("{:.12e}", tick as f64 * step).parse().unwrap_or(tick as f64 * step);
        (first..=last).map(rounded).collect()
    }
}

fn chart(svg: &mut String, one: &SweptReport, parameter: &str) {
    let [left, right, above, below] = MARGIN;
    let x = Linear::over(one.points.iter().map(|point| point.at), 0.0, [left, WIDTH - right]);
    let values = |point: &SweptPointReport| {
        let [low, high] = point.band().map_or([None; 2], |band| band.map(Some));
        [low, high, point.mean, point.nominal].into_iter().flatten().collect::<Vec<_>>()
    };
    let limits = [one.lower, one.upper].into_iter().flatten();
    let y = Linear::over(one.points.iter().flat_map(values).chain(limits), 0.05, [HEIGHT - below, above]);
    x.ticks().into_iter().for_each(|tick| across(svg, x.at(tick), &plain(tick)));
    y.ticks().into_iter().for_each(|tick| up(svg, y.at(tick), &plain(tick)));
    axes(svg, parameter, &with_unit(&one.name, one.unit.as_deref()));
    let place = |at: f64, value: f64| format!("{:.1} {:.1}", x.at(at), y.at(value));
    for part in runs(&one.points, |point| point.band().is_some()) {
        let end = |end: usize| move |point: &SweptPointReport| point.band().map(|band| (point.at, band[end]));
        let low = part.iter().filter_map(end(0));
        let high = part.iter().rev().filter_map(end(1));
        let outline: Vec<String> = low.chain(high).map(|(at, value)| place(at, value)).collect();
        let _ = writeln!(svg, "<path d=\"M{}Z\" fill=\"{ACCENT}\" fill-opacity=\"0.2\"/>", outline.join("L"));
    }
    line(svg, one, |point| point.nominal, place, "stroke=\"#666\" stroke-dasharray=\"2 3\"");
    line(svg, one, |point| point.mean, place, &format!("stroke=\"{ACCENT}\" stroke-width=\"1.5\""));
    for (limit, name) in [(one.lower, "lower limit"), (one.upper, "upper limit")] {
        if let Some(limit) = limit {
            mark(svg, y.at(limit), name);
        }
    }
    let named = |point: &SweptPointReport| Some((point.band()?, point.mean?));
    if let Some((band, mean)) = one.points.iter().rev().find_map(named) {
        for (value, name) in [(band[1], "99.865 %"), (mean, "mean"), (band[0], "0.135 %")] {
            // Where the band is narrow only the mean is named.
            if name == "mean" || (y.at(value) - y.at(mean)).abs() > 12.0 {
                let _ = writeln!(
                    svg,
                    "<text x=\"{}\" y=\"{:.1}\" fill=\"{ACCENT}\">{name}</text>",
                    WIDTH - right + 6.0,
                    y.at(value) + 4.0
                );
            }
        }
    }
}

/// A line through the points that have a value, broken where one has none.
fn line(
    svg: &mut String,
    one: &SweptReport,
    value: impl Fn(&SweptPointReport) -> Option<f64>,
    place: impl Fn(f64, f64) -> String,
    style: &str,
) {
    for part in runs(&one.points, |point| value(point).is_some()) {
        let path: Vec<String> =
            part.iter().filter_map(|point| value(point).map(|value| place(point.at, value))).collect();
        let _ = writeln!(svg, "<path d=\"M{}\" fill=\"none\" {style}/>", path.join("L"));
    }
}

/// Stretches of points that are known.
fn runs(points: &[SweptPointReport], known: impl Fn(&SweptPointReport) -> bool) -> Vec<&[SweptPointReport]> {
    points.chunk_by(|a, b| known(a) == known(b)).filter(|part| known(&part[0])).collect()
}
