//! Counts.
use super::files::bytes;
use sensitol_step::part21::EntityTable;
use sensitol_step::semantic::{StepModel};

#[test]
fn dump() {
    let paths: Vec<String> = std::env::var("STP").unwrap_or_default().split_whitespace().map(str::to_owned).collect();
    for path in paths {
        let bytes = std::fs::read(&path).unwrap();
        let start = std::time::Instant::now();
        let table = match EntityTable::read(&bytes) { Ok(t)=>t, Err(e)=>{println!("{path}: {e}"); continue}};
        let scanned = start.elapsed();
        let model = match StepModel::read(&table, true) { Ok(t)=>t, Err(e)=>{println!("{path}: {e}"); continue}};
        let read = start.elapsed();
        println!("{path}: {} entities {scanned:?} {read:?} parts {} placed {} annotations {}", table.len(), model.parts.len(), model.placed.len(), model.annotations);
        for part in &model.parts {
            let dims = &part.dimensions;
            let mut by = std::collections::BTreeMap::new();
            part.tolerances.iter().for_each(|t| *by.entry(t.kind).or_insert(0) += 1);
            println!("  {} {:?} faces {} dims {} {} {} tols {} complete {} {by:?} datums {} with feature {}", part.name, part.unit.name(), part.faces.len(), dims.len(), dims.iter().filter(|d| d.value.is_some()).count(), dims.iter().filter(|d| d.has_plus_minus).count(), part.tolerances.len(), part.tolerances.iter().filter(|t| t.is_complete()).count(), part.datums.len(), part.datums.iter().filter(|d| !d.faces.is_empty() || !d.targets.is_empty()).count());
            for t in part.tolerances.iter().filter(|t| !t.is_complete()) { println!("    {t:?}"); }
            if std::env::var("V").is_ok() {
                for t in &part.tolerances { println!("    #{} {:?} {:?} {:?} {:?} {:?} {:?} {} faces {:?} {}", t.entity, t.kind, t.value.map(|v| (v.value, v.unit.name())), t.condition, t.modifiers, t.zone, t.extra, t.faces.len(), t.datums.iter().map(|d| d.letters.join("-")+&d.modifiers.join(" ")).collect::<Vec<_>>().join("|"), t.name); }
                for t in &part.dimensions { println!("    #{} {} {:?} {:?} {:?} ends {:?}", t.entity, t.name, t.kind, t.value.map(|v| (v.value, v.unit.name())), t.limits, t.ends.iter().map(Vec::len).collect::<Vec<_>>()); }
                for t in &part.datums { println!("    {t:?}"); }
            }
        }
        for p in model.placed.iter().take(8) { println!("   {p:?}"); }
    }
    let _ = bytes;
}
