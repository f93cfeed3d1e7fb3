//! What the three gaps of conforming pairs do to a pressure, by Tamaas, against the data of the report and the table of the docs.

use crate::programs::{folder, output_of};
use std::fmt::Write as _;
use std::path::Path;
use wheelrail::export::array_npy;
use wheelrail::load::{Elastic, effective_modulus};
use wheelrail_report::conformal::pairs::{ConformingPair, GAPS, HEADER, conforming_pairs};
use wheelrail_report::loads::Solved;
use wheelrail_report::page::conforming_table;

/// The page that holds the table.
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../src/docs/conformal.md");

/// The data of the report, which has the pressures.
const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../report/data/conformal.csv");

/// Largest relative difference from the data.
const SAME: f64 = 1e-4;

fn write_array(path: &Path, shape: &[u64], values: &[f64]) {
    let mut file = std::fs::File::create(path).unwrap();
    array_npy(&mut file, shape, values).unwrap();
}

/// Writes the three gaps of a pair.
fn write_grid(dir: &Path, pair: &ConformingPair) {
    std::fs::create_dir_all(dir).unwrap();
    let grid = &pair.grid;
    let shape = [GAPS.len() as u64, grid.sigma.len() as u64, grid.eta.len() as u64];
    write_array(&dir.join("gaps.npy"), &shape, &grid.gaps.concat());
    write_array(&dir.join("cosine.npy"), &shape[1..2], &grid.cosine);
    let [sigma, eta] = [&grid.sigma, &grid.eta].map(|axis| axis[1] - axis[0]);
    let numbers = format!("{sigma:?} {eta:?} {:?} {:?}", pair.normal_load(), pair.patch.approach);
    std::fs::write(dir.join("numbers.txt"), numbers).unwrap();
}

/// Lets Tamaas solve all pairs, in their order.
fn solve(dir: &Path, pairs: &[ConformingPair]) -> Option<Vec<[Solved; GAPS.len()]>> {
    for (number, pair) in pairs.iter().enumerate() {
        write_grid(&dir.join(format!("{number:02}")), pair);
    }
    let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
    let lines = output_of("conformal_table.py", dir, &[&format!("{modulus:?}")])?;
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').skip(1).map(|cell| cell.parse().unwrap()).collect();
        [0, 1, 2].map(|gap| {
            let [peak, approach, area] = numbers[3 * gap..3 * gap + 3].try_into().unwrap();
            Solved { peak, approach, area }
        })
    };
    Some(lines.lines().map(row).collect())
}

/// The data as it should be.
fn data(pairs: &[ConformingPair]) -> String {
    let mut out = format!("{HEADER}\n");
    for pair in pairs {
        let _ = write!(out, "{},{:.1}", pair.key(), pair.normal_load());
        for Solved { peak, approach, area } in pair.solved.unwrap() {
            let _ = write!(out, ",{peak:.3},{approach:.7},{area:.4}");
        }
        out.push('\n');
    }
    out
}

#[test]
fn pressures_of_conforming_pairs_are_those_of_tamaas() {
    let (mut pairs, dir) = (conforming_pairs().unwrap(), folder("conforming"));
    let Some(solved) = solve(&dir, &pairs) else { return };
    assert_eq!(solved.len(), pairs.len());
    let known: Vec<_> = pairs.iter().map(|pair| pair.solved).collect();
    for (pair, solved) in pairs.iter_mut().zip(solved) {
        pair.solved = Some(solved);
    }
    let table = conforming_table(&pairs);
    std::fs::write(dir.join("conformal.csv"), data(&pairs)).unwrap();
    std::fs::write(dir.join("conformal.md"), &table).unwrap();
    for (pair, known) in pairs.iter().zip(known) {
        let advice = format!("{}: {DATA} differs; put that of {} there", pair.key(), dir.display());
        let (known, solved) = (known.expect(&advice), pair.solved.unwrap());
        for (known, solved) in known.into_iter().zip(solved) {
            let same = |a: f64, b: f64| (a / b - 1.0).abs() < SAME;
            assert!(same(known.peak, solved.peak) && same(known.approach, solved.approach), "{advice}");
            assert!(same(known.area, solved.area), "{advice}");
        }
    }
    let docs = std::fs::read_to_string(DOCS).unwrap();
    assert!(docs.contains(&table), "{DOCS} has another table; put that of {} there", dir.display());
}
