//! Maxima over the crank angle in many rows at once, and the height of a section that carries the largest stress.

use std::sync::LazyLock;

use super::super::gas;
use super::super::jet::{Jet, Peak, climb};
use super::mechanics::{Angle, Curve, Effect, Loaded, ROD_BY_CRANK, Speed, pressure};
use super::section::{MOST_WEB, Root, crossing};
use super::{DEGREE, LANES, Rows, input};
use sensitol_numeric::elementary::{Cos, Elementary, Exp, Sin, Work, on_this_processor};

/// Safety against yield.
pub(super) const SAFETY: f64 = 5.0;
/// Degrees between the angles at which a maximum is first looked for: a fifth of the narrowest lobe at most.
pub(super) const STEP: f64 = 5.0;

/// Angles at which a search begins, with what the volume makes of the pressure there.
pub(super) struct Grid {
    pub(super) degrees: Vec<f64>,
    pub(super) strokes: Vec<[f64; 2]>,
    /// The parts of the exhaust's pressure, by 1 and by p3, after the stroke that does work.
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
        // Before the compression nothing burns, and after the expansion everything has: the pressures' two parts are then these.
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

/// The largest value over the grid in every row, and the angle's place.
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
        // The same number, by which the compiler sees that every row lies within its column.
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

/// The largest value of a curve in every row, and where.
pub(super) fn maxima<C: Curve>(curve: &C, rows: &Rows, grid: &Grid, gas: bool) -> [Peak; LANES] {
    let places = on_this_processor(Scan { curve, rows, grid, gas });
    let mut peaks = [Peak { at: f64::NAN, value: f64::NAN }; LANES];
    for (row, peak) in peaks[..rows.count].iter_mut().enumerate() {
        *peak = refined(curve, rows, grid, gas, row, grid.degrees[places[row] as usize] * DEGREE);
    }
    peaks
}

/// The maximum near a place of the grid.
pub(super) fn refined<C: Curve>(curve: &C, rows: &Rows, grid: &Grid, gas: bool, row: usize, from: f64) -> Peak {
    let load = gas.then(|| (rows.x[input::P3][row], rows.x[input::THS][row]));
    let ends = [(from - STEP * DEGREE).max(grid.ends[0]), (from + STEP * DEGREE).min(grid.ends[1])];
    climb(|theta| curve.at(row, &Angle::<Jet>::around(theta, load)), from, ends)
}

/// Heights that Newton's method asks for at most.
pub(super) const MOST_HEIGHTS: usize = 60;
/// The height of the web by the thickness that the first pass over the grid begins with: the design's.
pub(super) const FIRST_WEB: f64 = 8.0;
/// Where Newton's method gives over to [`overlapping`].
pub(super) const LEAST_WEB: f64 = 1e-3;
/// Passes over the grid: each but the first sees whether the lobe has stayed the largest.
pub(super) const PASSES: usize = 6;

/// The least height of the section in every row, and the angle that requires it: the largest stress over the angle is what is
/// allowed. The web may vanish and flanges may overlap, down to k3 = -2, where they alone carry: the height is 0 there.
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

/// Brings the largest stress of a lobe to what is allowed by the height of the web, and tells the angle.
pub(super) fn required(root: &mut Root<'_>, grid: &Grid, row: usize, mut from: f64) -> Option<f64> {
    let rows = root.rows;
    let allowed = rows.x[input::S_Y][row] / SAFETY;
    for _ in 0..MOST_HEIGHTS {
        let k3 = root.webs[row];
        let peak = refined(root, rows, grid, true, row, from);
        from = peak.at;
        // The stress by the web's height at that angle: the angle's own change does not matter at a maximum.
        let h = 1e-6 * k3;
        let pressure = pressure(peak.at / DEGREE, rows.x[input::P3][row], rows.x[input::THS][row]);
        let angle = Angle::of(peak.at, pressure);
        let mut stress = |web: f64| {
            root.webs[row] = web;
            root.at(row, &angle)
        };
        let slope = (stress(k3 + h) - stress(k3 - h)) / (2.0 * h);
        let step = (peak.value - allowed) / slope;
        // Never to nothing at once: the stress grows without bound there.
        let next = if step < 0.9 * k3 { k3 - step } else { 0.1 * k3 };
        root.webs[row] = next;
        if !(next > LEAST_WEB && next < MOST_WEB) {
            return None;
        }
        // The next step would be the square of this one.
        if step.abs() <= 1e-8 * next {
            return Some(from);
        }
    }
    None
}

/// Steps in which a web between 0 and -2 thicknesses is looked for: the stress has one hump there, 0.5 wide or more.
const OVERLAPS: usize = 20;

/// The height for which flanges overlap: where the largest stress is what is allowed for the first time from above, because it
/// need not grow as the height falls. Without such a place the flanges alone carry: 0.
fn overlapping(root: &mut Root<'_>, grid: &Grid, row: usize) -> Peak {
    let (rows, t) = (root.rows, root.rows.x[input::T][row]);
    let allowed = rows.x[input::S_Y][row] / SAFETY;
    let mut largest = |web: f64| strained(root, grid, row, web);
    let web = |step: usize| LEAST_WEB - (2.0 + LEAST_WEB) * step as f64 / OVERLAPS as f64;
    let (mut before, mut above) = (f64::NEG_INFINITY, largest(web(0)).value);
    let mut bracket = None;
    if above >= allowed {
        // Newton's method jumped over the root.
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
            // A top between the steps may reach what they do not.
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
        // Where the bracket is narrow the lobe stays: from its last top to the next.
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

/// The largest stress over the grid for a web of this height.
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

/// The least height of the section at one crank angle.
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
    // As finely as the hump of the stress asks for, from above.
    let web = |step: usize| -2.0 * step as f64 / (20 * OVERLAPS) as f64;
    let found = (1..=20 * OVERLAPS).find(|&step| over(web(step)) >= 0.0);
    found.map_or(0.0, |step| (crossing(over, [web(step), web(step - 1)]) + 2.0) * t)
}

/// Degrees after the gas exchange dead centre for which the big end is pulled. The stroke is that of suction, whose pressure is one.
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
