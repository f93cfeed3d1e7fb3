//! Pictures for notebooks.

use wheelrail::export::ProfilePicture;
use wheelrail::profile::trace;

/// Distance \[mm\] of the points of a drawn profile: smooth to the eye.
const STEP: f64 = 0.2;

/// Draws a profile.
pub(crate) fn profile(profile: &wheelrail::Profile) -> String {
    let marks = trace(profile, STEP);
    let curve: Vec<[f64; 2]> = marks.iter().map(|mark| [mark.station.x, mark.station.z]).collect();
    let curvature: Vec<[f64; 2]> = marks.iter().map(|mark| [mark.s, mark.curvature]).collect();
    let (points, residual) = (&[], &[]);
    let (title, about) = (&profile.name, &profile.source);
    ProfilePicture { title, about, points, curve: &curve, residual, curvature: &curvature }.svg()
}
