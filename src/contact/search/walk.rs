//! One walk over all pairs of elements at one attitude.

use super::ProfilePair;
use super::arcs::{SINE_ROUNDING, arc_on_arc, arc_on_line, cosine, line_on_arc, line_on_line};
use super::element::{ArcElement, Element, Shape};
use super::locus::Attitude;
use super::polynomials;
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
        let slack = self.rounding(0.0);
        for wheel in placed {
            let element = &pair.wheel[wheel.element];
            let [low, high] = [wheel.x[0] - slack, wheel.x[1] + slack];
            // The rail's elements are in order of x, both ends.
            let first = pair.rail.partition_point(|rail| rail.x[1] < low);
            for rail in pair.rail[first..].iter().take_while(|rail| rail.x[0] <= high) {
                if rail.sine[0] <= wheel.sine[1] + SINE_ROUNDING
                    && rail.sine[1] >= wheel.sine[0] - SINE_ROUNDING
                {
                    self.meet(element, wheel, rail);
                }
            }
        }
    }

    fn meet(&mut self, wheel: &Element, placed: &Placed, rail: &Element) {
        match (&wheel.shape, &rail.shape) {
            (Shape::Arc(arc), Shape::Arc(below)) => arc_on_arc(self, (arc, placed), (below, rail.sine)),
            (Shape::Line(ends), Shape::Arc(below)) => line_on_arc(self, ends, (below, rail.sine)),
            (Shape::Arc(arc), Shape::Line(below)) => arc_on_line(self, (arc, placed), below),
            (Shape::Line(ends), Shape::Line(below)) => line_on_line(self, ends, below),
            (Shape::Polynomial(stretch), _) => polynomials::over_rail(self, (stretch, wheel.x), rail),
            (_, Shape::Polynomial(stretch)) => {
                polynomials::under_wheel(self, wheel, placed, (stretch, rail.x))
            }
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
        if gap.is_nan() || gap > self.lowest + self.within {
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
    let (sine, mut x) = match &element.shape {
        Shape::Polynomial(stretch) => {
            let sine = element.sine.map(|sin| attitude.outline_sine(sin));
            (sine, polynomials::range(attitude, stretch, element))
        }
        Shape::Line(ends) => {
            let outline = ends.map(|end| attitude.outline(&end));
            if outline[0].cos.is_nan() || outline[0].cos <= 0.0 {
                return None;
            }
            ([outline[0].sin; 2], outline.map(|p| p.x))
        }
        Shape::Arc(arc) => {
            let ends = arc_ends(attitude, arc, element)?;
            (ends.map(|end| end.sin), ends.map(|end| end.x))
        }
    };
    if x[0] > x[1] {
        x.swap(0, 1);
    }
    let centre = if let Shape::Arc(arc) = &element.shape {
        attitude.offset + arc.centre[0] * attitude.cos_roll + arc.centre[1] * attitude.sin_roll
    } else {
        0.0
    };
    (sine[0] <= sine[1]).then_some(Placed { element: index, x, sine, centre })
}

/// The outline's points at the ends of what is seen of an arc or fan.
fn arc_ends(attitude: &Attitude, arc: &ArcElement, element: &Element) -> Option<[Station; 2]> {
    let mut ends = element.ends;
    if attitude.sin_yaw != 0.0 {
        let steepest = steepest_seen(attitude, arc)?;
        if ends[0].sin >= steepest || ends[1].sin <= -steepest {
            return None;
        }
        for end in &mut ends {
            if end.sin.abs() > steepest {
                let sin = steepest.copysign(end.sin);
                *end = arc.at(sin, cosine(sin));
            }
        }
    }
    let mut outline = ends.map(|end| attitude.outline(&end));
    if outline[0].cos < 0.0 && outline[1].cos < 0.0 {
        return None;
    }
    for end in &mut outline {
        if end.cos < 0.0 {
            // Turned beyond the vertical by the roll: seen up to there.
            let tangent = 1f64.copysign(end.sin);
            let (sin, cos) = attitude.profile_tangent(tangent, 0.0);
            *end = Station { sin: tangent, cos: 0.0, ..attitude.outline(&arc.at(sin, cos)) };
        }
    }
    Some(outline)
}

/// Sine of the steepest profile tangent of an arc with an outline: cosψ, and where the hollow side is down
/// cos³φ = (R − b) sin²ψ/|r|.
fn steepest_seen(attitude: &Attitude, arc: &ArcElement) -> Option<f64> {
    if arc.radius >= 0.0 {
        return Some(attitude.cos_yaw);
    }
    let cube = (attitude.radius - arc.centre[1]) * attitude.sin_yaw_squared() / -arc.radius;
    (cube < 1.0).then(|| cosine(cube.cbrt()).min(attitude.cos_yaw))
}
