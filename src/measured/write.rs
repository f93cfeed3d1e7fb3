//! Writes points in profile axes as the text of a file, in the axes of its format.
//!
//! A number is written with the fewest digits that read back as the same number.

use std::fmt::Write as _;

use serde::Serialize;

use super::Format;
use crate::error::{Error, ErrorKind, Result};
use crate::numerics::polynomial::recentred;
use crate::profile::{
    Arc, ArcData, HalfData, LineData, Polynomial, PolynomialData, Profile, Segment, SegmentData, Shape, Side,
    Station,
};

/// Returns the text of a file with these points \[mm\]: x to the field side, z up, from left to right. `name` goes into its
/// header.
///
/// The gauge side of a MiniProf rail is written at positive X, as instruments have it. Reading the file therefore needs
/// `mirror = true`.
pub fn points(points: &[[f64; 2]], format: Format, side: Side, name: &str) -> String {
    // A control character or quote in the name would end its line or its string.
    let name: String = name.chars().filter(|c| !c.is_control() && !"'\"!".contains(*c)).collect();
    match format {
        Format::MiniProf => miniprof(points, side, &name),
        Format::Simpack => simpack(points, side, &name),
        Format::Gensys => rows(points.iter().rev().map(|[x, z]| [-x, -z]), " "),
        Format::Text => {
            format!("# {name}: x to the field side, z up, mm\n{}", rows(points.iter().copied(), " "))
        }
        Format::Csv => format!("x_mm,z_mm\n{}", rows(points.iter().copied(), ",")),
    }
}

fn rows(points: impl Iterator<Item = [f64; 2]>, separator: &str) -> String {
    let mut out = String::new();
    for [a, b] in points {
        // Adding 0.0 turns −0 into 0. Writing to a string cannot fail.
        let _ = writeln!(out, "{}{separator}{}", a + 0.0, b + 0.0);
    }
    out
}

fn miniprof(points: &[[f64; 2]], side: Side, name: &str) -> String {
    let turned = points.iter().map(|[x, z]| match side {
        Side::Rail => [-x, *z],
        Side::Wheel => [*x, -z],
    });
    let mut out = String::new();
    for line in
        ["ProgramName=wheelrail", "ProgramVer=", "Chars=UTF8", "Xoffset=0", "Yoffset=0", "ColumnDef=X,Y"]
    {
        let _ = writeln!(out, "{line}");
    }
    let _ = writeln!(out, "Comment={name}\nXYPoints={}\n", points.len());
    out + &rows(turned, " ")
}

/// Returns a SIMPACK file with the material to the right of the path, as CONTACT needs it: rails go from left to right,
/// wheels from right to left.
fn simpack(points: &[[f64; 2]], side: Side, name: &str) -> String {
    let body = match side {
        Side::Rail => 0,
        Side::Wheel => 1,
    };
    let mut out = format!(
        "! {name}\n  header.begin\n    version        =  1\n    type           =  {body}   ! 0 rail, 1 wheel\n  \
         header.end\n  spline.begin\n    approx.smooth  =  0.0\n    comment        = '{name}'\n"
    );
    for (step, key, value) in [
        (1, "point.dist.min", "0.0"),
        (2, "shift.y", "0.0"),
        (2, "shift.z", "0.0"),
        (3, "rotate", "0.0"),
        (4, "bound.y.min", "1.0"),
        (4, "bound.y.max", "0.0"),
        (4, "bound.z.min", "1.0"),
        (4, "bound.z.max", "0.0"),
        (5, "mirror.y", "0"),
        (5, "mirror.z", "0"),
        (6, "inversion", "0"),
        (7, "units.len", "'mm'"),
        (7, "units.ang", "'rad'"),
        (7, "units.len.f", "1000.0"),
        (7, "units.ang.f", "1.0"),
    ] {
        let _ = writeln!(out, "    {key:<14} =  {value}   ! {step}");
    }
    let _ = writeln!(out, "    point.begin");
    let turned = points.iter().map(|[x, z]| [*x, -z]);
    out += &match side {
        Side::Rail => rows(turned, " "),
        Side::Wheel => rows(turned.rev(), " "),
    };
    out + "    point.end\n  spline.end\n"
}

/// Least distance \[mm\] of neighbours in files for other programs. CONTACT's spline loses whole contacts where points are
/// some micrometres apart, and no instrument resolves less.
pub const LEAST_DISTANCE: f64 = 0.01;

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < LEAST_DISTANCE
}

/// Returns the points without those nearer than [`LEAST_DISTANCE`] to the last kept one. The first and the last point stay.
pub fn spaced(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    for &point in points {
        if !out.last().is_some_and(|&kept| near(kept, point)) {
            out.push(point);
        }
    }
    if let Some(&last) = points.last() {
        while out.len() > 1 && out.last().is_some_and(|&kept| kept != last && near(kept, last)) {
            out.pop();
        }
        if out.last() != Some(&last) {
            out.push(last);
        }
    }
    out
}

/// Returns points \[mm\] at most `step` \[mm\] apart along a profile, all joints included.
///
/// # Errors
/// A step that is not positive, or that gives more than 100 000 points on one segment.
pub fn sample(profile: &Profile, step: f64) -> Result<Vec<[f64; 2]>> {
    if !(step > 0.0 && step.is_finite()) {
        return Err(Error::new("step", step.to_string(), "a positive number of mm", "correct it"));
    }
    let mut out: Vec<[f64; 2]> = Vec::new();
    for segment in profile.segments() {
        let own: Vec<[f64; 2]> = match &segment.shape {
            Shape::Arc(arc) => along_arc(arc, step)?,
            Shape::Polynomial(polynomial) => along_polynomial(polynomial, step)?,
        };
        // The end of one segment and the start of the next one are one point.
        let joint = out.last().zip(own.first()).is_some_and(|(a, b)| near(*a, *b));
        out.extend(own.into_iter().skip(usize::from(joint)));
    }
    Ok(out)
}

/// Most points on one segment.
const MOST_SAMPLES: f64 = 1e5;

/// Returns the number of steps of at most `step` over a length, at least 1.
fn steps_over(length: f64, step: f64) -> Result<usize> {
    let n = (length / step).ceil().max(1.0);
    if n <= MOST_SAMPLES {
        return Ok(n as usize);
    }
    let found = format!("{step} mm, which takes {n:e} points over {length:.3} mm");
    Err(Error::new("step", found, format!("at most {MOST_SAMPLES:e} points a segment"), "take a larger step")
        .of_kind(ErrorKind::Limit))
}

fn along_arc(arc: &Arc, step: f64) -> Result<Vec<[f64; 2]>> {
    let n = steps_over(arc.length(), step)?;
    let inner = (1..n).map(|k| {
        let at = arc.station_at(k as f64 / n as f64);
        [at.x, at.z]
    });
    let ends = [arc.start, arc.end].map(|s| [s.x, s.z]);
    Ok(std::iter::once(ends[0]).chain(inner).chain([ends[1]]).collect())
}

fn along_polynomial(polynomial: &Polynomial, step: f64) -> Result<Vec<[f64; 2]>> {
    let [t0, t1] = polynomial.t;
    let at = |share: f64| {
        let station = polynomial.station(t0 + share * (t1 - t0));
        [station.x, station.z]
    };
    // Number of chords that measure the arc length. The parts are smooth and short.
    const CHORDS: usize = 64;
    let coarse: Vec<[f64; 2]> = (0..=CHORDS).map(|k| at(k as f64 / CHORDS as f64)).collect();
    let longest = coarse.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).fold(0.0, f64::max);
    let n = steps_over(longest * CHORDS as f64, step)?;
    Ok((0..=n).map(|k| at(k as f64 / n as f64)).collect())
}

/// A profile as the segments of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Segments {
    /// The `[[segments]]` tables in TOML.
    pub toml: String,
    /// Texts on what was cut off at the two ends: side faces beyond the vertical, which a graph z(x) cannot hold.
    pub cut: Vec<String>,
}

/// Writes the profile as `[[segments]]` of a scene. Side faces are cut off where they are vertical.
///
/// # Errors
/// Segments between the ends that are no graph z(x), with their place: undercuts, and the parametric spans of a spline. A
/// profile made with `curve = "arcs"` can be written.
pub fn segments(profile: &Profile) -> Result<Segments> {
    #[derive(Serialize)]
    struct Scene {
        segments: Vec<SegmentData>,
    }
    let all = profile.drawn();
    let first = all.iter().position(|segment| segment.end().cos >= 0.0).unwrap_or(all.len());
    let last = all.iter().rposition(|segment| segment.start().cos >= 0.0).map_or(0, |k| k + 1);
    let mut scene = Scene { segments: Vec::with_capacity(all.len()) };
    let mut cut = Vec::new();
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
        scene.segments.push(labelled(segment, data.map_err(|error| error.within(segment.place(k)))?));
    }
    let toml = toml::to_string(&scene).map_err(|error| {
        Error::new("segments", error.to_string(), "segments that TOML can hold", "report this")
    })?;
    Ok(Segments { toml, cut })
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
    let graph = polynomial.x.len() == 2 && f64::from(polynomial.x[1]) == 1.0;
    if !graph {
        let advice = "use curve = \"arcs\", or name the file in the scene";
        return Err(Error::new("", "a span of a parametric spline", "a graph z(x)", advice));
    }
    let middle = polynomial.x[0];
    let about_zero = recentred(&polynomial.z, -middle);
    let x = polynomial.t.map(|t| f64::from(middle + t));
    let coefficients = about_zero.into_iter().map(f64::from).collect();
    Ok(SegmentData { polynomial: Some(PolynomialData { x, coefficients }), ..NOTHING })
}
