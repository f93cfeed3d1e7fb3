//! Track and wheelset: where the four profiles' origins are.
//!
//! Track axes: x to the right, y forward, z up, right-handed; x = 0 in the middle of the track, z = 0 at the top of
//! rail. The right side is described; the left side is its mirror image under x → −x.
//! Yaw ψ about z is applied first: > 0 moves the right-hand wheel forward. Roll about y is applied second: > 0 lowers
//! the right-hand wheel. The drawing of every axis, distance and sign is `src/docs/axes.svg`, shown in the crate's
//! `docs::conventions`.

use crate::error::{Error, Result, finite};
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::profile::{
    Branch, Profile, Section, Segment, Side, Station, last_groove, parallel_to, points_along,
};

/// Where the rails are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RailDistance {
    /// Distance \[mm\] between the rails' inner faces, measured at most `height` \[mm\] below the top of rail: between the
    /// innermost points of the heads down to there. Typically 1435 and 14.
    Gauge {
        /// The gauge \[mm\].
        gauge: f64,
        /// Depth below the top of rail \[mm\].
        height: f64,
    },
    /// Distance \[mm\] between the two rail profiles' origins. Typically 1500.
    Spacing(f64),
}

/// Where the wheels are on their axle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WheelDistance {
    /// Distance \[mm\] between the flange backs, which lie at `flange_back_x` \[mm\] on the wheel profile. Typically 1360
    /// and −70.
    BackToBack {
        /// The back-to-back distance \[mm\].
        distance: f64,
        /// Abscissa of the flange back on the wheel profile \[mm\].
        flange_back_x: f64,
    },
    /// Distance \[mm\] between the two wheel profiles' origins. Typically 1500.
    Spacing(f64),
}

/// A track: where the right-hand rail's profile origin is in track axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track {
    /// Abscissa of the origin \[mm\], positive; the left-hand one has the negative.
    pub(crate) rail_x: f64,
    /// Height of the origin \[mm\], relative to the top of rail, + up: minus the profile's highest z.
    pub(crate) rail_z: f64,
}

/// A wheelset: its two wheels on a rigid axle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheelset {
    /// Distance \[mm\] of the right-hand wheel's profile origin from the middle of the axle, along the axle.
    pub(crate) wheel_x: f64,
    /// Nominal rolling radius R \[mm\] of both wheels.
    pub(crate) radius: f64,
}

impl Track {
    /// Makes the track of a right-hand rail profile as placed (inclined), and its mirror image. Top of rail and gauge are those
    /// of the head that wheels run on: of a grooved rail the one at the field side, not the keeper.
    ///
    /// # Errors
    /// A profile without a rail head; distances that are not positive, a negative gauge height; a gauge height within which the head has
    /// no inner face: a profile that ends above it and is not vertical there.
    pub fn new(rail: &Profile, distance: RailDistance) -> Result<Self> {
        let head = RunningHead::of(rail);
        let top = head.highest();
        if !top.is_finite() {
            return Err(Error::new(&rail.name, "no surface", "a rail head", "reverse or mirror the profile"));
        }
        let rail_x = match distance {
            RailDistance::Spacing(spacing) => positive("track: spacing", spacing)? / 2.0,
            RailDistance::Gauge { gauge, height } => {
                positive("track: gauge", gauge)?;
                if finite("track: gauge_height", height)? < 0.0 {
                    let advice = "give the depth below the top of rail as a positive number";
                    return Err(Error::new("track: gauge_height", height.to_string(), "0 or more", advice));
                }
                gauge / 2.0 - gauge_face(rail, &head, top, height)?
            }
        };
        Ok(Self { rail_x, rail_z: -top })
    }

    /// Makes the track of rails that vary along the track, which have no top of their own: their profile origins lie this far apart
    /// \[mm\], at height 0.
    ///
    /// # Errors
    /// A distance that is not positive.
    pub fn between_origins(spacing: f64) -> Result<Self> {
        Ok(Self { rail_x: positive("track: spacing", spacing)? / 2.0, rail_z: 0.0 })
    }

    /// Moves the rail of this side outwards and up \[mm\].
    ///
    /// # Errors
    /// Moves that are not finite; a rail that would be at the middle of the track or beyond.
    pub fn moved(&self, outwards: f64, up: f64) -> Result<Self> {
        let rail_x = self.rail_x + finite("lateral", outwards)?;
        if rail_x <= 0.0 {
            let expected = format!("a rail on its side of the track, {} mm from the middle", self.rail_x);
            return Err(Error::new("lateral", outwards.to_string(), expected, "give it in mm"));
        }
        Ok(Self { rail_x, rail_z: self.rail_z + finite("vertical", up)? })
    }

    /// Returns the distance \[mm\] of a rail's inner face from the middle of the track: half a gauge that is measured at most `height`
    /// \[mm\] below the top of rail.
    ///
    /// # Errors
    /// A depth within which the head has no inner face.
    pub fn half_gauge(&self, rail: &Profile, height: f64) -> Result<f64> {
        let head = RunningHead::of(rail);
        Ok(self.rail_x + gauge_face(rail, &head, head.highest(), height)?)
    }

    /// Returns the abscissa \[mm\] of the right-hand profile origin, positive; the left-hand one has the negative.
    pub fn rail_x(&self) -> f64 {
        self.rail_x
    }

    /// Returns the height \[mm\] of the profile origin, relative to the top of rail, + up.
    pub fn rail_z(&self) -> f64 {
        self.rail_z
    }
}

impl Wheelset {
    /// Makes a wheelset of two equal wheels.
    ///
    /// # Errors
    /// Distances or a radius that are not positive numbers.
    pub fn new(distance: WheelDistance, radius: f64) -> Result<Self> {
        let wheel_x = match distance {
            WheelDistance::Spacing(spacing) => positive("wheelset: spacing", spacing)? / 2.0,
            WheelDistance::BackToBack { distance, flange_back_x } => {
                positive("wheelset: back_to_back", distance)? / 2.0
                    - finite("wheelset: flange_back_x", flange_back_x)?
            }
        };
        positive("wheelset: distance of the wheels' profile origins", wheel_x)?;
        Ok(Self { wheel_x, radius: positive("wheel: radius", radius)? })
    }

    /// Returns the distance \[mm\] of the right-hand profile origin from the middle of the axle, along the axle.
    pub fn wheel_x(&self) -> f64 {
        self.wheel_x
    }

    /// Returns the nominal rolling radius R \[mm\] of both wheels.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

fn positive(place: &str, value: f64) -> Result<f64> {
    if finite(place, value)? > 0.0 {
        return Ok(value);
    }
    Err(Error::new(place, value.to_string(), "a positive number", "give it in mm"))
}

/// Distance \[mm\] of the points by which a groove, some 40 mm wide, is told from a head.
const GROOVE_STEP: f64 = 1.0;

/// The head that wheels run on.
struct RunningHead {
    section: Section,
    /// Its least abscissa \[mm\], the bottom of a groove; −∞ for all of the profile.
    from: f64,
}

impl RunningHead {
    fn of(rail: &Profile) -> Self {
        let points = points_along(rail, GROOVE_STEP);
        let heights: Vec<f64> = points.iter().map(|at| at.y).collect();
        let from = last_groove(&heights).map_or(f64::NEG_INFINITY, |bottom| points[bottom].x);
        Self { section: Section::own_axes(rail, Side::Rail), from }
    }

    /// Lists the branches with the intervals on which they are the head's surface, in order of x.
    fn stretches(&self) -> impl Iterator<Item = (&Branch, Interval)> {
        let seen = Interval { low: self.from, ..Interval::ALL };
        let inside = self.section.pieces.iter().filter(move |piece| piece.xi.high > seen.low);
        inside.map(move |piece| (&self.section.branches[piece.branch], piece.xi.cut(seen)))
    }

    /// Finds the greatest height \[mm\].
    fn highest(&self) -> f64 {
        self.stretches().map(|(branch, xi)| summit(branch, xi)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Finds the least abscissa where the head is at least `level` high \[mm\].
    fn innermost(&self, level: f64) -> Option<f64> {
        self.stretches().find_map(|(branch, xi)| first_at_level(branch, xi, level))
    }
}

/// Returns the ends of an interval and the places between them where a branch is level, ascending: it is monotone from each to the
/// next.
fn turns(branch: &Branch, xi: Interval) -> Vec<f64> {
    let level = parallel_to(branch, [1.0, 0.0], xi);
    [xi.low].into_iter().chain(level).chain([xi.high]).collect()
}

/// Finds the greatest height of a branch over an interval \[mm\].
fn summit(branch: &Branch, xi: Interval) -> f64 {
    turns(branch, xi).into_iter().map(|x| branch.height(x)).fold(f64::NEG_INFINITY, f64::max)
}

/// Cosine below which a tangent is vertical: rounding leaves 2e-8 of a vertical one, and a face of 100 mm that leans by
/// this is off by 0.1 µm.
const VERTICAL: f64 = 1e-6;

/// Finds the abscissa of the innermost point of the head within `height` of its top \[mm\].
fn gauge_face(rail: &Profile, head: &RunningHead, top: f64, height: f64) -> Result<f64> {
    // Where the profile ends above the level, the head goes on unseen, further in unless it is vertical there.
    let end = rail.segments().first().map(Segment::start).filter(|end| end.x >= head.from);
    let cut = end.filter(|end| end.z > top - height && end.cos > VERTICAL);
    if let (None, Some(x)) = (cut, head.innermost(top - height)) {
        return Ok(x);
    }
    let found = match cut {
        Some(Station { x, z, .. }) => {
            format!("{height} mm, while the profile ends {:.3} mm below its top at x = {x}", top - z)
        }
        None => format!("{height} mm, where the head has no face"),
    };
    let expected = "a depth to which the profile has the inner side of the head";
    Err(Error::new(
        "track: gauge_height",
        found,
        expected,
        "give another gauge_height, or more of the profile",
    ))
}

/// Finds the least abscissa of an interval where a branch is at least `level` high \[mm\].
fn first_at_level(branch: &Branch, xi: Interval, level: f64) -> Option<f64> {
    let turns = turns(branch, xi);
    let above = |x: f64| branch.height(x) - level;
    let first = turns.iter().position(|&x| above(x) >= 0.0)?;
    if first == 0 {
        return Some(turns[0]);
    }
    bracketed(above, turns[first - 1], turns[first])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::{inclination, standards};
    use nalgebra::UnitComplex;

    fn inclined(name: &str, n: f64) -> Result<Profile> {
        Ok(standards::rail(name)?.rotated(inclination(1.0, n)?))
    }

    #[test]
    fn an_upright_rail_has_its_half_width_at_the_gauge_face() -> Result<()> {
        let distance = RailDistance::Gauge { gauge: 1435.0, height: 14.0 };
        let track = Track::new(&standards::rail("46E1")?, distance)?;
        // The corner arc of radius 13 about (−19.5, −14.30) is at −14 a little inside of its vertical tangent.
        assert!((track.rail_x - 717.5 - 32.4967).abs() < 1e-3, "{}", track.rail_x);
        assert_eq!(track.rail_z, 0.0);
        let deep = RailDistance::Gauge { gauge: 1435.0, height: 20.0 };
        let track = Track::new(&standards::rail("46E1")?, deep)?;
        assert!((track.rail_x - 717.5 - 32.500_161_5).abs() < 1e-6, "{}", track.rail_x);
        Ok(())
    }

    #[test]
    fn a_gauge_height_below_the_profile_is_an_error() -> Result<()> {
        let at = |rail: &Profile, height| Track::new(rail, RailDistance::Gauge { gauge: 1435.0, height });
        let rail = standards::rail("60E1")?;
        assert!(at(&rail, 14.0).is_ok());
        for height in [60.0, 1000.0] {
            let error = at(&rail, height).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(error.contains(&format!("track: gauge_height: found {height} mm, while")), "{error}");
        }
        // A crown without its side faces.
        let crown =
            crate::profile::Arc::about([0.0, -300.0], 300.0, crate::profile::Half::Upper, [-20.0, 20.0])?;
        let crown = Profile::new("crown", "", vec![Segment::arc(crown)])?;
        assert!(at(&crown, 14.0).is_err() && at(&crown, 0.5).is_ok());
        Ok(())
    }

    #[test]
    fn the_top_of_an_inclined_rail_is_its_crown_s_highest_point() -> Result<()> {
        let track = Track::new(&inclined("60E1", 40.0)?, RailDistance::Spacing(1500.0))?;
        let tilt = 40f64.recip().atan();
        assert!((track.rail_z + 300.0 * (1.0 - tilt.cos())).abs() < 1e-12, "{}", track.rail_z);
        assert_eq!(track.rail_x, 750.0);
        Ok(())
    }

    #[test]
    fn a_grooved_rail_is_gauged_at_its_head_however_high_the_keeper() -> Result<()> {
        let head = standards::rail("60E1")?;
        let distance = RailDistance::Gauge { gauge: 1435.0, height: 14.0 };
        let single = Track::new(&head, distance)?;
        let flank = |end: &Station| end.z > -30.0;
        let own = head.segments().iter().filter(|s| flank(&s.start()) && flank(&s.end())).cloned();
        for keeper in [-8.0, 5.0] {
            let line = |a, b| crate::profile::Arc::line(a, b).map(Segment::arc);
            let first = own.clone().next().map_or([0.0; 2], |s| [s.start().x, s.start().z]);
            let mut chain = vec![
                line([-90.0, keeper], [-78.0, keeper])?,
                line([-78.0, keeper], [-74.0, -45.0])?,
                line([-74.0, -45.0], [-40.0, -45.0])?,
                line([-40.0, -45.0], first)?,
            ];
            chain.extend(own.clone());
            let grooved = Track::new(&Profile::new("grooved", "", chain)?, distance)?;
            assert_eq!(grooved, single, "keeper at {keeper}");
        }
        Ok(())
    }

    #[test]
    fn gauge_faces_are_found_on_polynomials() -> Result<()> {
        // z = −x²/10 is 14 deep at x = −√140.
        let polynomial = crate::profile::Polynomial::graph(&[0.0, 0.0, -0.1], [-20.0, 20.0])?;
        let shape = crate::profile::Shape::Polynomial(polynomial);
        let rail =
            Profile::new("parabola", "", vec![crate::profile::Segment { label: String::new(), shape }])?;
        let track = Track::new(&rail, RailDistance::Gauge { gauge: 1435.0, height: 14.0 })?;
        assert!((track.rail_x - 717.5 - 140f64.sqrt()).abs() < 1e-12, "{}", track.rail_x);
        assert!(track.rail_z.abs() < 1e-13, "{}", track.rail_z);
        Ok(())
    }

    #[test]
    fn a_level_and_a_wavy_polynomial_take_no_search_without_end() -> Result<()> {
        let gauged = |c: &[f64], x| {
            let shape = crate::profile::Shape::Polynomial(crate::profile::Polynomial::graph(c, x)?);
            let rail =
                Profile::new("top", "", vec![crate::profile::Segment { label: String::new(), shape }])?;
            let head = RunningHead::of(&rail);
            Ok::<_, Error>((head.highest(), head.innermost(0.5)))
        };
        let (top, first) = gauged(&[1.0, 0.0, 1e-30], [-20.0, 20.0])?;
        assert!((top - 1.0).abs() < 1e-12 && first == Some(-20.0), "{top} {first:?}");
        // T₅(x / 20) rises from −1 to its first crest.
        let (top, first) = gauged(&[0.0, 5.0 / 20.0, 0.0, -20.0 / 8e3, 0.0, 16.0 / 3.2e6], [-20.0, 20.0])?;
        assert!((top - 1.0).abs() < 1e-12, "{top}");
        // cos 5t = ½ at t = π − 2π/15 from the left.
        let expected = 20.0 * (std::f64::consts::PI * 13.0 / 15.0).cos();
        assert!(first.is_some_and(|x| (x - expected).abs() < 1e-11), "{first:?} {expected}");
        Ok(())
    }

    /// Changes of an angle from a last digit to 1e-9 rad, around those that inclined rails have.
    fn near(angle: f64) -> Vec<f64> {
        let ulp = f64::EPSILON * angle / 2.0;
        let mut steps: Vec<f64> = (1..=8).map(|k| f64::from(k) * ulp).collect();
        steps.extend((1..=7).map(|k| 10f64.powi(k - 16)));
        steps.iter().flat_map(|step| [angle - step, angle + step]).collect()
    }

    #[test]
    fn a_track_does_not_jump_when_an_angle_changes_in_its_last_digit() -> Result<()> {
        // No point of a head is farther than this from the origin, mm: what an angle of 1 rad moves it by at most.
        let lever = 80.0;
        let mut compared = 0;
        for name in standards::rail_names() {
            let rail = standards::rail(name)?;
            for angle in [20f64.recip().atan(), 40f64.recip().atan(), 0.05, 0.0] {
                for angle in [angle, -angle] {
                    let track = |angle: f64| {
                        let rail = rail.rotated(UnitComplex::new(angle));
                        Track::new(&rail, RailDistance::Gauge { gauge: 1435.0, height: 14.0 })
                    };
                    // A head that ends above the level has no gauge face there.
                    let Ok(base) = track(angle) else { continue };
                    for other in near(angle) {
                        let (track, allowed) = (track(other)?, lever * (other - angle).abs() + 1e-12);
                        let moved = (track.rail_z - base.rail_z).abs();
                        assert!(moved <= allowed, "{name} {other}: {moved:e} of {allowed:e} up");
                        // The gauge point may run along the face: as much again over its slope.
                        let moved = (track.rail_x - base.rail_x).abs();
                        assert!(moved <= 4.0 * allowed, "{name} {other}: {moved:e} of {allowed:e} aside");
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared > 25 * 4 * 30, "{compared}");
        Ok(())
    }

    #[test]
    fn a_side_face_that_is_vertical_to_rounding_is_no_top_of_rail() -> Result<()> {
        let rail = standards::rail("60E1")?;
        let heights = [0.049_958_395_721_942_765f64, 20f64.recip().atan()].map(|angle| {
            let rail = rail.rotated(UnitComplex::new(angle));
            Track::new(&rail, RailDistance::Gauge { gauge: 1435.0, height: 14.0 }).map(|track| track.rail_z)
        });
        let [found, expected] = [heights[0].clone()?, heights[1].clone()?];
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        Ok(())
    }

    #[test]
    fn back_to_back_and_spacing_give_the_same_wheelset() -> Result<()> {
        let by_backs =
            Wheelset::new(WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 }, 460.0)?;
        assert_eq!(by_backs, Wheelset::new(WheelDistance::Spacing(1500.0), 460.0)?);
        assert!(Wheelset::new(WheelDistance::Spacing(-1.0), 460.0).is_err());
        assert!(Wheelset::new(WheelDistance::Spacing(1500.0), f64::NAN).is_err());
        Ok(())
    }
}
