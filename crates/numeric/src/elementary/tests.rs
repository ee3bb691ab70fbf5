//! Accuracy against values of many digits, and equality of the values wherever they are computed.

use crate::elementary::*;

type Function = (&'static str, fn(f64) -> f64, fn(f64) -> f64, fn(&[f64], &mut [f64]), fn(&[f64], &mut [f64]), f64);

/// Name, scalar function, reference function of the crate `libm`, block on this processor, block on the least processor, and greatest error
/// in ulp.
fn functions() -> [Function; 6] {
    fn scalar<E: Elementary>(x: &[f64], out: &mut [f64]) {
        pulp::Scalar.vectorize(Compiled(Map::<E> { x, out, function: PhantomData }));
    }
    [
        ("sin", Sin::of, libm::sin, Sin::map, scalar::<Sin>, 1.0),
        ("cos", Cos::of, libm::cos, Cos::map, scalar::<Cos>, 1.0),
        ("tan", Tan::of, libm::tan, Tan::map, scalar::<Tan>, 2.5),
        ("exp", Exp::of, libm::exp, Exp::map, scalar::<Exp>, 1.0),
        ("ln", Ln::of, libm::log, Ln::map, scalar::<Ln>, 1.0),
        ("acos", Acos::of, libm::acos, Acos::map, scalar::<Acos>, 1.0),
    ]
}

fn ulp(value: f64) -> f64 {
    let size = value.abs().max(f64::MIN_POSITIVE);
    size.next_up() - size
}

/// Many arguments of every size, some outside the range of the fast path.
fn arguments() -> Vec<f64> {
    let special = [0.0, -0.0, 1.0, -1.0, 0.5, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, f64::MIN_POSITIVE];
    let tiny = [5e-324, -5e-324, 1e-310, 1e-20, 708.0, 708.5, -708.5, 709.9, -746.0, 1.6e6, 1_600_000.1, -1e22, 1e300];
    let quarters = (-40..40).map(|n| f64::from(n) * std::f64::consts::FRAC_PI_2);
    let spread = (0..20_000).map(|i| {
        let (sign, size) = (1.0 - 2.0 * f64::from(i % 2), f64::from(i * 7919 % 20_000) / 20_000.0);
        sign * 10f64.powf(-4.0 + 11.0 * size)
    });
    let near = (0..20_000).map(|i| f64::from(i) / 10_000.0 - 1.0);
    special.into_iter().chain(tiny).chain(quarters).chain(spread).chain(near).collect()
}

#[test]
fn values_of_sixty_digits_are_met() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/elementary.json")).unwrap();
    let cases: Vec<(String, f64, f64, f64)> = serde_json::from_str(&text).unwrap();
    for (name, of, _, _, _, most) in functions() {
        let mut worst = 0f64;
        for (_, x, value, rest) in cases.iter().filter(|case| case.0 == name) {
            // The difference of neighbouring doubles is exact, and so small that the rest counts.
            let error = ((of(*x) - value) - rest).abs() / ulp(*value);
            assert!(error <= most, "{name}({x:e}) is {} for {value}: {error} ulp", of(*x));
            worst = worst.max(error);
        }
        assert!(worst > 0.3, "{name}: no case has rounded, so none was looked at");
    }
}

/// Two functions within an ulp or two of the true value differ by at most the sum of both errors.
#[test]
fn another_library_says_the_same_everywhere() {
    for (name, of, other, _, _, most) in functions() {
        for x in arguments() {
            let (found, expected) = (of(x), other(x));
            let same = found == expected && found.is_sign_negative() == expected.is_sign_negative();
            let close = (found - expected).abs() <= (most + 1.0) * ulp(expected);
            assert!(same || close || found.is_nan() && expected.is_nan(), "{name}({x:e}): {found} for {expected}");
        }
    }
}

/// A value depends on its argument only, not on its neighbours in the block or on the instructions.
#[test]
fn a_value_is_the_same_alone_and_in_any_block_on_any_processor() {
    let x = arguments();
    for (name, of, _, map, scalar, _) in functions() {
        let bits = |x: f64| of(x).to_bits();
        for first in [0, 1, 2, 3, 5, 8, 13] {
            for length in [1, 2, 3, 7, 64, 255, 4001, x.len() - first] {
                let x = &x[first..first + length];
                let (mut here, mut least) = (vec![0.0; length], vec![0.0; length]);
                map(x, &mut here);
                scalar(x, &mut least);
                for ((&x, here), least) in x.iter().zip(here).zip(least) {
                    // NaN has many representations, and no rule selects one.
                    let known = x.is_nan() || of(x).is_nan() && here.is_nan() && least.is_nan();
                    assert!(known || bits(x) == here.to_bits(), "{name}({x:e}) from {first}, {length} numbers");
                    assert!(known || bits(x) == least.to_bits(), "{name}({x:e}) on the least processor");
                }
            }
        }
    }
}

#[test]
fn signs_and_ends_are_as_they_should() {
    assert!(Sin::of(-0.0).is_sign_negative() && Tan::of(-0.0).is_sign_negative());
    assert_eq!((Cos::of(0.0), Exp::of(-0.0), Acos::of(1.0)), (1.0, 1.0, 0.0));
    assert_eq!((Ln::of(1.0), Ln::of(0.0), Exp::of(f64::NEG_INFINITY)), (0.0, f64::NEG_INFINITY, 0.0));
    for undefined in [Sin::of(f64::INFINITY), Ln::of(-1.0), Acos::of(1.0f64.next_up()), Cos::of(f64::NAN)] {
        assert!(undefined.is_nan());
    }
}
