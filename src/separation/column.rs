//! The revolved wheel along one ξ-column, in sagitta form.
//!
//! A point at axle distance w = R − z and lateral offset η has the sagitta e = √(w² + η²) − w, and is on the
//! wheel exactly when (x, z − e) is on the profile. In the contact frame, with h(ξ) the midplane height,
//!
//! ```text
//! ζ = h(ξ − e sinθ) + e cosθ,   w = R − z_C − ξ sinθ − ζ cosθ,   u = η² = e (2w + e).
//! ```
//!
//! Given e, ζ and u follow with no iteration; given u, the step e ← u/(w + √(w² + u)) contracts by about e/w.
//! The profile abscissa ξ − e sinθ moves along the column, so that one column can cross joints (erratum 6).

use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::profile::{Branch, BranchPoint, Piece, Section};

/// Steps by which a point is found; each gains some six digits. A branch that needs more is steep there and is left to
/// the bracketed root.
pub(super) const STEPS: usize = 8;

/// A step below so many roundings of w is followed by one that is smaller by e/w and the difference of chord and tangent.
pub(super) const LAST_STEP: f64 = 16.0 * f64::EPSILON;

/// Share of the window's u that a polynomial's nodes must cover; continued that little beyond them, its error grows by some
/// per cent.
pub(super) const NEARLY_COVERED: f64 = 0.9999;

/// A branch that goes on to this many times the sagitta that the window needs is taken to cover it: between
/// there and the end only a profile that falls towards the axle could bring u back.
const FAR_END: f64 = 4.0;

/// The wheel as a surface over the contact frame of its own meridian.
#[derive(Debug, Clone, Copy)]
pub struct WheelSurface<'a> {
    /// The wheel profile in the contact frame.
    pub section: &'a Section,
    /// R − z_C \[mm\].
    pub(super) axle: f64,
    pub(super) cos: f64,
    pub(super) sin: f64,
}

/// The part of a column that lies over one branch of the wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Range of e \[mm\]; the end may be infinite.
    pub e: [f64; 2],
    /// Range of u = η² \[mm²\].
    pub u: [f64; 2],
    /// Index of the branch, and of its piece of the envelope.
    pub branch: usize,
    pub(super) piece: usize,
    /// ζ of the wheel at the beginning \[mm\].
    pub height: f64,
    /// Axle distance w there \[mm\].
    pub w: f64,
    /// The profile point there.
    begin: BranchPoint,
}

/// A point on the wheel above (ξ, u).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Sagitta e \[mm\].
    pub e: f64,
    /// ζ − ζ(begin of span) \[mm\].
    pub rise: f64,
    /// Axle distance w \[mm\].
    pub w: f64,
    /// u = η² \[mm²\].
    pub u: f64,
}

impl<'a> WheelSurface<'a> {
    /// The wheel of a placed pair.
    pub fn new(placement: &'a Placement) -> Self {
        let station = placement.wheel.section.frame;
        let axle = placement.rolling_radius();
        Self { section: &placement.wheel.section, axle, cos: station.cos, sin: station.sin }
    }

    fn branch(&self, span: &Span) -> &'a Branch {
        &self.section.branches[span.branch]
    }

    /// The spans of the column at ξ from η = 0 until u reaches `u_max`, in order of u; `spans` is overwritten.
    /// Empty where the wheel has no surface.
    pub fn spans(&self, xi: f64, u_max: f64, spans: &mut Vec<Span>) {
        spans.clear();
        let pieces = &self.section.pieces;
        let Some(mut index) = self.first_piece(xi) else { return };
        loop {
            let piece = &pieces[index];
            let [near, far] = self.sides().map(|side| piece.xi[side]);
            let begin = if self.sin == 0.0 { 0.0 } else { ((xi - near) / self.sin).max(0.0) };
            let end = if self.sin == 0.0 { f64::INFINITY } else { (xi - far) / self.sin };
            if self.sin == 0.0 && !(piece.xi[0] <= xi && xi <= piece.xi[1]) {
                return;
            }
            let mut span = self.span(xi, index, [begin, end], u_max);
            if let Some(last) = spans.last().filter(|last| last.e[1] == begin) {
                // One joint: the ranges meet, whatever rounding makes of them.
                span.u[0] = last.u[1];
            }
            // Near the axle's height u may fall along the column: such a span holds nothing.
            span.u[1] = span.u[1].max(span.u[0]);
            let done = span.u[1] >= u_max || self.sin == 0.0;
            if span.u[0] <= u_max {
                spans.push(span);
            }
            match self.next_piece(index) {
                Some(next) if !done => index = next,
                _ => return,
            }
        }
    }

    /// Index of the piece over which the column at ξ begins, or would if there were no gap.
    pub(super) fn first_piece(&self, xi: f64) -> Option<usize> {
        let pieces = &self.section.pieces;
        if self.sin > 0.0 {
            let before = pieces.partition_point(|p| p.xi[0] < xi).checked_sub(1);
            return before.or((self.at_end(xi) == Some(0)).then_some(0));
        }
        let index = pieces.partition_point(|p| p.xi[1] <= xi);
        Some(index).filter(|&i| i < pieces.len()).or(self.at_end(xi))
    }

    /// Index of the piece that a column passes next.
    pub(super) fn next_piece(&self, index: usize) -> Option<usize> {
        if self.sin > 0.0 {
            index.checked_sub(1)
        } else {
            Some(index + 1).filter(|&i| i < self.section.pieces.len())
        }
    }

    /// The end piece that has ξ for its outer end.
    fn at_end(&self, xi: f64) -> Option<usize> {
        let pieces = &self.section.pieces;
        let last = pieces.len().checked_sub(1)?;
        if pieces[0].xi[0] == xi { Some(0) } else { (pieces[last].xi[1] == xi).then_some(last) }
    }

    /// The ends of a piece by which a column enters and leaves it.
    pub(super) fn sides(&self) -> [usize; 2] {
        if self.sin > 0.0 { [1, 0] } else { [0, 1] }
    }

    /// The span over one piece between two sagittae.
    fn span(&self, xi: f64, index: usize, e: [f64; 2], u_max: f64) -> Span {
        let (piece, near) = (&self.section.pieces[index], self.sides()[0]);
        let (begin, on_profile) =
            if e[0] > 0.0 { piece.ends[near] } else { self.section.branches[piece.branch].point(xi) };
        let height = on_profile + e[0] * self.cos;
        let w = self.axle_distance(xi, height);
        let u0 = e[0] * (2.0 * w + e[0]);
        let span = Span { e, u: [u0, f64::INFINITY], branch: piece.branch, piece: index, height, w, begin };
        if e[1] > FAR_END * u_max / (2.0 * w) && w > 0.0 {
            return span;
        }
        let [_, u1] = self.leaves(xi, piece);
        // Where the ring of the column closes before the profile's end, that is never met.
        let e1 = if u1.is_finite() { e[1] } else { f64::INFINITY };
        Span { e: [e[0], e1], u: [u0, u1], ..span }
    }

    /// e \[mm\] and u \[mm²\] at which the column at ξ leaves a piece; u is infinite where that is beyond the axle's height.
    #[inline(always)]
    pub(super) fn leaves(&self, xi: f64, piece: &Piece) -> [f64; 2] {
        let far = self.sides()[1];
        let e = if self.sin == 0.0 { f64::INFINITY } else { (xi - piece.xi[far]) / self.sin };
        let w = self.axle_distance(xi, piece.ends[far].1 + e * self.cos);
        [e, if w > 0.0 { e * (2.0 * w + e) } else { f64::INFINITY }]
    }

    /// w \[mm\] of a point of the column at ξ with this ζ.
    #[inline(always)]
    pub(super) fn axle_distance(&self, xi: f64, height: f64) -> f64 {
        self.axle - xi * self.sin - height * self.cos
    }

    /// The point with sagitta e over a span: no iteration.
    #[inline]
    pub fn foot(&self, xi: f64, span: &Span, e: f64) -> Foot {
        let slope = self.branch(span).chord_from(&span.begin, self.abscissa(xi, e));
        let rise = (e - span.e[0]) * (self.cos - self.sin * slope);
        let w = span.w - rise * self.cos;
        Foot { e, rise, w, u: e * (2.0 * w + e) }
    }

    /// A point near u, by the contraction of the sagitta step.
    pub fn foot_near(&self, xi: f64, span: &Span, u: f64) -> Foot {
        let step = |w: f64| self.foot(xi, span, sagitta(w, u).clamp(span.e[0], span.e[1]));
        let mut foot = step(span.w);
        for _ in 0..STEPS {
            if (foot.u - u).abs() <= (1.0 - NEARLY_COVERED) * u {
                break;
            }
            foot = step(foot.w);
        }
        foot
    }

    /// The point at u = η² over a span, or `None` where η is beyond the ring.
    ///
    /// Newton's step on u(e) = e (2w + e) with the chord's slope for the tangent's, which it differs from by e × curvature.
    pub fn foot_at(&self, xi: f64, span: &Span, u: f64) -> Option<Foot> {
        let mut foot = self.foot(xi, span, sagitta(span.w, u));
        let mut last = foot.e;
        for _ in 0..STEPS {
            let run = foot.e - span.e[0];
            let fall = if run == 0.0 { 0.0 } else { self.cos * foot.rise / run };
            let e = foot.e - (foot.u - u) / (2.0 * (foot.w + foot.e * (1.0 - fall)));
            let change = (e - foot.e).abs();
            foot = self.foot(xi, span, e);
            // The steps fall in geometric progression: the next one would be below rounding. The first two may fall faster.
            if change * change <= f64::EPSILON * e * last && change <= LAST_STEP * foot.w {
                return Some(foot).filter(|foot| foot.w > 0.0);
            }
            last = change;
        }
        let end = if span.e[1].is_finite() { span.e[1] } else { self.axle };
        let root = bracketed(|e| self.foot(xi, span, e).u - u, span.e[0], end)?;
        Some(self.foot(xi, span, root)).filter(|foot| foot.w > 0.0)
    }

    /// The point that lies `rise` above the span's beginning: e = e_0 + rise/(cosθ − sinθ × chord slope), a
    /// contraction by e × curvature.
    pub fn foot_with_rise(&self, xi: f64, span: &Span, rise: f64, contractions: usize) -> Foot {
        let mut foot = self.foot(xi, span, span.e[0]);
        for _ in 0..contractions {
            let slope = self.branch(span).chord_from(&span.begin, self.abscissa(xi, foot.e));
            let e = (span.e[0] + rise / (self.cos - self.sin * slope)).min(span.e[1]);
            let change = (e - foot.e).abs();
            foot = self.foot(xi, span, e);
            if change <= f64::EPSILON * e {
                return foot;
            }
        }
        let end = if span.e[1].is_finite() { span.e[1] } else { self.axle };
        let root = bracketed(|e| self.foot(xi, span, e).rise - rise, span.e[0], end);
        root.map_or(foot, |e| self.foot(xi, span, e))
    }

    /// Profile abscissa ξ − e sinθ under the point with sagitta e.
    pub fn abscissa(&self, xi: f64, e: f64) -> f64 {
        xi - e * self.sin
    }

    /// q(ξ, 0) = (cosθ − h′(ξ) sinθ)/2w: how fast the wheel opens with η² \[1/mm\], for a span from η = 0.
    pub fn opening(&self, xi: f64, span: &Span) -> f64 {
        let slope = self.branch(span).chord_from(&span.begin, xi);
        (self.cos - self.sin * slope) / (2.0 * span.w)
    }

    /// Index of the span of a column that holds u, for ascending spans.
    pub fn span_at(spans: &[Span], u: f64) -> Option<usize> {
        let k = spans.iter().position(|span| u <= span.u[1])?;
        (u >= spans[k].u[0]).then_some(k)
    }

    /// Outward unit normal (towards the rail) in (ξ, η, ζ) at the point with sagitta e and offset η.
    pub fn normal(&self, xi: f64, eta: f64, span: &Span, foot: &Foot) -> [f64; 3] {
        let tangent = self.branch(span).station(xi - foot.e * self.sin);
        // Profile angle φ = ψ + θ in the wheel's own axes; the meridian plane is turned by atan(η/w).
        let (sin, cos) = (
            tangent.sin * self.cos + tangent.cos * self.sin,
            tangent.cos * self.cos - tangent.sin * self.sin,
        );
        let rho = foot.w.hypot(eta);
        let (x, y, z) = (sin, cos * eta / rho, -cos * foot.w / rho);
        [x * self.cos + z * self.sin, y, z * self.cos - x * self.sin]
    }
}

/// e = √(w² + u) − w without cancellation.
#[inline]
pub(super) fn sagitta(w: f64, u: f64) -> f64 {
    u / (w + (w * w + u).sqrt())
}
