//! Warnings about derivatives, and about the points that they are computed from.

use crate::method_kind::Method;
use crate::warning::text::{Text, likewise, names, part, say};
use crate::warning::{Advice, Figure, Loss};

pub(super) fn lost_derivative(characteristic: &str, dimensions: &[String], loss: &Loss, others: &[String]) -> Text {
    let by = names(dimensions);
    let text = match loss {
        Loss::Centre => say(format!(
            "`{characteristic}` has no value at the means, from which every difference is taken. It has no derivatives and no moments."
        ))
        .advise(Advice::CheckNominal),
        Loss::Slope => say(format!("The slope of `{characteristic}` along {by} is unknown, so it has no moments."))
            .advise(Advice::KeepDefined)
            .advise(Advice::SmallerStep { dimension: dimensions.first().cloned() }),
        Loss::Curvature => say(format!(
            "The slope of `{characteristic}` along {by} is one-sided. The curvature there is unknown and left out of the moments."
        ))
        .advise(Advice::SmallerStep { dimension: None }),
        Loss::Mixed => say(format!(
            "The interaction of {by} in `{characteristic}` could not be evaluated. It is left out of the moments."
        ))
        .advise(Advice::SmallerStep { dimension: None }),
        Loss::OneSidedMixed => say(format!(
            "The interaction of {by} in `{characteristic}` could be evaluated at some of its corners only. It is less exact."
        ))
        .advise(Advice::SmallerStep { dimension: None }),
        Loss::NotEvaluated { derivatives } => say(format!(
            "The run was stopped before {derivatives} derivatives of `{characteristic}` were evaluated. Its results leave them out, and no \
             verdict follows."
        ))
        .advise(Advice::RaiseTimeLimit),
    };
    Text { message: text.message + &likewise(others), ..text }
}

pub(super) fn lost_moments(characteristic: &str, because: &str) -> Text {
    say(format!(
        "Mean and sigma of `{characteristic}` are unknown, and so is the rest: {because}. Methods based on derivatives tolerate lost points."
    ))
    .advise(Advice::UseMethod { methods: vec![Method::SecondOrder] })
}

pub(super) fn domain_edge(characteristic: &str, dimension: &str, failed: &f64, used: &f64, others: &[String]) -> Text {
    say(format!(
        "`{characteristic}` has no value with `{dimension}` at {failed:+.3} sigma, so {used:+.3} sigma was used.{} Part of the assemblies may \
         have no value; they are in no moment and no yield.",
        likewise(others)
    ))
    .advise(Advice::Sample { points: None })
}

pub(super) fn domain_edge_within(characteristic: &str, failed: &usize, points: &usize, share: &Option<f64>) -> Text {
    let share = share
        .filter(|share| *share > 0.0)
        .map_or(String::new(), |share| format!(" By their places, up to {} of the assemblies have none.", part(share)));
    say(format!(
        "`{characteristic}` has no value at {failed} of {points} points of the distribution. Such assemblies are in no moment and no \
         yield.{share}"
    ))
    .advise(Advice::Sample { points: None })
}

pub(super) fn support_edge(dimension: &str, from: &f64, to: &f64, others: &[String]) -> Text {
    say(format!(
        "The node of `{dimension}` at {from:+.3} sigma lies outside its distribution and was moved to {to:+.3}.{} The fourth moment of the \
         dimension is matched less exactly.",
        likewise(others)
    ))
}

pub(super) fn long_tail(
    characteristic: &str,
    dimension: &str,
    farthest: &f64,
    reach: &f64,
    share: &f64,
    others: &[String],
) -> Text {
    say(format!(
        "The tail of `{dimension}` counts up to {reach:.0} sigma, and the model was evaluated up to {farthest:.1}. Its curvature has {:.1} % of \
         the variance of `{characteristic}`.{} Skewness, kurtosis and yield depend on an extrapolation.",
        100.0 * share,
        likewise(others)
    ))
    .advise(Advice::UseMethod { methods: vec![Method::SixN, Method::SecondOrder] })
    .advise(Advice::Sample { points: None })
}

pub(super) fn infinite_moment(characteristic: &str, figure: &Figure, dimensions: &[String]) -> Text {
    let of = names(dimensions);
    let result = match figure {
        Figure::Sigma => "No figure follows from its moments; quantiles and rejects of samples do not need them.",
        _ => {
            "No distribution can be fitted to its moments; yield and quantiles are those of the surface, which need none."
        }
    };
    say(format!(
        "The {} of `{characteristic}` is infinite: with so few degrees of freedom the tail of {of} is too long for it. {result}",
        figure.name()
    ))
    .advise(Advice::Sample { points: None })
}

pub(super) fn pairs_not_examined(examined: &usize, possible: &usize) -> Text {
    say(format!(
        "{examined} of {possible} interactions were examined. The contribution of the others to sigma is unknown."
    ))
    .advise(Advice::UseMethod { methods: vec![Method::Full, Method::Auto] })
}
