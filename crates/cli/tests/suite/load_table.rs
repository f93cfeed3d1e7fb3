//! Estimated approaches against Tamaas, which solves the same regions on cells three times as fine as the automatic grid's.

use crate::programs::{folder, output_of};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use wheelrail::case::{AskedPressure, PartPressure};
use wheelrail::export::array_npy;
use wheelrail::load::{Elastic, effective_modulus};
use wheelrail::mesh::groups;
use wheelrail::separation::Evaluator;
use wheelrail_report::loads::{Carried, carried};

/// The page that holds the table.
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../src/docs/loads.md");

/// The data of the report, which has the solved approaches.
const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../report/data/loads.csv");

/// Largest relative error of δ that a region has alone.
const BOUND: f64 = 5e-3;

/// Writes s of a region on cells three times as fine as those of the automatic grid.
fn write_grid(dir: &Path, region: &Carried) {
    let contact = &region.site.contact;
    let group = &groups(contact.whole_patch().unwrap(), 0.0, None)[0];
    let spacing = group.axes(None).unwrap().spacing.map(|step| step / 3.0);
    let axes = group.axes(Some(spacing)).unwrap();
    let mut evaluator = Evaluator::new(&contact.placement);
    let mut values = vec![0.0; axes.xi.len() * axes.eta.len()];
    for (column, xi) in values.chunks_exact_mut(axes.eta.len()).zip(&axes.xi) {
        evaluator.column(*xi, &axes.eta, column);
    }
    std::fs::create_dir_all(dir).unwrap();
    let shape = [axes.xi.len() as u64, axes.eta.len() as u64];
    let mut file = std::fs::File::create(dir.join("separation.npy")).unwrap();
    array_npy(&mut file, &shape, &values).unwrap();
    let [xi, eta] = axes.spacing;
    let load = region.site.normal_load.unwrap();
    std::fs::write(dir.join("numbers.txt"), format!("{xi:?} {eta:?} {load:?}")).unwrap();
}

/// What Tamaas found of a region: δ \[mm\], the largest pressure \[N/mm²\] and the contact area \[mm²\].
type Solved = [f64; 3];

/// Lets Tamaas solve all regions, by the name of the folder.
fn solve(dir: &Path, regions: &[Carried]) -> Option<BTreeMap<String, Solved>> {
    for (number, region) in regions.iter().enumerate() {
        write_grid(&dir.join(format!("{number:03}")), region);
    }
    let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
    let lines = output_of("load_table.py", dir, &[&format!("{modulus:?}")])?;
    let row = |line: &str| {
        let (name, numbers) = line.split_once(' ').unwrap();
        let numbers: Vec<f64> = numbers.split(' ').map(|number| number.parse().unwrap()).collect();
        (name.to_owned(), numbers.try_into().unwrap())
    };
    Some(lines.lines().map(row).collect())
}

/// The data as it should be, and the rows of the table.
fn texts(regions: &[Carried], solved: &BTreeMap<String, Solved>) -> [String; 2] {
    let (mut data, mut table) =
        (String::from("pair,offset_mm,yaw_rad,load_n,contact,normal_load_n,approach_mm\n"), String::new());
    for (number, region) in regions.iter().enumerate() {
        let (loaded, site) = (region.loaded, &region.site);
        let ([approach, ..], normal) = (solved[&format!("{number:03}")], site.normal_load.unwrap());
        let _ = writeln!(data, "{},{normal:.1},{approach:.7}", loaded.key(region.contact()));
        let error = 100.0 * (region.own_approach() / approach - 1.0);
        let places = 1 + site.contact.found.as_ref().map_or(0, |found| found.merged.len());
        let _ = writeln!(
            table,
            "| {} | {} | {} | {:.0} | {} | {:.1}° | {:.1} | {:.4} | {:.4} | {approach:.4} | {:.4} ({:+.1} %) | {places} |",
            loaded.pair,
            loaded.offset,
            loaded.yaw,
            loaded.load / 1e3,
            region.contact(),
            site.contact.placement.rail().contact_angle().to_degrees(),
            normal / 1e3,
            site.approach(),
            region.lowered(),
            region.own_approach(),
            // No minus before a zero.
            (10.0 * error).round() / 10.0 + 0.0,
        );
    }
    [data, table]
}

/// Bounds of the largest pressure, the true contact area and the load of pressures over the automatic grid, relative. Tamaas has
/// thirds of the grid's steps: where ours are ninths, its largest pressure is the rougher one, and an area counted in cells errs by
/// 1 % however it is corrected.
const PRESSURE_BOUNDS: [f64; 3] = [0.0105, 0.0121, 3e-3];

fn pressures_are_those_of_tamaas(regions: &[Carried], solved: &BTreeMap<String, Solved>) {
    let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
    for (number, region) in regions.iter().enumerate() {
        let [_, largest, area] = solved[&format!("{number:03}")];
        let found = PartPressure::over_grid(&region.site, AskedPressure { cell: None }, modulus).unwrap();
        let found = [found.largest.pressure_n_per_mm2, found.contact_area, found.load];
        let errors = [0, 1, 2].map(|k| found[k] / [largest, area, region.site.normal_load.unwrap()][k] - 1.0);
        let key = region.loaded.key(region.contact());
        assert!(
            errors.iter().zip(PRESSURE_BOUNDS).all(|(error, bound)| error.abs() <= bound),
            "{key}: {errors:?}"
        );
    }
}

#[test]
fn approaches_under_load_are_those_of_tamaas() {
    let (regions, dir) = (carried().unwrap(), folder("loads"));
    let Some(solved) = solve(&dir, &regions) else { return };
    let [data, table] = texts(&regions, &solved);
    std::fs::write(dir.join("loads.csv"), &data).unwrap();
    std::fs::write(dir.join("loads.md"), &table).unwrap();
    for (number, region) in regions.iter().enumerate() {
        let [approach, ..] = solved[&format!("{number:03}")];
        let key = region.loaded.key(region.contact());
        let error = (region.own_approach() / approach - 1.0).abs();
        assert!(error <= BOUND, "{key}: {} is not {approach}", region.own_approach());
        let known = region.solved;
        assert!(
            (known / approach - 1.0).abs() < 1e-4,
            "{key}: {DATA} has {known}; put {} there",
            dir.display()
        );
    }
    pressures_are_those_of_tamaas(&regions, &solved);
    let docs = std::fs::read_to_string(DOCS).unwrap();
    assert!(docs.contains(&table), "{DOCS} has another table; put that of {} there", dir.display());
}
