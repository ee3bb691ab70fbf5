//! Faces: analytic surfaces and their extents.

use std::collections::{HashMap, HashSet};

use super::aspect::{Effort, FACES};
use super::placement::{cross, dot, minus, placement, plus, triple, unit};
use crate::part21::{Entity, EntityTable, Part21Error, StepValue};

/// Surface of a face.
#[derive(Debug, Clone, PartialEq)]
pub enum FaceSurface {
    /// A plane.
    Plane {
        /// A point of the plane.
        point: [f64; 3],
        /// Normal out of the material.
        normal: [f64; 3],
    },
    /// A cylinder.
    Cylinder {
        /// A point of the axis.
        point: [f64; 3],
        /// Direction of the axis.
        axis: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// A cone.
    Cone {
        /// Point of the axis at which the radius holds.
        point: [f64; 3],
        /// Direction of the axis, in which the radius grows.
        axis: [f64; 3],
        /// Radius at the point.
        radius: f64,
        /// Angle between axis and surface, in the unit of the file.
        half_angle: f64,
    },
    /// A sphere.
    Sphere {
        /// Centre.
        centre: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// A torus.
    Torus {
        /// Centre.
        centre: [f64; 3],
        /// Direction of the axis.
        axis: [f64; 3],
        /// Radius of the circle on which the centres of the tube are.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// Another surface, by its types in the file.
    Other(String),
}

/// A circle that is a whole edge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct WholeCircle {
    centre: [f64; 3],
    axis: [f64; 3],
    radius: f64,
}

/// A face of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct StepFace {
    /// Number of the entity.
    pub entity: u64,
    /// Surface.
    pub surface: FaceSurface,
    /// True if the material lies inside: of a pin, not of a hole. True for planes.
    pub convex: bool,
    points: Vec<[f64; 3]>,
    circles: Vec<WholeCircle>,
}

impl StepFace {
    /// Least and greatest coordinate of the edges along a direction of length 1. Returns None for a face without edges.
    pub fn extent(&self, direction: [f64; 3]) -> Option<[f64; 2]> {
        let mut found: Option<[f64; 2]> = None;
        let mut add = |low: f64, high: f64| {
            let [a, b] = found.unwrap_or([low, high]);
            found = Some([a.min(low), b.max(high)]);
        };
        for &point in &self.points {
            let at = dot(point, direction);
            add(at, at);
        }
        for circle in &self.circles {
            let across = dot(circle.axis, direction);
            let half = circle.radius * (1.0 - across * across).max(0.0).sqrt();
            let middle = dot(circle.centre, direction);
            add(middle - half, middle + half);
        }
        found
    }
}

/// Points and whole circles of the edges of a loop.
#[derive(Debug, Clone, Default)]
struct Outline {
    points: Vec<[f64; 3]>,
    circles: Vec<WholeCircle>,
}

/// Reads faces, each once.
#[derive(Debug)]
pub(super) struct Faces<'t> {
    table: &'t EntityTable<'t>,
    read: HashMap<u64, Option<StepFace>>,
    effort: Effort,
}

impl<'t> Faces<'t> {
    pub(super) fn new(table: &'t EntityTable<'t>) -> Self {
        Self { table, read: HashMap::new(), effort: Effort::default() }
    }

    /// Face of this number. Returns None if its entity is no face or lacks a surface.
    pub(super) fn face(&mut self, id: u64) -> Result<Option<StepFace>, Part21Error> {
        if let Some(face) = self.read.get(&id) {
            return Ok(face.clone());
        }
        let face = self.fresh(id)?;
        self.read.insert(id, face.clone());
        Ok(face)
    }

    fn fresh(&self, id: u64) -> Result<Option<StepFace>, Part21Error> {
        let Some(entity) = self.table.get(id) else { return Ok(None) };
        if entity.first_of(&FACES).is_none() {
            return Ok(None);
        }
        let all = entity.all()?;
        // A complex face states bounds and surface in different types: FACE(bounds) and FACE_SURFACE(surface, sense).
        let find = |test: fn(&StepValue<'_>) -> bool| {
            all.iter().flat_map(|(_, arguments)| arguments).find(|value| test(value)).cloned()
        };
        let surface = find(|value| value.reference().is_some()).and_then(|value| value.reference());
        let Some(surface) = surface else { return Ok(None) };
        let bounds =
            find(|value| matches!(value, StepValue::List(_))).map(|value| value.references()).unwrap_or_default();
        let same = find(|value| matches!(value, StepValue::Word(_))).is_none_or(|word| word.word() != Some("F"));
        let surface = self.surface(self.table.referred(id, surface)?, same)?;
        let mut outline = Outline::default();
        let mut seen = HashSet::new();
        for bound in bounds {
            self.bound(id, bound, &mut seen, &mut outline)?;
        }
        let convex = same || matches!(surface, FaceSurface::Plane { .. });
        Ok(Some(StepFace { entity: id, surface, convex, points: outline.points, circles: outline.circles }))
    }

    fn surface(&self, entity: Entity<'_>, same: bool) -> Result<FaceSurface, Part21Error> {
        const KINDS: [&str; 5] =
            ["PLANE", "CYLINDRICAL_SURFACE", "CONICAL_SURFACE", "SPHERICAL_SURFACE", "TOROIDAL_SURFACE"];
        let other = || Ok(FaceSurface::Other(entity.kind_text()));
        let mut all = entity.all()?;
        let (1, Some(kind)) = (all.len(), entity.first_of(&KINDS)) else { return other() };
        let arguments = all.swap_remove(0).1;
        let Some(position) = arguments.get(1).and_then(StepValue::reference) else { return other() };
        let Some(position) = placement(self.table, entity.id(), position)? else { return other() };
        let (point, axis) = (position.place, position.direction([0.0, 0.0, 1.0]));
        let number = |index: usize| arguments.get(index).and_then(StepValue::number);
        Ok(match (kind, number(2), number(3)) {
            ("PLANE", ..) => {
                let normal = if same { axis } else { axis.map(|part| -part) };
                FaceSurface::Plane { point, normal }
            }
            ("CYLINDRICAL_SURFACE", Some(radius), _) => FaceSurface::Cylinder { point, axis, radius },
            ("CONICAL_SURFACE", Some(radius), Some(half_angle)) => {
                FaceSurface::Cone { point, axis, radius, half_angle }
            }
            ("SPHERICAL_SURFACE", Some(radius), _) => FaceSurface::Sphere { centre: point, radius },
            ("TOROIDAL_SURFACE", Some(major), Some(minor)) => FaceSurface::Torus { centre: point, axis, major, minor },
            _ => return other(),
        })
    }

    /// Adds the edges of a bound of a face.
    fn bound(&self, from: u64, bound: u64, seen: &mut HashSet<u64>, outline: &mut Outline) -> Result<(), Part21Error> {
        let bound = self.table.referred(from, bound)?;
        let arguments = bound.inherited("FACE_BOUND")?;
        let Some(edges) = arguments.get(1).and_then(StepValue::reference) else { return Ok(()) };
        let edges = self.table.referred(bound.id(), edges)?;
        if !seen.insert(edges.id()) {
            return Ok(());
        }
        let all = edges.all()?;
        let members: Vec<u64> = all.iter().flat_map(|(_, of)| of.iter().flat_map(StepValue::references)).collect();
        self.effort.add(edges.id(), members.len())?;
        for member in members {
            let member = self.table.referred(edges.id(), member)?;
            if member.is("ORIENTED_EDGE") {
                let arguments = member.inherited("ORIENTED_EDGE")?;
                let edge = arguments.iter().rev().find_map(StepValue::reference);
                let Some(edge) = edge else { continue };
                let edge = self.table.referred(member.id(), edge)?;
                if seen.insert(edge.id()) {
                    self.edge(edge, outline)?;
                }
            } else if member.is("VERTEX_POINT") {
                outline.points.extend(self.vertex(edges.id(), member.id())?);
            } else if member.is("CARTESIAN_POINT") {
                outline.points.extend(triple(self.table, edges.id(), member.id())?);
            }
        }
        Ok(())
    }

    fn vertex(&self, from: u64, vertex: u64) -> Result<Option<[f64; 3]>, Part21Error> {
        let vertex = self.table.referred(from, vertex)?;
        let arguments = vertex.inherited("VERTEX_POINT")?;
        match arguments.iter().rev().find_map(StepValue::reference) {
            Some(point) => triple(self.table, vertex.id(), point),
            None => Ok(None),
        }
    }

    fn edge(&self, edge: Entity<'_>, outline: &mut Outline) -> Result<(), Part21Error> {
        let arguments = edge.inherited("EDGE_CURVE")?;
        let part = |index: usize| arguments.get(index).and_then(StepValue::reference);
        let ends = [part(1), part(2)];
        for end in ends.into_iter().flatten() {
            outline.points.extend(self.vertex(edge.id(), end)?);
        }
        let Some(curve) = part(3) else { return Ok(()) };
        let curve = self.table.referred(edge.id(), curve)?;
        let Some(arguments) = curve.arguments("CIRCLE")? else { return Ok(()) };
        let position = arguments.get(1).and_then(StepValue::reference);
        let (Some(position), Some(radius)) = (position, arguments.get(2).and_then(StepValue::number)) else {
            return Ok(());
        };
        let Some(position) = placement(self.table, curve.id(), position)? else { return Ok(()) };
        let circle = WholeCircle { centre: position.place, axis: position.direction([0.0, 0.0, 1.0]), radius };
        if ends[0] == ends[1] {
            outline.circles.push(circle);
        } else {
            self.arc(edge, &circle, outline)?;
        }
        Ok(())
    }

    /// Adds the middle of an arc of half a circle or less, so that the extent across it is not that of its chord.
    fn arc(&self, edge: Entity<'_>, circle: &WholeCircle, outline: &mut Outline) -> Result<(), Part21Error> {
        let arguments = edge.inherited("EDGE_CURVE")?;
        let mut ends = Vec::new();
        for index in [1, 2] {
            let Some(end) = arguments.get(index).and_then(StepValue::reference) else { return Ok(()) };
            ends.extend(self.vertex(edge.id(), end)?);
        }
        let [start, end] = ends[..] else { return Ok(()) };
        let same = arguments.get(4).and_then(StepValue::word) != Some("F");
        let (start, end) = if same { (start, end) } else { (end, start) };
        let Some(x) = unit(minus(start, circle.centre)) else { return Ok(()) };
        let y = cross(circle.axis, x);
        let to = minus(end, circle.centre);
        let angle = dot(to, y).atan2(dot(to, x)).rem_euclid(2.0 * std::f64::consts::PI);
        // Eighths of the arc: the extent is short of the true one by at most 2 % of the radius.
        for eighth in 1..8 {
            let at = angle * f64::from(eighth) / 8.0;
            let point = plus(plus(circle.centre, circle.radius * at.cos(), x), circle.radius * at.sin(), y);
            outline.points.push(point);
        }
        Ok(())
    }
}
