//! Tests of external programs as models.

mod failures;
mod gradients;
mod process;
