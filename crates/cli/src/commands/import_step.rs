//! `sensitol import` of a STEP file: its parts as tables of a study.

use std::path::Path;

use crate::args::import_args::{DEFAULT_NAME, ImportArgs};
use crate::failure::{Exit, Failure};
use crate::output::Destination;
use crate::table::{failed, file_name};
use sensitol_study::import::{StepImportFault, StepRequest, is_step, step_into, step_study};

/// Ends of names of STEP files, also of packed ones, which are refused with a reason.
const ENDS: [&str; 7] = [".stp", ".step", ".p21", ".stpz", ".stp.gz", ".step.gz", ".p21.gz"];

/// True for a STEP file, by its name or its first bytes.
pub(crate) fn is_step_file(path: &Path, bytes: &[u8]) -> bool {
    let name = path.to_string_lossy().to_lowercase();
    ENDS.iter().any(|end| name.ends_with(end)) || is_step(bytes)
}

/// Imports the parts of a STEP file.
pub(crate) fn run(asked: &ImportArgs, bytes: &[u8]) -> Result<Exit, Failure> {
    let formula = asked.formula.as_ref().map(|_| "--formula");
    let name = (asked.name != DEFAULT_NAME).then_some("--name");
    if let Some(option) = asked.meaning.first_given().or(name).or(formula) {
        return Err(failed(&asked.table, format!("{option} is for tables, and this is a STEP file"), None));
    }
    let file = file_name(&asked.table, "a STEP file");
    let next = [
        "Next: add the other parts with `sensitol import PART.stp --into THIS.toml`, then write [joints] and [characteristics].",
        "Until a joint holds every part, `sensitol check` tells which part has none.",
    ];
    let request =
        StepRequest { file, part: asked.part.clone(), joints: asked.joints, next: next.map(str::to_owned).to_vec() };
    let refused = |fault: StepImportFault| {
        let help = fault.is_of_name().then(|| "choose another name: --part NAME".to_owned());
        match fault {
            StepImportFault::Target(reason) => {
                Failure::Import { path: asked.into.clone().unwrap_or_default(), reason, help }
            }
            fault => failed(&asked.table, fault.to_string(), help),
        }
    };
    let (destination, imported) = match &asked.into {
        Some(into) => {
            let unread = |error: std::io::Error| Failure::Import {
                path: into.clone(),
                reason: error.to_string(),
                help: Some("the option --into takes a study that is there; -o writes a new one".to_owned()),
            };
            let study = std::fs::read_to_string(into).map_err(unread)?;
            (Destination::file(into)?, step_into(bytes, &request, &study).map_err(refused)?)
        }
        None => (asked.destination()?, step_study(bytes, &request).map_err(refused)?),
    };
    let says = asked.output.is_some() || asked.into.is_some();
    destination.write(&asked.study_text(&imported.text))?;
    if says {
        let parts = imported.parts.iter().map(|part| format!("[parts.{part}]")).collect::<Vec<_>>().join(", ");
        Destination::Stdout.write(&format!("{parts}\n{}\n", imported.summary))?;
    }
    Ok(Exit::Done)
}
