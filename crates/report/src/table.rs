//! Writes the tables of the report: CSV for programs, Markdown for people.

use std::fmt::Write;

use super::conformal::GapScene;
use super::hard_case::METHODS;
use super::hard_run::HardOutcome;
use super::measurements::{AccuracyRow, Growth};
use super::practice::PracticeRow;
use super::rates::Rate;
use super::verification::Verified;
use super::whole_case::{PARTS, WholeCase};
use wheelrail_check::Floor;

/// Returns accuracy.csv. Lengths are in mm, times in s. The largest errors are NaN if a method misses a
/// surface, or finds one where there is none.
pub fn accuracy_csv(rows: &[AccuracyRow]) -> String {
    let mut out = String::from(
        "scene,method,tolerance_mm,points,seconds,mpoints_per_s,max_abs_error_mm,max_rel_error,q99_rel_error,\
         worst_xi,worst_eta\n",
    );
    for row in rows {
        let tolerance = row.tolerance.map_or(String::new(), |t| format!("{t:e}"));
        let errors = row.errors.map_or_else(
            || ",,,,".to_string(),
            |e| {
                let [xi, eta] = e.worst;
                format!("{:.4e},{:.4e},{:.4e},{xi},{eta}", e.max_abs, e.max_rel, e.q99_rel)
            },
        );
        let (points, seconds, rate) = (row.points(), row.timing.best, row.rate());
        let _ = writeln!(
            out,
            "{},{},{tolerance},{points},{seconds:.4e},{rate:.1},{errors}",
            row.scene, row.method
        );
    }
    out
}

/// Returns hard_cases.csv: for each case and method the errors where there is a value, and the number of
/// points that wrongly have a value or have none.
pub fn hard_cases_csv(outcomes: &[HardOutcome]) -> String {
    let mut out = String::from(
        "case,title,status,as_stated,method,points,wrongly_masked,max_abs_error_mm,max_rel_error,failed_checks,\
         report_newton_remark,provenance\n",
    );
    for outcome in outcomes {
        let case = &outcome.case;
        let failed: Vec<&str> = outcome.failures().map(|check| check.what.as_str()).collect();
        for (method, e) in METHODS.iter().zip(&outcome.errors) {
            let _ = writeln!(
                out,
                "{},{},{},{},{},{},{},{:.4e},{:.4e},{},{},{}",
                case.reference.name,
                quoted(&case.title),
                case.status.name(),
                outcome.as_stated(),
                method.name(),
                outcome.points,
                e.wrongly_masked,
                e.max_abs,
                e.max_rel,
                quoted(&failed.join("; ")),
                quoted(&case.report_newton.remark),
                quoted(&case.provenance),
            );
        }
    }
    out
}

/// Returns practice.csv: for each case its largest difference from brute force, and what disagrees.
pub fn practice_csv(rows: &[PracticeRow]) -> String {
    let mut out =
        String::from("case,places,largest_difference_mm,largest_area_difference,disagreements,what\n");
    for row in rows {
        let PracticeRow { name, what, figure, contacts, area, failures } = row;
        let (failures, what) = (quoted(&failures.join("; ")), quoted(what));
        let _ = writeln!(out, "{name},{contacts},{figure:.4e},{area:.4e},{failures},{what}");
    }
    out
}

/// Returns verification.csv: the results of parry3d's meshes, one row for each placed pair; lengths in mm.
pub fn verification_csv(groups: &[Vec<Verified>]) -> String {
    let mut out = String::from(
        "pair,agrees,points,compared,max_mm,q99_mm,median_mm,worst_xi,worst_eta,bracket_mm,outside_bracket,\
         max_normal,relation_mm,order,floor_rays_mm,floor_closest_mm\n",
    );
    for Verified { name, report } in groups.iter().flatten() {
        let s = &report.separation;
        let [xi, eta] = s.worst_at_mm;
        let floor = |figure: fn(&Floor) -> f64| report.floors.iter().map(figure).fold(0.0, f64::max);
        let _ = writeln!(
            out,
            "{},{},{},{},{:.2e},{:.2e},{:.2e},{xi},{eta},{:.2e},{},{:.2e},{:.2e},{:.3},{:.2e},{:.2e}",
            quoted(name),
            report.agrees,
            report.counts.points,
            report.counts.compared,
            s.max,
            s.p99,
            s.median,
            report.bracket_mm,
            report.outside_bracket,
            report.normals.max,
            report.distances.violation.max,
            report.orders.median,
            floor(|f| f.ray_mm),
            floor(|f| f.closest_mm),
        );
    }
    out
}

/// Returns normal_gap.csv: errors of t against 60-digit values, times, and the check by closest distances; one row for each
/// scene and grid.
pub fn normal_gap_csv(scenes: &[GapScene]) -> String {
    let mut out = String::from(
        "scene,skewed,points_relative_error,points_error_mm,grid_relative_error,grid_error_mm,wrongly_masked,side,seconds,\
         seconds_of_s,checked_points,distance_beyond_mm,agrees\n",
    );
    for GapScene { name, skewed, errors: [points, grid], costs, check } in scenes {
        for cost in costs {
            let _ = writeln!(
                out,
                "{name},{skewed},{:.4e},{:.4e},{:.4e},{:.4e},{},{},{:.4e},{:.4e},{},{:.2e},{}",
                points.relative,
                points.absolute,
                grid.relative,
                grid.absolute,
                points.wrongly_masked + grid.wrongly_masked,
                cost.side,
                cost.normal_gap,
                cost.separation,
                check.points,
                check.beyond_mm,
                check.agrees,
            );
        }
    }
    out
}

/// Returns scaling.csv.
pub fn growth_csv(rows: &[Growth]) -> String {
    let mut out = String::from("points,spectral_seconds,store_seconds\n");
    for row in rows {
        let _ = writeln!(out, "{},{:.4e},{:.4e}", row.points, row.spectral, row.store);
    }
    out
}

/// Returns positions.csv: rates of sweeps, with the table of conicity.
pub fn positions_csv(rows: &[Rate]) -> String {
    let mut out = String::from(
        "pair,measured,motion,positions,with_contact,seconds,positions_per_s,conicity_seconds,conicity_searches,\
         conicity_error\n",
    );
    for row in rows {
        let [positions, found] = row.positions;
        let _ = writeln!(
            out,
            "{},{},{},{positions},{found},{:.4e},{:.0},{:.4e},{},{:.1e}",
            quoted(&row.pair),
            row.measured,
            quoted(row.motion.name()),
            row.seconds,
            row.rate(),
            row.table_seconds,
            row.searches,
            row.conicity_error
        );
    }
    out
}

/// Returns cases.csv: times of whole cases, part by part \[s\].
pub fn cases_csv(rows: &[WholeCase]) -> String {
    let mut out = format!("pair,points,{}_s,total_s\n", PARTS.join("_s,"));
    for row in rows {
        let seconds: Vec<String> =
            row.seconds.iter().chain([&row.total()]).map(|seconds| format!("{seconds:.3e}")).collect();
        let _ = writeln!(out, "{},{},{}", row.pair, row.side * row.side, seconds.join(","));
    }
    out
}

/// Returns a cell of a CSV file in quotes.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// Returns a Markdown table; columns after the first `left` are aligned to the right.
pub fn markdown(head: &[&str], left: usize, rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut out = line(&head.iter().map(ToString::to_string).collect::<Vec<_>>());
    let rule: Vec<String> =
        (0..head.len()).map(|k| if k < left { "---" } else { "---:" }.to_string()).collect();
    out += &line(&rule);
    for row in rows {
        out += &line(row);
    }
    out
}
