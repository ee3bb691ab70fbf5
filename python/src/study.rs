//! A study on the side of Python: its text and its parsed content.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use sensitol::assembly::Signature;
use sensitol_external::Greeting;
use sensitol_report::task::Asked;
use sensitol_study::AnyError;
use sensitol_study::StudyError;
use sensitol_study::{Externals, JournalPlace, StudyText};
use serde_json::json;

use crate::errors::{of_engine, of_study};
use crate::host::{Event, Host};
use crate::law::Law;
use crate::outcome::Outcome;
use crate::running::{Caller, Ended, run};

/// Signature of the model and first message to it, once they are known.
type Hello = Arc<Mutex<Option<(Signature, Greeting)>>>;

/// The text of a study, with the files that it names.
#[pyclass(frozen, module = "sensitol._core")]
pub(crate) struct Study {
    text: String,
    toml: bool,
    name: String,
    folder: PathBuf,
    files: BTreeMap<String, Vec<u8>>,
    /// True if the study was made of Python objects, so that its text has no file.
    made_in_python: bool,
    /// None if the model is not a Python function, else true if the function is cheap.
    hosted: Option<bool>,
    /// Name of the selected configuration.
    configuration: Option<String>,
    described: String,
    /// Parsed dimensions, with their distributions.
    dimensions: Vec<sensitol::Dimension>,
}

impl Study {
    fn parsed(
        &self,
        parameter: Option<&str>,
        journal: JournalPlace,
        events: Option<Sender<Event<Ended>>>,
        whole: bool,
    ) -> Result<(sensitol_study::Study, Hello), StudyError> {
        let hello: Hello = Hello::default();
        let mut externals = configured(Externals::default().with_journal(journal), self.configuration.as_deref());
        if let Some(cheap) = self.hosted {
            let heard = Arc::clone(&hello);
            externals = externals.with_host(move |signature, greeting| {
                *heard.lock().unwrap_or_else(PoisonError::into_inner) = Some((signature.clone(), greeting));
                // Without a run there is no receiver, and a closed channel ends every call.
                let events = events.clone().unwrap_or_else(|| channel().0);
                Arc::new(Host::new(signature, (cheap, whole), events))
            });
        }
        let text = match self.toml {
            true => StudyText::toml(&self.name, &self.text),
            false => StudyText::json(&self.name, &self.text),
        };
        let text = text.in_folder(&self.folder).with_externals(externals);
        let text = self.files.iter().fold(text, |text, (name, bytes)| text.with_file(name, bytes));
        let text = parameter.map_or(text.clone(), |parameter| text.sweeping(parameter));
        Ok((sensitol_study::Study::from_text(text)?, hello))
    }
}

/// Returns a description of the study for Python, as JSON.
fn described(study: &sensitol_study::Study, hello: &Hello) -> String {
    let dimension = |one: &sensitol::Dimension| {
        json!({
            "name": one.name(), "unit": one.unit(), "nominal": one.nominal(), "tolerance": one.tolerance(),
            "mean": one.mean(), "sigma": one.sigma(),
            "distribution": one.distribution().map(|distribution| distribution.name()),
        })
    };
    let warning = |one: &sensitol::Warning| json!({ "code": one.code(), "message": one.message() });
    let hello = hello.lock().unwrap_or_else(PoisonError::into_inner);
    let model = hello.as_ref().map(|(signature, greeting)| spoken(signature, greeting));
    json!({
        "title": study.title,
        "dimensions": study.problem.dimensions().iter().map(dimension).collect::<Vec<_>>(),
        "configurations": study.configurations,
        "characteristics": study.problem.characteristics().iter().map(|one| one.name()).collect::<Vec<_>>(),
        "warnings": study.warnings.iter().map(warning).collect::<Vec<_>>(),
        "sha256": study.sha256,
        "model": model,
    })
    .to_string()
}

/// Returns the first message to a model, as JSON.
fn spoken(signature: &Signature, greeting: &Greeting) -> serde_json::Value {
    json!({
        "inputs": signature.inputs.iter().map(|input| &input.name).collect::<Vec<_>>(),
        "outputs": signature.outputs.iter().map(|output| &output.name).collect::<Vec<_>>(),
        "nominal": greeting.nominal,
        "constants": greeting.constants,
        "optional": greeting.optional,
    })
}

fn configured(externals: Externals, configuration: Option<&str>) -> Externals {
    match configuration {
        Some(name) => externals.with_configuration(name),
        None => externals,
    }
}

#[pymethods]
impl Study {
    /// Reads a study from text. `hosted` is None if the model is not a Python function, else true if the function is cheap.
    #[staticmethod]
    #[pyo3(signature = (text, toml, name, folder, files, made_in_python, hosted, configuration))]
    #[allow(clippy::too_many_arguments, reason = "the package alone calls it, by position")]
    fn from_text(
        py: Python<'_>,
        text: String,
        toml: bool,
        name: String,
        folder: PathBuf,
        files: BTreeMap<String, Vec<u8>>,
        made_in_python: bool,
        hosted: Option<bool>,
        configuration: Option<String>,
    ) -> PyResult<Self> {
        let study = Self {
            text,
            toml,
            name,
            folder,
            files,
            made_in_python,
            hosted,
            configuration,
            described: String::new(),
            dimensions: Vec::new(),
        };
        let (parsed, hello) = study
            .parsed(None, JournalPlace::Nowhere, None, true)
            .map_err(|error| of_study(py, &error, made_in_python))?;
        Ok(Self { described: described(&parsed, &hello), dimensions: parsed.problem.dimensions().to_vec(), ..study })
    }

    /// Reads a study from a file.
    #[staticmethod]
    #[pyo3(signature = (path, hosted, configuration))]
    fn read(py: Python<'_>, path: PathBuf, hosted: Option<bool>, configuration: Option<String>) -> PyResult<Self> {
        // The file is read once. Its text is parsed again with the model, so that errors of the model appear in both cases.
        let mut externals = configured(Externals::default(), configuration.as_deref());
        if let Some(cheap) = hosted {
            externals = externals.with_host(move |signature, _| {
                Arc::new(Host::new(signature, (cheap, true), channel::<Event<Ended>>().0))
            });
        }
        let read = sensitol_study::Study::read_with(&path, externals).map_err(|error| of_study(py, &error, false))?;
        let toml = path.extension().is_some_and(|extension| extension == "toml");
        let (name, folder) = (path.display().to_string(), read.folder().to_owned());
        Self::from_text(py, read.text().to_owned(), toml, name, folder, BTreeMap::new(), false, hosted, configuration)
    }

    /// The description of the study, as JSON.
    #[getter]
    fn described(&self) -> &str {
        &self.described
    }

    /// The text of the study.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// The study as JSON, whatever its format is.
    fn as_json(&self, py: Python<'_>) -> PyResult<String> {
        let (parsed, _) = self
            .parsed(None, JournalPlace::Nowhere, None, true)
            .map_err(|error| of_study(py, &error, self.made_in_python))?;
        Ok(parsed.as_json())
    }

    /// The distribution of a dimension, or None if it does not vary.
    fn law(&self, dimension: &str) -> Option<Law> {
        self.dimensions.iter().find(|one| one.name() == dimension).and_then(Law::of)
    }

    /// Runs the command `asked`. `make_model` receives the names of inputs and outputs as JSON, and returns the function that evaluates
    /// blocks of points.
    #[pyo3(signature = (asked, analysis, characteristics, make_model, progress, threads, seconds, journal, partial, whole))]
    #[allow(clippy::too_many_arguments, reason = "the package alone calls it, by position")]
    fn run<'py>(
        &self,
        py: Python<'py>,
        asked: &str,
        analysis: &str,
        characteristics: Vec<String>,
        make_model: Option<Bound<'py, PyAny>>,
        progress: Option<Bound<'py, PyAny>>,
        threads: usize,
        seconds: Option<f64>,
        journal: Option<PathBuf>,
        partial: bool,
        whole: bool,
    ) -> PyResult<Outcome> {
        let asked: Asked = serde_json::from_str(asked).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let (events, heard) = channel();
        let failed = |error: AnyError| of_engine(py, &error, self.made_in_python);
        let place = journal.map_or(JournalPlace::Nowhere, JournalPlace::At);
        let (study, hello) =
            self.parsed(asked.swept(), place, Some(events.clone()), whole).map_err(|error| failed(error.into()))?;
        let mut study = study.with_analysis(analysis).map_err(|error| of_study(py, &error, true))?;
        if !characteristics.is_empty() {
            study.problem = study.problem.only(&characteristics).map_err(|error| failed(error.into()))?;
        }
        let hello = hello.lock().unwrap_or_else(PoisonError::into_inner).take();
        let model = match (hello, make_model) {
            (Some((signature, greeting)), Some(make)) => {
                Some(make.call1((spoken(&signature, &greeting).to_string(),))?)
            }
            _ => None,
        };
        let caller = Caller { model, progress, partial };
        let found =
            run(py, (study, asked), (threads, seconds), &caller, heard, events)?.map_err(|error| failed(*error))?;
        if let Some(reason) = &found.not_kept {
            return Err(PyRuntimeError::new_err(format!("{reason}. What is in the journal stays")));
        }
        Ok(Outcome(found))
    }
}
