//! `rss`: root of the sum of squares, first order.
//!
//! Slopes are central differences over the moment-optimal pair of nodes. The reported RSS is `sqrt(sum of (slope x half band)^2)`. The
//! moments are those of the straight-line model, exact for any inputs.
//!
//! The same evaluations give the curvatures. The method does not use them, but warns if they matter. With exact derivatives, on an assembly
//! of closure conditions, this is the direct linearisation method (DLM): Chase, Gao, Magleby (1995).

use crate::method::Method;
use crate::method::derivative::stages::{Examined, Ladder, Order};
use crate::plan::Spread;

pub(in crate::method) const RSS: Ladder = Ladder {
    method: Method::Rss,
    runs: Method::Rss,
    about: "root of the sum of squares: first order",
    count: "2N+1",
    spread: Spread::Pair,
    interactions: Examined::None,
    order: Order::First,
};
