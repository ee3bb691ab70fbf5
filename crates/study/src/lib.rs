//! Study files: an assembly and its characteristics in TOML or JSON.
//!
//! One set of types describes both formats. Everything that is wrong is a [`StudyError`] with file, line, column, key and
//! what to write instead; the first one found is reported.
//!
//! # Distributions
//! `distribution = "uniform"`, or a table with parameters, such as `{ kind = "beta", alpha = 2, beta = 5 }`:
//!
//! | kind | mean and sigma | parameters |
//! |---|---|---|
//! | `normal` | the band's middle plus `shift`; `sigma`, or half the band by `sigmas` (3) or `cp` (1), alone or beside `cpk`; lots with a `drift` | |
//! | `truncated-normal` | the same before the cut at the band; both follow | |
//! | `uniform`, `two-point` | follow from the band: alike everywhere in it, or at one of its ends | |
//! | `triangular` | follow from the band | `mode`: a value within the band, its middle by default |
//! | `trapezoidal` | follow from the band | `top`: the share of the band over which it is flat |
//! | `beta` | follow from the band | `alpha`, `beta`: the exponents at the lower and the upper end |
//! | `arcsine`, `u-shaped` | follow from the band | |
//! | `curvilinear-trapezoid` | follow from the band and its inexactness | `inexactness`: by how much the ends of the band may be off |
//! | `student` | the band's middle plus `shift`; `sigma`, half the band by `sigmas` or `cp`, or `scale` | `degrees`: above 2; `scale`: sigma is `scale sqrt(degrees/(degrees - 2))` |
//! | `lognormal`, `gamma`, `weibull` | nominal plus `shift`; `sigma`, or half the band by `sigmas` or `cp` | `origin`: where it begins, 0 by default |
//! | `exponential`, `rayleigh` | nominal plus `shift`; sigma follows from mean and origin | `origin` |
//! | `mixture` | follow from the parts | `parts`: tables by name |
//! | `tabulated` | follow from the table | `scores`, `values`: quantiles over normal scores, both ascending |
//!
//! A part of a mixture has a `weight` (relative to the others') and `nominal`, `tolerance` or `limits`, `sigma`, `sigmas`, `cp`,
//! `shift` and `distribution` as a dimension has; nominal and band are the dimension's where the part gives none:
//!
//! ```
//! use sensitol_study::Study;
//! let study = Study::from_toml(
//!     r#"
//!     [dimensions]
//!     bore = { nominal = 25, tolerance = 0.03, distribution = { kind = "mixture", parts = { north = { weight = 3 }, south = { weight = 1, shift = 0.02 } } } }
//!     [characteristics]
//!     radius = { formula = "bore/2" }
//!     "#,
//!     "bore.toml",
//! )?;
//! assert!((study.problem.dimensions()[0].mean() - 25.005).abs() < 1e-12);
//! # Ok::<(), sensitol_study::StudyError>(())
//! ```

mod about;
mod analysis_entry;
mod any_error;
mod build;
mod changed;
mod conventions;
mod correlation;
mod costs;
mod data;
mod de;
mod decimal;
mod dimension;
mod distribution_entry;
mod drive;
mod entries;
mod error;
mod expand;
mod externals;
mod file;
mod files;
mod grades;
mod guard;
mod implicit;
pub mod import;
mod inspected;
mod joint;
mod labels;
mod lines;
mod loss;
mod model;
mod named_values;
mod options;
mod place;
mod price;
#[cfg(feature = "schema")]
mod registry;
mod remedy;
mod rewrite;
#[cfg(feature = "schema")]
pub mod schema;
mod slip;
mod source;
mod spanned;
mod states;
mod sweep;
pub mod table;
mod together;
mod tree;
mod units;
mod values;
mod words;
pub mod write;
mod written;
mod zone;

pub use any_error::Error;
pub use data::{DataFault, DataProblem};
pub use error::{StudyError, StudyFault};
use externals::Host;
pub use externals::{Externals, JournalPlace};
pub use files::{FileRole, NamedFile};
pub use place::Format;
pub use place::StudyText;
pub use rewrite::{RewriteError, Rewritten};
#[cfg(feature = "schema")]
pub use schema::schema;
pub use slip::Slip;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use error::Faults;
use place::Place;
use sensitol::allocation::{AllocationTask, Priced, QualityLoss, SetUp};
use sensitol::method::Options;
use sensitol::problem::Problem;
use sensitol::warning::Warning;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::requirement::Requirement;
use source::Source;
use tree::Tree;

/// A study: a problem, how it is to be analysed, and what is odd about it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Study {
    /// Its title.
    pub title: Option<String>,
    /// Dimensions, assembly function and characteristics.
    pub problem: Problem,
    /// The `[analysis]` section.
    pub options: Options,
    /// The seed of the `[analysis]` section, for what draws random numbers.
    pub seed: Option<u64>,
    /// The section `[dimensions]`: for every entry its keys, with their values as TOML.
    pub lines: Vec<(String, Vec<(String, String)>)>,
    /// The costs of tolerances, by groups that share one.
    pub costs: Vec<Priced>,
    /// The costs of deviations and rejects.
    pub losses: Vec<QualityLoss>,
    /// The costs of setting up machines.
    pub setups: Vec<SetUp>,
    /// The requirements of characteristics, by name.
    pub requirements: Vec<(String, Requirement)>,
    /// Warnings of entries that are legal but most likely not meant.
    pub warnings: Vec<Warning>,
    /// SHA-256 of the file's bytes, followed by those of every file of measured values, each once, in the order of the
    /// dimensions; in hexadecimal. As `cat gap.toml pin.csv | sha256sum` prints it.
    pub sha256: String,
    /// The files that it names, in the order of the dimensions, those of the model last.
    pub files: Vec<NamedFile>,
    /// The title block of pages, from the section `[about]`: name and text of every cell.
    pub about: Vec<(&'static str, String)>,
    /// The names of its configurations.
    pub configurations: Vec<String>,
    /// The study in plain keys, as TOML: what stands for relative dimensions is written out, each with its origin as comment, and a
    /// configuration that was asked for is set. Analysing it gives the same numbers.
    pub expanded: String,
    /// The text that it was read from.
    text: Arc<str>,
    format: Format,
    name: String,
    place: Place,
    /// Who answers in place of a program.
    host: Option<Host>,
}

impl Study {
    /// Faults of a study that are told at once.
    pub const MOST_FAULTS: usize = 20;

    /// Costs and requirements of the characteristics that its problem asks for.
    pub fn allocation_task(&self) -> AllocationTask {
        let of = |one: &Characteristic| {
            self.requirements.iter().find(|(name, _)| name == one.name()).map(|(_, requirement)| *requirement)
        };
        let requirements = self.problem.characteristics().iter().map(of).collect();
        AllocationTask::new(self.costs.clone(), requirements)
            .with_losses(self.losses.clone())
            .with_setups(self.setups.clone())
    }

    /// Reads a `.toml` or `.json` file.
    ///
    /// # Errors
    /// The faults in it: with the file or its syntax, or else with its keys and values, or else with what they mean together.
    /// Faults that do not follow from each other are told together.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::read_with(path, Externals::default())
    }

    /// [`read`](Self::read), with external programs treated like this. Nothing is started by reading.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_with(path: &Path, externals: Externals) -> Result<Self, StudyError> {
        Self::read_as(path, externals, None)
    }

    /// [`read_with`](Self::read_with), for a [sweep](sensitol::sweep) over the parameter of this name: a constant, or an input of a
    /// built-in model that the study leaves out, becomes a dimension without tolerance.
    ///
    /// # Errors
    /// As [`read`](Self::read), and when there is no such parameter.
    pub fn read_sweeping(path: &Path, externals: Externals, parameter: &str) -> Result<Self, StudyError> {
        Self::read_as(path, externals, Some(parameter))
    }

    fn read_as(path: &Path, externals: Externals, parameter: Option<&str>) -> Result<Self, StudyError> {
        let name = path.display().to_string();
        let failed = |text: &str, fault: StudyFault| StudyError {
            file: name.clone(),
            text: Arc::from(text),
            span: None,
            key: String::new(),
            fault: Box::new(fault),
            more: Vec::new(),
        };
        if path.is_dir() {
            let within =
                ["study.toml", "study.json"].map(|study| path.join(study)).into_iter().find(|study| study.is_file());
            let within = within.map(|study| study.display().to_string());
            return Err(failed("", StudyFault::IsFolder { within }));
        }
        let format = match path.extension().and_then(|extension| extension.to_str()) {
            Some("toml") => Format::Toml,
            Some("json") => Format::Json,
            _ => {
                let ending = |ending: &str| PathBuf::from(format!("{name}.{ending}"));
                let beside = ["toml", "json"].map(ending).into_iter().find(|study| study.is_file());
                let beside = beside.map(|study| study.display().to_string());
                return Err(failed("", StudyFault::UnknownFormat { beside }));
            }
        };
        let bytes =
            std::fs::read(path).map_err(|error| failed("", StudyFault::Unreadable { reason: error.to_string() }))?;
        match std::str::from_utf8(&bytes) {
            Ok(text) => {
                let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
                Self::parse(text, format, &name, Place::folder(folder), externals, parameter)
            }
            Err(error) => {
                let offset = error.valid_up_to();
                let before = std::str::from_utf8(&bytes[..offset]).expect("valid up to here");
                let fault = StudyFault::NotUtf8 { byte: bytes[offset], offset };
                Err(StudyError { span: Some(offset..offset), ..failed(before, fault) })
            }
        }
    }

    /// From TOML text; `name` stands for the file in errors, and relative paths start from the current folder.
    ///
    /// ```
    /// use sensitol_study::Study;
    /// let study = Study::from_toml(r#"
    ///     [dimensions]
    ///     a = { nominal = 10.0, tolerance = 0.3 }
    ///     b = { nominal = 9.5, limits = [9.4, 9.6] }
    ///     [characteristics]
    ///     gap = { formula = "a - b", lower = 0.1 }
    /// "#, "gap.toml")?;
    /// assert_eq!(study.problem.dimensions().len(), 2);
    /// # Ok::<(), sensitol_study::StudyError>(())
    /// ```
    pub fn from_toml(text: &str, name: &str) -> Result<Self, StudyError> {
        Self::from_text(StudyText::toml(name, text))
    }

    /// From JSON text; `name` stands for the file in errors.
    pub fn from_json(text: &str, name: &str) -> Result<Self, StudyError> {
        Self::from_text(StudyText::json(name, text))
    }

    /// From text in memory, with the files that it names.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_text(study: StudyText) -> Result<Self, StudyError> {
        let StudyText { format, name, text, files, externals, parameter, folder } = study;
        Self::parse(&text, format, &name, Place::memory(files, folder), externals, parameter.as_deref())
    }

    fn parse(
        text: &str,
        format: Format,
        name: &str,
        place: Place,
        externals: Externals,
        parameter: Option<&str>,
    ) -> Result<Self, StudyError> {
        let source = Source { name: name.to_owned(), text: Arc::from(text), place, externals };
        let failed = |faults: Faults| {
            StudyError::of(faults.0, &source.name, &source.text).expect("a study that fails has a fault")
        };
        let tree = match format {
            Format::Toml => Tree::of_toml(text),
            Format::Json => Tree::of_json(text),
        };
        let tree = tree.map_err(|fault| failed(fault.into()))?;
        let mut data = data::Data::of(&source.place);
        let expanded = expand::expand(tree, source.externals.configuration.as_deref(), &mut data).map_err(failed)?;
        let mut file: file::StudyFile = de::read(&expanded.tree).map_err(failed)?;
        if let Some(parameter) = parameter {
            sweep::as_dimension(&mut file, parameter).map_err(|fault| failed(fault.into()))?;
        }
        let built = build::build(&file, &source, data, &expanded.elements).map_err(failed)?;
        let mut hash = Sha256::new_with_prefix(text.as_bytes());
        built.data.iter().for_each(|bytes| hash.update(bytes));
        Ok(Self {
            title: file.title,
            about: file.about.cells(),
            problem: built.problem,
            options: built.options,
            seed: file.analysis.seed.map(spanned::Spanned::into_inner),
            lines: lines::of(&expanded.tree),
            expanded: expanded.toml(text),
            configurations: expanded.configurations,
            costs: built.costs,
            losses: built.losses,
            setups: built.setups,
            requirements: built.requirements,
            warnings: built.warnings,
            files: built.files,
            format,
            name: source.name,
            place: source.place,
            host: source.externals.host,
            text: source.text,
            sha256: hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect(),
        })
    }
}
