//! Equivalent conicity by integrating the wheelset's equation of motion in two steps over a table of Δr with equal steps, as
//! EN 15302 describes it. The adaptive integration of [`Conicity`](super::Conicity) is checked against it.

use super::conicity::{Equivalent, NoConicity};
use crate::error::{Error, Result, finite};
use crate::numerics::roots::last_where;

/// Distance from a turning point, as a share of that between both, within which entries are left out: rounding of S, some 1e-15 of it,
/// would decide there whether the movement turns back.
const AT_TURN: f64 = 1e-9;

/// Error of the integration as a multiple of the largest change by leaving out every other entry, and as a share of the conicity beside
/// it: of 2520 pairs of drawn wheels of different radii at 1 to 8 mm, 1 errs by more. A jump of Δr can lie in a step so that leaving out
/// its entries changes nothing.
const ERROR: [f64; 2] = [3.0, 0.01];

/// Δr over the lateral displacement, integrated once.
///
/// First step: S(y) = ∫ Δr dy by trapezia; the movement turns at the two displacements 2 ŷ apart that have one S. Second step:
/// x = ∫ dy/ψ with ψ = √(2 (S(ŷ) − S(y))/(e r₀)), each step counted as 2 Δy/(ψ_k + ψ_(k+1)). Half a wavelength is x, and
/// tan γ_e = (π/λ)² 2 e r₀, from which e and r₀ drop out.
///
/// Accuracy: that of the steps. With 0.1 mm a smooth Δr errs by about 1e-3 of the conicity at 3 mm, and a jump of Δr counts as
/// a slope over one step.
///
/// # Examples
/// ```
/// use wheelrail::search::TwoStep;
///
/// let lateral: Vec<f64> = (-40..=40).map(|k| 0.1 * f64::from(k)).collect();
/// let delta_r: Vec<f64> = lateral.iter().map(|y| 0.1 * y).collect(); // a cone of 1:20
/// let conicity = TwoStep::new(&lateral, &delta_r)?.at(3.0).expect("a movement that comes back");
/// assert!((conicity - 0.05).abs() < 1e-3);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TwoStep {
    entries: Entries,
    /// The tables of every other entry, from the first and from the second one on.
    coarser: [Entries; 2],
}

/// The entries of a table, integrated once.
#[derive(Debug, Clone, PartialEq)]
struct Entries {
    lateral: Vec<f64>,
    delta_r: Vec<f64>,
    /// S at the displacements \[mm²\], 0 at the first.
    energy: Vec<f64>,
    /// Largest S between the centre and each displacement \[mm²\].
    highest: Vec<f64>,
    /// The displacement nearest to 0 at which Δr grows through 0 \[mm\], and the number of the first entry above it.
    centre: Option<(f64, usize)>,
}

impl TwoStep {
    /// Integrates a table of Δr \[mm\] over ascending displacements \[mm\] once.
    ///
    /// # Errors
    /// Lists of different lengths; values that are not finite; displacements that do not ascend.
    pub fn new(lateral: &[f64], delta_r: &[f64]) -> Result<Self> {
        if lateral.len() != delta_r.len() {
            let found = format!("{} displacements and {} values of Δr", lateral.len(), delta_r.len());
            return Err(Error::new(
                "conicity",
                found,
                "a value for each displacement",
                "give as many of both",
            ));
        }
        for &value in lateral.iter().chain(delta_r) {
            finite("conicity", value)?;
        }
        if let Some(pair) = lateral.windows(2).find(|pair| pair[0] >= pair[1]) {
            let found = format!("{} mm after {} mm", pair[1], pair[0]);
            return Err(Error::new("conicity", found, "displacements that ascend", "sort them"));
        }
        let every_other = |from: usize| {
            let of = |all: &[f64]| all.iter().skip(from).step_by(2).copied().collect();
            Entries::new(of(lateral), of(delta_r))
        };
        let entries = Entries::new(lateral.to_vec(), delta_r.to_vec());
        Ok(Self { entries, coarser: [every_other(0), every_other(1)] })
    }

    /// Returns tan γ_e at an amplitude ŷ \[mm\], half the distance of the turning points, or why there is none.
    ///
    /// # Errors
    /// An amplitude of 0, or one that the table does not reach to both sides; a movement that does not come back.
    pub fn at(&self, amplitude: f64) -> std::result::Result<f64, NoConicity> {
        self.entries.at(amplitude)
    }

    /// Returns tan γ_e at an amplitude \[mm\] with its estimated error, from what leaving out every other entry changes: infinite where
    /// those that are left do not reach so far.
    ///
    /// # Errors
    /// Those of [`TwoStep::at`].
    pub fn with_error(&self, amplitude: f64) -> std::result::Result<Equivalent, NoConicity> {
        let conicity = self.at(amplitude)?;
        let change = |coarser: &Entries| match coarser.at(amplitude) {
            Ok(other) => (other / conicity - 1.0).abs(),
            Err(_) => f64::INFINITY,
        };
        let [multiple, beside] = ERROR;
        let largest = self.coarser.iter().map(change).fold(0.0, f64::max);
        Ok(Equivalent { conicity, error: multiple * largest + beside })
    }
}

impl Entries {
    fn new(lateral: Vec<f64>, delta_r: Vec<f64>) -> Self {
        let mut energy = Vec::with_capacity(lateral.len());
        let mut sum = 0.0;
        for k in 0..lateral.len() {
            if k > 0 {
                sum += (lateral[k] - lateral[k - 1]) * (delta_r[k] + delta_r[k - 1]) / 2.0;
            }
            energy.push(sum);
        }
        let centre = centre(&lateral, &delta_r);
        let mut highest = energy.clone();
        if let Some((_, above)) = centre {
            (above + 1..highest.len()).for_each(|k| highest[k] = highest[k].max(highest[k - 1]));
            (1..above).rev().for_each(|k| highest[k - 1] = highest[k - 1].max(highest[k]));
        }
        Self { lateral, delta_r, energy, highest, centre }
    }

    fn at(&self, amplitude: f64) -> std::result::Result<f64, NoConicity> {
        if amplitude <= 0.0 {
            return Err(NoConicity::NoAmplitude);
        }
        let centre = self.centre.ok_or(NoConicity::NoCentre)?;
        let [low, high] =
            [self.lateral.first(), self.lateral.last()].map(|end| end.copied().unwrap_or(f64::NAN));
        let span = 2.0 * amplitude;
        let [from, to] = [centre.0.max(low + span), (centre.0 + span).min(high)];
        // The movements of all energies about the centre lie in each other: with the right turning point the left one moves inward.
        let within = |right: f64| self.highest_at(centre, right) <= self.highest_at(centre, right - span);
        if from > to || !within(from) || within(to) {
            return Err(NoConicity::OffTrack);
        }
        let right = last_where(within, from, to);
        let half = self.half_wave(right - span, right).ok_or(NoConicity::NotRestoring)?;
        Ok(std::f64::consts::PI.powi(2) / (2.0 * half * half))
    }

    /// Returns x between the turning points, times √(e r₀); `None` if the movement turns back between them.
    fn half_wave(&self, left: f64, right: f64) -> Option<f64> {
        let total = f64::midpoint(self.energy_at(left), self.energy_at(right));
        let margin = AT_TURN * (right - left);
        let between = |y: &f64| left + margin < *y && *y < right - margin;
        let inside = self.lateral.iter().zip(&self.energy).filter(|(y, _)| between(y));
        let (mut x, mut last, mut speed) = (0.0, left, 0.0);
        for (&y, &energy) in inside {
            let square = 2.0 * (total - energy);
            if square <= 0.0 {
                return None;
            }
            let next = square.sqrt();
            x += 2.0 * (y - last) / (speed + next);
            (last, speed) = (y, next);
        }
        let half = x + 2.0 * (right - last) / speed;
        half.is_finite().then_some(half)
    }

    /// Returns S at a displacement within the table \[mm²\], for a Δr that is straight between its entries.
    fn energy_at(&self, y: f64) -> f64 {
        let k = self.lateral.partition_point(|known| *known <= y).saturating_sub(1);
        let Some(&next) = self.lateral.get(k + 1) else { return self.energy[k] };
        let (run, width) = (y - self.lateral[k], next - self.lateral[k]);
        let slope = (self.delta_r[k + 1] - self.delta_r[k]) / width;
        self.energy[k] + run * (self.delta_r[k] + slope * run / 2.0)
    }

    /// Returns the largest S between the centre and a displacement within the table \[mm²\].
    fn highest_at(&self, (centre, above): (f64, usize), y: f64) -> f64 {
        let between = if y < centre {
            let first = self.lateral.partition_point(|known| *known < y);
            (first < above).then_some(first)
        } else {
            let last = self.lateral.partition_point(|known| *known <= y);
            (last > above).then(|| last - 1)
        };
        between.map_or(f64::NEG_INFINITY, |k| self.highest[k]).max(self.energy_at(y))
    }
}

/// Returns where Δr grows through 0, nearest to 0, and the number of the first entry above it.
fn centre(lateral: &[f64], delta_r: &[f64]) -> Option<(f64, usize)> {
    let crossing = |k: usize| {
        let [from, to] = [delta_r[k], delta_r[k + 1]];
        let share = if to > from { -from / (to - from) } else { 0.0 };
        (lateral[k] + share * (lateral[k + 1] - lateral[k]), k + 1)
    };
    let grows =
        |k: &usize| delta_r[*k] <= 0.0 && delta_r[k + 1] > 0.0 || delta_r[*k] < 0.0 && delta_r[k + 1] >= 0.0;
    let all = (0..lateral.len().saturating_sub(1)).filter(grows).map(crossing);
    all.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
}
