//! Inputs whose products form a tree: `M(s)` by nested sums.
//!
//! The message of the branch below input `j` is a function of the value `u` of its parent,
//!
//! ```text
//! m_j(u) = E[ exp(s (g_j(z) + b z u)) prod_children m_k(z) ]
//! ```
//!
//! The message is `exp` of a parabola in `u` if the branch consists of parabolas of normal inputs. Otherwise it is a table over the
//! parent's nodes. Every message is divided by its value at the real part of `s`, so that nothing overflows.

use crate::law::input;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::elementary::{Elementary, Exp, on_this_processor};
use crate::law::inversion::complex::Complex;
use crate::law::inversion::node_sums::{LogSums, Message, NodeFactors, Parabola, Phases};
use crate::law::inversion::single_input::{Table, level, own_ends_weigh_nothing};
use crate::law::polynomial::{Quartic, value};
use crate::law::surface::Surface;

/// Negative logarithm of the least weight, relative to the largest, that a node may have: 1e-17 of the whole.
const LEAST: f64 = 40.0;
/// Greatest number of elements of a table of products. Beyond it the contour ends, with the error that this leaves.
const MOST: usize = 1 << 22;
/// Greatest product of a table's elements and the points of the contour so far, about 1e8. The contour also ends there.
const EFFORT: f64 = (1u64 << 27) as f64;

/// Product of elements and points from which on the contour may be given up, because the transform has not begun to vanish.
const CHEAP: f64 = (1u64 << 20) as f64;
/// Relative size of the transform, at a product of `CHEAP`, above which the contour is given up. It falls with the inverse square of the
/// product.
const HOPELESS: f64 = 0.02;
/// Sigmas of its neighbours up to which an input's nodes resolve the products. Half of them may add to the weight of a node.
const REACH: f64 = 8.0;
/// Points of a contour that share their nodes: next to the real axis, where the nodes double every few points, and beyond.
const SHARED: [usize; 2] = [8, 64];
/// Relative size below which the transform of a whole block of points is only rounding.
const VANISHED: f64 = 1e-15;
const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Tree of products, from the leaves to the root.
#[derive(Debug)]
pub(in crate::law) struct Tree {
    nodes: Vec<Node>,
    tables: Mutex<BTreeMap<(usize, i32), Arc<Table>>>,
}

/// Input with the branch below it.
#[derive(Debug)]
struct Node {
    /// Index of the input in the surface.
    input: usize,
    law: Arc<input::Input>,
    part: Quartic,
    children: Vec<usize>,
    /// Coefficient of the product with the parent.
    product: f64,
    /// Greatest change of the exponent by other inputs, per sigma of this one and unit of `s`.
    near: f64,
    /// True if the branch consists of parabolas of normal inputs.
    closed: bool,
}

/// Sums of one node at one tilt.
struct Tilted {
    z: Vec<f64>,
    values: Vec<f64>,
    /// Logarithms of weight, tilt and the branches below.
    logs: Vec<f64>,
}

impl Tree {
    /// Tree of the products among the members. Returns None if they form no tree.
    pub(in crate::law) fn of(surface: &Surface, members: &[usize]) -> Option<Self> {
        let degree = |j: usize| surface.neighbours[j].len();
        let edges: usize = members.iter().map(|&j| degree(j)).sum();
        if edges != 2 * (members.len() - 1) || members.iter().any(|&j| surface.is_correlated(j)) {
            return None;
        }
        // Choose as root the input with most products, preferably one whose branch has no closed form.
        let root = *members.iter().min_by_key(|&&j| (surface.is_normal_parabola(j), usize::MAX - degree(j), j))?;
        let mut order = vec![(root, usize::MAX)];
        let mut next = 0;
        while next < order.len() {
            let (j, parent) = order[next];
            let below = surface.neighbours[j].iter().map(|&(k, _)| k).filter(|&k| k != parent);
            order.extend(below.map(|k| (k, j)).collect::<Vec<_>>());
            next += 1;
        }
        order.reverse();
        let reach = |k: usize| surface.inputs[k].ends.iter().fold(0.0f64, |most, end| most.max(end.abs())).min(REACH);
        let place = |j: usize| order.iter().position(|&(k, _)| k == j);
        let mut nodes: Vec<Node> = Vec::with_capacity(order.len());
        for &(j, parent) in &order {
            let below = surface.neighbours[j].iter().filter(|&&(k, _)| k != parent);
            let children: Vec<usize> = below.filter_map(|&(k, _)| place(k)).collect();
            let closed = surface.is_normal_parabola(j) && children.iter().all(|&k| nodes[k].closed);
            nodes.push(Node {
                input: j,
                law: Arc::clone(&surface.inputs[j]),
                part: surface.parts[j],
                children,
                product: if parent == usize::MAX { 0.0 } else { surface.product(j, parent) },
                near: surface.neighbours[j].iter().map(|&(k, b)| b.abs() * reach(k)).sum(),
                closed,
            });
        }
        Some(Self { nodes, tables: Mutex::default() })
    }

    /// Indices of the inputs in the surface, ascending.
    pub(in crate::law) fn sorted(&self) -> Vec<usize> {
        let mut members: Vec<usize> = self.nodes.iter().map(|node| node.input).collect();
        members.sort_unstable();
        members
    }

    /// Mean and variance. The inputs are independent with mean 0 and variance 1, so products have no covariance with other terms.
    pub(in crate::law) fn moments(&self) -> [f64; 2] {
        self.nodes.iter().fold([0.0; 2], |[mean, variance], node| {
            let nodes = node.law.nodes(&node.part, 0.0, 0.0);
            let values: Vec<f64> = nodes.z.iter().map(|&z| value(&node.part, z)).collect();
            let over = |f: &dyn Fn(f64) -> f64| values.iter().zip(&nodes.weight).map(|(&g, w)| w * f(g)).sum::<f64>();
            let own = over(&|g| g);
            let spread = over(&|g| (g - own) * (g - own));
            [mean + own, variance + spread + node.product * node.product]
        })
    }

    fn table(&self, place: usize, level: i32) -> Arc<Table> {
        let node = &self.nodes[place];
        let mut tables = self.tables.lock().unwrap_or_else(PoisonError::into_inner);
        let table = tables
            .entry((place, level))
            .or_insert_with(|| Arc::new(Table::of(&node.law, &node.part, level, node.near, EVERYWHERE)));
        Arc::clone(table)
    }

    /// Nodes of an input that can have weight under a tilt.
    fn live(&self, place: usize, theta: f64, top: f64) -> Tilted {
        let node = &self.nodes[place];
        let table = self.table(place, level(top));
        let near = 0.5 * theta.abs() * node.near;
        let logs: Vec<f64> = table.values.iter().zip(&table.logs).map(|(g, log)| theta * g + log).collect();
        // Products may add as much to any node as they take from the heaviest one.
        let beside = |at: usize| near * table.z[at].abs();
        let most = (0..logs.len()).map(|at| logs[at] - beside(at)).fold(f64::NEG_INFINITY, f64::max);
        let kept: Vec<usize> = (0..logs.len()).filter(|&at| logs[at] + beside(at) > most - LEAST).collect();
        let of = |values: &[f64]| kept.iter().map(|&at| values[at]).collect();
        Tilted { z: of(&table.z), values: of(&table.values), logs: of(&logs) }
    }

    /// True if a tilt exists: closed branches exist, and no cut end of an unbounded input has weight.
    pub(in crate::law) fn bears(&self, theta: f64, at_mean: f64) -> bool {
        /// Sigmas of the parent that may add to the weight of a node.
        const OWN_REACH: f64 = 4.0;
        if !self.closed_positive(theta) {
            return false;
        }
        let bounded = |node: &Node| node.law.support.iter().all(|end| end.is_finite());
        if self.nodes.iter().all(|node| node.closed || bounded(node)) {
            return true;
        }
        let done = self.up(theta, at_mean);
        self.nodes.iter().zip(&done).filter(|(node, _)| !node.closed).all(|(node, (own, _))| {
            let near = OWN_REACH * (node.product * theta).abs();
            let weighed = || own.z.iter().zip(&own.logs).map(|(&z, log)| (z, log + near * z.abs()));
            own_ends_weigh_nothing(&node.law, weighed)
        })
    }

    /// True if the closed branches exist at a real tilt.
    fn closed_positive(&self, theta: f64) -> bool {
        (0..self.nodes.len()).filter(|&place| self.nodes[place].closed).all(|place| {
            let parabola = self.parabola(place, Complex::from(theta));
            parabola.constant.is_finite() && parabola.constant.im == 0.0
        })
    }

    /// Message of a closed branch.
    fn parabola(&self, place: usize, s: Complex) -> Parabola {
        let node = &self.nodes[place];
        let below = self.closed_below(place, s);
        // E exp(l z + h z^2) = exp(l^2/(2 q))/sqrt(q) with q = 1 - 2 h and l = s c1 + below + s b u.
        let q = Complex::ONE - (s * node.part[2] + below.square) * 2.0;
        let (own, by_parent) = (s * node.part[1] + below.linear, s * node.product);
        Parabola {
            constant: below.constant + own * own / (q * 2.0) - q.ln() * 0.5,
            linear: own * by_parent / q,
            square: by_parent * by_parent / (q * 2.0),
        }
    }

    /// Sum of the exponents of the closed branches below a node, by the value of that node.
    fn closed_below(&self, place: usize, s: Complex) -> Parabola {
        let closed = self.nodes[place].children.iter().filter(|&&child| self.nodes[child].closed);
        closed.map(|&child| self.parabola(child, s)).fold(Parabola::ZERO, |sum, more| sum + more)
    }

    /// `K` at a real tilt.
    pub(in crate::law) fn log(&self, theta: f64) -> f64 {
        let tilted = self.up(theta, theta.abs());
        tilted.last().map_or(0.0, |(_, log)| *log)
    }

    /// All nodes at a real tilt, with the branches below included in their logarithms, and the logarithm of each node's own message.
    fn up(&self, theta: f64, top: f64) -> Vec<(Tilted, f64)> {
        let s = Complex::from(theta);
        let mut done: Vec<(Tilted, f64)> = Vec::with_capacity(self.nodes.len());
        for (place, node) in self.nodes.iter().enumerate() {
            if node.closed {
                let log = self.parabola(place, s).constant.re;
                done.push((Tilted { z: Vec::new(), values: Vec::new(), logs: Vec::new() }, log));
                continue;
            }
            let mut tilted = self.live(place, theta, top);
            let below = self.closed_below(place, s);
            for (log, u) in tilted.logs.iter_mut().zip(&tilted.z) {
                *log += below.constant.re + u * (below.linear.re + u * below.square.re);
            }
            for &child in node.children.iter().filter(|&&child| !self.nodes[child].closed) {
                let slope = theta * self.nodes[child].product;
                let slopes: Vec<f64> = tilted.z.iter().map(|u| slope * u).collect();
                let more = log_sums(&done[child].0, &slopes);
                tilted.logs.iter_mut().zip(more).for_each(|(log, more)| *log += more);
            }
            let log = log_sums(&tilted, &[0.0])[0];
            done.push((tilted, log));
        }
        done
    }

    /// Multiplies `M(s)/M(theta)` into the points of a block. Returns the number of points that are resolved before the tables grow too
    /// large.
    pub(in crate::law) fn multiply(&self, theta: f64, from: f64, step: f64, out: &mut [Complex]) -> usize {
        let shared = SHARED[usize::from(from > 0.0)];
        let (mut ended, all) = (false, out.len());
        for (block, out) in out.chunks_mut(shared).enumerate() {
            if ended {
                out.fill(Complex::ZERO);
                continue;
            }
            let Some(effort) = self.few(theta, from + step * (block * shared) as f64, step, out) else {
                return block * shared;
            };
            // Nodes double from block to block, so a transform that has vanished is not resolved any further.
            let most = out.iter().map(|value| value.abs()).fold(0.0, f64::max);
            ended = most < VANISHED;
            if most > HOPELESS * (CHEAP / effort).powi(2) && effort > CHEAP {
                return (block * shared + out.len()).min(all);
            }
        }
        all
    }

    /// Multiplies the transform into points that share their nodes. Returns the largest product of table elements and points so far, or
    /// None if it is too large.
    fn few(&self, theta: f64, from: f64, step: f64, out: &mut [Complex]) -> Option<f64> {
        let top = libm::hypot(theta, from + step * out.len() as f64);
        let done = self.up(theta, top);
        let points = from / step + out.len() as f64;
        let mut effort: f64 = 0.0;
        let mut messages: Vec<Option<Message>> = Vec::with_capacity(self.nodes.len());
        let mut parents = vec![usize::MAX; self.nodes.len()];
        for (place, node) in self.nodes.iter().enumerate() {
            node.children.iter().for_each(|&child| parents[child] = place);
        }
        // Build the tables of all open branches first: they decide if the block is affordable.
        for (place, node) in self.nodes.iter().enumerate() {
            let open = !node.closed && parents[place] != usize::MAX;
            messages.push(match open {
                false => None,
                true => {
                    let (own, parent) = (&done[place].0, &done[parents[place]].0);
                    let elements = own.z.len() * parent.z.len();
                    if elements > MOST || elements as f64 * points > EFFORT {
                        return None;
                    }
                    effort = effort.max(elements as f64 * points);
                    let slopes: Vec<f64> = parent.z.iter().map(|u| theta * node.product * u).collect();
                    let slopes: Vec<[f64; 2]> =
                        slopes.iter().copied().zip(log_sums(own, &slopes)).map(Into::into).collect();
                    let turns: Vec<f64> = parent.z.iter().map(|u| node.product * u).collect();
                    Some(Message::new((&own.z, &own.logs), &slopes, &turns, [from, step]))
                }
            });
        }
        let root = self.nodes.len() - 1;
        if self.nodes[root].closed {
            // The whole tree consists of parabolas of normal inputs.
            let at_theta = self.parabola(root, Complex::from(theta)).constant;
            for (i, out) in out.iter_mut().enumerate() {
                let s = Complex::new(theta, from + step * i as f64);
                *out *= (self.parabola(root, s).constant - at_theta).exp();
            }
            return Some(effort);
        }
        let weights: Vec<f64> = done[root].0.logs.iter().map(|log| Exp::of(log - done[root].1)).collect();
        let real: Vec<Parabola> =
            (0..self.nodes.len()).map(|place| self.closed_below(place, Complex::from(theta))).collect();
        let mut factors: Vec<NodeFactors> = done.iter().map(|(own, _)| NodeFactors::new(own.z.len())).collect();
        let mut sums = NodeFactors::default();
        for (i, out) in out.iter_mut().enumerate() {
            let t = from + step * i as f64;
            let s = Complex::new(theta, t);
            // From the leaves to the root: the own phase of every node and its closed branches, then the messages of its open ones.
            for (place, node) in self.nodes.iter().enumerate().filter(|(_, node)| !node.closed) {
                let own = &done[place].0;
                let mut factor = std::mem::take(&mut factors[place]);
                let closed = node.children.iter().any(|&child| self.nodes[child].closed);
                let below = closed.then(|| self.closed_below(place, s) - real[place]);
                on_this_processor(Phases { z: &own.z, values: &own.values, t, below, out: &mut factor });
                for &child in &node.children {
                    if let Some(message) = &mut messages[child] {
                        message.next(&factors[child], &mut sums);
                        factor.multiply(&sums);
                    }
                }
                factors[place] = factor;
            }
            *out *= factors[root].weighed(&weights);
        }
        Some(effort)
    }
}

/// `log sum exp(logs + slope z)` for each slope.
fn log_sums(tilted: &Tilted, slopes: &[f64]) -> Vec<f64> {
    let sums = on_this_processor(LogSums { z: &tilted.z, logs: &tilted.logs, slopes });
    sums.into_iter().map(|[most, sum]| most + libm::log(sum)).collect()
}
