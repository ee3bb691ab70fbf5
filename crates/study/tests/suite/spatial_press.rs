//! Contacts that press: closed forms of tables and plates on four feet, invariances, and the switches that analyses meet.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{DerivativeSource, Method, Options, Warning, analyze};
use sensitol_study::Study;
use sensitol_testing::{close, data, parse, read};
use serde_json::Value;

use super::spatial::values;

fn oracle(name: &str) -> Value {
    let all = data("assembly3d.json");
    all.as_array().unwrap().iter().find(|case| case["name"] == name).unwrap().clone()
}

/// Text of a plate on pads at these places, with their heights as dimensions. The middle of the plate stays over the origin.
fn pads(places: &[[f64; 2]], heights: &[f64], weight: [f64; 2]) -> String {
    let names: Vec<String> = (1..=places.len()).map(|number| format!("h{number}")).collect();
    let dimension = |(name, height): (&String, &f64)| format!("{name} = {{ nominal = {height:?}, tolerance = 0.1 }}\n");
    let point =
        |(name, [x, y]): (&String, &[f64; 2])| format!("pad{name} = {{ point = [{x:?}, {y:?}, \"{name}\"] }}\n");
    let targets: Vec<String> = names.iter().map(|name| format!("\"pads.pad{name}\"")).collect();
    format!(
        r#"
[dimensions]
{dimensions}
[parts.pads]
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
line = {{ axis = [0, 0, 0], along = "z" }}
{points}
[parts.plate]
bottom = {{ plane = [0, 0, 0], normal = "-z" }}
middle = {{ point = [0, 0, 0] }}
weight = {{ point = [{x:?}, {y:?}, 0] }}
[joints]
middle = {{ hole = "pads.line", ball = "plate.middle" }}
stand = {{ on = "plate.bottom", targets = [{targets}], weight_at = "plate.weight" }}
[characteristics]
height = {{ of = "plate.middle", from = "pads.frame", along = "z" }}
"#,
        dimensions = names.iter().zip(heights).map(dimension).collect::<String>(),
        points = names.iter().zip(places).map(point).collect::<String>(),
        targets = targets.join(", "),
        x = weight[0],
        y = weight[1],
    )
}

fn numbers<const N: usize>(list: &Value) -> [f64; N] {
    let parts: Vec<f64> = list.as_array().unwrap().iter().map(|part| part.as_f64().unwrap()).collect();
    parts.try_into().unwrap()
}

#[test]
fn one_realisation_is_that_of_a_linear_program() {
    let case = oracle("four-legs-point");
    let legs: Vec<[f64; 2]> = case["given"]["legs"].as_array().unwrap().iter().map(numbers).collect();
    let heights: [f64; 4] = numbers(&case["given"]["heights"]);
    for (weight, expected) in [([0.0, 0.0], "weight_at_centre"), ([8.0, -3.0], "weight_at_8_minus3")] {
        let expected = &case["expect"][expected];
        // The weight at the middle lets the plate rock, and at the nominal sizes the height of the middle does not depend on that.
        let study = parse(&pads(&legs, &[0.0; 4], weight)).unwrap();
        let dimensions = study.problem.dimensions().len();
        assert_eq!(dimensions, 4);
        let found = at(&study, &heights);
        close(found, expected["z0"].as_f64().unwrap(), 1e-9, 1.0);
    }
    // The pose, with the heights as nominal sizes: the plane is z = z0 + rx y - ry x.
    let study = parse(&pads(&legs, &heights, [8.0, -3.0])).unwrap();
    let plate = study.poses.iter().find(|pose| pose.part == "plate").unwrap();
    let expected = &case["expect"]["weight_at_8_minus3"];
    let [rx, ry, rz] = plate.rotation;
    // Slopes of a plane that is turned by a small rotation vector without a part about z are tan of its parts, to the third power.
    assert!(rz.abs() < 1e-6);
    close(rx, expected["rx"].as_f64().unwrap(), 1e-8, 1.0);
    close(ry, expected["ry"].as_f64().unwrap(), 1e-8, 1.0);
}

/// Value of the first characteristic at these dimensions.
/// Values of all characteristics at a point.
fn all_at(study: &Study, point: &[f64]) -> Vec<f64> {
    use sensitol::assembly::{Points, Request, Responses, Run};
    let outputs: Vec<usize> = (0..study.problem.characteristics().len()).collect();
    let points = Points::from_rows(&[point.to_vec()]);
    let mut found = Responses::open(1, outputs.len());
    study.problem.function().evaluate(&Request::values(&points, &outputs), &Run::to_the_end(), &mut found);
    outputs.iter().map(|&output| found.value(0, output).unwrap()).collect()
}

fn at(study: &Study, point: &[f64]) -> f64 {
    use sensitol::assembly::{Points, Request, Responses, Run};
    let points = Points::from_rows(&[point.to_vec()]);
    let mut found = Responses::open(1, 1);
    study.problem.function().evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut found);
    found.value(0, 0).unwrap_or_else(|| panic!("{point:?}: {:?}", found.error(0, 0)))
}

/// Height of the lowest plane over the origin that lies above all points, by trying every triangle: the greatest height of those that
/// contain the origin. Their heights are interpolated with areas.
fn highest(places: &[[f64; 2]], heights: &[f64]) -> f64 {
    let area = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let mut best = f64::NEG_INFINITY;
    for i in 0..places.len() {
        for j in i + 1..places.len() {
            for k in j + 1..places.len() {
                let [a, b, c] = [places[i], places[j], places[k]];
                let parts = [area(b, c), area(c, a), area(a, b)];
                let all: f64 = parts.iter().sum();
                if parts.iter().all(|part| part / all >= 0.0) {
                    best = best.max((parts[0] * heights[i] + parts[1] * heights[j] + parts[2] * heights[k]) / all);
                }
            }
        }
    }
    best
}

#[test]
fn random_plates_rest_on_the_highest_triangle() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(54);
    for count in [3, 4, 5, 7, 12] {
        // Pads around the origin, so that it lies within them.
        let places: Vec<[f64; 2]> = (0..count)
            .map(|pad| {
                let angle =
                    std::f64::consts::TAU * (f64::from(pad) + random.random_range(-0.3..0.3)) / f64::from(count);
                let radius = random.random_range(30.0..90.0);
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let study = parse(&pads(&places, &vec![0.0; places.len()], [0.0; 2])).unwrap();
        for _ in 0..400 {
            let heights: Vec<f64> = places.iter().map(|_| random.random_range(-0.1..0.1)).collect();
            // The pose is found to some 1e-13 of its size, which is 100.
            close(at(&study, &heights), highest(&places, &heights), 1e-11, 1.0);
        }
    }
}

#[test]
fn a_table_on_four_legs_has_the_moments_of_the_greater_diagonal() {
    let case = oracle("four-legs");
    let expected = |name: &str| case["expect"][name].as_f64().unwrap();
    let study = parse(&read("tests/data/assembly3d/four-legs.toml")).unwrap();
    // By points: the greater of the two diagonals.
    for heights in [[0.4, -0.2, 0.1, 0.9], [1.0, 0.2, 0.1, -0.5], [-1.0, -0.5, -0.3, -2.0]] {
        let diagonals = [0.5 * (heights[0] + heights[2]), 0.5 * (heights[1] + heights[3])];
        close(at(&study, &heights), diagonals[0].max(diagonals[1]), 1e-9, 1.0);
    }
    let found = simulate(&study.problem, &SimulationOptions::default().with_samples(400_000)).unwrap();
    let one = &found.characteristics[0];
    assert_eq!(one.failed, 0);
    for (name, found) in
        [("mean", one.mean), ("sigma", one.sigma), ("skewness", one.skewness), ("kurtosis", one.kurtosis)]
    {
        // Four figures of one seed: three standard errors are exceeded by one of them once in a hundred seeds.
        let found = found.unwrap();
        close(found.value, expected(name), 3.0 * found.standard_error.unwrap(), 1.0);
    }
    shares(&found.warnings, true);
}

/// Holds that the warning names the joint with both diagonals, each in half of the assemblies.
fn shares(warnings: &[Warning], from_sample: bool) {
    let found = warnings.iter().find_map(|warning| match warning {
        Warning::ContactSwitch { switch, contacts, sampled, .. } => Some((switch, contacts, sampled)),
        _ => None,
    });
    let (switch, contacts, sampled) = found.unwrap_or_else(|| panic!("{warnings:?}"));
    assert_eq!((switch.as_str(), *sampled), ("the contacts of joint `stand`", from_sample));
    let names: Vec<Vec<&str>> = contacts.iter().map(|of| of.contacts.iter().map(String::as_str).collect()).collect();
    assert_eq!(names, [["one", "three"], ["two", "four"]]);
    for of in contacts {
        close(of.share, 0.5, 4.0 * of.error, 1.0);
        // 16 384 points.
        close(of.error, 0.5 / 128.0, 1e-4, 1.0);
    }
    assert!(!warnings.iter().any(|warning| warning.code() == "switch"), "{warnings:?}");
}

#[test]
fn auto_samples_and_names_the_sets_of_contacts() {
    let case = oracle("four-legs");
    let study = parse(&read("tests/data/assembly3d/four-legs.toml")).unwrap();
    let found = analyze(&study.problem, &Method::Auto.into()).unwrap();
    let one = &found.characteristics[0];
    let (moments, errors) = (one.moments.unwrap(), one.error_estimate.as_ref().unwrap());
    for (name, value, error) in [
        ("mean", moments.mean(), errors.mean),
        ("sigma", moments.sigma(), errors.sigma),
        ("kurtosis", moments.kurtosis().unwrap(), errors.kurtosis),
    ] {
        close(value, case["expect"][name].as_f64().unwrap(), 3.0 * error.unwrap(), 1.0);
    }
    shares(&found.warnings, false);
    // At the nominal sizes all four touch: there is no derivative, and a method that needs one says so.
    let mut exact = Options::from(Method::Rss);
    exact.derivatives = Some(DerivativeSource::Exact);
    let refused = analyze(&study.problem, &exact).unwrap_err().to_string();
    assert!(refused.contains("`height` has no derivative by `h1`"), "{refused}");
}

/// A table whose legs end at the origin of all heights is the same table: its nominal state is no dead centre, whatever the origin.
#[test]
fn a_tie_at_the_origin_is_no_dead_centre() {
    let moved = |origin: f64| {
        let text = read("examples/four-legged-table/study.toml");
        let text = text.replace("nominal = 700", &format!("nominal = {}", 700.0 - origin));
        let text = text.replace("[0, 0, 700]", &format!("[0, 0, {}]", 700.0 - origin));
        let text = text.replace("point = [0, 0, 0]", &format!("point = [0, 0, {origin}]"));
        let study = parse(&text).unwrap();
        analyze(&study.problem, &Method::Auto.into()).unwrap()
    };
    let [high, low] = [0.0, 700.0].map(moved);
    for found in [&high, &low] {
        let codes: Vec<&str> = found.warnings.iter().map(|warning| warning.code()).collect();
        assert_eq!(codes, ["contact-switch"]);
    }
    let [high, low] = [&high, &low].map(|found| found.characteristics[0].moments.unwrap());
    // A height of 700 mm leaves 1e-13 mm of rounding.
    close(high.mean(), low.mean(), 1e-11, 0.0);
    close(high.sigma(), low.sigma(), 1e-11, 0.0);
}

#[test]
fn the_expanded_study_gives_the_same_figures() {
    let study = parse(&read("tests/data/assembly3d/four-legs.toml")).unwrap();
    let expanded = parse(&study.expanded).unwrap();
    for heights in [[0.4, -0.2, 0.1, 0.9], [1.0, 0.2, 0.1, -0.5]] {
        assert_eq!(at(&study, &heights), at(&expanded, &heights));
    }
    // Its warnings name the joint and its contacts too.
    let [own, plain] = [&study, &expanded].map(|study| analyze(&study.problem, &Method::Auto.into()).unwrap());
    shares(&plain.warnings, false);
    assert_eq!(own.warnings, plain.warnings);
}

/// Text of a block with a face of 600 by 400 on a floor. `face` holds further keys of the face, `joint` those of the joint.
fn block(units: &str, face: &str, joint: &str) -> String {
    format!(
        r#"
units = "{units}"
[dimensions]
t = {{ nominal = 50, unit = "mm" }}
[parts.floor]
top = {{ plane = [0, 0, 0], normal = "z" }}
[parts.block]
at = [0, 0, 0]
foot = {{ plane = [0, 0, 0], normal = "-z", x = "x", {face} }}
middle = {{ point = [0, 0, 0] }}
weight = {{ point = [80, -30, 0] }}
lid = {{ point = [150, -80, "t"] }}
[joints]
stand = {{ on = "floor.top", against = "block.foot", {joint} }}
[characteristics]
height = {{ of = "block.middle", from = "floor.top", unit = "mm" }}
"#
    )
}

/// The four corners of a face with form are four legs: its middle has the moments of the greater of the two diagonals, with sigma a sixth of
/// the flatness at every corner.
#[test]
fn a_face_with_form_stands_on_its_corners() {
    let case = oracle("four-legs");
    let expected = |name: &str| case["expect"][name].as_f64().unwrap();
    for units in ["check", "convert"] {
        let study = parse(&block(units, "size = [600, 400], flatness = 3", "press = [0, 0, -1]")).unwrap();
        // A corner has the tolerance of its form.
        let gaps = format!("{:?}", study.completeness());
        assert!(!gaps.contains("corner"), "{gaps}");
        // The corners are around the face: those of one diagonal are the first and the third.
        for forms in [[0.4, -0.2, 0.1, 0.9], [1.0, 0.2, 0.1, -0.5]] {
            let diagonals = [0.5 * (forms[0] + forms[2]), 0.5 * (forms[1] + forms[3])];
            let point: Vec<f64> = (study.problem.dimensions().iter())
                .map(|one| {
                    one.name()
                        .strip_prefix("block.foot.corner")
                        .map_or(one.nominal(), |corner| forms[corner.parse::<usize>().unwrap() - 1])
                })
                .collect();
            // The middle is above the diagonal by its form times the cosine of a tilt of 2e-3.
            close(at(&study, &point), diagonals[0].max(diagonals[1]), 2e-6, 1.0);
        }
        let found = simulate(&study.problem, &SimulationOptions::default().with_samples(100_000)).unwrap();
        let one = &found.characteristics[0];
        // The sigma at a corner is 0.5 mm, so that the moments are half those of legs with a sigma of 1 mm.
        for (name, found, factor) in
            [("mean", one.mean, 0.5), ("sigma", one.sigma, 0.5), ("kurtosis", one.kurtosis, 1.0)]
        {
            let found = found.unwrap();
            close(found.value, factor * expected(name), 3.0 * found.standard_error.unwrap(), 1.0);
        }
        let expanded = parse(&study.expanded).unwrap();
        let again = simulate(&expanded.problem, &SimulationOptions::default().with_samples(100_000)).unwrap();
        assert_eq!(again.characteristics[0].mean, one.mean);
    }
}

/// A face whose corners deviate alike moves by that amount, and its profile moves the corners with the face, as in a contact without a force.
#[test]
fn a_pressed_face_moves_with_its_zones() {
    let face = "size = [600, 400], profile = 0.4, flatness = { zone = 0.1, side = \"out\" }";
    let lid = "lid = { of = \"block.lid\", from = \"floor.top\", unit = \"mm\" }\n";
    let pressed = parse(&(block("check", face, "weight_at = \"block.weight\"") + lid)).unwrap();
    let held = parse(&(block("check", "size = [600, 400], profile = 0.4", "takes = 3") + lid)).unwrap();
    let names = |study: &Study| study.problem.dimensions().iter().map(|one| one.name().to_owned()).collect::<Vec<_>>();
    let deviations = [("block.foot.at", 0.11), ("block.foot.tilt_x", 3e-4), ("block.foot.tilt_y", -2e-4)];
    let values = |study: &Study, form: f64| -> Vec<f64> {
        let of = |name: &String| {
            let given = deviations.iter().find(|(own, _)| own == name).map(|(_, value)| *value);
            given.unwrap_or(if name == "t" { 50.0 } else { form })
        };
        let point: Vec<f64> = names(study).iter().map(of).collect();
        all_at(study, &point)
    };
    // Zones are carried to the corners by small angles: 360 mm times half the square of 3.6e-4.
    for form in [0.0, 0.07] {
        for (found, expected) in values(&pressed, form).into_iter().zip(values(&held, form)) {
            close(found, expected + form, 5e-5, 0.0);
        }
    }
}

/// Text of a table on a floor whose whole is turned by `turned` degrees about x, with lengths multiplied by a factor.
fn table(turned: f64, factor: f64, joint: &str) -> String {
    let [x, y, h, w] = [300.0, 200.0, 700.0, 60.0].map(|length| length * factor);
    format!(
        r#"
[dimensions]
h1 = {{ nominal = {h:?}, tolerance = {band:?} }}
h2 = {{ nominal = {h:?}, tolerance = {band:?} }}
h3 = {{ nominal = {h:?}, tolerance = {band:?} }}
h4 = {{ nominal = {h:?}, tolerance = {band:?} }}
[parts.floor]
turned = [{turned:?}, 0, 0]
top = {{ plane = [0, 0, 0], normal = "z" }}
mark = {{ point = [0, 0, 0] }}
[parts.table]
turned = [{turned:?}, 0, 0]
at = [0, {aside:?}, {above:?}]
leg1 = {{ point = [-{x:?}, -{y:?}, "-h1"] }}
leg2 = {{ point = [{x:?}, -{y:?}, "-h2"] }}
leg3 = {{ point = [{x:?}, {y:?}, "-h3"] }}
leg4 = {{ point = [-{x:?}, {y:?}, "-h4"] }}
lamp = {{ point = [{w:?}, -{w:?}, 0] }}
centre = {{ axis = [0, 0, 0], along = "z" }}
[joints]
{joint}
middle = {{ hole = "table.centre", ball = "floor.mark" }}
[characteristics]
height = {{ of = "table.lamp", from = "floor.top" }}
second = {{ of = "table.leg2", from = "floor.top" }}
fourth = {{ of = "table.leg4", from = "floor.top" }}
"#,
        band = factor,
        aside = -h * turned.to_radians().sin(),
        above = h * turned.to_radians().cos(),
    )
}

fn stand(force: [f64; 3]) -> String {
    let legs = r#"targets = ["table.leg1", "table.leg2", "table.leg3", "table.leg4"], weight_at = "table.lamp""#;
    format!("stand = {{ on = \"floor.top\", {legs}, press = {force:?} }}")
}

#[test]
fn a_turned_or_larger_table_stands_the_same() {
    let moved = Some(("h2", 0.4));
    let expected = values(&parse(&table(0.0, 1.0, &stand([0.0, 0.0, -1.0]))).unwrap(), moved);
    assert!(expected[2] >= -1e-10, "{expected:?}");
    for degrees in [25.0f64, -70.0, 140.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let study = parse(&table(degrees, 1.0, &stand([0.0, sine, -cosine]))).unwrap();
        for (found, expected) in values(&study, moved).iter().zip(&expected) {
            close(*found, *expected, 1e-10, 1.0);
        }
    }
    let large = parse(&table(0.0, 1000.0, &stand([0.0, 0.0, -3.0]))).unwrap();
    for (found, expected) in values(&large, Some(("h2", 400.0))).iter().zip(&expected) {
        close(*found, 1000.0 * expected, 1e-7, 1.0);
    }
}

#[test]
fn three_legs_are_three_plain_contacts() {
    let pressed = r#"stand = { on = "floor.top", targets = ["table.leg1", "table.leg2", "table.leg3"], press = "-z" }"#;
    let contacts: String =
        (1..=3).map(|leg| format!("leg{leg} = {{ on = \"floor.top\", against = \"table.leg{leg}\" }}\n")).collect();
    let [pressed, plain] = [pressed, &contacts].map(|joint| parse(&table(0.0, 1.0, joint)).unwrap());
    for moved in [("h1", 0.5), ("h2", -0.3), ("h3", 0.7)] {
        for (a, b) in values(&pressed, Some(moved)).iter().zip(values(&plain, Some(moved))) {
            close(*a, b, 1e-10, 1.0);
        }
    }
    let counts = [&pressed, &plain].map(|study| study.mobility.as_ref().unwrap().equations);
    assert_eq!(counts, [5, 5]);
}

/// A box stands on a table that stands on a floor: the table is pressed first, whatever the box does.
#[test]
fn pressed_parts_stand_on_each_other() {
    let legs = |part: &str, [x, y]: [f64; 2], z: &str| -> String {
        [[-x, -y], [x, -y], [x, y], [-x, y]]
            .iter()
            .enumerate()
            .map(|(leg, [x, y])| format!("{part}{leg} = {{ point = [{x:?}, {y:?}, \"-{z}{leg}\"] }}\n"))
            .collect()
    };
    let dimensions: String = ["h", "g"]
        .iter()
        .flat_map(|name| (0..4).map(move |leg| format!("{name}{leg} = {{ nominal = 50, tolerance = 0.1 }}\n")))
        .collect();
    let text = format!(
        r#"
[dimensions]
{dimensions}
[parts.floor]
top = {{ plane = [0, 0, 0], normal = "z" }}
line = {{ axis = [0, 0, 0], along = "z" }}
[parts.table]
at = [0, 0, 50]
face = {{ plane = [0, 0, 0], normal = "z" }}
middle = {{ point = [0, 0, 0] }}
line = {{ axis = [0, 0, 0], along = "z" }}
{table}
[parts.box]
at = [0, 0, 100]
middle = {{ point = [0, 0, 0] }}
{feet}
[joints]
a = {{ hole = "floor.line", ball = "table.middle" }}
stand = {{ on = "floor.top", press = "-z", targets = ["table.leg0", "table.leg1", "table.leg2", "table.leg3"] }}
b = {{ hole = "table.line", ball = "box.middle" }}
rest = {{ on = "table.face", press = "-z", targets = ["box.foot0", "box.foot1", "box.foot2", "box.foot3"] }}
[characteristics]
top = {{ of = "box.middle", from = "floor.top" }}
"#,
        table = legs("leg", [3000.0, 2000.0], "h"),
        feet = legs("foot", [1000.0, 1500.0], "g"),
    );
    let study = parse(&text).unwrap();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    for _ in 0..100 {
        let point: Vec<f64> = (0..8).map(|_| 50.0 + random.random_range(-0.1..0.1)).collect();
        let diagonal = |of: &[f64]| (0.5 * (of[0] + of[2])).max(0.5 * (of[1] + of[3]));
        // A tilt of 1e-4 of legs of 50 lowers them by its square: less than 1e-6.
        close(at(&study, &point), diagonal(&point[..4]) + diagonal(&point[4..]), 1e-6, 1.0);
    }
}
