//! `bivariate-dimension-reduction`: the function in every plane of two axes, integrated by products of Gauss rules.
//!
//! ```text
//! y ~ sum_{j<k} f(x_j, x_k) - (N-2) sum_j f(x_j) + (N-1)(N-2)/2 f0 = f0 + sum_j g_j(x_j) + sum_{j<k} g_jk(x_j, x_k)
//! g_j = f(x_j) - f0,   g_jk = f(x_j, x_k) - f(x_j) - f(x_k) + f0
//! ```
//!
//! All dimensions that are not arguments are at their means. Source: equation 21 with S = 2 of Xu and Rahman (2004), "A generalized
//! dimension-reduction method for multidimensional integration in stochastic mechanics", International Journal for Numerical Methods in
//! Engineering 61.
//!
//! They integrate powers of the function itself plane by plane (their equation 26). Here all four moments are those of the decomposition,
//! exact at the nodes of the rules ([`Tables`](sensitol_numeric::moments::Tables)). Third and fourth moments therefore include products of
//! planes that share one or two dimensions. All moments are exact for functions whose terms have two dimensions each, within the exactness
//! of the rules. Joint effects of three dimensions are left out.
//!
//! Correlated inputs are transformed by eigenvectors, as in `dimension-reduction`.
//!
//! Evaluations: `1 + sum_j n_j + sum_{j<k} n_j n_k`, with n_j nodes of input j beside its mean. n_j is 4 for symmetric inputs and 5 for
//! others, unless `--nodes` sets another rule. A pair on which no characteristic depends jointly costs nothing.

use std::sync::Arc;

use crate::assembly::Run;
use crate::method::cost::affordable;
use crate::method::integration::dimension_reduction::{tables, univariate};
use crate::method::integration::quadrature::{Quadrature, check, complete, next_to_the_mean};
use crate::method::{
    Integrated, InteractionEffect, Lacking, MainEffect, Method, MethodError, Options, Outcome, Procedure,
};
use crate::plan::{KnownAnswers, Mixed, Plan, Point, Purpose};
use crate::problem::Problem;
use sensitol_numeric::moments::Tables;

pub(in crate::method) struct BivariateDimensionReduction;

/// Two variables and the points at their nodes. The node of the second variable changes fastest.
struct Plane {
    v: usize,
    w: usize,
    points: Vec<Point>,
}

/// Points of all axes and planes.
struct Planes<'p> {
    quadrature: Quadrature<'p>,
    cuts: Vec<Vec<Point>>,
    planes: Vec<Plane>,
}

impl Procedure for BivariateDimensionReduction {
    fn method(&self) -> Method {
        Method::BivariateDimensionReduction
    }

    fn about(&self) -> &'static str {
        "every two dimensions together, integrated by products of their Gauss rules"
    }

    fn count(&self) -> &'static str {
        "8N^2-4N+1 with 5 nodes"
    }

    fn check(&self, problem: &Problem, options: &Options) -> Result<(), MethodError> {
        check(self.name(), problem, options, true)
    }

    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError> {
        Ok(Arc::new(self.planes(problem, options)?.quadrature.design))
    }

    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
        let Planes { quadrature, cuts, planes } = self.planes(problem, options)?;
        let evaluated = quadrature.evaluated(self.name(), problem, options, run)?;
        let pairs = quadrature.design.pairs();
        let found = (0..problem.characteristics().len())
            .map(|c| {
                let known = &evaluated.known;
                match Decomposed::of(&quadrature, &cuts, &planes, known, c) {
                    Ok(decomposed) => {
                        (Ok(decomposed.integrated(&quadrature, &pairs)), decomposed.mixed(&quadrature, &pairs))
                    }
                    Err(lacking) => (Err(lacking), vec![None; pairs.len()]),
                }
            })
            .collect();
        Ok(quadrature.outcome(self.method(), options, evaluated, pairs, found))
    }
}

impl BivariateDimensionReduction {
    fn planes<'p>(&self, problem: &'p Problem, options: &Options) -> Result<Planes<'p>, MethodError> {
        self.check(problem, options)?;
        let mut quadrature = univariate(problem, options);
        let variables = quadrature.variables.all.len();
        let depends = |c: usize, v: usize| quadrature.variables.depends(&quadrature.design, c, v);
        let matters = |v: usize, w: usize| (0..problem.characteristics().len()).any(|c| depends(c, v) && depends(c, w));
        let pairs: Vec<(usize, usize)> = (0..variables)
            .flat_map(|v| (v + 1..variables).map(move |w| (v, w)))
            .filter(|&(v, w)| matters(v, w))
            .collect();
        let elsewhere = |v: usize| quadrature.variables.nodes_elsewhere(v) as u128;
        let needed = 1
            + (0..variables).map(elsewhere).sum::<u128>()
            + pairs.iter().map(|&(v, w)| elsewhere(v) * elsewhere(w)).sum::<u128>();
        affordable(self.name(), needed, problem, options, quadrature.design.varying().len())?;
        let cuts = quadrature.cuts();
        let nodes = |v: usize| quadrature.variables.all[v].rule.nodes.len();
        let counts: Vec<usize> = (0..variables).map(nodes).collect();
        let planes = pairs
            .into_iter()
            .map(|(v, w)| {
                let places = (0..counts[v]).flat_map(|a| (0..counts[w]).map(move |b| (a, b)));
                let points = places.map(|(a, b)| quadrature.want(&[(v, a), (w, b)], Purpose::Plane)).collect();
                Plane { v, w, points }
            })
            .collect();
        Ok(Planes { quadrature, cuts, planes })
    }
}

/// Decomposition of one characteristic into univariate and bivariate parts, at the nodes.
struct Decomposed {
    reference: f64,
    own: Vec<Vec<f64>>,
    /// Joint parts `g_jk` of every pair of variables on which the characteristic depends.
    pairs: Vec<(usize, usize, Vec<f64>)>,
}

impl Decomposed {
    fn of(
        quadrature: &Quadrature<'_>,
        cuts: &[Vec<Point>],
        planes: &[Plane],
        known: &KnownAnswers,
        c: usize,
    ) -> Result<Self, Lacking> {
        let depends = |v: usize| quadrature.variables.depends(&quadrature.design, c, v);
        let of = 1 + cuts.iter().map(Vec::len).sum::<usize>();
        let (reference, own) = tables(quadrature, cuts, known, c).ok_or(Lacking::Points { lost: 1, of })?;
        let mine: Vec<&Plane> = planes.iter().filter(|plane| depends(plane.v) && depends(plane.w)).collect();
        let both: Vec<Vec<Option<f64>>> =
            mine.iter().map(|plane| Quadrature::rises(known, c, &plane.points, reference)).collect();
        complete(own.iter().chain(&both).flatten().map(Option::is_some))?;
        let own: Vec<Vec<f64>> = own.into_iter().map(|table| table.into_iter().flatten().collect()).collect();
        let together = |(plane, rises): (&&Plane, Vec<Option<f64>>)| {
            let (of_v, of_w) = (&own[plane.v], &own[plane.w]);
            let table = rises.into_iter().flatten().enumerate();
            let table = table.map(|(at, rise)| rise - of_v[at / of_w.len()] - of_w[at % of_w.len()]).collect();
            (plane.v, plane.w, table)
        };
        let pairs = mine.iter().zip(both).map(together).collect();
        Ok(Self { reference, own, pairs })
    }

    fn integrated(&self, quadrature: &Quadrature<'_>, pairs: &[(usize, usize)]) -> Integrated {
        let variables = &quadrature.variables.all;
        let tables = Tables {
            constant: self.reference,
            weights: variables.iter().map(|variable| &variable.rule.weights[..]).collect(),
            own: self.own.clone(),
            pairs: self.pairs.clone(),
        };
        // Tables are in the order of the variables, the outcome in the order of the dimensions.
        let found = tables.moments();
        let n = quadrature.design.varying().len();
        let mut own = vec![None; n];
        for (v, variable) in variables.iter().enumerate() {
            if let Some(position) = quadrature.variables.position(v) {
                let rule = &variable.rule;
                let mean = |f: &dyn Fn(usize) -> f64| -> f64 {
                    rule.weights.iter().enumerate().map(|(i, weight)| weight * f(i)).sum()
                };
                let part = &found.own[v];
                let slope = mean(&|i| part[i] * rule.nodes[i]);
                let curvature = mean(&|i| (part[i] - slope * rule.nodes[i]).powi(2));
                let mean_shift = Some(mean(&|i| self.own[v][i]));
                own[position] = Some(MainEffect { linear: slope * slope, curvature, mean_shift });
            }
        }
        let joint = |&pair: &(usize, usize)| {
            own[pair.0].as_ref().and(own[pair.1].as_ref())?;
            let place = self.place(quadrature, pair);
            Some(place.map_or(InteractionEffect { share: 0.0, mean_shift: Some(0.0) }, |place| InteractionEffect {
                share: found.shares[place],
                mean_shift: Some(found.mean_shifts[place]),
            }))
        };
        let joints: Vec<Option<InteractionEffect>> = pairs.iter().map(joint).collect();
        let left_out = own.iter().all(Option::is_some).then_some(0.0);
        Integrated { moments: found.moments, own, pairs: joints, left_out, nodes: quadrature.variables.longest() }
    }

    /// Returns the index of the joint part of a pair of dimensions, or None if the characteristic does not depend on both.
    fn place(&self, quadrature: &Quadrature<'_>, (j, k): (usize, usize)) -> Option<usize> {
        let pair = (quadrature.variables.variable(j)?, quadrature.variables.variable(k)?);
        self.pairs.binary_search_by_key(&pair, |&(v, w, _)| (v, w)).ok()
    }

    /// Returns mixed derivatives from the four corners next to the means, in sigmas.
    fn mixed(&self, quadrature: &Quadrature<'_>, pairs: &[(usize, usize)]) -> Vec<Option<Mixed>> {
        let at_means = quadrature.reference == Point::Centre;
        let variables = &quadrature.variables.all;
        let mixed = |&pair: &(usize, usize)| {
            let Some(place) = self.place(quadrature, pair) else {
                let [j, k] = [pair.0, pair.1].map(|position| quadrature.variables.variable(position));
                return j.and(k).map(|_| Mixed::exact(0.0));
            };
            let (v, w, table) = &self.pairs[place];
            let (of_v, of_w) = (&variables[*v].rule, &variables[*w].rule);
            let (mut sum, mut weight, mut found) = (0.0, 0.0, 0);
            for a in next_to_the_mean(of_v).into_iter().flatten() {
                for b in next_to_the_mean(of_w).into_iter().flatten() {
                    let product = of_v.nodes[a] * of_w.nodes[b];
                    sum += product.signum() * table[a * of_w.nodes.len() + b];
                    weight += product.abs();
                    found += 1;
                }
            }
            (at_means && found > 0).then(|| Mixed { complete: found == 4, ..Mixed::evaluated(sum / weight) })
        };
        pairs.iter().map(mixed).collect()
    }
}
