//! `sensitol compare-lot`.

use std::path::Path;

use crate::args::CompareLotArgs;
use crate::commands::allocate::stays_beside;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::own_file::Content;
use crate::page_files::PageFiles;
use crate::running::{Clock, confirmed, externals, kept, on_threads};
use crate::table::{bytes, failed, text as text_of};
use crate::{interrupt, study};
use sensitol::assembly::Run;
use sensitol::lot::{LotComparison, LotOptions, LotTable, LotVerdict, compare_lot};
use sensitol::warning::Counted;
use sensitol_numeric::correlation::Pair;
use sensitol_report::document::terminal::text;
use sensitol_report::html::lot_html;
use sensitol_report::{LotReport, csv_tables};
use sensitol_study::import::{Sheet, is_workbook, workbook};
use sensitol_study::{Study, UpdatedSpread, UpdatedStudy, read_lot};

/// Tables of the report, a CSV file each.
const TABLES: [&str; 4] = ["parts", "assemblies", "differences", "groups"];

pub(crate) fn run(asked: &CompareLotArgs, look: Look) -> Result<Exit, Failure> {
    let study = study::read(&asked.study, externals(asked.work.journal.as_deref(), look, None))?;
    let mut files = Files::of(&asked.study.study, &study, asked.work.journal.as_deref()).forced(asked.output.force);
    asked.lot.iter().for_each(|path| files.reads(path, "a table of the lot"));
    let destination = files.output(&asked.output)?;
    let folder = files.folder(asked.csv.as_deref(), &TABLES.map(|name| format!("{name}.csv")))?;
    let page = PageFiles::open(&mut files, asked.html.as_deref(), asked.pdf.as_deref())?;
    asked.update.as_deref().map_or(Ok(()), |path| stays_beside(path, &asked.study.study, &study))?;
    let written = files.file_of(asked.update.as_deref(), &Content::Study)?;
    let tables = asked.lot.iter().map(|path| table(path, &study, look)).collect::<Result<Vec<_>, _>>()?;
    let mut options = LotOptions::default();
    options.level = asked.level.unwrap_or(options.level);
    options.assumed_parts = asked.assumed_parts.map_or(options.assumed_parts, |parts| parts as f64);
    let clock = Clock::start(asked.work.time)?;
    let stop = || clock.stop();
    let run = Run::to_the_end().stopping_when(&stop).abandoning_when(&interrupt::abandoned);
    let compared = on_threads(asked.threads, || compare_lot(&study.problem, &tables, &options, &study.options, &run));
    kept(&study.problem)?;
    let comparison = compared??;
    let names = asked.lot.iter().map(|path| path.display().to_string()).collect();
    let report = LotReport::of(&comparison, names, clock.about(&study));
    let document = report.document();
    let done =
        destination.write(&if asked.output.json { json(&report) } else { text(&document, look.style(&asked.output)) });
    let done = done.and(folder.map_or(Ok(()), |folder| folder.write(&csv_tables(&document, &TABLES))));
    let done = done.and(page.write(|| lot_html(&report)));
    look.warn_all(&study.warnings);
    clock.stopped(&comparison.run, (comparison.run.evaluations, None), Counted::Evaluations, look);
    done?;
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    if let Some(written) = written {
        let UpdatedStudy { text, made_normal, kept_correlations, .. } = updated(&study, &comparison)?;
        written.write(&text)?;
        let mut notes: Vec<String> =
            made_normal.iter().map(|name| format!("`{name}` is normal in the new study")).collect();
        notes.extend(kept_correlations.iter().map(kept_correlation));
        look.note("the study is updated", &notes);
    }
    let nothing = comparison.characteristics.iter().any(|one| one.assumed.is_none());
    let missed = asked.check && refuted(&comparison);
    let exit = match (nothing, missed) {
        (true, _) => Exit::NoResult,
        (_, true) => Exit::Missed,
        _ => Exit::Done,
    };
    Ok(confirmed(exit, &comparison.run))
}

/// Reads one table of the lot.
fn table(path: &Path, study: &Study, look: Look) -> Result<LotTable, Failure> {
    let bytes = bytes(path)?;
    let sheet = match is_workbook(&bytes) {
        true => {
            let found = workbook(bytes, None, |sheet| read_lot(sheet, study).is_ok());
            found.map_err(|fault| failed(path, fault.to_string(), fault.help()))?.1
        }
        false => Sheet::of_text(&text_of(path, bytes)?),
    };
    let mut read = read_lot(&sheet, study).map_err(|fault| failed(path, fault.to_string(), fault.help()))?;
    read.table.name = path.display().to_string();
    if !read.notes.is_empty() {
        look.note(&path.display().to_string(), &read.notes);
    }
    Ok(read.table)
}

/// Study with the posterior of every measured dimension, and the correlations that the lot shows.
fn updated(study: &Study, comparison: &LotComparison) -> Result<UpdatedStudy, Failure> {
    let spreads = comparison.dimensions.iter().filter_map(|one| {
        let posterior = one.posterior?;
        let (mean, sigma) = (posterior.mean.value, posterior.sigma.value);
        Some(UpdatedSpread { dimension: one.name.clone(), mean, sigma })
    });
    let level = comparison.family_wise_level;
    let refuted = comparison.correlations.iter().filter(|pair| pair.departs(level));
    let pairs: Vec<Pair> =
        refuted.map(|pair| Pair { between: pair.between.clone(), value: pair.value.value }).collect();
    Ok(study.updated(&spreads.collect::<Vec<_>>(), &pairs)?)
}

/// Note on a correlation that the new study cannot take over.
fn kept_correlation(pair: &Pair) -> String {
    let [a, b] = &pair.between;
    format!(
        "the correlation of `{a}` and `{b}` stays as assumed, since it has no entry of its own: the lot shows {:.4}",
        pair.value
    )
}

/// True if a dimension or a correlation departs from its assumption, or assemblies from the study.
fn refuted(comparison: &LotComparison) -> bool {
    let level = comparison.family_wise_level;
    let agrees = |verdict: &LotVerdict| matches!(verdict, LotVerdict::AsAssumed | LotVerdict::NotMeasured);
    comparison.dimensions.iter().any(|one| one.departs(level))
        || comparison.correlations.iter().any(|pair| pair.departs(level))
        || comparison.characteristics.iter().any(|one| !agrees(&one.verdict))
}
