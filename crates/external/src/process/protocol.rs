//! The lines of the protocol, version 1 (`adapters/PROTOCOL.md`).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use sensitol::assembly::ModelInfo;
use sensitol::assembly::{ProcessFault, Quoted};

/// The version that is spoken here.
pub(super) const VERSION: u32 = 1;

/// The engine's first line: what the study has, and what it asks for.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Hello {
    pub(super) sensitol: u32,
    pub(super) dimensions: Vec<String>,
    pub(super) units: Vec<Option<String>>,
    pub(super) nominal: Vec<f64>,
    pub(super) constants: serde_json::Map<String, serde_json::Value>,
    pub(super) characteristics: Vec<String>,
    /// Dimensions and constants that formulas use too: the child need not know them.
    pub(super) optional: Vec<String>,
    /// The units of the characteristics, which a child is not told: its own are held against them.
    #[serde(skip)]
    pub(super) asked_units: Vec<Option<String>>,
}

/// Anything that a child may say. Keys that are not known here are for others.
#[derive(Debug, Deserialize)]
pub(super) struct Line {
    pub(super) ready: Option<bool>,
    /// The version that the child speaks, where it says so.
    pub(super) sensitol: Option<u32>,
    pub(super) name: Option<String>,
    pub(super) version: Option<serde_json::Value>,
    pub(super) window: Option<usize>,
    pub(super) id: Option<u64>,
    pub(super) y: Option<Vec<Option<f64>>>,
    /// Derivatives: a row for each characteristic.
    pub(super) dy: Option<Vec<Vec<f64>>>,
    #[serde(default)]
    pub(super) errors: BTreeMap<String, String>,
    pub(super) error: Option<String>,
    #[serde(default)]
    pub(super) retry: bool,
    /// A sign of life, which restarts the clock of what has not started.
    #[serde(default)]
    pub(super) alive: bool,
    /// Where the evaluation of point `id` has just begun.
    pub(super) started: Option<String>,
    /// Where the answer was evaluated, and what it took.
    #[serde(rename = "where")]
    pub(super) place: Option<String>,
    pub(super) cost_s: Option<f64>,
    /// The abilities of the program; with `ready`.
    #[serde(default)]
    pub(super) isolated: bool,
    #[serde(default)]
    pub(super) gradients: bool,
    #[serde(default)]
    pub(super) cancel: bool,
    pub(super) places: Option<usize>,
    /// Its own units of dimensions and characteristics, by name; with `ready`. Anything else under this key is for others.
    #[serde(default)]
    pub(super) units: serde_json::Value,
    /// For `-v`.
    pub(super) note: Option<String>,
    /// Whether it holds NaN or infinities, as Python's json writes them: no value, for that reason.
    #[serde(skip)]
    pub(super) not_finite: bool,
    /// How it began, where it is odd.
    #[serde(skip)]
    pub(super) quoted: Option<Quoted>,
}

/// A line with null in place of NaN and infinities; None where there are none outside its strings.
fn finite(text: &[u8]) -> Option<Vec<u8>> {
    let (mut clean, mut inside, mut changed) = (Vec::with_capacity(text.len()), false, false);
    let mut rest = text;
    while let Some(&byte) = rest.first() {
        let word = [&b"NaN"[..], b"-Infinity", b"Infinity"].into_iter().find(|word| !inside && rest.starts_with(word));
        let taken = word.map_or(if inside && byte == b'\\' { 2 } else { 1 }, <[u8]>::len).min(rest.len());
        match word {
            Some(_) => clean.extend_from_slice(b"null"),
            None => clean.extend_from_slice(&rest[..taken]),
        }
        inside ^= byte == b'"';
        changed |= word.is_some();
        rest = &rest[taken..];
    }
    changed.then_some(clean)
}

impl Line {
    /// Reads a line; what may have to be shown is kept.
    pub(super) fn parse(text: &[u8]) -> Result<Self, ProcessFault> {
        let garbage =
            |error: serde_json::Error| ProcessFault::Garbage { reason: error.to_string(), line: Quoted::of(text) };
        let mut line: Self = match serde_json::from_slice(text) {
            Ok(line) => line,
            Err(error) => {
                let Some(text) = finite(text) else { return Err(garbage(error)) };
                Self { not_finite: true, ..serde_json::from_slice(&text).map_err(|_| garbage(error))? }
            }
        };
        if !line.alive && (line.id.is_none() || (line.y.is_none() && line.error.is_none())) {
            line.quoted = Some(Quoted::of(text));
        }
        Ok(line)
    }

    /// The program by its own words in `ready`.
    pub(super) fn info(&self) -> ModelInfo {
        let version = self.version.clone().map(|version| match version {
            serde_json::Value::String(text) => text,
            other => other.to_string(),
        });
        let window = self.window.unwrap_or(1).max(1);
        ModelInfo { name: self.name.clone(), version, window, gradients: self.gradients }
    }

    /// The fault in the shape of an answer.
    pub(super) fn misshapen(&self, rows: usize, columns: usize) -> Option<ProcessFault> {
        let found = self.y.as_ref().map_or(rows, Vec::len);
        if found != rows {
            return Some(ProcessFault::WrongLength { expected: rows, found });
        }
        let fits = |dy: &Vec<Vec<f64>>| dy.len() == rows && dy.iter().all(|row| row.len() == columns);
        let misshapen = self.dy.as_ref().is_some_and(|dy| !fits(dy));
        misshapen.then_some(ProcessFault::WrongGradients { rows, columns })
    }

    /// As something that should have been an answer.
    pub(super) fn garbage(&self, reason: &str) -> ProcessFault {
        let line = self.quoted.clone().unwrap_or_else(|| Quoted(String::new()));
        ProcessFault::Garbage { reason: reason.to_owned(), line }
    }
}

impl Hello {
    pub(super) fn line(&self) -> Vec<u8> {
        let mut line = serde_json::to_vec(self).expect("names and numbers are JSON");
        line.push(b'\n');
        line
    }
}

/// A request for one point, at a place of the program where one is named. Numbers are the shortest that read back as the same
/// double.
pub(super) fn request(line: &mut Vec<u8>, id: u64, point: impl Iterator<Item = f64>, place: Option<&str>) {
    line.extend_from_slice(b"{\"id\":");
    line.extend_from_slice(id.to_string().as_bytes());
    line.extend_from_slice(b",\"x\":[");
    for (index, value) in point.enumerate() {
        if index > 0 {
            line.push(b',');
        }
        serde_json::to_writer(&mut *line, &value).expect("a point is finite, and memory does not fail");
    }
    line.push(b']');
    if let Some(place) = place {
        line.extend_from_slice(b",\"place\":");
        serde_json::to_writer(&mut *line, place).expect("text is JSON, and memory does not fail");
    }
    line.extend_from_slice(b"}\n");
}
