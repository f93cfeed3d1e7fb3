//! Columns of a skewed wheel: s(ξ, ·) as polynomials in η, with even and odd powers.
//!
//! Along a column the wheel's own ξ′ = ξ cos χ + η sin χ moves, so that s is no function of η². Over one branch of the
//! wheel s is analytic in η. It is interpolated from 16 Chebyshev points; an interval where that is not accurate enough is
//! halved. The absolute error of the interpolant is a share of the interval's largest s. Intervals in which s is much
//! smaller somewhere, near C, are therefore divided or computed point by point.

use super::horner::{MOST_COEFFICIENTS, SpanRun};
use crate::numerics::chebyshev::{self, PROOF};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, every, lanes};
use crate::profile::{BranchPoints, Piece};
use crate::separation::demand::{Demand, ROUNDING_LEVEL};
use crate::separation::gap::contact_gap;
use crate::separation::relief::Relief;
use crate::separation::span::SpanLanes;
use crate::separation::wheel_surface::WheelSurface;

/// Share of an interval's largest |s| below which an interpolated s would not have the promised thirteen digits.
const SMALL_SHARE: f64 = 1.0 / 64.0;

/// Writes s \[mm\] of the column at ξ over ascending η to a demanded accuracy; NaN where a body has no surface. Returns the
/// largest truncation error \[mm\].
pub fn fill(
    relief: &mut Relief<'_>,
    (arch, demand): (pulp::Arch, Demand),
    xi: f64,
    eta: &[f64],
    out: &mut [f64],
) -> f64 {
    let mut column = SkewedColumn::new(relief, arch, demand, xi);
    if column.rail_height.is_nan() {
        out.fill(f64::NAN);
    } else {
        column.fill(eta, out);
    }
    column.error
}

/// A column of gaps along η, analytic over one branch of the wheel.
pub trait AlongEta {
    /// Writes the gaps \[mm\] at ascending η from one polynomial in η, or at most [`MANY`] gaps at once. Returns the interval from the
    /// least to the largest magnitude \[mm\]; `None` if the gaps do not lie over one branch, or if one polynomial does not keep the
    /// demand.
    fn at_once(&mut self, eta: &[f64], out: &mut [f64]) -> Option<Interval>;

    /// Writes the gaps \[mm\] at η, point by point.
    fn singly(&mut self, eta: &[f64], out: &mut [f64]);

    /// Writes the gaps \[mm\] at ascending η. An interval without a polynomial is halved, and one where gaps are small is computed anew.
    fn fill(&mut self, eta: &[f64], out: &mut [f64]) {
        let few = eta.len() <= MANY;
        let Some(size) = self.at_once(eta, out) else {
            if few {
                return self.singly(eta, out);
            }
            let (eta, out) = (eta.split_at(eta.len() / 2), out.split_at_mut(eta.len() / 2));
            self.fill(eta.0, out.0);
            return self.fill(eta.1, out.1);
        };
        let is_small = |gap: &f64| gap.abs() < SMALL_SHARE * size.high;
        // A parabola falls by less than that share between two Chebyshev points.
        if few || size.low > 2.0 * SMALL_SHARE * size.high {
            return;
        }
        let (Some(begin), Some(end)) = (out.iter().position(is_small), out.iter().rposition(is_small)) else {
            return;
        };
        let small = begin..end + 1;
        if small.len() <= eta.len() / 2 {
            self.fill(&eta[small.clone()], &mut out[small]);
        } else {
            self.singly(&eta[small.clone()], &mut out[small]);
        }
    }
}

/// One column of a skewed wheel.
struct SkewedColumn<'s, 'a> {
    relief: &'s mut Relief<'a>,
    arch: pulp::Arch,
    demand: Demand,
    xi: f64,
    /// ζ of the rail \[mm\]; NaN where it has no surface.
    rail_height: f64,
    contact: Option<ContactBeginning>,
    /// Largest truncation error so far \[mm\].
    error: f64,
}

/// The values from which s is computed if ξ lies over both contact segments.
#[derive(Debug, Clone, Copy)]
struct ContactBeginning {
    /// g(ξ) \[mm\].
    gap: f64,
    /// The point of the wheel's profile at ξ.
    from: BranchPoints<MANY>,
}

impl<'s, 'a> SkewedColumn<'s, 'a> {
    fn new(relief: &'s mut Relief<'a>, arch: pulp::Arch, demand: Demand, xi: f64) -> Self {
        let (rail, wheel) = (relief.below, relief.wheel.section);
        let piece = rail.piece_at(xi);
        let rail_height = piece.map_or(f64::NAN, |piece| rail.branches[piece.branch].height(xi));
        let branches =
            piece.map(|piece| piece.branch).filter(|r| rail.contact == Some(*r)).zip(wheel.contact);
        let contact = branches.and_then(|(r, w)| {
            let (rail, wheel) = (&rail.branches[r], &wheel.branches[w]);
            let (from, height) = wheel.point(xi);
            wheel.xi.contains(xi).then(|| ContactBeginning {
                gap: contact_gap(rail, wheel, xi, height),
                from: from.repeated(),
            })
        });
        Self { relief, arch, demand, xi, rail_height, contact, error: 0.0 }
    }
}

impl AlongEta for SkewedColumn<'_, '_> {
    fn at_once(&mut self, eta: &[f64], out: &mut [f64]) -> Option<Interval> {
        self.arch.dispatch(EtaInterval { column: self, eta, out })
    }

    fn singly(&mut self, eta: &[f64], out: &mut [f64]) {
        self.relief.column(self.xi, eta, out);
    }
}

/// An interval of η of a column that is to be filled. The work is compiled for each kind of machine.
struct EtaInterval<'c, 's, 'a> {
    column: &'c mut SkewedColumn<'s, 'a>,
    eta: &'c [f64],
    out: &'c mut [f64],
}

impl pulp::WithSimd for EtaInterval<'_, '_, '_> {
    type Output = Option<Interval>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Option<Interval> {
        let Self { column, eta, out } = self;
        if eta.len() <= MANY {
            let last = eta.len().checked_sub(1)?;
            let (s, _) = column.separations(&lanes(|k| eta[k.min(last)]), false)?;
            out.copy_from_slice(&s[..eta.len()]);
            return Some(magnitudes(&s));
        }
        let over = Interval::new(*eta.first()?, *eta.last()?);
        let (s, rounding) = column.separations(&chebyshev_points(over), true)?;
        let (size, dropped) = interpolate(simd, &s, over, (column.demand, rounding), eta, out)?;
        column.error = column.error.max(dropped);
        Some(size)
    }
}

/// Returns the 16 Chebyshev points of an interval.
#[inline(always)]
pub fn chebyshev_points(over: Interval) -> Lanes {
    let (nodes, centre, half) = (&*chebyshev::NODES, over.middle(), over.width() / 2.0);
    lanes(|k| centre + half * nodes[k])
}

/// Returns the interval from the least to the largest magnitude. A NaN does not count.
#[inline(always)]
fn magnitudes(values: &Lanes) -> Interval {
    let most = values.iter().fold(0.0, |most, value| value.abs().max(most));
    Interval { low: values.iter().fold(f64::INFINITY, |least, value| value.abs().min(least)), high: most }
}

/// Writes the interpolant of values at the 16 Chebyshev points of an interval to all η \[mm\]. Returns the magnitudes of the values,
/// and the sum of the coefficients that were dropped; `None` if too few of them are within the demand or as small as `rounding`
/// \[mm\].
#[inline(always)]
pub fn interpolate<S: pulp::Simd>(
    simd: S,
    values: &Lanes,
    over: Interval,
    (demand, rounding): (Demand, f64),
    eta: &[f64],
    out: &mut [f64],
) -> Option<(Interval, f64)> {
    let (c, centre, half) = (chebyshev::coefficients(values), over.middle(), over.width() / 2.0);
    let size = magnitudes(values);
    let (kept, dropped) = kept(&c, demand.absolute.min(demand.relative * size.high), rounding)?;
    let mut powers = chebyshev::to_powers(&c, kept);
    let mut shrink = 1.0;
    for c in &mut powers[1..kept] {
        shrink /= half;
        *c *= shrink;
    }
    let c = &powers[1..kept.max(2)];
    // Powers of a tiny interval may overflow.
    if c.len() > MOST_COEFFICIENTS || !c.iter().all(|c| c.is_finite()) {
        return None;
    }
    simd.vectorize(SpanRun { begin: [powers[0], centre], c, u: eta, out });
    Some((size, dropped))
}

/// Returns the number of Chebyshev coefficients that are needed, and the sum of the others. The others are all as small as
/// rounding, or their sum is within the demand. Returns `None` if there are too few others.
#[inline(always)]
fn kept(c: &Lanes, demand: f64, rounding: f64) -> Option<(usize, f64)> {
    let (mut kept, mut dropped) = (MANY, 0.0);
    while kept > 1 && (c[kept - 1].abs() <= rounding || dropped + c[kept - 1].abs() <= demand) {
        kept -= 1;
        dropped += c[kept].abs();
    }
    (kept + PROOF <= MANY).then_some((kept, dropped))
}

impl SkewedColumn<'_, '_> {
    /// Computes s \[mm\] at η over one branch of the wheel, and its rounding \[mm\]. Returns `None` if not all η lie over
    /// one branch. If `between`, this also covers all places between neighbouring η.
    #[inline(always)]
    fn separations(&mut self, eta: &Lanes, between: bool) -> Option<(Lanes, f64)> {
        let (xi, relief) = (self.xi, &mut *self.relief);
        let (mut shift, mut u) = ([0.0; MANY], [0.0; MANY]);
        for k in 0..MANY {
            let [along, across] = relief.skew.own(xi, eta[k]);
            (shift[k], u[k]) = (along, across * across);
        }
        let xi_w = lanes(|k| xi + shift[k]);
        let span = relief.span(xi_w[MANY / 2], u[MANY / 2])?;
        let wheel = &relief.wheel;
        let piece = &wheel.section.pieces[span.piece];
        let here = spans_over(wheel, &xi_w, piece)?;
        let points = wheel.points_at(&xi_w, &here, &u)?;
        if !every::<MANY>(|k| points.w[k] > 0.0) {
            return None;
        }
        let abscissae = lanes(|k| wheel.abscissa(xi_w[k], points.e[k]));
        if !inside_piece(piece.xi, &abscissae, between)
            || !beyond_steps(wheel, span.piece, [&xi_w, &u], between)
        {
            return None;
        }
        let begun = here.e[0].iter().filter(|&&e| e == 0.0).count();
        let contact = self.contact.filter(|_| wheel.section.contact == Some(piece.branch) && begun > 0);
        let Some(contact) = contact else {
            let s = lanes(|k| here.height[k] - self.rail_height + points.rise[k]);
            let size = here.height.iter().fold(0.0, |most, &height| relief.size(xi, height).max(most));
            return Some((s, f64::EPSILON * size));
        };
        if begun < MANY {
            return None;
        }
        let slope = wheel.section.branches[piece.branch].chords_from(&contact.from, &xi_w)?;
        let s = lanes(|k| contact.gap + shift[k] * slope[k] + points.rise[k]);
        let largest = s.iter().fold(0.0, |most, s| s.abs().max(most));
        Some((s, ROUNDING_LEVEL * largest))
    }
}

/// Makes the spans of columns at ξ over one piece. Each begins where its column enters the piece; the ends are not known.
/// Returns `None` if a point is not found.
#[inline(always)]
fn spans_over<'a>(wheel: &WheelSurface<'a>, xi: &Lanes, piece: &Piece) -> Option<SpanLanes<'a, MANY>> {
    let branch = &wheel.section.branches[piece.branch];
    let begin = lanes(|k| piece.xi.nearest(xi[k]));
    let e0 = lanes(|k| if xi[k] == begin[k] { 0.0 } else { (xi[k] - begin[k]) / wheel.sin });
    Some(wheel.span_from(xi, branch, e0, branch.points(&begin)?))
}

/// Returns whether columns that pass a step of the envelope on their way to a piece have left the piece in front of it; where
/// both have a point, the one in front is the outer one. If `between`, this also covers all columns between neighbouring ones.
#[inline(always)]
fn beyond_steps(wheel: &WheelSurface<'_>, index: usize, [xi, u]: [&Lanes; 2], between: bool) -> bool {
    let pieces = &wheel.section.pieces;
    wheel.section.steps.iter().all(|&step| {
        let before = match wheel.sides() {
            [0, _] if step <= index => &pieces[step - 1],
            [1, _] if step > index => &pieces[step],
            _ => return true,
        };
        // Columns that begin beyond the piece in front do not pass the step; a level wheel's columns pass nothing.
        let far = before.xi[wheel.sides()[1]];
        let passing = |k: usize| (xi[k] - far) * wheel.sin > 0.0;
        let near = |k: usize| ((xi[k] - before.xi[wheel.sides()[0]]) / wheel.sin).max(0.0);
        if !(0..MANY).any(passing) {
            return true;
        }
        let beyond: Lanes = lanes(|k| {
            if passing(k) { u[k] - wheel.leaves_or_folds(xi[k], before, near(k))[1] } else { f64::INFINITY }
        });
        let margin = if between { widest_step(&beyond) } else { 0.0 };
        beyond.iter().all(|&beyond| beyond > margin)
    })
}

/// Returns the largest difference of neighbouring values. An infinite value counts only beside a number.
#[inline(always)]
fn widest_step(values: &Lanes) -> f64 {
    values.windows(2).fold(0.0, |widest, pair| (pair[1] - pair[0]).abs().max(widest))
}

/// Returns whether abscissae of the profile are inside those of one piece. If `between`, this also covers all places between
/// neighbouring ones: the abscissa is a parabola up to terms of fourth order, so that a turn between two points moves it by
/// less than the step between two others.
#[inline(always)]
pub fn inside_piece(piece: Interval, abscissae: &Lanes, between: bool) -> bool {
    let margin = if between { widest_step(abscissae) } else { 0.0 };
    let inner = piece.grown(-margin);
    abscissae.iter().all(|&abscissa| inner.contains(abscissa))
}
