//! The numbers of a grid as text of fixed width.

use super::number::{Field, field};
use crate::error::Result;
use crate::export::model::{GridFields, Header};

/// The numbers of a grid as text, formatted once for all decks.
pub struct Deck<'a> {
    pub(super) header: &'a Header,
    pub(super) grid: &'a GridFields<'a>,
    /// Steps \[d_ξ, d_η\] \[mm\].
    pub(super) steps: [f64; 2],
    pub(super) xi: Vec<Field>,
    pub(super) eta: Vec<Field>,
    /// Texts of s, or of the fill value where s is undefined.
    pub(super) separation: Vec<Field>,
}

impl<'a> Deck<'a> {
    /// Formats the numbers of a grid. The texts take 25 bytes a point.
    ///
    /// # Errors
    /// A grid of unequal steps, or of one row or column, because decks state a grid by its first point and its steps.
    pub fn new(header: &'a Header, grid: &'a GridFields<'a>) -> Result<Self> {
        let fill = grid.fill_value();
        let number = |&s: &f64| field(if s.is_nan() { fill } else { s });
        Ok(Self {
            header,
            grid,
            steps: grid.steps("the text decks")?,
            xi: fields(grid.xi()),
            eta: fields(grid.eta()),
            separation: grid.separation().iter().map(number).collect(),
        })
    }

    /// Returns the lattice of the grid's points.
    pub(super) fn lattice(&self) -> Lattice {
        let first = [self.grid.xi()[0], self.grid.eta()[0]];
        Lattice { count: [self.xi.len(), self.eta.len()], first, steps: self.steps }
    }

    /// Returns the texts of s along the column of ξ number `i`.
    pub(super) fn column(&self, i: usize) -> &[Field] {
        &self.separation[i * self.eta.len()..(i + 1) * self.eta.len()]
    }
}

/// The lattice of a deck's points: along ξ or σ first, along η second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    /// Numbers of points.
    pub count: [usize; 2],
    /// The first point \[mm\].
    pub first: [f64; 2],
    /// Steps \[mm\].
    pub steps: [f64; 2],
}

fn fields(values: &[f64]) -> Vec<Field> {
    values.iter().map(|&value| field(value)).collect()
}

/// Returns one line of numbers.
pub(super) fn line(values: &[f64]) -> String {
    let mut text: String = values.iter().flat_map(|&value| field(value)).map(char::from).collect();
    text.push('\n');
    text
}
