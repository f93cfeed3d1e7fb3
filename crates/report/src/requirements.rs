//! The ratios that the project requires of itself, and whether a run met them.

use super::conformal::cost::GapCost;
use super::loads::LoadCost;
use super::measurements::{AccuracyRow, Growth, Measurements, median};
use super::rates::{Freedoms, Rate};
use super::spline_cost::SplineCost;
use wheelrail::separation::{FULL_PRECISION, Method};

/// Least ratio of the rate of spectral columns at full precision to that of the Report's Newton iteration.
const OVER_REPORT: f64 = 20.0;
/// Least ratio of the rate of spectral columns at full precision to that of a plain store of the same array.
const OVER_STORE: f64 = 0.5;
/// Least ratio of the rate on two threads to that on one.
const TWO_THREADS: f64 = 1.6;
/// Largest ratio of the time of a grid over splines to that over chains of arcs.
const SPLINES_OVER_ARCS: f64 = 2.0;
/// Largest time of a point of a splined grid, with its plan \[ns\].
const SPLINED_POINT: f64 = 6.0;
/// Least positions a second on one core, as (motion, of drawn arcs, of measured pairs).
const RATES: [(Freedoms, f64, f64); 3] =
    [(Freedoms::Lateral, 1e6, 2e4), (Freedoms::Rolling, 2e5, 1e4), (Freedoms::Yawing, 1e5, 5e3)];
/// Largest ratio of the rate of drawn arcs to that of a measured pair.
const DRAWN_OVER_MEASURED: f64 = 3.0;
/// Largest time of the table of conicity to ±10 mm of a measured pair \[s\].
const CONICITY_TABLE: f64 = 0.2;
/// Largest time of `run` for a measured wheelset \[s\].
const RUN: f64 = 0.1;
/// Largest time of a whole case, by pair \[s\].
const WHOLE_CASES: [(&str, f64); 4] =
    [("drawn", 6e-5), ("measured", 1.5e-4), ("drawn, yawed", 5e-4), ("measured, yawed", 1.5e-3)];
/// Largest extra time of a load, compared with the approach that it causes \[s\], by number of regions.
const LOADS: [(usize, f64); 2] = [(1, 1e-3), (2, 3e-3)];
/// Largest time of parts of a whole case, by pair \[s\].
const CASE_PARTS: [(&str, &str, f64); 6] = [
    ("drawn", "patch", 2e-5),
    ("drawn", "mesh", 2.5e-5),
    ("measured", "patch", 6e-5),
    ("measured", "mesh", 3.5e-5),
    ("drawn, yawed", "patch", 3e-4),
    ("measured, yawed", "patch", 1e-3),
];
/// Largest ratio of the time of a plan to that of the fill.
const PLAN_OVER_FILL: f64 = 2.0;
/// Largest ratio of the time of a grid of the normal gap to that of a grid of s.
const NORMAL_GAP_OVER_S: f64 = 3.0;
/// Number n of the n × n grid on which the normal gap is judged.
const NORMAL_GAP_SIDE: usize = 200;
/// Largest distance of d log time/d log points from 1 at which growth counts as linear. It is a factor of 1.6 over four
/// decades.
const LINEAR: f64 = 0.05;

/// One requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirement {
    /// Figure that is compared.
    pub what: String,
    /// Required bound.
    pub least: String,
    /// Figure that was found.
    pub found: String,
    /// Place of the figure, and other figures beside it.
    pub remark: String,
    /// Whether the requirement is met.
    pub met: bool,
}

/// Returns all requirements.
pub fn all(m: &Measurements) -> Vec<Requirement> {
    let mut sides: Vec<usize> = m.rows.iter().map(|row| row.side).collect();
    sides.sort_unstable();
    sides.dedup();
    let mut out = Vec::new();
    for &side in &sides {
        out.extend(ratio(m, side, "report-newton", OVER_REPORT));
    }
    // A smaller grid stays in the caches, where a store is faster than memory.
    out.extend(sides.last().and_then(|&side| ratio(m, side, "store", OVER_STORE)));
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
    out.extend(splined_points(m));
    out.extend(RATES.iter().flat_map(|&(motion, drawn, measured)| rates(m, motion, [drawn, measured])));
    out.extend(conicity_table(m));
    out.extend(whole_cases(m));
    out.extend(m.load_costs.iter().filter_map(load));
    out.extend(m.processes.iter().map(|cost| {
        at_most(format!("{}, s", cost.process.name), cost.process.bound, cost.seconds, "on the wall".into())
    }));
    out.extend(normal_gap(m));
    out.extend(m.run.map(|run| {
        at_most("`run` of a measured wheelset, files not written, s", RUN, run.total(), String::new())
    }));
    out
}

/// Makes the requirement that a figure does not exceed a bound.
fn at_most(what: impl Into<String>, bound: f64, found: f64, remark: String) -> Requirement {
    let (least, met) = (format!("at most {bound}"), found <= bound);
    Requirement { what: what.into(), least, found: format!("{found:.3e}"), remark, met }
}

/// Judges the rates of drawn arcs and of the slowest measured pair, and the ratio of the two.
fn rates(m: &Measurements, motion: Freedoms, [drawn, measured]: [f64; 2]) -> Vec<Requirement> {
    let slowest = |of_measured: bool| {
        let rows = m.rates.iter().filter(|row| row.motion == motion && row.measured == of_measured);
        rows.min_by(|a, b| a.rate().total_cmp(&b.rate()))
    };
    let name = motion.name();
    let at_least = |kind: &str, row: &Rate, bound: f64| Requirement {
        what: format!("positions a second, {kind}, {name}"),
        least: format!("{bound}"),
        found: format!("{:.0}", row.rate()),
        remark: row.pair.clone(),
        met: row.rate() >= bound,
    };
    let mut out = Vec::new();
    let rows = (slowest(false), slowest(true));
    out.extend(rows.0.map(|row| at_least("drawn", row, drawn)));
    out.extend(rows.1.map(|row| at_least("measured", row, measured)));
    if let (Some(drawn), Some(measured)) = rows {
        let ratio = drawn.rate() / measured.rate();
        let what = format!("positions a second, drawn over measured, {name}");
        out.push(at_most(what, DRAWN_OVER_MEASURED, ratio, measured.pair.clone()));
    }
    out
}

/// Judges the table of conicity that takes longest, of a measured pair.
fn conicity_table(m: &Measurements) -> Option<Requirement> {
    let measured = m.rates.iter().filter(|row| row.measured);
    let worst = measured.max_by(|a, b| a.table_seconds.total_cmp(&b.table_seconds))?;
    let remark = format!("{}, {}; {} searches", worst.pair, worst.motion.name(), worst.searches);
    Some(at_most("table of conicity to ±10 mm, measured, s", CONICITY_TABLE, worst.table_seconds, remark))
}

fn whole_cases(m: &Measurements) -> Vec<Requirement> {
    let mut out = Vec::new();
    for case in &m.whole_cases {
        let (pair, side) = (case.pair, case.side);
        for (_, bound) in WHOLE_CASES.iter().filter(|(name, _)| *name == pair) {
            let what = format!("touch to mesh, {pair}, {side} × {side}, s");
            out.push(at_most(what, *bound, case.total(), String::new()));
            let what = format!("plan over fill, {pair}, {side} × {side}");
            out.push(at_most(what, PLAN_OVER_FILL, case.part("plan") / case.part("fill"), String::new()));
        }
        for (_, part, bound) in CASE_PARTS.iter().filter(|(name, ..)| *name == pair) {
            out.push(at_most(format!("{part}, {pair}, s"), *bound, case.part(part), String::new()));
        }
    }
    out
}

/// Judges the extra time of a load, compared with the approach that it causes.
fn load(cost: &LoadCost) -> Option<Requirement> {
    let (regions, bound) = LOADS.into_iter().find(|(regions, _)| *regions == cost.regions)?;
    let what = format!("load over approach, {regions} region{}, s", if regions == 1 { "" } else { "s" });
    let remark = format!("{}, {} mm", cost.loaded.pair, cost.loaded.offset);
    Some(at_most(what, bound, cost.load - cost.approach, remark))
}

/// Judges the time per point of a splined grid; the slowest grid decides.
fn splined_points(m: &Measurements) -> Option<Requirement> {
    let worst = m.splines.iter().max_by(|a, b| a.nanoseconds().total_cmp(&b.nanoseconds()))?;
    let remark = format!("points every {} mm, {1} × {1}", worst.spacing, worst.side);
    Some(at_most(
        "time of a splined grid's point, plan included, ns",
        SPLINED_POINT,
        worst.nanoseconds(),
        remark,
    ))
}

/// Judges the normal gap over s; the slowest scene decides.
fn normal_gap(m: &Measurements) -> Option<Requirement> {
    let costs = m.normal_gap.scenes.iter().flat_map(|scene| &scene.costs);
    let costs: Vec<&GapCost> = costs.filter(|cost| cost.side == NORMAL_GAP_SIDE).collect();
    let worst = costs.iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio()))?;
    let met = costs.iter().filter(|cost| cost.ratio() <= NORMAL_GAP_OVER_S).count();
    let middle = median(costs.iter().map(|cost| cost.ratio()));
    Some(Requirement {
        what: format!("time of the normal gap over that of s, {NORMAL_GAP_SIDE} × {NORMAL_GAP_SIDE}"),
        least: format!("at most {NORMAL_GAP_OVER_S}"),
        found: format!("{:.2}", worst.ratio()),
        remark: format!("{}; median {middle:.2}; {met} of {} scenes", worst.scene, costs.len()),
        met: worst.ratio() <= NORMAL_GAP_OVER_S,
    })
}

/// Judges splines over arcs; the slowest grid decides.
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

/// Returns the rate of a method over that of another, scene by scene.
pub(super) fn ratios<'m>(
    m: &'m Measurements,
    (method, tolerance): (&'m str, Option<f64>),
    other: &'m str,
    side: usize,
) -> impl Iterator<Item = (&'m str, f64)> {
    let at = move |row: &&AccuracyRow, name: &str| row.method == name && row.side == side;
    let mine = m.rows.iter().filter(move |row| at(row, method) && row.tolerance == tolerance);
    mine.filter_map(move |row| {
        let other = m.rows.iter().find(|o| at(o, other) && o.scene == row.scene)?;
        Some((row.scene.as_str(), row.rate() / other.rate()))
    })
}

/// Judges the ratio of rates; the least ratio over the scenes decides.
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

/// Judges the growth of cost, with the store's exponent beside it: the store slows down too when its array
/// outgrows the caches, which is no growth of a computation.
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

/// Returns the slope of log time over log points, by least squares.
fn exponent(m: &Measurements, seconds: impl Fn(&Growth) -> f64) -> f64 {
    let points: Vec<[f64; 2]> =
        m.growth.iter().map(|row| [(row.points as f64).ln(), seconds(row).ln()]).collect();
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let moment = |k: usize| points.iter().map(|p| (p[0] - mean[0]) * (p[k] - mean[k])).sum::<f64>();
    moment(1) / moment(0)
}
