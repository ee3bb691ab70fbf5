//! Every claim of `docs/validation.md` that can be checked has a command: it is run, the figure is taken from its report,
//! what the verdict says of the figure is tested, and the tables are written from that.
//!
//! `tests/data/published-claims.toml` has the claims. `at` names places in a report, `with` formulas of these, `holds` conditions
//! that must be true; `{name:4}` in a text is the value to four decimals.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use rayon::prelude::*;
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol_study::Study;
use serde_json::Value;
use toml::Table;

use super::command::sensitol;
use sensitol_testing::{generated, repository};

const PAGE: &str = "docs/validation.md";
/// Page of the charts, each with its command.
const CHARTS: &str = "docs/published-cases.md";
/// Allowed beginnings of a verdict, which the page explains.
const VERDICTS: [&str; 6] = ["reproduced", "explained", "refuted", "misprint", "not recoverable", "ours"];

#[test]
fn every_published_claim_is_checked_by_its_command() {
    let text = std::fs::read_to_string(repository("tests/data/published-claims.toml")).unwrap();
    let claims: Vec<Claim> = toml::from_str::<Table>(&text).unwrap()["claim"]
        .as_array()
        .unwrap()
        .iter()
        .map(|claim| Claim(claim.as_table().unwrap().clone()))
        .collect();
    let commands: BTreeSet<&str> = claims.iter().filter_map(|claim| claim.text("run")).collect();
    let commands: Vec<&str> = commands.into_iter().collect();
    let reports: BTreeMap<&str, Value> = commands.par_iter().map(|&command| (command, report(command))).collect();
    let mut tables: BTreeMap<&str, String> = BTreeMap::new();
    // The last command of each table, which the row below does not repeat.
    let mut last: BTreeMap<&str, &str> = BTreeMap::new();
    let mut wrong = Vec::new();
    for claim in &claims {
        let name = claim.text("claim").unwrap();
        let values = claim.values(&reports).unwrap_or_else(|fault| panic!("{name}: {fault}"));
        let verdict = claim.text("verdict").unwrap();
        assert!(VERDICTS.iter().any(|kind| verdict.starts_with(kind)), "{name}: {verdict}");
        let conditions = claim.list("holds");
        assert!(claim.text("run").is_none() || !conditions.is_empty(), "{name}: nothing holds the verdict");
        for condition in conditions {
            if calculated(&condition, &values) != Some(1.0) {
                wrong.push(format!("{name}: {condition} does not hold of {values:?}"));
            }
        }
        let table = tables
            .entry(claim.text("table").unwrap())
            .or_insert_with(|| "| claim | printed | ours | verdict | command |\n|---|--:|--:|---|---|\n".to_owned());
        let [ours, verdict] = ["ours", "verdict"].map(|key| filled(claim.text(key).unwrap_or("-"), &values));
        let run = match claim.text("run") {
            Some(run) if last.get(claim.text("table").unwrap()) == Some(&run) => "″".to_owned(),
            Some(run) => format!("`sensitol {run}`"),
            None => "-".to_owned(),
        };
        if let Some(run) = claim.text("run") {
            last.insert(claim.text("table").unwrap(), run);
        }
        writeln!(table, "| {name} | {} | {ours} | {verdict} | {run} |", claim.text("printed").unwrap_or("-")).unwrap();
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for (name, table) in tables {
        generated(PAGE, name, &table);
    }
    generated(PAGE, "overview", &overview(&claims));
}

/// Returns the number of claims by source and verdict. Sources stand in the order of the page, under their headings.
fn overview(claims: &[Claim]) -> String {
    let page = std::fs::read_to_string(repository(PAGE)).unwrap();
    let mut sources: Vec<&str> = Vec::new();
    for claim in claims {
        let table = claim.text("table").unwrap();
        if !sources.contains(&table) {
            sources.push(table);
        }
    }
    let place = |source: &&str| page.find(&format!("<!-- {source}: begin -->")).unwrap();
    sources.sort_by_key(place);
    let counts = |of: &dyn Fn(&Claim) -> bool| {
        let verdicts: Vec<&str> =
            claims.iter().filter(|claim| of(claim)).map(|claim| claim.text("verdict").unwrap()).collect();
        let count = |kind: &&str| verdicts.iter().filter(|verdict| verdict.starts_with(*kind)).count().to_string();
        format!("{} | {}", verdicts.len(), VERDICTS.iter().map(count).collect::<Vec<_>>().join(" | "))
    };
    let mut table =
        format!("| source | claims | {} |\n|---|{}\n", VERDICTS.join(" | "), "--:|".repeat(VERDICTS.len() + 1));
    for source in &sources {
        let heading = page[..place(source)].rsplit("\n## ").next().unwrap().lines().next().unwrap();
        let name = format!("[{heading}](#{})", super::reference::anchor(heading));
        let of = |claim: &Claim| claim.text("table") == Some(source);
        writeln!(table, "| {name} | {} |", counts(&of)).unwrap();
    }
    writeln!(table, "| all | {} |", counts(&|_| true)).unwrap();
    table
}

struct Claim(Table);

impl Claim {
    fn text(&self, key: &str) -> Option<&str> {
        self.0.get(key)?.as_str()
    }

    fn list(&self, key: &str) -> Vec<String> {
        let list = self.0.get(key).and_then(|list| list.as_array().cloned()).unwrap_or_default();
        list.iter().map(|entry| entry.as_str().unwrap().to_owned()).collect()
    }

    fn table(&self, key: &str) -> Vec<(String, String)> {
        let table = self.0.get(key).and_then(|table| table.as_table().cloned()).unwrap_or_default();
        table.iter().map(|(name, value)| (name.clone(), value.as_str().unwrap().to_owned())).collect()
    }

    fn values(&self, reports: &BTreeMap<&str, Value>) -> Result<Vec<(String, f64)>, String> {
        let mut values = Vec::new();
        for (name, place) in self.table("at") {
            let value = found(&reports[self.text("run").ok_or("no command")?], &place).ok_or(place)?;
            values.push((name, value));
        }
        for (name, formula) in self.table("with") {
            let value = calculated(&formula, &values).ok_or(formula)?;
            values.push((name, value));
        }
        Ok(values)
    }
}

fn report(command: &str) -> Value {
    let arguments: Vec<&str> = command.split_whitespace().chain(["--json", "-q"]).collect();
    let output = sensitol(&arguments).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("sensitol {command}: {error}"))
}

/// Returns the number at a place such as `F/sensitivities/R/first`. `H_req#5/nominal` is at the value 5 of a sweep, `@correlation/R/X` is
/// the correlation of two characteristics, and `@report/cost_after` starts at the root of the report.
fn found(report: &Value, place: &str) -> Option<f64> {
    if let Some(pair) = place.strip_prefix("@correlation/") {
        let between: Vec<&str> = pair.split('/').collect();
        let pairs = report["characteristic_correlation"].as_array()?;
        return pairs.iter().find(|pair| pair["between"] == serde_json::json!(between))?["value"].as_f64();
    }
    let (mut at, place) = match place.strip_prefix("@report/") {
        Some(place) => (report, place),
        None => (&report["characteristics"], place),
    };
    for part in place.split('/') {
        let (part, value) = part.split_once('#').map_or((part, None), |(name, value)| (name, Some(value)));
        at = match at {
            Value::Array(entries) => entries
                .iter()
                .find(|entry| entry["name"] == part || entry["dimension"] == part)
                .or_else(|| part.parse::<usize>().ok().and_then(|index| entries.get(index)))?,
            other => other.get(part)?,
        };
        if let Some(value) = value {
            let value: f64 = value.parse().ok()?;
            // Values of a sweep have rounding errors.
            let close =
                |point: &&Value| point["at"].as_f64().is_some_and(|at| (at - value).abs() <= 1e-9 * value.abs());
            at = at["points"].as_array()?.iter().find(close)?;
        }
    }
    at.as_f64()
}

/// Evaluates a formula of values with sensitol itself.
fn calculated(formula: &str, values: &[(String, f64)]) -> Option<f64> {
    let constants: String = values.iter().map(|(name, value)| format!("{name} = {value:e}\n")).collect();
    let text = format!(
        "[dimensions]\nnothing = {{ nominal = 0, tolerance = 1 }}\n[constants]\n{constants}\n\
         [characteristics]\nvalue = {{ formula = \"{formula}\" }}\n"
    );
    let study = Study::from_toml(&text, "claim.toml").ok()?;
    let (points, mut out) = (Points::from_rows(&[vec![0.0]]), Responses::open(1, 1));
    study.problem.function().evaluate(&Request::values(&points, &[0]), &Run::default(), &mut out);
    out.value(0, 0)
}

/// Fills values into a text.
fn filled(text: &str, values: &[(String, f64)]) -> String {
    let mut parts = text.split('{');
    let mut filled = parts.next().unwrap().to_owned();
    for part in parts {
        let (field, rest) = part.split_once('}').unwrap_or_else(|| panic!("{text}: no closing brace"));
        let (name, decimals) = field.split_once(':').unwrap_or((field, "0"));
        let value = values.iter().find(|(known, _)| known == name).unwrap_or_else(|| panic!("{text}: no {name}")).1;
        write!(filled, "{value:.*}{rest}", decimals.parse::<usize>().unwrap()).unwrap();
    }
    filled
}

/// Charts of the page equal the output of their commands: `sensitol ... --svg docs/figures/NAME.svg` stands with each.
#[test]
fn charts_are_drawn_by_their_commands() {
    let page = std::fs::read_to_string(repository(CHARTS)).unwrap();
    let commands: Vec<&str> = page.split('`').filter(|text| text.contains("--svg docs/figures/")).collect();
    let drawn: BTreeSet<String> = commands.par_iter().map(|command| drawn(command)).collect();
    let files = std::fs::read_dir(repository("docs/figures")).unwrap();
    let files: BTreeSet<String> = files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(drawn, files, "every chart has a command");
}

fn drawn(command: &str) -> String {
    let (arguments, file) = command.split_once(" --svg ").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let new = folder.path().join("chart.svg");
    let arguments: Vec<&str> = arguments.split_whitespace().skip(1).collect();
    let output = sensitol(&[&arguments[..], &["-q", "--svg", new.to_str().unwrap()]].concat()).output().unwrap();
    assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    let new = std::fs::read_to_string(new).unwrap();
    if std::env::var_os("SENSITOL_UPDATE_DOCS").is_some() {
        std::fs::write(repository(file), &new).unwrap();
    }
    assert!(std::fs::read_to_string(repository(file)).unwrap_or_default() == new, "{file}: {command} draws it anew");
    file.rsplit('/').next().unwrap().to_owned()
}
