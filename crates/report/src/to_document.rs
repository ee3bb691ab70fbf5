//! Every report as a document and as a page.

use crate::document::Document;
use crate::{
    AllocationReport, CompareReport, DifferenceReport, LotReport, RareReport, Report, SimulationReport, SweepReport,
};

/// A report that can be shown to readers.
/// ```
/// use sensitol_report::{About, Report, ToDocument, markdown};
/// use sensitol::{Closure, Dimension, Method, Problem, analyze};
/// let dimensions = [Dimension::normal("bore", 25.02, 0.01)?, Dimension::normal("shaft", 24.98, 0.01)?];
/// let problem = Problem::new(dimensions, Closure::scalar("clearance", |x| x[0] - x[1]))?;
/// let report = Report::of(&problem, &analyze(&problem, &Method::SecondOrder.into())?, About::default());
/// assert!(markdown(&report.document()).contains("clearance"));
/// # Ok::<(), sensitol::Error>(())
/// ```
pub trait ToDocument {
    /// Builds the sections, tables and charts of the report. [`text`](crate::text), [`csv`](crate::csv()), [`markdown`](crate::markdown)
    /// and [`svg`](crate::svg) write it. Nothing is evaluated.
    fn document(&self) -> Document;

    /// Writes the report as one page of HTML, which needs no network and loads nothing. Nothing is evaluated.
    fn html(&self) -> String;
}

/// Implements the trait by the report's own functions.
macro_rules! to_document {
    ($($report:ident by $html:path),* $(,)?) => {
        $(impl ToDocument for $report {
            fn document(&self) -> Document {
                Self::document(self)
            }

            fn html(&self) -> String {
                $html(self)
            }
        })*
    };
}

/// Writes the page of an analysis without a what-if.
fn analysis_html(report: &Report) -> String {
    crate::html::analyze_html(report, None)
}

to_document! {
    Report by analysis_html,
    SimulationReport by crate::html::simulate_html,
    RareReport by crate::html::rare_html,
    CompareReport by crate::html::compare_html,
    SweepReport by crate::html::sweep_html,
    AllocationReport by crate::html::allocate_html,
    DifferenceReport by crate::html::difference_html,
    LotReport by crate::html::lot_html,
}
