//! Error estimates of the figures of a surface, from its residuals at check points.
//!
//! With `d = (y - q)/sigma`, the model minus the surface `q` in sigmas, at points of independent normal variables `z`:
//!
//! ```text
//! p(z)    = c_1 t + .. + c_4 t^4  (t = a.z, through the 4 differences on the line and 0)  +  sum_j z_j (z_j^2 - 3)(m_j + k_j z_j)
//! moved_r = figure_r(q + sigma p) - figure_r(q)                    exact in p, however large
//! e_i     = d_i - p(z_i) at the K random points                    (d_i, should that be smaller)
//! rho^2   = 1.3^2 (sum e^2 + max e^2)/K + 0.004^2 14/n + mean d^2(idle)/50
//! h       = 1, z, 3 z^2 - 3 - 3 g z, 4 z^3 - 4 g - 4 k z           influence on mean, sigma, skewness, kurtosis (Serfling 1980)
//! seen_r  = hypot(mean, standard error) of h_r(z_i) e_i
//! bound_r = sd(h_r) rho/sqrt K + (0, 1/2, 2, 6) rho^2              |E h e| <= sd(h) rho by Cauchy and Schwarz: 1/sqrt K of it would not show
//! far_r   = root of the sum of squares of the changes by the residuals along rays far from the means
//! error_r = sqrt(max(moved, far)^2 + seen^2 + bound^2)
//! share   = sqrt(moved^2 + limits by rho^2 + far^2 + (rejects unseen/2)^2 + (Phi(-4.5)/2)^2)
//! ```
//!
//! Two errors of a share reach what no point has shown: the share `unseen = 1 - 0.05^(1/n)` of all rejects, and all assemblies beyond 4.5
//! sigmas, the farthest check point towards a limit.
//!
//! `|t|` and `|z_j|` are clipped at 4.5. The errors of mean and sigma are multiplied by sigma. `3 hypot(m, s) >= m + 2.8 s`, Student's
//! quantile for a dozen points. The floor `0.004 sqrt(14/n)` allows for effects that a dozen points overlook: they give mean and sigma no
//! better than to 1.5e-3 of sigma.

use crate::estimate::Columns;
use crate::estimate::figures::{MOMENTS, moments};
use crate::estimate::strata;
use crate::estimate::strata::{along, dot};
use crate::verification::check_points::{Design, ON_AXIS, Wish};
use crate::verification::checked_surface::CheckedSurface;
use crate::verification::far_effect::FarEffect;
use crate::verification::likeliest_point::FARTHEST;
use crate::verification::unseen_share::unseen;
use sensitol_numeric::distribution::standard_normal;

/// Residual that [`OVERLOOKED_BY`] points may overlook, in sigmas. With `n` points it falls as `1/sqrt(n)`.
pub(crate) const OVERLOOKED: f64 = 0.004;
/// Number of points that [`OVERLOOKED`] refers to.
pub(crate) const OVERLOOKED_BY: f64 = 14.0;
/// Factor by which the root mean square of a handful of residuals may be too small. It is exceeded in 6 % of all cases for a dozen normal
/// residuals with the largest counted twice, and in 3 % for 32 residuals that are counted once.
pub(crate) const TOO_SMALL: f64 = 1.3;
/// Distance in sigmas beyond which polynomials are continued as constants.
const CLIPPED: f64 = 4.5;
/// Square of the outer nodes of the three-point rule, in normal variables: the univariate parts of a surface are exact there.
const NODES: f64 = 3.0;
/// Divisor of the mean square of the idle inputs' differences, four sigmas out, for their effect on all assemblies.
const IDLE: f64 = 50.0;
/// Smallest number of random points with a value: fewer have no useful standard error.
const FEWEST: usize = 3;
/// Contribution to the figures of the square of a residual that follows the output.
const SQUARES: [f64; MOMENTS] = [0.0, 0.5, 2.0, 6.0];

/// Results of one characteristic from the check points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    /// Errors of mean, sigma, skewness and kurtosis.
    pub(super) errors: [f64; MOMENTS],
    /// Error of the share within every interval.
    pub(super) shares: Vec<f64>,
    /// Share of the variance that the surface leaves unexplained.
    pub(super) left: f64,
}

/// Estimated shape of the residual (`p` above).
struct Bend<'d> {
    line: Option<(&'d [f64], [f64; 4])>,
    /// Input, odd and even coefficient of the parts along axes.
    axes: Vec<(usize, f64, f64)>,
}

impl Bend<'_> {
    fn at(&self, z: &Columns) -> Vec<f64> {
        let rows = z.first().map_or(0, Vec::len);
        let mut bend = vec![0.0; rows];
        if let Some((line, [c1, c2, c3, c4])) = &self.line {
            for (sum, t) in bend.iter_mut().zip(along(z, line)) {
                let t = t.clamp(-CLIPPED, CLIPPED);
                *sum += t * (c1 + t * (c2 + t * (c3 + t * c4)));
            }
        }
        for &(j, odd, even) in &self.axes {
            for (sum, &t) in bend.iter_mut().zip(&z[j]) {
                let t = t.clamp(-CLIPPED, CLIPPED);
                *sum += t * (t * t - NODES) * (odd + even * t);
            }
        }
        bend
    }
}

/// Coefficients of the quartic without constant through values at 1.5, -1.5, 3 and -3.
fn quartic([near_up, near_down, far_up, far_down]: [f64; 4]) -> [f64; 4] {
    let odd = [0.5 * (near_up - near_down) / 1.5, 0.5 * (far_up - far_down) / 3.0];
    let even = [0.5 * (near_up + near_down) / 2.25, 0.5 * (far_up + far_down) / 9.0];
    let [third, fourth] = [odd, even].map(|[near, far]| (far - near) / 6.75);
    [odd[0] - 2.25 * third, even[0] - 2.25 * fourth, third, fourth]
}

/// Judges a surface by its residuals in sigmas at the points of a design, and by the effects of those far from the means.
///
/// Shapes: `d` has a residual for every point of the design, NaN at points without a value; `surface_at` has the values of the surface at
/// the random ones. Returns None if fewer than [`FEWEST`] random points have a value, and if an error is not finite.
pub(super) fn judge(
    design: &Design,
    wish: &Wish,
    surface: &CheckedSurface<'_>,
    d: &[f64],
    surface_at: &[f64],
    far: &[FarEffect<'_>],
    intervals: &[[f64; 2]],
) -> Option<Judged> {
    let sigma = surface.figures[1];
    let random = design.random();
    let answered: Vec<usize> = (random..design.points.len()).filter(|&row| d[row].is_finite()).collect();
    if answered.len() < FEWEST {
        return None;
    }
    // A point without a value has no residual. The effects far from the means contain the assemblies about it.
    let known: Vec<f64> = d[..random].iter().map(|&d| if d.is_finite() { d } else { 0.0 }).collect();
    let bend = bend(design, wish, &known);
    // Effect of the bend on the figures, exact for any size.
    let over_all = bend.at(&surface.z);
    let moved_values: Vec<f64> = surface.values.iter().zip(&over_all).map(|(q, p)| q + sigma * p).collect();
    let moved_figures = moments(&moved_values, &surface.weights);
    let units = [sigma, sigma, 1.0, 1.0];
    let moved: [f64; MOMENTS] = std::array::from_fn(|r| (moved_figures[r] - surface.figures[r]) / units[r]);

    let rest = RandomResiduals::new(design, d, surface_at, &bend, &answered);
    let idle = match design.idle_inputs.is_empty() {
        true => 0.0,
        false => sum_of_squares(&known[random - 2..]) / 2.0 / IDLE,
    };
    let rho = rest.mean_square() + OVERLOOKED * OVERLOOKED * OVERLOOKED_BY / design.points.len() as f64 + idle;
    let [seen, spread] = [rest.seen(surface), spread(surface)];
    let errors = std::array::from_fn(|r| {
        let bound = (spread[r] * rho / rest.e.len() as f64).sqrt() + SQUARES[r] * rho;
        let far = sum_of_squares(&far.iter().map(|effect| effect.moments[r]).collect::<Vec<f64>>());
        // A moment that overflows is unknown.
        let far = if far.is_nan() { f64::INFINITY } else { far };
        units[r] * (far.max(moved[r] * moved[r]) + seen[r] * seen[r] + bound * bound).sqrt()
    });
    if errors.iter().any(|error: &f64| !error.is_finite()) {
        return None;
    }
    let total: f64 = surface.weights.iter().sum();
    let mean_square = |of: &[f64]| of.iter().zip(&surface.weights).map(|(p, w)| w / total * p * p).sum::<f64>();
    let far_square: f64 = far.iter().map(|effect| effect.square).sum();
    let [_, unseen] = unseen(d.len(), 0);
    let share = |(index, &interval): (usize, &[f64; 2])| {
        let changes = far.iter().map(|effect| effect.shares[index]).collect::<Vec<f64>>();
        let beside = 0.5 * unseen * (1.0 - surface.share(interval));
        let beyond = 0.5 * standard_normal::sf(FARTHEST);
        let own = share_error(surface, &moved_values, interval, rho.sqrt());
        (own * own + sum_of_squares(&changes) + beside * beside + beyond * beyond).sqrt().min(1.0)
    };
    let shares = intervals.iter().enumerate().map(share).collect();
    Some(Judged { errors, shares, left: rho + mean_square(&over_all).max(far_square) })
}

/// Residuals at the random points that have a value, less the bend if that makes them smaller.
struct RandomResiduals {
    e: Vec<f64>,
    /// Values of the surface at the same points.
    surface_at: Vec<f64>,
}

impl RandomResiduals {
    fn new(design: &Design, d: &[f64], surface_at: &[f64], bend: &Bend<'_>, answered: &[usize]) -> Self {
        let of_answered = |column: &[f64]| answered.iter().map(|&row| column[row]).collect::<Vec<f64>>();
        let points: Columns = design.columns().iter().map(|column| of_answered(column)).collect();
        let differences = of_answered(d);
        let left: Vec<f64> = differences.iter().zip(bend.at(&points)).map(|(d, p)| d - p).collect();
        let e = if sum_of_squares(&left) <= sum_of_squares(&differences) { left } else { differences };
        Self { e, surface_at: of_answered(surface_at) }
    }

    /// Mean square, with the largest residual counted twice.
    fn mean_square(&self) -> f64 {
        let largest = self.e.iter().map(|e| e * e).fold(0.0, f64::max);
        TOO_SMALL * TOO_SMALL * (sum_of_squares(&self.e) + largest) / self.e.len() as f64
    }

    /// Changes of the figures that the residuals show: their mean influence, with its standard error.
    fn seen(&self, surface: &CheckedSurface<'_>) -> [f64; MOMENTS] {
        let [mean, sigma, ..] = surface.figures;
        let k = self.e.len() as f64;
        let row = |(e, q): (&f64, &f64)| influence(surface, (q - mean) / sigma).map(|h| h * e);
        let rows: Vec<[f64; MOMENTS]> = self.e.iter().zip(&self.surface_at).map(row).collect();
        std::array::from_fn(|r| {
            let average = rows.iter().map(|row| row[r]).sum::<f64>() / k;
            let variance = rows.iter().map(|row| (row[r] - average).powi(2)).sum::<f64>() / (k - 1.0);
            libm::hypot(average, (variance / k).sqrt())
        })
    }
}

/// Influence of a residual at a standardised value of the surface on mean, sigma, skewness and kurtosis (Serfling 1980).
fn influence(surface: &CheckedSurface<'_>, z: f64) -> [f64; MOMENTS] {
    let [.., skewness, kurtosis] = surface.figures;
    [1.0, z, 3.0 * z * z - 3.0 - 3.0 * skewness * z, 4.0 * z.powi(3) - 4.0 * skewness - 4.0 * kurtosis * z]
}

/// Mean squares of the influences over the whole distribution.
fn spread(surface: &CheckedSurface<'_>) -> [f64; MOMENTS] {
    let [mean, sigma, ..] = surface.figures;
    let total: f64 = surface.weights.iter().sum();
    let mut spread = [0.0; MOMENTS];
    for (q, weight) in surface.values.iter().zip(&surface.weights) {
        let h = influence(surface, (q - mean) / sigma);
        spread.iter_mut().zip(h).for_each(|(sum, h)| *sum += weight / total * h * h);
    }
    spread
}

fn sum_of_squares(of: &[f64]) -> f64 {
    of.iter().map(|e| e * e).sum()
}

/// Fits the bend to the differences at the points on lines and axes.
fn bend<'d>(design: &'d Design, wish: &Wish, d: &[f64]) -> Bend<'d> {
    let line = design.line_of(wish).map(|index| {
        let own = &d[4 * index..4 * index + 4];
        (design.lines[index].as_slice(), quartic([own[0], own[1], own[2], own[3]]))
    });
    let first = 4 * design.lines.len();
    let axes = design.axes.iter().enumerate().filter(|&(_, &j)| wish.has_axis(j));
    let part = |(index, &j): (usize, &usize)| {
        // The part is 0 in the middle and at the nodes, and exact at three sigma.
        let outer = (ON_AXIS * ON_AXIS - NODES) * ON_AXIS;
        let [up, down] = [d[first + 2 * index] / outer, -d[first + 2 * index + 1] / outer];
        (j, 0.5 * (up + down), (up - down) / (2.0 * ON_AXIS))
    };
    Bend { line, axes: axes.map(part).collect() }
}

/// Error of the share within an interval: by the bend, and by limits that move by the residual, which grows outward.
fn share_error(surface: &CheckedSurface<'_>, moved: &[f64], interval: [f64; 2], rho: f64) -> f64 {
    let share = |values: &[f64], interval: [f64; 2]| surface.share_of(values, interval);
    let [mean, sigma, ..] = surface.figures;
    let here = surface.share(interval);
    let mut square = (share(moved, interval) - here).powi(2);
    for end in [0, 1].into_iter().filter(|&end| interval[end].is_finite()) {
        let by = rho * sigma.max((interval[end] - mean).abs());
        let off = [by, -by].map(|by| {
            let mut limits = interval;
            limits[end] += by;
            (share(&surface.values, limits) - here).abs()
        });
        square += off[0].max(off[1]).powi(2);
    }
    square.sqrt()
}

impl Judged {
    /// Error of a share of the variance: `2 sqrt(T U/K) + U/(1 + U)` with `U` the unexplained share.
    pub(super) fn share_of_variance(&self, share: f64, pairs: usize) -> f64 {
        2.0 * (share.max(0.0) * self.left / (2 * pairs) as f64).sqrt() + self.left / (1.0 + self.left)
    }
}

/// Normalised covariances of a surface with its variables: the direction along which it varies most.
pub(super) fn regression(surface: &CheckedSurface<'_>) -> Vec<f64> {
    let [mean, sigma, ..] = surface.figures;
    let weighted: Vec<f64> =
        surface.values.iter().zip(&surface.weights).map(|(q, weight)| weight * (q - mean) / sigma).collect();
    strata::unit(surface.z.iter().map(|column| dot(column, &weighted)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quartic_passes_its_points() {
        let of = |t: f64| t * (0.3 + t * (-0.2 + t * (0.05 + t * 0.01)));
        let found = quartic([of(1.5), of(-1.5), of(3.0), of(-3.0)]);
        for (found, expected) in found.iter().zip([0.3, -0.2, 0.05, 0.01]) {
            // A few roundings of numbers near 1.
            assert!((found - expected).abs() < 1e-15, "{found} for {expected}");
        }
    }
}
