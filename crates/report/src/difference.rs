//! Two revisions of a study: changed inputs, and the resulting changes of figures and contributions.

use serde::Serialize;

use crate::document::number::{
    UNKNOWN, band, beside, estimated, estimated_beside, index, limits, percent, plain, plural, short, yielded,
};
use crate::document::terminal::unbroken;
use crate::document::{Blocks, Cell, Columns, DataTable, Document, Section, Style, Tone, Value};
use crate::figures::{Figures, Named};
use crate::{About, DimensionReport, Head, Report};
use sensitol::analysis::CharacteristicAnalysis;
use sensitol_numeric::capability::Capability;
use sensitol_numeric::verdict::Verdict;

/// Greatest number of changed inputs that a line names.
const NAMED: usize = 4;
/// Least change of a share of the variance that is worth a line.
const SEEN: f64 = 0.005;

/// Two analyses beside each other. An unknown figure is null, never 0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DifferenceReport {
    /// The head of every report; the study is the newer one.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// The two studies, the older one first.
    pub(crate) studies: [String; 2],
    /// Hashes of the two studies, in this order.
    pub(crate) sha256: [String; 2],
    /// Evaluations of both.
    pub(crate) evaluations: [u64; 2],
    /// Inputs and limits that differ.
    pub(crate) changes: Vec<Changed>,
    /// The figures of every characteristic that either study requests.
    pub(crate) characteristics: Vec<Compared>,
}

/// One input or limit that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct Changed {
    /// A dimension or a characteristic.
    pub(crate) name: String,
    /// Key in the study; `all` if it is in one study only.
    pub(crate) key: &'static str,
    /// Old value; null if new.
    pub(crate) old: Option<String>,
    /// New value; null if removed.
    pub(crate) new: Option<String>,
}

/// A characteristic in both studies.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct Compared {
    /// Name of the characteristic.
    pub(crate) name: String,
    /// Unit of the characteristic.
    pub(crate) unit: Option<String>,
    /// Verdicts on the target yield, old and new; null without a target.
    pub(crate) verdicts: [Option<Verdict>; 2],
    /// Mean, sigma, Cpk and yield.
    pub(crate) figures: Vec<FigurePair>,
    /// Shares of the variance that moved by half a percent of it or more, those that moved most first.
    pub(crate) shares: Vec<SharePair>,
}

/// A figure before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct FigurePair {
    /// Name of the figure.
    pub(crate) figure: &'static str,
    /// The two values.
    pub(crate) values: [Option<f64>; 2],
    /// Estimated errors of both values.
    pub(crate) errors: [Option<f64>; 2],
    /// True if they differ by more than three times their errors together; null if an error is unknown.
    pub(crate) differs: Option<bool>,
}

/// A share before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct SharePair {
    /// The dimension.
    pub(crate) dimension: String,
    /// The two shares of the variance; null if it is not in the study, or not known.
    pub(crate) shares: [Option<f64>; 2],
}

impl DifferenceReport {
    /// Compares two reports, the older one first, with the names of their studies.
    pub fn of([old, new]: [&Report; 2], studies: [String; 2]) -> Self {
        let about = About { title: new.head.title.clone(), sha256: new.head.study_sha256.clone(), ..About::default() };
        let mut changes = dimensions(old, new);
        changes.extend(asked(old, new));
        Self {
            head: Head::of("analyze", &about),
            studies,
            sha256: [old, new].map(|report| report.head.study_sha256.clone()),
            evaluations: [old, new].map(|report| report.analysis.run.evaluations),
            changes,
            characteristics: compared(old, new),
        }
    }

    /// Formats the differences as a few lines: the inputs, then the figures of every characteristic that changed.
    pub fn brief(&self, style: Style) -> String {
        let mut lines = Vec::new();
        if !self.changes.is_empty() {
            let there = |value: &Option<String>| value.clone().unwrap_or_else(|| "not there".to_owned());
            let named = self
                .changes
                .iter()
                .take(NAMED)
                .map(|one| format!("{} {} {} -> {}", short(&one.name), one.key, there(&one.old), there(&one.new)));
            let named: Vec<String> = named.collect();
            let rest = self.changes.len() - named.len();
            let more = if rest > 0 { format!(" and {rest} more") } else { String::new() };
            lines.push(format!("  {}{more}", named.join(", ")));
        }
        lines.extend(self.characteristics.iter().filter_map(Compared::brief));
        if lines.is_empty() {
            lines.push("  nothing changed".to_owned());
        }
        lines.into_iter().map(|line| unbroken(&line.into(), style)).collect()
    }

    /// Builds the document with the tables `changes`, `results` and `contributions`.
    pub(crate) fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        let [old, new] = &self.studies;
        let count = match self.changes.len() {
            0 => "no input differs".to_owned(),
            many => plural(many, "input differs", "inputs differ"),
        };
        document.line(format!("from {old} to {new}: {count}"));
        document.gap();
        document.table(self.changed());
        document.table(self.data());
        document.table(self.share_data());
        document.sections = self.characteristics.iter().map(section).collect();
        document
    }

    fn changed(&self) -> DataTable {
        let shown = |value: &Option<String>| Cell::text(value.as_deref().unwrap_or("not there"));
        Columns::default()
            .named("name", "changed", |row: &&Changed| Cell::name(&row.name))
            .column("key", "what", |row| Cell::text(row.key))
            .column("old", "was", |row| shown(&row.old))
            .column("new", "is", |row| shown(&row.new))
            .table("changes", &self.changes)
    }

    fn data(&self) -> DataTable {
        let rows = self.characteristics.iter().flat_map(|one| one.figures.iter().map(move |figure| (one, figure)));
        Columns::default()
            .data("characteristic", |row: &(&Compared, &FigurePair)| Cell::text(&row.0.name))
            .data("figure", |row| Cell::text(row.1.figure))
            .data("old", |row| Cell::data(row.1.values[0]))
            .data("old_error", |row| Cell::data(row.1.errors[0]))
            .data("new", |row| Cell::data(row.1.values[1]))
            .data("new_error", |row| Cell::data(row.1.errors[1]))
            .table("results", rows)
    }

    fn share_data(&self) -> DataTable {
        let rows = self.characteristics.iter().flat_map(|one| one.shares.iter().map(move |share| (one, share)));
        Columns::default()
            .data("characteristic", |row: &(&Compared, &SharePair)| Cell::text(&row.0.name))
            .data("dimension", |row| Cell::text(&row.1.dimension))
            .data("old", |row| Cell::data(row.1.shares[0]))
            .data("new", |row| Cell::data(row.1.shares[1]))
            .table("contributions", rows)
    }
}

impl Compared {
    /// Line with the figures that changed and the verdicts. None if nothing did.
    fn brief(&self) -> Option<String> {
        let sigma = |place: usize| self.figures[1].values[place].unwrap_or(0.0);
        let shown = |pair: &FigurePair, place: usize| {
            pair.values[place]
                .map_or(UNKNOWN.to_owned(), |value| figure(pair.figure, value, pair.errors[place], sigma(place)))
        };
        let moved = self.figures.iter().filter(|pair| pair.differs != Some(false) && pair.values[0] != pair.values[1]);
        let moved = moved.map(|pair| [pair.figure.to_owned(), shown(pair, 0), shown(pair, 1)]);
        let moved: Vec<String> =
            moved.filter(|[_, was, is]| was != is).map(|[figure, was, is]| format!("{figure} {was} -> {is}")).collect();
        let word = |verdict: Option<Verdict>| verdict.map_or("no target", Verdict::name);
        let judged = match self.verdicts {
            [was, is] if was != is => format!("; {}, was {}", word(is), word(was)),
            _ => String::new(),
        };
        let changed = !moved.is_empty() || !judged.is_empty();
        changed.then(|| format!("  {}: {}{judged}", short(&self.name), moved.join(", ")))
    }
}

fn section(one: &Compared) -> Section {
    let mut section = Section::of(&one.name, one.unit.as_deref());
    let word = |verdict: Option<Verdict>| verdict.map_or("no target", Verdict::name);
    if one.verdicts != [None; 2] {
        section.words = format!(": {}, was {}", word(one.verdicts[1]), word(one.verdicts[0]));
    }
    let sigma = |place: usize| one.figures[1].values[place].unwrap_or(0.0);
    let shown = |pair: &FigurePair, place: usize| {
        let value = pair.values[place];
        Cell::both(
            Value::Number(value),
            value.map_or(UNKNOWN.to_owned(), |value| figure(pair.figure, value, pair.errors[place], sigma(place))),
        )
    };
    let moved = |pair: &FigurePair| match (pair.values, pair.differs) {
        ([Some(old), Some(new)], _) if old == new => Cell::text("unchanged"),
        ([Some(_), Some(_)], Some(false)) => Cell::text("within the errors"),
        ([Some(old), Some(new)], _) => {
            let change = new - old;
            let sign = if change > 0.0 { "+" } else { "" };
            let text = match pair.figure {
                "yield" => format!("{sign}{} ppm of rejects", estimated(-1e6 * change, None)),
                "Cpk" => format!("{sign}{}", index(change)),
                _ => format!("{sign}{}", beside(change, sigma(1))),
            };
            let text = if pair.figure == "yield" { text.trim_start_matches('+').to_owned() } else { text };
            let better = match pair.figure {
                "yield" | "Cpk" => Some(change > 0.0),
                _ => None,
            };
            Cell::text(text).toned(better.map_or(Tone::Plain, |better| if better { Tone::Good } else { Tone::Bad }))
        }
        _ => Cell::text("not known"),
    };
    let figures = Columns::default()
        .named("", "figure", |pair: &&FigurePair| Cell::text(pair.figure))
        .shown("was", |pair| shown(pair, 0))
        .shown("is", |pair| shown(pair, 1))
        .shown("change", |pair| moved(pair))
        .table("", &one.figures);
    section.table(figures);
    if !one.shares.is_empty() {
        section.gap();
        let share = |row: &SharePair, place: usize| Cell::known(row.shares[place], percent);
        let shares = Columns::default()
            .named("", "contribution of", |row: &&SharePair| Cell::name(&row.dimension))
            .shown("% was", |row| share(row, 0))
            .shown("% is", |row| share(row, 1))
            .table("", &one.shares);
        section.table(shares);
    }
    section
}

/// Formats a figure with the digits that its error supports.
fn figure(name: &str, value: f64, error: Option<f64>, sigma: f64) -> String {
    match name {
        "yield" => yielded(value),
        "Cpk" => index(value),
        _ => match error.filter(|error| *error > 1e-6 * sigma) {
            Some(error) => estimated_beside(value, Some(sigma), Some(error)),
            None => beside(value, sigma),
        },
    }
}

/// Lists the dimensions that differ, are new, or are gone, matched by name.
fn dimensions(old: &Report, new: &Report) -> Vec<Changed> {
    let mut found = Vec::new();
    let whole = |of: &DimensionReport| {
        let tolerance = of.tolerance.map(|ends| format!(" {}", band(ends))).unwrap_or_default();
        format!("{}{tolerance}", plain(of.nominal))
    };
    for one in &old.dimensions {
        let Some(other) = new.dimensions.iter().find(|other| other.name == one.name) else {
            found.push(Changed { name: one.name.clone(), key: "all", old: Some(whole(one)), new: None });
            continue;
        };
        let mut differ = |key: &'static str, [was, is]: [Option<String>; 2]| {
            if was != is {
                found.push(Changed { name: one.name.clone(), key, old: was, new: is });
            }
        };
        differ("nominal", [one, other].map(|of| Some(plain(of.nominal))));
        differ("tolerance", [one, other].map(|of| of.tolerance.map(band)));
        differ("distribution", [one, other].map(|of| of.kind().map(str::to_owned)));
        // A sigma that follows from a changed tolerance or distribution is not listed on its own.
        if one.tolerance == other.tolerance && one.kind() == other.kind() {
            differ("sigma", [one, other].map(|of| Some(plain(of.sigma))));
            if one.nominal == other.nominal {
                differ("mean", [one, other].map(|of| Some(plain(of.mean))));
            }
        }
        differ("unit", [one, other].map(|of| of.unit.clone()));
    }
    for one in &new.dimensions {
        if old.dimensions.iter().all(|other| other.name != one.name) {
            found.push(Changed { name: one.name.clone(), key: "all", old: None, new: Some(whole(one)) });
        }
    }
    found
}

fn asked(old: &Report, new: &Report) -> Vec<Changed> {
    let mut found = Vec::new();
    for one in &old.analysis.characteristics {
        let Some(other) = new.analysis.characteristics.iter().find(|other| other.name() == one.name()) else {
            continue;
        };
        let mut differ = |key: &'static str, [was, is]: [Option<String>; 2]| {
            if was != is {
                found.push(Changed { name: one.name().to_owned(), key, old: was, new: is });
            }
        };
        differ("limits", [one, other].map(|of| of.limited().then(|| limits(of.lower(), of.upper()))));
        differ("target_yield", [one, other].map(|of| of.target().map(yielded)));
    }
    found
}

fn compared(old: &Report, new: &Report) -> Vec<Compared> {
    let named = |report: &'_ Report, name: &str| -> Option<CharacteristicAnalysis> {
        report.analysis.characteristics.iter().find(|one| one.name() == name).cloned()
    };
    let gone = old.analysis.characteristics.iter().filter(|one| named(new, one.name()).is_none());
    let names = new.analysis.characteristics.iter().chain(gone).map(Named::name);
    names
        .map(|name| {
            let both = [old, new].map(|report| named(report, name));
            let of = |figure: &dyn Fn(&CharacteristicAnalysis) -> Option<f64>| {
                [0, 1].map(|place| both[place].as_ref().and_then(figure))
            };
            let pair = |figure, values: [Option<f64>; 2], errors: [Option<f64>; 2]| FigurePair {
                figure,
                values,
                errors,
                differs: match (values, errors) {
                    ([Some(was), Some(is)], [Some(a), Some(b)]) => Some((is - was).abs() > 3.0 * libm::hypot(a, b)),
                    _ => None,
                },
            };
            let capability =
                |one: &CharacteristicAnalysis| one.distribution.capability.as_ref().and_then(|of: &Capability| of.cpk);
            let error = |place: fn(&sensitol::method::ErrorEstimate) -> Option<f64>| {
                of(&move |one| one.error_estimate.as_ref().and_then(place))
            };
            let unit = both.iter().flatten().find_map(|one| one.unit()).map(str::to_owned);
            Compared {
                name: name.to_owned(),
                unit,
                verdicts: [0, 1].map(|place| both[place].as_ref().and_then(CharacteristicAnalysis::verdict)),
                figures: vec![
                    pair("mean", of(&|one| one.mean()), error(|of| of.mean)),
                    pair("sigma", of(&|one| one.sigma()), error(|of| of.sigma)),
                    pair("Cpk", of(&capability), [None, None]),
                    pair("yield", of(&|one| one.yield_()), error(|of| of.yield_)),
                ],
                shares: shares(&both),
            }
        })
        .collect()
}

/// Shares of the variance of each dimension, before and after, that have moved by `SEEN` or more.
fn shares(both: &[Option<CharacteristicAnalysis>; 2]) -> Vec<SharePair> {
    let share = |one: &CharacteristicAnalysis, name: &str| {
        let row = one.sensitivities.iter().find(|row| row.dimension == name)?;
        Some(row.linear_share? + row.curvature_share.unwrap_or(0.0))
    };
    let names =
        |place: usize| both[place].iter().flat_map(|one| one.sensitivities.iter().map(|row| row.dimension.clone()));
    let mut all: Vec<String> = names(1).collect();
    all.extend(names(0).filter(|name| names(1).all(|other| other != *name)));
    let mut found: Vec<SharePair> = (all.into_iter())
        .map(|dimension| {
            let shares = [0, 1].map(|place| both[place].as_ref().and_then(|one| share(one, &dimension)));
            SharePair { dimension, shares }
        })
        .collect();
    let moved = |row: &SharePair| (row.shares[1].unwrap_or(0.0) - row.shares[0].unwrap_or(0.0)).abs();
    found.retain(|row| moved(row) >= SEEN);
    found.sort_by(|a, b| moved(b).total_cmp(&moved(a)));
    found
}
