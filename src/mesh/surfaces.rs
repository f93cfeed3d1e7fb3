//! The surfaces of both bodies around the patch, for inspection and finite elements.
//!
//! Both surfaces are structured: index i runs along the profile, j along the rolling direction. They use the bodies' own
//! parameters (profile × extrusion, profile × rotation about the axle), and therefore show walls and overhangs that s(ξ, η)
//! cannot show.

use nalgebra::{Point2, Point3, Vector2, Vector3, distance_squared};

use crate::error::{Error, ErrorKind, Result, finite};
use crate::lofted::{FramedLoft, LoftStrip, joined};
use crate::numerics::interval::Interval;
use crate::patch::Window;
use crate::placement::Placement;
use crate::profile::{Side, Station};
use crate::separation::Evaluator;

use super::trace::{arc_step, trace};

/// Most points of a surface: a gigabyte of file. More can only be a mistake.
const MOST_POINTS: f64 = 3e7;

/// Largest distance of facets from the surfaces around a patch, as a share of the approach. The gap between two surfaces is
/// then visible.
const FACET_SHARE: f64 = 0.01;

/// Limits of that distance, as shares of the window's longer side. Below the first one a file has a million facets; above
/// the second one the facets are visible.
const FACET_LIMITS: Interval = Interval::new(1e-6, 1e-4);

/// Largest distance of the wheel's surface before and behind C, as a share of the rolling radius. Towards the whole radius
/// the surface becomes vertical.
const WIDEST: f64 = 0.5;

/// Step along the track over a rail that varies, and around a wheel that does \[mm\]; across they have their surface's own cells.
const CELL: f64 = 0.5;

/// Distance of a point from the surface that s sees, as a share of the profile's extent, below which it is on it: a thousand
/// times more than the rounding of both, and far less than any wall.
const SEEN: f64 = 1e-9;

/// The structured surface of one body.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::{Interval, Window, mesh::Surface};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let window = Window { xi: Interval::symmetric(5.0), eta: Interval::symmetric(8.0) };
/// let [rail, wheel] = Surface::around(&placement, &window, Some(0.05))?;
/// assert_eq!(rail.points.len(), rail.n[0] * rail.n[1]);
/// assert!(wheel.points.iter().any(|point| point.coords.norm() == 0.0)); // C is a point of the mesh
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The body.
    pub side: Side,
    /// Numbers of points \[along the profile, along the rolling direction\].
    pub n: [usize; 2],
    /// Points \[mm\] at index i · n\[1\] + j: (ξ, η, ζ) of the contact frame, unless the surface was moved to other axes.
    pub points: Vec<Point3<f64>>,
    /// Outward unit normals of the exact surface at the points, in the same axes; at a kink that of one side.
    pub normals: Vec<Vector3<f64>>,
}

impl Surface {
    /// Makes the surfaces of rail and wheel over the window of a grid. The approach \[mm\], if given, decides how fine they
    /// are. Along η they reach at most half a rolling radius to either side.
    ///
    /// # Errors
    /// A window that is not finite or wider than the wheel; a surface of too many points.
    pub fn around(placement: &Placement, window: &Window, approach: Option<f64>) -> Result<[Self; 2]> {
        let reach = WIDEST * placement.rolling_radius().min(placement.rail().axle_distance());
        let window = Window { eta: window.eta.map(|eta| eta.clamp(-reach, reach)), ..*window };
        let side = window.xi.width().max(window.eta.width());
        let limits = FACET_LIMITS.map(|share| share * side);
        let wanted = approach.filter(|approach| *approach > 0.0).map(|approach| FACET_SHARE * approach);
        let tolerance = wanted.map_or(limits.high, |wanted| limits.nearest(wanted));
        Ok([Self::rail(placement, &window, tolerance)?, Self::wheel(placement, &window, tolerance)?])
    }

    /// Makes the surface of a rail or roller over a window of the contact frame, as far as its profile goes. The window is
    /// widened along ξ to hold C, which is one of the points if η = 0 is in it. Along η a rail is straight and is divided like
    /// the wheel.
    ///
    /// `tolerance` \[mm\]: largest distance of the surface from the facets between its points.
    ///
    /// # Errors
    /// A window that is not finite or wider than the wheel; a tolerance that is not positive, or takes too many points.
    pub fn rail(placement: &Placement, window: &Window, tolerance: f64) -> Result<Self> {
        check(placement, window, tolerance)?;
        if let Some(under) = placement.under() {
            return Self::wheel(under, window, tolerance).map(Self::upside_down);
        }
        if let Some(lofted) = placement.lofted_rail() {
            return Self::lofted(lofted, window);
        }
        let stations = trace(placement.rail(), window.xi, tolerance)?;
        let radius = placement.rolling_radius();
        let along: Vec<f64> = angles(window.eta, radius, radius, tolerance / 2.0)?
            .into_iter()
            .map(|psi| radius * psi.sin())
            .collect();
        let frame = placement.rail().contact_frame();
        let nodes = |station: &Station| {
            let here = frame.inverse_transform_point(&Point2::new(station.x, station.z));
            let up = frame.inverse_transform_vector(&Vector2::new(-station.sin, station.cos));
            along.iter().map(|&eta| (in_space(here, eta), Vector3::new(up.x, 0.0, up.y))).collect::<Vec<_>>()
        };
        Self::of(Side::Rail, &stations, along.len(), nodes)
    }

    /// Makes the surface of a body that varies, on the cells of its own surface: of the parts that join each other across at C, as far
    /// ahead and behind as all of them reach.
    fn lofted(lofted: &FramedLoft, window: &Window) -> Result<Self> {
        let nowhere = || Error::new("surface", "no surface of the body at C", "one", "choose another place");
        let foot = lofted.foot(0.0, 0.0).ok_or_else(nowhere)?;
        let (side, strips, along) = (lofted.side(), &lofted.loft().strips, foot.place[1]);
        let parts = joined(lofted.loft(), foot.strip, along);
        let at = |part: usize, y: f64| {
            let same =
                |strip: &&LoftStrip| strip.part == strips[part].part && strip.cells() == strips[part].cells();
            strips.iter().filter(same).find(|strip| strip.holds(y))
        };
        let [xi, eta] = [window.xi, window.eta].map(|side| side.with(0.0));
        let reach = eta.map(|eta| lofted.along_at(0.0, eta));
        let steps = (reach.width() / CELL).ceil().max(1.0) as usize;
        let mut places: Vec<f64> = (0..=steps).map(|k| reach.step(k, steps)).chain([along]).collect();
        let ends = strips.iter().flat_map(|strip| strip.reach().ends()).filter(|end| reach.contains(*end));
        places.extend(ends);
        places.sort_by(f64::total_cmp);
        places.dedup();
        let whole = |y: &f64| parts.iter().all(|&part| at(part, *y).is_some());
        let middle = places.partition_point(|y| *y < along);
        let behind = places[..middle].iter().rev().take_while(|y| whole(y)).count();
        let ahead = places[middle..].iter().take_while(|y| whole(y)).count();
        let places = &places[middle - behind..middle + ahead];
        let inside = |&(part, u): &(usize, f64)| {
            xi.contains(lofted.seen_from(strips[part].point(u, along).at, along)[0])
        };
        let all = parts.iter().flat_map(|&part| (0..=strips[part].cells()).map(move |k| (part, k as f64)));
        let nodes: Vec<(usize, f64)> = all.filter(inside).collect();
        bounded(nodes.len() as f64 * places.len() as f64)?;
        let upward = if side == Side::Rail { 1.0 } else { -1.0 };
        let node = |&(part, u): &(usize, f64), y: f64| {
            let strip = at(part, y).unwrap_or(&strips[part]);
            let [point, across, along] = lofted.seen_at(strip, u, y).map(Vector3::from);
            (Point3::from(point), upward * across.cross(&along).normalize())
        };
        let all = nodes.iter().flat_map(|at| places.iter().map(move |&y| node(at, y)));
        let (points, normals) = all.unzip();
        Ok(Self { side, n: [nodes.len(), places.len()], points, normals })
    }

    /// Makes the wheel's surface, before any approach, over a window of the contact frame, as far as its profile goes. C is one
    /// of the points if η = 0 is in the window. The whole profile is turned by the angle at which its smallest circle spans the
    /// window. Half of `tolerance` \[mm\] goes to the profile, half to the rotation.
    ///
    /// # Errors
    /// A window that is not finite or wider than the wheel; a tolerance that is not positive, or takes too many points.
    pub fn wheel(placement: &Placement, window: &Window, tolerance: f64) -> Result<Self> {
        check(placement, window, tolerance)?;
        if let Some(lofted) = placement.lofted_wheel() {
            return Self::lofted(lofted, window);
        }
        let own = in_wheel_directions(placement, window);
        let stations = trace(placement.wheel(), own.xi, tolerance / 2.0)?;
        let radii = || stations.iter().map(|s| placement.wheel_radius() - s.z);
        let [smallest, largest] = [radii().fold(f64::INFINITY, f64::min), radii().fold(0.0, f64::max)];
        let psi = angles(own.eta, smallest, largest, tolerance / 2.0)?;
        let node = |station: &Station, psi: f64| {
            (wheel_point(placement, station, psi), wheel_normal(placement, station, psi))
        };
        let nodes = |station: &Station| psi.iter().map(|&psi| node(station, psi)).collect();
        Self::of(Side::Wheel, &stations, psi.len(), nodes)
    }

    fn of(
        side: Side,
        stations: &[Station],
        along: usize,
        nodes: impl Fn(&Station) -> Vec<(Point3<f64>, Vector3<f64>)>,
    ) -> Result<Self> {
        let n = [stations.len(), along];
        bounded(n[0] as f64 * n[1] as f64)?;
        let (points, normals) = stations.iter().flat_map(nodes).unzip();
        Ok(Self { side, n, points, normals })
    }

    /// Returns a wheel's surface mirrored under ζ → −ζ, which makes it the surface of a roller.
    fn upside_down(self) -> Self {
        let points = self.points.iter().map(|p| Point3::new(p.x, p.y, -p.z)).collect();
        let normals = self.normals.iter().map(|n| Vector3::new(n.x, n.y, -n.z)).collect();
        Self { side: Side::Rail, points, normals, ..self }
    }

    /// Returns this surface with its points in the rail profile's axes (x, y, z), y = η.
    #[must_use]
    pub fn in_rail_axes(&self, placement: &Placement) -> Self {
        let frame = placement.rail().contact_frame();
        let moved = |point: &Point3<f64>| in_space(frame * point.xz(), point.y);
        let turned = |normal: &Vector3<f64>| {
            let in_plane = frame * normal.xz();
            Vector3::new(in_plane.x, normal.y, in_plane.y)
        };
        Self {
            points: self.points.iter().map(moved).collect(),
            normals: self.normals.iter().map(turned).collect(),
            ..self.clone()
        }
    }

    /// Returns s \[mm\] at every point of a surface in the contact frame of this placed pair. It is NaN where the other body
    /// has no surface, and at points that s does not see because they are behind an overhang.
    pub fn separations(&self, placement: &Placement) -> Vec<f64> {
        let mut evaluator = Evaluator::new(placement);
        let body = if self.side == Side::Rail { placement.rail() } else { placement.wheel() };
        let near = SEEN * body.profile().extent();
        let separation = |point: &Point3<f64>| {
            let s = evaluator.separation(point.x, point.y);
            let lower = evaluator.lower_height(point.x, point.y);
            let seen = if self.side == Side::Rail { lower } else { lower + s };
            if (seen - point.z).abs() <= near { s } else { f64::NAN }
        };
        self.points.iter().map(separation).collect()
    }

    /// Returns the corners of the facets, counter-clockwise seen from outside the body.
    pub fn quads(&self) -> Vec<[usize; 4]> {
        let [n_i, n_j] = self.n;
        let quad = |i: usize, j: usize| {
            let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| i * n_j + j);
            // i × j points up: out of the rail and into the wheel.
            if self.side == Side::Rail { [a, b, c, d] } else { [a, d, c, b] }
        };
        (1..n_i).flat_map(|i| (1..n_j).map(move |j| quad(i - 1, j - 1))).collect()
    }

    /// Returns every facet as two triangles along its shorter diagonal, counter-clockwise seen from outside the body.
    pub fn triangles(&self) -> Vec<[usize; 3]> {
        let apart = |p: usize, q: usize| distance_squared(&self.points[p], &self.points[q]);
        let split = |[a, b, c, d]: [usize; 4]| {
            if apart(a, c) <= apart(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
        };
        self.quads().into_iter().flat_map(split).collect()
    }
}

fn check(placement: &Placement, window: &Window, tolerance: f64) -> Result<()> {
    for v in [window.xi, window.eta].into_iter().flat_map(Interval::ends) {
        finite("surface: window", v)?;
    }
    let wide = window.eta.magnitude() >= placement.rolling_radius();
    if wide || !window.xi.has_width() || !window.eta.has_width() {
        let found = format!("{window:?}");
        let expected = format!("ascending ends, |η| below {} mm", placement.rolling_radius());
        return Err(Error::new("surface: window", found, expected, "take the grid's window"));
    }
    if finite("surface: tolerance", tolerance)? <= 0.0 {
        let found = tolerance.to_string();
        return Err(Error::new("surface: tolerance", found, "a positive length in mm", "1e-3 is usual"));
    }
    Ok(())
}

/// Returns the window in the wheel's own ξ′ and η′. It is widened in ξ′ by e sinθ, the distance by which the profile moves
/// sideways as it turns.
fn in_wheel_directions(placement: &Placement, window: &Window) -> Window {
    let skew = placement.skew_rotation();
    let corners =
        window.xi.ends().into_iter().flat_map(|xi| window.eta.ends().map(|eta| Vector2::new(xi, eta)));
    let own: Vec<_> = corners.map(|corner| skew.inverse_transform_vector(&corner)).collect();
    let [xi, eta] = [0, 1].map(|k| Interval::around(own.iter().map(|p| p[k])));
    let (axle, widest) = (placement.rolling_radius(), eta.magnitude());
    let aside = widest * widest / (axle + axle.hypot(widest)) * placement.wheel().section.frame.sin;
    Window { xi: Interval::new(xi.low - aside.max(0.0), xi.high - aside.min(0.0)), eta }
}

/// Refuses more points than a surface may have.
fn bounded(count: f64) -> Result<()> {
    if count <= MOST_POINTS {
        return Ok(());
    }
    let (found, expected) = (format!("{count:e} points"), format!("at most {MOST_POINTS:e}"));
    Err(Error::new("surface", found, expected, "take a coarser tolerance").of_kind(ErrorKind::Limit))
}

/// Returns the angles about the axle, in equal steps, at which a point at this radius reaches from one end of η to the other. 0
/// is one of them if it is between. The chords of the steps keep the tolerance on the largest radius.
///
/// # Errors
/// More angles than a surface may have points.
fn angles(eta: Interval, radius: f64, largest: f64, tolerance: f64) -> Result<Vec<f64>> {
    let [from, to] = eta.ends().map(|eta| (eta / radius).clamp(-1.0, 1.0).asin());
    let step = arc_step(largest, tolerance);
    bounded((to - from) / step)?;
    let spread = |from: f64, to: f64| {
        let n = ((to - from) / step).ceil().max(1.0);
        (1..=n as usize).map(move |k| if k as f64 == n { to } else { from + (to - from) * k as f64 / n })
    };
    let mut angles = vec![from];
    if from < 0.0 && to > 0.0 {
        angles.extend(spread(from, 0.0));
        angles.extend(spread(0.0, to));
    } else {
        angles.extend(spread(from, to));
    }
    Ok(angles)
}

/// Returns the point of space \[mm\] over a point (ξ, ζ) or (x, z) of the midplane, at η.
fn in_space(in_plane: Point2<f64>, eta: f64) -> Point3<f64> {
    Point3::new(in_plane.x, eta, in_plane.y)
}

/// Returns (ξ, η, ζ) \[mm\] of a profile point turned about the axle by ψ \[rad\].
pub(super) fn wheel_point(placement: &Placement, station: &Station, psi: f64) -> Point3<f64> {
    let w = placement.wheel_radius() - station.z;
    // This computes R − w cosψ without cancellation.
    let turned = Point2::new(station.x, station.z + 2.0 * w * (psi / 2.0).sin().powi(2));
    let own = placement.wheel().contact_frame().inverse_transform_point(&turned);
    let tangential = placement.skew_rotation() * Vector2::new(own.x, w * psi.sin());
    Point3::new(tangential.x, tangential.y, own.y)
}

/// Returns the outward normal in (ξ, η, ζ) of the wheel at a profile point turned about the axle by ψ \[rad\].
fn wheel_normal(placement: &Placement, station: &Station, psi: f64) -> Vector3<f64> {
    let turned = Vector2::new(station.sin, -station.cos * psi.cos());
    let own = placement.wheel().contact_frame().inverse_transform_vector(&turned);
    let tangential = placement.skew_rotation() * Vector2::new(own.x, station.cos * psi.sin());
    Vector3::new(tangential.x, tangential.y, own.y)
}
