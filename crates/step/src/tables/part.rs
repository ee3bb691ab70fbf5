//! Writes the table of one part.

use super::cluster::FeatureShape;
use super::datum_frame::datum_names;
use super::features::Features;
use super::sizes::{StudyUnit, line, suffix};
use super::text::{UniqueNames, comment, number, point};
use super::zone_keys::{KeyText, rank};
use super::{OpenItem, OpenReason, StudyTables, TableRequest};
use crate::semantic::{
    DimensionKind, GeometricTolerance, Placement, StepDimension, StepPart, ToleranceKind, ZoneShape,
};

/// Writer of a part at its place.
pub(super) struct PartWriter<'m> {
    pub(super) part: &'m StepPart,
    pub(super) name: String,
    /// Factor from the unit of the part to that of the study.
    pub(super) scale: f64,
    pub(super) placement: Option<Placement>,
    pub(super) features: Features,
    /// False for a further occurrence of a part, whose tolerances were counted.
    is_first: bool,
}

impl<'m> PartWriter<'m> {
    pub(super) fn new(
        part: &'m StepPart,
        name: String,
        scale: f64,
        placement: Option<Placement>,
        is_first: bool,
    ) -> Self {
        let mut found = Self { part, name, scale, placement, features: Features::new(part), is_first };
        found.name_features();
        found
    }

    /// Names the features of dimensions and tolerances, in this order.
    fn name_features(&mut self) {
        let part = self.part;
        for dimension in part.dimensions.iter().filter(|dimension| dimension.is_size) {
            let roots = self.features.roots(dimension.ends.first().map_or(&[], Vec::as_slice));
            match self.features.known_pair(&roots) {
                Some(_) => {}
                None => _ = self.features.of(part, &roots),
            }
        }
        for tolerance in &part.tolerances {
            self.targets(tolerance);
        }
        for dimension in part.dimensions.iter().filter(|dimension| !dimension.is_size) {
            for end in &dimension.ends {
                let roots = self.features.roots(end);
                self.features.of(part, &roots);
            }
        }
    }

    /// Features that a tolerance controls.
    fn targets(&mut self, tolerance: &GeometricTolerance) -> Vec<usize> {
        let roots = self.features.roots(&tolerance.faces);
        let of_middle = match tolerance.kind {
            ToleranceKind::Position | ToleranceKind::Symmetry => self.features.pair(self.part, &roots, None),
            ToleranceKind::Perpendicularity | ToleranceKind::Parallelism | ToleranceKind::Angularity => {
                self.features.known_pair(&roots)
            }
            _ => None,
        };
        let mut found = match of_middle {
            Some(middle) => vec![middle],
            None => self.features.of(self.part, &roots),
        };
        // A cylindrical zone is of an axis: the floor of a counterbore beside it has none.
        let is_plane = |index: &usize| matches!(self.features.all[*index].shape, FeatureShape::Plane { .. });
        if matches!(tolerance.zone, ZoneShape::Cylinder | ZoneShape::Sphere) && !found.iter().all(is_plane) {
            found.retain(|index| !is_plane(index));
        }
        found
    }

    /// Writes dimensions and features.
    pub(super) fn write(
        &mut self,
        request: &TableRequest,
        prefixed: bool,
        unit: &str,
        metres: f64,
        names: &mut UniqueNames,
        found: &mut StudyTables,
    ) {
        let unit = StudyUnit { name: unit, metres };
        let part = self.part;
        for dimension in &part.dimensions {
            self.dimension(dimension, request, prefixed, unit, names, &mut found.dimensions);
        }
        let mut open = Vec::new();
        // Places first, so that a direction that refines one finds it.
        let mut ordered: Vec<&GeometricTolerance> = part.tolerances.iter().collect();
        ordered.sort_by_key(|tolerance| rank(tolerance));
        for tolerance in ordered {
            match self.tolerance(tolerance, unit) {
                Ok(()) if !self.is_first => {}
                Ok(()) if request.keys.takes("position") => found.written += 1,
                Ok(()) => found.waiting += 1,
                Err(item) => open.push((tolerance.entity, item)),
            }
        }
        open.sort_by_key(|(entity, _)| *entity);
        let open: Vec<OpenItem> = open.into_iter().map(|(_, item)| item).collect();
        found.parts += &self.table(request, &open);
        found.features += self.features.all.len();
        if self.is_first {
            found.open.extend(open);
        }
    }

    /// Adds the tolerance to its features. Returns a comment if none can have it.
    fn tolerance(&mut self, tolerance: &GeometricTolerance, unit: StudyUnit<'_>) -> Result<(), OpenItem> {
        let item = |reason: OpenReason, text: &str| {
            let value = tolerance.value.map(|value| format!(" {}", number(unit.value(&value)))).unwrap_or_default();
            let letters: Vec<String> = tolerance.datums.iter().map(|one| comment(&one.letters.join("-"))).collect();
            let datums = if letters.is_empty() { String::new() } else { format!(", datums {}", letters.join(" ")) };
            let line = format!("# {}{value}{datums}: {text} (#{})", tolerance.kind.label(), tolerance.entity);
            OpenItem { reason, line }
        };
        let Some(value) = &tolerance.value else { return Err(item(OpenReason::NoValue, "no value in the file")) };
        let targets = self.targets(tolerance);
        if targets.is_empty() {
            return Err(match (&tolerance.other, tolerance.whole) {
                (_, true) => item(OpenReason::WholePart, "of the whole part"),
                (Some((id, kind)), false) => item(
                    OpenReason::NoFace,
                    &format!("names no face but #{id}, {}", comment(&kind.to_ascii_lowercase())),
                ),
                (None, false) => item(OpenReason::NoFace, "names no face"),
            });
        }
        let datums = match self.datums(tolerance) {
            Ok(datums) => datums,
            Err(reason) => return Err(item(OpenReason::NoKey, &reason)),
        };
        let mut refused = None;
        let mut written = 0;
        for index in targets {
            match self.add(index, tolerance, unit.value(value), datums.as_deref()) {
                Ok(()) => written += 1,
                Err(reason) => refused = Some(format!("{}: {reason}", self.features.all[index].name)),
            }
        }
        match refused {
            Some(reason) if written == 0 => {
                let reason = match tolerance.upper {
                    Some(upper) => format!("{reason}, lower segment of #{upper}"),
                    None => reason,
                };
                Err(item(OpenReason::NoKey, &reason))
            }
            _ => Ok(()),
        }
    }

    /// Adds a tolerance to a feature. Returns why the feature cannot have it as a key.
    fn add(
        &mut self,
        index: usize,
        tolerance: &GeometricTolerance,
        value: f64,
        datums: Option<&[Vec<usize>]>,
    ) -> Result<(), String> {
        let (names, idle) = match datums {
            Some(datums) => {
                let (names, idle) = datum_names(&self.features.all, index, datums, self.features.tolerance)?;
                (Some(names), idle)
            }
            None => (None, Vec::new()),
        };
        let datum = names.as_ref().and_then(|names| names.features.first());
        let datum = datum.map(|&datum| self.features.all[datum].shape.clone());
        let feature = &mut self.features.all[index];
        let shape = feature.shape.scaled(self.scale);
        // A formula of a radius is no size that gives a bonus.
        let size = feature.diameter.clone().filter(|name| !name.contains('*'));
        let size = size.map(|name| (if feature.convex { "pin" } else { "hole" }, name));
        feature.zones.add(tolerance, value, names, (&shape, datum.as_ref()), size)?;
        feature.notes.extend(notes(tolerance));
        if let Some(upper) = tolerance.upper {
            let entity = tolerance.entity;
            feature.notes.push(format!("#{entity}: lower segment of #{upper}, each face alone"));
        }
        let fixes_nothing = |name: String| format!("#{}: datum {name} fixes nothing more", tolerance.entity);
        feature.notes.extend(idle.into_iter().map(fixes_nothing));
        Ok(())
    }

    /// Features of the datums of a tolerance, those of a common datum together. Returns why there is none.
    fn datums(&self, tolerance: &GeometricTolerance) -> Result<Option<Vec<Vec<usize>>>, String> {
        if !tolerance.has_datums {
            return Ok(None);
        }
        if tolerance.datums.is_empty() {
            return Err("its datums are not in the file".to_owned());
        }
        let mut found = Vec::new();
        for reference in &tolerance.datums {
            let mut features = Vec::new();
            for letter in &reference.letters {
                features.extend(self.features.datum_features(letter).map_err(|reason| comment(&reason))?);
            }
            found.push(features);
        }
        Ok(Some(found))
    }

    /// Writes a dimension, and the diameter of its features.
    fn dimension(
        &mut self,
        dimension: &StepDimension,
        request: &TableRequest,
        prefixed: bool,
        unit: StudyUnit<'_>,
        names: &mut UniqueNames,
        lines: &mut Vec<String>,
    ) {
        let prefix = if prefixed { format!("{}_", self.name) } else { String::new() };
        let word = suffix(dimension.kind);
        let ends: Vec<Vec<usize>> = (dimension.ends.iter())
            .map(|end| {
                let roots = self.features.roots(end);
                match self.features.known_pair(&roots) {
                    Some(pair) if dimension.is_size => vec![pair],
                    _ => self.features.of(self.part, &roots),
                }
            })
            .collect();
        if !dimension.is_size {
            let named: Vec<&str> = ends
                .iter()
                .filter_map(|end| end.first())
                .map(|&index| self.features.all[index].name.as_str())
                .collect();
            let wanted = match named[..] {
                [a, b] => format!("{prefix}{a}_to_{b}"),
                [a] => format!("{prefix}{a}_{word}"),
                _ => format!("{prefix}{word}_{}", dimension.entity),
            };
            lines.push(line(dimension, &wanted, unit, request, names).0);
            return;
        }
        let features = ends.into_iter().next().unwrap_or_default();
        let is_round = matches!(dimension.kind, DimensionKind::Diameter | DimensionKind::Radius);
        // Sizes of a pattern are made one by one. Another size names no single feature.
        if !is_round || features.is_empty() {
            let wanted = match features.first() {
                Some(&index) => format!("{prefix}{}_{word}", self.features.all[index].name),
                None => format!("{prefix}{word}_{}", dimension.entity),
            };
            lines.push(line(dimension, &wanted, unit, request, names).0);
            return;
        }
        for index in features {
            let feature = &mut self.features.all[index];
            let wanted = format!("{prefix}{}_{word}", feature.name);
            let (text, name) = line(dimension, &wanted, unit, request, names);
            lines.push(text);
            let has_radius = match &feature.shape {
                FeatureShape::Axis { radius, .. } | FeatureShape::Point { radius, .. } => radius.is_some(),
                FeatureShape::Plane { .. } => false,
            };
            if let (Some(name), true, None) = (name, has_radius, &feature.diameter) {
                feature.diameter = Some(match dimension.kind {
                    // A hyphen in the name of a part would be a minus sign.
                    DimensionKind::Radius if name.contains('-') => format!("2*`{name}`"),
                    DimensionKind::Radius => format!("2*{name}"),
                    _ => name,
                });
            }
        }
    }

    /// Text of the table.
    fn table(&self, request: &TableRequest, open: &[OpenItem]) -> String {
        let mut text = format!("\n[parts.{}]\n", self.name);
        let all = &self.features.all;
        if let Some(placement) = &self.placement {
            let turned = placement.rotation_vector().map(f64::to_degrees);
            text += &format!("at = {}\n", point(placement.place.map(|part| part * self.scale)));
            if turned != [0.0; 3] {
                text += &format!("turned = {}\n", point(turned));
            }
        }
        let width = all.iter().map(|feature| feature.name.len()).max().unwrap_or(0).min(24);
        for feature in all {
            let mut keys = feature.keys(self.scale);
            keys.extend(feature.zones.keys());
            let (taken, waiting): (Vec<KeyText>, Vec<KeyText>) =
                keys.into_iter().partition(|(key, _)| request.keys.takes(key));
            text += &format!("{:width$} = {{ {} }}", feature.name, pairs(&taken));
            let entities: Vec<String> = feature.zones.entities.iter().map(|id| format!("#{id}")).collect();
            let mut remarks: Vec<String> = feature.notes.clone();
            let waits = !waiting.is_empty();
            if !entities.is_empty() && !waits {
                remarks.insert(0, entities.join(", "));
            }
            if !remarks.is_empty() {
                text += &format!("  # {}", remarks.join("; "));
            }
            text.push('\n');
            if waits && !entities.is_empty() {
                text += &format!("# {}: {} ({})\n", feature.name, pairs(&waiting), entities.join(", "));
            }
        }
        for item in open {
            text += &format!("{}\n", item.line);
        }
        text
    }
}

/// Pairs of an inline table.
fn pairs(keys: &[KeyText]) -> String {
    keys.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
}

/// Remarks on parts of a tolerance that its keys do not cover.
fn notes(tolerance: &GeometricTolerance) -> Vec<String> {
    let mut found = Vec::new();
    if !tolerance.modifiers.is_empty() {
        let words = tolerance.modifiers.join(", ").to_ascii_lowercase().replace('_', " ");
        found.push(format!("#{}: {}", tolerance.entity, comment(&words)));
    }
    for reference in tolerance.datums.iter().filter(|reference| !reference.modifiers.is_empty()) {
        let words = reference.modifiers.join(", ").to_ascii_lowercase().replace('_', " ");
        found.push(format!(
            "#{}: datum {} with {}",
            tolerance.entity,
            comment(&reference.letters.join("-")),
            comment(&words)
        ));
    }
    found
}
