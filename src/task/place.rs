//! Where a task is done.

use std::path::PathBuf;

use crate::assembly::Run;
use crate::study::Externals;

/// The folder from which a study's paths start, how its external programs are treated, and what may stop them.
pub struct Place<'a> {
    /// The folder; the current one unless given.
    pub folder: PathBuf,
    /// How external programs are treated; the task names the configuration.
    pub externals: Externals,
    /// What hears of points, and may stop the run.
    pub run: Run<'a>,
}

impl Default for Place<'_> {
    fn default() -> Self {
        Self { folder: PathBuf::from("."), externals: Externals::default(), run: Run::to_the_end() }
    }
}
