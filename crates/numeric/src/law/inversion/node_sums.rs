//! Sums over the nodes of a tree of products, many nodes in one instruction.
//!
//! Real and imaginary parts stand in arrays of their own. Every sum has [`LANES`] partial sums, which are added in a fixed order, so that
//! results have the same bits on every processor.

use std::ops::{Add, Sub};

use crate::elementary::{Cos, Elementary, Exp, Sin, Work, on_this_processor};
use crate::law::inversion::complex::Complex;

/// Nodes that are summed side by side.
const LANES: usize = 8;

/// Exponent `constant + linear u + square u^2` of a message in closed form.
#[derive(Clone, Copy)]
pub(super) struct Parabola {
    pub(super) constant: Complex,
    pub(super) linear: Complex,
    pub(super) square: Complex,
}

impl Parabola {
    pub(super) const ZERO: Self = Self { constant: Complex::ZERO, linear: Complex::ZERO, square: Complex::ZERO };
}

impl Add for Parabola {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            constant: self.constant + other.constant,
            linear: self.linear + other.linear,
            square: self.square + other.square,
        }
    }
}

impl Sub for Parabola {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            constant: self.constant - other.constant,
            linear: self.linear - other.linear,
            square: self.square - other.square,
        }
    }
}

/// Complex factors of the nodes of one input.
#[derive(Debug, Default)]
pub(super) struct NodeFactors {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl NodeFactors {
    pub(super) fn new(nodes: usize) -> Self {
        Self { re: vec![1.0; nodes], im: vec![0.0; nodes] }
    }

    /// Multiplies by the factors of another list.
    pub(super) fn multiply(&mut self, other: &Self) {
        on_this_processor(Multiplication { own: self, other });
    }

    /// Sum of the factors with these weights.
    pub(super) fn weighed(&self, weights: &[f64]) -> Complex {
        let all = self.re.iter().zip(&self.im).zip(weights);
        all.fold(Complex::ZERO, |sum, ((&re, &im), &w)| sum + Complex::new(re, im) * w)
    }
}

struct Multiplication<'a> {
    own: &'a mut NodeFactors,
    other: &'a NodeFactors,
}

impl Work for Multiplication<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let own = self.own.re.iter_mut().zip(&mut self.own.im);
        for ((re, im), (c, d)) in own.zip(self.other.re.iter().zip(&self.other.im)) {
            let (a, b) = (*re, *im);
            *re = a * c - b * d;
            *im = a * d + b * c;
        }
    }
}

/// Writes `exp(i t g(z) + below(z))` at every node.
pub(super) struct Phases<'a> {
    pub(super) z: &'a [f64],
    pub(super) values: &'a [f64],
    pub(super) t: f64,
    /// Exponent of the closed branches below. None if there is none.
    pub(super) below: Option<Parabola>,
    pub(super) out: &'a mut NodeFactors,
}

impl Work for Phases<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { z, values, t, below, out } = self;
        let Some(Parabola { constant, linear, square }) = below else {
            let angles: Vec<f64> = values.iter().map(|g| t * g).collect();
            Cos::map_inline(&angles, &mut out.re);
            Sin::map_inline(&angles, &mut out.im);
            return;
        };
        let angle = |(u, g): (&f64, &f64)| t * g + (constant.im + (linear.im + square.im * u) * u);
        let angles: Vec<f64> = z.iter().zip(values).map(angle).collect();
        let exponents: Vec<f64> = z.iter().map(|u| constant.re + (linear.re + square.re * u) * u).collect();
        let mut sizes = vec![0.0; exponents.len()];
        Exp::map_inline(&exponents, &mut sizes);
        Cos::map_inline(&angles, &mut out.re);
        Sin::map_inline(&angles, &mut out.im);
        for ((re, im), size) in out.re.iter_mut().zip(&mut out.im).zip(&sizes) {
            *re *= size;
            *im *= size;
        }
    }
}

/// Largest exponent `logs + slope z`, and the sum of the exponential function of all exponents less that one, for each slope.
pub(super) struct LogSums<'a> {
    pub(super) z: &'a [f64],
    pub(super) logs: &'a [f64],
    pub(super) slopes: &'a [f64],
}

impl Work for LogSums<'_> {
    type Output = Vec<[f64; 2]>;

    #[inline(always)]
    fn work(self) -> Self::Output {
        let Self { z, logs, slopes } = self;
        let (mut exponents, mut sizes) = (vec![0.0; z.len()], vec![0.0; z.len()]);
        let mut sums = Vec::with_capacity(slopes.len());
        for &slope in slopes {
            for ((exponent, log), z) in exponents.iter_mut().zip(logs).zip(z) {
                *exponent = log + slope * z;
            }
            let most = exponents.iter().copied().fold(f64::NEG_INFINITY, |most, e| if e > most { e } else { most });
            exponents.iter_mut().for_each(|exponent| *exponent -= most);
            Exp::map_inline(&exponents, &mut sizes);
            let (lanes, rest) = sizes.as_chunks::<LANES>();
            let mut sum = [0.0; LANES];
            lanes.iter().for_each(|lane| sum.iter_mut().zip(lane).for_each(|(sum, size)| *sum += size));
            sums.push([most, sum.iter().sum::<f64>() + rest.iter().sum::<f64>()]);
        }
        sums
    }
}

/// Message as a table. Every node of the parent has the weights of the own nodes, with the sum 1, and their rotation to the next point.
pub(super) struct Message {
    now: NodeFactors,
    turn: NodeFactors,
    own: usize,
}

impl Message {
    /// Message of the nodes `z` with the logarithms of their weights. `slopes` has for every node of the parent the slope of the exponent and
    /// the logarithm of the sum of the weights, `turns` the phase per unit of `z` and `t`. The points are `t = from, from + step, ...`.
    pub(super) fn new((z, logs): (&[f64], &[f64]), slopes: &[[f64; 2]], turns: &[f64], [from, step]: [f64; 2]) -> Self {
        let elements = z.len() * slopes.len();
        let (mut now, mut turn) = (NodeFactors::new(elements), NodeFactors::new(elements));
        on_this_processor(Filling { z, logs, slopes, turns, from, step, now: &mut now, turn: &mut turn });
        Self { now, turn, own: z.len() }
    }

    /// Writes the message at every node of the parent and advances to the next point.
    pub(super) fn next(&mut self, factors: &NodeFactors, out: &mut NodeFactors) {
        on_this_processor(Advance { message: self, factors, out });
    }
}

struct Filling<'a> {
    z: &'a [f64],
    logs: &'a [f64],
    slopes: &'a [[f64; 2]],
    turns: &'a [f64],
    from: f64,
    step: f64,
    now: &'a mut NodeFactors,
    turn: &'a mut NodeFactors,
}

impl Work for Filling<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { z, logs, slopes, turns, from, step, now, turn } = self;
        let own = z.len();
        let (mut angles, mut sizes) = (vec![0.0; own], vec![0.0; own]);
        for (row, (&[slope, log], &product)) in slopes.iter().zip(turns).enumerate() {
            let range = row * own..(row + 1) * own;
            angles.iter_mut().zip(z.iter().zip(logs)).for_each(|(e, (z, own))| *e = own + slope * z - log);
            Exp::map_inline(&angles, &mut sizes);
            angles.iter_mut().zip(z).for_each(|(angle, z)| *angle = step * (product * z));
            Cos::map_inline(&angles, &mut turn.re[range.clone()]);
            Sin::map_inline(&angles, &mut turn.im[range.clone()]);
            angles.iter_mut().zip(z).for_each(|(angle, z)| *angle = from * (product * z));
            let (re, im) = (&mut now.re[range.clone()], &mut now.im[range]);
            Cos::map_inline(&angles, re);
            Sin::map_inline(&angles, im);
            re.iter_mut().zip(&sizes).for_each(|(re, size)| *re *= size);
            im.iter_mut().zip(&sizes).for_each(|(im, size)| *im *= size);
        }
    }
}

struct Advance<'a> {
    message: &'a mut Message,
    factors: &'a NodeFactors,
    out: &'a mut NodeFactors,
}

impl Work for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { message: Message { now, turn, own }, factors, out } = self;
        out.re.clear();
        out.im.clear();
        let own = (*own).max(1);
        let rows = now.re.chunks_exact_mut(own).zip(now.im.chunks_exact_mut(own));
        for ((re, im), (turn_re, turn_im)) in rows.zip(turn.re.chunks_exact(own).zip(turn.im.chunks_exact(own))) {
            let (mut sum_re, mut sum_im) = ([0.0; LANES], [0.0; LANES]);
            let whole = own / LANES * LANES;
            let mut first = 0;
            while first < whole {
                let lanes = first..first + LANES;
                let (re, im) = (&mut re[lanes.clone()], &mut im[lanes.clone()]);
                let (turn_re, turn_im) = (&turn_re[lanes.clone()], &turn_im[lanes.clone()]);
                let (c, d) = (&factors.re[lanes.clone()], &factors.im[lanes]);
                for lane in 0..LANES {
                    let (a, b) = (re[lane], im[lane]);
                    sum_re[lane] += a * c[lane] - b * d[lane];
                    sum_im[lane] += a * d[lane] + b * c[lane];
                    re[lane] = a * turn_re[lane] - b * turn_im[lane];
                    im[lane] = a * turn_im[lane] + b * turn_re[lane];
                }
                first += LANES;
            }
            let (mut re_rest, mut im_rest) = (0.0, 0.0);
            for at in whole..own {
                let (a, b) = (re[at], im[at]);
                re_rest += a * factors.re[at] - b * factors.im[at];
                im_rest += a * factors.im[at] + b * factors.re[at];
                re[at] = a * turn_re[at] - b * turn_im[at];
                im[at] = a * turn_im[at] + b * turn_re[at];
            }
            out.re.push(sum_re.iter().sum::<f64>() + re_rest);
            out.im.push(sum_im.iter().sum::<f64>() + im_rest);
        }
    }
}
