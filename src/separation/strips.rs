//! Strips: neighbouring columns that pass the same branches in the same order, as one polynomial in ξ.
//!
//! Between the ξ at which a joint of either body enters or leaves the window, all that makes up a spectral column
//! is analytic in ξ: of every span s at its beginning (over both contact segments as g/ξ², which keeps its relative
//! accuracy down to C), u_0, and the coefficients of q in powers of τ = (u − u_0)/(u_1 − u_0). They are interpolated
//! from columns at 16 Chebyshev points in ξ, to rounding; a strip where that fails is halved, one with few columns is
//! left to its columns.

use super::Evaluator;
use super::column::WheelSurface;
use super::columns::{Columns, MANY, Row, row};
use super::spectral::{MOST_COEFFICIENTS, ROUNDING_LEVEL, Spectral};
use crate::numerics::chebyshev;
use crate::placement::Placement;

/// Columns that a strip must have: making it takes as long as about so many columns singly.
const LEAST_COLUMNS: usize = 8;

/// Where g/ξ² varies much, its last coefficients below this share of its smallest value are rounding: a thirtieth of the
/// promised relative error.
const MOST_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Coefficients at the end that have to be rounding: one parity may vanish.
pub(super) const PROOF: usize = 2;

/// Places in 0 ≤ τ ≤ 1 at which changes of q are judged.
const JUDGED: [f64; 4] = [0.0, 0.3, 0.7, 1.0];

/// Most spans of a strip's columns.
pub const MOST_SPANS: usize = 3;

/// Quantities are evaluated this many at a time.
const LANES: usize = 8;
const MOST_LANES: usize = MOST_SPANS * (2 + MOST_COEFFICIENTS).div_ceil(LANES);

/// The quantities of one column.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub struct Values([f64; LANES * MOST_LANES]);

impl Default for Values {
    fn default() -> Self {
        Self([0.0; LANES * MOST_LANES])
    }
}

/// What fills a line of the cache and the widest vector.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Lanes([f64; LANES]);

/// Columns over an interval of ξ.
#[derive(Debug, Clone)]
pub struct Strip {
    /// Its open interval \[mm\]: at its ends may be a drawing's step, which has a value of its own.
    pub xi: [f64; 2],
    /// How s at the beginning of the columns is known.
    gap: Gap,
    /// Of every span the index of its first quantity, at the beginning of a lane, and the number of coefficients of q.
    spans: [(usize, usize); MOST_SPANS],
    /// Number of spans.
    count: usize,
    /// Coefficients of t^(kept−1), …, t⁰ of the first lanes, then of the next; t from −1 to 1 over the interval.
    powers: Vec<Lanes>,
    kept: usize,
    /// Largest measured truncation error of its columns \[mm\].
    pub truncation: f64,
}

/// s at the beginning of a strip's columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Gap {
    /// Interpolated as it is.
    Plain,
    /// Interpolated as g/ξ².
    Relative,
    /// Computed for every column: where g/ξ² varies too much for its smallest values to keep their digits.
    Computed,
}

/// The strips of a grid up to u = `u_max` \[mm²\], in order of ξ; none for a skewed wheel or few columns.
pub fn strips(spectral: &mut Spectral<'_>, placement: &Placement, xi: &[f64], u_max: f64) -> Vec<Strip> {
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return Vec::new() };
    if placement.skew != 0.0 || u_max == 0.0 {
        return Vec::new();
    }
    // What is no break belongs to the strip.
    let window = [first.next_down(), last.next_up()];
    let mut maker = Maker { spectral, u_max, strips: Vec::new() };
    let mut rest = xi;
    for pair in breaks(placement, u_max, window).windows(2) {
        rest = &rest[rest.iter().take_while(|&&xi| xi <= pair[0]).count()..];
        let (inside, beyond) = rest.split_at(rest.iter().take_while(|&&xi| xi < pair[1]).count());
        maker.divide([pair[0], pair[1]], inside);
        rest = beyond;
    }
    maker.strips
}

/// The ξ at which a joint of either body enters or leaves the columns, and the window's own ends, in order.
fn breaks(placement: &Placement, u_max: f64, window: [f64; 2]) -> Vec<f64> {
    let (rail, wheel) = (&placement.rail.section, WheelSurface::new(placement));
    let leaving = |(joint, height): (f64, f64)| {
        let w = wheel.axle_distance(joint, height);
        // u = e (2w − e): the joint's own ring meets the window's edge; it has no such point where that is NaN.
        joint + wheel.sin * u_max / (w + (w * w - u_max).sqrt())
    };
    let inside = |xi: &f64| window[0] < *xi && *xi < window[1];
    // e ≤ w, so that e² ≤ u: no joint leaves further than this from where it enters.
    let far = wheel.sin.abs() * u_max.sqrt();
    let mut ends = vec![window[0]];
    ends.extend(rail.joints(window).map(|(xi, _)| xi).filter(inside));
    ends.extend(wheel.section.joints(window).map(|(xi, _)| xi).filter(inside));
    ends.extend(wheel.section.joints([window[0] - far, window[1] + far]).map(leaving).filter(inside));
    ends.push(window[1]);
    // Four runs in order, which a stable sort merges.
    ends.sort_by(f64::total_cmp);
    ends
}

/// Makes strips.
struct Maker<'s, 'a> {
    spectral: &'s mut Spectral<'a>,
    u_max: f64,
    strips: Vec<Strip>,
}

impl Maker<'_, '_> {
    /// Appends strips for columns inside an interval without breaks.
    fn divide(&mut self, [a, b]: [f64; 2], columns: &[f64]) {
        let middle = a + (b - a) / 2.0;
        // An interval of two neighbouring numbers has no halves.
        if columns.len() < LEAST_COLUMNS || middle <= a || middle >= b {
            return;
        }
        // Halves of an interval that is so short would have no strips.
        let short = columns.len() < 2 * LEAST_COLUMNS;
        let arch = self.spectral.arch;
        let attempt = Attempt { spectral: self.spectral, u_max: self.u_max, xi: [a, b], short };
        match arch.dispatch(attempt) {
            Some(strip) => self.strips.push(strip),
            None => {
                let (left, right) = columns.split_at(columns.partition_point(|&xi| xi < middle));
                self.divide([a, middle], left);
                self.divide([middle, b], right);
            }
        }
    }
}

/// One strip over an interval, compiled for each kind of machine.
struct Attempt<'s, 'a> {
    spectral: &'s mut Spectral<'a>,
    u_max: f64,
    xi: [f64; 2],
    short: bool,
}

impl pulp::WithSimd for Attempt<'_, '_> {
    type Output = Option<Strip>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Option<Strip> {
        let ([a, b], half) = (self.xi, (self.xi[1] - self.xi[0]) / 2.0);
        let points = row(|k| a + half + half * chebyshev::point(k, MANY));
        let Spectral { evaluator, columns, .. } = &mut *self.spectral;
        columns.take(evaluator, self.u_max, points)?;
        Strip::new(self.spectral, [a, b], self.short)
    }
}

impl Strip {
    /// The strip through the columns last taken, at its Chebyshev points; `None` where there are too many spans, something
    /// is not finite, or has too few coefficients that are rounding; of a `short` strip the gap may have too few.
    #[inline(always)]
    fn new(spectral: &mut Spectral<'_>, xi: [f64; 2], short: bool) -> Option<Self> {
        let Spectral { evaluator, columns, demand, coefficients, rows, .. } = spectral;
        let mut beginnings = Beginnings::new(evaluator, columns, short)?;
        let judged = &mut beginnings.judged;
        let single = columns.spans.len() == 1;
        let mut spans = [(0, 0); MOST_SPANS];
        let (mut width, mut truncation) = (0, 0f64);
        rows.clear();
        for (k, span) in columns.spans.iter().enumerate() {
            let at = rows.len();
            let (n, error) = columns.polynomials(k, *demand, *coefficients, rows)?;
            truncation = error.max(truncation);
            let length = row(|k| span.u[1][k] - span.u[0][k]);
            let q = &mut rows[at..];
            let mut power = [1.0; MANY];
            for c in q.iter_mut() {
                *c = series(&row(|k| c[k] * power[k]));
                if !single {
                    power = row(|k| power[k] * length[k]);
                }
            }
            let relative = ROUNDING_LEVEL * q[0][0].abs();
            // Beyond the contact segments q need not be better than s at the beginning, over the span's length.
            let contact = columns.contact && k == 0;
            let allowed =
                if contact { relative } else { relative.max(beginnings.rounding[k] / largest(&length)) };
            // u at τ = 1 where there is one span and its q is left in powers of u.
            let end = if single { length[0] } else { 1.0 };
            for tau in JUDGED {
                let mut change = [0.0; MANY];
                for c in q.iter().rev() {
                    change = row(|k| change[k] * (tau * end) + c[k]);
                }
                judged.with(&change, allowed);
            }
            rows.extend(beginnings.series[k]);
            spans[k] = (width, n);
            width += (n + 2).next_multiple_of(LANES);
        }
        let kept = judged.kept()?.next_multiple_of(2);
        let mut powers = vec![Lanes([0.0; LANES]); width / LANES * kept];
        let places = spans[..columns.spans.len()].iter().flat_map(|&(first, n)| first..first + n + 2);
        for (at, row) in places.zip(rows.iter()) {
            let mut ascending = [0.0; MANY];
            chebyshev::to_powers(&row[..kept], &mut ascending);
            let lanes = &mut powers[at / LANES * kept..][..kept];
            for (lanes, power) in lanes.iter_mut().rev().zip(ascending) {
                lanes.0[at % LANES] = power;
            }
        }
        Some(Self { xi, gap: beginnings.gap, spans, count: columns.spans.len(), powers, kept, truncation })
    }

    /// Number of spans of every column.
    pub fn spans(&self) -> usize {
        self.count
    }

    /// \[u_0, u_1\], s at u_0 and the coefficients of q in powers of u − u_0 over one span of the column at ξ, made from
    /// its values in their place.
    #[inline(always)]
    pub fn span<'v>(
        &self,
        values: &'v mut Values,
        span: usize,
        xi: f64,
        u_max: f64,
    ) -> ([f64; 2], f64, &'v [f64]) {
        let values = &mut values.0;
        let (at, n) = self.spans[span];
        let (s, u0) = (values[at + n], values[at + n + 1]);
        let next = self.spans[..self.count].get(span + 1);
        let u1 = next.map_or(u_max, |&(next, n)| values[next + n + 1]);
        let base = if self.gap == Gap::Relative && span == 0 { s * (xi * xi) } else { s };
        let c = &mut values[at..at + n];
        if self.count > 1 {
            let (shrink, mut power) = (1.0 / (u1 - u0), 1.0);
            for c in &mut c[1..] {
                power *= shrink;
                *c *= power;
            }
        }
        ([u0, u1], base, c)
    }

    /// All quantities at ξ by Horner's rule, and by `compute` the gap that is not interpolated.
    #[inline(always)]
    pub fn values(&self, xi: f64, values: &mut Values, compute: impl Fn(f64) -> f64) {
        let [a, b] = self.xi;
        let t = ((xi - a) - (b - xi)) / (b - a);
        let square = t * t;
        for (values, powers) in
            values.0.as_chunks_mut::<LANES>().0.iter_mut().zip(self.powers.chunks_exact(self.kept))
        {
            // Two chains, of even and of odd powers: one would be as long as the rest of the column.
            let mut sums = [[0f64; LANES]; 2];
            for pair in powers.as_chunks::<2>().0 {
                for (sum, c) in sums.iter_mut().zip(pair) {
                    *sum = std::array::from_fn(|k| sum[k].mul_add(square, c.0[k]));
                }
            }
            *values = std::array::from_fn(|k| sums[0][k].mul_add(t, sums[1][k]));
        }
        if self.gap == Gap::Computed {
            values.0[self.spans[0].1] = compute(xi);
        }
    }
}

/// Where the columns of a strip begin their spans: most intervals that are too long are seen to be so by it.
struct Beginnings {
    gap: Gap,
    /// Of every span the series of s and of u_0.
    series: [[Row; 2]; MOST_SPANS],
    /// Rounding of s.
    rounding: [f64; MOST_SPANS],
    judged: Judged,
}

impl Beginnings {
    /// `None` as for [`Strip::new`].
    #[inline(always)]
    fn new(evaluator: &Evaluator<'_>, columns: &Columns<'_>, short: bool) -> Option<Self> {
        if columns.spans.len() > MOST_SPANS {
            return None;
        }
        let mut gap = if columns.contact { Gap::Relative } else { Gap::Plain };
        let mut judged = Judged::default();
        let mut begins = [[[0.0; MANY]; 2]; MOST_SPANS];
        let mut rounding = [0.0; MOST_SPANS];
        for (k, span) in columns.spans.iter().enumerate() {
            let mut s = span.base;
            rounding[k] = if columns.contact && k == 0 {
                s = row(|k| s[k] / (columns.xi[k] * columns.xi[k]));
                // What is relatively accurate must stay so where it is smallest; where it varies much, the largest
                // values' rounding is more.
                let least = s.iter().fold(f64::INFINITY, |least, s| s.abs().min(least));
                let rounding = (0.5 * f64::EPSILON * largest(&s)).min(MOST_ROUNDING * least);
                rounding.max(ROUNDING_LEVEL * least)
            } else {
                f64::EPSILON * largest(&span.size(evaluator, &columns.xi))
            };
            begins[k] = [s, span.u[0]].map(|values| series(&values));
            judged.with(&begins[k][1], ROUNDING_LEVEL * largest(&span.u[1]));
            let before = judged;
            judged.with(&begins[k][0], rounding[k]);
            if k == 0 && short && judged.kept().is_none() {
                (judged, gap) = (before, Gap::Computed);
            }
        }
        judged.kept()?;
        Some(Self { gap, series: begins, rounding, judged })
    }
}

/// Which Chebyshev coefficients are more than rounding, and whether all are finite.
#[derive(Debug, Default, Clone, Copy)]
struct Judged([bool; MANY]);

impl Judged {
    #[inline(always)]
    fn with(&mut self, row: &Row, allowed: f64) {
        for (more, c) in self.0.iter_mut().zip(row) {
            // What is not finite is more, too.
            *more |= c.is_nan() || c.abs() > allowed;
        }
    }

    /// Number of coefficients of which the last is more; `None` where too few are rounding.
    fn kept(&self) -> Option<usize> {
        let kept = self.0.iter().rposition(|&more| more).map_or(1, |last| last + 1);
        (kept + PROOF <= MANY).then_some(kept)
    }
}

#[inline(always)]
pub(super) fn series(values: &Row) -> Row {
    let mut coefficients = [0.0; MANY];
    chebyshev::coefficients(values, &mut coefficients);
    coefficients
}

fn largest(row: &Row) -> f64 {
    row.iter().fold(0.0, |most, v| v.max(most))
}
