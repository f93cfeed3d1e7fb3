//! Makes rail and wheel of both sides of a scene.

use std::path::Path;
use std::sync::Arc;

use super::data::Scene;
use super::profile_data::ProfileData;
use super::profiles::{Resolved, SceneSources, pair_of, rail_of};
use super::side_data::SideData;
use super::varying::{WheelBody, both_vary, list_of, loft, wheel};
use crate::case::{Profiles, SideProfiles};
use crate::error::{Error, Result};
use crate::lofted::{Loft, LoftedBody, section};
use crate::numerics::bodies::Bodies;
use crate::profile::{Profile, Side};

/// Returns the rails and the wheels of a scene, turned and shifted as the scene says. Files are relative to the folder; where one
/// side has a profile of its own, files that both sides share are opened once for each side.
///
/// # Errors
/// Anything that is wrong with a profile; the error names the key.
pub(super) fn profiles(scene: &Scene, sources: SceneSources<'_>) -> Result<Profiles> {
    let both = || of_side(scene, [&scene.rail, &scene.wheel], ["rail", "wheel"], sources);
    let own = |name: &str, side: &Option<SideData>| {
        let Some(SideData { rail, wheel, .. }) = side else { return Ok(None) };
        if rail.is_none() && wheel.is_none() {
            return Ok(None);
        }
        let places = [("rail", rail.is_some()), ("wheel", wheel.is_some())]
            .map(|(body, own)| if own { format!("{name}: {body}") } else { body.into() });
        let data = [rail.as_ref().unwrap_or(&scene.rail), wheel.as_ref().unwrap_or(&scene.wheel)];
        let places = places.each_ref().map(String::as_str);
        of_side(scene, data, places, sources).map(Some)
    };
    let (right, left) = (own("right", &scene.right)?, own("left", &scene.left)?);
    match (right, left) {
        (Some(right), Some(left)) => Ok(Profiles { right, left: Some(left) }),
        (Some(right), None) => Ok(Profiles { right, left: Some(both()?) }),
        (None, left) => Ok(Profiles { right: both()?, left }),
    }
}

/// Gives rail and wheel of one side of a scene; `places` are their keys.
fn of_side(
    scene: &Scene,
    data: [&ProfileData; 2],
    places: [&str; 2],
    sources: SceneSources<'_>,
) -> Result<SideProfiles> {
    let loft = varying(scene, data[0], places[0], sources.0)?;
    let rail = match &loft {
        Some((section, _)) => Resolved { profile: section.clone(), measured: None },
        None => rail_of(data[0], places[0], sources)?,
    };
    let WheelBody { resolved, radius, varying } =
        wheel(scene, (data[1], places[1]), Some(scene.pitch()?), sources)?;
    let varying = match (loft, varying) {
        (Some(_), Some(_)) => return Err(both_vary(places[1])),
        (Some((_, loft)), None) => Some(LoftedBody::Rail(loft)),
        (None, wheel) => wheel.map(|wheel| LoftedBody::Wheel(Arc::new(wheel))),
    };
    if let Some(body) = varying.as_ref().filter(|_| scene.roller.is_some()) {
        let expected = format!("no roller with {}", LoftedBody::name(body.side()));
        return Err(Error::new("roller", "one", expected, "remove it"));
    }
    let pair = pair_of(scene, rail.profile, resolved.profile, radius)?;
    let measured = Bodies { rail: rail.measured, wheel: resolved.measured };
    Ok(SideProfiles { pair, measured, varying })
}

/// Makes the surface of a rail that is a list of slices without a place of its own, with its section where the wheel or the wheelset
/// stands; `None` of any other rail, and where the scene gives no `along`.
fn varying(
    scene: &Scene,
    data: &ProfileData,
    place: &str,
    folder: &Path,
) -> Result<Option<(Profile, Arc<Loft>)>> {
    let Some((list, along)) = list_of(data, Side::Rail).zip(scene.along()?) else { return Ok(None) };
    let loft = loft(data, &folder.join(list)).map_err(|error| error.within(place))?;
    let Some(strip) = loft.widest(along) else {
        let [from, to] = loft.reach().ends();
        let expected = format!("a place from {from} to {to} mm, where the slices join to a surface");
        let place = if scene.wheelset.is_some() { "wheelset: along" } else { "contact: along" };
        return Err(Error::new(place, format!("{along:?} mm"), expected, "choose another place"));
    };
    let name = list.file_name().unwrap_or(list.as_os_str()).to_string_lossy();
    let mut section = section(&loft, strip, along)?;
    section.name = format!("{name}, {}", section.name);
    Ok(Some((section, Arc::new(loft))))
}
