//! The stack of one characteristic with live formulas.
//!
//! ```text
//! middle  m_i = nominal_i + (lower_i + upper_i)/2,    half band T_i = (upper_i - lower_i)/2
//! effect  e_i = |b_i| T_i                             b_i: factor, the slope at the mean
//! totals  sum b_i m_i  with  sum e_i,  sqrt(sum e_i^2)  and their mixtures;  sum b_i mean_i  with  3 sqrt(sum (b_i sigma_i)^2)
//! ```
//!
//! The remainder of the report's value at the middle of all bands, for example from dimensions that do not vary, has a row of its own
//! with the factor 1. The headers of the inputs are those that `sensitol import` reads. Totals have no nominal value, so the import
//! leaves them out.

use rust_xlsxwriter::{Format, Formula, Worksheet, XlsxError, utility::row_col_to_cell};

use crate::analysis::stack::{Stack, StackRow, TotalKind};
use crate::xlsx::book;
use sensitol::analysis::CharacteristicAnalysis;
use sensitol_numeric::labels::LABELS;

/// Half-width of a dimension without a band, and of the interval by moments, in sigmas.
const SIGMAS: f64 = 3.0;
/// Factor of the inflated RSS.
const INFLATION: f64 = 1.5;
/// Factor of the mean-shift RSS.
const MEAN_SHIFT: f64 = 0.5;
/// Greatest relative difference of a formula from the report.
const AGREE: f64 = 1e-9;
/// Greatest remainder of a sum that counts as rounding, as a part of the summed magnitudes.
const ROUNDING: f64 = 1e-13;
/// Row of the headers.
const HEADER: u32 = 2;
/// Width of a column in letters.
const WIDE: f64 = 14.0;

/// Column of the sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    Name,
    Label(usize),
    Factor,
    Nominal,
    Lower,
    Upper,
    Unit,
    Distribution,
    Sigma,
    Sigmas,
    Shift,
    Middle,
    Half,
    Mean,
    Deviation,
    Effect,
    Share,
}

impl Of {
    fn header(self) -> &'static str {
        match self {
            Self::Name => "name",
            Self::Label(place) => LABELS[place],
            Self::Factor => "factor",
            Self::Nominal => "nominal",
            Self::Lower => "lower deviation",
            Self::Upper => "upper deviation",
            Self::Unit => "unit",
            Self::Distribution => "distribution",
            Self::Sigma => "sigma",
            Self::Sigmas => "half band in sigmas",
            Self::Shift => "mean off middle",
            Self::Middle => "middle",
            Self::Half => "half band",
            Self::Mean => "mean",
            Self::Deviation => "standard dev",
            Self::Effect => "effect",
            Self::Share => "RSS %",
        }
    }
}

/// Figures of a row as its formulas compute them.
struct Figures {
    middle: f64,
    half: f64,
    mean: f64,
    deviation: f64,
    effect: f64,
    /// Factor times standard deviation.
    part: f64,
}

/// Returns the half-width in sigmas. Returns None if there is no band, or if the dimension does not vary.
fn sigmas(row: &StackRow) -> Option<f64> {
    let [lower, upper] = row.dimension.tolerance?;
    (row.dimension.sigma > 0.0).then(|| 0.5 * (upper - lower) / row.dimension.sigma)
}

/// Returns the sigma of a dimension that does not follow from its band.
fn own_sigma(row: &StackRow) -> Option<f64> {
    let sigma = Some(row.dimension.sigma).filter(|sigma| *sigma > 0.0)?;
    match sigmas(row) {
        None => Some(sigma),
        Some(of) if row.dimension.distribution == Some("normal") && (of - SIGMAS).abs() > AGREE => Some(sigma),
        Some(_) => None,
    }
}

/// Returns the distance of the mean from the middle of the band, 0 if it is rounding.
fn shift(row: &StackRow) -> f64 {
    let one = &row.dimension;
    let middle = one.tolerance.map_or(0.0, |[lower, upper]| 0.5 * (lower + upper));
    let shift = (one.mean - one.nominal) - middle;
    if shift.abs() <= AGREE * one.sigma { 0.0 } else { shift }
}

fn figures(row: &StackRow) -> Figures {
    let one = &row.dimension;
    let (middle, half) = match one.tolerance {
        Some([lower, upper]) => (one.nominal + (lower + upper) / 2.0, (upper - lower) / 2.0),
        None => (one.nominal + shift(row), SIGMAS * one.sigma),
    };
    let mean = if one.tolerance.is_some() { middle + shift(row) } else { middle };
    let factor = row.slope.unwrap_or(f64::NAN);
    let (effect, part) = (factor.abs() * half, factor * one.sigma);
    Figures { middle, half, mean, deviation: one.sigma, effect, part }
}

/// Returns the part of the value at the middle of all bands that no dimension contributes, or None if it is 0 or unknown.
fn constant(rows: &[StackRow], one: &CharacteristicAnalysis) -> Option<f64> {
    let parts: Vec<f64> = rows.iter().map(|row| row.slope.unwrap_or(f64::NAN) * figures(row).middle).collect();
    let constant = one.linear.middle? - parts.iter().sum::<f64>();
    // A remainder of the size of rounding errors is left out.
    let scale = parts.iter().map(|part| part.abs()).sum::<f64>();
    Some(constant).filter(|constant| constant.abs() > ROUNDING * scale)
}

/// Returns a name for this part that no dimension has.
fn name_of_constant(rows: &[StackRow]) -> String {
    let free = |name: &String| rows.iter().all(|row| row.dimension.name != *name);
    let numbered = |number: usize| if number == 1 { "constant".to_owned() } else { format!("constant {number}") };
    (1..).map(numbered).find(free).expect("numbers do not end")
}

struct Page<'w> {
    sheet: &'w mut Worksheet,
    columns: Vec<Of>,
    first: u32,
    last: u32,
    bold: Format,
    plain: Format,
    /// Format of cells that may be changed.
    input: Format,
}

impl Page<'_> {
    fn column(&self, of: Of) -> u16 {
        self.columns.iter().position(|column| *column == of).unwrap_or(0) as u16
    }

    /// Returns the name of a cell.
    fn cell(&self, row: u32, of: Of) -> String {
        row_col_to_cell(row, self.column(of))
    }

    /// Returns the range of all rows of a column.
    fn all(&self, of: Of) -> String {
        format!("{}:{}", self.cell(self.first, of), self.cell(self.last, of))
    }

    fn text(&mut self, row: u32, of: Of, text: &str, bold: bool) -> Result<(), XlsxError> {
        let format = if bold { &self.bold } else { &self.plain };
        book::text(
            self.sheet,
            row,
            self.columns.iter().position(|column| *column == of).unwrap_or(0) as u16,
            text,
            format,
        )
    }

    fn input(&mut self, row: u32, of: Of, value: Option<f64>) -> Result<(), XlsxError> {
        let column = self.column(of);
        value.map_or(Ok(()), |value| book::number(self.sheet, row, column, value, &self.input))
    }

    fn number(&mut self, row: u32, of: Of, value: Option<f64>) -> Result<(), XlsxError> {
        let column = self.column(of);
        value.map_or(Ok(()), |value| book::number(self.sheet, row, column, value, &self.plain))
    }

    /// Writes a formula with its value, or nothing if the value is unknown.
    fn formula(&mut self, row: u32, of: Of, formula: &str, value: f64) -> Result<(), XlsxError> {
        if !value.is_finite() {
            return Ok(());
        }
        let column = self.column(of);
        let formula = Formula::new(formula).set_result(format!("{value:?}"));
        self.sheet.write_formula_with_format(row, column, formula, &self.plain).map(|_| ())
    }
}

/// Writes the stack of one characteristic.
pub(super) fn write(sheet: &mut Worksheet, stack: &Stack, one: &CharacteristicAnalysis) -> Result<(), XlsxError> {
    let rows = &stack.rows;
    let labelled = |place: usize| rows.iter().any(|row| row.dimension.labels.texts()[place].is_some());
    let mut columns = vec![Of::Name];
    columns.extend((0..LABELS.len()).filter(|&place| labelled(place)).map(Of::Label));
    columns.extend([Of::Factor, Of::Nominal, Of::Lower, Of::Upper, Of::Unit, Of::Distribution]);
    if rows.iter().any(|row| own_sigma(row).is_some()) {
        columns.push(Of::Sigma);
    }
    columns.extend([Of::Sigmas, Of::Shift, Of::Middle, Of::Half, Of::Mean, Of::Deviation, Of::Effect, Of::Share]);
    let constant = constant(rows, one);
    let lines = rows.len() + usize::from(constant.is_some());
    let (first, last) = (HEADER + 1, HEADER + lines.max(1) as u32);
    let input = Format::new().set_background_color(0xFF_F8_DC);
    let mut page = Page { sheet, columns, first, last, bold: Format::new().set_bold(), plain: Format::new(), input };
    let unit = stack.unit.as_deref().map(|unit| format!(" [{unit}]")).unwrap_or_default();
    page.text(0, Of::Name, &format!("{}{unit}", stack.characteristic), true)?;
    for of in page.columns.clone() {
        page.text(HEADER, of, of.header(), true)?;
    }
    let mut all: Vec<(f64, Figures)> = rows.iter().map(|row| (row.slope.unwrap_or(f64::NAN), figures(row))).collect();
    let squares: f64 = all.iter().map(|(_, of)| of.effect * of.effect).sum();
    for ((line, row), (_, of)) in (first..).zip(rows).zip(&all) {
        dimension(&mut page, line, row, of, squares)?;
    }
    if let Some(value) = constant {
        page.text(last, Of::Name, &name_of_constant(rows), false)?;
        page.input(last, Of::Factor, Some(1.0))?;
        page.input(last, Of::Nominal, Some(value))?;
        // The remainder has the characteristic's unit.
        stack.unit.as_deref().map_or(Ok(()), |unit| page.text(last, Of::Unit, unit, false))?;
        let nominal = format!("={}", page.cell(last, Of::Nominal));
        page.formula(last, Of::Middle, &nominal, value)?;
        page.formula(last, Of::Mean, &nominal, value)?;
        all.push((1.0, Figures { middle: value, half: 0.0, mean: value, deviation: 0.0, effect: 0.0, part: 0.0 }));
    }
    let mut line = totals(&mut page, stack, one, &all)? + 1;
    for note in &stack.notes {
        page.text(line, Of::Name, &note.to_string(), false)?;
        line += 1;
    }
    page.text(line, Of::Name, "Tinted cells are inputs: formulas follow them.", false)?;
    for place in 0..page.columns.len() as u16 {
        page.sheet.set_column_width(place, if place == 0 { 2.0 * WIDE } else { WIDE })?;
    }
    page.sheet.set_freeze_panes(first, 1).map(|_| ())
}

/// Writes the row of a dimension.
fn dimension(page: &mut Page<'_>, line: u32, row: &StackRow, of: &Figures, squares: f64) -> Result<(), XlsxError> {
    let one = &row.dimension;
    page.text(line, Of::Name, &one.name, false)?;
    for (place, text) in one.labels.texts().into_iter().enumerate() {
        if let Some(text) = text {
            page.text(line, Of::Label(place), text, false)?;
        }
    }
    page.input(line, Of::Factor, row.slope)?;
    page.input(line, Of::Nominal, Some(one.nominal))?;
    page.input(line, Of::Lower, one.tolerance.map(|ends| ends[0]))?;
    page.input(line, Of::Upper, one.tolerance.map(|ends| ends[1]))?;
    for (at, text) in [(Of::Unit, one.unit.as_deref()), (Of::Distribution, one.distribution)] {
        text.map_or(Ok(()), |text| page.text(line, at, text, false))?;
    }
    let at = |page: &Page<'_>, of: Of| page.cell(line, of);
    let own = own_sigma(row);
    if own.is_some() {
        page.input(line, Of::Sigma, own)?;
    } else {
        page.input(line, Of::Sigmas, sigmas(row))?;
    }
    page.input(line, Of::Shift, Some(shift(row)))?;
    let [nominal, lower, upper] = [Of::Nominal, Of::Lower, Of::Upper].map(|of| at(page, of));
    let [shift, middle, half] = [Of::Shift, Of::Middle, Of::Half].map(|of| at(page, of));
    let sigma = match (own, sigmas(row)) {
        (Some(_), _) => at(page, Of::Sigma),
        (None, Some(_)) => format!("{half}/{}", at(page, Of::Sigmas)),
        (None, None) => "0".to_owned(),
    };
    let (of_middle, of_half, of_mean) = match one.tolerance {
        Some(_) => {
            (format!("{nominal}+({lower}+{upper})/2"), format!("({upper}-{lower})/2"), format!("{middle}+{shift}"))
        }
        None => (format!("{nominal}+{shift}"), format!("{SIGMAS}*({sigma})"), middle.clone()),
    };
    page.formula(line, Of::Middle, &format!("={of_middle}"), of.middle)?;
    page.formula(line, Of::Half, &format!("={of_half}"), of.half)?;
    page.formula(line, Of::Mean, &format!("={of_mean}"), of.mean)?;
    page.formula(line, Of::Deviation, &format!("={sigma}"), of.deviation)?;
    let effect = format!("=ABS({})*{half}", at(page, Of::Factor));
    page.formula(line, Of::Effect, &effect, of.effect)?;
    let effects = page.all(Of::Effect);
    let share = format!("=IF(SUMSQ({effects})=0,0,100*{}^2/SUMSQ({effects}))", at(page, Of::Effect));
    let value = if squares == 0.0 { 0.0 } else { 100.0 * of.effect * of.effect / squares };
    page.formula(line, Of::Share, &share, value)
}

/// Total with its formulas and their values.
struct Total {
    name: String,
    middle: (String, f64),
    half: (String, f64),
}

/// Writes factors, limits and totals, and returns the row after them.
fn totals(
    page: &mut Page<'_>,
    stack: &Stack,
    one: &CharacteristicAnalysis,
    all: &[(f64, Figures)],
) -> Result<u32, XlsxError> {
    let mut line = page.last + 2;
    let inputs = inputs(page, stack, line)?;
    line += inputs.len() as u32 + 1;
    titles(page, line)?;
    line += 1;
    let formulas = TotalFormulas::new(page, line, &inputs, all);
    // Dimensions that vary together are in no formula.
    let alone = near(formulas.rss, one.linear.rss, 0.0);
    let mut straight = None;
    for total in &stack.totals {
        let of_moments = matches!(total.kind, TotalKind::FirstOrder | TotalKind::SecondOrder);
        let live = formulas.total(total.kind, of_moments);
        let agrees = near(live.middle.1, total.middle, live.half.1) && near(live.half.1, total.half_width, 0.0);
        if of_moments && agrees {
            straight = Some(line);
        }
        if of_moments && !agrees && alone && live.half.1.is_finite() {
            interval(page, line, &Total { name: TotalKind::FirstOrder.name().to_owned(), ..live })?;
            line += 1;
            fixed(page, line, total.kind.name(), [total.middle, total.half_width])?;
        } else if agrees {
            interval(page, line, &live)?;
        } else {
            fixed(page, line, total.kind.name(), [total.middle, total.half_width])?;
        }
        line += 1;
    }
    if let (Some(at), Some(cpk)) = (straight, cpk(one)) {
        let [mean, half] = [page.cell(at, Of::Middle), page.cell(at, Of::Half)];
        let [_, _, lower, upper] = inputs;
        let sides = [
            stack.limits[1].map(|_| format!("({upper}-{mean})/{half}")),
            stack.limits[0].map(|_| format!("({mean}-{lower})/{half}")),
        ];
        let sides: Vec<String> = sides.into_iter().flatten().collect();
        page.text(line, Of::Name, "Cpk", false)?;
        page.formula(line, Of::Middle, &format!("=MIN({})", sides.join(",")), cpk)?;
        line += 1;
    }
    Ok(line)
}

/// Returns true if a figure of the report is that of a formula.
fn near(a: f64, b: Option<f64>, scale: f64) -> bool {
    b.is_some_and(|b| (a - b).abs() <= AGREE * scale.max(b.abs()))
}

/// Factors and limits, a row each; gives their cells.
fn inputs(page: &mut Page<'_>, stack: &Stack, from: u32) -> Result<[String; 4], XlsxError> {
    let inputs: [(&str, Option<f64>); 4] = [
        ("inflation factor", Some(INFLATION)),
        ("mean-shift factor", Some(MEAN_SHIFT)),
        ("lower limit", stack.limits[0]),
        ("upper limit", stack.limits[1]),
    ];
    for (line, (name, value)) in (from..).zip(inputs) {
        page.text(line, Of::Name, name, false)?;
        page.input(line, Of::Middle, value)?;
    }
    Ok([0, 1, 2, 3].map(|place| page.cell(from + place, Of::Middle)))
}

/// The headings of the totals.
fn titles(page: &mut Page<'_>, line: u32) -> Result<(), XlsxError> {
    for (of, title) in [
        (Of::Name, "total"),
        (Of::Middle, "middle"),
        (Of::Half, "half width"),
        (Of::Mean, "from"),
        (Of::Deviation, "to"),
    ] {
        page.text(line, of, title, true)?;
    }
    Ok(())
}

/// Formulas of the totals over all rows, with their values.
struct TotalFormulas {
    middle: (String, f64),
    mean: (String, f64),
    /// Cells of the inflation factor and of the mean-shift factor.
    factors: [String; 2],
    /// Cells of the half widths of worst case and RSS.
    cells: [String; 2],
    /// Half widths of worst case, RSS and moments.
    sums: [String; 3],
    worst: f64,
    rss: f64,
    sigma: f64,
}

impl TotalFormulas {
    /// Formulas of totals that begin in a line, worst case and RSS first.
    fn new(page: &Page<'_>, line: u32, [inflation, mean_shift, ..]: &[String; 4], all: &[(f64, Figures)]) -> Self {
        let sum = |of: fn(&Figures) -> f64| all.iter().map(|(slope, row)| slope * of(row)).sum::<f64>();
        let [factors, middles, means, deviations, effects] =
            [Of::Factor, Of::Middle, Of::Mean, Of::Deviation, Of::Effect].map(|of| page.all(of));
        Self {
            middle: (format!("SUMPRODUCT({factors},{middles})"), sum(|row| row.middle)),
            mean: (format!("SUMPRODUCT({factors},{means})"), sum(|row| row.mean)),
            factors: [inflation.clone(), mean_shift.clone()],
            cells: [page.cell(line, Of::Half), page.cell(line + 1, Of::Half)],
            sums: [
                format!("SUM({effects})"),
                format!("SQRT(SUMSQ({effects}))"),
                format!("{SIGMAS}*SQRT(SUMPRODUCT(({factors}*{deviations})^2))"),
            ],
            worst: all.iter().map(|(_, row)| row.effect).sum(),
            rss: all.iter().map(|(_, row)| row.effect * row.effect).sum::<f64>().sqrt(),
            sigma: all.iter().map(|(_, row)| row.part * row.part).sum::<f64>().sqrt(),
        }
    }

    /// A total by formulas, about the mean if it is one of moments.
    fn total(&self, kind: TotalKind, of_moments: bool) -> Total {
        let middle = if of_moments { self.mean.clone() } else { self.middle.clone() };
        Total { name: kind.name().to_owned(), middle, half: self.half(kind) }
    }

    /// The half width of a total.
    fn half(&self, kind: TotalKind) -> (String, f64) {
        let Self { factors: [inflation, mean_shift], cells: [of_worst, of_rss], sums, worst, rss, sigma, .. } = self;
        let [sum, root, by_sigma] = sums;
        match kind {
            TotalKind::WorstCase | TotalKind::LinearWorstCase => (sum.clone(), *worst),
            TotalKind::Rss => (root.clone(), *rss),
            TotalKind::InflatedRss => (format!("{inflation}*{of_rss}"), INFLATION * rss),
            TotalKind::MeanShiftRss => {
                let formula = format!("{mean_shift}*{of_worst}+(1-{mean_shift})*{of_rss}");
                (formula, MEAN_SHIFT * worst + (1.0 - MEAN_SHIFT) * rss)
            }
            // Of processes and proofs that the sheet does not have: as reported.
            TotalKind::SixSigma | TotalKind::ProvenWorstCase => (String::new(), f64::NAN),
            TotalKind::FirstOrder | TotalKind::SecondOrder => (by_sigma.clone(), SIGMAS * sigma),
        }
    }
}

/// Cpk if there are limits and it is known.
fn cpk(one: &CharacteristicAnalysis) -> Option<f64> {
    one.distribution.capability.as_ref()?.cpk
}

/// Writes a total by formulas.
fn interval(page: &mut Page<'_>, line: u32, total: &Total) -> Result<(), XlsxError> {
    page.text(line, Of::Name, &total.name, false)?;
    page.formula(line, Of::Middle, &format!("={}", total.middle.0), total.middle.1)?;
    page.formula(line, Of::Half, &format!("={}", total.half.0), total.half.1)?;
    ends(page, line, [total.middle.1, total.half.1])
}

/// Writes a total as the report has it.
fn fixed(page: &mut Page<'_>, line: u32, name: &str, [middle, half]: [Option<f64>; 2]) -> Result<(), XlsxError> {
    page.text(line, Of::Name, &format!("{name}, as reported"), false)?;
    page.number(line, Of::Middle, middle)?;
    page.number(line, Of::Half, half)?;
    ends(page, line, [middle.unwrap_or(f64::NAN), half.unwrap_or(f64::NAN)])
}

fn ends(page: &mut Page<'_>, line: u32, [middle, half]: [f64; 2]) -> Result<(), XlsxError> {
    let [at, width] = [page.cell(line, Of::Middle), page.cell(line, Of::Half)];
    page.formula(line, Of::Mean, &format!("={at}-{width}"), middle - half)?;
    page.formula(line, Of::Deviation, &format!("={at}+{width}"), middle + half)
}
