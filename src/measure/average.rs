//! The average of profiles: a representative one of a segment, with its spread.

use super::align::{self, Aligned};
use super::curve::MarkedCurve;
use super::nominal::{Nominal, sized};
use super::options::MeasureOptions;
use super::overlay::across;
use crate::error::{Error, Result};
use crate::numerics::interval::Interval;
use crate::profile::{Profile, Side, Station};

/// Distance of the points along the average \[mm\], as of hand-held instruments.
const STEP: f64 = 0.2;

/// A point of an average profile; lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AveragePoint {
    /// The point \[x, z\]: the mean of the profiles along the normal.
    pub at: [f64; 2],
    /// Unit normal \[x, z\], to the left of the way from left to right: up.
    pub normal: [f64; 2],
    /// Standard deviation of the profiles along the normal, n − 1 under the root.
    pub spread: f64,
    /// Offsets of the lowest and the highest profile along the normal.
    pub range: Interval,
    /// Number of profiles that have a point on the normal.
    pub count: usize,
}

/// The average of profiles, in the axes of the nominal, or those in which each of them is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Average {
    /// Its points from left to right, where at least half of the profiles are.
    pub points: Vec<AveragePoint>,
    /// Number of profiles that were averaged.
    pub profiles: usize,
    /// Which profiles are left out and why, and which alignments are doubted.
    pub findings: Vec<String>,
}

impl Average {
    /// Returns its points \[x, z\] \[mm\].
    pub fn xz(&self) -> Vec<[f64; 2]> {
        self.points.iter().map(|point| point.at).collect()
    }

    /// Returns the root of the mean square of the spread \[mm\].
    pub fn spread(&self) -> f64 {
        let squares: f64 = self.points.iter().map(|point| point.spread * point.spread).sum();
        (squares / self.points.len().max(1) as f64).sqrt()
    }

    /// Writes it as CSV: x_mm, z_mm, spread_mm, least_mm, largest_mm, profiles.
    pub fn csv(&self) -> String {
        let mut text = "x_mm,z_mm,spread_mm,least_mm,largest_mm,profiles\n".to_owned();
        for AveragePoint { at: [x, z], spread, range, count, .. } in &self.points {
            text += &format!("{x},{z},{spread},{},{},{count}\n", range.low, range.high);
        }
        text
    }
}

/// Averages profiles, right-hand and upright, along the normals of their average. They are aligned as [`measure`](super::measure()) aligns
/// them: on the nominal, or in their own axes, wheels with X = 0 at the flange back.
///
/// Accuracy: that of the alignment; along the normals 1e-7 mm on the curves. Cost: some 50 ms a profile, and the alignment's.
///
/// # Errors
/// Options without meaning; fewer than two profiles that can be aligned.
///
/// # Examples
/// ```
/// use wheelrail::measure::{MeasureOptions, average};
/// use wheelrail::{Side, standards};
///
/// let wheel = standards::wheel("S1002")?;
/// let raised = wheel.clone().shifted(0.0, 0.2);
/// let average = average(&[&wheel, &raised], Side::Wheel, None, &MeasureOptions::default())?;
/// let from_circle = |x: f64| (x - 70.0).abs(); // X = 0 is the flange back
/// let closer = |a: f64, b: f64| from_circle(a).total_cmp(&from_circle(b));
/// let tread = average.points.iter().min_by(|a, b| closer(a.at[0], b.at[0])).expect("points");
/// assert!((tread.at[1] - 0.1).abs() < 0.01 && (tread.range.high - 0.1).abs() < 1e-3);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn average(
    profiles: &[&Profile],
    side: Side,
    nominal: Option<&Profile>,
    options: &MeasureOptions,
) -> Result<Average> {
    options.validate(side, nominal.is_some())?;
    let nominal = nominal.map(|nominal| Nominal::named(nominal, side)).transpose()?;
    let (mut curves, mut findings) = (Vec::new(), Vec::new());
    for profile in profiles {
        match sized(profile).and_then(|curve| align::align(&curve, side, nominal.as_ref(), options)) {
            Ok(aligned) => {
                let doubt = aligned.alignment.doubt.iter();
                findings.extend(doubt.map(|doubt| format!("{}: {doubt}", profile.name)));
                curves.push(in_common_axes(aligned, nominal.is_some()));
            }
            Err(why) => findings.push(format!("{}: left out, {why}", profile.name)),
        }
    }
    if curves.len() < 2 {
        let found = format!("{} that can be aligned; {}", curves.len(), findings.join("; "));
        return Err(Error::new(
            "profiles",
            found,
            "two profiles or more",
            "give others, or another alignment",
        ));
    }
    let length = |curve: &MarkedCurve| curve.marks.last().map_or(0.0, |mark| mark.s);
    let longest = curves.iter().max_by(|a, b| length(a).total_cmp(&length(b)));
    let first: Vec<Station> = longest.map_or_else(Vec::new, stations);
    // The first reference has its own noise; distances count along the normals of the average.
    let rough = averaged(&curves, &first);
    let points = averaged(&curves, &along(&rough));
    Ok(Average { points, profiles: curves.len(), findings })
}

/// Moves a wheel that has no nominal so that x = 0 is its flange back.
fn in_common_axes(aligned: Aligned, nominal: bool) -> MarkedCurve {
    if nominal || aligned.back == 0.0 {
        return aligned.curve;
    }
    aligned.curve.placed(&Station { x: -aligned.back, ..Station::AXES })
}

/// Returns stations of a curve at even distances.
fn stations(curve: &MarkedCurve) -> Vec<Station> {
    let mut next = 0.0;
    let mut out = Vec::new();
    for mark in curve.marks.iter().filter(|mark| mark.station.sin.is_finite()) {
        if mark.s >= next {
            next = mark.s + STEP;
            out.push(mark.station);
        }
    }
    out
}

/// Returns stations at the points of an average, with the directions between their neighbours.
fn along(points: &[AveragePoint]) -> Vec<Station> {
    let last = points.len().saturating_sub(1);
    let station = |k: usize| {
        let [a, b] = [points[k.saturating_sub(1)].at, points[(k + 1).min(last)].at];
        let (dx, dz) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dz);
        let [x, z] = points[k].at;
        (length > 0.0).then(|| Station { x, z, cos: dx / length, sin: dz / length })
    };
    (0..points.len()).filter_map(station).collect()
}

/// Averages curves along the normals of stations, where at least half of the curves, and at least two, have a point.
fn averaged(curves: &[MarkedCurve], stations: &[Station]) -> Vec<AveragePoint> {
    let least = curves.len().div_ceil(2).max(2);
    let mut out = Vec::new();
    for at in stations {
        let normal = [-at.sin, at.cos];
        let offset = |[x, z]: [f64; 2]| (x - at.x) * normal[0] + (z - at.z) * normal[1];
        let offsets: Vec<f64> = curves.iter().filter_map(|curve| across(curve, at)).map(offset).collect();
        if offsets.len() < least {
            continue;
        }
        let count = offsets.len() as f64;
        let mean = offsets.iter().sum::<f64>() / count;
        let squares: f64 = offsets.iter().map(|offset| (offset - mean).powi(2)).sum();
        out.push(AveragePoint {
            at: [at.x + mean * normal[0], at.z + mean * normal[1]],
            normal,
            spread: (squares / (count - 1.0)).sqrt(),
            range: Interval::around(offsets.iter().map(|offset| offset - mean)),
            count: offsets.len(),
        });
    }
    out
}
