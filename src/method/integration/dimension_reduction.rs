//! `dimension-reduction`: the function along every axis, integrated by Gauss rules of the inputs' own distributions.
//!
//! ```text
//! y ~ sum_j f(mean, .., x_j, .., mean) - (N-1) f(mean) = f0 + sum_j g_j(x_j)
//! ```
//!
//! Univariate dimension reduction: Rahman and Xu (2004), "A univariate dimension-reduction method for multi-dimensional integration in
//! stochastic mechanics", Probabilistic Engineering Mechanics 19, equations 5 and 13.
//!
//! They integrate raw moments through a recurrence of binomials. Here each part is integrated about its own mean by one-dimensional
//! quadrature, and the cumulants of the parts are added, so that no digits cancel. The result is exact for sums of functions of one
//! dimension each, within the exactness of the rules: a rule of m nodes integrates the fourth power exactly up to degree 2m-1. Joint
//! effects of two dimensions are left out.
//!
//! Correlated inputs are moved along the eigenvectors of their correlation, with 2 or 4 points a direction and the centre: Youn, Xi and
//! Wang (2008), "Eigenvector dimension reduction (EDR) method for sensitivity-free probability analysis", Structural and Multidisciplinary
//! Optimization 37. They take the eigenvectors of the covariance, which depend on the units of the dimensions, and put a stepwise moving
//! least-squares curve through the samples. Here the eigenvectors are those of the correlation of the underlying normal variables (Nataf),
//! which do not depend on units, and the samples are the nodes of the rules themselves. If two eigenvalues are equal, the inputs do not
//! determine the directions of the two.
//!
//! Evaluations: m-1 for every symmetric input (m is odd, and the middle node is the mean), m for every other one, and 1.

use std::sync::Arc;

use crate::assembly::Run;
use crate::method::integration::quadrature::{Quadrature, check, complete};
use crate::method::{Integrated, Lacking, MainEffect, Method, MethodError, Options, Outcome, Procedure};
use crate::plan::{KnownAnswers, Plan, Point};
use crate::problem::Problem;
use sensitol_numeric::distribution::Rule;
use sensitol_numeric::moments::{Interactions, Term, contributions};

pub(in crate::method) struct DimensionReduction;

/// Number of nodes of a rule if the options give none.
pub(in crate::method) const NODES: usize = 5;

impl Procedure for DimensionReduction {
    fn method(&self) -> Method {
        Method::DimensionReduction
    }

    fn about(&self) -> &'static str {
        "every dimension by itself, integrated by its own Gauss rule"
    }

    fn count(&self) -> &'static str {
        "4N+1 with 5 nodes"
    }

    fn check(&self, problem: &Problem, options: &Options) -> Result<(), MethodError> {
        check(self.name(), problem, options, true)
    }

    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError> {
        self.check(problem, options)?;
        let mut quadrature = univariate(problem, options);
        quadrature.cuts();
        Ok(Arc::new(quadrature.design))
    }

    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
        self.check(problem, options)?;
        let mut quadrature = univariate(problem, options);
        let cuts = quadrature.cuts();
        let evaluated = quadrature.evaluated(self.name(), problem, options, run)?;
        let found = (0..problem.characteristics().len())
            .map(|c| (integrated(&quadrature, &cuts, &evaluated.known, c), Vec::new()))
            .collect();
        Ok(quadrature.outcome(self.method(), options, evaluated, Vec::new(), found))
    }
}

/// Returns the variables with their rules, and the point between the nodes.
pub(in crate::method) fn univariate<'p>(problem: &'p Problem, options: &Options) -> Quadrature<'p> {
    let nodes = options.nodes.unwrap_or(NODES);
    Quadrature::new(problem, options, |distribution| Rule::of(distribution, nodes), nodes, true)
}

/// Returns the value at the reference, and for every variable the rises above it at the nodes. Returns None if the reference has no value.
pub(in crate::method) fn tables(
    quadrature: &Quadrature<'_>,
    cuts: &[Vec<Point>],
    known: &KnownAnswers,
    c: usize,
) -> Option<(f64, Vec<Vec<Option<f64>>>)> {
    let reference = known.value(&quadrature.reference, c)?;
    let table = |(v, points): (usize, &Vec<Point>)| match quadrature.variables.depends(&quadrature.design, c, v) {
        true => Quadrature::rises(known, c, points, reference),
        false => vec![Some(0.0); points.len()],
    };
    Some((reference, cuts.iter().enumerate().map(table).collect()))
}

fn integrated(
    quadrature: &Quadrature<'_>,
    cuts: &[Vec<Point>],
    known: &KnownAnswers,
    c: usize,
) -> Result<Integrated, Lacking> {
    let of = 1 + cuts.iter().map(Vec::len).sum::<usize>();
    let (reference, tables) = tables(quadrature, cuts, known, c).ok_or(Lacking::Points { lost: 1, of })?;
    complete(tables.iter().flatten().map(Option::is_some))?;
    let variables = &quadrature.variables.all;
    let terms: Vec<Term<'_>> = (variables.iter().zip(tables))
        .map(|(variable, table)| Term::Tabulated {
            values: table.into_iter().flatten().collect(),
            rule: &variable.rule,
            moments: &variable.moments,
        })
        .collect();
    let all = contributions(reference, &terms, &Interactions::none(terms.len()));
    let n = quadrature.design.varying().len();
    let mut own = vec![None; n];
    for v in 0..variables.len() {
        if let Some(position) = quadrature.variables.position(v) {
            let (linear, curvature) = (all.linear[v], all.curvature[v]);
            own[position] = Some(MainEffect { linear, curvature, mean_shift: Some(all.mean_shift[v]) });
        }
    }
    let alone = (0..n).all(|j| (j + 1..n).all(|k| !quadrature.design.joint(c, j, k)));
    let (left_out, nodes) = (alone.then_some(0.0), quadrature.variables.longest());
    Ok(Integrated { moments: all.moments, own, pairs: Vec::new(), left_out, nodes })
}
