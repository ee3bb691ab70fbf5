//! External programs as assembly functions: JSON lines over stdin and stdout, with `workers` children side by side.
//!
//! A program that drives a CAD system may crash, hang or give wrong answers, so nothing of it is trusted. Every child is a process group of
//! its own, which is ended on every way out. Every point has a deadline, and every line is checked. A fault becomes an error of one point,
//! with the text that the program wrote to stderr. The protocol is in `adapters/PROTOCOL.md`.
//!
//! A solver that starts from its last solution may settle in a mirrored assembly and stay there, with status "solved". So every child
//! evaluates the nominal point again after some points, after every error and at the end of every batch. If the answer differs, the child
//! is ended, and a fresh one evaluates again what it has answered since.
//!
//! A failed point is tried again `retries` times, alone in a fresh child. So a point that crashes children is found and affects no other. A
//! failed child is started again after a pause that doubles every time. A program without a value at the first points, all of which fail for
//! one reason, is not asked for the others.

mod batch;
mod border;
mod child;
mod descendants;
mod futility;
mod group;
mod lane;
mod line_reader;
mod pool;
mod program;
mod protocol;
mod replay;
mod sentinel;
mod suspicion;
mod walk;
mod worker;

pub use group::GroupedProcess;
pub use program::Process;
pub(crate) use program::Recheck;
