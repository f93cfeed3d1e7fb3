//! The columns of one strip: their quantities, and s from them, for many columns at once.

use super::axis::EtaAxis;
use super::columns::{MANY, Row, row};
use super::gap::midplane_gap;
use super::horner::{PerDegree, horner, per_degree};
use super::spectral::MOST_COEFFICIENTS;
use crate::placement::Placement;

/// Columns over an interval of ξ, each made up of the same quantities: of every span the coefficients of q, s at its
/// beginning and u_0, all polynomials in ξ.
#[derive(Debug, Clone)]
pub struct Strip {
    /// Its open interval \[mm\]: at its ends may be a drawing's step, which has a value of its own.
    pub xi: [f64; 2],
    /// How s at the beginning of the columns is known.
    pub(super) gap: Gap,
    /// Of every span the number of coefficients of q.
    pub(super) coefficients: Vec<usize>,
    /// Of every quantity the coefficients of t^(kept−1), …, t⁰; t from −1 to 1 over the interval.
    pub(super) powers: Vec<f64>,
    pub(super) kept: usize,
    /// Largest measured truncation error of its columns \[mm\].
    pub truncation: f64,
}

/// s at the beginning of a strip's columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Gap {
    /// Interpolated as it is.
    Plain,
    /// Interpolated as g/ξ².
    Relative,
    /// Computed for every column: where g/ξ² varies too much for its smallest values to keep their digits.
    Computed,
}

/// One span of neighbouring columns.
#[derive(Debug, Clone)]
pub(super) struct SpanRows {
    /// Coefficients of q in powers of u − u_0.
    c: [Row; MOST_COEFFICIENTS],
    /// s at u_0 \[mm\].
    base: Row,
    /// Range of u \[mm²\].
    u: [Row; 2],
}

impl SpanRows {
    pub(super) const NONE: Self = Self { c: [[0.0; MANY]; _], base: [0.0; MANY], u: [[0.0; MANY]; 2] };
}

/// Neighbouring columns of one strip, compiled for each kind of machine. A struct, since closures may be left out of
/// line, and so without the machine's widest vectors. Stored past the caches if `PAST`.
pub(super) struct StripColumns<'a, const PAST: bool> {
    pub placement: &'a Placement,
    pub strip: &'a Strip,
    /// At most [`MANY`].
    pub xi: &'a [f64],
    pub axis: &'a EtaAxis,
    /// Scratch space.
    pub rows: &'a mut Vec<SpanRows>,
    pub out: &'a mut [f64],
}

impl<const PAST: bool> pulp::WithSimd for StripColumns<'_, PAST> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { placement, strip, xi, axis, rows, out } = self;
        rows.resize(strip.coefficients.len(), SpanRows::NONE);
        strip.rows(placement, xi, axis.reach * axis.reach, rows);
        let counts = &mut [0; MANY];
        for (k, (rows, &n)) in rows.iter().zip(&strip.coefficients).enumerate() {
            if k == 0 {
                per_degree(n, SpanOfColumns::<S, true, PAST> { simd, rows, axis, counts, out });
            } else {
                per_degree(n, SpanOfColumns::<S, false, PAST> { simd, rows, axis, counts, out });
            }
        }
    }
}

impl Strip {
    /// The spans at each ξ.
    #[inline(always)]
    fn rows(&self, placement: &Placement, xi: &[f64], u_max: f64, rows: &mut [SpanRows]) {
        let ([a, b], mut all) = (self.xi, [xi[0]; MANY]);
        all[..xi.len()].copy_from_slice(xi);
        let t = row(|k| ((all[k] - a) - (b - all[k])) / (b - a));
        let mut powers = self.powers.chunks_exact(self.kept);
        for (rows, &n) in rows.iter_mut().zip(&self.coefficients) {
            let quantities = rows.c[..n].iter_mut().chain([&mut rows.base, &mut rows.u[0]]);
            for (quantity, powers) in quantities.zip(&mut powers) {
                let mut sum = [0.0f64; MANY];
                for c in powers {
                    sum = row(|k| sum[k].mul_add(t[k], *c));
                }
                *quantity = sum;
            }
        }
        let base = &mut rows[0].base;
        match self.gap {
            Gap::Plain => {}
            Gap::Relative => *base = row(|k| base[k] * (all[k] * all[k])),
            Gap::Computed => *base = all.map(|xi| midplane_gap(placement, xi)),
        }
        let mut end = [u_max; MANY];
        for (rows, &n) in rows.iter_mut().zip(&self.coefficients).rev() {
            rows.u[1] = end;
            end = rows.u[0];
            if self.coefficients.len() > 1 {
                let shrink = row(|k| 1.0 / (rows.u[1][k] - rows.u[0][k]));
                let mut power = [1.0; MANY];
                for c in &mut rows.c[1..n] {
                    power = row(|k| power[k] * shrink[k]);
                    *c = row(|k| c[k] * power[k]);
                }
            }
        }
    }
}

/// One span of neighbouring columns.
struct SpanOfColumns<'a, S, const FIRST: bool, const PAST: bool> {
    simd: S,
    rows: &'a SpanRows,
    axis: &'a EtaAxis,
    /// Numbers of η ≥ 0 up to the span's begin, then up to its end.
    counts: &'a mut [usize; MANY],
    out: &'a mut [f64],
}

impl<S: pulp::Simd, const FIRST: bool, const PAST: bool> PerDegree for SpanOfColumns<'_, S, FIRST, PAST> {
    #[inline(always)]
    fn run<const N: usize>(self) {
        let Self { simd, rows, axis, counts, out } = self;
        let mut near = 0;
        for (k, (out, count)) in out.chunks_exact_mut(axis.eta.len()).zip(counts).enumerate() {
            let (u, begin) = ([rows.u[0][k], rows.u[1][k]], *count);
            let end = axis.count(u[1], near).max(begin);
            (near, *count) = (end, end);
            // A drawing's step is mostly between two values.
            if !FIRST && end == begin && axis.symmetric {
                continue;
            }
            let mut c = [0.0; N];
            for (c, row) in c.iter_mut().zip(&rows.c) {
                *c = row[k];
            }
            // Both halves of a symmetric axis: copying one takes longer than evaluating it.
            for run in axis.runs(u, begin, end) {
                let (u_run, out) = (&axis.u[run.clone()], &mut out[run]);
                horner::<S, N, FIRST, PAST>(simd, [rows.base[k], u[0]], &c, u_run, out);
            }
        }
    }
}
