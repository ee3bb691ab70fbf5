//! Runs of `sensitol simulate` with and without `--rare`.

use std::sync::Mutex;
use std::time::Duration;

use crate::args::SimulateArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::output::Look;
use crate::progress::Samples;
use crate::running::{Clock, on_threads};
use sensitol::assembly::Run;
use sensitol::method::{Method, Options};
use sensitol::simulation::Pace;
use sensitol::warning::Warning;
use sensitol_study::Study;

/// Expected time above which a simulation prints a warning.
const LONG: Duration = Duration::from_secs(60);

/// Returns the options of the surrogate: those of the study, with the method of the command line.
pub(super) fn surrogate(study: &Study, asked: &SimulateArgs) -> Options {
    let mut options = study.options.clone();
    if let Some(method) = asked.method {
        options.method = method.0;
        // The study's pairs belong to its own method.
        if method.0 != Method::SixN {
            (options.pairs, options.stencil) = (None, None);
        }
    }
    options
}

/// Draws points with a progress bar, and warns once if the run will be long.
pub(super) fn sampling<T: Send>(
    threads: Option<u16>,
    clock: &Clock,
    look: Look,
    work: impl FnOnce(&Run<'_>, &(dyn Fn(Pace) + Sync)) -> T + Send,
) -> Result<T, Failure> {
    let bar = Samples::new(look.quiet);
    let told = Mutex::new(false);
    let pace = |pace: Pace| {
        bar.show(&pace);
        // The warning comes after the first second, so that the user can stop a run that would take years.
        let Ok(mut told) = told.lock() else { return };
        let rest = Duration::try_from_secs_f64(pace.expected_s()).unwrap_or(Duration::MAX);
        if !*told && !clock.limited() && pace.elapsed > Duration::from_secs(1) && rest > LONG {
            *told = true;
            look.warn(&Warning::Long { expected_s: pace.expected_s() });
        }
    };
    let stop = || clock.stop();
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned);
    let result = on_threads(threads, || work(&run, &pace));
    bar.clear();
    result
}
