//! Makes the march of a scene: a wheelset on rails that vary along the track.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;

use super::data::Scene;
use super::doubts::of_keys;
use super::profile_data::ProfileData;
use super::profiles::{
    Given, is_chain_file, profile_from_file, rail_of, reject_measured_keys, turned_and_shifted, wheel_of,
};
use super::standing::{position, rails, wheels, within};
use crate::case::usual;
use crate::error::{Error, Result};
use crate::files::read_bytes;
use crate::lofted::{Loft, Slice};
use crate::measured::{self, Measured, SliceList, listed_body};
use crate::placement::{Pair, RailDistance, Track, WheelDistance, Wheelset};
use crate::profile::{Profile, Side};
use crate::search::{LoftedPair, March, ONE_CONTACT, Selection, SideOnTrack, WheelsetOnTrack};

/// Resolves a scene into a march over its rails, at least one of which is a list of slices without `along`. Paths in the scene are
/// relative to `folder`. Also returns what the lists leave undefined.
///
/// # Errors
/// Anything that is wrong; the error names the key.
pub fn march(scene: &Scene, folder: &Path) -> Result<(March, Vec<String>)> {
    let (Some(track), Some(wheelset)) = (&scene.track, &scene.wheelset) else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new("", "a single wheel", expected, "a march moves a wheelset along its track"));
    };
    if scene.roller.is_some() {
        return Err(Error::new("roller", "rollers", "rails that vary along the track", "remove [roller]"));
    }
    let (position, within) = (position(wheelset)?, within(wheelset.within)?);
    let sides = Sides { scene, folder, rails: rails(track)?, wheels: wheels(wheelset)? };
    let warnings = of_keys(scene).iter().map(ToString::to_string).collect();
    let mut lists = Lists { reach: [f64::NEG_INFINITY, f64::INFINITY], warnings };
    let right = sides.side(true, &mut lists)?;
    let system = if scene.left.is_none() && scene.right.is_none() {
        WheelsetOnTrack::symmetrical(right)
    } else {
        WheelsetOnTrack::of_sides(sides.side(false, &mut lists)?, right)
    };
    let [from, to] = lists.reach;
    if from == f64::NEG_INFINITY {
        let expected = "a rail that varies: a list .slcs of slices without `along`";
        return Err(Error::new("rail", "rails of one profile each", expected, "or take `wheelrail sweep`"));
    }
    if from >= to {
        let found = "rails whose lists have no place in common";
        return Err(Error::new("rail", found, "lists that overlap along the track", "correct the offsets"));
    }
    let selection = Selection { within, apart: ONE_CONTACT };
    Ok((March { system, position, selection, reach: lists.reach }, lists.warnings))
}

/// What both sides are made of.
struct Sides<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    rails: RailDistance,
    wheels: WheelDistance,
}

impl Sides<'_> {
    /// Makes one side, whose rail is a list of slices or one profile.
    fn side(&self, right: bool, lists: &mut Lists) -> Result<SideOnTrack> {
        let Self { scene, folder, rails, wheels } = *self;
        let (name, own) = if right { ("right", &scene.right) } else { ("left", &scene.left) };
        let own = own.as_ref();
        let [rail, wheel] =
            [own.and_then(|side| side.rail.as_ref()), own.and_then(|side| side.wheel.as_ref())];
        let [rail_key, wheel_key] = [("rail", rail), ("wheel", wheel)]
            .map(|(body, own)| if own.is_some() { format!("{name}: {body}") } else { body.to_owned() });
        let (rail, given) = (rail.unwrap_or(&scene.rail), Given::new());
        let wheel = wheel.unwrap_or(&scene.wheel);
        let (wheel, radius) = wheel_of(scene, wheel, &wheel_key, (folder, &given))?;
        let axle = Wheelset::new(wheels, radius)?;
        let findings = wheel.measured.iter().flat_map(|record| &record.warnings);
        lists
            .warnings
            .extend(findings.map(|finding| format!("{wheel_key}: {}: {}", finding.place, finding.found)));
        lists
            .warnings
            .extend(usual::radius(&format!("{wheel_key}: radius"), radius).map(|doubt| doubt.to_string()));
        let deviation = own.and_then(|side| side.deviation).unwrap_or_default();
        if deviation.roll != 0.0 {
            let place = format!("{name}: deviation: roll");
            let expected = "lateral and vertical deviations of rails that are marched along";
            return Err(Error::new(place, "a roll", expected, "turn the profile by `rotate`"));
        }
        let sign = if right { 1.0 } else { -1.0 };
        let moved = |track: Track| track.moved(sign * deviation.lateral, deviation.vertical);
        let Some(list) = list_of(rail) else {
            let rail = rail_of(rail, &rail_key, (folder, &given))?.profile;
            let track = moved(Track::new(&rail, rails)?)?;
            return SideOnTrack::new(&Pair::new(rail, wheel.profile, radius)?, track, axle);
        };
        let RailDistance::Spacing(spacing) = rails else {
            let expected = "`spacing` of the profile origins: rails that vary have no one gauge point";
            return Err(Error::new("track", "a gauge", expected, "give spacing instead of gauge"));
        };
        let loft = loft(rail, &folder.join(list)).map_err(|error| error.within(&rail_key))?;
        lists.take(&loft, &rail_key);
        let pair = LoftedPair::new(Arc::new(loft), &wheel.profile, radius)?;
        Ok(SideOnTrack::lofted(Arc::new(pair), moved(Track::between_origins(spacing)?)?, axle))
    }
}

/// What the lists of both sides say.
struct Lists {
    reach: [f64; 2],
    warnings: Vec<String>,
}

impl Lists {
    fn take(&mut self, loft: &Loft, place: &str) {
        let [from, to] = loft.reach();
        self.reach = [self.reach[0].max(from), self.reach[1].min(to)];
        self.warnings.extend(loft.warnings.iter().map(|warning| format!("{place}: {warning}")));
    }
}

/// Returns the list of slices of a rail that varies; `None` for one profile, or a section of a list.
pub(super) fn list_of(data: &ProfileData) -> Option<&PathBuf> {
    let listed = |file: &&PathBuf| listed_body(&file.display().to_string()) == Some(Side::Rail);
    data.file.as_ref().filter(listed).filter(|_| data.along.is_none())
}

/// Reads the slices of a list, which are relative to it, and joins them as a rail's keys say.
///
/// # Errors
/// An unreadable file; whatever is wrong with the list, a slice, or the surface.
pub fn loft(data: &ProfileData, path: &Path) -> Result<Loft> {
    let place = path.display().to_string();
    let bytes = read_bytes(path, measured::LARGEST_FILE)?;
    let list = SliceList::read(&bytes, Side::Rail).map_err(|error| error.within(&place))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let curves = list.slices.par_iter().map(|slice| {
        let curve = Curve::read(data, &folder.join(&slice.file))?;
        Ok(Curve { profile: turned_and_shifted(data, curve.profile)?, ..curve })
    });
    let curves = curves.collect::<Result<Vec<_>>>().map_err(|error| error.within(&place))?;
    if let Some(k) = (1..curves.len()).find(|&k| curves[k].scale != curves[0].scale) {
        let names = [0, k].map(|k| list.slices[k].file.as_str());
        let found =
            format!("scales {:?} of {} and {:?} of {}", curves[0].scale, names[0], curves[k].scale, names[1]);
        let error = Error::new("mirror", found, "slices turned alike", "give `mirror`, `flip_z` and `unit`");
        return Err(error.within(&place));
    }
    let doubts: Vec<Option<String>> = curves.iter().map(|curve| curve.doubt.clone()).collect();
    let slices: Vec<Slice> = list
        .slices
        .into_iter()
        .zip(curves)
        .map(|(slice, curve)| Slice {
            at: slice.at,
            name: slice.file,
            profile: curve.profile,
            features: slice.features,
            measured_along: curve.polygon,
        })
        .collect();
    let mut loft =
        Loft::new(&slices, data.surface.unwrap_or_default()).map_err(|error| error.within(&place))?;
    let doubtful: Vec<String> = slices
        .iter()
        .zip(doubts)
        .filter_map(|(slice, doubt)| Some(format!("{}: {}", slice.name, doubt?)))
        .collect();
    if let Some(first) = doubtful.first() {
        loft.warnings.push(format!(
            "{} of {} slices have doubtful points, the first {first}",
            doubtful.len(),
            slices.len()
        ));
    }
    if list.approximated {
        loft.warnings
            .push("the list asks for an approximating spline; the surface goes through its slices".into());
    }
    Ok(loft)
}

/// The curve of a slice.
struct Curve {
    profile: Profile,
    /// Length of the polygon of measured points \[mm\].
    polygon: Option<f64>,
    /// By what the file's axes were multiplied.
    scale: [f64; 2],
    /// The first finding about its points.
    doubt: Option<String>,
}

impl Curve {
    fn read(data: &ProfileData, path: &Path) -> Result<Self> {
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
            measured::profile(&path.display().to_string(), &bytes, Side::Rail, &options)?;
        let steps = points.windows(2).map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].z - pair[0].z));
        let doubt = record.warnings.first().map(|finding| format!("{}: {}", finding.place, finding.found));
        Ok(Self { profile, polygon: Some(steps.sum()), scale: record.transform.scale, doubt })
    }
}
