//! `auto`: as few evaluations as the requested accuracy takes.
//!
//! It starts like `second-order`, with parabolas for 2N+1 evaluations. Twelve check points of the dimensions' distribution (a Latin
//! hypercube in mirrored pairs) compare the surrogate with the model. While the residuals there, and the terms that polynomials may hide,
//! exceed the target error of sigma, it adds the evaluations that are expected to help:
//!
//! - two nodes more for dimensions in which three points hide too much;
//! - interactions if even powers are left: up to twelve dimensions pair by pair, strongest first. With more dimensions, probes move all
//!   dimensions at once and a sparse model is fitted to them. The number of probes grows until a separate evaluation of every pair is
//!   nearly as cheap;
//! - two nodes more for the strongest of the other dimensions, if odd powers are left.
//!
//! With more than twelve dimensions it examines no interactions of a model that is a product, because all of them interact. If points of
//! the model may follow, a regression of its logarithm takes fewer evaluations.
//!
//! The unexplained remainder adds to the variance, and is the estimate of the error. All points belong to a fixed design: the same study
//! gives the same numbers with any seed.

mod characteristic_state;
mod chosen_points;
mod next_stage;
mod product;
mod screened_interactions;
mod screening;
mod start;

use std::sync::Arc;

use crate::assembly::Run;
use crate::evaluation::{Evaluated, Evaluator};
use crate::method::auto::characteristic_state::View;
use crate::method::auto::next_stage::Climb;
use crate::method::auto_account::{AutoAccount, ClimbEnd};
use crate::method::derivative::stages::{Examined, Ladder, Order};
use crate::method::exact_derivatives::ExactDerivatives;
use crate::method::{Basis, Cost, DerivativeSource, Fitted, Method, MethodError, Options, Outcome, Procedure};
use crate::plan::{Mixed, Plan, Point, Spread};
use crate::problem::Problem;
use crate::warning::Figure;
use start::Start;

/// Relative error of sigma that is requested if the options give none.
pub const ACCURACY: f64 = 0.01;
/// Greatest number of pairs that are listed if a product of all slopes gives every pair an interaction.
const LISTED: usize = 20_000;

pub(super) struct Auto;

pub(super) const AUTO: Auto = Auto;

/// Difference plan that it begins with.
const BASE: Ladder = Ladder {
    method: Method::Auto,
    runs: Method::Auto,
    about: "the default: buys evaluations where they lower the error of sigma most, until it is known well enough",
    count: "2N+17 for what is linear or a parabola",
    spread: Spread::Pair,
    interactions: Examined::None,
    order: Order::Second,
};

/// Difference plan with exact derivatives, all of which cost one evaluation.
const EXACT: Ladder = Ladder { interactions: Examined::All(crate::plan::Stencil::TwoPoint), ..BASE };

impl Procedure for Auto {
    fn method(&self) -> Method {
        Method::Auto
    }

    fn about(&self) -> &'static str {
        BASE.about
    }

    fn count(&self) -> &'static str {
        BASE.count
    }

    fn check(&self, problem: &Problem, options: &Options) -> Result<(), MethodError> {
        if options.derivatives == Some(DerivativeSource::Exact) {
            return EXACT.check(problem, options);
        }
        accuracy(options)?;
        BASE.check(problem, options)
    }

    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError> {
        if options.derivatives == Some(DerivativeSource::Exact) {
            return EXACT.plan(problem, options);
        }
        let climb = climb(problem, options)?;
        Ok(Arc::new(Start::of(climb, problem.characteristics().len())))
    }

    fn fits(&self, problem: &Problem, options: &Options) -> Result<Cost, MethodError> {
        if options.derivatives == Some(DerivativeSource::Exact) {
            return EXACT.fits(problem, options);
        }
        // The first points alone must be within the budget. Check points are left out if it allows no more.
        Cost::of(&BASE.differences(problem, options)?).within(self.name(), problem, options)?;
        Ok(Cost::of(&*self.plan(problem, options)?))
    }

    fn range(&self, problem: &Problem, options: &Options) -> Option<[usize; 2]> {
        if options.derivatives == Some(DerivativeSource::Exact) {
            return None;
        }
        let plan = self.plan(problem, options).ok()?;
        let least = plan.cost().0;
        Some([
            least,
            crate::method::auto::next_stage::most(plan.varying().len())
                .max(least)
                .min(options.points(problem).unwrap_or(usize::MAX)),
        ])
    }

    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
        if options.derivatives == Some(DerivativeSource::Exact) {
            return EXACT.run(problem, options, run);
        }
        climb_until(problem, options, run, &|_| 1.0)
    }
}

/// Refines until `excess` is no more than 1, as far as tightening the target error of sigma can reach that. `excess` is the largest
/// estimated error of an outcome divided by the requested one.
pub fn climb_until(
    problem: &Problem,
    options: &Options,
    run: &Run<'_>,
    excess: &dyn Fn(&Outcome) -> f64,
) -> Result<Outcome, MethodError> {
    AUTO.fits(problem, options)?;
    problem.function().prepare(problem.outputs()).map_err(|error| MethodError::Model { error })?;
    let mut climb = climb(problem, options)?;
    let evaluator = Evaluator::new(problem, run).with_budget(options.budget);
    let mut evaluated = Evaluated::nothing(problem);
    loop {
        while let Some(stage) = climb.next(&evaluated.known, &evaluator) {
            evaluated.add(&evaluator, &climb.plan, &stage);
            if evaluator.stopped().is_some() {
                break;
            }
        }
        let found = outcome(problem, options, &climb, &evaluated);
        let excess = excess(&found);
        if evaluator.stopped().is_some() || excess <= 1.0 || !climb.tighten(1.0 / excess) {
            return Ok(found);
        }
    }
}

/// Returns the target relative error of sigma, after a check of all target errors.
fn accuracy(options: &Options) -> Result<f64, MethodError> {
    let accuracy = options.accuracy.unwrap_or(ACCURACY);
    for (figure, wanted) in [(Figure::Sigma, Some(accuracy))].into_iter().chain(options.accuracies.wanted()) {
        if let Some(accuracy) = wanted.filter(|wanted| !(wanted.is_finite() && *wanted > 0.0)) {
            return Err(MethodError::BadAccuracy { figure, accuracy });
        }
    }
    Ok(accuracy)
}

fn climb<'p>(problem: &'p Problem, options: &Options) -> Result<Climb<'p>, MethodError> {
    let accuracy = accuracy(options)?;
    Ok(Climb::new(problem, BASE.differences(problem, options)?, accuracy, options))
}

/// Builds the outcome from the state of the refinement.
fn outcome(problem: &Problem, options: &Options, climb: &Climb<'_>, evaluated: &Evaluated) -> Outcome {
    let known = &evaluated.known;
    let views = climb.views(known);
    let plan = &climb.plan;
    let pairs = listed(climb, &views);
    let exact = ExactDerivatives::beside(problem, plan, options, &pairs);
    let fit = |(c, (view, exact)): (usize, (&Option<View>, Option<ExactDerivatives>))| {
        let polynomial = climb.bought.polynomial(c);
        let own = |d: usize| Some(polynomial?.parts[plan.varying().binary_search(&d).ok()?]);
        let part = |d: usize| own(d).or_else(|| plan.part(known, c, d));
        let mixed = |pair: &(usize, usize)| match (view, polynomial) {
            (Some(_), Some(polynomial)) => Some(polynomial.mixed(*pair)),
            (Some(view), _) if climb.bought.direct.binary_search(pair).is_ok() => view.products.get(pair).copied(),
            // The pair was examined in another characteristic, and not in this one.
            (Some(view), _) => Some(view.products.get(pair).copied().unwrap_or(Mixed::screened(0.0))),
            (None, _) => None,
        };
        Fitted {
            nominal: known.value(plan.nominal(), c),
            centre: known.value(&Point::Centre, c),
            exact,
            parts: (0..problem.dimensions().len()).map(part).collect(),
            mixed: pairs.iter().map(mixed).collect(),
            surrogate: view.as_ref().map(|view| view.surrogate.clone()),
            screened: view.as_ref().map_or(0, View::screened),
            ..Fitted::default()
        }
    };
    let fitted = views.iter().zip(exact).enumerate().map(fit).collect();
    let of = |what: fn(&View) -> Option<f64>| views.iter().map(|view| what(view.as_ref()?)).collect();
    let climbed = AutoAccount {
        accuracy: options.accuracy.unwrap_or(ACCURACY),
        accuracies: options.accuracies,
        rest: if evaluated.stopped().is_some() { ClimbEnd::Stopped } else { climb.rest.unwrap_or(ClimbEnd::Budget) },
        refined: (0..climb.refined.len()).filter(|&j| climb.refined[j]).collect(),
        direct: climb.bought.direct.len(),
        probes: climb.bought.judging.len() + climb.bought.fitted.len(),
        checks: climb.bought.checks.iter().flatten().filter(|point| known.tried(point)).count(),
        from_formulas: climb.pairs_by_formulas(),
        all_pairs: (0..problem.characteristics().len()).all(|c| climb.knows_all_pairs(c)),
        noise: of(|view| view.noise),
        tails: of(|view| view.tail),
        beyond: of(|view| view.beyond),
        far: climb.bought.tails.clone(),
        unscreened: of(|view| view.unscreened),
        checked: views.iter().map(|view| view.as_ref()?.check.clone()).collect(),
    };
    let outcome = Outcome {
        asked: Method::Auto,
        method: Method::Auto,
        basis: Basis::Differences,
        plan: Arc::new(climb.plan.clone()),
        evaluated: evaluated.clone(),
        order: Order::Second,
        fitted,
        pairs,
        climbed: Some(climbed),
    };
    outcome.with_proofs(problem, &climb.bought.polynomials)
}

/// Returns the pairs that a surrogate has, or that were examined. If there are too many to read, only the known ones are returned.
fn listed(climb: &Climb<'_>, views: &[Option<View>]) -> Vec<(usize, usize)> {
    let mut pairs = climb.bought.direct.clone();
    let few = views.iter().flatten().map(View::screened).sum::<usize>() <= LISTED;
    for view in views.iter().flatten() {
        let shown = view.products.iter().filter(|(_, mixed)| few || mixed.origin.is_known());
        pairs.extend(shown.map(|(&pair, _)| pair));
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}
