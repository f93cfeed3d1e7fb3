//! A measured profile over its nominal one, with their differences.

use super::align::{self, Alignment};
use super::curve::MarkedCurve;
use super::nominal::{Nominal, sized};
use super::options::MeasureOptions;
use crate::error::{Error, Result};
use crate::profile::{Profile, Side, Station};

/// Distance of differences along the nominal \[mm\].
const EVERY: f64 = 2.0;
/// One in so many marks is drawn: all of them are finer than a picture shows.
const DRAWN: usize = 4;
/// Farthest difference \[mm\]: beyond it lies another part of the profile.
const FARTHEST: f64 = 15.0;

/// Two aligned curves in the axes of the nominal.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// Points \[x, z\] of the nominal \[mm\].
    pub nominal: Vec<[f64; 2]>,
    /// Points \[x, z\] of the measured curve \[mm\].
    pub measured: Vec<[f64; 2]>,
    /// Points of the nominal, 2 mm apart, each with the point of the measured curve on its normal, where there is one within 15 mm.
    pub differences: Vec<[[f64; 2]; 2]>,
    /// How the profile was aligned.
    pub alignment: Alignment,
}

/// Lays a measured profile over its nominal one.
///
/// # Errors
/// Options without meaning; an alignment that cannot be had.
pub fn overlay(
    profile: &Profile,
    side: Side,
    nominal: &Profile,
    options: &MeasureOptions,
) -> Result<Overlay> {
    options.validate(side, true)?;
    let advice = "choose another alignment, or give the whole profile";
    let error = |why: String| Error::new(&profile.name, why, "a profile that can be aligned", advice);
    let nominal = Nominal::named(nominal, side)?;
    let curve = sized(profile);
    let aligned =
        curve.and_then(|curve| align::align(&curve, side, Some(&nominal), options)).map_err(error)?;
    let points = |curve: &MarkedCurve| {
        let last = curve.marks.len().saturating_sub(1);
        let drawn = curve.marks.iter().enumerate().filter(|(k, _)| k % DRAWN == 0 || *k == last);
        drawn.map(|(_, mark)| [mark.station.x, mark.station.z]).collect()
    };
    let (mut differences, mut next) = (Vec::new(), 0.0);
    for mark in &nominal.curve.marks {
        if mark.s < next {
            continue;
        }
        next = mark.s + EVERY;
        let to = across(&aligned.curve, &mark.station);
        differences.extend(to.map(|to| [[mark.station.x, mark.station.z], to]));
    }
    Ok(Overlay {
        nominal: points(&nominal.curve),
        measured: points(&aligned.curve),
        differences,
        alignment: aligned.alignment,
    })
}

/// Returns the nearest point of a curve on the normal of a station; `None` if there is none within [`FARTHEST`].
pub(super) fn across(curve: &MarkedCurve, at: &Station) -> Option<[f64; 2]> {
    let all = curve.crossings([at.cos, at.sin], at.cos * at.x + at.sin * at.z).into_iter();
    let distance = |point: &[f64; 2]| (point[0] - at.x).hypot(point[1] - at.z);
    let near = all.map(|place| [place.x, place.z]).filter(|point| distance(point) <= FARTHEST);
    near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
