//! Units of a study: ignored, checked with a warning, checked as errors, or converted.

use std::collections::HashMap;

use crate::build::formula_text::{Named, Written};
use crate::build::implicit::Implicit;
use crate::entries::file::StudyFile;
use crate::entries::vocabulary::UNIT_MODES;
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::source::Source;
use sensitol::assembly::Composite;
use sensitol::assembly::formula::{Role, UnitFinding};
use sensitol::warning::Warning;
use sensitol_external::ForeignUnits;
use sensitol_models::{Model, ModelOutput};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::{SAME, Unit};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Labels,
    Warn,
    Check,
    Convert,
}

/// Units of the names in a study, and the mode of their check.
pub(crate) struct Units {
    mode: Mode,
    /// Units of dimensions, constants, unknowns, outputs of the model, and formulas that declare one.
    named: HashMap<String, Unit>,
    unknown: Option<Warning>,
    /// Names whose units are unknown, with the texts of these.
    unread: Vec<(String, String)>,
    /// Roles of the formulas, first of the named ones, then of the conditions.
    roles: Vec<Role>,
    /// Keys, names and places of the formulas, in the same order.
    places: Vec<Place>,
    /// Factors from the units of the study to those of the model, of its inputs and of its outputs.
    factors: [Vec<f64>; 2],
    source: Source,
}

struct Place {
    key: String,
    name: String,
    span: std::ops::Range<usize>,
}

impl Units {
    /// Reads all units. Inputs and outputs of a built-in model are checked against its own units here.
    pub(crate) fn of(
        file: &StudyFile,
        model: Option<&Model>,
        dimensions: &[Dimension],
        written: &Written<'_>,
        source: &Source,
    ) -> Result<Self, Faults> {
        let mode = mode(file)?;
        let mut texts: Vec<(&str, &str)> = Vec::new();
        texts.extend(dimensions.iter().filter_map(|dimension| Some((dimension.name(), dimension.unit()?))));
        let of_constants = file.constants.0.iter();
        texts.extend(
            of_constants.filter_map(|(name, one)| Some((name.get_ref().as_str(), one.get_ref().unit.as_deref()?))),
        );
        let of_unknowns = file.unknowns.0.iter();
        texts.extend(
            of_unknowns.filter_map(|(name, one)| Some((name.get_ref().as_str(), one.get_ref().unit.as_deref()?))),
        );
        match model {
            // With conversion the name of an output means the characteristic everywhere, in the unit that the study requests.
            Some(model) => texts.extend(model.outputs.iter().map(|output| {
                let asked = file.characteristics.0.iter().find(|(name, _)| name.get_ref() == output.name);
                let asked = asked.and_then(|(_, one)| one.get_ref().unit.as_deref()).filter(|_| mode == Mode::Convert);
                (output.name, asked.unwrap_or(output.unit))
            })),
            // A program answers in the unit of the characteristic.
            None => texts.extend(file.characteristics.0.iter().filter_map(|(name, one)| {
                let one = one.get_ref();
                Some((name.get_ref().as_str(), one.unit.as_deref().filter(|_| one.formula.is_none())?))
            })),
        }
        let declared = written.formulas.iter().filter_map(|named| Some((named.name.as_str(), named.unit?)));
        let mut unknown: Vec<(&str, &str)> = Vec::new();
        let mut named = HashMap::new();
        for (name, text) in texts.into_iter().chain(declared) {
            match Unit::parse(text) {
                Some(unit) => _ = named.entry(name.to_owned()).or_insert(unit),
                None => unknown.push((name, text)),
            }
        }
        let unread = unknown.iter().map(|(name, unit)| ((*name).to_owned(), (*unit).to_owned())).collect();
        let unknown = unknown_unit(mode, &unknown);
        let mut units = Self {
            mode,
            named,
            unknown,
            unread,
            roles: roles(model, written),
            places: places(&written.formulas, written.implicit.as_ref()),
            factors: Default::default(),
            source: source.clone(),
        };
        if let Some(model) = model.filter(|_| mode != Mode::Labels) {
            units.factors = units.border(file, model)?;
        }
        Ok(units)
    }

    /// Checks the units of all formulas. Returns warnings, or faults if the mode is stricter.
    pub(crate) fn check(&self, composite: &Composite) -> Result<Vec<Warning>, Faults> {
        if self.mode == Mode::Labels {
            return Ok(Vec::new());
        }
        let unit = |name: &str| self.named.get(name).cloned();
        let role = |index: usize| self.roles.get(index).cloned().unwrap_or(Role::Free);
        let unread = |name: &str| self.unread.iter().find(|(known, _)| known == name).map(|(_, unit)| unit.clone());
        let findings = composite.units(&unit, &unread, &role, self.mode == Mode::Convert);
        if self.mode == Mode::Warn {
            let sure = findings.into_iter().filter(|finding| !finding.doubtful);
            return Ok(self.warning(sure.collect()).into_iter().chain(self.unknown.clone()).collect());
        }
        let mut faults = self.two_scales();
        for UnitFinding { formula, span, what, remedy, .. } in findings {
            let Place { key, span: text, .. } = &self.places[formula];
            let span = self.source.within_string(text.clone(), span);
            faults.0.push(fault(span, key.clone(), StudyFault::Units { what, remedy }));
        }
        faults.none().map(|()| self.unknown.iter().cloned().collect())
    }

    /// Faults of results on another temperature scale than a name of the study: no factor converts one to the other.
    fn two_scales(&self) -> Faults {
        let mut faults = Faults::default();
        for (role, place) in self.roles.iter().zip(&self.places) {
            let Role::Declared(unit) = role else { continue };
            let differs =
                |name: &str, named: &Unit| name != place.name && named.point && unit.point && named.zero != unit.zero;
            let others = self.named.iter().filter(|(name, named)| differs(name, named));
            let Some((name, named)) = others.min_by_key(|(name, _)| *name) else { continue };
            let what = format!("this result is in {unit} and `{name}` in {named}, whose zeros differ");
            let remedy = format!("write both in {named}");
            faults.0.push(fault(place.span.clone(), place.key.clone(), StudyFault::Units { what, remedy }));
        }
        faults
    }

    /// Warning of the first finding, with the names of the other formulas. Returns None if there is no finding.
    fn warning(&self, findings: Vec<UnitFinding>) -> Option<Warning> {
        let mut findings = findings;
        findings.sort_by_key(|finding| finding.formula);
        let mut all = findings.into_iter();
        let UnitFinding { formula, span, what, remedy, .. } = all.next()?;
        let others = all.map(|other| self.places[other.formula].name.clone()).collect();
        let text = self.text(formula);
        let column = 1 + text.get(..span.start).unwrap_or_default().chars().count();
        let part = text.get(span).unwrap_or_default().trim().to_owned();
        let formula = self.places[formula].key.clone();
        Some(Warning::UnitMismatch { formula, column, part, what, instead: remedy, others })
    }

    /// Text of a formula without its quotes.
    fn text(&self, formula: usize) -> String {
        let raw = &self.source.text[self.places[formula].span.clone()];
        let quote = ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quote| raw.starts_with(quote)).unwrap_or("");
        let body = raw.get(quote.len()..raw.len() - quote.len()).unwrap_or_default();
        if quote.len() == 3 { body.strip_prefix('\n').unwrap_or(body).to_owned() } else { body.to_owned() }
    }

    /// Factors of the inputs and outputs of a built-in model. A unit other than the model's is converted or is a fault.
    fn border(&self, file: &StudyFile, model: &Model) -> Result<[Vec<f64>; 2], Faults> {
        let mut faults = Faults::default();
        let mut differs = |name: &str, given: &str, own: &str, of: &str, span: std::ops::Range<usize>, key: String| {
            let (Some(unit), Some(models)) = (Unit::parse(given), Unit::parse(own)) else { return 1.0 };
            let factor = unit.scale / models.scale;
            let same = (factor - 1.0).abs() <= SAME;
            // Temperature scales with different zeros differ by an offset, so no factor converts them.
            let kind = unit.same_kind(&models) && unit.point == models.point;
            if kind && (same || self.mode == Mode::Convert && !unit.point) {
                return if same { 1.0 } else { factor };
            }
            let by = if kind { format!(": factor {factor}") } else { String::new() };
            let what = format!("the {of} `{name}` of the model {} is in {own}, unit says {given}{by}", model.name);
            let remedy = match kind && !unit.point {
                true => format!("write it in {own}, or units = \"convert\" at the top"),
                false => format!("write it in {own}"),
            };
            faults.0.push(fault(span, key, StudyFault::Units { what, remedy }));
            1.0
        };
        let mut factors = Vec::with_capacity(model.inputs.len());
        for input in model.inputs {
            let dimension = file.dimensions.0.iter().find(|(name, _)| name.get_ref() == input.name);
            let constant = file.constants.0.iter().find(|(name, _)| name.get_ref() == input.name);
            let formula = file.formulas.0.iter().find(|(name, _)| name.get_ref() == input.name);
            let given = [
                dimension.map(|(name, one)| ("dimensions", name.span(), one.get_ref().unit.as_deref())),
                constant.map(|(name, one)| ("constants", name.span(), one.get_ref().unit.as_deref())),
                formula.map(|(name, one)| ("formulas", name.span(), one.get_ref().unit.as_deref())),
            ];
            let given = given.into_iter().flatten().find_map(|(section, span, unit)| Some((section, span, unit?)));
            factors.push(given.map_or(1.0, |(section, span, unit)| {
                differs(input.name, unit, input.unit, "input", span, format!("{section}.{}.unit", input.name))
            }));
        }
        let asked = |output: &ModelOutput| {
            let (name, entry) = file.characteristics.0.iter().find(|(name, _)| name.get_ref() == output.name)?;
            let entry = entry.get_ref();
            Some((name, entry.unit.as_deref().filter(|_| entry.formula.is_none())?))
        };
        let outputs = model.outputs.iter().map(|output| {
            asked(output).map_or(1.0, |(name, unit)| {
                let key = format!("characteristics.{}.unit", name.get_ref());
                differs(output.name, unit, output.unit, "output", name.span(), key).recip()
            })
        });
        let outputs = outputs.collect();
        faults.none().map(|()| [factors, outputs])
    }

    /// Factors of the model's inputs and of its outputs.
    pub(crate) fn factors(&self) -> [Vec<f64>; 2] {
        self.factors.clone()
    }

    /// Formulas in SI units, with their results in the declared units. Returns None if nothing is converted.
    pub(crate) fn converted<'f>(&self, written: &Written<'f>) -> Option<Written<'f>> {
        if self.mode != Mode::Convert {
            return None;
        }
        let scale = |name: &str| {
            let formula = written.formulas.iter().position(|named| named.name == name);
            match formula.map(|index| &self.roles[index]) {
                Some(Role::Declared(unit)) => unit.scale,
                Some(_) => 1.0,
                None => self.named.get(name).map_or(1.0, |unit| unit.scale),
            }
        };
        let formulas = written.formulas.iter().zip(&self.roles).map(|(named, role)| {
            let result = if let Role::Declared(unit) = role { unit.scale } else { 1.0 };
            Named { formula: named.formula.converted(&scale, result), ..named.clone() }
        });
        let formulas: Vec<Named<'f>> = formulas.collect();
        let implicit = written.implicit.as_ref().map(|implicit| Implicit {
            conditions: implicit.conditions.with_formulas(&|formula| formula.converted(&scale, 1.0)),
            places: implicit.places.clone(),
        });
        Some(Written { formulas, implicit })
    }
}

/// Handling of units of an external program. An unknown mode is reported elsewhere.
pub(crate) fn foreign(file: &StudyFile) -> ForeignUnits {
    match mode(file) {
        Ok(Mode::Warn | Mode::Check) => ForeignUnits::Refused,
        Ok(Mode::Convert) => ForeignUnits::Converted,
        Ok(Mode::Labels) | Err(_) => ForeignUnits::Ignored,
    }
}

fn mode(file: &StudyFile) -> Result<Mode, Fault> {
    let Some(text) = &file.units else { return Ok(Mode::Warn) };
    let found = text.get_ref();
    match found.as_str() {
        "labels" => Ok(Mode::Labels),
        "warn" => Ok(Mode::Warn),
        "check" => Ok(Mode::Check),
        "convert" => Ok(Mode::Convert),
        _ => {
            let nearest = nearest(found, UNIT_MODES).map(str::to_owned);
            let (known, found) = (UNIT_MODES.map(str::to_owned).to_vec(), found.clone());
            Err(fault(
                text.span(),
                "units",
                StudyFault::UnknownWord { what: "way to hold units", found, nearest, known },
            ))
        }
    }
}

fn unknown_unit(mode: Mode, unknown: &[(&str, &str)]) -> Option<Warning> {
    unknown.first().filter(|_| mode != Mode::Labels)?;
    let mut units: Vec<String> = unknown.iter().map(|(_, unit)| (*unit).to_owned()).collect();
    units.sort();
    units.dedup();
    Some(Warning::UnknownUnit { units })
}

/// Roles of all formulas in the check of units.
fn roles(model: Option<&Model>, written: &Written<'_>) -> Vec<Role> {
    let of_named = |named: &Named<'_>| {
        let input = model.and_then(|model| model.inputs.iter().find(|input| input.name == named.name));
        let unit = named.unit.or(input.map(|input| input.unit));
        match (unit.map(Unit::parse), named.result) {
            (Some(Some(unit)), _) => Role::Declared(unit),
            (None, true) => Role::Result,
            _ => Role::Free,
        }
    };
    let mut roles: Vec<Role> = written.formulas.iter().map(of_named).collect();
    let first = roles.len();
    let places = written.implicit.as_ref().map_or_else(Vec::new, |implicit| implicit.conditions.places());
    for (index, place) in places.iter().enumerate() {
        roles.push(match place {
            None => Role::Free,
            Some(place) if place % 2 == 0 => Role::Like(first + index - place),
            Some(_) => Role::Angle,
        });
    }
    roles
}

fn places(formulas: &[Named<'_>], implicit: Option<&Implicit>) -> Vec<Place> {
    let named =
        formulas.iter().map(|one| Place { key: one.key.clone(), name: one.name.clone(), span: one.span.clone() });
    let of_conditions = implicit.into_iter().flat_map(|implicit| &implicit.places);
    named
        .chain(of_conditions.map(|(span, key)| Place { key: key.clone(), name: key.clone(), span: span.clone() }))
        .collect()
}
