//! Change of a dimension and its band with the tolerance.

use sensitol_numeric::dimension::Dimension;

/// Relative difference that counts as rounding.
const SAME: f64 = 1e-12;

/// Change of a varying dimension with its tolerance.
#[derive(Clone, Copy)]
pub(in crate::allocation) enum Scaling {
    /// Same shape, with sigma in proportion. The mean moves by `alpha` old sigmas for every old half band that is
    /// added.
    Similar { alpha: f64 },
    /// Distribution with another shape at every tolerance.
    Reshaped,
    /// Distribution that does not depend on the tolerance.
    Still,
}

/// Band about the nominal at a factor of 1: its middle, its half-width, and the move of the middle per half-width that
/// is added.
#[derive(Clone, Copy)]
pub(in crate::allocation) struct Reach {
    pub(in crate::allocation) middle: f64,
    pub(in crate::allocation) half: f64,
    pub(in crate::allocation) lean: f64,
}

impl Scaling {
    pub(in crate::allocation) fn of(dimension: &Dimension) -> Self {
        let (mean, sigma) = (dimension.mean(), dimension.sigma());
        let Some(law) = dimension.distribution() else { return Self::Still };
        let scaled = |factor: f64| dimension.scaled(factor).and_then(Result::ok);
        let (Some(half), Some(double)) = (scaled(0.5), scaled(2.0)) else {
            return if dimension.scaled(1.0).is_some() { Self::Reshaped } else { Self::Still };
        };
        let alpha = (double.mean() - mean) / sigma;
        // Rounding of the mean, in sigmas.
        let blur = 8.0 * f64::EPSILON * (mean.abs() + double.mean().abs()) / sigma;
        let affine = ((half.mean() - mean) / sigma + 0.5 * alpha).abs() <= blur + SAME * alpha.abs();
        let wide = (double.sigma() / sigma - 2.0).abs() < SAME && (half.sigma() / sigma - 0.5).abs() < SAME;
        let shape = law.standard_moments();
        let same = [&half, &double].iter().all(|other| {
            other.distribution().is_some_and(|law| {
                let other = law.standard_moments().raw();
                other
                    .iter()
                    .zip(shape.raw())
                    .all(|(a, b)| (a.is_nan() && b.is_nan()) || (a - b).abs() <= SAME * b.abs().max(1.0))
            })
        });
        match affine && wide && same {
            true => Self::Similar { alpha: if alpha.abs() <= blur { 0.0 } else { alpha } },
            false => Self::Reshaped,
        }
    }
}

impl Reach {
    pub(in crate::allocation) fn of(dimension: &Dimension) -> Self {
        let [lower, upper] = dimension.reach();
        Self { middle: 0.5 * (lower + upper), half: 0.5 * (upper - lower), lean: dimension.lean() }
    }
}
