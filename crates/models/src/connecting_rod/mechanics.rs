//! How the rod moves, and the forces that this takes.

use std::f64::consts::PI;

use super::super::gas;
use super::super::jet::{Jet, Real};
use super::{DEGREE, LANES, Rows, input};
use sensitol_numeric::elementary::{Cos, Elementary, Sin};

/// The rod by the crank of the gas trace, which tolerances do not change.
pub(super) const ROD_BY_CRANK: f64 = 133.6 / 41.0;
/// The mass centre, and the distance of the eyes, that the optima are told from: m.
pub(super) const REFERENCE: [f64; 2] = [0.105, 0.1336];

/// The pressure at any angle, Pa.
pub(super) fn pressure(degrees: f64, p3: f64, start: f64) -> f64 {
    gas::pressure(degrees, p3, start, ROD_BY_CRANK)
}

/// The speed of the crankshaft: one for all rows in rpm, or the input `speed` of each.
#[derive(Clone, Copy)]
pub(super) enum Speed {
    Rpm(f64),
    Given,
}

impl Speed {
    /// In rad/s.
    #[inline(always)]
    pub(super) fn circular(self, rows: &Rows, row: usize) -> f64 {
        match self {
            Self::Rpm(rpm) => rpm * PI / 30.0,
            Self::Given => rows.x[input::SPEED][row] * PI / 30.0,
        }
    }
}

/// A crank angle with the gas pressure there.
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
    /// With derivatives by the angle; of the pressure too where gas matters.
    pub(super) fn around(theta: f64, gas: Option<(f64, f64)>) -> Self {
        let (s, c) = (Sin::of(theta), Cos::of(theta));
        let (sin, cos) = (Jet([s, c, -s]), Jet([c, -s, -c]));
        let pressure = gas.map_or(Jet([0.0; 3]), |(p3, start)| {
            let degrees = Jet([theta / DEGREE, 1.0 / DEGREE, 0.0]);
            match theta / DEGREE {
                ..-180.0 => Jet([gas::SUCTION, 0.0, 0.0]),
                // Exclusive of 180 itself, as in `pressure`: both sides are equal there.
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

/// How the rod moves.
pub(super) struct Motion<T> {
    pub(super) sin_a: T,
    pub(super) cos_a: T,
    /// Square of the rate of the rod's angle, and its acceleration.
    pub(super) rate: T,
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

    /// Acceleration at a distance from the small end, along the cylinder and across it.
    #[inline(always)]
    pub(super) fn acceleration(&self, at: f64) -> [T; 2] {
        let along = self.piston + (self.rate * self.cos_a + self.turn * self.sin_a) * -at;
        [along, (self.turn * self.cos_a + -(self.rate * self.sin_a)) * at]
    }

    /// The force across the cylinder at the small end, of a body of this mass, centre and inertia, and a force along it.
    #[inline(always)]
    pub(super) fn side_force(&self, [mass, centre, inertia]: [f64; 3], [ax, ay]: [T; 2], along: T, l: f64) -> T {
        let rest = (ay * self.cos_a - ax * self.sin_a) * (mass * (l - centre));
        (self.turn * -inertia + rest + along * self.sin_a * l) / (self.cos_a * l)
    }
}

/// The effect that is maximised.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Effect {
    Compression,
    Tension,
    Normal,
    AgainstNormal,
    /// That the rod exerts on the crank.
    Torque,
    Braking,
    /// Compression at the big end: the small end's, less what accelerates the rod along itself.
    BigEnd,
}

/// One effect on a rod with mass, centre of mass and inertia, with a force along the cylinder at its small end.
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

/// Something that has a value at every crank angle in every row.
pub(super) trait Curve {
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T;
}

/// Gas, piston and rod.
pub(super) struct Loaded<'r> {
    pub(super) rows: &'r Rows,
    pub(super) speed: Speed,
    pub(super) effect: Effect,
}

/// Piston and rod without gas.
pub(super) struct Unfired<'r>(pub(super) Loaded<'r>);

impl Curve for Unfired<'_> {
    #[inline(always)]
    fn at<T: Real>(&self, row: usize, angle: &Angle<T>) -> T {
        self.0.by(row, angle, angle.sin * 0.0)
    }
}

impl Loaded<'_> {
    /// With this force of the gas along the cylinder.
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

/// Where the mass centre of the rod is.
#[derive(Clone, Copy)]
pub(super) enum Centre {
    Given,
    /// At mc_F, the inertia as for the nominal distance of the eyes.
    Optimum,
    /// At mc_T, the inertia as for the mass centre and the distance of the eyes that there are.
    Tied,
}

/// The rod without piston and gas.
pub(super) struct Alone<'r> {
    rows: &'r Rows,
    speed: Speed,
    effect: Effect,
    /// Mass, centre of mass and inertia in every row, the same at any angle.
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
