//! `sensitol check`.

use std::path::Path;

use crate::args::CheckArgs;
use crate::commands::several;
use crate::failure::{Exit, Failure};
use crate::output::{Destination, Look};
use sensitol_study::{Mobility, Study};

pub(crate) fn run(asked: &CheckArgs, look: Look) -> Result<Exit, Failure> {
    match &asked.studies[..] {
        [study] => one(study, look),
        studies => {
            let mut exit = Exit::Done;
            for study in studies {
                let name = study.display().to_string();
                exit = exit.worse(several::outcome(&name, one(study, look.of(&name)))?);
            }
            Ok(exit)
        }
    }
}

fn one(path: &Path, look: Look) -> Result<Exit, Failure> {
    let study = Study::read(path)?;
    look.warn_all(&study.warnings);
    let procedure = study.options.method.procedure();
    let plan = procedure.plan(&study.problem, &study.options)?;
    let characteristics: Vec<&str> =
        study.problem.characteristics().iter().map(|characteristic| characteristic.name()).collect();
    let summary = format!(
        "{}: valid\n{}  {} dimensions, {} of which vary and matter\n  characteristics: {}\n  {} would evaluate {} points\n",
        path.display(),
        study.mobility.as_ref().map_or_else(String::new, assembly),
        study.problem.dimensions().len(),
        plan.varying().len(),
        characteristics.join(", "),
        procedure.name(),
        match procedure.range(&study.problem, &study.options) {
            Some([least, most]) if least < most => format!("{least} to {most}"),
            _ => plan.cost().0.to_string(),
        },
    );
    Destination::Stdout.write(&summary)?;
    Ok(Exit::Done)
}

/// Unknowns and equations of an assembly in space, with the motions that no joint stops.
fn assembly(mobility: &Mobility) -> String {
    let Mobility { parts, joints, unknowns, equations, free, doubtful } = mobility;
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    let mut text = format!(
        "  {parts} part{}, {joints} joint{}: {unknowns} unknowns, {equations} equation{}\n",
        plural(*parts),
        plural(*joints),
        plural(*equations)
    );
    for motion in free {
        text += &format!("  {motion}: no effect on the characteristics\n");
    }
    for equation in doubtful {
        text += &format!("  {equation} to the joints before it: whether it repeats them is doubtful\n");
    }
    text
}
