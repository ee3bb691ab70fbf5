//! Sequence of column operations for a graph, with as few stored columns as possible.

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::graph::{Graph, GraphNode, NodeId};

/// Source of an operand's column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operand {
    Constant(f64),
    Variable(usize),
    Register(usize),
}

/// Operation on columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Step {
    Unary { function: Unary, a: Operand, to: usize },
    Binary { function: Binary, a: Operand, b: Operand, to: usize },
    If { condition: Operand, then: Branch, otherwise: Branch, to: usize },
}

/// Steps that are computed only if some row takes this branch, and their result.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Branch {
    pub(super) steps: Vec<Step>,
    pub(super) result: Operand,
}

/// Operations that some outputs need, in order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Program {
    pub(super) steps: Vec<Step>,
    pub(super) results: Vec<Operand>,
    pub(super) registers: usize,
    /// Variables that the program uses, ascending.
    pub(super) variables: Vec<usize>,
}

/// Greatest depth of nested branches. Deeper ones are computed with the branch around them, which is correct but slower.
const DEEPEST: usize = 64;

/// Part of the program that runs as a whole or not at all: the program itself, or one branch of an `if`.
struct Region {
    parent: usize,
    depth: usize,
    nodes: Vec<NodeId>,
    /// Condition of its `if`, and true for the branch that is taken if it holds; None for the program itself.
    entry: Option<(NodeId, bool)>,
}

/// Returns for every node that `roots` need the conditions under which its value counts: those of the surrounding `if`s, with their
/// required outcomes. Returns None for a node that is not needed.
pub(super) fn guards(graph: &Graph, roots: &[NodeId]) -> Vec<Option<Vec<(NodeId, bool)>>> {
    let layout = Layout::of(graph, roots);
    let conditions = |&region: &Option<usize>| {
        let mut region = region?;
        let mut conditions = Vec::new();
        while let Some(entry) = layout.regions[region].entry {
            conditions.push(entry);
            region = layout.regions[region].parent;
        }
        Some(conditions)
    };
    layout.region_of.iter().map(conditions).collect()
}

impl Program {
    pub(super) fn of(graph: &Graph, roots: &[NodeId]) -> Self {
        let layout = Layout::of(graph, roots);
        let mut registers = Registers {
            register: vec![None; graph.nodes().len()],
            last_use: layout.last_use(graph, roots),
            free: Vec::new(),
            count: 0,
            clock: 0,
        };
        let steps = layout.emit(graph, 0, &mut registers);
        let results = roots.iter().map(|&root| registers.operand(graph, root)).collect();
        let needed = graph.needed(roots.iter().copied());
        let variable = |(node, needed): (&GraphNode, bool)| match node {
            GraphNode::Variable(index) if needed => Some(*index),
            _ => None,
        };
        let mut variables: Vec<usize> = graph.nodes().iter().zip(needed).filter_map(variable).collect();
        variables.sort_unstable();
        variables.dedup();
        Self { steps, results, registers: registers.count, variables }
    }
}

/// Region of every needed node: the innermost one that all its users share.
struct Layout {
    regions: Vec<Region>,
    /// Regions of the two branches of an `if`.
    branches: Vec<Option<(usize, usize)>>,
    /// Region of every node that is needed.
    region_of: Vec<Option<usize>>,
}

impl Layout {
    fn of(graph: &Graph, roots: &[NodeId]) -> Self {
        let count = graph.nodes().len();
        let program = Region { parent: 0, depth: 0, nodes: Vec::new(), entry: None };
        let mut layout = Self { regions: vec![program], branches: vec![None; count], region_of: Vec::new() };
        let mut region_of: Vec<Option<usize>> = vec![None; count];
        for &root in roots {
            region_of[root as usize] = Some(0);
        }
        // Users come after their operands, so that a backward loop meets every user first.
        for id in (0..count).rev() {
            let Some(region) = region_of[id] else { continue };
            let node = graph.nodes()[id];
            match node {
                GraphNode::Constant(_) | GraphNode::Variable(_) => continue,
                GraphNode::If(condition, then, otherwise) => {
                    let (of_then, of_otherwise) = layout.open_branches(region, condition);
                    layout.branches[id] = Some((of_then, of_otherwise));
                    layout.use_in(&mut region_of, condition, region);
                    layout.use_in(&mut region_of, then, of_then);
                    layout.use_in(&mut region_of, otherwise, of_otherwise);
                }
                GraphNode::Unary(..) | GraphNode::Binary(..) => {
                    node.operands().for_each(|operand| layout.use_in(&mut region_of, operand, region));
                }
            }
            layout.regions[region].nodes.push(id as NodeId);
        }
        for region in &mut layout.regions {
            region.nodes.reverse();
        }
        layout.region_of = region_of;
        layout
    }

    fn open_branches(&mut self, region: usize, condition: NodeId) -> (usize, usize) {
        let depth = self.regions[region].depth + 1;
        if depth > DEEPEST {
            return (region, region);
        }
        let first = self.regions.len();
        let branch = |taken| Region { parent: region, depth, nodes: Vec::new(), entry: Some((condition, taken)) };
        self.regions.extend([true, false].map(branch));
        (first, first + 1)
    }

    fn use_in(&self, region_of: &mut [Option<usize>], operand: NodeId, region: usize) {
        let known = &mut region_of[operand as usize];
        *known = Some(known.map_or(region, |known| self.common(known, region)));
    }

    /// Returns the innermost region that contains both.
    fn common(&self, mut a: usize, mut b: usize) -> usize {
        while a != b {
            let deeper = if self.regions[a].depth >= self.regions[b].depth { &mut a } else { &mut b };
            *deeper = self.regions[*deeper].parent;
        }
        a
    }

    /// Calls `visit` for every operation in the order in which the program runs them. An `if` comes after its branches.
    fn walk(&self, region: usize, visit: &mut impl FnMut(NodeId)) {
        for &id in &self.regions[region].nodes {
            if let Some((then, otherwise)) = self.branches[id as usize] {
                for branch in [then, otherwise] {
                    if branch != region {
                        self.walk(branch, visit);
                    }
                }
            }
            visit(id);
        }
    }

    /// Returns for every node the time of its last use. Results are used after the end.
    fn last_use(&self, graph: &Graph, roots: &[NodeId]) -> Vec<usize> {
        let mut last_use = vec![0; graph.nodes().len()];
        let mut clock = 0;
        self.walk(0, &mut |id| {
            clock += 1;
            for operand in graph.nodes()[id as usize].operands() {
                last_use[operand as usize] = clock;
            }
        });
        for &root in roots {
            last_use[root as usize] = usize::MAX;
        }
        last_use
    }

    fn emit(&self, graph: &Graph, region: usize, registers: &mut Registers) -> Vec<Step> {
        let mut steps = Vec::with_capacity(self.regions[region].nodes.len());
        for &id in &self.regions[region].nodes {
            let node = graph.nodes()[id as usize];
            let step = match node {
                GraphNode::Unary(function, a) => {
                    let a = registers.operand(graph, a);
                    Step::Unary { function, a, to: registers.define(graph, id) }
                }
                GraphNode::Binary(function, a, b) => {
                    let (a, b) = (registers.operand(graph, a), registers.operand(graph, b));
                    Step::Binary { function, a, b, to: registers.define(graph, id) }
                }
                GraphNode::If(condition, then, otherwise) => {
                    let (of_then, of_otherwise) = self.branches[id as usize].expect("every `if` has its branches");
                    let mut branch = |inner: usize, result: NodeId| {
                        let steps = if inner == region { Vec::new() } else { self.emit(graph, inner, registers) };
                        Branch { steps, result: registers.operand(graph, result) }
                    };
                    let (then, otherwise) = (branch(of_then, then), branch(of_otherwise, otherwise));
                    let condition = registers.operand(graph, condition);
                    Step::If { condition, then, otherwise, to: registers.define(graph, id) }
                }
                GraphNode::Constant(_) | GraphNode::Variable(_) => unreachable!("no operation"),
            };
            steps.push(step);
        }
        steps
    }
}

/// Columns in use. A register is free again after the last use of its column.
struct Registers {
    register: Vec<Option<usize>>,
    last_use: Vec<usize>,
    free: Vec<usize>,
    count: usize,
    clock: usize,
}

impl Registers {
    fn operand(&self, graph: &Graph, id: NodeId) -> Operand {
        match graph.nodes()[id as usize] {
            GraphNode::Constant(bits) => Operand::Constant(f64::from_bits(bits)),
            GraphNode::Variable(index) => Operand::Variable(index),
            _ => Operand::Register(self.register[id as usize].expect("operands are computed first")),
        }
    }

    /// Returns a register for the result of `id`. It is never one of its own operands, which are freed afterwards.
    fn define(&mut self, graph: &Graph, id: NodeId) -> usize {
        self.clock += 1;
        let to = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        self.register[id as usize] = Some(to);
        for operand in graph.nodes()[id as usize].operands() {
            let operand = operand as usize;
            if self.last_use[operand] == self.clock
                && let Some(register) = self.register[operand]
                && !self.free.contains(&register)
            {
                self.free.push(register);
            }
        }
        to
    }
}
