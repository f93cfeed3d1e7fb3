//! Finds where the boundary of a patch may have a corner, and where it turns back in η.

use super::band::{Band, ONE_CORNER, extrapolated, halved};
use super::lines::sections;
use super::loops::Rows;
use super::slice::Slicer;
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, change, last_where};

/// Number of steps along a band between which an edge is followed from joint to joint.
const JOINT_PLACES: usize = 32;

/// Appends the ξ or σ inside a band at which an edge passes a joint of the wheel or of a roller, on a roller and over the rail's
/// surface.
///
/// Method: the abscissae of the profiles' points under both edges are followed from tip to tip; between two places on different sides
/// of a joint a root is sought. Degenerate case: a joint that an edge passes twice between two of these places is left to the
/// boundary's interpolants. Over the rail's surface the ends and steps of the wheel's surface count, too.
pub(super) fn over_joints(slicer: &mut Slicer<'_>, band: &Band, corners: &mut Vec<f64>) {
    let grading = band.grading();
    let mut trail = JointTrail { slicer, band, known: [[f64::NAN; 3]; 2] };
    let mut before = trail.feet(band.xi.low);
    for k in 1..=JOINT_PLACES {
        let xi = if k == JOINT_PLACES { band.xi.high } else { grading.xi(k as f64 / JOINT_PLACES as f64) };
        let here = trail.feet(xi);
        if let (Some(before), Some(here)) = (&before, &here) {
            trail.between([before, here], ONE_CORNER * band.xi.width(), corners);
        }
        before = here;
    }
    corners.retain(|xi| band.xi.surrounds(*xi));
}

/// Both edges of a slice, and the profiles' points under them.
struct EdgeFeet {
    /// ξ or σ \[mm\].
    xi: f64,
    /// η \[mm\].
    edges: [f64; 2],
    /// For each edge the abscissae on the wheel and on a roller \[mm\].
    abscissae: [[f64; 2]; 2],
}

/// Follows the points of the profiles under the edges of a band.
struct JointTrail<'t, 'a> {
    slicer: &'t mut Slicer<'a>,
    band: &'t Band,
    /// ξ, the square of half the width and the middle of two slices, from which others are guessed.
    known: [[f64; 3]; 2],
}

impl JointTrail<'_, '_> {
    /// Finds the edges at ξ and the profiles' points under them; `None` outside the patch.
    fn feet(&mut self, xi: f64) -> Option<EdgeFeet> {
        let valley = self.band.lane;
        let near = self.slicer.edges_near(xi, valley, extrapolated(&self.known, xi));
        let edges = near.or_else(|| self.slicer.edges(xi, valley))?;
        self.known = [self.known[1], halved(xi, edges)];
        let abscissae = edges.map(|eta| self.slicer.abscissae(xi, eta));
        Some(EdgeFeet { xi, edges, abscissae })
    }

    /// Appends the ξ between two places, to within `enough` \[mm\], at which an edge passes a joint.
    fn between(&mut self, ends: [&EdgeFeet; 2], enough: f64, corners: &mut Vec<f64>) {
        let mirrored = self.slicer.is_mirrored(self.band.lane);
        let sides = if mirrored { 1..2 } else { 0..2 };
        self.known = ends.map(|end| halved(end.xi, end.edges));
        for (side, body) in sides.flat_map(|side| [(side, 0), (side, 1)]) {
            let [from, to] = ends.map(|end| end.abscissae[side][body]);
            let Some(section) = sections(self.slicer.placement())[body] else { continue };
            let over = Interval::between(from, to);
            let mut joints: Vec<f64> = section.joints(over).map(|(p, _)| p).collect();
            joints.dedup();
            for joint in joints.into_iter().filter(|joint| over.surrounds(*joint)) {
                // Negative at the first of the two places.
                let outwards = if from < joint { 1.0 } else { -1.0 };
                let beyond = |xi: f64| outwards * (self.abscissa(xi, side, body) - joint);
                corners.push(change(beyond, ends.map(|end| end.xi), enough));
            }
        }
    }

    /// Returns the abscissa \[mm\] of the point of one body under one edge at ξ; NaN where there is none.
    fn abscissa(&mut self, xi: f64, side: usize, body: usize) -> f64 {
        let near = self.slicer.edge_near(xi, extrapolated(&self.known, xi), side);
        let edge = near.or_else(|| Some(self.slicer.edges(xi, self.band.lane)?[side]));
        edge.map_or(f64::NAN, |eta| self.slicer.abscissae(xi, eta)[body])
    }
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
