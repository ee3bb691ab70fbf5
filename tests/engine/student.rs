//! Student's distribution with few degrees of freedom, whose higher moments are infinite, against 40 digits.

use sensitol::distribution::{Distribution, Student};
use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_testing::{close, data, relative};

/// Probabilities are accurate to 1e-12, quantiles to 1e-12 sigma or of their own size, as for every distribution. Infinite moments are NaN.
#[test]
fn tails_and_moments_at_any_degrees() {
    for case in data("student.json").as_array().unwrap() {
        let degrees = case["degrees"].as_f64().unwrap();
        let law = Student::new(0.0, 1.0, degrees).unwrap();
        let scaled = Student::with_scale(3.0, 0.5, degrees).unwrap();
        relative(scaled.sigma(), 0.5 * case["sigma"].as_f64().unwrap(), 4e-15 / (degrees - 2.0));
        let found = law.standard_moments();
        for (found, even) in [3.0 + found.excess, found.m6, found.m8].into_iter().zip(case["even"].as_array().unwrap())
        {
            match even.as_f64() {
                // The distance of the degrees from an order is rounded like the degrees.
                Some(even) => relative(found, even, 1e-12),
                None => assert!(found.is_nan(), "{degrees}"),
            }
        }
        let known = |moment: f64, order: f64| assert_eq!(moment == 0.0, degrees > order, "{degrees}: {order}");
        for (moment, order) in [(found.skewness, 3.0), (found.m5, 5.0), (found.m7, 7.0)] {
            known(moment, order);
        }
        let law = law.probability().unwrap();
        for row in case["at"].as_array().unwrap() {
            let [u, density, above] = [0, 1, 2].map(|i| row[i].as_f64().unwrap());
            relative(law.density(u).unwrap(), density, 2e-12);
            relative(law.sf(u), above, 2e-12);
            relative(law.cdf(-u), above, 2e-12);
            close(law.cdf(u), 1.0 - above, 1e-15, 1.0);
        }
        for row in case["quantiles"].as_array().unwrap() {
            let [p, u] = [0, 1].map(|i| row[i].as_f64().unwrap());
            // Near the median a probability is accurate to 1e-16 of the whole.
            close(law.upper_quantile(p), u, 2e-12, u.max(1e-3));
            close(law.quantile(p), -u, 2e-12, u.max(1e-3));
        }
        assert_eq!((law.quantile(0.5), law.sf(f64::INFINITY), law.cdf(f64::NEG_INFINITY)), (0.0, 0.0, 0.0));
        assert_eq!((law.quantile(0.0), law.quantile(1.0)), (f64::NEG_INFINITY, f64::INFINITY));
        assert!(law.quantile(f64::NAN).is_nan() && law.sf(f64::NAN).is_nan());
    }
}

fn analysed(degrees: f64, formula: &str, method: Method) -> sensitol::CharacteristicAnalysis {
    let text = format!(
        "[dimensions]\na = {{ nominal = 1, sigma = 0.3, distribution = {{ kind = \"student\", degrees = {degrees:?} }} }}\n\
         b = {{ nominal = 2, sigma = 0.4 }}\n[characteristics]\ny = {{ formula = \"{formula}\", lower = 2 }}\n"
    );
    let study = Study::from_toml(&text, "student.toml").unwrap();
    analyze(&study.problem, &method.into()).unwrap().characteristics.remove(0)
}

/// Cumulants of independent inputs add. Existing moments are exact, and the others are unknown, never 0.
#[test]
fn sums_have_the_moments_that_exist() {
    for method in [Method::Rss, Method::SecondOrder, Method::Full, Method::Auto, Method::DimensionReduction] {
        for degrees in [2.5, 3.0, 4.0, 5.0, 8.0, 30.0] {
            let moments = analysed(degrees, "a + b", method).moments.unwrap();
            let about = format!("{method:?} {degrees}");
            // Variance: the sum of 0.09 and 0.16. Differences of values of 3 have errors of 1e-15 of them.
            relative(moments.mean(), 3.0, 1e-13);
            relative(moments.sigma(), 0.5, 1e-12);
            assert_eq!(moments.skewness().is_some(), degrees > 3.0, "{about}");
            assert_eq!(moments.kurtosis().is_some(), degrees > 4.0, "{about}");
            if let Some(kurtosis) = moments.kurtosis() {
                relative(kurtosis, 3.0 + 6.0 / (degrees - 4.0) * 0.6f64.powi(4), 1e-9);
            }
        }
    }
}

/// Without a kurtosis there is no Pearson fit, but the tail follows from the surface.
#[test]
fn yields_do_not_need_moments() {
    let student = Student::new(1.0, 0.3, 3.0).unwrap();
    let expected = student.probability().unwrap().cdf(2.0);
    for method in [Method::SecondOrder, Method::Auto] {
        let text = "[dimensions]\na = { nominal = 1, sigma = 0.3, distribution = { kind = \"student\", degrees = 3 } }\n\
                    [characteristics]\ny = { formula = \"a\", upper = 2 }\nz = { formula = \"a^2\" }\n";
        let study = Study::from_toml(text, "student.toml").unwrap();
        let found = analyze(&study.problem, &method.into()).unwrap();
        let one = &found.characteristics[0];
        // A single input is integrated to the digits of its distribution function.
        close(one.distribution.capability.unwrap().yield_().unwrap(), expected, 1e-9, 1.0);
        assert!(one.evidence.pearson.is_none(), "{method:?}");
        let of = |warning: &sensitol::warning::Warning| warning.code() == "infinite-moment";
        let messages: Vec<String> = found.warnings.iter().filter(|one| of(one)).map(|one| one.message()).collect();
        assert!(messages[0].starts_with("The skewness of `y` is infinite"), "{messages:?}");
        assert!(messages[1].starts_with("The sigma of `z` is infinite"), "{messages:?}");
    }
}

/// A Student input beside one normal input is integrated, and beside two it is counted: with long tails no transform is inverted.
#[test]
fn sums_keep_their_tails() {
    let student = Student::new(1.0, 0.3, 5.0).unwrap();
    let law = student.probability().unwrap();
    // The trapezoidal rule converges faster than any power for a normal density.
    let beside = |sigma: f64, y: f64| {
        let at = |i: i32| {
            let z = f64::from(i) / 64.0;
            law.cdf(y - sigma * z) * (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt() / 64.0
        };
        (-640..=640).map(at).sum::<f64>()
    };
    let found = |formula: &str| {
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, sigma = 0.3, distribution = {{ kind = \"student\", degrees = 5 }} }}\n\
             b = {{ nominal = 0, sigma = 0.3 }}\nc = {{ nominal = 0, sigma = 0.4 }}\n\
             [characteristics]\ny = {{ formula = \"{formula}\", upper = 2 }}\n"
        );
        let study = Study::from_toml(&text, "student.toml").unwrap();
        let one = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0);
        1.0 - one.evidence.surface_law.as_ref().unwrap().above.unwrap().value
    };
    // Panels and roots are accurate to 1e-9 with an input that has no moments beyond the fourth.
    close(found("a + b"), beside(0.3, 2.0), 1e-9, 1.0);
    // A sum of three is counted at 65 536 points, to some 1e-3 of a share of 0.95 at the most.
    close(found("a + b + c"), beside(0.5, 2.0), 1e-3, 1.0);
}

/// The variance of a square needs a fourth moment, its kurtosis an eighth.
#[test]
fn curvature_needs_more_moments_than_a_line() {
    for method in [Method::SecondOrder, Method::Full] {
        assert!(analysed(4.0, "a^2 + b", method).moments.is_none());
        let moments = analysed(6.0, "a^2 + b", method).moments.unwrap();
        // a = 1 + 0.3 u: variance 0.36 + 0.0081 (m4 - 1) + 0.16 with m4 = 6.
        relative(moments.sigma(), (0.36f64 + 0.0081 * 5.0 + 0.16).sqrt(), 1e-9);
        assert!(moments.skewness().is_none() && moments.kurtosis().is_none());
    }
}
