//! Options of the commands that give a page to a browser.

use std::path::PathBuf;

use clap::Args;

use crate::args::shared_args::OUTPUT;

#[derive(Debug, Args)]
pub(crate) struct WorkbenchArgs {
    /// The study that the page opens, .toml or .json
    pub(crate) study: Option<PathBuf>,

    /// The file to write
    #[arg(short, long, value_name = "FILE.html", default_value = "workbench.html", help_heading = OUTPUT)]
    pub(crate) output: PathBuf,

    /// Write over a file that sensitol did not write
    #[arg(long, help_heading = OUTPUT)]
    pub(crate) force: bool,

    /// The page without a study, as web/build writes it
    #[arg(long, value_name = "FILE.html")]
    pub(crate) page: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ServeArgs {
    /// The folder of the studies
    #[arg(default_value = ".")]
    pub(crate) folder: PathBuf,

    /// The port; a free one unless given
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) port: u16,

    /// The address to listen at; any other than 127.0.0.1 admits other machines that have the token
    #[arg(long, value_name = "ADDRESS")]
    pub(crate) address: Option<std::net::IpAddr>,

    /// The page without a study, as web/build writes it
    #[arg(long, value_name = "FILE.html")]
    pub(crate) page: Option<PathBuf>,
}
