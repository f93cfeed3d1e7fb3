//! Progress on stderr: names the step at which a long command is.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::answer::complain;

/// Time without output after which progress is reported. A command that ends earlier reports nothing.
const PATIENCE: Duration = Duration::from_secs(2);

/// Reports the progress of a command until it is dropped. It has a thread of its own, because a single step may take longer
/// than users want to wait.
#[derive(Debug)]
pub(super) struct Progress {
    at: Arc<Mutex<String>>,
    /// The reporting thread stops when this is dropped.
    _at_work: Sender<()>,
}

impl Progress {
    /// Starts to report on the command with this name, which is at its first step.
    pub(super) fn of(command: &'static str, step: &str) -> Self {
        Self::told(PATIENCE, step, move |line| complain(&format!("{command}: {line}")))
    }

    fn told(patience: Duration, step: &str, tell: impl Fn(&str) + Send + 'static) -> Self {
        let (at_work, done) = channel();
        let at = Arc::new(Mutex::new(step.to_owned()));
        let (seen, start) = (Arc::clone(&at), Instant::now());
        let teller = move || {
            while done.recv_timeout(patience) == Err(RecvTimeoutError::Timeout) {
                let at = seen.lock().unwrap_or_else(PoisonError::into_inner).clone();
                tell(&format!("{at} ({} s)", start.elapsed().as_secs()));
            }
        };
        // If the system grants no thread, the work is done without reports.
        drop(thread::Builder::new().name("progress".into()).spawn(teller));
        Self { at, _at_work: at_work }
    }

    /// Names the step at which the command is from now on.
    pub(super) fn at(&self, step: impl Into<String>) {
        *self.at.lock().unwrap_or_else(PoisonError::into_inner) = step.into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the lines reported on two steps that take 300 ms each.
    fn lines(patience: Duration) -> Vec<String> {
        let lines = Arc::new(Mutex::new(Vec::new()));
        let told = Arc::clone(&lines);
        let progress =
            Progress::told(patience, "one", move |line| told.lock().unwrap().push(line.to_owned()));
        thread::sleep(Duration::from_millis(300));
        progress.at("two");
        thread::sleep(Duration::from_millis(300));
        drop(progress);
        lines.lock().unwrap().clone()
    }

    #[test]
    fn every_long_step_is_told_and_short_work_is_not() {
        let told = lines(Duration::from_millis(30));
        for step in ["one (", "two ("] {
            let seconds = |line: &String| line.strip_prefix(step)?.strip_suffix(" s)")?.parse::<u64>().ok();
            assert!(told.iter().any(|line| seconds(line).is_some()), "{told:?}");
        }
        assert!(lines(Duration::from_secs(60)).is_empty());
    }
}
