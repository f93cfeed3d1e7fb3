//! The picture of a profile: points, curve, residual and curvature.

use crate::export::{ProfilePicture, SEPARATOR};
use crate::measured::{CurveRecord, Record};
use crate::profile::{Mark, Profile, beside, trace};

/// Distance of the curve's marks \[mm\]: 1500 on a profile, finer than a page can show.
const STEP: f64 = 0.1;

/// Draws a profile with the points \[mm\] that it was measured at, as SVG; `about` stands below its name.
pub fn profile_picture(profile: &Profile, about: &str, points: &[[f64; 2]]) -> String {
    let marks = trace(profile, STEP);
    ProfilePicture {
        title: profile.title(),
        about,
        points,
        curve: &marks.iter().map(|mark| [mark.station.x, mark.station.z]).collect::<Vec<_>>(),
        residual: &residual(&marks, points),
        curvature: &marks.iter().map(|mark| [mark.s, mark.curvature]).collect::<Vec<_>>(),
    }
    .svg()
}

/// Says in a line where a profile comes from, and how a measured one was fitted.
pub fn about_profile(profile: &Profile, record: Option<&Record>) -> String {
    let segments = profile.segments().len();
    let Some(record) = record else {
        return format!("{segments} segments{SEPARATOR}{}", profile.source);
    };
    let CurveRecord { residual, cutoff_wavelength, tolerance, .. } = &record.curve;
    let mut out = format!("{} points", record.points_used);
    if let Some(cutoff) = cutoff_wavelength {
        out += &format!("{SEPARATOR}cut-off wavelength {cutoff} mm");
    }
    if let Some(tolerance) = tolerance {
        out += &format!("{SEPARATOR}tolerance {tolerance} mm");
    }
    if let Some(residual) = residual {
        let (largest, rms) = (1e3 * residual.largest, 1e3 * residual.rms);
        out += &format!("{SEPARATOR}residual: largest {largest:.2} µm, rms {rms:.2} µm");
    }
    out + &format!("{SEPARATOR}{segments} segments")
}

/// Returns \[arc length s, distance to the left of the curve\] \[mm\] for every point.
fn residual(marks: &[Mark], points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut hint = 0;
    let residual = |point: &[f64; 2]| {
        let found = beside(marks, *point, hint)?;
        hint = found.mark;
        Some([found.s, found.across])
    };
    points.iter().filter_map(residual).collect()
}
