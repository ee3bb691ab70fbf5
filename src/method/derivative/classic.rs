//! `classic`: every second derivative by the published four-point stencil.
//!
//! Twice the evaluations of `full`. Terms that are even in both dimensions cancel in its mixed derivatives.

use crate::method::Method;
use crate::method::derivative::stages::{Examined, Ladder, Order};
use crate::plan::{Spread, Stencil};

pub(in crate::method) const CLASSIC: Ladder = Ladder {
    method: Method::Classic,
    runs: Method::Classic,
    about: "every second derivative by the papers' four-point stencil",
    count: "2N^2+1",
    spread: Spread::Pair,
    interactions: Examined::All(Stencil::FourPoint),
    order: Order::Second,
};
