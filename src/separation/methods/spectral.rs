//! Spectral columns: q(ξ, ·) as a polynomial in u = η². They are computed by strips, by several neighbouring columns, or
//! one by one.

use crate::numerics::interval::Interval;
use crate::numerics::lanes::MANY;
use crate::placement::Placement;
use crate::separation::axis::{EtaAxis, mirror};
use crate::separation::columns::fit::Fitter;
use crate::separation::columns::neighbours::MOST_SPANS;
use crate::separation::columns::skewed;
use crate::separation::columns::strip::{ColumnPolynomials, Evaluation, Strip, StripColumns};
use crate::separation::columns::strips::strips;
use crate::separation::demand::{Demand, FULL_PRECISION};
use crate::separation::kernel::Kernel;
use crate::separation::relief::Relief;
use crate::separation::span::Span;

/// Spectral columns that keep a demanded accuracy.
#[derive(Debug)]
pub struct Spectral<'a> {
    fitter: Fitter<'a>,
    axis: &'a EtaAxis,
    strips: &'a [Strip],
    /// Polynomials of neighbouring columns.
    polynomials: Vec<ColumnPolynomials>,
    /// Largest measured truncation error so far \[mm\].
    truncation: f64,
}

impl<'a> Spectral<'a> {
    /// Makes the method from a fitter and the strips of some of the columns.
    pub fn new(fitter: Fitter<'a>, axis: &'a EtaAxis, strips: &'a [Strip]) -> Self {
        let polynomials = Vec::with_capacity(MOST_SPANS);
        Self { fitter, axis, strips, polynomials, truncation: 0.0 }
    }
}

/// Returns whether the spans cover the whole column up to `u_max` \[mm²\].
fn is_whole(spans: &[Span], u_max: f64) -> bool {
    let mut reached = 0.0;
    let joined = spans.iter().all(|span| {
        let joined = span.u.low <= reached;
        reached = span.u.high.max(reached);
        joined
    });
    joined && !spans.is_empty() && reached >= u_max
}

/// Returns the range of u \[mm²\] over which a span is the outer one, if earlier spans reach to `reached`: open at its beginning,
/// unless that is 0. Between two spans that do not meet the wheel has no surface, and the beginning counts.
fn outer(span: &Span, reached: f64) -> Interval {
    let low = if span.u.low > reached { span.u.low.next_down() } else { reached };
    Interval { low, ..span.u }
}

impl Kernel for Spectral<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        if self.fitter.relief.is_skewed() {
            let Fitter { relief, arch, demand, .. } = &mut self.fitter;
            let error = skewed::fill(relief, (*arch, *demand), xi, &self.axis.eta, out);
            self.truncation = self.truncation.max(error);
            return;
        }
        self.single_column(xi, self.axis.reach * self.axis.reach, out);
        mirror(out, self.axis.mirrored_count());
    }

    fn columns(&mut self, xi: &[f64], out: &mut [f64]) {
        let length = self.axis.eta.len();
        let mut done = 0;
        while let Some(&first) = xi.get(done) {
            let rest = &xi[done..];
            let beyond = self.strips.partition_point(|strip| strip.xi.high <= first);
            let next = self.strips.get(beyond);
            let strip = next.filter(|strip| strip.xi.low < first);
            let count = match (strip, next) {
                (Some(strip), _) => rest.partition_point(|&xi| xi < strip.xi.high),
                (None, Some(next)) => rest.partition_point(|&xi| xi <= next.xi.low),
                (None, None) => rest.len(),
            };
            let out = &mut out[done * length..(done + count) * length];
            for (xi, out) in rest[..count].chunks(MANY).zip(out.chunks_mut(MANY * length)) {
                self.neighbours(strip, xi, out);
            }
            done += count;
        }
    }

    fn truncation(&self) -> f64 {
        self.truncation
    }
}

/// Neighbouring columns in no strip, fitted at once if possible. The work is compiled for each kind of machine.
struct EachColumn<'s, 'a> {
    spectral: &'s mut Spectral<'a>,
    /// ξ of the columns \[mm\], at most [`MANY`].
    xi: &'s [f64],
    out: &'s mut [f64],
}

impl pulp::WithSimd for EachColumn<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { spectral, xi, out } = self;
        let (axis, length) = (spectral.axis, spectral.axis.eta.len());
        let Spectral { fitter, polynomials, truncation, .. } = &mut *spectral;
        let mut taken = [false; MANY];
        if let Some((fitted, n, error)) = fitter.columns(axis.reach * axis.reach, xi) {
            (taken, *truncation) = (fitted, truncation.max(error));
            polynomials.resize(1, ColumnPolynomials::ZERO);
            polynomials[0].set(&fitter.rows, &fitter.neighbours.spans[0].base);
            simd.vectorize(Evaluation::<true> { polynomials, n, axis, out });
        }
        for ((&xi, out), taken) in xi.iter().zip(out.chunks_exact_mut(length)).zip(taken) {
            if !taken {
                spectral.column(xi, out);
            }
        }
    }
}

impl Spectral<'_> {
    /// Writes at most [`MANY`] neighbouring columns, all of one strip or all of none.
    fn neighbours(&mut self, strip: Option<&Strip>, xi: &[f64], out: &mut [f64]) {
        let (arch, axis) = (self.fitter.arch, self.axis);
        let (relief, scratch) = (&self.fitter.relief, &mut self.polynomials);
        match strip {
            Some(strip) => arch.dispatch(StripColumns { relief, strip, xi, axis, scratch, out }),
            None if xi.len() > 1 && !relief.is_skewed() => {
                arch.dispatch(EachColumn { spectral: self, xi, out })
            }
            None => {
                for (&xi, out) in xi.iter().zip(out.chunks_exact_mut(axis.eta.len())) {
                    self.column(xi, out);
                }
            }
        }
    }

    /// Writes a column that is in no strip. On a symmetric axis it writes the half η ≥ 0.
    fn single_column(&mut self, xi: f64, u_max: f64, out: &mut [f64]) {
        let mut spans = std::mem::take(&mut self.fitter.spans);
        self.fitter.relief.wheel.spans(xi, u_max, &mut spans);
        if !is_whole(&spans, u_max) {
            out.fill(f64::NAN);
        }
        let mut reached = 0.0;
        for span in &spans {
            let u = outer(span, reached);
            if u[0] > u[1] {
                continue;
            }
            reached = u[1];
            let fit = self.fitter.column(xi, span, u_max);
            self.truncation = fit.as_ref().map_or(0.0, |fit| fit.error).max(self.truncation);
            for range in self.axis.ranges(u) {
                let (u, out) = (&self.axis.u[range.clone()], &mut out[range]);
                match &fit {
                    Some(fit) => self.fitter.arch.dispatch(fit.over(u, out)),
                    None => self.fitter.relief.over_span(xi, span, u, out),
                }
            }
        }
        self.fitter.spans = spans;
    }
}

/// Fills columns of s \[mm\] by the code for one kind of machine, of which a test compares the bits. `out` has the values of one
/// column after another, at ξ \[mm\] in ascending order. Returns the largest number of spans that a column of a strip has.
///
/// Accuracy: [`FULL_PRECISION`].
pub fn columns_by(
    placement: &Placement,
    arch: pulp::Arch,
    xi: &[f64],
    axis: &EtaAxis,
    out: &mut [f64],
) -> usize {
    let demand = Demand::for_tolerance(FULL_PRECISION);
    let fitter = || Fitter { arch, ..Fitter::new(Relief::new(placement), demand, 4) };
    let strips = strips(&mut fitter(), xi, axis.reach * axis.reach);
    Spectral::new(fitter(), axis, &strips).columns(xi, out);
    strips.iter().map(|strip| strip.spans).max().unwrap_or(0)
}
