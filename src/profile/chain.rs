//! A profile: a chain of segments that meet.

use nalgebra::UnitComplex;
use serde::{Deserialize, Serialize};

use super::arc::Arc;
use super::closing::{self, Closing};
use super::continuity;
use super::polynomial::Polynomial;
use super::segment::Segment;
use super::station::Station;
use crate::error::{Error, Result};

/// A chain of segments, travelled from left to right, with its name and source.
///
/// Neighbours share their joint point, to rounding. The rounded coordinates of a drawing leave small steps; they are closed
/// when the chain is made, by the rule that [`Closing`] describes. A stored profile (`serde`) is read back to the same bits;
/// what is no chain is refused.
///
/// # Examples
/// ```
/// use wheelrail::{Arc, Half, Profile, Segment};
///
/// let flank = Arc::line([-20.0, -1.0], [-10.0, 0.0])?;
/// let crown = Arc::about([0.0, -50.0], 50.990_195_135_927_85, Half::Upper, [-10.0, 10.0])?;
/// let rail = Profile::new("head", "a sketch", vec![Segment::arc(flank), Segment::arc(crown)])?;
/// assert_eq!(rail.segments().len(), 2);
/// assert_eq!(rail.mirrored().segments()[1].end().x, 20.0);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct Profile {
    /// Name of the standard, or of the file.
    pub name: String,
    /// Where the numbers come from.
    pub source: String,
    /// At least one segment.
    segments: Vec<Segment>,
    /// The segments before the chain was closed; empty if closing changed only roundings.
    drawn: Vec<Segment>,
    closings: Vec<Closing>,
    /// The larger side of the box around the segments' ends \[mm\].
    #[serde(skip_serializing)]
    extent: f64,
    /// Standard deviation \[mm\] of the points through which it was smoothed.
    noise: f64,
}

/// A profile as it is stored: without what follows from its segments.
#[derive(Deserialize)]
struct Stored {
    name: String,
    source: String,
    segments: Vec<Segment>,
    drawn: Vec<Segment>,
    closings: Vec<Closing>,
    #[serde(default)]
    noise: f64,
}

impl TryFrom<Stored> for Profile {
    type Error = Error;

    fn try_from(stored: Stored) -> Result<Self> {
        let Stored { name, source, segments, drawn, closings, noise } = stored;
        let all = segments.iter().chain(&drawn);
        let joints = segments.len().saturating_sub(1);
        let inside = closings.iter().all(|closing| closing.left < joints);
        if segments.is_empty() || !inside || !all.clone().all(Segment::is_sound) {
            let expected = "segments and joints of one chain";
            return Err(Error::new(name, "a damaged profile", expected, "store it anew"));
        }
        continuity::reject_jumps(&segments, extent(&segments))?;
        Ok(Self::closed(name, source, [segments, drawn], closings).with_noise(noise))
    }
}

impl Profile {
    /// Makes a chain of at least one segment and closes its small steps: see [`Closing`].
    ///
    /// Kinks are allowed at any angle: see [`Profile::continuity`].
    ///
    /// # Errors
    /// An empty chain. A step larger than 1e-4 × the chain's extent, or too large for the short segment beside it; the
    /// error gives its place and size.
    pub fn new(name: impl Into<String>, source: impl Into<String>, drawn: Vec<Segment>) -> Result<Self> {
        if drawn.is_empty() {
            return Err(Error::new(
                "segments",
                "none",
                "at least one segment",
                "give the profile's segments",
            ));
        }
        let extent = extent(&drawn);
        continuity::reject_jumps(&drawn, extent)?;
        let (segments, closings) = closing::close(&drawn, extent)?;
        let drawn = if closings.is_empty() { Vec::new() } else { drawn };
        Ok(Self::closed(name.into(), source.into(), [segments, drawn], closings))
    }

    fn closed(
        name: String,
        source: String,
        [segments, drawn]: [Vec<Segment>; 2],
        closings: Vec<Closing>,
    ) -> Self {
        let extent = extent(&segments);
        Self { name, source, segments, drawn, closings, extent, noise: 0.0 }
    }

    /// Says that the profile was smoothed through points of this standard deviation \[mm\] across it.
    pub(crate) fn with_noise(self, noise: f64) -> Self {
        Self { noise, ..self }
    }

    /// Returns the standard deviation \[mm\] of the points through which the profile was smoothed; 0 for others.
    pub(crate) fn noise(&self) -> f64 {
        self.noise
    }

    /// Returns the name for titles and pages: of a profile of a file that of the file, without its folders.
    #[cfg(feature = "files")]
    pub fn title(&self) -> &str {
        crate::files::file_name(&self.name)
    }

    /// Returns the segments from left to right.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Returns the segments as they were given, before the chain was closed.
    pub fn drawn(&self) -> &[Segment] {
        if self.drawn.is_empty() { &self.segments } else { &self.drawn }
    }

    /// Returns the places where closing changed the drawn chain, and by how much, from left to right.
    pub fn closings(&self) -> &[Closing] {
        &self.closings
    }

    /// Returns the closing that moved the drawn surface most, with its joint \[x, z\] \[mm\]. Returns `None` for a chain
    /// that was drawn without steps.
    pub fn largest_closing(&self) -> Option<(Closing, [f64; 2])> {
        let largest = self.closings.iter().max_by(|a, b| a.moved.total_cmp(&b.moved))?;
        let joint = self.segments[largest.left].end();
        Some((*largest, [joint.x, joint.z]))
    }

    /// Returns gap, kink and jump of curvature at every joint, from left to right.
    pub fn continuity(&self) -> Vec<continuity::Joint> {
        continuity::joints(&self.segments)
    }

    /// Returns the larger side of the box around the ends of all segments \[mm\]. It is the scale by which rounding is
    /// judged.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// Returns the profile turned about its origin, counter-clockwise from x to z. [`inclination`](super::inclination())
    /// makes the turn of 1:n.
    #[must_use]
    pub fn rotated(&self, turn: UnitComplex<f64>) -> Self {
        self.placed(&Station { x: 0.0, z: 0.0, cos: turn.re, sin: turn.im })
    }

    /// Returns the profile moved by (x, z) \[mm\].
    #[must_use]
    pub fn shifted(&self, x: f64, z: f64) -> Self {
        self.placed(&Station { x, z, ..Station::AXES })
    }

    /// Returns the mirror image under x → −x.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut mirrored = self.mapped(|s| s.map(Arc::mirrored, Polynomial::mirrored));
        mirrored.segments.reverse();
        mirrored.drawn.reverse();
        mirrored.closings.reverse();
        for closing in &mut mirrored.closings {
            // Mirroring puts the joint's other segment on the left.
            closing.left = self.segments.len() - 2 - closing.left;
        }
        mirrored
    }

    /// Returns the mirror image under z → −z: a profile of the other body.
    pub(crate) fn upside_down(&self) -> Self {
        self.mapped(|s| s.map(Arc::upside_down, Polynomial::upside_down))
    }

    pub(super) fn placed(&self, frame: &Station) -> Self {
        self.mapped(|s| s.map(|a| a.placed_by(frame), |p| p.placed_by(frame)))
    }

    fn mapped(&self, image: impl Fn(&Segment) -> Segment) -> Self {
        let chains = [&self.segments, &self.drawn].map(|all| all.iter().map(&image).collect());
        Self::closed(self.name.clone(), self.source.clone(), chains, self.closings.clone())
            .with_noise(self.noise)
    }
}

/// Returns the larger side of the box around all segment ends \[mm\].
fn extent(segments: &[Segment]) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for station in segments.iter().flat_map(|s| [s.start(), s.end()]) {
        for (k, v) in [station.x, station.z].into_iter().enumerate() {
            low[k] = low[k].min(v);
            high[k] = high[k].max(v);
        }
    }
    (high[0] - low[0]).max(high[1] - low[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::{inclination, standards};

    #[test]
    fn a_stored_profile_is_read_back_to_the_last_bit() -> std::result::Result<(), Box<dyn std::error::Error>>
    {
        let mut read = 0;
        for name in standards::wheel_names() {
            let profile = standards::wheel(name)?.rotated(inclination(1.0, 40.0)?);
            let text = serde_json::to_string(&profile)?;
            assert_eq!(serde_json::from_str::<Profile>(&text)?, profile, "{name}");
            read += 1;
        }
        assert!(read > 10);
        Ok(())
    }

    #[test]
    fn a_damaged_profile_is_refused() -> std::result::Result<(), Box<dyn std::error::Error>> {
        let text = serde_json::to_string(&standards::wheel("S1002")?)?;
        let value: serde_json::Value = serde_json::from_str(&text)?;
        let refused = |damage: &dyn Fn(&mut serde_json::Value)| {
            let mut value = value.clone();
            damage(&mut value);
            serde_json::from_value::<Profile>(value).is_err()
        };
        assert!(!refused(&|_| {}));
        assert!(refused(&|value| value["segments"] = serde_json::json!([])));
        assert!(refused(&|value| value["segments"][1]["shape"]["Polynomial"]["x"] = serde_json::json!([])));
        assert!(refused(&|value| {
            value["segments"].as_array_mut().into_iter().for_each(|all| all.swap(1, 3));
        }));
        Ok(())
    }
}
