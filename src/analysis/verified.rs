//! What the verification of a characteristic found.

use crate::verification::{FoundSwitch, Share, Verified};

/// How figures were verified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// What the model itself says of a characteristic.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Verification {
    /// How.
    pub kind: VerificationKind,
    /// Points of the model that were evaluated for it.
    pub points: usize,
    /// The share of the assemblies that have a value; None where points do not tell.
    pub valid: Option<Verified>,
    /// The share of the variance that the surface leaves unexplained.
    pub left: Option<f64>,
    /// Mean, sigma, skewness and kurtosis by the model; None without a sample of it.
    pub figures: [Option<Verified>; 4],
    /// The share within the limits: by the model, or by the surface with the error that checks give it.
    pub yield_: Option<Verified>,
    /// The shares beyond the lower and the upper limit.
    pub beyond: [Option<Verified>; 2],
    /// How much more of the model than of its surface lies within the limits, below and above them; None without a sample of both.
    pub difference: Option<[Verified; 3]>,
    /// The switches that are met; None where the model does not tell where it changes its form.
    pub switches: Option<Vec<FoundSwitch>>,
    /// The share of the assemblies that may do anything else where all points agree, at 95 %; None where points are many.
    pub unseen: Option<f64>,
    /// First-order and total shares of the variance from the model, by the dimension's place, where the surface is not trusted.
    pub shares: Option<Vec<(usize, [Share; 2])>>,
    /// Whether figures of the characteristic are the model's, in place of the surface's.
    pub replaced: bool,
}

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
