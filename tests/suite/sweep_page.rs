//! What the page of a sweep shows of a position is what its table says.

use wheelrail::case::{Arrangement, DoubtSet, SweepColumns, sweep_page};
use wheelrail::export::SweepSide;
use wheelrail::search::{ONE_CONTACT, ParallelSweep, Selection};
use wheelrail::{Position, Profile, Roll, scene};

/// A point of a wheel's profile in the axes of the rail's, in the plane that a page shows: what its script computes.
fn in_section(side: &SweepSide, number: usize, radius: f64, [x, z]: [f64; 2]) -> [f64; 2] {
    let [dx, dz, angle, yaw, ahead] = [0, 1, 2, 3, 4].map(|k| side.places[5 * number + k]);
    let along = (ahead - x * yaw.sin()) / yaw.cos();
    let across = x * yaw.cos() - along * yaw.sin();
    let up = radius - ((radius - z).powi(2) - along * along).sqrt();
    [dx + across * angle.cos() - up * angle.sin(), dz + across * angle.sin() + up * angle.cos()]
}

/// The example's wheelset, with and without yaw: the page puts both bodies' points of contact in one place.
#[test]
fn the_pair_of_profiles_touches_where_the_table_says() {
    let text = include_str!("../../examples/scenes/wheelset.toml");
    let scene = scene::parse(text, false).unwrap();
    let case = scene::resolve(&scene, ".".as_ref(), "wheelset").unwrap();
    let Arrangement::Wheelset { system, .. } = &case.setup().arrangement else { panic!("no wheelset") };
    for yaw in [0.0, 0.02] {
        let lateral = [-6.0, 0.0, 3.0, 7.0];
        let positions = lateral.map(|lateral| Position { lateral, yaw, roll: Roll::Solve });
        let selection = Selection { within: 0.0, apart: ONE_CONTACT };
        let mut columns = SweepColumns::default();
        let sweep = ParallelSweep { system, selection, conicity: None, positions: &positions };
        let rows = |chunk: &mut SweepColumns, position, rows: &[_]| {
            rows.iter().for_each(|row| chunk.push(position, row, None, DoubtSet::default()));
            Ok(())
        };
        let all = |_, chunks: Vec<SweepColumns>| {
            chunks.iter().for_each(|chunk| columns.extend(chunk));
            Ok(true)
        };
        sweep.blocks(rows, all).unwrap();
        let page = sweep_page(&case, system, &columns, &lateral, "").unwrap();
        let pair = &case.profiles().right.pair;
        for side in &page.sides {
            assert!(side.position.len() >= lateral.len() && side.rails.is_empty() && side.wheels.is_empty());
            for (k, &number) in side.position.iter().enumerate() {
                let height = |profile: &Profile, body: usize, x: f64| {
                    let [rail, wheel] = pair.sections();
                    [rail, wheel][body].point(profile, x).unwrap().station.z
                };
                let wheel = [side.wheel_x[k], height(pair.wheel(), 1, side.wheel_x[k])];
                let [x, z] = in_section(side, number, pair.wheel_radius(), wheel);
                let rail = [side.rail_x[k], height(pair.rail(), 0, side.rail_x[k])];
                assert!((x - rail[0]).hypot(z - rail[1]) < 1e-9, "{yaw}, {number}: {x} {z} {rail:?}");
            }
        }
    }
}
