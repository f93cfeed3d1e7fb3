//! Resolves a scene into a case: everything in the scene is checked, once.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::axes::asked_axes;
use super::data::{MaterialData, PatchData, Scene};
use super::doubts::doubts;
use super::motion::{friction, motion};
use super::profiles::Given;
use super::setup::setup;
use super::side_data::SideData;
use super::sides::profiles;
use crate::case::{
    ApproachBy, AskedPressure, Case, Echo, FrameOrigin, Friction, OutputFormat, Outputs, Profiles, Question,
};
use crate::conformal::Reference;
use crate::error::{Error, Result, finite};
use crate::load::{Elastic, effective_modulus};
use crate::lofted::LoftedBody;
use crate::mesh::checked_size;
use crate::numerics::bodies::Bodies;
use crate::placement::on_roller;

/// Smallest approach other than 0 \[mm\], and smallest load \[N\]. They are far below any real ones, and their powers do
/// not underflow.
const SMALLEST: f64 = 1e-60;

/// Largest approach \[mm\]. No rail is so high: bodies that sink so deep pass through each other.
const DEEPEST: f64 = 200.0;

/// Largest approach \[mm\] with a body that varies: deeper patches take tens of seconds and have no meaning.
const DEEPEST_IN_SLICES: f64 = 10.0;

/// Largest load \[N\]. It is far above any real one, and its powers do not overflow.
const HEAVIEST: f64 = 1e60;

/// Resolves a scene: reads its profiles, prepares the search and checks every value. Paths in the scene are relative to
/// `folder`. `name` is the title of a scene without a title.
///
/// Cost: each profile's file is read and fitted once, or once for each side where one side has a profile of its own. The case keeps
/// the profiles.
///
/// # Errors
/// Anything that is wrong; the error names the key. Loads, material, motion and grid are checked before profiles, and profiles before
/// placement.
pub fn resolve(scene: &Scene, folder: &Path, name: &str) -> Result<Case> {
    resolve_given(scene, folder, name, &Given::new())
}

/// Resolves a scene like [`resolve`], where `profile` may also name one of the `given` profiles.
///
/// # Errors
/// The errors of [`resolve`].
pub fn resolve_given(scene: &Scene, folder: &Path, name: &str, given: &Given) -> Result<Case> {
    case(scene, name, || profiles(scene, (folder, given)))
}

/// Resolves a scene over given profiles, which replace those of the scene. No file is opened.
///
/// # Errors
/// Anything that is wrong except for the profiles; the error names the key.
pub fn with_profiles(scene: &Scene, profiles: Profiles, name: &str) -> Result<Case> {
    case(scene, name, || Ok(profiles))
}

fn case(scene: &Scene, name: &str, profiles: impl FnOnce() -> Result<Profiles>) -> Result<Case> {
    let question = question(scene)?;
    if scene.roller.is_some() && question.motion.is_some() {
        return Err(on_roller());
    }
    let axes = asked_axes(&scene.grid)?;
    let (setup, profiles) = setup(scene, profiles()?)?;
    if let Some(side) = profiles.varying().next() {
        asked_of_varying(LoftedBody::name(side), &question)?;
    }
    let landmarks = profiles.landmarks();
    let (outputs, echo, doubts) = (outputs(scene)?, echo(scene, name), doubts(scene, &profiles, &landmarks));
    Ok(Case { profiles, setup, question, axes, outputs, echo, file: None, landmarks, doubts })
}

/// Refuses approaches above [`DEEPEST_IN_SLICES`] with a body that varies, which messages call `name`.
fn asked_of_varying(name: &str, question: &Question) -> Result<()> {
    match question.approach {
        Some(ApproachBy::Given(approach)) if approach > DEEPEST_IN_SLICES => {
            let expected = format!("0 to {DEEPEST_IN_SLICES} mm with {name}");
            Err(Error::new("patch: approach", format!("{approach:?} mm"), expected, "check the unit"))
        }
        _ => Ok(()),
    }
}

/// Writes a scene as TOML, with the values of the keys that it leaves to the program.
///
/// # Errors
/// Numbers that TOML cannot hold.
pub fn to_toml(scene: &Scene) -> Result<String> {
    toml::to_string(scene)
        .map_err(|error| Error::new("scene", error.to_string(), "values that TOML can hold", "correct them"))
}

/// Returns what output files say about a scene: its title or else `name`, and the scene itself with its SHA-256. Scenes
/// that differ only in comments have equal hashes.
pub fn echo(scene: &Scene, name: &str) -> Echo {
    let canonical = serde_json::to_vec(scene).unwrap_or_default();
    Echo {
        title: scene.title.clone().unwrap_or_else(|| name.to_string()),
        scene: serde_json::to_value(scene).unwrap_or_default(),
        hash: Sha256::digest(canonical).iter().map(|byte| format!("{byte:02x}")).collect(),
    }
}

/// Returns the formats to write, and the size of the triangle mesh. If the scene names no formats, these are all that are written
/// unasked, [`OutputFormat::unasked`].
fn outputs(scene: &Scene) -> Result<Outputs> {
    let named = scene.output.formats.clone();
    let required = named.is_some();
    let unasked = || OutputFormat::ALL.iter().copied().filter(|format| format.unasked()).collect();
    let formats = named.unwrap_or_else(unasked);
    let mesh_size = scene.mesh.size.map(checked_size).transpose()?;
    Ok(Outputs { formats, required, mesh_size })
}

fn question(scene: &Scene) -> Result<Question> {
    let tolerance = scene.grid.tolerance;
    let approach = approach_of(scene)?;
    let motion = scene.motion.as_ref().map(motion).transpose()?;
    let material = elastic(&scene.material)?;
    let friction = scene.friction.as_ref().map_or_else(|| Ok(Friction::default()), friction)?;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        let (found, expected) = (tolerance.to_string(), "a positive length in mm");
        return Err(Error::new("grid: tolerance", found, expected, "1e-12 gives all digits"));
    }
    let frame = scene.patch.as_ref().map_or_else(FrameOrigin::default, |patch| patch.frame);
    let pressure = scene.patch.as_ref().map_or(Ok(None), |patch| pressure(patch, scene.grid.reference))?;
    Ok(Question {
        approach,
        frame,
        motion,
        material,
        friction,
        tolerance,
        pressure,
        method: scene.grid.method,
    })
}

/// Returns what is asked of the pressures.
///
/// # Errors
/// Cells without pressures; sides that are not positive; a grid over the rail's surface.
fn pressure(patch: &PatchData, reference: Reference) -> Result<Option<AskedPressure>> {
    let cell = patch.pressure_cell;
    if !patch.pressure {
        return match cell {
            None => Ok(None),
            Some(cell) => {
                let (found, expected) = (format!("{cell} without pressures"), "pressure = true beside it");
                Err(Error::new("patch: pressure_cell", found, expected, "give it, or remove pressure_cell"))
            }
        };
    }
    if reference == Reference::Rail {
        let expected = "grid.reference = \"plane\": a half-space has one normal";
        return Err(Error::new(
            "patch: pressure",
            "grid.reference = \"rail\"",
            expected,
            "remove one of them",
        ));
    }
    Ok(Some(AskedPressure { cell: cell.map(pressure_cell).transpose()? }))
}

/// Returns the longest side of the cells of pressures \[mm\] as it is.
///
/// # Errors
/// One that is not positive and finite.
pub fn pressure_cell(cell: f64) -> Result<f64> {
    if cell > 0.0 && cell.is_finite() {
        return Ok(cell);
    }
    let advice = "give the longest side of a cell, or leave it out";
    Err(Error::new("patch: pressure_cell", cell.to_string(), "a positive length in mm", advice))
}

/// Returns the approach, or the load from which it is estimated, of `[patch]`, `[wheelset]` or both sides.
fn approach_of(scene: &Scene) -> Result<Option<ApproachBy>> {
    let of_axle = scene.wheelset.as_ref().and_then(|wheelset| wheelset.load);
    let of_side = |side: &Option<SideData>| side.as_ref().and_then(|side| side.load);
    let sides = [of_side(&scene.left), of_side(&scene.right)];
    let asked = scene.patch.as_ref().filter(|patch| patch.approach.is_some() || patch.load.is_some());
    let elsewhere = of_axle.is_some() || sides != [None, None];
    if let Some(patch) = asked.or(scene.patch.as_ref().filter(|_| !elsewhere)) {
        if elsewhere {
            let (place, load) = match (of_axle, sides) {
                (Some(load), _) => ("wheelset: load", load),
                (None, [Some(load), _]) => ("left: load", load),
                (None, [None, load]) => ("right: load", load.unwrap_or(f64::NAN)),
            };
            let expected = "loads beside a [patch] without approach and load, or [patch] alone";
            return Err(Error::new(place, format!("{load} beside [patch]"), expected, "remove one"));
        }
        return approach(patch).map(Some);
    }
    match (of_axle, sides) {
        (None, [None, None]) => Ok(None),
        (Some(load), [None, None]) => checked("wheelset: load", load, ApproachBy::AxleLoad(load)).map(Some),
        (None, [Some(left), Some(right)]) => {
            let by = ApproachBy::WheelLoads { right, left };
            checked("left: load", left, by).and_then(|by| checked("right: load", right, by)).map(Some)
        }
        (None, _) => {
            let (place, other) = if sides[0].is_none() { ("left", "right") } else { ("right", "left") };
            let found = format!("no load beside that of [{other}]");
            Err(Error::new(place, found, "loads of both sides or of none", "give both"))
        }
        (Some(_), _) => {
            let expected = "the load of the axle or those of its wheels";
            Err(Error::new("wheelset: load", "it and loads of sides", expected, "remove one"))
        }
    }
}

/// Returns the approach of `[patch]`, or the load from which it is estimated.
///
/// # Errors
/// None or both of them; values that are not finite, negative, or too small or large to be meant.
pub fn approach(patch: &PatchData) -> Result<ApproachBy> {
    let expected = "exactly one of `approach` and `load`";
    match (patch.approach, patch.load) {
        (Some(approach), None) => checked("patch: approach", approach, ApproachBy::Given(approach)),
        (None, Some(load)) => checked("patch: load", load, ApproachBy::WheelLoad(load)),
        (Some(_), Some(_)) => Err(Error::new("patch", "both", expected, "remove one")),
        (None, None) => Err(Error::new("patch", "neither", expected, "give one")),
    }
}

/// Returns `by` if its value, an approach \[mm\] or a load \[N\] of the key, is within the accepted range.
fn checked(key: &str, value: f64, by: ApproachBy) -> Result<ApproachBy> {
    let load = !matches!(by, ApproachBy::Given(_));
    if finite(key, value)? < 0.0 {
        let expected = if load { "a positive load in N" } else { "a value ≥ 0" };
        return Err(Error::new(key, value.to_string(), expected, "correct the sign"));
    }
    if load && value == 0.0 {
        let advice = "leave the load out to get the geometry alone, or give one";
        return Err(Error::new(key, "0", "a positive load in N", advice));
    }
    let largest = if load { HEAVIEST } else { DEEPEST };
    if value > 0.0 && !(SMALLEST..=largest).contains(&value) {
        let expected = if load {
            format!("{SMALLEST:e} to {largest:e} N")
        } else {
            format!("0, or {SMALLEST:e} to {largest} mm")
        };
        return Err(Error::new(key, format!("{value:e}"), expected, "check the unit"));
    }
    Ok(by)
}

/// Gives E* of both materials \[N/mm²\].
///
/// # Errors
/// A modulus that is not positive; a Poisson's ratio beyond (−1, 0.5\].
pub fn modulus(material: &MaterialData) -> Result<f64> {
    let Bodies { rail, wheel } = elastic(material)?;
    Ok(effective_modulus(&rail, &wheel))
}

fn elastic(material: &MaterialData) -> Result<Bodies<Elastic>> {
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
    Ok(Bodies {
        rail: body("rail", material.rail_youngs_modulus, material.rail_poissons_ratio)?,
        wheel: body("wheel", material.wheel_youngs_modulus, material.wheel_poissons_ratio)?,
    })
}
