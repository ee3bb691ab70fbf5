//! Report of a run, in the forms that a task can request.

use serde::Serialize;

use crate::csv::csv_tables;
use crate::html::{WhatIf, analyze_html};
use crate::{
    AllocationReport, CompareReport, CsvFile, Detail, RareReport, Report, SimulationReport, Style, SweepReport,
    ToDocument, csv_files, svg, text,
};

/// Report of any command.
pub enum Shown {
    /// Report of `analyze`, with the data of its what-if.
    Analysis(Box<(Report, WhatIf)>),
    /// Report of `simulate`.
    Simulation(SimulationReport),
    /// Report of `simulate --rare`.
    Rare(RareReport),
    /// Report of `compare`.
    Comparison(CompareReport),
    /// Report of `sweep`.
    Sweep(SweepReport),
    /// Report of `allocate`.
    Allocation(Box<AllocationReport>),
}

/// Report with its side results.
pub struct TaskReport {
    /// Report of the command.
    pub shown: Shown,
    /// Study with the tolerances that were found.
    pub study: Option<String>,
    /// Reason why there is no such study.
    pub not_written: Option<String>,
    /// Reason why answers of an external model could not be kept, if they were to be.
    pub not_kept: Option<String>,
}

/// Methods of every report, as a trait object.
trait Reported: ToDocument {
    fn json(&self) -> String;
}

impl<R: ToDocument + Serialize> Reported for R {
    fn json(&self) -> String {
        serde_json::to_string(self).expect("reports are plain data")
    }
}

impl TaskReport {
    /// Returns a report without side results.
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

    /// Formats the report as JSON, as `--json -v` prints it.
    pub fn json(&self) -> String {
        self.report().json()
    }

    /// Formats the report as text of this width, with every detail if `full` is set.
    pub fn text(&self, width: usize, full: bool) -> String {
        let detail = if full { Detail::Full } else { Detail::Short };
        let style = Style { detail, unicode: true, color: false, width };
        let report = text(&self.report().document(), style);
        match &self.shown {
            Shown::Analysis(analysis) => report + &analysis.0.closing(style),
            _ => report,
        }
    }

    /// Writes the report as a page.
    pub fn html(&self) -> String {
        match &self.shown {
            Shown::Analysis(analysis) => analyze_html(&analysis.0, Some(&analysis.1)),
            _ => self.report().html(),
        }
    }

    /// Draws the charts of the report.
    pub fn svg(&self, title: &str) -> String {
        svg(&self.report().document(), title)
    }

    /// Writes the tables of the report as CSV.
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
