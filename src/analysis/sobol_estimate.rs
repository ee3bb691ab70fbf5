//! Sobol' indices: the part of the variance that a dimension explains alone, and with all its interactions.
//!
//! ```text
//! first order  S_j = Var(E[y | x_j]) / Var(y)        total  T_j = E[Var(y | all but x_j)] / Var(y)
//! ```
//!
//! The contributions of a surface give them without evaluations: the linear and the curvature share of a dimension are `S_j`, and with its
//! interactions they are `T_j`. Dimensions that vary together are one factor, with the same formulas. A surface that leaves `U` of the
//! variance unexplained has the indices within `2 sqrt(S U) + U`, by Cauchy and Schwarz. If a sample of the model shows that the surface is
//! not to be trusted, the indices are the model's. They come from exchanging inputs, or from the ranks of an existing sample. Contributions
//! of that surface are unknown then.

use std::collections::HashMap;

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::result::sobol_indices::{FactorIndices, IndexSource, SobolIndices};
use crate::analysis::result::stage_figures::IndexFigures;
use crate::analysis::result::verification::{UNTRUSTED, VerificationKind};
use crate::analysis::sampling::sample_budget::SampleBudget;
use crate::assembly::Run;
use crate::estimate::factor_shares;
use crate::method::{Options, Order, Outcome};
use crate::problem::Problem;
use crate::verification::most_points_of_shares;
use sensitol_numeric::capability::EstimatedShare;
use sensitol_numeric::correlation::factors;

/// First order and total of one factor.
type Pair = (Option<EstimatedShare>, Option<EstimatedShare>);

/// Indices of the characteristics that vary, by their places.
pub(super) fn indices(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
    run: &Run<'_>,
) -> Vec<(usize, IndexFigures)> {
    let varying = outcome.plan.varying();
    let places = factors(problem.correlation(), varying);
    let factors: Vec<Vec<usize>> =
        places.iter().map(|places| places.iter().map(|&place| varying[place]).collect()).collect();
    let mut all = Vec::new();
    for (c, one) in characteristics.iter().enumerate() {
        if one.moments.is_none_or(|moments| moments.sigma() <= 0.0) {
            continue;
        }
        let distrusted = one.is_distrusted();
        let (source, found) = match distrusted {
            false => (IndexSource::Surface, of_surface(one, &factors)),
            true => of_model(problem, (c, options), left, one, &factors, run),
        };
        // A method of first order reports the contributions of its own sum of squares, regardless of the model.
        let distrusted = distrusted && outcome.order == Order::Second;
        all.push((c, IndexFigures { distrusted, ..index_figures(problem, &factors, source, found) }));
    }
    all
}

impl CharacteristicAnalysis {
    /// Share of the variance that the surface leaves unexplained, if the model was evaluated for it.
    pub fn left(&self) -> Option<f64> {
        let verified = self.evidence.verification.as_ref().and_then(|of| of.left);
        verified.or(self.evidence.model_sampled.as_ref().map(|of| of.left.unwrap_or(1.0)))
    }

    /// Error of a share of the surface as a share of the model. Returns None if it is unknown.
    pub fn share_error(&self, share: f64) -> Option<f64> {
        let left = self.left().filter(|_| self.evidence.sampled.is_none())?;
        Some((2.0 * (share.max(0.0) * left).sqrt() + left).min(1.0))
    }

    /// True if a sample of the model shows that the contributions of the surface are meaningless.
    fn is_distrusted(&self) -> bool {
        let sampled = self.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Sample);
        (sampled || self.evidence.model_sampled.is_some()) && self.left().is_some_and(|left| left > UNTRUSTED)
    }
}

/// Indices of dimensions and of factors.
fn index_figures(problem: &Problem, factors: &[Vec<usize>], source: IndexSource, found: Vec<Pair>) -> IndexFigures {
    let name = |&d: &usize| problem.dimensions()[d].name().to_owned();
    let firsts: Option<Vec<f64>> = found.iter().map(|(first, _)| Some(first.as_ref()?.value)).collect();
    let (mut single, mut together) = (Vec::new(), Vec::new());
    for (factor, (first_order, total)) in factors.iter().zip(found) {
        match factor[..] {
            [d] => single.push((d, first_order, total)),
            _ => together.push(FactorIndices { dimensions: factor.iter().map(name).collect(), first_order, total }),
        }
    }
    let interactions = firsts.map(|firsts| 1.0 - firsts.iter().sum::<f64>());
    IndexFigures { indices: SobolIndices { source, factors: together, interactions }, single, distrusted: false }
}

/// Indices from the contributions of the surface: those inside of a factor, and those of every interaction with another.
fn of_surface(one: &CharacteristicAnalysis, factors: &[Vec<usize>]) -> Vec<Pair> {
    let left = one.left();
    // A surface that check points do not trust gives no indices. Slopes alone give none either, unless a check shows that nothing is
    // missing.
    let trusted = left.is_none_or(|left| left <= UNTRUSTED);
    let own = |d: &usize| {
        let row = &one.sensitivities[*d];
        let curvature = row.curvature_share.or(left.map(|_| 0.0));
        Some(row.linear_share? + curvature?)
    };
    let index = |value: f64| EstimatedShare { value, error: one.share_error(value) };
    let complete = left.is_some() || one.contributions.examined_interactions == one.contributions.possible_interactions;
    let mut holders: HashMap<&str, usize> = HashMap::new();
    for (place, factor) in factors.iter().enumerate() {
        holders.extend(factor.iter().map(|&d| (one.sensitivities[d].dimension.as_str(), place)));
    }
    let holder = |name: &str| holders.get(name).copied();
    let mut inside: Vec<Option<f64>> =
        factors.iter().map(|factor| factor.iter().map(own).sum::<Option<f64>>().filter(|_| trusted)).collect();
    let mut across: Vec<Option<f64>> = vec![complete.then_some(0.0); factors.len()];
    let plus = |sum: &mut Option<f64>, share: Option<f64>| *sum = sum.zip(share).map(|(sum, share)| sum + share);
    for pair in one.contributions.interactions.iter() {
        let [a, b] = pair.dimensions.map(holder);
        match (a, b) {
            (Some(a), Some(b)) if a == b => plus(&mut inside[a], pair.share),
            (a, b) => a.into_iter().chain(b).for_each(|factor| plus(&mut across[factor], pair.share)),
        }
    }
    let of = |(first, across): (&Option<f64>, &Option<f64>)| {
        let total = first.zip(*across).map(|(first, across)| index(first + across));
        (first.map(index), total)
    };
    inside.iter().zip(&across).map(of).collect()
}

/// Indices of the model itself: from the exchange of its verification, from an exchange of factors, or from the ranks of its sample.
fn of_model(
    problem: &Problem,
    (c, options): (usize, &Options),
    left: &mut SampleBudget,
    one: &CharacteristicAnalysis,
    factors: &[Vec<usize>],
    run: &Run<'_>,
) -> (IndexSource, Vec<Pair>) {
    let known = one.evidence.verification.as_ref().and_then(|of| of.shares.as_ref());
    if let Some(known) = known {
        let of = |factor: &Vec<usize>| {
            let [d] = factor[..] else { return (None, None) };
            let found = known.iter().find(|share| share.dimension == one.sensitivities[d].dimension);
            let [first, total] = found.map_or([NOTHING; 2], |found| [found.first.into(), found.total.into()]);
            (Some(first), Some(total))
        };
        return (IndexSource::Exchange, factors.iter().map(of).collect());
    }
    // A model that is sampled to verify results may be evaluated more, if the budget allows it.
    let verified = one.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Sample);
    let inputs = factors.iter().map(Vec::len).sum();
    let affordable = verified && !run.stopped() && left.take(most_points_of_shares(inputs));
    let found = affordable.then(|| factor_shares(problem, c, options.seed.unwrap_or(Options::SEED), run)).flatten();
    let ranks = one.evidence.model_sampled.as_ref().map_or(&[][..], |of| &of.ranks);
    if found.is_none() && !ranks.is_empty() {
        let of = |factor: &Vec<usize>| match factor[..] {
            [d] => (ranks.iter().find(|(of, _)| *of == d).map(|(_, share)| EstimatedShare::from(*share)), None),
            // The ranks of one dimension give no index of a whole factor.
            _ => (None, None),
        };
        return (IndexSource::Ranks, factors.iter().map(of).collect());
    }
    let of = |factor: &Vec<usize>| {
        let Some(found) = &found else { return (None, None) };
        // A characteristic may depend on only some of the dimensions that vary together.
        let own = found.iter().find(|(dimensions, _)| dimensions.iter().all(|d| factor.contains(d)));
        let [first, total] = own.map_or([NOTHING; 2], |(_, shares)| shares.map(EstimatedShare::from));
        (Some(first), Some(total))
    };
    (IndexSource::Exchange, factors.iter().map(of).collect())
}

/// Index of a dimension on which a characteristic cannot depend.
const NOTHING: EstimatedShare = EstimatedShare { value: 0.0, error: Some(0.0) };
