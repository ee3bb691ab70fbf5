//! Polynomial of the surface along one direction, which is integrated by its own distribution function (preintegration).
//!
//! Coordinates `v` are independent, and the inputs are `z = M v`. `M` mixes normal inputs only. Correlated inputs of other distributions
//! are functions of mixed normal variables. Among the normal inputs the direction is the steepest one, `L'p` with `p_j = E[g_j']`. It
//! becomes the first axis of the block (Liu and Owen 2023). Otherwise the direction is the single input of largest variance. An input with
//! atoms is never the direction.

use std::sync::Arc;

use faer::{Mat, Side};

use crate::law::input::Input;
use crate::law::inversion::quadratic_form::{factor, form};
use crate::law::polynomial::{Quartic, value};
use crate::law::surface::Surface;

/// Coordinates of a part of the surface, and the one among them that is integrated.
#[derive(Debug, Clone)]
pub(super) struct Direction {
    surface: Arc<Surface>,
    /// Inputs that are mixtures of normal coordinates with the same indices. `axes` is the mixing matrix.
    block: Vec<usize>,
    axes: Mat<f64>,
    /// Inputs that are functions of mixed normal variables: those that are not normal themselves, and those correlated with such.
    behind: Vec<usize>,
    behind_factor: Mat<f64>,
    /// Coordinate that is integrated; None if there is none.
    along: Option<usize>,
    /// Slopes of the inputs by the direction: pairs (input, slope) of those that are not 0. `slope_of` holds all by index.
    slopes: Vec<(usize, f64)>,
    slope_of: Vec<f64>,
    /// Inputs of this part of the surface.
    members: Vec<usize>,
}

impl Direction {
    /// Coordinates and direction of these inputs, which form whole components. Returns None if a correlation has no factor.
    pub(super) fn of(surface: &Arc<Surface>, members: &[usize]) -> Option<Self> {
        let own = |j: &usize| members.contains(j);
        // Inputs that are linked by correlation to one that is not normal.
        let mut behind: Vec<usize> = Vec::new();
        if let Some(correlated) = &surface.correlated {
            let odd = |j: &usize| !surface.inputs[*j].is_normal();
            let mut open: Vec<usize> = correlated.members.iter().copied().filter(odd).filter(own).collect();
            while let Some(j) = open.pop() {
                if !behind.contains(&j) {
                    behind.push(j);
                    open.extend(correlated.members.iter().copied().filter(|&k| correlated.linked(j, k)));
                }
            }
            behind.sort_unstable();
        }
        let block: Vec<usize> =
            members.iter().copied().filter(|&j| surface.inputs[j].is_normal() && !behind.contains(&j)).collect();
        let m = block.len();
        let mut axes = factor(surface, &block)?.unwrap_or_else(|| Mat::identity(m, m));
        let behind_factor = factor(surface, &behind)?.unwrap_or_else(|| Mat::zeros(0, 0));
        let moments = |j: usize| {
            let nodes = surface.inputs[j].nodes(&surface.parts[j], 0.0, 0.0);
            let over = |f: &dyn Fn(f64) -> f64| nodes.z.iter().zip(&nodes.weight).map(|(&z, w)| w * f(z)).sum::<f64>();
            let mean = over(&|z| value(&surface.parts[j], z));
            let slope = over(&|z| value(&surface.parts[j], z) * z);
            [slope, over(&|z| (value(&surface.parts[j], z) - mean).powi(2))]
        };
        let slopes: Vec<f64> = block.iter().map(|&j| moments(j)[0]).collect();
        let mut steepest: Vec<f64> = (0..m).map(|a| (0..m).map(|j| axes[(j, a)] * slopes[j]).sum()).collect();
        let strength: f64 = steepest.iter().map(|d| d * d).sum();
        let free = |j: &&usize| {
            let input = &surface.inputs[**j];
            !input.is_normal() && input.atoms.is_empty() && !behind.contains(j)
        };
        let others = members.iter().filter(free).map(|&j| (j, moments(j)[1]));
        let other = others.fold(None, |best: Option<(usize, f64)>, next| match best {
            Some(best) if best.1 >= next.1 => Some(best),
            _ => Some(next),
        });
        let norm = strength.sqrt();
        steepest.iter_mut().for_each(|d| *d /= if norm > 0.0 { norm } else { 1.0 });
        // Slopes that change sign average out. Then take the direction of the largest mean square of the slope.
        let strength = match swinging(surface, &block, &axes, &steepest) {
            Some((direction, squares)) => {
                steepest = direction;
                squares
            }
            None => strength,
        };
        // Prefer the normal direction unless a single free input has the larger variance.
        let by_normal = m > 0 && (strength > 0.0 || other.is_none()) && other.is_none_or(|(_, most)| strength >= most);
        if by_normal && strength > 0.0 {
            axes = reflected(&axes, &steepest);
        }
        let along = if by_normal { Some(block[0]) } else { other.map(|(j, _)| j) };
        let slopes: Vec<(usize, f64)> = match along {
            Some(_) if by_normal => block.iter().enumerate().map(|(a, &j)| (j, axes[(a, 0)])).collect(),
            Some(j) => vec![(j, 1.0)],
            None => Vec::new(),
        };
        let slopes: Vec<(usize, f64)> = slopes.into_iter().filter(|&(_, d)| d != 0.0).collect();
        let mut slope_of = vec![0.0; surface.len()];
        slopes.iter().for_each(|&(j, d)| slope_of[j] = d);
        Some(Self {
            surface: Arc::clone(surface),
            block,
            axes,
            behind,
            behind_factor,
            along,
            slopes,
            slope_of,
            members: members.to_vec(),
        })
    }

    /// Distribution of the direction.
    pub(super) fn input(&self) -> Option<&Input> {
        self.along.map(|j| self.surface.inputs[j].as_ref())
    }

    /// Inputs of this part of the surface.
    pub(super) fn members(&self) -> &[usize] {
        &self.members
    }

    /// Coordinate that is integrated.
    pub(super) fn coordinate(&self) -> Option<usize> {
        self.along
    }

    /// Slopes of the inputs by a coordinate, if the inputs are linear in it.
    pub(super) fn column(&self, coordinate: usize) -> Vec<(usize, f64)> {
        match self.block.binary_search(&coordinate) {
            Ok(b) => {
                let own = self.block.iter().enumerate().map(|(a, &j)| (j, self.axes[(a, b)]));
                own.filter(|&(_, d)| d != 0.0).collect()
            }
            Err(_) => vec![(coordinate, 1.0)],
        }
    }

    /// Identical coordinates and direction for another surface over the same inputs.
    pub(super) fn over(&self, surface: &Arc<Surface>) -> Self {
        Self { surface: Arc::clone(surface), ..self.clone() }
    }

    /// Slopes of the inputs by the direction, without those that are 0.
    pub(super) fn slopes(&self) -> &[(usize, f64)] {
        &self.slopes
    }

    /// Identical part of the surface with every coordinate sampled and no direction.
    pub(super) fn without(mut self) -> Self {
        self.along = None;
        self.slopes.clear();
        self.slope_of.fill(0.0);
        self
    }

    /// Variance along the direction, with the other coordinates at their means.
    pub(super) fn variance(&self) -> f64 {
        let Some(input) = self.input() else { return 0.0 };
        let terms = self.terms(&self.surface);
        let along = self.along(&vec![0.0; self.surface.len()], &terms);
        let nodes = input.nodes(&along, 0.0, 0.0);
        let over = |f: &dyn Fn(f64) -> f64| nodes.z.iter().zip(&nodes.weight).map(|(&z, w)| w * f(z)).sum::<f64>();
        let mean = over(&|z| value(&along, z));
        over(&|z| (value(&along, z) - mean).powi(2))
    }

    /// Other coordinates, each by the index of its input.
    pub(super) fn rest(&self) -> Vec<usize> {
        self.members.iter().copied().filter(|&j| Some(j) != self.along).collect()
    }

    /// True if a coordinate is a normal variable behind an input.
    pub(super) fn is_behind(&self, coordinate: usize) -> bool {
        self.behind.contains(&coordinate)
    }

    /// Turns coordinates into inputs, in place. Both are indexed like the inputs of the surface.
    pub(super) fn mix(&self, v: &mut [f64], scratch: &mut Vec<f64>) {
        for (members, axes) in [(&self.block, &self.axes), (&self.behind, &self.behind_factor)] {
            if members.len() < 2 && !std::ptr::eq(members, &self.behind) {
                continue;
            }
            scratch.clear();
            scratch.extend(members.iter().map(|&j| v[j]));
            for (a, &j) in members.iter().enumerate() {
                v[j] = scratch.iter().enumerate().map(|(b, v)| axes[(a, b)] * v).sum();
            }
        }
        if let Some(correlated) = &self.surface.correlated {
            let own = correlated.blocks.iter().filter(|block| self.behind.contains(&block.members[0]));
            own.for_each(|block| block.apply(v, scratch));
        }
        for &j in &self.behind {
            v[j] = self.surface.inputs[j].at_score(v[j]);
        }
    }

    /// Products of a surface with the same inputs and parts, sorted by their order along the direction.
    pub(super) fn terms(&self, surface: &Surface) -> Terms {
        let products: Vec<(usize, usize, f64)> =
            surface.products().filter(|(j, _, _)| self.members.binary_search(j).is_ok()).collect();
        let square = products.iter().map(|&(j, k, b)| b * self.slope_of[j] * self.slope_of[k]).sum();
        let mut linear: Vec<(usize, usize, f64)> = Vec::new();
        for &(j, d) in &self.slopes {
            linear.extend(surface.neighbours[j].iter().map(|&(k, b)| (j, k, d * b)));
        }
        Terms { products, linear, square }
    }

    /// Surface about its centre as a polynomial along the direction. `z` are inputs at which the direction is 0.
    pub(super) fn along(&self, z: &[f64], terms: &Terms) -> Quartic {
        let mut c = [0.0; 5];
        c[0] = terms.products.iter().map(|&(j, k, b)| b * z[j] * z[k]).sum();
        c[1] = terms.linear.iter().map(|&(_, k, b)| b * z[k]).sum();
        c[2] = terms.square;
        for &j in &self.members {
            shifted(&self.surface.parts[j], z[j], self.slope_of[j], &mut c);
        }
        c
    }

    /// True if several inputs are mixtures of normal coordinates.
    pub(super) fn is_mixed(&self) -> bool {
        self.block.len() > 1
    }

    /// Single input that is the direction by itself.
    pub(super) fn own(&self) -> Option<usize> {
        if let [(j, _)] = self.slopes[..] { Some(j) } else { None }
    }

    pub(super) fn surface(&self) -> &Surface {
        &self.surface
    }
}

/// Products of a surface, expanded along a direction: constant, linear and quadratic.
#[derive(Debug, Clone)]
pub(super) struct Terms {
    products: Vec<(usize, usize, f64)>,
    /// Linear terms `d_j b_jk z_k` of the inputs `j` that move with the direction.
    linear: Vec<(usize, usize, f64)>,
    square: f64,
}

/// Adds the Taylor expansion of a part about `z` in steps of `d`.
#[inline]
pub(super) fn shifted(part: &Quartic, z: f64, d: f64, c: &mut Quartic) {
    if d == 0.0 {
        c[0] += value(part, z);
        return;
    }
    let mut factor = 1.0;
    for (q, c) in c.iter_mut().enumerate() {
        let mut sum = 0.0;
        for i in (q..5).rev() {
            sum = sum * z + BINOMIAL[i][q] * part[i];
        }
        *c += sum * factor;
        factor *= d;
    }
}

const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// Direction of the largest mean square of the slope among normal inputs, and that mean square. Returns None if the mean slope is nearly as
/// steep, or if there are too many inputs.
///
/// ```text
/// E[dy/dz_j dy/dz_k] = sum_n n! d_jn d_kn rho_jk^n,   dy/dz_j = sum_n d_jn He_n(z_j) + sum_k b_jk z_k
/// ```
fn swinging(surface: &Surface, block: &[usize], axes: &Mat<f64>, steepest: &[f64]) -> Option<(Vec<f64>, f64)> {
    /// Greatest number of inputs, because the direction is an eigenvector.
    const MOST: usize = 64;
    /// Factor of the mean squares from which on the other direction pays.
    const WORTH: f64 = 2.0;
    let m = block.len();
    if m == 0 || m > MOST {
        return None;
    }
    let correlation = axes * axes.transpose();
    let mut linear = form(surface, block) * 2.0;
    block.iter().enumerate().for_each(|(a, &j)| linear[(a, a)] += 12.0 * surface.parts[j][4]);
    let by_linear = &linear * &correlation * linear.transpose();
    let inside = |k: &usize| block.binary_search(k).is_ok();
    let squares = Mat::from_fn(m, m, |a, b| {
        let ([_, c1, _, c3, c4], [_, d1, _, d3, d4], rho) =
            (surface.parts[block[a]], surface.parts[block[b]], correlation[(a, b)]);
        let beside = surface.neighbours[block[a]].iter().filter(|(k, _)| !inside(k));
        let outside: f64 = beside.map(|&(k, product)| product * surface.product(block[b], k)).sum();
        let means = (c1 + 3.0 * c3) * (d1 + 3.0 * d3);
        means + by_linear[(a, b)] + outside + 18.0 * c3 * d3 * rho * rho + 96.0 * c4 * d4 * rho.powi(3)
    });
    let squares = axes.transpose() * &squares * axes;
    let eigen = squares.self_adjoint_eigen(Side::Lower).ok()?;
    let most = eigen.S()[m - 1];
    let own: f64 = (0..m).map(|a| (0..m).map(|b| steepest[a] * squares[(a, b)] * steepest[b]).sum::<f64>()).sum();
    if most.is_nan() || most <= WORTH * own {
        return None;
    }
    let vector: Vec<f64> = (0..m).map(|a| eigen.U()[(a, m - 1)]).collect();
    // Choose the sign that makes the largest component positive.
    let largest =
        vector.iter().fold(0.0f64, |largest, d| if d.abs() > largest.abs() * (1.0 + 1e-9) { *d } else { largest });
    Some((vector.iter().map(|d| d * largest.signum()).collect(), most))
}

/// Axes after a reflection that makes this unit vector the first of them.
fn reflected(axes: &Mat<f64>, unit: &[f64]) -> Mat<f64> {
    let m = unit.len();
    // Householder: v = unit + sign e1, H = I - 2 v v'/|v|^2 maps e1 to -sign unit.
    let sign = if unit[0] < 0.0 { -1.0 } else { 1.0 };
    let mut v = unit.to_vec();
    v[0] += sign;
    let norm: f64 = v.iter().map(|v| v * v).sum();
    Mat::from_fn(m, m, |i, k| {
        let along: f64 = (0..m).map(|j| axes[(i, j)] * v[j]).sum();
        let image = axes[(i, k)] - 2.0 * along * v[k] / norm;
        if k == 0 { -sign * image } else { image }
    })
}
