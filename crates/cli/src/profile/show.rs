//! `wheelrail profile show`: describes a profile.

use std::fmt::Write;

use super::source::SourcedProfile;
use crate::answer::counted;
use wheelrail::measured::{CurveKind, CurveRecord, Measured, Record, Wording, spoken};
use wheelrail::profile::{Profile, Shape};

/// Returns the description of a profile: name and source; how a measured file was read and fitted; segments and joints. The
/// spans of a spline are left out, because there are as many as points.
pub(super) fn show(source: &SourcedProfile) -> String {
    let profile = source.profile();
    // Writing to a string cannot fail, neither here nor below.
    let mut out = format!("# {}\n# {}\n", profile.name, profile.source);
    if let Some(measured) = source.measured() {
        record(&mut out, measured);
    }
    let spline = |measured: &Measured| {
        matches!(measured.record.curve.kind, CurveKind::Smoothing | CurveKind::Interpolation)
    };
    if !source.measured().is_some_and(spline) {
        segments(&mut out, profile);
        joints(&mut out, profile);
        closings(&mut out, profile);
    }
    out
}

fn record(out: &mut String, Measured { record, points, .. }: &Measured) {
    let Record { transform, curve, .. } = record;
    let _ = writeln!(out, "format     {}", record.format.name());
    let _ = writeln!(out, "points     {} read, {} used", record.points_read, record.points_used);
    for note in &record.notes {
        let _ = writeln!(out, "note       line {}: {}", note.line, note.text);
    }
    for step in &transform.steps {
        let _ = writeln!(out, "transform  {}: {}, because of {}", step.what, step.done, step.because);
    }
    let [[a, b], [x, z]] = [transform.scale, transform.shift];
    let _ = writeln!(out, "transform  x = {a} first + {x} mm, z = {b} second + {z} mm");
    for repair in &record.repairs {
        let (points, places) = (counted(repair.points, "point"), repair.places.join(", "));
        let _ = writeln!(out, "repair     {}: {points}, {places}", name(&repair.repair));
    }
    for finding in &record.warnings {
        let found = spoken(&finding.found, Wording::CommandLine);
        let _ = writeln!(out, "finding    {}, {}: {found}", name(&finding.check), finding.place);
    }
    let x = || points.iter().map(|point| point.x);
    let (from, to) = (x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max));
    let _ = writeln!(out, "extent     x from {from} to {to} mm");
    fitted(out, curve);
}

fn fitted(out: &mut String, curve: &CurveRecord) {
    let _ = write!(out, "curve      {}, {} segments", name(&curve.kind), curve.segments);
    if let Some(cutoff) = curve.cutoff_wavelength {
        let _ = write!(out, ", cut-off wavelength {cutoff} mm");
        if let Some(because) = curve.cutoff_because {
            let _ = write!(out, ", because of {because}");
        }
    }
    if let Some(tolerance) = curve.tolerance {
        let _ = write!(out, ", tolerance {tolerance} mm");
    }
    out.push('\n');
    for corner in &curve.corners {
        let ([x, z], turn) = (corner.point, corner.angle);
        let _ = writeln!(out, "corner     {} at ({x}, {z}) mm, turns by {turn:.4} rad", corner.place);
    }
    if let Some(residual) = &curve.residual {
        let (largest, rms) = (1e3 * residual.largest, 1e3 * residual.rms);
        let worst = &residual.worst;
        let _ = writeln!(out, "residual   largest {largest:.3} um at {worst}, rms {rms:.3} um");
    }
    if let Some(noise) = curve.noise {
        let _ = write!(out, "noise      {:.3} um across", 1e3 * noise);
        if let Some(error) = curve.curvature_error {
            let _ = write!(out, "; the curvature is known to {error:.2e} 1/mm");
        }
        out.push('\n');
    }
}

/// Returns a name as scenes and summaries spell it.
fn name(of: &impl serde::Serialize) -> String {
    serde_json::to_value(of).ok().and_then(|v| v.as_str().map(String::from)).unwrap_or_default()
}

fn segments(out: &mut String, profile: &Profile) {
    let _ = writeln!(
        out,
        "# {:<10} {:<10} {:>22} {:>22} {:>22} {:>22} {:>14}",
        "segment", "kind", "x_start", "z_start", "x_end", "z_end", "radius_mm"
    );
    for (index, segment) in profile.segments().iter().enumerate() {
        let label = if segment.label.is_empty() { (index + 1).to_string() } else { segment.label.clone() };
        let (kind, radius) = match &segment.shape {
            Shape::Arc(arc) if arc.radius().is_finite() => ("arc", format!("{:.9}", arc.radius())),
            Shape::Arc(_) => ("line", "-".into()),
            Shape::Polynomial(_) => ("polynomial", "-".into()),
        };
        let (start, end) = (segment.start(), segment.end());
        let _ = writeln!(
            out,
            "{:<12} {kind:<10} {:22.15} {:22.15} {:22.15} {:22.15} {radius:>14}",
            label.replace(' ', "_"),
            start.x,
            start.z,
            end.x,
            end.z
        );
    }
}

fn joints(out: &mut String, profile: &Profile) {
    *out += "\n# joint           x_mm         gap_mm        kink_rad  curvature_jump_per_mm\n";
    for joint in profile.continuity() {
        let _ = writeln!(
            out,
            "{:<7} {:14.6} {:14.3e} {:15.6e} {:22.6e}",
            joint.left + 1,
            joint.x,
            joint.gap,
            joint.kink,
            joint.curvature_jump
        );
    }
}

/// Appends what was changed of a drawing so that its segments meet.
fn closings(out: &mut String, profile: &Profile) {
    let Some((largest, [x, z])) = profile.largest_closing() else { return };
    let _ = writeln!(
        out,
        "\n# closed: the drawn surface moved by at most {:.3e} mm, at ({x:.6}, {z:.6}) mm\n\
         # joint           x_mm         step_mm       moved_mm       reach_mm",
        largest.moved
    );
    for closing in profile.closings() {
        let x = profile.segments()[closing.left].end().x;
        let _ = writeln!(
            out,
            "{:<7} {x:14.6} {:14.3e} {:14.3e} {:14.3e}",
            closing.left + 1,
            closing.step,
            closing.moved,
            closing.reach
        );
    }
}
