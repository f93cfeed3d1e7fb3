//! Progress on stderr: the step that a long command is at.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::answer::complain;

/// Silence on stderr after which progress is reported; a command that ends before says nothing.
const PATIENCE: Duration = Duration::from_secs(2);

/// Tells what a command is at until it is dropped. It has a thread of its own: one step may take longer than anybody's
/// patience.
#[derive(Debug)]
pub(super) struct Progress {
    at: Arc<Mutex<String>>,
    /// The teller waits for its end, and stops when it is dropped.
    _at_work: Sender<()>,
}

impl Progress {
    /// Starts to tell of the command with this name, which is at its first step.
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
        // A system that grants no thread gets the work done in silence.
        drop(thread::Builder::new().name("progress".into()).spawn(teller));
        Self { at, _at_work: at_work }
    }

    /// Names the step that the command is at from now on.
    pub(super) fn at(&self, step: impl Into<String>) {
        *self.at.lock().unwrap_or_else(PoisonError::into_inner) = step.into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines told of two steps that take 300 ms each.
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
