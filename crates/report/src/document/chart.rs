//! Charts as data.

use crate::document::Line;
use sensitol::simulation::Histogram;
use sensitol_numeric::pearson::Pearson;

/// A drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum Chart {
    /// Curves and points over an axis.
    Plot(Plot),
    /// Distribution of a value.
    Spread(Box<SpreadChart>),
    /// Bars side by side.
    Bars(Bars),
}

/// Bars on one scale from 0 to 100.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bars {
    /// Caption, for readers who do not see the bars.
    pub caption: String,
    /// Rows, a bar each.
    pub rows: Vec<Bar>,
    /// Positions of the limits, marked on every bar.
    pub marks: Vec<f64>,
    /// Meaning of each fill.
    pub legend: Vec<(Fill, &'static str)>,
}

/// A bar of several parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Name of the row.
    pub name: String,
    /// Parts of the bar: fill, and its beginning and width.
    pub parts: Vec<(Fill, [f64; 2])>,
    /// Printed amount.
    pub text: String,
    /// Remark beside the amount.
    pub remark: Line,
}

/// Fill of a part of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fill {
    /// The amount itself.
    Linear,
    /// An interval within the limits.
    Span,
    /// An interval that exceeds the limits.
    Over,
    /// The amount before a change, in the upper half of the row.
    Before,
    /// The amount after a change, in the lower half of the row.
    After,
}

/// Distribution of a value: a density, a histogram, or one over the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpreadChart {
    /// Pearson density.
    pub law: Option<Pearson>,
    /// More accurate density as `[value, density]` at evenly spaced values. `law` is then a thin line beside it.
    pub curve: Option<Vec<[f64; 2]>>,
    /// Histogram of a sample.
    pub bins: Option<Histogram>,
    /// True if a terminal shows the histogram instead of the density.
    pub sampled: bool,
    /// Lower and upper limit.
    pub limits: [Option<f64>; 2],
    /// Text of the rejects beyond each limit.
    pub rejects: [Option<String>; 2],
    /// Ranges below the axis of a page: name, ends, and the ends as printed.
    pub ranges: Vec<(String, [f64; 2], [String; 2])>,
    /// Value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// Places that are marked on pages: value, kind (`mean` or `quantile`), name.
    pub places: Vec<(f64, &'static str, &'static str)>,
    /// Standard deviation, which sets the printed digits.
    pub sigma: f64,
    /// Label, for readers who do not see the chart.
    pub label: String,
    /// Name of `curve`, for the legend.
    pub curve_name: String,
    /// Name of `law`, for the legend.
    pub law_name: String,
}

/// Curves and points over a horizontal axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Subject of the plot.
    pub name: String,
    /// Horizontal axis.
    pub x: PlotAxis,
    /// Vertical axis.
    pub y: PlotAxis,
    /// The layers, drawn one over the other.
    pub layers: Vec<Layer>,
    /// Meaning of the lines and points, printed below the plot on a page.
    pub words: String,
}

/// An axis. It extends over everything that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotAxis {
    /// The label of the axis.
    pub label: String,
    /// Linear or logarithmic scale.
    pub scale: PlotScale,
    /// Values with their labels; if empty, round numbers are chosen.
    pub ticks: Vec<(f64, String)>,
}

/// The scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlotScale {
    /// Even steps. The number is the margin, as a part of the extent.
    Linear(f64),
    /// Whole powers of ten.
    Decades,
}

/// A drawn element of a plot.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// An area between two values, with a gap if they are unknown.
    Band(Vec<(f64, Option<[f64; 2]>)>),
    /// A line, with a gap if its value is unknown.
    Curve(Vec<(f64, Option<f64>)>, Stroke),
    /// Circles.
    Points(Vec<PlotPoint>),
    /// A dashed horizontal line, with a name beside the chart.
    Mark(f64, &'static str),
    /// A name beside the chart, at this height.
    End(f64, &'static str),
}

/// Kind of line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// The main curve.
    Strong,
    /// The lines that join points.
    Thin,
    /// The curve to compare with, dotted.
    Dotted,
}

/// A circle of a plot.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotPoint {
    /// Horizontal and vertical value.
    pub at: [f64; 2],
    /// Name beside the circle; empty for none.
    pub name: String,
    /// Text shown under the mouse pointer; empty for none.
    pub tip: String,
    /// True if the point is emphasised.
    pub strong: bool,
    /// True if the circle is filled.
    pub filled: bool,
}

impl PlotAxis {
    /// Returns an axis with round numbers.
    pub fn new(label: impl Into<String>, scale: PlotScale) -> Self {
        Self { label: label.into(), scale, ticks: Vec::new() }
    }
}

impl Plot {
    /// Returns all drawn values along the horizontal axis (0) or the vertical one (1).
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
