//! One segment of a profile (Report Sec. 3): a line, an arc or a polynomial.

use super::arc::Arc;
use super::polynomial::Polynomial;
use super::station::Station;

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
