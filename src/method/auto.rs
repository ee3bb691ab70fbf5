//! `auto`: as few evaluations as the wanted accuracy takes.
//!
//! Until the adaptive ladder exists it is `second-order`, and every report that it makes says so.

use super::Method;
use super::ladder::{Examined, Ladder, Order};
use crate::plan::Spread;

pub(super) const AUTO: Ladder = Ladder {
    method: Method::Auto,
    runs: Method::SecondOrder,
    name: "auto",
    about: "the default; stands for second-order until the adaptive method is built",
    count: "2N+1",
    spread: Spread::Pair,
    interactions: Examined::None,
    order: Order::Second,
};
