//! Tests that readers survive bytes that no instrument wrote.

use super::*;
use wheelrail_report::random::{Random, SNIPPETS};

#[test]
fn every_reader_survives_a_hundred_thousand_mutations() {
    const ROUNDS: usize = 100_008;
    let mut random = Random::new(2026);
    let mut good = 0;
    for round in 0..ROUNDS {
        let (name, original) = FILES[round % FILES.len()];
        let mut bytes = original.to_vec();
        random.mutate(&mut bytes, &SNIPPETS);
        let Ok(format) = Format::of_file(name) else { unreachable!("{name}") };
        let columns = [Column::Number(1 + random.below(3)), Column::Number(1 + random.below(3))];
        let free = matches!(format, Format::Text | Format::Csv);
        match read::reader::read(&bytes, format, free.then_some(&columns)) {
            Ok(points) => {
                good += 1;
                assert!(points.at.len() <= bytes.len() && points.at.iter().all(|p| p.x.is_finite()));
            }
            Err(error) => {
                let placed = error.place.starts_with("line ") || error.place.starts_with("point ");
                assert!(placed, "round {round}: {error}");
            }
        }
    }
    assert!(good > ROUNDS / 10, "{good} read");
}
