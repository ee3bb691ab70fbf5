//! Zones in which a surface is a plane, with their two coordinates as independent inputs.
//!
//! The projection of a disc or of its rim onto a line varies as one coordinate with the slope `hypot(a, b)`. A diamond's coordinates are
//! half the sum and half the difference of two independent uniform variables.

use std::sync::Arc;

use crate::correlation::{Block, Correlation, JointLaw};
use crate::distribution::{Distribution, Uniform};
use crate::law::LawFigure;
use crate::surrogate::{Surrogate, Univariate};

/// Surface without the zones in which it is a plane.
pub(super) struct Straightened {
    pub(super) surrogate: Surrogate,
    pub(super) inputs: Vec<Arc<dyn Distribution>>,
    pub(super) correlation: Option<Correlation>,
    pub(super) zones: Vec<Zone>,
}

/// Zone by the positions of its coordinates, with their slopes.
#[derive(Debug, Clone)]
pub(super) struct Zone {
    members: [usize; 2],
    slopes: [f64; 2],
    diamond: bool,
}

/// Surface with independent inputs in place of such zones. Returns None if there is no such zone.
pub(super) fn straightened(
    surrogate: &Surrogate,
    inputs: &[Arc<dyn Distribution>],
    correlation: Option<&Correlation>,
) -> Option<Straightened> {
    let correlation = correlation?;
    let products = surrogate.interactions.pairs();
    // A zone is straight if both its coordinates have linear parts and no products.
    let plane = |block: &Block| -> Option<Zone> {
        let &[j, k] = &block.members[..] else { return None };
        if matches!(block.law, JointLaw::Rows(_) | JointLaw::Solid(_))
            || products.iter().any(|&(a, b, _)| [a, b].iter().any(|d| [j, k].contains(d)))
        {
            return None;
        }
        let slope = |d: usize| {
            let [slope, rest @ ..] = surrogate.parts.get(d).copied().flatten()?.coefficients();
            rest.iter().all(|&c| c == 0.0).then_some(slope)
        };
        Some(Zone { members: [j, k], slopes: [slope(j)?, slope(k)?], diamond: block.law == JointLaw::Diamond })
    };
    let found: Vec<Option<Zone>> = correlation.blocks().iter().map(plane).collect();
    let zones: Vec<Zone> = found.iter().flatten().cloned().collect();
    if zones.is_empty() {
        return None;
    }
    // Replace the coordinates: a diamond by its two uniform variables, a disc or rim by its projection onto the gradient.
    let (mut surrogate, mut inputs) = (surrogate.clone(), inputs.to_vec());
    for Zone { members: [j, k], slopes: [a, b], diamond } in &zones {
        let slopes = match diamond {
            true => {
                let uniform: Arc<dyn Distribution> = Arc::new(Uniform::new(-1.0, 1.0).ok()?);
                (inputs[*j], inputs[*k]) = (Arc::clone(&uniform), uniform);
                [a + b, a - b].map(|sum| sum * std::f64::consts::FRAC_1_SQRT_2)
            }
            false => [libm::hypot(*a, *b), 0.0],
        };
        for (d, slope) in [j, k].into_iter().zip(slopes) {
            surrogate.parts[*d] = Some(Univariate::of_coefficients(&[slope]));
        }
    }
    let correlation = correlation.without(&|block| found[block].is_some());
    Some(Straightened { surrogate, inputs, correlation, zones })
}

impl Zone {
    /// Turns derivatives by the tolerances of the replacing inputs into those by the zone's coordinates, in place.
    pub(super) fn distribute(&self, derivatives: &mut [LawFigure]) {
        let ([j, k], [a, b]) = (self.members, self.slopes);
        let part = |figure: LawFigure, by: f64| match by.is_finite() {
            true => LawFigure::new(figure.value * by, figure.error * by.abs()),
            false => LawFigure::new(0.0, 0.0),
        };
        let sum = |x: LawFigure, y: LawFigure| LawFigure::new(x.value + y.value, x.error + y.error);
        let (first, second) = (derivatives[j], derivatives[k]);
        (derivatives[j], derivatives[k]) = match self.diamond {
            true => (
                sum(part(first, a / (a + b)), part(second, a / (a - b))),
                sum(part(first, b / (a + b)), part(second, -b / (a - b))),
            ),
            false => (part(first, a * a / (a * a + b * b)), part(first, b * b / (a * a + b * b))),
        };
    }
}
