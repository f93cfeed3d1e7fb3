//! Points of branches and chords of polynomial curves, at N abscissae at once, so that the processor computes them side by
//! side.
//!
//! A curve is given by the coefficients of ξ(t) and ζ(t) in lanes: one curve for all lanes, or one for each.

use crate::numerics::interval::Interval;
use crate::numerics::lanes::Lanes;
use crate::numerics::polynomial::{Coefficients, divided_differences, values_and_slopes};
use crate::numerics::roots::bracketed;

/// Bound of a Newton step after which t is exact to rounding: the step is below this share of the range and of the previous
/// step, and below t. The error that remains is about the square of the step. This holds down to the contact point at t =
/// 0.
const QUADRATIC: f64 = 1e-4 * 1e-4;

/// Most Newton steps. More are needed only where the branch is nearly vertical.
const STEPS: usize = 10;

/// Least multiple of ξ along a chord. The chord of a parabola to its vertex has half the run of the tangent.
const LEAST_STRETCH: f64 = 0.5;

/// N points of branches of one shape, from which chords are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BranchPoints<const N: usize> {
    /// Points of arcs, by their tangent angles.
    Arc {
        /// S, the sines.
        sin: Lanes<N>,
        /// C, the cosines.
        cos: Lanes<N>,
        /// 1/C.
        secant: Lanes<N>,
    },
    /// Points of polynomials.
    Polynomial {
        /// ξ \[mm\].
        xi: Lanes<N>,
        /// t.
        t: Lanes<N>,
        /// dt/dξ.
        rate: Lanes<N>,
    },
}

/// A single point of a branch.
pub type BranchPoint = BranchPoints<1>;

impl BranchPoint {
    /// Returns this point N times.
    #[inline(always)]
    pub fn repeated<const N: usize>(&self) -> BranchPoints<N> {
        match *self {
            Self::Arc { sin: [sin], cos: [cos], secant: [secant] } => {
                BranchPoints::Arc { sin: [sin; N], cos: [cos; N], secant: [secant; N] }
            }
            Self::Polynomial { xi: [xi], t: [t], rate: [rate] } => {
                BranchPoints::Polynomial { xi: [xi; N], t: [t; N], rate: [rate; N] }
            }
        }
    }
}

impl<const N: usize> BranchPoints<N> {
    /// Returns one of the points.
    #[inline(always)]
    pub fn lane(&self, k: usize) -> BranchPoint {
        match self {
            Self::Arc { sin, cos, secant } => {
                BranchPoints::Arc { sin: [sin[k]], cos: [cos[k]], secant: [secant[k]] }
            }
            Self::Polynomial { xi, t, rate } => {
                BranchPoints::Polynomial { xi: [xi[k]], t: [t[k]], rate: [rate[k]] }
            }
        }
    }
}

/// Returns each end of an interval N times. The arrays are written out, because the compiler may not inline `array::map`.
#[inline(always)]
pub(super) fn repeated<const N: usize>(range: Interval) -> [Lanes<N>; 2] {
    [[range.low; N], [range.high; N]]
}

/// Finds the points of curves at abscissae `xi`, and their ζ \[mm\]. The curves have ranges of t; `ends` holds ξ at the
/// ends of each range.
///
/// Returns `None` if N > 1 and Newton's steps do not settle; one lane always has a point.
#[inline(always)]
pub(super) fn points<const N: usize>(
    [c_xi, c_zeta]: [impl Coefficients<N>; 2],
    range: [Lanes<N>; 2],
    ends: [Lanes<N>; 2],
    xi: &Lanes<N>,
) -> Option<(BranchPoints<N>, Lanes<N>)> {
    let t = parameters(c_xi, range, xi, guess(range, ends, xi))?;
    let ([_, mut rate], [zeta, _]) = (values_and_slopes(c_xi, &t), values_and_slopes(c_zeta, &t));
    for rate in &mut rate {
        *rate = 1.0 / *rate;
    }
    Some((BranchPoints::Polynomial { xi: *xi, t, rate }, zeta))
}

/// Returns the t at which the straight line through the ends of the curve has the abscissa ξ.
#[inline(always)]
pub(super) fn guess<const N: usize>(range: [Lanes<N>; 2], ends: [Lanes<N>; 2], xi: &Lanes<N>) -> Lanes<N> {
    let mut guess = [0.0; N];
    for k in 0..N {
        let share = (xi[k] - ends[0][k]) / (ends[1][k] - ends[0][k]);
        guess[k] = range[0][k] + (range[1][k] - range[0][k]) * share;
    }
    guess
}

/// Finds t with ξ(t) = ξ, where ξ rises with t over a range. If ξ is beyond the range, t is that of the nearer end.
///
/// Method: Newton's steps from a guess, held within the range. If they do not settle, a single lane is bisected and several
/// lanes give `None`.
#[inline(always)]
pub(super) fn parameters<const N: usize>(
    c: impl Coefficients<N>,
    [low, high]: [Lanes<N>; 2],
    xi: &Lanes<N>,
    guess: Lanes<N>,
) -> Option<Lanes<N>> {
    let mut t = guess;
    let mut last = [f64::INFINITY; N];
    let mut settled = [0u64; N];
    for k in 0..N {
        t[k] = within(t[k], low[k], high[k]);
    }
    for _ in 0..STEPS {
        let [value, slope] = values_and_slopes(c, &t);
        for k in 0..N {
            let miss = value[k] - xi[k];
            let next = within(t[k] - miss / slope[k], low[k], high[k]);
            let step = (next - t[k]).abs();
            let done = (QUADRATIC * (high[k] - low[k])).min(next.abs());
            let small = step <= 2.0 * f64::EPSILON * next.abs();
            // At a vertical end the slope may be rounded to a negative number. The step then leads out of the range, away
            // from the root.
            let rises = (slope[k] > 0.0) | (miss == 0.0);
            settled[k] |= u64::from((small | ((step <= done) & (step <= QUADRATIC * last[k]))) & rises);
            (t[k], last[k]) = (next, step);
        }
        if settled.iter().fold(1, |all, settled| all & settled) == 1 {
            return Some(t);
        }
    }
    (N == 1).then(|| bisected(c, [low, high], xi))
}

/// Finds t with ξ(t) = ξ for each lane by bracketing. If ξ is beyond the range, t is that of the nearer end.
#[cold]
fn bisected<const N: usize>(c: impl Coefficients<N>, [low, high]: [Lanes<N>; 2], xi: &Lanes<N>) -> Lanes<N> {
    let mut t = high;
    for k in 0..N {
        let miss = |t: f64| values_and_slopes(c, &[t; N])[0][k] - xi[k];
        let beyond = if miss(low[k]) > 0.0 { low[k] } else { high[k] };
        t[k] = bracketed(miss, low[k], high[k]).unwrap_or(beyond);
    }
    t
}

/// Returns the value, limited to \[low, high\]; NaN stays NaN. `f64::clamp` checks its limits, which prevents vector code.
#[inline(always)]
fn within(value: f64, low: f64, high: f64) -> f64 {
    let above = if value < low { low } else { value };
    if above > high { high } else { above }
}

/// Computes the slopes of chords from points (ξ, t, dt/dξ) of curves to the abscissae `to`. Returns `None` if N > 1 and
/// Newton's steps do not settle.
#[inline(always)]
pub(super) fn chords<const N: usize>(
    [c_xi, c_zeta]: [impl Coefficients<N>; 2],
    range: [Lanes<N>; 2],
    [xi, t, rate]: [&Lanes<N>; 3],
    to: &Lanes<N>,
) -> Option<Lanes<N>> {
    let mut guess = *t;
    for k in 0..N {
        guess[k] += (to[k] - xi[k]) * rate[k];
    }
    let t_to = parameters(c_xi, range, to, guess)?;
    let (mut rise, run) = (divided_differences(c_zeta, t, &t_to), divided_differences(c_xi, t, &t_to));
    for k in 0..N {
        rise[k] /= run[k];
    }
    Some(rise)
}

/// Computes ζ and ξ along chords from points (t, dt/dξ) of curves, as multiples of `runs`. No root is sought: the other end
/// of a chord is where t has changed by runs × dt/dξ. The multiple of ξ is about 1; it is NaN if the chord may end beyond a
/// vertical tangent.
#[inline(always)]
pub(super) fn chords_near<const N: usize>(
    [c_xi, c_zeta]: [impl Coefficients<N>; 2],
    [t, rate]: [&Lanes<N>; 2],
    runs: &Lanes<N>,
) -> [Lanes<N>; 2] {
    let mut t_to = *t;
    for k in 0..N {
        t_to[k] += runs[k] * rate[k];
    }
    let (mut climb, mut stretch) =
        (divided_differences(c_zeta, t, &t_to), divided_differences(c_xi, t, &t_to));
    for k in 0..N {
        climb[k] *= rate[k];
        stretch[k] *= rate[k];
        stretch[k] = if stretch[k] > LEAST_STRETCH { stretch[k] } else { f64::NAN };
    }
    [climb, stretch]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chord_past_a_vertical_tangent_is_no_number() {
        // ξ = t − t²/2 is vertical at t = 1; ζ = t/10.
        let curve = [&[0.0, 1.0, -0.5][..], &[0.0, 0.1][..]];
        let [climb, stretch] = chords_near(curve, [&[0.0; 2], &[1.0; 2]], &[0.4, 1.2]);
        assert!((stretch[0] - 0.8).abs() < 1e-15 && (climb[0] - 0.1).abs() < 1e-15);
        assert!(stretch[1].is_nan());
    }

    #[test]
    fn one_lane_has_a_parameter_where_newton_fails() {
        // ξ = t³ − 3t² + 3t = 1 + (t − 1)³ is level at t = 1. ξ = t − t²/2 is vertical at its end.
        let level = [0.0, 3.0, -3.0, 1.0];
        for (c, high, xi) in [(&level[..], 2.0, 1.0 + 1e-12), (&[0.0, 1.0, -0.5][..], 1.0, 0.5 - 1e-12)] {
            let [t] = parameters(c, repeated(Interval::new(0.0, high)), &[xi], [high]).unwrap();
            assert!((values_and_slopes(c, &[t])[0][0] - xi).abs() < 1e-15, "{t}");
        }
        for (xi, end) in [(-1.0, 0.0), (9.0, 2.0)] {
            assert_eq!(parameters(&level[..], repeated(Interval::new(0.0, 2.0)), &[xi], [1.0]), Some([end]));
        }
    }
}
