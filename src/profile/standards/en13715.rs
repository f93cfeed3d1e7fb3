//! The wheels of EN 13715:2020 by its formulas: a tread, a flange height, a flange thickness and an outer slope make one.
//!
//! A flange thinner than 32.5 mm has edges in the standard itself: the arcs of 12 mm before and behind its tip, RI and RE, have their
//! centres apart and meet in its point S, and the tread has a straight line from T1 to D0.

use std::ops::RangeInclusive;

use super::super::drawing::{ArcData, HalfData, LineData, PolynomialData, SegmentData, drawn_profile};
use super::super::{Profile, Segment};
use crate::error::{Error, Result};

/// Form of the family's names.
pub const PATTERN: &str = "EN13715-1:40-hH-eE-S% or EN13715-S1002-hH-eE-S%";
/// The source of all its members.
pub const SOURCE: &str =
    "EN 13715:2020 formulas (3 decimals); H = 28, 30 or 32, E = 28.5 to 32.5, S = 6.7 to 15, 15 if left out";

/// Flange thicknesses e \[mm\] and outer slopes \[%\] of the standard.
const THICKNESSES: RangeInclusive<f64> = 28.5..=32.5;
const SLOPES: RangeInclusive<f64> = 6.7..=15.0;
/// Outer slope of a name that gives none.
const USUAL_SLOPE: &str = "15%";
/// Flange thickness \[mm\] for which the formulas hold. The front of a thinner flange lies farther left by the difference.
const FULL_THICKNESS: f64 = 32.5;
/// End of the tread and of the chamfer behind it \[mm\], of a wheel 135 mm wide.
const ENDS: [f64; 2] = [60.0, 65.0];

/// What the standard tabulates for a flange height \[mm\]: the radius of F, its centre, and its joints G1 and F1.
struct Flange {
    height: f64,
    radius: f64,
    centre: [f64; 2],
    tip_joint: f64,
    face_joint: [f64; 2],
}

const FLANGES: [Flange; 3] = [
    Flange {
        height: 28.0,
        radius: 20.0,
        centre: [-58.558, -8.835],
        tip_joint: -49.663,
        face_joint: [-39.765, -15.675],
    },
    Flange {
        height: 30.0,
        radius: 21.5,
        centre: [-60.733, -10.425],
        tip_joint: -47.758,
        face_joint: [-40.530, -17.779],
    },
    Flange {
        height: 32.0,
        radius: 23.0,
        // The transcription has 12.558: then G1 lies 8 µm off the circle and F1 10 µm. By both, and by tangency, it is 12.568.
        centre: [-63.110, -12.568],
        tip_joint: -46.153,
        face_joint: [-41.497, -20.434],
    },
];

/// A member of the family, as its name says.
struct FamilyMember<'a> {
    tread: &'a str,
    flange: &'static Flange,
    thickness: f64,
    slope: f64,
}

/// Returns the wheel with this name, or `None` if the name is not of the family. `s1002` are the zones of S1002.
///
/// # Errors
/// A height, thickness or slope that the standard does not have.
pub(super) fn wheel(name: &str, s1002: &[SegmentData]) -> Option<Result<Profile>> {
    let (tread, rest) = name.strip_prefix("EN13715-")?.split_once("-h")?;
    let (height, rest) = rest.split_once("-e")?;
    let (thickness, slope) = rest.split_once('-').unwrap_or((rest, USUAL_SLOPE));
    ["1:40", "S1002"].contains(&tread).then(|| {
        let flange = FLANGES.iter().find(|flange| height.parse() == Ok(flange.height));
        let flange = flange.ok_or_else(|| unknown(name, height))?;
        let thickness = within(&THICKNESSES, thickness).ok_or_else(|| unknown(name, thickness))?;
        let slope = slope.strip_suffix('%').and_then(|slope| within(&SLOPES, slope));
        let slope = slope.ok_or_else(|| unknown(name, rest))?;
        FamilyMember { tread, flange, thickness, slope }.profile(name, s1002)
    })
}

fn within(range: &RangeInclusive<f64>, text: &str) -> Option<f64> {
    text.parse().ok().filter(|value| range.contains(value))
}

fn unknown(name: &str, part: &str) -> Error {
    let expected = format!("{PATTERN}, with H of 28, 30, 32, E from 28.5 to 32.5 and S from 6.7 to 15");
    Error::new("profile", format!("\"{part}\" in \"{name}\""), expected, "correct the name")
}

impl FamilyMember<'_> {
    fn profile(&self, name: &str, s1002: &[SegmentData]) -> Result<Profile> {
        let thinner = FULL_THICKNESS - self.thickness;
        let drawn = |segments: &[SegmentData]| drawn_profile(name, SOURCE, None, segments);
        let flange = drawn(&[self.front(thinner), self.moved(s1002)].concat())?.shifted(-thinner, 0.0);
        let parts = [drawn(&self.back(thinner))?, flange, drawn(&self.outer(thinner, s1002))?];
        let segments: Vec<Segment> = parts.iter().flat_map(|part| part.drawn().to_vec()).collect();
        Profile::new(name, SOURCE, segments)
    }

    /// The back of the flange, up to the standard's point S, where a thinner one has an edge of 2 asin((32.5 − e)/24).
    fn back(&self, thinner: f64) -> Vec<SegmentData> {
        let height = self.flange.height;
        vec![
            arc("H", [-49.5, 18.481 - height], 20.5, HalfData::Lower, [-70.0, -62.765]),
            arc("G in", [-55.0, 12.0 - height], 12.0, HalfData::Lower, [-62.765, -55.0 - thinner / 2.0]),
        ]
    }

    /// The front of the flange, drawn as one of full thickness.
    fn front(&self, thinner: f64) -> Vec<SegmentData> {
        let Flange { height, radius, centre, tip_joint, face_joint } = *self.flange;
        let tip = -55.0 + thinner / 2.0;
        vec![
            arc("G out", [-55.0, 12.0 - height], 12.0, HalfData::Lower, [tip, tip_joint]),
            arc("F", centre, radius, HalfData::Lower, [tip_joint, face_joint[0]]),
            line("E", face_joint, [-38.427, -12.0]),
        ]
    }

    /// The part of the tread that moves with the flange, up to T1.
    fn moved(&self, s1002: &[SegmentData]) -> Vec<SegmentData> {
        let throat = |to| arc("D", [-26.211, -16.446], 13.0, HalfData::Upper, [-38.427, to]);
        if self.tread == "1:40" {
            return vec![
                throat(-32.696),
                arc("R36", [-14.74, -36.38], 36.0, HalfData::Upper, [-32.696, -15.64]),
                line("1:40", [-15.64, -0.391], [-0.5, -0.013]),
            ];
        }
        let zones = [zone(s1002, "C", [-35.0, -26.0]), zone(s1002, "B", [-26.0, -0.5])];
        [throat(-35.0)].into_iter().chain(zones.into_iter().flatten()).collect()
    }

    /// The part of the tread that stays where it is: T1 to the chamfer.
    fn outer(&self, thinner: f64, s1002: &[SegmentData]) -> Vec<SegmentData> {
        // T1 and B1, where the outer slope begins.
        let (t1, b1) = if self.tread == "1:40" { (-0.013, [35.0, 0.875]) } else { (-0.017, [32.158, 0.780]) };
        let tread = if self.tread == "1:40" {
            Some(line("1:40", [0.0, 0.0], b1))
        } else {
            zone(s1002, "B", [0.0, b1[0]])
        };
        let end = [ENDS[0], b1[1] + self.slope / 100.0 * (ENDS[0] - b1[0])];
        let mut segments = vec![line("T1-D0", [-0.5 - thinner, t1], [0.0, 0.0])];
        segments.extend(tread);
        segments.push(line(&format!("{}%", self.slope), b1, end));
        segments.push(line("chamfer", end, [ENDS[1], end[1] + (ENDS[1] - ENDS[0])]));
        segments
    }
}

const NONE: SegmentData = SegmentData { label: None, line: None, arc: None, polynomial: None };

fn arc(label: &str, centre: [f64; 2], radius: f64, half: HalfData, x: [f64; 2]) -> SegmentData {
    let arc = ArcData { center: Some(centre), radius, half, x: Some(x), to_x: None };
    SegmentData { label: Some(label.into()), arc: Some(arc), ..NONE }
}

fn line(label: &str, from: [f64; 2], to: [f64; 2]) -> SegmentData {
    let line = LineData { from: Some(from), to: Some(to), slope: None, to_x: None };
    SegmentData { label: Some(label.into()), line: Some(line), ..NONE }
}

/// Part of the zone of S1002 with this letter.
fn zone(s1002: &[SegmentData], letter: &str, x: [f64; 2]) -> Option<SegmentData> {
    let zone = s1002.iter().find(|segment| segment.label.as_deref() == Some(letter))?;
    let coefficients = zone.polynomial.as_ref()?.coefficients.clone();
    let polynomial = Some(PolynomialData { x, coefficients });
    Some(SegmentData { label: Some(letter.into()), polynomial, ..NONE })
}

#[cfg(test)]
mod tests {
    use super::super::wheel;
    use super::*;
    use crate::profile::{Section, Side};

    /// Heights \[mm\] of a wheel at these abscissae.
    fn heights<const N: usize>(name: &str, at: [f64; N]) -> Result<[f64; N]> {
        let section = Section::own_axes(&wheel(name)?, Side::Wheel);
        Ok(at.map(|x| section.height(x)))
    }

    #[test]
    fn the_formulas_give_what_is_drawn_elsewhere() -> Result<()> {
        let at = [-65.0, -55.0, -45.0, -39.0, -36.0, -30.0, -20.0, -3.0, 12.0, 30.0];
        let drawn = heights("EN13715-1:40-h28-e32.5", at)?;
        assert_eq!(heights("EN13715-1:40-h28-e32.5-15%", at)?, drawn);
        // S1002 is drawn with nine decimals, and without the line from T1 to D0.
        let (drawn, made) = (heights("S1002", at)?, heights("EN13715-S1002-h28-e32.5-6.7%", at)?);
        for (x, (drawn, made)) in at.iter().zip(drawn.iter().zip(made)) {
            // On the face, with a slope of 70°, a rounding to a side is three upwards.
            assert!((drawn - made).abs() < 2e-3, "{x}: {drawn} {made}");
        }
        Ok(())
    }

    #[test]
    fn every_member_is_closed_near_its_formulas() -> Result<()> {
        for flange in &FLANGES {
            for joint in [[flange.tip_joint, 0.0], flange.face_joint] {
                let [x, z] = [joint[0] - flange.centre[0], joint[1] - flange.centre[1]];
                // Of the tip's joint the circle of 12 mm gives z.
                let on_tip = 12.0 - flange.height - (144.0 - (joint[0] + 55.0).powi(2)).sqrt();
                let z = if joint[1] == 0.0 { on_tip - flange.centre[1] } else { z };
                assert!((x.hypot(z) - flange.radius).abs() < 1e-3, "{}: {joint:?}", flange.height);
            }
        }
        for tread in ["1:40", "S1002"] {
            for (height, thickness) in
                [(28, 28.5), (28, 31.5), (30, 32.5), (30, 30.0), (32, 32.5), (32, 28.5)]
            {
                let name = format!("EN13715-{tread}-h{height}-e{thickness}-10%");
                let profile = wheel(&name)?;
                let moved = profile.largest_closing().map_or(0.0, |(largest, _)| largest.moved);
                assert!(moved < 1e-3, "{name}: {moved}");
            }
        }
        Ok(())
    }

    #[test]
    fn thin_flanges_have_the_edges_of_the_standard_and_no_other() -> Result<()> {
        // How far S is below the flange's height, as the standard tabulates it.
        for (thickness, lower) in [("31.5", 0.010), ("30.5", 0.042), ("29.5", 0.094), ("28.5", 0.168)] {
            let thinner: f64 = FULL_THICKNESS - thickness.parse::<f64>().unwrap_or(f64::NAN);
            let edge = 2.0 * (thinner / 24.0).asin();
            for (tread, height) in [("1:40", 28.0), ("S1002", 30.0), ("S1002", 32.0)] {
                let name = format!("EN13715-{tread}-h{height}-e{thickness}");
                let profile = wheel(&name)?;
                let at_tip = -55.0 - thinner / 2.0;
                let tip = Section::own_axes(&profile, Side::Wheel).height(at_tip);
                assert!((tip + height - lower).abs() < 1e-3, "{name}: {tip}");
                for joint in profile.continuity().iter().filter(|joint| joint.kink.abs() > 1e-9) {
                    // S, T1, D0; B1 and the chamfer.
                    let named = [at_tip, -0.5 - thinner, 0.0, 32.158, 35.0, ENDS[0]];
                    assert!(named.iter().any(|x| (x - joint.x).abs() < 0.02), "{name}: {joint:?}");
                    let is_tip = (joint.x - at_tip).abs() < 1e-6;
                    assert!(!is_tip || (joint.kink - edge).abs() < 1e-9, "{name}: {joint:?} {edge}");
                }
            }
        }
        Ok(())
    }

    #[test]
    fn a_wrong_number_is_named() {
        let found = |name| wheel(name).err().map(|error| error.found).unwrap_or_default();
        assert!(found("EN13715-1:40-h29-e32.5").starts_with("\"29\" in"));
        assert!(found("EN13715-S1002-h28-e33").starts_with("\"33\" in"));
        assert!(found("EN13715-S1002-h28-e30-20%").starts_with("\"30-20%\" in"));
    }
}
