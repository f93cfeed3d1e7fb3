//! The η values of a grid, prepared once for all columns.

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

    /// Calls `fill` with the index ranges whose u lies in (u0, u1], or in \[u0, u1\] for u0 = 0; only the half
    /// η ≥ 0 of a symmetric axis.
    pub fn ranges(&self, [u0, u1]: [f64; 2], mut fill: impl FnMut(std::ops::Range<usize>)) {
        let middle = self.first_positive;
        let right = &self.u[middle..];
        let begin = if u0 == 0.0 { 0 } else { right.partition_point(|&u| u <= u0) };
        fill(middle + begin..middle + right.partition_point(|&u| u <= u1));
        if !self.symmetric {
            let left = &self.u[..middle];
            let end = if u0 == 0.0 { middle } else { left.partition_point(|&u| u > u0) };
            fill(left.partition_point(|&u| u > u1)..end);
        }
    }

    /// Copies the half η ≥ 0 of a column onto the other, where the axis is symmetric.
    pub fn mirror(&self, column: &mut [f64]) {
        if self.symmetric {
            let n = column.len();
            let (left, right) = column.split_at_mut(self.first_positive);
            // An odd number of values has η = 0 in the middle, at the start of the right part.
            let skip = n - 2 * left.len();
            for (l, r) in left.iter_mut().rev().zip(&right[skip..]) {
                *l = *r;
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
                axis.ranges(interval, |range| {
                    for i in range {
                        assert!(column[i].is_nan() && axis.u[i] <= interval[1], "{eta:?} {i}");
                        column[i] = axis.u[i];
                    }
                });
            }
            axis.mirror(&mut column);
            assert_eq!(column, axis.u);
        }
    }
}
