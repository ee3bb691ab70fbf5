//! Prints the tables of STEP files and the time that each took: `cargo run --release -p sensitol-step --example describe -- part.stp`.

use std::time::Instant;

use sensitol_step::part21::EntityTable;
use sensitol_step::semantic::StepModel;
use sensitol_step::tables::{TableRequest, tables};

fn main() {
    for path in std::env::args().skip(1) {
        let start = Instant::now();
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                println!("{path}: {error}");
                continue;
            }
        };
        let read = start.elapsed();
        let found = EntityTable::read(&bytes).map_err(|error| error.to_string()).and_then(|table| {
            let scanned = start.elapsed();
            let model = StepModel::read(&table, true).map_err(|error| error.to_string())?;
            let request = TableRequest { joints: true, ..TableRequest::default() };
            let written = tables(&model, &request).map_err(|error| error.to_string())?;
            Ok((table.len(), scanned, start.elapsed(), written))
        });
        match found {
            Err(error) => println!("{path}: {error} ({:?})", start.elapsed()),
            Ok((entities, scanned, all, written)) => {
                println!("{}\n{}\n{}", written.dimensions.join("\n"), written.parts, written.joints.join("\n"));
                println!(
                    "{path}: {entities} entities, read {read:?}, scanned {scanned:?}, all {all:?}; {} tolerances, {} open",
                    written.tolerances,
                    written.open.len()
                );
            }
        }
    }
}
