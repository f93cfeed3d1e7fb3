//! Finds the slices of the patch: the interval of η with s(ξ, η) < δ at one ξ.
//!
//! Without skew the wheel must rise by δ − g(ξ). This gives the sagitta e, and η = ±√(e(2w + e)) takes the place of
//! (7.2)–(7.3). It is exact at the tips, where (7.3) cancels.

use super::fibres::{BySamples, Lane, LineSlice};
use super::level::{Level, joints};
use super::lines::Lines;
use super::lines::lanes::{edges_of, line};
use super::lines::least::{least_of, lowest_of, lowest_of_line, lowest_within};
use super::lines::newton::{NEAR_GUESS, newton_from};
use super::lines::open::have_one_slice;
use super::lines::ranges::LeastGap;
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
    /// The lines of swept bodies; `None` where a body varies.
    pub(super) lines: Option<Lines<'a>>,
    /// Those of the normal gap over the rail's surface; otherwise `None`.
    normal: Option<Lines<'a>>,
    /// The slices that are found from samples; otherwise `None`.
    pub(super) by_samples: Option<BySamples<'a>>,
    /// The slices of bands from single lines.
    pub(super) lanes: Vec<Lane>,
    /// Range of η of the window \[mm\].
    window: Interval,
    approach: f64,
}

impl<'a> Slicer<'a> {
    /// Makes a slicer for approach δ \[mm\].
    pub fn new(placement: &'a Placement, approach: f64) -> Self {
        Self::over(placement, approach, (Reference::Plane, Interval::ALL))
    }

    /// Makes a slicer of the patch inside a range of η over the tangent plane or over the rail's surface, where ξ is σ, and s is
    /// t(σ, η) + δ (1 − cos α).
    pub(super) fn over(
        placement: &'a Placement,
        approach: f64,
        (reference, window): (Reference, Interval),
    ) -> Self {
        let sampled = BySamples::apply_to(placement, approach, reference);
        let normal = !sampled && placement.under().is_none() && reference == Reference::Rail;
        let level = || Level::new(placement, approach, reference);
        Self {
            placement,
            wheel: WheelSurface::new(placement),
            evaluator: Evaluator::new(placement),
            spans: Vec::new(),
            lines: (!sampled).then(|| Lines::new(placement, approach, reference)),
            normal: normal.then(|| Lines::along_normals(placement, approach)),
            by_samples: sampled.then(|| BySamples::new(placement, approach, level())),
            lanes: Vec::new(),
            window,
            approach,
        }
    }

    /// Returns the gap whose level bounds the patch; `None` where it is s over the tangent plane of swept bodies on a rail.
    fn level(&self) -> Option<&Level<'a>> {
        let lines = || self.normal.as_ref().or(self.lines.as_ref())?.gap.level();
        self.by_samples.as_ref().map(|by_samples| &by_samples.level).or_else(lines)
    }

    fn level_mut(&mut self) -> Option<&mut Level<'a>> {
        let lines = self.normal.as_mut().or(self.lines.as_mut()).and_then(|lines| lines.gap.level_mut());
        self.by_samples.as_mut().map(|by_samples| &mut by_samples.level).or(lines)
    }

    /// Returns whether both edges of slices mirror each other.
    pub(super) fn is_mirrored(&self, lane: Option<usize>) -> bool {
        self.placement.skew() == 0.0 && lane.is_none() && self.by_samples.is_none()
    }

    /// Returns the gaps of a range of ξ inside one of η \[mm\] whose least on each line bounds the patch; `None` where slices are found from
    /// samples.
    pub(super) fn least_gap(&mut self, over: Interval, window: Interval) -> Option<LeastGap<'_, 'a>> {
        Some(LeastGap { lines: self.lines.as_mut()?, over, window })
    }

    /// Returns ξ or σ \[mm\] of the least s of all lines of a range, inside a window of η; `None` as for [`Self::least_gap`].
    pub(super) fn least_of_all(&mut self, over: Interval, window: Interval) -> Option<f64> {
        let lines = self.normal.as_mut().or(self.lines.as_mut())?;
        LeastGap { lines, over, window }.least_of_all()
    }

    /// Returns the ξ inside an interval \[mm\] at which the rail has joints.
    pub(super) fn joints(&self, over: Interval) -> Vec<f64> {
        joints(self.placement, self.level().and_then(Level::normal_gap), over)
    }

    /// Returns whether ξ is the arc length of the rail's surface.
    pub(super) fn is_over_rail(&self) -> bool {
        self.level().and_then(Level::normal_gap).is_some()
    }

    /// Returns whether what is below is a swept roller.
    pub(super) fn is_on_roller(&self) -> bool {
        self.by_samples.is_none() && self.placement.under().is_some()
    }

    /// Returns whether the patch of swept bodies is where the points of [`Self::raised`] lie in the wheel.
    pub(super) fn is_over_raised(&self) -> bool {
        let on_crown = self.is_on_roller() && self.is_over_rail();
        self.by_samples.is_none() && !on_crown
    }

    /// Returns the approach δ \[mm\].
    pub fn approach(&self) -> f64 {
        self.approach
    }

    /// Returns the minimum over η of s(ξ, η) − δ \[mm\]. It is negative inside the patch, zero at its tips, and NaN off the
    /// bodies. Outside a patch from samples it is s − δ at η = 0.
    pub fn depth(&mut self, xi: f64) -> f64 {
        let lowest = self.lowest(xi);
        self.miss(xi, lowest)
    }

    /// Returns s − δ at the lowest place of the slice of a lane, or of the line \[mm\].
    pub(super) fn depth_over(&mut self, lane: Option<usize>, xi: f64) -> f64 {
        let lowest = self.valley(lane, xi);
        self.miss(xi, lowest)
    }

    /// Returns how far the wheel lies above what bounds the patch at a point \[mm\]: s − δ, or over the rail's surface its height over
    /// the raised point.
    pub(super) fn miss(&mut self, xi: f64, eta: f64) -> f64 {
        match &mut self.lines {
            Some(lines) => lines.gap.gap(xi, eta),
            None => self.separation(xi, eta) - self.approach,
        }
    }

    /// Returns the interval of η at ξ, or `None` outside the patch. With skew it is the deepest of several intervals. The
    /// interval has no width at a tip. It ends where the wheel's surface ends along η, if that is before s reaches δ.
    ///
    /// Accuracy: |Δη| ≤ (R/η) × the accuracy of s.
    pub fn slice(&mut self, xi: f64) -> Option<Slice> {
        let edges = match self.lines.as_mut().filter(|lines| !have_one_slice(lines, Interval::of(xi))) {
            Some(lines) => {
                let slices = line(lines, xi, self.window).slices;
                let depth = |slice: &LineSlice| (lowest_within(lines, xi, slice.eta)[1], slice.eta);
                let depths: Vec<_> = slices.iter().map(depth).collect();
                Some(depths.into_iter().min_by(|p, q| p.0.total_cmp(&q.0))?.1.ends())
            }
            None => self.edges(xi, None),
        };
        edges.map(|edges| Slice { eta: edges.into() })
    }

    /// Returns both ends of the slice at ξ; of single lines, of that of a lane.
    pub(super) fn edges(&mut self, xi: f64, lane: Option<usize>) -> Option<[f64; 2]> {
        let own = lane.and_then(|lane| self.lanes.get(lane));
        if let Some(by_samples) = &mut self.by_samples {
            return by_samples.edges(xi, own);
        }
        if let (Some(lines), Some(lane)) = (&mut self.lines, own) {
            return edges_of(lines, xi, lane, self.window);
        }
        if self.placement.under().is_none() && self.normal.is_none() && self.is_mirrored(lane) {
            let edge = self.half(xi)?;
            return Some([-edge, edge]);
        }
        self.lines.as_mut()?.edges(xi)
    }

    /// Returns both ends of the slice at ξ \[mm\] by Newton's steps from a guess. Returns `None` by the formula without skew, of lanes, from
    /// samples, and unless both settle next to the guess, the gap rises outwards there, and no surface steps in the guess or next to it.
    pub(super) fn edges_near(&mut self, xi: f64, lane: Option<usize>, guess: [f64; 2]) -> Option<[f64; 2]> {
        if lane.is_some() {
            return None;
        }
        let upper = self.edge_near(xi, guess, 1)?;
        let lower = if self.is_mirrored(lane) { -upper } else { self.edge_near(xi, guess, 0)? };
        let stepped = self.lines.as_mut().is_some_and(|lines| lines.may_step(xi, [lower, upper]));
        (!stepped).then_some([lower, upper])
    }

    /// Returns one end of the slice at ξ \[mm\] by Newton's steps from a guess of both. `None` by the formula, from samples, and as for
    /// [`newton_from`].
    pub(super) fn edge_near(&mut self, xi: f64, [low, high]: [f64; 2], side: usize) -> Option<f64> {
        let (guess, outward, near) = ([low, high][side], [-1.0, 1.0][side], NEAR_GUESS * (high - low));
        let lines = self.lines.as_mut()?;
        newton_from(|eta| lines.gap.at(xi, eta).map(|at| [at.gap, at.across]), guess, outward, near)
    }

    /// Returns the abscissae \[mm\] of the points of the wheel's and of a roller's profile from which the surfaces at a place are swept;
    /// NaN where there is none.
    pub(super) fn abscissae(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        self.lines.as_mut().map_or([f64::NAN; 2], |lines| lines.gap.abscissae(xi, eta))
    }

    /// Returns the points at 16 ξ \[mm\] of a rail, or of a roller over the tangent plane, raised by δ.
    pub(super) fn raised(&self, xi: &Lanes) -> RaisedLanes<MANY> {
        let raised = self.lines.as_ref().and_then(|lines| lines.gap.raised());
        raised.map_or_else(|| RaisedLanes::over_plane(xi, self.approach), |raised| raised.lanes(xi))
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
        self.lines.as_mut().map_or(f64::NAN, |lines| {
            let one = have_one_slice(lines, Interval::of(xi));
            if one { lines.lowest(xi, 0.0) } else { lowest_of_line(lines, xi, self.window) }
        })
    }

    /// Returns η \[mm\] of the least gap in the slice of a lane at ξ, or of the line.
    pub(super) fn valley(&mut self, lane: Option<usize>, xi: f64) -> f64 {
        let own = lane.and_then(|lane| self.lanes.get(lane));
        if let Some(by_samples) = &mut self.by_samples {
            return by_samples.lowest(xi, own);
        }
        let Some(lines) = &mut self.lines else { return 0.0 };
        match own {
            Some(lane) => lowest_of(lines, xi, lane, self.window),
            None => lines.lowest(xi, 0.0),
        }
    }

    /// Returns η \[mm\] of the least gap on the line of ξ: over the rail's surface of the least t.
    pub(super) fn nearest_to_rail(&mut self, xi: f64) -> f64 {
        match &mut self.normal {
            Some(lines) => lines.lowest(xi, 0.0),
            None => self.valley(None, xi),
        }
    }

    /// Returns \[s, ξ, η\] of the least s of a lane within the window.
    pub(super) fn least_of(&mut self, lane: usize) -> Option<[f64; 3]> {
        let own = self.lanes.get(lane)?.clone();
        if let Some(by_samples) = &mut self.by_samples {
            let xi = by_samples.least(&own)?;
            let eta = self.window.nearest(by_samples.lowest(xi, Some(&own)));
            return Some([self.separation(xi, eta), xi, eta]);
        }
        let [_, xi, eta] = least_of(self.lines.as_mut()?, &own)?;
        let over = Interval::new(own.rows.first()?.xi, own.rows.last()?.xi);
        let lines = self.normal.as_mut().or(self.lines.as_mut())?;
        let [xi, eta] = LeastGap { lines, over, window: self.window }.least_near([xi, eta]);
        Some([self.separation(xi, eta), xi, eta])
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
