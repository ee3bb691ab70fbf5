//! The runs of `sensitol simulate` with and without `--rare`.

use std::sync::Mutex;
use std::time::Duration;

use super::args::SimulateArgs;
use super::failure::Failure;
use super::interrupt;
use super::output::Look;
use super::progress::Samples;
use super::running::{Clock, on_threads};
use sensitol::assembly::Run;
use sensitol::method::{Method, Options};
use sensitol::simulation::Pace;
use sensitol::warning::Warning;
use sensitol_study::Study;

/// A simulation that will take longer than this tells so.
const LONG: Duration = Duration::from_secs(60);

/// How the surrogate is analysed: as the study says, but for the method that is asked for.
pub(super) fn surrogate(study: &Study, asked: &SimulateArgs) -> Options {
    let mut options = study.options.clone();
    if let Some(method) = asked.method {
        options.method = method.0;
        // The study's choice of pairs was made for its own method.
        if method.0 != Method::SixN {
            (options.pairs, options.stencil) = (None, None);
        }
    }
    options
}

/// Draws points, showing how far it is, and telling once when that will be long.
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
        // Who waits for years should know after a second.
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
