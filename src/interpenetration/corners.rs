//! Where the boundary of a part may have a corner, and where it turns back in η.

use super::outline::{End, Outline, Part, ascending};
use super::slice::Edge;
use crate::numerics::roots::bracketed;

/// One ξ of the boundary: both ends of the slice, and the wheel's profile abscissa under them.
#[derive(Debug, Clone, Copy)]
struct Sample {
    xi: f64,
    eta: [f64; 2],
    foot: [f64; 2],
    ledge: [bool; 2],
}

impl Outline<'_> {
    /// Both ends of a part and all ξ between where its boundary may have a corner: joints of the two profiles,
    /// joints of the wheel that the boundary crosses off the midplane (erratum 6), and where it meets the window or
    /// the end of a surface.
    /// What happens twice between two of `nodes`, which hold the joints, is missed.
    pub(super) fn corners(&mut self, part: &Part, nodes: &[f64]) -> Vec<f64> {
        let [a, b] = part.xi;
        let mut corners = vec![a];
        corners.extend(self.slicer.placement().joints(a, b));
        corners.push(b);
        let targets = self.targets();
        let samples: Vec<Sample> = nodes.iter().map(|&xi| self.sample(part, xi)).collect();
        for pair in samples.windows(2) {
            corners.extend((0..2).filter_map(|branch| self.ledge_begin(part, branch, &pair[0], &pair[1])));
            corners
                .extend(targets.iter().filter_map(|target| self.crossing(part, target, &pair[0], &pair[1])));
        }
        ascending(corners)
    }

    /// The finite window edges and the wheel's joints, for each branch that is not the mirror image of the other.
    fn targets(&self) -> Vec<Target> {
        let placement = self.slicer.placement();
        let [skewed, tilted] = [placement.skew != 0.0, placement.wheel.section.frame.sin != 0.0];
        let mut targets = Vec::new();
        for branch in 0..2 {
            let edges = self.window.eta.into_iter().filter(|edge| edge.is_finite());
            targets.extend(edges.map(|value| Target { branch, foot: false, value }));
            if skewed || (tilted && branch == 1) {
                let pieces = &placement.wheel.section.pieces;
                let joints = pieces.iter().skip(1).map(|piece| piece.xi[0]);
                targets.extend(joints.map(|value| Target { branch, foot: true, value }));
            }
        }
        targets
    }

    /// The boundary without the window; at a tip, and where rounding finds no width beside it, its lowest point.
    fn sample(&mut self, part: &Part, xi: f64) -> Sample {
        let tip = (0..2).any(|k| xi == part.xi[k] && part.ends[k] == End::Tip);
        let (xi, at) = (part.beside_fork(xi), xi);
        let valley = part.valley(xi);
        let edges = self.slicer.edges(xi, valley).filter(|_| !tip);
        let lowest = |k| self.slicer.spot(k, xi).eta;
        let edges = edges.unwrap_or_else(|| [Edge { eta: valley.map_or(0.0, lowest), ledge: false }; 2]);
        let eta = edges.map(|edge| edge.eta);
        let foot = eta.map(|eta| self.slicer.foot_abscissa(xi, eta));
        Sample { xi: at, eta, foot, ledge: edges.map(|edge| edge.ledge) }
    }

    /// Where a branch passes from s = δ to the end of a surface, or back.
    fn ledge_begin(&mut self, part: &Part, branch: usize, from: &Sample, to: &Sample) -> Option<f64> {
        if from.ledge[branch] == to.ledge[branch] || from.eta[branch].is_nan() || to.eta[branch].is_nan() {
            return None;
        }
        let (mut a, mut b) = (from.xi, to.xi);
        loop {
            let middle = a + (b - a) / 2.0;
            if middle == a || middle == b {
                return Some(middle);
            }
            if self.sample(part, middle).ledge[branch] == from.ledge[branch] {
                a = middle
            } else {
                b = middle
            }
        }
    }

    fn crossing(&mut self, part: &Part, target: &Target, from: &Sample, to: &Sample) -> Option<f64> {
        let (p, q) = (target.miss(from), target.miss(to));
        let change = p * q < 0.0;
        change.then(|| bracketed(|xi| target.miss(&self.sample(part, xi)), from.xi, to.xi)).flatten()
    }

    /// The ξ next to a node at which one branch is farthest out in η: between its neighbours, if it turns there.
    pub(super) fn turn_of_branch(&mut self, part: &Part, branch: usize, from: f64, to: f64) -> Option<f64> {
        bracketed(
            |xi| match self.edges(part.valley(xi), xi).map(|edges| edges[branch]) {
                Some(Edge { eta, ledge: false }) => self.slicer.gradient(xi, eta)[0],
                _ => f64::NAN,
            },
            from,
            to,
        )
    }
}

/// A value that one branch of the boundary may cross.
#[derive(Debug, Clone, Copy)]
struct Target {
    branch: usize,
    foot: bool,
    value: f64,
}

impl Target {
    fn miss(&self, sample: &Sample) -> f64 {
        (if self.foot { sample.foot } else { sample.eta })[self.branch] - self.value
    }
}
