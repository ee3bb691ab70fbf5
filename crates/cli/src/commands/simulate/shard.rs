//! `sensitol simulate --shard` and `sensitol merge`: a sample that several processes share.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::args::{MergeArgs, SimulateArgs};
use crate::commands::simulate::{Reported, judges, options, report};
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::Look;
use crate::own_file::Content;
use crate::running::{Clock, kept};
use crate::sampling::sampling;
use crate::{interrupt, study};
use sensitol::simulation::{Shard, ShardError, ShardSums, SimulationOptions, merge_shards, simulate_shard};
use sensitol::summary::RunSummary;
use sensitol::warning::Counted;

/// First line of the file of a shard, by which it is known.
const FIRST_LINE: &str = r#"{"format":"sensitol-shard-1","#;

/// Sums of a shard, with the study that they belong to.
#[derive(Serialize, Deserialize)]
struct ShardFile {
    /// SHA-256 of the study and its data files.
    study_sha256: String,
    /// Configuration of the study.
    configuration: Option<String>,
    sums: ShardSums,
}

/// Evaluates one shard and writes its sums.
pub(crate) fn run(asked: &SimulateArgs, shard: Shard, look: Look) -> Result<Exit, Failure> {
    let study = study::read_sampled(&asked.of, look)?;
    let mut files =
        Files::of(&asked.of.study, &study, asked.of.work.journal.as_deref()).forced(asked.report.output.force);
    let destination = files.output_of(&asked.report.output, &Content::Points { header: FIRST_LINE })?;
    let options = options(asked, &study);
    let clock = Clock::start(asked.of.work.time)?;
    let sums = sampling(asked.of.threads, &clock, look, |run, pace| {
        simulate_shard(&study.problem, &options, shard, run, pace)
    })?;
    kept(&study.problem)?;
    let sums = match sums {
        Err(ShardError::Stopped { answered, points, reason }) => {
            let run = RunSummary { stopped: Some(reason), ..RunSummary::default() };
            clock.stopped(&run, (answered, Some(points)), Counted::Points, look);
            return Ok(if interrupt::stopped() { Exit::Interrupted } else { Exit::NoResult });
        }
        sums => sums?,
    };
    let (sha256, configuration) = (study.sha256.clone(), asked.of.configuration.clone());
    let file = ShardFile { study_sha256: sha256, configuration, sums };
    let text = serde_json::to_string(&file).map_err(|error| Failure::Table { reason: error.to_string() })?;
    // The first line stands alone, so that the file is recognised by it.
    destination.write(&format!("{FIRST_LINE}\n{}\n", &text[1..]))?;
    Ok(Exit::Done)
}

/// Merges the sums of all shards to the report of one run.
pub(crate) fn merge(asked: &MergeArgs, look: Look) -> Result<Exit, Failure> {
    let study = study::read_sampled(&asked.of, look)?;
    if asked.report.check && !judges(&study) {
        return Err(Failure::NothingToCheck);
    }
    let mut files = Files::of(&asked.of.study, &study, None).forced(asked.report.output.force);
    let mut sums = Vec::with_capacity(asked.shards.len());
    for path in &asked.shards {
        files.reads(path, "the sums of a shard");
        let file = read(path)?;
        let other = |what: &str| Failure::Shard { path: path.clone(), reason: format!("it is of another {what}") };
        if file.study_sha256 != study.sha256 {
            return Err(other("study: the study or its data files were changed since"));
        }
        if file.configuration != asked.of.configuration {
            return Err(other("configuration of the study"));
        }
        if let Some(seed) = asked.of.seed.filter(|&seed| seed != file.sums.seed) {
            let reason = format!("its points have the seed {}, not {seed}: leave --seed out", file.sums.seed);
            return Err(Failure::Shard { path: path.clone(), reason });
        }
        sums.push(file.sums);
    }
    let reported = Reported::open(&mut files, &asked.report, false)?;
    let mut options = SimulationOptions::default();
    options.target_joint_yield = study.options.target_joint_yield;
    let clock = Clock::start(asked.of.work.time)?;
    let merged = sampling(asked.of.threads, &clock, look, |run, _| merge_shards(&study.problem, &options, &sums, run))?;
    report(&study, &merged?, reported, &clock, look)
}

/// Reads the file of a shard.
fn read(path: &Path) -> Result<ShardFile, Failure> {
    let fault = |reason: String| Failure::Shard { path: path.to_owned(), reason };
    let text = std::fs::read_to_string(path).map_err(|error| fault(error.to_string()))?;
    let Some(rest) = text.strip_prefix(FIRST_LINE) else {
        return Err(fault("it is no file of `sensitol simulate --shard`".to_owned()));
    };
    serde_json::from_str(&format!("{{{}", rest.trim_start()))
        .map_err(|error| fault(format!("it is not complete or was changed ({error}): evaluate this shard again")))
}
