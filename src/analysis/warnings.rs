//! Warnings of an analysis: assumptions of its results that fail.

use crate::analysis::sampling::verification_stage;
use std::collections::HashSet;

use crate::analysis::distribution::law_guard::LawRefutation;
use crate::analysis::likely_mistakes::likely_mistakes;
use crate::analysis::result::characteristic::curvature;
use crate::analysis::result::interaction_listing::missing;
use crate::analysis::sampling::surface_trust as trust;
use crate::analysis::{CharacteristicAnalysis, Missing};
use crate::assembly::NonRepeatable;
use crate::evaluation::history;
use crate::method::{Basis, Lacking, Order, Outcome};
use crate::plan::Point;
use crate::problem::Problem;
use crate::warning::{Figure, Loss, Warning, aggregated};
use sensitol_numeric::capability::Law;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::element;
use sensitol_numeric::surrogate::Surrogate;

/// Largest value whose powers are safe: the third power of a larger one is close to the largest double, 1.8e308.
const LARGEST: f64 = 1e100;
/// Rounding error of a value, as a part of sigma, above which there is a warning.
const NOISE: f64 = 1e-4;
/// Mean shift by curvature, in sigmas, above which RSS is invalid.
const SHIFT: f64 = 0.1;
/// Variance by curvature, as a part of the linear variance, above which RSS is invalid.
const CURVED: f64 = 0.05;

/// Share of the variance by curvature above which three nodes are too few. Their rules are exact to the fifth degree, and the fourth power
/// of a parabola has degree eight: the error shows in the kurtosis.
const SHALLOW_CURVED: f64 = 1e-2;
/// Residual of a fitted surface, as a part of sigma, above which the fit is poor.
const POOR: f64 = 0.05;
/// Smallest number of points with a value of exactly 0 that count as an atom, if the value at the means is not 0.
const ATOM: usize = 2;
/// Share of the variance by curvature above which a dimension with a long tail gets a warning.
const LONG_TAIL: f64 = 1e-3;
/// Margin of the kurtosis above the least possible one, as a part of it, below which there is a warning.
const MARGIN: f64 = 0.1;
/// Sarle's coefficient `(skewness^2 + 1)/kurtosis` above which two peaks are more likely than one. An arc sine distribution, with its mass
/// at both ends, has 2/3.
const MODES: f64 = 0.68;

/// Warnings of all characteristics, aggregated; `found` are those of the search for jumps and of recorded failures.
pub(super) fn of(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
    non_repeatable: &[NonRepeatable],
    found: Vec<Warning>,
) -> Vec<Warning> {
    let mut warnings = found;
    warnings.extend(unused(problem));
    warnings.extend(likely_mistakes(problem, characteristics));
    for &d in outcome.plan.varying() {
        let moved = |moved: &crate::plan::MovedNode| Warning::SupportEdge {
            dimension: problem.dimensions()[d].name().to_owned(),
            from: moved.from,
            to: moved.to,
            others: Vec::new(),
        };
        warnings.extend(outcome.plan.axis(d).moved.iter().map(moved));
    }
    warnings.extend(not_resampled(problem, outcome));
    warnings.extend(history(problem, non_repeatable));
    warnings.extend(problem.function().warnings(problem.outputs()));
    for (c, analysis) in characteristics.iter().enumerate() {
        warnings.extend(failed_points(problem, outcome, c));
        warnings.extend(overflow(outcome, c, analysis));
        warnings.extend(unrepresentable(outcome, c, analysis));
        match outcome.basis {
            Basis::Exact | Basis::Differences => warnings.extend(lost(problem, outcome, c)),
            Basis::LeastSquares | Basis::Quadrature => warnings.extend(lost_moments(problem, outcome, c)),
        }
        warnings.extend(atom(problem, outcome, c));
        warnings.extend(long_tails(problem, outcome, analysis));
        warnings.extend(infinite_moment(problem, outcome, analysis));
        warnings.extend(doubtful(outcome, c, analysis));
        warnings.extend(trust::of(problem, outcome, c, analysis));
        let wanted = outcome.climbed.as_ref().map(|climbed| climbed.accuracy);
        warnings.extend(verification_stage::warnings(analysis, wanted));
        warnings.extend(refuted_law(analysis));
        warnings.extend(not_proven(analysis));
    }
    let possible = outcome.plan.possible_pairs();
    // Pairs that `auto` did not examine show in its comparison with the model instead.
    let open = outcome.fitted.iter().enumerate().any(|(c, fitted)| fitted.known_pairs < outcome.plan.pairs_of(c));
    if outcome.order == Order::Second && outcome.climbed.is_none() && outcome.pairs.len() < possible && open {
        warnings.push(Warning::PairsNotExamined { examined: outcome.pairs.len(), possible });
    }
    let chosen: Vec<usize> = (0..characteristics.len()).filter(|&c| problem.follows_costly_choice(c)).collect();
    let is_chosen = |name: &str| chosen.iter().any(|&c| characteristics[c].characteristic.name() == name);
    warnings.retain(|warning| !is_of_surface(warning) || !warning.characteristic().is_some_and(is_chosen));
    warnings.extend(chosen.into_iter().filter_map(|c| {
        let one = &characteristics[c];
        let characteristic = one.characteristic.name().to_owned();
        one.moments
            .is_none()
            .then(|| Warning::ChoiceNotSampled { characteristic, choice: problem.choice(c).unwrap_or_default() })
    }));
    // A kink at the nominal point is the more precise finding, and answers next to it do not scatter.
    let at_nominal: Vec<String> = warnings.iter().filter_map(kinked).collect();
    warnings.retain(|warning| {
        let general = matches!(warning, Warning::Kink { .. } | Warning::Scatter { .. });
        !general || !at_nominal.iter().any(|name| warning.characteristic() == Some(name))
    });
    aggregated(warnings)
}

/// True for a warning about a surface. It says nothing of a characteristic that follows a choice from stock, whose figures are those of points.
fn is_of_surface(warning: &Warning) -> bool {
    matches!(
        warning,
        Warning::HigherOrder { .. }
            | Warning::Kink { .. }
            | Warning::KinkAtNominal { .. }
            | Warning::Discontinuity { .. }
            | Warning::Scatter { .. }
            | Warning::FarResidual { .. }
            | Warning::ShallowRules { .. }
            | Warning::PoorFit { .. }
            | Warning::InteractionsLeftOut { .. }
            | Warning::UnderResolved { .. }
            | Warning::UntrustedSurrogate { .. }
    )
}

/// Name of a characteristic with a kink at the nominal point.
fn kinked(warning: &Warning) -> Option<String> {
    match warning {
        Warning::KinkAtNominal { characteristic, .. } => Some(characteristic.clone()),
        _ => None,
    }
}

/// Warning of measured dimensions whose sample was not drawn anew.
fn not_resampled(problem: &Problem, outcome: &Outcome) -> Option<Warning> {
    // Rows of measured parts are drawn anew as a whole.
    let correlated = outcome.plan.inputs().correlation().is_some_and(|of| of.without_blocks().is_some());
    let integrated = outcome.basis == Basis::Quadrature;
    let measured = |d: &&usize| {
        let law = problem.dimensions()[**d].distribution();
        (correlated || integrated) && law.is_some_and(|law| law.measured().is_some())
    };
    let name = |d: &usize| problem.dimensions()[*d].name().to_owned();
    let dimensions: Vec<String> = outcome.plan.varying().iter().filter(measured).map(name).collect();
    (!dimensions.is_empty()).then_some(Warning::NoSamplingInterval { dimensions, correlated })
}

/// Warning of dimensions that vary and affect no characteristic. Coordinates of a zone or a geometric element that has a used coordinate
/// are left out.
fn unused(problem: &Problem) -> Option<Warning> {
    let dependence = problem.dependence();
    let used = |d: &usize| dependence.iter().any(|row| row[*d]);
    let all = problem.dimensions();
    let of_used = || (0..all.len()).filter(used).map(|d| &all[d]);
    let zones: HashSet<&str> = of_used().filter_map(Dimension::zone).collect();
    let elements: HashSet<&str> = of_used().map(|of| element(of.name())).collect();
    let beside =
        |of: &Dimension| of.zone().is_some_and(|zone| zones.contains(zone)) || elements.contains(element(of.name()));
    let idle = (0..all.len()).filter(|d| !used(d) && !beside(&all[*d]));
    let dimensions: Vec<String> = idle.map(|d| problem.dimensions()[d].name().to_owned()).collect();
    (!dimensions.is_empty()).then_some(Warning::UnusedDimension { dimensions })
}

/// Warning of points without a value.
fn failed_points(problem: &Problem, outcome: &Outcome, c: usize) -> Option<Warning> {
    let known = &outcome.evaluated.known;
    let mut errors = known.errors().filter(|&(_, of, _)| of == c);
    let (point, _, error) = errors.next()?;
    let failed_more = errors.count();
    Some(Warning::FailedPoints {
        characteristic: name(problem, c),
        failed: 1 + failed_more,
        points: 1 + failed_more + known.values(c).count(),
        point: described(problem, outcome, point),
        error: error.to_string(),
    })
}

/// Warning of values or moments whose powers overflow a double.
fn overflow(outcome: &Outcome, c: usize, analysis: &CharacteristicAnalysis) -> Option<Warning> {
    let moments = analysis.moments.iter().flat_map(|moments| [moments.mean(), moments.sigma()]);
    let largest = outcome.evaluated.known.values(c).chain(moments).fold(0.0, |most: f64, value| most.max(value.abs()));
    let characteristic = analysis.characteristic.name().to_owned();
    (largest > LARGEST).then_some(Warning::Overflow { characteristic, value: largest, limit: LARGEST })
}

/// Warning of known second derivatives that a double cannot hold, because of dimensions of extreme size.
fn unrepresentable(outcome: &Outcome, c: usize, analysis: &CharacteristicAnalysis) -> Option<Warning> {
    let lost = analysis
        .sensitivities
        .iter()
        .enumerate()
        // Slopes after a choice from stock are left out together.
        .any(|(d, one)| one.first.is_some() && one.second.is_none() && curvature(outcome, c, d).is_some())
        || analysis.contributions.interactions.iter().any(|pair| pair.mixed.is_none() && pair.missing.is_none());
    let characteristic = analysis.characteristic.name().to_owned();
    lost.then_some(Warning::Unrepresentable { characteristic })
}

/// Description of a point in words: the dimensions that are not at their means.
fn described(problem: &Problem, outcome: &Outcome, point: &Point) -> String {
    if point == outcome.plan.nominal() {
        return "the nominal dimensions".to_owned();
    }
    if *point == Point::Centre {
        return "the means".to_owned();
    }
    let at = point.at().iter().map(|at| {
        let dimension = at.dimension as usize;
        let node = outcome.plan.axis(dimension).nodes[at.node as usize];
        format!("{} = {} (mean {:+.3} sigma)", problem.dimensions()[dimension].name(), node.x, node.u)
    });
    at.collect::<Vec<_>>().join(", ")
}

/// Warning of missing moments of a method that integrates or fits by least squares.
fn lost_moments(problem: &Problem, outcome: &Outcome, c: usize) -> Option<Warning> {
    let because = match outcome.fitted[c].lacking? {
        Lacking::Points { lost, of } if outcome.evaluated.stopped().is_some() => {
            format!("the run was stopped before {lost} of the {of} values of its quadrature were known")
        }
        Lacking::Points { lost, of } => {
            format!("{lost} of the {of} values of its quadrature {} missing", if lost == 1 { "is" } else { "are" })
        }
        Lacking::NotEstimable { left, coefficients } => {
            format!(
                "the {left} points that have a value do not determine the {coefficients} coefficients of its surface"
            )
        }
    };
    Some(Warning::LostMoments { characteristic: name(problem, c), because })
}

/// Warnings of missing derivatives, and of those known only over a shorter step.
fn lost(problem: &Problem, outcome: &Outcome, c: usize) -> Vec<Warning> {
    let (plan, fitted, known) = (&outcome.plan, &outcome.fitted[c], &outcome.evaluated.known);
    let mut warnings = Vec::new();
    let dimension = |d: usize| problem.dimensions()[d].name().to_owned();
    let lost = |dimensions: Vec<String>, loss| Warning::LostDerivative {
        characteristic: name(problem, c),
        dimensions,
        loss,
        others: Vec::new(),
    };
    let mut unevaluated = 0;
    let mut gone = |dimensions: &[usize], loss: Loss| match missing(outcome, c, dimensions) {
        Missing::Failed => Some(lost(dimensions.iter().map(|&d| dimension(d)).collect(), loss)),
        Missing::NotEvaluated => {
            unevaluated += 1;
            None
        }
    };
    // Without a value at the means no derivative is known: one warning covers them all.
    if fitted.centre.is_none() {
        let centre = gone(&[], Loss::Centre);
        return vec![centre.unwrap_or_else(|| lost(Vec::new(), Loss::NotEvaluated { derivatives: 1 }))];
    }
    for &d in plan.varying().iter().filter(|&&d| plan.depends(c, d)) {
        let axis = plan.axis(d);
        let value = |node: u32| {
            known
                .value(&Point::of(&[crate::plan::AtNode { dimension: d as u32, node }]), c)
                .map(|_| axis.nodes[node as usize].u)
        };
        // The first node of a slot is the intended one, the others replace it if it failed.
        for slot in &axis.slots {
            if let (None, Some(used)) = (value(slot[0]), slot[1..].iter().find_map(|&node| value(node))) {
                warnings.push(Warning::DomainEdge {
                    characteristic: name(problem, c),
                    dimension: dimension(d),
                    failed: axis.nodes[slot[0] as usize].u,
                    used,
                    others: Vec::new(),
                });
            }
        }
        match fitted.parts[d] {
            None => warnings.extend(gone(&[d], Loss::Slope)),
            Some(part) if part.degree() < 2 => warnings.extend(gone(&[d], Loss::Curvature)),
            Some(_) => {}
        }
    }
    for (&(j, k), mixed) in outcome.pairs.iter().zip(&fitted.mixed) {
        let pair = [j, k].map(|position| plan.varying()[position]);
        match mixed {
            None => warnings.extend(gone(&pair, Loss::Mixed)),
            Some(mixed) if !mixed.complete => warnings.extend(gone(&pair, Loss::OneSidedMixed)),
            Some(_) => {}
        }
    }
    if unevaluated > 0 {
        warnings.push(lost(Vec::new(), Loss::NotEvaluated { derivatives: unevaluated }));
    }
    warnings
}

/// Warning of a moment that is infinite because of the tails of some dimensions.
fn infinite_moment(problem: &Problem, outcome: &Outcome, analysis: &CharacteristicAnalysis) -> Option<Warning> {
    let figure = match analysis.moments {
        None => Figure::Sigma,
        Some(moments) if moments.sigma() == 0.0 || moments.kurtosis().is_some() => return None,
        Some(moments) if moments.skewness().is_some() => Figure::Kurtosis,
        Some(_) => Figure::Skewness,
    };
    let slope = |d: usize| analysis.sensitivities[d].first;
    let endless = |&&d: &&usize| {
        let law = problem.dimensions()[d].distribution();
        law.is_some_and(|law| !law.standard_moments().are_finite()) && slope(d).is_some_and(|slope| slope != 0.0)
    };
    let varying = outcome.plan.varying();
    // Points that were not evaluated are another reason of a missing sigma.
    if varying.iter().any(|&d| slope(d).is_none()) {
        return None;
    }
    let dimensions: Vec<String> =
        varying.iter().filter(endless).map(|&d| problem.dimensions()[d].name().to_owned()).collect();
    let characteristic = analysis.characteristic.name().to_owned();
    (!dimensions.is_empty()).then_some(Warning::InfiniteMoment { characteristic, figure, dimensions })
}

/// Warnings of curvature along dimensions whose tails reach far beyond the nodes.
fn long_tails(problem: &Problem, outcome: &Outcome, analysis: &CharacteristicAnalysis) -> Vec<Warning> {
    let warning = |&d: &usize| {
        let tail = outcome.plan.axis(d).tail.as_ref()?;
        let share = analysis.sensitivities[d].curvature_share.filter(|&share| share > LONG_TAIL)?;
        Some(Warning::LongTail {
            characteristic: analysis.characteristic.name().to_owned(),
            dimension: problem.dimensions()[d].name().to_owned(),
            farthest: tail.farthest,
            reach: tail.reach,
            share,
            others: Vec::new(),
        })
    };
    outcome.plan.varying().iter().filter_map(warning).collect()
}

/// Warning of an atom at 0, as of a minimum distance: several points are exactly 0, and others are not.
fn atom(problem: &Problem, outcome: &Outcome, c: usize) -> Option<Warning> {
    let known = &outcome.evaluated.known;
    let points = known.values(c).filter(|&value| value == 0.0).count();
    let elsewhere = outcome.fitted[c].centre.is_some_and(|centre| centre != 0.0);
    (points >= ATOM && elsewhere).then(|| Warning::Atom { characteristic: name(problem, c), points })
}

/// Warnings of results that exist but are doubtful.
fn doubtful(outcome: &Outcome, c: usize, analysis: &CharacteristicAnalysis) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let (Some(moments), fitted) = (analysis.moments, &outcome.fitted[c]) else { return warnings };
    let characteristic = analysis.characteristic.name().to_owned();
    let sigma = moments.sigma();
    if sigma == 0.0 {
        warnings.push(Warning::NoReaction { characteristic });
        return warnings;
    }
    let centre = fitted.surrogate.as_ref().map_or(moments.mean(), |surrogate| surrogate.centre);
    let rounding = f64::EPSILON * centre.abs() / sigma;
    if rounding > NOISE {
        warnings.push(Warning::Noise { characteristic: characteristic.clone(), rounding });
    }
    warnings.extend(law(analysis, &characteristic));
    let curved: f64 = analysis.sensitivities.iter().filter_map(|row| row.curvature_share).sum();
    if fitted.integrated.as_ref().is_some_and(|integrated| integrated.nodes == 3) && curved > SHALLOW_CURVED {
        warnings.push(Warning::ShallowRules { characteristic: characteristic.clone(), share: curved });
    }
    let residual = fitted.residual.and_then(|residual| residual.standard_error).map(|residual| residual / sigma);
    if let Some(residual) = residual.filter(|&residual| residual > POOR) {
        warnings.push(Warning::PoorFit { characteristic: characteristic.clone(), residual });
    }
    // A method of first order assumes straight lines: the surface with the known curvatures shows the error of that.
    if let (Order::First, Some(surrogate)) = (outcome.order, &fitted.surrogate) {
        let plan = &outcome.plan;
        let parts = plan.varying().iter().map(|&d| outcome.fitted[c].parts[d]).collect();
        let curved = Surrogate { parts, ..surrogate.clone() }.contributions(plan.inputs());
        if let Some(curved) = curved.map(|contributions| contributions.moments) {
            let mean_shift = (curved.mean() - moments.mean()) / sigma;
            let variance = curved.variance() / moments.variance() - 1.0;
            if mean_shift.abs() > SHIFT || variance.abs() > CURVED {
                warnings.push(Warning::RssInvalid { characteristic, mean_shift, variance });
            }
        }
    }
    warnings
}

/// Warning of a surface distribution that points contradict.
fn refuted_law(analysis: &CharacteristicAnalysis) -> Option<Warning> {
    let LawRefutation { test, limit, law, counted, error } = analysis.evidence.surface_law?.refuted?;
    let characteristic = analysis.characteristic.name().to_owned();
    Some(Warning::SurfaceLawRefuted { characteristic, test: test.name(), limit, law, counted, error })
}

/// Warning of extremes without a proof.
fn not_proven(analysis: &CharacteristicAnalysis) -> Option<Warning> {
    let extremes = analysis.range.extremes.as_ref().filter(|extremes| !extremes.proven())?;
    Some(Warning::NotProven {
        characteristic: analysis.characteristic.name().to_owned(),
        evaluations: extremes.evaluations,
        ended: extremes.ended,
        failed: extremes.failed,
        failure: extremes.failure.clone(),
        bounds: extremes.proof.as_ref().map(|proof| (proof.bounds, proof.boxes)),
    })
}

/// Warning of moments that no distribution has, or hardly any.
fn law(analysis: &CharacteristicAnalysis, characteristic: &str) -> Option<Warning> {
    let characteristic = characteristic.to_owned();
    match analysis.evidence.law.as_ref()? {
        // The warning `infinite-moment` reports this case.
        Err(_) if analysis.moments.is_some_and(|moments| moments.sigma() > 0.0 && moments.kurtosis().is_none()) => None,
        Err(error) => Some(Warning::InfeasibleMoments { characteristic, reason: error.to_string() }),
        Ok(Law::Pearson(law)) if law.margin() < MARGIN => {
            Some(Warning::NearInfeasibleMoments { characteristic, skewness: law.skewness(), kurtosis: law.kurtosis() })
        }
        Ok(Law::Pearson(law)) => {
            let coefficient = (law.skewness().powi(2) + 1.0) / law.kurtosis();
            (coefficient > MODES).then_some(Warning::SeveralModes { characteristic, coefficient })
        }
        Ok(_) => None,
    }
}

fn name(problem: &Problem, c: usize) -> String {
    problem.characteristics()[c].name().to_owned()
}
