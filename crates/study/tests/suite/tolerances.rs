//! All forms of a tolerance in a study (fits, parts of the nominal, one-sided bands, positions), and the totals of bands.

use proptest::prelude::*;

use sensitol::{Closure, Dimension, Method, Problem, analyze, fits};
use sensitol_study::Study;
use sensitol_testing::{close, dimension, faults, parse, relative};

#[test]
fn a_fit_is_a_band() {
    for (line, nominal, class) in [
        ("{ nominal = 25.0, fit = \"H7\", unit = \"mm\" }", 25.0, "H7"),
        ("{ nominal = 25, fit = \"g6\", unit = \"mm\" }", 25.0, "g6"),
        ("{ nominal = 0.5, fit = \"js01\", unit = \"mm\" }", 0.5, "js01"),
        ("{ nominal = 500, fit = \"ZC18\", unit = \"mm\" }", 500.0, "ZC18"),
    ] {
        let found = dimension(line).unwrap();
        let [lower, upper] = fits::deviations(nominal, class).unwrap();
        assert_eq!(found.tolerance(), Some([lower, upper]));
        relative(found.mean(), nominal + 0.5 * (lower + upper), 1e-15);
        relative(found.sigma(), (upper - lower) / 6.0, 1e-15);
    }
    // 40 N7 is -8 / -33 um. Keys beside a fit act as beside any band.
    let bands = "nominal = 40, fit = \"N7\", unit = \"mm\"";
    let with = |rest: &str| dimension(&format!("{{ {bands}, {rest} }}")).unwrap();
    for (found, mean, sigma) in [
        (with("sigmas = 6"), 39.9795, 0.0125 / 6.0),
        (with("cp = 2, sigma = 0.0020833333333333333"), 39.9795, 0.0125 / 6.0),
        (with("shift = 0.002"), 39.9815, 0.0125 / 3.0),
        (with("sigma = 0.001, shift = -0.002"), 39.9775, 0.001),
        (with("distribution = \"uniform\""), 39.9795, 0.0125 / 3f64.sqrt()),
    ] {
        relative(found.mean(), mean, 1e-15);
        // Rounding of deviations between two numbers near 40.
        relative(found.sigma(), sigma, 1e-12);
        assert_eq!(found.tolerance(), Some([-0.033, -0.008]));
    }
}

#[test]
fn parts_of_the_nominal() {
    let tolerance = |line: &str| dimension(line).unwrap().tolerance();
    for (line, expected) in [
        ("{ nominal = 50, tolerance = \"2%\" }", [-1.0, 1.0]),
        ("{ nominal = 50, tolerance = \" 0.5 % \" }", [-0.25, 0.25]),
        ("{ nominal = -50, tolerance = \"2%\" }", [-1.0, 1.0]),
        ("{ nominal = 50, tolerance = [\"-1%\", \"2%\"] }", [-0.5, 1.0]),
        ("{ nominal = -50, tolerance = [\"-1%\", \"2%\"] }", [-0.5, 1.0]),
        ("{ nominal = 50, tolerance = [0, \"2%\"] }", [0.0, 1.0]),
        ("{ nominal = 50, tolerance = [\"-1%\", 0.25] }", [-0.5, 0.25]),
        ("{ nominal = 8, tolerance = \"12.5%\", cp = 2 }", [-1.0, 1.0]),
    ] {
        assert_eq!(tolerance(line), Some(expected), "{line}");
    }
    assert_eq!(tolerance("{ nominal = 50, tolerance = \"0%\" }"), None);
    let json = r#"{"dimensions": {"a": {"nominal": 50, "tolerance": ["-1%", "2%"]}}, "characteristics": {"y": {"formula": "a"}}}"#;
    assert_eq!(Study::from_json(json, "study.json").unwrap().problem.dimensions()[0].tolerance(), Some([-0.5, 1.0]));
}

/// Bands that lie on one side of the nominal, or have it at an edge or outside.
#[test]
fn one_sided_bands() {
    for (line, tolerance, mean) in [
        ("{ nominal = 8, tolerance = [0, 0.25] }", [0.0, 0.25], 8.125),
        ("{ nominal = 8, tolerance = [-0.25, 0] }", [-0.25, 0.0], 7.875),
        ("{ nominal = 8, tolerance = [0.25, 0.5] }", [0.25, 0.5], 8.375),
        ("{ nominal = 8, limits = [8, 8.25] }", [0.0, 0.25], 8.125),
        ("{ nominal = 8, limits = [7.75, 8] }", [-0.25, 0.0], 7.875),
        ("{ nominal = 8, limits = [8.25, 8.5] }", [0.25, 0.5], 8.375),
    ] {
        let found = dimension(line).unwrap();
        assert_eq!((found.tolerance(), found.mean()), (Some(tolerance), mean), "{line}");
        assert_eq!(found.half_band(), 0.125);
        relative(found.sigma(), 0.125 / 3.0, 1e-15);
    }
}

/// All ways of giving sigma at once, on every form of a band: either they agree, or the error names two of them.
#[test]
fn sigma_in_all_ways_at_once() {
    let bands = [
        "tolerance = [-0.25, 0.5]",
        "limits = [7.75, 8.5]",
        "tolerance = [\"-3.125%\", \"6.25%\"]",
        "tolerance = [-0.25, \"6.25%\"]",
    ];
    for band in bands {
        let all = format!("{{ nominal = 8, {band}, sigmas = 6, cp = 2, sigma = 0.0625, shift = -0.125 }}");
        let found = dimension(&all).unwrap();
        assert_eq!((found.mean(), found.sigma(), found.tolerance()), (8.0, 0.0625, Some([-0.25, 0.5])), "{band}");
        for (disagree, keys) in [
            ("sigmas = 6, cp = 1.9, sigma = 0.0625", "`sigmas` and `cp`"),
            ("sigmas = 5, cp = 2, sigma = 0.0625", "`sigmas` and `cp`"),
            ("sigmas = 6, cp = 2, sigma = 0.0626", "`sigmas` and `sigma`"),
            ("cp = 1, sigma = 0.0625", "`cp` and `sigma`"),
        ] {
            let error = dimension(&format!("{{ nominal = 8, {band}, {disagree} }}")).unwrap_err();
            assert!(error.to_string().contains(&format!("{keys} disagree")), "{band}, {disagree}: {error}");
        }
    }
}

#[test]
fn tolerances_at_fault() {
    let line = |line: &str| format!("[dimensions]\na = {line}\n[characteristics]\ny = {{ formula = \"1\" }}\n");
    let lines = [
        "{ nominal = 25, fit = \"H7\" }",
        "{ nominal = 25, fit = \"H7\", unit = \"in\" }",
        "{ nominal = 25, fit = \"H7\", unit = \"MM\" }",
        "{ nominal = 25, fit = \"H7\", unit = \"mm\", tolerance = 0.1 }",
        "{ nominal = 25, fit = \"H7\", unit = \"mm\", limits = [24.9, 25.1] }",
        "{ nominal = 25, fit = \"H77\", unit = \"mm\" }",
        "{ nominal = 25, fit = \"Hh7\", unit = \"mm\" }",
        "{ nominal = 25, fit = \"Q7\", unit = \"mm\" }",
        "{ nominal = 25, fit = \"H\", unit = \"mm\" }",
        "{ nominal = 25, fit = \"H7/g6\", unit = \"mm\" }",
        "{ nominal = 25, fit = 7, unit = \"mm\" }",
        "{ nominal = 20, fit = \"t6\", unit = \"mm\" }",
        "{ nominal = 25, fit = \"K9\", unit = \"mm\" }",
        "{ nominal = 501, fit = \"H7\", unit = \"mm\" }",
        "{ nominal = -25, fit = \"H7\", unit = \"mm\" }",
        "{ fit = \"H7\", unit = \"mm\" }",
        "{ nominal = 25, fit = \"H7\", unit = \"mm\", sigmas = 3, sigma = 1 }",
        "{ nominal = 0, tolerance = \"2%\" }",
        "{ nominal = 0, tolerance = [\"-2%\", 1] }",
        "{ nominal = 10, tolerance = \"-2%\" }",
        "{ nominal = 10, tolerance = [\"2%\", \"-1%\"] }",
        "{ nominal = 10, tolerance = [\"2%\", \"2%\"] }",
        "{ nominal = 10, tolerance = \"2 percent\" }",
        "{ nominal = 10, tolerance = \"nan%\" }",
        "{ nominal = 10, tolerance = \"%\" }",
        "{ nominal = 10, tolerance = [\"1%\", \"two%\"] }",
        "{ nominal = 10, tolerance = [\"1%\"] }",
        "{ nominal = 10, tolerance = true }",
        "{ position = 0.2 }",
        "{ position = 0.2, nominal = 50 }",
        "{ position = 0.2, nominal = [50] }",
        "{ position = -0.2, nominal = [50, 30] }",
        "{ position = \"0.2\", nominal = [50, 30] }",
        "{ position = 0.2, nominal = [50, 30], tolerance = 0.1 }",
        "{ position = 0.2, nominal = [50, 30], limits = [1, 2] }",
        "{ position = 0.2, nominal = [50, 30], fit = \"H7\", unit = \"mm\" }",
        "{ position = 0.2, nominal = [50, 30], distribution = \"triangular\" }",
        "{ position = 0.2, nominal = [50, 30], shift = 0.1 }",
        "{ position = 0.2, nominal = [50, 30], sigmas = 3, cp = 2 }",
        "{ position = 0.2, nominal = [50, 30], cp = 0 }",
        "{ position = 0, nominal = [50, 30], sigma = 0.1 }",
        "{ nominal = [50, 30] }",
        "{ nominal = [50, 30], tolerance = 0.1 }",
        "{ nominal = \"50\" }",
    ]
    .map(line);
    let mut texts: Vec<&str> = lines.iter().map(String::as_str).collect();
    // The names that a position declares must be unique too.
    let taken = [
        "[dimensions]\nhole = { position = 0.2, nominal = [1, 2] }\nhole_x = { nominal = 1 }\n[characteristics]\ny = { formula = \"hole_x\" }\n",
        "[dimensions]\nhole_y = { nominal = 1 }\nhole = { position = 0.2, nominal = [1, 2] }\n[characteristics]\ny = { formula = \"hole_x\" }\n",
        "[constants]\nhole_x = 1\n[dimensions]\nhole = { position = 0.2, nominal = [1, 2] }\n[characteristics]\ny = { formula = \"hole_y\" }\n",
        "[dimensions]\nhole = { position = 0.2, nominal = [1, 2] }\n[characteristics]\nhole_x = { formula = \"hole_y\" }\n",
        "[dimensions]\nhole = { position = 0.2, nominal = [1, 2] }\n[characteristics]\ny = { formula = \"hole\" }\n",
        "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nR = { position = 0.2, nominal = [1, 2] }\n[characteristics]\nF = {}\n",
    ];
    texts.extend(taken);
    insta::assert_snapshot!(faults(&texts));
}

/// Both coordinates, and a distance that depends on both in closed form: linear in the worst case, quadratic in the moments.
#[test]
fn a_position_is_two_dimensions() {
    let study = parse(
        r#"
        [dimensions]
        hole = { position = 0.2, nominal = [50.0, 30.0], unit = "mm", step = 1.0 }
        pin = { position = 0.1, nominal = [50.0, 30.0], sigmas = 6 }
        edge = { nominal = 8.0, tolerance = 0.3 }
        point = { position = 0, nominal = [1, 2] }
        [characteristics]
        x = { formula = "hole_x - pin_x + point_x" }
        along = { formula = "3*hole_x + 4*hole_y - 5*pin_x - 12*pin_y + edge" }
        square = { formula = "hole_x^2 + hole_y^2" }
        "#,
    )
    .unwrap();
    let names: Vec<&str> = study.problem.dimensions().iter().map(Dimension::name).collect();
    assert_eq!(names, ["hole_x", "hole_y", "pin_x", "pin_y", "edge", "point_x", "point_y"]);
    let [hole_x, hole_y, pin_x, _, edge, point_x, _] = study.problem.dimensions() else { panic!("seven") };
    assert_eq!((hole_x.nominal(), hole_y.nominal(), hole_x.unit(), hole_y.step()), (50.0, 30.0, Some("mm"), Some(1.0)));
    assert_eq!((hole_x.tolerance(), hole_x.zone(), pin_x.zone()), (Some([-0.1, 0.1]), Some("hole"), Some("pin")));
    assert_eq!((edge.zone(), point_x.sigma(), point_x.tolerance()), (None, 0.0, None));
    relative(hole_x.sigma(), 0.1 / 3.0, 1e-15);
    relative(pin_x.sigma(), 0.05 / 6.0, 1e-15);
    let analysis = analyze(&study.problem, &Method::Full.into()).unwrap();
    let [x, along, square] = &analysis.characteristics[..] else { panic!("three characteristics") };
    let half = |interval: Option<[f64; 2]>| interval.map(|[lower, upper]| 0.5 * (upper - lower)).unwrap();
    // Differences of values near 100 and 4000 have rounding errors of 1e-13 of these. The half-widths are near 1 and 10.
    close(half(x.range.worst_case), 0.1 + 0.05, 1e-11, 1.0);
    close(half(along.range.worst_case), 0.1 * 5.0 + 0.05 * 13.0 + 0.3, 1e-11, 1.0);
    close(along.linear.rss.unwrap(), (0.5f64.powi(2) + 0.65f64.powi(2) + 0.3f64.powi(2)).sqrt(), 1e-11, 1.0);
    let sigma = (25.0 * (0.1f64 / 3.0).powi(2) + 169.0 * (0.05f64 / 6.0).powi(2) + 0.1f64.powi(2)).sqrt();
    close(along.moments.unwrap().sigma(), sigma, 1e-11, 1.0);
    // x^2 + y^2 with means m: variance 4 s^2 |m|^2 + 4 s^4, mean |m|^2 + 2 s^2.
    let (s2, m2) = ((0.1f64 / 3.0).powi(2), 50.0f64.powi(2) + 30.0f64.powi(2));
    close(square.moments.unwrap().mean(), m2 + 2.0 * s2, 1e-13, 1.0);
    close(square.moments.unwrap().sigma(), (4.0 * s2 * m2 + 4.0 * s2 * s2).sqrt(), 1e-9, 1.0);
    close(half(square.range.worst_case), 0.1 * 2.0 * m2.sqrt(), 1e-9, 1.0);
}

/// A program with the inputs `hole_x` and `hole_y` receives both coordinates.
#[test]
fn a_program_is_given_both_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let model = "import json, sys\nhello = json.loads(input())\nprint(json.dumps({'ready': True, 'name': 'm', 'version': '1'}), flush=True)\n\
                 at = hello['dimensions'].index\nfor line in sys.stdin:\n    ask = json.loads(line)\n    x = ask['x']\n    \
                 print(json.dumps({'id': ask['id'], 'y': [3*x[at('hole_x')] - 4*x[at('hole_y')]]}), flush=True)\n";
    std::fs::write(folder.path().join("model.py"), model).unwrap();
    let text = "[model]\ncommand = [\"python3\", \"model.py\"]\n[dimensions]\nhole = { position = 0.2, nominal = [50, 30] }\n\
                [characteristics]\nd = {}\n";
    std::fs::write(&study, text).unwrap();
    let found =
        &analyze(&Study::read(&study).unwrap().problem, &Method::SecondOrder.into()).unwrap().characteristics[0];
    assert_eq!(found.nominal, Some(30.0));
    let [lower, upper] = found.range.worst_case.unwrap();
    close(upper - lower, 2.0 * 0.1 * 5.0, 1e-11, 1.0);
}

proptest! {
    /// Totals of a linear characteristic equal their definitions, for any slopes, bands and zones. The reach of a zone is the greatest of
    /// all its points.
    #[test]
    fn totals_of_a_linear_characteristic(
        slopes in proptest::collection::vec(-5.0f64..5.0, 5),
        radius in 0.01f64..1.0,
        bands in proptest::collection::vec((-1.0f64..1.0, 0.01f64..1.0), 3),
    ) {
        let mut dimensions: Vec<Dimension> = (bands.iter().enumerate())
            .map(|(i, (lower, width))| Dimension::normal_between(format!("x{i}"), 2.0, [*lower, lower + width]).unwrap())
            .collect();
        for axis in ["u", "v"] {
            dimensions.push(Dimension::normal(axis, 1.0, radius).unwrap().within_zone("hole"));
        }
        let b = slopes.clone();
        let sum = Closure::scalar("y", move |x| x.iter().zip(&b).map(|(x, b)| x * b).sum());
        let analysis = analyze(&Problem::new(dimensions, sum).unwrap(), &Method::SecondOrder.into()).unwrap();
        let found = &analysis.characteristics[0];
        let nominal = 2.0 * slopes[..3].iter().sum::<f64>() + slopes[3] + slopes[4];
        // Greatest and least part of every dimension. For the circle they follow from a search of its edge.
        let on_edge = |turn: u32| {
            let angle = std::f64::consts::TAU * f64::from(turn) / 3600.0;
            radius * (slopes[3] * angle.cos() + slopes[4] * angle.sin())
        };
        let zone = (0..3600).map(on_edge).fold(0.0, f64::max);
        let ends = |pick: fn(f64, f64) -> f64| -> f64 {
            (bands.iter().zip(&slopes)).map(|((lower, width), b)| pick(b * lower, b * (lower + width))).sum()
        };
        let [lower, upper] = found.range.worst_case.unwrap();
        // The search of the edge in steps of 0.1 degrees misses up to (pi/3600)^2/2 of the radius, 4e-7.
        prop_assert!((lower - (nominal + ends(f64::min) - zone)).abs() < 1e-5);
        prop_assert!((upper - (nominal + ends(f64::max) + zone)).abs() < 1e-5);
        let squares: f64 = (bands.iter().zip(&slopes)).map(|((_, width), b)| (0.5 * b * width).powi(2)).sum();
        let rss = (squares + radius * radius * (slopes[3].powi(2) + slopes[4].powi(2))).sqrt();
        prop_assert!((found.linear.rss.unwrap() - rss).abs() < 1e-11);
        prop_assert!((found.linear.inflated_rss.unwrap() - 1.5 * rss).abs() < 1e-11);
        prop_assert!((found.linear.mean_shift_rss.unwrap() - 0.5 * (0.5 * (upper - lower) + rss)).abs() < 1e-11);
        prop_assert!((found.linear.middle.unwrap() - 0.5 * (lower + upper)).abs() < 1e-11);
    }
}

/// The estimated mean shift model, written out: shifts of half a half-width add up, and the remaining halves add as RSS.
#[test]
fn named_totals_of_a_published_kind() {
    let dimensions = [0.1, 0.2, 0.3].iter().enumerate();
    let dimensions = dimensions.map(|(i, &t)| Dimension::normal(format!("x{i}"), 10.0, t).unwrap());
    let gap = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1] - 2.0 * x[2])).unwrap();
    let found = &analyze(&gap, &Method::SecondOrder.into()).unwrap().characteristics[0];
    let shifts = 0.05 + 0.10 + 2.0 * 0.15;
    let rest = (0.05f64.powi(2) + 0.10f64.powi(2) + 0.30f64.powi(2)).sqrt();
    close(found.linear.mean_shift_rss.unwrap(), shifts + rest, 1e-12, 1.0);
    close(found.linear.rss.unwrap(), 2.0 * rest, 1e-12, 1.0);
    close(found.linear.inflated_rss.unwrap(), 3.0 * rest, 1e-12, 1.0);
    assert_eq!(found.linear.middle, found.nominal);
}
