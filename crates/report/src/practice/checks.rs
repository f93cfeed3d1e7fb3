//! Checks one placed pair against brute force.

use super::brute::{PairOfVertices, Stance};
use super::fill::filled;
use super::row::PracticeRow;
use wheelrail::error::{ErrorKind, Result};
use wheelrail::internal::Random;
use wheelrail::mesh;
use wheelrail::patch::{Component, End, Patch, Window};
use wheelrail::placement::{Pair, Placement, RailDistance, WheelDistance};
use wheelrail::search::{
    Conicity, Contact, NoConicity, ONE_CONTACT, Pose, Position, ProfilePair, Roll, Selection, Touch,
    WheelsetOnTrack,
};
use wheelrail::separation::Evaluator;

/// Gap \[mm\] up to which near misses are compared.
const WITHIN: f64 = 0.2;
/// Largest difference \[mm\] of a height or a gap from brute force. Chords are 1.3e-5 mm off a lip of 1 mm radius; on a
/// flange of 75° this is four times as much in height.
const HEIGHT: f64 = 1e-4;
/// Largest difference \[mm\] of s from brute force.
const SEPARATION: f64 = 3e-5;
/// Number of points at which s is compared.
const POINTS: usize = 40;
/// Half the width \[mm\] over which a place of brute force is the lowest: wider than a wave of noise.
const APART: f64 = 0.3;
/// Largest relative difference of a patch's area from that of a flood fill with 160 points across.
const AREA: f64 = 5e-3;
/// Gauge of the rails' inner faces \[mm\].
const GAUGE: RailDistance = RailDistance::Gauge { gauge: 1435.0, height: 14.0 };
/// Spacing of the wheels' origins \[mm\].
const WHEELS: WheelDistance = WheelDistance::Spacing(1500.0);

const SELECTION: Selection = Selection { within: WITHIN, apart: ONE_CONTACT };

/// Checks a single wheel: its contacts, and the patch around the first.
pub(super) fn wheel(pair: &Pair, offset: f64, yaw: f64, approach: f64, row: &mut PracticeRow) -> Result<()> {
    let bodies = PairOfVertices::new(pair);
    let profiles = ProfilePair::new(pair)?;
    let mut search = profiles.search();
    let touch = search.touch(&Pose::new(offset, yaw, 0.0)?, &SELECTION)?;
    contacts(&bodies, &Stance { offset, yaw, roll: 0.0 }, &touch, "", row);
    patch(pair, &bodies, touch.contacts.first(), approach, "", row)
}

/// Checks a wheelset with its roll solved: both sides as single wheels, at one height.
pub(super) fn wheelset(
    pair: &Pair,
    lateral: f64,
    yaw: f64,
    approach: f64,
    row: &mut PracticeRow,
) -> Result<()> {
    let bodies = PairOfVertices::new(pair);
    let system = WheelsetOnTrack::new(pair, GAUGE, WHEELS)?;
    let mut search = system.search();
    let position = Position { lateral, yaw, roll: Roll::Solve };
    let touch = search.touch(&position, &SELECTION)?;
    let z = touch.sides.map(|side| side.z);
    if (z[0] - z[1]).abs() > HEIGHT {
        row.failures.push(format!("the sides touch at {} and {} mm", z[0], z[1]));
    }
    for (sign, name, side) in [(-1.0, "left: ", touch.sides[0]), (1.0, "right: ", touch.sides[1])] {
        let standing = standing(&system, &position, touch.roll, sign);
        contacts(&bodies, &standing, &side.touch, name, row);
        patch(pair, &bodies, side.touch.contacts.first(), approach, name, row)?;
    }
    Ok(())
}

/// Checks a wheelset at many positions, and its conicity.
pub(super) fn sweep(
    pair: &Pair,
    positions: &[f64],
    yaw: f64,
    amplitude: f64,
    row: &mut PracticeRow,
) -> Result<()> {
    let bodies = PairOfVertices::new(pair);
    let system = WheelsetOnTrack::new(pair, GAUGE, WHEELS)?;
    let mut search = system.search();
    for &lateral in positions {
        let position = Position { lateral, yaw, roll: Roll::Solve };
        let touch = match search.touch(&position, &SELECTION) {
            Err(error) if error.kind == ErrorKind::NoContact => {
                row.failures.push(format!("lateral {lateral}: {error}"));
                continue;
            }
            touch => touch?,
        };
        for (sign, side) in [(-1.0, touch.sides[0]), (1.0, touch.sides[1])] {
            let standing = standing(&system, &position, touch.roll, sign);
            contacts(&bodies, &standing, &side.touch, &format!("lateral {lateral}, side {sign}: "), row);
        }
    }
    let conicity = Conicity::new(&system, amplitude, Roll::Neglect)?;
    let (searches, most) = (conicity.searches(), Conicity::most_searches(amplitude));
    if searches > most {
        row.failures.push(format!("the conicity took {searches} searches of at most {most}"));
    }
    match conicity.at(0.9 * amplitude) {
        // Worn pairs reach 1; a larger conicity is a fault. The movement of a hollow wheel may not return at all.
        Ok(found) if found.conicity > 0.0 && found.conicity < 2.0 => {}
        Err(NoConicity::NotRestoring) => {}
        other => row.failures.push(format!("conicity {other:?}")),
    }
    Ok(())
}

/// Returns the attitude of one side of a wheelset, by the definition of the axes: the left side is the mirror
/// image.
fn standing(system: &WheelsetOnTrack, position: &Position, roll: f64, sign: f64) -> Stance {
    let (yaw, roll) = (sign * position.yaw, sign * roll);
    let along = system.right().wheelset().wheel_x() * yaw.cos() * roll.cos()
        - system.right().wheelset().radius() * roll.sin();
    Stance { offset: sign * position.lateral + along - system.right().track().rail_x(), yaw, roll }
}

/// Compares height, contacts and near misses of one side.
fn contacts(bodies: &PairOfVertices, standing: &Stance, touch: &Touch, name: &str, row: &mut PracticeRow) {
    let Some(lowered) = bodies.lowered(standing) else {
        row.failures.push(format!("{name}brute force finds no wheel over the rail"));
        return;
    };
    let mut differ = |what: String, difference: f64| {
        row.figure = row.figure.max(difference);
        if difference.is_nan() || difference > HEIGHT {
            row.failures.push(format!("{name}{what}: {difference:.2e} mm from brute force"));
        }
    };
    differ(format!("height {}", touch.height), (touch.height - lowered.height).abs());
    for contact in touch.contacts {
        // A contact must be on both outlines at the rail's abscissa.
        let gap = lowered.gap(contact.rail_x).unwrap_or(f64::NAN);
        differ(format!("gap {} at {}", contact.gap, contact.rail_x), (gap - contact.gap).abs());
    }
    let places = lowered.lowest_places(WITHIN - HEIGHT, APART);
    row.contacts += places.len();
    for [x, gap] in places {
        let holds = |c: &Contact| (c.rail_x - x).abs() <= ONE_CONTACT + APART && c.gap <= gap + HEIGHT;
        if !touch.contacts.iter().any(holds) {
            row.failures.push(format!("{name}missed: x = {x:.3}, gap {gap:.6} mm"));
        }
    }
}

/// Compares the patch around a contact, its automatic grid, and s at random points of it.
fn patch(
    pair: &Pair,
    bodies: &PairOfVertices,
    contact: Option<&Contact>,
    approach: f64,
    name: &str,
    row: &mut PracticeRow,
) -> Result<()> {
    let Some(c) = contact else { return Ok(()) };
    let placement = c.placed(pair)?;
    let whole = Patch::new(&placement, approach, &Window::UNBOUNDED);
    let groups = mesh::groups(&whole, 0.0, None);
    let Some(group) = groups.first() else {
        row.failures.push(format!("{name}no patch at {approach} mm"));
        return Ok(());
    };
    let grid = group.axes(None)?;
    ring(&placement, approach, &grid, name, row);
    let window = grid.window();
    let patch = Patch::new(&placement, approach, &window);
    let fill = filled(&placement, approach, &window);
    let parts = patch.components.iter().filter(|part| part.area > fill.least_area).count();
    if parts != fill.parts {
        row.failures.push(format!("{name}{parts} parts, {} by flood fill", fill.parts));
    }
    // At the end of a surface the flood fill has half a cell too much or too little.
    let ends = |part: &Component| part.ends.iter().filter(|end| **end == End::ProfileEnd).count() as f64;
    let beside = |part: &Component| 0.5 * fill.step * ends(part) * part.eta.width();
    let beside: f64 = patch.components.iter().map(beside).sum();
    let area = ((patch.area() - fill.area).abs() - beside).max(0.0) / fill.area;
    row.area = row.area.max(area);
    if area.is_nan() || area > AREA {
        row.failures.push(format!("{name}area {} mm², {} by flood fill", patch.area(), fill.area));
    }
    separations(bodies, &placement, &window, name, row);
    Ok(())
}

/// Checks that the outermost cells of an automatic grid are outside the patch.
fn ring(placement: &Placement, approach: f64, grid: &mesh::Axes, name: &str, row: &mut PracticeRow) {
    let mut evaluator = Evaluator::new(placement);
    let (rows, columns) = (grid.xi.len(), grid.eta.len());
    for (k, &xi) in grid.xi.iter().enumerate() {
        for (l, &eta) in grid.eta.iter().enumerate() {
            let outermost = k == 0 || l == 0 || k + 1 == rows || l + 1 == columns;
            // There is no s beyond the end of a profile.
            if outermost && evaluator.separation(xi, eta) <= approach {
                row.failures.push(format!("{name}the automatic grid cuts the patch at ({xi:.4}, {eta:.4})"));
                return;
            }
        }
    }
}

/// Compares s at random points of a window.
fn separations(
    bodies: &PairOfVertices,
    placement: &Placement,
    window: &Window,
    name: &str,
    row: &mut PracticeRow,
) {
    let mut random = Random::new(POINTS as u64);
    let mut evaluator = Evaluator::new(placement);
    let mut compared = 0;
    for _ in 0..POINTS {
        let [xi, eta] = [window.xi, window.eta].map(|side| random.between(side.low, side.high));
        let s = evaluator.separation(xi, eta);
        let Some(exact) = bodies.separation(placement, xi, eta).filter(|_| s.is_finite()) else { continue };
        compared += 1;
        let difference = (s - exact).abs();
        row.figure = row.figure.max(difference);
        if difference > SEPARATION {
            row.failures.push(format!("{name}s({xi:.4}, {eta:.4}) = {s}, {exact} by brute force"));
        }
    }
    if compared < POINTS / 2 {
        row.failures.push(format!("{name}s is defined at {compared} of {POINTS} points"));
    }
}
