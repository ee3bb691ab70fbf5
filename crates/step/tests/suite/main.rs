//! Tests of the reader of STEP files.

mod counts;
mod files;
mod hostile;
mod joints;
