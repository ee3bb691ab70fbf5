//! Numbers of a table that are parsed together, since the style of decimals and thousands follows from all of them.

use crate::import::fault::{ImportFault, ImportProblem};
use crate::import::sheet::Content;
use crate::table::{NumberFault, NumberStyle};

/// A number and the name of its cell.
struct Figure {
    cell: String,
    /// Text of the cell; empty for a number of a workbook, which is not text.
    text: String,
    value: Option<f64>,
    /// Factor from the unit of its column to that of the nominal value.
    scale: f64,
}

/// Numbers of a table.
#[derive(Default)]
pub(super) struct Figures(Vec<Figure>);

impl Figures {
    /// Keeps a text to be parsed later. Returns its index.
    pub(super) fn keep(&mut self, cell: &str, text: &str, scale: f64) -> usize {
        self.0.push(Figure { cell: cell.to_owned(), text: text.to_owned(), value: None, scale });
        self.0.len() - 1
    }

    /// Keeps a number of a workbook. Returns its index.
    pub(super) fn keep_value(&mut self, cell: &str, value: f64, scale: f64) -> usize {
        self.0.push(Figure { cell: cell.to_owned(), text: String::new(), value: Some(value), scale });
        self.0.len() - 1
    }

    /// Keeps the number of a cell. Returns None for an empty cell.
    pub(super) fn keep_content(
        &mut self,
        cell: &str,
        content: &Content,
        scale: f64,
    ) -> Result<Option<usize>, ImportFault> {
        Ok(match content {
            Content::Empty | Content::Date(_) | Content::Error(_) => None,
            Content::Text(text) => Some(self.keep(cell, text, scale)),
            Content::Number { value, percent: false, .. } => Some(self.keep_value(cell, *value, scale)),
            Content::Number { value, percent: true, .. } => {
                let text = in_percent(*value).to_string();
                return Err(ImportFault::of(cell.to_owned(), ImportProblem::Percent { text }));
            }
        })
    }

    /// Name of the cell of a number.
    pub(super) fn cell(&self, place: usize) -> String {
        self.0[place].cell.clone()
    }

    /// True if the number was written with its sign. A number of a workbook has one if it is negative.
    pub(super) fn has_sign(&self, place: usize) -> bool {
        let figure = &self.0[place];
        match figure.value {
            Some(value) => value < 0.0,
            None => figure.text.trim().starts_with(['+', '-', '\u{2212}']),
        }
    }

    /// Values of all numbers, in the unit of their nominal values.
    pub(super) fn read(&self, commas_separate: bool) -> Result<Vec<f64>, ImportFault> {
        let style = NumberStyle::of(self.0.iter().map(|figure| figure.text.as_str()), commas_separate);
        let mut values = Vec::with_capacity(self.0.len());
        for (place, figure) in self.0.iter().enumerate() {
            let value = match figure.value {
                Some(value) => value,
                None => style.number(place, &figure.text).map_err(|fault| self.fault(figure, fault))?,
            };
            values.push(scaled(value, figure.scale));
        }
        Ok(values)
    }

    fn fault(&self, figure: &Figure, fault: NumberFault) -> ImportFault {
        let text = figure.text.clone();
        let problem = match fault {
            NumberFault::TwoMarks { other, .. } => ImportProblem::TwoMarks { text, other: self.0[other].cell.clone() },
            NumberFault::NoNumber { comma } => ImportProblem::NoNumber { text, comma },
            NumberFault::NotFinite => ImportProblem::NoNumber { text, comma: false },
        };
        ImportFault::of(figure.cell.clone(), problem)
    }
}

/// Product without the error of binary fractions: 5 times 0.001 is 0.005. Thirteen decimals of the mantissa remove it.
pub(super) fn scaled(value: f64, scale: f64) -> f64 {
    if scale == 1.0 { value } else { format!("{:.13e}", value * scale).parse().unwrap_or(value * scale) }
}

/// Percentage of a fraction: 0.02 is 2 %.
pub(super) fn in_percent(value: f64) -> f64 {
    scaled(value, 100.0)
}
