//! Section of the shank, and the stress at its root.

use super::super::jet::Real;
use super::mechanics::{Angle, Curve, Motion, Speed, gas_force};
use super::{LANES, Rows, input};

/// Stress in a section of the shank with webs of this height. The section is at the root, or at the input `cut` if `at_cut`.
pub(super) struct Root<'r> {
    pub(super) rows: &'r Rows,
    pub(super) speed: Speed,
    pub(super) webs: [f64; LANES],
    pub(super) at_cut: bool,
}

impl Root<'_> {
    /// Axial force and bending moment in the section.
    #[inline(always)]
    pub(super) fn load<T: Real>(&self, row: usize, angle: &Angle<T>) -> [T; 2] {
        let x = self.rows.row(row);
        let (l, root, length) = (x.of(input::L), x.of(input::R_IS) + x.of(input::T_S), shank(self.rows, row));
        let section = Section::of(self.rows, row);
        let mass = x.of(input::RHO) * section.area(self.webs[row]) * length;
        let centre = root + 0.5 * length;
        let inertia = mass * length * length / 12.0 + x.of(input::I_S) + x.of(input::I_B);
        let motion = Motion::of(angle, x.of(input::R), l, self.speed.circular(self.rows, row));
        let along = gas_force(angle, x.of(input::D)) + motion.piston * -(x.of(input::M_P) + x.of(input::M_S));
        let side = motion.side_force([mass, centre, inertia], motion.acceleration(centre), along, l);
        let axial = -(along * motion.cos_a) - side * motion.sin_a;
        let normal = along * motion.sin_a - side * motion.cos_a;
        if !self.at_cut {
            return [axial, normal * -root + motion.turn * x.of(input::I_S)];
        }
        // The part of the shank before the section adds its inertia forces.
        let before = x.of(input::CUT) * length;
        let (mass, centre) = (mass * x.of(input::CUT), root + 0.5 * before);
        let [ax, ay] = motion.acceleration(centre);
        let across = (ay * motion.cos_a - ax * motion.sin_a) * mass;
        let inertia = x.of(input::I_S) + mass * before * before / 12.0;
        let moment = motion.turn * inertia + across * centre - (normal + across) * (root + before);
        [axial + (ax * motion.cos_a + ay * motion.sin_a) * mass, moment]
    }
}

impl Curve for Root<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        let (section, web) = (Section::of(self.rows, row), self.webs[row]);
        let [axial, moment] = self.load(row, angle);
        axial.abs() * (1.0 / section.area(web)) + moment.abs() * section.bending(web)
    }
}

/// An I section: thickness and proportions. `k3`, the height of the web by the thickness, is an argument of the methods.
pub(super) struct Section {
    pub(super) t: f64,
    pub(super) k1: f64,
    pub(super) k2: f64,
}

impl Section {
    #[inline(always)]
    pub(super) fn of(rows: &Rows, row: usize) -> Self {
        Self { t: rows.x[input::T][row], k1: rows.x[input::K1][row], k2: rows.x[input::K2][row] }
    }

    #[inline(always)]
    pub(super) fn web(&self, height: f64) -> f64 {
        height / self.t - 2.0
    }

    #[inline(always)]
    pub(super) fn area(&self, k3: f64) -> f64 {
        (2.0 * self.k1 + self.k2 * k3) * self.t * self.t
    }

    /// Second moment of area Izz.
    #[inline(always)]
    pub(super) fn across(&self, k3: f64) -> f64 {
        let (square, k1) = (self.t * self.t, self.k1);
        square * square * (k1 / 6.0 + self.k2 * k3 * k3 * k3 / 12.0 + 0.5 * k1 * (k3 + 1.0) * (k3 + 1.0))
    }

    /// Second moment of area Iyy.
    #[inline(always)]
    pub(super) fn along(&self, k3: f64) -> f64 {
        let (square, k1, k2) = (self.t * self.t, self.k1, self.k2);
        square * square * (2.0 * k1 * k1 * k1 + k3 * k2 * k2 * k2) / 12.0
    }

    /// Height of the section for this Izz: the largest root of a cubic. Returns 0 if the flanges alone are stiffer.
    pub(super) fn height_across(&self, inertia: f64) -> f64 {
        let (k1, k2) = (self.k1, self.k2);
        // Izz has its minimum at the larger root of its derivative, k2/4 k3^2 + k1 (k3 + 1), and grows above it.
        let low = if k1 > k2 { -2.0 / (1.0 + (1.0 - k2 / k1).sqrt()) } else { -2.0 };
        let off = |k3: f64| self.across(k3) / inertia - 1.0;
        if off(low) > 0.0 {
            return 0.0;
        }
        let mut high = low.abs() + 1.0;
        while off(high) < 0.0 && high < MOST_WEB {
            high *= 2.0;
        }
        (crossing(off, [low, high]) + 2.0) * self.t
    }

    /// Height of the section for this Iyy. It is negative if the flanges alone are stiffer.
    pub(super) fn height_along(&self, inertia: f64) -> f64 {
        let (square, k1, k2) = (self.t * self.t, self.k1, self.k2);
        let k3 = (12.0 * inertia / (square * square) - 2.0 * k1 * k1 * k1) / (k2 * k2 * k2);
        (k3 + 2.0) * self.t
    }

    /// Stress per unit of bending moment.
    #[inline(always)]
    pub(super) fn bending(&self, k3: f64) -> f64 {
        0.5 * (k3 + 2.0) * self.t / self.across(k3)
    }
}

/// Greatest height of a web by the thickness in all searches.
pub(super) const MOST_WEB: f64 = 1e6;

/// Zero of a function in an interval with opposite signs at its ends, by halving until no double lies between.
pub(super) fn crossing(mut function: impl FnMut(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    let falls = function(high) < 0.0;
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return middle;
        }
        if (function(middle) < 0.0) == falls {
            high = middle;
        } else {
            low = middle;
        }
    }
}

#[inline(always)]
pub(super) fn shank(rows: &Rows, row: usize) -> f64 {
    let x = rows.row(row);
    x.of(input::L) - x.of(input::R_IS) - x.of(input::T_S) - x.of(input::T_B) - x.of(input::R_IB)
}
