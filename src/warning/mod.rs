//! Warnings: where an assumption of the method fails, what that means, and what to try.

mod message;

/// Something that a reader of the results must know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// No asked characteristic can depend on a dimension.
    UnusedDimension {
        /// The dimension.
        dimension: String,
    },
    /// No characteristic of the study uses a constant or formula.
    UnusedName {
        /// `constant` or `formula`.
        what: &'static str,
        /// Its name.
        name: String,
    },
    /// A tolerance that was found is no fit of ISO 286 any more.
    FitReplaced {
        /// The dimension.
        dimension: String,
    },
    /// The model was not asked at the tolerances that were found.
    NotConfirmed,
    /// Monte Carlo at the tolerances that were found says that a required yield is missed.
    ConfirmationMisses {
        /// The characteristic.
        characteristic: String,
        /// What is required.
        required: f64,
        /// 95 % interval of what there is.
        interval: [f64; 2],
    },
    /// The model failed at some points.
    FailedPoints {
        /// The characteristic that has no value there.
        characteristic: String,
        /// At how many points.
        failed: usize,
        /// Of how many.
        points: usize,
        /// The first such point, in words.
        point: String,
        /// Why it has no value there.
        error: String,
    },
    /// The model failed at some points of a sample.
    FailedSamples {
        /// The characteristic that has no value there.
        characteristic: String,
        /// At how many points.
        failed: u64,
        /// Of how many.
        samples: u64,
        /// Why, of the first.
        error: String,
    },
    /// Most of a small probability rests on one drawn point.
    HeavyPoint {
        /// The characteristic.
        characteristic: String,
        /// The limit that it lies beyond.
        limit: f64,
        /// The part of the estimate that is this point's.
        part: f64,
    },
    /// No drawn point lies beyond a limit.
    NothingBeyond {
        /// The characteristic.
        characteristic: String,
        /// The limit.
        limit: f64,
        /// Points drawn.
        points: u64,
        /// What the probability may be at most.
        most: f64,
    },
    /// What importance sampling found, plain sampling would have found with fewer points.
    PlainSampling {
        /// The characteristic.
        characteristic: String,
        /// The limit.
        limit: f64,
        /// Points that a plain sample would have taken.
        plain: f64,
        /// Points that were evaluated.
        evaluations: u64,
    },
    /// Moments could not be had by a method that is no difference plan.
    LostMoments {
        /// The characteristic.
        characteristic: String,
        /// Why not, in words.
        because: String,
    },
    /// Rules of three nodes do not integrate high powers of what is curved.
    ShallowRules {
        /// The characteristic.
        characteristic: String,
        /// The share of its variance that curvature adds.
        share: f64,
    },
    /// A surface of least squares misses the values that it was fitted to.
    PoorFit {
        /// The characteristic.
        characteristic: String,
        /// The residual standard error, in sigmas.
        residual: f64,
    },
    /// A derivative could not be had.
    LostDerivative {
        /// The characteristic.
        characteristic: String,
        /// The dimension, or the two of a mixed derivative.
        dimensions: Vec<String>,
        /// What is lost.
        loss: Loss,
    },
    /// The model fails within reach of the tolerances: differences were taken over a shorter step.
    DomainEdge {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which it fails.
        dimension: String,
        /// The node that failed, in sigmas off the mean.
        failed: f64,
        /// The node in its place.
        used: f64,
    },
    /// A node that the moments want lies outside a distribution's support.
    SupportEdge {
        /// The dimension.
        dimension: String,
        /// Where the moments want it, in sigmas off the mean.
        from: f64,
        /// Where it is.
        to: f64,
    },
    /// A characteristic is curved along a dimension whose distribution reaches far beyond the nodes.
    LongTail {
        /// The characteristic.
        characteristic: String,
        /// The dimension.
        dimension: String,
        /// The farthest node, in sigmas off the mean.
        farthest: f64,
        /// How far values count in the fourth moment, in sigmas.
        reach: f64,
        /// The share of the variance that the curvature makes.
        share: f64,
    },
    /// The characteristic is the same at every point.
    NoReaction {
        /// The characteristic.
        characteristic: String,
    },
    /// The characteristic is exactly 0 at several points, though not at the means.
    Atom {
        /// The characteristic.
        characteristic: String,
        /// At how many points.
        points: usize,
    },
    /// Rounding in the model is not small beside the differences.
    Noise {
        /// The characteristic.
        characteristic: String,
        /// The rounding error of one value, relative to sigma.
        rounding: f64,
    },
    /// Interactions were left unexamined.
    PairsNotExamined {
        /// How many were examined.
        examined: usize,
        /// Of how many.
        possible: usize,
    },
    /// A first-order method on a characteristic that is visibly curved.
    RssInvalid {
        /// The characteristic.
        characteristic: String,
        /// How far curvature moves the mean, in sigmas.
        mean_shift: f64,
        /// What curvature adds to the variance, relative to what the slopes make of it.
        variance: f64,
    },
    /// An external model answered the nominal point otherwise than before.
    History {
        /// What of the model: a characteristic, or something that formulas use.
        output: String,
        /// What it was at first; None where it had no value.
        expected: Option<f64>,
        /// What it was then.
        found: Option<f64>,
        /// Whether the difference is of the size of what the output varies by: another solution, not a drift.
        flip: bool,
        /// How often.
        times: usize,
        /// Points that were evaluated again for it.
        points: usize,
        /// The first few of them, in words.
        suspects: Vec<String>,
    },
    /// Near the nominal dimensions the assembly can move or jam.
    NearSingular {
        /// The unknown that is held least.
        unknown: String,
        /// The condition number of the scaled closure conditions.
        condition: f64,
    },
    /// No distribution has the moments.
    InfeasibleMoments {
        /// The characteristic.
        characteristic: String,
        /// Why not, with the law at the bound.
        reason: String,
    },
    /// Hardly any distribution has the moments.
    NearInfeasibleMoments {
        /// The characteristic.
        characteristic: String,
        /// Third standardised moment.
        skewness: f64,
        /// Fourth standardised moment.
        kurtosis: f64,
    },
    /// Cells of a measured column have no value.
    MissingValues {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// How many have none.
        missing: usize,
        /// Of how many.
        rows: usize,
        /// The first lines without one.
        lines: Vec<u64>,
    },
    /// Measured values that lie too far from the others.
    Outliers {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// How many do.
        count: usize,
        /// Of how many.
        values: usize,
        /// The farthest of them with their lines.
        first: Vec<(f64, u64)>,
    },
    /// A sample that says little of the higher moments.
    SmallSample {
        /// The dimension.
        dimension: String,
        /// How many values it has.
        values: usize,
        /// How many it should have.
        enough: usize,
    },
    /// What the size of a sample leaves uncertain is not computed where dimensions are correlated.
    NoSamplingInterval {
        /// The dimension.
        dimension: String,
        /// Whether because dimensions are correlated; else because the method has no surrogate.
        correlated: bool,
    },
    /// Measured values that are rounded too coarsely.
    CoarseResolution {
        /// The dimension.
        dimension: String,
        /// The least difference of two values.
        resolution: f64,
        /// Their sigma.
        sigma: f64,
        /// How many different values there are.
        distinct: usize,
    },
    /// Measured values outside the tolerance band.
    OutsideBand {
        /// The dimension.
        dimension: String,
        /// How many.
        count: usize,
        /// Of how many.
        values: usize,
        /// The first of them with their lines.
        first: Vec<(f64, u64)>,
        /// Whether their mean lies outside too.
        mean_too: bool,
    },
    /// The extremes of a characteristic are those that a search found, and no proof.
    NotProven {
        /// The characteristic.
        characteristic: String,
        /// Evaluations of the search.
        evaluations: usize,
        /// How it ended.
        ended: Ended,
        /// Points in the box at which the characteristic has no value.
        failed: usize,
        /// Why it has none at the first of them.
        failure: Option<String>,
        /// An interval that no assembly leaves, and the boxes of interval arithmetic that it took; for formulas.
        bounds: Option<([f64; 2], usize)>,
    },
    /// A formula changes its form within the assemblies, by its own tree.
    Switch {
        /// The characteristic.
        characteristic: String,
        /// The part of the formula that does it.
        switch: String,
        /// What happens there.
        change: Change,
        /// The probability of the smaller side.
        probability: f64,
    },
    /// The error of sigma by the model itself is too large for the surface to be one.
    UnverifiedSurface {
        /// The characteristic.
        characteristic: String,
        /// The share of the variance that the surface leaves unexplained; None where that is unknown.
        share: Option<f64>,
        /// Points of the model that were sampled; None where it was evaluated at a few points only.
        sampled: Option<u64>,
    },
    /// A figure lies beyond three errors of the model's own.
    FigureOff {
        /// The characteristic.
        characteristic: String,
        /// The figure.
        figure: &'static str,
        /// As the method has it.
        value: f64,
        /// As the model has it.
        model: f64,
        /// The error of that.
        error: f64,
    },
    /// Two slopes of a characteristic meet within reach.
    Kink {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which they do.
        dimension: String,
        /// On the left and on the right, per sigma of the dimension, in sigmas of the characteristic.
        slopes: [f64; 2],
        /// Between which places, in sigmas off the mean.
        between: [f64; 2],
    },
    /// A characteristic jumps within reach.
    Discontinuity {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which it does.
        dimension: String,
        /// By how many of its sigmas.
        by: f64,
        /// Between which places, in sigmas off the mean.
        between: [f64; 2],
    },
    /// Powers beyond the second have a visible part.
    HigherOrder {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which they have.
        dimension: String,
        /// Third and fourth coefficient, in sigmas of the characteristic.
        coefficients: [f64; 2],
        /// Whether the surrogate has them.
        held: bool,
    },
    /// Answers next to the means scatter.
    Scatter {
        /// The characteristic.
        characteristic: String,
        /// What they scatter by, in sigmas of the characteristic.
        scatter: f64,
        /// Dimensions whose second difference is no more than that makes.
        drowned: usize,
    },
    /// The model has no value at points of the distribution, though it has one wherever differences were taken.
    DomainEdgeWithin {
        /// The characteristic.
        characteristic: String,
        /// At how many points.
        failed: usize,
        /// Of how many that check.
        points: usize,
    },
    /// Interactions, or what else the surrogate does not have, are in the variance as an unexplained part.
    InteractionsLeftOut {
        /// The characteristic.
        characteristic: String,
        /// Their share of the variance.
        share: f64,
    },
    /// Model and surrogate differ at the points that check.
    UntrustedSurrogate {
        /// The characteristic.
        characteristic: String,
        /// The share of the variance that the surrogate does not have.
        share: f64,
        /// Points of the model on which the moments rest instead; None where there was no money for them.
        sampled: Option<u64>,
    },
    /// The estimated error is larger than wanted.
    UnderResolved {
        /// The characteristic.
        characteristic: String,
        /// Which of its results.
        figure: Figure,
        /// Its error as estimated, that of sigma relative; None where nothing is known of it.
        error: Option<f64>,
        /// As wanted.
        wanted: f64,
        /// Whether the budget was the reason.
        budget: bool,
    },
    /// The law of four moments rejects other assemblies than the surface that has these moments.
    TailsMissed {
        /// The characteristic.
        characteristic: String,
        /// The share that the law rejects.
        law: f64,
        /// The share of the surface's points.
        surface: f64,
        /// How many these are.
        points: usize,
    },
    /// Four moments that a distribution with several peaks has.
    SeveralModes {
        /// The characteristic.
        characteristic: String,
        /// `(skewness^2 + 1)/kurtosis`: 5/9 for a uniform distribution, 1 for one with two values.
        coefficient: f64,
    },
}

/// How a search for extremes ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// No move along a coordinate improves either extreme.
    Converged,
    /// The budget was spent.
    Budget,
    /// The run was stopped.
    Stopped,
}

/// What of a derivative is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loss {
    /// Every derivative: there is no value at the means, from which differences are taken.
    Centre,
    /// Slope and curvature: without them the characteristic has no moments.
    Slope,
    /// The curvature; the slope is one-sided.
    Curvature,
    /// The mixed derivative.
    Mixed,
    /// One side of the mixed derivative.
    OneSidedMixed,
    /// Nothing failed: the run was stopped before the points of these derivatives were evaluated.
    NotEvaluated {
        /// How many derivatives are missing.
        derivatives: usize,
    },
}

/// What happens to a characteristic at a switch of its formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// Its slope changes.
    Kink,
    /// Its value jumps.
    Jump,
    /// It has no value beyond.
    Edge,
    /// It grows without bound.
    Pole,
}

/// What an accuracy can be wanted of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// Sigma, relative.
    Sigma,
    /// The skewness.
    Skewness,
    /// The kurtosis.
    Kurtosis,
    /// The share within the limits.
    Yield,
}

impl Figure {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sigma => "sigma",
            Self::Skewness => "skewness",
            Self::Kurtosis => "kurtosis",
            Self::Yield => "yield",
        }
    }
}

impl Warning {
    /// The code that reports use.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnusedDimension { .. } => "unused-dimension",
            Self::UnusedName { .. } => "unused-name",
            Self::FailedPoints { .. } | Self::FailedSamples { .. } => "failed-points",
            Self::HeavyPoint { .. } => "untrusted-surrogate",
            Self::NothingBeyond { .. } => "under-resolved",
            Self::PlainSampling { .. } => "plain-sampling",
            Self::LostMoments { .. } => "lost-moments",
            Self::ShallowRules { .. } => "higher-order",
            Self::PoorFit { .. } => "untrusted-surrogate",
            Self::LostDerivative { .. } => "lost-derivative",
            Self::DomainEdge { .. } => "domain-edge",
            Self::SupportEdge { .. } => "support-edge",
            Self::LongTail { .. } => "long-tail",
            Self::NoReaction { .. } => "no-reaction",
            Self::Atom { .. } => "atom",
            Self::Noise { .. } => "noise",
            Self::PairsNotExamined { .. } => "pairs-not-examined",
            Self::RssInvalid { .. } => "rss-invalid",
            Self::History { flip: true, .. } => "branch-flip",
            Self::History { flip: false, .. } => "history",
            Self::NearSingular { .. } => "near-singular",
            Self::InfeasibleMoments { .. } => "infeasible-moments",
            Self::NearInfeasibleMoments { .. } => "near-infeasible-moments",
            Self::MissingValues { .. } => "missing-values",
            Self::Outliers { .. } => "outliers",
            Self::SmallSample { .. } => "small-sample",
            Self::NoSamplingInterval { .. } => "no-sampling-interval",
            Self::CoarseResolution { .. } => "coarse-resolution",
            Self::OutsideBand { .. } => "outside-band",
            Self::NotProven { .. } => "not-proven",
            Self::FitReplaced { .. } => "fit-replaced",
            Self::NotConfirmed => "not-confirmed",
            Self::ConfirmationMisses { .. } => "confirmation-misses",
            Self::Kink { .. } => "kink",
            Self::Discontinuity { .. } => "discontinuity",
            Self::HigherOrder { .. } => "higher-order",
            Self::Scatter { .. } => "noise",
            Self::DomainEdgeWithin { .. } => "domain-edge",
            Self::InteractionsLeftOut { .. } => "interactions-left-out",
            Self::UntrustedSurrogate { .. } => "untrusted-surrogate",
            Self::UnderResolved { .. } => "under-resolved",
            Self::TailsMissed { .. } => "tails-missed",
            Self::SeveralModes { .. } => "several-modes",
            Self::Switch { change: Change::Kink, .. } => "kink",
            Self::Switch { change: Change::Jump, .. } => "discontinuity",
            Self::Switch { change: Change::Edge, .. } => "domain-edge",
            Self::Switch { change: Change::Pole, .. } => "pole",
            Self::UnverifiedSurface { .. } => "untrusted-surrogate",
            Self::FigureOff { .. } => "figure-off",
        }
    }

    /// The characteristic that it concerns, where it concerns one.
    pub fn characteristic(&self) -> Option<&str> {
        match self {
            Self::FailedPoints { characteristic, .. }
            | Self::FailedSamples { characteristic, .. }
            | Self::HeavyPoint { characteristic, .. }
            | Self::NothingBeyond { characteristic, .. }
            | Self::PlainSampling { characteristic, .. }
            | Self::LostMoments { characteristic, .. }
            | Self::ShallowRules { characteristic, .. }
            | Self::PoorFit { characteristic, .. }
            | Self::LostDerivative { characteristic, .. }
            | Self::DomainEdge { characteristic, .. }
            | Self::LongTail { characteristic, .. }
            | Self::NoReaction { characteristic }
            | Self::Atom { characteristic, .. }
            | Self::Noise { characteristic, .. }
            | Self::History { output: characteristic, .. }
            | Self::InfeasibleMoments { characteristic, .. }
            | Self::NearInfeasibleMoments { characteristic, .. }
            | Self::NotProven { characteristic, .. }
            | Self::ConfirmationMisses { characteristic, .. }
            | Self::Kink { characteristic, .. }
            | Self::Discontinuity { characteristic, .. }
            | Self::HigherOrder { characteristic, .. }
            | Self::Scatter { characteristic, .. }
            | Self::DomainEdgeWithin { characteristic, .. }
            | Self::InteractionsLeftOut { characteristic, .. }
            | Self::UntrustedSurrogate { characteristic, .. }
            | Self::UnderResolved { characteristic, .. }
            | Self::TailsMissed { characteristic, .. }
            | Self::SeveralModes { characteristic, .. }
            | Self::Switch { characteristic, .. }
            | Self::UnverifiedSurface { characteristic, .. }
            | Self::FigureOff { characteristic, .. }
            | Self::RssInvalid { characteristic, .. } => Some(characteristic),
            _ => None,
        }
    }

    /// The dimension that it concerns, where it concerns one.
    pub fn dimension(&self) -> Option<&str> {
        match self {
            Self::UnusedDimension { dimension }
            | Self::DomainEdge { dimension, .. }
            | Self::LongTail { dimension, .. }
            | Self::MissingValues { dimension, .. }
            | Self::Outliers { dimension, .. }
            | Self::SmallSample { dimension, .. }
            | Self::NoSamplingInterval { dimension, .. }
            | Self::CoarseResolution { dimension, .. }
            | Self::OutsideBand { dimension, .. }
            | Self::FitReplaced { dimension }
            | Self::Kink { dimension, .. }
            | Self::Discontinuity { dimension, .. }
            | Self::HigherOrder { dimension, .. }
            | Self::SupportEdge { dimension, .. } => Some(dimension),
            Self::LostDerivative { dimensions, .. } => dimensions.first().map(String::as_str),
            _ => None,
        }
    }
}
