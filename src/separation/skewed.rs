//! Columns of a skewed wheel: s(ξ, ·) as polynomials in η, both parities.
//!
//! Along a column the wheel's own ξ′ = ξ cos χ + η sin χ moves too, so that s is no function of η². Over one branch of the
//! wheel it is analytic in η: it is interpolated from 16 Chebyshev points, and an interval where that fails is halved.
//! Interpolation keeps the accuracy of the interval's largest s; where s is much smaller, near C, it is done anew.

use super::Evaluator;
use super::column::WheelSurface;
use super::columns::{MANY, Row, row};
use super::gap::contact_gap;
use super::horner::{OneRun, per_degree};
use super::spectral::{Demand, MOST_COEFFICIENTS, ROUNDING_LEVEL};
use super::strips::PROOF;
use crate::numerics::chebyshev;
use crate::profile::{BranchPoints, Piece};

/// Below this share of an interval's largest |s|, interpolation would cost more than the promised thirteen relative digits.
const SMALL_SHARE: f64 = 1.0 / 64.0;

/// One column of the grid.
pub(super) struct SkewedColumn<'s, 'a> {
    evaluator: &'s mut Evaluator<'a>,
    arch: pulp::Arch,
    demand: Demand,
    xi: f64,
    /// ζ of the rail \[mm\]; NaN where it has no surface.
    rail_height: f64,
    contact: Option<Contact>,
    /// Largest truncation error so far \[mm\].
    pub error: f64,
}

/// What s is computed from where ξ lies over both contact segments.
#[derive(Debug, Clone, Copy)]
struct Contact {
    /// g(ξ) \[mm\].
    gap: f64,
    /// The wheel's profile point at ξ.
    from: BranchPoints<MANY>,
}

impl<'s, 'a> SkewedColumn<'s, 'a> {
    /// The column at ξ, held to a demand.
    pub fn new(evaluator: &'s mut Evaluator<'a>, arch: pulp::Arch, demand: Demand, xi: f64) -> Self {
        let (rail, wheel) = (&evaluator.placement.rail.section, &evaluator.placement.wheel.section);
        let piece = rail.piece_at(xi);
        let rail_height = piece.map_or(f64::NAN, |piece| rail.branches[piece.branch].height(xi));
        let branches =
            piece.map(|piece| piece.branch).filter(|r| rail.contact == Some(*r)).zip(wheel.contact);
        let contact = branches.and_then(|(r, w)| {
            let (rail, wheel) = (&rail.branches[r], &wheel.branches[w]);
            let (from, height) = wheel.point(xi);
            let inside = wheel.xi[0] <= xi && xi <= wheel.xi[1];
            inside.then(|| Contact { gap: contact_gap(rail, wheel, xi, height), from: wheel.repeated(&from) })
        });
        Self { evaluator, arch, demand, xi, rail_height, contact, error: 0.0 }
    }

    /// s at ascending η.
    pub fn fill(&mut self, eta: &[f64], out: &mut [f64]) {
        if self.rail_height.is_nan() {
            return out.fill(f64::NAN);
        }
        let (Some(&first), Some(&last)) = (eta.first(), eta.last()) else { return };
        let few = eta.len() <= MANY;
        let arch = self.arch;
        let Some(size) = arch.dispatch(Interval { column: self, ends: [first, last], eta, out }) else {
            if few {
                return self.evaluator.column(self.xi, eta, out);
            }
            let (eta, out) = (eta.split_at(eta.len() / 2), out.split_at_mut(eta.len() / 2));
            self.fill(eta.0, out.0);
            return self.fill(eta.1, out.1);
        };
        let is_small = |s: &f64| s.abs() < SMALL_SHARE * size.largest;
        // Between Chebyshev points a parabola falls by less than that share.
        if few || size.least > 2.0 * SMALL_SHARE * size.largest {
            return;
        }
        let (Some(begin), Some(end)) = (out.iter().position(is_small), out.iter().rposition(is_small)) else {
            return;
        };
        let small = begin..end + 1;
        if small.len() <= eta.len() / 2 {
            self.fill(&eta[small.clone()], &mut out[small]);
        } else {
            self.evaluator.column(self.xi, &eta[small.clone()], &mut out[small]);
        }
    }
}

/// |s| over the Chebyshev points of an interval \[mm\].
struct Size {
    largest: f64,
    least: f64,
}

/// Part of a column, compiled for each kind of machine.
struct Interval<'c, 's, 'a> {
    column: &'c mut SkewedColumn<'s, 'a>,
    ends: [f64; 2],
    eta: &'c [f64],
    out: &'c mut [f64],
}

impl pulp::WithSimd for Interval<'_, '_, '_> {
    type Output = Option<Size>;

    /// `None` where s is not over one branch, or its interpolant has too few coefficients that are rounding.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Option<Size> {
        let Self { column, ends: [a, b], eta, out } = self;
        let few = eta.len() <= MANY;
        let (centre, half) = (a + (b - a) / 2.0, (b - a) / 2.0);
        let points = if few {
            row(|k| eta[k.min(eta.len() - 1)])
        } else {
            let nodes = &*chebyshev::NODES;
            row(|k| centre + half * nodes[k])
        };
        let (s, rounding) = column.separations(&points, !few)?;
        let size = Size {
            largest: s.iter().fold(0.0, |most, s| s.abs().max(most)),
            least: s.iter().fold(f64::INFINITY, |least, s| s.abs().min(least)),
        };
        if few {
            out.copy_from_slice(&s[..eta.len()]);
            return Some(size);
        }
        let demand = column.demand;
        let c = chebyshev::coefficients(&s);
        let (kept, dropped) = kept(&c, demand.absolute.min(demand.relative * size.largest), rounding)?;
        let mut powers = chebyshev::to_powers(&c, kept);
        let mut shrink = 1.0;
        for c in &mut powers[1..kept] {
            shrink /= half;
            *c *= shrink;
        }
        let c = &powers[1..kept.max(2)];
        // Powers of a tiny interval may be beyond all numbers.
        if c.len() > MOST_COEFFICIENTS || !c.iter().all(|c| c.is_finite()) {
            return None;
        }
        per_degree(c.len(), OneRun { simd, begin: [powers[0], centre], c, u: eta, out });
        column.error = column.error.max(dropped);
        Some(size)
    }
}

/// Number of Chebyshev coefficients that are needed, and the sum of the others, each of which is rounding or all together
/// within the demand; `None` where that leaves too few.
#[inline(always)]
fn kept(c: &Row, demand: f64, rounding: f64) -> Option<(usize, f64)> {
    let (mut kept, mut dropped) = (MANY, 0.0);
    while kept > 1 && (c[kept - 1].abs() <= rounding || dropped + c[kept - 1].abs() <= demand) {
        kept -= 1;
        dropped += c[kept].abs();
    }
    (kept + PROOF <= MANY).then_some((kept, dropped))
}

impl SkewedColumn<'_, '_> {
    /// s at η over one branch of the wheel, and its rounding \[mm\]; `None` where they are not, or may not be `between`
    /// neighbours.
    #[inline(always)]
    fn separations(&mut self, eta: &Row, between: bool) -> Option<(Row, f64)> {
        let (xi, evaluator) = (self.xi, &mut *self.evaluator);
        let (mut shift, mut u) = ([0.0; MANY], [0.0; MANY]);
        for k in 0..MANY {
            let [along, across] = evaluator.wheel_coordinates(xi, eta[k]);
            (shift[k], u[k]) = (along, across * across);
        }
        let xi_w = row(|k| xi + shift[k]);
        evaluator.wheel.spans(xi_w[MANY / 2], u[MANY / 2], &mut evaluator.spans);
        let span = evaluator.spans[WheelSurface::span_at(&evaluator.spans, u[MANY / 2])?];
        let wheel = &evaluator.wheel;
        let piece = &wheel.section.pieces[span.piece];
        let here = wheel.spans_over(&xi_w, piece)?;
        let feet = wheel.feet_at(&xi_w, &here, &u)?;
        let abscissae = row(|k| wheel.abscissa(xi_w[k], feet.e[k]));
        if !inside(piece, &abscissae, between) || !beyond_step(wheel, span.piece, [&xi_w, &u], between) {
            return None;
        }
        let begun = here.e[0].iter().filter(|&&e| e == 0.0).count();
        let contact = self.contact.filter(|_| wheel.section.contact == Some(piece.branch) && begun > 0);
        let Some(contact) = contact else {
            let s = row(|k| here.height[k] - self.rail_height + feet.rise[k]);
            let size = here.height.iter().fold(0.0, |most, &height| evaluator.size(xi, height).max(most));
            return Some((s, f64::EPSILON * size));
        };
        if begun < MANY {
            return None;
        }
        let slope = wheel.section.branches[piece.branch].chords_from(&contact.from, &xi_w)?;
        let s = row(|k| contact.gap + shift[k] * slope[k] + feet.rise[k]);
        let largest = s.iter().fold(0.0, |most, s| s.abs().max(most));
        Some((s, ROUNDING_LEVEL * largest))
    }
}

/// Whether columns that enter a piece where the envelope jumps from sheet to sheet are beyond what the piece before it covers, and all in between
/// as well: where both have a point, that one counts.
#[inline(always)]
fn beyond_step(wheel: &WheelSurface<'_>, index: usize, [xi, u]: [&Row; 2], between: bool) -> bool {
    let ([near, far], pieces) = (wheel.sides(), &wheel.section.pieces);
    let neighbour = if near == 0 { index.checked_sub(1) } else { Some(index + 1) };
    let piece = &pieces[index];
    let joined = neighbour.and_then(|k| pieces.get(k)).filter(|before| before.xi[far] == piece.xi[near]);
    let Some(before) = joined.filter(|before| before.ends[far].1 != piece.ends[near].1) else { return true };
    // A column that begins on the piece, or on neither's side of the joint, leaves the other at e ≤ 0.
    let beyond = row(|k| match wheel.leaves(xi[k], before) {
        [e, u_joint] if e > 0.0 => u[k] - u_joint,
        _ => f64::INFINITY,
    });
    let margin = if between { widest_step(&beyond) } else { 0.0 };
    beyond.iter().all(|&beyond| beyond >= margin)
}

/// The largest difference of neighbours; infinities count only beside numbers.
#[inline(always)]
fn widest_step(values: &Row) -> f64 {
    values.windows(2).fold(0.0, |widest, pair| (pair[1] - pair[0]).abs().max(widest))
}

/// Whether abscissae of the profile are inside one piece, and all in between as well: the abscissa is a parabola up to terms of
/// fourth order, which turns between two points by less than it moves between others.
#[inline(always)]
fn inside(piece: &Piece, abscissae: &Row, between: bool) -> bool {
    let margin = if between { widest_step(abscissae) } else { 0.0 };
    let [low, high] = [piece.xi[0] + margin, piece.xi[1] - margin];
    abscissae.iter().all(|&abscissa| low <= abscissa && abscissa <= high)
}
