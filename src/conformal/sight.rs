//! The point where a ray meets the wheel, on any profile: also if the profile turns back across the ray, which then enters it more
//! than once.

use super::meeting::along;
use super::ray::Ray;
use super::rays::{SETTLED, STEPS};
use super::span::{RayPoint, RaySpan};
use crate::numerics::roots::bracketed;
use crate::profile::parallel_to;
use crate::separation::sagitta;

/// Largest correction \[mm\] along a ray for a rounding of ξ. Where a ray touches the profile, a larger one may belong to another entry.
const LARGEST_REST: f64 = 1e-6;

/// A ray in the profile's plane. Each of its points is lowered by its own sagitta.
struct Sight<'r, 'a> {
    ray: &'r Ray<'a>,
    /// Sagitta of the rail's point \[mm\].
    own: f64,
}

/// A point of the profile beside a ray.
#[derive(Debug, Clone, Copy)]
struct BesideRay {
    /// Abscissa of the point \[mm\].
    xi: f64,
    /// How far it lies beside the ray \[mm\], towards larger ξ.
    by: f64,
}

/// Finds the point where a ray meets the wheel at the ray's own η′. If the rail's point is outside the wheel, this is the nearest
/// intersection above; if it is inside, the nearest exit below. Returns `None` if the ray misses the wheel's outer surface.
///
/// Accuracy: a few roundings of the terms of t over both contact segments, elsewhere a few roundings of the profile's extent.
pub fn point(ray: &Ray<'_>) -> Option<RayPoint> {
    let simple = RaySpan::holding(ray).and_then(|span| span.point_at(ray.eta));
    simple.filter(|point| ray.begins_on_side(point.t)).or_else(|| searched(ray))
}

/// Finds the point of [`point`] on any profile, also if the ray crosses a piece more than once.
///
/// Method: follows the profile from the abscissa of the rail's point until it first crosses the ray. It misses a part that crosses the
/// ray twice if the two crossings are closer than the change of the sagitta between them.
pub fn searched(ray: &Ray<'_>) -> Option<RayPoint> {
    let sight = Sight { ray, own: ray.own_sagitta() };
    let (piece, abscissa) = sight.first_crossing()?;
    let branch = ray.branch(&ray.pieces()[piece]);
    let (from, zeta) = branch.point(abscissa);
    let (t, e) = sight.abreast([abscissa, zeta]);
    // A rounding of ξ moves the point of a steep surface off the ray.
    let (d, n) = ([ray.bodies.wheel.sin, ray.bodies.wheel.cos], ray.n.map(|n| [n]));
    let [x, z] = [(0, abscissa), (1, zeta)].map(|(k, at)| [ray.p[k] + t * ray.n[k] - e * d[k] - at]);
    let rest = along(branch, &from, [&x, &z], [&n[0], &n[1]]).map_or(f64::NAN, |met| met.r[0]);
    let t = if rest.abs() <= LARGEST_REST { t + rest } else { t };
    let (w, eta, branch) = (ray.axle_distance(t), ray.eta_at(t), ray.pieces()[piece].branch);
    (w > 0.0).then_some(RayPoint { t, w, eta, branch, abscissa, over_contact: false })
}

impl Sight<'_, '_> {
    /// Finds t \[mm\] of the ray's point that is nearest to a point of the profile, and its sagitta \[mm\].
    fn abreast(&self, at: [f64; 2]) -> (f64, f64) {
        let (ray, mut e) = (self.ray, self.own);
        let mut t = ray.t_through(at, e);
        for _ in 0..STEPS {
            let (next, settled) = self.next_sagitta(t, e);
            (t, e) = (ray.t_through(at, next), next);
            if settled {
                break;
            }
        }
        (t, e)
    }

    /// Computes how far a point of the profile lies beside the ray. The result has fewer digits for a point far from the ray, of which
    /// only the sign is used.
    fn beside(&self, at: [f64; 2]) -> BesideRay {
        let (ray, mut e) = (self.ray, self.own);
        let (own, mut by) = (ray.beside(at), f64::NAN);
        for _ in 0..STEPS {
            let (next, settled) = self.next_sagitta(ray.t_through(at, e), e);
            by = own + next * ray.drift;
            // The next step moves it by a thousandth of this one.
            if settled || ((next - e) * ray.drift).abs() <= by.abs() {
                break;
            }
            e = next;
        }
        BesideRay { xi: at[0], by }
    }

    /// Computes the sagitta \[mm\] of the ray's point at t \[mm\], and whether the step there from the last one is a rounding.
    fn next_sagitta(&self, t: f64, e: f64) -> (f64, bool) {
        let eta = self.ray.eta_at(t);
        let next = sagitta(self.ray.axle_distance(t), eta * eta);
        (next, (next - e).abs() <= SETTLED * f64::EPSILON * e)
    }

    /// Computes how far the end of a piece lies beside the ray; 0 is the end at smaller ξ.
    fn end_beside(&self, index: usize, end: usize) -> Option<BesideRay> {
        let piece = self.ray.pieces().get(index)?;
        Some(self.beside([piece.xi[end], piece.heights[end]]))
    }

    /// Finds the first crossing of the ray by the profile, followed from the abscissa of the rail's point: the piece and the abscissa
    /// \[mm\]. Returns `None` if the profile ends before, or crosses the ray by a step.
    fn first_crossing(&self) -> Option<(usize, f64)> {
        let (mut index, mut before, rises) = self.beginning()?;
        loop {
            for next in self.places(index, before.xi, rises) {
                if (before.by < 0.0) != (next.by < 0.0) {
                    return Some((index, self.crossing(index, before.xi, next.xi)));
                }
                before = next;
            }
            index = if rises { index + 1 } else { index.checked_sub(1)? };
            let begin = self.end_beside(index, usize::from(!rises))?;
            if (before.by < 0.0) != (begin.by < 0.0) {
                let joined = (begin.by - before.by).abs() <= self.ray.bodies.joint();
                return joined.then_some((index, begin.xi));
            }
            before = begin;
        }
    }

    /// Finds the piece and the place from which the profile is followed, and whether it is followed towards larger ξ. Returns `None` if
    /// the ray leads away from the profile, or passes its end in the material.
    fn beginning(&self) -> Option<(usize, BesideRay, bool)> {
        let (ray, from) = (self.ray, self.ray.p[0] - self.own * self.ray.bodies.wheel.sin);
        let leans_right = ray.n[0] > 0.0;
        let at = ray.pieces().partition_point(|piece| piece.xi.high < from);
        if let Some(piece) = ray.pieces().get(at).filter(|piece| piece.xi.low <= from) {
            // The profile is followed in the ray's direction if the rail's point is outside of the material, else against it.
            let begin = self.beside([from, ray.branch(piece).height(from)]);
            return Some((at, begin, begin.by < 0.0));
        }
        let index = if leans_right { at } else { at.checked_sub(1)? };
        let begin = self.end_beside(index, usize::from(!leans_right))?;
        ((begin.by < 0.0) == leans_right).then_some((index, begin, leans_right))
    }

    /// Lists the places of a piece from an abscissa \[mm\] to its far end between which it does not turn back across the ray.
    fn places(&self, index: usize, from: f64, rises: bool) -> Vec<BesideRay> {
        let (ray, piece) = (self.ray, &self.ray.pieces()[index]);
        let branch = ray.branch(piece);
        let mut all = Vec::new();
        if !ray.passes_once(index) {
            let turns = parallel_to(branch, ray.n, piece.xi.split(from)[usize::from(rises)]);
            all.extend(turns.into_iter().map(|xi| self.beside([xi, branch.height(xi)])));
            if !rises {
                all.reverse();
            }
        }
        all.extend(self.end_beside(index, usize::from(rises)));
        all
    }

    /// Finds the abscissa \[mm\] at which a piece crosses the ray between two others.
    fn crossing(&self, index: usize, a: f64, b: f64) -> f64 {
        let branch = self.ray.branch(&self.ray.pieces()[index]);
        bracketed(|xi| self.beside([xi, branch.height(xi)]).by, a, b).unwrap_or(b)
    }
}
