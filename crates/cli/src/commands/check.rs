//! `sensitol check`.

use std::path::Path;

use crate::args::CheckArgs;
use crate::commands::several;
use crate::failure::{Exit, Failure};
use crate::output::{Destination, Look};
use sensitol_numeric::names::first_of;
use sensitol_study::{AssemblyScene, CompletenessGap, Mobility, Study};

/// Most names in a line.
const NAMED: usize = 8;

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
        "{}: valid\n{}{}  {} dimensions, {} of which vary and matter\n  characteristics: {}\n  {} would evaluate {} points\n",
        path.display(),
        study.mobility.as_ref().map_or_else(String::new, assembly),
        study.scene().map_or_else(String::new, |scene| joint_table(&scene, look)) + &gaps(&study.completeness()),
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

/// Joints with the freedoms that each takes, if everything is asked for.
fn joint_table(scene: &AssemblyScene, look: Look) -> String {
    if !look.verbose {
        return String::new();
    }
    let mut rows = Vec::new();
    for joint in &scene.joints {
        let [a, b] = joint.between.map(|feature| scene.features[feature].name.as_str());
        let takes = format!("takes {}: {}", joint.freedoms.len(), joint.freedoms.join(", "));
        rows.push([joint.name.clone(), joint.kind.to_owned(), format!("{a}, {b}"), takes]);
    }
    let wide = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let [name, kind, between] = [wide(0), wide(1), wide(2)];
    rows.iter().map(|[a, b, c, d]| format!("    {a:name$}  {b:kind$}  {c:between$}  {d}\n")).collect()
}

/// Tolerances and datums that the drawings of an assembly leave out, a line for each kind or zone.
fn gaps(gaps: &[CompletenessGap]) -> String {
    let mut features = Vec::new();
    let mut dimensions = Vec::new();
    let mut text = String::new();
    for gap in gaps {
        match gap {
            CompletenessGap::FeatureWithoutTolerance { feature } => features.push(feature.clone()),
            CompletenessGap::OpenDatums { feature, zone, datums, open } => {
                let open = open.join(" and ");
                text += &match &datums[..] {
                    [] => format!("  {zone} of {feature} names no datums: it is taken from the frame of its part\n"),
                    datums => format!("  {zone} of {feature}: datums {} leave {open} free\n", datums.join(" ")),
                };
            }
            CompletenessGap::GeneralTolerance { dimension, half, unit } => {
                let unit = unit.as_ref().map_or_else(String::new, |unit| format!(" {unit}"));
                dimensions.push(format!("{dimension} \u{b1} {half}{unit}"));
            }
        }
    }
    if !features.is_empty() {
        text += &format!("  no tolerance, though characteristics depend on them: {}\n", first_of(&features, NAMED));
    }
    if !dimensions.is_empty() {
        let by = "[general] standard = \"ISO 2768-m\"";
        text += &format!("  no tolerance, where {by} would give one: {}\n", first_of(&dimensions, NAMED));
    }
    text
}
