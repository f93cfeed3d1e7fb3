//! The motion of a wheel over its rail, and the creepages that follow from it at a contact.
//!
//! Both bodies are rigid and the rail is at rest. The wheel's velocity at C is that of the middle of its axle plus
//! ω × (C − middle). All of it follows from the placed pair: the skew and the two contact angles say how the axle lies in
//! the contact frame. Signs are those of `src/docs/conventions.md`, shown in the crate's `docs::conventions`.

use nalgebra::Vector3;

use super::placed::Placement;
use crate::error::{Error, Result, finite};
use crate::lofted::FramedLoft;

/// How fast a wheel turns about its axle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Pitch {
    /// The wheel rolls without braking or driving: −speed/r, r the mean of the rolling radii at which the two wheels of
    /// the wheelset touch first, or that of a wheel alone.
    #[default]
    Rolling,
    /// The wheel turns by −speed/R, R its nominal rolling radius.
    Nominal,
    /// The wheel turns at this rate \[rad/s\], by the right-hand rule about the axle's direction to the right: negative
    /// forward, typically −50.
    Rate(f64),
}

/// Rates of a wheelset, or of a wheel alone, besides its forward speed, against the track at rest; all 0 in pure rolling.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rates {
    /// Lateral velocity of the axle's middle \[mm/s\], + to the right.
    pub lateral: f64,
    /// Vertical velocity of the axle's middle \[mm/s\], + up.
    pub vertical: f64,
    /// Rate of yaw \[rad/s\], + moves the right-hand wheel forward. A steady curve to the left of radius ρ has speed/ρ.
    pub yaw: f64,
    /// Rate of roll \[rad/s\], + lowers the right-hand wheel.
    pub roll: f64,
    /// How fast the wheels turn.
    pub pitch: Pitch,
}

/// The motion of a wheelset, or of a wheel alone, at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    speed: f64,
    rates: Rates,
}

/// Relative motion at a contact: rail minus wheel, over the rolling speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Creepages {
    /// Along η, forward \[–\]: positive where the wheel's surface moves backward over the rail, as under traction.
    pub longitudinal: f64,
    /// Along ξ \[–\]: positive where the wheel's surface moves to −ξ over the rail.
    pub lateral: f64,
    /// Spin \[rad/mm\] about −ζ, from wheel to rail: sin θ/r for a wheel that only rolls.
    pub spin: f64,
    /// Angular velocity of the wheel about ξ and η, over V \[rad/mm\]: about −1/r and 0 for a wheel that only rolls.
    pub turn: [f64; 2],
    /// The rolling speed V \[mm/s\], positive: mean of translational and circumferential speed along η.
    pub rolling_speed: f64,
    /// Whether the contact moves to +η.
    pub forward: bool,
    /// The rate of pitch \[rad/s\], given or found.
    pub pitch: f64,
}

impl Motion {
    /// Makes a motion of a forward speed \[mm/s\] and rates. A negative speed goes backwards.
    ///
    /// # Errors
    /// Values that are not finite; a speed of 0, over which no creepage is defined.
    pub fn new(speed: f64, rates: Rates) -> Result<Self> {
        let Rates { lateral, vertical, yaw, roll, pitch } = rates;
        let pitch = if let Pitch::Rate(rate) = pitch { rate } else { 0.0 };
        let named =
            [("lateral", lateral), ("vertical", vertical), ("yaw", yaw), ("roll", roll), ("pitch", pitch)];
        named.into_iter().try_for_each(|(key, value)| finite(key, value).map(drop))?;
        if finite("speed", speed)? == 0.0 {
            return Err(Error::new("speed", "0", "a forward speed other than 0", "leave the motion out"));
        }
        Ok(Self { speed, rates })
    }

    /// Gives the forward speed \[mm/s\].
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Gives all rates other than the forward speed.
    pub fn rates(&self) -> &Rates {
        &self.rates
    }

    /// Gives the mirror image of the motion under x → −x: that of a left side described as a right one.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let Rates { lateral, yaw, roll, .. } = self.rates;
        Self { rates: Rates { lateral: -lateral, yaw: -yaw, roll: -roll, ..self.rates }, ..*self }
    }

    /// Computes the creepages of a placed pair, in its contact frame.
    ///
    /// `half` is the distance of the wheel profile's origin from the middle of the axle, along the axle \[mm\]; 0 for a wheel
    /// alone. `radius` is the rolling radius \[mm\] of [`Pitch::Rolling`]. Exact for rigid bodies, with no small angles
    /// assumed. The part of the velocity along ζ does not enter: it opens or closes the contact.
    ///
    /// # Errors
    /// A wheel that neither moves nor turns along η at C; a roller, whose own turning is not known.
    pub fn creepages(&self, placement: &Placement, half: f64, radius: f64) -> Result<Creepages> {
        if placement.under().is_some() {
            return Err(on_roller());
        }
        let Rates { lateral, vertical, yaw, roll, pitch } = self.rates;
        let pitch = match pitch {
            Pitch::Rolling => -self.speed / radius,
            Pitch::Nominal => -self.speed / placement.wheel_radius(),
            Pitch::Rate(rate) => rate,
        };
        let axes = ContactDirections::new(placement);
        let up = axes.up * placement.rolling_radius();
        let arm = axes.axle * (half + placement.wheel().point.station.x) - up;
        let slow = axes.yaw * yaw + axes.ahead * roll;
        let carried =
            axes.ahead * self.speed + axes.track_x * lateral + axes.track_z * vertical + slow.cross(&arm);
        let fast = axes.axle * pitch;
        let turned = fast.cross(&-up);
        let speed = (carried.y.abs() + turned.y.abs()) / 2.0;
        if speed == 0.0 {
            let expected = "a wheel that moves or turns along the rail where it touches";
            return Err(Error::new("motion", "a wheel at rest", expected, "correct yaw and pitch"));
        }
        let velocity = carried + turned;
        // 0 without a sign.
        let over = |rate: f64| 0.0 + rate / speed;
        Ok(Creepages {
            longitudinal: over(-velocity.y),
            lateral: over(-velocity.x),
            spin: over((slow + fast).z),
            turn: [over((slow + fast).x), over((slow + fast).y)],
            rolling_speed: speed,
            forward: if carried.y.abs() >= turned.y.abs() { carried.y > 0.0 } else { turned.y < 0.0 },
            pitch,
        })
    }
}

impl Creepages {
    /// Computes the slip of the rail over the wheel at a point (ξ, η, ζ) of their surface \[mm\], over V: along η, and along the surface's
    /// tangent at the angle α, whose normal (−sin α, cos α) is given. At C it is the two creepages.
    ///
    /// Exact for rigid bodies: it holds the growth of the rolling radius and the turning of the normal, of which creepages and
    /// spin are the linear part on the tangent plane. The velocity of C along ζ does not enter.
    pub fn slip_at(&self, point: [f64; 3], [n_xi, n_zeta]: [f64; 2]) -> [f64; 2] {
        let ([xi, eta, zeta], [w_xi, w_eta]) = (point, self.turn);
        let along_xi = self.lateral - w_eta * zeta + self.spin * eta;
        let along_zeta = w_eta * xi - w_xi * eta;
        [self.longitudinal - self.spin * xi + w_xi * zeta, along_xi * n_zeta - along_zeta * n_xi]
    }
}

/// Returns the error of a motion over a roller.
pub(crate) fn on_roller() -> Error {
    let expected = "a rail at rest; creepages are not available for rollers yet";
    Error::new("motion", "a motion over a roller", expected, "leave the motion out")
}

/// Directions in the contact frame (ξ, η, ζ), all of length 1.
struct ContactDirections {
    /// The axle, to the right.
    axle: Vector3<f64>,
    /// From C to the axle.
    up: Vector3<f64>,
    /// The track's x, to the right.
    track_x: Vector3<f64>,
    /// The track's y, forward.
    ahead: Vector3<f64>,
    /// The track's z, up.
    track_z: Vector3<f64>,
    /// The axis that the wheelset yaws about: the track's z, turned by the roll.
    yaw: Vector3<f64>,
}

impl ContactDirections {
    fn new(placement: &Placement) -> Self {
        let [rail, wheel] = [placement.rail(), placement.wheel()].map(|body| body.point.station);
        // A direction of a body that varies is a column of its frame's axes.
        let seen = |lofted: &FramedLoft, k: usize| Vector3::from(lofted.axes().map(|axis| axis[k]));
        let across = placement.skew_rotation();
        let across = Vector3::new(across.re, across.im, 0.0);
        let [axle, up] = match placement.lofted_wheel() {
            Some(lofted) => [seen(lofted, 0), -seen(lofted, 2)],
            None => {
                [across * wheel.cos - Vector3::z() * wheel.sin, across * wheel.sin + Vector3::z() * wheel.cos]
            }
        };
        let [track_x, ahead, track_z] = match placement.lofted_rail() {
            Some(lofted) => [0, 1, 2].map(|k| seen(lofted, k)),
            None => {
                [Vector3::new(rail.cos, 0.0, -rail.sin), Vector3::y(), Vector3::new(rail.sin, 0.0, rail.cos)]
            }
        };
        let yaw = (track_z * axle.dot(&track_x) - track_x * axle.dot(&track_z)).normalize();
        Self { axle, up, track_x, ahead, track_z, yaw }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::Pair;
    use crate::profile::{Arc, Profile, Segment};

    const SPEED: f64 = 20_000.0;
    const RADIUS: f64 = 460.0;
    const HALF: f64 = 750.0;
    const CLOSE: f64 = 1e-14;

    /// A cone that rises to the right by an angle over a plane of the same angle, touching at x on both.
    fn cone(angle: f64, x: f64, skew: f64) -> Placement {
        let plane = |name: &str| {
            let rise = 40.0 * angle.tan();
            Profile::new(name, "test", vec![Segment::arc(Arc::line([-40.0, -rise], [40.0, rise]).unwrap())])
                .unwrap()
        };
        Pair::new(plane("rail"), plane("wheel"), RADIUS).unwrap().placed(x, x, skew).unwrap()
    }

    fn creepages(placement: &Placement, rates: Rates) -> Creepages {
        Motion::new(SPEED, rates).unwrap().creepages(placement, HALF, RADIUS).unwrap()
    }

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() <= CLOSE, "{found:e} instead of {expected:e}");
    }

    #[test]
    fn a_cone_that_rolls_creeps_by_its_radius_and_spins_by_its_angle() {
        let angle = 0.05_f64;
        let free = creepages(&cone(angle, 0.0, 0.0), Rates::default());
        near(free.longitudinal, 0.0);
        near(free.lateral, 0.0);
        near(free.spin, angle.sin() / RADIUS);
        near(free.rolling_speed / SPEED, 1.0);
        assert_eq!((free.forward, free.pitch), (true, -SPEED / RADIUS));
        // Nearer to the flange the radius is larger: the surface moves backward over the rail.
        let large = cone(angle, -10.0, 0.0);
        let r = large.rolling_radius();
        assert!(r > RADIUS);
        let faster = creepages(&large, Rates::default());
        near(faster.longitudinal, 2.0 * (r - RADIUS) / (r + RADIUS));
        near(faster.spin, angle.sin() / RADIUS * 2.0 * RADIUS / (r + RADIUS));
    }

    #[test]
    fn yaw_creeps_sideways() {
        let (angle, yaw) = (0.05_f64, 0.01_f64);
        // The skew of a yawed wheel: sin χ cos θ = sin ψ of its axle.
        let skew = (yaw.sin() / angle.cos()).asin();
        let yawed = creepages(&cone(angle, 0.0, skew), Rates::default());
        let carried = (1.0 + skew.cos()) / 2.0;
        near(yawed.lateral, -skew.sin() / carried);
        near(yawed.longitudinal, (skew.cos() - 1.0) / carried);
        assert!((yawed.lateral + yaw / angle.cos()).abs() < 1e-6, "{}", yawed.lateral);
    }

    #[test]
    fn every_rate_has_its_sign() {
        let (angle, rate) = (0.3_f64, 0.5);
        let placement = cone(angle, 0.0, 0.0);
        let (sin, cos) = angle.sin_cos();
        let with = |rates: Rates| creepages(&placement, rates);
        let lateral = with(Rates { lateral: 100.0, ..Rates::default() });
        near(lateral.lateral, -100.0 * cos / SPEED);
        let vertical = with(Rates { vertical: 100.0, ..Rates::default() });
        near(vertical.lateral, -100.0 * sin / SPEED);
        // The right-hand wheel moves forward: its surface is carried faster.
        let yaw = with(Rates { yaw: rate, ..Rates::default() });
        let speed = SPEED + rate * HALF / 2.0;
        near(yaw.rolling_speed / speed, 1.0);
        near(yaw.longitudinal, -rate * HALF / speed);
        near(yaw.spin, rate * cos / speed + sin / RADIUS * SPEED / speed);
        // The wheel's bottom swings to the left, and the wheel goes down.
        let roll = with(Rates { roll: rate, ..Rates::default() });
        near(roll.lateral, rate * (RADIUS * cos + HALF * sin) / SPEED);
        // The wheel turns faster than it rolls: its surface moves backward over the rail.
        let turn = -1.01 * SPEED / RADIUS;
        let pitch = with(Rates { pitch: Pitch::Rate(turn), ..Rates::default() });
        near(pitch.longitudinal, 0.01 / 1.005);
        assert_eq!((pitch.pitch, pitch.forward), (turn, true));
        let locked = with(Rates { pitch: Pitch::Rate(0.0), ..Rates::default() });
        assert_eq!((locked.longitudinal, locked.rolling_speed, locked.forward), (-2.0, SPEED / 2.0, true));
    }

    #[test]
    fn slip_away_from_c_is_that_of_a_rigid_wheel() {
        let angle = 0.3_f64;
        let placement = cone(angle, 3.0, 0.0);
        let (sin, cos) = angle.sin_cos();
        let rolling = creepages(&placement, Rates::default());
        near(rolling.slip_at([0.0; 3], [0.0, 1.0])[0], rolling.longitudinal);
        // A point of the rail's plane through the axle: the surface moves backward by the distance from the axle.
        let (r, v) = (placement.rolling_radius(), rolling.rolling_speed);
        for [xi, zeta, alpha] in [[5.0, -0.3, -0.1_f64], [-8.0, -1.2, 0.4], [2.0, 0.7, 1.2]] {
            let normal = [-alpha.sin(), alpha.cos()];
            let distance = r - xi * sin - zeta * cos;
            let [along, across] = rolling.slip_at([xi, 0.0, zeta], normal);
            near(along, (-SPEED - rolling.pitch * distance) / v);
            near(across, 0.0);
            // Ahead of C the surface of the wheel comes down, and up the slope of the tangent that is a slip to the side.
            let rise = rolling.pitch * 4.0 * cos;
            near(rolling.slip_at([xi, 4.0, zeta], [0.0, 1.0])[1], rolling.pitch * 4.0 * -sin / v);
            let expected =
                rolling.slip_at([xi, 4.0, zeta], [0.0, 1.0])[1] * alpha.cos() - rise * alpha.sin() / v;
            near(rolling.slip_at([xi, 4.0, zeta], normal)[1], expected);
        }
    }

    #[test]
    fn backwards_is_the_same_with_other_signs_and_a_mirror_changes_three() {
        let placement = cone(0.05, -10.0, 0.01);
        let forward = creepages(&placement, Rates::default());
        let motion = Motion::new(-SPEED, Rates::default()).unwrap();
        let back = motion.creepages(&placement, HALF, RADIUS).unwrap();
        assert!(!back.forward);
        assert_eq!((back.longitudinal, back.lateral), (-forward.longitudinal, -forward.lateral));
        assert_eq!((back.spin, back.rolling_speed), (-forward.spin, forward.rolling_speed));
        let rates = Rates { lateral: 1.0, vertical: 2.0, yaw: 3.0, roll: 4.0, pitch: Pitch::Nominal };
        let mirrored = Motion::new(SPEED, rates).unwrap().mirrored();
        let expected = Rates { lateral: -1.0, yaw: -3.0, roll: -4.0, ..rates };
        assert_eq!((*mirrored.rates(), mirrored.speed()), (expected, SPEED));
    }

    #[test]
    fn what_cannot_roll_is_refused() {
        assert!(Motion::new(0.0, Rates::default()).is_err());
        assert!(Motion::new(f64::NAN, Rates::default()).is_err());
        assert!(Motion::new(1.0, Rates { yaw: f64::INFINITY, ..Rates::default() }).is_err());
        let rates = Rates { yaw: -SPEED / HALF, pitch: Pitch::Rate(0.0), ..Rates::default() };
        let rest = Motion::new(SPEED, rates).unwrap().creepages(&cone(0.0, 0.0, 0.0), HALF, RADIUS);
        assert_eq!(rest.err().map(|error| error.found).as_deref(), Some("a wheel at rest"));
    }
}
