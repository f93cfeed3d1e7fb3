//! Neighbouring columns at once: the formulas of [`super::column`] and [`super::spectral`], step by step for all, so
//! that no column waits for the one before it.

use super::Evaluator;
use super::column::{NEARLY_COVERED, Span, WheelSurface, sagitta};
use super::gap::contact_gaps;
use super::spectral::{Demand, MOST_COEFFICIENTS, ROUNDING_LEVEL, is_whole, nodes, powers};
use crate::profile::{Branch, BranchPoints};

/// So many.
pub const MANY: usize = 16;

/// A quantity of all columns.
pub type Row = [f64; MANY];

/// A row by its columns: a loop, since `array::from_fn` may be left out of line.
#[inline(always)]
pub fn row(value: impl Fn(usize) -> f64) -> Row {
    let mut row = [0.0; MANY];
    for (k, out) in row.iter_mut().enumerate() {
        *out = value(k);
    }
    row
}

/// Columns that pass the same branches in the same order.
#[derive(Debug)]
pub struct Columns {
    /// Their abscissae \[mm\].
    pub xi: Row,
    /// Whether they begin over both contact segments.
    pub contact: bool,
    /// In order of u.
    pub spans: Vec<SpanColumns>,
    /// Of every span the coefficients of q, s at its beginning and u_0: s + v Σ c_k v^k, v = u − u_0.
    pub quantities: Vec<Row>,
}

/// One span of every column.
#[derive(Debug)]
pub struct SpanColumns {
    /// Index of the first coefficient among the quantities.
    pub at: usize,
    /// Number of coefficients.
    pub n: usize,
    /// Length of the span in u, up to the window's end \[mm²\].
    pub width: Row,
    /// Size of the coordinates that s at the beginning is computed from \[mm\].
    pub height: Row,
}

/// Where the columns enter a span.
struct Begin<'a> {
    xi: Row,
    branch: &'a Branch,
    points: BranchPoints<MANY>,
    /// ζ of the wheel.
    height: Row,
    e: Row,
    u: Row,
    w: Row,
    /// Sagittae at the other end of the span.
    far: Row,
}

/// Points on the wheel, one of every column.
struct Feet {
    e: Row,
    rise: Row,
    w: Row,
    u: Row,
}

impl Columns {
    /// The columns at ξ up to u = `u_max`, with at least so many coefficients, if they are as the one in the middle;
    /// `None` where a column is not whole or no polynomial reaches the demand.
    #[inline(always)]
    pub fn new(evaluator: &Evaluator<'_>, demand: Demand, least: usize, u_max: f64, xi: Row) -> Option<Self> {
        let (wheel, middle) = (&evaluator.wheel, xi[MANY / 2]);
        let mut shape = Vec::with_capacity(4);
        wheel.spans(middle, u_max, &mut shape);
        if !is_whole(&shape, u_max) {
            return None;
        }
        let contact = evaluator.over_contact(middle, &shape[0]);
        let rail = evaluator.placement.rail.section.branch_at(middle)?;
        let rail_height = if contact && shape.len() == 1 { [0.0; MANY] } else { rail.points(&xi)?.1 };
        let mut spans: Vec<SpanColumns> = Vec::with_capacity(shape.len());
        let mut quantities = Vec::with_capacity(shape.len() * (MOST_COEFFICIENTS + 2));
        let mut u0 = [0.0; MANY];
        for (k, span) in shape.iter().enumerate() {
            let begin = wheel.begin(&xi, span, u0)?;
            let ends = wheel.ends(&begin, span);
            let last = k + 1 == shape.len();
            // A span that ends elsewhere than in the middle column is another shape.
            if !(0..MANY).all(|k| if last { ends[k] >= u_max } else { ends[k] > u0[k] && ends[k] <= u_max }) {
                return None;
            }
            let u1 = if last { [u_max; MANY] } else { ends };
            let at = quantities.len();
            let n = wheel.polynomials(&begin, &u1, demand, least, &mut quantities)?;
            quantities.push(if contact && k == 0 {
                contact_gaps(rail, begin.branch, &xi, &begin.height)
            } else {
                row(|k| begin.height[k] - rail_height[k])
            });
            quantities.push(u0);
            let height = row(|k| evaluator.size(xi[k], begin.height[k]));
            spans.push(SpanColumns { at, n, width: row(|k| u1[k] - u0[k]), height });
            u0 = u1;
        }
        Some(Self { xi, contact, spans, quantities })
    }
}

impl<'a> WheelSurface<'a> {
    #[inline(always)]
    fn begin(&self, xi: &Row, span: &Span, u: Row) -> Option<Begin<'a>> {
        let branch = &self.section.branches[span.branch];
        let piece = &self.section.pieces[span.piece];
        let [near, far] = self.sides();
        let (e, points, on_profile): (Row, _, Row) = if span.e[0] > 0.0 {
            let (point, height) = &piece.ends[near];
            (row(|k| (xi[k] - piece.xi[near]) / self.sin), point.into(), [*height; MANY])
        } else {
            let (points, heights) = branch.points(xi)?;
            ([0.0; MANY], points, heights)
        };
        let height: Row = row(|k| on_profile[k] + e[k] * self.cos);
        let w = row(|k| self.axle - xi[k] * self.sin - height[k] * self.cos);
        let far = if span.e[1].is_finite() {
            row(|k| (xi[k] - piece.xi[far]) / self.sin)
        } else {
            [f64::INFINITY; MANY]
        };
        Some(Begin { xi: *xi, branch, points, height, e, u, w, far })
    }

    /// u where the columns leave a span.
    #[inline(always)]
    fn ends(&self, begin: &Begin<'_>, span: &Span) -> Row {
        let (_, height) = self.section.pieces[span.piece].ends[self.sides()[1]];
        row(|k| {
            let e = begin.far[k];
            let w = self.axle - begin.xi[k] * self.sin - (height + e * self.cos) * self.cos;
            // An end that is not finite is beyond the window.
            if span.u[1].is_finite() && w > 0.0 { e * (2.0 * w + e) } else { f64::INFINITY }
        })
    }

    #[inline(always)]
    fn feet(&self, begin: &Begin<'_>, e: Row) -> Option<Feet> {
        let slope = begin.branch.chords_from(&begin.points, &row(|k| self.abscissa(begin.xi[k], e[k])))?;
        let rise = row(|k| (e[k] - begin.e[k]) * (self.cos - self.sin * slope[k]));
        let w = row(|k| begin.w[k] - rise[k] * self.cos);
        let u = row(|k| e[k] * (2.0 * w[k] + e[k]));
        Some(Feet { e, rise, w, u })
    }

    /// Points near u, as [`Self::foot_near`]; `None` where one is not.
    #[inline(always)]
    fn feet_near(&self, begin: &Begin<'_>, u: &Row) -> Option<Feet> {
        let step = |w: &Row| self.feet(begin, row(|k| sagitta(w[k], u[k]).max(begin.e[k]).min(begin.far[k])));
        let near = |feet: &Feet| {
            (0..MANY).all(|k| (feet.u[k] - u[k]).abs() <= (1.0 - NEARLY_COVERED) * u[k] && feet.w[k] > 0.0)
        };
        let first = step(&begin.w)?;
        if near(&first) { Some(first) } else { step(&first.w).filter(near) }
    }

    /// Appends the coefficients of q, as [`super::spectral::Spectral::polynomial`]; how many.
    #[inline(always)]
    fn polynomials(
        &self,
        begin: &Begin<'_>,
        u1: &Row,
        demand: Demand,
        least: usize,
        quantities: &mut Vec<Row>,
    ) -> Option<usize> {
        let end = self.feet_near(begin, u1)?;
        let run: Row = row(|k| end.e[k] - begin.e[k]);
        for n in least..=MOST_COEFFICIENTS {
            let (mut v, mut d) = ([[0.0; MANY]; MOST_COEFFICIENTS], [[0.0; MANY]; MOST_COEFFICIENTS]);
            for ((v, d), node) in v.iter_mut().zip(&mut d).zip(nodes(n)) {
                let feet = self.feet(begin, row(|k| begin.e[k] + run[k] * node))?;
                *v = row(|k| feet.u[k] - begin.u[k]);
                *d = row(|k| feet.rise[k] / v[k]);
            }
            let c = powers(&v[..n], &mut d[..n]);
            let good = |k: usize| {
                let v = end.u[k] - begin.u[k];
                let value = v * c[..n].iter().rev().fold(0.0, |q, c| q * v + c[k]);
                let rise = end.rise[k].abs();
                let allowed = demand.absolute.min(demand.relative * rise);
                (value - end.rise[k]).abs() <= allowed.max(ROUNDING_LEVEL * (rise + begin.e[k]))
            };
            if (0..MANY).all(good) {
                quantities.extend(&c[..n]);
                return Some(n);
            }
        }
        None
    }
}
