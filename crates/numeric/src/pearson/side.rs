//! One side of a Pearson distribution, from an anchor outwards: density, mass beyond, and the inverse of the latter.

use crate::pearson::ending::Ending;
use crate::pearson::equation::{Equation, Panel};

/// Fall of log p at which the tables end. Values beyond are computed on demand.
const CORE: f64 = -45.0;
/// Relative density below which the rest adds no digit to the mass.
const REST: f64 = 1e-19;
/// Greatest number of panels of a side. The longest side seen has a sixth of it.
const PANELS: usize = 600;
/// Least logarithm of the distance from an end, relative to the reach of its series.
const LEAST: f64 = -800.0;
/// Greatest logarithm of the distance from an end, relative to the reach of its series.
const LARGEST: f64 = 700.0;
/// Greatest number of steps of an iteration. Three to six are usual.
const STEPS: usize = 200;

/// Side of a Pearson distribution. All densities are relative to that at the anchor.
#[derive(Debug, Clone)]
pub(super) struct Side {
    /// 1 to the right, -1 to the left.
    sign: f64,
    equation: Equation,
    pieces: Vec<Piece>,
    ending: Option<Ending>,
    anchor: f64,
    /// Place at which the tables end, and log p there.
    edge: f64,
    edge_log: f64,
    /// `log p` minus that of the ending. None if the tables end before the ending begins.
    ending_log: Option<f64>,
    /// End of the support, infinite if there is none.
    limit: f64,
    /// Logarithm of the mass beyond the end of the tables.
    edge_log_mass: f64,
    /// Mills' ratio at the anchor: the mass of the whole side.
    pub(super) mass: f64,
}

#[derive(Debug, Clone)]
struct Piece {
    panel: Panel,
    /// Distance of the inner end of the panel from the anchor.
    from: f64,
    /// Value of log p in the middle of the panel.
    log: f64,
    /// Mass beyond the middle, relative to the density there: that up to the outer end, plus the density at that end times Mills' ratio.
    beyond: f64,
    /// Logarithm of the mass beyond the inner end of the panel.
    log_mass: f64,
}

/// Place on a side: its density, and the mass beyond divided by that density.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) log_density: f64,
    pub(super) mills: f64,
}

impl Place {
    const BEYOND: Self = Self { log_density: f64::NEG_INFINITY, mills: 0.0 };

    pub(super) fn log_mass(&self) -> f64 {
        if self.mills == 0.0 { f64::NEG_INFINITY } else { self.log_density + libm::log(self.mills) }
    }
}

impl Side {
    pub(super) fn new(equation: Equation, anchor: f64, sign: f64, ending: Option<Ending>, limit: f64) -> Self {
        let mut panels: Vec<(Panel, f64)> = Vec::new();
        let (mut edge, mut edge_log) = (anchor, 0.0);
        let covered = |z: f64| ending.as_ref().is_some_and(|ending| ending.covers(z));
        while !covered(edge) && edge_log > CORE && panels.len() < PANELS {
            let Some(panel) = equation.panel(edge, sign) else { break };
            let middle_log = edge_log - libm::log(panel.density(-1.0));
            edge_log = middle_log + libm::log(panel.density(1.0));
            edge = panel.end();
            panels.push((panel, middle_log));
        }
        let ending_log = (ending.as_ref().filter(|ending| ending.covers(edge)))
            .map(|ending| edge_log - ending.log_density(ending.relative(edge)));
        let mut mills = mills(&equation, ending.as_ref(), sign, edge);
        let edge_log_mass = edge_log + libm::log(mills);
        let mut pieces = Vec::with_capacity(panels.len());
        for (panel, log) in panels.into_iter().rev() {
            let beyond = panel.mass(1.0) + panel.density(1.0) * mills;
            let inner = panel.density(-1.0);
            mills = (beyond - panel.mass(-1.0)) / inner;
            let log_mass = log + libm::log(inner * mills);
            pieces.push(Piece { from: sign * (panel.position(-1.0) - anchor), panel, log, beyond, log_mass });
        }
        pieces.reverse();
        Self { sign, equation, pieces, ending, anchor, edge, edge_log, ending_log, limit, edge_log_mass, mass: mills }
    }

    /// Density and mass beyond at a place on this side.
    pub(super) fn at(&self, z: f64) -> Place {
        if z.is_infinite() || self.sign * (self.limit - z) <= 0.0 {
            return Place::BEYOND;
        }
        if self.sign * (z - self.edge) < 0.0 {
            let from = self.sign * (z - self.anchor);
            let index = self.pieces.partition_point(|piece| piece.from <= from).max(1) - 1;
            let piece = &self.pieces[index];
            let u = piece.panel.coordinate(z).clamp(-1.0, 1.0);
            let density = piece.panel.density(u);
            let mills = (piece.beyond - piece.panel.mass(u)) / density;
            return Place { log_density: piece.log + libm::log(density), mills };
        }
        if let Some((ending, log)) = self.tabled_ending() {
            let v = ending.relative(z);
            return Place { log_density: log + ending.log_density(v), mills: ending.mills(v) };
        }
        let log_density = self.edge_log + self.equation.fall(self.edge, z);
        if log_density == f64::NEG_INFINITY {
            return Place::BEYOND;
        }
        Place { log_density, mills: mills(&self.equation, self.ending.as_ref(), self.sign, z) }
    }

    /// Derivative of `p'/p` outwards by skewness and excess, at a distance from the anchor. `growth` holds the derivatives of Pearson's
    /// coefficients.
    pub(super) fn rate(&self, distance: f64, growth: [[f64; 2]; 2]) -> [f64; 2] {
        let z = self.anchor + self.sign * distance;
        self.equation.slopes_by(z, growth).map(|slope| self.sign * slope)
    }

    /// Panels of the tables, as distances of their ends from the anchor.
    pub(super) fn panels(&self) -> impl ExactSizeIterator<Item = [f64; 2]> {
        self.pieces.iter().map(|piece| [piece.from, self.sign * (piece.panel.end() - self.anchor)])
    }

    /// True if the mass beyond the tables is negligible.
    pub(super) fn ends_with_tables(&self) -> bool {
        self.edge_log <= CORE
    }

    /// True if the remaining distance to the end of the support is so small that it has lost digits.
    pub(super) fn is_at_its_end(&self, distance: f64) -> bool {
        let whole = (self.limit - self.anchor).abs();
        whole.is_finite() && whole - distance <= 1e-10 * whole
    }

    /// Length over which a series converges, from a place at a distance from the anchor.
    pub(super) fn reach(&self, distance: f64) -> f64 {
        self.equation.reach(self.anchor + self.sign * distance)
    }

    /// Mass beyond a distance from the anchor, within the panel `index` of the tables.
    pub(super) fn mass_in_panel(&self, index: usize, distance: f64) -> f64 {
        let piece = &self.pieces[index];
        let u = piece.panel.coordinate(self.anchor + self.sign * distance);
        libm::exp(piece.log) * (piece.beyond - piece.panel.mass(u))
    }

    /// Mass beyond a distance from the anchor.
    pub(super) fn mass_beyond(&self, distance: f64) -> f64 {
        libm::exp(self.at(self.anchor + self.sign * distance).log_mass())
    }

    /// Ending and its constant. Returns None if the tables do not reach the ending.
    fn tabled_ending(&self) -> Option<(&Ending, f64)> {
        self.ending.as_ref().zip(self.ending_log)
    }

    /// Mass between the anchor and `z`, next to an end of the support that holds nearly all of the mass. There, the difference of the
    /// masses beyond has lost its digits. Returns None elsewhere.
    pub(super) fn inner(&self, z: f64) -> Option<f64> {
        let (ending, log) = self.tabled_ending().filter(|(ending, _)| ending.is_finite() && ending.covers(z))?;
        let own = libm::exp(log) * ending.inner(ending.relative(z).max(0.0), ending.relative(self.edge));
        Some(own + (self.mass - libm::exp(self.edge_log_mass)).max(0.0))
    }

    /// Place with this logarithm of the mass beyond.
    pub(super) fn with_mass_beyond(&self, log_mass: f64) -> f64 {
        if log_mass == f64::NEG_INFINITY {
            return self.limit;
        }
        if log_mass > self.edge_log_mass && !self.pieces.is_empty() {
            return self.within_tables(log_mass);
        }
        match self.tabled_ending() {
            Some((ending, log)) => {
                let off = |log_v: f64| {
                    let (found, slope) = ending.log_mass(log_v);
                    (found + log - log_mass, slope)
                };
                self.in_ending(ending, libm::log(ending.relative(self.edge)), off)
            }
            None => self.beyond_tables(log_mass),
        }
    }

    /// Place with the mass `mass` between it and the anchor, next to an end of the support that holds nearly all of the mass. Returns None
    /// if there is no such place.
    pub(super) fn with_inner_mass(&self, mass: f64) -> Option<f64> {
        let (ending, log) = self.tabled_ending().filter(|(ending, _)| ending.is_finite())?;
        let own = mass - (self.mass - libm::exp(self.edge_log_mass)).max(0.0);
        if own <= 0.0 {
            return None;
        }
        let edge = ending.relative(self.edge);
        let off = |log_v: f64| {
            let v = libm::exp(log_v);
            let slope = libm::exp(log + ending.log_density(v)) * ending.length(v);
            (own - libm::exp(log) * ending.inner(v, edge), slope)
        };
        // The place from the mass beyond is a good start, though not accurate enough as a result.
        let start = libm::log(ending.relative(self.with_mass_beyond(libm::log((self.mass - mass).max(0.0)))));
        Some(self.in_ending(ending, start, off))
    }

    /// Safeguarded Newton iteration in log v, from `start` on: the mass of an ending is nearly a straight line there.
    fn in_ending(&self, ending: &Ending, start: f64, off: impl Fn(f64) -> (f64, f64)) -> f64 {
        let edge = libm::log(ending.relative(self.edge));
        // Below `LEAST` no double lies between the end and the place.
        let [mut low, mut high] = if ending.is_finite() { [LEAST, edge] } else { [edge, LARGEST] };
        let mut log_v = start.clamp(low, high);
        for _ in 0..STEPS {
            let (error, slope) = off(log_v);
            if (error > 0.0) == (slope > 0.0) {
                high = log_v;
            } else {
                low = log_v;
            }
            let next = log_v - error / slope;
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            let step = (next - log_v).abs();
            log_v = next;
            if step <= 4.0 * f64::EPSILON * log_v.abs().max(1.0) {
                break;
            }
        }
        if log_v <= LEAST + 1.0 { self.limit } else { ending.position(libm::exp(log_v)) }
    }

    /// Newton's method on the logarithm of the mass, within the panel that holds the place.
    fn within_tables(&self, log_mass: f64) -> f64 {
        let index = self.pieces.partition_point(|piece| piece.log_mass >= log_mass).max(1) - 1;
        let piece = &self.pieces[index];
        let outer = self.pieces.get(index + 1).map_or(self.edge_log_mass, |next| next.log_mass);
        let target = libm::exp(log_mass - piece.log);
        let (mut low, mut high) = (-1.0, 1.0);
        let mut u = (-1.0 + 2.0 * (piece.log_mass - log_mass) / (piece.log_mass - outer)).clamp(low, high);
        for _ in 0..STEPS {
            let beyond = piece.beyond - piece.panel.mass(u);
            let error = libm::log(beyond / target);
            if error > 0.0 {
                low = u;
            } else {
                high = u;
            }
            let next = u + error * beyond / (piece.panel.density(u) * piece.panel.half.abs());
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            let step = (next - u).abs();
            u = next;
            if step <= 2.0 * f64::EPSILON {
                break;
            }
        }
        piece.panel.position(u)
    }

    /// Safeguarded Newton iteration on the logarithm of the mass, beyond the tables.
    fn beyond_tables(&self, log_mass: f64) -> f64 {
        let (mut low, mut high) = (self.edge, self.limit);
        let mut z = self.edge;
        for _ in 0..STEPS {
            let place = self.at(z);
            let error = place.log_mass() - log_mass;
            if error > 0.0 {
                low = z;
            } else {
                high = z;
            }
            let mut next = z + self.sign * error * place.mills;
            // Iterate to the last double next to an end of the support, since distances to it count.
            let last = if self.limit.is_finite() { 0.0 } else { 2.0 * f64::EPSILON * z.abs() };
            if (next - z).abs() <= last {
                break;
            }
            let within = self.sign * (next - low) > 0.0 && self.sign * (high - next) > 0.0;
            if !within {
                next = if high.is_finite() { 0.5 * (low + high) } else { z + (z - self.anchor) };
            }
            z = next;
        }
        z
    }
}

/// Terms of a continued fraction before panels take over.
const FRACTION: usize = 60;

/// Mills' ratio by a continued fraction. Returns None if it does not converge while its terms are positive.
///
/// The moments `m_k` of the mass beyond `z`, about `z` and divided by the density there, satisfy, outwards with `y = sign z`,
///
/// ```text
/// (1 + c2)(y m_0 + m_1) = C,    (1 + c2 - k c2) m_(k+1) = k C m_(k-1) + (k C' - (1 + c2) y) m_k
/// m_0 = C/(1 + c2)/(y + m_1/m_0),    m_k/m_(k-1) = k C/((1 + c2) y - k C' + (1 + c2 - k c2) m_(k+1)/m_k)
/// ```
///
/// For a normal distribution this is Laplace's fraction. As long as all terms are positive, the value lies between any two successive
/// approximants.
fn fraction(equation: &Equation, sign: f64, z: f64) -> Option<f64> {
    let [c, by, y] = [equation.c(z), sign * equation.c_by(z), sign * z];
    let (one, c2) = (1.0 + equation.c2(), equation.c2());
    if !(c > 0.0 && y > 0.0) {
        return None;
    }
    // Wallis' recurrence: numerators and denominators of approximants, rescaled at each step to stay in the range of doubles.
    let (mut above, mut below) = ([1.0, y], [0.0, 1.0]);
    let mut last = f64::INFINITY;
    for k in 1..FRACTION {
        let k = k as f64;
        let (partial, weight) = (one * y - k * by, one - k * c2);
        let before = if k == 1.0 { 1.0 } else { one - (k - 1.0) * c2 };
        if !(partial > 0.0 && weight > 0.0) {
            return None;
        }
        let numerator = before * k * c;
        let next = [partial * above[1] + numerator * above[0], partial * below[1] + numerator * below[0]];
        (above, below) = ([above[1], next[0]], [below[1], next[1]]);
        let scale = 1.0 / below[1];
        above.iter_mut().chain(&mut below).for_each(|value| *value *= scale);
        // Approximants of y + m_1/m_0, alternately from above and from below.
        let value = above[1];
        if (value - last).abs() <= f64::EPSILON * value {
            return Some(c / (one * value));
        }
        last = value;
    }
    None
}

/// Mills' ratio beyond the tables: the sum over panels until the rest is negligible or the ending takes over.
fn mills(equation: &Equation, ending: Option<&Ending>, sign: f64, mut z: f64) -> f64 {
    let covered = ending.is_some_and(|ending| ending.covers(z));
    if !covered && let Some(mills) = fraction(equation, sign, z) {
        return mills;
    }
    let (mut mass, mut density) = (0.0, 1.0);
    for _ in 0..PANELS {
        if let Some(ending) = ending.filter(|ending| ending.covers(z)) {
            return mass + density * ending.mills(ending.relative(z));
        }
        if density < REST {
            break;
        }
        let Some(panel) = equation.panel(z, sign) else { break };
        let inner = panel.density(-1.0);
        mass += density * (panel.mass(1.0) - panel.mass(-1.0)) / inner;
        density *= panel.density(1.0) / inner;
        z = panel.end();
    }
    mass
}
