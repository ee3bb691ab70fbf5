//! Common part of the derivative methods: a difference plan, evaluated and fitted.

use std::sync::Arc;

use crate::assembly::Run;
use crate::evaluation::{Evaluated, Evaluator, evaluate};
pub(in crate::method) use crate::method::Order;
use crate::method::exact_derivatives::{ExactDerivatives, fits, known};
use crate::method::model_gradients as gradients;
use crate::method::polynomial_surface::PolynomialSurface;
use crate::method::{
    Basis, Cost, DerivativeSource, Fitted, Method, MethodError, NODES, Options, Outcome, Pairs, Procedure,
};
use crate::plan::{DifferencePlan, KnownAnswers, Layout, Mixed, PairChoice, Plan, Point, Spread, Stencil};
use crate::problem::Problem;
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::names::nearest;
use sensitol_numeric::surrogate::{Surrogate, Univariate};

/// Exact derivatives of every characteristic; None for one without derivatives.
type KnownDerivatives = Vec<Option<ExactDerivatives>>;

/// Univariate parts and mixed derivatives that replace those of the plan, if given.
type Elsewhere = (Option<Vec<Option<Univariate>>>, Option<Vec<Option<Mixed>>>);

/// Derivative method: its points, and the order of the derivatives that it uses.
pub(in crate::method) struct Ladder {
    pub(in crate::method) method: Method,
    /// Method that the outcome names as the one that was run.
    pub(in crate::method) runs: Method,
    pub(in crate::method) about: &'static str,
    pub(in crate::method) count: &'static str,
    pub(in crate::method) spread: Spread,
    pub(in crate::method) interactions: Examined,
    pub(in crate::method) order: Order,
}

/// Interactions that a method examines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::method) enum Examined {
    None,
    All(Stencil),
    /// One pair per dimension, chosen and evaluated as the options say.
    Chosen,
}

impl Procedure for Ladder {
    fn method(&self) -> Method {
        self.method
    }

    fn about(&self) -> &'static str {
        self.about
    }

    fn count(&self) -> &'static str {
        self.count
    }

    fn check(&self, problem: &Problem, options: &Options) -> Result<(), MethodError> {
        self.checked(problem, options).map(drop)
    }

    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError> {
        Ok(Arc::new(self.differences(problem, options)?))
    }

    fn with_gradients(&self, problem: &Problem, options: &Options) -> Option<usize> {
        self.can_use_gradients(options).then(|| self.by_gradients(problem).1.evaluations)
    }

    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
        let plan = self.differences(problem, options)?;
        let gradients = self.can_use_gradients(options);
        let evaluations = Cost::of(&plan);
        if !gradients || !problem.function().signature().costly {
            evaluations.within(self.name(), problem, options)?;
        }
        let model = problem.function().prepare(problem.outputs()).map_err(|error| MethodError::Model { error })?;
        if gradients && model.is_some_and(|model| model.gradients) {
            return self.run_by_gradients(problem, options, &plan, run);
        }
        evaluations.within(self.name(), problem, options)?;
        let exact = options.derivatives == Some(DerivativeSource::Exact);
        if exact {
            known(problem, &plan)?;
        }
        let evaluated = evaluate(&Evaluator::new(problem, run), &plan);
        let (pairs, derivatives) = self.derivatives(problem, options, &plan, &evaluated)?;
        let polynomials = PolynomialSurface::all(problem, &plan, options);
        let fit = |(c, derivatives): (usize, Option<ExactDerivatives>)| {
            let mut fitted = self.fit(&plan, &evaluated, c, &pairs, derivatives, exact);
            polynomials[c].iter().for_each(|terms| terms.replace(&mut fitted, &plan, self.order, &pairs));
            fitted
        };
        let fitted = derivatives.into_iter().enumerate().map(fit).collect();
        let basis = if exact { Basis::Exact } else { Basis::Differences };
        let (asked, method, plan) = (self.method, self.runs, Arc::new(plan) as _);
        let outcome =
            Outcome { asked, method, basis, plan, evaluated, order: self.order, fitted, pairs, climbed: None };
        Ok(outcome.with_proofs(problem, &polynomials))
    }
}

impl Ladder {
    /// True if the method needs fewer evaluations of a model that sends derivatives.
    fn can_use_gradients(&self, options: &Options) -> bool {
        let all = matches!(self.interactions, Examined::All(_)) && self.spread == Spread::Pair;
        let slopes = matches!(self.method, Method::Rss | Method::SecondOrder);
        self.method == self.runs && (all || slopes) && gradients::serve(options)
    }

    /// Returns the plan and its cost for a model that sends derivatives.
    fn by_gradients(&self, problem: &Problem) -> (DifferencePlan, Cost) {
        let spread = match (self.order, self.method) {
            (Order::First, _) => Spread::Bare,
            (Order::Second, Method::SecondOrder) => Spread::Upper,
            (Order::Second, _) => self.spread,
        };
        let layout =
            Layout { spread, pairs: PairChoice::None, stencil: Stencil::TwoPoint, step: None, fixed_too: false };
        let plan = DifferencePlan::new(problem.dimensions(), problem.correlation(), problem.dependence(), layout);
        let cost = Cost::of(&plan);
        // A point beside the means checks the slopes at the means, because there is no other point.
        let checks = usize::from(self.order == Order::First);
        (plan, Cost { evaluations: cost.evaluations + checks, ..cost })
    }

    /// Runs the method with the derivatives that the model sends. `whole` is the plan without them.
    fn run_by_gradients(
        &self,
        problem: &Problem,
        options: &Options,
        whole: &DifferencePlan,
        run: &Run<'_>,
    ) -> Result<Outcome, MethodError> {
        let (plan, cost) = self.by_gradients(problem);
        cost.within(self.name(), problem, options)?;
        let first = self.order == Order::First;
        let one_node = self.method == Method::SecondOrder;
        let evaluator = Evaluator::new(problem, run);
        let mut evaluated = evaluate(&evaluator, &plan);
        let pairs = whole.pairs(None);
        let fitted: Vec<Fitted> = if first {
            let slopes = gradients::slopes(problem, &plan, &mut evaluated, &evaluator)?;
            let fit = |(c, slopes)| self.fit(&plan, &evaluated, c, &pairs, slopes, true);
            // Derivatives that a model sends are answers of the model.
            slopes.into_iter().enumerate().map(fit).map(Fitted::evaluated).collect()
        } else {
            gradients::checked(problem, &plan, &evaluated)?;
            let fit = |c| {
                let all = || (0..plan.centre().len()).map(|d| gradients::part(&plan, &evaluated, c, d)).collect();
                let (parts, mixed) = (one_node.then(all), gradients::mixed(&plan, &evaluated, c, &pairs));
                self.fitted(&plan, &evaluated, c, &pairs, (None, false), (parts, Some(mixed)))
            };
            (0..problem.characteristics().len()).map(fit).collect()
        };
        let basis = if first { Basis::Exact } else { Basis::Differences };
        let (asked, method, plan) = (self.method, self.runs, Arc::new(plan) as _);
        let outcome =
            Outcome { asked, method, basis, plan, evaluated, order: self.order, fitted, pairs, climbed: None };
        let polynomials = vec![None; problem.characteristics().len()];
        Ok(outcome.with_proofs(problem, &polynomials))
    }

    /// Returns the difference plan that the method follows.
    pub(in crate::method) fn differences(
        &self,
        problem: &Problem,
        options: &Options,
    ) -> Result<DifferencePlan, MethodError> {
        let layout = self.checked(problem, options)?;
        Ok(DifferencePlan::new(problem.dimensions(), problem.correlation(), problem.dependence(), layout))
    }

    /// Returns the layout of the points, once the options are checked.
    fn checked(&self, problem: &Problem, options: &Options) -> Result<Layout, MethodError> {
        if let Some(step) = options.step.filter(|step| !(step.is_finite() && *step > 0.0)) {
            return Err(MethodError::BadStep { step });
        }
        if options.nodes.is_some() {
            return Err(MethodError::OptionDoesNotApply { method: self.name(), option: "nodes", only: NODES });
        }
        fits(options.derivatives, "step", options.step.is_some())?;
        fits(options.derivatives, "stencil", options.stencil.is_some())?;
        let (spread, pairs, stencil) = self.layout(problem, options)?;
        let exact = options.derivatives == Some(DerivativeSource::Exact);
        let spread = if exact { Spread::Bare } else { spread };
        Ok(Layout { spread, pairs, stencil, step: options.step, fixed_too: options.all_sensitivities })
    }

    fn layout(&self, problem: &Problem, options: &Options) -> Result<(Spread, PairChoice, Stencil), MethodError> {
        let refused =
            |option| Err(MethodError::OptionDoesNotApply { method: self.name(), option, only: Method::SixN.name() });
        match (self.interactions, &options.pairs, options.stencil) {
            (Examined::Chosen, pairs, stencil) => {
                let pairs = pairs.as_ref().map_or(Ok(PairChoice::Strongest), |pairs| choice(problem, pairs))?;
                // The published scheme takes 6N+1 evaluations too: two nodes on an axis, four on a pair.
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

    /// Returns the pairs that are examined, and the exact derivatives of every characteristic if they are requested.
    fn derivatives(
        &self,
        problem: &Problem,
        options: &Options,
        plan: &DifferencePlan,
        evaluated: &Evaluated,
    ) -> Result<(Vec<(usize, usize)>, KnownDerivatives), MethodError> {
        if options.derivatives == Some(DerivativeSource::Difference) {
            return Ok((plan.pairs(Some(&evaluated.known)), vec![None; problem.characteristics().len()]));
        }
        let mut all = ExactDerivatives::of(problem, plan);
        if options.derivatives.is_none() {
            let mut pairs = plan.pairs(Some(&evaluated.known));
            if self.order == Order::Second {
                let known = ExactDerivatives::known_pairs(problem, plan, options);
                let more: Vec<_> = known.into_iter().filter(|pair| !pairs.contains(pair)).collect();
                pairs.extend(more);
            }
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

    /// Returns mixed derivatives by differences. Pairs that are known to interact and were not evaluated have exact ones.
    fn differences_of(
        &self,
        plan: &DifferencePlan,
        known: &KnownAnswers,
        c: usize,
        pairs: &[(usize, usize)],
        exact: Option<&ExactDerivatives>,
    ) -> Vec<Option<Mixed>> {
        let evaluated = plan.pairs(Some(known)).len();
        let mut mixed = plan.mixed(known, c, &pairs[..evaluated.min(pairs.len())]);
        if pairs.len() > mixed.len() {
            let exact = exact.filter(|exact| exact.mixed.len() == pairs.len()).map(|exact| exact.mixed(plan, pairs));
            // The pair is known to interact in another characteristic and was not examined in this one.
            let nothing = Some(Mixed::screened(0.0));
            let rest = (mixed.len()..pairs.len()).map(|index| exact.as_ref().and_then(|all| all[index]).or(nothing));
            mixed.extend(rest.collect::<Vec<_>>());
        }
        mixed
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
        self.fitted(plan, evaluated, c, pairs, (derivatives, exact), (None, None))
    }

    /// Fits one characteristic. `parts` and `mixed` replace the derivatives of the plan if they are given.
    fn fitted(
        &self,
        plan: &DifferencePlan,
        evaluated: &Evaluated,
        c: usize,
        pairs: &[(usize, usize)],
        (derivatives, exact): (Option<ExactDerivatives>, bool),
        (parts, mixed): Elsewhere,
    ) -> Fitted {
        let known = &evaluated.known;
        let dimensions = plan.centre().len();
        let exactly = derivatives.as_ref().filter(|_| exact);
        let part = |d: usize| match exactly {
            Some(derivatives) if plan.depends(c, d) => derivatives.part(plan, d),
            _ => plan.part(known, c, d),
        };
        let parts: Vec<Option<Univariate>> = parts.unwrap_or_else(|| (0..dimensions).map(part).collect());
        let mixed = mixed.unwrap_or_else(|| match (exactly, &derivatives) {
            (Some(exact), _) => exact.mixed(plan, pairs),
            (None, exact) => self.differences_of(plan, known, c, pairs, exact.as_ref()),
        });
        let used = |&d: &usize| parts[d].map(|part| self.order.used(part));
        let products = pairs.iter().zip(&mixed).filter_map(|(&(j, k), mixed)| Some((j, k, mixed.as_ref()?.value)));
        let centre = known.value(&Point::Centre, c);
        let surrogate = centre.map(|centre| Surrogate {
            centre,
            parts: plan.varying().iter().map(used).collect(),
            interactions: Interactions::of_pairs(plan.varying().len(), products.filter(|&(_, _, value)| value != 0.0)),
        });
        let nominal = known.value(plan.nominal(), c);
        Fitted { nominal, centre, exact: derivatives, parts, mixed, surrogate, ..Fitted::default() }
    }
}

/// Resolves the names of pairs to indices of varying dimensions.
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
