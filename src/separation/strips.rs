//! Strips: neighbouring columns that pass the same branches in the same order, as one polynomial in ξ.
//!
//! Between the ξ at which a joint of either body enters or leaves the window, all that makes up a spectral column
//! is analytic in ξ: of every span s at its beginning (over both contact segments as g/ξ², which keeps its relative
//! accuracy down to C), u_0, and the coefficients of q in powers of τ = (u − u_0)/(u_1 − u_0). They are interpolated
//! from columns at Chebyshev points in ξ, to rounding; a strip where that fails is halved, one with few columns is
//! left to its columns.

use super::spectral::{ColumnPolynomial, Fit, MOST_COEFFICIENTS, Spectral};
use crate::numerics::chebyshev;
use crate::placement::Placement;

/// Numbers of Chebyshev points in ξ that are tried.
const POINTS: [usize; 2] = [8, 16];

/// Columns that a strip must have for every column it is made from.
const COLUMNS_PER_POINT: usize = 2;

/// A quantity's last coefficients below this share of it are rounding of the columns that it is made from.
const ROUNDING_LEVEL: f64 = 4.0 * f64::EPSILON;

/// Coefficients at the end that have to be rounding: one parity may vanish.
const PROOF: usize = 2;

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
    spans: Vec<(usize, usize)>,
    /// Coefficients of t^(kept−1), …, t⁰ of the first lanes, then of the next; t from −1 to 1 over the interval.
    powers: Vec<Lanes>,
    kept: usize,
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

/// The columns of one strip at the Chebyshev points, all of one shape.
#[derive(Debug)]
struct Samples {
    contact: bool,
    /// As in [`Strip`].
    spans: Vec<(usize, usize)>,
    /// Point by point the quantities: of every span the coefficients of q in powers of τ, s at its beginning and u_0,
    /// padded to whole lanes.
    values: Vec<f64>,
    width: usize,
    /// Rounding of each span's s and u_0.
    rounding: [[f64; 2]; MOST_SPANS],
    /// Largest width of each span \[mm²\].
    widest: [f64; MOST_SPANS],
    /// u at τ = 1 where there is one span and its q is left in powers of u; 1 else.
    end: f64,
}

/// The strips of a grid up to u = `u_max` \[mm²\], in order of ξ; none for a skewed wheel or few columns.
pub fn strips(spectral: &mut Spectral<'_>, placement: &Placement, xi: &[f64], u_max: f64) -> Vec<Strip> {
    let mut strips = Vec::new();
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return strips };
    if placement.skew != 0.0 || u_max == 0.0 {
        return strips;
    }
    let mut ends = breaks(placement, u_max);
    ends.retain(|&end| end >= first && end <= last);
    // What is no break belongs to the strip.
    ends.extend([first.next_down(), last.next_up()]);
    ends.sort_by(f64::total_cmp);
    for pair in ends.windows(2) {
        divide(spectral, xi, [pair[0], pair[1]], &mut strips);
    }
    strips
}

/// The ξ at which a joint of either body enters or leaves the columns.
fn breaks(placement: &Placement, u_max: f64) -> Vec<f64> {
    let (rail, wheel) = (&placement.rail.section, &placement.wheel.section);
    let mut ends: Vec<f64> = rail.pieces.iter().chain(&wheel.pieces).flat_map(|piece| piece.xi).collect();
    let (sin, cos) = (wheel.frame.sin, wheel.frame.cos);
    for piece in &wheel.pieces {
        for joint in piece.xi {
            let height = wheel.branches[piece.branch].height(joint);
            let w = placement.rolling_radius() - joint * sin - height * cos;
            // u = e (2w − e): the joint's own ring meets the window's edge; it has no such point where that is NaN.
            ends.push(joint + sin * u_max / (w + (w * w - u_max).sqrt()));
        }
    }
    ends
}

/// Appends strips over an interval without breaks.
fn divide(spectral: &mut Spectral<'_>, xi: &[f64], [a, b]: [f64; 2], strips: &mut Vec<Strip>) {
    let columns = xi.partition_point(|&x| x < b).saturating_sub(xi.partition_point(|&x| x <= a));
    for points in POINTS {
        if columns < COLUMNS_PER_POINT * points {
            return;
        }
        if let Some(strip) = Strip::new(spectral, [a, b], points) {
            strips.push(strip);
            return;
        }
    }
    let middle = a + (b - a) / 2.0;
    divide(spectral, xi, [a, middle], strips);
    divide(spectral, xi, [middle, b], strips);
}

impl Strip {
    /// The strip through columns at n Chebyshev points, or `None` where these are not enough.
    fn new(spectral: &mut Spectral<'_>, [a, b]: [f64; 2], n: usize) -> Option<Self> {
        let samples = Samples::new(spectral, [a, b], n)?;
        let width = samples.width;
        let mut series = vec![0.0; n * width];
        chebyshev::coefficients(&samples.values, width, &mut series);
        let size = &series[..width];
        let kept = |gap: Gap| {
            let mut rows = series.chunks_exact(width).enumerate().rev();
            let last = rows.find(|(_, row)| !samples.is_rounding(row, size, gap)).map_or(1, |(k, _)| k + 1);
            (last + PROOF <= n).then_some((gap, last))
        };
        let own = if samples.contact { Gap::Relative } else { Gap::Plain };
        let computed = || if n == POINTS[POINTS.len() - 1] { kept(Gap::Computed) } else { None };
        let (gap, kept) = kept(own).or_else(computed)?;
        let kept = kept.next_multiple_of(2);
        series.truncate(kept * width);
        chebyshev::to_powers(&mut series, width);
        let lanes = (0..width / LANES)
            .flat_map(|lane| series.chunks_exact(width).rev().map(move |row| Lanes(row.as_chunks().0[lane])));
        let powers = lanes.collect();
        Some(Self { xi: [a, b], gap, spans: samples.spans, powers, kept })
    }

    /// Number of spans of every column.
    pub fn spans(&self) -> usize {
        self.spans.len()
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
        let u1 = self.spans.get(span + 1).map_or(u_max, |&(next, n)| values[next + n + 1]);
        let base = if self.gap == Gap::Relative && span == 0 { s * (xi * xi) } else { s };
        let c = &mut values[at..at + n];
        if self.spans.len() > 1 {
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

impl Samples {
    /// Columns at n points, or `None` where they are not of one shape, or not whole.
    fn new(spectral: &mut Spectral<'_>, [a, b]: [f64; 2], n: usize) -> Option<Self> {
        let (centre, half) = (a + (b - a) / 2.0, (b - a) / 2.0);
        let xi = |k: usize| centre + half * chebyshev::point(k, n);
        let mut column = Vec::with_capacity(MOST_SPANS);
        let mut least = [0; MOST_SPANS];
        // Every column is to have as many coefficients as the one that needs most: a second round, at times a third.
        loop {
            let (mut samples, mut needed): (Option<Self>, _) = (None, least);
            let mut uniform = true;
            for k in 0..n {
                spectral.whole_column(xi(k), &least, &mut column)?;
                let samples = match &mut samples {
                    Some(samples) => samples,
                    none => none.insert(Self::shaped(&column, n)?),
                };
                if column.len() != samples.spans.len() || column[0].contact != samples.contact {
                    return None;
                }
                for ((needed, fit), (_, n)) in needed.iter_mut().zip(&column).zip(&samples.spans) {
                    *needed = fit.polynomial.n.max(*needed);
                    uniform &= fit.polynomial.n == *n;
                }
                samples.append(xi(k), &column);
            }
            if uniform {
                return samples.filter(|samples| samples.values.iter().all(|v| v.is_finite()));
            }
            least = needed;
        }
    }

    /// No columns yet, of the shape of the first one.
    fn shaped(column: &[Fit], n: usize) -> Option<Self> {
        let mut at = 0;
        let mut spans = Vec::with_capacity(column.len());
        for fit in column {
            spans.push((at, fit.polynomial.n));
            at += (fit.polynomial.n + 2).next_multiple_of(LANES);
        }
        let end = if column.len() == 1 { column[0].width } else { 1.0 };
        let contact = column.first()?.contact;
        let values = Vec::with_capacity(n * at);
        let mut rounding = [[0.0; 2]; MOST_SPANS];
        if contact {
            rounding[0][0] = f64::INFINITY;
        }
        (column.len() <= MOST_SPANS).then_some(Self {
            contact,
            spans,
            values,
            width: at,
            rounding,
            widest: [0.0; MOST_SPANS],
            end,
        })
    }

    fn append(&mut self, xi: f64, column: &[Fit]) {
        for (k, fit) in column.iter().enumerate() {
            let ColumnPolynomial { base, u0, c, .. } = &fit.polynomial;
            let relative = self.contact && k == 0;
            let base = if relative { base / (xi * xi) } else { *base };
            let [s, u] = &mut self.rounding[k];
            // What is relatively accurate must stay so where it is smallest.
            *s = if relative { s.min(ROUNDING_LEVEL * base.abs()) } else { s.max(f64::EPSILON * fit.height) };
            *u = u.max(ROUNDING_LEVEL * (u0 + fit.width));
            self.widest[k] = self.widest[k].max(fit.width);
            let per = if column.len() == 1 { 1.0 } else { fit.width };
            let mut power = 1.0;
            for c in &c[..self.spans[k].1] {
                self.values.push(c * power);
                power *= per;
            }
            self.values.extend([base, *u0]);
            self.values.resize(self.values.len().next_multiple_of(LANES), 0.0);
        }
    }

    /// Whether a row of Chebyshev coefficients is no more than rounding; `size` is the first row.
    fn is_rounding(&self, row: &[f64], size: &[f64], gap: Gap) -> bool {
        self.spans.iter().zip(&self.rounding).enumerate().all(|(k, (&(at, n), rounding))| {
            let [s, u0] = [0, 1].map(|j| row[at + n + j].abs() <= rounding[j]);
            let small = (s || gap == Gap::Computed && k == 0) && u0;
            let q = &row[at..at + n];
            let change = |tau: f64| q.iter().rev().fold(0.0, |sum, c| sum * (tau * self.end) + c);
            let relative = ROUNDING_LEVEL * size[at].abs();
            // Elsewhere q need not be better than s at the beginning, over the span's width.
            let allowed =
                if self.contact && k == 0 { relative } else { relative.max(rounding[0] / self.widest[k]) };
            small && JUDGED.iter().all(|&tau| change(tau).abs() <= allowed)
        })
    }
}
