//! Makes the profiles of `[rail]` and `[wheel]`: built in, inline or from files.

use std::collections::BTreeMap;
use std::path::Path;

use super::data::Scene;
use super::profile_data::ProfileData;
use super::read::parse;
use super::words::nearest;
use crate::error::{Error, Result, finite, given};
use crate::files::{read_bytes, read_text};
use crate::measured::{self, Measured, Options, Record, SectionOfList, SliceList, Unit};
use crate::placement::Pair;
use crate::profile::{Profile, SegmentData, Side, drawn_profile, standards};

/// Largest rolling radius \[mm\]: a thousand kilometres. Its square is far from overflowing.
const FARTHEST: f64 = 1e9;

/// A profile file: the keys of an inline profile, with a name and a source.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct ProfileFile {
    #[serde(default)]
    name: Option<String>,
    #[serde(default)]
    source: Option<String>,
    #[serde(default)]
    unit: Option<Unit>,
    #[serde(default)]
    start: Option<[f64; 2]>,
    segments: Vec<SegmentData>,
}

/// Makes the profile of segments that are in a unit, mm if none is given; `names` are its name and source.
fn in_unit(
    names: [&str; 2],
    unit: Option<Unit>,
    start: Option<[f64; 2]>,
    segments: &[SegmentData],
) -> Result<Profile> {
    let Some(unit) = unit.map(Unit::millimetres) else {
        return drawn_profile(names[0], names[1], start, segments);
    };
    let segments: Vec<SegmentData> = segments.iter().map(|segment| segment.in_millimetres(unit)).collect();
    drawn_profile(names[0], names[1], start.map(|start| start.map(|value| unit * value)), &segments)
}

/// Profiles that `profile` of a scene may name, before built-in ones of the same name; each with its body where that is known.
pub type Given = BTreeMap<String, (Option<Side>, Profile)>;

/// Where the profiles of a scene come from: its folder, and those that are given.
pub(super) type SceneSources<'a> = (&'a Path, &'a Given);

/// Joins a rail, or the roller of a scene that has one, and a wheel with its nominal rolling radius \[mm\].
///
/// # Errors
/// A radius without meaning; profiles that cannot be joined.
pub fn pair_of(scene: &Scene, rail: Profile, wheel: Profile, radius: f64) -> Result<Pair> {
    let on_rail = Pair::new(rail, wheel, near("wheel", radius)?)?;
    match &scene.roller {
        Some(roller) => on_rail.on_roller(near("roller", roller.radius)?),
        None => Ok(on_rail),
    }
}

/// Makes a profile, mirrored, turned and shifted as its keys say, and gives the record of a measured one. Files are relative to `folder`.
///
/// # Errors
/// Anything that is wrong with the profile, or with its keys.
pub fn profile_of(data: &ProfileData, folder: &Path, side: Side) -> Result<(Profile, Option<Record>)> {
    let Resolved { profile, measured } = profile(data, (folder, &Given::new()), side)?;
    Ok((profile, measured))
}

/// Gives the profile of a rail; `place` is its key.
pub(super) fn rail_of(data: &ProfileData, place: &str, sources: SceneSources<'_>) -> Result<Resolved> {
    let rail = profile(data, sources, Side::Rail).map_err(|e| e.within(place))?;
    if let Some(radius) = data.radius {
        let expected = "a radius only for the wheel";
        return Err(Error::new(format!("{place}: radius"), radius.to_string(), expected, "remove it"));
    }
    Ok(rail)
}

/// Gives the profile of a wheel and its nominal rolling radius \[mm\]; `place` is its key.
pub(super) fn wheel_of(
    scene: &Scene,
    data: &ProfileData,
    place: &str,
    sources: SceneSources<'_>,
) -> Result<(Resolved, f64)> {
    let wheel = profile(data, sources, Side::Wheel).map_err(|e| e.within(place))?;
    Ok((wheel, wheel_radius(scene, data, place)?))
}

/// Gives the nominal rolling radius of a wheel \[mm\]: its own, or else that of `[wheel]`.
pub(super) fn wheel_radius(scene: &Scene, data: &ProfileData, place: &str) -> Result<f64> {
    let radius = data.radius.or(scene.wheel.radius);
    let radius = radius
        .ok_or_else(|| Error::new(place, "no `radius`", "the nominal rolling radius in mm", "add it"))?;
    near(place, radius)
}

/// Returns the radius of a body \[mm\] if its square is far from overflowing.
///
/// # Errors
/// A radius beyond a thousand kilometres; the error names the key `radius` of `place`.
pub fn near(place: &str, radius: f64) -> Result<f64> {
    if radius > FARTHEST {
        let (found, expected) = (format!("{radius:e}"), format!("at most {FARTHEST:e} mm"));
        return Err(Error::new(format!("{place}: radius"), found, expected, "take a plane for a rail"));
    }
    Ok(radius)
}

/// Returns a profile, mirrored, turned and shifted as its keys say, and the record of a measured one.
fn profile(data: &ProfileData, (folder, given_ones): SceneSources<'_>, side: Side) -> Result<Resolved> {
    let Resolved { mut profile, measured } = match (&data.profile, &data.file, &data.segments) {
        (Some(name), None, None) => Resolved::drawn(named(name, given_ones, side)?),
        (None, Some(file), None) => in_file(data, &folder.join(file), side)?,
        (None, None, Some(segments)) => {
            Resolved::drawn(in_unit(["inline", "scene"], data.unit, data.start, segments)?)
        }
        _ => {
            let expected = "exactly one of `profile`, `file`, `segments`";
            let found = given(&[
                ("profile", data.profile.is_some()),
                ("file", data.file.is_some()),
                ("segments", data.segments.is_some()),
            ]);
            return Err(Error::new("", found, expected, "give one source"));
        }
    };
    reject_varying_keys(data)?;
    if let (Some([x, z]), None) = (data.start, &data.segments) {
        let expected = "`start` only with `segments`";
        return Err(Error::new("start", format!("[{x}, {z}]"), expected, "remove it"));
    }
    if measured.is_none() {
        reject_measured_keys(data)?;
        if data.mirror == Some(true) {
            profile = profile.mirrored();
        }
    }
    Ok(Resolved { profile: turned_and_shifted(data, profile)?, measured })
}

/// Refuses keys of bodies that vary for one that does not.
fn reject_varying_keys(data: &ProfileData) -> Result<()> {
    let lists = "`surface` for a list .slcs without `along`, or one .slcw without `angle`";
    let wheels = "a wheel that varies around its axle in a scene for `wheelrail run`, `check` or `march`";
    let keys = [
        ("surface", data.surface.is_some(), lists),
        ("flat", data.flat.is_some(), wheels),
        ("radii", data.radii.is_some(), wheels),
    ];
    match keys.into_iter().find(|(_, given, _)| *given) {
        Some((key, _, expected)) => Err(Error::new(key, "an option without effect", expected, "remove it")),
        None => Ok(()),
    }
}

/// Turns a profile by `rotate`, then shifts it by `shift`.
pub(super) fn turned_and_shifted(data: &ProfileData, mut profile: Profile) -> Result<Profile> {
    if let Some(rotation) = &data.rotate {
        if data.already_inclined {
            let expected = "no `rotate` for a profile that is `already_inclined`";
            return Err(Error::new("rotate", rotation.to_string(), expected, "remove one of the two"));
        }
        profile = profile.rotated(rotation.turn().map_err(|e| e.within("rotate"))?);
    }
    if let Some([x, z]) = data.shift {
        profile = profile.shifted(finite("shift", x)?, finite("shift", z)?);
    }
    Ok(profile)
}

fn in_file(data: &ProfileData, path: &Path, side: Side) -> Result<Resolved> {
    if data.format.is_none() && is_chain_file(path) {
        return profile_from_file(path).map(Resolved::drawn);
    }
    let Measured { profile, record, .. } = measured_file(path, Some(side), &data.measured())?;
    Ok(Resolved { profile, measured: Some(record) })
}

/// A profile, and how it came to be.
#[derive(Debug, Clone)]
pub enum ProfileSource {
    /// Built in, or a file of segments.
    Drawn(Profile),
    /// A file of points.
    Measured(Box<Measured>),
}

impl ProfileSource {
    /// Gives the profile.
    pub fn profile(&self) -> &Profile {
        match self {
            Self::Drawn(profile) => profile,
            Self::Measured(measured) => &measured.profile,
        }
    }
}

/// Reads a profile from a file of any kind: segments in TOML or JSON, unless the options name a format, or measured points.
/// `side` is the body that it is of; not needed where the file says so, and ignored for segments.
///
/// Cost: that of [`measured::profile`].
///
/// # Errors
/// An unreadable file, and whatever is wrong with it; a measured file that does not say which body it is of; options for
/// a file of segments.
pub fn read_profile(path: &Path, side: Option<Side>, options: &Options) -> Result<ProfileSource> {
    if options.format.is_some() || !is_chain_file(path) {
        return measured_file(path, side, options)
            .map(|measured| ProfileSource::Measured(Box::new(measured)));
    }
    let given = options.given();
    if !given.is_empty() {
        let found = format!("`{}` for a drawn profile", given.join("`, `"));
        let expected = "options of measured files for a file of measured points only";
        let place = path.display().to_string();
        return Err(Error::new(place, found, expected, "remove them, or give another file"));
    }
    profile_from_file(path).map(ProfileSource::Drawn)
}

fn measured_file(path: &Path, side: Option<Side>, options: &Options) -> Result<Measured> {
    let place = path.display().to_string();
    if let Some(listed) = measured::listed_body(&place) {
        return section_from_files(path, side.unwrap_or(listed), options);
    }
    let bytes = read_bytes(path, measured::LARGEST_FILE)?;
    let Some(known) = side.map_or_else(|| measured::body(&place, &bytes, options), |side| Ok(Some(side)))?
    else {
        let expected = "the body that a measured file is of, where it does not say so";
        return Err(Error::new(place, "no side", expected, "name the body by `side`, rail or wheel"));
    };
    measured::profile(&place, &bytes, known, options)
}

/// Reads a list of slices, `.slcs` or `.slcw`, and cuts the section that the options name. The slices' files are relative
/// to the list; those beside the section are opened, each once.
///
/// # Errors
/// A list of the other body; an unreadable file; whatever is wrong with the list, the place or a slice.
pub fn section_from_files(path: &Path, side: Side, options: &Options) -> Result<Measured> {
    let place = path.display().to_string();
    if measured::listed_body(&place).is_some_and(|listed| listed != side) {
        let [found, expected] = match side {
            Side::Rail => ["slices of a wheel", "slices of a rail, in a file .slcs"],
            Side::Wheel => ["slices of a rail", "slices of a wheel, in a file .slcw"],
        };
        return Err(Error::new(place, found, expected, "give the other file"));
    }
    let bytes = read_bytes(path, measured::LARGEST_FILE)?;
    let list = SliceList::read(&bytes, side).map_err(|error| error.within(&place))?;
    let cut = SectionOfList::new(&list, options).map_err(|error| error.within(&place))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let slice = |name| Ok((name, read_bytes(&folder.join(name), measured::LARGEST_FILE)?));
    let contents: Vec<(&str, Vec<u8>)> =
        cut.files().into_iter().map(slice).collect::<Result<_>>().map_err(|error| error.within(&place))?;
    measured::section(&place, &cut, &contents, side, options)
}

/// Refuses keys that mean nothing for a drawn profile.
pub(super) fn reject_measured_keys(data: &ProfileData) -> Result<()> {
    let unit = data.unit.filter(|_| data.segments.is_none());
    let keys = Options { mirror: None, unit, ..data.measured() }.given();
    if keys.is_empty() {
        return Ok(());
    }
    let expected = "keys of measured files only beside a measured `file`";
    let found = format!("`{}`", keys.join("`, `"));
    Err(Error::new("", found, expected, "remove it, or give `file` and `format`"))
}

/// A profile, and the record of a measured one.
pub(super) struct Resolved {
    pub profile: Profile,
    pub measured: Option<Record>,
}

impl Resolved {
    fn drawn(profile: Profile) -> Self {
        Self { profile, measured: None }
    }
}

/// Returns the given or built-in profile with this name, which must be of the right body.
fn named(name: &str, given: &Given, side: Side) -> Result<Profile> {
    let own = given.get(name);
    let (of_other, body, other) = match side {
        Side::Rail => (standards::wheel_names().any(|known| known == name), "rail", "wheel"),
        Side::Wheel => (standards::rail_names().any(|known| known == name), "wheel", "rail"),
    };
    if own.map_or(of_other, |(own, _)| own.is_some_and(|own| own != side)) {
        let (found, expected) = (format!("\"{name}\", a {other}"), format!("a {body} profile"));
        return Err(Error::new("profile", found, expected, "see `wheelrail profile list`"));
    }
    if let Some((_, profile)) = own {
        return Ok(profile.clone());
    }
    let (found, known) = match side {
        Side::Rail => (standards::rail(name), standards::rail_names().collect::<Vec<_>>()),
        Side::Wheel => (standards::wheel(name), standards::wheel_names().collect()),
    };
    found.map_err(|mut error| {
        error.advice = nearest(name, &known).unwrap_or(error.advice);
        error
    })
}

/// Tells whether a file's extension is that of a chain of segments: `.toml` or `.json`.
pub fn is_chain_file(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml") || e.eq_ignore_ascii_case("json"))
}

/// Reads a profile file: `segments`, and optionally `name`, `source`, `unit` and `start`.
///
/// # Errors
/// An unreadable file; anything that is wrong with its segments.
pub fn profile_from_file(path: &Path) -> Result<Profile> {
    let text = read_text(path, measured::LARGEST_FILE)?;
    let json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    profile_from_text(&path.display().to_string(), &text, json)
}

/// Makes a profile of the text of a profile file, TOML or JSON; messages call it `place`.
///
/// # Errors
/// Anything that is wrong with the text or its segments.
pub fn profile_from_text(place: &str, text: &str, json: bool) -> Result<Profile> {
    let made = parse(text, json).and_then(|file: ProfileFile| {
        let (name, source) = (file.name.as_deref(), file.source.as_deref());
        let names = [name.unwrap_or(place), source.unwrap_or(place)];
        in_unit(names, file.unit, file.start, &file.segments)
    });
    made.map_err(|error| error.within(place))
}
