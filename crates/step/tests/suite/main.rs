//! Tests of the reader of STEP files.

mod counts;
mod features;
mod files;
mod hostile;
mod joints;
