//! Parts, features, joints and measures, as a study gives them.

/// A number on a drawing: a constant or a formula, with its value at the nominal dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Text of the formula; None for a constant.
    pub formula: Option<String>,
    /// Value at the nominal dimensions.
    pub value: f64,
}

impl Quantity {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self { formula: None, value }
    }

    /// A formula with its value at the nominal dimensions.
    pub fn formula(text: impl Into<String>, value: f64) -> Self {
        Self { formula: Some(text.into()), value }
    }
}

/// A direction in the frame of a part.
#[derive(Debug, Clone, PartialEq)]
pub enum Direction {
    /// A vector of any length.
    Along([Quantity; 3]),
    /// A direction that is turned about another one by an angle in radians.
    Turned {
        /// Angle in radians, by the right hand.
        angle: Quantity,
        /// Direction of the axis.
        about: [f64; 3],
        /// Direction before it is turned.
        from: [f64; 3],
    },
}

/// Kind of a feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeatureKind {
    /// A plane; its z is the normal out of the material.
    Plane,
    /// An axis of a hole or a pin; its z is the direction.
    Axis,
    /// A point, or the centre of a ball.
    Point,
    /// A frame of three directions.
    Frame,
}

impl FeatureKind {
    /// The word for the kind.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Axis => "axis",
            Self::Point => "point",
            Self::Frame => "frame",
        }
    }
}

/// A feature of a part: a place with a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// Name within the part.
    pub name: String,
    /// Kind of the feature.
    pub kind: FeatureKind,
    /// Place in the frame of the part.
    pub origin: [Quantity; 3],
    /// Direction of the normal or axis. Of a point it has no meaning.
    pub z: Direction,
    /// First direction of the feature's frame; None for the part's axis that is farthest from `z`.
    pub x: Option<Direction>,
    /// Diameter of a hole, pin or ball; None for 0.
    pub diameter: Option<Quantity>,
    /// Displacement in the frame of the feature.
    pub shift: Option<[Quantity; 3]>,
    /// Rotation vector in the frame of the feature, in radians. It is exact to the second order, and off by 1/12 of the third power.
    pub tilt: Option<[Quantity; 3]>,
}

/// A part: a rigid body with features.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidPart {
    /// Name of the part.
    pub name: String,
    /// True if the part stands still.
    pub ground: bool,
    /// Place of the part's origin at the start of the search.
    pub at: [f64; 3],
    /// Rotation vector of the part at the start of the search, in radians.
    pub turned: [f64; 3],
    /// Features of the part.
    pub features: Vec<Feature>,
}

/// A feature of a part, by their indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FeatureId {
    /// Index of the part.
    pub part: usize,
    /// Index of the feature in the part.
    pub feature: usize,
}

/// Kind of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// A plane against a plane, an axis or a point.
    Contact,
    /// An axis in an axis: a pin in a hole.
    Pin,
    /// An axis in a slot, which is a frame: x along the slot, y across it, z out of it.
    Slot,
    /// A point on a point.
    Ball,
    /// A point on an axis.
    BallInHole,
    /// A round surface in or at another one, with parallel axes.
    Round,
    /// Two skew axes whose surfaces touch.
    Crossed,
    /// A frame on a frame that turns about its z.
    Revolute,
    /// A frame on a frame that slides along its z.
    Slide,
    /// A frame on a frame.
    Rigid,
    /// A rod between two points.
    Rod,
    /// A driven angle about z, from x of the first frame to that of the second.
    Angle,
}

/// A joint of two features.
#[derive(Debug, Clone, PartialEq)]
pub struct PartJoint {
    /// Name of the joint.
    pub name: String,
    /// Kind of the joint.
    pub kind: JointKind,
    /// The two features.
    pub between: [FeatureId; 2],
    /// Number of freedoms that the joint takes; None for all that its kind can take.
    pub takes: Option<usize>,
    /// Gap of a contact, length of a rod, driven angle in radians; None for 0.
    pub value: Option<Quantity>,
    /// Offsets of a pin or ball across the axis of its hole, in the frame of the hole; None for 0.
    pub offset: Option<[Quantity; 2]>,
    /// Slopes of the axis of a pin along x and y of its hole; None for 0.
    pub tilt: Option<[Quantity; 2]>,
    /// True if round surfaces lie side by side, so that the sum of their radii counts and not the difference.
    pub side_by_side: bool,
    /// Force that presses a part against contacts. The features of the joint are the plane and the first contact then.
    pub press: Option<Press>,
}

/// Force that presses a part against points, some of which touch a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Press {
    /// Points that can touch the plane, in their order.
    pub targets: Vec<FeatureId>,
    /// Direction of the force in the assembly, of length 1.
    pub force: [f64; 3],
    /// Feature at which the force acts. None for the middle of the contacts, or for the origin of the plane if its part is pressed.
    pub weight: Option<FeatureId>,
}

impl Press {
    /// Index of the part that is pressed: that of `weight`, or the one with the contacts unless it stands still.
    pub(crate) fn part(&self, assembly: &Assembly, joint: &PartJoint) -> usize {
        let (plane, points) = (joint.between[0].part, joint.between[1].part);
        let without = if assembly.parts[points].ground { plane } else { points };
        self.weight.map_or(without, |id| id.part)
    }
}

/// A coordinate of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameAxis {
    /// The first direction.
    X,
    /// The second direction.
    Y,
    /// The normal or axis.
    Z,
}

/// Kind of a measure.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasureKind {
    /// Distance of a feature: along the normal of a plane, across an axis, from a point.
    Distance,
    /// A coordinate of a feature in the frame of the other.
    Along(FrameAxis),
    /// Angle in radians of two directions, or of an axis above a plane.
    Angle,
    /// Distance less the radii of both features.
    Gap,
    /// Greatest deviation over points of a feature, each given by its coordinates in the frame of the feature, from their nominal distances.
    Profile(Vec<[Quantity; 2]>),
}

/// A measure of two features.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// Name of the characteristic.
    pub name: String,
    /// Kind of the measure.
    pub kind: MeasureKind,
    /// The measured feature, and the feature from which it is measured.
    pub between: [FeatureId; 2],
}

/// Parts with joints and measures.
///
/// The first part, or the one with `ground`, stands still. Lengths have one unit, angles are in radians.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// Parts of the assembly.
    pub parts: Vec<RigidPart>,
    /// Joints, in the order of assembly.
    pub joints: Vec<PartJoint>,
    /// Measures.
    pub measures: Vec<Measure>,
    /// Unit that a constant length needs in a formula; None if it needs none.
    pub length_unit: Option<String>,
    /// Name of the unit in which faults show lengths, and its size in the unit of the numbers; None if it has none.
    pub shown_unit: Option<(String, f64)>,
}

impl PartJoint {
    /// Features that the joint joins: its two, and all contacts and the place of the force of a joint that presses.
    pub fn features(&self) -> impl Iterator<Item = FeatureId> {
        let pressed = self.press.iter().flat_map(|press| press.targets.iter().copied().chain(press.weight));
        self.between.into_iter().chain(pressed)
    }
}

impl Assembly {
    /// The feature of this index.
    pub fn feature(&self, id: FeatureId) -> &Feature {
        &self.parts[id.part].features[id.feature]
    }

    /// Full name of a feature, such as `housing.bore`.
    pub fn feature_name(&self, id: FeatureId) -> String {
        format!("{}.{}", self.parts[id.part].name, self.feature(id).name)
    }

    /// Names of contacts within their part.
    pub(crate) fn contact_names(&self, press: &Press) -> Vec<String> {
        press.targets.iter().map(|&id| self.feature(id).name.clone()).collect()
    }

    /// Indices of the parts that move.
    pub(crate) fn moving(&self) -> Vec<usize> {
        (0..self.parts.len()).filter(|&part| !self.parts[part].ground).collect()
    }

    /// The largest coordinate, with which directions and lengths are compared; 1 if there is none.
    pub(crate) fn size(&self) -> f64 {
        let of_feature = |feature: &Feature| {
            let places = feature.origin.iter().map(|place| place.value.abs());
            places.chain(feature.diameter.iter().map(|diameter| diameter.value.abs())).fold(0.0, f64::max)
        };
        let features = self.parts.iter().flat_map(|part| part.features.iter().map(of_feature));
        let starts = self.parts.iter().flat_map(|part| part.at.iter().map(|at| at.abs()));
        let values = self.joints.iter().filter(|joint| joint.kind == JointKind::Rod);
        let values = values.filter_map(|joint| joint.value.as_ref()).map(|value| value.value.abs());
        match features.chain(starts).chain(values).fold(0.0, f64::max) {
            size if size > 0.0 && size.is_finite() => size,
            _ => 1.0,
        }
    }
}
