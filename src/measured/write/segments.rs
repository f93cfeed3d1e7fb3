//! Writes a profile as the segments of a scene.

use serde::Serialize;

use crate::error::{Error, Result};
use crate::numerics::polynomial::recentred;
use crate::numerics::twice::Twice;
use crate::profile::{
    Arc, ArcData, HalfData, LineData, Polynomial, PolynomialData, Profile, Segment, SegmentData, Shape,
    Station,
};

/// A profile as the segments of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Segments {
    /// The segments in order of x.
    pub segments: Vec<SegmentData>,
    /// Texts on what was cut off at the two ends: side faces beyond the vertical, which a graph z(x) cannot hold.
    pub cut: Vec<String>,
}

/// Writes a profile file: TOML with name, source and segments. Also returns what was cut off.
///
/// # Errors
/// The errors of [`segments`].
pub fn chain(profile: &Profile) -> Result<(String, Vec<String>)> {
    #[derive(Serialize)]
    struct SegmentsFile<'a> {
        name: &'a str,
        source: &'a str,
        segments: Vec<SegmentData>,
    }
    let Segments { segments, cut } = segments(profile)?;
    let file = SegmentsFile { name: &profile.name, source: &profile.source, segments };
    let text = toml::to_string(&file).map_err(|error| {
        Error::new("segments", error.to_string(), "segments that TOML can hold", "report this")
    })?;
    Ok((text, cut))
}

/// Gives the profile as segments of a scene. Side faces are cut off where they are vertical.
///
/// # Errors
/// Segments between the ends that are no graph z(x), with their place: undercuts, and the parametric spans of a spline. A
/// profile made with `curve = "arcs"` can be written.
pub fn segments(profile: &Profile) -> Result<Segments> {
    let all = profile.drawn();
    let first = all.iter().position(|segment| segment.end().cos >= 0.0).unwrap_or(all.len());
    let last = all.iter().rposition(|segment| segment.start().cos >= 0.0).map_or(0, |k| k + 1);
    let (mut segments, mut cut) = (Vec::with_capacity(all.len()), Vec::new());
    for (k, segment) in all.iter().enumerate() {
        let ends = [k == first, k + 1 == last];
        let clipped = [segment.start(), segment.end()].map(|station| station.cos < 0.0);
        if k < first || k >= last {
            cut.push(format!("{}: beyond the vertical", segment.place(k)));
            continue;
        }
        if (0..2).any(|end| ends[end] && clipped[end]) {
            cut.push(format!("{}: the part beyond the vertical", segment.place(k)));
        }
        let data = match &segment.shape {
            Shape::Arc(arc) => arc_data(arc, ends),
            Shape::Polynomial(polynomial) => polynomial_data(polynomial),
        };
        segments.push(labelled(segment, data.map_err(|error| error.within(segment.place(k)))?));
    }
    Ok(Segments { segments, cut })
}

fn labelled(segment: &Segment, data: SegmentData) -> SegmentData {
    SegmentData { label: (!segment.label.is_empty()).then(|| segment.label.clone()), ..data }
}

const NOTHING: SegmentData = SegmentData { label: None, line: None, arc: None, polynomial: None };

/// Returns the data of an arc. An end that `clip` allows is cut off where its tangent is vertical.
fn arc_data(arc: &Arc, clip: [bool; 2]) -> Result<SegmentData> {
    let (start, end) = (arc.start, arc.end);
    let vertical = |side: f64| arc.centre().map_or(f64::NAN, |[a, _]| a + side * arc.radius.abs());
    let x0 = if clip[0] && start.cos < 0.0 { vertical(-1.0) } else { start.x };
    let x1 = if clip[1] && end.cos < 0.0 { vertical(1.0) } else { end.x };
    let graph = |station: &Station, clip: bool| clip || station.cos >= 0.0;
    if !(graph(&start, clip[0]) && graph(&end, clip[1]) && x0 < x1) {
        let found = format!("an arc that goes back at x = {}", end.x);
        return Err(Error::new("", found, "a graph z(x)", "cut the side faces off the points"));
    }
    let chord = (end.x - start.x).hypot(end.z - start.z);
    let sagitta = chord * chord / (8.0 * arc.radius.abs());
    let data = match arc.centre() {
        // If the centre is very far away, a height relative to it has fewer digits than the arc is high.
        Some(center) if sagitta > 4.0 * f64::EPSILON * arc.radius.abs() => {
            let half = if arc.radius < 0.0 { HalfData::Upper } else { HalfData::Lower };
            let x = Some([x0, x1]);
            let data = ArcData { center: Some(center), radius: arc.radius.abs(), half, x, to_x: None };
            SegmentData { arc: Some(data), ..NOTHING }
        }
        _ => {
            let (from, to) = (Some([start.x, start.z]), Some([end.x, end.z]));
            SegmentData { line: Some(LineData { from, to, slope: None, to_x: None }), ..NOTHING }
        }
    };
    Ok(data)
}

/// Returns z(x) in powers of x about 0, as standards print it. A polynomial that was read in that form comes back bit for
/// bit.
fn polynomial_data(polynomial: &Polynomial) -> Result<SegmentData> {
    // A moved polynomial has as many coefficients of x as of z.
    let linear = |x: &[Twice]| x.iter().skip(2).all(|higher| f64::from(*higher) == 0.0);
    let graph = polynomial.x.get(1).is_some_and(|slope| f64::from(*slope) == 1.0) && linear(&polynomial.x);
    if !graph {
        let advice = "use curve = \"arcs\", or name the file in the scene";
        return Err(Error::new("", "a span of a parametric spline", "a graph z(x)", advice));
    }
    let middle = polynomial.x[0];
    let about_zero = recentred(&polynomial.z, -middle);
    let x = polynomial.t.ends().map(|t| f64::from(middle + t));
    let coefficients = about_zero.into_iter().map(f64::from).collect();
    Ok(SegmentData { polynomial: Some(PolynomialData { x, coefficients }), ..NOTHING })
}
