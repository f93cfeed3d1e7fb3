//! The parts of the patch under a skewed wheel, where a line of constant ξ may meet it in several intervals of η.
//!
//! Every interval holds a valley of the wheel. Between neighbouring ξ at which a valley or ridge begins, ends, turns or
//! passes s = δ, the intervals stay as they are; from one such stretch of ξ to the next they go on, divide or join.

use super::components::least;
use super::outline::{End, Outline, Part, SEARCHED_INTERVALS, ascending};
use crate::numerics::roots::{bracketed, last_where};

/// Share of R within which a valley that begins at the edge of an interval belongs to it: where lines of constant ξ only
/// touch the wheel's end, the edge is known to the root of rounding, 1.5e-8. Intervals that are nearer than this count as one.
const TOUCH: f64 = 1e-6;

/// A part that goes on, with the valleys in it.
struct Lane {
    part: Part,
    valleys: Vec<usize>,
}

/// A valley inside the patch at one ξ.
#[derive(Clone, Copy)]
struct Inside {
    /// Its place \[mm\].
    eta: f64,
    /// s − δ \[mm\].
    depth: f64,
    crease: usize,
}

/// Where a valley or ridge passes s = δ.
#[derive(Default)]
struct Events {
    xi: Vec<f64>,
    /// Those of them at which its place is inside the window …
    tips: Vec<f64>,
    /// … and those at which it is outside.
    cuts: Vec<f64>,
}

impl Outline<'_> {
    /// The parts under a skewed wheel, by ascending ξ.
    pub(super) fn skewed_parts(&mut self) -> Vec<Part> {
        let Some([a, b]) = self.searched() else { return Vec::new() };
        let nodes = self.nodes(a, b);
        let events = self.events(&nodes);
        let all = ascending([&nodes[..], &events.xi].concat());
        let (mut parts, mut lanes): (Vec<Part>, Vec<Lane>) = (Vec::new(), Vec::new());
        for pair in all.windows(2) {
            let groups = self.groups(pair[0] + (pair[1] - pair[0]) / 2.0);
            let links = self.links(pair[0], &lanes, &groups);
            lanes = self.go_on(&events, [pair[0], pair[1]], lanes, groups, &links, &mut parts);
        }
        let end = self.end_at(b, &events);
        parts.extend(lanes.into_iter().map(|lane| closed(lane, b, end)));
        parts.sort_by(|p, q| p.xi[0].total_cmp(&q.xi[0]));
        parts
    }

    /// The interval of ξ in which the rail, the window and any valley are.
    fn searched(&self) -> Option<[f64; 2]> {
        let reach = self.slicer.placement().rail.section.reach()?;
        let creases = &self.slicer.valleys.as_ref()?.creases;
        let valleys = || creases.iter().filter(|crease| crease.is_valley);
        let first = valleys().map(|crease| crease.xi[0]).fold(f64::INFINITY, f64::min);
        let last = valleys().map(|crease| crease.xi[1]).fold(f64::NEG_INFINITY, f64::max);
        let [a, b] = self.window.xi;
        let ends = [a.max(reach[0]).max(first), b.min(reach[1]).min(last)];
        (ends[0] < ends[1]).then_some(ends)
    }

    /// ξ between which no valley or ridge begins or ends, and the depth over each is monotone.
    fn nodes(&mut self, a: f64, b: f64) -> Vec<f64> {
        let step = (b - a) / SEARCHED_INTERVALS as f64;
        let mut nodes = vec![a, b];
        nodes.extend((1..SEARCHED_INTERVALS).map(|k| a + step * k as f64));
        nodes.extend(self.slicer.placement().joints(a, b));
        let extents = self.extents();
        let steps =
            self.slicer.valleys.iter().flat_map(|valleys| &valleys.creases).flat_map(|crease| &crease.steps);
        nodes.extend(extents.iter().flatten().chain(steps).filter(|&&xi| xi > a && xi < b));
        let nodes = ascending(nodes);
        let mut all = nodes.clone();
        for (k, extent) in extents.iter().enumerate() {
            all.extend(self.turning_points_among(Some(k), within(&nodes, extent)));
        }
        ascending(all)
    }

    /// The intervals of ξ of all valleys and ridges.
    fn extents(&self) -> Vec<[f64; 2]> {
        self.slicer.valleys.iter().flat_map(|valleys| &valleys.creases).map(|crease| crease.xi).collect()
    }

    fn events(&mut self, nodes: &[f64]) -> Events {
        let mut events = Events::default();
        for (k, extent) in self.extents().iter().enumerate() {
            for pair in within(nodes, extent).windows(2) {
                let ends = [pair[0].next_up(), pair[1]];
                let inside = ends.map(|xi| self.depth_over(k, xi) < 0.0);
                if inside[0] == inside[1] {
                    continue;
                }
                let Some(xi) = bracketed(|xi| self.depth_over(k, xi), ends[0], ends[1]) else {
                    let (on, off) = if inside[0] { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
                    events.xi.push(last_where(|xi| self.depth_over(k, xi) < 0.0, on, off));
                    continue;
                };
                let place = self.slicer.spot(k, xi).eta;
                let seen = self.window.eta[0] <= place && place <= self.window.eta[1];
                (if seen { &mut events.tips } else { &mut events.cuts }).push(xi);
                events.xi.push(xi);
            }
        }
        events
    }

    /// s − δ at the place of a valley or ridge, or next to it in the window; infinite where s rises above δ on the way
    /// there.
    fn depth_over(&mut self, crease: usize, xi: f64) -> f64 {
        let (spot, floor) = (self.slicer.spot(crease, xi), self.floor(Some(crease), xi));
        if spot.eta == floor || floor.is_nan() {
            return self.slicer.depth_at(xi, &spot);
        }
        let edges = self.slicer.skewed_edges(xi, crease);
        let reached = edges.is_some_and(|[low, high]| low.eta <= floor && floor <= high.eta);
        if reached { self.slicer.separation(xi, floor) - self.slicer.approach } else { f64::INFINITY }
    }

    /// The valleys inside at ξ, those of one interval together.
    fn groups(&mut self, xi: f64) -> Vec<Vec<usize>> {
        let valleys = self.slicer.valleys_over(xi);
        let mut inside: Vec<Inside> = valleys
            .into_iter()
            .map(|crease| {
                let (eta, depth) = (self.slicer.spot(crease, xi).eta, self.depth_over(crease, xi));
                Inside { eta, depth, crease }
            })
            .filter(|valley| valley.depth < 0.0)
            .collect();
        inside.sort_by(|a, b| a.eta.total_cmp(&b.eta));
        let mut groups: Vec<Vec<Inside>> = Vec::new();
        let near = TOUCH * self.slicer.placement().rolling_radius();
        // Upper edge of the interval of the last group.
        let mut reached = f64::NEG_INFINITY;
        for valley in &inside {
            match groups.last_mut().filter(|_| valley.eta <= reached) {
                Some(group) => group.push(*valley),
                None => {
                    groups.push(vec![*valley]);
                    if inside.len() > 1 {
                        let edges = self.slicer.skewed_edges(xi, valley.crease);
                        reached = edges.map_or(reached, |[_, high]| high.eta + near);
                    }
                }
            }
        }
        let deepest_first = |mut group: Vec<Inside>| {
            group.sort_by(|a, b| a.depth.total_cmp(&b.depth));
            group.into_iter().map(|valley| valley.crease).collect()
        };
        groups.into_iter().map(deepest_first).collect()
    }

    /// Which lane goes on in which group at ξ: \[lane, group\].
    fn links(&mut self, xi: f64, lanes: &[Lane], groups: &[Vec<usize>]) -> Vec<[usize; 2]> {
        let mut links = Vec::new();
        for (i, lane) in lanes.iter().enumerate() {
            let shared = |group: &Vec<usize>| group.iter().any(|k| lane.valleys.contains(k));
            links.extend((0..groups.len()).filter(|&j| shared(&groups[j])).map(|j| [i, j]));
        }
        let known = links.clone();
        let alone = |side: usize, k: usize| !known.iter().any(|link| link[side] == k);
        for (i, lane) in lanes.iter().enumerate() {
            for (j, group) in groups.iter().enumerate() {
                let begins = alone(1, j) && self.touch(xi, group, &lane.valleys);
                if begins || (alone(0, i) && self.touch(xi, &lane.valleys, group)) {
                    links.push([i, j]);
                }
            }
        }
        links
    }

    /// Whether one of the valleys that begin or end at ξ does so in the interval of others.
    fn touch(&mut self, xi: f64, valleys: &[usize], others: &[usize]) -> bool {
        let near = TOUCH * self.slicer.placement().rolling_radius();
        let Some([low, high]) = others.first().and_then(|&other| self.slicer.skewed_edges(xi, other)) else {
            return false;
        };
        valleys.iter().any(|&k| {
            let eta = self.slicer.spot(k, xi).eta;
            low.eta - near <= eta && eta <= high.eta + near && self.depth_over(k, xi) < 0.0
        })
    }

    /// The lanes over a stretch of ξ after those before it; parts that end there are added.
    fn go_on(
        &mut self,
        events: &Events,
        [from, to]: [f64; 2],
        lanes: Vec<Lane>,
        groups: Vec<Vec<usize>>,
        links: &[[usize; 2]],
        parts: &mut Vec<Part>,
    ) -> Vec<Lane> {
        let end = self.end_at(from, events);
        let count = |side: usize, k: usize| links.iter().filter(|link| link[side] == k).count();
        let mut kept: Vec<Option<Lane>> = groups.iter().map(|_| None).collect();
        for (i, lane) in lanes.into_iter().enumerate() {
            match links.iter().find(|link| link[0] == i) {
                Some(&[_, j]) if count(0, i) == 1 && count(1, j) == 1 => kept[j] = Some(lane),
                Some(_) => parts.push(closed(lane, from, End::Fork)),
                None => parts.push(closed(lane, from, end)),
            }
        }
        let going = groups.into_iter().zip(kept).enumerate().map(|(j, (group, lane))| {
            let begin = if count(1, j) == 0 { end } else { End::Fork };
            let fresh = || Part { xi: [from; 2], ends: [begin; 2], valleys: Vec::new() };
            let mut part = lane.map_or_else(fresh, |lane| lane.part);
            match part.valleys.last_mut().filter(|(_, valleys)| *valleys == group) {
                Some((end, _)) => *end = to,
                None => part.valleys.push((to, group.clone())),
            }
            Lane { part, valleys: group }
        });
        going.collect()
    }

    /// What bounds a part that begins or ends at ξ without a fork.
    fn end_at(&self, xi: f64, events: &Events) -> End {
        if events.tips.contains(&xi) {
            End::Tip
        } else if self.window.xi.contains(&xi) || events.cuts.contains(&xi) {
            End::Window
        } else {
            End::ProfileEnd
        }
    }

    /// Where the depth over one of a part's valleys turns between its ascending ξ.
    pub(super) fn turning_points_of(&mut self, part: &Part, nodes: &[f64]) -> Vec<f64> {
        if part.valleys.is_empty() {
            return self.turning_points_among(None, nodes);
        }
        let mut valleys: Vec<usize> = part.valleys.iter().flat_map(|(_, valleys)| valleys).copied().collect();
        valleys.sort_unstable();
        valleys.dedup();
        let extents = self.extents();
        valleys
            .into_iter()
            .flat_map(|k| self.turning_points_among(Some(k), within(nodes, &extents[k])))
            .collect()
    }

    /// \[s, ξ, η\] of the smallest s of a part at ξ.
    pub(super) fn deepest_at(&mut self, part: &Part, xi: f64) -> [f64; 3] {
        let valleys = part.valleys_at(xi).iter().map(|&k| Some(k));
        let creases: Vec<Option<usize>> =
            if part.valleys.is_empty() { vec![None] } else { valleys.collect() };
        let values = creases.into_iter().map(|crease| {
            let floor = self.floor(crease, xi);
            let floor = self.slicer.on_surface(xi, floor);
            [self.slicer.separation(xi, floor), xi, floor]
        });
        least(values).unwrap_or([f64::NAN, xi, 0.0])
    }
}

fn closed(lane: Lane, xi: f64, end: End) -> Part {
    let Part { xi: [from, _], ends: [begin, _], valleys } = lane.part;
    Part { xi: [from, xi], ends: [begin, end], valleys }
}

/// The nodes over an interval.
fn within<'n>(nodes: &'n [f64], [from, to]: &[f64; 2]) -> &'n [f64] {
    &nodes[nodes.partition_point(|xi| xi < from)..nodes.partition_point(|xi| xi <= to)]
}
