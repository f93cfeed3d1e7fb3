//! Makes rotations from inclinations as drawings give them: 1:40.

use nalgebra::UnitComplex;

use crate::error::{Error, Result, finite};

/// Largest rise over run of an inclination: 89.94°. A steeper one is upright to a tenth of a millimetre over a rail's head. Much
/// steeper ones have a cosine below the rounding of their sine, so that profiles lose their order along x.
const STEEPEST: f64 = 1e3;

/// Makes the rotation whose tangent is rise/run, within ±90°. It is counter-clockwise for a positive quotient.
///
/// Cosine and sine come from the two lengths and not from an angle; both are exact to a rounding.
///
/// # Errors
/// Numbers that are not finite; a run of 0; a rise of more than a thousand runs.
///
/// # Examples
/// ```
/// use wheelrail::profile::{inclination, standards};
///
/// let inclined = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn inclination(rise: f64, run: f64) -> Result<UnitComplex<f64>> {
    if finite("inclination", run)? == 0.0 {
        let found = format!("{rise}:{run}");
        return Err(Error::new("inclination", found, "1:n with n ≠ 0", "give the run, 40 for 1:40"));
    }
    if finite("inclination", rise)?.abs() / run.abs() > STEEPEST {
        let (found, expected) = (format!("{rise}:{run}"), format!("at most {STEEPEST}:1, which is upright"));
        return Err(Error::new("inclination", found, expected, "give rise:run, 1:40 for a rail"));
    }
    let length = rise.hypot(run).copysign(run);
    Ok(UnitComplex::from_cos_sin_unchecked(run / length, rise / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inclinations_lean_by_their_quotient() -> Result<()> {
        for (rise, run) in [(1.0, 40.0), (-1.0, 20.0), (1.0, -40.0), (0.0, 1.0), (3.0, 4.0)] {
            let turn = inclination(rise, run)?;
            assert!((turn.angle() - (rise / run).atan()).abs() < 1e-16, "{rise}:{run}");
            assert!((turn.norm() - 1.0).abs() <= f64::EPSILON, "{rise}:{run}");
        }
        assert!(inclination(1.0, 0.0).is_err() && inclination(f64::NAN, 40.0).is_err());
        for (rise, run) in
            [(1e20, 40.0), (-1e20, 40.0), (1e5, -40.0), (1.0, 1e-300), (f64::MAX, f64::MIN_POSITIVE)]
        {
            assert!(inclination(rise, run).is_err(), "{rise}:{run}");
        }
        Ok(())
    }
}
