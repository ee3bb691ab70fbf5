//! Formulas on columns beside the same arithmetic in Rust.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sensitol::assembly::formula::Formula;
use sensitol::assembly::formula::set::{FormulaSet, Meaning};

const ROWS: usize = 100_000;

/// The stacked-blocks gap, written as an engineer writes it and as a programmer does.
const STACKED: &[(&str, &str)] = &[
    ("gap", "f - r - yR + (R - r)*sin(phi)"),
    ("yR", "c + e/cos(th*deg) + (a - b)*tan(th*deg) - R*sin(th*deg)*tan(th*deg)"),
    ("phi", "acos((R*sin(th*deg) + r)/(R - r))"),
];
const NAMES: [&str; 8] = ["a", "b", "c", "e", "f", "r", "R", "th"];
const NOMINAL: [f64; 8] = [10.0, 30.0, 31.9, 55.0, 75.0, 10.0, 40.0, 17.0];

fn stacked([a, b, c, e, f, r, big_r, th]: [f64; 8]) -> f64 {
    let t = th * (std::f64::consts::PI / 180.0);
    let y = c + e / t.cos() + (a - b) * t.tan() - big_r * t.sin() * t.tan();
    let phi = ((big_r * t.sin() + r) / (big_r - r)).acos();
    f - r - y + (big_r - r) * phi.sin()
}

/// A polynomial: no library functions that would hide the cost of the evaluator.
const POLYNOMIAL: &[(&str, &str)] = &[("gap", "a*b - c*e + f*f - r*R + 0.5*(a - th)^2 - 3*b*c + a*e*f")];

fn polynomial([a, b, c, e, f, r, big_r, th]: [f64; 8]) -> f64 {
    a * b - c * e + f * f - r * big_r + 0.5 * (a - th) * (a - th) - 3.0 * b * c + a * e * f
}

fn formulas(c: &mut Criterion) {
    let column = |d: usize| (0..ROWS).map(|row| NOMINAL[d] + 0.01 * ((row * (d + 3)) as f64).sin()).collect();
    let columns: Vec<Vec<f64>> = (0..8).map(column).collect();
    for (name, texts, native) in [
        ("stacked-blocks", STACKED, stacked as fn([f64; 8]) -> f64),
        ("polynomial", POLYNOMIAL, polynomial as fn([f64; 8]) -> f64),
    ] {
        let parsed = texts.iter().map(|(name, text)| ((*name).to_owned(), Formula::parse(text).unwrap())).collect();
        let names = NAMES.iter().enumerate().map(|(index, &name)| (name, Meaning::Variable(index)));
        let set = FormulaSet::new(parsed, names).unwrap();
        let mut group = c.benchmark_group(name);
        group.throughput(Throughput::Elements(ROWS as u64));
        let mut out = vec![0.0; ROWS];
        group.bench_function("formula", |b| {
            b.iter(|| set.evaluate(&[0], ROWS, |d| &columns[d], |_, row, value| out[row] = value));
        });
        group.bench_function("native", |b| {
            b.iter(|| {
                // Known at compile time in both cases: a call by pointer would be no fair match.
                let columns = black_box(&columns);
                for (row, out) in out.iter_mut().enumerate() {
                    let x = [0, 1, 2, 3, 4, 5, 6, 7].map(|d| columns[d][row]);
                    *out = if name == "polynomial" { polynomial(x) } else { stacked(x) };
                }
            });
        });
        assert!((out[7] - native([0, 1, 2, 3, 4, 5, 6, 7].map(|d| columns[d][7]))).abs() < 1e-12);
        group.finish();
    }
}

criterion_group!(benches, formulas);
criterion_main!(benches);
