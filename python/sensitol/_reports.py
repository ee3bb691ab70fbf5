"""The types of results, one class for each object of a report. Made from the schema of reports by tools/reports.py."""

from __future__ import annotations

from typing import Any, Dict, List, Literal, Optional, Tuple, Union

from ._records import Fitted, Record, Result

class Account(Record):
    """The shapes that `auto` found for the dimensions, and the use of its points. As text it is a sentence."""

    checks: int
    """Points that check the surrogate."""
    curved: List[str]
    """Those that are curved as a parabola is: two points each."""
    evaluations: int
    """Evaluations of the search, those of such a sample excepted."""
    examined: int
    """Interactions that were examined one by one."""
    from_formulas: int
    """Interactions that the formulas give, in every characteristic."""
    full_evaluations: int
    """Evaluations that every second derivative would take, `N² + N + 1`."""
    possible_interactions: int
    """Interactions that there can be."""
    probes: int
    """Probes that move all dimensions, of one point each or two, by which interactions were sought."""
    refined: List[str]
    """Those that are more than a parabola: four points each."""
    rest: Literal['reached', 'budget', 'exhausted', 'stopped']
    """Why it ended."""
    samples: Optional[int]
    """Points of the model that the moments rest on, where the surrogate was not trusted."""
    straight: List[str]
    """Those that act along straight lines: two points each."""
    varying: int
    """Dimensions that vary and matter."""


class Advice(Record):
    """Something to do about a warning or an error. Every front end shows it in its own words: the command line as
    options, a page as sentences, JSON as `{ "action": ... }` with the fields. `Display` writes a plain sentence
    without the name of any option.
    """

    action: Literal['use-method', 'raise-budget', 'check-limits', 'set-budget', 'raise-time-limit', 'limit-time', 'sample', 'sample-rare-events', 'sample-plainly', 'more-points', 'analyze', 'smaller-step', 'use-differences', 'include-fixed-dimensions', 'leave-out-correlation', 'use-formula', 'check-names', 'check-units', 'write-direction-as-rim', 'check-nominal', 'check-position', 'check-inputs', 'check-configuration', 'check-moments', 'check-column', 'find-missing-values', 'remove-wrong-values', 'measure-more', 'measure-finer', 'repair-model', 'read-model-log', 'name-model-files', 'keep-defined', 'reset-model', 'signed-measure', 'nearer-datum', 'larger-unit', 'ordinary-unit', 'tighten-solver', 'split-branches', 'nearest-fit', 'require-more', 'analyze-written-study', 'write-costs', 'name-movable-dimensions', 'write-missing-points', 'append-answers', 'analyze-stages', 'edit-study']
    methods: Optional[List[str]]
    """The methods."""
    points: Optional[int]
    """With this many points; None where the usual number will do."""
    dimension: Optional[str]
    """Along this dimension; None for all."""
    values: Optional[int]
    """So many in all."""
    file: Optional[str]
    """The file of the written points."""


class AllocatedCharacteristic(Record):
    """One characteristic before and after."""

    after: Optional[CharacteristicResult]
    """And at those found; null where none were."""
    before: CharacteristicResult
    """As `analyze` reports it, at the tolerances before."""
    name: str
    """Its name."""
    unit: Optional[str]
    """Its unit."""


class AllocatedTolerance(Record):
    """One dimension with a cost."""

    after: float
    """Half band after."""
    at_bound: Optional[Literal['min', 'max']]
    """The bound that it has met."""
    before: float
    """Half band before."""
    bound_price: Optional[float]
    """The saving per unit by which that bound gives way, all else unchanged; None within the bounds, and where it is
    not known.
    """
    contributions: List[AllocatedToleranceContributions]
    """Its share of each characteristic's variance."""
    cost_after: Optional[float]
    """Its cost."""
    cost_before: Optional[float]
    """Its cost before; None where no process holds that tolerance."""
    deviations: AllocatedToleranceDeviations
    """Lower and upper deviation from the nominal before and after, where there is a band."""
    dimension: str
    """The dimension."""
    process: Optional[str]
    """The process, where several compete."""
    unit: Optional[str]
    """Its unit."""


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
    """The report of an allocation. Unknown values are null, never 0."""

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
    """Whether the model was evaluated at the tolerances found."""
    cost_after: Optional[float]
    """All costs after."""
    cost_basis: Literal['given', 'tolerance-unit', 'constant-precision', 'equal-shares']
    """Where the costs come from: given, or relative to the tolerance unit of ISO 286."""
    cost_before: Optional[float]
    """All costs before; null where no process holds some tolerance, and without costs."""
    cost_unrounded: Optional[float]
    """The cost of the cheapest tolerances without rounding to steps or standard grades; null without such rounding."""
    dimensions_table: Optional[str]
    """The entries of dimensions that have changed, ready to paste into the study."""
    evaluations: int
    """Points sent to the model, those sent again included."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model; None where no such model ran."""
    failed: int
    """Points that lost at least one characteristic."""
    front: List[FrontPoint]
    """Cost against what is required."""
    goal: Goal
    """The objective, and the most that may be spent on it."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[JointKept]
    """The joint yield that is required of all characteristics with limits; null where none is."""
    joint_yield: AllocationResultJointYield
    """The share of assemblies that keep all limits at once; null with fewer than two characteristics with limits."""
    loosest_scaling: AllocationResultLoosestScaling
    """By which one factor all tolerances may be multiplied until some requirement is just kept."""
    loss: AllocationResultLoss
    """The part of them that is quality loss and scrap; null without losses."""
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
    """Points sent again: because an answer was a failure, or was not trusted."""
    rounds: int
    """How often derivatives were taken."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, where random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    setups: List[SetUp]
    """The machines that the processes need, and what it costs to set them up, which is part of the cost."""
    shadow_prices: List[AllocationResultShadowPrices]
    """Shadow prices of limits and required sigmas."""
    stages: int
    """Batches in which points were sent."""
    status: Literal['optimal', 'local-optimum', 'almost-optimal', 'infeasible', 'no-feasible-point-found', 'inconclusive', 'out-of-time']
    """`optimal`, `local-optimum`, `almost-optimal`, `infeasible`, `no-feasible-point-found`, `inconclusive` or `out-
    of-time`.
    """
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Why it ended early; None where it did not."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    title: Optional[str]
    """The study's title."""
    tolerances: List[AllocatedTolerance]
    """Every dimension with a cost, in the study's order."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Where an assumption fails."""

    def __getitem__(self, name: str) -> AllocatedCharacteristic:
        """The characteristic of this name."""
        found: AllocatedCharacteristic = self._named(name)
        return found


class AllocationResultAttainable(Record):
    """Something of a characteristic, with its name."""

    because: List[str]
    """The dimensions without cost that alone break the requirement, most harmful first; empty where the others are
    to blame too.
    """
    best: Optional[float]
    """The best that the bounds of the tolerances allow, in the requirement's own measure."""
    characteristic: str
    """The characteristic."""
    joint: bool
    """Whether it is the joint yield of all characteristics with limits."""
    required: float
    """How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1."""
    requirement: str
    """`yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    together: bool
    """Whether it could be kept if it were the only one."""
    unit: Optional[str]
    """Its unit."""


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
    """The nominal value after."""
    before: float
    """The nominal value before."""
    dimension: str
    """The dimension."""
    unit: Optional[str]
    """Its unit."""


class AllocationResultRequirements(Record):
    """Something of a characteristic, with its name."""

    after: Optional[float]
    """The value found."""
    before: Optional[float]
    """The value before."""
    characteristic: str
    """The characteristic."""
    interval: Optional[List[Optional[float]]]
    """Within which that is known, an end null where there is none; null where it is not known at all."""
    met: Optional[bool]
    """Whether it is kept; null where that is not known, and where nothing was found."""
    met_before: Optional[bool]
    """Whether it was kept; null where that is not known."""
    required: float
    """How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1."""
    requirement: str
    """`yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    sampled: Optional[AllocationResultRequirementsSampled]
    """The verdict of a sample of the model there, of a worst case by points in the box of the bands; None without
    one, and of rss, of which samples know nothing.
    """
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """The same in a word; null where nothing was found."""
    verdict_before: Literal['met', 'missed', 'inconclusive']
    """The same in a word."""


class AllocationResultRequirementsSampled(Record):
    """The verdict of a sample on a requirement, as it is written."""

    interval: Optional[List[Optional[float]]]
    """Within which that is known, three errors on either side; null where it is not known at all."""
    value: Optional[float]
    """The figure of the sample."""
    verdict: Literal['met', 'missed', 'inconclusive']
    """The verdict on the requirement from that."""


class AllocationResultShadowPrices(Record):
    """Something of a characteristic, with its name."""

    both: Optional[float]
    """Per unit by which both limits go outwards, or the only one; None where that is not what they cost inwards."""
    characteristic: str
    """The characteristic."""
    lower: Optional[float]
    """Per unit by which its lower limit goes down."""
    narrow: Optional[float]
    """The extra cost per unit by which they go inwards."""
    sigma: Optional[float]
    """Per unit of a required sigma."""
    upper: Optional[float]
    """Per unit by which its upper limit goes up."""
    widen: Optional[float]
    """The saving per unit by which the limits go outwards, or a required sigma grows, all else unchanged."""


class AnalysisResult(Result):
    """The report of an analysis, as `--json` prints it. Unknown values are null, never 0."""

    account: Optional[Account]
    """The findings of `auto` and the use of its points; None for any other method."""
    basis: Literal['exact', 'differences', 'least-squares', 'quadrature']
    """The basis of the moments."""
    cached: int
    """Points whose answers were known from an earlier run."""
    characteristic_correlation: List[OutputCorrelation]
    """How every two characteristics vary together; empty with one characteristic, and with more than 40."""
    characteristics: List[CharacteristicResult]
    """The results of every characteristic, in the problem's order."""
    command: str
    """The command that made the report."""
    correlation: List[Pair]
    """The dimensions that vary together."""
    derivatives: Optional[str]
    """Where the derivatives that the moments rest on come from: `exact` or `difference`; null where they rest on
    none.
    """
    dimensions: List[DimensionResult]
    """The dimensions, in the study's order."""
    evaluations: int
    """Points sent to the model, those sent again included."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model; None where no such model ran."""
    failed: int
    """Points that lost at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[Judged]
    """Whether that share reaches the target for all characteristics at once; None without such a target."""
    joint_yield: Optional[Verified]
    """The share of assemblies that keep the limits of all characteristics at once, and its error; None with fewer
    than two that have limits, and where it is not known.
    """
    joint_yield_interval: Optional[List[float]]
    """Within which that share is known: two errors on either side, with what measured samples leave open; None where
    it is not known.
    """
    method: str
    """The method that was run: for `auto`, what it stands for."""
    retried: int
    """Points sent again: because an answer was a failure, or was not trusted."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, where random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Why it ended early; None where it did not."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    title: Optional[str]
    """The study's title."""
    varying: int
    """Dimensions that vary and on which some characteristic can depend, N."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Where an assumption fails, in the study or in the analysis."""

    def __getitem__(self, name: str) -> CharacteristicResult:
        """The characteristic of this name."""
        found: CharacteristicResult = self._named(name)
        return found


class Beyond(Record):
    """Rejects beyond one limit, as they are written."""

    bounds: Optional[List[float]]
    """If no point without a value lies beyond, and if all do; null where every point has a value."""
    design_point: Optional[DesignPoint]
    """The most likely assembly at the limit, as the surrogate and rejects of the model show it; None where none is
    known.
    """
    effective_samples: float
    """Equally weighted points that would tell as much: `(sum of weights)^2 / sum of their squares`."""
    greatest_part: Optional[float]
    """The part of the estimate that the heaviest point has: where that is large, the surrogate has missed where
    rejects are.
    """
    hits: int
    """Points beyond."""
    interval: List[float]
    """95 % interval."""
    limit: float
    """The limit."""
    plain_samples: Optional[float]
    """Points of a plain random sample that would have the same standard error."""
    ppm: Optional[float]
    """The probability in millionths."""
    probability: Optional[float]
    """The probability of an assembly beyond it; null where none was seen."""
    standard_error: Optional[float]
    """Its standard error."""


class Capability(Record):
    """How limits are kept, as it is written."""

    cp: Optional[float]
    """Width of the limits by six sigma."""
    cp_percentile: Optional[float]
    """Width of the limits by that between the quantiles 0.00135 and 0.99865."""
    cpk: Optional[float]
    """Distance of the nearer limit by three sigma."""
    cpk_percentile: Optional[float]
    """Distance of the nearer limit from the median by that of the quantile on its side."""
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    sigma_level: Optional[float]
    """Sigmas of a normal beyond which, on one side, as many lie as are rejected."""
    yield_: Optional[float]
    """The share of assemblies within the limits."""


class CharacteristicResult(Fitted):
    """A characteristic with its verdicts and intervals, as it is written."""

    constant: bool
    """Whether it can depend on nothing that varies, so that its one value is all that there is."""
    coverage: Optional[CoverageIntervals]
    """Intervals that hold the share of assemblies that was asked for; None where none was."""
    cp: Optional[float]
    """Width of the limits by six sigma."""
    cp_percentile: Optional[float]
    """Width of the limits by that between the quantiles 0.00135 and 0.99865."""
    cpk: Optional[float]
    """Distance of the nearer limit by three sigma."""
    cpk_percentile: Optional[float]
    """Distance of the nearer limit from the median by that of the quantile on its side."""
    description: Optional[str]
    """A few words on its meaning."""
    distribution: Optional[Law]
    """The distribution that has these moments, or why none has."""
    drawing: Optional[str]
    """The number of its drawing."""
    error_estimate: Optional[ErrorEstimate]
    """How far these results may be off; None without moments."""
    examined_interactions: int
    """How many of them were examined, or are known from its formula."""
    feature: Optional[str]
    """The feature of the part, or its number on the drawing."""
    inflated_rss: Optional[float]
    """1.5 times the RSS (Bender 1962, 1968), or by the factors of the study."""
    inspection: Optional[InspectionRisks]
    """The risks of its inspection; None without a gauge."""
    interactions: List[Interaction]
    """The interactions examined, strongest first."""
    interactions_remainder: Optional[Remainder]
    """The sum of the interactions that are not listed one by one; None where all are."""
    kurtosis: Optional[float]
    """Fourth standardised moment, 3 for a normal."""
    least_squares: Optional[Residual]
    """How far a fitted surface misses the values that it was fitted to; None where nothing was fitted."""
    left_out_share: Optional[float]
    """The share of the variance that no contribution accounts for; None where it is unknown."""
    lower: Optional[float]
    """Lower limit."""
    mean: Optional[float]
    """First moment."""
    mean_shift_rss: Optional[float]
    """RSS with means that are off by half their half bands, 1.5 sigma of 3, all the wrong way: `0.5 sum of |slope| x
    half band + 0.5 rss` (Greenwood and Chase 1987 with m = 0.5).
    """
    met: Optional[bool]
    """Whether the target yield is kept; null where that is not known."""
    middle: Optional[float]
    """The value of a linear model with every dimension in the middle of its band: the middle of the worst case, of
    the RSS and of the two inflations of it. The nominal where all bands are symmetric.
    """
    model_sampling: Optional[SampledModel]
    """Points of the model that the moments rest on, in place of a surrogate that was not trusted."""
    name: str
    """Its name."""
    nominal: Optional[float]
    """Its value at the nominal dimensions."""
    normal_fit: Optional[Capability]
    """How the normal distribution with the same mean and sigma would."""
    part: Optional[str]
    """The part that it belongs to."""
    pearson_fit: Optional[Capability]
    """How the distribution with its moments keeps them: the Pearson fit."""
    possible_interactions: int
    """How many interactions it can have."""
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_above_interval: Optional[List[float]]
    """The same above the upper limit."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    ppm_below_interval: Optional[List[float]]
    """The 95 % interval of the assemblies below the lower limit by themselves, per million; 0 to 0 where a proof
    excludes them, null where it is not known.
    """
    requirements: List[Judged]
    """Everything that is required of it, the target yield included."""
    revision: Optional[str]
    """The revision of the drawing."""
    rss: Optional[float]
    """`sqrt(t'R t)` with `t` = slope x half band (three sigma where a dimension has no band) and the correlation
    `R`: without correlation the root of the sum of squares.
    """
    sampling_interval: Optional[SamplingInterval]
    """How far the results may be off because measured dimensions are known by samples; None where there are none."""
    sensitivities: List[Sensitivity]
    """For every dimension of the problem, in order."""
    sigma: Optional[float]
    """Standard deviation."""
    sigma_level: Optional[float]
    """Sigmas of a normal beyond which, on one side, as many lie as are rejected."""
    six_sigma: Optional[float]
    """`sqrt(sum of (slope x sigma/(1 - k))^2)` with sigma of a lot and the shift `k` of its mean in half bands, by
    `cpk`, `drift` or `shift` (Harry and Stewart 1988): a sigma, not an interval. None where every mean is in the
    middle of its band, or one at its end.
    """
    skewness: Optional[float]
    """Third standardised moment."""
    sobol: Optional[SobolIndices]
    """The source of the Sobol' indices of its [`sensitivities`](Self::sensitivities); None where it does not vary."""
    surface_law: Optional[SurfaceLaw]
    """The results of its surface distribution; None where its moments follow from no surface."""
    surrogate_sampling: Optional[Sampled]
    """Their uncertainty from sampling the surrogate of correlated inputs; None where they are exact."""
    target_yield: Optional[float]
    """The share of assemblies that must keep the limits."""
    unfinished: bool
    """Whether planned points were not evaluated because the run was stopped: no verdict follows from the others."""
    unit: Optional[str]
    """Its unit."""
    upper: Optional[float]
    """Upper limit."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """The same in a word; null without a target."""
    verification: Optional[Verification]
    """The verification of these results by the model itself; None where they were not verified."""
    without_value: int
    """Evaluated points at which it has no value."""
    worst_case: WorstCase
    """Intervals that no assembly leaves."""
    yield_: Optional[float]
    """The share of assemblies within the limits."""
    yield_interval: Optional[List[float]]
    """Within which the share is known that keeps the limits; null where that is not known."""
    yield_source: Optional[Literal['proof', 'samples', 'surface-law', 'pearson']]
    """The source of its yield; None without a yield."""


class ComparedCharacteristic(Record):
    """One characteristic."""

    methods: List[ComparedMethod]
    """The methods, fewest evaluations first."""
    name: str
    """Its name."""
    reference: SimulatedCharacteristic
    """The reference for all methods."""


class ComparedMethod(Record):
    """One method on one characteristic."""

    cached: int
    """Those of them that were known already."""
    engine_s: float
    """Seconds besides."""
    error_vs_reference: ErrorVsReference
    """How far that is off the reference."""
    evaluation_s: float
    """Seconds within the model."""
    evaluations: int
    """Points that it takes."""
    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """First moment."""
    method: str
    """Its name; of samples with the number of points."""
    pareto: bool
    """Whether no other method has a smaller error for as many evaluations or fewer."""
    run: RunSummary
    """The cost of its run by itself."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """Its verdict on the target yield; null without one."""
    yield_: Optional[float]
    """Share within the limits."""


class ComparisonResult(Result):
    """The report of a comparison, as `--json` prints it. Unknown values are null, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristics: List[ComparedCharacteristic]
    """The results of every characteristic asked for."""
    command: str
    """The command that made the report."""
    evaluations: int
    """Points sent to the model, those sent again included."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model; None where no such model ran."""
    failed: int
    """Points that lost at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    not_run: List[NotRun]
    """Methods that were not run, and why."""
    reference_method: str
    """How they were drawn."""
    reference_samples: int
    """Points of the reference."""
    retried: int
    """Points sent again: because an answer was a failure, or was not trusted."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, where random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Why it ended early; None where it did not."""
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


class Confirmation(Record):
    """Monte Carlo at the tolerances found."""

    characteristics: List[SimulatedCharacteristic]
    """Every characteristic, as `simulate` reports it."""
    samples: int
    """Points."""


class Control(Record):
    """The effect of a surrogate as control variate, as it is written."""

    evaluations: int
    """The evaluations that it took, of all characteristics together."""
    method: str
    """The method that it comes from."""
    reduction: Reduction
    """By how much standard errors have shrunk."""


class CoverageIntervals(Record):
    """Two intervals that hold a share `p` of all assemblies. Source: JCGM 101:2008, 5.3.2 to 5.3.4 and 7.7."""

    equal_tails: List[float]
    """With as many assemblies below as above."""
    probability: float
    """The share of assemblies that each holds."""
    shortest: List[float]
    """The shortest of all."""
    source: Literal['proof', 'samples', 'surface-law', 'pearson']
    """Where they come from: a surface that is trusted, else points of the model, else the Pearson fit."""


class DesignPoint(Record):
    """The most likely assembly at a limit."""

    distance: float
    """How far it is from the middle, in standard deviations of independent normal variables."""
    values: List[float]
    """The value of every dimension, in the problem's order."""


class DimensionResult(Record):
    """One dimension as the analysis took it."""

    degrees: Optional[float]
    """Degrees of freedom of its standard uncertainty; null where the study says none."""
    description: Optional[str]
    """A few words on its meaning."""
    distribution: Optional[str]
    """The kind of its distribution; null when it does not vary."""
    drawing: Optional[str]
    """The number of its drawing."""
    feature: Optional[str]
    """The feature of the part, or its number on the drawing."""
    mean: float
    """Its mean."""
    name: str
    """Its name."""
    nominal: float
    """The value on the drawing."""
    part: Optional[str]
    """The part that it belongs to."""
    revision: Optional[str]
    """The revision of the drawing."""
    sigma: float
    """Its standard deviation."""
    tolerance: Optional[List[float]]
    """Lower and upper deviation from the nominal."""
    unit: Optional[str]
    """Its unit."""
    zone: Optional[str]
    """The circular zone of which it is a coordinate."""


class Empirical(Record):
    """A distribution that is known by a sample."""

    family: str
    """Always `empirical`."""
    quantiles: Dict[str, Optional[float]]
    """Quantiles."""


class ErrorEstimate(Record):
    """The estimated error of each result, in its own unit; None where nothing is known."""

    kurtosis: Optional[float]
    """Of the kurtosis."""
    mean: Optional[float]
    """Of the mean."""
    sigma: Optional[float]
    """Of sigma."""
    skewness: Optional[float]
    """Of the skewness."""
    sources: List[ErrorSource]
    """Its basis."""
    yield_: Optional[float]
    """Of the share within the limits."""


class ErrorSource(Record):
    """The basis of an estimate."""

    kind: Literal['checked', 'powers', 'taylor', 'curvature', 'exact-pairs', 'similar-pairs', 'unknown-pairs', 'triples', 'scatter', 'lost', 'proven', 'sampled']
    points: Optional[int]
    """How many."""
    nodes: Optional[int]
    """Nodes of the axes with the fewest, the mean included."""
    pairs: Optional[int]
    """How many."""
    degree: Optional[int]
    """The degree."""


class ErrorVsReference(Record):
    """Errors with what follows from them, as they are written."""

    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """First moment."""
    overall: Optional[float]
    """Root of the sum of squares of the errors of mean and sigma."""
    reference_standard_error: Figures
    """The reference's own standard error, in the same units: what is not larger than twice this is not resolved."""
    resolved: bool
    """Whether the reference tells that from 0."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    yield_: Optional[float]
    """Share within the limits."""


class EstimatedShare(Record):
    """A share that is estimated: of the variance, or of all parts."""

    error: Optional[float]
    """Three of these reach the truth; None where nothing is known of it."""
    value: float
    """Its value; an estimate from a sample may be below 0 by its error."""


class EvaluatorSummary(Record):
    """Starts, crashes and retries of the processes of an external model since it was made."""

    crashes: int
    """Processes that ended while points were under way, or before they were ready."""
    garbage: int
    """Lines that were no answers."""
    lost_s: float
    """Seconds from the last answer of a process that failed until another one was ready in its place."""
    retried: int
    """Points that were sent again."""
    starts: int
    """Processes that were started, the first one of every worker included."""
    timeouts: int
    """Deadlines that passed."""
    unconfirmed: int
    """Answers that depend on the points before them, and that no fresh process confirmed: they have no value, or
    results were made of them before that was known.
    """


class ExtremesAt(Record):
    """Where the extremes are."""

    lower: Dict[str, float]
    """The dimensions at the least value."""
    upper: Dict[str, float]
    """The dimensions at the greatest value."""


class FactorIndices(Record):
    """Dimensions that vary together, as one factor."""

    dimensions: List[str]
    """The dimensions."""
    first_order: Optional[EstimatedShare]
    """The part of the variance that they explain by themselves."""
    total: Optional[EstimatedShare]
    """The same with everything in which they have a part."""


class Figures(Record):
    """The results of a method for one characteristic. Unknown values are None."""

    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """First moment."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    yield_: Optional[float]
    """Share within the limits."""


class FoundSwitch(Record):
    """A switch on both sides of which there are assemblies within eight sigmas."""

    kind: Literal['kink', 'jump', 'edge', 'pole']
    """The behaviour of the output there."""
    name: str
    """The part of the formula that does it, as it is written there."""
    probability: float
    """The probability of its smaller side."""


class FrontPoint(Record):
    """One point of the front: the cheapest tolerances for a requirement."""

    cost: Optional[float]
    """The cost of that; None where it cannot be kept."""
    required: List[RequiredOf]
    """The requirement of every characteristic that has one, in the order of the problem; of all together last."""
    tolerances: Optional[List[float]]
    """Half bands, in the order of [`Allocation::tolerances`]."""


class Goal(Record):
    """The objective."""

    kind: Literal['least-cost', 'most-cpk', 'fewest-rejects']
    cost_limit: Optional[float]
    """The most that may be spent."""


class Histogram(Record):
    """How many values lie in which interval."""

    counts: List[int]
    """How many values in each."""
    edges: List[float]
    """One more than there are intervals, ascending."""


class IndexEstimate(Record):
    """An index with what the sample leaves uncertain of it."""

    interval: List[float]
    """Its 95 % interval."""
    standard_error: float
    """Its standard error."""
    value: float
    """The estimate; of an index near 0 it may be below."""


class InspectionRisks(Record):
    """The risks of an inspection with a gauge that errs. Shares are of all parts unless something else is said."""

    acceptance: List[Optional[float]]
    """The tightened limits."""
    accepted: Optional[EstimatedShare]
    """Accepted."""
    bad_among_accepted: Optional[EstimatedShare]
    """Of the accepted parts, those that are bad."""
    false_accept: Optional[EstimatedShare]
    """Bad and accepted: the consumer's risk."""
    false_reject: Optional[EstimatedShare]
    """Good and rejected: the producer's risk."""
    gauge: float
    """The standard deviation of the gauge."""
    guard: Optional[float]
    """By how much the limits are tightened; None where no guard reaches the rate that is wanted."""


class Interaction(Record):
    """The joint effect of two dimensions."""

    dimensions: List[str]
    """The two dimensions."""
    exact: bool
    """Whether it is exact rather than a difference."""
    mean_shift: Optional[float]
    """How far it moves the mean: not at all unless the two are correlated."""
    missing: Optional[Literal['failed', 'not-evaluated']]
    """Why it is missing; None where it is not."""
    mixed: Optional[float]
    """Mixed second derivative at the means; None where it is missing."""
    origin: Optional[Literal['exact', 'evaluated', 'screened']]
    """The source of its share: `exact`, `evaluated`, or `screened` where it is an estimate without an evaluation of
    its own. None where it has no share.
    """
    rounding: Optional[float]
    """The largest effect of rounding errors of the characteristic's own size on it."""
    share: Optional[float]
    """Share of the variance."""


class JointKept(Record):
    """The joint yield that all characteristics with limits must keep, and what there is of it."""

    after: Optional[float]
    """The value found."""
    before: Optional[float]
    """The value before."""
    interval: Optional[List[Optional[float]]]
    """Within which that is known, an end null where there is none; null where it is not known at all."""
    met: Optional[bool]
    """Whether it is kept; null where that is not known, and where nothing was found."""
    met_before: Optional[bool]
    """Whether it was kept; null where that is not known."""
    required: float
    """How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1."""
    requirement: str
    """`yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    sampled: Optional[JointKeptSampled]
    """The verdict of a sample of the model there; None without one."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """The same in a word; null where nothing was found."""
    verdict_before: Literal['met', 'missed', 'inconclusive']
    """The same in a word."""


class JointKeptSampled(Record):
    """The verdict of a sample on a requirement, as it is written."""

    interval: Optional[List[Optional[float]]]
    """Within which that is known, three errors on either side; null where it is not known at all."""
    value: Optional[float]
    """The figure of the sample."""
    verdict: Literal['met', 'missed', 'inconclusive']
    """The verdict on the requirement from that."""


class JointYield(Record):
    """A share of a sample."""

    interval: List[float]
    """95 % interval."""
    samples: int
    """Points of the surrogates; none of them is evaluated by the model."""
    standard_error: Optional[float]
    """Its standard error; None where all or none are."""
    yield_: float
    """The share of assemblies within all limits."""


class Judged(Record):
    """A judged requirement as it is written."""

    interval: Optional[List[Optional[float]]]
    """Within which that is known, an end null where there is none; null where it is not known at all."""
    met: Optional[bool]
    """Whether it is kept; null where that is not known."""
    required: float
    """How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1."""
    requirement: str
    """`yield`, `cpk`, `sigma`, `rss` or `worst-case`."""
    value: Optional[float]
    """The value found."""
    verdict: Literal['met', 'missed', 'inconclusive']
    """The same in a word."""


class Law(Record):
    """A distribution with the four moments of a characteristic."""

    at: Optional[float]
    """The value."""
    family: Literal['point', 'pearson']
    quantiles: Optional[Dict[str, float]]
    """Quantiles."""
    support: Optional[List[Optional[float]]]
    """Lower and upper end, where there are any."""
    type: Optional[str]
    """Its type."""


class LawRefutation(Record):
    """A refutation as it is written."""

    counted: float
    """Share of points below the limit."""
    error: float
    """Standard error of that share."""
    law: float
    """Share of assemblies below the limit by the law."""
    limit: float
    """The limit at which the law failed."""
    test: str
    """`monotone` (quantiles or shares fall) or `count` (points contradict a share)."""


class NotRun(Record):
    """One method that was not run."""

    evaluations: Optional[int]
    """The evaluations that it needs."""
    method: str
    """Which."""
    projected_s: Optional[float]
    """Seconds that the model would have taken, at the speed of those that ran."""
    reason: NotRunReason
    """Why not."""


class NotRunReason(Record):
    """Why a method was not run."""

    kind: Literal['over-reference', 'longer-than-reference', 'over-budget', 'stopped-before', 'stopped', 'impossible']
    message: Optional[str]
    """Why, in words."""


class OutputCorrelation(Record):
    """How two characteristics vary together."""

    between: List[str]
    """The two characteristics."""
    error: Optional[float]
    """The error of the coefficient; null where the model was not asked."""
    value: Optional[float]
    """Their coefficient of correlation; null where one of them does not vary, or is not known."""


class Pair(Record):
    """Two dimensions and their coefficient of correlation."""

    between: List[str]
    """The dimensions."""
    value: float
    """Pearson's coefficient, from -1 to 1."""


class Parameter(Record):
    """The parameter."""

    name: str
    """Its name."""
    sigma: float
    """Its standard deviation at every value."""
    unit: Optional[str]
    """Its unit."""
    values: List[float]
    """Its nominal values."""


class Proof(Record):
    """A proof with the kind of its bound, as it is written."""

    bound: Optional[float]
    """No choice of processes costs less; None without lists, or where no bound is known."""
    bound_is_exact: Optional[bool]
    """Whether the bound is exact, rather than resting on a sample of choices; null without one."""
    closed_form: bool
    """Whether Lagrange's condition had the answer in closed form."""
    gap: Optional[float]
    """By what part of the cost it may be above the bound."""
    kkt_residual: Optional[float]
    """The largest violation of the conditions of Karush, Kuhn and Tucker; None where everything is chosen from
    lists.
    """
    nodes: int
    """Nodes of the branch and bound."""
    other_optimum: Optional[float]
    """The cost of the next cheapest optimum that one of them ended at; None where there was no other."""
    reached: Optional[int]
    """How many of them ended at the tolerances found."""
    solver: Optional[Literal['dual-newton', 'separable', 'sequential-quadratic', 'augmented-lagrangian', 'branch-and-bound', 'root', 'verified-search']]
    """The solver that found the tolerances; None where none were found."""
    starts: Optional[int]
    """Searches from different tolerances, where there may be several optima; None where one search is enough."""


class RareCharacteristic(Record):
    """A characteristic with its verdicts, as it is written."""

    above: Optional[Beyond]
    """Rejects above the upper limit; null without one."""
    below: Optional[Beyond]
    """Rejects below the lower limit; null without one."""
    description: Optional[str]
    """A few words on its meaning."""
    drawing: Optional[str]
    """The number of its drawing."""
    error: Optional[str]
    """Why not, of the first of them."""
    failed: int
    """Points at which it has no value."""
    feature: Optional[str]
    """The feature of the part, or its number on the drawing."""
    lower: Optional[float]
    """Lower limit."""
    met: Optional[bool]
    """Whether the interval of the yield lies above the target (true), below (false), or around it (null)."""
    name: str
    """Its name."""
    part: Optional[str]
    """The part that it belongs to."""
    requirements: List[Judged]
    """Everything that is required of it, the target yield included."""
    revision: Optional[str]
    """The revision of the drawing."""
    sampling_interval: Optional[SamplingInterval]
    """How far the yield may be off because measured dimensions are known by samples; None where there are none."""
    target_yield: Optional[float]
    """The share of assemblies that must keep the limits."""
    unfinished: bool
    """Whether the search was stopped before all points were drawn: no verdict follows from the others."""
    unit: Optional[str]
    """Its unit."""
    upper: Optional[float]
    """Upper limit."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """The same in a word; null without a target."""
    yield_: Optional[float]
    """The share of assemblies within the limits; None where that beyond one of them is unknown."""
    yield_interval: Optional[List[float]]
    """95 % interval of that."""


class RareResult(Result):
    """The report of rare events, as `--json` prints it. Unknown values are null, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristics: List[RareCharacteristic]
    """The results of every characteristic, in the problem's order."""
    command: str
    """The command that made the report."""
    correlation: List[Pair]
    """The dimensions that vary together."""
    dimensions: List[DimensionResult]
    """The dimensions, in the study's order."""
    evaluations: int
    """Points sent to the model, those sent again included."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model; None where no such model ran."""
    failed: int
    """Points that lost at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[Judged]
    """Whether that share reaches the target for all characteristics at once; None without such a target."""
    joint_yield: Optional[float]
    """The share of assemblies within the limits of all characteristics at once; None with fewer than two that have
    limits, where the means lie beyond one of them, and where no point lies beyond any.
    """
    joint_yield_interval: Optional[List[float]]
    """95 % interval of that."""
    method: str
    """`importance-sampling`."""
    reached: Optional[bool]
    """Whether what was wanted was reached; None where nothing was."""
    retried: int
    """Points sent again: because an answer was a failure, or was not trusted."""
    samples: int
    """Points that were drawn and answered."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, where random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Why it ended early; None where it did not."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    surrogate: str
    """The method of the surrogate."""
    surrogate_evaluations: int
    """Evaluations of the surrogate."""
    title: Optional[str]
    """The study's title."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Where an assumption fails."""

    def __getitem__(self, name: str) -> RareCharacteristic:
        """The characteristic of this name."""
        found: RareCharacteristic = self._named(name)
        return found


class Reduction(Record):
    """The standard error without the surrogate by that with it; null where that is unknown or 0."""

    mean: Optional[float]
    """Of the mean."""
    sigma: Optional[float]
    """Of sigma."""


class Remainder(Record):
    """Interactions that are not listed one by one."""

    count: int
    """How many."""
    not_evaluated: int
    """How many of them were not evaluated before the run was stopped."""
    share: float
    """Their shares of the variance, added up; of those whose share is known."""


class ReportedWarning(Record):
    """A warning."""

    advice: List[Advice]
    """Remedies, the most promising first."""
    at: Optional[List[float]]
    """Of a sweep, the values of the parameter at which it is so."""
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
    """A requirement of a characteristic, as it is written."""

    characteristic: str
    """The characteristic."""
    required: float
    """How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1."""
    requirement: str
    """`yield`, `cpk`, `sigma`, `rss` or `worst-case`."""


class Residual(Record):
    """How far a surrogate misses the values that it was fitted to."""

    coefficients: int
    """Coefficients."""
    mean_standard_error: Optional[float]
    """The standard error of the mean from that; None where it is unknown or inputs are correlated."""
    points: int
    """Points that were fitted."""
    residual_standard_error: Optional[float]
    """`sqrt(sum of squares / (points - coefficients))`, in the characteristic's unit; None where there are no more
    points than coefficients.
    """
    sigma_standard_error: Optional[float]
    """The same of sigma."""


class RunSummary(Record):
    """The cost of a run and the reason for its end. Every result has one."""

    cached: int
    """Points whose answers were known from an earlier run."""
    evaluations: int
    """Points sent to the model, those sent again included."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model; None where no such model ran."""
    failed: int
    """Points that lost at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    retried: int
    """Points sent again: because an answer was a failure, or was not trusted."""
    seed: Optional[int]
    """The seed, where random numbers were drawn."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Why it ended early; None where it did not."""
    wall_s: float
    """Time from the first evaluation to the result."""


class Sampled(Record):
    """Standard errors of moments that were sampled, from a surrogate and not from the model."""

    kurtosis: float
    """Standard error of the kurtosis."""
    samples: int
    """Points."""
    sigma: float
    """Standard error of sigma."""
    skewness: float
    """Standard error of the skewness."""


class SampledFactor(Record):
    """The indices of one factor."""

    dimensions: List[str]
    """The dimension, or those that vary together."""
    first_order: IndexEstimate
    """The part of the variance that it explains by itself."""
    total: IndexEstimate
    """The same with every interaction in which it has a part."""


class SampledModel(Record):
    """Points of the model in place of a surrogate that was not trusted."""

    beyond: List[Optional[float]]
    """Its shares below the lower and above the upper limit; None without that limit."""
    error: Optional[str]
    """Why not, of the first."""
    failed: int
    """Points at which the model has no value, beside these."""
    histogram: Optional[Histogram]
    """The sample, counted in some tens of intervals."""
    kurtosis: Optional[float]
    """Fourth standardised moment, 3 for a normal."""
    left: float
    """The share of the variance that the surrogate left unexplained at the check."""
    mean: Optional[float]
    """First moment."""
    samples: int
    """Points."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    yield_: Optional[float]
    """The share of the sample within the limits."""
    yield_interval: Optional[List[float]]
    """Its 95 % interval."""


class SamplingInterval(Record):
    """Intervals that cover the true results with a probability of `level`, as far as the size of measured samples
    decides. Mean, sigma, skewness, kurtosis and Cpk: by the bias-corrected and accelerated bootstrap (Efron 1987)
    of all measured dimensions on which the characteristic depends, with the surrogate kept. An interval is None
    where the result itself is unknown, where there is no surrogate, and where some resample has none: a resample
    without variation has no skewness, and a Pearson law fitted to it may have infinite moments. Of a simulation:
    mean, sigma and Cpk by the variances that rows of the samples make of them among its points, as far as normal
    distributions go; skewness and kurtosis have none. The share outside the limits: by the rows themselves. Where
    all that varies is measured, it is the interval of a count among as many rows as the smallest sample has
    (Clopper and Pearson 1934). Where other dimensions vary too, a row counts as far as it decides a reject, one
    further part may lie five sigmas out, and the interval holds that of the bootstrap. Coverage of the nominal 95
    % by the bootstrap, measured over 300 samples each of a normal law and of one with skewness 1.2: | | | normal,
    50 values | 200 | skewed, 50 values | 200 | |---|---|--:|--:|--:|--:| | linear | mean | 92 % | 96 % | 94 % |
    94 % | | | sigma | 93 % | 93 % | 87 % | 91 % | | quadratic | mean | 93 % | 93 % | 92 % | 91 % | | | sigma | 86
    % | 90 % | 78 % | 84 % | Of skewness and kurtosis the intervals are too narrow by far in samples of this size:
    a sample seldom has the rare values that decide them.
    """

    cpk: Optional[List[float]]
    """Of Cpk."""
    kurtosis: Optional[List[float]]
    """Of the kurtosis."""
    level: float
    """The probability with which each covers the truth."""
    mean: Optional[List[float]]
    """Of the mean."""
    resamples: int
    """How many resamples they come from; 0 where the samples were not drawn anew."""
    samples: Dict[str, int]
    """The measured dimensions that the characteristic depends on, with the number of values of each."""
    sigma: Optional[List[float]]
    """Of sigma."""
    skewness: Optional[List[float]]
    """Of the skewness."""
    yield_: Optional[List[float]]
    """Of the share within the limits."""


class Sensitivity(Record):
    """The effect of one dimension on a characteristic."""

    curvature_share: Optional[float]
    """Share of the variance that its curvature adds."""
    dimension: str
    """The dimension."""
    exact: bool
    """Whether both are exact rather than differences."""
    first: Optional[float]
    """First derivative at the mean, in units of the characteristic per unit of the dimension."""
    first_order: Optional[EstimatedShare]
    """First-order Sobol' index: the part of the variance that it explains by itself; None of a dimension that varies
    together with others.
    """
    linear_share: Optional[float]
    """Share of the variance that the best straight line through its own part explains."""
    mean_shift: Optional[float]
    """How far its curvature moves the mean."""
    origin: Optional[Literal['exact', 'evaluated', 'screened']]
    """The source of its shares: `exact`, `evaluated`, or `screened` where an estimate has a part in them. None where
    it has no shares.
    """
    rounding: Optional[List[float]]
    """The largest effect of a rounding error of the characteristic's own size on the two derivatives: at the steps
    taken, over a sigma where they are exact.
    """
    second: Optional[float]
    """Second derivative at the mean."""
    steps: List[float]
    """Where the model was evaluated along it, off its mean and in its unit, ascending: the nodes that answered;
    empty where none was asked.
    """
    total: Optional[EstimatedShare]
    """Total Sobol' index: with every interaction in which it has a part."""


class SetUp(Record):
    """A machine and what it costs to set it up, once for all dimensions whose processes need it."""

    cost: float
    """Its cost."""
    machine: str
    """The machine."""


class SimulatedCharacteristic(Record):
    """A characteristic with the standard errors beside the values, as it is written."""

    control: Optional[Control]
    """The surrogate that stood beside the model; None where none was asked for, or it does not vary."""
    cp: Optional[float]
    """Width of the limits by six sigma; None unless there are two, and where nothing varies."""
    cpk: Optional[float]
    """Distance of the nearer limit by three sigma."""
    description: Optional[str]
    """A few words on its meaning."""
    distribution: Empirical
    """The sample's own distribution."""
    drawing: Optional[str]
    """The number of its drawing."""
    error: Optional[str]
    """Why not, of the first of them."""
    failed: int
    """Points at which it has none."""
    feature: Optional[str]
    """The feature of the part, or its number on the drawing."""
    histogram: Optional[Histogram]
    """The sample, counted in some tens of intervals."""
    inspection: Optional[InspectionRisks]
    """The risks of its inspection, among the points of the sample; None without a gauge."""
    kurtosis: Optional[float]
    """Fourth standardised moment, 3 for a normal; None where nothing varies."""
    lower: Optional[float]
    """Lower limit."""
    mean: Optional[float]
    """First moment."""
    met: Optional[bool]
    """Whether the interval of the yield lies above the target (true), below (false), or around it (null)."""
    name: str
    """Its name."""
    part: Optional[str]
    """The part that it belongs to."""
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_above_interval: Optional[List[float]]
    """The same above the upper limit."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    ppm_below_interval: Optional[List[float]]
    """The 95 % interval of the assemblies below the lower limit by themselves, per million; 0 to 0 where a proof
    excludes them, null where it is not known.
    """
    range: Optional[List[float]]
    """The least and the greatest value seen."""
    requirements: List[Judged]
    """Everything that is required of it, the target yield included."""
    revision: Optional[str]
    """The revision of the drawing."""
    samples: int
    """Points at which it has a value."""
    sampling_interval: Optional[SamplingInterval]
    """How far the results may be off because measured dimensions are known by samples; None where there are none."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment; None where nothing varies."""
    sobol: Optional[List[SampledFactor]]
    """Its Sobol' indices, of every input; None where none were asked for, or the sample does not tell."""
    standard_error: StandardErrors
    """How uncertain the sample leaves all this."""
    target_yield: Optional[float]
    """The share of assemblies that must keep the limits."""
    unfinished: bool
    """Whether the sample was stopped before all its points were drawn: no verdict follows from the others."""
    unit: Optional[str]
    """Its unit."""
    upper: Optional[float]
    """Upper limit."""
    verdict: Optional[Literal['met', 'missed', 'inconclusive']]
    """The same in a word; null without a target."""
    yield_: Optional[float]
    """The share of assemblies within the limits; None without any limit."""
    yield_bounds: Optional[List[float]]
    """If all points without a value are rejected, and if none is; null where every point has one."""
    yield_interval: Optional[List[float]]
    """95 % interval of the yield, with what measured samples leave open; null without limits."""


class SimulationResult(Result):
    """The report of a simulation, as `--json` prints it. Unknown values are null, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristic_correlation: List[OutputCorrelation]
    """How every two characteristics vary together; empty with one characteristic, and with more than 40."""
    characteristics: List[SimulatedCharacteristic]
    """The results of every characteristic, in the problem's order."""
    command: str
    """The command that made the report."""
    correlation: List[Pair]
    """The dimensions that vary together."""
    dimensions: List[DimensionResult]
    """The dimensions, in the study's order."""
    evaluations: int
    """Points sent to the model, those sent again included."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model; None where no such model ran."""
    failed: int
    """Points that lost at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    joint_requirement: Optional[Judged]
    """Whether that share reaches the target for all characteristics at once; None without such a target."""
    joint_yield: Optional[YieldEstimate]
    """The share of assemblies that keep the limits of all characteristics at once; None with fewer than two that
    have limits.
    """
    method: str
    """`monte-carlo` or `quasi-monte-carlo`."""
    reached: Optional[bool]
    """Whether what was wanted was reached; None where nothing was."""
    retried: int
    """Points sent again: because an answer was a failure, or was not trusted."""
    sampler: str
    """`random` or `sobol`."""
    samples: int
    """Points that were answered."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, where random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Why it ended early; None where it did not."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    surrogate_evaluations: Optional[int]
    """Evaluations of the surrogate; None where none was asked for."""
    title: Optional[str]
    """The study's title."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Where an assumption fails."""

    def __getitem__(self, name: str) -> SimulatedCharacteristic:
        """The characteristic of this name."""
        found: SimulatedCharacteristic = self._named(name)
        return found


class SobolIndices(Record):
    """Where the indices of a characteristic come from, and those of factors that are no single dimension."""

    factors: List[FactorIndices]
    """Dimensions that vary together: these have indices as one factor only."""
    interactions: Optional[float]
    """1 less the sum of all first orders: interactions, and what the first orders are off."""
    source: str
    """Their source: `surface`, `exchange` of inputs of the model, or `ranks` of a sample."""


class StandardErrors(Record):
    """Standard errors, and the 95 % interval of the yield."""

    kurtosis: Optional[float]
    """Fourth standardised moment, 3 for a normal."""
    mean: Optional[float]
    """First moment."""
    quantiles: Dict[str, Optional[float]]
    """Of the quantiles."""
    sigma: Optional[float]
    """Standard deviation."""
    skewness: Optional[float]
    """Third standardised moment."""
    yield_: Optional[List[float]]
    """95 % interval, as far as the number of points decides."""


class SurfaceLaw(Record):
    """The results of the surface distribution, as they are written."""

    branch: str
    """`exact`, `single` or `sampled`: how it is computed."""
    counted_points: Optional[int]
    """Points of the surface at which the law was counted, where it could not be computed or is refuted; null where
    it was computed.
    """
    ppm_above: Optional[float]
    """Assemblies above the upper limit, per million."""
    ppm_below: Optional[float]
    """Assemblies below the lower limit, per million."""
    quantiles: Optional[Dict[str, float]]
    """Quantiles; null where one of them is unknown."""
    refuted: Optional[LawRefutation]
    """The contradiction for which points took the place of the law; null where there is none."""
    step_function: bool
    """Whether the law is a step function, because every input that counts has measured values only."""
    yield_: Optional[float]
    """The share within the limits; null without any."""
    yield_error: Optional[float]
    """The numerical error of the share within the limits: of the law of this surface, not of the surface."""


class SweepResult(Result):
    """The report of a sweep, as `--json` prints it. Unknown values are null, never 0."""

    cached: int
    """Points whose answers were known from an earlier run."""
    characteristics: List[SweptCharacteristic]
    """The results of every characteristic asked for."""
    command: str
    """The command that made the report."""
    evaluations: int
    """Points sent to the model, those sent again included."""
    evaluator: Optional[EvaluatorSummary]
    """Starts, crashes and retries of the processes of an external model; None where no such model ran."""
    failed: int
    """Points that lost at least one characteristic."""
    in_model_s: float
    """Time within the model, of all threads together."""
    method: Optional[str]
    """The method that was run; null where nothing was done."""
    parameter: Parameter
    """The swept parameter."""
    retried: int
    """Points sent again: because an answer was a failure, or was not trusted."""
    schema: int
    """The version of this shape."""
    seed: Optional[int]
    """The seed, where random numbers were drawn."""
    sensitol: str
    """The version of the program."""
    stages: int
    """Batches in which points were sent."""
    stopped: Optional[Literal['time-limit', 'budget', 'interrupted', 'requested']]
    """Why it ended early; None where it did not."""
    study_sha256: str
    """SHA-256 of the study file and the files of measured values that it reads."""
    title: Optional[str]
    """The study's title."""
    wall_s: float
    """Time from the first evaluation to the result."""
    warnings: List[ReportedWarning]
    """Where an assumption fails, each once, with the values at which it does."""

    def __getitem__(self, name: str) -> SweptCharacteristic:
        """The characteristic of this name."""
        found: SweptCharacteristic = self._named(name)
        return found


class SweptCharacteristic(Record):
    """One characteristic."""

    lower: Optional[float]
    """Lower limit."""
    name: str
    """Its name."""
    points: List[SweptPoint]
    """In the order of the parameter's values."""
    unit: Optional[str]
    """Its unit."""
    upper: Optional[float]
    """Upper limit."""


class SweptPoint(Record):
    """One characteristic at one value of the parameter."""

    at: float
    """The parameter."""
    error_estimate: Optional[ErrorEstimate]
    """How far all that may be off, by what the method did not see; null without moments."""
    kurtosis: Optional[float]
    """Fourth standardised moment."""
    mean: Optional[float]
    """First moment."""
    met: Optional[bool]
    """Whether the target yield is met; null where that is not known, and without one."""
    nominal: Optional[float]
    """With every dimension at its nominal value."""
    ppm_above: Optional[float]
    """Rejected above the upper limit."""
    ppm_above_interval: Optional[List[float]]
    """The same above the upper limit."""
    ppm_below: Optional[float]
    """Rejected below the lower limit, in parts per million."""
    ppm_below_interval: Optional[List[float]]
    """The 95 % interval of the assemblies below the lower limit by themselves, per million; 0 to 0 where a proof
    excludes them, null where it is not known.
    """
    quantiles: Dict[str, Optional[float]]
    """By the law of the surface where there is one, by the Pearson fit elsewhere."""
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
    """Within which that is known, measured samples included; null where it is not known."""
    yield_source: Optional[Literal['proof', 'samples', 'surface-law', 'pearson']]
    """Its source; null without limits."""


class TailPoint(Record):
    """A value of the characteristic, and the share of the assemblies at or beyond it."""

    at: float
    """The value."""
    error: Optional[float]
    """Its estimated error; null where one randomisation has all values, so that none differs from it."""
    share: float
    """The share."""


class Tails(Record):
    """The tails of a sample, of every side that has a limit: from 10 % to 1 ppm, or to the share of the last few
    points, in even steps of its logarithm.
    """

    above: List[TailPoint]
    """Towards the upper limit; empty without one."""
    below: List[TailPoint]
    """Towards the lower limit; empty without one."""


class VarianceShare(Record):
    """The part of the variance that a dimension explains, by the model itself."""

    dimension: str
    """The dimension."""
    first: Verified
    """By itself."""
    total: Verified
    """With all interactions in which it has a part."""


class Verification(Record):
    """A verification as it is written."""

    degree: Optional[int]
    """The degree of the polynomial that the formula is; null where it was not verified so."""
    difference: Optional[List[Verified]]
    """How much more of the model than of its surface lies within the limits, below and above them; None without a
    sample of both.
    """
    figures: VerifiedFigures
    """By the model itself; null without a sample of it."""
    kind: str
    """`sample`, `checks` or `exact`."""
    left: Optional[float]
    """The share of the variance that the surface leaves unexplained."""
    points: int
    """Points of the model that were evaluated for it."""
    replaced: bool
    """Whether figures of the characteristic are the model's, in place of the surface's."""
    shares: Optional[List[VarianceShare]]
    """Shares of the variance from the model, where the surface is not trusted."""
    switches: Optional[List[FoundSwitch]]
    """The switches that are met; None where the model does not tell where it changes its form."""
    tails: Optional[Tails]
    """The tails of the sample towards the limits; None without either."""
    unseen: Optional[float]
    """The share of the assemblies that may do anything else where all points agree, at 95 %; None where points are
    many.
    """
    valid_share: Optional[Verified]
    """The share of the assemblies that have a value; None where points do not tell."""


class Verified(Record):
    """A figure as the model itself gives it, and its error: three of it reach the truth whenever three standard
    errors do.
    """

    error: float
    """Its estimated error."""
    value: float
    """The value."""


class VerifiedFigures(Record):
    """The figures of a verification."""

    above: Optional[Verified]
    """Above the upper limit."""
    below: Optional[Verified]
    """Below the lower limit."""
    kurtosis: Optional[Verified]
    """Fourth standardised moment, 3 for a normal."""
    mean: Optional[Verified]
    """First moment."""
    sigma: Optional[Verified]
    """Standard deviation."""
    skewness: Optional[Verified]
    """Third standardised moment."""
    yield_: Optional[Verified]
    """The share within the limits; by the surface with the error that checks give it, where there is no sample."""


class WorstCase(Record):
    """Intervals that no assembly leaves, as they are written."""

    at: Optional[ExtremesAt]
    """Where the extremes are: every dimension that matters by name."""
    bounds: Optional[List[float]]
    """An interval that no assembly leaves, by interval arithmetic; of formulas only."""
    bounds_reached: Optional[bool]
    """Whether values next to both bounds exist."""
    evaluations: Optional[int]
    """Evaluations of the search; a point that serves several characteristics counts for each."""
    extremes: Optional[List[float]]
    """Of the model itself, where they were searched."""
    linear: Optional[List[float]]
    """Of the linear model."""
    proven: Optional[bool]
    """Whether it is proven that no assembly lies beyond the extremes."""


class YieldEstimate(Record):
    """The share of assemblies that keep the limits."""

    bounds: List[float]
    """If every point without a value is rejected, and if none is."""
    interval: List[float]
    """95 % interval of that, as far as the number of points decides."""
    value: float
    """Among the points that have a value."""


#: The classes of the objects within each.
_INNER: Dict[str, Dict[str, type]] = {
    "AllocatedCharacteristic": {"after": CharacteristicResult, "before": CharacteristicResult},
    "AllocatedTolerance": {"contributions": AllocatedToleranceContributions, "deviations": AllocatedToleranceDeviations},
    "AllocationResult": {"attainable": AllocationResultAttainable, "characteristics": AllocatedCharacteristic, "confirmation": Confirmation, "evaluator": EvaluatorSummary, "front": FrontPoint, "goal": Goal, "joint_requirement": JointKept, "joint_yield": AllocationResultJointYield, "loosest_scaling": AllocationResultLoosestScaling, "loss": AllocationResultLoss, "proof": Proof, "recentred": AllocationResultRecentred, "requirements": AllocationResultRequirements, "setups": SetUp, "shadow_prices": AllocationResultShadowPrices, "tolerances": AllocatedTolerance, "warnings": ReportedWarning},
    "AllocationResultJointYield": {"after": JointYield, "before": JointYield},
    "AllocationResultRequirements": {"sampled": AllocationResultRequirementsSampled},
    "AnalysisResult": {"account": Account, "characteristic_correlation": OutputCorrelation, "characteristics": CharacteristicResult, "correlation": Pair, "dimensions": DimensionResult, "evaluator": EvaluatorSummary, "joint_requirement": Judged, "joint_yield": Verified, "warnings": ReportedWarning},
    "Beyond": {"design_point": DesignPoint},
    "CharacteristicResult": {"coverage": CoverageIntervals, "distribution": Law, "error_estimate": ErrorEstimate, "inspection": InspectionRisks, "interactions": Interaction, "interactions_remainder": Remainder, "least_squares": Residual, "model_sampling": SampledModel, "normal_fit": Capability, "pearson_fit": Capability, "requirements": Judged, "sampling_interval": SamplingInterval, "sensitivities": Sensitivity, "sobol": SobolIndices, "surface_law": SurfaceLaw, "surrogate_sampling": Sampled, "verification": Verification, "worst_case": WorstCase},
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
    "SampledFactor": {"first_order": IndexEstimate, "total": IndexEstimate},
    "SampledModel": {"histogram": Histogram},
    "Sensitivity": {"first_order": EstimatedShare, "total": EstimatedShare},
    "SimulatedCharacteristic": {"control": Control, "distribution": Empirical, "histogram": Histogram, "inspection": InspectionRisks, "requirements": Judged, "sampling_interval": SamplingInterval, "sobol": SampledFactor, "standard_error": StandardErrors},
    "SimulationResult": {"characteristic_correlation": OutputCorrelation, "characteristics": SimulatedCharacteristic, "correlation": Pair, "dimensions": DimensionResult, "evaluator": EvaluatorSummary, "joint_requirement": Judged, "joint_yield": YieldEstimate, "warnings": ReportedWarning},
    "SobolIndices": {"factors": FactorIndices},
    "SurfaceLaw": {"refuted": LawRefutation},
    "SweepResult": {"characteristics": SweptCharacteristic, "evaluator": EvaluatorSummary, "parameter": Parameter, "warnings": ReportedWarning},
    "SweptCharacteristic": {"points": SweptPoint},
    "SweptPoint": {"error_estimate": ErrorEstimate, "requirements": Judged},
    "Tails": {"above": TailPoint, "below": TailPoint},
    "VarianceShare": {"first": Verified, "total": Verified},
    "Verification": {"difference": Verified, "figures": VerifiedFigures, "shares": VarianceShare, "switches": FoundSwitch, "tails": Tails, "valid_share": Verified},
    "VerifiedFigures": {"above": Verified, "below": Verified, "kurtosis": Verified, "mean": Verified, "sigma": Verified, "skewness": Verified, "yield_": Verified},
    "WorstCase": {"at": ExtremesAt},
}

for _name, _fields in _INNER.items():
    globals()[_name]._inner = _fields
