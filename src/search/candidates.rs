//! Candidates: the places of contact that a search collects.

use super::body::SearchBody;
use super::bounds::STEEPEST_SLOPE;
use super::element::Element;
use super::locus::Attitude;

use crate::profile::Station;

/// Cosine of the steepest tangent of a first touch. A curve turns from the vertical to here within 1e-16 of
/// its radius along x: a steeper tangent cannot be told from a vertical wall, over which nothing comes to
/// rest. A larger value would leave out contacts that a rounding of the offset does not undo; a smaller one
/// would divide a gap's rounding by nothing.
const STEEPEST: f64 = 1.5e-8;

/// Share of their size by which two curvatures may differ and still count as equal: below it rounding
/// decides.
pub(super) const EQUAL_CURVATURES: f64 = 64.0 * f64::EPSILON;

/// A place where wheel and rail have a common tangent at the same abscissa, the wheel above.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    /// Vertical gap with the wheel's profile origin on the level of the rail's \[mm\].
    pub gap: f64,
    /// The rail's point.
    pub rail: Station,
    /// The wheel profile's point, with the tangent that gives the common one.
    pub wheel: Station,
    /// Signed radius of the wheel profile \[mm\].
    pub wheel_radius: f64,
    /// Signed radius of the rail profile \[mm\].
    pub rail_radius: f64,
    /// The two elements that meet, with a parameter on each.
    pub meeting: Meeting,
}

/// An element of the wheel and one of the rail, with a parameter on each. Where a body varies: 0 and the index of its strip, with the
/// parameters u and y \[mm\] on the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Meeting {
    /// Indices of the wheel's and the rail's element.
    pub elements: [u32; 2],
    /// Parameter on the wheel's and on the rail's element.
    pub parameters: [f64; 2],
    /// Angle ν \[rad\] of the roller's meridian plane in which they meet, + ahead of its crown; 0 on a rail.
    pub turn: f64,
}

/// A point of the wheel's or the rail's profile, with its signed radius and its parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The point, in its own profile's axes.
    pub station: Station,
    /// Signed radius \[mm\].
    pub radius: f64,
    /// Parameter on its element.
    pub parameter: f64,
}

/// A search at one attitude: both bodies, and the candidates found so far.
pub(super) struct Search<'a> {
    /// The wheel and the rail.
    pub bodies: [&'a SearchBody; 2],
    /// The wheel's attitude.
    pub attitude: &'a Attitude,
    /// Size against which rounding is judged: the sum of both profiles' extents and of the offset \[mm\].
    pub extent: f64,
    /// Height above the lowest candidate beyond which candidates are dropped \[mm\].
    pub within: f64,
    /// Lowest gap so far, or a gap that the lowest is known not to exceed \[mm\].
    pub lowest: f64,
    /// The candidates so far.
    pub candidates: &'a mut Vec<Candidate>,
    /// Number of pairs of elements solved, parts of stretches included.
    pub solves: u64,
    /// Rounding of an abscissa \[mm\]: [`Search::rounding`] with a radius of 0.
    pub slack: f64,
}

impl<'a> Search<'a> {
    /// Returns the wheel's element and the rail's.
    pub fn elements(&self, [wheel, rail]: [u32; 2]) -> [&'a Element; 2] {
        let [above, below] = self.bodies;
        [&above.elements[wheel as usize], &below.elements[rail as usize]]
    }

    /// Returns the rounding of an abscissa \[mm\] in whose calculation lengths of size `radius` take part.
    pub fn rounding(&self, radius: f64) -> f64 {
        16.0 * f64::EPSILON * (self.extent + radius)
    }

    /// Returns the gap above which candidates are dropped \[mm\].
    #[inline]
    pub fn ceiling(&self) -> f64 {
        self.lowest + self.within
    }

    /// Returns the value above which bounds of gaps are dropped \[mm\]: the ceiling, raised by the rounding
    /// of an abscissa on the steepest chord that bounds.
    #[inline]
    pub fn bound_ceiling(&self) -> f64 {
        self.ceiling() + 2.0 * STEEPEST_SLOPE * self.slack
    }

    /// Adds the candidate of two points that have a common tangent at one abscissa, to rounding, unless the
    /// gap is largest there or above the ceiling.
    ///
    /// The gap is that of the two points, corrected along the common tangent for the rounding of their
    /// abscissae.
    pub fn offer(&mut self, elements: [u32; 2], wheel: &Foot, rail: &Foot) {
        if let Some(candidate) = self.candidate(elements, wheel, rail)
            && candidate.gap <= self.ceiling()
        {
            self.lowest = self.lowest.min(candidate.gap);
            self.candidates.push(candidate);
        }
    }

    /// Returns the candidate of two points; `None` if the gap is largest there or the tangent vertical.
    pub fn candidate(&self, elements: [u32; 2], wheel: &Foot, rail: &Foot) -> Option<Candidate> {
        let outline = self.attitude.outline(&wheel.station);
        let below = &rail.station;
        let gap = (outline.z - below.z) - below.sin / below.cos * (outline.x - below.x);
        if gap.is_nan() || below.cos < STEEPEST || outline.cos < STEEPEST {
            return None;
        }
        let [over, under] =
            [self.attitude.outline_radius(&wheel.station, wheel.radius), rail.radius].map(f64::recip);
        let seen = over == 0.0 || (over > 0.0) == (wheel.radius.is_sign_positive());
        if !seen || over - under < -EQUAL_CURVATURES * (over.abs() + under.abs()) {
            return None;
        }
        let meeting = Meeting { elements, parameters: [wheel.parameter, rail.parameter], turn: 0.0 };
        Some(Candidate {
            gap,
            rail: *below,
            wheel: wheel.station,
            wheel_radius: wheel.radius,
            rail_radius: rail.radius,
            meeting,
        })
    }
}
