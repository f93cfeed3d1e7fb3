//! Wheels that vary around their axle: sections at angles, a radius that varies, a flat.
//!
//! The surface is that of a rail's slices, over the developed circumference: the place of a section is R times its angle, and z points
//! away from the axle. It goes once around and as much further as a wheel is looked at, so that a search meets no seam.

use std::f64::consts::PI;
use std::sync::Arc;

use super::build::{Loft, MARKS, Slice};
use super::joining::Joining;
use crate::error::{Error, Result, finite};
use crate::profile::{Profile, trace};

/// What a wheel's surface has beyond half a circumference, to both sides \[rad\].
const BEYOND: f64 = 0.5 * PI;

/// Sections \[count\] beyond that, which the cubics between the others depend on.
const MARGIN: usize = 3;

/// Least angle \[rad\] between two sections of a wheel; sections closer to a whole turn apart are one. CONTACT has it, too.
const LEAST_APART: f64 = 1e-3;

/// Distance \[rad\] of the sections of a flat: cubics between them are off by less than 1e-6 mm on a radius of 500 mm.
const OF_FLAT: f64 = 1e-2;

/// Number of cubics along a rounded edge of a flat: they are off by less than 1e-7 mm on edges up to 50 mm.
const OF_EDGE: usize = 6;

/// Least kink of a profile \[rad\] at which its surface has an edge; a smaller one is rounded, by 30 nm at most.
const LEAST_KINK: f64 = 1e-3;

/// A wheel that varies around its axle.
#[derive(Debug, Clone)]
pub struct LoftedWheel {
    /// Its developed surface, z upside down.
    pub(crate) loft: Arc<Loft>,
    /// Nominal rolling radius \[mm\].
    pub(crate) radius: f64,
    /// Angle \[rad\] around which the surface goes once about the axle.
    pub(crate) middle: f64,
    warnings: Vec<String>,
}

/// A flat: the part of a wheel's circumference that slid on the rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flat {
    /// Length L of the chord \[mm\]; the flat is R − √(R² − L²/4) deep.
    pub length: f64,
    /// Where its middle lies around the wheel \[rad\].
    pub angle: f64,
    /// Radius of its edges \[mm\], tangential to the chord and to the circle; 0 for a fresh flat, whose edges are sharp.
    pub edge_radius: f64,
}

impl LoftedWheel {
    /// Joins sections at ascending angles \[rad\], `at`, of a wheel of this nominal rolling radius \[mm\]. A wheel is periodic: the last
    /// section is joined to the first.
    ///
    /// # Errors
    /// The errors of [`Loft::new`]; sections that are more than once around, but for a last one at the place of the first, which is not
    /// used.
    pub fn new(sections: &[Slice], radius: f64, joining: Joining) -> Result<Self> {
        let mut own: Vec<Slice> = sections.to_vec();
        let mut warnings = Vec::new();
        if let [first, .., last] = sections {
            let over = last.at - first.at - 2.0 * PI;
            if over > LEAST_APART {
                let found = format!("sections from {} to {} rad", first.at, last.at);
                let expected = "sections that go once around the wheel";
                return Err(Error::new(&last.name, found, expected, "leave out those that come twice"));
            }
            if over > -LEAST_APART {
                if last.name != first.name {
                    warnings.push(format!("{} lies where {} does, and is not used", last.name, first.name));
                }
                own.pop();
            }
        }
        let middle = own.first().zip(own.last()).map_or(0.0, |(first, last)| 0.5 * (first.at + last.at));
        let around = match own.as_slice() {
            [_, _, ..] => periodic(&own, middle),
            // Too few: the loft says so.
            few => few.to_vec(),
        };
        let loft = Loft::new(&developed(around, radius, 0.0), joining)?;
        warnings.extend(loft.warnings.iter().cloned());
        Ok(Self { loft: Arc::new(loft), radius, middle, warnings })
    }

    /// Makes a wheel whose profile keeps its shape while its radius varies: `deviations` \[mm\] from the nominal one at ascending angles
    /// \[rad\], less than a turn, joined all around.
    ///
    /// # Errors
    /// Fewer than two deviations, or some out of order, more than once around, not finite, or as large as the radius.
    pub fn out_of_round(
        profile: &Profile,
        radius: f64,
        deviations: &[[f64; 2]],
        joining: Joining,
    ) -> Result<Self> {
        let place = |k: usize| format!("radii: row {}", k + 1);
        if deviations.len() < 2 {
            let found = format!("{} rows", deviations.len());
            let advice = "give rows [angle in rad, deviation in mm]";
            return Err(Error::new("radii", found, "two rows or more", advice));
        }
        for (k, [angle, deviation]) in deviations.iter().enumerate() {
            finite(&place(k), *angle)?;
            if finite(&place(k), *deviation)?.abs() >= radius {
                let expected = format!("a deviation from the radius of {radius} mm");
                return Err(Error::new(
                    place(k),
                    format!("{deviation} mm"),
                    expected,
                    "give deviations, in mm",
                ));
            }
        }
        if let Some(k) =
            (1..deviations.len()).find(|&k| deviations[k][0] - deviations[k - 1][0] < LEAST_APART)
        {
            let found = format!("{} rad after {} rad", deviations[k][0], deviations[k - 1][0]);
            let expected = format!("ascending angles, at least {LEAST_APART} rad apart");
            return Err(Error::new(place(k), found, expected, "sort the rows; angles are in rad"));
        }
        let (from, to) = (deviations[0][0], deviations[deviations.len() - 1][0]);
        if to - from > 2.0 * PI - LEAST_APART {
            let found = format!("angles from {from} to {to} rad");
            let expected = "less than a turn of 2π: the last row is joined to the first";
            return Err(Error::new(
                "radii",
                found,
                expected,
                "leave out what comes twice; angles are in rad",
            ));
        }
        let features = edges(profile);
        let sections: Vec<Slice> = deviations.iter().map(|row| section(profile, *row, &features)).collect();
        Self::new(&sections, radius, joining)
    }

    /// Makes a wheel with a flat: the profile keeps its shape, and its radius is that of the chord.
    ///
    /// # Errors
    /// A length that is not positive, or the diameter and more; an edge radius that is negative, or no smaller than what the flat leaves
    /// of the radius.
    pub fn with_flat(profile: &Profile, radius: f64, flat: &Flat) -> Result<Self> {
        let shape = FlatShape::new(radius, flat)?;
        let (features, middle) = (edges(profile), turned(flat.angle, 0.0));
        let mut whole: Option<Loft> = None;
        for rows in shape.pieces() {
            let sections = rows.into_iter().map(|row| section(profile, row, &features)).collect();
            let piece = Loft::new(&developed(sections, radius, middle), Joining::Cubic)?;
            whole = Some(match whole {
                Some(before) => before.followed_by(piece),
                None => piece,
            });
        }
        let whole = whole.ok_or_else(|| Error::new("flat", "no surface", "a wheel", "give a length"))?;
        Ok(Self { loft: Arc::new(whole), radius, middle, warnings: Vec::new() })
    }

    /// Takes what is doubtful in the list of its sections, too.
    #[must_use]
    pub fn with_warnings(mut self, doubts: Vec<String>) -> Self {
        self.warnings.extend(doubts);
        self
    }

    /// Where the sections leave the surface undefined, and why.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

/// Returns the angle that is equal to this one but for whole turns, within π of `middle` \[rad\].
pub(crate) fn turned(angle: f64, middle: f64) -> f64 {
    let off = angle - middle;
    // An angle that needs no turn keeps its last digit.
    if off.abs() <= PI { angle } else { (off + PI).rem_euclid(2.0 * PI) - PI + middle }
}

/// The sections from half a turn and [`BEYOND`] before `middle` to as much after it, with [`MARGIN`] more on both sides.
fn periodic(own: &[Slice], middle: f64) -> Vec<Slice> {
    let turns = [-2.0, -1.0, 0.0, 1.0, 2.0];
    let all: Vec<Slice> = turns
        .iter()
        .flat_map(|turns| {
            own.iter().map(move |slice| Slice { at: slice.at + 2.0 * PI * turns, ..slice.clone() })
        })
        .collect();
    let far = PI + BEYOND;
    let first = all.partition_point(|slice| slice.at <= middle - far).saturating_sub(1 + MARGIN);
    let last = all.partition_point(|slice| slice.at < middle + far) + 1 + MARGIN;
    all[first..last.min(all.len())].to_vec()
}

/// Develops sections at angles from `middle` \[rad\] on the circumference, upside down.
fn developed(sections: Vec<Slice>, radius: f64, middle: f64) -> Vec<Slice> {
    let place = |slice: Slice| Slice {
        at: radius * (middle + slice.at),
        profile: slice.profile.upside_down(),
        ..slice
    };
    sections.into_iter().map(place).collect()
}

/// The section at an angle \[rad\] where the radius is larger by a deviation \[mm\].
fn section(profile: &Profile, [angle, deviation]: [f64; 2], features: &[f64]) -> Slice {
    Slice {
        at: angle,
        name: format!("{} at {angle} rad", profile.name),
        profile: profile.clone().shifted(0.0, -deviation),
        features: features.to_vec(),
        measured_along: None,
    }
}

/// Arc lengths of a profile's ends and kinks \[mm\].
fn edges(profile: &Profile) -> Vec<f64> {
    let marks = trace(profile, MARKS);
    let kinks = marks.windows(2).filter_map(|pair| {
        let kink = pair[1].station.seen_from(&pair[0].station).angle();
        (pair[0].segment != pair[1].segment && kink.abs() > LEAST_KINK).then_some(pair[1].s)
    });
    // A last one beyond the curve means its end.
    [0.0].into_iter().chain(kinks).chain([f64::INFINITY]).collect()
}

/// The radius along a flat, with its edges.
struct FlatShape {
    radius: f64,
    edge_radius: f64,
    /// Distance of the chord from the axle \[mm\].
    chord: f64,
    /// Angles \[rad\] from the middle at which the chord ends and the circle begins.
    ends: [f64; 2],
}

/// Shortest flat \[mm\]: places along a march are not told apart below it.
const SHORTEST: f64 = 0.01;

impl FlatShape {
    fn new(radius: f64, flat: &Flat) -> Result<Self> {
        let Flat { length, angle, edge_radius } = *flat;
        finite("flat: angle", angle)?;
        if !(SHORTEST..2.0 * radius).contains(&finite("flat: length", length)?) {
            let expected = format!("from {SHORTEST} mm to less than the diameter of {} mm", 2.0 * radius);
            return Err(Error::new(
                "flat: length",
                format!("{length} mm"),
                expected,
                "give its chord, in mm",
            ));
        }
        let half = 0.5 * length;
        let chord = ((radius - half) * (radius + half)).sqrt();
        if !(0.0..chord).contains(&finite("flat: edge_radius", edge_radius)?) {
            let expected = format!("from 0 to less than the {chord} mm that the flat leaves of the radius");
            let found = format!("{edge_radius} mm");
            return Err(Error::new("flat: edge_radius", found, expected, "give a smaller one, in mm"));
        }
        let depth = half * half / (radius + chord);
        // The centre of an edge stands over the end of the chord.
        let chord_half = (depth * (radius + chord - 2.0 * edge_radius)).sqrt();
        let ends = [chord_half.atan2(chord), chord_half.atan2(chord - edge_radius)];
        Ok(Self { radius, edge_radius, chord, ends })
    }

    /// Rows \[angle from the middle, deviation\] of the pieces of the circumference, in order.
    fn pieces(&self) -> Vec<Vec<[f64; 2]>> {
        let [chord, circle] = self.ends;
        let far = PI + BEYOND;
        let cells = (2.0 * chord / OF_FLAT).ceil().max(2.0) as usize;
        let row = |angle: f64| [angle, self.deviation(angle)];
        let flat = (0..=cells).map(|k| row(chord * (2.0 * k as f64 / cells as f64 - 1.0))).collect();
        let mut pieces = vec![vec![[-far, 0.0], [-circle, 0.0]], flat, vec![[circle, 0.0], [far, 0.0]]];
        if circle > chord {
            let share = |k: usize| k as f64 / OF_EDGE as f64;
            let edge = |sign: f64| {
                let row = move |k: usize| row(sign * (chord + (circle - chord) * share(k)));
                (0..=OF_EDGE).map(row).collect::<Vec<_>>()
            };
            pieces.insert(2, edge(1.0));
            pieces.insert(1, edge(-1.0).into_iter().rev().collect());
        }
        pieces
    }

    /// Radius less the nominal one at an angle from the middle \[mm\], on the chord or an edge.
    fn deviation(&self, angle: f64) -> f64 {
        let [chord, circle] = self.ends;
        let away = angle.abs();
        if away <= chord {
            return self.chord / angle.cos() - self.radius;
        }
        let (centre, off) = (self.radius - self.edge_radius, away - circle);
        let across = centre * off.sin();
        centre * off.cos() + ((self.edge_radius - across) * (self.edge_radius + across)).sqrt() - self.radius
    }
}
