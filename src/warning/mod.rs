//! Warnings: an assumption of the method fails, or a result is not what was asked for.
//!
//! A warning is data: its [`code`](Warning::code) and its fields, which it serialises as `data`. The [`message`](Warning::message) says what happened
//! and what it means for the result. The [`advice`](Warning::advice) says what to do; each front end shows it in its own words.

#[macro_use]
mod define;
mod advice;
pub mod aggregate;
mod allocation;
mod derivatives;
mod distribution;
mod measured;
mod model;
mod rescale;
mod run;
mod sample;
mod serialize;
mod study;
mod surface;
mod terms;
mod text;
mod written;

use crate::summary::StopReason;
pub use advice::Advice;
pub use aggregate::aggregated;
use serde::ser::SerializeMap;
pub(crate) use serialize::warnings_last;
pub use terms::{Change, Counted, Ended, Figure, Loss, NameKind};
use text::Text;
use written::WarningData;

warnings! {
    /// None of the analysed characteristics can depend on these dimensions.
    UnusedDimension = "unused-dimension" by study::unused_dimension {
        /// The dimensions.
        dimensions: Vec<String>,
    };
    /// Nominal values that lie outside the limits of their own dimensions.
    NominalOutsideLimits = "nominal-outside-limits" by study::nominal_outside_limits {
        /// The dimensions.
        dimensions: Vec<String>,
    };
    /// The units in a formula do not go together.
    UnitMismatch = "unit-mismatch" by study::unit_mismatch {
        /// The key of the first such formula.
        formula: String,
        /// The column in its text, from 1.
        column: usize,
        /// The part of it, as written.
        part: String,
        /// The parts that do not go together.
        what: String,
        /// The text to write instead.
        instead: String,
        /// Further formulas whose units do not go together.
        others: Vec<String>,
    };
    /// Units of which nothing is known: they are labels.
    UnknownUnit = "unknown-unit" by study::unknown_unit {
        /// The units, each once.
        units: Vec<String>,
    };
    /// Dimensions that are spread evenly over a full turn inside a sine or cosine.
    PeriodicInput = "periodic-input" by study::periodic_input {
        /// The dimensions.
        dimensions: Vec<String>,
    };
    /// The bands of a float let the pin be larger than its hole.
    Interference = "interference" by study::interference {
        /// The geometric element.
        element: String,
        /// The share of pairs whose pin is larger than its hole; None where their distributions do not say.
        share: Option<f64>,
    };
    /// No characteristic of the study uses these constants, formulas or unknowns.
    UnusedName = "unused-name" by study::unused_name {
        /// The kind of the names.
        kind: NameKind,
        /// Their names.
        names: Vec<String>,
    };
    /// Near the nominal dimensions the assembly can move or jam.
    NearSingular = "near-singular" by study::near_singular {
        /// The unknown that the closure conditions determine least.
        unknown: String,
        /// The condition number of the scaled closure conditions.
        condition: f64,
    };
    /// Cells of a measured column have no value.
    MissingValues = "missing-values" by measured::missing_values {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// Cells without a value.
        missing: usize,
        /// All cells.
        rows: usize,
        /// The first lines without a value.
        lines: Vec<u64>,
    };
    /// Rows of a measured file whose number stands in no other file.
    UnmatchedRows = "unmatched-rows" by measured::unmatched_rows {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// Rows without a partner.
        unmatched: usize,
        /// The first lines without a partner.
        lines: Vec<u64>,
    };
    /// Rows of a measured file vary together as no normal copula has it between their columns.
    RowsByCopula = "rows-by-copula" by measured::rows_by_copula {
        /// The two dimensions that are farthest off.
        dimensions: [String; 2],
        /// The correlation of their rows, and the one that is taken.
        correlation: [f64; 2],
    };
    /// Measured values that lie too far from the others.
    Outliers = "outliers" by measured::outliers {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// How many outliers there are.
        count: usize,
        /// All values.
        values: usize,
        /// The farthest of them with their lines.
        first: Vec<(f64, u64)>,
    };
    /// A sample too small for the higher moments.
    SmallSample = "small-sample" by measured::small_sample {
        /// The dimension with the fewest values.
        dimension: String,
        /// Its values.
        values: usize,
        /// The values that it should have.
        enough: usize,
        /// Further dimensions with fewer values than that.
        others: Vec<String>,
    };
    /// The uncertainty that comes from the size of a sample is not computed.
    NoSamplingInterval = "no-sampling-interval" by measured::no_sampling_interval {
        /// The measured dimensions.
        dimensions: Vec<String>,
        /// True where dimensions are correlated; false where the method has no surrogate.
        correlated: bool,
    };
    /// Measured values that are rounded too coarsely.
    CoarseResolution = "coarse-resolution" by measured::coarse_resolution {
        /// The dimension with the coarsest rounding.
        dimension: String,
        /// The least difference of two values.
        resolution: f64,
        /// Their standard deviation.
        sigma: f64,
        /// How many different values there are.
        distinct: usize,
        /// Further dimensions with coarse rounding.
        others: Vec<String>,
    };
    /// Measured values outside the tolerance band.
    OutsideBand = "outside-band" by measured::outside_band {
        /// The dimension.
        dimension: String,
        /// How many lie outside.
        count: usize,
        /// All values.
        values: usize,
        /// The first of them with their lines.
        first: Vec<(f64, u64)>,
        /// Whether their mean lies outside too.
        mean_too: bool,
    };
    /// The model failed at some points of the evaluation plan.
    FailedPoints = "failed-points" by model::failed_points {
        /// The characteristic that has no value there.
        characteristic: String,
        /// Points without a value.
        failed: usize,
        /// All points.
        points: usize,
        /// The first failed point, in words.
        point: String,
        /// The error there.
        error: String,
    };
    /// The model failed at some points of a sample.
    FailedSamples = "failed-samples" by model::failed_samples {
        /// The characteristic that has no value there.
        characteristic: String,
        /// Points without a value.
        failed: u64,
        /// All points.
        samples: u64,
        /// The error at the first of them.
        error: String,
    };
    /// Values so large that their powers overflow.
    Overflow = "overflow" by model::overflow {
        /// The characteristic.
        characteristic: String,
        /// The largest size of its values.
        value: f64,
        /// The size beyond which powers overflow.
        limit: f64,
    };
    /// Figures that a double-precision number cannot hold.
    Unrepresentable = "unrepresentable" by model::unrepresentable {
        /// The characteristic.
        characteristic: String,
    };
    /// Values of a built-in model for which its formulas describe nothing real.
    OutsideModel = "outside-model" by model::outside_model {
        /// The output of the model.
        output: String,
        /// The bound that it passed, and what does not hold beyond.
        reason: String,
    };
    /// An external model gave a slightly different answer to the nominal point later.
    NotRepeatable = "not-repeatable" by model::not_repeatable {
        /// The output: a characteristic, or a value that formulas use.
        output: String,
        /// The first answer; None where it had no value.
        expected: Option<f64>,
        /// The first differing answer; None where it had no value.
        found: Option<f64>,
        /// How often the answer differed.
        times: usize,
        /// Points that a fresh process evaluated again.
        points: usize,
        /// The first few of these points, in words.
        suspects: Vec<String>,
    };
    /// An external model gave an answer of another solution to the nominal point later.
    BranchFlip = "branch-flip" by model::branch_flip {
        /// The output: a characteristic, or a value that formulas use.
        output: String,
        /// The first answer; None where it had no value.
        expected: Option<f64>,
        /// The first differing answer; None where it had no value.
        found: Option<f64>,
        /// How often the answer differed.
        times: usize,
        /// Points that a fresh process evaluated again.
        points: usize,
        /// The first few of these points, in words.
        suspects: Vec<String>,
    };
    /// Processes of an external model failed and were started again.
    Restarts = "restarts" by model::restarts {
        /// Processes that were started.
        starts: u64,
        /// Processes that ended by themselves.
        crashes: u64,
        /// Deadlines that passed.
        timeouts: u64,
        /// Lines that were no answers.
        garbage: u64,
        /// Evaluations that were lost and done again.
        retried: u64,
        /// Seconds without an answer of a process that failed.
        lost_s: f64,
        /// The cause of the last failure.
        cause: String,
        /// The last lines that the process wrote to stderr.
        stderr: Vec<String>,
    };
    /// Answers of an external model depend on the points before them, and no fresh process confirmed them.
    Unconfirmed = "unconfirmed" by model::unconfirmed {
        /// How many answers.
        answers: u64,
    };
    /// The journal holds the answers of another model than the one that runs now.
    OutdatedJournal = "outdated-journal" by model::outdated_journal {
        /// The output that differs at the nominal dimensions: a characteristic, or a value that formulas use.
        output: String,
        /// Its value in the journal; None where it had none.
        expected: Option<f64>,
        /// Its value now.
        found: Option<f64>,
        /// Answers that were forgotten.
        answers: usize,
    };
    /// The characteristic is the same at every point.
    NoReaction = "no-reaction" by model::no_reaction {
        /// The characteristic.
        characteristic: String,
    };
    /// The characteristic is exactly 0 at several points, though not at the means.
    Atom = "atom" by model::atom {
        /// The characteristic.
        characteristic: String,
        /// Points at which it is 0.
        points: usize,
    };
    /// Rounding in the model is not small beside the differences.
    Noise = "noise" by model::noise {
        /// The characteristic.
        characteristic: String,
        /// The rounding error of one value, relative to sigma.
        rounding: f64,
    };
    /// Answers next to the means scatter.
    Scatter = "scatter" by model::scatter {
        /// The characteristic.
        characteristic: String,
        /// The standard deviation of the scatter, in sigmas of the characteristic.
        scatter: f64,
        /// Dimensions whose second difference is no larger than the scatter.
        drowned: usize,
    };
    /// A derivative is unknown.
    LostDerivative = "lost-derivative" by derivatives::lost_derivative {
        /// The characteristic.
        characteristic: String,
        /// The dimension, or the two of a mixed derivative; empty where every derivative is lost.
        dimensions: Vec<String>,
        /// The loss.
        loss: Loss,
        /// Further dimensions, or pairs as `a:b`, with the same loss.
        others: Vec<String>,
    };
    /// The moments of a method without derivatives are unknown.
    LostMoments = "lost-moments" by derivatives::lost_moments {
        /// The characteristic.
        characteristic: String,
        /// The reason, in words.
        because: String,
    };
    /// The model fails within the tolerances: differences were taken over a shorter step.
    DomainEdge = "domain-edge" by derivatives::domain_edge {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which it fails nearest to the mean.
        dimension: String,
        /// The node that failed, in sigmas from the mean.
        failed: f64,
        /// The node that was used instead.
        used: f64,
        /// Further dimensions along which it fails.
        others: Vec<String>,
    };
    /// The model has no value at points of the distribution, though it has one wherever differences were taken.
    DomainEdgeWithin = "domain-edge-within" by derivatives::domain_edge_within {
        /// The characteristic.
        characteristic: String,
        /// Check points without a value.
        failed: usize,
        /// All check points.
        points: usize,
    };
    /// A matched node lies outside the support of a distribution and was moved inside.
    SupportEdge = "support-edge" by derivatives::support_edge {
        /// The dimension with the longest move.
        dimension: String,
        /// The matched node, in sigmas from the mean.
        from: f64,
        /// The node that was used instead.
        to: f64,
        /// Further dimensions with a moved node.
        others: Vec<String>,
    };
    /// A characteristic is curved along a dimension whose distribution reaches far beyond the nodes.
    LongTail = "long-tail" by derivatives::long_tail {
        /// The characteristic.
        characteristic: String,
        /// The dimension whose curvature contributes most.
        dimension: String,
        /// The farthest node, in sigmas from the mean.
        farthest: f64,
        /// The distance up to which values count in the fourth moment, in sigmas.
        reach: f64,
        /// The share of the variance that the curvature contributes.
        share: f64,
        /// Further dimensions with a long tail.
        others: Vec<String>,
    };
    /// A dimension has so long a tail that a moment of a characteristic is infinite.
    InfiniteMoment = "infinite-moment" by derivatives::infinite_moment {
        /// The characteristic.
        characteristic: String,
        /// The first moment that it does not have; nor has it those beyond.
        figure: Figure,
        /// The dimensions whose own moments end.
        dimensions: Vec<String>,
    };
    /// Some interactions were not examined.
    PairsNotExamined = "pairs-not-examined" by derivatives::pairs_not_examined {
        /// Interactions examined.
        examined: usize,
        /// All interactions.
        possible: usize,
    };
    /// A first-order method on a characteristic that is visibly curved.
    RssInvalid = "rss-invalid" by surface::rss_invalid {
        /// The characteristic.
        characteristic: String,
        /// The mean shift of second order, in sigmas.
        mean_shift: f64,
        /// The contribution of curvature to the variance, relative to the linear variance.
        variance: f64,
    };
    /// Powers beyond the second have a visible effect.
    HigherOrder = "higher-order" by surface::higher_order {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which the effect is largest.
        dimension: String,
        /// Third and fourth coefficient, in sigmas of the characteristic.
        coefficients: [f64; 2],
        /// Whether the surrogate has these powers.
        held: bool,
        /// Further dimensions with such an effect.
        others: Vec<String>,
    };
    /// Rules of three nodes do not integrate the high powers of a curved characteristic.
    ShallowRules = "shallow-rules" by surface::shallow_rules {
        /// The characteristic.
        characteristic: String,
        /// The share of its variance that curvature contributes.
        share: f64,
    };
    /// A fitted surface misses the values that it was fitted to.
    PoorFit = "poor-fit" by surface::poor_fit {
        /// The characteristic.
        characteristic: String,
        /// The residual standard error, in sigmas.
        residual: f64,
    };
    /// The slope of a characteristic changes abruptly within the tolerances.
    Kink = "kink" by surface::kink {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which the slopes differ most.
        dimension: String,
        /// On the left and on the right, in sigmas of the characteristic per sigma of the dimension.
        slopes: [f64; 2],
        /// The places between which the kink lies, in sigmas from the mean.
        between: [f64; 2],
        /// Further dimensions with a kink.
        others: Vec<String>,
    };
    /// A characteristic jumps within the tolerances.
    Discontinuity = "discontinuity" by surface::discontinuity {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which the jump is largest.
        dimension: String,
        /// The height of the jump, in sigmas of the characteristic.
        by: f64,
        /// The places between which the jump lies, in sigmas from the mean.
        between: [f64; 2],
        /// The same places as values of the dimension.
        at: Option<[f64; 2]>,
        /// Further dimensions with a jump.
        others: Vec<String>,
    };
    /// Part of the variance comes from terms that were not examined.
    InteractionsLeftOut = "interactions-left-out" by surface::interactions_left_out {
        /// The characteristic.
        characteristic: String,
        /// Their share of the variance.
        share: f64,
    };
    /// Model and surrogate differ at the check points.
    UntrustedSurrogate = "untrusted-surrogate" by surface::untrusted_surrogate {
        /// The characteristic.
        characteristic: String,
        /// The share of the variance that the surrogate does not explain.
        share: f64,
        /// Points of the model from which the moments come instead; None where the budget did not allow any.
        sampled: Option<u64>,
    };
    /// A formula changes its form within the assemblies, by its own tree.
    Switch = "switch" by surface::switch {
        /// The characteristic.
        characteristic: String,
        /// The part of the formula that does it.
        switch: String,
        /// The change there.
        change: Change,
        /// The probability of the smaller side.
        probability: f64,
        /// Points of a sample that lie beyond on average; None where the figures are not those of a sample.
        points: Option<f64>,
    };
    /// A divisor passes through 0 within the assemblies.
    Pole = "pole" by surface::pole {
        /// The characteristic.
        characteristic: String,
        /// The part of the formula that grows without bound.
        switch: String,
        /// The probability of the smaller side.
        probability: f64,
    };
    /// A figure lies beyond three errors of the model's own.
    FigureOff = "figure-off" by surface::figure_off {
        /// The characteristic.
        characteristic: String,
        /// Mean, sigma, skewness or kurtosis.
        figure: &'static str,
        /// As the method has it.
        value: f64,
        /// As the model has it.
        model: f64,
        /// The error of that.
        error: f64,
    };
    /// The law of the surface fails a test, and points take its place.
    SurfaceLawRefuted = "surface-law-refuted" by surface::surface_law_refuted {
        /// The characteristic.
        characteristic: String,
        /// The failed test: `monotone` or `count`.
        test: &'static str,
        /// The limit at which it failed.
        limit: f64,
        /// Share of assemblies below the limit by the law.
        law: f64,
        /// Share of points below the limit.
        counted: f64,
        /// Standard error of that share.
        error: f64,
    };
    /// The estimated error is larger than the wanted accuracy.
    UnderResolved = "under-resolved" by surface::under_resolved {
        /// The characteristic.
        characteristic: String,
        /// Which of its results.
        figure: Figure,
        /// The estimated error, that of sigma relative; None where it is unknown.
        error: Option<f64>,
        /// The wanted error.
        wanted: f64,
        /// Whether the budget ended the analysis.
        budget: bool,
    };
    /// No distribution has the moments.
    InfeasibleMoments = "infeasible-moments" by distribution::infeasible_moments {
        /// The characteristic.
        characteristic: String,
        /// The reason, in words.
        reason: String,
    };
    /// The moments lie close to the bound beyond which no distribution has them.
    NearInfeasibleMoments = "near-infeasible-moments" by distribution::near_infeasible_moments {
        /// The characteristic.
        characteristic: String,
        /// Third standardised moment.
        skewness: f64,
        /// Fourth standardised moment.
        kurtosis: f64,
    };
    /// The Pearson fit rejects another share than what is known to be rejected.
    PearsonDiffers = "pearson-differs" by distribution::pearson_differs {
        /// The characteristic.
        characteristic: String,
        /// The share that the Pearson fit rejects.
        pearson: f64,
        /// The share that is rejected.
        rejected: f64,
        /// Its error.
        error: f64,
    };
    /// The moments are those of a distribution with several peaks.
    SeveralModes = "several-modes" by distribution::several_modes {
        /// The characteristic.
        characteristic: String,
        /// `(skewness^2 + 1)/kurtosis`: 5/9 for a uniform distribution, 1 for one with two values.
        coefficient: f64,
    };
    /// One drawn point carries most of a small probability.
    HeavyPoint = "heavy-point" by sample::heavy_point {
        /// The characteristic.
        characteristic: String,
        /// The limit beyond which the point lies.
        limit: f64,
        /// The point's share of the estimate.
        part: f64,
    };
    /// No drawn point lies beyond a limit.
    NothingBeyond = "nothing-beyond" by sample::nothing_beyond {
        /// The characteristic.
        characteristic: String,
        /// The limit.
        limit: f64,
        /// Points drawn.
        points: u64,
        /// The upper bound of the probability.
        most: f64,
    };
    /// Plain sampling would have given the same error with fewer points than importance sampling.
    PlainSampling = "plain-sampling" by sample::plain_sampling {
        /// The characteristic.
        characteristic: String,
        /// The limit.
        limit: f64,
        /// Points of a plain sample with the same standard error.
        plain: f64,
        /// Evaluations spent.
        evaluations: u64,
    };
    /// Importance sampling was worse than plain points, which make the estimate.
    PlainFallback = "plain-fallback" by sample::plain_fallback {
        /// The characteristic.
        characteristic: String,
        /// The limit.
        limit: f64,
        /// Plain points.
        points: u64,
    };
    /// Moments of a sample that a few points decide, or that rest on assemblies which it hardly has.
    UnsettledMoments = "unsettled-moments" by sample::unsettled_moments {
        /// The characteristic.
        characteristic: String,
        /// Mean, sigma, skewness or kurtosis, the lowest first.
        figures: Vec<&'static str>,
        /// Points of the sample.
        points: u64,
        /// The part of the largest point in the sum that the error of the first figure rests on.
        largest: f64,
        /// That of the ten largest.
        ten_largest: f64,
        /// The switch beyond which assemblies decide that the sample hardly has; None where the sample's own points do.
        switch: Option<String>,
    };
    /// The standard errors of a sample are larger than wanted.
    TargetErrorMissed = "target-error-missed" by sample::target_error_missed {
        /// Points drawn.
        points: u64,
    };
    /// The extremes of a characteristic come from a search and are not proven.
    NotProven = "not-proven" by allocation::not_proven {
        /// The characteristic.
        characteristic: String,
        /// Evaluations of the search.
        evaluations: usize,
        /// How the search ended.
        ended: Ended,
        /// Points of the search without a value.
        failed: usize,
        /// The error at the first of them.
        failure: Option<String>,
        /// An interval that contains every assembly, and the boxes of interval arithmetic that it took; for formulas.
        bounds: Option<([f64; 2], usize)>,
    };
    /// Dimensions with a fit of ISO 286 were given a free tolerance.
    FitReplaced = "fit-replaced" by allocation::fit_replaced {
        /// The dimensions.
        dimensions: Vec<String>,
    };
    /// The model was not evaluated at the tolerances that were found.
    NotConfirmed = "not-confirmed" by allocation::not_confirmed;
    /// A cost that bends the wrong way, so that there may be several optima.
    CostNotConvex = "cost-not-convex" by allocation::cost_not_convex {
        /// The dimensions.
        dimensions: Vec<String>,
    };
    /// Monte Carlo at the tolerances that were found misses what is required.
    ConfirmationMisses = "confirmation-misses" by allocation::confirmation_misses {
        /// The characteristic.
        characteristic: String,
        /// `yield`, `cpk`, `sigma` or `worst-case`.
        requirement: &'static str,
        /// How much of it is required.
        required: f64,
        /// Its interval by the sample, three errors on either side.
        interval: [f64; 2],
    };
    /// The same of the joint yield.
    JointConfirmationMisses = "joint-confirmation-misses" by allocation::joint_confirmation_misses {
        /// How much of it is required.
        required: f64,
        /// Its interval by the sample, three errors on either side.
        interval: [f64; 2],
    };
    /// There are no tolerances to write into a study.
    NothingToWrite = "nothing-to-write" by allocation::nothing_to_write;
    /// The study cannot be written with the tolerances that were found.
    NotWritten = "not-written" by allocation::not_written {
        /// The reason, in words.
        reason: String,
    };
    /// The run was stopped before its end.
    Stopped = "stopped" by run::stopped {
        /// The reason why it stopped.
        cause: StopReason,
        /// The time limit in seconds, where that stopped it and is known.
        limit_s: Option<f64>,
        /// How much was done until then.
        done: u64,
        /// How much there was to do, where that is known.
        planned: Option<u64>,
        /// The things that are counted.
        counted: Counted,
    };
    /// The run will take long.
    Long = "long" by run::long {
        /// The expected time in seconds.
        expected_s: f64,
    };
    /// Points of the plan have no answer in the table of answers.
    MissingPoints = "missing-points" by run::missing_points {
        /// How many.
        count: usize,
        /// The file to which they were written, where one was named.
        written: Option<String>,
    };
    /// Answers in the table belong to no point of the plan.
    UnmatchedPoints = "unmatched-points" by run::unmatched_points {
        /// How many.
        count: usize,
        /// The first of their lines.
        lines: Vec<usize>,
    };
    /// Only the points of the first stage are known.
    FirstStageOnly = "first-stage-only" by run::first_stage_only;
}
