//! Bounds of the gap and of its slopes over a box of the ξ–η plane, or of the σ–η plane of the rail's surface.
//!
//! A surface of revolution whose profile has the slope T in its own axes has, at the angle v about its axle, in the contact frame with the
//! tilt θ, and with k = T/cos v,
//!
//! ```text
//! a = ∂ζ/∂ξ′ = (k cosθ − sinθ)/(cosθ + k sinθ),   b = ∂ζ/∂η′ = tan v/(cosθ + k sinθ).
//! ```
//!
//! a grows with k. A roller is such a surface upside down.

use std::f64::consts::FRAC_PI_2;

use super::tree::{ProfileBounds, ProfileTree};
use crate::conformal::RailArcLength;
use crate::numerics::direction;
use crate::numerics::interval::Interval;
use crate::patch::in_valleys::circle::FARTHEST_SINE;
use crate::patch::raised::Raised;
use crate::placement::Placement;
use crate::separation::wheel_surface::WheelSurface;

/// Fall of the slope at kinks beyond which second derivatives are not asked for: no gap without a radius below 1 mm is convex to 1e-13 mm.
const MOST_FALL: f64 = 1e-6;

/// Rounding of the places of surfaces, in roundings of the axle distance.
const PLACE_ROUNDINGS: f64 = 64.0;

/// Bounds of the slopes of a gap over a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxSlopes {
    /// Along ξ or σ.
    pub(super) along: Interval,
    /// Along ξ or σ, where the gap does not slope along η. They are narrow where a kink of the wheel is lowest, too.
    pub(super) lowest: Interval,
    /// Along η.
    pub(super) across: Interval,
    /// η \[mm\] of all places in the box at which the gap does not slope along η.
    pub(super) level_at: Interval,
}

/// Bounds of the slopes of a surface over a box.
struct SurfaceSlopes {
    /// Range of ξ \[mm\].
    xi: Interval,
    /// a.
    along: Interval,
    /// b/η′ \[1/mm\].
    growth: Interval,
    /// b.
    across: Interval,
}

/// Bounds of the second derivatives of a gap or a surface over a box \[1/mm\].
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxBends {
    /// Along ξ twice.
    along: Interval,
    /// Along ξ and η.
    mixed: Interval,
    /// Along η twice.
    across: Interval,
    /// Sum of all falls of the slope along ξ at kinks.
    falls: f64,
}

impl BoxBends {
    fn plus(&self, other: &Self) -> Self {
        Self {
            along: self.along + other.along,
            mixed: self.mixed + other.mixed,
            across: self.across + other.across,
            falls: self.falls + other.falls,
        }
    }

    /// Whether the least of a gap over η is proved to be a convex function of ξ, but for kinks that make it `shallow` \[mm\] lower.
    fn is_bowl(&self, shallow: f64) -> bool {
        let least = self.along.low - self.mixed.magnitude().powi(2) / self.across.low;
        self.across.low > 0.0 && least > 0.0 && self.falls.powi(2) <= 2.0 * least * shallow
    }
}

/// The points of a profile from which a box of its surface is swept.
struct SweptBox {
    abscissae: Interval,
    slopes: Interval,
    /// Distances from the axle \[mm\].
    radii: Interval,
    /// η′ \[mm\].
    aside: Interval,
}

/// Bounds of the slopes of a surface over a box in the body's own axes.
struct OwnSlopes {
    /// T.
    own: Interval,
    /// k.
    turned: Interval,
    /// cosθ + k sinθ.
    facing: Interval,
    /// 1/cos v.
    secant: Interval,
}

/// A wheel, or a roller upside down.
#[derive(Debug)]
struct Round<'a> {
    surface: WheelSurface<'a>,
    /// sin χ and cos χ.
    skew: [f64; 2],
    tree: ProfileTree<'a>,
    /// Distances of the profile's points from the axle \[mm\].
    radii: Interval,
}

impl<'a> Round<'a> {
    fn new(placement: &'a Placement) -> Self {
        let surface = WheelSurface::new(placement);
        let tree = ProfileTree::new(surface.section);
        let skew = placement.skew_rotation();
        let mut round = Self { surface, skew: [skew.im, skew.re], tree, radii: Interval::NONE };
        let abscissae = surface.section.reach().unwrap_or(Interval::NONE);
        round.radii = round.radii_of(abscissae, round.tree.heights_around(abscissae));
        round
    }

    /// Returns bounds of the distances from the axle \[mm\] of points from ranges of their abscissae and heights \[mm\].
    fn radii_of(&self, abscissae: Interval, heights: Interval) -> Interval {
        let WheelSurface { axle, sin, cos, .. } = self.surface;
        -(abscissae * sin + heights * cos) + axle
    }

    /// Returns the ranges of ξ′ and η′ \[mm\] of a box of ξ and η.
    fn turned(&self, xi: Interval, eta: Interval) -> [Interval; 2] {
        let [sin, cos] = self.skew;
        [xi * cos + eta * sin, eta * cos + -(xi * sin)]
    }

    /// Returns the range of η \[mm\], over all ξ of a range, up to which surfaces are looked at.
    fn within(&self, xi: Interval) -> Interval {
        let [sin, cos] = self.skew;
        Interval::symmetric((FARTHEST_SINE * self.radii.low - (xi.magnitude() * sin).abs()) / cos)
    }

    /// Returns bounds of the abscissae \[mm\] of the points above a box, from bounds of their distances from the axle.
    fn abscissae(&self, along: Interval, aside: Interval, radii: Interval) -> Interval {
        let rounding = PLACE_ROUNDINGS * f64::EPSILON * self.surface.axle;
        (along + -(sagittae(aside, radii) * self.surface.sin)).grown(rounding)
    }

    /// Returns the profile's points from which the surface over a box is swept; `None` where it ends or steps there, and too far from the
    /// midplane.
    fn feet(&self, xi: Interval, eta: Interval) -> Option<SweptBox> {
        let WheelSurface { sin, cos, .. } = self.surface;
        let [along, aside] = self.turned(xi, eta);
        if self.radii.is_empty() || aside.magnitude() > FARTHEST_SINE * self.radii.low {
            return None;
        }
        // The sagittae of all radii of the wheel may be the widest part of the abscissae.
        let wide = self.abscissae(along, aside, self.radii);
        let near = self.radii.cut(self.radii_of(wide, self.tree.heights_around(wide)));
        let abscissae = self.abscissae(along, aside, near);
        let ProfileBounds { slopes, heights } = self.tree.over(abscissae)?;
        let radii = near.cut(self.radii_of(abscissae, heights));
        let upright = cos - sin * slopes.low <= 0.0 || cos - sin * slopes.high <= 0.0;
        (!upright && slopes.magnitude().is_finite()).then_some(SweptBox { abscissae, slopes, radii, aside })
    }

    /// Returns bounds of the surface's slopes along ξ′ and η′ over a box; `None` as for [`Self::feet`].
    fn slopes_over(&self, xi: Interval, eta: Interval) -> Option<SurfaceSlopes> {
        if self.skew[0] == 0.0 && eta == Interval::of(0.0) {
            // In the midplane they are those of the profile.
            let along = self.tree.over(xi)?.slopes;
            let [growth, across] = [Interval::of(1.0).quotient(self.radii), Interval::of(0.0)];
            return along.magnitude().is_finite().then_some(SurfaceSlopes { xi, along, growth, across });
        }
        let WheelSurface { sin, cos, .. } = self.surface;
        let swept = self.feet(xi, eta)?;
        let OwnSlopes { turned, facing, secant, .. } = self.own_slopes(&swept)?;
        let along = turned.map(|k| (k * cos - sin) / (cos + k * sin));
        let growth = secant.quotient(swept.radii * facing);
        Some(SurfaceSlopes { xi, along, growth, across: growth * swept.aside })
    }

    /// Returns bounds of the slopes of the surface over a box in its own axes; `None` where it may fold back over the contact frame.
    fn own_slopes(&self, SweptBox { slopes, radii, aside, .. }: &SweptBox) -> Option<OwnSlopes> {
        let WheelSurface { sin, cos, .. } = self.surface;
        let own = slopes.map(|m| (m * cos + sin) / (cos - m * sin));
        let secant = |y: f64, r: f64| r / (r * r - y * y).sqrt();
        let secant =
            Interval::new(secant(aside.nearest(0.0), radii.high), secant(aside.magnitude(), radii.low));
        let turned = own * secant;
        let facing = Interval::around(turned.ends().map(|k| cos + k * sin));
        (facing.low > 0.0).then_some(OwnSlopes { own, turned, facing, secant })
    }

    /// Returns bounds of the second derivatives of the surface over a box along ξ and η; `None` as for [`Self::feet`], and where the slope of
    /// the profile falls by more than `most_fall` at kinks.
    ///
    /// Method: with P the radius and c = cos v, f = cosθ + k sinθ, those along ξ′ and η′ are (P T′ + (k sin v)²)/(P c f³),
    /// b (k cosθ − (P T′ − T²) sinθ)/(P c f²) and (1 + b² (cos²θ + (P T′ − T²) sin²θ))/(P c f), and T′ = κ (1 + T²)^{3/2}.
    fn bends_over(&self, xi: Interval, eta: Interval, most_fall: f64) -> Option<BoxBends> {
        let WheelSurface { sin, cos, .. } = self.surface;
        let swept = self.feet(xi, eta)?;
        let OwnSlopes { own, turned, facing, secant } = self.own_slopes(&swept)?;
        let SweptBox { abscissae, radii, aside, .. } = swept;
        let falls: f64 = self.tree.kinks(abscissae).map(|kink| (-kink).max(0.0)).sum();
        if falls > most_fall {
            return None;
        }
        let bend = self.tree.bends(abscissae, own) * radii;
        let (sine, deep) = (aside.quotient(radii), radii.quotient(secant) * facing);
        let (b, level) = (aside.quotient(deep), bend + -own.squared());
        let by = |top: Interval, power: i32| top.quotient(deep * facing.map(|f| f.powi(power)));
        let along = by(bend + (turned * sine).squared(), 2);
        let mixed = by(b * (turned * cos + -(level * sin)), 1);
        let across = by(b.squared() * (level * (sin * sin) + cos * cos) + 1.0, 0);
        let [s, c] = self.skew;
        Some(BoxBends {
            along: along * (c * c) + mixed * (-2.0 * s * c) + across * (s * s),
            mixed: (along + -across) * (s * c) + mixed * (c * c - s * s),
            across: along * (s * s) + mixed * (2.0 * s * c) + across * (c * c),
            falls,
        })
    }

    /// Returns a height \[mm\] in the contact frame that the surface over a box nowhere lies below; infinite where it has none.
    fn lowest(&self, xi: Interval, eta: Interval) -> f64 {
        let [along, aside] = self.turned(xi, eta);
        let rise = sagittae(Interval::of(aside.nearest(0.0)), self.radii).low * self.surface.cos;
        self.tree.heights(self.abscissae(along, aside, self.radii)).low + rise
    }
}

/// Returns bounds of the sagittae \[mm\] at places aside of the midplane, from bounds of the distances from the axle.
fn sagittae(aside: Interval, radii: Interval) -> Interval {
    let sagitta = |y: f64, r: f64| y * y / (r + (r * r - y * y).max(0.0).sqrt());
    Interval::new(sagitta(aside.nearest(0.0), radii.high), sagitta(aside.magnitude(), radii.low))
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
        self.wheel.within(xi)
    }

    /// Returns bounds of the slopes of s over a box; `None` where a surface ends, steps or stands upright, and far from the midplane.
    pub(super) fn over_plane(&self, xi: Interval, eta: Interval) -> Option<BoxSlopes> {
        let [none, one] = [0.0, 1.0].map(Interval::of);
        let below = match &self.under {
            Under::Rail(tree) => {
                let along = -tree.over(xi)?.slopes;
                SurfaceSlopes { xi, along, growth: none, across: none }
            }
            Under::Roller(roller) => roller.slopes_over(xi, eta)?,
        };
        if !below.along.magnitude().is_finite() {
            return None;
        }
        let above = self.wheel.slopes_over(xi, eta)?;
        let [sin, cos] = self.wheel.skew;
        let along = above.along * cos + -(above.across * sin) + below.along;
        let lowest = above.along * (1.0 / cos) + below.across * (sin / cos) + below.along;
        Some(BoxSlopes {
            along,
            lowest: along.cut(lowest),
            across: above.along * sin + above.across * cos + below.across,
            level_at: self.level_at(&above, one, below.growth),
        })
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

    /// Returns bounds of the slopes of the wheel's height over the raised curve of a rail's surface, over a box of σ and η; `None` as for
    /// [`Self::over_plane`].
    pub(super) fn over_raised(
        &self,
        (raised, approach): (&Raised<'_>, f64),
        sigma: Interval,
        eta: Interval,
    ) -> Option<BoxSlopes> {
        let Under::Rail(tree) = &self.under else { return None };
        let [from, to] = sigma.ends().map(|sigma| raised.at(sigma));
        let foot = Interval::new(from.foot, to.foot);
        let slopes = tree.over(foot)?.slopes;
        if !slopes.magnitude().is_finite() {
            return None;
        }
        let [sine, cosine] = [
            slopes.map(|slope| direction(slope)[1]),
            Interval::new(direction(slopes.magnitude())[0], direction(slopes.nearest(0.0))[0]),
        ];
        let turned = tree.curvatures(foot) * approach;
        let run = cosine + -(turned * (cosine.squared() + -sine.squared()));
        let rise = sine + -(turned * sine * cosine * 2.0);
        // The curve runs straight from end to end, or strays by no more than this.
        let stray = if run.low >= 0.0 { 0.0 } else { run.magnitude() * sigma.width() };
        let above = self.wheel.slopes_over(Interval::between(from.xi(), to.xi()).grown(stray), eta)?;
        let [sin, cos] = self.wheel.skew;
        let along = (above.along * cos + -(above.across * sin)) * run + -rise;
        let lowest = above.along * (1.0 / cos) * run + -rise;
        Some(BoxSlopes {
            along,
            lowest: along.cut(lowest),
            across: above.along * sin + above.across * cos,
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
                    roller.slopes_over(foot + below * sines, eta)?;
                let (along, across, facing) = of_body([along, across], -angle, -(below * curvature))?;
                (below, [along, across], growth.quotient(facing))
            }
        };
        let above = gap + -below;
        let over = self.wheel.slopes_over(foot + -(above * sines), eta)?;
        let [sin, cos] = self.wheel.skew;
        let turned = [over.along * cos + -(over.across * sin), over.along * sin + over.across * cos];
        let (along, across, facing) = of_body(turned, angle, above * curvature)?;
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

    /// Returns a height \[mm\] above which the wheel's surface lies over what is below it, all over a box of ξ and η, and a range of ξ of the
    /// profile below: infinite where a body has no surface there.
    pub(super) fn least(&self, [xi, foot]: [Interval; 2], eta: Interval) -> f64 {
        let fall = match &self.under {
            Under::Rail(tree) => -tree.heights(foot).high,
            Under::Roller(roller) => roller.lowest(foot, eta),
        };
        self.wheel.lowest(xi, eta) + fall
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

    /// Returns whether every line of a rail over a range of ξ \[mm\] has one lowest place at most within a range of η.
    ///
    /// Method: what is raised from a rail is straight along η, so that the gap bends as the wheel does. At hollow kinks of J in all one of
    /// two places is lower by (J sinχ)²/2c at most, with `opening` the coefficient c/2 of η² at C; up to `shallow` \[mm\] it does not count.
    pub(super) fn is_convex(&self, xi: Interval, eta: Interval, (opening, shallow): (f64, f64)) -> bool {
        let sin = self.wheel.skew[0].abs();
        let most_fall = (4.0 * opening * shallow).sqrt() / sin;
        sin == 0.0 || self.wheel.bends_over(xi, eta, most_fall).is_some_and(|bends| bends.across.low > 0.0)
    }
}
