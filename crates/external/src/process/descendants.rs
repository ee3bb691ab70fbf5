//! Processes that a child started and that left its process group, found by a mark in their environment.
//!
//! A descendant inherits the mark, wherever it moves: into a group or session of its own, or to another parent. Children that the program
//! around this library started itself have no mark, and stay.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

/// Variable of the environment that holds the marks of all engines above a process.
pub(super) const VARIABLE: &str = "SENSITOL_PROCESS";
/// Greatest number of searches for one child: a process that was about to start another one at the first is found by the second.
const SEARCHES: usize = 8;

/// Mark of one child and its descendants.
#[derive(Debug, Clone)]
pub(super) struct Mark(String);

impl Mark {
    /// Mark that no other child has, on this machine and of any run.
    pub(super) fn new() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let since = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        Self(format!("sensitol-{}-{since:x}-{count}", std::process::id()))
    }

    /// Text of the mark, which no other text in an environment holds.
    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// Value of the variable for the child: the marks of engines above this one, then its own.
    pub(super) fn value(&self) -> String {
        let above = std::env::var(VARIABLE).map_or(String::new(), |above| format!("{above}:"));
        format!("{above}{}:", self.0)
    }

    /// Kills every process with one of the marks. Where there is no /proc, none is found.
    pub(super) fn kill<'a>(marks: impl IntoIterator<Item = &'a Self>) {
        let marks: Vec<String> = marks.into_iter().map(|mark| format!("{}:", mark.0)).collect();
        for _ in 0..SEARCHES {
            let found = if marks.is_empty() { Vec::new() } else { living(&marks) };
            if found.is_empty() {
                return;
            }
            let mut command = Command::new("/bin/sh");
            command.args(["-c", "kill -s KILL \"$@\"", "sensitol-end"]).args(&found);
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            let _ = command.status();
        }
    }
}

/// Numbers of the processes with one of the marks. A zombie has no environment, and is not among them.
fn living(marks: &[String]) -> Vec<String> {
    let own = std::process::id().to_string();
    let numbers = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let numbers = numbers.filter_map(|entry| entry.file_name().into_string().ok());
    let numbers = numbers.filter(|name| name.bytes().all(|digit| digit.is_ascii_digit()) && *name != own);
    let marked = |number: &String| {
        let environment = std::fs::read(Path::new("/proc").join(number).join("environ")).unwrap_or_default();
        let name = format!("{VARIABLE}=");
        let of = environment.split(|&byte| byte == 0).find_map(|entry| entry.strip_prefix(name.as_bytes()));
        let value = String::from_utf8_lossy(of.unwrap_or_default());
        marks.iter().any(|mark| value.contains(mark.as_str()))
    };
    numbers.filter(marked).collect()
}
