//! Measures the cost of a grid over measured profiles: splines through points of 60E1 and S1002 against
//! chains of arcs.

use super::inclined::RADIUS;
use super::speed::{LEAST_RUNS, RaceTrack, TimedWork, Timing, race};
use wheelrail::error::Result;
use wheelrail::measured::{self, CurveKind, Format, Options, write};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Profile, Side, standards};
use wheelrail::separation::{FULL_PRECISION, plan};

/// Distances of the points through which splines are drawn \[mm\].
const SPACINGS: [f64; 3] = [0.1, 0.5, 1.0];
/// Distance of the points through which arcs are drawn, within the default tolerance \[mm\]. The drawn S1002
/// is made of polynomials, and would be no chain of arcs.
const ARC_SPACING: f64 = 0.5;

/// Abscissa of the contact on both profiles \[mm\].
const CONTACT: f64 = -3.0;
/// Half widths of the window \[mm\].
const HALF_WIDTHS: [f64; 2] = [12.0, 10.0];

/// The times of one grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SplineCost {
    /// Number n of the n × n grid.
    pub side: usize,
    /// Distance of the points \[mm\].
    pub spacing: f64,
    /// Best time over splines and over arcs \[s\].
    pub seconds: [f64; 2],
    /// Best time over splines with the choice of the method \[s\].
    pub with_plan: f64,
}

impl SplineCost {
    /// Returns the time a point over splines, with the choice of the method \[ns\].
    pub fn nanoseconds(&self) -> f64 {
        1e9 * self.with_plan / (self.side * self.side) as f64
    }
}

/// Times grids with n × n points for every n, each contestant for at least `seconds`, on one thread.
///
/// # Errors
/// Built-in profiles that cannot be fitted or placed, which is a fault of this program.
pub fn spline_costs(sides: &[usize], seconds: f64) -> Result<Vec<SplineCost>> {
    let arcs = fitted(CurveKind::Arcs, ARC_SPACING)?;
    let mut costs = Vec::new();
    for &side in sides {
        for spacing in SPACINGS {
            let splines = fitted(CurveKind::Smoothing, spacing)?;
            let pair = [&splines, &arcs];
            let mut tracks = pair.map(|placement| {
                let [xi, eta] = HALF_WIDTHS;
                RaceTrack::new(placement, [-xi, xi], eta, side)
            });
            let works = [0, 1].map(|k| {
                let (xi, axis) = (tracks[k].xi(), tracks[k].axis());
                TimedWork::Fill(plan(pair[k], xi, axis, FULL_PRECISION, None).choice)
            });
            let mut timings = [Timing::NONE; 3];
            race(&mut timings, seconds, LEAST_RUNS, |k| match k {
                0 | 1 => tracks[k].timed(works[k]),
                _ => tracks[0].timed(TimedWork::PlanAndFill),
            });
            let [splines, arcs, with_plan] = timings.map(|timing| timing.best);
            costs.push(SplineCost { side, spacing, seconds: [splines, arcs], with_plan });
        }
    }
    Ok(costs)
}

/// Places the pair through points of the drawings.
fn fitted(curve: CurveKind, spacing: f64) -> Result<Placement> {
    let profile = |drawn: &Profile, side: Side| -> Result<Profile> {
        let text = write::points(&write::sample(drawn, spacing)?, Format::Csv, side, "sample");
        let options =
            Options { mirror: Some(false), flip_z: Some(false), curve: Some(curve), ..Options::default() };
        measured::profile("sample.csv", text.as_bytes(), side, &options).map(|measured| measured.profile)
    };
    let rail = profile(&standards::rail("60E1")?, Side::Rail)?;
    let wheel = profile(&standards::wheel("S1002")?, Side::Wheel)?;
    Pair::new(rail, wheel, RADIUS)?.placed(CONTACT, CONTACT, 0.0)
}
