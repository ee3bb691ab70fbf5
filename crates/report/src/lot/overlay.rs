//! Overlay of a characteristic: densities by the assumed and by the measured parts, and the measured assemblies.

use crate::document::{Chart, Layer, Plot, PlotAxis, PlotPoint, PlotScale, Stroke};
use sensitol::lot::{CharacteristicInLot, PredictedFigures};
use sensitol_numeric::pearson::Pearson;

/// Points of a curve.
const POINTS: u32 = 120;
/// Half-width of the drawn range, in sigmas of the wider prediction.
const REACH: f64 = 4.0;

/// Chart of a characteristic. Returns None without a prediction.
pub(super) fn overlay(one: &CharacteristicInLot) -> Option<Chart> {
    let assumed = one.assumed?;
    let parts = one.by_parts.unwrap_or(assumed);
    let low = [assumed, parts].map(|of| of.mean - REACH * of.sigma);
    let high = [assumed, parts].map(|of| of.mean + REACH * of.sigma);
    let (low, high) = (low[0].min(low[1]), high[0].max(high[1]));
    if low.partial_cmp(&high) != Some(std::cmp::Ordering::Less) {
        return None;
    }
    let places: Vec<f64> =
        (0..=POINTS).map(|point| low + (high - low) * f64::from(point) / f64::from(POINTS)).collect();
    let mut layers = Vec::new();
    let drawn = [(Some(assumed), Stroke::Dotted), (one.by_parts, Stroke::Strong)];
    for (of, stroke) in drawn.into_iter().filter_map(|(of, stroke)| Some((of?, stroke))) {
        let density = density(&of)?;
        layers.push(Layer::Curve(places.iter().map(|x| (*x, Some(density.pdf(*x)))).collect(), stroke));
    }
    if let Some(assemblies) = &one.assemblies {
        layers.push(Layer::Points(bins(&assemblies.values)));
    }
    let unit = one.unit.as_deref().map_or(String::new(), |unit| format!(" [{unit}]"));
    let mut words = "Dotted: predicted by the assumed parts.".to_owned();
    if one.by_parts.is_some() {
        words += " Line: predicted by the measured parts.";
    }
    if one.assemblies.is_some() {
        words += " Circles: density of the measured assemblies, a circle for each interval.";
    }
    Some(Chart::Plot(Plot {
        name: one.name.clone(),
        x: PlotAxis::new(format!("{}{unit}", one.name), PlotScale::Linear(0.0)),
        y: PlotAxis::new("density", PlotScale::Linear(0.05)),
        layers,
        words,
    }))
}

fn density(of: &PredictedFigures) -> Option<Pearson> {
    let fitted = of.skewness.zip(of.kurtosis);
    let fitted = fitted.and_then(|(skewness, kurtosis)| Pearson::new(of.mean, of.sigma, skewness, kurtosis).ok());
    fitted.or_else(|| Pearson::new(of.mean, of.sigma, 0.0, 3.0).ok())
}

/// Density of values in intervals of equal width, about the root of their number.
fn bins(values: &[f64]) -> Vec<PlotPoint> {
    let (low, high) =
        (values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max));
    let count = (values.len() as f64).sqrt().ceil().max(1.0);
    let width = (high - low) / count;
    (0..count as usize)
        .map(|bin| {
            let (from, to) = (low + width * bin as f64, low + width * (bin as f64 + 1.0));
            let last = bin + 1 == count as usize;
            let inside = values.iter().filter(|value| **value >= from && (**value < to || last)).count();
            let at = [0.5 * (from + to), inside as f64 / (values.len() as f64 * width)];
            let tip = format!("{inside} of {}", values.len());
            PlotPoint { at, name: String::new(), tip, strong: true, filled: true }
        })
        .collect()
}
