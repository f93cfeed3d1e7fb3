//! The positions of a sweep, as Python gives them.

use pyo3::prelude::*;
use wheelrail::Error;
use wheelrail::search::{Position, Roll};

use crate::arrays::values;
use crate::errors::exception;

/// A roll in rad, or a word.
#[derive(FromPyObject)]
pub(crate) enum RollArgument {
    Radians(f64),
    Word(String),
}

impl RollArgument {
    /// Gives the roll.
    pub(crate) fn roll(&self) -> PyResult<Roll> {
        match self {
            Self::Radians(angle) => Ok(Roll::Fixed(*angle)),
            Self::Word(word) if word == "solve" => Ok(Roll::Solve),
            Self::Word(word) if word == "neglect" => Ok(Roll::Neglect),
            Self::Word(word) => {
                let expected = "\"solve\", \"neglect\" or an angle in rad";
                Err(exception(Error::new("roll", format!("\"{word}\""), expected, "correct it")))
            }
        }
    }
}

/// Takes the positions of a sweep from numbers, arrays and words.
pub(crate) fn positions(
    lateral: &Bound<'_, PyAny>,
    yaw: Option<&Bound<'_, PyAny>>,
    roll: Option<&Bound<'_, PyAny>>,
) -> PyResult<Positions> {
    /// Most positions of one sweep: some GiB with all that is kept of them.
    const MOST: usize = 10_000_000;
    let lateral = Each::of("lateral", lateral)?;
    let yaw = yaw.map_or(Ok(Each::One(0.0)), |yaw| Each::of("yaw", yaw))?;
    let (word, angles) = match roll {
        None => (Some(Roll::Solve), Each::One(0.0)),
        Some(roll) => match roll.extract::<RollArgument>() {
            Ok(one) => (Some(one.roll()?), Each::One(0.0)),
            Err(_) => (None, Each::of("roll", roll)?),
        },
    };
    let lengths = [("lateral", &lateral), ("yaw", &yaw), ("roll", &angles)];
    let all = lengths.iter().filter_map(|(_, each)| each.len()).next().unwrap_or(1);
    if let Some((name, each)) = lengths.iter().find(|(_, each)| each.len().is_some_and(|n| n != all)) {
        let found = format!("{} values beside {all} others", each.len().unwrap_or(1));
        return Err(exception(Error::new(*name, found, "arrays of one length, or numbers", "correct it")));
    }
    if all > MOST {
        let error = Error::new(
            "lateral",
            format!("{all} positions"),
            format!("at most {MOST}"),
            "take several sweeps",
        );
        return Err(exception(error.of_kind(wheelrail::ErrorKind::Limit)));
    }
    Ok(Positions { lateral, yaw, word, angles, count: all })
}

/// The positions of a sweep, by their numbers.
pub(crate) struct Positions {
    lateral: Each,
    yaw: Each,
    /// How all rolls are found, unless they are given.
    word: Option<Roll>,
    angles: Each,
    pub(crate) count: usize,
}

impl Positions {
    /// Gives the position with this number, from 0.
    pub(crate) fn at(&self, k: usize) -> Position {
        let roll = self.word.unwrap_or_else(|| Roll::Fixed(self.angles.at(k)));
        Position { lateral: self.lateral.at(k), yaw: self.yaw.at(k), roll }
    }
}

/// One number for all positions, or one for each.
enum Each {
    One(f64),
    Many(Vec<f64>),
}

impl Each {
    fn of(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(number) = argument.extract::<f64>() {
            return Ok(Self::One(number));
        }
        Ok(Self::Many(values(name, argument)?))
    }

    fn len(&self) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Many(all) => Some(all.len()),
        }
    }

    fn at(&self, k: usize) -> f64 {
        match self {
            Self::One(value) => *value,
            Self::Many(all) => all[k],
        }
    }
}
