//! Summary with one line for every characteristic: moments, Cpk, yield and verdict.

use crate::document::number::{estimated_beside, index, known, yielded};
use crate::document::rejects::Rejects;
use crate::document::{Cell, Columns, DataTable, Line, Value};
use crate::figures::Named;
use crate::reject_rate::yield_text;
use crate::requirement::loud;
use sensitol::rare::RareCharacteristic;
use sensitol::simulation::SimulatedCharacteristic;
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::verdict::{Judged, worst};

/// Printed in place of a yield without limits.
pub(crate) const NO_LIMITS: &str = "no limits";
/// Printed in place of a verdict if there are limits but nothing is required.
pub(crate) const NO_TARGET: &str = "no target";

/// Line of a characteristic, as text.
pub(super) struct OverviewLine<'r> {
    name: &'r str,
    unit: Option<&'r str>,
    mean: String,
    sigma: String,
    cpk: Option<f64>,
    /// None without limits.
    yield_: Option<String>,
    verdict: Line,
}

impl<'r> OverviewLine<'r> {
    /// Summary of a simulation, with the digits that its standard errors support.
    pub(super) fn sampled(one: &'r SimulatedCharacteristic) -> Self {
        let sigma = one.sigma.map(|of| of.value);
        let text =
            |of: Option<Estimate>, error| known(of.map(|of| of.value), |value| estimated_beside(value, sigma, error));
        let [of_mean, of_sigma] = one.errors();
        Self {
            name: one.name(),
            unit: one.unit(),
            mean: text(one.mean, of_mean),
            sigma: text(one.sigma, of_sigma),
            cpk: one.cpk,
            yield_: one.limited().then(|| {
                let rejects = Rejects::new(one.below, one.above, one.yield_error()).within(one.reject_intervals);
                known(one.yield_.map(|share| share.value), |share| {
                    rejects.with_error().unwrap_or_else(|| yielded(share))
                })
            }),
            verdict: verdict(&one.requirements()),
        }
    }

    /// Summary of rare events: the yield with its interval.
    pub(super) fn sought(one: &'r RareCharacteristic) -> Self {
        let interval = one.yield_interval.map(|ends| ends.map(yielded));
        let interval = interval.map_or_else(String::new, |[low, high]| format!(", {low} to {high}"));
        Self {
            name: one.name(),
            unit: one.unit(),
            mean: String::new(),
            sigma: String::new(),
            cpk: None,
            yield_: one.limited().then(|| known(one.yield_, |_| format!("{}{interval}", yield_text(one)))),
            verdict: verdict(&one.requirements()),
        }
    }
}

/// Returns the worst verdict of all requirements, empty if there is none.
pub(super) fn verdict(judged: &[Judged]) -> Line {
    worst(judged.iter().map(|one| one.verdict)).map_or_else(Line::default, loud)
}

/// Cell of a verdict, which states that a characteristic with limits has no target.
pub(crate) fn verdict_cell(verdict: Line, limited: bool) -> Cell {
    match verdict.text().is_empty() && limited {
        true => Cell::both(Value::Empty, NO_TARGET),
        false => Cell::both(Value::Empty, verdict),
    }
}

/// Table for terminals. Pages show the verdict and its gauges instead.
pub(super) fn table<'r>(all: impl IntoIterator<Item = OverviewLine<'r>>) -> DataTable {
    let all: Vec<OverviewLine<'_>> = all.into_iter().collect();
    let any = |of: fn(&OverviewLine<'_>) -> bool| all.iter().any(of);
    let (moments, cpk) = (any(|one| !one.mean.is_empty()), any(|one| one.cpk.is_some()));
    let (limited, judged) = (any(|one| one.yield_.is_some()), any(|one| !one.verdict.text().is_empty()));
    // Values without a number keep figures right-aligned.
    let figure = |text: &str| Cell::both(Value::Number(None), text);
    Columns::default()
        .terminal(true, "", |one: &&OverviewLine<'_>| Cell::name(one.name))
        .terminal(moments, "mean", move |one| figure(&one.mean))
        .terminal(moments, "sigma", move |one| figure(&one.sigma))
        .terminal(moments, "", |one| Cell::optional(one.unit))
        .terminal(cpk, "Cpk", |one| Cell::known(one.cpk, index))
        .terminal(limited, "yield", |one| Cell::text(one.yield_.as_deref().unwrap_or(NO_LIMITS)))
        .terminal(judged, "verdict", |one| verdict_cell(one.verdict.clone(), one.yield_.is_some()))
        .table("", &all)
}
