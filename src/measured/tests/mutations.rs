//! Tests that readers survive bytes that no instrument wrote.

use super::*;
use crate::numerics::random::Random;

const SNIPPETS: [&str; 18] = [
    "\n",
    "\n\n",
    " ",
    ",",
    ";",
    "=",
    "\"",
    "!",
    "-",
    "1e999",
    "nan",
    "\u{1a}",
    "[Profile2Points]\n",
    "XYPoints=1\n",
    "MPD3=A 1 2 3 4 5\n",
    "point.end\n",
    "inversion = 1\n",
    "ColumnDef=Y,X\n",
];

fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(3) {
        let at = random.below(bytes.len());
        let end = (at + random.below(40)).min(bytes.len());
        match random.below(7) {
            0 if at < bytes.len() => bytes[at] = random.below(256) as u8,
            1 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            4 => bytes.truncate(at.max(1)),
            5 => bytes[at..end].reverse(),
            _ => {
                let snippet = SNIPPETS[random.below(SNIPPETS.len())];
                bytes.splice(at..at, snippet.bytes());
            }
        }
    }
}

#[test]
fn every_reader_survives_a_hundred_thousand_mutations() {
    const ROUNDS: usize = 100_008;
    let mut random = Random::new(2026);
    let (mut good, mut whole) = (0, 0);
    for round in 0..ROUNDS {
        let (name, original, side) = FILES[round % FILES.len()];
        let mut bytes = original.to_vec();
        mutate(&mut bytes, &mut random);
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
        // One round in ten makes the rest of the profile, too.
        if round % 10 == 0 {
            let curve = [None, Some(CurveKind::Interpolation), Some(CurveKind::Arcs)][random.below(3)];
            let repair = vec![Repair::DropDuplicates, Repair::Sort, Repair::RemoveSpikes, Repair::CutLoops];
            let unit = (name == "rail.csv").then_some(Unit::Metre);
            let columns = free.then_some(columns);
            let options = Options { mirror: Some(false), columns, unit, curve, repair, ..Options::default() };
            whole += usize::from(profile(name, &bytes, side, &options).is_ok());
        }
    }
    assert!(good > ROUNDS / 10 && whole > ROUNDS / 100, "{good} read, {whole} fitted");
}
