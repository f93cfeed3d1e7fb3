//! Built-in rails and wheels, from the published numbers in `rails.json` and `wheels.json`, and wheels by the formulas of
//! EN 13715.

mod en13715;
mod web;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use nalgebra::UnitComplex;
use serde::Deserialize;

use super::drawing::{self, SegmentData};
use super::{Arc, Half, Profile, Segment, Side, Station};
use crate::error::{Error, Result};

pub use en13715::{PATTERN as EN_13715_NAMES, SOURCE as EN_13715_SOURCE};

#[derive(Debug, Deserialize)]
struct RailFile {
    rails: BTreeMap<String, RailData>,
    webs: Vec<web::WebData>,
    former_names: BTreeMap<String, FormerName>,
}

/// The name that a rail had before EN 13674.
#[derive(Debug, Deserialize)]
struct FormerName {
    /// Its name today.
    name: String,
    /// Where it had the former one.
    source: String,
}

#[derive(Debug, Deserialize)]
struct WheelFile {
    wheels: BTreeMap<String, WheelData>,
}

/// A rail head as EN 13674 draws it: symmetric, from crown to corner.
#[derive(Debug, Clone, Deserialize)]
struct RailData {
    /// Radii from the crown outwards \[mm\].
    crown_to_corner_radii: Vec<f64>,
    /// |x| of the joints between these arcs \[mm\].
    tangent_x: Vec<f64>,
    /// Flank inclination, 0 for vertical.
    flank_dx_per_dz: f64,
    /// Radius between flank and underside \[mm\].
    lower_fillet_radius: f64,
    /// Run per unit of rise of the underside, outwards: z = `underside_apex_z` + |x|/this.
    underside_1_to: f64,
    /// z of the point where both undersides meet \[mm\].
    underside_apex_z: f64,
    /// Published numbers that the chain must reproduce.
    #[cfg(test)]
    check: RailCheck,
    /// The standard.
    source: String,
}

/// Published check values of a rail.
#[cfg(test)]
#[derive(Debug, Clone, Deserialize)]
struct RailCheck {
    /// |x| where the corner arc meets the flank \[mm\].
    half_width_at_flank_tangent: f64,
    /// z of that point \[mm\].
    z_at_flank_tangent: Option<f64>,
    /// The nominal width over both flanks \[mm\], a round number that no radius and no joint is computed from.
    head_width: Option<f64>,
}

#[derive(Debug, Deserialize)]
struct WheelData {
    source: String,
    origin: String,
    segments: Vec<SegmentData>,
}

// The two files are compiled into the program, and the tests read every entry: they cannot fail to parse.
static RAILS: LazyLock<RailFile> = LazyLock::new(|| {
    let none = |_| RailFile { rails: BTreeMap::new(), webs: Vec::new(), former_names: BTreeMap::new() };
    serde_json::from_str(include_str!("rails.json")).unwrap_or_else(none)
});
static WHEELS: LazyLock<BTreeMap<String, WheelData>> = LazyLock::new(|| {
    serde_json::from_str::<WheelFile>(include_str!("wheels.json")).map(|file| file.wheels).unwrap_or_default()
});

/// Returns the names of the built-in rails, in alphabetical order.
pub fn rail_names() -> impl Iterator<Item = &'static str> {
    RAILS.rails.keys().map(String::as_str)
}

/// Returns the former names of built-in rails, each with the name of today, in alphabetical order.
pub fn former_rail_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    RAILS.former_names.iter().map(|(former, today)| (former.as_str(), today.name.as_str()))
}

/// Returns the names of the built-in wheels, in alphabetical order.
pub fn wheel_names() -> impl Iterator<Item = &'static str> {
    WHEELS.keys().map(String::as_str)
}

/// Returns a built-in rail head: upright, symmetric, origin at the crown's apex. It includes the flanks where they are
/// inclined. A former name ([`former_rail_names`]) gives the rail of today under that name, which its source explains.
///
/// # Errors
/// An unknown name; the error offers the nearest known one, or says that the name is that of the other body.
pub fn rail(name: &str) -> Result<Profile> {
    let former = RAILS.former_names.get(name);
    let today = former.map_or(name, |former| &former.name);
    let data = RAILS
        .rails
        .get(today)
        .ok_or_else(|| unknown(name, ["rail", "wheel"], rail_names(), wheel_names()))?;
    let mut profile = head(name, data)?;
    if let Some(former) = former {
        profile.source = format!("{today} of {}; {}", profile.source, former.source);
    }
    Ok(profile)
}

/// Returns a built-in wheel: right-hand, flange at negative x, origin as its source says. Besides those of [`wheel_names`]
/// there are the wheels of EN 13715 with any of its flanges and slopes: [`EN_13715_NAMES`].
///
/// # Errors
/// An unknown name; the error offers the nearest known one, or says that the name is that of the other body.
pub fn wheel(name: &str) -> Result<Profile> {
    let Some(data) = WHEELS.get(name) else {
        let zones = WHEELS.get("S1002").map_or(&[][..], |s1002| &s1002.segments);
        let none = || Err(unknown(name, ["wheel", "rail"], wheel_names(), rail_names()));
        return en13715::wheel(name, zones).unwrap_or_else(none);
    };
    drawing::drawn_profile(name, &format!("{}; origin: {}", data.source, data.origin), None, &data.segments)
}

/// Tells whether a profile is that of a standard, as it was built in, or rotated and shifted.
pub fn is_built_in(profile: &Profile, side: Side) -> bool {
    let built_in = if side == Side::Rail { rail(&profile.name) } else { wheel(&profile.name) };
    built_in.is_ok_and(|own| own.source == profile.source)
}

/// Returns a built-in rail, as it was built in or moved, with its web and the upper side of its foot; `None` for other profiles, and for
/// rails whose webs are not built in.
pub(crate) fn with_web(rail: &Profile) -> Option<Profile> {
    if !is_built_in(rail, Side::Rail) {
        return None;
    }
    let today = RAILS.former_names.get(&rail.name).map_or(&rail.name, |former| &former.name);
    let web = RAILS.webs.iter().find(|web| web.rails.contains(today))?;
    let data = RAILS.rails.get(today)?;
    let head = head(&rail.name, data).ok()?;
    let under = web::Underside {
        run: data.underside_1_to,
        apex_z: data.underside_apex_z,
        fillet_radius: data.lower_fillet_radius,
    };
    let whole = web::section(&head, &under, web).ok()?;
    let [own, to] = [&head, rail].map(|of| of.segments().first().map(Segment::start));
    let motion = Station::AXES.seen_from(&own?).placed_by(&to?);
    Some(whole.rotated(UnitComplex::new(motion.angle())).shifted(motion.x, motion.z))
}

/// Makes a rail head: the crown, then arcs smooth with each other down to the flank tangent, then the flank down to the
/// lower fillet; mirrored for the left half.
fn head(name: &str, data: &RailData) -> Result<Profile> {
    let crown = data.crown_to_corner_radii[0];
    let first = data.tangent_x[0];
    let crown = Arc::about([0.0, -crown], crown, Half::Upper, [-first, first])?;
    let mut right = Vec::new();
    let mut end = crown.end;
    // The corner arc ends with the tangent of the flank, dz/dx = −1/flank_dx_per_dz. This is the sine of its angle.
    let flank = -data.flank_dx_per_dz.hypot(1.0).recip();
    for (k, &radius) in data.crown_to_corner_radii.iter().enumerate().skip(1) {
        let to_x = data.tangent_x.get(k).copied().unwrap_or(end.x + (end.sin - flank) * radius);
        let arc = Arc::tangent_at(end, -radius, to_x)?;
        end = arc.end;
        right.push(Segment::arc(arc));
    }
    if data.flank_dx_per_dz > 0.0 {
        let line = Arc::tangent_at(end, f64::INFINITY, end.x + flank_run(data, end.x, end.z))?;
        right.push(Segment::arc(line));
    }
    let half = Profile::new(name, &data.source, right.clone())?;
    let mut segments = half.mirrored().segments().to_vec();
    segments.push(Segment::arc(crown));
    segments.extend(right);
    Profile::new(name, &data.source, segments)
}

/// Returns the run in x \[mm\] of the flank from (x, z) to where the fillet to the underside begins.
fn flank_run(data: &RailData, x: f64, z: f64) -> f64 {
    let inclination = data.flank_dx_per_dz;
    // The drop d to the underside solves z − d = apex + (x + inclination·d)/n.
    let n = data.underside_1_to;
    let drop = (z - data.underside_apex_z - x / n) / (1.0 + inclination / n);
    // The flank turns into the underside by `turn`. The fillet takes r·tan(turn/2) of each.
    let turn = std::f64::consts::FRAC_PI_2 + inclination.atan() - n.recip().atan();
    let taken = data.lower_fillet_radius * (turn / 2.0).tan() / inclination.hypot(1.0);
    inclination * (drop - taken)
}

/// Makes the error of a name that is not among the `known` profiles of a body; `others` are those of the other body.
fn unknown(
    name: &str,
    [body, other]: [&str; 2],
    known: impl Iterator<Item = &'static str>,
    mut others: impl Iterator<Item = &'static str>,
) -> Error {
    // Names of one family differ in their last letters.
    let alike = |known: &str| {
        let same = |(a, b): &(char, char)| a.eq_ignore_ascii_case(b);
        let letters = known.chars().zip(name.chars()).take_while(same).count();
        letters as f64 / known.len().max(name.len()) as f64
    };
    let nearest = known.max_by(|a, b| alike(a).total_cmp(&alike(b)));
    let expected = nearest.map_or_else(String::new, |n| format!("a built-in {body} profile such as \"{n}\""));
    if others.any(|known| known == name) {
        let found = format!("\"{name}\", which is a built-in {other}");
        return Error::new("profile", found, expected, format!("give it as the {other}"));
    }
    let advice = "see `wheelrail profile list`, or give `file` or `segments`";
    Error::new("profile", format!("\"{name}\""), expected, advice)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published check values have six or seven decimals of a mm.
    const PUBLISHED: f64 = 1e-6;
    /// Joints are printed to a thousandth, and a corner may lie some of them off: 6 µm for 27E1, 3 µm for 36E3.
    const NOMINAL: f64 = 1e-2;

    #[test]
    fn every_rail_has_its_published_width_and_height() -> Result<()> {
        assert_eq!(rail_names().count(), 40);
        for name in rail_names() {
            let data = &RAILS.rails[name];
            let profile = rail(name)?;
            let corner = 2 * data.crown_to_corner_radii.len() - 2;
            let flanks = usize::from(data.flank_dx_per_dz > 0.0);
            let end = profile.segments()[corner + flanks].end();
            assert!((end.x - data.check.half_width_at_flank_tangent).abs() < PUBLISHED, "{name}: {end:?}");
            if let Some(z) = data.check.z_at_flank_tangent {
                assert!((end.z - z).abs() < PUBLISHED, "{name}: {end:?}");
            }
            if let Some(width) = data.check.head_width {
                assert!((2.0 * end.x - width).abs() < NOMINAL, "{name}: {end:?}");
            }
            for joint in profile.continuity() {
                assert!(joint.gap < 1e-12 && joint.kink.abs() < 1e-13, "{name}: {joint:?}");
            }
        }
        Ok(())
    }

    #[test]
    fn former_names_are_those_of_rails_of_today() -> Result<()> {
        let former: Vec<_> = former_rail_names().collect();
        assert_eq!(former, [("BS113A", "56E1"), ("BV50", "50E3"), ("S49", "49E1"), ("UIC54", "54E1")]);
        for (former, today) in former {
            let (own, today) = (rail(former)?, rail(today)?);
            assert_eq!(own.segments(), today.segments());
            assert!(
                own.name == former && own.source.contains(&today.name) && own.source.contains(&today.source)
            );
            assert!(is_built_in(&own, Side::Rail));
        }
        Ok(())
    }

    #[test]
    fn every_wheel_is_closed_near_its_drawing() -> Result<()> {
        assert_eq!(wheel_names().count(), 14);
        for name in wheel_names() {
            let profile = wheel(name)?;
            // Coordinates are printed to 1e-3 mm (EN) and 1e-4 inch (APTA). A rounding is half a step; at APTA-120's kink
            // it is a whole one.
            let moved = profile.largest_closing().map_or(0.0, |(largest, _)| largest.moved);
            assert!(moved < if name.starts_with("APTA") { 2e-3 } else { 6e-4 }, "{name}: {moved}");
            let gap = profile.continuity().iter().map(|joint| joint.gap).fold(0.0, f64::max);
            // Centres of arcs of 32 m are rounded to 4e-12 mm.
            assert!(gap < 1e-12, "{name}: {gap:e}");
        }
        Ok(())
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        let error = rail("60e1").err().map(|e| e.expected);
        assert_eq!(error.as_deref(), Some("a built-in rail profile such as \"60E1\""));
        let error = rail("S1002").err().map(|e| (e.found, e.advice));
        let expected = ("\"S1002\", which is a built-in wheel".into(), "give it as the wheel".into());
        assert_eq!(error, Some(expected));
    }
}
