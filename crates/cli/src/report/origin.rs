//! Finds where and by what a report was made. What the system does not tell is "unknown".

use std::path::Path;
use std::process::Command;
use std::thread::available_parallelism;

use wheelrail::files::read_text;
use wheelrail_report::page::PageOrigin;

/// Load from which other processes disturb the measurement: one of two cores is then taken half of the time.
const QUIET: f64 = 0.5;

/// Largest part of a system's file that is read \[bytes\]. A thousand processors take less.
const LARGEST_FILE: usize = 1 << 24;

/// Returns machine, compiler, commit and command.
pub(super) fn origin() -> PageOrigin {
    vec![
        ("command", command()),
        ("version", format!("wheelrail {}", env!("CARGO_PKG_VERSION"))),
        ("commit", commit()),
        ("compiler", compiler()),
        ("system", system()),
        ("processor", processor()),
        ("memory", field("/proc/meminfo", "MemTotal")),
        ("load at the start", load()),
    ]
}

/// Returns the command line without the path of the program.
fn command() -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    format!("wheelrail {}", arguments.join(" "))
}

fn compiler() -> String {
    let checks = if cfg!(debug_assertions) { ", with debug assertions: times mean nothing" } else { "" };
    format!("{}{checks}", env!("WHEELRAIL_RUSTC"))
}

/// Returns the commit of the folder in which the program was built, if that folder still exists.
///
/// It is looked up at run time. A build that follows the commit would compile everything anew after each commit.
fn commit() -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    if !Path::new(folder).join(".git").exists() {
        return "unknown: not built in a work tree".into();
    }
    let git = ["describe", "--always", "--dirty", "--abbrev=12"];
    let output = Command::new("git").arg("-C").arg(folder).args(git).output();
    match output {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout).trim().into(),
        _ => "unknown: git does not answer".into(),
    }
}

/// Returns the system's load: the number of running processes over the last minute, 5 and 15 minutes.
fn load() -> String {
    let text = first_words("/proc/loadavg", 3);
    let last_minute = text.split(' ').next().and_then(|word| word.parse::<f64>().ok());
    let busy = last_minute.is_some_and(|load| load > QUIET);
    if busy { format!("{text}: **busy**; measure again on a quiet machine") } else { text }
}

fn system() -> String {
    let release = first_words("/proc/sys/kernel/osrelease", 1);
    format!("{} {release}, {}", std::env::consts::OS, std::env::consts::ARCH)
}

fn processor() -> String {
    let threads = available_parallelism().map_or("unknown".into(), |n| n.to_string());
    format!("{}, {threads} threads", field("/proc/cpuinfo", "model name"))
}

/// Returns the value of the first line "name : value" of a file.
fn field(file: &str, name: &str) -> String {
    let text = read_text(Path::new(file), LARGEST_FILE).unwrap_or_default();
    let value = text.lines().find_map(|line| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == name).then(|| value.trim().to_string())
    });
    value.unwrap_or_else(|| "unknown".into())
}

fn first_words(file: &str, n: usize) -> String {
    let text = read_text(Path::new(file), LARGEST_FILE).unwrap_or_default();
    let words: Vec<&str> = text.split_whitespace().take(n).collect();
    if words.is_empty() { "unknown".into() } else { words.join(" ") }
}
