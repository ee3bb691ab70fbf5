//! `sensitol models`.

use schemars::JsonSchema;
use serde::Serialize;

use super::args::ModelsArgs;
use super::failure::{Exit, Failure};
use super::output::{Destination, Look, json};
use crate::document::number::plain;
use crate::models::{ALL, Model};

/// What `models --json` prints of one model.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct ModelReport {
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

pub(super) fn run(asked: &ModelsArgs, _: Look) -> Result<Exit, Failure> {
    let printed = match &asked.name {
        None if asked.output.json => json(&ALL.iter().map(|model| ModelReport::of(model)).collect::<Vec<_>>()),
        None => list(),
        Some(name) => {
            let model = known(name)?;
            if asked.output.json { json(&ModelReport::of(model)) } else { one(model) }
        }
    };
    Destination::open(&asked.output)?.write(&printed)?;
    Ok(Exit::Done)
}

/// The model of this name.
pub(super) fn known(name: &str) -> Result<&'static Model, Failure> {
    Ok(name.parse::<&Model>()?)
}

fn list() -> String {
    let widest = ALL.iter().map(|model| model.name.len()).max().unwrap_or(0);
    ALL.iter().map(|model| format!("{:<widest$}  {}\n", model.name, model.title)).collect()
}

fn one(model: &Model) -> String {
    let names = model.inputs.iter().map(|input| (input.name, input.unit));
    let names = names.chain(model.outputs.iter().map(|output| (output.name, output.unit)));
    // No narrower than most models want, so that two of them look alike.
    let widest = names.fold([8, 6], |[name, unit], of| [name.max(of.0.len()), unit.max(of.1.len())]);
    let row = |name: &str, nominal: &str, unit: &str, about: &str| {
        let [wide, of_unit] = widest;
        format!("  {name:<wide$} {nominal:>14}  {unit:<of_unit$}  {about}\n")
    };
    let inputs = model.inputs.iter().map(|input| row(input.name, &plain(input.nominal), input.unit, input.about));
    let outputs = model.outputs.iter().map(|output| row(output.name, "", output.unit, output.about));
    format!(
        "{}: {}\n{}\n\ninputs, with the nominal value where a study gives none\n{}\noutputs\n{}",
        model.name,
        model.title,
        model.source,
        inputs.collect::<String>(),
        outputs.collect::<String>(),
    )
}

impl ModelReport {
    fn of(model: &Model) -> Self {
        Self {
            name: model.name,
            title: model.title,
            source: model.source,
            inputs: (model.inputs.iter())
                .map(|&crate::models::ModelInput { name, unit, nominal, about }| InputReport {
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
