//! Finds where the boundary of a patch may have a corner, and where it turns back in η.

use super::band::Band;
use super::loops::Rows;
use super::outline::Outline;
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};

/// Distance from a band up to which joints of the wheel are examined, as a multiple of the band's depth × sinθ. It is
/// enough for slopes up to 80°. A joint beyond it that is missed only costs the quadrature some panels.
const FAR_JOINTS: f64 = 16.0;

/// Number of intervals of a circle in which a root of s = δ is sought. Two roots within one interval are missed.
const CIRCLE_INTERVALS: usize = 8;

/// Most doublings of the bracket of a sagitta.
const DOUBLINGS: usize = 40;

/// Appends the ξ inside a band where, without skew, its boundary crosses a joint or the end of the wheel's
/// surface. The two branches mirror each other.
///
/// Method: closed form except for one root at each joint. The point over the joint at p lies at ξ = p + e sinθ and height
/// h(p) + e cosθ; that height must equal ζ^R(ξ) + δ.
pub(super) fn plain(outline: &Outline<'_>, band: &Band, deepest: f64, corners: &mut Vec<f64>) {
    let placement = outline.slicer.placement();
    let (approach, rail) = (outline.slicer.approach(), &placement.rail().section);
    if outline.slicer.by_roots.is_some() {
        // The boundary's interpolants find these corners by themselves.
        return;
    }
    let frame = placement.wheel().section.frame;
    let far = FAR_JOINTS * (approach - deepest).abs() * frame.sin.abs();
    for (p, height) in placement.wheel().section.joints(band.xi.grown(far)) {
        let miss = |e: f64| height + e * frame.cos - rail.height(p + e * frame.sin) - approach;
        if frame.sin == 0.0 || miss(0.0) >= 0.0 {
            if frame.sin == 0.0 {
                corners.extend(band.xi.surrounds(p).then_some(p));
            }
            continue;
        }
        let mut high = (approach - deepest).abs() / frame.cos;
        for _ in 0..DOUBLINGS {
            if miss(high).is_nan() || miss(high) > 0.0 || high > placement.rolling_radius() {
                break;
            }
            high *= 2.0;
        }
        let root = bracketed(miss, 0.0, high).map(|e| p + e * frame.sin);
        corners.extend(root.filter(|&xi| band.xi.surrounds(xi)));
    }
}

/// Appends the ξ inside a band where s = δ on the circle of a joint or end of a skewed wheel. `eta` is the
/// range of η of the band.
pub(super) fn skewed(outline: &Outline<'_>, band: &Band, eta: Interval, corners: &mut Vec<f64>) {
    let Some(skewed) = &outline.slicer.skewed else { return };
    let (approach, rail) = (outline.slicer.approach(), &outline.slicer.placement().rail().section);
    skewed.valleys.circles(band.xi, eta, |place, [from, to]| {
        let depth = |t: f64| {
            let [xi, height] = place(t);
            height - rail.height(xi) - approach
        };
        let at = |k: usize| from + (to - from) * k as f64 / CIRCLE_INTERVALS as f64;
        let mut before = depth(from);
        for k in 1..=CIRCLE_INTERVALS {
            let here = depth(at(k));
            if before * here < 0.0 {
                let root = bracketed(depth, at(k - 1), at(k)).map(|t| place(t)[0]);
                corners.extend(root.filter(|&xi| band.xi.surrounds(xi)));
            }
            before = here;
        }
    });
}

/// Appends the ξ between two rows at which a branch meets the edge of the window.
pub(super) fn at_window(band: &Band, rows: &Rows, corners: &mut Vec<f64>) {
    for pair in rows.windows(2) {
        for branch in 0..2 {
            let cut = |row: &[f64; 3]| row[1 + branch] == band.window[branch];
            let first = cut(&pair[0]);
            if first != cut(&pair[1]) {
                let same = |xi: f64| (band.slice(xi).eta[branch] == band.window[branch]) == first;
                corners.push(last_where(same, pair[0][0], pair[1][0]));
            }
        }
    }
}

/// Returns the ξ between two rows at which a branch turns and is farthest out in η. Returns `None` if it does not turn.
pub(super) fn turn_of_branch(band: &Band, branch: usize, [from, to]: [f64; 2]) -> Option<f64> {
    bracketed(|xi| band.slope(branch, xi), from, to)
}
