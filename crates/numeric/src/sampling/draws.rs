//! Blocks of points of the inputs' joint distribution.

use std::fmt;

use std::str::FromStr;

use faer::Mat;
use serde::Serialize;

use crate::correlation::{Block, Correlation, JointLaw};
use crate::dimension::Dimension;
use crate::distribution::{Probability, behind_normal, standard_normal, ziggurat};
use crate::elementary::{Work, on_this_processor};
use crate::names::UnknownName;
use crate::points::Points;
use crate::sampling::joe_kuo::SOBOL_DIMENSIONS;
use crate::sampling::sobol::{Sobol, mixed, scrambled};
use crate::sampling::stream::Stream;

/// Method that draws points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Sampler {
    /// Independent random points.
    Random,
    /// Sobol' points, scrambled anew in every replicate.
    Sobol,
}

impl Sampler {
    /// Name of the simulation method with this sampler.
    pub fn method(self) -> &'static str {
        match self {
            Self::Random => "monte-carlo",
            Self::Sobol => "quasi-monte-carlo",
        }
    }

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Sobol => "sobol",
        }
    }
}

impl fmt::Display for Sampler {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Sampler {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        UnknownName::find("sampler", name, &[Self::Random, Self::Sobol], |sampler| sampler.name())
    }
}

/// Reason why a problem cannot be sampled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SamplingError {
    /// The distribution of a dimension is unknown.
    #[error(
        "dimension `{dimension}` is known by its moments only, which cannot be sampled: give it a distribution, or use a \
         derivative method"
    )]
    MomentsOnly {
        /// Name of the dimension.
        dimension: String,
    },
    /// A dimension may have any distribution within its band.
    #[error(
        "dimension `{dimension}` may have any distribution within its band, and only an analysis bounds the yield over all of \
         them: give it a distribution such as \"normal\" or \"uniform\""
    )]
    AnyDistribution {
        /// Name of the dimension.
        dimension: String,
    },
    /// More dimensions vary than there are direction numbers for.
    #[error("{dimensions} dimensions vary, and there are Sobol' points for {SOBOL_DIMENSIONS}: use random ones")]
    TooManyDimensions {
        /// Number of dimensions that vary.
        dimensions: usize,
    },
}

/// Checks that every dimension has a distribution of its own.
///
/// # Errors
/// Returns an error if a dimension may have any distribution within its band: a sample of the one that stands in for it answers nothing.
pub fn all_known(dimensions: &[Dimension]) -> Result<(), SamplingError> {
    match dimensions.iter().find(|dimension| dimension.convention().promise.is_some()) {
        Some(dimension) => Err(SamplingError::AnyDistribution { dimension: dimension.name().to_owned() }),
        None => Ok(()),
    }
}

/// Range of points: replicate, first point, number of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Portion {
    /// Replicate: always one for random points, and one for each scrambling of Sobol' points.
    pub replicate: u64,
    /// First point: a multiple of the portion's size, or of the next power of two above it.
    pub first: u64,
    /// Number of points.
    pub rows: usize,
}

/// Source of points. Every portion can be drawn at any time, independently of the others, and is always the same.
///
/// Every dimension has its own stream, so that leaving one out does not change the others. Every portion has its own seed, so that points
/// do not depend on the number of threads.
pub struct Draws<'a> {
    dimensions: &'a [Dimension],
    varying: Vec<(usize, &'a dyn Probability)>,
    correlated: Option<Correlated<'a>>,
    sobol: Option<Sobol>,
    seed: u64,
}

/// Buffers for drawing portions one after the other.
#[derive(Default)]
pub struct Room {
    stream: Stream,
    digits: Vec<u64>,
    /// Columns of normal variables of the correlated dimensions.
    normals: Vec<Vec<f64>>,
}

/// Correlated dimensions: their indices among the varying ones, and the factor of their normal variables.
struct Correlated<'a> {
    correlation: &'a Correlation,
    /// Indices among the varying dimensions, ascending like the members.
    places: Vec<usize>,
    factor: Mat<f64>,
}

impl<'a> Draws<'a> {
    /// Source of points of these dimensions.
    ///
    /// # Errors
    /// Returns an error if a dimension is known by moments only, or if too many vary for Sobol' points.
    pub fn new(
        dimensions: &'a [Dimension],
        correlation: Option<&'a Correlation>,
        sampler: Sampler,
        seed: u64,
    ) -> Result<Self, SamplingError> {
        let mut varying = Vec::new();
        for (d, dimension) in dimensions.iter().enumerate() {
            if let Some(distribution) = dimension.distribution() {
                let unknown = || SamplingError::MomentsOnly { dimension: dimension.name().to_owned() };
                varying.push((d, distribution.probability().ok_or_else(unknown)?));
            }
        }
        let sobol = match sampler {
            Sampler::Random => None,
            Sampler::Sobol => {
                let too_many = SamplingError::TooManyDimensions { dimensions: varying.len() };
                Some(Sobol::new(varying.len()).ok_or(too_many)?)
            }
        };
        let correlated = correlation.map(|correlation| Correlated {
            places: (correlation.members().iter())
                .map(|d| varying.iter().position(|(other, _)| other == d).expect("a correlated dimension varies"))
                .collect(),
            factor: correlation.factor(),
            correlation,
        });
        Ok(Self { dimensions, varying, correlated, sobol, seed })
    }

    /// Points of a portion. Dimensions that do not vary have their nominal value.
    pub fn points(&self, portion: Portion) -> Points {
        let mut points = Points::repeated(&[], 0);
        self.write(portion, &mut Room::default(), &mut points);
        points
    }

    /// Writes the points of a portion over other points.
    pub fn write(&self, portion: Portion, room: &mut Room, points: &mut Points) {
        points.resize(portion.rows, self.dimensions.len());
        for (d, dimension) in self.dimensions.iter().enumerate().filter(|(_, one)| one.distribution().is_none()) {
            points.column_mut(d).fill(dimension.nominal());
        }
        for (place, &(d, law)) in self.varying.iter().enumerate().filter(|(place, _)| !self.is_correlated(*place)) {
            let column = points.column_mut(d);
            match &self.sobol {
                None => law.fill(self.generator(portion, place, &mut room.stream), column),
                Some(sobol) => {
                    self.tails(sobol, portion, place, &mut room.digits, column);
                    law.quantiles(column);
                }
            }
        }
        if let Some(correlated) = &self.correlated {
            self.together(correlated, portion, room, points);
        }
    }

    fn is_correlated(&self, place: usize) -> bool {
        self.correlated.as_ref().is_some_and(|correlated| correlated.places.binary_search(&place).is_ok())
    }

    /// Key of a dimension in a stream, derived from the seed.
    fn key(&self, stream: u64, place: usize) -> u64 {
        mixed(mixed(mixed(self.seed).wrapping_add(stream)).wrapping_add(place as u64))
    }

    /// Generator of a dimension, started for a portion.
    fn generator<'s>(&self, portion: Portion, place: usize, stream: &'s mut Stream) -> &'s mut Stream {
        stream.begin(self.key(mixed(portion.replicate) ^ portion.first, place));
        stream
    }

    /// Scrambled Sobol' points of a dimension as probabilities, counted from the nearer end.
    fn tails(&self, sobol: &Sobol, portion: Portion, place: usize, digits: &mut Vec<u64>, out: &mut [f64]) {
        digits.resize(portion.rows, 0);
        sobol.digits(place, portion.first, digits);
        tails(digits, self.key(portion.replicate, place), out);
    }

    /// Writes the correlated dimensions: draws normal variables, correlates them, and turns them into inputs.
    fn together(&self, correlated: &Correlated<'_>, portion: Portion, room: &mut Room, points: &mut Points) {
        let Room { stream, digits, normals } = room;
        normals.resize_with(correlated.places.len(), Vec::new);
        for (normals, &place) in normals.iter_mut().zip(&correlated.places) {
            normals.resize(portion.rows, 0.0);
            match &self.sobol {
                None => ziggurat::normals(self.generator(portion, place, stream), ziggurat::STANDARD, normals),
                Some(sobol) => {
                    self.tails(sobol, portion, place, digits, normals);
                    standard_normal::quantiles(normals);
                }
            }
        }
        let correlation = correlated.correlation;
        let members = correlation.members();
        // Blocks with one joint distribution are applied first, point by point.
        for block in correlation.blocks() {
            let places: Vec<usize> =
                block.members.iter().map(|d| members.binary_search(d).expect("a block's member")).collect();
            let own = Block { members: (0..places.len()).collect(), law: block.law.clone() };
            let (mut at, mut scratch) = (vec![0.0; places.len()], Vec::new());
            let rows = matches!(own.law, JointLaw::Rows(_));
            #[expect(clippy::needless_range_loop, reason = "a point is a row over several columns")]
            for row in 0..portion.rows {
                at.iter_mut().zip(&places).for_each(|(z, &place)| *z = normals[place][row]);
                match rows {
                    true => own.apply(&mut at, &mut scratch),
                    false => own.apply_standardised(&mut at, &mut scratch),
                }
                at.iter().zip(&places).for_each(|(z, &place)| normals[place][row] = *z);
            }
        }
        for (j, (&place, transform)) in correlated.places.iter().zip(correlation.transforms()).enumerate() {
            // Points of a zone are already standardised coordinates.
            let in_zone = correlation
                .block_of(members[j])
                .is_some_and(|(block, _)| !matches!(correlation.blocks()[block].law, JointLaw::Rows(_)));
            let (d, law) = self.varying[place];
            let (mean, sigma) = (self.dimensions[d].mean(), self.dimensions[d].sigma());
            let column = points.column_mut(d);
            let terms = normals.iter().enumerate().map(|(k, normals)| (correlated.factor[(j, k)], &normals[..]));
            let terms: Vec<(f64, &[f64])> = terms.filter(|(factor, _)| *factor != 0.0).collect();
            let normal = transform.is_normal() || in_zone;
            let place = if normal { (mean, sigma) } else { ziggurat::STANDARD };
            on_this_processor(Combined { terms: &terms, place, out: &mut *column });
            if !normal {
                column.iter_mut().for_each(|value| *value = behind_normal(law, *value));
            }
        }
    }
}

/// Work item: columns times factors, summed in their order, then scaled by a sigma and moved to a mean.
struct Combined<'a> {
    terms: &'a [(f64, &'a [f64])],
    place: (f64, f64),
    out: &'a mut [f64],
}

impl Work for Combined<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        /// Rows whose sums stay in the nearest cache.
        const LANES: usize = 256;
        let Self { terms, place: (mean, sigma), out } = self;
        for (block, out) in out.chunks_mut(LANES).enumerate() {
            let rows = LANES * block..LANES * block + out.len();
            if terms.is_empty() {
                out.fill(0.0);
            }
            // Take three terms at a time. Missing ones have the factor 0.
            for (group, terms) in terms.chunks(3).enumerate() {
                let nothing = (0.0, terms[0].1);
                let [a, b, c] = match *terms {
                    [a] => [a, nothing, nothing],
                    [a, b] => [a, b, nothing],
                    _ => [terms[0], terms[1], terms[2]],
                };
                let columns = a.1[rows.clone()].iter().zip(&b.1[rows.clone()]).zip(&c.1[rows.clone()]);
                if group == 0 {
                    for (sum, ((x, y), z)) in out.iter_mut().zip(columns) {
                        *sum = a.0 * x + b.0 * y + c.0 * z;
                    }
                } else {
                    for (sum, ((x, y), z)) in out.iter_mut().zip(columns) {
                        *sum = *sum + a.0 * x + b.0 * y + c.0 * z;
                    }
                }
            }
            for sum in out {
                *sum = mean + sigma * *sum;
            }
        }
    }
}

/// Scrambles digits in bottom-up order and turns them into probabilities. Each is the middle of its cell, counted from the nearer end and
/// negative from above.
pub fn tails(digits: &[u64], key: u64, out: &mut [f64]) {
    on_this_processor(Tails { digits, key, out });
}

struct Tails<'a> {
    digits: &'a [u64],
    key: u64,
    out: &'a mut [f64],
}

impl Work for Tails<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        for (value, &digits) in self.out.iter_mut().zip(self.digits) {
            let digits = scrambled(digits, self.key);
            let upper = 0u64.wrapping_sub(digits >> 63);
            let cell = f64::from_bits((digits ^ upper) >> 12 | 0x4330_0000_0000_0000) - (1u64 << 52) as f64;
            let p = (cell + 0.5) / (1u64 << 52) as f64;
            *value = f64::from_bits(p.to_bits() | upper << 63);
        }
    }
}
