//! From `[[correlation]]` to pairs of dimensions that vary together.

use super::error::{Fault, StudyFault, fault};
use super::joint::Block;
use super::spanned::Spanned;
use super::together::CorrelationEntry;
use sensitol::problem::Problem;
use sensitol::warning::Warning;
use sensitol_numeric::correlation::{self, CorrelationError, Pair, Refusal};

/// Rounds in which correlations of rows are brought to what their distributions allow.
const ROUNDS: usize = 8;
/// A correlation that is off by less is the same in print.
const TRIFLE: f64 = 0.001;
/// Correlations at an end of the possible range are moved inside by this factor.
const INSIDE: f64 = 1.0 - 1e-9;

/// The problem with its dimensions correlated as its pairs say, as the rows of measured files are, and within zones.
pub(super) fn correlated(
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
            // All pairs together: the first of them has to stand for the whole.
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

/// The correlation of rows that is farthest off what is taken, where that is more than a trifle.
fn moved(taken: &[Pair], blocks: &[&Block]) -> Option<Warning> {
    let rows = blocks.iter().flat_map(|block| &block.pairs);
    let off = |(taken, rows): &(&Pair, &Pair)| (taken.value - rows.value).abs();
    let (taken, rows) = taken.iter().zip(rows).max_by(|a, b| off(a).total_cmp(&off(b)))?;
    let correlation = [rows.value, taken.value];
    (off(&(taken, rows)) > TRIFLE).then(|| Warning::RowsByCopula { dimensions: rows.between.clone(), correlation })
}

/// Brings correlations of rows to the nearest that distributions by a copula have; false where that is not what is wrong.
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

/// The fault of a pair of dimensions whose rows give their correlation already.
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
