//! The Pearson engine: a law from its moments, a probability, a quantile.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use sensitol::pearson::Pearson;

/// Type by type, and a nearly normal one, as most characteristics are.
const LAWS: [(&str, f64, f64); 7] = [
    ("normal", 0.0, 3.0),
    ("nearly-normal-IV", -0.0086, 3.0005),
    ("I", 0.5, 3.0),
    ("III", 1.0, 4.5),
    ("VI", 1.0, 4.8),
    ("IV", 0.5, 4.0),
    ("VII", 0.0, 9.0),
];

fn pearson(c: &mut Criterion) {
    let zs: Vec<f64> = (0..64).map(|i| -4.0 + 0.125 * f64::from(i)).collect();
    let ps: Vec<f64> = (1..65).map(|i| f64::from(i) / 65.0).collect();
    for (name, skewness, kurtosis) in LAWS {
        let law = Pearson::new(0.0, 1.0, skewness, kurtosis).unwrap();
        let mut group = c.benchmark_group(name);
        group.bench_function("build", |b| b.iter(|| Pearson::new(0.0, 1.0, black_box(skewness), black_box(kurtosis))));
        let mut next = zs.iter().cycle();
        group.bench_function("cdf", |b| b.iter(|| law.cdf(black_box(*next.next().unwrap()))));
        let mut next = ps.iter().cycle();
        group.bench_function("quantile", |b| b.iter(|| law.quantile(black_box(*next.next().unwrap()))));
        group.bench_function("quantile-1e-12", |b| b.iter(|| law.quantile(black_box(1e-12))));
        group.bench_function("quantile-1e-100", |b| b.iter(|| law.quantile(black_box(1e-100))));
        group.finish();
    }
}

criterion_group!(benches, pearson);
criterion_main!(benches);
