//! `full`: every second derivative.
//!
//! Parabolas as in `second-order`, and every mixed derivative by two evaluations: half of what the published stencil
//! takes, since both dimensions up and both down suffice beside the axes.

use super::Method;
use super::ladder::{Examined, Ladder, Order};
use crate::plan::{Spread, Stencil};

pub(super) const FULL: Ladder = Ladder {
    method: Method::Full,
    runs: Method::Full,
    about: "every second derivative, mixed ones by two evaluations",
    count: "N^2+N+1",
    spread: Spread::Pair,
    interactions: Examined::All(Stencil::TwoPoint),
    order: Order::Second,
};
