//! The results of the verification of a characteristic.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::verification::{FoundSwitch, Share, Tails, Verified, WeightedSample};
use sensitol_numeric::power::{Rescale, Rescaling, Unknown};
use sensitol_numeric::shape::{Four, Sides, through};

/// How figures were verified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum VerificationKind {
    /// By points of a cheap model.
    Sample,
    /// By check points of a costly model.
    Checks,
    /// By the formula itself, a polynomial of this degree that the surface holds exactly.
    Exact {
        /// The degree.
        degree: u32,
    },
}

/// Of the variance: a surface that leaves more unexplained says nothing of the tails, nor of an optimum.
pub(crate) const TRUSTED: f64 = 0.01;
/// A surface that leaves more of the variance unexplained does not follow the model, and has no contributions to show.
pub(super) const UNTRUSTED: f64 = 0.05;

/// The results of the model itself for a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
#[non_exhaustive]
pub struct Verification {
    /// How.
    #[serde(flatten, serialize_with = "through::<KindShape, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "KindShape"))]
    pub kind: VerificationKind,
    /// Points of the model that were evaluated for it.
    pub points: usize,
    /// Check points without a value; of a sample `valid` tells.
    #[serde(skip)]
    pub(crate) failed: usize,
    /// The share of the assemblies that have a value; None where points do not tell.
    #[serde(rename = "valid_share")]
    pub valid: Option<Verified>,
    /// The share of the variance that the surface leaves unexplained.
    pub left: Option<f64>,
    /// Mean, sigma, skewness and kurtosis by the model; None without a sample of it.
    #[serde(skip)]
    pub figures: [Option<Verified>; 4],
    /// The share within the limits: by the model, or by the surface with the error that checks give it.
    #[serde(skip)]
    pub yield_: Option<Verified>,
    /// The shares beyond the lower and the upper limit.
    #[serde(skip)]
    pub beyond: [Option<Verified>; 2],
    /// The weight of one point of a sample.
    #[serde(skip)]
    pub(crate) point: f64,
    /// How much more of the model than of its surface lies within the limits, below and above them; None without a sample of both.
    pub difference: Option<[Verified; 3]>,
    /// The switches that are met; None where the model does not tell where it changes its form.
    pub switches: Option<Vec<FoundSwitch>>,
    /// The share of the assemblies that may do anything else where all points agree, at 95 %; None where points are many.
    pub unseen: Option<f64>,
    /// Shares of the variance from the model, where the surface is not trusted.
    pub shares: Option<Vec<VarianceShare>>,
    /// The tails of the sample towards the limits; None without either.
    pub tails: Option<Tails>,
    /// Whether figures of the characteristic are the model's, in place of the surface's.
    pub replaced: bool,
    /// The sample, where an inspection asks for more of it.
    #[serde(skip)]
    pub(crate) sample: Option<Arc<WeightedSample>>,
}

/// The part of the variance that a dimension explains, by the model itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct VarianceShare {
    /// The dimension.
    pub dimension: String,
    /// By itself.
    pub first: Share,
    /// With all interactions in which it has a part.
    pub total: Share,
}

impl Rescale for Verification {
    fn rescale(&mut self, by: &mut Rescaling) {
        let [mean, sigma, ..] = &mut self.figures;
        mean.rescale(by);
        sigma.rescale(by);
        self.tails.rescale(by);
        if let Some(sample) = &mut self.sample {
            Arc::make_mut(sample).rescale(by);
        }
    }
}

impl Unknown for Verification {}

impl Verification {
    /// In one line.
    pub fn words(&self) -> String {
        match self.kind {
            VerificationKind::Sample => format!("verified at {} points of the model", self.points),
            VerificationKind::Checks => {
                let unseen = 100.0 * self.unseen.unwrap_or(1.0);
                format!("verified at {} check points; up to {unseen:.0} % of the assemblies unseen", self.points)
            }
            VerificationKind::Exact { degree } => format!("exact: the formula is a polynomial of degree {degree}"),
        }
    }
}

/// How figures were verified, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct KindShape {
    /// `sample`, `checks` or `exact`.
    kind: &'static str,
    /// The degree of the polynomial that the formula is; null where it was not verified so.
    degree: Option<u32>,
}

impl From<&VerificationKind> for KindShape {
    fn from(kind: &VerificationKind) -> Self {
        let (kind, degree) = match *kind {
            VerificationKind::Sample => ("sample", None),
            VerificationKind::Checks => ("checks", None),
            VerificationKind::Exact { degree } => ("exact", Some(degree)),
        };
        Self { kind, degree }
    }
}

/// A verification as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct VerificationShape<'r> {
    #[serde(flatten, serialize_with = "Verification::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "Verification"))]
    own: &'r Verification,
    /// By the model itself; null without a sample of it.
    figures: FiguresShape,
}

/// The figures of a verification.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct FiguresShape {
    #[serde(flatten)]
    moments: Four<Option<Verified>>,
    /// The share within the limits; by the surface with the error that checks give it, where there is no sample.
    #[serde(rename = "yield")]
    yield_: Option<Verified>,
    #[serde(flatten)]
    beyond: Sides<Option<Verified>>,
}

impl Serialize for Verification {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (moments, beyond) = (Four::from(&self.figures), Sides::from(&self.beyond));
        let figures = FiguresShape { moments, yield_: self.yield_, beyond };
        VerificationShape { own: self, figures }.serialize(serializer)
    }
}
