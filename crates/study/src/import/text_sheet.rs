//! Sheet of a stack-up table in a text file.

use crate::import::header::has_header;
use crate::import::sheet::Sheet;
use crate::table::DELIMITERS;

/// Sheet of a stack-up table in a text with tabs, semicolons or commas between the columns. A title above the header does not decide on the
/// delimiter: the first one that gives a header does.
///
/// ```
/// use sensitol_study::import::stack_sheet;
/// let plain = stack_sheet("name;nominal;tolerance\na;10,5;0,1\n");
/// let titled = stack_sheet("Gearbox, second draft, play\nname;nominal;tolerance\na;10,5;0,1\n");
/// assert_eq!(titled.rows[1].1, plain.rows[0].1);
/// ```
pub fn stack_sheet(text: &str) -> Sheet {
    let found = Sheet::of_text(text);
    if has_header(&found, &[]) {
        return found;
    }
    let others = DELIMITERS.map(|mark| Sheet::separated(text, mark));
    others.into_iter().find(|sheet| has_header(sheet, &[])).unwrap_or(found)
}
