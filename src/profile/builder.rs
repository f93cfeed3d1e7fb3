//! Builds smooth chains from drawing data: Appendix A of the Report.
//!
//! A segment is given by its slope or radius and by the abscissa where it ends. It leaves the previous segment along its
//! tangent. Equations (A-1)–(A-13) become one rule here: the new centre lies on the normal of the joint.

use super::{Arc, Half, Segment, Station};
use crate::error::{Error, Result, finite};

/// A chain under construction.
///
/// # Examples
/// ```
/// use wheelrail::profile::{ChainBuilder, Half, Profile};
///
/// let mut chain = ChainBuilder::starting_at([-10.0, 0.0])?;
/// chain.line_to(Some(0.0), 0.0)?;
/// chain.arc_to(50.0, Half::Upper, 30.0)?; // smooth: it leaves the line along its tangent
/// let profile = Profile::new("crown", "", chain.finish())?;
/// assert!((profile.segments()[1].end().z + 10.0).abs() < 1e-13);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct ChainBuilder {
    point: Option<[f64; 2]>,
    segments: Vec<Segment>,
}

impl ChainBuilder {
    /// Makes an empty chain. Its first segment must be given in full.
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes an empty chain whose first segment is a line that starts at this point \[mm\].
    ///
    /// # Errors
    /// A point that is not finite.
    pub fn starting_at(point: [f64; 2]) -> Result<Self> {
        for v in point {
            finite("start", v)?;
        }
        Ok(Self { point: Some(point), segments: Vec::new() })
    }

    /// Appends a segment that is given in full.
    pub fn push(&mut self, segment: Segment) {
        self.segments.push(segment);
    }

    /// Appends a line to abscissa `to_x` \[mm\]. With a slope the line has that slope; otherwise it continues the tangent
    /// of the previous segment: (A-11), (A-12).
    ///
    /// # Errors
    /// No point or no slope to continue from; values that are not finite; a `to_x` that is not beyond the beginning.
    pub fn line_to(&mut self, slope: Option<f64>, to_x: f64) -> Result<()> {
        let slope = slope.map(|slope| finite("line: slope", slope)).transpose()?;
        finite("line: to_x", to_x)?;
        let last = self.segments.last().map(Segment::end);
        let start = match (slope, last, self.point) {
            (None, Some(end), _) => end,
            (Some(slope), Some(end), _) => along(slope, [end.x, end.z]),
            (Some(slope), None, Some(point)) => along(slope, point),
            (_, None, None) => return Err(nothing_before("a line given by its slope")),
            (None, None, Some(_)) => {
                return Err(Error::new("line", "no slope", "`slope`, for the first segment", "give it"));
            }
        };
        self.segments.push(Segment::arc(Arc::tangent_at(start, f64::INFINITY, to_x)?));
        Ok(())
    }

    /// Appends an arc to abscissa `to_x` \[mm\], smooth with the previous segment: (A-3), (A-4) after a line, (A-8), (A-9)
    /// after an arc.
    ///
    /// # Errors
    /// No segment to continue from; values that are not finite; a radius that is not positive; a `to_x` that
    /// the arc does not reach.
    pub fn arc_to(&mut self, radius: f64, half: Half, to_x: f64) -> Result<()> {
        let Some(start) = self.segments.last().map(Segment::end) else {
            return Err(nothing_before("an arc given by its radius and end"));
        };
        finite("arc: to_x", to_x)?;
        if finite("arc: radius", radius)? <= 0.0 {
            let advice = "give the half of the circle by `half`";
            return Err(Error::new("arc: radius", radius.to_string(), "a positive number", advice));
        }
        let signed = if half == Half::Upper { -radius } else { radius };
        self.segments.push(Segment::arc(Arc::tangent_at(start, signed, to_x)?));
        Ok(())
    }

    /// Returns the segments from left to right.
    pub fn finish(self) -> Vec<Segment> {
        self.segments
    }
}

fn along(slope: f64, [x, z]: [f64; 2]) -> Station {
    let norm = slope.hypot(1.0);
    Station { x, z, cos: norm.recip(), sin: slope / norm }
}

fn nothing_before(found: &str) -> Error {
    let expected = "a segment before it, or `start = [x, z]` and a line with its `slope`";
    Error::new("first segment", found, expected, "give the first segment in full")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn centre_of_last(builder: &ChainBuilder) -> [f64; 2] {
        match builder.segments.last().map(|s| &s.shape) {
            Some(super::super::Shape::Arc(arc)) => arc.centre().unwrap_or([f64::NAN; 2]),
            _ => [f64::NAN; 2],
        }
    }

    fn assert_near(found: [f64; 2], expected: [f64; 2]) {
        for k in 0..2 {
            assert!((found[k] - expected[k]).abs() < 2e-13, "{found:?} is not {expected:?}");
        }
    }

    #[test]
    fn line_to_arc_follows_a3_and_a4() -> Result<()> {
        let (slope, x, radius) = (0.35, 12.0, 80.0);
        let mut builder = ChainBuilder::starting_at([-3.0, 1.0])?;
        builder.line_to(Some(slope), x)?;
        builder.arc_to(radius, Half::Upper, 30.0)?;
        let z = 1.0 + slope * (x + 3.0);
        let root = (1.0 + slope * slope).sqrt();
        assert_near(centre_of_last(&builder), [x + slope / root * radius, z - radius / root]);
        Ok(())
    }

    #[test]
    fn arc_to_arc_follows_a8_to_a10() -> Result<()> {
        let (centre, before, after, x): ([f64; 2], f64, f64, f64) = ([1.0, -300.0], 300.0, 80.0, 10.0);
        let mut builder = ChainBuilder::new();
        builder.push(Segment::arc(Arc::about(centre, before, Half::Upper, [-10.0, x])?));
        builder.arc_to(after, Half::Upper, 26.0)?;
        let z = centre[1] + (before * before - (x - centre[0]).powi(2)).sqrt();
        let share = 1.0 - after / before;
        let expected = [centre[0] + share * (x - centre[0]), centre[1] - share * (centre[1] - z)];
        assert_near(centre_of_last(&builder), expected);
        Ok(())
    }

    #[test]
    fn arc_to_line_follows_a11_to_a13() -> Result<()> {
        let (centre, radius, x): ([f64; 2], f64, f64) = ([0.0, -13.0], 13.0, 9.0);
        let mut builder = ChainBuilder::new();
        builder.push(Segment::arc(Arc::about(centre, radius, Half::Upper, [0.0, x])?));
        builder.line_to(None, 12.0)?;
        let z = centre[1] + (radius * radius - (x - centre[0]).powi(2)).sqrt();
        let slope = -(x - centre[0]) / (z - centre[1]);
        let end = builder.finish().last().map(Segment::end);
        let expected = z - slope * x + slope * 12.0;
        assert!(
            end.is_some_and(
                |end| (end.z - expected).abs() < 1e-13 && (end.sin / end.cos - slope).abs() < 1e-14
            )
        );
        Ok(())
    }

    #[test]
    fn nothing_to_go_on_from_is_an_error() -> Result<()> {
        assert!(ChainBuilder::new().line_to(Some(0.0), 1.0).is_err());
        assert!(ChainBuilder::new().arc_to(1.0, Half::Upper, 1.0).is_err());
        assert!(ChainBuilder::starting_at([0.0, 0.0])?.line_to(None, 1.0).is_err());
        Ok(())
    }

    #[test]
    fn what_is_not_finite_is_named() -> Result<()> {
        let place = |result: Result<()>| result.err().map(|e| e.place).unwrap_or_default();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(ChainBuilder::starting_at([0.0, bad]).is_err_and(|e| e.place == "start"));
            let mut builder = ChainBuilder::starting_at([0.0, 0.0])?;
            assert_eq!(place(builder.line_to(Some(bad), 1.0)), "line: slope");
            assert_eq!(place(builder.line_to(Some(0.0), bad)), "line: to_x");
            builder.line_to(Some(0.0), 1.0)?;
            assert_eq!(place(builder.arc_to(bad, Half::Upper, 2.0)), "arc: radius");
            assert_eq!(place(builder.arc_to(9.0, Half::Upper, bad)), "arc: to_x");
            assert_eq!(builder.finish().len(), 1);
        }
        Ok(())
    }
}
