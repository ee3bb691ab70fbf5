//! `sensitol allocate`.

use std::path::Path;

use super::args::AllocateArgs;
use super::csv::CsvFolder;
use super::failure::{Exit, Failure};
use super::output::{Destination, Look, json};
use super::progress::Bar;
use super::running::{Clock, externals, on_threads};
use super::{interrupt, study};
use crate::allocation::{Allocation, AllocationOptions, Status, allocate_within};
use crate::assembly::{Progress, Run};
use crate::method::Options;
use crate::report::html::allocate_html;
use crate::report::{
    AllocationReport, WrittenAnew, allocation_csv, allocation_csv_names, allocation_svg, allocation_text,
};
use crate::study::{Rewritten, Study};

pub(super) fn run(asked: &AllocateArgs, look: Look) -> Result<Exit, Failure> {
    let study = study::read(&asked.study, externals(asked.work.journal.as_deref(), look, None))?;
    let destination = Destination::open(&asked.output)?;
    let folder = asked.csv.as_deref().map(|folder| CsvFolder::open(folder, &allocation_csv_names())).transpose()?;
    let chart = asked.svg.as_deref().map(Destination::file).transpose()?;
    let page = asked.html.as_deref().map(Destination::file).transpose()?;
    let written = asked.write.as_deref().map(|path| beside(&asked.study.study, path)).transpose()?;
    let clock = Clock::start(asked.work.time);
    let options = AllocationOptions {
        analysis: study.options.clone(),
        recentre: asked.recentre.clone(),
        front: asked.front.or(asked.svg.is_some().then_some(FRONT)),
        confirm: asked.confirm,
        seed: asked.seed.or(study.seed).unwrap_or(Options::SEED),
    };
    let allocation = allocate(&study, &options, asked.threads, &clock, look)?;
    // What was stopped before the model had its say is shown and not written.
    let found = allocation.after.is_some() && allocation.status != Status::OutOfTime;
    // What cannot be written into the file can be shown all the same.
    let anew = if found { Some(study.rewritten(&allocation.problem)) } else { None };
    let table =
        anew.as_ref().and_then(|anew| anew.as_ref().ok()).map(|Rewritten { entries, replaced_fits, .. }| WrittenAnew {
            entries: entries.clone(),
            replaced_fits: replaced_fits.clone(),
        });
    let about = clock.about(&study, Some(options.seed));
    let report = AllocationReport::of(&study.problem, &allocation, table.as_ref(), about);
    let printed = if asked.output.json { json(&report) } else { allocation_text(&report, look.style(&asked.output)) };
    let mut result = destination.write(&printed);
    result = result.and(folder.map_or(Ok(()), |folder| folder.write(&allocation_csv(&report))));
    result = result.and(chart.map_or(Ok(()), |chart| chart.write(&allocation_svg(&report))));
    result = result.and(page.map_or(Ok(()), |page| page.write(&allocate_html(&report))));
    match (written, anew) {
        (Some(file), Some(Ok(anew))) => result = result.and(file.write(&anew.text)),
        (Some(_), Some(Err(error))) => result = result.and(Err(Failure::Rewrite(error))),
        (Some(_), None) => {
            look.warn("not-written", "there are no tolerances to write: the file of --write is as it was")
        }
        (None, Some(Err(error))) => look.warn("not-written", &error.to_string()),
        (None, _) => {}
    }
    for warning in &report.warnings {
        look.warn(warning.code, &warning.message);
    }
    let after = format!("after {} evaluations", allocation.evaluations);
    if interrupt::stopped() {
        look.warn("stopped", &format!("interrupted {after}"));
        result?;
        return Ok(Exit::Interrupted);
    }
    if let (true, Some(limit)) = (allocation.stopped, asked.work.time) {
        look.warn("stopped", &format!("stopped after {limit} s, {after}"));
    }
    result?;
    let incomplete = allocation.before.characteristics.iter().any(|one| one.moments.is_none());
    // Who asks for a confirmation wants to know that there is none.
    let refuted = report.warnings.iter().any(|warning| warning.code == "confirmation-misses");
    Ok(match allocation.status {
        _ if incomplete && !allocation.stopped => Exit::NoResult,
        Status::Optimal | Status::AlmostOptimal if refuted => Exit::Missed,
        Status::Optimal | Status::AlmostOptimal => Exit::Done,
        Status::Infeasible | Status::OutOfTime => Exit::NotAllocated,
    })
}

/// Where the study is written anew: never onto itself.
fn beside(study: &Path, path: &Path) -> Result<Destination, Failure> {
    let same = std::fs::canonicalize(path).ok().zip(std::fs::canonicalize(study).ok()).is_some_and(|(a, b)| a == b);
    if same { Err(Failure::OntoItself { path: path.to_owned() }) } else { Destination::file(path) }
}

/// Points of a chart when nobody said how many.
const FRONT: usize = 12;

fn allocate(
    study: &Study,
    options: &AllocationOptions,
    threads: Option<u16>,
    clock: &Clock,
    look: Look,
) -> Result<Allocation, Failure> {
    let stop = || clock.stop();
    let costly = study.problem.function().signature().costly;
    let asked = options.derivatives(&study.problem);
    let plan = costly.then(|| asked.method.procedure().plan(&study.problem, &asked)).transpose()?;
    // At the tolerances before and at those found, at the least.
    let bar = plan.map(|plan| Bar::new(2 * plan.cost().0, look.quiet));
    let show = |more: Progress| bar.iter().for_each(|bar| bar.show(more));
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned).showing(&show);
    let task = study.allocation_task();
    let result = on_threads(threads, || allocate_within(&study.problem, &task, options, &run));
    if let Some(bar) = bar {
        bar.clear();
    }
    Ok(result??)
}
