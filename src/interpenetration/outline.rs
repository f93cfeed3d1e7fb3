//! The patch inside a window, one ξ at a time, and the intervals of ξ that its parts cover.

use serde::Serialize;

use super::slice::{Edge, Slice, Slicer};
use crate::contact::feasibility::critical_points;
use crate::numerics::roots::{bracketed, last_where};
use crate::placement::Placement;

/// Intervals in which stationary points of the depth are looked for where they have no closed form (skew, or a
/// window off the midplane): a part is missed only if two of them fall into one interval.
pub(super) const SEARCHED_INTERVALS: usize = 512;

/// Share of a part's length by which its slice at a fork is taken inside: its end is then drawn to 1e-4 of its width.
const FORK_SHARE: f64 = 1e-8;

/// The rectangle of the ξ–η plane that is looked at \[mm\].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Window {
    /// Range of ξ.
    pub xi: [f64; 2],
    /// Range of η.
    pub eta: [f64; 2],
}

impl Window {
    /// The whole plane: nothing but the bodies' own ends bounds the patch.
    pub const UNBOUNDED: Self =
        Self { xi: [f64::NEG_INFINITY, f64::INFINITY], eta: [f64::NEG_INFINITY, f64::INFINITY] };
}

/// What bounds a component at one of its ends in ξ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// The two branches meet where s(ξ, η) = δ in a single point.
    Tip,
    /// The window cuts it.
    Window,
    /// One of the bodies ends, or steps back from the other behind an overhang.
    ProfileEnd,
    /// The patch goes on in other components: beside a skewed wheel's end, or over a ridge of it, lines of constant ξ
    /// meet it in several intervals.
    Fork,
}

/// An interval of ξ over which the patch, or one of several intervals of η of it, has a width.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Part {
    pub(crate) xi: [f64; 2],
    pub(crate) ends: [End; 2],
    /// With skew, by ascending ξ: the valleys that lie in it up to that ξ, of which the first, the deepest one, leads to
    /// its slices.
    pub(super) valleys: Vec<(f64, Vec<usize>)>,
}

impl Part {
    fn plain(xi: [f64; 2], ends: [End; 2]) -> Self {
        Self { xi, ends, valleys: Vec::new() }
    }

    /// The valleys at ξ; none without skew.
    pub(super) fn valleys_at(&self, xi: f64) -> &[usize] {
        let k = self.valleys.partition_point(|(to, _)| *to < xi).min(self.valleys.len().saturating_sub(1));
        self.valleys.get(k).map_or(&[], |(_, valleys)| valleys)
    }

    /// ξ, or next to it where the part ends in a fork, at which its slice cannot be told from those of others.
    pub(super) fn beside_fork(&self, xi: f64) -> f64 {
        let beside = FORK_SHARE * (self.xi[1] - self.xi[0]);
        let steps = [beside, -beside];
        let fork = (0..2).find(|&k| self.ends[k] == End::Fork && self.xi[k] == xi);
        fork.map_or(xi, |k| xi + steps[k])
    }

    /// The valley by which its slice at ξ is found; `None` without skew.
    pub(super) fn valley(&self, xi: f64) -> Option<usize> {
        self.valleys_at(xi).first().copied()
    }
}

/// Slices of the patch {s < δ} that end at a window.
#[derive(Debug)]
pub struct Outline<'a> {
    pub(super) slicer: Slicer<'a>,
    pub(super) window: Window,
}

impl<'a> Outline<'a> {
    /// The outline of a placed pair's patch at approach δ \[mm\] inside a window.
    pub fn new(placement: &'a Placement, approach: f64, window: &Window) -> Self {
        Self { slicer: Slicer::new(placement, approach), window: *window }
    }

    /// The interval of η of a part at ξ inside the window, or `None` outside the patch.
    pub(crate) fn slice(&mut self, part: &Part, xi: f64) -> Option<Slice> {
        let [low, high] = self.edges(part.valley(xi), xi)?;
        Some(Slice { eta: [low.eta, high.eta] })
    }

    /// Both ends of the slice.
    pub(super) fn edges(&mut self, valley: Option<usize>, xi: f64) -> Option<[Edge; 2]> {
        let [mut low, mut high] = self.slicer.edges(xi, valley)?;
        let [from, to] = self.window.eta;
        if low.eta < from {
            low = Edge { eta: from, ledge: false };
        }
        if high.eta > to {
            high = Edge { eta: to, ledge: false };
        }
        (low.eta <= high.eta).then_some([low, high])
    }

    /// The slice at ξ of a part: of no width at its tips, and where rounding finds none beside them.
    pub(crate) fn slice_of(&mut self, part: &Part, at: f64) -> Slice {
        let tip = (0..2).any(|k| at == part.xi[k] && part.ends[k] == End::Tip);
        if let Some(slice) = self.slice(part, part.beside_fork(at)).filter(|_| !tip) {
            return slice;
        }
        let floor = self.floor(part.valley(at), at);
        Slice { eta: [self.slicer.on_surface(at, floor); 2] }
    }

    /// η of the least s at ξ, over a valley if there is one, within the window: s only rises to both sides of it.
    pub(super) fn floor(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        let ([from, to], lowest) = (self.window.eta, valley.map_or(0.0, |k| self.slicer.spot(k, xi).eta));
        // NaN, where there is no surface, stays NaN.
        if lowest < from {
            from
        } else if lowest > to {
            to
        } else {
            lowest
        }
    }

    /// s(ξ, η) \[mm\].
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.slicer.separation(xi, eta)
    }

    /// Whether the least s is on the midplane, where its stationary points have a closed form.
    fn plain(&self) -> bool {
        self.slicer.placement().skew == 0.0 && self.window.eta[0] <= 0.0 && self.window.eta[1] >= 0.0
    }

    /// min over the window's η of s − δ, without skew.
    pub(super) fn depth(&mut self, xi: f64) -> f64 {
        if self.plain() {
            return self.slicer.depth(xi);
        }
        let floor = self.floor(None, xi);
        self.slicer.separation(xi, floor) - self.slicer.approach
    }

    /// d(depth)/dξ: the floor's own motion does not count, since s_η or the motion is zero there.
    fn depth_slope(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        let floor = self.floor(valley, xi);
        match valley {
            Some(valley) if self.slicer.spot(valley, xi).eta == floor => {
                self.slicer.depth_slope_of(valley, xi)
            }
            _ => self.slicer.gradient(xi, floor)[0],
        }
    }

    /// a, b and ξ between them such that the depth is monotone between neighbours: joints and stationary points.
    fn turning_points(&mut self, a: f64, b: f64) -> Vec<f64> {
        let mut points = critical_points(self.slicer.placement(), a, b);
        if self.plain() {
            return points;
        }
        let step = (b - a) / SEARCHED_INTERVALS as f64;
        points.extend((1..SEARCHED_INTERVALS).map(|k| a + step * k as f64));
        points.sort_by(f64::total_cmp);
        points.extend(self.turning_points_among(None, &points));
        ascending(points)
    }

    /// Where the depth, over a valley or ridge if one is given, turns between neighbours of ascending `nodes`.
    pub(super) fn turning_points_among(&mut self, crease: Option<usize>, nodes: &[f64]) -> Vec<f64> {
        if self.plain() {
            return critical_points(self.slicer.placement(), nodes[0], nodes[nodes.len() - 1]);
        }
        let turn = |pair: &[f64]| bracketed(|xi| self.depth_slope(crease, xi), pair[0].next_up(), pair[1]);
        nodes.windows(2).filter_map(turn).collect()
    }

    /// The intervals of ξ that the components cover, ascending.
    ///
    /// At a joint the gap may step (a drawing's rounded coordinates, an overhang): every interval between
    /// turning points is judged by its own side's values at both ends.
    pub(super) fn parts(&mut self) -> Vec<Part> {
        if self.slicer.placement().skew != 0.0 {
            return self.skewed_parts();
        }
        let Some([first, last]) = self.slicer.placement().overlap() else { return Vec::new() };
        let [a, b] = [first.max(self.window.xi[0]), last.min(self.window.xi[1])];
        if a.is_nan() || b.is_nan() || a >= b {
            return Vec::new();
        }
        let mut parts = Vec::new();
        let mut begun: Option<(f64, End)> = None;
        for pair in self.turning_points(a, b).windows(2) {
            let (p, q) = (pair[0].next_up(), pair[1]);
            let inside = [p, q].map(|xi| self.depth(xi) < 0.0);
            let step = if pair[0] == a && a != first { End::Window } else { End::ProfileEnd };
            begun = match (begun, inside[0]) {
                (Some((from, start)), false) => {
                    parts.push(Part::plain([from, pair[0]], [start, step]));
                    None
                }
                (None, true) => Some((pair[0], step)),
                (begun, _) => begun,
            };
            if inside[0] != inside[1] {
                let edge = self.part_end([p, q], inside[0]);
                begun = match begun {
                    Some((from, start)) => {
                        parts.push(Part::plain([from, edge.0], [start, edge.1]));
                        None
                    }
                    None => Some(edge),
                };
            }
        }
        if let Some((from, start)) = begun {
            let end = if b == last { End::ProfileEnd } else { End::Window };
            parts.push(Part::plain([from, b], [start, end]));
        }
        parts.retain(|part| part.xi[0] < part.xi[1]);
        parts
    }

    /// Where the patch ends between p and q, one of which is inside.
    fn part_end(&mut self, [p, q]: [f64; 2], first_inside: bool) -> (f64, End) {
        if let Some(tip) = bracketed(|xi| self.depth(xi), p, q) {
            return (tip, if self.plain() { End::Tip } else { End::Window });
        }
        // No surface on one side: the last ξ with one.
        let (on, off) = if first_inside { (p, q) } else { (q, p) };
        (last_where(|xi| self.depth(xi) < 0.0, on, off), End::ProfileEnd)
    }
}

/// Each number once, in ascending order.
pub(super) fn ascending(mut numbers: Vec<f64>) -> Vec<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    numbers
}
