//! Makes strips: neighbouring columns that pass the same branches in the same order, as polynomials in ξ.
//!
//! All quantities of a spectral column are analytic in ξ, except where a joint of either body enters or leaves the window.
//! For every span these quantities are s at the beginning (over both contact segments g/ξ², which keeps its relative
//! accuracy down to C), u_0, and the coefficients of q in powers of τ = (u − u_0)/(u_1 − u_0). They are interpolated to
//! rounding from columns at 16 Chebyshev points in ξ. A strip where that fails is halved; a strip of few columns is given
//! up, and its columns are fitted one by one.

use super::fit::{Fitter, polynomials};
use super::neighbours::{MOST_SPANS, Neighbours};
use super::strip::{GapStart, Strip};
use crate::numerics::chebyshev::{self, PROOF};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, lanes, largest, smallest};
use crate::separation::demand::ROUNDING_LEVEL;
use crate::separation::relief::Relief;

/// Least number of columns of a strip. Making a strip takes as long as about so many single columns.
const LEAST_COLUMNS: usize = 8;

/// Largest rounding that is allowed in g/ξ², as a share of its smallest value: a thirtieth of the promised relative error.
const MOST_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Places in 0 ≤ τ ≤ 1 at which changes of q are compared with rounding.
const JUDGED: [f64; 4] = [0.0, 0.3, 0.7, 1.0];

/// Makes the strips of a grid up to u = `u_max` \[mm²\], in order of ξ. There are none under a skewed wheel, over
/// a grid of few columns, and for u_max = 0.
pub fn strips(fitter: &mut Fitter<'_>, xi: &[f64], u_max: f64) -> Vec<Strip> {
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return Vec::new() };
    if fitter.relief.is_skewed() || u_max == 0.0 {
        return Vec::new();
    }
    // The ends of the window are widened by one number, so that the first and last columns lie inside.
    let window = Interval::new(first.next_down(), last.next_up());
    let least = fitter.least;
    let breaks = breaks(&fitter.relief, u_max, window);
    let mut maker = Maker { fitter, u_max, least, strips: Vec::new() };
    let mut rest = xi;
    for pair in breaks.windows(2) {
        rest = &rest[leading(rest, |xi| xi <= pair[0])..];
        let (inside, beyond) = rest.split_at(leading(rest, |xi| xi < pair[1]));
        maker.divide(Interval::new(pair[0], pair[1]), inside);
        rest = beyond;
    }
    maker.strips
}

/// Counts the leading columns that have a property. Most intervals of a spline have one column or none.
fn leading(xi: &[f64], holds: impl Fn(f64) -> bool) -> usize {
    if xi.get(LEAST_COLUMNS).is_some_and(|&xi| holds(xi)) {
        return xi.partition_point(|&xi| holds(xi));
    }
    xi.iter().take_while(|&&xi| holds(xi)).count()
}

/// Finds the ξ \[mm\] at which a joint of either body enters or leaves the columns, in order, with the window's two ends.
fn breaks(relief: &Relief<'_>, u_max: f64, window: Interval) -> Vec<f64> {
    let (rail, wheel) = (relief.below, &relief.wheel);
    let leaving = |(joint, height): (f64, f64)| {
        let w = wheel.axle_distance(joint, height);
        // From u = e (2w − e): the joint's circle meets the edge of the window here. The result is NaN if the circle does
        // not reach the edge.
        joint + wheel.sin * u_max / (w + (w * w - u_max).sqrt())
    };
    let inside = |xi: &f64| window.surrounds(*xi);
    // Because e ≤ w, e² ≤ u: no joint moves farther than this along ξ before it leaves.
    let far = wheel.sin.abs() * u_max.sqrt();
    let mut ends = Vec::with_capacity(MANY);
    ends.push(window.low);
    ends.extend(rail.joints(window).map(|(xi, _)| xi).filter(inside));
    ends.extend(wheel.section.joints(window).map(|(xi, _)| xi).filter(inside));
    ends.extend(wheel.section.joints(window.grown(far)).map(leaving).filter(inside));
    ends.push(window.high);
    // The list consists of four sorted runs, which a stable sort merges.
    ends.sort_by(f64::total_cmp);
    ends
}

/// The strips made so far, and what is needed to make more.
struct Maker<'s, 'a> {
    fitter: &'s mut Fitter<'a>,
    u_max: f64,
    /// Number of coefficients that the next strip starts with: one less than the last strip needed.
    least: usize,
    strips: Vec<Strip>,
}

impl Maker<'_, '_> {
    /// Appends strips for the columns inside an interval without breaks.
    fn divide(&mut self, xi: Interval, columns: &[f64]) {
        let middle = xi.middle();
        // An interval between two neighbouring numbers has no halves.
        if columns.len() < LEAST_COLUMNS || !xi.surrounds(middle) {
            return;
        }
        // The halves of such a short interval would have too few columns for strips.
        let short = columns.len() < 2 * LEAST_COLUMNS;
        let arch = self.fitter.arch;
        let attempt = Attempt { fitter: self.fitter, u_max: self.u_max, xi, least: self.least, short };
        match arch.dispatch(attempt) {
            Some(strip) => {
                self.least = strip.coefficients.saturating_sub(1).max(1);
                self.strips.push(strip);
            }
            None => {
                let (lower, upper) = columns.split_at(columns.partition_point(|&xi| xi < middle));
                for (half, columns) in xi.halves().into_iter().zip([lower, upper]) {
                    self.divide(half, columns);
                }
            }
        }
    }
}

/// Returns ξ \[mm\] at places t, which run from −1 to 1 over an interval.
#[inline(always)]
pub fn inside(xi: Interval, t: &Lanes) -> Lanes {
    let half = xi.width() / 2.0;
    lanes(|k| xi.low + half + half * t[k])
}

/// The attempt to make one strip over an interval. It is compiled for each kind of machine.
struct Attempt<'s, 'a> {
    fitter: &'s mut Fitter<'a>,
    u_max: f64,
    xi: Interval,
    least: usize,
    short: bool,
}

impl pulp::WithSimd for Attempt<'_, '_> {
    type Output = Option<Strip>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Option<Strip> {
        let points = inside(self.xi, &chebyshev::NODES);
        let Fitter { relief, neighbours, .. } = &mut *self.fitter;
        neighbours.take(relief, self.u_max, points)?;
        self.strip()
    }
}

impl Attempt<'_, '_> {
    /// Makes the strip through the columns taken last, which are at its Chebyshev points. Returns `None` if there are too
    /// many spans, if a value is not finite, or if too few coefficients of a quantity are as small as rounding. The gap of
    /// a `short` strip is exempt from the last condition.
    #[inline(always)]
    fn strip(self) -> Option<Strip> {
        let Self { fitter, u_max, xi, least, short } = self;
        let Fitter { relief, neighbours: columns, demand, rows, .. } = fitter;
        let beginnings = Beginnings::new(relief, columns, short)?;
        let single = columns.spans.len() == 1;
        let (mut counts, mut kept, mut truncation) = ([0; MOST_SPANS], [0; MOST_SPANS], 0f64);
        rows.clear();
        for (k, span) in columns.spans.iter().enumerate() {
            let at = rows.len();
            let (n, error) = polynomials(&columns.wheel, &span.wheel, u_max, (*demand, least), rows)?;
            truncation = error.max(truncation);
            let length: Lanes = lanes(|k| span.wheel.u[1][k] - span.wheel.u[0][k]);
            let q = &mut rows[at..];
            let mut power = [1.0; MANY];
            for c in q.iter_mut() {
                *c = chebyshev::coefficients(&lanes(|k| c[k] * power[k]));
                if !single {
                    power = lanes(|k| power[k] * length[k]);
                }
            }
            let relative = ROUNDING_LEVEL * q[0][0].abs();
            // Beyond the contact segments q needs the absolute accuracy of s at the beginning, divided by the span's
            // length.
            let contact = columns.contact && k == 0;
            let allowed =
                if contact { relative } else { relative.max(beginnings.rounding[k] / largest(&length)) };
            // This is u at τ = 1. A single span keeps q in powers of u.
            let end = if single { length[0] } else { 1.0 };
            let mut judged = Judged::default();
            for tau in JUDGED {
                let mut change = [0.0; MANY];
                for c in q.iter().rev() {
                    change = lanes(|k| change[k] * (tau * end) + c[k]);
                }
                judged.with(&change, allowed);
            }
            (counts[k], kept[k]) = (n, judged.kept()?.max(beginnings.kept));
        }
        let Beginnings { gap, series, .. } = beginnings;
        let (spans, coefficients) = (columns.spans.len(), counts.iter().fold(0, |most, &n| n.max(most)));
        // The first span has no u_0.
        let at_beginnings = (2 * spans - 1) * kept[0];
        let mut powers = vec![0.0; coefficients * kept.iter().sum::<usize>() + at_beginnings];
        let (mut rest, mut rows) = (&mut powers[..], rows.iter());
        for (n, kept) in counts.into_iter().zip(kept).take(spans) {
            // Columns are evaluated with the same number of coefficients for every span.
            let (of_q, others) = rest.split_at_mut(coefficients * kept);
            for (powers, row) in of_q.chunks_exact_mut(kept).zip(rows.by_ref().take(n)) {
                write(powers, row);
            }
            rest = others;
        }
        for (powers, row) in rest.chunks_exact_mut(kept[0]).zip(&series.as_flattened()[1..]) {
            write(powers, row);
        }
        Some(Strip { xi, gap, spans, coefficients, powers, kept, truncation })
    }
}

/// Writes the coefficients of t^(kept−1), …, t⁰ of the interpolant that has these Chebyshev coefficients.
#[inline(always)]
fn write(powers: &mut [f64], row: &Lanes) {
    let values = chebyshev::to_powers(row, powers.len());
    for (power, value) in powers.iter_mut().rev().zip(values) {
        *power = value;
    }
}

/// The values at the beginnings of the spans of a strip's columns. They reveal most of the intervals that are too long.
struct Beginnings {
    gap: GapStart,
    /// The Chebyshev series of u_0 and of s, for every span.
    series: [[Lanes; 2]; MOST_SPANS],
    /// Number of leading coefficients of these series that are larger than rounding.
    kept: usize,
    /// The rounding of s, for every span \[mm, or 1/mm for g/ξ²\].
    rounding: [f64; MOST_SPANS],
}

impl Beginnings {
    /// Judges the beginnings of the columns taken last. Returns `None` if too few coefficients of u_0 or s are as small as
    /// rounding. The first span of a `short` strip is exempt for s, which is then computed for every column.
    #[inline(always)]
    fn new(relief: &Relief<'_>, columns: &Neighbours<'_>, short: bool) -> Option<Self> {
        let mut gap = if columns.contact { GapStart::Relative } else { GapStart::Plain };
        let mut judged = Judged::default();
        let mut begins = [[[0.0; MANY]; 2]; MOST_SPANS];
        let mut rounding = [0.0; MOST_SPANS];
        for (k, span) in columns.spans.iter().enumerate() {
            let mut s = span.base;
            rounding[k] = if columns.contact && k == 0 {
                s = lanes(|k| s[k] / (columns.xi[k] * columns.xi[k]));
                // A value with relative accuracy must keep it where it is smallest. If it varies much, the rounding of its
                // largest values is larger than that.
                let least = smallest(&s);
                let rounding = (0.5 * f64::EPSILON * largest(&s)).min(MOST_ROUNDING * least);
                rounding.max(ROUNDING_LEVEL * least)
            } else {
                f64::EPSILON * largest::<MANY>(&lanes(|k| relief.size(columns.xi[k], span.wheel.height[k])))
            };
            begins[k] = [chebyshev::coefficients(&span.wheel.u[0]), chebyshev::coefficients(&s)];
            judged.with(&begins[k][0], ROUNDING_LEVEL * largest(&span.wheel.u[1]));
            let before = judged;
            judged.with(&begins[k][1], rounding[k]);
            if k == 0 && short && judged.kept().is_none() {
                (judged, gap) = (before, GapStart::Computed);
            }
        }
        Some(Self { gap, series: begins, kept: judged.kept()?, rounding })
    }
}

/// Which Chebyshev coefficients are larger than rounding or not finite: their entries are not 0.
#[derive(Debug, Default, Clone, Copy)]
struct Judged([u64; MANY]);

impl Judged {
    /// Adds one more series, in which coefficients up to `allowed` count as rounding.
    #[inline(always)]
    fn with(&mut self, row: &Lanes, allowed: f64) {
        for (more, c) in self.0.iter_mut().zip(row) {
            let rounding = c.abs() <= allowed;
            *more |= u64::from(!rounding);
        }
    }

    /// Returns the number of coefficients up to the last one larger than rounding. Returns `None` if too few are as small
    /// as rounding.
    fn kept(&self) -> Option<usize> {
        let kept = self.0.iter().rposition(|&more| more != 0).map_or(1, |last| last + 1);
        (kept + PROOF <= MANY).then_some(kept)
    }
}
