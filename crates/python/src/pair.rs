//! Pairs of profiles, and a single wheel on its rail.

use std::sync::Arc;

use pyo3::prelude::*;
use wheelrail::search::{ONE_CONTACT, Pose, ProfilePair, Selection};

use crate::contact::{Contact, Place};
use crate::errors::{OrRaise, no_contact};
use crate::profile::Profile;

/// A rail, a wheel and the wheel's nominal rolling radius in mm: the distance from the axle to the wheel profile's origin.
///
/// The rail is the one as it lies, inclined by `Profile.rotated`. A pair is prepared once for all that is asked of it; it
/// can be pickled.
///
/// Raises InputError for a radius that is not positive, a wheel that reaches its own axle, and profiles without a part that
/// faces the other body.
#[pyclass(frozen, module = "wheelrail")]
#[derive(Clone)]
pub(crate) struct Pair {
    pub(crate) pair: wheelrail::Pair,
    search: Arc<ProfilePair>,
}

#[pymethods]
impl Pair {
    #[new]
    #[pyo3(signature = (rail, wheel, radius))]
    fn new(rail: &Profile, wheel: &Profile, radius: f64) -> PyResult<Self> {
        let pair = wheelrail::Pair::new(rail.profile.clone(), wheel.profile.clone(), radius).or_raise()?;
        let search = Arc::new(ProfilePair::new(&pair).or_raise()?);
        Ok(Self { pair, search })
    }

    /// The rail profile.
    #[getter]
    fn rail(&self) -> Profile {
        Profile::of(self.pair.rail())
    }

    /// The wheel profile.
    #[getter]
    fn wheel(&self) -> Profile {
        Profile::of(self.pair.wheel())
    }

    /// The nominal rolling radius, mm.
    #[getter]
    fn radius(&self) -> f64 {
        self.pair.wheel_radius()
    }

    /// Lower the wheel, its origin `offset` mm to the field side of the rail's and turned by yaw and then roll in rad, until
    /// it touches. `within` mm: near misses up to this vertical gap are contacts too.
    ///
    /// Raises GeometryError for a wheel beside its rail; InputError for values that are not finite and angles beyond
    /// 0.5 rad.
    #[pyo3(signature = (offset = 0.0, *, yaw = 0.0, roll = 0.0, within = 0.0))]
    fn touch(&self, offset: f64, yaw: f64, roll: f64, within: f64) -> PyResult<WheelTouch> {
        let pose = Pose::new(offset, yaw, roll).or_raise()?;
        let mut search = self.search.search();
        let Some(touch) = search.touch(&pose, &Selection { within, apart: ONE_CONTACT }) else {
            return Err(no_contact("offset", "a wheel over its rail"));
        };
        let contact = |(k, found)| Contact::found(&self.pair, found, Place { side: "single", number: k + 1 });
        let contacts = touch.contacts.iter().copied().enumerate().map(contact).collect();
        Ok(WheelTouch { height: touch.height, contacts })
    }

    /// Put the two profiles in contact at chosen abscissae in mm, the way of the Report: each is turned so that its own
    /// tangent there is common. `skew` in rad turns the wheel about the common normal.
    ///
    /// Raises InputError for an abscissa off its profile.
    #[pyo3(signature = (rail_x, wheel_x, *, skew = 0.0))]
    fn placed(&self, rail_x: f64, wheel_x: f64, skew: f64) -> PyResult<Contact> {
        Ok(Contact::placed(self.pair.placed(rail_x, wheel_x, skew).or_raise()?, "chosen".into()))
    }

    pub(crate) fn __repr__(&self) -> String {
        let [rail, wheel] = [self.pair.rail(), self.pair.wheel()].map(|profile| &profile.name);
        format!("Pair({rail:?}, {wheel:?}, radius={:?})", self.pair.wheel_radius())
    }

    pub(crate) fn __eq__(&self, other: &Self) -> bool {
        self.pair.rail() == other.pair.rail()
            && self.pair.wheel() == other.pair.wheel()
            && self.pair.wheel_radius() == other.pair.wheel_radius()
    }

    fn __getnewargs__(&self) -> (Profile, Profile, f64) {
        (self.rail(), self.wheel(), self.radius())
    }
}

/// First touch of a single wheel.
#[pyclass(frozen, get_all, module = "wheelrail")]
pub(crate) struct WheelTouch {
    /// Height of the wheel profile's origin over the rail's, mm, + up.
    height: f64,
    /// The contacts, the lowest gap first.
    contacts: Vec<Contact>,
}

#[pymethods]
impl WheelTouch {
    fn __repr__(&self) -> String {
        format!("WheelTouch(height={:?}, {} contacts)", self.height, self.contacts.len())
    }
}
