//! The report of an allocation, as JSON prints it.

use serde::Serialize;

use crate::{About, Head, WarningReport};
use sensitol::allocation::{
    Allocated, Allocation, Attainable, CostBasis, FrontPoint, Goal, JointKept, JointYield, Kept, Moved, Proof, SetUp,
    ShadowPrice, Status,
};
use sensitol::analysis::{Analysis, CharacteristicAnalysis};
use sensitol::method::Method;
use sensitol::problem::Problem;
use sensitol::simulation::SimulatedCharacteristic;
use sensitol::summary::RunSummary;
use sensitol::warning::Warning;

/// The report of an allocation. Unknown values are null, never 0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AllocationReport {
    /// The common head of every report.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// The method by which derivatives were taken.
    pub(crate) method: Method,
    /// `optimal`, `local-optimum`, `almost-optimal`, `infeasible`, `no-feasible-point-found`, `inconclusive` or `out-of-time`.
    pub(crate) status: Status,
    /// True if the model was evaluated at the tolerances found.
    pub(crate) confirmed: bool,
    /// Points, time, and the reason of an early end.
    #[serde(flatten)]
    pub(crate) run: RunSummary,
    /// Number of times that derivatives were taken.
    pub(crate) rounds: usize,
    /// Points of a cheap model by which moments were corrected, worst cases followed and tolerances tried, beside the evaluations.
    pub(crate) model_points: u64,
    /// All costs before; null where no process holds some tolerance, and without costs.
    pub(crate) cost_before: Option<f64>,
    /// All costs after.
    pub(crate) cost_after: Option<f64>,
    /// The part of them that is quality loss and scrap; null without losses.
    pub(crate) loss: BeforeAfter<Option<f64>>,
    /// The cost of the cheapest tolerances without rounding to steps or standard grades; null without such rounding.
    pub(crate) cost_unrounded: Option<f64>,
    /// Machines of the processes, with the cost of their setup, which is part of the cost.
    pub(crate) setups: Vec<SetUp>,
    /// The objective, and the most that may be spent on it.
    pub(crate) goal: Goal,
    /// Source of the costs: given, or relative to the tolerance unit of ISO 286.
    pub(crate) cost_basis: CostBasis,
    /// Every dimension with a cost, in the study's order.
    pub(crate) tolerances: Vec<AllocatedReport>,
    /// Nominal values that have moved.
    pub(crate) recentred: Vec<OfDimension<Moved>>,
    /// Every requirement.
    pub(crate) requirements: Vec<OfCharacteristic<Kept>>,
    /// Required joint yield of all characteristics with limits; null if none is required.
    pub(crate) joint_requirement: Option<JointKept>,
    /// Shadow prices of limits and required sigmas.
    pub(crate) shadow_prices: Vec<OfCharacteristic<ShadowPrice>>,
    /// The requirement that cannot be kept, and the best that can be had.
    pub(crate) attainable: Option<OfCharacteristic<Attainable>>,
    /// The evidence that nothing is cheaper.
    pub(crate) proof: Proof,
    /// Factor of all tolerances at which some requirement is just kept.
    pub(crate) loosest_scaling: BeforeAfter<Option<f64>>,
    /// The share of assemblies that keep all limits at once; null with fewer than two characteristics with limits.
    pub(crate) joint_yield: BeforeAfter<Option<JointYield>>,
    /// Every characteristic before and after.
    pub(crate) characteristics: Vec<AllocatedCharacteristic>,
    /// Cost against the requirements.
    pub(crate) front: Vec<FrontPoint>,
    /// The model itself at the tolerances found, by Monte Carlo.
    pub(crate) confirmation: Option<ConfirmationReport>,
    /// The entries of dimensions that have changed, ready to paste into the study.
    pub(crate) dimensions_table: Option<String>,
    /// Warnings about assumptions that fail.
    pub warnings: Vec<WarningReport>,
}

/// Changed entries of a study after an allocation, ready for the report.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WrittenAnew {
    /// TOML text of the dimensions that have changed.
    pub entries: String,
    /// Dimensions whose fit has become a plain tolerance.
    pub replaced_fits: Vec<String>,
}

/// Something before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct BeforeAfter<T> {
    /// Before.
    pub(crate) before: T,
    /// After.
    pub(crate) after: T,
}

/// Something of a dimension, with its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct OfDimension<T> {
    /// The dimension.
    pub(crate) dimension: String,
    /// Unit of the dimension.
    pub(crate) unit: Option<String>,
    /// Result of the dimension.
    #[serde(flatten)]
    pub(crate) of: T,
}

/// Something of a characteristic, with its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct OfCharacteristic<T> {
    /// The characteristic.
    pub(crate) characteristic: String,
    /// Result of the characteristic.
    #[serde(flatten)]
    pub(crate) of: T,
}

/// One dimension with a cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct AllocatedReport {
    /// The allocated tolerance of the dimension.
    #[serde(flatten)]
    pub(crate) of: OfDimension<Allocated>,
    /// Lower and upper deviation from the nominal before and after, if there is a band.
    pub(crate) deviations: BeforeAfter<Option<[f64; 2]>>,
    /// Share of each characteristic's variance.
    pub(crate) contributions: Vec<OfCharacteristic<BeforeAfter<Option<f64>>>>,
}

/// One characteristic before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct AllocatedCharacteristic {
    /// Name of the characteristic.
    pub(crate) name: String,
    /// Unit of the characteristic.
    pub(crate) unit: Option<String>,
    /// Results of `analyze` at the tolerances before.
    pub(crate) before: CharacteristicAnalysis,
    /// Results of `analyze` at the tolerances found; null if none were found.
    pub(crate) after: Option<CharacteristicAnalysis>,
}

/// Monte Carlo at the tolerances found.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct ConfirmationReport {
    /// Points.
    pub(crate) samples: u64,
    /// Every characteristic, as `simulate` reports it.
    pub(crate) characteristics: Vec<SimulatedCharacteristic>,
}

impl AllocationReport {
    /// Builds the report of an allocation. `table` holds the rewritten study entries; None if the study cannot be rewritten.
    pub fn of(problem: &Problem, allocation: &Allocation, table: Option<&WrittenAnew>, about: About) -> Self {
        let found = allocation.after.as_ref().unwrap_or(&allocation.before);
        let mut warnings: Vec<WarningReport> =
            about.warnings.iter().chain(&found.warnings).map(WarningReport::of).collect();
        let fits = table.iter().flat_map(|table| &table.replaced_fits);
        let dimensions: Vec<String> = fits.cloned().collect();
        if !dimensions.is_empty() {
            warnings.push(WarningReport::of(&Warning::FitReplaced { dimensions }));
        }
        warnings.extend(allocation.warnings.iter().map(WarningReport::of));
        let named = Names(problem);
        Self {
            head: Head::of("allocate", &about),
            method: found.method,
            status: allocation.status,
            confirmed: allocation.confirmed,
            run: allocation.run,
            rounds: allocation.rounds,
            model_points: allocation.model_points,
            cost_before: allocation.cost_before.filter(|_| !allocation.tolerances.is_empty()),
            cost_after: allocation.cost_after,
            loss: BeforeAfter { before: allocation.loss[0], after: allocation.loss[1] },
            cost_unrounded: allocation.cost_unrounded,
            setups: allocation.setups.clone(),
            goal: allocation.goal,
            cost_basis: allocation.cost_basis,
            tolerances: allocation.tolerances.iter().map(|one| named.allocated(allocation, one)).collect(),
            recentred: allocation.moved.iter().map(|one| named.dimension(one.dimension, one)).collect(),
            requirements: allocation.requirements.iter().map(|one| named.of(one.characteristic, one)).collect(),
            joint_requirement: allocation.joint_requirement.clone(),
            shadow_prices: allocation.prices.iter().map(|one| named.of(one.characteristic, one)).collect(),
            attainable: allocation.attainable.as_ref().map(|one| named.attainable(one)),
            proof: allocation.proof.clone(),
            loosest_scaling: BeforeAfter { before: allocation.loosest_before, after: allocation.loosest_after },
            joint_yield: BeforeAfter { before: allocation.joint[0], after: allocation.joint[1] },
            characteristics: (allocation.before.characteristics.iter().enumerate())
                .map(|(c, before)| AllocatedCharacteristic {
                    name: before.characteristic.name().to_owned(),
                    unit: before.characteristic.unit().map(str::to_owned),
                    before: before.clone(),
                    after: allocation.after.as_ref().map(|after| after.characteristics[c].clone()),
                })
                .collect(),
            front: allocation.front.clone(),
            confirmation: allocation.confirmation.as_ref().map(|simulation| ConfirmationReport {
                samples: simulation.samples,
                characteristics: simulation.characteristics.clone(),
            }),
            dimensions_table: table.map(|table| table.entries.clone()).filter(|table| !table.is_empty()),
            warnings,
        }
    }

    /// Drops the interactions that hardly matter, before and after. Their sum stays in the report.
    pub fn shortened(mut self) -> Self {
        for one in &mut self.characteristics {
            one.before.shorten();
            one.after.iter_mut().for_each(CharacteristicAnalysis::shorten);
        }
        self
    }
}

/// Adds the names of dimensions and characteristics to results that hold indices.
struct Names<'p>(&'p Problem);

impl Names<'_> {
    fn of<T: Clone>(&self, c: usize, of: &T) -> OfCharacteristic<T> {
        OfCharacteristic { characteristic: self.0.characteristics()[c].name().to_owned(), of: of.clone() }
    }

    /// Adds the names of the concerned characteristics: for a joint yield all that have limits.
    fn attainable(&self, one: &Attainable) -> OfCharacteristic<Attainable> {
        let all = self.0.characteristics().iter().filter(|one| one.limits().exist()).map(|one| one.name());
        match one.joint {
            true => OfCharacteristic { characteristic: all.collect::<Vec<_>>().join(", "), of: one.clone() },
            false => self.of(one.characteristic, one),
        }
    }

    fn dimension<T: Clone>(&self, d: usize, of: &T) -> OfDimension<T> {
        let dimension = &self.0.dimensions()[d];
        let unit = dimension.unit().map(str::to_owned);
        OfDimension { dimension: dimension.name().to_owned(), unit, of: of.clone() }
    }

    fn allocated(&self, allocation: &Allocation, one: &Allocated) -> AllocatedReport {
        let (d, members) = match &one.zone {
            None => (one.dimension, vec![one.dimension]),
            Some(zone) => (one.dimension, zone.members.clone()),
        };
        let changed = allocation.cost_after.is_some();
        let share = |analysis: &Analysis, c: usize| -> Option<f64> {
            members.iter().map(|&d| analysis.characteristics[c].share(d)).sum()
        };
        let shares = |c: usize| BeforeAfter {
            before: share(&allocation.before, c),
            after: allocation.after.as_ref().and_then(|after| share(after, c)),
        };
        let one = Allocated { bound: one.bound.filter(|_| changed), ..one.clone() };
        let (of, deviations) = match &one.zone {
            None => (
                self.dimension(d, &one),
                BeforeAfter {
                    before: self.0.dimensions()[d].tolerance(),
                    after: allocation.problem.dimensions()[d].tolerance(),
                },
            ),
            Some(zone) => (
                OfDimension { dimension: zone.name.clone(), unit: zone.unit.clone(), of: one.clone() },
                BeforeAfter { before: Some([-one.before, one.before]), after: Some([-one.after, one.after]) },
            ),
        };
        AllocatedReport {
            of,
            deviations,
            contributions: (0..self.0.characteristics().len()).map(|c| self.of(c, &shares(c))).collect(),
        }
    }
}
