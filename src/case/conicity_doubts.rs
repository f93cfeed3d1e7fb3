//! What is doubtful about an equivalent conicity: two integrations that differ, and contacts within the movement that are seldom meant.

use super::doubts::{Doubt, DoubtKind, DoubtSet};
use super::landmarks::SideLandmarks;
use super::tally::Tally;
use crate::error::Result;
use crate::search::{
    Conicity, Equivalent, GeometryAt, Position, Roll, TrackSide, TwoStep, WheelsetOnTrack, free,
    geometry_over,
};

/// Step of the displacements \[mm\] where none is given: the widest of EN 15302.
const STEP: f64 = 0.1;

/// Most amplitudes of a sweep at which both integrations are compared.
const MOST_COMPARED: usize = 1000;

/// The contact geometry at equal steps over the displacements that the conicities of a table rest on.
#[derive(Debug, Clone)]
pub struct ConicityBasis<'a> {
    table: &'a Conicity,
    /// Whether the sides differ.
    asymmetric: bool,
    /// Displacements around the centre, without a gap, with contact on both sides.
    found: Vec<GeometryAt>,
    two_step: Option<TwoStep>,
}

impl<'a> ConicityBasis<'a> {
    /// Searches every 0.1 mm between the turning points of the largest amplitude that the table has.
    ///
    /// # Errors
    /// The errors of [`geometry_over`].
    pub fn new(system: &WheelsetOnTrack, table: &'a Conicity, roll: Roll) -> Result<Self> {
        let steps = (table.largest_amplitude() / STEP).floor().max(1.0);
        Self::over(system, table, [STEP * steps, STEP], roll)
    }

    /// Searches at equal steps \[mm\], given with the largest amplitude \[mm\]. Where the sides are alike, up to a step beyond it; where
    /// they differ, to twice the amplitude from the centre, as far as a turning point may be.
    ///
    /// # Errors
    /// The errors of [`geometry_over`].
    pub(super) fn over(
        system: &WheelsetOnTrack,
        table: &'a Conicity,
        [amplitude, step]: [f64; 2],
        roll: Roll,
    ) -> Result<Self> {
        let steps = (amplitude / step).round();
        let (centre, reach) = match table.centre() {
            Some(centre) if !system.symmetric() => ((centre / step).round(), 2.0 * steps),
            _ => (0.0, steps),
        };
        let at = |k: i64| {
            let outside = (k.abs() as f64 - steps).max(0.0);
            let inside = amplitude * (k.abs() as f64 - outside) / steps;
            (inside + step * outside).copysign(k as f64)
        };
        let [first, middle, last] = [centre - reach - 1.0, centre, centre + reach + 1.0].map(|k| k as i64);
        let lateral: Vec<f64> = (first..=last).map(at).collect();
        let found = geometry_over(system, &lateral, roll)?;
        let middle = (middle - first) as usize;
        let from = (0..middle).rev().find(|&k| found[k].is_none()).map_or(0, |k| k + 1);
        let found: Vec<GeometryAt> = found[from..].iter().map_while(|at| *at).collect();
        let (lateral, delta_r): (Vec<f64>, Vec<f64>) =
            found.iter().map(|at| (at.lateral, at.delta_r)).unzip();
        let two_step = (!found.is_empty()).then(|| TwoStep::new(&lateral, &delta_r)).transpose()?;
        Ok(Self { table, asymmetric: !system.symmetric(), found, two_step })
    }

    /// Returns Δr over the displacements, integrated in two steps; `None` of a wheelset without contact at its centre.
    pub(super) fn two_step(&self) -> Option<&TwoStep> {
        self.two_step.as_ref()
    }

    /// Returns whether the sides differ, so that a movement passes other displacements than those within its amplitude from 0.
    pub(super) fn is_asymmetric(&self) -> bool {
        self.asymmetric
    }

    /// Says what is doubtful about the conicities at some amplitudes \[mm\], contacts at the largest of them. `radius` is the nominal
    /// radius of a side \[mm\].
    pub fn doubts(
        &self,
        amplitudes: &[f64],
        landmarks: &SideLandmarks,
        radius: impl Fn(TrackSide) -> f64,
    ) -> Vec<String> {
        let integrations = self.integrations(amplitudes).map(|doubt| doubt.to_string());
        integrations.into_iter().chain(self.contacts(amplitudes, landmarks, radius)).collect()
    }

    /// Gives the doubt about amplitudes \[mm\] at which both integrations differ by more than their errors.
    pub(super) fn integrations(&self, amplitudes: &[f64]) -> Option<Doubt> {
        let two_step = self.two_step.as_ref()?;
        let both = |&amplitude: &f64| {
            Some((amplitude, self.table.at(amplitude).ok()?, two_step.with_error(amplitude).ok()?))
        };
        let off = |one: &Equivalent, two: &Equivalent| {
            (one.conicity - two.conicity).abs() / (one.error * one.conicity + two.error * two.conicity)
        };
        let differing: Vec<_> =
            amplitudes.iter().filter_map(both).filter(|(_, one, two)| off(one, two) > 1.0).collect();
        let (amplitude, one, two) =
            differing.iter().max_by(|a, b| off(&a.1, &a.2).total_cmp(&off(&b.1, &b.2)))?;
        let most = if differing.len() > 1 {
            format!("{} amplitudes, most at ", differing.len())
        } else {
            String::new()
        };
        let found = format!(
            "conicity at {most}{amplitude} mm: {:.4} by the energy integral and {:.4} in two steps differ by more than their errors",
            one.conicity, two.conicity
        );
        Some(Doubt::new(DoubtKind::Integrations, found))
    }

    /// Says the doubts about contacts between the turning points of the largest of some amplitudes \[mm\] that has a conicity.
    pub(super) fn contacts(
        &self,
        amplitudes: &[f64],
        landmarks: &SideLandmarks,
        radius: impl Fn(TrackSide) -> f64,
    ) -> Option<String> {
        let with = amplitudes.iter().copied().filter(|amplitude| self.table.at(*amplitude).is_ok());
        let amplitude = with.max_by(f64::total_cmp)?;
        let turns = self.table.turning_points(amplitude).ok()?;
        let (mut tally, mut all) = (Tally::default(), 0);
        for at in self.within(amplitude) {
            let doubts = landmarks.of_first(at.contacts.each_ref().map(Some));
            let sides = [TrackSide::Left, TrackSide::Right].into_iter().zip(doubts);
            tally.add_sides(sides.map(|(side, doubts)| ((at.lateral * 1e6).round() / 1e6, side, doubts)));
            all += 1;
        }
        let between = format!(" between its turning points at {:.2} and {:.2} mm", turns.low, turns.high);
        tally.said(all, &between, radius).map(|said| format!("conicity at {amplitude} mm: {said}"))
    }

    /// Returns the kinds of doubts about the contacts between the turning points of an amplitude \[mm\].
    pub(crate) fn kinds(&self, amplitude: f64, landmarks: &SideLandmarks) -> DoubtSet {
        let all = self.within(amplitude).map(|at| kinds_at(at, landmarks));
        all.fold(DoubtSet::default(), DoubtSet::with)
    }

    /// Lists the displacements between the turning points of an amplitude \[mm\].
    fn within(&self, amplitude: f64) -> impl Iterator<Item = &GeometryAt> {
        let turns = self.table.turning_points(amplitude).ok();
        self.found.iter().filter(move |at| turns.is_some_and(|turns| turns.contains(at.lateral)))
    }
}

/// Returns the kinds of doubts about the lowest contacts at a displacement.
pub(super) fn kinds_at(at: &GeometryAt, landmarks: &SideLandmarks) -> DoubtSet {
    let [left, right] = landmarks.of_first(at.contacts.each_ref().map(Some));
    left.kinds().with(right.kinds())
}

/// Says what is doubtful about the conicities of a sweep's positions, from the table that they were taken from. Contacts are said where the
/// sides differ: the movement then passes other displacements than those of the sweep.
///
/// # Errors
/// The errors of [`geometry_over`].
pub fn doubts_of_conicities(
    system: &WheelsetOnTrack,
    table: &Conicity,
    positions: &[Position],
    landmarks: &SideLandmarks,
    radius: impl Fn(TrackSide) -> f64,
) -> Result<Vec<String>> {
    let Some(first) = free(positions).next() else { return Ok(Vec::new()) };
    let basis = ConicityBasis::new(system, table, first.roll)?;
    let stride = positions.len().div_ceil(MOST_COMPARED).max(1);
    let mut amplitudes: Vec<f64> =
        free(positions).step_by(stride).map(|position| position.lateral.abs()).collect();
    amplitudes.sort_by(f64::total_cmp);
    amplitudes.dedup();
    if basis.is_asymmetric() {
        return Ok(basis.doubts(&amplitudes, landmarks, radius));
    }
    Ok(basis.integrations(&amplitudes).iter().map(Doubt::to_string).collect())
}
