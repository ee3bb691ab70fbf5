//! Processes with a distribution of their own: the choice is compared with every choice, each written as a study of its own and analysed.

use sensitol::allocation::{Allocation, AllocationOptions, Status, allocate};
use sensitol::{Verdict, analyze};
use sensitol_study::Study;

/// Name, half-width, cost, and keys for the distribution of its parts.
type Process = (&'static str, f64, f64, &'static str);

const DIMENSIONS: [(&str, f64, [Process; 3]); 3] = [
    (
        "a",
        10.0,
        [
            ("grind", 0.03, 9.0, "cp = 1.6"),
            ("turn", 0.05, 5.25, "cp = 1.2, cpk = 0.9, side = \"+\""),
            ("saw", 0.09, 2.0, "distribution = \"uniform\""),
        ],
    ),
    (
        "b",
        6.0,
        [
            ("mill", 0.04, 6.125, "cp = 1.3"),
            ("plane", 0.04, 4.0, "distribution = \"uniform\""),
            ("cast", 0.10, 1.0, "cp = 1.0, cpk = 0.8"),
        ],
    ),
    (
        "c",
        3.0,
        [
            ("lap", 0.02, 7.0, "cp = 1.0, drift = 0.004"),
            ("bore", 0.06, 3.5, "cp = 2.0"),
            // Looser and more expensive, but with a mean nearer to the middle than the one above.
            ("ream", 0.07, 4.0625, "cp = 2.5"),
        ],
    ),
];

fn characteristic(formula: &str, rest: &str) -> String {
    format!("[characteristics]\ngap = {{ formula = \"{formula}\", {rest} }}\n")
}

/// Returns a study of dimensions that are uniform by themselves. The processes replace this distribution.
fn study(formula: &str, rest: &str) -> Study {
    let mut text = String::from("[dimensions]\n");
    for (name, nominal, _) in DIMENSIONS {
        text += &format!("{name} = {{ nominal = {nominal}, tolerance = 0.05, distribution = \"uniform\" }}\n");
    }
    text += &characteristic(formula, rest);
    text += "[costs]\n";
    for (name, _, processes) in DIMENSIONS {
        let of = |(process, half, cost, own): &Process| {
            format!("{{ name = \"{process}\", tolerance = {half}, cost = {cost}, {own} }}")
        };
        text += &format!("{name} = {{ processes = [{}] }}\n", processes.iter().map(of).collect::<Vec<_>>().join(", "));
    }
    Study::from_toml(&text, "study.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// True if a study meets the requirements of its characteristic, by an analysis of its own.
fn keeps(study: &Study) -> bool {
    let found = analyze(&study.problem, &study.options).unwrap();
    found.characteristics[0].requirements().iter().all(|one| one.verdict == Verdict::Met)
}

/// Returns the least cost of a choice that meets the requirements, and its processes. The 27 choices are written and analysed from the
/// cheapest on. No two of them have the same cost.
fn cheapest(formula: &str, rest: &str) -> Option<(f64, Vec<&'static str>)> {
    let choice = |code: usize| -> (f64, Vec<Process>) {
        let picks = [code % 3, code / 3 % 3, code / 9];
        let chosen: Vec<Process> = DIMENSIONS.iter().zip(picks).map(|((.., all), pick)| all[pick]).collect();
        (chosen.iter().map(|(_, _, cost, _)| cost).sum(), chosen)
    };
    let mut all: Vec<(f64, Vec<Process>)> = (0..27).map(choice).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(all.windows(2).all(|pair| pair[0].0 < pair[1].0));
    for (cost, chosen) in all {
        let mut text = String::from("[dimensions]\n");
        for ((name, nominal, _), (_, half, _, own)) in DIMENSIONS.iter().zip(&chosen) {
            text += &format!("{name} = {{ nominal = {nominal}, tolerance = {half}, {own} }}\n");
        }
        text += &characteristic(formula, rest);
        let study = Study::from_toml(&text, "study.toml").unwrap();
        if keeps(&study) {
            return Some((cost, chosen.iter().map(|(name, ..)| *name).collect()));
        }
    }
    None
}

fn found(study: &Study) -> Allocation {
    let options = AllocationOptions::default().with_analysis(study.options.clone());
    allocate(&study.problem, &study.allocation_task(), &options).unwrap()
}

fn processes(found: &Allocation) -> Vec<String> {
    found.tolerances.iter().map(|one| one.process.clone().unwrap_or_default()).collect()
}

/// Costs are sums of sixteenths, so that equal costs are equal doubles.
#[test]
fn the_choice_is_the_cheapest_of_all() {
    let limits = "lower = 0.86, upper = 1.14";
    let sum = "a - b - c";
    for (formula, rest, word) in [
        // Variances add up: a knapsack problem.
        (sum, "require = { sigma = 0.03 }".to_owned(), Some(Status::Optimal)),
        // Bands add up for every distribution within them.
        (sum, format!("{limits}, require = \"worst-case\""), Some(Status::Optimal)),
        (sum, format!("{limits}, require = \"rss\""), Some(Status::Optimal)),
        // Means move, and distributions differ.
        (sum, format!("{limits}, require = {{ cpk = 1.5 }}"), Some(Status::Optimal)),
        (sum, format!("{limits}, require = {{ yield = 0.9995 }}"), Some(Status::Optimal)),
        (sum, "lower = 0.88, upper = 1.10, require = { yield = 0.99 }".to_owned(), Some(Status::Optimal)),
        // The surface changes with the tolerances.
        ("a*b/6 - c - 6", format!("{limits}, require = {{ cpk = 1.0 }}"), None),
        ("a*b/6 - c - 6", format!("{limits}, require = {{ yield = 0.999 }}"), None),
    ] {
        let (cost, names) = cheapest(formula, &rest).unwrap_or_else(|| panic!("{rest}: nothing keeps it"));
        let study = study(formula, &rest);
        let found = found(&study);
        assert_eq!(found.cost_after, Some(cost), "{formula}, {rest}: {:?} for {names:?}", processes(&found));
        assert_eq!(processes(&found), names, "{formula}, {rest}");
        assert!(word.is_none_or(|word| found.status == word), "{formula}, {rest}: {:?}", found.status);
        // At least one tolerance is not the tightest, or the case would be trivial.
        assert!(names != ["grind", "mill", "lap"], "{formula}, {rest}");
        // The written study meets the requirement too, and contains the distribution of the process.
        let written = study.rewritten(&found.problem).unwrap().text;
        let again = Study::from_toml(&written, "study.toml").unwrap();
        assert!(keeps(&again), "{formula}, {rest}:\n{written}");
        let of = |study: &Study| {
            let all = study.problem.dimensions().iter();
            all.map(|one| [one.mean(), one.sigma(), one.half_band()]).collect::<Vec<_>>()
        };
        let wanted: Vec<[f64; 3]> =
            found.problem.dimensions().iter().map(|one| [one.mean(), one.sigma(), one.half_band()]).collect();
        for (a, b) in of(&again).iter().flatten().zip(wanted.iter().flatten()) {
            // Tolerances of two digits are written without rounding.
            assert!((a - b).abs() < 1e-12 * b.abs().max(1.0), "{a} for {b}:\n{written}");
        }
        // A second allocation from there makes the same choice.
        assert_eq!(processes(&self::found(&again)), names, "{formula}, {rest}, again");
    }
}

/// A requirement that no choice meets is reported as infeasible, as proven by an exact surface and by all choices.
#[test]
fn what_no_choice_keeps_is_infeasible() {
    let rest = "require = { sigma = 0.008 }";
    assert!(cheapest("a - b - c", rest).is_none());
    assert_eq!(found(&study("a - b - c", rest)).status, Status::Infeasible);
}

/// Many lists under a sum of variances have the least cost of a dynamic program over the variances in whole units. It is exact for
/// tolerances whose variances are whole.
#[test]
fn many_lists_are_a_knapsack() {
    let n = 14;
    // Variances of options in whole units of 1e-6, with half-widths of any size.
    let option = |d: usize, i: usize| {
        let variance = ((i + 1) * (i + 1) * 7 + (d * 5 + i * 3) % 11) as f64;
        let cost = 60.0 / (1.0 + i as f64) + ((d * 7 + i) % 5) as f64;
        (variance, cost)
    };
    let most = 700usize;
    let mut text = String::from("[dimensions]\n");
    let (mut costs, mut formula) = (String::from("[costs]\n"), String::from("0"));
    for d in 0..n {
        text += &format!("x{d} = {{ nominal = 5, tolerance = 0.02 }}\n");
        formula += &format!(" {} x{d}", if d % 2 == 0 { "+" } else { "-" });
        let of = |i: usize| {
            let (variance, cost) = option(d, i);
            let cp = 0.8 + 0.2 * ((d + i) % 4) as f64;
            let half = 3.0 * cp * 1e-3 * variance.sqrt();
            format!("{{ name = \"p{i}\", tolerance = {half}, cost = {cost}, cp = {cp} }}")
        };
        costs += &format!("x{d} = {{ processes = [{}] }}\n", (0..4).map(of).collect::<Vec<_>>().join(", "));
    }
    // A millionth above the whole number excludes effects of rounding.
    let sigma = 1e-3 * (most as f64 + 1e-3).sqrt();
    text += &format!("[characteristics]\ny = {{ formula = \"{formula}\", require = {{ sigma = {sigma} }} }}\n{costs}");
    let study = Study::from_toml(&text, "study.toml").unwrap_or_else(|error| panic!("{error}"));
    let mut least = vec![f64::INFINITY; most + 1];
    least[0] = 0.0;
    for d in 0..n {
        let mut next = vec![f64::INFINITY; most + 1];
        for (used, &cost) in least.iter().enumerate().filter(|(_, cost)| cost.is_finite()) {
            for (variance, own) in (0..4).map(|i| option(d, i)) {
                let now = used + variance as usize;
                if now <= most {
                    next[now] = next[now].min(cost + own);
                }
            }
        }
        least = next;
    }
    let expected = least.into_iter().fold(f64::INFINITY, f64::min);
    let found = found(&study);
    assert_eq!(found.status, Status::Optimal, "{:?}", found.proof);
    // Both sides are sums of fourteen costs in different order.
    assert!((found.cost_after.unwrap() - expected).abs() < 1e-9, "{:?} for {expected}", found.cost_after);
}

/// A line of `[processes]` can describe a process once for all lists.
#[test]
fn a_process_may_be_named() {
    let text = |own: &str| {
        format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.1 }}\n\
             [processes]\nturning = {{ cp = 1.2, cpk = 0.9, side = \"+\" }}\n\
             [characteristics]\ny = {{ formula = \"a\", lower = 0.8, upper = 1.2, require = {{ cpk = 1.0 }} }}\n\
             [costs]\na = {{ processes = [{{ name = \"turn\", tolerance = 0.1, cost = 2.0, {own} }}, {{ name = \"grind\", tolerance = 0.02, cost = 9.0, cp = 1.0 }}] }}\n"
        )
    };
    let named = Study::from_toml(&text("process = \"turning\""), "study.toml").unwrap();
    let spelled = Study::from_toml(&text("cp = 1.2, cpk = 0.9, side = \"+\""), "study.toml").unwrap();
    let [named_found, spelled_found] = [&named, &spelled].map(found);
    assert_eq!(processes(&named_found), ["turn"]);
    assert_eq!(named_found.cost_after, spelled_found.cost_after);
    let written = named.rewritten(&named_found.problem).unwrap().text;
    assert!(written.contains("a = { nominal = 1, tolerance = 0.1, process = \"turning\" }"), "{written}");
}

/// Every fault is reported with its place and the correct form.
#[test]
fn faults_are_told_at_their_place() {
    let text = |dimension: &str, processes: &str| {
        format!(
            "[dimensions]\n{dimension}\n[characteristics]\ny = {{ formula = \"a\", lower = 0.8, upper = 1.2, require = \"rss\" }}\n\
             [costs]\na = {{ processes = [{processes}] }}\n"
        )
    };
    let good = "a = { nominal = 1, tolerance = 0.1 }";
    let grind = "{ name = \"grind\", tolerance = 0.02, cost = 9.0, cp = 1.3 }";
    for (dimension, processes, said) in [
        (
            good,
            format!("{grind}, {{ name = \"turn\", tolerance = 0.1, cost = 2.0 }}"),
            ["costs.a.processes[2]", "cp = 1.0"],
        ),
        (
            good,
            "{ name = \"turn\", model = \"reciprocal\", b = 1.0, min = 0.1, max = 0.2, cp = 1.3 }".to_owned(),
            ["costs.a.processes[1].cp", "one tolerance"],
        ),
        (
            good,
            "{ name = \"turn\", tolerance = 0.1, cost = 2.0, cp = 1.0, cpk = 1.3 }".to_owned(),
            ["costs.a.processes[1].cpk", "above cp"],
        ),
        (
            good,
            "{ name = \"turn\", tolerance = 0.1, cost = 2.0, cpk = 1.0, side = \"+\" }".to_owned(),
            ["costs.a.processes[1].side", "both"],
        ),
        (
            good,
            "{ name = \"turn\", tolerance = 0.1, cost = 2.0, distribution = \"unifrom\" }".to_owned(),
            ["costs.a.processes[1].distribution", "uniform"],
        ),
        (
            "a = { nominal = 1, sigma = 0.1 }",
            grind.to_owned(),
            ["costs.a.processes[1].cp", "give the dimension a tolerance"],
        ),
        (
            good,
            "{ name = \"turn\", tolerance = 0.1, cost = 2.0, process = \"x\" }".to_owned(),
            ["costs.a.processes[1].process", "[processes]"],
        ),
    ] {
        let refused = Study::from_toml(&text(dimension, &processes), "study.toml").map(|_| ()).unwrap_err().to_string();
        for part in said {
            assert!(refused.contains(part), "{refused}: {part}");
        }
    }
}
