//! Approaches under a load and pressures against Tamaas, which solves the same regions.

use crate::programs::{folder, output_of};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use wheelrail::case::{AskedPressure, PartPressure};
use wheelrail::export::array_npy;
use wheelrail::load::{Elastic, effective_modulus};
use wheelrail::mesh::{GridGroup, groups};
use wheelrail::separation::Evaluator;
use wheelrail::{Interval, Window};
use wheelrail_report::loads::{CarriedRegion, Solved, carried};

/// The page that holds the table.
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../src/docs/loads.md");

/// The data of the report, which has what Tamaas solves.
const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../report/data/loads.csv");

/// Where this is set, Tamaas finds the pressures of all regions anew, which takes minutes, and not only of every eighth one.
const ALL: &str = "WHEELRAIL_ALL_PRESSURES";

/// Largest relative error of δ that a region has alone.
const BOUND: f64 = 5e-3;

/// Bounds of the largest pressure, the true contact area and the load of pressures over the automatic grid, relative.
const PRESSURE_BOUNDS: [f64; 3] = [0.01, 0.005, 2.5e-3];

/// Largest relative differences of the data from what Tamaas finds: of δ and pressures, and of areas, of which a cell on the edge is 1e-4.
const SAME: [f64; 2] = [1e-4, 1e-3];

/// Writes s of a region on cells so many times as fine as those of the automatic grid, over it or over a box \[mm\].
fn write_grid(dir: &Path, region: &CarriedRegion, finer: f64, within: Option<Window>) {
    let contact = &region.site.contact;
    let group = &groups(contact.whole_patch().unwrap(), 0.0, None)[0];
    let spacing = group.axes(None).unwrap().spacing.map(|step| step / finer);
    let extent = within.unwrap_or(group.extent);
    let axes = GridGroup { extent, ..group.clone() }.axes(Some(spacing)).unwrap();
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

/// Lets Tamaas solve all regions of a folder, by their numbers.
fn solve(dir: &Path) -> Option<BTreeMap<usize, Solved>> {
    let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
    let lines = output_of("load_table.py", dir, &[&format!("{modulus:?}")])?;
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
        let [number, approach, peak, area] = numbers[..] else { panic!("{line}") };
        (number as usize, Solved { peak, approach, area })
    };
    Some(lines.lines().map(row).collect())
}

/// Gives the box \[mm\] around the edges of contact.
fn extent(pressure: &PartPressure) -> Window {
    let side = |axis: usize| Interval::around(pressure.outline.iter().flatten().map(|point| point[axis]));
    Window { xi: side(0), eta: side(1) }
}

/// The data as it should be, and the rows of the table.
fn texts(regions: &[CarriedRegion]) -> [String; 2] {
    let mut data =
        String::from("pair,offset_mm,yaw_rad,load_n,contact,normal_load_n,approach_mm,peak_mpa,area_mm2\n");
    let mut table = String::new();
    for region in regions {
        let (loaded, site) = (region.loaded, &region.site);
        let (Solved { peak, approach, area }, normal) = (region.solved, site.normal_load.unwrap());
        let _ =
            writeln!(data, "{},{normal:.1},{approach:.7},{peak:.3},{area:.4}", loaded.key(region.contact()));
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
            (1000.0 * region.compared().error).round() / 10.0 + 0.0,
        );
    }
    [data, table]
}

/// Compares the data with what Tamaas finds, and puts that in their place.
fn differing(
    regions: &mut [CarriedRegion],
    solved: &BTreeMap<usize, Solved>,
    of: fn(&mut Solved) -> &mut f64,
    most: f64,
) -> Vec<String> {
    let mut wrong = Vec::new();
    for (number, mut found) in solved.clone() {
        let region = &mut regions[number];
        let (known, found) = (of(&mut region.solved), *of(&mut found));
        let same = (*known / found - 1.0).abs() < most;
        *known = found;
        if !same {
            wrong.push(region.loaded.key(region.contact()));
        }
    }
    wrong
}

#[test]
fn approaches_and_pressures_under_load_are_those_of_tamaas() {
    let (mut regions, dir) = (carried().unwrap(), folder("loads"));
    let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
    let asked = AskedPressure { cell: None };
    let pressures: Vec<PartPressure> =
        regions.iter().map(|region| PartPressure::over_grid(&region.site, asked, modulus).unwrap()).collect();
    let _ = std::fs::remove_dir_all(&dir);
    let chosen = if std::env::var(ALL).is_ok() { 1 } else { 8 };
    for (number, region) in regions.iter().enumerate() {
        write_grid(&dir.join(format!("thirds/{number:03}")), region, 3.0, None);
        if number % chosen == 0 {
            let within = Some(extent(&pressures[number]));
            write_grid(&dir.join(format!("ninths/{number:03}")), region, 9.0, within);
        }
    }
    let Some(thirds) = solve(&dir.join("thirds")) else { return };
    let Some(ninths) = solve(&dir.join("ninths")) else { return };
    let mut wrong = differing(&mut regions, &thirds, |solved| &mut solved.approach, SAME[0]);
    wrong.extend(differing(&mut regions, &ninths, |solved| &mut solved.peak, SAME[0]));
    wrong.extend(differing(&mut regions, &ninths, |solved| &mut solved.area, SAME[1]));
    let [data, table] = texts(&regions);
    std::fs::write(dir.join("loads.csv"), &data).unwrap();
    std::fs::write(dir.join("loads.md"), &table).unwrap();
    assert!(
        wrong.is_empty(),
        "{DATA} differs ({wrong:?}); put that of {} there, made with {ALL}=1",
        dir.display()
    );
    for (region, found) in regions.iter().zip(&pressures) {
        let (key, solved) = (region.loaded.key(region.contact()), region.solved);
        let error = region.compared().error;
        assert!(error.abs() <= BOUND, "{key}: {} is not {}", region.own_approach(), solved.approach);
        let found = [found.largest.pressure_n_per_mm2, found.contact_area, found.load];
        let expected = [solved.peak, solved.area, region.site.normal_load.unwrap()];
        let errors = [0, 1, 2].map(|k| found[k] / expected[k] - 1.0);
        assert!(
            errors.iter().zip(PRESSURE_BOUNDS).all(|(error, bound)| error.abs() <= bound),
            "{key}: {errors:?}"
        );
    }
    let docs = std::fs::read_to_string(DOCS).unwrap();
    assert!(docs.contains(&table), "{DOCS} has another table; put that of {} there", dir.display());
}
