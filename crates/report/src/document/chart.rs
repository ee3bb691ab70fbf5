//! Charts as data.

use super::Line;
use sensitol::simulation::Histogram;
use sensitol_numeric::pearson::Pearson;

/// A drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum Chart {
    /// Values over others.
    Plot(Plot),
    /// How a value is distributed.
    Spread(Box<SpreadChart>),
    /// Amounts beside one another.
    Bars(Bars),
}

/// Amounts beside one another, on one scale from 0 to 100.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bars {
    /// The caption, for readers who do not see the bars.
    pub caption: String,
    /// The bars.
    pub rows: Vec<Bar>,
    /// Places marked on every bar.
    pub marks: Vec<f64>,
    /// The meaning of the fills.
    pub legend: Vec<(Fill, &'static str)>,
}

/// A bar of several parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// The name of its row.
    pub name: String,
    /// Its parts: fill, beginning and width.
    pub parts: Vec<(Fill, [f64; 2])>,
    /// The amount.
    pub text: String,
    /// The remark on it.
    pub remark: Line,
}

/// How a part of a bar is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fill {
    /// The amount itself.
    Linear,
    /// An interval within the limits.
    Span,
    /// An interval that exceeds them.
    Over,
    /// The amount before.
    Before,
}

/// How a value is distributed: a density, a histogram, or one over the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpreadChart {
    /// The density.
    pub law: Option<Pearson>,
    /// A better one, as `[value, density]` at evenly spaced places; `law` is then a thin line beside it.
    pub curve: Option<Vec<[f64; 2]>>,
    /// The histogram.
    pub bins: Option<Histogram>,
    /// Whether a terminal shows the histogram, rather than the density.
    pub sampled: bool,
    /// Lower and upper limit.
    pub limits: [Option<f64>; 2],
    /// The rejects beyond each limit, in words.
    pub rejects: [Option<String>; 2],
    /// Ranges below the axis of a page: name, ends, and the ends as they are shown.
    pub ranges: Vec<(String, [f64; 2], [String; 2])>,
    /// Its value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// Places that are marked on pages: value, kind (`mean` or `quantile`), name.
    pub places: Vec<(f64, &'static str, &'static str)>,
    /// The standard deviation, by which numbers are rounded.
    pub sigma: f64,
    /// The label, for readers who do not see the chart.
    pub label: String,
    /// The text below it.
    pub words: String,
}

/// Values over others.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// The subject.
    pub name: String,
    /// Across.
    pub x: PlotAxis,
    /// Upwards.
    pub y: PlotAxis,
    /// The layers, drawn one over the other.
    pub layers: Vec<Layer>,
    /// The meaning of its lines and points, below it on a page.
    pub words: String,
}

/// An axis. It reaches over everything that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotAxis {
    /// The label of the axis.
    pub label: String,
    /// Its scale.
    pub scale: PlotScale,
    /// Where numbers stand beside it; round ones where there are none.
    pub ticks: Vec<(f64, String)>,
}

/// The scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlotScale {
    /// Even steps, with this part of the extent as margin.
    Linear(f64),
    /// Whole powers of ten.
    Decades,
}

/// Something that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// An area between two values, open where they are unknown.
    Band(Vec<(f64, Option<[f64; 2]>)>),
    /// A line, broken where its value is unknown.
    Curve(Vec<(f64, Option<f64>)>, Stroke),
    /// Circles.
    Points(Vec<PlotPoint>),
    /// A dashed line across, named beside the chart.
    Mark(f64, &'static str),
    /// A name beside the chart.
    End(f64, &'static str),
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// The main curve.
    Strong,
    /// The lines that join points.
    Thin,
    /// The curve to compare with.
    Dotted,
}

/// A circle.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotPoint {
    /// Its place.
    pub at: [f64; 2],
    /// The name beside it; empty where it has none.
    pub name: String,
    /// The text that a pointer shows; empty for none.
    pub tip: String,
    /// Whether it is to be looked at.
    pub strong: bool,
    /// Whether it is filled.
    pub filled: bool,
}

impl PlotAxis {
    /// An axis with round numbers.
    pub fn new(label: impl Into<String>, scale: PlotScale) -> Self {
        Self { label: label.into(), scale, ticks: Vec::new() }
    }
}

impl Plot {
    /// All values along the horizontal axis (0) or the vertical one (1) that are drawn.
    pub(super) fn values(&self, axis: usize) -> Vec<f64> {
        let of = |layer: &Layer| -> Vec<f64> {
            match (layer, axis) {
                (Layer::Band(points), 0) => points.iter().map(|point| point.0).collect(),
                (Layer::Band(points), _) => points.iter().filter_map(|point| point.1).flatten().collect(),
                (Layer::Curve(points, _), 0) => points.iter().map(|point| point.0).collect(),
                (Layer::Curve(points, _), _) => points.iter().filter_map(|point| point.1).collect(),
                (Layer::Points(points), axis) => points.iter().map(|point| point.at[axis]).collect(),
                (Layer::Mark(at, _), 1) => vec![*at],
                (Layer::Mark(..) | Layer::End(..), _) => Vec::new(),
            }
        };
        self.layers.iter().flat_map(of).collect()
    }
}
