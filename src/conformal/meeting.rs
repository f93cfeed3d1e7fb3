//! Where a line in the wheel's meridian plane meets one segment of its profile.

use crate::numerics::lanes::{Lanes, every, lanes};
use crate::numerics::polynomial::{divided_differences, value_and_slope, values_and_slopes};
use crate::profile::{Branch, BranchPoint, BranchPoints, BranchShape};

/// Most Newton steps along a polynomial. Each doubles the digits of the run.
const STEPS: usize = 20;

/// Step, as a share of the run from the known point, after which the run is exact to rounding: the next step is about its
/// square.
const LAST_STEP: f64 = 1e-8;

/// Least ε along a chord, as a share of the one that its tangent promises. That of a parabola to the place where it is parallel
/// to n is half as long.
const LEAST_STRETCH: f64 = 0.5;

/// Where N lines meet a branch.
#[derive(Debug, Clone, Copy)]
pub struct Meetings<const N: usize> {
    /// r \[mm\].
    pub r: Lanes<N>,
    /// Parameters of the points met on a polynomial.
    pub parameters: Option<Lanes<N>>,
}

/// Computes runs ε and r such that −ε d + r n lies on a branch, for N lines from one known point of it. ε is exactly `runs` on arcs
/// and lines, and about `runs` on a polynomial, where no root is sought. `drift` is d_ξ n_ζ − d_ζ n_ξ. The result is NaN as for
/// [`along`], and if the chord may end beyond a place at which the polynomial is parallel to n.
#[inline(always)]
pub fn along_by<const N: usize>(
    branch: &Branch,
    from: &BranchPoint,
    runs: &Lanes<N>,
    (d, n): ([f64; 2], [f64; 2]),
    drift: f64,
) -> Option<[Lanes<N>; 2]> {
    match (&branch.shape, from) {
        (BranchShape::Polynomial(p), BranchPoints::Polynomial { t: [t], .. }) => {
            let (xi, zeta) = (p.xi.as_slice(), p.zeta.as_slice());
            let ([_, dx], [_, dz]) = (value_and_slope(xi, *t), value_and_slope(zeta, *t));
            let rate = 1.0 / (dx * n[1] - dz * n[0]);
            // The line moves across itself by −ε × drift.
            let steps: Lanes<N> = lanes(|k| -runs[k] * drift * rate);
            let to: Lanes<N> = lanes(|k| t + steps[k]);
            let (x, z) = (divided_differences(xi, &[*t; N], &to), divided_differences(zeta, &[*t; N], &to));
            let square = n[0] * n[0] + n[1] * n[1];
            let down = d[0] * n[0] + d[1] * n[1];
            let run: Lanes<N> = lanes(|k| runs[k] * rate * (x[k] * n[1] - z[k] * n[0]));
            let rise = |k: usize| {
                let r = (steps[k] * (x[k] * n[0] + z[k] * n[1]) + run[k] * down) / square;
                if rate > 0.0 && run[k] >= LEAST_STRETCH * runs[k] { r } else { f64::NAN }
            };
            Some([run, lanes(rise)])
        }
        _ => {
            let v0: [Lanes<N>; 2] = [lanes(|k| -runs[k] * d[0]), lanes(|k| -runs[k] * d[1])];
            Some([*runs, along(branch, &from.repeated(), [&v0[0], &v0[1]], [&[n[0]; N], &[n[1]; N]])?.r])
        }
    }
}

/// Computes r such that v₀ + r n lies on a branch, for N lines. v₀ is relative to known points of the branch. Of two solutions the
/// result is the one at which the line enters the wheel's material. It is NaN if the line misses the curve of the branch, and for
/// points of another branch. Arcs and lines are continued beyond the ends of the branch.
///
/// Method: the quadratic equation of an arc or line; Newton's method on a polynomial. Accuracy: a few roundings of r if v₀ is exact.
/// Cost: a root and a division on arcs. Returns `None` if Newton's steps do not settle: a caller of N lines then takes them one by
/// one, and a single line has no point.
#[inline(always)]
pub fn along<const N: usize>(
    branch: &Branch,
    from: &BranchPoints<N>,
    v0: [&Lanes<N>; 2],
    n: [&Lanes<N>; 2],
) -> Option<Meetings<N>> {
    match (&branch.shape, from) {
        (BranchShape::Arc(arc), BranchPoints::Arc { sin, cos, .. }) => {
            let r = |k: usize| {
                let ([x, z], [n_x, n_z]) = ([v0[0][k], v0[1][k]], [n[0][k], n[1][k]]);
                let square = n_x * n_x + n_z * n_z;
                let f = 2.0 * (z * cos[k] - x * sin[k]) - arc.curvature * (x * x + z * z);
                let b = n_z * cos[k] - n_x * sin[k] - arc.curvature * (n_x * x + n_z * z);
                let root = (b * b + arc.curvature * square * f).sqrt();
                // Seen from behind the centre the entry is the farther root. A line has no such side.
                let r = if b > 0.0 { -f / (b + root) } else { (b - root) / (arc.curvature * square) };
                if r.is_finite() { r } else { f64::NAN }
            };
            Some(Meetings { r: lanes(r), parameters: None })
        }
        (BranchShape::Polynomial(p), BranchPoints::Polynomial { t, .. }) => {
            let (xi, zeta) = (p.xi.as_slice(), p.zeta.as_slice());
            let cross: Lanes<N> = lanes(|k| n[1][k] * v0[0][k] - n[0][k] * v0[1][k]);
            let mut to = *t;
            for _ in 0..STEPS {
                let ([_, dx], [_, dz]) = (values_and_slopes(xi, &to), values_and_slopes(zeta, &to));
                let (x, z) = (divided_differences(xi, t, &to), divided_differences(zeta, t, &to));
                let across: Lanes<N> = lanes(|k| x[k] * n[1][k] - z[k] * n[0][k]);
                let next: Lanes<N> = lanes(|k| {
                    let miss = (to[k] - t[k]) * across[k] - cross[k];
                    (to[k] - miss / (dx[k] * n[1][k] - dz[k] * n[0][k])).max(p.t[0]).min(p.t[1])
                });
                let steps: Lanes<N> = lanes(|k| (next[k] - to[k]).abs());
                let done = every::<N>(|k| steps[k] <= LAST_STEP * (next[k] - t[k]).abs());
                to = next;
                if done {
                    let (x, z) = (divided_differences(xi, t, &to), divided_differences(zeta, t, &to));
                    let r = |k: usize| {
                        let across = x[k] * n[1][k] - z[k] * n[0][k];
                        let r = (z[k] * v0[0][k] - x[k] * v0[1][k]) / across;
                        if across > 0.0 { r } else { f64::NAN }
                    };
                    return Some(Meetings { r: lanes(r), parameters: Some(to) });
                }
            }
            None
        }
        // Points of another branch have no lines on this one.
        _ => Some(Meetings { r: [f64::NAN; N], parameters: None }),
    }
}
