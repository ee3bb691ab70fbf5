//! `sensitol expand`.

use crate::args::ExpandArgs;
use crate::failure::{Exit, Failure};
use crate::output::{Destination, Look};
use crate::study;
use sensitol_study::{Externals, Study};

pub(crate) fn run(asked: &ExpandArgs, look: Look) -> Result<Exit, Failure> {
    let externals = study::configured(Externals::default(), asked.configuration.as_deref());
    let study = Study::read_with(&asked.study, externals)?;
    look.warn_all(&study.warnings);
    Destination::Stdout.write(&study.expanded)?;
    Ok(Exit::Done)
}
