//! Methods of derivatives: a difference plan each.

pub(in crate::method) mod classic;
pub(in crate::method) mod full;
pub(in crate::method) mod rss;
pub(in crate::method) mod second_order;
pub(in crate::method) mod six_n;
pub(in crate::method) mod stages;
pub(in crate::method) mod worst_case;
