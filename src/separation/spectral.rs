//! Spectral columns: q(ξ, ·) as a polynomial in u = η², one per column and branch.
//!
//! Over one branch of the wheel s = s_0 + (u − u_0) q(u), with s_0 at the branch's beginning (g(ξ) at u_0 = 0)
//! and q analytic. q is interpolated, not s: the relative accuracy of both terms survives. The nodes are
//! Chebyshev points in the sagitta e, of which u is nearly a multiple: ζ and u follow from e with no iteration.

use super::axis::EtaAxis;
use super::column::{Span, WheelSurface};
use super::grid::Kernel;
use super::{Evaluator, skewed};
use crate::placement::Placement;

/// Most coefficients of a column. A span that needs more is close to a vertical tangent, and is evaluated
/// point-wise.
pub const MOST_COEFFICIENTS: usize = 12;

/// Relative error of q that counts as rounding: more coefficients would not lower it.
const ROUNDING_LEVEL: f64 = 4.0 * f64::EPSILON;

/// Share of the window's u that the nodes must cover; beyond them the polynomial is continued that little.
const NEARLY_COVERED: f64 = 0.99;

/// The demand on a column: |error of s| ≤ `absolute`, and ≤ `relative` × |(u − u_0) q|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// \[mm\].
    pub absolute: f64,
    /// Relative to the wheel's rise.
    pub relative: f64,
}

/// A polynomial s = base + v Σ c_k v^k, v = u − u_0.
#[derive(Debug, Clone, Copy)]
pub struct ColumnPolynomial {
    /// Value at the beginning of the span \[mm\].
    pub base: f64,
    /// u_0 \[mm²\].
    pub u0: f64,
    /// Coefficients of q.
    pub c: [f64; MOST_COEFFICIENTS],
    /// How many of them.
    pub n: usize,
    /// Measured error of s \[mm\] at the end of the span, where it is largest.
    pub error: f64,
}

/// Columns by interpolation to a demand.
#[derive(Debug)]
pub struct Spectral<'a> {
    evaluator: Evaluator<'a>,
    axis: &'a EtaAxis,
    demand: Demand,
    coefficients: usize,
    spans: Vec<Span>,
    arch: pulp::Arch,
}

impl<'a> Spectral<'a> {
    /// Over a placed pair; every column starts with `coefficients` and takes more where it needs them.
    pub fn new(placement: &'a Placement, axis: &'a EtaAxis, demand: Demand, coefficients: usize) -> Self {
        let evaluator = Evaluator::new(placement);
        let arch = pulp::Arch::new();
        Self { evaluator, axis, demand, coefficients, spans: Vec::with_capacity(8), arch }
    }

    /// The polynomial over one span up to `u_max`, or `None` where no degree reaches the demand.
    pub fn polynomial(&self, xi: f64, span: &Span, u_max: f64) -> Option<ColumnPolynomial> {
        let end = self.evaluator.wheel.foot_near(xi, span, span.u[1].min(u_max));
        let covered = end.u >= NEARLY_COVERED * span.u[1].min(u_max);
        if !covered || end.w <= 0.0 {
            return None;
        }
        let base = self.evaluator.base(xi, xi, span);
        let allowed = self.demand.absolute.min(self.demand.relative * end.rise.abs());
        let rounding = ROUNDING_LEVEL * end.rise.abs();
        for n in self.coefficients..=MOST_COEFFICIENTS {
            let c = interpolate(&self.evaluator.wheel, xi, span, end.e, n);
            let fit = ColumnPolynomial { base: 0.0, u0: span.u[0], c, n, error: 0.0 };
            // The end is where the error of an interpolant at Chebyshev points is largest.
            let error = (fit.value(end.u) - end.rise).abs();
            if error <= allowed.max(rounding) {
                return Some(ColumnPolynomial { base, error, ..fit });
            }
        }
        None
    }
}

impl ColumnPolynomial {
    fn value(&self, u: f64) -> f64 {
        let v = u - self.u0;
        self.base + v * self.c[..self.n].iter().rev().fold(0.0, |q, c| q * v + c)
    }
}

/// q at n nodes between the span's beginning and sagitta `e_end`, by divided differences, in powers of v.
fn interpolate(
    wheel: &WheelSurface<'_>,
    xi: f64,
    span: &Span,
    e_end: f64,
    n: usize,
) -> [f64; MOST_COEFFICIENTS] {
    let (mut v, mut d) = ([0.0; MOST_COEFFICIENTS], [0.0; MOST_COEFFICIENTS]);
    let width = e_end - span.e[0];
    for (j, node) in NODES[n - 1].iter().take(n).enumerate() {
        let foot = wheel.foot(xi, span, span.e[0] + width * node);
        v[j] = foot.u - span.u[0];
        d[j] = foot.rise / v[j];
    }
    for order in 1..n {
        for j in (order..n).rev() {
            d[j] = (d[j] - d[j - 1]) / (v[j] - v[j - order]);
        }
    }
    let mut c = [0.0; MOST_COEFFICIENTS];
    for j in (0..n).rev() {
        // c ← c·(v − v_j) + d_j
        for k in (1..n - j).rev() {
            c[k] = c[k - 1] - v[j] * c[k];
        }
        c[0] = d[j] - v[j] * c[0];
    }
    c
}

impl Kernel for Spectral<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        if self.evaluator.placement.skew != 0.0 {
            return skewed::column(&mut self.evaluator, self.axis, self.demand, xi, out);
        }
        let u_max = self.axis.reach * self.axis.reach;
        let mut spans = std::mem::take(&mut self.spans);
        self.evaluator.wheel.spans(xi, u_max, &mut spans);
        let whole = spans.first().is_some_and(|span| span.e[0] == 0.0)
            && spans.last().is_some_and(|span| span.u[1] >= u_max)
            && spans.windows(2).all(|pair| pair[0].u[1] == pair[1].u[0]);
        if !whole {
            out.fill(f64::NAN);
        }
        for span in &spans {
            let fit = self.polynomial(xi, span, u_max);
            self.axis.ranges(span.u, |range| match &fit {
                Some(fit) => evaluate(self.arch, fit, &self.axis.u[range.clone()], &mut out[range]),
                None => self.evaluator.over_span(xi, span, &self.axis.u[range.clone()], &mut out[range]),
            });
        }
        self.spans = spans;
        self.axis.mirror(out);
    }
}

/// Horner's rule over a run of u, with the widest vectors that the machine has; unrolled for the degree so
/// that it vectorises. No fused multiply-add: the same bits on every machine.
fn evaluate(arch: pulp::Arch, fit: &ColumnPolynomial, u: &[f64], out: &mut [f64]) {
    match fit.n {
        1 => arch.dispatch(|| horner::<1>(fit, u, out)),
        2 => arch.dispatch(|| horner::<2>(fit, u, out)),
        3 => arch.dispatch(|| horner::<3>(fit, u, out)),
        4 => arch.dispatch(|| horner::<4>(fit, u, out)),
        5 => arch.dispatch(|| horner::<5>(fit, u, out)),
        6 => arch.dispatch(|| horner::<6>(fit, u, out)),
        7 => arch.dispatch(|| horner::<7>(fit, u, out)),
        8 => arch.dispatch(|| horner::<8>(fit, u, out)),
        9 => arch.dispatch(|| horner::<9>(fit, u, out)),
        10 => arch.dispatch(|| horner::<10>(fit, u, out)),
        11 => arch.dispatch(|| horner::<11>(fit, u, out)),
        _ => arch.dispatch(|| horner::<MOST_COEFFICIENTS>(fit, u, out)),
    }
}

#[inline(always)]
fn horner<const N: usize>(fit: &ColumnPolynomial, u: &[f64], out: &mut [f64]) {
    let mut c = [0.0; N];
    c.copy_from_slice(&fit.c[..N]);
    for (s, u) in out.iter_mut().zip(u) {
        let v = u - fit.u0;
        let q = c.iter().rev().fold(0.0, |q, c| q * v + c);
        *s = fit.base + v * q;
    }
}

/// Chebyshev points (1 − cos((2j + 1)π/2n))/2 of (0, 1) for n = 1 … [`MOST_COEFFICIENTS`], ascending.
static NODES: std::sync::LazyLock<[[f64; MOST_COEFFICIENTS]; MOST_COEFFICIENTS]> =
    std::sync::LazyLock::new(|| {
        std::array::from_fn(|row| {
            let n = row as f64 + 1.0;
            std::array::from_fn(|j| {
                let half = (2.0 * j as f64 + 1.0) * std::f64::consts::FRAC_PI_4 / n;
                half.sin().powi(2)
            })
        })
    });
