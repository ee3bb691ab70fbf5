//! Exact derivatives of what is made of formulas and unknowns alone.

use rayon::prelude::*;

use super::{Composite, Needs, Origin};
use crate::assembly::formula::Jet;
use crate::assembly::implicit::Tangent;
use crate::assembly::{Derivatives, Directions, Run};

impl Composite {
    /// For every output its derivatives; None for one that depends on the model.
    ///
    /// Cost: for `P` pairs and `N` inputs about ten evaluations of the formulas for each of `N + P` directions, and as many
    /// solutions of linear systems where there are unknowns.
    pub(super) fn exact(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
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
        let along = |u: usize, v: usize| self.jets(&asked, &given, tangent.as_ref(), u, v);
        let pure: Vec<Vec<Jet>> = directions.inputs.par_iter().map(|&d| along(d, d)).collect();
        let mixed: Vec<Vec<Jet>> = directions.pairs.par_iter().map(|&(j, k)| along(j, k)).collect();
        // Formulas know that there is none where the unknowns have none.
        let none = |needs: &Needs| {
            explicit(needs).then(|| Derivatives {
                first: vec![None; directions.inputs.len()],
                second: vec![None; directions.inputs.len()],
                mixed: vec![None; directions.pairs.len()],
            })
        };
        let mut derivatives: Vec<Option<Derivatives>> = needs.iter().map(none).collect();
        for (place, &k) in known.iter().enumerate() {
            let of = |jets: &[Vec<Jet>], part: &dyn Fn(&Jet) -> Option<f64>| {
                jets.iter().map(|jets| part(&jets[place])).collect::<Vec<_>>()
            };
            derivatives[k] = Some(Derivatives {
                first: of(&pure, &|jet| jet.first(0)),
                second: of(&pure, &Jet::second),
                mixed: of(&mixed, &Jet::second),
            });
        }
        derivatives
    }

    /// These outputs along two dimensions.
    fn jets(&self, asked: &[Origin], given: &[f64], tangent: Option<&Tangent<'_>>, u: usize, v: usize) -> Vec<Jet> {
        let along = |index: usize| [u, v].map(|d| f64::from(u8::from(d == index)));
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
