//! Derivatives of a tail by the tolerances, from the same contour, panels or points as the tail itself.
//!
//! If a tolerance grows by the fraction `e` at fixed shape, `z_j` becomes `(1 + e) z_j`. The surface then changes by `e z_j dy/dz_j`, and
//! `dK = s E[z_j dy/dz_j exp(s y)]/E[exp(s y)]`.

use faer::Mat;

use crate::elementary::{Work, on_this_processor};
use crate::law::inversion::complex::Complex;
use crate::law::inversion::contour::Contour;
use crate::law::inversion::perturbed_form::PerturbedForm;
use crate::law::inversion::product_tree::Tree;
use crate::law::inversion::quadratic_form::Block;
use crate::law::inversion::single_input::BLOCK;
use crate::law::inversion::tail_inversion::Inversion;
use crate::law::polynomial::{derivative, value};
use crate::law::surface::Surface;
use crate::law::{Kind, LawFigure, LawTail, SurfaceLaw};

/// Derivatives by all inputs of the surrogate, 0 for one without a part in the surface. Returns None if the law is a step function.
pub(super) fn tail_derivatives(law: &SurfaceLaw, y: f64, tail: LawTail) -> Option<Vec<LawFigure>> {
    let [least, most] = law.range;
    if y.is_nan() || law.step {
        return None;
    }
    let nothing = LawFigure::new(0.0, 0.0);
    let own: Vec<LawFigure> = match &law.kind {
        _ if y <= least || y >= most => vec![nothing; law.surface.len()],
        Kind::Point(_) | Kind::Steps(_) => return None,
        Kind::Exact(exact) => exact_derivatives(&exact.inversion, &law.surface, y, tail),
        Kind::Single(single) => single.derivatives(y, tail),
        Kind::Sampled(sampled) => sampled.derivatives(y, tail, law.mean),
    };
    let mut all: Vec<LawFigure> =
        law.surface.places.iter().map(|place| place.map_or(nothing, |place| own[place])).collect();
    law.zones.iter().for_each(|zone| zone.distribute(&mut all));
    Some(all)
}

/// Derivatives of a tail of an inverted law by all inputs of the surface, 0 for inputs outside its transform.
pub(super) fn exact_derivatives(law: &Inversion, surface: &Surface, y: f64, tail: LawTail) -> Vec<LawFigure> {
    law.derivatives(y, tail, |contour, count| {
        let mut changes = vec![vec![Complex::ZERO; count]; surface.len()];
        let transform = &law.transform;
        // Uniform variables and quadratic forms have closed derivatives, single inputs take quadrature, the rest takes differences.
        for hat in &transform.hats.inputs {
            for (at, change) in changes[hat.input].iter_mut().enumerate() {
                let s = contour.s(at);
                *change = hat.halves.iter().fold(Complex::ZERO, |sum, &a| sum + x_coth_x_less_one(s * a));
            }
        }
        for block in &transform.forms.blocks {
            of_block(block, contour, &mut changes);
        }
        for single in &transform.singles {
            let slope = derivative(&surface.parts[single.input]);
            for first in (0..count).step_by(BLOCK) {
                let last = count.min(first + BLOCK);
                let top = contour.s(last).abs();
                let tilted = single.tilted(contour.theta, top);
                for (at, change) in changes[single.input].iter_mut().enumerate().take(last).skip(first) {
                    let s = contour.s(at);
                    let (mut mass, mut moved) = (Complex::ZERO, Complex::ZERO);
                    for ((z, g), w) in tilted.z.iter().zip(&tilted.values).zip(&tilted.weights) {
                        let weight = Complex::cis(s.im * g) * *w;
                        mass += weight;
                        moved += weight * (z * value(&slope, *z));
                    }
                    *change = s * moved / mass;
                }
            }
        }
        for form in &transform.perturbed {
            let ratios =
                |surface: &Surface| Some(form_ratios(&PerturbedForm::of(surface, &form.members)?, contour, count));
            by_differences(&form.members, surface, ratios, &mut changes);
        }
        for tree in &transform.trees {
            let members = tree.sorted();
            let ratios = |surface: &Surface| Some(tree_ratios(&Tree::of(surface, &members)?, contour, count));
            by_differences(&members, surface, ratios, &mut changes);
        }
        changes
    })
}

/// `x coth x - 1`, the derivative of `log(sinh x/x)` by the logarithm of `x`. The real part of `x` must not be 0.
fn x_coth_x_less_one(x: Complex) -> Complex {
    if x.square() < 0.04 {
        let square = x * x;
        // x^2/3 - x^4/45 + 2 x^6/945 - x^8/4725 + 2 x^10/93555 - 1382 x^12/638512875
        let coefficients = [1.0 / 3.0, -1.0 / 45.0, 2.0 / 945.0, -1.0 / 4725.0, 2.0 / 93555.0, -1382.0 / 638_512_875.0];
        return coefficients.iter().rev().fold(Complex::ZERO, |sum, &c| (sum + Complex::from(c)) * square);
    }
    // The function is even in x: with a real part that is not negative the exponential falls.
    let x = if x.re < 0.0 { -x } else { x };
    let small = (-(x * 2.0)).exp();
    x * (Complex::ONE + small) / (Complex::ONE - small) - Complex::ONE
}

/// Adds `s (b_j mu_j + 2 (mu_j (H mu)_j + (Sigma H)_jj))`, with the tilted mean `mu` and covariance `Sigma` of the form.
fn of_block(block: &Block, contour: &Contour, changes: &mut [Vec<Complex>]) {
    let count = changes.first().map_or(0, Vec::len);
    let images = block.images();
    for first in (0..count).step_by(LANES) {
        on_this_processor(BlockChanges { block, images: images.as_ref(), contour, first, changes });
    }
}

/// Points of a contour that are computed side by side.
const LANES: usize = 16;

/// Work item: the changes of one form at `LANES` points of the contour.
struct BlockChanges<'a> {
    block: &'a Block,
    images: Option<&'a Mat<f64>>,
    contour: &'a Contour,
    first: usize,
    changes: &'a mut [Vec<Complex>],
}

impl Work for BlockChanges<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { block, images, contour, first, changes } = self;
        let m = block.members.len();
        let count = changes.first().map_or(0, Vec::len).min(first + LANES) - first;
        let axis = |j: usize, i: usize| block.axes.as_ref().map_or(1.0, |axes| axes[(j, i)]);
        let image = |j: usize, i: usize| images.map_or(block.curvatures[0], |images| images[(j, i)]);
        let s: [Complex; LANES] = std::array::from_fn(|lane| contour.s(first + lane));
        // Tilted mean and variance of every axis at all points.
        let tilted = |(a, slope): (&f64, &f64)| -> [[Complex; LANES]; 2] {
            let inverse = s.map(|s| Complex::ONE / (Complex::ONE - s * (2.0 * a)));
            [std::array::from_fn(|lane| s[lane] * inverse[lane] * *slope), inverse]
        };
        let tilted: Vec<[[Complex; LANES]; 2]> = block.curvatures.iter().zip(&block.slopes).map(tilted).collect();
        for (j, &member) in block.members.iter().enumerate() {
            let [mut mu, mut moved, mut spread] = [[Complex::ZERO; LANES]; 3];
            for (i, [mean, inverse]) in tilted.iter().enumerate().take(m) {
                let (axis, image) = (axis(j, i), image(j, i));
                let both = axis * image;
                for lane in 0..LANES {
                    mu[lane] += mean[lane] * axis;
                    moved[lane] += mean[lane] * image;
                    spread[lane] += inverse[lane] * both;
                }
            }
            for lane in 0..count {
                changes[member][first + lane] =
                    s[lane] * (mu[lane] * block.linear[j] + (mu[lane] * moved[lane] + spread[lane]) * 2.0);
            }
        }
    }
}

/// Transform of a component along a contour divided by its value at the tilt, and the logarithm of that value.
type Ratios = (Vec<Complex>, f64);

fn tree_ratios(tree: &Tree, contour: &Contour, count: usize) -> Ratios {
    let mut all = vec![Complex::ONE; count];
    for (block, out) in all.chunks_mut(BLOCK).enumerate() {
        let from = contour.step * (block * BLOCK) as f64;
        let resolved = tree.multiply(contour.theta, from, contour.step, out);
        out[resolved..].fill(Complex::new(f64::NAN, 0.0));
    }
    (all, tree.log(contour.theta))
}

fn form_ratios(form: &PerturbedForm, contour: &Contour, count: usize) -> Ratios {
    let points: Vec<Complex> = (0..count).map(|index| contour.s(index)).collect();
    let mut all: Vec<Complex> = form.logs(contour.theta, &points).iter().map(|log| log.exp()).collect();
    all.resize(count, Complex::new(f64::NAN, 0.0));
    (all, form.log(contour.theta))
}

/// Changes of the transform of a component by central differences along the same contour, with a relative error of 1e-8.
fn by_differences(
    members: &[usize],
    surface: &Surface,
    ratios: impl Fn(&Surface) -> Option<Ratios>,
    changes: &mut [Vec<Complex>],
) {
    /// Relative step of the difference quotient: its error is some 1e-8 of the derivative.
    const PART: f64 = 1e-4;
    let Some((own, _)) = ratios(surface) else { return };
    for &j in members {
        let scaled = |by: f64| ratios(&surface.scaled(j, by));
        let (Some((more, log_more)), Some((less, log_less))) = (scaled(1.0 + PART), scaled(1.0 - PART)) else {
            continue;
        };
        let level = (log_more - log_less) / (2.0 * PART);
        for (at, change) in changes[j].iter_mut().enumerate() {
            let turn = (more[at] - less[at]) * (0.5 / PART) / own[at];
            // A change counts as 0 where the transform has vanished or is not resolved.
            *change = if turn.is_finite() { turn + Complex::from(level) } else { Complex::ZERO };
        }
    }
}
