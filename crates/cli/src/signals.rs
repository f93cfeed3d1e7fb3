//! Ctrl-C, SIGTERM and SIGHUP, which a terminal that closes sends: unfinished outputs are removed from the disk, and the exit code is that
//! of shells, 128 + signal: 130, 143 and 129.

use std::sync::Mutex;

/// Locked once the program ends because of a signal.
static ENDING: Mutex<()> = Mutex::new(());

/// Begins to wait for signals, but not for those that the caller has this program ignore. If the system grants no thread for this, a signal
/// ends the program at once, and the next run cleans up.
#[cfg(unix)]
pub(super) fn watch() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let wait = || {
        // Where the system does not tell, `nohup` may have had SIGHUP ignored.
        let is_heard = |&signal: &i32| !is_ignored(signal).unwrap_or(signal == SIGHUP);
        let heard = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(is_heard);
        let Ok(mut signals) = Signals::new(heard) else { return };
        let Some(signal) = signals.forever().next() else { return };
        let _ending = ENDING.lock();
        wheelrail::files::discard_all();
        std::process::exit(128 + signal);
    };
    drop(std::thread::Builder::new().name("signals".into()).spawn(wait));
}

/// Whether the caller has this program ignore a signal, as `nohup` does with SIGHUP and a script with the SIGINT of what it begins by `&`;
/// `None` where the system does not tell.
#[cfg(unix)]
fn is_ignored(signal: i32) -> Option<bool> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.map(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Does nothing: on other systems Ctrl-C ends the program at once, and the next run cleans up.
#[cfg(not(unix))]
pub(super) fn watch() {}

/// Returns at once, unless the program ends because of a signal: then it does not return.
pub(super) fn stay_if_ending() {
    drop(ENDING.lock());
}
