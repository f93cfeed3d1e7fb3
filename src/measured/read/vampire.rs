//! Reads Vampire's profiles: `.rai` rails and `.whe` wheels.
//!
//! ```text
//! RAILPROFILE                  WHEELPROFILE
//! title                        title
//! GAUGEPOINT EUROPEAN          TREADDATUM EUROPEAN       14 mm below the top; 70 mm from the flange back
//! GAUGE 1435.0                 FLANGEBACK 1353.0         between the gauge points; between the flange backs
//! y z y z                      y z y z                   left and right, mm from the middle of the track or the axle
//! ```
//!
//! `GAUGEPOINT` is also US (5/8 in) or CUSTOM with a height, `TREADDATUM` US1 (2 27/32 in), US2 (3 1/16 in) or CUSTOM with a distance.
//! Heights are up on rails and down on wheels. The origin becomes the gauge point at the height of the top of rail, or the tread datum
//! (CONTACT, `read_vampire.m`). `"`, `!` and `%` begin a comment.
//!
//! The right-hand profile is read. Where the left-hand one is not its mirror image, it is a second section, mirrored.

use super::points::Points;
use super::scan::{Line, last_place, lines};
use crate::error::{Error, Result};
use crate::measured::Format;
use crate::measured::unit::Unit;
use crate::profile::Side;

/// Largest difference \[mm\] of a left-hand profile and the mirror image of the right-hand one that are the same.
const SAME_SHAPE: f64 = 1e-3;

/// Reads a Vampire file: y to the field side, mm.
///
/// # Errors
/// Anything that is not of the head above; rows that are not four numbers. The error gives the line.
pub(in crate::measured) fn read(text: &str) -> Result<Points> {
    let mut all = lines(text);
    let mut next = |what: &str| {
        all.next()
            .ok_or_else(|| Error::new(last_place(text), "the end of the file", what, "complete the file"))
    };
    let first = next("WHEELPROFILE or RAILPROFILE")?;
    let side = match first.text {
        "WHEELPROFILE" => Side::Wheel,
        "RAILPROFILE" => Side::Rail,
        other => {
            return Err(first.error(
                other,
                "WHEELPROFILE or RAILPROFILE",
                "give its `format`, or correct it",
            ));
        }
    };
    next("a title")?;
    let datum = datum(next("the datum")?, side)?;
    let key = if side == Side::Wheel { "FLANGEBACK" } else { "GAUGE" };
    let distance = keyed(next(key)?, key)?;
    let distance = distance.0.number(distance.1, key)?;
    let mut hands: [Vec<(Line, [f64; 2])>; 2] = [Vec::new(), Vec::new()];
    for line in all.map(|line| line.without_comment(&['"', '!', '%'])) {
        let fields: Vec<&str> = line.text.split([' ', '\t', ',']).filter(|field| !field.is_empty()).collect();
        match fields[..] {
            [] => {}
            [a, b, c, d, ..] if fields.len() <= 8 => {
                let number = |field: &str| line.number(field, "a coordinate");
                hands[0].push((line, [number(c)?, number(d)?]));
                hands[1].push((line, [-number(a)?, number(b)?]));
            }
            _ => {
                return Err(line.error(
                    line.text,
                    "y and z of the left and the right profile",
                    "correct the line",
                ));
            }
        }
    }
    let mut points = Points::new(Format::Vampire, Some(1.0));
    points.body = Some(side);
    let apart = hands[0].iter().zip(&hands[1]).map(|((_, a), (_, b))| (a[0] - b[0]).hypot(a[1] - b[1]));
    let alike = apart.fold(0.0, f64::max) <= SAME_SHAPE;
    for hand in hands.into_iter().take(if alike { 1 } else { 2 }) {
        let origin = match side {
            Side::Wheel => [0.5 * distance + datum, 0.0],
            Side::Rail => gauge_point(&hand, datum),
        };
        points.begin_section();
        for (line, [y, z]) in hand {
            points.push(line, [y - origin[0], z - origin[1]], 1.0)?;
        }
    }
    points.finish(text)
}

/// Reads `KEY value`.
fn keyed<'a>(line: Line<'a>, key: &str) -> Result<(Line<'a>, &'a str)> {
    let value = line.text.strip_prefix(key).filter(|value| value.starts_with([' ', '\t']));
    value
        .map(|value| (line, value.trim()))
        .ok_or_else(|| line.error(line.text, format!("{key} and its value"), "correct the line"))
}

/// Returns the distance \[mm\] of the tread datum from the flange back, or the depth \[mm\] of the gauge point below the top.
fn datum(line: Line, side: Side) -> Result<f64> {
    let inch = Unit::Inch.millimetres();
    let (key, known) = match side {
        Side::Wheel => (
            "TREADDATUM",
            [("EUROPEAN", 70.0), ("US1", (2.0 + 27.0 / 32.0) * inch), ("US2", (3.0 + 1.0 / 16.0) * inch)],
        ),
        Side::Rail => ("GAUGEPOINT", [("EUROPEAN", 14.0), ("US", 0.625 * inch), ("", f64::NAN)]),
    };
    let (_, value) = keyed(line, key)?;
    if let Some(number) = value.strip_prefix("CUSTOM") {
        return line.number(number.trim(), key);
    }
    let named = known.into_iter().find(|(name, _)| !name.is_empty() && *name == value);
    named.map(|(_, length)| length).ok_or_else(|| {
        let names: Vec<_> = known.iter().map(|(name, _)| *name).filter(|name| !name.is_empty()).collect();
        line.error(value, format!("{} or CUSTOM with a length", names.join(", ")), "correct the line")
    })
}

/// Returns where the path of a rail comes within `depth` of its top, from the track's centre, at the height of the top. A rail that was
/// not measured so far down begins there.
fn gauge_point(hand: &[(Line, [f64; 2])], depth: f64) -> [f64; 2] {
    let mut path: Vec<[f64; 2]> = hand.iter().map(|(_, at)| *at).collect();
    if let [first, .., last] = path.as_slice()
        && last[0] < first[0]
    {
        path.reverse();
    }
    let top = path.iter().map(|at| at[1]).fold(f64::NEG_INFINITY, f64::max);
    let level = top - depth;
    let within = path.iter().position(|at| at[1] > level).unwrap_or(0);
    let y = match within.checked_sub(1).map(|k| (path[k], path[within])) {
        Some((below, above)) => {
            below[0] + (above[0] - below[0]) * ((level - below[1]) / (above[1] - below[1]))
        }
        None => path.first().map_or(0.0, |at| at[0]),
    };
    [y, if top.is_finite() { top } else { 0.0 }]
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAIL: &str = "RAILPROFILE\ntitle\nGAUGEPOINT CUSTOM 10\nGAUGE 1435\n-717 -20 717 -20\n-718 0 718 0 ! top\n-780,0,780,0\n";

    #[test]
    fn heads_give_the_origin() -> Result<()> {
        let rail = read(RAIL)?;
        assert_eq!(
            rail.at.iter().map(|p| p.xz()).collect::<Vec<_>>(),
            [[-0.5, -20.0], [0.5, 0.0], [62.5, 0.0]]
        );
        let wheel = "WHEELPROFILE\n\nTREADDATUM US1\nFLANGEBACK 1353.0\n-676.5 6 676.5 6\n-700 1 700 1\n-800 2 800 2\n";
        let back = -(2.0 + 27.0 / 32.0) * 25.4;
        assert!((read(wheel)?.at[0].x - back).abs() < 1e-12);
        assert_eq!(read(&RAIL.replace("-780,0", "-780,-3"))?.sections, [0, 3]);
        for (from, to, line) in [
            ("RAILPROFILE", "RAIL", 1),
            ("CUSTOM 10", "ASIAN", 3),
            ("GAUGE 1435", "GAGE 1435", 4),
            ("-717 -20 717 -20", "-717 -20", 5),
            ("-718 0 718 0", "-718 0 718 x", 6),
        ] {
            let error = read(&RAIL.replacen(from, to, 1)).err().map(|error| error.place);
            assert_eq!(error, Some(format!("line {line}")), "{to}");
        }
        assert!(read("RAILPROFILE\n").is_err());
        Ok(())
    }
}
