//! The vertical overlap of a wheel that has sunk into its rail: its parts, and the frame of each.

use nalgebra::Point2;

use super::input::FrameOrigin;
use crate::load::{WeightedFrame, weighted_frame};
use crate::mesh::{CELLS_REACHED, GridGroup, groups};
use crate::numerics::interval::Interval;
use crate::patch::{Patch, Window};
use crate::placement::Placement;

/// Range \[mm\] beyond the distance at which two parts join, over which their angles turn from a common one to their own. It is
/// CONTACT's default.
const TURNED_OVER: f64 = 4.0;

/// What makes parts of a patch one region, and where its frame is.
#[derive(Clone, Copy)]
pub(super) struct RegionRules {
    /// Parts closer than this \[mm\] are joined.
    pub merge: f64,
    /// Steps of the grids \[mm\]: parts that the grid of another one would cut are joined.
    pub spacing: Option<[f64; 2]>,
    /// Whether all parts of the patch of a place are its own: no other place stands for them.
    pub alone: bool,
    /// Origin and angle of a region's frame.
    pub frame: FrameOrigin,
}

/// A part of the overlap that is one region, in the upright frame in which it was found.
#[derive(Debug, Clone)]
pub(super) struct Overlap {
    /// The box around it \[mm\].
    extent: Window,
    /// Range of ξ that is nearer to it than to other parts \[mm\].
    nearest: Interval,
    /// Its frame on the rail, turned towards those of parts nearby.
    pub frame: WeightedFrame,
    /// Nearness of the nearest other part: 1 where they join, 0 from [`TURNED_OVER`] beyond that.
    pub near: f64,
}

/// Finds the parts of the overlap of a wheel that has sunk by `sunk` \[mm\], in order of ξ. `upright` has a vertical ζ, so that its s is
/// the vertical gap at first touch.
///
/// The frames move continuously as parts grow, join and separate: two parts have turned to one angle before they join.
pub(super) fn overlaps(upright: &Placement, sunk: f64, rules: &RegionRules) -> Vec<Overlap> {
    let patch = Patch::new(upright, sunk, &Window::UNBOUNDED);
    let mut parts = groups(&patch, rules.merge, rules.spacing);
    // All parts have the frame of the one that holds the place.
    parts.truncate(if rules.alone { 1 } else { parts.len() });
    let found = |group: &GridGroup| Some((group.clone(), weighted_frame(upright, &group.extent, sunk)?));
    let mut found: Vec<_> = parts.iter().filter_map(found).collect();
    found.sort_by(|(a, _), (b, _)| a.extent.xi.low.total_cmp(&b.extent.xi.low));
    let near: Vec<f64> =
        found.windows(2).map(|pair| nearness(upright, [&pair[0].0, &pair[1].0], rules)).collect();
    let turned = |k: usize| {
        let (mut weights, mut angles) = (0.0, 0.0);
        for (j, (_, frame)) in found.iter().enumerate() {
            let weight = frame.weight * near[k.min(j)..k.max(j)].iter().product::<f64>();
            (weights, angles) = (weights + weight, angles + weight * frame.angle);
        }
        angles / weights
    };
    let middle = |k: usize| 0.5 * (found[k].0.extent.xi.high + found[k + 1].0.extent.xi.low);
    let overlap = |k: usize| {
        let (group, frame) = &found[k];
        let nearest = Interval::new(
            if k > 0 { middle(k - 1) } else { f64::NEG_INFINITY },
            if k + 1 < found.len() { middle(k) } else { f64::INFINITY },
        );
        let beside = [k.checked_sub(1), Some(k)].into_iter().flatten().filter_map(|pair| near.get(pair));
        let near = beside.copied().fold(0.0, f64::max);
        Overlap { extent: group.extent, nearest, frame: WeightedFrame { angle: turned(k), ..*frame }, near }
    };
    (0..found.len()).map(overlap).collect()
}

/// Weight of one part in the angle of the other: 1 at the distance at which they join, 0 from [`TURNED_OVER`] beyond it, and a cubic with
/// level ends between.
fn nearness(upright: &Placement, [left, right]: [&GridGroup; 2], rules: &RegionRules) -> f64 {
    let on_rail = |xi: f64| Point2::new(xi, upright.rail().section().height(xi));
    let aside = left.extent.eta.distance(right.extent.eta);
    let distance = (on_rail(right.extent.xi.low) - on_rail(left.extent.xi.high)).norm().hypot(aside);
    let step = [left, right].map(|group| group.step(rules.spacing)).into_iter().fold(0.0, f64::max);
    let joined = rules.merge.max(CELLS_REACHED * step);
    let t = ((distance - joined) / TURNED_OVER).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

impl Overlap {
    /// Gives the frame where a part of one place keeps that place's own, with the abscissa and the angle of its tangent, until it is near
    /// others, and turns to the centre of what they will be together; `None` where it is the place's own.
    pub fn of_place(&self, [rail_x, angle]: [f64; 2]) -> Option<WeightedFrame> {
        let between = |own: f64, joined: f64| own + self.near * (joined - own);
        let (rail_x, angle) = (between(rail_x, self.frame.rail_x), between(angle, self.frame.angle));
        (self.near > 0.0).then_some(WeightedFrame { rail_x, angle, ..self.frame })
    }

    /// Tells whether a point of the rail at this ξ of the upright frame \[mm\] is in it.
    pub fn holds(&self, xi: f64) -> bool {
        self.extent.xi.contains(xi)
    }

    /// Finds the patch under an approach δ \[mm\] in another frame, with the components that are of this part; with all of them if `alone`.
    pub fn patch(&self, upright: &Placement, placement: &Placement, approach: f64, alone: bool) -> Patch {
        let along = |xi: f64| {
            let there = Point2::new(xi, upright.rail().section().height(xi));
            let there = upright.rail().contact_frame() * there;
            placement.rail().contact_frame().inverse_transform_point(&there).x
        };
        if alone {
            return Patch::new(placement, approach, &Window::UNBOUNDED);
        }
        let xi = self.nearest.map(|xi| if xi.is_finite() { along(xi) } else { xi });
        let mut patch = Patch::new(placement, approach, &Window { xi, ..Window::UNBOUNDED });
        let own = self.extent.xi.map(along);
        patch.components.retain(|component| own.meets(component.xi));
        patch
    }
}
