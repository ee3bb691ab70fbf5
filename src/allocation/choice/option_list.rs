//! Lists of options under rows that are sums, the input of the knapsacks ([`knapsack`](crate::allocation::choice::knapsack)).

/// Relative difference of a row between sums in another order.
pub(in crate::allocation) const ROUNDING: f64 = 1e-13;
/// Relative difference of costs within which they are the same.
pub(in crate::allocation) const SAME: f64 = 1e-12;

/// Saving of one or two exchanges, and the exchanges as list and option.
type Moves = (f64, [(usize, usize); 2]);

/// One option of a list.
#[derive(Debug, Clone, PartialEq)]
pub struct ListOption {
    /// Cost of the option.
    pub cost: f64,
    /// Use of every row, 0 or more.
    pub uses: Vec<f64>,
    /// Position in the list as given.
    pub place: usize,
}

/// Cheapest choice found.
#[derive(Debug, Clone, PartialEq)]
pub struct ListChoice {
    /// Position of the chosen option in every list, as given.
    pub places: Vec<usize>,
    /// Cost of all chosen options.
    pub cost: f64,
    /// Lower bound of the cost of every choice.
    pub bound: f64,
    /// Number of states or nodes examined.
    pub nodes: usize,
}

/// Lists and rows without those that cannot matter.
pub(in crate::allocation) struct Lists {
    pub(in crate::allocation) lists: Vec<Vec<ListOption>>,
    pub(in crate::allocation) rows: usize,
}

impl Lists {
    /// Removes redundant rows and dominated options. Returns None if a list is empty, or the tightest options break a
    /// row.
    pub(in crate::allocation) fn of(given: &[Vec<ListOption>]) -> Option<Self> {
        let rows = given.first()?.first()?.uses.len();
        let options = || given.iter().flatten();
        let implied = |weak: usize, strong: usize| options().all(|one| one.uses[weak] <= one.uses[strong]);
        // The first of two equal rows stays.
        let idle = |r: usize| {
            (0..rows).any(|s| s != r && implied(r, s) && (s < r || !implied(s, r)))
                || given.iter().map(|list| list.iter().map(|one| one.uses[r]).fold(0.0, f64::max)).sum::<f64>() <= 1.0
        };
        let kept: Vec<usize> = (0..rows).filter(|&r| !idle(r)).collect();
        let lists: Vec<Vec<ListOption>> = (given.iter())
            .map(|list| {
                let of =
                    |one: &ListOption| ListOption { uses: kept.iter().map(|&r| one.uses[r]).collect(), ..one.clone() };
                undominated(list.iter().map(of).collect())
            })
            .collect();
        let all = Self { lists, rows: kept.len() };
        let least = |r: usize| -> f64 { all.lists.iter().map(|list| least_use(list, r)).sum() };
        let possible = all.lists.iter().all(|list| !list.is_empty()) && (0..all.rows).all(|r| fits(least(r)));
        possible.then_some(all)
    }

    /// Cost of a choice by positions in these lists.
    pub(in crate::allocation) fn cost(&self, picks: &[usize]) -> f64 {
        self.lists.iter().zip(picks).map(|(list, &pick)| list[pick].cost).sum()
    }

    /// Use of every row by a choice.
    pub(in crate::allocation) fn uses(&self, picks: &[usize]) -> Vec<f64> {
        let mut uses = vec![0.0; self.rows];
        for (list, &pick) in self.lists.iter().zip(picks) {
            uses.iter_mut().zip(&list[pick].uses).for_each(|(all, own)| *all += own);
        }
        uses
    }

    pub(in crate::allocation) fn is_kept(&self, picks: &[usize]) -> bool {
        self.uses(picks).into_iter().all(fits)
    }

    /// Choice by positions in the given lists.
    pub(in crate::allocation) fn told(&self, picks: &[usize], bound: f64, nodes: usize) -> ListChoice {
        let cost = self.cost(picks);
        let places = self.lists.iter().zip(picks).map(|(list, &pick)| list[pick].place).collect();
        ListChoice { places, cost, bound: bound.min(cost), nodes }
    }

    /// Improves a choice by exchanges of one option, and of two at once if `two`, as long as they save cost and keep
    /// the rows.
    pub(in crate::allocation) fn exchanged(&self, picks: &mut [usize], two: bool) {
        let mut uses = self.uses(picks);
        loop {
            let mut best: Option<Moves> = None;
            for (j, list) in self.lists.iter().enumerate() {
                let own = &list[picks[j]];
                for (i, one) in list.iter().enumerate().filter(|(i, _)| *i != picks[j]) {
                    let saved = own.cost - one.cost;
                    let keeps = || (0..self.rows).all(|r| fits(uses[r] - own.uses[r] + one.uses[r]));
                    if saved > 0.0 && keeps() {
                        better(&mut best, saved, [(j, i), (j, i)]);
                    }
                }
            }
            if best.is_none() && two {
                self.pairs(picks, &uses, &mut best);
            }
            let Some((saved, moves)) = best else { break };
            if saved <= SAME * self.cost(picks).abs() {
                break;
            }
            moves.into_iter().for_each(|(j, i)| picks[j] = i);
            uses = self.uses(picks);
        }
    }

    /// Finds the best exchange of two options at once that saves cost and keeps the rows.
    fn pairs(&self, picks: &[usize], uses: &[f64], best: &mut Option<Moves>) {
        let mut after = vec![0.0; self.rows];
        for (j, list) in self.lists.iter().enumerate() {
            let own = &list[picks[j]];
            // A cheaper option pays for another one that uses less.
            for (i, one) in list.iter().enumerate().filter(|(_, one)| one.cost < own.cost) {
                let gained = own.cost - one.cost;
                after.iter_mut().enumerate().for_each(|(r, after)| *after = uses[r] - own.uses[r] + one.uses[r]);
                for (k, other) in self.lists.iter().enumerate().filter(|(k, _)| *k != j) {
                    let present = &other[picks[k]];
                    for (l, tighter) in other.iter().enumerate() {
                        let saved = gained - (tighter.cost - present.cost);
                        let keeps = || (0..self.rows).all(|r| fits(after[r] - present.uses[r] + tighter.uses[r]));
                        if l != picks[k] && saved > 0.0 && keeps() {
                            better(best, saved, [(j, i), (k, l)]);
                        }
                    }
                }
            }
        }
    }
}

/// Keeps the moves with the greater saving.
fn better(best: &mut Option<Moves>, saved: f64, moves: [(usize, usize); 2]) {
    if best.is_none_or(|(most, _)| saved > most) {
        *best = Some((saved, moves));
    }
}

/// True if a row with this use is kept.
pub(in crate::allocation) fn fits(use_: f64) -> bool {
    use_ <= 1.0 + ROUNDING
}

/// Least use of a row in a list.
pub(in crate::allocation) fn least_use(list: &[ListOption], r: usize) -> f64 {
    list.iter().map(|one| one.uses[r]).fold(f64::INFINITY, f64::min)
}

/// Options that no other one of the list dominates, the cheapest first.
fn undominated(mut list: Vec<ListOption>) -> Vec<ListOption> {
    list.sort_by(|a, b| {
        a.cost.total_cmp(&b.cost).then_with(|| a.uses.iter().sum::<f64>().total_cmp(&b.uses.iter().sum()))
    });
    let mut kept: Vec<ListOption> = Vec::with_capacity(list.len());
    for one in list {
        let beaten = |other: &ListOption| other.uses.iter().zip(&one.uses).all(|(other, own)| other <= own);
        if !kept.iter().any(beaten) {
            kept.push(one);
        }
    }
    kept
}
