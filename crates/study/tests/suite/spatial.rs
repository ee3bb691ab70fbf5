//! Assemblies in space: nominal values and slopes by independent routes, and invariances.

use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol::{Method, analyze};
use sensitol_study::{Study, StudyError};
use sensitol_testing::{close, data, parse, read, relative, repository};
use serde_json::Value;

fn oracle(name: &str) -> Value {
    let all = data("assembly3d.json");
    all.as_array().unwrap().iter().find(|case| case["name"] == name).unwrap().clone()
}

fn study(name: &str) -> Study {
    Study::read(&repository(&format!("tests/data/assembly3d/{name}.toml"))).unwrap()
}

/// Values of all characteristics at the nominal dimensions, with one of them moved.
pub fn values(study: &Study, moved: Option<(&str, f64)>) -> Vec<f64> {
    let dimensions = study.problem.dimensions();
    let point = dimensions.iter().map(|dimension| {
        let shift = moved.filter(|(name, _)| *name == dimension.name()).map_or(0.0, |(_, shift)| shift);
        dimension.nominal() + shift
    });
    let outputs: Vec<usize> = (0..study.problem.characteristics().len()).collect();
    let mut answers = Responses::open(1, outputs.len());
    let points = Points::from_rows(&[point.collect::<Vec<f64>>()]);
    study.problem.function().evaluate(&Request::values(&points, &outputs), &Run::to_the_end(), &mut answers);
    outputs.iter().map(|&output| answers.value(0, output).unwrap()).collect()
}

/// Slope of a characteristic by the central difference over two steps of 1e-4, whose error is of the order of 1e-8 here.
fn slope(study: &Study, output: usize, dimension: &str) -> f64 {
    const STEP: f64 = 1e-4;
    (values(study, Some((dimension, STEP)))[output] - values(study, Some((dimension, -STEP)))[output]) / (2.0 * STEP)
}

#[test]
fn a_crank_slider_in_space_is_its_closed_form() {
    let case = oracle("crank-slider-3d");
    let space = Study::read(&repository("examples/crank-slider-space/study.toml")).unwrap();
    close(values(&space, None)[0], case["expect"]["x"].as_f64().unwrap(), 1e-10, 1.0);
    for (name, expected) in case["expect"]["slopes"].as_object().unwrap() {
        let name = name.strip_suffix("_per_deg").unwrap_or(name);
        close(slope(&space, 0, name), expected.as_f64().unwrap(), 1e-6, 1.0);
    }
    let mobility = space.mobility.as_ref().unwrap();
    assert_eq!((mobility.unknowns, mobility.equations, mobility.free.len()), (18, 17, 1));
    assert!(mobility.free[0].contains("link turns about the line from link.small to link.big"), "{mobility:?}");
    // The moments are those of the closed form: both have exact derivatives.
    let formula = Study::read(&repository("examples/crank-slider-space/closed-form.toml")).unwrap();
    let moments =
        |study: &Study| analyze(&study.problem, &Method::Full.into()).unwrap().characteristics[0].moments.unwrap();
    let (a, b) = (moments(&space), moments(&formula));
    relative(a.mean(), b.mean(), 1e-12);
    relative(a.sigma(), b.sigma(), 1e-8);
}

#[test]
fn a_locator_moves_a_point_by_its_pads() {
    let case = oracle("locator-3-2-1");
    let study = study("locator");
    for (output, row) in case["expect"]["rows_xyz"].as_array().unwrap().iter().enumerate() {
        for (name, expected) in case["expect"]["columns"].as_array().unwrap().iter().zip(row.as_array().unwrap()) {
            // A difference over two steps of 1e-4 of a rotation has an error of some 1e-10.
            close(slope(&study, output, name.as_str().unwrap()), expected.as_f64().unwrap(), 1e-7, 1.0);
        }
    }
}

#[test]
fn a_platform_stands_where_its_legs_put_it() {
    let case = oracle("stewart");
    let study = study("stewart");
    let plate = study.poses.iter().find(|pose| pose.part == "plate").unwrap();
    for i in 0..3 {
        close(plate.rotation[i], case["expect"]["rotation_vector"][i].as_f64().unwrap(), 1e-10, 1.0);
        close(plate.translation[i], case["expect"]["translation"][i].as_f64().unwrap(), 1e-9, 1.0);
        for leg in 0..6 {
            let expected = case["expect"]["d_translation_dL"][i][leg].as_f64().unwrap();
            close(slope(&study, i, &format!("l{}", leg + 1)), expected, 1e-5, 1.0);
        }
    }
}

#[test]
fn a_clutch_as_bodies_is_the_published_one() {
    let case = oracle("clutch");
    let study = study("clutch");
    let phi = study.problem.characteristics().iter().position(|one| one.name() == "phi").unwrap();
    close(values(&study, None)[phi], case["expect"]["phi_deg"].as_f64().unwrap(), 1e-9, 1.0);
    for name in ["a", "c", "e"] {
        let expected = case["expect"]["slopes_rad_per_mm"][name].as_f64().unwrap();
        close(slope(&study, phi, name).to_radians(), expected, 1e-6, 1.0);
    }
    let mobility = study.mobility.as_ref().unwrap();
    assert_eq!((mobility.unknowns, mobility.equations, mobility.free.len()), (6, 4, 2));
}

#[test]
fn stacked_blocks_as_bodies_are_the_plane_study() {
    let case = oracle("blocks");
    let study = study("blocks");
    let gap = study.problem.characteristics().iter().position(|one| one.name() == "gap").unwrap();
    close(values(&study, None)[gap], case["expect"]["gap"].as_f64().unwrap(), 1e-9, 1.0);
    for (name, expected) in case["expect"]["slopes"].as_object().unwrap() {
        let name = name.strip_suffix("_per_deg").unwrap_or(name);
        close(slope(&study, gap, name), expected.as_f64().unwrap(), 2e-6, 1.0);
    }
}

#[test]
fn a_shaft_in_two_bores_has_the_moments_of_its_formula() {
    let case = oracle("shaft-two-bores");
    let study = study("shaft");
    let mobility = study.mobility.as_ref().unwrap();
    assert_eq!((mobility.unknowns, mobility.equations), (6, 5));
    assert_eq!(mobility.free, ["shaft turns about the axis of shaft.journal"]);
    let found = analyze(&study.problem, &Method::Full.into()).unwrap();
    let height = found.characteristics[0].moments.unwrap();
    let expected = &case["expect"]["height"];
    close(height.mean(), expected["mean"].as_f64().unwrap(), 1e-6, 1.0);
    close(height.sigma(), expected["sigma"].as_f64().unwrap(), 3.0 * expected["sigma_se"].as_f64().unwrap(), 1.0);
}

#[test]
fn a_shaft_held_twice_is_over_constrained() {
    let text = read("tests/data/assembly3d/shaft.toml");
    let text = text.replace("takes = 2, offset = [\"f1_x\", \"f1_y\"]", "takes = 4");
    let text = text.replace("takes = 2, offset = [\"f2_x\", \"f2_y\"]", "takes = 4");
    let error = parse(&text).unwrap_err();
    let (said, help) = (error.message(), error.help().unwrap());
    assert_eq!(error.key, "joints.second");
    assert_eq!(
        said,
        "joint `second` takes 4, and only 0 of these are free after `first`: 9 equations for 6 unknowns, rank 5"
    );
    assert!(help.contains("takes = 2 on both makes it a shaft in two bores"), "{help}");
}

/// A plate on a table, with a lid as reference, in any pose of the whole.
pub fn plate(joints: &str, characteristics: &str) -> Result<Study, StudyError> {
    parse(&format!(
        r#"
[dimensions]
t = {{ nominal = 12, tolerance = 0.1, unit = "mm" }}
w = {{ nominal = 40, tolerance = 0.1, unit = "mm" }}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
fence = {{ plane = [0, 0, 0], normal = "x" }}
stop = {{ plane = [0, 0, 0], normal = "y" }}
peg = {{ axis = [10, 10, 0], along = "z" }}
mark = {{ point = [0, 0, 0] }}
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
[parts.plate]
bottom = {{ plane = [0, 0, 0], normal = "-z" }}
left = {{ plane = [0, 0, 0], normal = "-x" }}
front = {{ plane = [0, 0, 0], normal = "-y" }}
lid = {{ plane = [0, 0, "t"], normal = "z" }}
hole = {{ axis = [10, 10, 0], along = "z", diameter = 8 }}
corner = {{ point = ["w", 20, "t"] }}
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
[joints]
{joints}
[characteristics]
{characteristics}
"#
    ))
}

pub const SEATED: &str = r#"seat = { on = "table.top", against = "plate.bottom" }
side = { on = "table.fence", against = "plate.left", takes = 2 }
end = { on = "table.stop", against = "plate.front", takes = 1 }"#;
pub const HEIGHT: &str = r#"height = { of = "plate.lid", from = "table.top", unit = "mm" }"#;

#[test]
fn datums_3_2_1_locate_a_plate() {
    let study =
        plate(SEATED, r#"x = { of = "plate.corner", from = "table.frame", along = "x", unit = "mm" }"#).unwrap();
    let mobility = study.mobility.as_ref().unwrap();
    assert_eq!((mobility.unknowns, mobility.equations, mobility.free.len()), (6, 6, 0));
    close(values(&study, None)[0], 40.0, 1e-12, 1.0);
    // Faces that change places of `on` and `against` give the same.
    let swapped = SEATED
        .replace("on = \"table.top\", against = \"plate.bottom\"", "on = \"plate.bottom\", against = \"table.top\"");
    let other =
        plate(&swapped, r#"x = { of = "plate.corner", from = "table.frame", along = "x", unit = "mm" }"#).unwrap();
    close(values(&other, Some(("w", 0.1)))[0], 40.1, 1e-12, 1.0);
}

#[test]
fn a_free_motion_that_no_measure_feels_is_named() {
    let study = plate(r#"seat = { on = "table.top", against = "plate.bottom" }"#, HEIGHT).unwrap();
    let mobility = study.mobility.as_ref().unwrap();
    assert_eq!((mobility.equations, mobility.free.len()), (3, 3));
    close(values(&study, Some(("t", 0.25)))[0], 12.25, 1e-12, 1.0);
    // The expanded study gives the same figures to the last digit.
    let expanded = parse(&study.expanded).unwrap();
    assert_eq!(values(&expanded, Some(("t", 0.25))), values(&study, Some(("t", 0.25))));
}

/// The text of an assembly whose whole is turned and moved, with lengths multiplied by a factor.
fn moved_arm(turn: [f64; 3], factor: f64) -> Study {
    // The ground has a pose; everything else follows from its joints.
    parse(&format!(
        r#"
[dimensions]
l = {{ nominal = {l:?}, tolerance = {band:?} }}
q = {{ nominal = 30, tolerance = 1, unit = "deg" }}
[parts.base]
turned = {turn:?}
pivot = {{ frame = [{p:?}, 0, 0], z = "y", x = "x" }}
[parts.arm]
turned = {turn:?}
pivot = {{ frame = [0, 0, 0], z = "y", x = "x" }}
tip = {{ point = ["l", 0, {s:?}] }}
[joints]
pivot = {{ revolute = ["base.pivot", "arm.pivot"] }}
drive = {{ angle = ["base.pivot", "arm.pivot"], value = "q" }}
[characteristics]
x = {{ of = "arm.tip", from = "base.pivot", along = "x" }}
z = {{ of = "arm.tip", from = "base.pivot", along = "y" }}
"#,
        l = 50.0 * factor,
        band = 0.2 * factor,
        p = 7.0 * factor,
        s = 3.0 * factor,
    ))
    .unwrap()
}

#[test]
fn a_turned_assembly_measures_the_same() {
    let still = moved_arm([0.0; 3], 1.0);
    let expected = values(&still, Some(("q", 2.0)));
    // The arm turns about y of the base: x = l cos q + 3 sin q, by hand, with q = 32 degrees. Its second direction is -z.
    let q = 32f64.to_radians();
    close(expected[0], 50.0 * q.cos() + 3.0 * q.sin(), 1e-12, 50.0);
    for turn in [[10.0, 0.0, 0.0], [25.0, -40.0, 60.0], [-70.0, 80.0, 15.0]] {
        for (found, expected) in values(&moved_arm(turn, 1.0), Some(("q", 2.0))).iter().zip(&expected) {
            close(*found, *expected, 1e-12, 50.0);
        }
    }
    for (found, expected) in values(&moved_arm([25.0, -40.0, 60.0], 1000.0), Some(("q", 2.0))).iter().zip(&expected) {
        close(*found, 1000.0 * expected, 1e-12, 50_000.0);
    }
}

/// A formula of the study may use a measure, and a coordinate may use a formula.
#[test]
fn formulas_use_measures_by_name() {
    let study = parse(
        r#"
[dimensions]
t = { nominal = 12, tolerance = 0.1 }
[formulas]
part = "t/3"
twice = "2*part"
half = "height/2"
[parts.table]
top = { plane = [0, 0, 0], normal = "z" }
[parts.plate]
foot = { plane = [0, 0, "-twice"], normal = "-z" }
lid = { plane = [0, 0, "part"], normal = "z" }
[joints]
seat = { on = "table.top", against = "plate.foot" }
[characteristics]
height = { of = "plate.lid", from = "table.top" }
more = { formula = "half + 1" }
"#,
    )
    .unwrap();
    // The lid is a third of t above the origin of the plate, and its foot two thirds below.
    let found = values(&study, Some(("t", 0.3)));
    close(found[0], 12.3, 1e-12, 1.0);
    close(found[1], 7.15, 1e-12, 1.0);
}

/// Converted units give the same figures as those of the drawing.
#[test]
fn converted_units_change_nothing() {
    let text = read("examples/crank-slider-space/study.toml");
    let plain = parse(&text).unwrap();
    let converted = parse(&format!("units = \"convert\"\n{text}")).unwrap();
    close(values(&converted, Some(("th", 0.3)))[0], values(&plain, Some(("th", 0.3)))[0], 1e-11, 70.0);
}
