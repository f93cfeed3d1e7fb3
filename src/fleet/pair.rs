//! A pair: a wheelset on a rail section, and what is computed of it.

use serde::{Deserialize, Serialize};

use super::list::Source;
use super::listed::{Listed, PairNumber};
use super::profiles::{Key, Shelf, data, keys};
use crate::case::{Arrangement, Case, ConicityBasis, Profiles, SideProfiles};
use crate::error::{Error, Result};
use crate::measure::{Measures, Quantity};
use crate::numerics::bodies::Bodies;
use crate::numerics::interval::Interval;
use crate::scene;
use crate::search::{
    AMPLITUDE, Conicity, Equivalent, NONLINEARITY, ONE_CONTACT, Position, Selection, Sweep, TrackSide,
    WheelsetOnTrack, nonlinearity,
};

/// Positions to either side of the centre, and their distance \[mm\]: to 8 mm, where flanges touch.
pub(super) const POSITIONS: i32 = 32;
pub(super) const STEP: f64 = 0.25;
/// Width \[mm\] of the cells on the rail.
pub(super) const CELL: f64 = 0.5;

/// Measures of a wheel that are in the table.
const MEASURES: [Quantity; 6] = [
    Quantity::FlangeHeight,
    Quantity::FlangeThickness,
    Quantity::Qr,
    Quantity::FlangeWidth,
    Quantity::Hollow,
    Quantity::Diameter,
];

/// Names of the sides, in their order.
const SIDES: [&str; 2] = ["left", "right"];

/// A row of the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct FleetRow {
    /// Wheelset, left and right wheel, left and right rail.
    pub names: [String; 5],
    /// Nominal rolling radii of the left and the right wheel \[mm\], where they are known.
    pub radii: [Option<f64>; 2],
    /// The values of [`numbers`], in their order.
    pub values: Vec<Option<f64>>,
    /// What cannot be computed and why, and what is doubtful; empty without either.
    pub finding: String,
    /// The words of the doubts about contacts between the turning points of the conicity at the largest amplitude.
    pub doubt: String,
    #[serde(skip)]
    /// Where its wheels touch: the number of the displacement towards the own rail, and of the cell on the rail.
    pub touched: Vec<[i32; 2]>,
}

/// Names the columns of numbers.
pub(super) fn numbers() -> Vec<String> {
    let of_pair = ["conicity", "conicity_error", "conicity_2mm", "conicity_4mm", "nonlinearity_per_mm"];
    let bands = ["rail_from_mm", "rail_to_mm", "wheel_from_mm", "wheel_to_mm"];
    let of_sides = |of: &[&str]| -> Vec<String> {
        SIDES.iter().flat_map(|side| of.iter().map(move |name| format!("{side}_{name}"))).collect()
    };
    let measures = MEASURES.map(Quantity::key);
    of_pair.map(String::from).into_iter().chain(of_sides(&bands)).chain(of_sides(&measures)).collect()
}

/// Computes the row of a pair. Errors become findings of the row.
pub(super) fn row(fleet: &Listed, shelf: &Shelf, number: PairNumber) -> FleetRow {
    let [rails, wheels] = keys(fleet, number);
    let wheelset = &fleet.wheelsets[number.wheelset];
    let name = |key: &Key| key.source.to_string();
    let mut findings = Vec::new();
    let measures = [0, 1].map(|k| measured(shelf, &wheels[k], SIDES[k], &mut findings));
    let found = case(fleet, shelf, number).and_then(|case| FoundContact::of(fleet, &case));
    let found = found.unwrap_or_else(|error| {
        findings.push(error.to_string());
        FoundContact::default()
    });
    findings.extend(found.findings);
    let mut own: Vec<String> = Vec::new();
    for finding in findings {
        // Both wheels of a file say the same.
        if !own.contains(&finding) {
            own.push(finding);
        }
    }
    let values = found.values.into_iter().chain(measures.into_iter().flatten());
    FleetRow {
        names: [wheelset.name.clone(), name(&wheels[0]), name(&wheels[1]), name(&rails[0]), name(&rails[1])],
        radii: [0, 1].map(|k| radius(fleet, shelf, number, k)),
        values: values.map(|value| value.filter(|value| value.is_finite())).collect(),
        finding: own.join("; "),
        doubt: found.doubt,
        touched: found.touched,
    }
}

/// Returns the measures of a wheel, and adds what is wrong with them to the findings.
fn measured(
    shelf: &Shelf,
    key: &Key,
    side: &str,
    findings: &mut Vec<String>,
) -> [Option<f64>; MEASURES.len()] {
    let Some(measures) = shelf.get(key).ok().and_then(|read| read.measures.as_ref()) else {
        return [None; MEASURES.len()];
    };
    let Measures { findings: own, .. } = measures;
    // Findings of one file for both wheels get one place, so that they are listed once.
    let place = if matches!(&key.source, Source::File(_)) { key.source.to_string() } else { side.to_owned() };
    findings.extend(own.iter().map(|finding| format!("{place}: {finding}")));
    MEASURES.map(|quantity| measures.value(quantity))
}

/// Returns the nominal rolling radius of a wheel \[mm\]: of the table, of the scene, or half the diameter that its file states.
fn radius(fleet: &Listed, shelf: &Shelf, number: PairNumber, side: usize) -> Option<f64> {
    let key = &keys(fleet, number)[1][side];
    let given = fleet.wheelsets[number.wheelset].radii[side];
    let stated = || shelf.get(key).ok()?.record.as_ref()?.diameter.map(|diameter| 0.5 * diameter);
    given.or(data(fleet, key).radius).or(fleet.scene.wheel.radius).or_else(stated)
}

/// Makes the case of a pair.
///
/// # Errors
/// What is wrong with its profiles, or with their place on the track.
pub(super) fn case(fleet: &Listed, shelf: &Shelf, number: PairNumber) -> Result<Case> {
    let [rails, wheels] = keys(fleet, number);
    let side = |k: usize| -> Result<SideProfiles> {
        let [rail, wheel] = [shelf.get(&rails[k])?, shelf.get(&wheels[k])?].map(Clone::clone);
        let radius = radius(fleet, shelf, number, k).ok_or_else(|| {
            let expected = "the nominal rolling radius in mm";
            Error::new(SIDES[k], "no radius", expected, "give `radius` in [wheel], or columns of the table")
        })?;
        let pair = scene::pair_of(&fleet.scene, rail.profile, wheel.profile, radius)?;
        Ok(SideProfiles { pair, measured: Bodies { rail: rail.record, wheel: wheel.record }, varying: None })
    };
    let radii = [0, 1].map(|k| radius(fleet, shelf, number, k));
    let alike = rails[0] == rails[1] && wheels[0] == wheels[1] && radii[0] == radii[1];
    let left = if alike { None } else { Some(side(0)?) };
    let profiles = Profiles { right: side(1)?, left };
    scene::with_profiles(&fleet.scene, profiles, &fleet.wheelsets[number.wheelset].name)
}

/// What was found of the contact of a pair.
struct FoundContact {
    /// Conicities and bands.
    values: Vec<Option<f64>>,
    findings: Vec<String>,
    doubt: String,
    touched: Vec<[i32; 2]>,
}

impl Default for FoundContact {
    fn default() -> Self {
        Self {
            values: vec![None; numbers().len() - 2 * MEASURES.len()],
            findings: Vec::new(),
            doubt: String::new(),
            touched: Vec::new(),
        }
    }
}

impl FoundContact {
    fn of(fleet: &Listed, case: &Case) -> Result<Self> {
        let (system, template) = wheelset(case)?;
        let mut findings = own_warnings(fleet, case);
        let [least, most] = NONLINEARITY;
        let conicity = Conicity::new(system, most, template.roll)?;
        let found = [AMPLITUDE, least, most].map(|amplitude| (amplitude, conicity.at(amplitude)));
        for (amplitude, found) in found {
            findings.extend(found.err().map(|why| format!("no conicity at {amplitude} mm: {why}")));
        }
        let basis = ConicityBasis::new(system, &conicity, template.roll)?;
        let radius = |side| case.profiles().on(Some(side)).pair.wheel_radius();
        findings.extend(basis.doubts(&found.map(|(amplitude, _)| amplitude), case.landmarks(), radius));
        let largest = if found[2].1.is_ok() { most } else { AMPLITUDE };
        let doubt = basis.kinds(largest, case.landmarks()).to_string();
        let [usual, low, high] = found.map(|(_, found)| found.ok());
        let value = |found: Option<Equivalent>| found.map(|found| found.conicity);
        let bands = Bands::of(system, &template)?;
        let mut values = vec![
            value(usual),
            usual.map(|found| found.error),
            value(low),
            value(high),
            nonlinearity(&conicity).ok(),
        ];
        let ends = bands.reach.into_iter().flatten().flat_map(Interval::ends);
        values.extend(ends.map(|x| Some(x).filter(|x| x.is_finite())));
        Ok(Self { values, findings, doubt, touched: bands.touched })
    }
}

/// Returns the wheelset of a case and its position.
///
/// # Errors
/// A case without a wheelset.
pub(super) fn wheelset(case: &Case) -> Result<(&WheelsetOnTrack, Position)> {
    match &case.setup().arrangement {
        Arrangement::Wheelset { system, position } => Ok((system, *position)),
        _ => Err(Error::new("", "a single wheel", "[track] and [wheelset]", "a fleet is of wheelsets")),
    }
}

/// Lists the warnings of a pair without those of the keys of the shared scene, which are given once for all pairs.
fn own_warnings(fleet: &Listed, case: &Case) -> Vec<String> {
    let shared = fleet.warnings();
    case.warnings().into_iter().filter(|warning| !shared.contains(warning)).collect()
}

/// Where the wheels of a pair touch.
struct Bands {
    /// Ranges of the abscissae \[mm\], by side, on rail and wheel, over displacements within ±3 mm.
    reach: [[Interval; 2]; 2],
    touched: Vec<[i32; 2]>,
}

impl Bands {
    fn of(system: &WheelsetOnTrack, template: &Position) -> Result<Self> {
        let mut sweep = Sweep::new(system, Selection { within: 0.0, apart: ONE_CONTACT }, None);
        let mut bands = Self { reach: [[Interval::NONE; 2]; 2], touched: Vec::new() };
        let mut rows = Vec::new();
        for number in -POSITIONS..=POSITIONS {
            rows.clear();
            let lateral = STEP * f64::from(number);
            sweep.position(&Position { lateral, ..*template }, &mut rows)?;
            for row in rows.iter().filter(|row| row.number == 0) {
                let (k, towards) = if row.side == TrackSide::Left { (0, -number) } else { (1, number) };
                // Rails are some 70 mm wide.
                bands.touched.push([towards, (row.contact.rail_x / CELL).floor() as i32]);
                if lateral.abs() <= AMPLITUDE {
                    let [rail, wheel] = bands.reach[k];
                    bands.reach[k] = [rail.with(row.contact.rail_x), wheel.with(row.contact.wheel_x)];
                }
            }
        }
        Ok(bands)
    }
}
