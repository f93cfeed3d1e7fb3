//! The η values of a grid, prepared once for all its columns.

use std::ops::Range;

use crate::numerics::interval::Interval;
use crate::numerics::lanes::WIDEST;

/// η and u = η² of every column, and whether one half of the values is the mirror image of the other.
#[derive(Debug, Clone)]
pub struct EtaAxis {
    /// η \[mm\], ascending.
    pub(crate) eta: Vec<f64>,
    /// η² \[mm²\].
    pub(crate) u: Vec<f64>,
    /// Index of the first η ≥ 0.
    pub(crate) first_positive: usize,
    /// Whether η_i = −η_{n−1−i} for all i.
    pub(crate) symmetric: bool,
    /// Largest |η| \[mm\].
    pub(crate) reach: f64,
}

impl EtaAxis {
    /// Prepares the axis for ascending η \[mm\].
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

    /// Returns η \[mm\], ascending.
    pub fn eta(&self) -> &[f64] {
        &self.eta
    }

    /// Returns whether η is symmetric and fills whole vectors on every machine: columns are then computed for one half and mirrored.
    pub(crate) fn has_whole_halves(&self) -> bool {
        self.symmetric && self.eta.len().is_multiple_of(WIDEST)
    }

    /// Returns the number of leading values that are the mirror image of the last ones.
    pub(crate) fn mirrored_count(&self) -> usize {
        if self.symmetric { self.first_positive } else { 0 }
    }

    /// Returns two ranges of indices whose u \[mm²\] lies in an interval, without its lower end unless that is 0: the first for
    /// η ≥ 0, the second for η < 0. On a symmetric axis the second range is empty, because the values are mirrored.
    pub(crate) fn ranges(&self, u: Interval) -> [Range<usize>; 2] {
        let right = &self.u[self.first_positive..];
        let ends = u.ends().map(|end| right.partition_point(|&u| u <= end));
        let begin = if u.low == 0.0 { 0 } else { ends[0] };
        let positive = self.first_positive + begin..self.first_positive + ends[1];
        [positive, if self.symmetric { 0..0 } else { self.negative(u) }]
    }

    /// Returns whether the last η ≥ 0 before the index `end` has at most this u \[mm²\]. The answer is yes if there is no
    /// such η.
    #[inline(always)]
    pub(crate) fn is_end(&self, u: f64, end: usize) -> bool {
        end == self.first_positive || self.u[end - 1] <= u
    }

    /// Finds the index after the last η ≥ 0 with at most this u \[mm²\]. The search begins at the index `near`, the result
    /// for a similar u.
    #[inline(always)]
    pub(crate) fn end(&self, u: f64, near: usize) -> usize {
        let mut end = near;
        while end < self.u.len() && self.u[end] <= u {
            end += 1;
        }
        while end > self.first_positive && self.u[end - 1] > u {
            end -= 1;
        }
        end
    }

    /// Finds the index of the first η < 0 with at most this u \[mm²\]. `end` is the index after the last η ≥ 0 with at most
    /// this u.
    #[inline(always)]
    pub(crate) fn begin(&self, u: f64, end: usize) -> usize {
        if self.symmetric {
            return self.u.len() - end;
        }
        self.u[..self.first_positive].partition_point(|&value| value > u)
    }

    /// Returns the indices of the η < 0 whose u \[mm²\] lies in an interval, without its lower end unless that is 0.
    fn negative(&self, Interval { low: u0, high: u1 }: Interval) -> Range<usize> {
        let left = &self.u[..self.first_positive];
        let end = if u0 == 0.0 { left.len() } else { left.partition_point(|&u| u > u0) };
        left.partition_point(|&u| u > u1)..end
    }
}

/// Writes the mirror image of a column's end to its first `count` values; `count` is at most half of the column.
#[inline(always)]
pub(crate) fn mirror(column: &mut [f64], count: usize) {
    let (left, right) = column.split_at_mut(count);
    let right = &right[right.len() - count..];
    let (lines, inner_left) = left.as_chunks_mut::<WIDEST>();
    let (inner_right, mirrored) = right.as_rchunks::<WIDEST>();
    for (left, right) in lines.iter_mut().zip(mirrored.iter().rev()) {
        // Eight values are reversed at once, which becomes one vector operation.
        let [a, b, c, d, e, f, g, h] = *right;
        *left = [h, g, f, e, d, c, b, a];
    }
    for (left, right) in inner_left.iter_mut().zip(inner_right.iter().rev()) {
        *left = *right;
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
            for interval in [[0.0, 1.0], [1.0, 4.0], [4.0, f64::INFINITY]].map(Interval::from) {
                for i in axis.ranges(interval).into_iter().flatten() {
                    assert!(column[i].is_nan() && axis.u[i] <= interval.high, "{eta:?} {i}");
                    column[i] = axis.u[i];
                }
            }
            if axis.symmetric {
                mirror(&mut column, axis.first_positive);
            }
            assert_eq!(column, axis.u);

            for u in [0.0, 0.2, 1.0, 4.0, 5.0, 20.0] {
                let inside = |i: &usize| axis.u[*i] <= u;
                for near in axis.first_positive..=eta.len() {
                    let end = axis.end(u, near);
                    assert!(
                        axis.is_end(u, end) && (axis.begin(u, end)..end).all(|i| inside(&i)),
                        "{eta:?} {u}"
                    );
                    assert_eq!(
                        end - axis.begin(u, end),
                        (0..eta.len()).filter(inside).count(),
                        "{eta:?} {u}"
                    );
                }
            }
        }
    }
}
