//! Finds the bands of a patch under a skewed wheel, beyond the end of a tilted one, or over the rail's surface, where a line of constant ξ
//! or σ may meet the patch in several intervals of η.
//!
//! Every interval holds a valley of the wheel. An event is a ξ at which a valley or ridge begins, ends or passes s = δ, or
//! at which the rail or its raised curve steps. Between two events the intervals persist; at an event they continue, divide or join.

use super::events::{Events, events};
use super::slicer::NEAR_GUESS;
use crate::numerics::interval::Interval;
use crate::patch::band::{Band, Turn};
use crate::patch::end::End;
use crate::patch::level::steps;
use crate::patch::outline::Outline;

/// Distance, as a share of R, within which a valley at the edge of an interval belongs to the interval, and within which
/// two intervals are one. Where lines of constant ξ only touch the wheel's end, the edge is known only to the square root
/// of rounding, 1.5e-8.
const TOUCH: f64 = 1e-6;

/// Distance from the ends of a stretch, as a share of the stretch, at which its intervals are found. Where two intervals
/// meet at an end, their edges are square roots: at this distance they are a thousandth of their width apart.
const INSIDE: f64 = 1e-6;

/// Distance, in roundings of R, below which two events are one. Between closer events rounding decides what is inside, and
/// there may be no other ξ.
const XI_ROUNDINGS: f64 = 64.0;

/// The valleys of one interval, the deepest first.
type ValleyGroup = Vec<usize>;

/// A band that is not finished yet.
struct Lane {
    band: Band,
    /// The valleys of its interval over the last stretch.
    group: ValleyGroup,
    /// The interval of η near the end of the last stretch \[mm\].
    edge: Interval,
}

/// A valley inside the patch at one ξ.
#[derive(Clone, Copy)]
struct Inside {
    /// Place of the valley \[mm\].
    eta: f64,
    /// s − δ at the place \[mm\].
    depth: f64,
    crease: usize,
}

/// Walks over the stretches by ascending ξ and builds the bands.
struct LaneWalk<'w, 'a> {
    outline: &'w mut Outline<'a>,
    events: Events,
    lanes: Vec<Lane>,
    done: Vec<Band>,
}

/// Returns the bands, and the places at which s may be least.
pub(in crate::patch) fn bands(outline: &mut Outline<'_>) -> (Vec<Band>, Vec<Turn>) {
    let Some(over) = searched(outline) else { return (Vec::new(), Vec::new()) };
    let mut events = events(outline, over);
    let turns = std::mem::take(&mut events.turns);
    let placement = outline.slicer.placement();
    let extent = placement.rail().profile().extent().max(placement.wheel().profile().extent());
    let raised = outline.slicer.in_valleys.as_ref().map(|in_valleys| &in_valleys.raised);
    let rail_steps = match raised.filter(|raised| raised.surface.is_some()) {
        Some(raised) => raised.jumps(over),
        None => steps(&placement.rail().section, over, extent).collect(),
    };
    let mut all = [&events.xi[..], &rail_steps, &over.ends()].concat();
    all.sort_by(f64::total_cmp);
    all.dedup();
    let mut walk = LaneWalk { outline, events, lanes: Vec::new(), done: Vec::new() };
    let shortest = XI_ROUNDINGS * f64::EPSILON * placement.rolling_radius();
    for pair in all.windows(2).filter(|pair| pair[1] - pair[0] > shortest) {
        let groups = groups(walk.outline, pair[0] + (pair[1] - pair[0]) / 2.0);
        walk.step(Interval::new(pair[0], pair[1]), groups, rail_steps.contains(&pair[0]));
    }
    walk.step(Interval::of(over.high), Vec::new(), false);
    (walk.done, turns)
}

/// Returns the range of ξ that the rail, the window and, over the tangent plane, the valleys have in common; `None` if it is empty.
fn searched(outline: &Outline<'_>) -> Option<Interval> {
    let in_valleys = outline.slicer.in_valleys.as_ref()?;
    let mut over = outline.window.xi.cut(in_valleys.raised.reach()?);
    if !outline.slicer.is_over_rail() {
        let valleys = in_valleys.valleys.creases.iter().filter(|crease| crease.is_valley);
        over = over.cut(valleys.fold(Interval::NONE, |under, crease| under.hull(crease.xi)));
    }
    Some(over).filter(|over| over.has_width())
}

/// Returns the valleys inside the patch at ξ, grouped by interval, the groups by ascending η.
fn groups(outline: &mut Outline<'_>, xi: f64) -> Vec<ValleyGroup> {
    let near = TOUCH * outline.slicer.placement().rolling_radius();
    let Some(in_valleys) = &outline.slicer.in_valleys else { return Vec::new() };
    let over: Vec<usize> = in_valleys.over(xi).filter(|&k| in_valleys.valleys.creases[k].is_valley).collect();
    let places = over.into_iter().map(|crease| {
        let depth = outline.depth(Some(crease), xi);
        Inside { eta: outline.slicer.valley(Some(crease), xi), depth, crease }
    });
    let mut inside: Vec<Inside> = places.filter(|valley| valley.depth < 0.0).collect();
    inside.sort_by(|a, b| a.eta.total_cmp(&b.eta));
    let mut groups: Vec<Vec<Inside>> = Vec::new();
    // This is the upper edge of the previous group's interval.
    let mut reached = f64::NEG_INFINITY;
    for valley in &inside {
        match groups.last_mut().filter(|_| valley.eta <= reached) {
            Some(group) => group.push(*valley),
            None => {
                groups.push(vec![*valley]);
                if inside.len() > 1 {
                    let edges = outline.slicer.edges(xi, Some(valley.crease));
                    reached = edges.map_or(reached, |[_, high]| high + near);
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

impl LaneWalk<'_, '_> {
    /// Handles the event at the beginning of a stretch. Continues or opens a band for each group of the stretch.
    fn step(&mut self, over: Interval, groups: Vec<ValleyGroup>, rail_steps: bool) {
        let (Interval { low: from, high: to }, inside) = (over, INSIDE * over.width());
        let begins: Vec<Interval> = groups.iter().map(|group| self.interval(group, from + inside)).collect();
        let lanes = std::mem::take(&mut self.lanes);
        let links: Vec<[usize; 2]> = (0..lanes.len())
            .flat_map(|i| (0..groups.len()).map(move |j| [i, j]))
            .filter(|&[i, j]| {
                let shared = groups[j].iter().any(|k| lanes[i].group.contains(k));
                shared || lanes[i].edge.overlaps(begins[j])
            })
            .collect();
        let partners = |side: usize, k: usize| -> Vec<usize> {
            links.iter().filter(|link| link[side] == k).map(|link| link[1 - side]).collect()
        };
        let (mut kept, mut sides): (Vec<Option<Band>>, Vec<Option<Interval>>) =
            (vec![None; groups.len()], vec![None; groups.len()]);
        let mut closing: Vec<(Lane, Option<Interval>)> = Vec::new();
        let forks = if rail_steps { Vec::new() } else { self.forks(from, &lanes, &groups, &begins, &links) };
        for (i, lane) in lanes.into_iter().enumerate() {
            match partners(0, i)[..] {
                [j] if !rail_steps && partners(1, j).len() == 1 => kept[j] = Some(lane.band),
                _ => {
                    let side = forks.iter().find(|fork| fork.0 == 0 && fork.1 == i).map(|fork| fork.2);
                    closing.push((lane, side));
                }
            }
        }
        for (side, index, eta) in forks {
            if side == 1 {
                sides[index] = Some(eta);
            }
        }
        let ended: Vec<Band> =
            closing.into_iter().map(|(lane, side)| self.closed(lane, from, side)).collect();
        let mut lanes = Vec::new();
        for (j, group) in groups.into_iter().enumerate() {
            let mut band = kept[j].take().unwrap_or_else(|| {
                self.opened(&group, from, sides[j], if rail_steps { from.next_up() } else { from })
            });
            match band.valleys.last_mut().filter(|(_, valleys)| *valleys == group) {
                Some((end, _)) => *end = to,
                None => band.valleys.push((to, group.clone())),
            }
            let edge = self.interval(&group, to - inside);
            lanes.push(Lane { band, group, edge });
        }
        self.lanes = lanes;
        self.done.extend(ended);
    }

    /// Returns the interval of a group at ξ \[mm\]; NaN outside the patch.
    fn interval(&mut self, group: &ValleyGroup, xi: f64) -> Interval {
        let edges = self.outline.edges(group.first().copied(), xi);
        edges.map_or(Interval::of(f64::NAN), Interval::from)
    }

    /// Returns the sides of the lanes (0) and groups (1) that meet at an event where one interval divides or several join.
    /// Neighbours meet there on a ridge or on the circle of an end.
    fn forks(
        &mut self,
        xi: f64,
        lanes: &[Lane],
        groups: &[ValleyGroup],
        begins: &[Interval],
        links: &[[usize; 2]],
    ) -> Vec<(usize, usize, Interval)> {
        let mut sides = Vec::new();
        let counts = [lanes.len(), groups.len()];
        for whole in 0..2 {
            for k in 0..counts[whole] {
                let mut parts: Vec<usize> =
                    links.iter().filter(|link| link[whole] == k).map(|link| link[1 - whole]).collect();
                let only = |part: &usize| links.iter().filter(|l| l[1 - whole] == *part).count() == 1;
                if parts.len() < 2 || !parts.iter().all(only) {
                    continue;
                }
                let interval = |part: usize| if whole == 0 { begins[part] } else { lanes[part].edge };
                parts.sort_by(|&p, &q| interval(p).low.total_cmp(&interval(q).low));
                let (first, last) = (parts[0], parts[parts.len() - 1]);
                let group = |part: usize| if whole == 0 { &groups[part] } else { &lanes[part].group };
                let (low, high) = (group(first).clone(), group(last).clone());
                let mut cuts = vec![self.outer(&low, xi, interval(first), 0)];
                for pair in parts.windows(2) {
                    cuts.push(self.meeting_point(xi, [interval(pair[0]).high, interval(pair[1]).low]));
                }
                cuts.push(self.outer(&high, xi, interval(last), 1));
                sides.push((whole, k, Interval::new(cuts[0], cuts[parts.len()])));
                let side = |cut: &[f64]| Interval::new(cut[0], cut[1]);
                sides.extend(parts.iter().zip(cuts.windows(2)).map(|(&p, cut)| (1 - whole, p, side(cut))));
            }
        }
        sides
    }

    /// Returns the lower (0) or upper (1) edge of a group at ξ \[mm\], near that of its interval next to ξ.
    fn outer(&mut self, group: &ValleyGroup, xi: f64, beside: Interval, side: usize) -> f64 {
        let near = |eta: &f64| (eta - beside[side]).abs() <= NEAR_GUESS * beside.width();
        let found = self.outline.edges(group.first().copied(), xi).map(|edges| edges[side]).filter(near);
        // Where the line only touches the circle of an end, rounding may end the surface there.
        let again = || self.outline.slicer.edge_near(xi, beside.ends(), side);
        let window = self.outline.window.eta;
        found.or_else(again).map_or(beside[side], |eta| window.nearest(eta))
    }

    /// Returns η at which two intervals meet: on a ridge or the circle of an end between them, or else half-way.
    fn meeting_point(&self, xi: f64, [from, to]: [f64; 2]) -> f64 {
        let middle = from + (to - from) / 2.0;
        let Some(in_valleys) = &self.outline.slicer.in_valleys else { return middle };
        let ridges = in_valleys.over(xi).filter(|&k| !in_valleys.valleys.creases[k].is_valley);
        let places = ridges.map(|k| in_valleys.spot(k, xi).eta).chain(in_valleys.rims(xi));
        let between = places.filter(|&eta| Interval::between(from, to).contains(eta));
        let nearest = between.min_by(|p, q| (p - middle).abs().total_cmp(&(q - middle).abs()));
        nearest.unwrap_or(middle)
    }

    /// Returns the finished band of a lane that ends at ξ.
    fn closed(&mut self, lane: Lane, xi: f64, fork: Option<Interval>) -> Band {
        let Lane { mut band, group, edge } = lane;
        let (side, end) = self.end(&group, xi, xi, edge);
        band.xi.high = xi;
        band.sides[1] = fork.unwrap_or(side);
        band.ends[1] = fork.is_none().then_some(end);
        band
    }

    /// Returns a new band that begins at ξ. Its slice is taken at `at`, which is ξ or the next number.
    fn opened(&mut self, group: &ValleyGroup, xi: f64, fork: Option<Interval>, at: f64) -> Band {
        let (side, end) = self.end(group, xi, at, Interval::of(f64::NAN));
        let ends = [fork.is_none().then_some(end), None];
        Band::new(Interval::of(xi), ends, [fork.unwrap_or(side); 2], self.outline.window.eta)
    }

    /// Returns the side of a band that begins or ends at ξ without a fork, and what bounds the band.
    fn end(&mut self, group: &ValleyGroup, xi: f64, at: f64, inside: Interval) -> (Interval, End) {
        let valley = group.first().copied();
        let end = self.end_at(xi);
        let edges = self.outline.edges(valley, at).filter(|_| end != End::Tip);
        let [_, _, lowest] = self.outline.lowest(valley, at);
        let side = match edges {
            Some(edges) => edges.into(),
            None if end == End::Tip || inside.low.is_nan() => Interval::of(lowest),
            None => inside,
        };
        (side, end)
    }

    /// Returns what bounds a band that begins or ends at ξ without a fork.
    fn end_at(&self, xi: f64) -> End {
        if self.events.tips.contains(&xi) {
            End::Tip
        } else if self.outline.window.xi.ends().contains(&xi) || self.events.cuts.contains(&xi) {
            End::Window
        } else {
            End::ProfileEnd
        }
    }
}
