//! Times this program as its users wait for it.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use wheelrail::error::{Error, Result};
use wheelrail_report::processes::{PROCESSES, Process, ProcessCost};

/// Number of runs of each scene; the shortest counts. The first ones find neither program nor folder in memory.
const RUNS: usize = 40;

/// Times the scenes of [`PROCESSES`], each in processes of its own, one after the other.
///
/// # Errors
/// A folder for the files that cannot be made; a process that cannot be started or fails.
pub(super) fn costs() -> Result<Vec<ProcessCost>> {
    let failed = |error: &dyn std::fmt::Display| {
        Error::new("processes", error.to_string(), "a run that ends well", "free some disk and memory")
    };
    let program = std::env::current_exe().map_err(|error| failed(&error))?;
    let folder = tempfile::tempdir().map_err(|error| failed(&error))?;
    let cost = |process: &Process| {
        let scene = folder.path().join("scene.toml");
        fs::write(&scene, process.scene).map_err(|error| failed(&error))?;
        let once = || once(&program, &scene).map_err(|error| failed(&error));
        let seconds = (0..RUNS).map(|_| once()).try_fold(f64::INFINITY, |best, time| Ok(time?.min(best)))?;
        Ok(ProcessCost { process: *process, seconds })
    };
    PROCESSES.iter().map(cost).collect()
}

/// Returns the wall-clock time of one run \[s\].
fn once(program: &Path, scene: &Path) -> std::io::Result<f64> {
    let mut command = Command::new(program);
    command.arg("run").arg(scene).arg("--out").arg(scene.with_extension("files"));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let start = Instant::now();
    let status = command.status()?;
    let seconds = start.elapsed().as_secs_f64();
    if status.success() { Ok(seconds) } else { Err(std::io::Error::other(format!("{status}"))) }
}
