//! Ctrl-C: the first one stops cleanly, the second one gives up running evaluations, the third one ends the process at once.
//!
//! SIGTERM and SIGHUP act like Ctrl-C. Without a terminal, a scheduler kills a process that has not ended after some 30 s, so the second
//! and third step then follow by themselves.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use crate::output::error;
use sensitol::summary::StopReason;

/// Time that a run without a terminal waits for running evaluations.
const PATIENCE: Duration = Duration::from_secs(10);
/// Time that follows for the report.
const LAST: Duration = Duration::from_secs(3);

/// Number of interruptions so far.
static PRESSED: AtomicUsize = AtomicUsize::new(0);

/// Installs the handler. A process without it is interrupted like any other.
pub(super) fn listen() {
    let _ = ctrlc::set_handler(|| match PRESSED.fetch_add(1, Ordering::SeqCst) {
        0 if !std::io::stderr().is_terminal() => {
            error("interrupted: waiting 10 s for what is under way");
            // If no thread can be started to wait, running evaluations are given up at once.
            if std::thread::Builder::new().spawn(hurry).is_err() {
                PRESSED.fetch_max(2, Ordering::SeqCst);
            }
        }
        0 => error("interrupted: waiting for what is under way; once more gives that up"),
        1 => error("interrupted again: giving up what is under way"),
        _ => std::process::exit(130),
    });
}

/// Installs a handler for a command that an interruption ends as planned: the first one stops it without a message.
pub(super) fn listen_silently() {
    let _ = ctrlc::set_handler(|| {
        if PRESSED.fetch_add(1, Ordering::SeqCst) > 1 {
            std::process::exit(130);
        }
    });
}

/// Gives up running evaluations after 10 s, and ends the process 3 s later in any case.
fn hurry() {
    std::thread::sleep(PATIENCE);
    PRESSED.fetch_max(2, Ordering::SeqCst);
    std::thread::sleep(LAST);
    std::process::exit(130);
}

/// Returns the stop reason after an interruption.
pub(super) fn reason() -> Option<StopReason> {
    stopped().then_some(StopReason::Interrupted)
}

/// True if the run should stop.
pub(super) fn stopped() -> bool {
    PRESSED.load(Ordering::SeqCst) > 0
}

/// True if running evaluations should be given up as well.
pub(super) fn abandoned() -> bool {
    PRESSED.load(Ordering::SeqCst) > 1
}
