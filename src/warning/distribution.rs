//! Warnings about the distribution of a characteristic.

use super::Advice;
use super::text::{Text, say};
use crate::method_kind::Method;

pub(super) fn infeasible_moments(characteristic: &str, reason: &str) -> Text {
    say(format!(
        "`{characteristic}` has no yield: {reason}. It may really have two values, or an interaction was not examined."
    ))
    .advise(Advice::UseMethod { methods: vec![Method::Full] })
    .advise(Advice::CheckMoments)
}

pub(super) fn near_infeasible_moments(characteristic: &str, skewness: &f64, kurtosis: &f64) -> Text {
    say(format!(
        "The kurtosis {kurtosis:.4} of `{characteristic}` is hardly above its lower bound 1 + skewness^2 = {:.4}. It has nearly two values \
         only. Its yield is very sensitive to the moments.",
        1.0 + skewness * skewness
    ))
    .advise(Advice::Sample { points: None })
}

pub(super) fn tails_missed(characteristic: &str, law: &f64, surface: &f64, points: &usize) -> Text {
    say(format!(
        "The yield of `{characteristic}` is unreliable: the Pearson fit gives {:.0} ppm rejects, the fitted surface {:.0} ppm ({points} \
         points). The estimated error of the yield includes the difference.",
        1e6 * law,
        1e6 * surface
    ))
    .advise(Advice::Sample { points: None })
    .advise(Advice::SampleRareEvents)
}

pub(super) fn several_modes(characteristic: &str, coefficient: &f64) -> Text {
    say(format!(
        "Skewness and kurtosis of `{characteristic}` are those of a distribution with two peaks ((skewness^2 + 1)/kurtosis = {coefficient:.2}). \
         A Pearson distribution has one peak or a trough, so quantiles and yield are unreliable."
    ))
    .advise(Advice::Sample { points: None })
}
