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

/// Parts of the figures of a characteristic that stages add to.
const PARTS: [&str; 6] = ["distribution", "evidence", "range", "contributions", "missing", "linear"];

/// Assignments into the figures of a characteristic, as `name.evidence.law =`, line by line.
fn assignments(code: &str) -> Vec<String> {
    let written = |line: &str| {
        PARTS.iter().any(|part| {
            line.split(&format!(".{part}.")).skip(1).any(|rest| {
                let rest = rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_' || c == '.').trim_start();
                let rest = rest.trim_start_matches(['+', '-']);
                rest.starts_with('=') && !rest.starts_with("==") && !rest.starts_with("=>")
            })
        })
    };
    code.lines().filter(|line| written(line)).map(|line| line.trim().to_owned()).collect()
}

#[test]
fn no_stage_writes_into_an_earlier_result() {
    for file in sources().into_iter().filter(|file| ["engine", "report", "cli"].contains(&file.package.as_str())) {
        let code = file.code();
        for form in [
            "&mut CharacteristicAnalysis",
            "&mut [CharacteristicAnalysis]",
            "&mut Vec<CharacteristicAnalysis>",
            "&mut Analysis",
        ] {
            assert!(!code.contains(form), "{} takes {form}: return a value to result/stage_figures.rs", file.name());
        }
        // The conclusion builds the allocation from the end of the search.
        let builds = file.name() == "src/allocation/search/conclusion.rs";
        assert!(builds || !code.contains("&mut Allocation"), "{} takes &mut Allocation", file.name());
        // The shortened list of a report replaces its remainder.
        if file.name().starts_with("src/analysis/") && file.name() != "src/analysis/interaction_truncation.rs" {
            let found = assignments(&code);
            assert!(found.is_empty(), "{} writes {found:?}: return a value to result/stage_figures.rs", file.name());
        }
    }
}

#[test]
fn the_check_of_assignments_sees_every_form() {
    assert_eq!(assignments("one.evidence.law = Some(law);").len(), 1);
    assert_eq!(assignments("    one.missing.without_value += 1;").len(), 1);
    assert_eq!(assignments("characteristics[c].distribution.conditional = found;").len(), 1);
    assert_eq!(assignments("let same = one.evidence.law == other; if a.range.bounds.is_none() {}"), [""; 0]);
    assert_eq!(assignments("let of = one.evidence.sampled.clone();"), [""; 0]);
}
