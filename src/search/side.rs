//! One side of a wheelset on its track: what its wheel runs on, where both are, and the search over them.

use std::sync::Arc;

use super::candidates::{Candidate, Meeting};
use super::locus::Attitude;
use super::lofted::{Cut, LoftedPair, LoftedSearch};
use super::over_rail::Work;
use super::touch::{ContactSearch, ProfilePair, Selection, Touch};
use crate::error::Result;
use crate::numerics::interval::Interval;
use crate::placement::{Pair, Track, Wheelset};

/// One side of a wheelset on its track, in the side's own axes: those of a right-hand side.
#[derive(Debug, Clone)]
pub struct SideOnTrack {
    /// The prepared wheel and rail.
    pub(super) pair: SidePair,
    /// The position of the rail.
    pub(super) track: Track,
    /// The position of the wheel.
    pub(super) wheelset: Wheelset,
}

impl SideOnTrack {
    /// Prepares the profiles of one side; `track` and `wheelset` say where they are.
    ///
    /// # Errors
    /// The errors of [`ProfilePair::new`].
    pub fn new(pair: &Pair, track: Track, wheelset: Wheelset) -> Result<Self> {
        Ok(Self { pair: SidePair::Swept(Arc::new(ProfilePair::new(pair)?)), track, wheelset })
    }

    /// Makes the side of a pair in which the rail varies along the track, or the wheel around its axle.
    pub fn lofted(pair: Arc<LoftedPair>, track: Track, wheelset: Wheelset) -> Self {
        Self { pair: SidePair::Lofted(pair), track, wheelset }
    }

    /// Returns the position of the rail.
    pub fn track(&self) -> &Track {
        &self.track
    }

    /// Returns the position of the wheel on its axle.
    pub fn wheelset(&self) -> &Wheelset {
        &self.wheelset
    }

    /// Cuts the body that varies by the plane across the track which lies `ahead` \[mm\] of the wheel profile's origin, as
    /// [`Contact::y`](super::Contact::y) counts. `stands` are \[along, pitch\]: that origin is at `along` \[mm\] of a rail's list
    /// ([`WheelsetOnTrack::along`](super::WheelsetOnTrack::along)), and −pitch \[rad\] of a wheel is lowest. `yaw` \[rad\] turns the wheel,
    /// + with the field side ahead. `None` for bodies of one profile; no pieces where the plane meets no surface.
    pub fn cut(&self, stands: [f64; 2], yaw: f64, ahead: f64) -> Option<Cut> {
        match &self.pair {
            SidePair::Swept(_) => None,
            SidePair::Lofted(pair) => Some(pair.cut(stands, yaw, ahead)),
        }
    }
}

/// A wheel and what it runs on, prepared for searches.
#[derive(Debug, Clone)]
pub(super) enum SidePair {
    /// A rail or a roller of one profile.
    Swept(Arc<ProfilePair>),
    /// A rail that varies along the track, or a wheel that varies around its axle.
    Lofted(Arc<LoftedPair>),
}

/// The search over a wheel and what it runs on.
#[derive(Debug, Clone)]
pub(super) enum SideSearch<'a> {
    Swept(Box<ContactSearch<'a>>),
    Lofted(LoftedSearch<'a>),
}

impl SidePair {
    pub fn search(&self) -> SideSearch<'_> {
        match self {
            Self::Swept(pair) => SideSearch::Swept(Box::new(pair.search())),
            Self::Lofted(pair) => SideSearch::Lofted(pair.search()),
        }
    }

    /// Tells whether the wheel varies around its axle.
    pub fn turning(&self) -> bool {
        match self {
            Self::Swept(_) => false,
            Self::Lofted(pair) => pair.turning_wheel(),
        }
    }

    /// Lists where a list of slices defines no surface: see [`LoftedPair::holes`].
    pub fn holes(&self) -> Vec<Interval> {
        match self {
            Self::Swept(_) => Vec::new(),
            Self::Lofted(pair) => pair.holes(),
        }
    }

    /// Gives the radius of a roller \[mm\]; `None` for a rail.
    pub fn roller(&self) -> Option<f64> {
        match self {
            Self::Swept(pair) => pair.roller(),
            Self::Lofted(_) => None,
        }
    }
}

impl SideSearch<'_> {
    /// Moves the axle's middle to a place along the track \[mm\] and turns the wheel about its axle \[rad\], + forward at the bottom;
    /// without effect on bodies of one profile.
    pub fn stand_at(&mut self, along: f64, pitch: f64) {
        if let Self::Lofted(search) = self {
            search.stand_at(along, pitch);
        }
    }

    /// Makes sure that all searches since the last call had an answer.
    ///
    /// # Errors
    /// A search that ended without one: a body that varies and follows the other one's shape all over.
    pub fn answered(&mut self) -> Result<()> {
        match self {
            Self::Swept(_) => Ok(()),
            Self::Lofted(search) => search.answered(),
        }
    }

    pub fn lower(&mut self, attitude: &Attitude, within: f64) -> Option<Candidate> {
        match self {
            Self::Swept(search) => search.lower(attitude, within),
            Self::Lofted(search) => search.lower(attitude, within),
        }
    }

    /// Tells whether a list of slices defines no surface where the wheel stands, or where it would touch at its lowest place.
    pub fn over_hole(&self, attitude: &Attitude, lowest: Option<&Meeting>) -> bool {
        match self {
            Self::Swept(_) => false,
            Self::Lofted(search) => search.over_hole(attitude, lowest),
        }
    }

    pub fn follow(&mut self, attitude: &Attitude, meeting: &Meeting) -> Option<Candidate> {
        match self {
            Self::Swept(search) => search.follow(attitude, meeting),
            Self::Lofted(search) => search.follow(attitude, meeting),
        }
    }

    pub fn collect(&mut self, attitude: &Attitude, height: f64, selection: &Selection) -> Touch<'_> {
        match self {
            Self::Swept(search) => search.collect(attitude, height, selection),
            Self::Lofted(search) => search.collect(attitude, height, selection),
        }
    }

    pub fn work(&self) -> Work {
        match self {
            Self::Swept(search) => search.work(),
            Self::Lofted(search) => search.work,
        }
    }
}
