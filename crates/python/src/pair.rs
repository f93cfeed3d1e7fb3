//! Pairs of profiles, and a single wheel on its rail.

use std::sync::Arc;

use pyo3::prelude::*;
use wheelrail::Error;
use wheelrail::case::{Doubt, Landmarks, SideLandmarks, usual};
use wheelrail::profile::Side;
use wheelrail::scene;
use wheelrail::search::{self, ONE_CONTACT, Pose, ProfilePair, Selection, TrackSide};

use crate::contact::Contact;
use crate::errors::{OrRaise, exception, warn};
use crate::place::{FoundAt, PairContact, joined};
use crate::profile::Profile;
use crate::values::made;

/// A rail, a wheel and the wheel's nominal rolling radius in mm: the distance from the axle to the wheel profile's origin.
///
/// The rail is the one as it lies, inclined by `Profile.rotated`. `roller` in mm makes a roller of the rail: the distance from its
/// axle, which is below, to the rail profile's origin. A pair is prepared once for all that is asked of it; it can be pickled.
///
///     >>> pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)
///     >>> round(pair.touch(offset=0.0).contacts[0].rolling_radius, 3)
///     460.735
///
/// Raises InputError for a radius that is not positive, a wheel that reaches its own axle, bodies in the wrong order, and
/// profiles without a part that faces the other body; warns of radii and flanges that no railway wheel has.
#[pyclass(frozen, module = "wheelrail")]
#[derive(Clone)]
pub(crate) struct Pair {
    pub(crate) pair: wheelrail::Pair,
    rail: Profile,
    wheel: Profile,
    search: Arc<ProfilePair>,
    pub(crate) landmarks: Arc<SideLandmarks>,
}

#[pymethods]
impl Pair {
    #[new]
    #[pyo3(signature = (rail, wheel, radius, *, roller = None))]
    fn new(
        py: Python<'_>,
        rail: &Profile,
        wheel: &Profile,
        radius: f64,
        roller: Option<f64>,
    ) -> PyResult<Self> {
        for (place, profile, other) in [("rail", rail, Side::Wheel), ("wheel", wheel, Side::Rail)] {
            if profile.side == Some(other) {
                let found = format!("{:?}, the profile of the other body", profile.profile.name);
                let advice = "write Pair(rail, wheel, radius)";
                return Err(exception(Error::new(place, found, format!("a profile of a {place}"), advice)));
            }
        }
        let radius = scene::near("wheel", radius).or_raise()?;
        let roller = roller.map(|radius| scene::near("roller", radius)).transpose();
        let bodies = (rail.profile.clone(), wheel.profile.clone());
        let pair = roller.and_then(|roller| joined(bodies.0, bodies.1, radius, roller)).or_raise()?;
        let made = Self::of(pair, (rail.clone(), wheel.clone()))?;
        let flange = usual::flange_side("wheel", made.landmarks.on(TrackSide::Right));
        warn(py, usual::radius("radius", radius).into_iter().chain(flange))?;
        Ok(made)
    }

    /// The rail profile.
    #[getter]
    fn rail(&self) -> Profile {
        self.rail.clone()
    }

    /// The wheel profile.
    #[getter]
    fn wheel(&self) -> Profile {
        self.wheel.clone()
    }

    /// The nominal rolling radius, mm.
    #[getter]
    fn radius(&self) -> f64 {
        self.pair.wheel_radius()
    }

    /// Distance from the roller's axle to the rail profile's origin, mm; None for a rail.
    #[getter]
    fn roller(&self) -> Option<f64> {
        self.pair.roller_radius()
    }

    /// Lower the wheel, its origin `offset` mm to the field side of the rail's and turned by yaw and then roll in rad, until
    /// it touches. `within` mm: near misses up to this vertical gap are contacts too.
    ///
    /// Raises GeometryError for a wheel beside its rail; InputError for values that are not finite and angles beyond
    /// 0.5 rad; warns of angles and places that no wheel has.
    #[pyo3(signature = (offset = 0.0, *, yaw = 0.0, roll = 0.0, within = 0.0))]
    fn touch<'py>(
        &self,
        py: Python<'py>,
        offset: f64,
        yaw: f64,
        roll: f64,
        within: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let pose = Pose::new(offset, yaw, roll).or_raise()?;
        let within = scene::within(Some(within)).or_raise()?;
        warn(
            py,
            [("yaw", yaw), ("roll", roll)].into_iter().filter_map(|(name, angle)| usual::angle(name, angle)),
        )?;
        let mut search = self.search.search();
        let touch = search.touch(&pose, &Selection { within, apart: ONE_CONTACT }).or_raise()?;
        warn(py, self.doubts_of([None, touch.contacts.first()]))?;
        let contacts = self.contacts("single", touch.contacts);
        made(py, "WheelTouch", (touch.height, contacts))
    }

    /// Put the two profiles in contact at chosen abscissae in mm, the way of the Report: each is turned so that its own
    /// tangent there is common. `skew` in rad turns the wheel about the common normal.
    ///
    /// Raises InputError for an abscissa off its profile; warns of tangents that differ and places where no wheel stands.
    #[pyo3(signature = (rail_x, wheel_x, *, skew = 0.0))]
    fn placed(&self, py: Python<'_>, rail_x: f64, wheel_x: f64, skew: f64) -> PyResult<Contact> {
        let placement = self.pair.placed(rail_x, wheel_x, skew).or_raise()?;
        let of_points = usual::tilt("placed", &placement).into_iter().chain(usual::angle("skew", skew));
        warn(py, of_points.chain(usual::standing(self.landmarks.on(TrackSide::Right), &placement, 0.0)))?;
        Ok(Contact::of(PairContact::chosen(placement, [rail_x, wheel_x, skew])))
    }

    pub(crate) fn __repr__(&self) -> String {
        let [rail, wheel] = [&self.rail, &self.wheel].map(|body| &body.profile.name);
        let roller = self.roller().map_or_else(String::new, |radius| format!(", roller={radius:?}"));
        format!("Pair({rail:?}, {wheel:?}, radius={:?}{roller})", self.pair.wheel_radius())
    }

    pub(crate) fn __eq__(&self, other: &Self) -> bool {
        self.rail == other.rail
            && self.wheel == other.wheel
            && self.radius() == other.radius()
            && self.roller() == other.roller()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, PairParts)> {
        let make = py.import("wheelrail._wheelrail")?.getattr("pair_from_parts")?;
        Ok((make, (self.rail(), self.wheel(), self.radius(), self.roller())))
    }
}

/// Rail, wheel, radius and roller.
type PairParts = (Profile, Profile, f64, Option<f64>);

/// Make a pair of its parts, without repeating the warnings of when it was first made.
#[pyfunction]
pub(crate) fn pair_from_parts(
    rail: Profile,
    wheel: Profile,
    radius: f64,
    roller: Option<f64>,
) -> PyResult<Pair> {
    let pair = joined(rail.profile.clone(), wheel.profile.clone(), radius, roller);
    Pair::of(pair.or_raise()?, (rail, wheel))
}

impl Pair {
    /// Prepares a pair of the library.
    pub(crate) fn of(pair: wheelrail::Pair, (rail, wheel): (Profile, Profile)) -> PyResult<Self> {
        let search = Arc::new(ProfilePair::new(&pair).or_raise()?);
        let landmarks = Arc::new(SideLandmarks::new(Landmarks::new(&pair), None));
        Ok(Self { pair, rail, wheel, search, landmarks })
    }

    /// Numbers the contacts of a side.
    pub(crate) fn contacts(&self, side: &'static str, found: &[search::Contact]) -> Vec<Contact> {
        let contact =
            |(k, found)| Contact::of(PairContact::found(&self.pair, found, FoundAt { side, number: k + 1 }));
        found.iter().copied().enumerate().map(contact).collect()
    }

    /// Lists the doubts about the first contacts of the left and the right side, or of a single wheel.
    fn doubts_of(&self, first: [Option<&search::Contact>; 2]) -> Vec<Doubt> {
        let radius = self.radius();
        let all = self.landmarks.of_first(first).into_iter();
        all.flat_map(|doubts| {
            doubts.list().map(|(kind, value)| Doubt::of_contact(kind, value, radius)).collect::<Vec<_>>()
        })
        .collect()
    }
}
