//! Finds the intervals of ξ over which s along a valley or ridge only rises or only falls.

use nalgebra::Vector2;

use super::path::Leg;
use super::valleys::Valleys;
use crate::numerics::interval::Interval;
use crate::numerics::lanes::Lanes;
use crate::numerics::sign_changes::sign_changes;
use crate::patch::raised::{Raised, RaisedPiece};
use crate::profile::{Branch, Section, Station};

/// Angle between the surfaces below which its sign does not count. Turns that are missed change s by less than 1e-13 of their
/// distance along the surfaces.
const ANGLE_NOISE: f64 = 1e-13;

/// One leg over one piece of the rail.
struct RailStretch<'v> {
    valleys: &'v Valleys<'v>,
    leg: &'v Leg,
    rail: &'v Branch,
    /// Bounds of ds/dξ along the leg.
    slopes: Interval,
    /// Whether the rail may stand upright.
    upright: bool,
}

/// Appends the intervals of ξ \[mm\], in order, over which s along a valley or ridge is monotone inside a given range. They
/// end at joints of both bodies and where s turns. A stretch between joints is left out if `matters` is false for bounds of
/// its least and largest s.
///
/// Method: the slope of the surface where it is parallel to η is a monotone function of the profile's angle. Bounds of that angle
/// and of the rail's slope prove that s does not turn over a stretch, or that the stretch does not matter; elsewhere all sign
/// changes of the angle between the surfaces are found, for polynomials of any degree, over the rail's own parameter where the rail
/// may stand upright. Cost: two places for most stretches, 16 and more for those over which the bodies may be parallel.
pub(crate) fn monotone(
    valleys: &Valleys<'_>,
    rail: &Section,
    crease: usize,
    xi: Interval,
    matters: impl Fn(Interval) -> bool,
    intervals: &mut Vec<Interval>,
) {
    for leg in &valleys.creases[crease].legs {
        let wheel = valleys.slopes(leg);
        let over = xi.cut(leg.xi.into());
        let before = rail.pieces.partition_point(|piece| piece.xi.high <= over.low);
        let pieces = rail.pieces.iter().enumerate().skip(before);
        for (index, piece) in pieces.take_while(|(_, piece)| piece.xi.low < over.high) {
            let bounds = rail.slopes(index);
            let over = over.cut(piece.xi);
            if !over.has_width() {
                continue;
            }
            let (slopes, upright) = (wheel + -bounds, bounds.magnitude().is_infinite());
            let stretch = RailStretch { valleys, leg, rail: &rail.branches[piece.branch], slopes, upright };
            let mut turns = Vec::new();
            if stretch.turns(over, &matters, &mut turns) {
                intervals.extend(over.parts(turns));
            }
        }
    }
}

/// Appends the intervals of σ \[mm\] over which the height of a valley or ridge over the raised rail is monotone, as [`monotone`] does for
/// s over the tangent plane. A part is left out if all of a valley is above it, or all of a ridge below. Appends to `level` the ranges
/// of σ over which the valley may be parallel to the rail, raised by up to δ.
///
/// Method: as there, with bounds of both directions of the raised curve in place of the rail's slope.
pub(super) fn along_surface(
    valleys: &Valleys<'_>,
    (raised, pieces): (&Raised<'_>, &[RaisedPiece]),
    crease: usize,
    intervals: &mut Vec<Interval>,
    level: &mut Vec<Interval>,
) {
    let is_valley = valleys.creases[crease].is_valley;
    for leg in &valleys.creases[crease].legs {
        let (legs, slopes) = (Interval::from(leg.xi), valleys.slopes(leg));
        for piece in pieces {
            let [run, rise] = piece.direction;
            let xi = piece.bounds[0].cut(legs);
            if !xi.has_width() {
                continue;
            }
            let ends = xi.ends().map(|xi| valleys.place(leg, valleys.parameter(leg, xi)).1);
            let most = slopes.magnitude() * xi.width();
            let heights = Interval::between(ends[0], ends[1]).grown(most);
            let gap = heights + -piece.bounds[1];
            let matters = if is_valley { gap.low <= 0.0 } else { gap.high >= 0.0 };
            if !matters {
                continue;
            }
            let growth = rise + -(slopes * run);
            let may_turn = !(growth.low > 0.0 || growth.high < 0.0);
            if may_turn && level.last() != Some(&piece.sigma) {
                level.push(piece.sigma);
            }
            let angle = |sigma: f64| {
                let [run, rise] = raised.direction(sigma);
                let (_, _, direction) = valleys.place(leg, valleys.parameter(leg, raised.xi(sigma)));
                direction.y * run - direction.x * rise
            };
            for over in raised.runs(piece).into_iter().filter_map(|run| raised.over(run, legs)) {
                let mut turns = Vec::new();
                if may_turn {
                    sign_changes(|sigma: &Lanes| sigma.map(angle), over, ANGLE_NOISE, &mut turns);
                }
                intervals.extend(over.parts(turns));
            }
        }
    }
}

impl RailStretch<'_> {
    /// Returns whether the stretch matters; if it does, appends the ξ inside it at which s may turn.
    fn turns(&self, xi: Interval, matters: &impl Fn(Interval) -> bool, turns: &mut Vec<f64>) -> bool {
        let ends = xi.ends().map(|xi| self.valleys.parameter(self.leg, xi));
        let [a, b] = ends.map(|at| self.gap(at));
        let (falls, climbs) = (self.slopes.low.min(0.0), self.slopes.high.max(0.0));
        let length = xi.width();
        // A bound that is no number decides nothing.
        let least = (a + falls * length).max(b - climbs * length);
        let most = (a + climbs * length).min(b - falls * length);
        if !(least.is_nan() || most.is_nan() || matters(Interval::new(least, most))) {
            return false;
        }
        if self.slopes.low > 0.0 || self.slopes.high < 0.0 {
            return true;
        }
        let mut places = Vec::new();
        if self.upright {
            let ends = xi.map(|xi| self.rail.parameter(xi));
            let angles = |parameters: &Lanes| parameters.map(|parameter| self.angle_over_rail(xi, parameter));
            sign_changes(angles, ends, ANGLE_NOISE, &mut places);
            turns.extend(places.into_iter().map(|parameter| self.rail.station_and_curvature(parameter).0.x));
        } else {
            let angles = |at: &Lanes| at.map(|at| self.angle(at));
            sign_changes(angles, Interval::between(ends[0], ends[1]), ANGLE_NOISE, &mut places);
            turns.extend(places.into_iter().map(|at| self.valleys.place(self.leg, at).0));
        }
        true
    }

    /// Returns s \[mm\] at a parameter of the leg, to the rounding of both bodies' heights.
    fn gap(&self, at: f64) -> f64 {
        let (xi, height, _) = self.valleys.place(self.leg, at);
        height - self.rail.height(xi)
    }

    /// Returns the sine of the angle between both surfaces along the valley or ridge, times a positive factor. Unlike the slope of s it
    /// is finite where a surface stands upright.
    fn angle(&self, at: f64) -> f64 {
        let (xi, _, direction) = self.valleys.place(self.leg, at);
        sine_between(direction, &self.rail.station(xi))
    }

    /// Returns the sine of the angle between both surfaces, times a positive factor, as a function of the rail's own parameter: it is
    /// smooth where the rail stands upright.
    fn angle_over_rail(&self, xi: Interval, parameter: f64) -> f64 {
        let rail = self.rail.station_and_curvature(parameter).0;
        let at = self.valleys.parameter(self.leg, xi.nearest(rail.x));
        let (_, _, direction) = self.valleys.place(self.leg, at);
        sine_between(direction, &rail)
    }
}

/// Returns the sine of the angle between a direction \[dξ, dζ\] of the wheel's surface and the rail's tangent, times the length of the
/// direction.
fn sine_between(direction: Vector2<f64>, rail: &Station) -> f64 {
    direction.y * rail.cos - direction.x * rail.sin
}
