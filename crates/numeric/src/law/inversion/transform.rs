//! `K(s) = log E exp(s (y - centre))` of a sum of independent components, and the domain in which it exists.

use crate::law::inversion::complex::Complex;
use crate::law::inversion::perturbed_form::PerturbedForm;
use crate::law::inversion::product_tree::Tree;
use crate::law::inversion::quadratic_form::{Block, Forms};
use crate::law::inversion::single_input::Single;
use crate::law::inversion::sinh_transform::{Hat, SinhTransform};
use crate::law::surface::Surface;

/// Greatest tilt that is searched, times sigma.
const FARTHEST: f64 = 2000.0;
/// Least tilt, times sigma, that must exist. Otherwise the tail is too heavy to be tilted.
const LEAST_TILT: f64 = 0.3;

/// Sum of those components of a surface whose transform is known.
#[derive(Debug)]
pub(in crate::law) struct Transform {
    pub(in crate::law) forms: Forms,
    pub(in crate::law) hats: SinhTransform,
    pub(in crate::law) singles: Vec<Single>,
    pub(in crate::law) perturbed: Vec<PerturbedForm>,
    pub(in crate::law) trees: Vec<Tree>,
    /// Mean about the centre of the surface. All values here are counted from that centre.
    pub(in crate::law) mean: f64,
    pub(in crate::law) sigma: f64,
    /// Lowest and highest real part of `s`; infinite if no bound was found.
    pub(in crate::law) domain: [f64; 2],
    /// Value about which the contour cannot be bent, because the density of a quadratic form has a corner there; None if it has none.
    pub(in crate::law) vertex: Option<f64>,
}

/// Component of a known kind.
enum Kind {
    Form(Block),
    Hat(Hat),
    Single(Single),
    Perturbed(PerturbedForm),
    Tree(Tree),
}

impl Kind {
    fn of(surface: &Surface, members: &[usize]) -> Option<Self> {
        if members.iter().all(|&j| surface.is_normal_parabola(j)) {
            return Some(Self::Form(Block::of(surface, members)?));
        }
        if let [j] = *members {
            let law = std::sync::Arc::clone(&surface.inputs[j]);
            if let Some(hat) = Hat::of(j, &law, &surface.parts[j]) {
                return Some(Self::Hat(hat));
            }
            return Some(Self::Single(Single::new(j, law, surface.parts[j])));
        }
        PerturbedForm::of(surface, members).map(Self::Perturbed).or_else(|| Tree::of(surface, members).map(Self::Tree))
    }
}

impl Transform {
    /// Transform of a surface's components, and the components outside it. Those are neither tree nor form, have too heavy a tail, or are
    /// of a kind that `summed` excludes.
    pub(in crate::law) fn of(surface: &Surface, components: &[Vec<usize>], summed: Summed) -> (Self, Vec<Vec<usize>>) {
        let mut transform = Self {
            forms: Forms::default(),
            hats: SinhTransform::default(),
            singles: Vec::new(),
            perturbed: Vec::new(),
            trees: Vec::new(),
            mean: 0.0,
            sigma: 0.0,
            domain: [f64::NEG_INFINITY, f64::INFINITY],
            vertex: None,
        };
        let mut left = Vec::new();
        for members in components {
            match Kind::of(surface, members) {
                Some(Kind::Form(block)) => transform.forms.push(block),
                Some(Kind::Hat(hat)) => transform.hats.push(hat),
                Some(Kind::Single(single)) => transform.singles.push(single),
                Some(Kind::Perturbed(form)) if summed >= Summed::Perturbed => transform.perturbed.push(form),
                Some(Kind::Tree(tree)) if summed >= Summed::Trees => transform.trees.push(tree),
                Some(Kind::Perturbed(_) | Kind::Tree(_)) | None => left.push(members.clone()),
            }
        }
        transform.measure();
        left.extend(transform.without_heavy_components(surface, summed));
        if !left.is_empty() {
            left.sort();
            transform.measure();
        }
        transform.domain = transform.reach();
        transform.vertex = transform.corner();
        (transform, left)
    }

    /// Removes the components whose own tail is too heavy for a tilt of the whole. A perturbed form without such a tilt may still be a
    /// tree.
    fn without_heavy_components(&mut self, surface: &Surface, summed: Summed) -> Vec<Vec<usize>> {
        let least = LEAST_TILT / self.sigma;
        let mut left: Vec<Vec<usize>> = Vec::new();
        let bears = |single: &Single| single.bears(least, least) && single.bears(-least, least);
        let heavy: Vec<usize> = self.singles.iter().filter(|single| !bears(single)).map(|s| s.input).collect();
        self.singles.retain(|single| !heavy.contains(&single.input));
        left.extend(heavy.iter().map(|&input| vec![input]));
        for form in std::mem::take(&mut self.perturbed) {
            match form.bears(least) && form.bears(-least) {
                true => self.perturbed.push(form),
                false => match Tree::of(surface, &form.members).filter(|_| summed >= Summed::Trees) {
                    Some(tree) => self.trees.push(tree),
                    None => left.push(form.members.clone()),
                },
            }
        }
        let tall = |tree: &Tree| !(tree.bears(least, least) && tree.bears(-least, least));
        let heavy: Vec<Vec<usize>> = self.trees.iter().filter(|tree| tall(tree)).map(Tree::sorted).collect();
        self.trees.retain(|tree| !heavy.contains(&tree.sorted()));
        left.extend(heavy);
        left
    }

    /// Vertex of quadratic forms, with or without higher powers. Returns None if there are other components.
    fn corner(&self) -> Option<f64> {
        if !self.is_perturbed() {
            return None;
        }
        let parabolas: Vec<[f64; 2]> = self.perturbed.iter().flat_map(PerturbedForm::parabolas).collect();
        self.forms.vertex(&parabolas)
    }

    /// True if there is no component.
    pub(in crate::law) fn is_empty(&self) -> bool {
        self.forms.blocks.is_empty() && self.hats.is_empty() && self.is_closed()
    }

    /// True if all components are quadratic forms of normal inputs.
    pub(in crate::law) fn is_form(&self) -> bool {
        self.hats.is_empty() && self.is_closed()
    }

    /// True if no component is summed over nodes.
    pub(in crate::law) fn is_closed(&self) -> bool {
        self.singles.is_empty() && self.are_sums_closed()
    }

    /// True if there are closed forms and atoms only, so that a contour may have many points.
    pub(in crate::law) fn is_cheap(&self) -> bool {
        self.are_sums_closed() && self.singles.iter().all(Single::is_discrete)
    }

    /// True if there are only quadratic forms, with or without higher powers.
    pub(in crate::law) fn is_perturbed(&self) -> bool {
        self.hats.is_empty() && self.singles.is_empty() && self.trees.is_empty()
    }

    /// True if no component combines products and curved parts, which only a sum over nodes resolves. Otherwise a contour may end early.
    pub(in crate::law) fn are_sums_closed(&self) -> bool {
        self.trees.is_empty() && self.perturbed.is_empty()
    }

    /// Computes mean and sigma.
    fn measure(&mut self) {
        let (mut mean, mut variance) = (self.forms.mean(), self.forms.variance() + self.hats.variance());
        for single in &self.singles {
            let [own, spread] = single.moments();
            (mean, variance) = (mean + own, variance + spread);
        }
        let moments = self.perturbed.iter().map(PerturbedForm::moments).chain(self.trees.iter().map(Tree::moments));
        for [own, spread] in moments {
            (mean, variance) = (mean + own, variance + spread);
        }
        (self.mean, self.sigma) = (mean, variance.sqrt());
    }

    /// Domain of the transform. For forms it is a closed form. For other components it ends before a cut end of an unbounded input has
    /// weight.
    fn reach(&self) -> [f64; 2] {
        /// Factor from one tilt of the search to the next.
        const GROWTH: f64 = 1.25;
        /// First tilt of the search, times sigma.
        const FIRST: f64 = 0.02;
        let [low, high] = self.forms.domain();
        if self.is_closed() {
            return [low, high];
        }
        let at_mean = 1.0 / self.sigma;
        let bears = |theta: f64| {
            self.singles.iter().all(|single| single.bears(theta, at_mean))
                && self.perturbed.iter().all(|form| form.bears(theta))
                && self.trees.iter().all(|tree| tree.bears(theta, at_mean))
        };
        let tilts: Vec<f64> = std::iter::successors(Some(FIRST), |t| (*t < FARTHEST).then_some(t * GROWTH)).collect();
        let far = |sign: f64| {
            let borne = leading(tilts.len() - 1, |place| bears(sign * tilts[place + 1] / self.sigma));
            if tilts[borne] >= FARTHEST { f64::INFINITY } else { tilts[borne] / self.sigma }
        };
        [low.max(-far(-1.0)), high.min(far(1.0))]
    }

    /// `[K, K', K'']` at a real `theta` within the domain. The derivatives of trees and perturbed forms are differences, which are accurate
    /// enough to choose a contour.
    pub(in crate::law) fn cumulants(&self, theta: f64) -> [f64; 3] {
        let (forms, hats) = (self.forms.cumulants(theta), self.hats.cumulants(theta));
        let [mut k, mut k1, mut k2] = std::array::from_fn(|order| forms[order] + hats[order]);
        for single in &self.singles {
            let [own, first, second] = single.cumulants(theta);
            (k, k1, k2) = (k + own, k1 + first, k2 + second);
        }
        let step = 1e-3 / self.sigma;
        let mut add = |log: &dyn Fn(f64) -> f64| {
            let [below, at, above] = [theta - step, theta, theta + step].map(log);
            (k, k1) = (k + at, k1 + (above - below) / (2.0 * step));
            k2 += (above - 2.0 * at + below) / (step * step);
        };
        self.perturbed.iter().for_each(|form| add(&|theta| form.log(theta)));
        self.trees.iter().for_each(|tree| add(&|theta| tree.log(theta)));
        [k, k1, k2]
    }

    /// `K(theta)` of every single input.
    pub(in crate::law) fn logs(&self, theta: f64) -> Vec<f64> {
        self.singles.iter().map(|single| single.cumulants(theta)[0]).collect()
    }

    /// Writes `M(s)/M(theta)` at the points `s = theta + i t` of a block. Returns the number of resolved points, counted from the first.
    pub(in crate::law) fn ratios(&self, theta: f64, logs: &[f64], from: f64, step: f64, out: &mut [Complex]) -> usize {
        let at_theta = self.forms.log(Complex::from(theta)).re;
        let points: Vec<Complex> = (0..out.len()).map(|i| Complex::new(theta, from + step * i as f64)).collect();
        for (&s, out) in points.iter().zip(out.iter_mut()) {
            *out = (self.forms.log(s) - Complex::from(at_theta)).exp() * self.hats.ratio(theta, s.im);
        }
        for (single, &log) in self.singles.iter().zip(logs) {
            single.multiply(theta, log, from, step, out);
        }
        let forms =
            self.perturbed.iter().fold(out.len(), |resolved, form| resolved.min(form.multiply(theta, &points, out)));
        self.trees.iter().fold(forms, |resolved, tree| resolved.min(tree.multiply(theta, from, step, out)))
    }

    /// `K(s) - K(theta)` at the resolved points of a bent contour, counted from the first. No component may be a single input or a tree.
    pub(in crate::law) fn bent_logs(&self, theta: f64, points: &[Complex]) -> Vec<Complex> {
        let at_theta = self.forms.log(Complex::from(theta));
        let mut logs: Vec<Complex> = points.iter().map(|&s| self.forms.log(s) - at_theta).collect();
        for form in &self.perturbed {
            let more = form.logs(theta, points);
            logs.truncate(more.len());
            logs.iter_mut().zip(more).for_each(|(log, more)| *log += more);
        }
        logs
    }
}

/// Number of the first places at which a condition holds, of those before `count`. From some place on it must not hold.
///
/// Cost: about twice the binary logarithm of the result.
fn leading(count: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, count);
    // Double the number as long as the condition holds, then halve the interval.
    while low < high {
        let next = (2 * low + 1).min(high);
        if !holds(next - 1) {
            high = next - 1;
            break;
        }
        low = next;
    }
    while low < high {
        let middle = (low + high).div_ceil(2);
        if holds(middle - 1) { low = middle } else { high = middle - 1 }
    }
    low
}

/// Kinds of components that may be summed over nodes, in addition to closed forms. Each includes the ones before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::law) enum Summed {
    /// Single inputs only.
    Singles,
    /// Quadratic forms with higher powers.
    Perturbed,
    /// Trees of products.
    Trees,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every number of leading places up to 60 is found as by trying one place after the other, in at most two binary logarithms.
    #[test]
    fn leading_places_are_counted() {
        for count in 0..60 {
            for end in 0..=count {
                let tried = std::cell::Cell::new(0);
                let holds = |place: usize| {
                    tried.set(tried.get() + 1);
                    place < end
                };
                assert_eq!(leading(count, holds), end, "{count} {end}");
                assert!(tried.get() <= 12, "{count} {end}: {}", tried.get());
            }
        }
    }
}
