//! What a run says: a table of its contacts and the list of its files, or JSON.

use std::path::Path;

use serde_json::{Value, json};

use crate::answer::{Outcome, counted};
use wheelrail::case::{FACTS, Part, Run, WrittenPart};

/// Contacts side by side in one table; more follow below.
const ABREAST: usize = 4;

/// Width of the first column.
const LABELS: usize = 26;

/// Width of a contact's column.
const COLUMN: usize = 22;

/// Most characters in a line of file names.
const LINE: usize = 110;

/// Returns the summaries of all parts with the sizes of their files, as JSON with a line break at its end.
pub(super) fn json(target: &Path, written: &[WrittenPart], outcome: Outcome) -> String {
    let part = |part: &WrittenPart| {
        let sizes: serde_json::Map<String, Value> =
            part.files.iter().map(|file| (file.name.clone(), file.size.into())).collect();
        json!({ "folder": part.folder, "file_sizes_bytes": sizes, "summary": part.summary })
    };
    let value = json!({
        "folder": target,
        "outcome": if outcome == Outcome::Done { "done" } else { "no" },
        "contacts": written.iter().map(part).collect::<Vec<_>>(),
    });
    format!("{value:#}\n")
}

/// Returns the table of all contacts, remarks on them, and the names of the files that were written.
pub(super) fn table(run: &Run, written: &[WrittenPart]) -> String {
    let mut out = format!("{}\n", run.case.echo().title);
    for parts in run.parts.chunks(ABREAST) {
        out.push('\n');
        out += &row("", parts.iter().map(|part| Some(part.site.name())));
        out += &row("folder", parts.iter().map(|part| Some(part.site.folder.clone())));
        for fact in &FACTS {
            let label = [fact.label, fact.unit].join(if fact.unit.is_empty() { "" } else { ", " });
            out += &row(&label, parts.iter().map(|part| fact.text(part)));
        }
        let warnings = |part: &Part| Some(part.warnings.len().to_string()).filter(|count| count != "0");
        out += &row("warnings", parts.iter().map(warnings));
    }
    out.push('\n');
    for part in &run.parts {
        let merged = part.site.contact.found.as_ref().map_or(0, |found| found.merged.len());
        if merged > 0 {
            let places = counted(merged, "further place");
            out += &format!(
                "{}: the same patch holds {places} of contact; this one folder has all of it\n",
                part.site.name()
            );
        }
    }
    for part in written {
        let sum = part.files.iter().map(|file| file.size as f64).sum();
        let place =
            if part.folder.is_empty() { "files".into() } else { format!("files in {}/", part.folder) };
        out += &format!("{place}: {}, {}\n", counted(part.files.len(), "file"), size(sum));
        let names = part.files.iter().map(|file| format!("{} {}", file.name, size(file.size as f64)));
        let mut line = String::new();
        for name in names {
            if line.len() + name.len() > LINE {
                out += &format!("  {line}\n");
                line.clear();
            }
            line += if line.is_empty() { "" } else { ", " };
            line += &name;
        }
        out += &format!("  {line}\n");
    }
    out
}

/// Gives a number of bytes to three digits.
pub(super) fn size(bytes: f64) -> String {
    let (value, unit) = match bytes {
        b if b >= 1e9 => (b / 1e9, "GB"),
        b if b >= 1e6 => (b / 1e6, "MB"),
        b if b >= 1e3 => (b / 1e3, "kB"),
        b => return format!("{b:.0} B"),
    };
    let digits = if value < 9.995 { 2 } else { usize::from(value < 99.95) };
    format!("{value:.digits$} {unit}")
}

/// Returns a row of the table; nothing where no contact has a cell.
fn row(label: &str, cells: impl Iterator<Item = Option<String>>) -> String {
    let cells: Vec<String> = cells.map(Option::unwrap_or_default).collect();
    if cells.iter().all(String::is_empty) {
        return String::new();
    }
    let cells: String = cells.iter().map(|cell| format!(" {cell:>COLUMN$}")).collect();
    format!("{label:<LABELS$}{cells}\n")
}
