//! Imports a stack-up table of a spreadsheet as a study. Each row is a dimension, and one characteristic adds them up. Of a STEP file it
//! imports the parts.

mod columns;
mod fault;
mod sheet;
mod stack;
mod step;
mod tolerance;
pub mod workbook;

pub use columns::{ColumnRole, ROLES, named};
pub use fault::{ImportFault, ImportProblem};
pub use sheet::Sheet;
pub use stack::{has_header, import};
pub use step::{StepImportFault, StepRequest, StepStudy, is_step, step_into, step_study};
pub use workbook::{WorkbookFault, is_workbook, workbook};
