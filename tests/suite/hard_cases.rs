//! Every file of `crates/report/src/hard_cases` against its 60-digit values and its status.

use crate::common::repository;
use std::collections::{BTreeMap, BTreeSet};

use wheelrail_report::hard_case::{FILES, METHODS, Status, hard_cases};
use wheelrail_report::hard_run::{self, HardOutcome};

/// A bound of which all cases together use less than this share fails as "tighten me".
const LEAST_USE: f64 = 0.25;

fn outcomes() -> Vec<HardOutcome> {
    let cases = hard_cases().expect("hard cases in their format");
    cases.iter().map(|case| hard_run::run(case, &cases).expect("a case that can be run")).collect()
}

#[test]
fn every_case_is_as_its_status_says() {
    let mut wrong = Vec::new();
    for outcome in outcomes() {
        let name = &outcome.case.reference.name;
        for (method, errors) in METHODS.iter().zip(&outcome.errors) {
            println!(
                "{name:32} {:13} {:8.1e} mm {:8.1e}  undefined {}",
                method.name(),
                errors.max_abs,
                errors.max_rel,
                errors.wrongly_masked
            );
        }
        if outcome.as_stated() {
            continue;
        }
        if outcome.case.status == Status::ExpectedFailure {
            wrong.push(format!("{name}: marked expected-failure, but every check passes: remove the mark"));
        }
        wrong.extend(outcome.failures().map(|check| {
            format!(
                "{name}: {}\n  input    {}\n  found    {}\n  expected {}",
                check.what, check.input, check.found, check.expected
            )
        }));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_bound_is_slack() {
    let mut used: BTreeMap<String, f64> = BTreeMap::new();
    for (what, share) in outcomes().into_iter().flat_map(|o| o.checks).filter_map(|check| check.share) {
        let largest = used.entry(what).or_default();
        *largest = largest.max(share);
    }
    for (what, share) in used {
        assert!(share >= LEAST_USE, "tighten {what}: {share:.2} of the bound is used");
    }
}

#[test]
fn every_file_is_embedded() {
    let folder = repository("crates/report/src/hard_cases");
    let entries = std::fs::read_dir(folder).expect("the folder of hard cases");
    let on_disk: BTreeSet<String> = entries
        .filter_map(|entry| {
            entry.ok()?.file_name().into_string().ok()?.strip_suffix(".json").map(String::from)
        })
        .collect();
    let embedded: BTreeSet<String> = FILES.iter().map(|(name, _)| (*name).to_string()).collect();
    assert_eq!(on_disk, embedded);
}
