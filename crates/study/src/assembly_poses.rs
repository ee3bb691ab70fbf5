//! Poses of the parts of an assembly in space at any point.

use crate::error::StudyError;
use crate::folder::Format;
use crate::{Externals, Study, write};
use sensitol::assembly::{EvaluationError, Points, Request, Responses, Run};
use sensitol::problem::Problem;
use sensitol_spatial::PartPose;

/// Poses of the parts of an assembly in space as a function of the dimensions.
#[derive(Debug, Clone)]
pub struct AssemblyPoses {
    /// Problem whose characteristics are the unknowns of the poses, six for every part that moves.
    problem: Problem,
    parts: Vec<PartPose>,
}

impl Study {
    /// Poses of the parts as a function of the dimensions, with lengths in [`length_unit`](Self::length_unit). Returns None if the study has
    /// no assembly in space.
    ///
    /// # Errors
    /// Fails if the study in plain keys cannot be read.
    ///
    /// ```
    /// use sensitol::assembly::{Points, Run};
    /// use sensitol_study::Study;
    /// let study = Study::from_toml(r#"
    ///     [dimensions]
    ///     h = { nominal = 12, tolerance = 0.1 }
    ///     [parts.table]
    ///     top = { plane = [0, 0, 0], normal = "z" }
    ///     [parts.block]
    ///     foot = { plane = [0, 0, "-h"], normal = "-z" }
    ///     lid = { plane = [0, 0, 5], normal = "z" }
    ///     [joints]
    ///     seat = { on = "table.top", against = "block.foot" }
    ///     [characteristics]
    ///     height = { of = "block.lid", from = "table.top" }
    /// "#, "block.toml")?;
    /// let poses = study.assembly_poses()?.expect("there are parts");
    /// let found = poses.at(&Points::from_rows(&[[12.25]]), &Run::to_the_end());
    /// assert!((found[0].as_ref().unwrap()[1].translation[2] - 12.25).abs() < 1e-12);
    /// # Ok::<(), sensitol_study::StudyError>(())
    /// ```
    pub fn assembly_poses(&self) -> Result<Option<AssemblyPoses>, StudyError> {
        if self.poses.is_empty() {
            return Ok(None);
        }
        let (names, text) = pose_characteristics(&self.poses, self.length_unit.as_deref());
        let text = format!("{}{text}", self.expanded);
        let externals = Externals { host: self.host.clone(), ..Externals::default() };
        let study = Self::parse(&text, Format::Toml, &self.name, self.place.clone(), externals, None)?;
        let problem = study.problem.only(&names).expect("these characteristics were added");
        Ok(Some(AssemblyPoses { problem, parts: self.poses.clone() }))
    }
}

/// Characteristics that give the unknowns of all poses: their names, and their lines.
pub(crate) fn pose_characteristics(poses: &[PartPose], length_unit: Option<&str>) -> (Vec<String>, String) {
    let (mut names, mut text) = (Vec::new(), String::new());
    for unknown in poses.iter().filter_map(PartPose::unknowns) {
        for (index, unknown) in unknown.iter().enumerate() {
            let name = format!("pose of {unknown}");
            let unit = if index < 3 { "1" } else { length_unit.unwrap_or("1") };
            text += &format!(
                "\n[characteristics.{}]\nformula = {}\nunit = {}\n",
                write::name(&name),
                write::quoted(&format!("`{unknown}`")),
                write::quoted(unit)
            );
            names.push(name);
        }
    }
    (names, text)
}

impl AssemblyPoses {
    /// Poses of all parts at every point, those that stand still included. A point at which the joints do not close has an error.
    pub fn at(&self, points: &Points, run: &Run<'_>) -> Vec<Result<Vec<PartPose>, EvaluationError>> {
        let outputs = self.problem.outputs();
        let mut found = Responses::open(points.rows(), outputs.len());
        self.problem.function().evaluate(&Request::values(points, outputs), run, &mut found);
        (0..points.rows()).map(|row| Self::of_row(&self.parts, &found, row)).collect()
    }

    /// Poses of parts by the unknowns in a row of answers.
    pub(crate) fn of_row(parts: &[PartPose], found: &Responses, row: usize) -> Result<Vec<PartPose>, EvaluationError> {
        let mut place = 0;
        let mut poses = Vec::with_capacity(parts.len());
        for part in parts {
            if part.start.is_none() {
                poses.push(part.clone());
                continue;
            }
            let mut unknowns = [f64::NAN; 6];
            for unknown in &mut unknowns {
                match (found.value(row, place), found.error(row, place)) {
                    (Some(value), _) => *unknown = value,
                    (None, Some(error)) => return Err(error.clone()),
                    // A point that a stop left open has no value.
                    (None, None) => return Err(EvaluationError::NotGiven),
                }
                place += 1;
            }
            poses.push(part.at(unknowns));
        }
        Ok(poses)
    }
}
