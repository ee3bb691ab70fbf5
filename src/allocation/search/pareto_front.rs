//! Front of cost against requirement.

use crate::allocation::choice::machine::choose;
use crate::allocation::choice::selection::Choice;
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::result::allocation::FrontPoint;
use crate::allocation::result::json::FrontRequirement;
use crate::problem::Problem;
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::requirement::Requirement;

/// Range of the front: from one sigma less to one and a half sigmas more than required. For Cpk it is a third of that.
const SPAN: [f64; 2] = [-1.0, 1.5];
/// Rate at which a required sigma, or the usable part of the slack, falls over the range: from 1.5 times to 0.55 times
/// the required value.
const FALLS: f64 = 0.4;

/// Points of the front at fixed derivatives, the loosest requirement first.
pub(in crate::allocation) fn front(
    setting: &Setting<'_>,
    problem: &Problem,
    requirements: &[Option<Requirement>],
    joint: Option<f64>,
    points: usize,
    start: &[f64],
) -> Vec<FrontPoint> {
    let characteristics = problem.characteristics();
    let limited = || characteristics.iter().enumerate().filter(|(_, one)| one.limits().exist());
    let mut found = Vec::with_capacity(points);
    for point in 0..points {
        if (setting.stopped)() {
            break;
        }
        let more = SPAN[0] + (SPAN[1] - SPAN[0]) * point as f64 / (points - 1) as f64;
        let (mut constraints, mut required) = (Vec::new(), Vec::new());
        for (c, one) in requirements.iter().enumerate().filter_map(|(c, one)| Some((c, (*one)?))) {
            let (requirement, part) = stricter(one, more);
            let sides = Constraint::of(c, requirement, characteristics[c].limits());
            constraints.extend(sides.into_iter().map(|side| side.taking(part)));
            let amount = requirement.value().unwrap_or(part);
            required.push(FrontRequirement {
                characteristic: characteristics[c].name().to_owned(),
                requirement,
                amount,
            });
        }
        if let Some((least, (first, one))) = joint.zip(limited().next()) {
            let (requirement, _) = stricter(Requirement::Yield(least), more);
            let amount = requirement.amount();
            constraints.push(Constraint::joint(first, amount, one.limits()));
            let names: Vec<&str> = limited().map(|(_, one)| one.name()).collect();
            required.push(FrontRequirement { characteristic: names.join(", "), requirement, amount });
        }
        let (cost, tolerances) = match choose(&Setting { constraints: &constraints, ..*setting }, start) {
            Choice::Found { solved, .. } => (Some(solved.cost), Some(solved.at)),
            _ => (None, None),
        };
        found.push(FrontPoint { required, cost, tolerances });
    }
    found
}

/// Requirement with more sigmas, and the usable part of the slack for rss and worst case.
fn stricter(requirement: Requirement, more: f64) -> (Requirement, f64) {
    let part = libm::exp(-FALLS * more);
    match requirement {
        Requirement::Yield(least) => {
            let level = standard_normal::upper_quantile(0.5 * (1.0 - least)) + more;
            (Requirement::Yield(1.0 - 2.0 * standard_normal::sf(level.max(0.1))), 1.0)
        }
        Requirement::Cpk(least) => (Requirement::Cpk((least + more / 3.0).max(0.05)), 1.0),
        Requirement::Sigma(most) => (Requirement::Sigma(part * most), 1.0),
        Requirement::Rss | Requirement::WorstCase => (requirement, part),
    }
}
