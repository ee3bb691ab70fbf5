//! Files that may be written over: empty ones, and those that this program wrote.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use crate::chromium::MARK;
use sensitol::allocation::Status;
use sensitol::method::Method;
use sensitol_models::ALL;
use sensitol_report::AUTHOR;

/// Bytes at the beginning of a file that are searched for its marks. The head of a page with a long title fits into them.
const HEAD: u64 = 1 << 16;
/// Lines of a text within which a report names its method: below the title, and below the note of a mixed report.
const LINES: usize = 8;
/// First words of a report's lead line, before a colon, besides the names of methods, models and outcomes.
const LEADS: [&str; 4] = ["monte-carlo", "quasi-monte-carlo", "importance sampling", "reference"];
/// Outcomes of an allocation.
const OUTCOMES: [Status; 7] = [
    Status::Optimal,
    Status::LocalOptimum,
    Status::AlmostOptimal,
    Status::Infeasible,
    Status::NoFeasiblePointFound,
    Status::Inconclusive,
    Status::OutOfTime,
];
/// Beginnings of the other lead lines.
const OPENINGS: [&str; 10] = [
    "==> ",
    "## `",
    "stack of ",
    "**stack of ",
    "uncertainty of ",
    "**uncertainty of ",
    "ready after ",
    "engine-balance  ",
    "Pearson ",
    "normal, from ",
];
/// Beginnings of the header lines of tables.
const HEADERS: [&str; 21] = [
    "name,unit,nominal,lower,upper,zone,",
    "name,unit,nominal,mean,sigma,skewness,kurtosis,",
    "name,key,old,new",
    "characteristic,dimension,first,second,",
    "characteristic,dimension_a,dimension_b,mixed,",
    "characteristic,probability,value,error,source",
    "characteristic,row,name,unit,nominal,lower,upper,",
    "characteristic,row,name,estimate,uncertainty,",
    "study,characteristic,row,name,",
    "code,characteristic,dimension,message",
    "characteristic,figure,old,old_error,new,new_error",
    "characteristic,dimension,old,new",
    "characteristic,method,evaluations,cached,",
    "characteristic,unit,estimate,value,standard_error,",
    "characteristic,from,to,count",
    "characteristic,unit,side,limit,probability,",
    "characteristic,unit,parameter,at,nominal,mean,",
    "characteristic,inputs,first_order,total,",
    "characteristic,requirement,required,before,after,",
    "dimension,unit,before,after,lower_before,",
    "point,characteristic,requirement,required,cost,",
];

/// New contents of a file, which decide the contents that may be replaced.
pub(super) enum Content<'h> {
    /// A report in any of its forms.
    Report,
    /// A table of points with this header line.
    Points { header: &'h str },
    /// A study. People edit studies, so none is written over.
    Study,
}

/// True if the file can be replaced without a loss: it is empty, or this program wrote it and can write it again.
pub(super) fn is_free(path: &Path, content: &Content<'_>) -> std::io::Result<bool> {
    let mut file = File::open(path)?;
    let mut head = Vec::new();
    (&mut file).take(HEAD).read_to_end(&mut head)?;
    if head.is_empty() {
        return Ok(true);
    }
    Ok(match content {
        Content::Study => false,
        Content::Points { header } => first_line(&head) == header.trim_end().as_bytes(),
        Content::Report if head.starts_with(b"%PDF") => is_own_print(file),
        Content::Report if head.starts_with(b"PK") => file.rewind().is_ok() && is_own_workbook(file),
        Content::Report => is_own_text(&String::from_utf8_lossy(&head)),
    })
}

fn first_line(head: &[u8]) -> &[u8] {
    head.split(|&byte| byte == b'\n').next().unwrap_or_default().trim_ascii_end()
}

/// True for a print that has not been changed since this program wrote it.
fn is_own_print(mut file: File) -> bool {
    let mut end = Vec::new();
    let from_end = std::io::SeekFrom::End(-(MARK.len() as i64));
    file.seek(from_end).and_then(|_| file.read_to_end(&mut end)).is_ok() && end == MARK
}

/// True for a workbook that has not been saved since this program wrote it.
fn is_own_workbook(file: File) -> bool {
    let mark = format!("<cp:lastModifiedBy>{AUTHOR}</cp:lastModifiedBy>");
    let core = || -> Option<String> {
        let mut text = String::new();
        let mut book = zip::ZipArchive::new(file).ok()?;
        book.by_name("docProps/core.xml").ok()?.take(HEAD).read_to_string(&mut text).ok()?;
        Some(text)
    };
    core().is_some_and(|core| core.contains(&mark))
}

/// True for a page, a chart, JSON, a table or a text report of this program, from the beginning of its text.
fn is_own_text(head: &str) -> bool {
    let lower = head.get(..15).unwrap_or_default().to_lowercase();
    if lower == "<!doctype html>" {
        // Reports have the name alone, and the workbench a version.
        let mark = "<meta name=\"generator\" content=\"sensitol";
        return head.split_once(mark).is_some_and(|(_, rest)| rest.starts_with(['"', ' ']));
    }
    if head.starts_with("<svg ") {
        return first_line(head.as_bytes()).ends_with(b"font-family=\"sans-serif\" font-size=\"12\" role=\"img\">");
    }
    if head.starts_with(['{', '[']) {
        return is_own_json(head);
    }
    let first = head.lines().next().unwrap_or_default();
    HEADERS.iter().any(|header| first.starts_with(header)) || head.lines().take(LINES).any(leads)
}

/// True for the beginning of JSON that carries the version of a report's shape, a schema of the program, or one of its lists.
fn is_own_json(head: &str) -> bool {
    let holds = |keys: &[&str]| keys.iter().all(|key| head.contains(&format!("\"{key}\": ")));
    holds(&["schema", "command"])
        || holds(&["study", "error"])
        || holds(&["$defs", "AboutEntry"])
        || holds(&["$defs", "title", "analyze"])
        || holds(&["name", "title", "source", "inputs"])
        || holds(&["type", "mean", "sigma", "skewness", "kurtosis", "support"])
}

/// True for a line at the head of a text report.
fn leads(line: &str) -> bool {
    let word = line.split_once(": ").map(|(word, _)| word).unwrap_or_default();
    let named = LEADS.contains(&word)
        || Method::ALL.iter().any(|method| method.name() == word)
        || OUTCOMES.iter().any(|status| status.name() == word);
    let named = named || ALL.iter().any(|model| model.name == word);
    let revisions = line.starts_with("from ") && line.contains(" to ") && line.contains(": ");
    named || revisions || OPENINGS.iter().any(|opening| line.starts_with(opening))
}
