//! Races: several methods and a plain store fill the same array in turn.

use std::hint::black_box;

use rustix::time::{ClockId, clock_gettime};

use crate::placement::Placement;
use crate::scene::equal_steps;
use crate::separation::axis::EtaAxis;
use crate::separation::grid::Choice;
use crate::separation::values::Values;

/// Least and most runs of one contestant: three show a disturbed one; a processor that changes its clock within milliseconds
/// shows every speed that it has in some thousand short ones.
const REPEATS: [usize; 2] = [3, 5000];

/// A run that takes this many times its contestant's share of time is not repeated.
const TOO_LONG: f64 = 10.0;

/// The value that is stored: no pattern of equal bytes, which a compiler could hand to `memset`.
const STORED: f64 = 0.1;

/// What is timed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Work {
    /// One value written to the whole array, column by column.
    Store,
    /// The array filled by a method.
    Fill(Choice),
}

/// The time of one contestant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Shortest run \[s\]: processor time on one thread, time on the wall on several.
    pub best: f64,
    /// How often it ran.
    pub repeats: usize,
}

/// The grid that is filled: one array for all contestants, its pages touched before the first run.
#[derive(Debug)]
pub struct Track<'a> {
    placement: &'a Placement,
    xi: Vec<f64>,
    axis: EtaAxis,
    out: Values,
}

impl<'a> Track<'a> {
    /// n × n points over \[ξ_0, ξ_1\] × \[−reach, reach\] \[mm\].
    pub fn new(placement: &'a Placement, [a, b]: [f64; 2], reach: f64, n: usize) -> Self {
        let xi = equal_steps(a, b, n);
        let axis = EtaAxis::new(&equal_steps(-reach, reach, n));
        let mut out = Values::new(n * n);
        out.fill(STORED);
        Self { placement, xi, axis, out }
    }

    /// ξ of the columns \[mm\].
    pub fn xi(&self) -> &[f64] {
        &self.xi
    }

    /// The common η axis.
    pub fn axis(&self) -> &EtaAxis {
        &self.axis
    }

    /// The array as the last run left it \[mm\].
    pub fn values(&self) -> &[f64] {
        &self.out
    }

    /// One run on the threads of the current rayon pool.
    pub fn run(&mut self, work: Work) {
        match work {
            Work::Store => {
                let value = black_box(STORED);
                for column in self.out.chunks_mut(self.axis.eta.len().max(1)) {
                    column.fill(value);
                }
            }
            Work::Fill(choice) => {
                choice.fill(self.placement, &self.xi, &self.axis, &mut self.out);
            }
        }
        black_box(&mut *self.out);
    }

    /// Runs all in turn, round by round, each until it has had `seconds` of time. To be called on a rayon pool of
    /// one thread, whose processor time is measured.
    pub fn race(&mut self, works: &[Work], seconds: f64) -> Vec<Timing> {
        race(works.len(), seconds, |k| {
            let start = processor_time();
            self.run(works[k]);
            processor_time() - start
        })
    }
}

/// Processor time of this thread \[s\]: unlike the time on the wall it leaves out what other processes took.
fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Rounds in which every contestant that has not had its time yet runs once; `run` gives the seconds of one run.
///
/// Contestants of one round meet the same disturbances by other processes, so that ratios hold where times do not.
pub fn race(contestants: usize, seconds: f64, mut run: impl FnMut(usize) -> f64) -> Vec<Timing> {
    let mut timings = vec![Timing { best: f64::INFINITY, repeats: 0 }; contestants];
    let mut spent = vec![0.0; contestants];
    let [least, most] = REPEATS;
    loop {
        let mut ran = false;
        for k in 0..contestants {
            let Timing { best, repeats } = timings[k];
            let long = repeats > 0 && best > TOO_LONG * seconds;
            if repeats >= most || long || (repeats >= least && spent[k] >= seconds) {
                continue;
            }
            let time = run(k);
            spent[k] += time;
            timings[k] = Timing { best: best.min(time), repeats: repeats + 1 };
            ran = true;
        }
        if !ran {
            return timings;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everyone_runs_in_turn_until_the_time_is_up() {
        let mut order = Vec::new();
        let timings = race(2, 1.0, |k| {
            order.push(k);
            [0.5, 0.1][k]
        });
        assert_eq!(&order[..6], &[0, 1, 0, 1, 0, 1]);
        assert_eq!(timings[0], Timing { best: 0.5, repeats: 3 });
        assert!(timings[1].repeats >= 10, "{timings:?}");
    }
}
