//! Spectral columns: q(ξ, ·) as a polynomial in u = η². They are computed by strips, by several neighbouring columns, or
//! one by one.

use crate::numerics::interval::Interval;
use crate::numerics::lanes::MANY;
use crate::separation::axis::{EtaAxis, mirror};
use crate::separation::columns::fit::Fitter;
use crate::separation::columns::neighbours::MOST_SPANS;
use crate::separation::columns::skewed;
use crate::separation::columns::strip::{ColumnPolynomials, Evaluation, Strip, StripColumns, Writing};
use crate::separation::kernel::Kernel;
use crate::separation::span::Span;
use crate::separation::values::{LINE, Residence, lead};

/// Spectral columns that keep a demanded accuracy.
#[derive(Debug)]
pub struct Spectral<'a> {
    fitter: Fitter<'a>,
    axis: &'a EtaAxis,
    strips: &'a [Strip],
    /// Polynomials of neighbouring columns.
    polynomials: Vec<ColumnPolynomials>,
    residence: Residence,
    /// Largest measured truncation error so far \[mm\].
    truncation: f64,
}

impl<'a> Spectral<'a> {
    /// Makes the method from a fitter, the strips of some of the columns, and the kind of memory in which the array is.
    pub fn new(fitter: Fitter<'a>, axis: &'a EtaAxis, strips: &'a [Strip], residence: Residence) -> Self {
        let polynomials = Vec::with_capacity(MOST_SPANS);
        Self { fitter, axis, strips, polynomials, residence, truncation: 0.0 }
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
        if self.axis.symmetric {
            mirror(out, self.axis.first_positive);
        }
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
        let (axis, length, writing) = (spectral.axis, spectral.axis.eta.len(), spectral.writing(out));
        let Spectral { fitter, polynomials, truncation, .. } = &mut *spectral;
        let mut taken = [false; MANY];
        if let Some((fitted, n, error)) = fitter.columns(axis.reach * axis.reach, xi) {
            (taken, *truncation) = (fitted, truncation.max(error));
            polynomials.resize(1, ColumnPolynomials::ZERO);
            polynomials[0].set(&fitter.rows, &fitter.neighbours.spans[0].base);
            simd.vectorize(Evaluation::<true> { polynomials, n, axis, writing, out });
        }
        for ((&xi, out), taken) in xi.iter().zip(out.chunks_exact_mut(length)).zip(taken) {
            if !taken {
                spectral.column(xi, out);
            }
        }
    }
}

impl Spectral<'_> {
    /// Returns how these columns are written. To mirror needs columns of whole cache lines, because stores across two lines take
    /// longer than the mirroring saves. It also needs an array inside the second cache: beyond it, storing backwards takes longer.
    fn writing(&self, columns: &[f64]) -> Writing {
        let lines = self.axis.eta.len().is_multiple_of(LINE) && lead(columns) == 0;
        match self.residence {
            Residence::SecondCache if self.axis.symmetric && lines => Writing::Outwards,
            Residence::Memory => Writing::PastCaches,
            _ => Writing::Whole,
        }
    }

    /// Writes at most [`MANY`] neighbouring columns, all of one strip or all of none.
    fn neighbours(&mut self, strip: Option<&Strip>, xi: &[f64], out: &mut [f64]) {
        let (arch, axis, writing) = (self.fitter.arch, self.axis, self.writing(out));
        let (relief, scratch) = (&self.fitter.relief, &mut self.polynomials);
        match strip {
            Some(strip) => arch.dispatch(StripColumns { relief, strip, xi, axis, writing, scratch, out }),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::measured::{self, CurveKind, Format, Options, write};
    use crate::placement::{Pair, Placement};
    use crate::profile::{Profile, Side, standards};
    use crate::separation::columns::strips::strips;
    use crate::separation::relief::Relief;
    use crate::separation::values::Residence::{LastCache, Memory, SecondCache};
    use crate::separation::values::Values;
    use crate::separation::{Demand, FULL_PRECISION};

    /// Most joints beside which columns are placed. A spline has more joints, and so many columns would be in strips.
    const FEW_JOINTS: usize = 24;

    /// Fills a window, with columns beside its joints, by code for one kind of machine. The array is treated as being in
    /// one kind of memory; it begins `behind` values after the beginning of a cache line. Returns s and the largest number of
    /// spans of the strips' columns.
    fn filled(
        placement: &Placement,
        count: i32,
        arch: pulp::Arch,
        (residence, behind): (Residence, usize),
    ) -> (Vec<f64>, usize) {
        let steps =
            |reach: f64, n: i32| (0..n).map(move |k| reach * f64::from(2 * k - n + 1) / f64::from(n - 1));
        let mut xi: Vec<f64> = steps(12.0, 101).collect();
        // In these columns a joint is near η = 0.
        let beside = |joint: f64| (0..16).map(move |k| joint - 1e-6 * 1.6f64.powi(k));
        let joints = placement.joints(-12.0, 12.0);
        if joints.len() <= FEW_JOINTS {
            xi.extend(joints.into_iter().flat_map(beside));
        }
        xi.sort_by(f64::total_cmp);
        let axis = EtaAxis::new(&steps(15.0, count).collect::<Vec<_>>());
        let fitter = || Fitter {
            arch,
            ..Fitter::new(Relief::new(placement), Demand::for_tolerance(FULL_PRECISION), 4)
        };
        let strips = strips(&mut fitter(), &xi, axis.reach * axis.reach);
        let mut out = Values::new(behind + xi.len() * axis.eta.len());
        Spectral::new(fitter(), &axis, &strips, residence).columns(&xi, &mut out[behind..]);
        (out[behind..].to_vec(), strips.iter().map(|strip| strip.spans).max().unwrap_or(0))
    }

    /// Returns a spline through points of a profile.
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
        // One pair has a kink; the other has the closing of a drawing, 0.06 mm wide.
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
            // The columns of the second count are whole cache lines, so that one half is the mirror image of the other.
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
