//! Bodies that vary: reads the lists of slices of rails and wheels, and the flats and radii of wheels, and joins them to surfaces.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::data::Scene;
use super::profile_data::ProfileData;
use super::profiles::{
    Resolved, SceneSources, is_chain_file, profile_from_file, reject_measured_keys, turned_and_shifted,
    wheel_of, wheel_radius,
};
use crate::error::{Error, Result, in_order};
use crate::files::read_bytes;
use crate::lofted::{Flat, Loft, LoftSlice, LoftedWheel};
use crate::measured::{self, Measured, SliceList, listed_body};
use crate::profile::{Profile, Side, trace};

/// A wheel, which may vary around its axle.
pub(super) struct WheelBody {
    /// Its profile; of a list of slices, the section that is lowest at the pitch, or the first one without a pitch.
    pub resolved: Resolved,
    /// Nominal rolling radius \[mm\].
    pub radius: f64,
    /// Its surface where it varies.
    pub varying: Option<LoftedWheel>,
}

/// Makes the wheel of one side; `key` is its place in the scene. A list of slices gives the section that is lowest at a pitch \[rad\], or
/// without a pitch the one where the surface begins.
///
/// # Errors
/// Anything that is wrong with its profile, its list, its flat or its radii.
pub(super) fn wheel(
    scene: &Scene,
    (data, key): (&ProfileData, &str),
    pitch: Option<f64>,
    sources: SceneSources<'_>,
) -> Result<WheelBody> {
    if let Some(list) = list_of(data, Side::Wheel) {
        let radius = wheel_radius(scene, data, key)?;
        let within = |error: Error| error.within(key);
        let wheel = wheel_of_slices(data, &sources.0.join(list), radius).map_err(within)?;
        let mut profile = wheel.lowest(pitch).map_err(within)?;
        let name = list.file_name().unwrap_or(list.as_os_str()).to_string_lossy();
        profile.name = match pitch {
            Some(_) => format!("{name}, {}", profile.name),
            // A march cuts another section at every pitch.
            None => name.into_owned(),
        };
        let resolved = Resolved { profile, measured: None };
        return Ok(WheelBody { resolved, radius, varying: Some(wheel) });
    }
    let plain = ProfileData { flat: None, radii: None, ..data.clone() };
    let (resolved, radius) = wheel_of(scene, &plain, key, sources)?;
    let varying = varying(data, &resolved.profile, radius).map_err(|error| error.within(key))?;
    Ok(WheelBody { resolved, radius, varying })
}

/// Makes the wheel with the flat or the radii of these keys; `None` without either.
fn varying(data: &ProfileData, profile: &Profile, radius: f64) -> Result<Option<LoftedWheel>> {
    match (&data.flat, &data.radii) {
        (None, None) => Ok(None),
        (Some(flat), None) => {
            let flat = Flat { length: flat.length, angle: flat.angle, edge_radius: flat.edge_radius };
            LoftedWheel::with_flat(profile, radius, &flat).map(Some)
        }
        (None, Some(radii)) => LoftedWheel::out_of_round(profile, radius, radii).map(Some),
        (Some(_), Some(_)) => {
            let advice = "keep one, or give the flat as `radii`";
            Err(Error::new("", "`flat` and `radii`", "one of the two", advice))
        }
    }
}

/// Reads the slices of a list around a wheel, and joins them.
fn wheel_of_slices(data: &ProfileData, path: &Path, radius: f64) -> Result<LoftedWheel> {
    if data.flat.is_some() || data.radii.is_some() {
        let expected = "neither beside a list .slcw without `angle`, which has them in its slices";
        return Err(Error::new("", "`flat` or `radii`", expected, "remove them, or give `angle`"));
    }
    let (mut slices, doubts) = slices(data, path, Side::Wheel)?;
    for slice in &mut slices {
        // Arc lengths of a wheel's features count from the field side, and its profile from the flange.
        let curve = || trace(&slice.profile, 0.05).last().map_or(0.0, |mark| mark.s);
        let length = slice.measured_along.unwrap_or_else(curve);
        let from_left = |s: &f64| if *s < 0.0 { *s } else { (length - s).max(0.0) };
        slice.features = slice.features.iter().rev().map(from_left).collect();
    }
    let place = path.display().to_string();
    LoftedWheel::new(&slices, radius, data.surface.unwrap_or_default())
        .map(|wheel| wheel.with_warnings(doubts))
        .map_err(|error| error.within(place))
}

/// Gives the error for a wheel that varies on a rail that varies.
pub(super) fn both_vary(wheel_key: &str) -> Error {
    let advice = "give the wheel one profile, or the rail a section by `along`";
    Error::new(wheel_key, "a wheel that varies on a rail that varies", "one of the two", advice)
}

/// Returns the list of slices of a body that varies; `None` for one profile, or a section of a list.
pub(super) fn list_of(data: &ProfileData, side: Side) -> Option<&PathBuf> {
    let listed = |file: &&PathBuf| listed_body(&file.display().to_string()) == Some(side);
    data.file.as_ref().filter(listed).filter(|_| data.along.is_none() && data.angle.is_none())
}

/// Reads the slices of a list, whose files are relative to it, and joins them as a rail's keys say.
///
/// # Errors
/// An unreadable file; whatever is wrong with the list, a slice, or the surface.
pub fn loft(data: &ProfileData, path: &Path) -> Result<Loft> {
    let (slices, doubts) = slices(data, path, Side::Rail)?;
    let mut loft =
        Loft::new(&slices, data.surface.unwrap_or_default()).map_err(|error| error.within(path.display()))?;
    loft.warnings.extend(doubts);
    Ok(loft)
}

/// Reads the slices of a list of this body, and what is doubtful in it.
fn slices(data: &ProfileData, path: &Path, side: Side) -> Result<(Vec<LoftSlice>, Vec<String>)> {
    let place = path.display().to_string();
    let bytes = read_bytes(path, measured::LARGEST_FILE)?;
    let list = SliceList::read(&bytes, side).map_err(|error| error.within(&place))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let curves = list.slices.par_iter().map(|slice| {
        let curve = SliceCurve::read(data, &folder.join(&slice.file), side)?;
        Ok(SliceCurve { profile: turned_and_shifted(data, curve.profile)?, ..curve })
    });
    let curves = in_order(curves).map_err(|error| error.within(&place))?;
    if let Some(k) = (1..curves.len()).find(|&k| curves[k].scale != curves[0].scale) {
        let names = [0, k].map(|k| list.slices[k].file.as_str());
        let found =
            format!("scales {:?} of {} and {:?} of {}", curves[0].scale, names[0], curves[k].scale, names[1]);
        let error = Error::new("mirror", found, "slices turned alike", "give `mirror`, `flip_z` and `unit`");
        return Err(error.within(&place));
    }
    let doubtful: Vec<String> = list
        .slices
        .iter()
        .zip(&curves)
        .filter_map(|(slice, curve)| Some(format!("{}: {}", slice.file, curve.doubt.as_ref()?)))
        .collect();
    let mut doubts = Vec::new();
    if let Some(first) = doubtful.first() {
        let (some, all) = (doubtful.len(), list.slices.len());
        doubts.push(format!("{some} of {all} slices have doubtful points, the first {first}"));
    }
    if list.approximated {
        doubts.push("the list asks for an approximating spline; the surface goes through its slices".into());
    }
    let joined = list.slices.into_iter().zip(curves).map(|(slice, curve)| LoftSlice {
        at: slice.at,
        name: slice.file,
        profile: curve.profile,
        features: slice.features,
        measured_along: curve.polygon,
    });
    Ok((joined.collect(), doubts))
}

/// The curve of a slice.
struct SliceCurve {
    profile: Profile,
    /// Length of the polygon of measured points \[mm\].
    polygon: Option<f64>,
    /// Factors by which the file's axes were multiplied.
    scale: [f64; 2],
    /// The first finding about its points.
    doubt: Option<String>,
}

impl SliceCurve {
    fn read(data: &ProfileData, path: &Path, side: Side) -> Result<Self> {
        if data.format.is_none() && is_chain_file(path) {
            reject_measured_keys(data)?;
            let drawn = profile_from_file(path)?;
            let mirrored = data.mirror == Some(true);
            let (profile, sign) = if mirrored { (drawn.mirrored(), -1.0) } else { (drawn, 1.0) };
            return Ok(Self { profile, polygon: None, scale: [sign, 1.0], doubt: None });
        }
        let bytes = read_bytes(path, measured::LARGEST_FILE)?;
        let options = data.measured();
        let Measured { profile, points, record } =
            measured::profile(&path.display().to_string(), &bytes, side, &options)?;
        let steps = points.windows(2).map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].z - pair[0].z));
        let doubt = record.warnings.first().map(|finding| format!("{}: {}", finding.place, finding.found));
        Ok(Self { profile, polygon: Some(steps.sum()), scale: record.transform.scale, doubt })
    }
}
