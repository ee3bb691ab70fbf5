//! Extremes of an output over the range of an input, for many points at once.

use crate::assembly::motion::Motion;
use crate::assembly::motion::brent::BrentSearch;
use crate::assembly::{AssemblyFunction, EvaluationError, Points, Request, Responses, Run};

/// Places that are refined at each point: the two with the least values between the steps of the scan.
const REFINED: usize = 2;
/// Difference of two least values, as a part of the range of values, below which neither is the only one.
const EQUAL: f64 = 1e-9;

/// Least value at one point, times the sign of the motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct LeastPlace {
    /// Place of the least value.
    pub(super) at: f64,
    pub(super) value: f64,
    /// True if no other place that was refined has an equal value.
    pub(super) alone: bool,
}

/// Least values at all points, with the evaluations that they took.
pub(super) struct LeastPlaces {
    pub(super) places: Vec<Option<LeastPlace>>,
    pub(super) errors: Vec<Option<EvaluationError>>,
    pub(super) spent: i64,
    pub(super) reused: usize,
}

/// Scans the range at every point, and refines the lowest places. A point at which a step has no value has no extreme.
pub(super) fn extremes(
    function: &dyn AssemblyFunction,
    motion: &Motion,
    refined: usize,
    points: &Points,
    run: &Run<'_>,
) -> LeastPlaces {
    let rows = points.rows();
    let mut found = LeastPlaces { places: vec![None; rows], errors: vec![None; rows], spent: 0, reused: 0 };
    let mut scan = Scan { function, motion, run, found: &mut found };
    let mut at = points.clone();
    let mut values: Vec<Vec<f64>> = Vec::with_capacity(motion.steps + 1);
    for step in 0..=motion.steps {
        at.column_mut(motion.over).fill(motion.place(step));
        let answers = scan.ask(&at);
        if answers.has_open_entries() {
            return found;
        }
        for row in 0..rows {
            if let Some(error) = answers.error(row, 0) {
                scan.found.errors[row].get_or_insert_with(|| error.clone());
            }
        }
        values.push(answers.column(0).iter().map(|value| motion.sign() * value).collect());
    }
    let mut searches: Vec<(usize, BrentSearch)> = Vec::new();
    for row in (0..rows).filter(|&row| scan.found.errors[row].is_none()) {
        let column: Vec<f64> = values.iter().map(|step| step[row]).collect();
        searches.extend(lowest(motion, &column).into_iter().map(|search| (row, search)));
    }
    for _ in 0..refined {
        let open: Vec<usize> = (0..searches.len()).filter(|&index| !searches[index].1.is_done()).collect();
        if open.is_empty() {
            break;
        }
        let places: Vec<f64> = open.iter().map(|&index| searches[index].1.next_place()).collect();
        let at = Points::written(open.len(), points.dimensions(), |dimension, column| {
            let from = points.column(dimension);
            for (to, &index) in column.iter_mut().zip(&open) {
                *to = from[searches[index].0];
            }
            if dimension == motion.over {
                column.copy_from_slice(&places);
            }
        });
        let answers = scan.ask(&at);
        if answers.has_open_entries() {
            return found;
        }
        for (place, &index) in open.iter().enumerate() {
            let value = answers.value(place, 0).map_or(f64::INFINITY, |value| motion.sign() * value);
            searches[index].1.observe(places[place], value);
        }
    }
    // The searches are in the order of their rows.
    let mut ordered = searches.iter().peekable();
    for row in 0..rows {
        let spread = values
            .iter()
            .map(|step| step[row])
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
        while let Some((_, search)) = ordered.next_if(|(of, _)| *of == row) {
            let (at, value) = search.best();
            found.places[row] = Some(better(found.places[row], LeastPlace { at, value, alone: true }, spread, motion));
        }
    }
    found
}

/// Lesser of two least places.
fn better(known: Option<LeastPlace>, new: LeastPlace, [low, high]: [f64; 2], motion: &Motion) -> LeastPlace {
    let Some(known) = known else { return new };
    let [from, to] = motion.range;
    let apart = (known.at - new.at).abs() > 1e-6 * (to - from);
    // Both ends of a whole turn are the same place.
    let ends = (known.at == from && new.at == to) || (known.at == to && new.at == from);
    let equal = (known.value - new.value).abs() <= EQUAL * (high - low);
    let least = if new.value < known.value { new } else { known };
    LeastPlace { alone: known.alone && !(equal && apart && !ends), ..least }
}

/// Searches about the lowest local minima of a scan, by the vertices of parabolas through three steps.
fn lowest(motion: &Motion, column: &[f64]) -> Vec<BrentSearch> {
    let last = motion.steps;
    let mut found: Vec<(f64, usize)> = Vec::new();
    for step in 0..=last {
        let below = step.checked_sub(1).map(|before| column[before]);
        let above = column.get(step + 1).copied();
        // Of equal neighbours the first one counts.
        let least = below.is_none_or(|value| column[step] < value) && above.is_none_or(|value| column[step] <= value);
        if !least {
            continue;
        }
        let vertex = match (below, above) {
            (Some(a), Some(b)) if a + b - 2.0 * column[step] > 0.0 => {
                column[step] - 0.125 * (b - a).powi(2) / (a + b - 2.0 * column[step])
            }
            _ => column[step],
        };
        found.push((vertex, step));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [from, to] = motion.range;
    let search = |&(_, step): &(f64, usize)| {
        let ends = [step.saturating_sub(1), (step + 1).min(last)];
        let known = ends.map(|end| (motion.place(end), column[end]));
        BrentSearch::new(known, (motion.place(step), column[step]), to - from)
    };
    found.iter().take(REFINED).map(search).collect()
}

struct Scan<'a, 'r> {
    function: &'a dyn AssemblyFunction,
    motion: &'a Motion,
    run: &'a Run<'r>,
    found: &'a mut LeastPlaces,
}

impl Scan<'_, '_> {
    fn ask(&mut self, points: &Points) -> Responses {
        let mut answers = Responses::open(points.rows(), 1);
        self.function.evaluate(&Request::values(points, &[self.motion.of]), self.run, &mut answers);
        self.found.spent += answers.answered().count() as i64 + answers.extra() + answers.count_reused() as i64;
        self.found.reused += answers.count_reused();
        answers
    }
}
