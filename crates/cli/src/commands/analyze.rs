//! `sensitol analyze`.

use std::path::Path;
use std::sync::Arc;

use crate::args::{AnalyzeArgs, StackArg};
use crate::csv::CsvFolder;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::interrupt;
use crate::output::{Destination, Look, json};
use crate::own_file::Content;
use crate::page_files::PageFiles;
use crate::points;
use crate::progress::Bar;
use crate::running::{Clock, checked, confirmed, externals, kept, on_threads};
use crate::study;
use crate::table::is_table;
use sensitol::analysis::{Analysis, CharacteristicAnalysis, FigureBasis, analyze_with};
use sensitol::assembly::{Progress, Run, Table};
use sensitol::method::ReducedInputs;
use sensitol::warning::{Counted, Warning};
use sensitol_numeric::characteristic::Characteristic;
use sensitol_report::document::markdown::markdown;
use sensitol_report::document::terminal::text;
use sensitol_report::document::{Detail, Style};
use sensitol_report::html::{WhatIf, analyze_html};
use sensitol_report::{
    Report, WarningReport, analyze_xlsx, budget_csv_of_studies, budget_document, csv_file_names, csv_files, stack_csv,
    stack_document,
};
use sensitol_study::Study;

/// Runs `sensitol analyze` on one study.
pub(crate) fn run(path: &Path, asked: &AnalyzeArgs, look: Look) -> Result<Exit, Failure> {
    let given = asked.points.as_deref().map(points::read).transpose()?.map(Arc::new);
    let study = read(path, asked.how.configuration.as_deref(), asked, given.clone(), look)?;
    let mut files = Files::of(path, &study, asked.work.journal.as_deref()).forced(asked.output.force);
    asked.points.iter().for_each(|points| files.reads(points, "read by --points"));
    let destination = files.output_beside_workbook(&asked.output)?;
    let mut beside =
        Beside::open(&mut files, &study, asked.csv.as_deref(), [asked.html.as_deref(), asked.pdf.as_deref()])?;
    beside.workbook = files.file(asked.xlsx.as_deref())?;
    let header = points::of_model(&study.problem, &[]);
    beside.missing = files.file_of(asked.write_missing.as_deref(), &Content::Points { header: &header })?;
    let show = |report: &Report| destination.write(&printed(report, asked, look));
    analyzed(&study, asked, beside, given.as_deref(), look, show)
}

/// Reads the study with the options of the command line.
pub(crate) fn read(
    path: &Path,
    configuration: Option<&str>,
    asked: &AnalyzeArgs,
    given: Option<Arc<Table>>,
    look: Look,
) -> Result<Study, Failure> {
    let externals = study::configured(externals(asked.work.journal.as_deref(), look, given), configuration);
    let mut study = match is_table(path) {
        true => study::read_table(path, &asked.table, &asked.how, externals, look)?,
        false => {
            if let Some(flag) = asked.table.first_given() {
                return Err(Failure::NoTable { flag, path: path.to_owned() });
            }
            study::read_file(path, &asked.how, externals)?
        }
    };
    study.options.seed = asked.seed.or(study.options.seed);
    // A file of answers covers the planned points only, so check points are off.
    let answers = asked.points.as_ref().map(|_| 0);
    study.options.verify = asked.verify.or(study.options.verify).or(answers);
    study.options.extremes |= asked.extremes;
    study.options.densities |= asked.html.is_some() || asked.pdf.is_some();
    let joint = study.options.target_joint_yield.is_some();
    if asked.check && !joint && study.problem.characteristics().iter().all(|one| one.requirements().is_empty()) {
        return Err(Failure::NothingToCheck);
    }
    Ok(study)
}

/// Files of a report besides the printed text.
pub(crate) struct Beside {
    folder: Option<CsvFolder>,
    page: PageFiles,
    pub(crate) workbook: Option<Destination>,
    missing: Option<Destination>,
}

impl Beside {
    /// Opens the CSV files in a folder, the page and its print, before the analysis.
    pub(crate) fn open(
        files: &mut Files,
        study: &Study,
        csv: Option<&Path>,
        [html, pdf]: [Option<&Path>; 2],
    ) -> Result<Self, Failure> {
        let names = csv_file_names(study.problem.characteristics().iter().map(Characteristic::name));
        let folder = files.folder(csv, &names)?;
        Ok(Self { folder, page: PageFiles::open(files, html, pdf)?, workbook: None, missing: None })
    }
}

pub(crate) fn printed(report: &Report, asked: &AnalyzeArgs, look: Look) -> String {
    let budgets = || budget_document(&report.budgets());
    match asked.gum {
        Some(StackArg::Text) => return text(&budgets(), look.style(&asked.output)),
        Some(StackArg::Csv) => return budget_csv_of_studies(&[(String::new(), report.budgets())]),
        Some(StackArg::Markdown) => return markdown(&budgets()),
        None => {}
    }
    if asked.brief {
        return report.brief(look.style(&asked.output));
    }
    match asked.stack {
        None if asked.output.json && look.verbose => json(report),
        None if asked.output.json => json(&report.clone().shortened()),
        None => {
            let style = look.style(&asked.output);
            let detail = if asked.summary { Detail::Summary } else { style.detail };
            let document = if detail == Detail::Full { report.document() } else { report.brief_document() };
            let report_text = text(&document, Style { detail, ..style });
            if detail == Detail::Summary { report_text } else { report_text + &report.closing(style) }
        }
        Some(StackArg::Text) => text(&stack_document(&report.stacks()), look.style(&asked.output)),
        Some(StackArg::Csv) => stack_csv(&report.stacks()),
        Some(StackArg::Markdown) => markdown(&stack_document(&report.stacks())),
    }
}

/// Analyses a study, shows the report, writes its files, and prints its warnings.
pub(crate) fn analyzed(
    study: &Study,
    asked: &AnalyzeArgs,
    files: Beside,
    given: Option<&Table>,
    look: Look,
    show: impl FnOnce(&Report) -> Result<(), Failure>,
) -> Result<Exit, Failure> {
    let clock = Clock::start(asked.work.time)?;
    let analysis = analyze(study, asked.threads, &clock, look)?;
    let about = clock.about(study);
    let mut report = Report::keeping(&study.problem, analysis, about);
    // Every form of the report has the warning of a strict check, which therefore comes before all of them.
    let conditional = if asked.strict && verdict(&report.analysis, asked) == Exit::Done {
        conditional(&report.analysis)
    } else {
        Vec::new()
    };
    let is_conditional = !conditional.is_empty();
    if is_conditional {
        report.warnings.push(WarningReport::of(&Warning::ConditionalVerdict { characteristics: conditional }));
    }
    // Only a page shows them.
    let report = if files.page.is_asked() { report.with_deviations(study, &Run::to_the_end())? } else { report };
    let analysis = &report.analysis;
    let written = show(&report);
    let written = written.and(files.folder.map_or(Ok(()), |folder| folder.write(&csv_files(&report))));
    let page = || {
        let what_if = WhatIf::of(&study.problem, analysis, &study.lines, &study.costs);
        analyze_html(&report, Some(&what_if))
    };
    let written = written.and(files.page.write(page));
    let written = written.and(files.workbook.map_or(Ok(()), |workbook| {
        let bytes = analyze_xlsx(&report).map_err(|error| Failure::Workbook { reason: error.to_string() })?;
        workbook.write_bytes(&bytes)
    }));
    let points = given.map(Table::missing).unwrap_or_default();
    let written =
        written.and(files.missing.map_or(Ok(()), |missing| missing.write(&points::of_model(&study.problem, &points))));
    look.tell_all(&report.warnings);
    if let Some(given) = given {
        unmatched(given, asked.write_missing.as_deref(), look);
    }
    clock.stopped(&analysis.run, (analysis.run.evaluations, None), Counted::Evaluations, look);
    written?;
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    let complete = analysis.characteristics.iter().all(|characteristic| characteristic.moments.is_some());
    if !complete {
        return Ok(Exit::NoResult);
    }
    Ok(if is_conditional { Exit::NoResult } else { confirmed(verdict(analysis, asked), &analysis.run) })
}

/// Exit code of the requirements, if they are checked.
fn verdict(analysis: &Analysis, asked: &AnalyzeArgs) -> Exit {
    let unfinished = analysis.characteristics.iter().any(|one| one.missing.unfinished);
    let judged = analysis.characteristics.iter().flat_map(CharacteristicAnalysis::requirements);
    let judged = judged.chain(analysis.joint_requirement);
    if asked.check { checked(unfinished, judged) } else { Exit::Done }
}

/// Names of the characteristics with a requirement that rests on the surface only, those of a joint yield included.
fn conditional(analysis: &Analysis) -> Vec<String> {
    let by_surface = |basis: Option<FigureBasis>| basis == Some(FigureBasis::Surface);
    let joint = analysis.joint_requirement.is_some();
    let conditional = |one: &&CharacteristicAnalysis| {
        one.requirements().into_iter().any(|judged| by_surface(one.basis_of(judged.requirement)))
            || joint && by_surface(one.bases().yield_)
    };
    analysis.characteristics.iter().filter(conditional).map(|one| one.characteristic.name().to_owned()).collect()
}

/// Warns of points without an answer, and of answers to points that the plan does not contain.
fn unmatched(given: &Table, written: Option<&Path>, look: Look) {
    let count = given.missing().len();
    if count > 0 {
        look.warn(&Warning::MissingPoints { count, written: written.map(|path| path.display().to_string()) });
    }
    let unused = given.unused();
    if !unused.is_empty() {
        let lines = unused.iter().take(10).map(|row| row + 2).collect();
        look.warn(&Warning::UnmatchedPoints { count: unused.len(), lines });
    }
}

/// Runs the analysis with a progress bar for costly models.
pub(crate) fn analyze(study: &Study, threads: Option<u16>, clock: &Clock, look: Look) -> Result<Analysis, Failure> {
    let stop = || clock.stop();
    let costly = study.problem.function().signature().costly;
    let narrow = ReducedInputs::of(&study.problem, &study.options);
    let problem = narrow.as_ref().map_or(&study.problem, |narrow| &narrow.problem);
    let plan = costly.then(|| study.options.method.procedure().plan(problem, &study.options)).transpose()?;
    let bar = plan.map(|plan| Bar::new(plan.cost().0, look.quiet));
    let show = |more: Progress| bar.iter().for_each(|bar| bar.show(more));
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned).showing(&show);
    let analysis = || analyze_with(&study.problem, &study.options, &run);
    let result = on_threads(threads, analysis);
    if let Some(bar) = bar {
        bar.clear();
    }
    kept(&study.problem)?;
    Ok(result??)
}
