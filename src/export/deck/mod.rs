//! Text decks for solvers: fixed columns, 17 significant digits, ASCII, with an end mark that shows whether
//! the file is complete.
//!
//! The card layouts of the original CONFORM and COUNTACT programs are not public. `conform.wrp` and
//! `countact.wrp` carry what those solvers read (separation, rail normals, boundary-fitted cells) in the grammar
//! of [`wrp`], and `tests/clients/read_wrp.f90` reads all three. `contact.inp` is for Vollebregt's CONTACT.

pub mod contact;
mod number;
pub mod wrp;

use super::model::{GridFields, Header};
use crate::error::Result;
use number::{Field, WIDTH, field};

/// The numbers of a grid as text, formatted once for all decks.
pub struct Deck<'a> {
    header: &'a Header,
    grid: &'a GridFields<'a>,
    /// Steps \[d_ξ, d_η\] \[mm\].
    steps: [f64; 2],
    xi: Vec<Field>,
    eta: Vec<Field>,
    /// Texts of s, or of the fill value where s is undefined.
    separation: Vec<Field>,
}

impl<'a> Deck<'a> {
    /// Formats the grid. It takes 25 bytes a point.
    ///
    /// # Errors
    /// A grid of unequal steps, or of one row or column: a deck cannot say where its points are.
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

    /// Returns the texts of s along the column of ξ number `i`.
    fn column(&self, i: usize) -> &[Field] {
        &self.separation[i * self.eta.len()..(i + 1) * self.eta.len()]
    }
}

fn fields(values: &[f64]) -> Vec<Field> {
    values.iter().map(|&value| field(value)).collect()
}

/// Returns one line of numbers.
fn line(values: &[f64]) -> String {
    let mut text: String = values.iter().flat_map(|&value| field(value)).map(char::from).collect();
    text.push('\n');
    text
}
