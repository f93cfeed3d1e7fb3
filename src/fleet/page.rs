//! Writes what a fleet is read for: the table, the summary, the page, and pages of the worst pairs.

use serde_json::json;

use super::listed::{Listed, Pairs};
use super::pair::{self, FleetRow, numbers, wheelset};
use super::part::{self, FleetPart};
use super::profiles::Shelf;
use super::tally::{FleetTally, WorstPair, by_names, rails};
use crate::case::{Case, DoubtSet, SweepColumns, about_bodies, polyline, sweep_page};
use crate::error::{Error, Result};
use crate::export::{FleetPage, FleetWorst, PageProfile, SEPARATOR};
use crate::files::{KeptFolder, NewFile};
use crate::scene;
use crate::search::{Conicity, ONE_CONTACT, ParallelSweep, Position, Selection};

/// Folder of the pages of the worst pairs.
pub(super) const WORST: &str = "worst";

/// Columns of a row before its numbers.
const NAMES: [&str; 7] =
    ["wheelset", "left", "right", "rail_left", "rail_right", "radius_left_mm", "radius_right_mm"];

/// Positions of a worst pair's page to either side, and their distance \[mm\].
const DRAWN: i32 = 80;
const STEP: f64 = 0.1;

/// Writes the table, the summary and the page from the parts, and the pages of the worst pairs from their profiles. Returns the number of
/// pairs, of those with a conicity and of those with a finding.
///
/// # Errors
/// A part, or a profile of a worst pair, that cannot be read; any error of the disk.
pub(super) fn write(
    fleet: &Listed,
    folder: &KeptFolder,
    parts: &KeptFolder,
    split: &[Pairs],
) -> Result<(usize, usize, usize)> {
    let mut table = NewFile::create(&folder.file("fleet.csv"))?;
    let mut tally = FleetTally::default();
    let names = numbers();
    let head = NAMES.into_iter().chain(names.iter().map(String::as_str)).chain(["finding", "doubt"]);
    table.put(&csv(std::iter::once(head.map(String::from).collect()))?)?;
    for (number, pairs) in split.iter().enumerate() {
        let part = FleetPart::read(&parts.file(&part::name(number)))?;
        table.put(&csv(part.rows.iter().map(cells))?)?;
        tally.add(&part, pairs.all());
    }
    table.commit()?;
    let rail = worst_pages(fleet, &folder.part(WORST)?, &tally.worst)?;
    let title = fleet.scene.title.as_deref().unwrap_or("Fleet");
    folder.write("fleet.html", &page(fleet, title, &tally, rail).html())?;
    folder.write("summary.json", format!("{:#}\n", summary(fleet, title, &tally)).as_bytes())?;
    Ok((tally.pairs, tally.with_conicity, tally.with_finding))
}

/// Writes rows as CSV.
fn csv(rows: impl Iterator<Item = Vec<String>>) -> Result<Vec<u8>> {
    let failed = |error: &dyn std::fmt::Display| {
        Error::new("fleet.csv", error.to_string(), "rows", "report this as a fault of wheelrail")
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(&row).map_err(|error| failed(&error))?;
    }
    writer.into_inner().map_err(|error| failed(&error))
}

fn cells(row: &FleetRow) -> Vec<String> {
    let number = |value: &Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let numbers = row.radii.iter().chain(&row.values).map(number);
    row.names.iter().cloned().chain(numbers).chain([row.finding.clone(), row.doubt.clone()]).collect()
}

fn summary(fleet: &Listed, title: &str, tally: &FleetTally) -> serde_json::Value {
    let worst = tally.worst.iter().enumerate().map(|(k, pair)| {
        json!({ "wheelset": pair.row.names[0], "rails": rails(&pair.row), "conicity": pair.conicity, "page": page_name(k) })
    });
    json!({
        "program": "wheelrail",
        "version": env!("CARGO_PKG_VERSION"),
        "title": title,
        "wheelsets": fleet.wheelsets.len(),
        "sections": fleet.sections.len(),
        "pairs": tally.pairs,
        "pairs_with_conicity": tally.with_conicity,
        "pairs_with_finding": tally.with_finding,
        "distributions": tally.summary(),
        "worst": worst.collect::<Vec<_>>(),
    })
}

fn page_name(k: usize) -> String {
    format!("{WORST}/{}", worst_name(k))
}

fn worst_name(k: usize) -> String {
    format!("worst-{:02}.html", k + 1)
}

fn page(fleet: &Listed, title: &str, tally: &FleetTally, rail: Option<PageProfile>) -> FleetPage {
    let names = numbers();
    let value = |row: &FleetRow, name: &str| {
        let value = names.iter().position(|own| own == name).and_then(|k| row.values[k]);
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"))
    };
    let shown = [
        "conicity",
        "nonlinearity_per_mm",
        "right_flange_height_mm",
        "right_flange_thickness_mm",
        "right_hollow_mm",
    ];
    let worst = tally.worst.iter().enumerate().map(|(k, WorstPair { row, .. })| FleetWorst {
        cells: [row.names[0].clone(), by_names(row, &rails(row))]
            .into_iter()
            .chain(shown.map(|name| value(row, name)))
            .collect(),
        page: page_name(k),
    });
    let columns = [
        "wheelset",
        "rails",
        "conicity",
        "nonlinearity [1/mm]",
        "right Sh [mm]",
        "right Sd [mm]",
        "right hollow [mm]",
    ];
    let counted = |n: usize, thing: &str| format!("{n} {thing}{}", if n == 1 { "" } else { "s" });
    let about = [
        about_bodies(&scene::echo(&fleet.scene, title).scene),
        [
            counted(fleet.wheelsets.len(), "wheelset"),
            counted(fleet.sections.len(), "rail section"),
            counted(tally.pairs, "pair"),
        ]
        .join(", "),
        format!("{} with a conicity", tally.with_conicity),
        format!("{} with a finding", tally.with_finding),
    ];
    FleetPage {
        title: title.into(),
        about: about.join(SEPARATOR),
        version: env!("CARGO_PKG_VERSION").into(),
        distributions: tally.distributions(),
        heat: tally.heat().map(|heat| crate::export::FleetHeat { rail, ..heat }),
        columns: columns.map(String::from).into(),
        worst: worst.collect(),
        findings: tally.findings.clone(),
        with_finding: tally.with_finding,
    }
}

/// Writes the pages of the worst pairs, and returns the outline of the first one's right-hand rail.
fn worst_pages(fleet: &Listed, folder: &KeptFolder, worst: &[WorstPair]) -> Result<Option<PageProfile>> {
    let (mut shelf, mut rail) = (Shelf::default(), None);
    for (k, pair) in worst.iter().enumerate() {
        let (wheelset, section) = (pair.number.wheelset, pair.number.section);
        shelf.fill(fleet, &Pairs { wheelsets: wheelset..wheelset + 1, sections: section..section + 1 });
        let case = pair::case(fleet, &shelf, pair.number)?;
        folder.write(&worst_name(k), &swept(&case, pair)?)?;
        rail.get_or_insert_with(|| polyline(case.profiles().right.pair.rail()));
    }
    folder.remove(|name| !(0..worst.len()).any(|k| worst_name(k) == name))?;
    Ok(rail)
}

/// Returns the page of a pair's sweep.
fn swept(case: &Case, pair: &WorstPair) -> Result<Vec<u8>> {
    let (system, template) = wheelset(case)?;
    let lateral: Vec<f64> = (-DRAWN..=DRAWN).map(|k| STEP * f64::from(k)).collect();
    let positions: Vec<Position> = lateral.iter().map(|&lateral| Position { lateral, ..template }).collect();
    let conicity = Conicity::new(system, STEP * f64::from(DRAWN), template.roll)?;
    let selection = Selection { within: 0.0, apart: ONE_CONTACT };
    let sweep = ParallelSweep { system, selection, conicity: Some(&conicity), positions: &positions };
    let mut columns = SweepColumns::default();
    sweep.blocks(
        |chunk: &mut SweepColumns, number, rows| {
            rows.iter().for_each(|row| chunk.push(number, row, None, DoubtSet::default()));
            Ok(())
        },
        |_, chunks: Vec<SweepColumns>| {
            chunks.iter().for_each(|chunk| columns.extend(chunk));
            Ok(true)
        },
    )?;
    let about = format!("wheelset {}", pair.row.names[0]);
    Ok(sweep_page(case, system, &columns, &lateral, &about)?.html())
}
