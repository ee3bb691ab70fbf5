//! Common part of the methods that integrate values instead of derivatives: independent variables, their rules, and their points.
//!
//! An independent input is one variable, with a quadrature rule of its own distribution. Correlated inputs are functions of normal
//! variables `z` (Nataf). These are transformed by the eigenvectors of their correlation `R = V D V'`, group by group:
//!
//! ```text
//! x_j = T_j(z_j),   z = V sqrt(D) w,   w independent standard normal, with a Gauss-Hermite rule each
//! ```
//!
//! Directions with the eigenvalue 0 are omitted. Cuts start from the point at which all variables are 0. This point is the means, except
//! that a skewed correlated input is at its median.

use std::sync::Arc;

use faer::{Mat, Side};

use crate::assembly::Run;
use crate::evaluation::{Evaluated, Evaluator, evaluate};
use crate::method::principal_axes::ZERO;
use crate::method::{
    Basis, Cost, DerivativeSource, ExactDerivatives, Fitted, Integrated, Lacking, Method, MethodError, Options, Order,
    Outcome,
};
use crate::plan::{AtNode, Design, KnownAnswers, Mixed, Plan, Point, Purpose};
use crate::problem::Problem;
use sensitol_numeric::correlation::Correlation;
use sensitol_numeric::distribution::{Distribution, Normal, Rule, StandardMoments, behind_normal};
use sensitol_numeric::surrogate::Univariate;

/// Distance of a median from the mean, in sigmas, below which both count as equal.
const SAME: f64 = 1e-9;
/// Smallest distance of a node from the mean, in sigmas, from which derivatives are taken: noise dominates the chords of shorter steps. The
/// innermost nodes of a normal input lie at 0.62 with six nodes and at 0.54 with eight. Those of a skewed input may lie anywhere.
const NEAREST: f64 = 0.35;

/// Independent standardised variable with its quadrature rule.
#[derive(Debug, Clone)]
pub(in crate::method) struct Variable {
    pub(in crate::method) rule: Rule,
    pub(in crate::method) moments: StandardMoments,
    moves: Moves,
}

/// Dimensions that a variable moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moves {
    /// Dimension at this position among the varying ones.
    One(usize),
    /// Members of a group, along one of the directions of the group.
    Along { group: usize, direction: usize },
}

/// Dimensions that are linked by correlations.
#[derive(Debug, Clone)]
struct Group {
    /// Positions among the varying dimensions.
    members: Vec<usize>,
    /// Matrix `V sqrt(D)`: one row for each member, one column for each variable.
    directions: Mat<f64>,
}

/// All variables of a problem, with the groups that they move.
#[derive(Debug, Clone)]
pub(in crate::method) struct Variables<'p> {
    problem: &'p Problem,
    varying: Vec<usize>,
    groups: Vec<Group>,
    pub(in crate::method) all: Vec<Variable>,
}

impl<'p> Variables<'p> {
    /// Returns the variables of a problem. An independent input has the rule `rule`, a direction of correlated inputs a Gauss-Hermite rule
    /// of `nodes` nodes.
    pub(in crate::method) fn of(
        problem: &'p Problem,
        plan: &dyn Plan,
        rule: impl Fn(&dyn Distribution) -> Rule,
        nodes: usize,
    ) -> Self {
        let varying = plan.varying().to_vec();
        let groups: Vec<Group> = plan.inputs().correlation().map_or_else(Vec::new, groups);
        let normal = Normal::new(0.0, 1.0).expect("the standard normal distribution");
        let mut all = Vec::new();
        for (position, &d) in varying.iter().enumerate() {
            let at_home = groups.iter().position(|group| group.members.contains(&position));
            match at_home {
                None => {
                    let distribution = problem.dimensions()[d].distribution().expect("a dimension that varies");
                    let moments = distribution.standard_moments();
                    all.push(Variable { rule: rule(distribution), moments, moves: Moves::One(position) });
                }
                // The directions of a group are listed at the place of its first member.
                Some(group) if groups[group].members[0] == position => {
                    let along = |direction| Variable {
                        rule: Rule::of(&normal, nodes),
                        moments: StandardMoments::NORMAL,
                        moves: Moves::Along { group, direction },
                    };
                    all.extend((0..groups[group].directions.ncols()).map(along));
                }
                Some(_) => {}
            }
        }
        Self { problem, varying, groups, all }
    }

    /// Returns the position of the dimension that a variable stands for, or None if the variable moves a group.
    pub(in crate::method) fn position(&self, variable: usize) -> Option<usize> {
        match self.all[variable].moves {
            Moves::One(position) => Some(position),
            Moves::Along { .. } => None,
        }
    }

    /// Returns the variable that stands for the dimension at this position, or None if the dimension is correlated.
    pub(in crate::method) fn variable(&self, position: usize) -> Option<usize> {
        self.all.iter().position(|variable| variable.moves == Moves::One(position))
    }

    /// True if a characteristic can depend on a variable.
    pub(in crate::method) fn depends(&self, plan: &dyn Plan, characteristic: usize, variable: usize) -> bool {
        let on = |position: usize| plan.depends(characteristic, self.varying[position]);
        match self.all[variable].moves {
            Moves::One(position) => on(position),
            Moves::Along { group, .. } => self.groups[group].members.iter().any(|&position| on(position)),
        }
    }

    /// Returns the number of nodes of the longest rule.
    pub(in crate::method) fn longest(&self) -> usize {
        self.all.iter().map(|variable| variable.rule.nodes.len()).max().unwrap_or(0)
    }

    /// Returns the number of nodes of a variable beside the reference.
    pub(in crate::method) fn nodes_elsewhere(&self, variable: usize) -> usize {
        self.all[variable].rule.nodes.iter().filter(|&&u| u != 0.0).count()
    }

    /// Returns the dimensions that are not at their means if these variables are at these nodes and all others at 0, with their values.
    pub(in crate::method) fn values(&self, at: &[(usize, usize)]) -> Vec<(usize, f64)> {
        let mut values = Vec::with_capacity(at.len());
        let mut z: Vec<Vec<f64>> = self.groups.iter().map(|group| vec![0.0; group.members.len()]).collect();
        for &(variable, node) in at {
            let Variable { rule, moves, .. } = &self.all[variable];
            let u = rule.nodes[node];
            match *moves {
                Moves::One(position) => {
                    let dimension = &self.problem.dimensions()[self.varying[position]];
                    values.push((self.varying[position], dimension.mean() + u * dimension.sigma()));
                }
                Moves::Along { group, direction } => {
                    let directions = &self.groups[group].directions;
                    z[group].iter_mut().enumerate().for_each(|(j, z)| *z += directions[(j, direction)] * u);
                }
            }
        }
        for (group, z) in self.groups.iter().zip(z) {
            values.extend(group.members.iter().zip(z).map(|(&position, z)| self.behind(position, z)));
        }
        values
    }

    /// Returns the value of a correlated dimension whose normal variable is `z`.
    fn behind(&self, position: usize, z: f64) -> (usize, f64) {
        let d = self.varying[position];
        let dimension = &self.problem.dimensions()[d];
        let distribution = dimension.distribution().expect("a dimension that varies");
        let (mean, sigma) = (dimension.mean(), dimension.sigma());
        let law = distribution.probability().expect("a correlated dimension is known whole");
        let x = match distribution.name() == Normal::NAME {
            true => mean + sigma * z,
            false => behind_normal(law, z),
        };
        (d, if (x - mean).abs() <= SAME * sigma { mean } else { x })
    }
}

/// Returns the groups of inputs that are linked by correlations other than 0. The directions of a group are ordered by descending variance.
fn groups(correlation: &Correlation) -> Vec<Group> {
    let (members, normal) = (correlation.members(), correlation.normal());
    let mut left: Vec<usize> = (0..members.len()).collect();
    let mut groups = Vec::new();
    while let Some(&first) = left.first() {
        let mut linked = vec![first];
        let mut next = 0;
        while next < linked.len() {
            let from = linked[next];
            let new: Vec<usize> =
                left.iter().copied().filter(|k| !linked.contains(k) && normal[(from, *k)] != 0.0).collect();
            linked.extend(new);
            next += 1;
        }
        linked.sort_unstable();
        left.retain(|place| !linked.contains(place));
        groups.push(Group {
            members: linked.iter().map(|&place| members[place]).collect(),
            directions: directions(&Mat::from_fn(linked.len(), linked.len(), |j, k| normal[(linked[j], linked[k])])),
        });
    }
    groups
}

/// Returns `V sqrt(D)` of `R = V D V'`, without the directions that do not vary.
fn directions(correlation: &Mat<f64>) -> Mat<f64> {
    let m = correlation.nrows();
    let eigen = correlation.self_adjoint_eigen(Side::Lower).expect("the eigenvalues of a correlation matrix");
    let mut order: Vec<usize> = (0..m).filter(|&k| eigen.S()[k] > ZERO * m as f64).collect();
    order.sort_by(|&a, &b| eigen.S()[b].total_cmp(&eigen.S()[a]).then(a.cmp(&b)));
    // An eigenvector has no sign of its own: its largest component is made positive.
    let sign = |k: usize| {
        let largest = (0..m).max_by(|&i, &j| eigen.U()[(i, k)].abs().total_cmp(&eigen.U()[(j, k)].abs()));
        largest.map_or(1.0, |i| eigen.U()[(i, k)].signum())
    };
    Mat::from_fn(m, order.len(), |j, place| {
        let k = order[place];
        sign(k) * eigen.U()[(j, k)] * eigen.S()[k].sqrt()
    })
}

/// Checks the problem and the options of a method that integrates: no step, no stencil, no pairs, and no blocks of inputs.
pub(in crate::method) fn check(
    method: &'static str,
    problem: &Problem,
    options: &Options,
    nodes: bool,
) -> Result<(), MethodError> {
    check_options(method, options, nodes)?;
    if let Some(block) = problem.correlation().and_then(|correlation| correlation.blocks().first()) {
        let dimensions = block.members.iter().map(|&d| problem.dimensions()[d].name().to_owned()).collect();
        return Err(MethodError::JointInputs { method, dimensions });
    }
    Ok(())
}

/// Checks the options of a method without steps, stencil and pairs.
pub(in crate::method) fn check_options(
    method: &'static str,
    options: &Options,
    nodes: bool,
) -> Result<(), MethodError> {
    let derivatives = "a method of derivatives";
    let given = [
        (options.step.is_some(), "step", derivatives),
        (options.pairs.is_some(), "pairs", Method::SixN.name()),
        (options.stencil.is_some(), "stencil", Method::SixN.name()),
        (options.derivatives == Some(DerivativeSource::Exact), "derivatives", derivatives),
        (options.nodes.is_some() && !nodes, "nodes", crate::method::NODES),
    ];
    if let Some(&(_, option, only)) = given.iter().find(|(given, ..)| *given) {
        return Err(MethodError::OptionDoesNotApply { method, option, only });
    }
    match options.nodes {
        Some(nodes) if ![3, 5, 7].contains(&nodes) => Err(MethodError::BadNodes { nodes }),
        _ => Ok(()),
    }
}

/// Results of one characteristic: its moments, or the reason why there are none, and the mixed derivatives of the pairs examined.
pub(in crate::method) type IntegratedParts = (Result<Integrated, Lacking>, Vec<Option<Mixed>>);

/// Design over the variables of a problem.
#[derive(Debug, Clone)]
pub(in crate::method) struct Quadrature<'p> {
    pub(in crate::method) variables: Variables<'p>,
    pub(in crate::method) design: Design,
    /// Point at which all variables are 0.
    pub(in crate::method) reference: Point,
}

impl<'p> Quadrature<'p> {
    /// Returns a design without points, except for the reference if it is requested.
    pub(in crate::method) fn new(
        problem: &'p Problem,
        options: &Options,
        rule: impl Fn(&dyn Distribution) -> Rule,
        nodes: usize,
        reference_wanted: bool,
    ) -> Self {
        let (dimensions, correlation) = (problem.dimensions(), problem.correlation());
        let mut design = Design::new(dimensions, correlation, problem.dependence(), options.all_sensitivities);
        let variables = Variables::of(problem, &design, rule, nodes);
        let reference = design.point(&variables.values(&[]));
        if reference_wanted {
            let purpose = if reference == Point::Centre { Purpose::Centre } else { Purpose::Cut };
            design.want(reference.clone(), purpose);
        }
        for (v, variable) in variables.all.iter().enumerate() {
            if let Moves::One(position) = variable.moves {
                let steps: Vec<f64> = (0..variable.rule.nodes.len())
                    .flat_map(|node| variables.values(&[(v, node)]))
                    .filter(|(d, _)| *d == variables.varying[position])
                    .map(|(_, x)| x)
                    .collect();
                design.steps(variables.varying[position], steps);
            }
        }
        Self { variables, design, reference }
    }

    /// Adds the point at which these variables are at these nodes to the design, and returns it.
    pub(in crate::method) fn want(&mut self, at: &[(usize, usize)], purpose: Purpose) -> Point {
        let point = self.design.point(&self.variables.values(at));
        self.design.want(point.clone(), purpose);
        point
    }

    /// Returns the node of the dimension that a variable stands for, or None if it is at the mean.
    pub(in crate::method) fn node(&mut self, variable: usize, node: usize) -> Option<AtNode> {
        self.design.point(&self.variables.values(&[(variable, node)])).at().first().copied()
    }

    /// Adds the points of the cuts along every variable. Returns for each variable the points at its nodes.
    pub(in crate::method) fn cuts(&mut self) -> Vec<Vec<Point>> {
        let nodes: Vec<usize> = self.variables.all.iter().map(|variable| variable.rule.nodes.len()).collect();
        let cut = |(v, nodes): (usize, usize)| (0..nodes).map(|node| self.want(&[(v, node)], Purpose::Cut)).collect();
        nodes.into_iter().enumerate().map(cut).collect()
    }

    /// Evaluates the design if the budget allows it.
    pub(in crate::method) fn evaluated(
        &self,
        method: &'static str,
        problem: &Problem,
        options: &Options,
        run: &Run<'_>,
    ) -> Result<Evaluated, MethodError> {
        Cost::of(&self.design).within(method, problem, options)?;
        problem.function().prepare(problem.outputs()).map_err(|error| MethodError::Model { error })?;
        Ok(evaluate(&Evaluator::new(problem, run), &self.design))
    }

    /// Returns the values of a characteristic at these points minus `above`; None for each value that is lost.
    pub(in crate::method) fn rises(known: &KnownAnswers, c: usize, points: &[Point], above: f64) -> Vec<Option<f64>> {
        points.iter().map(|point| Some(known.value(point, c)? - above)).collect()
    }

    /// Builds the outcome. Its derivatives are exact ones if they are known, or those of polynomials through the nodes next to the means.
    pub(in crate::method) fn outcome(
        self,
        method: Method,
        options: &Options,
        evaluated: Evaluated,
        pairs: Vec<(usize, usize)>,
        found: Vec<IntegratedParts>,
    ) -> Outcome {
        let Self { variables, design, reference } = self;
        let problem = variables.problem;
        let exact = ExactDerivatives::beside(problem, &design, options, &pairs);
        let at_means = reference == Point::Centre;
        let fitted = found.into_iter().zip(exact).enumerate().map(|(c, ((integrated, mixed), exact))| {
            let part = |d: usize| part(&design, &evaluated.known, c, d, at_means);
            Fitted {
                nominal: evaluated.known.value(design.nominal(), c),
                centre: evaluated.known.value(&Point::Centre, c),
                exact,
                parts: (0..problem.dimensions().len()).map(part).collect(),
                mixed,
                lacking: integrated.as_ref().err().copied(),
                integrated: integrated.ok(),
                ..Fitted::default()
            }
        });
        let fitted = fitted.collect();
        let plan = Arc::new(design);
        let outcome = Outcome {
            asked: method,
            method,
            basis: Basis::Quadrature,
            plan,
            evaluated,
            order: Order::Second,
            fitted,
            pairs,
            climbed: None,
        };
        // Moments are integrated from values at nodes, so that a polynomial of the formula does not replace anything.
        outcome.with_proofs(problem, &vec![None; problem.characteristics().len()])
    }
}

/// Returns the polynomial through the values at the nodes next to the mean, four of them at most. Returns None if no such node has a value.
fn part(design: &Design, known: &KnownAnswers, c: usize, d: usize, at_means: bool) -> Option<Univariate> {
    if !design.depends(c, d) {
        return Some(Univariate::of_coefficients(&[0.0, 0.0]));
    }
    let centre = known.value(&Point::Centre, c).filter(|_| at_means)?;
    let axis = design.axis(d);
    let mut samples: Vec<(f64, f64)> = (axis.slots.iter())
        .filter_map(|slot| {
            let value = known.value(&Point::of(&[AtNode { dimension: d as u32, node: slot[0] }]), c)?;
            Some((axis.nodes[slot[0] as usize].u, value - centre))
        })
        .filter(|(u, _)| u.abs() >= NEAREST)
        .collect();
    samples.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    samples.truncate(Univariate::DEGREE);
    Univariate::through(&samples)
}

/// Returns the indices of the two nodes next to the mean, one on either side; None for a side without a node.
pub(in crate::method) fn next_to_the_mean(rule: &Rule) -> [Option<usize>; 2] {
    let nearest = |right: bool| {
        let away = |&i: &usize| rule.nodes[i].abs() >= NEAREST && (rule.nodes[i] > 0.0) == right;
        (0..rule.nodes.len()).filter(away).min_by(|&i, &j| rule.nodes[i].abs().total_cmp(&rule.nodes[j].abs()))
    };
    [nearest(false), nearest(true)]
}

/// Fails with the number of lost values if any value is lost.
pub(in crate::method) fn complete(values: impl IntoIterator<Item = bool>) -> Result<(), Lacking> {
    let (mut lost, mut of) = (0, 0);
    for known in values {
        of += 1;
        lost += usize::from(!known);
    }
    if lost == 0 { Ok(()) } else { Err(Lacking::Points { lost, of }) }
}
