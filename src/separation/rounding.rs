//! Estimates the rounding error of s over a grid, from the sizes of the terms from which s is computed.

use super::axis::EtaAxis;
use super::relief::Relief;
use super::wheel_surface::sagitta;
use crate::numerics::interval::Interval;
use crate::profile::{Branch, BranchShape, Piece, Section};

/// Number of roundings of the terms of s (gap, rise, and their interpolation over ξ): without yaw, and under yaw, where s
/// is interpolated in powers of η.
const OWN_ROUNDINGS: [f64; 2] = [16.0, 32.0];

/// Number of roundings of the coordinates, which count beyond the contact segments. The worst of 2,700 random scenes needed
/// 2.6.
const PLACE_ROUNDINGS: f64 = 4.0;

/// Steepest slope at which the end of a piece itself counts. At a steeper end, which may be vertical, the nearest column
/// counts.
const STEEP: f64 = 1.0;

/// Estimates the largest rounding error of a relief \[mm\] over a grid. `largest` \[mm\] bounds the sum of the magnitudes of the
/// terms of s.
///
/// The estimate is a few units of the last place of that sum. Beyond the contact segments two terms are added for each body. The
/// first is the rounding of the heights by which joints are placed in the frame, ζ = Δz cosθ − Δx sinθ, with z_C rounded in Δz.
/// The second is the larger of two: the error of the angle θ_C (the rounding of its sine over its cosine) times the distance from
/// C; and the rounding of ξ and of the run to an arc's centre, times the slope.
pub fn rounding(relief: &Relief<'_>, xi: &[f64], axis: &EtaAxis, largest: f64) -> f64 {
    let bodies = [CoveredPart::below(relief, xi), CoveredPart::above(relief, xi, axis)];
    let of_sum = OWN_ROUNDINGS[usize::from(relief.is_skewed())] * f64::EPSILON * largest;
    if bodies.iter().all(|body| body.contact) {
        return of_sum;
    }
    of_sum + PLACE_ROUNDINGS * f64::EPSILON * (bodies[0].coordinates + bodies[1].coordinates)
}

/// The part of a profile over which a grid lies.
struct CoveredPart {
    /// Whether this part is only the contact segment.
    contact: bool,
    /// Size \[mm\] of the coordinates from which heights are computed, with the slope's share.
    coordinates: f64,
}

impl CoveredPart {
    fn below(relief: &Relief<'_>, xi: &[f64]) -> Self {
        Self::new(relief.below, xi, &[0.0], |xi, _| xi)
    }

    /// Finds the part of the wheel's profile. Away from the midplane, columns lie over other places of it.
    fn above(relief: &Relief<'_>, xi: &[f64], axis: &EtaAxis) -> Self {
        let wheel = &relief.wheel;
        let below = |xi: f64, eta: f64| {
            let [shift, eta_w] = relief.skew.own(xi, eta);
            // The axle distance at C is accurate enough, because e varies by thousandths of itself.
            wheel.abscissa(xi + shift, sagitta(wheel.axle, eta_w * eta_w))
        };
        let ends = [axis.eta.first(), axis.eta.last()].map(|eta| eta.copied().unwrap_or(0.0));
        Self::new(wheel.section, xi, &[0.0, ends[0], ends[1]], below)
    }

    /// Finds the part of a section over the abscissae that the columns reach at some η.
    fn new(section: &Section, xi: &[f64], eta: &[f64], abscissa: impl Fn(f64, f64) -> f64) -> Self {
        let mut reached = Self { contact: true, coordinates: 0.0 };
        let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return reached };
        let ends = |xi| eta.iter().map(move |&eta| (xi, eta)).map(|(xi, eta)| abscissa(xi, eta));
        let over = Interval::around(ends(first).chain(ends(last)));
        let curves = reached_pieces(section, over).all(|piece| is_curve(section, piece));
        let reach = over.magnitude();
        // Polynomials are turned into the frame in twice the working precision.
        let width = if curves { reach } else { reach + section.frame.x.abs() };
        let (mut height, mut climb) = (0f64, 0f64);
        for piece in reached_pieces(section, over) {
            reached.contact &= section.contact == Some(piece.branch);
            let branch = &section.branches[piece.branch];
            for end in [0, 1] {
                let (point, zeta) = section.end(piece, end);
                let (at, zeta) = if over.contains(piece.xi[end]) {
                    (branch.slope_from(&point), zeta)
                } else {
                    let at = over[end];
                    (branch.chord_slope(at, at), branch.height(at))
                };
                height = height.max(zeta.abs());
                let slope = if at.abs() <= STEEP {
                    at.abs()
                } else {
                    eta.iter().fold(0.0, |most, &eta| {
                        let nearest = nearest(piece, end, xi, |xi| abscissa(xi, eta));
                        nearest.map_or(most, |x| branch.chord_slope(x, x).abs().max(most))
                    })
                };
                climb = climb.max((width + run_to_centre(branch, slope)) * slope);
            }
        }
        // The angle of an arc at C is that of its rounded sine.
        let sine = section.frame.sin.abs();
        let turn = if curves { sine } else { sine / section.frame.cos };
        reached.coordinates = section.frame.z.abs() + height + climb.max(turn * width);
        reached
    }
}

/// Returns the pieces that touch an interval.
fn reached_pieces(section: &Section, xi: Interval) -> impl Iterator<Item = &Piece> {
    section.pieces_from(xi.low).iter().take_while(move |piece| piece.xi.low <= xi.high)
}

fn is_curve(section: &Section, piece: &Piece) -> bool {
    matches!(section.branches[piece.branch].shape, BranchShape::Polynomial(_))
}

/// Computes the run in ξ \[mm\] from a point of an arc with this slope to the centre: the radius times the sine of the
/// tangent's angle, which is rounded. It is 0 for a line or polynomial.
fn run_to_centre(branch: &Branch, slope: f64) -> f64 {
    match &branch.shape {
        BranchShape::Arc(arc) if arc.radius.is_finite() => arc.radius.abs() * slope / 1f64.hypot(slope),
        _ => 0.0,
    }
}

/// Finds the abscissa of a column inside a piece that is nearest to one end of the piece; `None` if no column lies over the
/// piece. The abscissae of the columns ascend.
fn nearest(piece: &Piece, end: usize, xi: &[f64], abscissa: impl Fn(f64) -> f64) -> Option<f64> {
    let index = if end == 0 {
        xi.partition_point(|&xi| abscissa(xi) < piece.xi.low)
    } else {
        xi.partition_point(|&xi| abscissa(xi) <= piece.xi.high).checked_sub(1)?
    };
    let x = abscissa(*xi.get(index)?);
    piece.xi.contains(x).then_some(x)
}
