//! `sensitol compare`.

use crate::args::CompareArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::page_files::PageFiles;
use crate::running::{Clock, confirmed, kept, on_threads};
use crate::{interrupt, study};
use sensitol::assembly::Run;
use sensitol::compare::{CompareOptions, compare_with};
use sensitol::evaluation::history;
use sensitol::method::Options;
use sensitol::warning::{Counted, Warning};
use sensitol_report::document::svg::svg;
use sensitol_report::document::terminal::text;
use sensitol_report::html::compare_html;
use sensitol_report::{CompareReport, csv_tables};

pub(crate) fn run(asked: &CompareArgs, look: Look) -> Result<Exit, Failure> {
    let study = study::read_sampled(&asked.of, look)?;
    let mut files = Files::of(&asked.of.study, &study, asked.of.work.journal.as_deref()).forced(asked.output.force);
    let destination = files.output(&asked.output)?;
    let names = ["comparison.csv".to_owned()];
    let table = files.folder(asked.csv.as_deref(), &names)?;
    let chart = files.file(asked.svg.as_deref())?;
    let page = PageFiles::open(&mut files, asked.html.as_deref(), asked.pdf.as_deref())?;
    let mut options = CompareOptions::default();
    options.budget = asked.budget.or(study.options.budget);
    options.reference = asked.samples;
    options.seed = asked.of.seed.or(study.seed).unwrap_or(Options::SEED);
    let clock = Clock::start(asked.of.work.time)?;
    let stop = || clock.stop();
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned);
    let comparison = on_threads(asked.of.threads, || compare_with(&study.problem, &options, &run));
    kept(&study.problem)?;
    let comparison = comparison??;
    let about = clock.about(&study);
    let report = CompareReport::of(&comparison, about);
    let document = report.document();
    let written =
        destination.write(&if asked.output.json { json(&report) } else { text(&document, look.style(&asked.output)) });
    let written = written.and(table.map_or(Ok(()), |table| table.write(&csv_tables(&document, &["comparison"]))));
    let written = written.and(chart.map_or(Ok(()), |chart| chart.write(&svg(&document, "Evaluations against error"))));
    let written = written.and(page.write(|| compare_html(&report)));
    let failed = comparison.reference.characteristics.iter().filter(|one| one.failed > 0);
    let failed = failed.map(|one| Warning::FailedSamples {
        characteristic: one.characteristic.name().to_owned(),
        failed: one.failed,
        samples: one.samples + one.failed,
        error: one.error.as_ref().map(ToString::to_string).unwrap_or_default(),
    });
    let told = study.warnings.iter().cloned().chain(history(&study.problem, &[])).chain(failed);
    look.warn_all(&told.collect::<Vec<_>>());
    let methods = (comparison.ran.len(), comparison.ran.len() + comparison.not_run.len());
    clock.stopped(&comparison.run, (methods.0 as u64, Some(methods.1 as u64)), Counted::Methods, look);
    written?;
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    let nothing = comparison.reference.characteristics.iter().any(|one| one.samples == 0);
    Ok(confirmed(if nothing { Exit::NoResult } else { Exit::Done }, &comparison.run))
}
