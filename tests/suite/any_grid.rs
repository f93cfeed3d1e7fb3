//! Grids of any size, place, spacing and tolerance against points one by one: within the estimate, on every built-in pair.

use std::cell::Cell;

use crate::common::holds;
use proptest::prelude::*;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::standards;
use wheelrail::separation::{EtaAxis, FULL_PRECISION, Method, plan};
use wheelrail_report::verification::built_in_pairs;

const CASES: u32 = 3000;

/// Values along one axis: half width \[mm\] as a power of ten, centre over half width, number, and places of some more.
type Axis = (f64, f64, usize, Vec<f64>);

fn axis(widest: f64) -> impl Strategy<Value = Axis> {
    let centre = prop_oneof![Just(0.0), -1.0..1.0f64];
    // Columns of whole vectors are mirrored where they are symmetric.
    let count = prop_oneof![1..160usize, (1..20usize).prop_map(|vectors| 8 * vectors)];
    (-3.0..widest, centre, count, prop::collection::vec(-1.0..1.0f64, 0..4))
}

fn values((width, centre, n, more): &Axis, extra: &[f64]) -> Vec<f64> {
    let half = 10f64.powf(*width);
    // −1 to 1, symmetric to the last bit.
    let even = (0..*n).map(|k| (2 * k) as f64 - (n - 1) as f64).map(|k| k / (*n.max(&2) - 1) as f64);
    let mut all: Vec<f64> = even.chain(more.iter().copied()).map(|place| half * (centre + place)).collect();
    let [first, last] = [f64::min, f64::max].map(|end| all.iter().copied().fold(all[0], end));
    all.extend(extra.iter().copied().filter(|x| first < *x && *x < last));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Compares a grid with its points one by one; the estimate of its error \[mm\].
fn within_estimate(
    placement: &Placement,
    xi: &[f64],
    axis: &EtaAxis,
    tolerance: f64,
    method: Option<Method>,
) -> Result<f64, String> {
    let filled = |tolerance, method| {
        let mut plan = plan(placement, xi, axis, tolerance, method);
        let mut s = vec![0.0; xi.len() * axis.eta().len()];
        s.fill(f64::INFINITY);
        plan.fill(placement, xi, axis, &mut s);
        (s, plan.error)
    };
    let (s, estimate) = filled(tolerance, method);
    let (exact, rounding) = filled(FULL_PRECISION, Some(Method::Pointwise));
    for (k, (s, exact)) in s.iter().zip(exact.iter()).enumerate() {
        let place = [xi[k / axis.eta().len()], axis.eta()[k % axis.eta().len()]];
        let right = (s - exact).abs() <= estimate + rounding || s.is_nan() && exact.is_nan();
        if !right {
            return Err(format!("{s} for {exact} at {place:?}, estimate {estimate:e}"));
        }
    }
    Ok(estimate)
}

/// 1.5 µm, too little for a span of its own: both spans of a column must mean the same u by their joint.
#[test]
fn a_step_of_the_drawing_is_within_the_estimate() -> Result<(), String> {
    let [rail, wheel] = [standards::rail("50E2"), standards::wheel("EN15302-I")];
    let pair = Pair::new(rail.expect("a rail"), wheel.expect("a wheel"), 20.0).expect("a pair");
    let placement = pair.placed(0.0, -30.1, 0.0).expect("a placement");
    let [xi, eta] = [1.0, 8.0].map(|half| values(&(f64::log10(half), 0.0, 52, Vec::new()), &[]));
    let estimate = within_estimate(&placement, &xi, &EtaAxis::new(&eta), FULL_PRECISION, None)?;
    assert!(estimate < FULL_PRECISION, "{estimate:e}");
    Ok(())
}

#[test]
fn any_grid_is_within_its_estimate() {
    let pairs = built_in_pairs().expect("built-in profiles");
    let radius = prop_oneof![300.0..600.0f64, (1.3..5.0f64).prop_map(|power| 10f64.powf(power))];
    let yaw = prop_oneof![2 => Just(0.0), 1 => -0.15..0.15f64];
    let tolerance = prop::sample::select(vec![FULL_PRECISION, 1e-9, 1e-6, 1e-3]);
    let method = prop::sample::select(vec![None, Some(Method::Spectral), Some(Method::Quadratic)]);
    let placed = (0..pairs.len(), radius, (-40.0..40.0f64, -60.0..70.0f64), yaw);
    let grid = (axis(1.8), axis(1.8), any::<bool>());
    let compared = Cell::new(0);
    holds("any grid", CASES, (placed, grid, tolerance, method), |(placed, grid, tolerance, method)| {
        let (index, radius, (rail_x, wheel_x), yaw) = placed;
        let [rail, wheel] = [pairs[index].placement.rail(), pairs[index].placement.wheel()];
        // Not every wheel may be so small, nor has every profile a point there.
        let pair = Pair::new(rail.profile().clone(), wheel.profile().clone(), radius);
        let Ok(placement) = pair.and_then(|pair| pair.placed(rail_x, wheel_x, yaw)) else { return Ok(()) };
        compared.set(compared.get() + 1);
        let (mut xi, mut eta, on_joints) = grid;
        eta.0 = eta.0.min((0.4 * radius).log10());
        xi.0 = xi.0.min((0.4 * radius).log10());
        let joints = if on_joints { placement.joints(-100.0, 100.0) } else { Vec::new() };
        let (xi, axis) = (values(&xi, &joints), EtaAxis::new(&values(&eta, &[])));
        // At a kink there is no quadratic form.
        let smooth = placement.rail().is_smooth() && placement.wheel().is_smooth();
        let method = method.filter(|method| *method != Method::Quadratic || smooth);
        within_estimate(&placement, &xi, &axis, tolerance, method)
            .map(drop)
            .map_err(|error| TestCaseError::fail(format!("{}: {error}", pairs[index].name)))
    });
    assert!(compared.get() > CASES / 2, "{compared:?}");
}
