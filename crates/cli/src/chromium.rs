//! Prints a page by an installed Chromium.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::failure::Failure;
use crate::interrupt;
use sensitol_external::process::GroupedProcess;
use sensitol_report::html::{Paper, on_paper};

/// Variable that names the browser.
const VARIABLE: &str = "SENSITOL_CHROMIUM";
/// Names of the browser on PATH, the first that is found is taken.
const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
/// Longest time of a print, with and without a sandbox together. A page takes about two seconds, and a loaded machine ten times as long.
const LIMIT: Duration = Duration::from_secs(60);
/// Time between two looks at the browser.
const LOOK: Duration = Duration::from_millis(20);
/// Last line of a printed page, after the end of the PDF. It marks the file as one of this program.
pub(crate) const MARK: &[u8] = b"\n% report of sensitol\n";
/// Territories with the paper size Letter (Unicode CLDR, `measurementData`).
const LETTER: [&str; 14] = ["BZ", "CA", "CL", "CO", "CR", "GT", "MX", "NI", "PA", "PH", "PR", "SV", "US", "VE"];

/// Returns the browser that the variable names, or the first one on PATH.
pub(crate) fn browser() -> Result<PathBuf, Failure> {
    if let Some(named) = std::env::var_os(VARIABLE).filter(|named| !named.is_empty()) {
        let path = PathBuf::from(named);
        return if path.is_file() { Ok(path) } else { Err(Failure::NoBrowser { named: Some(path) }) };
    }
    let folders: Vec<PathBuf> = std::env::var_os("PATH").iter().flat_map(std::env::split_paths).collect();
    let file = |name: &str| format!("{name}{}", std::env::consts::EXE_SUFFIX);
    let places = NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(file(name))));
    places.into_iter().find(|path| path.is_file()).ok_or(Failure::NoBrowser { named: None })
}

/// Returns the page as PDF.
pub(crate) fn printed(browser: &Path, page: &str) -> Result<Vec<u8>, Failure> {
    let failed = |reason: String| Failure::NotPrinted { browser: browser.to_owned(), reason };
    let unusable = |error: std::io::Error| failed(error.to_string());
    let folder = tempfile::tempdir().map_err(unusable)?;
    let (source, target) = (folder.path().join("page.html"), folder.path().join("page.pdf"));
    std::fs::write(&source, on_paper(page, paper())).map_err(unusable)?;
    // A browser of root, or in a container, starts without its sandbox only. The page loads nothing and runs its own scripts.
    let mut reason = String::new();
    let wait = PrintWait { begun: Instant::now(), was_stopped: interrupt::stopped() };
    for flags in [&[][..], &["--no-sandbox"]] {
        if wait.over().is_some() {
            break;
        }
        reason = match print(browser, flags, &wait, [folder.path(), &source, &target]) {
            Ok(()) => match std::fs::read(&target) {
                Ok(pdf) if pdf.starts_with(b"%PDF") => return Ok([&pdf, MARK].concat()),
                _ => "it wrote no PDF".to_owned(),
            },
            Err(reason) => reason,
        };
    }
    Err(failed(reason))
}

/// Wait for a print.
struct PrintWait {
    /// Start of the first browser.
    begun: Instant,
    /// True if Ctrl-C ended the analysis before. Its report is printed then.
    was_stopped: bool,
}

impl PrintWait {
    /// Reason to end the browser. Ctrl-C does not reach it in its own group.
    fn over(&self) -> Option<String> {
        if interrupt::stopped() && !self.was_stopped {
            return Some("it was interrupted".to_owned());
        }
        (self.begun.elapsed() >= LIMIT).then(|| format!("it printed nothing within {} s", LIMIT.as_secs()))
    }
}

/// Runs the browser on a page, with its profile in a folder of its own.
fn print(browser: &Path, flags: &[&str], wait: &PrintWait, [folder, source, target]: [&Path; 3]) -> Result<(), String> {
    let of = |name: &str, path: &Path| format!("--{name}={}", path.display());
    let mut command = Command::new(browser);
    command
        .args(["--headless", "--disable-gpu", "--no-first-run", "--disable-background-networking"])
        .args(["--no-pdf-header-footer", &of("user-data-dir", &folder.join("profile")), &of("print-to-pdf", target)])
        .args(flags)
        .arg(source)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    // A browser is several processes, which end together.
    let mut child = GroupedProcess::start(command).map_err(|error| error.to_string())?;
    loop {
        match (child.try_wait(), wait.over()) {
            (Ok(Some(status)), _) if status.success() => return Ok(()),
            (Ok(Some(status)), _) => return Err(format!("it ended with {status}")),
            (Ok(None), None) => std::thread::sleep(LOOK),
            (Ok(None), Some(reason)) => {
                let _ = child.kill();
                return Err(reason);
            }
            (Err(error), _) => return Err(error.to_string()),
        }
    }
}

/// Paper of the user's locale.
fn paper() -> Paper {
    let set = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
    let locale = set("LC_ALL").or_else(|| set("LC_PAPER")).or_else(|| set("LANG")).unwrap_or_default();
    paper_of(&locale)
}

/// Paper of a locale such as `en_US.UTF-8`. It is A4 where the territory is unknown.
fn paper_of(locale: &str) -> Paper {
    let territory = locale.split(['.', '@']).next().and_then(|name| name.split('_').nth(1)).unwrap_or_default();
    if LETTER.contains(&territory) { Paper::Letter } else { Paper::A4 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_follows_the_locale() {
        let papers = ["en_US.UTF-8", "es_MX", "de_DE.UTF-8", "C.UTF-8", "", "en_GB@euro"].map(paper_of);
        use Paper::{A4, Letter};
        assert_eq!(papers, [Letter, Letter, A4, A4, A4, A4]);
    }
}
