//! General tolerances of `[general]`.
//!
//! Oracle: ISO 2768-1:1989, table 1. The figures below were read from tables that others published: a page on the standard with all classes up
//! to 2000 mm, a copy of DIN ISO 2768-1 with class v up to 4000 mm, and the source of another program with f, m, c up to 4000 mm.

use sensitol_study::Study;

/// Degrees and minutes.
type Arc = (f64, f64);

/// Shorter legs at both ends of each range in mm, and half tolerances of classes f, m, c and v in degrees and minutes.
///
/// Oracle: ISO 2768-1:1989, table 3, as tables of others print it: in degrees and minutes, f and m in one column.
const ANGLES: [([f64; 2], [Arc; 4]); 5] = [
    ([0.5, 10.0], [(1.0, 0.0), (1.0, 0.0), (1.0, 30.0), (3.0, 0.0)]),
    ([10.01, 50.0], [(0.0, 30.0), (0.0, 30.0), (1.0, 0.0), (2.0, 0.0)]),
    ([50.01, 120.0], [(0.0, 20.0), (0.0, 20.0), (0.0, 30.0), (1.0, 0.0)]),
    ([120.01, 400.0], [(0.0, 10.0), (0.0, 10.0), (0.0, 15.0), (0.0, 30.0)]),
    ([400.01, 5000.0], [(0.0, 5.0), (0.0, 5.0), (0.0, 10.0), (0.0, 20.0)]),
];

/// Size in each range, and half tolerances of classes f, m, c and v in mm. None if the standard has none.
const TABLE: [(f64, [Option<f64>; 4]); 8] = [
    (3.0, [Some(0.05), Some(0.1), Some(0.2), None]),
    (6.0, [Some(0.05), Some(0.1), Some(0.3), Some(0.5)]),
    (30.0, [Some(0.1), Some(0.2), Some(0.5), Some(1.0)]),
    (120.0, [Some(0.15), Some(0.3), Some(0.8), Some(1.5)]),
    (400.0, [Some(0.2), Some(0.5), Some(1.2), Some(2.5)]),
    (1000.0, [Some(0.3), Some(0.8), Some(2.0), Some(4.0)]),
    (2000.0, [Some(0.5), Some(1.2), Some(3.0), Some(6.0)]),
    (4000.0, [None, Some(2.0), Some(4.0), Some(8.0)]),
];

fn study(general: &str, dimension: &str) -> Result<Study, String> {
    let text = format!(
        "[general]\n{general}\n[dimensions]\nd = {{ {dimension} }}\nt = {{ nominal = 1, tolerance = 0.01, unit = \"mm\" }}\n[characteristics]\ny = {{ formula = \"d + t\" }}\n"
    );
    Study::from_toml(&text, "general.toml").map_err(|error| error.to_string())
}

/// Half the band of `d`, as the expanded study writes it.
fn half(general: &str, dimension: &str) -> Result<f64, String> {
    study(general, dimension).map(|study| {
        let [lower, upper] = study.problem.dimensions()[0].tolerance().unwrap_or_default();
        0.5 * (upper - lower)
    })
}

#[test]
fn every_range_and_class_has_the_value_of_the_standard() {
    for (size, values) in TABLE {
        for (class, value) in ["f", "m", "c", "v"].into_iter().zip(values) {
            // The end of a range, and a size within it.
            for nominal in [size, 0.9 * size] {
                let found =
                    half(&format!("standard = \"ISO 2768-{class}\""), &format!("nominal = {nominal:?}, unit = \"mm\""));
                match value {
                    // Rounding of nominal +- tolerance: a few 1e-13 of 4000.
                    Some(value) => {
                        assert!((found.clone().unwrap() - value).abs() < 1e-11, "{nominal} {class}: {found:?}")
                    }
                    None => assert!(found.unwrap_err().contains("for which ISO 2768-"), "{nominal} {class}"),
                }
            }
        }
    }
    // Just above the end of a range the next one holds.
    assert!((half("standard = \"ISO 2768-m\"", "nominal = 30.01, unit = \"mm\"").unwrap() - 0.3).abs() < 1e-12);
    for outside in [0.4, 4001.0] {
        assert!(half("standard = \"ISO 2768-m\"", &format!("nominal = {outside}, unit = \"mm\"")).is_err());
    }
}

#[test]
fn every_angle_has_the_value_of_the_standard_for_its_shorter_leg() {
    for (legs, values) in ANGLES {
        for (class, (degrees, minutes)) in ["f", "m", "c", "v"].into_iter().zip(values) {
            for leg in legs {
                let dimension = format!("nominal = 30, unit = \"deg\", leg = {leg:?}");
                let found = half(&format!("standard = \"ISO 2768-{class}\""), &dimension).unwrap();
                // Rounding of 30 +- tolerance.
                assert!((found - (degrees + minutes / 60.0)).abs() < 1e-13, "{leg} {class}: {found}");
            }
        }
    }
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    // The leg is the dimension `t` of 1 mm; in radians; an own tolerance and the angle of a title block win.
    let named = "nominal = 0.5, unit = \"rad\", leg = \"t\"";
    near(half("standard = \"ISO 2768-v\"", named).unwrap(), 3f64.to_radians());
    near(half("standard = \"ISO 2768-v\"\nangle = 0.25", named).unwrap(), 0.25f64.to_radians());
    near(half("standard = \"ISO 2768-v\"", "nominal = 3, tolerance = 0.5, unit = \"deg\", leg = 20").unwrap(), 0.5);
}

#[test]
fn a_leg_stays_without_effect_until_there_is_a_general_tolerance() {
    let text = |leg: &str| {
        format!(
            "[dimensions]\na = {{ nominal = 30, unit = \"deg\", leg = {leg} }}\nt = {{ nominal = 40, tolerance = 0.1, unit = \"mm\" }}\n\
             [characteristics]\ny = {{ formula = \"t\" }}\n"
        )
    };
    let study = Study::from_toml(&text("\"t\""), "leg.toml").unwrap();
    assert_eq!(study.problem.dimensions()[0].tolerance(), None);
    assert!(!study.expanded.contains("leg"), "{}", study.expanded);
    for (leg, expected) in [
        ("0", "above 0"),
        ("\"tt\"", "no dimension `tt`"),
        ("\"a\"", "the name of a dimension"),
        ("[1]", "the name of a dimension"),
    ] {
        let error = Study::from_toml(&text(leg), "leg.toml").unwrap_err().to_string();
        assert!(error.contains("dimensions.a.leg") && error.contains(expected), "{leg}: {error}");
    }
    let length = text("40").replace("\"deg\"", "\"mm\"");
    let error = Study::from_toml(&length, "leg.toml").unwrap_err().to_string();
    assert!(error.contains("unit = \"deg\""), "{error}");
}

#[test]
fn values_of_a_title_block_and_units_are_taken() {
    // 0.2 mm are 0.2/25.4 in; half a degree in both units of angles.
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    near(half("length = 0.2", "nominal = 2, unit = \"in\"").unwrap(), 0.2 / 25.4);
    near(half("standard = \"ISO 2768-mK\"", "nominal = 2, unit = \"in\"").unwrap(), 0.3 / 25.4);
    near(half("angle = 0.5", "nominal = 30, unit = \"deg\"").unwrap(), 0.5);
    near(half("angle = 0.5", "nominal = 0.5, unit = \"rad\"").unwrap(), 0.5f64.to_radians());
    // Own tolerances win; an angle has none by a standard without its shorter leg, a mass by nothing.
    near(half("length = 0.2", "nominal = 2, tolerance = 0.01, unit = \"mm\"").unwrap(), 0.01);
    for constant in ["nominal = 30, unit = \"deg\"", "nominal = 3, unit = \"kg\"", "nominal = 3"] {
        near(half("standard = \"ISO 2768-m\"", constant).unwrap(), 0.0);
    }
}

#[test]
fn expand_writes_general_tolerances_out() {
    let study = study("standard = \"ISO 2768-f\"", "nominal = 50, unit = \"mm\"").unwrap();
    let text = study.expanded;
    assert!(text.contains("tolerance = 0.15") && !text.contains("general"), "{text}");
}

#[test]
fn wrong_sections_are_refused() {
    let fault = |general: &str| study(general, "nominal = 50, unit = \"mm\"").unwrap_err();
    for (general, expected) in [
        ("standard = \"ISO 2768-n\"", "ISO 2768-n"),
        ("standard = 2768", "ISO 2768-m"),
        ("length = 0", "above 0"),
        ("length = 0.1\nstandard = \"ISO 2768-f\"", "keep one"),
        ("lenght = 0.1", "lenght"),
    ] {
        assert!(fault(general).contains(expected), "{general}: {}", fault(general));
    }
}
