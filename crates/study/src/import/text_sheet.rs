//! Sheet of a stack-up table in a text file.

use crate::import::header::has_header;
use crate::import::sheet::Sheet;
use crate::table::DELIMITERS;

/// Sheet of a stack-up table in a text with tabs, semicolons or commas between the columns. A title above the header does not decide on the
/// delimiter: the first one that gives a header does.
///
/// ```
/// use sensitol_study::import::{has_header, stack_sheet};
/// let table = "name;nominal;tolerance\na;10,5;0,1\n";
/// assert!(has_header(&stack_sheet(table), &[]));
/// assert!(has_header(&stack_sheet(&format!("Gearbox, second draft, play\n{table}")), &[]));
/// ```
pub fn stack_sheet(text: &str) -> Sheet {
    let found = Sheet::of_text(text);
    if has_header(&found, &[]) {
        return found;
    }
    let others = DELIMITERS.map(|mark| Sheet::separated(text, mark));
    others.into_iter().find(|sheet| has_header(sheet, &[])).unwrap_or(found)
}
