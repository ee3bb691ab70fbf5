//! What the derivative methods share: a difference plan, evaluated and fitted.

use super::auto::Climbed;
use super::exact::{ExactDerivatives, fits, known};
use super::{DerivativeSource, Method, MethodError, Options, Pairs, Procedure};
use crate::assembly::Run;
use crate::evaluation::{Evaluated, evaluate};
use crate::moments::Interactions;
use crate::names::nearest;
use crate::plan::{DifferencePlan, Layout, PairChoice, Point, Spread, Stencil};
use crate::problem::Problem;
use crate::surrogate::{Surrogate, Univariate};

/// What the assembly function knows of every characteristic's derivatives.
type Known = Vec<Option<ExactDerivatives>>;

/// How much of the derivatives a method makes use of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Slopes only.
    First,
    /// Curvatures and interactions too.
    Second,
}

/// A derivative method: what it evaluates, and what it uses of that.
pub(super) struct Ladder {
    pub(super) method: Method,
    /// The method that it stands for: itself, but for `auto`.
    pub(super) runs: Method,
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    pub(super) count: &'static str,
    pub(super) spread: Spread,
    pub(super) interactions: Examined,
    pub(super) order: Order,
}

/// Which interactions a method examines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Examined {
    None,
    All(Stencil),
    /// As many as there are dimensions, chosen and evaluated as the options say.
    Chosen,
}

/// What a method found out.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The method that was asked for.
    pub asked: Method,
    /// The method that was run.
    pub method: Method,
    /// What it planned.
    pub plan: DifferencePlan,
    /// What it evaluated.
    pub evaluated: Evaluated,
    /// How much of it the surrogates use.
    pub order: Order,
    /// For every characteristic what is known of it.
    pub fitted: Vec<Fitted>,
    /// The pairs that were examined, as positions among the varying dimensions.
    pub pairs: Vec<(usize, usize)>,
    /// Whether the moments come from exact derivatives rather than differences.
    pub exact: bool,
    /// How `auto` came to its result; None for any other method.
    pub climbed: Option<Climbed>,
}

/// What is known of one characteristic.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// Its value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// Its value with every dimension at its mean.
    pub centre: Option<f64>,
    /// The derivatives at the means as the assembly function knows them; None where it does not, or was not asked.
    pub exact: Option<ExactDerivatives>,
    /// Every dimension's own part, in the problem's order; None where it is unknown or was not asked for.
    pub parts: Vec<Option<Univariate>>,
    /// The mixed derivatives of the pairs examined, in sigma units; None where lost.
    pub mixed: Vec<Option<crate::plan::Mixed>>,
    /// The surrogate over the varying dimensions; None without a value at the means.
    pub surrogate: Option<Surrogate>,
}

impl Procedure for Ladder {
    fn method(&self) -> Method {
        self.method
    }

    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> &'static str {
        self.about
    }

    fn count(&self) -> &'static str {
        self.count
    }

    fn plan(&self, problem: &Problem, options: &Options) -> Result<DifferencePlan, MethodError> {
        if let Some(step) = options.step.filter(|step| !(step.is_finite() && *step > 0.0)) {
            return Err(MethodError::BadStep { step });
        }
        fits(options.derivatives, "step", options.step.is_some())?;
        fits(options.derivatives, "stencil", options.stencil.is_some())?;
        let (spread, pairs, stencil) = self.differences(problem, options)?;
        let exact = options.derivatives == Some(DerivativeSource::Exact);
        let spread = if exact { Spread::Bare } else { spread };
        let layout = Layout { spread, pairs, stencil, step: options.step, fixed_too: options.all_sensitivities };
        Ok(DifferencePlan::new(problem.dimensions(), problem.correlation(), problem.dependence(), layout))
    }

    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
        let plan = self.plan(problem, options)?;
        let needed = plan.cost().0;
        if let Some(budget) = options.budget.filter(|&budget| needed > budget) {
            return Err(MethodError::OverBudget {
                method: self.name,
                needed,
                budget,
                fitting: fitting(problem, budget),
            });
        }
        problem.function().prepare(problem.outputs()).map_err(|error| MethodError::Model { error })?;
        let exact = options.derivatives == Some(DerivativeSource::Exact);
        if exact {
            known(problem, &plan)?;
        }
        let evaluated = evaluate(problem, &plan, run);
        let (pairs, derivatives) = self.derivatives(problem, options, &plan, &evaluated)?;
        let fit = |(c, derivatives)| self.fit(&plan, &evaluated, c, &pairs, derivatives, exact);
        let fitted = derivatives.into_iter().enumerate().map(fit).collect();
        Ok(Outcome {
            asked: self.method,
            method: self.runs,
            plan,
            evaluated,
            order: self.order,
            fitted,
            pairs,
            exact,
            climbed: None,
        })
    }
}

impl Ladder {
    fn differences(&self, problem: &Problem, options: &Options) -> Result<(Spread, PairChoice, Stencil), MethodError> {
        let refused =
            |option| Err(MethodError::OptionDoesNotApply { method: self.name, option, only: Method::SixN.name() });
        match (self.interactions, &options.pairs, options.stencil) {
            (Examined::Chosen, pairs, stencil) => {
                let pairs = pairs.as_ref().map_or(Ok(PairChoice::Strongest), |pairs| choice(problem, pairs))?;
                // The published scheme spends the same 6N+1: two nodes on an axis, four on a pair.
                let stencil = stencil.unwrap_or(Stencil::TwoPoint);
                let spread = if stencil == Stencil::FourPoint { Spread::Pair } else { self.spread };
                Ok((spread, pairs, stencil))
            }
            (_, Some(_), _) => refused("pairs"),
            (_, None, Some(_)) => refused("stencil"),
            (Examined::None, None, None) => Ok((self.spread, PairChoice::None, Stencil::TwoPoint)),
            (Examined::All(stencil), None, None) => Ok((self.spread, PairChoice::All, stencil)),
        }
    }

    /// The pairs that are examined, and the exact derivatives of every characteristic as far as they are wanted.
    fn derivatives(
        &self,
        problem: &Problem,
        options: &Options,
        plan: &DifferencePlan,
        evaluated: &Evaluated,
    ) -> Result<(Vec<(usize, usize)>, Known), MethodError> {
        if options.derivatives == Some(DerivativeSource::Difference) {
            return Ok((plan.pairs(Some(&evaluated.known)), vec![None; problem.characteristics().len()]));
        }
        let mut all = ExactDerivatives::of(problem, plan);
        if options.derivatives.is_none() {
            let pairs = plan.pairs(Some(&evaluated.known));
            ExactDerivatives::add_pairs(&mut all, problem, plan, &pairs);
            return Ok((pairs, all));
        }
        let pairs = plan.pairs_by(Some(&|c, d| all[c].as_ref()?.part(plan, d)));
        ExactDerivatives::add_pairs(&mut all, problem, plan, &pairs);
        for (c, exact) in all.iter().enumerate() {
            // Without a value at the means there is nothing to differentiate, and the report says so.
            let valued = evaluated.known.value(&Point::Centre, c).is_some();
            if let Some(lacking) =
                exact.as_ref().filter(|_| valued).and_then(|exact| exact.lacking(problem, plan, c, self.order, &pairs))
            {
                return Err(lacking);
            }
        }
        Ok((pairs, all))
    }

    fn fit(
        &self,
        plan: &DifferencePlan,
        evaluated: &Evaluated,
        c: usize,
        pairs: &[(usize, usize)],
        derivatives: Option<ExactDerivatives>,
        exact: bool,
    ) -> Fitted {
        let known = &evaluated.known;
        let dimensions = plan.centre().len();
        let exactly = derivatives.as_ref().filter(|_| exact);
        let part = |d: usize| match exactly {
            Some(derivatives) if plan.depends(c, d) => derivatives.part(plan, d),
            _ => plan.part(known, c, d),
        };
        let parts: Vec<Option<Univariate>> = (0..dimensions).map(part).collect();
        let mixed = exactly.map_or_else(|| plan.mixed(known, c, pairs), |exact| exact.mixed(plan, pairs));
        let used = |&d: &usize| match self.order {
            Order::First => parts[d].map(|part| Univariate::of_coefficients(&[part.slope()])),
            Order::Second => parts[d],
        };
        let products = pairs.iter().zip(&mixed).filter_map(|(&(j, k), mixed)| Some((j, k, mixed.as_ref()?.value)));
        let centre = known.value(&Point::Centre, c);
        let surrogate = centre.map(|centre| Surrogate {
            centre,
            parts: plan.varying().iter().map(used).collect(),
            interactions: Interactions::of_pairs(plan.varying().len(), products.filter(|&(_, _, value)| value != 0.0)),
        });
        Fitted { nominal: known.value(plan.nominal(), c), centre, exact: derivatives, parts, mixed, surrogate }
    }
}

/// The method with the most evaluations that the budget allows.
pub(super) fn fitting(problem: &Problem, budget: usize) -> Option<(&'static str, usize)> {
    [Method::Full, Method::SixN, Method::SecondOrder]
        .into_iter()
        .filter_map(|method| {
            let cost = method.procedure().plan(problem, &Options::from(method)).ok()?.cost().0;
            (cost <= budget).then_some((method.name(), cost))
        })
        .max_by_key(|&(_, cost)| cost)
}

/// The pairs as indices of dimensions that vary.
fn choice(problem: &Problem, pairs: &Pairs) -> Result<PairChoice, MethodError> {
    let Pairs::Listed(listed) = pairs else {
        return Ok(if *pairs == Pairs::Adjacent { PairChoice::Adjacent } else { PairChoice::Strongest });
    };
    let dependence = problem.dependence();
    let dimensions = problem.dimensions();
    let resolve = |(a, b): &(String, String)| {
        let index = |name: &String| {
            let index = dimensions.iter().position(|dimension| dimension.name() == name);
            let Some(index) = index else {
                let nearest = nearest(name, dimensions.iter().map(|dimension| dimension.name())).map(str::to_owned);
                let (a, b, unknown) = (a.clone(), b.clone(), name.clone());
                return Err(MethodError::UnknownPair { a, b, unknown, nearest });
            };
            let idle = dimensions[index].sigma() == 0.0 || !dependence.iter().any(|row| row[index]);
            if idle || a == b {
                return Err(MethodError::IdlePair { a: a.clone(), b: b.clone(), still: name.clone() });
            }
            Ok(index)
        };
        Ok((index(a)?, index(b)?))
    };
    Ok(PairChoice::Listed(listed.iter().map(resolve).collect::<Result<_, _>>()?))
}
