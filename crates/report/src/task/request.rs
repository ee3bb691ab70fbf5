//! Task from a page: the text of a study, the command, and the forms of the answer.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::value::RawValue;
use serde_json::{Map, Value, json};

use crate::task::answer::TaskReport;
use crate::task::fault::{not_asked, of_engine, of_study};
use crate::task::location::TaskPlace;
use crate::task::question::{Asked, Counted, done};
use sensitol_models::{ALL, Model};
use sensitol_study::AnyError;
use sensitol_study::{Study, StudyError, StudyText};

/// A study, and the question about it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// The text of the study.
    text: String,
    format: Format,
    /// The name in place of a file's in messages.
    name: String,
    /// The files that it names.
    #[serde(default)]
    files: BTreeMap<String, String>,
    configuration: Option<String>,
    /// Keys of `[analysis]` that win over those of the study.
    analysis: Option<Box<RawValue>>,
    #[serde(default)]
    characteristics: Vec<String>,
    asked: Option<Asked>,
    #[serde(default)]
    forms: Vec<Form>,
}

/// The format of the text.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Format {
    Toml,
    Json,
}

/// A form of a result.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Form {
    Json,
    Html,
    Text,
    Svg,
    Tables,
}

impl Task {
    /// Reads a task from JSON.
    pub fn read(told: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(told)
    }

    fn parsed(&self, place: &TaskPlace<'_>) -> Result<Study, StudyError> {
        let text = match self.format {
            Format::Toml => StudyText::toml(&self.name, &self.text),
            Format::Json => StudyText::json(&self.name, &self.text),
        };
        let externals = place.externals.clone();
        let text = place.root.iter().fold(text, |text, root| text.within(root));
        let text = text.in_folder(&place.folder).with_externals(match &self.configuration {
            Some(name) => externals.with_configuration(name),
            None => externals,
        });
        let text = self.files.iter().fold(text, |text, (name, content)| text.with_file(name, content));
        let swept = self.asked.as_ref().and_then(Asked::swept);
        Study::from_text(swept.map_or(text.clone(), |parameter| text.sweeping(parameter)))
    }

    /// Returns the study's keys and its program, or its faults.
    pub fn study(&self, place: &TaskPlace<'_>) -> String {
        match self.parsed(place) {
            Ok(study) => {
                // Spliced in as text, which keeps the order of its keys.
                let keys = RawValue::from_string(study.as_json()).expect("a study is JSON");
                let program = json!(study.program);
                format!("{{\"study\":{keys},\"program\":{program}}}")
            }
            Err(error) => of_study(&error).to_string(),
        }
    }

    /// Runs the command and returns the answer, or an error, as JSON. A program that may not start is named, and nothing is evaluated.
    pub fn run(&self, place: &TaskPlace<'_>, counted: Counted<'_>) -> String {
        let study = match self.parsed(place) {
            Ok(study) => study,
            Err(error) => return of_study(&error).to_string(),
        };
        let program = json!(study.program);
        let mut told = match &study.program {
            Some(program) if !place.starts_programs => not_asked(program),
            _ => match self.found(study, place, counted) {
                Ok(found) => self.shown(&found),
                Err(error) => of_engine(&error),
            },
        };
        told["program"] = program;
        told.to_string()
    }

    fn found(
        &self,
        mut study: Study,
        place: &TaskPlace<'_>,
        counted: Counted<'_>,
    ) -> Result<TaskReport, Box<AnyError>> {
        if let Some(keys) = &self.analysis {
            study = study.with_analysis(keys.get()).map_err(AnyError::from)?;
        }
        if !self.characteristics.is_empty() {
            study.problem = study.problem.only(&self.characteristics).map_err(AnyError::from)?;
        }
        let asked = self.asked.as_ref().unwrap_or(&Asked::Analyze {});
        done(&study, asked, &place.run, counted)
    }

    fn shown(&self, found: &TaskReport) -> Value {
        let mut shown = Map::new();
        for form in &self.forms {
            let (name, value) = match form {
                Form::Json => ("json", json!(found.json())),
                Form::Html => ("html", json!(found.html())),
                Form::Text => ("text", json!(found.text(80, true))),
                Form::Svg => ("svg", json!(found.svg(&self.name))),
                Form::Tables => {
                    let mut tables = Map::new();
                    tables.extend(found.tables().into_iter().map(|file| (file.name, json!(file.text))));
                    ("tables", Value::Object(tables))
                }
            };
            shown.insert(name.to_owned(), value);
        }
        shown.insert("study".to_owned(), json!(found.study));
        shown.insert("not_written".to_owned(), json!(found.not_written));
        Value::Object(shown)
    }
}

/// Lists the built-in models as JSON.
pub fn models() -> String {
    let model = |model: &&'static Model| {
        let inputs = model.inputs.iter().map(
            |input| json!({ "name": input.name, "unit": input.unit, "nominal": input.nominal, "about": input.about }),
        );
        let outputs = model
            .outputs
            .iter()
            .map(|output| json!({ "name": output.name, "unit": output.unit, "about": output.about }));
        json!({
            "name": model.name, "title": model.title, "source": model.source,
            "inputs": inputs.collect::<Vec<_>>(), "outputs": outputs.collect::<Vec<_>>(),
        })
    };
    Value::Array(ALL.iter().map(model).collect()).to_string()
}
