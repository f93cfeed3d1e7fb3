//! Every wheel and rail file of the repository that `WHEELRAIL_CONTACT` names: its values are those of its own header, or a finding
//! names the difference.

use std::fs;
use std::path::{Path, PathBuf};

use super::*;

/// Difference \[mm\] that is a finding.
const MOST: f64 = 0.1;

/// Returns Sd, Sh and qR as the header of a MiniProf file has them: by keys, or three numbers before `(Sd/Sh/qR)`.
fn stated(text: &str) -> Vec<(Quantity, f64)> {
    let names = [("Sd", Quantity::FlangeThickness), ("Sh", Quantity::FlangeHeight), ("qR", Quantity::Qr)];
    if let Some((before, _)) = text.split_once("(Sd/Sh/qR)") {
        let line = before.trim_end().lines().last().unwrap_or_default().trim_start_matches(['"', ' ']);
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        return names.iter().map(|(_, quantity)| *quantity).zip(numbers).collect();
    }
    let of = |line: &str| {
        let (key, value) = line.split_once('=')?;
        let (_, quantity) = names.iter().find(|(name, _)| *name == key)?;
        Some((*quantity, value.trim().parse().ok()?))
    };
    text.lines().filter_map(of).collect()
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|own| {
            ["ban", "whl", "mpt", "prr", "prw"].iter().any(|known| own.eq_ignore_ascii_case(known))
        }) {
            found.push(path);
        }
    }
}

#[test]
fn files_have_the_values_of_their_headers_or_a_finding_names_the_difference() -> Result<()> {
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT") else { return Ok(()) };
    let mut all = Vec::new();
    files(Path::new(&contact), &mut all);
    let (mut compared, mut named, mut unread) = (0, 0, 0);
    for path in all {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let bytes = wheelrail::files::read_bytes(&path, measured::LARGEST_FILE)?;
        let extension = path.extension().map_or_else(String::new, |own| own.to_string_lossy().to_lowercase());
        let side = if ["whl", "prw"].contains(&extension.as_str()) { Side::Wheel } else { Side::Rail };
        let stated = stated(&String::from_utf8_lossy(&bytes));
        let read = |repair| {
            let curve = Some(CurveKind::Interpolation);
            let options = measured::Options { curve, repair, ..measured::Options::default() };
            measured::profile(&name, &bytes, side, &options)
        };
        let repaired = || read(vec![measured::Repair::Sort, measured::Repair::RemoveSpikes]);
        let Ok(read) = read(vec![]).or_else(|_| repaired()) else {
            unread += 1;
            continue;
        };
        let nominal = if side == Side::Wheel { standards::wheel("S1002")? } else { standards::rail("60E1")? };
        let alone =
            measure(&read.profile, side, None, &MeasureOptions::default())?.compared(&read.record.stated);
        for nominal in [None, Some(&nominal)] {
            let measures = measure(&read.profile, side, nominal, &MeasureOptions::default())?;
            let measures = measures.compared(&read.record.stated);
            for &(quantity, value) in &stated {
                let own = measures.value(quantity);
                assert_eq!(own, alone.value(quantity), "{name}: {quantity:?} moves with the nominal");
                let Some(own) = own else {
                    assert!(!measures.findings.is_empty(), "{name}: no {quantity:?}");
                    continue;
                };
                compared += 1;
                let is_named = measures
                    .findings
                    .iter()
                    .any(|finding| finding.contains("the file states") && finding.contains(quantity.key()));
                named += usize::from(is_named);
                assert_eq!((own - value).abs() > MOST, is_named, "{name}: {quantity:?} {own} {value}");
            }
        }
    }
    println!("{compared} values compared, {named} differences named, {unread} readings refused");
    assert!(compared >= 24 && named > 0);
    Ok(())
}
