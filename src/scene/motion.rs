//! `[motion]` and `[friction]`: what solvers of rolling contact need besides the geometry.

use super::motion_data::{FrictionData, MotionData, PitchData, PitchWord};
use crate::case::Friction;
use crate::error::{Error, Result, finite};
use crate::placement::{Motion, Pitch, Rates};

/// Millimetres in a metre.
const MILLIMETRES: f64 = 1000.0;

/// Largest velocity that is accepted \[m/s\]: above any train's, and below the number that a slow train's has in mm/s.
const FASTEST: f64 = 250.0;

/// Smallest coefficient of friction that CONTACT takes.
const LEAST_FRICTION: f64 = 1e-4;

/// Largest coefficient of friction that is accepted: five times the highest of clean steel in vacuum.
const MOST_FRICTION: f64 = 10.0;

/// Checks the motion and turns it into mm/s and rad/s.
///
/// # Errors
/// Values that are not finite; a speed of 0; a velocity beyond ±250 m/s.
pub(super) fn motion(data: &MotionData) -> Result<Motion> {
    let in_table = |error: Error| error.within("motion");
    for (key, value) in [("speed", data.speed), ("lateral", data.lateral), ("vertical", data.vertical)] {
        if finite(key, value).map_err(in_table)?.abs() > FASTEST {
            let expected = format!("a velocity within ±{FASTEST} m/s");
            return Err(in_table(Error::new(key, value.to_string(), expected, "check the unit: m/s")));
        }
    }
    let pitch = match data.pitch {
        PitchData::Word(PitchWord::Rolling) => Pitch::Rolling,
        PitchData::Word(PitchWord::Nominal) => Pitch::Nominal,
        PitchData::Rate(rate) => Pitch::Rate(rate),
    };
    let rates = Rates {
        lateral: MILLIMETRES * data.lateral,
        vertical: MILLIMETRES * data.vertical,
        yaw: data.yaw,
        roll: data.roll,
        pitch,
    };
    Motion::new(MILLIMETRES * data.speed, rates).map_err(in_table)
}

/// Checks the coefficients of friction.
///
/// # Errors
/// A coefficient outside of 1e-4 to 10; a kinetic one above the static one.
pub(super) fn friction(data: &FrictionData) -> Result<Friction> {
    let at_rest = data.at_rest.unwrap_or(Friction::default().at_rest);
    let sliding = data.sliding.unwrap_or(at_rest);
    for (place, value) in [("friction: static", at_rest), ("friction: kinetic", sliding)] {
        if !(LEAST_FRICTION..=MOST_FRICTION).contains(&value) {
            let expected = format!("a coefficient from {LEAST_FRICTION} to {MOST_FRICTION}");
            return Err(Error::new(place, value.to_string(), expected, "dry steel has 0.3"));
        }
    }
    if sliding > at_rest {
        let expected = format!("at most the static coefficient, {at_rest}");
        return Err(Error::new("friction: kinetic", sliding.to_string(), expected, "give both, or lower it"));
    }
    Ok(Friction { at_rest, sliding })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_turned_and_words_are_understood() -> Result<()> {
        let data = MotionData { speed: 20.0, lateral: 0.1, yaw: 0.2, ..MotionData::default() };
        let found = motion(&data)?;
        let rates = Rates { lateral: 100.0, yaw: 0.2, ..Rates::default() };
        assert_eq!(found, Motion::new(20_000.0, rates)?);
        for (pitch, expected) in [
            (PitchData::Word(PitchWord::Nominal), Pitch::Nominal),
            (PitchData::Rate(-43.0), Pitch::Rate(-43.0)),
        ] {
            assert_eq!(motion(&MotionData { pitch, ..data.clone() })?.rates().pitch, expected);
        }
        let given = FrictionData { at_rest: Some(0.4), sliding: None };
        assert_eq!(friction(&given)?, Friction { at_rest: 0.4, sliding: 0.4 });
        Ok(())
    }

    #[test]
    fn complaints_name_the_key() {
        let of = |data: MotionData| motion(&data).err().map(|e| e.to_string()).unwrap_or_default();
        let base = || MotionData { speed: 20.0, ..MotionData::default() };
        for (data, text) in [
            (
                MotionData { speed: 0.0, ..base() },
                "motion: speed: found 0; expected a forward speed other than 0;",
            ),
            (
                MotionData { speed: 20_000.0, ..base() },
                "motion: speed: found 20000; expected a velocity within",
            ),
            (MotionData { speed: f64::NAN, ..base() }, "motion: speed: found NaN; expected a finite number;"),
            (
                MotionData { roll: f64::INFINITY, ..base() },
                "motion: roll: found inf; expected a finite number;",
            ),
            (MotionData { pitch: PitchData::Rate(f64::NAN), ..base() }, "motion: pitch: found NaN;"),
        ] {
            assert!(of(data.clone()).starts_with(text), "{}", of(data));
        }
        let of = |at_rest, sliding| {
            friction(&FrictionData { at_rest, sliding }).err().map(|e| e.to_string()).unwrap_or_default()
        };
        assert!(
            of(Some(0.0), None).starts_with("friction: static: found 0; expected a coefficient from 0.0001")
        );
        assert!(of(None, Some(0.5)).starts_with("friction: kinetic: found 0.5; expected at most the static"));
    }
}
