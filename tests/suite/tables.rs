//! Contact tables against direct searches: no error above the stated one, and the same bits on any number of threads.

use crate::campaign::scenes;
use crate::common::repository;
use rayon::ThreadPoolBuilder;
use wheelrail::case::{Arrangement, Case, table};
use wheelrail::export::table_wrp;
use wheelrail::internal::Random;
use wheelrail::load::{curvatures_at, quadratic_form_at};
use wheelrail::profile::standards;
use wheelrail::scene;
use wheelrail::search::SideTouch;
use wheelrail::table::{ContactTable, TableQuantity};
use wheelrail::{Interval, Position, Result, Selection};

/// Vertical load on each wheel \[N\].
const LOAD: f64 = 60e3;

/// Range of the displacements \[mm\]: from flange to flange.
const RANGE: [f64; 2] = [-9.0, 9.0];

const DRAWN: &str =
    "rail = { profile = \"60E1\", rotate = \"1:40\" }\nwheel = { profile = \"S1002\", radius = 460.0 }\n";

const MEASURED: &str = "rail = { file = \"../profiles/60E1.ban\", mirror = true, rotate = \"1:40\" }\n\
                        wheel = { file = \"../profiles/S1002.prw\", radius = 460.0 }\n";

/// One side measured, its wheel smaller, and the other rail off its place.
const SIDES: &str = "[left.rail]\nfile = \"../profiles/60E1.ban\"\nmirror = true\nrotate = \"1:40\"\n\
                     [left.wheel]\nfile = \"../profiles/S1002.prw\"\nradius = 459.0\n\
                     [right.deviation]\nlateral = 1.5\nvertical = -0.5\nroll = 0.01\n";

/// Random displacements of each table. The environment variable `WHEELRAIL_TABLE_POINTS` takes another number.
fn points() -> usize {
    std::env::var("WHEELRAIL_TABLE_POINTS").ok().and_then(|n| n.parse().ok()).unwrap_or(2000)
}

/// Range of the yaws \[rad\] of tables over yaw.
const YAWS: [f64; 2] = [-0.02, 0.02];

/// Random displacements over the range and yaws over theirs, by Knuth's generator.
fn random(count: usize, lateral: [f64; 2], yaw: [f64; 2]) -> Vec<[f64; 2]> {
    let mut state = 36_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| [lateral, yaw].map(|[from, to]| from + (to - from) * next())).collect()
}

fn case(profiles: &str, more: &str, sides: &str) -> Result<Case> {
    let text = format!(
        "{profiles}track = {{ gauge = 1435.0 }}\npatch = {{ load = {LOAD:?} }}\n\
         wheelset = {{ back_to_back = 1360.0, flange_back_x = -70.0{more} }}\n{sides}"
    );
    let folder = repository("examples/scenes");
    scene::resolve(&scene::parse(&text, false)?, &folder, "table")
}

/// What a search has found of one quantity.
fn found(quantity: &TableQuantity, roll: f64, sides: &[SideTouch<'_>; 2], modulus: f64) -> f64 {
    let Some(right) = quantity.right else { return roll };
    let side = &sides[usize::from(right)];
    let contact = &side.touch.contacts[0];
    let curvatures = curvatures_at(contact);
    let form = quadratic_form_at(contact).map(|c| if contact.kink() { f64::NAN } else { c });
    let ellipse = curvatures.under_load(LOAD / contact.contact_angle.cos(), modulus);
    let of_ellipse = |value: fn([f64; 2], [f64; 2]) -> f64| {
        ellipse.filter(|_| !contact.kink()).map_or(f64::NAN, |ellipse| {
            value(curvatures.along(&ellipse), [ellipse.approach_mm, ellipse.pressure_n_per_mm2])
        })
    };
    match quantity.name {
        "z_mm" => side.z,
        "rail_x_mm" => contact.rail_x,
        "wheel_x_mm" => contact.wheel_x,
        "y_mm" => contact.y,
        "contact_angle_rad" => contact.contact_angle,
        "rolling_radius_mm" => contact.rolling_radius,
        "skew_rad" => contact.skew,
        "a_xi_per_mm" => form[0],
        "c_xi_eta_per_mm" => form[1],
        "b_eta_per_mm" => form[2],
        "hertz_xi_mm" => of_ellipse(|axes, _| axes[0]),
        "hertz_eta_mm" => of_ellipse(|axes, _| axes[1]),
        "hertz_approach_mm" => of_ellipse(|_, pressed| pressed[0]),
        "hertz_p_n_per_mm2" => of_ellipse(|_, pressed| pressed[1]),
        other => panic!("an unknown quantity {other}"),
    }
}

/// Compares a table with direct searches, each from an upright wheelset.
fn compare(name: &str, case: &Case, table: &ContactTable) -> Result<()> {
    compare_at(points(), name, case, table)
}

fn compare_at(count: usize, name: &str, case: &Case, table: &ContactTable) -> Result<()> {
    let Arrangement::Wheelset { system, position } = &case.setup().arrangement else {
        panic!("{name}: no wheelset")
    };
    let (mut search, quantities) = (system.search(), table.quantities());
    let mut values = vec![0.0; quantities.len()];
    let mut shares = vec![0.0_f64; quantities.len()];
    let mut exist = 0;
    for [lateral, yaw] in random(count, table.about().lateral.ends(), table.about().yaw.ends()) {
        table.fill(lateral, yaw, &mut values);
        let at = Position { lateral, yaw, ..*position };
        let touch = search.touch(&at, &Selection { within: 0.0, apart: 0.0 })?;
        for (q, quantity) in quantities.iter().enumerate() {
            let direct = found(quantity, touch.roll, &touch.sides, case.question().modulus());
            assert_eq!(
                values[q].is_nan(),
                direct.is_nan(),
                "{name}: {quantity:?} at {lateral} mm, {yaw} rad: {direct}"
            );
            if direct.is_nan() {
                continue;
            }
            exist += 1;
            let share = (values[q] - direct).abs() / quantity.error;
            assert!(
                share <= 1.0,
                "{name}: {quantity:?} at {lateral} mm, {yaw} rad: {} for {direct}",
                values[q]
            );
            shares[q] = shares[q].max(share);
        }
    }
    let worst = shares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap_or((0, &0.0));
    println!(
        "{name}: {} cells, {} points; at worst {:.2} of the stated error, of {} {}",
        table.cells().len(),
        count,
        worst.1,
        quantities[worst.0].name,
        quantities[worst.0].side()
    );
    assert!(2 * exist > count * quantities.len(), "{name}: {exist} values");
    Ok(())
}

#[test]
fn tables_err_by_no_more_than_they_state() -> Result<()> {
    let cases = [
        ("drawn", case(DRAWN, "", "")?),
        ("drawn, yawed", case(DRAWN, ", yaw = 0.01", "")?),
        ("drawn, without roll", case(DRAWN, ", roll = \"neglect\"", "")?),
        ("measured", case(MEASURED, "", "")?),
        ("measured, yawed", case(MEASURED, ", yaw = -0.004", "")?),
        ("unlike sides", case(DRAWN, "", SIDES)?),
    ];
    for (name, case) in &cases {
        let made = table(case, RANGE.into(), None, 1e-3, true)?;
        let over = made.quantities().iter().find(|quantity| quantity.error > quantity.tolerance);
        assert!(over.is_none(), "{name}: {over:?}");
        compare(name, case, &made)?;
    }
    Ok(())
}

#[test]
fn tables_over_yaw_err_by_no_more_than_they_state() -> Result<()> {
    let cases = [
        ("drawn, over yaw", case(DRAWN, "", "")?, RANGE, YAWS),
        ("measured, over yaw", case(MEASURED, "", "")?, [-3.0, 3.0], YAWS),
        ("unlike sides, over yaw", case(DRAWN, "", SIDES)?, [-2.0, 2.0], [0.001, 0.02]),
    ];
    for (name, case, lateral, yaw) in &cases {
        let made = table(case, Interval::from(*lateral), Some(Interval::from(*yaw)), 1e-3, true)?;
        let over = made.quantities().iter().find(|quantity| quantity.error > quantity.tolerance);
        assert!(over.is_none(), "{name}: {over:?}");
        assert!(made.about().beside_curves() <= 1e-6);
        compare(name, case, &made)?;
        let text = table_wrp(&made, name);
        assert!(text.is_ascii() && text.lines().all(|line| line.len() < 80));
        assert!(table_wrp(&ContactTable::read(&text)?, name) == text, "{name}: another table is read");
    }
    Ok(())
}

#[test]
fn arrays_of_other_sizes_are_refused() -> Result<()> {
    let table = table(&case(DRAWN, "", "")?, Interval::new(0.0, 0.5), None, 1e-3, true)?;
    let said = |yaw: &[f64], numbers: &[usize], count: usize| {
        let filled = table.fill_many(&[0.1, 0.2, 0.3], yaw, numbers, &mut vec![0.0; count]);
        filled.err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert_eq!(said(&[0.0], &[0, 1], 6), "");
    assert!(said(&[0.0; 2], &[0], 3).starts_with("yaw: found 2 values; expected one, or 3 as of lateral"));
    assert!(
        said(&[0.0], &[0, 1], 3).starts_with("out: found 3 values; expected 6, 3 of each of 2 quantities")
    );
    assert!(said(&[0.0], &[99], 3).starts_with("numbers: found 99; expected a number below"));
    Ok(())
}

#[test]
fn any_number_of_threads_makes_and_reads_the_same_table() -> Result<()> {
    let case = case(DRAWN, ", yaw = 0.002", "")?;
    let places = random(points(), RANGE, YAWS);
    let [lateral, yaws] = [0, 1].map(|k| places.iter().map(|place| place[k]).collect::<Vec<f64>>());
    for yaw in [None, Some(Interval::new(0.0, 0.01))] {
        let on = |threads: usize| -> Result<(String, Vec<u64>)> {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let made = table(&case, RANGE.into(), yaw, 1e-3, true)?;
                let numbers: Vec<usize> = (0..made.quantities().len()).rev().collect();
                let mut all = vec![0.0; numbers.len() * lateral.len()];
                let yaws = if yaw.is_some() { yaws.as_slice() } else { &made.about().yaw.ends()[..1] };
                made.fill_many(&lateral, yaws, &numbers, &mut all)?;
                let mut row = vec![0.0; numbers.len()];
                for (k, y) in lateral.iter().enumerate() {
                    made.fill(*y, yaws[k % yaws.len()], &mut row);
                    let column = |(place, &number): (usize, &usize)| {
                        all[place * lateral.len() + k].to_bits() == row[number].to_bits()
                    };
                    assert!(numbers.iter().enumerate().all(column), "{y}");
                }
                Ok((table_wrp(&made, "threads"), all.iter().map(|value| value.to_bits()).collect()))
            })
        };
        let one = on(1)?;
        assert!(on(2)? == one && on(5)? == one);
    }
    Ok(())
}

/// A wheelset of built-in profiles, its left wheel smaller by so much \[mm\].
fn unequal(rail: &str, wheel: &str, radius: f64, smaller: f64) -> Result<Case> {
    let text = format!(
        "rail = {{ profile = {rail:?}, rotate = \"1:40\" }}\nwheel = {{ profile = {wheel:?}, radius = {radius:?} }}\n\
         track = {{ gauge = 1435.0 }}\npatch = {{ load = {LOAD:?} }}\n\
         wheelset = {{ back_to_back = 1360.0, flange_back_x = -70.0 }}\n\
         [left.wheel]\nprofile = {wheel:?}\nradius = {:?}\n",
        radius - smaller
    );
    scene::resolve(&scene::parse(&text, false)?, std::path::Path::new("."), "unequal")
}

/// Where a flange is so steep that a roll at which both wheels touch ends, the table is that of searches, and is cut there: random pairs
/// on their flanges, and the pair whose table had the other roll before the end.
#[test]
fn tables_are_cut_where_a_roll_ends() -> Result<()> {
    let defect = repository("tests/defects/table-fold-of-roll.toml");
    let end = scene::resolve(&scene::load(&defect)?, std::path::Path::new("."), "end")?;
    for range in [[4.66, 4.69], [-4.69, -4.66], [4.0, 5.5]] {
        let made = table(&end, range.into(), None, 1e-3, false)?;
        compare_at(300, &format!("45E3 under EN15302-B, {range:?}"), &end, &made)?;
        let jumps = made.roll_jumps(0.0);
        assert!(jumps.iter().any(|[lateral, _]| (lateral.abs() - 4.6777).abs() < 1e-3), "{jumps:?}");
    }
    let mut random = Random::new(6518);
    let rails: Vec<&str> = standards::rail_names().collect();
    let wheels: Vec<&str> = standards::wheel_names().collect();
    let (mut made, mut cut) = (0, 0);
    while made < scenes() {
        let (rail, wheel) = (*random.pick(&rails), *random.pick(&wheels));
        // Large wheels roll over on flanges of 70° already.
        let (radius, smaller) = (random.between(460.0, 660.0), random.between(0.0, 1.0));
        let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let from = side * random.between(3.0, 9.0);
        let Ok(case) = unequal(rail, wheel, radius, smaller) else { continue };
        let Ok(table) = table(&case, Interval::new(from - 1.0, from + 1.0), None, 1e-3, false) else {
            continue;
        };
        if !table.off_rail_somewhere().is_empty() {
            continue;
        }
        made += 1;
        cut += usize::from(!table.roll_jumps(0.0).is_empty());
        let name = format!("{rail} under {wheel}, {radius} mm, {smaller} mm smaller, from {from} mm");
        compare_at(100, &name, &case, &table)?;
    }
    println!("{made} tables, {cut} cut where a roll ends");
    assert!(cut > 0 || made < 20, "{made} tables, none of them cut where a roll ends");
    Ok(())
}
