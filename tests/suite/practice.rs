//! Whole cases as engineers have them, checked against brute force: `crates/report/src/practice/cases.toml`.

use wheelrail_report::practice::{PracticeCase, cases, run};

/// Runs the cases whose names begin so, prints their rows, and fails with all that disagrees.
fn agree(names: &[&str]) {
    let all = cases().expect("the table of cases");
    let chosen: Vec<&PracticeCase> =
        all.iter().filter(|case| names.iter().any(|name| case.name.starts_with(name))).collect();
    assert!(chosen.len() >= names.len(), "no case for one of {names:?}");
    let mut failed = Vec::new();
    for case in chosen {
        let row = run(case);
        println!("{:<24} {:9.2e} mm, area {:9.2e}, {} places", row.name, row.figure, row.area, row.contacts);
        row.failures.iter().for_each(|failure| println!("    {failure}"));
        failed.extend(row.failures.iter().map(|failure| format!("{}: {failure}", row.name)));
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn there_are_forty_cases_each_with_a_reason_and_a_name_of_its_own() {
    let all = cases().expect("the table of cases");
    assert!(all.len() >= 40, "{}", all.len());
    let mut names: Vec<_> = all.iter().map(|case| case.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert!(names.len() == all.len() && all.iter().all(|case| !case.why.is_empty()));
}

#[test]
fn new_and_worn_measured_pairs() {
    agree(&["new-", "worn-", "pits", "coarse", "dense", "clean"]);
}

#[test]
fn full_heads_with_vertical_sides_and_lips() {
    agree(&["full-head", "lipped"]);
}

#[test]
fn grooved_rails_and_switch_blades() {
    agree(&["grooved", "blade"]);
}

#[test]
fn hollow_wheels_and_conformal_corners() {
    agree(&["hollow", "conformal", "two-point"]);
}

#[test]
fn small_and_large_wheels() {
    agree(&["small", "large"]);
}

#[test]
fn wheelsets_on_curves() {
    agree(&["wheelset"]);
}

#[test]
fn sweeps_with_their_conicity() {
    agree(&["sweep"]);
}
