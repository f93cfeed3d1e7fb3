//! Measures everything that the report shows.

use std::time::Instant;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::conformal::{NormalGapFigures, normal_gap_figures};
use super::errors::{Errors, compare};
use super::hard_case::hard_cases;
use super::hard_run::{self, HardOutcome};
use super::loads::{self, ApproachError, CarriedRegion, LoadCost};
use super::measured;
use super::practice::{self, PracticeRow};
use super::processes::ProcessCost;
use super::rates::{Extent, Rate, rates};
use super::reference::{ReferenceFile, references};
use super::speed::{LEAST_RUNS, RaceTrack, TimedWork, Timing, race};
use super::spline_cost::{SplineCost, spline_costs};
use super::verification::{Subject, Verified, built_in_pairs, verify};
use super::whole_case::{RunCost, WholeCase, run_cost, whole_cases};
use wheelrail::error::{Error, Result};
use wheelrail::placement::Placement;
use wheelrail::separation::{FULL_PRECISION, Method, plan};

/// Tolerances \[mm\] at which spectral columns are measured.
pub const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, FULL_PRECISION];

/// The scene on which growth and threads are measured: a plain tread contact with arcs on both bodies.
const EXAMPLE: &str = "hollow_tread";

/// Factor by which the contestants of growth run longer. Runs on the largest grids take a tenth of a second, and other
/// processes disturb them most, as they wait for memory.
const GROWTH_SHARES: f64 = 4.0;

/// Number of passes over the races of the scenes. A disturbance of the machine may last for seconds.
pub const PASSES: usize = 6;

/// The amount of measuring.
#[derive(Debug, Clone, PartialEq)]
pub struct Effort {
    /// Numbers n of the n × n grids on which every method is timed.
    pub sides: Vec<usize>,
    /// Least time of each contestant of a race \[s\].
    pub seconds: f64,
    /// Numbers n of the n × n grids for the growth of cost.
    pub growth: Vec<usize>,
    /// Step in the list of built-in pairs that parry3d's meshes check: every n-th pair is checked.
    pub every_pair: usize,
    /// Step in the list of practice cases: every n-th case is run.
    pub every_case: usize,
    /// Distances of the points of the measured profiles \[mm\].
    pub spacings: Vec<f64>,
    /// Extent of the sweeps of wheelsets.
    pub sweeps: Extent,
    /// Number n of the n × n grid of whole cases.
    pub case_side: usize,
}

impl Effort {
    /// Returns the effort of `wheelrail report`: 4 × 10^4 and 4 × 10^6 points, growth up to 10^8; about three
    /// minutes, 0.9 GB.
    pub fn full() -> Self {
        Self {
            sides: vec![200, 2000],
            seconds: 0.25,
            growth: vec![100, 316, 1000, 3162, 10_000],
            every_pair: 1,
            every_case: 1,
            spacings: measured::SPACINGS.to_vec(),
            sweeps: Extent::full(),
            case_side: 200,
        }
    }
}

/// One row of accuracy.csv.
#[derive(Debug, Clone, PartialEq)]
pub struct AccuracyRow {
    /// Name of the reference scene.
    pub scene: String,
    /// Name of the method, or "store".
    pub method: &'static str,
    /// Tolerance \[mm\], for a method that has one.
    pub tolerance: Option<f64>,
    /// Number n of the n × n grid.
    pub side: usize,
    /// Times for the whole grid on one thread.
    pub timing: Timing,
    /// Errors at the 60-digit points; `None` for the store.
    pub errors: Option<Errors>,
}

impl AccuracyRow {
    /// Returns the number of points of the grid.
    pub fn points(&self) -> usize {
        self.side * self.side
    }

    /// Returns millions of points a second.
    pub fn rate(&self) -> f64 {
        self.points() as f64 / self.timing.best / 1e6
    }
}

/// Cost against the number of points, on one thread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// Number of points of the grid.
    pub points: usize,
    /// Time of spectral columns at full precision \[s\].
    pub spectral: f64,
    /// Time of a plain store \[s\].
    pub store: f64,
}

/// Times on one thread and on two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threads {
    /// The method.
    pub method: Method,
    /// Number of points of the grid.
    pub points: usize,
    /// Best wall-clock time on one and on two threads \[s\].
    pub seconds: [f64; 2],
    /// Whether both gave the same bits.
    pub same_bits: bool,
}

/// All numbers of a report.
#[derive(Debug, Clone)]
pub struct Measurements {
    /// Rows for every scene × method × tolerance × grid.
    pub rows: Vec<AccuracyRow>,
    /// Least, median and largest time for choosing a method at full precision \[s\], over the scenes and
    /// grids of the rows.
    pub planning: [f64; 3],
    /// Cost against the number of points, on one thread.
    pub growth: Vec<Growth>,
    /// Times on one thread and on two, method by method.
    pub threads: Vec<Threads>,
    /// Times of grids over splines and over arcs, on one thread.
    pub splines: Vec<SplineCost>,
    /// Positions of wheelsets a second, on one thread.
    pub rates: Vec<Rate>,
    /// Times of cases from first touch to mesh, on one thread.
    pub whole_cases: Vec<WholeCase>,
    /// Time of what `run` computes for a measured wheelset, on one thread; `None` without measured pairs in
    /// [`Effort::sweeps`].
    pub run: Option<RunCost>,
    /// Times of whole processes, which the program adds: here they are empty.
    pub processes: Vec<ProcessCost>,
    /// Results of the hard cases.
    pub hard_cases: Vec<HardOutcome>,
    /// Results of the practice cases against brute force.
    pub practice: Vec<PracticeRow>,
    /// Errors, times and effects of the normal gap.
    pub normal_gap: NormalGapFigures,
    /// Errors of approaches under loads.
    pub loads: Vec<ApproachError>,
    /// Times of contacts under loads.
    pub load_costs: Vec<LoadCost>,
    /// Results of the check by parry3d's meshes: of the reference scenes, with and without skew, and of the
    /// built-in pairs.
    pub verified: [Vec<Verified>; 2],
    /// Effects of sampling, noise and the choice of curve on measured profiles.
    pub evidence: Vec<measured::MeasuredRow>,
}

/// Measures everything; `progress` gets the name of each part when it begins.
///
/// # Errors
/// Embedded files that are not in their format; a system that grants no thread.
pub fn measure(effort: &Effort, progress: &mut dyn FnMut(&str)) -> Result<Measurements> {
    let one = pool(1)?;
    let references = references()?;
    let (rows, planning) = scene_races(&references, effort, &one, progress)?;
    let example = example(&references)?;
    progress("growth of cost with the number of points");
    let growth = one.install(|| growth(example, effort))?;
    progress("one thread against two");
    let threads = threads(example, effort)?;
    progress("splines against arcs");
    let splines = one.install(|| spline_costs(&effort.sides, effort.seconds))?;
    progress("whole cases");
    let whole_cases = one.install(|| whole_cases(effort.case_side, effort.seconds))?;
    let measured = !effort.sweeps.instruments.is_empty();
    let run = measured.then(|| one.install(|| run_cost(effort.seconds))).transpose()?;
    progress("positions of wheelsets");
    let rates = one.install(|| rates(&effort.sweeps, effort.seconds))?;
    progress("hard cases");
    let cases = hard_cases()?;
    let hard_cases = cases.iter().map(|case| hard_run::run(case, &cases)).collect::<Result<_>>()?;
    progress("practice cases against brute force");
    let cases: Vec<_> = practice::cases()?.into_iter().step_by(effort.every_case).collect();
    let practice = cases.par_iter().map(practice::run).collect();
    progress("the normal gap");
    let normal_gap = one.install(|| normal_gap_figures(&effort.sides, effort.seconds))?;
    progress("loads");
    let loads = loads::carried()?.iter().map(CarriedRegion::compared).collect();
    let load_costs = one.install(|| loads::costs(effort.seconds))?;
    progress("the check by parry3d's meshes");
    let verified = verified(&references, effort.every_pair)?;
    progress("measured profiles");
    let evidence = measured::rows(&effort.spacings)?;
    Ok(Measurements {
        rows,
        planning,
        growth,
        threads,
        splines,
        rates,
        whole_cases,
        run,
        processes: Vec::new(),
        hard_cases,
        practice,
        normal_gap,
        loads,
        load_costs,
        verified,
        evidence,
    })
}

fn verified(references: &[ReferenceFile], every_pair: usize) -> Result<[Vec<Verified>; 2]> {
    let mut scenes = Vec::new();
    for reference in references {
        let subject = Subject::of_reference(reference)?;
        scenes.extend(subject.skewed()?);
        scenes.push(subject);
    }
    let pairs: Vec<Subject> = built_in_pairs()?.into_iter().step_by(every_pair).collect();
    Ok([verify(&scenes)?, verify(&pairs)?])
}

fn pool(threads: usize) -> Result<ThreadPool> {
    ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
        Error::new("threads", error.to_string(), format!("{threads} threads"), "free some memory")
    })
}

fn example(references: &[ReferenceFile]) -> Result<&ReferenceFile> {
    references.iter().find(|reference| reference.name == EXAMPLE).ok_or_else(|| {
        Error::new("reference scenes", "no example", EXAMPLE, "restore crates/report/src/reference")
    })
}

/// Returns the grid over the window of the scene's own points, so that spectral columns are the same
/// polynomials as at these points.
fn track<'a>(reference: &ReferenceFile, placement: &'a Placement, side: usize) -> RaceTrack<'a> {
    let [xi, eta] = reference.scene.axes();
    let reach = eta.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let ends = [xi.first(), xi.last()].map(|v| v.copied().unwrap_or(0.0));
    RaceTrack::new(placement, ends, reach, side)
}

/// Returns every method and tolerance as (name, tolerance, method), the store first.
fn contestants() -> Vec<(&'static str, Option<f64>, Option<Method>)> {
    let mut all = vec![("store", None, None)];
    for method in Method::ALL {
        match method {
            Method::Spectral => all.extend(TOLERANCES.map(|t| (method.name(), Some(t), Some(method)))),
            Method::ReportNewton => all.push((method.name(), Some(FULL_PRECISION), Some(method))),
            _ => all.push((method.name(), None, Some(method))),
        }
    }
    all
}

/// Returns the rows of all scenes and grids, and the least, median and largest time of a plan \[s\].
fn scene_races(
    references: &[ReferenceFile],
    effort: &Effort,
    one: &ThreadPool,
    progress: &mut dyn FnMut(&str),
) -> Result<(Vec<AccuracyRow>, [f64; 3])> {
    let placements = references.iter().map(ReferenceFile::placement).collect::<Result<Vec<_>>>()?;
    let (mut rows, mut planning) = (Vec::new(), Vec::new());
    for &side in &effort.sides {
        progress(&format!("grid {side} x {side}, errors of {} scenes", references.len()));
        let entrants = references.iter().zip(&placements);
        let entered = entrants.map(|(reference, placement)| SceneRace::new(reference, placement, side));
        let mut races: Vec<_> = one.install(|| entered.collect());
        for pass in 1..=PASSES {
            progress(&format!("grid {side} x {side}, races of all scenes, {pass} of {PASSES}"));
            let seconds = effort.seconds * pass as f64 / PASSES as f64;
            let least = if pass == PASSES { LEAST_RUNS } else { 1 };
            one.install(|| races.iter_mut().for_each(|race| race.run(seconds, least)));
        }
        planning.extend(races.iter().map(|race| race.planning));
        rows.extend(races.into_iter().flat_map(|race| race.rows));
    }
    planning.sort_by(f64::total_cmp);
    let planning = [0, planning.len() / 2, planning.len().saturating_sub(1)]
        .map(|k| planning.get(k).copied().unwrap_or(f64::NAN));
    Ok((rows, planning))
}

/// All contestants over one scene and grid.
struct SceneRace<'a> {
    reference: &'a ReferenceFile,
    placement: &'a Placement,
    side: usize,
    works: Vec<TimedWork>,
    /// One row for each contestant, with the times of its runs so far.
    rows: Vec<AccuracyRow>,
    /// Time for choosing a method at full precision \[s\].
    planning: f64,
}

impl<'a> SceneRace<'a> {
    /// Makes the plans and errors; no contestant has run yet.
    fn new(reference: &'a ReferenceFile, placement: &'a Placement, side: usize) -> Self {
        let track = track(reference, placement, side);
        let planned = |tolerance, method| plan(placement, track.xi(), track.axis(), tolerance, method).choice;
        let (mut works, mut rows) = (Vec::new(), Vec::new());
        for (name, tolerance, method) in contestants() {
            let choice = method.map(|method| planned(tolerance.unwrap_or(FULL_PRECISION), Some(method)));
            works.push(choice.map_or(TimedWork::Store, TimedWork::Fill));
            rows.push(AccuracyRow {
                scene: reference.name.clone(),
                method: name,
                tolerance,
                side,
                timing: Timing::NONE,
                errors: choice.map(|choice| Errors::of(&compare(reference, placement, &choice, side))),
            });
        }
        let start = Instant::now();
        planned(FULL_PRECISION, None);
        Self { reference, placement, side, works, rows, planning: start.elapsed().as_secs_f64() }
    }

    /// Runs the contestants until each has had `seconds` and `least` runs, in an array of this race.
    fn run(&mut self, seconds: f64, least: usize) {
        let mut track = track(self.reference, self.placement, self.side);
        let mut timings: Vec<_> = self.rows.iter().map(|row| row.timing).collect();
        race(&mut timings, seconds, least, |k| track.timed(self.works[k]));
        for (row, timing) in self.rows.iter_mut().zip(timings) {
            row.timing = timing;
        }
    }
}

fn growth(reference: &ReferenceFile, effort: &Effort) -> Result<Vec<Growth>> {
    let placement = reference.placement()?;
    let mut tracks: Vec<_> = effort.growth.iter().map(|&side| track(reference, &placement, side)).collect();
    let works: Vec<_> = tracks
        .iter()
        .map(|track| {
            let method = Some(Method::Spectral);
            let plan = plan(&placement, track.xi(), track.axis(), FULL_PRECISION, method);
            [TimedWork::Store, TimedWork::Fill(plan.choice)]
        })
        .collect();
    let mut timings = vec![Timing::NONE; 2 * works.len()];
    let seconds = GROWTH_SHARES * effort.seconds;
    race(&mut timings, seconds, LEAST_RUNS, |k| tracks[k / 2].timed(works[k / 2][k % 2]));
    let grown = effort.growth.iter().zip(timings.as_chunks().0);
    let rows = grown.map(|(&side, [store, spectral])| Growth {
        points: side * side,
        store: store.best,
        spectral: spectral.best,
    });
    Ok(rows.collect())
}

fn threads(reference: &ReferenceFile, effort: &Effort) -> Result<Vec<Threads>> {
    let placement = reference.placement()?;
    let pools = [pool(1)?, pool(2)?];
    let side = effort.sides.iter().copied().max().unwrap_or(2);
    let mut track = track(reference, &placement, side);
    let rows = [Method::Spectral, Method::Pointwise].map(|method| {
        let choice = plan(&placement, track.xi(), track.axis(), FULL_PRECISION, Some(method)).choice;
        let mut timings = [Timing::NONE; 2];
        race(&mut timings, effort.seconds, LEAST_RUNS, |k| {
            let start = Instant::now();
            pools[k].install(|| track.run(TimedWork::Fill(choice)));
            start.elapsed().as_secs_f64()
        });
        let [one, two] = [0, 1].map(|k| {
            pools[k].install(|| track.run(TimedWork::Fill(choice)));
            track.values().iter().map(|s| s.to_bits()).collect::<Vec<_>>()
        });
        let same_bits = one == two;
        let seconds = [timings[0].best, timings[1].best];
        Threads { method, points: side * side, seconds, same_bits }
    });
    Ok(rows.to_vec())
}

/// Returns the median; NaN if there are no values.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
