//! Lists under additive rows. The least cost of generated problems is that of HiGHS (`tests/data/allocation-lists.json`), and that of small
//! ones is found over every choice.

use sensitol::allocation::choice::knapsack::cheapest;
use sensitol::allocation::choice::option_list::ListOption;
use serde_json::Value;

use super::generated_lists::{Numbers, lists};
use sensitol_testing::repository;

/// Costs agree to 1e-9, the accuracy to which HiGHS keeps rows.
#[test]
fn least_costs_are_those_of_highs() {
    let text = std::fs::read_to_string(repository("tests/data/allocation-lists.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let problems = all["problems"].as_array().unwrap();
    assert_eq!(problems.len(), 40);
    for of in problems {
        let lists = lists(of);
        let found = cheapest(&lists, &|| false).unwrap();
        let expected = of["cost"].as_f64().unwrap();
        assert!((found.cost / expected - 1.0).abs() < 1e-9, "{of}: {}", found.cost);
        assert!(found.bound <= found.cost && found.bound > found.cost * (1.0 - 1e-9), "{of}: {}", found.bound);
        let picked = || lists.iter().zip(&found.places).map(|(list, &place)| &list[place]);
        for r in 0..lists[0][0].uses.len() {
            let used: f64 = picked().map(|one| one.uses[r]).sum();
            assert!(used <= 1.0 + 1e-12, "{of}: {used}");
        }
        let cost: f64 = picked().map(|one| one.cost).sum();
        assert!((cost / found.cost - 1.0).abs() < 1e-13);
    }
}

/// Every choice of small problems, some of which are infeasible.
#[test]
fn least_costs_are_those_of_all_choices() {
    let mut numbers = Numbers(77);
    let mut impossible = 0;
    for case in 0..300 {
        let (count, rows) = (2 + case % 4, case % 4);
        let lists: Vec<Vec<ListOption>> = (0..count)
            .map(|_| {
                let options = 1 + (4.0 * numbers.next()) as usize;
                (0..options)
                    .map(|place| {
                        // Few different values, so that some options and sums are equal.
                        let mut few = |most: f64| (most * numbers.next()).floor() / most;
                        let uses = (0..rows).map(|_| 2.6 * few(8.0) / count as f64).collect();
                        ListOption { cost: few(6.0), uses, place }
                    })
                    .collect()
            })
            .collect();
        let mut least: Option<f64> = None;
        let mut picks = vec![0; count];
        loop {
            let keeps = (0..rows)
                .all(|r| picks.iter().zip(&lists).map(|(&i, list)| list[i].uses[r]).sum::<f64>() <= 1.0 + 1e-13);
            let cost: f64 = picks.iter().zip(&lists).map(|(&i, list)| list[i].cost).sum();
            if keeps && least.is_none_or(|least| cost < least) {
                least = Some(cost);
            }
            let Some(j) = (0..count).find(|&j| picks[j] + 1 < lists[j].len()) else { break };
            picks[j] += 1;
            picks[..j].fill(0);
        }
        let found = cheapest(&lists, &|| false).map(|found| found.cost);
        impossible += usize::from(least.is_none());
        match (found, least) {
            (Some(found), Some(least)) => assert!((found - least).abs() < 1e-12, "case {case}: {found} for {least}"),
            (found, least) => assert_eq!(found, least, "case {case}"),
        }
    }
    assert!((10..250).contains(&impossible), "{impossible}");
}

/// A search that is stopped reports a bound of its distance from the optimum.
#[test]
fn a_stopped_search_has_a_bound() {
    let text = std::fs::read_to_string(repository("tests/data/allocation-lists.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let hardest = all["problems"].as_array().unwrap().last().unwrap();
    let found = cheapest(&lists(hardest), &|| true).unwrap();
    let least = hardest["cost"].as_f64().unwrap();
    assert!(found.bound <= least * (1.0 + 1e-9) && found.cost >= least * (1.0 - 1e-9), "{found:?} {least}");
}
