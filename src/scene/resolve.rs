//! Scene → domain: profiles, axes, approach.

use nalgebra::UnitComplex;

use std::path::Path;

use super::data::{AxisData, ProfileData, Rotation, Scene, Spacing};
use super::read::{nearest, parse};
use crate::error::{Error, Result, finite, given};
use crate::files::{read_bytes, read_text};
use crate::load::hertz::Elastic;
use crate::measured::{self, Measured, Options, Record};
use crate::mesh::axes::MOST_ON_AXIS;
use crate::placement::Pair;
use crate::profile::drawing::{SegmentData, chain};
use crate::profile::{Profile, Side, inclination, standards};

/// A profile file: the same keys as inline.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct ProfileFile {
    #[serde(default)]
    name: Option<String>,
    #[serde(default)]
    source: Option<String>,
    #[serde(default)]
    start: Option<[f64; 2]>,
    segments: Vec<SegmentData>,
}

/// Largest ξ and η \[mm\]: a thousand kilometres, whose squares are far from overflowing.
const FARTHEST: f64 = 1e9;

/// Smallest approach and extent of a grid other than 0 \[mm\]: below any length, and its powers do not underflow.
const SMALLEST: f64 = 1e-60;

impl Scene {
    /// The rail and wheel of the scene, turned and shifted as it says; files are relative to `folder`.
    ///
    /// # Errors
    /// Whatever is wrong with a profile, by key.
    pub fn pair(&self, folder: &Path) -> Result<Pair> {
        self.pair_and_records(folder).map(|(pair, _)| pair)
    }

    /// The same, with what was done to measured profiles of rail and wheel.
    ///
    /// # Errors
    /// Those of [`Scene::pair`].
    pub fn pair_and_records(&self, folder: &Path) -> Result<(Pair, [Option<Record>; 2])> {
        let rail = self.rail.resolve(folder, Side::Rail).map_err(|e| e.within("rail"))?;
        if let Some(radius) = self.rail.radius {
            let expected = "a radius only for the wheel";
            return Err(Error::new("rail: radius", radius.to_string(), expected, "remove it"));
        }
        let wheel = self.wheel.resolve(folder, Side::Wheel).map_err(|e| e.within("wheel"))?;
        let radius = self.wheel.radius.ok_or_else(|| {
            Error::new("wheel", "no `radius`", "the nominal rolling radius in mm", "add it")
        })?;
        if radius > FARTHEST {
            let expected = format!("at most {FARTHEST:e} mm");
            return Err(Error::new(
                "wheel: radius",
                format!("{radius:e}"),
                expected,
                "take a plane for a rail",
            ));
        }
        Ok((Pair::new(rail.profile, wheel.profile, radius)?, [rail.measured, wheel.measured]))
    }

    /// Checks `[patch]`.
    ///
    /// # Errors
    /// Both or neither of `approach` and `load`; a negative or non-finite value.
    pub fn check_patch(&self) -> Result<()> {
        let Some(patch) = &self.patch else { return Ok(()) };
        let expected = "exactly one of `approach` and `load`";
        let (key, value) = match (patch.approach, patch.load) {
            (Some(approach), None) => ("patch: approach", approach),
            (None, Some(load)) => ("patch: load", load),
            (Some(_), Some(_)) => return Err(Error::new("patch", "both", expected, "remove one")),
            (None, None) => return Err(Error::new("patch", "neither", expected, "give one")),
        };
        if finite(key, value)? < 0.0 {
            return Err(Error::new(key, value.to_string(), "a value ≥ 0", "correct the sign"));
        }
        if value > 0.0 && value < SMALLEST {
            let expected = format!("0, or at least {SMALLEST:e}");
            return Err(Error::new(key, format!("{value:e}"), expected, "check the unit"));
        }
        Ok(())
    }

    /// Elastic constants of rail and wheel.
    ///
    /// # Errors
    /// A modulus that is not positive, a Poisson's ratio outside (−1, 0.5\].
    pub fn elastic(&self) -> Result<[Elastic; 2]> {
        let material = &self.material;
        let body = |name: &str, youngs_modulus: f64, poissons_ratio: f64| {
            let place = |key: &str| format!("material: {name}_{key}");
            if !(youngs_modulus > 0.0 && youngs_modulus.is_finite()) {
                let (place, found) = (place("youngs_modulus"), youngs_modulus.to_string());
                return Err(Error::new(place, found, "a positive modulus in N/mm²", "steel has 2.1e5"));
            }
            if !(poissons_ratio > -1.0 && poissons_ratio <= 0.5) {
                let (place, found) = (place("poissons_ratio"), poissons_ratio.to_string());
                return Err(Error::new(place, found, "a ratio in (-1, 0.5]", "steel has 0.28"));
            }
            Ok(Elastic { youngs_modulus, poissons_ratio })
        };
        Ok([
            body("rail", material.rail_youngs_modulus, material.rail_poissons_ratio)?,
            body("wheel", material.wheel_youngs_modulus, material.wheel_poissons_ratio)?,
        ])
    }

    /// The tolerance on s \[mm\].
    ///
    /// # Errors
    /// Not a positive number.
    pub fn tolerance(&self) -> Result<f64> {
        let tolerance = self.grid.tolerance;
        if tolerance > 0.0 && tolerance.is_finite() {
            return Ok(tolerance);
        }
        let expected = "a positive length in mm";
        Err(Error::new("grid: tolerance", tolerance.to_string(), expected, "1e-12 gives all digits"))
    }

    /// The explicit values of an axis, or `None` for "auto".
    ///
    /// # Errors
    /// Values that are not finite, not ascending or too many.
    pub fn axis(&self, name: &str) -> Result<Option<Vec<f64>>> {
        let axis = if name == "xi" { &self.grid.xi } else { &self.grid.eta };
        let place = format!("grid: {name}");
        let values = match axis {
            AxisData::Word(_) => return Ok(None),
            AxisData::Values(list) => {
                check_length(&place, list.values.len() as f64)?;
                list.values.clone()
            }
            AxisData::Steps(steps) => {
                let (from, to) = (finite(&place, steps.from)?, finite(&place, steps.to)?);
                if from >= to || steps.n < 2 {
                    let found = format!("from {from} to {to} with n = {}", steps.n);
                    return Err(Error::new(place, found, "from < to and n ≥ 2", "correct the axis"));
                }
                check_length(&place, steps.n as f64)?;
                equal_steps(from, to, steps.n as usize)
            }
        };
        let expected = "at least one value, each larger than the one before";
        if values.is_empty() {
            return Err(Error::new(place, "no values", expected, "give some, or \"auto\""));
        }
        if let Some(pair) = values.windows(2).find(|pair| pair[0] >= pair[1]) {
            let found = format!("{} after {}", pair[1], pair[0]);
            return Err(Error::new(place, found, expected, "sort the values"));
        }
        for &value in &values {
            if finite(&place, value)?.abs() > FARTHEST {
                let expected = format!("values within ±{FARTHEST:e} mm");
                return Err(Error::new(place, format!("{value:e}"), expected, "check the unit"));
            }
        }
        let extent = values[values.len() - 1] - values[0];
        if values.len() > 1 && extent < SMALLEST {
            let expected = format!("values that are at least {SMALLEST:e} mm apart");
            return Err(Error::new(place, format!("an extent of {extent:e} mm"), expected, "check the unit"));
        }
        Ok(Some(values))
    }

    /// Distance below which parts of the patch share a grid \[mm\]; 0, which merges none, without the key.
    ///
    /// # Errors
    /// A negative distance.
    pub fn merge(&self) -> Result<f64> {
        let merge = finite("grid: merge", self.grid.merge.unwrap_or(0.0))?;
        if merge < 0.0 {
            let expected = "a distance of 0 mm or more";
            return Err(Error::new("grid: merge", merge.to_string(), expected, "correct the sign"));
        }
        Ok(merge)
    }

    /// \[Δξ, Δη\] of automatic axes.
    ///
    /// # Errors
    /// A step that is not positive.
    pub fn spacing(&self) -> Result<Option<[f64; 2]>> {
        let Some(spacing) = self.grid.spacing else { return Ok(None) };
        let steps = match spacing {
            Spacing::Both(step) => [step; 2],
            Spacing::Each(steps) => steps,
        };
        for step in steps {
            if finite("grid: spacing", step)? <= 0.0 {
                return Err(Error::new(
                    "grid: spacing",
                    step.to_string(),
                    "a positive step in mm",
                    "correct it",
                ));
            }
        }
        Ok(Some(steps))
    }
}

fn check_length(place: &str, values: f64) -> Result<()> {
    if values <= MOST_ON_AXIS {
        return Ok(());
    }
    let expected = format!("at most {MOST_ON_AXIS:e} values");
    Err(Error::new(place, format!("{values:e} values"), expected, "take fewer, or a smaller window"))
}

/// n values from a to b, symmetric to the last bit where a = −b.
pub fn equal_steps(a: f64, b: f64, n: usize) -> Vec<f64> {
    let last = n as f64 - 1.0;
    (0..n).map(|k| (a * (last - k as f64) + b * k as f64) / last).collect()
}

impl ProfileData {
    /// The profile as placed by the scene, and what was done to a measured one.
    fn resolve(&self, folder: &Path, side: Side) -> Result<Resolved> {
        let Resolved { mut profile, measured } = match (&self.profile, &self.file, &self.segments) {
            (Some(name), None, None) => Resolved::drawn(built_in(name, side)?),
            (None, Some(file), None) => self.in_file(&folder.join(file), side)?,
            (None, None, Some(segments)) => Resolved::drawn(chain("inline", "scene", self.start, segments)?),
            _ => {
                let expected = "exactly one of `profile`, `file`, `segments`";
                let found = given(&[
                    ("profile", self.profile.is_some()),
                    ("file", self.file.is_some()),
                    ("segments", self.segments.is_some()),
                ]);
                return Err(Error::new("", found, expected, "give one source"));
            }
        };
        if let (Some([x, z]), None) = (self.start, &self.segments) {
            let expected = "`start` only with `segments`";
            return Err(Error::new("start", format!("[{x}, {z}]"), expected, "remove it"));
        }
        if measured.is_none() {
            self.reject_measured_keys()?;
            if self.mirror == Some(true) {
                profile = profile.mirrored();
            }
        }
        if let Some(rotation) = &self.rotate {
            if self.already_inclined {
                let expected = "no `rotate` for a profile that is `already_inclined`";
                return Err(Error::new("rotate", rotation.to_string(), expected, "remove one of the two"));
            }
            profile = profile.rotated(rotation.turn().map_err(|e| e.within("rotate"))?);
        }
        if let Some([x, z]) = self.shift {
            profile = profile.shifted(finite("shift", x)?, finite("shift", z)?);
        }
        Ok(Resolved { profile, measured })
    }

    fn in_file(&self, path: &Path, side: Side) -> Result<Resolved> {
        if self.format.is_none() && is_chain_file(path) {
            return profile_from_file(path).map(Resolved::drawn);
        }
        let place = path.display().to_string();
        let bytes = read_bytes(path, measured::LARGEST_FILE)?;
        let Measured { profile, record, .. } = measured::profile(&place, &bytes, side, &self.measured())?;
        Ok(Resolved { profile, measured: Some(record) })
    }

    /// Keys that mean nothing for a drawn profile are mistakes.
    fn reject_measured_keys(&self) -> Result<()> {
        let keys = Options { mirror: None, ..self.measured() }.given();
        if keys.is_empty() {
            return Ok(());
        }
        let expected = "keys of measured files only beside a measured `file`";
        let found = format!("`{}`", keys.join("`, `"));
        Err(Error::new("", found, expected, "remove it, or give `file` and `format`"))
    }
}

/// A profile, and the record of a measured one.
struct Resolved {
    profile: Profile,
    measured: Option<Record>,
}

impl Resolved {
    fn drawn(profile: Profile) -> Self {
        Self { profile, measured: None }
    }
}

/// A profile of the right body by name.
fn built_in(name: &str, side: Side) -> Result<Profile> {
    let (of_other, own, other) = match side {
        Side::Rail => (standards::wheel_names().any(|known| known == name), "rail", "wheel"),
        Side::Wheel => (standards::rail_names().any(|known| known == name), "wheel", "rail"),
    };
    if of_other {
        let (found, expected) = (format!("\"{name}\", a {other}"), format!("a {own} profile"));
        return Err(Error::new("profile", found, expected, "see `wheelrail profile list`"));
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

/// Whether a file's extension is that of a chain of segments.
pub fn is_chain_file(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml") || e.eq_ignore_ascii_case("json"))
}

impl std::fmt::Display for Rotation {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Radians(angle) => write!(f, "{angle}"),
            Self::Ratio(text) => write!(f, "\"{text}\""),
        }
    }
}

impl Rotation {
    /// The rotation that is written.
    fn turn(&self) -> Result<UnitComplex<f64>> {
        let bad = |found: String| Error::new("", found, "rad, or \"1:n\" with n ≠ 0", "correct it");
        match self {
            Self::Radians(angle) => Ok(UnitComplex::new(finite("", *angle)?)),
            Self::Ratio(text) => {
                let (one, n) = text.split_once(':').ok_or_else(|| bad(format!("\"{text}\"")))?;
                let number = |s: &str| s.trim().parse::<f64>().ok().filter(|v| v.is_finite());
                match (number(one), number(n)) {
                    (Some(rise), Some(run)) if run != 0.0 => inclination(rise, run),
                    _ => Err(bad(format!("\"{text}\""))),
                }
            }
        }
    }
}

/// A profile file with `segments` and perhaps `name`, `source`, `start`.
///
/// # Errors
/// An unreadable file; whatever is wrong with its segments.
pub fn profile_from_file(path: &Path) -> Result<Profile> {
    let place = path.display().to_string();
    let text = read_text(path, measured::LARGEST_FILE)?;
    let json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let file: ProfileFile = parse(&text, json).map_err(|e| e.within(&place))?;
    let name = file.name.unwrap_or_else(|| place.clone());
    let source = file.source.unwrap_or_else(|| place.clone());
    chain(&name, &source, file.start, &file.segments).map_err(|e| e.within(&place))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The complaint about a scene of these tables.
    fn complaint(rail: &str, rest: &str) -> Result<String> {
        let text = format!("[rail]\n{rail}\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n{rest}");
        let scene: Scene = parse(&text, false)?;
        let found = scene.pair(Path::new(".")).err().or(scene.standing().err()).or(scene.axis("xi").err());
        Ok(found.map(|e| e.to_string()).unwrap_or_default())
    }

    #[test]
    fn complaints_say_what_was_found() -> Result<()> {
        let rails = [
            ("profile = \"60e1\"", "perhaps `60E1` is meant"),
            ("profile = \"S1002\"", "rail: profile: found \"S1002\", a wheel; expected a rail profile;"),
            (
                "profile = \"60E1\"\nunit = \"m\"\nrepair = [\"sort\"]",
                "rail: found `unit`, `repair`; expected",
            ),
            (
                "profile = \"60E1\"\nfile = \"x.ban\"",
                "rail: found `profile` and `file`; expected exactly one",
            ),
            ("", "rail: found none of `profile`, `file`, `segments`; expected exactly one"),
            ("profile = \"60E1\"\nstart = [1, 2]", "rail: start: found [1, 2]; expected"),
            ("file = \"none.toml\"", "none.toml: found no such file; expected a readable file"),
            ("file = \"none.ban\"", "none.ban: found no such file; expected a readable file"),
        ];
        for (rail, message) in rails {
            let found = complaint(rail, "[contact]\noffset = 0.0\n")?;
            assert!(found.contains(message), "{rail}: {found}");
        }
        let rests = [
            ("[track]\ngauge = 1435.0", "found `track` alone; expected either [contact]"),
            ("[contact]\nrail_x = 1.0\nyaw = 0.1", "contact: found `rail_x` and `yaw`; expected either"),
            (
                "[track]\n[wheelset]\nspacing = 1500.0",
                "track: found none of `gauge`, `gauge_height`, `spacing`;",
            ),
            (
                "[track]\ngauge = 1435.0\n[wheelset]\nspacing = 1.0\nback_to_back = 2.0",
                "wheelset: found `back_to_back` and",
            ),
            (
                "[contact]\noffset = 0.0\n[grid]\nxi = { values = [1.0, 5.0, 3.0] }",
                "grid: xi: found 3 after 5;",
            ),
            ("[contact]\noffset = 0.0\n[grid]\nxi = { values = [] }", "grid: xi: found no values;"),
        ];
        for (rest, message) in rests {
            let found = complaint("profile = \"60E1\"", rest)?;
            assert!(found.contains(message), "{rest}: {found}");
        }
        Ok(())
    }
}
