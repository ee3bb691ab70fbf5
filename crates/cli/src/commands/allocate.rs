//! `sensitol allocate`.

use std::path::Path;

use crate::args::{AllocateArgs, CostArg, MaximiseArg, MinimiseArg};
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::own_file::Content;
use crate::page_files::PageFiles;
use crate::progress::Bar;
use crate::running::{Clock, confirmed, externals, kept, on_threads};
use crate::{interrupt, study};
use sensitol::allocation::{Allocation, AllocationOptions, AllocationTask, CostBasis, Goal, Status, allocate_written};
use sensitol::assembly::{Progress, Run};
use sensitol::method::Options;
use sensitol::problem::Problem;
use sensitol::warning::{Counted, Warning};
use sensitol_report::document::svg::svg;
use sensitol_report::document::terminal::text;
use sensitol_report::html::allocate_html;
use sensitol_report::{AllocationReport, WrittenAnew, csv_tables};
use sensitol_study::{NamedFile, Rewritten, Study};

pub(crate) fn run(asked: &AllocateArgs, look: Look) -> Result<Exit, Failure> {
    let study = study::read_for_all(&asked.study, &|| externals(asked.work.journal.as_deref(), look, None))?;
    let mut files = Files::of(&asked.study.study, &study, asked.work.journal.as_deref()).forced(asked.output.force);
    let destination = files.output(&asked.output)?;
    let folder = files.folder(asked.csv.as_deref(), &TABLES.map(|name| format!("{name}.csv")))?;
    let chart = files.file(asked.svg.as_deref())?;
    let page = PageFiles::open(&mut files, asked.html.as_deref(), asked.pdf.as_deref())?;
    asked.write.as_deref().map_or(Ok(()), |path| stays_beside(path, &asked.study.study, &study))?;
    let written = files.file_of(asked.write.as_deref(), &Content::Study)?;
    let clock = Clock::start(asked.work.time)?;
    let mut options = AllocationOptions::default();
    options.analysis = study.options.clone();
    options.recentre = asked.recentre.iter().map(|one| one.name.clone()).collect();
    options.nominal_bounds = asked.recentre.iter().filter_map(|one| Some((one.name.clone(), one.bounds?))).collect();
    options.front = asked.front.or(asked.svg.is_some().then_some(FRONT));
    options.confirm = None;
    options.seed = asked.seed.or(study.seed).unwrap_or(Options::SEED);
    let options = options.with_confirm_or_default(&study.problem, asked.confirm);
    let task = task(&study, asked);
    let allocation = allocate(&study, &task, &options, asked.threads, &clock, look)?;
    // An allocation that was stopped before the model confirmed it is printed, but not written to the study.
    let found = allocation.after.is_some() && allocation.status != Status::OutOfTime;
    // A result that cannot be written into the study is still printed.
    let anew = if found { Some(study.rewritten(&allocation.problem)) } else { None };
    let table =
        anew.as_ref().and_then(|anew| anew.as_ref().ok()).map(|Rewritten { entries, replaced_fits, .. }| WrittenAnew {
            entries: entries.clone(),
            replaced_fits: replaced_fits.clone(),
        });
    let about = clock.about(&study);
    let report = AllocationReport::of(&study.problem, &allocation, table.as_ref(), about);
    let document = report.document();
    let printed = match asked.output.json {
        true if look.verbose => json(&report),
        true => json(&report.clone().shortened()),
        false => text(&document, look.style(&asked.output)),
    };
    let mut result = destination.write(&printed);
    result = result.and(folder.map_or(Ok(()), |folder| folder.write(&csv_tables(&document, &TABLES))));
    result = result.and(chart.map_or(Ok(()), |chart| chart.write(&svg(&document, "Cost against what is required"))));
    result = result.and(page.write(|| allocate_html(&report)));
    match (written, anew) {
        (Some(file), Some(Ok(anew))) => result = result.and(file.write(&anew.text)),
        (Some(_), Some(Err(error))) => result = result.and(Err(Failure::Rewrite(error))),
        (Some(_), None) => look.warn(&Warning::NothingToWrite),
        (None, Some(Err(error))) => look.warn(&Warning::NotWritten { reason: error.to_string() }),
        (None, _) => {}
    }
    look.tell_all(&report.warnings);
    clock.stopped(&allocation.run, (allocation.run.evaluations, None), Counted::Evaluations, look);
    result?;
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    let incomplete = allocation.before.characteristics.iter().any(|one| one.moments.is_none());
    // A confirmation that the user requested and that fails decides the exit code.
    let refutes = ["confirmation-misses", "joint-confirmation-misses"];
    let refuted = report.warnings.iter().any(|warning| refutes.contains(&warning.code));
    let exit = match allocation.status {
        _ if incomplete && !allocation.run.unfinished() => Exit::NoResult,
        Status::Optimal | Status::LocalOptimum | Status::AlmostOptimal if refuted => Exit::Missed,
        Status::Optimal | Status::LocalOptimum | Status::AlmostOptimal => Exit::Done,
        Status::Infeasible | Status::NoFeasiblePointFound | Status::Inconclusive | Status::OutOfTime => {
            Exit::NotAllocated
        }
    };
    Ok(confirmed(exit, &allocation.run))
}

/// Refuses to write into another folder: relative paths in the study would lead elsewhere.
pub(crate) fn stays_beside(path: &Path, study_path: &Path, study: &Study) -> Result<(), Failure> {
    let folder = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        std::fs::canonicalize(folder).ok()
    };
    let (there, here) = (folder(path), folder(study_path));
    let mut names: Vec<String> = study.files.iter().filter(|file| file.is_relative()).map(NamedFile::shown).collect();
    names.dedup();
    match there.is_some() && there != here && !names.is_empty() {
        true => Err(Failure::AnotherFolder { path: path.to_owned(), names: names.join(", ") }),
        false => Ok(()),
    }
}

/// Tables of an allocation, a CSV file each.
const TABLES: [&str; 3] = ["tolerances", "requirements", "front"];

/// Default number of points of the front in a chart.
const FRONT: usize = 12;

/// Returns the task of the study. Without costs of its own it gets relative costs, unless only nominal values move.
fn task(study: &Study, asked: &AllocateArgs) -> AllocationTask {
    let basis = asked.cost.map(|basis| match basis {
        CostArg::ToleranceUnit => CostBasis::ToleranceUnit,
        CostArg::ConstantPrecision => CostBasis::ConstantPrecision,
        CostArg::EqualShares => CostBasis::EqualShares,
    });
    let goal = match (asked.minimise, asked.maximise, asked.cost_limit) {
        (Some(MinimiseArg::Rejects), _, Some(cost_limit)) => Goal::FewestRejects { cost_limit },
        (_, Some(MaximiseArg::Cpk), Some(cost_limit)) => Goal::MostCpk { cost_limit },
        _ => Goal::LeastCost,
    };
    let task = study.allocation_task().relative_or_default(&study.problem, basis, !asked.recentre.is_empty());
    task.towards(goal)
}

fn allocate(
    study: &Study,
    task: &AllocationTask,
    options: &AllocationOptions,
    threads: Option<u16>,
    clock: &Clock,
    look: Look,
) -> Result<Allocation, Failure> {
    let stop = || clock.stop();
    let costly = study.problem.function().signature().costly;
    let asked = options.derivatives(&study.problem);
    let plan = costly.then(|| asked.method.procedure().plan(&study.problem, &asked)).transpose()?;
    // Lower bound of the evaluations: one analysis at the tolerances before and one at those found.
    let bar = plan.map(|plan| Bar::new(2 * plan.cost().0, look.quiet));
    let show = |more: Progress| bar.iter().for_each(|bar| bar.show(more));
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned).showing(&show);
    let written = |problem: &Problem| study.written_dimensions(problem);
    let result = on_threads(threads, || allocate_written(&study.problem, task, options, &run, &written));
    if let Some(bar) = bar {
        bar.clear();
    }
    kept(&study.problem)?;
    Ok(result??)
}
