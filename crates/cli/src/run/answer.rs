//! What a run says: a table of its contacts and the list of its files, or JSON.

use std::path::Path;

use serde_json::{Value, json};

use crate::answer::{Outcome, counted};
use wheelrail::case::{Part, Run, WrittenPart};
use wheelrail::conformal::ConformalPatch;
use wheelrail::load::Estimate;

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
        for (label, cell) in ROWS {
            let cells: Vec<String> = parts.iter().map(|part| cell(part).unwrap_or_default()).collect();
            if cells.iter().any(|cell| !cell.is_empty()) {
                let cells: String = cells.iter().map(|cell| format!(" {cell:>COLUMN$}")).collect();
                out += &format!("{label:<LABELS$}{cells}\n");
            }
        }
    }
    out.push('\n');
    for part in &run.parts {
        let merged = part.site.contact.found.as_ref().map_or(0, |found| found.merged.len());
        if merged > 0 {
            let places = counted(merged, "further place");
            out += &format!(
                "{}: {places} of contact lie in the same patch; this one folder holds all of it\n",
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

/// The content of a row for one contact; `None` where it has none.
type Cell = fn(&Part) -> Option<String>;

/// The rows of the table, each with its unit.
const ROWS: [(&str, Cell); 22] = [
    ("", |part| Some(part.site.name())),
    ("folder", |part| Some(part.site.folder.clone()).filter(|folder| !folder.is_empty())),
    ("C on the rail, x, mm", |part| {
        Some(format!("{:.3}", part.site.contact.placement.rail().point().station.x))
    }),
    ("C on the wheel, x, mm", |part| {
        Some(format!("{:.3}", part.site.contact.placement.wheel().point().station.x))
    }),
    ("contact angle, degrees", |part| {
        Some(format!("{:.3}", part.site.contact.placement.rail().contact_angle().to_degrees()))
    }),
    ("rolling radius, mm", |part| Some(format!("{:.3}", part.site.contact.placement.rolling_radius()))),
    ("approach, mm", |part| part.site.contact.approach.map(|(approach, _)| format!("{approach:.5}"))),
    ("approach is", |part| {
        let (_, estimate) = part.site.contact.approach?;
        Some(match estimate {
            None => "given".into(),
            Some(Estimate::Hertz) => "estimated by Hertz".into(),
            Some(Estimate::HalfSpace) => "est. by half-space".into(),
        })
    }),
    ("normal force, kN", |part| part.site.normal_load.map(|load| format!("{:.3}", load / 1e3))),
    ("its vertical part, kN", |part| part.site.vertical_load().map(|load| format!("{:.3}", load / 1e3))),
    ("Hertz's pressure, N/mm²", |part| part.site.hertz_pressure().map(|pressure| format!("{pressure:.0}"))),
    // The area of no part is −0, which + 0 makes 0.
    ("patch: area, mm²", |part| {
        part.analysis.patch.as_ref().map(|patch| format!("{:.2}", patch.area() + 0.0))
    }),
    ("patch: extent, ξ × η, mm", |part| {
        let extent = part.analysis.patch.as_ref()?.extent()?;
        Some(format!("{:.3} × {:.3}", extent.xi[1] - extent.xi[0], extent.eta[1] - extent.eta[0]))
    }),
    ("patch: parts", |part| {
        part.analysis
            .patch
            .as_ref()
            .map(|patch| patch.components.len().to_string())
            .filter(|count| count != "1")
    }),
    ("conformal patch: area, mm²", |part| Some(format!("{:.2}", conformal_patch(part)?.area() + 0.0))),
    ("its normal turns, degrees", |part| {
        let components = &conformal_patch(part)?.components;
        let turn =
            components.iter().map(|component| component.angle[1] - component.angle[0]).reduce(f64::max)?;
        Some(format!("{:.2}", turn.to_degrees()))
    }),
    ("feasible", |part| {
        let feasible = part.site.contact.feasibility.feasible;
        let first = part.site.contact.found.as_ref().is_none_or(|found| found.contact == 1);
        first.then(|| if feasible { "yes" } else { "no" }.into())
    }),
    ("grid, ξ × η", |part| part.site.grid.sigma.is_none().then(|| points(part))),
    ("grid, σ × η", |part| part.site.grid.sigma.is_some().then(|| points(part))),
    ("method", |part| Some(part.analysis.plan.choice.method.name().into())),
    ("error of s up to, mm", |part| Some(format!("{:.1e}", part.analysis.plan.error))),
    ("warnings", |part| {
        let count = part.warnings.len();
        (count > 0).then(|| count.to_string())
    }),
];

fn points(part: &Part) -> String {
    format!("{} × {}", part.site.grid.xi.len(), part.site.grid.eta.len())
}

/// Gives the patch over the rail's surface; `None` for a grid over the plane and without an approach.
fn conformal_patch(part: &Part) -> Option<&ConformalPatch> {
    part.analysis.conformal.as_ref()?.patch.as_ref()
}
