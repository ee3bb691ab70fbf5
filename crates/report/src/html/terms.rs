//! Terms of a page, for paper too.

use std::fmt::Write;

use crate::html::part::Part;

/// Commands whose pages use a term: all.
const ALL: &[&str] = &["analyze", "simulate", "compare", "sweep", "allocate"];
/// Commands that use a surface.
const SURFACE: &[&str] = &["analyze", "sweep", "allocate"];
/// Commands that draw points of the model.
const POINTS: &[&str] = &["simulate", "compare"];

/// Terms, their meaning, and the commands whose pages list them.
const TERMS: [(&str, &str, &[&str]); 16] = [
    ("Yield", "Share of the assemblies that lie within the limits.", ALL),
    ("Rejects", "Assemblies outside a limit, per million.", ALL),
    (
        "95 % interval",
        "Holds the true value in 95 of 100 repetitions. A target within it is neither met nor missed.",
        ALL,
    ),
    (
        "Cpk",
        "Distance from the mean to the nearer limit, in units of three sigma. It says nothing about the shape of the distribution.",
        &["analyze", "simulate", "allocate"],
    ),
    ("Standard error", "Standard deviation that an estimate would have over many samples of this size.", POINTS),
    (
        "Most likely",
        "The assembly at a limit that comes about most often, in standard deviations off the means.",
        &["rare"],
    ),
    ("Reference", "Points of the model itself, by which every method is measured.", &["compare"]),
    ("Sigma", "Standard deviation.", &["compare", "sweep"]),
    ("Surface law", "Distribution of the fitted second-order surface with the inputs' own distributions.", SURFACE),
    (
        "Pearson fit",
        "Distribution of the Pearson system with the computed mean, sigma, skewness and kurtosis.",
        &["analyze", "simulate", "sweep", "allocate"],
    ),
    (
        "Quantile",
        "The value below which a share of the assemblies lies; 0.135 % and 99.865 % are three sigma of a normal distribution.",
        &["analyze", "simulate", "sweep"],
    ),
    (
        "Share",
        "Part of the variance that a dimension makes alone. Shares, interactions and what is not resolved add up to 100 %.",
        &["analyze", "allocate"],
    ),
    (
        "Interaction",
        "Part of the variance that two dimensions make jointly, beyond the sum of their own.",
        &["analyze"],
    ),
    (
        "Worst case",
        "Least and greatest value over the whole box of tolerances. Proven: no assembly lies beyond. Linear: by slopes alone.",
        &["analyze", "allocate"],
    ),
    ("RSS", "Root of the sum of squares of slope times half tolerance.", SURFACE),
    ("Room", "What the limits leave: 100 % are used where a range reaches from the middle to a limit.", &["allocate"]),
];

/// Writes the section of the terms for the page of a command.
pub(super) fn terms(command: &str, rare: bool) -> String {
    let has = |all: &&[&str]| match rare {
        true => all.contains(&"rare") || *all == ALL,
        false => all.contains(&command),
    };
    let mut text = "<dl class=\"terms\">\n".to_owned();
    for (term, meaning, _) in TERMS.iter().filter(|(.., all)| has(all)) {
        let _ = writeln!(text, "<div><dt>{term}</dt><dd>{meaning}</dd></div>");
    }
    Part::new("terms", "Terms", text + "</dl>\n").folded()
}
