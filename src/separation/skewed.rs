//! Columns of a skewed wheel: s(ξ, ·) as polynomials in η, both parities.
//!
//! Along a column the wheel's own ξ′ = ξ cos χ + η sin χ moves too, so that s is no function of η². Between
//! joints it is analytic in η. Interpolation keeps the accuracy of the column's largest s; the few points
//! where s is much smaller, near C, are evaluated one by one.

use super::Evaluator;
use super::axis::EtaAxis;
use super::spectral::Demand;
use crate::numerics::chebyshev;
use crate::numerics::roots::bracketed;

/// Most nodes of a span.
const MOST_NODES: usize = chebyshev::MOST_POINTS;

/// Below this share of the span's largest |s| a point is evaluated on its own: interpolation there would
/// cost more than the promised thirteen relative digits.
const SMALL_SHARE: f64 = 1.0 / 64.0;

/// One column of the grid.
pub(super) fn column(
    evaluator: &mut Evaluator<'_>,
    axis: &EtaAxis,
    demand: Demand,
    xi: f64,
    out: &mut [f64],
) {
    let eta = &axis.eta;
    let (Some(&first), Some(&last)) = (eta.first(), eta.last()) else { return };
    let mut cuts = vec![first];
    breaks(evaluator, xi, first, last, &mut cuts);
    cuts.push(last);
    let mut begin = 0;
    for pair in cuts.windows(2) {
        let end = if pair[1] == last { eta.len() } else { eta.partition_point(|&eta| eta <= pair[1]) };
        let (eta, out) = (&eta[begin..end], &mut out[begin..end]);
        // Interpolating pays where there are more points than nodes.
        if eta.len() <= MOST_NODES || !interpolate(evaluator, demand, xi, [pair[0], pair[1]], eta, out) {
            evaluator.column(xi, eta, out);
        }
        begin = end;
    }
}

/// All η inside (first, last) where the column passes from one branch of the wheel to another.
fn breaks(evaluator: &mut Evaluator<'_>, xi: f64, first: f64, last: f64, cuts: &mut Vec<f64>) {
    // The profile abscissa p(η) = ξ′ − e sinθ is a slanted parabola up to terms of fourth order: its turning
    // point divides the column into two monotone halves.
    let slope = |evaluator: &mut Evaluator<'_>, eta: f64| evaluator.foot_slope(xi, eta);
    let turning = bracketed(|eta| slope(evaluator, eta), first, last);
    let mut halves = vec![first];
    halves.extend(turning.filter(|&eta| eta > first && eta < last));
    halves.push(last);
    for pair in halves.windows(2) {
        let ends = [0, 1].map(|k| evaluator.foot_abscissa(xi, pair[k]));
        let [low, high] = if ends[0] <= ends[1] { ends } else { [ends[1], ends[0]] };
        let joints: Vec<f64> = evaluator.wheel.section.pieces.iter().flat_map(|p| p.xi).collect();
        let mut found: Vec<f64> = joints
            .into_iter()
            .filter(|&joint| joint > low && joint < high)
            .filter_map(|joint| bracketed(|eta| evaluator.foot_abscissa(xi, eta) - joint, pair[0], pair[1]))
            .collect();
        found.sort_by(f64::total_cmp);
        found.dedup();
        cuts.extend(found);
        if pair[1] < last {
            cuts.push(pair[1]);
        }
    }
}

/// Chebyshev interpolation of s over one span; `false` where no allowed degree reaches the demand.
fn interpolate(
    evaluator: &mut Evaluator<'_>,
    demand: Demand,
    xi: f64,
    [a, b]: [f64; 2],
    eta: &[f64],
    out: &mut [f64],
) -> bool {
    let (centre, half) = (a + (b - a) / 2.0, (b - a) / 2.0);
    let mut c = [0.0; MOST_NODES];
    let mut n = 6;
    let scale = loop {
        let values: [f64; MOST_NODES] = std::array::from_fn(|j| {
            if j < n { evaluator.separation(xi, centre + half * chebyshev::point(j, n)) } else { 0.0 }
        });
        let scale = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        if values.iter().any(|v| v.is_nan()) {
            return false;
        }
        chebyshev::coefficients(&values[..n], &mut c[..n]);
        // Two last coefficients, since one parity may vanish.
        let tail = c[n - 1].abs() + c[n - 2].abs();
        let allowed = demand.absolute.min(demand.relative * scale).max(4.0 * f64::EPSILON * scale);
        if tail <= allowed {
            break scale;
        }
        n += 3;
        if n > MOST_NODES {
            return false;
        }
    };
    for (s, &eta) in out.iter_mut().zip(eta) {
        *s = chebyshev::value(&c[..n], (eta - centre) / half);
        if s.abs() < SMALL_SHARE * scale {
            *s = evaluator.separation(xi, eta);
        }
    }
    true
}
