//! Contact geometry of a wheelset over its lateral displacement, in the terms of EN 15302: Δr, Δ tan γ, places of contact, roll,
//! and the figures that are taken from them.

use nalgebra::Point2;

use super::position::{Position, Roll};
use super::sweep::{Conicity, Equivalent, NoConicity};
use super::touch::{Contact, Selection};
use super::wheelset::WheelsetOnTrack;
use super::wheelset_touch::WheelsetTouch;
use crate::error::Result;
use crate::numerics::interval::Interval;
use crate::placement::Pair;
use crate::profile::points_along;

/// Amplitude \[mm\] at which the equivalent conicity is stated.
pub const AMPLITUDE: f64 = 3.0;

/// Amplitudes \[mm\] between which the nonlinearity parameter of EN 15302 is the slope of the equivalent conicity.
pub const NONLINEARITY: [f64; 2] = [2.0, 4.0];

/// Step of the displacements \[mm\] over which contact bands are found: the widest of EN 15302.
const STEP: f64 = 0.1;

/// Depth below the top of rail at which the gauge TG is measured \[mm\].
const GAUGE_DEPTH: f64 = 14.0;
/// Depth below the running circle at which the distance SR of the active faces is measured \[mm\].
const FACE_HEIGHT: f64 = 10.0;
/// Distance of the points \[mm\] between which the active face is found: chords of a 13 mm flange root are within 0.03 µm of it.
const FACE_STEP: f64 = 0.05;

/// Contact geometry at one lateral displacement, without yaw. Arrays are \[left, right\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeometryAt {
    /// Lateral displacement y \[mm\], + to the right.
    pub lateral: f64,
    /// Roll \[rad\], + lowers the right-hand wheel. Where it is neglected: the difference of the heights at which the two sides touch,
    /// over the distance of their contacts.
    pub roll: f64,
    /// Rolling radius difference Δr, right less left \[mm\].
    pub delta_r: f64,
    /// Contact angle difference Δ tan γ, right less left \[1\].
    pub delta_tan_gamma: f64,
    /// The lowest contact of each side, in its own axes.
    pub contacts: [Contact; 2],
}

impl GeometryAt {
    fn new(system: &WheelsetOnTrack, lateral: f64, touch: &WheelsetTouch<'_>, roll: Roll) -> Self {
        let contacts = touch.sides.map(|side| side.touch.contacts[0]);
        let [left, right] = contacts;
        let roll = match roll {
            Roll::Solve | Roll::Fixed(_) => touch.roll,
            Roll::Neglect => {
                let rails = system.left().track().rail_x() + system.right().track().rail_x();
                (touch.sides[0].z - touch.sides[1].z) / (rails + left.rail_x + right.rail_x)
            }
        };
        Self {
            lateral,
            roll,
            delta_r: right.rolling_radius - left.rolling_radius,
            delta_tan_gamma: right.contact_angle.tan() - left.contact_angle.tan(),
            contacts,
        }
    }

    /// Returns the geometry at the opposite displacement of a wheelset whose sides are alike.
    fn mirrored(&self) -> Self {
        let [left, right] = self.contacts;
        Self {
            lateral: -self.lateral,
            roll: -self.roll,
            delta_r: -self.delta_r,
            delta_tan_gamma: -self.delta_tan_gamma,
            contacts: [right, left],
        }
    }
}

/// Finds the contact geometry at lateral displacements \[mm\], without yaw; `None` where a wheel is off its rail. Cost: a search a
/// displacement.
///
/// # Errors
/// Values that are not finite; a given roll beyond ±0.5 rad.
pub fn geometry_over(
    system: &WheelsetOnTrack,
    lateral: &[f64],
    roll: Roll,
) -> Result<Vec<Option<GeometryAt>>> {
    let mut search = system.search();
    let at = |&lateral: &f64| {
        let position = Position { lateral, yaw: 0.0, roll };
        let touch = search.touch_near(&position, &Selection { within: 0.0, apart: 0.0 }, None)?;
        Ok(touch.map(|touch| GeometryAt::new(system, lateral, &touch, roll)))
    };
    lateral.iter().map(at).collect()
}

/// The parts of both profiles of a side over which the contact moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactBand {
    /// Least and largest abscissa on the rail's profile \[mm\].
    pub rail_x: Interval,
    /// Least and largest abscissa on the wheel's profile \[mm\].
    pub wheel_x: Interval,
}

impl ContactBand {
    /// Returns the bands \[left, right\] of some contacts; `None` of none.
    pub fn of(all: &[GeometryAt]) -> Option<[Self; 2]> {
        let range = |of: &dyn Fn(&GeometryAt) -> f64| Interval::around(all.iter().map(of));
        let band = |side: usize| Self {
            rail_x: range(&|at| at.contacts[side].rail_x),
            wheel_x: range(&|at| at.contacts[side].wheel_x),
        };
        (!all.is_empty()).then(|| [0, 1].map(band))
    }
}

/// The key figures of a wheelset's contact geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeyFigures {
    /// The displacement about which the wheelset swings \[mm\]; `None` if there is none.
    pub centre: Option<f64>,
    /// Equivalent conicity tan γ_e at 3 mm, or why there is none.
    pub conicity: std::result::Result<Equivalent, NoConicity>,
    /// Nonlinearity parameter \[1/mm\]: half the difference of tan γ_e at 4 mm and at 2 mm; or why there is none.
    pub nonlinearity: std::result::Result<f64, NoConicity>,
    /// Contact bands \[left, right\] of all displacements within 3 mm of the centre, every 0.1 mm; `None` if no such displacement has
    /// contact on both sides.
    pub bands: Option<[ContactBand; 2]>,
}

/// Finds the key figures of a wheelset on its track.
///
/// Accuracy: conicities as of [`Conicity`]. Cost: one table of Δr up to 4 mm and 31 searches, with two different sides two tables
/// over 8 mm together and 61 searches.
///
/// # Errors
/// A given roll, by which the wheelset is held.
///
/// # Examples
/// ```
/// use wheelrail::search::key_figures;
/// use wheelrail::{Pair, RailDistance, Roll, WheelDistance, WheelsetOnTrack, inclination, standards};
///
/// let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
/// let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
/// let wheels = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
/// let system = WheelsetOnTrack::new(&pair, RailDistance::Gauge { gauge: 1435.0, height: 14.0 }, wheels)?;
/// let figures = key_figures(&system, Roll::Neglect)?;
/// assert!(figures.conicity.is_ok_and(|found| (found.conicity - 0.1741).abs() < 1e-3));
/// assert!(figures.nonlinearity.is_ok());
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn key_figures(system: &WheelsetOnTrack, roll: Roll) -> Result<KeyFigures> {
    KeyFigures::new(system, &Conicity::new(system, NONLINEARITY[1], roll)?, roll)
}

impl KeyFigures {
    /// Takes the figures from a table of the same system and roll that reaches 4 mm; a shorter one gives no nonlinearity parameter.
    ///
    /// # Errors
    /// A given roll beyond ±0.5 rad.
    pub fn new(system: &WheelsetOnTrack, table: &Conicity, roll: Roll) -> Result<Self> {
        let centre = table.centre();
        let (about, symmetric) = (centre.unwrap_or(0.0), system.symmetric());
        let steps = (AMPLITUDE / STEP).round() as i32;
        let first = if symmetric { 0 } else { -steps };
        let lateral: Vec<f64> = (first..=steps).map(|k| about + STEP * f64::from(k)).collect();
        let mut found: Vec<GeometryAt> =
            geometry_over(system, &lateral, roll)?.into_iter().flatten().collect();
        if symmetric {
            found.extend(found.clone().iter().map(GeometryAt::mirrored));
        }
        Ok(Self {
            centre,
            conicity: table.at(AMPLITUDE),
            nonlinearity: nonlinearity(table),
            bands: ContactBand::of(&found),
        })
    }
}

/// Returns the nonlinearity parameter \[1/mm\] of a table that reaches 4 mm: (tan γ_e(4 mm) − tan γ_e(2 mm))/(2 mm).
///
/// # Errors
/// Why one of the two conicities does not exist.
pub fn nonlinearity(table: &Conicity) -> std::result::Result<f64, NoConicity> {
    let [low, high] = NONLINEARITY;
    Ok((table.at(high)?.conicity - table.at(low)?.conicity) / (high - low))
}

/// Returns the gauge TG \[mm\] within 14 mm below the top of rail; `pairs` are those of the left and the right side. `None` if a rail's
/// profile ends before that.
pub fn gauge(system: &WheelsetOnTrack, pairs: [&Pair; 2]) -> Option<f64> {
    let sides = [system.left(), system.right()].into_iter().zip(pairs);
    sides.map(|(side, pair)| side.track().half_gauge(pair.rail(), GAUGE_DEPTH).ok()).sum()
}

/// Returns the distance SR \[mm\] of the wheels' active faces, 10 mm below the running circles; `pairs` are those of the left
/// and the right side. `None` if a wheel's profile ends before that. The clearance of a centred wheelset is TG − SR.
pub fn active_faces(system: &WheelsetOnTrack, pairs: [&Pair; 2]) -> Option<f64> {
    let sides = [system.left(), system.right()].into_iter().zip(pairs);
    sides.map(|(side, pair)| Some(side.wheelset().wheel_x() + active_face(pair)?)).sum()
}

/// Returns x of the flange's face on the wheel profile \[mm\], 10 mm below the running circle: the place nearest to the tread.
fn active_face(pair: &Pair) -> Option<f64> {
    let points = points_along(pair.wheel(), FACE_STEP);
    let crossing = |ends: &[Point2<f64>]| {
        let [a, b] = [ends[0], ends[1]];
        let [from, to] = [a.y + FACE_HEIGHT, b.y + FACE_HEIGHT];
        (from < 0.0 && to >= 0.0).then(|| a.x - from / (to - from) * (b.x - a.x))
    };
    points.windows(2).filter_map(crossing).filter(|x| *x < 0.0).max_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::{RailDistance, WheelDistance};
    use crate::profile::{inclination, standards};

    fn s1002(gauge: f64) -> Result<(Pair, WheelsetOnTrack)> {
        let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
        let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
        let wheels = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
        let system = WheelsetOnTrack::new(&pair, RailDistance::Gauge { gauge, height: 14.0 }, wheels)?;
        Ok((pair, system))
    }

    #[test]
    fn the_clearance_is_that_of_the_drawings() -> Result<()> {
        // Flanges of 32.5 mm, 70 mm from the back: 1360 + 65.
        let (pair, system) = s1002(1435.0)?;
        let faces = active_faces(&system, [&pair, &pair]);
        assert!(faces.is_some_and(|faces| (faces - 1425.0).abs() < 1e-3), "{faces:?}");
        for by in [0.0, 1.5] {
            let wider = gauge(&system.widened(by)?, [&pair, &pair]);
            assert!(wider.is_some_and(|wider| (wider - 1435.0 - by).abs() < 1e-9), "{wider:?}");
        }
        Ok(())
    }

    #[test]
    fn a_wider_track_is_one_of_that_gauge() -> Result<()> {
        let ((_, narrow), (_, wide)) = (s1002(1435.0)?, s1002(1438.0)?);
        let [a, b] = [narrow.widened(3.0)?, wide].map(|system| key_figures(&system, Roll::Neglect));
        let (a, b) = (a?, b?);
        let off =
            a.conicity.map_or(0.0, |found| found.conicity) - b.conicity.map_or(1.0, |found| found.conicity);
        assert!(off.abs() < 1e-9, "{a:?} {b:?}");
        Ok(())
    }

    /// A wheelset of two sides that are alike but given apart has no mirrored half: its figures are found in another way.
    #[test]
    fn mirrored_displacements_are_those_of_a_search() -> Result<()> {
        let (_, system) = s1002(1435.0)?;
        let apart = WheelsetOnTrack::of_sides(system.left().clone(), system.right().clone());
        for roll in [Roll::Neglect, Roll::Solve] {
            let [one, two] = [&system, &apart].map(|system| key_figures(system, roll));
            let (one, two) = (one?, two?);
            let (Some(a), Some(b)) = (one.bands, two.bands) else { panic!("{one:?} {two:?}") };
            for (a, b) in a.iter().zip(&b) {
                let ends = |band: &ContactBand| [band.rail_x, band.wheel_x].map(Interval::ends).concat();
                assert!(ends(a).iter().zip(ends(b)).all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} {b:?}");
            }
            let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-3;
            assert!(
                close(one.nonlinearity.unwrap_or(0.0), two.nonlinearity.unwrap_or(1.0)),
                "{one:?} {two:?}"
            );
        }
        Ok(())
    }

    #[test]
    fn a_neglected_roll_is_told_by_the_heights() -> Result<()> {
        let (_, system) = s1002(1435.0)?;
        let at = |roll| Ok::<_, crate::Error>(geometry_over(&system, &[4.0], roll)?[0].map(|at| at.roll));
        let (Some(told), Some(solved)) = (at(Roll::Neglect)?, at(Roll::Solve)?) else { panic!("no contact") };
        // The contacts of a rolled wheelset are a little elsewhere.
        assert!(solved != 0.0 && (told / solved - 1.0).abs() < 0.05, "{told} {solved}");
        Ok(())
    }
}
