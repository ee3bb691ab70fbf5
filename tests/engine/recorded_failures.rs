//! Failed points of earlier runs: which of them an analysis counts, in each state and for each output.

use std::collections::BTreeMap;

use sensitol::assembly::{AssemblyFunction, RecordedFailure, Request, Responses, Run, Signature};
use sensitol::{Characteristic, Dimension, Problem, SpecLimits, Warning, analyze};

/// Costly function `y = a - b` with a journal that holds failed points. It has no value where `a` exceeds `edge`.
struct Recorded {
    signature: Signature,
    failed: Vec<[Option<f64>; 2]>,
    edge: f64,
}

impl Recorded {
    fn new(failed: &[[Option<f64>; 2]], edge: f64) -> Self {
        let signature = Signature { costly: true, ..Signature::of_names(["a", "b"], ["y"]) };
        Self { signature, failed: failed.to_vec(), edge }
    }
}

impl AssemblyFunction for Recorded {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn recorded_failures(&self, outputs: &[usize]) -> Vec<RecordedFailure> {
        let failure = |point: &[Option<f64>; 2]| RecordedFailure { output: 0, point: point.to_vec() };
        self.failed.iter().filter(|_| outputs == [0]).map(failure).collect()
    }

    fn evaluate(&self, request: &Request<'_>, _: &Run<'_>, out: &mut Responses) {
        for row in 0..out.rows() {
            let x = request.points.row(row);
            out.set(row, 0, if x[0] > self.edge { f64::NAN } else { x[0] - x[1] });
        }
    }
}

/// Problem with a ± 0.1 about this nominal value, and b = 5 ± 0.2.
fn problem(a: f64, function: Recorded) -> Problem {
    let dimensions = [Dimension::normal("a", a, 0.1).unwrap(), Dimension::normal("b", 5.0, 0.2).unwrap()];
    let limits = SpecLimits::new(Some(4.0), Some(8.0)).unwrap();
    let gap = Characteristic::new("y").with_limits(limits);
    Problem::new(dimensions, function).unwrap().asking([gap]).unwrap()
}

/// Points without a value of every characteristic, and the numbers in the warnings of recorded failures.
fn counts(problem: &Problem) -> (Vec<usize>, BTreeMap<String, usize>) {
    let analysis = analyze(problem, &Default::default()).unwrap();
    let warned = analysis.warnings.iter().filter_map(|warning| match warning {
        Warning::RecordedFailures { characteristic, failed, .. } => Some((characteristic.clone(), *failed)),
        _ => None,
    });
    let warned = warned.collect();
    (analysis.characteristics.iter().map(|one| one.missing.without_value).collect(), warned)
}

#[test]
fn failures_within_all_bands_count() {
    let near = [Some(10.05), Some(5.15)];
    let failed =
        [near, [Some(10.1), Some(4.8)], [Some(10.05), None], [Some(10.11), Some(5.0)], [Some(10.0), Some(5.3)]];
    let found = counts(&problem(10.0, Recorded::new(&failed, f64::INFINITY)));
    assert_eq!(found, (vec![3], BTreeMap::from([("y".to_owned(), 3)])));
    let none = counts(&problem(10.0, Recorded::new(&failed[3..], f64::INFINITY)));
    assert_eq!(none, (vec![0], BTreeMap::new()));
    // The yield is as uncertain as if the points had failed in this run.
    let analysis = analyze(&problem(10.0, Recorded::new(&[near], f64::INFINITY)), &Default::default()).unwrap();
    assert_eq!(analysis.characteristics[0].yield_interval().unwrap()[0], 0.0);
}

/// The journal holds failures of this run too. They count once.
#[test]
fn failures_of_this_run_are_counted_already() {
    let (own, warned) = counts(&problem(10.0, Recorded::new(&[], 10.06)));
    assert!(own[0] > 0 && warned.is_empty());
    // The first failed point of the run, as its warning states it, and another one.
    let analysis = analyze(&problem(10.0, Recorded::new(&[], 10.06)), &Default::default()).unwrap();
    let text = analysis.warnings.iter().find_map(|warning| match warning {
        Warning::FailedPoints { point, .. } => Some(point.clone()),
        _ => None,
    });
    let text = text.unwrap();
    let coordinate = |name: &str, mean: f64| {
        let given = text.split(&format!("{name} = ")).nth(1);
        given.map_or(mean, |given| given.split(' ').next().unwrap().parse().unwrap())
    };
    let same = [Some(coordinate("a", 10.0)), Some(coordinate("b", 5.0))];
    let other = [Some(10.0999), Some(5.0)];
    let (all, warned) = counts(&problem(10.0, Recorded::new(&[same, other], 10.06)));
    assert_eq!((all[0], warned["y"]), (own[0] + 1, 1));
}

/// A state shifts the points that its model receives.
#[test]
fn states_shift_recorded_points() {
    let (cold, warm) = (10.0, 12.0);
    let failed = [[Some(12.05), Some(5.1)]];
    let cold = problem(cold, Recorded::new(&failed, f64::INFINITY));
    let warm = problem(warm, Recorded::new(&failed, f64::INFINITY));
    let both = cold.in_states(&[("cold", &cold), ("warm", &warm)]).unwrap();
    assert_eq!(counts(&both), (vec![0, 1], BTreeMap::from([("y [warm]".to_owned(), 1)])));
}
