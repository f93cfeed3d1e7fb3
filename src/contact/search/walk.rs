//! One walk over all pairs of elements at one attitude.

use super::arcs::{arc_on_arc, arc_on_line, line_on_arc, line_on_line};
use super::element::{ArcElement, Element, Shape};
use super::locus::Attitude;
use super::polynomials;
use super::ProfilePair;
use crate::profile::Station;

/// A wheel element as it stands over the rail.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    /// Index of the element.
    pub element: usize,
    /// Its outline lies between these abscissae of the rail \[mm\].
    pub x: [f64; 2],
    /// Sines of the outline's tangent, ascending.
    pub sine: [f64; 2],
    /// Abscissa of an unyawed arc's centre.
    pub centre: f64,
}

/// A place where wheel and rail have a common tangent at the same abscissa, the wheel above.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    /// Vertical gap with the wheel's profile origin on the level of the rail's \[mm\].
    pub gap: f64,
    /// The rail's point with the common tangent.
    pub rail: Station,
    /// The wheel profile's point with the tangent that belongs to the common one.
    pub wheel: Station,
    /// Signed radii of the two profiles \[mm\].
    pub wheel_radius: f64,
    /// See `wheel_radius`.
    pub rail_radius: f64,
}

/// Everything a walk needs.
pub(super) struct Walk<'a> {
    /// The profiles.
    pub pair: &'a ProfilePair,
    /// The wheel's attitude.
    pub attitude: &'a Attitude,
    /// Candidates farther above the lowest than this are dropped \[mm\].
    pub within: f64,
    /// The lowest gap so far.
    pub lowest: f64,
    /// Candidates so far.
    pub candidates: &'a mut Vec<Candidate>,
}

impl Walk<'_> {
    /// Looks at every pair.
    pub fn all(&mut self, placed: &[Placed]) {
        let pair = self.pair;
        for wheel in placed {
            let element = &pair.wheel[wheel.element];
            let slack = self.rounding(0.0);
            for rail in &pair.rail {
                if rail.x[0] > wheel.x[1] + slack || rail.x[1] < wheel.x[0] - slack {
                    continue;
                }
                self.meet(element, wheel, rail);
            }
        }
    }

    fn meet(&mut self, wheel: &Element, placed: &Placed, rail: &Element) {
        match (&wheel.shape, &rail.shape) {
            (Shape::Arc(arc), Shape::Arc(below)) => arc_on_arc(self, (arc, placed), (below, rail.sine)),
            (Shape::Line(ends), Shape::Arc(below)) => line_on_arc(self, ends, (below, rail.sine)),
            (Shape::Arc(arc), Shape::Line(below)) => arc_on_line(self, (arc, placed), below),
            (Shape::Line(ends), Shape::Line(below)) => line_on_line(self, ends, below),
            (Shape::Polynomial(stretch), _) => polynomials::over_rail(self, (stretch, placed, wheel.x), rail),
            (_, Shape::Polynomial(stretch)) => polynomials::under_wheel(self, wheel, placed, (stretch, rail.x)),
        }
    }

    /// Rounding of an abscissa \[mm\], where lengths of size `radius` take part.
    pub fn rounding(&self, radius: f64) -> f64 {
        16.0 * f64::EPSILON * (self.pair.extent + self.attitude.offset.abs() + radius)
    }

    /// Takes a candidate unless it is a maximum of the gap or too far up.
    ///
    /// The gap is corrected along the common tangent for the rounding of the two abscissae.
    pub fn offer(&mut self, wheel: &Station, wheel_radius: f64, rail: &Station, rail_radius: f64) {
        let outline = self.attitude.outline(wheel);
        let gap = (outline.z - rail.z) - rail.sin / rail.cos * (outline.x - rail.x);
        if !(gap <= self.lowest + self.within) {
            return;
        }
        let [above, below] = [self.attitude.outline_radius(wheel, wheel_radius), rail_radius].map(f64::recip);
        // Equal curvatures stay in: their rounding decides nothing.
        let seen = above == 0.0 || (above > 0.0) == (wheel_radius.is_sign_positive());
        if !seen || above - below < -64.0 * f64::EPSILON * (above.abs() + below.abs()) {
            return;
        }
        self.lowest = self.lowest.min(gap);
        self.candidates.push(Candidate { gap, rail: *rail, wheel: *wheel, wheel_radius, rail_radius });
    }
}

/// Where a wheel element stands; `None` where it has no outline.
///
/// An arc with its hollow side down has an outline only where ϱ_c < 0, else the rings beside it hide it.
pub(super) fn place(attitude: &Attitude, index: usize, element: &Element) -> Option<Placed> {
    let [mut low, mut high] = element.sine;
    if low >= attitude.cos_yaw || high <= -attitude.cos_yaw {
        return None;
    }
    let mut centre = 0.0;
    let x = match &element.shape {
        Shape::Arc(arc) => {
            if let Some(steepest) = steepest_seen(attitude, arc) {
                (low, high) = (low.max(-steepest), high.min(steepest));
                if low > high {
                    return None;
                }
            }
            let [a, b] = arc.centre;
            centre = attitude.offset + a * attitude.cos_roll + b * attitude.sin_roll;
            arc_range(attitude, arc, centre, [low, high])
        }
        Shape::Line(ends) => ends.map(|end| attitude.outline(&end).x),
        Shape::Polynomial(stretch) => polynomials::range(attitude, stretch, element.x),
    };
    let sine = [low, high].map(|sin| attitude.outline_sine(sin));
    (sine[0] <= sine[1]).then_some(Placed { element: index, x, sine, centre })
}

/// Sine of the steepest profile tangent of an arc with an outline: cos³φ = (R − b) sin²ψ/|r|.
fn steepest_seen(attitude: &Attitude, arc: &ArcElement) -> Option<f64> {
    if arc.radius >= 0.0 || attitude.sin_yaw == 0.0 {
        return None;
    }
    let cube = (attitude.radius - arc.centre[1]) * attitude.sin_yaw_squared() / -arc.radius;
    let cos = cube.cbrt();
    Some(if cos < 1.0 { ((1.0 - cos) * (1.0 + cos)).sqrt() } else { -1.0 })
}

/// Abscissae of the ends of an arc's outline, ascending.
fn arc_range(attitude: &Attitude, arc: &ArcElement, centre: f64, sine: [f64; 2]) -> [f64; 2] {
    let mut x = if attitude.sin_yaw == 0.0 {
        sine.map(|sin| centre + arc.radius * attitude.outline_sine(sin))
    } else {
        sine.map(|sin| {
            let sin = sin.clamp(-attitude.cos_yaw, attitude.cos_yaw);
            let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
            attitude.outline(&arc.at(sin, cos)).x
        })
    };
    if x[0] > x[1] {
        x.swap(0, 1);
    }
    x
}
