//! Assemblies in space: rigid parts with features, joints between them, and measures.
//!
//! An assembly is closed at its nominal sizes, and written as closure equations: unknowns for the poses, an equation for every freedom that a
//! joint takes, and a formula for every measure. Everything that works with closure equations works with assemblies in space.
//!
//! # Equations
//! Every joint consists of three kinds of equation: directions that are perpendicular, offsets along a direction, and distances. Residuals are
//! written once over a number type, and give derivatives for the nominal state and formulas for the study.
//!
//! # Mobility
//! At the nominal state the rank of the equations shows joints that repeat others, which is an error, and motions that no joint stops. Such a
//! motion is an error if a measure depends on it, and is held still otherwise.

mod assembly;
mod closed_assembly;
mod closure;
mod dual;
mod error;
mod expression;
mod feature_place;
mod influence;
mod joint;
mod measure;
mod mobility;
mod number;
mod part_pose;
mod placement;
mod press;
mod press_fault;
mod pressed_contacts;
#[cfg(test)]
mod tests;
mod vector;

pub use assembly::{
    Assembly, Direction, Feature, FeatureId, FeatureKind, FrameAxis, JointKind, Measure, MeasureKind, PartJoint, Press,
    Quantity, RigidPart,
};
pub use closed_assembly::{ClosedAssembly, NamedFormula, PoseUnknown};
pub use error::{SpatialError, Subject};
pub use feature_place::FeaturePlace;
pub use mobility::Mobility;
pub use part_pose::PartPose;
pub use press_fault::PressFault;
pub use pressed_contacts::PressedContacts;
