//! Work that takes long: without the GIL, stopped by Ctrl-C, and with its progress told.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use wheelrail::{Error, ErrorKind, Result};

use crate::errors::{OrRaise, exception};

/// Time between two checks for Ctrl-C and calls of `progress`: a quarter of the 0.2 s in which Ctrl-C ends the work.
const PATIENCE: Duration = Duration::from_millis(50);

/// How far long work is, and whether its result is still wanted.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    done: AtomicUsize,
    all: AtomicUsize,
    unwanted: AtomicBool,
}

impl Watch {
    /// Says how much of all the work is done.
    pub(crate) fn at(&self, done: usize, all: usize) {
        self.done.store(done, Ordering::Relaxed);
        self.all.store(all, Ordering::Relaxed);
    }

    /// Ends work whose result is not wanted, by an error that no user sees.
    ///
    /// # Errors
    /// After Ctrl-C.
    pub(crate) fn go_on(&self) -> Result<()> {
        if self.unwanted.load(Ordering::Relaxed) {
            return Err(Error::new("", "Ctrl-C", "nothing", "start again"));
        }
        Ok(())
    }

    /// Calls `progress(done, all)`, and lets Python handle its signals.
    fn tell(&self, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        Python::attach(|py| {
            py.check_signals()?;
            let Some(progress) = progress else { return Ok(()) };
            let [done, all] = [&self.done, &self.all].map(|count| count.load(Ordering::Relaxed));
            progress.call1(py, (done, all)).map(drop)
        })
    }

    /// Waits for the result of another thread; an exception of `progress` or Ctrl-C makes the work unwanted.
    fn result<T>(&self, receiver: &Receiver<T>, progress: Option<&Py<PyAny>>) -> PyResult<T> {
        loop {
            match receiver.recv_timeout(PATIENCE) {
                Ok(value) => return Ok(value),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(fault(&"the work ended without a result"));
                }
                Err(RecvTimeoutError::Timeout) => {
                    self.tell(progress).inspect_err(|_| self.unwanted.store(true, Ordering::Relaxed))?;
                }
            }
        }
    }
}

/// Does work of one thread without the GIL.
///
/// # Errors
/// A RuntimeError for a fault of the library, which ends the work and not the process.
pub(crate) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work))).map_err(|panic| fault(panic.as_ref()))
}

/// Does work that the library shares among threads without the GIL.
///
/// # Errors
/// Those of [`detached`]; a LimitError where the system grants no threads.
pub(crate) fn shared<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = threads(py)?;
    detached(py, || pool.install(work))
}

/// The threads among which the library shares its work, and the number of the process that they are of.
static THREADS: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);

/// Gives the threads of this process; the first call makes them. Those of rayon's own pool would be missing in a child that was forked
/// after their first work, and the child would wait for them for ever.
///
/// Python forks while it holds the GIL, as the caller does, so that no child finds the lock taken.
fn threads(_: Python<'_>) -> PyResult<&'static ThreadPool> {
    let mut known = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((process, pool)) = *known
        && process == process::id()
    {
        return Ok(pool);
    }
    let made = ThreadPoolBuilder::new().build().map_err(|error| {
        let advice = "end other programs, or set RAYON_NUM_THREADS to a smaller number";
        let error = Error::new("threads", error.to_string(), "threads of the system", advice);
        exception(error.of_kind(ErrorKind::Limit))
    })?;
    // The pool of a parent is never dropped: to end its threads would wait for them.
    let made: &'static ThreadPool = Box::leak(Box::new(made));
    *known = Some((process::id(), made));
    Ok(made)
}

/// Makes the exception of a panic.
fn fault(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
    let text = text.unwrap_or("the work ended without a result");
    PyRuntimeError::new_err(format!("a fault of wheelrail, please report it: {text}"))
}

/// Does work, and calls `progress`, which is as `wheelrail._progress.shown` takes it, with the name of what its bar counts. Ctrl-C ends
/// the wait for the work within 0.2 s: its thread goes on to the next call of [`Watch::go_on`], which work has to make before it writes
/// results.
///
/// # Errors
/// Those of the work and of `progress`; KeyboardInterrupt.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<(&Py<PyAny>, &str)>,
    work: impl FnOnce(&Watch) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let Some((progress, counted)) = progress else { return told(py, None, work) };
    let shown = py.import("wheelrail._progress")?.call_method1("shown", (progress, counted))?;
    let call: Option<Py<PyAny>> = shown.call_method0("__enter__")?.extract()?;
    let result = told(py, call.as_ref(), work);
    // Its own exceptions are those of `progress`, which the result has.
    let closed = shown.call_method1("__exit__", (py.None(), py.None(), py.None()));
    result.and_then(|value| closed.map(|_| value))
}

/// Does work as [`watched`] does, and calls `progress(done, all)`.
fn told<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let (watch, pool) = (Arc::new(Watch::default()), threads(py)?);
    let result = py.detach(|| {
        let (sender, receiver) = channel();
        let seen = Arc::clone(&watch);
        // A send fails only where nobody waits for it.
        thread::spawn(move || drop(sender.send(pool.install(|| work(&seen)))));
        watch.result(&receiver, progress)
    })?;
    let value = result.or_raise()?;
    if let Some(progress) = progress {
        let all = watch.all.load(Ordering::Relaxed);
        progress.call1(py, (all, all))?;
    }
    Ok(value)
}

/// Does work as [`watched`] does, and tells no progress.
///
/// # Errors
/// Those of the work; KeyboardInterrupt.
pub(crate) fn waited<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Watch) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    told(py, None, work)
}
