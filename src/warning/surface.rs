//! Warnings about the second-order surface.

use crate::method_kind::Method;
use crate::warning::text::{Text, likewise, names, number, part, places, say, significant};
use crate::warning::{Advice, Change, ContactShare, Figure};

pub(super) fn rss_invalid(characteristic: &str, mean_shift: &f64, variance: &f64) -> Text {
    say(format!(
        "`{characteristic}` is curved: second order moves its mean by {mean_shift:+.2} sigma and adds {:.1} % to its variance. Mean and sigma \
         of first order are wrong by that much.",
        100.0 * variance
    ))
    .advise(Advice::UseMethod { methods: vec![Method::SecondOrder] })
}

pub(super) fn higher_order(
    characteristic: &str,
    dimension: &str,
    [third, fourth]: &[f64; 2],
    held: &bool,
    others: &[String],
) -> Text {
    let text = say(format!(
        "`{characteristic}` is more than a parabola along `{dimension}`: {third:+.2e} u^3 {fourth:+.2e} u^4 sigma.{} {}",
        likewise(others),
        match held {
            true => "The moments include these powers. The error estimate covers higher ones.",
            false => "The method leaves these powers out.",
        }
    ));
    if *held { text } else { text.advise(Advice::UseMethod { methods: vec![Method::SixN, Method::Auto] }) }
}

pub(super) fn shallow_rules(characteristic: &str, share: &f64) -> Text {
    let methods = vec![Method::DimensionReduction, Method::BivariateDimensionReduction];
    say(format!(
        "Curvature adds {:.1} % of the variance of `{characteristic}`. Rules of three nodes do not integrate its third and fourth powers. \
         Skewness, kurtosis and yield are unreliable.",
        100.0 * share
    ))
    .advise(Advice::UseMethod { methods })
}

pub(super) fn poor_fit(characteristic: &str, residual: &f64) -> Text {
    say(format!(
        "The fitted surface misses the values of `{characteristic}` by {:.1} % of sigma (residual standard error). A quadratic does not \
         describe it, so the moments are unreliable.",
        100.0 * residual
    ))
    .advise(Advice::UseMethod { methods: vec![Method::SixN, Method::BivariateDimensionReduction] })
}

pub(super) fn kink(
    characteristic: &str,
    dimension: &str,
    [left, right]: &[f64; 2],
    between: &[f64; 2],
    others: &[String],
) -> Text {
    say(format!(
        "`{characteristic}` has a kink along `{dimension}` {}: its slope changes from {left:.3} to {right:.3} sigma per sigma.{} No polynomial \
         follows a kink, so the moments are wrong.",
        places(*between),
        likewise(others)
    ))
    .advise(Advice::Sample { points: None })
    .advise(Advice::SplitBranches)
}

pub(super) fn kink_at_nominal(characteristic: &str, dimensions: &[String]) -> Text {
    say(format!(
        "`{characteristic}` has a kink at the nominal point: along {} its slopes on both sides are equal and opposite. So are those of a \
         distance or an angle that is 0 there, the length of two smooth components. No polynomial follows a kink, so moments of derivatives \
         are wrong.",
        names(dimensions)
    ))
    .advise(Advice::ReturnComponents)
    .advise(Advice::Sample { points: None })
}

pub(super) fn choice_not_sampled(characteristic: &str, choice: &str) -> Text {
    say(format!(
        "No surface follows {choice}, and too few points of the model have a value after it. The figures of `{characteristic}` are unknown."
    ))
    .advise(Advice::Sample { points: None })
}

pub(super) fn discontinuity(
    characteristic: &str,
    dimension: &str,
    by: &f64,
    between: &[f64; 2],
    at: &Option<[f64; 2]>,
    others: &[String],
) -> Text {
    let at = at.map(|[from, to]| format!(" ({from} to {to})")).unwrap_or_default();
    say(format!(
        "`{characteristic}` jumps along `{dimension}` {}{at} by {by:.2} sigma.{} Derivatives mean nothing there, so the moments are wrong.",
        places(*between),
        likewise(others)
    ))
    .advise(Advice::CheckConfiguration)
    .advise(Advice::Sample { points: None })
}

pub(super) fn interactions_left_out(characteristic: &str, share: &f64) -> Text {
    say(format!(
        "{:.2} % of the variance of `{characteristic}` comes from terms that were not examined, by comparison with the model. Sigma includes \
         this part; skewness and kurtosis do not.",
        100.0 * share
    ))
    .advise(Advice::RaiseBudget)
    .advise(Advice::UseMethod { methods: vec![Method::Full] })
}

pub(super) fn untrusted_surrogate(characteristic: &str, share: &f64, sampled: &Option<u64>) -> Text {
    let text = |result: &str| {
        say(format!(
            "The surface through the evaluated points leaves {:.1} % of the variance of `{characteristic}` unexplained. {result}",
            100.0 * share
        ))
    };
    match sampled {
        Some(points) => text(&format!(
            "The moments come from {points} points of the model, with the surface as control variate, and carry standard errors."
        )),
        None => text("The moments are unreliable.").advise(Advice::RaiseBudget).advise(Advice::Sample { points: None }),
    }
}

pub(super) fn conditional_verdict(characteristics: &[String]) -> Text {
    say(format!(
        "The verdict on {} comes from the surface: it holds if the model follows the surface between the check points. A strict check accepts \
         proof and points of the model only.",
        names(characteristics)
    ))
    .advise(Advice::SampleRareEvents)
}

pub(super) fn far_residual(
    characteristic: &str,
    directions: &[(String, bool)],
    residual: &f64,
    from: &f64,
    share: &f64,
) -> Text {
    let side = |(name, up): &(String, bool)| format!("`{name}` is {}", if *up { "large" } else { "small" });
    let place = if directions.is_empty() {
        "many dimensions deviate at once".to_owned()
    } else {
        directions.iter().map(side).collect::<Vec<String>>().join(" and ")
    };
    let sense = if *residual > 0.0 { "above" } else { "below" };
    let held = match *from < 0.1 {
        true => "The difference begins near the means".to_owned(),
        false => format!(
            "The surface is taken to hold up to {from:.1} sigma in this direction; up to {} of the assemblies lie beyond",
            part(*share)
        ),
    };
    say(format!(
        "The model of `{characteristic}` is {} sigma {sense} its surface where {place}. {held}. The errors of all figures include it.",
        significant(residual.abs(), 3)
    ))
    .advise(Advice::SampleRareEvents)
}

pub(super) fn under_resolved(
    characteristic: &str,
    figure: &Figure,
    error: &Option<f64>,
    wanted: &f64,
    budget: &bool,
) -> Text {
    let shown = |value: f64| match figure {
        Figure::Sigma => format!("{:.2} %", 100.0 * value),
        Figure::Yield => format!("{:.2e} %", 100.0 * value),
        Figure::Skewness | Figure::Kurtosis => format!("{value:.2e}"),
    };
    let (name, wanted) = (figure.name(), shown(*wanted));
    let known = match error {
        Some(error) => format!(
            "The estimated error of the {name} of `{characteristic}` is {}, and {wanted} was wanted.",
            shown(*error)
        ),
        None => format!("The error of the {name} of `{characteristic}` is unknown, and {wanted} was wanted."),
    };
    let sample = Advice::Sample { points: None };
    match budget {
        true => say(format!("{known} The budget was spent before.")).advise(Advice::RaiseBudget).advise(sample),
        false => say(format!("{known} Further derivatives would not reduce it.")).advise(sample),
    }
}

pub(super) fn switch(
    characteristic: &str,
    switch: &str,
    change: &Change,
    probability: &f64,
    points: &Option<f64>,
) -> Text {
    if let Some(points) = points {
        let does = match change {
            Change::Kink => "bends",
            Change::Jump => "jumps",
            Change::Edge => "has no value beyond a limit",
        };
        let (beyond, points) = (part(*probability), significant(*points, 2));
        return say(format!(
            "`{characteristic}` {does} at {switch}, with {beyond} of the assemblies beyond: about {points} points of the sample."
        ));
    }
    let (does, means) = match change {
        Change::Kink => ("bends", "No polynomial follows a kink."),
        Change::Jump => ("jumps", "No polynomial follows a jump."),
        Change::Edge => ("has no value beyond a limit", "Every figure is of the assemblies that have a value."),
    };
    let text = say(format!(
        "`{characteristic}` {does} at {switch}, with {} of the assemblies beyond. {means}",
        part(*probability)
    ));
    if *change == Change::Edge { text } else { text.advise(Advice::Sample { points: None }) }
}

/// Greatest number of sets of contacts in a text; all are in the data.
const SETS: usize = 4;

pub(super) fn contact_switch(
    characteristic: &str,
    switch: &str,
    change: &Change,
    contacts: &[ContactShare],
    sampled: &bool,
) -> Text {
    let does = if *change == Change::Jump { "jumps" } else { "bends" };
    let mut met: Vec<&ContactShare> = contacts.iter().filter(|of| of.share > 0.0).collect();
    met.sort_by(|a, b| b.share.total_cmp(&a.share));
    let share = |of: &&ContactShare| {
        let (names, percent, error) = (of.contacts.join(", "), 100.0 * of.share, 100.0 * of.error);
        format!("In {percent:.1} % ± {error:.1} of the assemblies the part stands on {names}.")
    };
    let mut sets: Vec<String> = met.iter().take(SETS).map(share).collect();
    if met.len() > SETS {
        let rest: f64 = met[SETS..].iter().map(|of| of.share).sum();
        sets.push(format!("In {:.1} % it stands on one of {} other sets.", 100.0 * rest, met.len() - SETS));
    }
    let shown = format!("`{characteristic}` {does} where {switch} change. {}", sets.join(" "));
    if *sampled {
        return say(shown);
    }
    say(format!("{shown} Derivatives hold for one of these sets only.")).advise(Advice::Sample { points: None })
}

pub(super) fn pole(characteristic: &str, switch: &str, probability: &f64) -> Text {
    say(format!(
        "`{characteristic}` grows without bound at {switch}, with {} of the assemblies beyond. It has no moments. Those printed are of the \
         assemblies within eight sigma, and change with every sample.",
        part(*probability)
    ))
}

pub(super) fn figure_off(characteristic: &str, figure: &&'static str, value: &f64, model: &f64, error: &f64) -> Text {
    // Show at least two digits of the difference.
    let places = libm::log10(value.abs() / (value - model).abs()).ceil();
    let digits = if places.is_finite() { (places.max(3.0) as i32 + 2).min(15) } else { 5 };
    let [value, model, error] =
        [(value, digits), (model, digits), (error, 2)].map(|(of, digits)| significant(*of, digits));
    say(format!(
        "The {figure} of `{characteristic}` is {value} by the method, and {model} by the model itself, with an error of {error}."
    ))
    .advise(Advice::UseMethod { methods: vec![Method::Auto] })
}

pub(super) fn surface_law_refuted(
    characteristic: &str,
    test: &&'static str,
    limit: &f64,
    law: &f64,
    counted: &f64,
    error: &f64,
) -> Text {
    let fails = if *test == "monotone" { "has quantiles or shares that fall" } else { "contradicts points" };
    let [law, counted, error] = [law, counted, error].map(|share| ppm(*share));
    say(format!(
        "The surface law of `{characteristic}` {fails}: it has {law} ppm below {}, where {counted} ± {error} ppm of the points lie. Points take \
         its place for yield, quantiles and coverage intervals.",
        number(short(*limit))
    ))
    .advise(Advice::Sample { points: None })
}

/// Number rounded to six digits.
fn short(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// Parts per million without decimals.
fn ppm(share: f64) -> String {
    format!("{:.0}", 1e6 * share)
}
