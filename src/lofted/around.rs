//! Wheels that vary around their axle: sections at angles, a radius that varies, a flat.
//!
//! The surface is that of a rail's slices, over the developed circumference: the place of a section is R times its angle, and z points
//! away from the axle. It goes beyond one turn as far as searches reach, so that they meet no seam.

use std::cmp::Ordering::Less;
use std::f64::consts::PI;
use std::sync::Arc;

use super::build::Loft;
use super::joining::Joining;
use super::kept::{HeightForm, HeightStretch, SmoothCurve};
use super::section::section;
use super::slice::LoftSlice;
use super::strip::LoftStrip;
use crate::error::{Error, Result, finite};
use crate::numerics::interval::Interval;
use crate::numerics::slopes;
use crate::profile::Profile;

/// How far a wheel's surface goes around from its middle, to both sides \[rad\].
const FAR: f64 = 1.5 * PI;

/// Number of sections beyond [`FAR`] on which the monotone cubics within it depend.
const MARGIN: usize = 3;

/// Least angle \[rad\] between two rows of a radius that varies. A last section that is a whole turn from the first one, within this
/// angle, is the first one, as in CONTACT.
const LEAST_APART: f64 = 1e-3;

/// Number of rows by which a spline is continued beyond the surface to stand for a periodic one. The effect of its ends falls to a quarter
/// from row to row, or to a half where rows are far from equally spaced: to 2⁻⁵⁴ over these.
const SPLINE_MARGIN: usize = 54;

/// Largest cell \[rad\] of a flat: cubics that approximate its closed form are off by 1e-6 mm on a radius of 500 mm.
const OF_FLAT: f64 = 2e-2;

/// Number of cells along a rounded edge of a flat.
const OF_EDGE: usize = 6;

/// A wheel that varies around its axle.
#[derive(Debug, Clone)]
pub struct LoftedWheel {
    /// Its developed surface, upside down: z points away from the axle.
    pub(crate) loft: Arc<Loft>,
    /// Nominal rolling radius \[mm\].
    pub(crate) radius: f64,
    /// Angle \[rad\] at the middle of the surface, which reaches [`FAR`] to both sides.
    pub(crate) middle: f64,
    warnings: Vec<String>,
}

/// A flat: the part of a wheel's circumference that slid on the rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flat {
    /// Length L of the chord \[mm\]; the flat is R − √(R² − L²/4) deep.
    pub length: f64,
    /// Angle of its middle around the wheel \[rad\].
    pub angle: f64,
    /// Radius of its edges \[mm\], tangential to the chord and to the circle; 0 for a fresh flat, whose edges are sharp.
    pub edge_radius: f64,
}

impl LoftedWheel {
    /// Joins the sections of a wheel of this nominal rolling radius \[mm\]; [`LoftSlice::at`] is their angle \[rad\], ascending. A wheel is
    /// periodic: the last section is joined to the first.
    ///
    /// # Errors
    /// The errors of [`Loft::new`]; angles that do not ascend; a radius that is not positive; a section that reaches the axle; sections
    /// that go more than once around. A last section at the place of the first one is left out, with a warning.
    pub fn new(sections: &[LoftSlice], radius: f64, joining: Joining) -> Result<Self> {
        check_radius(radius)?;
        if let Some(pair) = sections.windows(2).find(|pair| pair[0].at.partial_cmp(&pair[1].at) != Some(Less))
        {
            let found = format!("a section at {} rad after one at {} rad", pair[1].at, pair[0].at);
            return Err(Error::new(&pair[1].name, found, "ascending angles", "sort the sections"));
        }
        let mut own: Vec<LoftSlice> = sections.to_vec();
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
            [_, _, ..] => periodic(&own, middle, joining),
            // Too few: the loft says so.
            few => few.to_vec(),
        };
        let loft = Loft::new(&developed(around, radius), joining)?;
        warnings.extend(loft.warnings.iter().cloned());
        Self::around(loft, radius, middle, warnings)
    }

    /// Makes a wheel whose profile moves in and out as its radius varies: `deviations` \[mm\] from the nominal one at ascending angles
    /// \[rad\], less than a turn, joined all around by a periodic cubic spline.
    ///
    /// # Errors
    /// Fewer than two deviations, or some out of order, closer than 1 mrad, more than once around, not finite, or as large as the radius;
    /// a radius that is not positive; a profile that reaches the axle.
    pub fn out_of_round(profile: &Profile, radius: f64, deviations: &[[f64; 2]]) -> Result<Self> {
        check_radius(radius)?;
        let middle = check_rows(radius, deviations)?.middle();
        Self::kept(profile, radius, middle, &[periodic_spline(deviations, radius, middle)])
    }

    /// Makes a wheel with a flat. Every circle of the profile is cut by a chord over the same angle: the flat is straight along the rail
    /// on which the wheel slid. Accuracy: rounding, because chord and edges are closed forms.
    ///
    /// # Errors
    /// A length below 0.01 mm, or the diameter and more; an angle beyond a turn; an edge radius that is negative, or as large as the
    /// distance of the chord from the axle; a radius that is not positive; a profile that reaches the axle.
    pub fn with_flat(profile: &Profile, radius: f64, flat: &Flat) -> Result<Self> {
        check_radius(radius)?;
        let middle = turned(flat.angle, 0.0);
        Self::kept(profile, radius, middle, &FlatShape::new(radius, flat)?.stretches(middle))
    }

    fn kept(profile: &Profile, radius: f64, middle: f64, stretches: &[HeightStretch]) -> Result<Self> {
        let curves = SmoothCurve::parts(&profile.upside_down());
        let beside = |stretch| {
            curves.iter().enumerate().map(move |(part, curve)| LoftStrip::kept(part, curve, stretch))
        };
        let reach = Interval::of(middle).grown(FAR).map(|angle| radius * angle);
        let loft = Loft::of_strips(stretches.iter().flat_map(beside).collect(), reach);
        Self::around(loft, radius, middle, Vec::new())
    }

    /// Makes a wheel of a surface that stays clear of the axle.
    fn around(loft: Loft, radius: f64, middle: f64, warnings: Vec<String>) -> Result<Self> {
        let heights = loft.strips.iter().flat_map(LoftStrip::bays).map(|bay| bay.bounds(1)[1].low);
        let nearest = heights.fold(f64::INFINITY, f64::min);
        if nearest + radius <= 0.0 {
            let found = format!("a surface up to z = {} mm", -nearest);
            let expected = format!("all of it below the axle at z = R = {radius} mm");
            return Err(Error::new("profile", found, expected, "check unit, sign of z and radius"));
        }
        Ok(Self { loft: Arc::new(loft), radius, middle, warnings })
    }

    /// Adds warnings about the list of its sections.
    #[must_use]
    pub fn with_warnings(mut self, doubts: Vec<String>) -> Self {
        self.warnings.extend(doubts);
        self
    }

    /// Returns the section that is lowest where the wheel is turned by a pitch \[rad\], + forward at the bottom; without a pitch, the
    /// section where the surface begins.
    ///
    /// # Errors
    /// A place where the sections leave the surface undefined.
    pub fn lowest(&self, pitch: Option<f64>) -> Result<Profile> {
        let first = self.loft.strips.first().map_or(0.0, |strip| strip.reach().low / self.radius);
        let angle = pitch.map_or(first, |pitch| turned(-pitch, self.middle));
        let nowhere = || {
            let found = format!("a gap in the surface at {angle} rad");
            Error::new("pitch", found, "a place that the slices join to a surface", "choose another pitch")
        };
        let at = self.radius * angle;
        let section = section(&self.loft, self.loft.widest(at).ok_or_else(nowhere)?, at)?;
        let mut lowest = section.upside_down();
        lowest.name = format!("section at {angle:.4} rad");
        Ok(lowest)
    }

    /// Gives the warnings about its sections: where they leave the surface undefined, and why; what is doubtful in their list.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

fn check_radius(radius: f64) -> Result<()> {
    if finite("radius", radius)? > 0.0 {
        return Ok(());
    }
    Err(Error::new("radius", format!("{radius} mm"), "a positive length in mm", "give the rolling radius"))
}

/// Checks rows \[angle in rad, deviation in mm\]; returns the range of the angles.
fn check_rows(radius: f64, deviations: &[[f64; 2]]) -> Result<Interval> {
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
            return Err(Error::new(place(k), format!("{deviation} mm"), expected, "give deviations, in mm"));
        }
    }
    if let Some(k) = (1..deviations.len()).find(|&k| deviations[k][0] - deviations[k - 1][0] < LEAST_APART) {
        let found = format!("{} rad after {} rad", deviations[k][0], deviations[k - 1][0]);
        let expected = format!("ascending angles, at least {LEAST_APART} rad apart");
        return Err(Error::new(place(k), found, expected, "sort the rows; angles are in rad"));
    }
    let range = Interval::new(deviations[0][0], deviations[deviations.len() - 1][0]);
    if range.width() > 2.0 * PI - LEAST_APART {
        let found = format!("angles from {} to {} rad", range.low, range.high);
        let expected = "less than a turn of 2π: the last row is joined to the first";
        return Err(Error::new("radii", found, expected, "leave out what comes twice; angles are in rad"));
    }
    Ok(range)
}

/// Adds whole turns to an angle, so that it lies within π of `middle` \[rad\].
pub(crate) fn turned(angle: f64, middle: f64) -> f64 {
    let off = angle - middle;
    // An angle that needs no turn keeps its last digit.
    if off.abs() <= PI { angle } else { (off + PI).rem_euclid(2.0 * PI) - PI + middle }
}

/// Lists the sections from [`FAR`] before `middle` to as much after it, and as many more on both sides as their joining depends on.
fn periodic(own: &[LoftSlice], middle: f64, joining: Joining) -> Vec<LoftSlice> {
    let margin = match joining {
        Joining::Monotone => MARGIN,
        Joining::Cubic => SPLINE_MARGIN,
    };
    let turns = turns(own.len(), margin);
    let all: Vec<LoftSlice> = turns
        .flat_map(|turn| own.iter().map(move |slice| LoftSlice { at: slice.at + turn, ..slice.clone() }))
        .collect();
    let first = all.partition_point(|slice| slice.at <= middle - FAR).saturating_sub(1 + margin);
    let last = all.partition_point(|slice| slice.at < middle + FAR) + 1 + margin;
    all[first..last.min(all.len())].to_vec()
}

/// Lists the whole turns \[rad\] by which so many rows are repeated, so that `margin` of them lie beyond [`FAR`].
fn turns(rows: usize, margin: usize) -> impl Iterator<Item = f64> {
    let turns = (2 + margin.div_ceil(rows)) as i32;
    (-turns..=turns).map(|turn| 2.0 * PI * f64::from(turn))
}

/// Develops sections at angles \[rad\] on the circumference, upside down.
fn developed(sections: Vec<LoftSlice>, radius: f64) -> Vec<LoftSlice> {
    let place =
        |slice: LoftSlice| LoftSlice { at: radius * slice.at, profile: slice.profile.upside_down(), ..slice };
    sections.into_iter().map(place).collect()
}

/// Makes the periodic spline through deviations \[mm\] at angles \[rad\], over the developed circumference.
fn periodic_spline(deviations: &[[f64; 2]], radius: f64, middle: f64) -> HeightStretch {
    let all = turns(deviations.len(), SPLINE_MARGIN)
        .flat_map(|turn| deviations.iter().map(move |[angle, value]| [radius * (angle + turn), *value]));
    let (at, values): (Vec<f64>, Vec<f64>) = all.map(|[at, value]| (at, value)).unzip();
    let rows: Vec<[f64; 2]> =
        values.iter().zip(slopes::spline(&at, &values)).map(|(value, slope)| [*value, slope]).collect();
    let first = at.partition_point(|at| *at <= radius * (middle - FAR)).saturating_sub(1);
    let last = (at.partition_point(|at| *at < radius * (middle + FAR)) + 1).min(at.len());
    HeightStretch::of_cubics(at[first..last].to_vec(), rows[first..last].to_vec())
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

/// Shortest flat \[mm\]: a march does not tell places apart that are closer.
const SHORTEST: f64 = 0.01;

impl FlatShape {
    fn new(radius: f64, flat: &Flat) -> Result<Self> {
        let Flat { length, angle, edge_radius } = *flat;
        if finite("flat: angle", angle)?.abs() > 2.0 * PI {
            let expected = "an angle around the wheel within ±2π rad";
            return Err(Error::new("flat: angle", format!("{angle} rad"), expected, "give it in rad"));
        }
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

    /// Lists the stretches of the circumference, in order, for a flat whose middle lies at an angle \[rad\].
    fn stretches(&self, middle: f64) -> Vec<HeightStretch> {
        let Self { radius, edge_radius, chord: distance, ends: [chord, circle] } = *self;
        let place = |angle: f64| radius * (middle + angle);
        let round =
            |from: f64, to: f64| HeightStretch::of_cubics(vec![place(from), place(to)], vec![[0.0; 2]; 2]);
        let cells = |from: f64, to: f64, count: usize| -> Vec<f64> {
            let share = |k: usize| k as f64 / count as f64;
            (0..=count).map(|k| place(from * (1.0 - share(k)) + to * share(k))).collect()
        };
        let count = (2.0 * chord / OF_FLAT).ceil() as usize;
        let flat = HeightStretch::of_form(
            HeightForm::Chord { radius, distance, middle },
            cells(-chord, chord, count),
        );
        let edge = |sign: f64, from: f64, to: f64| {
            let middle = middle + sign * circle;
            let form = HeightForm::Edge { radius, edge_radius, distance: radius - edge_radius, middle };
            HeightStretch::of_form(form, cells(from, to, OF_EDGE))
        };
        let mut stretches = vec![round(-FAR, -circle), flat, round(circle, FAR)];
        if circle > chord {
            stretches.insert(2, edge(1.0, chord, circle));
            stretches.insert(1, edge(-1.0, -circle, -chord));
        }
        stretches
    }
}
