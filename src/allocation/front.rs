//! Cost against yield.

use super::choose::{Choice, choose};
use super::constraint::Constraint;
use super::result::FrontPoint;
use super::solve::Setting;
use crate::distribution::standard_normal;
use crate::problem::Problem;
use crate::requirement::Requirement;

/// From one sigma less to one and a half more than what is required, and for Cpk a third of that.
const SPAN: [f64; 2] = [-1.0, 1.5];

/// This many points, the loosest requirement first, at fixed derivatives; other requirements than yield and Cpk stay.
pub(super) fn front(
    setting: &Setting<'_>,
    problem: &Problem,
    requirements: &[Option<Requirement>],
    points: usize,
    start: &[f64],
) -> Vec<FrontPoint> {
    let mut found = Vec::with_capacity(points);
    for point in 0..points {
        if (setting.stopped)() {
            break;
        }
        let more = SPAN[0] + (SPAN[1] - SPAN[0]) * point as f64 / (points - 1) as f64;
        let wanted: Vec<Option<Requirement>> =
            requirements.iter().map(|one| one.map(|one| stricter(one, more))).collect();
        let constraints: Vec<Constraint> = (wanted.iter().enumerate())
            .filter_map(|(c, one)| Some(Constraint::of(c, (*one)?, problem.characteristics()[c].limits())))
            .flatten()
            .collect();
        let setting = Setting { constraints: &constraints, ..*setting };
        let choice = choose(&setting, start);
        let of_front = |(c, one): (usize, &Option<Requirement>)| match one {
            Some(one @ (Requirement::Yield(_) | Requirement::Cpk(_))) => {
                Some((problem.characteristics()[c].name().to_owned(), *one))
            }
            _ => None,
        };
        let required = wanted.iter().enumerate().filter_map(of_front).collect();
        let (cost, tolerances) = match choice {
            Choice::Found { solved, .. } => (Some(solved.cost), Some(solved.at)),
            _ => (None, None),
        };
        found.push(FrontPoint { required, cost, tolerances });
    }
    found
}

/// The requirement with this many sigmas more.
fn stricter(requirement: Requirement, more: f64) -> Requirement {
    match requirement {
        Requirement::Yield(least) => {
            let level = standard_normal::upper_quantile(0.5 * (1.0 - least)) + more;
            Requirement::Yield(1.0 - 2.0 * standard_normal::sf(level.max(0.1)))
        }
        Requirement::Cpk(least) => Requirement::Cpk((least + more / 3.0).max(0.05)),
        other => other,
    }
}
