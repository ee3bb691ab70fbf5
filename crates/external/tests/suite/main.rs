//! Tests of external programs as models.

mod gradients;
mod process;
