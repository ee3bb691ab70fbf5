//! Tasks on the text of a study that reads nothing outside a folder, for servers of agents.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sensitol::assembly::{Progress, Run};
use sensitol::summary::StopReason;
use sensitol_report::task::{Task, TaskPlace};

/// Runs a task, given as JSON, and returns the answer or the errors as JSON. `folder` is that of the study's relative paths, and files
/// outside `root` are refused. A program starts only if `starts_programs`. With `seconds` the run ends after that time, and with
/// `study_alone` nothing is evaluated.
#[pyfunction]
pub(crate) fn run_confined(
    py: Python<'_>,
    task: &str,
    folder: PathBuf,
    root: PathBuf,
    starts_programs: bool,
    study_alone: bool,
    seconds: Option<f64>,
) -> PyResult<String> {
    let task = Task::read(task).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let limit = seconds.map(Duration::try_from_secs_f64).transpose();
    let limit = limit.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(py.detach(|| {
        let begun = Instant::now();
        let stop = || limit.filter(|limit| begun.elapsed() >= *limit).map(|_| StopReason::TimeLimit);
        let show = |_: Progress| {};
        let run = Run::to_the_end().stopping_when(&stop).showing(&show);
        let place = TaskPlace { folder, root: Some(root), starts_programs, run, ..TaskPlace::default() };
        if study_alone { task.study(&place) } else { task.run(&place, &|_, _| {}) }
    }))
}

/// Returns the page on warnings: every code, its cause, its consequence and its remedies.
#[pyfunction]
pub(crate) fn warnings_page() -> &'static str {
    include_str!("../../docs/reference/warnings.md")
}
