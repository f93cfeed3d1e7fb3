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
use crate::numerics::chebyshev::{self, extrema, powers, unit_nodes};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, every, lanes, largest, smallest};
use crate::numerics::nan_max;
use crate::separation::{
    ColumnPolynomial, Demand, EtaAxis, MOST_COEFFICIENTS, ROUNDING_LEVEL, SMALL_SHARE, interpolate, mirror,
};

/// Number of columns of one block, which is the unit of work of a thread. Each block begins anew, so that any number of
/// threads gives the same bits.
const BLOCK: usize = MANY;

/// Most points of a grid that is filled by one thread, because waking another takes some 50 µs.
const FEW_POINTS: usize = 65536;

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
    if let Some(under) = &gap.under {
        let mut falls = vec![f64::NAN; out.len()];
        let error = fill_normal_gap(under, sigma, axis, tolerance, &mut falls);
        let above = fill_over_profile(gap, sigma, axis, tolerance, out);
        out.iter_mut().zip(falls).for_each(|(t, fall)| *t += fall);
        return above + error;
    }
    fill_over_profile(gap, sigma, axis, tolerance, out)
}

/// Writes the gap \[mm\] of the wheel over the lower body's profile; returns the largest truncation error \[mm\].
fn fill_over_profile(
    gap: &NormalGap<'_>,
    sigma: &[f64],
    axis: &EtaAxis,
    tolerance: f64,
    out: &mut [f64],
) -> f64 {
    let length = axis.eta().len();
    let demand = Demand::for_tolerance(tolerance).on_truncation();
    let block = |(out, sigma): (&mut [f64], &[f64])| {
        let mut columns = BlockColumns::new(gap, axis, demand);
        columns.fill(sigma, out);
        columns.error
    };
    if out.len() <= FEW_POINTS {
        return out.chunks_mut(BLOCK * length).zip(sigma.chunks(BLOCK)).map(block).fold(0.0, f64::max);
    }
    let blocks = out.par_chunks_mut(BLOCK * length).zip(sigma.par_chunks(BLOCK));
    blocks.map(block).reduce(|| 0.0, f64::max)
}

/// The columns of one block.
struct BlockColumns<'g, 'a> {
    gap: &'g NormalGap<'a>,
    axis: &'g EtaAxis,
    demand: Demand,
    arch: pulp::Arch,
    /// Number of coefficients that sufficed last.
    count: usize,
    /// Largest measured truncation error \[mm\].
    error: f64,
}

impl<'g, 'a> BlockColumns<'g, 'a> {
    fn new(gap: &'g NormalGap<'a>, axis: &'g EtaAxis, demand: Demand) -> Self {
        Self { gap, axis, demand, arch: pulp::Arch::new(), count: FIRST_COUNT, error: 0.0 }
    }

    /// Fills the columns of all σ of the block.
    fn fill(&mut self, sigma: &[f64], out: &mut [f64]) {
        out.fill(f64::NAN);
        let rail: Vec<Option<RailPoint>> = sigma.iter().map(|&sigma| self.gap.rail.point(sigma)).collect();
        let length = self.axis.eta().len();
        let skewed = self.gap.placement.skew() != 0.0;
        let ends = if skewed { vec![SEARCHED; sigma.len()] } else { self.all_plain(&rail, out) };
        for ((at, end), out) in rail.iter().zip(ends).zip(out.chunks_mut(length)) {
            let Some(at) = at else { continue };
            if skewed {
                self.skewed(at, self.axis.eta(), out);
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
        if self.axis.symmetric {
            mirror(out, self.axis.first_positive);
        }
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

    /// Fills a part of a column of a skewed wheel.
    fn skewed(&mut self, at: &RailPoint, eta: &[f64], out: &mut [f64]) {
        if eta.len() <= MANY {
            return self.singly(at, eta, out);
        }
        let Some(Interval { low: least, high: most }) = self.interpolated(at, eta, out) else {
            let (eta, out) = (eta.split_at(eta.len() / 2), out.split_at_mut(eta.len() / 2));
            self.skewed(at, eta.0, out.0);
            return self.skewed(at, eta.1, out.1);
        };
        // A parabola falls by less than that share between two Chebyshev points.
        if least > 2.0 * SMALL_SHARE * most {
            return;
        }
        let is_small = |t: &f64| t.abs() < SMALL_SHARE * most;
        let (Some(begin), Some(end)) = (out.iter().position(is_small), out.iter().rposition(is_small)) else {
            return;
        };
        let small = begin..end + 1;
        if small.len() <= eta.len() / 2 {
            self.skewed(at, &eta[small.clone()], &mut out[small]);
        } else {
            self.singly(at, &eta[small.clone()], &mut out[small]);
        }
    }

    fn singly(&self, at: &RailPoint, eta: &[f64], out: &mut [f64]) {
        for (t, &eta) in out.iter_mut().zip(eta) {
            *t = point(&self.gap.bodies.ray(at, eta)).map_or(f64::NAN, |point| point.t);
        }
    }

    /// Interpolates t over an interval of η. Returns the least and the largest |t| at the Chebyshev points, or `None` where
    /// t does not lie over one branch of the wheel or one polynomial does not reach the demand.
    fn interpolated(&mut self, at: &RailPoint, eta: &[f64], out: &mut [f64]) -> Option<Interval> {
        let interval = Interval::new(*eta.first()?, *eta.last()?);
        let bodies = &self.gap.bodies;
        let (dropped, least, most) =
            self.arch.dispatch(Interpolation { bodies, at, interval, demand: self.demand, eta, out })?;
        self.error = self.error.max(dropped);
        Some(Interval::new(least, most))
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

/// Interpolation of a part of a skewed column. The work is compiled for each kind of machine.
struct Interpolation<'w, 'a> {
    bodies: &'w RayBodies<'a>,
    at: &'w RailPoint,
    /// The interval of η \[mm\].
    interval: Interval,
    demand: Demand,
    eta: &'w [f64],
    out: &'w mut [f64],
}

impl pulp::WithSimd for Interpolation<'_, '_> {
    type Output = Option<(f64, f64, f64)>;

    /// Returns the sum of the dropped coefficients, and the least and the largest |t| at the Chebyshev points.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Option<(f64, f64, f64)> {
        let Self { bodies, at, interval, demand, eta, out } = self;
        let (centre, half) = (interval.middle(), interval.width() / 2.0);
        let nodes = &*chebyshev::NODES;
        let RayPoints { t, abscissae, piece, over_contact } =
            points(bodies, at, &lanes(|k| centre + half * nodes[k]))?;
        // The abscissa is nearly a parabola in η: a turn between two points moves it by less than the step between others.
        let margin = abscissae.windows(2).fold(0.0, |most: f64, pair| most.max((pair[1] - pair[0]).abs()));
        let inner = piece.grown(-margin);
        if !every::<MANY>(|k| inner.contains(abscissae[k])) {
            return None;
        }
        let size = largest(&t);
        let rounding = if over_contact { ROUNDING_LEVEL * size } else { bodies.rounding() };
        let allowed = demand.absolute.min(demand.relative * size);
        let dropped = interpolate(simd, &t, interval, [allowed, rounding], eta, out)?;
        Some((dropped, smallest(&t), size))
    }
}
