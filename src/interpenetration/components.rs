//! The connected parts of the patch {s < δ} inside a window, each with its closed boundary loop.

use super::measure::{Memo, Stretch};
use super::outline::{End, Outline, Part, Window};
use super::slice::{Edge, Slice};
use crate::placement::Placement;

/// Points of a loop along each of its two sides: the polygon is then within 1e-4 of the patch's width of the
/// curve. Shared out among the pieces between corners by length, with at least [`LEAST_POINTS`] each.
const POINTS_PER_SIDE: usize = 128;
const LEAST_POINTS: usize = 4;

/// A step of the boundary at a joint is shown with both its ends if it is larger than this share of the component:
/// below, the loop's points are no better than that anyway.
const SHOWN_STEP_SHARE: f64 = 1e-6;

/// Demand on the quadrature of the area, relative.
pub(crate) const AREA_DEMAND: f64 = 1e-13;

/// Demand on the quadrature of the perimeter, relative.
const PERIMETER_DEMAND: f64 = 1e-11;

/// One connected part of the patch.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Extent in ξ \[mm\].
    pub xi: [f64; 2],
    /// What bounds it there.
    pub ends: [End; 2],
    /// Extent in η \[mm\].
    pub eta: [f64; 2],
    /// Both ends in ξ and, between them, every ξ where the boundary may have a corner \[mm\], ascending.
    pub corners: Vec<f64>,
    /// Whether the window cuts it anywhere.
    pub cut_by_window: bool,
    /// Closed loop of \[ξ, η\], counter-clockwise seen from +ζ, the first point not repeated; tips exact.
    pub boundary: Vec<[f64; 2]>,
    /// Area \[mm²\], to about 1e-12 relative, or to the rounding of s over δ where that is more.
    pub area: f64,
    /// Length of the loop, steps at joints included but not its straight sides at forks \[mm\], to about 1e-10 relative;
    /// 1e-7 where the end of a tilted wheel profile rounds it.
    pub perimeter: f64,
    /// Smallest s on it \[mm\] and where (ξ, η).
    pub deepest: [f64; 3],
    /// Where its slices are found.
    pub(crate) part: Part,
}

/// Where a connected part of the patch lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingBox {
    /// In ξ \[mm\].
    pub xi: [f64; 2],
    /// What bounds it there.
    pub ends: [End; 2],
    /// In η \[mm\].
    pub eta: [f64; 2],
    /// Smallest s on it \[mm\].
    pub least: f64,
}

/// The patch {s < δ} inside a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// δ \[mm\].
    pub approach: f64,
    /// The window that was looked at.
    pub window: Window,
    /// Its parts, by ascending ξ.
    pub components: Vec<Component>,
}

impl Patch {
    /// All components inside the window. Along every ξ a component is one interval of η: without skew so is the patch. With
    /// it a part that divides is given as several components, which meet at forks.
    ///
    /// Degenerate: empty for a δ that the pair nowhere undercuts, δ = 0 at a mere touch included, and for NaN.
    /// With skew, or a window off the midplane, a part that begins and ends within 1/512 of the window
    /// beside another minimum of s can be missed.
    pub fn new(placement: &Placement, approach: f64, window: &Window) -> Self {
        let mut outline = Outline::new(placement, approach, window);
        let parts = outline.parts();
        let components = parts.iter().map(|part| outline.component(part)).collect();
        Self { approach, window: *window, components }
    }

    /// Where the components of [`Patch::new`] lie, without their areas and lengths, which take most of its time.
    pub fn bounding_boxes(placement: &Placement, approach: f64, window: &Window) -> Vec<BoundingBox> {
        let mut outline = Outline::new(placement, approach, window);
        let parts = outline.parts();
        let bounding_box = |part: &Part| {
            let corners = outline.corners_of(part);
            let points = outline.points(part, &corners);
            let [least, ..] = outline.deepest(part, &points);
            BoundingBox { xi: part.xi, ends: part.ends, eta: across(&points), least }
        };
        parts.iter().map(bounding_box).collect()
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

impl Outline<'_> {
    fn component(&mut self, part: &Part) -> Component {
        let Part { xi, ends, .. } = *part;
        let corners = self.corners_of(part);
        let points = self.points(part, &corners);
        let mut boundary: Vec<[f64; 2]> = points.iter().map(|(x, slice)| [*x, slice.eta[0]]).collect();
        let upper = points.iter().rev().filter(|(_, slice)| slice.eta[0] < slice.eta[1]);
        boundary.extend(upper.map(|(x, slice)| [*x, slice.eta[1]]));
        let eta = across(&points);
        let window = self.window.eta;
        let cut_by_window = ends.contains(&End::Window)
            || points.iter().any(|(_, slice)| slice.eta[0] == window[0] || slice.eta[1] == window[1]);
        let (area, perimeter) = self.measures(part, &corners);
        let deepest = self.deepest(part, &points);
        let part = part.clone();
        Component { xi, ends, eta, corners, cut_by_window, boundary, area, perimeter, deepest, part }
    }

    /// Both ends in ξ and, between them, every ξ where the boundary may have a corner.
    fn corners_of(&mut self, part: &Part) -> Vec<f64> {
        let joints = self.slicer.placement().joints(part.xi[0], part.xi[1]);
        let joined = [&part.xi[..1], &joints, &part.xi[1..]].concat();
        self.corners(part, &graded(part, &joined))
    }

    /// ξ of the loop's points with the slices there, ascending: every corner, between two of them points that crowd
    /// towards round ends, and where each branch is farthest out in η.
    fn points(&mut self, part: &Part, corners: &[f64]) -> Vec<(f64, Slice)> {
        let at = |outline: &mut Self, xi: f64| (xi, outline.slice_of(part, xi));
        let mut points: Vec<_> = graded(part, corners).into_iter().map(|xi| at(self, xi)).collect();
        let mut more: Vec<f64> = inner(corners)
            .iter()
            .filter(|&&x| self.step(part, x) > SHOWN_STEP_SHARE * (part.xi[1] - part.xi[0]))
            .map(|x| x.next_up())
            .collect();
        for (branch, sign) in [(0, -1.0), (1, 1.0)] {
            let outward = |k: &usize| sign * points[*k].1.eta[branch];
            let farthest =
                (1..points.len().saturating_sub(1)).max_by(|p, q| outward(p).total_cmp(&outward(q)));
            more.extend(
                farthest.and_then(|k| self.turn_of_branch(part, branch, points[k - 1].0, points[k + 1].0)),
            );
        }
        points.extend(more.into_iter().map(|xi| at(self, xi)));
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by_key(|point| point.0);
        points
    }

    /// Area and perimeter over the pieces between corners.
    fn measures(&mut self, part: &Part, corners: &[f64]) -> (f64, f64) {
        let (mut area, mut perimeter) = (0.0, 0.0);
        let edges = |outline: &mut Self, xi: f64| outline.edges(part.valley(xi), xi);
        for piece in pieces(part, corners) {
            let mut memo = Memo::new();
            area += piece.integral(&mut |xi| width(memo.at(xi, |xi| edges(self, xi))), AREA_DEMAND);
            let mut speed = |xi: f64| {
                let edges = memo.at(xi, |xi| edges(self, xi));
                self.speed(xi, edges)
            };
            perimeter += piece.integral(&mut speed, PERIMETER_DEMAND);
        }
        perimeter += inner(corners).iter().map(|&xi| self.step(part, xi)).sum::<f64>();
        for (xi, end) in part.xi.into_iter().zip(part.ends) {
            if end != End::Tip && end != End::Fork {
                perimeter += width(edges(self, xi));
            }
        }
        (area, perimeter)
    }

    /// How far both branches jump at a corner \[mm\]: a drawing's rounded coordinates leave such steps.
    fn step(&mut self, part: &Part, xi: f64) -> f64 {
        // With skew a corner is found by its jump, and may be on either side of it.
        let before = if part.valley(xi).is_some() { xi.next_down() } else { xi };
        let (Some(left), Some(right)) = (self.slice(part, before), self.slice(part, xi.next_up())) else {
            return 0.0;
        };
        left.eta.into_iter().zip(right.eta).map(|(a, b)| (a - b).abs()).sum()
    }

    /// Length of both branches per unit of ξ.
    fn speed(&mut self, xi: f64, edges: Option<[Edge; 2]>) -> f64 {
        let Some(edges) = edges else { return 0.0 };
        let window = self.window.eta;
        (0..2).map(|k| if edges[k].eta == window[k] { 1.0 } else { self.branch_speed(xi, edges[k]) }).sum()
    }

    fn branch_speed(&mut self, xi: f64, Edge { eta, ledge }: Edge) -> f64 {
        let slicer = &mut self.slicer;
        let slope = if ledge { slicer.ledge_slope(xi, eta) } else { slicer.boundary_slope(xi, eta) };
        // Infinite only where ξ has been rounded onto a round end itself, which has no measure.
        if slope.is_finite() { 1f64.hypot(slope) } else { 0.0 }
    }

    /// \[s, ξ, η\] of the smallest s among the points and where the depth turns between them.
    fn deepest(&mut self, part: &Part, points: &[(f64, Slice)]) -> [f64; 3] {
        let nodes: Vec<f64> = points.iter().map(|point| point.0).collect();
        // C first: points where s² is below the smallest number are none better.
        let mut candidates: Vec<f64> =
            [0.0].into_iter().filter(|&c| nodes[0] <= c && c <= nodes[nodes.len() - 1]).collect();
        candidates.extend(self.turning_points_of(part, &nodes));
        candidates.extend(&nodes);
        let values = candidates.into_iter().map(|xi| self.deepest_at(part, xi));
        least(values).unwrap_or([f64::NAN, nodes[0], 0.0])
    }
}

/// The one of \[s, ξ, η\] with the smallest s, NaN left out; the first of several.
pub(super) fn least(values: impl Iterator<Item = [f64; 3]>) -> Option<[f64; 3]> {
    values.filter(|v| !v[0].is_nan()).min_by(|p, q| p[0].total_cmp(&q[0]))
}

/// Width of a slice \[mm\], 0 outside.
fn width(edges: Option<[Edge; 2]>) -> f64 {
    edges.map_or(0.0, |[low, high]| high.eta - low.eta)
}

/// Extent of slices in η.
fn across(points: &[(f64, Slice)]) -> [f64; 2] {
    points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, slice)| {
        [low.min(slice.eta[0]), high.max(slice.eta[1])]
    })
}

/// All corners but the two ends.
fn inner(corners: &[f64]) -> &[f64] {
    &corners[1..corners.len() - 1]
}

/// The pieces of a part between corners.
fn pieces(part: &Part, corners: &[f64]) -> impl Iterator<Item = Stretch> {
    let ends = part.ends;
    let last = corners.len().saturating_sub(2);
    corners.windows(2).enumerate().map(move |(k, pair)| Stretch {
        xi: [pair[0], pair[1]],
        round: [k == 0 && ends[0] != End::Window, k == last && ends[1] != End::Window],
    })
}

/// Intervals of a piece of the loop.
fn points_between(a: f64, b: f64, whole: f64) -> usize {
    LEAST_POINTS.max((POINTS_PER_SIDE as f64 * (b - a) / whole) as usize)
}

/// Every corner, and between two of them ξ that crowd towards round ends.
fn graded(part: &Part, corners: &[f64]) -> Vec<f64> {
    let mut nodes = vec![corners[0]];
    let whole = part.xi[1] - part.xi[0];
    for piece in pieces(part, corners) {
        let n = points_between(piece.xi[0], piece.xi[1], whole);
        nodes.extend((1..n).map(|k| piece.xi(k as f64 / n as f64)));
        nodes.push(piece.xi[1]);
    }
    nodes.dedup();
    nodes
}
