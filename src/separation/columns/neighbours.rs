//! Several neighbouring columns at once: the branches that they pass, and their values at the beginning of each.

use crate::numerics::lanes::{Lanes, MANY, every, lanes};
use crate::profile::{Branches, Piece, Section};
use crate::separation::gap::contact_gaps;
use crate::separation::relief::Relief;
use crate::separation::span::SpanLanes;
use crate::separation::wheel_surface::WheelSurface;

/// Most spans of a column that are computed for several columns at once.
pub const MOST_SPANS: usize = 3;

/// [`MANY`] neighbouring columns. They pass the same branches in the same order, or each has one span over a branch of its
/// own.
#[derive(Debug)]
pub struct Neighbours<'a> {
    /// The wheel below the columns.
    pub wheel: WheelSurface<'a>,
    /// ξ of the columns \[mm\].
    pub xi: Lanes,
    /// Whether the columns of [`Self::take`] begin over both contact segments; false for those of [`Self::take_each`].
    pub contact: bool,
    /// The spans in order of u.
    pub spans: Vec<SpanColumns<'a>>,
    /// The rail's branches, if each column has its own. They are kept so that their memory is used again.
    rail_branches: Option<Branches<'a, MANY>>,
}

/// One span of [`MANY`] columns.
#[derive(Debug)]
pub struct SpanColumns<'a> {
    /// The span on the wheel. The last span ends at the window's u.
    pub wheel: SpanLanes<'a, MANY>,
    /// s at the beginning of the span \[mm\].
    pub base: Lanes,
}

impl<'a> Neighbours<'a> {
    /// Makes an empty set of columns.
    pub fn new(wheel: WheelSurface<'a>) -> Self {
        Self {
            wheel,
            xi: [f64::NAN; MANY],
            contact: false,
            spans: Vec::with_capacity(MOST_SPANS),
            rail_branches: None,
        }
    }

    /// Takes over the columns at ξ, up to u = `u_max` \[mm²\]. Returns `None` if they do not pass the same branches, pass
    /// more than [`MOST_SPANS`] or a step of the envelope, or have parts without a surface.
    #[inline(always)]
    pub fn take(&mut self, relief: &Relief<'a>, u_max: f64, xi: Lanes) -> Option<()> {
        let (wheel, section) = (&self.wheel, relief.below);
        let mut index = wheel.first_piece(xi[MANY / 2])?;
        let rail_piece = section.piece_at(xi[MANY / 2])?;
        for piece in [rail_piece, &wheel.section.pieces[index]] {
            if !every::<MANY>(|k| (piece.xi.low <= xi[k]) & (xi[k] <= piece.xi.high)) {
                return None;
            }
        }
        let rail = &section.branches[rail_piece.branch];
        self.contact = section.contact == Some(rail_piece.branch)
            && wheel.section.contact == Some(wheel.section.pieces[index].branch);
        self.xi = xi;
        self.spans.clear();
        let mut rail_height: Option<Lanes> = None;
        loop {
            let piece = &wheel.section.pieces[index];
            let mut here = span_over(wheel, &xi, piece, self.spans.is_empty())?;
            if let Some(before) = self.spans.last_mut() {
                // The spans meet at one joint, in spite of rounding.
                before.wheel.u[1] = here.u[0];
                if !every::<MANY>(|k| before.wheel.u[0][k] < before.wheel.u[1][k]) {
                    return None;
                }
            }
            let [u0, u1] = &mut here.u;
            let last = every::<MANY>(|k| u1[k] >= u_max);
            if last {
                *u1 = [u_max; MANY];
            }
            // If only some columns leave a span, the columns differ in what they pass.
            if !every::<MANY>(|k| (u0[k] < u1[k]) & (u1[k] <= u_max)) || self.spans.len() == MOST_SPANS {
                return None;
            }
            let base = if self.contact && self.spans.is_empty() {
                contact_gaps(rail, &wheel.section.branches[piece.branch], &xi, &here.height)?
            } else {
                if rail_height.is_none() {
                    rail_height = Some(rail.points(&xi)?.1);
                }
                rail_height.map(|rail_height| lanes(|k| here.height[k] - rail_height[k]))?
            };
            self.spans.push(SpanColumns { wheel: here, base });
            if last {
                return Some(());
            }
            let next = wheel.next_piece(index)?;
            if wheel.is_step(index, next) {
                return None;
            }
            index = next;
        }
    }

    /// Takes over columns that have a branch of their own each, if all lie over one branch or all over cubics, as over
    /// splines.
    ///
    /// Returns for each column whether it was taken, which means that it lies over one branch of each body. The lane of a
    /// column that was not taken holds a copy of one that was. Returns `None` if none was taken.
    #[inline(always)]
    pub fn take_each(&mut self, relief: &Relief<'a>, u_max: f64, xi: &[f64]) -> Option<[bool; MANY]> {
        let (rail, wheel) = (relief.below, &self.wheel);
        let pairs = pieces_under(wheel, rail, u_max, xi);
        let (first, stand_in) = pairs.iter().enumerate().find_map(|(k, pair)| Some((k, (*pair)?)))?;
        let [mut rails, mut wheels] = [stand_in.0, stand_in.1].map(|piece| [piece; MANY]);
        self.xi = [xi[first]; MANY];
        for (k, pair) in pairs.iter().enumerate() {
            if let Some((r, w)) = pair {
                (rails[k], wheels[k], self.xi[k]) = (*r, *w, xi[k]);
            }
        }
        let used = self.spans.pop().map(|span| span.wheel.branches);
        let branches = Branches::of(wheels.map(|piece| &wheel.section.branches[piece.branch]), used)?;
        let (points, height) = branches.points(&self.xi)?;
        let used = self.rail_branches.take();
        let rail_branches = Branches::of(rails.map(|piece| &rail.branches[piece.branch]), used)?;
        let (_, rail_height) = self.rail_branches.insert(rail_branches).points(&self.xi)?;
        let mut base: Lanes = lanes(|k| height[k] - rail_height[k]);
        let mut over_contact = [false; MANY];
        for (k, over) in over_contact.iter_mut().enumerate() {
            *over = [rail.contact, wheel.section.contact] == [rails[k].branch, wheels[k].branch].map(Some);
        }
        if let Some(k) = over_contact.iter().position(|&over| over) {
            let [r, w] = [&rail.branches[rails[k].branch], &wheel.section.branches[wheels[k].branch]];
            // Lanes over other branches are computed as copies of this one.
            let lane = |j: usize| if over_contact[j] { j } else { k };
            let (xi, zeta_w): (Lanes, Lanes) = (lanes(|j| self.xi[lane(j)]), lanes(|j| height[lane(j)]));
            let gaps = contact_gaps(r, w, &xi, &zeta_w)?;
            base = lanes(|k| if over_contact[k] { gaps[k] } else { base[k] });
        }
        let zero = [0.0; MANY];
        self.contact = false;
        self.spans.clear();
        let e = [zero, lanes(|k| wheel.leaves(self.xi[k], wheels[k])[0])];
        let (u, w) = ([zero, [u_max; MANY]], lanes(|k| wheel.axle_distance(self.xi[k], height[k])));
        let span = SpanLanes { branches, points, height, w, e, u };
        self.spans.push(SpanColumns { wheel: span, base });
        Some(pairs.map(|pair| pair.is_some()))
    }
}

/// Finds the piece that holds ξ in its interior, and removes earlier pieces from `rest`.
fn piece_inside<'a>(rest: &mut &'a [Piece], xi: f64) -> Option<&'a Piece> {
    let before = rest.iter().take_while(|piece| piece.xi.high < xi).count();
    *rest = &rest[before..];
    rest.first().filter(|piece| piece.xi.surrounds(xi))
}

/// Finds the pieces of rail and wheel for each ξ whose column lies over one piece of each body.
fn pieces_under<'r, 'w>(
    wheel: &WheelSurface<'w>,
    rail: &'r Section,
    u_max: f64,
    xi: &[f64],
) -> [Option<(&'r Piece, &'w Piece)>; MANY] {
    let mut found = [None; MANY];
    let (mut rest_r, mut rest_w) = (rail.pieces_from(xi[0]), wheel.section.pieces_from(xi[0]));
    for (found, &xi) in found.iter_mut().zip(xi) {
        let pair = piece_inside(&mut rest_r, xi).zip(piece_inside(&mut rest_w, xi));
        *found = pair.filter(|(_, w)| wheel.leaves(xi, w)[1] >= u_max);
    }
    found
}

/// Makes one span of all columns to the end of its piece. If `first`, it begins in the midplane. Returns `None` if a point
/// is not found.
#[inline(always)]
fn span_over<'a>(
    wheel: &WheelSurface<'a>,
    xi: &Lanes,
    piece: &Piece,
    first: bool,
) -> Option<SpanLanes<'a, MANY>> {
    let branch = &wheel.section.branches[piece.branch];
    let mut span = if first {
        wheel.span_from(xi, branch, [0.0; MANY], branch.points(xi)?)
    } else {
        let near = wheel.sides()[0];
        let (point, height) = wheel.section.end(piece, near);
        let e0 = lanes(|k| (xi[k] - piece.xi[near]) / wheel.sin);
        wheel.span_from(xi, branch, e0, (point.repeated(), [height; MANY]))
    };
    for (k, &xi) in xi.iter().enumerate() {
        [span.e[1][k], span.u[1][k]] = wheel.leaves(xi, piece);
    }
    Some(span)
}
