//! What is usual: values beyond it are allowed but seldom meant, and raise a doubt.
//!
//! Every rule takes values and the place that messages give them, the key of a scene or the argument of a call.

use std::ops::RangeInclusive;

use super::doubts::{Doubt, DoubtKind};
use super::ends::OpenEnd;
use super::landmarks::{Landmarks, Touching};
use super::unmeasured::BridgeInContact;
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::profile::{Profile, Side, points_along};

/// Steepest inclination that raises no doubt \[rad\]: 1:5.
const STEEPEST: f64 = 0.2;

/// Steepest inclination of a rail away from the middle of the track that raises no doubt \[rad\]: 1:100; a measured profile may be
/// turned back by as much.
const OUTWARDS: f64 = 0.01;

/// Largest yaw or roll that raises no doubt \[rad\]: almost 6°.
const LARGE_ANGLE: f64 = 0.1;

/// Least load of a wheel or axle that raises no doubt \[N\].
const LIGHT: f64 = 1000.0;

/// Moduli of what wheels and rails are made of, E or E* \[N/mm²\].
const MODULI: RangeInclusive<f64> = 1e4..=1e6;

/// Largest kink between drawn segments that raises no doubt \[degrees\].
const KINK: f64 = 5.0;

/// Nominal radii of railway wheels \[mm\], from wagons for lorries (180) to locomotives (625).
const RADII: RangeInclusive<f64> = 150.0..=700.0;

/// Radii that another unit may have been meant for \[mm\]: those of most wheels.
const USUAL_RADII: RangeInclusive<f64> = 250.0..=650.0;

/// Gauge less back-to-back distance \[mm\], from trams on grooved rails (50) to broad gauge (85).
const PLAY: RangeInclusive<f64> = 40.0..=110.0;

/// Depths below the top of rail at which gauges are measured \[mm\]: 9 (trams) to 16 (5/8 in).
const GAUGE_HEIGHTS: RangeInclusive<f64> = 5.0..=30.0;

/// Largest distance of a given flange back from the one that the profile shows that raises no doubt \[mm\]: railways measure it to
/// 0.5 mm.
const BACK_OFF: f64 = 1.0;

/// Where the profile shows no back: height of its end over the flange's tip from which on the end is near the back \[mm\], and the
/// largest distance of the given back from that end \[mm\]: backs that are not measured to their whole height end at a rounding of
/// some 10 mm.
const BACK_END: [f64; 2] = [5.0, 10.0];

/// Largest speed that raises no doubt \[m/s\]: 360 km/h.
const FAST: f64 = 100.0;

/// Approaches that are elastic \[mm\]: steel yields at a tenth of the larger end, and no load that a wheel carries makes one as small
/// as the smaller end.
const APPROACHES: RangeInclusive<f64> = 1e-3..=1.0;

/// Largest difference of the tangents at chosen points that raises no doubt \[degrees\]: wheels roll by less.
const TILT: f64 = 2.0;

/// Gives the doubt about a turn of a profile \[rad\] beyond ±0.2 rad, which is steeper than any inclination; of a `rail` also about one
/// away from the middle of the track by more than 0.01 rad.
pub fn turn(place: &str, turn: f64, rail: bool) -> Option<Doubt> {
    if turn.abs() > STEEPEST {
        let found = format!("{place}: {turn} rad is {:.1} degrees, steeper than 1:5", turn.to_degrees());
        return Some(Doubt::new(DoubtKind::Inclination, found));
    }
    let found = || format!("{place}: {turn:.4} rad inclines the rail away from the middle of the track");
    (rail && turn < -OUTWARDS).then(|| Doubt::new(DoubtKind::Outwards, found()))
}

/// Gives the doubt about a yaw or roll beyond ±0.1 rad.
pub fn angle(place: &str, angle: f64) -> Option<Doubt> {
    let found = || format!("{place}: {angle} rad is {:.1} degrees", angle.to_degrees());
    (angle.abs() > LARGE_ANGLE).then(|| Doubt::new(DoubtKind::Angle, found()))
}

/// Gives the doubt about the load of a wheel or axle above 0 and below 1000 N.
pub fn load(place: &str, load: f64) -> Option<Doubt> {
    let found = || format!("{place}: {load} N is the weight of {:.1} kg", load / 9.81);
    (load > 0.0 && load < LIGHT).then(|| Doubt::new(DoubtKind::Load, found()))
}

/// Gives the doubt about a modulus of elasticity outside of 1e4 to 1e6 N/mm².
pub fn modulus(place: &str, modulus: f64) -> Option<Doubt> {
    let found = || format!("{place}: {modulus:e} N/mm² is no metal's");
    (!MODULI.contains(&modulus)).then(|| Doubt::new(DoubtKind::Modulus, found()))
}

/// Gives the doubt about a speed beyond ±100 m/s.
pub fn speed(place: &str, speed: f64) -> Option<Doubt> {
    let found = || format!("{place}: {speed} m/s is {} km/h", 3.6 * speed);
    (speed.abs() > FAST).then(|| Doubt::new(DoubtKind::Speed, found()))
}

/// Gives the doubt about a depth outside of 5 to 30 mm at which a gauge is measured.
pub fn gauge_height(place: &str, height: f64) -> Option<Doubt> {
    let found = || format!("{place}: {height} mm below the top of rail");
    (!GAUGE_HEIGHTS.contains(&height)).then(|| Doubt::new(DoubtKind::GaugeHeight, found()))
}

/// Gives the doubt about a gauge that is not 40 to 110 mm more than the distance of the flange backs \[mm\].
pub fn gauge([place, back_place]: [&str; 2], gauge: f64, back_to_back: f64) -> Option<Doubt> {
    let play = gauge - back_to_back;
    let found = || format!("{place}: {gauge} mm is {play} mm more than {back_place}");
    (!PLAY.contains(&play)).then(|| Doubt::new(DoubtKind::Gauge, found()))
}

/// Gives the doubt about the nominal radius of a wheel outside of 150 to 700 mm, with the units that it may be in.
pub fn radius(place: &str, radius: f64) -> Option<Doubt> {
    if RADII.contains(&radius) {
        return None;
    }
    let read =
        [(0.5, "as a diameter"), (25.4, "in inches"), (12.7, "as a diameter in inches"), (10.0, "in cm")];
    let fitting = read.into_iter().filter(|(unit, _)| USUAL_RADII.contains(&(unit * radius)));
    let meant: String = fitting.map(|(unit, how)| format!(", {:.1} mm {how}", unit * radius)).collect();
    let found = format!("{place}: {radius} mm is no railway wheel's{meant}");
    Some(Doubt::new(DoubtKind::Radius, found))
}

/// Gives the doubt about a wheel whose flange is at its field side; `None` of a wheel without flange.
pub fn flange_side(place: &str, marks: &Landmarks) -> Option<Doubt> {
    let (tip, left) = (marks.tip?, marks.reach.low);
    let found =
        || format!("{place}: the tip of its flange is at x = {:.1} mm, its other end at {left:.1} mm", tip.x);
    (tip.x > left + marks.reach.width() / 2.0).then(|| Doubt::new(DoubtKind::FlangeSide, found()))
}

/// Gives the doubt about the abscissa of a flange back \[mm\] where the wheel's profile shows another one, more than 1 mm away; or of a
/// profile that ends before its back, where it ends more than 10 mm away.
pub fn flange_back_x([place, wheel]: [&str; 2], x: f64, marks: &Landmarks) -> Option<Doubt> {
    let [height, near_end] = BACK_END;
    let end = (marks.back > height).then_some((marks.reach.low, near_end));
    let (back, off) = marks.back_x.map(|back| (back, BACK_OFF)).or(end)?;
    let shown = marks.tip.is_some() && flange_side(wheel, marks).is_none();
    let found = || format!("{place}: {x} mm, and the back of {wheel} is at x = {back:.1} mm");
    (shown && (x - back).abs() > off).then(|| Doubt::new(DoubtKind::FlangeBackX, found()))
}

/// Lists the doubts about kinks of more than 5° of a drawn profile.
pub fn kinks(place: &str, profile: &Profile) -> Vec<Doubt> {
    let sharp = profile.continuity().into_iter().filter(|joint| joint.kink.to_degrees().abs() > KINK);
    let doubt = |joint: crate::profile::Joint| {
        let segments = format!("segments {} and {}", joint.left + 1, joint.left + 2);
        let kink = format!("x = {:.3} mm with a kink of {:.1} degrees", joint.x, joint.kink.to_degrees());
        Doubt::new(DoubtKind::Kink, format!("{place}: {segments} meet at {kink}"))
    };
    sharp.map(doubt).collect()
}

/// Gives the doubt about an approach outside of 1e-3 to 1 mm. A small one that is `estimated` from a load raises none, since the load
/// has its own; nor does 0, which asks for the geometry.
pub fn approach(rail: &Profile, approach: f64, estimated: bool) -> Option<Doubt> {
    if !estimated && approach > 0.0 && approach < *APPROACHES.start() {
        let in_m = 1e3 * approach;
        let found = format!("an approach of {approach:e} mm, which would be {in_m} mm if it were in m");
        return Some(Doubt::new(DoubtKind::Approach, found));
    }
    if approach <= *APPROACHES.end() {
        return None;
    }
    let height = Interval::around(points_along(rail, 1.0).iter().map(|at| at.y)).width();
    let beyond = if approach > height { ", more than the rail's profile is high" } else { "" };
    Some(Doubt::new(DoubtKind::Approach, format!("an approach of {approach:.4} mm{beyond}")))
}

/// Gives the doubt about an end of a profile in a contact.
pub fn profile_end(end: OpenEnd) -> Doubt {
    let body = if end.side == Side::Rail { "rail" } else { "wheel" };
    let found = format!("{body}: its profile ends at x = {:.2} mm, in the contact", end.x);
    Doubt::new(DoubtKind::ProfileEnd, found)
}

/// Gives the doubt about a contact where a file shows no surface.
pub fn unmeasured(bridge: BridgeInContact) -> Doubt {
    let BridgeInContact { side, name, rows, x: [from, to] } = bridge;
    let body = if side == Side::Rail { "rail" } else { "wheel" };
    let found =
        format!("{body}: {name}: {rows}: no surface from x = {from:.2} to {to:.2} mm, in the contact");
    Doubt::new(DoubtKind::Unmeasured, found)
}

/// Gives the doubt about chosen points whose tangents differ by more than 2°.
pub fn tilt(place: &str, placement: &Placement) -> Option<Doubt> {
    let angles = [placement.rail(), placement.wheel()].map(|body| body.contact_angle().to_degrees());
    let tilt = angles[0] - angles[1];
    let found = || format!("{place}: the tangents at rail_x and wheel_x differ by {tilt:.2} degrees");
    (tilt.abs() > TILT).then(|| Doubt::new(DoubtKind::Tilt, found()))
}

/// Lists the doubts about the way that a wheel stands on its rail, by the landmarks of the pair. `other` is the height \[mm\] of the other
/// wheel's tread over its rail, 0 for a single wheel.
pub fn standing(marks: &Landmarks, placement: &Placement, other: f64) -> Vec<Doubt> {
    let touching = Touching::from(placement);
    let doubts = marks.doubts(&touching, [marks.lift(&touching), other]);
    doubts.list().map(|(kind, value)| Doubt::of_contact(kind, value, placement.wheel_radius())).collect()
}
