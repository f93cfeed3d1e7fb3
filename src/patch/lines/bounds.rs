//! Bounds of the gap and of its slopes over a box of the ξ–η plane, or of the σ–η plane of the rail's surface.

use std::f64::consts::FRAC_PI_2;

use super::round::{BoxBends, Round, SurfaceSlopes, Torn};
use super::tree::ProfileTree;
use crate::conformal::RailArcLength;
use crate::numerics::direction;
use crate::numerics::interval::Interval;
use crate::patch::raised::Raised;
use crate::placement::Placement;
use crate::profile::Side;

/// Fall of the slope at kinks beyond which second derivatives are not asked for: no gap without a radius below 1 mm is convex to 1e-13 mm.
const MOST_FALL: f64 = 1e-6;

/// Bounds of the slopes of a gap over a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxSlopes {
    /// Along ξ or σ.
    pub(super) along: Interval,
    /// Along ξ or σ, where the gap does not slope along η: as a/cosχ, and as −b/sinχ, which is narrow where a kink of the wheel is lowest.
    pub(super) lowest: Interval,
    /// Along η.
    pub(super) across: Interval,
    /// η \[mm\] of all places in the box at which the gap does not slope along η.
    pub(super) level_at: Interval,
}

/// What lies below the wheel.
#[derive(Debug)]
enum Under<'a> {
    Rail(ProfileTree<'a>),
    /// Upside down.
    Roller(Round<'a>),
}

/// A rail's or roller's own surface over a range of σ.
struct SurfaceBounds {
    /// ξ of the profile \[mm\].
    foot: Interval,
    /// Angle from ξ \[rad\].
    angle: Interval,
    /// Curvature \[1/mm\], positive where the hollow side is up.
    curvature: Interval,
}

/// The raised curve of a rail's surface over a range of σ.
struct RaisedSlopes {
    /// ξ \[mm\].
    xi: Interval,
    /// dξ/dσ.
    run: Interval,
    /// dζ/dσ.
    rise: Interval,
}

/// Bounds of the gap of a placed pair.
#[derive(Debug)]
pub(super) struct GapBounds<'a> {
    wheel: Round<'a>,
    under: Under<'a>,
}

impl<'a> GapBounds<'a> {
    pub(super) fn new(placement: &'a Placement) -> Self {
        let under = match placement.under() {
            Some(under) => Under::Roller(Round::new(under)),
            None => Under::Rail(ProfileTree::new(&placement.rail().section)),
        };
        Self { wheel: Round::new(placement), under }
    }

    /// Returns the range of η \[mm\], over all ξ of a range, up to which surfaces are looked at.
    pub(super) fn within(&self, xi: Interval) -> Interval {
        let wheel = self.wheel.within(xi);
        match &self.under {
            Under::Rail(_) => wheel,
            Under::Roller(roller) => wheel.cut(roller.within(xi)),
        }
    }

    /// Returns whether no surface of revolution is found to fold back over a box.
    pub(super) fn are_open(&self, xi: Interval, eta: Interval) -> bool {
        let below = match &self.under {
            Under::Rail(_) => true,
            Under::Roller(roller) => roller.is_open(xi, eta),
        };
        below && self.wheel.is_open(xi, eta)
    }

    /// Returns bounds of the slopes of s over a box; `None` where a surface ends, steps or stands upright, and far from the midplane.
    pub(super) fn over_plane(&self, xi: Interval, eta: Interval, torn: Torn) -> Option<BoxSlopes> {
        let [none, one] = [0.0, 1.0].map(Interval::of);
        let below = match &self.under {
            Under::Rail(tree) => {
                let along = -tree.over(xi)?.slopes;
                SurfaceSlopes { xi, along, growth: none, across: none }
            }
            Under::Roller(roller) => roller.slopes_over(xi, eta, torn)?,
        };
        let above = self.wheel.slopes_over(xi, eta, torn)?;
        let [sin, cos] = self.wheel.skew;
        let [along, across] = self.turned(&above);
        let along = along + below.along;
        let lowest = above.along * (1.0 / cos) + below.across * (sin / cos) + below.along;
        let at_kinks = if sin == 0.0 {
            Interval::ALL
        } else {
            -(above.across + below.across * cos) * (1.0 / sin) + below.along
        };
        Some(BoxSlopes {
            along,
            lowest: along.cut(lowest).cut(at_kinks),
            across: across + below.across,
            level_at: self.level_at(&above, one, below.growth),
        })
    }

    /// Returns the wheel's slopes along ξ and η.
    fn turned(&self, above: &SurfaceSlopes) -> [Interval; 2] {
        let [sin, cos] = self.wheel.skew;
        [above.along * cos + -(above.across * sin), above.along * sin + above.across * cos]
    }

    /// Returns bounds of the η \[mm\] at which a gap does not slope along η. Its slope is that of the wheel's height, divided by `facing`, and
    /// `growth` × η of what is below.
    ///
    /// Method: with η′ = η cosχ − ξ sinχ, a sinχ + (b/η′) η′ cosχ is linear in η.
    fn level_at(&self, above: &SurfaceSlopes, facing: Interval, growth: Interval) -> Interval {
        let [sin, cos] = self.wheel.skew;
        let at_midplane = (above.along + -(above.xi * above.growth * cos)) * sin;
        let spread = (above.growth * (cos * cos)).quotient(facing) + growth;
        (-at_midplane).quotient(facing * spread)
    }

    /// Returns bounds of the direction of the raised curve of a rail's surface over a range of σ.
    fn raised_slopes(&self, (raised, approach): (&Raised<'_>, f64), sigma: Interval) -> Option<RaisedSlopes> {
        let Under::Rail(tree) = &self.under else { return None };
        let ends = sigma.ends().map(|sigma| raised.at(sigma));
        let foot = Interval::new(ends[0].foot, ends[1].foot);
        let slopes = tree.over(foot)?.slopes;
        let [sine, cosine] = [
            slopes.map(|slope| direction(slope)[1]),
            Interval::new(direction(slopes.magnitude())[0], direction(slopes.nearest(0.0))[0]),
        ];
        let turned = tree.curvatures(foot) * approach;
        let run = cosine + -(turned * (cosine.squared() + -sine.squared()));
        let rise = sine + -(turned * sine * cosine * 2.0);
        // The curve runs straight from end to end, or goes back and comes again.
        let back = if run.low >= 0.0 || run.high <= 0.0 { 0.0 } else { -run.low * run.high / run.width() };
        let xi = Interval::between(ends[0].xi(), ends[1].xi()).grown(back * sigma.width());
        Some(RaisedSlopes { xi, run, rise })
    }

    /// Returns the range of ξ \[mm\] of the raised curve of a rail's surface over a range of σ; `None` where the rail ends or steps.
    pub(super) fn raised_xi(&self, raised: (&Raised<'_>, f64), sigma: Interval) -> Option<Interval> {
        self.raised_slopes(raised, sigma).map(|over| over.xi)
    }

    /// Returns bounds of the slope of the gap along a circle over a box that holds it, from those of its height's slope and of dη/dξ; `None`
    /// where what faces it ends or steps. `raised` is a rail's raised surface, unless the gap is over the tangent plane.
    pub(super) fn along_rim(
        &self,
        (body, [slopes, turns]): (Side, [Interval; 2]),
        (raised, approach): (Option<&Raised<'_>>, f64),
        (xi, eta): (Interval, Interval),
    ) -> Option<Interval> {
        let facing = match (raised, &self.under, body) {
            (Some(raised), ..) => {
                let RaisedSlopes { run, rise, .. } = self.raised_slopes((raised, approach), xi)?;
                return Some(slopes * run + -rise);
            }
            (None, Under::Rail(tree), _) => -tree.over(xi)?.slopes,
            (None, Under::Roller(roller), Side::Wheel) => {
                let below = roller.slopes_over(xi, eta, Torn::No)?;
                below.along + below.across * turns
            }
            (None, Under::Roller(_), Side::Rail) => {
                let above = self.wheel.slopes_over(xi, eta, Torn::No)?;
                let [along, across] = self.turned(&above);
                along + across * turns
            }
        };
        Some(slopes + facing)
    }

    /// Returns bounds of the slopes of the wheel's height over the raised curve of a rail's surface, over a box of σ and η; `None` as for
    /// [`Self::over_plane`].
    pub(super) fn over_raised(
        &self,
        (raised, approach): (&Raised<'_>, f64),
        sigma: Interval,
        (eta, torn): (Interval, Torn),
    ) -> Option<BoxSlopes> {
        let RaisedSlopes { xi, run, rise } = self.raised_slopes((raised, approach), sigma)?;
        let above = self.wheel.slopes_over(xi, eta, torn)?;
        let [sin, cos] = self.wheel.skew;
        let [along, across] = self.turned(&above);
        let along = along * run + -rise;
        let lowest = above.along * (1.0 / cos) * run + -rise;
        let at_kinks = if sin == 0.0 { Interval::ALL } else { -above.across * (1.0 / sin) * run + -rise };
        Some(BoxSlopes {
            along,
            lowest: along.cut(lowest).cut(at_kinks),
            across,
            level_at: self.level_at(&above, Interval::of(1.0), Interval::of(0.0)),
        })
    }

    /// Returns bounds of the slopes of t + δ (1 − cos α) over a box of σ and η of the own `surface` of a rail or roller, where that gap lies
    /// in a range \[mm\]; `None` as for [`Self::over_plane`].
    pub(super) fn over_surface(
        &self,
        (surface, approach): (&RailArcLength<'_>, f64),
        (sigma, gap): (Interval, Interval),
        eta: Interval,
    ) -> Option<BoxSlopes> {
        let SurfaceBounds { foot, angle, curvature } = self.surface_over(surface, sigma)?;
        let sines = angle.map(f64::sin);
        let cosines = Interval::new(angle.magnitude().cos(), angle.nearest(0.0).cos());
        // The slopes of a body's height along the normals, from those along ζ, and how much longer its own circles are.
        let of_body = |[along, across]: [Interval; 2], angle: Interval, bend: Interval| {
            let own = along.map(f64::atan) + -angle;
            let facing = cosines + along * angle.map(f64::sin);
            let stretch = -bend + 1.0;
            (own.magnitude() < FRAC_PI_2 && facing.low > 0.0)
                .then(|| (own.map(f64::tan) * stretch, across.quotient(facing), facing))
        };
        let none = Interval::of(0.0);
        let (below, [along_below, across_below], growth) = match &self.under {
            Under::Rail(_) => (none, [none; 2], none),
            Under::Roller(roller) => {
                let below = Interval::new(0.0, eta.magnitude().powi(2) / roller.radii.low);
                let SurfaceSlopes { along, across, growth, .. } =
                    roller.slopes_over(foot + below * sines, eta, Torn::No)?;
                let (along, across, facing) = of_body([along, across], -angle, -(below * curvature))?;
                (below, [along, across], growth.quotient(facing))
            }
        };
        let above = gap + -below;
        let over = self.wheel.slopes_over(foot + -(above * sines), eta, Torn::No)?;
        let [sin, cos] = self.wheel.skew;
        let (along, across, facing) = of_body(self.turned(&over), angle, above * curvature)?;
        // Where the gap does not slope along η, the wheel's slope along η is this.
        let level = -(across_below * facing);
        let at_lowest = over.along * (1.0 / cos) + -(level * (sin / cos));
        let lowest =
            of_body([at_lowest, level], angle, above * curvature).map_or(Interval::ALL, |found| found.0);
        // The slope of δ (1 − cos α).
        let rest = along_below + sines * curvature * approach;
        let [along, lowest] = [along, along.cut(lowest)].map(|slopes| slopes + rest);
        let level_at = self.level_at(&over, facing, growth);
        Some(BoxSlopes { along, lowest, across: across + across_below, level_at })
    }

    /// Returns bounds of a rail's or roller's own surface over a range of σ \[mm\].
    fn surface_over(&self, surface: &RailArcLength<'_>, sigma: Interval) -> Option<SurfaceBounds> {
        let foot = Interval::new(surface.point(sigma.low)?.xi, surface.point(sigma.high)?.xi);
        let (slopes, curvature) = match &self.under {
            Under::Rail(tree) => (tree.over(foot)?.slopes, tree.curvatures(foot)),
            // Upside down.
            Under::Roller(roller) => (-roller.tree.over(foot)?.slopes, -roller.tree.curvatures(foot)),
        };
        Some(SurfaceBounds { foot, angle: slopes.map(f64::atan), curvature })
    }

    /// Returns a height \[mm\] as [`Self::least`], from fewer steps.
    pub(super) fn lowest(&self, [xi, foot]: [Interval; 2], eta: Interval) -> f64 {
        let fall = match &self.under {
            Under::Rail(tree) => -tree.heights(foot).high,
            Under::Roller(roller) => roller.lowest(foot, eta),
        };
        self.wheel.lowest(xi, eta) + fall
    }

    /// Returns a height \[mm\] above which the wheel's surface lies over what is below it, all over a box of ξ and η, and a range of ξ of the
    /// profile below: infinite where a body has no surface there.
    pub(super) fn least(&self, [xi, foot]: [Interval; 2], eta: Interval) -> f64 {
        let fall = match &self.under {
            Under::Rail(tree) => -tree.heights(foot).high,
            Under::Roller(roller) => roller.heights(foot, eta).low,
        };
        self.wheel.heights(xi, eta).low + fall
    }

    /// Returns a height \[mm\] below which the wheel's surface lies over what is below it, as [`Self::least`]: −∞ where a body has none.
    pub(super) fn most(&self, [xi, foot]: [Interval; 2], eta: Interval) -> f64 {
        let fall = match &self.under {
            Under::Rail(tree) => -tree.heights(foot).low,
            Under::Roller(roller) => roller.heights(foot, eta).high,
        };
        self.wheel.heights(xi, eta).high + fall
    }

    /// Returns whether the least s of a line is proved to be a convex function of ξ over a box of the tangent plane that holds the lowest
    /// places. Kinks may make it up to `shallow` \[mm\] lower.
    pub(super) fn is_bowl(&self, xi: Interval, eta: Interval, shallow: f64) -> bool {
        self.bends(xi, eta).is_some_and(|bends| bends.is_bowl(shallow))
    }

    fn bends(&self, xi: Interval, eta: Interval) -> Option<BoxBends> {
        let above = self.wheel.bends_over(xi, eta, MOST_FALL)?;
        let below = match &self.under {
            Under::Rail(tree) => {
                let slopes = tree.over(xi)?.slopes;
                let none = Interval::of(0.0);
                let falls = tree.kinks(xi).map(|kink| kink.max(0.0)).sum();
                let along = -tree.bends(xi, slopes);
                slopes.magnitude().is_finite().then_some(BoxBends {
                    along,
                    mixed: none,
                    across: none,
                    falls,
                })?
            }
            Under::Roller(roller) => roller.bends_over(xi, eta, MOST_FALL)?,
        };
        Some(above.plus(&below))
    }

    /// Returns whether every line over a range of ξ \[mm\] has one lowest place at most within a range of η.
    ///
    /// Method: the gap bends along η as both bodies do; what is raised from a rail is straight. At kinks by which the slope along the line
    /// falls by J in all one of two places is lower by J²/2c at most, with `opening` the coefficient c/2 of η² at C; up to `shallow` \[mm\] it
    /// does not count. J is sinχ times the fall at the wheel's kinks, and no more than that at a roller's.
    pub(super) fn is_convex(&self, xi: Interval, eta: Interval, (opening, shallow): (f64, f64)) -> bool {
        let sin = self.wheel.skew[0].abs();
        let most_fall = (4.0 * opening * shallow).sqrt();
        let bends =
            |body: &Round<'_>, most_fall: f64| body.bends_over(xi, eta, most_fall).map(|bends| bends.across);
        let of_wheel = || bends(&self.wheel, most_fall / sin);
        sin == 0.0
            || match &self.under {
                Under::Rail(_) => of_wheel().is_some_and(|across| across.low > 0.0),
                Under::Roller(roller) => of_wheel().is_some_and(|across| {
                    bends(roller, most_fall).is_some_and(|below| (across + below).low > 0.0)
                }),
            }
    }
}
