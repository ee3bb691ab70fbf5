//! Effect on the figures of a residual that was met far from the means.
//!
//! The residual `e(t)` along a ray `u` is taken to hold in the whole half-space `t = u.z > t_0`. Points of the half-space alone resolve its
//! share, however small:
//!
//! ```text
//! M_k   = E[v^k] + E[(v + e)^k - v^k; t > t_0]       k = 1 .. 4, v the surface in sigmas about its mean
//! share = share + E[1(v + e kept) - 1(v kept); t > t_0]
//! ```
//!
//! Without a value the assemblies of the half-space are left out: `M_k = (E[v^k] - E[v^k; t > t_0])/(1 - P(t > t_0))`. An effect of several
//! inputs fills only a part of the half-space, so that the change is rather too large than too small, unless there are further such places
//! that no point has met. It is an error, and no correction.

use crate::estimate::figures::{MOMENTS, standard};
use crate::estimate::strata::{HalfSpace, REACH, along};
use crate::verification::check_ray::{CheckRay, Profile};
use crate::verification::checked_surface::CheckedSurface;
use crate::verification::likeliest_point::FARTHEST;
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::sampling::Normals;

/// Points of a half-space, as a part of those of the surface.
const PART: usize = 8;
/// Residual in sigmas below which there is no effect to compute.
const NOTHING: f64 = 1e-3;
/// First stream of random numbers. The strata of a surface have smaller ones.
const STREAM: u64 = 1 << 36;

/// Changes of the figures of a surface by the residual along one ray.
pub(super) struct FarEffect<'r> {
    pub(super) ray: &'r CheckRay,
    pub(super) profile: Profile,
    /// Changes of mean and sigma in sigmas, of skewness and of kurtosis.
    pub(super) moments: [f64; MOMENTS],
    /// Changes of the share within every interval.
    pub(super) shares: Vec<f64>,
    /// Mean square of the residual over all assemblies, in sigmas.
    pub(super) square: f64,
    /// Greatest share of the assemblies without a value.
    pub(super) lost: f64,
}

impl<'r> FarEffect<'r> {
    /// Computes the effect of a residual on the figures and on the shares within intervals. Returns None if there is none.
    pub(super) fn new(
        surface: &CheckedSurface<'_>,
        normals: &Normals,
        ray: &'r CheckRay,
        profile: Profile,
        intervals: &[[f64; 2]],
    ) -> Option<Self> {
        if let Profile::Residual(at) = &profile
            && at.iter().all(|[_, d]| d.abs() < NOTHING)
        {
            return None;
        }
        let from = profile.from().min(REACH - 1.0);
        let mut z = normals.columns(STREAM, surface.knots() / PART);
        let weights = HalfSpace { direction: ray.direction.clone(), from }.enter(&mut z);
        let rows = weights.len() as f64;
        let [mean, sigma, skewness, kurtosis] = surface.figures;
        let (q, t) = (surface.at(&z)?, along(&z, &ray.direction));
        let mut raw = [0.0, 1.0, skewness, kurtosis];
        let mut shares = vec![0.0; intervals.len()];
        let mut square = 0.0;
        for ((q, t), weight) in q.into_iter().zip(t).zip(weights) {
            let (weight, v) = (weight / rows, (q - mean) / sigma);
            let kept = |value: f64, [low, high]: [f64; 2]| f64::from(u8::from(low <= value && value <= high));
            match &profile {
                Profile::Residual(at) => {
                    let e = Profile::residual(at, t, FARTHEST);
                    square += weight * e * e;
                    for (k, sum) in (1..).zip(&mut raw) {
                        *sum += weight * ((v + e).powi(k) - v.powi(k));
                    }
                    for (sum, &interval) in shares.iter_mut().zip(intervals) {
                        *sum += weight * (kept(q + sigma * e, interval) - kept(q, interval));
                    }
                }
                Profile::WithoutValue(_) => {
                    (1..).zip(&mut raw).for_each(|(k, sum)| *sum -= weight * v.powi(k));
                    for (sum, &interval) in shares.iter_mut().zip(intervals) {
                        *sum -= weight * kept(q, interval);
                    }
                }
            }
        }
        let mut lost = 0.0;
        if profile.is_without_value() {
            // Figures are those of the assemblies that have a value.
            lost = standard_normal::sf(from);
            for (sum, &interval) in shares.iter_mut().zip(intervals) {
                let kept = surface.share(interval);
                *sum = (kept + *sum) / (1.0 - lost) - kept;
            }
        }
        let moved = standard(&raw.map(|sum| sum / (1.0 - lost)), 0.0, 1.0);
        let base = [0.0, 1.0, skewness, kurtosis];
        Some(Self { ray, profile, moments: std::array::from_fn(|r| moved[r] - base[r]), shares, square, lost })
    }
}
