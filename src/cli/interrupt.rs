//! Ctrl-C: the first stops cleanly, the second gives up what is under way, the third leaves at once.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::output::error;
use crate::summary::StopReason;

static PRESSED: AtomicUsize = AtomicUsize::new(0);

/// Listens from now on. A process that cannot listen is interrupted as any other.
pub(super) fn listen() {
    let _ = ctrlc::set_handler(|| match PRESSED.fetch_add(1, Ordering::SeqCst) {
        0 => error("interrupted: waiting for what is under way; once more gives that up"),
        1 => error("interrupted again: giving up what is under way"),
        _ => std::process::exit(130),
    });
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
