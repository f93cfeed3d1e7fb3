//! How far columns are from what they interpolate, measured where they were not made from it.

use std::sync::LazyLock;

use super::columns::{MANY, Row, row};
use super::spectral::Spectral;
use super::strip::{ColumnPolynomials, Strip};
use super::strips::inside;
use crate::numerics::{chebyshev, nan_max};

/// Where in a span, as a share of its u, the truncation error of a column is measured beside its end, where it may pass through
/// zero.
const MEASURED: [f64; 4] = [0.1, 0.3, 0.55, 0.8];

/// Largest difference \[mm\] of a strip's columns from such columns singly, between the strip's nodes in ξ and at another place
/// in every span for each; compiled for each kind of machine.
struct Difference<'s, 'a> {
    spectral: &'s mut Spectral<'a>,
    strip: &'s Strip,
    u_max: f64,
}

impl pulp::WithSimd for Difference<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> f64 {
        let Self { spectral, strip, u_max } = self;
        let Spectral { evaluator, columns, polynomials, .. } = spectral;
        let points = inside(strip.xi, &BETWEEN.0);
        polynomials.resize(strip.spans, ColumnPolynomials::NONE);
        strip.polynomials(evaluator.placement, &points, u_max, polynomials);
        let mut most = 0.0;
        let mut compare = |polynomial: &ColumnPolynomials, [u, s]: [&Row; 2]| {
            let found = polynomial.values(strip.coefficients, &row(|k| u[k] - polynomial.u0[k]));
            // Those that lie over this polynomial.
            let differences = row(|k| if u[k] >= polynomial.u0[k] { (found[k] - s[k]).abs() } else { 0.0 });
            most = differences.into_iter().fold(most, nan_max);
        };
        let taken = columns.take(evaluator, u_max, points).filter(|()| columns.spans.len() == strip.spans);
        for (index, polynomial) in polynomials.iter().enumerate() {
            match taken.and_then(|()| columns.separations(index, &BETWEEN.1)) {
                Some([u, s]) => compare(polynomial, [&u, &s]),
                // Near a vertical tangent not all are found at once.
                None => {
                    let [begin, next] = [Some(polynomial), polynomials.get(index + 1)]
                        .map(|polynomial| polynomial.map_or([u_max; MANY], |polynomial| polynomial.u0));
                    let u = row(|k| begin[k] + BETWEEN.1[k] * (next[k] - begin[k]));
                    let mut s = u;
                    for (s, &xi) in s.iter_mut().zip(&points) {
                        *s = evaluator.separation(xi, s.sqrt());
                    }
                    compare(polynomial, [&u, &s]);
                }
            }
        }
        most
    }
}

/// Places of an interval half way between its nodes, the last one to its middle; and shares of spans, spread by the golden ratio.
static BETWEEN: LazyLock<(Row, Row)> = LazyLock::new(|| {
    let nodes = &*chebyshev::NODES;
    let places = row(|k| 0.5 * (nodes[k] + if k + 1 < MANY { nodes[k + 1] } else { -1.0 }));
    (places, row(|k| (GOLDEN * (k + 1) as f64).fract()))
});

/// (√5 − 1)/2: the fractions of its multiples are spread evenly, however many are taken.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Columns in no strip, measured at once where they can be; compiled for each kind of machine.
struct Measured<'s, 'a> {
    spectral: &'s mut Spectral<'a>,
    /// At most [`MANY`].
    xi: &'s [f64],
    needed: &'s mut Vec<usize>,
}

impl pulp::WithSimd for Measured<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> f64 {
        let Self { spectral, xi, needed } = self;
        let u_max = spectral.axis.reach * spectral.axis.reach;
        let Spectral { evaluator, demand, coefficients, columns, rows, .. } = &mut *spectral;
        rows.clear();
        let mut taken = columns.take_each(evaluator, u_max, xi).unwrap_or([false; MANY]);
        let mut error = 0.0;
        if taken.contains(&true) {
            match columns.polynomials(0, *demand, *coefficients, rows) {
                Some((n, measured)) => {
                    needed.resize(needed.len() + xi.len(), n);
                    error = nan_max(measured, columns.difference(0, rows, &BETWEEN.1));
                }
                None => taken = [false; MANY],
            }
        }
        for (&xi, _) in xi.iter().zip(taken).filter(|(_, taken)| !taken) {
            error = nan_max(error, spectral.truncation_of(xi, u_max, needed));
        }
        error
    }
}

impl Spectral<'_> {
    /// Largest difference \[mm\] of a strip's columns from columns singly, between its nodes.
    pub(super) fn difference(&mut self, strip: &Strip) -> f64 {
        let (arch, u_max) = (self.arch, self.axis.reach * self.axis.reach);
        arch.dispatch(Difference { spectral: self, strip, u_max })
    }

    /// Largest truncation error \[mm\] of columns in no strip; appends the numbers of coefficients that they need.
    pub(super) fn truncation_alone(&mut self, xi: &[f64], needed: &mut Vec<usize>) -> f64 {
        let arch = self.arch;
        let rows = xi.chunks(MANY);
        rows.map(|xi| arch.dispatch(Measured { spectral: self, xi, needed })).fold(0.0, nan_max)
    }

    /// The same for one column.
    fn truncation_of(&mut self, xi: f64, u_max: f64, needed: &mut Vec<usize>) -> f64 {
        let mut spans = std::mem::take(&mut self.spans);
        self.evaluator.wheel.spans(xi, u_max, &mut spans);
        let mut truncation = 0f64;
        for span in &spans {
            // Points one by one, without truncation.
            let Some(fit) = self.polynomial(xi, span, u_max, self.coefficients) else { continue };
            needed.push(fit.n);
            let run = span.u[1].min(u_max) - span.u[0];
            let inside = MEASURED.map(|share| self.truncation(xi, span, &fit, span.u[0] + share * run));
            truncation = inside.into_iter().fold(nan_max(truncation, fit.error), f64::max);
        }
        self.spans = spans;
        truncation
    }
}
