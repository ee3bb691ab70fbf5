//! Warnings: an assumption of the method fails, or a result differs from the request.
//!
//! A warning is data: a [`code`](Warning::code) with fields, a [`message`](Warning::message) on the result, and [`advice`](Warning::advice).

mod serialisation;
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
pub(crate) mod serialize;
mod study;
mod surface;
mod terms;
mod text;

use crate::summary::StopReason;
pub use terms::{Change, ContactShare, Counted, Ended, Figure, Loss, NameKind};
pub use {advice::Advice, aggregate::aggregated};

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
    /// Characteristics whose nominal value and mean lie on the wrong side of a limit.
    MeanOutsideLimits = "mean-outside-limits" by study::mean_outside_limits {
        /// The characteristics.
        characteristics: Vec<String>,
    };
    /// One dimension has nearly all of the variance, with a tolerance far wider than the others.
    DominantDimension = "dominant-dimension" by study::dominant_dimension {
        /// The first such characteristic.
        characteristic: String,
        /// The dimension.
        dimension: String,
        /// Share of the variance that it has.
        share: f64,
        /// Ratio of its tolerance to the widest other one in the same unit.
        factor: f64,
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
    /// Units are unknown and serve as labels only.
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
        /// The share of pairs whose pin is larger than its hole. None if their distributions do not give it.
        share: Option<f64>,
    };
    /// No characteristic of the study uses these constants, formulas or unknowns.
    UnusedName = "unused-name" by study::unused_name {
        /// The kind of the names.
        kind: NameKind,
        /// The unused names.
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
    /// Rows of a measured file have a number that no other file has.
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
    /// Rows of a measured file are correlated more than a normal copula between their columns allows.
    RowsByCopula = "rows-by-copula" by measured::rows_by_copula {
        /// The two dimensions that are farthest off.
        dimensions: [String; 2],
        /// The correlation of the rows, and the one that the result uses.
        correlation: [f64; 2],
    };
    /// Measured values that lie too far from the others.
    Outliers = "outliers" by measured::outliers {
        /// The dimension.
        dimension: String,
        /// The file.
        file: String,
        /// The number of outliers.
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
        /// The number of measured values.
        values: usize,
        /// The number of values that is sufficient.
        enough: usize,
        /// Further dimensions with fewer values than that.
        others: Vec<String>,
    };
    /// The uncertainty that comes from the size of a sample is not computed.
    NoSamplingInterval = "no-sampling-interval" by measured::no_sampling_interval {
        /// The measured dimensions.
        dimensions: Vec<String>,
        /// True if dimensions are correlated, false if the method has no surrogate.
        correlated: bool,
    };
    /// Measured values that are rounded too coarsely.
    CoarseResolution = "coarse-resolution" by measured::coarse_resolution {
        /// The dimension with the coarsest rounding.
        dimension: String,
        /// The least difference of two values.
        resolution: f64,
        /// The standard deviation of the values.
        sigma: f64,
        /// The number of different values.
        distinct: usize,
        /// Further dimensions with coarse rounding.
        others: Vec<String>,
    };
    /// Measured values outside the tolerance band.
    OutsideBand = "outside-band" by measured::outside_band {
        /// The dimension.
        dimension: String,
        /// The number of values outside.
        count: usize,
        /// All values.
        values: usize,
        /// The first of them with their lines.
        first: Vec<(f64, u64)>,
        /// True if the mean lies outside too.
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
    /// The journal holds points within the tolerance bands at which the model had no value in earlier runs.
    RecordedFailures = "recorded-failures" by model::recorded_failures {
        /// The characteristic that has no value there.
        characteristic: String,
        /// Points without a value that this run did not evaluate.
        failed: usize,
        /// The first of them, in words.
        point: String,
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
    /// Values of a built-in model lie where its formulas describe no real part.
    OutsideModel = "outside-model" by model::outside_model {
        /// The output of the model.
        output: String,
        /// The bound that was passed, and the consequence.
        reason: String,
    };
    /// An external model gave a slightly different answer to the nominal point later.
    NotRepeatable = "not-repeatable" by model::not_repeatable {
        /// The output: a characteristic, or a value that formulas use.
        output: String,
        /// The first answer. None if it had no value.
        expected: Option<f64>,
        /// The first differing answer. None if it had no value.
        found: Option<f64>,
        /// The number of differing answers.
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
        /// The first answer. None if it had no value.
        expected: Option<f64>,
        /// The first differing answer. None if it had no value.
        found: Option<f64>,
        /// The number of differing answers.
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
        /// Seconds spent on processes that failed without an answer.
        lost_s: f64,
        /// The cause of the last failure.
        cause: String,
        /// The last lines that the process wrote to stderr.
        stderr: Vec<String>,
    };
    /// Answers of an external model were not confirmed by a fresh process: they depend on the points before them, or a stop came first.
    Unconfirmed = "unconfirmed" by model::unconfirmed {
        /// The number of unconfirmed answers.
        answers: u64,
        /// True if an answer changed after other points, false if the run only ended before the check.
        changed: bool,
    };
    /// Checksums of answers in the journal do not agree.
    DamagedJournal = "damaged-journal" by model::damaged_journal {
        /// The path of the journal.
        file: String,
        /// The number of damaged answers.
        answers: usize,
    };
    /// The journal holds the answers of another model than the one that runs now.
    OutdatedJournal = "outdated-journal" by model::outdated_journal {
        /// The output that differs at the nominal dimensions: a characteristic, or a value that formulas use.
        output: String,
        /// The value in the journal. None if there was none.
        expected: Option<f64>,
        /// The value now. None if there is none.
        found: Option<f64>,
        /// Answers that were removed from the journal.
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
    /// Rounding errors of the model are not small compared with the differences.
    Noise = "noise" by model::noise {
        /// The characteristic.
        characteristic: String,
        /// The rounding error of one value, relative to sigma.
        rounding: f64,
    };
    /// Answers at points close to the means scatter.
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
        /// The dimension, or the two of a mixed derivative. Empty if every derivative is lost.
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
        /// Greatest share of the assemblies without a value. None if it is unknown.
        share: Option<f64>,
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
        /// The lowest moment that is infinite. Higher moments are infinite too.
        figure: Figure,
        /// The dimensions with infinite moments.
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
        /// True if the surrogate has these powers.
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
        /// The slopes on the left and on the right, in sigmas of the characteristic per sigma of the dimension.
        slopes: [f64; 2],
        /// The places between which the kink lies, in sigmas from the mean.
        between: [f64; 2],
        /// Further dimensions with a kink.
        others: Vec<String>,
    };
    /// Slopes of a characteristic are equal and opposite on both sides of the nominal point.
    KinkAtNominal = "kink-at-nominal" by surface::kink_at_nominal {
        /// The characteristic.
        characteristic: String,
        /// The dimensions concerned.
        dimensions: Vec<String>,
    };
    /// A characteristic of a costly model follows a choice from stock, and too few points of it have a value.
    ChoiceNotSampled = "choice-not-sampled" by surface::choice_not_sampled {
        /// The characteristic.
        characteristic: String,
        /// The choice in words.
        choice: String,
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
        /// The places as values of the dimension.
        at: Option<[f64; 2]>,
        /// Further dimensions with a jump.
        others: Vec<String>,
    };
    /// Part of the variance comes from terms that were not examined.
    InteractionsLeftOut = "interactions-left-out" by surface::interactions_left_out {
        /// The characteristic.
        characteristic: String,
        /// The share of the variance by these terms.
        share: f64,
    };
    /// Model and surrogate differ at the check points.
    UntrustedSurrogate = "untrusted-surrogate" by surface::untrusted_surrogate {
        /// The characteristic.
        characteristic: String,
        /// The share of the variance that the surrogate does not explain.
        share: f64,
        /// Points of the model that the moments are computed from instead. None if the budget did not allow any.
        sampled: Option<u64>,
    };
    /// Requirements are met by the surface only, which a strict check does not accept.
    ConditionalVerdict = "conditional-verdict" by surface::conditional_verdict {
        /// The characteristics.
        characteristics: Vec<String>,
    };
    /// The model differs from the surface at check points far from the means.
    FarResidual = "far-residual" by surface::far_residual {
        /// The characteristic.
        characteristic: String,
        /// Dimensions that deviate there, true for those that deviate upward.
        directions: Vec<(String, bool)>,
        /// Model minus surface at the farthest check point, in sigmas.
        residual: f64,
        /// Distance from the means in sigmas from which on the model may differ.
        from: f64,
        /// Share of the assemblies that may lie beyond that distance.
        share: f64,
    };
    /// The formula itself shows a change of its form within the assemblies.
    Switch = "switch" by surface::switch {
        /// The characteristic.
        characteristic: String,
        /// The part of the formula that changes.
        switch: String,
        /// The change there.
        change: Change,
        /// The probability of the smaller side.
        probability: f64,
        /// Points of a sample that lie beyond on average. None if the figures do not come from a sample.
        points: Option<f64>,
    };
    /// A pressed part rests on one set of contacts in some assemblies and on another one in others.
    ContactSwitch = "contact-switch" by surface::contact_switch {
        /// The characteristic.
        characteristic: String,
        /// The joint, in words.
        switch: String,
        /// The change there.
        change: Change,
        /// The sets of contacts with their shares.
        contacts: Vec<ContactShare>,
        /// True if the figures come from a sample.
        sampled: bool,
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
    /// A figure of the method differs from that of the model by more than three errors.
    FigureOff = "figure-off" by surface::figure_off {
        /// The characteristic.
        characteristic: String,
        /// Mean, sigma, skewness or kurtosis.
        figure: &'static str,
        /// Value of the figure by the method.
        value: f64,
        /// Value of the figure by points of the model.
        model: f64,
        /// Standard error of the value by points of the model.
        error: f64,
    };
    /// The surface distribution fails a test, and points of the model replace it.
    SurfaceLawRefuted = "surface-law-refuted" by surface::surface_law_refuted {
        /// The characteristic.
        characteristic: String,
        /// The failed test: `monotone` or `count`.
        test: &'static str,
        /// The limit at which it failed.
        limit: f64,
        /// Share of assemblies below the limit by the surface distribution.
        law: f64,
        /// Share of points below the limit.
        counted: f64,
        /// Standard error of that share.
        error: f64,
    };
    /// The estimated error is larger than the requested accuracy.
    UnderResolved = "under-resolved" by surface::under_resolved {
        /// The characteristic.
        characteristic: String,
        /// The figure with this error.
        figure: Figure,
        /// The estimated error, relative for sigma. None if it is unknown.
        error: Option<f64>,
        /// The target error.
        wanted: f64,
        /// True if the budget ended the analysis.
        budget: bool,
    };
    /// No distribution has these moments.
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
    /// The Pearson fit gives another reject rate than the best estimate.
    PearsonDiffers = "pearson-differs" by distribution::pearson_differs {
        /// The characteristic.
        characteristic: String,
        /// The reject rate by the Pearson fit.
        pearson: f64,
        /// The best estimate of the reject rate.
        rejected: f64,
        /// The error of the best estimate.
        error: f64,
    };
    /// The moments indicate a distribution with several peaks.
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
    /// Importance sampling was worse than plain points, which give the estimate instead.
    PlainFallback = "plain-fallback" by sample::plain_fallback {
        /// The characteristic.
        characteristic: String,
        /// The limit.
        limit: f64,
        /// Plain points.
        points: u64,
    };
    /// A few points decide the moments of a sample, or rare assemblies do that the sample hardly contains.
    UnsettledMoments = "unsettled-moments" by sample::unsettled_moments {
        /// The characteristic.
        characteristic: String,
        /// Mean, sigma, skewness or kurtosis, the lowest first.
        figures: Vec<&'static str>,
        /// Points of the sample.
        points: u64,
        /// The part of the largest point in the sum behind the error of the first figure.
        largest: f64,
        /// The part of the ten largest points in that sum.
        ten_largest: f64,
        /// The switch beyond which assemblies decide that are rare in the sample. None if points of the sample decide.
        switch: Option<String>,
    };
    /// The standard errors of a sample are larger than requested.
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
        /// The end of the search.
        ended: Ended,
        /// Points of the search without a value.
        failed: usize,
        /// The error at the first of them.
        failure: Option<String>,
        /// Interval that contains every assembly, and the number of boxes of interval arithmetic; for formulas only.
        bounds: Option<([f64; 2], usize)>,
    };
    /// Dimensions with a fit of ISO 286 were given a free tolerance.
    FitReplaced = "fit-replaced" by allocation::fit_replaced {
        /// The dimensions.
        dimensions: Vec<String>,
    };
    /// The model was not evaluated at the tolerances that were found.
    NotConfirmed = "not-confirmed" by allocation::not_confirmed;
    /// A cost curve is not convex, so that there may be several optima.
    CostNotConvex = "cost-not-convex" by allocation::cost_not_convex {
        /// The dimensions.
        dimensions: Vec<String>,
    };
    /// Monte Carlo at the tolerances that were found misses a requirement.
    ConfirmationMisses = "confirmation-misses" by allocation::confirmation_misses {
        /// The characteristic.
        characteristic: String,
        /// `yield`, `cpk`, `sigma` or `worst-case`.
        requirement: &'static str,
        /// The required amount.
        required: f64,
        /// The interval by the sample, three errors on either side.
        interval: [f64; 2],
    };
    /// Monte Carlo at the tolerances that were found misses the required joint yield.
    JointConfirmationMisses = "joint-confirmation-misses" by allocation::joint_confirmation_misses {
        /// The required joint yield.
        required: f64,
        /// The interval by the sample, three errors on either side.
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
        /// The time limit in seconds, if it stopped the run and is known.
        limit_s: Option<f64>,
        /// The amount done until then.
        done: u64,
        /// The amount planned, if it is known.
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
        /// The number of points.
        count: usize,
        /// The file to which the points were written, if one was named.
        written: Option<String>,
    };
    /// Answers in the table belong to no point of the plan.
    UnmatchedPoints = "unmatched-points" by run::unmatched_points {
        /// The number of answers.
        count: usize,
        /// The first lines with such answers.
        lines: Vec<usize>,
    };
    /// Only the points of the first stage are known.
    FirstStageOnly = "first-stage-only" by run::first_stage_only;
}
