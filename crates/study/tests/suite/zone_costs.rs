//! Costs of zones in space: allocations against Lagrange's conditions, the study written anew, and wrong costs.

use sensitol::allocation::{Allocation, AllocationOptions, CostBasis, Status, allocate, allocate_written};
use sensitol::analyze;
use sensitol::assembly::Run;
use sensitol_study::Study;
/// Relative difference.
fn relative(a: f64, b: f64) -> f64 {
    (a - b).abs() / b.abs()
}

/// Text of a block on a table, with a rod in its bore whose tip is 100 mm from the middle of the bore. Three sigma of the height of the tip are at
/// most 0.3 mm.
fn text(bore: &str, sizes: &str, costs: &str) -> String {
    format!(
        r#"
[dimensions]
t = {{ nominal = 30, tolerance = 0.1, unit = "mm" }}
{sizes}
[parts.table]
top = {{ plane = [0, 0, 0], normal = "z" }}
[parts.block]
foot = {{ plane = [0, 0, 0], normal = "-z", x = "x" }}
bore = {{ axis = [0, 0, "t"], along = "x", {bore} }} # reamed
[parts.rod]
at = [0, 0, 30]
pin = {{ axis = [0, 0, 0], along = "x" }}
tip = {{ point = [100, 0, 0] }}
[joints]
seat = {{ on = "table.top", against = "block.foot", takes = 3 }}
fit = {{ hole = "block.bore", pin = "rod.pin", takes = 4 }}
[characteristics]
height = {{ of = "rod.tip", from = "table.top", unit = "mm", lower = 29.7, upper = 30.3, target_cpk = 1.0 }}
[costs]
{costs}
"#
    )
}

fn read(text: &str) -> Study {
    Study::from_toml(text, "study.toml").unwrap()
}

fn allocated(study: &Study) -> Allocation {
    allocate(&study.problem, &study.allocation_task(), &AllocationOptions::default()).unwrap()
}

/// Tolerances after, by the names that a report shows.
fn tolerances(study: &Study, found: &Allocation) -> Vec<(String, f64)> {
    let name = |d: usize| study.problem.dimensions()[d].name().to_owned();
    let of = |row: &sensitol::allocation::Allocated| {
        (row.zone.as_ref().map_or_else(|| name(row.dimension), |zone| zone.name.clone()), row.after)
    };
    found.tolerances.iter().map(of).collect()
}

fn sigma(study: &Study) -> f64 {
    analyze(&study.problem, &study.options).unwrap().characteristics[0].moments.unwrap().sigma()
}

/// Least cost of `sum b/T` under `sum s^2 T^2 = total`, by Lagrange's condition.
fn lagrange(terms: &[(f64, f64)], total: f64) -> Vec<f64> {
    let proportions: Vec<f64> = terms.iter().map(|(b, s)| (b / (s * s)).cbrt()).collect();
    let used: f64 = proportions.iter().zip(terms).map(|(t, (_, s))| (s * t).powi(2)).sum();
    proportions.iter().map(|t| (total / used).sqrt() * t).collect()
}

/// Holds that nine variances by hand use the room of 0.3 mm, but for the error that the analysis states: 0.2 % of sigma.
fn uses_the_room(total: f64) {
    assert!(total <= 0.09 * (1.0 + 1e-6) && total > 0.09 * (1.0 - 4e-3), "{total}");
}

fn after(rows: &[(String, f64)], name: &str) -> f64 {
    rows.iter().find(|row| row.0 == name).unwrap_or_else(|| panic!("{name}: {rows:?}")).1
}

/// Both ends of the bore are within a circle of diameter 2a. The tip feels them by 4.5 and 3.5, so that s is the root of 32.5. The derivatives of
/// the solver are exact, and the rounds end at a relative change of 1e-7.
#[test]
fn a_zone_with_a_length_is_one_tolerance() {
    let costs = "t = { model = \"reciprocal\", b = 0.1, min = 0.001, max = 1 }\n\"block.bore.position\" = { model = \"reciprocal\", b = 0.4, min = 0.001, max = 1 }";
    let study = read(&text("length = 25, position = 0.1", "", costs));
    let found = allocated(&study);
    let rows = tolerances(&study, &found);
    assert_eq!(rows.iter().map(|row| row.0.as_str()).collect::<Vec<_>>(), ["t", "block.bore.position"]);
    let total = rows[0].1.powi(2) + 32.5 * rows[1].1.powi(2);
    uses_the_room(total);
    let expected = lagrange(&[(0.1, 1.0), (0.4, 32.5f64.sqrt())], total);
    for ((name, after), expected) in rows.iter().zip(&expected) {
        assert!(relative(*after, *expected) < 1e-5, "{name}: {after}, {expected}");
    }
    let before = found.tolerances[1].before;
    assert!(relative(before, 0.05) < 1e-12, "half the zone: {before}");
    let cost = 0.1 / expected[0] + 0.4 / expected[1];
    assert!(relative(found.cost_after.unwrap(), cost) < 1e-5);
}

/// The new width stands in the feature, with its comment, and an analysis gives the sigma of the allocation. Six digits are written.
#[test]
fn the_new_width_stands_in_the_feature() {
    let costs = "t = { model = \"reciprocal\", b = 0.1, min = 0.001, max = 1 }\n\"block.bore\" = { model = \"reciprocal\", b = 0.4, min = 0.001, max = 1 }";
    for (bore, with) in [
        ("length = 25, position = 0.1", "length = 25, position = "),
        ("length = 25, position = { zone = 0.1, distribution = \"uniform\" }", "length = 25, position = { zone = "),
    ] {
        let study = read(&text(bore, "", costs));
        let found = allocated(&study);
        let anew = study.rewritten(&found.problem).unwrap();
        assert!(
            anew.text.contains(with) && anew.text.contains("# reamed") && !anew.text.contains(bore),
            "{}",
            anew.text
        );
        assert!(anew.entries.contains("[parts.block]\nbore = { axis"), "{}", anew.entries);
        let again = read(&anew.text);
        let wanted = found.after.as_ref().unwrap().characteristics[0].moments.unwrap().sigma();
        let written = sigma(&again);
        assert!(relative(written, wanted) < 2e-5 && written <= wanted, "{written}, {wanted}");
    }
}

/// The bonus of a bore follows its size. With b the bonus, of mean m and sigma s, the place has the variance `((z + m)^2 + s^2)/36`. The least cost
/// is found by a search over z alone. The relative tolerance is that of slopes by differences, 2e-5, times the flatness of the optimum.
#[test]
fn a_bonus_keeps_its_size_when_the_zone_changes() {
    let costs = "t = { model = \"reciprocal\", b = 0.1, min = 0.001, max = 1 }\n\"block.bore\" = { model = \"reciprocal\", b = 0.02, min = 0.001, max = 1 }";
    let size = "D = { limits = [10.0, 10.2], unit = \"mm\" }";
    let study = read(&text("position = { zone = 0.1, hole = \"D\", at = \"MMC\" }", size, costs));
    let found = allocated(&study);
    let rows = tolerances(&study, &found);
    let (m, s) = (0.1, 0.1 / 3.0);
    let widened = |z: f64| ((z + m) * (z + m) + s * s) / 4.0;
    let total = after(&rows, "t").powi(2) + widened(2.0 * after(&rows, "block.bore"));
    uses_the_room(total);
    let cost = |z: f64| 0.1 / (total - widened(z)).sqrt() + 0.02 / (0.5 * z);
    let (mut low, mut high) = (0.002, 0.49);
    for _ in 0..200 {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if cost(a) < cost(b) { high = b } else { low = a }
    }
    assert!(relative(found.cost_after.unwrap(), cost(low)) < 1e-7, "{rows:?}, {}", cost(low));
    assert!(relative(after(&rows, "block.bore"), 0.5 * low) < 1e-3, "{rows:?} for {low}");
    let again = read(&study.rewritten(&found.problem).unwrap().text);
    let wanted = found.after.as_ref().unwrap().characteristics[0].moments.unwrap().sigma();
    assert!(relative(sigma(&again), wanted) < 2e-5, "{}, {wanted}", sigma(&again));
}

/// Middle and tilt are independent: the tip feels half the position by 1 and half the perpendicularity by 8. Alone the perpendicularity would be
/// the wider of the two, so that both are equal.
#[test]
fn an_orientation_never_exceeds_its_location() {
    let costs = |tight: f64| {
        format!(
            "\"block.bore.position\" = {{ model = \"reciprocal\", b = 0.001, min = 0.001, max = 1 }}\n\"block.bore.perpendicularity\" = {{ model = \"reciprocal\", b = {tight}, min = 0.001, max = 1 }}"
        )
    };
    let bore = "length = 25, position = 0.1, perpendicularity = 0.02";
    for (dear, is_tied) in [(10.0, true), (0.01, false)] {
        let study = read(&text(bore, "", &costs(dear)));
        let found = allocated(&study);
        let rows = tolerances(&study, &found);
        let [wide, tight] = ["block.bore.position", "block.bore.perpendicularity"].map(|name| after(&rows, name));
        let rest = wide * wide + 64.0 * tight * tight;
        // The thickness keeps its tolerance of 0.1.
        uses_the_room(rest + 0.01);
        let alone = lagrange(&[(0.001, 1.0), (dear, 8.0)], rest);
        assert_eq!(alone[1] > alone[0], is_tied);
        let both = (rest / 65.0).sqrt();
        let expected = if is_tied { [both, both] } else { [alone[0], alone[1]] };
        assert!(relative(wide, expected[0]) < 1e-5 && relative(tight, expected[1]) < 1e-5, "{rows:?}, {expected:?}");
        assert!(relative(found.cost_after.unwrap(), 0.001 / wide + dear / tight) < 1e-9);
        assert!(relative(found.cost_before.unwrap(), 0.001 / 0.05 + dear / 0.01) < 1e-9);
        assert!(!matches!(found.status, Status::Infeasible | Status::NoFeasiblePointFound), "{:?}", found.status);
        let anew = study.rewritten(&found.problem).unwrap();
        // Both zones stand in the one entry of the feature.
        assert_eq!(anew.entries.matches("bore = {").count(), 1, "{}", anew.entries);
        let again = read(&anew.text);
        let wanted = found.after.as_ref().unwrap().characteristics[0].moments.unwrap().sigma();
        assert!(relative(sigma(&again), wanted) < 2e-5);
    }
    // A location without a cost bounds its orientation.
    let study = read(&text(bore, "", "\"block.bore.perpendicularity\" = { model = \"reciprocal\", b = 1.0 }"));
    let rows = tolerances(&study, &allocated(&study));
    assert!(rows[0].1 <= 0.05 * (1.0 + 1e-9), "{rows:?}");
}

/// A uniform middle has what the tilt leaves of its zone, at any width.
#[test]
fn a_refined_uniform_zone_changes_with_its_width() {
    let bore = "length = 25, position = 0.1, perpendicularity = 0.02, distribution = \"uniform\"";
    let costs = "\"block.bore.position\" = { model = \"reciprocal\", b = 0.1 }\n\"block.bore.perpendicularity\" = { model = \"reciprocal\", b = 0.1 }";
    let [plain, priced] = [read(&text(bore, "", "")), read(&text(bore, "", costs))];
    assert!(relative(sigma(&plain), sigma(&priced)) < 1e-12);
    let found = allocated(&priced);
    let again = read(&priced.rewritten(&found.problem).unwrap().text);
    // The limits allow a sigma of 0.1. Derivatives do not follow the kink of the tilt, so that the search ends before it.
    assert!(sigma(&again) <= 0.1 && sigma(&again) > 0.085, "{}", sigma(&again));
}

/// Variance of the offset of the housing by hand, for half bands of both bores and half zones of bores and motor. The shaft is at 50 mm of 80
/// between the bores. A float of clearance c has the variance c^2/4 in one direction, and f7 leaves -20 to -41 um.
fn of_housing([bore1, bore2, first, second, motor]: [f64; 5]) -> f64 {
    let float = |bore: f64| {
        let (mean, spread) = (0.5 * (bore + 0.0305), 0.5 * (bore / 3.0).hypot(0.0105 / 3.0));
        (mean * mean + spread * spread) / 4.0
    };
    // The mean bonus is half of the tolerance of the bore.
    let widened = ((2.0 * second + bore2).powi(2) + (bore2 / 3.0).powi(2)) / 36.0;
    let [near, far] = [50.0 / 80.0, 30.0 / 80.0].map(|weight: f64| weight * weight);
    far * (first * first / 9.0 + float(bore1)) + near * (widened + float(bore2)) + motor * motor / 9.0
}

/// The example keeps Lagrange's condition by hand: the saving over the variance is the same for all tolerances within their bounds. Slopes by zones
/// with a bonus come from differences, with a truncation of 2e-5.
#[test]
fn the_housing_meets_lagranges_condition() {
    let study = Study::read(&sensitol_testing::repository("examples/housing-allocation/study.toml")).unwrap();
    let found = allocated(&study);
    let rows = tolerances(&study, &found);
    let names = ["D1", "D2", "housing.bore1", "housing.bore2", "housing.motor"];
    let after = names.map(|name| after(&rows, name));
    let [before, best] = [&found.before, found.after.as_ref().unwrap()]
        .map(|analysis| analysis.characteristics[0].moments.unwrap().sigma());
    // The bores turn the shaft by less than 1e-3, so that products are below 1e-6 of the offset.
    assert!(relative(before, of_housing([0.0105, 0.0105, 0.05, 0.05, 0.05]).sqrt()) < 1e-5);
    assert!(relative(best, of_housing(after).sqrt()) < 1e-5);
    let multiplier = |at: usize, b: f64| {
        let moved = |by: f64| {
            let mut all = after;
            all[at] += by;
            of_housing(all)
        };
        b / (after[at] * after[at]) / ((moved(1e-6) - moved(-1e-6)) / 2e-6)
    };
    let [own, rest @ ..] = [(4, 0.15), (1, 0.02), (2, 0.1), (3, 0.1)].map(|(at, b)| multiplier(at, b));
    for other in rest {
        assert!(relative(other, own) < 1e-4, "{own} {rest:?} at {after:?}");
    }
    // The first bore would open farther: it is at its greatest tolerance.
    assert!(after[0] == 0.02 && multiplier(0, 0.02) > own);
}

/// Study of two bores on one part: the middle of the first and its parallelism over 40 mm have costs.
fn bores(zones: &str, limit: f64, costs: &str) -> String {
    format!(
        r#"
[dimensions]
h = {{ nominal = 50, tolerance = 0.02, unit = "mm" }}
w = {{ nominal = 80, tolerance = 0.02, unit = "mm" }}
[parts.p]
A = {{ plane = [0, 0, 0], normal = "-z" }}
b1 = {{ axis = [0, 0, "h"], along = "x", {zones}, length = 40, datums = "A" }}
b2 = {{ axis = ["w", 0, "h"], along = "x", position = 0.1 }}
m = {{ frame = [0, 0, "h"], z = "z", x = "x" }}
[parts.q]
at = [0, 0, 50]
m = {{ frame = [0, 0, 0], z = "z", x = "x" }}
t = {{ point = [100, 0, 0] }}
[joints]
j = {{ rigid = ["p.m", "q.m"] }}
[characteristics]
d = {{ of = "p.b2", from = "p.b1", along = "y", unit = "mm", lower = -{limit}, upper = {limit}, target_cpk = 1.0 }}
[costs]
{costs}
"#
    )
}

/// Least cost by hand: three sigma of the height of the second bore above the first are the root of `16 Tpar^2 + Tpos^2 + 0.05^2`. All choices that
/// keep the limit and the refinement are enumerated; a free parallelism is as wide as the limit and the position allow.
fn least_cost(limit: f64, position: &[(f64, f64)], parallelism: &dyn Fn(f64) -> Option<f64>) -> f64 {
    let of = |&(wide, cost): &(f64, f64)| {
        let room = limit * limit - wide * wide - 0.05 * 0.05;
        let most = wide.min((room.max(0.0) / 16.0).sqrt());
        parallelism(most).map_or(f64::INFINITY, |other| cost + other)
    };
    position.iter().map(of).fold(f64::INFINITY, f64::min)
}

/// The cheapest pair of processes that keeps the refinement need not hold the process of the cheapest pair without it. A list costs what is
/// written, and the free tolerance has the relative error of the limit by slopes, 1e-6.
#[test]
fn processes_of_refined_zones_are_chosen_together() {
    let position = |tight: f64| [(0.02, tight), (0.04, 1.0)];
    let of_position = |tight: f64| {
        format!(
            "\"p.b1.position\" = {{ processes = [{{ name = \"g\", tolerance = 0.02, cost = {tight} }}, {{ name = \"m\", tolerance = 0.04, cost = 1.0 }}] }}\n"
        )
    };
    let three = [(0.015, 9.0), (0.03, 2.5), (0.05, 1.0)];
    for (own, tight, limit) in [(&three[..], 2.0, 0.20857), (&three[1..], 2.0, 0.20857), (&three[..], 2.0, 0.1)] {
        let names = ["g", "m", "n"];
        let list: Vec<String> = (own.iter().zip(&names[3 - own.len()..]))
            .map(|((t, cost), name)| format!("{{ name = \"{name}\", tolerance = {t}, cost = {cost} }}"))
            .collect();
        let costs = of_position(tight) + &format!("\"p.b1.parallelism\" = {{ processes = [{}] }}", list.join(", "));
        let study = read(&bores("position = 0.1, parallelism = 0.05", limit, &costs));
        let found = allocated(&study);
        let cheapest = |most: f64| own.iter().filter(|(t, _)| *t <= most).map(|(_, cost)| *cost).reduce(f64::min);
        let expected = least_cost(limit, &position(tight), &cheapest);
        assert!(expected.is_finite());
        let rows = tolerances(&study, &found);
        let [wide, narrow] = ["p.b1.position", "p.b1.parallelism"].map(|name| after(&rows, name));
        assert!(narrow <= wide * (1.0 + 1e-9), "{rows:?}");
        assert!(relative(found.cost_after.unwrap(), expected) < 1e-12, "{:?}, {expected}", found.cost_after);
        // The search proves no bound of all pairs: it found the cheapest, and does not call it proven.
        assert!(matches!(found.status, Status::Optimal | Status::AlmostOptimal), "{:?}", found.status);
        study.rewritten(&found.problem).unwrap();
    }
    for (tight, most) in [(1.2, 0.06), (1.2, 0.03)] {
        let costs = of_position(tight)
            + &format!("\"p.b1.parallelism\" = {{ model = \"reciprocal\", a = 1.0, b = 1, max = {most} }}");
        let study = read(&bores("position = 0.1, parallelism = 0.05", 0.20857, &costs));
        let found = allocated(&study);
        let expected = least_cost(0.20857, &position(tight), &|t| Some(1.0 + 1.0 / t.min(most)));
        assert!(relative(found.cost_after.unwrap(), expected) < 1e-6, "{:?}, {expected}", found.cost_after);
        assert!(matches!(found.status, Status::Optimal | Status::AlmostOptimal), "{:?}", found.status);
    }
}

/// No pair of processes keeps the refinement.
#[test]
fn processes_that_break_every_refinement_are_refused() {
    let costs = "\"p.b1.position\" = { processes = [{ name = \"g\", tolerance = 0.02, cost = 2 }] }\n\"p.b1.parallelism\" = { processes = [{ name = \"m\", tolerance = 0.03, cost = 2.5 }, { name = \"n\", tolerance = 0.05, cost = 1.0 }] }";
    let study = read(&bores("position = 0.1, parallelism = 0.05", 0.5, costs));
    let error = allocate(&study.problem, &study.allocation_task(), &AllocationOptions::default()).unwrap_err();
    let expected = "every cost of `p.b1.parallelism` is for 0.03 or more, and of `p.b1.position`, which it refines, for 0.02 or less";
    assert!(error.to_string().contains(expected), "{error}");
}

/// The limit is so wide that every table ends at the zone without a cost. The allowance is that of rounding.
#[test]
fn a_zone_without_a_cost_bounds_a_table() {
    let allocate = |costs: &str| {
        let study = read(&bores("position = 0.1, parallelism = 0.05", 2.0, costs));
        tolerances(&study, &allocated(&study))
    };
    let rows = allocate("\"p.b1.parallelism\" = { table = [[0.01, 5], [0.05, 3], [0.2, 2]] }");
    assert!(relative(after(&rows, "p.b1.parallelism"), 0.05) < 1e-6, "{rows:?}");
    let rows = allocate("\"p.b1.parallelism\" = { table = [[0.01, 5], [0.04, 3]] }");
    assert!(relative(after(&rows, "p.b1.parallelism"), 0.04) < 1e-6, "{rows:?}");
    // Three sigma are the root of 0.0125 + Tpos^2, with Tpos of at least 0.025.
    for (limit, keeps) in [(0.1130, false), (0.1150, true)] {
        let costs = "\"p.b1.position\" = { table = [[0.001, 5], [0.1, 2]] }";
        let found = allocated(&read(&bores("position = 0.1, parallelism = 0.05", limit, costs)));
        let kept = !matches!(found.status, Status::Infeasible | Status::NoFeasiblePointFound);
        assert_eq!(kept, keeps, "{limit}: {:?}", found.status);
    }
}

/// The farthest hole is at 50 mm from the middle of the pattern, whatever the height at which the holes begin. The zone turns the holes by half its
/// width over 50 mm and the root of 2.
#[test]
fn a_height_along_the_axes_of_a_pattern_is_no_lever() {
    let holes = |height: &str| {
        let hole = |name: &str, x: f64| {
            format!("{name} = {{ axis = [{x:?}, 0, {height}], along = \"z\", x = \"x\" }}\n[parts.p.patterns]\n")
        };
        let second = hole("h2", 80.0);
        let first = hole("h1", -20.0).replace("[parts.p.patterns]\n", "");
        bores("position = 0.1", 0.5, "\"p.bolts.position\" = { model = \"reciprocal\", b = 1 }").replace(
            "[parts.q]",
            &format!("{first}{second}bolts = {{ of = [\"h1\", \"h2\"], position = 0.2 }}\n[parts.q]"),
        )
    };
    let [plain, formula] = ["50", "\"h\""].map(|height| {
        let text = holes(height).replace("of = \"p.b2\", from = \"p.b1\"", "of = \"p.h2\", from = \"p.b1\"");
        let study = read(&text);
        let dimensions = study.problem.dimensions();
        let turn = dimensions.iter().find(|one| one.name() == "p.bolts.tilt").map(|one| one.half_band());
        turn.expect("a turn of the pattern")
    });
    assert!(relative(plain, 0.1 / 50.0 / 2f64.sqrt()) < 1e-12 && plain == formula, "{plain}, {formula}");
}

/// Relative costs: a zone is one tolerance with one cost, and the place of a pin in its hole has none.
#[test]
fn relative_costs_are_of_zones_and_not_of_floats() {
    let text = text(
        "diameter = \"D\", length = 25, position = 0.1",
        "D = { nominal = 20, tolerance = [0, 0.02], unit = \"mm\" }",
        "",
    );
    let text = text.replace(
        "pin = { axis = [0, 0, 0], along = \"x\" }",
        "pin = { axis = [0, 0, 0], along = \"x\", diameter = 19.98 }",
    );
    let study = read(&text.replace("takes = 4", "takes = 4, float = \"disc\"").replace("[costs]", ""));
    let name = |d: usize| study.problem.dimensions()[d].name().to_owned();
    let task = study.allocation_task().relative(&study.problem, CostBasis::ToleranceUnit);
    let groups: Vec<Vec<String>> =
        task.priced.iter().map(|group| group.members.iter().map(|&d| name(d)).collect()).collect();

    assert_eq!(groups[0].len(), 4, "{groups:?}");
    assert!(groups[0].iter().all(|name| name.starts_with("block.bore.")), "{groups:?}");
    let single: Vec<&str> = groups[1..].iter().map(|group| group[0].as_str()).collect();
    assert_eq!(single, ["t", "D"]);
    // The new width stands in the feature.
    let (options, written) =
        (AllocationOptions::default(), |problem: &sensitol::Problem| study.written_dimensions(problem));
    let found = allocate_written(&study.problem, &task, &options, &Run::to_the_end(), &written).unwrap();
    let zone = found.tolerances.iter().find(|row| row.zone.is_some()).unwrap();
    assert_eq!(zone.zone.as_ref().unwrap().name, "block.bore.position");
    let again = read(&study.rewritten(&found.problem).unwrap().text);
    for (new, old) in again.problem.dimensions().iter().zip(found.problem.dimensions()) {
        assert!(relative(new.half_band().max(1e-300), old.half_band().max(1e-300)) < 1e-5, "{}", new.name());
    }
}

/// Holds that every study is refused at its line of `[costs]`, with the words of what is wrong and of the remedy.
fn refuses(cases: &[(&str, String, &str, &str)]) {
    for (bore, costs, what, remedy) in cases {
        let text = text(bore, "w = { nominal = 0.1, tolerance = 0.01, unit = \"mm\" }", costs);
        let text = if bore.contains("w\"") { text } else { text.replace("w = { nominal", "# { nominal") };
        let error = Study::from_toml(&text, "study.toml").unwrap_err().to_string();
        assert!(error.contains(remedy) && (*what == "write" || error.contains(what)), "{costs}\n{error}");
        assert!(error.contains("costs."), "{error}");
    }
}

#[test]
fn wrong_costs_name_the_line_and_the_remedy() {
    let zone = |name: &str| format!("\"{name}\" = {{ model = \"reciprocal\", b = 0.1 }}");
    let both = "length = 25, position = 0.1, perpendicularity = 0.02";
    let cases = [
        (both, zone("block.bore"), "write", "name one of them: \"block.bore.position\""),
        ("length = 25", zone("block.bore"), "has a cost and no zone", "give `block.bore` a zone"),
        ("position = 0.1", zone("block.bore.runout"), "has no `runout`", "write \"block.bore.position\""),
        ("roundness = 0.1", zone("block.bore"), "moves nothing", "leave the cost out"),
        ("position = 0", zone("block.bore"), "the width 0", "write the present width"),
        (
            "length = \"10*w\", perpendicularity = 0.02",
            zone("block.bore"),
            "a length or a place that its width is divided by is a formula",
            "write the length of the feature",
        ),
        ("position = \"w\"", zone("block.bore"), "its width is a formula", "give the cost to the dimension"),
        (
            "position = 0.1",
            zone("block.bore") + "\n" + &zone("block.bore.position"),
            "has two costs",
            "keep one of them",
        ),
        (
            "position = 0.1",
            zone("block.bore") + "\n" + &zone("block.bore.at"),
            "`block.bore.at` has two costs, and `block.bore` is the first",
            "keep one of them",
        ),
        (
            "length = 25, perpendicularity = 0.1",
            "\"block.bore\" = { model = \"reciprocal\", b = 0.1, grades = [\"IT5\", \"IT9\"] }".to_owned(),
            "`grades` means nothing for a position",
            "has no size: write step or a free tolerance",
        ),
    ];
    refuses(&cases);
}

#[test]
fn costs_beyond_a_refinement_and_idle_keys_are_refused() {
    let zone = |name: &str| format!("\"{name}\" = {{ model = \"reciprocal\", b = 0.1 }}");
    let both = "length = 25, position = 0.1, perpendicularity = 0.02";
    let cases = [
        (
            both,
            "\"block.bore.perpendicularity\" = { model = \"reciprocal\", b = 0.1, max = 0.06 }".to_owned(),
            "max = 0.06 lets `perpendicularity` exceed `position` (half width 0.05)",
            "write max = 0.05",
        ),
        (
            both,
            "\"block.bore.position\" = { model = \"reciprocal\", b = 0.1, min = 0.005 }".to_owned(),
            "min = 0.005 lets `perpendicularity` (half width 0.01) exceed `position`",
            "write min = 0.01",
        ),
        (
            both,
            "\"block.bore.perpendicularity\" = { table = [[0.06, 3], [0.2, 2]] }".to_owned(),
            "every point of the table, the nearest at 0.06, lets `perpendicularity` exceed `position`",
            "write a point of at most 0.05",
        ),
        (
            both,
            "\"block.bore.perpendicularity\" = { processes = [{ name = \"m\", tolerance = 0.04, cost = 2 }, { name = \"n\", tolerance = 0.06, cost = 1 }] }".to_owned(),
            "the process `n` of 0.06 lets `perpendicularity` exceed `position` (half width 0.05)",
            "leave it out",
        ),
        (
            both,
            "\"block.bore.position\" = { processes = [{ name = \"m\", tolerance = 0.004, cost = 2 }] }".to_owned(),
            "the process `m` of 0.004 lets `perpendicularity` (half width 0.01) exceed `position`",
            "leave it out",
        ),
        ("position = 0.1", zone("block.bore").replace(" }", ", within = \"nonsense\" }"), "nonsense", "zone with a cost"),
        (
            both,
            zone("block.bore.position") + "\n" + &zone("block.bore.perpendicularity").replace(" }", ", within = \"t\" }"),
            "`within` means nothing for",
            "the feature gives it: leave it out",
        ),
        (
            "position = 0.1",
            zone("block.bore").replace(" }", ", fixed_side = \"lower\" }"),
            "`fixed_side` means nothing for",
            "leave it out",
        ),
        (
            "position = 0.1",
            zone("block.bore").replace(" }", ", unit = \"mm\" }"),
            "`unit` means nothing for",
            "the feature gives it: leave it out",
        ),
        (
            both,
            zone("block.bore.perpendiculrity"),
            "has no `perpendiculrity`",
            "write \"block.bore.perpendicularity\"",
        ),
        ("position = 0.1", zone("block.hole"), "block.hole", "block.bore"),
    ];
    refuses(&cases);
}
