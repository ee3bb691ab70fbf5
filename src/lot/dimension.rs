//! Measured dimensions of a lot.

use serde::Serialize;

use crate::lot::error::sample;
use crate::lot::{GroupKind, LotColumn, LotError, LotTable};
use crate::problem::Problem;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::Distribution;
use sensitol_numeric::lot::{
    Departure, LotFigure, LotSample, LotTest, Posterior, compare_groups, correlation_estimate, likeliest_departure,
    linear_trend, performance,
};

/// A measured dimension against its assumption.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DimensionInLot {
    /// Name of the dimension.
    pub name: String,
    /// Unit of the dimension.
    pub unit: Option<String>,
    /// Number of measured parts.
    pub parts: usize,
    /// Parts outside the tolerance band; null without a band.
    pub outside: Option<usize>,
    /// Assumed mean.
    pub assumed_mean: f64,
    /// Assumed standard deviation.
    pub assumed_sigma: f64,
    /// Kind of the assumed distribution.
    pub assumed_distribution: &'static str,
    /// Measured mean.
    pub mean: LotFigure,
    /// Measured standard deviation.
    pub sigma: LotFigure,
    /// Test of the mean.
    pub mean_test: LotTest,
    /// Test of the standard deviation.
    pub sigma_test: LotTest,
    /// Test of the shape; null of fewer than eight parts, or if the assumed shape is unknown.
    pub shape_test: Option<LotTest>,
    /// Change from the first part to the last along the trend; null if it cannot be computed.
    pub trend: Option<LotFigure>,
    /// Test against no trend.
    pub trend_test: Option<LotTest>,
    /// Variance between and within groups, for every column that groups the parts.
    pub groups: Vec<GroupsInLot>,
    /// Likeliest form, if the assumed shape is refuted or values lie far out; else null.
    pub departure: Option<Departure>,
    /// Index Pp; null without both ends of a band.
    pub pp: Option<LotFigure>,
    /// Index Ppk; null without a band.
    pub ppk: Option<LotFigure>,
    /// Mean and standard deviation with the study as prior.
    #[serde(serialize_with = "written_posterior")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<WrittenPosterior>"))]
    pub posterior: Option<Posterior>,
    /// Measured values in the order of measurement.
    #[serde(skip)]
    pub column: Option<LotSample>,
}

/// Posterior of a dimension in JSON.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct WrittenPosterior {
    /// Mean.
    mean: LotFigure,
    /// Standard deviation.
    sigma: LotFigure,
    /// Standard deviation of the next part.
    predictive_sigma: Option<f64>,
    /// Weight of the lot in the mean, from 0 to 1.
    weight: f64,
}

fn written_posterior<S: serde::Serializer>(found: &Option<Posterior>, to: S) -> Result<S::Ok, S::Error> {
    let written = found.as_ref().map(|found| WrittenPosterior {
        mean: found.mean,
        sigma: found.sigma,
        predictive_sigma: found.predictive_sigma,
        weight: found.weight,
    });
    written.serialize(to)
}

/// Variance of a dimension between and within groups.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GroupsInLot {
    /// Name of the column.
    pub column: String,
    /// Role of the column.
    pub kind: GroupKind,
    /// Standard deviation between groups.
    pub between: LotFigure,
    /// Standard deviation within groups.
    pub within: LotFigure,
    /// Test against equal means.
    pub test: LotTest,
    /// The groups, by name.
    pub groups: Vec<GroupInLot>,
}

/// Parts of one group.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GroupInLot {
    /// Name of the group.
    pub name: String,
    /// Number of parts.
    pub parts: usize,
    /// Mean of the parts.
    pub mean: f64,
}

/// Measured correlation of two dimensions.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CorrelationInLot {
    /// The dimensions.
    pub between: [String; 2],
    /// Assumed correlation.
    pub assumed: f64,
    /// Measured correlation.
    pub value: LotFigure,
    /// Test against the assumed correlation.
    pub test: LotTest,
    /// Rows in which both are measured.
    pub rows: usize,
}

impl CorrelationInLot {
    /// True if the assumed correlation is refuted.
    pub fn departs(&self, level: f64) -> bool {
        self.test.refutes(level)
    }
}

impl DimensionInLot {
    fn of(
        dimension: &Dimension,
        law: &dyn Distribution,
        table: &LotTable,
        column: &LotColumn,
    ) -> Result<Self, LotError> {
        let measured: Vec<(usize, f64)> =
            column.values.iter().enumerate().filter_map(|(row, value)| Some((row, (*value)?))).collect();
        let values: Vec<f64> = measured.iter().map(|(_, value)| *value).collect();
        let name = dimension.name().to_owned();
        let found = sample(table, column)?;
        let tests = found.tests(law);
        let excess = law.standard_moments().kurtosis() - 3.0;
        let limits =
            dimension.tolerance().map(|[lower, upper]| [dimension.nominal() + lower, dimension.nominal() + upper]);
        let indices = limits.and_then(|limits| performance(&found, limits.map(Some)));
        let outside =
            |[lower, upper]: [f64; 2]| values.iter().filter(|value| **value < lower || **value > upper).count();
        let trend = trend(table, &measured);
        let groups = table.groupings.iter().filter_map(|grouping| {
            let label = |(row, value): &(usize, f64)| Some((grouping.labels.get(*row)?.as_deref()?, *value));
            let parts: Vec<(&str, f64)> = measured.iter().filter_map(label).collect();
            let of = compare_groups(&parts)?;
            Some(GroupsInLot {
                column: grouping.name.clone(),
                kind: grouping.kind,
                between: of.between,
                within: of.within,
                test: of.test,
                groups: of.groups.into_iter().map(|(name, parts, mean)| GroupInLot { name, parts, mean }).collect(),
            })
        });
        Ok(Self {
            unit: dimension.unit().map(str::to_owned),
            parts: values.len(),
            outside: limits.map(outside),
            assumed_mean: law.mean(),
            assumed_sigma: law.sigma(),
            assumed_distribution: law.name(),
            mean: found.mean_figure(),
            sigma: found.sigma_figure(excess),
            mean_test: tests.mean,
            sigma_test: tests.sigma,
            shape_test: tests.shape,
            trend: trend.as_ref().map(|trend| trend.change),
            trend_test: trend.as_ref().map(|trend| trend.test),
            groups: groups.collect(),
            departure: None,
            pp: indices.and_then(|indices| indices.pp),
            ppk: indices.map(|indices| indices.ppk),
            posterior: None,
            column: Some(found),
            name,
        })
    }

    /// Names the likeliest form if the shape is refuted.
    pub(super) fn name_departures(&mut self, level: f64) {
        let refuted = self.shape_test.is_some_and(|test| test.refutes(level));
        self.departure = self.column.as_ref().filter(|_| refuted).and_then(likeliest_departure);
    }

    /// True if a test of mean, sigma, shape, trend or groups refutes the assumption.
    pub fn departs(&self, level: f64) -> bool {
        let all = [Some(self.mean_test), Some(self.sigma_test), self.shape_test, self.trend_test];
        all.into_iter().flatten().chain(self.groups.iter().map(|of| of.test)).any(|test| test.refutes(level))
    }
}

/// Trend over the times of the rows, or over their order.
fn trend(table: &LotTable, measured: &[(usize, f64)]) -> Option<sensitol_numeric::lot::LotTrend> {
    let timed = |(row, value): &(usize, f64)| match &table.times {
        Some(times) => Some(((*times.get(*row)?)?, *value)),
        None => Some((*row as f64, *value)),
    };
    let (at, values): (Vec<f64>, Vec<f64>) = measured.iter().filter_map(timed).unzip();
    linear_trend(&at, &values)
}

/// Measured dimensions, in the order of the problem.
pub(super) fn measured(problem: &Problem, tables: &[LotTable]) -> Result<Vec<DimensionInLot>, LotError> {
    let mut found = Vec::new();
    for dimension in problem.dimensions() {
        let Some(law) = dimension.distribution() else { continue };
        for table in tables {
            for column in table.columns.iter().filter(|column| column.name == dimension.name()) {
                found.push(DimensionInLot::of(dimension, law, table, column)?);
            }
        }
    }
    Ok(found)
}

/// Correlations of all pairs of dimensions that are measured in the same rows.
pub(super) fn correlated(problem: &Problem, tables: &[LotTable]) -> Vec<CorrelationInLot> {
    let place = |name: &str| problem.dimensions().iter().position(|one| one.name() == name);
    let mut found = Vec::new();
    for table in tables {
        let columns: Vec<(usize, &LotColumn)> =
            table.columns.iter().filter_map(|column| Some((place(&column.name)?, column))).collect();
        for (first, (a, of_a)) in columns.iter().enumerate() {
            for (b, of_b) in &columns[first + 1..] {
                let rows: Vec<[f64; 2]> =
                    of_a.values.iter().zip(&of_b.values).filter_map(|(a, b)| Some([(*a)?, (*b)?])).collect();
                let assumed = problem.correlation().map_or(0.0, |correlation| correlation.of(*a, *b));
                let Some(of_rows) = correlation_estimate(&rows, assumed) else { continue };
                found.push(CorrelationInLot {
                    between: [of_a.name.clone(), of_b.name.clone()],
                    assumed,
                    value: of_rows.figure,
                    test: of_rows.test,
                    rows: of_rows.rows,
                });
            }
        }
    }
    found
}
