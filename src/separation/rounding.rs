//! The rounding error of s over a grid, from the sizes of what s is computed from.

use super::Evaluator;
use super::axis::EtaAxis;
use super::column::{WheelSurface, sagitta};
use crate::placement::Placement;
use crate::profile::{Piece, Section};

/// Roundings of s over the contact segments: gap, rise, and their interpolation over ξ; under yaw that in powers of η.
const CONTACT_ROUNDINGS: [f64; 2] = [8.0, 32.0];

/// … and elsewhere: both bodies' joints are off at once.
const PLACE_ROUNDINGS: f64 = 2.0;

/// Up to this slope a piece's end counts as it is; at a steeper one, which may be vertical, the nearest column counts.
const STEEP: f64 = 1.0;

/// Largest rounding error of s \[mm\] over a grid where |s| is at most `largest` \[mm\].
///
/// A few units of the last place of s over the contact segments; elsewhere, of the heights by which joints are placed in the
/// frame, ζ = Δz cosθ − Δx sinθ, with z_C rounded in Δz, and of the rounded ξ times slope.
pub fn rounding(placement: &Placement, xi: &[f64], axis: &EtaAxis, largest: f64) -> f64 {
    let bodies = [Reached::of_rail(placement, xi), Reached::of_wheel(placement, xi, axis)];
    if bodies.iter().all(|body| body.contact) {
        return CONTACT_ROUNDINGS[usize::from(placement.skew != 0.0)] * f64::EPSILON * largest;
    }
    PLACE_ROUNDINGS * f64::EPSILON * largest.max(bodies[0].coordinates + bodies[1].coordinates)
}

/// What of a profile a grid lies over.
struct Reached {
    /// Whether it is nothing but the contact segment.
    contact: bool,
    /// Size of the coordinates that heights are computed from, the slope's share included \[mm\].
    coordinates: f64,
}

impl Reached {
    fn of_rail(placement: &Placement, xi: &[f64]) -> Self {
        Self::new(&placement.rail.section, xi, &[0.0], |xi, _| xi)
    }

    /// Beside the midplane columns lie over other places of the wheel's profile.
    fn of_wheel(placement: &Placement, xi: &[f64], axis: &EtaAxis) -> Self {
        let evaluator = Evaluator::new(placement);
        let wheel = WheelSurface::new(placement);
        let below = |xi: f64, eta: f64| {
            let [shift, eta_w] = evaluator.wheel_coordinates(xi, eta);
            // The axle distance at C will do: e varies by its thousandths.
            wheel.abscissa(xi + shift, sagitta(wheel.axle, eta_w * eta_w))
        };
        let ends = [axis.eta.first(), axis.eta.last()].map(|eta| eta.copied().unwrap_or(0.0));
        Self::new(&placement.wheel.section, xi, &[0.0, ends[0], ends[1]], below)
    }

    /// Over the abscissae that columns reach at some η.
    fn new(section: &Section, xi: &[f64], eta: &[f64], abscissa: impl Fn(f64, f64) -> f64) -> Self {
        let mut reached = Self { contact: true, coordinates: 0.0 };
        let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return reached };
        let ends = |xi| eta.iter().map(move |&eta| (xi, eta)).map(|(xi, eta)| abscissa(xi, eta));
        let from = ends(first).chain(ends(last)).fold(f64::INFINITY, f64::min);
        let to = ends(first).chain(ends(last)).fold(f64::NEG_INFINITY, f64::max);
        let (mut height, mut slope) = (0f64, 0f64);
        for piece in section.pieces_from(from).iter().take_while(|piece| piece.xi[0] <= to) {
            reached.contact &= section.contact == Some(piece.branch);
            let branch = &section.branches[piece.branch];
            for end in [0, 1] {
                let (point, zeta) = &piece.ends[end];
                let outside = if end == 0 { piece.xi[0] < from } else { piece.xi[1] > to };
                let (at, zeta) = if outside {
                    let at = if end == 0 { from } else { to };
                    (branch.chord_slope(at, at), branch.height(at))
                } else {
                    (branch.slope_from(point), *zeta)
                };
                height = height.max(zeta.abs());
                if at.abs() <= STEEP {
                    slope = slope.max(at.abs());
                } else {
                    slope = eta.iter().fold(slope, |most, &eta| {
                        let nearest = nearest(piece, end, xi, |xi| abscissa(xi, eta));
                        nearest.map_or(most, |x| branch.chord_slope(x, x).abs().max(most))
                    });
                }
            }
        }
        let width = from.abs().max(to.abs()) + section.frame.x.abs();
        reached.coordinates =
            section.frame.z.abs() + height + (width * slope).max(section.frame.sin.abs() * width);
        reached
    }
}

/// The abscissa inside a piece that is nearest to one of its ends, of columns whose abscissae ascend.
fn nearest(piece: &Piece, end: usize, xi: &[f64], abscissa: impl Fn(f64) -> f64) -> Option<f64> {
    let index = if end == 0 {
        xi.partition_point(|&xi| abscissa(xi) < piece.xi[0])
    } else {
        xi.partition_point(|&xi| abscissa(xi) <= piece.xi[1]).checked_sub(1)?
    };
    let x = abscissa(*xi.get(index)?);
    (piece.xi[0] <= x && x <= piece.xi[1]).then_some(x)
}
