//! Half-spaces of cells: what presses where, against Hertz, a line's closed form, one grid over both regions, and direct sums.

use std::f64::consts::PI;

use wheelrail::load::{Cells, Curvatures, Ellipse, HalfSpace, Located, Pressures, press, press_alone};
use wheelrail::nalgebra::Point3;
use wheelrail::{Interval, Result, Window};

/// E* of steel \[N/mm²\].
const STEEL: f64 = 113_932.0;

/// Largest violation of contact's conditions, as a share of δ, to which pressures are solved where sums are compared: the sums
/// themselves are right to 1e-14.
const WITHIN: f64 = 5e-13;

/// Cells over the box around the overlap of a paraboloid about `centre`, with its ellipse.
fn paraboloid(
    [a, b]: [f64; 2],
    centre: [f64; 2],
    approach: f64,
    count: [usize; 2],
) -> Result<(HalfSpace, Option<Ellipse>)> {
    let [xi, eta] = [(a, centre[0]), (b, centre[1])].map(|(curvature, centre)| {
        let reach = (approach / curvature).sqrt();
        Interval::of(centre).grown(reach)
    });
    let cells = Cells::over(&Window { xi, eta }, count)?;
    let gaps = gaps(&cells, |x, y| a * (x - centre[0]).powi(2) + b * (y - centre[1]).powi(2));
    let curvatures = Curvatures { a_per_mm: a.min(b), b_per_mm: a.max(b), long_axis_rad: 0.0 };
    Ok((HalfSpace::new(cells, &gaps, approach)?, curvatures.under_approach(approach, STEEL)))
}

fn gaps(cells: &Cells, gap: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let eta = cells.middles(1);
    cells.middles(0).iter().flat_map(|x| eta.iter().map(|y| gap(*x, *y))).collect()
}

fn differs(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// Circles, and ellipses of up to 1 : 70, long along ξ or along η.
#[test]
fn hertz_is_found_on_the_cells_of_loads() -> Result<()> {
    for curvatures in [[1e-3, 1e-3], [5e-4, 2e-3], [2e-3, 5e-4], [1.1e-3, 0.04], [0.04, 1.1e-3], [2e-5, 0.02]]
    {
        for approach in [1e-6, 0.02, 0.1] {
            let (region, exact) = paraboloid(curvatures, [3.0, 0.0], approach, [32, 16])?;
            let Some(exact) = exact else { panic!("no ellipse") };
            let found = press(&[region.alone()], 3e-4, STEEL)?.swap_remove(0);
            assert!(
                differs(found.load(), exact.load_n) < 2.5e-3,
                "{curvatures:?}: {} {exact:?}",
                found.load()
            );
            let largest = found.largest();
            assert!(
                differs(largest.pressure_n_per_mm2, exact.pressure_n_per_mm2) < 0.01,
                "{largest:?} {exact:?}"
            );
        }
    }
    Ok(())
}

#[test]
fn hertz_is_found_on_fine_cells_with_an_estimate_of_the_error() -> Result<()> {
    let cases = [
        ([1e-3, 1e-3], [100, 100]),
        ([5e-4, 2e-3], [96, 81]),
        ([0.04, 1.1e-3], [100, 60]),
        ([2e-5, 0.02], [128, 64]),
    ];
    for (curvatures, count) in cases {
        let (region, exact) = paraboloid(curvatures, [0.0, -2.0], 0.08, count)?;
        let Some(exact) = exact else { panic!("no ellipse") };
        let [fine, wider] = press_alone(region, 1e-4, STEEL)?;
        let found = fine.largest();
        let error = differs(found.pressure_n_per_mm2, exact.pressure_n_per_mm2);
        assert!(error < 1e-3, "{curvatures:?}: {found:?} {exact:?}");
        let estimate = fine.largest_error(&wider) / exact.pressure_n_per_mm2;
        assert!(error < estimate && estimate < 5e-3, "{curvatures:?}: {error:e} {estimate:e}");
        assert!(
            found.at_mm[0].abs() < 0.005 * exact.a_mm && (found.at_mm[1] + 2.0).abs() < 0.005 * exact.a_mm
        );
        assert!(differs(fine.load(), exact.load_n) < 3e-4, "{curvatures:?}: {} {exact:?}", fine.load());
        let area = PI * exact.a_mm * exact.b_mm;
        assert!(differs(fine.contact_area(), area) < 5e-3, "{curvatures:?}: {} {area}", fine.contact_area());
    }
    Ok(())
}

/// The middle of a cylinder 30 times as long as its contact is wide: p₀ = E* b/2R of the plane problem.
#[test]
fn the_middle_of_a_long_cylinder_has_the_pressures_of_a_line() -> Result<()> {
    let (radius, half_length, width) = (10.0, 30.0, 2.0);
    let window = Window { xi: Interval::symmetric(half_length), eta: Interval::symmetric(width) };
    let cells = Cells::over(&window, [60, 80])?;
    let region = HalfSpace::new(cells, &gaps(&cells, |_, y| y * y / (2.0 * radius)), 0.1)?;
    let found = press(&[region.alone()], 1e-4, STEEL)?.swap_remove(0);
    let middle = &found.values()[30 * 80..31 * 80];
    let force: f64 = middle.iter().sum::<f64>() * cells.step[1];
    let line = (force * STEEL / (PI * radius)).sqrt();
    let most = middle.iter().fold(0.0, |a: f64, b| a.max(*b));
    assert!(differs(most, line) < 5e-3, "{most} {line}");
    Ok(())
}

/// Two spheres, solved on one grid over both and as two regions that press upon each other from afar.
#[test]
fn regions_press_upon_each_other_as_on_one_grid() -> Result<()> {
    let (a, approach) = (2e-3, [0.08, 0.05]);
    for distance in [16.0, 30.0] {
        let cells = Cells::over(
            &Window { xi: Interval::new(-8.0, distance + 8.0), eta: Interval::symmetric(8.0) },
            [240, 120],
        )?;
        let one = |x: f64, y: f64, lift: f64| a * (x * x + y * y) + lift;
        let both = gaps(&cells, |x, y| one(x, y, 0.0).min(one(x - distance, y, approach[0] - approach[1])));
        let whole = press(&[HalfSpace::new(cells, &both, approach[0])?.alone()], 1e-4, STEEL)?;
        let columns = cells.middles(0).iter().filter(|x| **x < distance / 2.0).count() * cells.count[1];
        let left: f64 = whole[0].values()[..columns].iter().sum::<f64>() * cells.area();
        let (first, alone) = paraboloid([a, a], [0.0; 2], approach[0], [64, 64])?;
        let (second, _) = paraboloid([a, a], [0.0; 2], approach[1], [64, 64])?;
        let second = Located { middle: Point3::new(distance, 0.0, 0.0), ..second.alone() };
        let apart: Vec<f64> =
            press(&[first.alone(), second], 1e-4, STEEL)?.iter().map(Pressures::load).collect();
        assert!(differs(apart[0], left) < 2e-3, "{distance}: {apart:?} {left}");
        assert!(differs(apart.iter().sum(), whole[0].load()) < 2e-3, "{distance}: {apart:?}");
        assert!(alone.is_some_and(|alone| differs(alone.load_n, left) > 0.01), "{alone:?} {left}");
    }
    Ok(())
}

#[test]
fn nothing_presses_without_overlap() -> Result<()> {
    let cells = Cells::over(&Window { xi: Interval::new(0.0, 1.0), eta: Interval::new(0.0, 1.0) }, [8, 8])?;
    let found = press(&[HalfSpace::new(cells, &[f64::NAN; 64], 0.1)?.alone()], 1e-4, STEEL)?;
    assert_eq!([found[0].load(), found[0].contact_area(), found[0].largest().pressure_n_per_mm2], [0.0; 3]);
    assert!(press(&[], 1e-4, STEEL)?.is_empty());
    assert!(Cells::over(&Window::UNBOUNDED, [8, 8]).is_err());
    assert!(HalfSpace::new(cells, &[0.0; 63], 0.1).is_err());
    Ok(())
}

/// ∬ 1/r over a cell whose middle lies so many cells away, from its edges, one by one.
fn influence(away: [f64; 2], step: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|k| [(away[k] - 0.5) * step[k], (away[k] + 0.5) * step[k]]);
    let part = |a: f64, [from, to]: [f64; 2]| a * ((to / a.abs()).asinh() - (from / a.abs()).asinh());
    part(x[1], y) - part(x[0], y) + part(y[1], x) - part(y[0], x)
}

/// s + u = δ where anything presses and s + u ≥ δ elsewhere, with u summed over all cells one by one: of smooth overlaps that press
/// everywhere and of rough ones that press here and there, on many cells, one, or a row of them, square and flat.
#[test]
fn pressures_close_the_overlap_by_direct_sums() -> Result<()> {
    let shapes =
        [([32, 16], [0.3, 0.5]), ([7, 11], [1e-2, 1.0]), ([1, 1], [0.2, 0.1]), ([1, 30], [2.0, 0.1])];
    for ((count, step), rough) in shapes.into_iter().flat_map(|shape| [(shape, 1e-3), (shape, 1.2)]) {
        let (cells, approach) = (Cells { from: [0.0; 2], step, count }, 0.1);
        let all = count[0] * count[1];
        let gap = |k: usize| approach * rough * ((k * k + 3 * k + 1) % 17) as f64 / 17.0;
        let gaps: Vec<f64> = (0..all).map(gap).collect();
        let found = press(&[HalfSpace::new(cells, &gaps, approach)?.alone()], WITHIN, STEEL)?.swap_remove(0);
        let pressure = found.values();
        assert!(pressure.iter().all(|p| *p >= 0.0) && found.load() > 0.0, "{count:?} {rough}");
        for (to, gap) in gaps.iter().enumerate() {
            let place = |k: usize| [k / count[1], k % count[1]].map(|i| i as f64);
            let away = |from: usize| [0, 1].map(|k| (place(to)[k] - place(from)[k]).abs());
            let each = pressure.iter().enumerate().map(|(from, p)| p * influence(away(from), step));
            let open = (gap + each.sum::<f64>() / (PI * STEEL) - approach) / approach;
            let most = if pressure[to] > 0.0 { 2.0 * WITHIN } else { f64::INFINITY };
            assert!((-2.0 * WITHIN..most).contains(&open), "{count:?} {rough} {to}: {open:e}");
        }
    }
    Ok(())
}
