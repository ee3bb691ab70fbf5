//! The faults of an external process.

use std::fmt;
use std::time::Duration;

/// Why a process gave no value. Each names what was seen, and quotes the last lines that it wrote to stderr.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{fault}{stderr}")]
pub struct ProcessError {
    /// The fault.
    pub fault: ProcessFault,
    /// The last lines of its stderr.
    pub stderr: StderrTail,
}

/// The faults of a process.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProcessFault {
    /// There is no such program.
    #[error("there is no program `{program}`; it is looked for in {}", place(program, folder))]
    NotFound {
        /// As the study names it.
        program: String,
        /// The study's folder.
        folder: String,
    },
    /// The operating system does not run it.
    #[error("`{program}` cannot be started: {reason}")]
    NotStarted {
        /// As the study names it.
        program: String,
        /// The operating system's words.
        reason: String,
    },
    /// It ended before it was ready.
    #[error("the model ended before it said that it is ready ({exit})")]
    EndedAtStart {
        /// How it ended.
        exit: Exit,
    },
    /// It did not say in time that it is ready.
    #[error("the model did not say within {} s that it is ready; start_timeout_s allows for more", .after.as_secs_f64())]
    SilentAtStart {
        /// For how long it was waited for.
        after: Duration,
    },
    /// It does not serve this study.
    #[error("the model does not serve this study: {message}")]
    RefusedStudy {
        /// Its own words.
        message: String,
    },
    /// It has a dimension or a characteristic in another unit.
    #[error("the model has `{name}` in {own}, and the study in {study}{}: {}", by(*factor), in_own(name, own, *factor))]
    ForeignUnit {
        /// The dimension or characteristic.
        name: String,
        /// The unit of the study.
        study: String,
        /// That of the model.
        own: String,
        /// The factor on a number of the study; None where the two measure different things.
        factor: Option<f64>,
    },
    /// Its first line was none of the protocol.
    #[error("the model's first line is not a `ready` of this protocol: {line}{}", hint(line))]
    NotReady {
        /// The line that it wrote.
        line: Quoted,
    },
    /// It ended with points under way.
    #[error("the model ended while it evaluated this point ({exit})")]
    Crashed {
        /// How it ended.
        exit: Exit,
    },
    /// It did not answer in time.
    #[error("the model did not answer within {} s; timeout_s allows for more", .after.as_secs_f64())]
    TimedOut {
        /// For how long it was waited for.
        after: Duration,
    },
    /// It wrote a line that is not an answer.
    #[error("the model wrote a line that is not an answer ({reason}): {line}{}", hint(line))]
    Garbage {
        /// The reason why the line is invalid.
        reason: String,
        /// The line that it wrote.
        line: Quoted,
    },
    /// It wrote a line without end.
    #[error("the model wrote a line of more than {limit} bytes: {line}")]
    Oversized {
        /// The longest line that is read.
        limit: usize,
        /// How it began.
        line: Quoted,
    },
    /// It answered with another number of values.
    #[error("the model answered with {found} values where {expected} were asked for")]
    WrongLength {
        /// How many characteristics were asked for.
        expected: usize,
        /// How many values came.
        found: usize,
    },
    /// It answered with derivatives of another shape.
    #[error("the model answered with derivatives that are not {rows} rows of {columns}")]
    WrongGradients {
        /// A row for each characteristic.
        rows: usize,
        /// A number for each dimension.
        columns: usize,
    },
    /// It answered a point that was not asked for.
    #[error("the model answered point {id}, which was not under way")]
    UnknownPoint {
        /// The point's number.
        id: u64,
    },
    /// It answered a point for the second time.
    #[error("the model answered point {id} twice")]
    AnsweredTwice {
        /// The point's number.
        id: u64,
    },
    /// It has other values when the point is reached on other ways.
    #[error(
        "the answer depends on the points before it: {} at first, {} by small steps, {} along one dimension after the other",
        value(first),
        value(second),
        value(third)
    )]
    TwoAnswers {
        /// As it was first answered.
        first: Option<f64>,
        /// By small steps from the nominal point.
        second: Option<f64>,
        /// Along one dimension after the other.
        third: Option<f64>,
    },
    /// It has no value for one characteristic.
    #[error("{message}")]
    NoValue {
        /// Its own words, or ours where it said nothing.
        message: String,
    },
}

/// How a process ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Exit {
    /// With this code.
    Code(i32),
    /// By a signal, or in some other way.
    Signal(Option<i32>),
    /// Not at all: it closed its stdout.
    ClosedStdout,
}

impl fmt::Display for Exit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Code(code) => write!(f, "exit code {code}"),
            Self::Signal(Some(signal)) => write!(f, "signal {signal}"),
            Self::Signal(None) => write!(f, "killed"),
            Self::ClosedStdout => write!(f, "it closed its stdout"),
        }
    }
}

/// The beginning of a line from outside of this program, fit to be shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quoted(pub String);

impl Quoted {
    /// As many characters as an error message bears.
    const LENGTH: usize = 120;

    pub fn of(bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * Self::LENGTH)]);
        let clean = |c: char| if c.is_control() { '\u{fffd}' } else { c };
        Self(text.trim().chars().take(Self::LENGTH).map(clean).collect())
    }
}

impl fmt::Display for Quoted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.0)
    }
}

/// The last lines of a process's stderr; shown behind the error, if there are any.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StderrTail(pub Vec<String>);

impl fmt::Display for StderrTail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return Ok(());
        }
        write!(f, "; its stderr ended with: {}", self.0.join(" | "))
    }
}

/// The factor between two units, where there is one.
fn by(factor: Option<f64>) -> String {
    factor.map_or(String::new(), |factor| format!(" (factor {factor})"))
}

/// How the two come together.
fn in_own(name: &str, own: &str, factor: Option<f64>) -> String {
    match factor {
        Some(_) => {
            format!("write `{name}` in {own}, or units = \"convert\" at the top; \"labels\" takes numbers as they are")
        }
        None => format!("they measure different things; write `{name}` in {own}"),
    }
}

/// The action to take on a line that was printed for people.
fn hint(line: &Quoted) -> &'static str {
    match line.0.is_empty() || line.0.starts_with('{') {
        true => "",
        false => "; stdout belongs to the protocol: print to stderr",
    }
}

fn value(value: &Option<f64>) -> String {
    value.map_or("no value".to_owned(), |value| value.to_string())
}

fn place(program: &str, folder: &str) -> String {
    if program.contains('/') { format!("`{folder}`, the study's folder") } else { "the PATH".to_owned() }
}
