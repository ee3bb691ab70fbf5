//! Imports a stack-up table of a spreadsheet as a study. Each row is a dimension, and one characteristic adds them up. Of a STEP file it
//! imports the parts.

mod columns;
mod fault;
mod figures;
mod header;
mod json;
mod limits;
mod measured;
mod row;
mod sheet;
mod spread;
mod stack;
mod step;
mod study_text;
mod text_sheet;
mod title;
mod tolerance;
mod units;
mod words;
pub mod workbook;

pub use columns::{ColumnRole, ROLES, named};
pub use fault::{ImportFault, ImportProblem};
pub use header::has_header;
pub use json::sheet_of;
pub use measured::measured;
pub(crate) use sheet::Content;
pub use sheet::Sheet;
pub use stack::{ImportOptions, Imported, import};
pub use step::{StepImportFault, StepRequest, StepStudy, is_step, step_into, step_study};
pub use text_sheet::stack_sheet;
pub use workbook::{WorkbookFault, is_workbook, workbook};
