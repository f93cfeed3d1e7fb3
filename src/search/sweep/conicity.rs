//! Equivalent conicity by integration of the wheelset's kinematic movement, as in EN 15302.
//!
//! A wheelset that rolls without slip moves by y″ = −Δr(y)/(e r₀), with derivatives along the track and e the distance of
//! the contact points. A cone of conicity γ has Δr = 2y tanγ and Klingel's wavelength λ, λ² = 2π² e r₀/tanγ. The
//! equivalent conicity of any Δr is that of the cone with the same wavelength at the same amplitude:
//! tanγ_e = (π/λ)² 2 e r₀. With v² = 2 ∫_y^ŷ Δr the energy integral gives
//!
//! ```text
//! λ = 4 √(e r₀) T,   T = ∫_0^ŷ dy/v        tanγ_e = π²/(8 T²)
//! ```
//!
//! which does not depend on e and r₀. The yaw is neglected. Where both sides are alike Δr is odd, and a quarter of the movement is
//! enough. Where they are not, the wheelset swings about the displacement y₀ at which Δr = 0, between turning points
//! of equal energy, and ŷ is half their distance, the convention of EN 15302. T is then the mean of the two
//! quarters on either side of y₀. One turning point may be up to 2 ŷ from y₀, and y₀ itself farther from 0 than ŷ.
//!
//! # Effect of errors of Δr
//!
//! An error ε of Δr changes the conicity by the share 2/T ∫_0^ŷ (∫_y^ŷ ε) v⁻³ dy, less than the largest share
//! ∫_y^ŷ ε/∫_y^ŷ Δr over y. So only the integrals of Δr must be right: neither bends of micrometres nor the place
//! of a hop within a cell of 1e-6 mm matters.
//!
//! Δr is continuous except at hops: displacements at which two places of one side touch at once, and the
//! rolling radius jumps from the first place's to the second's. A hop is a root of the difference of two
//! gaps. A search near it returns both gaps and how fast they close; one or two searches locate it.

mod branches;
mod movement;
mod refine;
#[cfg(test)]
mod tests;

use std::fmt;

use branches::{Searched, SideBranches};
use movement::{Movement, Quarter, turning};
use refine::{LEAST_AMPLITUDE, RefinedTable, WIDEST, most_searches};

use crate::error::{Error, Result, finite};
use crate::numerics::interval::Interval;
use crate::search::position::Roll;
use crate::search::wheelset::WheelsetOnTrack;

/// Relative accuracy demanded of a conicity.
pub const ACCURACY: f64 = 1e-4;

/// Most rounds that refine the table, each to half of the last influence, while the estimated error is
/// too large. Amplitudes at which the movement barely comes back never become accurate; they must not use up
/// all searches of the others.
const ROUNDS: u32 = 7;

/// Share of the largest amplitude by which a table grows at a time until the movement turns within it, where Δr is not odd.
const GROWTH: f64 = 1.0 / 8.0;

/// Points in √(y − y_k) of a cell at which T is tabulated: Chebyshev's on \[0, 1\].
const POINTS: [f64; 5] = [
    0.024_471_741_852_423_234,
    0.206_107_373_853_763_43,
    0.5,
    0.793_892_626_146_236_5,
    0.975_528_258_147_576_8,
];

/// Point between [`POINTS`] at which the interpolant is compared with T.
const BETWEEN: f64 = 0.35;
/// Largest relative difference of the interpolant from T at [`BETWEEN`]: a hundredth of [`ACCURACY`].
const AGREEMENT: f64 = 1e-2 * ACCURACY;

/// The equivalent conicity of a wheelset on its track over the lateral amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct Conicity {
    /// The displacement about which the wheelset swings \[mm\]; `None` if there is none.
    centre: Option<f64>,
    /// The movement to the right of the centre; of both sides where Δr is odd.
    right: Swing,
    /// The movement to the left where Δr is not odd.
    left: Option<Swing>,
    searches: usize,
}

/// The movement from the centre to one side.
#[derive(Debug, Clone, PartialEq, Default)]
struct Swing {
    movement: Movement,
    /// For each cell T as a polynomial; `None` where T is no smooth curve.
    fits: Vec<Option<CellFit>>,
}

/// An equivalent conicity with its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equivalent {
    /// tan γ_e \[1\].
    pub conicity: f64,
    /// Estimated relative error \[1\], from the table of Δr, as if the errors of its cells were independent.
    pub error: f64,
}

/// Why there is no equivalent conicity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoConicity {
    /// It was not asked for.
    NotAsked,
    /// The roll is given: the wheelset is held.
    GivenRoll,
    /// The displacement is 0, which is no amplitude.
    NoAmplitude,
    /// A turning point is beyond the table, which ends at those of the amplitude it was made for, or where the wheelset
    /// leaves its track.
    OffTrack,
    /// Δr grows through 0 at no displacement: there is none about which the wheelset swings.
    NoCentre,
    /// The movement does not come back through 0: Δr does not restore there, or turns the movement back on
    /// the way.
    NotRestoring,
}

impl fmt::Display for NoConicity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotAsked => "it was not asked for",
            Self::GivenRoll => "the roll is given: the wheelset is held",
            Self::NoAmplitude => "the amplitude is 0",
            Self::OffTrack => "a wheel leaves its rail before the movement turns",
            Self::NoCentre => "the wheels have equal rolling radii nowhere on the track",
            Self::NotRestoring => "the movement does not come back through the centre",
        })
    }
}

/// T over one cell, in Newton's form in s = √((y − y_k)/(y_(k+1) − y_k)): beyond a jump of Δr, T grows with
/// s.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CellFit {
    differences: [f64; POINTS.len()],
    /// Largest relative error of T over the cell.
    error: f64,
}

impl Equivalent {
    /// Returns whether the estimated error is within [`ACCURACY`].
    pub fn converged(&self) -> bool {
        self.error <= ACCURACY
    }

    fn of(quarter: Quarter) -> Self {
        let conicity = std::f64::consts::PI.powi(2) / (8.0 * quarter.time * quarter.time);
        Self { conicity, error: 2.0 * quarter.error }
    }
}

impl Conicity {
    /// Tabulates Δr up to the largest amplitude ŷ \[mm\]; the table ends earlier if the wheelset leaves the
    /// track.
    ///
    /// `roll`: [`Roll::Neglect`] is the standard's convention, [`Roll::Solve`] the exact geometry.
    /// Accuracy: 1e-4 of the conicity at amplitudes from 0.1 mm on; [`Equivalent::error`] says what was
    /// reached.
    /// Cost: at most [`Conicity::most_searches`], of which a drawn pair takes a fifth, and three times as many where the sides
    /// differ, besides two for every 0.1 mm from 0 to the centre; with [`Roll::Solve`] every search solves the roll.
    ///
    /// # Errors
    /// An amplitude that is not a positive number; a given roll, by which the wheelset is held.
    pub fn new(system: &WheelsetOnTrack, amplitude: f64, roll: Roll) -> Result<Self> {
        Self::told(system, amplitude, roll, &mut |_, _| {})
    }

    /// Tabulates Δr like [`Conicity::new`], and tells `progress` the number of searches done and the most
    /// there will be.
    ///
    /// # Errors
    /// The errors of [`Conicity::new`].
    pub fn told(
        system: &WheelsetOnTrack,
        amplitude: f64,
        roll: Roll,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self> {
        if finite("conicity: amplitude", amplitude)? <= 0.0 {
            let found = amplitude.to_string();
            return Err(Error::new("conicity: amplitude", found, "a positive number", "give it in mm"));
        }
        if let Roll::Fixed(angle) = roll {
            let expected = "roll solved or neglected";
            return Err(Error::new("conicity: roll", angle.to_string(), expected, "leave conicity out"));
        }
        let mut searched = Searched::new(system, roll);
        if system.symmetric() {
            let mut table = RefinedTable::new(|y, sides| searched.at(y, sides), amplitude, ACCURACY)?;
            let right = Swing::refined(&mut table, progress)?;
            let [searches, _] = table.searches();
            return Ok(Self { centre: Some(0.0), right, left: None, searches });
        }
        match searched.centre()? {
            Some(y_0) => Self::about(system, roll, y_0, amplitude, progress),
            None => Ok(Self { centre: None, right: Swing::default(), left: None, searches: 0 }),
        }
    }

    /// Tabulates a Δr that is not odd to both sides of the displacement at which it vanishes \[mm\].
    fn about(
        system: &WheelsetOnTrack,
        roll: Roll,
        centre: f64,
        amplitude: f64,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self> {
        let table = |sign: f64| {
            let mut searched = Searched::new(system, roll);
            let beside = move |u: f64, sides: &mut SideBranches| searched.beside(centre, sign, u, sides);
            RefinedTable::at_centre(beside, ACCURACY)
        };
        let [mut left, mut right] = [table(-1.0)?, table(1.0)?];
        let most = Self::most_searches(amplitude + 2.0 * WIDEST).saturating_mul(3);
        let mut done = 0;
        let mut told = |searches: usize| {
            done += searches;
            progress(done, most);
        };
        reach_turning_points([&mut left, &mut right], amplitude, &mut told)?;
        let mut swing = |table| Swing::refined(table, &mut |_, _| told(1));
        let [to_left, to_right] = [swing(&mut left)?, swing(&mut right)?];
        let searches = left.searches()[0] + right.searches()[0];
        Ok(Self { centre: Some(centre), right: to_right, left: Some(to_left), searches })
    }

    /// Returns the displacement about which the wheelset swings \[mm\], 0 where both sides are alike: that nearest to 0 at which Δr grows
    /// through 0; `None` if there is none on the track.
    pub fn centre(&self) -> Option<f64> {
        self.centre
    }

    /// Returns the most searches that a table up to an amplitude \[mm\] takes where both sides are alike: 15 for
    /// every tenth of a millimetre.
    pub fn most_searches(amplitude: f64) -> usize {
        most_searches(amplitude, ACCURACY)
    }

    /// Returns the number of searches that the table took.
    pub fn searches(&self) -> usize {
        self.searches
    }

    /// Returns tan γ_e at the amplitude |y| \[mm\], or why there is none.
    ///
    /// Method: Δr is straight between the table's displacements. T of such a Δr is a polynomial over each
    /// cell, within 1e-6 of the sum over all cells; where there is no such polynomial, the sum itself is
    /// used. Cost: some ten nanoseconds, or a microsecond; where Δr is not odd, some microseconds.
    ///
    /// # Errors
    /// An amplitude of 0 or beyond the table; a movement that does not come back.
    pub fn at(&self, y: f64) -> std::result::Result<Equivalent, NoConicity> {
        let [to_left, to_right] = self.turns(y)?;
        let Some(left) = &self.left else { return self.right.quarter(to_right).map(Equivalent::of) };
        let [right, left] = [self.right.quarter(to_right)?, left.quarter(to_left)?];
        let time = (right.time + left.time) / 2.0;
        let error = (right.time * right.error).hypot(left.time * left.error) / (2.0 * time);
        Ok(Equivalent::of(Quarter { time, error }))
    }

    /// Returns the displacements between which the wheelset swings with the amplitude |y| \[mm\], 2 |y| apart.
    ///
    /// # Errors
    /// Those of [`Conicity::at`], except that the movement may turn back between them.
    pub fn turning_points(&self, y: f64) -> std::result::Result<Interval, NoConicity> {
        let [to_left, to_right] = self.turns(y)?;
        let centre = self.centre.unwrap_or(0.0);
        Ok(Interval::new(centre - to_left, centre + to_right))
    }

    /// Returns the largest amplitude that has room between the ends of the table \[mm\].
    pub fn largest_amplitude(&self) -> f64 {
        let right = self.right.movement.reach();
        self.left.as_ref().map_or(right, |left| f64::midpoint(left.movement.reach(), right))
    }

    /// Returns the distances of the turning points from the centre, to the left and to the right \[mm\].
    fn turns(&self, y: f64) -> std::result::Result<[f64; 2], NoConicity> {
        let amplitude = y.abs();
        match (&self.centre, &self.left) {
            _ if amplitude.is_nan() || amplitude == 0.0 => Err(NoConicity::NoAmplitude),
            (None, _) => Err(NoConicity::NoCentre),
            (_, None) => Ok([amplitude; 2]),
            (_, Some(left)) => {
                turning([&left.movement, &self.right.movement], amplitude).ok_or(NoConicity::OffTrack)
            }
        }
    }
}

/// Extends the tables to the left and to the right of the centre, always that with less energy, until a movement with this amplitude
/// \[mm\] turns within them, or the wheelset leaves its track on the side with less: all movements that turn before that are within
/// them. Tells `told` the searches of every step.
fn reach_turning_points<F>(
    tables: [&mut RefinedTable<F>; 2],
    amplitude: f64,
    told: &mut dyn FnMut(usize),
) -> Result<()>
where
    F: FnMut(f64, &mut SideBranches) -> Result<bool>,
{
    let mut movements = tables.each_ref().map(|table| Movement::new(table.knots()));
    let mut on_track = [true; 2];
    // What refines the tables further may move the turning points a little.
    while turning(movements.each_ref(), amplitude + WIDEST).is_none() {
        let [left, right] = movements.each_ref().map(|movement| movement.highest_at(f64::INFINITY));
        let short = usize::from(right < left);
        if !on_track[short] {
            break;
        }
        let table = &mut *tables[short];
        let [before, _] = table.searches();
        on_track[short] = table.lengthen(GROWTH * amplitude)?;
        table.refine(ACCURACY, &mut |_, _| {})?;
        told(table.searches()[0] - before);
        movements[short] = Movement::new(table.knots());
    }
    Ok(())
}

impl Swing {
    /// Refines a table round by round until all conicities are accurate, or its searches are used up.
    fn refined<F>(table: &mut RefinedTable<F>, progress: &mut dyn FnMut(usize, usize)) -> Result<Self>
    where
        F: FnMut(f64, &mut SideBranches) -> Result<bool>,
    {
        let mut influence = ACCURACY;
        let mut rounds = 1..ROUNDS;
        loop {
            table.refine(influence, progress)?;
            let movement = Movement::new(table.knots());
            let fits: Vec<_> = (0..movement.cells()).map(|cell| CellFit::new(&movement, cell)).collect();
            let [searches, most] = table.searches();
            let served = |cell: usize| movement.ends(cell).high > LEAST_AMPLITUDE;
            let fine = |fit: &CellFit| 2.0 * fit.error <= ACCURACY;
            let converged =
                fits.iter().enumerate().all(|(cell, fit)| !served(cell) || fit.as_ref().is_none_or(fine));
            if converged || searches >= most || rounds.next().is_none() {
                return Ok(Self { movement, fits });
            }
            influence /= 2.0;
        }
    }

    /// Returns the time of a quarter of the movement with this amplitude \[mm\].
    fn quarter(&self, amplitude: f64) -> std::result::Result<Quarter, NoConicity> {
        let cell = self.movement.cell(amplitude).ok_or(NoConicity::OffTrack)?;
        let quarter = match &self.fits[cell] {
            Some(fit) => Some(fit.at(share(self.movement.ends(cell), amplitude))),
            None => self.movement.quarter(cell, amplitude),
        };
        quarter.ok_or(NoConicity::NotRestoring)
    }
}

/// Returns the square root of the share of a cell that lies below y.
fn share(cell: Interval, y: f64) -> f64 {
    ((y - cell.low) / cell.width()).sqrt()
}

impl CellFit {
    /// Fits T over a cell; `None` over a jump, and where T is no smooth function of s: close to where the
    /// movement does not come back.
    fn new(movement: &Movement, cell: usize) -> Option<Self> {
        let ends = movement.ends(cell);
        let at = |s: f64| {
            let y = ends.low + ends.width() * s * s;
            (y > ends.low).then(|| movement.quarter(cell, y)).flatten()
        };
        let (mut differences, mut error) = ([0.0; POINTS.len()], 0f64);
        for (value, s) in differences.iter_mut().zip(POINTS) {
            let quarter = at(s)?;
            (*value, error) = (quarter.time, error.max(quarter.error));
        }
        for order in 1..POINTS.len() {
            for k in (order..POINTS.len()).rev() {
                differences[k] = (differences[k] - differences[k - 1]) / (POINTS[k] - POINTS[k - order]);
            }
        }
        let fit = Self { differences, error };
        let exact = at(BETWEEN)?.time;
        ((fit.at(BETWEEN).time - exact).abs() <= AGREEMENT * exact).then_some(fit)
    }

    fn at(&self, s: f64) -> Quarter {
        let terms = self.differences.iter().zip(POINTS).rev();
        Quarter { time: terms.fold(0.0, |sum, (c, point)| sum * (s - point) + c), error: self.error }
    }
}
