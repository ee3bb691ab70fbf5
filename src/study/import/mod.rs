//! A stack-up table of a spreadsheet as a study: one row a dimension, and one characteristic that adds them up.

mod columns;
mod fault;
mod sheet;
mod stack;
mod tolerance;
#[cfg(feature = "xlsx")]
mod workbook;

pub(crate) use columns::{ROLES, Role, named};
pub(crate) use fault::{ImportFault, ImportProblem};
pub(crate) use sheet::Sheet;
pub(crate) use stack::{has_header, import};
#[cfg(feature = "xlsx")]
pub(crate) use workbook::{WorkbookFault, is_workbook, workbook};
