//! `classic`: every second derivative by the published four-point stencil.
//!
//! Twice the evaluations of `full`. Terms that are even in both dimensions cancel in its mixed derivatives.

use super::Method;
use super::ladder::{Examined, Ladder, Order};
use crate::plan::{Spread, Stencil};

pub(super) const CLASSIC: Ladder = Ladder {
    method: Method::Classic,
    runs: Method::Classic,
    about: "every second derivative by the papers' four-point stencil",
    count: "2N^2+1",
    spread: Spread::Pair,
    interactions: Examined::All(Stencil::FourPoint),
    order: Order::Second,
};
