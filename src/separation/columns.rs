//! Neighbouring columns at once: the formulas of [`super::column`] and [`super::spectral`], step by step for all, so
//! that no column waits for the one before it.

use super::Evaluator;
use super::column::{LAST_STEP, NEARLY_COVERED, STEPS, WheelSurface, sagitta};
use super::gap::{contact_gap, contact_gaps};
use super::spectral::{Demand, MOST_COEFFICIENTS, ROUNDING_LEVEL, extrema, first_count, nodes, powers};
use crate::numerics::{chebyshev, nan_max};
use crate::profile::{Branch, BranchPoints, Branches, Piece, Section};

/// Columns that are computed at once: two of the widest vectors, and points of an interpolant.
pub const MANY: usize = chebyshev::POINTS;

/// Most spans of columns that are computed at once.
pub const MOST_SPANS: usize = 3;

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

/// Whether something holds for all columns; with no branch for each of them, as vector code has to be.
#[inline(always)]
pub fn every(holds: impl Fn(usize) -> bool) -> bool {
    let mut missed = 0;
    for k in 0..MANY {
        missed |= u64::from(!holds(k));
    }
    missed == 0
}

/// The largest magnitude in a row; what is not a number is passed over.
#[inline(always)]
pub fn largest(values: &Row) -> f64 {
    let mut most = row(|k| if values[k].abs() > 0.0 { values[k].abs() } else { 0.0 });
    // By halves: one after the other would take as long as everything else.
    let mut half = MANY;
    while half > 1 {
        half /= 2;
        for k in 0..half {
            most[k] = if most[k + half] > most[k] { most[k + half] } else { most[k] };
        }
    }
    most[0]
}

/// The smallest magnitude in a row, to two roundings; what is not a number is passed over.
#[inline(always)]
pub fn smallest(values: &Row) -> f64 {
    1.0 / largest(&row(|k| 1.0 / values[k]))
}

/// Columns that pass the same branches in the same order, or each a span of its own.
#[derive(Debug)]
pub struct Columns<'a> {
    wheel: WheelSurface<'a>,
    /// The columns' abscissae \[mm\].
    pub xi: Row,
    /// Whether they begin over both contact segments.
    pub contact: bool,
    /// In order of u.
    pub spans: Vec<SpanColumns<'a>>,
    /// Of the rail, each column's own; kept for their memory.
    rail_branches: Option<Branches<'a, MANY>>,
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
    /// u above that of the beginning, to its own roundings \[mm²\].
    v: Row,
}

impl<'a> Columns<'a> {
    /// None yet.
    pub fn new(wheel: WheelSurface<'a>) -> Self {
        Self {
            wheel,
            xi: [f64::NAN; MANY],
            contact: false,
            spans: Vec::with_capacity(MOST_SPANS),
            rail_branches: None,
        }
    }

    /// Takes the columns at ξ up to u = `u_max`; `None` where they do not pass the same branches, too many, or are not whole.
    #[inline(always)]
    pub fn take(&mut self, evaluator: &Evaluator<'a>, u_max: f64, xi: Row) -> Option<()> {
        let (wheel, section) = (&self.wheel, &evaluator.placement.rail.section);
        let mut index = wheel.first_piece(xi[MANY / 2])?;
        let rail_piece = section.piece_at(xi[MANY / 2])?;
        for piece in [rail_piece, &wheel.section.pieces[index]] {
            if !every(|k| (piece.xi[0] <= xi[k]) & (xi[k] <= piece.xi[1])) {
                return None;
            }
        }
        let rail = &section.branches[rail_piece.branch];
        self.contact = section.contact == Some(rail_piece.branch)
            && wheel.section.contact == Some(wheel.section.pieces[index].branch);
        self.xi = xi;
        self.spans.clear();
        let mut rail_height: Option<Row> = None;
        loop {
            let piece = &wheel.section.pieces[index];
            let mut here = wheel.span_at_many(&xi, piece, self.spans.is_empty())?;
            if let Some(before) = self.spans.last_mut() {
                // One joint: the spans meet, whatever rounding makes of it.
                before.u[1] = here.u[0];
                if !every(|k| before.u[0][k] < before.u[1][k]) {
                    return None;
                }
            }
            let [u0, u1] = &mut here.u;
            let last = every(|k| u1[k] >= u_max);
            if last {
                *u1 = [u_max; MANY];
            }
            // A span that only some of the columns leave is the end of one shape of columns.
            if !every(|k| (u0[k] < u1[k]) & (u1[k] <= u_max)) || self.spans.len() == MOST_SPANS {
                return None;
            }
            here.base = if self.contact && self.spans.is_empty() {
                contact_gaps(rail, &wheel.section.branches[piece.branch], &xi, (&here.points, &here.height))?
            } else {
                if rail_height.is_none() {
                    rail_height = Some(rail.points(&xi)?.1);
                }
                rail_height.map(|rail_height| row(|k| here.height[k] - rail_height[k]))?
            };
            self.spans.push(here);
            if last {
                return Some(());
            }
            index = wheel.next_piece(index)?;
        }
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
        let used = self.spans.pop().map(|span| span.branches);
        let branches = Branches::of(wheels.map(|piece| &wheel.section.branches[piece.branch]), used)?;
        let (points, height) = branches.points(&self.xi)?;
        let used = self.rail_branches.take();
        let rail_branches = Branches::of(rails.map(|piece| &rail.branches[piece.branch]), used)?;
        let (_, rail_height) = self.rail_branches.insert(rail_branches).points(&self.xi)?;
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

    /// u \[mm²\] and s \[mm\] at about these shares of one span's sagittae; `None` where they are not found.
    #[inline(always)]
    pub fn separations(&self, span: usize, shares: &Row) -> Option<[Row; 2]> {
        let span = &self.spans[span];
        let (_, run) = self.wheel.feet_near(span, &span.u[1])?;
        let feet = self.wheel.feet_by(span, &row(|k| run[k] * shares[k]));
        Some([feet.u, row(|k| span.base[k] + feet.rise[k])])
    }

    /// The largest difference \[mm\] of polynomials over one span from its rise at these shares of its sagittae; NaN where they
    /// are not found.
    #[inline(always)]
    pub fn difference(&self, span: usize, coefficients: &[Row], shares: &Row) -> f64 {
        let span = &self.spans[span];
        let Some((_, run)) = self.wheel.feet_near(span, &span.u[1]) else { return f64::NAN };
        let feet = self.wheel.feet_by(span, &row(|k| run[k] * shares[k]));
        error(coefficients, &feet).into_iter().fold(0.0, nan_max)
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
        let (end, run) = wheel.feet_near(span, &span.u[1])?;
        let allowed = row(|k| {
            let rise = end.rise[k].abs();
            let rounding = ROUNDING_LEVEL * (rise + span.e[0][k]);
            demand.absolute.min(demand.relative * rise).max(rounding)
        });
        let (length, u_max) = (row(|k| span.u[1][k] - span.u[0][k]), self.spans.last()?.u[1][0]);
        let begin = coefficients.len();
        let mut v = [[0.0; MANY]; MOST_COEFFICIENTS];
        for n in first_count(least, largest(&length), u_max)..=MOST_COEFFICIENTS {
            coefficients.resize(begin + n, [0.0; MANY]);
            let q = &mut coefficients[begin..];
            for ((v, q), node) in v.iter_mut().zip(&mut *q).zip(nodes(n)) {
                let feet = wheel.feet_by(span, &row(|k| run[k] * node));
                *v = feet.v;
                *q = row(|k| feet.rise[k] / v[k]);
            }
            powers(&v[..n], q);
            let mut errors = error(q, &end);
            for share in extrema(n) {
                let inner = error(q, &wheel.feet_by(span, &row(|k| run[k] * share)));
                errors = row(|k| nan_max(errors[k], inner[k]));
            }
            // An error that is no number is within no demand.
            if every(|k| errors[k] <= allowed[k]) {
                return Some((n, largest(&errors)));
            }
        }
        None
    }
}

/// |rise of the polynomials − rise| at points of a span \[mm\].
#[inline(always)]
fn error(q: &[Row], feet: &Feet) -> Row {
    let mut value = [0f64; MANY];
    for q in q.iter().rev() {
        value = row(|k| value[k] * feet.v[k] + q[k]);
    }
    row(|k| (value[k] * feet.v[k] - feet.rise[k]).abs())
}

/// The piece that holds ξ inside; pieces before it are taken from `rest`.
fn piece_inside<'a>(rest: &mut &'a [Piece], xi: f64) -> Option<&'a Piece> {
    let before = rest.iter().take_while(|piece| piece.xi[1] < xi).count();
    *rest = &rest[before..];
    rest.first().filter(|piece| piece.xi[0] < xi && xi < piece.xi[1])
}

impl SpanColumns<'_> {
    /// Size of the coordinates that s at the beginning is computed from \[mm\].
    #[inline(always)]
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

    /// One span of all columns to the end of its piece, from the midplane if it is the `first` one; s not yet known.
    #[inline(always)]
    fn span_at_many(&self, xi: &Row, piece: &Piece, first: bool) -> Option<SpanColumns<'a>> {
        let branch = &self.section.branches[piece.branch];
        let mut span = if first {
            self.span_from(xi, branch, [0.0; MANY], branch.points(xi)?)
        } else {
            let near = self.sides()[0];
            let (point, height) = &piece.ends[near];
            let e0 = row(|k| (xi[k] - piece.xi[near]) / self.sin);
            self.span_from(xi, branch, e0, (branch.repeated(point), [*height; MANY]))
        };
        for (k, &xi) in xi.iter().enumerate() {
            [span.e[1][k], span.u[1][k]] = self.leaves(xi, piece);
        }
        Some(span)
    }

    /// The spans of columns at ξ over one piece, each from where it enters the piece; s and the ends not known.
    #[inline(always)]
    pub(super) fn spans_over(&self, xi: &Row, piece: &Piece) -> Option<SpanColumns<'a>> {
        let branch = &self.section.branches[piece.branch];
        let [low, high] = piece.xi;
        let begin = row(|k| xi[k].max(low).min(high));
        let e0 = row(|k| if xi[k] == begin[k] { 0.0 } else { (xi[k] - begin[k]) / self.sin });
        Some(self.span_from(xi, branch, e0, branch.points(&begin)?))
    }

    /// The spans that begin at points of a branch with these heights, where the sagittae are e_0.
    #[inline(always)]
    fn span_from(
        &self,
        xi: &Row,
        branch: &'a Branch,
        e0: Row,
        (points, on_profile): (BranchPoints<MANY>, Row),
    ) -> SpanColumns<'a> {
        let height = row(|k| on_profile[k] + e0[k] * self.cos);
        let w = row(|k| self.axle_distance(xi[k], height[k]));
        let u = [row(|k| e0[k] * (2.0 * w[k] + e0[k])), [f64::NAN; MANY]];
        let (branches, base) = (Branches::One(branch), [f64::NAN; MANY]);
        SpanColumns { branches, points, base, height, u, e: [e0, [f64::INFINITY; MANY]], w }
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
            if every(settled) {
                return Some(feet).filter(|feet| every(|k| feet.w[k] > 0.0));
            }
            last = change;
        }
        None
    }

    /// The points with sagittae e.
    #[inline(always)]
    fn feet(&self, xi: &Row, span: &SpanColumns<'_>, e: Row) -> Option<Feet> {
        let slope = span.branches.chords_from(&span.points, &row(|k| self.abscissa(xi[k], e[k])))?;
        let runs = row(|k| e[k] - span.e[0][k]);
        let rise = row(|k| runs[k] * (self.cos - self.sin * slope[k]));
        Some(self.feet_over(span, &runs, rise))
    }

    /// Points with sagittae larger by about `runs` than at the span's beginning, with no root.
    #[inline(always)]
    fn feet_by(&self, span: &SpanColumns<'_>, runs: &Row) -> Feet {
        let [climb, stretch] = span.branches.chords_near(&span.points, &row(|k| -runs[k] * self.sin));
        let rise = row(|k| runs[k] * (self.cos * stretch[k] - self.sin * climb[k]));
        self.feet_over(span, &row(|k| runs[k] * stretch[k]), rise)
    }

    /// The points that lie `rise` above the span's beginning, with sagittae larger by `runs`.
    #[inline(always)]
    fn feet_over(&self, span: &SpanColumns<'_>, runs: &Row, rise: Row) -> Feet {
        let e = row(|k| span.e[0][k] + runs[k]);
        let w = row(|k| span.w[k] - rise[k] * self.cos);
        let u = row(|k| e[k] * (2.0 * w[k] + e[k]));
        // u − u_0 with no difference of what is nearly equal: w falls by rise cosθ.
        let v = row(|k| {
            let [e0, e1] = [span.e[0][k], e[k]];
            runs[k] * (2.0 * w[k] + (e0 + e1)) - 2.0 * e0 * (rise[k] * self.cos)
        });
        Feet { e, rise, w, u, v }
    }

    /// Points near u, as [`Self::foot_near`], and the runs that [`Self::feet_by`] finds them by; `None` where one is not.
    #[inline(always)]
    fn feet_near(&self, span: &SpanColumns<'_>, u: &Row) -> Option<(Feet, Row)> {
        let [low, high] = &span.e;
        // The first is as good as if the profile were level: nothing but its slope is then to be found.
        let mut w = row(|k| span.w[k] - (sagitta(span.w[k], u[k]) - low[k]) * self.cos * self.cos);
        let mut shrink = [1.0; MANY];
        for _ in 0..=STEPS {
            let runs = row(|k| sagitta(w[k], u[k]).max(low[k]).min(high[k]) - low[k]);
            let runs = row(|k| runs[k] * shrink[k]);
            let feet = self.feet_by(span, &runs);
            if every(|k| ((feet.u[k] - u[k]).abs() <= (1.0 - NEARLY_COVERED) * u[k]) & (feet.w[k] > 0.0)) {
                return Some((feet, runs));
            }
            shrink = row(|k| runs[k] / (feet.e[k] - low[k]));
            w = feet.w;
        }
        None
    }
}
