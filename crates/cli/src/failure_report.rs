//! Errors as JSON, for programs that call the command.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::advice;
use crate::failure::Failure;
use sensitol_report::SCHEMA;
use sensitol_study::StudyError;

/// An error of a study, of an option or of a file.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(crate) struct ErrorReport {
    /// The kind of error. It stays the same where a message changes.
    code: &'static str,
    /// The error in words.
    message: String,
    /// The file concerned, as it was given.
    file: Option<String>,
    /// Line of the fault in the file, from 1.
    line: Option<usize>,
    /// Column of the fault in characters, from 1.
    column: Option<usize>,
    /// Full name of the key at fault, such as `dimensions.a.tolerance`.
    key: Option<String>,
    /// The text to write instead, or the actions to take, the most promising first.
    advice: Vec<String>,
}

impl ErrorReport {
    /// Every error of a failure. A closed pipe is none.
    pub(crate) fn all(failure: &Failure) -> Vec<Self> {
        match failure {
            Failure::ClosedPipe => Vec::new(),
            Failure::Study(error) => std::iter::once(error).chain(&error.more).map(Self::of_study).collect(),
            other => vec![Self {
                code: other.code(),
                message: other.to_string(),
                file: other.path().map(|path| path.display().to_string()),
                line: None,
                column: None,
                key: None,
                advice: other.help().into_iter().collect(),
            }],
        }
    }

    /// Error of the command line, in the words of its parser.
    pub(crate) fn of_usage(error: &clap::Error) -> Self {
        let text = error.render().to_string();
        let mut blocks = text.split("\n\n").map(str::trim);
        let message = blocks.next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        // The usage and the hint on --help belong to a person at a terminal.
        let advice = blocks.filter_map(|block| block.strip_prefix("tip: ")).map(str::to_owned).collect();
        Self { code: "command-line", message, file: None, line: None, column: None, key: None, advice }
    }

    fn of_study(error: &StudyError) -> Self {
        let place = error.line_column();
        let help = error.help().into_iter();
        Self {
            code: error.fault.code(),
            message: error.message(),
            file: Some(error.file.clone()),
            line: place.map(|(line, _)| line),
            column: place.map(|(_, column)| column),
            key: (!error.key.is_empty()).then(|| error.place_name()),
            advice: help.chain(error.fault.advice().iter().map(advice::words)).collect(),
        }
    }
}

/// The output of a command with `--json` that ends with an error.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ErrorDocument {
    /// The version of this shape.
    schema: u32,
    /// The version of the program.
    sensitol: &'static str,
    /// The command; null where the command line names none.
    command: Option<String>,
    /// The errors. Those of a study are in the order of its file.
    errors: Vec<ErrorReport>,
}

impl ErrorDocument {
    pub(crate) fn of(command: Option<String>, errors: Vec<ErrorReport>) -> Self {
        Self { schema: SCHEMA, sensitol: env!("CARGO_PKG_VERSION"), command, errors }
    }
}

impl Failure {
    /// Stable code of the kind of error, in lower case with hyphens.
    fn code(&self) -> &'static str {
        match self {
            Self::Study(error) => error.fault.code(),
            Self::Problem(_) => "problem",
            Self::Method(_) => "method",
            Self::Simulation(_) => "simulation",
            Self::Sharding(_) | Self::Shard { .. } => "shard",
            Self::Lot(_) => "lot",
            Self::Rare(_) => "rare-events",
            Self::Compare(_) => "comparison",
            Self::Sweep(_) => "sweep",
            Self::Allocate(_) => "allocation",
            Self::Rewrite(_) => "rewrite",
            Self::Pearson(_) => "pearson",
            Self::Journal(_) => "journal",
            Self::UnknownJournalModel { .. } => "unknown-journal-model",
            Self::NotAgreed { .. } => "not-confirmed",
            Self::Points { .. } => "points",
            Self::Import { .. } => "import",
            Self::Table { .. } => "table",
            Self::Workbook { .. } => "workbook",
            Self::NothingToCheck => "nothing-to-check",
            Self::Pairs { .. } => "pairs",
            Self::UnknownName(_) => "unknown-name",
            Self::UnknownDimension { .. } => "unknown-dimension",
            Self::UnknownExample { .. } => "unknown-example",
            Self::NoExamples => "no-examples",
            Self::Unwritable { .. } | Self::Stdout(_) => "unwritable",
            Self::NoPage { .. } => "no-page",
            Self::NoBrowser { .. } => "no-browser",
            Self::NotPrinted { .. } => "not-printed",
            Self::WrongDate { .. } => "wrong-date",
            Self::WrongPage { .. } | Self::OldPage => "wrong-page",
            Self::NotInPage { .. } => "not-in-page",
            Self::NotAFolder { .. } => "not-a-folder",
            Self::NotServed { .. } | Self::NoLongerServed { .. } => "not-served",
            Self::Exists { .. } | Self::Foreign { .. } | Self::WouldBeLost { .. } | Self::AskedTwice { .. } => {
                "would-overwrite"
            }
            Self::AnotherFolder { .. } => "another-folder",
            Self::OtherKind { .. }
            | Self::NoTable { .. }
            | Self::GumFormat { .. }
            | Self::NotTwo { .. }
            | Self::NoFolder { .. }
            | Self::NoFolderOfPages { .. }
            | Self::SameName { .. }
            | Self::PointsOfOne { .. } => "command-line",
            Self::Threads { .. } => "threads",
            Self::NotKept { .. } => "not-kept",
            Self::FailsEverywhere { .. } => "model-fails",
            Self::ClosedPipe => "closed-pipe",
        }
    }

    /// Returns the file or folder concerned.
    fn path(&self) -> Option<&Path> {
        match self {
            Self::Points { path, .. }
            | Self::Import { path, .. }
            | Self::Shard { path, .. }
            | Self::OtherKind { path, .. }
            | Self::NoTable { path, .. }
            | Self::Unwritable { path, .. }
            | Self::WrongPage { path, .. }
            | Self::NotAFolder { path, .. }
            | Self::NotInPage { path, .. }
            | Self::Exists { path }
            | Self::Foreign { path }
            | Self::WouldBeLost { path, .. }
            | Self::AnotherFolder { path, .. }
            | Self::AskedTwice { path }
            | Self::NoFolder { path }
            | Self::NoFolderOfPages { path, .. } => Some(path),
            _ => None,
        }
    }
}
