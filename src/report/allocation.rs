//! The report of an allocation, as JSON prints it.

use serde::Serialize;

use super::requirement::{amount, ends, word};
use super::simulation::SimulatedReport;
use super::{About, CharacteristicReport, Head, WarningReport};
use crate::allocation::{Allocated, Allocation, Attainable, Bound, JointYield};
use crate::problem::Problem;
use crate::summary::RunSummary;
use crate::verdict::Verdict;
use crate::warning::Warning;

/// What an allocation found out. What is unknown is null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct AllocationReport {
    /// What every report begins with.
    #[serde(flatten)]
    pub head: Head,
    /// The method by which derivatives were taken.
    pub method: &'static str,
    /// `optimal`, `almost-optimal`, `infeasible` or `out-of-time`.
    pub status: &'static str,
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
    pub recentred: Vec<RecentredReport>,
    /// Every requirement.
    pub requirements: Vec<KeptReport>,
    /// What limits and required sigmas cost.
    pub shadow_prices: Vec<PriceReport>,
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

/// One dimension with a cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct AllocatedReport {
    /// Its name.
    pub dimension: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Half its band before.
    pub before: f64,
    /// Half its band after.
    pub after: f64,
    /// Lower and upper deviation from the nominal before and after, where there is a band.
    pub deviations: BeforeAfter<Option<[f64; 2]>>,
    /// What it cost; null where no process holds that.
    pub cost_before: Option<f64>,
    /// What it costs.
    pub cost_after: Option<f64>,
    /// The process, where several compete.
    pub process: Option<String>,
    /// `min` or `max` where it has met that bound.
    pub at_bound: Option<&'static str>,
    /// Its share of each characteristic's variance.
    pub contributions: Vec<ContributionReport>,
}

/// A share of a variance before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ContributionReport {
    /// The characteristic.
    pub characteristic: String,
    /// Before.
    pub before: Option<f64>,
    /// After.
    pub after: Option<f64>,
}

/// A nominal value that has moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RecentredReport {
    /// The dimension.
    pub dimension: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Before.
    pub before: f64,
    /// After.
    pub after: f64,
}

/// A requirement.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct KeptReport {
    /// The characteristic.
    pub characteristic: String,
    /// `yield`, `cpk`, `sigma`, `rss` or `worst-case`.
    pub requirement: &'static str,
    /// How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1.
    pub required: f64,
    /// What there was.
    pub before: Option<f64>,
    /// What there is.
    pub after: Option<f64>,
    /// Within which that is known, an end null where there is none; null where it is not known at all.
    pub interval: Option<[Option<f64>; 2]>,
    /// Whether it was kept; null where that is not known.
    pub met_before: Option<bool>,
    /// Whether it is; null where that is not known, and where nothing was found.
    pub met: Option<bool>,
    /// Whether it was kept, in a word.
    pub verdict_before: Verdict,
    /// Whether it is, in a word; null where nothing was found.
    pub verdict: Option<Verdict>,
}

/// What gives way, and what that saves, per unit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct PriceReport {
    /// The characteristic.
    pub characteristic: String,
    /// Cost saved per unit by which both limits go outwards, or the only one.
    pub both: Option<f64>,
    /// Cost saved per unit by which its lower limit goes down; null where the upper one holds the cost up too.
    pub lower: Option<f64>,
    /// Cost saved per unit by which its upper limit goes up.
    pub upper: Option<f64>,
    /// Cost saved per unit of a required sigma.
    pub sigma: Option<f64>,
}

/// A requirement that cannot be kept.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct AttainableReport {
    /// The characteristic.
    pub characteristic: String,
    /// Its unit.
    pub unit: Option<String>,
    /// What is required.
    pub requirement: &'static str,
    /// How much of it.
    pub required: f64,
    /// The best that there is.
    pub best: Option<f64>,
    /// Dimensions without cost that break it by themselves, most harmful first.
    pub because: Vec<String>,
    /// Whether it could be kept if it were the only one.
    pub together: bool,
}

/// What shows that nothing is cheaper.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ProofReport {
    /// The largest violation of the conditions of Karush, Kuhn and Tucker.
    pub kkt_residual: Option<f64>,
    /// No choice of processes costs less.
    pub bound: Option<f64>,
    /// By what part of the cost it may be above that.
    pub gap: Option<f64>,
    /// Whether the bound is exact, rather than resting on a sample of choices.
    pub bound_is_exact: Option<bool>,
    /// Nodes of the branch and bound.
    pub nodes: usize,
    /// Whether Lagrange's condition had the answer in closed form.
    pub closed_form: bool,
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
    pub before: CharacteristicReport,
    /// And at those found; null where none were.
    pub after: Option<CharacteristicReport>,
}

/// One point of the front.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct FrontReport {
    /// What was required of each characteristic.
    pub required: Vec<FrontRequirement>,
    /// What that costs; null where it cannot be kept.
    pub cost: Option<f64>,
    /// Half bands of the dimensions with a cost, in the order of `tolerances`.
    pub tolerances: Option<Vec<f64>>,
}

/// What a point of the front requires of one characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct FrontRequirement {
    /// The characteristic.
    pub characteristic: String,
    /// `yield` or `cpk`.
    pub requirement: &'static str,
    /// How much of it.
    pub required: f64,
}

/// Monte Carlo at the tolerances found.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ConfirmationReport {
    /// Points.
    pub samples: u64,
    /// Every characteristic, as `simulate` reports it.
    pub characteristics: Vec<SimulatedReport>,
}

impl AllocationReport {
    /// The report of an allocation; `table` is the study written anew, where it can be.
    pub fn of(problem: &Problem, allocation: &Allocation, table: Option<&WrittenAnew>, about: About) -> Self {
        let name = |c: usize| problem.characteristics()[c].name().to_owned();
        let dimension = |d: usize| problem.dimensions()[d].name().to_owned();
        let unit = |d: usize| problem.dimensions()[d].unit().map(str::to_owned);
        let before: Vec<_> = allocation.before.characteristics.iter().map(CharacteristicReport::of).collect();
        let after = allocation
            .after
            .as_ref()
            .map(|after| after.characteristics.iter().map(CharacteristicReport::of).collect::<Vec<_>>());
        let found = allocation.after.as_ref().unwrap_or(&allocation.before);
        let changed = allocation.cost_after.is_some();
        let mut warnings: Vec<WarningReport> =
            about.warnings.iter().chain(&found.warnings).map(WarningReport::of).collect();
        let fits = table.iter().flat_map(|table| &table.replaced_fits);
        let dimensions: Vec<String> = fits.cloned().collect();
        if !dimensions.is_empty() {
            warnings.push(WarningReport::of(&Warning::FitReplaced { dimensions }));
        }
        warnings.extend(allocation.warnings.iter().map(WarningReport::of));
        Self {
            head: Head::of("allocate", &about),
            method: found.method.name(),
            status: allocation.status.name(),
            confirmed: allocation.confirmed,
            run: allocation.run,
            rounds: allocation.rounds,
            cost_before: allocation.cost_before.filter(|_| !allocation.tolerances.is_empty()),
            cost_after: allocation.cost_after,
            tolerances: allocation.tolerances.iter().map(|one| allocated(problem, allocation, one, changed)).collect(),
            recentred: (allocation.moved.iter())
                .map(|one| RecentredReport {
                    dimension: dimension(one.dimension),
                    unit: unit(one.dimension),
                    before: one.before,
                    after: one.after,
                })
                .collect(),
            requirements: (allocation.requirements.iter())
                .map(|one| KeptReport {
                    characteristic: name(one.characteristic),
                    requirement: word(one.requirement),
                    required: amount(one.requirement),
                    before: one.before.value.filter(|value| value.is_finite()),
                    after: one.after.and_then(|after| after.value).filter(|value| value.is_finite()),
                    interval: one.after.and_then(|after| after.interval).map(ends),
                    met_before: one.before.verdict.met(),
                    met: one.after.and_then(|after| after.verdict.met()),
                    verdict_before: one.before.verdict,
                    verdict: one.after.map(|after| after.verdict),
                })
                .collect(),
            shadow_prices: (allocation.prices.iter())
                .map(|one| PriceReport {
                    characteristic: name(one.characteristic),
                    both: one.both,
                    lower: one.lower,
                    upper: one.upper,
                    sigma: one.sigma,
                })
                .collect(),
            attainable: allocation.attainable.as_ref().map(|one| attainable(problem, one)),
            proof: ProofReport {
                kkt_residual: allocation.proof.residual,
                bound: allocation.proof.bound,
                gap: (allocation.proof.bound.zip(allocation.cost_after))
                    .map(|(bound, cost)| ((cost - bound) / cost.abs().max(f64::MIN_POSITIVE)).max(0.0)),
                bound_is_exact: allocation.proof.bound.map(|_| allocation.proof.rigorous),
                nodes: allocation.proof.nodes,
                closed_form: allocation.proof.closed_form,
            },
            loosest_scaling: BeforeAfter { before: allocation.loosest_before, after: allocation.loosest_after },
            joint_yield: BeforeAfter { before: allocation.joint[0], after: allocation.joint[1] },
            characteristics: (before.into_iter().enumerate())
                .map(|(c, before)| AllocatedCharacteristic {
                    name: name(c),
                    unit: before.unit.clone(),
                    before,
                    after: after.as_ref().map(|after| after[c].clone()),
                })
                .collect(),
            front: front(problem, allocation),
            confirmation: allocation.confirmation.as_ref().map(|simulation| ConfirmationReport {
                samples: simulation.samples,
                characteristics: simulation.characteristics.iter().map(SimulatedReport::of).collect(),
            }),
            dimensions_table: table.map(|table| table.entries.clone()).filter(|table| !table.is_empty()),
            warnings,
        }
    }
}

fn allocated(problem: &Problem, allocation: &Allocation, one: &Allocated, changed: bool) -> AllocatedReport {
    let d = one.dimension;
    let share = |analysis: &crate::analysis::Analysis, c: usize| analysis.characteristics[c].share(d);
    AllocatedReport {
        dimension: problem.dimensions()[d].name().to_owned(),
        unit: problem.dimensions()[d].unit().map(str::to_owned),
        before: one.before,
        after: one.after,
        deviations: BeforeAfter {
            before: problem.dimensions()[d].tolerance(),
            after: allocation.problem.dimensions()[d].tolerance(),
        },
        cost_before: one.cost_before,
        cost_after: one.cost_after,
        process: one.process.clone(),
        at_bound: one.bound.filter(|_| changed).map(|bound| match bound {
            Bound::Least => "min",
            Bound::Greatest => "max",
        }),
        contributions: (problem.characteristics().iter().enumerate())
            .map(|(c, characteristic)| ContributionReport {
                characteristic: characteristic.name().to_owned(),
                before: share(&allocation.before, c),
                after: allocation.after.as_ref().and_then(|after| share(after, c)),
            })
            .collect(),
    }
}

fn attainable(problem: &Problem, one: &Attainable) -> AttainableReport {
    let characteristic = &problem.characteristics()[one.characteristic];
    AttainableReport {
        characteristic: characteristic.name().to_owned(),
        unit: characteristic.unit().map(str::to_owned),
        requirement: word(one.requirement),
        required: amount(one.requirement),
        best: one.best,
        because: one.because.iter().map(|&d| problem.dimensions()[d].name().to_owned()).collect(),
        together: one.together,
    }
}

fn front(problem: &Problem, allocation: &Allocation) -> Vec<FrontReport> {
    let one = |point: &crate::allocation::FrontPoint| FrontReport {
        required: (point.required.iter())
            .map(|&(c, requirement)| FrontRequirement {
                characteristic: problem.characteristics()[c].name().to_owned(),
                requirement: word(requirement),
                required: amount(requirement),
            })
            .collect(),
        cost: point.cost,
        tolerances: point.tolerances.clone(),
    };
    allocation.front.iter().map(one).collect()
}
