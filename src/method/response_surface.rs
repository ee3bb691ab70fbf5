//! `response-surface`: a quadratic surface through a central composite design, by least squares.
//!
//! ```text
//! y ~ c + sum_j b_j u_j + sum_j a_j u_j^2 + sum_{j<k} A_jk u_j u_k          u_j = (x_j - mean_j)/sigma_j
//! ```
//!
//! Box and Wilson (1951), "On the experimental attainment of optimum conditions", Journal of the Royal Statistical Society B 13. The design
//! has the means, two axial points of every dimension and the corners of a factorial.
//!
//! The axial points are the pair of nodes that matches a dimension's moments to the fourth (for a normal dimension +-sqrt 3). The corners
//! have every dimension at 1/sqrt 3 of these (for a normal dimension +-1), which is about as far out in N dimensions as most assemblies
//! are. `--step K` puts the axial points at K sigma.
//!
//! The factorial has resolution V ([`corners`]): no interaction is confounded with another, or with a slope. Smaller designs that confound
//! interactions with slopes (Hartley 1959) can estimate a quadratic too. A cubic term of one dimension would then appear as an interaction
//! of two others.
//!
//! The surface is fitted in sigmas, by a QR decomposition with column pivoting. Its moments are exact for all distributions, like those of
//! the derivative methods. They are sampled if correlated inputs are not normal.
//!
//! The residual standard error has as many degrees of freedom as there are points in excess of coefficients. The errors of mean and sigma
//! that follow from it assume random residuals. The residuals of a smooth function are not random, so that these errors are a scale and no
//! bound. A point that is lost is left out of the fit. There is no fit if the remaining points do not determine it.
//!
//! Evaluations: `2^r + 2N + 1`. r is N up to four dimensions, then 4, 5, 6 for N of 5, 6, 7 and 8, 7 up to 11, 8 up to 17.

use crate::method::integration::quadrature;
use std::sync::Arc;

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

use crate::assembly::Run;
use crate::evaluation::{Evaluator, evaluate};
use crate::method::polynomial_surface::PolynomialSurface;
use crate::method::{
    Basis, Cost, EvaluationLimit, ExactDerivatives, Fitted, Lacking, Method, MethodError, Options, Order, Outcome,
    Procedure, Residual, cost,
};
use crate::plan::{Axis, Design, KnownAnswers, Mixed, Plan, Point, Purpose, Spread, corners};
use crate::problem::Problem;
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{DerivativeOrigin, Surrogate, Univariate};

pub(super) struct ResponseSurface;

/// Greatest number of dimensions of a surface: 1431 coefficients take some seconds.
const MOST: usize = 52;
/// A pivot below this part of the largest belongs to a coefficient that the points do not determine.
const SINGULAR: f64 = 1e-10;

impl Procedure for ResponseSurface {
    fn method(&self) -> Method {
        Method::ResponseSurface
    }

    fn about(&self) -> &'static str {
        "a quadratic fitted by least squares to a central composite design"
    }

    fn count(&self) -> &'static str {
        "2^r+2N+1"
    }

    fn check(&self, _: &Problem, options: &Options) -> Result<(), MethodError> {
        if let Some(step) = options.step.filter(|step| !(step.is_finite() && *step > 0.0)) {
            return Err(MethodError::BadStep { step });
        }
        let step = Options { step: None, ..options.clone() };
        quadrature::check_options(self.name(), &step, false)
    }

    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError> {
        Ok(Arc::new(self.design(problem, options)?.0))
    }

    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
        let (design, places) = self.design(problem, options)?;
        Cost::of(&design).within(self.name(), problem, options)?;
        problem.function().prepare(problem.outputs()).map_err(|error| MethodError::Model { error })?;
        let evaluated = evaluate(&Evaluator::new(problem, run), &design);
        let pairs = design.pairs();
        let exact = ExactDerivatives::beside(problem, &design, options, &pairs);
        let (basis, order) = (Basis::LeastSquares, Order::Second);
        let polynomials = PolynomialSurface::all(problem, &design, options);
        let fit = |(c, exact): (usize, Option<ExactDerivatives>)| {
            let mut fitted = Fitted { exact, ..fitted(&design, &places, &evaluated.known, c, &pairs) };
            // Least squares determine a quadratic exactly, but mix up the terms of a polynomial of higher degree.
            let quadratic = polynomials[c].as_ref().filter(|terms| terms.degree <= 2);
            quadratic.into_iter().for_each(|terms| terms.replace(&mut fitted, &design, order, &pairs));
            fitted
        };
        let fitted = exact.into_iter().enumerate().map(fit).collect();
        let (method, plan) = (self.method(), Arc::new(design) as _);
        let outcome = Outcome { asked: method, method, basis, plan, evaluated, order, fitted, pairs, climbed: None };
        Ok(outcome.with_proofs(problem, &polynomials))
    }
}

impl ResponseSurface {
    /// Returns the design, and the points that the surface is fitted to.
    fn design(&self, problem: &Problem, options: &Options) -> Result<(Design, Vec<Point>), MethodError> {
        self.check(problem, options)?;
        let (dimensions, correlation) = (problem.dimensions(), problem.correlation());
        let mut design = Design::new(dimensions, correlation, problem.dependence(), options.all_sensitivities);
        let varying = design.varying().to_vec();
        let n = varying.len();
        if n > MOST {
            let most = options.budget.unwrap_or(EvaluationLimit::WithoutBudget.most());
            let fitting = cost::fitting(problem, most);
            return Err(MethodError::TooManyDimensions { method: self.name(), dimensions: n, most: MOST, fitting });
        }
        let mut points = vec![Point::Centre];
        design.want(Point::Centre, Purpose::Centre);
        let mut near = Vec::with_capacity(n);
        for &d in &varying {
            let axis = Axis::varying(&dimensions[d], Spread::Pair, options.step);
            let far: Vec<f64> = axis.slots.iter().map(|slot| axis.nodes[slot[0] as usize].x).collect();
            let nearer = |side: usize| axis.nearest_value(axis.mean + (far[side] - axis.mean) / 3f64.sqrt());
            near.push([0, far.len() - 1].map(nearer));
            design.steps(d, far.iter().copied());
            design.take_notes(d, axis);
            for x in far {
                let point = design.point(&[(d, x)]);
                design.want(point.clone(), Purpose::Axis);
                points.push(point);
            }
        }
        for corner in corners(n) {
            let at: Vec<(usize, f64)> =
                varying.iter().zip(&corner).zip(&near).map(|((&d, &up), near)| (d, near[usize::from(up)])).collect();
            let point = design.point(&at);
            design.want(point.clone(), Purpose::Corner);
            points.push(point);
        }
        Ok((design, points))
    }
}

/// Fits the surface of one characteristic.
fn fitted(design: &Design, points: &[Point], known: &KnownAnswers, c: usize, pairs: &[(usize, usize)]) -> Fitted {
    let varying = design.varying();
    let dimensions = design.centre().len();
    let mine: Vec<usize> = (0..varying.len()).filter(|&j| design.depends(c, varying[j])).collect();
    let products: Vec<(usize, usize)> = pairs.iter().copied().filter(|&(j, k)| design.joint(c, j, k)).collect();
    let values: Vec<(&Point, f64)> = points.iter().filter_map(|point| Some((point, known.value(point, c)?))).collect();
    let coefficients = 1 + 2 * mine.len() + products.len();
    let nominal = known.value(design.nominal(), c);
    let centre = known.value(&Point::Centre, c);
    let found = Fitted { nominal, centre, ..Fitted::default() };
    // Dimensions without tolerance have differences, as in every other method.
    let fixed = |d: usize| {
        let samples = design.axis(d).slots.iter().filter_map(|slot| {
            let node = slot[0];
            let value = known.value(&Point::of(&[crate::plan::AtNode { dimension: d as u32, node }]), c)?;
            Some((design.axis(d).nodes[node as usize].u, value - centre?))
        });
        Univariate::through(&samples.collect::<Vec<_>>())
    };
    let own_part = |d: usize| match (design.depends(c, d), varying.binary_search(&d)) {
        (false, _) => Some(Univariate::of_coefficients(&[0.0, 0.0])),
        (true, Ok(_)) => None,
        (true, Err(_)) => fixed(d),
    };
    let mut parts: Vec<Option<Univariate>> = (0..dimensions).map(own_part).collect();
    // Without a solution the report states the number of points that are left.
    let Some(solution) = solve(design, &values, &mine, &products, coefficients) else {
        let lacking = Some(Lacking::NotEstimable { left: values.len(), coefficients });
        return Fitted { parts, mixed: vec![None; pairs.len()], lacking, ..found };
    };
    for (place, &j) in mine.iter().enumerate() {
        let at = 1 + 2 * place;
        let part = Univariate::of_coefficients(&solution.coefficients[at..at + 2]);
        parts[varying[j]] = Some(part.with_origin(DerivativeOrigin::Evaluated));
    }
    let of_products = &solution.coefficients[1 + 2 * mine.len()..];
    let mixed = pairs.iter().map(|pair| {
        let value = products.binary_search(pair).map_or(0.0, |place| of_products[place]);
        Some(Mixed::evaluated(value))
    });
    let surrogate = Surrogate {
        centre: solution.coefficients[0],
        parts: varying.iter().map(|&d| parts[d]).collect(),
        interactions: Interactions::of_pairs(
            varying.len(),
            products.iter().zip(of_products).map(|(&(j, k), &value)| (j, k, value)).filter(|pair| pair.2 != 0.0),
        ),
    };
    // The formula for standard errors holds for independent inputs only.
    let [mean, sigma] = match design.inputs().correlation() {
        None => uncertain(design, &solution, &mine),
        Some(_) => [None; 2],
    };
    let residual = Residual { standard_error: solution.residual, mean, sigma, points: values.len(), coefficients };
    Fitted { mixed: mixed.collect(), parts, surrogate: Some(surrogate), residual: Some(residual), ..found }
}

/// Returns standard errors of mean and sigma of independent inputs: `s sqrt(g'(X'X)^-1 g)` with the gradient `g` by the coefficients.
///
/// The moments are `mean = c + sum_j a_j` and `var = sum_j b_j^2 + 2 a_j b_j s_j + a_j^2 (f_j - 1) + sum_{j<k} A_jk^2`, with skewness `s_j`
/// and kurtosis `f_j`.
fn uncertain(design: &Design, solution: &Solution, mine: &[usize]) -> [Option<f64>; 2] {
    let coefficients = &solution.coefficients;
    let products = 1 + 2 * mine.len();
    let (mut of_mean, mut of_variance) = (vec![0.0; coefficients.len()], vec![0.0; coefficients.len()]);
    of_mean[0] = 1.0;
    let mut variance: f64 = coefficients[products..].iter().map(|product| product * product).sum();
    for (place, &j) in mine.iter().enumerate() {
        let at = 1 + 2 * place;
        let (b, a) = (coefficients[at], coefficients[at + 1]);
        let moments = &design.inputs().shapes()[j].moments;
        let (skewness, bent) = (moments.skewness, moments.excess + 2.0);
        of_mean[at + 1] = 1.0;
        of_variance[at] = 2.0 * (b + a * skewness);
        of_variance[at + 1] = 2.0 * (b * skewness + a * bent);
        variance += b * b + 2.0 * a * b * skewness + a * a * bent;
    }
    for (gradient, product) in of_variance[products..].iter_mut().zip(&coefficients[products..]) {
        *gradient = 2.0 * product;
    }
    let sigma = variance.sqrt();
    let of = |gradient: &[f64]| Some(solution.residual? * solution.factor.as_ref()?.spread(gradient));
    [of(&of_mean), of(&of_variance).filter(|_| sigma > 0.0).map(|error| error / (2.0 * sigma))]
}

/// Coefficients in this order: constant, slope and curvature of every dimension, products.
struct Solution {
    coefficients: Vec<f64>,
    residual: Option<f64>,
    /// Factor of the decomposition; None if all values are the same.
    factor: Option<Factor>,
}

/// Factor of `X = Q R`, with the columns of `X` divided by their lengths and permuted to this order.
struct Factor {
    r: Mat<f64>,
    order: Vec<usize>,
    lengths: Vec<f64>,
}

impl Factor {
    /// Returns `sqrt(g'(X'X)^-1 g) = |R'^-1 g|`.
    fn spread(&self, gradient: &[f64]) -> f64 {
        let mut solved: Vec<f64> = Vec::with_capacity(gradient.len());
        for (i, &k) in self.order.iter().enumerate() {
            let before: f64 = solved.iter().enumerate().map(|(row, value)| self.r[(row, i)] * value).sum();
            solved.push((gradient[k] / self.lengths[k] - before) / self.r[(i, i)]);
        }
        solved.iter().map(|value| value * value).sum::<f64>().sqrt()
    }
}

/// Solves for the coefficients. Returns None if the points do not determine them.
fn solve(
    design: &Design,
    values: &[(&Point, f64)],
    mine: &[usize],
    products: &[(usize, usize)],
    coefficients: usize,
) -> Option<Solution> {
    if values.len() < coefficients {
        return None;
    }
    let varying = design.varying();
    let mut rows = Mat::<f64>::zeros(values.len(), coefficients);
    for (row, (point, _)) in values.iter().enumerate() {
        let mut u = vec![0.0; varying.len()];
        for at in point.at() {
            let position = varying.binary_search(&(at.dimension as usize)).expect("a design moves what varies");
            u[position] = design.axis(at.dimension as usize).nodes[at.node as usize].u;
        }
        rows[(row, 0)] = 1.0;
        for (place, &j) in mine.iter().enumerate() {
            (rows[(row, 1 + 2 * place)], rows[(row, 2 + 2 * place)]) = (u[j], u[j] * u[j]);
        }
        for (place, &(j, k)) in products.iter().enumerate() {
            rows[(row, 1 + 2 * mine.len() + place)] = u[j] * u[k];
        }
    }
    // Columns of length 1, so that a small pivot shows a coefficient that is not determined. Values are relative to the first.
    let lengths: Vec<f64> = (0..coefficients).map(|k| rows.col(k).norm_l2()).collect();
    if lengths.contains(&0.0) {
        return None;
    }
    let scaled = Mat::from_fn(values.len(), coefficients, |row, k| rows[(row, k)] / lengths[k]);
    let base = values[0].1;
    let largest = values.iter().map(|(_, value)| (value - base).abs()).fold(0.0, f64::max);
    if largest == 0.0 {
        let mut constant = vec![0.0; coefficients];
        constant[0] = base;
        let residual = (values.len() > coefficients).then_some(0.0);
        return Some(Solution { coefficients: constant, residual, factor: None });
    }
    let right = Mat::from_fn(values.len(), 1, |row, _| (values[row].1 - base) / largest);
    let decomposed = scaled.col_piv_qr();
    let pivot = |k: usize| decomposed.thin_R()[(k, k)].abs();
    if (0..coefficients).any(|k| pivot(k) <= SINGULAR * pivot(0)) {
        return None;
    }
    let solved = decomposed.solve_lstsq(&right);
    let missed = &scaled * &solved - &right;
    let freedom = values.len() - coefficients;
    let residual = (freedom > 0).then(|| largest * missed.norm_l2() / (freedom as f64).sqrt());
    let mut coefficients: Vec<f64> = (0..coefficients).map(|k| largest * solved[(k, 0)] / lengths[k]).collect();
    coefficients[0] += base;
    let factor = Factor { r: decomposed.thin_R().to_owned(), order: decomposed.P().arrays().0.to_vec(), lengths };
    Some(Solution { coefficients, residual, factor: Some(factor) })
}
