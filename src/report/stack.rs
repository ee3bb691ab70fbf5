//! The classic stack-up table of a characteristic: what every dimension contributes, and the usual totals side by side.
//!
//! ```text
//! contribution of a dimension    |b_i| T_i               b_i: direction or slope, T_i: half band, or three sigma without one
//! its share                      (b_i T_i)^2 / sum       of the sum of squares
//! ```
//!
//! A characteristic that is not linear has the table of its tangent at the means, and the table says so. Totals: as
//! [`CharacteristicAnalysis`](crate::CharacteristicAnalysis) defines them, each about its own middle.

use std::fmt;

use super::number::{beside, percent, plain, significant};
use super::page::{Grid, Page, Style, clean, short};
use super::text::tolerance;
use super::{CharacteristicReport, DimensionReport, Report, SensitivityReport};
use crate::method::Method;

/// A slope this near to 1 or -1 is a direction.
const DIRECTION: f64 = 1e-9;
const SIGMAS: f64 = 3.0;
/// A part of a half width that rounding may make.
const ROUNDING: f64 = 1e-9;
/// The longest line of a note.
const LINE: usize = 96;
const UNKNOWN: &str = "?";

/// The stack of one characteristic. What is unknown is None.
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    /// The characteristic.
    pub characteristic: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Its limits.
    pub limits: [Option<f64>; 2],
    /// The dimensions that do something to it, in the study's order.
    pub rows: Vec<StackRow>,
    /// The ways of adding it up, in the order of [`TotalKind`]. Of few dimensions the inflated RSS may exceed the worst case.
    pub totals: Vec<StackTotal>,
    /// What must be known to read it.
    pub notes: Vec<StackNote>,
}

/// One dimension in a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct StackRow {
    /// The dimension.
    pub dimension: DimensionReport,
    /// Lower and upper deviation from the nominal that are stacked: the tolerance, or three sigma about the mean.
    pub deviations: [f64; 2],
    /// The slope at the mean: 1 and -1 are directions.
    pub slope: Option<f64>,
    /// Slope by half band, without sign.
    pub contribution: Option<f64>,
    /// Its part of the sum of squares.
    pub share: Option<f64>,
    pub(super) direction: String,
}

/// One way of adding a stack up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StackTotal {
    /// Which.
    pub kind: TotalKind,
    /// The middle of the interval.
    pub middle: Option<f64>,
    /// Half its width.
    pub half_width: Option<f64>,
}

/// The ways of adding a stack up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TotalKind {
    /// Everything at its worst end.
    WorstCase,
    /// Root of the sum of squares.
    Rss,
    /// 1.5 times that.
    InflatedRss,
    /// RSS with every mean off by half its half band.
    MeanShiftRss,
    /// Three sigma about the mean, of the moments without curvature.
    FirstOrder,
    /// Three sigma about the mean, of the moments.
    SecondOrder,
}

/// What must be known to read a stack.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum StackNote {
    /// It is not linear.
    Curved {
        /// The share of the variance that curvature and interactions have.
        share: f64,
        /// How far curvature moves the mean.
        mean_shift: f64,
    },
    /// The method takes it as linear.
    NotExamined,
    /// It has no curvature, and nobody looked at these many interactions.
    InteractionsNotExamined {
        /// How many.
        count: usize,
    },
    /// Dimensions whose slope is not known.
    SlopeUnknown {
        /// The dimensions.
        dimensions: Vec<String>,
    },
    /// Dimensions that stand with three sigma, for they have no tolerance band.
    ThreeSigma {
        /// The dimensions.
        dimensions: Vec<String>,
    },
    /// Dimensions that do not vary and whose slope nobody asked for.
    Fixed {
        /// The dimensions.
        dimensions: Vec<String>,
    },
    /// Dimensions that vary together.
    Correlated {
        /// The dimensions.
        dimensions: Vec<String>,
    },
    /// Coordinates of one circular zone.
    Zone {
        /// Its name.
        zone: String,
        /// The coordinates.
        dimensions: Vec<String>,
    },
}

impl Report {
    /// The stacks of all its characteristics.
    pub fn stacks(&self) -> Vec<Stack> {
        self.characteristics.iter().map(|one| Stack::of(self, one)).collect()
    }
}

impl Stack {
    fn of(report: &Report, one: &CharacteristicReport) -> Self {
        let pairs = || one.sensitivities.iter().zip(&report.dimensions);
        let rows = pairs().filter(|(row, dimension)| matters(row, dimension));
        let mut rows: Vec<StackRow> =
            rows.map(|(sensitivity, dimension)| StackRow::of(sensitivity, dimension)).collect();
        // Of the sum of squares, which is the squared RSS unless dimensions are correlated; unknown where one slope is.
        let alone: Option<f64> = one
            .rss
            .and(rows.iter().map(|row| row.contribution).try_fold(0.0, |sum, part| Some(f64::hypot(sum, part?))));
        for row in &mut rows {
            row.share =
                row.contribution.zip(alone).map(|(part, all)| if all == 0.0 { 0.0 } else { (part / all).powi(2) });
        }
        let first_order = [Method::Rss, Method::WorstCase].iter().any(|method| method.name() == report.method);
        let worst_case = one.worst_case.linear.map(|[lower, upper]| 0.5 * (upper - lower));
        let about_middle = |kind, half_width| StackTotal { kind, middle: one.middle, half_width };
        let totals = vec![
            about_middle(TotalKind::WorstCase, worst_case),
            about_middle(TotalKind::Rss, one.rss),
            about_middle(TotalKind::InflatedRss, one.inflated_rss),
            about_middle(TotalKind::MeanShiftRss, one.mean_shift_rss),
            StackTotal {
                kind: if first_order { TotalKind::FirstOrder } else { TotalKind::SecondOrder },
                middle: one.mean,
                half_width: one.sigma.map(|sigma| SIGMAS * sigma),
            },
        ];
        Self {
            characteristic: one.name.clone(),
            unit: one.unit.clone(),
            limits: [one.lower, one.upper],
            notes: notes(report, one, &rows),
            rows,
            totals,
        }
    }

    /// Whether the interval of a total lies within the limits, and reaches them at most; None where it or every limit is unknown.
    pub fn keeps(&self, total: &StackTotal) -> Option<bool> {
        // A stack that just reaches a limit keeps it: what rounding adds is no excess.
        let slack = ROUNDING * total.half_width? + 8.0 * f64::EPSILON * total.middle?.abs();
        let [from, to] = total.interval().map(|[from, to]| [from + slack, to - slack])?;
        match self.limits {
            [None, None] => None,
            [lower, upper] => Some(lower.is_none_or(|lower| from >= lower) && upper.is_none_or(|upper| to <= upper)),
        }
    }
}

impl StackTotal {
    /// From where to where it goes.
    pub fn interval(&self) -> Option<[f64; 2]> {
        let (middle, half) = (self.middle?, self.half_width?);
        Some([middle - half, middle + half])
    }
}

impl TotalKind {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::WorstCase => "worst case",
            Self::Rss => "rss",
            Self::InflatedRss => "inflated rss",
            Self::MeanShiftRss => "mean-shift rss",
            Self::FirstOrder => "first order, 3 sigma",
            Self::SecondOrder => "second order, 3 sigma",
        }
    }
}

impl StackRow {
    fn of(sensitivity: &SensitivityReport, dimension: &DimensionReport) -> Self {
        let (shift, reach) = (dimension.mean - dimension.nominal, SIGMAS * dimension.sigma);
        let deviations = dimension.tolerance.unwrap_or([shift - reach, shift + reach]);
        let contribution = sensitivity.first.map(|slope| (0.5 * slope * (deviations[1] - deviations[0])).abs());
        Self {
            dimension: dimension.clone(),
            deviations,
            slope: sensitivity.first,
            contribution,
            share: None,
            direction: direction(sensitivity),
        }
    }
}

/// Whether a dimension belongs into the table: it varies and is not known to do nothing, or is known to do something.
fn matters(row: &SensitivityReport, dimension: &DimensionReport) -> bool {
    let idle = row.first == Some(0.0) && row.second.unwrap_or(0.0) == 0.0;
    !idle && (dimension.sigma > 0.0 || row.first.is_some())
}

/// `+`, `-`, or the slope where it is neither 1 nor -1.
fn direction(row: &SensitivityReport) -> String {
    let Some(slope) = row.first else { return UNKNOWN.to_owned() };
    let rounding = row.rounding.map_or(0.0, |[first, _]| 2.0 * first);
    let near = |value: f64| (slope - value).abs() <= DIRECTION.max(rounding);
    match slope {
        _ if near(1.0) => "+".to_owned(),
        _ if near(-1.0) => "-".to_owned(),
        slope if slope.abs() <= rounding => "0".to_owned(),
        slope => significant(slope, 6).parse().map_or(UNKNOWN.to_owned(), plain),
    }
}

fn notes(report: &Report, one: &CharacteristicReport, rows: &[StackRow]) -> Vec<StackNote> {
    let mut notes = Vec::new();
    let names = |kept: &dyn Fn(&StackRow) -> bool| -> Vec<String> {
        rows.iter().filter(|row| kept(row)).map(|row| row.dimension.name.clone()).collect()
    };
    let lost = names(&|row| row.slope.is_none());
    if !lost.is_empty() {
        notes.push(StackNote::SlopeUnknown { dimensions: lost });
    }
    notes.extend(shape(one, rows));
    let unbanded = names(&|row| row.dimension.tolerance.is_none() && row.dimension.sigma > 0.0);
    if !unbanded.is_empty() {
        notes.push(StackNote::ThreeSigma { dimensions: unbanded });
    }
    let correlated = names(&|row| report.correlation.iter().any(|pair| pair.between.contains(&row.dimension.name)));
    if correlated.len() > 1 {
        notes.push(StackNote::Correlated { dimensions: correlated });
    }
    let zone = |row: &StackRow| row.dimension.zone.clone();
    for (index, name) in rows.iter().enumerate().filter_map(|(index, row)| Some((index, zone(row)?))) {
        let dimensions = names(&|row| row.dimension.zone.as_ref() == Some(&name));
        let first = !rows[..index].iter().any(|row| row.dimension.zone.as_ref() == Some(&name));
        if first && dimensions.len() > 1 {
            notes.push(StackNote::Zone { zone: name, dimensions });
        }
    }
    let fixed: Vec<String> = (one.sensitivities.iter().zip(&report.dimensions))
        .filter(|(row, dimension)| dimension.sigma == 0.0 && row.first.is_none())
        .map(|(row, _)| row.dimension.clone())
        .collect();
    if !fixed.is_empty() {
        notes.push(StackNote::Fixed { dimensions: fixed });
    }
    notes
}

/// What is known of the characteristic's being linear; what rounding alone can make of a derivative is none.
fn shape(one: &CharacteristicReport, rows: &[StackRow]) -> Option<StackNote> {
    let real = |value: Option<f64>, rounding: Option<f64>| match (value, rounding) {
        (Some(value), Some(rounding)) => value.abs() > 2.0 * rounding,
        (value, _) => value.is_some_and(|value| value != 0.0),
    };
    let curved = one.sensitivities.iter().filter(|row| real(row.second, row.rounding.map(|[_, second]| second)));
    let known = curved.clone().all(|row| row.curvature_share.is_some());
    let curvature: f64 = curved.clone().filter_map(|row| row.curvature_share).sum();
    let mean_shift: f64 = curved.clone().filter_map(|row| row.mean_shift).sum();
    let joint = one.interactions.iter().filter(|pair| real(pair.mixed, pair.rounding));
    let interactions: f64 = joint.clone().filter_map(|pair| pair.share).sum();
    let varying =
        |row: &SensitivityReport| rows.iter().any(|of| of.dimension.name == row.dimension && of.dimension.sigma > 0.0);
    let not_examined = one.sensitivities.iter().any(|row| varying(row) && row.curvature_share.is_none());
    if (curved.count() > 0 && known) || joint.count() > 0 {
        return Some(StackNote::Curved { share: curvature + interactions, mean_shift });
    }
    if not_examined {
        return Some(StackNote::NotExamined);
    }
    match one.possible_interactions.saturating_sub(one.interactions.len()) {
        0 => None,
        count => Some(StackNote::InteractionsNotExamined { count }),
    }
}

impl fmt::Display for StackNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |names: &[String]| names.iter().map(|name| short(name)).collect::<Vec<_>>().join(", ");
        match self {
            Self::Curved { share, mean_shift } => write!(
                f,
                "not linear: curvature and the interactions examined have {} % of the variance and move the mean by {}; this is the stack of its \
                 tangent at the means",
                percent(*share),
                significant(*mean_shift, 3)
            ),
            Self::NotExamined => {
                f.write_str("curvature was not examined: this is the stack of its tangent at the means (the method full examines all)")
            }
            Self::InteractionsNotExamined { count } => {
                let which = if *count == 1 { "one interaction".to_owned() } else { format!("{count} interactions") };
                write!(f, "linear, unless an interaction says otherwise: {which} not examined (the method full examines all)")
            }
            Self::SlopeUnknown { dimensions } => write!(f, "without slope, so that the totals are unknown: {}", list(dimensions)),
            Self::ThreeSigma { dimensions } => write!(f, "3 sigma stands for a tolerance of {}", list(dimensions)),
            Self::Fixed { dimensions } => {
                write!(f, "left out, without tolerance: {} (`sensitivities = \"all\"` shows them)", list(dimensions))
            }
            Self::Correlated { dimensions } => {
                write!(f, "{} are correlated: every rss takes that in, shares and worst case do not", list(dimensions))
            }
            Self::Zone { zone, dimensions } => write!(
                f,
                "{} share the circular zone {}: the worst case takes them to its edge, not to the corners of a box",
                list(dimensions),
                short(zone)
            ),
        }
    }
}

/// Stacks as text.
pub fn stack_text(stacks: &[Stack], style: Style) -> String {
    let mut page = Page::new(style);
    for (index, stack) in stacks.iter().enumerate() {
        if index > 0 {
            page.line("");
        }
        page.line(&heading(stack));
        let mut table = Grid::new(["", "direction", "nominal", "tolerance", "", "contribution", "share %"], "<>><<>>");
        for row in &stack.rows {
            table.row(cells(stack, row, short(&row.dimension.name)));
        }
        page.print(&table);
        page.line("");
        let mut totals = Grid::new(["", "middle", "half width", "from", "to", ""], "<>>>><");
        for total in &stack.totals {
            totals.row(total_cells(stack, total));
        }
        page.print(&totals);
        for line in stack.notes.iter().flat_map(|note| wrapped(&note.to_string())) {
            page.line(&format!("  {line}"));
        }
    }
    page.finish()
}

/// Stacks as Markdown tables.
pub fn stack_markdown(stacks: &[Stack]) -> String {
    let line =
        |cells: &[String]| format!("| {} |\n", cells.iter().map(|cell| escaped(cell)).collect::<Vec<_>>().join(" | "));
    let mut text = String::new();
    for (index, stack) in stacks.iter().enumerate() {
        if index > 0 {
            text.push('\n');
        }
        let unit = stack.unit.as_deref().map(|unit| format!(" ({})", escaped(&clean(unit)))).unwrap_or_default();
        let name = escaped(&clean(&stack.characteristic));
        text += &format!("**Stack of {name}**{unit}{}\n\n", limits(stack));
        text += "| dimension | direction | nominal | tolerance | unit | contribution | share % |\n|---|--:|--:|---|---|--:|--:|\n";
        for row in &stack.rows {
            text += &line(&cells(stack, row, clean(&row.dimension.name)));
        }
        text += "\n| total | middle | half width | from | to | limits |\n|---|--:|--:|--:|--:|---|\n";
        for total in &stack.totals {
            text += &line(&total_cells(stack, total));
        }
        for note in &stack.notes {
            text += &format!("\n{}\n", escaped(&note.to_string()));
        }
    }
    text
}

fn heading(stack: &Stack) -> String {
    let unit = stack.unit.as_deref().map(|unit| format!(" [{}]", clean(unit))).unwrap_or_default();
    format!("stack of {}{unit}{}", clean(&stack.characteristic), limits(stack))
}

fn limits(stack: &Stack) -> String {
    match stack.limits {
        [None, None] => String::new(),
        [Some(lower), None] => format!(", above {}", plain(lower)),
        [None, Some(upper)] => format!(", below {}", plain(upper)),
        [Some(lower), Some(upper)] => format!(", {} .. {}", plain(lower), plain(upper)),
    }
}

/// Lines of words that fit a page.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().expect("never empty");
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > LINE {
            lines.push(format!("  {word}"));
        } else {
            line.push_str(if line.is_empty() { "" } else { " " });
            line.push_str(word);
        }
    }
    lines
}

/// Numbers beside the widest total.
fn scaled(stack: &Stack, value: Option<f64>) -> String {
    let scale = stack.totals.iter().filter_map(|total| total.half_width).fold(0.0, f64::max);
    value.map_or(UNKNOWN.to_owned(), |value| beside(value, scale))
}

fn cells(stack: &Stack, row: &StackRow, name: String) -> [String; 7] {
    [
        name,
        row.direction.clone(),
        plain(row.dimension.nominal),
        tolerance(&row.dimension),
        row.dimension.unit.as_deref().map(clean).unwrap_or_default(),
        scaled(stack, row.contribution),
        row.share.map_or(UNKNOWN.to_owned(), percent),
    ]
}

fn total_cells(stack: &Stack, total: &StackTotal) -> [String; 6] {
    let interval = total.interval();
    let kept = match stack.keeps(total) {
        None => "",
        Some(true) => "within the limits",
        Some(false) => "EXCEEDS the limits",
    };
    [
        total.kind.name().to_owned(),
        scaled(stack, total.middle),
        scaled(stack, total.half_width),
        scaled(stack, interval.map(|[from, _]| from)),
        scaled(stack, interval.map(|[_, to]| to)),
        kept.to_owned(),
    ]
}

/// What Markdown would read as more than text.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        if ['|', '\\', '`', '*', '_', '<', '[', ']'].contains(&c) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}
