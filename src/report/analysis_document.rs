//! The report of an analysis as a document: the verdict first, then what there is to say of each characteristic.

use super::distribution::{DistributionReport, Quantiles};
use super::head::{self, findings};
use super::requirement::{RequirementReport, judged, loud};
use super::stack::Stack;
use super::surface_law::source;
use super::{CharacteristicReport, CorrelationReport, DimensionReport, FitReport, Report, WarningReport, bars};
use crate::analysis::{Interaction, Sensitivity};
use crate::capability::Law;
use crate::document::number::{
    NEWS, UNKNOWN, beside, index, known, limits, percent, plain, plural, rejected, shape, share, short, significant,
    yielded,
};
use crate::document::{
    Block, Blocks, Cell, Chart, Columns, Document, Line, Section, Spread, Style, Table, Value, terminal,
};
use crate::extremes::{Extreme, Place};
use crate::method::Basis;
use crate::pearson::Pearson;

/// Contributions and interactions that a terminal shows unless all are asked for, and interactions that a page shows.
const CONTRIBUTIONS: usize = 30;
const INTERACTIONS: usize = 5;
const INTERACTIONS_OF_PAGE: usize = 24;
/// Dimensions that are named, rather than counted, in a sentence.
const NAMED: usize = 8;
const SAMPLES: usize = 3;
/// A rejected share that the normal fit has wrong by more than this part is worth a line.
const DIFFERENT: f64 = 0.05;
/// Parts per million below this are none.
const LEAST_PPM: f64 = 1e-6;
/// A second derivative or a slope within this many of its rounding errors is 0.
const ROUNDINGS: f64 = 2.0;

impl Report {
    /// What it says. Its tables: `characteristics`, `dimensions`, `sensitivities`, `interactions`, `quantiles` and `warnings`.
    pub fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        let evaluations = plural(self.run.evaluations as usize, "evaluation", "evaluations");
        let varying = plural(self.varying, "varying dimension", "varying dimensions");
        document.line(format!("{}: {evaluations}, {varying}{}", self.method, head::beside(&self.run)));
        self.account.iter().for_each(|account| document.wrapped(0, account.to_string()));
        document.gap();
        document.table(self.verdicts());
        if let Some(joint) = &self.joint_yield {
            let error = significant(100.0 * joint.error, 2);
            document.note(format!("all limits at once: yield {}, ± {error} %", yielded(joint.value)));
        }
        let all = self.characteristics.iter().zip(self.stacks());
        document.sections = all.map(|(one, stack)| self.section(one, &stack)).collect();
        document.head.extend([self.dimension_table(), self.warning_table()].map(Block::Table));
        document
    }

    fn section(&self, one: &CharacteristicReport, stack: &Stack) -> Section {
        let mut section = Section::of(&one.name, one.unit.as_deref());
        section.blocks = findings(&self.warnings, |name| name == Some(&one.name));
        one.figures(&mut section);
        one.errors(&mut section);
        one.extremes(&mut section);
        one.distribution(&mut section);
        one.sampling(&mut section);
        section.gap();
        section.table(one.contributions(&self.dimensions));
        if let Some(source) = self.source(one) {
            section.note(source);
        }
        self.correlations(one, &mut section);
        one.pairs(&mut section);
        let (pareto, rest) = bars::pareto(one);
        let mut drawn = vec![Block::Chart(Chart::Bars(pareto))];
        rest.into_iter().for_each(|rest| drawn.note(rest));
        section.aside("Contributions to the variance", drawn);
        if let Some(spans) = bars::spans(one) {
            section.aside("Worst case and RSS", vec![Block::Chart(Chart::Bars(spans))]);
        }
        if stack.straight() {
            let mut blocks: Vec<Block> = stack.tables().map(Block::Table).into();
            stack.notes.iter().for_each(|note| blocks.note(note.to_string()));
            section.aside("Stack", blocks);
        }
        section
    }

    /// A row for every characteristic: where it lies, its limits, and how it keeps them.
    pub(super) fn verdicts(&self) -> Table {
        type Of<'r> = &'r CharacteristicReport;
        let scaled = |one: &Of<'_>, value: Option<f64>, unknown: &str| {
            let text = value.zip(one.sigma).map_or(unknown.to_owned(), |(value, sigma)| beside(value, sigma));
            Cell::both(Value::Number(value), text)
        };
        let verdict = |one: &Of<'_>| {
            if one.lower.or(one.upper).is_none() || one.mean.is_none() {
                return Cell::empty();
            }
            let yield_ = rejected(one.ppm_below, one.ppm_above).unwrap_or_else(|| "unknown".to_owned());
            let target = one.verdict.map_or(Line::default(), |verdict| Line::from(", target ").and(loud(verdict)));
            Cell::both(Value::Empty, Line::from(format!("yield {yield_}")).and(target))
        };
        let family = |one: &Of<'_>| match &one.distribution {
            None => [None, None],
            Some(DistributionReport::Point { .. }) => [Some("point"), None],
            Some(DistributionReport::Pearson { kind, .. }) => [Some("pearson"), Some(*kind)],
        };
        let end = |interval: Option<[f64; 2]>, end: usize| Cell::data(interval.map(|ends| ends[end]));
        let normal = |one: &Of<'_>, of: fn(&FitReport) -> Option<f64>| Cell::data(one.normal_fit.as_ref().and_then(of));
        Columns::default()
            .named("name", "characteristic", |one: &Of<'_>| Cell::name(&one.name))
            .data("unit", |one| Cell::optional(one.unit.as_deref()))
            .data("nominal", |one| Cell::data(one.nominal))
            .column("mean", "mean", move |one| scaled(one, one.mean, "unknown"))
            .shown("± 3 sigma", move |one| scaled(one, one.sigma.map(|sigma| 3.0 * sigma), UNKNOWN))
            .named("", "unit", |one| Cell::optional(one.unit.as_deref()))
            .shown("limits", |one| Cell::text(limits(one.lower, one.upper)))
            .named("", "yield", verdict)
            .data("sigma", |one| Cell::data(one.sigma))
            .data("skewness", |one| Cell::data(one.skewness))
            .data("kurtosis", |one| Cell::data(one.kurtosis))
            .data("worst_case_lower", move |one| end(one.worst_case.linear, 0))
            .data("worst_case_upper", move |one| end(one.worst_case.linear, 1))
            .data("middle", |one| Cell::data(one.middle))
            .data("rss", |one| Cell::data(one.rss))
            .data("inflated_rss", |one| Cell::data(one.inflated_rss))
            .data("mean_shift_rss", |one| Cell::data(one.mean_shift_rss))
            .data("left_out_share", |one| Cell::data(one.left_out_share))
            .data("distribution", move |one| Cell::optional(family(one)[0]))
            .data("type", move |one| Cell::optional(family(one)[1]))
            .data("lower", |one| Cell::data(one.lower))
            .data("upper", |one| Cell::data(one.upper))
            .data("target_yield", |one| Cell::data(one.target_yield))
            .data("met", |one| Cell::both(Value::Truth(one.met), ""))
            .data("yield", |one| Cell::data(one.yield_))
            .data("ppm_below", |one| Cell::data(one.ppm_below))
            .data("ppm_above", |one| Cell::data(one.ppm_above))
            .data("cp", |one| Cell::data(one.cp))
            .wide("cpk", "Cpk", |one| Cell::known(one.cpk, index))
            .data("cp_percentile", |one| Cell::data(one.cp_percentile))
            .data("cpk_percentile", |one| Cell::data(one.cpk_percentile))
            .data("sigma_level", |one| Cell::data(one.sigma_level))
            .data("normal_yield", move |one| normal(one, |normal| normal.yield_))
            .data("normal_ppm_below", move |one| normal(one, |normal| normal.ppm_below))
            .data("normal_ppm_above", move |one| normal(one, |normal| normal.ppm_above))
            .table("characteristics", &self.characteristics)
    }

    fn dimension_table(&self) -> Table {
        let end = |one: &DimensionReport, end: usize| Cell::data(one.tolerance.map(|ends| ends[end]));
        Columns::default()
            .data("name", |one: &&DimensionReport| Cell::text(&one.name))
            .data("unit", |one| Cell::optional(one.unit.as_deref()))
            .data("nominal", |one| Cell::data(one.nominal))
            .data("lower", move |one| end(one, 0))
            .data("upper", move |one| end(one, 1))
            .data("zone", |one| Cell::optional(one.zone.as_deref()))
            .data("distribution", |one| Cell::optional(one.distribution))
            .data("mean", |one| Cell::data(one.mean))
            .data("sigma", |one| Cell::data(one.sigma))
            .table("dimensions", &self.dimensions)
    }

    fn warning_table(&self) -> Table {
        Columns::default()
            .data("code", |one: &&WarningReport| Cell::text(one.code))
            .data("characteristic", |one| Cell::optional(one.characteristic.as_deref()))
            .data("dimension", |one| Cell::optional(one.dimension.as_deref()))
            .data("message", |one| Cell::text(&one.message))
            .table("warnings", &self.warnings)
    }

    /// What slopes and curvatures are, unless they are differences as everything else.
    fn source(&self, one: &CharacteristicReport) -> Option<String> {
        let shown = || one.shown(&self.dimensions);
        let differences: Vec<String> =
            shown().filter(|(row, _)| !row.exact).map(|(row, _)| short(&row.dimension)).collect();
        if differences.len() == shown().count() {
            return None;
        }
        let but = match differences.len() {
            0 => String::new(),
            1..=NAMED => format!(", but by differences for {}", differences.join(", ")),
            many => format!(", but by differences for {many} dimensions"),
        };
        let rest = match self.basis {
            Basis::Exact => "everything rests on them",
            Basis::Differences => "the rest comes from differences",
            Basis::LeastSquares => "the rest comes from the fitted surface",
            Basis::Quadrature => "the moments come from quadrature",
        };
        Some(format!("slopes and curvatures are exact{but}; {rest}"))
    }

    /// The pairs that vary together, of dimensions that matter here.
    fn correlations(&self, one: &CharacteristicReport, section: &mut Section) {
        let matters =
            |name: &String| one.sensitivities.iter().any(|row| row.dimension == *name && row.first != Some(0.0));
        let word = |pair: &CorrelationReport| {
            format!("{} × {} {}", short(&pair.between[0]), short(&pair.between[1]), plain(pair.value))
        };
        let pairs = self.correlation.iter().filter(|pair| pair.between.iter().all(matters));
        let words: Vec<String> = pairs.map(word).collect();
        if !words.is_empty() {
            section.list("  correlated:", words);
            section.note("shares are covariances with the whole, the worst case ignores correlations");
        }
    }
}

impl CharacteristicReport {
    /// The unit by which its numbers are rounded.
    pub(super) fn scale(&self) -> f64 {
        self.sigma.filter(|&sigma| sigma > 0.0).or(self.rss).unwrap_or(0.0)
    }

    fn figures(&self, section: &mut Section) {
        let scale = self.scale();
        let number = |value: Option<f64>| Cell::number(value, |value| beside(value, scale));
        let interval = |ends: Option<[f64; 2]>| {
            let text = ends.map(|[low, high]| format!("{} .. {}", beside(low, scale), beside(high, scale)));
            Cell::text(text.unwrap_or_else(|| UNKNOWN.to_owned()))
        };
        let around = |middle: Option<f64>, reach: Option<f64>| {
            interval(middle.zip(reach).map(|(middle, reach)| [middle - reach, middle + reach]))
        };
        let shift = self.mean.zip(self.nominal).map(|(mean, nominal)| mean - nominal);
        let shift = Cell::text(known(shift, |shift| beside(shift, scale)));
        section.table(Table::untitled(
            [
                ("nominal", number(self.nominal), "mean shift", shift),
                ("mean", number(self.mean), "3 sigma", around(self.mean, self.sigma.map(|sigma| 3.0 * sigma))),
                ("sigma", number(self.sigma), "rss", around(self.middle, self.rss)),
                (
                    "skewness",
                    Cell::number(self.skewness, shape),
                    "inflated rss",
                    around(self.middle, self.inflated_rss),
                ),
                (
                    "kurtosis",
                    Cell::number(self.kurtosis, shape),
                    "mean-shift rss",
                    around(self.middle, self.mean_shift_rss),
                ),
                ("", Cell::empty(), "worst case", interval(self.worst_case.linear)),
            ]
            .map(|(name, value, other, text)| [Cell::text(name), value, Cell::text(other), text]),
        ));
    }

    /// How far all that may be off.
    fn errors(&self, section: &mut Section) {
        let error = |error: Option<f64>| known(error, |error| significant(error, 2));
        if let Some(fit) = &self.least_squares {
            section.note(format!(
                "{} coefficients fitted to {} points: residual standard error {}, of the mean {}, of sigma {}",
                fit.coefficients,
                fit.points,
                error(fit.standard_error),
                error(fit.mean),
                error(fit.sigma)
            ));
        }
        if let Some(estimate) = &self.error_estimate {
            let relative = estimate.sigma.zip(self.sigma).filter(|(_, sigma)| *sigma > 0.0);
            let relative = relative.map(|(error, sigma)| format!(" ({} %)", percent(error / sigma)));
            let mut parts = vec![
                format!("mean {}", error(estimate.mean)),
                format!("sigma {}{}", error(estimate.sigma), relative.unwrap_or_default()),
                format!("skewness {}", error(estimate.skewness)),
                format!("kurtosis {}", error(estimate.kurtosis)),
            ];
            if self.yield_.is_some() {
                let percent = estimate.yield_.map(|error| format!("{} %", significant(100.0 * error, 2)));
                parts.push(format!("yield {}", percent.unwrap_or_else(|| UNKNOWN.to_owned())));
            }
            section.wrapped(2, format!("estimated errors: {}", parts.join(", ")));
            let basis: Vec<String> = estimate.sources.iter().map(|source| source.words()).collect();
            section.wrapped(2, format!("they rest on: {}", basis.join("; ")));
        }
        if let Some(sampled) = self.error_estimate.as_ref().and(self.model_sampling.as_ref()) {
            section.wrapped(2, format!(
                "the surrogate was not trusted: mean to kurtosis from {} points of the model, with it as control variate",
                sampled.samples
            ));
        }
        match &self.verification {
            Some(found) => section.note(found.words.as_str()),
            // Nothing is to be verified of what has no moments, or depends on nothing that varies.
            None if self.mean.is_some() && !self.constant => section.note("not verified by the model"),
            None => {}
        }
        if let Some(sampled) = &self.surrogate_sampling {
            let [sigma, skewness, kurtosis] =
                [sampled.sigma, sampled.skewness, sampled.kurtosis].map(|error| significant(error, 2));
            section.note(format!(
                "sampled from the surrogate, {} points: standard error of sigma {sigma}, skewness {skewness}, kurtosis {kurtosis}",
                sampled.samples
            ));
        }
    }

    /// The extremes, whether they are proven, and where they are.
    fn extremes(&self, section: &mut Section) {
        let Some(found) = &self.worst_case.found else { return };
        let scale = self.scale();
        let [least, greatest] = [&found.least, &found.greatest].map(|extreme| beside(extreme.value, scale));
        let proven = if found.proven() { "proven" } else { "not proven" };
        let evaluations = plural(found.evaluations, "evaluation", "evaluations");
        section.note(format!("extremes  {least} .. {greatest}  {proven}, {evaluations}"));
        section.list("    least at   ", words(&found.least));
        section.list("    greatest at", words(&found.greatest));
    }

    /// Distribution, quantiles, and how they keep the limits.
    fn distribution(&self, section: &mut Section) {
        match &self.distribution {
            None if self.sigma.is_some() => {
                return section.note("no distribution has this skewness and kurtosis: its yield is unknown");
            }
            None => return,
            Some(DistributionReport::Point { at }) => {
                section.note(format!("every assembly has the same value: {}", plain(*at)));
            }
            Some(DistributionReport::Pearson { kind, quantiles, .. }) => {
                if let Some(Law::Pearson(law)) = &self.law {
                    section.gap();
                    section.chart(Chart::Spread(Box::new(self.spread(law, kind))));
                }
                section.gap();
                let sigma = self.sigma.unwrap_or(0.0);
                section.table(match self.surface_law.as_ref().and_then(|law| law.quantiles.as_ref()) {
                    Some(law) => quantile_table("surface law", law, sigma),
                    None => quantile_table(&named(kind), quantiles, sigma),
                });
            }
        }
        section.table(self.quantile_data());
        if self.lower.or(self.upper).is_some() {
            self.limits(section);
        }
    }

    /// The density, over the sample of the model where there is one.
    pub(super) fn spread(&self, law: &Pearson, kind: &str) -> Spread {
        let sample = self.model_sampling.as_ref().and_then(|sampling| sampling.histogram.as_ref());
        let bars = sample.map_or("", |_| " over the sample of the model; each bar with one standard error");
        let mut places = vec![
            (law.quantile(0.00135), "quantile", "0.135 % quantile"),
            (law.quantile(0.5), "quantile", "median"),
            (law.upper_quantile(0.00135), "quantile", "99.865 % quantile"),
        ];
        places.extend(self.mean.map(|mean| (mean, "mean", "mean")));
        Spread {
            law: Some(law.clone()),
            bins: sample.cloned(),
            sampled: false,
            limits: [self.lower, self.upper],
            places,
            sigma: self.sigma.unwrap_or(0.0),
            label: format!("Density of {}", self.name),
            words: if kind == "normal" { "normal.".to_owned() } else { format!("Pearson type {kind}{bars}.") },
        }
    }

    fn quantile_data(&self) -> Table {
        let quantiles = self.quantiles().map_or(&[][..], |quantiles| &quantiles.0);
        Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .data("probability", |row: &&(&'static str, f64)| Cell::text(row.0))
            .data("value", |row| Cell::data(row.1))
            .table("quantiles", quantiles)
    }

    fn limits(&self, section: &mut Section) {
        let shown = |below: Option<f64>, above: Option<f64>| {
            let yield_ = rejected(below, above).unwrap_or_else(|| "unknown".to_owned());
            format!("yield {yield_}{}", outside(below, above))
        };
        let target = judged(self.target_yield, self.verdict);
        section.note(Line::from(shown(self.ppm_below, self.ppm_above)).and(target));
        source(self).into_iter().for_each(|line| section.note(line));
        let named = |name: &str, value: Option<f64>| value.map(|value| format!("{name} {}", index(value)));
        let indices = [
            named("Cp", self.cp),
            named("Cpk", self.cpk),
            named("by percentiles Cp", self.cp_percentile),
            named(if self.cp_percentile.is_some() { "Cpk" } else { "by percentiles Cpk" }, self.cpk_percentile),
            named("sigma level", self.sigma_level),
        ];
        let indices: Vec<String> = indices.into_iter().flatten().collect();
        if !indices.is_empty() {
            section.note(indices.join("  "));
        }
        self.requirements.iter().filter_map(RequirementReport::line).for_each(|line| section.note(line));
        if let Some(normal) = self.normal_fit.as_ref().filter(|normal| self.differs(normal)) {
            section.note(format!("a normal fit would say: {}", shown(normal.ppm_below, normal.ppm_above)));
        }
    }

    /// Whether the normal fit rejects visibly more or fewer, on either side.
    fn differs(&self, normal: &FitReport) -> bool {
        let far = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() > DIFFERENT * a.max(b),
            (None, None) => false,
            _ => true,
        };
        let seen = |ppm: Option<f64>| ppm.map(|ppm| if ppm < LEAST_PPM { 0.0 } else { ppm });
        far(seen(self.ppm_below), seen(normal.ppm_below)) || far(seen(self.ppm_above), seen(normal.ppm_above))
    }

    /// What the size of measured samples leaves open: intervals beside one another, below what they belong to.
    fn sampling(&self, section: &mut Section) {
        let Some(interval) = &self.sampling_interval else { return };
        let samples = interval.samples.iter().take(SAMPLES);
        let samples: Vec<String> = samples.map(|(name, count)| format!("{count} values of {}", short(name))).collect();
        let more = interval.samples.len().saturating_sub(SAMPLES);
        let more = if more > 0 { format!(" and {more} more samples") } else { String::new() };
        let (level, samples) = (100.0 * interval.level, samples.join(", "));
        section.gap();
        section.note(format!("{level} % intervals for {samples}{more}, by {} resamples", interval.resamples));
        let scale = self.sigma.unwrap_or(0.0);
        let range = |ends: Option<[f64; 2]>, text: &dyn Fn(f64) -> String| match ends {
            Some([low, high]) => format!("{} .. {}", text(low), text(high)),
            None => "unknown".to_owned(),
        };
        let value = |ends| range(ends, &|value| beside(value, scale));
        let of_shape = |ends| range(ends, &shape);
        let kept = interval.rejected.map(|[low, high]| [high, low]);
        let limited = self.lower.or(self.upper).is_some();
        let of_limits = |name: &str, text: String| if limited { [name.to_owned(), text] } else { Default::default() };
        let ([yield_, yields], [cpk, cpks]) =
            (of_limits("yield", range(kept, &share)), of_limits("Cpk", range(interval.cpk, &index)));
        section.table(Table::untitled(
            [
                [
                    "mean".to_owned(),
                    value(interval.mean),
                    "skewness".to_owned(),
                    of_shape(interval.skewness),
                    yield_,
                    yields,
                ],
                [
                    "sigma".to_owned(),
                    value(interval.sigma),
                    "kurtosis".to_owned(),
                    of_shape(interval.kurtosis),
                    cpk,
                    cpks,
                ],
            ]
            .map(|row| row.map(Cell::text)),
        ));
    }

    /// The dimensions that vary or do something, with what they do.
    fn shown<'r>(
        &'r self,
        dimensions: &'r [DimensionReport],
    ) -> impl Iterator<Item = (&'r Sensitivity, &'r DimensionReport)> {
        self.sensitivities.iter().zip(dimensions).filter(|(row, dimension)| matters(row, dimension))
    }

    /// What the dimensions do, strongest first.
    pub(super) fn contributions(&self, dimensions: &[DimensionReport]) -> Table {
        type Row<'r> = (&'r Sensitivity, &'r DimensionReport);
        let part = |row: &Sensitivity| Some(row.linear_share? + row.curvature_share.unwrap_or(0.0));
        let all: Vec<Row<'_>> = self.sensitivities.iter().zip(dimensions).collect();
        let mut view: Vec<usize> = (0..all.len()).filter(|&index| matters(all[index].0, all[index].1)).collect();
        let size = |index: usize| part(all[index].0).unwrap_or(-1.0);
        view.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
        let rest = &view[view.len().min(CONTRIBUTIONS)..];
        let together: f64 = rest.iter().filter_map(|&index| part(all[index].0)).sum();
        let rest = format!("and {} more with {} % together; -v shows all", rest.len(), percent(together));
        let number = |value: Option<f64>, row: &Row<'_>, order: usize| {
            let rounding = row.0.rounding.map(|rounding| rounding[order]);
            Cell::both(Value::Number(value), derivative(value, rounding))
        };
        let rounding = |row: &Row<'_>, order: usize| Cell::data(row.0.rounding.map(|rounding| rounding[order]));
        let shift = |row: &Row<'_>| match (row.0.mean_shift, self.sigma) {
            (Some(shift), Some(sigma)) => Cell::number(shift, |shift| rounded(shift, sigma)),
            (shift, _) => Cell::both(Value::Number(shift), UNKNOWN),
        };
        Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .named("dimension", "dimension", |row: &Row<'_>| Cell::name(&row.0.dimension))
            .shown("nominal", |row| Cell::number(row.1.nominal, plain))
            .shown("tolerance", |row| Cell::text(row.1.tolerance()))
            .named("", "unit", |row| Cell::optional(row.1.unit.as_deref()))
            .column("first", "slope", move |row| number(row.0.first, row, 0))
            .column("second", "curvature", move |row| number(row.0.second, row, 1))
            .column("linear_share", "linear %", |row| Cell::number(row.0.linear_share, percent))
            .column("curvature_share", "curved %", |row| Cell::number(row.0.curvature_share, percent))
            .column("mean_shift", "mean shift", shift)
            .data("rounding_first", move |row| rounding(row, 0))
            .data("rounding_second", move |row| rounding(row, 1))
            .table("sensitivities", all.iter().copied())
            .seen(view)
            .at_most([CONTRIBUTIONS, usize::MAX], rest)
    }

    /// The interactions examined: how many, what they make, and the strongest.
    fn pairs(&self, section: &mut Section) {
        let (possible, examined) = (self.possible_interactions, self.interactions.len());
        if possible > 0 && examined == 0 {
            section.note(format!("interactions: none of {possible} examined"));
        } else if possible > 0 {
            let known: Option<Vec<f64>> = self.interactions.iter().map(|interaction| interaction.share).collect();
            let sum = known.map(|shares| format!("{} %", percent(shares.iter().sum())));
            let together = sum.unwrap_or_else(|| "an unknown part".to_owned());
            section
                .note(format!("interactions: {examined} of {possible} examined, {together} of the variance together"));
        }
        section.table(self.interaction_table());
    }

    pub(super) fn interaction_table(&self) -> Table {
        let news = self.interactions.iter().filter(|pair| pair.share.is_none_or(|share| share >= NEWS)).count();
        let most = [news.min(INTERACTIONS), news.min(INTERACTIONS_OF_PAGE)];
        let both = |pair: &&Interaction| {
            let [a, b] = &pair.dimensions;
            Cell {
                full: Some(format!("{a} × {b}")),
                ..Cell::both(Value::Empty, format!("{} × {}", short(a), short(b)))
            }
        };
        Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .data("dimension_a", |pair: &&Interaction| Cell::text(&pair.dimensions[0]))
            .data("dimension_b", |pair| Cell::text(&pair.dimensions[1]))
            .named("", "pair", both)
            .column("mixed", "mixed derivative", |pair| {
                Cell::both(Value::Number(pair.mixed), derivative(pair.mixed, pair.rounding))
            })
            .column("share", "share %", |pair| Cell::number(pair.share, percent))
            .data("rounding", |pair| Cell::data(pair.rounding))
            .table("interactions", &self.interactions)
            .at_most(most, String::new())
    }
}

/// Whether a dimension varies, or does something without.
fn matters(row: &Sensitivity, dimension: &DimensionReport) -> bool {
    dimension.sigma > 0.0 || row.first.is_some_and(|first| first != 0.0)
}

/// The dimensions by the end of their bands, and the others by their values.
fn words(extreme: &Extreme) -> Vec<String> {
    let of = |place: Place| extreme.at.iter().filter(move |at| at.place == place);
    let mut words = Vec::new();
    for (place, title) in [(Place::Lower, "lower "), (Place::Upper, "upper ")] {
        let first = words.len();
        words.extend(of(place).map(|at| short(&at.dimension)));
        if words.len() > first {
            words[first].insert_str(0, title);
            words.last_mut().expect("just pushed").push(';');
        }
    }
    words.extend(
        of(Place::Interior).map(|at| format!("{} = {}", short(&at.dimension), beside(at.x, at.band[1] - at.band[0]))),
    );
    words
}

/// A distribution by itself: its type, its support, its density, its quantiles.
pub fn law_text(law: &Pearson, style: Style) -> String {
    let mut document = Document::default();
    let end = |end: f64| match end.is_finite() {
        true => beside(end, law.sigma()),
        false => format!("{}infinity", if end < 0.0 { "-" } else { "" }),
    };
    let ([lower, upper], kind) = (law.support().map(end), law.kind().name());
    document.line(format!("{}, from {lower} to {upper}", named(kind)));
    document.gap();
    document.chart(Chart::Spread(Box::new(Spread { law: Some(law.clone()), sigma: law.sigma(), ..Spread::default() })));
    document.gap();
    document.table(quantile_table(&named(kind), &Quantiles::of(law), law.sigma()));
    terminal::text(&document, style)
}

fn named(kind: &str) -> String {
    if kind == "normal" { kind.to_owned() } else { format!("Pearson {kind}") }
}

/// Quantiles beside one another, with their probabilities above.
fn quantile_table(law: &str, quantiles: &Quantiles, sigma: f64) -> Table {
    let row = |name: String, cell: &dyn Fn(&(&'static str, f64)) -> Cell| -> [Cell; 8] {
        let mut cells = std::iter::once(Cell::text(name)).chain(quantiles.0.iter().map(cell));
        std::array::from_fn(|_| cells.next().unwrap_or_else(Cell::empty))
    };
    let probability = |&(p, _): &(&'static str, f64)| {
        // `0.00135` as `0.135 %`.
        Cell::number(p.parse::<f64>().ok(), |p| format!("{} %", plain((1e5 * p).round() / 1e3)))
    };
    Table::untitled([
        row(law.to_owned(), &probability),
        row("quantiles".to_owned(), &|(_, value)| Cell::number(*value, |value| beside(value, sigma))),
    ])
}

fn outside(below: Option<f64>, above: Option<f64>) -> String {
    let side = |ppm: Option<f64>, name: &str| ppm.map(|ppm| format!("{} ppm {name}", significant(ppm, 4)));
    let sides: Vec<String> = [side(below, "below"), side(above, "above")].into_iter().flatten().collect();
    if sides.is_empty() { String::new() } else { format!(" ({})", sides.join(", ")) }
}

/// A derivative to six digits; what rounding alone can make is 0 as far as anybody knows.
fn derivative(value: Option<f64>, rounding: Option<f64>) -> String {
    match (value, rounding) {
        (None, _) => UNKNOWN.to_owned(),
        (Some(value), Some(rounding)) if value.abs() <= ROUNDINGS * rounding => "0".to_owned(),
        (Some(value), _) => significant(value, 6),
    }
}

/// Beside sigma, where nothing but zeros is 0.
fn rounded(shift: f64, sigma: f64) -> String {
    let text = beside(shift, sigma);
    if text.parse() == Ok(0.0) { "0".to_owned() } else { text }
}
