//! Bands: parts of a component in which each ξ has one interval of η.

use super::grading::Grading;
use super::outline::{End, Outline};
use super::slice::Slice;
use crate::profile::Section;

/// Least step of a surface, in roundings of the profile's extent. A smaller one counts as a smooth joint.
const STEP_ROUNDINGS: f64 = 64.0;

/// A range of ξ over which a component has one interval of η, whose ends vary without a jump.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Band {
    /// Range of ξ \[mm\].
    pub(crate) xi: [f64; 2],
    /// What bounds the band at either end of `xi`; `None` where the component continues in other bands.
    pub(crate) ends: [Option<End>; 2],
    /// Interval of η \[mm\] at either end of `xi`. It has no width at a tip.
    pub(crate) sides: [[f64; 2]; 2],
    /// Pairs (ξ, valleys) by ascending ξ, empty without skew: the valleys that lie in the band up to that ξ, the deepest
    /// first. Slices are found from the deepest valley.
    pub(super) valleys: Vec<(f64, Vec<usize>)>,
    /// Both ends of `xi`, and every ξ between them where a side may have a corner \[mm\], ascending.
    pub(crate) corners: Vec<f64>,
}

impl Band {
    /// Returns the valleys in the band at ξ, the deepest first. There are none without skew.
    pub(super) fn valleys_at(&self, xi: f64) -> &[usize] {
        let k = self.valleys.partition_point(|(to, _)| *to < xi).min(self.valleys.len().saturating_sub(1));
        self.valleys.get(k).map_or(&[], |(_, valleys)| valleys)
    }

    /// Returns the valley from which the slice at ξ is found; `None` without skew.
    pub(crate) fn valley(&self, xi: f64) -> Option<usize> {
        self.valleys_at(xi).first().copied()
    }

    /// Returns the slice at ξ, which must lie within `xi`. If rounding finds no slice, the result has no width.
    pub(crate) fn slice(&self, outline: &mut Outline<'_>, xi: f64) -> Slice {
        if let Some(end) = (0..2).find(|&end| xi == self.xi[end]) {
            return Slice { eta: self.sides[end] };
        }
        if let Some([low, high]) = outline.edges(self.valley(xi), xi) {
            return Slice { eta: [low.eta, high.eta] };
        }
        let [_, _, eta] = outline.lowest(self.valley(xi), xi);
        Slice { eta: [eta; 2] }
    }

    /// Returns ξ as a function of t in \[0, 1\] in which the width of the band is smooth except at corners. An end at a
    /// window is not round.
    pub(crate) fn grading(&self) -> Grading {
        Grading { xi: self.xi, round: self.ends.map(|end| end != Some(End::Window)) }
    }

    /// Returns the ranges of t between neighbouring corners.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = [f64; 2]> {
        let (grading, last) = (self.grading(), self.corners.len().saturating_sub(1));
        // The ends are exactly 0 and 1, in spite of rounding.
        let parameter = move |k: usize| match k {
            0 => 0.0,
            k if k == last => 1.0,
            k => grading.parameter(self.corners[k]),
        };
        (1..self.corners.len()).map(move |k| [parameter(k - 1), parameter(k)])
    }

    /// Returns whether the component continues in `next`: this band ends where `next` begins, and their slices overlap
    /// there.
    pub(crate) fn meets(&self, next: &Self) -> bool {
        self.xi[1] == next.xi[0] && overlap(self.sides[1], next.sides[0])
    }
}

/// Returns whether two intervals have more than a point in common.
pub(super) fn overlap(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0].max(b[0]) < a[1].min(b[1])
}

/// Returns the ξ inside (a, b) at which a body's surface steps or ends because its profile overhangs. `extent` is that of
/// the profile.
pub(super) fn steps(section: &Section, [a, b]: [f64; 2], extent: f64) -> impl Iterator<Item = f64> {
    let rounding = STEP_ROUNDINGS * f64::EPSILON * extent;
    let torn = move |k: usize| {
        let [left, right] = [&section.pieces[k - 1], &section.pieces[k]];
        left.xi[1] != right.xi[0] || (left.ends[1].1 - right.ends[0].1).abs() > rounding
    };
    let torn = (1..section.pieces.len()).filter(move |&k| torn(k));
    let ends = torn.flat_map(|k| [section.pieces[k - 1].xi[1], section.pieces[k].xi[0]]);
    ends.filter(move |xi| a < *xi && *xi < b)
}
