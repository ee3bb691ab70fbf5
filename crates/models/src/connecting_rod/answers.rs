//! The outputs of a connecting rod: maxima over the crank angle first, then the figures that follow from them.

use std::f64::consts::PI;

use super::super::gas;
use super::super::jet::Peak;
use super::mechanics::{Alone, Angle, Centre, Curve, Effect, Loaded, Speed, Unfired, pressure};
use super::search::{CYCLE, GAS_ANGLES, ROD_ANGLES, SAFETY, height_at, heights, maxima, pulled};
use super::section::{Root, Section, shank};
use super::{DEGREE, LANES, Rows, input, output};
use sensitol::assembly::{EvaluationError, Responses};

/// Fills the requested outputs, with their columns, for some rows from the `first` on.
pub(super) fn answer(rows: &Rows, first: usize, asked: &[(usize, usize)], out: &mut Responses) {
    let maxima = Maxima::of(rows, asked);
    let answers = Answers { rows, maxima, across: Alone::of(rows, Speed::Given, Centre::Given, Effect::Normal) };
    for &(output, column) in asked {
        let mut values = [f64::NAN; LANES];
        for (row, value) in values[..rows.count].iter_mut().enumerate() {
            match answers.value(output, row) {
                Some(found) => *value = found,
                None => out.fail(first + row, column, EvaluationError::Refused { message: BEYOND.into() }),
            }
        }
        for (row, &value) in values[..rows.count].iter().enumerate() {
            if out.error(first + row, column).is_some() {
                continue;
            }
            match refusal(output, value) {
                Some(message) => out.fail(first + row, column, EvaluationError::Refused { message: message.into() }),
                None => out.set(first + row, column, value),
            }
        }
    }
}

/// The reason for which an output has no value. None if it has one.
fn refusal(output: usize, value: f64) -> Option<&'static str> {
    match output {
        _ if !value.is_nan() => None,
        output::THETA_BIG_TENSION => Some(NEVER_PUSHED),
        output::H_REQ_3000
        | output::H_MARGIN
        | output::THETA_H_REQ
        | output::H_REQ
        | output::THETA_H
        | output::M_SHANK_REQ
        | output::H_THETA => Some(NO_HEIGHT),
        _ => None,
    }
}

const BEYOND: &str = "the crank angle theta lies beyond -360 .. 360 degrees";
const NEVER_PUSHED: &str = "the big end is pulled during the whole stroke of suction";
const NO_HEIGHT: &str = "no height of the section brings the stress to a fifth of the yield strength";

/// The speed of the outputs that are not at the speed that is given.
const FIRED: Speed = Speed::Rpm(3000.0);

/// Maxima over the crank angle in every row; NaN where no requested output needs them.
struct Maxima {
    /// Maxima at 3000 rpm with gas.
    compression: [Peak; LANES],
    torque: [Peak; LANES],
    height: [Peak; LANES],
    /// Maxima of the rod alone at 3000 rpm.
    normal: [Peak; LANES],
    braking: [Peak; LANES],
    /// Maxima of the rod alone with the mass centres that are sought.
    tied: [Peak; LANES],
    lobe_a: [Peak; LANES],
    lobe_b: [Peak; LANES],
    pressed: [Peak; LANES],
    pulled_alone: [Peak; LANES],
    /// Maxima at the speed that is given.
    pushed: [Peak; LANES],
    big_end: [Peak; LANES],
    unfired: [Peak; LANES],
    rod: [Peak; LANES],
    required: [Peak; LANES],
}

impl Maxima {
    /// Searches for the maxima that the outputs need.
    fn of(rows: &Rows, asked: &[(usize, usize)]) -> Self {
        let search = MaximaSearch { rows, asked };
        let big_ends = [output::F_COMP_BIG, output::H_BUCKLING_ZZ, output::H_BUCKLING_YY];
        Self {
            compression: search.with_gas(
                &[output::F_COMP_3000, output::THETA_F_COMP, output::N_ZZ, output::N_YY],
                Effect::Compression,
            ),
            torque: search.with_gas(&[output::T_PEAK], Effect::Torque),
            normal: search.alone(&[output::FN_ROD], Centre::Given, Effect::Normal),
            braking: search.alone(&[output::T_ROD], Centre::Given, Effect::Braking),
            tied: search.alone(&[output::T_OPT], Centre::Tied, Effect::Torque),
            lobe_a: search.alone(&[output::FN_OPT, output::FN_OPT_A], Centre::Optimum, Effect::Normal),
            lobe_b: search.alone(&[output::FN_OPT, output::FN_OPT_B], Centre::Optimum, Effect::AgainstNormal),
            pressed: search.alone(&[output::FA_OPT], Centre::Optimum, Effect::Compression),
            pulled_alone: search.alone(&[output::FA_OPT], Centre::Optimum, Effect::Tension),
            height: search.found(&[output::H_REQ_3000, output::H_MARGIN, output::THETA_H_REQ], || {
                heights(Root { rows, speed: FIRED, webs: [1.0; LANES], at_cut: false }, &GAS_ANGLES)
            }),
            pushed: search.at_speed(&[output::F_COMP, output::THETA_F], Effect::Compression),
            big_end: search.at_speed(&big_ends, Effect::BigEnd),
            unfired: search.found(&[output::F_COMP_INERTIA], || {
                let curve = Unfired(Loaded { rows, speed: Speed::Given, effect: Effect::Compression });
                maxima(&curve, rows, &ROD_ANGLES, false)
            }),
            rod: search.found(&[output::F_COMP_ROD], || {
                let effect = Effect::Compression;
                maxima(&Alone::of(rows, Speed::Given, Centre::Given, effect), rows, &ROD_ANGLES, false)
            }),
            required: search
                .found(&[output::H_REQ, output::THETA_H, output::M_SHANK_REQ], || heights(at_speed(rows), &CYCLE)),
        }
    }
}

/// The section's root at the speed that is given.
fn at_speed(rows: &Rows) -> Root<'_> {
    Root { rows, speed: Speed::Given, webs: [1.0; LANES], at_cut: true }
}

/// Rows with the requested outputs.
#[derive(Clone, Copy)]
struct MaximaSearch<'r> {
    rows: &'r Rows,
    asked: &'r [(usize, usize)],
}

impl MaximaSearch<'_> {
    /// Runs a search if any of these outputs is requested.
    fn found(self, outputs: &[usize], search: impl FnOnce() -> [Peak; LANES]) -> [Peak; LANES] {
        if self.asked.iter().any(|(output, _)| outputs.contains(output)) {
            search()
        } else {
            [Peak { at: f64::NAN, value: f64::NAN }; LANES]
        }
    }

    /// Maxima of an effect at 3000 rpm with gas.
    fn with_gas(self, outputs: &[usize], effect: Effect) -> [Peak; LANES] {
        self.found(outputs, || maxima(&Loaded { rows: self.rows, speed: FIRED, effect }, self.rows, &GAS_ANGLES, true))
    }

    /// Maxima of an effect of the rod alone at 3000 rpm.
    fn alone(self, outputs: &[usize], centre: Centre, effect: Effect) -> [Peak; LANES] {
        self.found(outputs, || maxima(&Alone::of(self.rows, FIRED, centre, effect), self.rows, &ROD_ANGLES, false))
    }

    /// Maxima of an effect over the whole cycle at the speed that is given.
    fn at_speed(self, outputs: &[usize], effect: Effect) -> [Peak; LANES] {
        let speed = Speed::Given;
        self.found(outputs, || maxima(&Loaded { rows: self.rows, speed, effect }, self.rows, &CYCLE, true))
    }
}

/// The outputs of some rows by their maxima.
struct Answers<'r> {
    rows: &'r Rows,
    maxima: Maxima,
    /// The normal force, to which piston and gas add nothing.
    across: Alone<'r>,
}

impl Answers<'_> {
    /// An output in one row. None beyond the crank angles of a cycle.
    fn value(&self, output: usize, row: usize) -> Option<f64> {
        self.maximum(output, row).or_else(|| self.of_section(output, row)).or_else(|| self.at_theta(output, row))
    }

    /// An input of a row, in SI units.
    fn x(&self, input: usize, row: usize) -> f64 {
        self.rows.x[input][row]
    }

    /// The larger of forces and torques, and their angles. None for another output.
    fn maximum(&self, output: usize, row: usize) -> Option<f64> {
        let maxima = &self.maxima;
        Some(match output {
            output::F_TENS_6000 => self.pull(row, Speed::Rpm(6000.0)),
            output::F_COMP_3000 => maxima.compression[row].value,
            output::T_PEAK => maxima.torque[row].value,
            output::FN_ROD => maxima.normal[row].value,
            output::T_ROD => maxima.braking[row].value,
            output::T_OPT => maxima.tied[row].value,
            output::FN_OPT => maxima.lobe_a[row].value.max(maxima.lobe_b[row].value),
            output::FN_OPT_A => maxima.lobe_a[row].value,
            output::FN_OPT_B => maxima.lobe_b[row].value,
            output::THETA_F_COMP => maxima.compression[row].at / DEGREE,
            output::THETA_BIG_TENSION => pulled(self.rows, row),
            output::F_COMP => maxima.pushed[row].value,
            output::THETA_F => maxima.pushed[row].at / DEGREE,
            output::F_TENS => self.pull(row, Speed::Given),
            output::F_COMP_BIG => maxima.big_end[row].value,
            output::F_COMP_INERTIA => maxima.unfired[row].value,
            output::F_COMP_ROD => maxima.rod[row].value,
            output::FA_OPT => maxima.pressed[row].value.max(maxima.pulled_alone[row].value),
            _ => return None,
        })
    }

    /// The pull of the piston at the gas exchange dead centre.
    fn pull(&self, row: usize, speed: Speed) -> f64 {
        let (x, w) = (|at: usize| self.x(at, row), speed.circular(self.rows, row));
        x(input::M_P) * w * w * x(input::R) * (1.0 + x(input::R) / x(input::L))
            + (gas::ATMOSPHERE - gas::SUCTION) * 0.25 * PI * x(input::D) * x(input::D)
    }

    /// Heights, buckling and mass of the section. None for another output.
    fn of_section(&self, output: usize, row: usize) -> Option<f64> {
        let Maxima { compression, height, required, big_end, .. } = &self.maxima;
        let x = |at: usize| self.x(at, row);
        let section = || Section::of(self.rows, row);
        let buckling = || SAFETY * big_end[row].value * x(input::L) * x(input::L) / (PI * PI * x(input::E));
        Some(match output {
            output::H_REQ_3000 => 1e3 * height[row].value,
            output::H_MARGIN => 1e3 * (x(input::H) - least(height[row].value, 2.0 * x(input::T))),
            output::THETA_H_REQ => height[row].at / DEGREE,
            output::H_REQ => 1e3 * required[row].value,
            output::THETA_H => required[row].at / DEGREE,
            output::N_ZZ | output::N_YY => {
                let (section, l) = (section(), x(input::L));
                let web = section.web(x(input::H));
                let inertia = if output == output::N_ZZ { section.across(web) } else { 4.0 * section.along(web) };
                PI * PI * x(input::E) * inertia / (l * l * compression[row].value)
            }
            output::H_BUCKLING_ZZ => 1e3 * section().height_across(buckling()),
            output::H_BUCKLING_YY => 1e3 * section().height_along(0.25 * buckling()),
            output::M_SHANK => self.shank_mass(row, x(input::H)),
            output::M_SHANK_REQ => self.shank_mass(row, required[row].value),
            _ => return None,
        })
    }

    /// The mass of a shank of this height, in grams.
    fn shank_mass(&self, row: usize, height: f64) -> f64 {
        let section = Section::of(self.rows, row);
        1e3 * self.x(input::RHO, row) * section.area(section.web(height)) * shank(self.rows, row)
    }

    /// Forces and height at the crank angle that is given, or at the gas exchange dead centre. None beyond a cycle.
    fn at_theta(&self, output: usize, row: usize) -> Option<f64> {
        let (rows, x) = (self.rows, |at: usize| self.x(at, row));
        let degrees = if output == output::F_TENS_BIG { -360.0 } else { x(input::THETA) };
        if !(-360.0..=360.0).contains(&degrees) {
            return None;
        }
        let angle = Angle::of(degrees * DEGREE, pressure(degrees, x(input::P3), x(input::THS)));
        let loaded = |effect| Loaded { rows, speed: Speed::Given, effect }.at(row, &angle);
        Some(match output {
            output::F_AXIAL => -loaded(Effect::Compression),
            output::F_NORMAL => self.across.at(row, &angle),
            output::T_CRANK => loaded(Effect::Torque),
            output::H_THETA => 1e3 * height_at(&mut at_speed(rows), row, &angle),
            _ => -loaded(Effect::BigEnd),
        })
    }
}

/// The larger of both; unknown where the height is.
fn least(height: f64, flanges: f64) -> f64 {
    if height < flanges { flanges } else { height }
}
