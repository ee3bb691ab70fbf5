//! Formulas that drive the inputs of a model: of built-in ones by name, of programs by `[model] inputs`.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use assert_cmd::Command;
use sensitol::assembly::formula::Formula;
use sensitol::assembly::{
    AssemblyFunction, Composite, EvaluationError, Input, Parts, Points, Request, Responses, Run, Signature, Source,
};
use sensitol::verification::check_points;
use sensitol::{Analysis, Dimension, Method, Options, Problem, analyze};
use sensitol_study::Study;
use sensitol_testing::{analysed, case, close, faults, parse, relative, repository};

/// Returns the values of the first characteristics at one point of the dimensions.
fn at(study: &Study, point: &[f64]) -> Vec<Option<f64>> {
    let outputs: Vec<usize> = (0..study.problem.characteristics().len()).collect();
    let mut out = Responses::open(1, outputs.len());
    let points = Points::from_rows(&[point]);
    study.problem.function().evaluate(&Request::values(&points, &outputs), &Run::to_the_end(), &mut out);
    (0..outputs.len()).map(|output| out.value(0, output)).collect()
}

const FIXED_SUM: &str = "[model]\nbuiltin = \"dual-mass-flywheel\"\n[dimensions]\nJ2 = { nominal = 0.04, tolerance = 0.002 }\n\
                         [constants]\nk = 327.844\n[formulas]\nJ1 = \"0.33 - J2\"\n[characteristics]\nn_crit_DMF = {}\n";

/// The slope by hand, with J1 = J - J2: n/2 (1/J1 - 1/J2). With a fixed J1 it would differ. The step of `full` is sqrt(3) sigma, with a
/// fourth-order remainder below 1e-3 of the slope: (sigma/J2)^2.
#[test]
fn a_formula_drives_an_input_of_a_built_in_model() {
    let case = case("flywheel-fixed-sum");
    let exact = |key: &str| case["exact"][key].as_f64().unwrap();
    let study = parse(FIXED_SUM).unwrap();
    relative(at(&study, &[0.04])[0].unwrap(), exact("n_crit_DMF"), 1e-12);
    let printed = case["printed"]["n_crit_DMF"]["value"].as_f64().unwrap();
    assert!(
        (at(&study, &[0.04])[0].unwrap() - printed).abs()
            < case["printed"]["n_crit_DMF"]["tolerance"].as_f64().unwrap()
    );
    let first = |text: &str| analysed(text, Method::Full).characteristics[0].sensitivities[0].first.unwrap();
    relative(first(FIXED_SUM), exact("slope J2"), 2e-3);
    let free =
        FIXED_SUM.replace("[formulas]\nJ1 = \"0.33 - J2\"\n", "").replace("k = 327.844", "k = 327.844\nJ1 = 0.29");
    relative(first(&free), exact("slope J2 with J1 fixed"), 2e-3);
}

/// A formula of the outputs, a formula of a formula, and constants as inputs. The study with J1 as a dimension of the same value gives
/// the same digits.
#[test]
fn driven_inputs_are_what_their_formulas_say() {
    let chained = FIXED_SUM.replace("J1 = \"0.33 - J2\"", "total = \"0.3 + J2 - 0.01\"\nJ1 = \"total - J2 + 0*k\"");
    let plain = FIXED_SUM
        .replace("[formulas]\nJ1 = \"0.33 - J2\"\n", "")
        .replace("[constants]", "J1 = { nominal = 0.29 }\n[constants]");
    let (chained, plain) = (parse(&chained).unwrap(), parse(&plain).unwrap());
    let j1 = 0.3 + 0.045 - 0.01 - 0.045;
    assert_eq!(at(&chained, &[0.045]), at(&plain, &[0.045, j1]));
}

/// A point at which the driving formula has no value fails with the formula's reason.
#[test]
fn a_formula_without_a_value_is_a_point_without_one() {
    let study = parse(&FIXED_SUM.replace("0.33 - J2", "sqrt(0.04 - J2) + 0.29")).unwrap();
    let mut out = Responses::open(1, 1);
    let points = Points::from_rows(&[[0.05]]);
    study.problem.function().evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut out);
    let error = out.error(0, 0).unwrap().to_string();
    assert!(error.contains("sqrt"), "{error}");
}

/// Driven by unknowns of closure conditions: u solves u^2 = J2, so that J1 = 0.33 - u^2.
#[test]
fn unknowns_may_drive() {
    let text = FIXED_SUM.replace(
        "\"0.33 - J2\"\n",
        "\"0.33 - u^2\"\n[unknowns]\nu = { start = 0.2, lower = 0 }\n[equations]\ne = \"u^2 - J2\"\n",
    );
    let (implicit, plain) = (parse(&text).unwrap(), parse(FIXED_SUM).unwrap());
    for j2 in [0.038, 0.04, 0.0415] {
        // Newton's method ends within 1e-12 of the root.
        relative(at(&implicit, &[j2])[0].unwrap(), at(&plain, &[j2])[0].unwrap(), 1e-10);
    }
}

#[test]
fn what_cannot_drive_is_said() {
    let model = "[model]\nbuiltin = \"dual-mass-flywheel\"\n";
    let rest = "[characteristics]\nn_crit_DMF = {}\n";
    let program = |inputs: &str| format!("[model]\ncommand = [\"true\"]\n{inputs}");
    let dimensions = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\nb = { nominal = 2, tolerance = 0.1 }\n";
    insta::assert_snapshot!(faults(&[
        &format!(
            "{model}[dimensions]\nJ2 = {{ tolerance = 0.002 }}\n[formulas]\nJ1 = \"0.33 - J2*n_crit_DMF\"\n{rest}"
        ),
        &format!(
            "{model}[dimensions]\nJ2 = {{ tolerance = 0.002 }}\nJ1 = {{ tolerance = 0.1 }}\n[formulas]\nJ1 = \"0.33 - J2\"\n{rest}"
        ),
        &format!("{}{dimensions}[formulas]\nc = \"a + b\"\n[characteristics]\ny = {{}}\n", program("")),
        &format!(
            "{}{dimensions}[formulas]\nc = \"a + b\"\n[characteristics]\ny = {{}}\n",
            program("inputs = [\"a\", \"d\"]\n")
        ),
        &format!("{}{dimensions}[characteristics]\ny = {{}}\n", program("inputs = [\"a\", \"a\", \"b\"]\n")),
        &format!("{}{dimensions}[characteristics]\ny = {{}}\n", program("inputs = [\"a\"]\n")),
        &format!(
            "{}{dimensions}[formulas]\nc = \"a + y\"\n[characteristics]\ny = {{}}\n",
            program("inputs = [\"b\", \"c\"]\n")
        ),
        &format!(
            "{}{dimensions}[formulas]\nc = \"sqrt(a - b)\"\n[characteristics]\ny = {{}}\n",
            program("inputs = [\"c\"]\n")
        ),
        &format!(
            "{}{dimensions}[formulas]\nc = \"a + bb\"\n[characteristics]\ny = {{}}\n",
            program("inputs = [\"b\", \"c\"]\n")
        ),
        &format!("{model}inputs = [\"J2\"]\n[dimensions]\nJ2 = {{ tolerance = 0.002 }}\n{rest}"),
    ]));
}

/// Returns a study of a child that counts its requests. Three dimensions and a constant drive its two inputs.
fn counting(folder: &Path) -> String {
    let (script, counter) = (repository("tests/children/counting.py"), folder.join("count"));
    format!(
        "[model]\ncommand = [\"python3\", {:?}, {:?}, \"0\", \"1\"]\ninputs = [\"gap\", \"k\", \"c\"]\nverify = 0\n\
         [dimensions]\na = {{ nominal = 10, tolerance = 0.75 }}\nb = {{ nominal = 4, tolerance = 0.75 }}\nc = {{ nominal = 1, tolerance = 0.375 }}\n\
         [constants]\nk = 2\n[formulas]\ngap = \"a - b\"\n[characteristics]\ny = {{}}\n[analysis]\nmethod = \"full\"\nstep = 1\nverify = 0\n",
        script.display().to_string(),
        counter.display().to_string(),
    )
}

/// The child answers gap + 2 k + 3 c + 0.01 gap k. With k = 2 its slopes are 1.02 along a, -1.02 along b, 3 along c. The plan of `full`
/// has the nominal point, 6 points along the axes and 6 of the pairs. a - b is equal for a up and for b down, and nominal for both up, so
/// that fewer points are sent.
#[test]
fn a_program_is_sent_what_its_inputs_name_and_each_point_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, counting(folder.path())).unwrap();
    let run = || {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        let output = command
            .arg("analyze")
            .arg(&path)
            .args(["--json", "--journal"])
            .arg(folder.path().join("j.sqlite"))
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let report = run();
    let counted = || std::fs::metadata(folder.path().join("count")).unwrap().len();
    let slope = |index: usize| report["characteristics"][0]["sensitivities"][index]["first"].as_f64().unwrap();
    // Differences of a linear model: rounding of values of 12 over steps of 0.1.
    [1.02, -1.02, 3.0].into_iter().enumerate().for_each(|(index, exact)| close(slope(index), exact, 1e-12, 1.0));
    let sent = counted();
    // Steps of one sigma are exact in doubles. Axes: the gap up or down, and c up or down: 2 + 2. Pairs of a and b have a gap of 0 or of
    // 2 steps. Pairs of a or b with c are both up or both down: 2 + 2.
    assert!(sent < 12, "{sent} points sent");
    let evaluations = report["evaluations"].as_u64().unwrap();
    // The nominal point, once more at the end of the batch.
    assert_eq!(evaluations, sent + 2, "what is sent is what is counted");
    run();
    assert_eq!(counted(), sent, "what was sent once is known");
}

/// `plan --write-points` writes the inputs of the program.
#[test]
fn points_are_written_as_they_are_sent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, counting(folder.path())).unwrap();
    let points = folder.path().join("points.csv");
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
    command.arg("plan").arg(&path).arg("--write-points").arg(&points).assert().success();
    let text = std::fs::read_to_string(&points).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("gap,k,c"));
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert!(rows.contains(&vec![6.0, 2.0, 1.0]) && rows.iter().all(|row| row[1] == 2.0), "{text}");
    // With answers to them the analysis gives the result of the same model by hand.
    let answered: String =
        std::iter::once("gap,k,c,y\n".to_owned())
            .chain(rows.iter().map(|x| {
                format!("{},{},{},{}\n", x[0], x[1], x[2], x[0] + 2.0 * x[1] + 3.0 * x[2] + 0.01 * x[0] * x[1])
            }))
            .collect();
    std::fs::write(&points, answered).unwrap();
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
    let output = command.arg("analyze").arg(&path).arg("--json").arg("--points").arg(&points).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    close(report["characteristics"][0]["sensitivities"][1]["first"].as_f64().unwrap(), -1.02, 1e-12, 1.0);
}

/// Returns a costly product of its two inputs. It counts its requests, and has no value if its first input exceeds `most`.
struct Product {
    signature: Signature,
    asked: Arc<AtomicUsize>,
    most: f64,
}

impl AssemblyFunction for Product {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, _: &Run<'_>, out: &mut Responses) {
        self.asked.fetch_add(request.points.rows(), Ordering::Relaxed);
        for row in 0..request.points.rows() {
            let z = request.points.row(row);
            match z[0] > self.most {
                true => out.fail(row, 0, EvaluationError::NotFinite { value: f64::NAN }),
                false => out.set(row, 0, z[0] * z[1]),
            }
        }
    }
}

/// Twelve dimensions, of which six each drive an input of a costly model.
fn narrow(tolerance: f64) -> (Problem, Arc<AtomicUsize>) {
    let names: Vec<String> = (0..12).map(|i| format!("x{i}")).collect();
    driving(tolerance, f64::INFINITY, [&names[0..6].join(" + "), &names[6..12].join(" + ")])
}

/// Returns a problem of twelve dimensions that drive the two inputs of a costly model by these formulas. `z` is twice the product of the
/// inputs.
fn driving(tolerance: f64, most: f64, [p, q]: [&str; 2]) -> (Problem, Arc<AtomicUsize>) {
    let asked = Arc::new(AtomicUsize::new(0));
    let signature = Signature { costly: true, ..Signature::of_names(["p", "q"], ["y"]) };
    let model = Product { signature, asked: Arc::clone(&asked), most };
    let names: Vec<String> = (0..12).map(|i| format!("x{i}")).collect();
    let formula = |text: &str| Formula::parse(text).unwrap();
    let parts = Parts {
        inputs: names.iter().map(|name| Input { name: name.clone(), unit: None }).collect(),
        model: Some((Arc::new(model), vec![Source::Formula(0), Source::Formula(1)])),
        formulas: vec![("p".into(), formula(p)), ("q".into(), formula(q)), ("z".into(), formula("2*y"))],
        outputs: vec![("z".into(), None)],
        ..Parts::default()
    };
    let dimensions = names.iter().map(|name| Dimension::normal(name, 1.0, tolerance).unwrap());
    (Problem::new(dimensions, Composite::new(parts).unwrap()).unwrap(), asked)
}

/// If the model has no value at a point of its inputs, the fit is over the dimensions, with a warning that names the point. Points
/// evaluated before count. If only check points have no value, there is a warning too.
#[test]
fn points_without_a_value_are_said_whatever_the_side() {
    let names: Vec<String> = (0..12).map(|i| format!("x{i}")).collect();
    let (sum, rest) = (names[0..6].join(" + "), names[6..12].join(" + "));
    // The sum p has sigma 0.245: its upper node is at 6.42.
    let codes = |analysis: &Analysis| analysis.warnings.iter().map(|warning| warning.code()).collect::<Vec<_>>();
    let (problem, asked) = driving(0.3, 6.3, [&sum, &rest]);
    let analysis = analyze(&problem, &Options::from(Method::Full).with_verify(0)).unwrap();
    assert_eq!(analysis.run.evaluations as usize, asked.load(Ordering::Relaxed));
    assert!(codes(&analysis).contains(&"failed-points"), "{:?}", analysis.warnings);
    let (problem, _) = driving(0.3, 6.43, [&sum, &rest]);
    let analysis = analyze(&problem, &Method::Full.into()).unwrap();
    assert!(analysis.characteristics[0].missing.without_value > 0);
    assert_eq!(codes(&analysis), ["domain-edge-within"]);
}

/// A built-in model too: twelve dimensions drive its two inputs, and the speed is sqrt(k/J1 + k/J2) times a constant. Its variance by the
/// slopes of the two equals that by the slopes of the twelve. `auto` samples such a model as usual.
#[test]
fn few_inputs_of_a_built_in_model_are_the_narrower_side() {
    let name = |side: &str, i: usize| format!("{side}{i}");
    let parts = |side: &str| (0..6).map(|i| name(side, i)).collect::<Vec<_>>().join(" + ");
    let lines = |side: &str, nominal: f64| -> String {
        (0..6).map(|i| format!("{} = {{ nominal = {nominal}, tolerance = 0.0003 }}\n", name(side, i))).collect()
    };
    let study = |formulas: &str, lines: &str| {
        format!(
            "[model]\nbuiltin = \"dual-mass-flywheel\"\n[dimensions]\n{lines}[constants]\nk = 327.844\n{formulas}[characteristics]\nn_crit_DMF = {{}}\n"
        )
    };
    let driven = study(
        &format!("[formulas]\nJ1 = \"{}\"\nJ2 = \"{}\"\n", parts("p"), parts("q")),
        &(lines("p", 0.05) + &lines("q", 0.007)),
    );
    let problem = parse(&driven).unwrap().problem;
    let full = Options::from(Method::Full).with_verify(0);
    assert_eq!(full.cost(&problem).unwrap().evaluations, 7);
    let found = analyze(&problem, &full).unwrap();
    assert_eq!((found.run.evaluations, found.varying), (7, 12));
    // By hand: each of the two inputs is normal with sqrt(6) times the sigma of a part.
    let sigma = 6f64.sqrt() * 0.0001;
    let two =
        study("", &format!("J1 = {{ nominal = 0.3, sigma = {sigma} }}\nJ2 = {{ nominal = 0.042, sigma = {sigma} }}\n"));
    let plain = analyze(&parse(&two).unwrap().problem, &full).unwrap();
    let moments = |analysis: &Analysis| analysis.characteristics[0].moments.unwrap();
    // The moments of the inputs come from 8192 Sobol' points.
    relative(moments(&found).mean(), moments(&plain).mean(), 1e-6);
    relative(moments(&found).sigma(), moments(&plain).sigma(), 1e-3);
    assert!(Options::from(Method::Auto).cost(&problem).unwrap().evaluations > 12);
}

/// Inputs that are nearly or fully correlated are fitted along their principal axes: 7 evaluations for two axes, 3 for one, instead of
/// 157. By hand, for normal p of mean 6 and variance v, p^2 has the variance 144 v + 2 v^2. With another such r, p r has 72 v + v^2, and
/// the covariance of both is 72 v.
#[test]
fn inputs_that_vary_alike_are_fitted_along_their_axes() {
    let names: Vec<String> = (0..12).map(|i| format!("x{i}")).collect();
    let (sum, rest) = (names[0..6].join(" + "), names[6..12].join(" + "));
    let v = 6.0 * 0.1f64.powi(2);
    let c = 0.01;
    let alike = 144.0 * v + 2.0 * v * v + c * c * (72.0 * v + v * v) + 2.0 * c * 72.0 * v;
    for (second, evaluations, mean, variance, slope) in [
        (format!("{sum} + {c}*({rest})"), 7, 2.0 * (36.0 + v + c * 36.0), 4.0 * alike, 2.0 * (12.0 + c * 6.0)),
        (format!("2*({sum}) + 0*({rest})"), 3, 4.0 * (36.0 + v), 16.0 * (144.0 * v + 2.0 * v * v), 48.0),
    ] {
        let (problem, asked) = driving(0.3, f64::INFINITY, [&sum, &second]);
        let full = Options::from(Method::Full).with_verify(0);
        assert_eq!(full.cost(&problem).unwrap().evaluations as u64, evaluations, "{second}");
        let analysis = analyze(&problem, &full).unwrap();
        assert_eq!(analysis.run.evaluations, evaluations);
        assert_eq!(asked.load(Ordering::Relaxed) as u64, evaluations);
        let found = &analysis.characteristics[0];
        let moments = found.moments.unwrap();
        // The surface is exact. Its coefficients are differences of values near 72 over steps of 0.4, along an axis whose sigma is 0.002
        // of the other's.
        relative(moments.sigma(), variance.sqrt(), 1e-7);
        relative(moments.mean(), mean, 1e-11);
        close(found.sensitivities[3].first.unwrap(), slope, 1e-6, 1.0);
    }
}

/// The surface is fitted over the two inputs: 7 evaluations instead of 157. With p and q of mean 6 and sigma s, 2 p q has the variance 4
/// (2 36 s^2 + s^4).
#[test]
fn few_inputs_of_a_model_are_the_narrower_side() {
    let (problem, asked) = narrow(0.3);
    let full = Options::from(Method::Full).with_verify(0);
    assert_eq!(full.cost(&problem).unwrap().evaluations, 7);
    let analysis = analyze(&problem, &full).unwrap();
    assert_eq!((analysis.run.evaluations, asked.load(Ordering::Relaxed)), (7, 7));
    assert_eq!(analysis.varying, 12);
    let found = &analysis.characteristics[0];
    let square = 6.0 * 0.1f64.powi(2);
    let moments = found.moments.unwrap();
    // The surface is exact. Its coefficients are differences of values near 36 over steps of 0.25.
    relative(moments.sigma(), (4.0 * (72.0 * square + square * square)).sqrt(), 1e-9);
    relative(moments.mean(), 72.0, 1e-12);
    close(found.sensitivities[3].first.unwrap(), 12.0, 1e-8, 1.0);
    // Check points evaluate the model itself, and confirm the surface.
    let verified = analyze(&problem, &Method::Full.into()).unwrap();
    let checks = check_points(None, 2) as u64;
    assert!(verified.run.evaluations > 7 && verified.run.evaluations <= 7 + checks, "{}", verified.run.evaluations);
    // Few points always leave a part of the variance unverified.
    let share = verified.characteristics[0].evidence.verification.as_ref().unwrap().left.unwrap();
    assert!(share < 1e-4, "{share}");
    // Other methods too: 2 m + 1.
    let (problem, asked) = narrow(0.3);
    analyze(&problem, &Options::from(Method::SecondOrder).with_verify(0)).unwrap();
    assert_eq!(asked.load(Ordering::Relaxed), 5);
}
