//! `six-n`: five-point axes and the strongest interactions.
//!
//! 4N+1 evaluations make a quartic per dimension; then the N pairs with the largest product of univariate variance
//! shares get a mixed derivative by two evaluations each. With `--stencil four-point` the same 6N+1 go where the papers
//! put them: 2N+1 for parabolas and N mixed derivatives of four evaluations, which are all pairs at N = 3 only.

use super::Method;
use super::ladder::{Examined, Ladder, Order};
use crate::plan::Spread;

pub(super) const SIX_N: Ladder = Ladder {
    method: Method::SixN,
    runs: Method::SixN,
    about: "five-point axes and the N strongest interactions",
    count: "6N+1",
    spread: Spread::Five,
    interactions: Examined::Chosen,
    order: Order::Second,
};
