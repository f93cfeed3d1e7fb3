//! Bounds of a profile's slopes and heights over any range of it.

use std::cell::OnceCell;

use crate::numerics::interval::Interval;
use crate::profile::{BranchShape, Section};

/// Width of bounds of slopes up to which they are not narrowed over a part of a piece.
const NARROW: f64 = 1e-9;

/// Share of a piece from which on a part of it has the bounds of the whole.
const NEARLY_WHOLE: f64 = 0.75;

/// Difference of the slopes of a piece from which on bounds of its parts' own slopes and heights are narrower than those from bounds over all
/// of it.
const STRAIGHT: f64 = 1.0;

/// Bounds over a range of a profile.
#[derive(Debug, Clone, Copy)]
pub(super) struct ProfileBounds {
    /// Of ζ′.
    pub(super) slopes: Interval,
    /// Of ζ \[mm\].
    pub(super) heights: Interval,
}

impl ProfileBounds {
    const NONE: Self = Self { slopes: Interval::NONE, heights: Interval::NONE };

    fn hull(self, other: Self) -> Self {
        Self { slopes: self.slopes.hull(other.slopes), heights: self.heights.hull(other.heights) }
    }
}

/// A binary tree over the pieces of a profile.
#[derive(Debug)]
pub(super) struct ProfileTree<'a> {
    section: &'a Section,
    /// Node k holds what nodes 2k and 2k + 1 hold; the last half of them are the pieces.
    nodes: Vec<ProfileBounds>,
    /// For each piece bounds of ζ″ \[1/mm\], once they are asked for.
    bends: Vec<OnceCell<Interval>>,
}

impl<'a> ProfileTree<'a> {
    pub(super) fn new(section: &'a Section) -> Self {
        let count = section.pieces.len();
        let mut nodes = vec![ProfileBounds::NONE; 2 * count];
        for (k, piece) in section.pieces.iter().enumerate() {
            let slopes = section.slopes(k);
            let ends = Interval::between(piece.heights[0], piece.heights[1]);
            // A curve between two slopes leaves its chord by a quarter of their difference times its length at most.
            let bulge = slopes.width() * piece.xi.width() / 4.0;
            let heights = if slopes.width() < STRAIGHT {
                ends.grown(bulge)
            } else {
                section.branches[piece.branch].height_bounds(piece.xi).hull(ends)
            };
            nodes[count + k] = ProfileBounds { slopes, heights };
        }
        for k in (1..count).rev() {
            nodes[k] = nodes[2 * k].hull(nodes[2 * k + 1]);
        }
        Self { section, nodes, bends: vec![OnceCell::new(); count] }
    }

    fn of(&self, from: usize, to: usize) -> ProfileBounds {
        let count = self.nodes.len() / 2;
        let (mut low, mut high, mut hull) = (from + count, to + count, ProfileBounds::NONE);
        while low < high {
            if low % 2 == 1 {
                hull = hull.hull(self.nodes[low]);
                low += 1;
            }
            if high % 2 == 1 {
                high -= 1;
                hull = hull.hull(self.nodes[high]);
            }
            (low, high) = (low / 2, high / 2);
        }
        hull
    }

    /// Returns the indices of the first piece that meets a range of abscissae \[mm\], and of the first one beyond it.
    fn pieces(&self, over: Interval) -> [usize; 2] {
        let pieces = &self.section.pieces;
        let first = pieces.partition_point(|piece| piece.xi.high < over.low);
        let within = pieces.get(first).is_none_or(|piece| over.high < piece.xi.high);
        if within {
            return [
                first,
                first + usize::from(pieces.get(first).is_some_and(|piece| piece.xi.low <= over.high)),
            ];
        }
        [first, pieces.partition_point(|piece| piece.xi.low <= over.high)]
    }

    /// Returns bounds of all points over a range of abscissae \[mm\], wherever the profile ends or steps in it; `None` where it has none.
    pub(super) fn over_all(&self, range: Interval) -> Option<ProfileBounds> {
        let [first, end] = self.pieces(range);
        (first < end).then(|| self.hull(range, [first, end]))
    }

    /// Returns bounds over a range of abscissae \[mm\]; `None` where the profile ends or steps in it.
    pub(super) fn over(&self, range: Interval) -> Option<ProfileBounds> {
        let pieces = self.pieces(range);
        self.holds(range, pieces).then(|| self.hull(range, pieces))
    }

    /// Whether the profile neither ends nor steps in a range of abscissae \[mm\].
    pub(super) fn is_whole(&self, range: Interval) -> bool {
        self.holds(range, self.pieces(range))
    }

    fn holds(&self, range: Interval, [first, end]: [usize; 2]) -> bool {
        let (pieces, steps) = (&self.section.pieces, &self.section.steps);
        let torn = steps.get(steps.partition_point(|step| *step <= first)).is_some_and(|step| *step < end);
        // A range without a number, as NaN makes it, has no bounds.
        !torn && first < end && pieces[first].xi.low <= range.low && range.high <= pieces[end - 1].xi.high
    }

    fn hull(&self, range: Interval, [first, end]: [usize; 2]) -> ProfileBounds {
        let part = |k: usize| self.part(k, range.cut(self.section.pieces[k].xi));
        let hull = part(first);
        if end - first == 1 { hull } else { hull.hull(part(end - 1)).hull(self.of(first + 1, end - 1)) }
    }

    /// Returns bounds over a part of a piece \[mm\].
    ///
    /// Method: from the middle of a polynomial on, the slope changes as bounds of ζ″ over the whole piece say, unless it turns so far that
    /// these say little.
    fn part(&self, index: usize, part: Interval) -> ProfileBounds {
        let (piece, whole) = (&self.section.pieces[index], self.nodes[self.nodes.len() / 2 + index]);
        if part.width() > NEARLY_WHOLE * piece.xi.width() {
            return whole;
        }
        let branch = &self.section.branches[piece.branch];
        let (point, height) = branch.point(part.middle());
        let either_side = Interval::symmetric(part.width() / 2.0);
        let bend = match branch.shape {
            BranchShape::Polynomial(_) if whole.slopes.width() < STRAIGHT => {
                *self.bends[index].get_or_init(|| branch.derivative_bounds(piece.xi)[1])
            }
            _ => Interval::ALL,
        };
        let slopes = if whole.slopes.width() < NARROW {
            whole.slopes
        } else if bend.magnitude().is_finite() {
            whole.slopes.cut(bend * either_side + branch.slope_from(&point))
        } else {
            whole.slopes.cut(branch.derivative_bounds(part)[0])
        };
        ProfileBounds { slopes, heights: whole.heights.cut(slopes * either_side + height) }
    }

    /// Returns bounds of the heights \[mm\] of all pieces that meet a range of abscissae \[mm\].
    pub(super) fn heights_around(&self, range: Interval) -> Interval {
        let [first, end] = self.pieces(range);
        if first < end { self.of(first, end).heights } else { Interval::NONE }
    }

    /// Returns bounds of the heights \[mm\] of all points over a range of abscissae \[mm\], whether or not the profile ends or steps there.
    pub(super) fn heights(&self, range: Interval) -> Interval {
        let (pieces, [first, end]) = (&self.section.pieces, self.pieces(range));
        let part = |k: usize| {
            let (piece, whole) = (&pieces[k], self.nodes[self.nodes.len() / 2 + k]);
            let part = range.cut(piece.xi);
            if part.width() > NEARLY_WHOLE * piece.xi.width() {
                return whole.heights;
            }
            let (branch, bulge) =
                (&self.section.branches[piece.branch], whole.slopes.width() * part.width() / 4.0);
            if whole.slopes.width() >= STRAIGHT {
                return whole.heights.cut(branch.height_bounds(part));
            }
            whole.heights.cut(Interval::around(part.ends().map(|xi| branch.height(xi))).grown(bulge))
        };
        match end - first.min(end) {
            0 => Interval::NONE,
            1 => part(first),
            _ => part(first).hull(part(end - 1)).hull(self.of(first + 1, end - 1).heights),
        }
    }

    /// Returns bounds of the curvature \[1/mm\], positive where the hollow side is up, over a range of abscissae \[mm\].
    pub(super) fn curvatures(&self, range: Interval) -> Interval {
        let [first, end] = self.pieces(range);
        let pieces = self.section.pieces[first.min(end)..end].iter();
        let bends =
            pieces.map(|piece| self.section.branches[piece.branch].curvature_bounds(piece.xi.cut(range)));
        bends.fold(Interval::NONE, Interval::hull)
    }

    /// Returns bounds of the second derivative \[1/mm\] over a range of abscissae \[mm\] but for kinks, in axes in which these bound the slopes.
    pub(super) fn bends(&self, range: Interval, slopes: Interval) -> Interval {
        self.curvatures(range) * slopes.squared().map(|square| (1.0 + square).powf(1.5))
    }

    /// Returns by how much the slope rises at each joint in a range of abscissae \[mm\].
    pub(super) fn kinks(&self, range: Interval) -> impl Iterator<Item = f64> {
        let (section, [first, end]) = (self.section, self.pieces(range));
        let pairs = section.pieces[first.min(end)..end].windows(2);
        pairs.map(|pair| section.end_slope(&pair[1], 0) - section.end_slope(&pair[0], 1))
    }
}
