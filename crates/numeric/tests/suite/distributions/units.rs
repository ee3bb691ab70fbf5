//! Distributions in other units are the same, for extreme units too: a kilogram in proton masses, a metre in light years.

use std::sync::Arc;

use sensitol_numeric::distribution::{
    Beta, CurvilinearTrapezoid, Distribution, Drifting, Exponential, Gamma, Lognormal, Measured, Mixture, Normal, Part,
    PearsonLaw, Rayleigh, Student, Tabulated, Trapezoidal, Triangular, TruncatedNormal, TwoValues, UShaped, Uniform,
    Weibull,
};

use sensitol_numeric::distribution::outliers::{extreme, outliers};

use sensitol_testing::{close, relative};

/// A distribution of every kind, with all lengths in this unit.
fn laws(unit: f64) -> Vec<Arc<dyn Distribution>> {
    let of = |lengths: &[f64]| lengths.iter().map(|length| unit * length).collect::<Vec<f64>>();
    let measured = of(&[10.0, 10.02, 9.99, 10.01, 10.03, 9.98, 10.0, 10.05]);
    let part = |weight: f64, distribution: Arc<dyn Distribution>| Part { name: "part".into(), weight, distribution };
    let parts = vec![
        part(3.0, Arc::new(Normal::new(10.0 * unit, 0.1 * unit).unwrap())),
        part(1.0, Arc::new(Uniform::new(10.1 * unit, 10.5 * unit).unwrap())),
        part(1.0, Arc::new(Exponential::new(9.8 * unit, 9.9 * unit).unwrap())),
    ];
    vec![
        Arc::new(Normal::new(7.0 * unit, 0.2 * unit).unwrap()),
        Arc::new(Uniform::new(-unit, 3.0 * unit).unwrap()),
        Arc::new(Triangular::new(unit, 1.75 * unit, 4.0 * unit).unwrap()),
        Arc::new(Trapezoidal::new(-unit, unit, 0.25).unwrap()),
        Arc::new(TruncatedNormal::new(-unit, 2.0 * unit, 0.5 * unit, 0.5 * unit).unwrap()),
        Arc::new(Beta::new(unit, 3.0 * unit, 2.0, 5.0).unwrap()),
        Arc::new(UShaped::new(unit, 2.0 * unit).unwrap()),
        Arc::new(CurvilinearTrapezoid::new(-unit, unit, 0.125 * unit).unwrap()),
        Arc::new(Student::with_scale(0.0, unit, 25.0).unwrap()),
        Arc::new(Student::with_scale(0.0, unit, 9.5).unwrap()),
        Arc::new(Drifting::new(3.0 * unit, 0.2 * unit, 0.3 * unit).unwrap()),
        Arc::new(Exponential::new(0.5 * unit, 2.0 * unit).unwrap()),
        Arc::new(Rayleigh::new(0.5 * unit, 2.0 * unit).unwrap()),
        Arc::new(Gamma::new(unit, 7.0 * unit, 3.4 * unit).unwrap()),
        Arc::new(Lognormal::new(-unit, 0.13 * unit, 0.6 * unit).unwrap()),
        Arc::new(Weibull::new(0.0, 0.9 * unit, 0.6 * unit).unwrap()),
        Arc::new(TwoValues::new(unit, 2.0 * unit).unwrap()),
        Arc::new(Tabulated::new(&[-5.0, -1.0, 0.5, 5.0], &of(&[7.0, 7.4, 7.55, 8.0])).unwrap()),
        Arc::new(Measured::new(&measured).unwrap()),
        Arc::new(PearsonLaw::new(unit, 0.1 * unit, 0.4, 0.3).unwrap()),
        Arc::new(PearsonLaw::fitted(&measured).unwrap()),
        Arc::new(Mixture::new(parts).unwrap()),
    ]
}

/// Powers of ten of the unit: the ends of the supported range, and values in between.
const POWERS: [i32; 11] = [-290, -200, -161, -100, -40, -3, 3, 61, 155, 200, 290];

/// Rounding by a unit that is no power of two, in a parameter and in a difference of two.
const ROUNDING: f64 = 1e-12;

#[test]
fn a_law_in_another_unit_is_the_same_law() {
    let expected = laws(1.0);
    for power in POWERS {
        let unit = format!("1e{power}").parse::<f64>().unwrap();
        for (law, expected) in laws(unit).iter().zip(&expected) {
            let name = format!("{} in 1e{power}", law.name());
            let sigma = expected.sigma();
            close(law.mean() / unit, expected.mean(), ROUNDING, sigma);
            relative(law.sigma() / unit, sigma, ROUNDING);
            let (found, wanted) = (law.standard_moments(), expected.standard_moments());
            for (found, wanted) in found.raw().into_iter().zip(wanted.raw()) {
                // Skips orders of moments that the distribution does not have.
                if !wanted.is_nan() || !found.is_nan() {
                    close(found, wanted, 1e-9, 1.0);
                }
            }
            let (found, wanted) = (law.jacobi(5).gauss(), expected.jacobi(5).gauss());
            assert_eq!(found.nodes.len(), wanted.nodes.len(), "{name}");
            found.nodes.iter().zip(&wanted.nodes).for_each(|(found, wanted)| close(*found, *wanted, 1e-8, 1.0));
            let mean = expected.mean();
            let (law, expected) = (law.probability().unwrap(), expected.probability().unwrap());
            for p in [1e-9, 1e-3, 0.2, 0.5] {
                close(law.quantile(p) / unit, expected.quantile(p), ROUNDING, sigma);
                close(law.upper_quantile(p) / unit, expected.upper_quantile(p), ROUNDING, sigma);
            }
            for step in [-2.5, -1.1, -0.3, 0.7, 1.9] {
                let x = mean + step * sigma;
                close(law.cdf(x * unit), expected.cdf(x), 1e-11, 1e-3);
                close(law.sf(x * unit), expected.sf(x), 1e-11, 1e-3);
                if let Some((found, wanted)) = law.density(x * unit).zip(expected.density(x)) {
                    close(found * unit, wanted, 1e-10, 1e-3 / sigma);
                }
            }
        }
    }
}

/// The test of outliers measures in sigmas of the sample.
#[test]
fn an_outlier_is_one_in_every_unit() {
    let mut values: Vec<f64> = (0..40).map(|i| 10.0 + 0.01 * f64::from(i % 7)).collect();
    values[3] = 10.9;
    for power in POWERS {
        let unit = format!("1e{power}").parse::<f64>().unwrap();
        let scaled: Vec<f64> = values.iter().map(|value| value * unit).collect();
        assert_eq!(outliers(&scaled), [3], "1e{power}");
        assert_eq!(extreme(&scaled, 0.01, 2), extreme(&values, 0.01, 2), "1e{power}");
    }
}
