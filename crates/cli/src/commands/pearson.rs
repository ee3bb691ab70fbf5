//! `sensitol pearson`: the Pearson system as a calculator.

use schemars::JsonSchema;
use serde::Serialize;

use crate::args::PearsonArgs;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use sensitol_numeric::pearson::Pearson;
use sensitol_report::law_text;

/// The answers, in the order of the questions.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Answers {
    #[serde(rename = "type")]
    kind: &'static str,
    mean: f64,
    sigma: f64,
    skewness: f64,
    kurtosis: f64,
    /// Null where the support does not end.
    support: [Option<f64>; 2],
    pdf: Vec<f64>,
    cdf: Vec<f64>,
    sf: Vec<f64>,
    /// Null where the quantile is infinite.
    #[schemars(with = "Vec<Option<f64>>")]
    quantile: Vec<f64>,
    #[schemars(with = "Vec<Option<f64>>")]
    upper_quantile: Vec<f64>,
}

pub(crate) fn run(asked: &PearsonArgs, look: Look) -> Result<Exit, Failure> {
    let law = Pearson::new(asked.mean, asked.sigma, asked.skewness, asked.kurtosis)?;
    let destination = Files::default().forced(asked.output.force).output_text(&asked.output)?;
    let all = |values: &[f64], of: fn(&Pearson, f64) -> f64| values.iter().map(|&value| of(&law, value)).collect();
    let answers = Answers {
        kind: law.kind().name(),
        mean: law.mean(),
        sigma: law.sigma(),
        skewness: law.skewness(),
        kurtosis: law.kurtosis(),
        support: law.support().map(|end| Some(end).filter(|end| end.is_finite())),
        pdf: all(&asked.pdf, Pearson::pdf),
        cdf: all(&asked.cdf, Pearson::cdf),
        sf: all(&asked.sf, Pearson::sf),
        quantile: all(&asked.quantile, Pearson::quantile),
        upper_quantile: all(&asked.upper_quantile, Pearson::upper_quantile),
    };
    let printed = if asked.output.json { json(&answers) } else { text(asked, &answers, &law, look) };
    destination.write(&printed)?;
    Ok(Exit::Done)
}

/// Prints a line for each requested value, or the distribution itself if none is requested.
fn text(asked: &PearsonArgs, answers: &Answers, law: &Pearson, look: Look) -> String {
    let groups = [
        ("pdf", &asked.pdf, &answers.pdf),
        ("cdf", &asked.cdf, &answers.cdf),
        ("sf", &asked.sf, &answers.sf),
        ("quantile", &asked.quantile, &answers.quantile),
        ("upper-quantile", &asked.upper_quantile, &answers.upper_quantile),
    ];
    let lines: Vec<(String, f64)> = (groups.into_iter())
        .flat_map(|(name, xs, ys)| xs.iter().zip(ys).map(move |(x, y)| (format!("{name}({x})"), *y)))
        .collect();
    if lines.is_empty() {
        return law_text(law, look.style(&asked.output));
    }
    let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    lines.iter().map(|(name, value)| format!("{name:width$}  {value:?}\n")).collect()
}
