//! `sensitol compare`.

use std::time::{Duration, Instant};

use super::args::CompareArgs;
use super::csv::CsvFolder;
use super::failure::{Exit, Failure};
use super::output::{Destination, Look, json};
use super::{interrupt, on_threads, study};
use crate::assembly::Run;
use crate::compare::{CompareOptions, compare_within};
use crate::method::Options;
use crate::report::{About, CompareReport, compare_csv, compare_svg, compare_text};
use crate::study::Externals;

pub(super) fn run(asked: &CompareArgs, look: Look) -> Result<Exit, Failure> {
    let externals = Externals {
        journal: super::journal_place(asked.journal.as_deref()),
        listener: super::listener(look),
        points: None,
        sentinels: true,
    };
    let study = study::read_only(&asked.study, &asked.characteristics, externals)?;
    let destination = Destination::open(&asked.output)?;
    let names = ["comparison.csv".to_owned()];
    let table = asked.csv.as_deref().map(|folder| CsvFolder::open(folder, &names)).transpose()?;
    let chart = asked.svg.as_deref().map(Destination::file).transpose()?;
    let options = CompareOptions {
        budget: asked.budget.or(study.options.budget),
        reference: asked.samples,
        seed: asked.seed.or(study.seed).unwrap_or(Options::SEED),
    };
    interrupt::listen();
    let begun = Instant::now();
    let limit = asked.time.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
    let stop = || interrupt::stopped() || limit.is_some_and(|limit| begun.elapsed() >= limit);
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned);
    let comparison = on_threads(asked.threads, || compare_within(&study.problem, &options, &run))??;
    let about = About {
        title: study.title.clone(),
        sha256: study.sha256.clone(),
        seed: Some(options.seed),
        wall_s: begun.elapsed().as_secs_f64(),
        warnings: study.warnings.clone(),
    };
    let report = CompareReport::of(&comparison, about);
    let written =
        destination.write(&if asked.output.json { json(&report) } else { compare_text(&report, look.style()) });
    if let Some(table) = table {
        table.write(&[compare_csv(&report)])?;
    }
    if let Some(chart) = chart {
        chart.write(&compare_svg(&report))?;
    }
    for warning in &study.warnings {
        look.warn(warning.code(), &warning.message());
    }
    for one in comparison.reference.characteristics.iter().filter(|one| one.failed > 0) {
        let name = one.characteristic.name();
        look.warn("failed-points", &format!("`{name}` has no value at {} points of the reference", one.failed));
    }
    if interrupt::stopped() {
        look.warn("stopped", "interrupted");
        written?;
        return Ok(Exit::Interrupted);
    }
    if comparison.stopped {
        look.warn("stopped", "stopped by --time; what was not run is named");
    }
    written?;
    let nothing = comparison.reference.characteristics.iter().any(|one| one.samples == 0);
    Ok(if nothing { Exit::NoResult } else { Exit::Done })
}
