//! `sensitol watch`: analyses a study again at each save.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use sha2::{Digest, Sha256};

use crate::args::WatchArgs;
use crate::commands::analyze::analyze;
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::output::{Destination, Look, error, told};
use crate::running::{Clock, externals};
use crate::study;
use sensitol_report::document::{Detail, Style};
use sensitol_report::{DifferenceReport, Report};

/// Interval between two looks at the files: short beside the time that a person needs to look up.
const LOOK: Duration = Duration::from_millis(200);

/// State of a file: time and size, which are cheap, and a hash of the content.
#[derive(Debug, Clone, PartialEq)]
struct FileState {
    path: PathBuf,
    /// None if the file cannot be read.
    stamp: Option<(SystemTime, u64)>,
    hash: Option<[u8; 32]>,
}

impl FileState {
    fn of(path: &Path) -> Self {
        let hash = std::fs::read(path).ok().map(|content| Sha256::digest(content).into());
        Self { path: path.to_owned(), stamp: stamp(path), hash }
    }

    /// True if the content differs. A file with the same time and size is not read.
    fn changed(&mut self) -> bool {
        if stamp(&self.path) == self.stamp {
            return false;
        }
        let now = Self::of(&self.path);
        let changed = now.hash != self.hash;
        *self = now;
        changed
    }
}

fn stamp(path: &Path) -> Option<(SystemTime, u64)> {
    let there = std::fs::metadata(path).ok()?;
    Some((there.modified().ok()?, there.len()))
}

/// Study with the files that it reads, and its last result.
struct Watched<'a> {
    asked: &'a WatchArgs,
    look: Look<'a>,
    files: Vec<FileState>,
    last: Option<Report>,
}

/// Runs `sensitol watch` until it is interrupted.
pub(crate) fn run(asked: &WatchArgs, look: Look) -> Result<Exit, Failure> {
    interrupt::listen_silently();
    let path = &asked.study.study;
    if !path.exists() {
        // A study that is not there is a mistake of the command line. Reading it gives its error.
        study::read(&asked.study, externals(None, look, None))?;
    }
    let mut watched = Watched { asked, look, files: vec![FileState::of(path)], last: None };
    if !look.quiet {
        told(&format!("watching {}: Ctrl-C ends it", path.display()));
    }
    watched.analyze_again()?;
    while !interrupt::stopped() {
        std::thread::sleep(LOOK);
        if watched.saved() {
            watched.analyze_again()?;
        }
    }
    Ok(Exit::Done)
}

impl Watched<'_> {
    /// True if a file has new content that is complete: an editor may be writing it at the first look.
    fn saved(&mut self) -> bool {
        let mut saved = false;
        loop {
            let mut changed = false;
            for file in &mut self.files {
                changed |= file.changed();
            }
            if !changed {
                break;
            }
            saved = true;
            std::thread::sleep(LOOK);
        }
        // A file that is missing for a moment is being replaced.
        saved && self.files.first().is_none_or(|study| study.hash.is_some())
    }

    /// Prints the new result, or the error of the study. Only an output that cannot be written ends watching.
    fn analyze_again(&mut self) -> Result<(), Failure> {
        match self.result() {
            Ok(report) => self.show(report),
            Err(failure @ (Failure::ClosedPipe | Failure::Stdout(_))) => Err(failure),
            Err(failure) => {
                failure.render().iter().for_each(|message| error(message));
                Ok(())
            }
        }
    }

    fn result(&mut self) -> Result<Report, Failure> {
        let externals = externals(self.asked.work.journal.as_deref(), self.look, None);
        let study = study::read(&self.asked.study, externals)?;
        let read = study.files.iter().map(|file| file.path.as_path());
        let paths: Vec<&Path> = std::iter::once(self.asked.study.study.as_path()).chain(read).collect();
        self.files.retain(|known| paths.contains(&known.path.as_path()));
        for path in paths {
            if self.files.iter().all(|known| known.path != path) {
                self.files.push(FileState::of(path));
            }
        }
        let clock = Clock::start(self.asked.work.time)?;
        let analysis = analyze(&study, self.asked.threads, &clock, self.look)?;
        Ok(Report::keeping(&study.problem, analysis, clock.about(&study)))
    }

    /// Prints a line for every characteristic, the codes of the warnings, and the difference from the last result.
    fn show(&mut self, report: Report) -> Result<(), Failure> {
        // An interrupted analysis is incomplete, and the command ends.
        if interrupt::stopped() {
            return Ok(());
        }
        let style = Style { detail: Detail::Short, ..self.look.terminal_style() };
        let mut text = report.brief(style);
        let codes: Vec<&str> = report.warnings.iter().filter(|one| one.asks()).map(|one| one.code).collect();
        if !codes.is_empty() && !self.look.quiet {
            text += &format!("  warnings: {}\n", codes.join(", "));
        }
        if let Some(last) = &self.last {
            let name = self.asked.study.study.display().to_string();
            text += &DifferenceReport::of([last, &report], [name.clone(), name]).brief(style);
        }
        self.last = Some(report);
        Destination::Stdout.write(&text)
    }
}
