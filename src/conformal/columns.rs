//! Fills grids of the normal gap: t(σ, ·) as polynomials, column by column.
//!
//! Without skew t over one segment of the wheel is t₀ + v q(v), v = u − u₀, u = η². q is interpolated at Chebyshev points of
//! the sagitta, all of one column at once. With skew t is interpolated in η itself over intervals that are halved as needed.

use rayon::prelude::*;

use super::arc_length::RailPoint;
use super::gap::NormalGap;
use super::ray::{Ray, RayBodies};
use super::sight::{point, searched};
use super::span::{RayPoints, RaySpan, SpanReach, points};
use crate::numerics::chebyshev::{extrema, powers, unit_nodes};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, lanes, largest};
use crate::numerics::nan_max;
use crate::separation::{
    AlongEta, BLOCK, ColumnPolynomial, Demand, EtaAxis, Kernel, MOST_COEFFICIENTS, ROUNDING_LEVEL, ReliefSum,
    chebyshev_points, fill_all, inside_piece, interpolate, mirror,
};

/// The end of columns of a skewed wheel: no point is missing, because each was searched for.
const SEARCHED: f64 = f64::NEG_INFINITY;

/// Number of coefficients that the first column of a block begins with.
const FIRST_COUNT: usize = 4;

/// Writes t \[mm\] over a grid of σ and η, at index i_σ · n_η + i_η; NaN where t is undefined. The tolerance \[mm\] is that
/// of s: at and below [`crate::separation::FULL_PRECISION`] all digits near C are kept. Returns the largest truncation error
/// \[mm\] that was measured meanwhile.
///
/// With a body that varies every point is computed by itself, and 0 is returned.
///
/// It runs on the threads of the current rayon pool. Any number of threads gives the same bits.
pub fn fill_normal_gap(
    gap: &NormalGap<'_>,
    sigma: &[f64],
    axis: &EtaAxis,
    tolerance: f64,
    out: &mut [f64],
) -> f64 {
    let length = axis.eta().len();
    if length == 0 {
        return 0.0;
    }
    if gap.placement.lofted().is_some() {
        out.par_chunks_mut(length).zip(sigma).for_each(|(out, &sigma)| {
            let mut column = gap.column(sigma);
            for (t, &eta) in out.iter_mut().zip(axis.eta()) {
                *t = column.as_mut().map_or(f64::NAN, |column| gap.gap_in(column, eta));
            }
        });
        return 0.0;
    }
    let demand = Demand::for_tolerance(tolerance).on_truncation();
    let kernel = || -> Box<dyn Kernel + '_> {
        let above = Columns::new(gap, axis, demand);
        match &gap.under {
            Some(under) => {
                Box::new(ReliefSum::new(Box::new(above), Box::new(Columns::new(under, axis, demand))))
            }
            None => Box::new(above),
        }
    };
    fill_all(kernel, true, sigma, out)
}

/// The columns of t over the profile of the lower body.
struct Columns<'g, 'a> {
    gap: &'g NormalGap<'a>,
    axis: &'g EtaAxis,
    demand: Demand,
    arch: pulp::Arch,
    /// Number of coefficients that sufficed last.
    count: usize,
    /// Largest measured truncation error \[mm\].
    error: f64,
}

impl<'g, 'a> Columns<'g, 'a> {
    fn new(gap: &'g NormalGap<'a>, axis: &'g EtaAxis, demand: Demand) -> Self {
        Self { gap, axis, demand, arch: pulp::Arch::new(), count: FIRST_COUNT, error: 0.0 }
    }
}

impl Kernel for Columns<'_, '_> {
    fn column(&mut self, sigma: f64, out: &mut [f64]) {
        self.columns(&[sigma], out);
    }

    fn columns(&mut self, sigma: &[f64], out: &mut [f64]) {
        let length = self.axis.eta().len();
        for (sigma, out) in sigma.chunks(BLOCK).zip(out.chunks_mut(BLOCK * length)) {
            // Each block begins anew, so that any number of threads gives the same bits.
            self.count = FIRST_COUNT;
            self.block(sigma, out);
        }
    }

    fn truncation(&self) -> f64 {
        self.error
    }
}

impl Columns<'_, '_> {
    /// Fills the columns of at most [`BLOCK`] σ.
    fn block(&mut self, sigma: &[f64], out: &mut [f64]) {
        out.fill(f64::NAN);
        let rail: Vec<Option<RailPoint>> = sigma.iter().map(|&sigma| self.gap.rail.point(sigma)).collect();
        let length = self.axis.eta().len();
        let skewed = self.gap.placement.skew() != 0.0;
        let ends = if skewed { vec![SEARCHED; sigma.len()] } else { self.all_plain(&rail, out) };
        for ((at, end), out) in rail.iter().zip(ends).zip(out.chunks_mut(length)) {
            let Some(at) = at else { continue };
            if skewed {
                let (bodies, demand, arch) = (&self.gap.bodies, self.demand, self.arch);
                let mut column = SkewedRays { bodies, at, demand, arch, error: self.error };
                column.fill(self.axis.eta(), out);
                self.error = column.error;
            }
            self.complete(at, end, out);
        }
    }

    /// Fills the columns of the block over a wheel without skew. Returns for each the u \[mm²\] beyond which it has no points.
    fn all_plain(&mut self, rail: &[Option<RailPoint>], out: &mut [f64]) -> Vec<f64> {
        let columns = out.chunks_mut(self.axis.eta().len());
        let rays: Vec<Option<Ray<'_>>> =
            rail.iter().map(|at| at.as_ref().map(|at| self.gap.bodies.ray(at, 0.0))).collect();
        let all: Option<[Ray<'_>; BLOCK]> =
            rays.iter().copied().collect::<Option<Vec<_>>>().and_then(|rays| rays.try_into().ok());
        match all {
            Some(rays) => {
                let firsts = self.arch.dispatch(Firsts(&rays));
                firsts.into_iter().zip(columns).map(|(first, out)| self.plain(first, out)).collect()
            }
            None => {
                let firsts = rays.iter().map(|ray| ray.as_ref().and_then(RaySpan::first));
                firsts.zip(columns).map(|(first, out)| self.plain(first, out)).collect()
            }
        }
    }

    /// Finds the points of a column that lie over none of its spans, and those at which the rail's point is on the other side of
    /// the wheel's profile than at the beginning of a span. Beyond the u \[mm²\] of `end` none are missing.
    fn complete(&self, at: &RailPoint, end: f64, out: &mut [f64]) {
        let bodies = &self.gap.bodies;
        // All at once: hardly any column has such a point.
        if !bodies.has_steps() && out.iter().fold(true, |all, t| all & (*t >= 0.0)) {
            return;
        }
        let [stepped, ends] = bodies.edges_over(at, self.axis.eta());
        let undefined = out.iter().fold(false, |any, t| any | t.is_nan());
        if !stepped && !ends && !undefined {
            return;
        }
        for (t, &eta) in out.iter_mut().zip(self.axis.eta()) {
            let ray = || bodies.ray(at, eta);
            let missing = t.is_nan() && eta * eta <= end;
            let doubtful = stepped || (ends && *t < 0.0);
            if missing || (doubtful && !ray().begins_on_side(*t)) {
                *t = searched(&ray()).map_or(f64::NAN, |point| point.t);
            }
        }
    }

    /// Fills a column of a wheel without skew from its first span. Returns the u \[mm²\] at which it leaves the wheel by the end of
    /// the profile; infinite where it does not.
    fn plain(&mut self, first: Option<RaySpan<'_>>, out: &mut [f64]) -> f64 {
        let (mut next, reach) = (first, self.axis.reach);
        let (mut from, mut end) = (0.0, f64::INFINITY);
        while let Some(span) = next {
            let SpanReach { run, u } = span.reach(from, reach);
            if u.has_width() || u.low == 0.0 {
                self.over_span(&span, run, u, out);
            }
            from = u.high;
            if span.is_last() {
                end = from;
            }
            next = if from < reach * reach { span.next() } else { None };
        }
        mirror(out, self.axis.mirrored_count());
        end
    }

    /// Evaluates one span between two u \[mm²\], by its polynomial or else point by point.
    fn over_span(&mut self, span: &RaySpan<'_>, run: f64, u: Interval, out: &mut [f64]) {
        let fitter = SpanFit { span, run, demand: self.demand, least: self.count };
        let fit = self.arch.dispatch(fitter);
        if let Some(fit) = &fit {
            self.count = fit.n;
            self.error = self.error.max(fit.error);
        }
        for range in self.axis.ranges(u) {
            match &fit {
                Some(fit) => {
                    self.arch.dispatch(fit.over(&self.axis.u[range.clone()], &mut out[range]));
                }
                None => {
                    for k in range {
                        let point = span.point_at(self.axis.eta()[k]);
                        out[k] = point.map_or(f64::NAN, |point| point.t);
                    }
                }
            }
        }
    }
}

/// The first spans of the columns of a block. The work is compiled for each kind of machine.
struct Firsts<'r, 'a>(&'r [Ray<'a>; BLOCK]);

impl<'a> pulp::WithSimd for Firsts<'_, 'a> {
    type Output = [Option<RaySpan<'a>>; BLOCK];

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        RaySpan::firsts(self.0)
    }
}

/// The fit of one span. The work is compiled for each kind of machine.
struct SpanFit<'f, 'a> {
    span: &'f RaySpan<'a>,
    /// e at the end less e at the beginning \[mm\].
    run: f64,
    demand: Demand,
    /// Number of coefficients to begin with.
    least: usize,
}

impl pulp::WithSimd for SpanFit<'_, '_> {
    type Output = Option<ColumnPolynomial>;

    /// Fits q in powers of v. Returns `None` if no degree reaches the demand, near a vertical tangent.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Option<ColumnPolynomial> {
        // Half the lanes hold the nodes of low degrees, and the places where the error is measured.
        // A closure would be compiled apart, for the least of machines.
        for n in self.least..=MOST_COEFFICIENTS {
            let few = n + extrema(n).len() < MANY / 2;
            let fit = if few { self.attempt::<{ MANY / 2 }>(n) } else { self.attempt::<MANY>(n) };
            if fit.is_some() {
                return fit;
            }
        }
        None
    }
}

impl SpanFit<'_, '_> {
    /// Fits n coefficients, with N lanes for the nodes and for the places where the error is measured. Returns `None` if the
    /// error is above the demand.
    #[inline(always)]
    fn attempt<const N: usize>(&self, n: usize) -> Option<ColumnPolynomial> {
        let Self { span, run, demand, .. } = *self;
        // The nodes, then places between nodes, then the end.
        let (nodes, between) = (unit_nodes(n), extrema(n));
        let runs: Lanes<N> = lanes(|k| {
            let inner = if k < n { nodes.get(k) } else { between.get(k - n) };
            run * inner.copied().unwrap_or(1.0)
        });
        let [runs, rise] = span.rises_by(&runs)?;
        let v = span.u_above(&runs, &rise);
        let (mut places, mut q) = ([[0.0; 1]; MOST_COEFFICIENTS], [[0.0; 1]; MOST_COEFFICIENTS]);
        for k in 0..n {
            (places[k], q[k]) = ([v[k]], [rise[k] / v[k]]);
        }
        powers(&places[..n], &mut q[..n]);
        let value = |k: usize| q[..n].iter().rev().fold(0.0, |sum, [q]| sum * v[k] + q);
        let error = (n..N).map(|k| (value(k) * v[k] - rise[k]).abs()).fold(0.0, nan_max);
        // The comparison is false for an error that is NaN.
        if error <= demand.allowed(rise[N - 1], span.e0()) {
            return Some(ColumnPolynomial {
                base: span.base(),
                u0: span.u0(),
                c: *q.as_flattened().first_chunk()?,
                n,
                error,
            });
        }
        None
    }
}

/// The rays of one σ to a skewed wheel: a column of t.
struct SkewedRays<'w, 'a> {
    bodies: &'w RayBodies<'a>,
    at: &'w RailPoint,
    demand: Demand,
    arch: pulp::Arch,
    /// Largest truncation error so far \[mm\].
    error: f64,
}

impl AlongEta for SkewedRays<'_, '_> {
    fn at_once(&mut self, eta: &[f64], out: &mut [f64]) -> Option<Interval> {
        if eta.len() <= MANY {
            return None;
        }
        let (size, dropped) = self.arch.dispatch(Interpolation { column: self, eta, out })?;
        self.error = self.error.max(dropped);
        Some(size)
    }

    fn singly(&mut self, eta: &[f64], out: &mut [f64]) {
        for (t, &eta) in out.iter_mut().zip(eta) {
            *t = point(&self.bodies.ray(self.at, eta)).map_or(f64::NAN, |point| point.t);
        }
    }
}

/// Interpolation of a part of a skewed column. The work is compiled for each kind of machine.
struct Interpolation<'i, 'w, 'a> {
    column: &'i SkewedRays<'w, 'a>,
    eta: &'i [f64],
    out: &'i mut [f64],
}

impl pulp::WithSimd for Interpolation<'_, '_, '_> {
    type Output = Option<(Interval, f64)>;

    /// Returns the magnitudes of t at the Chebyshev points, and the sum of the dropped coefficients.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Self::Output {
        let Self { column: &SkewedRays { bodies, at, demand, .. }, eta, out } = self;
        let over = Interval::new(*eta.first()?, *eta.last()?);
        let RayPoints { t, abscissae, piece, over_contact } = points(bodies, at, &chebyshev_points(over))?;
        if !inside_piece(piece, &abscissae, true) {
            return None;
        }
        let rounding = if over_contact { ROUNDING_LEVEL * largest(&t) } else { bodies.rounding() };
        interpolate(simd, &t, over, (demand, rounding), eta, out)
    }
}
