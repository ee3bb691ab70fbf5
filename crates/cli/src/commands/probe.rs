//! `sensitol probe`.

use schemars::JsonSchema;
use serde::Serialize;

use crate::args::ProbeArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::progress::Bar;
use crate::running::listener;
use crate::{interrupt, study};
use sensitol::assembly::{Progress, Run};
use sensitol::method::MethodError;
use sensitol::probe::{Finding, Probe, evaluations, probe};
use sensitol::summary::RunSummary;
use sensitol_report::document::number::{UNKNOWN, known, plural, significant};
use sensitol_report::document::terminal::text;
use sensitol_report::document::{Blocks, Document, Line, Section, Tone};
use sensitol_study::Externals;

/// The report of `probe --json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ProbeReport {
    schema: u32,
    command: &'static str,
    adapter: Option<AdapterReport>,
    #[serde(flatten)]
    run: RunSummary,
    start_s: f64,
    evaluation_alone_s: f64,
    evaluation_together_s: f64,
    passed: bool,
    checks: Vec<CheckReport>,
    characteristics: Vec<CharacteristicReport>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct AdapterReport {
    name: Option<String>,
    version: Option<String>,
    window: usize,
}

#[derive(Debug, Serialize, JsonSchema)]
struct CheckReport {
    check: &'static str,
    /// None if there were no values to check it with.
    passed: Option<bool>,
    verdict: &'static str,
    fault: Option<String>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct CharacteristicReport {
    name: String,
    nominal: Option<f64>,
    noise: Option<f64>,
    steps: Vec<StepReport>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct StepReport {
    dimension: String,
    /// Values in sigmas.
    least_step: Option<f64>,
    reacts: bool,
}

pub(crate) fn run(asked: &ProbeArgs, look: Look) -> Result<Exit, Failure> {
    // Answers from a journal would prove nothing, and sentinels would hide the differences that the probe looks for.
    let externals = Externals { listener: listener(look), ..Externals::default() }.with_sentinels(false);
    let study = study::read(&asked.study, externals)?;
    let mut files = Files::of(&asked.study.study, &study, None).forced(asked.output.force);
    let destination = files.output_text(&asked.output)?;
    interrupt::listen();
    let costly = study.problem.function().signature().costly;
    let bar = costly.then(|| Bar::new(evaluations(&study.problem), look.quiet));
    let show = |more: Progress| bar.iter().for_each(|bar| bar.show(more));
    let within =
        Run::to_the_end().stopping_when(&interrupt::reason).abandoning_when(&interrupt::abandoned).showing(&show);
    let found = probe(&study.problem, &within);
    bar.iter().for_each(Bar::clear);
    let found = found.map_err(|error| MethodError::Model { error })?;
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    let names: Vec<&str> = study.problem.dimensions().iter().map(|dimension| dimension.name()).collect();
    let report = ProbeReport::of(&found, &names);
    destination.write(&match asked.output.json {
        true => json(&report),
        false => text(&report.document(), look.style(&asked.output)),
    })?;
    Ok(if found.passed() { Exit::Done } else { Exit::Missed })
}

impl ProbeReport {
    fn of(found: &Probe, dimensions: &[&str]) -> Self {
        let adapter = found.adapter.clone().map(|adapter| AdapterReport {
            name: adapter.name,
            version: adapter.version,
            window: adapter.window,
        });
        let check = |check: &sensitol::probe::Check| CheckReport {
            check: check.what,
            passed: match check.verdict {
                Finding::Passed | Finding::Doubtful(_) => Some(true),
                Finding::Failed(_) => Some(false),
                Finding::NotChecked => None,
            },
            verdict: match check.verdict {
                Finding::Passed => "ok",
                Finding::Doubtful(_) => "warn",
                Finding::Failed(_) => "fail",
                Finding::NotChecked => "not-checked",
            },
            fault: check.verdict.fault().map(str::to_owned),
        };
        let characteristic = |one: &sensitol::probe::Probed| CharacteristicReport {
            name: one.name.clone(),
            nominal: one.nominal,
            noise: one.noise,
            steps: (dimensions.iter().zip(&one.least_step))
                .map(|(name, &least_step)| StepReport {
                    dimension: (*name).to_owned(),
                    least_step,
                    reacts: !one.silent.iter().any(|silent| silent == name),
                })
                .collect(),
        };
        Self {
            schema: sensitol_report::SCHEMA,
            command: "probe",
            adapter,
            run: found.run,
            start_s: found.start.as_secs_f64(),
            evaluation_alone_s: found.alone.as_secs_f64(),
            evaluation_together_s: found.together.as_secs_f64(),
            passed: found.passed(),
            checks: found.checks.iter().map(check).collect(),
            characteristics: found.characteristics.iter().map(characteristic).collect(),
        }
    }

    /// Builds the text of the probe: speed of the model, result of every check, and safe steps for every characteristic.
    fn document(&self) -> Document {
        let mut document = Document::default();
        if let Some(AdapterReport { name, version, window }) = &self.adapter {
            let word = |word: &Option<String>| word.clone().unwrap_or_else(|| UNKNOWN.to_owned());
            document.line(format!("{}, version {}, window {window}", word(name), word(version)));
        }
        let seconds = |value: f64| format!("{} s", significant(value, 2));
        document.line(format!(
            "ready after {}; {} for a point alone, {} for one of many; {}",
            seconds(self.start_s),
            seconds(self.evaluation_alone_s),
            seconds(self.evaluation_together_s),
            plural(self.run.evaluations as usize, "evaluation", "evaluations"),
        ));
        document.gap();
        self.checks.iter().for_each(|check| document.note(check.line()));
        document.sections = self.characteristics.iter().map(CharacteristicReport::section).collect();
        document
    }
}

impl CheckReport {
    fn line(&self) -> Line {
        let (word, tone) = match self.verdict {
            "ok" => ("ok  ", Tone::Good),
            "warn" => ("WARN", Tone::Doubtful),
            "fail" => ("FAIL", Tone::Bad),
            _ => ("-   ", Tone::Plain),
        };
        let fault = self.fault.as_ref().map(|fault| format!(": {fault}")).unwrap_or_default();
        let unknown = if self.passed.is_none() { ": not checked, as there are no values" } else { "" };
        Line::toned(word, tone).and(format!("  {}{fault}{unknown}", self.check))
    }
}

impl CharacteristicReport {
    fn section(&self) -> Section {
        let none = if self.nominal.is_some() { "none to be seen" } else { UNKNOWN };
        let noise = self.noise.map_or(none.to_owned(), |noise| significant(noise, 2));
        let nominal = known(self.nominal, |value| significant(value, 6));
        let mut section = Section::of(&self.name, None);
        section.words = format!(": nominal {nominal}, noise {noise}");
        let coarse = self.steps.iter().filter_map(|step| step.least_step).fold(0.0, f64::max);
        if coarse > 0.0 {
            section.note(format!("steps of {} sigma and more are safe for every dimension", significant(coarse, 2)));
        }
        let silent: Vec<&str> =
            self.steps.iter().filter(|step| !step.reacts).map(|step| step.dimension.as_str()).collect();
        if !silent.is_empty() {
            section.note(format!("does not react to {}", silent.join(", ")));
        }
        section
    }
}
