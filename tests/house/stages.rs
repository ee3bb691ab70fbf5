//! Stages of an analysis return values, and a kind of requirement stands in few files.

use super::sources::sources;

/// Files that name a kind of requirement: its definition, the constructors of a target yield, the words of reports, the keys of a study,
/// and the allocation's registry with the searches that serve one kind.
const KINDS_OF_REQUIREMENTS: [&str; 9] = [
    "src/allocation/requirement/constraint.rs",
    "src/allocation/requirement/registry.rs",
    "src/allocation/search/box_sample.rs",
    "src/allocation/search/cost_limit.rs",
    "crates/numeric/src/characteristic.rs",
    "crates/numeric/src/requirement.rs",
    "crates/numeric/src/verdict.rs",
    "crates/report/src/requirement.rs",
    "crates/study/src/build/costs.rs",
];

#[test]
fn a_kind_of_requirement_stands_in_few_files() {
    let kinds =
        ["Requirement::Yield", "Requirement::Cpk", "Requirement::Sigma", "Requirement::Rss", "Requirement::WorstCase"];
    for file in sources() {
        // A module of tests in a file of its own.
        if file.name() == "crates/report/src/completeness.rs" {
            continue;
        }
        let named = kinds.iter().find(|kind| file.code().contains(*kind));
        assert!(
            named.is_none() || KINDS_OF_REQUIREMENTS.contains(&file.name().as_str()),
            "{} names {}: ask the requirement in crates/numeric/src/requirement.rs",
            file.name(),
            named.unwrap(),
        );
    }
}
