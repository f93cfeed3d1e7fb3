//! A placed pair: contact frame ξηζ and both profiles in it (Report Sec. 4).

use std::sync::Arc;

use nalgebra::{Isometry2, Point2, Translation2, UnitComplex};

use crate::error::{Error, Result, finite};
use crate::profile::{Profile, ProfilePoint, Section, Side, Station};

/// A profile with its outer surface in its own axes.
#[derive(Debug)]
struct Prepared {
    profile: Profile,
    own_axes: Section,
}

/// One body of a placed pair.
#[derive(Debug, Clone)]
pub struct Body {
    prepared: Arc<Prepared>,
    /// The contact point C on it; its tangent gives θ_C.
    pub(crate) point: ProfilePoint,
    /// The profile in the contact frame.
    pub(crate) section: Section,
}

/// A rail and a wheel that share the contact point C and the common normal there.
///
/// The contact frame has its origin at C, ξ along the rail profile's tangent, η = y along the rail, ζ along
/// the common normal from rail to wheel. The wheel's meridian through C may be turned about ζ by the skew χ
/// (yaw); then the wheel's own coordinates in the tangent plane are ξ′ = ξ cos χ + η sin χ,
/// η′ = η cos χ − ξ sin χ.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// let pair = Pair::new(rail, wheel, 460.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let placement = pair.placed(10.0, 0.0, 0.0)?;
/// assert!((placement.rail().contact_angle().sin() + 10.0 / 300.0).abs() < 1e-15);
/// assert_eq!(placement.rolling_radius(), 460.0);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Placement {
    rail: Body,
    wheel: Body,
    /// R \[mm\].
    wheel_radius: f64,
    /// χ \[rad\], finite.
    skew: f64,
    /// Whether the frame's origin is C.
    at_contact: bool,
}

/// What is placed: two right-hand profiles, prepared once, and the wheel's radius. A clone shares the profiles.
#[derive(Debug, Clone)]
pub struct Pair {
    rail: Arc<Prepared>,
    wheel: Arc<Prepared>,
    wheel_radius: f64,
}

impl Pair {
    /// Two profiles and the nominal rolling radius.
    ///
    /// # Errors
    /// A radius that is not positive and finite; a wheel profile that reaches its own axle.
    pub fn new(rail: Profile, wheel: Profile, wheel_radius: f64) -> Result<Self> {
        if finite("wheel: radius", wheel_radius)? <= 0.0 {
            let found = wheel_radius.to_string();
            return Err(Error::new(
                "wheel: radius",
                found,
                "a positive length in mm",
                "give the rolling radius",
            ));
        }
        let highest = wheel.segments().iter().flat_map(|s| [s.start().z, s.end().z]).fold(f64::MIN, f64::max);
        if highest >= wheel_radius {
            let found = format!("a profile up to z = {highest} mm");
            let expected = format!("all of it below the axle at z = R = {wheel_radius} mm");
            return Err(Error::new("wheel: profile", found, expected, "check unit, sign of z and radius"));
        }
        let [rail, wheel] = [(rail, Side::Rail), (wheel, Side::Wheel)].map(|(profile, side)| {
            let own_axes = Section::own_axes(&profile, side);
            Arc::new(Prepared { profile, own_axes })
        });
        Ok(Self { rail, wheel, wheel_radius })
    }

    /// The rail profile.
    pub fn rail(&self) -> &Profile {
        &self.rail.profile
    }

    /// The wheel profile.
    pub fn wheel(&self) -> &Profile {
        &self.wheel.profile
    }

    /// The outer surface of the rail and of the wheel, each in its own axes.
    pub fn sections(&self) -> [&Section; 2] {
        [&self.rail.own_axes, &self.wheel.own_axes]
    }

    /// R \[mm\].
    pub fn wheel_radius(&self) -> f64 {
        self.wheel_radius
    }

    /// Places the pair in contact at chosen abscissae \[mm\] of the two profiles, the Report's way: (4.9)–(4.12). Each body
    /// is turned so that its own tangent at C lies along ξ. The skew χ \[rad\] is 0 without yaw.
    ///
    /// # Errors
    /// An abscissa off its profile, or where the profile is vertical; a skew that is not finite.
    pub fn placed(&self, rail_x: f64, wheel_x: f64, skew: f64) -> Result<Placement> {
        let rail = Body::at(&self.rail, rail_x, Side::Rail).map_err(|e| e.within("contact: rail_x"))?;
        let wheel = Body::at(&self.wheel, wheel_x, Side::Wheel).map_err(|e| e.within("contact: wheel_x"))?;
        self.touching(rail, wheel, skew)
    }

    /// Places the pair in contact along a given common tangent: abscissa \[mm\] and angle of ξ \[rad\] in the own axes of each
    /// body. At a kink the angle is not that of a tangent; s then has no second-order expansion at C. The place of contact
    /// of a search is placed by its own method `placed`.
    ///
    /// # Errors
    /// An abscissa off its profile, or a skew that is not finite.
    pub fn placed_along(&self, rail: [f64; 2], wheel: [f64; 2], skew: f64) -> Result<Placement> {
        let rail = Body::along(&self.rail, rail, Side::Rail).map_err(|e| e.within("contact: rail"))?;
        let wheel = Body::along(&self.wheel, wheel, Side::Wheel).map_err(|e| e.within("contact: wheel"))?;
        self.touching(rail, wheel, skew)
    }

    fn touching(&self, rail: Body, wheel: Body, skew: f64) -> Result<Placement> {
        let skew = finite("contact: skew", skew)?;
        Ok(Placement { rail, wheel, wheel_radius: self.wheel_radius, skew, at_contact: true })
    }

    /// This pair in the contact frames of another placed pair, so that s of both can be compared point by point.
    #[must_use]
    pub fn placed_like(&self, other: &Placement) -> Placement {
        let body = |prepared: &Arc<Prepared>, like: &Body, side| Body {
            section: Section::in_frame(&prepared.profile, like.point.station, side),
            prepared: Arc::clone(prepared),
            point: like.point,
        };
        Placement {
            rail: body(&self.rail, &other.rail, Side::Rail),
            wheel: body(&self.wheel, &other.wheel, Side::Wheel),
            wheel_radius: self.wheel_radius,
            skew: other.skew,
            at_contact: other.at_contact,
        }
    }
}

/// Angles closer than this \[rad\] are those of one tangent: what a search leaves by rounding, far below the kinks of
/// drawings.
const SAME_TANGENT: f64 = 1e-9;

impl Body {
    fn at(prepared: &Arc<Prepared>, x: f64, side: Side) -> Result<Self> {
        let point = prepared.point(x)?;
        if point.station.cos > 0.0 { Ok(Self::smooth(prepared, point, side)) } else { Err(prepared.off(x)) }
    }

    fn along(prepared: &Arc<Prepared>, [x, angle]: [f64; 2], side: Side) -> Result<Self> {
        let mut point = prepared.point(x)?;
        if (point.station.angle() - angle).abs() <= SAME_TANGENT {
            return Ok(Self::smooth(prepared, point, side));
        }
        let (sin, cos) = angle.sin_cos();
        (point.station.cos, point.station.sin) = (cos, sin);
        let section = Section::in_frame(&prepared.profile, point.station, side);
        Ok(Self { prepared: Arc::clone(prepared), point, section })
    }

    fn smooth(prepared: &Arc<Prepared>, point: ProfilePoint, side: Side) -> Self {
        let section = Section::at_contact(&prepared.profile, &point, side);
        Self { prepared: Arc::clone(prepared), point, section }
    }

    /// The profile in its own axes.
    pub fn profile(&self) -> &Profile {
        &self.prepared.profile
    }

    /// The contact point C on it; its tangent gives θ_C.
    pub fn point(&self) -> &ProfilePoint {
        &self.point
    }

    /// The profile in the contact frame.
    pub fn section(&self) -> &Section {
        &self.section
    }

    /// The contact frame in the profile's own axes (x, z): its translation is C \[mm\], its rotation θ_C.
    ///
    /// It takes a point (ξ, ζ) of the midplane to (x, z), eqs. (4.3), and its inverse (x, z) to (ξ, ζ), eqs. (4.2).
    /// `inverse_transform_point` subtracts C before it turns, so that points near C keep all digits of their distance from
    /// it; the composed `inverse()` does not.
    pub fn contact_frame(&self) -> Isometry2<f64> {
        let frame = &self.section.frame;
        let turn = UnitComplex::from_cos_sin_unchecked(frame.cos, frame.sin);
        Isometry2::from_parts(Translation2::new(frame.x, frame.z), turn)
    }

    /// Whether the contact frame's ξ is the tangent of the profile at C: not so at kinks and ends.
    pub fn is_smooth(&self) -> bool {
        self.section.contact.is_some()
    }

    /// θ_C \[rad\] of (4.12): the profile's angle at C, positive counter-clockwise from x to z.
    pub fn contact_angle(&self) -> f64 {
        self.point.station.angle()
    }
}

impl Prepared {
    fn point(&self, x: f64) -> Result<ProfilePoint> {
        self.own_axes.point(&self.profile, finite("", x)?).ok_or_else(|| self.off(x))
    }

    fn off(&self, x: f64) -> Error {
        let reach = self.own_axes.reach().unwrap_or([f64::NAN; 2]);
        let name = &self.profile.name;
        let expected = format!("a point of {name}, which lies over [{}, {}]", reach[0], reach[1]);
        Error::new("", x.to_string(), expected, "choose a point on the profile")
    }
}

impl Placement {
    /// The extruded body, below.
    pub fn rail(&self) -> &Body {
        &self.rail
    }

    /// The revolved body, above.
    pub fn wheel(&self) -> &Body {
        &self.wheel
    }

    /// The pair that is placed; it shares the profiles.
    pub fn pair(&self) -> Pair {
        let [rail, wheel] = [&self.rail, &self.wheel].map(|body| Arc::clone(&body.prepared));
        Pair { rail, wheel, wheel_radius: self.wheel_radius }
    }

    /// R \[mm\], the nominal rolling radius: distance from the axle to the wheel profile's origin.
    pub fn wheel_radius(&self) -> f64 {
        self.wheel_radius
    }

    /// χ \[rad\], the skew: 0 without yaw, + turns the wheel from ξ to η.
    pub fn skew(&self) -> f64 {
        self.skew
    }

    /// The rotation by χ in the tangent plane: it takes the wheel's own (ξ′, η′) to (ξ, η).
    pub fn skew_rotation(&self) -> UnitComplex<f64> {
        UnitComplex::new(self.skew)
    }

    /// The same contact with another skew χ \[rad\].
    ///
    /// # Errors
    /// A skew that is not finite.
    pub fn with_skew(&self, skew: f64) -> Result<Self> {
        Ok(Self { skew: finite("contact: skew", skew)?, ..self.clone() })
    }

    /// The same contact with χ = 0.
    #[must_use]
    pub fn without_skew(&self) -> Self {
        Self { skew: 0.0, ..self.clone() }
    }

    /// The same bodies in another frame of the plane η = 0: its origin lies on the rail at `rail_x` \[mm\], its ξ at `angle` \[rad\]
    /// in the rail profile's axes. The wheel does not move, so that s at the new origin is what it was there, along the new
    /// ζ; neither body is smooth in the sense of [`Body::is_smooth`].
    ///
    /// # Errors
    /// An abscissa off the rail; a skewed wheel, whose meridians do not hold the new ζ.
    pub fn reframed(&self, rail_x: f64, angle: f64) -> Result<Self> {
        if self.skew != 0.0 {
            let (found, expected) = (format!("a skew of {} rad", self.skew), "a wheel without yaw");
            return Err(Error::new("contact", found, expected, "keep the frame of the contact point"));
        }
        let point = self.rail.prepared.point(rail_x).map_err(|e| e.within("contact: rail_x"))?;
        let here = self.rail.contact_frame();
        let origin = here.inverse_transform_point(&Point2::new(point.station.x, point.station.z));
        let turn = UnitComplex::new(angle) * here.rotation.inverse();
        let body = |body: &Body, mut point: ProfilePoint, side| {
            let (origin, along) = (body.contact_frame() * origin, body.contact_frame().rotation * turn);
            point.station = Station { x: origin.x, z: origin.y, cos: along.re, sin: along.im };
            let section = Section::in_frame(&body.prepared.profile, point.station, side);
            Body { prepared: Arc::clone(&body.prepared), point, section }
        };
        let wheel = body(&self.wheel, self.wheel.point, Side::Wheel);
        Ok(Self { rail: body(&self.rail, point, Side::Rail), wheel, at_contact: false, ..self.clone() })
    }

    /// Whether the frame's origin is the contact point C: not so in a frame by [`Self::reframed`].
    pub fn is_at_contact(&self) -> bool {
        self.at_contact
    }

    /// R − z_C \[mm\]: distance from the axle to C.
    pub fn rolling_radius(&self) -> f64 {
        self.wheel_radius - self.wheel.point.station.z
    }

    /// The ξ where both bodies have a surface in the midplane, outermost ends.
    pub fn overlap(&self) -> Option<[f64; 2]> {
        let (rail, wheel) = (self.rail.section.reach()?, self.wheel.section.reach()?);
        let both = [rail[0].max(wheel[0]), rail[1].min(wheel[1])];
        (both[0] < both[1]).then_some(both)
    }

    /// All ξ inside (a, b) where either body changes its branch, ascending.
    pub fn joints(&self, a: f64, b: f64) -> Vec<f64> {
        let ends = |section: &Section| section.pieces.iter().flat_map(|p| p.xi).collect::<Vec<_>>();
        let mut all = ends(&self.rail.section);
        all.extend(ends(&self.wheel.section));
        all.retain(|&xi| xi > a && xi < b);
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}
