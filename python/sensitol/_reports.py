"""The types of results, one class for each object of a report. Made from the schema of reports by tools/reports.py."""

from __future__ import annotations

from typing import Any, Dict, List, Literal, Optional, Tuple, Union

from ._records import Fitted, Record, Result

class Account(Record):
    """Shapes of the dimensions that `auto` found, and the use of its points. The text form is a sentence."""

    checks: int
    """Check points of the surrogate."""
    curved: List[str]
    """Dimensions that act along parabolas: two points each."""
    evaluations: int
    """Evaluations of the search, without those of `samples`."""
    examined: int
    """Interactions that were examined one by one."""
    from_formulas: int
    """Interactions that are known from the formulas, in every characteristic."""
    full_evaluations: int
    """Evaluations that every second derivative would take, `N² + N + 1`."""
    possible_interactions: int
    """Possible interactions."""
    probes: int
    """Probes of one or two points that move all dimensions to search for interactions."""
    refined: List[str]
    """Dimensions that need more than a parabola: four points each."""
    rest: Literal['reached', 'budget', 'exhausted', 'stopped']
    """Reason of the end of the search."""
    samples: Optional[int]
    """Points of the model from which the moments follow, if the surrogate was not trusted."""
    straight: List[str]
    """Dimensions that act along straight lines: two points each."""
    varying: int
    """Dimensions that vary and matter."""


class Advice(Record):
    """Action advised by a warning or an error. Every front end shows it in its own words: the command line as
    options, a page as sentences, JSON as `{ "action": ... }` with the fields. `Display` writes a plain sentence
    without the name of any option.
    """

    action: Literal['use-method', 'raise-budget', 'check-limits', 'set-budget', 'raise-time-limit', 'limit-time', 'sample', 'sample-rare-events', 'sample-plainly', 'more-points', 'analyze', 'smaller-step', 'use-differences', 'include-fixed-dimensions', 'leave-out-correlation', 'use-formula', 'check-names', 'check-units', 'write-direction-as-rim', 'check-nominal', 'check-position', 'check-inputs', 'check-configuration', 'check-moments', 'check-column', 'find-missing-values', 'remove-wrong-values', 'measure-more', 'measure-finer', 'repair-model', 'read-model-log', 'name-model-files', 'keep-defined', 'reset-model', 'run-again', 'signed-measure', 'nearer-datum', 'larger-unit', 'ordinary-unit', 'tighten-solver', 'split-branches', 'return-components', 'nearest-fit', 'require-more', 'analyze-written-study', 'write-costs', 'name-movable-dimensions', 'write-missing-points', 'append-answers', 'analyze-stages', 'edit-study']
    methods: Optional[List[str]]
    """The methods, the best first."""
    points: Optional[int]
    """The number of points. None if the usual number suffices."""
    dimension: Optional[str]
    """The dimension with the shorter step. None for all."""
    values: Optional[int]
    """The total number of parts."""
    file: Optional[str]
    """The file of the written points."""


class AllocatedCharacteristic(Record):
    """One characteristic before and after."""

    after: Optional[CharacteristicResult]
    """Results of `analyze` at the tolerances found; None if none were found."""
    before: CharacteristicResult
    """Results of `analyze` at the tolerances before."""
    name: str
    """Name of the characteristic."""
    unit: Optional[str]
    """Unit of the characteristic."""


class AllocatedTolerance(Record):
    """One dimension with a cost."""

    after: float
    """Half band after."""
    at_bound: Optional[Literal['min', 'max']]
    """Bound that the tolerance has met."""
    before: float
    """Half band before."""
    bound_price: Optional[float]
    """Saving per unit by which that bound is widened, with all else unchanged. None within the bounds, and if it is
    not known.
    """
    contributions: List[AllocatedToleranceContributions]
    """Share of each characteristic's variance."""
    cost_after: Optional[float]
    """Cost after."""
    cost_before: Optional[float]
    """Cost before. None if no process holds the tolerance."""
    deviations: AllocatedToleranceDeviations
    """Lower and upper deviation from the nominal before and after, if there is a band."""
    dimension: str
    """The dimension."""
    process: Optional[str]
    """Name of the process, if several compete."""
    unit: Optional[str]
    """Unit of the dimension."""


class AllocatedToleranceContributions(Record):
    """Something of a characteristic, with its name."""

    after: Optional[float]
    """After."""
    before: Optional[float]
    """Before."""
    characteristic: str
    """The characteristic."""


class AllocatedToleranceDeviations(Record):
    """Something before and after."""

    after: Optional[List[float]]
    """After."""
    before: Optional[List[float]]
    """Before."""


class AllocationResult(Result):
    """The report of an allocation. Unknown values are None, never 0."""

    attainable: Optional[AllocationResultAttainable]
    """The requirement that cannot be kept, and the best that can be had."""
    cached: int
    """Points whose answers were known from an earlier run."""
    characteristics: List[AllocatedCharacteristic]
    """Every characteristic before and after."""
    command: str
    """The command that made the report."""
    confirmation: Optional[Confirmation]
    """The model itself at the tolerances found, by Monte Carlo."""
    confirmed: bool
    """True if the model was evaluated at the tolerances found."""
    cost_after: Optional[float]
    """All costs after."""
    cost_basis: Literal['given', 'tolerance-unit', 'constant-precision', 'equal-shares']
    """Source of the costs: given, or relative to the tolerance unit of ISO 286."""
    cost_before: Optional[float]
    """All costs before; None where no process holds some tolerance, and without costs."""
    cost_unrounded: Optional[float]
    """The cost of the cheapest tolerances without rounding to steps or standard grades; None without such rounding."""
    dimensions_table: Optional[str]
    """The entries of dimensions that have changed, ready to paste into the study."""
    evaluations: int
    """Points sent to the model, including those sent again."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model. None if there is no external model."""
    failed: int
    """Points without a value of at least one characteristic."""
    front: List[FrontPoint]
    """Cost against the requirements."""
    goal: Goal
    """The objective, and the most that may be spent on it."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[JointKept]
    """Required joint yield of all characteristics with limits; None if none is required."""
    joint_yield: AllocationResultJointYield
    """The share of assemblies that keep all limits at once; None with fewer than two characteristics with limits."""
    loosest_scaling: AllocationResultLoosestScaling
    """Factor of all tolerances at which some requirement is just kept."""
    loss: AllocationResultLoss
    """The part of them that is quality loss and scrap; None without losses."""
    method: str
    """The method by which derivatives were taken."""
    model_points: int
    """Points of a cheap model by which moments were corrected, worst cases followed and tolerances tried, beside the
    evaluations.
    """
    proof: Proof
    """The evidence that nothing is cheaper."""
    recentred: List[AllocationResultRecentred]
    """Nominal values that have moved."""
    requirements: List[AllocationResultRequirements]
    """Every requirement."""
    retried: int
    """Points sent again, because an answer was a failure or was not trusted."""
    rounds: int
    """Number of times that derivatives were taken."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, if random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    setups: List[SetUp]
    """Machines of the processes, with the cost of their setup, which is part of the cost."""
    shadow_prices: List[AllocationResultShadowPrices]
    """Shadow prices of limits and required sigmas."""
    stages: int
    """Batches in which points were sent."""
    status: Literal['optimal', 'local-optimum', 'almost-optimal', 'infeasible', 'no-feasible-point-found', 'inconclusive', 'out-of-time']
    """`optimal`, `local-optimum`, `almost-optimal`, `infeasible`, `no-feasible-point-found`, `inconclusive` or `out-
    of-time`.
    """
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Reason for an early end. None if the run was completed."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    title: Optional[str]
    """The study's title."""
    tolerances: List[AllocatedTolerance]
    """Every dimension with a cost, in the study's order."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Warnings about assumptions that fail."""

    def __getitem__(self, name: str) -> AllocatedCharacteristic:
        """The characteristic of this name."""
        found: AllocatedCharacteristic = self._named(name)
        return found


class AllocationResultAttainable(Record):
    """Something of a characteristic, with its name."""

    because: List[str]
    """Dimensions without cost that alone break the requirement, most harmful first. The list is empty if the others
    contribute too.
    """
    best: Optional[float]
    """Best value within the bounds of the tolerances, in the measure of the requirement."""
    characteristic: str
    """The characteristic."""
    joint: bool
    """True if it is the joint yield of all characteristics with limits."""
    required: float
    """Required amount. For `rss` and `worst-case`, the fraction of the limits used, at most 1."""
    requirement: str
    """Name of the requirement: `yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    together: bool
    """True if it could be kept as the only requirement."""
    unit: Optional[str]
    """Unit of the characteristic."""


class AllocationResultJointYield(Record):
    """Something before and after."""

    after: Optional[JointYield]
    """After."""
    before: Optional[JointYield]
    """Before."""


class AllocationResultLoosestScaling(Record):
    """Something before and after."""

    after: Optional[float]
    """After."""
    before: Optional[float]
    """Before."""


class AllocationResultLoss(Record):
    """Something before and after."""

    after: Optional[float]
    """After."""
    before: Optional[float]
    """Before."""


class AllocationResultRecentred(Record):
    """Something of a dimension, with its name."""

    after: float
    """Nominal value after."""
    before: float
    """Nominal value before."""
    dimension: str
    """The dimension."""
    unit: Optional[str]
    """Unit of the dimension."""


class AllocationResultRequirements(Record):
    """Something of a characteristic, with its name."""

    after: Optional[float]
    """Value at the tolerances found."""
    before: Optional[float]
    """Value before."""
    characteristic: str
    """The characteristic."""
    interval: Optional[List[Optional[float]]]
    """Interval of the value, with None for an unbounded end; None if the value is not known."""
    met: Optional[bool]
    """True if the requirement is kept; None if that is not known, and if no tolerances were found."""
    met_before: Optional[bool]
    """True if the requirement was kept before; None if that is not known."""
    required: float
    """Required amount. For `rss` and `worst-case`, the fraction of the limits used, at most 1."""
    requirement: str
    """Name of the requirement: `yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    sampled: Optional[AllocationResultRequirementsSampled]
    """Verdict from a sample of the model at the tolerances found; for a worst case from points in the box of the
    bands. None if there is no sample, and for rss, which samples cannot judge.
    """
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """Verdict on the requirement; None if no tolerances were found."""
    verdict_before: Literal['met', 'missed', 'inconclusive']
    """Verdict on the requirement before."""


class AllocationResultRequirementsSampled(Record):
    """Verdict of a sample on a requirement, as it is written."""

    interval: Optional[List[Optional[float]]]
    """Interval of the value, three errors on either side; None if the value is not known."""
    value: Optional[float]
    """Value from the sample."""
    verdict: Literal['met', 'missed', 'inconclusive']
    """Verdict on the requirement from the interval."""


class AllocationResultShadowPrices(Record):
    """Something of a characteristic, with its name."""

    both: Optional[float]
    """Saving per unit by which both limits, or the only one, are widened. None if it differs from the cost of
    narrowing them.
    """
    characteristic: str
    """The characteristic."""
    lower: Optional[float]
    """Saving per unit by which the lower limit goes down."""
    narrow: Optional[float]
    """Extra cost per unit by which the limits are narrowed."""
    sigma: Optional[float]
    """Saving per unit by which a required sigma grows."""
    upper: Optional[float]
    """Saving per unit by which the upper limit goes up."""
    widen: Optional[float]
    """Saving per unit by which the limits are widened or a required sigma grows, with all else unchanged."""


class AnalysisResult(Result):
    """The report of an analysis, as `--json` prints it. Unknown values are None, never 0."""

    account: Optional[Account]
    """The findings of `auto` and the use of its points; None for any other method."""
    basis: Literal['exact', 'differences', 'least-squares', 'quadrature']
    """The basis of the moments."""
    cached: int
    """Points whose answers were known from an earlier run."""
    characteristic_correlation: List[OutputCorrelation]
    """Correlations of every two characteristics. Empty with one characteristic, and with more than 40."""
    characteristics: List[CharacteristicResult]
    """The results of every characteristic, in the problem's order."""
    command: str
    """The command that made the report."""
    correlation: List[Pair]
    """The dimensions that vary together."""
    derivatives: Optional[Literal['exact', 'difference']]
    """Source of the derivatives from which the moments follow. None if they follow from none."""
    dimensions: List[DimensionResult]
    """The dimensions, in the study's order."""
    evaluations: int
    """Points sent to the model, including those sent again."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model. None if there is no external model."""
    failed: int
    """Points without a value of at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[Judged]
    """Verdict on the target for the joint yield. None if there is no such target."""
    joint_yield: Optional[Verified]
    """Share of assemblies that keep the limits of all characteristics at once, with its error. None if fewer than
    two characteristics have limits, or if it is unknown.
    """
    joint_yield_interval: Optional[List[float]]
    """Interval of the joint yield: two errors on either side, widened by the uncertainty of measured samples. None
    if it is unknown.
    """
    method: str
    """Method that was run. For `auto`, the method that it chose."""
    retried: int
    """Points sent again, because an answer was a failure or was not trusted."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, if random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Reason for an early end. None if the run was completed."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    title: Optional[str]
    """The study's title."""
    varying: int
    """Dimensions that vary and on which some characteristic can depend, N."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Warnings about assumptions that fail, in the study or in the analysis."""

    def __getitem__(self, name: str) -> CharacteristicResult:
        """The characteristic of this name."""
        found: CharacteristicResult = self._named(name)
        return found


class Beyond(Record):
    """Results beyond one limit."""

    bounds: Optional[List[float]]
    """Probability if no point without a value lies beyond, and if all of them do. None if every point has a value."""
    design_point: Optional[DesignPoint]
    """Most likely assembly at the limit, from the surrogate and from rejects of the model. None if none is known."""
    effective_samples: float
    """Number of equally weighted points with the same information: `(sum of weights)^2 / sum of their squares`."""
    greatest_part: Optional[float]
    """Part of the estimate that the heaviest point has. If it is large, the surrogate has missed the place of the
    rejects.
    """
    hits: int
    """Number of points beyond the limit."""
    interval: List[float]
    """95 % interval of the probability."""
    limit: float
    """Limit as it was given."""
    plain_samples: Optional[float]
    """Number of points of a plain random sample with the same standard error."""
    ppm: Optional[float]
    """Probability in parts per million."""
    probability: Optional[float]
    """Probability beyond the limit. None if no point lies there. The interval is then a bound, for a corner that
    none of the explored points met.
    """
    standard_error: Optional[float]
    """Standard error of the probability."""
    unmet: Optional[Unmet]
    """Bound of the probability of rejects that no point met. None if plain points make the estimate, whose interval
    has it already, and if no explored point has a value.
    """


class Capability(Record):
    """Capability as serialised in results."""

    cp: Optional[float]
    """Width of the limits, divided by six sigma."""
    cp_percentile: Optional[float]
    """Width of the limits, divided by the width between the quantiles 0.00135 and 0.99865."""
    cpk: Optional[float]
    """Distance of the nearer limit, divided by three sigma."""
    cpk_percentile: Optional[float]
    """Distance of the nearer limit from the median, divided by that of the quantile on its side."""
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    sigma_level: Optional[float]
    """Distance from the mean of a normal distribution, in sigmas, beyond which one side holds the share of all
    rejects.
    """
    yield_: Optional[float]
    """Share of assemblies within the limits."""


class CharacteristicResult(Fitted):
    """Figures of one characteristic, with their evidence. Unknown values are None."""

    basis: FigureBases
    """Bases of the figures: `proof`, `points` of the model, or the `surface`."""
    coefficient_of_variation: Optional[Verified]
    """Sigma divided by the magnitude of the mean; None if unknown, and if the mean may be 0."""
    conditional_yield: Optional[ConditionalYield]
    """Yield of the assemblies that keep the limits of the characteristic that this one is given. None if it is given
    none, or if it is unknown.
    """
    constant: bool
    """True if the characteristic depends on nothing that varies, so that it has a single value."""
    coverage: Optional[CoverageIntervals]
    """Intervals that hold the requested share of assemblies. None if none was requested."""
    cp: Optional[float]
    """Width of the limits, divided by six sigma."""
    cp_percentile: Optional[float]
    """Width of the limits, divided by the width between the quantiles 0.00135 and 0.99865."""
    cpk: Optional[float]
    """Distance of the nearer limit, divided by three sigma."""
    cpk_percentile: Optional[float]
    """Distance of the nearer limit from the median, divided by that of the quantile on its side."""
    description: Optional[str]
    """Description in a few words."""
    distribution: Optional[Law]
    """Distribution of the Pearson system with these moments, or the reason why there is none."""
    distribution_free_yield: Optional[DistributionFreeYield]
    """Yield over all distributions of dimensions of which only the band is promised. None if there is none."""
    drawing: Optional[str]
    """Number of the drawing."""
    error_estimate: Optional[ErrorEstimate]
    """Estimated errors of these results. None if there are no moments."""
    examined_interactions: int
    """Number of interactions that were examined, or are known from the formula."""
    feature: Optional[str]
    """Feature of the part, or its number on the drawing."""
    inflated_rss: Optional[float]
    """1.5 times the RSS (Bender 1962, 1968), or by the factors of the study."""
    inspection: Optional[InspectionRisks]
    """Risks of the inspection. None if there is no gauge."""
    interactions: List[Interaction]
    """Examined interactions, strongest first."""
    interactions_remainder: Optional[Remainder]
    """Sum of the interactions that are not listed one by one. None if all are listed."""
    kurtosis: Optional[float]
    """Value for the fourth standardised moment, which is 3 for a normal."""
    least_squares: Optional[Residual]
    """Residual of a fitted surface at the values that it was fitted to. None if nothing was fitted."""
    left_out_share: Optional[float]
    """Share of the variance that no contribution explains. None if it is unknown."""
    lower: Optional[float]
    """Lower limit."""
    mean: Optional[float]
    """Value for the expected value."""
    mean_shift_rss: Optional[float]
    """RSS with means that are all shifted in the unfavourable direction by half of their half-widths, 1.5 sigma of
    3: `0.5 sum of |slope| x half-width + 0.5 rss` (Greenwood and Chase 1987 with m = 0.5).
    """
    met: Optional[bool]
    """True if the target yield is met. None if there is no target, and if it is unknown."""
    middle: Optional[float]
    """Middle of the worst case and of the RSS: the value of a linear model with every dimension in the middle of its
    band. It is the nominal value if all bands are symmetric.
    """
    model_sampling: Optional[SampledModel]
    """Points of the model from which the moments follow, in place of a surrogate that was not trusted."""
    name: str
    """Name of the characteristic."""
    nominal: Optional[float]
    """Value at the nominal dimensions."""
    normal_fit: Optional[Capability]
    """Capability by the normal distribution with the same mean and sigma."""
    part: Optional[str]
    """Part that it belongs to."""
    pearson_fit: Optional[Capability]
    """Capability by the Pearson fit."""
    points_to_decide: Optional[int]
    """Plain points of the model that would decide the target yield; None unless the verdict comes from an unrefuted
    surface.
    """
    possible_interactions: int
    """Number of possible interactions."""
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_above_interval: Optional[List[float]]
    """95 % interval of the assemblies above the upper limit alone, per million, in the same form."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    ppm_below_interval: Optional[List[float]]
    """95 % interval of the assemblies below the lower limit alone, per million: 0 to 0 if a proof excludes them,
    None if it is unknown.
    """
    quantiles: Optional[QuantileEstimates]
    """Quantiles with their errors. None if nothing is known of the distribution."""
    requirements: List[Judged]
    """Verdicts on all requirements, the target yield included."""
    revision: Optional[str]
    """Revision of the drawing."""
    rss: Optional[float]
    """`sqrt(t'R t)` with `t` = slope x half-width (three sigma if a dimension has no band) and the correlation `R`.
    Without correlation it is the root of the sum of squares.
    """
    sampling_interval: Optional[SamplingInterval]
    """Uncertainty of the results because measured dimensions are known by samples. None if there are no measured
    dimensions.
    """
    sensitivities: List[Sensitivity]
    """Sensitivities to every dimension of the problem, in order."""
    sigma: Optional[float]
    """Value for the standard deviation."""
    sigma_level: Optional[float]
    """Distance from the mean of a normal distribution, in sigmas, beyond which one side holds the share of all
    rejects.
    """
    six_sigma: Optional[float]
    """`sqrt(sum of (slope x sigma/(1 - k))^2)` with the sigma of a lot and the shift `k` of its mean in half-widths,
    from `cpk`, `drift` or `shift` (Harry and Stewart 1988). It is a sigma, not an interval. None if every mean is
    in the middle of its band, or one is at an end.
    """
    skewness: Optional[float]
    """Value for the third standardised moment."""
    sobol: Optional[SobolIndices]
    """Source of the Sobol' indices of the `sensitivities`. None if the characteristic does not vary."""
    surface_law: Optional[SurfaceLaw]
    """Results of the surface distribution. None if the moments follow from no surface."""
    surrogate_sampling: Optional[Sampled]
    """Standard errors of the moments from sampling the surrogate of correlated inputs. None if the moments are
    exact.
    """
    tail_sampling: Optional[SampledTail]
    """Points of the model from which the yield follows, in tails at whose limits check points refute the surface."""
    target_yield: Optional[float]
    """Share of assemblies that must keep the limits."""
    unfinished: bool
    """True if the run was stopped before all planned points were evaluated. There is no verdict then."""
    unit: Optional[str]
    """Unit, which is shown and never converted."""
    upper: Optional[float]
    """Upper limit."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """Verdict on the target yield. None if there is no target."""
    verification: Optional[Verification]
    """Verification of these results by the model itself. None if they were not verified."""
    without_value: int
    """Evaluated points without a value of the characteristic."""
    worst_case: WorstCase
    """Intervals that no assembly leaves."""
    yield_: Optional[float]
    """Share of assemblies within the limits."""
    yield_interval: Optional[List[float]]
    """Interval of the yield; None if unknown."""
    yield_source: Optional[Literal['proof', 'samples', 'surface-law', 'pearson']]
    """Source of the yield. None if there is no yield."""


class ComparedCharacteristic(Record):
    """One characteristic."""

    methods: List[ComparedMethod]
    """The methods, fewest evaluations first."""
    name: str
    """Name of the characteristic."""
    reference: SimulatedCharacteristic
    """The reference for all methods."""


class ComparedMethod(Record):
    """One method on one characteristic."""

    cached: int
    """Evaluations that were known already."""
    engine_s: float
    """Seconds besides."""
    error_vs_reference: ErrorVsReference
    """Difference from the reference."""
    evaluation_s: float
    """Seconds within the model."""
    evaluations: int
    """Points that it takes."""
    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """Expected value."""
    method: str
    """Name of the method; that of samples has the number of points."""
    pareto: bool
    """True if no other method has a smaller error for as many evaluations or fewer."""
    run: RunSummary
    """The cost of its run by itself."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """Verdict on the target yield; None without a target."""
    yield_: Optional[float]
    """Share within the limits."""


class ComparisonResult(Result):
    """The report of a comparison, as `--json` prints it. Unknown values are None, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristics: List[ComparedCharacteristic]
    """The results of every characteristic requested."""
    command: str
    """The command that made the report."""
    evaluations: int
    """Points sent to the model, including those sent again."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model. None if there is no external model."""
    failed: int
    """Points without a value of at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    not_run: List[NotRun]
    """Methods that were not run, and why."""
    reference_method: str
    """Sampler that drew them."""
    reference_samples: int
    """Points of the reference."""
    retried: int
    """Points sent again, because an answer was a failure or was not trusted."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, if random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Reason for an early end. None if the run was completed."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    title: Optional[str]
    """The study's title."""
    wall_s: float
    """Time from the first evaluation to the result."""

    def __getitem__(self, name: str) -> ComparedCharacteristic:
        """The characteristic of this name."""
        found: ComparedCharacteristic = self._named(name)
        return found


class ConditionalYield(Record):
    """Yield of the assemblies that keep the limits of another characteristic: `P(both kept) / P(other kept)`."""

    given: str
    """Characteristic whose limits decide which assemblies count."""
    interval: Optional[List[float]]
    """95 % interval of the share. None if the uncertainty of measured samples is unknown."""
    yield_: float
    """Share of these assemblies that keep the own limits."""


class Confirmation(Record):
    """Monte Carlo at the tolerances found."""

    characteristics: List[SimulatedCharacteristic]
    """Every characteristic, as `simulate` reports it."""
    samples: int
    """Points."""


class Control(Record):
    """Effect of a surrogate as control variate."""

    evaluations: int
    """Evaluations of the surrogate, for all characteristics together."""
    method: str
    """Method of the surrogate."""
    reduction: Reduction
    """Reduction of standard errors."""


class CoverageIntervals(Record):
    """Two intervals that hold a share `p` of all assemblies. Source: JCGM 101:2008, 5.3.2 to 5.3.4 and 7.7."""

    equal_tails: List[float]
    """Interval with equal shares of assemblies below and above it."""
    equal_tails_errors: List[Optional[float]]
    """Errors of the ends of `equal_tails`; None if unknown."""
    probability: float
    """Share of assemblies that each interval holds."""
    shortest: List[float]
    """Shortest interval."""
    shortest_errors: List[Optional[float]]
    """Errors of the ends of `shortest`, as quantiles; None if unknown."""
    source: Literal['proof', 'samples', 'surface-law', 'pearson']
    """Source of the intervals: that of the quantiles."""


class DesignPoint(Record):
    """Most likely assembly at a limit."""

    distance: float
    """Distance from the middle, in standard deviations of independent normal variables."""
    values: List[float]
    """Value of every dimension, in the problem's order."""


class DimensionResult(Record):
    """One dimension as the analysis took it."""

    degrees: Optional[float]
    """Degrees of freedom of its standard uncertainty; None if the study gives none."""
    description: Optional[str]
    """Description in a few words."""
    distribution: Optional[str]
    """The kind of its distribution; None when it does not vary."""
    drawing: Optional[str]
    """Number of the drawing."""
    feature: Optional[str]
    """Feature of the part, or its number on the drawing."""
    mean: float
    """Mean."""
    name: str
    """Name of the dimension."""
    nominal: float
    """The value on the drawing."""
    part: Optional[str]
    """Part that it belongs to."""
    revision: Optional[str]
    """Revision of the drawing."""
    sigma: float
    """Standard deviation."""
    tolerance: Optional[List[float]]
    """Lower and upper deviation from the nominal."""
    unit: Optional[str]
    """Unit of the dimension."""
    zone: Optional[str]
    """The circular zone of which it is a coordinate."""


class DistributionFreeYield(Record):
    """Least and greatest yield, whatever the distribution of some dimensions within their bands. Figures beside it,
    such as sigma and the quantiles, are those of uniform distributions in their place.
    """

    dimensions: List[str]
    """Names of the dimensions that may have any distribution."""
    interval: Optional[List[float]]
    """Least and greatest yield. None if they are unknown: bounds need a linear formula, or a cheap model with one
    such dimension.
    """
    proven: bool
    """True if the interval is proven, as for linear formulas. False if it comes from points of the model, or is
    unknown.
    """
    worst: Optional[List[List[float]]]
    """Values and shares of a distribution with the least yield. None if several dimensions may have any
    distribution.
    """


class Empirical(Record):
    """Distribution that is known by a sample."""

    family: str
    """Always `empirical`."""
    quantiles: Dict[str, Optional[float]]
    """Quantiles."""


class ErrorEstimate(Record):
    """Estimated error of each result, in the unit of the result; None if the error is unknown."""

    kurtosis: Optional[float]
    """Error of the kurtosis."""
    mean: Optional[float]
    """Error of the mean."""
    sigma: Optional[float]
    """Error of sigma."""
    skewness: Optional[float]
    """Error of the skewness."""
    sources: List[ErrorSource]
    """Sources that the estimate is made of."""
    yield_: Optional[float]
    """Error of the share within the limits."""


class ErrorSource(Record):
    """Source of an estimated error."""

    kind: Literal['checked', 'powers', 'taylor', 'curvature', 'exact-pairs', 'similar-pairs', 'unknown-pairs', 'triples', 'scatter', 'lost', 'proven', 'sampled']
    points: Optional[int]
    """Number of check points with a value."""
    nodes: Optional[int]
    """Nodes of the axes with the fewest, including the mean."""
    pairs: Optional[int]
    """Number of pairs that were not examined."""
    degree: Optional[int]
    """Degree of the polynomial that the formula is."""


class ErrorVsReference(Record):
    """Errors of a method against the reference: that of the mean in sigmas, that of sigma relative, the others
    absolute.
    """

    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """Expected value."""
    overall: Optional[float]
    """Overall error, in sigmas: root of the sum of squares of the errors of mean and sigma. None if one of them is
    unknown.
    """
    reference_standard_error: Figures
    """Standard errors of the reference, in the same units. Differences up to twice these are not resolved."""
    resolved: bool
    """True if the overall error exceeds the part that may be due to the reference."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    yield_: Optional[float]
    """Share within the limits."""


class EstimatedQuantile(Record):
    """A quantile and its error."""

    error: Optional[float]
    """Error of the value: the true quantile lies within three of these. None if it is unknown."""
    value: float
    """Value of the characteristic."""


class EstimatedShare(Record):
    """Estimated share: of the variance, or of all parts."""

    error: Optional[float]
    """Error of the share: the true value lies within three of these. None if it is unknown."""
    value: float
    """Estimated share. An estimate from a sample may be below 0 by its error."""


class EvaluatorSummary(Record):
    """Starts, crashes and retries of the processes of an external model since it was made."""

    crashes: int
    """Processes that ended while points were under way, or before they were ready."""
    garbage: int
    """Lines that were not valid answers."""
    lost_s: float
    """Seconds from the last answer of each failed process until its replacement was ready."""
    retried: int
    """Points that were sent again."""
    starts: int
    """Processes that were started, including the first one of every worker."""
    timeouts: int
    """Deadlines that were missed."""
    unconfirmed: int
    """Answers that no fresh process confirmed: they depend on the points before them, or the run ended before their
    check. They have no value, or entered results before that was known.
    """


class ExtremesAt(Record):
    """Places of the extremes."""

    lower: Dict[str, float]
    """Values of the dimensions at the least value."""
    upper: Dict[str, float]
    """Values of the dimensions at the greatest value."""


class FactorIndices(Record):
    """Dimensions that vary together, as one factor."""

    dimensions: List[str]
    """Names of the dimensions."""
    first_order: Optional[EstimatedShare]
    """Part of the variance that the factor explains alone."""
    total: Optional[EstimatedShare]
    """Part of the variance with all interactions of the factor."""


class FarResidual(Record):
    """A difference between model and surface that check points met far from the means."""

    from_: float
    """Distance in sigmas from which on the model may differ."""
    residual: Optional[float]
    """Model minus surface in sigmas at the farthest check point. None if the model has no value there."""
    share: float
    """Share of the assemblies that may lie beyond that distance."""


class FigureBases(Record):
    """The bases of the figures of a characteristic. None for a figure that is unknown."""

    moments: Optional[Literal['proof', 'points', 'surface']]
    """Basis of mean, sigma, skewness and kurtosis."""
    quantiles: Optional[Literal['proof', 'points', 'surface']]
    """Basis of the quantiles."""
    yield_: Optional[Literal['proof', 'points', 'surface']]
    """Basis of the yield and of the reject rates."""


class Figures(Record):
    """Results of a method for one characteristic. Unknown values are None."""

    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """Expected value."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    yield_: Optional[float]
    """Share within the limits."""


class FoundSwitch(Record):
    """A switch with assemblies within eight sigmas on both of its sides."""

    kind: Literal['kink', 'jump', 'edge', 'pole']
    """Behaviour of the output at the switch."""
    name: str
    """Part of the formula that causes it, as written there."""
    probability: float
    """Probability of the smaller side."""


class FrontPoint(Record):
    """Point of the front: the cheapest tolerances for a requirement."""

    cost: Optional[float]
    """Cost of the tolerances. None if the requirement cannot be kept."""
    required: List[RequiredOf]
    """Required amount of every characteristic with a requirement, in the order of the problem. The joint yield comes
    last.
    """
    tolerances: Optional[List[float]]
    """Half bands, in the order of `Allocation::tolerances`."""


class Goal(Record):
    """Objective of an allocation."""

    kind: Literal['least-cost', 'most-cpk', 'fewest-rejects']
    cost_limit: Optional[float]
    """Greatest amount that may be spent."""


class Histogram(Record):
    """Counts of values in intervals."""

    counts: List[int]
    """Number of values in each interval."""
    edges: List[float]
    """Ends of the intervals, ascending: one more than there are intervals."""


class IndexEstimate(Record):
    """Estimate of an index with its uncertainty."""

    interval: List[float]
    """95 % interval of the index."""
    standard_error: float
    """Standard error of the estimate."""
    value: float
    """Estimate, which may be negative if the index is near 0."""


class InspectionRisks(Record):
    """Risks of an inspection with a gauge that has an error. Shares are of all parts unless stated otherwise."""

    acceptance: List[Optional[float]]
    """Tightened limits."""
    accepted: Optional[EstimatedShare]
    """Share of parts that are accepted."""
    bad_among_accepted: Optional[EstimatedShare]
    """Share of bad parts among the accepted ones."""
    false_accept: Optional[EstimatedShare]
    """Share of parts that are bad and accepted: the consumer's risk."""
    false_reject: Optional[EstimatedShare]
    """Share of parts that are good and rejected: the producer's risk."""
    gauge: float
    """Standard deviation of the gauge."""
    guard: Optional[float]
    """Amount by which the limits are tightened. None if no guard reaches the requested rate."""


class Interaction(Record):
    """Joint effect of two dimensions."""

    dimensions: List[str]
    """Names of the two dimensions."""
    exact: bool
    """True if the derivative is exact rather than a difference."""
    mean_shift: Optional[float]
    """Mean shift by the interaction: none unless the two dimensions are correlated."""
    missing: Optional[Literal['failed', 'not-evaluated']]
    """Reason why the derivative is missing. None if it is known."""
    mixed: Optional[float]
    """Mixed second derivative at the means. None if it is missing."""
    origin: Optional[Literal['exact', 'evaluated', 'screened']]
    """Source of the share: `exact`, `evaluated`, or `screened` if it is an estimate without an evaluation of its
    own. None if there is no share.
    """
    rounding: Optional[float]
    """Largest effect of a rounding error of the characteristic on the derivative."""
    share: Optional[float]
    """Share of the variance."""


class JointKept(Record):
    """Required joint yield, and its values."""

    after: Optional[float]
    """Value at the tolerances found."""
    before: Optional[float]
    """Value before."""
    interval: Optional[List[Optional[float]]]
    """Interval of the value, with None for an unbounded end; None if the value is not known."""
    met: Optional[bool]
    """True if the requirement is kept; None if that is not known, and if no tolerances were found."""
    met_before: Optional[bool]
    """True if the requirement was kept before; None if that is not known."""
    required: float
    """Required amount. For `rss` and `worst-case`, the fraction of the limits used, at most 1."""
    requirement: str
    """Name of the requirement: `yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    sampled: Optional[JointKeptSampled]
    """Verdict from a sample of the model at the tolerances found. None if there is no sample."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """Verdict on the requirement; None if no tolerances were found."""
    verdict_before: Literal['met', 'missed', 'inconclusive']
    """Verdict on the requirement before."""


class JointKeptSampled(Record):
    """Verdict of a sample on a requirement, as it is written."""

    interval: Optional[List[Optional[float]]]
    """Interval of the value, three errors on either side; None if the value is not known."""
    value: Optional[float]
    """Value from the sample."""
    verdict: Literal['met', 'missed', 'inconclusive']
    """Verdict on the requirement from the interval."""


class JointYield(Record):
    """Joint yield from a sample."""

    interval: List[float]
    """95 % interval."""
    samples: int
    """Number of points of the surrogates. The model is not evaluated at them."""
    standard_error: Optional[float]
    """Standard error of the share. None if all or no points lie within the limits."""
    yield_: float
    """Share of assemblies within all limits."""


class Judged(Record):
    """Requirement with the value found, its interval and the verdict."""

    interval: Optional[List[Optional[float]]]
    """Interval of the value, an end None if it is unbounded. None as a whole if it is unknown."""
    met: Optional[bool]
    """True if the requirement is met. None if that is unknown."""
    required: float
    """Required amount. For `rss` and `worst-case`, the fraction of the limits used, at most 1."""
    requirement: str
    """Name of the requirement: `yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    value: Optional[float]
    """Value found, None if it is unknown."""
    verdict: Literal['met', 'missed', 'inconclusive']
    """Verdict from the interval."""


class Law(Record):
    """Distribution with the four moments of a characteristic."""

    at: Optional[float]
    """Value of every assembly."""
    family: Literal['point', 'pearson']
    quantiles: Optional[Dict[str, float]]
    """Quantiles of the distribution."""
    support: Optional[List[Optional[float]]]
    """Lower and upper end of the support, None if infinite."""
    type: Optional[str]
    """Type in the Pearson system: `normal`, or `I` to `VII`."""


class LawRefutation(Record):
    """Contradiction that refutes the distribution of a surface."""

    counted: float
    """Share of points below the limit."""
    error: float
    """Standard error of that share."""
    law: float
    """Share of assemblies below the limit by the distribution."""
    limit: float
    """Limit at which it failed."""
    test: Literal['monotone', 'count']
    """Failed test."""


class NotRun(Record):
    """Method that was not run, with the reason."""

    evaluations: Optional[int]
    """Evaluations that the method needs, if that is known."""
    method: str
    """Method or sample that was not run."""
    projected_s: Optional[float]
    """Time in seconds that the model would have taken, at the speed of the methods that ran."""
    reason: NotRunReason
    """Reason for not running it."""


class NotRunReason(Record):
    """Reason for not running a method."""

    kind: Literal['over-reference', 'longer-than-reference', 'over-budget', 'stopped-before', 'stopped', 'impossible']
    message: Optional[str]
    """Error message in words."""


class OutputCorrelation(Record):
    """Correlation of two characteristics."""

    between: List[str]
    """Names of the two characteristics."""
    error: Optional[float]
    """Error of the coefficient; None if the model was not evaluated for it."""
    value: Optional[float]
    """Coefficient of correlation; None if one of them does not vary, or is unknown."""


class Pair(Record):
    """Pair of dimensions with its coefficient of correlation."""

    between: List[str]
    """Names of the two dimensions."""
    value: float
    """Pearson's coefficient, from -1 to 1."""


class Parameter(Record):
    """The parameter."""

    name: str
    """Name of the parameter."""
    sigma: float
    """Standard deviation of the parameter, the same at every value."""
    unit: Optional[str]
    """Unit of the parameter."""
    values: List[float]
    """Values of the parameter."""


class Proof(Record):
    """Evidence that nothing is cheaper."""

    bound: Optional[float]
    """Lower bound of the cost of every choice of processes. None if there are no lists, and if no bound is known."""
    bound_is_exact: Optional[bool]
    """True if the bound is exact, false if it rests on a sample of choices. None if there is no bound."""
    closed_form: bool
    """True if Lagrange's condition gave the result in closed form."""
    gap: Optional[float]
    """Greatest possible excess of the cost over the bound, as a part of the cost. None if there is no bound."""
    kkt_residual: Optional[float]
    """Largest violation of the conditions of Karush, Kuhn and Tucker. None if everything is chosen from lists."""
    nodes: int
    """Number of nodes of the branch and bound."""
    other_optimum: Optional[float]
    """Cost of the next cheapest optimum among them. None if there was no other."""
    reached: Optional[int]
    """Number of them that ended at the tolerances found."""
    solver: Optional[Literal['dual-newton', 'separable', 'sequential-quadratic', 'augmented-lagrangian', 'branch-and-bound', 'root', 'verified-search']]
    """Solver that found the tolerances. None if none were found."""
    starts: Optional[int]
    """Number of searches from different tolerances, if there may be several optima. None if one search is enough."""


class QuantileEstimates(Record):
    """Quantiles with their errors, all from one source."""

    cp_percentile_error: Optional[float]
    """Error of `cp_percentile`. None if it is unknown."""
    cpk_percentile_error: Optional[float]
    """Error of `cpk_percentile`. None if it is unknown."""
    source: Literal['proof', 'samples', 'surface-law', 'pearson']
    """Source of the quantiles: that of the yield, unless that is a proof about the limits only."""
    values: Dict[str, Optional[EstimatedQuantile]]
    """Quantiles by their probabilities; None at a probability that the source does not resolve."""


class RareCharacteristic(Record):
    """Results of one characteristic."""

    above: Optional[Beyond]
    """Results above the upper limit. None if there is no upper limit."""
    below: Optional[Beyond]
    """Results below the lower limit. None if there is no lower limit."""
    description: Optional[str]
    """Description in a few words."""
    drawing: Optional[str]
    """Number of the drawing."""
    error: Optional[str]
    """Error at the first of these points."""
    failed: int
    """Number of points at which the characteristic has no value."""
    feature: Optional[str]
    """Feature of the part, or its number on the drawing."""
    lower: Optional[float]
    """Lower limit."""
    met: Optional[bool]
    """True if the target yield is met. None if there is no target, and if it is unknown."""
    name: str
    """Name of the characteristic."""
    part: Optional[str]
    """Part that it belongs to."""
    requirements: List[Judged]
    """Verdicts on all requirements, the target yield included."""
    revision: Optional[str]
    """Revision of the drawing."""
    sampling_interval: Optional[SamplingInterval]
    """Error of the yield from the size of measured samples. None if no dimension is measured."""
    target_yield: Optional[float]
    """Share of assemblies that must keep the limits."""
    unfinished: bool
    """True if the run was stopped before all planned points were evaluated. There is no verdict then."""
    unit: Optional[str]
    """Unit, which is shown and never converted."""
    upper: Optional[float]
    """Upper limit."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """Verdict on the target yield. None if there is no target."""
    yield_: Optional[float]
    """Yield. None if the probability beyond one of the limits is unknown."""
    yield_interval: Optional[List[float]]
    """95 % interval of the yield."""


class RareResult(Result):
    """The report of rare events, as `--json` prints it. Unknown values are None, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristics: List[RareCharacteristic]
    """Results of every characteristic, in the problem's order."""
    command: str
    """The command that made the report."""
    correlation: List[Pair]
    """The dimensions that vary together."""
    dimensions: List[DimensionResult]
    """The dimensions, in the study's order."""
    evaluations: int
    """Points sent to the model, including those sent again."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model. None if there is no external model."""
    failed: int
    """Points without a value of at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[Judged]
    """Verdict on the target of the joint yield. None if there is no target."""
    joint_yield: Optional[float]
    """Joint yield. None for fewer than two characteristics with limits, if the means lie beyond a limit, and if no
    point lies beyond any.
    """
    joint_yield_interval: Optional[List[float]]
    """95 % interval of the joint yield."""
    method: str
    """`importance-sampling`."""
    reached: Optional[bool]
    """True if the requested accuracy was reached. None if none was requested."""
    retried: int
    """Points sent again, because an answer was a failure or was not trusted."""
    samples: int
    """Points that were drawn and evaluated."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, if random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Reason for an early end. None if the run was completed."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    surrogate: str
    """Method of the surrogate."""
    surrogate_evaluations: int
    """Evaluations of the surrogate."""
    title: Optional[str]
    """The study's title."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Warnings about assumptions that fail."""

    def __getitem__(self, name: str) -> RareCharacteristic:
        """The characteristic of this name."""
        found: RareCharacteristic = self._named(name)
        return found


class Reduction(Record):
    """Ratios of the standard errors without and with the surrogate. None if unknown, and if the denominator is 0."""

    mean: Optional[float]
    """Ratio for the mean."""
    sigma: Optional[float]
    """Ratio for sigma."""


class Remainder(Record):
    """Interactions that are not listed one by one."""

    count: int
    """Number of interactions."""
    not_evaluated: int
    """Number of interactions that were not evaluated before the run was stopped."""
    share: float
    """Sum of their shares of the variance, as far as they are known."""


class ReportedWarning(Record):
    """A warning."""

    advice: List[Advice]
    """Remedies, the most promising first."""
    at: Optional[List[float]]
    """Values of the parameter of a sweep at which the warning holds."""
    characteristic: Optional[str]
    """The characteristic concerned."""
    code: str
    """The kind."""
    data: Dict[str, Any]
    """The fields of the warning."""
    dimension: Optional[str]
    """The dimension concerned."""
    message: str
    """Cause and consequence."""


class RequiredOf(Record):
    """Requirement of a characteristic, as it is written."""

    characteristic: str
    """Name of the characteristic."""
    required: float
    """Required amount. For `rss` and `worst-case`, the fraction of the limits used, at most 1."""
    requirement: str
    """Name of the requirement: `yield`, `cpk`, `sigma`, `rss` or `worst-case`."""


class Residual(Record):
    """Residuals of a surrogate at the points that it was fitted to."""

    coefficients: int
    """Number of coefficients of the fit."""
    mean_standard_error: Optional[float]
    """Standard error of the mean that follows from the residuals; None if it is unknown or inputs are correlated."""
    points: int
    """Number of points of the fit."""
    residual_standard_error: Optional[float]
    """`sqrt(sum of squares / (points - coefficients))`, in the characteristic's unit; None if there are no more
    points than coefficients.
    """
    sigma_standard_error: Optional[float]
    """Standard error of sigma that follows from the residuals; None if it is unknown or inputs are correlated."""


class RunSummary(Record):
    """Cost of a run and the reason for its end. Every result has one."""

    cached: int
    """Points whose answers were known from an earlier run."""
    evaluations: int
    """Points sent to the model, including those sent again."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model. None if there is no external model."""
    failed: int
    """Points without a value of at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    retried: int
    """Points sent again, because an answer was a failure or was not trusted."""
    seed: Optional[int]
    """The seed, if random numbers were drawn."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Reason for an early end. None if the run was completed."""
    wall_s: float
    """Time from the first evaluation to the result."""


class SampleTails(Record):
    """Tails of a sample on every side with a limit: from 10 % to 1 ppm or the last few points, in even steps of the
    logarithm.
    """

    above: List[TailPoint]
    """Tail towards the upper limit. Empty if there is none."""
    below: List[TailPoint]
    """Tail towards the lower limit. Empty if there is none."""


class Sampled(Record):
    """Standard errors of moments that were sampled from a surrogate, not from the model."""

    kurtosis: float
    """Standard error of the kurtosis."""
    samples: int
    """Number of points sampled."""
    sigma: float
    """Standard error of sigma."""
    skewness: float
    """Standard error of the skewness."""


class SampledFactor(Record):
    """Sobol' indices of one factor."""

    dimensions: List[str]
    """Names of the dimension, or of those that vary together."""
    first_order: IndexEstimate
    """Part of the variance that the factor explains alone."""
    total: IndexEstimate
    """Part of the variance with all interactions of the factor."""


class SampledModel(Record):
    """Points of the model in place of a surrogate that was not trusted."""

    beyond: List[Optional[float]]
    """Shares of the sample below the lower and above the upper limit. None if that limit does not exist."""
    error: Optional[str]
    """Error of the first of them."""
    failed: int
    """Number of further points at which the model has no value."""
    histogram: Optional[Histogram]
    """Histogram of the sample, with some tens of intervals."""
    kurtosis: Optional[float]
    """Value for the fourth standardised moment, which is 3 for a normal."""
    left: Optional[float]
    """Share of the variance that the surrogate left unexplained at the check points. None if no surrogate is a
    control variate, because the characteristic follows a choice from stock.
    """
    mean: Optional[float]
    """Value for the expected value."""
    samples: int
    """Number of points with a value."""
    sigma: Optional[float]
    """Value for the standard deviation."""
    skewness: Optional[float]
    """Value for the third standardised moment."""
    yield_: Optional[float]
    """Share of the sample within the limits. None if there are no limits."""
    yield_interval: Optional[List[float]]
    """95 % interval of the yield."""


class SampledTail(Record):
    """Yield by importance samples of the model."""

    beyond: List[Optional[float]]
    """Shares below the lower and above the upper limit. None if that limit does not exist."""
    failed: int
    """Number of those at which the model has no value."""
    points: int
    """Number of points of the model, those that found places included."""
    yield_: float
    """Yield by these points."""
    yield_interval: List[float]
    """95 % interval of the yield, unseen rejects included."""


class SamplingInterval(Record):
    """Intervals that contain the true results with a probability of `level`, as far as the size of the measured
    samples determines them. Mean, sigma, skewness, kurtosis and Cpk: by the bias-corrected and accelerated
    bootstrap (Efron 1987) of all measured dimensions on which the characteristic depends, with the surrogate
    kept. An interval is None if the result itself is unknown, if there is no surrogate, or if a resample has no
    such figure. A resample without variation has no skewness, and a Pearson distribution fitted to it may have
    infinite moments. In a simulation: mean, sigma and Cpk by the variances that the rows of the samples explain
    among its points, with the formulas for normal distributions. Skewness and kurtosis have no interval. Share
    outside the limits: by the rows themselves. If all inputs that vary are measured, it is the interval of a
    count among as many rows as the smallest sample has (Clopper and Pearson 1934). If other dimensions vary too,
    a row counts as far as it decides a reject, and one further part may lie five sigmas out. The interval then
    contains that of the bootstrap. Coverage of the nominal 95 % by the bootstrap, measured over 300 samples each
    of a normal distribution and of one with skewness 1.2: | | | normal, 50 values | 200 | skewed, 50 values | 200
    | |---|---|--:|--:|--:|--:| | linear | mean | 92 % | 96 % | 94 % | 94 % | | | sigma | 93 % | 93 % | 87 % | 91
    % | | quadratic | mean | 93 % | 93 % | 92 % | 91 % | | | sigma | 86 % | 90 % | 78 % | 84 % | For skewness and
    kurtosis the intervals are far too narrow in samples of this size. A sample seldom has the rare values that
    decide them.
    """

    cpk: Optional[List[float]]
    """Interval of Cpk."""
    kurtosis: Optional[List[float]]
    """Interval of the kurtosis."""
    level: float
    """Probability with which each interval contains the true value."""
    mean: Optional[List[float]]
    """Interval of the mean."""
    resamples: int
    """Number of resamples; 0 if the samples were not resampled."""
    samples: Dict[str, int]
    """Measured dimensions that the characteristic depends on, with the number of values of each."""
    sigma: Optional[List[float]]
    """Interval of sigma."""
    skewness: Optional[List[float]]
    """Interval of the skewness."""
    yield_: Optional[List[float]]
    """Of the share within the limits."""


class Sensitivity(Record):
    """Effect of one dimension on a characteristic."""

    curvature_share: Optional[float]
    """Share of the variance that the curvature adds."""
    dimension: str
    """Name of the dimension."""
    exact: bool
    """True if both derivatives are exact rather than differences."""
    first: Optional[float]
    """First derivative at the mean, in units of the characteristic per unit of the dimension."""
    first_order: Optional[EstimatedShare]
    """First-order Sobol' index: the part of the variance that the dimension explains alone. None for a dimension
    that varies together with others.
    """
    linear_share: Optional[float]
    """Share of the variance that the best straight line through the univariate part explains."""
    mean_shift: Optional[float]
    """Mean shift by the curvature."""
    origin: Optional[Literal['exact', 'evaluated', 'screened']]
    """Source of the shares: `exact`, `evaluated`, or `screened` if an estimate has a part in them. None if there are
    no shares.
    """
    rounding: Optional[List[float]]
    """Largest effect on the two derivatives of a rounding error of the characteristic. It is computed for the steps
    used, and for one sigma if the derivatives are exact.
    """
    second: Optional[float]
    """Second derivative at the mean."""
    steps: List[float]
    """Nodes along the dimension at which the model has a value, relative to the mean and in the unit of the
    dimension, ascending. Empty if none was evaluated.
    """
    total: Optional[EstimatedShare]
    """Total Sobol' index: the part of the variance including all interactions of the dimension."""


class SetUp(Record):
    """Machine with its set-up cost, which is paid once for all dimensions whose processes need it."""

    cost: float
    """Cost of setting it up."""
    machine: str
    """Name of the machine."""


class SimulatedCharacteristic(Record):
    """Estimates for one characteristic, each with its standard error. Unknown values are None."""

    conditional_yield: Optional[ConditionalYield]
    """Yield of the assemblies that keep the limits of the characteristic that this one is given. None if it is given
    none, or no point keeps them.
    """
    control: Optional[Control]
    """Effect of the surrogate as control variate. None if none was requested, or it does not vary."""
    cp: Optional[float]
    """Width of the limits divided by six sigma. None unless there are two limits, and if nothing varies."""
    cpk: Optional[float]
    """Distance of the nearer limit from the mean, divided by three sigma."""
    description: Optional[str]
    """Description in a few words."""
    distribution: Empirical
    """Distribution of the sample."""
    drawing: Optional[str]
    """Number of the drawing."""
    error: Optional[str]
    """Error of the first point without a value."""
    failed: int
    """Number of points without a value."""
    feature: Optional[str]
    """Feature of the part, or its number on the drawing."""
    histogram: Optional[Histogram]
    """Histogram of the sample, with some tens of intervals."""
    inspection: Optional[InspectionRisks]
    """Risks of the inspection, among the points of the sample. None if there is no gauge."""
    kurtosis: Optional[float]
    """Fourth standardised moment, 3 for a normal distribution. None if nothing varies."""
    lower: Optional[float]
    """Lower limit."""
    mean: Optional[float]
    """Mean value."""
    met: Optional[bool]
    """True if the target yield is met. None if there is no target, and if it is unknown."""
    name: str
    """Name of the characteristic."""
    part: Optional[str]
    """Part that it belongs to."""
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_above_interval: Optional[List[float]]
    """95 % interval of the assemblies above the upper limit alone, per million, in the same form."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    ppm_below_interval: Optional[List[float]]
    """95 % interval of the assemblies below the lower limit alone, per million: 0 to 0 if a proof excludes them,
    None if it is unknown.
    """
    range: Optional[List[float]]
    """Least and greatest value of the sample."""
    requirements: List[Judged]
    """Verdicts on all requirements, the target yield included."""
    revision: Optional[str]
    """Revision of the drawing."""
    samples: int
    """Number of points with a value."""
    sampling_interval: Optional[SamplingInterval]
    """Uncertainty of the results because measured dimensions are known by samples. None if there are no measured
    dimensions.
    """
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment. None if nothing varies."""
    sobol: Optional[List[SampledFactor]]
    """Sobol' indices of every input. None if none were requested, or the sample does not determine them."""
    standard_error: StandardErrors
    """Standard errors of the values."""
    target_yield: Optional[float]
    """Share of assemblies that must keep the limits."""
    unfinished: bool
    """True if the sample was stopped before all its points were drawn. There is no verdict then."""
    unit: Optional[str]
    """Unit, which is shown and never converted."""
    upper: Optional[float]
    """Upper limit."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """Verdict on the target yield. None if there is no target."""
    yield_: Optional[float]
    """Share of assemblies within the limits. None if there are no limits."""
    yield_bounds: Optional[List[float]]
    """Yield if all points without a value are rejected, and if none is; None if every point has one."""
    yield_interval: Optional[List[float]]
    """95 % interval of the yield, with the uncertainty of measured samples; None if there are no limits."""


class SimulationResult(Result):
    """The report of a simulation, as `--json` prints it. Unknown values are None, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristic_correlation: List[OutputCorrelation]
    """Correlations of every two characteristics. Empty with one characteristic, and with more than 40."""
    characteristics: List[SimulatedCharacteristic]
    """The results of every characteristic, in the problem's order."""
    command: str
    """The command that made the report."""
    correlation: List[Pair]
    """The dimensions that vary together."""
    dimensions: List[DimensionResult]
    """The dimensions, in the study's order."""
    evaluations: int
    """Points sent to the model, including those sent again."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model. None if there is no external model."""
    failed: int
    """Points without a value of at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[Judged]
    """Verdict on the target for the joint yield. None if there is no such target."""
    joint_yield: Optional[YieldEstimate]
    """Share of assemblies that keep the limits of all characteristics at once. None if fewer than two have limits."""
    method: str
    """`monte-carlo` or `quasi-monte-carlo`."""
    reached: Optional[bool]
    """True if the requested accuracy was reached. None if none was requested."""
    retried: int
    """Points sent again, because an answer was a failure or was not trusted."""
    sampler: Literal['random', 'sobol']
    """Sampler of the points."""
    samples: int
    """Number of points that were answered."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, if random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Reason for an early end. None if the run was completed."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    surrogate_evaluations: Optional[int]
    """Evaluations of the surrogate. None if none was requested."""
    title: Optional[str]
    """The study's title."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Warnings about assumptions that fail."""

    def __getitem__(self, name: str) -> SimulatedCharacteristic:
        """The characteristic of this name."""
        found: SimulatedCharacteristic = self._named(name)
        return found


class SobolIndices(Record):
    """Source of the indices of a characteristic, and the indices of factors with several dimensions."""

    factors: List[FactorIndices]
    """Dimensions that vary together and have indices as one factor only."""
    interactions: Optional[float]
    """One minus the sum of all first orders: interactions, and the errors of the first orders."""
    source: str
    """Source: `surface`, `exchange` of inputs of the model, or `ranks` of a sample."""


class StandardErrors(Record):
    """Standard errors, and the 95 % interval of the yield."""

    kurtosis: Optional[float]
    """Value for the fourth standardised moment, which is 3 for a normal."""
    mean: Optional[float]
    """Value for the expected value."""
    quantiles: Dict[str, Optional[float]]
    """Standard errors of the quantiles."""
    sigma: Optional[float]
    """Value for the standard deviation."""
    skewness: Optional[float]
    """Value for the third standardised moment."""
    yield_: Optional[List[float]]
    """95 % interval of the yield, by the number of points only."""


class SurfaceLaw(Record):
    """Shares of a characteristic by the distribution of its surface."""

    branch: Literal['exact', 'single', 'sampled']
    """Kind of computation of the distribution: `exact`, `single` or `sampled`."""
    counted_points: Optional[int]
    """Number of surface points that were counted because the distribution could not be computed or is refuted. None
    if it was computed.
    """
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    quantiles: Optional[Dict[str, float]]
    """Quantiles at the reported probabilities. None if one of them is unknown: those of the Pearson fit are reported
    then.
    """
    refuted: Optional[LawRefutation]
    """Contradiction because of which points replace the distribution. None if there is none."""
    step_function: bool
    """True if the distribution is a step function: every input with an effect has measured values only."""
    yield_: Optional[float]
    """Share within the limits. None if there are no limits."""
    yield_error: Optional[float]
    """Numerical error of the share within the limits: of the distribution of this surface, not of the surface."""


class SweepResult(Result):
    """The report of a sweep, as `--json` prints it. Unknown values are None, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristics: List[SweptCharacteristic]
    """The results of every characteristic requested."""
    command: str
    """The command that made the report."""
    evaluations: int
    """Points sent to the model, including those sent again."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model. None if there is no external model."""
    failed: int
    """Points without a value of at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    method: Optional[str]
    """The method that was run; None where nothing was done."""
    parameter: Parameter
    """The swept parameter."""
    retried: int
    """Points sent again, because an answer was a failure or was not trusted."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, if random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Reason for an early end. None if the run was completed."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    title: Optional[str]
    """The study's title."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Warnings, each once, with the values of the parameter at which an assumption fails."""

    def __getitem__(self, name: str) -> SweptCharacteristic:
        """The characteristic of this name."""
        found: SweptCharacteristic = self._named(name)
        return found


class SweptCharacteristic(Record):
    """One characteristic."""

    lower: Optional[float]
    """Lower limit."""
    name: str
    """Name of the characteristic."""
    points: List[SweptPoint]
    """Points in the order of the parameter's values."""
    unit: Optional[str]
    """Unit of the characteristic."""
    upper: Optional[float]
    """Upper limit."""


class SweptPoint(Record):
    """One characteristic at one value of the characteristic."""

    at: float
    """The parameter."""
    error_estimate: Optional[ErrorEstimate]
    """Estimated errors of the figures; None without moments."""
    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """First moment."""
    met: Optional[bool]
    """True if the target yield is met; None if that is unknown, and without a target."""
    nominal: Optional[float]
    """Value with every dimension at its nominal value."""
    ppm_above: Optional[float]
    """Rejected above the upper limit."""
    ppm_above_interval: Optional[List[float]]
    """95 % interval of the assemblies above the upper limit alone, per million, in the same form."""
    ppm_below: Optional[float]
    """Rejected below the lower limit, in parts per million."""
    ppm_below_interval: Optional[List[float]]
    """95 % interval of the assemblies below the lower limit alone, per million: 0 to 0 if a proof excludes them,
    None if it is unknown.
    """
    quantile_errors: Dict[str, Optional[float]]
    """Errors of the quantiles; None if unknown."""
    quantile_source: Optional[Literal['proof', 'samples', 'surface-law', 'pearson']]
    """Source of the quantiles; None if there are none."""
    quantiles: Dict[str, Optional[float]]
    """Quantiles; None at a probability that their source does not resolve."""
    requirements: List[Judged]
    """Everything that is required of it, the target yield included."""
    rss: Optional[float]
    """Root of the sum of squares."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """The same in a word."""
    yield_: Optional[float]
    """Share of assemblies within the limits."""
    yield_interval: Optional[List[float]]
    """Interval of the yield, with the uncertainty of measured samples; None if unknown."""
    yield_source: Optional[Literal['proof', 'samples', 'surface-law', 'pearson']]
    """Source of the yield; None without limits."""


class TailPoint(Record):
    """A value of the characteristic, and the share of the assemblies at or beyond it."""

    at: float
    """Value of the characteristic."""
    error: Optional[float]
    """Estimated error of the share; None if all values are of one randomisation, so that there is no scatter."""
    share: float
    """Share of the assemblies at or beyond the value."""


class Unmet(Record):
    """Bound of the probability of a region without a sampled point."""

    directions: int
    """Greatest number of directions that the region needs at once: 1 for a half-space, 2 or 3 for a corner."""
    most: float
    """Greatest probability of such a region, with 97.5 %. It is in the upper end of the interval."""
    points: int
    """Points that would have met it: of the inputs' own distribution and of wider ones, without explained rejects."""


class VarianceShare(Record):
    """Part of the variance that a dimension explains, by the model itself."""

    dimension: str
    """Name of the dimension."""
    first: Verified
    """Share of the dimension alone."""
    total: Verified
    """Share with all interactions of the dimension."""


class Verification(Record):
    """Results of the model itself for a characteristic."""

    degree: Optional[int]
    """Degree of the polynomial that the formula is. None for other kinds."""
    difference: Optional[List[Verified]]
    """Difference of the shares of model and surface within the limits, below and above them. None if there is no
    sample of both.
    """
    far_residual: Optional[FarResidual]
    """Largest residual of the surface far from the means. None if no check point met one that changes a figure."""
    figures: VerifiedFigures
    """Figures of the model itself."""
    kind: Literal['sample', 'checks', 'exact']
    """Kind of the verification."""
    left: Optional[float]
    """Share of the variance that the surface leaves unexplained."""
    lost_share: Optional[float]
    """Greatest share of the assemblies without a value, by the places of the check points without one. 0 if all have
    a value, None without check points.
    """
    points: int
    """Evaluated points of the model."""
    replaced: bool
    """True if figures of the characteristic are the model's, in place of the surface's."""
    shares: Optional[List[VarianceShare]]
    """Shares of the variance from the model, if the surface is not trusted."""
    switches: Optional[List[FoundSwitch]]
    """Switches that were met. None if the model does not report where it changes its form."""
    tails: Optional[SampleTails]
    """Tails of the sample towards the limits. None if there are no limits."""
    unseen: Optional[float]
    """Greatest share of the assemblies that may behave differently although all points agree, at 95 %. None for a
    sample, which has many points.
    """
    valid_share: Optional[Verified]
    """Share of the assemblies that have a value. None if there is no sample."""


class Verified(Record):
    """A figure by the model itself, with its error. The true value lies within three of these errors whenever it
    lies within three standard errors.
    """

    error: float
    """Estimated error of the value."""
    value: float
    """The value."""


class VerifiedFigures(Record):
    """Figures of a verification."""

    above: Optional[Verified]
    """Value above the upper limit."""
    below: Optional[Verified]
    """Value below the lower limit."""
    kurtosis: Optional[Verified]
    """Value for the fourth standardised moment, which is 3 for a normal."""
    mean: Optional[Verified]
    """Value for the expected value."""
    sigma: Optional[Verified]
    """Value for the standard deviation."""
    skewness: Optional[Verified]
    """Value for the third standardised moment."""
    yield_: Optional[Verified]
    """Share within the limits: by the sample, or by the surface with the error from check points."""


class WorstCase(Record):
    """Intervals that no assembly leaves, in JSON."""

    at: Optional[ExtremesAt]
    """Points at which the extremes are: every dimension that matters by name."""
    bounds: Optional[List[float]]
    """Interval that no assembly leaves, by interval arithmetic. Only for formulas."""
    bounds_reached: Optional[bool]
    """True if values next to both bounds exist."""
    evaluations: Optional[int]
    """Evaluations of the search; a point that serves several characteristics counts for each."""
    extremes: Optional[List[float]]
    """Interval of the model itself, if it was searched."""
    linear: Optional[List[float]]
    """Worst case of the linear model, an interval."""
    proven: Optional[bool]
    """True if it is proven that no assembly lies beyond the extremes."""


class YieldEstimate(Record):
    """Estimate of the share of assemblies that keep the limits."""

    bounds: List[float]
    """Share if every point without a value is rejected, and if none is."""
    interval: List[float]
    """95 % interval of the share, by the number of points only."""
    value: float
    """Share among the points that have a value."""


#: The classes of the objects within each.
_INNER: Dict[str, Dict[str, type]] = {
    "AllocatedCharacteristic": {"after": CharacteristicResult, "before": CharacteristicResult},
    "AllocatedTolerance": {"contributions": AllocatedToleranceContributions, "deviations": AllocatedToleranceDeviations},
    "AllocationResult": {"attainable": AllocationResultAttainable, "characteristics": AllocatedCharacteristic, "confirmation": Confirmation, "evaluator": EvaluatorSummary, "front": FrontPoint, "goal": Goal, "joint_requirement": JointKept, "joint_yield": AllocationResultJointYield, "loosest_scaling": AllocationResultLoosestScaling, "loss": AllocationResultLoss, "proof": Proof, "recentred": AllocationResultRecentred, "requirements": AllocationResultRequirements, "setups": SetUp, "shadow_prices": AllocationResultShadowPrices, "tolerances": AllocatedTolerance, "warnings": ReportedWarning},
    "AllocationResultJointYield": {"after": JointYield, "before": JointYield},
    "AllocationResultRequirements": {"sampled": AllocationResultRequirementsSampled},
    "AnalysisResult": {"account": Account, "characteristic_correlation": OutputCorrelation, "characteristics": CharacteristicResult, "correlation": Pair, "dimensions": DimensionResult, "evaluator": EvaluatorSummary, "joint_requirement": Judged, "joint_yield": Verified, "warnings": ReportedWarning},
    "Beyond": {"design_point": DesignPoint, "unmet": Unmet},
    "CharacteristicResult": {"basis": FigureBases, "coefficient_of_variation": Verified, "conditional_yield": ConditionalYield, "coverage": CoverageIntervals, "distribution": Law, "distribution_free_yield": DistributionFreeYield, "error_estimate": ErrorEstimate, "inspection": InspectionRisks, "interactions": Interaction, "interactions_remainder": Remainder, "least_squares": Residual, "model_sampling": SampledModel, "normal_fit": Capability, "pearson_fit": Capability, "quantiles": QuantileEstimates, "requirements": Judged, "sampling_interval": SamplingInterval, "sensitivities": Sensitivity, "sobol": SobolIndices, "surface_law": SurfaceLaw, "surrogate_sampling": Sampled, "tail_sampling": SampledTail, "verification": Verification, "worst_case": WorstCase},
    "ComparedCharacteristic": {"methods": ComparedMethod, "reference": SimulatedCharacteristic},
    "ComparedMethod": {"error_vs_reference": ErrorVsReference, "run": RunSummary},
    "ComparisonResult": {"characteristics": ComparedCharacteristic, "evaluator": EvaluatorSummary, "not_run": NotRun},
    "Confirmation": {"characteristics": SimulatedCharacteristic},
    "Control": {"reduction": Reduction},
    "ErrorEstimate": {"sources": ErrorSource},
    "ErrorVsReference": {"reference_standard_error": Figures},
    "FactorIndices": {"first_order": EstimatedShare, "total": EstimatedShare},
    "FrontPoint": {"required": RequiredOf},
    "InspectionRisks": {"accepted": EstimatedShare, "bad_among_accepted": EstimatedShare, "false_accept": EstimatedShare, "false_reject": EstimatedShare},
    "JointKept": {"sampled": JointKeptSampled},
    "NotRun": {"reason": NotRunReason},
    "RareCharacteristic": {"above": Beyond, "below": Beyond, "requirements": Judged, "sampling_interval": SamplingInterval},
    "RareResult": {"characteristics": RareCharacteristic, "correlation": Pair, "dimensions": DimensionResult, "evaluator": EvaluatorSummary, "joint_requirement": Judged, "warnings": ReportedWarning},
    "ReportedWarning": {"advice": Advice},
    "RunSummary": {"evaluator": EvaluatorSummary},
    "SampleTails": {"above": TailPoint, "below": TailPoint},
    "SampledFactor": {"first_order": IndexEstimate, "total": IndexEstimate},
    "SampledModel": {"histogram": Histogram},
    "Sensitivity": {"first_order": EstimatedShare, "total": EstimatedShare},
    "SimulatedCharacteristic": {"conditional_yield": ConditionalYield, "control": Control, "distribution": Empirical, "histogram": Histogram, "inspection": InspectionRisks, "requirements": Judged, "sampling_interval": SamplingInterval, "sobol": SampledFactor, "standard_error": StandardErrors},
    "SimulationResult": {"characteristic_correlation": OutputCorrelation, "characteristics": SimulatedCharacteristic, "correlation": Pair, "dimensions": DimensionResult, "evaluator": EvaluatorSummary, "joint_requirement": Judged, "joint_yield": YieldEstimate, "warnings": ReportedWarning},
    "SobolIndices": {"factors": FactorIndices},
    "SurfaceLaw": {"refuted": LawRefutation},
    "SweepResult": {"characteristics": SweptCharacteristic, "evaluator": EvaluatorSummary, "parameter": Parameter, "warnings": ReportedWarning},
    "SweptCharacteristic": {"points": SweptPoint},
    "SweptPoint": {"error_estimate": ErrorEstimate, "requirements": Judged},
    "VarianceShare": {"first": Verified, "total": Verified},
    "Verification": {"difference": Verified, "far_residual": FarResidual, "figures": VerifiedFigures, "shares": VarianceShare, "switches": FoundSwitch, "tails": SampleTails, "valid_share": Verified},
    "VerifiedFigures": {"above": Verified, "below": Verified, "kurtosis": Verified, "mean": Verified, "sigma": Verified, "skewness": Verified, "yield_": Verified},
    "WorstCase": {"at": ExtremesAt},
}

for _name, _fields in _INNER.items():
    globals()[_name]._inner = _fields
