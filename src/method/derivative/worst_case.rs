//! `worst-case`: sum of absolute values, first order.
//!
//! Evaluations and moments are those of `rss`. The result is the interval that no assembly of a linear model can leave: `sum of |slope| x
//! band`, with each dimension at the unfavourable end of its band.

use crate::method::Method;
use crate::method::derivative::stages::{Examined, Ladder, Order};
use crate::plan::Spread;

pub(in crate::method) const WORST_CASE: Ladder = Ladder {
    method: Method::WorstCase,
    runs: Method::WorstCase,
    about: "sum of absolute values: first order, the interval no linear assembly leaves",
    count: "2N+1",
    spread: Spread::Pair,
    interactions: Examined::None,
    order: Order::First,
};
