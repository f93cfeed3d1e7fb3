//! The connected parts of the patch {s < δ} inside a window, each with its closed boundary loop.

use serde::Serialize;

use super::slice::{Slice, Slicer};
use crate::contact::feasibility::critical_points;
use crate::numerics::quadrature::integral;
use crate::numerics::roots::bracketed;
use crate::placement::Placement;

/// Points of a loop along each of its two sides: the polygon is then within 1e-4 of the patch's width of the
/// curve. Shared out among the pieces between corners by length, with at least [`LEAST_POINTS`] each.
const POINTS_PER_SIDE: usize = 128;
const LEAST_POINTS: usize = 4;

/// Intervals in which the patch is looked for with skew, where the depth has no closed-form stationary
/// points: a part of the patch narrower than this share of the window can be missed.
const SEARCHED_INTERVALS: usize = 512;

/// Demand on the quadrature of area and perimeter, relative.
const QUADRATURE: f64 = 1e-13;

/// The rectangle of the ξ–η plane that is looked at \[mm\].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Window {
    /// Range of ξ.
    pub xi: [f64; 2],
    /// Range of η.
    pub eta: [f64; 2],
}

/// What bounds a component at one of its ends in ξ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// The two branches meet where s(ξ, η) = δ in a single point.
    Tip,
    /// The window cuts it.
    Window,
    /// One of the bodies ends.
    ProfileEnd,
}

/// One connected part of the patch.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Extent in ξ \[mm\].
    pub xi: [f64; 2],
    /// What bounds it there.
    pub ends: [End; 2],
    /// Extent in η \[mm\].
    pub eta: [f64; 2],
    /// Whether the window cuts it anywhere.
    pub cut_by_window: bool,
    /// Closed loop of \[ξ, η\], counter-clockwise seen from +ζ, the first point not repeated; tips exact.
    pub boundary: Vec<[f64; 2]>,
    /// Area \[mm²\], to about 1e-12 relative.
    pub area: f64,
    /// Length of the loop \[mm\], to about 1e-10 relative.
    pub perimeter: f64,
    /// Smallest s on it \[mm\] and where (ξ, η).
    pub deepest: [f64; 3],
}

/// The patch {s < δ} inside a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// δ \[mm\].
    pub approach: f64,
    /// Its parts, by ascending ξ.
    pub components: Vec<Component>,
}

impl Patch {
    /// All components inside the window. Along every ξ the patch is one interval of η, so that no component
    /// has a hole and each is an interval of ξ.
    pub fn new(placement: &Placement, approach: f64, window: &Window) -> Self {
        let mut slicer = Slicer::new(placement, approach);
        let mut cut = Clipped { slicer: &mut slicer, window: *window };
        let intervals = cut.intervals();
        let components = intervals.into_iter().map(|(xi, ends)| cut.component(xi, ends)).collect();
        Self { approach, components }
    }

    /// Whether any component is cut by the window.
    pub fn cut_by_window(&self) -> bool {
        self.components.iter().any(|component| component.cut_by_window)
    }

    /// Total area \[mm²\].
    pub fn area(&self) -> f64 {
        self.components.iter().map(|component| component.area).sum()
    }

    /// The box around all components, or `None` for an empty patch.
    pub fn extent(&self) -> Option<Window> {
        let mut components = self.components.iter();
        let first = components.next()?;
        let join = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Some(components.fold(Window { xi: first.xi, eta: first.eta }, |w, c| Window {
            xi: join(w.xi, c.xi),
            eta: join(w.eta, c.eta),
        }))
    }
}

/// A slicer whose slices end at the window.
struct Clipped<'s, 'a> {
    slicer: &'s mut Slicer<'a>,
    window: Window,
}

impl Clipped<'_, '_> {
    /// min over the window's η of s − δ.
    fn depth(&mut self, xi: f64) -> f64 {
        let [from, to] = self.window.eta;
        if from <= 0.0 && to >= 0.0 && self.slicer.placement().skew == 0.0 {
            return self.slicer.depth(xi);
        }
        let Some(Slice { eta: [a, b] }) = self.slicer.slice(xi) else { return self.slicer.depth(xi) };
        // Overlap of [a, b] with the window, as a length: negative where there is some.
        if a.max(from) <= b.min(to) { self.slicer.depth(xi).min(0.0) } else { (a - to).max(from - b) }
    }

    /// The clipped interval of η.
    fn slice(&mut self, xi: f64) -> Option<Slice> {
        let Slice { eta: [a, b] } = self.slicer.slice(xi)?;
        let eta = [a.max(self.window.eta[0]), b.min(self.window.eta[1])];
        (eta[0] <= eta[1]).then_some(Slice { eta })
    }

    /// The intervals of ξ that the components cover.
    fn intervals(&mut self) -> Vec<([f64; 2], [End; 2])> {
        let placement = self.slicer.placement();
        let Some([first, last]) = placement.overlap() else { return Vec::new() };
        let [a, b] = [first.max(self.window.xi[0]), last.min(self.window.xi[1])];
        if a >= b {
            return Vec::new();
        }
        let kind = |xi: f64, profile: f64| if xi == profile { End::ProfileEnd } else { End::Window };
        let mut points = critical_points(placement, a, b);
        let plain = placement.skew == 0.0 && self.window.eta[0] <= 0.0 && self.window.eta[1] >= 0.0;
        if !plain {
            points
                .extend((1..SEARCHED_INTERVALS).map(|k| a + (b - a) * k as f64 / SEARCHED_INTERVALS as f64));
            points.sort_by(f64::total_cmp);
        }
        let mut out = Vec::new();
        let mut begun = (self.depth(a) < 0.0).then_some((a, kind(a, first)));
        for pair in points.windows(2) {
            let (here, next) = (self.depth(pair[0]), self.depth(pair[1]));
            if (here < 0.0) == (next < 0.0) {
                continue;
            }
            let tip = bracketed(|xi| self.depth(xi), pair[0], pair[1]);
            let (tip, end) =
                tip.map_or((pair[usize::from(here < 0.0)], End::ProfileEnd), |tip| (tip, End::Tip));
            match begun.take() {
                None => begun = Some((tip, end)),
                Some((from, start)) => out.push(([from, tip], [start, end])),
            }
        }
        if let Some((from, start)) = begun {
            out.push(([from, b], [start, kind(b, last)]));
        }
        out
    }

    fn component(&mut self, xi: [f64; 2], ends: [End; 2]) -> Component {
        let corners = self.corners(xi);
        let nodes = graded(&corners, ends);
        let slices: Vec<(f64, Slice)> = nodes
            .iter()
            .map(|&x| {
                let tip = (x == xi[0] && ends[0] == End::Tip) || (x == xi[1] && ends[1] == End::Tip);
                (x, if tip { self.tip(x) } else { self.slice(x).unwrap_or_else(|| self.tip(x)) })
            })
            .collect();
        let mut boundary: Vec<[f64; 2]> = slices.iter().map(|(x, slice)| [*x, slice.eta[0]]).collect();
        let upper = slices.iter().rev().filter(|(_, slice)| slice.eta[0] < slice.eta[1]);
        boundary.extend(upper.map(|(x, slice)| [*x, slice.eta[1]]));
        let eta = slices.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, slice)| {
            [low.min(slice.eta[0]), high.max(slice.eta[1])]
        });
        let window_eta =
            slices.iter().any(|(_, s)| s.eta[0] == self.window.eta[0] || s.eta[1] == self.window.eta[1]);
        let (area, perimeter) = self.measures(&corners, ends);
        let deepest = self.deepest(&nodes);
        let cut_by_window = window_eta || ends.contains(&End::Window);
        Component { xi, ends, eta, cut_by_window, boundary, area, perimeter, deepest }
    }

    /// A slice of no width at the η of the tip.
    fn tip(&mut self, xi: f64) -> Slice {
        let eta = if self.slicer.placement().skew == 0.0 {
            0.0
        } else {
            self.slicer.slice(xi).map_or(0.0, |s| (s.eta[0] + s.eta[1]) / 2.0)
        };
        let eta = eta.clamp(self.window.eta[0], self.window.eta[1]);
        Slice { eta: [eta, eta] }
    }

    /// Both ends and all ξ between where the boundary may have a corner: joints, and where it meets the window.
    fn corners(&mut self, [a, b]: [f64; 2]) -> Vec<f64> {
        let mut corners = vec![a];
        corners.extend(self.slicer.placement().joints(a, b));
        corners.push(b);
        let mut crossings = Vec::new();
        for pair in corners.windows(2) {
            let n = points_between(pair[0], pair[1], b - a);
            let steps: Vec<f64> =
                (0..=n).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / n as f64).collect();
            for edge in self.window.eta {
                let mut beyond = |xi: f64| self.slicer.separation(xi, edge) - self.slicer.approach;
                crossings.extend(steps.windows(2).filter_map(|s| {
                    let (p, q) = (beyond(s[0]), beyond(s[1]));
                    ((p < 0.0) != (q < 0.0)).then(|| bracketed(&mut beyond, s[0], s[1])).flatten()
                }));
            }
        }
        corners.extend(crossings);
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        corners
    }

    /// Area and perimeter over the pieces between corners.
    fn measures(&mut self, corners: &[f64], ends: [End; 2]) -> (f64, f64) {
        let (mut area, mut perimeter) = (0.0, 0.0);
        for piece in pieces(corners, ends) {
            let width = |cut: &mut Self, xi: f64| cut.slice(xi).map_or(0.0, |s| s.eta[1] - s.eta[0]);
            area += integral(&mut |t| width(self, piece.xi(t)) * piece.dxi(t), 0.0, 1.0, QUADRATURE)[0];
            perimeter +=
                integral(&mut |t| self.speed(piece.xi(t)) * piece.dxi(t), 0.0, 1.0, QUADRATURE.sqrt())[0];
        }
        for (xi, end) in [corners[0], corners[corners.len() - 1]].into_iter().zip(ends) {
            if end != End::Tip {
                perimeter += self.slice(xi).map_or(0.0, |s| s.eta[1] - s.eta[0]);
            }
        }
        (area, perimeter)
    }

    /// Length of both branches per unit of ξ.
    fn speed(&mut self, xi: f64) -> f64 {
        let Some(Slice { eta }) = self.slice(xi) else { return 0.0 };
        let window = self.window.eta;
        let mut branch = |eta: f64, edge: f64| {
            if eta == edge { 1.0 } else { 1f64.hypot(self.slicer.boundary_slope(xi, eta)) }
        };
        branch(eta[0], window[0]) + branch(eta[1], window[1])
    }

    /// \[s, ξ, η\] of the smallest s among the nodes and the gap's own stationary points.
    fn deepest(&mut self, nodes: &[f64]) -> [f64; 3] {
        let (a, b) = (nodes[0], nodes[nodes.len() - 1]);
        let mut candidates = critical_points(self.slicer.placement(), a, b);
        candidates.extend(nodes);
        let eta = 0f64.clamp(self.window.eta[0], self.window.eta[1]);
        let values = candidates.into_iter().map(|xi| [self.slicer.separation(xi, eta), xi, eta]);
        values.filter(|v| !v[0].is_nan()).min_by(|p, q| p[0].total_cmp(&q[0])).unwrap_or([f64::NAN, a, eta])
    }
}

/// A piece of a component between two corners, with the square-root behaviour at tips taken out:
/// ξ(t) = a + (b − a) φ(t), φ′ = 0 at tips.
struct PieceMap {
    a: f64,
    b: f64,
    tips: [bool; 2],
}

impl PieceMap {
    fn xi(&self, t: f64) -> f64 {
        let share = match self.tips {
            [false, false] => t,
            [true, false] => t * t,
            [false, true] => t * (2.0 - t),
            [true, true] => t * t * (3.0 - 2.0 * t),
        };
        self.a + (self.b - self.a) * share
    }

    fn dxi(&self, t: f64) -> f64 {
        let slope = match self.tips {
            [false, false] => 1.0,
            [true, false] => 2.0 * t,
            [false, true] => 2.0 - 2.0 * t,
            [true, true] => 6.0 * t * (1.0 - t),
        };
        (self.b - self.a) * slope
    }
}

fn pieces(corners: &[f64], ends: [End; 2]) -> impl Iterator<Item = PieceMap> {
    let last = corners.len().saturating_sub(2);
    corners.windows(2).enumerate().map(move |(k, pair)| PieceMap {
        a: pair[0],
        b: pair[1],
        tips: [k == 0 && ends[0] == End::Tip, k == last && ends[1] == End::Tip],
    })
}

/// Intervals of a piece of the loop.
fn points_between(a: f64, b: f64, whole: f64) -> usize {
    LEAST_POINTS.max((POINTS_PER_SIDE as f64 * (b - a) / whole) as usize)
}

/// ξ of the loop's points: every corner, and between two of them points that crowd towards tips.
fn graded(corners: &[f64], ends: [End; 2]) -> Vec<f64> {
    let mut nodes = vec![corners[0]];
    let whole = corners[corners.len() - 1] - corners[0];
    for piece in pieces(corners, ends) {
        let n = points_between(piece.a, piece.b, whole);
        nodes.extend((1..n).map(|k| piece.xi(k as f64 / n as f64)));
        nodes.push(piece.b);
    }
    nodes.dedup();
    nodes
}
