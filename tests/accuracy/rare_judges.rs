//! Intervals of rare events for functions on which no constant of the search was chosen. Right values are closed forms
//! and quadratures.

use sensitol::rare::Beyond;
use sensitol_study::Study;

use super::rare_unmet::{Case, found, mean, tail};

/// Seeds of a coverage.
const SEEDS: u64 = 40;
/// Fewest of 40 intervals that must contain the right value: 95 %.
const HELD: usize = 38;

/// Chi-square probability beyond a radius for an even number of variables: a sum of Poisson's.
fn beyond_sphere(n: u32, radius: f64) -> f64 {
    let half = 0.5 * radius * radius;
    let mut term = (-half).exp();
    let mut sum = term;
    for i in 1..n / 2 {
        term *= half / f64::from(i);
        sum += term;
    }
    sum
}

/// Probability of `u > a` and `v > b` for standard normal variables of correlation `rho`, by the midpoint rule from `a` on.
fn both(a: f64, b: f64, rho: f64) -> f64 {
    const STEP: f64 = 1e-3;
    let density = |u: f64| (-0.5 * u * u).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let beyond = |u: f64| tail((b - rho * u) / (1.0 - rho * rho).sqrt());
    (0..10_000).map(|i| a + STEP * (f64::from(i) + 0.5)).map(|u| STEP * density(u) * beyond(u)).sum()
}

/// Mean over the sum of squares of six standard normal variables, by the trapezoidal rule over the radius.
fn over_six_squares(of: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1e-3;
    let density = |r: f64| r.powi(5) * (-0.5 * r * r).exp() / 8.0;
    (1..12_000).map(|i| STEP * f64::from(i)).map(|r| STEP * density(r) * of(r * r)).sum()
}

/// Half-spaces, alone, joined and across each other.
fn flat_judges() -> Vec<Case> {
    let rho = 0.5 / 2f64.sqrt();
    vec![
        Case { name: "plane-2", n: 2, function: |x| 3.0 * x[0] - 4.0 * x[1], limit: 5.0 * 4.2, truth: tail(4.2) },
        Case {
            name: "plane-12",
            n: 12,
            function: |x| x.iter().enumerate().map(|(j, x)| x * if j % 2 == 0 { 1.0 } else { -1.0 }).sum(),
            limit: 3.8 * 12f64.sqrt(),
            truth: tail(3.8),
        },
        Case {
            name: "three-half-spaces-12",
            n: 12,
            function: |x| {
                let part = |j: usize| 0.5 * (x[4 * j] - x[4 * j + 1] + x[4 * j + 2] + x[4 * j + 3]);
                (part(0) - 3.5).max(-part(1) - 3.7).max(part(2) - 4.0)
            },
            limit: 0.0,
            truth: 1.0 - (1.0 - tail(3.5)) * (1.0 - tail(3.7)) * (1.0 - tail(4.0)),
        },
        Case {
            name: "series-5",
            n: 5,
            // Their correlation is 1/(2 sqrt 2).
            function: |x| {
                let u = (x[0] + x[1]) * std::f64::consts::FRAC_1_SQRT_2;
                let v = 0.5 * (x[0] + x[2] + x[3] - x[4]);
                (u - 3.6).max(v - 3.4)
            },
            limit: 0.0,
            truth: tail(3.6) + tail(3.4) - both(3.6, 3.4, rho),
        },
        Case {
            name: "parallel-5",
            n: 5,
            function: |x| {
                let u = (x[0] + x[1]) * std::f64::consts::FRAC_1_SQRT_2;
                let v = 0.5 * (x[0] + x[2] + x[3] - x[4]);
                (u - 2.7).min(v - 2.5)
            },
            limit: 0.0,
            truth: both(2.7, 2.5, rho),
        },
        Case {
            name: "opposite-3",
            n: 3,
            function: |x| (x[0] + 0.5 * x[1] - 3.5 * 1.25f64.sqrt()).max(-x[0] - 0.5 * x[1] - 3.8 * 1.25f64.sqrt()),
            limit: 0.0,
            truth: tail(3.5) + tail(3.8),
        },
        Case {
            name: "four-corner-4",
            n: 4,
            function: |x| x.iter().copied().fold(f64::INFINITY, f64::min),
            limit: 1.3,
            truth: tail(1.3).powi(4),
        },
    ]
}

/// Limits that bend towards the means, away from them, and all around them.
fn bent_judges() -> Vec<Case> {
    vec![
        Case {
            name: "paraboloid-7",
            n: 7,
            function: |x| x[0] + 0.12 * x[1..].iter().map(|x| x * x).sum::<f64>(),
            limit: 5.2,
            truth: over_six_squares(|s| tail(5.2 - 0.12 * s)),
        },
        Case {
            name: "hollow-paraboloid-7",
            n: 7,
            function: |x| x[0] - 0.12 * x[1..].iter().map(|x| x * x).sum::<f64>(),
            limit: 3.1,
            truth: over_six_squares(|s| tail(3.1 + 0.12 * s)),
        },
        Case {
            name: "shell-2",
            n: 2,
            function: |x| -(x.iter().map(|x| x * x).sum::<f64>().sqrt() - 4.6).abs(),
            limit: -0.3,
            truth: beyond_sphere(2, 4.3) - beyond_sphere(2, 4.9),
        },
        Case {
            name: "shell-4",
            n: 4,
            function: |x| -(x.iter().map(|x| x * x).sum::<f64>().sqrt() - 5.2).abs(),
            limit: -0.3,
            truth: beyond_sphere(4, 4.9) - beyond_sphere(4, 5.5),
        },
    ]
}

/// Limits with a jump or a contact.
fn broken_judges() -> Vec<Case> {
    vec![
        Case {
            name: "shell-step-6",
            n: 6,
            function: |x| {
                let square = x.iter().map(|x| x * x).sum::<f64>();
                0.1 * x[0] + if square > 5.0 * 5.0 && square < 6.5 * 6.5 { 9.0 } else { 0.0 }
            },
            limit: 4.5,
            truth: beyond_sphere(6, 5.0) - beyond_sphere(6, 6.5),
        },
        Case {
            name: "sum-step-10",
            n: 10,
            function: |x| {
                let late = (x[7] + x[8]) * std::f64::consts::FRAC_1_SQRT_2 > 3.1;
                x[0] - x[1] + 0.2 * x[2] + if late { 15.0 } else { 0.0 }
            },
            limit: 6.5,
            truth: tail(3.1) * tail(-8.5 / 2.04f64.sqrt()) + (1.0 - tail(3.1)) * tail(6.5 / 2.04f64.sqrt()),
        },
        Case {
            name: "slab-3",
            n: 3,
            function: |x| x[0] + 0.2 * x[2] + if x[1] > 2.4 && x[1] < 2.9 { 8.0 } else { 0.0 },
            limit: 4.6,
            truth: {
                let slab = tail(2.4) - tail(2.9);
                slab * tail(-3.4 / 1.04f64.sqrt()) + (1.0 - slab) * tail(4.6 / 1.04f64.sqrt())
            },
        },
        Case {
            name: "wedge-contact-6",
            n: 6,
            // One edge of the contact is a sum of two variables, along no coordinate.
            function: |x| {
                let edge = (x[3] + x[4]) * std::f64::consts::FRAC_1_SQRT_2;
                0.3 * x[0] + 0.4 * x[1] + 3.0 * (edge.min(x[5]) - 1.5).max(0.0)
            },
            limit: 3.0,
            truth: mean(|u| if u < 6.0 { tail(1.5 + (3.0 - 0.5 * u) / 3.0).powi(2) } else { 1.0 }),
        },
    ]
}

/// Judge given by formulas, whose switches are known.
struct FormulaCase {
    formula: &'static str,
    limit: f64,
    truth: f64,
}

fn formula_judges() -> Vec<FormulaCase> {
    let slope = 0.41f64.sqrt();
    let (late, side) = (tail(4.2 / 2f64.sqrt()), 1.09f64.sqrt());
    vec![
        FormulaCase {
            formula: "0.5*a + 0.4*b + 2*max(0, min(c, d) - 1.9)",
            limit: 3.1,
            truth: mean(|u| if slope * u < 3.1 { tail(1.9 + 0.5 * (3.1 - slope * u)).powi(2) } else { 1.0 }),
        },
        FormulaCase {
            formula: "a - 0.3*b + if(c + d > 4.2, 5, 0)",
            limit: 5.2,
            truth: late * tail(0.2 / side) + (1.0 - late) * tail(5.2 / side),
        },
        FormulaCase {
            formula: "0.2*a - 0.1*b + if(c > 2.9, d, 0)",
            limit: 1.0,
            truth: tail(2.9) * tail(1.0 / 1.05f64.sqrt()) + (1.0 - tail(2.9)) * tail(1.0 / 0.05f64.sqrt()),
        },
    ]
}

impl FormulaCase {
    fn found(&self, samples: u64) -> Vec<(u64, Beyond)> {
        let dimension = |name: &str| format!("{name} = {{ nominal = 0, sigma = 1 }}\n");
        let dimensions: String = ["a", "b", "c", "d"].map(dimension).concat();
        let (formula, limit) = (self.formula, self.limit);
        let text = format!(
            "[dimensions]\n{dimensions}[characteristics]\ny = {{ formula = \"{formula}\", upper = {limit:?} }}\n"
        );
        found(&Study::from_toml(&text, "judge.toml").unwrap().problem, samples, SEEDS)
    }
}

fn judges() -> Vec<Case> {
    [flat_judges(), bent_judges(), broken_judges()].into_iter().flatten().collect()
}

/// Number of intervals that contain a value.
fn held(found: &[(u64, Beyond)], truth: f64) -> usize {
    found.iter().filter(|(_, above)| above.interval[0] <= truth && truth <= above.interval[1]).count()
}

/// Median of a figure of the results, relative to the right value.
fn median(found: &[(u64, Beyond)], truth: f64, figure: impl Fn(&Beyond) -> f64) -> f64 {
    let mut values: Vec<f64> = found.iter().map(|(_, above)| figure(above) / truth).collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Few points leave wide intervals, and none that are wrong.
#[test]
fn intervals_hold_whatever_the_limit_looks_like() {
    let mut poor = Vec::new();
    for samples in [400, 900, 2000] {
        for case in judges() {
            let held = held(&case.found(samples, SEEDS), case.truth);
            if held < HELD {
                poor.push((case.name, samples, held));
            }
        }
        for case in formula_judges() {
            let held = held(&case.found(samples), case.truth);
            if held < HELD {
                poor.push((case.formula, samples, held));
            }
        }
    }
    assert!(poor.is_empty(), "{poor:?}");
}

/// Median of the estimates at 10,000 points, the default: it is right to a twentieth.
#[test]
fn many_points_find_all_regions() {
    for case in judges() {
        let found = case.found(10_000, SEEDS);
        let value = median(&found, case.truth, |above| above.probability.unwrap_or(0.0));
        let held = held(&found, case.truth);
        assert!(held >= HELD && (value - 1.0).abs() < 0.05, "{}: {held} {value}", case.name);
    }
}

/// Caution costs little where the limit is easy: the bound of what no point met falls fast with the points. Fewer
/// points cannot exclude a corner of three dimensions as small as these rejects.
#[test]
fn easy_limits_keep_narrow_intervals() {
    let width = |above: &Beyond| above.interval[1] - above.interval[0];
    for (name, samples, most) in [
        ("plane-2", 900, 0.2),
        ("plane-2", 2000, 0.08),
        ("plane-2", 10_000, 0.03),
        ("plane-12", 2000, 0.3),
        ("plane-12", 10_000, 0.03),
        ("hollow-paraboloid-7", 2000, 0.12),
        ("paraboloid-7", 10_000, 0.1),
        ("series-5", 2000, 0.3),
        ("three-half-spaces-12", 10_000, 0.1),
        ("parallel-5", 10_000, 0.15),
    ] {
        let case = judges().into_iter().find(|case| case.name == name).unwrap();
        let width = median(&case.found(samples, SEEDS), case.truth, width);
        assert!(width < most, "{name} {samples}: {width}");
    }
}
