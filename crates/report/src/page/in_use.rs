//! Builds the sections on what users wait for: positions of a wheelset, and whole cases.

use super::section::PageSection;
use crate::loads::{ApproachError, LoadCost};
use crate::measurements::Measurements;
use crate::practice::PracticeRow;
use crate::rates::{Freedoms, Rate};
use crate::table::{cases_csv, markdown, positions_csv, practice_csv};
use crate::whole_case::{PARTS, WholeCase};

/// Returns the section on positions of wheelsets a second.
pub(super) fn positions(m: &Measurements) -> PageSection {
    let body = format!("{}\n{}\nAll rows: [positions.csv](positions.csv).\n", rate_table(m), rate_note(m));
    let files = vec![("positions.csv", positions_csv(&m.rates).into_bytes())];
    PageSection { title: "Positions of a wheelset", body, files }
}

/// Returns the section on the time of a case, part by part.
pub(super) fn cases(m: &Measurements) -> PageSection {
    let body = format!("{}\n{}\nAll rows: [cases.csv](cases.csv).\n", case_table(m), case_note(m));
    let files = vec![("cases.csv", cases_csv(&m.whole_cases).into_bytes())];
    PageSection { title: "Whole cases", body, files }
}

/// Makes the section on whole cases as engineers have them, against brute force.
pub(super) fn practice(m: &Measurements) -> PageSection {
    let figure = |value: f64| if value.is_nan() { "–".into() } else { format!("{value:.1e}") };
    let row = |row: &PracticeRow| {
        let verdict = if row.failures.is_empty() { "yes" } else { "**no**" };
        let places = row.contacts.to_string();
        vec![row.name.clone(), row.what.clone(), places, figure(row.figure), figure(row.area), verdict.into()]
    };
    let rows: Vec<Vec<String>> = m.practice.iter().map(row).collect();
    let head = ["case", "what", "places", "largest difference, mm", "of the area, relative", "agrees"];
    let body = format!(
        "Contacts, heights, separations, components and rings of automatic grids against both bodies as chords of \
         0.01 mm and flood fills, which have errors of their own: up to 1e-4 mm on steep flanks, 5e-3 of an area.\n\n{}\n\
         What disagrees: [practice.csv](practice.csv).\n",
        markdown(&head, 2, &rows)
    );
    let files = vec![("practice.csv", practice_csv(&m.practice).into_bytes())];
    PageSection { title: "Practice", body, files }
}

/// Makes the section on approaches under load, against a boundary-element solver.
pub(super) fn loads(m: &Measurements) -> PageSection {
    let worst = m.loads.iter().max_by(|a, b| a.error.abs().total_cmp(&b.error.abs()));
    let worst =
        worst.map_or_else(String::new, |one| format!(" The largest error is that of {}.", one.region));
    let body = format!(
        "Errors of δ from a load, against Tamaas under the same normal force on cells three times as fine as the automatic \
         grid's: treads, flange roots, flanges, yaw, several places, drawn and worn.{worst}\n\n{}\n{}\n{COST_NOTE}",
        distribution(&m.loads),
        cost_table(&m.load_costs)
    );
    PageSection { title: "Approaches under load", body, files: Vec::new() }
}

/// Explains the table of what loads cost.
pub(super) const COST_NOTE: &str =
    "Time of all contacts of a wheel under 60 kN, and under the approach that this load causes.\n";

/// Returns the table of what loads cost.
pub(super) fn cost_table(costs: &[LoadCost]) -> String {
    let row = |cost: &LoadCost| {
        let milliseconds = |seconds: f64| format!("{:.2}", 1e3 * seconds);
        vec![
            cost.loaded.pair.to_string(),
            cost.loaded.offset.to_string(),
            cost.regions.to_string(),
            milliseconds(cost.load),
            milliseconds(cost.approach),
            milliseconds(cost.load - cost.approach),
        ]
    };
    let head = ["pair", "offset, mm", "regions", "load, ms", "approach, ms", "more, ms"];
    markdown(&head, 3, &costs.iter().map(row).collect::<Vec<_>>())
}

/// Returns the table of rates, one row per pair: rates, and the ratio of the drawn arcs' rate to each.
pub(super) fn rate_table(m: &Measurements) -> String {
    let mut head = vec!["pair".to_string()];
    for motion in Freedoms::ALL {
        head.extend([format!("{}, positions/s", motion.name()), "drawn over this".into()]);
    }
    head.extend(["conicity table, s".into(), "searches".into(), "estimated error".into()]);
    let of = |pair: &str, motion| m.rates.iter().find(|row| row.pair == pair && row.motion == motion);
    let drawn = |motion| m.rates.iter().find(|row| !row.measured && row.motion == motion);
    let mut pairs: Vec<&str> = m.rates.iter().map(|row| row.pair.as_str()).collect();
    pairs.dedup();
    let row = |pair: &str| {
        let mut cells = vec![pair.to_string()];
        for motion in Freedoms::ALL {
            let rate = of(pair, motion).map_or(f64::NAN, Rate::rate);
            let ratio = drawn(motion).map_or(f64::NAN, Rate::rate) / rate;
            cells.extend([format!("{rate:.0}"), format!("{ratio:.2}")]);
        }
        cells.extend(of(pair, Freedoms::Lateral).map_or_else(Vec::new, |row| {
            vec![
                format!("{:.4}", row.table_seconds),
                row.searches.to_string(),
                format!("{:.0e}", row.conicity_error),
            ]
        }));
        cells
    };
    let rows: Vec<Vec<String>> = pairs.into_iter().map(row).collect();
    markdown(&head.iter().map(String::as_str).collect::<Vec<_>>(), 1, &rows)
}

/// Returns the explanation of the table of rates.
pub(super) fn rate_note(m: &Measurements) -> String {
    let positions = m.rates.first().map_or(0, |row| row.positions[0]);
    format!(
        "Wheelsets on their track, {positions} positions evenly over the amplitude to both sides, the table of equivalent conicity \
         included; yaw 2 mrad a millimetre. Drawn arcs: 60E1 (1:40) and wheel A of EN 15302; worn: specimens with noise, \
         by a fixed seed, written as files and read back. The last three columns are of the table with the roll neglected.\n"
    )
}

/// Returns the table of cases, one row per case with its parts.
pub(super) fn case_table(m: &Measurements) -> String {
    let mut head = vec!["case".to_string(), "grid".into()];
    head.extend(PARTS.iter().map(|part| format!("{part}, µs")));
    head.push("total, µs".into());
    let row = |case: &WholeCase| {
        let mut cells = vec![case.pair.to_string(), format!("{0} × {0}", case.side)];
        cells.extend(
            case.seconds.iter().chain([&case.total()]).map(|seconds| format!("{:.1}", 1e6 * seconds)),
        );
        cells
    };
    let rows: Vec<Vec<String>> = m.whole_cases.iter().map(row).collect();
    markdown(&head.iter().map(String::as_str).collect::<Vec<_>>(), 2, &rows)
}

/// Returns the explanation of the table of cases.
pub(super) fn case_note(m: &Measurements) -> String {
    let mut note = "A wheel lowered onto its rail, placed at its contact, a grid planned at 1e-12 mm and filled, the patch cut out and \
                    meshed.\n"
        .to_string();
    if let Some(run) = &m.run {
        let [profiles, rest] = [run.profiles, run.rest].map(|seconds| 1e3 * seconds);
        note += &format!(
            "All that `run` computes for a measured wheelset, automatic grids of both contacts: {profiles:.1} ms for reading and \
             smoothing the profiles, {rest:.1} ms for the rest; files are not written.\n"
        );
    }
    note
}

/// Returns a table of the errors of δ: median, 90 % and largest.
fn distribution(errors: &[ApproachError]) -> String {
    let classes = [("one place", false), ("places or parts joined", true)];
    let rows = classes.map(|(name, joined)| {
        let of_class = |one: &&ApproachError| one.joined == joined;
        let mut errors: Vec<f64> =
            errors.iter().filter(of_class).map(|one| 100.0 * one.error.abs()).collect();
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * errors.len() as f64).ceil() as usize;
            errors.get(index.saturating_sub(1)).map_or_else(String::new, |error| format!("{error:.2} %"))
        };
        vec![name.into(), errors.len().to_string(), at(0.5), at(0.9), at(1.0)]
    });
    markdown(&["δ of", "regions", "median error", "90 % below", "largest"], 5, &rows)
}
