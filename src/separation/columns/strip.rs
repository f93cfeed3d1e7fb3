//! A strip of neighbouring columns whose quantities are polynomials in ξ, and the evaluation of s for many of its columns
//! at once.

use super::horner::{MOST_COEFFICIENTS, PerDegree, horner, per_degree, whole_vectors};
use super::neighbours::MOST_SPANS;
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, lanes};
use crate::separation::axis::{EtaAxis, mirror};
use crate::separation::relief::Relief;

/// Columns over an interval of ξ in which the same quantities determine s. For every span these are the coefficients of q,
/// s at the beginning, and u_0. All are polynomials in ξ.
#[derive(Debug, Clone, PartialEq)]
pub struct Strip {
    /// The open interval of ξ \[mm\].
    pub xi: Interval,
    /// How s at the beginning of the columns is known.
    pub(super) gap: GapStart,
    /// Number of spans.
    pub spans: usize,
    /// Number of coefficients of q.
    pub coefficients: usize,
    /// Coefficients of t^(kept−1), …, t⁰ of every quantity; t runs from −1 to 1 over the interval. The order is: the
    /// coefficients of q, span by span; then s of the first span; then u_0 and s of each further span.
    pub(super) powers: Vec<f64>,
    /// Number of powers of t for each coefficient of q, by spans. u_0 and s have as many powers as the first span.
    pub(super) kept: [usize; MOST_SPANS],
    /// Largest measured truncation error of the columns \[mm\].
    pub truncation: f64,
}

/// How s at the beginning of a strip's columns is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GapStart {
    /// s is interpolated in ξ.
    Plain,
    /// g/ξ² is interpolated in ξ.
    Relative,
    /// g is computed for every column, because too few Chebyshev coefficients of its interpolant would be as small as rounding.
    Computed,
}

/// Polynomials s = base + v Σ c_k v^k of several neighbouring columns over one span, with v = u − u_0.
#[derive(Debug, Clone)]
pub struct ColumnPolynomials {
    /// Coefficients of q.
    c: [Lanes; MOST_COEFFICIENTS],
    /// s at the beginning of the span \[mm\].
    base: Lanes,
    /// u_0 \[mm²\].
    pub(super) u0: Lanes,
}

impl ColumnPolynomials {
    /// Zero polynomials.
    pub const ZERO: Self = Self { c: [[0.0; MANY]; _], base: [0.0; MANY], u0: [0.0; MANY] };

    /// Sets the polynomials of columns that have one span, which begins at u_0 = 0.
    #[inline(always)]
    pub fn set(&mut self, c: &[Lanes], base: &Lanes) {
        self.c[..c.len()].copy_from_slice(c);
        (self.base, self.u0) = (*base, [0.0; MANY]);
    }

    /// Computes s \[mm\] of each column at its own v \[mm²\], with the given number of coefficients.
    #[inline(always)]
    pub fn values(&self, coefficients: usize, v: &Lanes) -> Lanes {
        let mut q = [0.0f64; MANY];
        for c in self.c[..coefficients].iter().rev() {
            q = lanes(|k| q[k].mul_add(v[k], c[k]));
        }
        lanes(|k| q[k].mul_add(v[k], self.base[k]))
    }

    /// Returns s and u_0 at the beginning of the k-th column's span, and its first N coefficients. If it has fewer, the rest are left
    /// over from other columns.
    #[inline(always)]
    fn column<const N: usize>(&self, k: usize) -> ([f64; 2], [f64; N]) {
        let mut c = [0.0; N];
        for (c, row) in c.iter_mut().zip(&self.c) {
            *c = row[k];
        }
        ([self.base[k], self.u0[k]], c)
    }
}

/// Neighbouring columns of one strip that are to be evaluated. The work is compiled for each kind of machine.
///
/// This is a struct and not a closure: the compiler may not inline a closure, which would then lack the machine's widest
/// vectors.
pub struct StripColumns<'a> {
    pub relief: &'a Relief<'a>,
    pub strip: &'a Strip,
    /// ξ of the columns \[mm\], at most [`MANY`].
    pub xi: &'a [f64],
    pub axis: &'a EtaAxis,
    /// Memory for the polynomials of every span, overwritten.
    pub scratch: &'a mut Vec<ColumnPolynomials>,
    /// s \[mm\], column by column, overwritten.
    pub out: &'a mut [f64],
}

impl pulp::WithSimd for StripColumns<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { relief, strip, xi, axis, scratch: polynomials, out } = self;
        polynomials.resize(strip.spans, ColumnPolynomials::ZERO);
        strip.polynomials(relief, xi, axis.reach * axis.reach, polynomials);
        let n = strip.coefficients;
        if strip.spans == 1 {
            simd.vectorize(Evaluation::<true> { polynomials, n, axis, out });
        } else {
            simd.vectorize(Evaluation::<false> { polynomials, n, axis, out });
        }
    }
}

/// Computes Σ c t^k at each t. The coefficients begin with the highest power.
#[inline(always)]
fn at(powers: &[f64], t: &Lanes) -> Lanes {
    let mut sum = [0.0f64; MANY];
    for c in powers {
        sum = lanes(|k| sum[k].mul_add(t[k], *c));
    }
    sum
}

impl Strip {
    /// Computes the polynomials over every span at each ξ \[mm\], at most [`MANY`]. The columns end at `u_max` \[mm²\].
    #[inline(always)]
    pub fn polynomials(&self, relief: &Relief<'_>, xi: &[f64], u_max: f64, spans: &mut [ColumnPolynomials]) {
        let (Interval { low: a, high: b }, mut all) = (self.xi, [xi[0]; MANY]);
        all[..xi.len()].copy_from_slice(xi);
        let t = lanes(|k| ((all[k] - a) - (b - all[k])) / (b - a));
        let n = self.coefficients;
        let mut rest = &self.powers[..];
        for (span, kept) in spans.iter_mut().zip(self.kept) {
            let (powers, others) = rest.split_at(n * kept);
            for (c, powers) in span.c[..n].iter_mut().zip(powers.chunks_exact(kept)) {
                *c = at(powers, &t);
            }
            rest = others;
        }
        let beginnings = spans.iter_mut().flat_map(|span| [&mut span.u0, &mut span.base]).skip(1);
        for (quantity, powers) in beginnings.zip(rest.chunks_exact(self.kept[0])) {
            *quantity = at(powers, &t);
        }
        let base = &mut spans[0].base;
        match self.gap {
            GapStart::Plain => {}
            GapStart::Relative => *base = lanes(|k| base[k] * (all[k] * all[k])),
            GapStart::Computed => *base = all.map(|xi| relief.midplane(xi)),
        }
        // With several spans, q was interpolated in powers of τ = v/(u_1 − u_0) and is converted to powers of v.
        let mut end = [u_max; MANY];
        for span in spans.iter_mut().rev().filter(|_| self.spans > 1) {
            let shrink: Lanes = lanes(|k| 1.0 / (end[k] - span.u0[k]));
            let mut power = [1.0; MANY];
            for c in &mut span.c[1..n] {
                power = lanes(|k| power[k] * shrink[k]);
                *c = lanes(|k| c[k] * power[k]);
            }
            end = span.u0;
        }
    }
}

/// Neighbouring columns that are to be evaluated from their polynomials over every span. If `SINGLE`, there is one span. The
/// work is compiled for each kind of machine.
pub struct Evaluation<'a, const SINGLE: bool> {
    /// Polynomials of every span, in order of u.
    pub polynomials: &'a [ColumnPolynomials],
    /// Number of their coefficients.
    pub n: usize,
    pub axis: &'a EtaAxis,
    /// s \[mm\], column by column, overwritten.
    pub out: &'a mut [f64],
}

impl<const SINGLE: bool> pulp::WithSimd for Evaluation<'_, SINGLE> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        per_degree(simd, self.n, self);
    }
}

impl<const SINGLE: bool> PerDegree for Evaluation<'_, SINGLE> {
    #[inline(always)]
    fn run<S: pulp::Simd, const N: usize>(self, simd: S, n: usize) {
        if self.axis.has_whole_halves() {
            self.outwards::<S, N>(simd, n);
        } else {
            self.whole::<S, N>(simd, n);
        }
    }
}

impl<const SINGLE: bool> Evaluation<'_, SINGLE> {
    /// Writes columns in whole vectors, from the vector that holds the first η ≥ 0 outwards, and then their mirror images.
    #[inline(always)]
    fn outwards<S: pulp::Simd, const N: usize>(self, simd: S, n: usize) {
        let Self { polynomials: spans, axis, out, .. } = self;
        let (count, lanes) = (axis.eta.len(), S::F64_LANES);
        let half = axis.first_positive - axis.first_positive % lanes;
        let (all, outer) = (&axis.u[..], &axis.u[half..]);
        // The first vector of each span: it holds the span's beginning, and also the end of the previous span.
        let mut begins = [half; MOST_SPANS];
        for (k, out) in out.chunks_exact_mut(count).enumerate() {
            if SINGLE {
                let (begin, c) = spans[0].column::<N>(k);
                whole_vectors::<S, N, true>(simd, (begin, &c[..n]), outer, &mut out[half..]);
            } else {
                for (index, span) in spans.iter().enumerate().skip(1) {
                    // The vector is mostly that of the previous column. A loop with an end that processors cannot predict
                    // takes longer.
                    let least = begins[index - 1];
                    let mut begin = begins[index].max(least);
                    while begin > least && all[begin] > span.u0[k] {
                        begin -= lanes;
                    }
                    while begin + lanes < count && all[begin + lanes] <= span.u0[k] {
                        begin += lanes;
                    }
                    begins[index] = begin;
                }
                for (index, span) in spans.iter().enumerate() {
                    let end = if index + 1 < spans.len() { begins[index + 1] + lanes } else { count };
                    let (u, out) = (&all[begins[index]..end], &mut out[begins[index]..end]);
                    let (begin, c) = span.column::<N>(k);
                    if index == 0 {
                        whole_vectors::<S, N, true>(simd, (begin, &c[..n]), u, out);
                    } else {
                        whole_vectors::<S, N, false>(simd, (begin, &c[..n]), u, out);
                    }
                }
            }
            mirror(out, half);
        }
    }

    /// Writes columns from the first η to the last one.
    #[inline(always)]
    fn whole<S: pulp::Simd, const N: usize>(self, simd: S, n: usize) {
        let Self { polynomials: spans, axis, out, .. } = self;
        let (count, all) = (axis.eta.len(), &axis.u[..]);
        let mut ends = [count; MOST_SPANS];
        for (k, out) in out.chunks_exact_mut(count).enumerate() {
            if SINGLE {
                let (begin, c) = spans[0].column::<N>(k);
                horner::<S, N, true>(simd, (begin, &c[..n]), all, out);
                continue;
            }
            for (index, span) in spans.iter().enumerate().skip(1).rev() {
                // A short span mostly lies between two values. Other spans end near their end in the previous column.
                let (u, beyond) = (span.u0[k], ends[index]);
                let near = if axis.is_end(u, beyond) { beyond } else { ends[index - 1] };
                ends[index - 1] = axis.end(u, near).min(beyond);
            }
            let mut begin = 0;
            let inwards = (1..spans.len()).rev();
            let inwards = inwards.map(|index| (index, axis.begin(spans[index].u0[k], ends[index - 1])));
            let outwards = (0..spans.len()).map(|index| (index, ends[index]));
            for (index, end) in inwards.chain(outwards) {
                if end <= begin {
                    continue;
                }
                // Only whole vectors are written. The next span overwrites the values beyond the end of this one.
                let whole = begin + (end - begin).next_multiple_of(S::F64_LANES);
                let run = begin..if whole <= count { whole } else { end };
                let (beginning, c) = spans[index].column::<N>(k);
                horner::<S, N, false>(simd, (beginning, &c[..n]), &all[run.clone()], &mut out[run]);
                begin = end;
            }
        }
    }
}
