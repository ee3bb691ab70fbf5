//! Spread of a dimension: its tolerance or its limits, from the cells of a row.

use crate::import::columns::ColumnRole;
use crate::import::fault::{ImportFault, ImportProblem};
use crate::import::figures::{Figures, in_percent};
use crate::import::header::Header;
use crate::import::sheet::Content;
use crate::import::tolerance::{Written, written};
use crate::import::units::Scales;

/// Relative difference below which limits and deviations agree: they are written with the same digits.
const AGREE: f64 = 1e-9;

/// Tolerance of a row as written. Its numbers are indices into [`Figures`].
#[derive(Debug)]
pub(super) enum Band {
    None,
    Half(usize),
    /// One deviation; the other one is 0.
    OneSided(usize),
    Two([usize; 2]),
    /// Upper deviation, and lower one that is negative without a sign.
    UpperMinus([usize; 2]),
    /// Upper and lower deviation.
    UpperLower([usize; 2]),
    /// Greatest and least value, or the deviations in columns that may hold either.
    Limits([usize; 2]),
    Percent(usize),
    Class(String),
}

/// Tolerance of a dimension in numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Spread {
    None,
    /// Lower and upper deviation.
    Deviations([f64; 2]),
    /// Lower and upper limit.
    Limits([f64; 2]),
    Percent(f64),
    Class(String),
}

impl Spread {
    /// True if one of two deviations is 0 and the other one is not.
    pub(super) fn is_one_sided(&self, nominal: f64) -> bool {
        match self {
            Self::Deviations([low, high]) => (*low == 0.0) != (*high == 0.0),
            Self::Limits([low, high]) => (*low == nominal) != (*high == nominal),
            Self::None | Self::Percent(_) | Self::Class(_) => false,
        }
    }

    /// Lower and upper deviation. Returns None if the table does not hold them as numbers.
    pub(super) fn deviations(&self, nominal: f64) -> Option<[f64; 2]> {
        match self {
            Self::None => Some([0.0, 0.0]),
            Self::Deviations(both) => Some(*both),
            Self::Limits(both) => Some(both.map(|limit| limit - nominal)),
            Self::Percent(part) => Some([-part.abs(), part.abs()].map(|part| 0.01 * part * nominal.abs())),
            Self::Class(_) => None,
        }
    }
}

/// Tolerance of a row, and the limits that stand beside it.
pub(super) fn band(
    header: &Header,
    line: u64,
    content: &[Content],
    scales: &Scales,
    figures: &mut Figures,
) -> Result<(Band, Option<[usize; 2]>), ImportFault> {
    let cell = |role: ColumnRole| header.cell(role, line);
    let of = |role: ColumnRole| header.of(role, content);
    let lower_role = if *of(ColumnRole::Minus) == Content::Empty { ColumnRole::Lower } else { ColumnRole::Minus };
    let mut both = |upper: ColumnRole, lower: ColumnRole| {
        let mut figure = |role: ColumnRole| figures.keep_content(&cell(role), of(role), scales.of(role));
        match (figure(upper)?, figure(lower)?) {
            (Some(upper), Some(lower)) => Ok(Some([upper, lower])),
            (None, None) => Ok(None),
            (found, _) => {
                let missing = if found.is_some() { lower } else { upper };
                Err(ImportFault::of(cell(missing), ImportProblem::OneDeviation))
            }
        }
    };
    let deviations = both(ColumnRole::Upper, lower_role)?;
    let limits = both(ColumnRole::Max, ColumnRole::Min)?;
    let one = in_one_cell(header, line, content, scales, figures)?;
    let found = match (one, deviations) {
        (Some(_), Some([upper, _])) => {
            let problem = ImportProblem::ToleranceTwice { other: figures.cell(upper) };
            return Err(ImportFault::of(cell(tolerance_role(of)), problem));
        }
        (Some(one), None) => one,
        (None, Some(both)) if lower_role == ColumnRole::Minus => Band::UpperMinus(both),
        (None, Some(both)) => Band::UpperLower(both),
        (None, None) => return Ok((limits.map_or(Band::None, Band::Limits), None)),
    };
    Ok((found, limits))
}

/// Role of the column that holds the tolerance of a row in one cell.
fn tolerance_role<'c>(of: impl Fn(ColumnRole) -> &'c Content) -> ColumnRole {
    if *of(ColumnRole::Tolerance) == Content::Empty { ColumnRole::PlusMinus } else { ColumnRole::Tolerance }
}

/// Tolerance in one cell of a row. Returns None if the cell is empty.
fn in_one_cell(
    header: &Header,
    line: u64,
    content: &[Content],
    scales: &Scales,
    figures: &mut Figures,
) -> Result<Option<Band>, ImportFault> {
    let of = |role: ColumnRole| header.of(role, content);
    let role = tolerance_role(of);
    let (at, scale, symmetric) = (header.cell(role, line), scales.of(role), role == ColumnRole::PlusMinus);
    if symmetric && *of(ColumnRole::Tolerance) != Content::Empty && *of(ColumnRole::PlusMinus) != Content::Empty {
        let other = header.cell(ColumnRole::PlusMinus, line);
        return Err(ImportFault::of(at, ImportProblem::ToleranceTwice { other }));
    }
    let percent = header.unit(role) == Some("%");
    let text = match of(role) {
        Content::Text(text) => text,
        Content::Number { value, percent: false, .. } if percent => {
            return Ok(Some(Band::Percent(figures.keep_value(&at, *value, 1.0))));
        }
        Content::Number { value, percent: false, plus } => {
            let one = figures.keep_value(&at, *value, scale);
            let signed = (*plus || *value < 0.0) && !symmetric && *value != 0.0;
            return Ok(Some(if signed { Band::OneSided(one) } else { Band::Half(one) }));
        }
        Content::Number { value, percent: true, .. } => {
            return Ok(Some(Band::Percent(figures.keep_value(&at, in_percent(*value), 1.0))));
        }
        Content::Empty | Content::Date(_) | Content::Error(_) => return Ok(None),
    };
    let no_tolerance = || ImportFault::of(at.clone(), ImportProblem::NoTolerance { text: text.clone() });
    Ok(Some(match written(text).ok_or_else(no_tolerance)? {
        Written::Half(half) if percent => Band::Percent(figures.keep(&at, &half, 1.0)),
        Written::Half(half) => Band::Half(figures.keep(&at, &half, scale)),
        Written::OneSided(one) if symmetric => Band::Half(figures.keep(&at, &one, scale)),
        Written::OneSided(one) if !percent => Band::OneSided(figures.keep(&at, &one, scale)),
        Written::Percent(part) => Band::Percent(figures.keep(&at, &part, 1.0)),
        Written::Unsigned(both) if !percent => Band::UpperMinus(both.map(|one| figures.keep(&at, &one, scale))),
        Written::Two(both) if !percent => Band::Two(both.map(|one| figures.keep(&at, &one, scale))),
        Written::Class(class) if !percent => Band::Class(class),
        Written::MissingSign => return Err(ImportFault::of(at, ImportProblem::MissingSign { text: text.clone() })),
        _ => return Err(no_tolerance()),
    }))
}

/// Reading of columns that hold limits in one table and deviations in another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LimitReading {
    Limits,
    Deviations,
}

/// Reading of the columns of limits that fits all rows: nominal, greatest and least value of each.
pub(super) fn limit_reading(header: &Header, rows: &[[f64; 3]]) -> Result<LimitReading, ImportFault> {
    let limits = rows.iter().all(|[nominal, high, low]| low <= nominal && nominal <= high);
    let deviations = rows.iter().all(|[_, high, low]| *low <= 0.0 && 0.0 <= *high);
    let about_zero = rows.iter().all(|[nominal, ..]| *nominal == 0.0);
    match (limits, deviations) {
        _ if !header.either || header.is_given(ColumnRole::Max) || header.is_given(ColumnRole::Min) => {
            Ok(LimitReading::Limits)
        }
        (true, false) => Ok(LimitReading::Limits),
        (false, true) => Ok(LimitReading::Deviations),
        (true, true) if about_zero => Ok(LimitReading::Deviations),
        _ => {
            let [upper, lower] = [ColumnRole::Max, ColumnRole::Min].map(|role| header.text(role));
            let problem = ImportProblem::LimitsOrDeviations { upper, lower };
            Err(ImportFault::of(header.own_cell(ColumnRole::Max), problem))
        }
    }
}

/// Spread of a dimension by the numbers of its row.
pub(super) fn spread(
    band: &Band,
    nominal: f64,
    reading: LimitReading,
    values: &[f64],
    figures: &Figures,
) -> Result<Spread, ImportFault> {
    let at = |place: usize, problem: ImportProblem| ImportFault::of(figures.cell(place), problem);
    let ordered = |[low, high]: [f64; 2], place: usize| match (low == high, low > high) {
        (true, _) if low == 0.0 => Ok(Spread::None),
        (true, _) => Err(at(place, ImportProblem::EqualDeviations { value: high })),
        (_, true) => Err(at(place, ImportProblem::SwappedDeviations { upper: high, lower: low })),
        _ => Ok(Spread::Deviations([low, high])),
    };
    match band {
        Band::None => Ok(Spread::None),
        Band::Half(half) => match values[*half] {
            0.0 => Ok(Spread::None),
            value if value < 0.0 => Err(at(*half, ImportProblem::NegativeTolerance { value })),
            half => Ok(Spread::Deviations([-half, half])),
        },
        Band::OneSided(one) => ordered([values[*one].min(0.0), values[*one].max(0.0)], *one),
        Band::Two([a, b]) => ordered([values[*a].min(values[*b]), values[*a].max(values[*b])], *a),
        Band::UpperMinus([upper, lower]) => {
            let low = if figures.has_sign(*lower) { values[*lower] } else { -values[*lower].abs() };
            ordered([low, values[*upper]], *upper)
        }
        Band::UpperLower([upper, lower]) => ordered([values[*lower], values[*upper]], *upper),
        Band::Limits([high, low]) => {
            let (high_at, [high, low]) = (*high, [values[*high], values[*low]]);
            if reading == LimitReading::Deviations {
                return ordered([low, high], high_at);
            }
            match (low == high, low > high) {
                (true, _) if low == nominal => Ok(Spread::None),
                (true, _) => Err(at(high_at, ImportProblem::EqualDeviations { value: high })),
                (_, true) => Err(at(high_at, ImportProblem::SwappedDeviations { upper: high, lower: low })),
                _ => Ok(Spread::Limits([low, high])),
            }
        }
        Band::Percent(part) => match values[*part] {
            0.0 => Ok(Spread::None),
            value if value < 0.0 => Err(at(*part, ImportProblem::NegativeTolerance { value })),
            part => Ok(Spread::Percent(part)),
        },
        Band::Class(class) => Ok(Spread::Class(class.clone())),
    }
}

/// Refuses limits that contradict the tolerance beside them.
pub(super) fn same_limits(
    spread: &Spread,
    nominal: f64,
    limits: [usize; 2],
    values: &[f64],
    figures: &Figures,
) -> Result<(), ImportFault> {
    let Some([low, high]) = spread.deviations(nominal) else { return Ok(()) };
    let given = [values[limits[1]], values[limits[0]]];
    let near = |one: [f64; 2]| {
        let scale = one.iter().chain(&given).fold(0.0f64, |most, value| most.max(value.abs()));
        one.iter().zip(given).all(|(one, given)| (one - given).abs() <= AGREE * scale)
    };
    if near([nominal + low, nominal + high]) || near([low, high]) {
        return Ok(());
    }
    let problem = ImportProblem::LimitsDiffer { lower: nominal + low, upper: nominal + high };
    Err(ImportFault::of(figures.cell(limits[0]), problem))
}

/// Refuses a column of lower deviations with and without signs: 0.02 beside -0.05 may lie above the nominal value or below.
pub(super) fn refuse_mixed_signs<'b>(
    bands: impl Iterator<Item = &'b Band>,
    values: &[f64],
    figures: &Figures,
) -> Result<(), ImportFault> {
    let lowers = bands.filter_map(|band| if let Band::UpperMinus([_, lower]) = band { Some(*lower) } else { None });
    let lowers: Vec<usize> = lowers.filter(|lower| values[*lower] != 0.0).collect();
    let signed = lowers.iter().find(|lower| values[**lower] < 0.0);
    let bare = lowers.iter().find(|lower| !figures.has_sign(**lower));
    match (signed, bare) {
        (Some(signed), Some(bare)) => {
            let problem = ImportProblem::MixedSigns { other: figures.cell(*signed) };
            Err(ImportFault::of(figures.cell(*bare), problem))
        }
        _ => Ok(()),
    }
}
