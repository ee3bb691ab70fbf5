//! Warnings about estimates of rare events that rest on few points.

use crate::rare::RareCharacteristic;
use crate::warning::Warning;

/// Part of an estimate on a single point above which there is a warning.
const HEAVY: f64 = 0.25;

pub(super) fn of(characteristics: &[RareCharacteristic], samples: u64, evaluations: u64) -> Vec<Warning> {
    characteristics.iter().flat_map(|one| of_one(one, samples, evaluations)).collect()
}

fn of_one(one: &RareCharacteristic, samples: u64, evaluations: u64) -> Vec<Warning> {
    let characteristic = || one.characteristic.name().to_owned();
    let mut warnings: Vec<Warning> = (one.error.iter())
        .map(|error| Warning::FailedSamples {
            characteristic: characteristic(),
            failed: one.failed,
            samples,
            error: error.to_string(),
        })
        .collect();
    for beyond in [&one.below, &one.above].into_iter().flatten() {
        let limit = beyond.limit;
        if beyond.probability.is_none() {
            let most = beyond.interval[1];
            warnings.push(Warning::NothingBeyond { characteristic: characteristic(), limit, points: samples, most });
        }
        if let Some(part) = beyond.greatest_part.filter(|&part| part > HEAVY) {
            warnings.push(Warning::HeavyPoint { characteristic: characteristic(), limit, part });
        }
        if let Some(points) = beyond.plain_points {
            warnings.push(Warning::PlainFallback { characteristic: characteristic(), limit, points });
            continue;
        }
        if let Some(plain) = beyond.plain_samples.filter(|&plain| plain < evaluations as f64) {
            warnings.push(Warning::PlainSampling { characteristic: characteristic(), limit, plain, evaluations });
        }
    }
    warnings
}
