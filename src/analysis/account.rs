//! What `auto` found and bought, in words.

use super::CharacteristicAnalysis;
use crate::method::{ClimbEnd, Outcome};
use crate::problem::Problem;

/// Dimensions that are named.
const NAMED: usize = 8;
/// A curvature with a share of the variance below this is none, in every characteristic.
const STRAIGHT: f64 = 1e-8;

/// None for other methods.
pub(super) fn account(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
    evaluations: usize,
) -> Option<String> {
    let climbed = outcome.climbed.as_ref()?;
    let plan = &outcome.plan;
    let n = plan.varying().len();
    if n == 0 {
        return None;
    }
    let name = |j: usize| problem.dimensions()[plan.varying()[j]].name();
    let list = |positions: &[usize]| {
        let named: Vec<&str> = positions.iter().take(NAMED).map(|&j| name(j)).collect();
        match positions.len() {
            many if many > NAMED => format!("{} and {} more", named.join(", "), many - NAMED),
            _ => named.join(", "),
        }
    };
    let straight = |j: usize| {
        let share = |one: &CharacteristicAnalysis| one.sensitivities[plan.varying()[j]].curvature_share;
        characteristics.iter().all(|one| share(one).is_some_and(|share| share < STRAIGHT))
    };
    let three: Vec<usize> = (0..n).filter(|j| !climbed.refined.contains(j)).collect();
    let (lines, parabolas): (Vec<usize>, Vec<usize>) = three.into_iter().partition(|&j| straight(j));
    let mut parts = Vec::new();
    let be = |positions: &[usize], one: &str, many: &str| {
        if positions.len() == 1 { one.to_owned() } else { many.to_owned() }
    };
    if !lines.is_empty() {
        let all = if lines.len() == n { "all dimensions".to_owned() } else { list(&lines) };
        parts.push(format!(
            "{all} {}: 2 points each",
            if lines.len() == n {
                "act along straight lines".to_owned()
            } else {
                be(&lines, "acts along a straight line", "act along straight lines")
            }
        ));
    }
    if !parabolas.is_empty() {
        parts.push(format!("{} {}: 2 points each", list(&parabolas), be(&parabolas, "is curved", "are curved")));
    }
    if !climbed.refined.is_empty() {
        parts.push(format!(
            "{} {} more than a parabola: 4 points each",
            list(&climbed.refined),
            be(&climbed.refined, "is", "are")
        ));
    }
    let possible = plan.possible_pairs();
    parts.push(match (climbed.probes, climbed.direct) {
        _ if possible == 0 => "no interactions possible".to_owned(),
        (0, 0) if climbed.rest != ClimbEnd::Reached => format!("no interaction of {possible} examined"),
        (0, 0) => format!("no interactions of {possible} needed"),
        (0, direct) => format!("{direct} of {possible} interactions examined one by one"),
        (probes, 0) => format!("interactions sought by {probes} probes of 2 points that move all dimensions"),
        (probes, direct) => format!("{probes} probes, {direct} of {possible} interactions examined one by one"),
    });
    parts.push(format!("{} points check", climbed.checks));
    let full = n * n + n + 1;
    let sampled = characteristics.iter().filter_map(|one| one.model_sampled.as_ref()).map(|one| one.samples).max();
    match sampled {
        Some(samples) => parts.push(format!("the model was sampled at {samples} points more")),
        None => parts.push(format!("{evaluations} evaluations where every second derivative takes {full}")),
    }
    match climbed.rest {
        ClimbEnd::Budget => parts.push("the budget ended it".to_owned()),
        ClimbEnd::Stopped => parts.push("interrupted".to_owned()),
        ClimbEnd::Reached | ClimbEnd::Exhausted => {}
    }
    Some(parts.join("; "))
}
