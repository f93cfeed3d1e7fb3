//! The landmarks of a pair that doubts about contacts are judged by: top of rail, tip and tread of the wheel.

use nalgebra::{Point2, UnitComplex};

use super::doubts::{ContactDoubts, DoubtKind};
use super::ends::OpenEnds;
use super::unmeasured::Bridges;
use crate::lofted::LoftedBody;
use crate::measure::flange_back;
use crate::numerics::interval::Interval;
use crate::placement::{Pair, Placement};
use crate::profile::{last_groove, points_along};
use crate::search::{Contact, SweepRow, TrackSide};

/// Distance of the points \[mm\] along a profile: over a flange's face of 70° the lift is off by less than 0.15 mm.
const STEP: f64 = 0.1;

/// Depth of the lowest point below the tread from which on it is a flange's tip \[mm\]; trams have 15.
const FLANGE: f64 = 10.0;

/// Height above the lowest point up to which a contact is on the tip \[mm\].
const TIP: f64 = 2.0;

/// Largest lift of an axle's middle \[mm\] that raises no doubt, as the mean of both treads' heights over their rails: a wheel that
/// climbs its flange by two millimetres beyond the clearance lifts it by less.
const LIFTED: f64 = 8.0;

/// Largest distance of a contact from the flange's tip that raises no doubt \[mm\]: 35 mm beyond the taping line, where treads end
/// in their outer slope, and where a wheel stands only if the gauge is that of other wheels.
const RUNNING: f64 = 90.0;

/// Contact angles below this \[rad\] are those of treads: 20°.
const TREAD: f64 = 0.35;

/// Largest difference of a tread's rolling radius from the nominal one that raises no doubt \[mm\].
const RADIUS_OFF: f64 = 15.0;

/// Where a wheel touches its rail, each in its own axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touching {
    rail: Point2<f64>,
    pub(super) wheel: Point2<f64>,
    /// Angle of the common tangent in the rail's and the wheel's axes \[rad\].
    angles: [f64; 2],
}

impl From<&Contact> for Touching {
    fn from(c: &Contact) -> Self {
        Self {
            rail: Point2::new(c.rail_x, c.rail_z),
            wheel: Point2::new(c.wheel_x, c.wheel_z),
            angles: [c.contact_angle, c.wheel_angle],
        }
    }
}

impl From<&Placement> for Touching {
    fn from(placement: &Placement) -> Self {
        let bodies = [placement.rail(), placement.wheel()];
        let [rail, wheel] = bodies.map(|body| {
            let at = &body.point().station;
            Point2::new(at.x, at.z)
        });
        Self { rail, wheel, angles: bodies.map(|body| body.contact_angle()) }
    }
}

/// Width \[mm\] over which the end of a wheel's profile is its back, which is not quite upright.
const BACK_WIDTH: f64 = 1.0;

/// The landmarks of a pair.
#[derive(Debug, Clone)]
pub struct Landmarks {
    pair: Pair,
    /// Top of the running head, in the rail's axes.
    top: Point2<f64>,
    /// Tip of the flange, in the wheel's axes; `None` for a wheel without one.
    pub(crate) tip: Option<Point2<f64>>,
    /// Range of the abscissae of the wheel's profile \[mm\].
    pub(crate) reach: Interval,
    /// Height over the tip \[mm\] of the profile's end at its least abscissa: the largest within 1 mm of it.
    pub(crate) back: f64,
    /// Abscissa of the flange back \[mm\] where the wheel's profile shows it.
    pub(crate) back_x: Option<f64>,
    ends: OpenEnds,
    bridges: Bridges,
}

impl Landmarks {
    /// Finds the landmarks of a pair, to 0.05 mm along its profiles.
    pub fn new(pair: &Pair) -> Self {
        let [rail, wheel] = [pair.rail(), pair.wheel()].map(|profile| points_along(profile, STEP));
        let heights: Vec<f64> = rail.iter().map(|at| at.y).collect();
        let head = rail[last_groove(&heights).unwrap_or(0)..].iter().copied();
        let top = head.max_by(|a, b| a.y.total_cmp(&b.y)).unwrap_or_default();
        let low = wheel.iter().copied().min_by(|a, b| a.y.total_cmp(&b.y)).unwrap_or_default();
        let reach = Interval::around(wheel.iter().map(|at| at.x));
        let back = wheel.iter().filter(|at| at.x < reach.low + BACK_WIDTH).map(|at| at.y);
        let back = back.fold(f64::NEG_INFINITY, f64::max) - low.y;
        let tip = (median_height(&wheel) - low.y >= FLANGE).then_some(low);
        let back_x = flange_back(pair.wheel());
        let (ends, bridges) = (OpenEnds::new(pair, None), Bridges::new(pair, None));
        Self { pair: pair.clone(), top, tip, reach, back, back_x, ends, bridges }
    }

    /// Finds the landmarks of a pair one body of which varies; the ends are that body's, and it has no bridges.
    pub fn varying(pair: &Pair, body: Option<&LoftedBody>) -> Self {
        Self { ends: OpenEnds::new(pair, body), bridges: Bridges::new(pair, body), ..Self::new(pair) }
    }

    /// Adds what is doubtful wherever a contact lies: an open end of a profile, or no surface that was measured.
    fn of_profiles(&self, doubts: ContactDoubts, contact: &Contact) -> ContactDoubts {
        let x = |holds: bool| holds.then_some(contact.wheel_x);
        doubts
            .and(DoubtKind::ProfileEnd, x(self.ends.hold(contact)))
            .and(DoubtKind::Unmeasured, x(self.bridges.hold(contact)))
    }

    /// Returns the height \[mm\] of the wheel's surface over the top of the rail, 0 where nothing of the wheel is over it: how far
    /// the tread is lifted.
    pub(super) fn lift(&self, at: &Touching) -> f64 {
        let [rail, wheel] = at.angles;
        let up = at.wheel + UnitComplex::new(wheel - rail) * (self.top - at.rail);
        let [_, profile] = self.pair.sections();
        let height = profile.height(up.x) - up.y;
        if height.is_nan() { 0.0 } else { height }
    }

    /// Finds what is doubtful about a contact but for ends and bridges of profiles; `lift` is that of its wheel \[mm\], `other` that of the other wheel.
    pub(super) fn doubts(&self, at: &Touching, [lift, other]: [f64; 2]) -> ContactDoubts {
        let [x, z] = [at.wheel.x, at.wheel.y];
        let on_tip = self.tip.is_some_and(|tip| z < tip.y + TIP);
        let on_back = self.tip.is_some_and(|tip| x < tip.x) && !on_tip;
        let lifted = lift > LIFTED && lift + other > 2.0 * LIFTED;
        let from_tip = self.tip.map(|tip| (x - tip.x).abs()).filter(|distance| *distance > RUNNING);
        // R − z is the rolling radius.
        let off = !on_tip && !on_back && at.angles[0].abs() < TREAD && z.abs() > RADIUS_OFF;
        let lift = lifted.then_some(lift);
        let [tip, back, off] = [on_tip.then_some(x), on_back.then_some(x), off.then_some(-z)];
        ContactDoubts([tip, back, lift, from_tip, off, None, None, None])
    }
}

/// Returns the median height over x \[mm\]: that of the tread.
fn median_height(points: &[Point2<f64>]) -> f64 {
    let runs = points.windows(2).map(|pair| (0.5 * (pair[0].y + pair[1].y), (pair[1].x - pair[0].x).abs()));
    let mut runs: Vec<(f64, f64)> = runs.collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * runs.iter().map(|(_, run)| run).sum::<f64>();
    let mut sum = 0.0;
    let median = runs.iter().find(|(_, run)| {
        sum += run;
        sum >= half
    });
    median.map_or(f64::NAN, |(height, _)| *height)
}

/// The landmarks of both sides' pairs, by which the contacts of runs and sweeps are doubted.
#[derive(Debug, Clone)]
pub struct SideLandmarks {
    right: Landmarks,
    left: Option<Landmarks>,
}

impl SideLandmarks {
    /// Joins the landmarks of both sides' pairs; without left ones, both sides have one pair.
    pub fn new(right: Landmarks, left: Option<Landmarks>) -> Self {
        Self { right, left }
    }

    /// Finds the doubts about each row of a position; rows of further contacts have only those about ends and bridges of
    /// profiles.
    pub fn of_rows<'a>(
        &'a self,
        rows: &'a [SweepRow],
    ) -> impl Iterator<Item = (&'a SweepRow, ContactDoubts)> + 'a {
        let first = [TrackSide::Left, TrackSide::Right].map(|side| {
            let first = rows.iter().find(|row| row.side == side && row.number == 0);
            first.map(|row| &row.contact)
        });
        let [left, right] = self.of_first(first);
        rows.iter().map(move |row| match row.number {
            0 => (row, if row.side == TrackSide::Right { right } else { left }),
            _ => (row, self.of_profiles(row)),
        })
    }

    /// Finds the doubts about a contact at the end of a profile, or where none was measured: those that need no other landmark.
    pub(super) fn of_profiles(&self, row: &SweepRow) -> ContactDoubts {
        self.on(row.side).of_profiles(ContactDoubts::default(), &row.contact)
    }

    /// Finds the doubts about the first contacts of the left and the right side, or of a single wheel, which is a right one.
    pub fn of_first(&self, first: [Option<&Contact>; 2]) -> [ContactDoubts; 2] {
        let marks = [self.on(TrackSide::Left), self.on(TrackSide::Right)];
        let touching = first.map(|contact| contact.map(Touching::from));
        let lift = |k: usize| touching[k].as_ref().map_or(0.0, |at| marks[k].lift(at));
        let lifts = [lift(0), lift(1)];
        [0, 1].map(|k| {
            let doubts = touching[k].as_ref().map(|at| marks[k].doubts(at, [lifts[k], lifts[1 - k]]));
            let doubts = doubts.unwrap_or_default();
            first[k].map_or(doubts, |contact| marks[k].of_profiles(doubts, contact))
        })
    }

    /// Gives the landmarks of a side's pair.
    pub fn on(&self, side: TrackSide) -> &Landmarks {
        self.left.as_ref().filter(|_| side == TrackSide::Left).unwrap_or(&self.right)
    }
}
