//! Makes rotations from inclinations as drawings give them: 1:40.

use nalgebra::UnitComplex;

use crate::error::{Error, Result, finite};

/// Makes the rotation whose tangent is rise/run, within ±90°. It is counter-clockwise for a positive quotient.
///
/// Cosine and sine come from the two lengths and not from an angle; both are exact to a rounding.
///
/// # Errors
/// Numbers that are not finite; a run of 0.
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
    let length = finite("inclination", rise)?.hypot(run).copysign(run);
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
        Ok(())
    }
}
