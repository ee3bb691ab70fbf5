//! `sensitol simulate`.

use crate::args::{SamplerArg, SimulateArgs};
use crate::commands::rare;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::running::{Clock, checked, confirmed, kept};
use crate::sampling::{sampling, surrogate};
use crate::{interrupt, study};
use sensitol::method::Options;
use sensitol::simulation::{SimulatedCharacteristic, Simulation, SimulationOptions, simulate_with};
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
    let study = study::read_sampled(&asked.of, look)?;
    let joint = study.options.target_joint_yield.is_some();
    if asked.check && !joint && study.problem.characteristics().iter().all(|one| one.requirements().is_empty()) {
        return Err(Failure::NothingToCheck);
    }
    if asked.rare {
        return rare::run(asked, &study, look);
    }
    let mut files = Files::of(&asked.of.study, &study, asked.of.work.journal.as_deref()).forced(asked.output.force);
    let destination = files.output(&asked.output)?;
    let tables = if asked.sobol { &TABLES[..] } else { &TABLES[..2] };
    let names: Vec<String> = tables.iter().map(|name| format!("{name}.csv")).collect();
    let folder = files.folder(asked.csv.as_deref(), &names)?;
    let page = files.file(asked.html.as_deref())?;
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
    options.control = asked.surrogate_control.then(|| surrogate(&study, asked));
    options.target_joint_yield = study.options.target_joint_yield;
    options.sobol = asked.sobol.then(|| asked.samples.unwrap_or(SOBOL));
    options.budget = asked.budget;
    let clock = Clock::start(asked.of.work.time);
    let simulation = simulate(&study, asked.of.threads, &options, &clock, look);
    kept(&study.problem)?;
    let simulation = simulation?;
    let about = clock.about(&study);
    let report = SimulationReport::of(&study.problem, &simulation, about);
    let document = report.document();
    let written =
        destination.write(&if asked.output.json { json(&report) } else { text(&document, look.style(&asked.output)) });
    let written = written.and(folder.map_or(Ok(()), |folder| folder.write(&csv_tables(&document, tables))));
    let written = written.and(page.map_or(Ok(()), |page| page.write(&simulate_html(&report))));
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
    let exit = if asked.check { checked(simulation.run.unfinished(), judged) } else { Exit::Done };
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
