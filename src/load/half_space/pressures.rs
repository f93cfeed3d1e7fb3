//! Solved pressures and what is read from them: load, true contact area, largest pressure.

use std::f64::consts::PI;

use super::cells::Cells;

/// Relative error of the largest pressure per violation of contact's conditions relative to δ; up to 4 was seen on ellipses.
const UNSETTLED: f64 = 5.0;

/// Error of the largest pressure per change of slope of s between two cells, as a share of E*: 1/2π, by which the pressure at a kink grows
/// when cells become e times narrower. A change of slope over a third of a cell counts as a kink.
const ROUGH: f64 = 0.159;

/// Rise of the largest pressure by what cells do not show, relative, from which on they are too wide along that axis.
const MUCH: f64 = 0.01;

/// The largest pressure of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// p \[N/mm²\].
    pub pressure_n_per_mm2: f64,
    /// ξ and η of its place \[mm\].
    pub at_mm: [f64; 2],
}

/// The pressures of a region under an approach.
#[derive(Debug, Clone)]
pub struct Pressures {
    /// The cells.
    pub cells: Cells,
    /// Displacement of the surface under the other regions \[mm\], ≥ 0: the part of δ that this region's own pressures do not close.
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

    /// Gives the true contact area \[mm²\]: that inside the contour p² = 0, as p² falls nearly linearly towards the edge.
    pub fn contact_area(&self) -> f64 {
        let ([columns, _], squares) = self.squares_to_edges();
        let rows = squares.len() / columns.len();
        let mut cells = 0.0;
        for (one, next) in squares.chunks_exact(rows).zip(squares[rows..].chunks_exact(rows)) {
            for (a, b) in one.windows(2).zip(next.windows(2)) {
                cells += positive_share([a[0], b[0], b[1], a[1]]);
            }
        }
        cells * self.cells.area()
    }

    /// Gives ξ and η \[mm\], and p² \[1\] at i_ξ · n_η + i_η, at the middles of the cells and of one more row of cells all around. p² falls
    /// nearly linearly towards the edge of the contact, where it is 0; beyond, the line through the last two cells continues it.
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

    /// Estimates the error of the largest pressure \[N/mm²\] from that on cells twice as wide, the violation that the search left, and the
    /// height of the parabolas' top over the largest cell: 1 % beside a jump of curvature, where pressures have a corner.
    ///
    /// What cells do not show of s adds to it, by how far the pressure there may pass the largest one.
    ///
    /// The estimate is some three times the error where pressures are smooth, and about the error where the curvature of s jumps. At a
    /// kink of s the pressure has no bound, and grows with every finer grid: [`sharp_edge`](crate::load::sharp_edge) finds them.
    pub fn largest_error(&self, wider: &Self) -> f64 {
        let [here, there] = [self, wider].map(|pressures| pressures.largest().pressure_n_per_mm2);
        let of_cells = self.unit * self.relative.iter().fold(0.0, |most: f64, p| most.max(*p));
        let hidden = self.hidden();
        (here - there).abs()
            + (here - of_cells)
            + UNSETTLED * self.violation * here
            + hidden[0].max(hidden[1])
    }

    /// Tells along which axes cells are too wide: those along which s turns between them, or both where it does so along neither.
    pub fn rough_axes(&self) -> [bool; 2] {
        let (hidden, largest) = (self.hidden(), self.largest().pressure_n_per_mm2);
        let most = hidden[0].max(hidden[1]);
        hidden.map(|own| most <= MUCH * largest || own >= 0.5 * most)
    }

    /// Estimates by how much the pressure may pass the largest one \[N/mm²\] where neighbouring cells along ξ and along η do not follow each
    /// other smoothly: the sum of two neighbouring fourth differences of s over the side of a cell is the turn between them, of a short arc
    /// or of a jump of curvature, wherever it lies between their middles. One of them alone may be a quarter of it.
    fn hidden(&self) -> [f64; 2] {
        let [columns, rows] = self.cells.count;
        let turn = |at: usize, stride: usize| {
            let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|k| self.depth[at + k * stride - 2 * stride]);
            let known = [a, b, c, d, e, f].iter().all(|depth| *depth > 0.0);
            known.then(|| (a - 3.0 * b + 2.0 * (c + d) - 3.0 * e + f).abs())
        };
        let largest = self.relative.iter().fold(0.0, |most: f64, p| most.max(*p));
        let mut most = [largest; 2];
        for at in (0..self.relative.len()).filter(|&at| self.relative[at] > 0.0) {
            let axes = [(at / rows, columns, rows), (at % rows, rows, 1)];
            for (k, (place, count, stride)) in axes.into_iter().enumerate() {
                let inside = place >= 2 && place + 3 < count;
                let turn = inside.then(|| turn(at, stride)).flatten();
                // A smooth contact ends before the overlap, and carries little there.
                let here = self.relative[at];
                let rise = turn.map_or(here, |turn| ROUGH * turn / (PI * self.cells.step[k]));
                most[k] = most[k].max(here + rise);
            }
        }
        most.map(|most| self.unit * (most - largest))
    }
}

/// Gives the share of a unit square in which a function is positive, from its values at the corners in their order around: the area of
/// the polygon through the positive corners and the zeros of linear interpolation along the sides.
fn positive_share(corners: [f64; 4]) -> f64 {
    const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    if corners.iter().all(|value| *value > 0.0) {
        return 1.0;
    }
    let (mut first, mut last, mut twice) = (None, [0.0; 2], 0.0);
    let mut to = |place: [f64; 2]| {
        let from = if first.is_some() { last } else { *first.insert(place) };
        twice += from[0] * place[1] - place[0] * from[1];
        last = place;
    };
    for (k, here) in corners.into_iter().enumerate() {
        let next = corners[(k + 1) % 4];
        let (from, towards) = (PLACES[k], PLACES[(k + 1) % 4]);
        if here > 0.0 {
            to(from);
        }
        if (here > 0.0) != (next > 0.0) {
            let share = here / (here - next);
            to([0, 1].map(|axis| from[axis] + share * (towards[axis] - from[axis])));
        }
    }
    if let Some(first) = first {
        twice += last[0] * first[1] - first[0] * last[1];
    }
    0.5 * twice
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_squares_are_those_of_polygons() {
        let shares = [
            ([1.0, 1.0, 1.0, 1.0], 1.0),
            ([-1.0, -1.0, 0.0, -1.0], 0.0),
            ([1.0, -1.0, -1.0, -1.0], 0.125),
            ([-1.0, 3.0, -1.0, -1.0], 0.28125),
            ([1.0, 3.0, -1.0, -1.0], 0.625),
            ([1.0, 1.0, 1.0, -3.0], 1.0 - 0.28125),
            ([1.0, -1.0, 1.0, -1.0], 0.75),
        ];
        for (corners, share) in shares {
            assert!((positive_share(corners) - share).abs() < 1e-15, "{corners:?}");
            let [a, b, c, d] = corners;
            assert!((positive_share([b, c, d, a]) - share).abs() < 1e-15, "{corners:?} turned");
        }
    }
}
