//! Examples of assemblies in space beside their plane studies and closed forms.

use sensitol::allocation::{Allocation, AllocationOptions, allocate_written};
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_testing::{close, parse, random_points, relative, repository};

fn study(path: &str) -> Study {
    Study::read(&repository(&format!("examples/{path}.toml"))).unwrap()
}

/// Values of a characteristic at points of the box of tolerances.
fn values(study: &Study, characteristic: &str, points: &Points) -> Vec<f64> {
    let output = study.problem.characteristics().iter().position(|one| one.name() == characteristic).unwrap();
    let output = study.problem.outputs()[output];
    let mut found = Responses::open(points.rows(), 1);
    study.problem.function().evaluate(&Request::values(points, &[output]), &Run::to_the_end(), &mut found);
    (0..points.rows()).map(|row| found.value(row, 0).unwrap()).collect()
}

/// The largest difference of two studies of the same dimensions at random points of their tolerances.
fn difference(a: &Study, b: &Study, characteristic: &str) -> f64 {
    let names = |study: &Study| {
        study.problem.dimensions().iter().map(|dimension| dimension.name().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names(a), names(b));
    let points = Points::from_rows(&random_points(&a.problem, 1000));
    let pairs = values(a, characteristic, &points).into_iter().zip(values(b, characteristic, &points));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Bodies of a plane assembly give what its loops give.
#[test]
fn plane_studies_return_as_bodies() {
    let (bodies, loops) = (study("one-way-clutch/bodies"), study("one-way-clutch/study"));
    // The angle is 7 degrees, and the height of the roller of 39 mm decides it with a slope of 0.2 rad/mm: rounding of 1e-14 of the size
    // is 1e-11 degrees.
    assert!(difference(&bodies, &loops, "angle") < 1e-10);
    let (bodies, loops) = (study("stacked-blocks-loops/bodies"), study("stacked-blocks-loops/study"));
    assert!(difference(&bodies, &loops, "gap") < 1e-10);
}

/// Every digit of the report of the plane study returns: moments, slopes and shares.
#[test]
fn bodies_have_the_figures_of_the_plane_study() {
    for (bodies, plane, characteristic) in [
        ("one-way-clutch/bodies", "one-way-clutch/study", "angle"),
        ("stacked-blocks-loops/bodies", "stacked-blocks-loops/contacts", "gap"),
    ] {
        let [a, b] = [bodies, plane].map(|path| {
            let found = analyze(&study(path).problem, &Method::Full.into()).unwrap();
            found.characteristics.into_iter().find(|one| one.characteristic.name() == characteristic).unwrap()
        });
        let (of_bodies, of_plane) = (a.moments.unwrap(), b.moments.unwrap());
        relative(of_bodies.mean(), of_plane.mean(), 1e-10);
        relative(of_bodies.sigma(), of_plane.sigma(), 1e-7);
        for (row, other) in a.sensitivities.iter().zip(&b.sensitivities) {
            close(row.first.unwrap(), other.first.unwrap(), 1e-8, 1.0);
        }
    }
}

/// Studies with parts among the examples.
fn spatial() -> Vec<(String, Study)> {
    let mut found = Vec::new();
    for folder in std::fs::read_dir(repository("examples")).unwrap() {
        for file in std::fs::read_dir(folder.unwrap().path()).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_some_and(|of| of == "toml") && !path.ends_with("tests.toml") {
                let text = std::fs::read_to_string(&path).unwrap();
                if text.contains("\n[parts.") {
                    found.push((path.display().to_string(), Study::read(&path).unwrap()));
                }
            }
        }
    }
    assert!(found.len() >= 9, "{}", found.len());
    found
}

/// The expanded study of every example in space has the figures and the verdicts of the study, to the last digit: both are one function.
#[test]
fn expanded_examples_have_the_same_figures() {
    for (path, own) in spatial() {
        let plain = parse(&own.expanded).unwrap_or_else(|error| panic!("{path}: {error}"));
        let [own, plain] = [&own, &plain].map(|study| analyze(&study.problem, &study.options).unwrap());
        assert_eq!(own.run.evaluations, plain.run.evaluations, "{path}");
        assert_eq!(own.characteristics, plain.characteristics, "{path}");
    }
}

/// The expanded study of the housing is allocated as the study is: the same tolerances, costs and verdicts, and the same written numbers.
#[test]
fn the_expanded_housing_is_allocated_the_same() {
    let own = study("housing-allocation/study");
    let plain = parse(&own.expanded).unwrap();
    let [of_own, of_plain] = [&own, &plain].map(|study| {
        let written = |problem: &sensitol::Problem| study.written_dimensions(problem);
        let (task, options) = (study.allocation_task(), AllocationOptions::default());
        allocate_written(&study.problem, &task, &options, &Run::to_the_end(), &written).unwrap()
    });
    assert_eq!(of_own.status, of_plain.status);
    let rows = |found: &Allocation| -> Vec<(usize, f64, Option<f64>)> {
        found.tolerances.iter().map(|row| (row.dimension, row.after, row.cost_after)).collect()
    };
    assert_eq!(rows(&of_own), rows(&of_plain));
    let [own, plain] = [(&own, &of_own), (&plain, &of_plain)].map(|(study, found)| {
        let text = study.rewritten(&found.problem).unwrap().text;
        let dimensions = parse(&text).unwrap().problem.dimensions().to_vec();
        dimensions.iter().map(|one| (one.name().to_owned(), one.half_band(), one.nominal())).collect::<Vec<_>>()
    });
    assert_eq!(own, plain);
}

/// The crank slider is its closed form at every point.
#[test]
fn a_crank_slider_is_its_closed_form_at_every_point() {
    let (space, formula) = (study("crank-slider-space/study"), study("crank-slider-space/closed-form"));
    assert!(difference(&space, &formula, "x") < 1e-10);
}

/// Small displacements by hand have an error of the second order: tilts of 1e-3 times lengths of 100 mm times the same again, some 1e-4 mm.
#[test]
fn a_located_plate_is_its_closed_form_to_second_order() {
    let (space, formula) = (study("locating-plate/study"), study("locating-plate/closed-form"));
    let mobility = space.mobility.as_ref().unwrap();
    assert_eq!((mobility.unknowns, mobility.equations, mobility.free.len()), (6, 6, 0));
    for characteristic in ["x", "y", "height"] {
        assert!(difference(&space, &formula, characteristic) < 2e-4, "{characteristic}");
    }
    let [a, b] = [&space, &formula].map(|study| analyze(&study.problem, &Method::Full.into()).unwrap());
    for (a, b) in a.characteristics.iter().zip(&b.characteristics) {
        relative(a.moments.unwrap().sigma(), b.moments.unwrap().sigma(), 1e-4);
    }
}

/// The slopes of the platform are those of the inverse of its unit vectors.
#[test]
fn a_platform_is_linear_to_second_order() {
    let (space, linear) = (study("six-legged-platform/study"), study("six-legged-platform/linear"));
    for characteristic in ["x", "y", "z"] {
        // Legs move by 0.1 of 140 mm, so that the second order is some 0.1^2/140.
        assert!(difference(&space, &linear, characteristic) < 1e-3, "{characteristic}");
    }
    let [a, b] = [&space, &linear].map(|study| analyze(&study.problem, &Method::Full.into()).unwrap());
    for (a, b) in a.characteristics.iter().zip(&b.characteristics) {
        relative(a.moments.unwrap().sigma(), b.moments.unwrap().sigma(), 1e-5);
        for (row, other) in a.sensitivities.iter().zip(&b.sensitivities) {
            close(row.first.unwrap(), other.first.unwrap(), 1e-6, 1.0);
        }
    }
}
