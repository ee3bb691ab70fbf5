//! `worst-case`: sum of absolute values, first order.
//!
//! The evaluations and moments of `rss`; the result that counts is the interval that no assembly of a linear model can
//! leave: `sum of |slope| x band`, each dimension at the end of its band that hurts.

use super::Method;
use super::ladder::{Examined, Ladder, Order};
use crate::plan::Spread;

pub(super) const WORST_CASE: Ladder = Ladder {
    method: Method::WorstCase,
    runs: Method::WorstCase,
    about: "sum of absolute values: first order, the interval no linear assembly leaves",
    count: "2N+1",
    spread: Spread::Pair,
    interactions: Examined::None,
    order: Order::First,
};
