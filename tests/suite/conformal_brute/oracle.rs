//! The normal gap by brute force: points of a line in space, each taken to the wheel's profile by its distance from the axle.

use wheelrail::Placement;
use wheelrail::conformal::RailPoint;
use wheelrail::nalgebra::{Isometry2, Point2, UnitComplex, Vector2};

/// How far from the rail's point both ways the wheel is looked for \[mm\].
const REACH: f64 = 150.0;

/// Distances \[mm\] of the points of a line that is followed coarsely, near the rail's point and far from it, and how near that
/// is.
const STEPS: [f64; 2] = [0.1, 0.5];
const NEAR: f64 = 6.0;

/// Number of parts of a step in which the end of the wheel lies.
const PARTS: usize = 64;

/// Largest depth \[mm\] that a point of the surface has by rounding. More is a step of the profile.
const ON_SURFACE: f64 = 1e-6;

/// |t| \[mm\] below which rounding decides on which side of the wheel's surface the rail's point lies.
const TOUCHING: f64 = 1e-9;

/// A wheel as the surface of revolution of its profile's heights about its axle.
pub struct Revolved<'a> {
    placement: &'a Placement,
    frame: Isometry2<f64>,
    skew: UnitComplex<f64>,
}

/// A line from a point of the rail along its normal, over the contact frame.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// Rail's point (ξ, η, ζ) \[mm\].
    pub from: [f64; 3],
    /// (n_ξ, n_ζ).
    pub normal: [f64; 2],
}

impl Line {
    pub fn new(at: &RailPoint, eta: f64) -> Self {
        Self { from: [at.xi, eta, at.zeta], normal: [-at.sin, at.cos] }
    }

    fn at(&self, t: f64) -> [f64; 3] {
        let ([xi, eta, zeta], [along, up]) = (self.from, self.normal);
        [xi + t * along, eta, zeta + t * up]
    }
}

impl<'a> Revolved<'a> {
    pub fn new(placement: &'a Placement) -> Self {
        let (frame, skew) = (placement.wheel().contact_frame(), placement.skew_rotation());
        Self { placement, frame, skew }
    }

    /// Takes a point of space \[mm\] to the profile's plane, in the contact frame; `None` behind the axle.
    pub fn flat(&self, [xi, eta, zeta]: [f64; 3]) -> Option<Point2<f64>> {
        let own = self.skew.inverse_transform_vector(&Vector2::new(xi, eta));
        let place = self.frame * Point2::new(own.x, zeta);
        let (radius, below) = (self.placement.wheel_radius(), self.placement.wheel_radius() - place.y);
        let on_plane = Point2::new(place.x, radius - below.hypot(own.y));
        (below > 0.0).then(|| self.frame.inverse_transform_point(&on_plane))
    }

    /// Depth of a point in the wheel's material along ζ \[mm\], negative outside; `None` beside the profile.
    pub fn depth(&self, at: [f64; 3]) -> Option<f64> {
        let flat = self.flat(at)?;
        Some(flat.y - self.placement.wheel().section().height(flat.x)).filter(|depth| !depth.is_nan())
    }

    /// All t \[mm\], ascending, at which a line enters the material, each with whether it does so through the profile's
    /// outer surface and not through a step or the end of it. The line is followed in steps that are `finer` times shorter.
    pub fn entries(&self, line: &Line, finer: f64) -> Vec<(f64, bool)> {
        let mut found = Vec::new();
        let depth = |t: f64| self.depth(line.at(t));
        let mut before = (-REACH, depth(-REACH));
        while before.0 < REACH {
            let step = STEPS[usize::from(before.0.abs() >= NEAR)] / finer;
            let next = (before.0 + step, depth(before.0 + step));
            if before.1.is_some() == next.1.is_some() {
                found.extend(self.entry(line, before, next));
            } else {
                let mut last = before;
                for k in 1..=PARTS {
                    let t = before.0 + step * k as f64 / PARTS as f64;
                    let part = (t, depth(t));
                    found.extend(self.entry(line, last, part));
                    last = part;
                }
            }
            before = next;
        }
        found
    }

    /// The entry between two places with their depths, by bisection.
    fn entry(&self, line: &Line, a: (f64, Option<f64>), b: (f64, Option<f64>)) -> Option<(f64, bool)> {
        let outside = |depth: Option<f64>| depth.is_none_or(|depth| depth < 0.0);
        let (mut low, mut high) = (a, b);
        if !outside(low.1) || outside(high.1) {
            return None;
        }
        loop {
            let t = low.0 + (high.0 - low.0) / 2.0;
            if t == low.0 || t == high.0 {
                break;
            }
            let middle = (t, self.depth(line.at(t)));
            *if outside(middle.1) { &mut low } else { &mut high } = middle;
        }
        let through = low.1.zip(high.1).is_some_and(|(low, high)| high - low <= ON_SURFACE);
        Some((high.0, through))
    }

    /// t \[mm\] of the first entry of a line into the material; `None` if there is none, or if it is not through the profile's
    /// outer surface.
    pub fn first_entry(&self, line: &Line, finer: f64) -> Option<f64> {
        self.entries(line, finer).first().and_then(|&(t, through)| through.then_some(t))
    }

    /// The normal gap \[mm\]: outside of the material the first entry above the rail's point, inside of it the last one below.
    pub fn gap(&self, line: &Line, finer: f64) -> Option<f64> {
        let entries = self.entries(line, finer);
        let touching = entries.iter().copied().find(|(t, _)| t.abs() < TOUCHING);
        let entry = touching.or_else(|| {
            if self.depth(line.from).is_some_and(|depth| depth > 0.0) {
                return entries.iter().copied().rfind(|&(t, _)| t < 0.0);
            }
            entries.iter().copied().find(|&(t, _)| t > 0.0)
        });
        entry.and_then(|(t, through)| through.then_some(t))
    }
}
