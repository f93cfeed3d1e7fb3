//! Δr as a table that is as fine as the conicity needs it.

use std::collections::BinaryHeap;

use super::branches::{Branch, Sides};
use super::movement::Knot;
use crate::error::Result;

/// Widest cell of the table \[mm\], as EN 15302 has it.
const WIDEST: f64 = 0.1;

/// Smallest amplitude \[mm\] whose conicity is refined for; smaller ones say how accurate they are. Without it all searches would
/// go to where Δr jumps at 0: that counts the same for every amplitude, however small.
pub(super) const LEAST_AMPLITUDE: f64 = WIDEST;

/// A search this share of a cell's width from a hop places it: by the slopes of both gaps, to the square of the share.
const BESIDE: f64 = 1e-2;

/// Tries to meet a hop that its neighbours predict before a cell is halved: gaps that are about to close may open again.
const TRIES: u8 = 2;

/// The most searches for an amplitude \[mm\] and a relative accuracy of the conicity ε: 1 + log₂ 1/ε for every tenth of a
/// millimetre, with which one hop would be found there by halving alone.
pub(super) fn most_searches(amplitude: f64, accuracy: f64) -> usize {
    let halvings = 1.0 + (1.0 / accuracy).log2().max(0.0).ceil();
    // Saturates: an amplitude of a kilometre ends with the track.
    ((amplitude / WIDEST).ceil() * halvings) as usize
}

/// A hop of the contact to another place of its side.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hop {
    /// How far from here \[mm\].
    distance: f64,
    side: usize,
    /// The other place, in the order of the side's.
    to: usize,
    /// Change of Δr \[mm\].
    jump: f64,
}

/// Δr at a displacement, on one side of a jump where there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    y: f64,
    /// Δr \[mm\] and dΔr/dy.
    value: f64,
    slope: f64,
    /// Of the axle's middle, by each side's contact \[mm\], and its derivative.
    height: [f64; 2],
    climb: [f64; 2],
    /// The nearest hops below and above.
    hops: [Option<Hop>; 2],
}

/// Stretch between two nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    ends: [Node; 2],
    /// Mean of |Δr| from 0 to here \[mm\].
    scale: f64,
    /// By how much ∫ Δr, straight between the ends, may be wrong \[mm²\].
    defect: f64,
    /// Searches spent on hops that were not met.
    tries: u8,
}

/// The table while it is refined.
#[derive(Debug)]
pub(super) struct Table<F> {
    /// Fills in the places of contact at a displacement; false off the track.
    search: F,
    sides: Sides,
    searches: usize,
    most: usize,
    cells: Vec<Cell>,
    /// Cells that are not fine enough: bits of the influence, which order as non-negative numbers do, and the index.
    waiting: BinaryHeap<(u64, usize)>,
}

impl<F: FnMut(f64, &mut Sides) -> Result<bool>> Table<F> {
    /// Δr at equal steps up to the amplitude, or as far as the track goes.
    ///
    /// # Errors
    /// Those of `search`.
    pub(super) fn new(search: F, amplitude: f64, accuracy: f64) -> Result<Self> {
        let mut table = Self {
            search,
            sides: Sides::default(),
            searches: 0,
            most: most_searches(amplitude, accuracy),
            cells: Vec::new(),
            waiting: BinaryHeap::new(),
        };
        let steps = (amplitude / WIDEST).ceil();
        let Some(mut last) = table.searched(0.0)? else { return Ok(table) };
        let mut mean = 0.0;
        for k in 1..=steps as u64 {
            let Some(next) = table.searched(amplitude * k as f64 / steps)? else { break };
            mean += (next.value.abs() - mean) / k as f64;
            table.push(Cell::new([last, next], mean));
            last = next;
        }
        table.most = table.most.min(most_searches(last.y, accuracy));
        Ok(table)
    }

    /// Searches so far, and the most that there will be.
    pub(super) fn searches(&self) -> [usize; 2] {
        [self.searches, self.most]
    }

    /// Splits the cells that change a conicity by more than this relative influence, the most influential first, as long as
    /// searches are left; `told` of their number.
    ///
    /// # Errors
    /// Those of the search.
    pub(super) fn refine(&mut self, influence: f64, told: &mut dyn FnMut(usize, usize)) -> Result<()> {
        while self.searches < self.most
            && let Some(&(bits, index)) = self.waiting.peek()
            && f64::from_bits(bits) > influence
        {
            self.waiting.pop();
            self.split(index)?;
            told(self.searches, self.most);
        }
        Ok(())
    }

    /// The table in order of y: every cell's ends, where Δr does not jump one of them.
    pub(super) fn knots(&self) -> Vec<Knot> {
        let mut cells: Vec<&Cell> = self.cells.iter().collect();
        cells.sort_unstable_by(|a, b| a.ends[0].y.total_cmp(&b.ends[0].y));
        let mut knots = Vec::with_capacity(2 * cells.len());
        for cell in cells {
            let [from, to] = cell.ends;
            let joined = knots.last().is_some_and(|last: &Knot| last.y == from.y && last.force == from.value);
            if !joined {
                knots.push(Knot { y: from.y, force: from.value, defect: 0.0 });
            }
            knots.push(Knot { y: to.y, force: to.value, defect: cell.defect });
        }
        knots
    }

    /// One search.
    fn searched(&mut self, y: f64) -> Result<Option<Node>> {
        self.searches += 1;
        let found = (self.search)(y, &mut self.sides)?;
        Ok(found.then(|| Node::new(&self.sides, [0, 0], y, y)))
    }

    /// Replaces a cell by two, at a hop where one is met.
    fn split(&mut self, index: usize) -> Result<()> {
        let cell = self.cells[index];
        let [from, to] = cell.ends;
        let (y, hopped) = cell.proposal();
        // Neighbouring numbers: nothing is left to split.
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
                let part = |ends| Cell { tries, ..Cell::new(ends, cell.scale) };
                [part([from, middle]), part([middle, to])]
            }
        };
        self.cells[index] = parts[0];
        self.wait(index);
        self.push(parts[1]);
        Ok(())
    }

    /// The two parts of a cell below and above a hop, as it was seen from y; `None` where it lies outside: a hop that an end
    /// predicts may be the one that the other end was placed at.
    fn at_hop(&self, cell: &Cell, y: f64, way: usize, hop: Hop) -> Option<[Cell; 2]> {
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
        let mut parts = [Cell::new([from, nodes[0]], cell.scale), Cell::new([nodes[1], to], cell.scale)];
        // The slopes were those at y: the place is wrong by a share of the way there.
        let defect = hop.jump.abs() * hop.distance * hop.distance / (to.y - from.y);
        parts[0].defect += defect;
        Some(parts)
    }

    fn push(&mut self, cell: Cell) {
        self.cells.push(cell);
        self.wait(self.cells.len() - 1);
    }

    /// Puts a cell among those that may be split.
    fn wait(&mut self, index: usize) {
        let influence = self.cells[index].influence();
        if influence > 0.0 {
            self.waiting.push((influence.to_bits(), index));
        }
    }
}

impl Node {
    /// What a search at `found` tells of `y` beside it, with these of each side's places in touch.
    fn new(sides: &Sides, chosen: [usize; 2], found: f64, y: f64) -> Self {
        let [left, right] = [0, 1].map(|side| sides[side][chosen[side]]);
        let (slope, off) = (right.growth - left.growth, y - found);
        let value = right.radius - left.radius;
        // Slopes that curvatures do not tell move nothing.
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

/// Which way, and how far from `off` beside the search, the gap of another place closes while one touches.
fn closing(touching: &Branch, other: &Branch, off: f64) -> Option<(usize, f64)> {
    let (gap, rate) = (other.gap - touching.gap, touching.climb - other.climb);
    let way = usize::from(rate < 0.0);
    let at = -gap / rate - off;
    let distance = if way == 0 { -at } else { at };
    at.is_finite().then(|| (way, distance.max(0.0)))
}

impl Cell {
    fn new(ends: [Node; 2], scale: f64) -> Self {
        let mut cell = Self { ends, scale, defect: 0.0, tries: 0 };
        cell.defect = cell.width() * (cell.bend() + cell.unexplained() / 2.0) + cell.hopped();
        cell
    }

    fn width(&self) -> f64 {
        self.ends[1].y - self.ends[0].y
    }

    /// Most of what Δr can bend by on the average, if it turns from one end's slope to the other's \[mm\].
    fn bend(&self) -> f64 {
        let bend = self.width() * (self.ends[1].slope - self.ends[0].slope).abs() / 8.0;
        if bend.is_finite() { bend } else { 0.0 }
    }

    /// Change of Δr that the slopes do not explain: jumps \[mm\].
    fn unexplained(&self) -> f64 {
        let [from, to] = &self.ends;
        let change = to.value - from.value;
        let explained = self.width() * (from.slope + to.slope) / 2.0;
        if explained.is_finite() { (change - explained).abs() } else { change.abs() }
    }

    /// What hops that the ends predict inside change ∫ Δr by \[mm²\].
    fn hopped(&self) -> f64 {
        let inside = self.predicted().into_iter().flatten();
        inside.map(|(hop, _)| hop.jump.abs() * (self.width() - hop.distance)).sum()
    }

    /// The hops inside that the lower and the upper end predict, and where.
    fn predicted(&self) -> [Option<(Hop, f64)>; 2] {
        let [from, to] = &self.ends;
        let inside = |hop: &Hop| hop.distance < self.width();
        let up = from.hops[1].filter(inside).map(|hop| (hop, from.y + hop.distance));
        let down = to.hops[0].filter(inside).map(|hop| (hop, to.y - hop.distance));
        [up, down]
    }

    /// Relative change of the conicity at an amplitude just above, if ∫ Δr changes by the defect: T's integrand falls by
    /// defect/(Δr · h) at the distance h below the turning point, where the movement spends √(h/ŷ) of its time.
    fn influence(&self) -> f64 {
        let [_, to] = &self.ends;
        let influence = self.defect / (self.scale * (self.width() * to.y.max(LEAST_AMPLITUDE)).sqrt());
        if influence.is_nan() { 0.0 } else { influence }
    }

    /// Where to search next, and whether in the hope of a hop: where the nearer end predicts one, or where the heights'
    /// tangents cross; else in the middle.
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
        // A hop at an end is met from inside: what is left beyond is a hundredth of the cell.
        let margin = self.width() * BESIDE / 2.0;
        place.map_or((middle, false), |y| (y.clamp(from.y + margin, to.y - margin), true))
    }

    /// Where the tangents of the height cross, of the side where they differ more.
    fn crossing(&self) -> Option<f64> {
        let [from, to] = &self.ends;
        let turn = |side: usize| from.climb[side] - to.climb[side];
        let side = usize::from(turn(1).abs() > turn(0).abs());
        let short = to.height[side] - from.height[side] - to.climb[side] * self.width();
        let y = from.y + short / turn(side);
        y.is_finite().then_some(y)
    }
}
