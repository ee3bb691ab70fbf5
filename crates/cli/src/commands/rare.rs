//! `sensitol simulate --rare`.

use crate::args::SimulateArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::interrupt;
use crate::output::{Look, json};
use crate::page_files::PageFiles;
use crate::running::{Clock, checked, confirmed, kept};
use crate::sampling::{sampling, surrogate};
use sensitol::method::Options;
use sensitol::rare::{RareCharacteristic, RareOptions, rare_with};
use sensitol::warning::{Counted, Warning};
use sensitol_report::document::terminal::text;
use sensitol_report::html::rare_html;
use sensitol_report::{RareReport, csv_tables};
use sensitol_study::Study;

/// Default number of points: cheap model, costly model.
const SAMPLES: [u64; 2] = [10_000, 1000];

pub(crate) fn run(asked: &SimulateArgs, study: &Study, look: Look) -> Result<Exit, Failure> {
    let mut files =
        Files::of(&asked.of.study, study, asked.of.work.journal.as_deref()).forced(asked.report.output.force);
    let destination = files.output(&asked.report.output)?;
    let names = ["rare.csv".to_owned()];
    let folder = files.folder(asked.report.csv.as_deref(), &names)?;
    let page = PageFiles::open(&mut files, asked.report.html.as_deref(), asked.report.pdf.as_deref())?;
    let costly = study.problem.function().signature().costly;
    let mut options = RareOptions::default();
    options.samples = asked.samples.unwrap_or(SAMPLES[usize::from(costly)]);
    options.seed = asked.of.seed.or(study.seed).unwrap_or(Options::SEED);
    options.until = asked.until;
    options.surrogate = surrogate(study, asked);
    let clock = Clock::start(asked.of.work.time)?;
    let threads = asked.of.threads;
    let found = sampling(threads, &clock, look, |run, pace| rare_with(&study.problem, &options, run, pace));
    kept(&study.problem)?;
    let found = found??;
    let about = clock.about(study);
    let report = RareReport::of(&study.problem, &found, about);
    let document = report.document();
    let written = destination.write(&if asked.report.output.json {
        json(&report)
    } else {
        text(&document, look.style(&asked.report.output))
    });
    let written = written.and(folder.map_or(Ok(()), |folder| folder.write(&csv_tables(&document, &["rare"]))));
    let written = written.and(page.write(|| rare_html(&report)));
    look.tell_all(&report.warnings);
    clock.stopped(&found.run, (found.samples, None), Counted::Points, look);
    if interrupt::stopped() {
        written?;
        return Ok(Exit::Interrupted);
    }
    if found.reached == Some(false) {
        look.warn(&Warning::TargetErrorMissed { points: found.samples });
    }
    written?;
    let nothing =
        |one: &RareCharacteristic| one.characteristic.limits().exist() && one.below.is_none() && one.above.is_none();
    if found.characteristics.iter().any(nothing) {
        return Ok(Exit::NoResult);
    }
    let judged = found.characteristics.iter().flat_map(RareCharacteristic::requirements);
    let judged = judged.chain(found.joint_requirement);
    let exit = if asked.report.check { checked(found.run.unfinished(), judged) } else { Exit::Done };
    Ok(confirmed(exit, &found.run))
}
