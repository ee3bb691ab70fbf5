//! Distributions of dimensions whose tolerance is made narrower or wider.

use sensitol_numeric::dimension::Dimension;
use sensitol_testing::{close, dimension, fields, relative};

fn scaled(line: &str, factor: f64) -> Dimension {
    dimension(line).unwrap().scaled(factor).unwrap_or_else(|| panic!("{line} does not scale")).unwrap()
}

/// A tolerance written half as wide is the tolerance scaled by a half: the study file and `scaled` agree.
#[test]
fn a_scaled_dimension_is_the_one_written_so() {
    for (line, half) in [
        ("{ nominal = 10, tolerance = 0.3 }", "{ nominal = 10, tolerance = 0.15 }"),
        (
            "{ nominal = 10, tolerance = [-0.1, 0.3], shift = 0.02 }",
            "{ nominal = 10, tolerance = [0.0, 0.2], shift = 0.02 }",
        ),
        ("{ nominal = 10, sigma = 0.3 }", "{ nominal = 10, sigma = 0.15 }"),
        (
            "{ nominal = 10, tolerance = [0, 0.4], distribution = \"uniform\" }",
            "{ nominal = 10, tolerance = [0.1, 0.3], distribution = \"uniform\" }",
        ),
        (
            "{ nominal = 10, tolerance = 0.4, distribution = { kind = \"triangular\", mode = 10.2 } }",
            "{ nominal = 10, tolerance = 0.2, distribution = { kind = \"triangular\", mode = 10.1 } }",
        ),
        (
            "{ nominal = 10, tolerance = 0.4, distribution = { kind = \"trapezoidal\", top = 0.5 } }",
            "{ nominal = 10, tolerance = 0.2, distribution = { kind = \"trapezoidal\", top = 0.5 } }",
        ),
        (
            "{ nominal = 10, tolerance = 0.4, distribution = { kind = \"beta\", alpha = 2, beta = 5 } }",
            "{ nominal = 10, tolerance = 0.2, distribution = { kind = \"beta\", alpha = 2, beta = 5 } }",
        ),
        (
            "{ nominal = 10, tolerance = [-0.2, 0.4], shift = 0.05, sigmas = 2, distribution = \"truncated-normal\" }",
            "{ nominal = 10, tolerance = [-0.05, 0.25], shift = 0.05, sigmas = 2, distribution = \"truncated-normal\" }",
        ),
        (
            "{ nominal = 10, sigma = 4, shift = 1, distribution = { kind = \"gamma\", origin = 3 } }",
            "{ nominal = 10, sigma = 2, shift = 1, distribution = { kind = \"gamma\", origin = 3 } }",
        ),
        (
            "{ nominal = 10, tolerance = [-1, 5], distribution = \"lognormal\" }",
            "{ nominal = 10, tolerance = [0.5, 3.5], distribution = \"lognormal\" }",
        ),
        (
            "{ nominal = 10, sigma = 4, distribution = \"weibull\" }",
            "{ nominal = 10, sigma = 2, distribution = \"weibull\" }",
        ),
        (
            "{ nominal = 10, tolerance = 0.4, distribution = { kind = \"mixture\", parts = { a = { weight = 2, shift = 0.1 }, b = { weight = 1, sigma = 0.2 } } } }",
            "{ nominal = 10, tolerance = 0.2, distribution = { kind = \"mixture\", parts = { a = { weight = 2, shift = 0.1 }, b = { weight = 1, sigma = 0.1 } } } }",
        ),
    ] {
        let (found, expected) = (scaled(line, 0.5), dimension(half).unwrap());
        relative(found.mean(), expected.mean(), 1e-14);
        relative(found.sigma(), expected.sigma(), 1e-12);
        for (found, expected) in found.tolerance().iter().flatten().zip(expected.tolerance().iter().flatten()) {
            close(*found, *expected, 1e-15, 1.0);
        }
        assert_eq!(found.tolerance().is_some(), expected.tolerance().is_some(), "{line}");
        let shape = |dimension: &Dimension| fields(dimension.distribution().unwrap().standard_moments());
        for (found, expected) in shape(&found).into_iter().zip(shape(&expected)) {
            close(found, expected, 1e-11, 1.0);
        }
        let back = found.scaled(2.0).unwrap().unwrap();
        relative(back.sigma(), dimension(line).unwrap().sigma(), 1e-12);
    }
}

#[test]
fn what_a_tolerance_does_not_govern_does_not_scale() {
    for line in [
        "{ nominal = 10 }",
        "{ nominal = 10, distribution = \"exponential\" }",
        "{ nominal = 10, tolerance = 3, distribution = \"rayleigh\" }",
        "{ nominal = 10, moments = [0.04, 0, 0.0048, 0, 0.00096, 0, 0.0002688], tolerance = 1 }",
        "{ nominal = 10, distribution = { kind = \"mixture\", parts = { a = { weight = 2, sigma = 0.1 }, b = { weight = 1, distribution = \"exponential\" } } } }",
    ] {
        assert!(dimension(line).unwrap().scaled(0.5).is_none(), "{line}");
    }
    let normal = dimension("{ nominal = 10, tolerance = 0.3 }").unwrap();
    for factor in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(normal.scaled(factor).unwrap().is_err(), "{factor}");
    }
    let error = dimension("{ nominal = 10, sigma = 4, distribution = \"gamma\" }").unwrap().scaled(1e3).unwrap();
    assert!(error.unwrap_err().to_string().contains("sigma 4000 is 4.000e2 times"));
}
