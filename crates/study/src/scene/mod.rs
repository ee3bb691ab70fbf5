//! Scene of an assembly in space: its features, joints and measures at their places, as a drawing needs them.
//!
//! | what | file |
//! |---|---|
//! | places of features, and their extents | [`mod.rs`](self) |
//! | lines of measures | `measure_mark.rs` |
//! | features and joints to which dimensions belong | `dimension_owner.rs` |
//! | displacements at other dimensions | `deviation.rs` |
//! | tolerances and datums that are left out | `completeness.rs` |

mod completeness;
mod deviation;
mod dimension_owner;
mod entry_uses;
mod measure_mark;
mod spatial_facts;

use sensitol_spatial::{FeatureKind, FeaturePlace, JointKind};

use crate::Study;
pub use completeness::CompletenessGap;
pub use deviation::{RigidDisplacement, SceneDeviation};
pub use dimension_owner::DimensionOwner;
pub(crate) use entry_uses::{AssemblyUses, EntryUses, OpenZone};
pub use measure_mark::MeasureMark;
pub(crate) use spatial_facts::{ExtentQuantity, SpatialFacts, in_unit};

/// Assembly in space at its nominal dimensions, with lengths in one unit.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyScene {
    /// Unit of lengths; None if the study names none.
    pub length_unit: Option<String>,
    /// Parts in the order of the study.
    pub parts: Vec<ScenePart>,
    /// Features of all parts, in the order of the study.
    pub features: Vec<SceneFeature>,
    /// Joints in the order of assembly.
    pub joints: Vec<SceneJoint>,
    /// Measures.
    pub measures: Vec<SceneMeasure>,
    /// Indices of the measures of each characteristic of the problem: its own, or those that its formula uses.
    pub measured: Vec<Vec<usize>>,
    /// Owner of each dimension of the problem.
    pub owners: Vec<DimensionOwner>,
}

/// A part of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenePart {
    /// Name of the part.
    pub name: String,
    /// True if the part stands still.
    pub ground: bool,
    /// Place of the part's origin.
    pub origin: [f64; 3],
}

/// Outline of a feature about its origin. An extent that the study does not give is None.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FeatureOutline {
    /// A plane: a rectangle along x and y of the feature.
    Rectangle(Option<[f64; 2]>),
    /// A plane: a disc of this diameter.
    Disc(f64),
    /// A cylinder along z of the feature, with its origin in the middle.
    Cylinder {
        /// Diameter.
        diameter: Option<f64>,
        /// Length.
        length: Option<f64>,
    },
    /// A point, or a ball of this diameter.
    Ball(Option<f64>),
    /// Three directions.
    Triad,
}

/// A feature at its place in the assembly.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFeature {
    /// Full name, such as `housing.bore`.
    pub name: String,
    /// Index of the part.
    pub part: usize,
    /// Outline.
    pub outline: FeatureOutline,
    /// Origin.
    pub origin: [f64; 3],
    /// Directions x, y, z.
    pub axes: [[f64; 3]; 3],
}

/// A joint of two features.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneJoint {
    /// Name of the joint.
    pub name: String,
    /// Kind in words, such as `pin in hole`.
    pub kind: &'static str,
    /// Indices of the two features.
    pub between: [usize; 2],
    /// Freedoms that the joint takes, in words.
    pub freedoms: Vec<String>,
    /// Place at which the features meet.
    pub at: [f64; 3],
    /// True for a rod between two points.
    pub is_rod: bool,
}

/// A measure of two features.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneMeasure {
    /// Name of its characteristic.
    pub name: String,
    /// Indices of the measured feature, and of the one from which it is measured.
    pub between: [usize; 2],
    /// Lines that show it.
    pub mark: MeasureMark,
}

impl Study {
    /// Scene of the assembly in space. Returns None if the study has none. Evaluates nothing.
    ///
    /// ```
    /// use sensitol_study::{DimensionOwner, Study};
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
    /// let scene = study.scene().expect("there are parts");
    /// assert_eq!(scene.features[2].name, "block.lid");
    /// assert!((scene.features[2].origin[2] - 17.0).abs() < 1e-12);
    /// assert_eq!(scene.owners, [DimensionOwner::Feature(1)]);
    /// # Ok::<(), sensitol_study::StudyError>(())
    /// ```
    pub fn scene(&self) -> Option<AssemblyScene> {
        let facts = self.spatial.as_ref()?;
        let assembly = &facts.assembly;
        let places: Vec<FeaturePlace> = assembly.places(&facts.poses).concat();
        let mut features: Vec<SceneFeature> = Vec::with_capacity(places.len());
        for (part, of) in assembly.parts.iter().enumerate() {
            for feature in &of.features {
                let index = features.len();
                features.push(SceneFeature {
                    name: format!("{}.{}", of.name, feature.name),
                    part,
                    outline: outline(feature.kind, places[index].radius, facts.extent(index)),
                    origin: places[index].origin,
                    axes: places[index].axes,
                });
            }
        }
        let mut joints = Vec::with_capacity(assembly.joints.len());
        for (joint, freedoms) in assembly.joints.iter().zip(&facts.freedoms) {
            let between = joint.between.map(|id| facts.index(id));
            let kinds = joint.between.map(|id| assembly.feature(id).kind);
            joints.push(SceneJoint {
                name: joint.name.clone(),
                kind: words(joint.kind),
                between,
                freedoms: freedoms.clone(),
                at: meeting(joint.kind, kinds, between.map(|index| &places[index])),
                is_rod: joint.kind == JointKind::Rod,
            });
        }
        let mut measures = Vec::with_capacity(assembly.measures.len());
        for measure in &assembly.measures {
            let between = measure.between.map(|id| facts.index(id));
            let kinds = measure.between.map(|id| assembly.feature(id).kind);
            let mark = MeasureMark::of(&measure.kind, kinds, between.map(|index| &places[index]));
            measures.push(SceneMeasure { name: measure.name.clone(), between, mark });
        }
        Some(AssemblyScene {
            length_unit: self.length_unit.clone(),
            parts: (assembly.parts.iter().zip(&facts.poses))
                .map(|(part, pose)| ScenePart {
                    name: part.name.clone(),
                    ground: part.ground,
                    origin: pose.translation,
                })
                .collect(),
            measured: self.problem.characteristics().iter().map(|one| facts.measures_of(one.name())).collect(),
            owners: self.problem.dimensions().iter().map(|dimension| facts.owner(dimension.name())).collect(),
            features,
            joints,
            measures,
        })
    }
}

/// Outline of a feature by its kind and extent.
fn outline(kind: FeatureKind, radius: f64, extent: ExtentQuantity<f64>) -> FeatureOutline {
    let diameter = (radius > 0.0).then_some(2.0 * radius);
    match (kind, extent) {
        (FeatureKind::Plane, ExtentQuantity::Rectangle(size)) => FeatureOutline::Rectangle(Some(size)),
        (FeatureKind::Plane, ExtentQuantity::Length(length)) => FeatureOutline::Rectangle(Some([length; 2])),
        (FeatureKind::Plane, ExtentQuantity::Round(diameter)) => FeatureOutline::Disc(diameter),
        (FeatureKind::Plane, ExtentQuantity::Unknown) => FeatureOutline::Rectangle(None),
        (FeatureKind::Axis, ExtentQuantity::Length(length)) => {
            FeatureOutline::Cylinder { diameter, length: Some(length) }
        }
        (FeatureKind::Axis, _) => FeatureOutline::Cylinder { diameter, length: None },
        (FeatureKind::Point, _) => FeatureOutline::Ball(diameter),
        (FeatureKind::Frame, _) => FeatureOutline::Triad,
    }
}

/// Kind of a joint in words.
fn words(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Contact => "contact",
        JointKind::Pin => "pin in hole",
        JointKind::Slot => "pin in slot",
        JointKind::Ball => "ball in socket",
        JointKind::BallInHole => "ball in hole",
        JointKind::Round => "round on round",
        JointKind::Crossed => "crossed cylinders",
        JointKind::Revolute => "revolute",
        JointKind::Slide => "slide",
        JointKind::Rigid => "rigid",
        JointKind::Rod => "rod",
        JointKind::Angle => "driven angle",
    }
}

/// Place at which the features of a joint meet.
fn meeting(kind: JointKind, kinds: [FeatureKind; 2], [a, b]: [&FeaturePlace; 2]) -> [f64; 3] {
    let along = |from: [f64; 3], direction: [f64; 3], by: f64| [0, 1, 2].map(|i| from[i] + by * direction[i]);
    let middle = || [0, 1, 2].map(|i| 0.5 * (a.origin[i] + b.origin[i]));
    let across = [0, 1, 2].map(|i| b.origin[i] - a.origin[i]);
    match (kind, kinds) {
        // A round surface touches the plane below its middle, which is against the normal.
        (JointKind::Contact, [_, FeatureKind::Axis | FeatureKind::Point]) => along(b.origin, a.axes[2], -b.radius),
        (JointKind::Contact, _) => b.origin,
        (JointKind::Round, _) => {
            let forward = measure_mark::dot(across, a.axes[2]);
            let off = along(across, a.axes[2], -forward);
            match measure_mark::dot(off, off).sqrt() {
                0.0 => b.origin,
                // The point of the larger surface on the line through both axes.
                length => along(along(a.origin, a.axes[2], forward), off.map(|part| part / length), a.radius),
            }
        }
        (JointKind::Rod | JointKind::Crossed, _) => middle(),
        _ => a.origin,
    }
}
