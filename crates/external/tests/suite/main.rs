//! External programs as models.

mod gradients;
mod process;
