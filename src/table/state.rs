//! What touches at one displacement, and what could touch beside it.

use std::f64::consts::FRAC_PI_4;

use super::asked::{Asked, Pressed};
use super::cell::{BREAK, Lacks};
use super::quantity::{MOST, QuantityValues, SideValues, values};
use crate::error::Result;
use crate::load::{curvatures_at, quadratic_form_at};
use crate::numerics::interval::Interval;
use crate::search::{Contact, LowestPlaces, Position, Roll, Selection, WheelsetOnTrack, WheelsetSearch};

/// Distance \[mm\] below which two places are one.
const APART: f64 = 1e-3;

/// Signs of the left and the right side's own x axis along the track's.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// What decides whether quantities are analytic from one displacement to the next: what touches on both sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Topology {
    elements: [[u32; 2]; 2],
    pub lacks: [Lacks; 2],
    /// Whether the long axis of each ellipse is the one nearest to ξ.
    along: [bool; 2],
}

/// What touches on one side.
pub(super) type SideTopology = ([u32; 2], Lacks, bool);

impl Topology {
    /// Gives what touches on the left (0) or right (1) side.
    pub fn side(&self, k: usize) -> SideTopology {
        (self.elements[k], self.lacks[k], self.along[k])
    }
}

/// A place that does not touch.
#[derive(Debug, Clone, Copy)]
struct NearMiss {
    /// Vertical gap \[mm\].
    gap: f64,
    /// Rate at which the gap grows with the displacement, without the effect of the roll.
    rate: f64,
}

/// What a search finds at one displacement.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub lateral: f64,
    /// `None` where a wheel is off its rail.
    pub topology: Option<Topology>,
    pub values: QuantityValues,
    /// Abscissae \[mm\] of the places of contact on both rails and wheels.
    places: [f64; 4],
    /// The lowest places, from which searches nearby begin.
    lowest: Option<LowestPlaces>,
    near: Vec<NearMiss>,
    /// Slopes of both places of contact in track axes.
    slopes: [f64; 2],
}

/// Rate at which the heights of both sides part with the roll, as a share of that of level treads, below which several rolls may have
/// contact on both sides: searches nearby then begin anew. It falls to 0 where such a roll ends, as on flanges of 70 to 73°.
const STEADY: f64 = 0.5;

/// Jump of the roll \[rad\] across a break above which contact does not pass from one place to another of a wheelset that stands still: it
/// lifts a wheel by less than the jump of a hop.
const TURNED: f64 = 1e-8;

/// Searches at one displacement after another, under one yaw.
pub(super) struct Sampler<'a> {
    search: WheelsetSearch<'a>,
    asked: &'a Asked,
    yaw: f64,
}

impl<'a> Sampler<'a> {
    pub fn new(system: &'a WheelsetOnTrack, asked: &'a Asked, yaw: f64) -> Self {
        Self { search: system.search(), asked, yaw }
    }

    /// Searches at one displacement \[mm\], with near misses up to a gap `within` \[mm\].
    ///
    /// # Errors
    /// The errors of the search.
    pub fn at(&mut self, lateral: f64, within: f64) -> Result<State> {
        self.touch(lateral, within, None)
    }

    /// Searches at one displacement \[mm\], with near misses up to a gap `within` \[mm\], with less work than [`Sampler::at`] where the
    /// places of a state nearby still touch.
    ///
    /// # Errors
    /// The errors of the search.
    pub fn near(&mut self, lateral: f64, within: f64, state: &State) -> Result<State> {
        let steady = |lowest: &&LowestPlaces| self.asked.roll != Roll::Solve || lowest.steadiness() > STEADY;
        self.touch(lateral, within, state.lowest.as_ref().filter(steady))
    }

    /// Finds where contact passes from the places of one state to those of a later one, by following both, which takes no search.
    /// Returns an interval of at most [`BREAK`]; `None` where the same elements touch, or nothing does.
    pub fn handover(&mut self, from: &State, to: &State) -> Option<Interval> {
        let (before, after) = (from.lowest?, to.lowest?);
        let differ = [0, 1].map(|k| before.elements()[k] != after.elements()[k]);
        if !differ.contains(&true) {
            return None;
        }
        let (roll, yaw) = (self.asked.roll, self.yaw);
        let mut holds = |lateral: f64| {
            let position = Position { lateral, yaw, roll };
            let Some(before) = self.search.heights(&position, &before) else { return false };
            let after = self.search.heights(&position, &after);
            // The wheel that comes down touches first where it has to stay highest.
            after.is_none_or(|after| (0..2).all(|k| !differ[k] || before[k] >= after[k]))
        };
        let [mut low, mut high] = [from.lateral, to.lateral];
        while high - low > BREAK / 2.0 {
            let middle = low + (high - low) / 2.0;
            if middle <= low || middle >= high {
                break;
            }
            if holds(middle) { low = middle } else { high = middle }
        }
        // On a joint itself rounding decides which elements touch.
        Some(Interval::new(low, high).grown(BREAK / 4.0).cut(Interval::new(from.lateral, to.lateral)))
    }

    fn touch(&mut self, lateral: f64, within: f64, near: Option<&LowestPlaces>) -> Result<State> {
        let pressed = self.asked.pressed;
        let position = Position { lateral, yaw: self.yaw, roll: self.asked.roll };
        let Some(touch) = self.search.touch_near(&position, &Selection { within, apart: APART }, near)?
        else {
            return Ok(State::off_rail(lateral));
        };
        let (mut near, mut slopes) = (Vec::new(), [0.0; 2]);
        let (mut lacks, mut along) = ([Lacks::Nothing; 2], [false; 2]);
        let sides = [0, 1].map(|k| {
            let side = &touch.sides[k];
            let (first, others) = (&side.touch.contacts[0], &side.touch.contacts[1..]);
            slopes[k] = SIGNS[k] * first.contact_angle.tan();
            let miss = |contact: &Contact| NearMiss {
                gap: contact.gap,
                rate: slopes[k] - SIGNS[k] * contact.contact_angle.tan(),
            };
            near.extend(others.iter().map(miss));
            let (values, lack, long) = side_values(side.z, first, pressed.map(|(by, e)| (by[k], e)));
            (lacks[k], along[k]) = (lack, long);
            values
        });
        let [left, right] = sides.each_ref().map(|side| side.contact);
        let places = [left.rail_x, left.wheel_x, right.rail_x, right.wheel_x];
        let values = values(touch.roll, &sides, pressed.is_some());
        let topology = Some(Topology { elements: touch.places.elements(), lacks, along });
        Ok(State { lateral, topology, values, places, lowest: Some(touch.places), near, slopes })
    }
}

/// Returns the values of one side, what does not exist, and whether its ellipse is longer along ξ.
fn side_values(z: f64, contact: &Contact, pressed: Option<(Pressed, f64)>) -> (SideValues, Lacks, bool) {
    let form = quadratic_form_at(contact);
    let mut side = SideValues { z, contact: *contact, form, ellipse: [f64::NAN; 4] };
    if contact.kink() || !form.iter().all(|c| c.is_finite()) {
        side.form = [f64::NAN; 3];
        return (side, Lacks::Curvatures, false);
    }
    let Some((by, modulus)) = pressed else { return (side, Lacks::Nothing, false) };
    let curvatures = curvatures_at(contact);
    let ellipse = match by {
        Pressed::Approach(approach) => curvatures.under_approach(approach, modulus),
        Pressed::Load(load) => curvatures.under_load(load / contact.contact_angle.cos(), modulus),
    };
    let Some(ellipse) = ellipse else { return (side, Lacks::Ellipse, false) };
    let [xi, eta] = curvatures.along(&ellipse);
    side.ellipse = [xi, eta, ellipse.approach_mm, ellipse.pressure_n_per_mm2];
    (side, Lacks::Nothing, curvatures.long_axis_rad.abs() < FRAC_PI_4)
}

/// Part \[mm/mm\] of the bound of a gap's rate of change over the displacement that covers roll and turning tangents between two states,
/// beside what their slopes give. Twice the change of the slopes between the states comes on top.
const UNSEEN: f64 = 0.05;

impl State {
    fn off_rail(lateral: f64) -> Self {
        Self {
            lateral,
            topology: None,
            values: [f64::NAN; MOST],
            places: [f64::NAN; 4],
            lowest: None,
            near: Vec::new(),
            slopes: [0.0; 2],
        }
    }

    /// Tells whether no other place can have touched between this displacement and another one at which the same places touch: no near
    /// miss of either end closes in between, by the slopes there and a margin.
    pub fn alone_until(&self, other: &Self) -> bool {
        let width = (other.lateral - self.lateral).abs();
        let turned = [0, 1].map(|k| (self.slopes[k] - other.slopes[k]).abs());
        let unseen = UNSEEN + 2.0 * turned[0].max(turned[1]);
        let safe = |state: &Self, inward: f64| {
            state.near.iter().all(|near| near.gap + (inward * near.rate - unseen).min(0.0) * width > 0.0)
        };
        let inward = (other.lateral - self.lateral).signum();
        safe(self, inward) && safe(other, -inward)
    }

    /// Returns by how much the wheelset has rolled over on the way to another state at nearly the same displacement \[rad\], where one roll at
    /// which both wheels touch has ended in between; `None` where it goes on.
    pub fn turned(&self, other: &Self) -> Option<f64> {
        let jump = other.lowest.as_ref()?.roll() - self.lowest.as_ref()?.roll();
        (jump.abs() > TURNED).then_some(jump)
    }

    /// Returns the largest distance of a place of contact from that of another state, along the profiles' abscissae \[mm\].
    pub fn moved(&self, other: &Self) -> f64 {
        self.places.iter().zip(&other.places).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Returns what decides which quantities exist, and what they are of: what each side lacks, and which axis of its ellipse is the long
    /// one; `None` where a wheel is off its rail.
    pub fn exists(&self) -> Option<([Lacks; 2], [bool; 2])> {
        self.topology.map(|topology| (topology.lacks, topology.along))
    }

    /// Returns the steepest slope of the common tangents at both contacts, as a magnitude, in track axes.
    pub fn steepest(&self) -> f64 {
        self.slopes[0].abs().max(self.slopes[1].abs())
    }
}
