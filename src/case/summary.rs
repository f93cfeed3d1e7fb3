//! summary.json: what was computed, from what, how and how well.

use serde::Serialize;
use serde_json::{Value, json};

use super::conformal::Conformal;
use super::facts::FACTS;
use super::in_place;
use super::input::Case;
use super::pressure::PartPressure;
use super::run::{Part, Run};
use crate::error::Result;
use crate::files::FolderPart;
use crate::mesh::{Quality, Surface, TriangleMesh};
use crate::patch::{Component, Patch};
use crate::placement::{Body, Creepages};
use crate::profile::{Closing, Joint};

/// One body in the summary.
#[derive(Debug, Serialize)]
struct BodySummary<'a> {
    profile: &'a str,
    source: &'a str,
    contact_x_mm: f64,
    contact_z_mm: f64,
    contact_angle_rad: f64,
    contact_segment: String,
    /// Where closing the drawn chain moved its surface most; none for a chain without steps.
    largest_closing: Option<ClosingSummary>,
    /// Joints of the chain with a kink above 1e-9 rad.
    kinks: Vec<Joint>,
}

/// How a drawn chain was closed.
#[derive(Debug, Serialize)]
struct ClosingSummary {
    joints_closed: usize,
    moved_mm: f64,
    x_mm: f64,
    z_mm: f64,
    /// Stretch to either side of the joint that is not as drawn.
    reach_mm: f64,
}

/// Kinks up to this are not listed \[rad\].
const SMOOTH: f64 = 1e-9;

/// The meshes that were written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meshes<'a> {
    /// The surfaces of rail and wheel.
    pub(super) bodies: Option<&'a [Surface; 2]>,
    /// The triangles of the patch.
    pub(super) patch: Option<&'a TriangleMesh>,
}

/// Gives the summary of one part; without a `folder` paths are absolute.
///
/// # Errors
/// Those of its creepages.
pub(super) fn summary(
    run: &Run,
    part: &Part,
    folder: Option<&FolderPart<'_>>,
    meshes: Meshes<'_>,
    (files, skipped): (&[String], &[String]),
) -> Result<Value> {
    let (Part { site, analysis, .. }, Case { profiles, .. }) = (part, &run.case);
    let (contact, own) = (&site.contact, profiles.on(site.side()));
    let placement = &contact.placement;
    let place = in_place::to_track(run, part);
    let rows = [0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column| place[(row, column)]));
    let mut summary = head(&run.case, folder);
    let facts = FACTS.iter().filter_map(|fact| fact.number(part));
    // Numbers of bodies, patches and ellipses stand in their tables.
    let flat = facts.filter(|(keys, _)| keys.len() == 1).map(|(keys, value)| (keys.concat(), json!(value)));
    let rest = json!({
        "rail": body(placement.rail()),
        "wheel": body(placement.wheel()),
        "measured_rail": own.measured.rail,
        "measured_wheel": own.measured.wheel,
        "wheel_radius_mm": placement.wheel_radius(),
        "found": contact.found,
        "creepages": run.creepages(part)?.map(relative_motion),
        "feasibility": contact.feasibility,
        "curvatures": contact.curvatures,
        "approach_estimated_by": contact.is_loaded().then_some("half-space"),
        "effective_modulus_n_per_mm2": run.case.question.modulus(),
        "contact_to_track": rows,
        "wheelset_files": in_place::beside(run, part),
        "hertz_ellipse": hertz(part),
        "hertz_ellipse_under": contact.ellipse_under,
        "pressure": analysis.pressure.as_ref().map(pressure),
        "patch": analysis.patch.as_ref().map(patch),
        "mesh_quality": analysis.strips.as_ref().and_then(Quality::of_strips),
        "triangle_mesh": meshes.patch.map(triangle_mesh),
        "surface_quality": meshes.bodies.map(|[rail, wheel]| json!({
            "rail": Quality::of_surface(rail),
            "wheel": Quality::of_surface(wheel),
        })),
        "conformal": analysis.conformal.as_ref().map(Conformal::summary),
        "grid": {
            "n_xi": site.grid.xi.len(),
            "n_eta": site.grid.eta.len(),
            "undefined_points": analysis.separation.iter().filter(|s| s.is_nan()).count(),
            "method": analysis.plan.choice.method,
            "coefficients": analysis.plan.choice.coefficients,
            "estimated_error_mm": analysis.plan.error,
            "reason": analysis.plan.reason,
        },
        "refusals": part.refusals(),
        "warnings": part.warnings,
        "other_parts": run.parts.iter().map(|p| &p.site.folder).filter(|f| **f != site.folder).collect::<Vec<_>>(),
        "files": files,
        "files_skipped": skipped,
        "timings": analysis.timings,
    });
    if let (Value::Object(all), Value::Object(rest)) = (&mut summary, rest) {
        all.extend(flat.chain(rest));
    }
    Ok(summary)
}

/// Gives what the summary says of the program and of the scene.
fn head(Case { echo, file, .. }: &Case, folder: Option<&FolderPart<'_>>) -> Value {
    json!({
        "program": "wheelrail",
        "version": env!("CARGO_PKG_VERSION"),
        "title": echo.title,
        "scene": echo.scene,
        "scene_file": file.as_ref().map(|file| folder.map_or_else(|| file.clone(), |folder| folder.relative(file))),
        "scene_sha256": echo.hash,
        "conventions": "mm, rad; s > 0 apart; contact frame: origin C, xi along the common tangent, eta along the rail, zeta from rail to wheel; grids [i_xi][i_eta]",
    })
}

fn body(body: &Body) -> BodySummary<'_> {
    let segment = body.point.segment;
    let closing = |(largest, [x_mm, z_mm]): (Closing, [f64; 2])| ClosingSummary {
        joints_closed: body.profile().closings().len(),
        moved_mm: largest.moved,
        x_mm,
        z_mm,
        reach_mm: largest.reach,
    };
    BodySummary {
        profile: &body.profile().name,
        source: &body.profile().source,
        contact_x_mm: body.point.station.x,
        contact_z_mm: body.point.station.z,
        contact_angle_rad: body.contact_angle(),
        contact_segment: body.profile().segments()[segment].place(segment),
        largest_closing: body.profile().largest_closing().map(closing),
        kinks: body.profile().continuity().into_iter().filter(|joint| joint.kink.abs() > SMOOTH).collect(),
    }
}

fn relative_motion(creepages: Creepages) -> Value {
    json!({
        "longitudinal": creepages.longitudinal,
        "lateral": creepages.lateral,
        "spin_rad_per_mm": creepages.spin,
        "rolling_speed_mm_per_s": creepages.rolling_speed,
        "forward": creepages.forward,
        "pitch_rad_per_s": creepages.pitch,
    })
}

/// Gives Hertz's ellipse; its pressure is null where pressures were solved, since it is then not that of the contact.
fn hertz(part: &Part) -> Option<Value> {
    let mut ellipse = json!(part.site.contact.ellipse?);
    ellipse["pressure_n_per_mm2"] = json!(part.hertz_pressure());
    Some(ellipse)
}

/// Gives the pressures that were solved.
fn pressure(found: &PartPressure) -> Value {
    json!({
        "largest_n_per_mm2": found.largest.pressure_n_per_mm2,
        "largest_error_n_per_mm2": found.largest_error,
        "largest_at_mm": found.largest.at_mm,
        "contact_area_mm2": found.contact_area,
        "normal_load_n": found.load,
        "cell_mm": found.cell,
        "unbounded": found.unbounded.map(|found| json!({
            "rail_x_mm": found.rail_x,
            "at_mm": found.edge.at_mm,
            "kink": found.edge.kink,
            "rise_n_per_mm2": found.edge.rise_n_per_mm2,
        })),
        "over_grid": found.field.is_some(),
        "on_grid": found.on_grid.map(|on| json!({
            "largest_n_per_mm2": on.largest,
            "finer_n_per_mm2": on.finer,
            "difference": on.difference(),
        })),
    })
}

fn patch(patch: &Patch) -> Value {
    let extent = patch.extent();
    // The empty sum is −0, which + 0 makes 0.
    json!({
        "area_mm2": patch.area() + 0.0,
        "perimeter_mm": patch.components.iter().map(|c| c.perimeter).sum::<f64>() + 0.0,
        "xi_extent_mm": extent.map(|e| e.xi),
        "eta_extent_mm": extent.map(|e| e.eta),
        "cut_by_window": patch.cut_by_window(),
        "components": patch.components.iter().map(component).collect::<Vec<_>>(),
    })
}

fn triangle_mesh(mesh: &TriangleMesh) -> Value {
    json!({
        "quality": Quality::of_triangles(mesh),
        "smallest_angle_away_from_sharp_corners_rad": Some(mesh.smallest_angle()).filter(|angle| angle.is_finite()),
        "components": (0..mesh.size.len()).map(|k| json!({
            "size_mm": mesh.size[k],
            "chord_error_mm": mesh.chord_error[k],
            "area_mm2": mesh.area(k),
            "sharp_corners": mesh.sharp_corners(k).into_iter().map(|(node, angle)| json!({
                "xi_mm": mesh.points[node].x,
                "eta_mm": mesh.points[node].y,
                "angle_rad": angle,
            })).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
    })
}

fn component(component: &Component) -> Value {
    json!({
        "xi_extent_mm": component.xi,
        "eta_extent_mm": component.eta,
        "ends": component.ends,
        "cut_by_window": component.cut_by_window,
        "area_mm2": component.area,
        "perimeter_mm": component.perimeter,
        "least_separation_mm": component.deepest[0],
        "least_separation_at_mm": [component.deepest[1], component.deepest[2]],
    })
}
