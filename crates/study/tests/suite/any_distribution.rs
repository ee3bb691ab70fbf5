//! Yields over all distributions within a band, beside inequalities that are known in closed form.

use proptest::prelude::*;

use sensitol::analysis::DistributionFreeYield;
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_testing::{close, faults};

/// Accuracy of a proven end: cells of the band are split until both ends differ by 1e-6.
const CLOSE: f64 = 2e-6;

fn analysed(text: &str) -> sensitol::analysis::CharacteristicAnalysis {
    let study = Study::from_toml(text, "study.toml").unwrap();
    analyze(&study.problem, &Method::Auto.into()).unwrap().characteristics.remove(0)
}

fn bounds(text: &str) -> DistributionFreeYield {
    analysed(text).distribution.distribution_free_yield.unwrap()
}

/// A band alone leaves every fixed value possible: the yield is that of the normal part at the worst and at the best place.
#[test]
fn a_band_alone_is_bounded_by_its_ends() {
    let one = analysed(
        "dimensions = { shim = { nominal = 5, tolerance = 0.1, distribution = \"any\" }, bore = { nominal = 8, sigma = 0.05 } }
         [characteristics]
         gap = { formula = \"bore - shim\", lower = 2.85, upper = 3.15, target_yield = 0.9 }",
    );
    let free = one.distribution.distribution_free_yield.as_ref().unwrap();
    // Phi(1) - Phi(-5) with the gap 0.1 off the middle, and Phi(3) - Phi(-3) in the middle.
    let [least, greatest] = free.interval.unwrap();
    close(least, 0.8413447460685429 - 2.866515718791939e-7, CLOSE, 1.0);
    close(greatest, 0.9973002039367398, CLOSE, 1.0);
    assert_eq!((free.proven, free.dimensions.as_slice()), (true, ["shim".to_owned()].as_slice()));
    // The worst distribution puts every shim at one end of its band.
    let worst: f64 = free.worst.as_ref().unwrap().iter().map(|[x, share]| share * (x - 5.0).abs()).sum();
    close(worst, 0.1, 1e-6, 1.0);
    // No yield of the uniform distribution in its place is reported, and the target lies between both ends.
    assert_eq!((one.distribution.yield_source, one.distribution.capability.unwrap().yield_()), (None, None));
    assert_eq!(one.yield_interval(), free.interval);
    let target = one.characteristic.target().unwrap();
    assert_eq!(one.basis_of(target), Some(sensitol::analysis::FigureBasis::Proof));
    assert_eq!(one.verdict(), Some(sensitol_numeric::verdict::Verdict::Inconclusive));
}

/// Chebyshev (1867): at least 1 - (s/k)^2 lies within k of a known mean. Camp and Meidell (1922): 1 - 4/9 (s/k)^2 for a symmetric unimodal
/// distribution.
#[test]
fn known_inequalities_are_reached() {
    let text = |facts: &str| {
        format!(
            "dimensions = {{ shim = {{ nominal = 0, tolerance = 9, distribution = {{ kind = \"any\", {facts} }} }} }}
             [characteristics]
             twice = {{ formula = \"2*shim\", lower = -4, upper = 4 }}"
        )
    };
    let least = |facts: &str| bounds(&text(facts)).interval.unwrap()[0];
    close(least("mean = [0, 0], sigma_at_most = 1"), 0.75, CLOSE, 1.0);
    // The slices of a uniform distribution are bounded in 256 parts: the bound holds, and is off by as much.
    let unimodal = least("symmetric = true, unimodal = true, sigma_at_most = 1");
    assert!((8.0 / 9.0 - 5e-3..=8.0 / 9.0 + 1e-9).contains(&unimodal), "{unimodal}");
    // A symmetric distribution has its mean in the middle: Chebyshev's bound is attained by such a one.
    close(least("symmetric = true, sigma_at_most = 1"), 0.75, CLOSE, 1.0);
}

/// Several unknown distributions of a sum with bands alone: the worst case of their sum beside the normal part.
#[test]
fn bands_of_several_dimensions_are_added() {
    let free = bounds(
        "[dimensions]
         a = { nominal = 1, tolerance = 0.03, distribution = \"any\" }
         b = { nominal = 2, tolerance = [-0.05, 0.01], distribution = \"any\" }
         c = { nominal = 0, sigma = 0.02 }
         [characteristics]
         y = { formula = \"a - b + c\", upper = -0.9 }",
    );
    // The greatest place is 1.03 - 1.95 = -0.92, one sigma below the limit, and the least 0.97 - 2.01.
    let [least, greatest] = free.interval.unwrap();
    close(least, 0.8413447460685429, CLOSE, 1.0);
    close(greatest, 1.0, CLOSE, 1.0);
    assert!(free.worst.is_none() && free.dimensions.len() == 2);
}

/// A curved formula is counted at points. Where it equals a sum in disguise, the bounds enclose those of the sum.
#[test]
fn points_bound_a_curved_characteristic() {
    let of = |formula: &str| {
        bounds(&format!(
            "dimensions = {{ shim = {{ nominal = 5, tolerance = 0.1, distribution = {{ kind = \"any\", mean = [4.98, 5.02] }} }}, bore = {{ nominal = 8, sigma = 0.05 }} }}
             [characteristics]
             gap = {{ formula = \"{formula}\", lower = 2.85, upper = 3.15 }}"
        ))
    };
    let (sum, curved) = (of("bore - shim"), of("sqrt((bore - shim)^2)"));
    assert!(sum.proven && !curved.proven);
    let ([low, high], [least, greatest]) = (sum.interval.unwrap(), curved.interval.unwrap());
    // Cells of a 64th of the band and intervals of 16,384 points widen the bounds by at most 0.02.
    assert!(least <= low && low - least < 0.02, "{least} {low}");
    assert!(greatest >= high && greatest - high < 0.02, "{greatest} {high}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Bounds do not depend on the unit, on a reflection, or on the order of the dimensions.
    #[test]
    fn bounds_have_no_unit(scale in 1e-6f64..1e6, tolerance in 0.01f64..0.3, limit in 0.05f64..0.4, off in -0.9f64..0.9) {
        let text = |scale: f64, sign: f64, swapped: bool| {
            let mean = sign * off * tolerance * scale;
            let shim = format!("shim = {{ nominal = 0, tolerance = {}, distribution = {{ kind = \"any\", mean = [{mean}, {mean}] }} }}\n", tolerance * scale);
            let bore = format!("bore = {{ nominal = 0, sigma = {} }}\n", 0.1 * scale);
            let lines = if swapped { bore + &shim } else { shim + &bore };
            let [lower, upper] = if sign < 0.0 { [-limit * scale, 2.0 * limit * scale] } else { [-2.0 * limit * scale, limit * scale] };
            format!("[dimensions]\n{lines}[characteristics]\ny = {{ formula = \"bore + shim\", lower = {lower}, upper = {upper} }}")
        };
        let [low, high] = bounds(&text(1.0, 1.0, false)).interval.unwrap();
        for other in [text(scale, 1.0, false), text(1.0, -1.0, false), text(1.0, 1.0, true)] {
            let [least, greatest] = bounds(&other).interval.unwrap();
            prop_assert!((least - low).abs() < CLOSE && (greatest - high).abs() < CLOSE);
        }
    }
}

/// Limits that the ends of all bands reach exactly are kept, whatever the distributions.
#[test]
fn a_worst_case_on_its_limits_has_a_yield_of_one() {
    let free = bounds(
        "[dimensions]
         a = { nominal = 5, tolerance = 0.1, distribution = \"any\" }
         b = { nominal = 3, tolerance = 0.2, distribution = \"any\" }
         [characteristics]
         y = { formula = \"a - b\", lower = 1.7, upper = 2.3 }",
    );
    assert_eq!(free.interval, Some([1.0, 1.0]));
}

/// A dimension of slope 0 leaves the ordinary yield.
#[test]
fn a_dimension_without_effect_changes_nothing() {
    let one = analysed(
        "dimensions = { a = { nominal = 0, tolerance = 1, distribution = \"any\" }, b = { nominal = 0, sigma = 1 } }
         [characteristics]
         y = { formula = \"0*a + b\", upper = 2 }",
    );
    assert!(one.distribution.distribution_free_yield.is_none());
    close(one.distribution.capability.unwrap().yield_().unwrap(), 0.9772498680518208, 1e-9, 1.0);
}

/// The yield of those that keep another limit is unknown: the worst distribution leaves none of them.
#[test]
fn a_condition_leaves_the_yield_open() {
    let text = "dimensions = { a = { nominal = 0, tolerance = 0.1, distribution = \"any\" }, b = { nominal = 0, sigma = 0.1 } }
                [characteristics]
                base = { formula = \"b - 2*a\", lower = 0 }
                y = { formula = \"a + b\", upper = 0.2, given = \"base\", target_yield = 0.5 }";
    let study = Study::from_toml(text, "study.toml").unwrap();
    let found = analyze(&study.problem, &Method::Auto.into()).unwrap();
    assert_eq!(found.characteristics[1].verdict(), Some(sensitol_numeric::verdict::Verdict::Inconclusive));
}

/// A window of rejects between the values at which a curved formula is counted: the bounds are not proven, and the target is not met.
#[test]
fn bounds_from_points_never_meet_a_target() {
    let one = analysed(
        "dimensions = { a = { nominal = 0, tolerance = 0.1, distribution = \"any\" }, b = { nominal = 0, sigma = 0.1 } }
         [characteristics]
         y = { formula = \"10*exp(-((a - 0.0515)/0.0003)^2) + b\", upper = 0.5, target_yield = 0.99 }",
    );
    assert!(!one.distribution.distribution_free_yield.as_ref().unwrap().proven);
    assert_eq!(one.yield_interval().unwrap()[0], 0.0);
    assert_eq!(one.verdict(), Some(sensitol_numeric::verdict::Verdict::Inconclusive));
}

#[test]
fn samples_and_allocations_refuse_it() {
    let study = Study::from_toml(
        "dimensions = { shim = { nominal = 5, tolerance = 0.1, distribution = \"any\" } }
         characteristics = { gap = { formula = \"shim\", upper = 5.2 } }",
        "study.toml",
    )
    .unwrap();
    let error = simulate(&study.problem, &SimulationOptions::default().with_samples(1000)).unwrap_err().to_string();
    assert!(error.contains("`shim` may have any distribution") && error.contains("uniform"), "{error}");
}

#[test]
fn wrong_promises_name_key_and_remedy() {
    let of = |line: &str| {
        let text = format!(
            "dimensions = {{ shim = {{ {line} }} }}\ncharacteristics = {{ y = {{ formula = \"shim\", upper = 6 }} }}"
        );
        faults(&[&text])
    };
    for (line, said) in [
        (
            "nominal = 5, tolerance = 0.1, distribution = { kind = \"any\", mean = [4.8, 5.0] }",
            "4.8 is not within the tolerance band",
        ),
        ("nominal = 5, tolerance = 0.1, distribution = { kind = \"any\", mean = [5.05, 5.0] }", "not below the least"),
        ("nominal = 5, tolerance = 0.1, distribution = { kind = \"any\", sigma_at_most = 0 }", "0 is not above 0"),
        ("nominal = 5, tolerance = 0.1, distribution = { kind = \"any\", unimodal = true }", "add symmetric = true"),
        (
            "nominal = 5, tolerance = 0.1, distribution = { kind = \"any\", symmetric = true, mean = [5.05, 5.1] }",
            "contradict each other",
        ),
        ("nominal = 5, tolerance = 0.1, sigma = 0.01, distribution = \"any\"", "sigma_at_most = 0.01"),
        ("nominal = 5, distribution = \"any\"", "tolerance"),
        ("nominal = 5, tolerance = 0.1, distribution = { kind = \"uniform\", symmetric = true }", "symmetric"),
        (
            "nominal = 5, tolerance = 0.1, distribution = { kind = \"mixture\", parts = { a = { weight = 1, distribution = \"any\" } } }",
            "known one",
        ),
    ] {
        let found = of(line);
        assert!(found.contains(said), "{line}\n{found}");
    }
}
