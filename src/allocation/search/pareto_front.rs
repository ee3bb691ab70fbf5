//! Front of cost against requirement.

use crate::allocation::choice::machine::choose;
use crate::allocation::choice::selection::Choice;
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::registry::form_of;
use crate::allocation::result::allocation::FrontPoint;
use crate::allocation::result::json::FrontRequirement;
use crate::problem::Problem;
use sensitol_numeric::requirement::Requirement;

/// Range of the front: from one sigma less to one and a half sigmas more than required. For Cpk it is a third of that.
const SPAN: [f64; 2] = [-1.0, 1.5];

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
            let (amount, part) = form_of(&one).stricter(one.amount(), more);
            let requirement = one.with_amount(amount);
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
            let asked = Constraint::joint(first, least, one.limits());
            let (amount, _) = asked.form().stricter(least, more);
            let requirement = asked.requirement.with_amount(amount);
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
