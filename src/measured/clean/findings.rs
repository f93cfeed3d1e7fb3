//! Checks measured points in profile axes, from left to right.

use super::checks::{Check, Finding, distance, duplicates, median};
use super::loops;
use super::order::folds;
use super::runs::Path;
use crate::measured::read::points::Point;
use crate::measured::shape::{gauge_depth, has_flange_back};
use crate::profile::Side;

/// Least length of a gap, as a multiple of the median distance of neighbours. A gap is also at least [`GAP`] long.
const GAP_RATIO: f64 = 10.0;
/// Least length of a gap \[mm\]: the length of a contact patch.
const GAP: f64 = 5.0;

/// Finds all faults, in the order of [`Check`].
pub fn findings(points: &[Point], side: Side, gauge_height: f64) -> Vec<Finding> {
    let path = Path::of(points);
    let sound = &path.sound;
    let mut out = Vec::new();
    let found = |k: usize| format!("the same place as {}", sound[k - 1].place());
    out.extend(duplicates(sound).map(|k| Finding::new(Check::Duplicate, &sound[k], found(k))));
    out.extend(folds(&path).iter().map(|fold| fold.finding(points)));
    out.extend(path.runs.iter().map(|run| run.finding(points)));
    // A path that runs back crosses itself everywhere: beside a fatal finding, crossings are not sought.
    if !out.iter().any(|finding| finding.fatal) {
        out.extend(crossings(&path.course.at));
    }
    out.extend(gaps(sound).into_iter().map(|(k, step)| {
        let found = format!("no point over {step:.2} mm up to {}", sound[k + 1].place());
        Finding::new(Check::Gap, &sound[k], found)
    }));
    out.extend(missing_side_face(&path.course.at, side, gauge_height));
    out
}

fn crossings(points: &[Point]) -> Vec<Finding> {
    let found = loops::crossings(points);
    let crossing = |[a, b]: &[usize; 2]| {
        let found = format!("a loop: the curve crosses itself before {}", points[b + 1].place());
        Finding::new(Check::Loop, &points[*a], found)
    };
    let mut out: Vec<Finding> = found.edges.iter().map(crossing).collect();
    if let (Some(first), true) = (points.first(), found.cut_short) {
        let text = "too tangled a path to be searched for loops to its end: there may be some";
        out.push(Finding { fatal: false, ..Finding::new(Check::Loop, first, text) });
    }
    out
}

/// Returns the indices of points after which a long stretch has no points, and its lengths \[mm\].
fn gaps(points: &[Point]) -> Vec<(usize, f64)> {
    let steps: Vec<f64> = points.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
    let least = GAP.max(GAP_RATIO * median(steps.clone()));
    steps.into_iter().enumerate().filter(|(_, step)| *step > least).collect()
}

fn missing_side_face(points: &[Point], side: Side, gauge_height: f64) -> Option<Finding> {
    let first = points.first()?;
    let found = match side {
        Side::Wheel if has_flange_back(points) => return None,
        Side::Wheel => "no back of the flange".to_owned(),
        Side::Rail => {
            let depth = gauge_depth(points);
            if depth >= gauge_height {
                return None;
            }
            format!("a gauge face measured down to {depth:.1} of {gauge_height} mm below the top")
        }
    };
    Some(Finding::new(Check::MissingSideFace, first, found))
}
