//! The ratios that the project asks of itself, and whether a run met them.

use super::measurements::{Growth, Measurements, Row, median};
use super::spline_cost::SplineCost;
use crate::separation::grid::Method;
use crate::separation::plan::FULL_PRECISION;

/// Rate of spectral columns at full precision over the Report's Newton.
const OVER_REPORT: f64 = 20.0;
/// … and over a plain store of the same array.
const OVER_STORE: f64 = 0.5;
/// Rate on two threads over that on one.
const TWO_THREADS: f64 = 1.6;
/// Time of a grid over measured profiles over that over chains of arcs.
const SPLINES_OVER_ARCS: f64 = 2.0;
/// How far d log time/d log points may be from 1 where growth counts as linear: a factor of 1.6 over four decades.
const LINEAR: f64 = 0.05;

/// One requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirement {
    /// What is compared.
    pub what: String,
    /// What is asked for.
    pub least: String,
    /// What was found.
    pub found: String,
    /// Where, and what lies around it.
    pub remark: String,
    /// Whether it is met.
    pub met: bool,
}

/// All of them.
pub fn all(m: &Measurements) -> Vec<Requirement> {
    let mut sides: Vec<usize> = m.rows.iter().map(|row| row.side).collect();
    sides.sort_unstable();
    sides.dedup();
    let mut out = Vec::new();
    for side in sides {
        for (other, least) in [("report-newton", OVER_REPORT), ("store", OVER_STORE)] {
            out.extend(ratio(m, side, other, least));
        }
    }
    out.extend(linear(m));
    out.extend(m.threads.iter().filter(|row| row.method == Method::Spectral).map(|row| {
        let ratio = row.seconds[0] / row.seconds[1];
        Requirement {
            what: "2 threads over 1 thread, the same bits".into(),
            least: format!("{TWO_THREADS}"),
            found: format!("{ratio:.2}"),
            remark: format!("{} points", row.points),
            met: ratio >= TWO_THREADS && row.same_bits,
        }
    }));
    out.extend(splines(m));
    out
}

/// The dearest grid decides.
fn splines(m: &Measurements) -> Option<Requirement> {
    let ratio = |cost: &SplineCost| cost.seconds[0] / cost.seconds[1];
    let worst = m.splines.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
    Some(Requirement {
        what: "time of a grid over splines, over that over arcs".into(),
        least: format!("at most {SPLINES_OVER_ARCS}"),
        found: format!("{:.2}", ratio(worst)),
        remark: format!("points every {} mm, {1} × {1}", worst.spacing, worst.side),
        met: ratio(worst) <= SPLINES_OVER_ARCS,
    })
}

/// Rate of a method over that of another, scene by scene.
pub(super) fn ratios<'m>(
    m: &'m Measurements,
    (method, tolerance): (&'m str, Option<f64>),
    other: &'m str,
    side: usize,
) -> impl Iterator<Item = (&'m str, f64)> {
    let at = move |row: &&Row, name: &str| row.method == name && row.side == side;
    let mine = m.rows.iter().filter(move |row| at(row, method) && row.tolerance == tolerance);
    mine.filter_map(move |row| {
        let other = m.rows.iter().find(|o| at(o, other) && o.scene == row.scene)?;
        Some((row.scene.as_str(), row.rate() / other.rate()))
    })
}

/// The least ratio over the scenes decides.
fn ratio(m: &Measurements, side: usize, other: &str, least: f64) -> Option<Requirement> {
    let all = || ratios(m, (Method::Spectral.name(), Some(FULL_PRECISION)), other, side);
    let (scene, smallest) = all().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let middle = median(all().map(|(_, ratio)| ratio));
    let met = all().filter(|(_, ratio)| *ratio >= least).count();
    Some(Requirement {
        what: format!("spectral over {other}, {side} × {side}"),
        least: format!("{least}"),
        found: format!("{smallest:.2}"),
        remark: format!("{scene}; median {middle:.2}; {met} of {} scenes", all().count()),
        met: smallest >= least,
    })
}

/// The store's exponent beside: what it takes more where its array outgrows the caches is no growth of a computation.
fn linear(m: &Measurements) -> Option<Requirement> {
    let (first, last) = (m.growth.first()?, m.growth.last()?);
    let (spectral, store) = (exponent(m, |row| row.spectral), exponent(m, |row| row.store));
    let per_point = |row: &Growth| row.spectral / row.points as f64 * 1e9;
    Some(Requirement {
        what: format!("cost over points, {:.0e} to {:.0e}", first.points as f64, last.points as f64),
        least: format!("exponent 1 ± {LINEAR}"),
        found: format!("{spectral:.3}"),
        remark: format!(
            "store {store:.3}; {:.2} ns a point at first, {:.2} at last",
            per_point(first),
            per_point(last)
        ),
        met: (spectral - 1.0).abs() <= LINEAR,
    })
}

/// Slope of log time over log points by least squares.
fn exponent(m: &Measurements, seconds: impl Fn(&Growth) -> f64) -> f64 {
    let points: Vec<[f64; 2]> =
        m.growth.iter().map(|row| [(row.points as f64).ln(), seconds(row).ln()]).collect();
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let moment = |k: usize| points.iter().map(|p| (p[0] - mean[0]) * (p[k] - mean[k])).sum::<f64>();
    moment(1) / moment(0)
}
