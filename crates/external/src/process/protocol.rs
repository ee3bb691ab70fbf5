//! Lines of the protocol, version 1 (`adapters/PROTOCOL.md`).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use sensitol::assembly::ModelInfo;
use sensitol::assembly::{ProcessFault, Quoted};
use sensitol_numeric::names::clipped;

/// Version of the protocol.
pub(super) const VERSION: u32 = 1;

/// First line of the engine: dimensions, constants and requested characteristics.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Hello {
    pub(super) sensitol: u32,
    pub(super) dimensions: Vec<String>,
    pub(super) units: Vec<Option<String>>,
    pub(super) nominal: Vec<f64>,
    pub(super) constants: serde_json::Map<String, serde_json::Value>,
    pub(super) characteristics: Vec<String>,
    /// Dimensions and constants that formulas use too, so that the child does not use them.
    pub(super) optional: Vec<String>,
    /// Units of the characteristics. They are not sent, only compared with those of the child.
    #[serde(skip)]
    pub(super) asked_units: Vec<Option<String>>,
}

/// Any line of a child. Unknown keys are ignored.
#[derive(Debug, Deserialize)]
pub(super) struct Line {
    pub(super) ready: Option<bool>,
    /// Version of the protocol that the child declares.
    pub(super) sensitol: Option<u32>,
    pub(super) name: Option<String>,
    pub(super) version: Option<serde_json::Value>,
    pub(super) window: Option<usize>,
    pub(super) id: Option<u64>,
    pub(super) y: Option<Vec<Option<f64>>>,
    /// Derivatives, with one row for each characteristic.
    pub(super) dy: Option<Vec<Vec<f64>>>,
    #[serde(default)]
    pub(super) errors: BTreeMap<String, String>,
    pub(super) error: Option<String>,
    #[serde(default)]
    pub(super) retry: bool,
    /// Sign of life, which restarts the clock of points that have not started.
    #[serde(default)]
    pub(super) alive: bool,
    /// Place at which the evaluation of point `id` has just begun.
    pub(super) started: Option<String>,
    /// Place of the evaluation. `cost_s` is its cost in seconds.
    #[serde(rename = "where")]
    pub(super) place: Option<String>,
    pub(super) cost_s: Option<f64>,
    /// Abilities of the program, with `ready`.
    #[serde(default)]
    pub(super) isolated: bool,
    #[serde(default)]
    pub(super) gradients: bool,
    #[serde(default)]
    pub(super) cancel: bool,
    pub(super) places: Option<usize>,
    /// Units of dimensions and characteristics by name, with `ready`. Other values of this key are ignored.
    #[serde(default)]
    pub(super) units: serde_json::Value,
    /// Message for the user, shown by `-v`.
    pub(super) note: Option<String>,
    /// True if the line holds NaN or infinities, as Python's json writes them. Such an output has no value.
    #[serde(skip)]
    pub(super) not_finite: bool,
    /// Beginning of the line, kept if the line is odd.
    #[serde(skip)]
    pub(super) quoted: Option<Quoted>,
}

/// Line with null in place of NaN and infinities. Returns None if there are none outside of strings.
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
    /// Parses a line. Its beginning is kept if an error may have to quote it.
    pub(super) fn parse(text: &[u8]) -> Result<Self, ProcessFault> {
        let garbage = |error: serde_json::Error| ProcessFault::Garbage {
            reason: clipped(&error.to_string()),
            line: Quoted::of(text),
        };
        let mut line: Self = match serde_json::from_slice(text) {
            Ok(line) => line,
            Err(error) => {
                let Some(text) = finite(text) else { return Err(garbage(error)) };
                Self { not_finite: true, ..serde_json::from_slice(&text).map_err(|_| garbage(error))? }
            }
        };
        line.clip();
        if !line.alive && (line.id.is_none() || (line.y.is_none() && line.error.is_none())) {
            line.quoted = Some(Quoted::of(text));
        }
        Ok(line)
    }

    /// Shortens the texts of the program that enter messages and reports.
    fn clip(&mut self) {
        let version = match &mut self.version {
            Some(serde_json::Value::String(version)) => Some(version),
            _ => None,
        };
        let said = [&mut self.error, &mut self.note, &mut self.name].into_iter().flatten();
        for text in said.chain(version).chain(self.errors.values_mut()) {
            *text = clipped(text);
        }
    }

    /// Description of the program by itself, from `ready`.
    pub(super) fn info(&self) -> ModelInfo {
        let version = self.version.clone().map(|version| match version {
            serde_json::Value::String(text) => text,
            other => other.to_string(),
        });
        let window = self.window.unwrap_or(1).max(1);
        ModelInfo { name: self.name.clone(), version, window, gradients: self.gradients }
    }

    /// Fault in the shape of an answer. Returns None if it has the right shape.
    pub(super) fn misshapen(&self, rows: usize, columns: usize) -> Option<ProcessFault> {
        let found = self.y.as_ref().map_or(rows, Vec::len);
        if found != rows {
            return Some(ProcessFault::WrongLength { expected: rows, found });
        }
        let fits = |dy: &Vec<Vec<f64>>| dy.len() == rows && dy.iter().all(|row| row.len() == columns);
        let misshapen = self.dy.as_ref().is_some_and(|dy| !fits(dy));
        misshapen.then_some(ProcessFault::WrongGradients { rows, columns })
    }

    /// Fault of a line that should have been an answer.
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

/// Appends a request for one point, at a place of the program if one is given. Numbers are the shortest ones that are parsed as the same
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
