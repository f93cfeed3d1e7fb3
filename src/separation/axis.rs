//! The η values of a grid, prepared once for all columns.

use std::ops::Range;

/// η and u = η² of every column, and whether half of it is the mirror image of the other.
#[derive(Debug, Clone)]
pub struct EtaAxis {
    /// η \[mm\], ascending.
    pub eta: Vec<f64>,
    /// η² \[mm²\].
    pub u: Vec<f64>,
    /// Index of the first η ≥ 0.
    pub first_positive: usize,
    /// η_i = −η_{n−1−i} for all i.
    pub symmetric: bool,
    /// Largest |η| \[mm\].
    pub reach: f64,
}

impl EtaAxis {
    /// Prepares ascending η values.
    pub fn new(eta: &[f64]) -> Self {
        let symmetric = eta.iter().zip(eta.iter().rev()).all(|(a, b)| *a == -*b);
        Self {
            u: eta.iter().map(|eta| eta * eta).collect(),
            first_positive: eta.partition_point(|&eta| eta < 0.0),
            symmetric,
            reach: eta.iter().fold(0.0, |reach, eta| eta.abs().max(reach)),
            eta: eta.to_vec(),
        }
    }

    /// The index ranges whose u lies in (u0, u1], or in \[u0, u1\] for u0 = 0: η ≥ 0, and η < 0 where that is not the
    /// mirror image.
    pub fn ranges(&self, u: [f64; 2]) -> [Range<usize>; 2] {
        let right = &self.u[self.first_positive..];
        let ends = u.map(|end| right.partition_point(|&u| u <= end));
        let begin = if u[0] == 0.0 { 0 } else { ends[0] };
        let positive = self.first_positive + begin..self.first_positive + ends[1];
        [positive, if self.symmetric { 0..0 } else { self.negative(u) }]
    }

    /// The same with η < 0 always, ascending, and in one range where u0 = 0. `begin` and `end` are the numbers of η ≥ 0 up
    /// to u0 and to u1, as of [`Self::count`].
    #[inline(always)]
    pub fn runs(&self, u: [f64; 2], begin: usize, end: usize) -> [Range<usize>; 2] {
        let n = self.u.len();
        let begin = if u[0] == 0.0 { 0 } else { begin };
        let positive = self.first_positive + begin..self.first_positive + end;
        let negative = if self.symmetric { n - positive.end..n - positive.start } else { self.negative(u) };
        if u[0] == 0.0 { [negative.start..positive.end, 0..0] } else { [negative, positive] }
    }

    /// The number of η ≥ 0 up to u, found from the number for another u nearby.
    #[inline(always)]
    pub fn count(&self, u: f64, near: usize) -> usize {
        let right = &self.u[self.first_positive..];
        if right.last().is_none_or(|&last| last <= u) {
            return right.len();
        }
        let mut count = near;
        while count < right.len() && right[count] <= u {
            count += 1;
        }
        while count > 0 && right[count - 1] > u {
            count -= 1;
        }
        count
    }

    /// The indices of η < 0 of [`Self::ranges`].
    fn negative(&self, [u0, u1]: [f64; 2]) -> Range<usize> {
        let left = &self.u[..self.first_positive];
        let end = if u0 == 0.0 { left.len() } else { left.partition_point(|&u| u > u0) };
        left.partition_point(|&u| u > u1)..end
    }

    /// Copies the half η ≥ 0 of a column onto the other, where the axis is symmetric.
    pub fn mirror(&self, column: &mut [f64]) {
        if self.symmetric {
            let (left, right) = column.split_at_mut(self.first_positive);
            for (left, right) in left.iter_mut().zip(right.iter().rev()) {
                *left = *right;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_cover_every_value_once() {
        for eta in
            [vec![-3.0, -1.0, 0.0, 1.0, 3.0], vec![-2.0, -1.0, 0.5, 4.0], vec![1.0, 2.0], vec![-2.0, 2.0]]
        {
            let axis = EtaAxis::new(&eta);
            let mut column = vec![f64::NAN; eta.len()];
            for interval in [[0.0, 1.0], [1.0, 4.0], [4.0, f64::INFINITY]] {
                for i in axis.ranges(interval).into_iter().flatten() {
                    assert!(column[i].is_nan() && axis.u[i] <= interval[1], "{eta:?} {i}");
                    column[i] = axis.u[i];
                }
            }
            axis.mirror(&mut column);
            assert_eq!(column, axis.u);

            let (mut column, mut begin) = (vec![f64::NAN; eta.len()], 0);
            for interval in [[0.0, 1.0], [1.0, 4.0], [4.0, f64::INFINITY]] {
                let end = axis.count(interval[1], begin);
                for i in axis.runs(interval, begin, end).into_iter().flatten() {
                    assert!(column[i].is_nan() && axis.u[i] <= interval[1], "{eta:?} {i}");
                    column[i] = axis.u[i];
                }
                begin = end;
            }
            assert_eq!(column, axis.u);
        }
    }
}
