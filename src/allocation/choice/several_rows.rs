//! Cheapest options of lists under several rows.
//!
//! ```text
//! L(lambda) = sum_j min_i [ cost_j(i) + sum_r lambda_r use_rj(i) ] - sum_r lambda_r  <=  the least cost, for every lambda >= 0
//! ```
//!
//! The search is depth first. A node allows some options of every list. Its bound is the greatest `L` found by steps
//! from its parent's multipliers. Steps follow the averages of the choices that they meet, the volume algorithm: F.
//! Barahona, R. Anbil, "The volume algorithm", Mathematical Programming 87 (2000). The averages approach the fractional
//! solution. The list that they split most is split in two. At every node an option is ruled out by its contribution to
//! the bound, or by the use of a row that it leaves to the others.

use crate::allocation::choice::option_list::{ListChoice, Lists, SAME, fits, least_use};

/// Steps of the multipliers at the root, and at every other node.
const STEPS: [usize; 2] = [400, 24];
/// Nodes between two repairs of a node's choice.
const REPAIR: usize = 16;
/// Weight of the newest choice in the averages.
const NEWEST: f64 = 0.15;
/// Nodes between two repairs that exchange two options at once.
const PAIRS: usize = 512;
/// Nodes between two checks of `stopped`.
const LOOK: usize = 64;

/// All options, list after list: the cost of each, then its use of every row. They are contiguous, because steps of the
/// multipliers read them again and again.
struct Table {
    rows: usize,
    numbers: Vec<f64>,
    /// Index of the first option of every list, and the number of all options.
    starts: Vec<usize>,
}

/// Some options of every list, by their positions among all.
#[derive(Clone)]
struct Options {
    places: Vec<usize>,
    starts: Vec<usize>,
}

struct Node {
    left: Options,
    multipliers: Vec<f64>,
    bound: f64,
}

/// Result of the steps of the multipliers.
struct Bounded {
    bound: f64,
    multipliers: Vec<f64>,
    /// Choice of the best multipliers.
    picks: Vec<usize>,
    /// Weight of every option in the averages.
    weights: Vec<f64>,
}

struct Search<'p> {
    problem: &'p Lists,
    table: Table,
    best: Option<Vec<usize>>,
    known: f64,
}

pub(in crate::allocation) fn several_rows(problem: &Lists, stopped: &dyn Fn() -> bool) -> Option<ListChoice> {
    let table = Table::of(problem);
    let left = Options { places: (0..table.starts[problem.lists.len()]).collect(), starts: table.starts.clone() };
    let mut search = Search { problem, table, best: None, known: f64::INFINITY };
    let root = Node { left, multipliers: vec![0.0; problem.rows], bound: f64::NEG_INFINITY };
    let (mut open, mut nodes, mut left_over) = (vec![root], 0usize, f64::INFINITY);
    while let Some(mut node) = open.pop() {
        if node.bound >= search.known * (1.0 - SAME) {
            continue;
        }
        if nodes > 0 && nodes.is_multiple_of(LOOK) && stopped() {
            left_over = open.iter().map(|node| node.bound).fold(node.bound, f64::min);
            break;
        }
        if !search.tightened(&mut node) {
            nodes += 1;
            continue;
        }
        let bounded = search.bounded(&node, STEPS[usize::from(nodes > 0)]);
        if nodes.is_multiple_of(REPAIR) || search.table.is_kept(&bounded.picks) {
            search.repair(&bounded, nodes.is_multiple_of(PAIRS));
        }
        nodes += 1;
        node.bound = node.bound.max(bounded.bound);
        if node.bound >= search.known * (1.0 - SAME) {
            continue;
        }
        search.reduce(&mut node, &bounded);
        node.multipliers.clone_from(&bounded.multipliers);
        open.extend(split(node, &bounded).into_iter().flatten());
    }
    let best = search.best?;
    let proven = left_over.min(search.known);
    Some(problem.told(&best, proven, nodes))
}

/// Splits a node at the list with the most fractional averages, at their mean. The half with the choice of the best
/// multipliers comes last, so that it is examined first. Returns None if every list has one option.
fn split(node: Node, bounded: &Bounded) -> Option<[Node; 2]> {
    let lists = node.left.starts.len() - 1;
    // Options may have been ruled out since, because the averages belong to the node before.
    let fraction = |j: usize| 1.0 - node.left.list(j).iter().map(|&place| bounded.weights[place]).fold(0.0, f64::max);
    let wide = (0..lists).filter(|&j| node.left.list(j).len() > 1).map(|j| (j, fraction(j)));
    let longer = |a: usize, b: usize| node.left.list(a).len().cmp(&node.left.list(b).len());
    let (most, _) = wide.max_by(|a, b| a.1.total_cmp(&b.1).then(longer(a.0, b.0)))?;
    let options = node.left.list(most);
    let weighed = options.iter().enumerate().map(|(at, &place)| (at as f64, bounded.weights[place]));
    let (sum, weight) = weighed.fold((0.0, 0.0), |(sum, all), (at, weight)| (sum + at * weight, all + weight));
    let mean = if weight > 0.0 { sum / weight } else { 0.5 * (options.len() - 1) as f64 };
    let cut = options[(mean.floor() as usize + 1).clamp(1, options.len() - 1)];
    let picked_low = bounded.picks[most] < cut;
    let half = |low: bool| {
        let mut left = node.left.clone();
        left.retain(|j, place| j != most || low == (place < cut));
        Node { left, multipliers: node.multipliers.clone(), bound: node.bound }
    };
    Some([half(!picked_low), half(picked_low)])
}

impl Table {
    fn of(problem: &Lists) -> Self {
        let (mut numbers, mut starts) = (Vec::new(), vec![0]);
        for list in &problem.lists {
            for one in list {
                numbers.push(one.cost);
                numbers.extend_from_slice(&one.uses);
            }
            starts.push(starts[starts.len() - 1] + list.len());
        }
        Self { rows: problem.rows, numbers, starts }
    }

    /// Table of the remaining options only.
    fn left(&self, left: &Options) -> Self {
        let mut numbers = Vec::with_capacity((1 + self.rows) * left.places.len());
        left.places.iter().for_each(|&place| numbers.extend_from_slice(self.option(place)));
        Self { rows: self.rows, numbers, starts: left.starts.clone() }
    }

    fn option(&self, place: usize) -> &[f64] {
        &self.numbers[place * (1 + self.rows)..(place + 1) * (1 + self.rows)]
    }

    /// Cost of an option plus its use at these prices of the rows.
    fn priced(&self, place: usize, multipliers: &[f64]) -> f64 {
        let option = self.option(place);
        option[0] + option[1..].iter().zip(multipliers).map(|(use_, price)| use_ * price).sum::<f64>()
    }

    /// Chooses the cheapest option of every list at these prices of the rows, and returns the bound.
    fn choose(&self, multipliers: &[f64], picks: &mut [usize]) -> f64 {
        // For two and three rows the numbers stay in registers.
        let (two, three) = (self.numbers.as_chunks::<3>().0, self.numbers.as_chunks::<4>().0);
        match *multipliers {
            [a, b] => self.choose_by(multipliers, picks, |place| {
                let [cost, x, y] = two[place];
                cost + (x * a + y * b)
            }),
            [a, b, c] => self.choose_by(multipliers, picks, |place| {
                let [cost, x, y, z] = three[place];
                cost + (x * a + y * b + z * c)
            }),
            _ => self.choose_by(multipliers, picks, |place| self.priced(place, multipliers)),
        }
    }

    #[inline(always)]
    fn choose_by(&self, multipliers: &[f64], picks: &mut [usize], price: impl Fn(usize) -> f64) -> f64 {
        let mut value = -multipliers.iter().sum::<f64>();
        for (pick, ends) in picks.iter_mut().zip(self.starts.windows(2)) {
            let mut least = f64::INFINITY;
            for place in ends[0]..ends[1] {
                let own = price(place);
                if own < least {
                    (least, *pick) = (own, place);
                }
            }
            value += least;
        }
        value
    }

    /// Computes the excess of every row by a choice.
    fn over(&self, picks: &[usize], over: &mut [f64]) {
        match over {
            [a, b] => {
                let options = self.numbers.as_chunks::<3>().0;
                let sum = picks.iter().map(|&pick| options[pick]).fold([0.0; 2], |[a, b], [_, x, y]| [a + x, b + y]);
                (*a, *b) = (sum[0] - 1.0, sum[1] - 1.0);
            }
            _ => {
                over.fill(0.0);
                for &pick in picks {
                    over.iter_mut().zip(&self.option(pick)[1..]).for_each(|(all, own)| *all += own);
                }
                over.iter_mut().for_each(|over| *over -= 1.0);
            }
        }
    }

    fn is_kept(&self, picks: &[usize]) -> bool {
        (1..=self.rows).all(|r| fits(picks.iter().map(|&pick| self.option(pick)[r]).sum()))
    }
}

impl Options {
    fn list(&self, j: usize) -> &[usize] {
        &self.places[self.starts[j]..self.starts[j + 1]]
    }

    /// Keeps some options, by list and position. Returns true if any was removed.
    fn retain(&mut self, keep: impl Fn(usize, usize) -> bool) -> bool {
        let (mut kept, mut from) = (0, 0);
        for j in 0..self.starts.len() - 1 {
            let to = self.starts[j + 1];
            for at in from..to {
                let place = self.places[at];
                self.places[kept] = place;
                kept += usize::from(keep(j, place));
            }
            (from, self.starts[j + 1]) = (to, kept);
        }
        let changed = kept < self.places.len();
        self.places.truncate(kept);
        changed
    }
}

impl Search<'_> {
    /// Removes options that leave too little of a row to the others. Returns false if no choice is left.
    fn tightened(&self, node: &mut Node) -> bool {
        let mut least = vec![0.0; self.problem.lists.len()];
        loop {
            let mut changed = false;
            for r in 1..=self.table.rows {
                let of = |&place: &usize| self.table.option(place)[r];
                for (j, least) in least.iter_mut().enumerate() {
                    *least = node.left.list(j).iter().map(of).fold(f64::INFINITY, f64::min);
                }
                let sum: f64 = least.iter().sum();
                if !fits(sum) {
                    return false;
                }
                changed |= node.left.retain(|j, place| fits(sum - least[j] + of(&place)));
            }
            if !changed {
                return (0..least.len()).all(|j| !node.left.list(j).is_empty());
            }
        }
    }

    /// Removes options whose contribution to the bound rules them out.
    fn reduce(&self, node: &mut Node, bounded: &Bounded) {
        let slack = 1e-9 * self.known.abs();
        let price = |place: usize| self.table.priced(place, &bounded.multipliers);
        let least: Vec<f64> = bounded.picks.iter().map(|&pick| price(pick)).collect();
        node.left.retain(|j, place| bounded.bound + price(place) - least[j] <= self.known + slack);
    }

    /// Steps of the multipliers, beginning at those of the node.
    fn bounded(&self, node: &Node, steps: usize) -> Bounded {
        let rows = self.table.rows;
        let left = self.table.left(&node.left);
        let mut picks: Vec<usize> = left.starts[..left.starts.len() - 1].to_vec();
        let mut at = node.multipliers.clone();
        let bound = left.choose(&at, &mut picks);
        let mut weights = vec![0.0; left.starts[left.starts.len() - 1]];
        picks.iter().for_each(|&pick| weights[pick] = 1.0);
        // Excess of every row by the averages, and by a choice.
        let (mut over, mut own) = (vec![0.0; rows], vec![0.0; rows]);
        left.over(&picks, &mut over);
        let (mut best, mut best_at, mut best_picks) = (bound, at.clone(), picks.clone());
        let (mut length, mut in_vain) = (1.0, 0);
        for step in 0..steps {
            if best >= self.known * (1.0 - SAME) {
                break;
            }
            let useful = |r: usize| over[r] > 0.0 || best_at[r] > 0.0;
            let square: f64 = (0..rows).filter(|&r| useful(r)).map(|r| over[r] * over[r]).sum();
            if square <= 1e-24 {
                break;
            }
            // Polyak's step towards the known cost.
            let target = if self.known.is_finite() { self.known } else { best + 0.05 * best.abs().max(1e-9) };
            let by = length * (target - best).max(1e-6 * target.abs()) / square;
            for r in 0..rows {
                at[r] = (best_at[r] + by * over[r]).max(0.0);
            }
            let bound = left.choose(&at, &mut picks);
            let newest = if step < 8 { 0.5 } else { NEWEST };
            weights.iter_mut().for_each(|weight| *weight *= 1.0 - newest);
            picks.iter().for_each(|&pick| weights[pick] += newest);
            left.over(&picks, &mut own);
            over.iter_mut().zip(&own).for_each(|(over, own)| *over = (1.0 - newest) * *over + newest * own);
            if bound > best {
                let rise = bound - best;
                (best, in_vain) = (bound, 0);
                best_at.clone_from(&at);
                best_picks.clone_from(&picks);
                if rise > 1e-4 * bound.abs() {
                    length = f64::min(1.2 * length, 2.0);
                }
            } else {
                in_vain += 1;
                if in_vain >= 4 {
                    (length, in_vain) = (0.6 * length, 0);
                    // The direction is half reset to the choice of the best multipliers.
                    left.over(&best_picks, &mut own);
                    over.iter_mut().zip(&own).for_each(|(over, own)| *over = 0.5 * *over + 0.5 * own);
                }
                if length < 1e-4 {
                    break;
                }
            }
        }
        let mut of_all = vec![0.0; self.table.starts[self.problem.lists.len()]];
        node.left.places.iter().zip(&weights).for_each(|(&place, weight)| of_all[place] = *weight);
        best_picks.iter_mut().for_each(|pick| *pick = node.left.places[*pick]);
        Bounded { bound: best, multipliers: best_at, picks: best_picks, weights: of_all }
    }

    /// Repairs the choice of the best multipliers, and keeps it if it is better than the known one. Exchanges with the
    /// least cost for their effect make it keep the rows. Further exchanges then improve it.
    fn repair(&mut self, bounded: &Bounded, two: bool) {
        let problem = self.problem;
        let mut picks: Vec<usize> =
            bounded.picks.iter().zip(&self.table.starts).map(|(place, start)| place - start).collect();
        let mut uses = problem.uses(&picks);
        let over = |uses: &[f64]| uses.iter().map(|use_| (use_ - 1.0).max(0.0)).sum::<f64>();
        while !uses.iter().all(|&use_| fits(use_)) {
            let now = over(&uses);
            let mut cheapest: Option<(f64, usize, usize)> = None;
            for (j, list) in problem.lists.iter().enumerate() {
                let own = &list[picks[j]];
                for (i, one) in list.iter().enumerate().filter(|(i, _)| *i != picks[j]) {
                    let after: f64 =
                        (0..problem.rows).map(|r| (uses[r] - own.uses[r] + one.uses[r] - 1.0).max(0.0)).sum();
                    if after < now {
                        let [new, old] = [i, picks[j]]
                            .map(|place| self.table.priced(self.table.starts[j] + place, &bounded.multipliers));
                        let price = new - old;
                        let ratio = price.max(1e-12) / (now - after);
                        if cheapest.is_none_or(|(least, ..)| ratio < least) {
                            cheapest = Some((ratio, j, i));
                        }
                    }
                }
            }
            let Some((_, j, i)) = cheapest else { break };
            picks[j] = i;
            uses = problem.uses(&picks);
        }
        if !problem.is_kept(&picks) {
            // As a last resort, each list takes the option with the least use of the fullest row.
            let fullest = (0..problem.rows).max_by(|&a, &b| uses[a].total_cmp(&uses[b])).unwrap_or(0);
            for (list, pick) in problem.lists.iter().zip(&mut picks) {
                let least = least_use(list, fullest);
                *pick = list.iter().position(|one| one.uses[fullest] <= least).unwrap_or(*pick);
            }
        }
        if problem.is_kept(&picks) {
            problem.exchanged(&mut picks, two);
            let cost = problem.cost(&picks);
            if cost < self.known * (1.0 - SAME) {
                (self.known, self.best) = (cost, Some(picks));
            }
        }
    }
}
