//! Switches and degree of the outputs of a composite.

use crate::assembly::composite::{Composite, Origin, Source};
use crate::assembly::implicit::{PressedJoint, RowSolution};
use crate::assembly::{ContactSets, Points, Polynomial, Run, Switch, SwitchKind, Switches};
use sensitol_numeric::parallel::prelude::*;

/// Marks the comparisons of a joint that presses as changes of its contacts, if all of them are among the switches.
fn name_contacts(switches: &mut Switches, pressed: &PressedJoint) {
    let place = |change: &String| {
        switches.list.iter().position(|switch| switch.kind == SwitchKind::Branch && switch.text == *change)
    };
    let Some(places) = pressed.changes.iter().map(place).collect::<Option<Vec<usize>>>() else { return };
    for &place in &places {
        let text = format!("the contacts of joint `{}`", pressed.joint);
        switches.list[place] = Switch { kind: SwitchKind::Contact, text, formula: None, span: 0..0 };
    }
    let (joint, sets) = (pressed.joint.clone(), pressed.sets.clone());
    switches.contacts.push(ContactSets { joint, sets, switches: places });
}

/// Rows whose unknowns one task solves.
const ROWS: usize = 128;
/// Margins of a solver: no state found, state found.
const SOLVED: [f64; 2] = [-1.0, 1.0];

impl Composite {
    /// Returns the formulas whose switches an output has: its own, those that drive the model, and the conditions if it needs the unknowns.
    fn switching(&self, origin: Origin) -> Vec<usize> {
        let own = match origin {
            Origin::Formula(formula) => vec![formula],
            Origin::Model(_) | Origin::Unknown(_) => Vec::new(),
        };
        let conditions = if self.needs(origin).unknowns { self.named..self.formulas.len() } else { 0..0 };
        // A switch of a driving formula changes the form of the model's answers.
        let driving = if self.needs(origin).answers.is_empty() { Vec::new() } else { self.driving() };
        own.into_iter().chain(driving).chain(conditions).collect()
    }

    pub(super) fn switches_of(&self, output: usize) -> Option<Switches> {
        let origin = self.outputs[output];
        let needs = self.needs(origin);
        let list = self.formulas.switches(&self.switching(origin));
        let mut switches = Switches { list, complete: true, contacts: Vec::new() };
        if needs.unknowns {
            let pressed = self.assembler.iter().flat_map(|assembler| &assembler.pressed);
            pressed.for_each(|joint| name_contacts(&mut switches, joint));
            let text = "the solution of the closure conditions".to_owned();
            switches.list.push(Switch { kind: SwitchKind::Edge, text, formula: None, span: 0..0 });
        }
        for answer in needs.answers {
            match self.model.as_ref().and_then(|model| model.function.switches(answer)) {
                Some(more) => {
                    switches.complete &= more.complete;
                    switches.list.extend(more.list);
                }
                None => switches.complete = false,
            }
        }
        (switches.complete || !switches.list.is_empty()).then_some(switches)
    }

    pub(super) fn margins_of(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
        let origin = self.outputs[output];
        let needs = self.needs(origin);
        if self.signature.costly && !needs.answers.is_empty() {
            return None;
        }
        let (rows, dimensions, given) = (points.rows(), self.signature.inputs.len(), self.given());
        let answers = self.ask_model(points, &Run::to_the_end(), &needs.answers);
        let column = |index: usize| -> &[f64] {
            match index.checked_sub(dimensions) {
                None => points.column(index),
                Some(output) => answers.column(needs.answers.binary_search(&output).expect("the model was asked")),
            }
        };
        let mut unknowns = vec![Vec::with_capacity(rows); self.assembler.as_ref().map_or(0, |of| of.len())];
        let mut solved: Vec<f64> = Vec::new();
        if let (true, Some(assembler)) = (needs.unknowns, &self.assembler) {
            match self.anchor(&Run::to_the_end()).0 {
                Some(Ok(anchor)) => {
                    let block = |first: usize| {
                        let rows = ROWS.min(rows - first);
                        let variable = |index: usize, row: usize| column(index)[first + row];
                        RowSolution::of((assembler, &self.formulas), &anchor, rows, given, variable)
                    };
                    let starts: Vec<usize> = (0..rows).step_by(ROWS).collect();
                    let blocks: Vec<RowSolution> = starts.into_par_iter().map(block).collect();
                    for found in blocks {
                        unknowns.iter_mut().zip(found.columns).for_each(|(all, block)| all.extend(block));
                        solved.extend(found.errors.iter().map(|error| SOLVED[usize::from(error.is_none())]));
                    }
                }
                _ => {
                    unknowns.iter_mut().for_each(|column| column.resize(rows, f64::NAN));
                    solved = vec![SOLVED[0]; rows];
                }
            }
        }
        let variable = |index: usize| match index.checked_sub(given) {
            None => column(index),
            Some(unknown) => &unknowns[unknown],
        };
        let mut margins = self.formulas.margins(&self.switching(origin), rows, variable);
        if needs.unknowns {
            margins.push(solved);
        }
        if let Some(model) = &self.model {
            let sent = self.sent(points, &Run::to_the_end());
            for &answer in &needs.answers {
                if model.function.switches(answer).is_some() {
                    margins.extend(model.function.margins(answer, &sent.columns)?);
                }
            }
        }
        Some(margins)
    }

    /// Returns an output as a polynomial if it is a formula of dimensions alone.
    pub(super) fn polynomial_of(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        let dimensions = self.signature.inputs.len();
        let Origin::Formula(formula) = self.outputs[output] else { return None };
        let variable =
            |index: usize| (index < dimensions).then(|| Polynomial::input(index, centre[index], scale[index]));
        self.formulas.polynomial(formula, &variable)
    }

    pub(super) fn degree_of(&self, output: usize, varying: &[bool]) -> Option<u32> {
        let of_answer = |output: usize| {
            let model = self.model.as_ref()?;
            let dimensions = self.signature.inputs.len();
            let of_source = |source: &Source| match *source {
                Source::Dimension(dimension) => Some(u32::from(varying[dimension])),
                Source::Fixed(_) => Some(0),
                Source::Formula(formula) => {
                    self.formulas.degree(formula, |index| (index < dimensions).then(|| u32::from(varying[index])))
                }
            };
            let degrees = model.inputs.iter().map(of_source).collect::<Option<Vec<u32>>>()?;
            let own = model.function.degree(output, &degrees.iter().map(|&degree| degree > 0).collect::<Vec<_>>())?;
            own.checked_mul(degrees.into_iter().max().unwrap_or(0).max(1))
        };
        let (dimensions, given) = (self.signature.inputs.len(), self.given());
        let variable = |index: usize| match index.checked_sub(dimensions) {
            None => Some(u32::from(varying[index])),
            Some(output) if index < given => of_answer(output),
            Some(_) => None,
        };
        match self.outputs[output] {
            Origin::Formula(formula) => self.formulas.degree(formula, variable),
            Origin::Model(output) => of_answer(output),
            Origin::Unknown(_) => None,
        }
    }
}
