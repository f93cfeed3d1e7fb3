//! Displacements of equal cells under their pressures, as a product of Fourier transforms.

use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// Displacements \[mm\] of every cell under pressures p/(π E*) on every cell: u = K p, with K by Love (1929).
///
/// K depends on the distance of two cells alone, so that the sum is a convolution. Grids are padded with zeros to twice their
/// length: no cell meets the periodic image of another one. Two rows of real numbers share a complex transform.
pub(super) struct Influence {
    /// Cells along ξ and η.
    count: [usize; 2],
    /// Padded lengths.
    length: [usize; 2],
    /// Transforms along ξ and η, there and back.
    transforms: [[Arc<dyn Fft<f64>>; 2]; 2],
    /// Transform of K over the padded lengths' product, the waves of ξ fastest. K is even, so its transform is real.
    spectrum: Vec<f64>,
    /// Room for one row, for all columns, and for what transforms need.
    row: Vec<Complex<f64>>,
    columns: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

const ZERO: Complex<f64> = Complex::new(0.0, 0.0);

impl Influence {
    /// Plans the transforms for this many cells along ξ and η, at i_ξ · n_η + i_η, and computes K for cells with these sides \[mm\].
    ///
    /// Cost: 10 ns a cell, and two products.
    pub fn new(count: [usize; 2], step: [f64; 2]) -> Self {
        let length = count.map(padded);
        let mut planner = FftPlanner::new();
        let transforms =
            length.map(|length| [planner.plan_fft_forward(length), planner.plan_fft_inverse(length)]);
        let room = transforms.iter().flatten().map(|t| t.get_inplace_scratch_len()).max().unwrap_or(0);
        let waves = length[1] / 2 + 1;
        let mut influence = Self {
            count,
            length,
            transforms,
            spectrum: Vec::new(),
            row: vec![ZERO; length[1]],
            columns: vec![ZERO; waves * length[0]],
            scratch: vec![ZERO; room],
        };
        influence.spectrum = influence.transformed(&love(count, step));
        influence
    }

    /// Gives the number of cells.
    pub fn cells(&self) -> usize {
        self.count[0] * self.count[1]
    }

    /// Computes the displacements \[mm\] under all pressures p/(π E*).
    ///
    /// Accuracy: 1e-15 of the largest displacement. Cost: n log n for n cells.
    pub fn apply(&mut self, pressure: &[f64], out: &mut [f64]) {
        self.columns.fill(ZERO);
        let rows = self.count[1];
        for (pair, values) in pressure.chunks(2 * rows).enumerate() {
            let (one, other) = values.split_at(rows);
            self.row_to_columns(2 * pair, one, other);
        }
        let [there, back] = &self.transforms[0];
        there.process_with_scratch(&mut self.columns, &mut self.scratch);
        for (wave, factor) in self.columns.iter_mut().zip(&self.spectrum) {
            *wave *= factor;
        }
        back.process_with_scratch(&mut self.columns, &mut self.scratch);
        for (pair, values) in out.chunks_mut(2 * rows).enumerate() {
            let (one, other) = values.split_at_mut(rows);
            self.columns_to_row(2 * pair, one, other);
        }
    }

    /// Gives the transform of an even function of the distance, known at i_ξ · n_η + i_η cells, over the padded lengths' product.
    fn transformed(&mut self, even: &[f64]) -> Vec<f64> {
        let ([columns, rows], [across, along]) = (self.count, self.length);
        let mut mirrored = vec![0.0; along];
        for (i, values) in even.chunks_exact(rows).enumerate() {
            mirrored[..rows].copy_from_slice(values);
            for (j, value) in values.iter().enumerate().skip(1) {
                mirrored[along - j] = *value;
            }
            self.row_to_columns(i, &mirrored, &[]);
        }
        for column in self.columns.chunks_exact_mut(across) {
            for i in 1..columns {
                column[across - i] = column[i];
            }
        }
        self.transforms[0][0].process_with_scratch(&mut self.columns, &mut self.scratch);
        let scale = ((across * along) as f64).recip();
        self.columns.iter().map(|wave| wave.re * scale).collect()
    }

    /// Transforms row i and the next one along η; the other row may be shorter.
    fn row_to_columns(&mut self, i: usize, one: &[f64], other: &[f64]) {
        self.row.fill(ZERO);
        for (z, re) in self.row.iter_mut().zip(one) {
            z.re = *re;
        }
        for (z, im) in self.row.iter_mut().zip(other) {
            z.im = *im;
        }
        self.transforms[1][0].process_with_scratch(&mut self.row, &mut self.scratch);
        let [across, along] = self.length;
        for (k, column) in self.columns.chunks_exact_mut(across).enumerate() {
            // A = (Z(k) + Z(−k)*)/2 and B = (Z(k) − Z(−k)*)/2i are the transforms of the two rows.
            let (z, mirrored) = (self.row[k], self.row[(along - k) % along].conj());
            let (sum, difference) = (z + mirrored, z - mirrored);
            column[i] = 0.5 * sum;
            column[i + 1] = Complex::new(0.5 * difference.im, -0.5 * difference.re);
        }
    }

    /// Transforms row i and the next one back.
    fn columns_to_row(&mut self, i: usize, one: &mut [f64], other: &mut [f64]) {
        let [across, along] = self.length;
        for (k, column) in self.columns.chunks_exact(across).enumerate() {
            let [a, b] = [column[i], column[i + 1]];
            self.row[(along - k) % along] = Complex::new(a.re + b.im, b.re - a.im);
            self.row[k] = Complex::new(a.re - b.im, a.im + b.re);
        }
        self.transforms[1][1].process_with_scratch(&mut self.row, &mut self.scratch);
        for (re, z) in one.iter_mut().zip(&self.row) {
            *re = z.re;
        }
        for (im, z) in other.iter_mut().zip(&self.row) {
            *im = z.im;
        }
    }
}

/// Gives the least even length ≥ 2 n whose only prime factors are 2, 3 and 5, for which transforms are fast.
fn padded(n: usize) -> usize {
    let smooth = |mut length: usize| {
        for factor in [2, 3, 5] {
            while length.is_multiple_of(factor) {
                length /= factor;
            }
        }
        length == 1
    };
    let mut length = 2 * n.max(1);
    while !smooth(length) {
        length += 2;
    }
    length
}

/// Gives ∬ 1/r \[mm\] over a cell whose middle lies (i_ξ, i_η) cells from a point, at i_ξ · n_η + i_η (Love 1929).
///
/// It is the second difference of f = x asinh(y/x) + y asinh(x/y) over the cell's corners; f is odd in x and in y.
/// Accuracy: 1e-16 of the squared distance in cells.
fn love([columns, rows]: [usize; 2], step: [f64; 2]) -> Vec<f64> {
    let edges = |n: usize, step: f64| -> Vec<[f64; 2]> {
        (0..n).map(|i| (i as f64 + 0.5) * step).map(|x| [x, x.ln()]).collect()
    };
    let along = edges(rows, step[1]);
    let mut corners = Vec::with_capacity(columns * rows);
    for [x, ln_x] in edges(columns, step[0]) {
        corners.extend(along.iter().map(|[y, ln_y]| {
            let r = x.hypot(*y);
            x * ((y + r).ln() - ln_x) + y * ((x + r).ln() - ln_y)
        }));
    }
    let corner = |i: usize, j: usize| corners[i * rows + j];
    let mut table = Vec::with_capacity(columns * rows);
    for i in 0..columns {
        for j in 0..rows {
            // The corners before the first cell's middle mirror those behind it.
            let [before_x, before_y] = [i, j].map(|k| if k == 0 { (0, -1.0) } else { (k - 1, 1.0) });
            let ((i0, sx), (j0, sy)) = (before_x, before_y);
            table.push(corner(i, j) - sx * corner(i0, j) - sy * corner(i, j0) + sx * sy * corner(i0, j0));
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_even_and_smooth() {
        assert_eq!([1, 2, 7, 16, 32, 101, 200].map(padded), [2, 4, 16, 32, 64, 216, 400]);
    }
}
