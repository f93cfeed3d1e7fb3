//! Counts the doubts of a sweep's positions, and says them in one line.

use super::doubts::{ContactDoubts, Doubt, DoubtKind};
use crate::search::{SweepRow, TrackSide};

/// The doubts of some positions.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    /// Number of positions with a doubt.
    positions: usize,
    /// Each kind of [`DoubtKind::OF_CONTACT`].
    kinds: [Kind; DoubtKind::OF_CONTACT.len()],
}

/// The positions with a doubt of one kind.
#[derive(Debug, Clone, Copy, Default)]
struct Kind {
    positions: usize,
    /// The number of largest magnitude \[mm\], and the lateral displacement \[mm\] and the side that it belongs to.
    worst: Option<(f64, f64, TrackSide)>,
}

impl Kind {
    fn add(&mut self, other: Self) {
        self.positions += other.positions;
        let size = |kind: &Self| kind.worst.map_or(0.0, |(value, ..)| value.abs());
        if size(&other) > size(self) {
            self.worst = other.worst;
        }
    }
}

impl Tally {
    /// Adds the doubts of one position.
    pub fn add<'a>(&mut self, rows: impl Iterator<Item = (&'a SweepRow, ContactDoubts)>) {
        self.add_sides(rows.map(|(row, doubts)| (row.lateral, row.side, doubts)));
    }

    /// Adds the doubts of one position: its lateral displacement \[mm\] and the doubts of each side.
    pub fn add_sides(&mut self, sides: impl Iterator<Item = (f64, TrackSide, ContactDoubts)>) {
        let mut here = [Kind::default(); DoubtKind::OF_CONTACT.len()];
        for (lateral, side, doubts) in sides {
            for (kind, value) in doubts.list() {
                let known = DoubtKind::OF_CONTACT.iter().zip(&mut here).find(|(known, _)| **known == kind);
                if let Some((_, own)) = known {
                    own.add(Kind { positions: 0, worst: Some((value, lateral, side)) });
                    own.positions = 1;
                }
            }
        }
        let positions = usize::from(here.iter().any(|kind| kind.positions > 0));
        self.join(&Self { positions, kinds: here });
    }

    /// Adds the doubts of other positions.
    pub fn join(&mut self, other: &Self) {
        self.positions += other.positions;
        self.kinds.iter_mut().zip(other.kinds).for_each(|(own, other)| own.add(other));
    }

    /// Says the doubts in one line, each with its largest number and its likely cause; `None` without doubts. `all` is the
    /// number of positions, `radius` the nominal radius of a side \[mm\].
    pub fn line(&self, all: usize, radius: impl Fn(TrackSide) -> f64) -> Option<String> {
        self.said(all, ", in the column doubt", radius)
    }

    /// Says the doubts as [`Tally::line`] does, of positions that `of` describes.
    pub(super) fn said(&self, all: usize, of: &str, radius: impl Fn(TrackSide) -> f64) -> Option<String> {
        let kinds = DoubtKind::OF_CONTACT.into_iter().zip(&self.kinds);
        let said: String = kinds
            .filter_map(|(kind, found)| {
                let (value, lateral, side) = found.worst?;
                let doubt = Doubt::of_contact(kind, value, radius(side));
                let (word, count) = (kind.word(), found.positions);
                Some(format!("; {word} at {count}, most at {lateral} mm, {side} side: {doubt}"))
            })
            .collect();
        let positions = if all == 1 { "position" } else { "positions" };
        (self.positions > 0).then(|| format!("doubts at {} of {all} {positions}{of}{said}", self.positions))
    }
}
