//! The arguments of the command line.

pub(crate) mod import_args;
pub(crate) mod init_args;
pub(crate) mod lot_args;
pub(crate) mod page_args;
pub(crate) mod sampled_args;
pub(crate) mod shared_args;

use std::path::PathBuf;

use clap::{Args, ColorChoice, Parser, Subcommand};

use crate::args::import_args::ImportArgs;
pub(super) use crate::args::init_args::InitArgs;
pub(super) use crate::args::lot_args::CompareLotArgs;
pub(super) use crate::args::page_args::{ServeArgs, WorkbenchArgs};
pub(super) use crate::args::sampled_args::{CompareArgs, MergeArgs, SampleReportArgs, SampledArgs, SimulateArgs};
use crate::args::shared_args::OUTPUT;
pub(super) use crate::args::shared_args::{HowArgs, OutputArgs, StudyArgs, WorkArgs};
use crate::commands::examples::ExamplesArgs;
use crate::commands::journal::JournalArgs;
use crate::table::TableArgs;
pub(super) use crate::values::{
    CostArg, DerivativesArg, MaximiseArg, MinimiseArg, Over, Place, SamplerArg, SensitivitiesArg, StackArg, StencilArg,
};
use crate::values::{
    Movable, count, finite, html_file, movable, over, pdf_file, place, positive, probability, samples_or_none, whole,
    workbook,
};

/// The program in one sentence, as in the README.
const ABOUT: &str = "Statistical tolerance analysis for anything you can compute: a formula, a spreadsheet, a CAD model, your own code.";

/// The command line.
#[derive(Debug, Parser)]
#[command(name = "sensitol", version, about = ABOUT, max_term_width = 100, subcommand_required = true)]
#[command(after_help = "Examples:\n  sensitol init gap && sensitol analyze gap.toml")]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,

    /// Print no warnings
    #[arg(short, long, global = true, help_heading = OUTPUT)]
    pub(super) quiet: bool,

    /// Print all contributions and interactions, and the stderr of an external model
    #[arg(short, long, global = true, help_heading = OUTPUT)]
    pub(super) verbose: bool,

    /// Use of colours; `never` prints plain ASCII too
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto", help_heading = OUTPUT)]
    pub(super) color: ColorChoice,

    /// Print results and errors as JSON on stdout
    #[arg(long, global = true, help_heading = OUTPUT)]
    pub(super) json: bool,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Yield, contributors and moments of every characteristic
    ///
    /// Several studies are analysed one after another, each with its own --budget and --time. If one fails, the others are still analysed.
    /// The exit code is the worst of all: 130 interrupted, 2 an error, 3 a characteristic without result, 1 a target missed, 0 done. With
    /// --json they are one array, in the order given.
    #[command(
        after_help = "Examples:\n  sensitol analyze examples/engine-balance/study.toml --method full\n  sensitol analyze examples/first-study/study.toml examples/first-study/tighter.toml --check\n  sensitol analyze stack-up.xlsx --lower 0.2 --upper 0.8 --html gap.html"
    )]
    Analyze(AnalyzeArgs),
    /// Monte Carlo: the model itself at random points, with standard errors
    #[command(
        after_help = "Examples:\n  sensitol simulate examples/engine-balance/study.toml --samples 1000000\n  sensitol simulate examples/first-study/study.toml --rare\n  sensitol simulate examples/ishigami/study.toml --sobol"
    )]
    Simulate(SimulateArgs),
    /// Figures of a sample from the shards of several processes
    ///
    /// Each process draws its own points by `sensitol simulate --shards K --shard k -o FILE`. The points of all shards are those of one run
    /// with the same seed. A shard that is missing is an error, and one that is given twice counts once.
    #[command(after_help = "Examples:\n  sensitol merge examples/first-study/study.toml shard-*.json --html page.html")]
    Merge(MergeArgs),
    /// Speed and accuracy of every suitable method against a reference
    #[command(after_help = "Examples:\n  sensitol compare examples/stacked-blocks/study.toml --svg trade.svg")]
    Compare(CompareArgs),
    /// A measured lot against the study: parts, assemblies, and causes of their difference
    #[command(
        after_help = "Examples:\n  sensitol compare-lot examples/housing-lot/study.toml examples/housing-lot/parts.csv examples/housing-lot/assemblies.csv --html lot.html"
    )]
    CompareLot(CompareLotArgs),
    /// Mean and quantile band along a parameter
    #[command(
        after_help = "Examples:\n  sensitol sweep examples/connecting-rod/crank-angle.toml --over theta=-180:180:73 --svg band.svg"
    )]
    Sweep(SweepArgs),
    /// The cheapest tolerances that keep the requirements
    ///
    /// Costs are given in [costs], requirements by target_yield or require of the characteristics. Method auto stands for full, and above
    /// twenty dimensions for six-n.
    #[command(
        after_help = "Examples:\n  sensitol allocate examples/shaft-and-housing/study.toml --write cheaper.toml\n  sensitol allocate examples/first-study/study.toml --confirm 100000"
    )]
    Allocate(AllocateArgs),
    /// Lists the evaluations of an analysis, and why; evaluates nothing
    #[command(after_help = "Examples:\n  sensitol plan examples/engine-balance/study.toml --write-points points.csv")]
    Plan(PlanArgs),
    /// Validates studies; evaluates nothing
    ///
    /// Nothing is evaluated or executed. Each study is validated, even if another has errors; any error gives exit code 2. Errors have
    /// line, column and advice with --json; several studies give one array.
    #[command(
        after_help = "Examples:\n  sensitol check examples/stacked-blocks/study.toml\n  sensitol check examples/stacked-blocks/study.toml examples/engine-balance/study.toml"
    )]
    Check(CheckArgs),
    /// Prints a study with every short form written out
    ///
    /// A relative dimension becomes an absolute one and a formula. Each such entry names its origin. The printed study gives the same
    /// numbers.
    #[command(after_help = "Examples:\n  sensitol expand examples/first-study/study.toml")]
    Expand(ExpandArgs),
    /// The built-in models, with their inputs and outputs
    #[command(after_help = "Examples:\n  sensitol models engine-balance")]
    Models(ModelsArgs),
    /// Writes a commented study that runs as it is
    #[command(
        after_help = "Examples:\n  sensitol init gap && sensitol analyze gap.toml\n  sensitol init pattern --position && sensitol analyze pattern.toml\n  sensitol init balance --model engine-balance"
    )]
    Init(InitArgs),
    /// Analyses a study again at each save
    ///
    /// Each save gives the line of `analyze --brief` for every characteristic and the difference from the last result. Files that the study
    /// reads are watched too. An error in the study is printed, and watching continues until Ctrl-C, which ends it with exit code 0.
    #[command(after_help = "Examples:\n  sensitol watch examples/first-study/study.toml")]
    Watch(WatchArgs),
    /// Makes a study of a stack-up table, in English or German
    ///
    /// Each dimension has a row. The first row names the columns: name and nominal are needed; direction or factor, tolerance or
    /// deviations, unit, distribution, part and description are optional. Numbers have decimal points or commas.
    #[command(
        after_help = "Examples:\n  sensitol import stack.csv -o stack.toml\n  sensitol import stack.csv --column nominal=Wert --name play\n  sensitol import stack-up.xlsx --sheet Stack --lower 0.2 --upper 0.8 -o stack.toml"
    )]
    Import(ImportArgs),
    /// Writes a page that edits and analyses studies, offline
    ///
    /// The page holds the engine: it opens from disk and sends nothing anywhere. It is not part of every build: web/build makes it, and
    /// this command looks for it beside the program, where the variable SENSITOL_WORKBENCH says, or where --page does.
    #[command(
        after_help = "Examples:\n  sensitol workbench\n  sensitol workbench examples/first-study/study.toml -o first-study.html"
    )]
    Workbench(WorkbenchArgs),
    /// The workbench over a folder of studies, in a browser
    ///
    /// The page opens and saves studies of the folder, shows a file again when it changes, and runs external models. It is reached by the
    /// address that is printed, from this machine alone. It reads and writes nothing outside the folder. A program that a study names
    /// starts when the user requests a result, and has the rights of the user.
    #[command(after_help = "Examples:\n  sensitol serve\n  sensitol serve examples/external-python --port 8080")]
    Serve(ServeArgs),
    /// The examples of the documentation, to begin from
    #[command(after_help = "Examples:\n  sensitol examples\n  sensitol examples copy engine-balance")]
    Examples(ExamplesArgs),
    /// The JSON Schema of study files, or of reports
    #[command(
        after_help = "Examples:\n  sensitol schema -o study.schema.json\n  sensitol schema --report -o report.schema.json"
    )]
    Schema(SchemaArgs),
    /// The Pearson distribution of four moments
    #[command(
        after_help = "Examples:\n  sensitol pearson --skewness 0.5 --kurtosis 3.4 --sf 4 --upper-quantile 1e-6,1e-9"
    )]
    Pearson(PearsonArgs),
    /// Completions for a shell
    #[command(
        after_help = "Examples:\n  sensitol completions bash > ~/.local/share/bash-completion/completions/sensitol"
    )]
    Completions(CompletionsArgs),
    /// The manual page
    #[command(after_help = "Examples:\n  sensitol man | man -l -")]
    Man,
    /// Checks an external model: protocol, noise, speed, least step
    #[command(after_help = "Examples:\n  sensitol probe examples/external-python/study.toml")]
    Probe(ProbeArgs),
    /// Answers points of a study, as an external model does
    ///
    /// Reads requests from stdin and writes the values of the characteristics to stdout. The study then is the model of another
    /// study, of a UM-Bridge client or of workers on a cluster. With --at, --json or --output it reports the values at points instead, and the
    /// poses of the parts of an assembly in space.
    #[command(
        after_help = "Examples:\n  sensitol evaluate examples/stacked-blocks/study.toml\n  sensitol evaluate examples/crank-slider-space/study.toml --at th=36,L=60.05 --at nominal"
    )]
    Evaluate(EvaluateArgs),
    /// Show, export or forget the kept answers of external models
    #[command(after_help = "Examples:\n  sensitol journal show gap.journal.sqlite")]
    Journal(JournalArgs),
}

/// A study and how it is to be analysed.
#[derive(Debug, Args)]
pub(super) struct AnalyzeArgs {
    /// Studies, .toml or .json, or stack-up tables, .xlsx, .csv or .tsv; each is analysed
    #[arg(value_name = "STUDY", required = true)]
    pub(super) studies: Vec<PathBuf>,

    #[command(flatten)]
    pub(super) how: HowArgs,

    #[command(flatten)]
    pub(super) work: WorkArgs,

    /// Take the answers of an external model from a CSV file: a column for every dimension and every characteristic
    #[arg(long, value_name = "FILE.csv", conflicts_with = "journal")]
    pub(super) points: Option<PathBuf>,

    /// Write the points of the next stage that have no answer in the file of --points, as plan --write-points does
    #[arg(long, value_name = "FILE.csv", requires = "points", help_heading = OUTPUT, hide_short_help = true)]
    pub(super) write_missing: Option<PathBuf>,

    /// Check every figure at points of the model: a sample of a formula, or at most N points of an external model; 0 for none
    #[arg(long, value_name = "N", value_parser = count, num_args = 0..=1, default_missing_value = "64")]
    pub(super) verify: Option<usize>,

    /// Search the true worst case within the tolerance bands too: some 2N evaluations or more of N dimensions for each end
    #[arg(long, conflicts_with = "points")]
    pub(super) extremes: bool,

    /// Show the table of all characteristics only
    #[arg(long, conflicts_with_all = ["json", "stack"], help_heading = OUTPUT, hide_short_help = true)]
    pub(super) summary: bool,

    /// Print one line for every characteristic: yield, verdict, contributors
    #[arg(long, conflicts_with_all = ["json", "stack", "gum", "summary", "compare"], help_heading = OUTPUT)]
    pub(super) brief: bool,

    /// Show the changes from the first study to the second: inputs, results, contributions; --check judges the second
    #[arg(long, conflicts_with_all = ["points", "stack", "summary"], help_heading = OUTPUT)]
    pub(super) compare: bool,

    /// Print the stack-up table of every characteristic instead of the report: text, csv or markdown
    #[arg(long, value_name = "FORMAT", conflicts_with = "json", help_heading = OUTPUT)]
    pub(super) stack: Option<StackArg>,

    /// Print the budget of measurement uncertainty of every characteristic instead of the report: text, csv or markdown
    #[arg(long, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "text", conflicts_with_all = ["json", "stack", "summary", "compare"], help_heading = OUTPUT)]
    pub(super) gum: Option<StackArg>,

    /// Write the report as one HTML page; several studies: a folder of pages
    ///
    /// Write the report as one HTML page, in which other tolerances can be tried; several studies: a folder of pages, STUDY.html
    #[arg(long, value_name = "FILE.html", value_parser = html_file, help_heading = OUTPUT)]
    pub(super) html: Option<PathBuf>,

    /// Print that page by an installed Chromium; several studies: a folder
    ///
    /// Print that page to a PDF by an installed Chromium: SENSITOL_CHROMIUM, or chromium, chromium-browser or google-chrome on PATH. The
    /// paper is that of the locale, A4 or Letter; several studies: a folder, STUDY.pdf
    #[arg(long, value_name = "FILE.pdf", value_parser = pdf_file, help_heading = OUTPUT)]
    pub(super) pdf: Option<PathBuf>,

    /// Write the tables of the report as CSV files into DIR, which is created if missing; several studies: into DIR/STUDY
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub(super) csv: Option<PathBuf>,

    /// Write the report as a workbook: the stack with live formulas, results, contributions and inputs; several studies: a folder, STUDY.xlsx
    #[arg(long, value_name = "FILE.xlsx", value_parser = workbook, conflicts_with = "compare", help_heading = OUTPUT)]
    pub(super) xlsx: Option<PathBuf>,

    /// Exit with 1 when a requirement is missed or inconclusive
    #[arg(long)]
    pub(super) check: bool,

    /// Exit with 3 when a requirement is met by the surface only, and not by proof or by points of the model
    #[arg(long, requires = "check", hide_short_help = true)]
    pub(super) strict: bool,

    /// Seed of random numbers, for the methods that draw some; kept in the report
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true, hide_short_help = true)]
    pub(super) seed: Option<u64>,

    /// Threads that evaluate formulas and built-in models [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    pub(super) threads: Option<u16>,

    #[command(flatten)]
    pub(super) table: TableArgs,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(super) struct SweepArgs {
    #[command(flatten)]
    pub(super) study: StudyArgs,

    /// The parameter and its values, both ends included: a dimension, whose tolerance is kept, a constant, or an input of the built-in model
    #[arg(long, value_name = "NAME=FROM:TO:STEPS", value_parser = over)]
    pub(super) over: Over,

    #[command(flatten)]
    pub(super) work: WorkArgs,

    /// Seed of random numbers, for the methods that draw some; kept in the report
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    pub(super) seed: Option<u64>,

    /// Threads that evaluate formulas and built-in models [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    pub(super) threads: Option<u16>,

    /// Write the report as one HTML page
    #[arg(long, value_name = "FILE.html", value_parser = html_file, help_heading = OUTPUT)]
    pub(super) html: Option<PathBuf>,

    /// Print that page to a PDF by an installed Chromium
    #[arg(long, value_name = "FILE.pdf", value_parser = pdf_file, help_heading = OUTPUT)]
    pub(super) pdf: Option<PathBuf>,

    /// Write the table as sweep.csv into DIR, which is created if missing
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub(super) csv: Option<PathBuf>,

    /// Draw mean and band over the parameter
    #[arg(long, value_name = "FILE.svg", help_heading = OUTPUT)]
    pub(super) svg: Option<PathBuf>,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(super) struct AllocateArgs {
    #[command(flatten)]
    pub(super) study: StudyArgs,

    /// Move the nominal values of these dimensions too: to the least cost together with the tolerances, or without costs to the fewest
    /// rejects. With bounds: DIM=LOW:HIGH
    #[arg(long, value_name = "DIM,..", value_delimiter = ',', value_parser = movable)]
    pub(super) recentre: Vec<Movable>,

    /// A relative cost for every tolerance, in place of the costs of the study [default: tolerance-unit if the study has no costs]
    #[arg(long, value_name = "BASIS")]
    pub(super) cost: Option<CostArg>,

    /// Find the fewest rejects within --cost-limit, in place of the least cost
    #[arg(long, value_name = "WHAT", requires = "cost_limit", conflicts_with_all = ["maximise", "front", "svg"])]
    pub(super) minimise: Option<MinimiseArg>,

    /// Find the highest Cpk within --cost-limit, in place of the least cost
    #[arg(long, value_name = "WHAT", requires = "cost_limit", conflicts_with_all = ["front", "svg"])]
    pub(super) maximise: Option<MaximiseArg>,

    /// Greatest total cost of all tolerances, with --minimise or --maximise
    #[arg(long, value_name = "COST", value_parser = positive, allow_negative_numbers = true)]
    pub(super) cost_limit: Option<f64>,

    /// The Pareto front of cost against the requirements, in N points
    #[arg(long = "pareto", alias = "front", value_name = "N", value_parser = count, allow_negative_numbers = true)]
    pub(super) front: Option<usize>,

    /// Confirm the tolerances found by Monte Carlo: N points of the model, 0 for none [default: 100000 of a formula or a built-in
    /// model, none of an external one]
    #[arg(long, value_name = "N", value_parser = samples_or_none, allow_negative_numbers = true)]
    pub(super) confirm: Option<u64>,

    #[command(flatten)]
    pub(super) work: WorkArgs,

    /// Seed of the random numbers [default: that of the study, or 1]
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true, hide_short_help = true)]
    pub(super) seed: Option<u64>,

    /// Threads that evaluate formulas and built-in models [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    pub(super) threads: Option<u16>,

    /// Write the study with the tolerances found; nothing else changes
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub(super) write: Option<PathBuf>,

    /// Write the report as one HTML page
    #[arg(long, value_name = "FILE.html", value_parser = html_file, help_heading = OUTPUT)]
    pub(super) html: Option<PathBuf>,

    /// Print that page to a PDF by an installed Chromium
    #[arg(long, value_name = "FILE.pdf", value_parser = pdf_file, help_heading = OUTPUT, hide_short_help = true)]
    pub(super) pdf: Option<PathBuf>,

    /// Write tolerances, requirements and front as CSV files into DIR, which is created if missing
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub(super) csv: Option<PathBuf>,

    /// Draw the front
    #[arg(long, value_name = "FILE.svg", help_heading = OUTPUT, hide_short_help = true)]
    pub(super) svg: Option<PathBuf>,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}

/// A study that is analysed again at each save.
#[derive(Debug, Args)]
pub(super) struct WatchArgs {
    #[command(flatten)]
    pub(super) study: StudyArgs,

    #[command(flatten)]
    pub(super) work: WorkArgs,

    /// Threads that evaluate formulas and built-in models [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    pub(super) threads: Option<u16>,
}

#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// The shell
    pub(super) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(super) struct PlanArgs {
    #[command(flatten)]
    pub(super) study: StudyArgs,

    /// Write the points of the first stage to a CSV file
    #[arg(long, value_name = "FILE.csv")]
    pub(super) write_points: Option<PathBuf>,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// The study, a .toml or .json file; several are checked one after another
    #[arg(value_name = "STUDY", required = true)]
    pub(super) studies: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(super) struct ExpandArgs {
    /// The study, a .toml or .json file
    pub(super) study: PathBuf,

    /// Use this configuration of the study
    #[arg(long, value_name = "NAME")]
    pub(super) configuration: Option<String>,
}

#[derive(Debug, Args)]
pub(super) struct ModelsArgs {
    /// The model to describe
    pub(super) name: Option<String>,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(super) struct SchemaArgs {
    /// The JSON Schema of reports (--json), instead of that of study files
    #[arg(long)]
    pub(super) report: bool,

    /// Write to a file instead of stdout
    #[arg(short, long, value_name = "FILE", help_heading = OUTPUT)]
    pub(super) output: Option<PathBuf>,

    /// Write over a file that sensitol did not write
    #[arg(long, help_heading = OUTPUT)]
    pub(super) force: bool,
}

#[derive(Debug, Args)]
pub(super) struct ProbeArgs {
    #[command(flatten)]
    pub(super) study: StudyArgs,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(super) struct EvaluateArgs {
    /// The study, a .toml or .json file
    pub(super) study: PathBuf,

    /// Report the values and poses at this point, with all other dimensions nominal; `nominal` for the nominal point (repeatable)
    #[arg(long, value_name = "DIM=VALUE,..", value_parser = place)]
    pub(super) at: Vec<Place>,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}

impl EvaluateArgs {
    /// True if a report is requested, and not the protocol.
    pub(super) fn reports(&self) -> bool {
        !self.at.is_empty() || self.output.json || self.output.output.is_some()
    }
}

#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct PearsonArgs {
    /// Third standardised moment
    #[arg(long, value_name = "G", value_parser = finite)]
    pub(super) skewness: f64,

    /// Fourth standardised moment, 3 for a normal; above 1 + skewness^2
    #[arg(long, value_name = "B", value_parser = finite)]
    pub(super) kurtosis: f64,

    /// First moment
    #[arg(long, value_name = "M", value_parser = finite, default_value = "0")]
    pub(super) mean: f64,

    /// Standard deviation
    #[arg(long, value_name = "S", value_parser = positive, default_value = "1")]
    pub(super) sigma: f64,

    /// Densities at these values
    #[arg(long, value_name = "X,..", value_parser = finite, value_delimiter = ',', allow_hyphen_values = true)]
    pub(super) pdf: Vec<f64>,

    /// Probabilities below these values
    #[arg(long, value_name = "X,..", value_parser = finite, value_delimiter = ',', allow_hyphen_values = true)]
    pub(super) cdf: Vec<f64>,

    /// Probabilities above these values
    #[arg(long, value_name = "X,..", value_parser = finite, value_delimiter = ',', allow_hyphen_values = true)]
    pub(super) sf: Vec<f64>,

    /// Values below which these probabilities lie
    #[arg(long, value_name = "P,..", value_parser = probability, value_delimiter = ',')]
    pub(super) quantile: Vec<f64>,

    /// Values above which these probabilities lie
    #[arg(long, value_name = "P,..", value_parser = probability, value_delimiter = ',')]
    pub(super) upper_quantile: Vec<f64>,

    #[command(flatten)]
    pub(super) output: OutputArgs,
}
