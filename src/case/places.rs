//! The contacts of a case: the chosen one, or those that a search finds.

use std::time::Instant;

use rayon::prelude::*;

use super::contact::PlacedContact;
use super::found::{Found, ListedContact};
use super::input::{ApproachBy, Arrangement, Case, FrameOrigin, RollByLoad};
use super::overlaps::RegionRules;
use super::wheel::{ContactRegion, OnLoft, SinkingWheel, carry, placed_at};
use crate::error::{Error, Result};
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::search;
use crate::search::{NoConicity, ONE_CONTACT, Position, Roll, Selection, SweepRow, TrackSide};

/// Vertical gaps \[mm\] up to which places of contact are searched at least, the second only where the first do not carry the load:
/// most loads close gaps of 1 mm at most, and no load that steel bears closes 10 mm.
const SEARCHED_GAPS: [f64; 2] = [1.0, 10.0];

/// Vertical displacement of a wheel for an approach of 1 along the normal of a flange of 75°; flanges are not steeper.
const STEEPEST: f64 = 4.0;

/// Largest number of contacts of one wheel, and of parts of one patch. More are due to rough profiles, and each would have a folder.
pub(super) const MOST_PARTS: usize = 100;

/// A side of the track, or a single wheel, at first touch.
struct TouchedSide {
    /// `None` of a single wheel.
    side: Option<TrackSide>,
    height: f64,
    roll: f64,
    /// The places of contact, the lowest gap first.
    places: Vec<search::Contact>,
}

/// Places the pair at every contact of a case, the first one first, with their names. It computes no grid, and only the patches that tell
/// contacts apart and the pressures that carry a load.
///
/// # Errors
/// No contact, or more than are listed; a load that no approach carries.
pub fn contacts(case: &Case) -> Result<Vec<(String, Placement)>> {
    // A chosen contact is one whatever the approach.
    let chosen = matches!(case.setup.arrangement, Arrangement::Points { .. });
    let placed = find(case, case.question.approach.filter(|_| !chosen))?;
    Ok(placed.into_iter().map(|contact| (contact.name(), contact.placement)).collect())
}

/// Returns the approach \[mm\] along the normal of a contact that carries a vertical load \[N\] alone, with all parts of its patch;
/// `modulus` is E* \[N/mm²\].
///
/// # Errors
/// A load that no approach carries.
pub fn approach_under_load(placement: &Placement, load: f64, modulus: f64) -> Result<f64> {
    let pair = placement.pair();
    let rules = RegionRules { merge: 0.0, spacing: None, alone: true, frame: FrameOrigin::Contact };
    let wheel = SinkingWheel::at_points(&pair, placement.clone(), rules);
    let [.., most] = SEARCHED_GAPS;
    let carried = carry(&mut [wheel], load, modulus, most)?;
    let first = carried.and_then(|mut wheels| wheels.pop()?.pop());
    first.map(|region| region.approach).ok_or_else(|| unborne("load", load, None))
}

/// Finds all contacts of a case under an approach or load, the first one first, with what each carries.
///
/// # Errors
/// No contact, or more than are listed; a load that no approach carries.
pub fn find(case: &Case, approach: Option<ApproachBy>) -> Result<Vec<PlacedContact>> {
    let modulus = case.question.modulus();
    let Arrangement::Points { rail_x, wheel_x } = &case.setup.arrangement else {
        return search(case, approach);
    };
    let placement = case.profiles.right.pair.placed(*rail_x, *wheel_x, 0.0)?;
    let start = Instant::now();
    let contact = match approach {
        None => PlacedContact::new(placement, None, modulus)?,
        Some(ApproachBy::Given(approach)) if case.question.frame != FrameOrigin::Weighted => {
            PlacedContact::new(placement, Some(approach), modulus)?
        }
        Some(by) => {
            let mut wheel =
                SinkingWheel::at_points(&case.profiles.right.pair, placement, rules(case, by, true));
            let [.., most] = SEARCHED_GAPS;
            let mut regions = match by {
                ApproachBy::Given(approach) => wheel.regions(approach)?,
                ApproachBy::WheelLoad(load)
                | ApproachBy::WheelLoads { right: load, .. }
                | ApproachBy::AxleLoad(load) => {
                    let carried = carry(&mut [wheel], load, modulus, most)?;
                    carried.ok_or_else(|| too_heavy(case, None))?.swap_remove(0)
                }
            };
            PlacedContact::of(regions.swap_remove(0), modulus, start.elapsed().as_secs_f64())?
        }
    };
    Ok(vec![contact])
}

/// Lets a search find the contacts of a wheel or a wheelset.
fn search(case: &Case, approach: Option<ApproachBy>) -> Result<Vec<PlacedContact>> {
    let (sides, regions, load_s) = closed(case, approach)?;
    let contacts = sides.iter().zip(regions).map(|(side, regions)| side.contacts(case, regions, load_s));
    contacts.collect::<Result<Vec<_>>>().map(|all| all.into_iter().flatten().collect())
}

/// Finds the places of a wheelset's contact under the loads of a case, the left side's first: those that have a region, with it, and those
/// within the largest gap of near misses.
///
/// # Errors
/// No contact; a load that no approach carries; no roll that the loads settle at.
pub(super) fn rows_under_load(case: &Case) -> Result<Vec<(SweepRow, Option<ContactRegion>)>> {
    let Arrangement::Wheelset { position, .. } = &case.setup.arrangement else { return Ok(Vec::new()) };
    let (sides, regions, _) = closed(case, case.question.approach)?;
    let radius =
        |k: usize| sides.get(k).and_then(|side| side.places.first()).map_or(f64::NAN, |at| at.rolling_radius);
    let delta_r = radius(0) - radius(1);
    let mut rows = Vec::new();
    for (side, mut regions) in sides.iter().zip(regions).rev() {
        let held: Vec<usize> = regions.iter().map(|region| region.place).collect();
        let reached =
            |(k, place): &(usize, &search::Contact)| place.gap <= case.setup.within || held.contains(k);
        for (number, (k, place)) in side.places.iter().enumerate().filter(reached).enumerate() {
            let row = SweepRow {
                lateral: position.lateral,
                yaw: position.yaw,
                roll: side.roll,
                side: side.side.unwrap_or(TrackSide::Right),
                number,
                z: side.height,
                contact: *place,
                delta_r,
                conicity: Err(NoConicity::NotAsked),
            };
            let own = regions.iter().position(|region| region.place == k);
            rows.push((row, own.map(|at| regions.swap_remove(at))));
        }
    }
    Ok(rows)
}

/// Lowers the wheels of a case and lets them sink: the sides, the regions of each, and the seconds that a load took.
fn closed(
    case: &Case,
    approach: Option<ApproachBy>,
) -> Result<(Vec<TouchedSide>, Vec<Vec<ContactRegion>>, f64)> {
    let nearest = case.setup.within.max(match approach {
        Some(ApproachBy::Given(approach)) => STEEPEST * approach,
        _ => 0.0,
    });
    let mut heavy = None;
    for most in SEARCHED_GAPS {
        let start = Instant::now();
        let (sides, found) = sunk(case, approach, most, most.max(nearest))?;
        match found {
            Ok(regions) => {
                let load_s = match approach {
                    None | Some(ApproachBy::Given(_)) => 0.0,
                    Some(_) => start.elapsed().as_secs_f64(),
                };
                return Ok((sides, regions, load_s));
            }
            Err(side) => heavy = side,
        }
    }
    Err(too_heavy(case, heavy))
}

/// Most rolls that are tried under the loads. On treads three suffice: the wheels' vertical displacements hardly depend on the roll.
const MOST_ROLLS: usize = 64;

/// Least step of the roll \[rad\] from which the slope of the difference of heights is taken: rounding changes it by less than a
/// hundredth.
const SLOPE_OVER: f64 = 1e-8;

/// Largest next step of the roll at which the search ends \[rad\]: it lifts a wheel by 1e-9 mm.
const SETTLED_ROLL: f64 = 1e-12;

/// Lowers the wheels, and finds the regions under an approach, at the roll at which each wheel carries its load if that is asked
/// for: both sides then give the middle of the axle one height, to [`SETTLED_ROLL`].
///
/// If a place comes or goes within a region, its frame turns and the height jumps. If one height jumps over the other, the result is a roll
/// beside the jump, closer to it than [`SLOPE_OVER`].
///
/// # Errors
/// No contact; neither one height nor a jump found in [`MOST_ROLLS`] tries.
fn sunk(
    case: &Case,
    approach: Option<ApproachBy>,
    most: f64,
    within: f64,
) -> Result<(Vec<TouchedSide>, Carried)> {
    let mut sides = sides(case, within, None)?;
    let each = match approach {
        Some(ApproachBy::AxleLoad(load)) if follows(case) => Some(ApproachBy::WheelLoad(load / 2.0)),
        _ => approach,
    };
    let mut found = regions(case, &sides, each, most)?;
    if !follows(case) {
        return Ok((sides, found));
    }
    let Arrangement::Wheelset { system, .. } = &case.setup.arrangement else { return Ok((sides, found)) };
    let spread = system.right().track().rail_x() + system.left().track().rail_x();
    let (mut range, mut before) = (Interval::ALL, None);
    for _ in 0..MOST_ROLLS {
        let (Ok(carried), [right, left]) = (&found, sides.as_slice()) else { break };
        let heights = [right, left].map(|side| side.height);
        let sunk = [0, 1].map(|k| carried[k].first().map_or(0.0, ContactRegion::sunk));
        // A roll about the axle's middle lifts a contact by its lever arm, and a steep one also by its lateral movement.
        let steep = |side: &TouchedSide| side.places[0].rolling_radius * side.places[0].contact_angle.tan();
        let lever = spread + right.places[0].rail_x + left.places[0].rail_x - steep(right) - steep(left);
        let (here, miss) = (right.roll, (heights[1] - sunk[1]) - (heights[0] - sunk[0]));
        // Where a steep flange carries, the vertical displacements depend on the roll as well: a secant includes that.
        let slope = match before {
            Some((there, missed, _)) if f64::abs(here - there) > SLOPE_OVER => {
                (missed - miss) / (here - there)
            }
            Some((.., slope)) => slope,
            None => lever,
        };
        let step = miss / if slope > 0.0 { slope } else { lever };
        if step.abs() <= SETTLED_ROLL {
            return Ok((sides, found));
        }
        *(if step < 0.0 { &mut range.high } else { &mut range.low }) = here;
        before = Some((here, miss, slope));
        let inside = range.low < here + step && here + step < range.high;
        // No roll between the two makes up for what is missed: there the heights jump.
        if !inside && range.width() < SLOPE_OVER && miss.abs() > spread * SLOPE_OVER {
            break;
        }
        let roll = if inside { here + step } else { range.low + range.width() / 2.0 };
        sides = self::sides(case, within, Some(roll))?;
        found = regions(case, &sides, each, most)?;
    }
    if found.is_ok() && sides.len() == 2 && range.width() >= SLOPE_OVER {
        let (found, expected) =
            ("no roll that the loads settle at", "a roll at which both loads leave the axle one height");
        return Err(Error::new("wheelset: roll", found, expected, "take \"solve\", or give the roll"));
    }
    Ok((sides, found))
}

/// Tells whether the roll of a case follows its loads.
pub(super) fn follows(case: &Case) -> bool {
    let solved = matches!(&case.setup.arrangement, Arrangement::Wheelset { position, .. } if position.roll == Roll::Solve);
    solved && case.setup.roll_by_load != RollByLoad::No
}

/// Lowers a wheel or a wheelset, and gives the places of contact with vertical gaps up to `within` \[mm\]. The right-hand
/// side, which is the one that is described, comes first. `roll` \[rad\] takes the place of a wheelset's own.
fn sides(case: &Case, within: f64, roll: Option<f64>) -> Result<Vec<TouchedSide>> {
    let selection = Selection { within, apart: ONE_CONTACT };
    match &case.setup.arrangement {
        Arrangement::Points { .. } => Ok(Vec::new()),
        Arrangement::Wheel { profiles, pose } => {
            let mut search = profiles.search();
            let touch = search.touch(pose, &selection)?;
            let places = touch.contacts.to_vec();
            Ok(vec![TouchedSide { side: None, height: touch.height, roll: pose.roll(), places }])
        }
        Arrangement::OnSlices { pair, pose } => {
            let standing = [case.setup.along, case.setup.pitch];
            let (height, places) = pair.touch(pose, standing, &selection)?;
            Ok(vec![TouchedSide { side: None, height, roll: pose.roll(), places }])
        }
        Arrangement::Wheelset { system, position } => {
            let mut search = system.search();
            search.stand_at(case.setup.along, case.setup.pitch);
            let position = Position { roll: roll.map_or(position.roll, Roll::Fixed), ..*position };
            let touch = search.touch(&position, &selection)?;
            let side = |side, k: usize| {
                let found = &touch.sides[k];
                let places = found.touch.contacts.to_vec();
                TouchedSide { side: Some(side), height: found.z, roll: touch.roll, places }
            };
            Ok(vec![side(TrackSide::Right, 1), side(TrackSide::Left, 0)])
        }
    }
}

/// The regions of every side, or the side that does not carry its load; `None` of an axle and of a single wheel.
type Carried = std::result::Result<Vec<Vec<ContactRegion>>, Option<TrackSide>>;

/// Finds the regions of every side under an approach; under a load a wheel is lowered by at most `most` \[mm\].
fn regions(case: &Case, sides: &[TouchedSide], approach: Option<ApproachBy>, most: f64) -> Result<Carried> {
    let Some(approach) = approach else { return Ok(Ok(vec![Vec::new(); sides.len()])) };
    let rules = rules(case, approach, false);
    let wheel = |side: &TouchedSide| {
        SinkingWheel::over(&case.profiles.on(side.side).pair, on_loft(case, side.side), &side.places, rules)
    };
    let modulus = case.question.modulus();
    let mut all = Vec::new();
    match approach {
        ApproachBy::Given(approach) => {
            for side in sides {
                all.push(wheel(side).regions(approach)?);
            }
        }
        ApproachBy::WheelLoad(load) => {
            let by = ApproachBy::WheelLoads { right: load, left: load };
            return regions(case, sides, Some(by), most);
        }
        ApproachBy::WheelLoads { right, left } => {
            let carried = |side: &TouchedSide| {
                let load = if side.side == Some(TrackSide::Left) { left } else { right };
                carry(&mut [wheel(side)], load, modulus, most)
            };
            let both: Vec<_> = sides.par_iter().map(carried).collect();
            for (side, carried) in sides.iter().zip(both) {
                let Some(carried) = carried? else { return Ok(Err(side.side)) };
                all.extend(carried);
            }
        }
        ApproachBy::AxleLoad(load) => {
            let mut wheels: Vec<_> = sides.iter().map(wheel).collect();
            let Some(carried) = carry(&mut wheels, load, modulus, most)? else { return Ok(Err(None)) };
            all = carried;
        }
    }
    Ok(Ok(all))
}

/// Gives the body that varies on a side, and where the wheel stands; `None` where none varies.
fn on_loft(case: &Case, side: Option<TrackSide>) -> Option<OnLoft<'_>> {
    let body = case.profiles.on(side).varying.as_ref()?;
    let along = case.setup.along;
    let from = match &case.setup.arrangement {
        Arrangement::Wheelset { system, position } => {
            system.along(side != Some(TrackSide::Left), position, along)
        }
        Arrangement::Points { .. } | Arrangement::Wheel { .. } | Arrangement::OnSlices { .. } => along,
    };
    Some(OnLoft { body, from })
}

/// Gives the rules of regions under an approach or a load.
fn rules(case: &Case, approach: ApproachBy, alone: bool) -> RegionRules {
    let frame = match (case.question.frame, approach) {
        (FrameOrigin::Auto, ApproachBy::Given(_)) => FrameOrigin::Contact,
        (frame, _) => frame,
    };
    RegionRules { merge: case.axes.merge, spacing: case.axes.spacing, alone, frame }
}

/// Says that no approach carries the load of a case.
fn too_heavy(case: &Case, side: Option<TrackSide>) -> Error {
    let (key, load) = match case.question.approach {
        // Of both wheels, even where one of them alone was found not to carry its half.
        Some(ApproachBy::AxleLoad(load)) => return unborne("wheelset: load", load, None),
        Some(ApproachBy::WheelLoad(load)) => ("patch: load", load),
        Some(ApproachBy::WheelLoads { left, .. }) if side == Some(TrackSide::Left) => ("left: load", left),
        Some(ApproachBy::WheelLoads { right, .. }) => ("right: load", right),
        Some(ApproachBy::Given(_)) | None => ("patch", 0.0),
    };
    unborne(key, load, side)
}

fn unborne(key: &str, load: f64, side: Option<TrackSide>) -> Error {
    let on = side.map_or_else(String::new, |side| format!(" on the {side} side"));
    let [.., most] = SEARCHED_GAPS;
    let expected = format!("a load that a wheel carries which sinks by at most {most} mm");
    let advice = "check the unit of the load and the place of contact";
    Error::new(key, format!("{load} N{on}"), expected, advice)
}

impl TouchedSide {
    /// Makes contacts of the regions; without an approach there are none, and the places within the largest gap of near misses are taken.
    fn contacts(&self, case: &Case, regions: Vec<ContactRegion>, load_s: f64) -> Result<Vec<PlacedContact>> {
        let within = case.setup.within;
        let modulus = case.question.modulus();
        let of = |indices: &[usize]| indices.iter().map(|&k| ListedContact::from(&self.places[k])).collect();
        let mut placed = Vec::new();
        if regions.is_empty() {
            for place in self.places.iter().take_while(|place| place.gap <= within) {
                let pair = &case.profiles.on(self.side).pair;
                let placement = placed_at(place, pair, on_loft(case, self.side))?;
                let found = self.found(placed.len() + 1, place)?;
                placed.push(PlacedContact::new(placement, None, modulus)?.found_as(found));
            }
            return Ok(placed);
        }
        let own: Vec<usize> =
            regions.iter().flat_map(|region| region.merged.iter().chain([&region.place])).copied().collect();
        let missed = (0..self.places.len()).filter(|k| !own.contains(k) && self.places[*k].gap <= within);
        let missed: Vec<ListedContact> = of(&missed.collect::<Vec<_>>());
        for region in regions {
            let (place, merged) = (&self.places[region.place], of(&region.merged));
            let near_misses = missed.clone();
            let found = Found { merged, near_misses, ..self.found(placed.len() + 1, place)? };
            placed.push(PlacedContact::of(region, modulus, load_s)?.found_as(found));
        }
        Ok(placed)
    }

    /// Says how the contact with this number, from 1, was found.
    fn found(&self, number: usize, place: &search::Contact) -> Result<Found> {
        if number > MOST_PARTS {
            let found = format!("more than {MOST_PARTS} places of contact of one wheel");
            let advice = "smooth the profiles, or give grid.merge";
            return Err(Error::new("contact", found, format!("at most {MOST_PARTS}"), advice));
        }
        Ok(Found {
            side: self.side,
            height_mm: self.height,
            roll_rad: self.roll,
            contact: number,
            place: place.into(),
            merged: Vec::new(),
            near_misses: Vec::new(),
        })
    }
}
