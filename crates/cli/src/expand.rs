//! `sensitol expand`.

use super::args::ExpandArgs;
use super::failure::{Exit, Failure};
use super::output::{Destination, Look};
use super::study;
use sensitol_study::{Externals, Study};

pub(super) fn run(asked: &ExpandArgs, look: Look) -> Result<Exit, Failure> {
    let externals = study::configured(Externals::default(), asked.configuration.as_deref());
    let study = Study::read_with(&asked.study, externals)?;
    look.warn_all(&study.warnings);
    Destination::Stdout.write(&study.expanded)?;
    Ok(Exit::Done)
}
