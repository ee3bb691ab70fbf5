//! The commands, a file each.

pub(crate) mod allocate;
pub(crate) mod analyze;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod difference;
pub(crate) mod evaluate;
pub(crate) mod expand;
pub(crate) mod import;
pub(crate) mod import_step;
pub(crate) mod init;
pub(crate) mod journal;
pub(crate) mod models;
pub(crate) mod pearson;
pub(crate) mod plan;
pub(crate) mod point_report;
pub(crate) mod probe;
pub(crate) mod rare;
pub(crate) mod reference;
pub(crate) mod schema;
pub(crate) mod serve;
pub(crate) mod several;
pub(crate) mod shard;
pub(crate) mod simulate;
pub(crate) mod sweep;
pub(crate) mod watch;
pub(crate) mod workbench;
