//! `wheelrail check`: every contact of a scene against triangle meshes measured by parry3d.

use std::fmt::Write;
use std::path::Path;

use super::{Outcome, folder_of, print};
use crate::check::{Answer, Differences, Report, Request, check as compare};
use crate::error::Result;
use crate::interpenetration::Window;
use crate::run::{Part, Run};
use crate::scene;
use crate::separation::Evaluator;

/// Checks a scene; exit code 1 where something disagrees.
pub(super) fn check(path: &Path) -> Result<Outcome> {
    let run = Run::new(scene::load(path)?, folder_of(path), "check").map_err(|e| e.within(path.display()))?;
    let mut agrees = true;
    for part in &run.parts {
        let report = check_part(part)?;
        agrees &= report.agrees;
        print(&text(&part.folder, &report))?;
    }
    Ok(if agrees { Outcome::Done } else { Outcome::No })
}

fn check_part(part: &Part) -> Result<Report> {
    let placement = &part.contact.placement;
    let ends = |values: &[f64]| [values[0], values[values.len() - 1]];
    let window = Window { xi: ends(&part.analysis.xi), eta: ends(&part.analysis.eta) };
    let approach = part.contact.approach.map_or(0.0, |(approach, _)| approach);
    let mut evaluator = Evaluator::new(placement);
    compare(placement, &Request { window, approach }, &mut |xi, eta| Answer::of(&mut evaluator, xi, eta))
}

fn text(folder: &str, report: &Report) -> String {
    let mut out = String::new();
    let name = if folder.is_empty() { "first contact" } else { folder };
    let verdict = if report.agrees { "agrees" } else { "DISAGREES" };
    let _ = writeln!(out, "{name}: {verdict} with parry3d's meshes, {:.2} s", report.seconds);
    let counts = &report.counts;
    let _ = writeln!(out, "  points compared {}, of {}", counts.compared, counts.points);
    let mut row = |what: &str, unit: &str, d: &Differences| {
        let _ = writeln!(
            out,
            "  {what:<24} max {:8.1e}  99 % {:8.1e}  median {:8.1e} {unit}; worst at xi = {:.4}, eta = {:.4} mm",
            d.max, d.p99, d.median, d.worst_at_mm[0], d.worst_at_mm[1]
        );
    };
    row("|separation - rays|", "mm", &report.separation);
    row("|normals - meshes|", "  ", &report.normals);
    row("closest against zeta", "mm", &report.distances.violation);
    let _ = writeln!(out, "  relation: {}", report.relation);
    let _ = writeln!(
        out,
        "  bracket of s at most {:.1e} mm wide, {} outside; observed order {:.2}",
        report.bracket_mm, report.outside_bracket, report.orders.median
    );
    for floor in &report.floors {
        let _ = writeln!(
            out,
            "  floor on a {:<10} rays {:8.1e} mm, closest points {:8.1e} mm",
            floor.form, floor.ray_mm, floor.closest_mm
        );
    }
    for objection in &report.objections {
        let _ = writeln!(out, "  objection: {objection}");
    }
    out
}
