//! Joins the sides of bands that touch into closed loops.
//!
//! At every ξ where bands end or begin, the loop continues from a side of one band to a side of another. If need be it
//! follows the line of constant ξ: upwards if the patch is only on the left of the line, downwards if it is only on the
//! right.

use super::band::Band;
use crate::numerics::interval::Interval;

/// A side of a band, as part of a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BandSide {
    /// Index of the band in its component.
    pub(crate) band: usize,
    /// 0 for the lower side, along which a loop runs with ξ; 1 for the upper side, along which it runs back.
    pub(crate) branch: usize,
}

/// The slices of one band as \[ξ, lower η, upper η\] \[mm\], by ascending ξ, both ends included.
pub(super) type Rows = Vec<[f64; 3]>;

/// Returns the sides of the bands that make up each loop, in the order in which the loop runs along them, with the patch on
/// the left.
pub(crate) fn rings(bands: &[Band]) -> Vec<Vec<BandSide>> {
    let mut free: Vec<BandSide> =
        (0..bands.len()).flat_map(|band| [0, 1].map(|branch| BandSide { band, branch })).collect();
    let mut rings = Vec::new();
    while let Some(first) = free.pop() {
        let (mut ring, mut side) = (vec![first], first);
        loop {
            side = next(bands, side);
            if side == first {
                break;
            }
            // Two intervals at one ξ overlap only by rounding if no side is left. The loop is then closed here.
            let Some(place) = free.iter().position(|other| *other == side) else { break };
            ring.push(free.swap_remove(place));
        }
        rings.push(ring);
    }
    rings
}

/// Returns loops of \[ξ, η\] \[mm\] around the bands, with the patch on the left: outer loops are counter-clockwise, holes
/// clockwise. The first point is not repeated, and neighbouring points differ.
pub(super) fn loops(bands: &[Band], rows: &[Rows]) -> Vec<Vec<[f64; 2]>> {
    let around = |ring: Vec<BandSide>| {
        let mut points = Vec::new();
        for side in ring {
            let rows = rows[side.band].iter();
            if side.branch == 0 {
                points.extend(rows.map(|[xi, low, _]| [*xi, *low]));
            } else {
                points.extend(rows.rev().map(|[xi, _, high]| [*xi, *high]));
            }
        }
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points
    };
    rings(bands).into_iter().map(around).collect()
}

/// Returns the side on which a loop continues after the given side.
fn next(bands: &[Band], BandSide { band, branch }: BandSide) -> BandSide {
    let (end, here) = (1 - branch, &bands[band]);
    let (xi, eta) = (here.xi[end], here.sides[end][branch]);
    // `across` finds bands on the other side of the line ξ, `along` those on the same side.
    let across = |k: usize| bands[k].xi[1 - end] == xi;
    let along = |k: usize| bands[k].xi[end] == xi;
    // Turns η so that the loop moves upwards along the line ξ.
    let up = |value: f64| if branch == 0 { value } else { -value };
    let near = |k: usize| up(bands[k].sides[1 - end][branch]);
    let far = |k: usize| up(bands[k].sides[1 - end][1 - branch]);
    let start = up(eta);
    let others = || (0..bands.len()).filter(|&k| across(k));
    match others().find(|&k| near(k) <= start && start < far(k)) {
        // A band on the other side is here. The loop moves back along it, to its own edge or to the first band that it
        // meets on this side.
        Some(beside) => {
            let last = |k: &usize| up(bands[*k].sides[end][1 - branch]);
            let own = (0..bands.len()).filter(|&k| along(k) && k != band);
            let before = own.filter(|k| last(k) <= start && last(k) > near(beside));
            let before = before.max_by(|p, q| last(p).total_cmp(&last(q)));
            before.map_or(BandSide { band: beside, branch }, |band| BandSide { band, branch: 1 - branch })
        }
        // No band on the other side is here. The loop moves on, to the other side of its own band or to the first band
        // that it meets on the other side of the line.
        None => {
            let limit = up(here.sides[end][1 - branch]);
            let before = others().filter(|&k| start <= near(k) && near(k) < limit);
            let before = before.min_by(|&p, &q| near(p).total_cmp(&near(q)));
            before.map_or(BandSide { band, branch: 1 - branch }, |band| BandSide { band, branch })
        }
    }
}

/// Returns the area that a loop encloses \[mm²\], positive if the loop is counter-clockwise.
pub(super) fn enclosed(points: &[[f64; 2]]) -> f64 {
    let Some([x, y]) = points.first() else { return 0.0 };
    let pairs = points.iter().zip(points.iter().cycle().skip(1));
    pairs.map(|(p, q)| ((p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y)) / 2.0).sum()
}

/// Returns the length \[mm\] of the boundary along lines of constant ξ: there bands end or begin and no other band
/// continues.
pub(super) fn walls(bands: &[Band]) -> f64 {
    let width = |side: Interval| side.width().max(0.0);
    let sides = bands.iter().flat_map(|band| band.sides).map(width).sum::<f64>();
    let common = bands.iter().flat_map(|left| bands.iter().map(move |right| (left, right)));
    let common = common.filter(|(left, right)| left.xi.high == right.xi.low);
    let common = common.map(|(left, right)| width(left.sides[1].cut(right.sides[0])));
    sides - 2.0 * common.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(xi: [f64; 2], sides: [[f64; 2]; 2]) -> Band {
        Band::new(xi.into(), [None; 2], sides.map(Interval::from), Interval::ALL)
    }

    /// Returns the loops of bands with straight sides.
    fn around(bands: &[Band]) -> Vec<Vec<[f64; 2]>> {
        let row = |band: &Band, k: usize| [band.xi[k], band.sides[k][0], band.sides[k][1]];
        loops(bands, &bands.iter().map(|band| vec![row(band, 0), row(band, 1)]).collect::<Vec<_>>())
    }

    #[test]
    fn a_fork_is_one_loop() {
        let bands = [
            band([0.0, 1.0], [[0.0; 2], [-2.0, 2.0]]),
            band([1.0, 3.0], [[-2.0, 0.5], [-1.0; 2]]),
            band([1.0, 2.0], [[0.5, 2.0], [1.0; 2]]),
        ];
        let loops = around(&bands);
        assert_eq!(loops.len(), 1, "{loops:?}");
        assert!((enclosed(&loops[0]) - (2.0 + 2.5 + 0.75)).abs() < 1e-15, "{loops:?}");
        assert_eq!(walls(&bands), 0.0);
    }

    #[test]
    fn a_hole_runs_clockwise() {
        let bands = [
            band([0.0, 1.0], [[0.0; 2], [-2.0, 2.0]]),
            band([1.0, 2.0], [[-2.0, 0.0], [-2.0, 0.0]]),
            band([1.0, 2.0], [[0.0, 2.0], [0.5, 2.0]]),
            band([2.0, 3.0], [[-2.0, 2.0], [0.0; 2]]),
        ];
        let mut areas: Vec<f64> = around(&bands).iter().map(|points| enclosed(points)).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas, [-0.25, 8.0]);
        assert_eq!(walls(&bands), 0.5);
    }

    #[test]
    fn a_step_is_drawn_along_its_line() {
        let bands =
            [band([0.0, 1.0], [[-1.0, 1.0], [-1.0, 1.0]]), band([1.0, 2.0], [[-3.0, 0.5], [-3.0, 0.5]])];
        let loops = around(&bands);
        assert_eq!(loops.len(), 1);
        assert!((enclosed(&loops[0]) - 5.5).abs() < 1e-15 && loops[0].len() == 8, "{loops:?}");
        assert_eq!(walls(&bands), 2.0 + 3.5 + 2.5);
    }
}
