//! The largest residual of a surface far from the means, as it is reported.

use serde::Serialize;

use crate::estimate::strata::length;
use crate::verification::check_ray::Profile;
use crate::verification::checked_surface::CheckedSurface;
use crate::verification::far_effect::FarEffect;
use sensitol_numeric::distribution::standard_normal;

/// Change of mean or sigma in sigmas below which a residual is not reported.
const FELT: f64 = 0.01;
/// Factor of the relative change of a reject rate beside changes of moments: a tenth of the rejects matters as much as [`FELT`].
const OF_REJECTS: f64 = 0.1;
/// Change of a reject rate below which a residual is not reported.
const SELDOM: f64 = 1e-6;
/// Part of the last residual up to which the surface holds.
const SMALL: f64 = 0.1;
/// Least part of the deviation of a named input in that of all.
const NAMED: f64 = 0.3;

/// A difference between model and surface that check points met far from the means.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FarResidual {
    /// Dimensions that deviate there, by position, and true for those that deviate upward.
    #[serde(skip)]
    pub directions: Vec<(usize, bool)>,
    /// Distance in sigmas from which on the model may differ.
    pub from: f64,
    /// Model minus surface in sigmas at the farthest check point. None if the model has no value there.
    pub residual: Option<f64>,
    /// Share of the assemblies that may lie beyond that distance.
    pub share: f64,
}

impl FarResidual {
    /// Returns the residual with the greatest effect that is felt.
    ///
    /// Shapes: `kept` has the share of the surface within every interval of the effects, `varying` a dimension for every variable.
    pub(super) fn largest(
        surface: &CheckedSurface<'_>,
        far: &[FarEffect<'_>],
        kept: &[f64],
        varying: &[usize],
    ) -> Option<Self> {
        let felt = far.iter().map(|effect| (size(effect, kept), effect));
        let (size, FarEffect { ray, profile, .. }) = felt.max_by(|a, b| a.0.total_cmp(&b.0))?;
        if size < FELT {
            return None;
        }
        // Correlated inputs deviate together, whatever variable carries them.
        let inputs = surface.inputs_at(&ray.end());
        let least = NAMED * length(&inputs);
        let named = inputs.iter().zip(varying).filter(|(x, _)| x.abs() > least);
        let (from, residual) = match profile {
            Profile::Residual(at) => (begin(at), at.last().map(|[_, d]| *d)),
            Profile::WithoutValue([last, _]) => (*last, None),
        };
        let share = standard_normal::sf(from);
        Some(Self { directions: named.map(|(x, &d)| (d, *x > 0.0)).collect(), from, residual, share })
    }
}

/// Last distance up to which all residuals are a small part of the last one.
fn begin(at: &[[f64; 2]]) -> f64 {
    let [_, end] = at[at.len() - 1];
    let small = at.iter().take_while(|[_, d]| d.abs() <= SMALL * end.abs());
    small.last().map_or(0.0, |[t, _]| *t)
}

/// Greatest change of mean and sigma in sigmas, and of the reject rates.
fn size(effect: &FarEffect<'_>, kept: &[f64]) -> f64 {
    let [mean, sigma, ..] = effect.moments.map(f64::abs);
    let of_rejects = |(change, kept): (&f64, &f64)| {
        let change = change.abs();
        if change > SELDOM { OF_REJECTS * change / (1.0 - kept + change) } else { 0.0 }
    };
    effect.shares.iter().zip(kept).map(of_rejects).fold(mean.max(sigma), f64::max)
}
