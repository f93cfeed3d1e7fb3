//! Writes points in profile axes as the text of a file, in the axes of its format.
//!
//! A number is written with the fewest digits that read back as the same number.

use std::fmt::Write as _;

use super::Format;
use crate::error::{Error, ErrorKind, Result};
use crate::profile::{Arc, Polynomial, Profile, Shape, Side};

#[cfg(feature = "files")]
mod segments;

#[cfg(feature = "files")]
pub use segments::{Segments, chain, segments};

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
        Format::Vampire => vampire(points, side, &name),
    }
}

/// Returns a Vampire file of both sides: a wheel's datum is its origin, a rail's gauge point becomes its origin when it is read.
fn vampire(points: &[[f64; 2]], side: Side, name: &str) -> String {
    let (head, out) = match side {
        Side::Rail => ("RAILPROFILE\n{}\nGAUGEPOINT EUROPEAN\nGAUGE 1435\n", 717.5),
        Side::Wheel => ("WHEELPROFILE\n{}\nTREADDATUM EUROPEAN\nFLANGEBACK 1360\n", 750.0),
    };
    let mut text = head.replace("{}", &name.chars().take(80).collect::<String>());
    for [x, z] in points {
        let (y, z) = (out + x, if side == Side::Rail { *z } else { 0.0 - z });
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{} {z} {y} {z}", -y);
    }
    text
}

/// Default distance \[mm\] of points along a drawn profile: that of hand-held instruments.
pub const STEP: f64 = 0.2;

/// Writes a profile as the text of a file of points: those that were `measured` \[mm\], unless there are none or a `step` \[mm\] is
/// given. Also returns how many points were left out because SIMPACK's readers cannot tell them from others.
///
/// # Errors
/// No `side` for a format whose axes depend on it; the errors of [`sample`].
pub fn profile(
    profile: &Profile,
    (measured, step): (Option<&[[f64; 2]]>, Option<f64>),
    (format, side): (Format, Option<Side>),
) -> Result<(String, usize)> {
    let own_axes = matches!(format, Format::MiniProf | Format::Simpack | Format::Vampire);
    if side.is_none() && own_axes {
        let expected = format!("the body, which sets the axes of {}", format.title());
        return Err(Error::new("side", "none", expected, "give rail or wheel"));
    }
    let all = match (measured, step) {
        (Some(points), None) => points.to_vec(),
        _ => sample(profile, step.unwrap_or(STEP))?,
    };
    let kept = if format == Format::Simpack { spaced(&all) } else { all.clone() };
    let text = points(&kept, format, side.unwrap_or(Side::Rail), &profile.name);
    Ok((text, all.len() - kept.len()))
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
    let at = |share: f64| {
        let station = polynomial.station(polynomial.t.at(share));
        [station.x, station.z]
    };
    // Number of chords that measure the arc length. The parts are smooth and short.
    const CHORDS: usize = 64;
    let coarse: Vec<[f64; 2]> = (0..=CHORDS).map(|k| at(k as f64 / CHORDS as f64)).collect();
    let longest = coarse.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).fold(0.0, f64::max);
    let n = steps_over(longest * CHORDS as f64, step)?;
    Ok((0..=n).map(|k| at(k as f64 / n as f64)).collect())
}
