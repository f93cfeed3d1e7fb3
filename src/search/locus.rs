//! The contact locus: the outline of a yawed and rolled wheel seen along the rail, in closed form.
//!
//! A rail is the same at every y, so a wheel meets it where the wheel's *outline* in the xz plane does. The
//! outline is the set of surface points whose normal has no y component. For a point (x, z) of the wheel's
//! profile with tangent angle φ, at the radius ϱ = R − z, this condition gives one angle ω about the axle
//! (from the lowest meridian, forward positive). With yaw ψ and no roll
//!
//! ```text
//! sin ω = −tan φ tan ψ        X = x cosψ − ϱ sinω sinψ        sin Θ = sin φ / cosψ
//! cos ω = cos Θ / cos φ       Z = R − ϱ cosω                  tan Θ: slope of the outline
//! ```
//!
//! Z counts from the level R below the axle. The roll then turns (X, Z) and Θ rigidly about the y axis. Where
//! |sin φ| > cosψ a wheel has no outline: no part of that ring is seen edge on.
//!
//! An arc of radius r about (a, b), r > 0 for the lower half, is the outline parallel to the ellipse of its
//! centre ring: X = a cosψ + r sinΘ + …; its radius of curvature is
//!
//! ```text
//! ϱ_c = r (1 − sin²ψ/cos²φ) + ϱ sin²ψ/cos³φ = r + (R − b) sin²ψ/cos³φ
//! ```
//!
//! which is monotone in |Θ|; therefore the search over arcs is complete. r = 0 is the ring of a kink or end
//! under its fan of normals, r = ∞ a cone.

use super::element::ElementPoint;
use crate::profile::Station;

/// The attitude of a wheel over its rail, without the height: the trigonometry of one position, done once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Attitude {
    /// Abscissa of the wheel's profile origin in the rail's axes \[mm\].
    pub offset: f64,
    /// Ordinate y of the wheel's profile origin from the middle of the axle \[mm\]. It counts where a body varies, and on a roller, whose
    /// crown is at y = 0.
    pub along: f64,
    /// Nominal rolling radius R \[mm\].
    pub radius: f64,
    /// sinψ, ψ the yaw.
    pub sin_yaw: f64,
    /// cosψ, positive.
    pub cos_yaw: f64,
    /// Sine of the roll, positive clockwise as seen along y.
    pub sin_roll: f64,
    /// Cosine of the roll, positive.
    pub cos_roll: f64,
    /// tanψ.
    pub tan_yaw: f64,
    /// Slope of the steepest profile tangent with an outline: 1/|tanψ|.
    pub steepest_tangent: f64,
    /// tanψ sinψ: the shift of an outline per rolling radius and slope.
    pub shift: f64,
}

impl Attitude {
    /// Calculates the attitude of a pose, with `along` at 0.
    pub fn new(offset: f64, yaw: f64, roll: f64, radius: f64) -> Self {
        Self::of_directions(offset, yaw.sin_cos().into(), roll.sin_cos().into(), radius)
    }

    /// Calculates the attitude from sine and cosine of yaw and roll.
    pub fn of_directions(
        offset: f64,
        [sin_yaw, cos_yaw]: [f64; 2],
        [sin_roll, cos_roll]: [f64; 2],
        radius: f64,
    ) -> Self {
        let tan_yaw = sin_yaw / cos_yaw;
        let (steepest_tangent, shift) = (tan_yaw.abs().recip(), tan_yaw * sin_yaw);
        let along = 0.0;
        Self { offset, along, radius, sin_yaw, cos_yaw, sin_roll, cos_roll, tan_yaw, steepest_tangent, shift }
    }

    /// Returns sin²ψ.
    pub fn sin_yaw_squared(&self) -> f64 {
        self.sin_yaw * self.sin_yaw
    }

    /// Returns the outline point of a wheel profile point, with the tangent of the outline: x in the rail's
    /// axes, z above the (still unknown) height of the wheel's profile origin. NaN where there is no outline.
    ///
    /// Accuracy: a few roundings of the profile's coordinates; R enters only through the small ϱ(1 − cosω).
    #[inline]
    pub fn outline(&self, point: &Station) -> Station {
        if self.sin_yaw == 0.0 {
            return self.rolled(point);
        }
        let sin = point.sin / self.cos_yaw;
        let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
        let sin_omega = -sin * self.sin_yaw / point.cos;
        let cos_omega = cos / point.cos;
        let rolling = self.radius - point.z;
        let x = point.x * self.cos_yaw - rolling * sin_omega * self.sin_yaw;
        let z = point.z + rolling * sin_omega * sin_omega / (1.0 + cos_omega);
        self.rolled(&Station { x, z, cos, sin })
    }

    /// Turns a point of the outline by the roll, into the rail's axes.
    #[inline]
    fn rolled(&self, p: &Station) -> Station {
        let (cos, sin) = (self.cos_roll, self.sin_roll);
        Station {
            x: self.offset + p.x * cos + p.z * sin,
            z: p.z * cos - p.x * sin,
            cos: p.cos * cos + p.sin * sin,
            sin: p.sin * cos - p.cos * sin,
        }
    }

    /// Returns (sin φ, cos φ) of the wheel's profile where its outline has the tangent (sin, cos) in the
    /// rail's axes.
    #[inline]
    pub fn profile_tangent(&self, sin: f64, cos: f64) -> (f64, f64) {
        // A sine past 1 by a rounding would have no outline.
        let unrolled = (sin * self.cos_roll + cos * self.sin_roll).clamp(-1.0, 1.0);
        let sine = unrolled * self.cos_yaw;
        (sine, ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt())
    }

    /// Returns the sine of the outline's tangent in the rail's axes for a sine of the profile's tangent; −1 or
    /// 1, by its sign, where the outline's tangent is beyond the vertical.
    #[inline]
    pub fn outline_sine(&self, profile_sine: f64) -> f64 {
        self.rolled_sine((profile_sine / self.cos_yaw).clamp(-1.0, 1.0))
    }

    /// Returns the sine of a tangent after the roll; −1 or 1, by the sign of `sin`, beyond the vertical.
    #[inline]
    pub fn rolled_sine(&self, sin: f64) -> f64 {
        let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
        if cos * self.cos_roll + sin * self.sin_roll < 0.0 {
            return 1f64.copysign(sin);
        }
        sin * self.cos_roll - cos * self.sin_roll
    }

    /// Returns the outline point of a wheel profile point, with its derivatives with respect to the same
    /// parameter; NaN where there is no outline.
    #[inline]
    pub fn outline_place(&self, place: &ElementPoint) -> ElementPoint {
        let station = self.outline(&place.station);
        if self.sin_yaw == 0.0 && self.sin_roll == 0.0 {
            return ElementPoint { station, ..*place };
        }
        let Station { x: _, z, cos, sin } = place.station;
        let slope = sin / cos;
        let rolling = self.radius - z;
        let bend = rolling * place.turn / (cos * cos * cos);
        let run = place.run * self.cos_yaw + self.shift * (bend - place.run * slope * slope);
        // The roll turns the outline: dx by cos(roll) + tanΘ sin(roll), and the sine too.
        let sin = sin / self.cos_yaw;
        let tangent = sin / ((1.0 - sin) * (1.0 + sin)).sqrt();
        let turned = self.cos_roll + tangent * self.sin_roll;
        ElementPoint { station, run: run * turned, turn: place.turn / self.cos_yaw * turned, ..*place }
    }

    /// Returns the outline's signed radius of curvature ϱ_c \[mm\] at a profile point of signed radius
    /// `radius`.
    pub fn outline_radius(&self, point: &Station, radius: f64) -> f64 {
        let tilt = self.sin_yaw_squared() / (point.cos * point.cos);
        if tilt == 0.0 {
            return radius;
        }
        radius * (1.0 - tilt) + (self.radius - point.z) * tilt / point.cos
    }
}
