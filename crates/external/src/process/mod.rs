//! An external program as assembly function: JSON lines over stdin and stdout, `workers` children side by side.
//!
//! A program that a CAD system runs in crashes, hangs and lies. Nothing of it is trusted: every child is a process group of
//! its own that is ended on every way out, every point has a deadline, every line is checked, and what goes wrong is an error of
//! one point with what the program wrote to stderr. The protocol is in `adapters/PROTOCOL.md`.
//!
//! A solver that starts from its last solution may settle in a mirrored assembly and stay there, with status "solved". So
//! every child evaluates the nominal point again after some points, after every error and at the end of every batch; where the
//! answer is another than before, it is ended, and what it has answered since is evaluated again by a fresh one.
//!
//! A point that fails is tried again `retries` times, in a fresh child and alone, so that a point that crashes children is
//! found out and takes no other with it. A child that fails is started again, after a pause that doubles every time.

mod batch;
mod border;
mod child;
mod pool;
mod program;
mod protocol;
mod replay;
mod sentinel;
mod suspicion;
mod worker;

pub use program::Process;
pub(crate) use program::{Kept, Recheck};
