//! Progress on stderr: names the step at which a long command is.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::answer::complain;

/// Time without output after which progress is reported. A command that ends earlier reports nothing.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between two changes of the line on a terminal.
const TICK: Duration = Duration::from_millis(200);

/// Steps of a terminal's bar from 0 to 100 %.
const BAR: u64 = 1000;

/// The step at which a command is.
#[derive(Debug, Clone)]
struct Stage {
    step: String,
    /// Share of the work that is done, 0 to 1, where it is known.
    share: Option<f64>,
}

/// Reports the progress of a command until it is dropped: on a terminal one line with percentage and remaining time, elsewhere
/// a line every two seconds. It has a thread of its own, because a single step may take longer than users want to wait.
#[derive(Debug)]
pub(super) struct Progress {
    at: Arc<Mutex<Stage>>,
    /// Dropping the sender stops the reporting thread.
    at_work: Option<Sender<()>>,
    teller: Option<thread::JoinHandle<()>>,
}

impl Progress {
    /// Starts to report on the command with this name, which is at its first step.
    pub(super) fn of(command: &'static str, step: &str) -> Self {
        if std::io::stderr().is_terminal() {
            return Self::on_terminal(command, step);
        }
        Self::told(PATIENCE, step, move |line| complain(&format!("{command}: {line}")))
    }

    /// Reports nothing.
    pub(super) fn silent() -> Self {
        let at = Arc::new(Mutex::new(Stage { step: String::new(), share: None }));
        Self { at, at_work: None, teller: None }
    }

    fn on_terminal(command: &'static str, step: &str) -> Self {
        Self::with_teller(step, PATIENCE, TICK, move |wait| {
            let bar = ProgressBar::new(BAR);
            let style = |template: &str| {
                ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
            };
            let [known, unknown] =
                ["{prefix}: {percent} % {msg} (ready in {eta})", "{prefix}: {msg} ({elapsed})"].map(style);
            bar.set_prefix(command);
            while let Some(Stage { step, share }) = wait() {
                bar.set_style(if share.is_some() { known.clone() } else { unknown.clone() });
                bar.set_position((share.unwrap_or(0.0) * BAR as f64) as u64);
                bar.set_message(step);
                bar.tick();
            }
            bar.finish_and_clear();
        })
    }

    fn told(patience: Duration, step: &str, tell: impl Fn(&str) + Send + 'static) -> Self {
        let start = Instant::now();
        Self::with_teller(step, patience, patience, move |wait| {
            while let Some(Stage { step, .. }) = wait() {
                tell(&format!("{step} ({} s)", start.elapsed().as_secs()));
            }
        })
    }

    /// Starts the thread of `teller`, whose argument waits for the next time to tell: `patience` first, then `tick`. It gives
    /// `None` when the command has ended.
    fn with_teller(
        step: &str,
        patience: Duration,
        tick: Duration,
        teller: impl FnOnce(&mut dyn FnMut() -> Option<Stage>) + Send + 'static,
    ) -> Self {
        let (at_work, done) = channel();
        let at = Arc::new(Mutex::new(Stage { step: step.to_owned(), share: None }));
        let seen = Arc::clone(&at);
        let work = move || {
            if done.recv_timeout(patience) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let mut first = true;
            teller(&mut || {
                let ended = !first && done.recv_timeout(tick) != Err(RecvTimeoutError::Timeout);
                first = false;
                (!ended).then(|| seen.lock().unwrap_or_else(PoisonError::into_inner).clone())
            });
        };
        // If the system grants no thread, the work is done without reports.
        let teller = thread::Builder::new().name("progress".into()).spawn(work).ok();
        Self { at, at_work: Some(at_work), teller }
    }

    /// Names the step at which the command is from now on.
    pub(super) fn at(&self, step: impl Into<String>) {
        self.set(Stage { step: step.into(), share: None });
    }

    /// Names the step, with the share of the work that is done, 0 to 1.
    pub(super) fn share(&self, step: impl Into<String>, share: f64) {
        self.set(Stage { step: step.into(), share: Some(share) });
    }

    fn set(&self, stage: Stage) {
        *self.at.lock().unwrap_or_else(PoisonError::into_inner) = stage;
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        drop(self.at_work.take());
        // The line on the terminal has to be gone before anything else is written there.
        if let Some(teller) = self.teller.take() {
            drop(teller.join());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the lines reported on two steps, each of which takes until there is a line on it, if `waits` is set.
    fn lines(patience: Duration, waits: bool) -> Vec<String> {
        let lines = Arc::new(Mutex::new(Vec::<String>::new()));
        let told = Arc::clone(&lines);
        let progress =
            Progress::told(patience, "one", move |line| told.lock().unwrap().push(line.to_owned()));
        let wait = |step: &str| {
            while waits && !lines.lock().unwrap().iter().any(|line| line.starts_with(step)) {
                thread::sleep(Duration::from_millis(1));
            }
        };
        wait("one (");
        progress.share("two", 0.5);
        wait("two (");
        drop(progress);
        lines.lock().unwrap().clone()
    }

    #[test]
    fn every_long_step_is_told_and_short_work_is_not() {
        let told = lines(Duration::from_millis(30), true);
        for step in ["one (", "two ("] {
            let seconds = |line: &String| line.strip_prefix(step)?.strip_suffix(" s)")?.parse::<u64>().ok();
            assert!(told.iter().any(|line| seconds(line).is_some()), "{told:?}");
        }
        assert!(lines(Duration::from_secs(60), false).is_empty());
    }
}
