//! Whole grids against points one by one, on every built-in pair: strips, joints on columns, masks, estimate.

use wheelrail::Interval;
use wheelrail::placement::Placement;
use wheelrail::separation::{EtaAxis, FULL_PRECISION, Method, plan};
use wheelrail_report::verification::built_in_pairs;

/// Half widths \[mm\] of windows inside one segment, over some joints, and over most of the profile; and columns.
const WINDOWS: [[f64; 2]; 3] = [[3.0, 4.0], [12.0, 15.0], [25.0, 40.0]];
const COLUMNS: usize = 120;

/// C on rail and wheel \[mm\]: flange root, gauge corner, crown.
const CONTACTS: [[f64; 2]; 3] = [[-33.0, -41.0], [-11.0, -9.0], [7.0, 12.0]];

fn steps(a: f64, b: f64, n: usize) -> Vec<f64> {
    (0..n).map(|k| a + (b - a) * k as f64 / (n - 1) as f64).collect()
}

/// Largest |spectral − pointwise| \[mm\] over a window with columns on every joint, and the estimate for the former.
fn difference(placement: &Placement, [half, reach]: [f64; 2], points: usize) -> (f64, f64) {
    let mut xi = steps(-0.9 * half, 1.1 * half, COLUMNS);
    let sections = [placement.rail().section(), placement.wheel().section()];
    let joints =
        sections.into_iter().flat_map(|section| section.joints(Interval::symmetric(half))).map(|(xi, _)| xi);
    xi.extend(joints.filter(|xi| xi.abs() < half));
    xi.sort_by(f64::total_cmp);
    xi.dedup();
    let axis = EtaAxis::new(&steps(-reach, reach, points));
    let mut plans = [Method::Spectral, Method::Pointwise]
        .map(|method| plan(placement, &xi, &axis, FULL_PRECISION, Some(method)));
    let [spectral, pointwise] = plans.each_mut().map(|plan| {
        let mut s = vec![0.0; xi.len() * axis.eta().len()];
        plan.fill(placement, &xi, &axis, &mut s);
        s
    });
    let apart = |(a, b): (&f64, &f64)| if a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() };
    let largest = spectral.iter().zip(&pointwise).map(apart).fold(0.0, |most: f64, d| {
        // A value for one only is as wrong as can be.
        if d.is_nan() { f64::INFINITY } else { most.max(d) }
    });
    (largest, plans[0].error)
}

#[test]
fn grids_and_points_agree_within_the_estimate_on_every_built_in_pair() {
    let mut compared = 0;
    for subject in built_in_pairs().expect("built-in profiles") {
        let pair = subject.placement.pair();
        for ([rail_x, wheel_x], window) in CONTACTS.into_iter().zip(WINDOWS) {
            // Not every wheel has a flange at −41 mm.
            let Ok(placement) = pair.placed(rail_x, wheel_x, 0.0) else { continue };
            let (largest, estimate) = difference(&placement, window, 9);
            assert!(largest <= estimate, "{} at {rail_x}: {largest:e} > {estimate:e}", subject.name);
            compared += 1;
        }
    }
    assert!(compared > 900, "{compared}");
}

#[test]
fn so_they_do_under_a_yawed_wheel() {
    let mut compared = 0;
    for (k, subject) in built_in_pairs().expect("built-in profiles").into_iter().enumerate() {
        let pair = subject.placement.pair();
        let ([rail_x, wheel_x], window) = (CONTACTS[k % 3], WINDOWS[k % 3]);
        for yaw in [-0.12, 0.004, 0.05] {
            let Ok(placement) = pair.placed(rail_x, wheel_x, yaw) else { continue };
            // More values of η than are computed one by one.
            let (largest, estimate) = difference(&placement, window, 53);
            assert!(largest <= estimate, "{} at {rail_x}, {yaw}: {largest:e} > {estimate:e}", subject.name);
            compared += 1;
        }
    }
    assert!(compared > 900, "{compared}");
}
