//! Finds columns of measured files whose rows are the same parts: rows of one file, or of several that a serial number joins.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::data::{Data, DataFault, DataProblem};
use crate::entries::file::{DimensionEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::error::{Fault, Faults, StudyFault, fault};
use sensitol::warning::Warning;
use sensitol_numeric::correlation::{JointLaw, Pair, Rows};
use sensitol_numeric::names::nearest;

/// Smallest number of common rows: fewer do not show a correlation of columns.
const LEAST: usize = 5;
/// Greatest number of lines that a warning names.
const NAMED: usize = 5;

/// Dimensions that are measured on the same parts or lie within one zone.
pub(crate) struct Block {
    pub(crate) dimensions: Vec<String>,
    /// Correlations of all pairs in the rows that every dimension has; empty for a zone.
    pub(crate) pairs: Vec<Pair>,
    /// Joint distribution; None if the dimensions follow the normal copula of `pairs`.
    pub law: Option<JointLaw>,
}

/// A measured dimension of a study.
struct Member<'f> {
    name: &'f Spanned<String>,
    entry: &'f DimensionEntry,
    file: &'f Spanned<String>,
    /// Column with the part number, which joins it to other files; None if it is joined by lines.
    serial: Option<&'f Spanned<String>>,
}

/// Finds the rows that belong together and keeps them in `data`. Faults of a single column are reported where the column is read.
pub(crate) fn blocks(file: &StudyFile, data: &mut Data<'_>) -> Result<Vec<Block>, Faults> {
    let mut faults = Faults::default();
    let mut members: Vec<Member<'_>> = Vec::new();
    for (name, entry) in &file.dimensions.0 {
        let entry = entry.get_ref();
        let at = |span, key: &str, found| fault(span, format!("dimensions.{}.{key}", name.get_ref()), found);
        let Some(measured) = &entry.measured else {
            let keys = [
                ("joint", entry.joint.as_ref().map(Spanned::span)),
                ("match", entry.serial.as_ref().map(Spanned::span)),
            ];
            for (key, span) in keys {
                if let Some(span) = span {
                    let instead = format!("`{key}` is for measured values: write measured = \"values.csv\" beside it");
                    faults.0.push(at(span, key, StudyFault::MissingKey { key: "measured".into(), instead }));
                }
            }
            continue;
        };
        let joint = entry.joint.as_ref().is_none_or(|joint| *joint.get_ref());
        if let (false, Some(serial)) = (joint, &entry.serial) {
            let why = "contradict each other: parts with a common number are measured together".to_owned();
            faults.0.push(at(serial.span(), "match", StudyFault::Conflict { a: "joint", b: "match", why }));
        }
        if joint {
            members.push(Member { name, entry, file: measured, serial: entry.serial.as_ref() });
        }
    }
    faults.none()?;
    let mut groups: Vec<Vec<Member<'_>>> = Vec::new();
    for member in members {
        let same = |other: &Member<'_>| match (member.serial, other.serial) {
            (Some(a), Some(b)) => a.get_ref() == b.get_ref(),
            (None, None) => member.file.get_ref() == other.file.get_ref(),
            _ => false,
        };
        match groups.iter_mut().find(|group| same(&group[0])) {
            Some(group) => group.push(member),
            None => groups.push(vec![member]),
        }
    }
    let mut faults = Faults::default();
    let found: Vec<Block> = (groups.iter().filter(|group| group.len() > 1))
        .filter_map(|group| faults.take(block(group, data)).flatten())
        .collect();
    faults.none().map(|()| found)
}

/// Block of dimensions that are measured on the same parts. Returns None if a column cannot be read or too few rows are common.
fn block(group: &[Member<'_>], data: &mut Data<'_>) -> Result<Option<Block>, Fault> {
    // Values and lines of each member, by the key of the part.
    let mut columns: Vec<HashMap<String, (f64, u64)>> = Vec::with_capacity(group.len());
    for member in group {
        let name = member.entry.column.as_ref().map(|column| column.get_ref().as_str());
        let Ok(column) = data.column(member.file.get_ref(), name) else { return Ok(None) };
        let keys = match member.serial {
            None => column.lines.iter().map(|line| (*line, line.to_string())).collect(),
            Some(serial) => serials(member, serial, data)?,
        };
        let of = |(value, line): (&f64, &u64)| Some((keys.get(line)?.clone(), (*value, *line)));
        columns.push(column.values.iter().zip(&column.lines).filter_map(of).collect());
    }
    let mut common: Vec<&String> =
        columns[0].keys().filter(|key| columns[1..].iter().all(|column| column.contains_key(*key))).collect();
    // The order of the first file makes sums independent of the order of a hash map.
    common.sort_by_key(|key| columns[0][*key].1);
    for (member, column) in group.iter().zip(&columns) {
        let kept: HashSet<u64> = common.iter().map(|key| column[*key].1).collect();
        if member.serial.is_some() && kept.len() < column.len() {
            let mut lines: Vec<u64> =
                column.values().map(|(_, line)| *line).filter(|line| !kept.contains(line)).collect();
            lines.sort_unstable();
            let unmatched = lines.len();
            lines.truncate(NAMED);
            let (dimension, file) = (member.name.get_ref().clone(), member.file.get_ref().clone());
            data.warnings.push(Warning::UnmatchedRows { dimension, file, unmatched, lines });
        }
        data.keep(member.name.get_ref(), kept);
    }
    if common.len() < LEAST {
        // The fault of too few values is reported where the column is read.
        return Ok(None);
    }
    let rows: Vec<Vec<f64>> = columns.iter().map(|column| common.iter().map(|key| column[*key].0).collect()).collect();
    let names: Vec<String> = group.iter().map(|member| member.name.get_ref().clone()).collect();
    let mut pairs = Vec::new();
    for a in 0..names.len() {
        for b in a + 1..names.len() {
            // A column that does not vary is reported where it is read.
            if let Some(value) = correlation(&rows[a], &rows[b]) {
                pairs.push(Pair { between: [names[a].clone(), names[b].clone()], value });
            }
        }
    }
    // A fitted distribution has no rows, so the dimensions vary together by a copula.
    let fitted =
        group.iter().any(|member| member.entry.model.as_ref().is_some_and(|model| model.get_ref() == "pearson"));
    let still = |column: &Vec<f64>| column.iter().all(|value| *value == column[0]);
    let law = (!fitted && !rows.iter().any(still)).then(|| JointLaw::Rows(Arc::new(Rows::of(&rows))));
    Ok(Some(Block { dimensions: names, pairs, law }))
}

/// Part number of every line.
fn serials(member: &Member<'_>, serial: &Spanned<String>, data: &mut Data<'_>) -> Result<HashMap<u64, String>, Fault> {
    let at = |found: DataFault| {
        fault(serial.span(), format!("dimensions.{}.match", member.name.get_ref()), StudyFault::Data(found))
    };
    let file = member.file.get_ref();
    let (known, texts) = data.texts(file, serial.get_ref()).map_err(at)?;
    let problem = |line, problem| {
        at(DataFault { file: file.clone(), line, column: Some(serial.get_ref().clone()), problem: Box::new(problem) })
    };
    let Some(texts) = texts else {
        let nearest = nearest(serial.get_ref(), known.iter().map(String::as_str)).map(str::to_owned);
        let name = serial.get_ref().clone();
        return Err(at(DataFault {
            file: file.clone(),
            line: None,
            column: None,
            problem: Box::new(DataProblem::UnknownColumn { name, nearest, known }),
        }));
    };
    let mut first: HashMap<&String, u64> = HashMap::new();
    for (line, text) in texts.iter().filter(|(_, text)| !text.is_empty()) {
        if let Some(&other) = first.get(text) {
            return Err(problem(Some(*line), DataProblem::SerialTwice { text: text.clone(), other }));
        }
        first.insert(text, *line);
    }
    Ok(texts.into_iter().filter(|(_, text)| !text.is_empty()).collect())
}

/// Pearson's correlation coefficient. Returns None if one of the two does not vary.
fn correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    let n = x.len() as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let sum = |f: &dyn Fn(f64, f64) -> f64| x.iter().zip(y).map(|(x, y)| f(x - mx, y - my)).sum::<f64>();
    let (xx, yy, xy) = (sum(&|x, _| x * x), sum(&|_, y| y * y), sum(&|x, y| x * y));
    (xx > 0.0 && yy > 0.0).then(|| (xy / (xx * yy).sqrt()).clamp(-1.0, 1.0))
}
