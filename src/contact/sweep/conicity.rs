//! Equivalent conicity by integration of the wheelset's kinematic movement, as in EN 15302.
//!
//! A wheelset that rolls without slip moves by y″ = −Δr(y)/(e r₀), primes along the track, e the distance of the
//! contact points. A cone of conicity γ has Δr = 2y tanγ and Klingel's wavelength λ, λ² = 2π² e r₀/tanγ. The
//! equivalent conicity of any Δr is that of the cone with the same wavelength at the same amplitude:
//! tanγ_e = (π/λ)² 2 e r₀. With v² = 2 ∫_y^ŷ Δr the energy integral gives
//!
//! ```text
//! λ = 4 √(e r₀) T,   T = ∫_0^ŷ dy/v        tanγ_e = π²/(8 T²)
//! ```
//!
//! free of e and r₀. Both wheels being alike and the yaw neglected, Δr is odd, so a quarter of the movement does.

use super::rolling_radius_difference;
use crate::contact::search::wheelset::{Roll, WheelsetOnTrack, WheelsetSearch};
use crate::error::{Error, Result, finite};

/// Widest cell of the table of Δr \[mm\], as EN 15302 has it.
const WIDEST: f64 = 0.1;

/// Cells over which Δr bends by more than this share of a millimetre are halved …
const BEND: f64 = 2e-5;

/// … down to this width \[mm\]: there Δr jumps, and the place of the jump has this error.
const NARROWEST: f64 = 1e-6;

/// The equivalent conicity of a wheelset on its track over the lateral amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct Conicity {
    /// Displacements y ≥ 0 \[mm\], ascending from 0.
    y: Vec<f64>,
    /// Δr(y) \[mm\].
    delta_r: Vec<f64>,
    /// 2 ∫_0^y Δr \[mm²\].
    energy: Vec<f64>,
}

impl Conicity {
    /// Tabulates Δr up to the largest amplitude ŷ \[mm\]; the table ends early where the wheelset leaves the track.
    ///
    /// `roll`: [`Roll::Neglect`] is the standard's convention; [`Roll::Solve`] the exact geometry.
    /// Accuracy: 1e-4 of the conicity, and 1e-6 mm in the places where Δr jumps.
    /// Cost: some hundred searches.
    ///
    /// # Errors
    /// An amplitude that is not a positive number; a given roll, at which Δr is not odd.
    pub fn new(system: &WheelsetOnTrack, amplitude: f64, roll: Roll) -> Result<Self> {
        if finite("conicity: amplitude", amplitude)? <= 0.0 {
            let found = amplitude.to_string();
            return Err(Error::new("conicity: amplitude", found, "a positive number", "give it in mm"));
        }
        if let Roll::Fixed(angle) = roll {
            let expected = "roll solved or neglected";
            return Err(Error::new("conicity: roll", angle.to_string(), expected, "leave conicity out"));
        }
        let mut table = Self { y: vec![0.0], delta_r: vec![0.0], energy: vec![0.0] };
        let mut search = system.search();
        let cells = (amplitude / WIDEST).ceil();
        let mut last = [0.0, 0.0];
        for k in 1..=cells as usize {
            let y = amplitude * k as f64 / cells;
            let Some(value) = rolling_radius_difference(&mut search, y, roll)? else { break };
            table.refine(&mut search, roll, last, [y, value])?;
            last = [y, value];
        }
        Ok(table)
    }

    /// Adds the cell from `a` to `b` (y, Δr), halved where Δr is not straight.
    fn refine(&mut self, search: &mut WheelsetSearch, roll: Roll, a: [f64; 2], b: [f64; 2]) -> Result<()> {
        let middle = a[0] + (b[0] - a[0]) / 2.0;
        if let Some(value) = rolling_radius_difference(search, middle, roll)? {
            let bend = (value - (a[1] + b[1]) / 2.0).abs();
            let halve = bend > BEND && b[0] - a[0] > NARROWEST;
            if halve {
                self.refine(search, roll, a, [middle, value])?;
                return self.refine(search, roll, [middle, value], b);
            }
        }
        self.push(b);
        Ok(())
    }

    fn push(&mut self, [y, value]: [f64; 2]) {
        let last = self.y.len() - 1;
        let energy = self.energy[last] + (y - self.y[last]) * (self.delta_r[last] + value);
        self.y.push(y);
        self.delta_r.push(value);
        self.energy.push(energy);
    }

    /// tan γ_e at the amplitude |y|; `None` at 0, beyond the table, and where the movement does not come back
    /// (Δr does not restore).
    ///
    /// Method: Δr straight between the table's displacements, the movement over each cell in closed form.
    pub fn at(&self, y: f64) -> Option<f64> {
        let amplitude = y.abs();
        let above = self.y.partition_point(|&y| y < amplitude);
        if above == 0 || above >= self.y.len() {
            return None;
        }
        let below = above - 1;
        let share = (amplitude - self.y[below]) / (self.y[above] - self.y[below]);
        let value = self.delta_r[below] + share * (self.delta_r[above] - self.delta_r[below]);
        let total = self.energy[below] + (amplitude - self.y[below]) * (self.delta_r[below] + value);
        // From the turning point, where v = 0, inwards.
        let (mut outer, mut force, mut speed, mut time) = (amplitude, value, 0.0, 0.0);
        for k in (0..=below).rev() {
            let left = total - self.energy[k];
            if left <= 0.0 {
                return None;
            }
            let inner = left.sqrt();
            time += crossing([self.y[k], outer], [self.delta_r[k], force], [inner, speed]);
            (outer, force, speed) = (self.y[k], self.delta_r[k], inner);
        }
        Some(std::f64::consts::PI.powi(2) / (8.0 * time * time))
    }
}

/// Time from y0 to y1 under the force Δr, straight between its end values, at the end speeds given: with the stiffness
/// g, tan(√g T/2) = √g (y1 − y0)/(v0 + v1).
fn crossing(y: [f64; 2], force: [f64; 2], speed: [f64; 2]) -> f64 {
    let run = y[1] - y[0];
    let mean = run / (speed[0] + speed[1]);
    let stiffness = if run > 0.0 { (force[1] - force[0]) / run } else { 0.0 };
    let square = stiffness * mean * mean;
    // The series' next term is below 2e-9 of the first.
    if square.abs() < 1e-2 {
        return 2.0 * mean * (1.0 - square * (1.0 / 3.0 - square * (0.2 - square / 7.0)));
    }
    let root = square.abs().sqrt();
    2.0 * mean * if square > 0.0 { root.atan() } else { root.min(1.0).atanh() } / root
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::Pair;
    use crate::placement::track::{RailDistance, WheelDistance};
    use crate::profile::{Profile, standards};

    fn system(rail: &Profile, wheel: &str) -> Result<WheelsetOnTrack> {
        let pair = Pair::new(rail.clone(), standards::wheel(wheel)?, 460.0)?;
        WheelsetOnTrack::new(&pair, RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0))
    }

    #[test]
    fn a_cone_has_its_own_conicity() -> Result<()> {
        let system = system(&standards::rail("60E1")?, "cone-1:20")?;
        let conicity = Conicity::new(&system, 4.0, Roll::Neglect)?;
        for y in [0.03, 0.5, -1.0, 3.999] {
            let found = conicity.at(y).unwrap_or(f64::NAN);
            assert!((found - 0.05).abs() < 1e-9, "{y}: {found}");
        }
        assert_eq!(conicity.at(0.0), None);
        assert_eq!(conicity.at(4.5), None);
        Ok(())
    }

    #[test]
    fn wheel_a_of_en_15302_has_its_published_conicity() -> Result<()> {
        let (sin, cos) = 0.05f64.sin_cos();
        let rail = standards::rail("UIC60")?.rotated(cos, sin).shifted(2.60264, 0.14155);
        let system = system(&rail, "EN15302-A")?;
        let conicity = Conicity::new(&system, 8.0, Roll::Neglect)?;
        // Annex E, case A/A/A, as reproduced by a public benchmark program.
        let table = [
            (1.0, 0.125),
            (2.0, 0.155),
            (3.0, 0.188),
            (4.0, 0.216),
            (5.0, 0.254),
            (6.0, 0.303),
            (7.0, 0.505),
        ];
        for (y, expected) in table {
            let found = conicity.at(y).unwrap_or(f64::NAN);
            assert!((found - expected).abs() < 6e-4, "{y}: {found} is not {expected}");
        }
        Ok(())
    }
}
