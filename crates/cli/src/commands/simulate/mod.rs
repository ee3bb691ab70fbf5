//! `sensitol simulate`.

pub(crate) mod shard;

use crate::args::{SampleReportArgs, SamplerArg, SimulateArgs};
use crate::commands::rare;
use crate::csv::CsvFolder;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Destination, Look, json};
use crate::page_files::PageFiles;
use crate::running::{Clock, checked, confirmed, kept};
use crate::sampling::{sampling, surrogate};
use crate::{interrupt, study};
use sensitol::method::Options;
use sensitol::simulation::{Shard, SimulatedCharacteristic, Simulation, SimulationOptions, simulate_with};
use sensitol::warning::{Counted, Warning};
use sensitol_numeric::sampling::Sampler;
use sensitol_report::document::terminal::text;
use sensitol_report::html::simulate_html;
use sensitol_report::{SimulationReport, csv_tables};
use sensitol_study::Study;

/// Default number of points. With a target error there is no such limit.
const SAMPLES: u64 = 100_000;

/// Default number of base points for Sobol' indices.
const SOBOL: u64 = 1 << 14;

/// Tables of a simulation, a CSV file each. The last one exists with Sobol' indices only.
const TABLES: [&str; 3] = ["estimates", "histogram", "sobol"];

pub(crate) fn run(asked: &SimulateArgs, look: Look) -> Result<Exit, Failure> {
    if let Some((number, count)) = asked.shard.zip(asked.shards) {
        return shard::run(asked, Shard::new(number, count)?, look);
    }
    let study = study::read_sampled(&asked.of, look)?;
    if asked.report.check && !judges(&study) {
        return Err(Failure::NothingToCheck);
    }
    if asked.rare {
        return rare::run(asked, &study, look);
    }
    let mut files =
        Files::of(&asked.of.study, &study, asked.of.work.journal.as_deref()).forced(asked.report.output.force);
    let reported = Reported::open(&mut files, &asked.report, asked.sobol)?;
    let options = options(asked, &study);
    let clock = Clock::start(asked.of.work.time)?;
    let simulation = simulate(&study, asked.of.threads, &options, &clock, look);
    kept(&study.problem)?;
    report(&study, &simulation?, reported, &clock, look)
}

/// True if the study has a requirement to judge.
pub(super) fn judges(study: &Study) -> bool {
    let joint = study.options.target_joint_yield.is_some();
    joint || study.problem.characteristics().iter().any(|one| !one.requirements().is_empty())
}

/// Returns the options of a simulation, as the command line and the study give them.
pub(super) fn options(asked: &SimulateArgs, study: &Study) -> SimulationOptions {
    let wanted = asked.until.is_some() || asked.until_yield.is_some();
    let mut options = SimulationOptions::default();
    options.samples = asked.samples.unwrap_or(if wanted { 1 << 52 } else { SAMPLES });
    options.sampler = match asked.sampler {
        SamplerArg::Random => Sampler::Random,
        SamplerArg::Sobol => Sampler::Sobol,
    };
    options.seed = asked.of.seed.or(study.seed).unwrap_or(Options::SEED);
    options.until = asked.until;
    options.until_yield = asked.until_yield;
    options.control = asked.surrogate_control.then(|| surrogate(study, asked));
    options.target_joint_yield = study.options.target_joint_yield;
    options.sobol = asked.sobol.then(|| asked.samples.unwrap_or(SOBOL));
    options.budget = asked.budget;
    options
}

/// Files into which the report of a simulation is written, opened before anything is evaluated.
pub(super) struct Reported<'a> {
    asked: &'a SampleReportArgs,
    destination: Destination,
    folder: Option<CsvFolder>,
    tables: &'static [&'static str],
    page: PageFiles,
}

impl<'a> Reported<'a> {
    /// Opens the files. `indices` adds the table of Sobol' indices.
    pub(super) fn open(files: &mut Files, asked: &'a SampleReportArgs, indices: bool) -> Result<Self, Failure> {
        let destination = files.output(&asked.output)?;
        let tables = if indices { &TABLES[..] } else { &TABLES[..2] };
        let names: Vec<String> = tables.iter().map(|name| format!("{name}.csv")).collect();
        let folder = files.folder(asked.csv.as_deref(), &names)?;
        let page = PageFiles::open(files, asked.html.as_deref(), asked.pdf.as_deref())?;
        Ok(Self { asked, destination, folder, tables, page })
    }
}

/// Writes the report of a simulation, and returns the exit code.
pub(super) fn report(
    study: &Study,
    simulation: &Simulation,
    to: Reported<'_>,
    clock: &Clock,
    look: Look,
) -> Result<Exit, Failure> {
    let report = SimulationReport::of(&study.problem, simulation, clock.about(study));
    let document = report.document();
    let text = if to.asked.output.json { json(&report) } else { text(&document, look.style(&to.asked.output)) };
    let written = to.destination.write(&text);
    let written = written.and(to.folder.map_or(Ok(()), |folder| folder.write(&csv_tables(&document, to.tables))));
    let written = written.and(to.page.write(|| simulate_html(&report)));
    look.tell_all(&report.warnings);
    clock.stopped(&simulation.run, (simulation.samples, None), Counted::Points, look);
    if interrupt::stopped() {
        written?;
        return Ok(Exit::Interrupted);
    }
    if simulation.reached == Some(false) {
        look.warn(&Warning::TargetErrorMissed { points: simulation.samples });
    }
    written?;
    if simulation.characteristics.iter().any(|one| one.samples == 0) {
        return Ok(Exit::NoResult);
    }
    let judged = simulation.characteristics.iter().flat_map(SimulatedCharacteristic::requirements);
    let judged = judged.chain(simulation.joint_requirement);
    let exit = if to.asked.check { checked(simulation.run.unfinished(), judged) } else { Exit::Done };
    Ok(confirmed(exit, &simulation.run))
}

fn simulate(
    study: &Study,
    threads: Option<u16>,
    options: &SimulationOptions,
    clock: &Clock,
    look: Look,
) -> Result<Simulation, Failure> {
    Ok(sampling(threads, clock, look, |run, pace| simulate_with(&study.problem, options, run, pace))??)
}
