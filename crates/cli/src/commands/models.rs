//! `sensitol models`.

use schemars::JsonSchema;
use serde::Serialize;

use crate::args::ModelsArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use sensitol_models::{ALL, Model};
use sensitol_report::document::number::plain;
use sensitol_report::document::terminal::text;
use sensitol_report::document::{Blocks, Cell, DataTable, Document, Section};

/// The report of `models --json` on one model.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ModelReport {
    name: &'static str,
    title: &'static str,
    source: &'static str,
    inputs: Vec<InputReport>,
    outputs: Vec<OutputReport>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct InputReport {
    name: &'static str,
    unit: &'static str,
    nominal: f64,
    about: &'static str,
}

#[derive(Debug, Serialize, JsonSchema)]
struct OutputReport {
    name: &'static str,
    unit: &'static str,
    about: &'static str,
}

pub(crate) fn run(asked: &ModelsArgs, look: Look) -> Result<Exit, Failure> {
    let style = look.style(&asked.output);
    let printed = match &asked.name {
        None if asked.output.json => json(&ALL.iter().map(|model| ModelReport::of(model)).collect::<Vec<_>>()),
        None => text(&list(), style),
        Some(name) => {
            let model = known(name)?;
            if asked.output.json { json(&ModelReport::of(model)) } else { text(&document(model), style) }
        }
    };
    Files::default().forced(asked.output.force).output_text(&asked.output)?.write(&printed)?;
    Ok(Exit::Done)
}

pub(crate) fn known(name: &str) -> Result<&'static Model, Failure> {
    Ok(name.parse::<&Model>()?)
}

/// Lists the names and titles of all models.
fn list() -> Document {
    let widest = ALL.iter().map(|model| model.name.len()).max().unwrap_or(0);
    let mut document = Document::default();
    ALL.iter().for_each(|model| document.line(format!("{:<widest$}  {}", model.name, model.title)));
    document
}

/// Describes a model, its inputs, and its outputs.
fn document(model: &Model) -> Document {
    let mut document = Document::default();
    document.line(format!("{}: {}", model.name, model.title));
    document.line(model.source);
    let mut inputs = Section::of("inputs", None);
    inputs.words = ", with the nominal value where a study gives none".to_owned();
    inputs.table(DataTable::untitled(model.inputs.iter().map(|input| {
        [Cell::text(input.name), Cell::number(input.nominal, plain), Cell::text(input.unit), Cell::text(input.about)]
    })));
    let mut outputs = Section::of("outputs", None);
    outputs.table(DataTable::untitled(
        model.outputs.iter().map(|output| [output.name, output.unit, output.about].map(Cell::text)),
    ));
    document.sections = vec![inputs, outputs];
    document
}

impl ModelReport {
    fn of(model: &Model) -> Self {
        Self {
            name: model.name,
            title: model.title,
            source: model.source,
            inputs: (model.inputs.iter())
                .map(|&sensitol_models::ModelInput { name, unit, nominal, about }| InputReport {
                    name,
                    unit,
                    nominal,
                    about,
                })
                .collect(),
            outputs: (model.outputs.iter())
                .map(|output| OutputReport { name: output.name, unit: output.unit, about: output.about })
                .collect(),
        }
    }
}
