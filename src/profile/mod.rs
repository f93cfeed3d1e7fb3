//! Profiles (Report Sec. 3, Appendix A): chains of lines, arcs and polynomials, as drawings and standards
//! define them, in profile axes (x lateral, z up, mm).

mod arc;
pub mod builder;
pub mod closing;
pub mod continuity;
mod groove;
mod inclination;
mod polynomial;
mod section;
pub mod standards;
pub mod trace;

pub use arc::{Arc, Half};
pub use closing::ONE_JOINT;
pub use groove::last_groove;
pub use inclination::inclination;
pub use polynomial::Polynomial;
pub use section::{
    ArcBranch, Branch, BranchPoint, BranchPoints, BranchShape, Branches, Piece, PolynomialBranch,
    ProfilePoint, Section, Side, stationary_points,
};
pub mod drawing;

use nalgebra::UnitComplex;

use crate::error::{Error, Result};
use closing::Closing;

/// A point of a profile with its unit tangent in the direction of travel (towards larger x on a graph).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Lateral coordinate \[mm\].
    pub x: f64,
    /// Height \[mm\].
    pub z: f64,
    /// cos φ, φ the tangent's angle from x to z.
    pub cos: f64,
    /// sin φ.
    pub sin: f64,
}

impl Station {
    /// The profile's own axes: origin (0, 0), tangent along x.
    pub const AXES: Self = Self { x: 0.0, z: 0.0, cos: 1.0, sin: 0.0 };

    /// Tangent angle φ \[rad\] in (−π, π\].
    pub fn angle(&self) -> f64 {
        self.sin.atan2(self.cos)
    }

    /// This station seen from the frame whose origin and first axis are `frame`: eqs. (4.2-a, b).
    #[must_use]
    pub fn seen_from(&self, frame: &Self) -> Self {
        let (dx, dz) = (self.x - frame.x, self.z - frame.z);
        Self {
            x: dx * frame.cos + dz * frame.sin,
            z: dz * frame.cos - dx * frame.sin,
            cos: self.cos * frame.cos + self.sin * frame.sin,
            sin: self.sin * frame.cos - self.cos * frame.sin,
        }
    }

    /// The inverse of [`Station::seen_from`]: eqs. (4.3-a, b).
    #[must_use]
    pub fn placed_by(&self, frame: &Self) -> Self {
        Self {
            x: frame.x + self.x * frame.cos - self.z * frame.sin,
            z: frame.z + self.x * frame.sin + self.z * frame.cos,
            cos: self.cos * frame.cos - self.sin * frame.sin,
            sin: self.sin * frame.cos + self.cos * frame.sin,
        }
    }

    /// The mirror image under x → −x, still travelled towards larger x.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { x: -self.x, z: self.z, cos: self.cos, sin: -self.sin }
    }
}

/// The shape of one segment.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A line or a circular arc, eqs. (3.2).
    Arc(Arc),
    /// A polynomial z(x) of a standard, or one span of a parametric spline.
    Polynomial(Polynomial),
}

/// One segment of a chain.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// The drawing's name of the segment, or empty.
    pub label: String,
    /// Its shape.
    pub shape: Shape,
}

impl Segment {
    /// A line or arc without a label.
    pub fn arc(arc: Arc) -> Self {
        Self { label: String::new(), shape: Shape::Arc(arc) }
    }

    /// The station at its beginning.
    pub fn start(&self) -> Station {
        match &self.shape {
            Shape::Arc(arc) => arc.start,
            Shape::Polynomial(polynomial) => polynomial.station(polynomial.t[0]),
        }
    }

    /// The station at its end.
    pub fn end(&self) -> Station {
        match &self.shape {
            Shape::Arc(arc) => arc.end,
            Shape::Polynomial(polynomial) => polynomial.station(polynomial.t[1]),
        }
    }

    /// Curvature \[1/mm\] at its two ends, positive where it turns counter-clockwise (hollow side up).
    pub fn end_curvatures(&self) -> [f64; 2] {
        match &self.shape {
            Shape::Arc(arc) => [arc.curvature(); 2],
            Shape::Polynomial(polynomial) => polynomial.t.map(|t| polynomial.curvature(t)),
        }
    }

    /// "segment 3 (R80)", counted from 1.
    pub fn place(&self, index: usize) -> String {
        let number = index + 1;
        if self.label.is_empty() {
            format!("segment {number}")
        } else {
            format!("segment {number} ({})", self.label)
        }
    }

    fn map(&self, arc: impl Fn(&Arc) -> Arc, polynomial: impl Fn(&Polynomial) -> Polynomial) -> Self {
        let shape = match &self.shape {
            Shape::Arc(a) => Shape::Arc(arc(a)),
            Shape::Polynomial(p) => Shape::Polynomial(polynomial(p)),
        };
        Self { label: self.label.clone(), shape }
    }
}

/// A chain of segments, travelled from left to right, with its name and source.
///
/// Neighbours share their joint point, to rounding: a drawing's rounded coordinates are closed when the chain is made, by the
/// rule of [`closing`].
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Name of the standard, or of the file.
    pub name: String,
    /// Where the numbers come from.
    pub source: String,
    /// The segments, at least one.
    segments: Vec<Segment>,
    /// The segments before they were closed; empty where that changed nothing but roundings.
    drawn: Vec<Segment>,
    closings: Vec<Closing>,
    /// The larger side of the box around the segments' ends \[mm\].
    extent: f64,
}

impl Profile {
    /// A chain of at least one segment that nowhere jumps, closed by the rule of [`closing`].
    ///
    /// Kinks are allowed at any angle: see [`Profile::continuity`].
    ///
    /// # Errors
    /// An empty chain; a joint with a step larger than [`continuity::LARGEST_STEP`] × the chain's extent, or than the short
    /// segment beside it can take, with its place and size.
    pub fn new(name: impl Into<String>, source: impl Into<String>, drawn: Vec<Segment>) -> Result<Self> {
        if drawn.is_empty() {
            return Err(Error::new(
                "segments",
                "none",
                "at least one segment",
                "give the profile's segments",
            ));
        }
        let extent = extent(&drawn);
        continuity::reject_jumps(&drawn, extent)?;
        let (segments, closings) = closing::close(&drawn, extent)?;
        let drawn = if closings.is_empty() { Vec::new() } else { drawn };
        Ok(Self::closed(name.into(), source.into(), [segments, drawn], closings))
    }

    fn closed(
        name: String,
        source: String,
        [segments, drawn]: [Vec<Segment>; 2],
        closings: Vec<Closing>,
    ) -> Self {
        let extent = extent(&segments);
        Self { name, source, segments, drawn, closings, extent }
    }

    /// The segments from left to right.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The segments as they were given, before the chain was closed.
    pub fn drawn(&self) -> &[Segment] {
        if self.drawn.is_empty() { &self.segments } else { &self.drawn }
    }

    /// Where and by how much the drawn chain was changed to close it, from left to right.
    pub fn closings(&self) -> &[Closing] {
        &self.closings
    }

    /// The closing that moved the drawn surface most, with its joint point [x, z] \[mm\]; `None` for a chain drawn without steps.
    pub fn largest_closing(&self) -> Option<(Closing, [f64; 2])> {
        let largest = self.closings.iter().max_by(|a, b| a.moved.total_cmp(&b.moved))?;
        let joint = self.segments[largest.left].end();
        Some((*largest, [joint.x, joint.z]))
    }

    /// Gap, kink and curvature jump at every joint.
    pub fn continuity(&self) -> Vec<continuity::Joint> {
        continuity::joints(&self.segments)
    }

    /// The larger side of the box around all segment ends \[mm\]: the scale that rounding is judged by.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// The profile turned about its origin, counter-clockwise from x to z. For 1:n see [`inclination()`].
    #[must_use]
    pub fn rotated(&self, turn: UnitComplex<f64>) -> Self {
        self.placed(&Station { x: 0.0, z: 0.0, cos: turn.re, sin: turn.im })
    }

    /// The profile moved by (x, z) \[mm\].
    #[must_use]
    pub fn shifted(&self, x: f64, z: f64) -> Self {
        self.placed(&Station { x, z, ..Station::AXES })
    }

    /// The mirror image under x → −x.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut mirrored = self.mapped(|s| s.map(Arc::mirrored, Polynomial::mirrored));
        mirrored.segments.reverse();
        mirrored.drawn.reverse();
        mirrored.closings.reverse();
        for closing in &mut mirrored.closings {
            // The segment on the other side of the same joint.
            closing.left = self.segments.len() - 2 - closing.left;
        }
        mirrored
    }

    fn placed(&self, frame: &Station) -> Self {
        self.mapped(|s| s.map(|a| a.placed_by(frame), |p| p.placed_by(frame)))
    }

    fn mapped(&self, image: impl Fn(&Segment) -> Segment) -> Self {
        let chains = [&self.segments, &self.drawn].map(|all| all.iter().map(&image).collect());
        Self::closed(self.name.clone(), self.source.clone(), chains, self.closings.clone())
    }
}

/// The larger side of the box around all segment ends \[mm\].
fn extent(segments: &[Segment]) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for station in segments.iter().flat_map(|s| [s.start(), s.end()]) {
        for (k, v) in [station.x, station.z].into_iter().enumerate() {
            low[k] = low[k].min(v);
            high[k] = high[k].max(v);
        }
    }
    (high[0] - low[0]).max(high[1] - low[1])
}
