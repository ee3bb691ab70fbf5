//! Zones of features and floats of joints in space: exact moments, published and simulated figures, invariances, and wrong studies.

use sensitol::method::Options;
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_testing::{close, data, parse, read, relative};
use serde_json::Value;

fn oracle(name: &str) -> Value {
    let all = data("assembly3d.json");
    all.as_array().unwrap().iter().find(|case| case["name"] == name).unwrap()["expect"].clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Mean, sigma and kurtosis of every characteristic by `full`. Points that verify the method would take minutes.
fn moments(study: &Study) -> Vec<[f64; 3]> {
    let found = analyze(&study.problem, &Options::from(Method::Full).with_verify(0).with_densities(false)).unwrap();
    let of = |one: &sensitol::analysis::CharacteristicAnalysis| {
        let moments = one.moments.unwrap();
        // A constant has no kurtosis.
        [moments.mean(), moments.sigma(), moments.kurtosis().unwrap_or(0.0)]
    };
    found.characteristics.iter().map(of).collect()
}

/// A block with a feature on a table, and characteristics.
fn block(feature: &str, more: &str, characteristics: &str) -> Study {
    let text = format!(
        r#"
[dimensions]
t = {{ nominal = 30, tolerance = 0.1, unit = "mm" }}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
[parts.block]
foot = {{ plane = [0, 0, 0], normal = "-z", x = "x" }}
side = {{ plane = [0, 0, 0], normal = "-x" }}
end = {{ plane = [0, 0, 0], normal = "-y" }}
{feature}
[joints]
seat = {{ on = "table.top", against = "block.foot", takes = 3 }}
[characteristics]
height = {{ of = "block.foot", from = "table.top", unit = "mm" }}
{characteristics}
{more}
"#
    );
    parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Second moments of torsors that are uniform in their zones, in units of half the zone.
#[test]
fn uniform_zones_have_exact_moments() {
    let exact = oracle("zones-uniform");
    // A rectangle of 60 x 40 within a profile of 0.2: half the zone is 0.1.
    let face = block(
        "lid = { plane = [0, 0, \"t\"], normal = \"z\", x = \"x\", profile = 0.2, size = [60, 40], distribution = \"uniform\" }",
        "",
        "z = { formula = \"`block.lid.at`/0.1\" }\nx = { formula = \"`block.lid.tilt_x`*20/0.1\" }\n\
         y = { formula = \"`block.lid.tilt_y`*30/0.1\" }\n\
         corner = { formula = \"(`block.lid.at` + `block.lid.tilt_x`*20 - `block.lid.tilt_y`*30)/0.1\" }",
    );
    let found = moments(&face);
    for (found, variance) in found[1..4].iter().zip(exact["rectangle"].as_array().unwrap()) {
        relative(found[1].powi(2), number(variance), 1e-12);
        relative(found[2], number(&exact["rectangle_fourth"]) / number(variance).powi(2), 1e-12);
    }
    relative(found[4][1].powi(2), number(&exact["corner_of_rectangle"]), 1e-12);
    // A round face of radius 25.
    let round = block(
        "lid = { plane = [0, 0, \"t\"], normal = \"z\", x = \"x\", profile = { zone = 0.2, distribution = \"uniform\" }, diameter = 50 }",
        "",
        "z = { formula = \"`block.lid.at`/0.1\" }\nx = { formula = \"`block.lid.tilt_x`*25/0.1\" }\n\
         y = { formula = \"`block.lid.tilt_y`*25/0.1\" }\nxy = { formula = \"`block.lid.at`*`block.lid.tilt_x`*25/0.01\" }",
    );
    let found = moments(&round);
    for (found, variance) in found[1..4].iter().zip(exact["round_face"].as_array().unwrap()) {
        relative(found[1].powi(2), number(variance), 1e-12);
    }
    // E z^2 x^2 by the two shares: E h^2 (1 - h)^2 E s^2/2 with densities 3 (1 - h)^2 and 2 s, which is 3 B(3, 5)/4.
    relative(found[4][1].powi(2), 0.75 / 105.0, 1e-11);
    // An axis of length 50: both ends in the zone.
    let axis = block(
        "bore = { axis = [10, 10, 15], along = \"z\", length = 50, position = 0.2, distribution = \"uniform\" }",
        "",
        "middle = { formula = \"(`block.bore.end1_x` + `block.bore.end2_x`)/2/0.1\" }\n\
         tilt = { formula = \"(`block.bore.end2_x` - `block.bore.end1_x`)/0.1\" }",
    );
    let found = moments(&axis);
    relative(found[1][1].powi(2), number(&exact["axis_centre"]), 1e-12);
    relative(found[2][1].powi(2), number(&exact["axis_tilt_times_L"]), 1e-12);
    // A point in a ball, a perpendicularity of an axis, and one of a plane about one direction: 1/5, 1 and 4/3.
    let others = block(
        "tip = { point = [10, 10, 15], position = { zone = 0.2, distribution = \"uniform\" } }\n\
         pin = { axis = [10, 10, 15], along = \"z\", length = 50, perpendicularity = 0.2, distribution = \"uniform\", datums = \"foot\" }\n\
         wall = { plane = [0, 0, 15], normal = \"x\", x = \"y\", length = 40, perpendicularity = 0.2, distribution = \"uniform\", datums = \"foot\" }",
        "",
        "z = { formula = \"`block.tip.at_z`/0.1\" }\npin = { formula = \"`block.pin.tilt_x`*50/0.1\" }\n\
         wall = { formula = \"`block.wall.tilt`*40/0.1\" }",
    );
    let found = moments(&others);
    for (found, variance) in found[1..].iter().zip([0.2, 1.0, 4.0 / 3.0]) {
        relative(found[1].powi(2), variance, 1e-12);
    }
}

fn shaft(bores: &str) -> String {
    format!(
        r#"
[dimensions]
h = {{ nominal = 50, tolerance = 0.05, unit = "mm" }}
L = {{ nominal = 140, tolerance = 0.2, unit = "mm" }}
D1 = {{ nominal = 20, fit = "H7", unit = "mm" }}
D2 = {{ nominal = 20, fit = "H7", unit = "mm" }}
d = {{ nominal = 20, limits = [19.967, 19.980], unit = "mm" }}
[parts.housing]
base = {{ plane = [0, 0, 0], normal = "z" }}
end = {{ plane = [0, 0, "h"], normal = "x" }}
line = {{ axis = [0, 0, 0], along = "x" }}
bore1 = {{ axis = [0, 0, "h"], along = "x", diameter = "D1", position = 0.1, datums = "base" }}
bore2 = {{ axis = [80, 0, "h"], along = "x", diameter = "D2", position = 0.1, datums = "base" }}
[parts.shaft]
at = [0, 0, 50]
collar = {{ plane = [0, 0, 0], normal = "-x" }}
journal = {{ axis = [0, 0, 0], along = "x", diameter = "d" }}
tip = {{ point = ["L", 0, 0], runout = 0.03, datums = "journal" }}
[joints]
{bores}
shoulder = {{ on = "housing.end", against = "shaft.collar", takes = 1 }}
[characteristics]
height = {{ of = "shaft.tip", from = "housing.base", unit = "mm" }}
side = {{ of = "shaft.tip", from = "housing.line", along = "x", unit = "mm" }}
"#
    )
}

const BORES: &str = r#"first = { hole = "housing.bore1", pin = "shaft.journal", takes = 2, float = "disc" }
second = { hole = "housing.bore2", pin = "shaft.journal", takes = 2, float = "disc" }"#;

/// The figures of the formula, by zones and floats that the study names.
#[test]
fn a_shaft_in_two_bores_has_the_figures_of_its_formula() {
    let expected = oracle("shaft-two-bores");
    let study = parse(&shaft(BORES)).unwrap();
    let mobility = study.mobility.as_ref().unwrap();
    assert_eq!((mobility.unknowns, mobility.equations, mobility.free.len()), (6, 5, 1));
    let found = moments(&study);
    close(found[0][0], number(&expected["height"]["mean"]), 1e-6, 1.0);
    for (found, name) in found.iter().zip(["height", "side"]) {
        close(found[1], number(&expected[name]["sigma"]), 3.0 * number(&expected[name]["sigma_se"]), 1.0);
    }
    // The tilt has a kink at 0: its figures are those of points.
    let tilted =
        format!("{}tilt = {{ angle = [\"shaft.journal\", \"housing.line\"], unit = \"deg\" }}\n", shaft(BORES));
    let tilted = parse(&tilted).unwrap();
    let sample = simulate(&tilted.problem, &SimulationOptions::default().with_samples(20_000)).unwrap();
    let tilt = &sample.characteristics[2];
    for (found, name) in [(&tilt.mean, "mean"), (&tilt.sigma, "sigma")] {
        let (found, se) = (found.as_ref().unwrap(), number(&expected["tilt"][format!("{name}_se")]));
        let error = 3.0 * (found.standard_error.unwrap() + se);
        close(found.value, number(&expected["tilt"][name]), error, 1.0);
    }
    let height = sample.characteristics[0].sigma.as_ref().unwrap();
    close(height.value, found[0][1], 3.0 * height.standard_error.unwrap(), 1.0);
}

/// A housing that is turned with its directions has the same law.
#[test]
fn a_turned_part_changes_nothing() {
    let text = shaft(BORES);
    let expected = moments(&parse(&text).unwrap());
    // The housing in another frame of its own: x becomes y.
    let turned = text
        .replace(
            "end = { plane = [0, 0, \"h\"], normal = \"x\" }",
            "turned = [0, 0, -90]\nend = { plane = [0, 0, \"h\"], normal = \"y\" }",
        )
        .replace("line = { axis = [0, 0, 0], along = \"x\" }", "line = { axis = [0, 0, 0], along = \"y\", x = \"-x\" }")
        .replace("bore1 = { axis = [0, 0, \"h\"], along = \"x\"", "bore1 = { axis = [0, 0, \"h\"], along = \"y\"")
        .replace("bore2 = { axis = [80, 0, \"h\"], along = \"x\"", "bore2 = { axis = [0, 80, \"h\"], along = \"y\"");
    let found = moments(&parse(&turned).unwrap());
    for (found, expected) in found.iter().zip(&expected) {
        close(found[0], expected[0], 1e-9, 1.0);
        // Derivatives by differences have an error of 1e-8.
        relative(found[1], expected[1], 1e-7);
    }
}

/// A hole on a pin has the same law as a pin in a hole, where both have one middle.
#[test]
fn an_exchanged_hole_and_pin_change_nothing() {
    let study = |hole: &str, pin: &str, of_block: &str, of_table: &str| {
        parse(&format!(
            r#"
[dimensions]
D = {{ nominal = 12.2, tolerance = 0.05, unit = "mm" }}
d = {{ nominal = 12, tolerance = 0.05, unit = "mm" }}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
fence = {{ plane = [0, 0, 0], normal = "y" }}
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
peg = {{ axis = [0, 0, 0], along = "z", diameter = "{of_table}", position = 0.1 }}
[parts.block]
foot = {{ plane = [0, 0, 0], normal = "-z" }}
side = {{ plane = [0, -5, 0], normal = "-y" }}
bore = {{ axis = [0, 0, 0], along = "z", diameter = "{of_block}" }}
corner = {{ point = [20, 0, 0] }}
[joints]
seat = {{ on = "table.top", against = "block.foot", takes = 3 }}
pin = {{ hole = "{hole}", pin = "{pin}", takes = 2, float = "disc" }}
[characteristics]
x = {{ of = "block.bore", from = "table.frame", along = "x", unit = "mm" }}
"#
        ))
        .unwrap()
    };
    let one = moments(&study("block.bore", "table.peg", "D", "d"));
    let other = moments(&study("table.peg", "block.bore", "d", "D"));
    // By hand: the position of the peg, and the clearance over a disc, E c^2 (1/4) with c of 0.1 and sigma 0.05/3/sqrt 2.
    let clearance = (0.1f64.powi(2) + 2.0 * (0.05f64 / 3.0 / 2.0).powi(2)) / 4.0;
    relative(one[0][1], (clearance + (0.05f64 / 3.0).powi(2)).sqrt(), 1e-6);
    relative(other[0][1], one[0][1], 1e-9);
}

/// Tilts of a bearing within a zone of orientation, and of a way as plain dimensions.
#[test]
fn a_crank_slider_with_tilted_bearings_has_the_moments_of_its_closed_form() {
    let expected = oracle("crank-slider-3d-moments");
    let text = read("examples/crank-slider-space/study.toml")
        .replace(
            "[parts.base]",
            "wx = { nominal = 0, tolerance = 0.01 }\nwy = { nominal = 0, tolerance = 0.01 }\n\n[parts.base]",
        )
        .replace(
            "bearing = { frame = [0, 0, 0], z = \"z\", x = \"x\" }",
            "origin = { frame = [0, 0, 0], z = \"z\", x = \"x\" }\n\
             bearing = { axis = [0, 0, 0], along = \"z\", x = \"x\", length = 40, perpendicularity = 0.4 }",
        )
        .replace(
            "way = { frame = [0, \"e\", 0], z = \"x\", x = \"y\" }",
            "way = { frame = [0, \"e\", 0], z = \"x\", x = \"y\", tilt = [\"wx\", \"wy\", 0] }",
        )
        .replace("drive = { angle = [\"base.bearing\", ", "drive = { angle = [\"base.origin\", ")
        // The place of the slider along its way, as in the closed form.
        .replace(
            "of = \"slider.ball\", from = \"base.bearing\", along = \"x\"",
            "of = \"slider.guide\", from = \"base.way\", along = \"z\"",
        );
    let study = parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let [mean, sigma, kurtosis] = moments(&study)[0];
    // The closed form is that of a rotation vector, and the drive is an angle in the tilted bearing: differences of the third order.
    close(mean, number(&expected["mean"]), 3.0 * number(&expected["mean_se"]), 1.0);
    close(sigma, number(&expected["sigma"]), 3.0 * number(&expected["sigma_se"]), 1.0);
    close(kurtosis, number(&expected["kurtosis"]), 0.02, 1.0);
}

/// Studies with every kind of zone and float: their expanded text gives the same figures to the last digit, and a sample agrees.
#[test]
fn expanded_zones_and_samples_agree() {
    let float = |float: &str| shaft(BORES).replacen("takes = 2, float = \"disc\"", &format!("takes = 2, {float}"), 1);
    let texts = [
        shaft(BORES),
        float("float = \"rim\""),
        float("float = \"uniform\", toward = [0, 1, -1]"),
        float("float = \"contact\""),
        float("toward = [0, 0, -1]"),
        float("float = \"-\", toward = \"z\""),
        shaft(BORES).replace("position = 0.1", "position = { zone = 0.1, at = \"MMC\" }"),
        shaft(BORES).replace("position = 0.1", "length = 30, position = 0.1, perpendicularity = 0.04"),
        shaft(BORES).replace("position = 0.1", "length = 30, position = { zone = 0.1, at = \"MMC\", most = 0.02 }"),
        shaft(BORES).replace("datums = \"base\" }\n[parts.shaft]", "datums = \"bore1\" }\n[parts.shaft]"),
        shaft("first = { hole = \"housing.bore1\", pin = \"shaft.journal\", takes = 4, float = \"disc\", tilt_float = true }")
            .replace("position = 0.1", "length = 30, position = 0.1"),
    ];
    for text in &texts {
        let study = parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let expanded = parse(&study.expanded).unwrap_or_else(|error| panic!("{error}\n{}", study.expanded));
        let found = moments(&study);
        assert_eq!(moments(&expanded), found, "{}", study.expanded);
        let converted =
            parse(&format!("units = \"convert\"\n{text}")).unwrap_or_else(|error| panic!("{error}\n{text}"));
        for (converted, found) in moments(&converted).iter().zip(&found) {
            // The derivatives are differences of values in metres.
            relative(converted[1], found[1], 1e-6);
        }
        let sample = simulate(&study.problem, &SimulationOptions::default().with_samples(4_000)).unwrap();
        for (one, found) in sample.characteristics.iter().zip(&found) {
            let (mean, sigma) = (one.mean.as_ref().unwrap(), one.sigma.as_ref().unwrap());
            // Four standard errors: 44 comparisons. The method itself is exact to the third order of 1e-3.
            close(mean.value, found[0], 4.0 * mean.standard_error.unwrap(), 1.0);
            close(sigma.value, found[1], 4.0 * sigma.standard_error.unwrap() + 1e-3 * sigma.value, 1.0);
        }
    }
}

/// Wrong zones and floats: each message names the line and the remedy.
#[test]
fn every_wrong_zone_names_its_remedy() {
    let lid = "lid = { plane = [0, 0, \"t\"], normal = \"z\"";
    let bore = "bore = { axis = [10, 10, 15], along = \"z\"";
    let seat = "seat = { on = \"table.top\", against = \"block.foot\", takes = 3 }";
    for (feature, joint, key, what, remedy) in [
        (
            &format!("{lid}, profile = 0.1, datums = \"lid\" }}"),
            "",
            "parts.block.lid.datums",
            "`lid` is its own datum",
            "name other features",
        ),
        (
            &format!("{lid}, profile = 0.1, datums = \"foot sied\" }}"),
            "",
            "parts.block.lid.datums",
            "no feature of this part `sied`",
            "`side`",
        ),
        (
            &format!(
                "{lid}, profile = 0.1, datums = \"foot bottom\" }}\nbottom = {{ plane = [0, 0, -1], normal = \"-z\" }}"
            ),
            "",
            "parts.block.lid.datums",
            "datum `bottom` fixes nothing that `foot` has not fixed",
            "another direction",
        ),
        (
            &format!("{lid}, profile = {{ zone = 0.1, at = \"MMC\" }} }}"),
            "",
            "parts.block.lid.profile.at",
            "`at` means nothing for a plane",
            "write it at the hole or pin",
        ),
        (&format!("{lid}, profile = -0.1 }}"), "", "parts.block.lid.profile", "-0.1", "0 or above"),
        (
            &format!("{lid}, runout = 0.1, diameter = 40 }}"),
            "",
            "parts.block.lid.runout",
            "measured from an axis",
            "datums = \"journal\"",
        ),
        (
            &format!("{lid}, runout = 0.1, diameter = 40, datums = \"foot\" }}"),
            "",
            "parts.block.lid.datums",
            "datum `foot` is a plane",
            "name an axis first",
        ),
        (
            &format!("{lid}, perpendicularity = 0.1, datums = \"side\" }}"),
            "",
            "parts.block.lid.perpendicularity",
            "`length` is missing",
            "length = 40 or size",
        ),
        (
            &format!("{lid}, position = 0.1, profile = 0.2 }}"),
            "",
            "parts.block.lid.profile",
            "two zones of one thing",
            "keep the one",
        ),
        (
            &format!("{lid}, coaxiality = 0.1 }}"),
            "",
            "parts.block.lid.coaxiality",
            "means nothing for a plane",
            "write position or profile",
        ),
        (
            &format!("{bore}, flatness = 0.1 }}"),
            "",
            "parts.block.bore.flatness",
            "means nothing for an axis",
            "it is of a plane",
        ),
        (
            &format!("{bore}, position = 0.1, perpendicularity = 0.2, length = 30 }}"),
            "",
            "parts.block.bore.perpendicularity",
            "refines nothing",
            "tighter zone",
        ),
        (
            &format!("{bore}, position = {{ zone = 0.1, at = \"MMC\" }} }}"),
            "",
            "parts.block.bore.position",
            "`hole` is missing",
            "hole = \"D\"",
        ),
        (
            &format!("{bore}, position = 0.1, distribution = \"flat\" }}"),
            "",
            "parts.block.bore.distribution",
            "no law of a zone `flat`",
            "normal",
        ),
        (&format!("{bore}, position = \"q\" }}"), "", "parts.block.bore.position", "no dimension or formula `q`", ""),
        (&format!("{bore}, position = 0.1, length = 0 }}"), "", "parts.block.bore.length", "0", "above 0"),
        (&format!("{bore}, postion = 0.1 }}"), "", "parts.block.bore.postion", "no key `postion`", "position"),
        (
            &format!(
                "{bore}, position = 0.1, datums = \"peg\" }}\npeg = {{ axis = [0, 0, 0], along = \"z\", position = 0.1, datums = \"bore\" }}"
            ),
            "",
            "parts.block",
            "measured from each other",
            "third feature",
        ),
        (
            &format!("{bore}, diameter = 10 }}"),
            "pin = { hole = \"block.bore\", pin = \"table.peg\", takes = 2, float = \"disc\" }",
            "joints.pin.float.hole",
            "nothing floats",
            "swap them",
        ),
        (
            &format!("{bore} }}"),
            "pin = { hole = \"block.bore\", pin = \"table.peg\", takes = 2, float = \"disc\" }",
            "joints.pin.float",
            "`diameter` is missing",
            "diameter of `block.bore`",
        ),
        (
            &format!("{bore}, diameter = 13 }}"),
            "pin = { hole = \"block.bore\", pin = \"table.peg\", takes = 2, float = \"disk\" }",
            "joints.pin.float",
            "no law of a float `disk`",
            "disc",
        ),
        (
            &format!("{bore}, diameter = 13 }}"),
            "pin = { hole = \"block.bore\", pin = \"table.peg\", takes = 2, toward = \"z\" }",
            "joints.pin.toward",
            "a direction across the hole",
            "",
        ),
        (
            &format!("{bore}, diameter = 13 }}"),
            "pin = { hole = \"block.bore\", pin = \"table.peg\", takes = 2, tilt_float = true }",
            "joints.pin.tilt_float",
            "leaves the tilts free",
            "takes = 4",
        ),
        (
            &format!("{bore} }}"),
            "other = { on = \"table.fence\", against = \"block.side\", takes = 1, float = \"disc\" }",
            "joints.other.float",
            "means nothing for this joint",
            "a hole with a pin",
        ),
    ] {
        let text = format!(
            r#"
[dimensions]
t = {{ nominal = 30, tolerance = 0.1, unit = "mm" }}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
fence = {{ plane = [0, 0, 0], normal = "x" }}
peg = {{ axis = [10, 10, 0], along = "z", diameter = 12 }}
[parts.block]
foot = {{ plane = [0, 0, 0], normal = "-z" }}
side = {{ plane = [0, 0, 0], normal = "-x" }}
{feature}
[joints]
{seat}
{joint}
[characteristics]
height = {{ of = "block.foot", from = "table.top", unit = "mm" }}
"#
        );
        let error = parse(&text).expect_err(feature);
        assert!(error.key.starts_with(key), "{feature} {joint}: {}: {error}", error.key);
        let said = error.to_string();
        assert!(said.contains(what), "{feature} {joint}: {said}");
        assert!(said.contains(remedy), "{feature} {joint}: {said}");
        assert!(error.line_column().is_some(), "{feature} {joint}: {said}");
    }
}

/// Texts of the numbers of zones, and a feature that moves with its datum.
#[test]
fn a_feature_moves_with_its_datum() {
    let text = |bore2: &str, tip: &str| {
        format!(
            r#"
[dimensions]
t = {{ nominal = 30, tolerance = 0.1, unit = "mm" }}
gap = {{ nominal = 80, tolerance = 0.1, unit = "mm" }}
[parts.housing]
base = {{ plane = [0, 0, 0], normal = "z" }}
bore1 = {{ axis = [0, 0, 50], along = "x", length = 20, position = 0.1, datums = "base" }}
bore2 = {{ axis = ["gap", 0, 50], along = "x", {bore2} datums = "bore1" }}
[parts.rod]
at = [80, 0, 50]
ball = {{ point = [0, 0, 0] }}
tip = {{ point = [0, 0, 0] }}
[joints]
ball = {{ hole = "housing.bore2", ball = "rod.ball" }}
[characteristics]
z = {{ of = "rod.ball", from = "housing.base", unit = "mm" }}
{tip}
"#
        )
    };
    let found = |text: &str| moments(&parse(text).unwrap_or_else(|error| panic!("{error}\n{text}")));
    // Both ends of bore1 have sigma 0.05/3. At 80 from the middle of a length of 20 its axis is 4 times the one end less 3 times... by hand:
    // z = (e1 + e2)/2 + 80 (e2 - e1)/20 = 4.5 e2 - 3.5 e1.
    let own = 0.05 / 3.0;
    relative(found(&text("", ""))[0][1], own * f64::hypot(4.5, 3.5), 1e-6);
    // With a coaxiality of its own, of half the zone 0.02.
    let both = f64::hypot(own * f64::hypot(4.5, 3.5), 0.02 / 3.0);
    relative(found(&text("coaxiality = 0.04,", ""))[0][1], both, 1e-6);
}

/// Flatness acts at the contact: half the zone on either side, or all of it outside.
#[test]
fn form_acts_at_the_contact() {
    let text = r#"
[dimensions]
t = { nominal = 30, unit = "mm" }
[parts.table]
top = { plane = [0, 0, 0], normal = "z", flatness = 0.06 }
[parts.block]
foot = { plane = [0, 0, 0], normal = "-z", flatness = { zone = 0.06, side = "out", distribution = "uniform" } }
lid = { plane = [0, 0, "t"], normal = "z", flatness = 0.5 }
[joints]
seat = { on = "table.top", against = "block.foot", takes = 3, gap = 0.5 }
[characteristics]
height = { of = "block.lid", from = "table.top", unit = "mm" }
"#;
    let study = parse(text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(study.problem.dimensions().len(), 3, "the lid touches nothing");
    let [mean, sigma, _] = moments(&study)[0];
    relative(mean, 30.53, 1e-9);
    relative(sigma, f64::hypot(0.01, 0.06 / 12f64.sqrt()), 1e-7);
}

/// A pattern as one body: a displacement, and a turn about its middle with the lever of each hole.
#[test]
fn a_pattern_moves_and_turns_as_one_body() {
    let text = |law: &str, within: &str| {
        format!(
            r#"
[dimensions]
t = {{ nominal = 30, tolerance = 0.1, unit = "mm" }}
[parts.flange]
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
h1 = {{ axis = [40, 0, 0], along = "z" }}
h2 = {{ axis = [0, 40, 0], along = "-z" }}
h3 = {{ axis = [-40, 0, 0], along = "z" }}
h4 = {{ axis = [0, -40, 0], along = "z" }}
[parts.flange.patterns]
bolts = {{ of = ["h1", "h2", "h3", "h4"], position = {{ zone = 0.6{law} }}{within} }}
[parts.rod]
at = [40, 0, 0]
ball = {{ point = [0, 0, 0] }}
[parts.other]
at = [0, 40, 0]
ball = {{ point = [0, 0, 0] }}
[joints]
ball = {{ hole = "flange.h1", ball = "rod.ball" }}
other = {{ hole = "flange.h2", ball = "other.ball" }}
[characteristics]
x = {{ of = "rod.ball", from = "flange.frame", along = "x", unit = "mm" }}
y = {{ of = "rod.ball", from = "flange.frame", along = "y", unit = "mm" }}
x2 = {{ of = "other.ball", from = "flange.frame", along = "x", unit = "mm" }}
"#
        )
    };
    let found = |law: &str, within: &str| {
        let text = text(law, within);
        moments(&parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}")))
    };
    let variances = |of: &[[f64; 3]]| of.iter().map(|one| (one[1] / 0.3).powi(2)).collect::<Vec<_>>();
    // Half the zone is 0.3. The turn moves h1 along y, and h2 along x.
    for (found, expected) in variances(&found("", "")).iter().zip([1.0 / 9.0, 1.5 / 9.0, 1.5 / 9.0]) {
        relative(*found, expected, 1e-7);
    }
    let even = ", distribution = \"uniform\"";
    for (found, expected) in variances(&found(even, "")).iter().zip([0.15, 0.25, 0.25]) {
        relative(*found, expected, 1e-7);
    }
    // Each hole within 0.3 of its own.
    let own = 0.25 / 9.0;
    for (found, expected) in variances(&found(even, ", within = 0.3")).iter().zip([0.15, 0.25, 0.25]) {
        relative(*found, expected + own, 1e-7);
    }
}

/// The examples of drawings keep their units, checked and as written, and have the mobility that their text says.
#[test]
fn examples_of_drawings_check_their_units() {
    let studies = [("examples/shaft-two-bores/study.toml", 1), ("tests/data/assembly3d/bolted-flange.toml", 0)];
    for (name, free) in studies {
        let text = read(name);
        let study = parse(&text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(study.mobility.as_ref().unwrap().free.len(), free, "{name}");
        let checked = parse(&format!("units = \"check\"\n{text}")).unwrap_or_else(|error| panic!("{error}"));
        let warned = checked.warnings.iter().any(|warning| warning.code().contains("unit"));
        assert!(!warned, "{name}: {:?}", checked.warnings);
        let found = moments(&study);
        assert_eq!(moments(&parse(&study.expanded).unwrap()), found, "{name}");
        assert!(study.expanded.contains("3 sigma = half the zone"), "{}", study.expanded);
    }
}
