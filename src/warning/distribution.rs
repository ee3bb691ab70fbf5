//! Warnings about the distribution of a characteristic.

use crate::method_kind::Method;
use crate::warning::Advice;
use crate::warning::text::{Text, say};

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

pub(super) fn pearson_differs(characteristic: &str, pearson: &f64, rejected: &f64, error: &f64) -> Text {
    let ppm = |share: &f64| format!("{:.0}", 1e6 * share);
    let known = if *error < 5e-7 { ppm(rejected) } else { format!("{} ± {}", ppm(rejected), ppm(error)) };
    say(format!(
        "The Pearson fit of `{characteristic}` would reject {} ppm, and {known} ppm are rejected: its four moments do not determine its \
         tails. The yield and the quantiles are not those of the fit.",
        ppm(pearson)
    ))
}

pub(super) fn several_modes(characteristic: &str, coefficient: &f64) -> Text {
    say(format!(
        "Skewness and kurtosis of `{characteristic}` are those of a distribution with two peaks ((skewness^2 + 1)/kurtosis = {coefficient:.2}). \
         A Pearson distribution has one peak or a trough, so quantiles and yield are unreliable."
    ))
    .advise(Advice::Sample { points: None })
}
