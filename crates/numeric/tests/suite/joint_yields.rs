//! Joint yield of distributions over the same inputs, compared with products and single integrals.

use std::sync::Arc;

use sensitol_numeric::correlation::{Correlation, Pair};
use sensitol_numeric::distribution::{Distribution, Normal, Probability, Uniform};

use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::law::{LawOptions, SurfaceLaw, joint_yield};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{Surrogate, Univariate};

type Law = Arc<dyn Distribution>;

fn normal() -> Law {
    Arc::new(Normal::new(0.0, 1.0).unwrap())
}

fn uniform() -> Law {
    Arc::new(Uniform::new(-1.0, 1.0).unwrap())
}

fn made(parts: &[&[f64]], inputs: &[Law], correlation: Option<&Correlation>) -> SurfaceLaw {
    let own = |part: &&[f64]| Some(Univariate::of_coefficients(part));
    let parts: Vec<Option<Univariate>> = parts.iter().map(own).collect();
    let interactions = Interactions::none(parts.len());
    let surrogate = Surrogate { centre: 0.0, parts, interactions };
    SurfaceLaw::of(&surrogate, inputs, correlation, &LawOptions::default()).unwrap()
}

fn limits(lower: f64, upper: f64) -> SpecLimits {
    SpecLimits::new(Some(lower), Some(upper)).unwrap()
}

/// The joint yield is exact in two cases: the product for two independent characteristics, and the yield itself for the same characteristic
/// twice.
#[test]
fn a_joint_yield_counts_common_failures_once() {
    let inputs = vec![normal(), uniform(), uniform()];
    let first = made(&[&[1.0], &[0.5], &[]], &inputs, None);
    let second = made(&[&[], &[], &[1.0]], &inputs, None);
    let (limits, narrow) = (limits(-2.0, 1.8), limits(-1.6, 1.7));
    let yield_of = |law: &SurfaceLaw, limits: SpecLimits| {
        1.0 - law.below(limits.lower().unwrap()).value - law.above(limits.upper().unwrap()).value
    };
    let both = joint_yield(&[(&first, limits), (&second, narrow)]);
    let product = yield_of(&first, limits) * yield_of(&second, narrow);
    assert!((both.value - product).abs() <= both.error && both.error < 1e-3, "{both:?} {product}");
    let same = joint_yield(&[(&first, limits), (&first, limits)]);
    assert!((same.value - yield_of(&first, limits)).abs() <= same.error, "{same:?}");
    let alone = joint_yield(&[(&first, limits)]);
    assert!((alone.value - yield_of(&first, limits)).abs() < 1e-15);
}

/// Integral by Simpson's rule. For smooth functions over these steps its error is 1e-9 of their size.
fn simpson(from: f64, to: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 4000;
    let width = (to - from) / f64::from(STEPS);
    let weight = |i: u32| match i {
        0 | STEPS => 1.0,
        _ if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=STEPS).map(|i| weight(i) * f(from + width * f64::from(i))).sum::<f64>() * width / 3.0
}

/// Probability of a normal variable with this sigma beyond a distance on either side.
fn beyond(sigma: f64, to_lower: f64, to_upper: f64) -> f64 {
    let normal = Normal::new(0.0, sigma).unwrap();
    normal.cdf(-to_lower) + normal.sf(to_upper)
}

/// Probability that at least one of three characteristics is rejected, given that each is with the probability `of` and they are
/// independent. The form avoids cancellation.
fn any_of_three(of: f64) -> f64 {
    of * (3.0 - 3.0 * of + of * of)
}

/// Density of the standard normal distribution.
fn density(s: f64) -> f64 {
    (-0.5 * s * s).exp() / (2.0 * std::f64::consts::PI).sqrt()
}

/// Three characteristics of shared inputs, which are first, and of one normal input each.
fn sharing(shared: &[&[f64]], own: f64, inputs: &[Law]) -> Vec<SurfaceLaw> {
    let own = [own];
    let one = |k: usize| {
        let mut parts = shared.to_vec();
        parts.extend((0..3).map(|each| if each == k { &own[..] } else { &[] }));
        made(&parts, inputs, None)
    };
    (0..3).map(one).collect()
}

/// Three characteristics with four shared inputs and one own input each. Given the shared inputs they are independent, so the joint yield
/// is one integral. The errors follow from points at which limits are broken: they hold, and fall with the rejects.
#[test]
fn a_joint_yield_is_known_in_the_tail() {
    let inputs: Vec<Law> = (0..7).map(|_| normal()).collect();
    for own in [0.3, 1.0, 3.0] {
        let laws = sharing(&[&[0.5][..]; 4], own, &inputs);
        for score in [1.0, 2.0, 3.0, 4.5, 6.0] {
            let limit = score * (1.0f64 + own * own).sqrt();
            let all: Vec<(&SurfaceLaw, SpecLimits)> = laws.iter().map(|law| (law, limits(-limit, limit))).collect();
            let found = joint_yield(&all);
            let given = |s: f64| density(s) * any_of_three(beyond(own, limit + s, limit - s));
            let exact = simpson(-12.0, 12.0, &given);
            let rejected = 1.0 - found.value;
            assert!((rejected - exact).abs() <= found.error + 1e-15, "{own}, {score}: {found:?} for {exact:e}");
            assert!(found.error < 0.02 * exact + 1e-15, "{own}, {score}: {found:?} for {exact:e}");
        }
    }
}

/// The shared input is curved, uniform, or a parabola that breaks limits on both sides, which no direction explains.
#[test]
fn a_joint_yield_of_bent_surfaces_is_within_its_error() {
    let root = 3f64.sqrt();
    // The last number is the permitted error as a fraction of the rejects. No direction helps for a uniform input far out, or for a
    // parabola anywhere.
    type Shared<'a> = (Law, &'a [f64], &'a dyn Fn(f64) -> f64, [f64; 2], f64);
    let cases: [Shared<'_>; 3] = [
        (normal(), &[1.0, 0.2], &density, [-9.0, 9.0], 0.05),
        (uniform(), &[1.0, 0.1], &|_| 0.5 / 3f64.sqrt(), [-root, root], 0.3),
        (normal(), &[0.0, 0.5], &density, [-9.0, 9.0], 0.3),
    ];
    for (shared, part, density, [from, to], most) in cases {
        let inputs = [shared, normal(), normal(), normal()];
        let own = 0.4;
        let laws = sharing(&[part], own, &inputs);
        for limit in [2.0, 3.0, 4.0] {
            let all: Vec<(&SurfaceLaw, SpecLimits)> = laws.iter().map(|law| (law, limits(-limit, limit))).collect();
            let found = joint_yield(&all);
            // The surface is 0 at the nominal. The parabola has a mean other than 0.
            let given = |s: f64| {
                let at = part[0] * s + part[1] * s * s;
                density(s) * any_of_three(beyond(own, limit + at, limit - at))
            };
            let exact = simpson(from, to, &given);
            let rejected = 1.0 - found.value;
            assert!((rejected - exact).abs() <= found.error + 1e-15, "{part:?}, {limit}: {found:?} for {exact:e}");
            assert!(found.error < most * exact + 1e-15, "{part:?}, {limit}: {found:?} for {exact:e}");
        }
    }
}

/// Three normal inputs with equal correlations and a limit each. They share one factor.
#[test]
fn a_joint_yield_of_correlated_inputs_is_one_integral() {
    let names = ["a", "b", "c"];
    let dimensions: Vec<Dimension> = names.map(|name| Dimension::normal(name, 0.0, 1.0).unwrap()).to_vec();
    let inputs: Vec<Law> = (0..3).map(|_| normal()).collect();
    for rho in [0.3f64, 0.8] {
        let pair = |a: &str, b: &str| Pair { between: [a.into(), b.into()], value: rho };
        let pairs = [pair("a", "b"), pair("a", "c"), pair("b", "c")];
        let correlation = Correlation::new(&dimensions, &pairs).unwrap();
        let laws: Vec<SurfaceLaw> = (0..3)
            .map(|k| {
                let parts: Vec<&[f64]> = (0..3).map(|each| if each == k { &[1.0][..] } else { &[] }).collect();
                made(&parts, &inputs, Some(&correlation))
            })
            .collect();
        for limit in [2.0, 3.0, 5.0] {
            let all: Vec<(&SurfaceLaw, SpecLimits)> = laws.iter().map(|law| (law, limits(-limit, limit))).collect();
            let found = joint_yield(&all);
            let (shared, own) = (rho.sqrt(), (1.0 - rho).sqrt());
            let given = |s: f64| density(s) * any_of_three(beyond(own, limit + shared * s, limit - shared * s));
            let exact = simpson(-12.0, 12.0, &given);
            let rejected = 1.0 - found.value;
            assert!((rejected - exact).abs() <= found.error + 1e-15, "{rho}, {limit}: {found:?} for {exact:e}");
            assert!(found.error < 0.02 * exact + 1e-15, "{rho}, {limit}: {found:?} for {exact:e}");
        }
    }
}
