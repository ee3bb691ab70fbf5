//! `sensitol check`.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::args::CheckArgs;
use crate::commands::several;
use crate::failure::{Exit, Failure};
use crate::failure_report::ErrorReport;
use crate::output::{Destination, Look, json};
use sensitol_numeric::names::first_of;
use sensitol_report::{SCHEMA, WarningReport};
use sensitol_study::{AssemblyScene, CompletenessGap, Mobility, Study};

/// Greatest number of names in a line.
const NAMED: usize = 8;

pub(crate) fn run(asked: &CheckArgs, as_json: bool, look: Look) -> Result<Exit, Failure> {
    if as_json {
        return reported(asked, look);
    }
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

/// Plan of a study in numbers, without an evaluation.
struct PlanSize {
    dimensions: usize,
    varying: usize,
    characteristics: Vec<String>,
    method: &'static str,
    /// Smallest and greatest number of evaluations.
    evaluations: [usize; 2],
}

impl PlanSize {
    fn of(study: &Study) -> Result<Self, Failure> {
        let procedure = study.options.method.procedure();
        let plan = procedure.plan(&study.problem, &study.options)?;
        let evaluations = match procedure.range(&study.problem, &study.options) {
            Some([least, most]) if least < most => [least, most],
            _ => [plan.cost().0; 2],
        };
        Ok(Self {
            dimensions: study.problem.dimensions().len(),
            varying: plan.varying().len(),
            characteristics: study.problem.characteristics().iter().map(|one| one.name().to_owned()).collect(),
            method: procedure.name(),
            evaluations,
        })
    }
}

fn one(path: &Path, look: Look) -> Result<Exit, Failure> {
    let study = Study::read(path)?;
    look.warn_all(&study.warnings);
    let checked = PlanSize::of(&study)?;
    let summary = format!(
        "{}: valid\n{}{}  {} dimensions, {} of which vary and matter\n  characteristics: {}\n  {} would evaluate {} points\n",
        path.display(),
        study.mobility.as_ref().map_or_else(String::new, assembly),
        study.scene().map_or_else(String::new, |scene| joint_table(&scene, look)) + &gaps(&study.completeness()),
        checked.dimensions,
        checked.varying,
        checked.characteristics.join(", "),
        checked.method,
        match checked.evaluations {
            [least, most] if least < most => format!("{least} to {most}"),
            [count, _] => count.to_string(),
        },
    );
    Destination::Stdout.write(&summary)?;
    Ok(Exit::Done)
}

/// The report of `check --json` on one study. Keys of a study that is not valid are null.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct StudyCheck {
    schema: u32,
    /// The version of the program.
    sensitol: &'static str,
    command: &'static str,
    /// The file, as it was given.
    study: String,
    valid: bool,
    errors: Vec<ErrorReport>,
    warnings: Vec<WarningReport>,
    dimensions: Option<usize>,
    /// Dimensions that vary and matter.
    varying: Option<usize>,
    characteristics: Option<Vec<String>>,
    method: Option<&'static str>,
    /// Smallest and greatest number of evaluations of the method.
    evaluations: Option<[usize; 2]>,
    /// Program that an analysis starts, with its arguments; null if it starts none.
    program: Option<Vec<String>>,
    /// Unknowns and equations of an assembly in space; null of other studies.
    assembly: Option<MobilityReport>,
    /// Tolerances and datums that the drawings of an assembly leave out.
    gaps: Option<Vec<GapReport>>,
}

/// Unknowns and equations of an assembly in space.
#[derive(Debug, Serialize, JsonSchema)]
struct MobilityReport {
    parts: usize,
    joints: usize,
    unknowns: usize,
    equations: usize,
    /// Motions that no joint stops and no characteristic depends on.
    free: Vec<String>,
    /// Equations that may repeat those before them.
    doubtful: Vec<String>,
}

/// A gap of the drawings of an assembly. Keys that a kind does not have are null.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct GapReport {
    kind: GapKind,
    feature: Option<String>,
    zone: Option<&'static str>,
    datums: Option<Vec<String>>,
    /// Freedoms that the datums leave.
    open: Option<Vec<String>>,
    dimension: Option<String>,
    /// Half of the general tolerance that would apply.
    half: Option<f64>,
    unit: Option<String>,
}

/// Kind of a gap.
#[derive(Debug, Default, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum GapKind {
    #[default]
    FeatureWithoutTolerance,
    OpenDatums,
    GeneralTolerance,
}

impl GapReport {
    fn of(gap: CompletenessGap) -> Self {
        match gap {
            CompletenessGap::FeatureWithoutTolerance { feature } => Self { feature: Some(feature), ..Self::default() },
            CompletenessGap::OpenDatums { feature, zone, datums, open } => Self {
                kind: GapKind::OpenDatums,
                feature: Some(feature),
                zone: Some(zone),
                datums: Some(datums),
                open: Some(open),
                ..Self::default()
            },
            CompletenessGap::GeneralTolerance { dimension, half, unit } => Self {
                kind: GapKind::GeneralTolerance,
                dimension: Some(dimension),
                half: Some(half),
                unit,
                ..Self::default()
            },
        }
    }
}

impl StudyCheck {
    /// Checks one study.
    fn of(path: &Path) -> (Self, Option<Failure>) {
        let mut report = Self {
            schema: SCHEMA,
            sensitol: env!("CARGO_PKG_VERSION"),
            command: "check",
            study: path.display().to_string(),
            valid: false,
            errors: Vec::new(),
            warnings: Vec::new(),
            dimensions: None,
            varying: None,
            characteristics: None,
            method: None,
            evaluations: None,
            program: None,
            assembly: None,
            gaps: None,
        };
        let failure = report.fill(path).err();
        report.valid = failure.is_none();
        report.errors = failure.iter().flat_map(ErrorReport::all).collect();
        (report, failure)
    }

    fn fill(&mut self, path: &Path) -> Result<(), Failure> {
        let study = Study::read(path)?;
        self.warnings = study.warnings.iter().map(WarningReport::of).collect();
        let checked = PlanSize::of(&study)?;
        self.dimensions = Some(checked.dimensions);
        self.varying = Some(checked.varying);
        self.characteristics = Some(checked.characteristics);
        self.method = Some(checked.method);
        self.evaluations = Some(checked.evaluations);
        self.assembly = study.mobility.as_ref().map(|mobility| {
            let Mobility { parts, joints, unknowns, equations, free, doubtful } = mobility.clone();
            MobilityReport { parts, joints, unknowns, equations, free, doubtful }
        });
        self.gaps = Some(study.completeness().into_iter().map(GapReport::of).collect());
        self.program = study.program;
        Ok(())
    }
}

/// Checks all studies and prints one JSON value: an object of one study, else an array.
fn reported(asked: &CheckArgs, look: Look) -> Result<Exit, Failure> {
    let (mut reports, mut exit) = (Vec::new(), Exit::Done);
    for path in &asked.studies {
        let (report, failure) = StudyCheck::of(path);
        let name = report.study.clone();
        let look = if asked.studies.len() > 1 { look.of(&name) } else { look };
        look.tell_all(&report.warnings);
        if let Some(failure) = failure {
            exit = exit.worse(several::outcome(&name, Err(failure))?);
        }
        reports.push(report);
    }
    let text = match &reports[..] {
        [report] => json(report),
        reports => json(&reports),
    };
    Destination::Stdout.write(&text)?;
    Ok(exit)
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

/// Joints with the freedoms that each takes, if everything is requested.
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
