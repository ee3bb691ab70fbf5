//! The tabular parts of a report as CSV: a header, a row per thing, numbers with full precision; unknown is an empty cell.
//!
//! RFC 4180, but for line ends without carriage return.

use super::Report;
use super::distribution::DistributionReport;
use super::stack::Stack;
use super::table::{Table, empty, number, optional, text, truth};

/// The name of a file, and what makes its table.
type Writer = (&'static str, fn(&Report) -> String);

/// The tables but for the stacks.
const TABLES: [Writer; 6] = [
    ("dimensions.csv", dimensions),
    ("characteristics.csv", characteristics),
    ("sensitivities.csv", sensitivities),
    ("interactions.csv", interactions),
    ("quantiles.csv", quantiles),
    ("warnings.csv", warnings),
];

/// Bytes of a characteristic's name in a file name, of the 255 that a file name has.
const LONGEST: usize = 100;

/// One file: its name and its text.
#[derive(Debug, Clone, PartialEq)]
pub struct CsvFile {
    /// A name that is safe on every file system, `sensitivities.csv`.
    pub name: String,
    /// The whole table.
    pub text: String,
}

/// The tables of a report: `dimensions.csv`, `characteristics.csv`, `sensitivities.csv`, `interactions.csv`, `quantiles.csv`,
/// `warnings.csv`, and `stack-NAME.csv` for every characteristic.
pub fn csv_files(report: &Report) -> Vec<CsvFile> {
    let names = csv_file_names(report.characteristics.iter().map(|one| one.name.as_str()));
    let tables = TABLES.iter().map(|(_, table)| table(report));
    let stacks = report.stacks().into_iter().map(|stack| stack_csv(&[stack]));
    names.into_iter().zip(tables.chain(stacks)).map(|(name, text)| CsvFile { name, text }).collect()
}

/// The names of the files that [`csv_files`] makes of a report on these characteristics.
pub fn csv_file_names<'n>(characteristics: impl IntoIterator<Item = &'n str>) -> Vec<String> {
    TABLES.iter().map(|(name, _)| (*name).to_owned()).chain(stack_file_names(characteristics)).collect()
}

/// `stack-NAME.csv`: letters, digits, `-`, `_` and `.` stay, everything else is `_`; names that would be the same where case does
/// not count have a number.
fn stack_file_names<'n>(characteristics: impl IntoIterator<Item = &'n str>) -> Vec<String> {
    let mut taken: Vec<String> = Vec::new();
    let safe = |c: char| if c.is_alphanumeric() || ['-', '_', '.'].contains(&c) { c } else { '_' };
    for name in characteristics {
        let kept = name.char_indices().take_while(|(at, c)| at + c.len_utf8() <= LONGEST);
        let stem: String = kept.map(|(_, c)| safe(c)).collect();
        let numbered = |number: usize| match number {
            1 => format!("stack-{stem}.csv"),
            number => format!("stack-{stem}-{number}.csv"),
        };
        let free = |name: &String| !taken.iter().any(|taken| taken.to_lowercase() == name.to_lowercase());
        let name = (1..).map(numbered).find(free).expect("numbers do not end");
        taken.push(name);
    }
    taken
}

/// The columns of a table of stacks.
const STACK: &str = "characteristic,row,name,unit,nominal,lower,upper,slope,contribution,share,from,to,within_limits";

/// Stacks as one table: dimensions and totals of every characteristic, by `row`. Of a total, `nominal` is the middle, and `lower`
/// and `upper` are its half width as deviations.
pub fn stack_csv(stacks: &[Stack]) -> String {
    let mut table = Table::new(STACK);
    stack_rows(&mut table, stacks);
    table.text
}

/// The stacks of several studies as one table, with the study's name before the columns of [`stack_csv`].
pub fn stack_csv_of_studies(studies: &[(String, Vec<Stack>)]) -> String {
    let mut table = Table::new(&format!("study,{STACK}"));
    for (study, stacks) in studies {
        table.lead(text(study));
        stack_rows(&mut table, stacks);
    }
    table.text
}

fn stack_rows(table: &mut Table, stacks: &[Stack]) {
    for stack in stacks {
        for row in &stack.rows {
            let dimension = &row.dimension;
            let [lower, upper] = row.deviations;
            table.row([
                text(&stack.characteristic),
                text("dimension"),
                text(&dimension.name),
                optional(dimension.unit.as_deref()),
                number(dimension.nominal),
                number(lower),
                number(upper),
                number(row.slope),
                number(row.contribution),
                number(row.share),
                empty(),
                empty(),
                empty(),
            ]);
        }
        for total in &stack.totals {
            let (half, interval) = (total.half_width, total.interval());
            table.row([
                text(&stack.characteristic),
                text("total"),
                text(total.kind.name()),
                optional(stack.unit.as_deref()),
                number(total.middle),
                number(half.map(|half| -half)),
                number(half),
                empty(),
                number(half),
                empty(),
                number(interval.map(|[from, _]| from)),
                number(interval.map(|[_, to]| to)),
                truth(stack.keeps(total)),
            ]);
        }
    }
}

fn dimensions(report: &Report) -> String {
    let mut table = Table::new("name,unit,nominal,lower,upper,zone,distribution,mean,sigma");
    for one in &report.dimensions {
        table.row([
            text(&one.name),
            optional(one.unit.as_deref()),
            number(one.nominal),
            number(one.tolerance.map(|[lower, _]| lower)),
            number(one.tolerance.map(|[_, upper]| upper)),
            optional(one.zone.as_deref()),
            optional(one.distribution),
            number(one.mean),
            number(one.sigma),
        ]);
    }
    table.text
}

fn characteristics(report: &Report) -> String {
    let mut table = Table::new(
        "name,unit,nominal,mean,sigma,skewness,kurtosis,worst_case_lower,worst_case_upper,middle,rss,inflated_rss,\
         mean_shift_rss,left_out_share,distribution,type,lower,upper,target_yield,met,yield,ppm_below,ppm_above,cp,cpk,\
         cp_percentile,cpk_percentile,sigma_level,normal_yield,normal_ppm_below,normal_ppm_above",
    );
    for one in &report.characteristics {
        let (family, kind) = match &one.distribution {
            None => (None, None),
            Some(DistributionReport::Point { .. }) => (Some("point"), None),
            Some(DistributionReport::Pearson { kind, .. }) => (Some("pearson"), Some(*kind)),
        };
        let normal = one.normal_fit.as_ref();
        table.row([
            text(&one.name),
            optional(one.unit.as_deref()),
            number(one.nominal),
            number(one.mean),
            number(one.sigma),
            number(one.skewness),
            number(one.kurtosis),
            number(one.worst_case.linear.map(|[lower, _]| lower)),
            number(one.worst_case.linear.map(|[_, upper]| upper)),
            number(one.middle),
            number(one.rss),
            number(one.inflated_rss),
            number(one.mean_shift_rss),
            number(one.left_out_share),
            optional(family),
            optional(kind),
            number(one.lower),
            number(one.upper),
            number(one.target_yield),
            truth(one.met),
            number(one.yield_),
            number(one.ppm_below),
            number(one.ppm_above),
            number(one.cp),
            number(one.cpk),
            number(one.cp_percentile),
            number(one.cpk_percentile),
            number(one.sigma_level),
            number(normal.and_then(|normal| normal.yield_)),
            number(normal.and_then(|normal| normal.ppm_below)),
            number(normal.and_then(|normal| normal.ppm_above)),
        ]);
    }
    table.text
}

fn sensitivities(report: &Report) -> String {
    let mut table = Table::new(
        "characteristic,dimension,first,second,linear_share,curvature_share,mean_shift,rounding_first,rounding_second",
    );
    for (one, row) in report.characteristics.iter().flat_map(|one| one.sensitivities.iter().map(move |row| (one, row)))
    {
        table.row([
            text(&one.name),
            text(&row.dimension),
            number(row.first),
            number(row.second),
            number(row.linear_share),
            number(row.curvature_share),
            number(row.mean_shift),
            number(row.rounding.map(|[first, _]| first)),
            number(row.rounding.map(|[_, second]| second)),
        ]);
    }
    table.text
}

fn interactions(report: &Report) -> String {
    let mut table = Table::new("characteristic,dimension_a,dimension_b,mixed,share,rounding");
    for (one, row) in report.characteristics.iter().flat_map(|one| one.interactions.iter().map(move |row| (one, row))) {
        let [a, b] = &row.dimensions;
        table.row([text(&one.name), text(a), text(b), number(row.mixed), number(row.share), number(row.rounding)]);
    }
    table.text
}

fn quantiles(report: &Report) -> String {
    let mut table = Table::new("characteristic,probability,value");
    for one in &report.characteristics {
        if let Some(quantiles) = one.quantiles() {
            for (probability, value) in &quantiles.0 {
                table.row([text(&one.name), text(probability), number(*value)]);
            }
        }
    }
    table.text
}

fn warnings(report: &Report) -> String {
    let mut table = Table::new("code,characteristic,dimension,message");
    for one in &report.warnings {
        let (characteristic, dimension) = (one.characteristic.as_deref(), one.dimension.as_deref());
        table.row([text(one.code), optional(characteristic), optional(dimension), text(&one.message)]);
    }
    table.text
}
