//! A rail and a wheel over it, with the points joined at which they touch over a sweep.

use super::columns::SweepColumns;
use super::polylines::thinned;
use crate::export::JoinedPair;
use crate::placement::Pair;
use crate::profile::{Profile, points_along};

/// Distance of a profile's points \[mm\].
const STEP: f64 = 0.5;

/// Most points of a profile, and most lines between contact points: more lines would merge into one surface.
const MOST_POINTS: usize = 1000;
const MOST_LINES: usize = 80;

/// Free height between the rail and the raised wheel \[mm\].
const CLEARANCE: f64 = 12.0;

/// Makes the picture of the right-hand pair of a sweep: the lowest contact of every position joins its points on the rail and on
/// the wheel, which is raised. `gauge` is the abscissa of the gauge line in the rail profile's axes \[mm\].
pub fn joined_pair(pair: &Pair, columns: &SweepColumns, gauge: Option<f64>) -> JoinedPair {
    let polyline = |profile: &Profile, up: f64| -> Vec<[f64; 2]> {
        thinned(&points_along(profile, STEP), MOST_POINTS).iter().map(|at| [at.x, at.y + up]).collect()
    };
    let (rail, wheel) = (polyline(pair.rail(), 0.0), polyline(pair.wheel(), 0.0));
    let top = rail.iter().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
    let low = wheel.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
    let up = top - low + CLEARANCE;
    let column = |name: &str| columns.quantity(name).unwrap_or_default();
    let (rail_x, wheel_x) = (column("rail_x_mm"), column("wheel_x_mm"));
    let rows: Vec<usize> =
        (0..columns.rows()).filter(|&row| columns.right[row] && columns.contact[row] == 1).collect();
    let [rail_section, wheel_section] = pair.sections();
    let join = |row: usize| {
        let (a, b) = (rail_x[row], wheel_x[row]);
        [[a, rail_section.height(a)], [b, wheel_section.height(b) + up]]
    };
    JoinedPair {
        rail,
        wheel: polyline(pair.wheel(), up),
        lines: thinned(&rows, MOST_LINES).into_iter().map(join).collect(),
        gauge,
    }
}
