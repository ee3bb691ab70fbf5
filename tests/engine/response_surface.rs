//! Response surfaces: designs without confounding, exact quadratics, residuals, and lost points.

use std::collections::HashSet;
use std::sync::Arc;

use sensitol::correlation::Pair;
use sensitol::distribution::Exponential;
use sensitol::plan::corners;

use sensitol::method::Basis;
use sensitol::{Analysis, Closure, Dimension, Method, Options, Problem, Warning, analyze};
use sensitol_testing::{Asked, close, refusing, relative, standard};

fn analysis(dimensions: Vec<Dimension>, f: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Analysis {
    analyze(&Problem::new(dimensions, Closure::scalar("y", f)).unwrap(), &Method::ResponseSurface.into()).unwrap()
}

/// The designs have resolution V: the columns of all slopes and products of two are orthogonal to each other and to the constant, by
/// counting.
#[test]
fn corners_tell_slopes_and_products_apart() {
    for n in 1..=20 {
        let corners = corners(n);
        let rows = corners.len();
        let sign = |row: &[bool], d: usize| if row[d] { 1i64 } else { -1 };
        let mut columns: Vec<Vec<i64>> = vec![vec![1; rows]];
        for j in 0..n {
            columns.push(corners.iter().map(|row| sign(row, j)).collect());
            // With no more corners than that, a product of two dimensions is a constant.
            for k in j + 1..n {
                columns.push(corners.iter().map(|row| sign(row, j) * sign(row, k)).collect());
            }
        }
        for (i, a) in columns.iter().enumerate() {
            for b in &columns[..i] {
                assert_eq!(a.iter().zip(b).map(|(a, b)| a * b).sum::<i64>(), 0, "{n} dimensions");
            }
        }
        let different: HashSet<&Vec<bool>> = corners.iter().collect();
        assert_eq!(different.len(), rows);
    }
    // No smaller design exists: the largest number of columns with 4 to 8 signs (Draper and Lin 1990, table 1).
    assert_eq!([5, 6, 8, 11, 17].map(|n| corners(n).len()), [16, 32, 64, 128, 256]);
    assert_eq!([9, 12, 18].map(|n| corners(n).len()), [128, 256, 512]);
}

#[test]
fn counts_are_stated() {
    for n in 1..=12usize {
        let asked = Asked::default();
        let problem = Problem::new(standard(n), asked.watching(|x| x.iter().sum())).unwrap();
        let options = Options::from(Method::ResponseSurface);
        let fits = options.cost(&problem).unwrap();
        let found = analyze(&problem, &options).unwrap();
        assert_eq!(found.run.evaluations, asked.distinct() as u64);
        assert_eq!((found.run.evaluations, found.run.stages), (fits.evaluations as u64, fits.stages as u64));
        assert_eq!(found.run.evaluations as usize, corners(n).len() + 2 * n + 1);
    }
}

/// Quadratics of inputs of several kinds have exact derivatives, the moments of `full`, and no residuals.
#[test]
fn quadratics_are_exact() {
    let dimensions = || {
        let skewed = Arc::new(Exponential::new(1.0, 1.5).unwrap());
        vec![
            Dimension::normal("n", 10.0, 0.3).unwrap(),
            Dimension::uniform("u", 5.0, 0.2).unwrap(),
            Dimension::distributed("e", 1.5, None, skewed).unwrap(),
            Dimension::normal_between("s", 3.0, [0.0, 0.6]).unwrap(),
            Dimension::normal("m", 0.0, 0.9).unwrap(),
        ]
    };
    let f = |x: &[f64]| {
        let [n, u, e, s, m] = [x[0] - 10.0, x[1] - 5.0, x[2] - 1.5, x[3] - 3.3, x[4]];
        7.0 + n - 2.0 * u + 0.3 * e * e + 0.7 * u * e - 0.2 * n * s + s + 0.4 * m * m - 0.1 * m * e
    };
    let found = analysis(dimensions(), f);
    let problem = Problem::new(dimensions(), Closure::scalar("y", f)).unwrap();
    let full = analyze(&problem, &Method::Full.into()).unwrap();
    let (one, other) = (&found.characteristics[0], &full.characteristics[0]);
    let (a, b) = (one.moments.unwrap(), other.moments.unwrap());
    // Two solutions of the same equations in doubles differ by ten times the rounding of a QR of 27 rows.
    relative(a.mean(), b.mean(), 1e-13);
    relative(a.sigma(), b.sigma(), 1e-12);
    close(a.skewness().unwrap(), b.skewness().unwrap(), 1e-11, 1.0);
    close(a.excess().unwrap(), b.excess().unwrap(), 1e-11, 1.0);
    // In closed form: mean 7 + 0.3 x 0.25 + 0.4 x 0.09.
    relative(a.mean(), 7.0 + 0.075 + 0.036, 1e-13);
    let slope = |d: usize| one.sensitivities[d].first.unwrap();
    let second = |d: usize| one.sensitivities[d].second.unwrap();
    close(slope(0), 1.0, 1e-11, 1.0);
    close(slope(1), -2.0, 1e-11, 1.0);
    close(second(2), 0.6, 1e-10, 1.0);
    close(second(4), 0.8, 1e-10, 1.0);
    let mixed = |a: &str, b: &str| {
        let named = |pair: &sensitol::analysis::Interaction<'_>| pair.dimensions == [a, b];
        one.contributions.interactions.iter().find(named).unwrap().mixed.unwrap()
    };
    close(mixed("u", "e"), 0.7, 1e-10, 1.0);
    close(mixed("n", "s"), -0.2, 1e-10, 1.0);
    close(mixed("n", "u"), 0.0, 1e-10, 1.0);
    assert_eq!((found.basis, one.contributions.left_out_share), (Basis::LeastSquares, Some(0.0)));
    let residual = one.evidence.residual.unwrap();
    assert_eq!((residual.points, residual.coefficients), (16 + 10 + 1, 21));
    assert!(residual.standard_error.unwrap() < 1e-13);
    assert!(found.warnings.iter().all(|warning| warning.code() != "poor-fit"));
}

/// A cubic term of one normal dimension, from the normal equations by hand. The values are x = -1, 1 (corners, each twice), 0 (the other
/// axis and the centre) and +-sqrt 3.
///
/// The slope of x^3 is (4 + 2 x 9)/(4 + 2 x 3) = 2.2. The remainder is the residual.
#[test]
fn a_cubic_shows_in_the_residual() {
    let found = analysis(standard(2), |x| x[0].powi(3) + 5.0 * x[1]);
    let one = &found.characteristics[0];
    close(one.sensitivities[0].first.unwrap(), 2.2, 1e-12, 1.0);
    let missed = 4.0 * (1.0f64 - 2.2).powi(2) + 2.0 * (27f64.sqrt() - 2.2 * 3f64.sqrt()).powi(2);
    // The design has nine points, the surface six coefficients.
    let residual = one.evidence.residual.unwrap();
    let error = (missed / 3.0).sqrt();
    relative(residual.standard_error.unwrap(), error, 1e-12);
    // Variance of c + a_0 + a_1, whose normal matrix is [9 10 10; 10 22 4; 10 4 22], and of the two slopes, s^2/10 each.
    relative(residual.mean.unwrap(), error * (2.0f64 / 17.0).sqrt(), 1e-12);
    relative(residual.sigma.unwrap(), error / 10f64.sqrt(), 1e-12);
    let warning = found.warnings.iter().find(|warning| warning.code() == "poor-fit").unwrap();
    assert!(warning.message().contains("32.7 % of sigma"), "{}", warning.message());
}

/// The surface does not depend on the correlation of normal inputs, but its moments do.
#[test]
fn correlated_normals_are_exact() {
    let r = 0.6f64;
    let problem = Problem::new(standard(2), Closure::scalar("y", |x| x[0] * x[1])).unwrap();
    let between = ["x0", "x1"].map(str::to_owned);
    let problem = problem.correlated(&[Pair { between, value: r }]).unwrap();
    let moments = analyze(&problem, &Method::ResponseSurface.into()).unwrap().characteristics[0].moments.unwrap();
    close(moments.mean(), r, 1e-13, 1.0);
    relative(moments.variance(), 1.0 + r * r, 1e-12);
    relative(moments.skewness().unwrap(), (6.0 * r + 2.0 * r.powi(3)) / (1.0 + r * r).powf(1.5), 1e-12);
}

/// A lost corner is left out. If the remaining points do not determine the surface, there is none, and the report states this.
#[test]
fn lost_points_are_left_out_or_end_it() {
    let f = |x: &[f64]| 1.0 + x[0] + x[1] * x[2] + 0.5 * x[2] * x[2];
    let one = refusing(f, |x| x.iter().all(|&x| x > 0.5));
    let found = analyze(&Problem::new(standard(3), one).unwrap(), &Method::ResponseSurface.into()).unwrap();
    let moments = found.characteristics[0].moments.unwrap();
    relative(moments.variance(), 1.0 + 1.0 + 0.5, 1e-12);
    assert_eq!(found.characteristics[0].evidence.residual.unwrap().points, 14);
    assert_eq!(found.run.failed, 1);
    assert!(found.warnings.iter().any(|warning| warning.code() == "failed-points"));

    // Half of the design is just enough, so that there are no residuals.
    let half = refusing(f, |x| x[1] > 0.0);
    let found = analyze(&Problem::new(standard(3), half).unwrap(), &Method::ResponseSurface.into()).unwrap();
    relative(found.characteristics[0].moments.unwrap().variance(), 1.0 + 1.0 + 0.5, 1e-11);
    let residual = found.characteristics[0].evidence.residual.unwrap();
    assert_eq!((residual.points, residual.coefficients, residual.standard_error), (10, 10, None));

    let quarter = refusing(f, |x| x[1] > 0.0 || x[2] > 0.0);
    let found = analyze(&Problem::new(standard(3), quarter).unwrap(), &Method::ResponseSurface.into()).unwrap();
    let lost = &found.characteristics[0];
    assert_eq!((lost.moments, lost.evidence.residual, lost.sensitivities[0].first), (None, None, None));
    let warning = found.warnings.iter().find(|warning| warning.code() == "lost-moments").unwrap();
    assert!(matches!(warning, Warning::LostMoments { .. }));
    assert!(
        warning.message().contains("the 7 points that have a value do not determine the 10 coefficients"),
        "{}",
        warning.message()
    );
}
