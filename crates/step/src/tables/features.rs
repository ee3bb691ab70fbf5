//! Features of a part: names, shapes and tolerances.

use std::collections::{BTreeMap, HashMap};

use super::cluster::{Clusters, FeatureShape, SAME_LENGTH, median, shape};
use super::text::{UniqueNames, direction, list, name_of, number, point};
use super::zone_keys::{FeatureZones, KeyText};
use crate::semantic::{FaceSurface, StepDatum, StepFace, StepPart, StepUnit, plus};

/// A feature of a part.
#[derive(Debug, Clone)]
pub(super) struct TableFeature {
    pub(super) name: String,
    /// Shape in the unit of the part.
    pub(super) shape: FeatureShape,
    /// True for a pin, false for a hole.
    pub(super) convex: bool,
    /// Text of the diameter: the name of a dimension or a formula. None for the nominal number.
    pub(super) diameter: Option<String>,
    pub(super) zones: FeatureZones,
    pub(super) notes: Vec<String>,
}

impl TableFeature {
    /// Keys of the frame with their values. `scale` leads from the unit of the part to that of the study.
    pub(super) fn keys(&self, scale: f64) -> Vec<KeyText> {
        let diameter = |radius: &Option<f64>| {
            let nominal = radius.map(|radius| number(2.0 * radius));
            self.diameter.as_ref().map(|name| format!("\"{name}\"")).or(nominal)
        };
        let mut found = Vec::new();
        match self.shape.scaled(scale) {
            FeatureShape::Plane { point: at, normal, size } => {
                found.push(("plane", point(at)));
                found.push(("normal", direction(normal)));
                let size = size.filter(|[a, b]| *a > 0.0 && *b > 0.0);
                found.extend(size.map(|size| ("size", list(&size))));
            }
            FeatureShape::Axis { point: at, along, length, radius } => {
                found.push(("axis", point(at)));
                found.push(("along", direction(along)));
                found.extend(diameter(&radius).map(|text| ("diameter", text)));
                found.extend(length.filter(|length| *length > 0.0).map(|length| ("length", number(length))));
            }
            FeatureShape::Point { point: at, radius } => {
                found.push(("point", point(at)));
                found.extend(diameter(&radius).map(|text| ("diameter", text)));
            }
        }
        found
    }
}

/// Features of a part, by the faces that they are.
#[derive(Debug)]
pub(super) struct Features {
    pub(super) all: Vec<TableFeature>,
    clusters: Clusters,
    members: BTreeMap<u64, Vec<u64>>,
    by_root: HashMap<u64, usize>,
    by_pair: HashMap<(u64, u64), usize>,
    by_letter: BTreeMap<String, Vec<usize>>,
    names: UniqueNames,
    counts: HashMap<&'static str, usize>,
    /// Greatest distance of two surfaces that are one, in the unit of the part.
    pub(super) tolerance: f64,
}

/// Groups of faces that something names together.
fn groups(part: &StepPart) -> Vec<Vec<u64>> {
    let mut found: Vec<Vec<u64>> = part.datums.iter().map(|datum| datum.faces.clone()).collect();
    found.extend(part.dimensions.iter().flat_map(|dimension| dimension.ends.iter().cloned()));
    found.extend(part.tolerances.iter().map(|tolerance| tolerance.faces.clone()));
    found
}

impl Features {
    pub(super) fn new(part: &StepPart) -> Self {
        let tolerance = match part.unit {
            StepUnit::Length(scale) => SAME_LENGTH / scale,
            _ => SAME_LENGTH * 1e3,
        };
        let clusters = Clusters::new(part, &groups(part), tolerance);
        let members = clusters.members();
        let mut found = Self {
            all: Vec::new(),
            clusters,
            members,
            by_root: HashMap::new(),
            by_pair: HashMap::new(),
            by_letter: BTreeMap::new(),
            names: UniqueNames::default(),
            counts: HashMap::new(),
            tolerance,
        };
        // These keys of a part are no features.
        ["ground", "at", "turned"].into_iter().for_each(|key| _ = found.names.take(key));
        part.datums.iter().for_each(|datum| found.datum(part, datum));
        found
    }

    /// Clusters of some faces.
    pub(super) fn roots(&self, faces: &[u64]) -> Vec<u64> {
        self.clusters.of(faces)
    }

    /// All clusters of the part.
    pub(super) fn all_roots(&self) -> Vec<u64> {
        self.members.keys().copied().collect()
    }

    /// Shape of a cluster in the unit of the part, and true for a convex one.
    pub(super) fn shape(&self, part: &StepPart, root: u64) -> Option<(FeatureShape, bool)> {
        let faces = self.faces(part, root);
        let convex = faces.first()?.convex;
        Some((shape(&faces)?, convex))
    }

    fn faces<'p>(&self, part: &'p StepPart, root: u64) -> Vec<&'p StepFace> {
        self.members.get(&root).into_iter().flatten().filter_map(|face| part.faces.get(face)).collect()
    }

    fn push(&mut self, name: String, shape: FeatureShape) -> usize {
        let (diameter, zones, notes) = (None, FeatureZones::default(), Vec::new());
        self.all.push(TableFeature { name, shape, convex: true, diameter, zones, notes });
        self.all.len() - 1
    }

    /// Adds the features of a datum, named by its letter.
    fn datum(&mut self, part: &StepPart, datum: &StepDatum) {
        let letter: String = datum.letter.chars().filter(char::is_ascii_alphanumeric).collect();
        let letter = if letter.is_empty() { name_of(&datum.letter, "datum") } else { letter };
        let roots = self.roots(&datum.faces);
        let mut found = Vec::new();
        if let Some(pair) = self.pair(part, &roots, Some(&letter)) {
            found.push(pair);
        } else if let [root] = roots[..] {
            found.extend(self.named(part, root, &letter));
        } else {
            for (index, root) in roots.iter().enumerate() {
                found.extend(self.named(part, *root, &format!("{letter}_{}", index + 1)));
            }
        }
        if found.is_empty() {
            found.extend(self.targets(datum, &letter));
        }
        self.by_letter.entry(datum.letter.clone()).or_default().extend(found);
    }

    /// Plane through the middle of the targets of a datum without faces. Returns None if their places are not given.
    fn targets(&mut self, datum: &StepDatum, letter: &str) -> Option<usize> {
        let places: Vec<_> = datum.targets.iter().filter_map(|target| target.placement).collect();
        let normal = places.first()?.direction([0.0, 0.0, 1.0]);
        let sum = places.iter().fold([0.0; 3], |sum, place| plus(sum, 1.0, place.place));
        let point = sum.map(|part| part / places.len() as f64);
        let name = self.names.take(letter);
        let index = self.push(name, FeatureShape::Plane { point, normal, size: None });
        self.all[index].notes.push(match places.len() {
            1 => "the datum target".to_owned(),
            targets => format!("the middle of {targets} datum targets"),
        });
        Some(index)
    }

    /// Feature of a cluster. The first name that a cluster gets stays.
    fn named(&mut self, part: &StepPart, root: u64, name: &str) -> Option<usize> {
        if let Some(&index) = self.by_root.get(&root) {
            return Some(index);
        }
        let faces = self.faces(part, root);
        let shape = shape(&faces)?;
        let convex = faces.first()?.convex;
        let other = match &faces.first()?.surface {
            FaceSurface::Other(kind) => Some(kind.to_ascii_lowercase()),
            FaceSurface::Cone { .. } => Some("cone: its axis".to_owned()),
            FaceSurface::Torus { .. } => Some("torus: its axis".to_owned()),
            _ => None,
        };
        let other =
            other.map(|kind| if kind.contains(':') { kind } else { format!("{kind}: the middle of its edges") });
        let name = self.names.take(name);
        let index = self.push(name, shape);
        self.all[index].convex = convex;
        self.all[index].notes.extend(other);
        self.by_root.insert(root, index);
        Some(index)
    }

    /// Middle plane of two clusters. Returns None unless they are two opposite planes.
    pub(super) fn pair(&mut self, part: &StepPart, roots: &[u64], name: Option<&str>) -> Option<usize> {
        let [a, b] = *roots else { return None };
        let key = (a.min(b), a.max(b));
        if let Some(&index) = self.by_pair.get(&key) {
            return Some(index);
        }
        let shapes = [self.shape(part, a)?.0, self.shape(part, b)?.0];
        let shape = median(&shapes[0], &shapes[1], self.tolerance)?;
        let name = match name {
            Some(name) => self.names.take(name),
            None => {
                let number = self.count("middle");
                self.names.take(&format!("middle_{number}"))
            }
        };
        let index = self.push(name, shape);
        self.all[index].notes.push("the middle of two opposite faces".to_owned());
        self.by_pair.insert(key, index);
        Some(index)
    }

    /// Middle plane of two clusters that is a feature already.
    pub(super) fn known_pair(&self, roots: &[u64]) -> Option<usize> {
        let [a, b] = *roots else { return None };
        self.by_pair.get(&(a.min(b), a.max(b))).copied()
    }

    fn count(&mut self, word: &'static str) -> usize {
        let count = self.counts.entry(word).or_insert(0);
        *count += 1;
        *count
    }

    /// Features of some clusters. New ones are named by their shape, and those of a pattern by one number.
    pub(super) fn of(&mut self, part: &StepPart, roots: &[u64]) -> Vec<usize> {
        let mut fresh: BTreeMap<&'static str, Vec<u64>> = BTreeMap::new();
        for &root in roots.iter().filter(|root| !self.by_root.contains_key(root)) {
            if let Some(face) = self.faces(part, root).first() {
                fresh.entry(word(face)).or_default().push(root);
            }
        }
        for (word, fresh) in fresh {
            let number = self.count(word);
            for (index, &root) in fresh.iter().enumerate() {
                let name = match fresh.len() {
                    1 => format!("{word}_{number}"),
                    _ => format!("{word}_{number}_{}", index + 1),
                };
                self.named(part, root, &name);
            }
        }
        roots.iter().filter_map(|root| self.by_root.get(root).copied()).collect()
    }

    /// Features of a datum: one, or two that are one datum.
    ///
    /// # Errors
    /// Returns why there is none.
    pub(super) fn datum_features(&self, letter: &str) -> Result<Vec<usize>, String> {
        match self.by_letter.get(letter).map_or(&[][..], Vec::as_slice) {
            [] => Err(format!("datum {letter} has no feature")),
            found if found.len() <= 2 => Ok(found.to_vec()),
            _ => Err(format!("datum {letter} has several features")),
        }
    }
}

/// Word for a face in names.
fn word(face: &StepFace) -> &'static str {
    match (&face.surface, face.convex) {
        (FaceSurface::Plane { .. }, _) => "face",
        (FaceSurface::Cylinder { .. }, false) => "hole",
        (FaceSurface::Cylinder { .. }, true) => "pin",
        (FaceSurface::Cone { .. }, _) => "cone",
        (FaceSurface::Sphere { .. }, _) => "ball",
        (FaceSurface::Torus { .. }, _) => "torus",
        (FaceSurface::Other(_), _) => "surface",
    }
}
