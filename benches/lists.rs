//! Lists of processes under additive rows: milliseconds of every generated problem, a line each, the median of five; `benches/run` sets them
//! beside HiGHS.

#[path = "../tests/allocation/generated_lists.rs"]
mod generated_lists;

use std::time::Instant;

use generated_lists::lists;
use sensitol::allocation::choice::knapsack::cheapest;
use serde_json::Value;

fn main() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/allocation-lists.json");
    let text = std::fs::read_to_string(path).expect("the generated problems");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    for of in all["problems"].as_array().expect("a list of problems") {
        let lists = lists(of);
        let mut times = [0.0; 5].map(|_: f64| {
            let begun = Instant::now();
            let found = cheapest(&lists, &|| false).expect("a choice");
            assert!(found.bound > found.cost * (1.0 - 1e-9), "not closed: {of}");
            1e3 * begun.elapsed().as_secs_f64()
        });
        times.sort_by(f64::total_cmp);
        println!("{} {:.3}", of["seed"], times[2]);
    }
}
