//! N rays over one piece of the wheel's profile: of one point of the rail at N places along η, or of N points of the rail. A
//! single ray is N = 1.

use super::meeting::{Meetings, along};
use super::ray::Ray;
use crate::numerics::lanes::{Lanes, every, lanes};
use crate::profile::{Branch, BranchPoints};
use crate::separation::{contact_gap, contact_gaps, sagitta};

/// Most steps to the sagitta of a point. Each gains some three digits.
pub const STEPS: usize = 40;

/// Roundings of the sagitta below which its steps have settled.
pub const SETTLED: f64 = 2.0;

/// The points at which rays begin to follow a piece.
#[derive(Debug, Clone, Copy)]
pub struct RayStart<const N: usize> {
    /// t \[mm\].
    pub t: Lanes<N>,
    /// Sagitta e \[mm\].
    pub e: Lanes<N>,
    /// The wheel's points.
    pub points: BranchPoints<N>,
    /// Whether they are in the midplane over both contact segments, from where t keeps all digits.
    pub over_contact: bool,
}

impl<const N: usize> RayStart<N> {
    /// Returns the start of the k-th ray.
    #[inline(always)]
    pub fn lane(&self, k: usize) -> RayStart<1> {
        let Self { t, e, points, over_contact } = self;
        RayStart { t: [t[k]], e: [e[k]], points: points.lane(k), over_contact: *over_contact }
    }
}

/// Points of the wheel on rays.
#[derive(Debug, Clone, Copy)]
pub struct Met<const N: usize> {
    /// t \[mm\].
    pub t: Lanes<N>,
    /// Sagitta e \[mm\].
    pub e: Lanes<N>,
    /// Axle distance w \[mm\].
    pub w: Lanes<N>,
}

/// Finds the points at which rays meet a piece in the wheel's own midplane, e = 0. Under skew all rays must come from one point of the
/// rail. Returns `None` if a ray misses the piece, and if N > 1 and only some have the accuracy of the contact segments.
#[inline(always)]
pub fn in_midplane<const N: usize>(rays: &[Ray<'_>; N], index: usize) -> Option<RayStart<N>> {
    let (bodies, n) = (rays[0].bodies, directions(rays));
    let piece = &rays[0].pieces()[index];
    let branch = rays[0].branch(piece);
    let of_contact = bodies.wheel.section.contact == Some(piece.branch);
    let rail = bodies.rail().contact.filter(|_| of_contact).map(|r| &bodies.rail().branches[r]);
    let inside = |x: f64| branch.xi.contains(x);
    let from_contact = |k: usize| rays[k].contact.is_some_and(|[xi, _]| inside(xi));
    let over = rail.filter(|_| every::<N>(|k| from_contact(k) && inside(rays[k].p[0])));
    if N > 1 && over.is_none() && rail.is_some() && !every::<N>(|k| !from_contact(k)) {
        return None;
    }
    let above: Lanes<N> = lanes(|k| match over {
        Some(_) => rays[k].p[0],
        None => rays[k].p[0].max(piece.xi.low).min(piece.xi.high),
    });
    let (from, height) = branch.points(&above)?;
    let apart: Lanes<N> = match over {
        Some(rail) if bodies.is_skewed() => {
            let xi = rays[0].contact.map_or(f64::NAN, |[xi, _]| xi);
            let (point, at) = branch.point(xi);
            let gap = contact_gap(rail, branch, xi, at);
            let slope = branch.chords_from(&point.repeated(), &above)?;
            lanes(|k| gap + rays[k].contact.map_or(f64::NAN, |[_, shift]| shift) * slope[k])
        }
        // The wheel's points are over the rail's own.
        Some(rail) => contact_gaps(rail, branch, &above, &height)?,
        None => lanes(|k| height[k] - rays[k].p[1]),
    };
    let v0: [Lanes<N>; 2] = [lanes(|k| rays[k].p[0] - above[k]), lanes(|k| -apart[k])];
    let Meetings { r: t, parameters } = along(branch, &from, [&v0[0], &v0[1]], [&n[0], &n[1]])?;
    if !every::<N>(|k| t[k].is_finite()) {
        return None;
    }
    let points = match parameters {
        Some(parameters) => branch.points_of(&parameters)?,
        None => branch.points(&lanes(|k| rays[k].p[0] + t[k] * n[0][k]))?.0,
    };
    Some(RayStart { t, e: [0.0; N], points, over_contact: over.is_some() })
}

/// Returns the directions n′ of rays.
#[inline(always)]
fn directions<const N: usize>(rays: &[Ray<'_>; N]) -> [Lanes<N>; 2] {
    [lanes(|k| rays[k].n[0]), lanes(|k| rays[k].n[1])]
}

/// Finds the points at which the columns of rays enter a piece by its near end. Returns `None` if one of them does not.
#[inline(always)]
pub fn at_joint<const N: usize>(rays: &[Ray<'_>; N], index: usize) -> Option<RayStart<N>> {
    let [near, _] = rays[0].sides();
    let piece = &rays[0].pieces()[index];
    let (begin, zeta) = rays[0].section().end(piece, near);
    let e: Lanes<N> = lanes(|k| rays[k].passes(index, near));
    if !every::<N>(|k| e[k].is_finite()) {
        return None;
    }
    let t = lanes(|k| rays[k].t_through([piece.xi[near], zeta], e[k]));
    Some(RayStart { t, e, points: begin.repeated(), over_contact: false })
}

/// Finds the points of the wheel at the rays' own η′ over a branch. Returns `None` if a ray misses the branch, or if its steps do not
/// settle.
///
/// Method: computes the sagitta from t and t from the sagitta in turn, until the sagitta settles.
#[inline(always)]
pub fn meet<const N: usize>(rays: &[Ray<'_>; N], branch: &Branch, begin: &RayStart<N>) -> Option<Met<N>> {
    let (wheel, n) = (&rays[0].bodies.wheel, directions(rays));
    let (mut t, mut e) = (begin.t, begin.e);
    let mut w: Lanes<N> = lanes(|k| rays[k].axle_distance(t[k]));
    for _ in 0..STEPS {
        let next: Lanes<N> = lanes(|k| {
            let eta = rays[k].eta_at(t[k]);
            sagitta(w[k], eta * eta)
        });
        let steps: Lanes<N> = lanes(|k| (next[k] - e[k]).abs());
        e = next;
        let v0: [Lanes<N>; 2] =
            [lanes(|k| -(e[k] - begin.e[k]) * wheel.sin), lanes(|k| -(e[k] - begin.e[k]) * wheel.cos)];
        let Meetings { r: rise, .. } = along(branch, &begin.points, [&v0[0], &v0[1]], [&n[0], &n[1]])?;
        t = lanes(|k| begin.t[k] + rise[k]);
        w = lanes(|k| rays[k].axle_distance(t[k]));
        if !every::<N>(|k| t[k].is_finite()) {
            return None;
        }
        if every::<N>(|k| steps[k] <= SETTLED * f64::EPSILON * e[k]) {
            return every::<N>(|k| w[k] > 0.0).then_some(Met { t, e, w });
        }
    }
    None
}
