//! The arguments of `sensitol init`: the kind of the first study.

use clap::{ArgGroup, Args};

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("kind").args(["stack", "fit", "measured", "position", "closed_loop", "assembly", "process", "model"]))]
pub(crate) struct InitArgs {
    /// Output file; `.toml` is added if there is no extension [default: study.toml]. An existing file is never overwritten
    pub(crate) name: Option<String>,

    /// A linear stack: parts in a row, and the gap that is left
    #[arg(long)]
    pub(crate) stack: bool,

    /// A fit of ISO 286: a shaft in a bore
    #[arg(long)]
    pub(crate) fit: bool,

    /// A dimension with measured values; writes the values too, in a CSV file
    #[arg(long)]
    pub(crate) measured: bool,

    /// Positions of holes: zones with a diameter sign
    #[arg(long)]
    pub(crate) position: bool,

    /// A mechanism as a closed loop of vectors
    #[arg(long = "loop")]
    pub(crate) closed_loop: bool,

    /// Two parts in space with their joints
    #[arg(long)]
    pub(crate) assembly: bool,

    /// A program as the model; writes the program too, a few lines of Python to put your CAD system into
    #[arg(long)]
    pub(crate) process: bool,

    /// A built-in model (see sensitol models)
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<String>,
}
