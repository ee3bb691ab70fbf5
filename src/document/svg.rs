//! Plots as SVG: one below the other, each with a frame of its own.

use std::fmt::Write;

use super::labels::{Label, placed};
use super::number::plain;
use super::{Chart, Document, Element, Layer, Plot, PlotAxis, PlotPoint, PlotScale, Stroke};

const WIDTH: f64 = 720.0;
/// Height of one plot.
const HEIGHT: f64 = 420.0;
/// Left, right, above, below.
const MARGIN: [f64; 4] = [80.0, 150.0, 48.0, 56.0];
/// The colours of what is to be looked at, and of what it is compared with.
const ACCENT: &str = "#1f6feb";
const FAINT: &str = "#666";
/// A name beside the chart this near to another one stands in its way.
const NEAR: f64 = 12.0;

/// All plots of a document.
pub fn svg(document: &Document, title: &str) -> String {
    let plots = document.all().filter_map(|block| match block {
        Element::Chart(Chart::Plot(plot)) => Some(plot),
        _ => None,
    });
    drawn(&plots.collect::<Vec<_>>(), title)
}

/// Plots as one drawing on white.
pub(super) fn drawn(plots: &[&Plot], title: &str) -> String {
    let (height, title) = (HEIGHT * plots.len() as f64, escaped(title));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<title>{title}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    for (index, one) in plots.iter().enumerate() {
        let (down, name) = (HEIGHT * index as f64, escaped(&one.name));
        let _ = writeln!(svg, "<g transform=\"translate(0 {down})\">");
        let _ = writeln!(svg, "<text x=\"{}\" y=\"24\" font-size=\"15\" font-weight=\"bold\">{name}</text>", MARGIN[0]);
        plot(&mut svg, one);
        svg += "</g>\n";
    }
    svg + "</svg>\n"
}

/// Names come from studies: nothing in them is markup, and characters that XML 1.0 does not have are left out.
pub(crate) fn escaped(text: &str) -> String {
    let allowed =
        |c: &char| !matches!(c, '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}');
    let text: String = text.chars().filter(allowed).collect();
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    text.replace('"', "&quot;").replace('\'', "&#x27;")
}

/// A scale from values to places in the drawing.
struct Ruler {
    scale: PlotScale,
    from: f64,
    to: f64,
    pixels: [f64; 2],
}

impl Ruler {
    fn over(values: Vec<f64>, scale: PlotScale, pixels: [f64; 2]) -> Self {
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            let ends = values.filter(|value| value.is_finite());
            let [low, high] =
                ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
            if low <= high { [low, high] } else { [0.0, 1.0] }
        };
        let [from, to] = match scale {
            PlotScale::Linear(margin) => {
                let [from, to] = ends(&mut values.into_iter());
                // A constant stands in the middle.
                let room = if from < to { margin * (to - from) } else { 0.5 * from.abs().max(1.0) };
                [from - room, to + room]
            }
            PlotScale::Decades => {
                let [from, to] = ends(&mut values.into_iter().filter(|value| *value > 0.0).map(f64::log10));
                [from.floor(), to.ceil().max(from.floor() + 1.0)]
            }
        };
        Self { scale, from, to, pixels }
    }

    fn at(&self, value: f64) -> f64 {
        let value = if self.scale == PlotScale::Decades { value.log10() } else { value };
        self.pixels[0] + (value - self.from) / (self.to - self.from) * (self.pixels[1] - self.pixels[0])
    }

    /// Places of an axis with what stands there, which is markup.
    fn ticks(&self, axis: &PlotAxis) -> Vec<(f64, String)> {
        if !axis.ticks.is_empty() {
            return axis.ticks.iter().map(|(at, label)| (self.at(*at), escaped(label))).collect();
        }
        if self.scale == PlotScale::Decades {
            return (self.from as i32..=self.to as i32).map(|of| (self.at(10f64.powi(of)), power(of))).collect();
        }
        // Round numbers, five to ten of them.
        let rough = (self.to - self.from) / 5.0;
        let decade = 10f64.powf(rough.log10().floor());
        let step =
            [5.0, 2.0, 1.0].map(|digit| digit * decade).into_iter().find(|step| *step <= rough).unwrap_or(decade);
        let (first, last) = ((self.from / step).ceil() as i64, (self.to / step).floor() as i64);
        // A product is rounder than a sum of steps.
        let rounded = |tick: i64| format!("{:.12e}", tick as f64 * step).parse().unwrap_or(tick as f64 * step);
        (first..=last).map(rounded).map(|tick| (self.at(tick), plain(tick))).collect()
    }
}

/// A power of ten with its exponent raised; 1 to 1000 in full.
fn power(decade: i32) -> String {
    match decade {
        0..=3 => 10u32.pow(decade as u32).to_string(),
        _ => format!("10<tspan baseline-shift=\"super\" font-size=\"9\">{decade}</tspan>"),
    }
}

fn plot(svg: &mut String, plot: &Plot) {
    let [left, right, above, below] = MARGIN;
    let (far, floor) = (WIDTH - right, HEIGHT - below);
    let x = Ruler::over(plot.values(0), plot.x.scale, [left, far]);
    let y = Ruler::over(plot.values(1), plot.y.scale, [floor, above]);
    for (at, label) in x.ticks(&plot.x) {
        let _ = writeln!(svg, "<path d=\"M{at:.1} {above}V{floor}\" stroke=\"#ddd\"/>");
        let _ = writeln!(svg, "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", floor + 18.0);
    }
    for (at, label) in y.ticks(&plot.y) {
        let _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{far}\" stroke=\"#ddd\"/>");
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>", left - 8.0, at + 4.0);
    }
    let (middle, label) = (0.5 * (left + far), escaped(&plot.x.label));
    let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", HEIGHT - 12.0);
    let (centre, label) = (0.5 * (above + floor), escaped(&plot.y.label));
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre})\"");
    let _ = writeln!(svg, "<text x=\"18\" y=\"{centre}\" {turned}>{label}</text>");
    let mut named: Option<f64> = None;
    for layer in &plot.layers {
        match layer {
            Layer::Band(points) => {
                for part in known(points) {
                    let low = part.iter().map(|&(at, [low, _])| (at, low));
                    let high = part.iter().rev().map(|&(at, [_, high])| (at, high));
                    let outline = path(&x, &y, low.chain(high));
                    let _ = writeln!(svg, "<path d=\"{outline}Z\" fill=\"{ACCENT}\" fill-opacity=\"0.2\"/>");
                }
            }
            Layer::Curve(points, stroke) => {
                let stroke = match stroke {
                    Stroke::Strong => format!("stroke=\"{ACCENT}\" stroke-width=\"1.5\""),
                    Stroke::Thin => format!("stroke=\"{ACCENT}\""),
                    Stroke::Dotted => format!("stroke=\"{FAINT}\" stroke-dasharray=\"2 3\""),
                };
                for part in known(points) {
                    let _ = writeln!(svg, "<path d=\"{}\" fill=\"none\" {stroke}/>", path(&x, &y, part.into_iter()));
                }
            }
            Layer::Points(points) => circles(svg, &x, &y, points),
            Layer::Mark(value, name) => {
                let (at, name) = (y.at(*value), escaped(name));
                let _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{far}\" stroke=\"#888\" stroke-dasharray=\"4 4\"/>");
                let _ = writeln!(svg, "<text x=\"{}\" y=\"{:.1}\" fill=\"#555\">{name}</text>", far + 6.0, at + 4.0);
            }
            Layer::End(value, name) => {
                let at = y.at(*value);
                // Where names would stand over one another only the first is there.
                if named.is_none_or(|first| (at - first).abs() > NEAR) {
                    let _ = writeln!(
                        svg,
                        "<text x=\"{}\" y=\"{:.1}\" fill=\"{ACCENT}\">{name}</text>",
                        far + 6.0,
                        at + 4.0
                    );
                }
                named = named.or(Some(at));
            }
        }
    }
}

/// Stretches of points that are known.
fn known<T: Copy>(points: &[(f64, Option<T>)]) -> Vec<Vec<(f64, T)>> {
    let stretches = points.chunk_by(|a, b| a.1.is_some() == b.1.is_some());
    let inside = |part: &[(f64, Option<T>)]| part.iter().filter_map(|&(at, value)| Some((at, value?))).collect();
    stretches.map(inside).filter(|part: &Vec<_>| !part.is_empty()).collect()
}

fn path(x: &Ruler, y: &Ruler, points: impl Iterator<Item = (f64, f64)>) -> String {
    let points: Vec<String> = points.map(|(at, value)| format!("{:.1} {:.1}", x.at(at), y.at(value))).collect();
    format!("M{}", points.join("L"))
}

fn circles(svg: &mut String, x: &Ruler, y: &Ruler, points: &[PlotPoint]) {
    let [left, _, above, below] = MARGIN;
    let place = |point: &PlotPoint| [x.at(point.at[0]), y.at(point.at[1])];
    let colour = |point: &PlotPoint| if point.strong { ACCENT } else { FAINT };
    let named: Vec<&PlotPoint> = points.iter().filter(|point| !point.name.is_empty()).collect();
    let names: Vec<([f64; 2], &str)> = named.iter().map(|point| (place(point), point.name.as_str())).collect();
    let labels = placed(&names, [left, WIDTH - 5.0, above - 12.0, HEIGHT - below]);
    for Label { x, y, of: [from, top], point, .. } in labels.iter().filter(|label| label.far) {
        // To the middle of the line, where the text begins or ends.
        let (to, colour) = (y - 4.0, colour(named[*point]));
        let _ =
            writeln!(svg, "<path d=\"M{from:.1} {top:.1}L{x:.1} {to:.1}\" stroke=\"{colour}\" stroke-width=\"0.5\"/>");
    }
    for point in points {
        let ([at, height], colour) = (place(point), colour(point));
        let fill = if point.filled { colour } else { "#fff" };
        let circle = format!("circle cx=\"{at:.1}\" cy=\"{height:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{colour}\"");
        let _ = match point.tip.as_str() {
            "" => writeln!(svg, "<{circle}/>"),
            tip => writeln!(svg, "<{circle}><title>{}</title></circle>", escaped(tip)),
        };
    }
    for Label { x, y, ends, point, text, .. } in labels {
        let (colour, anchor) = (colour(named[point]), if ends { " text-anchor=\"end\"" } else { "" });
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{colour}\"{anchor}>{}</text>", escaped(&text));
    }
}
