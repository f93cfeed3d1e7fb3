//! The check of a pair one body of which varies, a rail along the track or a wheel around its axle: both surfaces as triangle meshes,
//! measured by rays along ζ.
//!
//! The meshes of the body that varies are made of points of its strips. The frame of a rail is set up here from the angles of the contact;
//! a wheel is wrapped around its axle here, and has the program's frame. A ray first meets a coarse mesh, and then meshes of nine cells
//! around that place, each smaller than the one before.

use std::fmt;
use std::time::Instant;

use serde::Serialize;
use wheelrail::Interval;
use wheelrail::error::{Error, Result};
use wheelrail::lofted::{FramedLoft, LoftStrip};
use wheelrail::placement::Placement;
use wheelrail::profile::Side;

use super::body::{AlongZeta, FLANGEWAY, STEEPEST, Solid};
use super::closest::CLOSER;
use super::compare::{ROUNDINGS, SAFETY};
use super::meshes::{Hit, Mesh, RayOrigin, Vector};
use super::patch::{cells, parameters};
use super::ray::extrapolated;
use super::report::Differences;
use super::request::{Answer, Request};
use super::sampler::SampledSurface;

/// Numbers of lines of points in ξ and η, with the edges of the window.
const GRID: [usize; 2] = [17, 13];

/// Longest cell of the coarse mesh along the track or around the wheel \[mm\]; across, its cells are those of the strip.
const ALONG: f64 = 1.0;

/// Margin of the coarse mesh around the window \[mm\].
const MARGIN: f64 = 2.0;

/// Most points of the coarse mesh of a strip.
const MOST_POINTS: usize = 2_000_000;

/// First and last cell of the meshes around a place, as a share of a coarse one. The last chords are off by less than 1e-12 mm.
const CELLS: [f64; 2] = [0.5, 1e-5];

/// Cell whose diagonals give the normal, as a share of a coarse one.
const NORMAL_CELL: f64 = 1.0 / 64.0;

/// Distance \[mm\] in front of a point from which the ray to its sheet starts: more than the error of a coarse mesh.
const NEAR: f64 = 0.5;

/// Results of rays on meshes for a contact with a body that varies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoftedReport {
    /// Whether all values agree.
    pub agrees: bool,
    /// Number of rays.
    pub points: usize,
    /// Points where neither program nor meshes have both surfaces.
    pub no_surface: usize,
    /// Points at the end of a part, or where a surface is too steep to measure.
    pub steep_or_end: usize,
    /// Points where only one of both finds both surfaces: a disagreement.
    pub surface_disputed: usize,
    /// Differences |s − s by rays| \[mm\].
    pub separation: Differences,
    /// Differences of the unit normals of the body that varies.
    pub normals: Differences,
    /// Distances of that body from the ends of the normal gap's lines, along ζ \[mm\]; `None` for a grid over the tangent plane.
    pub ends: Option<Differences>,
    /// Time of the check \[s\].
    pub seconds: f64,
}

impl fmt::Display for LoftedReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.agrees { "agrees" } else { "DISAGREES" };
        writeln!(
            f,
            "{verdict} with triangle meshes of rail and wheel measured by parry3d, {:.2} s",
            self.seconds
        )?;
        writeln!(
            f,
            "  points: {} of {} compared; {} without a surface, {} at an end or steep, {} where only one of both finds one",
            self.separation.compared, self.points, self.no_surface, self.steep_or_end, self.surface_disputed
        )?;
        let plane =
            [("|s - s by rays|", " mm", &self.separation), ("|n - n of the meshes|", "", &self.normals)];
        let ends = self.ends.iter().map(|ends| ("ends of t off the mesh", " mm", ends));
        for (name, unit, found) in plane.into_iter().chain(ends) {
            let [xi, eta] = found.worst_at_mm;
            writeln!(
                f,
                "  {name:<22} largest {:.1e}, half up to {:.1e}{unit}; nearest to its limit: {:.1e} of {:.1e} at ξ = {xi:.4}, η = {eta:.4} mm",
                found.max, found.median, found.worst, found.allowed
            )?;
        }
        Ok(())
    }
}

/// Checks the separation of a contact with a body that varies, the normals of that body, and the points (ξ, η, ζ) \[mm\] of that body
/// where lines along the rail's normals end.
///
/// Cost: about a second.
///
/// # Errors
/// A window that is not finite, or too wide.
pub(super) fn check_lofted(
    (placement, lofted): (&Placement, &FramedLoft),
    request: &Request,
    answer: &mut dyn FnMut(f64, f64) -> Answer,
    ends: Option<&[[f64; 3]]>,
) -> Result<LoftedReport> {
    let start = Instant::now();
    let Request { window, .. } = request;
    let reach = window.xi.magnitude().max(window.eta.magnitude());
    let own = MeshedLoft::new(lofted, placement, request)?;
    let other = match lofted.side() {
        Side::Rail => SampledSurface::wheel(placement),
        Side::Wheel => SampledSurface::rail(placement),
    };
    let other = Solid::up_to(placement, other, 2.0 * reach)?;
    let (mut separation, mut normals) = (Vec::new(), Vec::new());
    let [mut no_surface, mut steep_or_end, mut surface_disputed] = [0; 3];
    for k in 0..GRID[0] * GRID[1] {
        let at = [window.xi.step(k / GRID[1], GRID[0] - 1), window.eta.step(k % GRID[1], GRID[1] - 1)];
        let found = answer(at[0], at[1]);
        let met = (own.met(at, found, &other), other.along_zeta(at[0], at[1]));
        match met {
            (RayHit::Steep, _) | (_, AlongZeta::Steep | AlongZeta::Unresolved) => steep_or_end += 1,
            (RayHit::Nothing, _) | (_, AlongZeta::Nothing) if found.separation.is_nan() => no_surface += 1,
            (RayHit::Nothing, _) | (_, AlongZeta::Nothing) => surface_disputed += 1,
            _ if found.separation.is_nan() => surface_disputed += 1,
            (RayHit::At { zeta, upright, normal }, AlongZeta::Heights(heights)) => {
                let error = heights.iter().map(|h| h.error).fold(0.0, f64::max);
                let allowed = SAFETY * error + ROUNDINGS * own.size / upright.min(heights[0].normal.z);
                let apart = own.apart(zeta, heights[0].zeta);
                separation.push(((found.separation - apart).abs(), allowed, at));
                let outward = match lofted.side() {
                    Side::Rail => found.normals.rail,
                    Side::Wheel => found.normals.wheel.map(|down| -down),
                };
                let upward = outward.map_or(Vector::NAN, |n| Vector::from_array(n.into_inner().into()));
                let rounding = ROUNDINGS * own.size / NORMAL_CELL;
                if let Some((normal, normal_error)) = normal {
                    normals.push((upward.distance(normal), SAFETY * normal_error + rounding, at));
                }
            }
        }
    }
    let (separation, normals) = (Differences::of(&separation), Differences::of(&normals));
    let ends =
        ends.map(|ends| Differences::of(&ends.iter().filter_map(|at| own.off(*at)).collect::<Vec<_>>()));
    let both = separation.within() && normals.within() && ends.as_ref().is_none_or(Differences::within);
    let agrees = both && surface_disputed == 0;
    Ok(LoftedReport {
        agrees,
        points: GRID[0] * GRID[1],
        no_surface,
        steep_or_end,
        surface_disputed,
        separation,
        normals,
        ends,
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// What a ray finds of the body that varies.
enum RayHit {
    At {
        zeta: f64,
        /// ζ component of the last mesh's normal.
        upright: f64,
        /// The unit normal with its estimated error; `None` beside a slice or a cell's side, where curvature may jump.
        normal: Option<(Vector, f64)>,
    },
    Nothing,
    Steep,
}

/// The strips of the body that varies as coarse meshes around the window.
struct MeshedLoft<'a> {
    lofted: &'a FramedLoft,
    /// ξ, η, ζ in the body's own axes, upright.
    axes: [Vector; 3],
    /// C in these axes \[mm\].
    origin: Vector,
    /// R of a wheel \[mm\].
    radius: f64,
    meshes: Vec<MeshedStrip>,
    /// Largest coordinate \[mm\].
    size: f64,
}

struct MeshedStrip {
    strip: usize,
    mesh: Mesh,
    u: Vec<f64>,
    y: Vec<f64>,
}

impl<'a> MeshedLoft<'a> {
    fn new(lofted: &'a FramedLoft, placement: &Placement, request: &Request) -> Result<Self> {
        let [x, y, z] = lofted.origin();
        let (axes, origin, extent, radius) = match lofted.side() {
            Side::Rail => {
                let ((sin, cos), (rise, run)) =
                    (placement.rail().contact_angle().sin_cos(), placement.turn().sin_cos());
                let (xi, zeta) = (Vector::new(cos, 0.0, sin), Vector::new(-sin * run, rise, cos * run));
                let extent = placement.rail().profile().extent();
                ([xi, zeta.cross(xi), zeta], Vector::new(x, y, z), extent, f64::INFINITY)
            }
            Side::Wheel => {
                let axes = lofted.axes().map(|[x, y, z]| Vector::new(x, y, -z));
                let radius = placement.wheel_radius();
                (axes, Vector::new(x, 0.0, -z), placement.wheel().profile().extent() + radius, radius)
            }
        };
        let size = extent + x.abs() + y.abs() + z.abs();
        let mut made = Self { lofted, axes, origin, radius, meshes: Vec::new(), size };
        let (window, middle) = (request.window, lofted.along());
        for (strip, own) in lofted.loft().strips.iter().enumerate() {
            let [first, last] = own.reach().ends();
            let [from, to] = [window.eta.low - MARGIN, window.eta.high + MARGIN]
                .map(|eta| (middle + eta).clamp(first, last));
            if from >= to {
                continue;
            }
            let steps = ((to - from) / ALONG).ceil();
            let y: Vec<f64> = (0..=steps as usize).map(|k| from + (to - from) * k as f64 / steps).collect();
            let u: Vec<f64> = (0..=own.cells()).map(|k| k as f64).collect();
            if u.len() * y.len() > MOST_POINTS {
                let (found, expected) = (u.len() * y.len(), format!("at most {MOST_POINTS} points"));
                return Err(Error::new(
                    "check",
                    format!("{found} points"),
                    expected,
                    "take a smaller window",
                ));
            }
            let points = u.iter().flat_map(|&u| y.iter().map(move |&y| (u, y)));
            let points: Vec<Vector> = points.map(|(u, y)| made.point(own, u, y)).collect();
            let faces = cells(u.len(), y.len());
            let not_finite =
                || Error::new("check", "points that are not finite", "finite points", "check the list");
            let mesh = Mesh::new(points, faces).ok_or_else(not_finite)?;
            made.meshes.push(MeshedStrip { strip, mesh, u, y });
        }
        Ok(made)
    }

    fn point(&self, strip: &LoftStrip, u: f64, y: f64) -> Vector {
        let [x, z] = strip.point(u, y).at;
        let from = match self.lofted.side() {
            Side::Rail => Vector::new(x, y, z) - self.origin,
            Side::Wheel => {
                // Its slices are upside down: z counts outwards from R.
                let (angle, distance) = ((y - self.lofted.along()) / self.radius, self.radius + z);
                let rise = 2.0 * distance * (angle / 2.0).sin().powi(2) - z;
                Vector::new(x, distance * angle.sin(), rise) - self.origin
            }
        };
        Vector::new(from.dot(self.axes[0]), from.dot(self.axes[1]), from.dot(self.axes[2]))
    }

    /// The separation between a height of this body and one of the other \[mm\].
    fn apart(&self, own: f64, other: f64) -> f64 {
        if self.lofted.side() == Side::Rail { other - own } else { own - other }
    }

    /// Measures the sheet that a line from the other body meets first; or the sheet a flangeway behind it, where the separation differs
    /// from the program's by more than half a flangeway, as the first sheet may then be that of another head.
    fn met(&self, at: [f64; 2], found: Answer, other: &Solid) -> RayHit {
        let rail = self.lofted.side() == Side::Rail;
        let first = self.ray(at, if rail { RayOrigin::Above } else { RayOrigin::Below });
        let (RayHit::At { zeta, .. }, AlongZeta::Heights(heights)) = (&first, other.along_zeta(at[0], at[1]))
        else {
            return first;
        };
        if (found.separation - self.apart(*zeta, heights[0].zeta)).abs() <= FLANGEWAY / 2.0 {
            return first;
        }
        let behind =
            if rail { RayOrigin::DownFrom(zeta - FLANGEWAY) } else { RayOrigin::UpFrom(zeta + FLANGEWAY) };
        self.ray(at, behind)
    }

    /// Measures the distance \[mm\] along ζ of a point (ξ, η, ζ) from the sheet that it is said to lie on. Returns it with the distance that
    /// rounding allows and with (ξ, η); `None` where the sheet is too steep to measure.
    fn off(&self, [xi, eta, zeta]: [f64; 3]) -> Option<(f64, f64, [f64; 2])> {
        let rail = self.lofted.side() == Side::Rail;
        let origin = if rail { RayOrigin::DownFrom(zeta + NEAR) } else { RayOrigin::UpFrom(zeta - NEAR) };
        match self.ray([xi, eta], origin) {
            RayHit::Steep => None,
            RayHit::Nothing => Some((f64::INFINITY, 0.0, [xi, eta])),
            RayHit::At { zeta: met, upright, .. } => {
                Some(((met - zeta).abs(), ROUNDINGS * self.size / upright, [xi, eta]))
            }
        }
    }

    fn ray(&self, [xi, eta]: [f64; 2], origin: RayOrigin) -> RayHit {
        let outward = if self.lofted.side() == Side::Rail { 1.0 } else { -1.0 };
        let nudge = self.size * f64::EPSILON.sqrt();
        let met = self
            .meshes
            .iter()
            .filter_map(|own| Some((own, own.mesh.along_zeta_beside(xi, eta, origin, nudge)?)));
        let height = |hit: &Hit| outward * hit.point.z;
        let Some((own, hit)) = met.max_by(|a, b| height(&a.1).total_cmp(&height(&b.1))) else {
            return RayHit::Nothing;
        };
        if own.mesh.normal(hit.triangle).z < STEEPEST {
            return RayHit::Steep;
        }
        let strip = &self.lofted.loft().strips[own.strip];
        let mut place = parameters([&own.u, &own.y], &hit);
        let (mut share, mut zeta, mut upright) = (CELLS[0], hit.point.z, 1.0);
        while share >= CELLS[1] {
            let nodes = |at: f64, cell: f64| -> Vec<f64> {
                // Off every symmetry, so that the ray meets no side.
                (0..4).map(|k| at + (f64::from(k) - 1.43) * share * cell).collect()
            };
            let (u, y) = (nodes(place[0], 1.0), nodes(place[1], ALONG));
            let points = u.iter().flat_map(|&u| y.iter().map(move |&y| (u, y)));
            let points = points.map(|(u, y)| self.point(strip, u, y)).collect();
            let mesh = Mesh::new(points, cells(4, 4));
            let Some((mesh, hit)) =
                mesh.and_then(|mesh| mesh.along_zeta(xi, eta, RayOrigin::Above).map(|hit| (mesh, hit)))
            else {
                return RayHit::Steep;
            };
            upright = mesh.normal(hit.triangle).z;
            if upright < STEEPEST {
                return RayHit::Steep;
            }
            (place, zeta) = (parameters([&u, &y], &hit), hit.point.z);
            share *= CLOSER;
        }
        let inside = |at: f64, range: Interval, least: f64| at > range.low + least && at < range.high - least;
        let own = inside(place[0], Interval::new(0.0, strip.cells() as f64), NORMAL_CELL);
        if !(own && inside(place[1], strip.reach(), NORMAL_CELL * ALONG)) {
            return RayHit::Steep;
        }
        let own = inside(place[0].fract(), Interval::new(0.0, 1.0), NORMAL_CELL);
        let smooth = own && inside(place[1], strip.bay_at(place[1]).y(), NORMAL_CELL * ALONG);
        let direction = |share: f64| {
            let [h, k] = [NORMAL_CELL * share, NORMAL_CELL * ALONG * share];
            let corner = |a: f64, b: f64| self.point(strip, place[0] + a * h, place[1] + b * k);
            (corner(0.5, 0.5) - corner(-0.5, -0.5)).cross(corner(-0.5, 0.5) - corner(0.5, -0.5)).normalize()
        };
        RayHit::At { zeta, upright, normal: smooth.then(|| extrapolated(direction)) }
    }
}
