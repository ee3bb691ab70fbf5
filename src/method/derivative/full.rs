//! `full`: every second derivative.
//!
//! Parabolas as in `second-order`, and every mixed derivative by two evaluations. The published stencil takes four, but both dimensions up
//! and both down are enough, because the values on the axes are known.

use crate::method::Method;
use crate::method::derivative::stages::{Examined, Ladder, Order};
use crate::plan::{Spread, Stencil};

pub(in crate::method) const FULL: Ladder = Ladder {
    method: Method::Full,
    runs: Method::Full,
    about: "every second derivative, mixed ones by two evaluations",
    count: "N^2+N+1",
    spread: Spread::Pair,
    interactions: Examined::All(Stencil::TwoPoint),
    order: Order::Second,
};
