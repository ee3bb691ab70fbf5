//! Four moments of a second-order model: cost over N, dense and sparse.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sensitol::distribution::StandardMoments;
use sensitol_numeric::moments::{Interactions, of_quadratic};

fn moments(c: &mut Criterion) {
    let mut group = c.benchmark_group("moments");
    let skewed = StandardMoments::from_standard([0.7, 4.0, 8.0, 40.0, 120.0, 700.0]);
    for n in [10usize, 100, 500, 1000] {
        let linear: Vec<f64> = (0..n).map(|j| (j as f64).sin()).collect();
        let curved: Vec<f64> = (0..n).map(|j| 0.1 * (j as f64).cos()).collect();
        let all = || (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k, 0.01 * ((j * k) as f64).sin())));
        let ring = || (0..n).map(|j| (j, (j + 1) % n, 0.05));
        let inputs = vec![skewed; n];
        group.sample_size(if n < 500 { 100 } else { 20 });
        for (name, interactions) in
            [("dense", Interactions::of_pairs(n, all())), ("ring", Interactions::of_pairs(n, ring()))]
        {
            group.bench_with_input(BenchmarkId::new(name, n), &interactions, |b, interactions| {
                b.iter(|| of_quadratic(0.0, black_box(&linear), black_box(&curved), interactions, &inputs));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, moments);
criterion_main!(benches);
