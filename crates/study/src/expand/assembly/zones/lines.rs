//! Plain lines that zones and floats of an assembly add to a study.

use std::ops::Range;

use crate::decimal::{KEPT, decimal};
use crate::error::{Fault, Faults};
use crate::expand::{Expanded, Origin, Tree, Value, quoted};
use crate::tree::Key;

/// Ending of the name of a place on a zone of radius 1.
pub(super) const UNIT: &str = ".unit";
/// Ending of the name of a place in the whole zone, of which other deviations take a part.
const WHOLE: &str = ".whole";

/// Quantity that a line measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LineUnit {
    Length,
    /// Radians, if lengths have a unit.
    Angle,
    /// A place on a zone of radius 1. It has a unit only if all units are converted.
    Plain,
}

/// A width, a length or half a zone: a number in the unit of lengths, or a formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Extent {
    Number(f64),
    Formula(String),
}

/// Entry of the study that makes lines, with the assumption to state beside them.
#[derive(Debug, Clone)]
pub(super) struct Owner {
    /// Full key, such as `parts.housing.bore`.
    pub(super) key: String,
    pub(super) span: Range<usize>,
    pub(super) note: String,
    /// Zone whose lines these are; None for a float.
    pub(super) zone: Option<ZoneLabel>,
}

/// Zone of a feature, for the lines that it makes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ZoneLabel {
    /// Full name, such as `housing.bore.position`.
    pub(super) name: String,
    /// Half of its width; None if that is a formula.
    pub(super) half: Option<f64>,
}

/// Zone with the lines that it has made.
#[derive(Debug, Clone)]
pub(super) struct MadeZone {
    pub(super) label: ZoneLabel,
    /// Dimensions whose half bands are proportional to the width, with their half bands.
    pub(super) members: Vec<(String, f64)>,
    /// Dimension that holds the width itself, for formulas.
    pub(super) width: Option<String>,
    /// True if its lines do not follow the width, such as a band that is not about 0.
    pub(super) is_uneven: bool,
    /// True if the factor of a line is a formula, such as a lever arm.
    pub(super) has_formula: bool,
}

/// A dimension within a band, by the text that formulas need and by its name.
#[derive(Debug, Clone)]
pub(super) struct Band {
    pub(super) text: String,
    pub(super) dimension: String,
}

/// Lines to add to a study.
pub(super) struct Lines {
    dimensions: Vec<(Key, Tree)>,
    formulas: Vec<(Key, Tree)>,
    blocks: Vec<Tree>,
    /// Names of made lines with their owners.
    owners: Vec<(String, Owner)>,
    /// Zones with the lines that they have made.
    pub(super) zones: Vec<MadeZone>,
    /// Names of the zones with a cost.
    pub(super) priced: Vec<String>,
    /// Unit of lengths; None if the study has none.
    unit: Option<String>,
    converts: bool,
}

/// Names of made lines with their owners, to name these in faults and comments.
pub(in crate::expand) struct LineOwners(Vec<(String, Owner)>);

impl Extent {
    /// The number; None for a formula.
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Formula(_) => None,
        }
    }
}

/// Text of a number in a formula, without the rounding errors of sums of decimals.
fn plain(value: f64) -> String {
    let value = decimal(value, KEPT);
    if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") }
}

impl Lines {
    pub(super) fn new(unit: Option<String>, converts: bool) -> Self {
        let (dimensions, formulas, blocks, owners) = Default::default();
        let (zones, priced) = Default::default();
        Self { dimensions, formulas, blocks, owners, zones, priced, unit, converts }
    }

    /// Text of a length in a formula, with its unit: a lever times an angle is a length.
    pub(super) fn length(&self, extent: &Extent) -> String {
        match (extent, &self.unit) {
            (Extent::Number(value), Some(unit)) if *value != 0.0 => {
                let text = format!("{:?}[{unit}]", decimal(value.abs(), KEPT));
                if *value < 0.0 { format!("(-{text})") } else { text }
            }
            (Extent::Number(value), _) => plain(*value),
            (Extent::Formula(text), _) => text.clone(),
        }
    }

    /// An extent times a number.
    pub(super) fn scaled(&self, extent: &Extent, by: f64) -> Extent {
        match extent {
            Extent::Number(value) => Extent::Number(decimal(value * by, KEPT)),
            Extent::Formula(text) => Extent::Formula(format!("{}*{text}", plain(by))),
        }
    }

    /// Quotient of two lengths times a number: an angle.
    pub(super) fn angle(&self, width: &Extent, across: &Extent, by: f64) -> Extent {
        match (width, across) {
            (Extent::Number(width), Extent::Number(across)) => Extent::Number(by * width / across),
            _ => Extent::Formula(format!("{}*{}/{}", plain(by), self.length(width), self.length(across))),
        }
    }

    /// True if there is a line of this name.
    pub(super) fn has(&self, name: &str) -> bool {
        self.owners.iter().any(|(own, _)| own == name)
    }

    /// A point in a circle: the texts of its two coordinates.
    pub(super) fn circle(
        &mut self,
        owner: &Owner,
        name: &str,
        radius: &Extent,
        unit: LineUnit,
        spread: &[(Key, Tree)],
    ) -> [String; 2] {
        let both = ["_x", "_y"].map(|axis| quoted(&format!("{name}{axis}")));
        let mut keys = vec![("nominal", self.list(owner, vec![number(owner, 0.0), number(owner, 0.0)]))];
        match radius {
            Extent::Number(radius) => {
                keys.push(("position", number(owner, decimal(2.0 * radius, KEPT))));
                self.dimension(owner, name.to_owned(), unit, keys, spread);
            }
            Extent::Formula(radius) => {
                keys.push(("position", number(owner, 2.0)));
                self.dimension(owner, format!("{name}{UNIT}"), LineUnit::Plain, keys, spread);
                for axis in ["_x", "_y"] {
                    let product = format!("{radius}*{}", quoted(&format!("{name}{UNIT}{axis}")));
                    self.formula(owner, format!("{name}{axis}"), unit, product);
                }
            }
        }
        both
    }

    /// A point in a circle of which other deviations take a part: `used` of `half`. The width of a zone with a cost is a
    /// dimension, so that the part changes with it.
    pub(super) fn circle_left(
        &mut self,
        owner: &Owner,
        name: &str,
        (half, used): (&Extent, &str),
        spread: &[(Key, Tree)],
    ) -> [String; 2] {
        let (Some(width), Extent::Number(radius)) = (self.width(owner), half) else {
            let left = format!("({} - {used})", self.length(half));
            return self.circle(owner, name, &Extent::Formula(left), LineUnit::Length, spread);
        };
        let keys = vec![
            ("nominal", self.list(owner, vec![number(owner, 0.0), number(owner, 0.0)])),
            ("position", number(owner, decimal(2.0 * radius, KEPT))),
        ];
        self.dimension(owner, format!("{name}{WHOLE}"), LineUnit::Length, keys, spread);
        ["_x", "_y"].map(|axis| {
            let product = format!("{}*(1 - 2*{used}/{width})", quoted(&format!("{name}{WHOLE}{axis}")));
            self.formula(owner, format!("{name}{axis}"), LineUnit::Length, product);
            quoted(&format!("{name}{axis}"))
        })
    }

    /// A band of which other deviations take a part, as [`circle_left`](Self::circle_left).
    pub(super) fn band_left(
        &mut self,
        owner: &Owner,
        name: &str,
        (half, used): (&Extent, &str),
        spread: &[(Key, Tree)],
    ) -> String {
        let (Some(width), Extent::Number(radius)) = (self.width(owner), half) else {
            let left = format!("({} - {used})", self.length(half));
            return self.band(owner, name, &Extent::Formula(left), LineUnit::Length, spread).text;
        };
        let whole = format!("{name}{WHOLE}");
        let keys = vec![("nominal", number(owner, 0.0)), ("tolerance", number(owner, *radius))];
        self.dimension(owner, whole.clone(), LineUnit::Length, keys, spread);
        let product = format!("{}*(1 - 2*{used}/{width})", quoted(&whole));
        self.formula(owner, name.to_owned(), LineUnit::Length, product);
        quoted(name)
    }

    /// A dimension about 0 with this half band.
    pub(super) fn band(
        &mut self,
        owner: &Owner,
        name: &str,
        half: &Extent,
        unit: LineUnit,
        spread: &[(Key, Tree)],
    ) -> Band {
        let text = quoted(name);
        let mut keys = vec![("nominal", number(owner, 0.0))];
        match half {
            Extent::Number(half) if *half == 0.0 => {
                self.dimension(owner, name.to_owned(), unit, keys, &[]);
                Band { text, dimension: name.to_owned() }
            }
            Extent::Number(half) => {
                keys.push(("tolerance", number(owner, *half)));
                self.dimension(owner, name.to_owned(), unit, keys, spread);
                Band { text, dimension: name.to_owned() }
            }
            Extent::Formula(half) => {
                let dimension = format!("{name}{UNIT}");
                keys.push(("tolerance", number(owner, 1.0)));
                self.dimension(owner, dimension.clone(), LineUnit::Plain, keys, spread);
                self.formula(owner, name.to_owned(), unit, format!("{half}*{}", quoted(&dimension)));
                Band { text, dimension }
            }
        }
    }

    /// A dimension with a band that need not be symmetric.
    pub(super) fn offset_band(
        &mut self,
        owner: &Owner,
        name: &str,
        [lower, upper]: [f64; 2],
        spread: &[(Key, Tree)],
    ) -> Band {
        let band = [lower, upper].map(|end| number(owner, decimal(end, KEPT))).to_vec();
        let keys = vec![("nominal", number(owner, 0.0)), ("tolerance", self.list(owner, band))];
        self.dimension(owner, name.to_owned(), LineUnit::Length, keys, spread);
        Band { text: quoted(name), dimension: name.to_owned() }
    }

    /// A line of `[dimensions]` with these keys.
    pub(super) fn dimension(
        &mut self,
        owner: &Owner,
        name: String,
        unit: LineUnit,
        keys: Vec<(&'static str, Tree)>,
        spread: &[(Key, Tree)],
    ) {
        self.record(owner, &name, &keys);
        let mut keys: Vec<(Key, Tree)> = keys.into_iter().map(|(name, tree)| (key(owner, name), tree)).collect();
        keys.extend(spread.iter().cloned());
        keys.extend(self.unit(unit).map(|unit| (key(owner, "unit"), text(owner, unit))));
        self.dimensions.push((key(owner, &name), Tree { span: owner.span.clone(), value: Value::Table(keys) }));
        self.owners.push((name, owner.clone()));
    }

    /// Records a line among those of its zone.
    fn record(&mut self, owner: &Owner, name: &str, keys: &[(&'static str, Tree)]) {
        let Some(label) = &owner.zone else { return };
        let of = |key: &str| keys.iter().find(|(known, _)| *known == key).map(|(_, tree)| &tree.value);
        let half = match (of("tolerance"), of("position")) {
            (Some(Value::Number(half)), _) => Some(*half),
            (_, Some(Value::Number(width))) => Some(0.5 * width),
            (_, Some(Value::Table(frame))) => frame.iter().find_map(|(key, tree)| match &tree.value {
                Value::Number(width) if key.name == "zone" => Some(0.5 * width),
                _ => None,
            }),
            _ => None,
        };
        let (plain, table) = match of("position") {
            Some(Value::Table(frame)) => (frame.iter().any(|(key, _)| key.name == "width"), true),
            _ => (!name.ends_with(UNIT), false),
        };
        let zone = self.zone_of(label);
        match half.filter(|_| plain) {
            // A bonus puts the places in a line of its own.
            Some(half) => zone.members.push((if table { format!("{name}{UNIT}") } else { name.to_owned() }, half)),
            None if name.ends_with(UNIT) => zone.has_formula = true,
            None => zone.is_uneven = true,
        }
    }

    fn zone_of(&mut self, label: &ZoneLabel) -> &mut MadeZone {
        let place = self.zones.iter().position(|zone| zone.label.name == label.name).unwrap_or_else(|| {
            let label = label.clone();
            self.zones.push(MadeZone { label, members: Vec::new(), width: None, is_uneven: false, has_formula: false });
            self.zones.len() - 1
        });
        &mut self.zones[place]
    }

    /// Dimension that holds the width of a zone, if the zone has a cost: the width then changes, and formulas need it.
    pub(super) fn width(&mut self, owner: &Owner) -> Option<String> {
        let label = owner.zone.clone().filter(|label| self.priced.contains(&label.name))?;
        let half = label.half.filter(|half| *half > 0.0)?;
        let name = label.name.clone();
        if self.zone_of(&label).width.is_none() {
            let plain = Owner { zone: None, ..owner.clone() };
            self.dimension(&plain, name.clone(), LineUnit::Length, vec![("nominal", number(owner, 2.0 * half))], &[]);
            self.zone_of(&label).width = Some(name.clone());
        }
        Some(quoted(&name))
    }

    /// A line of `[formulas]`.
    pub(super) fn formula(&mut self, owner: &Owner, name: String, unit: LineUnit, formula: String) {
        let formula = text(owner, formula);
        let tree = match self.unit(unit) {
            None => formula,
            Some(unit) => {
                let keys = vec![(key(owner, "formula"), formula), (key(owner, "unit"), text(owner, unit))];
                Tree { span: owner.span.clone(), value: Value::Table(keys) }
            }
        };
        self.formulas.push((key(owner, &name), tree));
        self.owners.push((name, owner.clone()));
    }

    /// A block of dimensions that share a zone.
    pub(super) fn block(&mut self, owner: &Owner, of: &[&Band], law: &str) {
        let of = self.list(owner, of.iter().map(|band| text(owner, band.dimension.clone())).collect());
        let keys = vec![(key(owner, "of"), of), (key(owner, "law"), text(owner, law.to_owned()))];
        self.blocks.push(Tree { span: owner.span.clone(), value: Value::Table(keys) });
    }

    pub(super) fn list(&self, owner: &Owner, items: Vec<Tree>) -> Tree {
        Tree { span: owner.span.clone(), value: Value::Array(items) }
    }

    /// Unit of lengths; None if the study has none.
    pub(super) fn length_unit(&self) -> Option<String> {
        self.unit.clone()
    }

    fn unit(&self, of: LineUnit) -> Option<String> {
        match of {
            LineUnit::Length => self.unit.clone(),
            LineUnit::Angle => self.unit.as_ref().map(|_| "rad".to_owned()),
            LineUnit::Plain => self.unit.as_ref().filter(|_| self.converts).map(|_| "1".to_owned()),
        }
    }

    /// Adds the lines to the study.
    pub(super) fn write(self, expanded: &mut Expanded) -> LineOwners {
        let names = |lines: &[(Key, Tree)]| lines.iter().map(|(key, _)| key.name.clone()).collect::<Vec<_>>();
        for (section, names) in [("dimensions", names(&self.dimensions)), ("formulas", names(&self.formulas))] {
            for name in names {
                let Some((_, owner)) = self.owners.iter().find(|(own, _)| *own == name) else { continue };
                let (key, span) = (owner.noted(), owner.span.clone());
                expanded.origins.push(Origin { section, name, key, span });
            }
        }
        expanded.elements.made.extend(names(&self.formulas));
        for (section, lines) in [("dimensions", self.dimensions), ("formulas", self.formulas)] {
            if let Some(entries) = expanded.tree.section(section).filter(|_| !lines.is_empty()) {
                entries.extend(lines);
            }
        }
        crate::expand::geometry::add_blocks(&mut expanded.tree, self.blocks);
        LineOwners(self.owners)
    }
}

impl Owner {
    /// Key with the assumption.
    fn noted(&self) -> String {
        if self.note.is_empty() { self.key.clone() } else { format!("{} ({})", self.key, self.note) }
    }
}

impl LineOwners {
    /// Owner of a key such as `dimensions.first.float.float.hole`, and the rest of the key.
    fn of<'k>(&self, full: &'k str) -> Option<(&Owner, &'k str)> {
        let key = full.strip_prefix("dimensions.")?;
        let mut found: Option<(&Owner, &str)> = None;
        for (name, owner) in &self.0 {
            let Some(rest) = key.strip_prefix(name.as_str()) else { continue };
            if (rest.is_empty() || rest.starts_with('.'))
                && found.is_none_or(|(_, shortest)| rest.len() < shortest.len())
            {
                found = Some((owner, rest));
            }
        }
        found
    }

    /// Faults at the entries of the assembly instead of the lines that these make.
    pub(in crate::expand) fn renamed(&self, mut faults: Faults) -> Faults {
        for found in &mut faults.0 {
            if let Some((owner, rest)) = self.of(&found.key.clone()) {
                found.key = format!("{}{rest}", owner.key);
            }
        }
        faults
    }

    /// Names the entries of the assembly as the origins of lines that geometric elements make.
    pub(in crate::expand) fn rename_origins(&self, expanded: &mut Expanded) {
        for origin in &mut expanded.origins {
            if let Some((owner, _)) = self.of(&origin.key.clone()) {
                (origin.key, origin.span) = (owner.noted(), owner.span.clone());
            }
        }
    }
}

pub(super) fn key(owner: &Owner, name: &str) -> Key {
    Key { span: owner.span.clone(), name: name.to_owned() }
}

pub(super) fn number(owner: &Owner, value: f64) -> Tree {
    Tree { span: owner.span.clone(), value: Value::Number(value) }
}

pub(super) fn text(owner: &Owner, text: impl Into<String>) -> Tree {
    Tree { span: owner.span.clone(), value: Value::Text(text.into()) }
}

/// Fault at a place of an owner.
pub(super) fn at(owner: &Owner, rest: &str, span: &Range<usize>, found: crate::error::StudyFault) -> Fault {
    let key = if rest.is_empty() { owner.key.clone() } else { format!("{}.{rest}", owner.key) };
    crate::error::fault(span.clone(), key, found)
}
