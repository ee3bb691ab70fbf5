//! Assembly in space that a report shows beside the figures: its scene, and contributions by feature.

mod deviations;
mod owner_share;

pub(crate) use owner_share::{OwnerShare, ShareOwner, owner_shares};

use sensitol_study::{AssemblyScene, SceneDeviation};

/// Assembly in space of a report.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReportedAssembly {
    pub(crate) scene: AssemblyScene,
    /// Displacements at one sigma of each characteristic; None if they are unknown. Empty unless requested.
    pub(crate) deviations: Vec<Option<SceneDeviation>>,
}
