//! The rare sides of the switches of a model, as half-spaces, and their probability.
//!
//! A switch whose smaller side holds less than a hundredth of all assemblies is met by few or no points of a sample. Its margin is known,
//! so that a search can find it. It starts from the nearest of some points with two and three times the scatter of the assemblies. Steps of
//! Hasofer and Lind (1974; Rackwitz and Fiessler 1978) lead to the likeliest point beyond, the design point `z*` at the distance `beta`.
//! The half-space `z*/beta . z > beta - 0.5` contains nearly all of that side. A stratum of its own makes it as accurate as the rest.

use std::cell::OnceCell;

use serde::Serialize;

use crate::assembly::{ContactSets, Switch, SwitchKind};
use crate::estimate::cheap_model::CheapModel;
use crate::estimate::normal_space::Columns;
use crate::estimate::strata::{HalfSpace, REACH, length, outside_of};
use crate::warning::{Change, ContactShare, Warning};
use sensitol_numeric::sampling::Normals;

/// Points at which margins are evaluated, for each of three widths: plain, twice and three times as wide.
const POINTS: usize = 1 << 11;
/// Points for the shares of sets of contacts. A share of one half has a standard error of 0.4 %.
const SHARED: usize = 1 << 14;
/// Factors by which the wider points are stretched.
const WIDE: [f64; 2] = [2.0, 3.0];
/// Greatest probability of a side that is searched for, 256 of 32 768 points.
const SELDOM: f64 = 1.0 / 128.0;
/// Greatest number of half-spaces of one switch: `abs(x) > c` has two.
const PLACES: usize = 4;
/// Greatest number of half-spaces of all switches.
pub(crate) const MOST: usize = 6;
/// Distance in sigmas at which a half-space begins before its design point.
pub(crate) const BEFORE: f64 = 0.5;
/// Number of steps of Hasofer and Lind.
const STEPS: usize = 12;
/// Step of the difference quotients of margins, in sigmas.
const STEP: f64 = 1e-3;
/// Ends of the line search about each step, as factors of its distance.
const LINE: [f64; 2] = [0.9, 1.1];
/// Points of a half-space, which give its probability to a percent.
const WITHIN: usize = 1 << 12;
/// Least probability of a switch that is worth a warning: one assembly in ten million.
const TOLD: f64 = 1e-7;
/// Number of halvings that locate a border.
const HALVINGS: usize = 40;
/// Difference of two values, as a part of sigma, above which there is a jump.
const APART: f64 = 1e-6;
/// Change of slope, in sigmas of the output for each sigma of the input, above which there is a kink.
const BENT: f64 = 1e-3;
/// Distances over which slopes are computed, in sigmas. A curvature shows more over the longer one.
const NEAR: [f64; 2] = [1e-5, 1e-4];
/// Distance of a value from the mean, in sigmas, above which it grows without bound next to a border.
const WITHOUT_BOUND: f64 = 1e6;

/// Behaviour of an output at a switch, by its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Crossing {
    /// Change of slope.
    Kink,
    /// Jump of the value.
    Jump,
    /// Edge of the domain: there is no value beyond.
    Edge,
    /// Growth without bound: no moments exist.
    Pole,
}

/// A switch with assemblies within eight sigmas on both of its sides.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FoundSwitch {
    /// Switch in the function.
    #[serde(skip)]
    pub switch: Switch,
    /// Part of the formula that causes it, as written there.
    pub name: String,
    /// Behaviour of the output at the switch.
    #[serde(rename = "kind")]
    pub crossing: Crossing,
    /// Probability of the smaller side.
    pub probability: f64,
    /// Shares of the sets of contacts of the joint, at its first switch. None elsewhere.
    #[serde(skip)]
    pub contacts: Option<Vec<ContactShare>>,
}

impl FoundSwitch {
    /// Warning of the switch, with the points of a sample on its smaller side. Returns None if it is met too seldom.
    pub(crate) fn warning(&self, characteristic: &str, sample: Option<u64>) -> Option<Warning> {
        let (switch, probability) = (self.name.clone(), self.probability);
        let change = match self.crossing {
            // A choice is requested, and both sides of it are alike.
            _ if probability < TOLD || self.switch.kind == SwitchKind::Choice => return None,
            Crossing::Kink => Change::Kink,
            Crossing::Jump => Change::Jump,
            Crossing::Edge => Change::Edge,
            Crossing::Pole => {
                return Some(Warning::Pole { characteristic: characteristic.to_owned(), switch, probability });
            }
        };
        if self.switch.kind == SwitchKind::Contact {
            let contacts = self.contacts.clone()?;
            let (characteristic, sampled) = (characteristic.to_owned(), sample.is_some());
            return Some(Warning::ContactSwitch { characteristic, switch, change, contacts, sampled });
        }
        let points = sample.map(|points| points as f64 * probability);
        Some(Warning::Switch { characteristic: characteristic.to_owned(), switch, change, probability, points })
    }
}

/// Results of the search for the switches of one output.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sides {
    /// Half-spaces that contain the seldom sides.
    pub(crate) half_spaces: Vec<HalfSpace>,
    /// Switches that assemblies meet. None if the model does not report them.
    pub(crate) switches: Option<Vec<FoundSwitch>>,
    /// True if the model reported all of its switches.
    pub(crate) complete: bool,
}

/// Margins of all switches at some points, clamped, with 0 for NaN.
struct Margins(Vec<Vec<f64>>);

impl Margins {
    fn read(model: &CheapModel<'_>, z: &Columns) -> Option<Self> {
        let mut columns = model.margins(z)?;
        for margin in columns.iter_mut().flatten() {
            *margin = if margin.is_nan() { 0.0 } else { margin.clamp(-1e9, 1e9) };
        }
        Some(Self(columns))
    }

    /// Adds the margins at further points.
    fn and(mut self, more: Self) -> Self {
        self.0.iter_mut().zip(more.0).for_each(|(all, more)| all.extend(more));
        self
    }

    fn share(&self, switch: usize, sign: f64) -> f64 {
        let column = &self.0[switch];
        column.iter().filter(|&&margin| margin * sign > 0.0).count() as f64 / column.len().max(1) as f64
    }
}

/// Searches for the sides that are seldom met.
///
/// `scale` is the spread of the output, to recognise a jump. Cost: 6144 points, and `12 (N + 22)` for every searched place.
pub(crate) fn sides(model: &CheapModel<'_>, normals: &Normals, scale: f64) -> Sides {
    let Some(known) = model.problem().function().switches(model.output()) else { return Sides::default() };
    if known.list.is_empty() {
        return Sides { switches: Some(Vec::new()), complete: known.complete, ..Sides::default() };
    }
    let places = Places { normals, plain: OnceCell::new(), wide: OnceCell::new() };
    // One set of points after the other, to save memory: each is dropped before the next is drawn.
    let plain = || Margins::read(model, &places.drawn(0));
    let wide = |index: usize| Margins::read(model, &places.widened(index));
    let margins = plain().zip(wide(0)).zip(wide(1));
    let margins = margins.map(|((plain, near), far)| (plain, near.and(far)));
    let Some((plain, far)) = margins.filter(|(plain, _)| plain.0.len() == known.list.len()) else {
        return Sides::default();
    };
    let mut found = Search { model, places: &places, half_spaces: Vec::new(), scale };
    let characteristic = model.problem().outputs().iter().position(|&output| output == model.output());
    let output = characteristic.map_or("", |c| model.problem().characteristics()[c].name());
    let (mut switches, mut bending) = (Vec::new(), Vec::new());
    for (k, switch) in known.list.iter().cloned().enumerate() {
        let sign = if plain.share(k, -1.0) <= plain.share(k, 1.0) { -1.0 } else { 1.0 };
        let first = found.half_spaces.len();
        if plain.share(k, sign) < SELDOM {
            found.seek(k, sign, &far.0[k]);
        }
        let own = first..found.half_spaces.len();
        let Some(probability) = found.probability(k, sign, own, &plain.0[k]) else { continue };
        // The nearest point on the smaller side: the way to it from the middle crosses the border.
        let beyond =
            nearest(|| places.plain(), &plain.0[k], sign).or_else(|| nearest(|| places.wide(), &far.0[k], sign));
        let Some(crossing) = beyond.and_then(|point| found.crossing(k, sign, &switch, &point)) else { continue };
        switches.push(FoundSwitch { name: switch.name(output), switch, crossing, probability, contacts: None });
        bending.push(k);
    }
    for contacts in &known.contacts {
        // The shares stand at the first of the joint's switches at which the output changes.
        if let Some(first) = bending.iter().position(|k| contacts.switches.contains(k)) {
            switches[first].contacts = contact_shares(model, contacts, &normals.columns(stream(16), SHARED));
        }
    }
    Sides { half_spaces: found.half_spaces, switches: Some(switches), complete: known.complete }
}

/// Shares of the sets of contacts among the points that have a state. Returns None if none has one.
fn contact_shares(model: &CheapModel<'_>, contacts: &ContactSets, z: &Columns) -> Option<Vec<ContactShare>> {
    let margins = model.margins(z)?;
    let rows = margins.first().map_or(0, Vec::len);
    let resting = (0..rows).filter_map(|row| contacts.resting(|switch| margins[switch][row]));
    let mut counts = vec![0u32; contacts.sets.len()];
    resting.for_each(|set| counts[set] += 1);
    let all = f64::from(counts.iter().sum::<u32>());
    let share = |(set, &count): (&Vec<String>, &u32)| {
        let share = f64::from(count) / all;
        ContactShare { contacts: set.clone(), share, error: (share * (1.0 - share) / all).sqrt() }
    };
    (all > 0.0).then(|| contacts.sets.iter().zip(&counts).map(share).collect())
}

fn stream(index: usize) -> u64 {
    (1 << 32) + index as u64
}

fn row(z: &Columns, row: usize) -> Vec<f64> {
    z.iter().map(|column| column[row]).collect()
}

/// Nearest point to the middle at which the margin has this sign. `z` makes the points only if there is one.
fn nearest<'z>(z: impl Fn() -> &'z Columns, margins: &[f64], sign: f64) -> Option<Vec<f64>> {
    let beyond: Vec<usize> = (0..margins.len()).filter(|&at| margins[at] * sign > 0.0).collect();
    let square = |at: usize| z().iter().map(|column| column[at] * column[at]).sum::<f64>();
    beyond.into_iter().min_by(|&a, &b| square(a).total_cmp(&square(b))).map(|at| row(z(), at))
}

/// Points at which margins are evaluated. They are drawn again if a point is needed, which is seldom: with many dimensions they take more
/// memory than anything else.
struct Places<'n> {
    normals: &'n Normals,
    plain: OnceCell<Columns>,
    wide: OnceCell<Columns>,
}

impl Places<'_> {
    fn drawn(&self, index: usize) -> Columns {
        self.normals.columns(stream(index), POINTS)
    }

    /// Points of one of the widths, by its index.
    fn widened(&self, index: usize) -> Columns {
        let mut z = self.drawn(1 + index);
        z.iter_mut().flatten().for_each(|z| *z *= WIDE[index]);
        z
    }

    fn plain(&self) -> &Columns {
        self.plain.get_or_init(|| self.drawn(0))
    }

    /// Points of all widths together.
    fn wide(&self) -> &Columns {
        self.wide.get_or_init(|| {
            let mut all = self.widened(0);
            all.iter_mut().zip(self.widened(1)).for_each(|(all, more)| all.extend(more));
            all
        })
    }
}

struct Search<'a, 'p> {
    model: &'a CheapModel<'p>,
    places: &'a Places<'a>,
    half_spaces: Vec<HalfSpace>,
    scale: f64,
}

impl Search<'_, '_> {
    /// Searches for the places of one side of a switch.
    fn seek(&mut self, switch: usize, sign: f64, margins: &[f64]) {
        let mut open: Vec<bool> = margins.iter().map(|margin| margin * sign > 0.0).collect();
        if !open.contains(&true) {
            return;
        }
        let wide = self.places.wide();
        for space in &self.half_spaces {
            open.iter_mut().zip(space.holds(wide)).for_each(|(open, held)| *open &= !held);
        }
        for _ in 0..PLACES {
            let left: Vec<f64> = open.iter().map(|&open| if open { 1.0 } else { 0.0 }).collect();
            let Some(start) = nearest(|| wide, &left, 1.0).filter(|_| self.half_spaces.len() < MOST) else { return };
            let point = self.design_point(switch, sign, start);
            let distance = length(&point);
            if !(distance > 1.0 && distance < REACH) {
                return;
            }
            let direction = point.iter().map(|part| part / distance).collect();
            let space = HalfSpace { direction, from: distance - BEFORE };
            open.iter_mut().zip(space.holds(wide)).for_each(|(open, held)| *open &= !held);
            self.half_spaces.push(space);
        }
    }

    fn margin(&self, switch: usize, z: &Columns) -> Vec<f64> {
        Margins::read(self.model, z).map_or_else(Vec::new, |mut margins| margins.0.swap_remove(switch))
    }

    /// Likeliest point at which the margin has this sign. It is found by steps from `z` with a line search about each, then by bisection
    /// from the middle.
    fn design_point(&self, switch: usize, sign: f64, mut z: Vec<f64>) -> Vec<f64> {
        // Points of a line search.
        const ON_LINE: usize = 21;
        let n = z.len();
        let mut best = z.clone();
        for _ in 0..STEPS {
            let column = |j: usize| (0..=n).map(|row| z[j] + if row == j + 1 { STEP } else { 0.0 }).collect();
            let margins = self.margin(switch, &(0..n).map(column).collect());
            let slopes: Vec<f64> = margins[1..].iter().map(|margin| (margin - margins[0]) / STEP).collect();
            let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
            if !(square > 0.0 && square.is_finite()) {
                break;
            }
            let along: f64 = slopes.iter().zip(&z).map(|(slope, z)| slope * z).sum();
            let factor = (along - margins[0]) / square;
            z = slopes.iter().map(|slope| factor * slope).collect();
            let part = |step: usize| LINE[0] + (LINE[1] - LINE[0]) * step as f64 / (ON_LINE - 1) as f64;
            let line: Columns = z.iter().map(|z| (0..ON_LINE).map(|step| part(step) * z).collect()).collect();
            let hit = self.margin(switch, &line).iter().position(|margin| margin * sign > 0.0);
            if let Some(point) = hit.map(|step| row(&line, step)).filter(|point| length(point) < length(&best)) {
                best = point;
            }
        }
        let at = |part: f64| -> Vec<f64> { best.iter().map(|z| part * z).collect() };
        let (_, high) = self.halved(switch, sign, &|part| at(part), 20);
        at(high)
    }

    /// Bisects the way `at`: returns two parts of it, the first without the sign and the second with it.
    fn halved(&self, switch: usize, sign: f64, at: &dyn Fn(f64) -> Vec<f64>, times: usize) -> (f64, f64) {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..times {
            let middle = 0.5 * (low + high);
            let point: Columns = at(middle).into_iter().map(|z| vec![z]).collect();
            if self.margin(switch, &point).first().is_some_and(|margin| margin * sign > 0.0) {
                high = middle;
            } else {
                low = middle;
            }
        }
        (low, high)
    }

    /// Probability of a side, by the plain points outside its half-spaces, and by points within each that no earlier one contains.
    /// Returns None if no point lies on the side.
    fn probability(&self, switch: usize, sign: f64, own: std::ops::Range<usize>, margins: &[f64]) -> Option<f64> {
        let mut outside: Vec<bool> = margins.iter().map(|margin| margin * sign > 0.0).collect();
        let mut sum = 0.0;
        for index in own.clone() {
            let space = &self.half_spaces[index];
            outside.iter_mut().zip(space.holds(self.places.plain())).for_each(|(outside, held)| *outside &= !held);
            let mut z = self.places.normals.columns(stream(8 + index), WITHIN);
            let weights = space.enter(&mut z);
            let counts = outside_of(&self.half_spaces[own.start..index], &z);
            let margins = self.margin(switch, &z);
            let inside = weights.iter().zip(&margins).zip(&counts);
            let held = inside.filter(|((_, margin), counts)| **counts && *margin * sign > 0.0);
            sum += held.map(|((weight, _), _)| weight).sum::<f64>() / WITHIN as f64;
        }
        sum += outside.iter().filter(|&&outside| outside).count() as f64 / outside.len() as f64;
        (sum > 0.0).then_some(sum)
    }

    /// Behaviour of the output at the border between the middle and a point beyond. Returns None if it does not change there.
    fn crossing(&self, switch: usize, sign: f64, of: &Switch, beyond: &[f64]) -> Option<Crossing> {
        if of.kind == SwitchKind::Edge {
            return Some(Crossing::Edge);
        }
        let start = self.start(switch, sign, beyond);
        let at = |part: f64| -> Vec<f64> { start.iter().zip(beyond).map(|(a, b)| a + part * (b - a)).collect() };
        let way: Vec<f64> = start.iter().zip(beyond).map(|(a, b)| b - a).collect();
        let (low, high) = self.halved(switch, sign, &at, HALVINGS);
        let step = |by: f64| by / length(&way);
        let [near, far] = NEAR.map(step);
        let parts = [low, high, low - near, low, low + near, low - far, low, low + far];
        let points: Vec<Vec<f64>> = parts.iter().map(|&part| at(part)).collect();
        let columns = (0..beyond.len()).map(|j| points.iter().map(|point| point[j]).collect()).collect();
        let y = self.model.values(&columns);
        let size = |value: f64| value.abs() / self.scale;
        if of.kind == SwitchKind::Pole {
            let middle = y[2].min(y[4]);
            let grows = [y[0], y[1]].iter().any(|y| y.is_nan() || size(y - middle) > WITHOUT_BOUND);
            return (grows && size(y[4] - y[7]) > 1.0).then_some(Crossing::Pole);
        }
        if size(y[1] - y[0]) > APART {
            return Some(Crossing::Jump);
        }
        let bend = |i: usize, by: f64| size(y[i] - 2.0 * y[i + 1] + y[i + 2]) / by;
        let [near, far] = [bend(2, NEAR[0]), bend(5, NEAR[1])];
        (near > BENT && near > 0.5 * far).then_some(Crossing::Kink)
    }

    /// Point on the other side of the switch: the middle, unless it is beyond the border itself.
    fn start(&self, switch: usize, sign: f64, beyond: &[f64]) -> Vec<f64> {
        let n = beyond.len();
        let other = |point: &[f64]| {
            let margin = self.margin(switch, &point.iter().map(|&z| vec![z]).collect());
            margin.first().is_some_and(|margin| margin * sign < 0.0)
        };
        let middle = vec![0.0; n];
        if other(&middle) {
            return middle;
        }
        let plain = self.places.plain();
        nearest(|| plain, &self.margin(switch, plain), -sign).unwrap_or(middle)
    }
}
