//! Study files: an assembly and its characteristics in TOML or JSON.
//!
//! One set of types describes both formats. A fault is a [`StudyError`] with file, line, column, key and the text to write instead. Faults
//! that are independent of each other are reported together.
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
//! | `arcsine`, `u-shaped`, `octahedron`, `bicone` | follow from the band | |
//! | `curvilinear-trapezoid` | follow from the band and its inexactness | `inexactness`: by how much the ends of the band may be off |
//! | `student` | the band's middle plus `shift`; `sigma`, half the band by `sigmas` or `cp`, or `scale` | `degrees`: above 2; `scale`: sigma is `scale sqrt(degrees/(degrees - 2))` |
//! | `lognormal`, `gamma`, `weibull` | nominal plus `shift`; `sigma`, or half the band by `sigmas` or `cp` | `origin`: where it begins, 0 by default |
//! | `exponential`, `rayleigh` | nominal plus `shift`; sigma follows from mean and origin | `origin` |
//! | `mixture` | follow from the parts | `parts`: tables by name |
//! | `tabulated` | follow from the table | `scores`, `values`: quantiles over normal scores, both ascending; between them a monotone cubic of the score |
//! | `any` | unknown: yields are bounded over all distributions within the band, other figures take a uniform one | `mean` (least and greatest), `sigma_at_most`, `symmetric`, `unimodal` |
//! | `split-normal` | follow from both sigmas about the nominal plus `shift` | `below`, `above`: the sigmas of both sides, or each deviation by `sigmas` (3) |
//! | `gumbel-largest`, `gumbel-smallest` | as those of `normal` | |
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

mod analysis_change;
mod any_error;
mod assembly_poses;
mod build;
mod data;
mod decimal;
mod deserializer;
mod dimension;
mod dimension_text;
mod entries;
mod error;
mod expand;
mod external_settings;
mod fault_code;
mod faults;
mod files;
mod folder;
#[cfg(feature = "import")]
pub mod import;
mod labels;
#[cfg(feature = "import")]
mod lot;
mod posterior_text;
mod rewrite;
mod scene;
#[cfg(feature = "schema")]
pub mod schema;
mod source;
mod states;
mod suggestion;
pub mod table;
mod tree;
mod typing_habits;
pub mod write;

use crate::build::sweep;
use crate::entries::spanned;
use crate::external_settings::Host;
pub use crate::external_settings::{Externals, JournalPlace};
pub use crate::faults::compensator_fault::CompensatorFault;
pub use crate::folder::Format;
pub use crate::folder::StudyText;
pub use crate::typing_habits::TypingHabit;
pub use any_error::AnyError;
pub use assembly_poses::AssemblyPoses;
pub use data::{DataFault, DataProblem};
pub use error::{StudyError, StudyFault};
pub use faults::zone_fault::ZoneFault;
pub use files::{FileRole, NamedFile};
#[cfg(feature = "import")]
pub use lot::{LotTableFault, ReadLot, read_lot};
pub use posterior_text::{UpdatedSpread, UpdatedStudy};
pub use rewrite::{RewriteError, Rewritten};
pub use scene::{
    AssemblyScene, CompletenessGap, DimensionOwner, FeatureOutline, MeasureMark, RigidDisplacement, SceneDeviation,
    SceneFeature, SceneJoint, SceneMeasure, ScenePart,
};
#[cfg(feature = "schema")]
pub use schema::{SCHEMA_FILE, SCHEMA_ID, schema};

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use crate::folder::Place;
use error::Faults;
use sensitol::allocation::{AllocationTask, Priced, QualityLoss, SetUp};
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol::method::Options;
use sensitol::problem::Problem;
use sensitol::warning::Warning;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::requirement::Requirement;
pub use sensitol_spatial::{Mobility, PartPose};
use source::Source;
use tree::Tree;

/// Endings of files that hold tables.
const TABLES: [&str; 6] = ["xlsx", "xlsm", "xls", "ods", "csv", "tsv"];

/// A study: a problem, the options of its analysis, its costs and requirements, and its warnings.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Study {
    /// Title.
    pub title: Option<String>,
    /// Dimensions, assembly function and characteristics.
    pub problem: Problem,
    /// The `[analysis]` section.
    pub options: Options,
    /// Seed of the random numbers, from the `[analysis]` section.
    pub seed: Option<u64>,
    /// Entries of the section `[dimensions]`, each with its keys and their values as TOML.
    pub lines: Vec<(String, Vec<(String, String)>)>,
    /// Costs of tolerances, by groups of dimensions that share one.
    pub costs: Vec<Priced>,
    /// Costs of deviations and rejects.
    pub losses: Vec<QualityLoss>,
    /// Costs of setting up machines.
    pub setups: Vec<SetUp>,
    /// Requirements, each with the name of its characteristic.
    pub requirements: Vec<(String, Requirement)>,
    /// Warnings of entries that are permitted but are most likely mistakes.
    pub warnings: Vec<Warning>,
    /// SHA-256 of the bytes of the study file followed by those of every data file that it reads, in hexadecimal. Each file counts once, in
    /// the order of reading. Without other data files it equals the output of `cat gap.toml pin.csv | sha256sum`.
    pub sha256: String,
    /// Files that the study names, in the order of the dimensions. Those of the model are last.
    pub files: Vec<NamedFile>,
    /// Program that evaluations start, with its arguments. None if nothing is started: the model is built in, a formula or a function, or
    /// the answers come from elsewhere.
    pub program: Option<Vec<String>>,
    /// Title block of printed pages, from the section `[about]`: name and text of every cell.
    pub about: Vec<(&'static str, String)>,
    /// Names of the configurations.
    pub configurations: Vec<String>,
    /// The study in plain keys, as TOML. Short forms such as relative dimensions are written out, each with its origin as comment. The
    /// configuration that was requested is set. Its analysis gives the same numbers.
    pub expanded: String,
    /// Unknowns, equations and free motions of an assembly in space; None if the study has none.
    pub mobility: Option<Mobility>,
    /// Poses of the parts of an assembly in space at the nominal dimensions, with lengths in `length_unit`.
    pub poses: Vec<PartPose>,
    /// Unit of lengths of an assembly in space: the first one that the study names. None if it names none.
    pub length_unit: Option<String>,
    /// Zones with a cost, and those without one whose dimensions follow their widths.
    zones: Vec<expand::ZonePlace>,
    /// Groups of the dimensions of zones, for relative costs.
    zone_groups: Vec<Priced>,
    /// Facts about an assembly in space; None if the study has none.
    spatial: Option<scene::SpatialFacts>,
    /// Text that the study was read from.
    text: Arc<str>,
    format: Format,
    name: String,
    place: Place,
    /// Function that answers in place of a program; None if there is none.
    host: Option<Host>,
}

impl Study {
    /// Greatest number of faults that one error reports.
    pub const MOST_FAULTS: usize = 20;

    /// Costs of the study, and the requirements of the characteristics in the order of its problem.
    pub fn allocation_task(&self) -> AllocationTask {
        let of = |one: &Characteristic| {
            self.requirements.iter().find(|(name, _)| name == one.name()).map(|(_, requirement)| *requirement)
        };
        let requirements = self.problem.characteristics().iter().map(of).collect();
        AllocationTask::new(self.costs.clone(), requirements)
            .with_losses(self.losses.clone())
            .with_setups(self.setups.clone())
            .with_zones(self.zone_groups.clone(), self.places_in_joints())
    }

    /// Dimensions that place a pin in its hole. They are no tolerances.
    fn places_in_joints(&self) -> Vec<usize> {
        let Some(facts) = &self.spatial else { return Vec::new() };
        let all = self.problem.dimensions().iter().enumerate();
        all.filter(|(_, one)| facts.is_made_by_joint(one.name())).map(|(d, _)| d).collect()
    }

    /// Reads a `.toml` or `.json` file.
    ///
    /// # Errors
    /// Returns the faults of the first of three steps that fails: file and syntax, keys and values, or their meaning together. Faults that
    /// do not follow from each other are reported together.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::read_with(path, Externals::default())
    }

    /// [`read`](Self::read) with settings for external programs. Reading starts no program.
    ///
    /// # Errors
    /// Fails like [`read`](Self::read).
    pub fn read_with(path: &Path, externals: Externals) -> Result<Self, StudyError> {
        Self::read_as(path, externals, None)
    }

    /// [`read_with`](Self::read_with), for a [sweep](sensitol::sweep) over the parameter of this name. A constant becomes a dimension
    /// without tolerance, and so does an input of a built-in model that the study leaves out.
    ///
    /// # Errors
    /// Fails like [`read`](Self::read), or if there is no such parameter.
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
                let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
                let table = TABLES.contains(&ending.as_str());
                return Err(failed("", StudyFault::UnknownFormat { table, beside }));
            }
        };
        let bytes =
            std::fs::read(path).map_err(|error| failed("", StudyFault::Unreadable { reason: error.to_string() }))?;
        match std::str::from_utf8(&bytes) {
            Ok(text) => {
                let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
                let mut study = Self::parse(text, format, &name, Place::folder(folder), externals, parameter)?;
                let file = path.file_name().map(|file| ("Study", file.to_string_lossy().into_owned()));
                study.about.extend(file);
                Ok(study)
            }
            Err(error) => {
                let offset = error.valid_up_to();
                let before = std::str::from_utf8(&bytes[..offset]).expect("valid up to here");
                let fault = StudyFault::NotUtf8 { byte: bytes[offset], offset };
                Err(StudyError { span: Some(offset..offset), ..failed(before, fault) })
            }
        }
    }

    /// Reads TOML text. Errors show `name` in place of a file, and relative paths start from the current folder.
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

    /// Reads JSON text. Errors show `name` in place of a file.
    pub fn from_json(text: &str, name: &str) -> Result<Self, StudyError> {
        Self::from_text(StudyText::json(name, text))
    }

    /// Reads text in memory, with the files that it names.
    ///
    /// # Errors
    /// Fails like [`read`](Self::read).
    pub fn from_text(study: StudyText) -> Result<Self, StudyError> {
        let StudyText { format, name, text, files, externals, parameter, folder, root } = study;
        let place = Place::memory(files, folder).within(root);
        Self::parse(&text, format, &name, place, externals, parameter.as_deref())
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
        let nominal = |tree: &Tree| nominal_values(tree, &source);
        let configuration = source.externals.configuration.as_deref();
        let expanded = expand::expand(tree, configuration, &mut data, &nominal).map_err(failed)?;
        let mut file: crate::entries::file::StudyFile = crate::deserializer::read(&expanded.tree).map_err(failed)?;
        if let Some(parameter) = parameter {
            sweep::as_dimension(&mut file, parameter).map_err(|fault| failed(fault.into()))?;
        }
        let built = crate::build::problem::build(&file, &source, data, &expanded.elements).map_err(failed)?;
        let zone_groups = crate::build::zone_cost::groups(&expanded.free_zones, &built.costs, &built.problem);
        let mut hash = Sha256::new_with_prefix(text.as_bytes());
        built.data.iter().for_each(|bytes| hash.update(bytes));
        Ok(Self {
            title: file.title,
            about: file.about.cells(),
            problem: built.problem,
            options: built.options,
            seed: file.analysis.seed.map(spanned::Spanned::into_inner),
            lines: crate::dimension_text::of(&expanded.tree),
            expanded: expanded.toml(text),
            mobility: expanded.spatial.as_ref().map(|facts| facts.mobility.clone()),
            length_unit: expanded.spatial.as_ref().and_then(|facts| facts.length_unit.clone()),
            poses: expanded.spatial.as_ref().map_or_else(Vec::new, |facts| facts.poses.clone()),
            spatial: expanded.spatial,
            zone_groups,
            zones: expanded.zones.into_iter().chain(expanded.free_zones.into_iter().map(|zone| zone.place)).collect(),
            configurations: expanded.configurations,
            costs: built.costs,
            losses: built.losses,
            setups: built.setups,
            requirements: built.requirements,
            warnings: built.warnings,
            files: built.files,
            program: built.program,
            format,
            name: source.name,
            place: source.place,
            host: source.externals.host,
            text: source.text,
            sha256: hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect(),
        })
    }
}

/// Values of the characteristics of a study in plain keys at its nominal dimensions.
fn nominal_values(tree: &Tree, source: &Source) -> Result<Vec<f64>, Faults> {
    let file: crate::entries::file::StudyFile = crate::deserializer::read(tree)?;
    let data = data::Data::of(&source.place);
    let built = crate::build::problem::build(&file, source, data, &expand::Elements::default())?;
    let nominal: Vec<f64> = built.problem.dimensions().iter().map(|dimension| dimension.nominal()).collect();
    let outputs: Vec<usize> = (0..built.problem.characteristics().len()).collect();
    let mut answers = Responses::open(1, outputs.len());
    let points = Points::from_rows(&[nominal]);
    built.problem.function().evaluate(&Request::values(&points, &outputs), &Run::to_the_end(), &mut answers);
    Ok(outputs.iter().map(|&output| answers.value(0, output).unwrap_or(f64::NAN)).collect())
}
