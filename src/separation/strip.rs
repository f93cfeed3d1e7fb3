//! The columns of one strip: their quantities, and s from them, for many columns at once.

use super::axis::{EtaAxis, mirror};
use super::columns::{MANY, MOST_SPANS, Row, row};
use super::gap::midplane_gap;
use super::horner::{PerDegree, horner, per_degree, whole_vectors};
use super::spectral::MOST_COEFFICIENTS;
use crate::placement::Placement;

/// Columns over an interval of ξ, each made up of the same quantities: of every span the coefficients of q, s at its
/// beginning and u_0, all polynomials in ξ.
#[derive(Debug, Clone, PartialEq)]
pub struct Strip {
    /// Its open interval \[mm\].
    pub xi: [f64; 2],
    /// How s at the beginning of the columns is known.
    pub(super) gap: Gap,
    /// Number of spans.
    pub(super) spans: usize,
    /// Number of coefficients of q.
    pub(super) coefficients: usize,
    /// Of every quantity the coefficients of t^(kept−1), …, t⁰, t from −1 to 1 over the interval: of every span those of q, then
    /// of every span u_0, but for the first one, and s.
    pub(super) powers: Vec<f64>,
    /// Number of powers of the quantities of q by spans; of u_0 and s as many as for the first one's.
    pub(super) kept: [usize; MOST_SPANS],
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

/// The polynomials of neighbouring columns over one span: s = base + v Σ c_k v^k, v = u − u_0.
#[derive(Debug, Clone)]
pub(super) struct ColumnPolynomials {
    /// Coefficients of q.
    c: [Row; MOST_COEFFICIENTS],
    /// s at u_0 \[mm\].
    base: Row,
    /// u_0 \[mm²\].
    pub(super) u0: Row,
}

impl ColumnPolynomials {
    pub(super) const NONE: Self = Self { c: [[0.0; MANY]; _], base: [0.0; MANY], u0: [0.0; MANY] };

    /// Makes it those of columns that have no other span.
    #[inline(always)]
    pub(super) fn set(&mut self, c: &[Row], base: &Row) {
        self.c[..c.len()].copy_from_slice(c);
        (self.base, self.u0) = (*base, [0.0; MANY]);
    }

    /// s at v = u − u_0 of each column \[mm\], by so many coefficients.
    #[inline(always)]
    pub(super) fn values(&self, coefficients: usize, v: &Row) -> Row {
        let mut q = [0.0f64; MANY];
        for c in self.c[..coefficients].iter().rev() {
            q = row(|k| q[k].mul_add(v[k], c[k]));
        }
        row(|k| q[k].mul_add(v[k], self.base[k]))
    }

    /// s and u_0 at the beginning of the k-th column's span, and its first N coefficients, which are all.
    #[inline(always)]
    fn column<const N: usize>(&self, k: usize) -> ([f64; 2], [f64; N]) {
        let mut c = [0.0; N];
        for (c, row) in c.iter_mut().zip(&self.c) {
            *c = row[k];
        }
        ([self.base[k], self.u0[k]], c)
    }
}

/// Neighbouring columns of one strip, compiled for each kind of machine. A struct, since closures may be left out of
/// line, and so without the machine's widest vectors. Stored past the caches if `PAST`.
pub(super) struct StripColumns<'a, const PAST: bool> {
    pub placement: &'a Placement,
    pub strip: &'a Strip,
    /// At most [`MANY`].
    pub xi: &'a [f64],
    pub axis: &'a EtaAxis,
    /// Whether one half is the other's mirror image, and columns are whole vectors.
    pub mirrored: bool,
    /// Polynomials of every span, overwritten.
    pub scratch: &'a mut Vec<ColumnPolynomials>,
    pub out: &'a mut [f64],
}

impl<const PAST: bool> pulp::WithSimd for StripColumns<'_, PAST> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { placement, strip, xi, axis, mirrored, scratch: polynomials, out } = self;
        polynomials.resize(strip.spans, ColumnPolynomials::NONE);
        strip.polynomials(placement, xi, axis.reach * axis.reach, polynomials);
        if strip.spans == 1 {
            per_degree(
                strip.coefficients,
                Evaluation::<S, true, PAST> { simd, polynomials, axis, mirrored, out },
            );
        } else {
            per_degree(
                strip.coefficients,
                Evaluation::<S, false, PAST> { simd, polynomials, axis, mirrored, out },
            );
        }
    }
}

/// Σ c t^k at each t, the highest power first.
#[inline(always)]
fn at(powers: &[f64], t: &Row) -> Row {
    let mut sum = [0.0f64; MANY];
    for c in powers {
        sum = row(|k| sum[k].mul_add(t[k], *c));
    }
    sum
}

impl Strip {
    /// Number of coefficients of q.
    pub fn coefficients(&self) -> usize {
        self.coefficients
    }

    /// The polynomials over every span at each ξ.
    #[inline(always)]
    pub(super) fn polynomials(
        &self,
        placement: &Placement,
        xi: &[f64],
        u_max: f64,
        spans: &mut [ColumnPolynomials],
    ) {
        let ([a, b], mut all) = (self.xi, [xi[0]; MANY]);
        all[..xi.len()].copy_from_slice(xi);
        let t = row(|k| ((all[k] - a) - (b - all[k])) / (b - a));
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
            Gap::Plain => {}
            Gap::Relative => *base = row(|k| base[k] * (all[k] * all[k])),
            Gap::Computed => *base = all.map(|xi| midplane_gap(placement, xi)),
        }
        // Of several spans q is interpolated in powers of τ.
        let mut end = [u_max; MANY];
        for span in spans.iter_mut().rev().filter(|_| self.spans > 1) {
            let shrink = row(|k| 1.0 / (end[k] - span.u0[k]));
            let mut power = [1.0; MANY];
            for c in &mut span.c[1..n] {
                power = row(|k| power[k] * shrink[k]);
                *c = row(|k| c[k] * power[k]);
            }
            end = span.u0;
        }
    }
}

/// Neighbouring columns from their polynomials over every span, of which there is one if `SINGLE`.
pub(super) struct Evaluation<'a, S, const SINGLE: bool, const PAST: bool> {
    pub simd: S,
    /// In order of u.
    pub polynomials: &'a [ColumnPolynomials],
    pub axis: &'a EtaAxis,
    /// As of [`StripColumns`].
    pub mirrored: bool,
    pub out: &'a mut [f64],
}

impl<S: pulp::Simd, const SINGLE: bool, const PAST: bool> PerDegree for Evaluation<'_, S, SINGLE, PAST> {
    #[inline(always)]
    fn run<const N: usize>(self) {
        if self.mirrored {
            self.outwards::<N>();
        } else {
            self.whole::<N>();
        }
    }
}

impl<S: pulp::Simd, const SINGLE: bool, const PAST: bool> Evaluation<'_, S, SINGLE, PAST> {
    /// Columns from the vector on that holds the first η ≥ 0, in whole vectors, and their mirror images.
    #[inline(always)]
    fn outwards<const N: usize>(self) {
        let Self { simd, polynomials: spans, axis, out, .. } = self;
        let (count, lanes) = (axis.eta.len(), S::F64_LANES);
        let half = axis.first_positive - axis.first_positive % lanes;
        // Where the vectors begin that hold both a span's beginning and the end of the span before.
        let mut begins = [half; MOST_SPANS];
        for (k, out) in out.chunks_exact_mut(count).enumerate() {
            if SINGLE {
                let (begin, c) = spans[0].column(k);
                whole_vectors::<S, N, true>(simd, begin, &c, &axis.u[half..], &mut out[half..]);
            } else {
                for (index, span) in spans.iter().enumerate().skip(1) {
                    // Seldom another vector than in the column before: a loop whose end no processor foresees takes longer.
                    let least = begins[index - 1];
                    let mut begin = begins[index].max(least);
                    while begin > least && axis.u[begin] > span.u0[k] {
                        begin -= lanes;
                    }
                    while begin + lanes < count && axis.u[begin + lanes] <= span.u0[k] {
                        begin += lanes;
                    }
                    begins[index] = begin;
                }
                for (index, span) in spans.iter().enumerate() {
                    let end = if index + 1 < spans.len() { begins[index + 1] + lanes } else { count };
                    let (u, out) = (&axis.u[begins[index]..end], &mut out[begins[index]..end]);
                    let (begin, c) = span.column(k);
                    if index == 0 {
                        whole_vectors::<S, N, true>(simd, begin, &c, u, out);
                    } else {
                        whole_vectors::<S, N, false>(simd, begin, &c, u, out);
                    }
                }
            }
            mirror(out, half);
        }
    }

    /// Columns from the first η to the last one, so that memory is written in order.
    #[inline(always)]
    fn whole<const N: usize>(self) {
        let Self { simd, polynomials: spans, axis, out, .. } = self;
        let count = axis.eta.len();
        let mut ends = [count; MOST_SPANS];
        for (k, out) in out.chunks_exact_mut(count).enumerate() {
            if SINGLE {
                let (begin, c) = spans[0].column(k);
                horner::<S, N, true, PAST>(simd, begin, &c, &axis.u, out);
                continue;
            }
            for (index, span) in spans.iter().enumerate().skip(1).rev() {
                // A short span is mostly between two values; others end near where they do in the column before.
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
                // Whole vectors: what they hold beyond the span's end is overwritten by the next one.
                let whole = begin + (end - begin).next_multiple_of(S::F64_LANES);
                let run = begin..if whole <= count { whole } else { end };
                let (beginning, c) = spans[index].column(k);
                horner::<S, N, false, PAST>(simd, beginning, &c, &axis.u[run.clone()], &mut out[run]);
                begin = end;
            }
        }
    }
}
