//! Closed shells of both bodies, for pictures of the whole: a piece of rail, and arcs of the rims of wheels and rollers.

use std::f64::consts::PI;

use nalgebra::{Point2, Point3};

use super::surfaces::wheel_point;
use crate::lofted::{FramedLoft, SPACING};
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::profile::{Profile, Station, trace};

/// How far a shell is carried beyond what the profile describes \[mm\], so that it has a back.
const BACK: f64 = 20.0;

/// Step along the shells of bodies that vary \[mm\].
const ALONG: f64 = 10.0;
/// Step across the shells of bodies that vary \[mm\].
const ACROSS: f64 = 1.0;

/// Step of the traces that outlines are thinned from \[mm\].
const TRACED: f64 = 0.25;

/// Least step of these traces, as a share of the profile's extent. It bounds the number of points of a body of any size.
const FINEST_TRACE: f64 = 2e-4;
/// Least tolerance of a shell, as a share of its body's size: less is invisible. It bounds the number of points, too.
const FINEST: f64 = 1e-5;

/// A closed surface of polygons: a prism or an arc of a ring, with both ends.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyShell {
    /// Points in the contact frame (ξ, η, ζ) \[mm\].
    pub points: Vec<Point3<f64>>,
    /// The points of every face in order.
    pub faces: Vec<Vec<usize>>,
}

impl BodyShell {
    /// Makes a piece of the rail from −`half_length` to `half_length` \[mm\] along η. The outline departs from the profile by at most
    /// `tolerance` \[mm\] or a hundred-thousandth of its extent, whichever is more, and is closed below it. The rim of a roller is as
    /// long, up to the whole circumference.
    pub fn rail(placement: &Placement, half_length: f64, tolerance: f64) -> Self {
        if let Some(under) = placement.under() {
            let half_angle = (half_length / under.rolling_radius()).min(PI);
            return Self::wheel(under, half_angle, tolerance).upside_down();
        }
        if let Some(lofted) = placement.lofted_rail() {
            return Self::lofted(lofted, half_length);
        }
        let stations = outline(placement.rail().profile(), tolerance);
        let low = stations.iter().map(|station| station.z).fold(f64::INFINITY, f64::min) - BACK;
        let frame = placement.rail().contact_frame();
        let points = |eta: f64| {
            let point = move |x: f64, z: f64| {
                let point = frame.inverse_transform_point(&Point2::new(x, z));
                Point3::new(point.x, eta, point.y)
            };
            closed(&stations, low).into_iter().map(|station| point(station.x, station.z)).collect()
        };
        Self::swept([-half_length, half_length].into_iter().map(points).collect())
    }

    /// Makes the rim of the wheel, before any approach, from −`half_angle` to `half_angle` \[rad\] about the axle, 0 at C. The
    /// outline departs from the profile, and a chord about the axle from its circle at the rolling radius, by at most `tolerance`
    /// \[mm\] or a hundred-thousandth of the size, whichever is more. The outline is closed above the profile.
    pub fn wheel(placement: &Placement, half_angle: f64, tolerance: f64) -> Self {
        if let Some(lofted) = placement.lofted_wheel() {
            let mut rim = Self::lofted(lofted, half_angle * placement.wheel_radius());
            rim.faces.iter_mut().for_each(|face| face.reverse());
            return rim;
        }
        let tolerance = tolerance.max(FINEST * placement.rolling_radius());
        let stations = outline(placement.wheel().profile(), tolerance);
        let high = stations.iter().map(|station| station.z).fold(f64::NEG_INFINITY, f64::max) + BACK;
        let ring = closed(&stations, high.min(placement.wheel_radius()));
        let step = (8.0 * tolerance / placement.rolling_radius()).sqrt();
        let count = (2.0 * half_angle / step).ceil().max(1.0);
        let turned = |k: usize| {
            let psi = half_angle * (2.0 * k as f64 / count - 1.0);
            ring.iter().map(|station| wheel_point(placement, station, psi)).collect()
        };
        Self::swept((0..=count as usize).map(turned).collect())
    }

    /// Makes the parts of a body that varies, up to `half_length` \[mm\] along its surface from C, each closed inside the body.
    fn lofted(lofted: &FramedLoft, half_length: f64) -> Self {
        let (middle, deepest) = (lofted.along(), -lofted.laid().radius());
        let mut all = Self { points: Vec::new(), faces: Vec::new() };
        for strip in &lofted.loft().strips {
            let [from, to] = strip.reach().cut(Interval::of(middle).grown(half_length)).ends();
            if from >= to {
                continue;
            }
            let sections = ((to - from) / ALONG).ceil() as usize;
            let nodes = (strip.cells() as f64 * SPACING / ACROSS).ceil() as usize;
            let at = |j: usize| from + (to - from) * j as f64 / sections as f64;
            let outline = |y: f64| -> Vec<[f64; 2]> {
                (0..=nodes).map(|k| strip.point((strip.cells() * k) as f64 / nodes as f64, y).at).collect()
            };
            let outlines: Vec<Vec<[f64; 2]>> = (0..=sections).map(|j| outline(at(j))).collect();
            let low = outlines.iter().flatten().map(|at| at[1]).fold(f64::INFINITY, f64::min) - BACK;
            let low = low.max(deepest);
            let points = |(j, outline): (usize, Vec<[f64; 2]>)| {
                let corners = [outline[nodes], outline[0]].map(|[x, _]| [x, low]);
                let all = outline.into_iter().chain(corners);
                all.map(|from| Point3::from(lofted.seen_from(from, at(j)))).collect()
            };
            let part = Self::swept(outlines.into_iter().enumerate().map(points).collect());
            let first = all.points.len();
            all.points.extend(part.points);
            let moved = |face: Vec<usize>| face.into_iter().map(|node| first + node).collect();
            all.faces.extend(part.faces.into_iter().map(moved));
        }
        all
    }

    /// Returns the shell mirrored under ζ → −ζ.
    fn upside_down(mut self) -> Self {
        self.points.iter_mut().for_each(|point| point.z = -point.z);
        self.faces.iter_mut().for_each(|face| face.reverse());
        self
    }

    /// Joins outlines of equally many points, one after the other, by quadrilaterals, and closes both ends.
    fn swept(outlines: Vec<Vec<Point3<f64>>>) -> Self {
        let (count, around) = (outlines.len(), outlines.first().map_or(0, Vec::len));
        let at = |section: usize, k: usize| section * around + k % around;
        let quad = |section: usize, k: usize| {
            vec![at(section, k), at(section, k + 1), at(section + 1, k + 1), at(section + 1, k)]
        };
        let mut faces: Vec<Vec<usize>> =
            (1..count).flat_map(|section| (0..around).map(move |k| quad(section - 1, k))).collect();
        faces.push((0..around).rev().collect());
        faces.push((0..around).map(|k| at(count - 1, k)).collect());
        Self { points: outlines.into_iter().flatten().collect(), faces }
    }
}

/// Gives the point of the axle in the wheel profile's plane x \[mm\], in the contact frame \[mm\].
pub fn axle_point(placement: &Placement, x: f64) -> Point3<f64> {
    if let Some(lofted) = placement.lofted_wheel() {
        return Point3::from(lofted.seen([x, 0.0, -placement.wheel_radius()]));
    }
    wheel_point(placement, &Station { x, z: placement.wheel_radius(), ..Station::AXES }, 0.0)
}

/// Gives points of a profile from left to right whose chords depart from it by at most `tolerance` \[mm\].
fn outline(profile: &Profile, tolerance: f64) -> Vec<Station> {
    let (step, tolerance) =
        (TRACED.max(FINEST_TRACE * profile.extent()), tolerance.max(FINEST * profile.extent()));
    let stations: Vec<Station> = trace(profile, step).into_iter().map(|mark| mark.station).collect();
    let mut out = Vec::from_iter(stations.first().copied());
    let mut from = 0;
    for k in 2..stations.len() {
        let between = &stations[from + 1..k];
        if between.iter().any(|station| beside_chord(station, &stations[from], &stations[k]) > tolerance) {
            out.push(stations[k - 1]);
            from = k - 1;
        }
    }
    out.extend(stations.last());
    out
}

/// Gives the distance of a point from the line through two others \[mm\], or from the first where they are one.
fn beside_chord(point: &Station, a: &Station, b: &Station) -> f64 {
    let (along, off) = ([b.x - a.x, b.z - a.z], [point.x - a.x, point.z - a.z]);
    let length = along[0].hypot(along[1]);
    if length > 0.0 { (along[0] * off[1] - along[1] * off[0]).abs() / length } else { off[0].hypot(off[1]) }
}

/// Closes an outline by two corners at the height z \[mm\].
fn closed(stations: &[Station], z: f64) -> Vec<Station> {
    let corner = |station: &Station| Station { z, ..*station };
    let ends = [stations.last(), stations.first()].into_iter().flatten().map(corner);
    stations.iter().copied().chain(ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::placement::Pair;
    use crate::profile::standards;

    #[test]
    fn shells_are_closed_and_follow_their_bodies() -> Result<()> {
        let pair = Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?;
        let placement = pair.placed(0.0, 0.0, 0.01)?;
        for shell in [BodyShell::rail(&placement, 100.0, 0.02), BodyShell::wheel(&placement, 0.5, 0.02)] {
            // Every edge of a closed surface belongs to two faces, once in each direction.
            let mut edges = std::collections::BTreeMap::new();
            for face in &shell.faces {
                for (k, &a) in face.iter().enumerate() {
                    let b = face[(k + 1) % face.len()];
                    *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
                }
            }
            assert!(edges.values().all(|sum| *sum == 0), "{} edges", edges.len());
            assert!(shell.points.len() > 50);
        }
        // What the outline of the wheel leaves out is within the tolerance.
        let wheel = placement.wheel().profile();
        let outline = outline(wheel, 0.02);
        for mark in trace(wheel, 0.1) {
            let away = outline.windows(2).map(|ends| {
                let (a, b) = (ends[0], ends[1]);
                let (dx, dz) = (b.x - a.x, b.z - a.z);
                let share = ((mark.station.x - a.x) * dx + (mark.station.z - a.z) * dz) / (dx * dx + dz * dz);
                let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
                (mark.station.x - a.x - share * dx).hypot(mark.station.z - a.z - share * dz)
            });
            let nearest = away.fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.021, "{mark:?}: {nearest}");
        }
        Ok(())
    }

    #[test]
    fn shells_of_bodies_of_any_size_have_a_bounded_number_of_points() -> Result<()> {
        use crate::profile::{Arc, Half, Segment};
        for size in [1e-6, 1.0, 1e3, 1e6, 1e12] {
            let arc = |radius: f64| {
                let arc = Arc::about([0.0, -radius], radius, Half::Upper, [-0.9 * radius, 0.9 * radius])?;
                Profile::new("arc", "", vec![Segment::arc(arc)])
            };
            let pair = Pair::new(arc(size)?, arc(2.0 * size)?, 460.0 * size)?;
            let placement = pair.placed(0.0, 0.0, 0.0)?;
            for shell in [BodyShell::rail(&placement, 100.0, 0.02), BodyShell::wheel(&placement, 0.5, 0.02)] {
                assert!((5..100_000).contains(&shell.points.len()), "{size}: {}", shell.points.len());
            }
        }
        Ok(())
    }
}
