//! `six-n`: five-point axes and the strongest interactions.
//!
//! 4N+1 evaluations determine a quartic per dimension. The N pairs with the largest product of univariate variance shares then get a mixed
//! derivative by two evaluations each. With `--stencil four-point` the 6N+1 evaluations are distributed as in the papers: 2N+1 for
//! parabolas, and N mixed derivatives of four evaluations, which are all pairs at N = 3 only.

use crate::method::Method;
use crate::method::derivative::stages::{Examined, Ladder, Order};
use crate::plan::Spread;

pub(in crate::method) const SIX_N: Ladder = Ladder {
    method: Method::SixN,
    runs: Method::SixN,
    about: "five-point axes and the N strongest interactions",
    count: "6N+1",
    spread: Spread::Five,
    interactions: Examined::Chosen,
    order: Order::Second,
};
