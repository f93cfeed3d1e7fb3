//! Neighbouring columns at once: the formulas of [`super::column`] and [`super::spectral`], step by step for all, so
//! that no column waits for the one before it.

use super::Evaluator;
use super::column::{LAST_STEP, NEARLY_COVERED, STEPS, Span, WheelSurface, sagitta};
use super::gap::{contact_gap, contact_gaps};
use super::spectral::{Demand, MOST_COEFFICIENTS, ROUNDING_LEVEL, inner_extremum, is_whole, nodes, powers};
use crate::profile::{BranchPoints, Branches, Piece, Section};

/// Columns that are computed at once: two of the widest vectors.
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

/// Columns that pass the same branches in the same order, or each a span of its own.
#[derive(Debug)]
pub struct Columns<'a> {
    wheel: WheelSurface<'a>,
    /// Scratch space: spans of the column in the middle.
    shape: Vec<Span>,
    /// The columns' abscissae \[mm\].
    pub xi: Row,
    /// Whether they begin over both contact segments.
    pub contact: bool,
    /// In order of u.
    pub spans: Vec<SpanColumns<'a>>,
}

/// Where the columns enter and leave a span.
#[derive(Debug)]
pub struct SpanColumns<'a> {
    branches: Branches<'a, MANY>,
    points: BranchPoints<MANY>,
    /// s there \[mm\].
    pub base: Row,
    /// ζ of the wheel there \[mm\].
    pub height: Row,
    /// Range of u, up to the window's end \[mm²\].
    pub u: [Row; 2],
    /// Range of e \[mm\].
    pub e: [Row; 2],
    /// Axle distance at the beginning \[mm\].
    w: Row,
}

/// Points on the wheel, one of every column.
pub struct Feet {
    /// Sagitta \[mm\].
    pub e: Row,
    /// ζ above the beginning of the span \[mm\].
    pub rise: Row,
    w: Row,
    u: Row,
}

impl<'a> Columns<'a> {
    /// None yet.
    pub fn new(wheel: WheelSurface<'a>) -> Self {
        Self { wheel, shape: Vec::new(), xi: [f64::NAN; MANY], contact: false, spans: Vec::new() }
    }

    /// Takes the columns at ξ up to u = `u_max`, if they are as the one in the middle; `None` where one is not, or not
    /// whole.
    #[inline(always)]
    pub fn take(&mut self, evaluator: &Evaluator<'a>, u_max: f64, xi: Row) -> Option<()> {
        let (wheel, middle) = (&self.wheel, xi[MANY / 2]);
        wheel.spans(middle, u_max, &mut self.shape);
        if !is_whole(&self.shape, u_max) {
            return None;
        }
        let (contact, single) = (evaluator.over_contact(middle, &self.shape[0]), self.shape.len() == 1);
        let rail = evaluator.placement.rail.section.branch_at(middle)?;
        let rail_height = if contact && single { [0.0; MANY] } else { rail.points(&xi)?.1 };
        (self.xi, self.contact) = (xi, contact);
        self.spans.clear();
        for (k, span) in self.shape.iter().enumerate() {
            let u0 = self.spans.last().map_or([0.0; MANY], |before| before.u[1]);
            let mut here = wheel.span_at_many(&xi, span, u0)?;
            let (ends, last) = (here.u[1], k + 1 == self.shape.len());
            // A span that ends elsewhere than in the middle column is another shape.
            if !(0..MANY).all(|k| if last { ends[k] >= u_max } else { ends[k] > u0[k] && ends[k] <= u_max }) {
                return None;
            }
            if last {
                here.u[1] = [u_max; MANY];
            }
            here.base = if contact && k == 0 {
                contact_gaps(rail, &wheel.section.branches[span.branch], &xi, (&here.points, &here.height))?
            } else {
                row(|k| here.height[k] - rail_height[k])
            };
            self.spans.push(here);
        }
        Some(())
    }

    /// Takes columns each over its own branches, if all are over the same one or over cubics, as of splines; for each whether
    /// it is one that lies over one branch of either body. In the place of one that does not stands one that does; `None`
    /// where none does.
    #[inline(always)]
    pub fn take_each(&mut self, evaluator: &Evaluator<'a>, u_max: f64, xi: &[f64]) -> Option<[bool; MANY]> {
        let (rail, wheel) = (&evaluator.placement.rail.section, &self.wheel);
        let pairs = wheel.pieces_under(rail, u_max, xi);
        let (first, stand_in) = pairs.iter().enumerate().find_map(|(k, pair)| Some((k, (*pair)?)))?;
        let [mut rails, mut wheels] = [stand_in.0, stand_in.1].map(|piece| [piece; MANY]);
        self.xi = [xi[first]; MANY];
        for (k, pair) in pairs.iter().enumerate() {
            if let Some((r, w)) = pair {
                (rails[k], wheels[k], self.xi[k]) = (*r, *w, xi[k]);
            }
        }
        let branches = Branches::of(wheels.map(|piece| &wheel.section.branches[piece.branch]))?;
        let (points, height) = branches.points(&self.xi)?;
        let (_, rail_height) =
            Branches::of(rails.map(|piece| &rail.branches[piece.branch]))?.points(&self.xi)?;
        let contact = [rail.contact, wheel.section.contact];
        let base = row(|k| {
            let [r, w] = [rails[k].branch, wheels[k].branch];
            if contact == [Some(r), Some(w)] {
                contact_gap(&rail.branches[r], &wheel.section.branches[w], self.xi[k], height[k])
            } else {
                height[k] - rail_height[k]
            }
        });
        let zero = [0.0; MANY];
        self.contact = false;
        self.spans.clear();
        self.spans.push(SpanColumns {
            branches,
            points,
            base,
            height,
            u: [zero, [u_max; MANY]],
            e: [zero, row(|k| wheel.leaves(self.xi[k], wheels[k])[0])],
            w: row(|k| wheel.axle_distance(self.xi[k], height[k])),
        });
        Some(pairs.map(|pair| pair.is_some()))
    }

    /// Appends the coefficients of q over one span in powers of u − u_0, at least so many, as
    /// [`super::spectral::Spectral::polynomial`]; how many, and their largest measured error \[mm\]. `None` where no degree
    /// reaches the demand.
    #[inline(always)]
    pub fn polynomials(
        &self,
        span: usize,
        demand: Demand,
        least: usize,
        coefficients: &mut Vec<Row>,
    ) -> Option<(usize, f64)> {
        let (wheel, span) = (&self.wheel, &self.spans[span]);
        let end = wheel.feet_near(&self.xi, span, &span.u[1])?;
        let run: Row = row(|k| end.e[k] - span.e[0][k]);
        let allowed = row(|k| {
            let rise = end.rise[k].abs();
            let rounding = ROUNDING_LEVEL * (rise + span.e[0][k]);
            demand.absolute.min(demand.relative * rise).max(rounding)
        });
        let at = |share: f64| wheel.feet(&self.xi, span, row(|k| span.e[0][k] + run[k] * share));
        for n in least..=MOST_COEFFICIENTS {
            let (mut v, mut d) = ([[0.0; MANY]; MOST_COEFFICIENTS], [[0.0; MANY]; MOST_COEFFICIENTS]);
            for ((v, d), node) in v.iter_mut().zip(&mut d).zip(nodes(n)) {
                let feet = at(*node)?;
                *v = row(|k| feet.u[k] - span.u[0][k]);
                *d = row(|k| feet.rise[k] / v[k]);
            }
            let c = powers(&v[..n], &mut d[..n]);
            let error = |feet: &Feet| {
                row(|k| {
                    let v = feet.u[k] - span.u[0][k];
                    let value = v * c[..n].iter().rev().fold(0.0, |q, c| q * v + c[k]);
                    (value - feet.rise[k]).abs()
                })
            };
            let errors = [error(&end), error(&at(inner_extremum(n))?)];
            // An error that is no number is within no demand.
            if (0..MANY).all(|k| errors[0][k] <= allowed[k] && errors[1][k] <= allowed[k]) {
                coefficients.extend(&c[..n]);
                return Some((n, errors.as_flattened().iter().fold(0.0, |most, error| error.max(most))));
            }
        }
        None
    }
}

/// The piece that holds ξ inside; pieces before it are taken from `rest`.
fn piece_inside<'a>(rest: &mut &'a [Piece], xi: f64) -> Option<&'a Piece> {
    let before = rest.iter().take_while(|piece| piece.xi[1] < xi).count();
    *rest = &rest[before..];
    rest.first().filter(|piece| piece.xi[0] < xi && xi < piece.xi[1])
}

impl SpanColumns<'_> {
    /// Size of the coordinates that s at the beginning is computed from \[mm\].
    pub fn size(&self, evaluator: &Evaluator<'_>, xi: &Row) -> Row {
        row(|k| evaluator.size(xi[k], self.height[k]))
    }
}

impl<'a> WheelSurface<'a> {
    /// The pieces of rail and wheel at each ξ where the column lies over one of either.
    fn pieces_under<'r>(
        &self,
        rail: &'r Section,
        u_max: f64,
        xi: &[f64],
    ) -> [Option<(&'r Piece, &'a Piece)>; MANY] {
        let mut found = [None; MANY];
        let (mut rest_r, mut rest_w) = (rail.pieces_from(xi[0]), self.section.pieces_from(xi[0]));
        for (found, &xi) in found.iter_mut().zip(xi) {
            let pair = piece_inside(&mut rest_r, xi).zip(piece_inside(&mut rest_w, xi));
            *found = pair.filter(|(_, w)| self.leaves(xi, w)[1] >= u_max);
        }
        found
    }

    /// One span of all columns, from u as given to the end of its piece; s not yet known.
    #[inline(always)]
    fn span_at_many(&self, xi: &Row, span: &Span, u0: Row) -> Option<SpanColumns<'a>> {
        let branch = &self.section.branches[span.branch];
        let piece = &self.section.pieces[span.piece];
        let near = self.sides()[0];
        let sagitta = |end: f64| row(|k| (xi[k] - end) / self.sin);
        let (e0, points, on_profile) = if span.e[0] > 0.0 {
            let (point, height) = &piece.ends[near];
            (sagitta(piece.xi[near]), point.into(), [*height; MANY])
        } else {
            let (points, heights) = branch.points(xi)?;
            ([0.0; MANY], points, heights)
        };
        let height = row(|k| on_profile[k] + e0[k] * self.cos);
        let w = row(|k| self.axle_distance(xi[k], height[k]));
        let (mut e1, mut u1) = ([f64::INFINITY; MANY], [f64::INFINITY; MANY]);
        // An end that the middle column has not is beyond the window.
        for k in 0..MANY {
            let end = self.leaves(xi[k], piece);
            e1[k] = if span.e[1].is_finite() { end[0] } else { e1[k] };
            u1[k] = if span.u[1].is_finite() { end[1] } else { u1[k] };
        }
        let branches = Branches::One(branch);
        Some(SpanColumns { branches, points, base: [f64::NAN; MANY], height, u: [u0, u1], e: [e0, e1], w })
    }

    /// The spans of columns at ξ over one piece, each from where it enters the piece; s and the ends not known.
    #[inline(always)]
    pub(super) fn spans_over(&self, xi: &Row, piece: &Piece) -> Option<SpanColumns<'a>> {
        let branch = &self.section.branches[piece.branch];
        let [low, high] = piece.xi;
        let begin = row(|k| xi[k].max(low).min(high));
        let (points, heights) = branch.points(&begin)?;
        let e0 = row(|k| if xi[k] == begin[k] { 0.0 } else { (xi[k] - begin[k]) / self.sin });
        let height = row(|k| heights[k] + e0[k] * self.cos);
        let w = row(|k| self.axle_distance(xi[k], height[k]));
        let (branches, base, u) = (Branches::One(branch), [f64::NAN; MANY], [[f64::NAN; MANY]; 2]);
        Some(SpanColumns { branches, points, base, height, u, e: [e0, [f64::INFINITY; MANY]], w })
    }

    /// The points at u, as [`Self::foot_at`]; `None` where one is not found by Newton's steps.
    #[inline(always)]
    pub(super) fn feet_at(&self, xi: &Row, span: &SpanColumns<'_>, u: &Row) -> Option<Feet> {
        let mut feet = self.feet(xi, span, row(|k| sagitta(span.w[k], u[k])))?;
        let mut last = feet.e;
        for _ in 0..STEPS {
            let e = row(|k| {
                let run = feet.e[k] - span.e[0][k];
                let fall = if run == 0.0 { 0.0 } else { self.cos * feet.rise[k] / run };
                feet.e[k] - (feet.u[k] - u[k]) / (2.0 * (feet.w[k] + feet.e[k] * (1.0 - fall)))
            });
            let change = row(|k| (e[k] - feet.e[k]).abs());
            feet = self.feet(xi, span, e)?;
            let settled = |k: usize| {
                change[k] * change[k] <= f64::EPSILON * e[k] * last[k] && change[k] <= LAST_STEP * feet.w[k]
            };
            if (0..MANY).all(settled) {
                return Some(feet).filter(|feet| feet.w.iter().all(|&w| w > 0.0));
            }
            last = change;
        }
        None
    }

    #[inline(always)]
    fn feet(&self, xi: &Row, span: &SpanColumns<'_>, e: Row) -> Option<Feet> {
        let slope = span.branches.chords_from(&span.points, &row(|k| self.abscissa(xi[k], e[k])))?;
        let rise = row(|k| (e[k] - span.e[0][k]) * (self.cos - self.sin * slope[k]));
        let w = row(|k| span.w[k] - rise[k] * self.cos);
        let u = row(|k| e[k] * (2.0 * w[k] + e[k]));
        Some(Feet { e, rise, w, u })
    }

    /// Points near u, as [`Self::foot_near`]; `None` where one is not.
    #[inline(always)]
    fn feet_near(&self, xi: &Row, span: &SpanColumns<'_>, u: &Row) -> Option<Feet> {
        let [low, high] = &span.e;
        let step = |w: &Row| self.feet(xi, span, row(|k| sagitta(w[k], u[k]).max(low[k]).min(high[k])));
        let near = |feet: &Feet| {
            (0..MANY).all(|k| (feet.u[k] - u[k]).abs() <= (1.0 - NEARLY_COVERED) * u[k] && feet.w[k] > 0.0)
        };
        let mut feet = step(&span.w)?;
        for _ in 0..STEPS {
            if near(&feet) {
                return Some(feet);
            }
            feet = step(&feet.w)?;
        }
        None
    }
}
