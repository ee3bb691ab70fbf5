//! Two datum frames of one feature: a position from A B C, and an orientation from datums of its own.

use sensitol::analyze;
use sensitol_study::{Study, StudyError};
use sensitol_testing::{parse, relative};

/// Text of a block with a bore and a rod in it, whose tip is 100 mm above the middle of the bore.
fn text(lid: &str, perpendicularity: &str) -> String {
    format!(
        r#"
[dimensions]
t = {{ nominal = 30, unit = "mm" }}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
fence = {{ plane = [0, 0, 0], normal = "x" }}
stop = {{ plane = [0, 0, 0], normal = "y" }}
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
[parts.block]
foot = {{ plane = [0, 0, 0], normal = "-z", x = "x" }}
side = {{ plane = [0, 0, 0], normal = "-x" }}
end = {{ plane = [0, 0, 0], normal = "-y" }}
lid = {{ plane = [0, 0, "t"], normal = "z", x = "x", datums = "foot"{lid} }}
bore = {{ axis = [40, 25, 15], along = "z", x = "x", length = 20, position = 0.2, datums = "foot side end", perpendicularity = {perpendicularity} }}
[parts.rod]
at = [40, 25, 15]
pin = {{ axis = [0, 0, 0], along = "z" }}
middle = {{ point = [0, 0, 0] }}
tip = {{ point = [0, 0, 100] }}
[joints]
seat = {{ on = "table.top", against = "block.foot", takes = 3 }}
left = {{ on = "table.fence", against = "block.side", takes = 2 }}
front = {{ on = "table.stop", against = "block.end", takes = 1 }}
fit = {{ hole = "block.bore", pin = "rod.pin", takes = 4 }}
[characteristics]
tip = {{ of = "rod.tip", from = "table.frame", along = "x", unit = "mm" }}
middle = {{ of = "rod.middle", from = "table.frame", along = "x", unit = "mm" }}
"#
    )
}

fn sigmas(text: &str) -> ([f64; 2], Study) {
    let study = parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let found = analyze(&study.problem, &study.options).unwrap();
    ([0, 1].map(|c| found.characteristics[c].moments.unwrap().sigma()), study)
}

/// The bore tilts with the lid, from which its perpendicularity is measured, and its place does not move with it. The two tilts are
/// independent, so that the squares of their effects add: those of the lid have the lever from the middle of the bore to the tip.
#[test]
fn an_orientation_has_datums_of_its_own() {
    let ([tip, middle], _) = sigmas(&text("", "0.02"));
    let lid = ", size = [30, 30], parallelism = 0.06";
    let ([same, _], _) = sigmas(&text(lid, "0.02"));
    relative(same, tip, 1e-9);
    let ([tilted, still], study) = sigmas(&text(lid, "{ zone = 0.02, datums = \"lid\" }"));
    relative(still, middle, 1e-9);
    let tilts: Vec<f64> = (study.problem.dimensions().iter())
        .filter(|one| one.name().starts_with("block.lid.") && one.name().ends_with('y'))
        .map(|one| one.sigma())
        .collect();
    assert_eq!(tilts.len(), 1, "{:?}", study.problem.dimensions().iter().map(|one| one.name()).collect::<Vec<_>>());
    // The bore stands 100 mm below the tip, and a tilt of 1e-3 has a cosine of 1 but for 5e-7.
    relative(tilted, f64::hypot(tip, 100.0 * tilts[0]), 1e-4);
    // The expanded study has the same figures.
    let ([expanded, _], _) = sigmas(&study.expanded);
    assert_eq!(expanded, tilted);
}

#[test]
fn wrong_datums_of_an_orientation_name_the_remedy() {
    for (perpendicularity, what, remedy) in [
        ("{ zone = 0.02, datums = \"lit\" }", "no feature of this part `lit`", "`lid`"),
        ("{ zone = 0.02, datums = \"bore\" }", "`bore` is its own datum", "name other features"),
        ("{ zone = 0.02, datums = \"foot lid\" }", "datum `lid` fixes nothing that `foot` has", "another direction"),
        ("{ zone = 0.02, datums = 3 }", "the names of features of this part", ""),
    ] {
        let error: StudyError = parse(&text("", perpendicularity)).expect_err(perpendicularity);
        assert_eq!(error.key, "parts.block.bore.perpendicularity.datums", "{error}");
        let said = error.to_string();
        assert!(said.contains(what) && said.contains(remedy), "{perpendicularity}: {said}");
    }
}

/// Text of a plate on a fixture by datum targets: three under it, two beside it, one at its end. `bottom` holds further keys of its bottom.
fn plate(units: &str, bottom: &str, joint: &str) -> String {
    format!(
        r#"
units = "{units}"
[dimensions]
t = {{ nominal = 12, unit = "mm" }}
[parts.fixture]
table = {{ plane = [0, 0, 0], normal = "z" }}
fence = {{ plane = [0, 0, 0], normal = "y" }}
stop = {{ plane = [0, 0, 0], normal = "x" }}
[parts.plate]
A = {{ plane = [0, 0, 0], normal = "-z", x = "x", targets = [[20, -10], [140, -10], [80, -90]]{bottom} }}
B = {{ plane = [0, 0, 0], normal = "-y", x = "x", targets = [[20, 12], [140, 12]], flatness = 0.03 }}
C = {{ plane = [0, 0, 0], normal = "-x", x = "y", targets = [[50, 5]] }}
corner = {{ point = [160, 100, "t"] }}
[joints]
seat = {{ on = "fixture.table", against = "plate.A"{joint} }}
side = {{ on = "plate.B", against = "fixture.fence" }}
end = {{ on = "fixture.stop", against = "plate.C", takes = 1 }}
[characteristics]
height = {{ of = "plate.corner", from = "fixture.table", unit = "mm" }}
across = {{ of = "plate.corner", from = "fixture.fence", unit = "mm" }}
"#
    )
}

/// Targets are pads under a face: by the lever rule the corner at (160, 100) follows the pads at (20, 10), (140, 10), (80, 90) by the weights
/// -1/6 - 9/16, 1 + 1/6 - 9/16 and 9/8, and the fence by -1/6 and 7/6. The form at every target is independent: half the zone is three sigma.
#[test]
fn datum_targets_are_pads_with_a_form_of_their_own() {
    let weights = [-1.0 / 6.0 - 9.0 / 16.0, 1.0 + 1.0 / 6.0 - 9.0 / 16.0, 9.0 / 8.0];
    let height = 0.06 / 6.0 * weights.iter().map(|weight: &f64| weight * weight).sum::<f64>().sqrt();
    let across = 0.03 / 6.0 * f64::hypot(1.0 / 6.0, 7.0 / 6.0);
    for units in ["check", "convert"] {
        let ([found, beside], study) = sigmas(&plate(units, ", flatness = 0.06", ""));
        // Tilts of 1e-4 turn the place by their square.
        relative(found, height, 1e-5);
        relative(beside, across, 1e-3);
        let ([again, _], _) = sigmas(&study.expanded);
        assert_eq!(again, found);
    }
    // Without form nothing varies under the plate, and with a uniform law the sigma is that of its band.
    let ([still, _], _) = sigmas(&plate("check", "", ""));
    assert!(still < 1e-6, "{still}");
    let ([uniform, _], _) = sigmas(&plate("check", ", flatness = { zone = 0.06, distribution = \"uniform\" }", ""));
    relative(uniform, height * 3f64.sqrt(), 1e-5);
}

#[test]
fn wrong_targets_name_the_remedy() {
    for (bottom, joint, key, what) in [
        ("", ", takes = 2", "joints.seat.takes", "3 targets of the face take as many freedoms"),
        (", flatness = \"t\"", "", "parts.plate.A.flatness", "a number of 0 or above"),
        (", flatness = { zone = 0.06, side = \"in\" }", "", "parts.plate.A.flatness.side", "\"out\""),
    ] {
        let error = parse(&plate("check", bottom, joint)).expect_err(key);
        assert_eq!(error.key, key, "{error}");
        assert!(error.to_string().contains(what) && error.line_column().is_some(), "{error}");
    }
    for targets in ["[]", "[[1, 2, 3]]", "[[0, 0], [1, 0], [0, 1], [1, 1]]", "3"] {
        let text = plate("check", "", "").replace("[[20, -10], [140, -10], [80, -90]]", targets);
        let error = parse(&text).expect_err(targets);
        assert_eq!(error.key, "parts.plate.A.targets", "{error}");
        assert!(error.to_string().contains("one to three places"), "{error}");
    }
    // Sizes are about the middle of the face, so that 160 reaches to 80 at either side.
    let sized = |size: &str| parse(&plate("check", &format!(", size = {size}"), ""));
    assert!(sized("[280, 180]").is_ok());
    let error = sized("[270, 180]").expect_err("size");
    assert_eq!(error.key, "parts.plate.A.targets", "{error}");
    let said = error.to_string();
    assert!(said.contains("target 2 of `plate.A` lies at [140, -10], outside of its size [270, 180]"), "{said}");
    assert!(error.line_column().is_some());
    // Targets in a line hold no plane.
    let text = plate("check", "", "").replace("[80, -90]", "[200, -10]");
    let error = parse(&text).expect_err("in a line");
    assert!(error.to_string().contains("joint `seat 3` takes 1, and only 0"), "{error}");
}

/// Names that are made here are not those of the study, and a misspelt face is the fault that is reported.
#[test]
fn names_of_targets_are_free_and_faces_with_targets_are_used() {
    let text = plate("check", ", flatness = 0.06", "");
    let with = |line: &str, after: &str| text.replacen(after, &format!("{after}{line}\n"), 1);
    for (text, key, what) in [
        (
            with("\"A target 1\" = { point = [1, 2, 3] }", "[parts.plate]\n"),
            "parts.plate.A target 1",
            "the name `A target 1` is taken",
        ),
        (
            with("\"seat 1\" = { on = \"fixture.fence\", against = \"plate.top\" }", "[joints]\n"),
            "joints.seat 1",
            "the name `seat 1` is taken",
        ),
        (with("\"plate.A.target1\" = { nominal = 1 }", "[dimensions]\n"), "dimensions.plate.A.target1", "is taken"),
        (text.replacen("\"plate.A\"", "\"plate.a\"", 1), "joints.seat.against", "there is no feature `plate.a`"),
        (
            with("D = { plane = [0, 0, 12], normal = \"z\", targets = [[1, 2]] }", "[parts.plate]\n"),
            "parts.plate.D.targets",
            "no joint without `press` names",
        ),
    ] {
        let error = parse(&text).expect_err(key);
        assert_eq!(error.key, key, "{error}");
        assert!(error.to_string().contains(what) && error.line_column().is_some(), "{error}");
    }
    let error = parse(&text.replacen("\"plate.A\"", "\"plate.a\"", 1)).expect_err("misspelt");
    assert!(error.help().is_some_and(|text| text.contains("plate.A")), "{error:?}");
    // An unknown key of a plane lists the targets too.
    let error = parse(&text.replacen("normal = \"-z\"", "normal = \"-z\", target = [1, 2]", 1)).expect_err("key");
    assert!(error.help().is_some_and(|text| text.contains("targets")), "{error:?}");
}

/// Text of a shaft in two bearings. The ring is 40 mm beyond the second one, and its runout is about both.
fn shaft(datums: &str, bearings: [&str; 2]) -> String {
    let [a, b] = bearings;
    format!(
        r#"
[dimensions]
t = {{ nominal = 30, unit = "mm" }}
[parts.shaft]
zero = {{ frame = [0, 0, 0], z = "z", x = "x" }}
A = {{ axis = [0, 0, 10], along = "z", x = "x"{a} }}
B = {{ axis = [0, 0, 90], along = "-z", x = "x"{b} }}
face = {{ plane = [0, 0, 130], normal = "z" }}
ring = {{ axis = [0, 0, 130], along = "z", x = "x", datums = "{datums}", runout = 0.03 }}
[parts.pointer]
at = [0, 0, 130]
sleeve = {{ axis = [0, 0, 0], along = "z" }}
tip = {{ point = [0, 0, 0] }}
far = {{ point = [0, 0, 100] }}
key = {{ plane = [0, 0, 0], normal = "-z" }}
[joints]
fit = {{ hole = "shaft.ring", pin = "pointer.sleeve", takes = 4 }}
stop = {{ on = "shaft.face", against = "pointer.key", takes = 1 }}
[characteristics]
tip = {{ of = "pointer.tip", from = "shaft.zero", along = "x", unit = "mm" }}
far = {{ of = "pointer.far", from = "shaft.zero", along = "x", unit = "mm" }}
"#
    )
}

/// The line through the middles of two bearings at 10 and 90 passes a ring at 130 with the weights -0.5 and 1.5, and a point at 230 with
/// -1.75 and 2.75: the lever rule. Zones are independent, with three sigma at half their width.
#[test]
fn a_common_datum_is_the_line_through_two_middles() {
    let ([alone, _], _) = sigmas(&shaft("A-B", ["", ""]));
    let zones = [", position = 0.06", ", position = 0.12"];
    let ([tip, far], study) = sigmas(&shaft("A-B", zones));
    let [a, b] = [0.06 / 6.0, 0.12 / 6.0];
    let expected = |weights: [f64; 2]| (alone.powi(2) + (weights[0] * a).powi(2) + (weights[1] * b).powi(2)).sqrt();
    // Tilts of 1e-3 turn places by their square.
    relative(tip, expected([-0.5, 1.5]), 1e-5);
    relative(far, expected([-1.75, 2.75]), 1e-5);
    let ([again, _], _) = sigmas(&study.expanded);
    assert_eq!(again, tip);
    // The order of the two has no meaning.
    let ([turned, _], _) = sigmas(&shaft("B-A", zones));
    relative(turned, tip, 1e-9);
    // A place that is a dimension has the same lever.
    let formula = shaft("A-B", zones).replace("[0, 0, 90]", "[0, 0, \"3*t\"]");
    for units in ["", "units = \"convert\"\n"] {
        let ([found, _], _) = sigmas(&format!("{units}{formula}"));
        relative(found, tip, 1e-9);
    }
    // A single datum has other figures: its place alone moves the ring.
    let ([single, _], _) = sigmas(&shaft("A", zones));
    relative(single, expected([1.0, 0.0]), 1e-5);
}

/// Two pads in one plane, 80 mm apart along x: the block on both follows the lever rule along x, and the mean of their tilts along y.
#[test]
fn a_common_datum_of_planes_leans_by_their_heights() {
    let text = |a: &str, b: &str| {
        format!(
            r#"
[dimensions]
t = {{ nominal = 30, unit = "mm" }}
[parts.base]
zero = {{ plane = [0, 0, 0], normal = "z" }}
A = {{ plane = [10, 0, 20], normal = "z", x = "x"{a} }}
B = {{ plane = [90, 0, 20], normal = "z", x = "y"{b} }}
top = {{ plane = [130, 50, 60], normal = "z", x = "x", datums = "A-B", position = 0 }}
[parts.lid]
at = [130, 50, 60]
foot = {{ plane = [0, 0, 0], normal = "-z" }}
mark = {{ point = [0, 0, 0] }}
edge = {{ point = [0, 20, 0] }}
[joints]
seat = {{ on = "base.top", against = "lid.foot", takes = 3 }}
[characteristics]
mark = {{ of = "lid.mark", from = "base.zero", unit = "mm" }}
edge = {{ of = "lid.edge", from = "base.zero", unit = "mm" }}
"#
        )
    };
    let ([mark, _], _) = sigmas(&text(", position = 0.06", ", position = 0.12"));
    // No tilt of their own: -0.5 and 1.5 at x = 130.
    relative(mark, f64::hypot(-0.5 * 0.01, 1.5 * 0.02), 1e-5);
    // A tilt about x of 0.04 over 20 mm, of the first pad alone: half of it at 50 and at 70 mm along y.
    let ([mark, edge], study) = sigmas(&text(", parallelism = 0.04, size = [20, 20], datums = \"zero\"", ""));
    let tilt = study.problem.dimensions().iter().find(|one| one.name().starts_with("base.A.tilt")).unwrap().sigma();
    // These figures are of a sample of the model, with a standard error of 2.3e-5 of sigma.
    relative(mark, 0.5 * tilt * 50.0, 1e-4);
    relative(edge, 0.5 * tilt * 70.0, 1e-4);
}

#[test]
fn wrong_common_datums_name_the_remedy() {
    let study = shaft("A-B", ["", ""]);
    for (from, to, what, remedy) in [
        ("datums = \"A-B\"", "datums = \"A-C\"", "no feature of this part `C`", ""),
        ("datums = \"A-B\"", "datums = \"A-face\"", "they are not two axes or two planes", "\"A face\""),
        ("datums = \"A-B\"", "datums = \"A-ring\"", "`ring` is its own datum", "name other features"),
        (
            "datums = \"A-B\"",
            "datums = \"face A-B face\"",
            "datum `face` fixes nothing that `face` and `A-B` have",
            "leave it out",
        ),
        ("[0, 0, 90]", "[5, 0, 90]", "their axes are not one line", "\"A B\""),
        ("[0, 0, 90]", "[0, 0, 10]", "their middles are not apart", "\"A B\""),
        ("[0, 0, 90]", "[\"t\", 0, 90]", "different formulas", "\"A B\""),
        ("along = \"-z\"", "along = \"y\"", "their directions are not parallel", "\"A B\""),
    ] {
        let changed = study.replacen(from, to, 1);
        assert_ne!(changed, study, "{from}");
        let error: StudyError = parse(&changed).expect_err(to);
        assert_eq!(error.key, "parts.shaft.ring.datums", "{to}: {error}");
        let said = error.to_string();
        assert!(said.contains(what) && said.contains(remedy), "{to}: {said}");
    }
}
