//! `sensitol sweep`.

use crate::args::SweepArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::page_files::PageFiles;
use crate::progress::Bar;
use crate::running::{Clock, confirmed, externals, kept, on_threads};
use crate::{interrupt, study};
use sensitol::assembly::{Progress, Run};
use sensitol::sweep::{Sweep, sweep_with};
use sensitol::warning::Counted;
use sensitol_report::document::svg::svg;
use sensitol_report::document::terminal::text;
use sensitol_report::html::sweep_html;
use sensitol_report::{SweepReport, csv_tables};
use sensitol_study::Study;

pub(crate) fn run(asked: &SweepArgs, look: Look) -> Result<Exit, Failure> {
    let externals = externals(asked.work.journal.as_deref(), look, None);
    let mut study = study::read_sweeping(&asked.study, externals, &asked.over.name)?;
    study.options.seed = asked.seed.or(study.options.seed);
    let mut files = Files::of(&asked.study.study, &study, asked.work.journal.as_deref()).forced(asked.output.force);
    let destination = files.output(&asked.output)?;
    let names = ["sweep.csv".to_owned()];
    let table = files.folder(asked.csv.as_deref(), &names)?;
    let chart = files.file(asked.svg.as_deref())?;
    let page = PageFiles::open(&mut files, asked.html.as_deref(), asked.pdf.as_deref())?;
    let clock = Clock::start(asked.work.time)?;
    let sweep = swept(&study, asked, &clock, look)?;
    let report = SweepReport::of(&study.problem, &sweep, clock.about(&study));
    let document = report.document();
    let written =
        destination.write(&if asked.output.json { json(&report) } else { text(&document, look.style(&asked.output)) });
    let written = written.and(table.map_or(Ok(()), |table| table.write(&csv_tables(&document, &["sweep"]))));
    let written = written.and(chart.map_or(Ok(()), |chart| chart.write(&svg(&document, "Mean and quantile band"))));
    let written = written.and(page.write(|| sweep_html(&report)));
    look.tell_all(&report.warnings);
    let done = sweep.analyses.iter().flatten().count();
    clock.stopped(&sweep.run, (done as u64, Some(sweep.values.len() as u64)), Counted::Values, look);
    written?;
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    let nothing = |one: &sensitol_report::SweptReport| one.points.iter().all(|point| point.mean.is_none());
    let exit = if report.characteristics.iter().any(nothing) { Exit::NoResult } else { Exit::Done };
    Ok(confirmed(exit, &sweep.run))
}

fn swept(study: &Study, asked: &SweepArgs, clock: &Clock, look: Look) -> Result<Sweep, Failure> {
    let stop = || clock.stop();
    let costly = study.problem.function().signature().costly;
    let plan = costly.then(|| study.options.method.procedure().plan(&study.problem, &study.options)).transpose()?;
    let bar = plan.map(|plan| Bar::new(plan.cost().0.saturating_mul(asked.over.values.len()), look.quiet));
    let show = |more: Progress| bar.iter().for_each(|bar| bar.show(more));
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned).showing(&show);
    let sweep = || sweep_with(&study.problem, &asked.over.name, &asked.over.values, &study.options, &run);
    let result = on_threads(asked.threads, sweep);
    if let Some(bar) = bar {
        bar.clear();
    }
    kept(&study.problem)?;
    Ok(result??)
}
