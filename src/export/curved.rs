//! The normal gap over the rail's surface, as writers take it.

use super::model::{GridFields, same_length};
use crate::error::Result;

/// The normal gap over the grid of σ and η, the rail below it and the wheel above it.
#[derive(Debug, Clone, Copy)]
pub struct CurvedFields<'a> {
    sigma: &'a [f64],
    grid: GridFields<'a>,
    wheel_normal: &'a [[f64; 3]],
}

impl<'a> CurvedFields<'a> {
    /// Makes the fields from arrays whose lengths must agree.
    ///
    /// `sigma`: ascending arc lengths \[mm\]. `grid`: the fields at the ξ of the rail's points, with the
    /// normal gap t \[mm\] in the place of s. `wheel_normal`: the wheel's outward unit normal (ξ, η, ζ) at
    /// `i_sigma * n_eta + i_eta`, NaN where t is undefined.
    ///
    /// # Errors
    /// Lengths that do not agree.
    pub fn new(sigma: &'a [f64], grid: GridFields<'a>, wheel_normal: &'a [[f64; 3]]) -> Result<Self> {
        same_length("arc lengths", sigma.len(), grid.xi().len())?;
        same_length("wheel normals", wheel_normal.len(), grid.separation().len())?;
        Ok(Self { sigma, grid, wheel_normal })
    }

    /// Returns the arc lengths σ \[mm\], ascending.
    pub fn sigma(&self) -> &'a [f64] {
        self.sigma
    }

    /// Returns the grid over the ξ of the rail's points, with t in the place of s.
    pub fn grid(&self) -> GridFields<'a> {
        self.grid
    }

    /// Returns the rail's outward unit normal (n_ξ, n_ζ) at σ number `i`.
    pub fn normal(&self, i: usize) -> [f64; 2] {
        self.grid.rail_normal()[i]
    }

    /// Returns α \[rad\] at σ number `i`: the angle of the rail's normal from ζ, positive counter-clockwise from ξ to ζ.
    pub fn angle(&self, i: usize) -> f64 {
        let [n_xi, n_zeta] = self.normal(i);
        (-n_xi).atan2(n_zeta)
    }

    /// Returns the angle α \[rad\] of the rail's normal from ζ at every σ, positive counter-clockwise.
    pub fn angles(&self) -> Vec<f64> {
        (0..self.sigma.len()).map(|i| self.angle(i)).collect()
    }

    /// Returns the wheel's outward unit normals along the column of σ number `i`.
    pub fn wheel_normals(&self, i: usize) -> &'a [[f64; 3]] {
        let n = self.grid.eta().len();
        &self.wheel_normal[i * n..(i + 1) * n]
    }
}
