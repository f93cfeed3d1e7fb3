//! Lines and circular arcs in curvature form: Report (3.2) with a signed radius (erratum 2).

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::station::Station;
use crate::error::{Error, Result, finite};
use crate::numerics::cosine;
use crate::numerics::twice::Twice;

/// Largest distance of an arc's end beyond the vertical tangent, in roundings of the radius. The coordinates of a drawing
/// are rounded, so that an end can lie a little beyond. An end farther out belongs to a drawing that does not close.
const VERTICAL_END_ROUNDINGS: f64 = 64.0;

/// The half of its circle on which an arc is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    /// The upper half z = b + √(r² − (x − a)²), which bulges up.
    Upper,
    /// The lower half z = b − √(r² − (x − a)²), which bulges down.
    Lower,
}

/// A line (infinite radius) or a circular arc of at most half a turn.
///
/// # Examples
/// ```
/// use wheelrail::{Arc, Half};
///
/// let crown = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-30.0, 40.0])?;
/// assert_eq!(crown.curvature(), -1.0 / 300.0);
/// assert!((crown.start().sin - 0.1).abs() < 1e-15); // it rises by a tenth at x = −30 mm
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Arc {
    /// Station at the beginning.
    pub(crate) start: Station,
    /// Station at the end.
    pub(crate) end: Station,
    /// Signed radius \[mm\]: positive if the arc turns counter-clockwise (lower half), ∞ for a line. The radius is stored
    /// and not the curvature, because the difference of two nearly equal radii is exact.
    #[serde(serialize_with = "finite_or_none", deserialize_with = "infinite_where_none")]
    pub(crate) radius: f64,
}

/// Stores the radius of a line as nothing: JSON has no infinity.
fn finite_or_none<S: Serializer>(radius: &f64, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    Some(*radius).filter(|radius| radius.is_finite()).serialize(serializer)
}

/// Reads a radius as [`finite_or_none`] stores it: an absent one is that of a line.
fn infinite_where_none<'de, D: Deserializer<'de>>(deserializer: D) -> std::result::Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
}

impl Arc {
    /// Makes the line between two points \[mm\].
    ///
    /// # Errors
    /// Points that are not finite or coincide.
    pub fn line(from: [f64; 2], to: [f64; 2]) -> Result<Self> {
        for v in from.into_iter().chain(to) {
            finite("line", v)?;
        }
        let (dx, dz) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dz);
        if length == 0.0 {
            return Err(Error::new("line", "two equal points", "two different points", "drop the segment"));
        }
        let (cos, sin) = (dx / length, dz / length);
        let at = |[x, z]: [f64; 2]| Station { x, z, cos, sin };
        Ok(Self { start: at(from), end: at(to), radius: f64::INFINITY })
    }

    /// Makes the arc about `centre` (a, b) between two abscissae \[mm\]: (3.2-a).
    ///
    /// # Errors
    /// Values that are not finite, a radius that is not positive, abscissae out of order or off the circle.
    pub fn about(centre: [f64; 2], radius: f64, half: Half, x: [f64; 2]) -> Result<Self> {
        for v in centre.into_iter().chain(x).chain([radius]) {
            finite("arc", v)?;
        }
        if radius <= 0.0 {
            let advice = "give the half of the circle by `half`";
            return Err(Error::new("arc: radius", radius.to_string(), "a positive number", advice));
        }
        if x[0] >= x[1] {
            let found = format!("[{}, {}]", x[0], x[1]);
            return Err(Error::new("arc: x", found, "two abscissae in ascending order", "swap them"));
        }
        let signed = if half == Half::Upper { -radius } else { radius };
        let at = |x: f64| station_on_circle(centre, signed, x);
        Ok(Self { start: at(x[0])?, end: at(x[1])?, radius: signed })
    }

    /// Makes the arc or line that leaves `start` along its tangent and ends at abscissa `to_x` \[mm\] (Appendix A: smooth
    /// transitions). `radius` \[mm\] is signed; it is ∞ for a line.
    ///
    /// # Errors
    /// A `to_x` that is not finite, not beyond the start, or not reached before the tangent is vertical.
    pub fn tangent_at(start: Station, radius: f64, to_x: f64) -> Result<Self> {
        let run = finite("to_x", to_x)? - start.x;
        if run <= 0.0 {
            let expected = format!("an abscissa beyond {}", start.x);
            return Err(Error::new("to_x", to_x.to_string(), expected, "give segments in order of x"));
        }
        let sin = start.sin + run / radius;
        let rounding = VERTICAL_END_ROUNDINGS * f64::EPSILON * (1.0 + (start.x / radius).abs());
        if sin.abs() > 1.0 + rounding || start.cos <= 0.0 {
            let farthest = start.x + (1f64.copysign(radius) - start.sin) * radius;
            let expected = format!("an abscissa the arc reaches, {farthest} at most");
            return Err(Error::new("to_x", to_x.to_string(), expected, "correct the radius or the abscissa"));
        }
        let sin = sin.clamp(-1.0, 1.0);
        let cos = cosine(sin);
        let z = start.z + run * (start.sin + sin) / (start.cos + cos);
        Ok(Self { start, end: Station { x: to_x, z, cos, sin }, radius })
    }

    /// Returns the station at the beginning.
    pub fn start(&self) -> Station {
        self.start
    }

    /// Returns the station at the end.
    pub fn end(&self) -> Station {
        self.end
    }

    /// Returns the signed radius \[mm\]: positive if the arc turns counter-clockwise (lower half), ∞ for a line.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the signed curvature \[1/mm\], 0 for a line.
    pub fn curvature(&self) -> f64 {
        self.radius.recip()
    }

    /// Returns the centre (a, b) of (3.2-a) \[mm\], or `None` for a line.
    pub fn centre(&self) -> Option<[f64; 2]> {
        let Station { x, z, cos, sin } = self.start;
        self.radius.is_finite().then_some([x - self.radius * sin, z + self.radius * cos])
    }

    /// Returns the signed turn from start to end \[rad\]; 0 for a line.
    pub fn turn(&self) -> f64 {
        let relative = self.end.seen_from(&self.start);
        let turn = relative.sin.atan2(relative.cos);
        // Half a turn can come out with either sign.
        if self.radius.is_finite() { turn.abs().copysign(self.radius) } else { 0.0 }
    }

    /// Returns the length along the arc \[mm\].
    pub fn length(&self) -> f64 {
        let chord = (self.end.x - self.start.x).hypot(self.end.z - self.start.z);
        if self.radius.is_finite() { (self.turn() * self.radius).abs() } else { chord }
    }

    /// Returns the station at a share (0 to 1) of the arc's length.
    pub fn station_at(&self, share: f64) -> Station {
        // The chord of the part has the direction of the mean tangent. Its length is the length of the part times sinc of
        // half the turn.
        let turn = share * self.turn();
        let half = 0.5 * turn;
        let chord = share * self.length() * if half == 0.0 { 1.0 } else { half.sin() / half };
        Station { x: chord * half.cos(), z: chord * half.sin(), cos: turn.cos(), sin: turn.sin() }
            .placed_by(&self.start)
    }

    pub(super) fn mirrored(&self) -> Self {
        Self { start: self.end.mirrored(), end: self.start.mirrored(), radius: self.radius }
    }

    pub(super) fn upside_down(&self) -> Self {
        let radius = if self.radius.is_finite() { -self.radius } else { self.radius };
        Self { start: self.start.upside_down(), end: self.end.upside_down(), radius }
    }

    pub(super) fn placed_by(&self, frame: &Station) -> Self {
        Self { start: self.start.placed_by(frame), end: self.end.placed_by(frame), radius: self.radius }
    }
}

/// Returns the station of a circle at abscissa x; `radius` is negative for the upper half. The height is rounded only once,
/// because b and r may be thousands of times larger than it.
fn station_on_circle([a, b]: [f64; 2], radius: f64, x: f64) -> Result<Station> {
    let beyond = (x - a).abs() - radius.abs();
    if beyond > VERTICAL_END_ROUNDINGS * f64::EPSILON * (radius.abs() + a.abs()) {
        let expected = format!("abscissae within [{}, {}]", a - radius.abs(), a + radius.abs());
        return Err(Error::new("arc: x", x.to_string(), expected, "correct the centre, radius or end"));
    }
    let offset = Twice::sum(x, -a);
    let square = (Twice::from(radius) - offset) * (Twice::from(radius) + offset);
    let leg = if f64::from(square) > 0.0 { square.sqrt() } else { Twice::ZERO };
    let height = if radius < 0.0 { leg + b } else { -leg + b };
    let sin = f64::from(offset / radius).clamp(-1.0, 1.0);
    Ok(Station { x, z: f64::from(height), cos: f64::from(leg) / radius.abs(), sin })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_about_a_centre_has_its_ends_and_centre() -> Result<()> {
        let arc = Arc::about([3.0, -80.0], 80.0, Half::Upper, [-10.0, 20.0])?;
        assert_eq!(arc.start.x, -10.0);
        assert!((arc.start.z - (-80.0 + (6400.0f64 - 169.0).sqrt())).abs() < 1e-13);
        assert!((arc.start.sin - 13.0 / 80.0).abs() < 1e-16);
        let [a, b] = arc.centre().unwrap_or_default();
        assert!((a - 3.0).abs() < 1e-14 && (b + 80.0).abs() < 1e-13);
        Ok(())
    }

    #[test]
    fn a_radius_of_ten_metres_costs_no_digits() -> Result<()> {
        let arc = Arc::about([0.0, -1e4], 1e4, Half::Upper, [-1e-3, 1.0])?;
        assert!((arc.end.z + 5.000_000_012_5e-5).abs() < 1e-20, "{:e}", arc.end.z);
        Ok(())
    }

    #[test]
    fn tangent_arcs_reach_their_end_or_say_why_not() -> Result<()> {
        let start = Station::AXES;
        let arc = Arc::tangent_at(start, -13.0, 12.0)?;
        assert!((arc.end.z - (-13.0 + 5.0)).abs() < 1e-14);
        assert!(Arc::tangent_at(start, -13.0, 13.5).is_err());
        assert!(Arc::tangent_at(start, f64::INFINITY, -1.0).is_err());
        Ok(())
    }

    #[test]
    fn ends_off_the_circle_are_rejected_but_a_rounded_vertical_end_is_not() -> Result<()> {
        assert!(Arc::about([0.0, 0.0], 1.0, Half::Lower, [0.0, 1.0001]).is_err());
        let end = Arc::about([94.45752, 35.58032], 15.875, Half::Lower, [95.25, 110.33252])?.end;
        assert!(end.cos < 1e-6 && end.sin == 1.0, "{end:?}");
        Ok(())
    }
}
