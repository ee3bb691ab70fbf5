//! Messages: wrongly built assemblies, and points at which an assembly does not close.

use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol_study::Study;
use sensitol_testing::{close, parse, read};

use super::spatial::{HEIGHT, SEATED, plate};

/// Wrongly built assemblies: each message names the part or joint, the motion or equation, and what to write instead.
#[test]
fn every_wrong_assembly_names_its_remedy() {
    let seat = r#"seat = { on = "table.top", against = "plate.bottom" }"#;
    let corner = r#"x = { of = "plate.corner", from = "table.frame", along = "x" }"#;
    for (joints, characteristics, key, what, remedy) in [
        (seat, corner, "characteristics.x", "`x` depends on it", "add a joint that stops it"),
        (
            &format!("{SEATED}\nagain = {{ on = \"table.top\", against = \"plate.bottom\" }}"),
            HEIGHT,
            "joints.again",
            "only 0 of these are free",
            "remove `again`",
        ),
        (
            "seat = { on = \"table.top\", against = \"plate.lid\" }",
            HEIGHT,
            "joints.seat",
            "look the same way",
            "normal",
        ),
        (
            "seat = { on = \"table.peg\", against = \"plate.bottom\" }",
            HEIGHT,
            "joints.seat",
            "connects axis `table.peg`",
            "name a plane and a plane",
        ),
        (
            "seat = { on = \"table.top\", against = \"table.stop\" }",
            HEIGHT,
            "joints.seat",
            "two features of part `table`",
            "another part",
        ),
        (
            "seat = { on = \"table.top\", against = \"plate.bottom\", takes = 4 }",
            HEIGHT,
            "joints.seat",
            "cannot take 4",
            "takes = 3 or 2 or 1",
        ),
        (
            "seat = { on = \"table.top\", against = \"plate.botom\" }",
            HEIGHT,
            "joints.seat.against",
            "no feature `plate.botom`",
            "plate.bottom",
        ),
        ("seat = { on = \"table.top\" }", HEIGHT, "joints.seat", "`against` is missing", "against = \"part.feature\""),
        (
            "seat = { upon = \"table.top\", against = \"plate.bottom\" }",
            HEIGHT,
            "joints.seat",
            "`on` is missing",
            "on = \"part.feature\"",
        ),
        (
            "seat = { on = \"table.top\", against = \"plate.bottom\", gab = 1 }",
            HEIGHT,
            "joints.seat.gab",
            "no key `gab`",
            "gap",
        ),
        ("rod = { rod = [\"table.mark\", \"plate.corner\"] }", HEIGHT, "joints.rod", "`length` is missing", "length"),
        ("rod = { rod = [\"table.mark\"], length = 3 }", HEIGHT, "joints.rod.rod", "list of two features", ""),
        (seat, "h = { of = \"plate.lid\" }", "characteristics.h", "`from` is missing", "from = \"part.feature\""),
        (
            seat,
            "h = { of = \"plate.lit\", from = \"table.top\" }",
            "characteristics.h.of",
            "no feature `plate.lit`",
            "plate.lid",
        ),
        (
            seat,
            "h = { of = \"plate.lid\", from = \"table.top\", along = \"q\" }",
            "characteristics.h.along",
            "no coordinate `q`",
            "",
        ),
        (
            seat,
            "h = { of = \"plate.lid\", from = \"table.top\", formula = \"t\" }",
            "characteristics.h",
            "keep one",
            "",
        ),
        (seat, "h = { angle = [\"plate.lid\"] }", "characteristics.h.angle", "list of two features", ""),
        (
            "round = { inside = \"table.peg\", outside = \"plate.hole\" }",
            HEIGHT,
            "joints.round",
            "has no direction there",
            "two offsets",
        ),
        ("", HEIGHT, "parts.plate", "part `plate` has no joint", "add a joint"),
        (
            "seat = { on = \"table.top\", against = \"plate.bottom\", gap = \"nothing\" }",
            HEIGHT,
            "joints.seat.gap",
            "nothing",
            "",
        ),
        (
            &format!("{seat}\nrod = {{ rod = [\"table.mark\", \"plate.corner\"], length = 1 }}"),
            HEIGHT,
            "joints.rod",
            "do not close at the nominal sizes",
            "check the places",
        ),
        (
            "side = { on = \"table.fence\", against = \"plate.left\", takes = 2 }\nseat = { on = \"table.top\", against = \"plate.bottom\" }",
            HEIGHT,
            "joints.side",
            "joint `side` takes 2 and so leaves out a tilt, and no joint before it holds one",
            "the primary datum takes 3: put `side` after `seat`, or say takes = 3",
        ),
        (
            "side = { on = \"table.fence\", against = \"plate.left\", takes = 2 }\nstop = { on = \"table.stop\", against = \"plate.front\", takes = 1 }",
            HEIGHT,
            "joints.side",
            "no joint before it holds one",
            "say takes = 3, or put `side` after the joint that holds its tilt",
        ),
        (
            &format!("{seat}\npin = {{ hole = \"plate.hole\", pin = \"table.peg\" }}"),
            HEIGHT,
            "joints.pin",
            "joint `pin` takes 4, and only 2 of these are free after `seat` (offset along x, offset along y)",
            "write takes = 2 for `pin`",
        ),
        (
            &format!("{SEATED}\nrod = {{ rod = [\"table.mark\", \"plate.corner\"], length = 46 }}"),
            HEIGHT,
            "joints.rod",
            "joint `rod` takes 1, and only 0 of these are free after `seat`, `side`, `end`: 7 equations for 6 unknowns, rank 6",
            "remove `rod`, or let a joint before it take less",
        ),
        (
            "seat = { on = \"table.top\", against = \"plate.bottom\" }\npin = { hole = \"table.peg\", pin = \"plate.hole\", takes = 2 }",
            r#"turn = { of = "plate.corner", from = "table.frame", along = "y" }"#,
            "characteristics.turn",
            "plate turns about the axis of plate.hole, and `turn` depends on it",
            "let `turn` measure something that does not depend on it",
        ),
    ] {
        let error = plate(joints, characteristics).expect_err(joints);
        assert_eq!(error.key, key, "{joints}: {error}");
        let said = error.to_string();
        assert!(said.contains(what), "{joints}: {said}");
        assert!(said.contains(remedy), "{joints}: {said}");
    }
    let error = parse("[dimensions]\na = { nominal = 1 }\n[characteristics]\nh = { of = \"a.b\", from = \"a.c\" }")
        .unwrap_err();
    assert!(error.to_string().contains("[parts]"), "{error}");
}

/// Wrongly pressed tables: each message names the joint, what is wrong, and what to write instead.
#[test]
fn every_wrong_press_names_its_remedy() {
    let four = r#"targets = ["table.leg1", "table.leg2", "table.leg3", "table.leg4"]"#;
    let stand = |rest: &str| format!("stand = {{ on = \"floor.top\", {rest} }}");
    let tilt = r#"tilt = { of = "table.leg2", from = "floor.top", along = "z" }"#;
    let height = r#"height = { of = "table.middle", from = "floor.top", unit = "mm" }"#;
    for (joints, measure, key, what, remedy) in [
        (
            stand(&format!("{four}, press = [0, 0.1, -1]")),
            height,
            "joints.stand",
            "leaves `table` sliding: its force has a part along `floor.top`",
            "press along the normal of `floor.top`, or put the joints that stop the part before this one",
        ),
        (
            stand("targets = [\"table.leg1\", \"table.leg2\"], press = \"-z\""),
            height,
            "joints.stand",
            "names 2 contacts, and needs 3 to 12",
            "against = \"part.point\"",
        ),
        (
            stand("targets = [\"table.leg1\", \"table.middle\", \"table.leg3\"], press = \"-z\""),
            height,
            "joints.stand",
            "has its contacts in a line: `leg1`, `middle` and `leg3`",
            "add a contact beside the line",
        ),
        (
            stand(&format!("{four}, weight_at = \"table.lamp\"")),
            height,
            "joints.stand",
            "lets `table` tip over: its force lies outside the contacts",
            "move `weight_at` between the contacts",
        ),
        (
            stand(&format!("{four}, press = \"z\"")),
            height,
            "joints.stand",
            "presses `table` away from its contacts",
            "turn the direction of `press` around",
        ),
        (
            stand(&format!("{four}, press = \"-z\"")),
            tilt,
            "joints.stand",
            "lets `table` rock on `leg1` and `leg3`, and `tilt` depends on the side to which it does",
            "move `weight_at` off the line of `leg1` and `leg3`",
        ),
        (
            stand(&format!("{four}, press = \"-z\", takes = 3")),
            height,
            "joints.stand",
            "`press` and `takes`",
            "leave out `takes`",
        ),
        (
            stand(&format!("{four}, press = \"-z\", against = \"table.bottom\"")),
            height,
            "joints.stand.targets",
            "`against` and `targets`",
            "keep one",
        ),
        (
            stand("press = \"-z\", against = \"table.bottom\""),
            height,
            "parts.table.bottom",
            "`size` is missing",
            "size = [60, 40]",
        ),
        (
            stand("press = \"-z\", against = \"table.leg1\""),
            height,
            "joints.stand",
            "`press` and `against`",
            "a plane with flatness and size, or write the contact points as `targets`",
        ),
        (
            stand("press = \"-z\", against = \"table.plate\""),
            height,
            "parts.table.plate",
            "`flatness` is missing",
            "leave out `press`",
        ),
        (stand("press = \"-z\""), height, "joints.stand", "`targets` is missing", "\"table.leg1\""),
        (stand(four), height, "joints.stand", "`press` is missing", "press = [0, 0, -1]"),
        (
            stand(&format!("{four}, press = [0, 0, 0]")),
            height,
            "joints.stand.press",
            "a direction of numbers in the assembly",
            "",
        ),
        (
            stand("targets = [\"table.leg1\", \"table.leg2\", \"table.bottom\"], press = \"-z\""),
            height,
            "joints.stand",
            "has a plane `table.bottom` among its targets, and needs points",
            "a feature with `point`",
        ),
        (
            stand("targets = [\"table.leg1\", \"table.leg2\", \"floor.mark\"], press = \"-z\""),
            height,
            "joints.stand",
            "has `floor.mark` among its targets",
            "name contacts of one part",
        ),
        (
            stand("targets = [\"table.leg1\", \"table.leg2\", \"table.leg1\"], press = \"-z\""),
            height,
            "joints.stand",
            "names `table.leg1` twice",
            "name each contact once",
        ),
        (
            stand(&format!("{four}, weight_at = \"floor.mark\"")),
            height,
            "joints.stand",
            "has its force at `floor.mark`, and that part is not moved by it",
            "a feature of the part that rests on the contacts",
        ),
        (
            format!(
                "seat = {{ on = \"floor.top\", against = \"table.bottom\" }}\n{}",
                stand(&format!("{four}, press = \"-z\""))
            ),
            height,
            "joints.stand",
            "the joints before it leave nothing to press",
            "remove `press`, or let the joints before it take less",
        ),
        (
            format!(
                "{}\nseat = {{ on = \"floor.top\", against = \"table.bottom\" }}",
                stand(&format!("{four}, press = \"-z\""))
            ),
            height,
            "joints.seat",
            "only 0 of these are free after `stand`",
            "remove `seat`, or let a joint before it take less",
        ),
    ] {
        let error = table(&joints, measure).expect_err(&joints);
        assert_eq!(error.key, key, "{joints}: {error}");
        let said = error.to_string();
        assert!(said.contains(what), "{joints}: {said}");
        assert!(said.contains(remedy), "{joints}: {said}");
    }
}

/// A table on a floor.
fn table(joints: &str, measure: &str) -> Result<Study, sensitol_study::StudyError> {
    parse(&format!(
        r#"
[dimensions]
h = {{ nominal = 70, tolerance = 0.1, unit = "mm" }}
[parts.floor]
top = {{ plane = [0, 0, 0], normal = "z" }}
mark = {{ point = [0, 0, 0] }}
[parts.table]
at = [0, 0, 70]
bottom = {{ plane = [0, 0, "-h"], normal = "-z" }}
plate = {{ plane = [0, 0, "-h"], normal = "-z", size = [60, 40] }}
middle = {{ point = [0, 0, "-h"] }}
leg1 = {{ point = [-30, -20, "-h"] }}
leg2 = {{ point = [30, -20, "-h"] }}
leg3 = {{ point = [30, 20, "-h"] }}
leg4 = {{ point = [-30, 20, "-h"] }}
lamp = {{ point = [35, 0, 0] }}
[joints]
{joints}
[characteristics]
{measure}
"#
    ))
}

/// Planes that must lie on each other and are parallel to none: the residual of a direction is an angle.
#[test]
fn an_open_direction_is_an_angle() {
    // The hole is 30 degrees off the normal of the seat, which holds both tilts.
    let error = parse(
        r#"
[dimensions]
t = { nominal = 12, tolerance = 0.1, unit = "mm" }
[parts.table]
top = { plane = [0, 0, 0], normal = "z" }
peg = { axis = [0, 0, 0], along = [0.5, 0, 0.8660254037844386] }
[parts.plate]
bottom = { plane = [0, 0, 0], normal = "-z" }
lid = { plane = [0, 0, "t"], normal = "z" }
hole = { axis = [0, 0, 0], along = "z" }
[joints]
seat = { on = "table.top", against = "plate.bottom" }
pin = { hole = "table.peg", pin = "plate.hole" }
[characteristics]
height = { of = "plate.lid", from = "table.top", unit = "mm" }
"#,
    )
    .unwrap_err();
    // The equations contradict each other, so the joints are found to repeat others or to be open. Either way a joint is named.
    assert_eq!(error.key, "joints.pin", "{error}");
}

/// The error at a point, with some dimensions at other values.
fn failure(study: &Study, moved: &[(&str, f64)]) -> String {
    let point = study.problem.dimensions().iter().map(|dimension| {
        let found = moved.iter().find(|(name, _)| *name == dimension.name());
        found.map_or(dimension.nominal(), |(_, value)| *value)
    });
    let points = Points::from_rows(&[point.collect::<Vec<f64>>()]);
    let mut found = Responses::open(1, 1);
    study.problem.function().evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut found);
    found.error(0, 0).expect("no solution").to_string()
}

const ARM: &str = r#"
[dimensions]
L = { nominal = 62, tolerance = 1, unit = "mm" }
[parts.base]
pivot = { frame = [0, 0, 0], z = "z", x = "x" }
anchor = { point = [80, 0, 0] }
[parts.arm]
turned = [0, 0, 20]
hub = { frame = [0, 0, 0], z = "z", x = "x" }
tip = { point = [20, 0, 0] }
[joints]
pivot = { revolute = ["base.pivot", "arm.hub"] }
link = { rod = ["base.anchor", "arm.tip"], length = "L" }
[characteristics]
y = { of = "arm.tip", from = "base.pivot", along = "y", unit = "mm" }
"#;

/// A rod between a pivoted arm of 20 and an anchor 80 away: the ends are between 60 and 100 apart.
#[test]
fn a_rod_that_cannot_reach_is_named_with_its_lengths() {
    let study = parse(ARM).unwrap();
    let said = failure(&study, &[("L", 59.0)]);
    let lengths = said.strip_prefix("the joints do not close: rod `link` (59 mm) cannot reach: its ends are ");
    let apart: f64 = lengths.unwrap_or_else(|| panic!("{said}")).split(' ').next().unwrap().parse().unwrap();
    // The search ends near the closest position, where the distance is flat.
    assert!((apart - 60.0).abs() < 0.01, "{said}");
    let said = failure(&study, &[("L", 101.0)]);
    assert!(said.contains("rod `link` (101 mm) is too long: its ends are "), "{said}");
    // With converted units the scales of the equations are others: the search may end with the pivot open. Lengths are in the unit of the
    // study all the same.
    let study = parse(&format!("units = \"convert\"\n{ARM}")).unwrap();
    let said = failure(&study, &[("L", 59.0)]);
    assert!(said.starts_with("the joints do not close: "), "{said}");
    let (rod, pivot) = (said.contains("rod `link` (59 mm) cannot reach"), said.contains("joint `pivot` (offset along"));
    assert!(rod || (pivot && said.contains(" mm")), "{said}");
}

/// A rod that is 8 mm too short to reach a plate on its seat: the amount has the unit of the study, also where formulas are in metres.
#[test]
fn an_open_distance_has_the_unit_of_the_study() {
    let amount = |mode: &str| -> f64 {
        let error = parse(&format!(
            r#"
units = "{mode}"
[dimensions]
t = {{ nominal = 12, tolerance = 0.1, unit = "mm" }}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
mark = {{ point = [0, 0, 40] }}
[parts.plate]
bottom = {{ plane = [0, 0, 0], normal = "-z" }}
corner = {{ point = [0, 3, "t"] }}
[joints]
seat = {{ on = "table.top", against = "plate.bottom" }}
rod = {{ rod = ["table.mark", "plate.corner"], length = 20 }}
[characteristics]
height = {{ of = "plate.corner", from = "table.top", unit = "mm" }}
"#
        ));
        let said = error.unwrap_err().to_string();
        let amount = said.split("is off by ").nth(1).and_then(|rest| rest.split(" mm (").next()?.parse().ok());
        amount.unwrap_or_else(|| panic!("{mode}: {said}"))
    };
    let [checked, converted] = ["check", "convert"].map(amount);
    // The residual is shared by the rod and the seat, and is not above the 8 mm of the rod.
    assert!(checked > 0.1 && checked < 8.1, "{checked}");
    close(converted, checked, 1e-3, 0.0);
}

/// Motions of two parts that are fixed to each other have the same words, and names of their own: the expanded study can be read.
#[test]
fn free_motions_alike_have_names_of_their_own() {
    let study = parse(
        r#"
[dimensions]
t = { nominal = 12, tolerance = 0.1, unit = "mm" }
[parts.block]
bore = { axis = [0, 0, 0], along = "z" }
[parts.shaft]
journal = { axis = [0, 0, 0], along = "z" }
end = { frame = [0, 0, 20], z = "z", x = "x" }
[parts.wheel]
hub = { frame = [0, 0, 0], z = "z", x = "x" }
rim = { point = [5, 0, "t"] }
[joints]
fit = { hole = "block.bore", pin = "shaft.journal", takes = 4 }
weld = { rigid = ["shaft.end", "wheel.hub"] }
[characteristics]
height = { of = "wheel.rim", from = "shaft.end", along = "z", unit = "mm" }
"#,
    )
    .unwrap();
    let free = &study.mobility.as_ref().unwrap().free;
    assert_eq!(free[..], ["shaft, wheel move together", "shaft, wheel move together (2)"]);
    let expanded = parse(&study.expanded).unwrap();
    let [own, plain] = [&study, &expanded].map(|study| sensitol::analyze(&study.problem, &study.options).unwrap());
    assert_eq!(own.characteristics[0].moments, plain.characteristics[0].moments);
}

/// A link of the crank slider that is too short opens a ball joint.
#[test]
fn a_joint_that_does_not_close_at_a_point_is_named() {
    let study = parse(&read("examples/crank-slider-space/study.toml")).unwrap();
    let said = failure(&study, &[("L", 9.0)]);
    assert!(said.starts_with("the joints do not close: joint `"), "{said}");
    assert!(said.contains("followed for"), "{said}");
    assert!(["`one`", "`two`", "`way`"].iter().any(|joint| said.contains(joint)), "{said}");
}

/// Equations that add little to those before them are doubtful.
#[test]
fn a_doubtful_rank_is_told() {
    let study = |tilt: f64| {
        parse(&format!(
            r#"
[dimensions]
t = {{ nominal = 12, tolerance = 0.1, unit = "mm" }}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
frame = {{ frame = [0, 0, 0], z = "z", x = "x" }}
other = {{ frame = [0, 0, 0], z = "z", x = [1, {tilt:e}, 0] }}
mark = {{ point = [0, 0, 0] }}
[parts.plate]
bottom = {{ plane = [0, 0, 0], normal = "-z" }}
corner = {{ point = [40, 0, "t"] }}
near = {{ axis = [40, 0, 0], along = "z" }}
far = {{ axis = [40, {place:e}, 0], along = "z" }}
[joints]
seat = {{ on = "table.top", against = "plate.bottom" }}
one = {{ slot = "table.frame", pin = "plate.near", takes = 1 }}
two = {{ slot = "table.other", pin = "plate.near", takes = 1 }}
[characteristics]
height = {{ of = "plate.corner", from = "table.top", unit = "mm" }}
"#,
            place = 0.0
        ))
    };
    let doubtful = study(1e-8).unwrap().mobility.unwrap().doubtful;
    assert_eq!(doubtful.len(), 1, "{doubtful:?}");
    assert!(doubtful[0].contains("joint `two` (offset across the slot) adds only"), "{doubtful:?}");
    assert!(study(1e-3).unwrap().mobility.unwrap().doubtful.is_empty());
    assert_eq!(study(0.0).unwrap_err().key, "joints.two");
}
