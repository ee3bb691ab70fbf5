//! The report of `sensitol evaluate --at`: values of the characteristics and poses of the parts at points.

use schemars::JsonSchema;
use serde::Serialize;

use crate::args::EvaluateArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::interrupt;
use crate::output::{Look, json};
use crate::values::Place;
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol::problem::Problem;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;
use sensitol_report::document::number::significant;
use sensitol_report::document::terminal::text;
use sensitol_report::document::{Blocks, Cell, Columns, DataTable, Document, Line, Section, Tone};
use sensitol_study::{AssemblyPoses, PartPose, Study};

/// The report of `evaluate --json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct EvaluationReport {
    /// Version of the shape.
    schema: u32,
    /// Name of the command.
    command: &'static str,
    /// Unit of the translations of parts. None if the study names no length, or has no assembly in space.
    length_unit: Option<String>,
    /// Points in the order of `--at`.
    points: Vec<PointReport>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct PointReport {
    /// Values of all dimensions at the point.
    dimensions: Vec<DimensionValue>,
    /// Values of the characteristics at the point.
    characteristics: Vec<CharacteristicValue>,
    /// Poses of the parts of an assembly in space, those that stand still included. Empty if the study has none.
    parts: Vec<PoseReport>,
    /// Contacts of the joints that press a part. Empty if the study has none.
    contacts: Vec<ContactReport>,
}

/// Contacts on which a pressed part rests.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct ContactReport {
    /// Name of the joint.
    joint: String,
    /// Contacts that carry the force. None if the joints do not close at the point.
    resting_on: Option<Vec<String>>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct DimensionValue {
    /// Name of the dimension.
    name: String,
    /// Unit of the dimension; None if the study gives none.
    unit: Option<String>,
    /// Value of the dimension.
    value: f64,
}

#[derive(Debug, Serialize, JsonSchema)]
struct CharacteristicValue {
    /// Name of the characteristic.
    name: String,
    /// Unit of the characteristic; None if the study gives none.
    unit: Option<String>,
    /// Value of the characteristic. None if there is none at the point.
    value: Option<f64>,
    /// Reason why there is no value. None if there is one.
    error: Option<String>,
}

/// Pose of a part: a rotation about its origin, then a displacement of its origin.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct PoseReport {
    /// Name of the part.
    pub(super) name: String,
    /// Rotation vector in radians: its direction is the axis, its length the angle. None if the joints do not close at the point.
    pub(super) rotation: Option<[f64; 3]>,
    /// Place of the origin of the part in the frame of the assembly. None if the joints do not close at the point.
    pub(super) translation: Option<[f64; 3]>,
}

impl PoseReport {
    /// Returns the poses of a point, or parts without poses.
    pub(super) fn all(poses: Option<&[PartPose]>, parts: &[PartPose]) -> Vec<Self> {
        let known = poses.is_some();
        let pose = |pose: &PartPose| Self {
            name: pose.part.clone(),
            rotation: known.then_some(pose.rotation),
            translation: known.then_some(pose.translation),
        };
        poses.unwrap_or(parts).iter().map(pose).collect()
    }
}

pub(crate) fn run(study: &Study, asked: &EvaluateArgs, look: Look) -> Result<Exit, Failure> {
    let mut files = Files::of(&asked.study, study, None).forced(asked.output.force);
    let destination = files.output_text(&asked.output)?;
    let nominal = [Place::default()];
    let places = if asked.at.is_empty() { &nominal[..] } else { &asked.at[..] };
    let rows = places.iter().map(|place| point(&study.problem, place)).collect::<Result<Vec<_>, Failure>>()?;
    let poses = study.assembly_poses()?;
    interrupt::listen();
    let report = EvaluationReport::of(study, poses.as_ref(), &rows);
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    destination.write(&match asked.output.json {
        true => json(&report),
        false => text(&report.document(places), look.style(&asked.output)),
    })?;
    let lacks = |point: &PointReport| point.characteristics.iter().any(|one| one.value.is_none());
    Ok(if report.points.iter().any(lacks) { Exit::NoResult } else { Exit::Done })
}

/// Returns the point of these values. All other dimensions are nominal.
fn point(problem: &Problem, place: &Place) -> Result<Vec<f64>, Failure> {
    let dimensions = problem.dimensions();
    let mut point: Vec<f64> = dimensions.iter().map(|dimension| dimension.nominal()).collect();
    for (name, value) in &place.values {
        let Some(index) = dimensions.iter().position(|dimension| dimension.name() == name) else {
            let known: Vec<String> = dimensions.iter().map(|dimension| dimension.name().to_owned()).collect();
            let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
            return Err(Failure::UnknownDimension { name: name.clone(), nearest, known: known.join(", ") });
        };
        point[index] = *value;
    }
    Ok(point)
}

impl EvaluationReport {
    fn of(study: &Study, poses: Option<&AssemblyPoses>, rows: &[Vec<f64>]) -> Self {
        let problem = &study.problem;
        let (points, outputs) = (Points::from_rows(rows), problem.outputs());
        let within = Run::to_the_end().stopping_when(&interrupt::reason).abandoning_when(&interrupt::abandoned);
        let mut found = Responses::open(rows.len(), outputs.len());
        problem.function().evaluate(&Request { points: &points, outputs }, &within, &mut found);
        let placed = poses.map_or_else(Vec::new, |poses| poses.at(&points, &within));
        let dimension = |(dimension, &value): (&Dimension, &f64)| DimensionValue {
            name: dimension.name().to_owned(),
            unit: dimension.unit().map(str::to_owned),
            value,
        };
        let contacts = contacts(problem, &points);
        let point = |(row, values): (usize, &Vec<f64>)| PointReport {
            dimensions: problem.dimensions().iter().zip(values).map(dimension).collect(),
            characteristics: (problem.characteristics().iter().enumerate())
                .map(|(output, one)| CharacteristicValue {
                    name: one.name().to_owned(),
                    unit: one.unit().map(str::to_owned),
                    value: found.value(row, output),
                    error: found.error(row, output).map(ToString::to_string),
                })
                .collect(),
            parts: placed
                .get(row)
                .map_or_else(Vec::new, |found| PoseReport::all(found.as_ref().ok().map(Vec::as_slice), &study.poses)),
            contacts: contacts[row].clone(),
        };
        Self {
            schema: sensitol_report::SCHEMA,
            command: "evaluate",
            length_unit: study.length_unit.clone(),
            points: rows.iter().enumerate().map(point).collect(),
        }
    }

    /// Builds the text: a section for every point, with the characteristics and the poses.
    fn document(&self, places: &[Place]) -> Document {
        let mut document = Document::default();
        for (point, place) in self.points.iter().zip(places) {
            let mut section = Section::of(&place.words(), None);
            for one in &point.characteristics {
                let unit = one.unit.as_deref().map_or_else(String::new, |unit| format!(" {unit}"));
                section.note(match (one.value, &one.error) {
                    (Some(value), _) => Line::from(format!("{} = {}{unit}", one.name, significant(value, DIGITS))),
                    (None, error) => {
                        let reason = error.as_deref().unwrap_or("not evaluated");
                        Line::from(format!("{}: ", one.name)).and(Line::toned(reason, Tone::Bad))
                    }
                });
            }
            if !point.parts.is_empty() {
                let unit = self.length_unit.as_deref().map_or_else(String::new, |unit| format!(" in {unit}"));
                section.gap();
                section.note(format!("poses: rotation vector in rad, origin{unit}"));
                section.table(table(&point.parts));
            }
            if !point.contacts.is_empty() {
                section.gap();
            }
            for one in &point.contacts {
                let names = one.resting_on.as_ref().map_or_else(|| "unknown".to_owned(), |names| names.join(", "));
                section.note(format!("joint {}: stands on {names}", one.joint));
            }
            document.sections.push(section);
        }
        document
    }
}

/// Contacts of every joint that presses a part and that a characteristic depends on, for each point.
fn contacts(problem: &Problem, points: &Points) -> Vec<Vec<ContactReport>> {
    let function = problem.function();
    let mut found: Vec<Vec<ContactReport>> = vec![Vec::new(); points.rows()];
    for &output in problem.outputs() {
        let Some(switches) = function.switches(output) else { continue };
        let known = |joint: &str| found.first().is_some_and(|row| row.iter().any(|one| one.joint == joint));
        let new: Vec<_> = switches.contacts.into_iter().filter(|of| !known(&of.joint)).collect();
        let Some(margins) = function.margins(output, points).filter(|_| !new.is_empty()) else { continue };
        for (row, found) in found.iter_mut().enumerate() {
            found.extend(new.iter().map(|of| ContactReport {
                joint: of.joint.clone(),
                resting_on: of.resting(|switch| margins[switch][row]).map(|set| of.sets[set].clone()),
            }));
        }
    }
    found
}

/// Significant digits of values and poses in text.
const DIGITS: usize = 7;
/// Value below which a part of a pose is shown as 0, as part of the largest one beside it.
const ZERO: f64 = 1e-12;

fn table(parts: &[PoseReport]) -> DataTable {
    let columns = Columns::default().column("part", "part", |part: &&PoseReport| Cell::name(&part.name));
    let columns = ["rx", "ry", "rz"].into_iter().enumerate().fold(columns, |columns, (index, title)| {
        columns.column(title, title, move |part: &&PoseReport| shown(part.rotation, index))
    });
    let columns = ["x", "y", "z"].into_iter().enumerate().fold(columns, |columns, (index, title)| {
        columns.column(title, title, move |part: &&PoseReport| shown(part.translation, index))
    });
    columns.table("poses", parts)
}

/// Returns the cell of a part of a vector.
fn shown(vector: Option<[f64; 3]>, index: usize) -> Cell {
    let least = vector.map_or(0.0, |all| ZERO * all.iter().fold(1.0, |most: f64, part| most.max(part.abs())));
    let value = vector.map(|all| if all[index].abs() <= least { 0.0 } else { all[index] });
    Cell::number(value, |value| significant(value, DIGITS))
}
