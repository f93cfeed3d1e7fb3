//! Bodies in their own axes: profiles that are extruded or revolved.

use std::sync::{Arc, OnceLock};

use crate::error::{Error, Result, finite};
use crate::numerics::interval::Interval;
use crate::profile::{Profile, ProfilePoint, Section, Side};

/// How a body is swept from its profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Generator {
    /// The body is extruded along y: a rail.
    Extruded,
    /// The body is revolved about an axle parallel to x, which lies above a wheel and below a roller.
    Revolved {
        /// Distance from the axle to the profile's origin \[mm\], positive, typically 460.
        radius: f64,
    },
}

impl Generator {
    /// Returns the distance from the axle to the profile's origin \[mm\]; infinite for an extruded body.
    pub fn radius(self) -> f64 {
        match self {
            Self::Extruded => f64::INFINITY,
            Self::Revolved { radius } => radius,
        }
    }
}

/// A body in its own axes: a profile with its outer surface, and how it is swept.
#[derive(Debug)]
pub(super) struct Swept {
    pub profile: Profile,
    pub own_axes: Section,
    pub side: Side,
    pub generator: Generator,
    /// A roller's profile as a rail, and the roller as a wheel, both upside down; made once.
    upside_down: OnceLock<[Arc<Swept>; 2]>,
}

impl Swept {
    pub fn extruded(profile: Profile, side: Side) -> Self {
        let own_axes = Section::own_axes(&profile, side);
        Self { profile, own_axes, side, generator: Generator::Extruded, upside_down: OnceLock::new() }
    }

    /// Returns a roller's profile as an extruded rail, and the roller as a wheel, both upside down. The outer surface of both is that of a
    /// wheel.
    pub fn upside_down(&self) -> &[Arc<Self>; 2] {
        self.upside_down.get_or_init(|| {
            let rail = Self::extruded(self.profile.upside_down(), Side::Wheel);
            let wheel =
                Self { generator: self.generator, ..Self::extruded(rail.profile.clone(), Side::Wheel) };
            [rail, wheel].map(Arc::new)
        })
    }

    pub fn revolved(profile: Profile, side: Side, radius: f64) -> Result<Self> {
        let [name, advice, reach, axle] = match side {
            Side::Rail => ["roller", "give the distance from its axle", "down", "above its axle at z = −"],
            Side::Wheel => ["wheel", "give the rolling radius", "up", "below the axle at z = R = "],
        };
        let place = format!("{name}: radius");
        if finite(&place, radius)? <= 0.0 {
            return Err(Error::new(place, radius.to_string(), "a positive length in mm", advice));
        }
        let towards = |z: f64| if side == Side::Rail { -z } else { z };
        let ends = profile.segments().iter().flat_map(|s| [s.start().z, s.end().z]);
        let nearest = ends.map(towards).fold(f64::MIN, f64::max);
        if nearest >= radius {
            let found = format!("a profile {reach} to z = {} mm", towards(nearest));
            let expected = format!("all of it {axle}{radius} mm");
            let place = format!("{name}: profile");
            return Err(Error::new(place, found, expected, "check unit, sign of z and radius"));
        }
        let generator = Generator::Revolved { radius };
        Ok(Self { generator, ..Self::extruded(profile, side) })
    }

    pub fn point(&self, x: f64) -> Result<ProfilePoint> {
        self.own_axes.point(&self.profile, finite("", x)?).ok_or_else(|| self.off(x))
    }

    pub fn off(&self, x: f64) -> Error {
        let reach = self.own_axes.reach().unwrap_or(Interval::of(f64::NAN));
        let name = &self.profile.name;
        let expected = format!("a point of {name}, which lies over [{}, {}]", reach.low, reach.high);
        Error::new("", x.to_string(), expected, "choose a point on the profile")
    }
}
