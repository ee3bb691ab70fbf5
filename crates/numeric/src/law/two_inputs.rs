//! Surfaces of one or two inputs: Gauss panels in one input, roots and the distribution function of the other.

use crate::law::direction::{Direction, Terms};
use crate::law::input::Input;
use crate::law::panels::{EXACT, NEARLY, expectation};
use crate::law::polynomial::{MonotonePieces, Quartic, range, roots, value};
use crate::law::sampled_law::pathwise;
use crate::law::{LawFigure, LawTail};

/// Relative accuracy of the distribution functions of the inputs.
const RELATIVE: f64 = 2e-12;

/// Surface with at most one coordinate left after a direction has been integrated.
#[derive(Debug)]
pub(super) struct Single {
    direction: Direction,
    outer: Option<usize>,
    /// Inner input, if neither it nor the outer one is a mixture. `product` is the coefficient of their product.
    apart: Option<usize>,
    product: f64,
}

impl Single {
    /// Surface along this direction. Returns None if more than one coordinate is left, or if there is no direction.
    pub(super) fn of(direction: Direction) -> Option<Self> {
        let rest = direction.rest();
        direction.input()?;
        let outer = match rest[..] {
            [] => None,
            [outer] => Some(outer),
            _ => return None,
        };
        let apart = direction.own().filter(|_| direction.surface().correlated.is_none() && !direction.is_mixed());
        let product = apart.zip(outer).map_or(0.0, |(own, outer)| direction.surface().product(own, outer));
        Some(Self { direction, outer, apart, product })
    }

    pub(super) fn tail(&self, y: f64, tail: LawTail) -> LawFigure {
        self.figure(y, EXACT, |input, polynomial| input.beyond(polynomial, tail)).clamped()
    }

    /// Tail with the accuracy that a quantile needs, at a small part of the cost.
    pub(super) fn tail_nearly(&self, y: f64, tail: LawTail) -> LawFigure {
        self.figure(y, NEARLY, |input, polynomial| input.beyond(polynomial, tail)).clamped()
    }

    /// Derivatives of a tail by the logarithms of the tolerances of the inputs.
    pub(super) fn derivatives(&self, y: f64, tail: LawTail) -> Vec<LawFigure> {
        let surface = self.direction.surface();
        let n = surface.len();
        let terms = self.direction.terms(surface);
        let Some(inner) = self.direction.input() else { return Vec::new() };
        let at = |z: Option<(usize, f64)>, j: usize| {
            let (mut v, mut sums) = (vec![0.0; n], vec![0.0; n]);
            if let Some((outer, z)) = z {
                v[outer] = z;
            }
            self.direction.mix(&mut v, &mut Vec::new());
            let polynomial = self.direction.along(&v, &terms);
            let off = y - surface.centre;
            pathwise(surface, &self.direction, inner, &v, polynomial, off, tail.sign(), &mut sums);
            sums[j]
        };
        let of = |j: usize| match self.outer {
            None => LawFigure::new(at(None, j), RELATIVE * at(None, j).abs()),
            Some(outer) => {
                let found =
                    expectation(&surface.inputs[outer], &self.splits(y, outer), EXACT, |z| at(Some((outer, z)), j));
                LawFigure::new(found.value, found.error + RELATIVE * found.value.abs())
            }
        };
        (0..n).map(of).collect()
    }

    pub(super) fn density(&self, y: f64) -> LawFigure {
        self.figure(y, EXACT, |input, polynomial| {
            input.density_of(&MonotonePieces::of(polynomial, input.ends), polynomial)
        })
    }

    /// Surface minus a limit, as a polynomial along the direction.
    fn along(&self, terms: &Terms, outer: Option<(usize, f64)>, off: f64) -> Quartic {
        if let (Some((place, z)), Some(own)) = (outer, self.apart) {
            let surface = self.direction.surface();
            let mut polynomial = surface.parts[own];
            polynomial[0] = off + value(&surface.parts[place], z);
            polynomial[1] += self.product * z;
            return polynomial;
        }
        let mut v = vec![0.0; self.direction.surface().len()];
        if let Some((place, z)) = outer {
            v[place] = z;
        }
        self.direction.mix(&mut v, &mut Vec::new());
        let mut polynomial = self.direction.along(&v, terms);
        polynomial[0] += off;
        polynomial
    }

    /// Values of the outer input at which the integrand is not smooth.
    fn splits(&self, y: f64, outer: usize) -> Vec<f64> {
        let Some(inner) = self.direction.input() else { return Vec::new() };
        let surface = self.direction.surface();
        let (off, law) = (surface.centre - y, &surface.inputs[outer]);
        let terms = self.direction.terms(surface);
        let mut splits = Vec::new();
        // Values at which the limit crosses an end or a corner of the inner distribution.
        if let Some(own) = self.direction.own().filter(|_| !inner.is_normal()) {
            for at in inner.breaks() {
                let mut part = surface.parts[outer];
                part[0] = off + value(&surface.parts[own], at);
                part[1] += surface.product(own, outer) * at;
                splits.extend_from_slice(roots(&part, law.ends).as_slice());
            }
        }
        for tail in [LawTail::Lower, LawTail::Upper] {
            // Values between which the limit separates no part or all of the inner distribution. The test takes the farthest value that the
            // inner input gives.
            let reach = |z: f64| match (tail, range(&self.along(&terms, Some((outer, z)), off), inner.ends)) {
                (LawTail::Lower, [least, _]) => -least,
                (LawTail::Upper, [_, most]) => most,
            };
            splits.extend(crossings(law, reach));
        }
        splits
    }

    /// Expectation over the outer input of a figure `f` of the inner one.
    fn figure(&self, y: f64, tolerance: f64, f: impl Fn(&Input, &Quartic) -> f64) -> LawFigure {
        let Some(inner) = self.direction.input() else { return LawFigure::new(f64::NAN, f64::INFINITY) };
        let surface = self.direction.surface();
        let (off, terms) = (surface.centre - y, self.direction.terms(surface));
        let Some(outer) = self.outer else {
            let value = f(inner, &self.along(&terms, None, off));
            return LawFigure::new(value, RELATIVE * value);
        };
        let integrand = |z: f64| f(inner, &self.along(&terms, Some((outer, z)), off));
        // At reduced accuracy, halving finds the points that are not smooth by itself.
        let splits = if tolerance == EXACT { self.splits(y, outer) } else { Vec::new() };
        let found = expectation(&surface.inputs[outer], &splits, tolerance, integrand);
        LawFigure::new(found.value, found.error + RELATIVE * found.value)
    }
}

/// Arguments at which a function of the outer input crosses 0, also those next to an extreme that barely exceeds it.
fn crossings(law: &Input, f: impl Fn(f64) -> f64) -> Vec<f64> {
    /// Intervals of a grid between whose points a function is taken to have at most one extreme.
    const GRID: usize = 96;
    /// Number of halvings, which locate a crossing to the last digit.
    const HALVINGS: usize = 60;
    let [low, high] = law.ends;
    let place = |i: usize| low + (high - low) * i as f64 / GRID as f64;
    let mut known: Vec<(f64, f64)> = (0..=GRID).map(|i| (place(i), f(place(i)))).collect();
    let mut extremes = Vec::new();
    for three in known.windows(3) {
        let [(a, at_a), (_, at_b), (c, at_c)] = [three[0], three[1], three[2]];
        // A local maximum on the grid that stays below 0 may exceed 0 between grid points.
        if at_b <= 0.0 && at_b >= at_a && at_b >= at_c {
            extremes.push(largest(&f, a, c));
        }
    }
    known.extend(extremes.into_iter().map(|z| (z, f(z))));
    known.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut found = Vec::new();
    for pair in known.windows(2) {
        let ((mut a, at_a), (mut b, at_b)) = (pair[0], pair[1]);
        if (at_a > 0.0) == (at_b > 0.0) {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (a + b);
            if (f(middle) > 0.0) == (at_a > 0.0) { a = middle } else { b = middle }
        }
        found.push(0.5 * (a + b));
    }
    found
}

/// Maximum point of a function with one extreme in an interval, by golden section search.
fn largest(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    /// Golden section.
    const SECTION: f64 = 0.618_033_988_749_894_8;
    for _ in 0..60 {
        let (a, b) = (high - SECTION * (high - low), low + SECTION * (high - low));
        if f(a) >= f(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}
