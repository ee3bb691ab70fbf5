//! Whole processes: from the command line to the printed report.

use std::process::{Command, Stdio};

use criterion::{Criterion, criterion_group, criterion_main};

fn process(c: &mut Criterion) {
    let mut group = c.benchmark_group("process");
    group.sample_size(50);
    for (name, arguments) in [
        ("version", &["--version"][..]),
        ("engine-balance six-n", &["analyze", "examples/engine-balance/study.toml", "-q"]),
        ("engine-balance full", &["analyze", "examples/engine-balance/study.toml", "-q", "--method", "full"]),
        ("stacked-blocks full", &["analyze", "examples/stacked-blocks/study.toml", "-q"]),
    ] {
        group.bench_function(name, |b| {
            b.iter(|| {
                let status = Command::new(env!("CARGO_BIN_EXE_sensitol"))
                    .args(arguments)
                    .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
                    .stdout(Stdio::null())
                    .status()
                    .unwrap();
                assert!(status.success());
            });
        });
    }
    group.finish();
}

criterion_group!(benches, process);
criterion_main!(benches);
