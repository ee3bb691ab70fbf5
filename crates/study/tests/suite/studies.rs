//! Study files: both formats, every form of a dimension, and every fault with its place and help.

use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_testing::{INSTALLED, close, dimension, example_studies, faults, parse, relative};

#[test]
fn tolerances_become_distributions() {
    let figures = |line: &str| {
        let dimension = dimension(line).unwrap();
        (dimension.mean(), dimension.sigma(), dimension.half_band())
    };
    for (line, (mean, sigma, half)) in [
        ("{ nominal = 10.0, tolerance = 0.3 }", (10.0, 0.1, 0.3)),
        ("{ nominal = 10, tolerance = [-0.1, 0.3] }", (10.1, 0.2 / 3.0, 0.2)),
        ("{ nominal = 10, tolerance = [0, 0.3] }", (10.15, 0.05, 0.15)),
        ("{ nominal = 31.9, limits = [31.6, 32.2] }", (31.9, 0.1, 0.3)),
        ("{ limits = [31.6, 32.2] }", (31.9, 0.1, 0.3)),
        ("{ nominal = 10, tolerance = 0.3, sigmas = 6 }", (10.0, 0.05, 0.3)),
        ("{ nominal = 10, tolerance = 0.3, cp = 2 }", (10.0, 0.05, 0.3)),
        ("{ nominal = 10, tolerance = 0.3, sigmas = 6, cp = 2.0, sigma = 0.05 }", (10.0, 0.05, 0.3)),
        ("{ nominal = 10, tolerance = 0.3, sigma = 0.2, shift = 0.05 }", (10.05, 0.2, 0.3)),
        ("{ nominal = 10, sigma = 0.2 }", (10.0, 0.2, 0.6)),
        ("{ nominal = 10, tolerance = 0.3, distribution = \"uniform\" }", (10.0, 0.3 / 3f64.sqrt(), 0.3)),
        ("{ nominal = 10, tolerance = 0.3, distribution = { kind = \"normal\" } }", (10.0, 0.1, 0.3)),
        ("{ nominal = 10, moments = [0.04, 0, 0.0048, 0, 0.00096, 0, 0.0002688] }", (10.0, 0.2, 0.6)),
        (
            "{ nominal = 10, moments = [0.04, 0, 0.0048, 0, 0.00096, 0, 0.0002688], tolerance = 1, shift = 0.1 }",
            (10.1, 0.2, 1.0),
        ),
        ("{ nominal = 10 }", (10.0, 0.0, 0.0)),
        ("{ nominal = 10, tolerance = 0 }", (10.0, 0.0, 0.0)),
        ("{ nominal = 10, tolerance = 0, cp = 1 }", (10.0, 0.0, 0.0)),
        ("{ nominal = 10, sigma = 0 }", (10.0, 0.0, 0.0)),
    ] {
        let found = figures(line);
        close(found.0, mean, 1e-15, 1.0);
        close(found.1, sigma, 1e-13, 0.0);
        close(found.2, half, 1e-13, 0.0);
    }
    let full = dimension("{ nominal = 10.0, tolerance = 0.3, unit = \"mm\", step = 0.5 }").unwrap();
    assert_eq!((full.unit(), full.step(), full.tolerance()), (Some("mm"), Some(0.5), Some([-0.3, 0.3])));
}

/// Mean, sigma and half-width of every kind, computed by hand.
#[test]
fn every_kind_of_distribution_is_written() {
    let figures = |line: &str| {
        let dimension = dimension(line).unwrap();
        (dimension.distribution().unwrap().name(), dimension.mean(), dimension.sigma(), dimension.half_band())
    };
    let root = f64::sqrt;
    let pi = std::f64::consts::PI;
    for (line, name, (mean, sigma, half)) in [
        // The factor 1 - 6 density(3)/P(|z| < 3) is from mpmath.
        (
            "tolerance = 0.3, distribution = \"truncated-normal\"",
            "truncated-normal",
            (10.0, 0.1 * root(0.973_336_924_662_541_5), 0.3),
        ),
        ("limits = [9.7, 10.3], sigmas = 3, distribution = \"triangular\"", "", (0.0, 0.0, 0.0)),
        ("tolerance = 0.3, distribution = \"triangular\"", "triangular", (10.0, 0.3 / root(6.0), 0.3)),
        (
            "tolerance = [0, 0.6], distribution = { kind = \"triangular\", mode = 10 }",
            "triangular",
            (10.2, 0.6 / root(18.0), 0.3),
        ),
        (
            "tolerance = 0.3, distribution = { kind = \"trapezoidal\", top = 0.5 }",
            "trapezoidal",
            (10.0, 0.3 * root(0.625 / 3.0), 0.3),
        ),
        (
            "limits = [9.3, 10], distribution = { kind = \"beta\", alpha = 2, beta = 5 }",
            "beta",
            (9.5, 0.7 * root(10.0 / 49.0 / 8.0), 0.35),
        ),
        ("limits = [9, 10], distribution = \"arcsine\"", "beta", (9.5, 0.5 / root(2.0), 0.5)),
        ("tolerance = 0.3, distribution = \"u-shaped\"", "u-shaped", (10.0, 0.3 * root(0.6), 0.3)),
        (
            "tolerance = [0, 0.6], distribution = { kind = \"curvilinear-trapezoid\", inexactness = 0.06 }",
            "curvilinear-trapezoid",
            (10.3, root(0.03 + 0.0004), 0.3),
        ),
        ("tolerance = 0.3, distribution = { kind = \"student\", degrees = 9 }", "student", (10.0, 0.1, 0.3)),
        (
            "shift = 0.5, distribution = { kind = \"student\", degrees = 18, scale = 4 }",
            "student",
            (10.5, 4.0 * root(1.125), 12.0 * root(1.125)),
        ),
        ("sigma = 2, shift = 1, distribution = \"lognormal\"", "lognormal", (11.0, 2.0, 6.0)),
        ("tolerance = [-1, 5], distribution = { kind = \"gamma\", origin = 4 }", "gamma", (10.0, 1.0, 3.0)),
        ("tolerance = 3, sigmas = 2, distribution = { kind = \"weibull\", origin = 4 }", "weibull", (10.0, 1.5, 3.0)),
        ("distribution = { kind = \"exponential\" }", "exponential", (10.0, 10.0, 30.0)),
        (
            "sigma = 8, shift = 2, tolerance = 5, distribution = { kind = \"exponential\", origin = 4 }",
            "exponential",
            (12.0, 8.0, 5.0),
        ),
        (
            "distribution = { kind = \"rayleigh\", origin = 9 }",
            "rayleigh",
            (10.0, root(4.0 / pi - 1.0), 3.0 * root(4.0 / pi - 1.0)),
        ),
        (
            "tolerance = 0.3, distribution = { kind = \"mixture\", parts = { a = { weight = 3 }, b = { weight = 1, shift = 0.4 } } }",
            "mixture",
            (10.1, root(0.01 + 0.16 * 3.0 / 16.0), 0.3),
        ),
        (
            "distribution = { kind = \"mixture\", parts = { a = { weight = 1, limits = [9, 10], distribution = \"uniform\" }, b = { weight = 1, nominal = 10.5, sigma = 0.5 } } }",
            "mixture",
            (10.0, root(0.5 * (1.0 / 12.0 + 0.25) + 0.25), 3.0 * root(0.5 * (1.0 / 12.0 + 0.25) + 0.25)),
        ),
    ] {
        let line = format!("{{ nominal = 10, {line} }}");
        if name.is_empty() {
            assert!(dimension(&line).is_err());
            continue;
        }
        let found = figures(&line);
        assert_eq!(found.0, name, "{line}");
        close(found.1, mean, 1e-14, 1.0);
        close(found.2, sigma, 1e-12, 0.0);
        close(found.3, half, 1e-12, 0.0);
    }
    // A tolerance set to 0 makes any dimension fixed.
    for kind in ["normal", "triangular", "arcsine", "u-shaped", "gamma", "exponential"] {
        let line = format!("{{ nominal = 10, tolerance = 0, distribution = \"{kind}\" }}");
        assert!(dimension(&line).unwrap().distribution().is_none(), "{kind}");
    }
}

#[test]
fn distributions_at_fault() {
    let line = |line: &str| {
        format!("[dimensions]\na = {{ nominal = 1, {line} }}\n[characteristics]\ny = {{ formula = \"a\" }}\n")
    };
    let lines = [
        "tolerance = 0.1, distribution = { kind = \"triangular\", top = 0.5 }",
        "tolerance = 0.1, distribution = { kind = \"triangular\", mode = 2 }",
        "tolerance = 0.1, distribution = { kind = \"triangular\", mod = 1 }",
        "tolerance = 0.1, distribution = { kind = \"trapezoidal\" }",
        "tolerance = 0.1, distribution = { kind = \"trapezoidal\", top = 1.5 }",
        "tolerance = 0.1, distribution = \"beta\"",
        "tolerance = 0.1, distribution = { kind = \"beta\", alpha = 2 }",
        "tolerance = 0.1, distribution = { kind = \"beta\", alpha = 2, beta = 0 }",
        "tolerance = 0.1, sigma = 0.1, distribution = { kind = \"beta\", alpha = 2, beta = 2 }",
        "distribution = { kind = \"beta\", alpha = 2, beta = 2 }",
        "tolerance = 0.1, shift = 0.01, distribution = \"triangular\"",
        "tolerance = 0.1, cp = 1, distribution = \"triangular\"",
        "tolerance = 0.1, shift = 10, distribution = \"truncated-normal\"",
        "tolerance = 0.1, sigma = 0.05, distribution = \"truncated-normal\"",
        "tolerance = 0.1, distribution = { kind = \"arcsine\", alpha = 2 }",
        "tolerance = 0.1, sigma = 0.05, distribution = \"u-shaped\"",
        "distribution = \"arcsine\"",
        "tolerance = 0.1, distribution = \"curvilinear-trapezoid\"",
        "tolerance = 0.1, distribution = { kind = \"curvilinear-trapezoid\", inexactness = 0.1 }",
        "tolerance = 0.1, distribution = \"student\"",
        "tolerance = 0.1, distribution = { kind = \"student\", degrees = 2 }",
        "distribution = { kind = \"student\", degrees = 5 }",
        "tolerance = 0.1, sigma = 0.1, distribution = { kind = \"student\", degrees = 5, scale = 0.1 }",
        "tolerance = 0.1, sigmas = 2, distribution = { kind = \"student\", degrees = 5, scale = 0.1 }",
        "distribution = { kind = \"student\", degrees = 5, scale = 0 }",
        "tolerance = 0.1, distribution = { kind = \"studnet\", degrees = 5 }",
        "tolerance = 0.1, distribution = { kind = \"normal\", origin = 0 }",
        "distribution = \"gamma\"",
        "sigma = 0.1, distribution = { kind = \"gamma\", origin = 2 }",
        "sigma = 100, distribution = \"gamma\"",
        "sigma = -1, distribution = \"weibull\"",
        "tolerance = 0.1, sigmas = 3, sigma = 0.1, distribution = \"lognormal\"",
        "sigma = 0.5, distribution = \"exponential\"",
        "tolerance = 0.1, sigmas = 3, distribution = \"rayleigh\"",
        "distribution = { kind = \"exponential\", origin = 1 }",
        "tolerance = 0.1, distribution = \"exponentail\"",
        "tolerance = 0.1, distribution = \"mixture\"",
        "tolerance = 0.1, distribution = { kind = \"mixture\", parts = {} }",
        "tolerance = 0.1, distribution = { kind = \"mixture\", parts = { a = {} } }",
        "tolerance = 0.1, distribution = { kind = \"mixture\", parts = { a = { weight = 0 } } }",
        "tolerance = 0.1, distribution = { kind = \"mixture\", parts = { a = { weight = 1, unit = \"mm\" } } }",
        "tolerance = 0.1, distribution = { kind = \"mixture\", parts = { a = { weight = 1, distribution = \"beta\" } } }",
        "distribution = { kind = \"mixture\", parts = { a = { weight = 1 } } }",
        "tolerance = 0.1, shift = 1, distribution = { kind = \"mixture\", parts = { a = { weight = 1 } } }",
        "tolerance = 0.1, sigma = 1, distribution = { kind = \"mixture\", parts = { a = { weight = 1 } } }",
        "tolerance = 0.1, distribution = { kind = \"mixture\", parts = [1] }",
    ]
    .map(line);
    insta::assert_snapshot!(faults(&lines.iter().map(String::as_str).collect::<Vec<_>>()));
}

#[test]
fn dimensions_at_fault() {
    let line = |line: &str| format!("[dimensions]\na = {line}\n[characteristics]\ny = {{ formula = \"a\" }}\n");
    let lines = [
        "{ nominal = 10.0, tolerance = -0.3 }",
        "{ nominal = 10.0, tolerance = nan }",
        "{ nominal = inf }",
        "{ nominal = 1, tolerance = [0.3, -0.1] }",
        "{ nominal = 1, tolerance = [0.1, 0.1] }",
        "{ nominal = 1, tolerance = [0.1] }",
        "{ nominal = 1, tolerance = [0.1, 0.2, 0.3] }",
        "{ nominal = 1, tolerance = \"0.1\" }",
        "{ nominal = 1, limits = [2.0, 0.5] }",
        "{ nominal = 1, limits = [0.5, 2.0], tolerance = 0.1 }",
        "{ tolerance = 0.1 }",
        "{ nominal = 1, tolerence = 0.1 }",
        "{ nominal = 1, colour = 0.1 }",
        "{ nominal = 1, tolerance = 0.1, distribution = \"unifrom\" }",
        "{ nominal = 1, tolerance = 0.1, distribution = \"zipf\" }",
        "{ nominal = 1, tolerance = 0.1, distribution = { kind = \"uniform\", alpha = 2 } }",
        "{ nominal = 1, tolerance = 0.1, distribution = 3 }",
        "{ nominal = 1, tolerance = 0.1, distribution = {} }",
        "{ nominal = 1, distribution = \"uniform\" }",
        "{ nominal = 1, sigma = 0.1, distribution = \"uniform\" }",
        "{ nominal = 1, tolerance = 0.3, sigma = 0.1, distribution = \"uniform\" }",
        "{ nominal = 1, tolerance = 0.3, cp = 1, distribution = \"uniform\" }",
        "{ nominal = 1, tolerance = 0.3, shift = 0.1, distribution = \"uniform\" }",
        "{ nominal = 1, tolerance = 0.3, sigmas = 3, sigma = 0.2 }",
        "{ nominal = 1, tolerance = 0.3, sigmas = 3, cp = 2 }",
        "{ nominal = 1, tolerance = 0.3, sigmas = 0 }",
        "{ nominal = 1, tolerance = 0, sigma = 0.2 }",
        "{ nominal = 1, tolerance = 0.3, sigma = -0.2 }",
        "{ nominal = 1, sigmas = 3 }",
        "{ nominal = 1, shift = 0.1 }",
        "{ nominal = 1, sigma = 0.1, sigmas = 3 }",
        "{ nominal = 1, moments = [1, 0, 0.5, 0, 15, 0, 105] }",
        "{ nominal = 1, moments = [1, 0, 3, 0, 15, 0] }",
        "{ nominal = 1, moments = [1, 0, 3, 0, 15, 0, 105], sigma = 1 }",
        "{ nominal = 1e10, tolerance = 1e-8 }",
        "{ nominal = 1, tolerance = 0.1, step = 0 }",
        "{ nominal = 2026-11-21 }",
        "3",
    ]
    .map(line);
    insta::assert_snapshot!(faults(&lines.iter().map(String::as_str).collect::<Vec<_>>()));
}

#[test]
fn names_and_formulas_at_fault() {
    let dimensions = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n";
    let with = |rest: &str| format!("{dimensions}{rest}");
    let texts = [
        "".to_owned(),
        "[characteristics]\ny = { formula = \"1\" }\n".to_owned(),
        with(""),
        with("[characteristics]\n"),
        with("[characteristics]\ny = {}\n"),
        with("[characteristics]\ny = { formula = \"a + * 2\" }\n"),
        with("[characteristics]\ny = { formula = \"a + (b\" }\n"),
        with("[characteristics]\ny = { formula = \"a + bb\" }\n[constants]\nb = 1\n"),
        with("[characteristics]\ny = { formula = \"\" }\n"),
        with("[characteristics]\ny = { formula = \"\"\"\n  a\n  + zz\"\"\" }\n"),
        with("[characteristics]\ny = { formula = \"\\u0061 + zz\" }\n"),
        with("[formulas]\nu = \"v\"\nv = \"u\"\n[characteristics]\ny = { formula = \"u\" }\n"),
        with("[constants]\na = 1\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[constants]\npi = 3\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[constants]\n\"\" = 3\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[constants]\nk = \"3\"\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("a = { nominal = 2 }\n"),
        with("[characteristics]\ny = { formula = \"a\", lower = 2, upper = 1 }\n"),
        with("[characteristics]\ny = { formula = \"a\", lower = -inf }\n"),
        with("[characteristics]\ny = { formula = \"a\", lower = 0, target_yield = 1.0 }\n"),
        with("[characteristics]\ny = { formula = \"a\", target_yield = 0.9 }\n"),
        with("[characteristics]\ny = { formular = \"a\" }\n"),
        with("[characteristics]\ny = \"a\"\n"),
        with("[charakteristics]\ny = { formula = \"a\" }\n"),
        with("[characteristics]\ny = { formula = 'a'\n"),
        with("[analysis]\nmethod = \"sixn\"\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\naccuracy = 0\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\nbudget = -5\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\npairs = \"neighbours\"\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\nmethod = \"six-n\"\npairs = [[\"a\", \"c\"]]\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\nmethod = \"full\"\npairs = \"adjacent\"\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\nstencil = \"9-point\"\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\nmethod = \"dimension-reduction\"\nnodes = 4\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\nmethod = \"full\"\nnodes = 5\n[characteristics]\ny = { formula = \"a\" }\n"),
        with("[analysis]\nsensitivities = \"some\"\n[characteristics]\ny = { formula = \"a\" }\n"),
    ];
    insta::assert_snapshot!(faults(&texts.iter().map(String::as_str).collect::<Vec<_>>()));
}

#[test]
fn models_at_fault() {
    let texts = [
        "[model]\nbuiltin = \"engine-balence\"\n[dimensions]\na = { tolerance = 0.1 }\n[characteristics]\nF = {}\n",
        "[model]\nbuiltin = \"rocket\"\n",
        "[model]\n",
        "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nRR = { nominal = 1 }\n[characteristics]\nF = {}\n",
        "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nR = {}\n[constants]\nOmega = 3\n[characteristics]\nF = {}\n",
        "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nR = {}\n[characteristics]\nG = {}\n",
        "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nR = {}\n[characteristics]\nF = { formula = \"F/1000\" }\n",
        "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nR = {}\n[characteristics]\nk = { formula = \"FF/1000\" }\n",
        "[model]\ncommand = []\n[dimensions]\na = { nominal = 1 }\n[characteristics]\ng = {}\n",
        "[model]\ncommand = \"python3 gap.py\"\n[dimensions]\na = { nominal = 1 }\n[characteristics]\ng = {}\n",
        "[model]\nbuiltin = \"engine-balance\"\ncommand = [\"a\"]\n[dimensions]\nR = {}\n[characteristics]\nF = {}\n",
        "[model]\nbuiltin = \"engine-balance\"\nworkers = 2\n[dimensions]\nR = {}\n[characteristics]\nF = {}\n",
        "[model]\ncommand = [\"a\"]\nworkers = 0\n[dimensions]\na = { nominal = 1 }\n[characteristics]\ng = {}\n",
        "[model]\ncommand = [\"a\"]\ntimeout_s = -1\n[dimensions]\na = { nominal = 1 }\n[characteristics]\ng = {}\n",
        "[model]\ncommand = [\"a\"]\ntime_out_s = 1\n[dimensions]\na = { nominal = 1 }\n[characteristics]\ng = {}\n",
        "[model]\ncommand = [\"a\"]\nfiles = [\"nowhere.txt\"]\n[dimensions]\na = { nominal = 1 }\n[characteristics]\ng = {}\n",
        "[model]\ncommand = [\"a\"]\n[dimensions]\na = { tolerance = 1 }\n[characteristics]\ng = {}\n",
    ];
    insta::assert_snapshot!(faults(&texts));
}

#[test]
fn files_at_fault() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let message = |path: &std::path::Path| {
        let error = Study::read(path).err().unwrap();
        let text = format!("{}{}", error.fault, error.help().map(|help| format!(" / {help}")).unwrap_or_default());
        text.replace(&folder.path().display().to_string(), "FOLDER")
    };
    assert_eq!(
        message(&file("a.toml", b"title = \"caf\xe9\"\n")),
        "the file is not UTF-8 text: byte 0xe9 at offset 12"
    );
    assert_eq!(Study::read(&folder.path().join("a.toml")).err().unwrap().line_column(), Some((1, 13)));
    assert_eq!(message(folder.path()), "this is a folder, not a study / name the study file in it");
    file("study.toml", b"");
    assert_eq!(message(folder.path()), "this is a folder, not a study / did you mean FOLDER/study.toml?");
    assert_eq!(message(&file("a.txt", b"")), "a study is a .toml or a .json file");
    assert_eq!(
        message(&folder.path().join("none.toml")),
        "the file cannot be read: No such file or directory (os error 2)"
    );
    assert_eq!(message(&file("a.json", b"{\"dimensions\": {}")), "Unterminated object");
}

#[test]
fn toml_and_json_say_the_same() {
    let toml = parse(
        r#"
        title = "t"
        [constants]
        k = 2
        [dimensions]
        b = { nominal = 1, tolerance = [-0.1, 0.2], unit = "mm" }
        a = { nominal = 3.5, tolerance = 0.1, distribution = { kind = "uniform" } }
        [formulas]
        u = "a*k"
        [characteristics]
        y = { formula = "u - b", lower = 1, target_yield = 0.99 }
        [analysis]
        method = "six-n"
        pairs = [["a", "b"]]
        seed = 7
        "#,
    )
    .unwrap();
    let json = Study::from_json(
        r#"{
        "title": "t",
        "constants": {"k": 2},
        "dimensions": {
            "b": {"nominal": 1, "tolerance": [-0.1, 0.2], "unit": "mm"},
            "a": {"nominal": 3.5, "tolerance": 0.1, "distribution": {"kind": "uniform"}}
        },
        "formulas": {"u": "a*k"},
        "characteristics": {"y": {"formula": "u - b", "lower": 1, "target_yield": 0.99}},
        "analysis": {"method": "six-n", "pairs": [["a", "b"]], "seed": 7}
        }"#,
        "study.json",
    )
    .unwrap();
    let names = |study: &Study| study.problem.dimensions().iter().map(|d| d.name().to_owned()).collect::<Vec<_>>();
    assert_eq!(names(&toml), ["b", "a"], "file order");
    assert_eq!(names(&json), names(&toml));
    assert_eq!((json.title, json.seed, json.options.clone()), (toml.title, Some(7), toml.options.clone()));
    let of = |study: &sensitol::Problem, options| analyze(study, options).unwrap().characteristics;
    assert_eq!(of(&json.problem, &json.options), of(&toml.problem, &toml.options));
}

#[test]
fn json_faults_have_their_place() {
    let error =
        Study::from_json("{\"dimensions\": {\"a\": {\"nominal\": 1,\n \"tolerance\": -1}}}", "s.json").err().unwrap();
    assert_eq!((error.line_column(), error.key.as_str()), (Some((2, 15)), "dimensions.a.tolerance"));
    for text in [
        "[1]",
        "{\"title\": null}",
        "{\"dimensions\": {\"a\": {\"nominal\": 1e999}}}",
        "{\"title\": \"a\", \"title\": \"b\"}",
        "",
        "// x\n{}",
    ] {
        assert!(Study::from_json(text, "s.json").is_err(), "{text}");
    }
    // The place of a formula's fault takes escapes of its string into account.
    let text =
        "{\"dimensions\": {\"a\": {\"nominal\": 1}}, \"characteristics\": {\"y\": {\"formula\": \"\\u0061 +\\t zz\"}}}";
    let error = Study::from_json(text, "s.json").err().unwrap();
    assert_eq!(&text[error.span.unwrap()], "zz");
}

/// A model's inputs by name, its default nominal values, and formulas of its outputs.
#[test]
fn models_and_formulas_work_together() {
    let study = parse(
        r#"
        [model]
        builtin = "engine-balance"
        [constants]
        omega = 314.15925
        [dimensions]
        R = { tolerance = 0.00004 }
        mount = { nominal = 2.0, tolerance = 0.1 }
        [characteristics]
        F = {}
        per_mount = { formula = "F/mount", unit = "N" }
        "#,
    )
    .unwrap();
    let dimension = &study.problem.dimensions()[0];
    assert_eq!((dimension.nominal(), dimension.unit()), (0.0425, Some("m")));
    let analysis = analyze(&study.problem, &Method::Full.into()).unwrap();
    let [force, per_mount] = &analysis.characteristics[..] else { panic!("two characteristics") };
    relative(force.nominal.unwrap(), 12556.9361 / 4.0, 1e-8);
    relative(per_mount.nominal.unwrap(), 12556.9361 / 8.0, 1e-8);
    assert_eq!(force.sensitivities[1].first, Some(0.0), "the force does not know the mount");
    assert_eq!(force.contributions.possible_interactions, 0);
}

#[test]
fn names_may_be_anything() {
    let study = parse(
        r#"
        [dimensions]
        "D5@Sketch1@Crank" = { nominal = 55.8, tolerance = 0.2 }
        "größe 2" = { nominal = 1, tolerance = 0.1 }
        e = { nominal = 3, tolerance = 0.1 }
        länge = { nominal = 3, tolerance = 0.1 }
        [characteristics]
        "gap [upper]" = { formula = "`D5@Sketch1@Crank` - `größe 2`*e + länge" }
        "#
        .replace("länge", "\"länge\"")
        .replace("+ \"länge\"", "+ länge")
        .as_str(),
    )
    .unwrap();
    let found = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    relative(found.nominal.unwrap(), 55.8, 1e-14);
    // Inputs of a model may have names that formulas reserve, if the study has no formulas.
    let reserved = parse("[dimensions]\npi = { nominal = 1 }\n[characteristics]\ny = { formula = \"`pi`\" }\n");
    assert!(reserved.is_err());
}

#[test]
fn unused_names_are_warnings() {
    let study = parse(
        r#"
        [constants]
        used = 1
        idle = 2
        [dimensions]
        a = { nominal = 1, tolerance = 0.1 }
        b = { nominal = 1, tolerance = 0.1 }
        [formulas]
        u = "a + used"
        v = "b"
        [characteristics]
        y = { formula = "u" }
        "#,
    )
    .unwrap();
    let messages: Vec<String> = study.warnings.iter().map(|warning| warning.message()).collect();
    assert_eq!(messages, ["No characteristic uses the constant `idle`.", "No characteristic uses the formula `v`."]);
    let analysis = analyze(&study.problem, &Method::Full.into()).unwrap();
    assert_eq!(analysis.run.evaluations, 3);
    assert_eq!(analysis.warnings.iter().map(|warning| warning.code()).collect::<Vec<_>>(), ["unused-dimension"]);
}

/// One point lies outside the domain of `acos`. The error names point and value, and the rest of the study is analysed.
#[test]
fn a_formula_that_leaves_its_domain_names_point_and_value() {
    let study = parse(
        r#"
        [dimensions]
        a = { nominal = 0.9, tolerance = 0.3 }
        b = { nominal = 1.0, tolerance = 0.1 }
        [characteristics]
        angle = { formula = "b + acos(a)" }
        sum = { formula = "a + b" }
        "#,
    )
    .unwrap();
    let analysis = analyze(&study.problem, &Method::SecondOrder.into()).unwrap();
    let message = analysis.warnings.iter().find(|warning| warning.code() == "failed-points").unwrap().message();
    assert_eq!(
        message,
        "`angle` has no value at 1 of 6 points. The first is at a = 1.0732050807568878 (mean +1.732 sigma): `acos(a)` in formula \
         `angle`: the argument must lie in -1 .. 1, but is 1.0732050807568878. The share of assemblies without a value is unknown."
    );
    let [angle, sum] = &analysis.characteristics[..] else { panic!("two characteristics") };
    assert!(angle.moments.is_some());
    relative(sum.moments.unwrap().sigma(), 0.1f64.hypot(0.1 / 3.0), 1e-12);
}

#[test]
fn every_example_is_valid() {
    let all = example_studies();
    for (example, path) in &all {
        let study = Study::read(path).unwrap_or_else(|error| panic!("{error}"));
        if !INSTALLED.contains(&example.as_str()) {
            analyze(&study.problem, &study.options).unwrap();
        }
    }
    assert!(all.len() >= 20);
}
