//! Samples along lines of constant ξ, and the intervals of the patch on them. Over the rail's surface ξ is σ, and s is
//! t + δ (1 − cos α).
//!
//! On a line of constant ξ the patch may be several intervals of η, as on either side of a dip. The lines lie half a millimetre apart,
//! nearer to each other around C, and on the joints of swept bodies. Where two neighbours differ in the number of their slices, or an end
//! moves far between them, intervals begin, end, divide or join in between; lines are then added there until that place is known to
//! rounding.
//!
//! A part is missed only if it is narrower than the steps, across or along, and does not hold C.

use super::slices::{Lane, LaneRow, LineSlice, SlicedLine, refined};
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::numerics::roots::change;
use crate::patch::divided::lines_divide;
use crate::patch::level::{Level, joints};
use crate::patch::lines::line::CrossingKind;
use crate::patch::window::Window;
use crate::placement::Placement;

/// Step of the lines of constant ξ \[mm\].
const STEP: f64 = 0.5;

/// Step along a line of constant ξ, as a share of the half-length √(2Rδ) of the patch of a wheel on a straight rail.
const SHARE: f64 = 0.125;
/// Least and largest step along a line of constant ξ near or inside the patch \[mm\].
const STEPS: [f64; 2] = [0.25, 1.0];

/// Longest step along a line of constant ξ where s is far above δ \[mm\].
const STRIDE: f64 = 2.5;
/// Step along a line of constant ξ as a multiple of s − δ: over it, s falls by less than half of its length.
const STRIDE_SHARE: f64 = 2.0;

/// How far along the track from C the patch is looked for at least \[mm\].
const FARTHEST: f64 = 120.0;
/// How far along the track from C the patch is looked for at least, as a multiple of the half-length √(2Rδ).
const FARTHEST_SHARE: f64 = 2.0;

/// How many halvings of a step lie around C.
const HALVINGS: i32 = 24;

/// Largest move of an interval's end between two lines, as a multiple of the distance of the lines, without more lines between them.
const STEEPEST: f64 = 4.0;

/// Number of steps between the points at which s is computed over and beside an interval of a neighbouring line.
const POINTS: usize = 12;
/// How far these points go beyond both ends of the interval, as a share of its width.
const BEYOND: f64 = 0.25;

/// Largest depth \[mm\] of an interval or a dip that counts as rounding of s.
const ROUNDING: f64 = 1e-11;

/// Distance of two lines, in mm or as a share of ξ, at which none is laid between them: slices begin, end, divide or join there.
const NEAREST: f64 = 1e-10;

/// Accuracy of an edge \[mm\].
const TO_EDGE: f64 = 1e-9;
/// Accuracy of a lowest place \[mm\], where s is flat.
pub(super) const TO_LOWEST: f64 = 1e-6;

/// How far an edge is looked for from its estimate, as shares of half the interval's length, the nearest first.
const BESIDE_EDGE: [f64; 3] = [2e-3, 0.02, 0.1];

/// The slices of a placed pair at one approach, from samples.
#[derive(Debug)]
pub(crate) struct BySamples<'a> {
    pub(in crate::patch) level: Level<'a>,
    pub(super) approach: f64,
    /// Step along lines of constant ξ \[mm\].
    step: f64,
    /// How far along the track from C the patch is looked for \[mm\].
    farthest: f64,
}

impl<'a> BySamples<'a> {
    /// Returns whether the patch of a placed pair at approach δ \[mm\] is found from samples.
    pub(crate) fn apply_to(placement: &Placement, approach: f64, reference: Reference) -> bool {
        let over_roller = reference == Reference::Rail && placement.under().is_some();
        placement.lofted().is_some() || (over_roller && lines_divide(placement, approach))
    }

    /// Makes the slices of a placed pair at a level of its gap, which is that of an approach δ \[mm\].
    pub(in crate::patch) fn new(placement: &'a Placement, approach: f64, level: Level<'a>) -> Self {
        // Steps and reach are the least for δ < 0, and for δ = NaN, where nothing is found.
        let half = (2.0 * placement.rolling_radius() * approach.max(0.0)).sqrt();
        let step = (SHARE * half).clamp(STEPS[0], STEPS[1]);
        let farthest = FARTHEST.max(FARTHEST_SHARE * half);
        Self { level, approach, step, farthest }
    }

    /// Finds the lines over a window, from one end to the other of the range of ξ over which the rail or the body that varies has a
    /// surface, or of σ over which the rail has one; none if the window holds nothing of that range.
    pub(super) fn lines(&mut self, placement: &Placement, window: &Window) -> Vec<SlicedLine> {
        let eta = window.eta.cut(self.within());
        let reach = match self.level.normal_gap() {
            Some(gap) => gap.rail().reach(),
            None => match placement.lofted() {
                Some(body) => body.reach(eta),
                None => placement.rail().section.reach(),
            },
        };
        let over = reach.map(|reach| window.xi.cut(reach));
        let Some(xi) = over.filter(|xi| xi.has_width() && eta.has_width()) else { return Vec::new() };
        let mut all = places(xi, STEP);
        // At a joint parts may be parted, however near to each other.
        let mut joints = joints(placement, self.level.normal_gap(), xi);
        if placement.lofted().is_none() {
            joints.extend(placement.wheel().section.joints(xi).map(|(joint, _)| joint));
        }
        for joint in joints.into_iter().filter(|joint| xi.surrounds(*joint)) {
            if all.iter().all(|place| (place - joint).abs() > nearest(*place, joint)) {
                all.push(joint);
            }
        }
        all.sort_by(f64::total_cmp);
        let lines: Vec<SlicedLine> = all.into_iter().map(|xi| self.whole_line(xi, eta)).collect();
        refined(self, lines, nearest, |samples, pair| answer(pair, samples.step), Self::between)
    }

    /// Lays a line half-way between two.
    fn between(&mut self, [last, next]: [&SlicedLine; 2]) -> SlicedLine {
        let mut samples = Vec::new();
        last.slices.iter().chain(&next.slices).for_each(|found| spread(found.eta, &mut samples));
        samples.sort_by(f64::total_cmp);
        samples.dedup();
        self.line(last.xi + 0.5 * (next.xi - last.xi), &samples)
    }

    /// Returns both ends of the slice of a lane at ξ; `None` outside the patch.
    pub(in crate::patch) fn edges(&mut self, xi: f64, lane: Option<&Lane>) -> Option<[f64; 2]> {
        let near = self.edges_between(xi, lane);
        near.or_else(|| self.interval(xi, lane).map(|found| found.eta.ends()))
    }

    /// Finds both ends of the slice of a lane at ξ near their estimate from the lines on both sides; `None` where they are farther off.
    fn edges_between(&mut self, xi: f64, lane: Option<&Lane>) -> Option<[f64; 2]> {
        let [LaneRow { xi: from, slice: a, .. }, LaneRow { xi: to, slice: b, .. }] = lane?.beside(xi)?;
        let share = ((xi - from) / (to - from)).clamp(0.0, 1.0);
        let square = |of: &LineSlice| (0.5 * of.eta.width()).powi(2);
        let half = (square(a) + share * (square(b) - square(a))).sqrt();
        let middle = a.eta.middle() + share * (b.eta.middle() - a.eta.middle());
        let approach = self.approach;
        let mut found = [0.0; 2];
        for (found, outward) in found.iter_mut().zip([-1.0, 1.0]) {
            let guess = middle + outward * half;
            let mut depth = |eta: f64| self.level.gap(xi, eta) - approach;
            let around = BESIDE_EDGE.map(|share| [-share, share].map(|by| guess + outward * by * half));
            let held = around.into_iter().find(|ends| depth(ends[0]) < 0.0 && depth(ends[1]) >= 0.0)?;
            *found = change(depth, held, TO_EDGE);
        }
        Some(found)
    }

    /// Returns η of the least s of a lane at ξ \[mm\]; of the deepest interval without a lane. Where there is no interval it is that of the
    /// lane's nearest line, or 0.
    pub(in crate::patch) fn lowest(&mut self, xi: f64, lane: Option<&Lane>) -> f64 {
        if let Some(found) = self.interval(xi, lane) {
            return found.lowest[0];
        }
        let Some([a, b]) = lane.and_then(|lane| lane.beside(xi)) else { return 0.0 };
        (if (xi - a.xi).abs() <= (b.xi - xi).abs() { a } else { b }).slice.lowest[0]
    }

    /// Returns how far along the track the patch is looked for \[mm\].
    fn within(&self) -> Interval {
        Interval::symmetric(self.farthest)
    }

    /// Returns s \[mm\].
    pub(in crate::patch) fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.level.gap(xi, eta)
    }

    /// Finds the interval of a lane at ξ, that nearest to those of the lines on both sides; without a lane the deepest one.
    fn interval(&mut self, xi: f64, lane: Option<&Lane>) -> Option<LineSlice> {
        let Some([before, after]) = lane.and_then(|lane| lane.beside(xi)) else {
            let found = self.whole_line(xi, self.within());
            return found.slices.into_iter().min_by(|a, b| a.lowest[1].total_cmp(&b.lowest[1]));
        };
        let ([from, to], [a, b]) = ([before.xi, after.xi], [before.slice, after.slice]);
        let share = if to > from { ((xi - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        let near = a.eta.middle() + share * (b.eta.middle() - a.eta.middle());
        let mut samples = Vec::new();
        spread(a.eta.hull(b.eta), &mut samples);
        let away = |of: &LineSlice| (of.eta.nearest(near) - near).abs();
        let line = self.line(xi, &samples);
        line.slices.into_iter().min_by(|p, q| away(p).total_cmp(&away(q)))
    }

    /// Finds the intervals along a line between two η \[mm\].
    fn whole_line(&mut self, xi: f64, eta: Interval) -> SlicedLine {
        let mut points: Vec<[f64; 2]> = Vec::new();
        let near = Interval::symmetric(self.step).map(|place| eta.nearest(place));
        for eta in places(near, self.step) {
            points.push([eta, self.separation(xi, eta)]);
        }
        for (end, outward) in eta.ends().into_iter().zip([-1.0, 1.0]) {
            points.reverse();
            while let Some(&[eta, s]) = points.last().filter(|[eta, _]| (end - eta) * outward > 0.0) {
                // NaN, where there is no surface, makes the shortest step.
                let stride = (STRIDE_SHARE * (s - self.approach)).max(self.step).min(STRIDE);
                let next = if stride < (end - eta).abs() { eta + outward * stride } else { end };
                points.push([next, self.separation(xi, next)]);
            }
        }
        self.intervals(xi, points)
    }

    /// Finds the intervals along a line by s at ascending η.
    fn line(&mut self, xi: f64, samples: &[f64]) -> SlicedLine {
        let points = samples.iter().map(|&eta| [eta, self.separation(xi, eta)]).collect();
        self.intervals(xi, points)
    }

    /// Finds the intervals along a line of which points \[η, s\] are known, by ascending η.
    fn intervals(&mut self, xi: f64, mut points: Vec<[f64; 2]>) -> SlicedLine {
        let approach = self.approach;
        let dips: Vec<usize> = (1..points.len().max(1) - 1)
            .filter(|&k| {
                let [a, s, b] = [k - 1, k, k + 1].map(|k| points[k][1]);
                // Into a crease s falls, at equal steps, no further below the middle one than by the larger difference; into a parabola by at
                // most an eighth of their sum. A level stretch, as on a flat, has no lower place.
                let [before, after] = [a - s, b - s];
                before >= 0.0 && after >= 0.0 && before.max(after) > ROUNDING.max(s - approach)
            })
            .collect();
        for k in dips.into_iter().rev() {
            let slope = |eta: f64| self.level.slope(xi, eta);
            let eta = change(slope, [points[k - 1][0], points[k + 1][0]], TO_LOWEST);
            let (s, at) = (self.separation(xi, eta), k + usize::from(eta > points[k][0]));
            if s < points[k][1] {
                points.insert(at, [eta, s]);
            }
        }
        let mut slices: Vec<LineSlice> = Vec::new();
        let mut open: Option<LineSlice> = None;
        for k in 0..points.len() {
            let [eta, s] = points[k];
            let inside = s < approach;
            if inside && open.is_none() {
                let from = if k == 0 { eta } else { self.edge(xi, eta, points[k - 1][0]) };
                open = Some(LineSlice {
                    eta: Interval::new(from, eta),
                    kinds: [CrossingKind::Root; 2],
                    lowest: [eta, s],
                });
            }
            if let Some(found) = open.as_mut().filter(|_| inside) {
                found.eta.high = eta;
                if s < found.lowest[1] {
                    found.lowest = [eta, s];
                }
            }
            if let Some(mut found) = open.take_if(|_| !inside) {
                found.eta.high = self.edge(xi, points[k - 1][0], eta);
                slices.push(found);
            }
        }
        slices.extend(open);
        slices.retain(|found| approach - found.lowest[1] > ROUNDING);
        SlicedLine { xi, slices, crossings: Vec::new(), follows: false }
    }

    /// Finds the end of an interval between a place inside and one outside.
    fn edge(&mut self, xi: f64, inside: f64, outside: f64) -> f64 {
        let approach = self.approach;
        change(|eta| self.separation(xi, eta) - approach, [inside, outside], TO_EDGE)
    }
}

impl BySamples<'_> {
    /// Finds ξ \[mm\] of the least s of a lane: where s turns next to the deepest of its lines.
    pub(in crate::patch) fn least(&mut self, lane: &Lane) -> Option<f64> {
        let depth = |row: &LaneRow| row.slice.lowest[1];
        let order = |p: &usize, q: &usize| depth(&lane.rows[*p]).total_cmp(&depth(&lane.rows[*q]));
        let at = (0..lane.rows.len()).min_by(order)?;
        let deepest = &lane.rows[at];
        let (Some(from), Some(to)) =
            (at.checked_sub(1).and_then(|k| lane.rows.get(k)), lane.rows.get(at + 1))
        else {
            return Some(deepest.xi);
        };
        let slope = |xi: f64| {
            let eta = self.lowest(xi, Some(lane));
            self.level.gradient(xi, eta)[0]
        };
        let turn = change(slope, [from.xi, to.xi], TO_LOWEST);
        // A crease, where s does not turn, may be deeper.
        let eta = self.lowest(turn, Some(lane));
        Some(if self.separation(turn, eta) < depth(deepest) { turn } else { deepest.xi })
    }
}

/// Returns whether the intervals of two lines correspond one to one, and none has an end that moves by more than a step \[mm\] and
/// [`STEEPEST`] times the distance of the lines: another interval may begin and join it in between.
fn answer([a, b]: [&SlicedLine; 2], step: f64) -> bool {
    let (count, farthest) = (a.slices.len(), step.max(STEEPEST * (b.xi - a.xi)));
    let near = |[i, j]: &[usize; 2]| {
        let [from, to] = [a.slices[*i].eta, b.slices[*j].eta];
        i == j && (0..2).all(|end| (to[end] - from[end]).abs() <= farthest)
    };
    count == b.slices.len() && {
        let links = b.links(a);
        links.len() == count && links.iter().all(near)
    }
}

/// Adds points over an interval of η and beyond its ends.
fn spread(eta: Interval, out: &mut Vec<f64>) {
    let wide = eta.grown(BEYOND * eta.width());
    out.extend((0..=POINTS).map(|k| wide.step(k, POINTS)));
}

/// Lists places in steps over an interval, with its ends; nearer to each other around 0 if that lies inside.
fn places(over: Interval, step: f64) -> Vec<f64> {
    let count = (over.width() / step).ceil().max(1.0) as usize;
    let mut out: Vec<f64> = (0..=count).map(|k| over.step(k, count)).collect();
    out.push(0.0);
    out.extend((0..HALVINGS).flat_map(|k| [1.0, -1.0].map(|sign| sign * step * 0.5f64.powi(k))));
    out.retain(|place| over.contains(*place));
    out.sort_by(f64::total_cmp);
    out.dedup();
    out
}

/// Returns the distance of two lines at which none is laid between them \[mm\].
fn nearest(from: f64, to: f64) -> f64 {
    NEAREST * from.abs().max(to.abs()).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_hold_both_ends_whatever_the_rounding() {
        for k in 0..1000 {
            let ends = [-40.0 - 0.017 * f64::from(k), 15.0 + 0.0131 * f64::from(k)];
            let places = places(ends.into(), STEP);
            assert_eq!([places[0], places[places.len() - 1]], ends);
            assert!(places.windows(2).all(|pair| pair[0] < pair[1] && pair[1] - pair[0] < STEP + 1e-12));
        }
    }
}
