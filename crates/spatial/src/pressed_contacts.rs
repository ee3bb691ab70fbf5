//! Formulas of a joint that presses: openings of its contacts, the choice among the sets that can carry the force, and its equations.

use crate::assembly::Press;
use crate::closure::Closure;
use crate::expression::Expression;
use crate::joint::opening;
use crate::number::Number;
use crate::placement::PlacedFeature;

/// Coefficient, as part of the greatest one, that rounding leaves in place of 0.
const ROUNDING: f64 = 1e-14;

/// Sets of contacts on which a part can rest, and the comparisons that choose among them.
#[derive(Debug, Clone, PartialEq)]
pub struct PressedContacts {
    /// Index of the joint.
    pub joint: usize,
    /// Contacts of every set that carry a part of the force, by their names.
    pub sets: Vec<Vec<String>>,
    /// Texts of the comparisons in the formulas. If the one of index k is true, set k + 1 precedes all sets up to k.
    pub changes: Vec<String>,
}

/// Features of a joint that presses, at their places.
pub(crate) struct PressedFeatures {
    pub(crate) plane: PlacedFeature<Expression>,
    pub(crate) targets: Vec<PlacedFeature<Expression>>,
}

impl Closure<'_> {
    /// Names and formulas of the equations of a joint that presses, with its contacts. `named` gives a long formula a name.
    ///
    /// Every set `T` of contacts has the motions `G^-1 gap_T`, with the openings `G` of its contacts by these motions: zero if all of its
    /// contacts touch. By the motions themselves the derivatives of all sets are the same, so that a change of the set is a bend and no jump
    /// of the equations. The set whose push is greatest gives the equations.
    pub(crate) fn pressed(
        &self,
        joint: usize,
        press: &Press,
        features: &PressedFeatures,
        mut named: impl FnMut(String, &Expression) -> Expression,
    ) -> (Vec<(String, String)>, PressedContacts) {
        let given = &self.assembly.joints[joint];
        let names = self.assembly.contact_names(press);
        let mut gaps = Vec::new();
        for (target, name) in features.targets.iter().zip(&names) {
            let gap = opening(&features.plane, target).residual;
            gaps.push(named(format!("{}: gap of {name}", given.name), &gap));
        }
        let sets = self.press_rows(joint, press, &self.rows_before(joint)).sets();
        let motions = sets[0].contacts.len();
        let (mut best, mut chosen): (Option<Expression>, Vec<Expression>) = (None, Vec::new());
        let mut changes = Vec::new();
        for (index, set) in sets.iter().enumerate() {
            let of_set: Vec<&Expression> = set.contacts.iter().map(|&contact| &gaps[contact]).collect();
            let forces: Vec<f64> = set.forces.iter().map(|force| -force).collect();
            let push = combined(&of_set, &forces);
            let own: Vec<Expression> = set.inverse.iter().map(|row| combined(&of_set, row)).collect();
            let Some(before) = best else {
                best = (sets.len() > 1).then(|| named(format!("{}: push 1", given.name), &push));
                chosen = own;
                continue;
            };
            let last = index + 1 == sets.len();
            let push = named(format!("{}: push {}", given.name, index + 1), &push);
            changes.push(format!("{} > {}", push.text(), before.text()));
            for (motion, (chosen, own)) in chosen.iter_mut().zip(&own).enumerate() {
                let choice = Expression::choice([&push, &before], own, chosen);
                let name = format!("{}: contact {} of {} sets", given.name, motion + 1, index + 1);
                *chosen = if last { choice } else { named(name, &choice) };
            }
            let name = format!("{}: best of {}", given.name, index + 1);
            best = Some(named(name, &Expression::choice([&push, &before], &push, &before)));
        }
        let equation = |motion: usize| (format!("{}: contact {}", given.name, motion + 1), chosen[motion].text());
        let sets = sets.iter().map(|set| set.carrying().map(|contact| names[contact].clone()).collect()).collect();
        ((0..motions).map(equation).collect(), PressedContacts { joint, sets, changes })
    }
}

/// Sum of gaps with constant factors.
fn combined(gaps: &[&Expression], factors: &[f64]) -> Expression {
    let largest = factors.iter().fold(0.0f64, |largest, factor| largest.max(factor.abs()));
    let mut sum = Expression::constant(0.0);
    for (gap, &factor) in gaps.iter().zip(factors).filter(|(_, factor)| factor.abs() > ROUNDING * largest) {
        sum = sum.plus(&Expression::constant(factor).times(gap));
    }
    sum
}
