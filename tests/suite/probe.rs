//! What a probe finds out of models that behave, drift, flip, and hiss.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use sensitol::assembly::Run;
use sensitol::probe::{Probe, probe};
use sensitol::{Closure, Problem};

use super::support::{normals, refusing};

fn of(function: Closure) -> Probe {
    probe(&Problem::new(normals(&[3.0, 2.0], &[0.3, 0.6]), function).unwrap(), &Run::to_the_end()).unwrap()
}

fn scalar(function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Probe {
    of(Closure::scalar("y", function))
}

/// The checks that failed.
fn failed(probe: &Probe) -> Vec<&'static str> {
    probe.checks.iter().filter(|check| check.fault.is_some()).map(|check| check.what).collect()
}

#[test]
fn a_model_that_behaves_passes() {
    let found = scalar(|x| x[0] * x[1]);
    assert!(found.passed(), "{:?}", found.checks);
    assert_eq!((found.evaluations, found.adapter.is_none()), (2 * 2 + 31, true));
    assert_eq!(found.characteristics[0].nominal, Some(6.0));
    // A rounding error of 6 is 9e-16: its noise is of that size, if it shows at all.
    assert!(found.characteristics[0].noise.is_none_or(|noise| noise < 1e-14));
    // A symmetric parabola has no slope, and reacts all the same.
    let parabola = scalar(|x| (x[0] - 3.0).powi(2));
    assert!(parabola.passed());
    assert_eq!(parabola.characteristics[0].silent, ["x1"]);
}

/// Noise of a known size: a hash of the coordinates, uniform with sigma 1e-6.
#[test]
fn noise_is_measured() {
    let hiss = |x: &[f64]| {
        let mut bits = x[0].to_bits() ^ x[1].to_bits().rotate_left(17);
        for _ in 0..3 {
            bits = (bits ^ (bits >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
        ((bits >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12f64.sqrt() * 1e-6
    };
    let found = scalar(move |x| x[0] - 2.0 * x[1] + hiss(x));
    assert!(found.passed(), "{:?}", found.checks);
    // Nine values tell a standard deviation to a factor of two or so.
    let noise = found.characteristics[0].noise.unwrap();
    assert!((2e-7..5e-6).contains(&noise), "{noise}");
    // A step of h sigmas changes y by 0.1 h for x0: the noise is a thousandth of that at 1e-2.
    let step = found.characteristics[0].least_step[0].unwrap();
    assert!((step / (noise / 0.1 / 1e-3) - 1.0).abs() < 1e-3, "{step}");
}

#[test]
fn models_that_remember_are_found_out() {
    // A drift with every point.
    let count = AtomicUsize::new(0);
    let drift = scalar(move |x| x[0] + 1e-3 * count.fetch_add(1, Ordering::Relaxed) as f64);
    assert!(failed(&drift).contains(&"the same point twice has the same values"), "{:?}", drift.checks);
    // A mirrored solution from some point on.
    let mirrored = AtomicBool::new(false);
    let flip = scalar(move |x| {
        if x[0] > 3.2 {
            mirrored.store(true, Ordering::Relaxed);
        }
        if mirrored.load(Ordering::Relaxed) { -x[0] } else { x[0] }
    });
    assert!(failed(&flip).contains(&"the nominal values are the same after other points"), "{:?}", flip.checks);
    // Poisoned by a point at which it fails.
    let poisoned = std::sync::Arc::new(AtomicBool::new(false));
    let (seen, kept) = (std::sync::Arc::clone(&poisoned), poisoned);
    let function = refusing(
        move |x| x[0] + if kept.load(Ordering::Relaxed) { 0.1 } else { 0.0 },
        move |x| {
            let fails = x[0] > 10.0;
            seen.fetch_or(fails, Ordering::Relaxed);
            fails
        },
    );
    assert_eq!(failed(&of(function)), ["the nominal values are the same after points where it may fail"]);
}

#[test]
fn models_without_values_or_reaction_fail() {
    let none = of(refusing(|x| x[0], |_| true));
    assert!(failed(&none).contains(&"the nominal dimensions have values"));
    let mute = scalar(|_| 7.0);
    assert_eq!(failed(&mute), ["every characteristic reacts to some dimension"]);
}
