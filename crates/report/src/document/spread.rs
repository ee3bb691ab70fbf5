//! Distribution of a value as SVG in a page, whose style sheet has the colours.

use std::fmt::Write;

use crate::document::chart::SpreadChart;
use crate::document::number::{beside, plain, power_of_ten, unsigned_zero};
use crate::document::svg::escaped;
use sensitol::simulation::Histogram;

/// Height of the density, in px.
const TALL: f64 = 150.0;
/// Distance between the density and the labels above, in px.
const ROOM: f64 = 8.0;
/// Height of a row of labels, in px.
const ROW: f64 = 14.0;
/// Height of the numbers at the axis, in px.
const NUMBERS: f64 = 22.0;
/// Height of a range below the axis, in px.
const RANGE: f64 = 18.0;
/// Width of a letter of a label (11.5 px font), in px. It is on the safe side for bold digits of a wide font.
const LETTER: f64 = 8.0;
/// Least distance between two labels, in px.
const APART: f64 = 6.0;
/// Greatest distance of a drawn range from the density, in extents of the density. A farther one would compress the density.
const FAR: f64 = 1.0;

/// Size of one of the two drawings of a figure. Text keeps its size, so the narrow one has fewer labels.
struct Frame {
    class: &'static str,
    width: f64,
    ticks: usize,
    points: usize,
}

/// Sizes of the drawings. A page shows the one that fits.
const FRAMES: [Frame; 2] = [
    Frame { class: "wide", width: 736.0, ticks: 8, points: 180 },
    Frame { class: "narrow", width: 358.0, ticks: 4, points: 110 },
];

/// A horizontal scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) from: f64,
    pub(crate) to: f64,
    width: f64,
}

impl Extent {
    /// Returns the extent of these values with a margin. Returns None if all are equal.
    pub(crate) fn over(values: impl Iterator<Item = f64>, margin: f64, width: f64) -> Option<Self> {
        let (least, most) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
        let extent = most - least;
        (extent > 0.0 && extent.is_finite()).then_some(Self {
            from: least - margin * extent,
            to: most + margin * extent,
            width,
        })
    }

    pub(crate) fn at(&self, value: f64) -> f64 {
        let share = (value - self.from) / (self.to - self.from);
        (1e3 * self.width * share).round() / 1e3
    }

    /// Returns round numbers along the scale, about `most` of them.
    fn ticks(&self, most: usize) -> Vec<Tick> {
        let raw = (self.to - self.from) / most as f64;
        let decade = power_of_ten(libm::log10(raw).floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade).into_iter().find(|&step| step >= raw);
        let step = step.unwrap_or(10.0 * decade);
        let first = (self.from / step).ceil();
        let decimals = (-libm::log10(step).floor()).max(0.0) as usize;
        (0..=2 * most)
            .map(|i| (first + i as f64) * step)
            .take_while(|&value| value <= self.to)
            .map(|value| {
                let label = if decimals > 9 || value.abs() >= 1e9 {
                    plain(value)
                } else {
                    unsigned_zero(format!("{value:.decimals$}"))
                };
                Tick { x: self.at(value), label }
            })
            .collect()
    }
}

struct Tick {
    x: f64,
    label: String,
}

fn total(bins: &Histogram) -> f64 {
    bins.counts.iter().sum::<u64>() as f64
}

/// Returns the density of a bar. Intervals may differ in width, so heights are densities.
fn density(bins: &Histogram, i: usize, count: f64) -> f64 {
    count / total(bins) / (bins.edges[i + 1] - bins.edges[i])
}

/// Returns the standard error of a count, as that of a binomial share.
fn error(bins: &Histogram, count: u64) -> f64 {
    (count as f64 * (1.0 - count as f64 / total(bins))).sqrt()
}

fn densest(bins: &Histogram) -> f64 {
    let tops = bins.counts.iter().enumerate().map(|(i, &count)| density(bins, i, count as f64 + error(bins, count)));
    tops.filter(|density| density.is_finite()).fold(0.0, f64::max)
}

/// Interpolates a tabulated density linearly. Returns 0 beyond the table.
fn between(curve: &[[f64; 2]], x: f64) -> f64 {
    let after = curve.partition_point(|[at, _]| *at < x);
    match (after.checked_sub(1).and_then(|before| curve.get(before)), curve.get(after)) {
        (Some([a, low]), Some([b, high])) => low + (high - low) * (x - a) / (b - a),
        (None, Some([at, density])) if *at == x => *density,
        _ => 0.0,
    }
}

/// Side of a label relative to its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Before,
    Over,
    After,
}

struct Label {
    class: &'static str,
    text: String,
    left: f64,
    row: usize,
    side: Side,
}

/// Rows of labels without overlap, each label as near to its place as the width allows.
#[derive(Default)]
struct Labels(Vec<Label>);

impl Labels {
    fn put(&mut self, class: &'static str, text: String, (x, side): (f64, Side), width: f64) {
        let wide = LETTER * text.chars().count() as f64;
        let left = match side {
            Side::Before => x - wide - APART,
            Side::Over => x - 0.5 * wide,
            Side::After => x + APART,
        };
        let left = left.min(width - wide).max(0.0);
        // The reserved width fits the widest font. Other fonts leave space around the text.
        let free = |row: usize| {
            self.0.iter().filter(|one| one.row == row).all(|one| {
                let end = one.left + LETTER * one.text.chars().count() as f64;
                left + wide + APART <= one.left || end + APART <= left
            })
        };
        let row = (0..=self.0.len()).find(|&row| free(row)).unwrap_or(0);
        self.0.push(Label { class, text, left, row, side });
    }

    fn rows(&self) -> usize {
        self.0.iter().map(|one| one.row + 1).max().unwrap_or(0)
    }

    fn svg(&self) -> String {
        let text = |one: &Label| {
            let (y, wide) = (ROW * (one.row + 1) as f64 - 3.0, LETTER * one.text.chars().count() as f64);
            let (part, anchor) = match one.side {
                Side::Before => (1.0, " text-anchor=\"end\""),
                Side::Over => (0.5, " text-anchor=\"middle\""),
                Side::After => (0.0, ""),
            };
            let (class, x, text) = (one.class, one.left + part * wide, escaped(&one.text));
            format!("<text class=\"{class}\" x=\"{x:.1}\" y=\"{y}\"{anchor}>{text}</text>\n")
        };
        self.0.iter().map(text).collect()
    }
}

/// Draws a figure with marks at the places within the drawn extent. Returns None if there is neither
/// density nor sample, or if the extent is zero.
pub(super) fn figure(of: &SpreadChart) -> Option<String> {
    let drawn: Option<String> = FRAMES.iter().map(|frame| drawing(of, frame)).collect();
    let key = |class: &str, name: &str| format!("<li class=\"{class}\">{}</li>", escaped(name));
    let quantiles = of.places.iter().filter(|place| place.1 == "quantile");
    let sigma = of.sigma.abs();
    let named = quantiles.map(|(x, kind, name)| {
        let near = if sigma > 0.0 { sigma } else { 1e-3 * x.abs() };
        key(kind, &format!("{name} {}", beside(*x, near)))
    });
    let legend: String = named.collect();
    let legend = if legend.is_empty() { legend } else { format!(" <ul class=\"legend\">{legend}</ul>") };
    Some(format!("<figure>\n{}<figcaption>{}{legend}</figcaption>\n</figure>\n", drawn?, escaped(&of.words)))
}

/// Text of the chart for screen readers.
fn said(of: &SpreadChart) -> String {
    let near = of.sigma.abs();
    let number = |x: f64| if near > 0.0 { beside(x, near) } else { plain(x) };
    let mut parts = vec![of.label.clone()];
    parts.extend(of.places.iter().map(|(x, _, name)| format!("{name} {}", number(*x))));
    for (limit, name, rejected) in
        [(of.limits[0], "lower limit", &of.rejects[0]), (of.limits[1], "upper limit", &of.rejects[1])]
    {
        let beyond = rejected.as_ref().map(|rejected| format!(" with {rejected} beyond it")).unwrap_or_default();
        parts.extend(limit.map(|limit| format!("{name} {}{beyond}", plain(limit))));
    }
    parts.extend(of.ranges.iter().map(|(name, _, [from, to])| format!("{name} {from} to {to}")));
    parts.join(", ")
}

fn drawing(of: &SpreadChart, frame: &Frame) -> Option<String> {
    let (law, limits, width) = (of.law.as_ref(), of.limits, frame.width);
    let bins = of.bins.as_ref().filter(|bins| bins.counts.len() > 1 && total(bins) > 0.0);
    let curve = of.curve.as_deref().filter(|curve| curve.len() > 1);
    let of_law = match curve {
        Some([[from, _], .., [to, _]]) => Some([*from, *to]),
        _ => law.map(|law| [law.quantile(1e-4), law.upper_quantile(1e-4)]),
    };
    let of_bins = bins.map(|bins| [bins.edges[0], bins.edges[bins.counts.len()]]);
    let extents = || of_law.into_iter().chain(of_bins);
    let [low, high] = extents().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
    let near = |x: &f64| *x - high < FAR * (high - low) && low - *x < FAR * (high - low);
    let ranges: Vec<&(String, [f64; 2], [String; 2])> =
        of.ranges.iter().filter(|range| range.1.iter().all(near)).collect();
    let others = limits.into_iter().flatten().chain(of.nominal).filter(near);
    let ends = [low, high].into_iter().chain(others).chain(ranges.iter().flat_map(|range| range.1));
    let scale = Extent::over(ends, 0.02, width)?;
    let place = |i: usize| scale.from + (scale.to - scale.from) * i as f64 / frame.points as f64;
    let along =
        |of: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> { (0..=frame.points).map(|i| (place(i), of(place(i)))).collect() };
    // Main curve: the tabulated density, or the Pearson fit if there is none. The Pearson fit is drawn beside a table.
    let best = |x: f64| match curve {
        Some(curve) => between(curve, x),
        None => law.map_or(f64::NAN, |law| law.pdf(x)),
    };
    let points = if law.is_some() || curve.is_some() { along(&best) } else { Vec::new() };
    let fit = law.filter(|_| curve.is_some()).map(|law| along(&|x| law.pdf(x)));
    let marked = |x: f64| x >= scale.from && x <= scale.to;
    let unit = if of.sigma > 0.0 { of.sigma } else { high - low };
    let mut labels = Labels::default();
    for (limit, rejected, name, side, inside) in [
        (limits[0], &of.rejects[0], "lower", Side::Before, Side::After),
        (limits[1], &of.rejects[1], "upper", Side::After, Side::Before),
    ] {
        let Some(limit) = limit.filter(|limit| marked(*limit)) else { continue };
        let x = scale.at(limit);
        labels.put("name", format!("{name} {}", plain(limit)), (x, inside), width);
        if let Some(rejected) = rejected {
            // If there is no space beyond the limit, the text stands inside it and names the side.
            let wide = LETTER * rejected.chars().count() as f64 + APART;
            let (text, side) = match (name, x) {
                ("lower", x) if x < wide => (format!("{rejected} below"), inside),
                ("upper", x) if x + wide > width => (format!("{rejected} above"), inside),
                _ => (rejected.clone(), side),
            };
            labels.put("rejected", text, (x, side), width);
        }
    }
    let mean = of.places.iter().find(|place| place.1 == "mean").filter(|place| marked(place.0));
    if let Some((x, _, name)) = mean {
        labels.put("of-mean", format!("{name} {}", beside(*x, unit)), (scale.at(*x), Side::Over), width);
    }
    let top = ROW * labels.rows() as f64 + ROOM;
    let base = top + TALL;
    // A density that is infinite at an end is cut off.
    let finite = points.iter().map(|&(_, density)| density).filter(|density| density.is_finite());
    let usual = of_law.map_or(f64::INFINITY, |[low, high]| 24.0 / (high - low));
    let most = finite.fold(0.0, f64::max).min(usual).max(bins.map_or(0.0, densest));
    let height = |density: f64| (1e2 * TALL * (density / most).min(1.0)).round() / 1e2;
    let path = |points: &[(f64, f64)]| {
        let mut path = String::new();
        for (i, &(x, density)) in points.iter().enumerate() {
            let y = base - height(density);
            let _ = write!(path, "{}{:.1} {y:.1}", if i == 0 { "M" } else { "L" }, scale.at(x));
        }
        path
    };
    let area = |from: f64, to: f64| {
        let (from, to) = (from.max(scale.from), to.min(scale.to));
        (from < to && bins.is_none() && !points.is_empty()).then(|| {
            let mut inside = vec![(from, best(from))];
            inside.extend(points.iter().filter(|(x, _)| *x > from && *x < to));
            inside.push((to, best(to)));
            format!("{}L{:.1} {base}L{:.1} {base}Z", path(&inside), scale.at(to), scale.at(from))
        })
    };
    let tall = base + NUMBERS + RANGE * ranges.len() as f64;
    let mut svg = format!(
        "<svg class=\"density {}\" viewBox=\"0 0 {width} {tall}\" role=\"img\" aria-label=\"{}\">\n",
        frame.class,
        escaped(&said(of))
    );
    let line = (!points.is_empty()).then(|| path(&points));
    if let (Some(line), None) = (&line, bins) {
        let _ = writeln!(svg, "<path class=\"area\" d=\"{line}L{width} {base}L0 {base}Z\"/>");
    }
    let [lower, upper] = limits;
    let beyond =
        [lower.and_then(|lower| area(f64::NEG_INFINITY, lower)), upper.and_then(|upper| area(upper, f64::INFINITY))];
    for area in beyond.into_iter().flatten() {
        let _ = writeln!(svg, "<path class=\"beyond\" d=\"{area}\"/>");
    }
    let outside = |x: f64| lower.is_some_and(|lower| x < lower) || upper.is_some_and(|upper| x > upper);
    for (bins, (i, &count)) in bins.iter().flat_map(|bins| bins.counts.iter().enumerate().map(move |bar| (bins, bar))) {
        let (x, to) = (scale.at(bins.edges[i]), scale.at(bins.edges[i + 1]));
        let (number, error) = (count as f64, error(bins, count));
        let tall = height(density(bins, i, number));
        let [low, high] = [-1.0, 1.0].map(|side| base - height(density(bins, i, (number + side * error).max(0.0))));
        let class = if outside(0.5 * (bins.edges[i] + bins.edges[i + 1])) { "bin out" } else { "bin" };
        let (y, wide, middle) = (base - tall, (to - x).max(0.1), 0.5 * (x + to));
        let _ =
            write!(svg, "<rect class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{wide:.1}\" height=\"{tall:.1}\"/>");
        let _ = writeln!(svg, "<path class=\"error\" d=\"M{middle:.1} {low:.1}V{high:.1}\"/>");
    }
    let foot = base + RANGE * ranges.len() as f64;
    for (x, kind, name) in of.places.iter().filter(|place| marked(place.0)) {
        let (at, label) = (scale.at(*x), format!("{name} {}", beside(*x, unit)));
        let _ = writeln!(svg, "<path class=\"{kind}\" d=\"M{at:.1} {top}V{base}\"><title>{label}</title></path>");
    }
    if let Some(fit) = &fit {
        let _ = writeln!(svg, "<path class=\"fit\" d=\"{}\"><title>Pearson fit</title></path>", path(fit));
    }
    if let Some(line) = &line {
        let _ = writeln!(svg, "<path class=\"line\" d=\"{line}\"/>");
    }
    for (limit, name) in [(lower, "lower limit"), (upper, "upper limit")] {
        if let Some(limit) = limit.filter(|limit| marked(*limit)) {
            let (at, label) = (scale.at(limit), format!("{name} {}", plain(limit)));
            let _ = writeln!(
                svg,
                "<path class=\"limit\" d=\"M{at:.1} 0V{}\"><title>{label}</title></path>",
                foot + NUMBERS
            );
        }
    }
    let _ = writeln!(svg, "<path class=\"axis\" d=\"M0 {base}H{width}\"/>");
    let mut end = f64::NEG_INFINITY;
    for Tick { x, label } in scale.ticks(frame.ticks) {
        let _ = write!(svg, "<path class=\"axis\" d=\"M{x:.1} {base}v4\"/>");
        let half = 0.5 * LETTER * label.chars().count() as f64;
        if x - half < end.max(0.0) || x + half > width {
            continue;
        }
        end = x + half + APART;
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", base + 17.0);
    }
    if let Some(nominal) = of.nominal.filter(|nominal| marked(*nominal)) {
        let at = scale.at(nominal);
        let _ = writeln!(
            svg,
            "<path class=\"nominal\" d=\"M{at:.1} {}l-4 7h8z\"><title>nominal {}</title></path>",
            base + 1.0,
            beside(nominal, unit)
        );
    }
    for (row, (name, [from, to], _)) in ranges.into_iter().enumerate() {
        svg += &range(&scale, limits, (name, [*from, *to]), base + NUMBERS + RANGE * (row as f64 + 0.5));
    }
    svg += &labels.svg();
    Some(svg + "</svg>\n")
}

/// Draws a range as a dimension line, with its name in a gap of the line or beside it. The part beyond a limit stands out.
fn range(scale: &Extent, limits: [Option<f64>; 2], (name, [from, to]): (&str, [f64; 2]), y: f64) -> String {
    let [a, b] = [scale.at(from), scale.at(to)];
    let wide = LETTER * name.chars().count() as f64 + APART;
    let mut svg = String::new();
    let (text, line) = if b - a > wide + 24.0 {
        let middle = 0.5 * (a + b);
        let (before, after) = (middle - 0.5 * wide, middle + 0.5 * wide);
        ((middle, " text-anchor=\"middle\""), format!("M{a:.1} {y}H{before:.1}M{after:.1} {y}H{b:.1}"))
    } else {
        let text = if b + wide < scale.width { b + APART } else { (a - wide).max(0.0) };
        ((text, ""), format!("M{a:.1} {y}H{b:.1}"))
    };
    let _ = writeln!(svg, "<path class=\"range\" d=\"{line}M{a:.1} {}v8M{b:.1} {}v8\"/>", y - 4.0, y - 4.0);
    let [lower, upper] = limits.map(|limit| limit.map(|limit| scale.at(limit)));
    // Least visible length, in px: shorter parts are rounding.
    const SEEN: f64 = 0.5;
    for [from, to] in [lower.map(|lower| [a, b.min(lower)]), upper.map(|upper| [a.max(upper), b])].into_iter().flatten()
    {
        if to - from > SEEN {
            let _ = writeln!(svg, "<path class=\"over\" d=\"M{from:.1} {y}H{to:.1}\"/>");
        }
    }
    let (x, anchor) = text;
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{:.1}\"{anchor}>{}</text>", y + 4.0, escaped(name));
    svg
}
