//! Completeness of assemblies in space: what `check` names as left out on the drawings.

use sensitol_study::{CompletenessGap, Study};
use sensitol_testing::{parse, repository};

/// Names of the features without tolerance.
fn bare(gaps: &[CompletenessGap]) -> Vec<&str> {
    let mut names = Vec::new();
    for gap in gaps {
        if let CompletenessGap::FeatureWithoutTolerance { feature } = gap {
            names.push(feature.as_str());
        }
    }
    names
}

/// A block with a hole on a table, with these keys at the hole and these lines before the parts.
fn block(hole: &str, more: &str) -> Result<Study, sensitol_study::StudyError> {
    parse(&format!(
        r#"
        [dimensions]
        h = {{ nominal = 12, tolerance = 0.1, unit = "mm" }}
        {more}
        [parts.table]
        top = {{ plane = [0, 0, 0], normal = "z" }}
        side = {{ plane = [0, -40, 0], normal = "y" }}
        stop = {{ plane = [-40, 0, 0], normal = "x" }}
        [parts.block]
        A = {{ plane = [0, 0, "-h"], normal = "-z" }}
        B = {{ plane = [0, -40, 0], normal = "-y", profile = 0.1 }}
        C = {{ plane = [-40, 0, 0], normal = "-x", profile = 0.1 }}
        lid = {{ plane = [0, 0, 5], normal = "z" }}
        hole = {{ axis = [0, 0, 0], along = "z", {hole} }}
        [joints]
        seat = {{ on = "table.top", against = "block.A" }}
        back = {{ on = "table.side", against = "block.B", takes = 2 }}
        left = {{ on = "table.stop", against = "block.C", takes = 1 }}
        [characteristics]
        height = {{ of = "block.lid", from = "table.top", unit = "mm" }}
        place = {{ of = "block.hole", from = "table.side", unit = "mm" }}
        "#
    ))
}

#[test]
fn a_feature_that_contributes_and_has_no_tolerance_is_named() {
    let gaps = block("position = 0.2, datums = \"A B C\"", "").unwrap().completeness();
    // The block sits on the faces of the table from which it is measured, so that it moves with them. No characteristic is along x, A has
    // its height, and B its profile.
    assert_eq!(bare(&gaps), ["block.lid"]);
    let gaps = block("diameter = 8", "").unwrap().completeness();
    assert_eq!(bare(&gaps), ["block.lid", "block.hole"]);
}

#[test]
fn a_datum_that_no_feature_bears_is_an_error_at_its_line() {
    let error = block("position = 0.2, datums = \"A B D\"", "").unwrap_err();
    let text = error.to_string();
    assert!(text.contains("parts.block.hole.datums") && text.contains('D'), "{text}");
}

#[test]
fn datums_that_leave_free_what_a_zone_bounds_are_named() {
    let open = |datums: &str| {
        let gaps = block(&format!("position = 0.2{datums}"), "").unwrap().completeness();
        let text = |gap: &CompletenessGap| match gap {
            CompletenessGap::OpenDatums { feature, datums, open, .. } if feature == "block.hole" => {
                Some(format!("{}: {}", datums.join(" "), open.join(", ")))
            }
            _ => None,
        };
        gaps.iter().find_map(text)
    };
    assert_eq!(open(", datums = \"A B C\""), None);
    assert_eq!(open(", datums = \"A B\"").as_deref(), Some("A B: its place along x"));
    assert_eq!(open(", datums = \"A\"").as_deref(), Some("A: its place along x, its place along y"));
    assert_eq!(open("").as_deref(), Some(": all of it"));
}

/// 50 mm is in the range from 30 to 120 mm of ISO 2768-1, table 1, with 0.3 mm in class m.
#[test]
fn a_general_tolerance_that_would_apply_is_named_with_its_value() {
    let line = "w = { nominal = 50, unit = \"mm\" }";
    let hole = "position = 0.2, datums = \"A B C\", diameter = \"w\"";
    let general = |study: Study| {
        let of = |gap: &CompletenessGap| match gap {
            CompletenessGap::GeneralTolerance { dimension, half, unit } => {
                Some((dimension.clone(), *half, unit.clone()))
            }
            _ => None,
        };
        study.completeness().iter().filter_map(of).collect::<Vec<_>>()
    };
    assert_eq!(general(block(hole, line).unwrap()), [("w".to_owned(), 0.3, Some("mm".to_owned()))]);
    let with = format!("{line}\n[general]\nstandard = \"ISO 2768-m\"\n");
    assert_eq!(general(block(hole, &with).unwrap()), []);
    let own = "w = { nominal = 50, tolerance = 0.1, unit = \"mm\" }";
    assert_eq!(general(block(hole, own).unwrap()), []);
}

#[test]
fn examples_name_the_features_that_they_take_as_exact() {
    let expected: [(&str, &[&str]); 5] = [
        ("one-way-clutch/bodies", &[]),
        ("stacked-blocks-loops/bodies", &["block.bottom"]),
        ("locating-plate/study", &["plate.bottom"]),
        ("crank-slider-space/study", &["base.bearing", "crank.hub", "link.small", "slider.guide"]),
        // The shoulder stops the shaft along its axis, across which it is measured.
        ("shaft-two-bores/study", &[]),
    ];
    for (name, features) in expected {
        let study = Study::read(&repository(&format!("examples/{name}.toml"))).unwrap();
        let gaps = study.completeness();
        assert_eq!(bare(&gaps), features, "{name}");
        assert_eq!(gaps.len(), features.len(), "{name}: {gaps:?}");
    }
    // The joints of the base and the plate have no tolerance, and the centre has none either.
    let platform = Study::read(&repository("examples/six-legged-platform/study.toml")).unwrap();
    assert_eq!(bare(&platform.completeness()).len(), 13);
}
