//! Conversion of warnings from divided outputs to the units of the characteristics.

use crate::warning::Warning;
use sensitol_numeric::power::Power;

impl Warning {
    /// Multiplies figures in the unit of a characteristic by the power of two for its name.
    pub(crate) fn rescale(&mut self, power_of: impl Fn(&str) -> Power) {
        // A value beyond the range of doubles becomes the greatest double.
        let times = |name: &str, figure: &mut f64| *figure = power_of(name).times(*figure).clamp(-f64::MAX, f64::MAX);
        match self {
            Self::Overflow { characteristic, value, limit } => {
                [value, limit].into_iter().for_each(|figure| times(characteristic, figure));
            }
            Self::FigureOff { characteristic, figure: "mean" | "sigma", value, model, error } => {
                [value, model, error].into_iter().for_each(|figure| times(characteristic, figure));
            }
            Self::HeavyPoint { characteristic, limit, .. }
            | Self::SurfaceLawRefuted { characteristic, limit, .. }
            | Self::NothingBeyond { characteristic, limit, .. }
            | Self::PlainFallback { characteristic, limit, .. }
            | Self::PlainSampling { characteristic, limit, .. } => times(characteristic, limit),
            Self::NotProven { characteristic, bounds: Some((bounds, _)), .. } => {
                bounds.iter_mut().for_each(|end| times(characteristic, end));
            }
            Self::ConfirmationMisses { characteristic, requirement: "sigma", required, interval } => {
                times(characteristic, required);
                interval.iter_mut().for_each(|end| times(characteristic, end));
            }
            _ => {}
        }
    }
}
