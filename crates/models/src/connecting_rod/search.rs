//! Maxima over the crank angle in many rows at once, and the section height that carries the largest stress.

use std::sync::LazyLock;

use super::super::gas;
use super::super::jet::{Jet, Peak, climb};
use super::mechanics::{Angle, Curve, Effect, Loaded, ROD_BY_CRANK, Speed, pressure};
use super::section::{MOST_WEB, Root, crossing};
use super::{DEGREE, LANES, Rows, input};
use sensitol_numeric::elementary::{Cos, Elementary, Exp, Sin, Work, on_this_processor};

/// Safety factor against yield.
pub(super) const SAFETY: f64 = 5.0;
/// Distance of the grid's angles, degrees: at most a fifth of the narrowest lobe.
pub(super) const STEP: f64 = 5.0;

/// Angles at which a search begins, with the pressure terms that depend on the volume there.
pub(super) struct Grid {
    pub(super) degrees: Vec<f64>,
    pub(super) strokes: Vec<[f64; 2]>,
    /// Constant and factor of p3 of the exhaust's pressure, after the working stroke.
    pub(super) exhaust: Vec<[f64; 2]>,
    pub(super) turns: Vec<[f64; 2]>,
    pub(super) ends: [f64; 2],
}

impl Grid {
    fn over(from: f64, to: f64) -> Self {
        let steps = ((to - from) / STEP).round() as usize;
        let degrees: Vec<f64> = (0..=steps).map(|step| from + STEP * step as f64).collect();
        let turns: Vec<[f64; 2]> =
            degrees.iter().map(|at| at * DEGREE).map(|theta| [Sin::of(theta), Cos::of(theta)]).collect();
        // Nothing burns before the compression, and everything has burnt after the expansion. The two terms of the pressure are then
        // constant.
        let working = |(degrees, &[sin, cos]): (&f64, &[f64; 2])| match *degrees {
            ..-180.0 => [gas::SUCTION, 0.0],
            at if at > 180.0 => [0.0, 0.0],
            _ => gas::strokes(sin, cos, ROD_BY_CRANK),
        };
        let strokes = degrees.iter().zip(&turns).map(working).collect();
        let exhaust = degrees.iter().map(|&at| if at > 180.0 { gas::exhaust(at) } else { [0.0; 2] }).collect();
        Self { degrees, strokes, exhaust, turns, ends: [from * DEGREE, to * DEGREE] }
    }
}

pub(super) static GAS_ANGLES: LazyLock<Grid> = LazyLock::new(|| Grid::over(-60.0, 180.0));
/// Both turns of the cycle.
pub(super) static CYCLE: LazyLock<Grid> = LazyLock::new(|| Grid::over(-360.0, 360.0));
pub(super) static ROD_ANGLES: LazyLock<Grid> = LazyLock::new(|| Grid::over(0.0, 180.0));

/// Finds the angle of the grid with the largest value, in every row.
pub(super) struct Scan<'a, C> {
    pub(super) curve: &'a C,
    pub(super) rows: &'a Rows,
    pub(super) grid: &'a Grid,
    pub(super) gas: bool,
}

impl<C: Curve> Work for Scan<'_, C> {
    type Output = [f64; LANES];

    #[inline(always)]
    fn work(self) -> [f64; LANES] {
        let Self { curve, rows, grid, gas } = self;
        // The minimum does not change the count. It shows the compiler that every row lies within its column.
        let count = rows.count.min(LANES);
        let (mut best, mut place) = ([f64::NEG_INFINITY; LANES], [0.0; LANES]);
        let (mut exponents, mut unburnt) = ([0.0; LANES], [1.0; LANES]);
        for (index, &degrees) in grid.degrees.iter().enumerate() {
            let (strokes, [sin, cos], [own, by_p3]) = (grid.strokes[index], grid.turns[index], grid.exhaust[index]);
            if gas {
                for (exponent, start) in exponents[..count].iter_mut().zip(&rows.x[input::THS]) {
                    *exponent = gas::unburnt_log(degrees, *start);
                }
                Exp::map_inline(&exponents[..count], &mut unburnt[..count]);
            }
            for row in 0..count {
                let p3 = rows.x[input::P3][row];
                let pressure = if gas { gas::working(strokes, unburnt[row], p3) + (own + by_p3 * p3) } else { 0.0 };
                let value = curve.at(row, &Angle { sin, cos, pressure });
                let better = value > best[row];
                best[row] = if better { value } else { best[row] };
                place[row] = if better { index as f64 } else { place[row] };
            }
        }
        place
    }
}

/// Largest value of a curve in every row, and its angle.
pub(super) fn maxima<C: Curve>(curve: &C, rows: &Rows, grid: &Grid, gas: bool) -> [Peak; LANES] {
    let places = on_this_processor(Scan { curve, rows, grid, gas });
    let mut peaks = [Peak { at: f64::NAN, value: f64::NAN }; LANES];
    for (row, peak) in peaks[..rows.count].iter_mut().enumerate() {
        *peak = refined(curve, rows, grid, gas, row, grid.degrees[places[row] as usize] * DEGREE);
    }
    peaks
}

/// Maximum near an angle of the grid.
pub(super) fn refined<C: Curve>(curve: &C, rows: &Rows, grid: &Grid, gas: bool, row: usize, from: f64) -> Peak {
    let load = gas.then(|| (rows.x[input::P3][row], rows.x[input::THS][row]));
    let ends = [(from - STEP * DEGREE).max(grid.ends[0]), (from + STEP * DEGREE).min(grid.ends[1])];
    climb(|theta| curve.at(row, &Angle::<Jet>::around(theta, load)), from, ends)
}

/// Greatest number of steps of Newton's method for a height.
pub(super) const MOST_HEIGHTS: usize = 60;
/// Height of the web by the thickness at the first pass over the grid: that of the design.
pub(super) const FIRST_WEB: f64 = 8.0;
/// Height of the web by the thickness below which [`overlapping`] replaces Newton's method.
pub(super) const LEAST_WEB: f64 = 1e-3;
/// Greatest number of passes over the grid. All but the first check that the same lobe is the largest.
pub(super) const PASSES: usize = 6;

/// Least height of the section in every row, with the angle that requires it: the largest stress over the angle equals the permitted one.
/// The web may vanish and the flanges may overlap, down to k3 = -2. There the flanges alone carry, and the height is 0.
pub(super) fn heights(mut root: Root<'_>, grid: &Grid) -> [Peak; LANES] {
    let rows = root.rows;
    let mut found = [Peak { at: f64::NAN, value: f64::NAN }; LANES];
    let mut open: [bool; LANES] = std::array::from_fn(|row| row < rows.count);
    for row in 0..rows.count {
        root.webs[row] = FIRST_WEB;
    }
    for _ in 0..PASSES {
        if !open.contains(&true) {
            break;
        }
        let places = on_this_processor(Scan { curve: &root, rows, grid, gas: true });
        for row in (0..rows.count).filter(|&row| open[row]).collect::<Vec<_>>() {
            let from = grid.degrees[places[row] as usize] * DEGREE;
            if (from - found[row].at).abs() <= STEP * DEGREE {
                open[row] = false;
                continue;
            }
            match required(&mut root, grid, row, from) {
                Some(at) => {
                    let (t, k3) = (rows.x[input::T][row], root.webs[row]);
                    found[row] = Peak { at, value: (k3 + 2.0) * t };
                }
                None if root.webs[row] < FIRST_WEB => {
                    found[row] = overlapping(&mut root, grid, row);
                    open[row] = false;
                }
                None => {
                    found[row] = Peak { at: f64::NAN, value: f64::NAN };
                    (open[row], root.webs[row]) = (false, 1.0);
                }
            }
        }
    }
    found
}

/// Finds the height of the web at which the largest stress of a lobe equals the permitted one. Returns the angle, or None if the height
/// leaves its range.
pub(super) fn required(root: &mut Root<'_>, grid: &Grid, row: usize, mut from: f64) -> Option<f64> {
    let rows = root.rows;
    let allowed = rows.x[input::S_Y][row] / SAFETY;
    for _ in 0..MOST_HEIGHTS {
        let k3 = root.webs[row];
        let peak = refined(root, rows, grid, true, row, from);
        from = peak.at;
        // At a maximum the change of the angle has no effect, so the derivative by the web's height is taken at a fixed angle.
        let h = 1e-6 * k3;
        let pressure = pressure(peak.at / DEGREE, rows.x[input::P3][row], rows.x[input::THS][row]);
        let angle = Angle::of(peak.at, pressure);
        let mut stress = |web: f64| {
            root.webs[row] = web;
            root.at(row, &angle)
        };
        let slope = (stress(k3 + h) - stress(k3 - h)) / (2.0 * h);
        let step = (peak.value - allowed) / slope;
        // The stress grows without bound as the web vanishes, so a step never removes more than nine tenths of it.
        let next = if step < 0.9 * k3 { k3 - step } else { 0.1 * k3 };
        root.webs[row] = next;
        if !(next > LEAST_WEB && next < MOST_WEB) {
            return None;
        }
        // The error of the next step would be the square of this one.
        if step.abs() <= 1e-8 * next {
            return Some(from);
        }
    }
    None
}

/// Steps of the search for a web between 0 and -2 thicknesses. The stress has one hump there, at least 0.5 wide.
const OVERLAPS: usize = 20;

/// Height for overlapping flanges. From above it is the first one at which the largest stress equals the permitted one, since the stress
/// need not grow as the height falls. Without such a height the flanges alone carry, and it is 0.
fn overlapping(root: &mut Root<'_>, grid: &Grid, row: usize) -> Peak {
    let (rows, t) = (root.rows, root.rows.x[input::T][row]);
    let allowed = rows.x[input::S_Y][row] / SAFETY;
    let mut largest = |web: f64| strained(root, grid, row, web);
    let web = |step: usize| LEAST_WEB - (2.0 + LEAST_WEB) * step as f64 / OVERLAPS as f64;
    let (mut before, mut above) = (f64::NEG_INFINITY, largest(web(0)).value);
    let mut bracket = None;
    if above >= allowed {
        // Newton's method jumped over the root, which lies above.
        let mut high = 1.0;
        while largest(high).value >= allowed {
            high *= 2.0;
            if high > MOST_WEB {
                return Peak { at: f64::NAN, value: f64::NAN };
            }
        }
        bracket = Some([LEAST_WEB, high]);
    }
    for step in 1..=OVERLAPS {
        if bracket.is_some() {
            break;
        }
        let here = largest(web(step)).value;
        if here >= allowed {
            bracket = Some([web(step), web(step - 1)]);
        } else if step > 1 && above > before && above >= here {
            // A maximum between the steps may reach the permitted stress although the steps do not.
            let (mut low, mut high) = (web(step), web(step - 2));
            for _ in 0..40 {
                let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                if largest(a).value > largest(b).value {
                    high = b;
                } else {
                    low = a;
                }
            }
            let top = 0.5 * (low + high);
            bracket = (largest(top).value >= allowed).then(|| [top, web(step - 2)]);
        }
        (before, above) = (above, here);
    }
    let Some([mut low, mut high]) = bracket else { return Peak { at: largest(-2.0).at, value: 0.0 } };
    let mut at = strained(root, grid, row, low).at;
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return Peak { at, value: (low + 2.0) * t };
        }
        // In a narrow bracket the lobe stays the same, so the search starts from its last angle.
        let peak = if high - low > 1e-3 {
            strained(root, grid, row, middle)
        } else {
            root.webs[row] = middle;
            refined(root, rows, grid, true, row, at)
        };
        if peak.value >= allowed {
            (low, at) = (middle, peak.at);
        } else {
            high = middle;
        }
    }
}

/// Largest stress over the grid for a web of this height.
fn strained(root: &mut Root<'_>, grid: &Grid, row: usize, web: f64) -> Peak {
    root.webs[row] = web;
    let (root, rows) = (&*root, root.rows);
    let stress = |index: usize| {
        let degrees = grid.degrees[index];
        let pressure = pressure(degrees, rows.x[input::P3][row], rows.x[input::THS][row]);
        root.at(row, &Angle::of(degrees * DEGREE, pressure))
    };
    let stresses = (0..grid.degrees.len()).map(|index| (index, stress(index)));
    let place = stresses.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(index, _)| index);
    refined(root, rows, grid, true, row, grid.degrees[place] * DEGREE)
}

/// Least height of the section at one crank angle.
pub(super) fn height_at(root: &mut Root<'_>, row: usize, angle: &Angle<f64>) -> f64 {
    let (rows, t) = (root.rows, root.rows.x[input::T][row]);
    let allowed = rows.x[input::S_Y][row] / SAFETY;
    let mut over = |web: f64| {
        root.webs[row] = web;
        root.at(row, angle) - allowed
    };
    let mut high = 1.0;
    while over(high) >= 0.0 {
        high *= 2.0;
        if high > MOST_WEB {
            return f64::NAN;
        }
    }
    if over(0.0) >= 0.0 {
        return (crossing(over, [0.0, high]) + 2.0) * t;
    }
    // Steps from above that are fine enough for the hump of the stress.
    let web = |step: usize| -2.0 * step as f64 / (20 * OVERLAPS) as f64;
    let found = (1..=20 * OVERLAPS).find(|&step| over(web(step)) >= 0.0);
    found.map_or(0.0, |step| (crossing(over, [web(step), web(step - 1)]) + 2.0) * t)
}

/// Degrees after the gas exchange dead centre in which the big end is pulled. The stroke is that of suction, with constant pressure.
pub(super) fn pulled(rows: &Rows, row: usize) -> f64 {
    let curve = Loaded { rows, speed: Speed::Given, effect: Effect::BigEnd };
    let compression = |degrees: f64| curve.at(row, &Angle::of(degrees * DEGREE, gas::SUCTION));
    let ends = CYCLE.degrees.iter().copied().take_while(|&degrees| degrees <= -180.0);
    match ends.into_iter().find(|&degrees| compression(degrees) > 0.0) {
        Some(degrees) if degrees > -360.0 => crossing(compression, [degrees - STEP, degrees]) + 360.0,
        Some(_) => 0.0,
        None => f64::NAN,
    }
}
