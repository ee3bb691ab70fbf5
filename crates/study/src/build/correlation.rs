//! Reads `[[correlation]]`: pairs of dimensions that vary together.

use crate::build::measured_rows::Block;
use crate::entries::correlation_entry::CorrelationEntry;
use crate::entries::spanned::Spanned;
use crate::error::{Fault, StudyFault, fault};
use sensitol::problem::Problem;
use sensitol::warning::Warning;
use sensitol_numeric::correlation::{self, CorrelationError, Pair, Refusal};

/// Greatest number of rounds that move correlations of rows into the range that their distributions permit.
const ROUNDS: usize = 8;
/// Difference of correlations below which no warning is given, since it does not show in print.
const TRIFLE: f64 = 0.001;
/// Factor that moves a correlation at the end of its range to the inside.
const INSIDE: f64 = 1.0 - 1e-9;

/// Problem with the correlations of the study, those of the rows of measured files, and the zones.
pub(crate) fn correlated(
    problem: Problem,
    entries: &[Spanned<CorrelationEntry>],
    blocks: &[Block],
) -> Result<(Problem, Option<Warning>), Fault> {
    let pair = |entry: &Spanned<CorrelationEntry>| {
        let entry = entry.get_ref();
        let (a, b) = entry.between.get_ref().clone();
        Pair { between: [a, b], value: *entry.value.get_ref() }
    };
    for (index, entry) in entries.iter().enumerate() {
        beside_rows(entry, blocks).map_or(Ok(()), |found| {
            Err(fault(entry.get_ref().between.span(), format!("correlation[{}].between", index + 1), found))
        })?;
    }
    let mut pairs: Vec<Pair> = entries.iter().map(pair).collect();
    let (copulas, joint): (Vec<&Block>, Vec<&Block>) = blocks.iter().partition(|block| block.law.is_none());
    pairs.extend(copulas.iter().flat_map(|block| block.pairs.clone()));
    let place = |name: &String| problem.dimensions().iter().position(|dimension| dimension.name() == name);
    let law = |block: &&Block| {
        let members = block.dimensions.iter().map(place).collect::<Option<Vec<usize>>>()?;
        Some(correlation::Block { members, law: block.law.clone()? })
    };
    let joint: Vec<correlation::Block> = joint.iter().filter_map(law).collect();
    let at = |error: CorrelationError| {
        let Some(index) = error.pair.filter(|&index| index < entries.len()) else {
            // A fault of all pairs together is shown at the first pair.
            let span = entries.first().map(Spanned::span);
            return Fault { span, key: "correlation".into(), fault: Box::new(StudyFault::Correlation(error.refusal)) };
        };
        let entry = entries[index].get_ref();
        let (span, key) = match &error.refusal {
            Refusal::NoCoefficient { .. } | Refusal::Unreachable { .. } => (entry.value.span(), "value"),
            _ => (entry.between.span(), "between"),
        };
        fault(span, format!("correlation[{}].{key}", index + 1), StudyFault::Correlation(error.refusal))
    };
    for _ in 0..ROUNDS {
        match problem.clone().jointly(&pairs, joint.clone()) {
            Ok(problem) => return Ok((problem, moved(&pairs[entries.len()..], &copulas))),
            Err(error) => {
                if !nearer(&mut pairs, entries.len(), &error) {
                    return Err(at(error));
                }
            }
        }
    }
    let problem = problem.jointly(&pairs, joint).map_err(at)?;
    Ok((problem, moved(&pairs[entries.len()..], &copulas)))
}

/// Warning of the correlation of rows that had to be moved farthest. Returns None if it moved less than [`TRIFLE`].
fn moved(taken: &[Pair], blocks: &[&Block]) -> Option<Warning> {
    let rows = blocks.iter().flat_map(|block| &block.pairs);
    let off = |(taken, rows): &(&Pair, &Pair)| (taken.value - rows.value).abs();
    let (taken, rows) = taken.iter().zip(rows).max_by(|a, b| off(a).total_cmp(&off(b)))?;
    let correlation = [rows.value, taken.value];
    (off(&(taken, rows)) > TRIFLE).then(|| Warning::RowsByCopula { dimensions: rows.between.clone(), correlation })
}

/// Moves correlations of rows to the nearest ones that a copula of the distributions can have. Returns false if the error has another
/// reason.
fn nearer(pairs: &mut [Pair], written: usize, error: &CorrelationError) -> bool {
    match (&error.refusal, error.pair) {
        (Refusal::Unreachable { range, .. }, Some(index)) if index >= written => {
            pairs[index].value = pairs[index].value.clamp(range[0] * INSIDE, range[1] * INSIDE);
            true
        }
        (Refusal::NoSuchMatrix { nearest } | Refusal::NotForTheseDistributions { nearest }, _) => {
            let rows = &mut pairs[written..];
            for pair in rows.iter_mut() {
                let found = nearest.iter().find(|(between, _)| {
                    *between == pair.between || [&between[1], &between[0]] == [&pair.between[0], &pair.between[1]]
                });
                if let Some((_, value)) = found {
                    pair.value = value * INSIDE;
                }
            }
            !rows.is_empty()
        }
        _ => false,
    }
}

/// Fault of a pair whose rows or zone already determine how it varies. Returns None if the pair may have a correlation.
fn beside_rows(entry: &Spanned<CorrelationEntry>, blocks: &[Block]) -> Option<StudyFault> {
    let (a, b) = entry.get_ref().between.get_ref();
    let block = blocks.iter().find(|block| block.dimensions.iter().any(|name| name == a || name == b))?;
    let [has_a, has_b] = [a, b].map(|name| block.dimensions.contains(name));
    if has_a && has_b && block.pairs.is_empty() && a != b {
        return Some(StudyFault::CorrelationInZone { between: [a.clone(), b.clone()] });
    }
    if has_a && has_b {
        let same = |pair: &&Pair| pair.between.contains(a) && pair.between.contains(b);
        let value = block.pairs.iter().find(same).filter(|_| a != b)?.value;
        return Some(StudyFault::CorrelationOfRows { between: [a.clone(), b.clone()], value });
    }
    let inside = if has_a { a } else { b };
    let others = block.dimensions.iter().filter(|name| *name != inside).map(|name| format!("`{name}`"));
    let others = others.collect::<Vec<_>>().join(", ");
    Some(StudyFault::CorrelationBesideRows { inside: inside.clone(), others })
}
