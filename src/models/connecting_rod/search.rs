//! Maxima over the crank angle in many rows at once, and the height of a section that carries the largest stress.

use std::sync::LazyLock;

use super::super::gas;
use super::super::jet::{Jet, Peak, climb};
use super::mechanics::{Angle, Curve, ROD_BY_CRANK, pressure};
use super::section::Root;
use super::{DEGREE, LANES, Rows, input};
use crate::elementary::{Cos, Elementary, Exp, Sin, Work, on_this_processor};

/// Safety against yield.
pub(super) const SAFETY: f64 = 5.0;
/// Degrees between the angles at which a maximum is first looked for: a fifth of the narrowest lobe at most.
pub(super) const STEP: f64 = 5.0;

/// Angles at which a search begins, with what the volume makes of the pressure there.
pub(super) struct Grid {
    pub(super) degrees: Vec<f64>,
    pub(super) strokes: Vec<[f64; 2]>,
    pub(super) turns: Vec<[f64; 2]>,
    pub(super) ends: [f64; 2],
}

impl Grid {
    fn over(from: f64, to: f64) -> Self {
        let steps = ((to - from) / STEP).round() as usize;
        let degrees: Vec<f64> = (0..=steps).map(|step| from + STEP * step as f64).collect();
        let turns: Vec<[f64; 2]> =
            degrees.iter().map(|at| at * DEGREE).map(|theta| [Sin::of(theta), Cos::of(theta)]).collect();
        let strokes = turns.iter().map(|&[sin, cos]| gas::strokes(sin, cos, ROD_BY_CRANK)).collect();
        Self { degrees, strokes, turns, ends: [from * DEGREE, to * DEGREE] }
    }
}

pub(super) static GAS_ANGLES: LazyLock<Grid> = LazyLock::new(|| Grid::over(-60.0, 180.0));
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
        let count = rows.count;
        let (mut best, mut place) = ([f64::NEG_INFINITY; LANES], [0.0; LANES]);
        let (mut exponents, mut unburnt) = ([0.0; LANES], [1.0; LANES]);
        for (index, (&degrees, (&strokes, &[sin, cos]))) in
            grid.degrees.iter().zip(grid.strokes.iter().zip(&grid.turns)).enumerate()
        {
            if gas {
                for (exponent, start) in exponents[..count].iter_mut().zip(&rows.x[input::THS]) {
                    *exponent = gas::unburnt_log(degrees, *start);
                }
                Exp::map_inline(&exponents[..count], &mut unburnt[..count]);
            }
            for row in 0..count {
                let pressure = if gas { gas::working(strokes, unburnt[row], rows.x[input::P3][row]) } else { 0.0 };
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
/// Passes over the grid: each but the first sees whether the lobe has stayed the largest.
pub(super) const PASSES: usize = 6;

/// The least height of the section in every row, and the angle that requires it: the largest stress over the angle is what is
/// allowed.
pub(super) fn heights(rows: &Rows, w: f64) -> [Peak; LANES] {
    let grid: &Grid = &GAS_ANGLES;
    let mut root = Root { rows, w, webs: [1.0; LANES] };
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
        if !(next > 1e-3 && next < 1e6) {
            return None;
        }
        // The next step would be the square of this one.
        if step.abs() <= 1e-8 * next {
            return Some(from);
        }
    }
    None
}
