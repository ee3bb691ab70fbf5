//! Sheet of a drawing: the view that fits it, its marks as paths, and its labels with the least overlap.

use std::fmt::Write;

use super::camera::{Camera, Projection, ViewAngles};
use super::drawing::{Drawing, DrawnMark, DrawnPoint, MarkForm};
use crate::document::svg::escaped;

/// Size of a sheet in pixels. The script of the page has the same margins.
#[derive(Debug, Clone, Copy)]
pub(super) struct SheetSize {
    pub(super) class: &'static str,
    pub(super) width: f64,
    /// Least and greatest height.
    pub(super) height: [f64; 2],
    /// Space for labels on each side.
    pub(super) margin: f64,
}

/// The wide and the narrow sheet of a page, so that text keeps its size.
pub(super) const SHEETS: [SheetSize; 2] = [
    SheetSize { class: "wide", width: 736.0, height: [300.0, 460.0], margin: 64.0 },
    SheetSize { class: "narrow", width: 358.0, height: [250.0, 340.0], margin: 44.0 },
];
/// Width of a letter of a label, in pixels.
const LETTER: f64 = 6.4;
/// Height of a label, and diameter of a balloon, in pixels.
const TALL: f64 = 20.0;
/// Distances of a label from its place that are tried, in pixels.
const DISTANCES: [f64; 5] = [22.0, 34.0, 48.0, 66.0, 88.0];
/// Turns of a label about its place that are tried, in steps of 30 degrees, the nearest to its direction first.
const TURNS: [f64; 12] = [0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.0, -4.0, 5.0, -5.0, 6.0];
/// Length and half width of an arrow head, in pixels.
const HEAD: [f64; 2] = [8.0, 2.8];
/// Length of a dimension line in pixels below which a cross replaces it.
const SHORT: f64 = 7.0;
/// Middle of the small axes from the lower left corner, and their length, in pixels.
const AXES: [f64; 2] = [34.0, 24.0];

/// Kind of a label.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LabelKind {
    /// A number in a circle, as on assembly drawings.
    Balloon,
    Measure,
    Part,
}

/// Label with the place to which it belongs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SheetLabel {
    pub(super) kind: LabelKind,
    pub(super) text: String,
    /// Points in whose middle it belongs.
    pub(super) at: Vec<DrawnPoint>,
}

/// A sheet with its projection.
#[derive(Debug, Clone, Copy)]
pub(super) struct AssemblySheet {
    pub(super) size: SheetSize,
    pub(super) height: f64,
    pub(super) projection: Projection,
}

/// Number of a drawing, with one decimal.
fn number(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn pair([x, y]: [f64; 2]) -> String {
    format!("{} {}", number(x), number(y))
}

/// View from which a drawing shows most: from the front, above and to the right. Of a flat drawing it is nearly along the normal.
pub(super) fn default_view(drawing: &Drawing) -> ViewAngles {
    let points = || drawing.marks.iter().flat_map(|mark| mark.points.iter().map(|point| point.at));
    let reach = [0, 1, 2].map(|i| {
        let values = points().map(|point| point[i]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    });
    let largest = reach.iter().copied().fold(0.0, f64::max);
    let is_flat = |axis: usize| reach[axis] < FLAT * largest;
    match (is_flat(0), is_flat(1), is_flat(2)) {
        (false, false, true) => ViewAngles { azimuth: -70.0, elevation: 55.0 },
        (_, true, _) => ViewAngles { azimuth: -72.0, elevation: 14.0 },
        (true, ..) => ViewAngles { azimuth: -18.0, elevation: 14.0 },
        _ => ViewAngles { azimuth: -60.0, elevation: 24.0 },
    }
}

/// Extent along an axis, over the largest one, below which a drawing is flat.
const FLAT: f64 = 0.3;

impl AssemblySheet {
    /// Sheet on which a drawing fits from this view.
    pub(super) fn fitting(drawing: &Drawing, size: SheetSize, view: ViewAngles) -> Self {
        let camera = Camera::of(view);
        let mut ends = [[f64::MAX, f64::MIN]; 2];
        for mark in &drawing.marks {
            let radius = match mark.form {
                MarkForm::Sides(radius) | MarkForm::Ball(radius) => radius,
                _ => 0.0,
            };
            for point in &mark.points {
                let flat = camera.flat(point.at);
                for (end, value) in ends.iter_mut().zip(flat) {
                    *end = [end[0].min(value - radius), end[1].max(value + radius)];
                }
            }
        }
        let [width, height] = ends.map(|[low, high]| (high - low).max(1.0));
        let inside = [size.width - 2.0 * size.margin, size.height[1] - 2.0 * size.margin];
        let scale = (inside[0] / width).min(inside[1] / height);
        let tall = (scale * height + 2.0 * size.margin).clamp(size.height[0], size.height[1]).round();
        let middle = [0.5 * size.width, 0.5 * tall];
        let off = |i: usize| middle[i] - scale * 0.5 * (ends[i][0] + ends[i][1]);
        Self { size, height: tall, projection: Projection { camera, scale, middle: [off(0), off(1)] } }
    }

    /// Text of a mark's path.
    pub(super) fn path(&self, mark: &DrawnMark) -> String {
        let at = |index: usize| self.projection.at(mark.points[index].at);
        match &mark.form {
            MarkForm::Path(letters) => {
                let mut text = String::new();
                let mut next = 0;
                for letter in letters.chars() {
                    text.push(letter);
                    let count = match letter {
                        'C' => 3,
                        'Z' => 0,
                        _ => 1,
                    };
                    let points: Vec<String> = (next..next + count).map(|index| pair(at(index))).collect();
                    text += &points.join(" ");
                    next += count;
                }
                text
            }
            MarkForm::Sides(radius) => {
                let (a, b) = (at(0), at(1));
                let across = [b[0] - a[0], b[1] - a[1]];
                let length = libm::hypot(across[0], across[1]);
                if length < 0.5 {
                    return String::new();
                }
                let by = radius * self.projection.scale / length;
                let side = [-across[1] * by, across[0] * by];
                let moved = |point: [f64; 2], sign: f64| pair([point[0] + sign * side[0], point[1] + sign * side[1]]);
                format!("M{}L{}M{}L{}", moved(a, 1.0), moved(b, 1.0), moved(a, -1.0), moved(b, -1.0))
            }
            MarkForm::Ball(radius) => disc(at(0), radius * self.projection.scale),
            MarkForm::Dot(radius) => disc(at(0), *radius),
            MarkForm::Diamond => {
                let [x, y] = at(0);
                format!("M{}l5 5-5 5-5-5z", pair([x, y - 5.0]))
            }
            MarkForm::Dimension => dimension(at(0), at(1)),
        }
    }

    /// Labels at places where they do not overlap, each with the place to which it belongs and the middle of its box.
    pub(super) fn placed<'l>(&self, labels: &'l [SheetLabel]) -> Vec<(&'l SheetLabel, [f64; 2], [f64; 2])> {
        let middle = [0.5 * self.size.width, 0.5 * self.height];
        let mut taken: Vec<[f64; 4]> = vec![[0.0, self.height - 68.0, 68.0, self.height]];
        taken.extend(labels.iter().filter(|label| label.kind != LabelKind::Part).map(|label| {
            let [x, y] = self.projection.at(label.place());
            [x - 4.0, y - 4.0, x + 4.0, y + 4.0]
        }));
        let mut placed = Vec::with_capacity(labels.len());
        for label in labels {
            let at = self.projection.at(label.place());
            let wide = label.wide();
            let outward = libm::atan2(at[1] - middle[1], at[0] - middle[0]);
            let mut best = (f64::MAX, at);
            for distance in DISTANCES {
                for turn in TURNS {
                    let angle = outward + turn * std::f64::consts::PI / 6.0;
                    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
                    let x = at[0] + cosine * (distance + 0.5 * (wide - TALL));
                    let middle = [x, at[1] + sine * distance];
                    let cost = self.overlap(boxed(middle, wide), &taken);
                    if cost < best.0 - 1e-9 {
                        best = (cost, middle);
                    }
                }
            }
            taken.push(boxed(best.1, wide));
            placed.push((label, at, best.1));
        }
        placed
    }

    /// Area of a box that others have taken, or that lies outside of the sheet.
    fn overlap(&self, own: [f64; 4], taken: &[[f64; 4]]) -> f64 {
        let common = |other: &[f64; 4]| {
            let wide = own[2].min(other[2]) - own[0].max(other[0]);
            let tall = own[3].min(other[3]) - own[1].max(other[1]);
            if wide > 0.0 && tall > 0.0 { wide * tall } else { 0.0 }
        };
        let inside = common(&[2.0, 2.0, self.size.width - 2.0, self.height - 2.0]);
        let whole = (own[2] - own[0]) * (own[3] - own[1]);
        // A label outside of the sheet is worse than one over another.
        taken.iter().map(common).sum::<f64>() + 4.0 * (whole - inside)
    }

    /// Markup of all labels.
    pub(super) fn labels(&self, labels: &[SheetLabel]) -> String {
        let mut text = String::new();
        for (label, at, middle) in self.placed(labels) {
            let words = escaped(&label.text);
            let [x, y] = middle.map(number);
            let (class, lead) = match label.kind {
                LabelKind::Balloon => (
                    "balloon",
                    format!("<path d=\"M{}L{}\"/><circle cx=\"{x}\" cy=\"{y}\" r=\"10\"/>", pair(at), pair(middle)),
                ),
                LabelKind::Measure => ("of-measure", String::new()),
                LabelKind::Part => ("of-part", String::new()),
            };
            let base = number(middle[1] + 4.0);
            let _ = write!(
                text,
                "<g class=\"{class}\">{lead}<text x=\"{x}\" y=\"{base}\" text-anchor=\"middle\">{words}</text></g>"
            );
        }
        text
    }

    /// Markup of the small axes in the lower left corner.
    pub(super) fn axes(&self) -> String {
        let mut text = String::new();
        let origin = [AXES[0], self.height - AXES[0]];
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let mut unit = [0.0; 3];
            unit[axis] = 1.0;
            let [x, y] = self.projection.camera.flat(unit);
            let end = [origin[0] + AXES[1] * x, origin[1] + AXES[1] * y];
            let letter = [origin[0] + (AXES[1] + 8.0) * x, origin[1] + (AXES[1] + 8.0) * y + 4.0].map(number);
            let _ = write!(
                text,
                "<path d=\"M{}L{}\"/><text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{name}</text>",
                pair(origin),
                pair(end),
                letter[0],
                letter[1]
            );
        }
        text
    }
}

impl SheetLabel {
    /// Middle of its points.
    fn place(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.at.iter().map(|point| point.at[i]).sum::<f64>() / self.at.len().max(1) as f64)
    }

    /// Width of the label in pixels.
    fn wide(&self) -> f64 {
        match self.kind {
            LabelKind::Balloon => TALL,
            _ => LETTER * self.text.chars().count() as f64 + 8.0,
        }
    }
}

/// Box about a middle, with a margin of a pixel.
fn boxed([x, y]: [f64; 2], wide: f64) -> [f64; 4] {
    let (a, b) = (0.5 * wide + 1.0, 0.5 * TALL + 1.0);
    [x - a, y - b, x + a, y + b]
}

fn disc([x, y]: [f64; 2], radius: f64) -> String {
    let r = number(radius);
    let wide = number(2.0 * radius);
    format!("M{}a{r} {r} 0 1 0 {wide} 0a{r} {r} 0 1 0 -{wide} 0", pair([x - radius, y]))
}

/// Line with arrow heads at both ends. A short one is a cross.
fn dimension(a: [f64; 2], b: [f64; 2]) -> String {
    let across = [b[0] - a[0], b[1] - a[1]];
    let length = libm::hypot(across[0], across[1]);
    if length < SHORT {
        return format!("M{}l10 10m0-10l-10 10", pair([a[0] - 5.0, a[1] - 5.0]));
    }
    let unit = across.map(|part| part / length);
    let long = HEAD[0].min(0.45 * length);
    let head = |end: [f64; 2], sign: f64| {
        let base = [end[0] + sign * long * unit[0], end[1] + sign * long * unit[1]];
        let side = [-HEAD[1] * unit[1], HEAD[1] * unit[0]];
        let corner = |by: f64| pair([base[0] + by * side[0], base[1] + by * side[1]]);
        format!("M{}L{}L{}Z", pair(end), corner(1.0), corner(-1.0))
    };
    format!("M{}L{}{}{}", pair(a), pair(b), head(a, 1.0), head(b, -1.0))
}
