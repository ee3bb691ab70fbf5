//! Solution side by side against the safeguarded search of every point alone.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::rows::RowSolution;
use super::{Anchor, Assembler, Condition, Conditions, Unknown};
use crate::assembly::formula::{Formula, FormulaSet, Meaning};

/// Assembly with its nominal state.
struct Assembly {
    set: FormulaSet,
    assembler: Assembler,
    anchor: Arc<Anchor>,
    nominal: Vec<f64>,
}

/// Text of an assembly: names with nominal or start values, and names with formulas.
#[derive(Default)]
struct Text {
    dimensions: Vec<(String, f64)>,
    unknowns: Vec<(String, f64)>,
    formulas: Vec<(String, String)>,
    equations: Vec<(String, String)>,
}

impl Text {
    fn new(dimensions: &[(&str, f64)], unknowns: &[(&str, f64)], equations: &[&str]) -> Self {
        let owned = |all: &[(&str, f64)]| all.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
        let named = |(index, text): (usize, &&str)| (format!("e{index}"), (*text).to_owned());
        Self {
            dimensions: owned(dimensions),
            unknowns: owned(unknowns),
            formulas: Vec::new(),
            equations: equations.iter().enumerate().map(named).collect(),
        }
    }

    fn assembly(&self) -> Assembly {
        let parsed = |text: &str| Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error:?}"));
        let unknowns = self.unknowns.iter().map(|(name, start)| {
            Unknown::new(name, *start, f64::NEG_INFINITY, f64::INFINITY).expect("within its bounds")
        });
        let conditions = self
            .equations
            .iter()
            .map(|(name, text)| Condition::Equation { name: name.clone(), formula: parsed(text) })
            .collect();
        let nominal: Vec<f64> = self.dimensions.iter().map(|(_, value)| *value).collect();
        let conditions = Conditions::new(unknowns.collect(), conditions, nominal.clone()).expect("balanced");
        let mut formulas: Vec<(String, Formula)> =
            self.formulas.iter().map(|(name, text)| (name.clone(), parsed(text))).collect();
        let first = formulas.len();
        formulas.extend(conditions.formulas());
        let names = self.dimensions.iter().chain(&self.unknowns).enumerate();
        let meanings = names.map(|(index, (name, _))| (name.as_str(), Meaning::Variable(index)));
        let set = FormulaSet::with_unnamed(formulas, first, meanings).expect("resolved");
        let assembler = Assembler::new(&conditions, &set, first, nominal.len());
        let anchor = assembler.anchor(&set, || Some(nominal.clone())).expect("sought").expect("assembled");
        Assembly { set, assembler, anchor, nominal }
    }
}

impl Assembly {
    fn together(&self, points: &[Vec<f64>]) -> RowSolution {
        let solver = (&self.assembler, &self.set);
        RowSolution::of(solver, &self.anchor, points.len(), self.nominal.len(), |index, row| points[row][index])
    }

    /// Returns a flag for each point that is solved side by side, without the safeguarded search.
    fn solved_at_once(&self, points: &[Vec<f64>]) -> Vec<bool> {
        let batch = self.assembler.batch(&self.set, &self.anchor).expect("solvable in blocks");
        let mut workspace = batch.workspace::<1>();
        let mut u = vec![0.0; self.assembler.len()];
        let solved = points.iter().map(|point| {
            batch.load(&mut workspace, 0, |index, _| point[index]);
            batch.solve(&self.assembler.system, &self.anchor, &mut workspace);
            batch.solution(&workspace, 0, &mut u)
        });
        solved.collect()
    }

    fn points(&self, rows: usize, spread: f64, seed: u64) -> Vec<Vec<f64>> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut point = || self.nominal.iter().map(|x| x + spread * random.random_range(-1.0..1.0)).collect();
        (0..rows).map(|_| point()).collect()
    }

    /// Holds that both ways agree to rounding, with the same failures. Returns the share of points that were solved at once.
    fn agrees(&self, points: &[Vec<f64>], what: &str) -> f64 {
        let together = self.together(points);
        for (row, point) in points.iter().enumerate() {
            match self.assembler.solve_safeguarded(&self.set, &self.anchor, point) {
                Ok(u) => {
                    assert_eq!(together.errors[row], None, "{what}: {point:?}");
                    for (unknown, &u) in u.iter().enumerate() {
                        let (other, scale) = (together.columns[unknown][row], self.anchor.scales.unknowns[unknown]);
                        let rounding = 1e-13 * scale.min(u.abs().max(1.0));
                        assert!((other - u).abs() <= rounding, "{what}: unknown {unknown} is {other}, alone {u}");
                    }
                }
                Err(failure) => assert_eq!(together.errors[row].as_deref(), Some(&failure), "{what}: {point:?}"),
            }
        }
        let solved = self.solved_at_once(points);
        solved.iter().filter(|&&solved| solved).count() as f64 / points.len() as f64
    }
}

/// Four-bar linkage with random bars, as two equations.
fn four_bar(seed: u64) -> Text {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut near = |value: f64| value * random.random_range(0.9..1.1);
    let dimensions = [("a", near(40.0)), ("b", near(120.0)), ("c", near(80.0)), ("d", near(100.0)), ("t", near(1.05))];
    let (x, y) = ("a*cos(t) + b*cos(p) - c*cos(q) - d", "a*sin(t) + b*sin(p) - c*sin(q)");
    Text::new(&dimensions, &[("p", 0.4), ("q", 1.5)], &[x, y])
}

/// Bodies in sequence: every body has a place and an angle, held at its predecessor by three contacts.
fn sequence(bodies: usize, seed: u64) -> Text {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut text = Text::default();
    for body in 0..bodies {
        let before = |name: &str| if body == 0 { "0".to_owned() } else { format!("{name}{}", body - 1) };
        let (x, y, r) = (before("x"), before("y"), before("r"));
        let place = (body + 1) as f64;
        text.unknowns.extend([(format!("x{body}"), 10.0 * place), (format!("y{body}"), 5.0 * place)]);
        text.unknowns.push((format!("r{body}"), 0.0));
        for contact in 0..3 {
            text.dimensions.push((format!("g{body}_{contact}"), random.random_range(-0.05..0.05)));
        }
        text.formulas.push((format!("c{body}"), format!("cos(r{body})")));
        text.formulas.push((format!("s{body}"), format!("sin(r{body})")));
        let equations = [
            format!("x{body} - ({x}) - 10*cos({r}) - 0.1*sin(2*r{body}) - g{body}_0"),
            format!("y{body} - 4*s{body} - ({y}) - 5 - 3*sin({r}) - g{body}_1"),
            format!("y{body} + 5*s{body} + c{body} - 6 - ({y}) - 2*sin({r}) - g{body}_2"),
        ];
        // The order of the equations is not that of their solution.
        for (index, equation) in equations.into_iter().enumerate() {
            text.equations.insert(0, (format!("e{body}_{index}"), equation));
        }
    }
    text
}

/// Twelve unknowns in a ring, each of which needs the next.
fn ring(seed: u64) -> Text {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut text = Text::default();
    for index in 0..12 {
        let (next, far) = ((index + 1) % 12, (index + 5) % 12);
        text.unknowns.push((format!("u{index}"), 1.0));
        text.dimensions.push((format!("d{index}"), random.random_range(0.9..1.1)));
        let equation = format!("u{index}^2 + 0.5*sin(u{next}) + 0.3*exp(-u{far}) - 1.5*d{index}");
        text.equations.push((format!("e{index}"), equation));
    }
    text
}

#[test]
fn side_by_side_is_what_every_point_is_alone() {
    for seed in 0..6 {
        for (text, what) in [(four_bar(seed), "four-bar"), (sequence(4, seed), "sequence"), (ring(seed), "ring")] {
            let assembly = text.assembly();
            let share = assembly.agrees(&assembly.points(70, 0.02, seed), what);
            assert!(share > 0.95, "{what}: {share} at once");
        }
    }
}

/// A point has the same bits alone, in the last places of a group, and among points that fail.
#[test]
fn neighbours_do_not_matter() {
    for text in [four_bar(7), sequence(3, 7), ring(7)] {
        let assembly = text.assembly();
        let mut points = assembly.points(150, 0.05, 7);
        // Some of them have no solution, no value, or the nominal one.
        for (row, value) in [(3, 1e3), (40, f64::NAN), (90, -1e3)] {
            points[row][0] = value;
        }
        points[60] = assembly.nominal.clone();
        let bits = |found: &RowSolution, row: usize| -> Vec<u64> {
            found.columns.iter().map(|column| column[row].to_bits()).collect()
        };
        let all = assembly.together(&points);
        for size in [1, 7, 64, 97] {
            for (group, rows) in points.chunks(size).enumerate() {
                let found = assembly.together(rows);
                for row in 0..rows.len() {
                    assert_eq!(bits(&found, row), bits(&all, group * size + row));
                    assert_eq!(found.errors[row], all.errors[group * size + row]);
                }
            }
        }
        assert!(all.columns[0][40].is_nan() && all.errors[40].is_none());
    }
}

/// Points without a solution, on another branch, or far away have the results of the safeguarded search.
#[test]
fn what_is_hard_is_left_to_the_safeguarded_search() {
    let cubic = Text::new(&[("x", 0.0)], &[("u", -1.7)], &["u^3 - 3*u - x"]).assembly();
    let points: Vec<Vec<f64>> = (0..160).map(|row| vec![0.25 * f64::from(row) - 15.0]).collect();
    let share = cubic.agrees(&points, "cubic");
    assert!(share > 0.0 && share < 1.0, "{share}");
    let linkage = four_bar(1).assembly();
    let share = linkage.agrees(&linkage.points(60, 30.0, 3), "long bars");
    assert!(share < 1.0, "{share}");
    let root = Text::new(&[("x", 1.0)], &[("u", 1.0)], &["u - sqrt(x)"]).assembly();
    assert_eq!(root.agrees(&[vec![-1.0], vec![-2.0]], "root"), 0.0);
}

/// A start on a kink has no derivative, so that the safeguarded search decides.
#[test]
fn a_start_on_a_kink_is_left_to_the_safeguarded_search() {
    for kink in ["abs(u - y) + (u - y)", "min(0, y - u)", "max(0, u - y)", "if(u < y, 0, u - y)"] {
        let text = Text::new(&[("x", 1.0), ("y", 3.0)], &[("u", 1.0)], &[&format!("u + 0.1*({kink}) - x")]);
        let assembly = text.assembly();
        assert_eq!(assembly.anchor.slopes[(0, 1)], 0.0, "{kink}");
        // The kink lies where the prediction is.
        let predicted = assembly.anchor.u[0] + assembly.anchor.slopes[(0, 0)] * 0.25;
        let points = [vec![1.25, 3.0], vec![1.25, predicted]];
        assembly.agrees(&points, kink);
        assert_eq!(assembly.solved_at_once(&points), [true, false], "{kink}");
    }
    let still = Text::new(&[("x", 0.0)], &[("u", 0.0)], &["u + 0.1*abs(u) - x"]).assembly();
    still.agrees(&[vec![0.2], vec![-0.2], vec![1e-9]], "at the kink of the nominal state");
}

/// An unknown that an equation uses in steps only has no derivative there.
#[test]
fn steps_wait_for_their_unknown() {
    let text = Text::new(
        &[("x", 1.3), ("y", 2.0)],
        &[("u", 1.3), ("v", 1.0)],
        &["v^2 + 0.1*floor(u) - y", "u^2 + 0.2*u - x^2 - 0.2*x"],
    );
    let assembly = text.assembly();
    let share = assembly.agrees(&assembly.points(60, 0.2, 4), "steps");
    assert!(share > 0.9, "{share}");
    let singular = Text::new(&[("x", 1.3)], &[("u", 1.3), ("v", 1.3)], &["u - x", "v - u^2"]).assembly();
    assert_eq!(singular.agrees(&singular.points(20, 0.2, 4), "two linear equations"), 1.0);
}

/// Pins in holes, each of which is carried by the one before. All clearances are 0 at the nominal sizes, so that no slope predicts the floats.
#[test]
fn floats_without_nominal_clearance_are_solved_at_once() {
    let mut text = Text::default();
    for pin in 0..4 {
        let before = if pin == 0 { "0".to_owned() } else { format!("u{}", pin - 1) };
        text.unknowns.push((format!("u{pin}"), 0.0));
        text.dimensions.extend([(format!("D{pin}"), 20.0), (format!("d{pin}"), 20.0), (format!("f{pin}"), 0.0)]);
        let float = format!("f{pin}*max(0, D{pin} - d{pin})/2");
        text.equations.push((format!("e{pin}"), format!("sin(u{pin} - {before}) - 0.1*({float})")));
    }
    let assembly = text.assembly();
    let points = assembly.points(200, 0.3, 11);
    assert_eq!(assembly.agrees(&points, "floats"), 1.0);
    // The angles add up in closed form.
    let found = assembly.together(&points);
    for (row, point) in points.iter().enumerate() {
        let angle =
            |pin: usize| (0.1 * point[3 * pin + 2] * (point[3 * pin] - point[3 * pin + 1]).max(0.0) / 2.0).asin();
        let sum: f64 = (0..4).map(angle).sum();
        assert!((found.columns[3][row] - sum).abs() < 1e-14, "{sum}");
    }
}

/// Roots that move by kinks, two of them near each other: a root that is accepted is that of the nominal branch.
#[test]
fn a_near_root_without_a_prediction_is_on_the_nominal_branch() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(29);
    let mut solved = 0;
    for seed in 0..400 {
        let mut apart = || {
            let distance = 10f64.powf(random.random_range(-2.5..0.0));
            if random.random_bool(0.5) { distance } else { -distance }
        };
        let (second, third) = (1.0 + apart(), if seed % 2 == 0 { 1.4 } else { 0.6 });
        let first = "(u - 1 - max(0, x) + 0.5*abs(y))";
        let text = format!("{first}*(u - {second} - 0.7*max(0, y) + abs(z))*(u - {third} + max(x, z))");
        let assembly = Text::new(&[("x", 0.0), ("y", 0.0), ("z", 0.0)], &[("u", 1.0)], &[&text]).assembly();
        let points = assembly.points(40, 0.1, seed);
        let found = assembly.together(&points);
        for (row, at_once) in assembly.solved_at_once(&points).into_iter().enumerate() {
            let (x, y, z) = (points[row][0], points[row][1], points[row][2]);
            let root = 1.0 + x.max(0.0) - 0.5 * y.abs();
            // Roots that have passed each other leave the branch undefined.
            let others = [second + 0.7 * y.max(0.0) - z.abs(), third - x.max(z)];
            let passed = (others[0] > root) != (second > 1.0) || (others[1] > root) != (third > 1.0);
            if at_once && !passed {
                solved += 1;
                assert!((found.columns[0][row] - root).abs() < 1e-7, "{text}: {} for {root}", found.columns[0][row]);
            }
        }
    }
    assert!(solved > 2000, "{solved}");
}
