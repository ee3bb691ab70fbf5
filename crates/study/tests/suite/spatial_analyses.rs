//! A study in space through every analysis, beside the closed form of the crank slider: both are the same function, and the second one is
//! known to none of the code for space.

use sensitol::allocation::{AllocationOptions, allocate};
use sensitol::compare::{CompareOptions, Contender, compare};
use sensitol::method::ALL;
use sensitol::rare::{RareOptions, rare};
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::sweep::sweep;
use sensitol::{DerivativeSource, Method, Options, analyze};
use sensitol_study::{Externals, Study, StudyText};
use sensitol_testing::{close, parse, read, relative};

/// Text of the study in space and of its closed form, with more lines for both.
fn texts(more: &str) -> [String; 2] {
    ["study", "closed-form"].map(|name| {
        let text = read(&format!("examples/crank-slider-space/{name}.toml"));
        format!("{}\n{more}", text.replace("upper = 71.4", "upper = 71.15, target_yield = 0.9973"))
    })
}

fn studies(more: &str) -> [Study; 2] {
    texts(more).map(|text| parse(&text).unwrap())
}

/// Relative difference of two figures of the same function. The states of the assembly are exact to some 1e-13 of its size, which is 1e-10
/// of sigma here, and differences of second order lose three digits of it.
const SAME: f64 = 1e-6;

#[test]
fn every_method_gives_the_moments_of_the_closed_form() {
    let [space, formula] = studies("");
    for procedure in ALL {
        let method = procedure.method();
        let options = Options::from(method);
        let [a, b] =
            [&space, &formula].map(|study| analyze(&study.problem, &options).unwrap().characteristics.remove(0));
        let (of_space, of_formula) = (a.moments.unwrap(), b.moments.unwrap());
        let sigma = of_formula.sigma();
        // Methods that sample or stop at an accuracy may take other points. Their own errors hold then.
        let error = |one: &sensitol::CharacteristicAnalysis| {
            let estimate = one.error_estimate.as_ref();
            estimate.and_then(|estimate| estimate.sigma).unwrap_or(0.0)
        };
        let allowed = match method {
            Method::Auto => error(&a) + error(&b) + SAME * sigma,
            _ => SAME * sigma,
        };
        let name = procedure.name();
        assert!((of_space.sigma() - sigma).abs() <= allowed, "{name}: {} and {sigma}", of_space.sigma());
        assert!(
            (of_space.mean() - of_formula.mean()).abs() <= allowed,
            "{name}: {} and {}",
            of_space.mean(),
            of_formula.mean()
        );
        for (row, other) in a.sensitivities.iter().zip(&b.sensitivities) {
            // Slopes are exact where the method takes derivatives, and integrals or fits of one surface elsewhere.
            close(row.first.unwrap(), other.first.unwrap(), 1e-5, 1.0);
        }
    }
}

/// Linear moments take one evaluation where derivatives are exact.
#[test]
fn rss_takes_one_evaluation() {
    let [space, formula] = studies("");
    let mut options = Options::from(Method::Rss);
    options.derivatives = Some(DerivativeSource::Exact);
    let [a, b] = [&space, &formula].map(|study| analyze(&study.problem, &options).unwrap());
    assert_eq!(a.run.evaluations, 1);
    let sigma = |found: &sensitol::Analysis| found.characteristics[0].moments.unwrap().sigma();
    relative(sigma(&a), sigma(&b), 1e-10);
}

#[test]
fn a_simulation_is_that_of_the_closed_form() {
    let [space, formula] = studies("");
    let options = SimulationOptions::default().with_samples(20_000).with_seed(7);
    let [a, b] = [&space, &formula].map(|study| simulate(&study.problem, &options).unwrap());
    let (a, b) = (&a.characteristics[0], &b.characteristics[0]);
    // The same points, at which both functions have the same values but for rounding.
    relative(a.mean.unwrap().value, b.mean.unwrap().value, 1e-12);
    relative(a.sigma.unwrap().value, b.sigma.unwrap().value, 1e-9);
    assert_eq!((a.failed, b.failed), (0, 0));
    relative(a.yield_.unwrap().value, b.yield_.unwrap().value, 1e-12);
}

#[test]
fn rare_rejects_are_those_of_the_closed_form() {
    let [space, formula] = studies("");
    let options = RareOptions::default().with_samples(4000);
    let [a, b] = [&space, &formula].map(|study| rare(&study.problem, &options).unwrap().characteristics.remove(0));
    for (space, formula) in [(a.below, b.below), (a.above, b.above)] {
        let (space, formula) = (space.unwrap(), formula.unwrap());
        // Both estimates have their standard error. The points depend on the surrogate, whose digits differ in the last places.
        let error = space.standard_error.unwrap().hypot(formula.standard_error.unwrap());
        let (space, formula) = (space.probability.unwrap(), formula.probability.unwrap());
        assert!((space - formula).abs() <= 3.0 * error, "{space:?} and {formula:?}");
        assert!(space > 0.0);
    }
}

#[test]
fn allocated_tolerances_are_those_of_the_closed_form() {
    let costs = "[costs]\nr = { model = \"reciprocal\", b = 0.1, min = 0.005, max = 0.5 }\nL = { model = \"reciprocal\", b = 0.2, min = 0.005, max = 0.5 }\nth = { model = \"reciprocal\", b = 0.5, min = 0.05, max = 2 }\n";
    let [space, formula] = studies(costs);
    let options = AllocationOptions::default();
    let [a, b] = [&space, &formula].map(|study| allocate(&study.problem, &study.allocation_task(), &options).unwrap());
    // The search ends at a relative change of the cost of 1e-6 or less, where tolerances may still move by its root.
    relative(a.cost_after.unwrap(), b.cost_after.unwrap(), 1e-4);
    for (space, formula) in a.tolerances.iter().zip(&b.tolerances) {
        relative(space.after, formula.after, 1e-2);
        assert!(space.after != space.before);
    }
}

#[test]
fn a_sweep_over_the_driven_angle_is_that_of_the_closed_form() {
    let [space, formula] = studies("");
    let angles = [5.0, 35.0, 80.0, 130.0];
    let [a, b] = [&space, &formula].map(|study| sweep(&study.problem, "th", &angles, &Method::Full.into()).unwrap());
    for (a, b) in a.analyses.iter().zip(&b.analyses) {
        let [a, b] = [a, b].map(|one| one.as_ref().unwrap().characteristics[0].moments.unwrap());
        relative(a.mean(), b.mean(), 1e-10);
        relative(a.sigma(), b.sigma(), SAME);
    }
}

#[test]
fn a_comparison_runs_every_method() {
    let [space, formula] = studies("");
    let options = CompareOptions::default().with_reference(1 << 14);
    let [a, b] = [&space, &formula].map(|study| compare(&study.problem, &options).unwrap());
    let mean = |found: &sensitol::compare::Comparison| found.reference.characteristics[0].mean.unwrap().value;
    relative(mean(&a), mean(&b), 1e-12);
    let methods = |found: &sensitol::compare::Comparison| {
        let names = found.ran.iter().filter(|ran| matches!(ran.contender, Contender::Method(_)));
        let mut names: Vec<String> = names.map(|ran| ran.contender.name()).collect();
        names.sort();
        names
    };
    assert_eq!(methods(&a), methods(&b));
    assert!(methods(&a).len() >= 8, "{:?}", methods(&a));
}

/// The extremes of an assembly come from a search, those of a formula are proven.
#[test]
fn searched_extremes_are_the_proven_ones() {
    let [space, formula] = studies("");
    let options = Options::from(Method::SecondOrder).with_extremes(true);
    let [a, b] = [&space, &formula].map(|study| {
        let one = analyze(&study.problem, &options).unwrap().characteristics.remove(0);
        one.range.extremes.unwrap()
    });
    assert!(b.proven() && !a.proven());
    relative(a.least.value, b.least.value, 1e-10);
    relative(a.greatest.value, b.greatest.value, 1e-10);
}

/// Units that are converted change no figure.
#[test]
fn converted_units_give_the_same_analysis() {
    let [text, _] = texts("");
    let plain = parse(&text).unwrap();
    let converted = parse(&format!("units = \"convert\"\n{text}")).unwrap();
    let [a, b] = [&plain, &converted]
        .map(|study| analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0));
    relative(a.moments.unwrap().mean(), b.moments.unwrap().mean(), 1e-12);
    relative(a.moments.unwrap().sigma(), b.moments.unwrap().sigma(), SAME);
    // Poses are in the unit of the study.
    for (a, b) in plain.poses.iter().zip(&converted.poses) {
        for i in 0..3 {
            close(b.translation[i], a.translation[i], 1e-11, 60.0);
            close(b.rotation[i], a.rotation[i], 1e-11, 1.0);
        }
    }
    assert_eq!(converted.length_unit.as_deref(), Some("mm"));
}

/// A configuration closes the joints at its own sizes.
#[test]
fn configurations_have_their_own_state() {
    let more = "[configurations]\nlong = { L = 75, th = 50 }\n";
    for text in texts(more) {
        let externals = Externals::default().with_configuration("long");
        let study = Study::from_text(StudyText::toml("study.toml", &text).with_externals(externals)).unwrap();
        let found = analyze(&study.problem, &Method::Rss.into()).unwrap();
        // x by hand: r cos th + sqrt(L^2 - (r sin th - e)^2 - (h - k)^2) with L = 75 and th = 50 degrees.
        let th = 50f64.to_radians();
        let x = 15.0 * th.cos() + (75f64.powi(2) - (15.0 * th.sin() - 5.0).powi(2) - 144.0).sqrt();
        relative(found.characteristics[0].moments.unwrap().mean(), x, 1e-10);
    }
}

/// Neither the order of features nor that of parts has an effect.
#[test]
fn the_order_of_features_changes_nothing() {
    let text = read("examples/crank-slider-space/study.toml");
    let moments = |text: &str| {
        let study = parse(text).unwrap();
        let found = analyze(&study.problem, &Method::Full.into()).unwrap();
        found.characteristics[0].moments.unwrap()
    };
    // Blocks of parts in reverse order, and the lines within each block too; the ground is named, since the first part stands still otherwise.
    let (head, rest) = text.split_at(text.find("[parts.").unwrap());
    let (parts, tail) = rest.split_at(rest.find("[joints]").unwrap());
    let mut blocks: Vec<String> = parts
        .split("[parts.")
        .filter(|block| !block.trim().is_empty())
        .map(|block| {
            let (name, lines) = block.split_once('\n').unwrap();
            let mut lines: Vec<&str> = lines.lines().filter(|line| !line.is_empty()).collect();
            lines.reverse();
            let ground = if name == "base]" { "ground = true\n" } else { "" };
            format!("[parts.{name}\n{ground}{}\n\n", lines.join("\n"))
        })
        .collect();
    blocks.reverse();
    let turned = format!("{head}{}{tail}", blocks.concat());
    assert_ne!(turned, text);
    let (a, b) = (moments(&text), moments(&turned));
    relative(a.mean(), b.mean(), 1e-13);
    relative(a.sigma(), b.sigma(), 1e-9);
}

/// A profile has the deviations of its points, with converted units too.
#[test]
fn a_profile_is_the_greatest_deviation() {
    let text = r#"
[dimensions]
z1 = { nominal = 5, tolerance = 0.1, unit = "mm" }
z2 = { nominal = 5, tolerance = 0.1, unit = "mm" }
z3 = { nominal = 5, tolerance = 0.1, unit = "mm" }
[parts.base]
p1 = { point = [0, 0, "z1"] }
p2 = { point = [100, 0, "z2"] }
p3 = { point = [0, 100, "z3"] }
table = { plane = [0, 0, 0], normal = "z" }
[parts.plate]
at = [0, 0, 5]
bottom = { plane = [0, 0, 0], normal = "-z" }
lid = { plane = [0, 0, 8], normal = "z", x = "x" }
[joints]
a = { on = "plate.bottom", against = "base.p1" }
b = { on = "plate.bottom", against = "base.p2" }
c = { on = "plate.bottom", against = "base.p3" }
[characteristics]
flat = { profile = { of = "plate.lid", at = [[0, 0], [100, 0], [50, 50]] }, from = "base.table", unit = "mm" }
"#;
    for units in ["", "units = \"convert\"\n"] {
        let study = parse(&format!("{units}{text}")).unwrap();
        let value = |z: [f64; 3]| {
            let points = sensitol::assembly::Points::from_rows(&[z]);
            let mut found = sensitol::assembly::Responses::open(1, 1);
            let request = sensitol::assembly::Request::values(&points, &[0]);
            study.problem.function().evaluate(&request, &sensitol::assembly::Run::to_the_end(), &mut found);
            found.value(0, 0).unwrap()
        };
        // Pads raise the corners by 0.05, -0.2 and 0.1: the plane has -0.05 at (50, 50). A tilt of 3e-3 is of the second order in heights.
        close(value([5.05, 4.8, 5.1]), 0.2, 1e-3, 1.0);
        close(value([5.3, 5.3, 5.3]), 0.3, 1e-9, 1.0);
        assert!(value([5.0; 3]).abs() < 1e-12);
    }
}
