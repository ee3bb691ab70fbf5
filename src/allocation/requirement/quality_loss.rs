//! Costs of the assemblies made: quality loss and scrap, as terms of the objective.
//!
//! ```text
//! k (sigma^2 + (mean - target)^2) + price (share of assemblies that break a limit)
//! ```
//!
//! This is the expected loss of G. Taguchi, "Introduction to quality engineering", Asian Productivity Organization
//! (1986): a deviation from the target costs `k` times its square. If the surface is a sum of dimensions with fixed
//! means, the first term is a sum of squares of tolerances, exact in the search. Any other loss is represented by its
//! value and slopes at the trial tolerances.

use crate::allocation::cost::cost_error::CostError;
use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::surface::response::Responses;

/// Cost of deviations and rejects of a characteristic, per assembly.
///
/// ```
/// use sensitol::allocation::QualityLoss;
/// // 40 per square of the unit, and 12 for an assembly that breaks a limit.
/// let loss = QualityLoss::new(0, 40.0, 0.0)?.with_scrap(12.0)?;
/// assert_eq!(loss.scrap, 12.0);
/// # Ok::<(), sensitol::allocation::CostError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct QualityLoss {
    /// Index of the characteristic in the problem.
    pub characteristic: usize,
    /// Cost per square of the characteristic's unit.
    pub k: f64,
    /// Value from which deviations count.
    pub target: f64,
    /// Cost of an assembly that breaks a limit.
    pub scrap: f64,
}

/// Half of the difference in `ln T`. Truncation and rounding are both near 1e-9.
const STEP: f64 = 3e-5;

impl QualityLoss {
    /// Creates a loss of `k` per square of the deviation from the target.
    ///
    /// # Errors
    ///
    /// If `k` is negative or not finite, or the target is not finite.
    pub fn new(characteristic: usize, k: f64, target: f64) -> Result<Self, CostError> {
        if !(k.is_finite() && k >= 0.0) {
            return Err(CostError::Negative { name: "k", value: k });
        }
        if !target.is_finite() {
            return Err(CostError::Negative { name: "target", value: target });
        }
        Ok(Self { characteristic, k, target, scrap: 0.0 })
    }

    /// Sets the cost of an assembly that breaks a limit.
    ///
    /// # Errors
    ///
    /// If it is negative or not finite.
    pub fn with_scrap(self, scrap: f64) -> Result<Self, CostError> {
        match scrap.is_finite() && scrap >= 0.0 {
            true => Ok(Self { scrap, ..self }),
            false => Err(CostError::Negative { name: "scrap", value: scrap }),
        }
    }

    /// Loss at factors of all tolerances, with nominals moved by `shifts`, in sigmas. Returns None if it is unknown.
    pub(in crate::allocation) fn at(
        &self,
        responses: &Responses,
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<f64> {
        let moments = responses.moments_shifted(self.characteristic, factors, shifts)?;
        let squares = self.k * (moments.sigma().powi(2) + (moments.mean() - self.target).powi(2));
        let scrapped = match self.scrap {
            0.0 => 0.0,
            price => price * responses.rejects(&[self.characteristic]).share(responses, factors, shifts)?,
        };
        Some(squares + scrapped)
    }

    /// True if the loss is a sum of squares of tolerances.
    pub(in crate::allocation) fn is_exact(&self, responses: &Responses) -> bool {
        self.scrap == 0.0 && responses.is_still_sum(self.characteristic)
    }

    /// Loss and its slopes at half bands. Returns None if they are unknown.
    pub(in crate::allocation) fn linearised(
        &self,
        responses: &Responses,
        priced: &[Priced],
        at: &[f64],
    ) -> Option<Linearised> {
        let c = self.characteristic;
        let factors = responses.factors(priced, at);
        let value = self.at(responses, &factors, None)?;
        if self.is_exact(responses) {
            let (_, squares) = responses.plain_squares(c, priced, &factors)?;
            return Some(Linearised::of_squares(value, squares.iter().map(|square| 2.0 * self.k * square).collect()));
        }
        let mut slopes = vec![0.0; priced.len()];
        let mut trial = factors.clone();
        for (group, slope) in priced.iter().zip(&mut slopes).filter(|(group, _)| responses.depends(c, group)) {
            let mut at = |step: f64| {
                group.members.iter().for_each(|&d| trial[d] = factors[d] * libm::exp(step));
                self.at(responses, &trial, None)
            };
            let (up, down) = (at(STEP)?, at(-STEP)?);
            group.members.iter().for_each(|&d| trial[d] = factors[d]);
            *slope = (up - down) / (2.0 * STEP);
        }
        value.is_finite().then(|| Linearised::of_squares(value, slopes))
    }
}

/// Sum of all losses at half bands of the groups. Infinite if one is unknown.
pub(in crate::allocation) fn losses_at(
    losses: &[QualityLoss],
    responses: &Responses,
    priced: &[Priced],
    at: &[f64],
) -> f64 {
    if losses.is_empty() {
        return 0.0;
    }
    let factors = responses.factors(priced, at);
    losses.iter().map(|loss| loss.at(responses, &factors, None).unwrap_or(f64::INFINITY)).sum()
}
