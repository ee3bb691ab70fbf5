//! The report of an allocation, as JSON prints it.

use serde::Serialize;

use super::{About, Head, WarningReport};
#[cfg(feature = "cli")]
use crate::allocation::ProofShape;
use crate::allocation::{
    Allocated, Allocation, Attainable, FrontPoint, JointYield, Kept, Moved, Proof, ShadowPrice, Status,
};
#[cfg(feature = "cli")]
use crate::analysis::CharacteristicShape;
use crate::analysis::{Analysis, CharacteristicAnalysis};
use crate::method::Method;
use crate::problem::Problem;
use crate::requirement::Requirement;
use crate::simulation::SimulatedCharacteristic;
#[cfg(feature = "cli")]
use crate::simulation::SimulatedShape;
use crate::summary::RunSummary;
use crate::warning::Warning;

/// What an allocation found out. What is unknown is null, never 0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct AllocationReport {
    /// What every report begins with.
    #[serde(flatten)]
    pub head: Head,
    /// The method by which derivatives were taken.
    #[cfg_attr(feature = "cli", schemars(with = "String"))]
    pub method: Method,
    /// `optimal`, `almost-optimal`, `infeasible` or `out-of-time`.
    pub status: Status,
    /// Whether the model was evaluated at the tolerances found.
    pub confirmed: bool,
    /// What it came to in points and time, and why it ended early.
    #[serde(flatten)]
    pub run: RunSummary,
    /// How often derivatives were taken.
    pub rounds: usize,
    /// All costs before; null where no process holds some tolerance, and without costs.
    pub cost_before: Option<f64>,
    /// All costs after.
    pub cost_after: Option<f64>,
    /// Every dimension with a cost, in the study's order.
    pub tolerances: Vec<AllocatedReport>,
    /// Nominal values that have moved.
    pub recentred: Vec<OfDimension<Moved>>,
    /// Every requirement.
    pub requirements: Vec<OfCharacteristic<Kept>>,
    /// What limits and required sigmas cost.
    pub shadow_prices: Vec<OfCharacteristic<ShadowPrice>>,
    /// The requirement that cannot be kept, and the best that can be had.
    pub attainable: Option<AttainableReport>,
    /// What shows that nothing is cheaper.
    pub proof: ProofReport,
    /// By which one factor all tolerances may be multiplied until some requirement is just kept.
    pub loosest_scaling: BeforeAfter<Option<f64>>,
    /// The share of assemblies that keep all limits at once; null with fewer than two characteristics with limits.
    pub joint_yield: BeforeAfter<Option<JointYield>>,
    /// Every characteristic before and after.
    pub characteristics: Vec<AllocatedCharacteristic>,
    /// Cost against what is required.
    pub front: Vec<FrontReport>,
    /// The model itself at the tolerances found, by Monte Carlo.
    pub confirmation: Option<ConfirmationReport>,
    /// The entries of dimensions that have changed, ready to paste into the study.
    pub dimensions_table: Option<String>,
    /// Where an assumption fails.
    pub warnings: Vec<WarningReport>,
}

/// The study written anew, as far as a report shows it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WrittenAnew {
    /// The entries that have changed.
    pub entries: String,
    /// Dimensions whose fit has become a plain tolerance.
    pub replaced_fits: Vec<String>,
}

/// Something before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct BeforeAfter<T> {
    /// Before.
    pub before: T,
    /// After.
    pub after: T,
}

/// Something of a dimension, with its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct OfDimension<T> {
    /// The dimension.
    pub dimension: String,
    /// Its unit.
    pub unit: Option<String>,
    /// What there is of it.
    #[serde(flatten)]
    pub of: T,
}

/// Something of a characteristic, with its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct OfCharacteristic<T> {
    /// The characteristic.
    pub characteristic: String,
    /// What there is of it.
    #[serde(flatten)]
    pub of: T,
}

/// One dimension with a cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct AllocatedReport {
    /// What was found.
    #[serde(flatten)]
    pub of: OfDimension<Allocated>,
    /// Lower and upper deviation from the nominal before and after, where there is a band.
    pub deviations: BeforeAfter<Option<[f64; 2]>>,
    /// Its share of each characteristic's variance.
    pub contributions: Vec<OfCharacteristic<BeforeAfter<Option<f64>>>>,
}

/// A requirement that cannot be kept.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct AttainableReport {
    /// The characteristic.
    pub characteristic: String,
    /// Its unit.
    pub unit: Option<String>,
    /// What can be had.
    #[serde(flatten)]
    pub of: Attainable,
    /// Dimensions without cost that break it by themselves, most harmful first.
    pub because: Vec<String>,
}

/// What shows that nothing is cheaper.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ProofReport {
    /// The proof.
    #[serde(flatten)]
    #[cfg_attr(feature = "cli", schemars(with = "ProofShape"))]
    pub of: Proof,
    /// By what part of the cost it may be above the bound.
    pub gap: Option<f64>,
}

/// One characteristic before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct AllocatedCharacteristic {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// As `analyze` reports it, at the tolerances before.
    #[cfg_attr(feature = "cli", schemars(with = "CharacteristicShape"))]
    pub before: CharacteristicAnalysis,
    /// And at those found; null where none were.
    #[cfg_attr(feature = "cli", schemars(with = "Option<CharacteristicShape>"))]
    pub after: Option<CharacteristicAnalysis>,
}

/// One point of the front.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct FrontReport {
    /// What was required of each characteristic.
    #[cfg_attr(feature = "cli", schemars(with = "Vec<OfCharacteristic<crate::requirement::Required>>"))]
    pub required: Vec<OfCharacteristic<Requirement>>,
    /// What that costs; null where it cannot be kept.
    pub cost: Option<f64>,
    /// Half bands of the dimensions with a cost, in the order of `tolerances`.
    pub tolerances: Option<Vec<f64>>,
}

/// Monte Carlo at the tolerances found.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ConfirmationReport {
    /// Points.
    pub samples: u64,
    /// Every characteristic, as `simulate` reports it.
    #[cfg_attr(feature = "cli", schemars(with = "Vec<SimulatedShape>"))]
    pub characteristics: Vec<SimulatedCharacteristic>,
}

impl AllocationReport {
    /// The report of an allocation; `table` is the study written anew, where it can be.
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
        let proof = &allocation.proof;
        let gap = |(bound, cost): (f64, f64)| ((cost - bound) / cost.abs().max(f64::MIN_POSITIVE)).max(0.0);
        Self {
            head: Head::of("allocate", &about),
            method: found.method,
            status: allocation.status,
            confirmed: allocation.confirmed,
            run: allocation.run,
            rounds: allocation.rounds,
            cost_before: allocation.cost_before.filter(|_| !allocation.tolerances.is_empty()),
            cost_after: allocation.cost_after,
            tolerances: allocation.tolerances.iter().map(|one| named.allocated(allocation, one)).collect(),
            recentred: allocation.moved.iter().map(|one| named.dimension(one.dimension, one)).collect(),
            requirements: allocation.requirements.iter().map(|one| named.of(one.characteristic, one)).collect(),
            shadow_prices: allocation.prices.iter().map(|one| named.of(one.characteristic, one)).collect(),
            attainable: allocation.attainable.as_ref().map(|one| named.attainable(one)),
            proof: ProofReport { of: proof.clone(), gap: proof.bound.zip(allocation.cost_after).map(gap) },
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
            front: allocation.front.iter().map(|point| named.front(point)).collect(),
            confirmation: allocation.confirmation.as_ref().map(|simulation| ConfirmationReport {
                samples: simulation.samples,
                characteristics: simulation.characteristics.clone(),
            }),
            dimensions_table: table.map(|table| table.entries.clone()).filter(|table| !table.is_empty()),
            warnings,
        }
    }

    /// Without the interactions that hardly matter, before and after: what they make together stands in their place.
    pub fn shortened(mut self) -> Self {
        for one in &mut self.characteristics {
            one.before.shorten();
            one.after.iter_mut().for_each(CharacteristicAnalysis::shorten);
        }
        self
    }
}

/// Names in place of indices.
struct Names<'p>(&'p Problem);

impl Names<'_> {
    fn of<T: Clone>(&self, c: usize, of: &T) -> OfCharacteristic<T> {
        OfCharacteristic { characteristic: self.0.characteristics()[c].name().to_owned(), of: of.clone() }
    }

    fn dimension<T: Clone>(&self, d: usize, of: &T) -> OfDimension<T> {
        let dimension = &self.0.dimensions()[d];
        let unit = dimension.unit().map(str::to_owned);
        OfDimension { dimension: dimension.name().to_owned(), unit, of: of.clone() }
    }

    fn allocated(&self, allocation: &Allocation, one: &Allocated) -> AllocatedReport {
        let d = one.dimension;
        let changed = allocation.cost_after.is_some();
        let share = |analysis: &Analysis, c: usize| analysis.characteristics[c].share(d);
        let shares = |c: usize| BeforeAfter {
            before: share(&allocation.before, c),
            after: allocation.after.as_ref().and_then(|after| share(after, c)),
        };
        let one = Allocated { bound: one.bound.filter(|_| changed), ..one.clone() };
        AllocatedReport {
            of: self.dimension(d, &one),
            deviations: BeforeAfter {
                before: self.0.dimensions()[d].tolerance(),
                after: allocation.problem.dimensions()[d].tolerance(),
            },
            contributions: (0..self.0.characteristics().len()).map(|c| self.of(c, &shares(c))).collect(),
        }
    }

    fn attainable(&self, one: &Attainable) -> AttainableReport {
        let characteristic = &self.0.characteristics()[one.characteristic];
        AttainableReport {
            characteristic: characteristic.name().to_owned(),
            unit: characteristic.unit().map(str::to_owned),
            of: one.clone(),
            because: one.because.iter().map(|&d| self.0.dimensions()[d].name().to_owned()).collect(),
        }
    }

    fn front(&self, point: &FrontPoint) -> FrontReport {
        FrontReport {
            required: point.required.iter().map(|(c, requirement)| self.of(*c, requirement)).collect(),
            cost: point.cost,
            tolerances: point.tolerances.clone(),
        }
    }
}
