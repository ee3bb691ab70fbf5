//! What the model itself says of a characteristic, as reports show it.

use serde::Serialize;

use crate::analysis::{CharacteristicAnalysis, VerificationKind};
use crate::verification::{Crossing, Verified};

/// How results were verified, and by what.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct VerificationReport {
    /// `sample`, `checks` or `exact`.
    pub kind: &'static str,
    /// Points of the model.
    pub points: usize,
    /// The share of the assemblies that have a value; null where points do not tell.
    pub valid_share: Option<Verified>,
    /// The share of the variance that the surface leaves unexplained.
    pub left: Option<f64>,
    /// By the model itself; null without a sample of it.
    pub figures: VerifiedFiguresReport,
    /// Where the formula changes its form; null where the model does not tell.
    pub switches: Option<Vec<SwitchReport>>,
    /// The share of the assemblies that may do anything else where all points agree, at 95 %; null where points are many.
    pub unseen: Option<f64>,
    /// Shares of the variance by the model, where the surface is not trusted; null elsewhere.
    pub shares: Option<Vec<VarianceShareReport>>,
    /// Whether figures of the report are the model's, in place of the method's.
    pub replaced: bool,
    /// In one line.
    #[serde(skip)]
    pub words: String,
}

/// The figures of a verification.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct VerifiedFiguresReport {
    /// First moment.
    pub mean: Option<Verified>,
    /// Standard deviation.
    pub sigma: Option<Verified>,
    /// Third standardised moment.
    pub skewness: Option<Verified>,
    /// Fourth standardised moment.
    pub kurtosis: Option<Verified>,
    /// The share within the limits; by the surface with the error that checks give it, where there is no sample.
    #[serde(rename = "yield")]
    pub yield_: Option<Verified>,
    /// The share below the lower limit.
    pub below: Option<Verified>,
    /// The share above the upper limit.
    pub above: Option<Verified>,
}

/// A place at which a formula changes its form.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SwitchReport {
    /// The part of the formula that does it.
    pub name: String,
    /// `kink`, `jump`, `edge` or `pole`.
    pub kind: &'static str,
    /// The probability of its smaller side.
    pub probability: f64,
}

/// What a dimension explains of the variance.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct VarianceShareReport {
    /// The dimension.
    pub dimension: String,
    /// By itself.
    pub first: Verified,
    /// With all interactions in which it has a part.
    pub total: Verified,
}

impl VerificationReport {
    pub(super) fn of(one: &CharacteristicAnalysis) -> Option<Self> {
        let of = one.verification.as_ref()?;
        let [mean, sigma, skewness, kurtosis] = of.figures;
        let [below, above] = of.beyond;
        let switch = |found: &crate::verification::FoundSwitch| SwitchReport {
            name: found.switch.name(one.characteristic.name()),
            kind: match found.crossing {
                Crossing::Kink => "kink",
                Crossing::Jump => "jump",
                Crossing::Edge => "edge",
                Crossing::Pole => "pole",
            },
            probability: found.probability,
        };
        let share = |(d, [first, total]): &(usize, [Verified; 2])| VarianceShareReport {
            dimension: one.sensitivities[*d].dimension.clone(),
            first: *first,
            total: *total,
        };
        Some(Self {
            kind: match of.kind {
                VerificationKind::Sample => "sample",
                VerificationKind::Checks => "checks",
                VerificationKind::Exact { .. } => "exact",
            },
            points: of.points,
            valid_share: of.valid,
            left: of.left,
            figures: VerifiedFiguresReport { mean, sigma, skewness, kurtosis, yield_: of.yield_, below, above },
            switches: of.switches.as_ref().map(|found| found.iter().map(switch).collect()),
            unseen: of.unseen,
            shares: of.shares.as_ref().map(|shares| shares.iter().map(share).collect()),
            replaced: of.replaced,
            words: of.words(),
        })
    }
}
