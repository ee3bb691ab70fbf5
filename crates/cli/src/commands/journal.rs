//! `sensitol journal`: the kept answers of external models.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use schemars::JsonSchema;
use serde::Serialize;

use crate::args::shared_args::OutputArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output;
use crate::output::{Destination, Look, json};
use crate::own_file::Content;
use sensitol_external::journal::{KnownModel, Store, StoredAnswer};
use sensitol_report::document::csv::guarded;
use sensitol_report::document::number::UNKNOWN;
use sensitol_report::document::terminal::text;
use sensitol_report::document::{Blocks, Document};

/// The report of `journal show --json` on one model.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "JournalReport")]
pub(crate) struct ModelReport {
    id: i64,
    since: String,
    points: usize,
    values: usize,
    errors: usize,
    /// Points whose run ended before their check. The next run checks them before it uses them.
    unconfirmed: usize,
    /// Answers whose checksum does not agree. They count as unknown.
    damaged: usize,
    /// True if answers were found to depend on the points before them, so that each is replayed.
    flips: bool,
    dimensions: Vec<String>,
    identity: serde_json::Value,
}

#[derive(Debug, Args)]
#[command(subcommand_required = true)]
pub(crate) struct JournalArgs {
    #[command(subcommand)]
    pub(crate) command: JournalCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum JournalCommand {
    /// The models in a journal, with how much is known of each
    #[command(after_help = "Examples:\n  sensitol journal show gap.journal.sqlite")]
    Show {
        /// The journal
        file: PathBuf,
        #[command(flatten)]
        output: OutputArgs,
    },
    /// Every answer of a model as CSV: dimensions, outputs, reasons for no value
    #[command(after_help = "Examples:\n  sensitol journal export gap.journal.sqlite --model 2 -o answers.csv")]
    Export {
        /// The journal
        file: PathBuf,
        /// Number of the model, if the journal has several
        #[arg(long, value_name = "N")]
        model: Option<i64>,
        #[command(flatten)]
        output: OutputArgs,
    },
    /// Forgets the answers of a model, after --yes or a question on the terminal
    #[command(after_help = "Examples:\n  sensitol journal forget gap.journal.sqlite --model 2")]
    Forget {
        /// The journal
        file: PathBuf,
        /// Number of the model, if the journal has several
        #[arg(long, value_name = "N", conflicts_with = "all")]
        model: Option<i64>,
        /// Forget every model
        #[arg(long)]
        all: bool,
        /// Forget without a question
        #[arg(short, long)]
        yes: bool,
    },
}

pub(crate) fn run(asked: &JournalArgs, look: Look) -> Result<Exit, Failure> {
    match &asked.command {
        JournalCommand::Show { file, output } => {
            let models = Store::open_existing(file)?.models()?;
            let reports: Vec<ModelReport> = models.into_iter().map(ModelReport::of).collect();
            let mut document = Document::default();
            reports.iter().for_each(|report| report.put(&mut document));
            let shown = || text(&document, look.style(output));
            print(file, output, &Content::Report, &if output.json { json(&reports) } else { shown() })
        }
        JournalCommand::Export { file, model, output } => {
            let store = Store::open_existing(file)?;
            let model = chosen(&store, *model)?;
            let mut answers = store.answers(model.id)?;
            // Sorted by value, not by bytes.
            let order = |kept: &StoredAnswer| kept.point.clone();
            answers.sort_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal));
            let table = table(&model, &answers)?;
            let header = table.lines().next().unwrap_or_default();
            print(file, output, &Content::Points { header }, &table)
        }
        JournalCommand::Forget { file, model, all, yes } => {
            let mut store = Store::open_existing(file)?;
            let models = if *all { store.models()? } else { vec![chosen(&store, *model)?] };
            let answers: usize = models.iter().map(|model| model.values + model.errors).sum();
            if !yes && !agreed(answers)? {
                return Ok(Exit::Usage);
            }
            let id = if *all { None } else { models.first().map(|model| model.id) };
            let forgotten = store.forget(id)?;
            if !look.quiet {
                Destination::Stdout.write(&format!("{forgotten} answers forgotten\n"))?;
            }
            Ok(Exit::Done)
        }
    }
}

fn print(journal: &Path, output: &OutputArgs, content: &Content<'_>, text: &str) -> Result<Exit, Failure> {
    let mut files = Files::default().forced(output.force);
    files.reads(journal, "the journal itself");
    files.output_of(output, content)?.write(text)?;
    Ok(Exit::Done)
}

/// Asks at the terminal before answers are deleted. Returns true if the user agrees.
fn agreed(answers: usize) -> Result<bool, Failure> {
    let (mut said, stdin) = (String::new(), std::io::stdin());
    if !stdin.is_terminal() || !std::io::stderr().is_terminal() {
        return Err(Failure::NotAgreed { answers });
    }
    output::prompt(&format!("forget {answers} answers, each of which was evaluated? [y/N] "));
    stdin.read_line(&mut said).map_err(|_| Failure::NotAgreed { answers })?;
    Ok(["y", "yes"].contains(&said.trim().to_lowercase().as_str()))
}

/// Returns the model with this number. Without a number, the journal must hold a single model.
fn chosen(store: &Store, number: Option<i64>) -> Result<KnownModel, Failure> {
    let mut models = store.models()?;
    match number {
        Some(number) => {
            let known: Vec<String> = models.iter().map(|model| model.id.to_string()).collect();
            let found = models.into_iter().find(|model| model.id == number);
            found.ok_or(Failure::UnknownJournalModel { number: Some(number), known: known.join(", ") })
        }
        None if models.len() == 1 => Ok(models.remove(0)),
        None => {
            let known: Vec<String> = models.iter().map(|model| model.id.to_string()).collect();
            Err(Failure::UnknownJournalModel { number: None, known: known.join(", ") })
        }
    }
}

/// Writes a row for each point: its dimensions, then the values of all outputs, then the errors of all outputs.
fn table(model: &KnownModel, answers: &[StoredAnswer]) -> Result<String, Failure> {
    let mut outputs: Vec<&str> = answers.iter().map(|kept| kept.output.as_str()).collect();
    outputs.sort_unstable();
    outputs.dedup();
    let bits = |point: &[f64]| point.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    let mut order: Vec<&[f64]> = Vec::new();
    let mut rows: BTreeMap<Vec<u64>, BTreeMap<&str, &StoredAnswer>> = BTreeMap::new();
    for kept in answers {
        let row = rows.entry(bits(&kept.point)).or_insert_with(|| {
            order.push(&kept.point);
            BTreeMap::new()
        });
        row.insert(&kept.output, kept);
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    let errors: Vec<String> = outputs.iter().map(|output| format!("{output} error")).collect();
    let header = model.dimensions.iter().map(String::as_str).chain(outputs.iter().copied());
    let written = writer.write_record(header.chain(errors.iter().map(String::as_str)).map(guarded));
    written
        .and_then(|()| {
            for point in order {
                let row = &rows[&bits(point)];
                let answer = |output: &&str| row.get(output).map(|kept| &kept.answer);
                let value = |output: &&str| {
                    answer(output).and_then(|answer| answer.as_ref().ok()).map_or(String::new(), f64::to_string)
                };
                let error = |output: &&str| {
                    answer(output)
                        .and_then(|answer| answer.as_ref().err())
                        .map_or(String::new(), |error| guarded(error))
                };
                let cells =
                    point.iter().map(f64::to_string).chain(outputs.iter().map(value)).chain(outputs.iter().map(error));
                writer.write_record(cells)?;
            }
            Ok(())
        })
        .map_err(|error| Failure::Table { reason: error.to_string() })?;
    let bytes = writer.into_inner().map_err(|error| Failure::Table { reason: error.to_string() })?;
    Ok(String::from_utf8(bytes).expect("names and numbers are UTF-8"))
}

impl ModelReport {
    fn of(model: KnownModel) -> Self {
        let identity = serde_json::from_str(&model.identity).unwrap_or(serde_json::Value::Null);
        let KnownModel { id, since, points, values, errors, unconfirmed, damaged, flips, dimensions, .. } = model;
        Self { id, since, points, values, errors, unconfirmed, damaged, flips, dimensions, identity }
    }

    /// Appends the model to the document.
    fn put(&self, document: &mut Document) {
        let word = |key: &str| match &self.identity[key] {
            serde_json::Value::String(text) => text.clone(),
            serde_json::Value::Array(words) => {
                words.iter().filter_map(|word| word.as_str()).collect::<Vec<_>>().join(" ")
            }
            _ => UNKNOWN.to_owned(),
        };
        let Self { id, points, values, errors, since, .. } = self;
        document.line(format!("model {id}: {}", word("command")));
        document.note(format!("adapter {}, version {}", word("adapter"), word("version")));
        document.note(format!("{points} points, {values} values, {errors} without a value; since {since} UTC"));
        if self.unconfirmed > 0 {
            document.note(format!(
                "{} points lack their check: the next run checks them before it uses them",
                self.unconfirmed
            ));
        }
        if self.flips {
            document.note("answers depend on the points evaluated before: every one is replayed by a fresh process");
        }
        if self.damaged > 0 {
            document
                .note(format!("{} answers are damaged: they are evaluated again when a run needs them", self.damaged));
        }
        document.note(format!("dimensions: {}", self.dimensions.join(", ")));
    }
}
