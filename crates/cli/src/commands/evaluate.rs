//! `sensitol evaluate`: a study as a program that speaks the protocol of external models, or a report on some points.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};

use serde::{Deserialize, Serialize};

use crate::args::EvaluateArgs;
use crate::commands::point_report::{self, PoseReport};
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::output::Look;
use crate::running::listener;
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol::problem::Problem;
use sensitol_study::{AssemblyPoses, Externals, PartPose, Study};

/// Version of the protocol (`adapters/PROTOCOL.md`).
const VERSION: u32 = 1;
/// Greatest number of points that may be sent ahead. Points that arrive together are evaluated together.
const WINDOW: usize = 256;
/// Digits of the study's hash that are part of its version.
const DIGITS: usize = 16;

/// The first line. Without names, all dimensions and all characteristics in the study's order are meant.
#[derive(Deserialize)]
struct Greeted {
    sensitol: u32,
    #[serde(default)]
    dimensions: Vec<String>,
    #[serde(default)]
    units: Vec<Option<String>>,
    #[serde(default)]
    constants: BTreeMap<String, f64>,
    #[serde(default)]
    characteristics: Vec<String>,
    #[serde(default)]
    optional: Vec<String>,
    /// True if every answer shall have the poses of the parts of an assembly in space.
    #[serde(default)]
    poses: bool,
}

#[derive(Deserialize)]
struct Asked {
    id: Option<u64>,
    x: Option<Vec<f64>>,
}

#[derive(Serialize)]
struct Ready<'a> {
    ready: bool,
    name: &'a str,
    version: &'a str,
    window: usize,
    dimensions: Vec<&'a str>,
    units: Vec<Option<&'a str>>,
    nominal: Vec<f64>,
    characteristics: Vec<&'a str>,
    /// Unit of the translations, if poses are requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    length_unit: Option<&'a str>,
}

#[derive(Serialize)]
struct Answer {
    id: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    y: Option<Vec<Option<f64>>>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    errors: BTreeMap<String, String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    poses: Vec<PoseReport>,
}

#[derive(Serialize)]
struct Refusal {
    error: String,
}

/// Study with the names and units that one engine requested.
struct Session {
    problem: Problem,
    /// Point with nominal values and constants, into which the values of a request are written.
    start: Vec<f64>,
    /// Index of the dimension of every value in a request. None for an optional name that the study does not have.
    columns: Vec<Option<usize>>,
    /// Poses of the parts, if they are requested.
    poses: Option<AssemblyPoses>,
    /// Poses at the nominal dimensions.
    parts: Vec<PartPose>,
}

pub(crate) fn run(asked: &EvaluateArgs, look: Look) -> Result<Exit, Failure> {
    // The calling engine keeps the answers and checks repeatability, so journal and sentinels are off here.
    let externals = Externals { listener: listener(look), ..Externals::default() }.with_sentinels(false);
    let study = Study::read_with(&asked.study, externals)?;
    look.warn_all(&study.warnings);
    if asked.reports() {
        return point_report::run(&study, asked, look);
    }
    interrupt::listen();
    let mut input = BufReader::new(std::io::stdin());
    let mut line = Vec::new();
    if !matches!(input.read_until(b'\n', &mut line), Ok(read) if read > 0) {
        return Ok(Exit::Done);
    }
    let stem = asked.study.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let name = study.title.clone().or(stem).unwrap_or_default();
    let length_unit = study.length_unit.clone();
    let mut version = study.sha256.chars().take(DIGITS).collect::<String>();
    let session = match Session::open(study, &line, &mut version) {
        Ok(session) => session,
        Err(error) => {
            write(&[Refusal { error }])?;
            return Ok(Exit::Usage);
        }
    };
    let dimensions = session.problem.dimensions();
    write(&[Ready {
        ready: true,
        name: &name,
        version: &version,
        window: WINDOW,
        dimensions: dimensions.iter().map(|dimension| dimension.name()).collect(),
        units: dimensions.iter().map(|dimension| dimension.unit()).collect(),
        nominal: session.start.clone(),
        characteristics: session.problem.characteristics().iter().map(|one| one.name()).collect(),
        length_unit: length_unit.as_deref().filter(|_| session.poses.is_some()),
    }])?;
    while let Some(lines) = together(&mut input) {
        if interrupt::stopped() {
            return Ok(Exit::Interrupted);
        }
        write(&session.answers(&lines))?;
    }
    Ok(Exit::Done)
}

/// Returns the lines that have arrived, at least one. Returns None at the end of the input.
fn together(input: &mut BufReader<impl Read>) -> Option<Vec<Vec<u8>>> {
    let mut lines = Vec::new();
    loop {
        let mut line = Vec::new();
        match input.read_until(b'\n', &mut line) {
            Ok(read) if read > 0 => lines.push(line),
            _ => return (!lines.is_empty()).then_some(lines),
        }
        if lines.len() >= WINDOW || !input.buffer().contains(&b'\n') {
            return Some(lines);
        }
    }
}

fn write(lines: &[impl Serialize]) -> Result<(), Failure> {
    let mut text = Vec::new();
    for line in lines {
        serde_json::to_writer(&mut text, line).map_err(|error| Failure::Stdout(error.into()))?;
        text.push(b'\n');
    }
    let mut out = std::io::stdout().lock();
    match out.write_all(&text).and_then(|()| out.flush()) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Err(Failure::ClosedPipe),
        done => done.map_err(Failure::Stdout),
    }
}

impl Session {
    /// Matches the study to the request of an engine. The version of an external model is appended to that of the study.
    fn open(study: Study, line: &[u8], version: &mut String) -> Result<Self, String> {
        let greeted: Greeted = serde_json::from_slice(line)
            .map_err(|error| format!("the first line is not that of protocol {VERSION}: {error}"))?;
        if greeted.sensitol != VERSION {
            return Err(format!("this is version {VERSION} of the protocol, not {}", greeted.sensitol));
        }
        let poses = match greeted.poses {
            true => study.assembly_poses().map_err(|error| error.to_string())?,
            false => None,
        };
        let (mut problem, parts) = (study.problem, study.poses);
        if !greeted.characteristics.is_empty() {
            problem = problem.only(&greeted.characteristics).map_err(|error| error.to_string())?;
        }
        let known: Vec<&str> = problem.dimensions().iter().map(|dimension| dimension.name()).collect();
        let find = |name: &String| match known.iter().position(|known| known == name) {
            None if !greeted.optional.contains(name) => {
                Err(format!("no dimension `{name}`; there are {}", known.join(", ")))
            }
            found => Ok(found),
        };
        let mut start: Vec<f64> = problem.dimensions().iter().map(|dimension| dimension.nominal()).collect();
        for (name, value) in &greeted.constants {
            find(name)?.into_iter().for_each(|place| start[place] = *value);
        }
        let columns = if greeted.dimensions.is_empty() {
            (0..start.len()).map(Some).collect()
        } else {
            greeted.dimensions.iter().map(find).collect::<Result<Vec<_>, _>>()?
        };
        for (column, unit) in columns.iter().zip(&greeted.units) {
            let own = column.and_then(|place| Some((place, problem.dimensions()[place].unit()?)));
            if let (Some((place, own)), Some(unit)) = (own, unit)
                && own != unit
            {
                return Err(format!("`{}` is in `{unit}` there and in `{own}` here", known[place]));
            }
        }
        if let Some(model) = problem.function().prepare(problem.outputs()).map_err(|error| error.to_string())? {
            for part in [model.name, model.version].into_iter().flatten() {
                *version += &format!("; {part}");
            }
        }
        Ok(Self { problem, start, columns, poses, parts })
    }

    /// Returns an answer to every line that is a request.
    fn answers(&self, lines: &[Vec<u8>]) -> Vec<Answer> {
        let fault = |id, error| Answer { id, y: None, errors: BTreeMap::new(), error: Some(error), poses: Vec::new() };
        let mut answers = Vec::new();
        let mut requests: Vec<(u64, Vec<f64>)> = Vec::new();
        for line in lines {
            // Lines that are not requests, such as cancellations, need no answer.
            let Ok(Asked { id: Some(id), x: Some(x) }) = serde_json::from_slice(line) else { continue };
            if x.len() != self.columns.len() {
                answers
                    .push(fault(id, format!("{} values where there are {} dimensions", x.len(), self.columns.len())));
                continue;
            }
            let mut point = self.start.clone();
            for (column, value) in self.columns.iter().zip(x) {
                column.iter().for_each(|&place| point[place] = value);
            }
            requests.push((id, point));
        }
        if requests.is_empty() {
            return answers;
        }
        let (ids, rows): (Vec<u64>, Vec<Vec<f64>>) = requests.into_iter().unzip();
        let (points, outputs) = (Points::from_rows(&rows), self.problem.outputs());
        let mut found = Responses::open(rows.len(), outputs.len());
        let within = Run::to_the_end().stopping_when(&interrupt::reason).abandoning_when(&interrupt::abandoned);
        self.problem.function().evaluate(&Request { points: &points, outputs }, &within, &mut found);
        let placed = self.poses.as_ref().map_or_else(Vec::new, |poses| poses.at(&points, &within));
        let names: Vec<&str> = self.problem.characteristics().iter().map(|one| one.name()).collect();
        answers.extend(ids.into_iter().enumerate().map(|(row, id)| {
            let reason =
                |(output, name): (usize, &&str)| Some(((*name).to_owned(), found.error(row, output)?.to_string()));
            let y = (0..names.len()).map(|output| found.value(row, output)).collect();
            let errors = names.iter().enumerate().filter_map(reason).collect();
            let poses = placed.get(row).map(|found| found.as_ref().ok().map(Vec::as_slice));
            let poses = poses.map_or_else(Vec::new, |poses| PoseReport::all(poses, &self.parts));
            Answer { id, y: Some(y), errors, error: None, poses }
        }));
        answers
    }
}
