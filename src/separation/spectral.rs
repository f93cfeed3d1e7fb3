//! Spectral columns: q(ξ, ·) as a polynomial in u = η², one per column and branch.
//!
//! Over one branch of the wheel s = s_0 + (u − u_0) q(u), with s_0 at the branch's beginning (g(ξ) at u_0 = 0)
//! and q analytic. q is interpolated, not s: the relative accuracy of both terms survives. The nodes are
//! Chebyshev points in the sagitta e, of which u is nearly a multiple: ζ and u follow from e with no iteration.

use std::array::from_fn;

use super::Evaluator;
use super::axis::{EtaAxis, mirror};
use super::column::{NEARLY_COVERED, Span, WheelSurface};
use super::columns::{Columns, MANY, MOST_SPANS, Row};
use super::grid::Kernel;
use super::horner::{Run, per_degree};
use super::skewed::SkewedColumn;
use super::strip::{ColumnPolynomials, Evaluation, Strip, StripColumns};
use super::values::{LINE, Residence, lead};
use crate::numerics::nan_max;
use crate::placement::Placement;

/// Most coefficients of a column. A span that needs more is close to a vertical tangent, and is evaluated
/// point-wise.
pub const MOST_COEFFICIENTS: usize = 12;

/// A span below this share of its column's u, such as the closing of a drawing, starts with two coefficients.
const SHORT_SPAN: f64 = 0.01;

/// Share of a quantity that counts as rounding: more coefficients would not lower its error.
pub(super) const ROUNDING_LEVEL: f64 = 4.0 * f64::EPSILON;

/// Share of the absolute demand that truncation may use up: rounding, and what lies between a plan's samples, need the rest.
const TRUNCATION: f64 = 0.5;

/// The demand on s: |error| ≤ `absolute`, and ≤ `relative` × |(u − u_0) q|.
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
    /// Largest measured error of s \[mm\].
    pub error: f64,
}

/// Columns by interpolation to a demand.
#[derive(Debug)]
pub struct Spectral<'a> {
    pub(super) evaluator: Evaluator<'a>,
    pub(super) axis: &'a EtaAxis,
    pub(super) demand: Demand,
    pub(super) coefficients: usize,
    strips: &'a [Strip],
    pub(super) spans: Vec<Span>,
    pub(super) columns: Columns<'a>,
    /// Coefficients of columns.
    pub(super) rows: Vec<Row>,
    pub(super) polynomials: Vec<ColumnPolynomials>,
    residence: Residence,
    pub(super) arch: pulp::Arch,
    /// Largest measured truncation error so far \[mm\].
    truncation: f64,
}

impl<'a> Spectral<'a> {
    /// Over a placed pair; every column starts with `coefficients` and takes more where it needs them.
    pub fn new(placement: &'a Placement, axis: &'a EtaAxis, demand: Demand, coefficients: usize) -> Self {
        let evaluator = Evaluator::new(placement);
        Self {
            columns: Columns::new(evaluator.wheel),
            evaluator,
            axis,
            demand: Demand { absolute: TRUNCATION * demand.absolute, ..demand },
            coefficients,
            strips: &[],
            spans: Vec::new(),
            rows: Vec::with_capacity(MOST_SPANS * (MOST_COEFFICIENTS + 2)),
            polynomials: Vec::with_capacity(MOST_SPANS),
            residence: Residence::LastCache,
            arch: pulp::Arch::new(),
            truncation: 0.0,
        }
    }

    /// The same with strips for some of the columns, for an array that is there while it is filled.
    pub fn with_strips(self, strips: &'a [Strip], residence: Residence) -> Self {
        Self { strips, residence, ..self }
    }

    /// The polynomial over one span up to `u_max` with at least so many coefficients, or `None` where no degree reaches
    /// the demand.
    pub fn polynomial(&self, xi: f64, span: &Span, u_max: f64, least: usize) -> Option<ColumnPolynomial> {
        let u_end = span.u[1].min(u_max);
        let end = self.evaluator.wheel.foot_near(xi, span, u_end);
        let covered = end.u >= NEARLY_COVERED * u_end;
        if !covered || end.w <= 0.0 {
            return None;
        }
        let (wheel, base) = (&self.evaluator.wheel, self.evaluator.base(xi, 0.0, span));
        let allowed = self.demand.absolute.min(self.demand.relative * end.rise.abs());
        // A short span's rise is the difference of sagittae that are larger.
        let rounding = ROUNDING_LEVEL * (end.rise.abs() + span.e[0]);
        for n in first_count(least, u_end - span.u[0], u_max)..=MOST_COEFFICIENTS {
            let c = interpolate(wheel, xi, span, end.e, n);
            let fit = ColumnPolynomial { base: 0.0, u0: span.u[0], c, n, error: 0.0 };
            let inner = extrema(n).iter().map(|share| span.e[0] + (end.e - span.e[0]) * share);
            let feet = inner.map(|e| wheel.foot(xi, span, e)).chain([end]);
            let error = feet.map(|foot| (fit.rise(foot.u) - foot.rise).abs()).fold(0.0, nan_max);
            if error <= allowed.max(rounding) {
                return Some(ColumnPolynomial { base, error, ..fit });
            }
        }
        None
    }
}

impl Spectral<'_> {
    /// Error of a fit at u \[mm\], 0 where the wheel has no point there.
    pub(super) fn truncation(&self, xi: f64, span: &Span, fit: &ColumnPolynomial, u: f64) -> f64 {
        let foot = self.evaluator.wheel.foot_at(xi, span, u);
        foot.map_or(0.0, |foot| (fit.rise(u) - foot.rise).abs())
    }
}

impl ColumnPolynomial {
    /// ζ above the beginning of the span at u \[mm\].
    fn rise(&self, u: f64) -> f64 {
        let v = u - self.u0;
        v * self.c[..self.n].iter().rev().fold(0.0, |q, c| q * v + c)
    }
}

/// q at n nodes between the span's beginning and sagitta `e_end`, in powers of v.
fn interpolate(
    wheel: &WheelSurface<'_>,
    xi: f64,
    span: &Span,
    e_end: f64,
    n: usize,
) -> [f64; MOST_COEFFICIENTS] {
    let (mut v, mut d) = ([[0.0]; MOST_COEFFICIENTS], [[0.0]; MOST_COEFFICIENTS]);
    let width = e_end - span.e[0];
    for ((v, d), node) in v.iter_mut().zip(&mut d).zip(nodes(n)) {
        let foot = wheel.foot(xi, span, span.e[0] + width * node);
        *v = [foot.u - span.u[0]];
        *d = [foot.rise / v[0]];
    }
    powers(&v[..n], &mut d[..n]);
    d.map(|[c]| c)
}

/// Makes of the values d at the places v the coefficients of the polynomials through them, by divided differences; for N
/// at once.
#[inline(always)]
pub(super) fn powers<const N: usize>(v: &[[f64; N]], d: &mut [[f64; N]]) {
    let n = v.len();
    for order in 1..n {
        let mut rest = n;
        // Two by one division, which takes longer than some products.
        while rest >= order + 2 {
            rest -= 2;
            let [i, j] = [rest, rest + 1];
            for k in 0..N {
                let [a, b] = [v[i][k] - v[i - order][k], v[j][k] - v[j - order][k]];
                let inverse = 1.0 / (a * b);
                d[j][k] = (d[j][k] - d[i][k]) * (inverse * a);
                d[i][k] = (d[i][k] - d[i - 1][k]) * (inverse * b);
            }
        }
        if rest > order {
            for k in 0..N {
                d[order][k] = (d[order][k] - d[order - 1][k]) / (v[order][k] - v[0][k]);
            }
        }
    }
    // p_j = d_j + (v − v_j) p_(j+1), in the place of d_j, …, d_(n−1).
    for j in (0..n - 1).rev() {
        for i in j..n - 1 {
            for k in 0..N {
                d[i][k] -= v[j][k] * d[i + 1][k];
            }
        }
    }
}

/// Whether the spans are all of the column up to `u_max`.
pub(super) fn is_whole(spans: &[Span], u_max: f64) -> bool {
    spans.first().is_some_and(|span| span.e[0] == 0.0)
        && spans.last().is_some_and(|span| span.u[1] >= u_max)
        && spans.windows(2).all(|pair| pair[0].u[1] == pair[1].u[0])
}

impl Kernel for Spectral<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        if self.evaluator.placement.skew != 0.0 {
            let error = self.skewed_column(xi, &self.axis.eta, out);
            self.truncation = self.truncation.max(error);
            return;
        }
        self.single_column(xi, self.axis.reach * self.axis.reach, out);
        if self.axis.symmetric {
            mirror(out, self.axis.first_positive);
        }
    }

    fn columns(&mut self, xi: &[f64], out: &mut [f64]) {
        let length = self.axis.eta.len();
        let mut done = 0;
        while let Some(&first) = xi.get(done) {
            let rest = &xi[done..];
            let beyond = self.strips.partition_point(|strip| strip.xi[1] <= first);
            let next = self.strips.get(beyond);
            let strip = next.filter(|strip| strip.xi[0] < first);
            let count = match (strip, next) {
                (Some(strip), _) => rest.partition_point(|&xi| xi < strip.xi[1]),
                (None, Some(next)) => rest.partition_point(|&xi| xi <= next.xi[0]),
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

/// Neighbouring columns that are in no strip; those over one branch, or each over its own cubic, at once.
struct EachColumn<'s, 'a> {
    spectral: &'s mut Spectral<'a>,
    /// At most [`MANY`].
    xi: &'s [f64],
    out: &'s mut [f64],
}

impl pulp::WithSimd for EachColumn<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { spectral, xi, out } = self;
        let (axis, length, mirrored) = (spectral.axis, spectral.axis.eta.len(), spectral.mirrored(out));
        let Spectral { evaluator, demand, coefficients, columns, rows, polynomials, truncation, .. } =
            &mut *spectral;
        rows.clear();
        let mut taken = columns.take_each(evaluator, axis.reach * axis.reach, xi).unwrap_or([false; MANY]);
        if taken.contains(&true) {
            match columns.polynomials(0, *demand, *coefficients, rows) {
                Some((_, error)) => *truncation = truncation.max(error),
                None => taken = [false; MANY],
            }
        }
        if taken.contains(&true) {
            polynomials.resize(1, ColumnPolynomials::NONE);
            polynomials[0].set(rows, &columns.spans[0].base);
            per_degree(rows.len(), Evaluation::<S, true, false> { simd, polynomials, axis, mirrored, out });
        }
        for ((&xi, out), taken) in xi.iter().zip(out.chunks_exact_mut(length)).zip(taken) {
            if !taken {
                spectral.column(xi, out);
            }
        }
    }
}

impl Spectral<'_> {
    /// Whether half of such columns is to be evaluated: where they are whole lines of the cache. A store across two lines takes
    /// longer than that saves, and further off than the second cache one that goes backwards does.
    fn mirrored(&self, columns: &[f64]) -> bool {
        let lines = self.axis.eta.len().is_multiple_of(LINE) && lead(columns) == 0;
        self.axis.symmetric && lines && self.residence == Residence::SecondCache
    }

    /// At most [`MANY`] neighbouring columns, of one strip or of none.
    fn neighbours(&mut self, strip: Option<&Strip>, xi: &[f64], out: &mut [f64]) {
        let (arch, placement, axis) = (self.arch, self.evaluator.placement, self.axis);
        let (mirrored, scratch) = (self.mirrored(out), &mut self.polynomials);
        match strip {
            Some(strip) if self.residence == Residence::Memory => {
                arch.dispatch(StripColumns::<true> { placement, strip, xi, axis, mirrored, scratch, out });
            }
            Some(strip) => {
                arch.dispatch(StripColumns::<false> { placement, strip, xi, axis, mirrored, scratch, out });
            }
            None if xi.len() > 1 && placement.skew == 0.0 => {
                arch.dispatch(EachColumn { spectral: self, xi, out });
            }
            None => {
                for (&xi, out) in xi.iter().zip(out.chunks_exact_mut(axis.eta.len())) {
                    self.column(xi, out);
                }
            }
        }
    }

    /// A column of a skewed wheel; its truncation error \[mm\].
    pub(super) fn skewed_column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) -> f64 {
        let mut column = SkewedColumn::new(&mut self.evaluator, self.arch, self.demand, xi);
        column.fill(eta, out);
        column.error
    }

    /// A column that is in no strip; the half η ≥ 0 of a symmetric axis.
    fn single_column(&mut self, xi: f64, u_max: f64, out: &mut [f64]) {
        let mut spans = std::mem::take(&mut self.spans);
        self.evaluator.wheel.spans(xi, u_max, &mut spans);
        if !is_whole(&spans, u_max) {
            out.fill(f64::NAN);
        }
        for span in &spans {
            let fit = self.polynomial(xi, span, u_max, self.coefficients);
            self.truncation = fit.as_ref().map_or(0.0, |fit| fit.error).max(self.truncation);
            for range in self.axis.ranges(span.u) {
                let (u, out) = (&self.axis.u[range.clone()], &mut out[range]);
                match &fit {
                    Some(fit) => self.arch.dispatch(Run { fit, u, out }),
                    None => self.evaluator.over_span(xi, span, u, out),
                }
            }
        }
        self.spans = spans;
    }
}

/// Where in (0, 1) the error of an interpolant at n Chebyshev points is measured besides the end: at its first extremum, which is
/// the largest where q is least smooth near the beginning, and near the middle, for at the end it may happen to be zero.
pub(super) fn extrema(n: usize) -> &'static [f64] {
    // Up to three coefficients have both at once.
    &EXTREMA[n - 1][usize::from(n < 4)..]
}

/// (1 − cos(kπ/n))/2, k = 1 and n/2; for n = 1 that of v times a line through zero at ½.
static EXTREMA: std::sync::LazyLock<[[f64; 2]; MOST_COEFFICIENTS]> = std::sync::LazyLock::new(|| {
    let extremum = |k: usize, n: usize| (std::f64::consts::FRAC_PI_2 * k as f64 / n as f64).sin().powi(2);
    from_fn(|row| match row + 1 {
        1 => [0.25; 2],
        n => [extremum(1, n), extremum(n / 2, n)],
    })
});

/// The number of coefficients to start with, mostly `least`, over a span of this length of u.
pub(super) fn first_count(least: usize, length: f64, u_max: f64) -> usize {
    if length <= SHORT_SPAN * u_max { least.min(2) } else { least }
}

/// The n Chebyshev points of (0, 1), ascending.
pub(super) fn nodes(n: usize) -> &'static [f64] {
    &NODES[n - 1][..n]
}

/// Chebyshev points (1 − cos((2j + 1)π/2n))/2 of (0, 1) for n = 1 … [`MOST_COEFFICIENTS`], ascending.
static NODES: std::sync::LazyLock<[[f64; MOST_COEFFICIENTS]; MOST_COEFFICIENTS]> =
    std::sync::LazyLock::new(|| {
        from_fn(|row| {
            let n = row as f64 + 1.0;
            from_fn(|j| {
                let half = (2.0 * j as f64 + 1.0) * std::f64::consts::FRAC_PI_4 / n;
                half.sin().powi(2)
            })
        })
    });

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::placement::Pair;
    use crate::profile::measured::{self, CurveKind, Format, Options, write};
    use crate::profile::{Profile, Side, standards};
    use crate::separation::plan::{FULL_PRECISION, demand};
    use crate::separation::strips::strips;
    use crate::separation::values::Residence::{LastCache, Memory, SecondCache};
    use crate::separation::values::Values;

    /// A spline has more: so many columns beside them would be in strips.
    const FEW_JOINTS: usize = 24;

    /// s over a window, with columns beside its joints, and the largest number of spans of its strips' columns; compiled for one
    /// kind of machine, for an array that is there, so many values behind the beginning of a line.
    fn filled(
        placement: &Placement,
        count: i32,
        arch: pulp::Arch,
        (residence, behind): (Residence, usize),
    ) -> (Vec<f64>, usize) {
        let steps =
            |reach: f64, n: i32| (0..n).map(move |k| reach * f64::from(2 * k - n + 1) / f64::from(n - 1));
        let mut xi: Vec<f64> = steps(12.0, 101).collect();
        // Columns in which a joint is near η = 0.
        let beside = |joint: f64| (0..16).map(move |k| joint - 1e-6 * 1.6f64.powi(k));
        let joints = placement.joints(-12.0, 12.0);
        if joints.len() <= FEW_JOINTS {
            xi.extend(joints.into_iter().flat_map(beside));
        }
        xi.sort_by(f64::total_cmp);
        let axis = EtaAxis::new(&steps(15.0, count).collect::<Vec<_>>());
        let spectral = || {
            let spectral = Spectral::new(placement, &axis, demand(FULL_PRECISION), 4);
            Spectral { arch, ..spectral }
        };
        let strips = strips(&mut spectral(), placement, &xi, axis.reach * axis.reach);
        let mut out = Values::new(behind + xi.len() * axis.eta.len());
        spectral().with_strips(&strips, residence).columns(&xi, &mut out[behind..]);
        (out[behind..].to_vec(), strips.iter().map(|strip| strip.spans).max().unwrap_or(0))
    }

    /// A spline through points of a profile.
    fn spline(profile: &Profile, side: Side) -> Result<Profile> {
        let text = write::points(&write::sample(profile, 0.5)?, Format::Csv, side, "sample");
        let [mirror, flip_z] = [Some(false); 2];
        let options = Options { mirror, flip_z, curve: Some(CurveKind::Smoothing), ..Options::default() };
        measured::profile("sample.csv", text.as_bytes(), side, &options).map(|measured| measured.profile)
    }

    #[test]
    fn every_machine_gives_the_same_bits() -> Result<()> {
        let rail = standards::rail("UIC60")?;
        let splines = [spline(&rail, Side::Rail)?, spline(&standards::wheel("S1002")?, Side::Wheel)?];
        // A kink; and the closing of a drawing, 0.06 mm wide.
        let drawings = [rail.clone(), standards::wheel("APTA-120")?];
        let closed = [rail, standards::wheel("EN15302-A")?];
        let cases = [
            (drawings.clone(), -14.0, 0.0, 2),
            (closed, -49.6, 0.0, 3),
            (drawings, -14.0, 0.02, 0),
            (splines, -9.0, 0.0, 0),
        ];
        for ([rail, wheel], wheel_x, yaw, most_spans) in cases {
            let placement = Pair::new(rail, wheel, 460.0)?.placed(-11.0, wheel_x, yaw)?;
            // The columns of the second are whole lines: one half is the other's mirror image.
            for count in [253, 248] {
                let (plain, spans) = filled(&placement, count, pulp::Arch::Scalar, (LastCache, 1));
                assert_eq!(spans, most_spans);
                assert!(plain.iter().all(|s| s.is_finite()));
                let same = |arch| {
                    [(SecondCache, 0), (LastCache, 0), (SecondCache, 1), (Memory, 0)].into_iter().all(
                        |stored| {
                            let (other, _) = filled(&placement, count, arch, stored);
                            plain.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits())
                        },
                    )
                };
                assert!(same(pulp::Arch::Scalar) && same(pulp::Arch::new()));
                #[cfg(target_arch = "x86_64")]
                if let Some(v3) = pulp::x86::V3::try_new() {
                    assert!(same(pulp::Arch::V3(v3)));
                }
            }
        }
        Ok(())
    }
}
