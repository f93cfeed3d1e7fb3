//! A placed pair: contact frame ξηζ and both profiles in it (Report Sec. 4).

use std::sync::{Arc, OnceLock};

use nalgebra::{Isometry2, Point2, Translation2, UnitComplex};

use super::along::wheel_along;
use super::swept::{Generator, Swept};
use crate::error::{Error, Result, finite};
use crate::lofted::{FramedLoft, LoftedBody};
use crate::numerics::interval::Interval;
use crate::profile::{Profile, ProfilePoint, Section, Side};

/// One body of a placed pair.
#[derive(Debug, Clone)]
pub struct Body {
    swept: Arc<Swept>,
    /// The contact point C on the body; its tangent gives θ_C.
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
    /// χ \[rad\], finite.
    skew: f64,
    /// Whether the frame's origin is C.
    at_contact: bool,
    /// Angle ν \[rad\] by which the common normal leans forward: on a roller, about its axle from the crown to C; on an extruded rail 0.
    turn: f64,
    /// The surface of a rail that varies along the track, or of a wheel that varies around its axle; its profile is then the section
    /// through C.
    lofted: Option<Arc<FramedLoft>>,
    /// How far the frame's origin lies ahead of C along η \[mm\].
    ahead: f64,
    /// The pair of [`Self::under`], made once.
    under: OnceLock<Option<Box<Placement>>>,
}

/// A rail or a roller, and a wheel, with right-hand profiles that are prepared once; clones share them.
#[derive(Debug, Clone)]
pub struct Pair {
    rail: Arc<Swept>,
    wheel: Arc<Swept>,
}

impl Pair {
    /// Makes the pair of an extruded rail and a wheel with its nominal rolling radius \[mm\].
    ///
    /// # Errors
    /// A radius that is not positive and finite; a wheel profile that reaches its own axle.
    pub fn new(rail: Profile, wheel: Profile, wheel_radius: f64) -> Result<Self> {
        let wheel = Swept::revolved(wheel, Side::Wheel, wheel_radius)?;
        Ok(Self { rail: Arc::new(Swept::extruded(rail, Side::Rail)), wheel: Arc::new(wheel) })
    }

    /// Returns the pair with the rail's profile revolved about an axle below it: a wheel on a roller. `radius` \[mm\] is the
    /// distance from that axle to the origin of the rail's profile, typically 350.
    ///
    /// # Errors
    /// A radius that is not positive and finite; a profile that reaches the roller's axle.
    ///
    /// # Examples
    /// ```
    /// # use wheelrail::{Arc, Evaluator, Half, Pair, Profile, Segment};
    /// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
    /// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
    /// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
    /// let pair = Pair::new(rail, wheel, 460.0)?.on_roller(350.0)?; // a crown of 300 mm below a cylinder of 460 mm
    /// let placement = pair.placed(0.0, 0.0, 0.0)?;
    /// let below = |radius: f64| radius - f64::sqrt(radius * radius - 5.0 * 5.0);
    /// let s = Evaluator::new(&placement).separation(0.0, 5.0);
    /// assert!((s - (below(460.0) + below(350.0))).abs() < 1e-13);
    /// # Ok::<(), wheelrail::Error>(())
    /// ```
    pub fn on_roller(&self, radius: f64) -> Result<Self> {
        let roller = Swept::revolved(self.rail().clone(), Side::Rail, radius)?;
        Ok(Self { rail: Arc::new(roller), wheel: Arc::clone(&self.wheel) })
    }

    /// Returns the pair with another profile of its rail or roller.
    ///
    /// # Errors
    /// A profile that reaches the roller's axle.
    pub fn with_rail(&self, profile: Profile) -> Result<Self> {
        let rail = match self.rail.generator {
            Generator::Extruded => Swept::extruded(profile, Side::Rail),
            Generator::Revolved { radius } => Swept::revolved(profile, Side::Rail, radius)?,
        };
        Ok(Self { rail: Arc::new(rail), wheel: Arc::clone(&self.wheel) })
    }

    /// Returns the pair with another profile of its wheel.
    ///
    /// # Errors
    /// A profile that reaches the wheel's axle.
    pub fn with_wheel(&self, profile: Profile) -> Result<Self> {
        let wheel = Swept::revolved(profile, Side::Wheel, self.wheel_radius())?;
        Ok(Self { rail: Arc::clone(&self.rail), wheel: Arc::new(wheel) })
    }

    /// Gives the profile of the rail or roller.
    pub fn rail(&self) -> &Profile {
        &self.rail.profile
    }

    /// Gives the wheel profile.
    pub fn wheel(&self) -> &Profile {
        &self.wheel.profile
    }

    /// Gives the outer surface of the rail and of the wheel, each in its own axes.
    pub fn sections(&self) -> [&Section; 2] {
        [&self.rail.own_axes, &self.wheel.own_axes]
    }

    /// Gives the nominal rolling radius R \[mm\].
    pub fn wheel_radius(&self) -> f64 {
        self.wheel.generator.radius()
    }

    /// Gives the distance \[mm\] from a roller's axle to the origin of its profile; `None` for a rail.
    pub fn roller_radius(&self) -> Option<f64> {
        Some(self.rail.generator.radius()).filter(|radius| radius.is_finite())
    }

    /// Places the pair in contact at chosen abscissae \[mm\] of the two profiles, the Report's way: (4.9)–(4.12). Each body
    /// is turned so that its own tangent at C lies along ξ. The skew χ \[rad\] is 0 without yaw.
    ///
    /// # Errors
    /// An abscissa off its profile, or where the profile is vertical; a skew that is not finite.
    pub fn placed(&self, rail_x: f64, wheel_x: f64, skew: f64) -> Result<Placement> {
        let rail = Body::at(&self.rail, rail_x).map_err(|e| e.within("contact: rail_x"))?;
        let wheel = Body::at(&self.wheel, wheel_x).map_err(|e| e.within("contact: wheel_x"))?;
        Placement::touching(rail, wheel, skew)
    }

    /// Places the pair in contact along a given common tangent: abscissa \[mm\] and angle of ξ \[rad\] in the own axes of each
    /// body. At a kink the angle is not that of a tangent; s then has no second-order expansion at C. `search::Contact::placed`
    /// places what a search found.
    ///
    /// # Errors
    /// An abscissa off its profile, or a skew that is not finite.
    pub fn placed_along(&self, rail: [f64; 2], wheel: [f64; 2], skew: f64) -> Result<Placement> {
        let rail = Body::along(&self.rail, rail).map_err(|e| e.within("contact: rail"))?;
        let wheel = Body::along(&self.wheel, wheel).map_err(|e| e.within("contact: wheel"))?;
        Placement::touching(rail, wheel, skew)
    }

    /// Places this pair in the contact frames of another placed pair, so that s of both can be compared point by point.
    #[must_use]
    pub fn placed_like(&self, other: &Placement) -> Placement {
        let [rail, wheel] = [(&self.rail, &other.rail), (&self.wheel, &other.wheel)]
            .map(|(swept, like)| Body::in_frame(swept, like.point));
        Placement { rail, wheel, lofted: None, under: OnceLock::new(), ..other.clone() }
    }
}

/// Angles closer than this \[rad\] are those of one tangent: what a search leaves by rounding, far below the kinks of
/// drawings.
const SAME_TANGENT: f64 = 1e-9;

impl Body {
    fn at(swept: &Arc<Swept>, x: f64) -> Result<Self> {
        let point = swept.point(x)?;
        if point.station.cos > 0.0 { Ok(Self::smooth(swept, point)) } else { Err(swept.off(x)) }
    }

    fn along(swept: &Arc<Swept>, [x, angle]: [f64; 2]) -> Result<Self> {
        let mut point = swept.point(x)?;
        if (point.station.angle() - angle).abs() <= SAME_TANGENT {
            return Ok(Self::smooth(swept, point));
        }
        let (sin, cos) = angle.sin_cos();
        (point.station.cos, point.station.sin) = (cos, sin);
        Ok(Self::in_frame(swept, point))
    }

    fn smooth(swept: &Arc<Swept>, point: ProfilePoint) -> Self {
        let section = swept.own_axes.at_contact(&swept.profile, &point, swept.side);
        Self { swept: Arc::clone(swept), point, section }
    }

    fn in_frame(swept: &Arc<Swept>, point: ProfilePoint) -> Self {
        let section = swept.own_axes.in_frame(&swept.profile, point.station, swept.side);
        Self { swept: Arc::clone(swept), point, section }
    }

    /// Returns a roller as a wheel, and its profile as a rail, both upside down; `None` for a rail.
    fn upside_down(&self) -> Option<[Self; 2]> {
        let Generator::Revolved { .. } = self.generator() else { return None };
        let point = self.point.upside_down();
        let made = self.swept.upside_down().each_ref().map(|swept| {
            if self.is_smooth() { Self::smooth(swept, point) } else { Self::in_frame(swept, point) }
        });
        Some(made)
    }

    /// Tells how the body is swept from its profile.
    pub fn generator(&self) -> Generator {
        self.swept.generator
    }

    /// Gives the distance \[mm\] from the body's axle to C along its own z: R − z_C of a wheel, R + z_C of a roller; infinite for a rail.
    pub fn axle_distance(&self) -> f64 {
        match self.swept.side {
            Side::Rail => self.generator().radius() + self.point.station.z,
            Side::Wheel => self.generator().radius() - self.point.station.z,
        }
    }

    /// Gives the profile in its own axes.
    pub fn profile(&self) -> &Profile {
        &self.swept.profile
    }

    /// Gives the contact point C on the body; its tangent gives θ_C.
    pub fn point(&self) -> &ProfilePoint {
        &self.point
    }

    /// Gives the profile in the contact frame.
    pub fn section(&self) -> &Section {
        &self.section
    }

    /// Gives the contact frame in the profile's own axes (x, z): its translation is C \[mm\], its rotation θ_C.
    ///
    /// It takes a point (ξ, ζ) of the midplane to (x, z), eqs. (4.3), and its inverse (x, z) to (ξ, ζ), eqs. (4.2).
    /// `inverse_transform_point` subtracts C before it turns, so that points near C keep all digits of their distance from
    /// it; the composed `inverse()` does not.
    pub fn contact_frame(&self) -> Isometry2<f64> {
        let frame = &self.section.frame;
        let turn = UnitComplex::from_cos_sin_unchecked(frame.cos, frame.sin);
        Isometry2::from_parts(Translation2::new(frame.x, frame.z), turn)
    }

    /// Tells whether the contact frame's ξ is the tangent of the profile at C: not so at kinks and ends.
    pub fn is_smooth(&self) -> bool {
        self.section.contact.is_some()
    }

    /// Gives θ_C \[rad\] of (4.12): the profile's angle at C, positive counter-clockwise from x to z.
    pub fn contact_angle(&self) -> f64 {
        self.point.station.angle()
    }
}

impl Placement {
    fn touching(rail: Body, wheel: Body, skew: f64) -> Result<Self> {
        let skew = finite("contact: skew", skew)?;
        let (lofted, under) = (None, OnceLock::new());
        Ok(Self { rail, wheel, skew, at_contact: true, turn: 0.0, lofted, ahead: 0.0, under })
    }

    /// Returns the same contact at the angle ν \[rad\] ahead of a roller's crown.
    pub(crate) fn turned(self, turn: f64) -> Self {
        Self { turn, ..self }
    }

    /// Takes the surface of the body that varies, seen from this contact.
    pub(crate) fn with_loft(self, lofted: Arc<FramedLoft>) -> Self {
        Self { lofted: Some(lofted), ..self }
    }

    /// Gives the surface of the body that varies, a rail along the track or a wheel around its axle, in the contact frame; `None` where
    /// both are swept.
    pub fn lofted(&self) -> Option<&FramedLoft> {
        self.lofted.as_deref()
    }

    /// Gives the surface of a rail that varies along the track, in the contact frame; `None` for any other rail.
    pub fn lofted_rail(&self) -> Option<&FramedLoft> {
        self.lofted().filter(|lofted| lofted.side() == Side::Rail)
    }

    /// Gives the surface of a wheel that varies around its axle, in the contact frame; `None` for any other wheel.
    pub fn lofted_wheel(&self) -> Option<&FramedLoft> {
        self.lofted().filter(|lofted| lofted.side() == Side::Wheel)
    }

    /// Names the body that varies, for messages; `None` where both are swept.
    pub fn varying(&self) -> Option<&'static str> {
        self.lofted().map(|lofted| LoftedBody::name(lofted.side()))
    }

    /// Gives the angle ν \[rad\] by which the contact frame's ζ leans forward. On a roller it is the angle about its axle from the crown
    /// to C; it is 0 on an extruded rail.
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// Gives the cosine of the angle between the common normal and the vertical: cosθ, cosθ cosν on a roller and on a rail that varies.
    pub fn upright(&self) -> f64 {
        self.rail.point.station.cos * self.turn.cos()
    }

    /// Gives a roller seen upside down: a wheel on a rail with the roller's own profile, touching at C without skew. Its separation is
    /// how far the roller lies below its extruded profile, so that s of a wheel on a roller is s on a rail plus s of this pair. The
    /// frame's ξ and η are those of the contact, and its ζ is opposite. `None` for a rail.
    pub fn under(&self) -> Option<&Self> {
        let made = || {
            let [rail, wheel] = self.rail.upside_down()?;
            let at_contact = self.at_contact;
            let (lofted, under) = (None, OnceLock::new());
            Some(Box::new(Self { rail, wheel, skew: 0.0, at_contact, turn: 0.0, lofted, ahead: 0.0, under }))
        };
        self.under.get_or_init(made).as_deref()
    }

    /// Gives the lower body: a rail or a roller.
    pub fn rail(&self) -> &Body {
        &self.rail
    }

    /// Gives the upper body: a wheel.
    pub fn wheel(&self) -> &Body {
        &self.wheel
    }

    /// Gives the pair that is placed; it shares the profiles.
    pub fn pair(&self) -> Pair {
        let [rail, wheel] = [&self.rail, &self.wheel].map(|body| Arc::clone(&body.swept));
        Pair { rail, wheel }
    }

    /// Gives the nominal rolling radius R \[mm\]: the distance from the axle to the wheel profile's origin.
    pub fn wheel_radius(&self) -> f64 {
        self.wheel.generator().radius()
    }

    /// Gives the skew χ \[rad\]: 0 without yaw, + turns the wheel from ξ to η.
    pub fn skew(&self) -> f64 {
        self.skew
    }

    /// Gives the rotation by χ in the tangent plane: it takes the wheel's own (ξ′, η′) to (ξ, η).
    pub fn skew_rotation(&self) -> UnitComplex<f64> {
        UnitComplex::new(self.skew)
    }

    /// Gives this contact with another skew χ \[rad\].
    ///
    /// # Errors
    /// A skew that is not finite.
    pub fn with_skew(&self, skew: f64) -> Result<Self> {
        Ok(Self { skew: finite("contact: skew", skew)?, ..self.clone() })
    }

    /// Gives this contact with χ = 0.
    #[must_use]
    pub fn without_skew(&self) -> Self {
        Self { skew: 0.0, ..self.clone() }
    }

    /// Gives the same bodies in another frame: its origin lies on the rail at `rail_x` \[mm\], its ξ at `angle` \[rad\] in the rail
    /// profile's axes. The wheel does not move, so that s is what it was, but measured along the new ζ; neither body is smooth in the
    /// sense of [`Body::is_smooth`].
    ///
    /// The new ζ has to lie in a plane through the axle. So under a skewed wheel the origin also moves along the rail, by
    /// [`Self::ahead`], and the skew changes.
    ///
    /// # Errors
    /// An abscissa off the rail; a skewed wheel over a roller, on which nothing moves along a straight line; a body that varies.
    pub fn reframed(&self, rail_x: f64, angle: f64) -> Result<Self> {
        if self.skew != 0.0 && self.rail.generator() != Generator::Extruded {
            let found = format!("a skew of {} rad over a roller", self.skew);
            let advice = "keep the frame of the contact point";
            return Err(Error::new("contact", found, "a wheel without yaw, or a rail", advice));
        }
        if let Some(varying) = self.varying() {
            let expected = "bodies of one profile each, whose sections are all alike";
            return Err(Error::new("contact", varying, expected, "keep the frame of the contact point"));
        }
        let mut point = self.rail.swept.point(rail_x).map_err(|e| e.within("contact: rail_x"))?;
        let here = self.rail.contact_frame();
        let origin = here.inverse_transform_point(&Point2::new(point.station.x, point.station.z));
        let turn = UnitComplex::new(angle) * here.rotation.inverse();
        let along = here.rotation * turn;
        (point.station.cos, point.station.sin) = (along.re, along.im);
        let rail = Body::in_frame(&self.rail.swept, point);
        let mut on_wheel = self.wheel.point;
        let ([ahead, skew], station) =
            wheel_along((&self.wheel.contact_frame(), self.skew, self.rolling_radius()), origin, turn);
        on_wheel.station = station;
        let wheel = Body::in_frame(&self.wheel.swept, on_wheel);
        let ahead = self.ahead + ahead;
        Ok(Self { rail, wheel, skew, ahead, at_contact: false, under: OnceLock::new(), ..self.clone() })
    }

    /// Gives how far \[mm\] the frame's origin lies ahead of the contact point C along η: 0 except in a frame by [`Self::reframed`] under
    /// a skewed wheel.
    pub fn ahead(&self) -> f64 {
        self.ahead
    }

    /// Tells whether the frame's origin is the contact point C: not so in a frame by [`Self::reframed`].
    pub fn is_at_contact(&self) -> bool {
        self.at_contact
    }

    /// Gives the rolling radius R − z_C \[mm\]: the distance from the wheel's axle to C.
    pub fn rolling_radius(&self) -> f64 {
        self.wheel.axle_distance()
    }

    /// Gives the range of ξ, up to the outermost ends, where both bodies have a surface in the midplane; `None` if there is none.
    pub fn overlap(&self) -> Option<Interval> {
        let both = self.rail.section.reach()?.cut(self.wheel.section.reach()?);
        (both.has_width()).then_some(both)
    }

    /// Lists all ξ inside (a, b) where either body changes its branch, ascending.
    pub fn joints(&self, a: f64, b: f64) -> Vec<f64> {
        let ends = |section: &Section| section.pieces.iter().flat_map(|p| p.xi.ends()).collect::<Vec<_>>();
        let mut all = ends(&self.rail.section);
        all.extend(ends(&self.wheel.section));
        all.retain(|&xi| xi > a && xi < b);
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}
