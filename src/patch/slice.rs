//! Finds the slices of the patch: the interval of η with s(ξ, η) < δ at one ξ.
//!
//! Without skew the wheel must rise by δ − g(ξ). This gives the sagitta e, and η = ±√(e(2w + e)) takes the place of
//! (7.2)–(7.3). It is exact at the tips, where (7.3) cancels.

use super::by_roots::ByRoots;
use super::by_roots::turns::LeastGap;
use super::by_samples::BySamples;
use super::divided::lines_reenter;
use super::in_valleys::slicer::{InValleys, NEAR_GUESS, newton_from, on_surface};
use super::level::{Level, joints};
use super::raised::RaisedLanes;
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY};
use crate::placement::Placement;
use crate::separation::span::{SagittaPoint, Span};
use crate::separation::wheel_surface::WheelSurface;
use crate::separation::{Evaluator, midplane_gap};

/// Most contractions of the sagitta step; each gains at least three digits away from vertical tangents.
const CONTRACTIONS: usize = 24;

/// Steps to the place of the least t on a valley. Each makes the error of t, which is as the square of that of η, a millionth.
const TO_NEAREST: usize = 2;

/// The interval of η of the patch at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slice {
    /// Lower and upper end \[mm\].
    pub eta: Interval,
}

/// Finds the slices of a placed pair at one approach.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::patch::Slicer;
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let slice = Slicer::new(&placement, 0.05).slice(0.0).expect("inside the patch");
/// assert!((slice.eta.high - f64::sqrt(460.0 * 460.0 - 459.95 * 459.95)).abs() < 1e-11);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug)]
pub struct Slicer<'a> {
    pub(super) placement: &'a Placement,
    wheel: WheelSurface<'a>,
    pub(super) evaluator: Evaluator<'a>,
    spans: Vec<Span>,
    /// The slices of swept bodies on a roller; `None` on a rail.
    pub(super) by_roots: Option<ByRoots<'a>>,
    /// The slices of swept bodies on a rail under a skewed wheel, over the rail's surface, or beyond an end of the wheel; otherwise `None`.
    pub(super) in_valleys: Option<InValleys<'a>>,
    /// The normal gap of these slices over the rail's surface; otherwise `None`.
    normal: Option<Level<'a>>,
    /// The slices that are found from samples; otherwise `None`.
    pub(super) by_samples: Option<BySamples<'a>>,
    approach: f64,
}

impl<'a> Slicer<'a> {
    /// Makes a slicer for approach δ \[mm\].
    pub fn new(placement: &'a Placement, approach: f64) -> Self {
        Self::over(placement, approach, Reference::Plane)
    }

    /// Makes a slicer of the patch over the tangent plane or over the rail's surface, where ξ is σ, and s is t(σ, η) + δ (1 − cos α).
    pub(super) fn over(placement: &'a Placement, approach: f64, reference: Reference) -> Self {
        let level = || Level::new(placement, approach, reference);
        let (sampled, on_roller) = (BySamples::apply_to(placement, approach), placement.under().is_some());
        let on_rail = !sampled && !on_roller;
        let normal = (on_rail && reference == Reference::Rail).then(level);
        let surface = normal.as_ref().and_then(Level::normal_gap).map(|gap| gap.rail().clone());
        let skewed = placement.skew() != 0.0;
        let in_valleys = on_rail && (surface.is_some() || skewed || lines_reenter(placement, approach));
        Self {
            placement,
            wheel: WheelSurface::new(placement),
            evaluator: Evaluator::new(placement),
            spans: Vec::new(),
            by_roots: (on_roller && !sampled).then(|| ByRoots::new(placement, approach, level())).flatten(),
            in_valleys: in_valleys.then(|| InValleys::new(placement, approach, surface)),
            by_samples: sampled.then(|| BySamples::new(placement, approach, level())),
            normal,
            approach,
        }
    }

    /// Returns the gap whose level bounds the patch; `None` where it is s over the tangent plane of swept bodies on a rail.
    fn level(&self) -> Option<&Level<'a>> {
        let of_roots = || self.by_roots.as_ref().map(|by_roots| &by_roots.level);
        self.by_samples
            .as_ref()
            .map(|by_samples| &by_samples.level)
            .or_else(of_roots)
            .or(self.normal.as_ref())
    }

    fn level_mut(&mut self) -> Option<&mut Level<'a>> {
        let of_roots = self.by_roots.as_mut().map(|by_roots| &mut by_roots.level);
        self.by_samples.as_mut().map(|by_samples| &mut by_samples.level).or(of_roots).or(self.normal.as_mut())
    }

    /// Returns whether both edges of the slices around a valley mirror each other.
    pub(super) fn is_mirrored(&self, valley: Option<usize>) -> bool {
        let in_midplane = match (&self.in_valleys, valley) {
            (Some(in_valleys), Some(valley)) => in_valleys.valleys.is_mirrored(valley),
            _ => self.by_samples.is_none(),
        };
        self.placement.skew() == 0.0 && in_midplane
    }

    /// Returns the range of ξ \[mm\] in which both bodies may lie over each other.
    pub(super) fn reach(&self) -> Option<Interval> {
        match self.level().and_then(Level::normal_gap) {
            Some(gap) => gap.rail().reach(),
            None if self.placement.skew() == 0.0 => self.placement.overlap(),
            // A skewed wheel lies over another part of a roller.
            None => self.placement.rail().section.reach(),
        }
    }

    /// Returns the least gaps of a range of ξ inside one of η \[mm\], on a roller; `None` where they are those of two profiles in the midplane,
    /// whose turns have formulas.
    pub(super) fn least_gap(&mut self, over: Interval, window: Interval) -> Option<LeastGap<'_, 'a>> {
        let slices = self.by_roots.as_mut()?;
        (!slices.in_midplane(window)).then_some(LeastGap { slices, over, window })
    }

    /// Returns the ξ inside an interval \[mm\] at which the rail has joints.
    pub(super) fn joints(&self, over: Interval) -> Vec<f64> {
        joints(self.placement, self.level().and_then(Level::normal_gap), over)
    }

    /// Returns whether ξ is the arc length of the rail's surface.
    pub(super) fn is_over_rail(&self) -> bool {
        self.level().and_then(Level::normal_gap).is_some()
    }

    /// Returns whether the patch of swept bodies is where the points of [`Self::raised`] lie in the wheel.
    pub(super) fn is_over_raised(&self) -> bool {
        let on_crown = self.by_roots.is_some() && self.is_over_rail();
        self.by_samples.is_none() && !on_crown
    }

    /// Returns the approach δ \[mm\].
    pub fn approach(&self) -> f64 {
        self.approach
    }

    /// Returns the minimum over η of s(ξ, η) − δ \[mm\]. It is negative inside the patch, zero at its tips, and NaN off the
    /// bodies. Outside a patch from samples it is s − δ at η = 0.
    pub fn depth(&mut self, xi: f64) -> f64 {
        if let Some(by_samples) = &mut self.by_samples {
            let eta = by_samples.lowest(xi, None);
            return by_samples.separation(xi, eta) - self.approach;
        }
        if let Some(by_roots) = &mut self.by_roots {
            return by_roots.depth(xi);
        }
        match &mut self.in_valleys {
            Some(in_valleys) => {
                in_valleys.lowest_valley(xi).map_or(f64::NAN, |valley| in_valleys.depth(valley, xi))
            }
            None => midplane_gap(self.placement, xi) - self.approach,
        }
    }

    /// Returns s − δ at a valley \[mm\]; without a valley that of the midplane.
    pub(super) fn depth_over(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        match (&mut self.in_valleys, valley) {
            (Some(in_valleys), Some(valley)) => in_valleys.depth(valley, xi),
            _ => self.depth(xi),
        }
    }

    /// Returns how far the wheel lies above what bounds the patch at a point \[mm\]: s − δ, or over the rail's surface its height over
    /// the raised point.
    pub(super) fn miss(&mut self, xi: f64, eta: f64) -> f64 {
        match &mut self.in_valleys {
            Some(in_valleys) => in_valleys.raised.gap(xi, eta),
            None => self.separation(xi, eta) - self.approach,
        }
    }

    /// Returns the slope of [`Self::miss`] along ξ.
    pub(super) fn slope_along(&mut self, xi: f64, eta: f64) -> f64 {
        match &mut self.in_valleys {
            Some(in_valleys) => in_valleys.raised.slope_along(xi, eta),
            None => self.gradient(xi, eta)[0],
        }
    }

    /// Returns the interval of η at ξ, or `None` outside the patch. With skew it is the deepest of several intervals. The
    /// interval has no width at a tip. It ends where the wheel's surface ends along η, if that is before s reaches δ.
    ///
    /// Accuracy: |Δη| ≤ (R/η) × the accuracy of s.
    pub fn slice(&mut self, xi: f64) -> Option<Slice> {
        let valley = match &mut self.in_valleys {
            Some(in_valleys) => Some(in_valleys.lowest_valley(xi)?),
            None => None,
        };
        self.edges(xi, valley).map(|edges| Slice { eta: edges.into() })
    }

    /// Returns both ends of the slice at ξ; of slices from valleys, of the one that holds `valley`.
    pub(super) fn edges(&mut self, xi: f64, valley: Option<usize>) -> Option<[f64; 2]> {
        if let Some(by_samples) = &mut self.by_samples {
            return by_samples.edges(xi, valley);
        }
        let by_formula = self.normal.is_none() && self.is_mirrored(valley);
        if let (Some(in_valleys), Some(valley), false) = (&mut self.in_valleys, valley, by_formula) {
            return in_valleys.edges(xi, valley);
        }
        if let Some(by_roots) = &mut self.by_roots {
            return by_roots.edges(xi);
        }
        let edge = self.half(xi)?;
        Some([-edge, edge])
    }

    /// Returns both ends of the slice at ξ \[mm\] by Newton's steps from a guess; of slices from valleys, of the one that holds `valley`.
    /// Returns `None` by the formula without skew, from samples, and unless both settle next to the guess, the gap rises outwards there, and
    /// neither a second valley or ridge nor a step or end of a surface is in the guess or next to it.
    pub(super) fn edges_near(&mut self, xi: f64, valley: Option<usize>, guess: [f64; 2]) -> Option<[f64; 2]> {
        if let Some(in_valleys) = &self.in_valleys {
            let around = Interval::from(guess).grown(NEAR_GUESS * (guess[1] - guess[0]));
            let place = in_valleys.raised.xi(xi);
            if !in_valleys.valleys.is_alone_within(valley?, place, around) {
                return None;
            }
        }
        let upper = self.edge_near(xi, guess, 1)?;
        let lower = if self.is_mirrored(valley) { -upper } else { self.edge_near(xi, guess, 0)? };
        let stepped = self.by_roots.as_mut().is_some_and(|by_roots| by_roots.may_step(xi, [lower, upper]));
        (!stepped).then_some([lower, upper])
    }

    /// Returns one end of the slice at ξ \[mm\] by Newton's steps from a guess of both. `None` by the formula, from samples, and as for
    /// [`newton_from`].
    pub(super) fn edge_near(&mut self, xi: f64, [low, high]: [f64; 2], side: usize) -> Option<f64> {
        let (guess, outward, near) = ([low, high][side], [-1.0, 1.0][side], NEAR_GUESS * (high - low));
        match (&mut self.by_roots, &mut self.in_valleys) {
            (Some(by_roots), _) => newton_from(|eta| by_roots.miss_and_slope(xi, eta), guess, outward, near),
            (None, Some(InValleys { raised, .. })) => {
                newton_from(|eta| raised.gap_and_slope(xi, eta), guess, outward, near)
            }
            (None, None) => None,
        }
    }

    /// Returns the abscissae \[mm\] of the points of the wheel's and of a roller's profile from which the surfaces at a place are swept;
    /// NaN where there is none.
    pub(super) fn abscissae(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        match &mut self.in_valleys {
            Some(in_valleys) => [in_valleys.raised.abscissa(xi, eta), f64::NAN],
            None => {
                self.level_mut().and_then(|level| level.at(xi, eta)).map_or([f64::NAN; 2], |at| at.abscissae)
            }
        }
    }

    /// Returns the points at 16 ξ \[mm\] of a rail, or of a roller over the tangent plane, raised by δ.
    pub(super) fn raised(&self, xi: &Lanes) -> RaisedLanes<MANY> {
        let over_plane = || RaisedLanes::over_plane(xi, self.approach);
        self.in_valleys.as_ref().map_or_else(over_plane, |in_valleys| in_valleys.raised.lanes(xi))
    }

    /// Returns whether s over the tangent plane of a rail rises at every ξ from one lowest place, of slices from valleys that of `valley`,
    /// up to both edges \[mm\].
    pub(super) fn has_one_valley(
        &self,
        xi: &Lanes,
        [low, high]: &[Lanes; 2],
        valley: impl Fn(f64) -> Option<usize>,
    ) -> bool {
        self.in_valleys.as_ref().is_none_or(|InValleys { valleys, raised, .. }| {
            let places = raised.lanes(xi).xi;
            let alone = |k: usize| {
                let eta = Interval::new(low[k], high[k]);
                valley(xi[k]).is_some_and(|valley| valleys.is_alone_within(valley, places[k], eta))
            };
            valleys.is_one_between(Interval::around(places)) || (0..MANY).all(alone)
        })
    }

    /// Returns the upper end of the slice at ξ without skew, or `None` outside the patch.
    fn half(&mut self, xi: f64) -> Option<f64> {
        let depth = self.approach - midplane_gap(self.placement, xi);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        // This is enough for slopes up to 80°. Steeper ones need the whole profile.
        let likely = 16.0 * self.placement.rolling_radius() * depth;
        self.foot_lifted(xi, depth, likely).or_else(|| self.foot_lifted(xi, depth, f64::INFINITY))
    }

    /// Returns the edge at the wheel point that lies `depth` \[mm\] above the midplane point at ξ, or at an earlier point where the
    /// surface ends or steps. Returns `None` if η² would exceed `u_max` \[mm²\], and if the wheel has no midplane point at ξ.
    fn foot_lifted(&mut self, xi: f64, depth: f64, u_max: f64) -> Option<f64> {
        self.wheel.spans(xi, u_max, &mut self.spans);
        let half = |foot: SagittaPoint| foot.u.max(0.0).sqrt();
        let floor = self.spans.first().filter(|span| span.e.low == 0.0)?.height;
        for span in &self.spans {
            let rise = depth - (span.height - floor);
            let end = span.e.high.is_finite().then(|| self.wheel.point(xi, span, span.e.high));
            if end.is_none_or(|end| end.rise >= rise) {
                let foot = self.wheel.point_with_rise(xi, span, rise.max(0.0), CONTRACTIONS);
                return Some(half(foot));
            }
        }
        let last = self.spans.last().filter(|span| span.u.high < u_max)?;
        Some(half(self.wheel.point(xi, last, last.e.high)))
    }

    /// Returns η \[mm\] of the least s at ξ. It is 0 for swept bodies without skew, else the place where s neither rises nor falls
    /// along η, or where a surface ends; NaN where a body has no surface. Outside a patch from samples it is 0.
    pub fn lowest(&mut self, xi: f64) -> f64 {
        if let Some(by_samples) = &mut self.by_samples {
            return by_samples.lowest(xi, None);
        }
        if let Some(by_roots) = &mut self.by_roots {
            return by_roots.lowest(xi);
        }
        let Some(in_valleys) = &mut self.in_valleys else { return 0.0 };
        in_valleys.lowest_valley(xi).map_or(f64::NAN, |valley| in_valleys.spot(valley, xi).eta)
    }

    /// Returns η of a valley at ξ \[mm\]; 0 in the midplane.
    pub(super) fn valley(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        if let Some(by_samples) = &mut self.by_samples {
            return by_samples.lowest(xi, valley);
        }
        if let Some(by_roots) = &mut self.by_roots {
            return by_roots.lowest(xi);
        }
        let places = self.in_valleys.as_ref().zip(valley);
        places.map_or(0.0, |(in_valleys, valley)| in_valleys.spot(valley, xi).eta)
    }

    /// Returns η \[mm\] of the least gap over a valley at ξ; 0 in the midplane.
    ///
    /// Method: over the rail's surface the least t lies where the normal meets the valley, which is δ cos α − t below the raised point.
    pub(super) fn nearest_to_rail(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        let mut eta = self.valley(valley, xi);
        if let (Some(in_valleys), Some(level), Some(valley)) = (&self.in_valleys, &mut self.normal, valley) {
            let steps = if in_valleys.valleys.is_mirrored(valley) { 0 } else { TO_NEAREST };
            for _ in 0..steps {
                let Some(met) = level.met_by_normal(xi, eta) else { break };
                eta = in_valleys.valleys.spot(valley, met).eta;
            }
        }
        eta
    }

    /// Returns \[s, η\] \[mm\]. If rounding ends the surface too early, it returns a place on the surface next to η.
    pub(super) fn on_surface(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        if self.in_valleys.is_some() {
            on_surface(self.placement, eta, |eta| self.separation(xi, eta))
        } else {
            [self.separation(xi, eta), eta]
        }
    }

    /// Returns \[∂s/∂ξ, ∂s/∂η\].
    pub(super) fn gradient(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        match self.level_mut() {
            Some(level) => level.gradient(xi, eta),
            None => self.evaluator.separation_and_gradient(xi, eta).1,
        }
    }

    /// Returns s(ξ, η) \[mm\].
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        match self.level_mut() {
            Some(level) => level.gap(xi, eta),
            None => self.evaluator.separation(xi, eta),
        }
    }

    /// Returns the placed pair.
    pub fn placement(&self) -> &'a Placement {
        self.placement
    }
}
