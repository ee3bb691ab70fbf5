//! Motion of the rod, and the forces for it.

use std::f64::consts::PI;

use super::super::gas;
use super::super::jet::{Jet, Real};
use super::{DEGREE, LANES, Rows, input};
use sensitol_numeric::elementary::{Cos, Elementary, Sin};

/// Ratio of rod to crank in the gas trace. It is fixed: tolerances of the inputs do not change it.
pub(super) const ROD_BY_CRANK: f64 = 133.6 / 41.0;
/// Mass centre and distance of the eyes from which the optima are counted, m.
pub(super) const REFERENCE: [f64; 2] = [0.105, 0.1336];

/// Pressure at an angle, Pa.
pub(super) fn pressure(degrees: f64, p3: f64, start: f64) -> f64 {
    gas::pressure(degrees, p3, start, ROD_BY_CRANK)
}

/// Speed of the crankshaft: one for all rows in rpm, or the input `speed` of each row.
#[derive(Clone, Copy)]
pub(super) enum Speed {
    Rpm(f64),
    Given,
}

impl Speed {
    /// Circular frequency in rad/s.
    #[inline(always)]
    pub(super) fn circular(self, rows: &Rows, row: usize) -> f64 {
        match self {
            Self::Rpm(rpm) => rpm * PI / 30.0,
            Self::Given => rows.x[input::SPEED][row] * PI / 30.0,
        }
    }
}

/// A crank angle with its gas pressure.
pub(super) struct Angle<T> {
    pub(super) sin: T,
    pub(super) cos: T,
    pub(super) pressure: T,
}

impl Angle<f64> {
    pub(super) fn of(theta: f64, pressure: f64) -> Self {
        Self { sin: Sin::of(theta), cos: Cos::of(theta), pressure }
    }
}

impl Angle<Jet> {
    /// Angle with derivatives by the angle. The pressure is 0 without gas.
    pub(super) fn around(theta: f64, gas: Option<(f64, f64)>) -> Self {
        let (s, c) = (Sin::of(theta), Cos::of(theta));
        let (sin, cos) = (Jet([s, c, -s]), Jet([c, -s, -c]));
        let pressure = gas.map_or(Jet([0.0; 3]), |(p3, start)| {
            let degrees = Jet([theta / DEGREE, 1.0 / DEGREE, 0.0]);
            match theta / DEGREE {
                ..-180.0 => Jet([gas::SUCTION, 0.0, 0.0]),
                // The bound excludes 180, as in `pressure`. Both sides are equal there.
                at if at > 180.0 => gas::blow_down(degrees, p3),
                _ => {
                    let unburnt = gas::unburnt_log(degrees, start).exp();
                    gas::working(gas::strokes(sin, cos, ROD_BY_CRANK), unburnt, p3)
                }
            }
        });
        Self { sin, cos, pressure }
    }
}

/// Motion of the rod at one crank angle.
pub(super) struct Motion<T> {
    pub(super) sin_a: T,
    pub(super) cos_a: T,
    /// Square of the angular velocity of the rod.
    pub(super) rate: T,
    /// Angular acceleration of the rod.
    pub(super) turn: T,
    /// Acceleration of the piston.
    pub(super) piston: T,
}

impl<T: Real> Motion<T> {
    #[inline(always)]
    pub(super) fn of(angle: &Angle<T>, r: f64, l: f64, w: f64) -> Self {
        let sin_a = angle.sin * (r / l);
        let cos_a = -(-(sin_a * sin_a) + 1.0).sqrt();
        let below = cos_a * l;
        let rate = angle.cos * (r * w) / below;
        let rate = rate * rate;
        let turn = (rate * sin_a * l + angle.sin * (-r * w * w)) / below;
        let piston = angle.cos * (-r * w * w) + (turn * sin_a + rate * cos_a) * l;
        Self { sin_a, cos_a, rate, turn, piston }
    }

    /// Acceleration of a point of the rod at this distance from the small end, along the cylinder and across it.
    #[inline(always)]
    pub(super) fn acceleration(&self, at: f64) -> [T; 2] {
        let along = self.piston + (self.rate * self.cos_a + self.turn * self.sin_a) * -at;
        [along, (self.turn * self.cos_a + -(self.rate * self.sin_a)) * at]
    }

    /// Force across the cylinder at the small end. The rod has this mass, centre and inertia, and `along` is the force along the cylinder.
    #[inline(always)]
    pub(super) fn side_force(&self, [mass, centre, inertia]: [f64; 3], [ax, ay]: [T; 2], along: T, l: f64) -> T {
        let rest = (ay * self.cos_a - ax * self.sin_a) * (mass * (l - centre));
        (self.turn * -inertia + rest + along * self.sin_a * l) / (self.cos_a * l)
    }
}

/// Effect whose maximum is searched for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Effect {
    Compression,
    Tension,
    Normal,
    AgainstNormal,
    /// Torque of the rod on the crank.
    Torque,
    Braking,
    /// Compression at the big end: that at the small end, less the force that accelerates the rod along its axis.
    BigEnd,
}

/// Effect on a rod with mass, centre of mass and inertia, and with a force along the cylinder at its small end.
#[inline(always)]
pub(super) fn effect<T: Real>(
    effect: Effect,
    angle: &Angle<T>,
    motion: &Motion<T>,
    body: [f64; 3],
    along: T,
    [r, l]: [f64; 2],
) -> T {
    let [mass, centre, inertia] = body;
    let [ax, ay] = motion.acceleration(centre);
    let side = motion.side_force(body, [ax, ay], along, l);
    let (sin_a, cos_a) = (motion.sin_a, motion.cos_a);
    match effect {
        Effect::Compression => side * sin_a + along * cos_a,
        Effect::Tension => -(side * sin_a + along * cos_a),
        Effect::Normal => side * cos_a - along * sin_a,
        Effect::AgainstNormal => along * sin_a - side * cos_a,
        Effect::BigEnd => side * sin_a + along * cos_a - (ax * cos_a + ay * sin_a) * mass,
        Effect::Torque | Effect::Braking => {
            let pin = angle.cos * r;
            let external = -(side * (pin - cos_a * l)) + ay * (pin - cos_a * (l - centre)) * mass
                - ax * sin_a * (mass * centre)
                + motion.turn * inertia;
            if effect == Effect::Torque { -external } else { external }
        }
    }
}

/// A quantity with a value at every crank angle in every row.
pub(super) trait Curve {
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T;
}

/// Effect of gas, piston and rod.
pub(super) struct Loaded<'r> {
    pub(super) rows: &'r Rows,
    pub(super) speed: Speed,
    pub(super) effect: Effect,
}

/// Effect of piston and rod without gas.
pub(super) struct Unfired<'r>(pub(super) Loaded<'r>);

impl Curve for Unfired<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        self.0.by(row, angle, angle.sin * 0.0)
    }
}

impl Loaded<'_> {
    /// Effect with this force of the gas along the cylinder.
    #[inline(always)]
    fn by<T: Real>(&self, row: usize, angle: &Angle<T>, gas: T) -> T {
        let x = self.rows.row(row);
        let motion = Motion::of(angle, x.of(input::R), x.of(input::L), self.speed.circular(self.rows, row));
        let along = gas + motion.piston * -x.of(input::M_P);
        let body = [x.of(input::M_ROD), x.of(input::MC), x.of(input::I_G)];
        effect(self.effect, angle, &motion, body, along, [x.of(input::R), x.of(input::L)])
    }
}

impl Curve for Loaded<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        self.by(row, angle, gas_force(angle, self.rows.x[input::D][row]))
    }
}

#[inline(always)]
pub(super) fn gas_force<T: Real>(angle: &Angle<T>, bore: f64) -> T {
    (angle.pressure + -gas::ATMOSPHERE) * (-0.25 * PI * bore * bore)
}

/// Place of the rod's mass centre.
#[derive(Clone, Copy)]
pub(super) enum Centre {
    Given,
    /// Mass centre at mc_F. The inertia is that for the nominal distance of the eyes.
    Optimum,
    /// Mass centre at mc_T. The inertia is that for the actual mass centre and distance of the eyes.
    Tied,
}

/// Effect of the rod without piston and gas.
pub(super) struct Alone<'r> {
    rows: &'r Rows,
    speed: Speed,
    effect: Effect,
    /// Mass, centre of mass and inertia in every row. They do not depend on the angle.
    bodies: [[f64; LANES]; 3],
}

impl<'r> Alone<'r> {
    pub(super) fn of(rows: &'r Rows, speed: Speed, centre: Centre, effect: Effect) -> Self {
        let [reference, eyes] = REFERENCE;
        let cubes = |centre: f64, l: f64| centre * centre * centre + (l - centre) * (l - centre) * (l - centre);
        let mut bodies = [[0.0; LANES]; 3];
        for row in 0..rows.count {
            let x = rows.row(row);
            let l = x.of(input::L);
            let moved = |to: usize| x.of(to) + (x.of(input::MC) - reference);
            let (at, factor) = match centre {
                Centre::Given => (x.of(input::MC), 1.0),
                Centre::Optimum => (moved(input::MC_F), cubes(x.of(input::MC_F), eyes) / cubes(reference, eyes)),
                Centre::Tied => (moved(input::MC_T), cubes(moved(input::MC_T), l) / cubes(reference, l)),
            };
            let body = [x.of(input::M_ROD), at, factor * x.of(input::I_G)];
            bodies.iter_mut().zip(body).for_each(|(rows, of)| rows[row] = of);
        }
        Self { rows, speed, effect, bodies }
    }
}

impl Curve for Alone<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        let x = self.rows.row(row);
        let l = x.of(input::L);
        let motion = Motion::of(angle, x.of(input::R), l, self.speed.circular(self.rows, row));
        let body = self.bodies.each_ref().map(|rows| rows[row]);
        effect(self.effect, angle, &motion, body, angle.sin * 0.0, [x.of(input::R), l])
    }
}
