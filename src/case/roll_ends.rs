//! Where a sweep's rows lie on different branches of the roll: the ends of the roll at which both wheels touch, between positions.

use crate::error::{ErrorKind, Result};
use crate::numerics::interval::Interval;
use crate::search::{Position, Roll, SweepRow, WheelsetOnTrack};
use crate::table::roll_ends;

/// Slope of a common tangent below which no roll ends: heights of both sides part with the roll, and cease to at slopes of about 3.
const STEEP: f64 = 0.5;

/// Distance \[mm\] of the contacts across the widest tracks: on narrower ones roll is sought at a few more positions.
const WIDEST: f64 = 1800.0;

/// Most ends that are said one by one; no more are looked for.
const MOST_SAID: usize = 6;

/// Most displacements \[mm\] that are searched, of all ranges: a second or two.
const MOST_SEARCHED: f64 = 1000.0;

/// What a position has found, for the next one.
#[derive(Debug, Clone, Copy)]
struct RollAt {
    lateral: f64,
    yaw: f64,
    roll: f64,
    /// The steepest slope of both lowest contacts, as a magnitude.
    slope: f64,
}

/// Ranges between neighbouring positions of a sweep, of one yaw and with the roll solved, in which the roll at which both wheels touch may
/// end. Positions come in order, those of each thread apart.
#[derive(Debug, Clone, Default)]
pub struct RollEnds {
    /// The first and the last position, and whether there is any.
    first: Option<Option<RollAt>>,
    last: Option<RollAt>,
    /// Pairs of neighbours.
    pairs: Vec<[RollAt; 2]>,
}

impl RollEnds {
    /// Adds a position with its rows.
    pub fn add(&mut self, position: &Position, rows: &[SweepRow]) {
        let lowest = || rows.iter().filter(|row| row.number == 0);
        let slope = lowest().map(|row| row.contact.contact_angle.tan().abs()).fold(0.0, f64::max);
        let solved = rows.first().filter(|_| position.roll == Roll::Solve);
        let seen = solved.map(|row| RollAt { lateral: row.lateral, yaw: row.yaw, roll: row.roll, slope });
        self.then(seen);
    }

    /// Adds the positions after these.
    pub fn join(&mut self, later: &Self) {
        if let Some(first) = later.first {
            self.then(first);
            self.pairs.extend(&later.pairs);
            self.last = later.last;
        }
    }

    fn then(&mut self, seen: Option<RollAt>) {
        self.pairs.extend(self.last.zip(seen).filter(|(a, b)| a.may_end_before(b)).map(|(a, b)| [a, b]));
        self.first = self.first.or(Some(seen));
        self.last = seen;
    }

    /// Says where the roll ends, a line for each place; after a few, or a long search, how many ranges are left. `go_on` is asked on the way.
    ///
    /// # Errors
    /// Those of `go_on`.
    pub fn lines(&self, system: &WheelsetOnTrack, go_on: impl Fn() -> Result<()>) -> Result<Vec<String>> {
        let (mut said, mut searched) = (Vec::new(), 0.0);
        let ranges = self.ranges();
        for (k, (yaw, range)) in ranges.iter().enumerate() {
            if said.len() >= MOST_SAID || searched > MOST_SEARCHED {
                said.push(format!(
                    "the roll may jump in {} more ranges between positions, which were not searched",
                    ranges.len() - k
                ));
                break;
            }
            go_on()?;
            searched += range.width();
            let under = if *yaw == 0.0 { String::new() } else { format!(" under a yaw of {yaw} rad") };
            match roll_ends(system, *yaw, *range) {
                Ok(ends) => said.extend(ends.into_iter().map(|end| roll_end(end, &under))),
                Err(error) if error.kind == ErrorKind::Limit => said.push(format!(
                    "from {} to {} mm{under} the roll at which both wheels touch may end: {error}",
                    range.low, range.high
                )),
                Err(error) => return Err(error),
            }
        }
        Ok(said)
    }

    /// Gives the ranges by yaw \[rad\] and displacement \[mm\], none of which touches another.
    fn ranges(&self) -> Vec<(f64, Interval)> {
        let range = |[a, b]: &[RollAt; 2]| (a.yaw, Interval::of(a.lateral).hull(Interval::of(b.lateral)));
        let mut all: Vec<_> = self.pairs.iter().map(range).collect();
        all.sort_by(|(yaw, a), (other, b)| yaw.total_cmp(other).then(a.low.total_cmp(&b.low)));
        all.dedup_by(|(yaw, next), (own_yaw, own)| {
            let touch = yaw == own_yaw && next.low <= own.high;
            if touch {
                *own = own.hull(*next);
            }
            touch
        });
        all
    }
}

impl RollAt {
    /// Tells whether a roll may have ended on the way to the next position: on a flank, or where the wheelset has rolled by more than
    /// twice what the slopes of its contacts give. Between positions of different yaws none is looked for.
    fn may_end_before(&self, next: &Self) -> bool {
        let (width, slope) = ((next.lateral - self.lateral).abs(), self.slope.max(next.slope));
        let turned = (next.roll - self.roll).abs() * WIDEST;
        self.yaw == next.yaw && width > 0.0 && (slope > STEEP || turned > 4.0 * slope * width)
    }
}

/// Says that a roll ends, as tables and sweeps do: displacement \[mm\] and jump \[rad\], and under what yaw.
pub fn roll_end([lateral, jump]: [f64; 2], under: &str) -> String {
    format!(
        "the roll jumps by {:.3} mrad at {lateral:.6} mm{under}: the one at which both wheels touch ends there, as on a steep flange, and \
         they touch at another one beyond",
        1e3 * jump
    )
}
