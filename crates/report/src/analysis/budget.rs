//! The budget of measurement uncertainty of a characteristic.
//!
//! ```text
//! combined standard uncertainty    u_c = sqrt(sum of (c_i u_i)^2), with correlation sqrt(t'R t) of t_i = c_i u_i
//! effective degrees of freedom     u_c^4/sum of ((c_i u_i)^4/nu_i)         (Welch-Satterthwaite), for independent inputs
//! expanded uncertainty             U = t_p(nu) u_c                         nu rounded down
//! ```
//!
//! First order in the slopes at the means. The standard uncertainty of an input is its sigma; for a Student distribution it is the scale.
//! Source: JCGM 100:2008, 5.1.2, 5.2.2, 8 and G.4.1.

use crate::document::number::{UNKNOWN, beside, percent, plain, significant};
use crate::document::{Blocks, Cell, Columns, DataTable, Document, Section, Value};
use crate::figures::{Figures, Named};
use crate::{DimensionReport, Report};
use sensitol::analysis::{CharacteristicAnalysis, Interaction};
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::sampling::student_quantile;

/// Probability that an expanded uncertainty holds unless the study sets `coverage`.
const PROBABILITY: f64 = 0.95;
/// Name of the distribution whose standard uncertainty is its scale.
const STUDENT: &str = "student";
/// Relative difference below which sigma and the combined uncertainty count as equal.
const SAME: f64 = 1e-3;

/// The budget of one characteristic. Unknown values are None.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Budget {
    /// Name of the characteristic.
    pub characteristic: String,
    /// Unit of the characteristic.
    pub unit: Option<String>,
    /// Mean of the characteristic.
    pub estimate: Option<f64>,
    /// Dimensions that vary and affect the characteristic, in the study's order.
    pub rows: Vec<BudgetRow>,
    /// The combined standard uncertainty, of first order.
    pub combined: Option<f64>,
    /// Effective degrees of freedom, infinite if those of all inputs are infinite. None if inputs are correlated.
    pub degrees: Option<f64>,
    /// Probability that the expanded uncertainty holds.
    pub probability: f64,
    /// The coverage factor: the quantile of Student's distribution with the degrees of freedom rounded down.
    pub factor: Option<f64>,
    /// The expanded uncertainty.
    pub expanded: Option<f64>,
    /// Sigma of the analysis, which includes curvature and interactions.
    sigma: Option<f64>,
    correlated: bool,
}

/// One input of a budget.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BudgetRow {
    /// The dimension.
    pub dimension: DimensionReport,
    /// Standard uncertainty of the dimension.
    pub uncertainty: f64,
    /// Degrees of freedom of the standard uncertainty, infinite unless the study sets them.
    pub degrees: f64,
    /// The slope at the means.
    pub coefficient: Option<f64>,
    /// Slope times uncertainty, without sign.
    pub contribution: Option<f64>,
    /// Part of the sum of squares of all contributions.
    pub share: Option<f64>,
}

impl Report {
    /// Budgets of all characteristics, for the `coverage` of the study, 0.95 unless given.
    pub fn budgets(&self) -> Vec<Budget> {
        self.analysis.characteristics.iter().map(|one| Budget::of(self, one)).collect()
    }
}

impl Budget {
    fn of(report: &Report, one: &CharacteristicAnalysis) -> Self {
        let varying = one.sensitivities.iter().zip(&report.dimensions).filter(|(row, dimension)| {
            let idle = row.first == Some(0.0) && row.second.unwrap_or(0.0) == 0.0 && !interacts(one, &row.dimension);
            dimension.sigma > 0.0 && !idle
        });
        let mut rows: Vec<BudgetRow> =
            varying.map(|(sensitivity, dimension)| BudgetRow::of(sensitivity.first, dimension)).collect();
        let terms: Option<Vec<f64>> = rows.iter().map(|row| Some(row.coefficient? * row.uncertainty)).collect();
        let alone = terms.as_ref().map(|terms| terms.iter().fold(0.0f64, |sum, term| libm::hypot(sum, *term)));
        for row in &mut rows {
            row.share =
                row.contribution.zip(alone).filter(|(_, all)| *all > 0.0).map(|(part, all)| (part / all).powi(2));
        }
        let place = |name: &String| rows.iter().position(|row| row.dimension.name == *name);
        let pairs: Vec<(usize, usize, f64)> = (report.correlation.iter())
            .filter_map(|pair| Some((place(&pair.between[0])?, place(&pair.between[1])?, pair.value)))
            .collect();
        let together = |terms: &[f64]| pairs.iter().map(|&(a, b, r)| 2.0 * r * terms[a] * terms[b]).sum::<f64>();
        let combined = match pairs.is_empty() {
            true => alone,
            false => alone.zip(terms.as_ref()).map(|(alone, terms)| (alone * alone + together(terms)).max(0.0).sqrt()),
        };
        let degrees = combined.zip(terms.as_ref()).filter(|_| pairs.is_empty()).map(|(combined, terms)| {
            // Relative to the combined uncertainty, so that no fourth power overflows.
            let part = |(term, row): (&f64, &BudgetRow)| (term / combined).powi(4) / row.degrees;
            if combined > 0.0 { terms.iter().zip(&rows).map(part).sum::<f64>().recip() } else { f64::INFINITY }
        });
        let probability = one.distribution.coverage.map_or(PROBABILITY, |coverage| coverage.probability);
        let factor = degrees.and_then(|degrees| factor(probability, degrees));
        Self {
            characteristic: one.name().to_owned(),
            unit: one.unit().map(str::to_owned),
            estimate: one.mean(),
            combined,
            degrees,
            probability,
            factor,
            expanded: factor.zip(combined).map(|(factor, combined)| factor * combined),
            sigma: one.sigma(),
            correlated: !pairs.is_empty(),
            rows,
        }
    }
}

/// True if the dimension has a product with another one. Its slope at the means may be 0 all the same.
fn interacts(one: &CharacteristicAnalysis, dimension: &str) -> bool {
    let named = |pair: &Interaction<'_>| pair.dimensions.contains(&dimension);
    let with = |pair: Interaction<'_>| named(&pair) && pair.mixed.is_some_and(|mixed| mixed != 0.0);
    one.contributions.interactions.iter().any(with)
}

impl BudgetRow {
    fn of(coefficient: Option<f64>, dimension: &DimensionReport) -> Self {
        let degrees = dimension.degrees.unwrap_or(f64::INFINITY);
        let uncertainty = match dimension.distribution {
            Some(STUDENT) if degrees > 2.0 && degrees.is_finite() => {
                dimension.sigma * ((degrees - 2.0) / degrees).sqrt()
            }
            _ => dimension.sigma,
        };
        let contribution = coefficient.map(|slope| (slope * uncertainty).abs());
        Self { dimension: dimension.clone(), uncertainty, degrees, coefficient, contribution, share: None }
    }
}

/// Half the width of the interval that holds `probability` of Student's distribution, in scales. None below one degree of freedom.
fn factor(probability: f64, degrees: f64) -> Option<f64> {
    let outside = 0.5 * (1.0 - probability);
    if degrees.is_infinite() {
        return Some(standard_normal::upper_quantile(outside));
    }
    let whole = whole(degrees);
    (whole >= 1.0).then(|| student_quantile(1.0 - outside, whole))
}

/// Rounds down, but keeps a whole number that only rounding made smaller.
fn whole(degrees: f64) -> f64 {
    /// Degrees of freedom that rounding may take from a whole number.
    const ROUNDING: f64 = 1e-9;
    (degrees * (1.0 + ROUNDING)).floor()
}

/// Budgets as a document: a section each, with the inputs and the totals. Both tables together are the table `budget`.
pub fn budget_document(budgets: &[Budget]) -> Document {
    Document { sections: budgets.iter().map(Budget::section).collect(), ..Document::default() }
}

enum Total {
    Combined,
    Expanded,
}

impl Budget {
    fn section(&self) -> Section {
        let mut section = Section::of(&format!("uncertainty of {}", self.characteristic), self.unit.as_deref());
        let [rows, totals] = self.tables();
        section.table(rows);
        section.gap();
        section.table(totals);
        if let (Some(estimate), Some(expanded)) = (self.estimate, self.expanded) {
            let unit = self.unit.as_deref().map(|unit| format!(" {unit}")).unwrap_or_default();
            let half = significant(expanded, 3);
            // The estimate is printed to the last digit of its uncertainty.
            let middle = match half.split_once('.') {
                _ if half.contains('e') => plain(estimate),
                decimals => format!("{estimate:.*}", decimals.map_or(0, |(_, digits)| digits.len())),
            };
            section.note(format!("{} = {middle} \u{b1} {half}{unit}, for {} %", self.characteristic, self.share()));
        }
        let promised = self.rows.iter().filter(|row| row.dimension.promised);
        let promised: Vec<&str> = promised.map(|row| row.dimension.name.as_str()).collect();
        if !promised.is_empty() {
            let names = promised.join(", ");
            section
                .wrapped(2, format!("{names}: only the band is known, and u is that of a uniform distribution in it"));
        }
        if self.correlated {
            section.wrapped(
                2,
                "inputs are correlated: the combined uncertainty takes that in, and the formula of Welch and Satterthwaite does not apply",
            );
        }
        if let (Some(sigma), Some(combined)) = (self.sigma, self.combined)
            && (sigma - combined).abs() > SAME * combined
        {
            let student = self.rows.iter().any(|row| row.dimension.distribution == Some(STUDENT));
            let more =
                if student { ", interactions and the sigma of Student distributions" } else { " and interactions" };
            let sigma = significant(sigma, 4);
            section.wrapped(2, format!("of first order: the analysis gives sigma {sigma}, with curvature{more}"));
        }
        section
    }

    /// The share that the expanded uncertainty holds, in percent.
    fn share(&self) -> String {
        plain(100.0 * self.probability)
    }

    /// Tables of the inputs and of the totals. In CSV they are one table.
    pub(crate) fn tables(&self) -> [DataTable; 2] {
        let scale = self.combined.unwrap_or(0.0);
        let scaled = |value: Option<f64>| Cell::number(value, |value| beside(value, scale));
        let freedom = |degrees: Option<f64>, shown: fn(f64) -> String| match degrees {
            Some(degrees) if degrees.is_infinite() => Cell::both(Value::Number(None), "\u{221e}"),
            Some(degrees) => Cell::number(degrees, shown),
            None => Cell::both(Value::Number(None), UNKNOWN),
        };
        let rows = Columns::default()
            .data("characteristic", |_| Cell::text(&self.characteristic))
            .data("row", |_| Cell::text("input"))
            .named("name", "input", |row: &&BudgetRow| Cell::name(&row.dimension.name))
            .column("estimate", "estimate", |row| Cell::number(row.dimension.mean, plain))
            .column("uncertainty", "u", |row| Cell::number(row.uncertainty, |u| significant(u, 4)))
            .named("unit", "unit", |row| Cell::optional(row.dimension.unit.as_deref()))
            .named("distribution", "distribution", |row| Cell::optional(row.dimension.distribution))
            .column("degrees", "degrees", move |row| freedom(Some(row.degrees), plain))
            .column("coefficient", "c", |row| Cell::number(row.coefficient, |c| significant(c, 4)))
            .column("contribution", "|c| u", move |row| scaled(row.contribution))
            .column("share", "share %", |row| Cell::number(row.share, percent))
            .data("factor", |_| Cell::empty())
            .table("budget", &self.rows);
        let share = self.share();
        let totals = Columns::default()
            .data("characteristic", |_| Cell::text(&self.characteristic))
            .data("row", |_| Cell::text("total"))
            .named("name", "total", move |total| match total {
                Total::Combined => Cell::text("combined standard uncertainty"),
                Total::Expanded => Cell::text(format!("expanded uncertainty, {share} %")),
            })
            .data("estimate", |_| Cell::data(self.estimate))
            .column("uncertainty", "uncertainty", move |total| match total {
                Total::Combined => scaled(self.combined),
                Total::Expanded => scaled(self.expanded),
            })
            .data("unit", |_| Cell::optional(self.unit.as_deref()))
            .data("distribution", |_| Cell::empty())
            .column("degrees", "degrees", move |total| match total {
                Total::Combined => freedom(self.degrees, |degrees| whole(degrees).to_string()),
                Total::Expanded => Cell::empty(),
            })
            .data("coefficient", |_| Cell::empty())
            .data("contribution", |_| Cell::empty())
            .data("share", |_| Cell::empty())
            .column("factor", "factor", |total| match total {
                Total::Combined => Cell::empty(),
                Total::Expanded => Cell::number(self.factor, |factor| significant(factor, 3)),
            })
            .table("budget", [Total::Combined, Total::Expanded]);
        [rows, totals]
    }
}
