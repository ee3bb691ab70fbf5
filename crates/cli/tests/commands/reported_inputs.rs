//! Small inputs of users' reports with right answers: unlike sides, units of an expansion coefficient, columns by the names of dimensions.
//!
//! Oracle: closed forms, beside each test.

use sensitol::{Method, analyze};
use sensitol_study::{Study, StudyText};

use sensitol_testing::close;

/// Mean, sigma and shares below and above the limits of the only characteristic.
fn figures(study: &Study) -> [f64; 4] {
    let one = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    let (moments, capability) = (one.moments.unwrap(), one.distribution.capability.unwrap());
    [moments.mean(), moments.sigma(), capability.ppm_below().unwrap() * 1e-6, capability.ppm_above().unwrap() * 1e-6]
}

fn normal_below(z: f64) -> f64 {
    0.5 * libm::erfc(-z / 2f64.sqrt())
}

/// 5 +0.6 -0.3 at three sigma on either side: a split normal distribution with the sigmas 0.1 and 0.2 (John 1982).
#[test]
fn unlike_sides_are_a_split_normal_distribution() {
    let pi = std::f64::consts::PI;
    for dimension in [
        "nominal = 5, tolerance = [-0.3, 0.6], distribution = \"split-normal\"",
        "nominal = 5, distribution = { kind = \"split-normal\", below = 0.1, above = 0.2 }",
        "nominal = 5, sigma = [0.1, 0.2]",
    ] {
        let text = format!(
            "[dimensions]\nx = {{ {dimension} }}\n[characteristics]\ny = {{ formula = \"x\", lower = 4.9, upper = 5.2 }}\n"
        );
        let [mean, sigma, below, above] = figures(&Study::from_toml(&text, "unlike.toml").unwrap());
        close(mean, 5.0 + 0.1 * (2.0 / pi).sqrt(), 1e-14, 1.0);
        close(sigma, ((1.0 - 2.0 / pi) * 0.01 + 0.02).sqrt(), 1e-12, 1.0);
        // A third of the values lies below the mode; each limit is one sigma of its side away.
        close(below, 2.0 / 3.0 * normal_below(-1.0), 1e-6, 1.0);
        close(above, 4.0 / 3.0 * normal_below(-1.0), 1e-6, 1.0);
    }
}

/// The largest of many values: `1 - exp(-exp(-(x - mode)/scale))` lies above x.
#[test]
fn largest_and_smallest_values_are_gumbel_distributions() {
    let (scale, euler) = (0.5 * 6f64.sqrt() / std::f64::consts::PI, 0.577_215_664_901_532_9);
    for (kind, sign) in [("gumbel-largest", 1.0), ("gumbel-smallest", -1.0)] {
        let text = format!(
            "[dimensions]\nx = {{ nominal = 8, sigma = 0.5, distribution = \"{kind}\" }}\n[characteristics]\ny = {{ formula = \"x\", lower = 7, upper = 9 }}\n"
        );
        let [mean, sigma, below, above] = figures(&Study::from_toml(&text, "gumbel.toml").unwrap());
        close(mean, 8.0, 1e-14, 1.0);
        close(sigma, 0.5, 1e-12, 1.0);
        let long = -f64::exp_m1(-(-(1.0 / scale + euler)).exp());
        let short = (-(1.0 / scale - euler).exp()).exp();
        let expected = if sign > 0.0 { [short, long] } else { [long, short] };
        for (found, expected) in [below, above].into_iter().zip(expected) {
            close(found, expected, 1e-6, 1.0);
        }
    }
}

/// A rod of 1 m, 23.6e-6 per kelvin, 50 K warmer: 1.18 mm, in every spelling of the unit.
#[test]
fn an_expansion_is_the_same_in_every_spelling() {
    for (number, unit) in [
        ("23.6", "ppm/degC"),
        ("23.6", "um/m/degC"),
        ("23.6", "um/(m*K)"),
        ("23.6e-6", "1/degC"),
        ("23.6e-6", "mm/mm/degC"),
        ("23.6", "10^-6/K"),
        ("13.11111111111111", "uin/in/degF"),
    ] {
        let text = format!(
            "units = \"convert\"\n[dimensions]\nL = {{ nominal = 1000, tolerance = 0.1, unit = \"mm\" }}\n\
             cte = {{ nominal = {number}, unit = \"{unit}\" }}\nT = {{ nominal = 70, unit = \"degC\" }}\n\
             [characteristics]\ngrowth = {{ formula = \"L*cte*(T - 20[degC])\", unit = \"mm\" }}\n"
        );
        let study = Study::from_toml(&text, "rod.toml").unwrap_or_else(|error| panic!("{unit}: {error}"));
        let found = analyze(&study.problem, &Method::Full.into()).unwrap();
        close(found.characteristics[0].nominal.unwrap(), 1.18, 1e-13, 1.0);
    }
    let mean = "units = \"convert\"\n[dimensions]\nT1 = { nominal = 20, tolerance = 1, unit = \"degC\" }\nT2 = { nominal = 30, tolerance = 1, unit = \"degC\" }\n\
                [characteristics]\nT = { formula = \"(T1 + T2)/2\", unit = \"degC\" }\n";
    let study = Study::from_toml(mean, "mean.toml").unwrap_or_else(|error| panic!("{error}"));
    let found = analyze(&study.problem, &Method::Full.into()).unwrap();
    close(found.characteristics[0].nominal.unwrap(), 25.0, 1e-14, 1.0);
    // A result on another scale has another zero.
    let scales =
        mean.replace("formula = \"(T1 + T2)/2\", unit = \"degC\"", "formula = \"(T1 + T2)/2\", unit = \"degF\"");
    let error = Study::from_toml(&scales, "mean.toml").unwrap_err().to_string();
    assert!(error.contains("whose zeros differ"), "{error}");
    let unknown = mean.replace("unit = \"degC\" }\nT2", "unit = \"degX\" }\nT2");
    let error = Study::from_toml(&unknown, "mean.toml").unwrap_err().to_string();
    assert!(error.contains("the unit `degX` of `T1` is unknown"), "{error}");
}

/// Two columns of one file, of other parts. Mean 12.40375 - 5.2, sigma by the divisor n of either column (`measured-apart` of the reports).
#[test]
fn a_measured_column_is_that_of_the_dimension() {
    let text = "[dimensions]\nhousing = { nominal = 12.40, measured = \"lot.csv\", joint = false }\n\
                bearing = { nominal = 5.20, measured = \"lot.csv\", joint = false }\n[characteristics]\ngap = { formula = \"housing - bearing\" }\n";
    let lot = "housing,bearing\n12.41,5.21\n12.40,5.20\n12.40,5.20\n12.39,5.19\n12.41,5.20\n12.40,5.21\n12.42,5.20\n12.40,5.19\n";
    let study = Study::from_text(StudyText::toml("apart.toml", text).with_file("lot.csv", lot)).unwrap();
    let found = analyze(&study.problem, &Method::Full.into()).unwrap();
    let moments = found.characteristics[0].moments.unwrap();
    close(moments.mean(), 7.20375, 1e-12, 1.0);
    // The report has six digits.
    close(moments.sigma(), 0.0111102, 5e-8, 1.0);
}
