//! Reads the axes of the grids: `[grid]`.

use super::data::{AxisData, GridData, Spacing};
use crate::case::AskedAxes;
use crate::conformal::Reference;
use crate::error::{Error, Result, finite};
use crate::mesh::{MOST_ON_AXIS, equal_steps};

/// Largest |ξ| and |η| \[mm\]: a thousand kilometres. Its square is far from overflowing.
const FARTHEST: f64 = 1e9;

/// Smallest extent of an axis \[mm\]. It is far below any real length, and its powers do not underflow.
const SMALLEST: f64 = 1e-60;

/// Returns the axes that are asked for, and how automatic axes are laid.
///
/// # Errors
/// The errors of [`check_axis`]; equal steps of fewer than two values, or that do not ascend; a step that is not positive; a negative
/// distance; a step or distance beside two given axes; a method of s for the normal gap.
pub(super) fn asked_axes(grid: &GridData) -> Result<AskedAxes> {
    if let (Reference::Rail, Some(method)) = (grid.reference, grid.method) {
        let (found, expected) = (method.name(), "\"auto\" where grid.reference is \"rail\"");
        return Err(Error::new("grid: method", found, expected, "remove it: the normal gap has one method"));
    }
    let (xi, eta) = (axis("grid: xi", &grid.xi)?, axis("grid: eta", &grid.eta)?);
    let (spacing, merge) = (grid.spacing.map(steps).transpose()?, distance(grid.merge.unwrap_or(0.0))?);
    let automatic = [("spacing", grid.spacing.is_some()), ("merge", grid.merge.is_some())];
    match automatic.into_iter().find(|(_, set)| *set) {
        Some((key, _)) if xi.is_some() && eta.is_some() => {
            let (place, expected) = (format!("grid: {key}"), format!("`{key}` only with automatic axes"));
            Err(Error::new(place, "a value beside given axes", expected, "remove it"))
        }
        _ => Ok(AskedAxes { xi, eta, spacing, merge, reference: grid.reference }),
    }
}

/// Returns the values of an axis, or `None` for "auto".
fn axis(place: &str, axis: &AxisData) -> Result<Option<Vec<f64>>> {
    let values = match axis {
        AxisData::Word(_) => return Ok(None),
        AxisData::Values(list) => list.values.clone(),
        AxisData::Steps(steps) => {
            let (from, to) = (finite(place, steps.from)?, finite(place, steps.to)?);
            if from >= to || steps.n < 2 {
                let found = format!("from {from} to {to} with n = {}", steps.n);
                return Err(Error::new(place, found, "from < to and n ≥ 2", "correct the axis"));
            }
            check_length(place, steps.n as f64)?;
            equal_steps(from, to, steps.n as usize)
        }
    };
    check_axis(place, &values)?;
    Ok(Some(values))
}

/// Checks the values \[mm\] of an axis; `place` names it.
///
/// # Errors
/// Values that are not finite, beyond ±10⁹ mm, not ascending or more than 10⁶; an extent below 10⁻⁶⁰ mm; none at all.
pub fn check_axis(place: &str, values: &[f64]) -> Result<()> {
    check_length(place, values.len() as f64)?;
    let [first, .., last] = values else {
        return match values {
            [only] => check_near(place, *only),
            _ => {
                let expected = "at least one value, each larger than the one before";
                Err(Error::new(place, "no values", expected, "give some, or \"auto\""))
            }
        };
    };
    if let Some(pair) = values.windows(2).find(|pair| pair[0] >= pair[1]) {
        let found = format!("{} after {}", pair[1], pair[0]);
        let expected = "at least one value, each larger than the one before";
        return Err(Error::new(place, found, expected, "sort the values"));
    }
    values.iter().try_for_each(|&value| check_near(place, value))?;
    if last - first < SMALLEST {
        let expected = format!("values that are at least {SMALLEST:e} mm apart");
        let found = format!("an extent of {:e} mm", last - first);
        return Err(Error::new(place, found, expected, "check the unit"));
    }
    Ok(())
}

fn check_near(place: &str, value: f64) -> Result<()> {
    if finite(place, value)?.abs() <= FARTHEST {
        return Ok(());
    }
    let expected = format!("values within ±{FARTHEST:e} mm");
    Err(Error::new(place, format!("{value:e}"), expected, "check the unit"))
}

fn check_length(place: &str, values: f64) -> Result<()> {
    if values <= MOST_ON_AXIS {
        return Ok(());
    }
    let expected = format!("at most {MOST_ON_AXIS:e} values");
    Err(Error::new(place, format!("{values:e} values"), expected, "take fewer, or a smaller window"))
}

/// Returns the steps \[Δξ, Δη\] \[mm\] of automatic axes.
fn steps(spacing: Spacing) -> Result<[f64; 2]> {
    let steps = match spacing {
        Spacing::Both(step) => [step; 2],
        Spacing::Each(steps) => steps,
    };
    for step in steps {
        if finite("grid: spacing", step)? <= 0.0 {
            let (found, expected) = (step.to_string(), "a positive step in mm");
            return Err(Error::new("grid: spacing", found, expected, "correct it"));
        }
    }
    Ok(steps)
}

/// Returns the distance \[mm\] below which parts of the patch share a grid.
fn distance(merge: f64) -> Result<f64> {
    if finite("grid: merge", merge)? >= 0.0 {
        return Ok(merge);
    }
    let expected = "a distance of 0 mm or more";
    Err(Error::new("grid: merge", merge.to_string(), expected, "correct the sign"))
}
