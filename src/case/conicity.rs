//! The contact geometry of a wheelset on its track by EN 15302: functions of the lateral displacement, key figures, a map over gauge
//! and amplitude, and how far noise of the measurement moves them.

use rayon::prelude::*;
use serde::Serialize;

use super::conicity_doubts::{ConicityBasis, kinds_at};
use super::conicity_noise::{Noise, Uncertainty, uncertainty};
use super::doubts::DoubtSet;
use super::input::{Arrangement, Case};
use super::landmarks::{Landmarks, SideLandmarks};
use super::tally::Tally;
use crate::error::{Error, ErrorKind, Result, finite, in_order};
use crate::placement::Pair;
use crate::profile::trace;
use crate::search::{
    AMPLITUDE, Conicity, ContactBand, GeometryAt, KeyFigures, NONLINEARITY, NoConicity, Roll, TrackSide,
    TwoStep, WheelsetOnTrack, active_faces, gauge, geometry_over,
};

/// Columns of the functions over the lateral displacement, with their definitions. Names that a sweep has mean the same there, except
/// `roll_rad` where the roll is neglected: a sweep then has 0.
pub const FUNCTIONS: [(&str, &str); 17] = [
    ("lateral_mm", "lateral displacement y of the middle of the axle, + to the right"),
    (
        "roll_rad",
        "roll, + lowers the right-hand wheel: solved, or from the heights at which the two sides touch",
    ),
    ("delta_r_mm", "rolling radius difference: right less left"),
    (
        "conicity",
        "equivalent conicity tan gamma_e at the amplitude |y|, by the energy integral, adaptive in y",
    ),
    ("conicity_error", "estimated relative error of conicity"),
    (
        "conicity_two_step",
        "the same by two-step integration of y'' = -delta_r/(e r0) over the steps of this table",
    ),
    ("conicity_difference", "conicity_two_step less conicity"),
    ("delta_tan_gamma", "contact angle difference: tan gamma right less left"),
    (
        "curve_radius_m",
        "radius of the curve in which this delta_r rolls without slip: e r0/|delta_r|, e the distance of the contacts",
    ),
    ("left_rail_x_mm", "left contact on the rail's profile, + to the field side"),
    ("left_wheel_x_mm", "left contact on the wheel's profile, + to the field side"),
    ("left_contact_angle_rad", "left contact angle, + at a flange"),
    ("left_rolling_radius_mm", "left rolling radius"),
    ("right_rail_x_mm", "right contact on the rail's profile, + to the field side"),
    ("right_wheel_x_mm", "right contact on the wheel's profile, + to the field side"),
    ("right_contact_angle_rad", "right contact angle, + at a flange"),
    ("right_rolling_radius_mm", "right rolling radius"),
];

/// The column of doubts beside [`FUNCTIONS`], with its definition.
pub const DOUBT: (&str, &str) = (
    "doubt",
    "what is possible at the contacts of this displacement but seldom meant, by words with a space between two",
);

/// Key figures with their definitions.
pub const KEY_FIGURES: [(&str, &str); 17] = [
    ("conicity_3mm", "equivalent conicity tan gamma_e at 3 mm, by the energy integral"),
    ("conicity_3mm_error", "its estimated relative error"),
    ("conicity_3mm_two_step", "the same by two-step integration"),
    ("conicity_3mm_difference", "conicity_3mm_two_step less conicity_3mm"),
    ("nonlinearity_per_mm", "nonlinearity parameter: (conicity at 4 mm less that at 2 mm)/2 mm"),
    ("gauge_mm", "track gauge TG within 14 mm below the top of rail"),
    ("active_faces_mm", "distance SR of the flanges' faces 10 mm outside of the running circles"),
    ("clearance_mm", "TG - SR"),
    ("centre_mm", "displacement at which delta_r vanishes, about which the wheelset swings"),
    ("left_rail_from_mm", "contact band on the left rail over 3 mm to both sides of the centre: least x"),
    ("left_rail_to_mm", "largest x"),
    ("left_wheel_from_mm", "contact band on the left wheel: least x"),
    ("left_wheel_to_mm", "largest x"),
    ("right_rail_from_mm", "contact band on the right rail: least x"),
    ("right_rail_to_mm", "largest x"),
    ("right_wheel_from_mm", "contact band on the right wheel: least x"),
    ("right_wheel_to_mm", "largest x"),
];

/// Largest number of displacements to one side, and of gauges: the cost of the two-step integration grows with its square.
const MOST: usize = 10_000;

/// Largest amplitude \[mm\]: no wheel moves so far over its rail.
const FARTHEST: f64 = 1000.0;

/// Step of the amplitudes of the map \[mm\].
const MAP_STEP: f64 = 0.5;

/// What is asked of the contact geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct ConicityOptions {
    /// Largest displacement and amplitude \[mm\].
    pub amplitude: f64,
    /// Step of the displacements \[mm\]; EN 15302 has at most 0.1.
    pub step: f64,
    /// Changes of the gauge of the map \[mm\].
    pub gauges: Vec<f64>,
    /// Noise of the measurement; `None` asks for no uncertainty.
    pub noise: Option<Noise>,
}

impl Default for ConicityOptions {
    fn default() -> Self {
        Self { amplitude: 8.0, step: 0.1, gauges: (-5..=15).map(f64::from).collect(), noise: None }
    }
}

/// Equivalent conicity over gauge and amplitude.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConicityMap {
    /// Changes of the gauge \[mm\].
    pub gauge_change_mm: Vec<f64>,
    /// Gauges \[mm\]; NaN where the track's is not known.
    pub gauge_mm: Vec<f64>,
    /// Amplitudes \[mm\].
    pub amplitude_mm: Vec<f64>,
    /// Equivalent conicity, a list of all amplitudes for each gauge; NaN where there is none.
    pub conicity: Vec<Vec<f64>>,
}

/// The contact geometry of a wheelset on its track.
#[derive(Debug, Clone, PartialEq)]
pub struct ConicityReport {
    /// The values of each of [`FUNCTIONS`] over the displacements; NaN where there is none.
    pub functions: [Vec<f64>; FUNCTIONS.len()],
    /// The doubts about the lowest contacts at each displacement.
    pub doubts: Vec<DoubtSet>,
    /// The values of [`KEY_FIGURES`]; NaN where there is none.
    pub key_figures: [f64; KEY_FIGURES.len()],
    /// Equivalent conicity over gauge and amplitude.
    pub map: ConicityMap,
    /// How far noise moves the figures, if it is given.
    pub uncertainty: Option<Uncertainty>,
    /// What cannot be had, and what is not plausible.
    pub findings: Vec<String>,
    /// The table of Δr that the conicities come from.
    pub(super) table: Conicity,
    /// How the roll was found.
    pub(super) roll: Roll,
}

impl ConicityReport {
    /// Gives a column of the functions; empty of an unknown one.
    pub fn function(&self, name: &str) -> &[f64] {
        let index = FUNCTIONS.iter().position(|(own, _)| *own == name);
        index.map_or(&[], |index| &self.functions[index])
    }

    /// Gives a key figure; `None` where there is none.
    pub fn key_figure(&self, name: &str) -> Option<f64> {
        let index = KEY_FIGURES.iter().position(|(own, _)| *own == name)?;
        Some(self.key_figures[index]).filter(|value| !value.is_nan())
    }
}

/// Finds the contact geometry of the wheelset of a case; its yaw and its displacement are not used, its roll is solved or neglected as
/// the case says. `told` gets the name of each step.
///
/// # Errors
/// A case without wheelset, or with bodies that vary; a given roll; options without meaning; samples of which none can be computed.
pub fn conicity(case: &Case, options: &ConicityOptions, told: &dyn Fn(&str)) -> Result<ConicityReport> {
    let Arrangement::Wheelset { system, position } = &case.setup().arrangement else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new(
            "",
            "a single wheel",
            expected,
            "conicity is that of a wheelset on its track",
        ));
    };
    case.profiles().swept("give it one section")?;
    let pairs = [TrackSide::Left, TrackSide::Right].map(|side| &case.profiles().on(Some(side)).pair);
    let mut report = contact_geometry(system, pairs, position.roll, options, told)?;
    report.findings.extend(points_apart(case));
    report.findings.extend(case.warnings());
    Ok(report)
}

/// Finds the contact geometry of a wheelset on its track; `pairs` are those of the left and the right side. See [`conicity`].
///
/// It runs on the threads of the current rayon pool; any number of threads gives the same bits.
///
/// # Errors
/// The errors of [`conicity`].
pub fn contact_geometry(
    system: &WheelsetOnTrack,
    pairs: [&Pair; 2],
    roll: Roll,
    options: &ConicityOptions,
    told: &dyn Fn(&str),
) -> Result<ConicityReport> {
    let lateral = options.displacements()?;
    told("rolling radius difference");
    // The nonlinearity parameter needs 4 mm, whatever is asked for.
    let table = Conicity::new(system, options.amplitude.max(4.0), roll)?;
    let found = geometry_over(system, &lateral, roll)?;
    let basis = ConicityBasis::over(system, &table, [options.amplitude, options.step], roll)?;
    let functions = functions(system, &lateral, &found, &table, basis.two_step());
    let (key_figures, mut findings) = key_figures(system, pairs, &table, basis.two_step(), roll)?;
    let marks = |pair: &Pair| Landmarks::new(pair);
    let landmarks = SideLandmarks::new(marks(pairs[1]), Some(marks(pairs[0])));
    let doubts =
        found.iter().map(|at| at.map_or(DoubtSet::default(), |at| kinds_at(&at, &landmarks))).collect();
    told("map over the gauge");
    let map = map(system, options, roll, gauge(system, pairs).unwrap_or(f64::NAN))?;
    let uncertainty = match &options.noise {
        None => None,
        Some(noise) => {
            noise.validate()?;
            told("samples of the noise");
            Some(uncertainty(system, pairs, roll, noise)?)
        }
    };
    findings.extend(reach(&lateral, &found));
    findings.extend(missing(&found, &table));
    findings.extend(doubted(&lateral, &found, &basis, (&landmarks, pairs)));
    findings.extend(uncertainty.iter().flat_map(Uncertainty::findings));
    Ok(ConicityReport { functions, doubts, key_figures, map, uncertainty, findings, table, roll })
}

/// Says at how many displacements with contact there is no conicity, by reasons.
fn missing(found: &[Option<GeometryAt>], table: &Conicity) -> Vec<String> {
    let mut by_reason: Vec<(NoConicity, Vec<f64>)> = Vec::new();
    for lateral in found.iter().flatten().map(|at| at.lateral).filter(|lateral| *lateral > 0.0) {
        let Err(why) = table.at(lateral) else { continue };
        match by_reason.iter_mut().find(|(known, _)| *known == why) {
            Some((_, all)) => all.push(lateral),
            None => by_reason.push((why, vec![lateral])),
        }
    }
    let said = |(why, all): &(NoConicity, Vec<f64>)| match all.as_slice() {
        [first, .., last] => {
            format!("no conicity at {} amplitudes, {first:.3} to {last:.3} mm: {why}", all.len())
        }
        all => format!("no conicity at an amplitude of {:.3} mm: {why}", all.first().unwrap_or(&f64::NAN)),
    };
    by_reason.iter().map(said).collect()
}

/// Says the doubts about both integrations and about contacts: at the displacements of the functions, and within the movements of the key
/// figures and, where the sides differ, of the largest amplitude, which reach other displacements.
fn doubted(
    lateral: &[f64],
    found: &[Option<GeometryAt>],
    basis: &ConicityBasis<'_>,
    (landmarks, pairs): (&SideLandmarks, [&Pair; 2]),
) -> Vec<String> {
    let radius = |side| pairs[usize::from(side == TrackSide::Right)].wheel_radius();
    let mut tally = Tally::default();
    for at in found.iter().flatten() {
        let sides = [TrackSide::Left, TrackSide::Right].into_iter();
        let doubts = sides.zip(landmarks.of_first(at.contacts.each_ref().map(Some)));
        tally.add_sides(doubts.map(|(side, doubts)| (at.lateral, side, doubts)));
    }
    let amplitudes: Vec<f64> = lateral.iter().copied().filter(|lateral| *lateral > 0.0).collect();
    let mut out = basis.doubts(&[AMPLITUDE, NONLINEARITY[1]], landmarks, radius);
    let further = basis.integrations(&amplitudes).map(|doubt| doubt.to_string());
    out.extend(further.filter(|said| !out.contains(said)));
    if basis.is_asymmetric() {
        out.extend(basis.contacts(&amplitudes, landmarks, radius));
    }
    out.extend(tally.line(found.len(), radius));
    out
}

impl ConicityOptions {
    /// Lists the displacements, both ends included.
    fn displacements(&self) -> Result<Vec<f64>> {
        for (name, value) in [("conicity: amplitude", self.amplitude), ("conicity: step", self.step)] {
            if finite(name, value)? <= 0.0 {
                return Err(Error::new(name, value.to_string(), "a positive number", "give it in mm"));
            }
        }
        if self.amplitude > FARTHEST {
            let (found, expected) = (self.amplitude.to_string(), format!("at most {FARTHEST} mm"));
            return Err(Error::new("conicity: amplitude", found, expected, "take a smaller one"));
        }
        let steps = (self.amplitude / self.step).round();
        if steps > MOST as f64 || self.gauges.len() > MOST {
            let found = format!("{} displacements and {} gauges", 2.0 * steps + 1.0, self.gauges.len());
            let expected = format!("at most {} displacements and {MOST} gauges", 2 * MOST + 1);
            let error = Error::new("conicity", found, expected, "take larger steps");
            return Err(error.of_kind(ErrorKind::Limit));
        }
        if steps < 1.0 {
            let found = self.step.to_string();
            return Err(Error::new(
                "conicity: step",
                found,
                "a step within the amplitude",
                "take a smaller step",
            ));
        }
        let steps = steps as i64;
        Ok((-steps..=steps).map(|k| self.amplitude * k as f64 / steps as f64).collect())
    }
}

/// Gives the columns of the functions.
fn functions(
    system: &WheelsetOnTrack,
    lateral: &[f64],
    found: &[Option<GeometryAt>],
    table: &Conicity,
    two_step: Option<&TwoStep>,
) -> [Vec<f64>; FUNCTIONS.len()] {
    let mut columns = [const { Vec::new() }; FUNCTIONS.len()];
    for (&lateral, at) in lateral.iter().zip(found) {
        let equivalent = at.and_then(|_| table.at(lateral).ok());
        let conicity = equivalent.map_or(f64::NAN, |found| found.conicity);
        let other = at.and_then(|_| two_step?.at(lateral.abs()).ok()).unwrap_or(f64::NAN);
        let of = |value: fn(&GeometryAt) -> f64| at.as_ref().map_or(f64::NAN, value);
        let row = [
            lateral,
            of(|at| at.roll),
            of(|at| at.delta_r),
            conicity,
            equivalent.map_or(f64::NAN, |found| found.error),
            other,
            other - conicity,
            of(|at| at.delta_tan_gamma),
            at.as_ref().map_or(f64::NAN, |at| curve_radius(system, at)),
            of(|at| at.contacts[0].rail_x),
            of(|at| at.contacts[0].wheel_x),
            of(|at| at.contacts[0].contact_angle),
            of(|at| at.contacts[0].rolling_radius),
            of(|at| at.contacts[1].rail_x),
            of(|at| at.contacts[1].wheel_x),
            of(|at| at.contacts[1].contact_angle),
            of(|at| at.contacts[1].rolling_radius),
        ];
        for (column, value) in columns.iter_mut().zip(row) {
            column.push(value);
        }
    }
    columns
}

/// Gives the radius of the curve \[m\] in which a wheelset rolls without slip; NaN where Δr is 0: straight on.
fn curve_radius(system: &WheelsetOnTrack, at: &GeometryAt) -> f64 {
    let [left, right] = at.contacts;
    let distance =
        system.left().track().rail_x() + system.right().track().rail_x() + left.rail_x + right.rail_x;
    let radius = f64::midpoint(left.rolling_radius, right.rolling_radius);
    if at.delta_r == 0.0 { f64::NAN } else { distance * radius / at.delta_r.abs() / 1e3 }
}

/// Gives the key figures, and says why some do not exist.
fn key_figures(
    system: &WheelsetOnTrack,
    pairs: [&Pair; 2],
    table: &Conicity,
    two_step: Option<&TwoStep>,
    roll: Roll,
) -> Result<([f64; KEY_FIGURES.len()], Vec<String>)> {
    let mut findings = Vec::new();
    let figures = KeyFigures::new(system, table, roll)?;
    let mut known = |what: &str, found: std::result::Result<f64, NoConicity>| {
        found.unwrap_or_else(|why| {
            findings.push(format!("no {what}: {why}"));
            f64::NAN
        })
    };
    let conicity = known("conicity at 3 mm", figures.conicity.map(|found| found.conicity));
    let nonlinear = known("nonlinearity parameter", figures.nonlinearity);
    let (gauge, faces) = (gauge(system, pairs), active_faces(system, pairs));
    let clearance = gauge.zip(faces).map(|(gauge, faces)| gauge - faces);
    let other = two_step.and_then(|table| table.at(AMPLITUDE).ok()).unwrap_or(f64::NAN);
    let nan = f64::NAN;
    let missing = ContactBand { rail_x: [nan; 2].into(), wheel_x: [nan; 2].into() };
    let [left, right] = figures.bands.unwrap_or([missing; 2]);
    let [gauge, faces, clearance] = [gauge, faces, clearance].map(|value| value.unwrap_or(nan));
    if clearance.is_nan() {
        findings.push("no clearance: a profile ends above the gauge face or the flange's face".into());
    } else if !USUAL_CLEARANCE.contains(&clearance) {
        findings.push(format!("a clearance TG - SR of {clearance:.2} mm: check gauge and wheel distance"));
    }
    let error = figures.conicity.map_or(nan, |found| found.error);
    let figures = [
        conicity,
        error,
        other,
        other - conicity,
        nonlinear,
        gauge,
        faces,
        clearance,
        figures.centre.unwrap_or(nan),
        left.rail_x.low,
        left.rail_x.high,
        left.wheel_x.low,
        left.wheel_x.high,
        right.rail_x.low,
        right.rail_x.high,
        right.wheel_x.low,
        right.wheel_x.high,
    ];
    Ok((figures, findings))
}

/// Clearances of railways \[mm\]: from wheels that just fit to worn flanges in a curve with widened gauge.
const USUAL_CLEARANCE: std::ops::RangeInclusive<f64> = 0.0..=40.0;

/// Says up to where both wheels touch, if that is less than what is asked for.
fn reach(lateral: &[f64], found: &[Option<GeometryAt>]) -> Option<String> {
    let missing = lateral.iter().zip(found).filter(|(_, at)| at.is_none()).map(|(y, _)| y.abs());
    let nearest = missing.fold(f64::INFINITY, f64::min);
    nearest.is_finite().then(|| format!("no contact on both sides from {nearest} mm on"))
}

/// Tabulates the conicity over gauge and amplitude.
fn map(system: &WheelsetOnTrack, options: &ConicityOptions, roll: Roll, gauge: f64) -> Result<ConicityMap> {
    let steps = (options.amplitude / MAP_STEP).floor().max(1.0) as usize;
    let amplitude_mm: Vec<f64> = (1..=steps).map(|k| (MAP_STEP * k as f64).min(options.amplitude)).collect();
    let row = |&change: &f64| {
        let table = Conicity::new(&system.widened(change)?, options.amplitude, roll)?;
        Ok(amplitude_mm.iter().map(|y| table.at(*y).map_or(f64::NAN, |found| found.conicity)).collect())
    };
    let conicity = in_order(options.gauges.par_iter().map(row))?;
    let gauge_mm = options.gauges.iter().map(|change| gauge + change).collect();
    Ok(ConicityMap { gauge_change_mm: options.gauges.clone(), gauge_mm, amplitude_mm, conicity })
}

/// Longest mean distance \[mm\] of measured points that is not doubted: smoothing halves waves of 5 mm, which fewer than five points do
/// not describe.
const FARTHEST_POINTS: f64 = 1.0;

/// Names measured profiles whose points are far apart.
fn points_apart(case: &Case) -> Vec<String> {
    let mut out = Vec::new();
    for (side, profiles) in case.profiles().sides() {
        let bodies = profiles.measured.both().into_iter().zip([profiles.pair.rail(), profiles.pair.wheel()]);
        for (record, profile) in bodies {
            let Some(record) = record else { continue };
            let length = trace(profile, FARTHEST_POINTS).last().map_or(0.0, |mark| mark.s);
            let apart = length / (record.points_used.max(2) - 1) as f64;
            if apart > FARTHEST_POINTS {
                let side = side.map_or_else(String::new, |side| format!("{side} side: "));
                out.push(format!("{side}{}: points {apart:.2} mm apart in the mean", profile.title()));
            }
        }
    }
    out
}
