//! The function of the plane whose negative values are the patch.

pub(super) use super::bounds::BoxSlopes;
use super::bounds::GapBounds;
use super::round::Torn;
use crate::conformal::{NormalGap, Reference};
use crate::numerics::interval::Interval;
use crate::patch::level::{Level, steps};
use crate::patch::raised::Raised;
use crate::placement::{Body, Placement};
use crate::profile::{Section, Side};
use crate::separation::midplane_gap;

/// Kink of a roller's surface \[rad\] at which the gap along its normals steps. A smaller one moves gaps near δ by some roundings.
const KINK: f64 = 1e-11;

/// Most boxes by which lines are proved to pass above the patch.
const MOST_BOXES: usize = 16;

/// G over the tangent plane is s − δ. Over the surface of a rail it is the height of the wheel over the point raised by δ cos α along the
/// normal, over that of a roller t − δ cos α.
#[derive(Debug)]
enum GapOf<'a> {
    Raised(Box<Raised<'a>>),
    Level(Box<Level<'a>>),
}

/// G at a place, and its slopes.
#[derive(Debug, Clone, Copy)]
pub(in crate::patch) struct GapAt {
    /// \[mm\]
    pub(in crate::patch) gap: f64,
    /// Along ξ or σ.
    pub(in crate::patch) along: f64,
    /// Along η.
    pub(in crate::patch) across: f64,
}

/// G of swept bodies with its bounds.
#[derive(Debug)]
pub(in crate::patch) struct PatchGap<'a> {
    placement: &'a Placement,
    of: GapOf<'a>,
    bounds: GapBounds<'a>,
    /// Approach δ \[mm\].
    approach: f64,
    /// Coefficient \[1/mm\] of η² in s at C, without skew.
    pub(super) opening: f64,
}

/// Returns the sections along which a line of constant ξ or σ moves as η grows: the wheel's, and that of a roller.
pub(in crate::patch) fn sections(placement: &Placement) -> [Option<&Section>; 2] {
    [Some(&placement.wheel().section), placement.under().map(|under| &under.wheel().section)]
}

/// Returns the coefficient \[1/mm\] of η² in the gap at C, without skew.
pub(in crate::patch) fn opening(placement: &Placement) -> f64 {
    let around = |body: &Body| body.section.frame.cos / body.axle_distance();
    0.5 * (around(placement.wheel()) + around(placement.rail()))
}

impl<'a> PatchGap<'a> {
    /// Makes the function whose negative values are the patch of a placed pair.
    pub(super) fn new(placement: &'a Placement, approach: f64, reference: Reference) -> Self {
        let on_rail = || {
            let surface = (reference == Reference::Rail).then(|| NormalGap::new(placement).rail().clone());
            GapOf::Raised(Box::new(Raised::new(placement, approach, surface)))
        };
        let on_roller = || GapOf::Level(Box::new(Level::new(placement, approach, reference)));
        Self::with(placement, approach, if placement.under().is_some() { on_roller() } else { on_rail() })
    }

    /// Makes t + δ (1 − cos α) − δ over a rail's or roller's own surface.
    pub(super) fn along_normals(placement: &'a Placement, approach: f64) -> Self {
        let level = Level::new(placement, approach, Reference::Rail);
        Self::with(placement, approach, GapOf::Level(Box::new(level)))
    }

    fn with(placement: &'a Placement, approach: f64, of: GapOf<'a>) -> Self {
        Self { placement, of, bounds: GapBounds::new(placement), approach, opening: opening(placement) }
    }

    /// Returns the raised curve of a rail; `None` on a roller and along normals.
    pub(in crate::patch) fn raised(&self) -> Option<&Raised<'a>> {
        match &self.of {
            GapOf::Raised(raised) => Some(raised),
            GapOf::Level(_) => None,
        }
    }

    /// Returns the gap of which a level bounds the patch; `None` on a rail.
    pub(in crate::patch) fn level(&self) -> Option<&Level<'a>> {
        match &self.of {
            GapOf::Raised(_) => None,
            GapOf::Level(level) => Some(level),
        }
    }

    /// Returns the gap of which a level bounds the patch; `None` on a rail.
    pub(in crate::patch) fn level_mut(&mut self) -> Option<&mut Level<'a>> {
        match &mut self.of {
            GapOf::Raised(_) => None,
            GapOf::Level(level) => Some(level),
        }
    }

    /// Returns the approach δ \[mm\].
    pub(super) fn approach(&self) -> f64 {
        self.approach
    }

    pub(super) fn placement(&self) -> &'a Placement {
        self.placement
    }

    /// Returns the ξ or σ \[mm\] of the profile's point at ξ.
    pub(super) fn sigma(&self, xi: f64) -> f64 {
        self.raised().and_then(|raised| raised.surface.as_ref()).map_or(xi, |surface| surface.sigma(xi))
    }

    /// Returns ξ \[mm\] of the place at ξ or σ, and how fast it changes.
    pub(super) fn xi_and_run(&self, sigma: f64) -> (f64, f64) {
        let raised = self.raised().filter(|raised| raised.surface.is_some());
        raised.map_or((sigma, 1.0), |raised| (raised.xi(sigma), raised.direction(sigma)[0]))
    }

    pub(super) fn is_over_plane(&self) -> bool {
        match &self.of {
            GapOf::Raised(raised) => raised.surface.is_none(),
            GapOf::Level(level) => level.normal_gap().is_none(),
        }
    }

    /// Returns the range of ξ or σ \[mm\] in which both bodies may lie over each other.
    pub(in crate::patch) fn reach(&self) -> Option<Interval> {
        match &self.of {
            GapOf::Level(level) if let Some(gap) = level.normal_gap() => gap.rail().reach(),
            GapOf::Raised(raised) if raised.surface.is_some() => raised.reach(),
            // A skewed or tilted wheel lies over another part of what is below it.
            _ => self.placement.rail().section.reach(),
        }
    }

    /// Whether the lowest place along η may be off η = 0.
    pub(super) fn is_skewed(&self) -> bool {
        self.placement.skew() != 0.0
    }

    /// Returns G \[mm\]; NaN where a body has no surface.
    pub(in crate::patch) fn gap(&mut self, xi: f64, eta: f64) -> f64 {
        if eta == 0.0 && !self.is_skewed() && self.is_over_plane() {
            return midplane_gap(self.placement, xi) - self.approach;
        }
        match &mut self.of {
            GapOf::Raised(raised) => raised.gap(xi, eta),
            GapOf::Level(level) => level.gap(xi, eta) - self.approach,
        }
    }

    /// Returns whether the bodies have surfaces at a place; but along normals at less cost than G.
    pub(super) fn has_surface(&mut self, xi: f64, eta: f64) -> bool {
        match &mut self.of {
            GapOf::Raised(raised) => raised.has_surface(xi, eta),
            GapOf::Level(level) => level.has_surface(xi, eta),
        }
    }

    /// Returns G \[mm\]; infinite where a body has no surface.
    pub(super) fn or_infinite(&mut self, xi: f64, eta: f64) -> f64 {
        let gap = self.gap(xi, eta);
        if gap.is_nan() { f64::INFINITY } else { gap }
    }

    /// Returns a number of roundings of R \[mm\].
    pub(super) fn roundings(&self, count: f64) -> f64 {
        count * f64::EPSILON * self.placement.rolling_radius()
    }

    /// Returns G and its slopes; `None` where a body has no surface.
    pub(in crate::patch) fn at(&mut self, xi: f64, eta: f64) -> Option<GapAt> {
        let at = match &mut self.of {
            GapOf::Raised(raised) => {
                let [gap, along, across] = raised.gap_and_slopes(xi, eta)?;
                GapAt { gap, along, across }
            }
            GapOf::Level(level) => {
                let at = level.at(xi, eta)?;
                GapAt { gap: at.gap - self.approach, along: at.slopes[0], across: at.slopes[1] }
            }
        };
        (!at.gap.is_nan()).then_some(at)
    }

    /// Returns the slope of G along η; NaN where a body has no surface.
    pub(super) fn across(&mut self, xi: f64, eta: f64) -> f64 {
        self.at(xi, eta).map_or(f64::NAN, |at| at.across)
    }

    /// Returns the abscissae \[mm\] of the points of the wheel's and of a roller's profile from which the surfaces at a place are swept;
    /// NaN where there is none.
    pub(in crate::patch) fn abscissae(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        match &mut self.of {
            GapOf::Raised(raised) => [raised.abscissa(xi, eta), f64::NAN],
            GapOf::Level(level) => level.at(xi, eta).map_or([f64::NAN; 2], |at| at.abscissae),
        }
    }

    /// Returns the range of η \[mm\], over all lines of a range of ξ or σ, up to which surfaces are looked at.
    pub(super) fn within(&self, xi: Interval) -> Interval {
        self.bounds.within(self.feet(xi)[0])
    }

    /// Returns bounds of the slopes of G over a box. Along the normals of a surface they hold where G + δ lies in a range \[mm\]. `None`
    /// where a surface ends, steps or stands upright, and far from the midplane.
    pub(super) fn slopes(&self, xi: Interval, eta: Interval, gap: Interval) -> Option<BoxSlopes> {
        match &self.of {
            GapOf::Level(level) if let Some(normal) = level.normal_gap() => {
                self.bounds.over_surface((normal.rail(), self.approach), (xi, gap), eta)
            }
            _ => self.slopes_of_parts(xi, eta, Torn::No),
        }
    }

    /// Returns bounds of the slopes of G over a box that hold for each part of surfaces that end or step in it, continued over all of the box:
    /// where no rim passes through it, one of the parts is its surface. Along normals they are those of [`Self::slopes`], whatever G is.
    pub(super) fn torn_slopes(&self, xi: Interval, eta: Interval) -> Option<BoxSlopes> {
        if self.has_plain_bounds() {
            self.slopes_of_parts(xi, eta, Torn::Allowed)
        } else {
            self.slopes(xi, eta, Interval::ALL)
        }
    }

    /// Returns bounds of the slope of G along a circle over a box that holds it, from those of its height's slope and of dη/dξ; `None` along
    /// normals, and where what faces it ends or steps.
    pub(super) fn along_rim(
        &self,
        (body, slopes): (Side, [Interval; 2]),
        xi: Interval,
        eta: Interval,
    ) -> Option<Interval> {
        let raised = self.raised().filter(|raised| raised.surface.is_some());
        let plain = self.has_plain_bounds();
        plain.then(|| self.bounds.along_rim((body, slopes), (raised, self.approach), (xi, eta)))?
    }

    fn slopes_of_parts(&self, xi: Interval, eta: Interval, torn: Torn) -> Option<BoxSlopes> {
        match &self.of {
            GapOf::Raised(raised) if raised.surface.is_some() => {
                self.bounds.over_raised((raised, self.approach), xi, (eta, torn))
            }
            _ => self.bounds.over_plane(xi, eta, torn),
        }
    }

    /// Returns bounds of the slopes of s over a box of the tangent plane, as [`Self::slopes`].
    pub(super) fn plane_slopes(&self, xi: Interval, eta: Interval) -> Option<BoxSlopes> {
        self.bounds.over_plane(xi, eta, Torn::No)
    }

    /// Whether bounds of slopes hold whatever G is.
    pub(super) fn has_plain_bounds(&self) -> bool {
        !matches!(&self.of, GapOf::Level(level) if level.normal_gap().is_some())
    }

    /// Returns what G \[mm\] is proved not to be below wherever both bodies have a surface over a box, by their heights alone.
    pub(super) fn least(&self, xi: Interval, eta: Interval) -> f64 {
        self.bounds.least(self.feet(xi), eta) - self.approach
    }

    /// Returns whether G is proved to be above 0 wherever both bodies have a surface over a box, by their heights alone.
    pub(super) fn is_high(&self, xi: Interval, eta: Interval) -> bool {
        self.bounds.lowest(self.feet(xi), eta) > self.approach.max(0.0)
    }

    /// Returns whether G is proved to be below 0, or not, wherever both bodies have a surface over a box, by their heights alone. Where it is
    /// below 0, no surface folds back over the box: between two rims it then is all over it, or nowhere.
    pub(super) fn is_all(&self, xi: Interval, eta: Interval, inside: bool) -> bool {
        let feet = self.feet(xi);
        if inside {
            self.bounds.most(feet, eta) < self.lift() && self.bounds.are_open(feet[0], eta)
        } else {
            self.bounds.least(feet, eta) > self.approach.max(0.0)
        }
    }

    /// Returns the least height \[mm\] by which what is below is raised.
    fn lift(&self) -> f64 {
        if self.is_over_plane() { self.approach } else { 0.0 }
    }

    /// As [`Self::is_high`], for parts of the range of η: what stands far aside of the midplane is high above it.
    pub(super) fn is_above(&self, xi: Interval, eta: Interval) -> bool {
        let mut waiting = vec![eta];
        for _ in 0..MOST_BOXES {
            let Some(eta) = waiting.pop() else { return true };
            if !self.is_high(xi, eta) {
                waiting.extend(eta.halves());
            }
        }
        false
    }

    /// Returns whether every line over a range has one lowest place at most within a range of η; of several, others lie up to `shallow`
    /// \[mm\] lower.
    pub(super) fn is_convex(&self, xi: Interval, eta: Interval, shallow: f64) -> bool {
        self.bounds.is_convex(self.feet(xi)[0], eta, (self.opening, shallow))
    }

    /// Returns whether the least s of a line is proved to be a convex function of ξ over a box of the tangent plane that holds the lowest
    /// places. Kinks may make it up to `shallow` \[mm\] lower.
    pub(super) fn is_bowl(&self, xi: Interval, eta: Interval, shallow: f64) -> bool {
        self.bounds.is_bowl(xi, eta, shallow)
    }

    /// Returns the range of ξ \[mm\] in which the wheel may meet what is raised over a range of ξ or σ, and that of the profile below.
    pub(super) fn feet(&self, xi: Interval) -> [Interval; 2] {
        let surface = match &self.of {
            GapOf::Raised(raised) => raised.surface.as_ref(),
            GapOf::Level(level) => level.normal_gap().map(NormalGap::rail),
        };
        let Some(surface) = surface else { return [xi; 2] };
        if let GapOf::Raised(raised) = &self.of {
            let [from, to] = xi.ends().map(|sigma| raised.at(sigma));
            // Where the rail steps, the curve is no longer than the surface below it, or bent by less than its radius.
            let longest = || Interval::between(from.xi(), to.xi()).grown(2.0 * xi.width());
            let over = self.bounds.raised_xi((raised, self.approach), xi).unwrap_or_else(longest);
            return [over, Interval::new(from.foot, to.foot)];
        }
        let foot = xi.map(|sigma| surface.point(sigma).map_or(f64::NAN, |at| at.xi));
        [foot.grown(self.approach.abs()), foot]
    }

    /// Returns the ξ or σ inside a range \[mm\] at which the least gap of lines may step: where a profile steps, and over a surface at its
    /// kinks.
    pub(super) fn torn(&self, over: Interval) -> Vec<f64> {
        match &self.of {
            GapOf::Raised(raised) if raised.surface.is_some() => raised.jumps(over),
            GapOf::Level(level) if let Some(normal) = level.normal_gap() => self.kinks(normal),
            _ => {
                let bodies = [self.placement.rail(), self.placement.wheel()];
                let extent = bodies.map(|body| body.profile().extent()).into_iter().fold(0.0, f64::max);
                bodies.into_iter().flat_map(|body| steps(&body.section, over, extent)).collect()
            }
        }
    }

    /// Returns the σ \[mm\] at which the surface below has kinks.
    fn kinks(&self, normal: &NormalGap<'_>) -> Vec<f64> {
        let section = &self.placement.rail().section;
        let angle = |piece: usize, end: usize| section.end_slope(&section.pieces[piece], end).atan();
        let pieces: Vec<_> = normal.rail().pieces().collect();
        let joints = pieces.windows(2).map(|pair| (pair[1].0.low, [pair[0].1, pair[1].1]));
        // C parts its own piece.
        let kinks = joints.filter(|&(_, [a, b])| a != b && (angle(a, 1) - angle(b, 0)).abs() > KINK);
        kinks.map(|(sigma, _)| sigma).collect()
    }
}
