//! The classic stack-up table of a characteristic: the contribution of every dimension, and the usual totals side by side.
//!
//! ```text
//! contribution of a dimension    |b_i| T_i               b_i: direction or slope, T_i: half band, or three sigma without one
//! its share                      (b_i T_i)^2 / sum       of the sum of squares
//! ```
//!
//! A nonlinear characteristic has the table of its tangent at the means, with a note about it.
//! The totals are those of [`CharacteristicAnalysis`](sensitol::CharacteristicAnalysis), each about its own middle.

use crate::analysis::worst_case::KnownWorstCaseFigures;
use std::fmt;

use crate::analysis::statistics::{CharacteristicStatistics, part};
use crate::analysis::worst_case::KnownWorstCase;
use crate::document::number::{UNKNOWN, beside, limits, outward, percent, plain, short, significant};
use crate::document::{Blocks, Cell, Columns, DataTable, Document, Line, Section, Tone, Value};
use crate::figures::{Figures, Named};
use crate::{DimensionReport, Report};
use sensitol::analysis::DerivativeOrigin;
use sensitol::analysis::{CharacteristicAnalysis, Sensitivity};
use sensitol::method::Method;

/// Greatest deviation of a slope from 1 or -1 that still is a direction.
const DIRECTION: f64 = 1e-9;
/// Sigmas on either side in place of a tolerance, and in the totals by moments.
const SIGMAS: f64 = 3.0;
/// Rounding tolerance at a limit, as a part of the half-width.
const ROUNDING: f64 = 1e-9;

/// The stack of one characteristic. Unknown values are None.
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    /// Name of the characteristic.
    pub characteristic: String,
    /// Unit of the characteristic.
    pub unit: Option<String>,
    /// Lower and upper limit.
    pub limits: [Option<f64>; 2],
    /// Dimensions that affect the characteristic, in the study's order.
    pub rows: Vec<StackRow>,
    /// Totals in the order of [`TotalKind`], except the proven worst case, which is last. For few dimensions the inflated RSS may exceed
    /// the worst case.
    pub totals: Vec<StackTotal>,
    /// Notes for reading the table.
    pub notes: Vec<StackNote>,
}

/// One dimension in a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct StackRow {
    /// The dimension.
    pub dimension: DimensionReport,
    /// Lower and upper deviation from the nominal in the stack: the tolerance, or three sigma about the mean.
    pub deviations: [f64; 2],
    /// Slope at the mean; 1 and -1 are directions.
    pub slope: Option<f64>,
    /// Slope times half-width, without sign.
    pub contribution: Option<f64>,
    /// Part of the sum of squares of all contributions.
    pub share: Option<f64>,
    pub(crate) direction: String,
}

/// One way to add up a stack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StackTotal {
    /// Kind of the total.
    pub kind: TotalKind,
    /// Middle of the interval.
    pub middle: Option<f64>,
    /// Half-width of the interval.
    pub half_width: Option<f64>,
}

/// Ways to add up a stack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TotalKind {
    /// Worst case by slopes, for a characteristic that is proven to be linear.
    WorstCase,
    /// Worst case by slopes alone, which is not a bound.
    LinearWorstCase,
    /// Proven worst case of a nonlinear characteristic.
    ProvenWorstCase,
    /// Root of the sum of squares.
    Rss,
    /// RSS times 1.5, or by the factors of the study.
    InflatedRss,
    /// RSS with every mean shifted by half of its half-width, or by the shifts of the study.
    MeanShiftRss,
    /// Three effective sigmas of processes with shifted means.
    SixSigma,
    /// Three sigma about the mean, from moments without curvature.
    FirstOrder,
    /// Three sigma about the mean, from moments with curvature.
    SecondOrder,
}

/// Note for reading a stack.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum StackNote {
    /// The characteristic is nonlinear.
    Curved {
        /// Share of the variance from curvature and interactions.
        share: f64,
        /// Shift of the mean by curvature.
        mean_shift: f64,
    },
    /// The moments come from points of the model, because no surface of second order follows the characteristic.
    Sampled,
    /// The method assumes that the characteristic is linear.
    NotExamined,
    /// There is no curvature, but some interactions were not examined.
    InteractionsNotExamined {
        /// Number of interactions that were not examined.
        count: usize,
    },
    /// Shares in the squared RSS differ from the contributions to the variance.
    SharesOfRss,
    /// Some dimensions have no known slope.
    SlopeUnknown {
        /// Names of the dimensions.
        dimensions: Vec<String>,
    },
    /// Some dimensions use three sigma, because they have no tolerance band.
    ThreeSigma {
        /// Names of the dimensions.
        dimensions: Vec<String>,
    },
    /// Some dimensions do not vary, and their slope was not requested.
    Fixed {
        /// Names of the dimensions.
        dimensions: Vec<String>,
    },
    /// Some dimensions are correlated.
    Correlated {
        /// Names of the dimensions.
        dimensions: Vec<String>,
    },
    /// Some dimensions are coordinates of one circular zone.
    Zone {
        /// Name of the zone.
        zone: String,
        /// Names of the coordinates.
        dimensions: Vec<String>,
    },
}

impl Report {
    /// Stacks of all characteristics of the report.
    pub fn stacks(&self) -> Vec<Stack> {
        self.analysis.characteristics.iter().map(|one| Stack::of(self, one)).collect()
    }
}

impl Stack {
    fn of(report: &Report, one: &CharacteristicAnalysis) -> Self {
        let pairs = || one.sensitivities.iter().zip(&report.dimensions);
        let rows = pairs().filter(|(row, dimension)| matters(row, dimension));
        let mut rows: Vec<StackRow> =
            rows.map(|(sensitivity, dimension)| StackRow::of(sensitivity, dimension)).collect();
        // Root of the sum of squares. It equals the RSS unless dimensions are correlated, and is unknown if one slope is.
        let alone: Option<f64> = one
            .linear
            .rss
            .and(rows.iter().map(|row| row.contribution).try_fold(0.0, |sum, part| Some(libm::hypot(sum, part?))));
        for row in &mut rows {
            row.share =
                row.contribution.zip(alone).map(|(part, all)| if all == 0.0 { 0.0 } else { (part / all).powi(2) });
        }
        // The six-sigma total stands before that of the moments. A proven worst case of its own stands last.
        let first_order = [Method::Rss, Method::WorstCase].contains(&report.analysis.method);
        let worst_case = one.range.worst_case.map(|[lower, upper]| 0.5 * (upper - lower));
        let proven = one.proven_worst_case();
        let linear = proven.as_ref().is_some_and(|proven| one.is_linear(proven));
        let by_slopes = if linear { TotalKind::WorstCase } else { TotalKind::LinearWorstCase };
        let about_middle = |kind, half_width| StackTotal { kind, middle: one.linear.middle, half_width };
        let mut totals = vec![
            about_middle(by_slopes, worst_case),
            about_middle(TotalKind::Rss, one.linear.rss),
            about_middle(TotalKind::InflatedRss, one.linear.inflated_rss),
            about_middle(TotalKind::MeanShiftRss, one.linear.mean_shift_rss),
            StackTotal {
                kind: if first_order { TotalKind::FirstOrder } else { TotalKind::SecondOrder },
                middle: one.mean(),
                half_width: one.sigma().map(|sigma| SIGMAS * sigma),
            },
        ];
        if let Some(effective) = one.linear.six_sigma {
            totals.insert(4, about_middle(TotalKind::SixSigma, Some(SIGMAS * effective)));
        }
        if let Some(KnownWorstCase { ends: [lower, upper], .. }) = proven.filter(|_| !linear) {
            let [middle, half_width] = [0.5 * (lower + upper), 0.5 * (upper - lower)].map(Some);
            totals.push(StackTotal { kind: TotalKind::ProvenWorstCase, middle, half_width });
        }
        Self {
            characteristic: one.name().to_owned(),
            unit: one.unit().map(str::to_owned),
            limits: one.limits(),
            notes: notes(report, one, &rows),
            rows,
            totals,
        }
    }

    /// True if the interval of a total lies within the limits or just reaches them. None if the interval is unknown, or without limits.
    pub fn keeps(&self, total: &StackTotal) -> Option<bool> {
        // Rounding must not turn a stack that just reaches a limit into an excess.
        let slack = ROUNDING * total.half_width? + 8.0 * f64::EPSILON * total.middle?.abs();
        let [from, to] = total.interval().map(|[from, to]| [from + slack, to - slack])?;
        match self.limits {
            [None, None] => None,
            [lower, upper] => Some(lower.is_none_or(|lower| from >= lower) && upper.is_none_or(|upper| to <= upper)),
        }
    }
}

impl StackTotal {
    /// Returns the ends of the total's interval.
    pub(crate) fn interval(&self) -> Option<[f64; 2]> {
        let (middle, half) = (self.middle?, self.half_width?);
        Some([middle - half, middle + half])
    }
}

impl TotalKind {
    /// Returns the name of the total for readers.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::WorstCase => "worst case",
            Self::LinearWorstCase => "linear worst case",
            Self::ProvenWorstCase => "proven worst case",
            Self::Rss => "rss",
            Self::InflatedRss => "inflated rss",
            Self::MeanShiftRss => "mean-shift rss",
            Self::SixSigma => "six sigma, shifted",
            Self::FirstOrder => "first order, 3 sigma",
            Self::SecondOrder => "second order, 3 sigma",
        }
    }
}

impl StackRow {
    fn of(sensitivity: &Sensitivity, dimension: &DimensionReport) -> Self {
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

/// True if a dimension belongs into the table: its effect is known, or it varies and its effect is unknown.
fn matters(row: &Sensitivity, dimension: &DimensionReport) -> bool {
    let idle = row.first == Some(0.0) && row.second.unwrap_or(0.0) == 0.0;
    !idle && (dimension.sigma > 0.0 || row.first.is_some())
}

/// Formats the direction: `+`, `-`, or the slope if it is neither 1 nor -1.
fn direction(row: &Sensitivity) -> String {
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

fn notes(report: &Report, one: &CharacteristicAnalysis, rows: &[StackRow]) -> Vec<StackNote> {
    let mut notes = Vec::new();
    let names = |kept: &dyn Fn(&StackRow) -> bool| -> Vec<String> {
        rows.iter().filter(|row| kept(row)).map(|row| row.dimension.name.clone()).collect()
    };
    let lost = names(&|row| row.slope.is_none());
    if !lost.is_empty() {
        notes.push(StackNote::SlopeUnknown { dimensions: lost });
    }
    notes.extend(shape(one, rows));
    if has_other_contributions(one, rows) {
        notes.push(StackNote::SharesOfRss);
    }
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

/// True if a printed contribution to the variance differs from the printed share in the squared RSS.
fn has_other_contributions(one: &CharacteristicAnalysis, rows: &[StackRow]) -> bool {
    let apart = |row: &StackRow| {
        let of_variance = one.sensitivities.iter().find(|of| of.dimension == row.dimension.name).and_then(part);
        of_variance.zip(row.share).is_some_and(|(a, b)| percent(a) != percent(b))
    };
    rows.iter().any(apart)
}

/// Returns the note on linearity. Derivatives within their rounding errors count as 0.
fn shape(one: &CharacteristicAnalysis, rows: &[StackRow]) -> Option<StackNote> {
    if one.is_of_model() {
        return Some(StackNote::Sampled);
    }
    let real = |value: Option<f64>, rounding: Option<f64>| match (value, rounding) {
        (Some(value), Some(rounding)) => value.abs() > 2.0 * rounding,
        (value, _) => value.is_some_and(|value| value != 0.0),
    };
    let curved = one.sensitivities.iter().filter(|row| real(row.second, row.rounding.map(|[_, second]| second)));
    let known = curved.clone().all(|row| row.curvature_share.is_some());
    let curvature: f64 = curved.clone().filter_map(|row| row.curvature_share).sum();
    let mean_shift: f64 = curved.clone().filter_map(|row| row.mean_shift).sum();
    let examined = one.contributions.interactions.iter().filter(|pair| pair.origin != Some(DerivativeOrigin::Screened));
    let joint = examined.filter(|pair| real(pair.mixed, pair.rounding));
    let interactions: f64 = joint.clone().filter_map(|pair| pair.share).sum();
    let varying =
        |row: &Sensitivity| rows.iter().any(|of| of.dimension.name == row.dimension && of.dimension.sigma > 0.0);
    let not_examined = one.sensitivities.iter().any(|row| varying(row) && row.curvature_share.is_none());
    if (curved.count() > 0 && known) || joint.count() > 0 {
        return Some(StackNote::Curved { share: curvature + interactions, mean_shift });
    }
    if not_examined {
        return Some(StackNote::NotExamined);
    }
    match one.contributions.possible_interactions.saturating_sub(one.contributions.examined_interactions) {
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
            Self::Sampled => f.write_str(
                "not linear: mean and sigma come from points of the model; this is the stack of its tangent at the means",
            ),
            Self::NotExamined => {
                f.write_str("curvature was not examined: this is the stack of its tangent at the means (the method full examines all)")
            }
            Self::InteractionsNotExamined { count } => {
                let which = if *count == 1 { "one interaction".to_owned() } else { format!("{count} interactions") };
                write!(f, "linear, unless an interaction says otherwise: {which} not examined (the method full examines all)")
            }
            Self::SharesOfRss => f.write_str(
                "RSS % is a dimension's part of the squared rss, by half tolerances; its contribution to the variance is another one",
            ),
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

/// Stacks as a document: a section each, with contributions and totals. Both tables together are the table `stack`.
pub fn stack_document(stacks: &[Stack]) -> Document {
    Document { sections: stacks.iter().map(Stack::section).collect(), ..Document::default() }
}

impl Stack {
    fn section(&self) -> Section {
        let mut section = Section::of(&format!("stack of {}", self.characteristic), self.unit.as_deref());
        section.words = match self.limits {
            [None, None] => String::new(),
            [lower, upper] => format!(", {}", limits(lower, upper)),
        };
        let [rows, totals] = self.tables();
        section.table(rows);
        section.gap();
        section.table(totals);
        self.notes.iter().for_each(|note| section.wrapped(2, note.to_string()));
        section
    }

    /// True if no note contradicts that the characteristic is linear.
    pub(crate) fn straight(&self) -> bool {
        let bent = |note: &StackNote| {
            matches!(
                note,
                StackNote::Curved { .. }
                    | StackNote::Sampled
                    | StackNote::NotExamined
                    | StackNote::InteractionsNotExamined { .. }
            )
        };
        !self.rows.is_empty() && !self.notes.iter().any(bent)
    }

    /// Tables of the contributions and of the totals. In CSV they are one table. In a total, `nominal` is the middle, and `lower` and
    /// `upper` are the half-width as deviations.
    pub(crate) fn tables(&self) -> [DataTable; 2] {
        let scale = self.totals.iter().filter_map(|total| total.half_width).fold(0.0, f64::max);
        let scaled = |value: Option<f64>| Cell::number(value, |value| beside(value, scale));
        let shown_end = move |total: &StackTotal, end: usize| {
            let interval = total.interval();
            // Ends of a proven worst case are rounded outward, so that no assembly lies beyond the printed numbers.
            let proven = matches!(total.kind, TotalKind::WorstCase | TotalKind::ProvenWorstCase);
            match interval.filter(|_| proven) {
                Some(ends) => Cell::both(Value::Number(Some(ends[end])), outward(ends, scale, None)[end].clone()),
                None => scaled(interval.map(|ends| ends[end])),
            }
        };
        let rows = Columns::default()
            .data("characteristic", |_| Cell::text(&self.characteristic))
            .data("row", |_| Cell::text("dimension"))
            .named("name", "dimension", |row: &&StackRow| Cell::name(&row.dimension.name))
            .data("unit", |row| Cell::optional(row.dimension.unit.as_deref()))
            .shown("direction", |row| Cell::both(Value::Number(row.slope), row.direction.as_str()))
            .column("nominal", "nominal", |row| Cell::number(row.dimension.nominal, plain))
            .data("lower", |row| Cell::data(row.deviations[0]))
            .data("upper", |row| Cell::data(row.deviations[1]))
            .shown("tolerance", |row| Cell::text(row.dimension.tolerance()))
            .named("", "unit", |row| Cell::optional(row.dimension.unit.as_deref()))
            .data("slope", |row| Cell::data(row.slope))
            .column("contribution", "effect", move |row| scaled(row.contribution))
            .column("share", "RSS %", |row| Cell::number(row.share, percent))
            .data("from", |_| Cell::empty())
            .data("to", |_| Cell::empty())
            .data("within_limits", |_| Cell::empty())
            .table("stack", &self.rows);
        let totals = Columns::default()
            .data("characteristic", |_| Cell::text(&self.characteristic))
            .data("row", |_| Cell::text("total"))
            .named("name", "total", |total: &&StackTotal| Cell::text(total.kind.name()))
            .data("unit", |_| Cell::optional(self.unit.as_deref()))
            .column("nominal", "middle", move |total| scaled(total.middle))
            .data("lower", |total| Cell::data(total.half_width.map(|half| -half)))
            .column("upper", "half width", move |total| scaled(total.half_width))
            .data("slope", |_| Cell::empty())
            .data("contribution", |total| Cell::data(total.half_width))
            .data("share", |_| Cell::empty())
            .column("from", "from", move |total| shown_end(total, 0))
            .column("to", "to", move |total| shown_end(total, 1))
            .named("within_limits", "limits", |total| {
                let keeps = self.keeps(total);
                let line = match keeps {
                    None => Line::default(),
                    Some(true) => Line::toned("within the limits", Tone::Good),
                    Some(false) => Line::toned("EXCEEDS the limits", Tone::Bad),
                };
                Cell::both(Value::Truth(keeps), line)
            })
            .table("stack", &self.totals);
        [rows, totals]
    }
}
