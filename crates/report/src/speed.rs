//! Races: several methods and a plain store fill one array in turn.

use std::hint::black_box;
use std::time::Instant;

use rustix::time::{ClockId, clock_gettime};

use wheelrail::mesh::equal_steps;
use wheelrail::placement::Placement;
use wheelrail::separation::{Choice, EtaAxis, FULL_PRECISION, plan};

/// Least number of runs of one contestant in all its races: three show a disturbed one.
pub const LEAST_RUNS: usize = 3;

/// Length of a run, as a multiple of its contestant's share of time, above which it is not repeated.
const TOO_LONG: f64 = 10.0;

/// Longest run \[s\] that is timed by the wall clock: the shortest of many such runs is undisturbed. The clock of a thread's
/// processor time was seen to stand still during one of some million such runs.
const SHORT: f64 = 1e-3;

/// The value that is stored. It is not a pattern of equal bytes, which a compiler could turn into `memset`.
const STORED: f64 = 0.1;

/// The work that is timed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimedWork {
    /// Writes one value to the whole array, column by column.
    Store,
    /// Fills the array by a method.
    Fill(Choice),
    /// Chooses a method at full precision, and fills the array by it.
    PlanAndFill,
}

/// The times of one contestant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Time of the shortest run \[s\]: [`RaceTrack::timed`] on one thread, wall-clock time on several.
    pub best: f64,
    /// Sum of the times of all runs \[s\].
    pub spent: f64,
    /// Number of runs.
    pub runs: usize,
}

impl Timing {
    /// The times of a contestant that has not run.
    pub const NONE: Self = Self { best: f64::INFINITY, spent: 0.0, runs: 0 };
}

/// The grid that is filled: one array for all contestants, with its pages touched before the first run.
#[derive(Debug)]
pub struct RaceTrack<'a> {
    placement: &'a Placement,
    xi: Vec<f64>,
    axis: EtaAxis,
    out: Vec<f64>,
}

impl<'a> RaceTrack<'a> {
    /// Makes a grid of n × n points over \[ξ_0, ξ_1\] × \[−reach, reach\] \[mm\].
    pub fn new(placement: &'a Placement, [a, b]: [f64; 2], reach: f64, n: usize) -> Self {
        let xi = equal_steps(a, b, n);
        let axis = EtaAxis::new(&equal_steps(-reach, reach, n));
        let mut out = vec![0.0; n * n];
        out.fill(STORED);
        Self { placement, xi, axis, out }
    }

    /// Returns ξ of the columns \[mm\].
    pub fn xi(&self) -> &[f64] {
        &self.xi
    }

    /// Returns the common η axis.
    pub fn axis(&self) -> &EtaAxis {
        &self.axis
    }

    /// Returns the array as the last run left it \[mm\].
    pub fn values(&self) -> &[f64] {
        &self.out
    }

    /// Runs once, on the threads of the present rayon pool.
    pub fn run(&mut self, work: TimedWork) {
        match work {
            TimedWork::Store => {
                let value = black_box(STORED);
                for column in self.out.chunks_mut(self.axis.eta().len().max(1)) {
                    column.fill(value);
                }
            }
            TimedWork::Fill(choice) => {
                choice.fill(self.placement, &self.xi, &self.axis, &mut self.out);
            }
            TimedWork::PlanAndFill => {
                let mut plan = plan(self.placement, &self.xi, &self.axis, FULL_PRECISION, None);
                plan.fill(self.placement, &self.xi, &self.axis, &mut self.out);
            }
        }
        black_box(&mut *self.out);
    }

    /// Returns the time of one run \[s\], measured by [`timed`].
    pub fn timed(&mut self, work: TimedWork) -> f64 {
        timed(|| self.run(work))
    }
}

/// Returns the time of some work \[s\]: processor time, which leaves out what other processes took, or wall-clock
/// time if the work is short. Call it on a rayon pool of one thread.
pub fn timed(work: impl FnOnce()) -> f64 {
    let (start, on_the_wall) = (processor_time(), Instant::now());
    work();
    let on_the_wall = on_the_wall.elapsed().as_secs_f64();
    (processor_time() - start).max(on_the_wall.min(SHORT))
}

/// Returns the processor time of this thread \[s\].
fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Runs contestants until each has had `seconds`, earlier races included, and `least` runs; fewer if one run takes far more
/// than `seconds`. `run` returns the seconds of one run.
///
/// The next contestant is the one with the least time so far. All runs are therefore spread over the same stretch of time
/// and meet the same disturbances, so that ratios hold even if times do not.
pub fn race(timings: &mut [Timing], seconds: f64, least: usize, mut run: impl FnMut(usize) -> f64) {
    let waits = |timing: &Timing| {
        let long = timing.best > TOO_LONG * seconds;
        timing.runs == 0 || timing.spent < seconds || (timing.runs < least && !long)
    };
    let waiting = |timings: &[Timing]| {
        let all = timings.iter().enumerate().filter(|(_, timing)| waits(timing));
        all.min_by(|(_, a), (_, b)| a.spent.total_cmp(&b.spent)).map(|(k, _)| k)
    };
    while let Some(k) = waiting(timings) {
        let time = run(k);
        let Timing { best, spent, runs } = timings[k];
        timings[k] = Timing { best: best.min(time), spent: spent + time, runs: runs + 1 };
    }
}
