//! The tables of an analysis over all characteristics, dimensions and warnings.

use crate::analysis::analysis_document::CharacteristicSections;
use crate::analysis::yield_source::least_yield;
use crate::document::number::{UNKNOWN, carried, index, limits};
use crate::document::{Blocks, Cell, Column, Columns, DataTable, Document, Value};
use crate::figures::FittedFigures;
use crate::figures::{Figures, Named};
use crate::overview::{NO_LIMITS, verdict, verdict_cell};
use crate::{DimensionReport, Report, WarningReport};
use sensitol::analysis::{CharacteristicAnalysis, EstimatedShare, InspectionRisks};
use sensitol::method::ErrorEstimate;
use sensitol_numeric::capability::{Capability, Law};

impl Report {
    /// Builds the table `characteristics`: a row each, with moments, limits, capability and verdict.
    pub(crate) fn verdicts(&self) -> DataTable {
        type Of<'r> = &'r CharacteristicAnalysis;
        let scaled = |one: &Of<'_>, value: Option<f64>, error: Option<f64>, unknown: &str| {
            let text = value.zip(one.sigma());
            let text = text.map_or(unknown.to_owned(), |(value, sigma)| carried(value, sigma, error));
            Cell::both(Value::Number(value), text)
        };
        let error = |one: &Of<'_>, of: fn(&ErrorEstimate) -> Option<f64>| one.error_estimate.as_ref().and_then(of);
        let all = &self.analysis.characteristics;
        let limited = all.iter().any(Named::limited);
        let judged = all.iter().any(|one| !one.requirements().is_empty());
        let yield_ = |one: &Of<'_>| {
            if !one.limited() {
                return Cell::both(Value::Empty, NO_LIMITS);
            }
            if one.mean().is_none() {
                return Cell::empty();
            }
            Cell::both(Value::Empty, free_or_rejects(one))
        };
        let verdict = |one: &Of<'_>| verdict_cell(verdict(&one.requirements()), one.limited());
        let family = |one: &Of<'_>| match one.fitted() {
            None => [None, None],
            Some(Law::Point { .. }) => [Some("point"), None],
            Some(Law::Pearson(law)) => [Some("pearson"), Some(law.kind().name())],
        };
        let end = |interval: Option<[f64; 2]>, end: usize| Cell::data(interval.map(|ends| ends[end]));
        let fit =
            |one: &Of<'_>, of: fn(&Capability) -> Option<f64>| Cell::data(one.evidence.normal.as_ref().and_then(of));
        let index_of =
            |one: &Of<'_>, of: fn(&Capability) -> Option<f64>| one.distribution.capability.as_ref().and_then(of);
        Columns::default()
            .named("name", "characteristic", |one: &Of<'_>| Cell::name(one.name()))
            .data("unit", |one| Cell::optional(one.unit()))
            .data("nominal", |one| Cell::data(one.nominal))
            .column("mean", "mean", move |one| scaled(one, one.mean(), error(one, |of| of.mean), "unknown"))
            .shown("sigma", move |one| scaled(one, one.sigma(), error(one, |of| of.sigma), UNKNOWN))
            .named("", "unit", |one| Cell::optional(one.unit()))
            .page("limits", |one| Cell::text(limits(one.lower(), one.upper())))
            .shown_if(limited, "Cpk", move |one| Cell::known(index_of(one, |of| of.cpk), index))
            .shown_if(limited, "yield", yield_)
            .shown_if(judged, "verdict", verdict)
            .data("sigma", |one| Cell::data(one.sigma()))
            .data("skewness", |one| Cell::data(one.skewness()))
            .data("kurtosis", |one| Cell::data(one.kurtosis()))
            .data("worst_case_lower", move |one| end(one.range.worst_case, 0))
            .data("worst_case_upper", move |one| end(one.range.worst_case, 1))
            .data("middle", |one| Cell::data(one.linear.middle))
            .data("rss", |one| Cell::data(one.linear.rss))
            .data("inflated_rss", |one| Cell::data(one.linear.inflated_rss))
            .data("mean_shift_rss", |one| Cell::data(one.linear.mean_shift_rss))
            .data("left_out_share", |one| Cell::data(one.contributions.left_out_share))
            .data("distribution", move |one| Cell::optional(family(one)[0]))
            .data("type", move |one| Cell::optional(family(one)[1]))
            .data("lower", |one| Cell::data(one.lower()))
            .data("upper", |one| Cell::data(one.upper()))
            .data("target_yield", |one| Cell::data(one.target()))
            .data("met", |one| Cell::both(Value::Truth(one.met()), ""))
            .data("yield", |one| Cell::data(one.yield_()))
            .data("ppm_below", |one| Cell::data(one.ppm_below()))
            .data("ppm_above", |one| Cell::data(one.ppm_above()))
            .data("cp", move |one| Cell::data(index_of(one, |of| of.cp)))
            .data("cpk", move |one| Cell::data(index_of(one, |of| of.cpk)))
            .data("cp_percentile", move |one| Cell::data(index_of(one, |of| of.cp_percentile)))
            .data("cpk_percentile", move |one| Cell::data(index_of(one, |of| of.cpk_percentile)))
            .data("sigma_level", move |one| Cell::data(index_of(one, Capability::sigma_level)))
            .data("normal_yield", move |one| fit(one, Capability::yield_))
            .data("normal_ppm_below", move |one| fit(one, Capability::ppm_below))
            .data("normal_ppm_above", move |one| fit(one, Capability::ppm_above))
            .data("guard", |one| Cell::data(one.distribution.inspection.as_ref().and_then(|of| of.guard)))
            .data("false_accept", |one| Cell::data(risk(one, |of| of.false_accept)))
            .data("false_reject", |one| Cell::data(risk(one, |of| of.false_reject)))
            .labels(|one| one.characteristic.labels())
            .table("characteristics", all)
            .of_sections()
    }

    /// Joins the rows of several reports below each other, each with the name of its study in front.
    pub fn rows_of_all(reports: &[(String, Self)]) -> Document {
        let mut document = Document::default();
        let mut all: Option<DataTable> = None;
        for (name, report) in reports {
            let own = report.verdicts();
            let table = all.get_or_insert_with(|| {
                let mut columns = own.columns.clone();
                columns
                    .insert(0, Column { key: "of", title: "", heading: "", terminal: true, page: true, label: false });
                DataTable { columns, rows: Vec::new(), view: Vec::new(), ..own.clone() }
            });
            for (column, of_own) in table.columns.iter_mut().skip(1).zip(&own.columns) {
                column.terminal |= of_own.terminal;
                column.page |= of_own.page;
            }
            for mut row in own.rows {
                row.iter_mut().for_each(|cell| cell.leads_to = None);
                row.insert(0, Cell::text(name));
                table.view.push(table.rows.len());
                table.rows.push(row);
            }
        }
        all.into_iter().for_each(|table| document.table(table));
        document
    }

    pub(crate) fn dimension_table(&self) -> DataTable {
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
            .labels(|one| &one.labels)
            .table("dimensions", &self.dimensions)
    }

    pub(crate) fn warning_table(&self) -> DataTable {
        Columns::default()
            .data("code", |one: &&WarningReport| Cell::text(one.code))
            .data("characteristic", |one| Cell::optional(one.characteristic.as_deref()))
            .data("dimension", |one| Cell::optional(one.dimension.as_deref()))
            .data("message", |one| Cell::text(&one.message))
            .table("warnings", &self.warnings)
    }
}

/// Returns a probability from the inspection risks, or None if there is no inspection.
fn risk(one: &CharacteristicAnalysis, share: fn(&InspectionRisks) -> Option<EstimatedShare>) -> Option<f64> {
    Some(share(one.distribution.inspection.as_ref()?)?.value)
}

/// Yield with its error, or the least one over all distributions if one is unknown.
fn free_or_rejects(one: &CharacteristicAnalysis) -> String {
    let free = one.distribution.distribution_free_yield.as_ref().and_then(least_yield);
    free.or_else(|| one.rejects().with_error()).unwrap_or_else(|| "unknown".to_owned())
}
