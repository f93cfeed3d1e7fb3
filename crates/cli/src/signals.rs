//! Ctrl-C and SIGTERM: unfinished outputs are removed from the disk, and the exit code is that of shells, 128 + signal: 130
//! and 143.

use std::sync::Mutex;

/// Locked once the program ends because of a signal.
static ENDING: Mutex<()> = Mutex::new(());

/// Begins to wait for signals. If the system grants no thread for this, a signal ends the program at once, and the next run
/// cleans up.
#[cfg(unix)]
pub(super) fn watch() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let wait = || {
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
        let Some(signal) = signals.forever().next() else { return };
        let _ending = ENDING.lock();
        wheelrail::files::discard_all();
        std::process::exit(128 + signal);
    };
    drop(std::thread::Builder::new().name("signals".into()).spawn(wait));
}

/// Does nothing: on other systems Ctrl-C ends the program at once, and the next run cleans up.
#[cfg(not(unix))]
pub(super) fn watch() {}

/// Returns at once, unless the program ends because of a signal: then it does not return.
pub(super) fn stay_if_ending() {
    drop(ENDING.lock());
}
