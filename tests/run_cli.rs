//! `wheelrail run`, `midsep` and `schema` through the binary: progress, folders, sizes, and what bad scenes get.
#![allow(clippy::unwrap_used)]

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

const BODIES: &str =
    "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n";

/// A small grid, and few files.
const SMALL: &str = "[grid]\nxi = { from = -6.0, to = 6.0, n = 13 }\neta = { from = -8.0, to = 8.0, n = 17 }\n\
                     [output]\nformats = [\"npy\"]\n";

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    command.current_dir(folder).args(arguments);
    command
}

fn wheelrail(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

/// What a call says on stderr when it ends with this code.
fn complaint(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = wheelrail(folder, arguments);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    text
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
    std::fs::write(folder.join(name), text).unwrap();
}

#[test]
fn a_long_run_tells_what_it_is_at_and_a_short_one_says_nothing() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let rest = format!("[contact]\noffset = 0.0\n[patch]\napproach = 0.05\n{SMALL}");
    write(here, "short.toml", &format!("{BODIES}{rest}"));
    assert_eq!(complaint(here, &["run", "short.toml"], 0), "");
    // A wheel that is long in coming.
    let slow = BODIES.replace("profile = \"S1002\"", "file = \"wheel.toml\"");
    write(here, "long.toml", &format!("{slow}{rest}"));
    let wheel = here.join("wheel.toml");
    assert!(Command::new("mkfifo").arg(&wheel).status().unwrap().success());
    let mut run = command(here, &["run", "long.toml"]);
    let mut run = run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(run.stderr.take().unwrap()).lines();
    assert_eq!(lines.next().unwrap().unwrap(), "run: profiles (2 s)");
    std::fs::write(&wheel, "segments = [{ line = { from = [-60, 3], to = [60, -3] } }]\n").unwrap();
    let output = run.wait_with_output().unwrap();
    assert!(output.status.success());
    assert_eq!(output.stdout, b"output/long\n", "stdout is data");
}
