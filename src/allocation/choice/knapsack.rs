//! Multiple-choice knapsack: the cheapest option of every list under rows that are sums.
//!
//! ```text
//! min  sum_j cost_j(i_j)    subject to    sum_j use_rj(i_j) <= 1 for every row r,   one option i_j of every list j
//! ```
//!
//! Redundant rows are left out, and options that another one of the list beats in cost and in every row. One row is
//! solved by a dynamic program on the linear relaxation (`single_row`), several by branch and bound on
//! the Lagrangian one (`several_rows`). Sources: P. Sinha, A. A. Zoltners, "The multiple-choice
//! knapsack problem", Operations Research 27 (1979); D. Pisinger, "A minimal algorithm for the multiple-choice knapsack
//! problem", European J. Operational Research 83 (1995).

use crate::allocation::choice::option_list::{ListChoice, ListOption, Lists};
use crate::allocation::choice::several_rows::several_rows;
use crate::allocation::choice::single_row::one_row;

/// Cheapest choice. Returns None if no choice keeps the rows, or none was found before the stop.
pub fn cheapest(lists: &[Vec<ListOption>], stopped: &dyn Fn() -> bool) -> Option<ListChoice> {
    let problem = Lists::of(lists)?;
    match problem.rows {
        0 | 1 => one_row(&problem, stopped),
        _ => several_rows(&problem, stopped),
    }
}
