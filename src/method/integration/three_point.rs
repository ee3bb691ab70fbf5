//! `three-point`: the full product of three-point rules.
//!
//! Every input has three levels and weights that match its moments 1 to 4. One of the levels is the mean
//! ([`Rule::three_point`](sensitol_numeric::distribution::Rule::three_point)). The function is evaluated at all `3^N` combinations, and
//! every expectation is the weighted sum over them. Seo and Kwak (2002), "Efficient statistical tolerance analysis for general
//! distributions using three-point information", International Journal of Production Research 40.
//!
//! They form raw moments from the sums and central moments from these, which costs the digits of mean/sigma. Here the second to fourth
//! moments are compensated sums of powers of the deviation from the estimated mean. An input whose matched level would lie outside its
//! support has a three-point Gauss rule instead.
//!
//! Exactness follows from the rules. Means are exact for polynomials up to degree 4 in every dimension (5 for a symmetric input), with any
//! products. Fourth moments are exact for functions that are linear in each dimension. For curved functions mean and sigma are good, but
//! skewness and kurtosis are not: a warning states this.
//!
//! Shares of the variance come from the same values, as conditional means at the levels of one dimension and of two. Joint effects of three
//! and more dimensions are left out. Correlated inputs are transformed by eigenvectors, as in `dimension-reduction`.
//!
//! Evaluations: 3 to the power of N, and 1 if the nominal is not among them.

use std::sync::Arc;

use crate::assembly::Run;
use crate::method::cost::affordable;
use crate::method::integration::quadrature::{Quadrature, check, complete};
use crate::method::{
    Cost, Integrated, InteractionEffect, Lacking, MainEffect, Method, MethodError, Options, Outcome, Procedure,
};
use crate::plan::{AtNode, KnownAnswers, Plan, Point, Purpose};
use crate::problem::Problem;
use sensitol_numeric::distribution::Rule;
use sensitol_numeric::moments::{Moments, exact};
use sensitol_numeric::parallel::prelude::*;

pub(in crate::method) struct ThreePoint;

/// Number of levels of an input.
const LEVELS: usize = 3;

impl Procedure for ThreePoint {
    fn method(&self) -> Method {
        Method::ThreePoint
    }

    fn about(&self) -> &'static str {
        "all combinations of three levels of every dimension, weighted by its moments"
    }

    fn count(&self) -> &'static str {
        "3^N"
    }

    fn check(&self, problem: &Problem, options: &Options) -> Result<(), MethodError> {
        check(self.name(), problem, options, false)
    }

    fn fits(&self, problem: &Problem, options: &Options) -> Result<Cost, MethodError> {
        self.check(problem, options)?;
        let (mut quadrature, grid) = self.grid(problem, options)?;
        // First a lower bound of the cost, so that an unaffordable grid is refused before a million points are listed.
        Cost { evaluations: grid.len(), stages: 1 }.within(self.name(), problem, options)?;
        Cost { evaluations: grid.cost(&mut quadrature), stages: 1 }.within(self.name(), problem, options)
    }

    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError> {
        self.check(problem, options)?;
        let (mut quadrature, grid) = self.grid(problem, options)?;
        grid.points(&mut quadrature);
        Ok(Arc::new(quadrature.design))
    }

    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
        self.check(problem, options)?;
        let (mut quadrature, grid) = self.grid(problem, options)?;
        Cost { evaluations: grid.len(), stages: 1 }.within(self.name(), problem, options)?;
        let points = grid.points(&mut quadrature);
        let evaluated = quadrature.evaluated(self.name(), problem, options, run)?;
        let pairs = quadrature.design.pairs();
        let found = (0..problem.characteristics().len())
            .map(|c| {
                let values = grid.values(&points, &evaluated.known, c);
                (values.map(|values| integrated(&quadrature, &grid, &values, &pairs)), vec![None; pairs.len()])
            })
            .collect();
        Ok(quadrature.outcome(self.method(), options, evaluated, pairs, found))
    }
}

impl ThreePoint {
    /// Returns the grid, or an error if it has too many combinations. No point is listed before this check.
    fn grid<'p>(&self, problem: &'p Problem, options: &Options) -> Result<(Quadrature<'p>, Grid), MethodError> {
        let quadrature = Quadrature::new(problem, options, Rule::three_point, LEVELS, false);
        let levels: Vec<usize> = quadrature.variables.all.iter().map(|variable| variable.rule.nodes.len()).collect();
        let needed = levels.iter().fold(1u128, |needed, &levels| needed.saturating_mul(levels as u128));
        affordable(self.name(), needed, problem, options, quadrature.design.varying().len())?;
        Ok((quadrature, Grid { levels }))
    }
}

/// All combinations of levels. The level of the last variable changes fastest.
struct Grid {
    levels: Vec<usize>,
}

impl Grid {
    fn len(&self) -> usize {
        self.levels.iter().product()
    }

    /// Returns the distance in the grid from one level of a variable to the next.
    fn stride(&self, variable: usize) -> usize {
        self.levels[variable + 1..].iter().product()
    }

    fn level(&self, place: usize, variable: usize, stride: usize) -> usize {
        place / stride % self.levels[variable]
    }

    /// Returns the node of every level of every variable, with None for a level at the mean. Returns None if a variable moves several
    /// dimensions.
    fn nodes(&self, quadrature: &mut Quadrature<'_>) -> Option<Vec<Vec<Option<AtNode>>>> {
        let variable = |(v, &levels): (usize, &usize)| {
            quadrature.variables.position(v)?;
            Some((0..levels).map(|level| quadrature.node(v, level)).collect())
        };
        self.levels.iter().enumerate().map(variable).collect()
    }

    /// Returns the number of points of the design together with all combinations.
    fn cost(&self, quadrature: &mut Quadrature<'_>) -> usize {
        let Some(nodes) = self.nodes(quadrature) else {
            self.points(quadrature);
            return quadrature.design.cost().0;
        };
        // All combinations are different. Only the nominal point of the initial design can be among them.
        let nominal = quadrature.design.nominal().at();
        let of_variable = |v: usize| {
            let d = quadrature.variables.position(v).map(|position| quadrature.design.varying()[position]);
            nominal.iter().copied().find(|at| Some(at.dimension as usize) == d)
        };
        let own: Vec<Option<AtNode>> = (0..nodes.len()).map(of_variable).collect();
        let among = nodes.iter().zip(&own).all(|(nodes, own)| nodes.contains(own));
        let whole = own.iter().flatten().count() == nominal.len();
        quadrature.design.cost().0 + self.len() - usize::from(among && whole)
    }

    fn points(&self, quadrature: &mut Quadrature<'_>) -> Vec<Point> {
        let nodes = self.nodes(quadrature);
        let mut at: Vec<(usize, usize)> = (0..self.levels.len()).map(|v| (v, 0)).collect();
        let strides: Vec<usize> = (0..self.levels.len()).map(|v| self.stride(v)).collect();
        let mut elsewhere = Vec::with_capacity(at.len());
        quadrature.design.reserve(self.len());
        (0..self.len())
            .map(|place| {
                at.iter_mut().for_each(|(v, level)| *level = self.level(place, *v, strides[*v]));
                let Some(nodes) = &nodes else { return quadrature.want(&at, Purpose::Grid) };
                elsewhere.clear();
                elsewhere.extend(at.iter().filter_map(|&(v, level)| nodes[v][level]));
                let point = Point::of(&elsewhere);
                quadrature.design.want(point.clone(), Purpose::Grid);
                point
            })
            .collect()
    }

    fn values(&self, points: &[Point], known: &KnownAnswers, c: usize) -> Result<Vec<f64>, Lacking> {
        let values: Vec<Option<f64>> = points.par_iter().map(|point| known.value(point, c)).collect();
        complete(values.iter().map(Option::is_some))?;
        Ok(values.into_iter().flatten().collect())
    }

    /// Returns the probability of every combination.
    fn weights(&self, rules: &[&Rule]) -> Vec<f64> {
        rules.iter().fold(vec![1.0], |weights, rule| {
            weights.iter().flat_map(|weight| rule.weights.iter().map(move |own| weight * own)).collect()
        })
    }
}

fn integrated(quadrature: &Quadrature<'_>, grid: &Grid, values: &[f64], pairs: &[(usize, usize)]) -> Integrated {
    let rules: Vec<&Rule> = quadrature.variables.all.iter().map(|variable| &variable.rule).collect();
    let weights = grid.weights(&rules);
    let n = quadrature.design.varying().len();
    let mean = |f: &dyn Fn(f64) -> f64| exact(values.iter().zip(&weights).map(|(&value, weight)| weight * f(value)));
    // Deviations from the first value, so that the mean keeps their digits.
    let first = values[0];
    let middle = first + mean(&|value| value - first);
    let largest = values.iter().map(|value| (value - middle).abs()).fold(0.0, f64::max);
    let rounding = 4.0 * f64::EPSILON * middle.abs();
    let of = |position: usize| quadrature.variables.variable(position);
    if largest <= rounding {
        let nothing =
            |position: usize| of(position).map(|_| MainEffect { linear: 0.0, curvature: 0.0, mean_shift: None });
        let together =
            |&(j, k): &(usize, usize)| of(j).and(of(k)).map(|_| InteractionEffect { share: 0.0, mean_shift: None });
        return Integrated {
            moments: Moments::constant(middle),
            own: (0..n).map(nothing).collect(),
            pairs: pairs.iter().map(together).collect(),
            left_out: None,
            nodes: LEVELS,
        };
    }
    // Deviations are divided by the largest, so that their squares neither overflow nor underflow.
    let sigma = largest * mean(&|value| ((value - middle) / largest).powi(2)).sqrt();
    let [skewness, kurtosis] = [3, 4].map(|order| mean(&|value| ((value - middle) / sigma).powi(order)));
    let deviations: Vec<f64> = values.iter().map(|value| (value - middle) / sigma).collect();
    let given = ConditionalMeans { grid, deviations: &deviations, weights: &weights, rules: &rules };
    let own: Vec<Option<(MainEffect, Vec<f64>)>> = (0..n)
        .into_par_iter()
        .map(|position| {
            let v = of(position)?;
            let (part, rule) = (given.one(v), rules[v]);
            let over = |f: &dyn Fn(usize) -> f64| -> f64 {
                rule.weights.iter().enumerate().map(|(level, weight)| weight * f(level)).sum()
            };
            let slope = over(&|level| part[level] * rule.nodes[level]);
            let curvature = over(&|level| (part[level] - slope * rule.nodes[level]).powi(2));
            Some((MainEffect { linear: slope * slope, curvature, mean_shift: None }, part))
        })
        .collect();
    let joints: Vec<Option<InteractionEffect>> = pairs
        .par_iter()
        .map(|&(j, k)| {
            let ((_, of_j), (_, of_k)) = (own[j].as_ref()?, own[k].as_ref()?);
            Some(InteractionEffect { share: given.two([of(j)?, of(k)?], of_j, of_k), mean_shift: None })
        })
        .collect();
    let own: Vec<Option<MainEffect>> = own.into_iter().map(|own| Some(own?.0)).collect();
    let shares = own.iter().map(|own| Some(own.as_ref()?.linear + own.as_ref()?.curvature));
    // The remainder is known only if no input is correlated.
    let known: Option<Vec<f64>> = shares.chain(joints.iter().map(|joint| Some(joint.as_ref()?.share))).collect();
    Integrated {
        moments: Moments::new(middle, sigma, skewness, kurtosis - 3.0),
        own,
        pairs: joints,
        left_out: known.map(|shares| (1.0 - exact(shares)).max(0.0)),
        nodes: quadrature.variables.longest(),
    }
}

/// Conditional means of the characteristic, in sigmas.
struct ConditionalMeans<'g> {
    grid: &'g Grid,
    deviations: &'g [f64],
    weights: &'g [f64],
    rules: &'g [&'g Rule],
}

impl ConditionalMeans<'_> {
    /// Returns the conditional mean at every level of a variable.
    fn one(&self, v: usize) -> Vec<f64> {
        let stride = self.grid.stride(v);
        let mut sums = vec![0.0; self.grid.levels[v]];
        for (place, (deviation, weight)) in self.deviations.iter().zip(self.weights).enumerate() {
            sums[self.grid.level(place, v, stride)] += weight * deviation;
        }
        sums.iter().zip(&self.rules[v].weights).map(|(sum, weight)| sum / weight).collect()
    }

    /// Returns the variance of the joint effect of two variables, beyond the effect of each by itself.
    fn two(&self, [v, w]: [usize; 2], of_v: &[f64], of_w: &[f64]) -> f64 {
        let strides = [self.grid.stride(v), self.grid.stride(w)];
        let columns = self.grid.levels[w];
        let mut sums = vec![0.0; self.grid.levels[v] * columns];
        for (place, (deviation, weight)) in self.deviations.iter().zip(self.weights).enumerate() {
            let (a, b) = (self.grid.level(place, v, strides[0]), self.grid.level(place, w, strides[1]));
            sums[a * columns + b] += weight * deviation;
        }
        let share = |(at, sum): (usize, &f64)| {
            let (a, b) = (at / columns, at % columns);
            let weight = self.rules[v].weights[a] * self.rules[w].weights[b];
            weight * (sum / weight - of_v[a] - of_w[b]).powi(2)
        };
        sums.iter().enumerate().map(share).sum()
    }
}
