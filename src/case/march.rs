//! A march with what its places of contact carry.

use rayon::prelude::*;

use super::doubts::{ContactDoubts, DoubtKind};
use super::ends::end_in_contact;
use super::input::{Case, Echo, Profiles};
use super::landmarks::SideLandmarks;
use super::places::rows_under_load;
use super::run::end_reached;
use super::unmeasured::bridge_in_contact;
use super::wheel::ContactRegion;
use crate::error::{Result, in_order};
use crate::search::{Event, March, Position, Stop, SweepRow};

/// What a march goes along: the column of its places, and the axis of its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MarchCourse {
    /// Name of the column.
    pub column: &'static str,
    /// Name and unit of the axis.
    pub axis: &'static str,
    /// Decimals of the place of an event.
    pub(super) decimals: usize,
}

/// Along the track.
pub const ALONG: MarchCourse = MarchCourse { column: "along_mm", axis: "along the track [mm]", decimals: 2 };

/// Around the axle.
pub const AROUND: MarchCourse =
    MarchCourse { column: "angle_rad", axis: "pitch of the wheelset [rad]", decimals: 5 };

/// Stops under a load that are found at a time: each takes seconds, and threads share them.
const PORTION: usize = 8;

/// A march, what it is drawn from, and the loads on it.
///
/// The room `scene` makes one, by its `march`.
#[derive(Debug, Clone)]
pub struct MarchCase {
    /// Ready to be computed.
    pub march: March,
    /// The profiles of both sides: of a body that varies a section of it, or the profile before it was made to vary.
    pub profiles: Profiles,
    /// The wheelset on the track under the loads of the scene, wherever it stands; `None` without loads.
    pub loaded: Option<Case>,
    /// Landmarks by which its contacts are judged.
    pub landmarks: SideLandmarks,
    /// What the lists leave undefined, and what is doubtful.
    pub warnings: Vec<String>,
    /// The scene, as pages name it.
    pub echo: Echo,
}

/// A place of contact, with what its region carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarchRow {
    /// The place at first touch.
    pub row: SweepRow,
    /// Approach δ along its normal \[mm\]; NaN without a load, and where the place is within the region of another one or not closed.
    pub approach: f64,
    /// Normal force of its region \[N\]; NaN where `approach` is.
    pub normal_load: f64,
    /// Whether the end of the slices cuts its patch off, so that the approach is too large.
    pub cut_off: bool,
    /// Whether a profile ends in the contact, or shows no surface there. The other doubts need landmarks of the section at each place.
    pub doubts: ContactDoubts,
}

/// The places of contact of a wheelset with the middle of its axle at one place, or at one pitch.
#[derive(Debug, Clone, PartialEq)]
pub struct MarchStop {
    /// The place along the track \[mm\], or the pitch \[rad\].
    pub along: f64,
    /// Contacts of both sides, the left one first; none where a wheel has no rail, and over a hole.
    pub rows: Vec<MarchRow>,
    /// Whether the left and the right wheel stand over a hole of a list of slices, or would touch at its edge.
    pub holes: [bool; 2],
    /// Lateral displacement \[mm\] and yaw \[rad\].
    pub stands: [f64; 2],
}

/// Says at how many places of a march the end of the slices cuts a patch off; `None` where at none.
pub fn cut_off_warning(places: usize) -> Option<String> {
    let some = if places == 1 { "1 place".to_owned() } else { format!("{places} places") };
    (places > 0).then(|| {
        format!("the end of the slices cuts off a patch at {some}: approaches there are too large; list more slices")
    })
}

/// Says at how many places of a march a list of slices defines no surface under a wheel; `None` where at none.
pub fn hole_warning(places: usize) -> Option<String> {
    let some = if places == 1 { "1 place".to_owned() } else { format!("{places} places") };
    (places > 0).then(|| {
        format!("a hole at {some}: the list defines no surface there, or contact would be at its edge")
    })
}

impl MarchRow {
    fn touching(row: SweepRow, landmarks: &SideLandmarks) -> Self {
        let doubts = landmarks.of_profiles(&row);
        Self { row, approach: f64::NAN, normal_load: f64::NAN, cut_off: false, doubts }
    }

    /// Makes the row of a place with the region that has its frame; without one, the row of first touch.
    fn carrying(row: SweepRow, region: Option<&ContactRegion>, landmarks: &SideLandmarks) -> Self {
        let touching = Self::touching(row, landmarks);
        let Some(ContactRegion { placement, patch, approach, loads, .. }) = region else { return touching };
        let end = end_in_contact(placement, Some(patch)).map(|_| row.contact.wheel_x);
        let bridge = bridge_in_contact(placement, Some(patch)).map(|_| row.contact.wheel_x);
        Self {
            approach: *approach,
            normal_load: loads.iter().sum(),
            cut_off: end_reached(placement, patch).is_some(),
            doubts: touching.doubts.and(DoubtKind::ProfileEnd, end).and(DoubtKind::Unmeasured, bridge),
            ..touching
        }
    }
}

impl MarchCase {
    /// Hands the stops at ascending places of a course to `sink` in order, and after each block of stops its events, until `sink` returns
    /// false. Under loads the places and the roll are those that the loads settle at; events are those of first touch.
    ///
    /// It runs on the threads of the current rayon pool; any number of threads gives the same bits. Cost: that of [`March::blocks`];
    /// under loads 0.5 to 2 s more for a stop.
    ///
    /// # Errors
    /// The errors of [`March::blocks`] and [`March::turns`]; a load that no approach carries, with the place.
    pub fn blocks(
        &self,
        course: MarchCourse,
        places: &[f64],
        mut sink: impl FnMut(&[MarchStop], &[Event]) -> Result<bool>,
    ) -> Result<()> {
        let portion = if self.loaded.is_some() { PORTION } else { usize::MAX };
        let sink = |stops: &[Stop], events: &[Event]| {
            for some in stops.chunks(portion) {
                if !sink(&in_order(some.par_iter().map(|stop| self.stop(course, stop)))?, &[])? {
                    return Ok(false);
                }
            }
            sink(&[], events)
        };
        if course == AROUND { self.march.turns(places, sink) } else { self.march.blocks(places, sink) }
    }

    /// Finds what the places of a stop carry.
    fn stop(&self, course: MarchCourse, stop: &Stop) -> Result<MarchStop> {
        let along = stop.along;
        let rows = match &self.loaded {
            Some(case) if !stop.rows.is_empty() => {
                let mut here = case.clone();
                let place = if course == AROUND {
                    here.setup.pitch = along;
                    format!("angle {along} rad")
                } else {
                    here.setup.along = along;
                    format!("along {along} mm")
                };
                let rows = rows_under_load(&here).map_err(|error| error.within(place))?;
                let carrying =
                    |(row, region): (_, Option<_>)| MarchRow::carrying(row, region.as_ref(), &self.landmarks);
                rows.into_iter().map(carrying).collect()
            }
            _ => stop.rows.iter().map(|row| MarchRow::touching(*row, &self.landmarks)).collect(),
        };
        let Position { lateral, yaw, .. } = self.march.position;
        Ok(MarchStop { along, rows, holes: stop.holes, stands: [lateral, yaw] })
    }
}
