//! Failed points that a journal holds: a later run gets those at which the model itself has no value.

use std::path::Path;

use sensitol::Dimension;
use sensitol::assembly::{AssemblyFunction, Points, RecordedFailure, Request, Responses, Run, Signature};
use sensitol_external::journal::Journaled;
use sensitol_external::process::Process;
use sensitol_external::{Greeting, Settings};
use sensitol_testing::repository;

/// Child in a mode that concerns the point with a = 13, with the journal `folder/a.sqlite`.
fn journaled(folder: &Path, mode: &str) -> Journaled {
    let script = repository("tests/children/child.py").display().to_string();
    let settings = Settings::new(["python3", &script, mode]).with_retries(0).with_sentinels(false);
    let signature = Signature::of_names(["a", "b"], ["sum", "product"]);
    let process = Process::new(signature, Greeting::new(vec![1.0, 2.0]), settings);
    Journaled::new(process, folder.join("a.sqlite"), Vec::new())
}

/// Evaluates points with b = 2.
fn ask(model: &Journaled, a: &[f64]) -> Responses {
    let points = Points::from_rows(&a.iter().map(|&a| [a, 2.0]).collect::<Vec<_>>());
    let mut out = Responses::open(a.len(), 2);
    model.evaluate(&Request::values(&points, &[0, 1]), &Run::to_the_end(), &mut out);
    out
}

fn failure(output: usize) -> RecordedFailure {
    RecordedFailure { output, point: vec![Some(13.0), Some(2.0)] }
}

#[test]
fn a_later_run_gets_the_points_without_a_value() {
    let folder = tempfile::tempdir().unwrap();
    let first = ask(&journaled(folder.path(), "partial"), &[1.0, 5.0, 13.0]);
    assert_eq!((first.value(2, 0), first.value(2, 1)), (Some(15.0), None));
    let later = journaled(folder.path(), "partial");
    // Until the nominal point was evaluated again, the answers may belong to another model.
    assert_eq!(later.recorded_failures(&[0, 1]), []);
    ask(&later, &[1.0]);
    assert_eq!(later.recorded_failures(&[0, 1]), [failure(1)]);
    assert_eq!(later.recorded_failures(&[0]), []);
    // Another script or mode is another model.
    let other = journaled(folder.path(), "good");
    ask(&other, &[1.0]);
    assert_eq!(other.recorded_failures(&[0, 1]), []);
}

#[test]
fn a_failure_of_the_whole_point_counts_for_every_output() {
    let folder = tempfile::tempdir().unwrap();
    ask(&journaled(folder.path(), "error"), &[1.0, 13.0]);
    let later = journaled(folder.path(), "error");
    ask(&later, &[1.0]);
    assert_eq!(later.recorded_failures(&[0, 1]), [failure(1), failure(0)]);
}

/// Another attempt may succeed, so nothing is known about the point.
#[test]
fn a_crash_is_no_recorded_failure() {
    let folder = tempfile::tempdir().unwrap();
    let first = ask(&journaled(folder.path(), "crash"), &[1.0, 13.0]);
    assert!(first.error(1, 0).is_some());
    let later = journaled(folder.path(), "crash");
    ask(&later, &[1.0]);
    assert_eq!(later.recorded_failures(&[0, 1]), []);
}

/// A program that asks for another attempt, such as one that waits for a licence, says nothing about the point.
#[test]
fn a_failure_that_may_pass_is_not_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let first = ask(&journaled(folder.path(), "error-always"), &[1.0, 13.0]);
    assert!(first.error(1, 0).is_some_and(|error| error.to_string().contains("licence busy")));
    let later = journaled(folder.path(), "error-always");
    assert_eq!(ask(&later, &[1.0, 13.0]).extra(), 0, "the point is evaluated again");
    assert_eq!(later.recorded_failures(&[0, 1]), []);
}

/// A band includes its ends. Inputs that the model does not receive may have any value.
#[test]
fn the_bands_decide_which_failures_count() {
    let dimensions =
        |tolerance: f64| [Dimension::normal("a", 12.0, tolerance).unwrap(), Dimension::fixed("b", 2.0).unwrap()];
    assert!(failure(0).is_within(&dimensions(1.0)) && !failure(0).is_within(&dimensions(0.999)));
    let elsewhere = RecordedFailure { output: 0, point: vec![Some(13.0), Some(2.1)] };
    assert!(!elsewhere.is_within(&dimensions(1.0)));
    let unknown = RecordedFailure { output: 0, point: vec![Some(13.0), None] };
    assert!(unknown.is_within(&dimensions(1.0)));
}
