//! Solved pressures and what is read from them: load, true contact area, largest pressure.

use super::cells::Cells;

/// Relative error of the largest pressure for a violation of contact's conditions relative to δ: seen up to 4 on ellipses.
const UNSETTLED: f64 = 5.0;

/// The largest pressure of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// p \[N/mm²\].
    pub pressure_n_per_mm2: f64,
    /// Where: ξ and η \[mm\].
    pub at_mm: [f64; 2],
}

/// The pressures of a region under an approach.
#[derive(Debug, Clone)]
pub struct Pressures {
    /// The cells.
    pub cells: Cells,
    /// What the other regions lower the surface by \[mm\], ≥ 0: the part of δ that this one's own pressures do not close.
    pub lowered: f64,
    /// p/(π E*) of every cell \[1\], ≥ 0, at i_ξ · n_η + i_η.
    pub(super) relative: Vec<f64>,
    /// π E* \[N/mm²\].
    pub(super) unit: f64,
    /// Largest violation of contact's conditions that the search left, relative to δ.
    pub(super) violation: f64,
    /// δ − s − `lowered` \[mm\] of every cell, ≥ 0.
    pub(super) depth: Vec<f64>,
}

impl Pressures {
    /// Lists p \[N/mm²\] of every cell, ≥ 0, at i_ξ · n_η + i_η.
    pub fn values(&self) -> Vec<f64> {
        self.relative.iter().map(|p| p * self.unit).collect()
    }

    /// Gives the normal force F \[N\].
    pub fn load(&self) -> f64 {
        self.unit * self.cells.area() * self.relative.iter().sum::<f64>()
    }

    /// Gives the largest pressure and its place: the top of the parabolas through the cell of most pressure and its neighbours.
    pub fn largest(&self) -> Largest {
        let [columns, rows] = self.cells.count;
        let most = self
            .relative
            .iter()
            .enumerate()
            .fold((0, 0.0), |(at, most), (k, p)| if *p > most { (k, *p) } else { (at, most) });
        let (at, p) = most;
        let place = [at / rows, at % rows];
        let mut largest = Largest { pressure_n_per_mm2: p, at_mm: [0.0; 2] };
        for (axis, (stride, count)) in [(rows, columns), (1, rows)].into_iter().enumerate() {
            let inside = place[axis] > 0 && place[axis] + 1 < count;
            let [before, behind] =
                if inside { [self.relative[at - stride], self.relative[at + stride]] } else { [p; 2] };
            let (slope, bend) = ((behind - before) / 2.0, 2.0 * p - before - behind);
            let top = if bend > 0.0 { slope / bend } else { 0.0 };
            largest.pressure_n_per_mm2 += 0.5 * slope * top;
            largest.at_mm[axis] = self.cells.middle(axis, place[axis] as f64 + top);
        }
        largest.pressure_n_per_mm2 *= self.unit;
        largest
    }

    /// Gives the true contact area \[mm²\]: that of the cells with pressure, with their outline where p², which falls to the outline
    /// nearly as a line, is 0.
    pub fn contact_area(&self) -> f64 {
        let columns = self.relative.chunks_exact(self.cells.count[1]);
        columns.map(pressed_length).sum::<f64>() * self.cells.area()
    }

    /// Gives p² \[1\] at the middles of the cells and of one more around them all, with ξ and η \[mm\] there, at i_ξ · n_η + i_η. It falls to
    /// the edge of the contact nearly as a line, and beyond goes on as one from the two last cells: the contact ends where it is 0.
    pub fn squares_to_edges(&self) -> ([Vec<f64>; 2], Vec<f64>) {
        let [columns, rows] = self.cells.count.map(|count| count as isize);
        let most = self.relative.iter().fold(0.0, |most: f64, p| most.max(p * p));
        let square = |i: isize, j: isize| {
            let inside = (0..columns).contains(&i) && (0..rows).contains(&j);
            if inside { self.relative[(i * rows + j) as usize].powi(2) } else { 0.0 }
        };
        let beyond = |i: isize, j: isize, [di, dj]: [isize; 2]| {
            match [square(i + di, j + dj), square(i + 2 * di, j + 2 * dj)] {
                [0.0, _] => -most,
                // A single cell ends at its border.
                [last, 0.0] => -last,
                [last, before] => (2.0 * last - before).clamp(-most, 0.0),
            }
        };
        let value = |i: isize, j: isize| match square(i, j) {
            0.0 => [[1, 0], [-1, 0], [0, 1], [0, -1]]
                .map(|to| beyond(i, j, to))
                .into_iter()
                .fold(-most, f64::max),
            here => here,
        };
        let axes = [columns, rows].map(|count| -1..=count);
        let places = [0, 1].map(|k| axes[k].clone().map(|i| self.cells.middle(k, i as f64)).collect());
        let [along, across] = axes;
        (places, along.flat_map(|i| across.clone().map(move |j| [i, j])).map(|[i, j]| value(i, j)).collect())
    }

    /// Estimates the error of the largest pressure \[N/mm²\] from that on cells twice as wide, and from what the search left.
    ///
    /// It is some three times the error where pressures are smooth, and about the error where s has a jump of curvature. At a kink of
    /// s the pressure has no bound, and grows with every finer grid.
    pub fn largest_error(&self, wider: &Self) -> f64 {
        let [here, there] = [self, wider].map(|pressures| pressures.largest().pressure_n_per_mm2);
        (here - there).abs() + UNSETTLED * self.violation * here
    }
}

/// Gives the length of a line of cells that is pressed, in cells.
fn pressed_length(line: &[f64]) -> f64 {
    line.split(|p| *p == 0.0)
        .map(|run| match run {
            [] => 0.0,
            [_] => 1.0,
            [first, second, ..] => {
                let [.., before, last] = run else { return 0.0 };
                (run.len() - 1) as f64 + beyond(*first, *second) + beyond(*last, *before)
            }
        })
        .sum()
}

/// Gives how far contact reaches beyond the middle of its last cell, in cells, with the pressures of that and of the one before.
fn beyond(last: f64, before: f64) -> f64 {
    let fall = before * before - last * last;
    if fall > 0.0 { (last * last / fall).min(1.0) } else { 0.5 }
}
