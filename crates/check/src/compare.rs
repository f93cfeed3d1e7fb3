//! Compares the program's answers with the measurements on the meshes.

use std::time::Instant;
use wheelrail::nalgebra::{Unit, Vector3};

use super::body::{AlongZeta, FLANGEWAY, JOINT, STEEPEST, Solid};
use super::closest::{of_bodies, to_point};
use super::floor::{Floor, floors};
use super::meshes::Vector;
use super::patch::ParameterPoint;
use super::points::spread_points;
use super::ray::{FIRST_CELL, Height, extrapolated};
use super::relation::{OppositePoint, RELATION, normals_between};
use super::report::{ClosestDistances, Counts, Differences, Orders, Report};
use super::request::{Answer, Request};
use super::sampler::{SampledCurve, SampledSurface};
use wheelrail::Interval;
use wheelrail::error::Result;
use wheelrail::internal::largest;
use wheelrail::placement::{Body, Placement};
use wheelrail::profile::Shape;

/// Largest difference that counts as agreement, as a multiple of the larger one of floor and own estimate. The maxima over
/// a few dozen points of the closed forms stand for those over all points.
pub(crate) const SAFETY: f64 = 4.0;

/// Error that the program itself may have, per millimetre of the largest coordinate: it promises 2e-12 mm on profiles of 150 mm, 60
/// roundings.
pub(crate) const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// Largest error estimate of the checker, as a share of the body's size, with which it can decide.
const RESOLVED: f64 = 1e-11;

/// Number of points at which closest distances are taken.
const DISTANCES: usize = 24;
/// Largest s at these points, as a share of R: the width of the relation's interval grows with its square.
const NEARBY: f64 = 2e-3;

/// Newton steps from the nearest sample of a segment to C.
const CONTACT_STEPS: usize = 12;

/// Lift of the wheel for closest distances, as a share of R, on top of the approach.
const LIFT: f64 = 1e-4;

/// Checks the answers of `answer` for s and normals at (ξ, η) of a placed pair.
///
/// Cost: about a millisecond a point, under 0.5 s in all.
///
/// # Errors
/// A placed pair whose profiles have points that are not finite, or a window that is not finite; bodies so large that their
/// meshes take more than 10⁵ cells.
pub fn check(
    placement: &Placement,
    request: &Request,
    answer: &mut dyn FnMut(f64, f64) -> Answer,
) -> Result<Report> {
    let start = Instant::now();
    let [xi, eta] = [request.window.xi, request.window.eta];
    let reach = [xi, eta].map(Interval::magnitude);
    let reach = reach[0].hypot(reach[1]);
    let solid = |surface: SampledSurface| Solid::up_to(placement, surface, reach);
    let (rail, wheel) = (solid(SampledSurface::rail(placement))?, solid(SampledSurface::wheel(placement))?);
    let floors = floors(smallest_radius(placement), placement.rolling_radius())?;
    let points = spread_points(placement, request, &rail.surface, &wheel.surface);
    let mut tally = CheckTally::new(&rail, &wheel, &floors);
    for &[xi, eta] in &points {
        tally.ray(xi, eta, answer(xi, eta));
    }
    let distances = tally.distances(request.approach, placement.wheel_radius(), answer);
    let contact_point = placement.is_at_contact().then(|| {
        let bodies = [placement.rail(), placement.wheel()].map(contact_point);
        [0, 1].map(|k| largest(bodies.iter().map(|body| body[k])))
    });
    let mut report = tally.report(distances, contact_point);
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

/// Returns the smallest radius of the arcs of both profiles \[mm\], at most an eighth of the rolling radius: the radius
/// of the closed forms.
pub(super) fn smallest_radius(placement: &Placement) -> f64 {
    let segments =
        [placement.rail(), placement.wheel()].into_iter().flat_map(|body| body.profile().segments());
    let radii = segments.filter_map(|segment| match &segment.shape {
        Shape::Arc(arc) => Some(arc.radius().abs()),
        Shape::Polynomial(_) => None,
    });
    radii.fold(placement.rolling_radius() / 8.0, f64::min)
}

/// Returns the distance \[mm\] of C from the profile, and the angle \[rad\] between the frame's ξ axis and the profile's
/// tangent. At an edge ξ is no tangent, and the angle is 0.
fn contact_point(body: &Body) -> [f64; 2] {
    let frame = body.point().station;
    let segment = &body.profile().segments()[body.point().segment];
    let curve = SampledCurve::of_segment(segment, [frame.x, frame.z], body.profile().extent());
    let mut t = curve.nearest_to_origin();
    for _ in 0..CONTACT_STEPS {
        let [x, z] = curve.point(t);
        t -= (x * frame.cos + z * frame.sin) / curve.speed(t);
    }
    let h = FIRST_CELL * curve.scale;
    let chord = |share: f64| {
        let ([x0, z0], [x1, z1]) = (curve.point(t - h * share), curve.point(t + h * share));
        Vector::new(x1 - x0, 0.0, z1 - z0).normalize()
    };
    let tangent = extrapolated(chord).0;
    let turned = tangent.z * frame.cos - tangent.x * frame.sin;
    let [x, z] = curve.point(t);
    let slack = JOINT * body.profile().extent() / curve.speed(t);
    let at_edge = !body.is_smooth() && (t <= slack || t >= curve.length - slack);
    [x.hypot(z), if at_edge { 0.0 } else { turned.abs() }]
}

/// Everything measured so far.
struct CheckTally<'a> {
    rail: &'a Solid,
    wheel: &'a Solid,
    floors: &'a [Floor],
    counts: Counts,
    separation: Vec<Compared>,
    normals: Vec<Compared>,
    orders: Vec<f64>,
    bracket: f64,
    outside: usize,
    estimate: f64,
    near: Vec<ComparedFeet>,
}

/// A difference, the allowed difference, and (ξ, η).
type Compared = (f64, f64, [f64; 2]);

/// A compared point whose feet are inside their segments.
#[derive(Clone, Copy)]
struct ComparedFeet {
    at: [f64; 2],
    /// The program's s \[mm\].
    separation: f64,
    /// Places on the rail and on the wheel.
    places: [ParameterPoint; 2],
    /// Points at these places \[mm\].
    points: [Vector; 2],
}

impl<'a> CheckTally<'a> {
    fn new(rail: &'a Solid, wheel: &'a Solid, floors: &'a [Floor]) -> Self {
        Self {
            rail,
            wheel,
            floors,
            counts: Counts::default(),
            separation: Vec::new(),
            normals: Vec::new(),
            orders: Vec::new(),
            bracket: 0.0,
            outside: 0,
            estimate: 0.0,
            near: Vec::new(),
        }
    }

    /// Returns the largest floor of one kind.
    fn floor(&self, kind: impl Fn(&Floor) -> f64) -> f64 {
        largest(self.floors.iter().map(kind))
    }

    /// Returns the rounding that the program may have if the least normal has this ζ component \[mm\].
    fn rounding(&self, least_normal: f64) -> f64 {
        let size = self.rail.surface.size.max(self.wheel.surface.size);
        ROUNDINGS * size / least_normal
    }

    /// Measures at (ξ, η) and compares.
    fn ray(&mut self, xi: f64, eta: f64, answer: Answer) {
        self.counts.points += 1;
        let missing = answer.separation.is_nan();
        match self.sheets(xi, eta, answer.separation) {
            (AlongZeta::Unresolved, _) | (_, AlongZeta::Unresolved) => self.counts.unresolved += 1,
            (AlongZeta::Steep, _) | (_, AlongZeta::Steep) => self.counts.steep_or_end += 1,
            (AlongZeta::Nothing, _) | (_, AlongZeta::Nothing) if missing => self.counts.no_surface += 1,
            (AlongZeta::Nothing, _) | (_, AlongZeta::Nothing) => self.counts.surface_disputed += 1,
            (AlongZeta::Heights(rail), AlongZeta::Heights(wheel)) => {
                let ends = |solid: &Solid, all: &[Height]| all.iter().all(|h| solid.at_end(&h.place));
                if ends(self.rail, &rail) || ends(self.wheel, &wheel) {
                    self.counts.steep_or_end += 1;
                } else if missing {
                    self.counts.surface_disputed += 1;
                } else {
                    self.compare([xi, eta], answer, &rail, &wheel);
                }
            }
        }
    }

    /// Returns what the line through (ξ, η) meets of rail and wheel: the outermost sheets, or where these are so much nearer to
    /// each other than `separation` \[mm\] that one of them may be of another head, the sheet behind that.
    fn sheets(&self, xi: f64, eta: f64, separation: f64) -> (AlongZeta, AlongZeta) {
        let (rail, wheel) = (self.rail.along_zeta(xi, eta), self.wheel.along_zeta(xi, eta));
        let (AlongZeta::Heights(r), AlongZeta::Heights(w)) = (&rail, &wheel) else { return (rail, wheel) };
        let near = |[r, w]: [f64; 2]| (separation - (w - r)).abs() < FLANGEWAY / 2.0;
        let outer = [r[0].zeta, w[0].zeta];
        if near(outer) || separation.is_nan() {
            return (rail, wheel);
        }
        // Each sheet lies a flangeway behind the one before, so that the searches end.
        let mut behind = self.rail.behind(xi, eta, outer[0]);
        while let AlongZeta::Heights(r) = &behind {
            if near([r[0].zeta, outer[1]]) {
                return (behind, wheel);
            }
            behind = self.rail.behind(xi, eta, r[0].zeta);
        }
        behind = self.wheel.behind(xi, eta, outer[1]);
        while let AlongZeta::Heights(w) = &behind {
            if near([outer[0], w[0].zeta]) {
                return (rail, behind);
            }
            behind = self.wheel.behind(xi, eta, w[0].zeta);
        }
        (rail, wheel)
    }

    fn compare(&mut self, at: [f64; 2], answer: Answer, rail: &[Height], wheel: &[Height]) {
        let both = || rail.iter().chain(wheel);
        let least_normal = both().map(|h| h.normal.z).fold(1.0, f64::min);
        let estimate = largest(both().map(|h| h.error));
        let size = self.rail.surface.size.max(self.wheel.surface.size);
        if estimate.is_nan() || estimate > RESOLVED * size {
            self.counts.unresolved += 1;
            return;
        }
        self.counts.compared += 1;
        self.estimate = self.estimate.max(estimate);
        self.orders.extend(both().filter_map(|h| h.order));
        let s = answer.separation;
        let rounding = self.rounding(least_normal);
        let measured =
            gap(wheel.iter().map(|h| Interval::of(h.zeta)), rail.iter().map(|h| Interval::of(h.zeta)));
        let floor = self.floor(|f| f.ray_mm) / least_normal;
        self.separation.push((beyond(s, measured), SAFETY * floor.max(estimate) + rounding, at));
        let bracket = gap(wheel.iter().map(|h| h.bracket), rail.iter().map(|h| h.bracket));
        let outside = beyond(s, bracket);
        if outside.is_nan() || outside > rounding {
            self.outside += 1;
        }
        if let ([rail], [wheel]) = (rail, wheel) {
            self.bracket = self.bracket.max(bracket.width());
            let points = [rail, wheel].map(|h| Vector::new(at[0], at[1], h.zeta));
            self.near.push(ComparedFeet { at, separation: s, places: [rail.place, wheel.place], points });
        }
        let vector = |normal: Option<_>| {
            normal.map_or(Vector::NAN, |n: Unit<Vector3<f64>>| Vector::from_array(n.into_inner().into()))
        };
        self.compare_normals(self.rail, at, vector(answer.normals.rail), rail);
        self.compare_normals(self.wheel, at, -vector(answer.normals.wheel), wheel);
    }

    fn compare_normals(&mut self, solid: &Solid, at: [f64; 2], normal: Vector, heights: &[Height]) {
        let floor = self.floor(|f| f.normal);
        let differences = heights.iter().map(|h| {
            // A direction is a difference of points. The shorter its curve, the more digits it has lost.
            let digits = 1.0 + solid.surface.size / solid.surface.curves[h.place.curve].scale;
            let rounding = ROUNDINGS * digits / h.normal.z;
            let allowed = SAFETY * floor.max(h.normal_error) + rounding;
            (normal.distance(h.normal), allowed, at)
        });
        let least = differences.min_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)));
        self.normals.extend(least);
    }

    /// Measures closest distances of points of each body from the other, and of the bodies.
    fn distances(
        &self,
        approach: f64,
        wheel_radius: f64,
        answer: &mut dyn FnMut(f64, f64) -> Answer,
    ) -> ClosestDistances {
        let none = ClosestDistances { bodies_mm: f64::NAN, ..ClosestDistances::default() };
        let close = |n: &&ComparedFeet| n.separation.abs() <= NEARBY * wheel_radius;
        let near: Vec<&ComparedFeet> = self.near.iter().filter(close).collect();
        let Some(least) = near.iter().min_by(|a, b| a.separation.total_cmp(&b.separation)) else {
            return none;
        };
        let lift = approach + LIFT * wheel_radius - least.separation.min(0.0);
        let surface = self.wheel.surface.lifted(lift);
        let Some(wheel) = Solid::new(surface, self.wheel.reach) else { return none };
        let mut relation = DistanceRelation { tally: self, all: Vec::new(), widest: 0.0 };
        let every = near.len().div_ceil(DISTANCES);
        for n in near.iter().step_by(every) {
            let separation = n.separation + lift;
            let point = n.points[1] + Vector::Z * lift;
            relation.hold(self.rail, &OppositePoint { at: n.at, separation, point, foot: n.places[0] });
            relation
                .hold(&wheel, &OppositePoint { at: n.at, separation, point: n.points[0], foot: n.places[1] });
        }
        let mut out = ClosestDistances { lift_mm: lift, ..none };
        if let Some([below, above]) = of_bodies(self.rail, &wheel, least.places) {
            let at = [above.point.x, above.point.y];
            out.bodies_mm = above.point.distance(below.point);
            out.bodies_at_mm = at;
            out.bodies_separation_mm = answer(at[0], at[1]).separation + lift;
            // At the end of a body the foot along ζ depends on rounding.
            let foot = match self.rail.along_zeta(at[0], at[1]) {
                AlongZeta::Heights(rail) if !wheel.at_end(&above.place) => Some(rail[0].place),
                _ => None,
            };
            if let Some(foot) = foot.filter(|foot| !self.rail.at_end(foot)) {
                let (separation, point) = (out.bodies_separation_mm, above.point);
                relation.hold(self.rail, &OppositePoint { at, separation, point, foot });
            }
        }
        out.widest_mm = relation.widest;
        out.violation = Differences::of(&relation.all);
        out
    }

    fn report(self, distances: ClosestDistances, contact_point: Option<[f64; 2]>) -> Report {
        let mut report = Report {
            agrees: false,
            objections: Vec::new(),
            counts: self.counts,
            floors: self.floors.to_vec(),
            separation: Differences::of(&self.separation),
            bracket_mm: self.bracket,
            outside_bracket: self.outside,
            largest_estimate_mm: self.estimate,
            orders: Orders::of(self.orders.clone()),
            normals: Differences::of(&self.normals),
            contact_point,
            relation: RELATION,
            distances,
            seconds: 0.0,
        };
        let size = self.rail.surface.size.max(self.wheel.surface.size);
        report.judge(RESOLVED * size, self.rounding(1.0));
        report
    }
}

/// The relation between distances along ζ and closest distances, point by point.
struct DistanceRelation<'a> {
    tally: &'a CheckTally<'a>,
    all: Vec<Compared>,
    widest: f64,
}

impl DistanceRelation<'_> {
    /// Checks s·min n ≤ d ≤ s·max n between a point and the body `solid`.
    fn hold(&mut self, solid: &Solid, above: &OppositePoint) {
        let Some(closest) = to_point(solid, above.point) else {
            return self.all.push((f64::INFINITY, 1.0, above.at));
        };
        let n = normals_between(solid, above, &closest, self.tally.rounding(1.0));
        let interval = n.map(|n| above.separation * n);
        self.widest = self.widest.max(interval.width());
        let floor = self.tally.floor(|f| f.closest_mm);
        let allowed = SAFETY * (floor + closest.error) + self.tally.rounding(n.low.max(STEEPEST));
        self.all.push((beyond(closest.distance, interval), allowed, above.at));
    }
}

/// Returns the range of wheel − rail.
fn gap(wheel: impl Iterator<Item = Interval>, rail: impl Iterator<Item = Interval>) -> Interval {
    wheel.fold(Interval::NONE, Interval::hull) + -rail.fold(Interval::NONE, Interval::hull)
}

/// Returns how far a value is outside an interval; NaN if any of them is.
fn beyond(value: f64, range: Interval) -> f64 {
    largest([range.low - value, value - range.high])
}
