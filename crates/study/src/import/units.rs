//! Units of a row: that of the nominal value, and the factors from other columns to it.

use crate::import::columns::{ColumnRole, unit_of};
use crate::import::fault::{ImportFault, ImportProblem};
use crate::import::header::Header;
use crate::import::sheet::Content;
use sensitol_numeric::unit::{SAME, Unit};

/// Roles whose numbers are lengths as the nominal value is.
const LENGTHS: [ColumnRole; 9] = [
    ColumnRole::Upper,
    ColumnRole::Lower,
    ColumnRole::Minus,
    ColumnRole::Tolerance,
    ColumnRole::PlusMinus,
    ColumnRole::Max,
    ColumnRole::Min,
    ColumnRole::Sigma,
    ColumnRole::Shift,
];

/// Unit of the nominal value of a row, and factors of its other columns to it.
#[derive(Debug)]
pub(super) struct Scales {
    /// Unit of the nominal value; None if the table has none.
    pub(super) unit: Option<String>,
    factors: Vec<(ColumnRole, f64)>,
}

impl Scales {
    /// Units of a row. `all` is the unit of all numbers of the table, if a title says one.
    pub(super) fn of_row(
        header: &Header,
        line: u64,
        content: &[Content],
        all: Option<&str>,
    ) -> Result<Self, ImportFault> {
        let own = header.of(ColumnRole::Unit, content).words();
        let headed = header.unit(ColumnRole::Nominal);
        let unit = match (own, headed) {
            (Some(own), Some(headed)) if !same(&own, headed) => {
                let problem = ImportProblem::TwoUnits { unit: own, other: headed.to_owned() };
                return Err(ImportFault::of(header.cell(ColumnRole::Unit, line), problem));
            }
            (Some(own), _) => Some(unit_of(&own).unwrap_or(own)),
            (None, headed) => headed.or(all).map(str::to_owned),
        };
        let mut factors = Vec::new();
        for role in LENGTHS {
            let Some(other) = header.unit(role).filter(|other| *other != "%") else { continue };
            let fault = |problem| ImportFault::of(header.own_cell(role), problem);
            let Some(unit) = &unit else {
                let nominal = header.text(ColumnRole::Nominal);
                return Err(fault(ImportProblem::UnitAlone { unit: other.to_owned(), nominal }));
            };
            let factor = factor(other, unit);
            let two = || ImportProblem::TwoUnits { unit: other.to_owned(), other: unit.clone() };
            factors.push((role, factor.ok_or_else(|| fault(two()))?));
        }
        Ok(Self { unit, factors })
    }

    /// Factor of a column to the unit of the nominal value.
    pub(super) fn of(&self, role: ColumnRole) -> f64 {
        self.factors.iter().find(|(known, _)| *known == role).map_or(1.0, |(_, factor)| *factor)
    }
}

fn same(one: &str, other: &str) -> bool {
    one == other || factor(one, other).is_some_and(|factor| (factor - 1.0).abs() <= SAME)
}

/// Factor between two units. Returns None if they do not measure the same or one is unknown.
fn factor(from: &str, to: &str) -> Option<f64> {
    if from == to {
        return Some(1.0);
    }
    let [from, to] = [from, to].map(|text| Unit::parse(text).map(|unit| unit.difference()));
    let (from, to) = (from?, to?);
    let ratio = from.scale / to.scale;
    // A power of ten such as 1e-6/1e-3 has an error of the division.
    let ratio = format!("{ratio:.14e}").parse().unwrap_or(ratio);
    (from.same_kind(&to) && (from.radians - to.radians).abs() < SAME).then_some(ratio)
}
