//! What a run found out: a report, shown as it is asked for.

use pyo3::prelude::*;
use sensitol::internals::{WhatIf, analyze_html, csv_tables};
use sensitol::report::{
    AllocationReport, CompareReport, CsvFile, Detail, RareReport, Report, SimulationReport, Style, SweepReport,
    ToDocument, csv_files, svg, text,
};
use serde::Serialize;

/// A report of any command.
pub(crate) enum Shown {
    Analysis(Box<(Report, WhatIf)>),
    Simulation(SimulationReport),
    Rare(RareReport),
    Comparison(CompareReport),
    Sweep(SweepReport),
    Allocation(Box<AllocationReport>),
}

/// A report, and what else there is.
pub(crate) struct Found {
    pub(crate) shown: Shown,
    /// The study with the tolerances that were found.
    pub(crate) study: Option<String>,
    /// Why there is none.
    pub(crate) not_written: Option<String>,
    /// Why answers of an external program could not be kept, where they were to be.
    pub(crate) not_kept: Option<String>,
}

impl Found {
    pub(crate) fn of(shown: Shown) -> Self {
        Self { shown, study: None, not_written: None, not_kept: None }
    }
}

/// A trait object of what all reports have.
trait Reported: ToDocument {
    fn json(&self) -> String;
}

impl<R: ToDocument + Serialize> Reported for R {
    fn json(&self) -> String {
        serde_json::to_string(self).expect("reports are plain data")
    }
}

impl Shown {
    fn report(&self) -> &dyn Reported {
        match self {
            Self::Analysis(analysis) => &analysis.0,
            Self::Simulation(report) => report,
            Self::Rare(report) => report,
            Self::Comparison(report) => report,
            Self::Sweep(report) => report,
            Self::Allocation(report) => &**report,
        }
    }

    fn tables(&self) -> Vec<CsvFile> {
        let names: &[&str] = match self {
            Self::Analysis(analysis) => return csv_files(&analysis.0),
            Self::Simulation(_) => &["estimates", "histogram"],
            Self::Rare(_) => &["rare"],
            Self::Comparison(_) => &["comparison"],
            Self::Sweep(_) => &["sweep"],
            Self::Allocation(_) => &["tolerances", "requirements", "front"],
        };
        csv_tables(&self.report().document(), names)
    }
}

/// The outcome of a run.
#[pyclass(frozen, module = "sensitol._core")]
pub(crate) struct Outcome(pub(crate) Found);

#[pymethods]
impl Outcome {
    /// The report as JSON.
    fn json(&self) -> String {
        self.0.shown.report().json()
    }

    /// The report as text of this width.
    #[pyo3(signature = (width=100, full=false))]
    fn text(&self, width: usize, full: bool) -> String {
        let detail = if full { Detail::Full } else { Detail::Short };
        text(&self.0.shown.report().document(), Style { detail, unicode: true, color: false, width })
    }

    /// The report as a page.
    fn html(&self) -> String {
        match &self.0.shown {
            Shown::Analysis(analysis) => analyze_html(&analysis.0, Some(&analysis.1)),
            other => other.report().html(),
        }
    }

    /// The charts of the report.
    fn svg(&self, title: &str) -> String {
        svg(&self.0.shown.report().document(), title)
    }

    /// Its tables as CSV, by file name.
    fn tables(&self) -> Vec<(String, String)> {
        self.0.shown.tables().into_iter().map(|file| (file.name, file.text)).collect()
    }

    /// The text of the study that an allocation found.
    #[getter]
    fn study(&self) -> Option<&str> {
        self.0.study.as_deref()
    }

    /// Why there is none.
    #[getter]
    fn not_written(&self) -> Option<&str> {
        self.0.not_written.as_deref()
    }
}
