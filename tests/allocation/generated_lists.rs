//! Lists under additive rows from seeds, generated like those of `tests/data/generators/allocation_lists.py`.

use sensitol::allocation::choice::option_list::ListOption;
use serde_json::Value;

/// Generator of numbers in [0, 1) by S. Vigna's splitmix64, like that of `generators/allocation_lists.py`.
pub struct Numbers(pub u64);

impl Numbers {
    /// Returns the next number in [0, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 * 2f64.powi(-53)
    }
}

/// Returns the problem of a seed, by the same arithmetic in the same order.
pub fn lists(of: &Value) -> Vec<Vec<ListOption>> {
    let number = |key: &str| of[key].as_u64().unwrap();
    let (count, options, rows) = (number("lists"), number("options"), number("rows") as usize);
    let (squares, proportional) = (of["squares"].as_bool().unwrap(), of["proportional"].as_bool().unwrap());
    let mut u = Numbers(number("seed"));
    let mut all: Vec<Vec<ListOption>> = Vec::new();
    for _ in 0..count {
        let size = 0.02 + 0.08 * u.next();
        let b = 0.5 + 1.5 * u.next();
        let kind = (3.0 * u.next()).floor() as usize;
        let mut slopes = Vec::new();
        for r in 0..rows {
            let slope = 0.3 + 1.2 * u.next();
            let absent = u.next() < 0.3;
            slopes.push(if r > 0 && absent { 0.0 } else { slope });
        }
        let mut own: Vec<(ListOption, f64)> = Vec::new();
        for place in 0..options as usize {
            let factor = 0.3 + 2.7 * u.next();
            let tolerance = size * factor;
            let noise = u.next();
            let power = match kind {
                0 => 1.0 / factor,
                1 => (1.0 / factor).sqrt(),
                _ => 1.0 / factor * (1.0 / factor).sqrt(),
            };
            let linear = slopes.iter().map(|slope| slope * tolerance);
            let uses: Vec<f64> = linear.map(|x| if squares { x * x } else { x }).collect();
            own.push((ListOption { cost: b * power * (0.97 + 0.06 * noise), uses, place }, noise));
        }
        if proportional {
            let sums: Vec<f64> = own.iter().map(|(one, _)| one.uses.iter().fold(0.0, |sum, use_| sum + use_)).collect();
            let most = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            for ((one, noise), sum) in own.iter_mut().zip(sums) {
                one.cost = 110.0 * most - 100.0 * sum * (0.98 + 0.04 * *noise);
            }
        }
        all.push(own.into_iter().map(|(one, _)| one).collect());
    }
    for r in 0..rows {
        let (mut tight, mut loose) = (0.0, 0.0);
        for list in &all {
            tight += list.iter().map(|one| one.uses[r]).fold(f64::INFINITY, f64::min);
            loose += list.iter().map(|one| one.uses[r]).fold(0.0, f64::max);
        }
        let room = tight + 0.35 * (loose - tight);
        all.iter_mut().flatten().for_each(|one| one.uses[r] /= room);
    }
    all
}
