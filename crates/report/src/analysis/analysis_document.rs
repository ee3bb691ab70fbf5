//! The report of an analysis as a document: the verdict first, then a section for every characteristic.

use crate::analysis::interactions::InteractionSections;
use crate::analysis::interactions::{SHOWN, SHOWN_ON_PAGE};
use crate::analysis::range_bars as bars;
use crate::analysis::stack::Stack;
use crate::analysis::statistics::CharacteristicStatistics;
use crate::analysis::statistics::{derivative, matters, part, size, total};
use crate::analysis::yield_source::{ROUNDING, decision, distribution_free, pearson_fit, source, stand_in};
use crate::document::number::{
    UNKNOWN, beside, carried, carried_ends, index, index_with, known, limits, percent, plain, plural, short,
    significant, within, yielded,
};
use crate::document::rejects::Rejects;
use crate::document::{
    Blocks, Cell, Chart, Columns, DataTable, Document, Element, Line, Paragraph, Section, SpreadChart, Style, Value,
    terminal,
};
use crate::figures::FittedFigures;
use crate::figures::{Figures, Named};
use crate::head;
use crate::head::findings;
use crate::inspection::inspected;
use crate::output_correlation::{all_limits, conditional, together, together_table};
use crate::requirement::{judged, lines};
use crate::sampling::{index_names, sampled};
use crate::{DimensionReport, Report};
use sensitol::analysis::{CharacteristicAnalysis, Sensitivity, YieldSource};
use sensitol::extremes::{Extreme, Place};
use sensitol::method::{Basis, ErrorEstimate, ErrorSource};
use sensitol_numeric::capability::{Capability, EstimatedQuantile, Law, Quantiles};
use sensitol_numeric::correlation::Pair;
use sensitol_numeric::pearson::Pearson;
use sensitol_numeric::sampling::one_error;

/// Contributions that a terminal shows unless all are requested.
const CONTRIBUTIONS: usize = 30;
/// Dimensions that are named, rather than counted, in a sentence.
const NAMED: usize = 8;
/// Heading of the contributions.
pub(crate) const SHARES: &str = "Contributions to the variance";
/// Least relative difference of the reject rates, between the normal fit and the best source, that is worth a line.
const DIFFERENT: f64 = 0.05;
/// Reject rates below this, in ppm, count as zero.
const LEAST_PPM: f64 = 1e-6;

impl Report {
    /// Builds the document with every table: `characteristics`, `dimensions`, `sensitivities`, `interactions`, `quantiles` and
    /// `warnings`.
    pub fn document(&self) -> Document {
        self.with_pairs(usize::MAX)
    }

    /// Builds the document with only as many interactions as a page or a terminal shows.
    pub fn brief_document(&self) -> Document {
        self.with_pairs(SHOWN.max(SHOWN_ON_PAGE))
    }

    fn with_pairs(&self, pairs: usize) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        let evaluations = head::evaluations(&self.analysis.run);
        let varying = plural(self.analysis.varying, "varying dimension", "varying dimensions");
        document.line(format!(
            "{}: {evaluations}, {varying}{}",
            self.analysis.method,
            head::beside(&self.analysis.run)
        ));
        let mut account = Vec::new();
        self.analysis.account.iter().for_each(|one| account.wrapped(0, one.to_string()));
        document.detail(account);
        document.gap();
        document.table(self.verdicts());
        if let Some(joint) = &self.analysis.joint {
            let measured = self.analysis.characteristics.iter().any(|one| one.evidence.sampling.is_some());
            let interval = self.analysis.joint_interval.filter(|_| measured);
            let error = interval.map_or(joint.error, |interval| one_error(joint.value, interval));
            let text = Rejects::all(1.0 - joint.value, Some(error)).yield_text().unwrap_or_default();
            let requirement = self.analysis.joint_requirement.as_ref();
            let reach = match interval.map(|ends| ends.map(yielded)) {
                Some([low, high]) => format!("95 % interval {low} to {high}"),
                // Rounding says nothing about a proven yield.
                None if joint.error < ROUNDING => String::new(),
                None => format!("± {} %", significant(100.0 * joint.error, 2)),
            };
            document.note(all_limits(&text, &reach, requirement));
        }
        if let Some(line) = together(&self.analysis.correlations) {
            document.wrapped(2, line);
        }
        self.labels().into_iter().for_each(|table| document.detail(table));
        let all = self.analysis.characteristics.iter().zip(self.stacks());
        document.sections = all.map(|(one, stack)| self.section(one, &stack, pairs)).collect();
        document.head.extend(
            [self.dimension_table(), together_table(&self.analysis.correlations), self.warning_table()]
                .map(Element::Table),
        );
        document
    }

    /// Section in the order of a first-time reader's questions: verdict and yield, contributors, moments and intervals.
    fn section(&self, one: &CharacteristicAnalysis, stack: &Stack, pairs: usize) -> Section {
        let mut section = Section::of(one.name(), one.unit());
        section.blocks = findings(&self.warnings, |name| name == Some(one.name()));
        one.characteristic.labels().line().into_iter().for_each(|line| section.wrapped(2, line));
        if one.limited() {
            section.words = format!(", limits {}", limits(one.lower(), one.upper()));
            one.kept(&mut section);
        }
        decision(one, &self.analysis.run).into_iter().for_each(|line| section.wrapped(2, line));
        let concerned = self.warnings.iter().filter(|warning| warning.characteristic.as_deref() == Some(one.name()));
        let codes: Vec<&str> = concerned.filter(|one| one.asks()).map(|warning| warning.code).collect();
        if !codes.is_empty() {
            section.brief(vec![Element::Paragraph(Paragraph::note(format!("warnings: {}", codes.join(", "))))]);
        }
        section.gap();
        self.contributed(one, &mut section, pairs);
        section.gap();
        one.statistics(&mut section);
        one.errors(&mut section);
        one.extremes(&mut section);
        one.distribution(&mut section);
        one.evidence
            .sampling
            .iter()
            .for_each(|of| sampled(&mut section, of, one.sigma().unwrap_or(0.0), one.limited()));
        if let Some(spans) = bars::spans(one) {
            section.aside("Worst case and RSS", vec![Element::Chart(Chart::Bars(spans))]);
        }
        if stack.straight() {
            let mut blocks: Vec<Element> = stack.tables().map(Element::Table).into();
            stack.notes.iter().for_each(|note| blocks.note(note.to_string()));
            section.aside("Stack", blocks);
        }
        section
    }

    /// Adds the contributors, the sensitivities, and the interactions.
    fn contributed(&self, one: &CharacteristicAnalysis, section: &mut Section, pairs: usize) {
        section.brief(vec![Element::Table(one.contributors(&self.dimensions))]);
        let mut all = vec![Element::Table(one.contributions(&self.dimensions))];
        all.remark("Slope and curvature at the means, per unit of the dimension; ≈ marks those that are differences.");
        if let Some(source) = self.source(one) {
            all.note(source);
        }
        section.detail(all);
        self.features(one, section);
        self.correlations(one, section);
        if one.has_negative_contributions() {
            section.note("a contribution below 0 lowers the variance: it varies against the others");
        }
        one.pairs(section, pairs);
        // Pages draw the contributions as bars.
        let mut left = Vec::new();
        bars::left_out(one).into_iter().for_each(|words| left.note(words));
        section.aside(SHARES, left);
    }

    /// Returns a sentence on the source of slopes and curvatures, or None if all come from differences.
    fn source(&self, one: &CharacteristicAnalysis) -> Option<String> {
        let shown: Vec<_> = one.shown(&self.dimensions).map(|(row, _)| row).collect();
        let differences: Vec<String> = shown.iter().filter(|row| !row.exact).map(|row| short(&row.dimension)).collect();
        if differences.len() == shown.len() {
            return None;
        }
        let but = match differences.len() {
            0 => String::new(),
            1..=NAMED => format!(", but by differences for {}", differences.join(", ")),
            many => format!(", but by differences for {many} dimensions"),
        };
        let rest = match self.analysis.basis {
            Basis::Exact => "everything rests on them",
            Basis::Differences => "the rest comes from differences",
            Basis::LeastSquares => "the rest comes from the fitted surface",
            Basis::Quadrature => "the moments come from quadrature",
        };
        Some(format!("slopes and curvatures are exact{but}; {rest}"))
    }

    /// Lists correlated pairs of dimensions that affect this characteristic.
    fn correlations(&self, one: &CharacteristicAnalysis, section: &mut Section) {
        let matters =
            |name: &String| one.sensitivities.iter().any(|row| row.dimension == *name && row.first != Some(0.0));
        let word =
            |pair: &Pair| format!("{} × {} {}", short(&pair.between[0]), short(&pair.between[1]), plain(pair.value));
        let pairs = self.correlation.iter().filter(|pair| pair.between.iter().all(matters));
        let words: Vec<String> = pairs.map(word).collect();
        if !words.is_empty() {
            section.list("  correlated:", words);
            section.note("shares are covariances with the whole, the worst case ignores correlations");
        }
    }
}

/// Remark of figures without verification. Errors of a surface that is not proven are conditional.
fn not_verified(estimate: Option<&ErrorEstimate>) -> String {
    let proven = |of: &ErrorEstimate| matches!(of.sources[..], [ErrorSource::Proven { .. }]);
    let conditional = estimate.is_some_and(|of| !proven(of));
    format!("not verified by the model{}", if conditional { ": errors hold if the surface does" } else { "" })
}

/// Sections of the report of a characteristic.
pub(crate) trait CharacteristicSections {
    /// Adds the verification of the figures and the basis of their error estimates.
    fn errors(&self, section: &mut Section);

    /// Adds the extremes, their places, and whether they are proven.
    fn extremes(&self, section: &mut Section);

    /// Adds the distribution and its quantiles.
    fn distribution(&self, section: &mut Section);

    fn covered(&self, section: &mut Section);

    /// Chart of the density, over the histogram of the model if there is one.
    fn spread(&self, law: &Pearson, kind: &str) -> SpreadChart;

    fn quantile_data(&self) -> DataTable;

    /// Adds yield, target and verdict, the indices, and the other requirements.
    fn kept(&self, section: &mut Section);

    /// Line of the yield with the rejects on both sides.
    fn yield_line(&self) -> String;

    /// Line of the indices, None if there are none.
    fn index_line(&self) -> Option<String>;

    /// Reject rates with their error.
    fn rejects(&self) -> Rejects;

    /// True if the reject rate of the normal fit differs visibly on either side.
    fn differs(&self, normal: &Capability) -> bool;

    /// Dimensions that vary or affect the characteristic, with their sensitivities.
    fn shown<'r>(
        &'r self,
        dimensions: &'r [DimensionReport],
    ) -> impl Iterator<Item = (&'r Sensitivity, &'r DimensionReport)>;

    /// Table of the contributions of the dimensions, strongest first.
    fn contributions(&self, dimensions: &[DimensionReport]) -> DataTable;
}

impl CharacteristicSections for CharacteristicAnalysis {
    fn errors(&self, section: &mut Section) {
        let error = |error: Option<f64>| known(error, |error| significant(error, 2));
        match &self.evidence.verification {
            Some(found) => section.note(found.words()),
            // No remark if there are no moments, or if nothing that varies has an effect.
            // Points of the model need no verification.
            None if self.evidence.model_sampled.is_some() => {}
            None if self.mean().is_some() && !self.constant => section.note(not_verified(self.error_estimate.as_ref())),
            None => {}
        }
        let mut detail = Vec::new();
        if let Some(fit) = &self.evidence.residual {
            detail.note(format!(
                "{} coefficients fitted to {} points: residual standard error {}, of the mean {}, of sigma {}",
                fit.coefficients,
                fit.points,
                error(fit.standard_error),
                error(fit.mean),
                error(fit.sigma)
            ));
        }
        if let Some(estimate) = &self.error_estimate {
            let basis: Vec<String> = estimate.sources.iter().map(|source| source.words()).collect();
            detail.wrapped(2, format!("error estimates are based on: {}", basis.join("; ")));
        }
        if let Some(sampled) = self.error_estimate.as_ref().and(self.evidence.model_sampled.as_ref()) {
            let points = format!("mean to kurtosis from {} points of the model", sampled.samples);
            section.wrapped(
                2,
                match sampled.left {
                    Some(_) => format!("the surface is not trusted: {points}, with the surface as control variate"),
                    None => format!("{points}: no surface follows a choice from stock"),
                },
            );
        }
        if let Some(of) = self.coefficient_of_variation() {
            let percent = within(100.0 * of.value, 4, Some(100.0 * of.error));
            detail.note(format!("coefficient of variation {percent} %"));
        }
        if let Some(sampled) = &self.evidence.sampled {
            let [sigma, skewness, kurtosis] =
                [sampled.sigma, sampled.skewness, sampled.kurtosis].map(|error| significant(error, 2));
            detail.note(format!(
                "sampled from the surface, {} points: standard error of sigma {sigma}, skewness {skewness}, kurtosis {kurtosis}",
                sampled.samples
            ));
        }
        section.detail(detail);
    }

    fn extremes(&self, section: &mut Section) {
        let Some(found) = &self.range.extremes else { return };
        let scale = self.scale();
        let [least, greatest] = carried_ends([found.least.value, found.greatest.value], scale, None);
        let proven = if found.proven() { "proven" } else { "not proven" };
        let evaluations = plural(found.evaluations, "evaluation", "evaluations");
        section.note(format!("extremes  {least} .. {greatest}  {proven}, {evaluations}"));
        section.list("    least at   ", words(&found.least));
        section.list("    greatest at", words(&found.greatest));
    }

    fn distribution(&self, section: &mut Section) {
        match self.fitted() {
            None if self.sigma().is_some() => {
                return section.note("no distribution has this skewness and kurtosis: its yield is unknown");
            }
            None => return,
            Some(Law::Point { at }) if self.constant => {
                section.note(format!("every assembly has the same value: {}", plain(*at)));
            }
            // Nothing proves that the characteristic has this value everywhere.
            Some(Law::Point { at }) => {
                section.note(format!("all evaluated points have the same value: {}", plain(*at)))
            }
            Some(Law::Pearson(law)) => {
                let (kind, sigma) = (law.kind().name(), self.sigma().unwrap_or(0.0));
                let mut detail =
                    vec![Element::Gap, Element::Chart(Chart::Spread(Box::new(self.spread(law, kind)))), Element::Gap];
                match &self.distribution.quantiles {
                    Some(of) => {
                        detail.note(format!("quantiles by {}", of.source.words()));
                        detail.table(quantile_table("share below", &of.values, sigma));
                    }
                    None => detail.note("the quantiles are unknown"),
                }
                section.detail(detail);
            }
        }
        if self.evidence.surface_law.is_some_and(|law| law.steps) && self.sigma().is_some_and(|sigma| sigma > 0.0) {
            section.note("the surface law is a step function: all that varies has single values");
        }
        if let Some(points) = self.evidence.surface_law.as_ref().and_then(|law| law.counted) {
            section.note(format!("the surface law is counted at {points} points of the surface"));
        }
        section.table(self.quantile_data());
        self.covered(section);
    }

    fn covered(&self, section: &mut Section) {
        let Some(of) = &self.distribution.coverage else { return };
        /// Least relative difference of the shortest interval from that with equal tails that is worth a line.
        const NOTABLE: f64 = 0.01;
        let share = plain(100.0 * of.probability);
        let width = |[from, to]: [f64; 2]| to - from;
        let scale = self.sigma().filter(|sigma| *sigma > 0.0);
        let interval = |ends: [f64; 2], errors: [Option<f64>; 2]| {
            let error = errors[0].zip(errors[1]).map(|(from, to)| from.min(to));
            scale.map_or_else(|| ends.map(plain), |sigma| carried_ends(ends, sigma, error)).join(" .. ")
        };
        let equal_tails = interval(of.equal_tails, of.equal_tails_errors);
        section.note(format!("{share} % within {equal_tails} (equal tails), by {}", of.source.words()));
        if width(of.shortest) < (1.0 - NOTABLE) * width(of.equal_tails) {
            section.note(format!("  the shortest such interval: {}", interval(of.shortest, of.shortest_errors)));
        }
    }

    fn spread(&self, law: &Pearson, kind: &str) -> SpreadChart {
        let sample = self.evidence.model_sampled.as_ref().and_then(|sampling| sampling.histogram.as_ref());
        let names = ["0.135 %", "median", "99.865 %"];
        let outer = self.distribution.quantiles.map_or([None; 3], |of| [0, 3, 6].map(|index| of.values.0[index]));
        let marked = names.into_iter().zip(outer).filter_map(|(name, found)| Some((found?.value, "quantile", name)));
        let mut places: Vec<_> = marked.collect();
        let fit = if kind == "normal" { "normal fit".to_owned() } else { format!("Pearson fit, type {kind}") };
        let sampled = self.distribution.quantiles.is_some_and(|of| of.source == YieldSource::Samples)
            && self.evidence.verification.as_ref().is_some_and(|of| !of.follows_surface());
        let source = if sampled { "distribution of the sample" } else { "distribution by the surface" };
        let accuracy = self.evidence.density.as_ref().map_or(String::new(), |table| accuracy(table));
        places.extend(self.mean().map(|mean| (mean, "mean", "mean")));
        SpreadChart {
            law: Some(law.clone()),
            curve: self
                .evidence
                .density
                .as_ref()
                .map(|table| table.iter().map(|&[y, density, _]| [y, density]).collect()),
            bins: sample.cloned(),
            sampled: false,
            limits: Named::limits(self),
            rejects: self.rejects().by_side(),
            ranges: bars::ranges(self),
            nominal: self.nominal,
            places,
            sigma: self.sigma().unwrap_or(0.0),
            label: format!("Density of {}", self.name()),
            curve_name: format!("{source}{accuracy}"),
            law_name: fit,
        }
    }

    fn quantile_data(&self) -> DataTable {
        let source = self.distribution.quantiles.map_or("", |of| of.source.name());
        Columns::default()
            .data("characteristic", |_| Cell::text(self.name()))
            .data("probability", |row: &(&'static str, &Option<EstimatedQuantile>)| Cell::text(row.0))
            .data("value", |row| Cell::data(row.1.map(|of| of.value)))
            .data("error", |row| Cell::data(row.1.and_then(|of| of.error)))
            .data("source", move |_| Cell::text(source))
            .table("quantiles", self.distribution.quantiles.iter().flat_map(|of| of.values.iter()))
    }

    fn kept(&self, section: &mut Section) {
        let free = self.distribution.distribution_free_yield.as_ref();
        let target = judged(self.target(), self.verdict());
        let reason = "too few assemblies keep it, or their share is unknown";
        let conditional = conditional(&self.characteristic, self.distribution.conditional.as_ref(), reason);
        let plain = Line::from(self.yield_line());
        // The target is that of the assemblies that count.
        section.note(if conditional.is_some() { plain } else { plain.and(target.clone()) });
        conditional.into_iter().for_each(|line| section.note(Line::from(line).and(target.clone())));
        if let Some(free) = free {
            section.note(stand_in(free));
        }
        source(self).into_iter().for_each(|line| section.note(line));
        self.index_line().into_iter().for_each(|line| section.note(line));
        lines(self.requirements()).for_each(|line| section.note(line));
        if let Some(of) = &self.distribution.inspection {
            inspected(section, of);
        }
        let mut detail = Vec::new();
        let of = |figure: fn(&Capability) -> Option<f64>| self.distribution.capability.as_ref().and_then(figure);
        let names = index_names(self.evidence.sampling.is_some());
        let indices = [of(|of| of.cp_percentile), of(|of| of.cpk_percentile)];
        let errors =
            self.distribution.quantiles.map_or([None; 2], |of| [of.cp_percentile_error, of.cpk_percentile_error]);
        let with_error = |((name, index), error): ((&str, Option<f64>), Option<f64>)| {
            index.map(|index| format!("{name} {}", index_with(index, error)))
        };
        let quantiles = names.into_iter().zip(indices).zip(errors).filter_map(with_error);
        let quantiles = quantiles.collect::<Vec<String>>().join("  ");
        if !quantiles.is_empty() {
            detail.note(format!("by quantiles (ISO 22514-2): {quantiles}"));
        }
        pearson_fit(self).into_iter().for_each(|line| detail.wrapped(2, line));
        if let Some(normal) = self.evidence.normal.as_ref().filter(|normal| self.differs(normal)) {
            let rejects = Rejects::new(normal.below, normal.above, None);
            detail.note(format!("a normal fit would say: {}", yield_line(&rejects)));
        }
        section.detail(detail);
    }

    fn yield_line(&self) -> String {
        match &self.distribution.distribution_free_yield {
            Some(free) => format!("yield {}", distribution_free(free)),
            None => yield_line(&self.rejects()),
        }
    }

    fn index_line(&self) -> Option<String> {
        let found = self.distribution.capability.as_ref()?;
        let level = found.sigma_level().filter(|_| self.rejects().are_resolved());
        let [cp, cpk] = index_names(self.evidence.sampling.is_some());
        let named = [(cp, found.cp), (cpk, found.cpk), ("sigma level", level)];
        let indices = named.into_iter().filter_map(|(name, value)| Some(format!("{name} {}", index(value?))));
        Some(indices.collect::<Vec<String>>().join("  ")).filter(|line| !line.is_empty())
    }

    fn rejects(&self) -> Rejects {
        let error = match self.evidence.sampling.as_ref().and(self.yield_()) {
            Some(value) => self.yield_interval().map(|interval| one_error(value, interval)),
            None => self.error_estimate.as_ref().and_then(|estimate| estimate.yield_),
        };
        let [below, above] = [|of: &Capability| of.below, |of: &Capability| of.above]
            .map(|side| self.distribution.capability.as_ref().and_then(side));
        Rejects::new(below, above, error).within(self.distribution.reject_intervals)
    }

    fn differs(&self, normal: &Capability) -> bool {
        let far = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() > DIFFERENT * a.max(b),
            (None, None) => false,
            _ => true,
        };
        let seen = |ppm: Option<f64>| ppm.map(|ppm| if ppm < LEAST_PPM { 0.0 } else { ppm });
        far(seen(self.ppm_below()), seen(normal.ppm_below())) || far(seen(self.ppm_above()), seen(normal.ppm_above()))
    }

    fn shown<'r>(
        &'r self,
        dimensions: &'r [DimensionReport],
    ) -> impl Iterator<Item = (&'r Sensitivity, &'r DimensionReport)> {
        self.sensitivities.iter().zip(dimensions).filter(|(row, dimension)| matters(row, dimension))
    }

    fn contributions(&self, dimensions: &[DimensionReport]) -> DataTable {
        type Row<'r> = (&'r Sensitivity, &'r DimensionReport);
        let all: Vec<Row<'_>> = self.sensitivities.iter().zip(dimensions).collect();
        let mut view: Vec<usize> = (0..all.len()).filter(|&index| matters(all[index].0, all[index].1)).collect();
        let size = |index: usize| size(all[index].0);
        view.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
        let rest = &view[view.len().min(CONTRIBUTIONS)..];
        let together: f64 = rest.iter().filter_map(|&index| part(all[index].0)).sum();
        let rest = format!("and {} more with {} % together; -v shows all", rest.len(), percent(together));
        let number = |value: Option<f64>, row: &Row<'_>, order: usize| {
            let rounding = row.0.rounding.map(|rounding| rounding[order]);
            let text = derivative(value, rounding, 6);
            let cell = Cell::both(Value::Number(value), text.as_str());
            if row.0.exact || value.is_none() { cell } else { cell.on_pages(format!("{text} ≈")) }
        };
        let rounding = |row: &Row<'_>, order: usize| Cell::data(row.0.rounding.map(|rounding| rounding[order]));
        let shift = |row: &Row<'_>| match (row.0.mean_shift, self.sigma()) {
            (Some(shift), Some(sigma)) => Cell::number(shift, |shift| rounded(shift, sigma)),
            (shift, _) => Cell::both(Value::Number(shift), UNKNOWN),
        };
        Columns::default()
            .data("characteristic", |_| Cell::text(self.name()))
            .named("dimension", "dimension", |row: &Row<'_>| Cell::name(&row.0.dimension))
            .shown("nominal", |row| Cell::number(row.1.nominal, plain))
            .shown("tolerance", |row| Cell::text(row.1.tolerance()))
            .named("", "unit", |row| Cell::optional(row.1.unit.as_deref()))
            .column("first", "slope", move |row| number(row.0.first, row, 0))
            .column("second", "curvature", move |row| number(row.0.second, row, 1))
            .column("linear_share", "linear %", |row| Cell::number(row.0.linear_share, percent))
            .column("curvature_share", "curved %", |row| Cell::number(row.0.curvature_share, percent))
            .column("mean_shift", "mean shift", shift)
            .shown_if(self.has_totals(), "total %", |row| Cell::number(total(row.0), percent))
            .data("rounding_first", move |row| rounding(row, 0))
            .data("rounding_second", move |row| rounding(row, 1))
            .data("first_order", |row| Cell::data(row.0.first_order.map(|index| index.value)))
            .data("first_order_error", |row| Cell::data(row.0.first_order.and_then(|index| index.error)))
            .data("total", |row| Cell::data(total(row.0)))
            .data("total_error", |row| Cell::data(row.0.total.and_then(|index| index.error)))
            .table("sensitivities", all.iter().copied())
            .seen(view)
            .at_most([CONTRIBUTIONS, usize::MAX], rest)
    }
}

/// Line of a yield with the rejects on both sides.
fn yield_line(rejects: &Rejects) -> String {
    format!("yield {}", rejects.text().unwrap_or_else(|| "unknown".to_owned()))
}

/// Returns the error of a drawn density in words, empty if it is too small to be seen.
fn accuracy(table: &[[f64; 3]]) -> String {
    /// Least visible error, as a part of the peak: the width of a line.
    const SEEN: f64 = 1e-3;
    let most = |of: fn(&[f64; 3]) -> f64| table.iter().map(of).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let (peak, error) = (most(|row| row[1]), most(|row| row[2]));
    match error > SEEN * peak {
        true => format!(", from points within ± {} % of its peak", significant(100.0 * error / peak, 2)),
        false => String::new(),
    }
}

/// Lists the dimensions at the lower and upper ends of their bands, then those in between with their values.
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

/// Prints a Pearson distribution by itself: its type, support, density and quantiles.
pub fn law_text(law: &Pearson, style: Style) -> String {
    let mut document = Document::default();
    let end = |end: f64| match end.is_finite() {
        true => beside(end, law.sigma()),
        false => format!("{}infinity", if end < 0.0 { "-" } else { "" }),
    };
    let ([lower, upper], kind) = (law.support().map(end), law.kind().name());
    document.line(format!("{}, from {lower} to {upper}", named(kind)));
    document.gap();
    document.chart(Chart::Spread(Box::new(SpreadChart {
        law: Some(law.clone()),
        sigma: law.sigma(),
        ..SpreadChart::default()
    })));
    document.gap();
    let exact = Quantiles::of(law).0.map(|value| Some(EstimatedQuantile { value, error: None }));
    document.table(quantile_table("share below", &Quantiles(exact), law.sigma()));
    terminal::text(&document, style)
}

fn named(kind: &str) -> String {
    if kind == "normal" { kind.to_owned() } else { format!("Pearson {kind}") }
}

/// Table of quantiles, one a row: its probability, its value, and its error if it is known.
fn quantile_table(title: &'static str, quantiles: &Quantiles<Option<EstimatedQuantile>>, sigma: f64) -> DataTable {
    type Entry<'q> = (&'static str, &'q Option<EstimatedQuantile>);
    let probability = |(p, _): &Entry<'_>| {
        // Rounded, so that `0.00135` becomes `0.135 %`.
        Cell::number(p.parse::<f64>().ok(), |p| format!("{} %", plain((1e5 * p).round() / 1e3)))
    };
    let value = move |(_, found): &Entry<'_>| match found {
        Some(of) => Cell::number(of.value, |value| carried(value, sigma, of.error)),
        None => Cell::text(UNKNOWN),
    };
    // An error of 0 is that of a value that does not vary.
    let error = |(_, found): &Entry<'_>| match found.and_then(|of| of.error).filter(|error| *error > 0.0) {
        Some(error) => Cell::text(format!("± {}", significant(error, 2))),
        None => Cell::empty(),
    };
    Columns::default().shown(title, probability).shown("value", value).shown("", error).table("", quantiles.iter())
}

/// Formats a mean shift with the digits of sigma, or as `0` if all of them are zeros.
fn rounded(shift: f64, sigma: f64) -> String {
    let text = beside(shift, sigma);
    if text.parse() == Ok(0.0) { "0".to_owned() } else { text }
}
