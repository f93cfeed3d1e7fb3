//! Places of contact as a search finds them.

use super::body::Body;
use super::bounds::STEEPEST_SLOPE;
use super::element::Element;
use super::locus::Attitude;

use crate::profile::Station;

/// Cosine of the steepest tangent of a first touch. A curve turns from the vertical to here within 1e-16 of its radius along
/// x: nothing steeper can be told from a vertical wall, over which nothing comes to rest. Larger would leave contacts out that
/// a rounding of the offset does not undo; smaller divides a gap's rounding by nothing.
const STEEPEST: f64 = 1.5e-8;

/// Share of their size by which curvatures may differ and be equal: their rounding decides nothing.
pub(super) const EQUAL_CURVATURES: f64 = 64.0 * f64::EPSILON;

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
    /// Where it was found.
    pub meeting: Meeting,
}

/// An element of the wheel and one of the rail, with a parameter on each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    /// Indices of the elements: wheel, rail.
    pub elements: [u32; 2],
    /// Parameters on them.
    pub parameters: [f64; 2],
}

/// A point of the wheel's profile or of the rail's, with its signed radius \[mm\] and its parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The point, in its own profile's axes.
    pub station: Station,
    /// Signed radius \[mm\].
    pub radius: f64,
    /// Parameter on its element.
    pub parameter: f64,
}

/// Both bodies at one attitude, with what has been found so far.
pub(super) struct Search<'a> {
    /// The wheel and the rail.
    pub bodies: [&'a Body; 2],
    /// The wheel's attitude.
    pub attitude: &'a Attitude,
    /// Sum of both profiles' extents and of the offset: the size that rounding is judged by \[mm\].
    pub extent: f64,
    /// Candidates farther above the lowest than this are dropped \[mm\].
    pub within: f64,
    /// The lowest gap so far, or one that is known to be no lower than the lowest.
    pub lowest: f64,
    /// Candidates so far.
    pub candidates: &'a mut Vec<Candidate>,
    /// Pairs of elements solved, parts of stretches included.
    pub solves: u64,
    /// Rounding of an abscissa \[mm\]: that of [`Search::rounding`] without a radius.
    pub slack: f64,
}

impl<'a> Search<'a> {
    /// The wheel's element and the rail's.
    pub fn elements(&self, [wheel, rail]: [u32; 2]) -> [&'a Element; 2] {
        let [above, below] = self.bodies;
        [&above.elements[wheel as usize], &below.elements[rail as usize]]
    }

    /// Rounding of an abscissa \[mm\], where lengths of size `radius` take part.
    pub fn rounding(&self, radius: f64) -> f64 {
        16.0 * f64::EPSILON * (self.extent + radius)
    }

    /// The gap above which nothing is looked for any more \[mm\].
    #[inline]
    pub fn ceiling(&self) -> f64 {
        self.lowest + self.within
    }

    /// The same for bounds of gaps, which may be too high by the rounding of an abscissa on the steepest chord that bounds.
    #[inline]
    pub fn bound_ceiling(&self) -> f64 {
        self.ceiling() + 2.0 * STEEPEST_SLOPE * self.slack
    }

    /// Takes two points with a common tangent at one abscissa, to rounding, unless the gap is largest there or too large.
    ///
    /// The gap is that of the two points, corrected along the common tangent for the rounding of their abscissae.
    pub fn offer(&mut self, elements: [u32; 2], wheel: &Foot, rail: &Foot) {
        if let Some(candidate) = self.candidate(elements, wheel, rail)
            && candidate.gap <= self.ceiling()
        {
            self.lowest = self.lowest.min(candidate.gap);
            self.candidates.push(candidate);
        }
    }

    /// The place of least gap that two points are; `None` where the gap is largest there or the tangent vertical.
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
        let meeting = Meeting { elements, parameters: [wheel.parameter, rail.parameter] };
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
