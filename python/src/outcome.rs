//! The outcome of a run.

use pyo3::prelude::*;
use sensitol_report::task::TaskReport;

/// The outcome of a run.
#[pyclass(frozen, module = "sensitol._core")]
pub(crate) struct Outcome(pub(crate) TaskReport);

#[pymethods]
impl Outcome {
    /// The report as JSON.
    fn json(&self) -> String {
        self.0.json()
    }

    /// The report as text of this width.
    #[pyo3(signature = (width=80, full=false))]
    fn text(&self, width: usize, full: bool) -> String {
        self.0.text(width, full)
    }

    /// The report as a page.
    fn html(&self) -> String {
        self.0.html()
    }

    /// The charts of the report.
    fn svg(&self, title: &str) -> String {
        self.0.svg(title)
    }

    /// The tables of the report as CSV, by file name.
    fn tables(&self) -> Vec<(String, String)> {
        self.0.tables().into_iter().map(|file| (file.name, file.text)).collect()
    }

    /// The text of the study that an allocation found.
    #[getter]
    fn study(&self) -> Option<&str> {
        self.0.study.as_deref()
    }

    /// The reason why there is no such study.
    #[getter]
    fn not_written(&self) -> Option<&str> {
        self.0.not_written.as_deref()
    }
}
