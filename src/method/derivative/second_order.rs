//! `second-order`: slopes and curvatures, no interactions.
//!
//! One parabola per dimension through the centre and its moment-optimal pair of nodes. The nodes integrate polynomials up to the fourth
//! degree (fifth for symmetric inputs). The contribution of interactions to sigma stays unknown.

use crate::method::Method;
use crate::method::derivative::stages::{Examined, Ladder, Order};
use crate::plan::Spread;

pub(in crate::method) const SECOND_ORDER: Ladder = Ladder {
    method: Method::SecondOrder,
    runs: Method::SecondOrder,
    about: "slopes and curvatures, no interactions",
    count: "2N+1",
    spread: Spread::Pair,
    interactions: Examined::None,
    order: Order::Second,
};
