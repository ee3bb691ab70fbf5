//! Evaluations of the built-in models a second on one core; `benches/peers/numpy_models.py` has the same in numpy.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sensitol::assembly::{AssemblyFunction, Points, Request, Responses, Run};
use sensitol_models::{self, Model};

/// Model, outputs asked, and rows.
const CASES: &[(&str, &[&str], usize)] = &[
    ("engine-balance", &["F", "M"], 1 << 16),
    ("inline-engine-balance", &["F", "M"], 1 << 16),
    ("compression-clearance", &["clearance"], 1 << 16),
    ("quick-return", &["stroke", "ratio"], 1 << 16),
    ("spot-weld", &["gap", "flush1", "flush2"], 1 << 16),
    (
        "dual-mass-flywheel",
        &["n_crit_DMF", "n_crit_SMF", "dW2_1000", "A_DMF_1500", "A_SMF_1500", "A_peak_DMF"],
        1 << 16,
    ),
    ("dual-mass-flywheel", &["dW2_1000_multi"], 1 << 14),
    ("connecting-rod", &["F_comp_3000"], 1 << 12),
    ("connecting-rod", &["Fn_rod_3000"], 1 << 12),
    ("connecting-rod", &["H_req_3000"], 1 << 12),
];

fn evaluations(c: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for &(name, outputs, rows) in CASES {
        let model = name.parse::<&Model>().unwrap();
        let column = |(d, input): (usize, &sensitol_models::ModelInput)| -> Vec<f64> {
            let whole = name.starts_with("inline") && input.name == "n";
            let off = |row: usize| if whole { 0.0 } else { 1e-3 * ((row * (d + 3)) as f64).sin() };
            (0..rows).map(|row| input.nominal * (1.0 + off(row))).collect()
        };
        let columns: Vec<Vec<f64>> = model.inputs.iter().enumerate().map(column).collect();
        let points = Points::from_columns(rows, &columns);
        let asked: Vec<usize> = outputs
            .iter()
            .map(|output| model.outputs.iter().position(|known| known.name == *output).unwrap())
            .collect();
        let function = model.function();
        let mut group = c.benchmark_group(name);
        group.throughput(Throughput::Elements(rows as u64)).sample_size(10);
        group.bench_function(outputs.join("+"), |b| {
            b.iter(|| {
                let mut out = Responses::open(rows, asked.len());
                pool.install(|| {
                    function.evaluate(&Request::values(black_box(&points), &asked), &Run::to_the_end(), &mut out);
                });
                out
            });
        });
        group.finish();
    }
}

criterion_group!(benches, evaluations);
criterion_main!(benches);
