//! Discrete distributions, with limits that equal possible values: counted with whole numbers.

use std::sync::Arc;

use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::distribution::{Distribution, Measured, Mixture, Normal, Part, TwoValues};

use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{Analysis, Characteristic, Closure, Dimension, Method, Options, Problem, SpecLimits, Verdict, analyze};
use sensitol_numeric::law::{LawOptions, LawTail, SurfaceLaw};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{Surrogate, Univariate};
use sensitol_study::Study;
use sensitol_study::StudyText;

use sensitol_testing::{Asked, data, relative, repository};

/// Study whose values are whole hundredths.
struct GridStudy {
    /// Values of every dimension, each with the same probability.
    values: Vec<Vec<i64>>,
    /// True for a dimension with two values about the nominal one, instead of a measured list.
    two: Vec<bool>,
    /// Coefficients and limits of every characteristic.
    characteristics: Vec<(Vec<i64>, i64, i64)>,
}

impl GridStudy {
    /// Draws two to six dimensions with two values or some measured ones, and two or three sums of them. The limits are possible values of
    /// the sums.
    fn drawn(random: &mut Xoshiro256PlusPlus) -> Self {
        let n = random.random_range(2..=6usize);
        let two: Vec<bool> = (0..n).map(|_| random.random()).collect();
        let values: Vec<Vec<i64>> = two
            .iter()
            .map(|&two| {
                let middle = random.random_range(100..2000i64);
                if two {
                    let half = random.random_range(1..30i64);
                    return vec![middle - half, middle + half];
                }
                // Five values at least, two of which differ.
                let count = random.random_range(3..6);
                let others = (0..count).map(|_| middle + random.random_range(-4..=4i64));
                [middle - 5, middle + 3].into_iter().chain(others).collect()
            })
            .collect();
        let mut study = Self { values, two, characteristics: Vec::new() };
        for _ in 0..random.random_range(2..=3) {
            let mut coefficients: Vec<i64> = (0..n).map(|_| random.random_range(-2..=2i64)).collect();
            coefficients[random.random_range(0..n)] = 1;
            let mut sums = Vec::new();
            study.combinations(|at| sums.push(coefficients.iter().zip(at).map(|(c, x)| c * x).sum::<i64>()));
            let ends = [*sums.choose(random).unwrap(), *sums.choose(random).unwrap()];
            let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            study.characteristics.push((coefficients, low, if high > low { high } else { low + 1 }));
        }
        study
    }

    fn combinations(&self, mut visit: impl FnMut(&[i64])) {
        let count: usize = self.values.iter().map(Vec::len).product();
        for place in 0..count {
            let mut rest = place;
            let at: Vec<i64> = (self.values.iter())
                .map(|values| {
                    let value = values[rest % values.len()];
                    rest /= values.len();
                    value
                })
                .collect();
            visit(&at);
        }
    }

    /// Returns the yield of every characteristic, and the joint yield.
    fn counted(&self) -> (Vec<f64>, f64) {
        let (mut all, mut kept, mut together) = (0u64, vec![0u64; self.characteristics.len()], 0u64);
        self.combinations(|at| {
            all += 1;
            let mut every = true;
            for ((coefficients, low, high), kept) in self.characteristics.iter().zip(&mut kept) {
                let sum: i64 = coefficients.iter().zip(at).map(|(c, x)| c * x).sum();
                let keeps = (*low..=*high).contains(&sum);
                *kept += u64::from(keeps);
                every &= keeps;
            }
            together += u64::from(every);
        });
        let share = |count: u64| count as f64 / all as f64;
        (kept.into_iter().map(share).collect(), share(together))
    }

    /// Returns the study with its file of measured values, as decimal numbers.
    fn read(&self) -> Study {
        let mut text = "[dimensions]\n".to_owned();
        let mut csv: Vec<Vec<String>> = vec![Vec::new(); self.values.iter().map(Vec::len).max().unwrap() + 1];
        for (d, (values, two)) in self.values.iter().zip(&self.two).enumerate() {
            if *two {
                let (nominal, half) = ((values[0] + values[1]) / 2, (values[1] - values[0]) / 2);
                let [nominal, half] = [nominal, half].map(decimal);
                text +=
                    &format!("x{d} = {{ nominal = {nominal}, tolerance = {half}, distribution = \"two-point\" }}\n");
                continue;
            }
            text += &format!("x{d} = {{ measured = \"lot.csv\", column = \"x{d}\", joint = false }}\n");
            csv[0].push(format!("x{d}"));
            for (row, line) in csv[1..].iter_mut().enumerate() {
                line.push(values.get(row).map_or_else(String::new, |value| decimal(*value)));
            }
        }
        text += "[characteristics]\n";
        for (c, (coefficients, low, high)) in self.characteristics.iter().enumerate() {
            let terms: Vec<String> =
                coefficients.iter().enumerate().map(|(d, coefficient)| format!("{coefficient}*x{d}")).collect();
            let [low, high] = [*low, *high].map(decimal);
            text += &format!("y{c} = {{ formula = \"{}\", lower = {low}, upper = {high} }}\n", terms.join(" + "));
        }
        let csv: String = csv.iter().map(|line| line.join(",") + "\n").collect();
        let study = StudyText::toml("study.toml", &text).with_file("lot.csv", &csv);
        Study::from_text(study).unwrap_or_else(|error| panic!("{error}\n{text}{csv}"))
    }
}

/// Formats a whole number of hundredths as a decimal number.
fn decimal(hundredths: i64) -> String {
    let sign = if hundredths < 0 { "-" } else { "" };
    format!("{sign}{}.{:02}", hundredths.abs() / 100, hundredths.abs() % 100)
}

/// Checks the bounds of the joint yield: at most the least yield, and at least 1 minus the sum of all rejects.
#[track_caller]
fn consistent(joint: f64, yields: &[f64]) {
    let least = yields.iter().copied().fold(1.0, f64::min);
    let all = yields.iter().sum::<f64>() - (yields.len() - 1) as f64;
    // The tolerance covers roundings of numbers near 1.
    assert!(joint <= least + 1e-12 && joint >= all - 1e-12, "{joint} of {yields:?}");
}

fn yields(found: &Analysis) -> Vec<f64> {
    found.characteristics.iter().map(|one| one.distribution.capability.unwrap().yield_().unwrap()).collect()
}

/// A value on a limit keeps it, in the yields and in the joint yield, by every method and by samples. The expected yields are counted with
/// whole numbers over all combinations.
#[test]
fn values_on_a_limit_are_counted_as_whole_numbers_count_them() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(48);
    let mut apart = 0;
    for index in 0..60 {
        let drawn = GridStudy::drawn(&mut random);
        let (exact, joint) = drawn.counted();
        let problem = drawn.read().problem;
        for method in [Method::SecondOrder, Method::Full, Method::SixN, Method::Auto, Method::Rss] {
            let found = analyze(&problem, &method.into()).unwrap();
            for (found, exact) in yields(&found).iter().zip(&exact) {
                assert!((found - exact).abs() < 1e-12, "{index} {method:?}: {found} for {exact}");
            }
            let of_all = found.joint.unwrap();
            assert!((of_all.value - joint).abs() < 1e-12, "{index} {method:?}: {of_all:?} for {joint}");
            assert!(of_all.error < 1e-9, "{index} {method:?}: {of_all:?}");
            consistent(of_all.value, &yields(&found));
        }
        let found = simulate(&problem, &SimulationOptions::default().with_samples(4000)).unwrap();
        let sampled = found.characteristics.iter().map(|one| one.yield_.unwrap()).chain(found.joint);
        for (found, exact) in sampled.zip(exact.iter().chain([&joint])) {
            // Six standard errors are exceeded by 2e-9 of the shares.
            let error = (exact * (1.0 - exact) / 4000.0).sqrt();
            assert!((found.value - exact).abs() <= 6.0 * error, "{index}: {found:?} for {exact}");
        }
        apart += usize::from(joint > 0.0 && exact.iter().all(|own| *own < 1.0));
    }
    // Most cases have a joint yield that differs from the single yields.
    assert!(apart > 25, "{apart}");
}

/// The larger of two sums has a kink, so that its yields come from points of the model. The joint yield does too if a surface is not
/// trusted. From every source, three errors reach the counted yield.
#[test]
fn kinks_of_values_on_a_grid_are_counted_by_points() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    for index in 0..8 {
        let [a, b, c]: [i64; 3] = std::array::from_fn(|_| random.random_range(1..6));
        let parts: Vec<[i64; 2]> = [a, b, c].map(|half| [20 - half, 20 + half]).to_vec();
        let (mut all, mut values) = (0.0, Vec::new());
        for x in parts[0] {
            for y in parts[1] {
                for z in parts[2] {
                    values.push(((x + y).max(2 * z), (x - z).abs()));
                    all += 1.0;
                }
            }
        }
        let upper = [values[index % 8].0, values[(3 * index + 1) % 8].1];
        let kept = |keeps: &dyn Fn(&(i64, i64)) -> bool| values.iter().filter(|of| keeps(of)).count() as f64 / all;
        let exact = [kept(&|of| of.0 <= upper[0]), kept(&|of| of.1 <= upper[1])];
        let joint = kept(&|of| of.0 <= upper[0] && of.1 <= upper[1]);
        let [a, b, c] = [a, b, c].map(decimal);
        let line = |half: &str| format!("{{ nominal = 0.2, tolerance = {half}, distribution = \"two-point\" }}");
        let text = format!(
            "[dimensions]\nx = {}\ny = {}\nz = {}\n[characteristics]\nlarger = {{ formula = \"max(x + y, 2*z)\", upper = {} }}\n\
             apart = {{ formula = \"abs(x - z)\", upper = {} }}\n",
            line(&a),
            line(&b),
            line(&c),
            decimal(upper[0]),
            decimal(upper[1]),
        );
        let problem = Study::from_text(StudyText::toml("study.toml", &text)).unwrap().problem;
        for method in [Method::SecondOrder, Method::Auto] {
            let found = analyze(&problem, &method.into()).unwrap();
            for (one, exact) in found.characteristics.iter().zip(exact) {
                let error = one.error_estimate.as_ref().unwrap().yield_.unwrap();
                let own = one.distribution.capability.unwrap().yield_().unwrap();
                assert!((own - exact).abs() <= 3.0 * error + 1e-12 && error < 0.02, "{index}: {own} {error} {exact}");
            }
            let of_all = found.joint.unwrap();
            assert!((of_all.value - joint).abs() <= 3.0 * of_all.error + 1e-12, "{index}: {of_all:?} for {joint}");
            assert!(of_all.error < 0.05, "{index}: {of_all:?}");
            consistent(of_all.value, &yields(&found));
        }
        let found = simulate(&problem, &SimulationOptions::default().with_samples(4000)).unwrap();
        let sampled = found.characteristics.iter().map(|one| one.yield_.unwrap()).chain(found.joint);
        for (found, exact) in sampled.zip(exact.into_iter().chain([joint])) {
            let error = (exact * (1.0 - exact) / 4000.0).sqrt();
            assert!((found.value - exact).abs() <= 6.0 * error, "{index}: {found:?} for {exact}");
        }
    }
}

/// The difference of two large parts has rounding errors in proportion to the parts: 100.01 - 100 is 5e-15 above 0.01, which is 25 units in
/// its last place. The unit in the signature states that a black box adds parts in it.
#[test]
fn a_difference_of_large_values_is_on_its_limit() {
    let text = "[dimensions]\na = { nominal = 100.005, tolerance = 0.005, distribution = \"two-point\" }\n\
                b = { nominal = 99.995, tolerance = 0.005, distribution = \"two-point\" }\n\
                [characteristics]\ngap = { formula = \"a - b\", lower = 0, upper = 0.01 }\n";
    let formula = Study::from_text(StudyText::toml("study.toml", text)).unwrap().problem;
    let part = |name: &str, middle: f64| {
        let law: Arc<dyn Distribution> = Arc::new(TwoValues::new(middle - 0.005, middle + 0.005).unwrap());
        Dimension::distributed(name, middle, Some([-0.005, 0.005]), law).unwrap().with_unit("mm")
    };
    let limits = SpecLimits::new(Some(0.0), Some(0.01)).unwrap();
    let gap = Characteristic::new("gap").with_unit("mm").with_limits(limits);
    let function = Closure::scalar("gap", |x| x[0] - x[1]);
    let closure = Problem::new([part("a", 100.005), part("b", 99.995)], function).unwrap().asking([gap]).unwrap();
    for problem in [formula, closure] {
        // The values are 0.02, 0.01 twice, and 0.
        let found = analyze(&problem, &Method::Full.into()).unwrap();
        let capability = found.characteristics[0].distribution.capability.unwrap();
        assert_eq!(
            (capability.below, capability.above.map(|above| (above - 0.25).abs() < 1e-12)),
            (Some(0.0), Some(true))
        );
        let found = simulate(&problem, &SimulationOptions::default().with_samples(1 << 14)).unwrap();
        let one = &found.characteristics[0];
        assert_eq!(one.below, Some(0.0));
        assert!((one.above.unwrap() - 0.25).abs() < 0.02, "{:?}", one.above);
    }
}

/// A constant sum of three tenths is on its limit of 0.3, and a sum that is 0 on one of 0.
#[test]
fn a_constant_on_its_limit_keeps_it() {
    let text = "[dimensions]\na = { nominal = 0.1 }\nb = { nominal = 0.2 }\nx = { nominal = 1, tolerance = 0.1 }\n\
                [characteristics]\nsum = { formula = \"a + b\", upper = 0.3 }\nnothing = { formula = \"a + b - 0.3\", upper = 0 }\n\
                y = { formula = \"x\" }\n";
    let problem = Study::from_text(StudyText::toml("study.toml", text)).unwrap().problem;
    let found = analyze(&problem, &Method::SecondOrder.into()).unwrap();
    let sampled = simulate(&problem, &SimulationOptions::default().with_samples(100)).unwrap();
    for c in 0..2 {
        assert_eq!(found.characteristics[c].distribution.capability.unwrap().above, Some(0.0));
        assert_eq!(sampled.characteristics[c].above, Some(0.0));
    }
}

fn law(parts: &[&[f64]], inputs: &[Arc<dyn Distribution>]) -> SurfaceLaw {
    let parts: Vec<Option<Univariate>> = parts.iter().map(|part| Some(Univariate::of_coefficients(part))).collect();
    let interactions = Interactions::none(parts.len());
    SurfaceLaw::of(&Surrogate { centre: 0.0, parts, interactions }, inputs, None, &LawOptions::default()).unwrap()
}

/// Forty two-point inputs have 2^40 combinations, but 41 sums with binomial probabilities. A sum that equals a limit keeps it.
#[test]
fn many_combinations_on_a_grid_are_a_short_list() {
    const N: usize = 40;
    let two: Arc<dyn Distribution> = Arc::new(TwoValues::new(-1.0, 1.0).unwrap());
    let law = law(&[&[0.1][..]; N], &vec![two; N]);
    // Pascal's recurrence, which is exact in doubles up to 2^53.
    let mut row = vec![1.0f64];
    for _ in 0..N {
        row = (0..=row.len()).map(|k| row.get(k).unwrap_or(&0.0) + if k > 0 { row[k - 1] } else { 0.0 }).collect();
    }
    let beyond = |k: usize| row[k + 1..].iter().sum::<f64>() / 2f64.powi(N as i32);
    for k in [0, 12, 20, 23, 31, 39] {
        let limit = 0.1 * (2.0 * k as f64 - N as f64);
        let found = law.above(limit);
        assert!((found.value - beyond(k)).abs() <= 1e-14, "{k}: {found:?} for {}", beyond(k));
        assert!(found.error < 1e-12, "{found:?}");
        assert!((law.below(limit).value - (1.0 - beyond(k) - row[k] / 2f64.powi(N as i32))).abs() < 1e-13);
    }
}

/// Half of all parts have one of two values, the other half are normal. Beyond either value lies a quarter of twice the normal tail, and
/// the value itself keeps the limit. A second such part gives sums of both kinds.
#[test]
fn values_beside_a_density_keep_their_limits() {
    let part = |distribution: Arc<dyn Distribution>| Part { name: String::new(), weight: 1.0, distribution };
    let mixed = Mixture::new(vec![
        part(Arc::new(TwoValues::new(-1.0, 1.0).unwrap())),
        part(Arc::new(Normal::new(0.0, 1.0).unwrap())),
    ])
    .unwrap();
    // The mean is 0 and the variance 1, so that the coefficients are the values themselves.
    let mixed: Arc<dyn Distribution> = Arc::new(mixed);
    let normal = Normal::new(0.0, 1.0).unwrap();
    let tail = |x: f64| normal.probability().unwrap().sf(x);
    let one = law(&[&[1.0]], &[Arc::clone(&mixed)]);
    let close = |law: &SurfaceLaw, tail: LawTail, limit: f64, exact: f64| {
        let found = law.tail(limit, tail);
        assert!((found.value - exact).abs() <= found.error + 1e-10, "{limit}: {found:?} for {exact}");
        assert!(found.error < 1e-6, "{found:?}");
    };
    close(&one, LawTail::Upper, 1.0, 0.5 * tail(1.0));
    close(&one, LawTail::Upper, 1.0 - 1e-6, 0.25 + 0.5 * tail(1.0 - 1e-6));
    close(&one, LawTail::Lower, -1.0, 0.5 * tail(1.0));
    close(&one, LawTail::Upper, -1.0, 0.25 + 0.5 * tail(-1.0));
    let both = law(&[&[1.0], &[1.0]], &[Arc::clone(&mixed), mixed]);
    // Two values, one value and a normal part, or two normal parts. The sums 2 and 0 have probabilities in sixteenths.
    let sums = |limit: f64, beyond: f64| {
        beyond / 16.0 + 0.25 * (tail(limit - 1.0) + tail(limit + 1.0)) + 0.25 * tail(limit / 2f64.sqrt())
    };
    close(&both, LawTail::Upper, 2.0, sums(2.0, 0.0));
    close(&both, LawTail::Upper, 0.0, sums(0.0, 1.0));
    close(&both, LawTail::Upper, -2.0, sums(-2.0, 3.0));
    close(&both, LawTail::Lower, 0.0, sums(0.0, 1.0));
}

/// Returns the study and the figures of a case in `tests/data/discrete.json`: counted, or in closed form.
fn case(name: &str) -> (Study, serde_json::Value) {
    let study = Study::read(&repository(&format!("tests/data/discrete/{name}.toml"))).unwrap();
    (study, data("discrete.json")[name].clone())
}

fn numbers(of: &serde_json::Value) -> Vec<f64> {
    of.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn windows_that_no_sum_keeps_at_once_have_no_joint_yield() {
    let (study, exact) = case("joint-two-windows");
    let found = analyze(&study.problem, &study.options).unwrap();
    for (found, exact) in yields(&found).into_iter().zip(numbers(&exact["yields"])) {
        assert!((found - exact).abs() < 1e-15);
    }
    assert!(found.joint.unwrap().value.abs() < 1e-15, "{:?}", found.joint);
    assert_eq!(found.joint_requirement.unwrap().verdict, Verdict::Missed);
}

#[test]
fn measured_hundredths_are_counted_pair_by_pair() {
    let (study, exact) = case("joint-lot");
    for method in [Method::SecondOrder, Method::Full, Method::Auto] {
        let found = analyze(&study.problem, &method.into()).unwrap();
        for (found, exact) in yields(&found).into_iter().zip(numbers(&exact["yields"])) {
            assert!((found - exact).abs() < 1e-14);
        }
        assert!((found.joint.unwrap().value - exact["joint_yield"].as_f64().unwrap()).abs() < 1e-14, "{method:?}");
    }
}

/// A dimension with two values has two nodes. The parabola through both of them is exact for every function.
#[test]
fn two_values_are_evaluated_at_both() {
    let (study, exact) = case("two-point-exact");
    let of = |key: &str| exact[key].as_f64().unwrap();
    for method in [Method::SecondOrder, Method::Full, Method::SixN, Method::ResponseSurface, Method::DimensionReduction]
    {
        let found = analyze(&study.problem, &method.into()).unwrap();
        let moments = found.characteristics[0].moments.unwrap();
        relative(moments.mean(), of("mean"), 1e-12);
        relative(moments.sigma(), of("sigma"), 1e-12);
        assert!(found.warnings.iter().all(|warning| warning.code() != "support-edge"), "{method:?}");
    }
}

/// A pin that touches one side of its hole or the other: the float is the radial play, here 0.1 up or down, and the function exp(20 x) of
/// it.
#[test]
fn a_float_in_contact_is_evaluated_on_both_sides() {
    let text = "[dimensions]\nhole = { nominal = 10.2 }\npin = { nominal = 10 }\n\
                side = { float = { hole = \"hole\", pin = \"pin\", law = \"contact\" } }\n\
                [characteristics]\ny = { formula = \"exp(20*side)\" }\n";
    let problem = Study::from_text(StudyText::toml("study.toml", text)).unwrap().problem;
    for method in [Method::SecondOrder, Method::Full, Method::SixN] {
        let moments = analyze(&problem, &method.into()).unwrap().characteristics[0].moments.unwrap();
        relative(moments.mean(), 2f64.cosh(), 1e-12);
        relative(moments.sigma(), 2f64.sinh(), 1e-12);
    }
}

/// Every point of these methods has possible values or the mean: for few measured values, for mixtures of two values, and for two values.
#[test]
fn dimensions_of_few_values_are_evaluated_at_them() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut drawn = |count: usize| -> Vec<f64> {
        let mut values: Vec<f64> = (0..count).map(|_| 0.01 * f64::from(random.random_range(900..1100i32))).collect();
        values.extend([8.5, 8.5, 11.5]);
        values
    };
    let part = |low: f64, high: f64, weight: f64| Part {
        name: String::new(),
        weight,
        distribution: Arc::new(TwoValues::new(low, high).unwrap()),
    };
    let laws: Vec<Arc<dyn Distribution>> = vec![
        Arc::new(TwoValues::new(0.3 - 0.1, 0.3 + 0.1).unwrap()),
        Arc::new(Measured::new(&[12.38, 12.40, 12.40]).unwrap()),
        Arc::new(Mixture::new(vec![part(1.0, 1.3, 1.0), part(1.1, 1.7, 2.0)]).unwrap()),
        Arc::new(Measured::new(&drawn(1)).unwrap()),
        Arc::new(Measured::new(&drawn(4)).unwrap()),
        Arc::new(Measured::new(&drawn(30)).unwrap()),
    ];
    for (index, law) in laws.iter().enumerate() {
        let occur: Vec<f64> = law.probability().unwrap().atoms().into_iter().map(|(x, _)| x).collect();
        let mut methods = vec![Method::SecondOrder, Method::Full, Method::SixN, Method::ResponseSurface];
        // Rules with as many nodes as there are values have the values as nodes.
        methods.extend((occur.len() <= 3).then_some(Method::ThreePoint));
        methods.extend((occur.len() <= 5).then_some(Method::DimensionReduction));
        for method in methods {
            let asked = Asked::default();
            let dimension = Dimension::distributed("x", law.mean(), None, Arc::clone(law)).unwrap();
            let other = Dimension::normal("z", 1.0, 0.1).unwrap();
            let problem = Problem::new([dimension, other], asked.watching(|x| (0.1 * x[0]).exp() + x[1])).unwrap();
            let options = Options::from(method).with_verify(0);
            let found = analyze(&problem, &options).unwrap();
            for point in asked.points() {
                assert!(point[0] == law.mean() || occur.contains(&point[0]), "{index} {method:?}: {point:?} {occur:?}");
            }
            assert!(found.characteristics[0].moments.unwrap().sigma() > 0.0);
            if occur.len() == 2 || occur.len() <= 3 && method == Method::ThreePoint {
                let [mean, square] = [1, 2].map(|power| {
                    let atoms = law.probability().unwrap().atoms();
                    atoms.iter().map(|(x, share)| share * (0.1 * x).exp().powi(power)).sum::<f64>()
                });
                let moments = found.characteristics[0].moments.unwrap();
                relative(moments.mean(), mean + 1.0, 1e-12);
                // The tolerance covers the rounding of differences of numbers near 10.
                relative(moments.variance(), square - mean * mean + (0.1f64 / 3.0).powi(2), 1e-10);
            }
        }
    }
}
