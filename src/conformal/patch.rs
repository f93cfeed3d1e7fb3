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
    /// Least and largest α \[rad\]. The normal turns by their difference within the part.
    pub angle: [f64; 2],
    /// Boundary: a closed loop of \[σ, η\] \[mm\], counter-clockwise seen from outside of the rail. The first point is not
    /// repeated.
    pub boundary: Vec<[f64; 2]>,
}

/// The conformal patch inside a window of (σ, η).
///
/// Method: at every σ the wheel's lowest place along η is where its normal has no component along η; the interval of η
/// around it is bounded by roots of t = δ cos α. Tips are roots of the depth of the lowest place. A part that is narrower in
/// σ than 1/256 of the window and lies between two joints may be missed, and so may a second interval of η at one σ, which
/// only a skewed wheel with a hollow has.
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
        let inside = |sigma: f64| depth(sigma) < 0.0;
        // Where a part begins, and whether that is a tip.
        let mut begin = inside(from).then_some((from, false));
        for pair in places.windows(2) {
            let (here, there) = (inside(pair[0]), inside(pair[1]));
            if here != there {
                let tip = bracketed(depth, pair[0], pair[1]);
                // Without a root the wheel's surface ends between the two.
                let end = (tip.unwrap_or(if here { pair[0] } else { pair[1] }), tip.is_some());
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
        for k in 0..POINTS_PER_SIDE {
            let at = grading.xi(k as f64 / (POINTS_PER_SIDE - 1) as f64);
            let alpha = gap.angle(at);
            angle = [angle[0].min(alpha), angle[1].max(alpha)];
            if let Some(found) = slice(at) {
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
        self.components.push(ConformalComponent { sigma, eta, cut, area, angle, boundary });
    }
}

/// Finds the place of the wheel along η that is lowest over the rail at σ: η \[mm\] and t − δ cos α there \[mm\]. Returns
/// `None` where there is no such place in the window.
fn lowest(gap: &NormalGap<'_>, approach: f64, window: [f64; 2], sigma: f64) -> Option<[f64; 2]> {
    let across = |eta: f64| {
        let normal = gap.point(sigma, eta).and_then(|point| point.wheel_normal);
        normal.map_or(f64::NAN, |normal| normal.y)
    };
    let eta = if gap.placement.skew() == 0.0 && window[0] <= 0.0 && 0.0 <= window[1] {
        0.0
    } else {
        bracketed(across, window[0], window[1]).unwrap_or_else(|| {
            // The surface rises over the whole window from one of its ends.
            if gap.gap(sigma, window[0]) < gap.gap(sigma, window[1]) { window[0] } else { window[1] }
        })
    };
    let point = gap.point(sigma, eta)?;
    Some([eta, point.gap - approach * point.rail.cos]).filter(|[_, depth]| depth.is_finite())
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
    let mut cut = false;
    let ends = window.map(|end| {
        let beyond = |eta: f64| gap.gap(sigma, eta) - target;
        if depth == 0.0 {
            return middle;
        }
        let at_end = beyond(end);
        if at_end > 0.0
            && let Some(root) = bracketed(beyond, middle, end)
        {
            return root;
        }
        cut = true;
        if at_end.is_nan() {
            let on_wheel = |eta: f64| beyond(eta) <= 0.0;
            return last_where(on_wheel, middle, end);
        }
        end
    });
    Some(ConformalSlice { eta: ends, cut })
}
