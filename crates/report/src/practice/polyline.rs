//! Turns profiles into chains of chords, and finds their outermost heights: the data of brute force. Nothing here uses the
//! sections, searches and kernels that it checks.

use wheelrail::Interval;
use wheelrail::profile::{Profile, trace};

/// Distance \[mm\] of a chain's points. Its chords are 1.3e-5 mm off a radius of 1 mm, which is that of a lip.
const STEP: f64 = 0.01;
/// Width \[mm\] of the bins in which chords are looked up: some ten chords.
const BIN: f64 = 0.05;

/// A vertex of a profile with its unit tangent.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub x: f64,
    pub z: f64,
    pub cos: f64,
    pub sin: f64,
}

/// Returns the vertices of a profile, from left to right, with both sides of its joints.
pub(super) fn vertices(profile: &Profile) -> Vec<Vertex> {
    let vertex = |station: wheelrail::profile::Station| Vertex {
        x: station.x,
        z: station.z,
        cos: station.cos,
        sin: station.sin,
    };
    trace(profile, STEP).iter().map(|mark| vertex(mark.station)).collect()
}

/// The direction in which a surface faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Facing {
    /// Upwards: the highest point counts.
    Up,
    /// Downwards: the lowest point counts.
    Down,
}

impl Facing {
    fn outer(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Up => a.max(b),
            Self::Down => a.min(b),
        }
    }
}

/// A chain of chords whose outermost height is taken at many places.
#[derive(Debug)]
pub(super) struct Polyline {
    points: Vec<[f64; 2]>,
    facing: Facing,
    left: f64,
    /// Indices of the chords over each bin.
    bins: Vec<Vec<usize>>,
}

impl Polyline {
    pub fn new(points: Vec<[f64; 2]>, facing: Facing) -> Self {
        let reach = Interval::around(points.iter().map(|p| p[0]));
        let count = if reach.is_empty() { 0 } else { (reach.width() / BIN) as usize + 1 };
        let mut bins = vec![Vec::new(); count];
        for (k, pair) in points.windows(2).enumerate() {
            let bin = |x: f64| ((x - reach.low) / BIN) as usize;
            let [a, b] = [bin(pair[0][0].min(pair[1][0])), bin(pair[0][0].max(pair[1][0]))];
            bins[a..=b].iter_mut().for_each(|bin| bin.push(k));
        }
        Self { points, facing, left: reach.low, bins }
    }

    /// Returns the outermost height at an abscissa; `None` beside the chain.
    pub fn height(&self, x: f64) -> Option<f64> {
        let bin = (x >= self.left).then(|| ((x - self.left) / BIN) as usize)?;
        let chords = self
            .bins
            .get(bin)?
            .iter()
            .filter_map(|&k| over(self.points[k], self.points[k + 1], x, self.facing));
        chords.reduce(|a, b| self.facing.outer(a, b))
    }

    /// Returns the abscissae of the chain's points.
    pub fn abscissae(&self) -> impl Iterator<Item = f64> {
        self.points.iter().map(|p| p[0])
    }
}

/// Returns the height of a chord at an abscissa; for a vertical chord, that of its outer end.
fn over(a: [f64; 2], b: [f64; 2], x: f64, facing: Facing) -> Option<f64> {
    let [low, high] = [a[0].min(b[0]), a[0].max(b[0])];
    if x < low || x > high {
        return None;
    }
    if low == high {
        return Some(facing.outer(a[1], b[1]));
    }
    Some(a[1] + (b[1] - a[1]) * ((x - a[0]) / (b[0] - a[0])))
}

/// Returns the outermost height of a chain at one abscissa, without bins: for chains that are asked once.
pub(super) fn outermost(points: impl Iterator<Item = [f64; 2]>, x: f64, facing: Facing) -> Option<f64> {
    let mut before: Option<[f64; 2]> = None;
    let mut out: Option<f64> = None;
    for point in points {
        let height = before.and_then(|before| over(before, point, x, facing));
        out = match (out, height) {
            (Some(a), Some(b)) => Some(facing.outer(a, b)),
            (a, b) => a.or(b),
        };
        before = Some(point);
    }
    out
}
