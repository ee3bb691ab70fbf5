//! `sensitol plan`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use crate::args::PlanArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::own_file::Content;
use crate::{points, study};
use sensitol::analysis::{choice_points, most_tail_points};
use sensitol::method::{DerivativeSource, ReducedInputs};
use sensitol::plan::{KnownAnswers, Plan, Point, Purpose, Stage};
use sensitol::problem::Problem;
use sensitol::verification::check_points;
use sensitol::warning::Warning;
use sensitol_report::document::number::plural;
use sensitol_report::document::terminal::text;
use sensitol_report::document::{Blocks, Document};
use sensitol_study::Externals;

/// The report of `plan --json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct PlanReport {
    schema: u32,
    command: &'static str,
    method: &'static str,
    about: &'static str,
    count: &'static str,
    varying: usize,
    evaluations: usize,
    /// Greatest number of evaluations for one point, if values are chosen from stock or extremes over a motion are sought; null if it is
    /// one.
    evaluations_per_point: Option<usize>,
    /// Evaluations if the program sends derivatives (`"gradients":true`); null if these save none, and for formulas.
    with_gradients: Option<usize>,
    /// Inputs over which the surface is fitted, if many dimensions drive few inputs of the program; null if these are the dimensions.
    fitted_over: Option<FittedOver>,
    /// The fewest and the most, of a method that chooses as it goes.
    range: Option<[usize; 2]>,
    /// Batches that wait for each other, the fewest; with `range` or `extremes` more may follow.
    rounds: usize,
    /// Points of the largest batch: so many workers can be busy at a time.
    largest_batch: usize,
    stages: Vec<StageReport>,
    /// Greatest number of check points; null if the model is sampled instead, and 0 without verification.
    checks: Option<usize>,
    /// Greatest number of further points in tails at whose limits check points refute the surface; 0 if there are none.
    tail_points: usize,
    /// Plain points of the model for characteristics that follow a choice from stock; 0 if there are none.
    choice_points: usize,
    /// Evaluations that replay answers of an external program in fresh processes, at most; 0 for other models.
    replays: usize,
    /// True if a search of the extremes follows, whose points depend on the answers.
    extremes: bool,
    dimensions: Vec<AxisReport>,
}

/// The inputs of the program, fewer than the dimensions that drive them.
#[derive(Debug, Serialize, JsonSchema)]
struct FittedOver {
    inputs: usize,
    dimensions: usize,
}

/// One batch; later batches depend on the answers to earlier ones.
#[derive(Debug, Serialize, JsonSchema)]
struct StageReport {
    evaluations: usize,
    known_beforehand: bool,
    purposes: Vec<PurposeReport>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct PurposeReport {
    points: usize,
    purpose: &'static str,
}

/// Evaluations of one dimension.
#[derive(Debug, Serialize, JsonSchema)]
struct AxisReport {
    name: String,
    unit: Option<String>,
    sigmas: Vec<f64>,
    values: Vec<f64>,
}

/// Greatest number of dimensions listed beside their nodes.
const NAMED: usize = 8;
/// Text for the count of a plan without differences.
const EXACT: &str = "exact derivatives: the means, and the nominal values where they differ";

pub(crate) fn run(asked: &PlanArgs, look: Look) -> Result<Exit, Failure> {
    // Points that are only written need no model that answers.
    let externals = Externals::default().with_unanswered(asked.write_points.is_some());
    let study = study::read(&asked.study, externals)?;
    let mut files = Files::of(&asked.study.study, &study, None).forced(asked.output.force);
    let destination = files.output_text(&asked.output)?;
    let header = points::of_model(&study.problem, &[]);
    let written = files.file_of(asked.write_points.as_deref(), &Content::Points { header: &header })?;
    let procedure = study.options.method.procedure();
    let narrow = ReducedInputs::of(&study.problem, &study.options);
    let problem = narrow.as_ref().map_or(&study.problem, |narrow| &narrow.problem);
    let plan = procedure.plan(problem, &study.options)?;
    let (evaluations, stages) = plan.cost();
    let first = plan.first();
    let of_first: usize = first.values().sum();
    let mut report = PlanReport {
        schema: sensitol_report::SCHEMA,
        command: "plan",
        method: procedure.name(),
        about: procedure.about(),
        count: if study.options.derivatives == Some(DerivativeSource::Exact) { EXACT } else { procedure.count() },
        varying: plan.varying().len(),
        evaluations,
        with_gradients: (study.problem.function().signature().costly)
            .then(|| procedure.with_gradients(problem, &study.options))
            .flatten(),
        fitted_over: narrow.as_ref().map(|narrow| FittedOver { inputs: narrow.inputs, dimensions: narrow.dimensions }),
        evaluations_per_point: Some(study.problem.function().evaluations_per_point(study.problem.outputs()))
            .filter(|&most| most > 1),
        range: procedure.range(problem, &study.options),
        rounds: stages,
        largest_batch: of_first.max(evaluations.saturating_sub(of_first)),
        stages: vec![of_stage(first)],
        checks: match study.options.verifies(study.problem.function().signature())
            && !all_follow_choices(&study.problem)
        {
            false => Some(0),
            true => (study.problem.function().signature().costly)
                .then(|| check_points(study.options.verify, plan.varying().len())),
        },
        tail_points: most_tail_points(&study.problem, &study.options, evaluations),
        choice_points: choice_points(&study.problem, &study.options, evaluations),
        replays: 0,
        extremes: study.options.extremes,
        dimensions: plan.varying().iter().map(|&d| axis(problem, &*plan, d)).collect(),
    };
    let answers = report.range.map_or(evaluations, |[_, most]| most)
        + report.checks.unwrap_or(0)
        + report.tail_points
        + report.choice_points;
    report.replays = study.problem.function().own_checks(answers);
    if stages > 1 {
        let left = evaluations - of_first;
        let purpose = if report.range.is_some() { Purpose::Check } else { Purpose::Pair };
        let purposes = vec![PurposeReport { points: left, purpose: purpose.words() }];
        report.stages.push(StageReport { evaluations: left, known_beforehand: false, purposes });
    }
    if let Some(file) = written {
        let first = plan.next(&KnownAnswers::nothing(study.problem.characteristics().len())).unwrap_or_default();
        file.write(&points::table(problem, &rows(&*plan, &first)))?;
        if stages > 1 {
            look.warn(&Warning::FirstStageOnly);
        }
    }
    look.warn_all(&study.warnings);
    destination.write(&match asked.output.json {
        true => json(&report),
        false => text(&report.document(), look.style(&asked.output)),
    })?;
    Ok(Exit::Done)
}

/// True if the figures of all characteristics of a costly model are those of points after a choice from stock, so that none has check points.
fn all_follow_choices(problem: &Problem) -> bool {
    (0..problem.characteristics().len()).all(|c| problem.follows_costly_choice(c))
}

fn of_stage(counts: BTreeMap<Purpose, usize>) -> StageReport {
    let evaluations = counts.values().sum();
    let purposes =
        counts.into_iter().map(|(purpose, points)| PurposeReport { points, purpose: purpose.words() }).collect();
    StageReport { evaluations, known_beforehand: true, purposes }
}

fn axis(problem: &Problem, plan: &dyn Plan, d: usize) -> AxisReport {
    let (dimension, axis) = (&problem.dimensions()[d], plan.axis(d));
    let nodes: Vec<_> = axis.slots.iter().map(|slot| axis.nodes[slot[0] as usize]).collect();
    AxisReport {
        name: dimension.name().to_owned(),
        unit: dimension.unit().map(str::to_owned),
        sigmas: nodes.iter().map(|node| node.u).collect(),
        values: nodes.iter().map(|node| node.x).collect(),
    }
}

/// Formats the number of rounds and the size of the largest batch, which bounds the busy workers.
fn rounds(report: &PlanReport) -> String {
    let (rounds, points) = (plural(report.rounds, "round", "rounds"), plural(report.largest_batch, "point", "points"));
    match report.range.is_some() || report.extremes {
        true => format!("{rounds} or more, the largest of {points}"),
        false if report.rounds == 1 => format!("{rounds} of {points}"),
        false => format!("{rounds}, the largest of {points}"),
    }
}

impl PlanReport {
    /// Builds the text of the plan: number of evaluations, stages, and nodes of every dimension.
    fn document(&self) -> Document {
        let mut document = Document::default();
        document.line(format!("{}: {}", self.method, self.about));
        let (evaluations, varying) = (self.evaluations, self.varying);
        match &self.fitted_over {
            None => document.line(format!(
                "{} for {} ({})",
                plural(evaluations, "evaluation", "evaluations"),
                plural(varying, "varying dimension", "varying dimensions"),
                self.count
            )),
            Some(FittedOver { inputs, dimensions }) => document.line(format!(
                "{evaluations} evaluations over {} of the program, which {dimensions} dimensions drive ({}, N the inputs)",
                plural(*inputs, "input", "inputs"),
                self.count
            )),
        }
        if let Some(fewer) = self.with_gradients {
            document.line(format!("{fewer} where the model sends derivatives with its answers"));
        }
        if let Some(most) = self.evaluations_per_point {
            document.line(format!(
                "each point takes up to {most} evaluations of the model: a choice from stock, or a motion"
            ));
        }
        document.line(rounds(self));
        for (index, stage) in self.stages.iter().enumerate() {
            let chosen = if stage.known_beforehand { "" } else { ", chosen by the answers so far" };
            document.line(format!("stage {}: {}{chosen}", index + 1, plural(stage.evaluations, "point", "points")));
            for purpose in &stage.purposes {
                document.note(format!("{:>6}  {}", purpose.points, purpose.purpose));
            }
        }
        if let Some([least, most]) = self.range {
            document.line(format!(
                "then more nodes, interactions and probes where they lower the error of sigma: {least} to {most} evaluations in all,"
            ));
            document.line(
                "and points of the model itself where no surrogate is to be trusted and --budget, or a cheap model, allows",
            );
        }
        if self.choice_points > 0 {
            document.line(format!(
                "then {} points of the model for what follows a choice from stock, whose jumps no surface describes",
                self.choice_points
            ));
        }
        if let Some(checks) = self.checks.filter(|&checks| checks > 0) {
            document.line(format!("then up to {checks} check points, placed by the answers, that verify the results"));
        }
        if self.tail_points > 0 {
            document.line(format!(
                "and, only where they refute the surface at a limit, up to {} points of the model in that tail",
                self.tail_points
            ));
        }
        if self.replays > 0 {
            document.line(format!("and up to {} evaluations that replay answers in fresh processes", self.replays));
        }
        if self.extremes {
            document.line(
                "then the search of the extremes: 4 points for a linear characteristic, some 2N or more for either side \
                 of another",
            );
        }
        self.steps(&mut document);
        document
    }

    /// Lists the nodes. Dimensions whose printed nodes agree share a line.
    fn steps(&self, document: &mut Document) {
        let mut alike: Vec<(String, Vec<&str>)> = Vec::new();
        for dimension in self.dimensions.iter().filter(|dimension| !dimension.sigmas.is_empty()) {
            let nodes = dimension.sigmas.iter().map(|u| format!("{u:+.4}")).collect::<Vec<_>>().join("  ");
            match alike.iter_mut().find(|(known, _)| *known == nodes) {
                Some((_, names)) => names.push(&dimension.name),
                None => alike.push((nodes, vec![&dimension.name])),
            }
        }
        if !alike.is_empty() {
            document.line("steps in sigma about the mean:");
        }
        for (nodes, names) in alike {
            let shown = names.iter().take(NAMED).copied().collect::<Vec<_>>().join(", ");
            let more = names.len().saturating_sub(NAMED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            document.note(format!("{nodes}  {shown}{more}"));
        }
    }
}

/// Returns every point of a stage with the values of all dimensions.
fn rows(plan: &dyn Plan, stage: &Stage) -> Vec<Vec<f64>> {
    let centre = plan.centre();
    let row = |point: &Point| {
        let mut row = centre.clone();
        for at in point.at() {
            row[at.dimension as usize] = plan.axis(at.dimension as usize).nodes[at.node as usize].x;
        }
        row
    };
    stage.points.iter().map(|(point, _)| row(point)).collect()
}
