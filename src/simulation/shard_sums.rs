//! Shards of a sample and their sums, as files hold them.

use serde::{Deserialize, Serialize};

use crate::assembly::EvaluationError;
use crate::simulation::SimulationError;
use crate::simulation::joint_result::Together;
use crate::simulation::sample_groups::GroupSums;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::sampling::{Fine, LargestPoints, Summary};

/// Greatest number of shards of a sample.
const SHARDS: u64 = 100_000;

/// Part of a sample that one process evaluates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Shard {
    number: u64,
    count: u64,
}

impl Shard {
    /// Shard `number` of `count`, counted from 1.
    ///
    /// # Errors
    /// If the number lies outside 1 to `count`, or `count` above 100 000.
    pub fn new(number: u64, count: u64) -> Result<Self, ShardError> {
        match (1..=SHARDS).contains(&count) && (1..=count).contains(&number) {
            true => Ok(Self { number, count }),
            false => Err(ShardError::NoSuchShard { number, count, most: SHARDS }),
        }
    }

    /// Number of this shard, from 1.
    pub fn number(self) -> u64 {
        self.number
    }

    /// Number of all shards.
    pub fn count(self) -> u64 {
        self.count
    }

    /// Range of this shard in `total` things that all shards divide evenly.
    pub(super) fn range(self, total: u64) -> [u64; 2] {
        let end = |number: u64| (u128::from(total) * u128::from(number) / u128::from(self.count)) as u64;
        [end(self.number - 1), end(self.number)]
    }
}

/// Sums of one shard, to be written to a file and merged with those of the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShardSums {
    /// Shard that was evaluated.
    pub shard: Shard,
    /// Points of the whole sample.
    pub samples: u64,
    /// Seed of the whole sample.
    pub seed: u64,
    /// Points of this shard.
    pub(super) answered: u64,
    pub(super) characteristics: Vec<CharacteristicSums>,
    pub(super) together: Together,
    pub(super) work: ShardWork,
    /// True if values of this size are computed in other units.
    #[serde(skip)]
    pub(super) rescaled: bool,
}

/// Sums of one characteristic in one shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct CharacteristicSums {
    pub(super) name: String,
    pub(super) summary: Summary,
    pub(super) largest: LargestPoints,
    pub(super) outside: [u64; 2],
    pub(super) groups: GroupSums,
    pub(super) failed: u64,
    /// First failure, in words.
    pub(super) error: Option<String>,
    /// Counts in bins. None if no point has a value.
    pub(super) bins: Option<Fine>,
}

/// Work that a shard took.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct ShardWork {
    evaluations: u64,
    cached: u64,
    retried: u64,
    failed: u64,
    stages: u64,
    in_model_s: f64,
}

/// Reason why a sample cannot be divided or merged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShardError {
    /// The sample cannot be drawn at all.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The number of a shard lies outside its range.
    #[error("there is no shard {number} of {count}: shards are counted from 1, and there are at most {most}")]
    NoSuchShard {
        /// Number of the shard.
        number: u64,
        /// Number of all shards.
        count: u64,
        /// Greatest number of shards.
        most: u64,
    },
    /// An option that needs all points in one process.
    #[error("a shard does not go with {option}: it needs all points in one run")]
    OneRun {
        /// Option in words.
        option: &'static str,
    },
    /// The run ended before all points of the shard were evaluated.
    #[error("the shard was stopped after {answered} of {points} points: its sums are not written")]
    Stopped {
        /// Evaluated points.
        answered: u64,
        /// Points of the shard.
        points: u64,
        /// Reason.
        reason: StopReason,
    },
    /// The model is not repeatable.
    #[error("`{output}` has different values when a point is evaluated again: sums of such a model are not merged")]
    NotRepeatable {
        /// Name of the output.
        output: String,
    },
    /// Answers of the model lack the check by a fresh process.
    #[error("answers of the model are not confirmed by a fresh process: sums of such a model are not merged")]
    Unconfirmed,
    /// The values are too large or too small for sums in doubles.
    #[error(
        "values of this size are computed in other units within one run: choose units in which they are between 1e-19 and 1e19"
    )]
    Extreme,
    /// There is nothing to merge.
    #[error("there are no shards to merge")]
    Nothing,
    /// Two shards belong to different samples.
    #[error("shard {number} belongs to another sample: its {what} is {found}, that of the first one {expected}")]
    Other {
        /// Number of the shard.
        number: u64,
        /// Property in which they differ.
        what: &'static str,
        /// Value of the shard.
        found: String,
        /// Value of the first shard.
        expected: String,
    },
    /// A shard that is given twice, with different sums.
    #[error("shard {number} is given twice, and its sums differ: evaluate it again")]
    Contradiction {
        /// Number of the shard.
        number: u64,
    },
    /// Shards are missing.
    #[error("of {count} shards {} missing: {}", many(missing), listed(missing))]
    Missing {
        /// Number of all shards.
        count: u64,
        /// Numbers of the missing ones, ascending.
        missing: Vec<u64>,
    },
    /// The sums of a shard contradict each other.
    #[error("shard {number} was changed: its numbers of points do not add up, so evaluate it again")]
    Inconsistent {
        /// Number of the shard.
        number: u64,
    },
    /// A shard has bins of its own.
    #[error(
        "`{characteristic}` has no value at the first points, so that shards have no common histogram: simulate in one run"
    )]
    NoCommonBins {
        /// Name of the characteristic.
        characteristic: String,
    },
}

/// Number of missing shards, with its verb.
fn many(missing: &[u64]) -> String {
    if missing.len() == 1 { "one is".to_owned() } else { format!("{} are", missing.len()) }
}

/// First missing shards.
fn listed(missing: &[u64]) -> String {
    /// Shards that an error names.
    const NAMED: usize = 12;
    let named: Vec<String> = missing.iter().take(NAMED).map(u64::to_string).collect();
    named.join(", ") + if missing.len() > NAMED { ", ..." } else { "" }
}

impl ShardWork {
    pub(super) fn of(run: &RunSummary) -> Self {
        let RunSummary { evaluations, cached, retried, failed, stages, in_model, .. } = *run;
        Self { evaluations, cached, retried, failed, stages, in_model_s: in_model.as_secs_f64() }
    }

    pub(super) fn add_to(self, run: RunSummary) -> RunSummary {
        let in_model = std::time::Duration::try_from_secs_f64(self.in_model_s).unwrap_or_default();
        let Self { evaluations, cached, retried, failed, stages, .. } = self;
        run.and(&RunSummary { evaluations, cached, retried, failed, stages, in_model, ..RunSummary::default() })
    }
}

impl ShardSums {
    /// True if the sums are those of the other, whatever the work that they took.
    pub(super) fn equals(&self, other: &Self) -> bool {
        self.answered == other.answered
            && self.characteristics == other.characteristics
            && self.together == other.together
    }

    /// True if the numbers of points of the file agree with each other.
    pub(super) fn add_up(&self) -> bool {
        self.characteristics.iter().all(|one| {
            let values = one.summary.count();
            let bins = one.bins.as_ref().map_or(0, Fine::total);
            let outside = one.outside[0].checked_add(one.outside[1]);
            values.checked_add(one.failed) == Some(self.answered)
                && bins == values
                && outside.is_some_and(|outside| outside <= values)
        }) && self.together.counts_up_to(self.answered)
    }
}

/// First failure of a characteristic, as read from a file.
pub(super) fn failure(message: &str) -> EvaluationError {
    EvaluationError::Refused { message: message.to_owned() }
}
