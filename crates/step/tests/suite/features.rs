//! Features, sizes and keys of tolerances in the tables.
//!
//! Oracle: places and sizes of faces as read in the text of the NIST files by eye.

use std::collections::BTreeSet;

use super::files::bytes;
use sensitol_step::tables::{OpenReason, ReaderKeys, StepFault, StudyTables, TableFault, TableRequest, tables_of};

fn zones(name: &str) -> StudyTables {
    let request = TableRequest { keys: ReaderKeys::Zones, part: Some("part".to_owned()), ..TableRequest::default() };
    tables_of(&bytes(name), &request).unwrap()
}

/// Line of a feature or dimension, without the spaces that align it.
fn line(text: &str, name: &str) -> String {
    let found = text.lines().find(|line| line.split(" = ").next().is_some_and(|first| first.trim() == name));
    let (_, rest) = found.unwrap_or_else(|| panic!("{name} is in\n{text}")).split_once(" = ").unwrap();
    rest.to_owned()
}

#[test]
fn tolerances_are_keys_with_the_features_of_their_datums() {
    let found = zones("nist_stc_06_asme1_ap242-e3");
    // #10006: 0.025 in at maximum material, to C, A, B. 0.8125 in is the diameter #8621, of 2 holes, each with its own size.
    assert_eq!(
        line(&found.parts, "hole_1_1"),
        "{ axis = [24.60625, 127, 78.74], along = \"x\", diameter = \"hole_1_1_diameter\", length = 14.2875, \
         position = { zone = 0.635, at = \"MMC\", hole = \"hole_1_1_diameter\" }, datums = \"C A B\" }  # #10006"
    );
    let sizes = found.dimensions.join("\n");
    for hole in ["hole_1_1_diameter", "hole_1_2_diameter"] {
        assert_eq!(line(&sizes, hole), "{ nominal = 20.6375, tolerance = 0.508, unit = \"mm\" }  # #8621");
    }
    // Datum F is four holes of 0.281 in; a tolerance to it names no single feature.
    assert!(line(&found.parts, "F_4").contains("position = 0.381, datums = \"E A B\""), "{}", found.parts);
    let to_f = found.open.iter().find(|item| item.line.contains("#11135")).unwrap();
    assert_eq!(to_f.reason, OpenReason::NoKey);
    assert_eq!(to_f.line, "# position 0.508, datums F: datum F has several features (#11135)");
    // 25 tolerances, without #11135, the profiles #10498 and #10652 of cones, and their lower segments #10507 and #10661.
    assert_eq!((found.tolerances, found.written, found.waiting, found.open.len()), (25, 20, 0, 5));
    assert!(found.open.iter().filter(|item| item.line.contains("lower segment")).count() == 2);
}

/// Composite profiles: #9761 of 0.05 in to D, B, C above #9773 of 0.01 in to D, on two faces that lean by 25 degrees. ftc_06 has two such frames,
/// and ctc_03 an angularity #36 of 0.04 in to A beside the profile #38 of the same face.
#[test]
fn lower_segments_bound_the_direction_of_each_face() {
    let found = zones("nist_stc_06_asme1_ap242-e3");
    for face in ["face_3_1", "face_3_2"] {
        let text = line(&found.parts, face);
        let keys = "profile = 1.27, angularity = { zone = 0.254, datums = \"D\" }, datums = \"D B C\" }";
        assert!(text.contains(keys), "{text}");
        assert!(text.ends_with("# #9761, #9773; #9773: lower segment of #9761, each face alone"), "{text}");
    }
    let again = zones("nist_ftc_06_asme1_ap242-e2");
    assert_eq!((again.tolerances, again.written, again.open.len()), (28, 22, 6));
    let beside = zones("nist_ctc_03_asme1_ap242-e2");
    assert!(line(&beside.parts, "E").contains("profile = 1.524, angularity = { zone = 1.016, datums = \"A\" }"));
    assert_eq!((beside.tolerances, beside.written, beside.open.len()), (13, 10, 3));
}

/// Bearings A and B of ctc_05 lie on one line. Of the runouts to A-B, #947 and #948 are of one disc, and #946 is of a face.
#[test]
fn two_bearings_are_a_common_datum() {
    let found = zones("nist_ctc_05_asme1_ap242-e1");
    assert!(line(&found.parts, "pin_1").ends_with("runout = 0.025, datums = \"A-B\" }  # #947"), "{}", found.parts);
    let open: Vec<&str> =
        found.open.iter().map(|item| item.line.as_str()).filter(|line| line.contains("A-B")).collect();
    assert_eq!(
        open,
        [
            "# circular run-out 0.035, datums A-B: face_1: the runout of a face needs its diameter (#946)",
            "# circular run-out 0.025, datums A-B: pin_1: the feature has another runout (#948)",
        ]
    );
    assert_eq!((found.tolerances, found.written, found.open.len()), (10, 6, 4));
}

/// Datum B of stc_06 is the width of the part: faces at y = -152.4 and 152.4 mm.
#[test]
fn two_opposite_faces_are_their_middle() {
    let found = zones("nist_stc_06_asme1_ap242-e3");
    let middle = line(&found.parts, "B");
    assert!(middle.starts_with("{ plane = [117.475, 0, 42.545], normal = \"y\""), "{middle}");
    assert!(
        middle.contains("perpendicularity = 0.3048, datums = \"A\"")
            && middle.ends_with("#10246; the middle of two opposite faces")
    );
}

/// Two halves of a cylinder are one axis, whether one tolerance names both or two name one each. The shaft of ctc_05 has a disc of 22 in.
#[test]
fn halves_are_one_feature() {
    let found = zones("nist_ctc_05_asme1_ap242-e1");
    let discs = found.parts.lines().filter(|line| line.contains("diameter = 22,")).count();
    assert_eq!(discs, 1, "{}", found.parts);
    // Datum C of rectangular targets: 10.375 in from the axis, and looks outwards.
    assert_eq!(line(&found.parts, "C"), "{ plane = [10.375, 0, 1.175], normal = \"x\" }  # the datum target");
    // #960.
    assert!(found.parts.contains("concentricity = 0.03, datums = \"A\" }  # #960"), "{}", found.parts);
}

#[test]
fn names_and_units_follow_the_study() {
    let taken = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<BTreeSet<_>>();
    let request = TableRequest {
        unit: Some("mm".to_owned()),
        part: Some("shaft".to_owned()),
        taken_dimensions: taken(&["shaft_B_diameter"]),
        prefixed: true,
        ..TableRequest::default()
    };
    let bytes = bytes("nist_ctc_05_asme1_ap242-e1");
    let found = tables_of(&bytes, &request).unwrap();
    // 10 in +- 0.001 in.
    assert!(
        found.dimensions[0].starts_with("shaft_B_diameter_2 = { nominal = 254, tolerance = 0.0254, unit = \"mm\" }")
    );
    assert!(line(&found.parts, "B").contains("diameter = \"shaft_B_diameter_2\""), "{}", found.parts);
    let again = TableRequest { taken_parts: taken(&["shaft"]), ..request };
    let error = tables_of(&bytes, &again).unwrap_err();
    assert_eq!(error, StepFault::Content(TableFault::PartExists("shaft".to_owned())));
}

/// Sizes with limits, fits, single limits and none, written here.
#[test]
fn limits_of_all_kinds_are_written() {
    let mut text = String::from(
        "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n#2=SHAPE_ASPECT('','',$,.T.);\n",
    );
    let item = |value: f64, name: &str| {
        format!(
            "(LENGTH_MEASURE_WITH_UNIT()MEASURE_REPRESENTATION_ITEM()MEASURE_WITH_UNIT(LENGTH_MEASURE({value:?}),#1)REPRESENTATION_ITEM('{name}'))"
        )
    };
    let mut size = |id: u64, items: &[String], range: &str| {
        let ids: Vec<String> = (0..items.len()).map(|index| format!("#{}", id + 10 + index as u64)).collect();
        for (index, item) in items.iter().enumerate() {
            text += &format!("#{}={item};\n", id + 10 + index as u64);
        }
        text += &format!(
            "#{id}=DIMENSIONAL_SIZE(#2,'diameter');\n#{}=SHAPE_DIMENSION_REPRESENTATION('',({}),$);\n",
            id + 1,
            ids.join(",")
        );
        text += &format!("#{}=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#{id},#{});\n", id + 2, id + 1);
        if !range.is_empty() {
            text += &format!("#{}={range};\n#{}=PLUS_MINUS_TOLERANCE(#{},#{id});\n", id + 3, id + 4, id + 3);
        }
    };
    size(100, &[item(25.0, "nominal value")], "LIMITS_AND_FITS('H','hole','7','')");
    size(200, &[item(30.0, "nominal value"), item(29.9, "lower limit"), item(30.3, "upper limit")], "");
    size(300, &[item(5.0, "upper limit")], "");
    size(400, &[item(6.0, "nominal value")], "");
    size(
        500,
        &[item(7.0, "nominal value"), "DESCRIPTIVE_REPRESENTATION_ITEM('dimensional note','theoretical')".to_owned()],
        "",
    );
    size(600, &[item(8.0, "nominal value")], "LIMITS_AND_FITS('q','hole','99','')");
    text += "ENDSEC;\nEND-ISO-10303-21;\n";
    let request =
        TableRequest { fit_is_known: Some(|size, class| size == 25.0 && class == "H7"), ..TableRequest::default() };
    let found = tables_of(text.as_bytes(), &request).unwrap().dimensions;
    assert_eq!(
        found,
        [
            "diameter_100 = { nominal = 25, fit = \"H7\", unit = \"mm\" }  # #100",
            "diameter_200 = { nominal = 30, tolerance = [-0.1, 0.3], unit = \"mm\" }  # #200",
            "# diameter_300 = 5 mm: a greatest value alone (#300)",
            "diameter_400 = { nominal = 6, unit = \"mm\" }  # #400, no tolerance in the file",
            "# diameter_500 = 7 mm: theoretically exact (#500)",
            "# diameter_600 = 8 mm: tolerance class `q99` is not in the tables (#600)",
        ]
    );
}
