//! Points, derivatives and control points of a bicubic over one cell.

use crate::numerics::interval::Interval;

/// A point of a surface over its parameters (u, y): values and derivatives of \[x, z\] in mm; u counts cells across, y is the
/// coordinate along the track \[mm\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Coordinate along the track \[mm\].
    pub y: f64,
    /// The point.
    pub at: [f64; 2],
    /// ∂/∂u.
    pub across: [f64; 2],
    /// ∂/∂y.
    pub along: [f64; 2],
    /// ∂²/∂u².
    pub across2: [f64; 2],
    /// ∂²/∂u∂y.
    pub mixed: [f64; 2],
    /// ∂²/∂y².
    pub along2: [f64; 2],
}

/// Value, ∂/∂u, ∂/∂y and ∂²/∂u∂y of \[x, z\] at a corner of a cell.
pub(super) type CornerValues = [[f64; 2]; 4];

/// The bicubic of one cell: its four corners, and the interval of y that it covers \[mm\].
#[derive(Debug, Clone, Copy)]
pub struct Bicubic {
    /// Corners by u, then by y.
    pub(super) corners: [[CornerValues; 2]; 2],
    /// Ends of the cell \[mm\].
    pub(super) y: Interval,
}

/// Computes Hermite's four cubics on \[0, 1\] and their first two derivatives: of value and slope at 0, of value and slope at 1.
#[inline(always)]
pub(super) fn hermite(t: f64) -> [[f64; 4]; 3] {
    let (t2, s) = (t * t, 1.0 - t);
    [
        [(1.0 + 2.0 * t) * s * s, t * s * s, t2 * (3.0 - 2.0 * t), -t2 * s],
        [-6.0 * t * s, s * (1.0 - 3.0 * t), 6.0 * t * s, t * (3.0 * t - 2.0)],
        [12.0 * t - 6.0, 6.0 * t - 4.0, 6.0 - 12.0 * t, 6.0 * t - 2.0],
    ]
}

impl Bicubic {
    /// Returns the point at the share f of the cell across and at y \[mm\].
    // Inline, so that derivatives that the caller does not use are not computed.
    #[inline(always)]
    pub fn point(&self, f: f64, y: f64) -> SurfacePoint {
        let step = self.y.width();
        let (u, v) = (hermite(f), hermite((y - self.y.low) / step));
        let scaled = |row: [f64; 4], power: i32| {
            let unit = step.powi(-power);
            [row[0] * unit, row[1] * unit * step, row[2] * unit, row[3] * unit * step]
        };
        let v = [scaled(v[0], 0), scaled(v[1], 1), scaled(v[2], 2)];
        let sum = |u: &[f64; 4], v: &[f64; 4]| {
            [0, 1].map(|axis| {
                let corner = |a: usize, b: usize, k: usize| self.corners[a][b][k][axis];
                let column = |b: usize, k: usize| {
                    u[0] * corner(0, b, k)
                        + u[1] * corner(0, b, k + 1)
                        + u[2] * corner(1, b, k)
                        + u[3] * corner(1, b, k + 1)
                };
                v[0] * column(0, 0) + v[1] * column(0, 2) + v[2] * column(1, 0) + v[3] * column(1, 2)
            })
        };
        SurfacePoint {
            y,
            at: sum(&u[0], &v[0]),
            across: sum(&u[1], &v[0]),
            along: sum(&u[0], &v[1]),
            across2: sum(&u[2], &v[0]),
            mixed: sum(&u[1], &v[1]),
            along2: sum(&u[0], &v[2]),
        }
    }

    /// Returns the 4 × 4 control points \[x, y, z\] of the part over these shares across and this interval of y \[mm\]: the surface lies
    /// in their hull. The first index goes across.
    pub fn control(&self, shares: Interval, y: Interval) -> [[[f64; 3]; 4]; 4] {
        let (du, dy) = (shares.width() / 3.0, y.width() / 3.0);
        let mut out = [[[0.0; 3]; 4]; 4];
        for (a, f) in shares.ends().into_iter().enumerate() {
            for (b, own) in y.ends().into_iter().enumerate() {
                let p = self.point(f, own);
                let (to_u, to_y) = if a == 0 { (du, b) } else { (-du, b) };
                let to_y = if to_y == 0 { dy } else { -dy };
                for (k, i) in [(0.0, 3 * a), (to_u, a + 1)] {
                    for (l, j) in [(0.0, 3 * b), (to_y, b + 1)] {
                        let value = |axis: usize| {
                            p.at[axis] + k * p.across[axis] + l * p.along[axis] + k * l * p.mixed[axis]
                        };
                        out[i][j] = [value(0), own + l, value(1)];
                    }
                }
            }
        }
        out
    }
}
