//! Comparison of a measured lot with a study: parts against the assumed dimensions, assemblies against the predicted characteristics.
//!
//! 1. Every measured dimension has figures with intervals and tests against its assumed distribution. All tests of dimensions and
//!    characteristics are one family: the probability that any of them refutes a right assumption is at most the family-wise level (Holm).
//! 2. The problem is analysed again with the measured parts: mean and sigma of each measured dimension, its assumed shape unless that is
//!    refuted, and the assumed correlation unless that is.
//! 3. Measured assemblies are compared with both predictions. The difference of the predictions is split by dimensions.
//!
//! # The difference by dimensions
//! The difference of the means is the sum of `(a_i + b_i)/2 (m_i - n_i)`, with the slopes `a` at the assumed and `b` at the measured means.
//! It is exact for a quadratic surface of constant curvature; the remainder is the change by curvature and spread. The difference of the
//! variances is that of the variances which each dimension explains alone; the remainder is that of interactions and correlations.

mod characteristic;
mod dimension;
mod error;
mod family;
mod measured_problem;

pub use characteristic::{CharacteristicInLot, DifferenceShare, LotVerdict, MeasuredAssemblies, PredictedFigures};
pub use dimension::{CorrelationInLot, DimensionInLot, GroupInLot, GroupsInLot};
pub use error::LotError;

use serde::Serialize;

use crate::analysis::analyze_with;
use crate::assembly::Run;
use crate::method::Options;
use crate::problem::Problem;
use crate::summary::RunSummary;
use sensitol_numeric::lot::NormalPrior;

/// Role of a column that groups parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum GroupKind {
    /// Production lot.
    Lot,
    /// Machine, tool or cavity.
    Machine,
    /// Person who measured or made the part.
    Operator,
}

/// A column that groups parts.
#[derive(Debug, Clone, PartialEq)]
pub struct LotGrouping {
    /// Name of the column.
    pub name: String,
    /// Role of the column.
    pub kind: GroupKind,
    /// Group of each row; None if it is unknown.
    pub labels: Vec<Option<String>>,
}

/// Measured values of one dimension or characteristic.
#[derive(Debug, Clone, PartialEq)]
pub struct LotColumn {
    /// Name of the dimension or characteristic.
    pub name: String,
    /// Values by row, None if nothing was measured.
    pub values: Vec<Option<f64>>,
}

/// Rows of measured parts or assemblies, in the order of measurement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LotTable {
    /// Name of the table in messages; empty if it has none.
    pub name: String,
    /// Measured values.
    pub columns: Vec<LotColumn>,
    /// Columns that group the rows.
    pub groupings: Vec<LotGrouping>,
    /// Time of each row; None if the order of the rows stands for it.
    pub times: Option<Vec<Option<f64>>>,
}

/// Choices of a comparison with a lot.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LotOptions {
    /// Probability that any test refutes a right assumption.
    pub level: f64,
    /// Number of parts that the assumed mean and sigma of a dimension are worth in its posterior.
    pub assumed_parts: f64,
}

impl Default for LotOptions {
    fn default() -> Self {
        Self { level: 0.05, assumed_parts: 30.0 }
    }
}

impl LotOptions {
    /// Sets the weight of the study in the posterior, in parts.
    #[must_use]
    pub fn with_assumed_parts(mut self, parts: f64) -> Self {
        self.assumed_parts = parts;
        self
    }

    /// Sets the family-wise level of the tests.
    #[must_use]
    pub fn with_level(mut self, level: f64) -> Self {
        self.level = level;
        self
    }
}

/// A study and a lot side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LotComparison {
    /// Probability that any of the tests refutes a right assumption.
    pub family_wise_level: f64,
    /// Number of tests in the family.
    pub tests: usize,
    /// Measured dimensions, in the order of the study.
    pub dimensions: Vec<DimensionInLot>,
    /// Dimensions that vary and were not measured: they stay as assumed.
    pub not_measured: Vec<String>,
    /// Correlations that differ from the assumed ones, or that are assumed.
    pub correlations: Vec<CorrelationInLot>,
    /// Number of pairs of dimensions that were examined.
    pub examined_correlations: usize,
    /// Characteristics of the study.
    pub characteristics: Vec<CharacteristicInLot>,
    /// Weight of the study in the posterior figures, in parts.
    pub assumed_parts: f64,
    /// Points and time of both analyses.
    #[serde(flatten)]
    pub run: RunSummary,
}

/// Compares a lot with a problem. Tables may hold parts, assemblies or both; a dimension stands in one of them.
///
/// Evaluations: those of two analyses.
///
/// # Errors
/// If a column is neither a dimension nor a characteristic, stands in two tables, or has too few values; if a dimension does not vary in
/// the study; if a choice is out of range; or if the method does not fit the problem.
///
/// ```
/// use sensitol::lot::{LotColumn, LotOptions, LotTable, compare_lot};
/// use sensitol::{Closure, Dimension, Method, Problem};
/// use sensitol::assembly::Run;
/// let dimensions = [Dimension::normal("a", 10.0, 0.3)?, Dimension::normal("b", 9.0, 0.3)?];
/// let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?;
/// let values = (0..20).map(|part| Some(10.2 + 0.1 * f64::from(part % 5 - 2))).collect();
/// let table = LotTable { columns: vec![LotColumn { name: "a".into(), values }], ..LotTable::default() };
/// let found = compare_lot(&problem, &[table], &LotOptions::default(), &Method::SecondOrder.into(), &Run::to_the_end())?;
/// let shift = &found.characteristics[0].differences[0];
/// assert!(shift.dimension == "a" && (shift.mean.unwrap() - 0.2).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare_lot(
    problem: &Problem,
    tables: &[LotTable],
    options: &LotOptions,
    method: &Options,
    run: &Run<'_>,
) -> Result<LotComparison, LotError> {
    error::checked(problem, tables, options)?;
    let mut dimensions = dimension::measured(problem, tables)?;
    let mut correlations = dimension::correlated(problem, tables);
    let assumed = analyze_with(problem, method, run)?;
    // The shapes and correlations of the second analysis depend on the tests of the parts, which are a family of their own until the
    // assemblies are compared.
    family::adjust(&mut dimensions, &mut correlations, &mut []);
    let with_parts = measured_problem::with_parts(problem, &dimensions, &correlations, options.level)?;
    let by_parts = analyze_with(&with_parts, method, run)?;
    let lot = characteristic::MeasuredLot {
        problem: &with_parts,
        dimensions: &dimensions,
        correlations: &correlations,
        level: options.level,
    };
    let mut characteristics = characteristic::compared(tables, [&assumed, &by_parts], &lot)?;
    let tests = family::adjust(&mut dimensions, &mut correlations, &mut characteristics);
    for one in &mut characteristics {
        one.judge(options.level);
    }
    for one in &mut dimensions {
        let refuted = one.mean_test.refutes(options.level) || one.sigma_test.refutes(options.level);
        // A refuted assumption has no weight.
        let parts = if refuted { 0.0 } else { options.assumed_parts };
        let prior = NormalPrior { mean: one.assumed_mean, sigma: one.assumed_sigma, parts };
        one.name_departures(options.level);
        one.posterior = one.column.as_ref().map(|column| prior.updated(column));
    }
    let examined = correlations.len();
    correlations.retain(|pair| pair.test.refutes(options.level) || pair.assumed != 0.0);
    let measured = |name: &str| dimensions.iter().any(|one| one.name == name);
    let vary = problem.dimensions().iter().filter(|one| one.distribution().is_some() && !measured(one.name()));
    Ok(LotComparison {
        family_wise_level: options.level,
        tests,
        not_measured: vary.map(|one| one.name().to_owned()).collect(),
        dimensions,
        correlations,
        examined_correlations: examined,
        characteristics,
        assumed_parts: options.assumed_parts,
        run: assumed.run.and(&by_parts.run),
    })
}
