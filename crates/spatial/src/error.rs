//! Faults of an assembly in space.

use crate::press_fault::PressFault;

/// Part of a study to which a fault belongs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Subject {
    /// The part of this index.
    Part(usize),
    /// The joint of this index.
    Joint(usize),
    /// The measure of this index.
    Measure(usize),
}

/// Reason why an assembly determines no state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpatialError {
    /// Every part stands still.
    #[error("no part moves: an assembly needs a part without `ground`")]
    NothingMoves,
    /// A part without a joint.
    #[error("part `{part}` has no joint")]
    NoJoint {
        /// Name of the part.
        part: String,
        /// Index of the part.
        index: usize,
    },
    /// Features that the kind of joint does not connect.
    #[error("joint `{joint}` connects {found}, and needs {expected}")]
    Features {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// The two features with their kinds.
        found: String,
        /// Kinds that fit.
        expected: String,
    },
    /// A joint between two features of one part, or of parts that stand still.
    #[error("joint `{joint}` connects two features of {what}")]
    SamePart {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// Owner of the features.
        what: String,
    },
    /// A number of freedoms that the joint cannot take.
    #[error("joint `{joint}` cannot take {found}: of these features it takes {known}")]
    Takes {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// The number that was given.
        found: usize,
        /// Numbers that fit, in words.
        known: String,
    },
    /// A distance that is 0 where the search stands, so that it has no direction.
    #[error("joint `{joint}` holds a distance that is 0 at the nominal sizes, and has no direction there")]
    NoDirection {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
    },
    /// Joints that fix freedoms again that others fix.
    #[error(
        "joint `{joint}` takes {takes}, and only {left} of these {are} free after {before}{named}: {equations} equations for {unknowns} unknowns, rank {rank}",
        are = if *left == 1 { "is" } else { "are" },
        named = if free.is_empty() { String::new() } else { format!(" ({})", free.join(", ")) }
    )]
    OverConstrained {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// Number of freedoms that the joint takes.
        takes: usize,
        /// Number of them that the joints before it leave.
        left: usize,
        /// Names of these freedoms.
        free: Box<[&'static str]>,
        /// Names of the joints before it, in words.
        before: Box<str>,
        /// Number of equations of all joints.
        equations: usize,
        /// Number of unknowns.
        unknowns: usize,
        /// Number of independent equations.
        rank: usize,
        /// Text to write instead.
        instead: Box<str>,
    },
    /// A joint that leaves out a tilt, and comes before every joint that could hold this tilt.
    #[error("joint `{joint}` takes {takes} and so leaves out a tilt, and no joint before it holds one")]
    WrongOrder {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// Number of freedoms that the joint takes.
        takes: usize,
        /// Number of freedoms with both tilts.
        all: usize,
        /// Later joint of the same parts that takes all freedoms; None if there is none.
        primary: Option<String>,
    },
    /// A force that holds a part against no contacts.
    #[error("joint `{joint}` {fault}")]
    Press {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// Reason.
        fault: Box<PressFault>,
    },
    /// A motion that no joint stops and a measure depends on.
    #[error("{motion}, and `{measure}` depends on it")]
    Free {
        /// The motion in words.
        motion: String,
        /// Name of the measure.
        measure: String,
        /// Index of the measure.
        index: usize,
    },
    /// Joints that cannot be closed at the nominal sizes.
    #[error("the joints do not close at the nominal sizes: `{joint}` is off by {off} ({equation})")]
    Open {
        /// Name of the joint that is off most.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// Residual of its worst equation, with its unit.
        off: String,
        /// Name of its worst equation.
        equation: &'static str,
        /// Advice on features that look the same way; None if there are none.
        same_way: Option<String>,
    },
    /// Planes in contact whose normals point the same way.
    #[error("joint `{joint}`: {features} look the same way")]
    SameWay {
        /// Name of the joint.
        joint: String,
        /// Index of the joint.
        index: usize,
        /// Names of the two planes.
        features: String,
    },
}

impl SpatialError {
    /// Part of the study to which the fault belongs. Returns None for the assembly as a whole.
    pub fn subject(&self) -> Option<Subject> {
        match self {
            Self::NothingMoves => None,
            Self::NoJoint { index, .. } => Some(Subject::Part(*index)),
            Self::Features { index, .. }
            | Self::SamePart { index, .. }
            | Self::Takes { index, .. }
            | Self::NoDirection { index, .. }
            | Self::Press { index, .. }
            | Self::WrongOrder { index, .. }
            | Self::OverConstrained { index, .. }
            | Self::Open { index, .. }
            | Self::SameWay { index, .. } => Some(Subject::Joint(*index)),
            Self::Free { index, .. } => Some(Subject::Measure(*index)),
        }
    }

    /// Text to write instead.
    pub fn help(&self) -> String {
        match self {
            Self::NothingMoves => "remove `ground = true` from the parts that the joints locate".into(),
            Self::NoJoint { part, .. } => {
                format!("add a joint that locates `{part}`, or remove the part")
            }
            Self::Features { expected, .. } => format!("name {expected}, or use another kind of joint"),
            Self::SamePart { .. } => "name a feature of a part that moves, and one of another part".into(),
            Self::NoDirection { .. } => {
                "place the parts apart with `at`, or hold two offsets: hole = \"part.bore\", pin = \"part.pin\"".into()
            }
            Self::Press { fault, .. } => fault.help(),
            Self::Takes { known, .. } => format!("write takes = {known}"),
            Self::WrongOrder { joint, all, primary: Some(primary), .. } => {
                format!("the primary datum takes {all}: put `{joint}` after `{primary}`, or say takes = {all}")
            }
            Self::WrongOrder { joint, all, primary: None, .. } => {
                format!("say takes = {all}, or put `{joint}` after the joint that holds its tilt")
            }
            Self::OverConstrained { instead, .. } => instead.to_string(),
            Self::Free { measure, .. } => {
                format!("add a joint that stops it, or let `{measure}` measure something that does not depend on it")
            }
            Self::Open { same_way: Some(advice), .. } => advice.clone(),
            Self::Open { .. } => {
                "check the places of its features, or give the parts a better start with `at` and `turned`".into()
            }
            Self::SameWay { .. } => "turn one of the normals around: each points out of its material".into(),
        }
    }
}
