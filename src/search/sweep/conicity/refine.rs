//! Refines a table of Δr as far as the conicity needs.

use std::collections::BinaryHeap;

use super::branches::{SideBranches, TouchBranch};
use super::movement::Knot;
use crate::error::Result;

/// Widest cell of the table \[mm\], as in EN 15302.
pub(super) const WIDEST: f64 = 0.1;

/// Smallest amplitude \[mm\] for whose conicity the table is refined; at smaller ones the results say how accurate
/// they are. Without this limit all searches would go to a jump of Δr at 0, which counts the same for every
/// amplitude, however small.
pub(super) const LEAST_AMPLITUDE: f64 = WIDEST;

/// Distance of a search from a hop, as a share of the cell's width, at which it locates the hop: by the
/// slopes of both gaps, to the square of the share.
const BESIDE: f64 = 1e-2;

/// Tries to meet a hop that its neighbours predict before a cell is halved: gaps that are about to close may
/// open again.
const TRIES: u8 = 2;

/// Number of chords of a cell over which Δr bends. They leave a sixteenth of what one chord errs by.
const BENDS: u32 = 4;

/// Returns the most searches for an amplitude \[mm\] and a relative accuracy ε of the conicity: 1 + log₂ 1/ε
/// for every tenth of a millimetre, with which halving alone would find one hop in each.
pub(super) fn most_searches(amplitude: f64, accuracy: f64) -> usize {
    // Saturates: an amplitude of a kilometre ends with the track.
    ((amplitude / WIDEST).ceil() * halvings(accuracy)) as usize
}

fn halvings(accuracy: f64) -> f64 {
    1.0 + (1.0 / accuracy).log2().max(0.0).ceil()
}

/// A hop of the contact to another place of its side.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hop {
    /// Distance from the node \[mm\].
    distance: f64,
    side: usize,
    /// Index of the other place among those of the side.
    to: usize,
    /// Change of Δr \[mm\].
    jump: f64,
}

/// Δr at a displacement; at a jump, on one side of it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    y: f64,
    /// Δr \[mm\].
    value: f64,
    /// dΔr/dy \[1\].
    slope: f64,
    /// Height of the axle's middle \[mm\], by the contact of each side.
    height: [f64; 2],
    /// Derivative of `height` with respect to y \[1\].
    climb: [f64; 2],
    /// The nearest hops below and above.
    hops: [Option<Hop>; 2],
}

/// The stretch between two nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BetweenNodes {
    ends: [Node; 2],
    /// Mean of |Δr| from 0 to this cell \[mm\].
    scale: f64,
    /// Possible error of ∫ Δr, taken as straight between the ends \[mm²\].
    defect: f64,
    /// Number of searches spent on hops that were not met.
    tries: u8,
}

/// The table while it is refined.
#[derive(Debug)]
pub(super) struct RefinedTable<F> {
    /// Fills in the places of contact at a displacement; returns false off the track.
    search: F,
    sides: SideBranches,
    /// Relative accuracy that halving alone would find hops to.
    accuracy: f64,
    searches: usize,
    cells: Vec<BetweenNodes>,
    /// The end of the table; `None` of a wheelset that is off its track at 0.
    outermost: Option<Node>,
    /// Number of first cells, before any was split, and the mean of |Δr| over them \[mm\].
    first_cells: usize,
    mean: f64,
    /// Cells that are not fine enough, as (bits of the influence, index): the bits order as non-negative
    /// numbers do.
    waiting: BinaryHeap<(u64, usize)>,
}

impl<F: FnMut(f64, &mut SideBranches) -> Result<bool>> RefinedTable<F> {
    /// Tabulates Δr at equal steps up to the amplitude, or as far as the track goes.
    ///
    /// # Errors
    /// The errors of `search`.
    pub(super) fn new(search: F, amplitude: f64, accuracy: f64) -> Result<Self> {
        let mut table = Self::at_centre(search, accuracy)?;
        let steps = (amplitude / WIDEST).ceil();
        for k in 1..=steps as u64 {
            if !table.extend(amplitude * k as f64 / steps)? {
                break;
            }
        }
        Ok(table)
    }

    /// Makes the table of the displacement 0 alone.
    ///
    /// # Errors
    /// The errors of `search`.
    pub(super) fn at_centre(search: F, accuracy: f64) -> Result<Self> {
        let mut table = Self {
            search,
            sides: SideBranches::default(),
            accuracy,
            searches: 0,
            cells: Vec::new(),
            outermost: None,
            first_cells: 0,
            mean: 0.0,
            waiting: BinaryHeap::new(),
        };
        table.outermost = table.searched(0.0)?;
        Ok(table)
    }

    /// Adds a cell up to a displacement \[mm\]; returns false, and adds none, where the wheelset is off its track.
    ///
    /// # Errors
    /// The errors of the search.
    pub(super) fn extend(&mut self, y: f64) -> Result<bool> {
        let Some(last) = self.outermost else { return Ok(false) };
        let Some(next) = self.searched(y)? else { return Ok(false) };
        self.first_cells += 1;
        self.mean += (next.value.abs() - self.mean) / self.first_cells as f64;
        self.push(BetweenNodes::new([last, next], self.mean));
        self.outermost = Some(next);
        Ok(true)
    }

    /// Adds cells of the same width over at least `length` \[mm\]; returns false where the wheelset leaves its track within them.
    ///
    /// # Errors
    /// The errors of the search.
    pub(super) fn lengthen(&mut self, length: f64) -> Result<bool> {
        let last = self.first_cells.saturating_add((length / WIDEST).ceil().max(1.0) as usize);
        while self.first_cells < last {
            if !self.extend(WIDEST * (self.first_cells + 1) as f64)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Returns the number of searches so far, and the most that there will be.
    pub(super) fn searches(&self) -> [usize; 2] {
        [self.searches, (self.first_cells as f64 * halvings(self.accuracy)) as usize]
    }

    /// Splits the cells that change a conicity by more than this relative influence, the most influential
    /// first, while searches are left; tells `told` the number of searches.
    ///
    /// # Errors
    /// The errors of the search.
    pub(super) fn refine(&mut self, influence: f64, told: &mut dyn FnMut(usize, usize)) -> Result<()> {
        let [_, most] = self.searches();
        while self.searches < most
            && let Some(&(bits, index)) = self.waiting.peek()
            && f64::from_bits(bits) > influence
        {
            self.waiting.pop();
            self.split(index)?;
            told(self.searches, most);
        }
        Ok(())
    }

    /// Returns the table in order of y: the ends of every cell, once where Δr does not jump, and places between them where
    /// Δr bends. Chords of a bend all err to one side, so that the error of a smooth Δr would add up over all cells.
    pub(super) fn knots(&self) -> Vec<Knot> {
        let mut cells: Vec<&BetweenNodes> = self.cells.iter().collect();
        cells.sort_unstable_by(|a, b| a.ends[0].y.total_cmp(&b.ends[0].y));
        let mut knots = Vec::with_capacity(2 * cells.len());
        for cell in cells {
            let [from, to] = cell.ends;
            let joined = knots.last().is_some_and(|last: &Knot| last.y == from.y && last.force == from.value);
            if !joined {
                knots.push(Knot { y: from.y, force: from.value, defect: 0.0 });
            }
            let parts = if cell.is_smooth() { BENDS } else { 1 };
            let defect = cell.defect / f64::from(parts);
            knots.extend((1..parts).map(|k| cell.on_curve(f64::from(k) / f64::from(parts), defect)));
            knots.push(Knot { y: to.y, force: to.value, defect });
        }
        knots
    }

    /// Searches once, at `y`.
    fn searched(&mut self, y: f64) -> Result<Option<Node>> {
        self.searches += 1;
        let found = (self.search)(y, &mut self.sides)?;
        Ok(found.then(|| Node::new(&self.sides, [0, 0], y, y)))
    }

    /// Replaces a cell by two, divided at a hop if one is met.
    fn split(&mut self, index: usize) -> Result<()> {
        let cell = self.cells[index];
        let [from, to] = cell.ends;
        let (y, hopped) = cell.proposal();
        // The ends are neighbouring numbers: there is nothing to split.
        if y <= from.y || y >= to.y {
            return Ok(());
        }
        let Some(middle) = self.searched(y)? else { return Ok(()) };
        let near = |hop: &Hop| hop.distance <= BESIDE * (to.y - from.y);
        let met = [0, 1].map(|way| middle.hops[way].filter(near).map(|hop| (way, hop)));
        let nearest = met.into_iter().flatten().min_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        let parts = match nearest.and_then(|(way, hop)| self.at_hop(&cell, y, way, hop)) {
            Some(parts) => parts,
            None => {
                let tries = if hopped { cell.tries + 1 } else { 0 };
                let part = |ends| BetweenNodes { tries, ..BetweenNodes::new(ends, cell.scale) };
                [part([from, middle]), part([middle, to])]
            }
        };
        self.cells[index] = parts[0];
        self.wait(index);
        self.push(parts[1]);
        Ok(())
    }

    /// Returns the parts of a cell below and above a hop that was seen from y; `None` if the hop is outside
    /// the cell: a hop that one end predicts may be the one at which the other end was placed.
    fn at_hop(&self, cell: &BetweenNodes, y: f64, way: usize, hop: Hop) -> Option<[BetweenNodes; 2]> {
        let [from, to] = cell.ends;
        let place = if way == 0 { y - hop.distance } else { y + hop.distance };
        if place <= from.y || place >= to.y {
            return None;
        }
        let mut other = [0, 0];
        other[hop.side] = hop.to;
        let mut nodes = [[0, 0], other].map(|chosen| Node::new(&self.sides, chosen, y, place));
        if way == 0 {
            nodes.swap(0, 1);
        }
        let mut parts =
            [BetweenNodes::new([from, nodes[0]], cell.scale), BetweenNodes::new([nodes[1], to], cell.scale)];
        // The slopes are those at y: the place is wrong by a share of the distance.
        let defect = hop.jump.abs() * hop.distance * hop.distance / (to.y - from.y);
        parts[0].defect += defect;
        Some(parts)
    }

    fn push(&mut self, cell: BetweenNodes) {
        self.cells.push(cell);
        self.wait(self.cells.len() - 1);
    }

    /// Adds a cell to those that may be split.
    fn wait(&mut self, index: usize) {
        let influence = self.cells[index].influence();
        if influence > 0.0 {
            self.waiting.push((influence.to_bits(), index));
        }
    }
}

impl Node {
    /// Makes the node at `y` from a search at `found` beside it, with the `chosen` place of each side in
    /// touch.
    fn new(sides: &SideBranches, chosen: [usize; 2], found: f64, y: f64) -> Self {
        let [left, right] = [0, 1].map(|side| sides[side][chosen[side]]);
        let (slope, off) = (right.growth - left.growth, y - found);
        let value = right.radius - left.radius;
        // A slope that the curvatures do not determine moves nothing.
        let moved = if slope.is_finite() { value + slope * off } else { value };
        let mut hops = [None; 2];
        for side in 0..2 {
            let touching = sides[side][chosen[side]];
            for (to, place) in sides[side].iter().enumerate().filter(|(to, _)| *to != chosen[side]) {
                let Some((way, distance)) = closing(&touching, place, off) else { continue };
                let change = place.radius - touching.radius;
                let jump = if side == 0 { -change } else { change };
                if hops[way].is_none_or(|nearest: Hop| distance < nearest.distance) {
                    hops[way] = Some(Hop { distance, side, to, jump });
                }
            }
        }
        Self {
            y,
            value: moved,
            slope,
            height: [left.height + left.climb * off, right.height + right.climb * off],
            climb: [left.climb, right.climb],
            hops,
        }
    }
}

/// Returns the direction in which the gap of another place closes while one touches, and the distance from
/// `off` beside the search.
fn closing(touching: &TouchBranch, other: &TouchBranch, off: f64) -> Option<(usize, f64)> {
    let (gap, rate) = (other.gap - touching.gap, touching.climb - other.climb);
    let way = usize::from(rate < 0.0);
    let at = -gap / rate - off;
    let distance = if way == 0 { -at } else { at };
    at.is_finite().then(|| (way, distance.max(0.0)))
}

impl BetweenNodes {
    fn new(ends: [Node; 2], scale: f64) -> Self {
        let mut cell = Self { ends, scale, defect: 0.0, tries: 0 };
        cell.defect = cell.width() * (cell.bend() + cell.unexplained() / 2.0) + cell.hopped();
        cell
    }

    fn width(&self) -> f64 {
        self.ends[1].y - self.ends[0].y
    }

    /// Returns a bound of the mean bend of Δr, if its slope turns from one end's to the other's \[mm\].
    fn bend(&self) -> f64 {
        let bend = self.width() * (self.ends[1].slope - self.ends[0].slope).abs() / 8.0;
        if bend.is_finite() { bend } else { 0.0 }
    }

    /// Returns the change of Δr that the slopes do not explain: jumps \[mm\].
    fn unexplained(&self) -> f64 {
        let [from, to] = &self.ends;
        let change = to.value - from.value;
        let explained = self.width() * (from.slope + to.slope) / 2.0;
        if explained.is_finite() { (change - explained).abs() } else { change.abs() }
    }

    /// Returns the change of ∫ Δr by hops that the ends predict inside the cell \[mm²\].
    fn hopped(&self) -> f64 {
        let inside = self.predicted().into_iter().flatten();
        inside.map(|(hop, _)| hop.jump.abs() * (self.width() - hop.distance)).sum()
    }

    /// Returns the hops inside the cell that the lower and the upper end predict, each with its displacement.
    fn predicted(&self) -> [Option<(Hop, f64)>; 2] {
        let [from, to] = &self.ends;
        let inside = |hop: &Hop| hop.distance < self.width();
        let up = from.hops[1].filter(inside).map(|hop| (hop, from.y + hop.distance));
        let down = to.hops[0].filter(inside).map(|hop| (hop, to.y - hop.distance));
        [up, down]
    }

    /// Returns whether the slopes of both ends explain the change of Δr. A curve with these slopes then errs less than a
    /// chord: by a third of the bend if one kink is inside, and far less if none is.
    fn is_smooth(&self) -> bool {
        self.hopped() == 0.0 && self.bend() > 0.0 && self.unexplained() <= self.bend()
    }

    /// Returns the place at a share of the width on the cubic with the values and slopes of both ends.
    fn on_curve(&self, share: f64, defect: f64) -> Knot {
        let ([from, to], rest) = (&self.ends, 1.0 - share);
        let chord = rest * from.value + share * to.value;
        let change = to.value - from.value;
        let turns = [self.width() * from.slope - change, self.width() * to.slope - change];
        let force = chord + share * rest * (rest * turns[0] - share * turns[1]);
        Knot { y: rest * from.y + share * to.y, force, defect }
    }

    /// Returns the relative change of the conicity at an amplitude just above the cell, if ∫ Δr changes by
    /// the defect: T's integrand falls by defect/(Δr · h) at the distance h below the turning point, where
    /// the movement spends √(h/ŷ) of its time.
    fn influence(&self) -> f64 {
        let [_, to] = &self.ends;
        let influence = self.defect / (self.scale * (self.width() * to.y.max(LEAST_AMPLITUDE)).sqrt());
        if influence.is_nan() { 0.0 } else { influence }
    }

    /// Returns where to search next, and whether a hop is expected there: where the nearer end predicts one,
    /// or where the tangents of the heights cross; otherwise the middle.
    fn proposal(&self) -> (f64, bool) {
        let [from, to] = &self.ends;
        let middle = from.y + self.width() / 2.0;
        let smooth = self.width() * self.bend();
        if self.tries >= TRIES || self.defect - smooth <= smooth {
            return (middle, false);
        }
        let nearest =
            self.predicted().into_iter().flatten().min_by(|a, b| a.0.distance.total_cmp(&b.0.distance));
        let inside = |y: &f64| (from.y..=to.y).contains(y);
        let place = nearest.map(|(_, y)| y).or_else(|| self.crossing()).filter(inside);
        // A hop at an end is met from inside: the rest beyond it is a hundredth of the cell.
        let margin = self.width() * BESIDE / 2.0;
        place.map_or((middle, false), |y| (y.clamp(from.y + margin, to.y - margin), true))
    }

    /// Returns where the tangents of the height at both ends cross, for the side where they differ more.
    fn crossing(&self) -> Option<f64> {
        let [from, to] = &self.ends;
        let turn = |side: usize| from.climb[side] - to.climb[side];
        let side = usize::from(turn(1).abs() > turn(0).abs());
        let short = to.height[side] - from.height[side] - to.climb[side] * self.width();
        let y = from.y + short / turn(side);
        y.is_finite().then_some(y)
    }
}
