//! Measures the checker's own error on closed forms, before it judges anything.
//!
//! A plane and a cylinder pass through the checker as rails, a cone and a torus as wheels. Their implicit equations,
//! evaluated in twice the working precision, give the error of every measured point.

use serde::Serialize;

use super::body::{AlongZeta, Solid};
use super::closest::to_point;
use super::meshes::Vector;
use super::sampler::SampledSurface;
use wheelrail::error::Result;
use wheelrail::internal::{Twice, largest};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Profile, Segment, Station};

/// Errors of the checker on one closed form.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Floor {
    /// Name of the form: "plane", "cylinder", "cone" or "torus".
    pub form: &'static str,
    /// Largest distance of a point measured by an extrapolated ray from the true surface \[mm\].
    pub ray_mm: f64,
    /// Largest error of an extrapolated unit normal.
    pub normal: f64,
    /// Largest error of a closest-point distance \[mm\].
    pub closest_mm: f64,
}

/// Slope of the lines.
const SLOPE: f64 = 0.375;
/// Distance of the contact from the middle of the arcs, as a share of the radius.
const OFFSET: f64 = 0.3125;
/// Half width of arcs and lines, as a share of the radius.
const WIDTH: f64 = 0.9;

/// Rays along each side: n × n rays on each form.
const RAYS: i32 = 4;
/// Distance of the outermost rays to either side, as a share of the radius.
const REACH: f64 = 0.4;

/// Measures the checker's errors on the four forms, at the scene's own size: radius r of the arcs, R of the wheel
/// \[mm\].
///
/// # Errors
/// None for positive finite radii with r well below R; otherwise the errors of [`Profile::new`] and
/// [`Pair::new`].
pub(super) fn floors(radius: f64, wheel_radius: f64) -> Result<Vec<Floor>> {
    let width = WIDTH * radius;
    let line = |slope: f64| Arc::line([-width, -slope * width], [width, slope * width]);
    let arc = |radius: f64| Arc::about([0.0, -radius], radius, Half::Upper, [-width, width]);
    let offset = OFFSET * radius;
    let pairs = [
        (["plane", "cone"], [line(SLOPE)?, line(-SLOPE)?], 0.0),
        (["cylinder", "torus"], [arc(radius)?, arc(1.25 * radius)?], offset),
    ];
    let reach = REACH * radius;
    let mut out = Vec::new();
    for (forms, arcs, x) in pairs {
        let profile = |k: usize| Profile::new(forms[k], "closed form", vec![Segment::arc(arcs[k])]);
        let placement = Pair::new(profile(0)?, profile(1)?, wheel_radius)?.placed(x, x, 0.0)?;
        let bodies = [SampledSurface::rail(&placement), SampledSurface::wheel(&placement)];
        for (k, surface) in bodies.into_iter().enumerate() {
            let exact = Implicit::new(&placement, surface.is_wheel(), arcs[k]);
            out.extend(
                Solid::new(surface, 2.0 * reach).map(|solid| measure(&solid, &exact, forms[k], reach)),
            );
        }
    }
    Ok(out)
}

fn measure(solid: &Solid, exact: &Implicit, form: &'static str, reach: f64) -> Floor {
    let mut floor = Floor { form, ray_mm: 0.0, normal: 0.0, closest_mm: 0.0 };
    let worse = |worst: &mut f64, error: f64| *worst = largest([*worst, error]);
    for i in 0..RAYS * RAYS {
        let at = |k: i32| reach * f64::from(2 * k - RAYS + 1) / f64::from(RAYS - 1);
        let (xi, eta) = (at(i / RAYS), at(i % RAYS));
        let AlongZeta::Heights(heights) = solid.along_zeta(xi, eta) else {
            floor.ray_mm = f64::INFINITY;
            continue;
        };
        let height = &heights[0];
        let point = Vector::new(xi, eta, height.zeta);
        let (distance, normal) = exact.distance_and_normal(point);
        worse(&mut floor.ray_mm, distance.abs());
        worse(&mut floor.normal, height.normal.distance(normal));
        // The point lies off the surface, on the side of the other body.
        let away = if solid.surface.is_wheel() { -normal } else { normal };
        let point = point + away * (reach / 64.0);
        let error = to_point(solid, point)
            .map_or(f64::INFINITY, |c| (c.distance - exact.distance_and_normal(point).0.abs()).abs());
        worse(&mut floor.closest_mm, error);
    }
    floor
}

/// The function F(ξ, η, ζ), the signed distance from the surface \[mm\], positive above.
struct Implicit {
    frame: Station,
    /// R of the wheel \[mm\]; `None` for the rail.
    axle: Option<f64>,
    arc: Arc,
}

impl Implicit {
    fn new(placement: &Placement, wheel: bool, arc: Arc) -> Self {
        let body = if wheel { placement.wheel() } else { placement.rail() };
        Self { frame: body.point().station, axle: wheel.then_some(placement.wheel_radius()), arc }
    }

    fn distance_and_normal(&self, point: Vector) -> (f64, Vector) {
        let Station { x, z, cos, sin } = self.frame;
        let two = Twice::product;
        let along = two(point.x, cos) - two(point.z, sin) + x;
        let up = two(point.x, sin) + two(point.z, cos) + z;
        let w = self.axle.map(|r| -up + r);
        // Height at which the point crosses the meridian plane when it is turned about the axle.
        let meridian = match (self.axle, w) {
            (Some(r), Some(w)) => -(w * w + two(point.y, point.y)).sqrt() + r,
            _ => up,
        };
        let (distance, [gx, gz]) = self.meridian(along, meridian);
        let (y, up) = match w.map(f64::from) {
            Some(w) => (-point.y / w.hypot(point.y) * gz, w / w.hypot(point.y) * gz),
            None => (0.0, gz),
        };
        (distance, Vector::new(gx * cos + up * sin, y, up * cos - gx * sin))
    }

    fn meridian(&self, x: Twice, z: Twice) -> (f64, [f64; 2]) {
        let start = self.arc.start();
        let Some([a, b]) = self.arc.centre() else {
            let distance = (z - start.z) * start.cos - (x - start.x) * start.sin;
            return (distance.into(), [-start.sin, start.cos]);
        };
        let (dx, dz) = (x - a, z - b);
        let distance = (dx * dx + dz * dz).sqrt();
        let unit = [f64::from(dx / distance), f64::from(dz / distance)];
        (f64::from(distance - self.arc.radius().abs()), unit)
    }
}
