//! Implicit assemblies: against explicit formulas and closed forms, at their limits, and with faulty definitions. Analyses use exact
//! derivatives.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::assembly::implicit::AssemblyFailure;
use sensitol::assembly::{Derivatives, Directions, EvaluationError, Points, Request, Responses, Run};

use sensitol::method::Basis;
use sensitol::{DerivativeSource, Method, MethodError, Options, Problem, analyze};
use sensitol_study::Study;
use sensitol_testing::{close, data, repository};

fn study(text: &str) -> Study {
    Study::from_toml(text, "study.toml").unwrap_or_else(|error| panic!("{error}"))
}

fn example(path: &str) -> Problem {
    Study::read(&repository("examples").join(path)).unwrap().problem
}

fn evaluated(problem: &Problem, points: &Points) -> Responses {
    let mut out = Responses::open(points.rows(), problem.outputs().len());
    problem.function().evaluate(&Request::values(points, problem.outputs()), &Run::to_the_end(), &mut out);
    out
}

/// Returns the value of the first characteristic at one point.
fn value(problem: &Problem, x: &[f64]) -> Result<f64, EvaluationError> {
    let out = evaluated(problem, &Points::from_rows(&[x]));
    out.value(0, 0).ok_or_else(|| out.error(0, 0).expect("a value or an error").clone())
}

fn exact(problem: &Problem, x: &[f64], pairs: &[(usize, usize)]) -> Derivatives {
    let inputs: Vec<usize> = (0..x.len()).collect();
    let directions = Directions { point: x, inputs: &inputs, pairs };
    problem.function().derivatives(&problem.outputs()[..1], &directions).remove(0).unwrap()
}

fn centre(problem: &Problem) -> Vec<f64> {
    problem.dimensions().iter().map(|dimension| dimension.nominal()).collect()
}

/// Returns random points within three times the tolerances.
fn random_points(problem: &Problem, rows: usize) -> Vec<Vec<f64>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut row = || {
        let dimensions = problem.dimensions().iter();
        dimensions.map(|d| d.nominal() + 3.0 * d.half_band() * random.random_range(-1.0..1.0)).collect()
    };
    (0..rows).map(|_| row()).collect()
}

/// Converts a point of one problem to another one that has some of its dimensions, in another order.
fn translated(from: &Problem, to: &Problem, x: &[f64]) -> Vec<f64> {
    let of = |name: &str| from.dimensions().iter().position(|dimension| dimension.name() == name);
    let dimension = |d: &sensitol::Dimension| of(d.name()).map_or(d.nominal(), |index| x[index]);
    to.dimensions().iter().map(dimension).collect()
}

/// Tolerance of results: the rounding of a hundred millimetres is 1e-14, and the conditions amplify it a few times.
const ROUNDING: f64 = 1e-12;

#[test]
fn stacked_blocks_by_loops_and_by_contacts_equal_the_formula() {
    let explicit = example("stacked-blocks/study.toml");
    for path in ["stacked-blocks-loops/study.toml", "stacked-blocks-loops/contacts.toml"] {
        let implicit = example(path);
        let rows = random_points(&implicit, 1000);
        let there: Vec<Vec<f64>> = rows.iter().map(|x| translated(&implicit, &explicit, x)).collect();
        let found = evaluated(&implicit, &Points::from_rows(&rows));
        let expected = evaluated(&explicit, &Points::from_rows(&there));
        for row in 0..rows.len() {
            close(found.value(row, 0).unwrap(), expected.value(row, 0).unwrap(), ROUNDING, 1.0);
        }
    }
}

#[test]
fn a_four_bar_linkage_equals_its_closed_form() {
    let (implicit, explicit) = (example("four-bar/study.toml"), example("four-bar/closed-form.toml"));
    let rows = random_points(&implicit, 1000);
    let points = Points::from_rows(&rows);
    let (found, expected) = (evaluated(&implicit, &points), evaluated(&explicit, &points));
    for row in 0..rows.len() {
        for output in 0..2 {
            close(found.value(row, output).unwrap(), expected.value(row, output).unwrap(), ROUNDING, 1.0);
        }
    }
    let pairs: Vec<(usize, usize)> = (0..5).flat_map(|j| (j + 1..5).map(move |k| (j, k))).collect();
    for x in &rows[..20] {
        let (found, expected) = (exact(&implicit, x, &pairs), exact(&explicit, x, &pairs));
        let all = |of: &Derivatives| [of.first.clone(), of.second.clone(), of.mixed.clone()].concat();
        for (found, expected) in all(&found).into_iter().zip(all(&expected)) {
            close(found.unwrap(), expected.unwrap(), ROUNDING, 1.0);
        }
    }
}

/// The closed form is `x = r cos(theta) + sqrt(l^2 - (e + r sin(theta))^2)`, over the full turn and far from the start values.
#[test]
fn a_slider_crank_equals_its_closed_form() {
    let problem = study(SLIDER).problem;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    for _ in 0..1000 {
        let [r, l, e] = [50.0, 150.0, 10.0].map(|nominal: f64| nominal * random.random_range(0.9..1.1));
        let theta: f64 = random.random_range(-180.0..180.0);
        let (sin, cos) = theta.to_radians().sin_cos();
        let x = r * cos + (l * l - (e + r * sin).powi(2)).sqrt();
        close(value(&problem, &[r, l, e, theta]).unwrap(), x, ROUNDING, 1.0);
    }
}

const SLIDER: &str = r#"
    [dimensions]
    r = { nominal = 50, tolerance = 0.1 }
    l = { nominal = 150, tolerance = 0.1 }
    e = { nominal = 10, tolerance = 0.1 }
    theta = { nominal = 40, tolerance = 1 }
    [unknowns]
    x = 180
    beta = { start = -0.3, lower = -1.57, upper = 1.57 }
    [loops]
    crank = [
        { length = "r", angle = "theta*deg" },
        { length = "l", angle = "beta" },
        { length = "e", angle = "pi/2" },
        { length = "x", angle = "pi" },
    ]
    [characteristics]
    x = { upper = 200 }
"#;

/// Sensitivities of the direct linearisation method are the limit of differences, and those of the explicit formula.
#[test]
fn sensitivities_are_exact() {
    let problem = example("stacked-blocks-loops/study.toml");
    let (x, truth) = (centre(&problem), data("stacked-blocks.json"));
    let derivatives = exact(&problem, &x, &[]);
    for (d, dimension) in problem.dimensions().iter().enumerate() {
        let name = dimension.name();
        let at = |u: f64| {
            value(&problem, &x.iter().enumerate().map(|(e, x)| x + if e == d { u } else { 0.0 }).collect::<Vec<_>>())
                .unwrap()
        };
        // Richardson extrapolation, with errors of h^4 f'''''/20 and of rounding, 1e-14/h.
        let slope = |h: f64| (at(h) - at(-h)) / (2.0 * h);
        let difference = (4.0 * slope(5e-4) - slope(1e-3)) / 3.0;
        close(derivatives.first[d].unwrap(), difference, 1e-8, 1.0);
        if let (Some(first), Some(second)) = (truth["first"][name].as_f64(), truth["second"][name].as_f64()) {
            close(derivatives.first[d].unwrap(), first, ROUNDING, 1.0);
            close(derivatives.second[d].unwrap(), second, ROUNDING, 1.0);
        }
    }
    // The same result from the study file.
    let text = std::fs::read_to_string(repository("examples/stacked-blocks-loops/study.toml")).unwrap();
    let options = study(&text.replace("method = \"rss\"", "method = \"rss\"\nderivatives = \"exact\"")).options;
    let linear = Options::from(Method::Rss).with_derivatives(DerivativeSource::Exact);
    assert_eq!(options, linear);
    let analysis = analyze(&problem, &linear).unwrap();
    assert_eq!((analysis.run.evaluations, analysis.basis), (1, Basis::Exact));
    let gap = &analysis.characteristics[0];
    let rss = |d: usize| derivatives.first[d].unwrap() * problem.dimensions()[d].half_band();
    let expected = (0..x.len()).map(|d| rss(d).powi(2)).sum::<f64>().sqrt();
    close(gap.linear.rss.unwrap(), expected, 1e-14, 0.0);
    close(gap.moments.unwrap().sigma(), expected / 3.0, 1e-13, 0.0);
}

/// Results have the same bits for any number of threads and any order of the points. None depends on its neighbours.
#[test]
fn points_do_not_know_of_each_other() {
    let problem = example("four-bar/study.toml");
    let mut rows = random_points(&problem, 3000);
    let with = |threads: usize, rows: &[Vec<f64>]| -> Vec<u64> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let out = pool.install(|| evaluated(&example("four-bar/study.toml"), &Points::from_rows(rows)));
        out.column(0).iter().map(|value| value.to_bits()).collect()
    };
    let once = with(1, &rows);
    assert_eq!(once, with(2, &rows));
    rows.reverse();
    let mut reversed = with(2, &rows);
    reversed.reverse();
    assert_eq!(once, reversed);
    assert_eq!(once[17], value(&problem, &rows[2999 - 17]).unwrap().to_bits());
}

/// Solutions of `u^3 - 3u = x`, which has three branches for -2 < x < 2. The branch through u = -2 at x = -2 .. ends at x = 2, u = -1.
fn cubic(start: f64, characteristic: &str) -> Problem {
    let text = format!(
        "[dimensions]\nx = {{ nominal = 0, tolerance = 0.1 }}\n[unknowns]\nu = {start}\n[equations]\n\
         cubic = \"u^3 - 3*u - x\"\n[characteristics]\n{characteristic}\n"
    );
    study(&text).problem
}

#[test]
fn a_branch_is_followed_to_its_end() {
    let lower = cubic(-1.7, "u = {}");
    // u = 2 cos(phi), x = 2 cos(3 phi): the branch of -sqrt 3 is phi in 2 pi/3 .. pi, with x from 2 down to -2, and beyond.
    for phi in [2.1, 2.2, 2.4, 2.7, 3.0] {
        let phi: f64 = phi;
        // Near the fold at 2 pi/3 rounding of x is amplified by 1/(3 u^2 - 3).
        let (x, u) = (2.0 * (3.0 * phi).cos(), 2.0 * phi.cos());
        close(value(&lower, &[x]).unwrap(), u, 1e-14 + 1e-15 / (3.0 * u * u - 3.0), 1.0);
    }
    close(value(&lower, &[-52.0]).unwrap(), -4.0, 1e-14, 0.0);
    // No solution is near beyond the fold.
    let error = value(&lower, &[2.5]).unwrap_err();
    let EvaluationError::Assembly(failure) = &error else { panic!("{error}") };
    let AssemblyFailure::Open { nominal: false, followed: Some(followed), residual, .. } = &**failure else {
        panic!("{error}")
    };
    close(*followed, 0.8, 1e-3, 0.0);
    close(*residual, -0.5, 1e-6, 0.0);
    // Only another branch exists farther away.
    let error = value(&lower, &[20.0]).unwrap_err();
    let EvaluationError::Assembly(failure) = &error else { panic!("{error}") };
    let AssemblyFailure::OtherBranch { unknown, found, followed, .. } = &**failure else { panic!("{error}") };
    assert_eq!(unknown, "u");
    close(found.powi(3) - 3.0 * found, 20.0, 1e-12, 0.0);
    close(*followed, 0.1, 1e-3, 0.0);
    assert!(error.to_string().starts_with("the assembly jumps to another branch: `u` would be 3."), "{error}");
    let upper = cubic(1.7, "u = {}");
    close(value(&upper, &[52.0]).unwrap(), 4.0, 1e-14, 0.0);
}

#[test]
fn a_point_without_state_names_what_is_worst() {
    let problem = study(
        "[dimensions]\nx = { nominal = 1, tolerance = 0.1 }\n[unknowns]\nu = 1\nv = { start = 2, upper = 3 }\n[equations]\n\
         square = \"u^2 - x\"\nsum = \"v - 2*x - (u - 1)\"\n[characteristics]\ny = { formula = \"u + v\" }\n",
    )
    .problem;
    close(value(&problem, &[1.21]).unwrap(), 1.1 + 2.52, 1e-14, 0.0);
    let message = |x: f64| value(&problem, &[x]).unwrap_err().to_string();
    assert!(message(-1.0).contains("equation `square` is off by"), "{}", message(-1.0));
    let root = study(
        "[dimensions]\nx = { nominal = 1, tolerance = 0.1 }\n[unknowns]\nu = 1\n[equations]\nroot = \"u - sqrt(x)\"\n\
         [characteristics]\nu = {}\n",
    );
    let error = value(&root.problem, &[-1.0]).unwrap_err().to_string();
    assert_eq!(error, "`sqrt(x)` in formula `root`: the argument must not be negative, but is -1");
    let bound = message(4.0);
    assert!(bound.contains("equation `sum` is off by") && bound.contains("`v` stands at its bound 3"), "{bound}");
}

/// A loop that does not close is reported before any evaluation, with its residual.
#[test]
fn a_loop_that_does_not_close_says_by_how_much() {
    let text = std::fs::read_to_string(repository("examples/four-bar/study.toml")).unwrap();
    let problem = study(&text.replace("nominal = 100.0", "nominal = 300.0")).problem;
    let MethodError::Model { error } = analyze(&problem, &Method::Rss.into()).unwrap_err() else {
        panic!("another error")
    };
    let EvaluationError::Assembly(failure) = &error else { panic!("{error}") };
    let AssemblyFailure::Open { nominal: true, worst, residual, start, .. } = &**failure else { panic!("{error}") };
    // With the crank at 60 degrees the two other bars reach 200 of the sqrt(280^2 + 34.64^2) to the far pin.
    assert_eq!(worst, "loop `linkage` along x");
    close(residual.abs(), (280.0f64.hypot(34.641016) - 200.0) * 280.0 / 280.0f64.hypot(34.641016), 0.02, 0.0);
    let begun = 20.0 + 120.0 * 0.4f64.cos() - 80.0 * 1.5f64.cos() - 300.0;
    close(start.unwrap(), begun, 1e-12, 0.0);
    assert!(
        error
            .to_string()
            .starts_with("the assembly does not close at the nominal dimensions: loop `linkage` along x is off by")
    );
    // A characteristic that does not depend on the loop is still evaluated.
    let unneeded =
        study(&(text.replace("nominal = 100.0", "nominal = 300.0") + "sum = { formula = \"crank + ground\" }\n"));
    let sum = unneeded.problem.only(&["sum"]).unwrap();
    assert_eq!(analyze(&sum, &Method::Rss.into()).unwrap().characteristics[0].nominal, Some(340.0));
}

/// A crank near its dead centre, driven by the slider, causes a warning.
#[test]
fn a_nearly_singular_position_warns() {
    let warned = |x: f64| {
        let text = format!(
            "[dimensions]\nx = {{ nominal = {x}, tolerance = 1e-5 }}\n[unknowns]\ntheta = 0.3\nbeta = -0.1\n[loops]\n\
             crank = [ {{ length = 50, angle = \"theta\" }}, {{ length = 150, angle = \"beta\" }}, {{ length = \"x\", angle = \"pi\" }} ]\n\
             [characteristics]\ntheta = {{}}\n"
        );
        let analysis = analyze(&study(&text).problem, &Method::SecondOrder.into()).unwrap();
        let codes: Vec<&str> = analysis.warnings.iter().map(|warning| warning.code()).collect();
        let message = analysis.warnings.iter().find(|warning| warning.code() == "near-singular").map(|w| w.message());
        (codes.contains(&"near-singular"), message.unwrap_or_default())
    };
    assert!(!warned(170.0).0);
    assert!(!warned(195.0).0);
    let (near, message) = warned(199.9995);
    assert!(near && message.contains("condition number"), "{message}");
}

/// Ten parts on each other are held as firmly as two: a chain has no dead centre, however long it is.
#[test]
fn a_chain_of_parts_is_not_nearly_singular() {
    for parts in [2, 10, 30] {
        let analysis = analyze(&study(&sequence(parts)).problem, &Method::Rss.into()).unwrap();
        let codes: Vec<&str> = analysis.warnings.iter().map(|warning| warning.code()).collect();
        assert!(!codes.contains(&"near-singular"), "{parts} parts: {codes:?}");
    }
}

#[test]
fn a_singular_nominal_position_is_an_error() {
    let text = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[unknowns]\nu = 1\nv = 1\n[equations]\none = \"u + v - 2*a\"\n\
                two = \"2*u + 2*v - 4*a\"\n[characteristics]\nu = {}\n";
    let MethodError::Model { error } = analyze(&study(text).problem, &Method::Rss.into()).unwrap_err() else {
        panic!()
    };
    assert!(
        error.to_string().starts_with("the assembly is singular at the nominal dimensions: nothing holds `"),
        "{error}"
    );
}

/// Text of parts in sequence, each on the frame of the one before, with four dimensions of the frame and two of the place on it.
fn sequence(parts: usize) -> String {
    let mut text = "[dimensions]\n".to_owned();
    for i in 0..parts {
        for (name, nominal, tolerance) in
            [("x", 20.0, 0.1), ("y", 5.0, 0.1), ("z", 30.0, 0.1), ("a", 8.0, 0.5), ("u", 1.0, 0.1), ("v", -2.0, 0.1)]
        {
            let nominal = nominal + 0.3 * i as f64;
            text += &format!("{name}{i} = {{ nominal = {nominal:?}, tolerance = {tolerance} }}\n");
        }
    }
    for i in 0..parts {
        let about = ["x", "y"][i % 2];
        text += &format!("[parts.p{i}]\nbase = {{ frame = [\"u{i}\", \"v{i}\", 0], z = \"z\", x = \"x\" }}\n");
        text += &format!(
            "end = {{ frame = [\"x{i}\", \"y{i}\", \"z{i}\"], z = {{ turned = \"a{i}*deg\", about = \"{about}\", from = \"z\" }}, x = \"{about}\" }}\n\
             tip = {{ point = [\"x{i}\", \"y{i}\", \"z{i}\"] }}\n"
        );
    }
    text += "[joints]\n";
    (1..parts).for_each(|i| text += &format!("j{i} = {{ rigid = [\"p{}.end\", \"p{i}.base\"] }}\n", i - 1));
    text += &format!("[characteristics]\nh = {{ of = \"p{}.tip\", from = \"p0.base\", along = \"z\" }}\n", parts - 1);
    text
}

/// Mixed derivatives of many pairs come from multipliers, those of few pairs from numbers that carry their derivatives. The two have no
/// step in common. Rounding of the sums is 1e-13 of the greatest derivative.
#[test]
fn many_mixed_derivatives_are_those_of_each_pair() {
    let problem = study(&sequence(4)).problem;
    let count = problem.dimensions().len();
    let pairs: Vec<(usize, usize)> = (0..count).flat_map(|j| (j + 1..count).map(move |k| (j, k))).collect();
    for x in [centre(&problem), random_points(&problem, 1).remove(0)] {
        let together = exact(&problem, &x, &pairs).mixed;
        let alone: Vec<Option<f64>> = pairs.chunks(50).flat_map(|pairs| exact(&problem, &x, pairs).mixed).collect();
        let size = alone.iter().map(|value| value.unwrap().abs()).fold(0.0, f64::max);
        for (pair, (together, alone)) in pairs.iter().zip(together.into_iter().zip(alone)) {
            let (found, expected) = (together.unwrap(), alone.unwrap());
            assert!((found - expected).abs() <= 1e-12 * size, "{pair:?}: {found} for {expected}");
        }
    }
}

/// An unknown itself is an output, and a kink leaves the derivatives to each pair: only the pairs of the kink have none.
#[test]
fn many_mixed_derivatives_of_an_unknown_and_beside_a_kink() {
    let names: Vec<String> = (1..=12).map(|i| format!("a{i}")).collect();
    let dimensions: String =
        names.iter().map(|name| format!("{name} = {{ nominal = 1, tolerance = 0.1 }}\n")).collect();
    let squares = names.windows(2).map(|pair| format!("{}*{}^2", pair[0], pair[1])).collect::<Vec<_>>().join(" + ");
    let pairs: Vec<(usize, usize)> = (0..12).flat_map(|j| (j + 1..12).map(move |k| (j, k))).collect();
    let of = |equation: &str| {
        let text = format!(
            "[dimensions]\n{dimensions}[unknowns]\nu = 3.3\n[equations]\none = \"{equation}\"\n[characteristics]\nu = {{}}\n"
        );
        let problem = study(&text).problem;
        exact(&problem, &centre(&problem), &pairs).mixed
    };
    // u = sqrt(s) with s = 11, s_j = 3 inside, 1 for the first and 2 for the last, and s_jk = 2 for neighbours.
    let root = 11.0f64.sqrt();
    let slope = |j: usize| match j {
        0 => 1.0,
        11 => 2.0,
        _ => 3.0,
    };
    for (&(j, k), found) in pairs.iter().zip(of(&format!("u^2 - ({squares})"))) {
        let mixed = if k == j + 1 { 2.0 } else { 0.0 };
        let expected = mixed / (2.0 * root) - slope(j) * slope(k) / (4.0 * root * root * root);
        close(found.unwrap(), expected, 1e-13, 1.0);
    }
    for (&(j, k), found) in pairs.iter().zip(of(&format!("u - ({squares}) - abs(a1 - 1)"))) {
        let expected = (j > 0).then_some(if k == j + 1 { 2.0 } else { 0.0 });
        assert_eq!(found, expected, "{j}, {k}");
    }
}

/// Conditions depend on the output of a model, which takes one more evaluation for the nominal state.
#[test]
fn conditions_use_outputs_of_a_model() {
    let text = "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nL = { tolerance = 0.0001 }\n[unknowns]\nu = 100\n[equations]\n\
                root = \"u^2 - F\"\n[characteristics]\nu = {}\nF = {}\n";
    let problem = study(text).problem;
    let analysis = analyze(&problem, &Method::SecondOrder.into()).unwrap();
    assert_eq!(analysis.run.evaluations, 4);
    let [u, f] = [0, 1].map(|c| analysis.characteristics[c].nominal.unwrap());
    close(u, f.sqrt(), 1e-14, 0.0);
    assert!(!analysis.characteristics[0].sensitivities[0].exact);
    let refused = analyze(&problem, &Options::from(Method::Rss).with_derivatives(DerivativeSource::Exact));
    assert!(matches!(refused, Err(MethodError::DerivativesUnknown { characteristic }) if characteristic == "u"));
}

fn with(method: Method, derivatives: DerivativeSource) -> Options {
    Options::from(method).with_derivatives(derivatives)
}

/// All derivatives of a quadratic exist: exact ones by one evaluation agree with a full stencil.
#[test]
fn a_quadratic_by_exact_derivatives_and_by_differences() {
    let text = "[dimensions]\nx = { nominal = 2, tolerance = 0.3 }\ny = { nominal = 1, tolerance = [0, 0.6] }\nz = { nominal = -1, tolerance = 0.3 }\n\
                [characteristics]\nq = { formula = \"x*y + x^2 - 3*y*z + z\" }\n";
    let problem = study(text).problem;
    for (method, exact, differences) in
        [(Method::Full, 2, 14), (Method::SixN, 2, 20), (Method::SecondOrder, 2, 8), (Method::Classic, 2, 20)]
    {
        let by = |source| analyze(&problem, &with(method, source)).unwrap();
        let (one, other) = (by(DerivativeSource::Exact), by(DerivativeSource::Difference));
        assert_eq!((one.run.evaluations, other.run.evaluations), (exact, differences), "{method:?}");
        let (one, other) = (&one.characteristics[0], &other.characteristics[0]);
        let figures = |m: sensitol::Moments| [m.mean(), m.sigma(), m.skewness().unwrap(), m.kurtosis().unwrap()];
        for (a, b) in figures(one.moments.unwrap()).into_iter().zip(figures(other.moments.unwrap())) {
            close(a, b, 1e-12, 1.0);
        }
        for (a, b) in one.sensitivities.iter().zip(&other.sensitivities) {
            assert!(a.exact && !b.exact);
            close(a.first.unwrap(), b.first.unwrap(), 1e-11, 1.0);
            close(a.second.unwrap(), b.second.unwrap(), 1e-9, 1.0);
            close(a.linear_share.unwrap(), b.linear_share.unwrap(), 1e-11, 1.0);
        }
        for a in one.contributions.interactions.iter() {
            let b = other.contributions.interactions.iter().find(|b| b.dimensions == a.dimensions).unwrap();
            assert!(a.exact && !b.exact);
            close(a.mixed.unwrap(), b.mixed.unwrap(), 1e-9, 1.0);
        }
    }
}

/// Sensitivities are exact by default, and moments come from differences. A difference replaces a sensitivity that does not exist.
#[test]
fn a_kink_has_a_difference_for_a_sensitivity() {
    let text = "[dimensions]\nx = { nominal = 1, tolerance = 0.3 }\ny = { nominal = 2, tolerance = 0.3 }\nz = { nominal = 1 }\n\
                [characteristics]\nq = { formula = \"abs(x - 1) + exp(y) + z\" }\n";
    let problem = study(text).problem;
    let analysis = analyze(&problem, &Method::SecondOrder.into()).unwrap();
    assert_eq!(analysis.run.evaluations, 5);
    let [x, y, z] = &analysis.characteristics[0].sensitivities[..] else { panic!("three dimensions") };
    assert!(!x.exact && x.first == Some(0.0) && x.second.unwrap() > 1.0);
    assert!(y.exact && y.first == Some(2.0f64.exp()) && y.second == Some(2.0f64.exp()));
    assert!(!z.exact && z.first.is_none());
    let differences = analyze(&problem, &with(Method::SecondOrder, DerivativeSource::Difference)).unwrap();
    assert_eq!(analysis.characteristics[0].moments, differences.characteristics[0].moments);
    let slope = differences.characteristics[0].sensitivities[1].first.unwrap();
    assert!((slope - 2.0f64.exp()).abs() > 1e-3, "matched nodes are wide");

    let refused = analyze(&problem, &with(Method::SecondOrder, DerivativeSource::Exact)).unwrap_err();
    assert_eq!(refused, MethodError::NoDerivative { characteristic: "q".into(), dimensions: vec!["x".into()] });
    let stepped = with(Method::SecondOrder, DerivativeSource::Exact).with_step(1.0);
    assert_eq!(analyze(&problem, &stepped).unwrap_err(), MethodError::NoDifferences { option: "step" });
    let all = Options::from(Method::SecondOrder).with_all_sensitivities(true);
    let analysis = analyze(&problem, &all).unwrap();
    assert!(analysis.characteristics[0].sensitivities[2].exact);
}

fn fault(text: &str) -> String {
    let error = Study::from_toml(text, "study.toml").err().unwrap_or_else(|| panic!("valid: {text}"));
    let place = error.line_column().map_or("-".to_owned(), |(line, column)| format!("{line}:{column}"));
    let spanned = error.span.clone().map_or("", |span| &error.text[span]).lines().next().unwrap_or("").to_owned();
    let help = error.help().map_or(String::new(), |help| format!("\n  help: {help}"));
    format!("{place} [{spanned}] {}: {}{help}", error.key, error.fault)
}

#[test]
fn conditions_at_fault() {
    let texts = [
        "[unknowns]\nu = 1\n[equations]\none = \"u - a\"\ntwo = \"u - 2*a\"\n",
        "[unknowns]\nu = 1\nv = 2\nw = 3\n[loops]\nL1 = [ { length = \"u\", angle = \"v\" }, { length = \"a\", angle = 0 } ]\n",
        "[unknowns]\nu = 1\n",
        "[equations]\none = \"a - 1\"\n",
        "[unknowns]\nu = 1\nv = 2\n[loops]\nL1 = []\n",
        "[unknowns]\nu = 1\nv = 2\n[loops]\nL1 = [ { length = \"u\", angle = \"vv\" }, { length = \"a\", angle = 0 } ]\n",
        "[unknowns]\nu = 1\nv = 2\n[loops]\nL1 = [ { length = \"u\", angle = \"v +\" }, { length = \"a\", angle = 0 } ]\n",
        "[unknowns]\nu = 1\nv = 2\n[loops]\nL1 = [ { length = \"u\", angel = \"v\" } ]\n",
        "[unknowns]\nu = 1\nv = 2\n[loops]\nL1 = [ { length = true, angle = \"v\" } ]\n",
        "[unknowns]\nu = { start = 5, lower = 0, upper = 3 }\n[equations]\none = \"u - a\"\n",
        "[unknowns]\nu = { start = 1, lower = 1, upper = 1 }\n[equations]\none = \"u - a\"\n",
        "[unknowns]\nu = { lower = 1 }\n[equations]\none = \"u - a\"\n",
        "[unknowns]\nu = { start = 1, uper = 2 }\n[equations]\none = \"u - a\"\n",
        "[unknowns]\nu = \"one\"\n[equations]\none = \"u - a\"\n",
        "[unknowns]\nu = nan\n[equations]\none = \"u - a\"\n",
        "[unknowns]\na = 1\n[equations]\none = \"a\"\n",
        "[unknowns]\npi = 1\n[equations]\none = \"a\"\n",
        "[unknowns]\nu = 1\nv = 1\n[equations]\none = \"u - a\"\ntwo = \"u^2 - a\"\n",
        "[unknowns]\nu = 1\nv = 1\n[equations]\none = \"u - v\"\ntwo = \"a - 1\"\n",
        "[unknowns]\nu = 1\n[equations]\none = \"u - b\"\n",
        "[unknowns]\nu = 1\n[equations]\none = \"u - one\"\n",
        "[unknowns]\nu = 1\n[equations]\none = \"u - a\"\n[formulas]\nf = \"one\"\n",
        "[analysis]\nderivatives = \"exakt\"\n",
        "[analysis]\nderivatives = \"exact\"\nstep = 1\n",
    ];
    let head = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"a\" }\n";
    let mut faults: Vec<String> = texts.iter().map(|text| fault(&format!("{head}{text}"))).collect();
    let nothing = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[unknowns]\nlength = 1\n[equations]\none = \"length - a\"\n\
                   [characteristics]\nlenght = { upper = 2 }\n";
    faults.push(fault(nothing));
    insta::assert_snapshot!(faults.join("\n"));
}
