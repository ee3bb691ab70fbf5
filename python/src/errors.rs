//! Errors of the engine as exceptions of the package.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sensitol_numeric::names::clipped;
use sensitol_study::AnyError;
use sensitol_study::StudyError;

/// Returns the exception of this name in `sensitol._errors`, with these attributes.
fn exception(py: Python<'_>, name: &str, message: String, attributes: &Bound<'_, PyDict>) -> PyResult<PyErr> {
    let class = py.import("sensitol._errors")?.getattr(name)?;
    Ok(PyErr::from_value(class.call((message,), Some(attributes))?))
}

/// Returns the faults of a study: message, place and help. A study made in Python has no file, line or column.
pub(crate) fn of_study(py: Python<'_>, error: &StudyError, made_in_python: bool) -> PyErr {
    let build = || -> PyResult<PyErr> {
        let attributes = one(py, error, made_in_python)?;
        let more = error.more.iter().map(|error| {
            let attributes = one(py, error, made_in_python)?;
            attributes.set_item("message", message(error, made_in_python))?;
            Ok(attributes)
        });
        attributes.set_item("more", more.collect::<PyResult<Vec<_>>>()?)?;
        exception(py, "StudyError", message(error, made_in_python), &attributes)
    };
    build().unwrap_or_else(|error| error)
}

fn help(error: &StudyError) -> Option<String> {
    let error = AnyError::from(error.clone());
    let advice: Vec<String> = error.advice().iter().map(ToString::to_string).collect();
    error.help().or_else(|| (!advice.is_empty()).then(|| advice.join(" ")))
}

/// Formats `file:line:column: key: fault (help)`, without the parts that are unknown.
fn message(error: &StudyError, made_in_python: bool) -> String {
    let mut place = Vec::new();
    if !made_in_python {
        let at = error.line_column().map(|(line, column)| format!(":{line}:{column}")).unwrap_or_default();
        place.push(format!("{}{at}", error.file));
    }
    if !error.key.is_empty() {
        place.push(error.place_name());
    }
    place.push(error.message());
    let help = help(error).map(|help| format!(" ({help})")).unwrap_or_default();
    place.join(": ") + &help
}

fn one<'py>(py: Python<'py>, error: &StudyError, made_in_python: bool) -> PyResult<Bound<'py, PyDict>> {
    let attributes = PyDict::new(py);
    let place = error.line_column().filter(|_| !made_in_python);
    attributes.set_item("file", (!made_in_python).then_some(error.file.as_str()))?;
    attributes.set_item("line", place.map(|(line, _)| line))?;
    attributes.set_item("column", place.map(|(_, column)| column))?;
    attributes.set_item("key", error.place_name())?;
    attributes.set_item("fault", error.message())?;
    attributes.set_item("help", help(error))?;
    Ok(attributes)
}

/// Returns any other error with the actions to take.
pub(crate) fn of_engine(py: Python<'_>, error: &AnyError, made_in_python: bool) -> PyErr {
    if let AnyError::Study(error) = error {
        return of_study(py, error, made_in_python);
    }
    let build = || -> PyResult<PyErr> {
        let advice: Vec<String> = error.advice().iter().map(ToString::to_string).collect();
        let attributes = PyDict::new(py);
        attributes.set_item("advice", &advice)?;
        let said = advice.first().map(|advice| format!(" ({advice})")).unwrap_or_default();
        exception(py, "AnalysisError", format!("{}{said}", clipped(&error.to_string())), &attributes)
    };
    build().unwrap_or_else(|error| error)
}
