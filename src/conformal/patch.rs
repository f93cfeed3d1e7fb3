//! The conformal patch t < δ cos α(σ), over the rail's surface unrolled by σ.

use super::gap::NormalGap;
use crate::numerics::roots::{bracketed, last_where};
use crate::patch::{Grading, Window};

/// Least number of equal steps of σ over the window in which parts of the patch are looked for.
const STEPS: usize = 256;

/// Relative accuracy demanded of areas.
const AREA_DEMAND: f64 = 1e-10;

/// Number of points on each of the two sides of a loop.
const POINTS_PER_SIDE: usize = 128;

/// Steps over the window in η in which the lowest place of a skewed wheel is looked for.
const ETA_STEPS: usize = 16;

/// Most steps to the least or largest depth between two places. The interval is then 1e-6 of what it was.
const TURN_STEPS: usize = 30;

/// Share of an interval at which a golden section divides it.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Largest number of times that a window is doubled: from 1/100 mm to beyond any wheel.
const MOST_DOUBLINGS: usize = 20;

/// One connected part of the conformal patch.
#[derive(Debug, Clone, PartialEq)]
pub struct ConformalComponent {
    /// Range of σ \[mm\]: the tips, or the ends of the window or of the rail's surface.
    pub sigma: [f64; 2],
    /// Range of η \[mm\].
    pub eta: [f64; 2],
    /// Whether the window or an end of a surface cuts the part anywhere.
    pub cut: bool,
    /// Area on the rail's surface \[mm²\].
    pub area: f64,
    /// Smallest t − δ cos α \[mm\], of the points of the boundary's columns.
    pub least: f64,
    /// Least and largest α \[rad\]. The normal turns by their difference within the part.
    pub angle: [f64; 2],
    /// Boundary: a closed loop of \[σ, η\] \[mm\], counter-clockwise seen from outside of the rail. The first point is not
    /// repeated.
    pub boundary: Vec<[f64; 2]>,
}

/// The conformal patch inside a window of (σ, η).
///
/// Method: at every σ the wheel's lowest place along η is where its normal has no component along η; the interval of η
/// around it is bounded by roots of t = δ cos α. Tips are roots of the depth of the lowest place, which is looked for at joints of the
/// rail, at 256 equal steps of the window, and where it turns between them. A part with two turns of that depth within two
/// steps may be missed, and so may a second interval of η at one σ, which only a skewed wheel with a hollow has.
#[derive(Debug, Clone, PartialEq)]
pub struct ConformalPatch {
    /// Approach δ \[mm\].
    pub approach: f64,
    /// The parts, by ascending σ.
    pub components: Vec<ConformalComponent>,
}

/// The interval of η of one σ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConformalSlice {
    /// Smallest and largest η \[mm\] with t ≤ δ cos α.
    pub eta: [f64; 2],
    /// Whether an end of the interval is that of the window or of the wheel.
    pub cut: bool,
    /// Smallest t − δ cos α \[mm\].
    pub least: f64,
}

impl ConformalPatch {
    /// Finds the patch in a bounded window; its `xi` is the range of σ \[mm\].
    pub fn new(gap: &NormalGap<'_>, approach: f64, window: &Window) -> Self {
        let mut patch = Self { approach, components: Vec::new() };
        let Some([low, high]) = gap.rail().reach() else { return patch };
        let [from, to] = [window.xi[0].max(low), window.xi[1].min(high)];
        if from >= to {
            return patch;
        }
        let mut places: Vec<f64> =
            (0..=STEPS).map(|k| from + (to - from) * k as f64 / STEPS as f64).collect();
        places.extend(gap.rail().joints().into_iter().chain([0.0]).filter(|&at| from < at && at < to));
        places.sort_by(f64::total_cmp);
        places.dedup();
        let depth =
            |sigma: f64| lowest(gap, approach, window.eta, sigma).map_or(f64::NAN, |[_, depth]| depth);
        let mut places: Vec<Place> =
            places.into_iter().map(|sigma| Place { sigma, depth: depth(sigma) }).collect();
        places.extend(turned(&depth, &places));
        places.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
        // Where a part begins, and whether that is a tip.
        let mut begin = places.first().filter(|place| place.is_inside()).map(|place| (place.sigma, false));
        for pair in places.windows(2) {
            let [here, there] = [pair[0], pair[1]];
            if here.is_inside() != there.is_inside() {
                let tip = bracketed(depth, here.sigma, there.sigma);
                // Without a root the wheel's surface ends between the two.
                let [on, off] = if here.is_inside() { [here, there] } else { [there, here] };
                let last = || last_where(|sigma| depth(sigma) < 0.0, on.sigma, off.sigma);
                let end = (tip.unwrap_or_else(last), tip.is_some());
                match begin.take() {
                    Some(begin) => patch.add(gap, window, [begin, end]),
                    None => begin = Some(end),
                }
            }
        }
        if let Some(begin) = begin {
            patch.add(gap, window, [begin, (to, false)]);
        }
        patch
    }

    /// Finds the whole patch: in a window that is doubled until it cuts no part, or covers the rail's surface and the wheel. It begins
    /// with the half widths \[mm\] `around` C, along σ and η.
    pub fn whole(gap: &NormalGap<'_>, approach: f64, around: [f64; 2]) -> Self {
        let mut window = Window { xi: [-around[0], around[0]], eta: [-around[1], around[1]] };
        let mut patch = Self::new(gap, approach, &window);
        for _ in 0..MOST_DOUBLINGS {
            let meets = |ends: [f64; 2], of: [f64; 2]| ends[0] <= of[0] || ends[1] >= of[1];
            // The ends of the rail's surface and of the wheel lie inside of a window that is wide enough.
            let along = patch.components.iter().any(|part| meets(part.sigma, window.xi));
            let across = patch.components.iter().any(|part| meets(part.eta, window.eta));
            if !along && !across {
                break;
            }
            let wider = |[a, b]: [f64; 2], grow: bool| if grow { [2.0 * a, 2.0 * b] } else { [a, b] };
            window = Window { xi: wider(window.xi, along), eta: wider(window.eta, across) };
            patch = Self::new(gap, approach, &window);
        }
        patch
    }

    /// Returns the area on the rail's surface \[mm²\].
    pub fn area(&self) -> f64 {
        self.components.iter().map(|component| component.area).sum()
    }

    /// Adds the part between two σ, each with whether it is a tip.
    fn add(&mut self, gap: &NormalGap<'_>, window: &Window, ends: [(f64, bool); 2]) {
        let (sigma, round) = (ends.map(|end| end.0), ends.map(|end| end.1));
        let slice = |sigma: f64| conformal_slice(gap, self.approach, window.eta, sigma);
        let grading = Grading { xi: sigma, round };
        let mut rows = Vec::with_capacity(POINTS_PER_SIDE);
        let mut cut = round.contains(&false);
        let mut eta = [f64::INFINITY, f64::NEG_INFINITY];
        let mut angle = eta;
        let mut least = f64::INFINITY;
        for k in 0..POINTS_PER_SIDE {
            let at = grading.xi(k as f64 / (POINTS_PER_SIDE - 1) as f64);
            let alpha = gap.angle(at);
            angle = [angle[0].min(alpha), angle[1].max(alpha)];
            if let Some(found) = slice(at) {
                least = least.min(found.least);
                cut |= found.cut;
                eta = [eta[0].min(found.eta[0]), eta[1].max(found.eta[1])];
                rows.push((at, found.eta));
            }
        }
        let width = |sigma: f64| [slice(sigma).map_or(0.0, |s| s.eta[1] - s.eta[0])];
        let mut parts = vec![0.0];
        let joints = gap.rail().joints().into_iter().filter(|&at| sigma[0] < at && at < sigma[1]);
        parts.extend(joints.map(|at| grading.parameter(at)));
        parts.push(1.0);
        let area = parts.windows(2).map(|t| grading.integrals([t[0], t[1]], width, [AREA_DEMAND])[0]).sum();
        let lower = rows.iter().map(|(at, eta)| [*at, eta[0]]);
        let upper = rows.iter().rev().map(|(at, eta)| [*at, eta[1]]);
        let mut boundary: Vec<[f64; 2]> = lower.chain(upper).collect();
        boundary.dedup();
        if boundary.len() > 1 && boundary.first() == boundary.last() {
            boundary.pop();
        }
        self.components.push(ConformalComponent { sigma, eta, cut, area, least, angle, boundary });
    }
}

/// The depth of the lowest place of the wheel over one σ.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// σ \[mm\].
    sigma: f64,
    /// The least t − δ cos α \[mm\]; NaN where there is none.
    depth: f64,
}

impl Place {
    fn is_inside(&self) -> bool {
        self.depth < 0.0
    }
}

/// Finds places between neighbouring ones, ascending, at which the depth may pass zero twice: where it turns on the other side of
/// zero.
fn turned(depth: &impl Fn(f64) -> f64, places: &[Place]) -> Vec<Place> {
    let mut found = Vec::new();
    for at in places.windows(3) {
        let sign = at[1].depth.signum();
        let [before, here, after] = [at[0], at[1], at[2]].map(|place| place.depth * sign);
        // Three places on one side, of which the middle one is nearest to the other side, and near enough.
        let near = here <= before && here <= after && here < (before - here).max(after - here);
        let signed = |sigma: f64| sign * depth(sigma);
        if near && let Some(sigma) = crosses(&signed, [at[0].sigma, at[2].sigma]) {
            found.push(Place { sigma, depth: depth(sigma) });
        }
    }
    found
}

/// Finds a place inside an interval at which a function with one turn is negative, by golden sections.
fn crosses(f: &impl Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> Option<f64> {
    let mut inner = [a + GOLDEN * (b - a), b - GOLDEN * (b - a)];
    let mut values = inner.map(f);
    for _ in 0..TURN_STEPS {
        if let Some(k) = values.iter().position(|value| *value < 0.0) {
            return Some(inner[k]);
        }
        if values[0] <= values[1] {
            b = inner[1];
            inner = [a + GOLDEN * (b - a), inner[0]];
            values = [f(inner[0]), values[0]];
        } else {
            a = inner[0];
            inner = [inner[1], b - GOLDEN * (b - a)];
            values = [values[1], f(inner[1])];
        }
    }
    None
}

/// Finds the place of the wheel along η that is lowest over the rail at σ: η \[mm\] and t − δ cos α there \[mm\]. Returns
/// `None` where there is no such place in the window.
fn lowest(gap: &NormalGap<'_>, approach: f64, window: [f64; 2], sigma: f64) -> Option<[f64; 2]> {
    let eta = if gap.placement.skew() == 0.0 && window[0] <= 0.0 && 0.0 <= window[1] {
        0.0
    } else {
        lowest_of_steps(gap, window, sigma)?
    };
    let point = gap.point(sigma, eta)?;
    Some([eta, point.gap - approach * point.rail.cos]).filter(|[_, depth]| depth.is_finite())
}

/// Finds the η \[mm\] at which the wheel is lowest: next to the least of some steps, where its normal has no component along η.
fn lowest_of_steps(gap: &NormalGap<'_>, [from, to]: [f64; 2], sigma: f64) -> Option<f64> {
    let t = |eta: f64| gap.gap(sigma, eta);
    let step = |k: usize| from + (to - from) * k as f64 / ETA_STEPS as f64;
    let met = (0..=ETA_STEPS).map(|k| (k, t(step(k)))).filter(|(_, t)| !t.is_nan());
    let (least, _) = met.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let ends = [least.saturating_sub(1), (least + 1).min(ETA_STEPS)].map(|k| {
        let end = step(k);
        if t(end).is_nan() { last_where(|eta| !t(eta).is_nan(), step(least), end) } else { end }
    });
    let turn = bracketed(|eta| gap.slope(sigma, eta), ends[0], ends[1]);
    // Without a turn the surface rises over the whole interval from one of its ends.
    turn.or_else(|| ends.into_iter().min_by(|a, b| t(*a).total_cmp(&t(*b))))
}

/// Finds the interval of η \[mm\] inside `window` with t ≤ δ cos α at one σ \[mm\]; `None` outside of the patch.
pub fn conformal_slice(
    gap: &NormalGap<'_>,
    approach: f64,
    window: [f64; 2],
    sigma: f64,
) -> Option<ConformalSlice> {
    let [middle, depth] = lowest(gap, approach, window, sigma)?;
    if depth > 0.0 {
        return None;
    }
    let target = approach * gap.rail().point(sigma)?.cos;
    let beyond = |eta: f64| gap.gap(sigma, eta) - target;
    let mut cut = false;
    let eta = window.map(|end| {
        if depth == 0.0 {
            return middle;
        }
        // The wheel may end before the window.
        let end =
            if beyond(end).is_nan() { last_where(|eta| !beyond(eta).is_nan(), middle, end) } else { end };
        bracketed(beyond, middle, end).unwrap_or_else(|| {
            cut = true;
            end
        })
    });
    Some(ConformalSlice { eta, cut, least: depth })
}
