//! Reads segments in the form in which scenes and data files give them.

use serde::{Deserialize, Serialize};

use super::builder::ChainBuilder;
use super::{Arc, Half, Polynomial, Profile, Segment, Shape};
use crate::error::{Error, Result, given};

/// One segment of a chain: exactly one of `line`, `arc`, `polynomial`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SegmentData {
    /// Name of the segment in the drawing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// A straight line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<LineData>,
    /// A circular arc.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc: Option<ArcData>,
    /// A polynomial z(x).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polynomial: Option<PolynomialData>,
}

/// A line: `from` and `to`, or `to_x` with `slope` (Appendix A).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LineData {
    /// First point [x, z], mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<[f64; 2]>,
    /// Last point [x, z], mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<[f64; 2]>,
    /// Slope dz/dx. Without it the line continues the tangent of the previous segment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
    /// Abscissa of the end, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_x: Option<f64>,
}

/// An arc: `center` and `x`, or `to_x` (Appendix A).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ArcData {
    /// Centre [a, b], mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 2]>,
    /// Radius, mm, positive.
    pub radius: f64,
    /// Half of the circle on which the arc is.
    pub half: HalfData,
    /// Abscissae [x0, x1] of the ends, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<[f64; 2]>,
    /// Abscissa of the end, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_x: Option<f64>,
}

/// Half of a circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum HalfData {
    /// The upper half, which bulges up.
    Upper,
    /// The lower half, which bulges down.
    Lower,
}

/// A polynomial z = Σ c_k x^k over [x0, x1], mm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PolynomialData {
    /// Abscissae [x0, x1] of the ends, mm.
    pub x: [f64; 2],
    /// Coefficients c0, c1, … of z(x).
    pub coefficients: Vec<f64>,
}

impl SegmentData {
    /// Gives this segment in mm, where its numbers are in a unit of `unit` mm. The coefficients of a polynomial are those of z over x
    /// in that unit.
    #[must_use]
    pub fn in_millimetres(&self, unit: f64) -> Self {
        let point = |point: Option<[f64; 2]>| point.map(|point| point.map(|value| unit * value));
        let line = |line: &LineData| LineData {
            from: point(line.from),
            to: point(line.to),
            slope: line.slope,
            to_x: line.to_x.map(|x| unit * x),
        };
        let arc = |arc: &ArcData| ArcData {
            center: point(arc.center),
            radius: unit * arc.radius,
            half: arc.half,
            x: point(arc.x),
            to_x: arc.to_x.map(|x| unit * x),
        };
        let polynomial = |polynomial: &PolynomialData| {
            let powers = polynomial.coefficients.iter().zip(0..);
            let coefficients = powers.map(|(c, power)| c * unit * unit.powi(power).recip()).collect();
            PolynomialData { x: polynomial.x.map(|x| unit * x), coefficients }
        };
        Self {
            label: self.label.clone(),
            line: self.line.as_ref().map(line),
            arc: self.arc.as_ref().map(arc),
            polynomial: self.polynomial.as_ref().map(polynomial),
        }
    }
}

/// Makes the profile of a chain of segments. `start` is the first point of a chain that begins in the form of Appendix A.
///
/// # Errors
/// A wrong segment, with its name and what is wrong with it; the errors of [`Profile::new`].
pub fn drawn_profile(
    name: &str,
    source: &str,
    start: Option<[f64; 2]>,
    data: &[SegmentData],
) -> Result<Profile> {
    let mut builder = start.map_or_else(|| Ok(ChainBuilder::new()), ChainBuilder::starting_at)?;
    let mut labels = Vec::with_capacity(data.len());
    for (index, segment) in data.iter().enumerate() {
        let label = segment.label.clone().unwrap_or_default();
        append(&mut builder, segment).map_err(|error| {
            let name = if label.is_empty() { String::new() } else { format!(" ({label})") };
            error.within(format!("segment {}{name}", index + 1))
        })?;
        labels.push(label);
    }
    let mut segments = builder.finish();
    for (segment, label) in segments.iter_mut().zip(labels) {
        segment.label = label;
    }
    Profile::new(name, source, segments)
}

fn append(builder: &mut ChainBuilder, data: &SegmentData) -> Result<()> {
    let plain = |shape| Segment { label: String::new(), shape };
    match (&data.line, &data.arc, &data.polynomial) {
        (Some(LineData { from: Some(from), to: Some(to), slope: None, to_x: None }), None, None) => {
            let line = Arc::line(*from, *to)?;
            if from[0] > to[0] {
                let found = format!("from x = {} to x = {}", from[0], to[0]);
                return Err(Error::new("line", found, "points in order of x", "swap them"));
            }
            builder.push(plain(Shape::Arc(line)));
            Ok(())
        }
        (Some(LineData { from: None, to: None, slope, to_x: Some(to_x) }), None, None) => {
            builder.line_to(*slope, *to_x)
        }
        (Some(line), None, None) => {
            let expected = "either `from` and `to`, or `to_x` and perhaps `slope`";
            Err(Error::new("line", line.given(), expected, "give one of the two forms"))
        }
        (None, Some(ArcData { center: Some(center), radius, half, x: Some(x), to_x: None }), None) => {
            builder.push(plain(Shape::Arc(Arc::about(*center, *radius, (*half).into(), *x)?)));
            Ok(())
        }
        (None, Some(ArcData { center: None, radius, half, x: None, to_x: Some(to_x) }), None) => {
            builder.arc_to(*radius, (*half).into(), *to_x)
        }
        (None, Some(arc), None) => {
            let expected = "either `center` and `x`, or `to_x`, with `radius` and `half`";
            Err(Error::new("arc", arc.given(), expected, "give one of the two forms"))
        }
        (None, None, Some(polynomial)) => {
            let graph = Polynomial::graph(&polynomial.coefficients, polynomial.x)?;
            builder.push(plain(Shape::Polynomial(graph)));
            Ok(())
        }
        _ => {
            let expected = "exactly one of `line`, `arc`, `polynomial`";
            let found = given(&[
                ("line", data.line.is_some()),
                ("arc", data.arc.is_some()),
                ("polynomial", data.polynomial.is_some()),
            ]);
            Err(Error::new("", found, expected, "give one, further ones as segments of their own"))
        }
    }
}

impl LineData {
    fn given(&self) -> String {
        let Self { from, to, slope, to_x } = self;
        let ends = [("from", from.is_some()), ("to", to.is_some())];
        given(&[ends[0], ends[1], ("slope", slope.is_some()), ("to_x", to_x.is_some())])
    }
}

impl ArcData {
    fn given(&self) -> String {
        let Self { center, x, to_x, .. } = self;
        given(&[("center", center.is_some()), ("x", x.is_some()), ("to_x", to_x.is_some())])
    }
}

impl From<HalfData> for Half {
    fn from(half: HalfData) -> Self {
        match half {
            HalfData::Upper => Self::Upper,
            HalfData::Lower => Self::Lower,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complaint(segments: &str) -> std::result::Result<String, toml::de::Error> {
        #[derive(Deserialize)]
        struct DrawnProfile {
            start: Option<[f64; 2]>,
            segments: Vec<SegmentData>,
        }
        let drawn: DrawnProfile = toml::from_str(segments)?;
        let error = drawn_profile("drawn", "", drawn.start, &drawn.segments).err();
        Ok(error.map(|e| e.to_string()).unwrap_or_default())
    }

    /// A chain of a line, an arc and a parabola in inches is 25.4 times as large in mm: all its ends, with their slopes.
    #[test]
    fn segments_in_inches_are_those_in_millimetres() -> Result<()> {
        let none = SegmentData { label: None, line: None, arc: None, polynomial: None };
        let line = LineData { from: Some([-2.0, -0.5]), to: Some([-1.0, 0.0]), slope: None, to_x: None };
        let arc = ArcData { center: None, radius: 3.0, half: HalfData::Upper, x: None, to_x: Some(0.0) };
        let polynomial = PolynomialData { x: [0.0, 1.5], coefficients: vec![0.125, -0.25, -0.0625] };
        let chain = [
            SegmentData { line: Some(line), ..none.clone() },
            SegmentData { arc: Some(arc), ..none.clone() },
            SegmentData { polynomial: Some(polynomial), ..none },
        ];
        let inches = drawn_profile("inches", "", None, &chain[..2])?;
        let millimetres: Vec<SegmentData> =
            chain.iter().map(|segment| segment.in_millimetres(25.4)).collect();
        let scaled = drawn_profile("mm", "", None, &millimetres[..2])?;
        for (a, b) in inches.segments().iter().zip(scaled.segments()) {
            for (a, b) in [(a.start(), b.start()), (a.end(), b.end())] {
                assert!((25.4 * a.x - b.x).abs() < 1e-13 && (25.4 * a.z - b.z).abs() < 1e-13, "{a:?} {b:?}");
                assert!((a.sin - b.sin).abs() < 1e-13, "{a:?} {b:?}");
            }
        }
        let parabola = millimetres[2].polynomial.as_ref().map(|p| (p.x[1], p.coefficients.clone()));
        let Some((x, c)) = parabola else { panic!("no parabola") };
        let z = c[0] + x * (c[1] + x * c[2]);
        assert!((z / 25.4 - (0.125 + 1.5 * (-0.25 - 1.5 * 0.0625))).abs() < 1e-15, "{z}");
        Ok(())
    }

    #[test]
    fn a_wrong_segment_is_answered_with_what_it_has() -> std::result::Result<(), toml::de::Error> {
        for (segments, message) in [
            (
                "segments = [{ line = { from = [0, 0], slope = 1, to_x = 2 } }]",
                "line: found `from`, `slope` and `to_x`;",
            ),
            ("segments = [{ line = {} }]", "line: found none of `from`, `to`, `slope`, `to_x`;"),
            ("segments = [{ arc = { radius = 1, half = 'upper', x = [0, 1] } }]", "arc: found `x` alone;"),
            ("segments = [{}]", "segment 1: found none of `line`, `arc`, `polynomial`;"),
            (
                "segments = [{ line = { to_x = 2 }, arc = { radius = 1, half = 'upper' } }]",
                "segment 1: found `line` and `arc`;",
            ),
            ("start = [nan, 0]\nsegments = [{ line = { slope = 0, to_x = 2 } }]", "start: found NaN;"),
            (
                "start = [0, 0]\nsegments = [{ line = { slope = inf, to_x = 2 } }]",
                "segment 1: line: slope: found inf;",
            ),
        ] {
            let found = complaint(segments)?;
            assert!(found.contains(message), "{segments}: {found}");
        }
        Ok(())
    }
}
