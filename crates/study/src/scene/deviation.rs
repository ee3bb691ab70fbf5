//! Displacements of parts and features of a scene at other dimensions.

use super::spatial_facts::{NumberKind, SpatialFacts, numbers};
use crate::assembly_poses::pose_characteristics;
use crate::error::StudyError;
use crate::folder::Format;
use crate::{AssemblyPoses, Externals, Study, write};
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol_spatial::{Assembly, FeaturePlace, PartPose};

/// Small displacement of a rigid body about a point of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigidDisplacement {
    /// Displacement of the point.
    pub displacement: [f64; 3],
    /// Rotation vector in radians.
    pub rotation: [f64; 3],
}

/// Displacements of a scene from its nominal state.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneDeviation {
    /// Displacement of every part about its origin.
    pub parts: Vec<RigidDisplacement>,
    /// Displacement of every feature about its origin.
    pub features: Vec<RigidDisplacement>,
}

impl Study {
    /// Displacements of the scene at every point. A point at which the joints do not close has None. Returns None if the study has no
    /// assembly in space.
    ///
    /// # Errors
    /// Fails if the study in plain keys cannot be read.
    ///
    /// # Cost
    /// Reads the study in plain keys once, and evaluates each point once.
    ///
    /// # Example
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
    /// let found = study.scene_deviations(&Points::from_rows(&[[12.25]]), &Run::to_the_end())?.expect("there are parts");
    /// let deviation = found[0].as_ref().expect("the joints close");
    /// // The lid rises, and the foot stays on the table.
    /// assert!((deviation.features[2].displacement[2] - 0.25).abs() < 1e-12);
    /// assert!(deviation.features[1].displacement[2].abs() < 1e-12);
    /// # Ok::<(), sensitol_study::StudyError>(())
    /// ```
    pub fn scene_deviations(
        &self,
        points: &Points,
        run: &Run<'_>,
    ) -> Result<Option<Vec<Option<SceneDeviation>>>, StudyError> {
        let Some(facts) = &self.spatial else { return Ok(None) };
        let (mut names, mut text) = pose_characteristics(&facts.poses, self.length_unit.as_deref());
        let unknowns = names.len();
        let mut assembly = facts.assembly.clone();
        for (index, (formula, kind)) in formulas(&mut assembly).into_iter().enumerate() {
            let name = format!("number of the scene {index}");
            text += &format!("\n[characteristics.{}]\nformula = {}\n", write::name(&name), write::quoted(&formula));
            text += &facts.unit(kind).map_or_else(String::new, |unit| format!("unit = {}\n", write::quoted(&unit)));
            names.push(name);
        }
        let text = format!("{}{text}", self.expanded);
        let externals = Externals { host: self.host.clone(), ..Externals::default() };
        let study = Self::parse(&text, Format::Toml, &self.name, self.place.clone(), externals, None)?;
        let problem = study.problem.only(&names).expect("these characteristics were added");
        let outputs = problem.outputs();
        let mut found = Responses::open(points.rows(), outputs.len());
        problem.function().evaluate(&Request::values(points, outputs), run, &mut found);
        let nominal = facts.assembly.places(&facts.poses).concat();
        let mut deviations = Vec::with_capacity(points.rows());
        for row in 0..points.rows() {
            let values: Option<Vec<f64>> = (0..names.len()).map(|place| found.value(row, place)).collect();
            let poses = AssemblyPoses::of_row(&facts.poses, &found, row).ok();
            deviations.push(values.zip(poses).map(|(values, poses)| {
                set(&mut assembly, &values[unknowns..]);
                deviation((&facts.poses, &nominal), (&poses, &assembly.places(&poses).concat()))
            }));
        }
        Ok(Some(deviations))
    }
}

impl SpatialFacts {
    /// Unit of the characteristic that gives a number; None if it needs none.
    fn unit(&self, kind: NumberKind) -> Option<String> {
        match kind {
            NumberKind::Length => self.length_unit.clone().filter(|_| self.converts),
            NumberKind::Angle => self.converts.then(|| "rad".to_owned()),
            NumberKind::Plain => self.converts.then(|| "1".to_owned()),
        }
    }
}

/// Formulas among the numbers of all features.
fn formulas(assembly: &mut Assembly) -> Vec<(String, NumberKind)> {
    let features = assembly.parts.iter_mut().flat_map(|part| &mut part.features);
    let all = features.flat_map(numbers).filter_map(|(number, kind)| Some((number.formula.clone()?, kind)));
    all.collect()
}

/// Sets the values of the formulas among the numbers of all features.
fn set(assembly: &mut Assembly, values: &[f64]) {
    let features = assembly.parts.iter_mut().flat_map(|part| &mut part.features);
    let numbers = features.flat_map(numbers).filter(|(number, _)| number.formula.is_some());
    for ((number, _), value) in numbers.zip(values) {
        number.value = *value;
    }
}

fn deviation(
    (poses, nominal): (&[PartPose], &[FeaturePlace]),
    (moved_poses, moved): (&[PartPose], &[FeaturePlace]),
) -> SceneDeviation {
    let parts = poses.iter().zip(moved_poses).map(|(from, to)| RigidDisplacement {
        displacement: difference(to.translation, from.translation),
        rotation: rotation(from.axes(), to.axes()),
    });
    let features = nominal.iter().zip(moved).map(|(from, to)| RigidDisplacement {
        displacement: difference(to.origin, from.origin),
        rotation: rotation(from.axes, to.axes),
    });
    SceneDeviation { parts: parts.collect(), features: features.collect() }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// Rotation vector from one frame to another by the skew part of the rotation. It is short by a sixth of the angle's third power.
fn rotation(from: [[f64; 3]; 3], to: [[f64; 3]; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (a, b) in from.iter().zip(&to) {
        for (i, part) in sum.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            *part += 0.5 * (a[j] * b[k] - a[k] * b[j]);
        }
    }
    sum
}
