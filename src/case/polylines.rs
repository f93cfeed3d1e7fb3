//! The profiles of a case as pages draw them.

use super::input::{Profiles, SideProfiles};
use crate::export::{PageCut, PagePair, PageProfile};
use crate::profile::{Profile, points_along};

/// Distance of a profile's points \[mm\].
const STEP: f64 = 0.25;

/// Most points of a profile; only measured profiles have more.
const MOST_POINTS: usize = 1200;

/// Largest distance \[mm\] of a section from the fewer points that it is drawn by: far less than a pixel shows.
const DRAWN_WITHIN: f64 = 0.01;

/// Gives the profiles of all sides, the right-hand one's first.
pub(super) fn pairs(profiles: &Profiles) -> Vec<PagePair> {
    let pair = |side: &SideProfiles| {
        let [rail, wheel] = [side.pair.rail(), side.pair.wheel()].map(polyline);
        PagePair { rail, wheel, radius: side.pair.wheel_radius(), roller: side.pair.roller_radius() }
    };
    profiles.sides().map(|(_, side)| pair(side)).collect()
}

/// Gives a profile as points at most [`STEP`] apart; one of very many points is thinned.
pub(crate) fn polyline(profile: &Profile) -> PageProfile {
    let points = thinned(&points_along(profile, STEP), MOST_POINTS);
    let (x, z) = points.iter().map(|at| (at.x, at.y)).unzip();
    PageProfile { name: profile.title().to_owned(), x, z }
}

/// Gives at most about `most` of some items, evenly chosen, the first and the last among them.
pub(super) fn thinned<T: Copy>(items: &[T], most: usize) -> Vec<T> {
    let stride = items.len().div_ceil(most).max(1);
    let mut kept: Vec<T> = items.iter().step_by(stride).copied().collect();
    if stride > 1 && !(items.len() - 1).is_multiple_of(stride) {
        kept.extend(items.last());
    }
    kept
}

/// Gives the pieces of a section with as few points as lie within [`DRAWN_WITHIN`] of all.
pub(super) fn page_cut(pieces: &[Vec<[f64; 2]>]) -> PageCut {
    let mut out = Vec::new();
    for piece in pieces {
        if !out.is_empty() {
            out.extend([f64::NAN; 2]);
        }
        out.extend(simplified(piece, DRAWN_WITHIN).into_iter().flatten());
    }
    PageCut(out)
}

/// Simplifies a polyline: points that are left out lie within a distance \[mm\] of the line between those that stay beside them.
///
/// Method: Ramer, Douglas and Peucker's, which keeps the farthest point first.
fn simplified(points: &[[f64; 2]], within: f64) -> Vec<[f64; 2]> {
    let mut stays = vec![false; points.len()];
    let mut open = vec![[0, points.len().saturating_sub(1)]];
    while let Some([from, to]) = open.pop() {
        let (Some(a), Some(b)) = (points.get(from), points.get(to)) else { break };
        (stays[from], stays[to]) = (true, true);
        let off = |k: &usize| distance(points[*k], [*a, *b]);
        let farthest = (from + 1..to).max_by(|j, k| off(j).total_cmp(&off(k)));
        if let Some(k) = farthest.filter(|k| off(k) > within) {
            open.extend([[from, k], [k, to]]);
        }
    }
    points.iter().zip(stays).filter_map(|(point, stays)| stays.then_some(*point)).collect()
}

/// Distance \[mm\] of a point from the line between two others, not beyond its ends.
fn distance([x, z]: [f64; 2], [[x0, z0], [x1, z1]]: [[f64; 2]; 2]) -> f64 {
    let [dx, dz] = [x1 - x0, z1 - z0];
    let share = ((x - x0) * dx + (z - z0) * dz) / (dx * dx + dz * dz);
    // The ends may be one point.
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    (x - x0 - share * dx).hypot(z - z0 - share * dz)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_lie_near_all() {
        let circle: Vec<[f64; 2]> =
            (0..=400).map(|k| (f64::from(k) * 0.01).sin_cos()).map(|(s, c)| [13.0 * s, 13.0 * c]).collect();
        let few = simplified(&circle, 0.01);
        // Halving divides it into 64 parts, where 52 would do.
        assert!(few.len() <= 65 && few[0] == circle[0] && few[few.len() - 1] == circle[400], "{}", few.len());
        for point in &circle {
            let off =
                few.windows(2).map(|pair| distance(*point, [pair[0], pair[1]])).fold(f64::INFINITY, f64::min);
            assert!(off <= 0.01, "{point:?}: {off}");
        }
        assert_eq!(simplified(&[[1.0, 2.0]; 5], 0.01), [[1.0, 2.0]; 2]);
        assert!(simplified(&[], 0.01).is_empty());
        let PageCut(cut) =
            page_cut(&[vec![[0.0, 1.0], [1.0, 1.0], [2.0, 1.0]], vec![[3.0, 0.0], [4.0, 0.0]]]);
        assert!(cut.len() == 10 && cut[4].is_nan() && cut[6..] == [3.0, 0.0, 4.0, 0.0], "{cut:?}");
    }
}
