//! Curves y(yaw): the lateral displacements at which cells begin and end.

use std::array::from_fn;
use std::f64::consts::PI;
use std::sync::LazyLock;

use super::cell::{Beginning, COEFFICIENTS, YAW_COEFFICIENTS};
use crate::numerics::interval::Interval;

/// A curve in the plane of yaw and lateral displacement: a polynomial of the yaw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// The yaws \[rad\] between which it was fitted: u is −1 at the first one, 1 at the last one.
    pub yaw: Interval,
    /// What happens across it.
    pub kind: Beginning,
    /// Coefficients \[mm\] of 1, u, …; under one yaw all but the first are 0.
    pub coefficients: [f64; YAW_COEFFICIENTS],
}

impl Curve {
    /// Makes the curve of one displacement \[mm\] under all yaws.
    pub(super) fn constant(lateral: f64, yaw: Interval, kind: Beginning) -> Self {
        let mut coefficients = [0.0; YAW_COEFFICIENTS];
        coefficients[0] = lateral;
        Self { yaw, kind, coefficients }
    }

    /// Interpolates displacements \[mm\] at the nodes of a range of yaws \[rad\]; a single displacement gives a constant curve.
    pub(super) fn through(nodes: &[f64], yaw: Interval, kind: Beginning) -> Self {
        let Ok(nodes) = <[f64; YAW_COEFFICIENTS]>::try_from(nodes) else {
            return Self::constant(nodes.first().copied().unwrap_or_default(), yaw, kind);
        };
        let coefficients = from_fn(|j| nodes.iter().zip(&*YAW_POWERS).map(|(y, powers)| y * powers[j]).sum());
        Self { yaw, kind, coefficients }
    }

    /// Returns the coefficients \[mm\] of 1, u, … with u from −1 to 1 over other yaws \[rad\].
    pub fn over(&self, yaw: Interval) -> [f64; YAW_COEFFICIENTS] {
        let nodes: [f64; YAW_COEFFICIENTS] =
            from_fn(|k| self.at(yaw.at(0.5 * (1.0 + node(k, YAW_COEFFICIENTS)))));
        Self::through(&nodes, yaw, self.kind).coefficients
    }

    /// Returns the displacement \[mm\] under a yaw \[rad\].
    #[inline(always)]
    pub fn at(&self, yaw: f64) -> f64 {
        let u = share(self.yaw, yaw);
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * u + c)
    }
}

/// Returns the displacements \[mm\] between two curves under a yaw \[rad\].
pub(super) fn between(curves: &[Curve; 2], yaw: f64) -> Interval {
    curves.map(|curve| curve.at(yaw)).into()
}

/// Returns where a value is in an interval: −1 at its beginning, 1 at its end; 0 in one without width.
#[inline(always)]
pub(super) fn share(Interval { low: from, high: to }: Interval, value: f64) -> f64 {
    if to > from { ((value - from) - (to - value)) / (to - from) } else { 0.0 }
}

/// Returns point k of `count` from −1 to 1, those of Chebyshev with both ends.
pub(super) fn node(k: usize, count: usize) -> f64 {
    -(PI * k as f64 / (count - 1) as f64).cos()
}

/// Coefficients of the powers of t of the polynomials that are 1 at one node and 0 at the others, at \[node\]\[power\].
pub(super) static POWERS: LazyLock<[[f64; COEFFICIENTS]; COEFFICIENTS]> = LazyLock::new(powers);

/// Coefficients of the powers of u of the polynomials that are 1 at one node and 0 at the others, at \[node\]\[power\].
pub(super) static YAW_POWERS: LazyLock<[[f64; YAW_COEFFICIENTS]; YAW_COEFFICIENTS]> = LazyLock::new(powers);

/// Gives the coefficient of t^i of the polynomial that is 1 at node k and 0 at the others, at \[k\]\[i\].
fn powers<const N: usize>() -> [[f64; N]; N] {
    let last = N - 1;
    let mut chebyshev = [[0.0; N]; N];
    (chebyshev[0][0], chebyshev[1][1]) = (1.0, 1.0);
    for j in 2..N {
        for i in 0..=j {
            let twice = if i == 0 { 0.0 } else { 2.0 * chebyshev[j - 1][i - 1] };
            chebyshev[j][i] = twice - chebyshev[j - 2][i];
        }
    }
    let half = |k: usize| if k == 0 || k == last { 0.5 } else { 1.0 };
    let weight = |j: usize, k: usize| {
        2.0 / last as f64 * half(j) * half(k) * (PI * (j * (last - k)) as f64 / last as f64).cos()
    };
    from_fn(|k| from_fn(|i| (0..N).map(|j| weight(j, k) * chebyshev[j][i]).sum()))
}
