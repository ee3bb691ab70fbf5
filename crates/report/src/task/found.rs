//! The report of a run, shown as it is asked for.

use serde::Serialize;

use crate::csv::csv_tables;
use crate::html::{WhatIf, analyze_html};
use crate::{
    AllocationReport, CompareReport, CsvFile, Detail, RareReport, Report, SimulationReport, Style, SweepReport,
    ToDocument, csv_files, svg, text,
};

/// A report of any command.
pub enum Shown {
    /// Of `analyze`, with what its page lets a reader try.
    Analysis(Box<(Report, WhatIf)>),
    /// Of `simulate`.
    Simulation(SimulationReport),
    /// Of `simulate --rare`.
    Rare(RareReport),
    /// Of `compare`.
    Comparison(CompareReport),
    /// Of `sweep`.
    Sweep(SweepReport),
    /// Of `allocate`.
    Allocation(Box<AllocationReport>),
}

/// A report, and what else there is.
pub struct TaskReport {
    /// The report.
    pub shown: Shown,
    /// The study with the tolerances that were found.
    pub study: Option<String>,
    /// Why there is none.
    pub not_written: Option<String>,
    /// Why answers of an external program could not be kept, where they were to be.
    pub not_kept: Option<String>,
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

impl TaskReport {
    /// A report, and nothing else.
    pub(crate) fn of(shown: Shown) -> Self {
        Self { shown, study: None, not_written: None, not_kept: None }
    }

    fn report(&self) -> &dyn Reported {
        match &self.shown {
            Shown::Analysis(analysis) => &analysis.0,
            Shown::Simulation(report) => report,
            Shown::Rare(report) => report,
            Shown::Comparison(report) => report,
            Shown::Sweep(report) => report,
            Shown::Allocation(report) => &**report,
        }
    }

    /// The report as JSON, as `--json -v` prints it.
    pub fn json(&self) -> String {
        self.report().json()
    }

    /// The report as text of this width.
    pub fn text(&self, width: usize, full: bool) -> String {
        let detail = if full { Detail::Full } else { Detail::Short };
        text(&self.report().document(), Style { detail, unicode: true, color: false, width })
    }

    /// The report as a page.
    pub fn html(&self) -> String {
        match &self.shown {
            Shown::Analysis(analysis) => analyze_html(&analysis.0, Some(&analysis.1)),
            _ => self.report().html(),
        }
    }

    /// The charts of the report.
    pub fn svg(&self, title: &str) -> String {
        svg(&self.report().document(), title)
    }

    /// Its tables as CSV.
    pub fn tables(&self) -> Vec<CsvFile> {
        let names: &[&str] = match &self.shown {
            Shown::Analysis(analysis) => return csv_files(&analysis.0),
            Shown::Simulation(_) => &["estimates", "histogram"],
            Shown::Rare(_) => &["rare"],
            Shown::Comparison(_) => &["comparison"],
            Shown::Sweep(_) => &["sweep"],
            Shown::Allocation(_) => &["tolerances", "requirements", "front"],
        };
        csv_tables(&self.report().document(), names)
    }
}
