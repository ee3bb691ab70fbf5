//! Runs of a study for a page.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use serde_json::json;

use crate::commands::serve::answer::{Answer, Lines};
use crate::commands::serve::connection::Connection;
use crate::commands::serve::folder::Folder;
use crate::commands::serve::guard::Query;
use crate::interrupt;
use sensitol::assembly::{Progress, Run};
use sensitol::summary::StopReason;
use sensitol_report::task::{Task, TaskPlace};
use sensitol_study::{Externals, JournalPlace};

/// Interval between two empty lines that show if the page still listens.
const BEAT: Duration = Duration::from_millis(500);

/// Returns a study in keys of JSON, or its faults.
pub(in crate::commands::serve) fn keys(folder: &Folder, query: &Query, told: &str) -> Answer {
    match asked(folder, query, told) {
        Ok((task, path)) => {
            let place = TaskPlace { folder: parent(&path), root: Some(folder.root()), ..TaskPlace::default() };
            Answer::json(task.study(&place))
        }
        Err(refusal) => refusal,
    }
}

/// Runs a task and reports progress to the page. The run ends if the page is gone. A program starts only if the request says that the user
/// requested it.
pub(in crate::commands::serve) fn run(folder: &Folder, query: &Query, told: &str, connection: &Connection) {
    let (task, path) = match asked(folder, query, told) {
        Ok(asked) => asked,
        Err(refusal) => return refusal.send(connection),
    };
    let (gone, done) = (AtomicBool::new(false), AtomicBool::new(false));
    let lines = Mutex::new(Lines::begin(connection));
    let tell = |text: &str| {
        let heard = lines.lock().unwrap_or_else(PoisonError::into_inner).line(text);
        if !heard {
            gone.store(true, Ordering::SeqCst);
        }
    };
    let stop = || {
        let ended = gone.load(Ordering::SeqCst).then_some(StopReason::Interrupted);
        ended.or_else(interrupt::reason)
    };
    let abandon = || gone.load(Ordering::SeqCst) || interrupt::abandoned();
    // The expected number comes first. Costly models report their answered points separately.
    let expected = Mutex::new(0);
    let counted = |answered: u64, points: u64| {
        *expected.lock().unwrap_or_else(PoisonError::into_inner) = points;
        tell(&json!({ "answered": answered, "expected": points }).to_string());
    };
    let show = |progress: Progress| {
        let points = *expected.lock().unwrap_or_else(PoisonError::into_inner);
        tell(&json!({ "answered": progress.points, "expected": points.max(progress.points as u64) }).to_string());
    };
    let starts_programs = query.get("programs") == Some("yes");
    // Without a program there are no answers to keep.
    let journal = match starts_programs {
        true => JournalPlace::At(path.with_extension("journal.sqlite")),
        false => JournalPlace::Nowhere,
    };
    let place = TaskPlace {
        folder: parent(&path),
        root: Some(folder.root()),
        starts_programs,
        externals: Externals::default().with_journal(journal),
        run: Run::to_the_end().stopping_when(&stop).abandoning_when(&abandon).showing(&show),
    };
    let found = std::thread::scope(|scope| {
        let beats = scope.spawn(|| {
            while !done.load(Ordering::SeqCst) {
                std::thread::park_timeout(BEAT);
                tell("");
            }
        });
        let found = catch_unwind(AssertUnwindSafe(|| task.run(&place, &counted)));
        done.store(true, Ordering::SeqCst);
        // The thread is woken, so that a quick run does not wait for the next beat.
        beats.thread().unpark();
        found
    });
    let found = found.unwrap_or_else(|_| json!({ "error": "the engine failed", "advice": [] }).to_string());
    tell(&format!("{{\"found\":{found}}}"));
    lines.into_inner().unwrap_or_else(PoisonError::into_inner).end();
}

/// Returns the task of a page, and the path of its study.
fn asked(folder: &Folder, query: &Query, told: &str) -> Result<(Task, PathBuf), Answer> {
    let task = Task::read(told).map_err(|error| Answer::refused(400, &error.to_string()))?;
    Ok((task, folder.place(query)?))
}

fn parent(path: &Path) -> PathBuf {
    path.parent().map_or_else(|| PathBuf::from("."), Path::to_path_buf)
}
