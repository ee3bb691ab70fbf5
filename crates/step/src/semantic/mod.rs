//! Tolerances, datums, dimensions, faces and placed parts of an AP242 file.

mod aspect;
mod datum;
mod dimension;
mod face;
mod measure;
mod model;
mod placement;
mod product;
mod tolerance;

pub use datum::{DatumReference, DatumTarget, StepDatum};
pub use dimension::{DimensionKind, DimensionLimits, StepDimension};
pub use face::{FaceSurface, StepFace};
pub use measure::{StepMeasure, StepUnit};
pub use model::{StepModel, StepPart};
pub use placement::Placement;
pub(crate) use placement::{cross, dot, minus, plus, unit};
pub use product::PlacedPart;
pub use tolerance::{GeometricTolerance, MaterialCondition, ToleranceKind, ZoneShape};
