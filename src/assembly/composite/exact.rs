//! Exact derivatives of outputs that depend on formulas and unknowns alone.

use crate::assembly::composite::{Composite, Needs, Origin};
use crate::assembly::formula::Jet;
use crate::assembly::implicit::{ImplicitOutput, Tangent};
use crate::assembly::{Derivatives, Directions, Run};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::power::Power;

/// Number of pairs from which a tape of the formula is faster than a jet for each pair.
const TOGETHER: usize = 64;

impl Composite {
    /// Returns the derivatives of every output, or None for one that depends on the model.
    ///
    /// With `exponents` the derivatives are per unit of `2^exponent` of each input, as in
    /// [`derivatives_per`](crate::AssemblyFunction::derivatives_per).
    ///
    /// Cost: for `P` pairs and `N` inputs about ten evaluations of the formulas for each of `N + P` directions. With unknowns, as many
    /// linear systems are solved. If `P` is 64 or more and there are no loops, it is `2 N` directions and `N` linear systems.
    pub(super) fn exact(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: Option<&[i32]>,
    ) -> Vec<Option<Derivatives>> {
        // An input moves by one unit along its direction.
        let unit = |input: usize| exponents.map_or(1.0, |all| Power::of_exponent(all[input]).times(1.0));
        let origins = self.origins(outputs);
        let needs: Vec<Needs> = origins.iter().map(|&origin| self.needs(origin)).collect();
        let explicit = |needs: &Needs| needs.answers.is_empty();
        let mut given = directions.point.to_vec();
        given.resize(self.given(), f64::NAN);
        let implicit = needs.iter().any(|needs| explicit(needs) && needs.unknowns);
        let anchor = if implicit { self.anchor(&Run::to_the_end()).0.and_then(Result::ok) } else { None };
        let tangent =
            anchor.as_ref().and_then(|anchor| self.assembler.as_ref()?.tangent(&self.formulas, anchor, &given));

        let determined = |needs: &Needs| !needs.unknowns || tangent.is_some();
        let known: Vec<usize> = (0..origins.len()).filter(|&k| explicit(&needs[k]) && determined(&needs[k])).collect();
        let asked: Vec<Origin> = known.iter().map(|&k| origins[k]).collect();
        // Pure derivatives need one jet for each input, mixed ones a jet for each pair, unless a tape gives all pairs at once.
        let along = |u: usize, v: usize| self.jets(&asked, &given, tangent.as_ref(), [(u, unit(u)), (v, unit(v))]);
        let pure: Vec<Vec<Jet>> = directions.inputs.par_iter().map(|&d| along(d, d)).collect();
        let together = self.mixed_together(&asked, &given, tangent.as_ref(), directions, exponents);
        let open: Vec<Origin> =
            asked.iter().zip(&together).filter(|(_, together)| together.is_none()).map(|(&origin, _)| origin).collect();
        let each = |&(j, k): &(usize, usize)| self.jets(&open, &given, tangent.as_ref(), [(j, unit(j)), (k, unit(k))]);
        let mixed: Vec<Vec<Jet>> =
            if open.is_empty() { Vec::new() } else { directions.pairs.par_iter().map(each).collect() };
        // If the unknowns have no derivatives, the formulas have none either. That is known, in contrast to an output of the model.
        let none = |needs: &Needs| {
            explicit(needs).then(|| Derivatives {
                first: vec![None; directions.inputs.len()],
                second: vec![None; directions.inputs.len()],
                mixed: vec![None; directions.pairs.len()],
            })
        };
        let mut derivatives: Vec<Option<Derivatives>> = needs.iter().map(none).collect();
        let of = |jets: &[Vec<Jet>], place: usize, part: &dyn Fn(&Jet) -> Option<f64>| {
            jets.iter().map(|jets| part(&jets[place])).collect::<Vec<_>>()
        };
        let mut next = 0;
        for (place, (&k, together)) in known.iter().zip(together).enumerate() {
            let mixed = match together {
                Some(mixed) => mixed.into_iter().map(Some).collect(),
                None => {
                    next += 1;
                    of(&mixed, next - 1, &Jet::second)
                }
            };
            let (first, second) = (of(&pure, place, &|jet| jet.first(0)), of(&pure, place, &Jet::second));
            derivatives[k] = Some(Derivatives { first, second, mixed });
        }
        derivatives
    }

    /// Returns all mixed derivatives of every output, or None for an output with a derivative that may not exist, and for few pairs.
    fn mixed_together(
        &self,
        asked: &[Origin],
        given: &[f64],
        tangent: Option<&Tangent<'_>>,
        directions: &Directions<'_>,
        exponents: Option<&[i32]>,
    ) -> Vec<Option<Vec<f64>>> {
        let mut together = vec![None; asked.len()];
        if directions.pairs.len() < TOGETHER || exponents.is_some() {
            return together;
        }
        let (mut places, mut implicit) = (Vec::new(), Vec::new());
        for (place, &origin) in asked.iter().enumerate() {
            match origin {
                Origin::Formula(formula) if !self.needs(origin).unknowns => {
                    together[place] = self.formulas.mixed(formula, given, directions.pairs);
                }
                Origin::Formula(formula) => {
                    places.push(place);
                    implicit.push(ImplicitOutput::Formula(formula));
                }
                Origin::Unknown(unknown) => {
                    places.push(place);
                    implicit.push(ImplicitOutput::Unknown(unknown));
                }
                Origin::Model(_) => {}
            }
        }
        let found = tangent.filter(|_| !places.is_empty());
        let found = found.and_then(|tangent| tangent.mixed(&self.formulas, &implicit, directions.pairs));
        for (place, mixed) in places.into_iter().zip(found.into_iter().flatten()) {
            together[place] = Some(mixed);
        }
        together
    }

    /// Evaluates these outputs along two dimensions, each with the amount by which it moves.
    fn jets(
        &self,
        asked: &[Origin],
        given: &[f64],
        tangent: Option<&Tangent<'_>>,
        directions: [(usize, f64); 2],
    ) -> Vec<Jet> {
        let along = |index: usize| directions.map(|(d, unit)| if d == index { unit } else { 0.0 });
        let unknowns = tangent.map_or_else(Vec::new, |tangent| tangent.jets(&along));
        let variable = |index: usize| match index.checked_sub(given.len()) {
            None => Jet::variable(given[index], along(index)),
            Some(unknown) => unknowns[unknown],
        };
        let formulas: Vec<usize> = (asked.iter())
            .filter_map(|origin| match origin {
                Origin::Formula(formula) => Some(*formula),
                _ => None,
            })
            .collect();
        let mut values = self.formulas.jets(&formulas, variable).into_iter();
        let jet = |origin: &Origin| match *origin {
            Origin::Unknown(unknown) => unknowns[unknown],
            _ => values.next().expect("a jet for every formula"),
        };
        asked.iter().map(jet).collect()
    }
}
