//! Errors of an external process.

use std::fmt;
use std::time::Duration;

use sensitol_numeric::names::clipped;

/// Reason why a process gave no value, with the last lines that it wrote to stderr.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{fault}{stderr}")]
pub struct ProcessError {
    /// Fault of the process.
    pub fault: ProcessFault,
    /// Last lines that the process wrote to stderr.
    pub stderr: StderrTail,
}

/// Faults of a process.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProcessFault {
    /// The program does not exist.
    #[error("there is no program `{program}`; it is looked for in {}", place(program, folder))]
    NotFound {
        /// Name of the program in the study.
        program: String,
        /// Folder of the study.
        folder: String,
    },
    /// The operating system cannot start the program.
    #[error("`{program}` cannot be started: {reason}")]
    NotStarted {
        /// Name of the program in the study.
        program: String,
        /// Reason in the operating system's words.
        reason: String,
    },
    /// The process ended before it was ready.
    #[error("the model ended before it said that it is ready ({exit})")]
    EndedAtStart {
        /// Way in which the process ended.
        exit: Exit,
    },
    /// The process did not report in time that it is ready.
    #[error("the model did not say within {} s that it is ready; start_timeout_s allows for more", .after.as_secs_f64())]
    SilentAtStart {
        /// Time limit for the report, after which it was stopped.
        after: Duration,
    },
    /// The process does not serve this study.
    #[error("the model does not serve this study: {message}")]
    RefusedStudy {
        /// Reason in the model's own words.
        message: String,
    },
    /// The process has a dimension or a characteristic in another unit.
    #[error("the model has `{name}` in {own}, and the study in {study}{}: {}", by(*factor), in_own(name, own, *factor))]
    ForeignUnit {
        /// Name of the dimension or characteristic.
        name: String,
        /// Unit of the study.
        study: String,
        /// Unit of the model.
        own: String,
        /// Factor on a number of the study; None if the two units measure different quantities.
        factor: Option<f64>,
    },
    /// The first line of the process does not follow the protocol.
    #[error("the model's first line is not a `ready` of this protocol: {line}{}", hint(line))]
    NotReady {
        /// First line that the process wrote.
        line: Quoted,
    },
    /// The process ended while points were in progress.
    #[error("the model ended while it evaluated this point ({exit})")]
    Crashed {
        /// Way in which the process ended.
        exit: Exit,
    },
    /// The process did not answer in time.
    #[error("the model did not answer within {} s; timeout_s allows for more", .after.as_secs_f64())]
    TimedOut {
        /// Time limit for an answer, after which it was stopped.
        after: Duration,
    },
    /// The process still writes at a line that does not end.
    #[error("the model writes a line that did not end within {} s: end every answer with a newline", .after.as_secs_f64())]
    EndlessLine {
        /// Time limit for an answer, after which it was stopped.
        after: Duration,
    },
    /// The process wrote a line that is not an answer.
    #[error("the model wrote a line that is not an answer ({}): {line}{}", clipped(reason), hint(line))]
    Garbage {
        /// Reason why the line is invalid.
        reason: String,
        /// Line that the process wrote.
        line: Quoted,
    },
    /// The process wrote a line that is too long.
    #[error("the model wrote a line of more than {limit} bytes: {line}")]
    Oversized {
        /// Length in bytes of the longest line that is read.
        limit: usize,
        /// Beginning of the line.
        line: Quoted,
    },
    /// The process answered with a wrong number of values.
    #[error("the model answered with {found} values where {expected} were asked for")]
    WrongLength {
        /// Number of characteristics that were requested.
        expected: usize,
        /// Number of values in the answer.
        found: usize,
    },
    /// The process answered with derivatives of a wrong shape.
    #[error("the model answered with derivatives that are not {rows} rows of {columns}")]
    WrongGradients {
        /// Expected rows, one for each characteristic.
        rows: usize,
        /// Expected columns, one for each dimension.
        columns: usize,
    },
    /// The process answered a point that was not requested.
    #[error("the model answered point {id}, which was not under way")]
    UnknownPoint {
        /// Number of the point in the answer.
        id: u64,
    },
    /// The process answered a point for the second time.
    #[error("the model answered point {id} twice")]
    AnsweredTwice {
        /// Number of the point in the answer.
        id: u64,
    },
    /// The process has different values if a point is reached on different ways.
    #[error(
        "the answer depends on the points before it: {} at first, {} by small steps, {} along one dimension after the other",
        value(first),
        value(second),
        value(third)
    )]
    TwoAnswers {
        /// First answer for the point.
        first: Option<f64>,
        /// Answer after small steps from the nominal point.
        second: Option<f64>,
        /// Answer after steps along one dimension after the other.
        third: Option<f64>,
    },
    /// The process has failed at every point so far for one reason, so that no more points are sent.
    #[error("the model has no value at {}, always because: {}", failed_points(*nominal, *others), clipped(message))]
    FailsEverywhere {
        /// True if the nominal point is one of them.
        nominal: bool,
        /// Number of the others.
        others: usize,
        /// First reason.
        message: String,
    },
    /// The process requested another attempt at the point every time, which is not an answer of the model. It is not kept in a journal.
    #[error("{}", clipped(message))]
    Unable {
        /// Reason of the last attempt in the model's own words.
        message: String,
    },
    /// The process has no value for one characteristic.
    #[error("{}", clipped(message))]
    NoValue {
        /// Reason in the model's own words, or a general one if it gave none.
        message: String,
    },
}

/// Way in which a process ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Exit {
    /// Exit with this code.
    Code(i32),
    /// End by a signal, or in some other way.
    Signal(Option<i32>),
    /// No end yet, but the process closed its stdout.
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

/// Beginning of a line from outside of this program, with control characters replaced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quoted(pub String);

impl Quoted {
    /// Greatest number of characters, so that an error message stays short.
    const LENGTH: usize = 120;

    /// Quotes the beginning of these bytes. Invalid UTF-8 and control characters are replaced.
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

/// Last lines of a process's stderr. They are shown after the error, if there are any.
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

/// Describes the factor between two units, if there is one.
fn by(factor: Option<f64>) -> String {
    factor.map_or(String::new(), |factor| format!(" (factor {factor})"))
}

/// Advises how to bring the two units together.
fn in_own(name: &str, own: &str, factor: Option<f64>) -> String {
    match factor {
        Some(_) => {
            format!("write `{name}` in {own}, or units = \"convert\" at the top; \"labels\" takes numbers as they are")
        }
        None => format!("they measure different things; write `{name}` in {own}"),
    }
}

/// Names the points of a model that fails everywhere.
fn failed_points(nominal: bool, others: usize) -> String {
    if nominal {
        format!("the nominal dimensions and {others} other points")
    } else {
        format!("the first {others} points")
    }
}

/// Advises on a line that was printed for readers.
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
