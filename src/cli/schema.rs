//! `sensitol schema`.

use super::args::{OutputArgs, SchemaArgs};
use super::failure::{Exit, Failure};
use super::output::{Destination, json};
use crate::study::schema;

pub(super) fn run(asked: &SchemaArgs) -> Result<Exit, Failure> {
    let destination = Destination::open(&OutputArgs { json: true, output: asked.output.clone() })?;
    destination.write(&json(&schema()))?;
    Ok(Exit::Done)
}
