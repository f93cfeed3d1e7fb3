//! Runs of a column by Horner's rule, with the widest vectors of the machine.

use std::array::from_fn;

use super::spectral::{ColumnPolynomial, MOST_COEFFICIENTS};
use super::stream;

/// Values of the widest vector, and of a line of the cache.
const LINE: usize = 8;

/// Runs from this length on are stored line by line of the cache.
const LONG_RUN: usize = 64;

/// One run of a column's u.
pub(super) struct Run<'a> {
    pub fit: &'a ColumnPolynomial,
    /// \[mm²\].
    pub u: &'a [f64],
    /// s \[mm\].
    pub out: &'a mut [f64],
}

impl pulp::WithSimd for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { fit, u, out } = self;
        evaluate::<S, false>(simd, [fit.base, fit.u0], &fit.c[..fit.n], u, out);
    }
}

/// base + (u − u_0) Σ c_k (u − u_0)^k by Horner's rule over a run of u, unrolled for the degree, with the widest vectors
/// of the machine. Multiply-adds are fused on every machine, be it in software: the same bits everywhere. Long runs are
/// stored past the caches if `PAST`.
#[inline(always)]
pub(super) fn evaluate<S: pulp::Simd, const PAST: bool>(
    simd: S,
    begin: [f64; 2],
    c: &[f64],
    u: &[f64],
    out: &mut [f64],
) {
    if begin[1] == 0.0 {
        of_degree::<S, true, PAST>(simd, begin, c, u, out)
    } else {
        of_degree::<S, false, PAST>(simd, begin, c, u, out)
    }
}

/// [`evaluate`] where u_0 is zero, and where it is not.
#[inline(always)]
fn of_degree<S: pulp::Simd, const FIRST: bool, const PAST: bool>(
    simd: S,
    begin: [f64; 2],
    c: &[f64],
    u: &[f64],
    out: &mut [f64],
) {
    match c.len() {
        1 => horner::<S, 1, FIRST, PAST>(simd, begin, c, u, out),
        2 => horner::<S, 2, FIRST, PAST>(simd, begin, c, u, out),
        3 => horner::<S, 3, FIRST, PAST>(simd, begin, c, u, out),
        4 => horner::<S, 4, FIRST, PAST>(simd, begin, c, u, out),
        5 => horner::<S, 5, FIRST, PAST>(simd, begin, c, u, out),
        6 => horner::<S, 6, FIRST, PAST>(simd, begin, c, u, out),
        7 => horner::<S, 7, FIRST, PAST>(simd, begin, c, u, out),
        8 => horner::<S, 8, FIRST, PAST>(simd, begin, c, u, out),
        9 => horner::<S, 9, FIRST, PAST>(simd, begin, c, u, out),
        10 => horner::<S, 10, FIRST, PAST>(simd, begin, c, u, out),
        11 => horner::<S, 11, FIRST, PAST>(simd, begin, c, u, out),
        _ => horner::<S, MOST_COEFFICIENTS, FIRST, PAST>(simd, begin, c, u, out),
    }
}

#[inline(always)]
fn horner<S: pulp::Simd, const N: usize, const FIRST: bool, const PAST: bool>(
    simd: S,
    [base, u0]: [f64; 2],
    c: &[f64],
    u: &[f64],
    out: &mut [f64],
) {
    let Some(last) = u.len().checked_sub(S::F64_LANES) else {
        for (s, u) in out.iter_mut().zip(u) {
            let v = u - u0;
            *s = c[..N].iter().rev().fold(0.0, |q: f64, c| q.mul_add(v, *c)).mul_add(v, base);
        }
        return;
    };
    let c: [S::f64s; N] = from_fn(|k| simd.splat_f64s(c[k]));
    let begin = [base, u0].map(|value| simd.splat_f64s(value));
    // Long runs are stored where lines of the cache begin: a store across two takes twice as long. The vectors at both
    // ends, as many as reach there, may overlap the others.
    let (end, long) = (u.len(), u.len() >= LONG_RUN);
    let begin_lines = if long { lead(out) } else { 0 };
    let first = begin_lines.next_multiple_of(S::F64_LANES);
    for part in [0..first, last..end] {
        let (u, out) = (S::as_simd_f64s(&u[part.clone()]).0, S::as_mut_simd_f64s(&mut out[part]).0);
        for (s, &u) in out.iter_mut().zip(u) {
            *s = value::<S, N, FIRST>(simd, begin, &c, u);
        }
    }
    let (u, out) = (S::as_simd_f64s(&u[begin_lines..]).0, S::as_mut_simd_f64s(&mut out[begin_lines..]).0);
    if PAST && long {
        return stream::write(out, u.iter().map(|&u| value::<S, N, FIRST>(simd, begin, &c, u)));
    }
    for (s, &u) in out.iter_mut().zip(u) {
        *s = value::<S, N, FIRST>(simd, begin, &c, u);
    }
}

/// One vector of [`horner`]. A function, since closures may be left out of line.
#[inline(always)]
fn value<S: pulp::Simd, const N: usize, const FIRST: bool>(
    simd: S,
    [base, u0]: [S::f64s; 2],
    c: &[S::f64s; N],
    u: S::f64s,
) -> S::f64s {
    let v = if FIRST { u } else { simd.sub_f64s(u, u0) };
    let mut q = c[N - 1];
    for &c in c[..N - 1].iter().rev() {
        q = simd.mul_add_f64s(q, v, c);
    }
    simd.mul_add_f64s(q, v, base)
}

/// Number of values before the first one that begins a line of the cache.
#[inline(always)]
fn lead(values: &[f64]) -> usize {
    values.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE - 1)
}
