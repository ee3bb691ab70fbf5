//! Exit codes and errors of a command.

use std::path::PathBuf;
use std::process::ExitCode;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use crate::advice;
use sensitol::allocation::AllocateError;
use sensitol::assembly::ProcessError;
use sensitol::compare::CompareError;
use sensitol::lot::LotError;
use sensitol::method::MethodError;
use sensitol::problem::ProblemError;
use sensitol::rare::RareError;
use sensitol::simulation::{ShardError, SimulationError};
use sensitol::sweep::SweepError;
use sensitol::warning::Advice;
use sensitol_external::journal::JournalError;
use sensitol_numeric::names::{UnknownName, clipped};
use sensitol_numeric::pearson::PearsonError;
use sensitol_study::{RewriteError, StudyError};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Exit {
    /// Done, possibly with warnings.
    Done = 0,
    /// A target is missed, with `--check`.
    Missed = 1,
    /// The command line or the study is wrong.
    Usage = 2,
    /// The model gave no result for a requested characteristic.
    NoResult = 3,
    /// No tolerances meet the requirements, or they were not found in time.
    NotAllocated = 4,
    /// Interrupted by Ctrl-C.
    Interrupted = 130,
}

impl Exit {
    /// Returns the worse of two exit codes. An unknown result is worse than a target that is known to be missed.
    pub(super) fn worse(self, other: Self) -> Self {
        let rank = |exit: Self| match exit {
            Self::Done => 0,
            Self::Missed => 1,
            Self::NotAllocated => 2,
            Self::NoResult => 3,
            Self::Usage => 4,
            Self::Interrupted => 5,
        };
        if rank(other) > rank(self) { other } else { self }
    }
}

impl Exit {
    /// Exit codes with their meaning, for the manual.
    pub(super) const ALL: [(Self, &'static str); 6] = [
        (Self::Done, "done, with warnings perhaps; a pipe that was closed"),
        (
            Self::Missed,
            "`--check`: a requirement is missed or inconclusive; `allocate --confirm`: the sample refutes what was found; `probe`: \
             a check failed",
        ),
        (Self::Usage, "the command line or the study is wrong, or an output cannot be written"),
        (
            Self::NoResult,
            "the model gave a characteristic that was asked for no result; `--check`: the run was stopped before its planned \
             points were evaluated; `--check --strict`: a requirement is met by the surface only; no fresh process confirmed \
             answers of an external model: they depend on the points before them, or the run ended before their check",
        ),
        (Self::NotAllocated, "`allocate`: no tolerances keep the requirements, or they were not found in time"),
        (
            Self::Interrupted,
            "interrupted: the first Ctrl-C reports what is known, the second gives up what is under way, the third ends at once",
        ),
    ];
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Error that ends a command.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error(transparent)]
    Problem(#[from] ProblemError),
    #[error(transparent)]
    Method(#[from] MethodError),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Sharding(#[from] ShardError),
    #[error("{path}: {reason}", path = path.display())]
    Shard { path: PathBuf, reason: String },
    #[error(transparent)]
    Rare(#[from] RareError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error(transparent)]
    Lot(#[from] LotError),
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error(transparent)]
    Allocate(#[from] AllocateError),
    #[error(transparent)]
    Rewrite(#[from] RewriteError),
    #[error(transparent)]
    Pearson(#[from] PearsonError),
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error("{}; there are {known}", number.map_or("--model N says which of several models".to_owned(), |number| format!("there is no model {number} in the journal")))]
    UnknownJournalModel { number: Option<i64>, known: String },
    #[error("{answers} answers would be forgotten, and there is no terminal to confirm it: pass --yes")]
    NotAgreed { answers: usize },
    #[error("{path}: {reason}", path = path.display())]
    Points { path: PathBuf, reason: String },
    #[error("{path}: {reason}", path = path.display())]
    Import { path: PathBuf, reason: String, help: Option<String> },
    #[error("{flag} is for tables, and {path} is a study: write it there", path = path.display())]
    NoTable { flag: &'static str, path: PathBuf },
    #[error("the format of the budget stands behind `=`: write --gum={format}")]
    GumFormat { format: &'static str },
    #[error("{path}: -o writes text or JSON; write {right}", path = path.display())]
    OtherKind { path: PathBuf, right: String },
    #[error("the table cannot be written: {reason}")]
    Table { reason: String },
    #[error("{reason}")]
    Workbook { reason: String },
    #[error("--check has nothing to check: no characteristic asked for has a target_yield, a target_cpk or a require")]
    NothingToCheck,
    #[error("--pairs {text}: {fault}")]
    Pairs { text: String, fault: &'static str },
    #[error(transparent)]
    UnknownName(#[from] UnknownName),
    #[error("there is no example `{}`; `sensitol examples` lists all: {known}", clipped(name))]
    UnknownExample { name: String, nearest: Option<String>, known: String },
    #[error("this build holds no examples: they stand in the folder examples of a clone or of a release")]
    NoExamples,
    #[error("--at: there is no dimension `{name}`; known: {known}")]
    UnknownDimension { name: String, nearest: Option<String>, known: String },
    #[error("{path} cannot be written: {error}", path = path.display())]
    Unwritable { path: PathBuf, error: std::io::Error },
    #[error("a page that works without this program holds the engine, and none was built: run web/build, name a page by --page, or open the studies by `sensitol serve`; there is no page at {sought}", sought = sought.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", "))]
    NoPage { sought: Vec<PathBuf> },
    #[error("{path} is not a page for `sensitol workbench`: {reason}", path = path.display())]
    WrongPage { path: PathBuf, reason: String },
    #[error("--compare is about two revisions of a study, the older one first: name two files, not {count}")]
    NotTwo { count: usize },
    #[error("--pdf prints the page by Chromium, and {}: install Chromium, name it in the variable SENSITOL_CHROMIUM, or write the page by --html and print it from a browser", named.as_ref().map_or("there is none on PATH".to_owned(), |path| format!("there is no file {}, which SENSITOL_CHROMIUM names", path.display())))]
    NoBrowser { named: Option<PathBuf> },
    #[error("{browser} did not print the page: {reason}; write the page by --html and print it from a browser", browser = browser.display())]
    NotPrinted { browser: PathBuf, reason: String },
    #[error(
        "the variable {variable} is `{text}`: write the whole number of seconds since 1970, such as 1700000000, or unset it"
    )]
    WrongDate { variable: &'static str, text: String },
    #[error("the page of the workbench is older than this program: run web/build again")]
    OldPage,
    #[error("{path} is no folder of studies: {reason}", path = path.display())]
    NotAFolder { path: PathBuf, reason: String },
    #[error("nothing can listen at {address}: {reason}")]
    NotServed { address: std::net::SocketAddr, reason: String },
    #[error("nothing listens at {address} any longer: {reason}")]
    NoLongerServed { address: std::net::SocketAddr, reason: String },
    #[error("{path} cannot be put into a page: {reason}", path = path.display())]
    NotInPage { path: PathBuf, reason: String },
    #[error("{path} is there already and stays as it is: name another file, or remove it", path = path.display())]
    Exists { path: PathBuf },
    #[error("`{path}` is there, and no report of sensitol that may be written over: name another file, or pass --force", path = path.display())]
    Foreign { path: PathBuf },
    #[error("`{path}` is {what}, which would be lost: name another file", path = path.display())]
    WouldBeLost { path: PathBuf, what: &'static str },
    #[error("--write {path}: the study names {names}, and its paths start from its own folder: write into that folder, and move study and files together", path = path.display())]
    AnotherFolder { path: PathBuf, names: String },
    #[error("`{path}` is asked for twice: name two files", path = path.display())]
    AskedTwice { path: PathBuf },
    #[error("{path} is a file, and --csv needs a folder", path = path.display())]
    NoFolder { path: PathBuf },
    #[error("{flag} {path} is {what}, and several studies need a folder for their {files}", path = path.display())]
    NoFolderOfPages { flag: &'static str, path: PathBuf, what: &'static str, files: &'static str },
    #[error("{first} and {second} would both write {name}: analyse them in two calls, or rename one", first = first.display(), second = second.display())]
    SameName { first: PathBuf, second: PathBuf, name: String },
    #[error("--points is of one study, and there are {count}: analyse each in a call of its own")]
    PointsOfOne { count: usize },
    #[error("cannot write to standard output: {0}")]
    Stdout(std::io::Error),
    #[error("cannot start {threads} threads: {reason}")]
    Threads { threads: u16, reason: String },
    #[error("{reason}. The run was ended: what is in the journal stays, and the same command goes on from there")]
    NotKept { reason: String },
    #[error(
        "{error}. No more points were evaluated: `sensitol evaluate STUDY --at nominal -v` shows what the model writes, and `sensitol probe STUDY` tries it"
    )]
    FailsEverywhere { error: Box<ProcessError> },
    #[error("nothing reads the output any more")]
    ClosedPipe,
}

impl Failure {
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::ClosedPipe => Exit::Done,
            _ => Exit::Usage,
        }
    }

    /// Returns the actions to take, if the library has any.
    fn advice(&self) -> Vec<Advice> {
        match self {
            Self::Method(error) | Self::Sweep(SweepError::Method(error)) | Self::Lot(LotError::Method(error)) => {
                error.advice()
            }
            Self::Simulation(error)
            | Self::Rare(RareError::Simulation(error))
            | Self::Compare(CompareError::Reference(error)) => error.advice(),
            Self::Allocate(error) => error.advice(),
            _ => Vec::new(),
        }
    }

    /// Formats the message with its place in the file. Returns None if there is nothing to print.
    pub(super) fn render(&self) -> Option<String> {
        self.rendered(String::new())
    }

    /// Formats the message of one study of several, with its name.
    pub(super) fn render_of(&self, study: &str) -> Option<String> {
        self.rendered(format!("{study}: "))
    }

    fn rendered(&self, of: String) -> Option<String> {
        match self {
            Self::ClosedPipe => None,
            // Errors of a study name their file themselves.
            Self::Study(error) => {
                let all: Vec<String> = std::iter::once(error).chain(&error.more).map(render).collect();
                Some(all.join("\n\n"))
            }
            _ => Some(title(&format!("{of}{self}"), self.help())),
        }
    }

    /// Returns the text to write instead, or the actions to take, in one line.
    pub(super) fn help(&self) -> Option<String> {
        match self {
            Self::Study(error) => help(error),
            Self::Problem(ProblemError::UnknownCharacteristic { nearest: Some(nearest), .. })
            | Self::UnknownDimension { nearest: Some(nearest), .. }
            | Self::UnknownExample { nearest: Some(nearest), .. } => Some(format!("did you mean `{nearest}`?")),
            Self::Import { help, .. } => help.clone(),
            _ => advice::help(&self.advice()),
        }
    }
}

/// Returns the text to write instead, or the action to take.
fn help(error: &StudyError) -> Option<String> {
    error.help().or_else(|| advice::help(&error.fault.advice()))
}

/// Formats an error of a study: title, the lines concerned with the fault underlined, and the text to write instead.
fn render(error: &StudyError) -> String {
    let Some(span) = error.span.clone().filter(|_| !error.text.is_empty()) else {
        let place =
            if error.key.is_empty() { error.file.clone() } else { format!("{}: {}", error.file, error.place_name()) };
        return title(&format!("{place}: {}", error.message()), help(error));
    };
    let heading = error.message();
    let label = error.place_name();
    let snippet =
        Snippet::source(&*error.text).path(&error.file).annotation(AnnotationKind::Primary.span(span).label(&label));
    let mut group = Group::with_title(Level::ERROR.primary_title(heading)).element(snippet);
    if let Some(help) = help(error) {
        group = group.element(Level::HELP.message(help));
    }
    Renderer::styled().render(&[group])
}

fn title(heading: &str, help: Option<String>) -> String {
    let mut group = Group::with_title(Level::ERROR.primary_title(clipped(heading)));
    if let Some(help) = help {
        group = group.element(Level::HELP.message(help));
    }
    Renderer::styled().render(&[group])
}
