//! Lowers a wheel onto a rail, and keeps the candidates for contact.

use super::body::SearchBody;
use super::candidates::{Candidate, Meeting, Search};
use super::locus::Attitude;
use super::walk::{self, Walk};
use crate::numerics::cosine;

/// The outlines of a rail and a wheel, prepared for searches.
#[derive(Debug, Clone)]
pub(super) struct SearchPair {
    /// The rail's outline.
    pub rail: SearchBody,
    /// The wheel's outline.
    pub wheel: SearchBody,
    /// Nominal rolling radius \[mm\].
    pub radius: f64,
    /// Size against which rounding is judged: the sum of both extents \[mm\].
    pub extent: f64,
}

/// Searches over one pair; keeps its buffers, so that a search allocates nothing.
#[derive(Debug, Clone)]
pub(super) struct RailSearch<'a> {
    pub pair: &'a SearchPair,
    walk: Walk,
    /// The candidates that the last search has left.
    pub candidates: Vec<Candidate>,
    /// The contact of the last search.
    last: Option<Meeting>,
    /// Work of the searches so far.
    pub work: Work,
}

/// Counts what the searches have done so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Number of searches: each lowers a wheel onto its rail once.
    pub searches: u64,
    /// Number of pairs of tree nodes looked at.
    pub pairs: u64,
    /// Number of pairs of elements, or of parts of them, looked at for common tangents.
    pub solves: u64,
}

impl<'a> RailSearch<'a> {
    /// Makes a search over a pair.
    pub fn new(pair: &'a SearchPair) -> Self {
        let walk = Walk::new(&pair.wheel.nodes, &pair.rail.nodes);
        Self { pair, walk, candidates: Vec::new(), last: None, work: Work::default() }
    }

    /// Returns the lowest candidate over a rail, and leaves all others up to `within` above it in the buffer.
    pub fn lower(&mut self, attitude: &Attitude, within: f64) -> Option<Candidate> {
        self.candidates.clear();
        let mut search = self.pair.at(attitude, within, &mut self.candidates);
        search.lowest = self.pair.highest(attitude);
        self.walk.all(&mut search, self.last);
        self.work.searches += 1;
        self.work.solves += search.solves;
        self.work.pairs = self.walk.pairs;
        let lowest = *self.candidates.iter().min_by(|a, b| a.gap.total_cmp(&b.gap))?;
        self.last = Some(lowest.meeting);
        Some(lowest)
    }

    /// Returns the place of least gap over a rail near a former one; `None` if it has left its two elements.
    pub fn follow(&self, attitude: &Attitude, meeting: &Meeting) -> Option<Candidate> {
        walk::follow(&self.pair.at(attitude, 0.0, &mut Vec::new()), meeting)
    }

    /// Returns the abscissae \[mm\] of a place on both profiles: of the wheel and of the rail.
    pub fn places_of(&self, meeting: &Meeting) -> [f64; 2] {
        let place = |body: &SearchBody, k: usize| {
            let element = &body.elements[meeting.elements[k] as usize];
            element.place(&body.coefficients, meeting.parameters[k]).station.x
        };
        [place(&self.pair.wheel, 0), place(&self.pair.rail, 1)]
    }
}

impl SearchPair {
    /// Makes a search at one attitude.
    fn at<'a>(
        &'a self,
        attitude: &'a Attitude,
        within: f64,
        candidates: &'a mut Vec<Candidate>,
    ) -> Search<'a> {
        let extent = self.extent + attitude.offset.abs();
        let bodies = [&self.wheel, &self.rail];
        let slack = 16.0 * f64::EPSILON * extent;
        Search { bodies, attitude, extent, within, lowest: f64::INFINITY, candidates, solves: 0, slack }
    }

    /// Returns the gap of the highest point of the wheel's profile over the lowest of the rail \[mm\]. With a
    /// larger gap the profiles do not touch, only rings of a yawed wheel towards its axle. Slopes up to 45° may
    /// rise above their profile by their own ring.
    pub fn highest(&self, attitude: &Attitude) -> f64 {
        let [x, z] = self.wheel.extent;
        let tilted = (-x.low * attitude.sin_roll).max(-x.high * attitude.sin_roll);
        let steepest = attitude.tan_yaw;
        let rise = self.radius * steepest * steepest / (1.0 + cosine(steepest));
        z.high * attitude.cos_roll + tilted + rise - self.rail.extent[1].low
    }
}
