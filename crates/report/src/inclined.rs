//! The pair that most measurements use: a rail inclined 1:40 under a wheel of 460 mm.

use wheelrail::error::Result;
use wheelrail::placement::Pair;
use wheelrail::profile::{Profile, inclination};

/// Nominal rolling radius R of the report's wheels \[mm\].
pub(super) const RADIUS: f64 = 460.0;

/// Makes the pair of a rail, which is inclined 1:40 here, and a wheel.
///
/// # Errors
/// The errors of [`Pair::new`].
pub(super) fn inclined_pair(rail: &Profile, wheel: Profile) -> Result<Pair> {
    Pair::new(rail.rotated(inclination(1.0, 40.0)?), wheel, RADIUS)
}
