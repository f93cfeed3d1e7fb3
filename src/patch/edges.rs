//! Finds both edges of 16 slices at once, where each edge lies over one piece of the wheel and, on a roller, one of the roller.
//!
//! With y = η′ in the wheel's own directions, the wheel has the sagitta e = y²/(w + ϱ), ϱ = √(w² + y²), at the axle distance w of the edge,
//! and a roller upside down e_L = η²/(w_L + ϱ_L) likewise. The feet of the edge lie on the profiles at ξ′ − e sinθ and ξ − e_L sinθ_L. With m
//! and m_L the slopes of the chords from profile points b and b_L near the midplane to the feet,
//!
//! ```text
//! h(b) + m (ξ′ − b) + (cosθ − m sinθ) e + h_L(b_L) + m_L (ξ − b_L) + (cosθ_L − m_L sinθ_L) e_L = δ,
//! ξ′ = ξ/cosχ + y tanχ,   η = (y + ξ sinχ)/cosχ.
//! ```
//!
//! On a rail −ζ^R(ξ) stands for the roller's terms; over its surface ξ, ζ and δ are those of the raised point. m, w and ϱ of both bodies hardly
//! change with y, so that the quadratic equation is solved anew with those of its last solution. It contracts by about e × curvature and tanχ ×
//! the turn of the profile, and it is exact at the tips, where y² follows without a difference of large numbers.

use super::raised::RaisedLanes;
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, every, lanes};
use crate::placement::Placement;
use crate::profile::{Branch, BranchPoints, Section};
use crate::separation::contact_gaps;
use crate::separation::wheel_surface::WheelSurface;

/// Most solutions of the quadratic equation; each gains at least three digits away from vertical tangents.
const CONTRACTIONS: usize = 12;

/// Most pairs of pieces on which the feet of an edge are sought.
const PIECES: usize = 4;

/// Steepest slope of a piece over which edges are found. The surface folds back where the profile stands up to e/w, some 1e-3.
const STEEPEST: f64 = 64.0;

/// Finds the edges of the slices of a wheel on a rail or a roller.
#[derive(Debug)]
pub(super) struct EdgeFinder<'a> {
    rail: &'a Section,
    wheel: WheelSurface<'a>,
    /// The roller upside down.
    roller: Option<WheelSurface<'a>>,
    /// cos χ.
    cos: f64,
    /// sin χ.
    sin: f64,
    /// 1/cos χ − 1, to all digits.
    stretch: f64,
    /// Indices of the pieces of the wheel's profile and of that below over which the lower and the upper edge were found last.
    under: [Option<[usize; 2]>; 2],
    arch: pulp::Arch,
}

/// N edges and their feet \[mm\].
struct Edges<const N: usize> {
    eta: Lanes<N>,
    /// Abscissae of the feet on the wheel's profile, and on that below.
    feet: [Lanes<N>; 2],
}

/// Points of one piece of a profile, from which chords are drawn.
struct Base<'a, const N: usize> {
    branch: &'a Branch,
    /// Index of the branch.
    index: usize,
    /// Abscissae \[mm\]: the nearest ones of the piece.
    xi: Lanes<N>,
    points: BranchPoints<N>,
    /// \[mm\]
    height: Lanes<N>,
}

impl<'a, const N: usize> Base<'a, N> {
    #[inline(always)]
    fn new(section: &'a Section, piece: usize, xi: &Lanes<N>) -> Option<Self> {
        let piece = &section.pieces[piece];
        let (branch, xi) = (&section.branches[piece.branch], lanes(|k| piece.xi.nearest(xi[k])));
        let (points, height) = branch.points(&xi)?;
        Some(Self { branch, index: piece.branch, xi, points, height })
    }

    /// Returns the slopes of the chords to other points of the branch.
    #[inline(always)]
    fn chords(&self, to: &Lanes<N>) -> Option<Lanes<N>> {
        self.branch.chords_from(&self.points, to)
    }
}

impl<'a> EdgeFinder<'a> {
    /// Makes the finder of a placed pair.
    pub(super) fn new(placement: &'a Placement) -> Self {
        let skew = placement.skew_rotation();
        Self {
            rail: &placement.rail().section,
            wheel: WheelSurface::new(placement),
            roller: placement.under().map(WheelSurface::new),
            cos: skew.re,
            sin: skew.im,
            stretch: 2.0 * (placement.skew() / 2.0).sin().powi(2) / skew.re,
            under: [None; 2],
            arch: pulp::Arch::new(),
        }
    }

    /// Returns the profile below: the rail's, or the roller's upside down.
    fn below(&self) -> &'a Section {
        self.roller.map_or(self.rail, |roller| roller.section)
    }

    /// Finds the lower and the upper edges \[mm\] at 16 raised points in the patch, at which s may only rise from one lowest place to
    /// either side. Returns `None` unless each edge lies over one piece of either profile, which is no wall, and neither surface has a step
    /// on the way.
    pub(super) fn edges(&mut self, at: &RaisedLanes<MANY>) -> Option<[Lanes; 2]> {
        let [wheel, below] = [self.wheel.section.reach()?, self.below().reach()?];
        if !every::<MANY>(|k| below.contains(at.foot[k]) & wheel.contains(at.xi[k])) {
            return None;
        }
        let upper = self.side(at, 1)?;
        let lower: Lanes = if self.sin == 0.0 { lanes(|k| -upper[k]) } else { self.side(at, 0)? };
        every::<MANY>(|k| lower[k] <= upper[k]).then_some([lower, upper])
    }

    /// Finds the lower (0) or the upper (1) edges.
    fn side(&mut self, at: &RaisedLanes<MANY>, side: usize) -> Option<Lanes> {
        let sections = [self.wheel.section, self.below()];
        let middle = at.lane(MANY / 2);
        let at_midplane = [index_at(sections[0], middle.xi[0])?, index_at(sections[1], middle.foot[0])?];
        let mut under = self.under[side].unwrap_or(at_midplane);
        if self.roller.is_none() {
            under[1] = at_midplane[1];
        }
        let holds = |body: usize, piece: usize, foot: f64| {
            let Interval { low, high } = sections[body].pieces[piece].xi;
            (low <= foot) & (foot <= high)
        };
        for _ in 0..PIECES {
            let feet = self.solved(&middle, under, side)?.feet;
            let before = under;
            for body in 0..2 {
                let [foot] = feet[body];
                if !holds(body, under[body], foot) {
                    under[body] = index_at(sections[body], foot)?;
                }
            }
            if under == before {
                break;
            }
        }
        self.under[side] = Some(under);
        let chords = if self.roller.is_some() { 0..2 } else { 0..1 };
        let slopes =
            chords.map(|body| sections[body].slopes(under[body])).fold(Interval::NONE, Interval::hull);
        if !(-STEEPEST < slopes.low && slopes.high < STEEPEST) {
            return None;
        }
        let Edges { eta, feet } = self.arch.dispatch(Solve { finder: self, at, under, side })?;
        let from = [&at.xi, &at.foot];
        let passed = |body: usize, step: usize| {
            let [end, joint] = [sections[body].pieces[step - 1].xi.high, sections[body].pieces[step].xi.low];
            let over = |k: usize| Interval::between(from[body][k], feet[body][k]);
            (0..MANY).any(|k| over(k).low <= joint && end <= over(k).high)
        };
        let is_alone = |body: usize| {
            every::<MANY>(|k| holds(body, under[body], feet[body][k]))
                && !sections[body].steps.iter().any(|&step| passed(body, step))
        };
        (is_alone(0) && is_alone(1)).then_some(eta)
    }
}

impl EdgeFinder<'_> {
    /// Finds the lower or the upper edges over one piece of either profile, which is continued beyond its ends if it is an arc. Returns
    /// `None` if the solutions do not settle.
    #[inline(always)]
    fn solved<const N: usize>(
        &self,
        at: &RaisedLanes<N>,
        under: [usize; 2],
        side: usize,
    ) -> Option<Edges<N>> {
        let (wheel, xi, outwards) = (&self.wheel, &at.xi, if side == 0 { -1.0 } else { 1.0 });
        let above = Base::new(wheel.section, under[0], xi)?;
        let below = Base::new(self.below(), under[1], &at.foot)?;
        let up = if self.roller.is_some() { -1.0 } else { 1.0 };
        let ground: Lanes<N> = lanes(|k| up * below.height[k]);
        let gap = self.gaps(&above, &below, &ground)?;
        // ξ′ − b and η for y = 0.
        let shift: Lanes<N> = lanes(|k| (xi[k] - above.xi[k]) + xi[k] * self.stretch);
        let aside: Lanes<N> = lanes(|k| xi[k] * self.sin / self.cos);
        let (tangent, secant) = (self.sin / self.cos, 1.0 / self.cos);
        let mut slope = above.chords(&above.xi)?;
        let mut slope_below = if self.roller.is_some() { below.chords(&below.xi)? } else { [0.0; N] };
        // How far the roller's point under the edge lies below its profile at b_L.
        let [mut y, mut change, mut settled, mut fall] = [[0.0; N]; 4];
        for contraction in 0..CONTRACTIONS {
            let mut feet = [[0.0; N], at.foot];
            for k in 0..N {
                let reached = above.xi[k] + shift[k] + y[k] * tangent;
                let w = wheel.axle_distance(reached, ground[k] - fall[k] + at.lift[k]);
                let sum = w + (w * w + y[k] * y[k]).sqrt();
                let rise = (wheel.cos - wheel.sin * slope[k]) / sum;
                let (mut square, mut half) = (rise, 0.5 * slope[k] * tangent);
                let mut rest = gap[k] - at.lift[k] + slope[k] * shift[k];
                let [mut w_below, mut sum_below] = [f64::INFINITY; 2];
                if let Some(roller) = &self.roller {
                    w_below = roller.axle_distance(xi[k], fall[k] - ground[k]);
                    let eta = y[k] * secant + aside[k];
                    sum_below = w_below + (w_below * w_below + eta * eta).sqrt();
                    let rise = (roller.cos - roller.sin * slope_below[k]) / sum_below;
                    square += rise * secant * secant;
                    half += rise * secant * aside[k];
                    rest += rise * aside[k] * aside[k] + slope_below[k] * (xi[k] - below.xi[k]);
                }
                let root = outwards * (half * half - square * rest).sqrt();
                let next = (root - half) / square;
                let step = (next - y[k]).abs();
                let size = next.abs() + (root / square).abs();
                // The steps fall in geometric progression: the next one would be below rounding.
                let small = (contraction > 0)
                    & (w > 0.0)
                    & (w_below > 0.0)
                    & (step * step <= f64::EPSILON * size * change[k].min(size));
                settled[k] = if small { 1.0 } else { settled[k] };
                (y[k], change[k]) = (next, step);
                feet[0][k] = above.xi[k] + shift[k] + next * tangent - next * next / sum * wheel.sin;
                if let Some(roller) = &self.roller {
                    let eta = next * secant + aside[k];
                    let sagitta = eta * eta / sum_below;
                    feet[1][k] = xi[k] - sagitta * roller.sin;
                    fall[k] = slope_below[k] * (feet[1][k] - below.xi[k]) + sagitta * roller.cos;
                }
            }
            if every::<N>(|k| settled[k] == 1.0) {
                return Some(Edges { eta: lanes(|k| (y[k] + xi[k] * self.sin) / self.cos), feet });
            }
            slope = above.chords(&feet[0])?;
            if self.roller.is_some() {
                slope_below = below.chords(&feet[1])?;
            }
        }
        None
    }

    /// Computes how far the wheel's profile at b lies above that below at b_L, whose ζ is `ground` \[mm\]; to full relative accuracy over both
    /// contact segments.
    #[inline(always)]
    fn gaps<const N: usize>(
        &self,
        above: &Base<'_, N>,
        below: &Base<'_, N>,
        ground: &Lanes<N>,
    ) -> Option<Lanes<N>> {
        let plain: Lanes<N> = lanes(|k| above.height[k] - ground[k]);
        let touching =
            (self.wheel.section.contact == Some(above.index)) & (self.below().contact == Some(below.index));
        let Some(rail) = self.rail.contact.filter(|_| touching).map(|index| &self.rail.branches[index])
        else {
            return Some(plain);
        };
        if every::<N>(|k| above.xi[k] == below.xi[k]) {
            return contact_gaps(rail, above.branch, &above.xi, &above.height);
        }
        let is_over = |k: usize| above.branch.xi.contains(below.xi[k]);
        let from: Lanes<N> = lanes(|k| if is_over(k) { below.xi[k] } else { above.xi[k] });
        let (points, height) = above.branch.points(&from)?;
        let exact = contact_gaps(rail, above.branch, &from, &height)?;
        let slope = above.branch.chords_from(&points, &above.xi)?;
        Some(lanes(|k| if is_over(k) { exact[k] + slope[k] * (above.xi[k] - from[k]) } else { plain[k] }))
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
    under: [usize; 2],
    side: usize,
}

impl pulp::WithSimd for Solve<'_, '_> {
    type Output = Option<Edges<MANY>>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        self.finder.solved(self.at, self.under, self.side)
    }
}
