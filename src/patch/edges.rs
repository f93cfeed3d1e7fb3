//! Finds both edges of 16 slices at once, where each edge lies over one piece of the wheel.
//!
//! At an edge the wheel stands at ζ = ζ^R(ξ) + δ; over the rail's surface ξ and ζ are those of the raised point. This gives the axle
//! distance w of the edge, and with y = η′ in the wheel's own directions its sagitta e = y²/(w + ϱ), ϱ = √(w² + y²). The foot ξ′ − e sinθ
//! of the edge lies on the profile at the height ζ − e cosθ. With m the slope of the chord from a profile point ξ_0 near the midplane to
//! the foot, and g_0 = h(ξ_0) − ζ,
//!
//! ```text
//! (cosθ − m sinθ)/(w + ϱ) y² + m tanχ y + g_0 + m (ξ/cosχ − ξ_0) = 0,   η = (y + ξ sinχ)/cosχ.
//! ```
//!
//! m, w and ϱ hardly change with y, so that the quadratic equation is solved anew with those of its last solution. It contracts by about e
//! × curvature and tanχ × the turn of the profile, and it is exact at the tips, where y² follows without a difference of large numbers.

use super::raised::RaisedLanes;
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, every, lanes};
use crate::placement::Placement;
use crate::profile::{Branch, Piece, Section};
use crate::separation::contact_gaps;
use crate::separation::wheel_surface::WheelSurface;

/// Most solutions of the quadratic equation; each gains at least three digits away from vertical tangents.
const CONTRACTIONS: usize = 12;

/// Most pieces on which the foot of an edge is sought.
const PIECES: usize = 4;

/// Steepest slope of a piece over which edges are found. The surface folds back where the profile stands up to e/w, some 1e-3.
const STEEPEST: f64 = 64.0;

/// Finds the edges of the slices of a wheel on a rail.
#[derive(Debug)]
pub(super) struct EdgeFinder<'a> {
    rail: &'a Section,
    wheel: WheelSurface<'a>,
    /// cos χ.
    cos: f64,
    /// sin χ.
    sin: f64,
    /// 1/cos χ − 1, to all digits.
    stretch: f64,
    /// Indices of the pieces over which the lower and the upper edge were found last.
    pieces: [Option<usize>; 2],
    arch: pulp::Arch,
}

impl<'a> EdgeFinder<'a> {
    /// Makes the finder of a placed pair on a rail.
    pub(super) fn new(placement: &'a Placement) -> Self {
        let skew = placement.skew_rotation();
        Self {
            rail: &placement.rail().section,
            wheel: WheelSurface::new(placement),
            cos: skew.re,
            sin: skew.im,
            stretch: 2.0 * (placement.skew() / 2.0).sin().powi(2) / skew.re,
            pieces: [None; 2],
            arch: pulp::Arch::new(),
        }
    }

    /// Finds the lower and the upper edges \[mm\] at 16 raised points in the patch, at which s may only rise from one lowest place to
    /// either side. Returns `None` unless the rail has one piece there, each edge lies over one piece of the wheel, which is no wall,
    /// and the wheel has no step on the way.
    pub(super) fn edges(&mut self, at: &RaisedLanes<MANY>) -> Option<[Lanes; 2]> {
        let (rail, wheel) = (self.rail.piece_at(at.foot[MANY / 2])?, self.wheel.section.reach()?);
        let over = |k: usize| rail.xi.contains(at.foot[k]) & wheel.contains(at.xi[k]);
        if !every::<MANY>(over) {
            return None;
        }
        let upper = self.side(at, rail, 1)?;
        let lower: Lanes = if self.sin == 0.0 { lanes(|k| -upper[k]) } else { self.side(at, rail, 0)? };
        every::<MANY>(|k| lower[k] <= upper[k]).then_some([lower, upper])
    }

    /// Finds the lower (0) or the upper (1) edges.
    fn side(&mut self, at: &RaisedLanes<MANY>, rail: &Piece, side: usize) -> Option<Lanes> {
        let section = self.wheel.section;
        let middle = at.lane(MANY / 2);
        let mut index = self.pieces[side].map_or_else(|| index_at(section, middle.xi[0]), Some)?;
        let inside = |index: usize, foot: f64| {
            let Interval { low, high } = section.pieces[index].xi;
            (low <= foot) & (foot <= high)
        };
        for _ in 0..PIECES {
            let [_, [foot]] = self.solved(&middle, rail, index, side)?;
            if inside(index, foot) {
                break;
            }
            index = index_at(section, foot)?;
        }
        self.pieces[side] = Some(index);
        let slopes = section.slopes(index);
        if !(-STEEPEST < slopes.low && slopes.high < STEEPEST) {
            return None;
        }
        let [eta, foot] = self.arch.dispatch(Solve { finder: self, at, rail, index, side })?;
        let passed = |step: &usize| {
            let joint = section.pieces[*step].xi.low;
            let end = section.pieces[*step - 1].xi.high;
            (0..MANY).any(|k| at.xi[k].min(foot[k]) <= joint && end <= at.xi[k].max(foot[k]))
        };
        (every::<MANY>(|k| inside(index, foot[k])) && !section.steps.iter().any(passed)).then_some(eta)
    }

    /// Finds the lower or the upper edges over one piece of the wheel, which is continued beyond its ends if it is an arc: their η, and
    /// the abscissae of their feet \[mm\]. Returns `None` if the solutions do not settle.
    #[inline(always)]
    fn solved<const N: usize>(
        &self,
        at: &RaisedLanes<N>,
        rail: &Piece,
        index: usize,
        side: usize,
    ) -> Option<[Lanes<N>; 2]> {
        let (wheel, xi, outwards) = (&self.wheel, &at.xi, if side == 0 { -1.0 } else { 1.0 });
        let piece = &wheel.section.pieces[index];
        let branch = &wheel.section.branches[piece.branch];
        let begin: Lanes<N> = lanes(|k| piece.xi.nearest(xi[k]));
        let (points, height) = branch.points(&begin)?;
        let (_, rail_height) = self.rail.branches[rail.branch].points(&at.foot)?;
        let gap = self.gaps(at, &begin, rail.branch, (piece.branch, &height), &rail_height)?;
        // ξ′ − ξ_0 for y = 0.
        let shift: Lanes<N> = lanes(|k| (xi[k] - begin[k]) + xi[k] * self.stretch);
        let tangent = self.sin / self.cos;
        let [mut y, mut change, mut settled] = [[0.0; N]; 3];
        let mut slope = branch.chords_from(&points, &begin)?;
        for contraction in 0..CONTRACTIONS {
            let mut foot = [0.0; N];
            for k in 0..N {
                let reached = begin[k] + shift[k] + y[k] * tangent;
                let w = wheel.axle_distance(reached, rail_height[k] + at.lift[k]);
                let sum = w + (w * w + y[k] * y[k]).sqrt();
                let rise = (wheel.cos - wheel.sin * slope[k]) / sum;
                let half = 0.5 * slope[k] * tangent;
                let rest = gap[k] - at.lift[k] + slope[k] * shift[k];
                let root = outwards * (half * half - rise * rest).sqrt();
                let next = (root - half) / rise;
                let step = (next - y[k]).abs();
                let size = next.abs() + (root / rise).abs();
                // The steps fall in geometric progression: the next one would be below rounding.
                let small = (contraction > 0)
                    & (w > 0.0)
                    & (step * step <= f64::EPSILON * size * change[k].min(size));
                settled[k] = if small { 1.0 } else { settled[k] };
                (y[k], change[k]) = (next, step);
                foot[k] = begin[k] + shift[k] + next * tangent - next * next / sum * wheel.sin;
            }
            if every::<N>(|k| settled[k] == 1.0) {
                return Some([lanes(|k| (y[k] + xi[k] * self.sin) / self.cos), foot]);
            }
            slope = branch.chords_from(&points, &foot)?;
        }
        None
    }

    /// Computes how far the wheel's profile at ξ_0 lies above the rail's at the foot of a raised point \[mm\] from both heights, and to full
    /// relative accuracy over both contact segments.
    #[inline(always)]
    fn gaps<const N: usize>(
        &self,
        at: &RaisedLanes<N>,
        begin: &Lanes<N>,
        rail: usize,
        (wheel, height): (usize, &Lanes<N>),
        rail_height: &Lanes<N>,
    ) -> Option<Lanes<N>> {
        let plain: Lanes<N> = lanes(|k| height[k] - rail_height[k]);
        let section = self.wheel.section;
        if self.rail.contact != Some(rail) || section.contact != Some(wheel) {
            return Some(plain);
        }
        let [rail, wheel]: [&Branch; 2] = [&self.rail.branches[rail], &section.branches[wheel]];
        if every::<N>(|k| (at.foot[k] == begin[k]) | (at.foot[k] == at.xi[k])) {
            let exact = contact_gaps(rail, wheel, begin, height)?;
            return Some(lanes(|k| if begin[k] == at.foot[k] { exact[k] } else { plain[k] }));
        }
        if !every::<N>(|k| wheel.xi.contains(at.foot[k])) {
            return Some(plain);
        }
        let (points, height) = wheel.points(&at.foot)?;
        let (exact, slope) =
            (contact_gaps(rail, wheel, &at.foot, &height)?, wheel.chords_from(&points, begin)?);
        Some(lanes(|k| exact[k] + slope[k] * (begin[k] - at.foot[k])))
    }
}

/// Returns the index of the piece that holds ξ, or else of the nearest one.
fn index_at(section: &Section, xi: f64) -> Option<usize> {
    let index = section.pieces.len() - section.pieces_from(xi).len();
    section.pieces.len().checked_sub(1).map(|last| index.min(last)).filter(|_| !xi.is_nan())
}

/// Edges to be found by vector code.
struct Solve<'f, 'a> {
    finder: &'f EdgeFinder<'a>,
    at: &'f RaisedLanes<MANY>,
    rail: &'f Piece,
    index: usize,
    side: usize,
}

impl pulp::WithSimd for Solve<'_, '_> {
    type Output = Option<[Lanes; 2]>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Option<[Lanes; 2]> {
        self.finder.solved(self.at, self.rail, self.index, self.side)
    }
}
