//! Exact derivatives of outputs that depend on formulas and unknowns alone.

use crate::assembly::composite::{Composite, Needs, Origin};
use crate::assembly::formula::Jet;
use crate::assembly::implicit::{ImplicitOutput, Tangent};
use crate::assembly::{Derivatives, Directions, Run};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::power::Power;

/// Number of pairs from which a tape of the formula is faster than a jet for each pair.
const TOGETHER: usize = 64;

/// Number of inputs from which a tape of the formula is used in place of a jet for each input. Below it both take less than 1 ms.
const MANY: usize = 256;

/// First and second derivatives of one output by every input; None where one does not exist.
struct PureDerivatives {
    first: Vec<Option<f64>>,
    second: Vec<Option<f64>>,
}

/// Outputs with the point at which they are differentiated.
#[derive(Clone, Copy)]
struct Place<'c> {
    asked: &'c [Origin],
    given: &'c [f64],
    tangent: Option<&'c Tangent<'c>>,
    /// Exponents of the units of the inputs; None if each is 1.
    exponents: Option<&'c [i32]>,
}

impl Place<'_> {
    /// Returns the amount by which an input moves along its direction.
    fn unit(&self, input: usize) -> f64 {
        self.exponents.map_or(1.0, |all| Power::of_exponent(all[input]).times(1.0))
    }
}

/// Returns the outputs that have no derivatives yet.
fn open<T>(asked: &[Origin], together: &[Option<T>]) -> Vec<Origin> {
    asked.iter().zip(together).filter(|(_, together)| together.is_none()).map(|(&origin, _)| origin).collect()
}

impl Composite {
    /// Returns the derivatives of every output, or None for one that depends on the model.
    ///
    /// With `exponents` the derivatives are per unit of `2^exponent` of each input, as in
    /// [`derivatives_per`](crate::AssemblyFunction::derivatives_per).
    ///
    /// Cost: for `P` pairs and `N` inputs about ten evaluations of the formulas for each of `N + P` directions. With unknowns, as many
    /// linear systems are solved. If `P` is 64 or more and there are no loops, it is `2 N` directions and `N` linear systems. From 256 inputs
    /// on, formulas without unknowns take one tape for all first and second derivatives.
    pub(super) fn exact(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: Option<&[i32]>,
    ) -> Vec<Option<Derivatives>> {
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
        let place = Place { asked: &asked, given: &given, tangent: tangent.as_ref(), exponents };
        let pure = self.pure(&place, directions.inputs);
        let mixed = self.mixed(&place, directions.pairs);
        // If the unknowns have no derivatives, the formulas have none either. That is known, in contrast to an output of the model.
        let none = |needs: &Needs| {
            explicit(needs).then(|| Derivatives {
                first: vec![None; directions.inputs.len()],
                second: vec![None; directions.inputs.len()],
                mixed: vec![None; directions.pairs.len()],
            })
        };
        let mut derivatives: Vec<Option<Derivatives>> = needs.iter().map(none).collect();
        for ((&k, PureDerivatives { first, second }), mixed) in known.iter().zip(pure).zip(mixed) {
            derivatives[k] = Some(Derivatives { first, second, mixed });
        }
        derivatives
    }

    /// Returns the first and the second derivatives of every output by these inputs, None where one does not exist.
    fn pure(&self, place: &Place<'_>, inputs: &[usize]) -> Vec<PureDerivatives> {
        // One tape gives those of a formula with many inputs.
        let together = |&origin: &Origin| match origin {
            Origin::Formula(formula)
                if inputs.len() >= MANY && place.exponents.is_none() && !self.needs(origin).unknowns =>
            {
                self.formulas.pure(formula, place.given, inputs)
            }
            _ => None,
        };
        let together: Vec<Option<Vec<[f64; 2]>>> = place.asked.iter().map(together).collect();
        // All other outputs need one jet for each input.
        let open = open(place.asked, &together);
        let along = |&d: &usize| self.jets(place, &open, (d, d));
        let jets: Vec<Vec<Jet>> = if open.is_empty() { Vec::new() } else { inputs.par_iter().map(along).collect() };
        let mut of_open = (0..open.len()).map(|output| {
            let first = jets.iter().map(|jets| jets[output].first(0)).collect();
            PureDerivatives { first, second: jets.iter().map(|jets| jets[output].second()).collect() }
        });
        let of_output = |together: Option<Vec<[f64; 2]>>| match together {
            Some(known) => {
                let (first, second) = known.into_iter().map(|[first, second]| (Some(first), Some(second))).unzip();
                PureDerivatives { first, second }
            }
            None => of_open.next().expect("jets for every output that is open"),
        };
        together.into_iter().map(of_output).collect()
    }

    /// Returns the mixed derivatives of every output by these pairs of inputs, None where one does not exist.
    fn mixed(&self, place: &Place<'_>, pairs: &[(usize, usize)]) -> Vec<Vec<Option<f64>>> {
        // A jet for each pair, unless a tape gives all pairs at once.
        let together = self.mixed_together(place, pairs);
        let open = open(place.asked, &together);
        let along = |&pair: &(usize, usize)| self.jets(place, &open, pair);
        let jets: Vec<Vec<Jet>> = if open.is_empty() { Vec::new() } else { pairs.par_iter().map(along).collect() };
        let mut of_open = (0..open.len()).map(|output| jets.iter().map(|jets| jets[output].second()).collect());
        let of_output = |together: Option<Vec<f64>>| match together {
            Some(together) => together.into_iter().map(Some).collect(),
            None => of_open.next().expect("jets for every output that is open"),
        };
        together.into_iter().map(of_output).collect()
    }

    /// Returns all mixed derivatives of every output, or None for an output with a derivative that may not exist, and for few pairs.
    fn mixed_together(&self, place: &Place<'_>, pairs: &[(usize, usize)]) -> Vec<Option<Vec<f64>>> {
        let Place { asked, given, tangent, exponents } = *place;
        let mut together = vec![None; asked.len()];
        if pairs.len() < TOGETHER || exponents.is_some() {
            return together;
        }
        let (mut places, mut implicit) = (Vec::new(), Vec::new());
        for (place, &origin) in asked.iter().enumerate() {
            match origin {
                Origin::Formula(formula) if !self.needs(origin).unknowns => {
                    together[place] = self.formulas.mixed(formula, given, pairs);
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
        let found = found.and_then(|tangent| tangent.mixed(&self.formulas, &implicit, pairs));
        for (place, mixed) in places.into_iter().zip(found.into_iter().flatten()) {
            together[place] = Some(mixed);
        }
        together
    }

    /// Evaluates these outputs along two inputs, each of which moves by its unit.
    fn jets(&self, place: &Place<'_>, asked: &[Origin], (u, v): (usize, usize)) -> Vec<Jet> {
        let Place { given, tangent, .. } = *place;
        let directions = [u, v].map(|input| (input, place.unit(input)));
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
