//! Parsers for values of options: numbers, ranges and words.

use std::path::{Path, PathBuf};

use clap::ValueEnum;

/// Parameter of a sweep with its values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Over {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
}

/// Dimension whose nominal value may move, with its bounds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Movable {
    pub(super) name: String,
    pub(super) bounds: Option<[f64; 2]>,
}

/// Values of some dimensions at a point. All others are nominal.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Place {
    pub(super) values: Vec<(String, f64)>,
}

impl Place {
    /// Returns the values in words.
    pub(super) fn words(&self) -> String {
        if self.values.is_empty() {
            return NOMINAL.to_owned();
        }
        self.values.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
    }
}

/// Word for the nominal point.
const NOMINAL: &str = "nominal";

/// Parses `nominal`, or `NAME=VALUE` pairs that commas separate.
pub(super) fn place(text: &str) -> Result<Place, String> {
    if text.trim() == NOMINAL {
        return Ok(Place::default());
    }
    let mut values: Vec<(String, f64)> = Vec::new();
    let mut name = String::new();
    for piece in text.split(',') {
        // A piece without `=` is the beginning of a name with a comma. Names may contain `=` too, numbers cannot.
        name += piece;
        let Some((given, value)) = name.rsplit_once('=').filter(|(given, _)| !given.is_empty()) else {
            name.push(',');
            continue;
        };
        let value = finite(value).map_err(|why| format!("VALUE `{value}` of `{given}`: {why}"))?;
        if values.iter().any(|(known, _)| known == given) {
            return Err(format!("`{given}` is given twice"));
        }
        values.push((given.to_owned(), value));
        name.clear();
    }
    if !name.is_empty() {
        return Err("it is nominal, or NAME=VALUE,.. such as th=36,L=60.05".to_owned());
    }
    Ok(Place { values })
}

pub(super) fn movable(text: &str) -> Result<Movable, String> {
    let form = || "it is NAME, or NAME=LOW:HIGH, such as shoulder=14.8:15.2".to_owned();
    // Split at the last `=`: names may contain `=`, numbers cannot.
    let Some((name, range)) = text.rsplit_once('=') else {
        return Ok(Movable { name: text.to_owned(), bounds: None });
    };
    let (low, high) = range.split_once(':').filter(|_| !name.is_empty()).ok_or_else(form)?;
    let end = |what: &str, text: &str| finite(text).map_err(|why| format!("{what} `{text}`: {why}"));
    match [end("LOW", low)?, end("HIGH", high)?] {
        [low, high] if low < high => Ok(Movable { name: name.to_owned(), bounds: Some([low, high]) }),
        [low, high] => Err(format!("LOW {low} is not below HIGH {high}")),
    }
}

/// Path of a workbook that is written, or of a folder for several.
pub(super) fn workbook(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let ending = ending(&path);
    match ["xls", "xlsm", "xlsb", "ods", "csv", "html", "pdf", "json", "txt", "toml"].contains(&ending.as_str()) {
        true => Err(format!("a workbook is written as .xlsx: write {}", path.with_extension("xlsx").display())),
        false => Ok(path),
    }
}

/// Endings of other files than pages, each with the option that writes one.
const OTHER_ENDINGS: [(&str, &str); 9] = [
    ("html", "--html"),
    ("htm", "--html"),
    ("pdf", "--pdf"),
    ("json", "--json -o"),
    ("xlsx", ""),
    ("txt", "-o"),
    ("md", "-o"),
    ("csv", "--csv DIR"),
    ("toml", ""),
];

/// Path of a page in HTML, or of a folder for several.
pub(super) fn html_file(text: &str) -> Result<PathBuf, String> {
    page_file(text, "--html", "html")
}

/// Path of a printed page, or of a folder for several.
pub(super) fn pdf_file(text: &str) -> Result<PathBuf, String> {
    page_file(text, "--pdf", "pdf")
}

/// Path of a file of this ending. Fails with the right option if the ending is that of another kind.
fn page_file(text: &str, option: &str, own: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let ending = ending(&path);
    let other = OTHER_ENDINGS.iter().find(|(other, right)| *other == ending && *right != option);
    let Some((_, right)) = other else { return Ok(path) };
    let proper = path.with_extension(own);
    let instead = match *right {
        "" => String::new(),
        "--csv DIR" => ", or --csv with a folder".to_owned(),
        right => format!(", or {right} {text}"),
    };
    Err(format!("{option} writes a .{own}: write {option} {}{instead}", proper.display()))
}

/// Ending of a file in small letters.
pub(super) fn ending(path: &Path) -> String {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase()
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, |value| value.is_finite() && value > 0.0, "it must be a number above 0")
}

/// Parses a part of something, such as 0.01 or 1 %.
pub(super) fn part(text: &str) -> Result<f64, String> {
    match text.trim().strip_suffix('%') {
        Some(percent) => positive(percent).map(|percent| percent / 100.0),
        None => positive(text),
    }
}

/// Parses a count, such as 1000000 or 1e6.
pub(super) fn whole(text: &str) -> Result<u64, String> {
    /// Limit up to which every whole number is a double.
    /// Largest number of samples: counts stay exact in doubles.
    const MOST: f64 = (1u64 << 53) as f64;
    if let Ok(count) = text.trim().parse::<u64>() {
        return Ok(count);
    }
    match text.trim().parse::<f64>() {
        Ok(value) if (0.0..=MOST).contains(&value) && value.fract() == 0.0 => Ok(value as u64),
        _ => Err("it is a whole number from 0 on, such as 1000 or 1e6".to_owned()),
    }
}

/// Parses the number of points of a sample.
pub(super) fn samples(text: &str) -> Result<u64, String> {
    /// Points that a double counts exactly.
    const MOST: u64 = 1 << 52;
    match whole(text)? {
        count @ 2..=MOST => Ok(count),
        count => Err(format!("{count} is not in 2..={MOST}")),
    }
}

/// Parses the number of points of a sample, or 0 for no sample.
pub(super) fn samples_or_none(text: &str) -> Result<u64, String> {
    if whole(text)? == 0 { Ok(0) } else { samples(text) }
}

/// Parses a number of evaluations, or of points of a front.
pub(super) fn count(text: &str) -> Result<usize, String> {
    usize::try_from(whole(text)?).map_err(|_| "it is too large".to_owned())
}

pub(super) fn finite(text: &str) -> Result<f64, String> {
    number(text, f64::is_finite, "it must be a finite number")
}

pub(super) fn probability(text: &str) -> Result<f64, String> {
    number(text, |value| (0.0..=1.0).contains(&value), "a probability lies between 0 and 1")
}

fn number(text: &str, holds: fn(f64) -> bool, must: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if holds(value) => Ok(value),
        Ok(_) => Err(must.to_owned()),
        Err(_) => Err("it is not a number".to_owned()),
    }
}

/// Greatest number of values of a sweep: more are probably a typing error.
const MOST_STEPS: usize = 10_000;

pub(super) fn over(text: &str) -> Result<Over, String> {
    // Split at the last `=`: names may contain `=`, numbers cannot.
    let form = || "it is NAME=FROM:TO:STEPS, such as theta=-180:180:73".to_owned();
    let (name, range) = text.rsplit_once('=').ok_or_else(form)?;
    let parts: Vec<&str> = range.split(':').collect();
    let (&[from, to, steps], false) = (&parts[..], name.is_empty()) else { return Err(form()) };
    let end = |what: &str, text: &str| finite(text).map_err(|why| format!("{what} `{text}`: {why}"));
    let (from, to) = (end("FROM", from)?, end("TO", to)?);
    let steps: usize =
        steps.trim().parse().map_err(|_| format!("STEPS `{steps}`: it is the number of values, a whole number"))?;
    if !(2..=MOST_STEPS).contains(&steps) {
        return Err(format!("STEPS is the number of values, from 2 to {MOST_STEPS}, not {steps}"));
    }
    if from == to {
        return Err("FROM and TO are the same value; `analyze` looks at one".to_owned());
    }
    let last = (steps - 1) as f64;
    // Exact at both ends, and with little rounding error between them.
    let value = |step: usize| (from * (last - step as f64) + to * step as f64) / last;
    let values: Vec<f64> = (0..steps).map(value).collect();
    if values.iter().any(|value| !value.is_finite()) || values.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err("FROM and TO are too large, or too near to each other, for so many values".to_owned());
    }
    Ok(Over { name: name.to_owned(), values })
}

/// Registered methods as values of an option.
#[derive(Debug, Clone, Copy)]
pub(super) struct MethodArg(pub(super) sensitol::method::Method);

impl ValueEnum for MethodArg {
    fn value_variants<'a>() -> &'a [Self] {
        static VARIANTS: std::sync::LazyLock<Vec<MethodArg>> = std::sync::LazyLock::new(|| {
            sensitol::method::ALL.iter().map(|procedure| MethodArg(procedure.method())).collect()
        });
        &VARIANTS
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        let procedure = self.0.procedure();
        let help = format!("{} ({})", procedure.about(), procedure.count());
        Some(clap::builder::PossibleValue::new(procedure.name()).help(help))
    }
}

/// The relative costs as values of an option.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum CostArg {
    /// The tolerance unit of ISO 286 for the size, by the tolerance.
    ToleranceUnit,
    /// The same grade everywhere.
    ConstantPrecision,
    /// The same effect on the characteristic everywhere.
    EqualShares,
}

/// The quantity that is to be few for a cost.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum MinimiseArg {
    /// Rejected assemblies.
    Rejects,
}

/// The quantity that is to be high for a cost.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum MaximiseArg {
    /// The least Cpk.
    Cpk,
}

/// The samplers as values of an option.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum SamplerArg {
    /// Independent random points
    Random,
    /// Sobol' points, scrambled anew in each of 16 replicates
    Sobol,
}

/// The stencils as values of an option.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum StencilArg {
    /// Both up and both down, beside five-point axes
    TwoPoint,
    /// All four corners, beside three-point axes
    FourPoint,
}

/// The sources of derivatives as values of an option.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum DerivativesArg {
    /// Exact derivatives at the means, for the moments too: one evaluation, and one at the nominal values if these differ
    Exact,
    /// Differences, for the sensitivities too
    Difference,
}

/// Format of a stack-up table or a budget.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum StackArg {
    /// Text
    Text,
    /// One table of all characteristics, for spreadsheets
    Csv,
    /// Markdown, for documents
    Markdown,
}

/// Requested sensitivities, as values of an option.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum SensitivitiesArg {
    /// Dimensions that have a tolerance
    Varying,
    /// All dimensions
    All,
}
