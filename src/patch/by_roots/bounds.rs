//! Bounds of the slopes of the gap between a wheel and a roller over a part of the tangent plane or of the roller's surface.

use std::f64::consts::FRAC_PI_2;

use super::tilts::{ANGLE_ROUNDING, Tilts, cosines};
use crate::conformal::RailArcLength;
use crate::numerics::interval::Interval;
use crate::patch::in_valleys::circle::Turned;
use crate::placement::Placement;
use crate::profile::Section;

/// Most widenings of a range that is to hold the gap, or the lowest places along η.
const WIDENINGS: usize = 4;

/// Factor by which such a range is widened.
const WIDER: f64 = 4.0;

/// Kink of a roller's crown \[rad\] at which the gap along its normals steps. A smaller one moves gaps near δ by some roundings.
const KINK: f64 = 1e-11;

/// Range of η around a lowest place, in widths of the range of ξ, that only a kink makes wider.
const KINKED: f64 = 16.0;

/// Least range of η \[mm\] around a lowest place.
const NARROWEST: f64 = 1e-9;

/// A place along ξ or σ, and the least gap there.
#[derive(Debug, Clone, Copy)]
pub(super) struct LowestPlace {
    /// ξ or σ \[mm\].
    pub(super) xi: f64,
    /// η of the least gap \[mm\], or of one far above δ.
    pub(super) eta: f64,
    /// Bounds of the least gap inside the window, less δ \[mm\]; the upper one is that at η. NaN where a body is missing.
    pub(super) depth: Interval,
}

impl LowestPlace {
    /// Whether a body is missing.
    pub(super) fn is_missing(&self) -> bool {
        self.depth.high.is_nan()
    }
}

/// Bounds the slopes of the gap of a placed pair.
#[derive(Debug)]
pub(super) struct GapBounds<'a> {
    /// Of the wheel, and of the roller upside down.
    bodies: [Tilts<'a>; 2],
    /// The roller's crown, if t over it is the gap.
    crown: Option<(RailArcLength<'a>, &'a Section)>,
    /// Approach δ \[mm\].
    approach: f64,
    /// Coefficient \[1/mm\] of η² at C, without skew.
    opening: f64,
}

/// The roller's crown over a range of ξ or σ.
struct CrownBounds {
    /// ξ \[mm\].
    xi: Interval,
    /// Angle from ξ \[rad\].
    angle: Interval,
    /// Curvature \[1/mm\], positive where the hollow side is up.
    curvature: Interval,
}

/// Bounds of the slopes of the gap.
struct SlopeBounds {
    along: Interval,
    /// Along ξ or σ, where the gap does not slope along η. They are narrow where a kink of the wheel is lowest, too.
    lowest: Interval,
    across: Interval,
}

impl CrownBounds {
    /// Returns bounds of a wheel's slope along the crown from its slope across and the direction of its circles in ξ, η and ζ; `None`
    /// where a circle may run square to the crown.
    ///
    /// Method: a surface of revolution holds a circle through each of its points, also on a kink. The direction of that circle and the
    /// one across span the tangent plane.
    fn slope_on_circle(&self, [xi, eta, zeta]: [Interval; 3], across: Interval) -> Option<Interval> {
        let (sin, cos) = (self.angle.map(f64::sin), cosines(self.angle));
        let along = xi * cos + zeta * sin;
        let rise = (zeta * cos + -(xi * sin) + -(across * eta)).grown(ANGLE_ROUNDING);
        if along.contains(0.0) {
            return None;
        }
        Some(if along.low > 0.0 { rise.quotient(along) } else { (-rise).quotient(-along) })
    }
}

impl<'a> GapBounds<'a> {
    /// Makes the bounds of a wheel on a roller; `crown` is the roller's surface where t over it is the gap. `None` on a rail.
    pub(super) fn new(
        placement: &'a Placement,
        crown: Option<RailArcLength<'a>>,
        (approach, opening): (f64, f64),
    ) -> Option<Self> {
        let bodies = [placement, placement.under()?].map(Turned::new).map(Tilts::new);
        let crown = crown.map(|crown| (crown, &placement.rail().section));
        Some(Self { bodies, crown, approach, opening })
    }

    /// Returns the σ \[mm\] at which the roller's crown has kinks, if t over it is the gap.
    pub(super) fn kinks(&self) -> Vec<f64> {
        let Some((crown, section)) = &self.crown else { return Vec::new() };
        let angle = |piece: usize, end: usize| section.end_slope(&section.pieces[piece], end).atan();
        let pieces: Vec<_> = crown.pieces().collect();
        let joints = pieces.windows(2).map(|pair| (pair[1].0.low, [pair[0].1, pair[1].1]));
        // C parts its own piece.
        let kinks = joints.filter(|&(_, [a, b])| a != b && (angle(a, 1) - angle(b, 0)).abs() > KINK);
        kinks.map(|(sigma, _)| sigma).collect()
    }

    /// Returns bounds of the slope of the least gap between two places; infinite where none are known.
    ///
    /// Method: from line to line the least gap changes as the gap does along ξ at the lowest place. The lowest places of a range of ξ lie
    /// between an η at which the gap falls along η all over that range, and one at which it rises.
    pub(super) fn slopes(&self, [a, b]: [&LowestPlace; 2], skewed: bool, window: Interval) -> Interval {
        let cell = Interval::new(a.xi, b.xi);
        let found = || {
            let crown = self.crown_over(cell)?;
            let depths = a.depth.hull(b.depth);
            let gaps = depths.hull(depths + self.approach);
            let mut margin = cell.width();
            for _ in 0..WIDENINGS {
                // Over the tangent plane the gap does not matter.
                let gap = gaps.grown(margin);
                let eta = if skewed {
                    self.lowest((&crown, cell.width()), gap, a.eta + (b.eta - a.eta) / 2.0)?
                        .with(a.eta)
                        .with(b.eta)
                } else {
                    Interval::of(0.0)
                };
                let slopes = self.over(&crown, gap, eta.map(|eta| window.nearest(eta)))?;
                let change =
                    slopes.along.magnitude() * cell.width() + slopes.across.magnitude() * eta.width();
                if self.crown.is_none() || change <= margin {
                    return Some(if window.holds(eta) { slopes.lowest } else { slopes.along });
                }
                margin *= WIDER;
            }
            None
        };
        found().unwrap_or(Interval::ALL)
    }

    /// Returns a range of η \[mm\] that holds the lowest places over a part of the crown of a width \[mm\], from one between them.
    fn lowest(&self, (crown, width): (&CrownBounds, f64), gap: Interval, middle: f64) -> Option<Interval> {
        let across = |eta: f64| Some(self.over(crown, gap, Interval::of(eta))?.across);
        let holds = |margin: f64| {
            let Interval { low, high } = Interval::of(middle).grown(margin);
            Some(across(low)?.high < 0.0 && across(high)?.low > 0.0)
        };
        let mut margin = across(middle)?.magnitude() / self.opening + NARROWEST;
        let mut widenings = 0;
        while !holds(margin)? {
            (margin, widenings) = (WIDER * margin, widenings + 1);
            if widenings == WIDENINGS {
                return None;
            }
        }
        while margin > KINKED * width && holds(margin / WIDER) == Some(true) {
            margin /= WIDER;
        }
        Some(Interval::of(middle).grown(margin))
    }

    /// Returns bounds of the slopes of the gap over a part of the crown and a range of η \[mm\], where the gap lies within a range \[mm\].
    /// `None` where a body's surface ends, steps or stands upright.
    fn over(&self, crown: &CrownBounds, gap: Interval, eta: Interval) -> Option<SlopeBounds> {
        let below = self.crown.as_ref().map_or(0.0, |_| eta.magnitude().powi(2) / self.bodies[1].radii.low);
        let below = Interval::new(0.0, below);
        // `up` is 1 for the wheel, and −1 for the roller, which is seen upside down.
        let of_body = |body: usize, up: f64, gap: Interval, across: Option<Interval>| {
            let angle = crown.angle * Interval::of(up);
            let xi = match self.crown {
                Some(_) => crown.xi + -(gap * angle.map(f64::sin)),
                None => crown.xi,
            };
            let tilts = self.bodies[body].over(xi, eta)?;
            let own = tilts.angle + -angle;
            if own.magnitude() >= FRAC_PI_2 {
                return None;
            }
            let stretch = -(gap * crown.curvature * Interval::of(up)) + 1.0;
            let along = own.map(f64::tan) * stretch;
            let on_circle = across.and_then(|across| crown.slope_on_circle(tilts.circle, across));
            let lowest = on_circle.map_or(along, |slope| along.cut(slope * stretch));
            Some(SlopeBounds { along, lowest, across: tilts.lean.quotient(cosines(own)) })
        };
        let roller = of_body(1, -1.0, below, None)?;
        let wheel = of_body(0, 1.0, gap + -below, Some(-roller.across))?;
        // The slope of δ (1 − cos α).
        let turning = crown.angle.map(f64::sin) * crown.curvature * Interval::of(self.approach);
        let rest = roller.along + turning;
        Some(SlopeBounds {
            along: wheel.along + rest,
            lowest: wheel.lowest + rest,
            across: wheel.across + roller.across,
        })
    }

    /// Returns bounds of the crown over a range of ξ or σ \[mm\].
    fn crown_over(&self, cell: Interval) -> Option<CrownBounds> {
        let Some((crown, section)) = &self.crown else {
            return Some(CrownBounds { xi: cell, angle: Interval::of(0.0), curvature: Interval::of(0.0) });
        };
        let xi = Interval::new(crown.point(cell.low)?.xi, crown.point(cell.high)?.xi);
        let pieces = section.pieces_from(xi.low).iter().take_while(|piece| piece.xi.low <= xi.high);
        let curvatures =
            pieces.map(|piece| section.branches[piece.branch].curvature_bounds(xi.cut(piece.xi)));
        Some(CrownBounds {
            xi,
            angle: section.slopes_over(xi)?.map(f64::atan),
            curvature: curvatures.fold(Interval::NONE, Interval::hull),
        })
    }
}
