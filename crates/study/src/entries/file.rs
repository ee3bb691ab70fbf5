//! Types of the study file, for TOML and JSON alike.

#[cfg(feature = "schema")]
use crate::entries::vocabulary;
use std::fmt;
use std::ops::Range;

use crate::entries::about::AboutEntry;
use crate::entries::adjust_entry::{Adjustments, MotionEntry};
pub(crate) use crate::entries::analysis_entry::{AnalysisEntry, FactorEntry, PairsEntry};
#[cfg(feature = "schema")]
use crate::entries::assembly_schema as assembly;
use crate::entries::correlation_entry::{Correlations, Joints};
use crate::entries::cost_entry::{CostEntry, LossEntry, RequireEntry};
pub(crate) use crate::entries::distribution_entry::{DistributionEntry, PartEntry, distribution};
#[cfg(feature = "schema")]
use crate::entries::general_schema::GeneralEntry;
use crate::entries::guard::GuardEntry;
pub(crate) use crate::entries::named_entries::Entries;
pub(crate) use crate::entries::named_values::{ConstantEntry, UnknownEntry};
#[cfg(feature = "schema")]
use crate::entries::schema_parts as registry;
use crate::entries::spanned::Spanned;
use serde::de::{IgnoredAny, MapAccess, Visitor, value};
use serde::{Deserialize, Deserializer};

use crate::entries::values::{NominalEntry, ToleranceEntry};

/// A whole study file.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(title = "Study of sensitol", extend("required" = ["dimensions", "characteristics"])))]
#[serde(deny_unknown_fields, expecting = "a table of sections")]
pub(crate) struct StudyFile {
    /// Place of the schema, for editors; it has no effect.
    #[serde(rename = "$schema")]
    pub(crate) _schema: Option<String>,
    /// The subject of the study, in one line.
    pub(crate) title: Option<String>,
    /// The title block of pages: part, drawing, revision, author, a note.
    #[serde(default)]
    pub(crate) about: AboutEntry,
    /// Handling of units: labels only, warnings, errors (check), or conversion to SI and back (convert).
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::unit_modes(), "default" = registry::unit_modes()[1])))]
    pub(crate) units: Option<Spanned<String>>,
    /// The inputs: each with its nominal value, its tolerance and its distribution.
    #[serde(default)]
    pub(crate) dimensions: Entries<DimensionEntry>,
    /// Fixed numbers for formulas and models.
    #[serde(default)]
    pub(crate) constants: Entries<ConstantEntry>,
    /// Intermediate values by name, in any order, without cycles. One with the name of an input of the model drives it. Formulas have + - *
    /// / ^, comparisons, if(condition, x, y), abs, sign, floor, ceil, sqrt, exp, ln, log10, sin, cos, tan, asin, acos, atan, atan2, sinh,
    /// cosh, tanh, hypot, min, max, and the constants pi and deg = pi/180; angles are radians; a name with other characters than letters,
    /// digits and _ needs backquotes.
    #[serde(default)]
    pub(crate) formulas: Entries<FormulaEntry>,
    /// Values that equations and loops determine, each with the start of its search.
    #[serde(default)]
    pub(crate) unknowns: Entries<UnknownEntry>,
    /// Formulas that are 0 in the assembled state.
    #[serde(default)]
    pub(crate) equations: Entries<String>,
    /// Vectors that close: two equations each.
    #[serde(default)]
    pub(crate) loops: Entries<Vec<LinkEntry>>,
    /// Contacts of joints that press a part, as `sensitol expand` writes them: the comparisons of the equations that choose between sets.
    #[serde(default)]
    pub(crate) contacts: Entries<ContactsEntry>,
    /// Rigid parts in space, each with features by name. The first part stands still, or the one with ground = true.
    #[serde(default, rename = "parts")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::parts"))]
    pub(crate) _parts: Option<IgnoredAny>,
    /// Joints of two features, in the order of assembly, by the keys of the joint table.
    #[serde(default, rename = "joints")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::joints"))]
    pub(crate) _joints: Option<IgnoredAny>,
    /// The key characteristics, with their formulas, limits and targets.
    #[serde(default)]
    pub(crate) characteristics: Entries<CharacteristicEntry>,
    /// The cost of tolerances, for `sensitol allocate`; dimensions without a cost keep their tolerance. A band opens and
    /// closes about its middle, so that no mean moves because a tolerance does.
    #[serde(default)]
    pub(crate) costs: Entries<CostEntry>,
    /// The cost to set up each machine, by name: paid once for all dimensions whose processes need it.
    #[serde(default)]
    pub(crate) setup: Entries<f64>,
    /// The cost of deviations and rejects per assembly, which `sensitol allocate` adds to that of the tolerances.
    #[serde(default)]
    pub(crate) loss: Entries<LossEntry>,
    /// Pairs of dimensions that vary together.
    #[serde(default)]
    pub(crate) correlation: Correlations,
    /// Blocks of dimensions that vary together as a whole: rows of a measured file, or points within a zone.
    #[serde(default)]
    pub(crate) joint: Joints,
    /// Dimensions chosen from a stock for each assembly, such as a shim, so that a characteristic is nearest a target. They are chosen one
    /// after the other, and all characteristics follow the choice.
    #[serde(default)]
    pub(crate) adjust: Adjustments,
    /// Sizes of one assembly by name. Their nominal values and constants replace those of the study, such as small = { L = 40, D = 8 }; or
    /// file = "sizes.csv", whose first column is the name.
    #[serde(default, rename = "configurations")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::configurations"))]
    pub(crate) _configurations: Option<IgnoredAny>,
    /// Capabilities of processes by name, for the key `process` of dimensions: turning = { cp = 1.33, cpk = 1.0 }; or processes =
    /// "shop.toml", a file of such lines.
    #[serde(default, rename = "processes")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::processes::<DistributionEntry>"))]
    pub(crate) _processes: Option<IgnoredAny>,
    /// Tolerance of dimensions that state neither a tolerance nor a spread: { standard = "ISO 2768-m" }, or the values of a title block by
    /// ISO 22081. Theoretically exact dimensions are [constants].
    #[serde(default, rename = "general")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<GeneralEntry>"))]
    pub(crate) _general: Option<IgnoredAny>,
    /// A built-in model, an external program or a matrix of influence coefficients, evaluated next to the formulas.
    pub(crate) model: Option<Spanned<ModelEntry>>,
    /// Options of the analysis; flags of the command line win.
    #[serde(default)]
    pub(crate) analysis: AnalysisEntry,
}

/// One line of `[contacts]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "a table such as { sets = [[\"foot1\", \"foot2\", \"foot3\"]], changes = [] }"
)]
pub(crate) struct ContactsEntry {
    /// Contacts that carry the force, for each set on which the part can rest.
    pub(crate) sets: Vec<Vec<String>>,
    /// Comparisons of the equations, as written there. If the one of index k is true, set k + 1 precedes all sets up to k.
    pub(crate) changes: Vec<String>,
}

/// One line of `[dimensions]`.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table such as { nominal = 10.0, tolerance = 0.3 }")]
pub(crate) struct DimensionEntry {
    /// The value on the drawing, [x, y] of a position. Unless given: that of a built-in model, or the mean of measured values.
    pub(crate) nominal: Option<Spanned<NominalEntry>>,
    /// Half the tolerance band, 0.3, or both deviations from the nominal, [-0.1, 0.3]; numbers or percent of the nominal, "2 %". Without
    /// tolerance and sigma a dimension is constant.
    pub(crate) tolerance: Option<Spanned<ToleranceEntry>>,
    /// Lower and upper limit, in place of a tolerance.
    pub(crate) limits: Option<Spanned<[f64; 2]>>,
    /// A tolerance class of ISO 286, H7 or g6, in place of a tolerance; the unit must be mm.
    pub(crate) fit: Option<Spanned<String>>,
    /// The origin of its measurement: a dimension or formula, or several that are added; of a position another position. Its nominal is
    /// then the distance.
    #[serde(default, rename = "from")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::names"))]
    pub(crate) _from: Option<IgnoredAny>,
    /// The shorter leg of an angle, by which `[general]` gives its tolerance: a length in mm, or the name of a dimension.
    #[serde(default, rename = "leg")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::leg"))]
    pub(crate) _leg: Option<IgnoredAny>,
    /// Diameter of the circular zone of a position, in place of a tolerance: two dimensions, NAME_x and NAME_y. A table if the size of a
    /// feature widens the zone: { zone = 0.2, hole = "D", at = "MMC" }.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::position"))]
    pub(crate) position: Option<Spanned<f64>>,
    /// Play between a hole and a pin, { hole = "A", pin = "B", law = "uniform" }: NAME is the radial clearance times the place of the pin.
    #[serde(default, rename = "float")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::float"))]
    pub(crate) _float: Option<IgnoredAny>,
    /// A part on a round pin and in a slot: NAME_x, NAME_y and the rotation NAME_rot.
    #[serde(default, rename = "locate")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::locate"))]
    pub(crate) _locate: Option<IgnoredAny>,
    /// Zone of a profile: the offset of a face, and with length its tilt NAME_tilt, which shares the zone. A table if it is not equal on
    /// both sides: { zone = 0.4, outward = 0.3 }.
    #[serde(default, rename = "profile")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::profile"))]
    pub(crate) _profile: Option<IgnoredAny>,
    /// Zone of a perpendicularity over a length: an angle in rad, or NAME_x and NAME_y of an axis.
    #[serde(default, rename = "perpendicularity")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _perpendicularity: Option<IgnoredAny>,
    /// The same of a parallelism.
    #[serde(default, rename = "parallelism")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _parallelism: Option<IgnoredAny>,
    /// The same of an angularity.
    #[serde(default, rename = "angularity")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _angularity: Option<IgnoredAny>,
    /// Zone of a flatness: half of it on either side, or all of it with side = "out".
    #[serde(default, rename = "flatness")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _flatness: Option<IgnoredAny>,
    /// The same of a straightness.
    #[serde(default, rename = "straightness")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _straightness: Option<IgnoredAny>,
    /// The same of a roundness.
    #[serde(default, rename = "roundness")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _roundness: Option<IgnoredAny>,
    /// The same of a cylindricity.
    #[serde(default, rename = "cylindricity")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _cylindricity: Option<IgnoredAny>,
    /// Runout: the axis lies in a circle of this diameter about the datum's, NAME_x and NAME_y.
    #[serde(default, rename = "runout")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _runout: Option<IgnoredAny>,
    /// The same of a total runout.
    #[serde(default, rename = "total_runout")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _total_runout: Option<IgnoredAny>,
    /// The same of a coaxiality.
    #[serde(default, rename = "coaxiality")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _coaxiality: Option<IgnoredAny>,
    /// The same of a concentricity.
    #[serde(default, rename = "concentricity")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _concentricity: Option<IgnoredAny>,
    /// Zone of a symmetry: half of it on either side of the middle.
    #[serde(default, rename = "symmetry")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _symmetry: Option<IgnoredAny>,
    /// Length over which a profile or an orientation holds.
    #[serde(default, rename = "length")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::zone"))]
    pub(crate) _length: Option<IgnoredAny>,
    /// True if an orientation is that of an axis, in a cylindrical zone.
    #[serde(default, rename = "axis")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::truth"))]
    pub(crate) _axis: Option<IgnoredAny>,
    /// "out" for a form deviation that only adds to a size. Beside cp and cpk the side of the mean, "+" or "-"; unless given half of the
    /// parts have each.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::side"))]
    pub(crate) side: Option<Spanned<String>>,
    /// Number of equal parts, which vary independently: NAME.1, NAME.2 and so on. A formula adds them up by sum(NAME).
    #[serde(default, rename = "count")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::count"))]
    pub(crate) _count: Option<IgnoredAny>,
    /// The unit of its numbers: a label, checked or converted according to `units`.
    pub(crate) unit: Option<String>,
    /// Distribution: the name of a kind, or a table with its parameters.
    #[serde(default, deserialize_with = "distribution")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::distribution::<DistributionEntry>", extend("default" = "normal")))]
    pub(crate) distribution: Option<Spanned<DistributionEntry>>,
    /// Standard deviation; half the band divided by sigmas unless given. Kinds whose sigma follows from the band have none. Two numbers,
    /// [0.1, 0.2], below and above the nominal, make a split-normal distribution.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::sigma"))]
    pub(crate) sigma: Option<Spanned<f64>>,
    /// Number of sigmas in half the tolerance band.
    #[cfg_attr(feature = "schema", schemars(extend("default" = vocabulary::SIGMAS)))]
    pub(crate) sigmas: Option<Spanned<f64>>,
    /// Process capability, in place of sigmas: cp = sigmas/3.
    pub(crate) cp: Option<Spanned<f64>>,
    /// Process capability with the place of the mean. Alone it means cp, with the mean in the middle. Beside cp the mean lies half a band
    /// times 1 - cpk/cp off the middle.
    pub(crate) cpk: Option<Spanned<f64>>,
    /// Greatest distance of the mean of a lot from the mean of all: lots are uniform within it on either side.
    pub(crate) drift: Option<Spanned<f64>>,
    /// A process of [processes] with the keys that the dimension leaves out.
    #[serde(default, rename = "process")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    pub(crate) _process: Option<IgnoredAny>,
    /// The factor of its part in the inflated RSS; that of [analysis] unless given.
    pub(crate) rss_factor: Option<Spanned<f64>>,
    /// Possible shift of its mean in the mean-shift RSS, as part of its half band; that of [analysis] unless given.
    pub(crate) mean_shift: Option<Spanned<f64>>,
    /// Degrees of freedom of its standard uncertainty, for the budget that `analyze --gum` prints; infinite unless given.
    pub(crate) degrees: Option<Spanned<f64>>,
    /// Distance of the mean from the middle of the band; of a kind with a tail, from the nominal.
    #[cfg_attr(feature = "schema", schemars(extend("default" = 0)))]
    pub(crate) shift: Option<Spanned<f64>>,
    /// Central moments 2 to 8 about the mean, in place of a distribution; the dimension cannot be sampled then.
    pub(crate) moments: Option<Spanned<[f64; 7]>>,
    /// A CSV file of measured values, relative to the study's folder; they stand for the distribution.
    pub(crate) measured: Option<Spanned<String>>,
    /// Column of the measured file by its header; unless given the one with the dimension's name, or the only one.
    pub(crate) column: Option<Spanned<String>>,
    /// True if a row of the measured file is one part, so that its columns vary together (default); false for values of different parts.
    pub(crate) joint: Option<Spanned<bool>>,
    /// The column with the number of the part: rows of several files with the same one belong together.
    #[serde(rename = "match")]
    pub(crate) serial: Option<Spanned<String>>,
    /// The distribution made from measured values: `empirical`, each with the same probability, or `pearson`, by their four moments.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::measured_models(), "default" = registry::measured_models()[0])))]
    pub(crate) model: Option<Spanned<String>>,
    /// Evaluation step in sigmas, in place of the nodes that suit the distribution.
    pub(crate) step: Option<Spanned<f64>>,
    /// A few words on its meaning, for reports only, as are part, drawing, revision and feature.
    pub(crate) description: Option<String>,
    /// The part that it belongs to.
    pub(crate) part: Option<String>,
    /// The number of its drawing.
    pub(crate) drawing: Option<String>,
    /// The revision of the drawing.
    pub(crate) revision: Option<String>,
    /// The feature of the part, or its number on the drawing.
    pub(crate) feature: Option<String>,
}

impl PartEntry {
    /// The part of a mixture as an entry of `[dimensions]`.
    pub(crate) fn as_dimension(&self) -> DimensionEntry {
        DimensionEntry {
            nominal: self
                .nominal
                .as_ref()
                .map(|nominal| Spanned::new(nominal.span(), NominalEntry::One(*nominal.get_ref()))),
            tolerance: self.tolerance.clone(),
            limits: self.limits.clone(),
            distribution: self.distribution.clone(),
            sigma: self.sigma.clone(),
            sigmas: self.sigmas.clone(),
            cp: self.cp.clone(),
            shift: self.shift.clone(),
            ..DimensionEntry::default()
        }
    }
}

/// One line of `[formulas]`: a text, or `{ formula = "a + b", unit = "mm" }`.
#[derive(Debug)]
pub(crate) struct FormulaEntry {
    /// Text of an entry that is a text alone; empty if the entry is a table.
    plain: String,
    /// Text of an entry that is a table.
    written: Option<Spanned<String>>,
    pub(crate) unit: Option<String>,
}

impl FormulaEntry {
    /// Text of the formula with its place. `whole` is the place of the entry.
    pub(crate) fn text(&self, whole: Range<usize>) -> (Range<usize>, &str) {
        match &self.written {
            None => (whole, &self.plain),
            Some(written) => (written.span(), written.get_ref()),
        }
    }
}

/// One vector of a loop.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a vector such as { length = \"R - r\", angle = \"phi\" }")]
pub(crate) struct LinkEntry {
    /// Length: a formula or a number.
    pub(crate) length: Spanned<TermEntry>,
    /// Absolute angle in radians: a formula or a number.
    pub(crate) angle: Spanned<TermEntry>,
}

/// A formula, or a number in its place.
#[derive(Debug)]
pub(crate) struct TermEntry(pub(crate) String);

/// One line of `[characteristics]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table such as { formula = \"a - b\" }")]
pub(crate) struct CharacteristicEntry {
    /// A formula of dimensions, constants, formulas and outputs of the model; without one it is an output of that name.
    pub(crate) formula: Option<Spanned<String>>,
    /// The remaining play of a fastener, in place of a formula: { kind = "fixed", hole = "h", pin = "p", places = ["hp", "tp"] }, or kind =
    /// "floating" with two holes.
    #[serde(default, rename = "fastener")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::fastener"))]
    pub(crate) _fastener: Option<IgnoredAny>,
    /// The measured feature of a part, such as "shaft.tip", with the feature that it is measured `from`.
    #[serde(default, rename = "of")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::feature"))]
    pub(crate) _of: Option<IgnoredAny>,
    /// The feature from which it is measured: along the normal of a plane, across an axis, from a point.
    #[serde(default, rename = "from")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::feature"))]
    pub(crate) _from: Option<IgnoredAny>,
    /// A coordinate in the frame of `from`, in place of the distance.
    #[serde(default, rename = "along")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::coordinate"))]
    pub(crate) _along: Option<IgnoredAny>,
    /// The angle of two features: of their directions, or of an axis above a plane. The unit is deg or rad.
    #[serde(default, rename = "angle")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::pair"))]
    pub(crate) _angle: Option<IgnoredAny>,
    /// The distance of two features less their radii.
    #[serde(default, rename = "gap")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::pair"))]
    pub(crate) _gap: Option<IgnoredAny>,
    /// The greatest deviation of points of a face from their nominal distances from a plane: { of = "cover.face", at = [[0, 0], [50, 0]] }.
    #[serde(default, rename = "profile")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "assembly::profile"))]
    pub(crate) _profile: Option<IgnoredAny>,
    /// The least value of another characteristic over a motion: { of = "gap", over = "theta", from = 0, to = 360 }.
    pub(crate) minimum: Option<Spanned<MotionEntry>>,
    /// The greatest value of another characteristic over a motion.
    pub(crate) maximum: Option<Spanned<MotionEntry>>,
    /// Another characteristic. The yield and the target_yield then refer to the assemblies within its limits only.
    pub(crate) given: Option<Spanned<String>>,
    /// The unit of the result and its limits: a label, checked or converted according to `units`.
    pub(crate) unit: Option<String>,
    /// Lower limit; without a limit there is no yield.
    pub(crate) lower: Option<Spanned<f64>>,
    /// Upper limit.
    pub(crate) upper: Option<Spanned<f64>>,
    /// Least share of assemblies within the limits, between 0 and 1; --check judges it, and allocate keeps it.
    pub(crate) target_yield: Option<Spanned<f64>>,
    /// The least Cpk; the same as require = { cpk = 1.33 }.
    pub(crate) target_cpk: Option<Spanned<f64>>,
    /// A requirement: worst case, rss, or a number. allocate keeps it in place of target_yield, --check judges both.
    pub(crate) require: Option<Spanned<RequireEntry>>,
    /// Standard deviation of the gauge that accepts parts; the report then has the risks of the inspection.
    pub(crate) gauge: Option<Spanned<f64>>,
    /// Amount by which the limits are tightened for acceptance, or `{ false_accept = 0.001 }`: the greatest share of all parts that are bad
    /// and accepted.
    pub(crate) guard: Option<Spanned<GuardEntry>>,
    /// A few words on its meaning, for reports only, as are part, drawing, revision and feature.
    pub(crate) description: Option<String>,
    /// The part that it belongs to.
    pub(crate) part: Option<String>,
    /// The number of its drawing.
    pub(crate) drawing: Option<String>,
    /// The revision of the drawing.
    pub(crate) revision: Option<String>,
    /// The feature of the part, or its number on the drawing.
    pub(crate) feature: Option<String>,
}

/// `[model]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(extend("oneOf" = registry::one_of(["builtin", "command", "matrix"]))))]
#[serde(
    deny_unknown_fields,
    expecting = "a table such as { builtin = \"engine-balance\" } or { command = [\"python3\", \"gap.py\"] }"
)]
pub(crate) struct ModelEntry {
    /// A built-in model, by name: `sensitol models` lists them.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::built_in_models())))]
    pub(crate) builtin: Option<Spanned<String>>,
    /// A program and its arguments, each a text of its own, run in the study's folder; it speaks the adapter protocol.
    pub(crate) command: Option<Spanned<Vec<String>>>,
    /// A CSV file of influence coefficients in place of a program: a row for every output, a column for every input. Column y0 has the
    /// outputs at zero inputs, or nominal those at the nominal dimensions. Rows become linear formulas.
    #[serde(default, rename = "matrix")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    pub(crate) _matrix: Option<IgnoredAny>,
    /// Names that the program gets at every point, in this order, in place of all dimensions: dimensions, constants and formulas. Points
    /// with the same numbers are one evaluation.
    pub(crate) inputs: Option<Spanned<Vec<Spanned<String>>>>,
    /// Processes side by side.
    #[cfg_attr(feature = "schema", schemars(extend("default" = registry::program().workers)))]
    pub(crate) workers: Option<Spanned<u64>>,
    /// Seconds that an evaluation may take.
    #[cfg_attr(feature = "schema", schemars(extend("default" = registry::program().timeout.as_secs())))]
    pub(crate) timeout_s: Option<Spanned<f64>>,
    /// Seconds that the program may take to start.
    #[cfg_attr(feature = "schema", schemars(extend("default" = registry::program().start_timeout.as_secs())))]
    pub(crate) start_timeout_s: Option<Spanned<f64>>,
    /// Number of retries of a point that failed.
    #[cfg_attr(feature = "schema", schemars(extend("default" = registry::program().retries)))]
    pub(crate) retries: Option<Spanned<u64>>,
    /// Number of answers that are repeated in a fresh process, because they may depend on earlier points; 0 for none. By default 5 %, at
    /// least 7 and at most 59.
    pub(crate) verify: Option<Spanned<u64>>,
    /// Files that the model depends on, relative to the study's folder: with other contents nothing kept in the journal is used.
    pub(crate) files: Option<Vec<Spanned<String>>>,
}

impl<'de> Deserialize<'de> for FormulaEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            formula: Spanned<String>,
            unit: Option<String>,
        }
        struct Formula;
        impl<'de> Visitor<'de> for Formula {
            type Value = FormulaEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a text in quotes")
            }

            fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
                Ok(FormulaEntry { plain: text.to_owned(), written: None, unit: None })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let Table { formula, unit } = Table::deserialize(value::MapAccessDeserializer::new(map))?;
                Ok(FormulaEntry { plain: String::new(), written: Some(formula), unit })
            }
        }
        deserializer.deserialize_any(Formula)
    }
}

impl<'de> Deserialize<'de> for TermEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Term;
        impl<'de> Visitor<'de> for Term {
            type Value = TermEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a formula such as \"R - r\", or a number")
            }

            fn visit_str<E>(self, formula: &str) -> Result<Self::Value, E> {
                Ok(TermEntry(formula.to_owned()))
            }

            fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
                Ok(TermEntry(format!("{number:?}")))
            }

            fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
                Ok(TermEntry(number.to_string()))
            }
        }
        deserializer.deserialize_any(Term)
    }
}
