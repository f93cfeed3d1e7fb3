//! Compares the closest distance with the separation.
//!
//! When a point rises along ζ from its foot F, its distance from the body grows by the ζ component n of the unit normal at
//! its closest point: d = ∫ n dζ. The closest point moves, too. Let h be the height by which it has risen above F when the
//! point has risen by s. It stays inside the sphere of radius s around the final position of the point, and therefore
//! within √(2sh) of F. The extremes of n within that distance bracket d. They are enclosed piece by piece, with the largest
//! turn of the profile inside a piece, so that an inflection between two samples is not missed.

use super::body::Solid;
use super::closest::Closest;
use super::meshes::Vector;
use super::patch::ParameterPoint;
use super::sampler::{SampledCurve, SampledSurface};
use wheelrail::Interval;

/// The relation in words.
pub const RELATION: &str = "s·min n ≤ d ≤ s·max n, where n are the ζ components of the body's unit normals up to \
                            √(2sh) from the foot along ζ, h the height of the closest point over the foot";

/// Largest piece of a profile, as a share of the reach: the bracket widens by half a piece's turn.
const PIECE: f64 = 1.0 / 16.0;

/// Most halvings: a range of the parameter has no more bits.
const HALVINGS: u32 = 52;

/// A point of one body above or below the other body.
pub(super) struct OppositePoint {
    /// Coordinates (ξ, η) \[mm\].
    pub at: [f64; 2],
    /// s at the point, lift included \[mm\].
    pub separation: f64,
    /// Coordinates of the point \[mm\].
    pub point: Vector,
    /// The foot along ζ on the other body.
    pub foot: ParameterPoint,
}

/// Returns the range of n between the foot of `above` and the closest point of `solid`.
///
/// If the closest point is a joint or an end, the direction to it counts as well, because any direction between the normals
/// of the neighbours can be the closest one's. An end that the closest point only passes on its way is not seen.
pub(super) fn normals_between(
    solid: &Solid,
    above: &OppositePoint,
    closest: &Closest,
    rounding: f64,
) -> Interval {
    let surface = &solid.surface;
    let foot = surface.point(above.foot.curve, above.foot.t, above.foot.v);
    let h = (closest.point.z - foot.z).abs() + closest.error + rounding;
    let reach = (2.0 * above.separation * h).sqrt() + rounding;
    let within = normals_within(surface, &above.foot, reach);
    if !solid.at_joint(&closest.place) {
        return within;
    }
    let direct = (above.point.z - closest.point.z).abs() / closest.distance;
    // The direction of a distance of 0 is NaN and stays NaN.
    if direct.is_nan() { Interval::of(f64::NAN) } else { within.with(direct) }
}

/// Returns the range of the ζ component of the unit normals of all points up to `reach` from a place.
fn normals_within(surface: &SampledSurface, foot: &ParameterPoint, reach: f64) -> Interval {
    let centre = surface.curves[foot.curve].point(foot.t);
    let near = Disc { centre, reach };
    let own = Interval::of(surface.curves[foot.curve].angle(foot.t));
    let curves = surface.curves.iter().filter(|curve| near.may_hold(curve));
    let tilts = curves.fold(own, |hull, curve| near.tilts(curve, [0.0, curve.length], HALVINGS, hull));
    surface.normals_between(tilts, foot.v, centre[1], reach)
}

/// The disc in a profile's plane in which points are sought.
struct Disc {
    centre: [f64; 2],
    reach: f64,
}

impl Disc {
    fn distance(&self, [x, z]: [f64; 2]) -> f64 {
        (x - self.centre[0]).hypot(z - self.centre[1])
    }

    fn may_hold(&self, curve: &SampledCurve) -> bool {
        self.distance(curve.point(0.0)) <= self.reach + curve.longest
    }

    /// Returns the hull widened by the tangent angles \[rad\] of the curve inside the disc, from parameter a
    /// to b.
    fn tilts(&self, curve: &SampledCurve, [a, b]: [f64; 2], halvings: u32, hull: Interval) -> Interval {
        let (middle, half) = (f64::midpoint(a, b), (b - a) / 2.0);
        let bend = curve.bend(middle, half);
        let speed = curve.speed(middle);
        let length = half * (speed + bend * half);
        if self.distance(curve.point(middle)) > self.reach + length {
            return hull;
        }
        let least_speed = speed - bend * half;
        if halvings > 0 && (length > PIECE * self.reach || least_speed <= 0.0) {
            let left = self.tilts(curve, [a, middle], halvings - 1, hull);
            return self.tilts(curve, [middle, b], halvings - 1, left);
        }
        let (angle, turn) = (curve.angle(middle), bend * half / least_speed);
        hull.hull(Interval::of(angle).grown(turn))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wheelrail::placement::Pair;
    use wheelrail::profile::{Arc, Half, Polynomial, Profile, Segment, Shape};

    /// A wave z = a(x³ − 3x) under a wheel has an inflection at 0, between extremes at ±1.
    #[test]
    fn an_inflection_inside_a_piece_is_seen() -> wheelrail::error::Result<()> {
        let wave = Polynomial::graph(&[0.0, -0.03, 0.0, 0.01], [-2.0, 2.0])?;
        let rail = Profile::new(
            "wave",
            "test",
            vec![Segment { label: String::new(), shape: Shape::Polynomial(wave) }],
        );
        let wheel = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-30.0, 30.0])?;
        let wheel = Profile::new("arc", "test", vec![Segment::arc(wheel)]);
        let pair = Pair::new(rail?, wheel?, 460.0)?;
        let placement = pair.placed(1.0, 0.0, 0.0)?;
        let surface = SampledSurface::rail(&placement);
        let foot = ParameterPoint { curve: 0, t: surface.curves[0].length / 2.0, v: 0.0 };
        for reach in [0.3, 0.9] {
            let [least, most] = normals_within(&surface, &foot, reach).ends();
            let component = |x: f64| 1.0 / (1.0 + (0.03 * x * x - 0.03).powi(2)).sqrt();
            // The wave is steepest at its inflection. Only x = 0 shows it, and neither end does.
            assert!(least <= component(0.0) && least > component(0.0) - 1e-4, "{least}");
            assert!(most >= component(0.999 * reach) && most < component(reach) + 1e-4, "{most}");
        }
        Ok(())
    }
}
