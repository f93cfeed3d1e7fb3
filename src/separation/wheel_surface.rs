//! A body of revolution above as a surface over the contact frame, along columns of constant ξ, in sagitta form.
//!
//! A point at axle distance w = R − z and lateral offset η has the sagitta e = √(w² + η²) − w. It is on the wheel exactly when
//! (x, z − e) is on the profile. In the contact frame, with h(ξ) the midplane height,
//!
//! ```text
//! ζ = h(ξ − e sinθ) + e cosθ,   w = R − z_C − ξ sinθ − ζ cosθ,   u = η² = e (2w + e).
//! ```
//!
//! Given e, both ζ and u follow without iteration. Given u, the step e ← u/(w + √(w² + u)) contracts by about e/w. The
//! profile abscissa ξ − e sinθ moves along the column, so that one column can cross joints (erratum 6). The formulas are
//! written for N columns at once; a single column is N = 1.

use nalgebra::{Unit, UnitComplex, Vector2, Vector3};

use super::span::{SagittaPoint, SagittaPoints, Span, SpanLanes};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, every, lanes};
use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::profile::{Branch, BranchPoints, Branches, Piece, Section, Station};

/// Most steps in which a point is found. Each step gains some six digits; a branch that needs more steps is steep there.
const STEPS: usize = 8;

/// Size of a step, in roundings of w, after which the iteration ends. The next step would be smaller by the factor e/w and
/// the difference of chord and tangent.
const LAST_STEP: f64 = 16.0 * f64::EPSILON;

/// Share of a span's u, up to the end of the window, that the nodes must cover. Beyond them a polynomial is continued, and its error
/// grows by some per cent.
const NEARLY_COVERED: f64 = 0.9999;

/// Multiple of the sagitta that the window needs, up to which a branch must continue to count as covering the window.
/// Beyond it, only a profile that falls towards the axle could make u fall again.
const FAR_END: f64 = 4.0;

/// The wheel as a surface over the contact frame of its own meridian plane.
#[derive(Debug, Clone, Copy)]
pub struct WheelSurface<'a> {
    /// The wheel profile in the contact frame.
    pub section: &'a Section,
    /// Axle distance of C: R − z_C \[mm\].
    pub(crate) axle: f64,
    pub(crate) cos: f64,
    pub(crate) sin: f64,
}

impl<'a> WheelSurface<'a> {
    /// Makes the surface of the wheel of a placed pair.
    pub fn new(placement: &'a Placement) -> Self {
        let station = placement.wheel().section.frame;
        let axle = placement.rolling_radius();
        Self { section: &placement.wheel().section, axle, cos: station.cos, sin: station.sin }
    }

    fn branch(&self, span: &Span) -> &'a Branch {
        &self.section.branches[span.branch]
    }

    /// Finds the spans of the column at ξ from η = 0 until u reaches `u_max` \[mm²\], in order of e. They overwrite
    /// `spans`, which is empty if the wheel has no surface there.
    ///
    /// Behind a step of the envelope a span may begin before the span in front of the step ends: there the earlier span is
    /// the outer one. It may also begin later: between the two the wheel has no surface.
    pub fn spans(&self, xi: f64, u_max: f64, spans: &mut Vec<Span>) {
        spans.clear();
        let pieces = &self.section.pieces;
        let Some(mut index) = self.first_piece(xi) else { return };
        loop {
            let piece = &pieces[index];
            let [near, far] = self.sides().map(|side| piece.xi[side]);
            let begin = if self.sin == 0.0 { 0.0 } else { ((xi - near) / self.sin).max(0.0) };
            let end = if self.sin == 0.0 { f64::INFINITY } else { (xi - far) / self.sin };
            if self.sin == 0.0 && !piece.xi.contains(xi) {
                return;
            }
            let mut span = self.span(xi, index, Interval::new(begin, end), u_max);
            if let Some(last) = spans.last().filter(|last| !self.is_step(last.piece, index)) {
                // Two ranges meet at one joint, in spite of rounding.
                span.u.low = last.u.high;
            }
            // Near the axle's height u may fall along the column. Such a span is empty.
            span.u.high = span.u.high.max(span.u.low);
            let done = span.u.high >= u_max || self.sin == 0.0;
            // What begins beyond the axle's height is no surface.
            if span.u.low <= u_max && span.w > 0.0 {
                spans.push(span);
            }
            match self.next_piece(index) {
                Some(next) if !done => index = next,
                _ => return,
            }
        }
    }

    /// Finds the index of the piece over which the column at ξ begins; in a gap of the profile, that of the piece that the column meets
    /// first.
    pub(super) fn first_piece(&self, xi: f64) -> Option<usize> {
        let pieces = &self.section.pieces;
        if self.sin > 0.0 {
            let before = pieces.partition_point(|p| p.xi.low < xi).checked_sub(1);
            return before.or((self.at_end(xi) == Some(0)).then_some(0));
        }
        let index = pieces.partition_point(|p| p.xi.high <= xi);
        Some(index).filter(|&i| i < pieces.len()).or(self.at_end(xi))
    }

    /// Returns the index of the piece that a column passes next; `None` at the end of the profile.
    pub(super) fn next_piece(&self, index: usize) -> Option<usize> {
        if self.sin > 0.0 {
            index.checked_sub(1)
        } else {
            Some(index + 1).filter(|&i| i < self.section.pieces.len())
        }
    }

    /// Returns whether the envelope has a hole or a step between two neighbouring pieces.
    pub(super) fn is_step(&self, a: usize, b: usize) -> bool {
        self.section.steps.contains(&a.max(b))
    }

    /// Returns the index of the first or last piece whose outer end is ξ.
    fn at_end(&self, xi: f64) -> Option<usize> {
        let pieces = &self.section.pieces;
        let last = pieces.len().checked_sub(1)?;
        if pieces[0].xi.low == xi { Some(0) } else { (pieces[last].xi.high == xi).then_some(last) }
    }

    /// Returns the ends of a piece by which a column enters and leaves it; 0 is the end at smaller ξ.
    pub(super) fn sides(&self) -> [usize; 2] {
        if self.sin > 0.0 { [1, 0] } else { [0, 1] }
    }

    /// Makes the span over one piece between two sagittae \[mm\].
    fn span(&self, xi: f64, index: usize, e: Interval, u_max: f64) -> Span {
        let (piece, near) = (&self.section.pieces[index], self.sides()[0]);
        let branch = &self.section.branches[piece.branch];
        let fold = if e.low > 0.0 { self.fold(xi, branch, e.low, e.high) } else { None };
        let e = Interval { low: fold.unwrap_or(e.low), ..e };
        let (begin, on_profile) = match fold {
            Some(e) => branch.point(self.abscissa(xi, e)),
            None if e.low > 0.0 => self.section.end(piece, near),
            None => branch.point(xi),
        };
        let SpanLanes { height: [height], w: [w], u: [[u0], _], .. } =
            self.span_from(&[xi], branch, [e.low], (begin, [on_profile]));
        let span = Span {
            e,
            u: Interval::new(u0, f64::INFINITY),
            branch: piece.branch,
            piece: index,
            height,
            w,
            begin,
        };
        if e.high > FAR_END * u_max / (2.0 * w) && w > 0.0 {
            return span;
        }
        let [e1, u1] = self.leaves_or_folds(xi, piece, e.low);
        // If the column leaves the wheel before the profile ends, that end is never met.
        let e1 = if u1.is_finite() { e1 } else { f64::INFINITY };
        Span { e: Interval { high: e1, ..e }, u: Interval::new(u0, u1), ..span }
    }

    /// Makes the spans that begin at points of a branch with these heights \[mm\] and sagittae e_0 \[mm\]. Their ends are
    /// not known yet: e is infinite and u is NaN there.
    #[inline(always)]
    pub(super) fn span_from<const N: usize>(
        &self,
        xi: &Lanes<N>,
        branch: &'a Branch,
        e0: Lanes<N>,
        (points, on_profile): (BranchPoints<N>, Lanes<N>),
    ) -> SpanLanes<'a, N> {
        let height = lanes(|k| on_profile[k] + e0[k] * self.cos);
        let w = lanes(|k| self.axle_distance(xi[k], height[k]));
        let u = [lanes(|k| e0[k] * (2.0 * w[k] + e0[k])), [f64::NAN; N]];
        SpanLanes { branches: Branches::One(branch), points, height, w, e: [e0, [f64::INFINITY; N]], u }
    }

    /// Returns one span as lanes with N = 1.
    #[inline(always)]
    pub(super) fn lane(&self, span: &Span) -> SpanLanes<'a, 1> {
        SpanLanes {
            branches: Branches::One(self.branch(span)),
            points: span.begin,
            height: [span.height],
            w: [span.w],
            e: span.e.ends().map(|e| [e]),
            u: span.u.ends().map(|u| [u]),
        }
    }

    /// Returns e \[mm\] and u \[mm²\] at which the column at ξ leaves a piece. u is infinite beyond the axle's height.
    #[inline(always)]
    pub(super) fn leaves(&self, xi: f64, piece: &Piece) -> [f64; 2] {
        let far = self.sides()[1];
        let e = if self.sin == 0.0 { f64::INFINITY } else { (xi - piece.xi[far]) / self.sin };
        let w = self.axle_distance(xi, piece.heights[far] + e * self.cos);
        [e, if w > 0.0 { e * (2.0 * w + e) } else { f64::INFINITY }]
    }

    /// Returns e \[mm\] and u \[mm²\] at which a column that entered a piece at `e0` \[mm\] leaves it, or folds before. u is infinite
    /// beyond the axle's height.
    pub(super) fn leaves_or_folds(&self, xi: f64, piece: &Piece, e0: f64) -> [f64; 2] {
        let [e1, u1] = self.leaves(xi, piece);
        let branch = &self.section.branches[piece.branch];
        let fold = if u1.is_finite() { self.fold(xi, branch, e1, e0) } else { None };
        let Some(e) = fold else { return [e1, u1] };
        let w = self.axle_distance(xi, branch.height(self.abscissa(xi, e)) + e * self.cos);
        [e, e * (2.0 * w + e)]
    }

    /// Finds the sagitta \[mm\] at which a column over a branch folds, between `from`, which is next to a wall of the profile, and
    /// `to`. From the wall to the fold u falls as the sagitta grows, and the surface faces away. Returns `None` if u grows at `from`. The
    /// wheel must be tilted: without tilt a column stays at one abscissa, and meets no wall.
    fn fold(&self, xi: f64, branch: &Branch, from: f64, to: f64) -> Option<f64> {
        // The branch's station at a parameter, and the sagitta at which the column meets it.
        let met = |parameter: f64| {
            let station = branch.station_and_curvature(parameter).0;
            (station, (xi - station.x) / self.sin)
        };
        // du/de halved, w + e (1 + dw/de), where dw/de = −cosθ dζ/de; times the cosine of the profile, which is 0 at the wall.
        let growth = |parameter: f64| {
            let (Station { z, cos, sin, .. }, e) = met(parameter);
            let w = self.axle_distance(xi, z + e * self.cos);
            (w + e) * cos - e * self.cos * (self.cos * cos - self.sin * sin)
        };
        let [from, to] = [from, to].map(|e| branch.parameter(self.abscissa(xi, e)));
        if growth(from) < 0.0 { bracketed(growth, from, to).map(|parameter| met(parameter).1) } else { None }
    }

    /// Returns w \[mm\] of the point with height ζ = `height` \[mm\] of the column at ξ.
    #[inline(always)]
    pub(crate) fn axle_distance(&self, xi: f64, height: f64) -> f64 {
        self.axle - xi * self.sin - height * self.cos
    }

    /// Finds the point with sagitta e \[mm\] over a span: on an arc or line without iteration, on a polynomial by Newton's steps.
    #[inline]
    pub fn point(&self, xi: f64, span: &Span, e: f64) -> SagittaPoint {
        if e == span.e.low {
            // At a vertical end no chord has a slope.
            return SagittaPoint { e, rise: 0.0, w: span.w, u: span.u.low };
        }
        let nowhere = SagittaPoint { e, rise: f64::NAN, w: f64::NAN, u: f64::NAN };
        self.points(&[xi], &self.lane(span), &[e]).map_or(nowhere, SagittaPoint::from)
    }

    /// Finds the points with sagittae e \[mm\]. Returns `None` if N > 1 and Newton's steps on a polynomial do not settle.
    #[inline(always)]
    fn points<const N: usize>(
        &self,
        xi: &Lanes<N>,
        span: &SpanLanes<'_, N>,
        e: &Lanes<N>,
    ) -> Option<SagittaPoints<N>> {
        let slope = span.branches.chords_from(&span.points, &lanes(|k| self.abscissa(xi[k], e[k])))?;
        let runs = lanes(|k| e[k] - span.e[0][k]);
        let rise = lanes(|k| runs[k] * (self.cos - self.sin * slope[k]));
        Some(self.points_above(span, &runs, rise))
    }

    /// Finds points whose sagittae are about `runs` \[mm\] larger than at the beginning of the span. The runs are not met
    /// exactly, because no root is sought. The results are NaN near a vertical tangent.
    #[inline(always)]
    pub(super) fn points_by<const N: usize>(
        &self,
        span: &SpanLanes<'_, N>,
        runs: &Lanes<N>,
    ) -> SagittaPoints<N> {
        let [climb, stretch] = span.branches.chords_near(&span.points, &lanes(|k| -runs[k] * self.sin));
        let rise = lanes(|k| runs[k] * (self.cos * stretch[k] - self.sin * climb[k]));
        self.points_above(span, &lanes(|k| runs[k] * stretch[k]), rise)
    }

    /// Completes the points that lie `rise` \[mm\] above the beginning of the span and have sagittae larger by `runs`
    /// \[mm\].
    #[inline(always)]
    fn points_above<const N: usize>(
        &self,
        span: &SpanLanes<'_, N>,
        runs: &Lanes<N>,
        rise: Lanes<N>,
    ) -> SagittaPoints<N> {
        let e = lanes(|k| span.e[0][k] + runs[k]);
        let w = lanes(|k| span.w[k] - rise[k] * self.cos);
        let u = lanes(|k| e[k] * (2.0 * w[k] + e[k]));
        // u − u_0 is computed without a difference of nearly equal numbers: w falls by rise cosθ.
        let v = lanes(|k| {
            let [e0, e1] = [span.e[0][k], e[k]];
            runs[k] * (2.0 * w[k] + (e0 + e1)) - 2.0 * e0 * (rise[k] * self.cos)
        });
        SagittaPoints { e, rise, w, u, v }
    }

    /// Finds points near u \[mm²\] by the contraction of the sagitta step, and the runs \[mm\] that [`Self::points_by`]
    /// needs for them. Returns `None` if a point is not found or its axle distance is not positive.
    #[inline(always)]
    pub(super) fn points_near<const N: usize>(
        &self,
        span: &SpanLanes<'_, N>,
        u: &Lanes<N>,
    ) -> Option<(SagittaPoints<N>, Lanes<N>)> {
        let [low, high] = &span.e;
        // The first step treats the profile as level; the next ones add its slope.
        let mut w = lanes(|k| span.w[k] - (sagitta(span.w[k], u[k]) - low[k]) * self.cos * self.cos);
        let mut shrink = [1.0; N];
        for _ in 0..=STEPS {
            let runs: Lanes<N> = lanes(|k| sagitta(w[k], u[k]).max(low[k]).min(high[k]) - low[k]);
            let runs = lanes(|k| runs[k] * shrink[k]);
            let points = self.points_by(span, &runs);
            let near =
                |k: usize| (points.u[k] - u[k]).abs() <= (1.0 - NEARLY_COVERED) * (u[k] - span.u[0][k]);
            if every::<N>(|k| near(k) & (points.w[k] > 0.0)) {
                return Some((points, runs));
            }
            shrink = lanes(|k| runs[k] / (points.e[k] - low[k]));
            w = points.w;
        }
        None
    }

    /// Finds the points at u = η² \[mm²\]. Returns `None` if the steps do not settle. w is not positive if η is beyond the
    /// wheel.
    ///
    /// Method: Newton's step on u(e) = e (2w + e), with the slope of the chord, which differs from that of the tangent by e
    /// × curvature.
    #[inline(always)]
    pub(super) fn points_at<const N: usize>(
        &self,
        xi: &Lanes<N>,
        span: &SpanLanes<'_, N>,
        u: &Lanes<N>,
    ) -> Option<SagittaPoints<N>> {
        let mut points = self.points(xi, span, &lanes(|k| sagitta(span.w[k], u[k])))?;
        let mut last = points.e;
        for _ in 0..STEPS {
            let e = lanes(|k| {
                let run = points.e[k] - span.e[0][k];
                let fall = if run == 0.0 { 0.0 } else { self.cos * points.rise[k] / run };
                points.e[k] - (points.u[k] - u[k]) / (2.0 * (points.w[k] + points.e[k] * (1.0 - fall)))
            });
            let change: Lanes<N> = lanes(|k| (e[k] - points.e[k]).abs());
            points = self.points(xi, span, &e)?;
            // The steps fall in geometric progression: the next one would be below rounding. The first two may fall faster.
            let settled = |k: usize| {
                change[k] * change[k] <= f64::EPSILON * e[k] * last[k] && change[k] <= LAST_STEP * points.w[k]
            };
            if every::<N>(settled) {
                return Some(points);
            }
            last = change;
        }
        None
    }

    /// Finds the point at u = η² \[mm²\] over a span. Returns `None` if η is beyond the wheel.
    ///
    /// Method: Newton's step on u(e) = e (2w + e); if it does not settle, a bracketed root.
    pub fn point_at(&self, xi: f64, span: &Span, u: f64) -> Option<SagittaPoint> {
        let found = self.points_at(&[xi], &self.lane(span), &[u]).map(SagittaPoint::from);
        // Where u turns, steps may leave the span.
        let within = span.e.grown(f64::EPSILON.sqrt() * span.w);
        let point = match found.filter(|point| within.contains(point.e)) {
            Some(point) => point,
            None => {
                // Up to the axle's height no sagitta is longer than η.
                let end = self.end(span).min(u.sqrt());
                self.point(xi, span, bracketed(|e| self.point(xi, span, e).u - u, span.e.low, end)?)
            }
        };
        Some(point).filter(|point| point.w > 0.0)
    }

    /// Returns a sagitta \[mm\] beyond which a span has no point.
    fn end(&self, span: &Span) -> f64 {
        if span.e.high.is_finite() { span.e.high } else { self.axle }
    }

    /// Finds the point that lies `rise` \[mm\] above the beginning of the span.
    ///
    /// Method: at most `contractions` steps e ← e_0 + rise/(cosθ − sinθ × chord slope), which contract by e × curvature;
    /// then a bracketed root. Degenerate case: if there is no root, the result is that of the last step.
    pub fn point_with_rise(&self, xi: f64, span: &Span, rise: f64, contractions: usize) -> SagittaPoint {
        let [begin, end] = span.e.ends();
        let slope = self.branch(span).chord_from(&span.begin, self.abscissa(xi, begin));
        let mut point = self.point(xi, span, (begin + rise / (self.cos - self.sin * slope)).min(end));
        let mut last = f64::INFINITY;
        for _ in 0..contractions {
            if point.e == begin {
                return point;
            }
            // The rise per sagitta is cosθ − sinθ × chord slope.
            let e = (begin + rise * ((point.e - begin) / point.rise)).min(end);
            let change = (e - point.e).abs();
            point = self.point(xi, span, e);
            // The steps fall in geometric progression: the next one would be below rounding.
            if change * change <= f64::EPSILON * e * last.min(e) {
                return point;
            }
            last = change;
        }
        let root = bracketed(|e| self.point(xi, span, e).rise - rise, begin, self.end(span));
        root.map_or(point, |e| self.point(xi, span, e))
    }

    /// Returns the profile abscissa ξ − e sinθ \[mm\] under the point with sagitta e \[mm\].
    #[inline(always)]
    pub fn abscissa(&self, xi: f64, e: f64) -> f64 {
        xi - e * self.sin
    }

    /// Computes dζ/du \[1/mm\], the growth of ζ with η², at the beginning of a span. At η = 0 this is q(ξ, 0) = (cosθ − h′(ξ)
    /// sinθ)/2w. At a vertical end of the profile e stays while w falls.
    pub fn opening(&self, xi: f64, span: &Span) -> f64 {
        let e = span.e.low;
        let rise = self.cos - self.sin * self.branch(span).chord_from(&span.begin, self.abscissa(xi, e));
        if rise.is_infinite() {
            return -1.0 / (2.0 * e * self.cos);
        }
        rise / (2.0 * (span.w + e * (1.0 - self.cos * rise)))
    }

    /// Finds the index of the span that holds u \[mm²\], among the spans of a column in order of e.
    pub fn span_at(spans: &[Span], u: f64) -> Option<usize> {
        let k = spans.iter().position(|span| u <= span.u.high)?;
        (u >= spans[k].u.low).then_some(k)
    }

    /// Computes the outward unit normal (towards the rail) in (ξ, η, ζ) at a point with lateral offset η \[mm\].
    pub fn normal(&self, xi: f64, eta: f64, span: &Span, point: &SagittaPoint) -> Unit<Vector3<f64>> {
        let tangent = self.branch(span).station(self.abscissa(xi, point.e));
        self.normal_at(&tangent, point.w, eta)
    }

    /// Computes the outward unit normal (towards the rail) in (ξ, η, ζ) from the profile's tangent in the contact frame, at an
    /// axle distance w and a lateral offset η \[mm\].
    pub fn normal_at(&self, tangent: &Station, w: f64, eta: f64) -> Unit<Vector3<f64>> {
        // The profile angle is φ = ψ + θ in the wheel's own axes; the meridian plane is turned by atan(η/w).
        let tilt = UnitComplex::from_cos_sin_unchecked(self.cos, self.sin);
        let own = tilt * Vector2::new(tangent.cos, tangent.sin);
        let rho = w.hypot(eta);
        let down = tilt.inverse_transform_vector(&Vector2::new(own.y, -own.x * w / rho));
        Unit::new_unchecked(Vector3::new(down.x, own.x * eta / rho, down.y))
    }
}

/// Computes e = √(w² + u) − w \[mm\] without cancellation.
#[inline]
pub(crate) fn sagitta(w: f64, u: f64) -> f64 {
    u / (w + (w * w + u).sqrt())
}
