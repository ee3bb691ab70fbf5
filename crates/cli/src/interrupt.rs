//! Ctrl-C: the first stops cleanly, the second gives up what is under way, the third leaves at once.
//!
//! SIGTERM and SIGHUP are heard as Ctrl-C is. Where no person watches a terminal, a scheduler kills after some 30 s whatever has not
//! ended: the second and third step then follow by themselves.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use super::output::error;
use sensitol::summary::StopReason;

/// How long a run without a terminal waits for what is under way, and then for the report.
const PATIENCE: Duration = Duration::from_secs(10);
const LAST: Duration = Duration::from_secs(3);

static PRESSED: AtomicUsize = AtomicUsize::new(0);

/// Listens from now on. A process that cannot listen is interrupted as any other.
pub(super) fn listen() {
    let _ = ctrlc::set_handler(|| match PRESSED.fetch_add(1, Ordering::SeqCst) {
        0 if !std::io::stderr().is_terminal() => {
            error("interrupted: waiting 10 s for what is under way");
            // Without a thread to wait, what is under way is given up at once.
            if std::thread::Builder::new().spawn(hurry).is_err() {
                PRESSED.fetch_max(2, Ordering::SeqCst);
            }
        }
        0 => error("interrupted: waiting for what is under way; once more gives that up"),
        1 => error("interrupted again: giving up what is under way"),
        _ => std::process::exit(130),
    });
}

/// Gives up what is under way after 10 s, and leaves 3 s later, whatever is done by then.
fn hurry() {
    std::thread::sleep(PATIENCE);
    PRESSED.fetch_max(2, Ordering::SeqCst);
    std::thread::sleep(LAST);
    std::process::exit(130);
}

/// Why to stop, once the user said so.
pub(super) fn reason() -> Option<StopReason> {
    stopped().then_some(StopReason::Interrupted)
}

/// Whether to stop.
pub(super) fn stopped() -> bool {
    PRESSED.load(Ordering::SeqCst) > 0
}

/// Whether to give up what is under way too.
pub(super) fn abandoned() -> bool {
    PRESSED.load(Ordering::SeqCst) > 1
}
