//! The law of a surface: what it costs to make one, and a limit of it.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sensitol::distribution::{Distribution, Normal, Triangular, Uniform};
use sensitol_numeric::law::{LawOptions, SurfaceLaw};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{Surrogate, Univariate};

type Law = Arc<dyn Distribution>;

fn normal() -> Law {
    Arc::new(Normal::new(0.0, 1.0).expect("a sigma above 0"))
}

/// Normal, uniform and triangular inputs in turn.
fn mixed(n: usize) -> Vec<Law> {
    let kinds: [Law; 3] = [
        normal(),
        Arc::new(Uniform::new(0.0, 1.0).expect("an interval")),
        Arc::new(Triangular::new(0.0, 0.3, 1.0).expect("a triangle")),
    ];
    (0..n).map(|j| Arc::clone(&kinds[j % 3])).collect()
}

fn surface(n: usize, product: f64) -> Surrogate {
    let part = |j: usize| Some(Univariate::of_coefficients(&[1.0 + 0.1 * (j as f64).sin(), 0.03 * (j as f64).cos()]));
    let all = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k, product * ((j * k) as f64).sin())));
    let interactions = if product == 0.0 { Interactions::none(n) } else { Interactions::of_pairs(n, all) };
    Surrogate { centre: 0.0, parts: (0..n).map(part).collect(), interactions }
}

/// Name, numbers of inputs, coefficient of the products, and the inputs.
type Case = (&'static str, &'static [usize], f64, fn(usize) -> Vec<Law>);

fn law(c: &mut Criterion) {
    let made = |surrogate: &Surrogate, inputs: &[Law]| {
        SurfaceLaw::of(surrogate, inputs, None, &LawOptions::default()).expect("a law")
    };
    let cases: [Case; 3] = [
        ("sums", &[10, 100], 0.0, mixed),
        ("forms of normals", &[10, 100, 1000], 0.01, |n| vec![normal(); n]),
        ("all interactions", &[10, 100], 0.01, mixed),
    ];
    for (name, sizes, product, inputs) in cases {
        let mut group = c.benchmark_group(name);
        group.sample_size(10);
        for &n in sizes {
            let (surrogate, inputs) = (surface(n, product), inputs(n));
            group.bench_function(BenchmarkId::new("set-up", n), |b| b.iter(|| made(black_box(&surrogate), &inputs)));
            // The first limit on a contour or a set of points, and a further one that shares them.
            group.bench_function(BenchmarkId::new("first limit", n), |b| {
                b.iter_batched(
                    || made(&surrogate, &inputs),
                    |law| law.above(law.mean() + 3.0 * law.sigma()),
                    criterion::BatchSize::PerIteration,
                );
            });
            let law = made(&surrogate, &inputs);
            let y = law.mean() + 3.0 * law.sigma();
            group.bench_function(BenchmarkId::new("limit", n), |b| b.iter(|| law.above(black_box(y))));
        }
        group.finish();
    }
}

criterion_group!(benches, law);
criterion_main!(benches);
