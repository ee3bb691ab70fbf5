//! Conversion of units between a study and a program: a factor for every dimension and characteristic.

use super::protocol::{Hello, Line};
use crate::settings::ForeignUnits;
use sensitol::assembly::ProcessFault;
use sensitol_numeric::unit::{SAME, Unit};

/// Factors from the study's units to those of the program. Empty lists stand for factors of 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Border {
    inputs: Vec<f64>,
    outputs: Vec<f64>,
}

impl Border {
    /// Factors between the units of a study and those that a program declares. A unit that is missing or unknown on either side gives a
    /// factor of 1.
    pub(super) fn of(hello: &Hello, said: &serde_json::Value, held: ForeignUnits) -> Result<Self, ProcessFault> {
        if held == ForeignUnits::Ignored {
            return Ok(Self::default());
        }
        let factor = |(name, unit): (&String, &Option<String>)| {
            let both = unit.as_deref().zip(said.get(name).and_then(serde_json::Value::as_str));
            let Some((study, own)) = both else { return Ok(1.0) };
            let (Some(given), Some(model)) = (Unit::parse(study), Unit::parse(own)) else { return Ok(1.0) };
            // Temperature scales with different zeros differ by an offset, so no factor converts them.
            let kind = given.same_kind(&model) && given.point == model.point;
            let factor = given.scale / model.scale;
            let same = (factor - 1.0).abs() <= SAME;
            let converted = held == ForeignUnits::Converted && !given.point;
            match kind && (same || converted) {
                true => Ok(if same { 1.0 } else { factor }),
                false => {
                    let [name, study, own] = [name, study, own].map(str::to_owned);
                    Err(ProcessFault::ForeignUnit { name, study, own, factor: kind.then_some(factor) })
                }
            }
        };
        let inputs = hello.dimensions.iter().zip(&hello.units).map(factor).collect::<Result<Vec<f64>, _>>()?;
        let asked = hello.characteristics.iter().zip(&hello.asked_units);
        let outputs = asked.map(factor).collect::<Result<Vec<f64>, _>>()?;
        let plain = inputs.iter().chain(&outputs).all(|factor| *factor == 1.0);
        Ok(if plain { Self::default() } else { Self { inputs, outputs } })
    }

    /// True if no number is converted.
    pub(super) fn is_open(&self) -> bool {
        self.inputs.is_empty() && self.outputs.is_empty()
    }

    /// Point in the units of the program.
    pub(super) fn out(&self, point: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
        point.enumerate().map(|(input, x)| self.inputs.get(input).map_or(x, |factor| x * factor))
    }

    /// Converts an answer to the units of the study. Its shape need not be correct yet.
    pub(super) fn back(&self, line: &mut Line) {
        let value = |y: &mut Option<f64>, factor: f64| y.iter_mut().for_each(|y| *y /= factor);
        line.y.iter_mut().flatten().zip(&self.outputs).for_each(|(y, factor)| value(y, *factor));
        for (row, output) in line.dy.iter_mut().flatten().zip(&self.outputs) {
            row.iter_mut().zip(&self.inputs).for_each(|(slope, input)| *slope *= input / output);
        }
    }
}
