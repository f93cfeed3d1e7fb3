//! Polynomials of single columns, and their evaluation over parts of a column by Horner's rule, with the widest vectors of
//! the machine.

use crate::numerics::chebyshev::MOST_POINTS;
use crate::numerics::lanes::WIDEST;
use crate::numerics::polynomial;

/// Most coefficients of a column. A span that needs more is close to a vertical tangent and is evaluated point by point.
pub const MOST_COEFFICIENTS: usize = MOST_POINTS;

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

    /// Its evaluation at a run of u \[mm²\].
    pub fn over<'a>(&'a self, u: &'a [f64], out: &'a mut [f64]) -> SpanRun<'a> {
        SpanRun { begin: [self.base, self.u0], c: &self.c[..self.n], u, out }
    }
}

/// Work that is compiled for each number of coefficients, so that the compiler unrolls its innermost loop.
pub trait PerDegree {
    /// Does the work with n coefficients, at most N.
    fn run<S: pulp::Simd, const N: usize>(self, simd: S, n: usize);
}

/// Calls `work` as it is compiled for n coefficients, from 1 to [`MOST_COEFFICIENTS`]. On machines without vectors one copy, with loops
/// that are not unrolled, serves all n.
#[inline(always)]
pub fn per_degree<S: pulp::Simd>(simd: S, n: usize, work: impl PerDegree) {
    if S::F64_LANES == 1 {
        return work.run::<S, MOST_COEFFICIENTS>(simd, n);
    }
    match n {
        1 => work.run::<S, 1>(simd, 1),
        2 => work.run::<S, 2>(simd, 2),
        3 => work.run::<S, 3>(simd, 3),
        4 => work.run::<S, 4>(simd, 4),
        5 => work.run::<S, 5>(simd, 5),
        6 => work.run::<S, 6>(simd, 6),
        7 => work.run::<S, 7>(simd, 7),
        8 => work.run::<S, 8>(simd, 8),
        9 => work.run::<S, 9>(simd, 9),
        10 => work.run::<S, 10>(simd, 10),
        11 => work.run::<S, 11>(simd, 11),
        _ => work.run::<S, MOST_COEFFICIENTS>(simd, MOST_COEFFICIENTS),
    }
}

/// The part of a column's u that lies over one span. Its evaluation is compiled for each kind of machine.
pub struct SpanRun<'a> {
    /// s at the beginning \[mm\], and u_0 \[mm²\].
    pub begin: [f64; 2],
    /// Coefficients of q.
    pub c: &'a [f64],
    pub u: &'a [f64],
    /// s \[mm\], overwritten.
    pub out: &'a mut [f64],
}

impl pulp::WithSimd for SpanRun<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        per_degree(simd, self.c.len(), self);
    }
}

impl PerDegree for SpanRun<'_> {
    #[inline(always)]
    fn run<S: pulp::Simd, const N: usize>(self, simd: S, n: usize) {
        horner::<S, N, false>(simd, (self.begin, &self.c[..n]), self.u, self.out);
    }
}

/// Computes base + (u − u_0) Σ c_k (u − u_0)^k over a run of u by Horner's rule, with at most N coefficients. If `FIRST`, u_0 is
/// zero.
///
/// Multiply-adds are fused on every machine (by software if need be), so that all machines give the same bits.
#[inline(always)]
pub fn horner<S: pulp::Simd, const N: usize, const FIRST: bool>(
    simd: S,
    (begin, c): ([f64; 2], &[f64]),
    u: &[f64],
    out: &mut [f64],
) {
    let polynomial = Splat::<S, N, FIRST>::new(simd, begin, c);
    let Some(last) = u.len().checked_sub(S::F64_LANES) else {
        return polynomial.few(u, out);
    };
    polynomial.vectors(u, out);
    // The vector that fills the end overlaps the others.
    if !u.len().is_multiple_of(S::F64_LANES) {
        polynomial.vectors(&u[last..], &mut out[last..]);
    }
}

/// Computes Horner's rule over whole vectors. Values up to u_0 in the first vector stay unchanged, unless `FIRST` (u_0 is
/// zero).
#[inline(always)]
pub fn whole_vectors<S: pulp::Simd, const N: usize, const FIRST: bool>(
    simd: S,
    (begin, c): ([f64; 2], &[f64]),
    u: &[f64],
    out: &mut [f64],
) {
    let polynomial = Splat::<S, N, FIRST>::new(simd, begin, c);
    let before = S::as_simd_f64s(out).0.first().copied();
    polynomial.vectors(u, out);
    if !FIRST
        && let (Some(before), Some(s), Some(&u)) =
            (before, S::as_mut_simd_f64s(out).0.first_mut(), S::as_simd_f64s(u).0.first())
    {
        *s = simd.select_f64s(simd.greater_than_f64s(u, polynomial.u0), *s, before);
    }
}

/// A polynomial of one column, ready for vectors: every lane of a vector holds the same number. It is filled by a loop, because the
/// compiler may not inline closures.
struct Splat<S: pulp::Simd, const N: usize, const FIRST: bool> {
    simd: S,
    base: S::f64s,
    u0: S::f64s,
    c: [S::f64s; N],
    n: usize,
}

impl<S: pulp::Simd, const N: usize, const FIRST: bool> Splat<S, N, FIRST> {
    #[inline(always)]
    fn new(simd: S, [base, u0]: [f64; 2], c: &[f64]) -> Self {
        let mut splat = [simd.splat_f64s(0.0); N];
        for (splat, c) in splat.iter_mut().zip(c) {
            *splat = simd.splat_f64s(*c);
        }
        Self { simd, base: simd.splat_f64s(base), u0: simd.splat_f64s(u0), c: splat, n: c.len() }
    }

    /// Computes s \[mm\] at u \[mm²\] in whole vectors; values beyond the last whole one stay unchanged.
    #[inline(always)]
    fn vectors(&self, u: &[f64], out: &mut [f64]) {
        for (s, &u) in S::as_mut_simd_f64s(out).0.iter_mut().zip(S::as_simd_f64s(u).0) {
            *s = self.value(u);
        }
    }

    /// Computes fewer values than a vector holds.
    #[inline(always)]
    fn few(&self, u: &[f64], out: &mut [f64]) {
        let [mut vector, mut s] = [[0.0; WIDEST]; 2];
        vector[..u.len()].copy_from_slice(u);
        self.vectors(&vector, &mut s);
        out.copy_from_slice(&s[..u.len()]);
    }

    /// Computes one vector of values.
    #[inline(always)]
    fn value(&self, u: S::f64s) -> S::f64s {
        let v = if FIRST { u } else { self.simd.sub_f64s(u, self.u0) };
        let mut q = self.c[self.n - 1];
        for &c in self.c[..self.n - 1].iter().rev() {
            q = self.simd.mul_add_f64s(q, v, c);
        }
        self.simd.mul_add_f64s(q, v, self.base)
    }
}
