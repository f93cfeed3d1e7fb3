//! A place of contact as rail and wheel have it: their points, tangents, normal and curvatures there.

use super::above::{SweptAbove, into_wheel, out_of_wheel};
use super::settle::{FoundPlace, SettledPlace};
use crate::lofted::SurfacePoint;
use crate::profile::{Side, Station};
use crate::search::candidates::{Candidate, Meeting};
use crate::search::touch::Contact;

/// A place as rail and wheel have it.
struct TouchPlace {
    /// Upward unit normal of the rail, in its axes; at a kink of the rail that of the wheel.
    normal: [f64; 3],
    /// x and z on the rail \[mm\].
    rail: [f64; 2],
    /// x and z on the wheel's profile \[mm\].
    wheel: [f64; 2],
    /// Sine and cosine of the wheel profile's tangent.
    tangent: [f64; 2],
    /// Sine and cosine of the angle about the wheel's axle, from the lowest meridian.
    around: [f64; 2],
    /// Distance from the axle \[mm\].
    rolling_radius: f64,
    /// Curvatures of the rail's section across the track and of the wheel's profile \[1/mm\], + with the hollow side up.
    curvatures: [f64; 2],
    /// Whether rail and wheel touch with a kink or an end.
    kinks: [bool; 2],
    /// How far ahead of the wheel's centre it lies \[mm\].
    y: f64,
    /// The angle around a wheel that varies, as its slices count, and that of the normal out of the meridian plane \[rad\]; else 0.
    on_wheel: [f64; 2],
}

impl TouchPlace {
    fn new(over: &SweptAbove<'_>, found: &FoundPlace, along: f64) -> Self {
        let SettledPlace { below, above, at_end, kink, .. } = &found.settled;
        let ([x, h], radius) = (below.own.at, over.attitude.radius);
        let normal = over.upward(normal(over, &found.settled));
        let ends = at_end.contains(&true);
        let section = if at_end[0] { f64::NEG_INFINITY } else { section_curvature(&below.own) };
        if over.varying == Side::Rail {
            let [_, y, z] = above.at;
            let rolling_radius = (radius - z).hypot(y);
            return Self {
                normal,
                rail: [x, h],
                wheel: [above.at[0], radius - rolling_radius],
                tangent: above.tangent,
                around: [y / rolling_radius, (radius - z) / rolling_radius],
                rolling_radius,
                curvatures: [section, if *kink { f64::INFINITY } else { above.curvature }],
                kinks: [ends, *kink],
                y: below.own.y - along - over.attitude.along,
                on_wheel: [0.0; 2],
            };
        }
        let (sin, cos) = ((below.own.y - along) / radius).sin_cos();
        // The meridian's tangent is perpendicular to the common normal, however the wheel varies around the axle.
        let [nx, ny, nz] = into_wheel(over.attitude, normal);
        let inward = nz * cos - ny * sin;
        let length = nx.hypot(inward);
        Self {
            normal,
            rail: [above.at[0], -above.at[2]],
            wheel: [x, -h],
            tangent: [-nx / length, inward / length],
            around: [sin, cos],
            rolling_radius: radius + h,
            curvatures: [if *kink { f64::NEG_INFINITY } else { -above.curvature }, -section],
            kinks: [*kink, ends],
            y: over.seen(below.at)[1] - over.attitude.along,
            on_wheel: [below.own.y / radius, (ny * cos + nz * sin).asin()],
        }
    }
}

/// Gives the common unit normal at a place, out of the varying body, in the swept body's axes: that of the body which is smooth there.
/// That of an extruded rail has no component along the track.
fn normal(over: &SweptAbove<'_>, settled: &SettledPlace) -> [f64; 3] {
    let SettledPlace { below, above, at_end, kink, .. } = settled;
    let n = if at_end.contains(&true) || (over.varying == Side::Wheel && !kink) {
        [-above.slopes[0], -above.slopes[1], 1.0]
    } else {
        let ([xu, yu, zu], [xy, yy, zy]) = (below.across, below.along);
        over.turned([yu * zy - zu * yy, zu * xy - xu * zy, xu * yy - yu * xy])
    };
    let length = n[0].hypot(n[1]).hypot(n[2]);
    n.map(|component| component / length)
}

pub(super) fn candidate(over: &SweptAbove<'_>, found: &FoundPlace) -> Candidate {
    let place = TouchPlace::new(over, found, 0.0);
    let [x, _, z] = place.normal;
    let length = x.hypot(z);
    let [sin, cos] = place.tangent;
    Candidate {
        gap: found.settled.above.gap,
        rail: Station { x: place.rail[0], z: place.rail[1], cos: z / length, sin: -x / length },
        wheel: Station { x: place.wheel[0], z: place.wheel[1], cos, sin },
        wheel_radius: place.curvatures[1].recip(),
        rail_radius: place.curvatures[0].recip(),
        meeting: Meeting { elements: [0, found.strip as u32], parameters: found.settled.place, turn: 0.0 },
    }
}

/// Computes the curvature of the surface's section across \[1/mm\], + with the hollow side up.
fn section_curvature(own: &SurfacePoint) -> f64 {
    let ([x, z], [xx, zz]) = (own.across, own.across2);
    (x * zz - z * xx) / x.hypot(z).powi(3)
}

pub(super) fn contact(over: &SweptAbove<'_>, found: &FoundPlace, along: f64, height: f64) -> Contact {
    let place = TouchPlace::new(over, found, along);
    let normal = place.normal;
    let (theta, ahead) = ((-normal[0]).atan2(normal[2]), normal[1].asin());
    let (cos, sin) = (theta.cos(), theta.sin());
    // ξ lies in the section across the track, η completes ξ, η, ζ.
    let eta = [normal[1] * sin, normal[2] * cos - normal[0] * sin, -normal[1] * cos];
    let ([s, c], [behind, down]) = (place.tangent, place.around);
    let meridian = out_of_wheel(over.attitude, [c, -s * behind, s * down]);
    let on = |axis: [f64; 3]| (0..3).map(|k| meridian[k] * axis[k]).sum::<f64>();
    Contact {
        rail_x: place.rail[0],
        wheel_x: place.wheel[0],
        rail_z: place.rail[1],
        wheel_z: place.wheel[1],
        y: place.y,
        turn: ahead,
        around: place.on_wheel[0],
        lean: place.on_wheel[1],
        contact_angle: theta,
        wheel_angle: s.atan2(c),
        skew: on(eta).atan2(on([cos, 0.0, sin])),
        gap: found.settled.above.gap + height,
        rolling_radius: place.rolling_radius,
        rail_curvature: place.curvatures[0],
        wheel_curvature: place.curvatures[1],
        roller_curvature: 0.0,
        rail_kink: place.kinks[0],
        wheel_kink: place.kinks[1],
    }
}
