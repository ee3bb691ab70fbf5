//! Plots as SVG. A file has the plots one below the other, each with its own frame. A page has each plot twice, for two widths.

use std::fmt::Write;

use crate::document::labels::{LETTER, Label, placed};
use crate::document::number::{plain, power_of_ten, significant};
use crate::document::{Chart, Document, Element, Layer, Plot, PlotAxis, PlotPoint, PlotScale, Stroke};

/// Colour of emphasised elements.
const ACCENT: &str = "#1f6feb";
/// Colour of elements to compare with.
const FAINT: &str = "#666";
/// Least distance between two names beside the chart, in px.
const NEAR: f64 = 13.0;

/// Sheet of a plot: size, margins, and steps of the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sheet {
    width: f64,
    height: f64,
    /// Margins: left, right, above, below.
    margin: [f64; 4],
    /// Smallest number of steps of an axis with round numbers: horizontal, vertical.
    ticks: [f64; 2],
    /// True if the style sheet of a page sets the colours.
    page: bool,
}

/// Sheet of a plot in a file of its own.
const ALONE: Sheet =
    Sheet { width: 720.0, height: 420.0, margin: [80.0, 150.0, 48.0, 56.0], ticks: [5.0, 5.0], page: false };
/// Sheets of the two drawings of a page, which shows the one that fits. Their margins grow with their labels.
const PAGES: [(&str, Sheet); 2] = [
    ("wide", Sheet { width: 736.0, height: 330.0, margin: [48.0, 16.0, 28.0, 44.0], ticks: [5.0, 4.0], page: true }),
    ("narrow", Sheet { width: 358.0, height: 270.0, margin: [40.0, 16.0, 28.0, 44.0], ticks: [3.0, 4.0], page: true }),
];

/// Colour of a mark, by its meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ink {
    Grid,
    Band,
    Line(Stroke),
    Mark,
    MarkName,
    EndName,
}

impl Sheet {
    /// Returns SVG attributes: a class on a page, colours in a file.
    fn ink(self, ink: Ink) -> String {
        if self.page {
            let class = match ink {
                Ink::Grid => "grid",
                Ink::Band => "band",
                Ink::Line(Stroke::Strong) => "strong",
                Ink::Line(Stroke::Thin) => "thin",
                Ink::Line(Stroke::Dotted) => "dotted",
                Ink::Mark => "mark",
                Ink::MarkName => "of-mark",
                Ink::EndName => "end",
            };
            return format!("class=\"{class}\"");
        }
        match ink {
            Ink::Grid => "stroke=\"#ddd\"".to_owned(),
            Ink::Band => format!("fill=\"{ACCENT}\" fill-opacity=\"0.2\""),
            Ink::Line(stroke) => {
                let stroke = match stroke {
                    Stroke::Strong => format!("stroke=\"{ACCENT}\" stroke-width=\"1.5\""),
                    Stroke::Thin => format!("stroke=\"{ACCENT}\""),
                    Stroke::Dotted => format!("stroke=\"{FAINT}\" stroke-dasharray=\"2 3\""),
                };
                format!("fill=\"none\" {stroke}")
            }
            Ink::Mark => "stroke=\"#888\" stroke-dasharray=\"4 4\"".to_owned(),
            Ink::MarkName => "fill=\"#555\"".to_owned(),
            Ink::EndName => format!("fill=\"{ACCENT}\""),
        }
    }

    /// Returns the attributes of a point's circle, of its name, and of the line between them.
    fn of_point(self, point: &PlotPoint) -> [String; 3] {
        let colour = if point.strong { ACCENT } else { FAINT };
        let fill = if point.filled { colour } else { "#fff" };
        if !self.page {
            let line = format!("stroke=\"{colour}\" stroke-width=\"0.5\"");
            return [format!("fill=\"{fill}\" stroke=\"{colour}\""), format!("fill=\"{colour}\""), line];
        }
        let kind = if point.strong { "best" } else { "other" };
        let filled = if point.filled { "" } else { " open" };
        [format!("class=\"{kind}{filled}\""), format!("class=\"of-{kind}\""), format!("class=\"lead {kind}\"")]
    }
}

/// Draws all plots of a document.
pub fn svg(document: &Document, title: &str) -> String {
    let plots = document.all().filter_map(|block| match block {
        Element::Chart(Chart::Plot(plot)) => Some(plot),
        _ => None,
    });
    drawn(&plots.collect::<Vec<_>>(), title)
}

/// Draws plots as one drawing on white.
fn drawn(plots: &[&Plot], title: &str) -> String {
    let Sheet { width, height: each, margin, .. } = ALONE;
    let (height, title) = (each * plots.len() as f64, escaped(title));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<title>{title}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    for (index, one) in plots.iter().enumerate() {
        let (down, name) = (each * index as f64, escaped(&one.name));
        let _ = writeln!(svg, "<g transform=\"translate(0 {down})\">");
        let _ = writeln!(svg, "<text x=\"{}\" y=\"24\" font-size=\"15\" font-weight=\"bold\">{name}</text>", margin[0]);
        plot(&mut svg, one, ALONE);
        svg += "</g>\n";
    }
    svg + "</svg>\n"
}

/// Draws a plot of a page, with its text below.
pub(super) fn figure(of: &Plot) -> String {
    let label = escaped(&said(of));
    let mut text = "<figure>\n".to_owned();
    for (class, sheet) in PAGES {
        let Sheet { width, height, .. } = sheet;
        let _ = writeln!(
            text,
            "<svg class=\"density plot {class}\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{label}\">"
        );
        plot(&mut text, of, sheet);
        text += "</svg>\n";
    }
    text + &format!("<figcaption>{}</figcaption>\n</figure>\n", escaped(&of.words))
}

/// Text of a plot for screen readers.
fn said(of: &Plot) -> String {
    let number = |value: f64| significant(value, 4);
    let ends = |known: Vec<(f64, f64)>| Some((*known.first()?, *known.last()?));
    let mut parts = vec![format!("{}: {} over {}", of.name, of.y.label, of.x.label)];
    for layer in &of.layers {
        match layer {
            Layer::Band(points) => {
                let all = points.iter().filter_map(|&(at, band)| Some((at, band?)));
                let all: Vec<(f64, [f64; 2])> = all.collect();
                parts.extend([all.first(), all.last()].into_iter().flatten().map(|(at, [low, high])| {
                    format!("band at {} from {} to {}", plain(*at), number(*low), number(*high))
                }));
            }
            Layer::Curve(points, Stroke::Strong) => {
                let known = points.iter().filter_map(|&(at, value)| Some((at, value?))).collect();
                if let Some(((from, first), (to, last))) = ends(known) {
                    let [from, to] = [from, to].map(plain);
                    parts.push(format!("line from {} at {from} to {} at {to}", number(first), number(last)));
                }
            }
            Layer::Curve(..) | Layer::End(..) => {}
            Layer::Points(points) => parts.extend(points.iter().map(|point| {
                let name = if point.name.is_empty() { String::new() } else { format!("{} ", point.name) };
                match point.tip.as_str() {
                    "" => format!("{name}{} at {}", number(point.at[1]), number(point.at[0])),
                    tip => format!("{name}{tip}"),
                }
            })),
            Layer::Mark(at, name) => parts.push(format!("{name} {}", plain(*at))),
        }
    }
    parts.join(", ")
}

/// Escapes text from studies for markup, and drops characters that XML 1.0 does not allow.
pub(crate) fn escaped(text: &str) -> String {
    let allowed =
        |c: &char| !matches!(c, '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}');
    let text: String = text.chars().filter(allowed).collect();
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    text.replace('"', "&quot;").replace('\'', "&#x27;")
}

/// Scale from values to positions in the drawing.
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
                // A constant value stands in the middle.
                let room = if from < to { margin * (to - from) } else { 0.5 * from.abs().max(1.0) };
                [from - room, to + room]
            }
            PlotScale::Decades => {
                let [from, to] = ends(&mut values.into_iter().filter(|value| *value > 0.0).map(libm::log10));
                [from.floor(), to.ceil().max(from.floor() + 1.0)]
            }
        };
        Self { scale, from, to, pixels }
    }

    fn at(&self, value: f64) -> f64 {
        let value = if self.scale == PlotScale::Decades { libm::log10(value) } else { value };
        self.pixels[0] + (value - self.from) / (self.to - self.from) * (self.pixels[1] - self.pixels[0])
    }

    /// Returns the positions of an axis with their labels as markup.
    fn ticks(&self, axis: &PlotAxis, least: f64) -> Vec<(f64, String)> {
        if !axis.ticks.is_empty() {
            return axis.ticks.iter().map(|(at, label)| (self.at(*at), escaped(label))).collect();
        }
        if self.scale == PlotScale::Decades {
            return (self.from as i32..=self.to as i32).map(|of| (self.at(10f64.powi(of)), power(of))).collect();
        }
        // Round steps, so that there are `least` to about twice as many.
        let rough = (self.to - self.from) / least;
        let decade = power_of_ten(libm::log10(rough).floor());
        let step =
            [5.0, 2.0, 1.0].map(|digit| digit * decade).into_iter().find(|step| *step <= rough).unwrap_or(decade);
        let (first, last) = ((self.from / step).ceil() as i64, (self.to / step).floor() as i64);
        // A product has less rounding error than a sum of steps.
        let rounded = |tick: i64| format!("{:.12e}", tick as f64 * step).parse().unwrap_or(tick as f64 * step);
        (first..=last).map(rounded).map(|tick| (self.at(tick), plain(tick))).collect()
    }
}

/// Formats a power of ten with a raised exponent; 1 to 1000 in full.
fn power(decade: i32) -> String {
    match decade {
        0..=3 => 10u32.pow(decade as u32).to_string(),
        _ => format!("10<tspan baseline-shift=\"super\" font-size=\"9\">{decade}</tspan>"),
    }
}

/// Counts the visible letters of a label with markup.
fn letters(label: &str) -> usize {
    let parts = label.split('<').enumerate();
    let shown = parts.map(|(i, part)| if i == 0 { part } else { part.split_once('>').map_or("", |(_, text)| text) });
    shown.map(|part| part.chars().count()).sum()
}

/// Name beside the chart: its height, text and colour.
type Beside = (f64, &'static str, Ink);

/// Returns all names beside the chart from top to bottom, without overlap.
fn beside(plot: &Plot, y: &Ruler, [above, floor]: [f64; 2]) -> Vec<Beside> {
    let name = |layer: &Layer| match layer {
        Layer::Mark(value, name) => Some((y.at(*value), *name, Ink::MarkName)),
        Layer::End(value, name) => Some((y.at(*value), *name, Ink::EndName)),
        _ => None,
    };
    let mut names: Vec<Beside> = plot.layers.iter().filter_map(name).collect();
    names.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = above - NEAR;
    for one in &mut names {
        one.0 = one.0.max(last + NEAR);
        last = one.0;
    }
    let mut next = floor + NEAR;
    for one in names.iter_mut().rev() {
        one.0 = one.0.min(next - NEAR);
        next = one.0;
    }
    names
}

/// Returns as much of the text as fits into a width.
fn fitted(text: &str, width: f64) -> String {
    let most = (width / LETTER) as usize;
    match text.chars().count() > most {
        true => text.chars().take(most.saturating_sub(1)).chain(['\u{2026}']).collect(),
        false => text.to_owned(),
    }
}

/// Draws a plot on a sheet: grid and numbers first, then its labels and layers, and names at the end of lines over all.
fn plot(svg: &mut String, plot: &Plot, mut sheet: Sheet) {
    let [_, _, above, below] = sheet.margin;
    let floor = sheet.height - below;
    let y = Ruler::over(plot.values(1), plot.y.scale, [floor, above]);
    let upwards = y.ticks(&plot.y, sheet.ticks[1]);
    let names = beside(plot, &y, [above, floor]);
    if sheet.page {
        let widest = |lengths: &mut dyn Iterator<Item = usize>| LETTER * lengths.max().unwrap_or(0) as f64;
        sheet.margin[0] = sheet.margin[0].max(widest(&mut upwards.iter().map(|(_, label)| letters(label))) + 12.0);
        // A name that takes too much of the width stands inside the chart.
        let room = 0.25 * sheet.width;
        let outside = names.iter().map(|(_, name, _)| name.len()).filter(|length| LETTER * *length as f64 <= room);
        sheet.margin[1] = sheet.margin[1].max(widest(&mut outside.into_iter()) + 10.0);
    }
    let [left, right, ..] = sheet.margin;
    let x = Ruler::over(plot.values(0), plot.x.scale, [left, sheet.width - right]);
    grid(svg, [x.ticks(&plot.x, sheet.ticks[0]), upwards], &sheet);
    axis_labels(svg, plot, &sheet);
    let (texts, held) = end_names(names, &sheet);
    layers(svg, plot, [&x, &y], &sheet, &held);
    *svg += &texts;
}

/// Draws the grid with the numbers at it.
fn grid(svg: &mut String, [across, upwards]: [Vec<(f64, String)>; 2], sheet: &Sheet) {
    let [left, right, above, below] = sheet.margin;
    let (far, floor) = (sheet.width - right, sheet.height - below);
    let grid = sheet.ink(Ink::Grid);
    let mut end = f64::NEG_INFINITY;
    for (at, label) in across {
        let _ = writeln!(svg, "<path d=\"M{at:.1} {above}V{floor}\" {grid}/>");
        let half = 0.5 * LETTER * letters(&label) as f64;
        // A plot in a file has space for all labels.
        if sheet.page && at - half < end {
            continue;
        }
        end = at + half + 4.0;
        let _ = writeln!(svg, "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", floor + 18.0);
    }
    for (at, label) in upwards {
        let _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{far}\" {grid}/>");
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>", left - 8.0, at + 4.0);
    }
}

/// Writes the labels of both axes.
fn axis_labels(svg: &mut String, plot: &Plot, sheet: &Sheet) {
    let [left, right, above, below] = sheet.margin;
    let (far, floor) = (sheet.width - right, sheet.height - below);
    let (middle, low) = (0.5 * (left + far), sheet.height - if sheet.page { 8.0 } else { 12.0 });
    if sheet.page {
        // The label uses the whole width; a longer one is cut.
        let of_x = fitted(&plot.x.label, 2.0 * middle.min(sheet.width - middle));
        let _ = writeln!(svg, "<text x=\"{middle:.1}\" y=\"{low}\" text-anchor=\"middle\">{}</text>", escaped(&of_x));
        let of_y = fitted(&plot.y.label, sheet.width);
        let _ = writeln!(svg, "<text class=\"name\" x=\"0\" y=\"12\">{}</text>", escaped(&of_y));
    } else {
        let label = escaped(&plot.x.label);
        let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{low}\" text-anchor=\"middle\">{label}</text>");
        let (centre, label) = (0.5 * (above + floor), escaped(&plot.y.label));
        let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre})\"");
        let _ = writeln!(svg, "<text x=\"18\" y=\"{centre}\" {turned}>{label}</text>");
    }
}

/// The names at the end of lines, and the boxes that they take.
fn end_names(names: Vec<Beside>, sheet: &Sheet) -> (String, Vec<[f64; 4]>) {
    let right = sheet.margin[1];
    let far = sheet.width - right;
    let (mut held, mut texts) = (Vec::new(), String::new());
    for (at, name, ink) in names {
        let (ink, name, wide) = (sheet.ink(ink), escaped(name), LETTER * name.len() as f64);
        // The margin of a plot in a file is wide enough.
        if !sheet.page || wide <= right - 6.0 {
            held.push([far + 6.0, far + 6.0 + wide, at - 7.0, at + 7.0]);
            let _ = writeln!(texts, "<text x=\"{}\" y=\"{:.1}\" {ink}>{name}</text>", far + 6.0, at + 4.0);
            continue;
        }
        held.push([far - wide - 4.0, far, at - 16.0, at - 2.0]);
        let (x, y) = (far - 4.0, at - 5.0);
        let _ = writeln!(texts, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"end\" {ink}>{name}</text>");
    }
    (texts, held)
}

/// Draws the layers one over the other; names of points keep out of the boxes that are held.
fn layers(svg: &mut String, plot: &Plot, [x, y]: [&Ruler; 2], sheet: &Sheet, held: &[[f64; 4]]) {
    let [left, right, ..] = sheet.margin;
    let far = sheet.width - right;
    for layer in &plot.layers {
        match layer {
            Layer::Band(points) => {
                let ink = sheet.ink(Ink::Band);
                for part in known(points) {
                    let low = part.iter().map(|&(at, [low, _])| (at, low));
                    let high = part.iter().rev().map(|&(at, [_, high])| (at, high));
                    let _ = writeln!(svg, "<path d=\"{}Z\" {ink}/>", path(x, y, low.chain(high)));
                }
            }
            Layer::Curve(points, stroke) => {
                let ink = sheet.ink(Ink::Line(*stroke));
                for part in known(points) {
                    let _ = writeln!(svg, "<path d=\"{}\" {ink}/>", path(x, y, part.into_iter()));
                }
            }
            Layer::Points(points) => circles(svg, x, y, points, sheet, held),
            Layer::Mark(value, _) => {
                let _ = writeln!(svg, "<path d=\"M{left} {:.1}H{far}\" {}/>", y.at(*value), sheet.ink(Ink::Mark));
            }
            Layer::End(..) => {}
        }
    }
}

/// Splits a curve into stretches of known points.
fn known<T: Copy>(points: &[(f64, Option<T>)]) -> Vec<Vec<(f64, T)>> {
    let stretches = points.chunk_by(|a, b| a.1.is_some() == b.1.is_some());
    let inside = |part: &[(f64, Option<T>)]| part.iter().filter_map(|&(at, value)| Some((at, value?))).collect();
    stretches.map(inside).filter(|part: &Vec<_>| !part.is_empty()).collect()
}

fn path(x: &Ruler, y: &Ruler, points: impl Iterator<Item = (f64, f64)>) -> String {
    let points: Vec<String> = points.map(|(at, value)| format!("{:.1} {:.1}", x.at(at), y.at(value))).collect();
    format!("M{}", points.join("L"))
}

fn circles(svg: &mut String, x: &Ruler, y: &Ruler, points: &[PlotPoint], sheet: &Sheet, held: &[[f64; 4]]) {
    let [left, _, above, below] = sheet.margin;
    let place = |point: &PlotPoint| [x.at(point.at[0]), y.at(point.at[1])];
    let named: Vec<&PlotPoint> = points.iter().filter(|point| !point.name.is_empty()).collect();
    let names: Vec<([f64; 2], &str)> = named.iter().map(|point| (place(point), point.name.as_str())).collect();
    // A page may leave names out, because its table has them too.
    let labels = placed(&names, [left, sheet.width - 5.0, above - 12.0, sheet.height - below], held, !sheet.page);
    for Label { x, y, of: [from, top], point, .. } in labels.iter().filter(|label| label.far) {
        // The lead ends at the middle of the text's height, where the text begins or ends.
        let (to, [.., ink]) = (y - 4.0, sheet.of_point(named[*point]));
        let _ = writeln!(svg, "<path d=\"M{from:.1} {top:.1}L{x:.1} {to:.1}\" {ink}/>");
    }
    for point in points {
        let ([at, height], [ink, ..]) = (place(point), sheet.of_point(point));
        let circle = format!("circle cx=\"{at:.1}\" cy=\"{height:.1}\" r=\"4\" {ink}");
        let _ = match point.tip.as_str() {
            "" => writeln!(svg, "<{circle}/>"),
            tip => writeln!(svg, "<{circle}><title>{}</title></circle>", escaped(tip)),
        };
    }
    for Label { x, y, ends, point, text, .. } in labels {
        let ([_, ink, _], anchor) = (sheet.of_point(named[point]), if ends { " text-anchor=\"end\"" } else { "" });
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" {ink}{anchor}>{}</text>", escaped(&text));
    }
}
