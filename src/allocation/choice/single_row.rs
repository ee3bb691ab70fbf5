//! Cheapest options of lists under one row.
//!
//! The linear relaxation takes the steps of each list's lower convex hull, the greatest saving per use first, until the
//! row is full. Its price of the row rules out options. The others enter a dynamic program over the lists. Its states
//! are pairs of use and cost without the dominated ones. A state is dropped if its cost plus the relaxation of all
//! later lists reaches the best known choice. The steps that fit into the remaining slack complete a state to a choice.

use crate::allocation::choice::option_list::{ListChoice, ListOption, Lists, ROUNDING, SAME, fits};

/// Greatest number of states of one list. They take some hundred megabytes.
const MOST: usize = 4_000_000;

/// Step along the hull of a list: to the next option that uses more and costs less.
#[derive(Debug, Clone, Copy)]
struct Step {
    list: usize,
    to: usize,
    more: f64,
    saved: f64,
}

/// Relaxation of some lists as a function of the slack, beginning with the tightest options.
struct Relaxation {
    /// Use and cost of the tightest options.
    tight: [f64; 2],
    /// Tightest options, as list and position.
    picks: Vec<(usize, usize)>,
    /// Steps, the greatest saving per use first.
    steps: Vec<Step>,
    /// Use and saving of the steps up to each.
    sums: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, Copy)]
struct State {
    used: f64,
    cost: f64,
    parent: u32,
    pick: u32,
}

/// Use of the row by an option, 0 if there is no row.
fn used(one: &ListOption) -> f64 {
    one.uses.first().copied().unwrap_or(0.0)
}

pub(in crate::allocation) fn one_row(problem: &Lists, stopped: &dyn Fn() -> bool) -> Option<ListChoice> {
    let whole: Vec<Vec<usize>> = problem.lists.iter().map(|list| (0..list.len()).collect()).collect();
    // The relaxation gives a bound, and a choice whose cost rules out options.
    let all = Relaxation::of(problem, &whole, 0..problem.lists.len());
    let (bound, price, mut best) = all.root(problem);
    problem.exchanged(&mut best, true);
    let mut known = problem.cost(&best);
    let left = reduced(problem, bound, price, known)?;
    // Short lists first would make few states. Long ones first make the bound of the others sharp soonest.
    let mut order: Vec<usize> = (0..left.len()).collect();
    order.sort_by_key(|&j| std::cmp::Reverse(left[j].len()));
    let ordered = Lists { lists: order.iter().map(|&j| problem.lists[j].clone()).collect(), rows: problem.rows };
    let left: Vec<Vec<usize>> = order.iter().map(|&j| left[j].clone()).collect();
    let mut best: Vec<usize> = order.iter().map(|&j| best[j]).collect();
    let mut stages: Vec<Vec<State>> = vec![vec![State { used: 0.0, cost: 0.0, parent: 0, pick: 0 }]];
    let (mut nodes, mut open) = (0, f64::INFINITY);
    for j in 0..left.len() {
        let rest = Relaxation::of(&ordered, &left, j + 1..left.len());
        let before = &stages[j];
        let mut states: Vec<State> = Vec::with_capacity(before.len() * left[j].len());
        for (parent, state) in before.iter().enumerate() {
            for &pick in &left[j] {
                let one = &ordered.lists[j][pick];
                let (used, cost) = (state.used + used(one), state.cost + one.cost);
                if fits(used + rest.tight[0]) && cost < known {
                    states.push(State { used, cost, parent: parent as u32, pick: pick as u32 });
                }
            }
        }
        // States that another one beats in use and cost are dropped.
        states.sort_unstable_by(|a, b| a.used.total_cmp(&b.used).then(a.cost.total_cmp(&b.cost)));
        nodes += states.len();
        let mut least = f64::INFINITY;
        states.retain(|state| {
            let keeps = state.cost < least;
            least = least.min(state.cost);
            keeps
        });
        // The best completion comes first, because its cost rules out others.
        let mut completed: Option<(f64, usize)> = None;
        let mut bounds = Vec::with_capacity(states.len());
        let mut place = rest.sums.len();
        for (index, state) in states.iter().enumerate() {
            let [lower, whole] = rest.at(1.0 + ROUNDING - state.used, &mut place);
            bounds.push(state.cost + lower);
            if state.cost + whole < completed.map_or(known * (1.0 - SAME), |(cost, _)| cost) {
                completed = Some((state.cost + whole, index));
            }
        }
        stages.push(states);
        if let Some((_, index)) = completed {
            let mut picks = traced(&stages, index);
            picks.extend(rest.completed(1.0 + ROUNDING - stages[j + 1][index].used, j + 1, left.len()));
            if ordered.is_kept(&picks) && ordered.cost(&picks) < known {
                ordered.exchanged(&mut picks, true);
                known = ordered.cost(&picks);
                best = picks;
            }
        }
        let mut keep = bounds.iter().map(|bound| *bound < known * (1.0 - SAME));
        stages[j + 1].retain(|_| keep.next().unwrap_or(false));
        if stages[j + 1].len() > MOST || stopped() {
            open = bounds.into_iter().fold(f64::INFINITY, f64::min);
            break;
        }
    }
    let mut picks = vec![0; best.len()];
    order.iter().zip(&best).for_each(|(&j, &pick)| picks[j] = pick);
    let proven = if open.is_finite() { open.max(bound) } else { known };
    Some(problem.told(&picks, proven, nodes))
}

/// Options that the price of the row does not rule out, given a choice that costs `known`.
fn reduced(problem: &Lists, bound: f64, price: f64, known: f64) -> Option<Vec<Vec<usize>>> {
    let priced = |one: &ListOption| one.cost + price * used(one);
    let left = problem.lists.iter().map(|list| {
        let least = list.iter().map(priced).fold(f64::INFINITY, f64::min);
        // A difference by the rounding of sums does not rule out an option.
        let slack = 1e-9 * known.abs();
        let stays = |i: &usize| bound + (priced(&list[*i]) - least) <= known + slack;
        let left: Vec<usize> = (0..list.len()).filter(stays).collect();
        (!left.is_empty()).then_some(left)
    });
    left.collect()
}

/// Options that lead to a state of the last stage.
fn traced(stages: &[Vec<State>], index: usize) -> Vec<usize> {
    let mut picks = Vec::with_capacity(stages.len() - 1);
    let mut at = index;
    for stage in stages[1..].iter().rev() {
        picks.push(stage[at].pick as usize);
        at = stage[at].parent as usize;
    }
    picks.reverse();
    picks
}

impl Relaxation {
    /// Relaxation of some lists with their remaining options.
    fn of(problem: &Lists, left: &[Vec<usize>], range: std::ops::Range<usize>) -> Self {
        let (mut tight, mut picks, mut steps) = ([0.0; 2], Vec::new(), Vec::new());
        for j in range {
            let list = &problem.lists[j];
            // Options are sorted by use. The cheapest one uses most.
            let mut options: Vec<usize> = left[j].clone();
            options.sort_by(|&a, &b| used(&list[a]).total_cmp(&used(&list[b])));
            let mut hull: Vec<usize> = Vec::new();
            for i in options {
                let place = |i: usize| (used(&list[i]), list[i].cost);
                while let [.., a, b] = hull[..] {
                    let ((xa, ya), (xb, yb), (x, y)) = (place(a), place(b), place(i));
                    if (yb - ya) * (x - xa) >= (y - ya) * (xb - xa) {
                        hull.pop();
                    } else {
                        break;
                    }
                }
                hull.push(i);
            }
            tight[0] += used(&list[hull[0]]);
            tight[1] += list[hull[0]].cost;
            picks.push((j, hull[0]));
            for pair in hull.windows(2) {
                let (more, saved) =
                    (used(&list[pair[1]]) - used(&list[pair[0]]), list[pair[0]].cost - list[pair[1]].cost);
                if saved > 0.0 {
                    steps.push(Step { list: j, to: pair[1], more, saved });
                }
            }
        }
        steps.sort_by(|a, b| (b.saved * a.more).total_cmp(&(a.saved * b.more)));
        let mut sums = Vec::with_capacity(steps.len());
        let mut sum = [0.0; 2];
        for step in &steps {
            sum = [sum[0] + step.more, sum[1] + step.saved];
            sums.push(sum);
        }
        Self { tight, picks, steps, sums }
    }

    /// Least cost of the relaxation in this slack, and cost of the whole steps that fit. `place` is an upper bound of
    /// the number of steps that fit, and is lowered to that number.
    fn at(&self, room: f64, place: &mut usize) -> [f64; 2] {
        let left = room - self.tight[0];
        while *place > 0 && self.sums[*place - 1][0] > left {
            *place -= 1;
        }
        let done = if *place == 0 { [0.0; 2] } else { self.sums[*place - 1] };
        let part = self.steps.get(*place).map_or(0.0, |step| {
            if step.more > 0.0 { step.saved * ((left - done[0]) / step.more).clamp(0.0, 1.0) } else { step.saved }
        });
        [self.tight[1] - done[1] - part, self.tight[1] - done[1]]
    }

    /// Options of the whole steps that fit into this slack.
    fn completed(&self, room: f64, first: usize, end: usize) -> Vec<usize> {
        let mut place = self.sums.len();
        self.at(room, &mut place);
        let mut picks = vec![0; end - first];
        self.picks.iter().for_each(|&(j, i)| picks[j - first] = i);
        self.steps[..place].iter().for_each(|step| picks[step.list - first] = step.to);
        picks
    }

    /// Relaxation of all lists: its bound, the price of the row, and the choice of the steps that fit, including later
    /// ones.
    fn root(&self, problem: &Lists) -> (f64, f64, Vec<usize>) {
        let room = 1.0 + ROUNDING;
        let mut place = self.sums.len();
        let [bound, _] = self.at(room, &mut place);
        let price = self.steps.get(place).map_or(0.0, |step| step.saved / step.more.max(f64::MIN_POSITIVE));
        let mut picks = self.completed(room, 0, problem.lists.len());
        let mut used_now: f64 = problem.uses(&picks).first().copied().unwrap_or(0.0);
        for step in &self.steps[place.min(self.steps.len())..] {
            let more = used(&problem.lists[step.list][step.to]) - used(&problem.lists[step.list][picks[step.list]]);
            let cheaper = problem.lists[step.list][step.to].cost < problem.lists[step.list][picks[step.list]].cost;
            if cheaper && fits(used_now + more) {
                used_now += more;
                picks[step.list] = step.to;
            }
        }
        (bound, price, picks)
    }
}
