//! One segment of a profile (Report Sec. 3): a line, an arc or a polynomial.

use serde::{Deserialize, Serialize};

use super::arc::Arc;
use super::polynomial::Polynomial;
use super::station::Station;
use crate::numerics::interval::Interval;

/// The curve of one segment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// A line or a circular arc, eqs. (3.2).
    Arc(Arc),
    /// A polynomial z(x) of a standard, or one span of a parametric spline.
    Polynomial(Polynomial),
}

/// A segment of a chain: a curve with a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// Name of the segment in the drawing, or empty.
    pub label: String,
    /// The curve.
    pub shape: Shape,
}

/// First word of the label of a segment that bridges what was not measured.
const GAP: &str = "gap";

impl Segment {
    /// Tells whether the segment bridges what was not measured: a gap between points of a file, or a point off the curve. Its curve is
    /// no surface. It keeps the name through every motion and in files of segments.
    pub fn is_gap(&self) -> bool {
        self.gap().is_some()
    }

    /// Names the rows of the file that the segment bridges instead of showing a surface; empty where they are not known.
    pub fn gap(&self) -> Option<&str> {
        let rest = self.label.strip_prefix(GAP)?;
        if rest.is_empty() { Some(rest) } else { rest.strip_prefix(": ") }
    }

    /// Names the segment a bridge over what was not measured, with its rows in the file.
    pub(crate) fn name_gap(&mut self, rows: &str) {
        self.label = format!("{GAP}: {rows}");
    }

    /// Makes a segment of a line or arc, without a label.
    pub fn arc(arc: Arc) -> Self {
        Self { label: String::new(), shape: Shape::Arc(arc) }
    }

    /// Returns the station at the beginning.
    pub fn start(&self) -> Station {
        match &self.shape {
            Shape::Arc(arc) => arc.start,
            Shape::Polynomial(polynomial) => polynomial.station(polynomial.t[0]),
        }
    }

    /// Returns the station at the end.
    pub fn end(&self) -> Station {
        match &self.shape {
            Shape::Arc(arc) => arc.end,
            Shape::Polynomial(polynomial) => polynomial.station(polynomial.t[1]),
        }
    }

    /// Tells whether the curve has finite ends, and a radius or enough coefficients, as its constructors ensure.
    pub(super) fn is_sound(&self) -> bool {
        let enough = match &self.shape {
            Shape::Arc(arc) => !arc.radius.is_nan() && arc.radius != 0.0,
            Shape::Polynomial(polynomial) => polynomial.is_sound(),
        };
        let sound = |at: Station| [at.x, at.z, at.cos, at.sin].iter().all(|value| value.is_finite());
        enough && sound(self.start()) && sound(self.end())
    }

    /// Returns the curvature \[1/mm\] at the two ends, positive where the curve turns counter-clockwise (hollow side up).
    pub fn end_curvatures(&self) -> [f64; 2] {
        match &self.shape {
            Shape::Arc(arc) => [arc.curvature(); 2],
            Shape::Polynomial(polynomial) => polynomial.t.ends().map(|t| polynomial.curvature(t)),
        }
    }

    /// Returns the point at a share (0 to 1) of an arc's length or of a polynomial's range, and its first two derivatives by that share
    /// \[mm\].
    pub(crate) fn at_share(&self, share: f64) -> [[f64; 2]; 3] {
        match &self.shape {
            Shape::Arc(arc) => {
                let (at, length) = (arc.station_at(share), arc.length());
                let bend = length * length * arc.curvature();
                [[at.x, at.z], [length * at.cos, length * at.sin], [-bend * at.sin, bend * at.cos]]
            }
            Shape::Polynomial(polynomial) => {
                let about = polynomial.over(Interval::new(share, share + 1.0));
                let term = |k: usize, factor: f64| {
                    [0, 1].map(|axis: usize| about[axis].get(k).map_or(0.0, |c| factor * c))
                };
                [term(0, 1.0), term(1, 1.0), term(2, 2.0)]
            }
        }
    }

    /// Returns the name of the segment with this index for messages: "segment 3 (R80)", counted from 1.
    pub fn place(&self, index: usize) -> String {
        let number = index + 1;
        if self.label.is_empty() {
            format!("segment {number}")
        } else {
            format!("segment {number} ({})", self.label)
        }
    }

    pub(super) fn map(
        &self,
        arc: impl Fn(&Arc) -> Arc,
        polynomial: impl Fn(&Polynomial) -> Polynomial,
    ) -> Self {
        let shape = match &self.shape {
            Shape::Arc(a) => Shape::Arc(arc(a)),
            Shape::Polynomial(p) => Shape::Polynomial(polynomial(p)),
        };
        Self { label: self.label.clone(), shape }
    }
}
