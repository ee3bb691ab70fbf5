//! The engine as a Python module: `sensitol._core`, which the package `sensitol` wraps.
//!
//! Python code runs only on the calling thread. The engine works on threads of its own and sends every block of points to the caller. The
//! caller evaluates it, checks for signals and shows progress.

mod confined;
mod errors;
mod host;
mod law;
mod outcome;
mod pools;
mod running;
mod study;

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command line, with the program's name first, and returns the exit code. It installs signal handlers, so it needs a process of
/// its own.
#[pyfunction]
fn run_cli(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| sensitol_cli::run_code(arguments))
}

/// Functions and classes that the package `sensitol` wraps.
#[pymodule(gil_used = false)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(run_cli, module)?)?;
    module.add_function(wrap_pyfunction!(confined::run_confined, module)?)?;
    module.add_function(wrap_pyfunction!(confined::warnings_page, module)?)?;
    module.add_class::<study::Study>()?;
    module.add_class::<law::Law>()?;
    module.add_class::<outcome::Outcome>()
}
