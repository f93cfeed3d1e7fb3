//! Polynomials of single columns, and their evaluation over parts of a column by Horner's rule, with the widest vectors of
//! the machine.

use super::stream;
use crate::numerics::chebyshev::MOST_POINTS;
use crate::numerics::polynomial;
use crate::separation::values::{LINE, lead};

/// Most coefficients of a column. A span that needs more is close to a vertical tangent and is evaluated point by point.
pub const MOST_COEFFICIENTS: usize = MOST_POINTS;

/// Least number of values of a run that is stored whole cache line by cache line: for arrays in the caches, and for larger
/// ones. Grids with shorter runs fit into the second cache, where nothing is gained.
const LONG_RUNS: [usize; 2] = [512, 64];

/// A polynomial s = base + v Σ c_k v^k over one span of a column, v = u − u_0.
#[derive(Debug, Clone, Copy)]
pub struct ColumnPolynomial {
    /// s at the beginning of the span \[mm\].
    pub base: f64,
    /// u_0 \[mm²\].
    pub u0: f64,
    /// Coefficients of q.
    pub c: [f64; MOST_COEFFICIENTS],
    /// Number of coefficients in use.
    pub n: usize,
    /// Largest measured error of s \[mm\].
    pub error: f64,
}

impl ColumnPolynomial {
    /// Computes ζ of the wheel above its value at the beginning of the span \[mm\], at u \[mm²\].
    pub fn rise(&self, u: f64) -> f64 {
        let v = u - self.u0;
        v * polynomial::value(&self.c[..self.n], v)
    }
}

/// Work that is compiled for each number of coefficients, so that the compiler unrolls its innermost loop.
pub trait PerDegree {
    /// Does the work with N coefficients.
    fn run<const N: usize>(self);
}

/// Calls `work` compiled for n coefficients; n is at most [`MOST_COEFFICIENTS`].
#[inline(always)]
pub fn per_degree(n: usize, work: impl PerDegree) {
    match n {
        1 => work.run::<1>(),
        2 => work.run::<2>(),
        3 => work.run::<3>(),
        4 => work.run::<4>(),
        5 => work.run::<5>(),
        6 => work.run::<6>(),
        7 => work.run::<7>(),
        8 => work.run::<8>(),
        9 => work.run::<9>(),
        10 => work.run::<10>(),
        11 => work.run::<11>(),
        _ => work.run::<MOST_COEFFICIENTS>(),
    }
}

/// The part of a column's u that lies over one span. Its evaluation is compiled for each kind of machine.
pub struct SpanRun<'a> {
    pub fit: &'a ColumnPolynomial,
    pub u: &'a [f64],
    /// s \[mm\], overwritten.
    pub out: &'a mut [f64],
}

impl pulp::WithSimd for SpanRun<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { fit, u, out } = self;
        per_degree(fit.n, OneRun { simd, begin: [fit.base, fit.u0], c: &fit.c, u, out });
    }
}

/// The evaluation of one polynomial over a run of values.
pub struct OneRun<'a, S> {
    pub simd: S,
    /// s at the beginning \[mm\], and u_0 \[mm²\].
    pub begin: [f64; 2],
    /// Coefficients: at least as many as the compiled work uses.
    pub c: &'a [f64],
    pub u: &'a [f64],
    pub out: &'a mut [f64],
}

impl<S: pulp::Simd> PerDegree for OneRun<'_, S> {
    #[inline(always)]
    fn run<const N: usize>(self) {
        let mut c = [0.0; N];
        c.copy_from_slice(&self.c[..N]);
        horner::<S, N, false, false>(self.simd, self.begin, &c, self.u, self.out);
    }
}

/// Computes base + (u − u_0) Σ c_k (u − u_0)^k over a run of u by Horner's rule. If `FIRST`, u_0 is zero.
///
/// Multiply-adds are fused on every machine (by software if need be), so that all machines give the same bits. If `PAST`,
/// long runs are stored past the caches.
#[inline(always)]
pub fn horner<S: pulp::Simd, const N: usize, const FIRST: bool, const PAST: bool>(
    simd: S,
    [base, u0]: [f64; 2],
    c: &[f64; N],
    u: &[f64],
    out: &mut [f64],
) {
    let Some(last) = u.len().checked_sub(S::F64_LANES) else {
        return singly([base, u0], c, u, out);
    };
    let (begin, splat) = splats(simd, [base, u0], c);
    // Stores of long runs begin at cache lines, because a store across two lines takes twice as long. The vectors that fill
    // the two ends may overlap the others.
    let (end, long) = (u.len(), u.len() >= LONG_RUNS[usize::from(PAST)]);
    let begin_lines = if long { lead(out) } else { 0 };
    if PAST && long {
        // Lines that partly belong to a neighbouring column are stored through the caches; all others past them. No line is
        // stored in both ways.
        let end_lines = end - (end - begin_lines) % LINE;
        for part in [0..begin_lines, end_lines..end] {
            singly([base, u0], c, &u[part.clone()], &mut out[part]);
        }
        let u = S::as_simd_f64s(&u[begin_lines..end_lines]).0;
        let out = S::as_mut_simd_f64s(&mut out[begin_lines..end_lines]).0;
        return stream::write(out, u.iter().map(|&u| value::<S, N, FIRST>(simd, begin, &splat, u)));
    }
    let first = begin_lines.next_multiple_of(S::F64_LANES);
    let rest = if (end - begin_lines).is_multiple_of(S::F64_LANES) { end } else { last };
    for part in [0..first, rest..end] {
        let (u, out) = (S::as_simd_f64s(&u[part.clone()]).0, S::as_mut_simd_f64s(&mut out[part]).0);
        for (s, &u) in out.iter_mut().zip(u) {
            *s = value::<S, N, FIRST>(simd, begin, &splat, u);
        }
    }
    let (u, out) = (S::as_simd_f64s(&u[begin_lines..]).0, S::as_mut_simd_f64s(&mut out[begin_lines..]).0);
    for (s, &u) in out.iter_mut().zip(u) {
        *s = value::<S, N, FIRST>(simd, begin, &splat, u);
    }
}

/// Computes Horner's rule over whole vectors. Values up to u_0 in the first vector stay unchanged, unless `FIRST` (u_0 is
/// zero).
#[inline(always)]
pub fn whole_vectors<S: pulp::Simd, const N: usize, const FIRST: bool>(
    simd: S,
    begin: [f64; 2],
    c: &[f64; N],
    u: &[f64],
    out: &mut [f64],
) {
    let (begin, splat) = splats(simd, begin, c);
    let (u, out) = (S::as_simd_f64s(u).0, S::as_mut_simd_f64s(out).0);
    let before = out.first().copied();
    for (s, &u) in out.iter_mut().zip(u) {
        *s = value::<S, N, FIRST>(simd, begin, &splat, u);
    }
    if !FIRST && let (Some(before), Some(s), Some(&u)) = (before, out.first_mut(), u.first()) {
        *s = simd.select_f64s(simd.greater_than_f64s(u, begin[1]), *s, before);
    }
}

/// Makes vectors of base, of u_0 and of the coefficients. This is a loop, because the compiler may not inline closures.
#[inline(always)]
fn splats<S: pulp::Simd, const N: usize>(
    simd: S,
    [base, u0]: [f64; 2],
    c: &[f64; N],
) -> ([S::f64s; 2], [S::f64s; N]) {
    let mut splat = [simd.splat_f64s(0.0); N];
    for (splat, c) in splat.iter_mut().zip(c) {
        *splat = simd.splat_f64s(*c);
    }
    ([simd.splat_f64s(base), simd.splat_f64s(u0)], splat)
}

/// Computes Horner's rule value by value.
#[inline(always)]
fn singly<const N: usize>([base, u0]: [f64; 2], c: &[f64; N], u: &[f64], out: &mut [f64]) {
    for (s, u) in out.iter_mut().zip(u) {
        let v = u - u0;
        *s = c.iter().rev().fold(0.0, |q: f64, c| q.mul_add(v, *c)).mul_add(v, base);
    }
}

/// Computes one vector of values. This is a function, because the compiler may not inline closures.
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
