//! Distribution by inversion, with points of the surface where a contour does not resolve a limit.

use std::sync::{Arc, OnceLock};

use crate::law::inversion::tail_inversion::Inversion;
use crate::law::inversion::transform::{Summed, Transform};
use crate::law::sampled_law::Sampled;
use crate::law::surface::Surface;
use crate::law::{LawFigure, LawOptions, LawTail};

/// Relative error of a probability above which points are better than a contour.
const POOR: f64 = 1e-3;

/// Density per sigma that sets the scale of density errors: a quarter of the peak of a normal distribution.
const PEAK: f64 = 0.1;
/// Absolute error that points cannot lower.
const TRACE: f64 = 1e-8;

/// Inversion of a whole surface.
#[derive(Debug)]
pub(super) struct Exact {
    pub(super) inversion: Inversion,
    /// Points of the surface, made when a limit is not resolved, as next to a corner of the density.
    pub(super) points: OnceLock<Option<Sampled>>,
    pub(super) options: LawOptions,
}

/// True if the error is too large relative to a probability or its complement.
pub(super) fn is_poor(figure: LawFigure) -> bool {
    let smaller = figure.value.min(1.0 - figure.value).max(0.0);
    figure.error.is_nan() || figure.value.is_nan() || figure.error > POOR * smaller + TRACE
}

impl Exact {
    /// Probability beyond `y` on one side.
    pub(super) fn tail(&self, surface: &Arc<Surface>, y: f64, tail: LawTail) -> LawFigure {
        let own = self.inversion.tail(y, tail);
        let better = |points: &Sampled| better(own, points.tail(y, tail, self.inversion.mean()));
        if is_poor(own) { self.points(surface).map_or(own, better) } else { own }
    }

    /// Density per unit of `y`.
    pub(super) fn density(&self, surface: &Arc<Surface>, y: f64) -> LawFigure {
        let own = self.inversion.density(y);
        let poor =
            own.value.is_nan() || own.error.is_nan() || own.error > POOR * own.value.max(PEAK / self.inversion.sigma());
        let better = |points: &Sampled| better(own, points.density(y, self.inversion.mean()));
        if poor { self.points(surface).map_or(own, better) } else { own }
    }

    /// Distribution with every component sampled except along one direction.
    fn points(&self, surface: &Arc<Surface>) -> Option<&Sampled> {
        let make = || {
            let components = surface.components();
            let (transform, _) = Transform::of(surface, &[], Summed::Singles);
            Sampled::of(surface, transform, &components, self.inversion.sigma(), &self.options)
        };
        self.points.get_or_init(make).as_ref()
    }
}

/// Figure with the smaller error. Points win if they contradict the contour or if the contour returned NaN.
fn better(own: LawFigure, points: LawFigure) -> LawFigure {
    let contradicted = (own.value - points.value).abs() > own.error + points.error;
    if points.error < own.error || contradicted || own.value.is_nan() { points } else { own }
}
