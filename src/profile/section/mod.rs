//! Profiles seen from a frame: the transformed profile ζ(ξ) of Report (4.4)–(4.8).

mod arc_branch;
mod between;
mod branch;
mod branches;
mod curve;
mod envelope;
mod points;
mod span;
mod turned;

pub use arc_branch::ArcBranch;
pub use between::{parallel_to, stationary_points};
pub use branch::{Branch, BranchShape};
pub use branches::Branches;
pub use curve::PolynomialBranch;
pub use envelope::Piece;
pub use points::{BranchPoint, BranchPoints};
use span::{PolynomialSpan, View};

use std::sync::Arc;

use super::chain::Profile;
use super::closing::ONE_JOINT;
use super::segment::{Segment, Shape};
use super::side::Side;
use super::station::Station;
use crate::numerics::interval::Interval;
use crate::numerics::twice::Twice;

/// A point of a profile as the origin of a frame: eqs. (4.9)–(4.12).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// Point and unit tangent.
    pub station: Station,
    /// Index of the segment. A joint belongs to both neighbours; this is the left one.
    pub segment: usize,
    /// Parameter on a polynomial segment; 0 on an arc.
    parameter: Twice,
}

impl ProfilePoint {
    /// Returns the same point of the profile's mirror image under z → −z.
    pub(crate) fn upside_down(&self) -> Self {
        Self { station: self.station.upside_down(), ..*self }
    }
}

/// The part of a profile that faces the other body, as a function ζ(ξ) in a frame.
///
/// All quantities are in the axes of the frame: ξ along its tangent, ζ along its normal \[mm\]. The profile may overhang in
/// ξ. The outer one of the sheets that face the other body then counts. In the frame of a contact, though, a sheet that begins
/// more than 10 mm in front of the one through C is that of another head, such as a guard rail beside a flangeway: it counts
/// only where the sheet through C has ended. The height is undefined where no sheet faces the other body.
#[derive(Debug, Clone)]
pub struct Section {
    /// The frame, in profile axes.
    pub(crate) frame: Station,
    /// All branches, in the order of the chain.
    pub(crate) branches: Vec<Branch>,
    /// The envelope: the branch that counts over disjoint closed intervals of ascending ξ.
    pub(crate) pieces: Vec<Piece>,
    /// Indices of the pieces before which the envelope has a hole, or changes its height at once by more than rounding.
    pub(crate) steps: Vec<usize>,
    /// What is seen from the frame, and the frame.
    view: Arc<View>,
    /// Index of the branch through the frame's origin, if the frame is that of a contact point.
    pub(crate) contact: Option<usize>,
}

impl Section {
    /// Makes the section of a profile in its own axes.
    pub fn own_axes(profile: &Profile, side: Side) -> Self {
        Self::build(profile, PolynomialSpan::all(profile), Station::AXES, None, side, false)
    }

    /// Makes the section of the same profile in the contact frame of a point of it: its origin is the point, ξ is along the tangent.
    pub(crate) fn at_contact(&self, profile: &Profile, point: &ProfilePoint, side: Side) -> Self {
        Self::build(profile, Arc::clone(&self.view.spans), point.station, Some(point), side, true)
    }

    /// Makes the section of the same profile in the frame of any contact. A contact at a kink needs this, because the common normal
    /// there is not the normal of a tangent.
    pub(crate) fn in_frame(&self, profile: &Profile, frame: Station, side: Side) -> Self {
        Self::build(profile, Arc::clone(&self.view.spans), frame, None, side, true)
    }

    fn build(
        profile: &Profile,
        spans: Arc<[PolynomialSpan]>,
        frame: Station,
        contact: Option<&ProfilePoint>,
        side: Side,
        at_contact: bool,
    ) -> Self {
        let view = Arc::new(View { spans, frame });
        let rounding = ONE_JOINT * (profile.extent() + frame.x.abs() + frame.z.abs());
        let branches = branches(profile, &view, contact, rounding);
        let contact = contact.and_then(|point| branches.iter().position(|b| b.is_contact(point.segment)));
        let pieces = envelope::pieces(&branches, side, at_contact.then_some(rounding));
        let steps = envelope::steps(&pieces, rounding);
        Self { frame, branches, pieces, steps, view, contact }
    }

    /// Returns the branch that counts at ξ, or `None` where the body has no surface. At a joint it is the left branch.
    pub(crate) fn branch_at(&self, xi: f64) -> Option<&Branch> {
        self.piece_at(xi).map(|piece| &self.branches[piece.branch])
    }

    /// Returns the piece of the envelope that holds ξ.
    pub(crate) fn piece_at(&self, xi: f64) -> Option<&Piece> {
        self.pieces_from(xi).first().filter(|piece| piece.xi.low <= xi)
    }

    /// Returns the branch of the envelope at ξ, with bounds of ζ′ over its whole piece.
    pub(crate) fn branch_and_slopes(&self, xi: f64) -> Option<(&Branch, Interval)> {
        let piece = self.pieces.len() - self.pieces_from(xi).len();
        let branch = self.pieces.get(piece).filter(|piece| piece.xi.low <= xi)?.branch;
        Some((&self.branches[branch], self.slopes(piece)))
    }

    /// Returns the pieces of the envelope that do not end before ξ.
    pub(crate) fn pieces_from(&self, xi: f64) -> &[Piece] {
        &self.pieces[self.pieces.partition_point(|piece| piece.xi.high < xi)..]
    }

    /// Returns bounds of ζ′ over a piece of the envelope; infinite where the piece is vertical. They are found once.
    pub(crate) fn slopes(&self, piece: usize) -> Interval {
        let Piece { xi, branch, slopes, .. } = &self.pieces[piece];
        *slopes.get_or_init(|| self.branches[*branch].slope_bounds(*xi))
    }

    /// Returns an end of a piece, 0 the one at smaller ξ, as a point of its branch, and its ζ \[mm\]. The ends are found once.
    pub(crate) fn end(&self, piece: &Piece, end: usize) -> (BranchPoint, f64) {
        let point = |xi| self.branches[piece.branch].point(xi);
        piece.ends.get_or_init(|| Box::new(piece.xi.ends().map(point)))[end]
    }

    /// Returns ζ′ at an end of a piece; infinite where the piece is vertical.
    pub(crate) fn end_slope(&self, piece: &Piece, end: usize) -> f64 {
        self.branches[piece.branch].slope_from(&self.end(piece, end).0)
    }

    /// Returns the intervals of ξ \[mm\] over which the envelope has a hole or changes its height at once; ascending, without its
    /// own ends.
    pub(crate) fn steps(&self) -> Vec<Interval> {
        self.steps.iter().map(|&k| Interval::new(self.pieces[k - 1].xi.high, self.pieces[k].xi.low)).collect()
    }

    /// Returns whether ξ \[mm\] lies on the segment through C, at least `margin` \[mm\] inside the ends of its outer part.
    pub fn on_contact_segment(&self, xi: f64, margin: f64) -> bool {
        self.piece_at(xi)
            .is_some_and(|piece| self.contact == Some(piece.branch) && piece.xi.grown(-margin).contains(xi))
    }

    /// Returns the ends of the envelope's pieces that touch an interval of ξ \[mm\], with their ζ \[mm\], in order of ξ. A
    /// joint of two pieces comes twice.
    pub fn joints(&self, over: Interval) -> impl Iterator<Item = (f64, f64)> {
        let pieces = self.pieces_from(over.low).iter().take_while(move |piece| piece.xi.low <= over.high);
        pieces.flat_map(|piece| [0, 1].map(|end| (piece.xi[end], piece.heights[end])))
    }

    /// Returns ζ(ξ) of (4.5) \[mm\], or NaN where the body has no surface.
    ///
    /// Accuracy: near the origin of a contact frame, a rounding of ζ; elsewhere, a rounding of the profile's extent.
    pub fn height(&self, xi: f64) -> f64 {
        self.branch_at(xi).map_or(f64::NAN, |branch| branch.height(xi))
    }

    /// Returns the smallest and largest ξ with a surface; `None` if there is no surface.
    pub fn reach(&self) -> Option<Interval> {
        Some(Interval::new(self.pieces.first()?.xi.low, self.pieces.last()?.xi.high))
    }

    /// Returns the point of the profile at abscissa x \[mm\], (4.9)–(4.12); the section must be in the profile's own axes.
    /// At a joint the point is on the left segment. Returns `None` where the body has no surface.
    pub fn point(&self, profile: &Profile, x: f64) -> Option<ProfilePoint> {
        Some(Self::point_on(self.branch_at(x)?, profile, x))
    }

    fn point_on(branch: &Branch, profile: &Profile, x: f64) -> ProfilePoint {
        let (station, parameter) = match (&branch.shape, &profile.segments()[branch.segment].shape) {
            (BranchShape::Polynomial(shape), Shape::Polynomial(polynomial)) => {
                let t = shape.exact_parameters(&[x], &[shape.parameter(x)])[0];
                // Neighbours round their joint differently: x may lie a rounding beyond the end of its segment.
                let [low, high] = polynomial.t.ends();
                let t = match t {
                    t if f64::from(t - low) < 0.0 => low.into(),
                    t if f64::from(t - high) > 0.0 => high.into(),
                    t => t,
                };
                (turned::station_at(polynomial, t), t)
            }
            _ => (branch.station(x), Twice::ZERO),
        };
        ProfilePoint { station: Station { x, ..station }, segment: branch.segment, parameter }
    }
}

/// Makes the branches of a profile from left to right. Neighbours that are one surface share the ξ of their joint. A segment without
/// a branch between them does not separate them if it runs over at most `rounding` \[mm\] of ξ.
fn branches(
    profile: &Profile,
    view: &Arc<View>,
    contact: Option<&ProfilePoint>,
    rounding: f64,
) -> Vec<Branch> {
    let frame = &view.frame;
    let mut branches: Vec<Branch> = Vec::with_capacity(profile.segments().len());
    let mut goes_on = false;
    let mut spans = 0..view.spans.len();
    for (index, segment) in profile.segments().iter().enumerate() {
        let here = contact.filter(|point| point.segment == index);
        let first = branches.len();
        let joint = branches.last().filter(|_| goes_on).map(|before| before.xi.high);
        match &segment.shape {
            Shape::Arc(arc) => branches.extend(Branch::of_arc(index, arc, frame, here.is_some())),
            Shape::Polynomial(polynomial) => {
                let Some(span) = spans.next() else { break };
                if here.is_none() && view.spans[span].slopes(frame).is_some() {
                    branches.push(Branch::of_span(index, (view, span), joint));
                    goes_on = true;
                    continue;
                }
                let parameter = here.map(|point| point.parameter);
                branches.extend(Branch::of_polynomial(index, polynomial, (view, span), parameter));
            }
        }
        // Only the first part of a segment may go on from the branch before.
        if let (Some(joint), Some(branch)) = (joint, branches.get_mut(first))
            && branch.begins_segment
        {
            branch.begin_at(joint);
        }
        goes_on = match branches.last().filter(|branch| branch.segment == index) {
            Some(branch) => branch.ends_segment,
            // The segment is vertical to rounding. The surface continues beyond it, whether it has a narrow branch or
            // none.
            None => goes_on && run(segment, frame).abs() <= rounding,
        };
    }
    branches
}

/// Returns the distance \[mm\] in ξ from a segment's start to its end.
fn run(segment: &Segment, frame: &Station) -> f64 {
    segment.end().seen_from(frame).x - segment.start().seen_from(frame).x
}
