//! Tests that profiles come of bytes that no instrument wrote, or errors.

use super::*;
use wheelrail_report::random::SNIPPETS;

#[test]
fn ten_thousand_mutated_files_become_a_profile_or_an_error() {
    const ROUNDS: usize = 10_008;
    let mut random = Random::new(2026);
    let mut whole = 0;
    for round in 0..ROUNDS {
        let (name, original, side) = FILES[round % FILES.len()];
        let mut bytes = original.to_vec();
        random.mutate(&mut bytes, &SNIPPETS);
        let columns = [Column::Number(1 + random.below(3)), Column::Number(1 + random.below(3))];
        let curve = [None, Some(CurveKind::Interpolation), Some(CurveKind::Arcs)][random.below(3)];
        let repair = vec![Repair::DropDuplicates, Repair::Sort, Repair::RemoveSpikes, Repair::CutLoops];
        let unit = (name == "rail.csv").then_some(Unit::Metre);
        let columns = ["rail.csv", "rail.txt"].contains(&name).then_some(columns);
        let options = Options { mirror: Some(false), columns, unit, curve, repair, ..Options::default() };
        whole += usize::from(profile(name, &bytes, side, &options).is_ok());
    }
    assert!(whole > ROUNDS / 10, "{whole} fitted");
}
