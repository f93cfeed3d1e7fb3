//! Where a sweep's rows lie on different branches of the roll: the ends of the roll at which both wheels touch, between positions.

use crate::error::{ErrorKind, Result};
use crate::numerics::interval::Interval;
use crate::search::{Position, Roll, SweepRow, WheelsetOnTrack};
use crate::table::{ContactTable, roll_ends};

/// Slope of a common tangent below which no roll ends: heights of both sides part with the roll, and cease to at slopes of about 3.
const STEEP: f64 = 0.5;

/// Distance \[mm\] of the contacts across the widest tracks: on narrower ones roll is sought at a few more positions.
const WIDEST: f64 = 1800.0;

/// Most ends that are said one by one; no more are looked for.
const MOST_SAID: usize = 6;

/// Most displacements \[mm\] that are searched, of all ranges: a second or two.
const MOST_SEARCHED: f64 = 1000.0;

/// The roll of a position at which both wheels touch.
#[derive(Debug, Clone, Copy)]
struct RollAt {
    /// Lateral displacement \[mm\].
    lateral: f64,
    /// \[rad\]
    yaw: f64,
    /// \[rad\]
    roll: f64,
    /// The larger slope of both lowest contacts, as a magnitude.
    slope: f64,
}

/// The rolls of the positions of a sweep, from which ranges between neighbours follow in which the roll at which both wheels touch may end.
#[derive(Debug, Clone, Default)]
pub struct RollEnds {
    /// In order; `None` where the roll was given, and where there is no contact.
    rolls: Vec<Option<RollAt>>,
}

impl RollEnds {
    /// Adds the next position with its rows.
    pub fn add(&mut self, position: &Position, rows: &[SweepRow]) {
        let lowest = || rows.iter().filter(|row| row.number == 0);
        let slope = lowest().map(|row| row.contact.contact_angle.tan().abs()).fold(0.0, f64::max);
        let solved = rows.first().filter(|_| position.roll == Roll::Solve);
        self.rolls.push(solved.map(|row| RollAt {
            lateral: row.lateral,
            yaw: row.yaw,
            roll: row.roll,
            slope,
        }));
    }

    /// Adds the positions after these.
    pub fn join(&mut self, later: &Self) {
        self.rolls.extend(&later.rolls);
    }

    /// Says where the roll ends, a line for each place: displacement \[mm\] and jump \[mrad\], + where the roll grows. After six places, or
    /// 1 m of displacements, it says how many ranges were not searched. `go_on` is asked before each range; its error ends the search.
    ///
    /// # Errors
    /// Those of `go_on` and of [`roll_ends`], but for a limit of work, which a line says.
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
                Ok(ends) => said.extend(ends.into_iter().map(|end| sentence(end, &under))),
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
        let neighbours = self.rolls.windows(2).filter_map(|pair| pair[0].zip(pair[1]));
        let range = |(a, b): (RollAt, RollAt)| (a.yaw, Interval::between(a.lateral, b.lateral));
        let mut all: Vec<_> = neighbours.filter(|(a, b)| a.may_end_before(b)).map(range).collect();
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

/// Says where the roll ends in a table, a line for each place under the middle of its yaws.
pub fn table_roll_ends(table: &ContactTable) -> Vec<String> {
    let about = table.about();
    let under = if about.over_yaw() { " under some yaws" } else { "" };
    table.roll_jumps(about.yaw.at(0.5)).into_iter().map(|end| sentence(end, under)).collect()
}

/// Says that the roll ends at a displacement \[mm\] with a jump \[rad\].
fn sentence([lateral, jump]: [f64; 2], under: &str) -> String {
    format!(
        "the roll jumps by {:.3} mrad at {lateral:.6} mm{under}: the one at which both wheels touch ends there, as on a steep flange, and \
         they touch at another one beyond",
        1e3 * jump
    )
}
