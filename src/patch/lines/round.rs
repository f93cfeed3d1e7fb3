//! Bounds of a surface of revolution, its slopes and second derivatives over a box.
//!
//! A surface of revolution whose profile has the slope T in its own axes has, at the angle v about its axle, in the contact frame with the
//! tilt θ, and with k = T/cos v,
//!
//! ```text
//! a = ∂ζ/∂ξ′ = (k cosθ − sinθ)/(cosθ + k sinθ),   b = ∂ζ/∂η′ = tan v/(cosθ + k sinθ).
//! ```
//!
//! a grows with k. A roller is such a surface upside down.

use super::rims::FARTHEST_SINE;
use super::tree::{ProfileBounds, ProfileTree};
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::separation::wheel_surface::WheelSurface;

/// Most times that bounds of distances from the axle are narrowed by those of the heights: each gains two digits.
const NARROWINGS: usize = 6;

/// Share by which the radii over a box may differ, and with them its sagittae, where the profile is known not to end over it. Beyond it they
/// are narrowed all the same.
const ALIKE: f64 = 0.125;

/// Rounding of the places of surfaces, in roundings of the axle distance.
const PLACE_ROUNDINGS: f64 = 64.0;

/// Whether a surface may end or step in a box over which its slopes are bounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Torn {
    No,
    /// The bounds hold for each of its parts, continued over the whole box.
    Allowed,
}

impl Torn {
    /// Returns bounds over a range of abscissae \[mm\].
    fn over(self, tree: &ProfileTree<'_>, range: Interval) -> Option<ProfileBounds> {
        match self {
            Self::No => tree.over(range),
            Self::Allowed => tree.over_all(range),
        }
    }
}

/// Bounds of the slopes of a surface over a box.
pub(super) struct SurfaceSlopes {
    /// Range of ξ \[mm\].
    pub(super) xi: Interval,
    /// a.
    pub(super) along: Interval,
    /// b/η′ \[1/mm\].
    pub(super) growth: Interval,
    /// b.
    pub(super) across: Interval,
}

/// Bounds of the second derivatives of a gap or a surface over a box \[1/mm\].
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxBends {
    /// Along ξ twice.
    pub(super) along: Interval,
    /// Along ξ and η.
    pub(super) mixed: Interval,
    /// Along η twice.
    pub(super) across: Interval,
    /// Sum of all falls of the slope along ξ at kinks.
    pub(super) falls: f64,
}

impl BoxBends {
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            along: self.along + other.along,
            mixed: self.mixed + other.mixed,
            across: self.across + other.across,
            falls: self.falls + other.falls,
        }
    }

    /// Whether the least of a gap over η is proved to be a convex function of ξ, but for kinks that make it `shallow` \[mm\] lower.
    pub(super) fn is_bowl(&self, shallow: f64) -> bool {
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
pub(super) struct Round<'a> {
    pub(super) surface: WheelSurface<'a>,
    /// sin χ and cos χ.
    pub(super) skew: [f64; 2],
    /// sin v where the abscissae of a line of constant ξ turn; infinite where they do not.
    turning: f64,
    pub(super) tree: ProfileTree<'a>,
    /// Distances of the profile's points from the axle \[mm\].
    pub(super) radii: Interval,
}

impl<'a> Round<'a> {
    pub(super) fn new(placement: &'a Placement) -> Self {
        let surface = WheelSurface::new(placement);
        let tree = ProfileTree::new(surface.section);
        let skew = placement.skew_rotation();
        let turning = skew.im / (skew.re * surface.sin);
        let turning = if surface.sin == 0.0 { f64::INFINITY } else { turning / turning.hypot(1.0) };
        let mut round = Self { surface, skew: [skew.im, skew.re], turning, tree, radii: Interval::NONE };
        let abscissae = surface.section.reach().unwrap_or(Interval::NONE);
        round.radii = round.radii_of(abscissae, round.tree.heights_around(abscissae));
        round
    }

    /// Returns bounds of the distances from the axle \[mm\] of points from ranges of their abscissae and heights \[mm\].
    fn radii_of(&self, abscissae: Interval, heights: Interval) -> Interval {
        let WheelSurface { axle, sin, cos, .. } = self.surface;
        -(abscissae * sin + heights * cos) + axle
    }

    /// Returns the range of η′ \[mm\] of a box of ξ and η.
    fn aside(&self, xi: Interval, eta: Interval) -> Interval {
        let [sin, cos] = self.skew;
        eta * cos + -(xi * sin)
    }

    /// Returns the range of η \[mm\], over all ξ of a range, up to which surfaces are looked at.
    pub(super) fn within(&self, xi: Interval) -> Interval {
        let [sin, cos] = self.skew;
        Interval::symmetric((FARTHEST_SINE * self.radii.low - (xi.magnitude() * sin).abs()) / cos)
    }

    /// Returns bounds of the abscissae \[mm\] of the points above a box, from bounds of their distances from the axle.
    ///
    /// Method: p = ξ cosχ + η sinχ − e sinθ grows with ξ, grows or falls with the distance as sinθ says, and along η turns once, where
    /// tan v = tanχ/sinθ.
    fn abscissae(&self, xi: Interval, eta: Interval, radii: Interval) -> Interval {
        let ([sin, cos], tilt) = (self.skew, self.surface.sin);
        let at = |xi: f64, eta: f64, radius: f64| {
            let y = eta * cos - xi * sin;
            xi * cos + eta * sin - sagittae(Interval::of(y), Interval::of(radius)).low * tilt
        };
        let [least, most] = if tilt < 0.0 { [radii.high, radii.low] } else { radii.ends() };
        let turned =
            |xi: f64, radius: f64| at(xi, eta.nearest((radius * self.turning + xi * sin) / cos), radius);
        let mut low = Interval::around(eta.ends().map(|eta| at(xi.low, eta, least))).low;
        let mut high = Interval::around(eta.ends().map(|eta| at(xi.high, eta, most))).high;
        if (self.radii * self.turning).meets(self.aside(xi, eta)) {
            if tilt < 0.0 {
                low = low.min(turned(xi.low, least));
            } else {
                high = high.max(turned(xi.high, most));
            }
        }
        Interval::new(low, high).grown(self.rounding())
    }

    /// Returns the rounding \[mm\] of the places of points.
    fn rounding(&self) -> f64 {
        PLACE_ROUNDINGS * f64::EPSILON * self.surface.axle
    }

    /// Returns bounds of the abscissae of the points above a box, and of their distances from the axle \[mm\].
    ///
    /// Method: the sagittae of all radii of the wheel may be the widest part of the abscissae, and beside an end of the profile a box has a
    /// surface only if they are as narrow as it is.
    fn narrowed(&self, xi: Interval, eta: Interval) -> (Interval, Interval) {
        let wide = self.abscissae(xi, eta, self.radii);
        let mut radii = self.radii.cut(self.radii_of(wide, self.tree.heights_around(wide)));
        let mut abscissae = self.abscissae(xi, eta, radii);
        for _ in 0..NARROWINGS {
            let alike = radii.width() <= ALIKE * radii.low;
            if radii.is_empty() || (alike && self.tree.is_whole(abscissae)) {
                break;
            }
            radii = radii.cut(self.radii_of(abscissae, self.tree.heights(abscissae)));
            abscissae = self.abscissae(xi, eta, radii);
        }
        if radii.is_empty() { (Interval::NONE, radii) } else { (abscissae, radii) }
    }

    /// Returns the profile's points from which the surface over a box is swept; `None` where it is [`Torn::No`] and ends or steps there, and too
    /// far from the midplane.
    fn feet(&self, xi: Interval, eta: Interval, torn: Torn) -> Option<SweptBox> {
        let WheelSurface { sin, cos, .. } = self.surface;
        let aside = self.aside(xi, eta);
        if self.radii.is_empty() || aside.magnitude() > FARTHEST_SINE * self.radii.low {
            return None;
        }
        let (abscissae, radii) = self.narrowed(xi, eta);
        let ProfileBounds { slopes, heights } = torn.over(&self.tree, abscissae)?;
        let radii = radii.cut(self.radii_of(abscissae, heights));
        let upright = cos - sin * slopes.low <= 0.0 || cos - sin * slopes.high <= 0.0;
        (!upright && slopes.magnitude().is_finite()).then_some(SweptBox { abscissae, slopes, radii, aside })
    }

    /// Returns bounds of the surface's slopes along ξ′ and η′ over a box; `None` as for [`Self::feet`].
    pub(super) fn slopes_over(&self, xi: Interval, eta: Interval, torn: Torn) -> Option<SurfaceSlopes> {
        if self.skew[0] == 0.0 && eta == Interval::of(0.0) {
            // In the midplane they are those of the profile.
            let along = torn.over(&self.tree, xi)?.slopes;
            let [growth, across] = [Interval::of(1.0).quotient(self.radii), Interval::of(0.0)];
            return along.magnitude().is_finite().then_some(SurfaceSlopes { xi, along, growth, across });
        }
        let WheelSurface { sin, cos, .. } = self.surface;
        let swept = self.feet(xi, eta, torn)?;
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

    /// Returns whether the surface is proved not to fold back over the contact frame in a box.
    pub(super) fn is_open(&self, xi: Interval, eta: Interval) -> bool {
        let swept = self.feet(xi, eta, Torn::Allowed);
        swept.is_some_and(|swept| self.own_slopes(&swept).is_some())
    }

    /// Returns bounds of the second derivatives of the surface over a box along ξ and η; `None` as for [`Self::feet`], and where the slope of
    /// the profile falls by more than `most_fall` at kinks.
    ///
    /// Method: with P the radius and c = cos v, f = cosθ + k sinθ, those along ξ′ and η′ are (P T′ + (k sin v)²)/(P c f³),
    /// b (k cosθ − (P T′ − T²) sinθ)/(P c f²) and (1 + b² (cos²θ + (P T′ − T²) sin²θ))/(P c f), and T′ = κ (1 + T²)^{3/2}.
    pub(super) fn bends_over(&self, xi: Interval, eta: Interval, most_fall: f64) -> Option<BoxBends> {
        let WheelSurface { sin, cos, .. } = self.surface;
        let swept = self.feet(xi, eta, Torn::No)?;
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
    pub(super) fn lowest(&self, xi: Interval, eta: Interval) -> f64 {
        let ([sin, cos], WheelSurface { sin: tilt, cos: level, .. }) = (self.skew, self.surface);
        let sagittae = sagittae(self.aside(xi, eta), self.radii);
        let abscissae = xi * cos + eta * sin + -(sagittae * tilt);
        self.tree.heights(abscissae).low + sagittae.low * level
    }

    /// Returns bounds of the heights \[mm\] of the surface over a box in the contact frame: empty where it has none.
    pub(super) fn heights(&self, xi: Interval, eta: Interval) -> Interval {
        let (abscissae, radii) = self.narrowed(xi, eta);
        let heights = self.tree.heights(abscissae);
        if heights.is_empty() {
            return heights;
        }
        let radii = radii.cut(self.radii_of(abscissae, heights));
        heights + sagittae(self.aside(xi, eta), radii) * self.surface.cos
    }
}

/// Returns bounds of the sagittae \[mm\] at places aside of the midplane, from bounds of the distances from the axle.
fn sagittae(aside: Interval, radii: Interval) -> Interval {
    let sagitta = |y: f64, r: f64| y * y / (r + (r * r - y * y).max(0.0).sqrt());
    Interval::new(sagitta(aside.nearest(0.0), radii.high), sagitta(aside.magnitude(), radii.low))
}
