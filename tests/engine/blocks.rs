//! Blocks: dimensions with one joint distribution, by rows of measured parts or within a zone.

use std::f64::consts::PI;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::{Analysis, Method, analyze};
use sensitol_study::StudyText;
use sensitol_study::{Study, StudyError};
use sensitol_testing::{case, close, faults, relative};

fn read(text: &str, files: &[(&str, &str)]) -> Result<Study, StudyError> {
    let study = StudyText::toml("study.toml", text);
    Study::from_text(files.iter().fold(study, |study, (name, content)| study.with_file(*name, *content)))
}

fn study(text: &str, files: &[(&str, &str)]) -> Study {
    read(text, files).unwrap_or_else(|error| panic!("{error}"))
}

fn analysed(text: &str, files: &[(&str, &str)]) -> Analysis {
    analyze(&study(text, files).problem, &Method::Full.into()).unwrap()
}

/// Returns mean, sigma, skewness and kurtosis of the first characteristic.
fn moments(text: &str, files: &[(&str, &str)]) -> [f64; 4] {
    let moments = analysed(text, files).characteristics[0].moments.unwrap();
    [moments.mean(), moments.sigma(), moments.skewness().unwrap(), moments.kurtosis().unwrap()]
}

/// Returns mean, sigma, skewness and kurtosis of values with weights.
fn of_values(values: &[(f64, f64)]) -> [f64; 4] {
    let over = |f: &dyn Fn(f64) -> f64| values.iter().map(|&(weight, y)| weight * f(y)).sum::<f64>();
    let mean = over(&|y| y);
    let central = |power: i32| over(&|y| (y - mean).powi(power));
    let sigma = central(2).sqrt();
    [mean, sigma, central(3) / sigma.powi(3), central(4) / sigma.powi(4)]
}

fn same(found: [f64; 4], expected: [f64; 4], tolerance: f64) {
    for (found, expected) in found.into_iter().zip(expected) {
        close(found, expected, tolerance, 1.0);
    }
}

const ZONE: &str =
    "x = { nominal = 0, tolerance = 0.2 }\ny = { nominal = 0, tolerance = 0.2 }\n[[joint]]\nof = [\"x\", \"y\"]\n";

fn zone(law: &str, formula: &str, more: &str) -> String {
    format!("[dimensions]\n{more}{ZONE}law = \"{law}\"\n[characteristics]\nz = {{ formula = \"{formula}\" }}\n")
}

/// Returns `E[x^a y^b]` of a rotationally symmetric distribution, with `radial` the mean of `r^(a + b)`. The factor is the mean of `cos^a
/// sin^b`, a product of odd numbers for even powers.
fn turned(a: u32, b: u32, radial: f64) -> f64 {
    let odd = |n: u32| (1..n).step_by(2).map(f64::from).product::<f64>();
    let even = |n: u32| (2..=n).step_by(2).map(f64::from).product::<f64>();
    radial * odd(a) * odd(b) / even(a + b)
}

/// A line through a disc varies as one input of slope hypot(a, b), whose kurtosis is 2; two independent coordinates of the same
/// distribution would have 2.5.
#[test]
fn a_line_through_a_disc() {
    let case = case("disc-linear");
    let (a, b, radius) = (3.0, 4.0, 0.2);
    let [mean, sigma, skewness, kurtosis] = moments(&zone("disc", "3*x + 4*y", ""), &[]);
    // The tolerance covers roundings of numbers of 36.
    close(mean, 0.0, 1e-15, 1.0);
    relative(sigma, f64::hypot(a, b) * radius / 2.0, 1e-12);
    close(skewness, 0.0, 1e-12, 1.0);
    relative(kurtosis, case["exact"]["kurtosis"].as_f64().unwrap(), 1e-12);
    let product = case["exact"]["E x^2y^2 / R^4"].as_f64().unwrap();
    let [_, sigma, _, kurtosis] = moments(&zone("disc", "x*y", ""), &[]);
    relative(sigma, (product * radius.powi(4)).sqrt(), 1e-12);
    // E r^k = 2/(k + 2).
    relative(kurtosis, turned(4, 4, 0.2) / turned(2, 2, 1.0 / 3.0).powi(2), 1e-12);
}

/// Moments of a rim, and of a diamond: offset and tilt that share a zone.
#[test]
fn rim_and_diamond() {
    let [_, sigma, _, kurtosis] = moments(&zone("rim", "3*x + 4*y", ""), &[]);
    relative(sigma, 0.2 * 5.0 / 2f64.sqrt(), 1e-12);
    relative(kurtosis, 1.5, 1e-12);
    let [_, sigma, _, kurtosis] = moments(&zone("rim", "x^2 - 2*y^2", ""), &[]);
    // x^2 - 2 y^2 = -1/2 + 3/2 cos 2 phi.
    relative(sigma, 0.04 * 1.5 / 2f64.sqrt(), 1e-12);
    relative(kurtosis, 1.5, 1e-11);
    let shared = case("shared-zone");
    let exact = |key: &str, index: usize| shared["exact"][key].as_array().unwrap()[index].as_f64().unwrap();
    let text = |formula: &str| {
        format!(
            "[dimensions]\nd = {{ nominal = 0, tolerance = 0.2 }}\nt = {{ nominal = 0, tolerance = {:.17} }}\n[[joint]]\nof = [\"d\", \"t\"]\n\
             law = \"diamond\"\n[characteristics]\nz = {{ formula = \"{formula}\" }}\n",
            0.4 / 60.0
        )
    };
    relative(moments(&text("d"), &[])[1].powi(2), exact("variances", 0), 1e-12);
    relative(moments(&text("t"), &[])[1].powi(2), exact("variances", 1), 1e-12);
    let product = shared["exact"]["E offset^2 tilt^2"].as_f64().unwrap();
    relative(moments(&text("d*t"), &[])[1].powi(2), product, 1e-11);
    // The greatest offset is 30 beside the middle: no point has both extremes at once.
    let worst = analysed(&text("d + 30*t"), &[]).characteristics[0].range.worst_case.unwrap();
    relative(worst[1], shared["exact"]["greatest offset 30 from the middle"].as_f64().unwrap(), 1e-12);
}

/// A float in a random direction: E cos^2 = 1/2.
#[test]
fn a_float_in_a_random_direction() {
    let case = case("random-direction-float");
    let text = "[dimensions]\nedge = { nominal = 10, tolerance = 0.1 }\nfloat = { nominal = 0, tolerance = 0.08, distribution = \"uniform\" }\n\
                dx = { nominal = 0, tolerance = 1 }\ndy = { nominal = 0, tolerance = 1 }\n[[joint]]\nof = [\"dx\", \"dy\"]\nlaw = \"rim\"\n\
                [characteristics]\ny = { formula = \"edge + float*dx\" }\n";
    let analysis = analysed(text, &[]);
    let found = &analysis.characteristics[0];
    relative(found.moments.unwrap().sigma(), case["exact"]["sigma"].as_f64().unwrap(), 1e-12);
    let edge = found.sensitivities.iter().find(|one| one.dimension == "edge").unwrap();
    relative(
        edge.linear_share.unwrap() + edge.curvature_share.unwrap(),
        case["exact"]["share of edge"].as_f64().unwrap(),
        1e-12,
    );
}

/// Three columns of 40 rows, of which two are strongly correlated.
fn lot() -> (String, Vec<[f64; 3]>) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut rows = Vec::new();
    for _ in 0..40 {
        let [common, own, third]: [f64; 3] = [random.random(), random.random(), random.random()];
        rows.push([10.0 + common * common, 9.5 + common + 0.2 * own, 3.0 + third - common]);
    }
    let text = rows.iter().fold("a,b,c\n".to_owned(), |text, [a, b, c]| text + &format!("{a},{b},{c}\n"));
    (text, rows)
}

const ROWS: &str = "a = { measured = \"lot.csv\", column = \"a\" }\nb = { measured = \"lot.csv\", column = \"b\" }\n";

/// A surface over rows alone has the moments of its values at the rows. Beside a uniform input a Gauss rule averages those of the rows, and
/// integrates the fourth power of a cubic exactly.
#[test]
fn moments_of_rows_are_exact() {
    let (csv, rows) = lot();
    let files = [("lot.csv", csv.as_str())];
    let weight = 1.0 / rows.len() as f64;
    let alone = format!("[dimensions]\n{ROWS}[characteristics]\ny = {{ formula = \"a*b - 3*a^2\" }}\n");
    let values: Vec<(f64, f64)> = rows.iter().map(|[a, b, _]| (weight, a * b - 3.0 * a * a)).collect();
    // The surface has second derivatives of exact first ones: the roundings are those of squares near 300 beside a sigma of 12.
    same(moments(&alone, &files), of_values(&values), 1e-8);
    let beside = format!(
        "[dimensions]\n{ROWS}u = {{ nominal = 2, tolerance = 0.5, distribution = \"uniform\" }}\n[characteristics]\ny = {{ formula = \"a*u - b*u + a - b\" }}\n"
    );
    // Five nodes of Gauss-Legendre quadrature.
    let node = |inner: f64| (5.0 + inner * 2.0 * (10f64 / 7.0).sqrt()).sqrt() / 3.0;
    let share = |inner: f64| (322.0 + inner * 13.0 * 70f64.sqrt()) / 1800.0;
    let rule = [(0.0, 64.0 / 225.0), (node(-1.0), share(1.0)), (node(1.0), share(-1.0))];
    let mut values = Vec::new();
    for [a, b, _] in &rows {
        for (place, share) in rule {
            for (side, part) in [(1.0, 0.5), (-1.0, 0.5)] {
                let u = 2.0 + 0.5 * side * place;
                values
                    .push((2.0 * weight * share * part * if place == 0.0 { 0.5 } else { 1.0 }, a * u - b * u + a - b));
            }
        }
    }
    let total: f64 = values.iter().map(|(weight, _)| weight).sum();
    values.iter_mut().for_each(|(weight, _)| *weight /= total);
    same(moments(&beside, &files), of_values(&values), 1e-8);
}

/// Shares are covariances with the sum and add up to 1. The reported correlation is that of the rows.
#[test]
fn shares_of_rows_sum_to_one() {
    let (csv, rows) = lot();
    let files = [("lot.csv", csv.as_str())];
    let text = format!(
        "[dimensions]\n{ROWS}c = {{ measured = \"lot.csv\", column = \"c\" }}\nn = {{ nominal = 1, tolerance = 0.3 }}\n[characteristics]\ny = {{ formula = \"a*n - b*c + n^2\" }}\n"
    );
    let study = study(&text, &files);
    let analysis = analyze(&study.problem, &Method::Full.into()).unwrap();
    let found = &analysis.characteristics[0];
    let own: f64 = found.sensitivities.iter().map(|one| one.linear_share.unwrap() + one.curvature_share.unwrap()).sum();
    let pairs: f64 = found.contributions.interactions.iter().map(|one| one.share.unwrap()).sum();
    close(own + pairs, 1.0, 1e-9, 1.0);
    let column = |index: usize| rows.iter().map(|row| row[index]).collect::<Vec<f64>>();
    let (a, b) = (column(0), column(1));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let covariance = |x: &[f64], y: &[f64]| {
        let (mx, my) = (mean(x), mean(y));
        x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>()
    };
    let expected = covariance(&a, &b) / (covariance(&a, &a) * covariance(&b, &b)).sqrt();
    relative(study.problem.correlation().unwrap().of(0, 1), expected, 1e-12);
}

/// Samples of the model at Sobol' points and at random ones have the exact moments within four of their standard errors.
#[test]
fn samples_follow_the_block() {
    let (csv, _) = lot();
    let files = [("lot.csv", csv.as_str())];
    let noise = "e = { nominal = 5, tolerance = 0.3 }\n";
    let texts = [
        zone("disc", "3*x + 4*y + x*y + e", noise),
        zone("rim", "x - y + 2*x^2 + e", noise),
        zone("diamond", "x + y + x*y", ""),
        format!("[dimensions]\n{ROWS}{noise}[characteristics]\ny = {{ formula = \"a - b + 0.1*e*a\" }}\n"),
    ];
    for text in &texts {
        let exact = moments(text, &files);
        for sampler in [Sampler::Random, Sampler::Sobol] {
            let options = SimulationOptions::default().with_samples(1 << 16).with_sampler(sampler);
            let found = simulate(&study(text, &files).problem, &options).unwrap();
            let found = &found.characteristics[0];
            for (found, exact) in [found.mean, found.sigma, found.skewness, found.kurtosis].into_iter().zip(exact) {
                let found = found.unwrap();
                // Sigma is that of a sample, with n - 1, a difference that Sobol' points resolve.
                let error = found.standard_error.unwrap() + exact.abs() / f64::from(1 << 18);
                assert!((found.value - exact).abs() <= 4.0 * error + 1e-9, "{text}: {found:?} for {exact}");
            }
        }
    }
}

/// The yield of a line through a disc is that of a semicircle's segment.
#[test]
fn the_yield_of_a_line_through_a_disc() {
    let text = zone("disc", "3*x + 4*y", "").replace("4*y\"", "4*y\", upper = 0.8");
    // The limit lies at 0.8 of the greatest value 1.
    let angle = 0.8f64.acos();
    let beyond = (angle - angle.sin() * angle.cos()) / PI;
    let found = &analysed(&text, &[]).characteristics[0];
    let law = found.evidence.surface_law.unwrap();
    let above = law.above.unwrap();
    assert!((above.value - beyond).abs() <= above.error + 1e-12, "{above:?} for {beyond}");
    assert!(above.error < 1e-6, "{above:?}");
}

/// Limits that some rows exceed: the surface distribution counts rows, and so does a sample of the model.
#[test]
fn the_yield_of_rows_is_their_share() {
    let (csv, rows) = lot();
    let text = format!("[dimensions]\n{ROWS}[characteristics]\ny = {{ formula = \"a - b\", upper = 0.3 }}\n");
    let expected = rows.iter().filter(|[a, b, _]| a - b > 0.3).count() as f64 / rows.len() as f64;
    let found = &analysed(&text, &[("lot.csv", &csv)]).characteristics[0];
    let above = found.evidence.surface_law.unwrap().above.unwrap();
    assert!((above.value - expected).abs() <= above.error + 1e-12, "{above:?} for {expected}");
    assert!(expected > 0.0 && expected < 1.0);
}

/// Rows are drawn as a whole: the interval of a difference is that of its own values, by the normal approximation to a tenth or so.
#[test]
fn rows_are_drawn_anew_as_a_whole() {
    let (csv, rows) = lot();
    let text = format!("[dimensions]\n{ROWS}[characteristics]\ny = {{ formula = \"a - b\" }}\n");
    let found = &analysed(&text, &[("lot.csv", &csv)]).characteristics[0];
    let [_, sigma, ..] = of_values(&rows.iter().map(|[a, b, _]| (1.0 / rows.len() as f64, a - b)).collect::<Vec<_>>());
    let interval = found.evidence.sampling.as_ref().unwrap().mean.unwrap();
    let expected = 2.0 * 1.96 * sigma / (rows.len() as f64).sqrt();
    // The ends of a percentile interval of 1000 resamples are accurate to a tenth of its width.
    relative(interval[1] - interval[0], expected, 0.15);
}

/// An evenly distributed position is a disc, as is the block that is written out.
#[test]
fn an_even_position_is_a_disc() {
    let position = "[dimensions]\nh = { nominal = [0, 0], position = 0.4, distribution = \"uniform\" }\n[characteristics]\nz = { formula = \"3*h_x + 4*h_y + h_x*h_y\" }\n";
    let written = zone("disc", "3*x + 4*y + x*y", "");
    assert_eq!(moments(position, &[]), moments(&written, &[]));
    let expanded = read(&written, &[]).unwrap();
    assert_eq!(expanded.problem.dimensions()[0].distribution().unwrap().name(), "beta");
    let worst = analysed(position, &[]).characteristics[0].range.worst_case.unwrap();
    relative(worst[1], 1.0, 1e-12);
}

/// Blocks that share no product are independent, so that their cumulants add. Discs that interact are pooled.
#[test]
fn several_blocks() {
    let two = |law: &str, formula: &str| {
        format!(
            "[dimensions]\np = {{ nominal = 0, tolerance = 1 }}\nq = {{ nominal = 0, tolerance = 1 }}\n{ZONE}law = \"{law}\"\n[[joint]]\nof = [\"p\", \"q\"]\nlaw = \"{law}\"\n[characteristics]\nz = {{ formula = \"{formula}\" }}\n"
        )
    };
    // Fourth cumulants of two discs: -1 each, in units of the variance squared.
    let [_, sigma, _, kurtosis] = moments(&two("disc", "5*x + q"), &[]);
    relative(sigma, (0.25f64 + 0.25).sqrt(), 1e-12);
    relative(kurtosis, 3.0 - 0.5, 1e-12);
    // E (x p)^2 = 0.01/4 = E (y q)^2, E x p y q = 0, and E (x p + y q)^4 = E r^4 E s^4 E cos^4 = 3/8/9 for unit discs.
    let [_, sigma, _, kurtosis] = moments(&two("disc", "x*p + y*q"), &[]);
    relative(sigma, 0.2 * (0.125f64).sqrt(), 1e-12);
    relative(kurtosis, (3.0 / 8.0 / 9.0) / 0.125f64.powi(2), 1e-11);
}

/// Methods that integrate over one input after the other refuse blocks.
#[test]
fn methods_of_single_inputs_refuse_blocks() {
    let problem = study(&zone("disc", "x + y", ""), &[]).problem;
    for method in [Method::DimensionReduction, Method::BivariateDimensionReduction, Method::ThreePoint] {
        let refused = analyze(&problem, &method.into()).unwrap_err().to_string();
        assert!(refused.contains("`x`, `y` vary together as a whole"), "{refused}");
    }
    for method in [Method::Auto, Method::SecondOrder, Method::SixN, Method::ResponseSurface] {
        let sigma = analyze(&problem, &method.into()).unwrap().characteristics[0].moments.unwrap().sigma();
        // Least squares have larger rounding errors than differences.
        relative(sigma, 0.1 * 2f64.sqrt(), 1e-9);
    }
}

#[test]
fn wrong_blocks_are_said() {
    let joint = |more: &str| {
        format!(
            "[dimensions]\nx = {{ nominal = 0, tolerance = 0.2 }}\ny = {{ nominal = 0, tolerance = 0.2 }}\nn = {{ nominal = 0, sigma = 0.2 }}\n\
             t = {{ nominal = 0, tolerance = 0.2, distribution = \"triangular\" }}\n{more}\n[characteristics]\nz = {{ formula = \"x + y + n + t\" }}\n"
        )
    };
    let block = |text: &str| joint(&format!("[[joint]]\n{text}"));
    let texts = [
        block("of = [\"x\", \"yy\"]\nlaw = \"disc\""),
        block("of = [\"x\", \"y\", \"n\"]\nlaw = \"disc\""),
        block("of = [\"x\", \"y\"]\nlaw = \"disk\""),
        block("of = [\"x\", \"y\"]"),
        block("of = [\"x\", \"y\"]\nlaw = \"disc\"\nmeasured = \"lot.csv\""),
        block("of = [\"x\", \"n\"]\nlaw = \"rim\""),
        block("of = [\"x\", \"t\"]\nlaw = \"rim\""),
        block("of = [\"x\"]\nmeasured = \"lot.csv\""),
        block("of = [\"x\", \"y\"]\nlaw = \"disc\"\n[[joint]]\nof = [\"x\", \"t\"]\nlaw = \"diamond\""),
        block("of = [\"x\", \"y\"]\nlaw = \"disc\"\n[[correlation]]\nbetween = [\"x\", \"y\"]\nvalue = 0.5"),
        block("of = [\"x\", \"y\"]\nlaw = \"disc\"\n[[correlation]]\nbetween = [\"x\", \"n\"]\nvalue = 0.5"),
        block("of = \"x\"\nlaw = \"disc\""),
        joint("[joint]\nof = [\"x\", \"y\"]\nlaw = \"disc\""),
        "[dimensions]\nh = { nominal = [0, 0], position = 0.4, distribution = \"triangular\" }\n[characteristics]\nz = { formula = \"h_x + h_y\" }\n".to_owned(),
        "[dimensions]\nh = { nominal = [0, 0], position = 0.4, distribution = \"uniform\", sigma = 0.1 }\n[characteristics]\nz = { formula = \"h_x + h_y\" }\n".to_owned(),
    ];
    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    insta::assert_snapshot!(faults(&texts));
    let other = "[dimensions]\na = { measured = \"a.csv\" }\nb = { nominal = 1 }\n[[joint]]\nof = [\"a\", \"b\"]\nmeasured = \"lot.csv\"\n[characteristics]\ny = { formula = \"a + b\" }\n";
    let (csv, _) = lot();
    let found = read(other, &[("lot.csv", &csv), ("a.csv", "a\n1\n2\n3\n4\n5\n")]).unwrap_err().to_string();
    assert!(found.contains("`a` is not measured in \"lot.csv\""), "{found}");
}

/// A block that names a file gives the dimensions their columns.
#[test]
fn a_block_names_its_file() {
    let (csv, _) = lot();
    let files = [("lot.csv", csv.as_str())];
    let short = "[dimensions]\na = {}\nb = {}\n[[joint]]\nof = [\"a\", \"b\"]\nmeasured = \"lot.csv\"\n[characteristics]\ny = { formula = \"a - b\" }\n";
    let long = format!("[dimensions]\n{ROWS}[characteristics]\ny = {{ formula = \"a - b\" }}\n");
    assert_eq!(moments(short, &files), moments(&long, &files));
}

/// A uniform angle over a full turn inside a sine or cosine causes a warning. Half a turn, a normal angle, and an angle elsewhere do not.
#[test]
fn an_angle_over_a_full_turn_is_warned_of() {
    let warned = |units: &str, dir: &str, formula: &str| {
        let text = format!(
            "units = \"{units}\"\n[dimensions]\nr = {{ nominal = 2, tolerance = 0.1, unit = \"mm\" }}\ndir = {{ nominal = 0, {dir} }}\n\
             [characteristics]\ny = {{ formula = \"{formula}\", unit = \"mm\" }}\n"
        );
        let warnings = study(&text, &[]).warnings;
        warnings.iter().any(|warning| warning.code() == "periodic-input")
    };
    let turn = "tolerance = 180, distribution = \"uniform\"";
    assert!(warned("warn", turn, "r*cos(dir*deg)"));
    assert!(warned("warn", turn, "r*sin(pi/4 - dir*pi/180) + r"));
    assert!(warned("warn", "tolerance = 360, distribution = \"uniform\"", "r*sin(dir*deg)"));
    assert!(warned("convert", "tolerance = 180, distribution = \"uniform\", unit = \"deg\"", "r*cos(dir)"));
    assert!(!warned("warn", "tolerance = 90, distribution = \"uniform\"", "r*cos(dir*deg)"));
    assert!(!warned("warn", "tolerance = 180", "r*cos(dir*deg)"));
    assert!(!warned("warn", turn, "r + 0.001*dir + r*cos(0.3)"));
}
