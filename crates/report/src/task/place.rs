//! Where a task is done.

use std::path::PathBuf;

use sensitol::assembly::Run;
use sensitol_study::Externals;

/// The folder from which a study's paths start, how its external programs are treated, and what may stop them.
pub struct TaskPlace<'a> {
    /// The folder; the current one unless given.
    pub folder: PathBuf,
    /// How external programs are treated; the task names the configuration.
    pub externals: Externals,
    /// The run, which hears of points and may be stopped.
    pub run: Run<'a>,
}

impl Default for TaskPlace<'_> {
    fn default() -> Self {
        Self { folder: PathBuf::from("."), externals: Externals::default(), run: Run::to_the_end() }
    }
}
