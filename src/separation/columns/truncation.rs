//! Measures the truncation error of columns, at places between the nodes of their interpolation.

use std::sync::LazyLock;

use super::fit::{Fitter, error};
use super::neighbours::{MOST_SPANS, SpanColumns};
use super::strip::{ColumnPolynomials, Strip};
use super::strips::inside;
use crate::numerics::chebyshev;
use crate::numerics::lanes::{Lanes, MANY, lanes};
use crate::numerics::nan_max;
use crate::separation::span::SagittaPoints;
use crate::separation::wheel_surface::WheelSurface;

/// Places in a span, as shares of its u, at which the truncation error of a single column is measured. The end of the span
/// is measured, too.
const MEASURED: [f64; 4] = [0.1, 0.3, 0.55, 0.8];

/// The golden ratio (√5 − 1)/2. The fractional parts of its multiples are spread evenly, however many are taken.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Share of a span at its end, less what rounding may put beyond it.
const SPAN_END: f64 = 1.0 - 1e-9;

/// Places half way between the nodes of an interval, the last one half way to its end; and shares of spans, every second one
/// by the golden ratio. The others are the end of the span, where the truncation error is largest beside a steep surface.
static BETWEEN: LazyLock<(Lanes, Lanes)> = LazyLock::new(|| {
    let nodes = &*chebyshev::NODES;
    let places = lanes(|k| 0.5 * (nodes[k] + if k + 1 < MANY { nodes[k + 1] } else { -1.0 }));
    (places, lanes(|k| if k % 2 == 0 { (GOLDEN * (k + 1) as f64).fract() } else { SPAN_END }))
});

/// Measures the largest difference \[mm\] of a strip's columns from the same columns fitted directly, up to u = `u_max`
/// \[mm²\]. The places lie between the strip's nodes in ξ, at the end of every span and at various shares of it in turn.
pub fn of_strip(fitter: &mut Fitter<'_>, strip: &Strip, u_max: f64) -> f64 {
    fitter.arch.dispatch(StripDifference { fitter, strip, u_max })
}

/// Measures the largest truncation error \[mm\] of columns in no strip. Appends the numbers of coefficients that they need
/// to `needed`.
pub fn of_columns(fitter: &mut Fitter<'_>, xi: &[f64], u_max: f64, needed: &mut Vec<usize>) -> f64 {
    let arch = fitter.arch;
    let columns = |xi| arch.dispatch(LoneColumns { fitter: &mut *fitter, xi, u_max, needed: &mut *needed });
    xi.chunks(MANY).map(columns).fold(0.0, nan_max)
}

/// Measures the largest truncation error \[mm\] of one column in no strip. Appends the number of coefficients that it needs
/// to `needed`.
fn of_column(fitter: &mut Fitter<'_>, xi: f64, u_max: f64, needed: &mut Vec<usize>) -> f64 {
    let mut spans = std::mem::take(&mut fitter.spans);
    fitter.relief.wheel.spans(xi, u_max, &mut spans);
    let mut truncation = 0f64;
    for span in &spans {
        // A span without a polynomial is evaluated point by point and has no truncation error.
        let Some(fit) = fitter.column(xi, span, u_max) else { continue };
        needed.push(fit.n);
        let run = span.u.high.min(u_max) - span.u.low;
        let error = |u: f64| {
            // A place without a point on the wheel has no error.
            let point = fitter.relief.wheel.point_at(xi, span, u);
            point.map_or(0.0, |point| (fit.rise(u) - point.rise).abs())
        };
        let inside = MEASURED.map(|share| error(span.u.low + share * run));
        truncation = inside.into_iter().fold(nan_max(truncation, fit.error), f64::max);
    }
    fitter.spans = spans;
    truncation
}

/// Finds points of columns near these shares of one span's sagittae. Returns `None` near a vertical tangent.
#[inline(always)]
fn points(wheel: &WheelSurface<'_>, span: &SpanColumns<'_>, shares: &Lanes) -> Option<SagittaPoints<MANY>> {
    let (_, run) = wheel.points_near(&span.wheel, &span.wheel.u[1])?;
    Some(wheel.points_by(&span.wheel, &lanes(|k| run[k] * shares[k])))
}

/// The work of [`of_strip`], compiled for each kind of machine.
struct StripDifference<'s, 'a> {
    fitter: &'s mut Fitter<'a>,
    strip: &'s Strip,
    u_max: f64,
}

impl pulp::WithSimd for StripDifference<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> f64 {
        let Self { fitter: Fitter { relief, neighbours: columns, .. }, strip, u_max } = self;
        let at = inside(strip.xi, &BETWEEN.0);
        let mut polynomials = [ColumnPolynomials::ZERO; MOST_SPANS];
        let polynomials = &mut polynomials[..strip.spans];
        strip.polynomials(relief, &at, u_max, polynomials);
        let mut most = 0.0;
        let mut compare = |polynomial: &ColumnPolynomials, [u, s]: [&Lanes; 2]| {
            let found = polynomial.values(strip.coefficients, &lanes(|k| u[k] - polynomial.u0[k]));
            // Only places over this polynomial count.
            let over = |k: usize| u[k] >= polynomial.u0[k];
            let differences: Lanes = lanes(|k| if over(k) { (found[k] - s[k]).abs() } else { 0.0 });
            most = differences.into_iter().fold(most, nan_max);
        };
        let taken = columns.take(relief, u_max, at).filter(|()| columns.spans.len() == strip.spans);
        for (index, polynomial) in polynomials.iter().enumerate() {
            let span = taken.map(|()| &columns.spans[index]);
            let found = span.and_then(|span| Some((span.base, points(&columns.wheel, span, &BETWEEN.1)?)));
            match found {
                Some((base, points)) => {
                    compare(polynomial, [&points.u, &lanes(|k| base[k] + points.rise[k])])
                }
                // Near a vertical tangent not all points are found at once; they are computed one by one.
                None => {
                    let [begin, next] = [Some(polynomial), polynomials.get(index + 1)]
                        .map(|polynomial| polynomial.map_or([u_max; MANY], |polynomial| polynomial.u0));
                    let u = lanes(|k| begin[k] + BETWEEN.1[k] * (next[k] - begin[k]));
                    let mut s = u;
                    for (s, &xi) in s.iter_mut().zip(&at) {
                        *s = relief.height(xi, s.sqrt());
                    }
                    compare(polynomial, [&u, &s]);
                }
            }
        }
        most
    }
}

/// The work of [`of_columns`] for at most [`MANY`] columns, at once if possible; compiled for each kind of machine.
struct LoneColumns<'s, 'a> {
    fitter: &'s mut Fitter<'a>,
    xi: &'s [f64],
    u_max: f64,
    needed: &'s mut Vec<usize>,
}

impl pulp::WithSimd for LoneColumns<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> f64 {
        let Self { fitter, xi, u_max, needed } = self;
        let (mut taken, mut most) = ([false; MANY], 0.0);
        if let Some((fitted, n, measured)) = fitter.columns(u_max, xi) {
            (taken, most) = (fitted, measured);
            needed.resize(needed.len() + xi.len(), n);
            let (wheel, span) = (&fitter.neighbours.wheel, &fitter.neighbours.spans[0]);
            let errors = points(wheel, span, &BETWEEN.1)
                .map_or([f64::NAN; MANY], |points| error(&fitter.rows, &points));
            most = errors.into_iter().fold(most, nan_max);
        }
        for (&xi, _) in xi.iter().zip(taken).filter(|(_, taken)| !taken) {
            most = nan_max(most, of_column(fitter, xi, u_max, needed));
        }
        most
    }
}
