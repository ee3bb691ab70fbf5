//! Environment of a task.

use std::path::PathBuf;

use sensitol::assembly::Run;
use sensitol_study::Externals;

/// Folder of a study's paths, treatment of its external models, and control of the run.
pub struct TaskPlace<'a> {
    /// Folder of relative paths; the current folder by default.
    pub folder: PathBuf,
    /// Folder that measured files are in, and files of a model; None if they may be anywhere.
    pub root: Option<PathBuf>,
    /// True if a run may start the program of a study.
    pub starts_programs: bool,
    /// Treatment of external models. The task names the configuration.
    pub externals: Externals,
    /// Run that counts points and can be stopped.
    pub run: Run<'a>,
}

impl Default for TaskPlace<'_> {
    fn default() -> Self {
        Self {
            folder: PathBuf::from("."),
            root: None,
            starts_programs: true,
            externals: Externals::default(),
            run: Run::to_the_end(),
        }
    }
}
