//! Fits q(ξ, ·) over one span as a polynomial in v = u − u_0, for N columns at once, to a demanded accuracy.
//!
//! Over one branch of the wheel s = s_0 + v q(v), with s_0 the value at the beginning of the span and q analytic. Not s but
//! q is interpolated, so that both terms keep their relative accuracy. The nodes are Chebyshev points in the sagitta e.
//! Because u is nearly a multiple of e, they are nearly Chebyshev points in u, too; and ζ and u follow from e without
//! iteration.

use super::horner::{ColumnPolynomial, MOST_COEFFICIENTS};
use super::neighbours::{MOST_SPANS, Neighbours};
use crate::numerics::chebyshev::{extrema, powers, unit_nodes};
use crate::numerics::lanes::{Lanes, MANY, every, lanes, largest};
use crate::numerics::nan_max;
use crate::separation::demand::{Demand, first_count};
use crate::separation::relief::Relief;
use crate::separation::span::{SagittaPoints, Span, SpanLanes};
use crate::separation::wheel_surface::WheelSurface;

/// Fits polynomials to columns of a relief: for strips, for columns in no strip, and for the measurement of errors.
#[derive(Debug)]
pub struct Fitter<'a> {
    pub relief: Relief<'a>,
    pub neighbours: Neighbours<'a>,
    /// The accuracy that truncation must keep.
    pub demand: Demand,
    /// Number of coefficients that a column starts with, if its span is not short.
    pub least: usize,
    /// Coefficients of several columns that were fitted at once.
    pub rows: Vec<Lanes>,
    pub spans: Vec<Span>,
    /// Coefficients of a single column.
    pub single: Vec<Lanes<1>>,
    /// The vector instructions of this machine, for which work on lanes is compiled.
    pub arch: pulp::Arch,
}

impl<'a> Fitter<'a> {
    /// Makes a fitter for a demand on s. Every column starts with `least` coefficients and takes more if it needs them.
    pub fn new(relief: Relief<'a>, demand: Demand, least: usize) -> Self {
        Self {
            neighbours: Neighbours::new(relief.wheel),
            relief,
            demand: demand.on_truncation(),
            least,
            rows: Vec::with_capacity(MOST_SPANS * (MOST_COEFFICIENTS + 2)),
            spans: Vec::new(),
            single: Vec::with_capacity(MOST_COEFFICIENTS),
            arch: pulp::Arch::new(),
        }
    }

    /// Fits the column at ξ \[mm\] over one span up to `u_max` \[mm²\], without skew. Returns `None` if no degree reaches
    /// the demand.
    pub fn column(&mut self, xi: f64, span: &Span, u_max: f64) -> Option<ColumnPolynomial> {
        let wheel = &self.relief.wheel;
        let mut lane = wheel.lane(span);
        lane.u[1] = [span.u.high.min(u_max)];
        self.single.clear();
        let (n, error) = polynomials(wheel, &lane, u_max, (self.demand, self.least), &mut self.single)?;
        let mut c = [0.0; MOST_COEFFICIENTS];
        c[..n].copy_from_slice(self.single.as_flattened());
        Some(ColumnPolynomial { base: self.relief.base(xi, 0.0, span), u0: span.u.low, c, n, error })
    }

    /// Fits several columns in no strip at once, up to `u_max` \[mm²\]: at most [`MANY`], each over one span. Their
    /// coefficients are in `rows`.
    ///
    /// Returns which columns were fitted, their number of coefficients, and the largest measured error \[mm\]. Returns
    /// `None` if no column was fitted.
    #[inline(always)]
    pub fn columns(&mut self, u_max: f64, xi: &[f64]) -> Option<([bool; MANY], usize, f64)> {
        let Self { relief, neighbours, demand, least, rows, .. } = self;
        rows.clear();
        let taken = neighbours.take_each(relief, u_max, xi)?;
        let span = &neighbours.spans[0].wheel;
        let (n, error) = polynomials(&neighbours.wheel, span, u_max, (*demand, *least), rows)?;
        taken.contains(&true).then_some((taken, n, error))
    }
}

/// Appends the coefficients of q over one span in powers of v: at least `least` of them; over a short span two may do. The columns
/// end at `u_max` \[mm²\].
///
/// Returns their number and the largest error \[mm\], measured at the end of the span and between its nodes. Returns `None`
/// if no degree reaches the demand; the span is then close to a vertical tangent.
#[inline(always)]
pub fn polynomials<const N: usize>(
    wheel: &WheelSurface<'_>,
    span: &SpanLanes<'_, N>,
    u_max: f64,
    (demand, least): (Demand, usize),
    coefficients: &mut Vec<Lanes<N>>,
) -> Option<(usize, f64)> {
    let (end, run) = wheel.points_near(span, &span.u[1])?;
    let allowed: Lanes<N> = lanes(|k| demand.allowed(end.rise[k], span.e[0][k]));
    let length: Lanes<N> = lanes(|k| span.u[1][k] - span.u[0][k]);
    let begin = coefficients.len();
    let mut v = [[0.0; N]; MOST_COEFFICIENTS];
    for n in first_count(least, largest(&length), u_max)..=MOST_COEFFICIENTS {
        coefficients.resize(begin + n, [0.0; N]);
        let q = &mut coefficients[begin..];
        for ((v, q), node) in v.iter_mut().zip(&mut *q).zip(unit_nodes(n)) {
            let points = wheel.points_by(span, &lanes(|k| run[k] * node));
            *v = points.v;
            *q = lanes(|k| points.rise[k] / v[k]);
        }
        powers(&v[..n], q);
        let mut errors = error(q, &end);
        for share in extrema(n) {
            let inner = error(q, &wheel.points_by(span, &lanes(|k| run[k] * share)));
            errors = lanes(|k| nan_max(errors[k], inner[k]));
        }
        // The comparison is false for an error that is NaN.
        if every::<N>(|k| errors[k] <= allowed[k]) {
            return Some((n, largest(&errors)));
        }
    }
    None
}

/// Computes the errors \[mm\] of polynomials at points of a span.
#[inline(always)]
pub fn error<const N: usize>(q: &[Lanes<N>], points: &SagittaPoints<N>) -> Lanes<N> {
    let mut value = [0f64; N];
    for q in q.iter().rev() {
        value = lanes(|k| value[k] * points.v[k] + q[k]);
    }
    lanes(|k| (value[k] * points.v[k] - points.rise[k]).abs())
}
